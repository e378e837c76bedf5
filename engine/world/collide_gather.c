/* A box → the triangles near it: of the clusters in the kd-trees of the cells that it touches, and of the solids.
 *
 * What was gathered is kept with the box that it was gathered for: the many small sweeps of a step ask for it once. Corners are
 * kept as world points, exact (a cell's origin and a float on the grid add without rounding), so what a sweep sees does not
 * depend on when they were gathered. */
#include "world/collide_internal.h"

#include <string.h>

/* How much farther than asked is gathered, so that the next move finds it there. Metres; 0 for what is already large. */
#define AHEAD 0.25
#define LARGE 4.0

bool enf_collide_reserve(EnfCollider *collider, uint32_t more) {
    if (more <= collider->capacity - collider->count) {
        return true;
    }
    uint32_t needed = collider->count + more;
    uint32_t capacity = collider->capacity < 512 ? 1024 : collider->capacity * 2;
    if (needed < more || capacity < collider->capacity) {
        return false;
    }
    capacity = capacity < needed ? needed : capacity;
    void *grown = enf_realloc(collider->allocator, collider->triangles, collider->capacity, capacity,
                              sizeof *collider->triangles);
    if (grown == NULL) {
        return false;
    }
    collider->triangles = grown;
    collider->capacity = capacity;
    return true;
}

void enf_collide_put(EnfCollider *collider, const EnfVec3 corner[3], uint32_t cluster, uint32_t triangle, uint32_t solid) {
    EnfNearTriangle *out = &collider->triangles[collider->count++];
    EnfVec3 a = enf_sub(corner[1], corner[0]), b = enf_sub(corner[2], corner[0]);
    out->box = enf_box3_empty();
    for (int i = 0; i < 3; i++) {
        out->corner[i] = corner[i];
        out->box = enf_box3_add(out->box, corner[i]);
    }
    out->normal = enf_normalize(enf_cross(a, b));
    out->cluster = cluster;
    out->triangle = triangle;
    out->solid = solid;
}

static bool apart(const float *a, const float *b, const float *c, float low, float high) {
    return (*a < low && *b < low && *c < low) || (*a > high && *b > high && *c > high);
}

static bool gather_cluster(EnfCollider *collider, uint32_t index) {
    const EnfMap *map = collider->map;
    const EnfCluster *cluster = &map->clusters[index];
    const double *o = map->cells[cluster->cell].origin;
    EnfVec3 origin = enf_v3(o[0], o[1], o[2]);
    EnfBox3 local = {enf_sub(collider->region.min, origin), enf_sub(collider->region.max, origin)};
    EnfBox3f box = enf_box3f_outward(local);
    if (!enf_collide_reserve(collider, cluster->index_count / 3)) {
        return false;
    }
    for (uint32_t i = 0; i < cluster->index_count / 3; i++) {
        const uint32_t *at = &map->indices[cluster->index_first + 3 * i];
        const float *p[3] = {map->vertices[at[0]].position, map->vertices[at[1]].position, map->vertices[at[2]].position};
        if (apart(p[0], p[1], p[2], box.min.x, box.max.x) || apart(p[0] + 1, p[1] + 1, p[2] + 1, box.min.y, box.max.y) ||
            apart(p[0] + 2, p[1] + 2, p[2] + 2, box.min.z, box.max.z)) {
            continue;
        }
        EnfVec3 corner[3];
        for (int k = 0; k < 3; k++) {
            corner[k] = enf_add(origin, enf_v3((double)p[k][0], (double)p[k][1], (double)p[k][2]));
        }
        enf_collide_put(collider, corner, index, i, ENF_NONE);
    }
    return true;
}

static bool gather_cell(EnfCollider *collider, uint32_t cell) {
    const EnfMap *map = collider->map;
    const double *o = map->cells[cell].origin;
    EnfVec3 origin = enf_v3(o[0], o[1], o[2]);
    EnfBox3 local = {enf_sub(collider->region.min, origin), enf_sub(collider->region.max, origin)};
    EnfKdTree tree = enf_map_cell_tree(map, cell);
    uint32_t found = enf_kd_overlap(&tree, enf_box3f_outward(local), collider->clusters, map->clusters_count);
    for (uint32_t i = 0; i < found; i++) {
        uint32_t cluster = collider->clusters[i];
        if (collider->stamps[cluster] == collider->stamp || !collider->collides[map->clusters[cluster].material]) {
            continue;
        }
        collider->stamps[cluster] = collider->stamp;
        if (!gather_cluster(collider, cluster)) {
            return false;
        }
    }
    return true;
}

static void next_stamp(EnfCollider *collider) {
    if (++collider->stamp == 0) { /* come round: old stamps would look like this one's */
        memset(collider->stamps, 0, collider->map->clusters_count * sizeof *collider->stamps);
        collider->stamp = 1;
    }
}

static bool gather_level(EnfCollider *collider) {
    const EnfMap *map = collider->map;
    const double *o = map->tree_origin;
    EnfVec3 origin = enf_v3(o[0], o[1], o[2]);
    EnfBox3 local = {enf_sub(collider->region.min, origin), enf_sub(collider->region.max, origin)};
    EnfKdTree tree = {map->cell_nodes, map->cell_blocks, map->cell_nodes_count, map->cell_blocks_count};
    uint32_t found = enf_kd_overlap(&tree, enf_box3f_outward(local), collider->cells, map->cells_count);
    next_stamp(collider);
    collider->count = 0;
    for (uint32_t i = 0; i < found; i++) {
        if (!gather_cell(collider, collider->cells[i])) {
            return false;
        }
    }
    for (uint32_t i = 0; i < collider->outside_count; i++) {
        if (!gather_cell(collider, collider->outside[i])) {
            return false;
        }
    }
    collider->level_count = collider->count;
    return true;
}

static bool holds(const EnfBox3 *a, const EnfBox3 *b) {
    return enf_box3_contains(*a, b->min) && enf_box3_contains(*a, b->max);
}

/* The world's clock, as far as poses depend on it: its tick, how many changes it has seen within it, and pushes. */
static bool solids_are_fresh(EnfCollider *collider) {
    if (collider->solid_count == 0) {
        return true;
    }
    uint32_t changes;
    (void)enf_world_changes(collider->world, &changes);
    bool fresh = collider->tick == enf_world_tick(collider->world) && collider->changes == changes &&
                 collider->pushes == enf_world_pushes(collider->world);
    collider->pushes = enf_world_pushes(collider->world);
    collider->tick = enf_world_tick(collider->world);
    collider->changes = changes;
    return fresh;
}

bool enf_collide_gather(EnfCollider *collider, EnfBox3 box) {
    bool here = holds(&collider->region, &box), fresh = solids_are_fresh(collider);
    if (here && fresh) {
        return !collider->failed;
    }
    collider->counters.gathers++;
    if (!here) {
        EnfVec3 size = enf_sub(box.max, box.min);
        double ahead = size.x > LARGE || size.y > LARGE || size.z > LARGE ? 0.0 : AHEAD;
        EnfVec3 margin = enf_v3(ahead, ahead, ahead);
        collider->region = (EnfBox3){enf_sub(box.min, margin), enf_add(box.max, margin)};
        collider->failed = !gather_level(collider);
    }
    collider->count = collider->level_count;
    collider->failed = collider->failed || !enf_collide_gather_solids(collider);
    collider->counters.triangles += collider->count;
    if (collider->failed) { /* what is not there cannot stop anything: refuse, and try anew next time */
        collider->region = enf_box3_empty();
        collider->level_count = collider->count = 0;
    }
    return !collider->failed;
}
