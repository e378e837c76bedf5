/* Makes an EnfDrawList from an EnfVisSet: visible clusters regrouped by material, neighbours merged into ranges, blended
 * ones back to front, and for each cell touched an eye-relative offset with which shared vertices stay bit-equal
 * (README.md). The cost follows the entries of the set; nothing here walks the map. DESIGN §2; PITFALLS 33. */
#include <string.h>

#include "draw/draw_internal.h"

/* What most programs show at once: they never need more room. */
enum { FIRST_MOVERS = 256, FIRST_PARTS = 1024 };

/* ---- life ------------------------------------------------------------------------------------------------------- */

/* The arrays and how many elements each may need: one table for making and freeing. Those that hold parts of movers, too, are in
 * movers.c. */
#define ENF_DRAW_ARRAYS(X)                                                                                                     \
    X(cells, map->cells_count)                                                                                                 \
    X(cell_stamps, map->cells_count)                                                                                           \
    X(solids, map->clusters_count)                                                                                             \
    X(grouped, map->clusters_count)                                                                                            \
    X(material_ends, map->materials_count)                                                                                     \
    X(materials, map->materials_count)

EnfResult enf_draw_create(EnfDraw **draw, const EnfMap *map, const EnfAllocator *allocator, EnfError *error) {
    ENF_ASSERT(draw && map);
    *draw = NULL;
    EnfDraw *made = enf_alloc(allocator, 1, sizeof *made);
    if (!made) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a draw list");
    }
    made->map = map;
    made->allocator = *(allocator ? allocator : enf_default_allocator());
    bool complete = true;
#define ENF_DRAW_MAKE(array, count)                                                                                            \
    made->array = enf_alloc(&made->allocator, (count), sizeof *made->array);                                                   \
    complete = complete && (made->array || (count) == 0);
    ENF_DRAW_ARRAYS(ENF_DRAW_MAKE)
#undef ENF_DRAW_MAKE
    bool moves = map->meshes_count > 0;
    complete = complete && enf_draw_reserve_movers(made, moves ? FIRST_MOVERS : 0, moves ? FIRST_PARTS : 0);
    if (!complete) {
        enf_draw_destroy(made);
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for draw lists of %u clusters",
                             map->clusters_count);
    }
    *draw = made;
    return ENF_OK;
}

void enf_draw_destroy(EnfDraw *draw) {
    if (!draw) {
        return;
    }
    EnfAllocator allocator = draw->allocator;
    const EnfMap *map = draw->map;
#define ENF_DRAW_FREE(array, count) enf_free(&allocator, draw->array, (count), sizeof *draw->array);
    ENF_DRAW_ARRAYS(ENF_DRAW_FREE)
#undef ENF_DRAW_FREE
    enf_draw_free_movers(draw);
    enf_free(&allocator, draw, 1, sizeof *draw);
}

/* ---- the eye ---------------------------------------------------------------------------------------------------- */

static double axis(EnfVec3 v, int i) {
    return i == 0 ? v.x : i == 1 ? v.y : v.z;
}

/* Projection with the far plane at infinity, times rotation. Rows x, y, z, w of a point p at depth d = forward·p:
 * right·p / tan_x, up·p / tan_y, d − 2 near, d. */
static void set_camera(EnfDraw *draw, const EnfCamera *camera, double near_plane) {
    draw->eye_grid = enf_grid_point(enf_grid_snap(camera->eye_ws));
    EnfVec3 fraction = enf_sub(camera->eye_ws, draw->eye_grid);
    float *m = draw->list.clip_from_eye;
    for (int i = 0; i < 3; i++) {
        draw->list.eye_fraction[i] = (float)axis(fraction, i);
        m[4 * i + 0] = (float)(axis(camera->right, i) / camera->tan_x);
        m[4 * i + 1] = (float)(axis(camera->up, i) / camera->tan_y);
        m[4 * i + 2] = (float)axis(camera->forward, i);
        m[4 * i + 3] = (float)axis(camera->forward, i);
    }
    m[12] = m[13] = m[15] = 0.0f;
    m[14] = (float)(-2.0 * near_plane);
}

/* Lists a cell once a frame. */
static void touch_cell(EnfDraw *draw, uint32_t cell) {
    if (draw->cell_stamps[cell] == draw->stamp) {
        return;
    }
    draw->cell_stamps[cell] = draw->stamp;
    const double *origin = draw->map->cells[cell].origin;
    EnfDrawCell *out = &draw->cells[draw->list.cell_count++];
    out->cell = cell;
    out->offset[0] = (float)(origin[0] - draw->eye_grid.x);
    out->offset[1] = (float)(origin[1] - draw->eye_grid.y);
    out->offset[2] = (float)(origin[2] - draw->eye_grid.z);
}

/* ---- collecting ------------------------------------------------------------------------------------------------- */

static void add_solid(EnfDraw *draw, uint32_t cluster, uint32_t material, bool masked) {
    if (draw->material_ends[material]++ == 0) {
        EnfDrawKey *key = &draw->materials[draw->material_count++];
        key->key = masked ? 1u : 0u;
        key->index = material;
    }
    draw->solids[draw->solid_count++] = cluster;
}

static void add_blend(EnfDraw *draw, uint32_t cluster, EnfVec3 eye_ws) {
    const EnfCluster *c = &draw->map->clusters[cluster];
    const double *origin = draw->map->cells[c->cell].origin;
    EnfVec3 center = enf_v3(0.5 * ((double)c->min[0] + (double)c->max[0]), 0.5 * ((double)c->min[1] + (double)c->max[1]),
                            0.5 * ((double)c->min[2] + (double)c->max[2]));
    EnfVec3 to = enf_sub(enf_add(enf_v3(origin[0], origin[1], origin[2]), center), eye_ws);
    EnfDrawKey *key = &draw->blends[draw->blend_count++];
    key->key = enf_draw_far_first(enf_dot(to, to));
    key->index = cluster;
}

/* Entries ascend by (space, cluster, visit), so equal clusters stand together and space 0 comes first. */
static void collect(EnfDraw *draw, const EnfVisSet *set) {
    uint32_t last = ENF_NONE;
    for (uint32_t i = 0; i < set->entry_count && set->entries[i].space == 0; i++) {
        uint32_t cluster = set->entries[i].cluster;
        ENF_ASSERT(cluster < draw->map->clusters_count);
        ENF_ASSERT(last == ENF_NONE || cluster >= last);
        if (cluster == last) {
            continue;
        }
        last = cluster;
        const EnfCluster *c = &draw->map->clusters[cluster];
        const EnfMaterial *material = &draw->map->materials[c->material];
        if (material->flags & ENF_MATERIAL_NODRAW) {
            continue;
        }
        touch_cell(draw, c->cell);
        if (material->alpha_mode == ENF_ALPHA_BLEND) {
            add_blend(draw, cluster, set->cameras[0].eye_ws);
        } else {
            add_solid(draw, cluster, c->material, material->alpha_mode == ENF_ALPHA_MASK);
        }
        draw->list.cluster_count++;
        draw->list.triangle_count += c->index_count / 3;
    }
}

/* ---- listing ---------------------------------------------------------------------------------------------------- */

EnfDrawBatch *enf_draw_open_batch(EnfDraw *draw, uint32_t material, uint32_t mover) {
    EnfDrawBatch *batch = &draw->batches[draw->list.batch_count++];
    batch->material = material;
    batch->mover = mover;
    batch->range_first = draw->list.range_count;
    batch->range_count = 0;
    return batch;
}

/* Appends a cluster to the last batch: longer range, if its indices follow the last one's, or a new range. */
static void append(EnfDraw *draw, uint32_t cluster) {
    const EnfCluster *c = &draw->map->clusters[cluster];
    EnfDrawBatch *batch = &draw->batches[draw->list.batch_count - 1];
    if (batch->range_count) {
        EnfDrawRange *last = &draw->ranges[draw->list.range_count - 1];
        if (last->index_first + last->index_count == c->index_first) {
            last->index_count += c->index_count;
            last->vertex_first = last->vertex_first < c->vertex_first ? last->vertex_first : c->vertex_first;
            return;
        }
    }
    EnfDrawRange *range = &draw->ranges[draw->list.range_count++];
    range->index_first = c->index_first;
    range->index_count = c->index_count;
    range->vertex_first = c->vertex_first;
    range->cluster = cluster;
    batch->range_count++;
}

/* A counting sort by material over the materials touched; leaves material_ends zero again. */
static void list_solids(EnfDraw *draw) {
    enf_draw_sort(draw->materials, draw->material_count);
    uint32_t first = 0;
    for (uint32_t i = 0; i < draw->material_count; i++) {
        uint32_t *end = &draw->material_ends[draw->materials[i].index];
        uint32_t count = *end;
        *end = first;
        first += count;
    }
    for (uint32_t i = 0; i < draw->solid_count; i++) {
        uint32_t cluster = draw->solids[i];
        draw->grouped[draw->material_ends[draw->map->clusters[cluster].material]++] = cluster;
    }
    uint32_t next = 0;
    for (uint32_t i = 0; i < draw->material_count; i++) {
        uint32_t material = draw->materials[i].index;
        enf_draw_open_batch(draw, material, ENF_NONE);
        for (; next < draw->material_ends[material]; next++) {
            append(draw, draw->grouped[next]);
        }
        draw->material_ends[material] = 0;
    }
}

/* Static clusters and parts of movers together. Of equal distance, clusters come first: their numbers are lower. */
static void list_blends(EnfDraw *draw) {
    enf_draw_sort(draw->blends, draw->blend_count);
    const uint32_t clusters = draw->map->clusters_count;
    uint32_t material = ENF_NONE; /* of the open batch, if it is one of clusters */
    for (uint32_t i = 0; i < draw->blend_count; i++) {
        uint32_t index = draw->blends[i].index;
        if (index >= clusters) {
            enf_draw_list_part(draw, index - clusters);
            material = ENF_NONE;
            continue;
        }
        if (draw->map->clusters[index].material != material) {
            material = draw->map->clusters[index].material;
            enf_draw_open_batch(draw, material, ENF_NONE);
        }
        append(draw, index);
    }
}

static void begin(EnfDraw *draw) {
    if (++draw->stamp == 0) { /* after 2^32 frames old stamps would look new */
        memset(draw->cell_stamps, 0, draw->map->cells_count * sizeof *draw->cell_stamps);
        draw->stamp = 1;
    }
    draw->solid_count = draw->material_count = draw->blend_count = 0;
    draw->part_count = draw->part_order_count = 0;
    memset(&draw->list, 0, sizeof draw->list);
    draw->list.batches = draw->batches;
    draw->list.ranges = draw->ranges;
    draw->list.cells = draw->cells;
    draw->list.movers = draw->movers;
}

const EnfDrawList *enf_draw_build(EnfDraw *draw, const EnfVisSet *set, double near_plane, EnfWorld *world, double alpha) {
    ENF_ASSERT(draw && set && set->cameras && set->space_count > 0);
    ENF_ASSERT(near_plane > 0.0 && alpha >= 0.0 && alpha <= 1.0);
    ENF_ASSERT(!world || enf_world_map(world) == draw->map);
    enf_draw_make_room(draw, set, world);
    begin(draw);
    set_camera(draw, &set->cameras[0], near_plane);
    collect(draw, set);
    enf_draw_collect_movers(draw, set, world, alpha);
    list_solids(draw);
    enf_draw_list_parts(draw);
    draw->list.opaque_batch_count = draw->list.batch_count;
    list_blends(draw);
    return &draw->list;
}
