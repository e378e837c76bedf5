/* The first page about a map: counts, where the bytes are, the cells. */
#include "enfinfo/info.h"
#include "enfinfo/table.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { CELLS_SHOWN = 40 };

const char *info_bytes(uint64_t bytes, char out[32]) {
    static const char *const units[] = {"B", "KiB", "MiB", "GiB"};
    double value = (double)bytes;
    int unit = 0;
    while (value >= 1024.0 && unit < 3) {
        value /= 1024.0;
        unit++;
    }
    snprintf(out, 32, unit ? "%.1f %s" : "%.0f %s", value, units[unit]);
    return out;
}

uint32_t info_triangles(const EnfMap *map, uint32_t cell) {
    const EnfCell *c = &map->cells[cell];
    uint32_t triangles = 0;
    for (uint32_t i = 0; i < c->cluster_count; i++) {
        triangles += map->clusters[c->cluster_first + i].index_count / 3;
    }
    return triangles;
}

void info_chunks(const EnfMap *map, InfoChunkFn *each, void *user) {
#define INFO_CHUNK(type, array, fourcc) each(user, fourcc, #array, map->array##_count, sizeof(type) * map->array##_count);
    ENF_MAP_CHUNKS(INFO_CHUNK)
#undef INFO_CHUNK
}

typedef struct ChunkTable {
    Table table;
    uint64_t total;
} ChunkTable;

static void add_bytes(void *user, const char *fourcc, const char *name, uint32_t records, uint64_t bytes) {
    (void)fourcc, (void)name, (void)records;
    ((ChunkTable *)user)->total += bytes;
}

static void add_row(void *user, const char *fourcc, const char *name, uint32_t records, uint64_t bytes) {
    ChunkTable *chunks = user;
    char text[32];
    if (records) {
        table_cell(&chunks->table, "  %s", fourcc);
        table_cell(&chunks->table, "%s", name);
        table_cell(&chunks->table, "%u", records);
        table_cell(&chunks->table, "%s", info_bytes(bytes, text));
        table_cell(&chunks->table, "%.1f %%", 100.0 * (double)bytes / (double)chunks->total);
    }
}

static void print_chunks(const EnfMap *map) {
    ChunkTable chunks = {{{0}, {0}, 0, NULL, 0, 0, false}, 0};
    info_chunks(map, add_bytes, &chunks);
    table_titles(&chunks.table, "  chunk|holds|#records|#size|#share");
    info_chunks(map, add_row, &chunks);
    table_print(&chunks.table, UINT32_MAX, "");
    table_free(&chunks.table);
}

/* Portals by kind; a pair is two half-portals that name one another. */
static void print_portals_line(const EnfMap *map) {
    uint32_t pairs = 0, one_way = 0, closed = 0, overlaps = 0, transforms = 0;
    for (uint32_t i = 0; i < map->portals_count; i++) {
        const EnfPortal *p = &map->portals[i];
        pairs += p->twin != ENF_NONE && p->twin > i;
        one_way += p->twin == ENF_NONE;
        closed += (p->flags & ENF_PORTAL_CLOSED) != 0;
        overlaps += (p->flags & ENF_PORTAL_OVERLAP) != 0;
        transforms += p->transform != ENF_NONE;
    }
    printf("  portals    %u half-portals: %u pairs, %u one-way; %u closed, %u overlaps, %u with a transform\n",
           map->portals_count, pairs, one_way, closed, overlaps, transforms);
}

static void print_size(const EnfMap *map) {
    EnfBox3 box = enf_box3_empty();
    for (uint32_t i = 0; i < map->cells_count; i++) {
        const EnfCell *c = &map->cells[i];
        EnfVec3 origin = enf_v3(c->origin[0], c->origin[1], c->origin[2]);
        if (!(c->flags & ENF_CELL_OUTSIDE)) {
            box = enf_box3_add(box, enf_add(origin, enf_v3((double)c->min[0], (double)c->min[1], (double)c->min[2])));
            box = enf_box3_add(box, enf_add(origin, enf_v3((double)c->max[0], (double)c->max[1], (double)c->max[2])));
        }
    }
    if (!enf_box3_is_empty(box)) {
        EnfVec3 size = enf_sub(box.max, box.min);
        printf("  size       %.1f × %.1f × %.1f m, from (%.2f, %.2f, %.2f)\n", size.x, size.y, size.z, box.min.x, box.min.y,
               box.min.z);
    }
}

static uint32_t static_triangles(const EnfMap *map) {
    uint32_t triangles = 0;
    for (uint32_t i = 0; i < map->clusters_count; i++) {
        triangles += map->clusters[i].index_count / 3;
    }
    return triangles;
}

static void print_movers_line(const EnfMap *map) {
    uint32_t triangles = 0, doors = 0;
    for (uint32_t i = 0; i < map->movers_count; i++) {
        doors += map->movers[i].portal != ENF_NONE;
    }
    for (uint32_t i = 0; i < map->meshes_count; i++) {
        triangles += info_mesh_triangles(map, i);
    }
    printf("  movers     %u", map->movers_count);
    if (map->movers_count > 0) {
        printf(": %u along paths, %u hinges, %u slides, %u free, %u still; %u close portals",
               info_movers_of_kind(map, ENF_MOVER_PATH), info_movers_of_kind(map, ENF_MOVER_HINGE),
               info_movers_of_kind(map, ENF_MOVER_SLIDE), info_movers_of_kind(map, ENF_MOVER_FREE),
               info_movers_of_kind(map, ENF_MOVER_STILL), doors);
    }
    printf("\n  meshes     %u, of %u triangles in %u parts\n", map->meshes_count, triangles, map->mesh_parts_count);
}

static void print_counts(const EnfMap *map) {
    uint32_t outside = 0, open = 0;
    for (uint32_t i = 0; i < map->cells_count; i++) {
        outside += (map->cells[i].flags & ENF_CELL_OUTSIDE) != 0;
        open += (map->cells[i].flags & ENF_CELL_OPEN) != 0;
    }
    printf("  cells      %u%s%s", map->cells_count - outside, outside ? " and the outside" : "", open ? "" : "\n");
    if (open) {
        printf(", %u with a leaking shell\n", open);
    }
    print_portals_line(map);
    printf("  geometry   %u triangles in %u clusters, %u vertices\n", static_triangles(map), map->clusters_count,
           map->vertices_count);
    printf("  kd-trees   %u nodes, %u blocks of eight boxes\n", map->kd_nodes_count, map->kd_blocks_count);
    printf("  materials  %u, with %u textures of %u images\n", map->materials_count, map->textures_count, map->images_count);
    printf("  lights     %u, reaching cells %u times\n", map->lights_count, map->light_refs_count);
    printf("  entities   %u, with %u cameras and %u animation paths\n", map->entities_count, map->cameras_count,
           map->paths_count);
    print_movers_line(map);
}

void info_print_overview(const EnfMap *map, const Options *options) {
    char bytes[32];
    printf("%s: Enfilade map, version %d, %s\n", options->map_path, ENF_MAP_VERSION, info_bytes(map->file.size, bytes));
    printf("  content    %016llx, compiled from %016llx\n", (unsigned long long)map->hash,
           (unsigned long long)map->source_hash);
    print_size(map);
    print_counts(map);
    printf("\n");
    print_chunks(map);
    if (!options->cells) {
        printf("\n");
        info_print_cells(map, CELLS_SHOWN);
    }
}
