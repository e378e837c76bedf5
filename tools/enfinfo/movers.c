/* Meshes and movers, a row each: what moves in the map, how, and what it is made of. */
#include "enfinfo/info.h"
#include "enfinfo/table.h"

#include <stdio.h>
#include <string.h>

static const char *const kinds[] = {"still", "path", "hinge", "slide", "free"};
static const char *const wraps[] = {"once", "loop", "ping-pong"};

const char *info_mover_kind(const EnfMap *map, uint32_t mover) {
    return kinds[map->movers[mover].kind];
}

const char *info_mover_wrap(const EnfMap *map, uint32_t mover) {
    return map->movers[mover].kind == ENF_MOVER_PATH ? wraps[map->movers[mover].wrap] : "";
}

uint32_t info_mesh_triangles(const EnfMap *map, uint32_t mesh) {
    const EnfMesh *m = &map->meshes[mesh];
    uint32_t triangles = 0;
    for (uint32_t i = m->part_first; i < m->part_first + m->part_count; i++) {
        triangles += map->mesh_parts[i].index_count / 3;
    }
    return triangles;
}

uint32_t info_mesh_users(const EnfMap *map, uint32_t mesh) {
    uint32_t users = 0;
    for (uint32_t i = 0; i < map->movers_count; i++) {
        users += map->movers[i].mesh == mesh;
    }
    return users;
}

uint32_t info_mesh_vertices(const EnfMap *map, uint32_t mesh) {
    const EnfMesh *m = &map->meshes[mesh];
    uint32_t vertices = 0;
    for (uint32_t i = m->part_first; i < m->part_first + m->part_count; i++) {
        vertices += map->mesh_parts[i].vertex_count;
    }
    return vertices;
}

uint32_t info_movers_of_kind(const EnfMap *map, EnfMoverKind kind) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < map->movers_count; i++) {
        count += map->movers[i].kind == (uint32_t)kind;
    }
    return count;
}

/* How it moves, in words: "loop 12 s, 33 + 33 + 0 keys"; "-100°..30° at 90°/s". */
static const char *motion_text(const EnfMap *map, uint32_t mover, char out[128]) {
    const EnfMover *m = &map->movers[mover];
    const double degrees = 180.0 / ENF_PI;
    out[0] = '\0';
    if (m->kind == ENF_MOVER_PATH) {
        const uint32_t tracks[3] = {m->translation, m->rotation, m->scale};
        uint32_t keys[3];
        for (int t = 0; t < 3; t++) {
            keys[t] = tracks[t] == ENF_NONE ? 0 : map->paths[tracks[t]].key_count;
        }
        snprintf(out, 128, "%s %.3g s, %u + %u + %u keys", wraps[m->wrap], (double)m->seconds, keys[0], keys[1], keys[2]);
    } else if (m->kind == ENF_MOVER_HINGE) {
        snprintf(out, 128, "%.3g°..%.3g° at %.3g°/s", (double)m->low * degrees, (double)m->high * degrees,
                 (double)m->rate * degrees);
    } else if (m->kind == ENF_MOVER_SLIDE) {
        snprintf(out, 128, "%.3g..%.3g m at %.3g m/s", (double)m->low, (double)m->high, (double)m->rate);
    }
    return out;
}

const char *info_mover_flags(const EnfMap *map, uint32_t mover, char out[96]) {
    uint32_t flags = map->movers[mover].flags;
    snprintf(out, 96, "%s%s%s", flags & ENF_MOVER_SOLID ? "solid " : "", flags & ENF_MOVER_LOCKED ? "locked " : "",
             flags & ENF_MOVER_CARRY ? "carry " : "");
    size_t length = strlen(out);
    if (length > 0) {
        out[length - 1] = '\0';
    }
    return out;
}

static void print_and_free(Table *table) {
    table_print(table, UINT32_MAX, "");
    table_free(table);
}

void info_print_movers(const EnfMap *map) {
    Table table = {{0}, {0}, 0, NULL, 0, 0, false};
    table_titles(&table, "#mover|name|class|kind|motion|#mesh|cell|closes|#max m/s|flags");
    for (uint32_t i = 0; i < map->movers_count; i++) {
        const EnfMover *m = &map->movers[i];
        const EnfEntity *e = &map->entities[m->entity];
        char text[128];
        table_cell(&table, "%u", i);
        table_cell(&table, "%s", enf_map_string(map, e->name));
        table_cell(&table, "%s", enf_map_string(map, e->classname));
        table_cell(&table, "%s", info_mover_kind(map, i));
        table_cell(&table, "%s", motion_text(map, i, text));
        table_cell(&table, m->mesh == ENF_NONE ? "-" : "%u", m->mesh);
        table_cell(&table, "%s", info_cell_name(map, e->cell));
        table_cell(&table, "%s", m->portal == ENF_NONE ? "" : enf_map_string(map, map->portals[m->portal].name));
        table_cell(&table, m->max_speed > 0.0f ? "%.3g" : "-", (double)m->max_speed);
        table_cell(&table, "%s", info_mover_flags(map, i, text));
    }
    print_and_free(&table);
}

void info_print_meshes(const EnfMap *map) {
    Table table = {{0}, {0}, 0, NULL, 0, 0, false};
    table_titles(&table, "#mesh|name|#size, m|#parts|#triangles|#vertices|#movers");
    for (uint32_t i = 0; i < map->meshes_count; i++) {
        const EnfMesh *m = &map->meshes[i];
        table_cell(&table, "%u", i);
        table_cell(&table, "%s", enf_map_string(map, m->name));
        table_cell(&table, "%.2f × %.2f × %.2f", (double)(m->max[0] - m->min[0]), (double)(m->max[1] - m->min[1]),
                   (double)(m->max[2] - m->min[2]));
        table_cell(&table, "%u", m->part_count);
        table_cell(&table, "%u", info_mesh_triangles(map, i));
        table_cell(&table, "%u", info_mesh_vertices(map, i));
        table_cell(&table, "%u", info_mesh_users(map, i));
    }
    print_and_free(&table);
}
