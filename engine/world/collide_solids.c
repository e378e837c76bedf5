/* Solids: what collides and moves. Where each is now and was a tick ago, for those near a capsule alone: a kd-tree over the boxes
 * that hold them for all time names them; the few that roam are asked each tick. */
#include "world/collide_internal.h"

#include <string.h>

void enf_solid_box(EnfBox3 box, EnfVec3f corners[36]) {
    /* Corner bits: 1 x, 2 y, 4 z; fronts outward. */
    static const uint8_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    static const uint8_t fan[6] = {0, 1, 2, 0, 2, 3};
    for (int f = 0; f < 6; f++) {
        for (int i = 0; i < 6; i++) {
            uint8_t bits = faces[f][fan[i]];
            EnfVec3 p = enf_v3(bits & 1 ? box.max.x : box.min.x, bits & 2 ? box.max.y : box.min.y,
                               bits & 4 ? box.max.z : box.min.z);
            corners[6 * f + i] = enf_v3f(p);
        }
    }
}

static bool roams(const EnfSolid *solid) {
    return enf_box3_is_empty(solid->bounds);
}

/* ---- the list --------------------------------------------------------------------------------------------------- */

static bool reserve_solids(EnfCollider *collider) {
    if (collider->solid_count < collider->solid_capacity) {
        return true;
    }
    uint32_t capacity = collider->solid_capacity == 0 ? 16 : collider->solid_capacity * 2;
    void *solids = enf_realloc(collider->allocator, collider->solids, collider->solid_capacity, capacity,
                               sizeof *collider->solids);
    if (solids == NULL) {
        return false;
    }
    collider->solids = solids;
    void *near = enf_realloc(collider->allocator, collider->near, collider->solid_capacity, capacity, sizeof *collider->near);
    if (near == NULL) { /* the longer list of solids is put back: both have one capacity */
        solids = enf_realloc(collider->allocator, collider->solids, capacity, collider->solid_capacity,
                             sizeof *collider->solids);
        collider->solids = solids != NULL || collider->solid_capacity == 0 ? solids : collider->solids;
        return false;
    }
    collider->near = near;
    collider->solid_capacity = capacity;
    return true;
}

EnfResult enf_collider_add(EnfCollider *collider, const EnfSolidDef *def, uint32_t *number, EnfError *error) {
    bool known = collider->world != NULL && def->object < enf_world_object_limit(collider->world);
    if (!known || def->triangle_count == 0 || def->triangle_count > ENF_SOLID_TRIANGLES_MAX) {
        return enf_error_set(error, ENF_ERROR_ARGUMENT, UINT64_MAX, "solid of object %u with %u triangles", def->object,
                             def->triangle_count);
    }
    return enf_collide_add_solid(collider, def, number, error);
}

EnfResult enf_collide_add_solid(EnfCollider *collider, const EnfSolidDef *def, uint32_t *number, EnfError *error) {
    EnfVec3f *corners = enf_alloc(collider->allocator, 3 * def->triangle_count, sizeof *corners);
    if (corners == NULL || !reserve_solids(collider)) {
        enf_free(collider->allocator, corners, 3 * def->triangle_count, sizeof *corners);
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "solid of object %u", def->object);
    }
    memcpy(corners, def->triangles, 3 * def->triangle_count * sizeof *corners);
    EnfSolid solid;
    memset(&solid, 0, sizeof solid);
    solid.corners = corners;
    solid.count = def->triangle_count;
    solid.object = def->object;
    solid.bounds = def->bounds_ws;
    solid.local = enf_box3_empty();
    for (uint32_t i = 0; i < 3 * solid.count; i++) {
        solid.local = enf_box3_add(solid.local, enf_v3_from_f(corners[i]));
    }
    solid.pose = solid.before = enf_pose_identity();
    solid.tick = INT64_MIN;
    solid.on = true;
    collider->solids[collider->solid_count] = solid;
    *number = collider->solid_count++;
    collider->tree_stale = true;
    collider->region = enf_box3_empty();
    return ENF_OK;
}

void enf_collider_set_solid(EnfCollider *collider, uint32_t object, bool on) {
    for (uint32_t i = 0; i < collider->solid_count; i++) {
        if (collider->solids[i].object == object && collider->solids[i].on != on) {
            collider->solids[i].on = on;
            collider->solids[i].tick = INT64_MIN;
            collider->region = enf_box3_empty();
        }
    }
}

void enf_collider_set_bounds(EnfCollider *collider, uint32_t object, EnfBox3 bounds_ws) {
    for (uint32_t i = 0; i < collider->solid_count; i++) {
        if (collider->solids[i].object == object) {
            collider->solids[i].bounds = bounds_ws;
            collider->tree_stale = true;
            collider->region = enf_box3_empty();
        }
    }
}

uint32_t enf_collide_solid_of(const EnfCollider *collider, uint32_t object) {
    for (uint32_t i = 0; i < collider->solid_count; i++) {
        if (collider->solids[i].object == object && collider->solids[i].on) {
            return i;
        }
    }
    return ENF_NONE;
}

bool enf_collider_is_solid(const EnfCollider *collider, uint32_t object) {
    return enf_collide_solid_of(collider, object) != ENF_NONE;
}

/* ---- where they are --------------------------------------------------------------------------------------------- */

/* Brings a solid to the world's tick. Who was not near a tick ago counts as having stood still. */
static void pose_solid(EnfCollider *collider, EnfSolid *solid) {
    int64_t tick = enf_world_tick(collider->world);
    EnfPose now = enf_world_pose(collider->world, solid->object);
    if (solid->tick != tick) {
        solid->before = solid->tick == tick - 1 ? solid->pose : now;
        solid->tick = tick;
    }
    solid->pose = now;
}

static EnfVec3 turn_back(EnfQuat q, EnfVec3 p) {
    EnfVec3 u = enf_v3(-q.x, -q.y, -q.z), t = enf_scale(enf_cross(u, p), 2.0);
    return enf_add(enf_add(p, enf_scale(t, q.w)), enf_cross(u, t));
}

static bool same_pose(const EnfPose *a, const EnfPose *b) {
    return a->position.x == b->position.x && a->position.y == b->position.y && a->position.z == b->position.z &&
           a->rotation.x == b->rotation.x && a->rotation.y == b->rotation.y && a->rotation.z == b->rotation.z &&
           a->rotation.w == b->rotation.w && a->scale.x == b->scale.x && a->scale.y == b->scale.y && a->scale.z == b->scale.z;
}

EnfVec3 enf_solid_ride(const EnfSolid *solid, EnfVec3 p) {
    const EnfPose *before = &solid->before;
    if (same_pose(before, &solid->pose)) {
        return p; /* to the bit */
    }
    EnfVec3 local = turn_back(before->rotation, enf_sub(p, before->position));
    EnfVec3 s = before->scale;
    if (s.x == 0.0 || s.y == 0.0 || s.z == 0.0) {
        return p;
    }
    return enf_pose_point(&solid->pose, enf_v3(local.x / s.x, local.y / s.y, local.z / s.z));
}

static EnfBox3 posed_box(const EnfSolid *solid) {
    EnfBox3 box = enf_box3_empty();
    for (int i = 0; i < 8; i++) {
        EnfVec3 p = enf_v3(i & 1 ? solid->local.max.x : solid->local.min.x, i & 2 ? solid->local.max.y : solid->local.min.y,
                           i & 4 ? solid->local.max.z : solid->local.min.z);
        box = enf_box3_add(box, enf_pose_point(&solid->pose, p));
    }
    return box;
}

/* ---- the gathering ---------------------------------------------------------------------------------------------- */

/* Solids that roam have no box, and are in no tree. */
bool enf_collide_sort_solids(EnfCollider *collider) {
    uint32_t count = collider->solid_count;
    if (count == 0) {
        return true;
    }
    EnfBox3f *boxes = enf_alloc(collider->allocator, count, sizeof *boxes);
    uint32_t *items = enf_alloc(collider->allocator, count, sizeof *items);
    bool ok = boxes != NULL && items != NULL;
    uint32_t used = 0;
    for (uint32_t i = 0; ok && i < count; i++) {
        if (!roams(&collider->solids[i])) {
            boxes[used] = enf_box3f_outward(collider->solids[i].bounds);
            items[used++] = i;
        }
    }
    enf_kd_built_free(&collider->tree);
    memset(&collider->tree, 0, sizeof collider->tree);
    ok = ok && (used == 0 || enf_kd_build(&collider->tree, boxes, items, used, collider->allocator, NULL) == ENF_OK);
    enf_free(collider->allocator, boxes, count, sizeof *boxes);
    enf_free(collider->allocator, items, count, sizeof *items);
    collider->tree_stale = !ok;
    return ok;
}

/* In ascending order, so that nothing depends on the tree's. */
static void sort_near(uint32_t *items, uint32_t count) {
    for (uint32_t i = 1; i < count; i++) {
        uint32_t item = items[i], at = i;
        for (; at > 0 && items[at - 1] > item; at--) {
            items[at] = items[at - 1];
        }
        items[at] = item;
    }
}

static bool gather_solid(EnfCollider *collider, uint32_t number) {
    EnfSolid *solid = &collider->solids[number];
    EnfBox3 box = posed_box(solid);
    if (!enf_box3_overlaps(box, collider->region)) {
        return true;
    }
    if (!enf_collide_reserve(collider, solid->count)) {
        return false;
    }
    for (uint32_t i = 0; i < solid->count; i++) {
        EnfVec3 corner[3];
        for (uint32_t k = 0; k < 3; k++) {
            corner[k] = enf_pose_point(&solid->pose, enf_v3_from_f(solid->corners[3 * i + k]));
        }
        enf_collide_put(collider, corner, ENF_NONE, i, number);
    }
    return true;
}

bool enf_collide_gather_solids(EnfCollider *collider) {
    collider->near_count = 0;
    if (collider->solid_count == 0) {
        return true;
    }
    if (collider->tree_stale && !enf_collide_sort_solids(collider)) {
        return false;
    }
    EnfKdTree tree = enf_kd_tree(&collider->tree);
    uint32_t found = enf_kd_overlap(&tree, enf_box3f_outward(collider->region), collider->near, collider->solid_capacity);
    for (uint32_t i = 0; i < collider->solid_count; i++) {
        if (roams(&collider->solids[i])) {
            collider->near[found++] = i;
        }
    }
    sort_near(collider->near, found);
    for (uint32_t i = 0; i < found; i++) {
        EnfSolid *solid = &collider->solids[collider->near[i]];
        if (!solid->on || enf_world_object(collider->world, solid->object).generation == 0) {
            continue;
        }
        pose_solid(collider, solid);
        collider->near[collider->near_count++] = collider->near[i];
        if (!gather_solid(collider, collider->near[i])) {
            return false;
        }
    }
    return true;
}

void enf_collider_reset(EnfCollider *collider) {
    for (uint32_t i = 0; i < collider->solid_count; i++) {
        collider->solids[i].tick = INT64_MIN;
        collider->solids[i].ignored = 0;
    }
    collider->region = enf_box3_empty();
    collider->tick = INT64_MIN;
}
