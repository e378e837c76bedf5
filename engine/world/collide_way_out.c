/* A way out: a free place for a capsule that is inside something. First by pushing, the deepest overlap at a time; then by trying
 * places around, the near ones first. A place counts only if it lies in a cell (behind a wall it is free, too), unless none does. */
#include "world/collide_internal.h"

#include <math.h>

enum { PUSHES_MAX = 24, SHELLS = 12 };

static bool in_a_cell(const EnfCollider *collider, const EnfCapsule *capsule, EnfVec3 at) {
    EnfVec3 middle = enf_v3(at.x, at.y + 0.5 * capsule->height, at.z);
    return enf_map_locate(collider->map, middle) != ENF_NONE;
}

/* Out of the deepest overlap, by its depth and a skin, until there is none. */
static bool push_out(EnfCollider *collider, const EnfCapsule *capsule, EnfVec3 at, double reach, EnfVec3 *out) {
    EnfVec3 start = at;
    for (int i = 0; i < PUSHES_MAX; i++) {
        EnfOverlap overlap;
        if (!enf_collide_overlap(collider, capsule, at, &overlap)) {
            *out = at;
            return true;
        }
        at = enf_add(at, enf_scale(overlap.direction, overlap.depth + ENF_TOL_SKIN));
        EnfVec3 moved = enf_sub(at, start);
        if (enf_dot(moved, moved) > reach * reach) {
            return false;
        }
    }
    return false;
}

/* The 26 ways of a cube's corners, edges and faces: up first, down last. */
static EnfVec3 way_of(int i) {
    int y = 1 - i / 9, x = i % 3 - 1, z = i / 3 % 3 - 1;
    return enf_normalize(enf_v3((double)x, (double)y, (double)z));
}

static bool search(EnfCollider *collider, const EnfCapsule *capsule, EnfVec3 at, double reach, EnfVec3 *out) {
    bool found = false;
    for (int shell = 1; shell <= SHELLS; shell++) {
        for (int i = 0; i < 27; i++) {
            EnfVec3 way = way_of(i);
            EnfVec3 place = enf_add(at, enf_scale(way, reach * (double)shell / SHELLS));
            if ((way.x == 0.0 && way.y == 0.0 && way.z == 0.0) || enf_collide_overlap(collider, capsule, place, NULL)) {
                continue;
            }
            if (in_a_cell(collider, capsule, place)) {
                *out = place;
                return true;
            }
            *out = found ? *out : place; /* the nearest of those that lie in no cell */
            found = true;
        }
    }
    return found;
}

bool enf_collide_way_out(EnfCollider *collider, const EnfCapsule *capsule, EnfVec3 at_ws, double reach, EnfVec3 *out) {
    EnfVec3 place;
    *out = at_ws;
    if (!enf_v3_finite(at_ws)) {
        return false;
    }
    if (!enf_collide_overlap(collider, capsule, at_ws, NULL)) {
        return true;
    }
    if (push_out(collider, capsule, at_ws, reach, &place) && in_a_cell(collider, capsule, place)) {
        *out = place;
        return true;
    }
    if (search(collider, capsule, at_ws, reach, &place)) {
        *out = place;
        return true;
    }
    return false;
}
