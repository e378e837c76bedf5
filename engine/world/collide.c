/* EnfCollider: sweeps and overlaps of a capsule against what was gathered near it. */
#include "world/collide_internal.h"

#include <math.h>
#include <string.h>

/* Longer sweeps go in pieces of this, metres, so that none gathers a whole level; and no sweep is longer than that many. */
#define PIECE 1.0
enum { PIECES_MAX = 32768 };

/* Room for more triangles than a body ever has about it in the densest of our levels, so that no move asks the heap. */
enum { TRIANGLES_AT_FIRST = 16384 };

/* An overlap of less is rounding: far above that of a pose and of a sweep, far below the skin. */
#define OVERLAP_MIN 0x1p-20

/* ---- life ------------------------------------------------------------------------------------------------------- */

static void *array_of(const EnfAllocator *allocator, uint32_t count, size_t size, bool *ok) {
    void *array = enf_alloc(allocator, count > 0 ? count : 1, size);
    *ok = *ok && array != NULL;
    return array;
}

static size_t at_least_one(uint32_t count) {
    return count > 0 ? count : 1;
}

static bool fill(EnfCollider *c) {
    const EnfMap *map = c->map;
    bool ok = true;
    c->collides = array_of(c->allocator, map->materials_count, sizeof *c->collides, &ok);
    c->cells = array_of(c->allocator, map->cells_count, sizeof *c->cells, &ok);
    c->clusters = array_of(c->allocator, map->clusters_count, sizeof *c->clusters, &ok);
    c->stamps = array_of(c->allocator, map->clusters_count, sizeof *c->stamps, &ok);
    c->outside = array_of(c->allocator, map->cells_count, sizeof *c->outside, &ok);
    if (!ok) {
        return false;
    }
    for (uint32_t i = 0; i < map->materials_count; i++) {
        c->collides[i] = enf_material_collides(&map->materials[i]);
    }
    c->bounds = enf_box3_empty();
    for (uint32_t i = 0; i < map->cells_count; i++) {
        const EnfCell *cell = &map->cells[i];
        for (int k = 0; k < 2; k++) {
            const float *p = k == 0 ? cell->min : cell->max;
            EnfVec3 corner = enf_v3(cell->origin[0] + (double)p[0], cell->origin[1] + (double)p[1],
                                    cell->origin[2] + (double)p[2]);
            c->bounds = enf_box3_add(c->bounds, corner);
        }
        if (map->cells[i].flags & ENF_CELL_OUTSIDE) {
            c->outside[c->outside_count++] = i;
        }
    }
    return enf_collide_reserve(c, TRIANGLES_AT_FIRST);
}

EnfResult enf_collider_create(EnfCollider **out, const EnfMap *map, EnfWorld *world, const EnfAllocator *allocator,
                              EnfError *error) {
    *out = NULL;
    EnfCollider *collider = enf_alloc(allocator, 1, sizeof *collider);
    if (collider == NULL) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "a collider");
    }
    collider->map = map;
    collider->world = world;
    collider->allocator = allocator;
    collider->region = enf_box3_empty();
    collider->tick = INT64_MIN;
    EnfResult result = fill(collider) ? ENF_OK : enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "a collider");
    if (result == ENF_OK && world != NULL) {
        result = enf_collide_add_movers(collider, error);
        if (result == ENF_OK && !enf_collide_sort_solids(collider)) {
            result = enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "the solids of a collider");
        }
    }
    if (result != ENF_OK) {
        enf_collider_destroy(collider);
        return result;
    }
    *out = collider;
    return ENF_OK;
}

void enf_collider_destroy(EnfCollider *c) {
    if (c == NULL) {
        return;
    }
    const EnfAllocator *allocator = c->allocator;
    for (uint32_t i = 0; i < c->solid_count; i++) {
        enf_free(allocator, c->solids[i].corners, 3 * c->solids[i].count, sizeof *c->solids[i].corners);
    }
    enf_kd_built_free(&c->tree);
    enf_free(allocator, c->solids, c->solid_capacity, sizeof *c->solids);
    enf_free(allocator, c->near, c->solid_capacity, sizeof *c->near);
    enf_free(allocator, c->triangles, c->capacity, sizeof *c->triangles);
    enf_free(allocator, c->collides, at_least_one(c->map->materials_count), sizeof *c->collides);
    enf_free(allocator, c->cells, at_least_one(c->map->cells_count), sizeof *c->cells);
    enf_free(allocator, c->clusters, at_least_one(c->map->clusters_count), sizeof *c->clusters);
    enf_free(allocator, c->stamps, at_least_one(c->map->clusters_count), sizeof *c->stamps);
    enf_free(allocator, c->outside, at_least_one(c->map->cells_count), sizeof *c->outside);
    enf_free(allocator, c, 1, sizeof *c);
}

EnfColliderCounters enf_collider_counters(const EnfCollider *collider) {
    return collider->counters;
}

/* ---- sweeps ----------------------------------------------------------------------------------------------------- */

static EnfVec3 face_towards(EnfVec3 face, EnfVec3 side) {
    return enf_dot(face, side) < 0.0 ? enf_scale(face, -1.0) : face;
}

/* An edge belongs to several triangles: the one that faces up most decides whether it can be stood on. */
static EnfVec3 best_face(const EnfCollider *collider, const EnfSweep *sweep) {
    EnfVec3 best = face_towards(sweep->met->normal, sweep->normal), way = enf_scale(sweep->delta, sweep->contact);
    if (sweep->normal.y <= 0.0 || enf_dot(best, sweep->normal) > 1.0 - 0x1p-30) {
        return best; /* from below, or flat upon it */
    }
    EnfBox3 box = enf_capsule_box(&sweep->capsule, enf_add(sweep->from, way), ENF_TOL_SKIN);
    for (uint32_t i = 0; i < collider->count; i++) {
        const EnfNearTriangle *triangle = &collider->triangles[i];
        EnfVec3 face = face_towards(triangle->normal, sweep->normal);
        if (face.y <= best.y || triangle->solid != sweep->met->solid || !enf_box3_overlaps(box, triangle->box)) {
            continue;
        }
        EnfNearest at;
        enf_nearest(triangle, &sweep->capsule, sweep->from, way, &at);
        bool same = at.distance <= sweep->capsule.radius + 0.5 * ENF_TOL_SKIN + 4.0 * ENF_TOL_CONTACT;
        if (same && enf_dot(at.normal, sweep->normal) > 1.0 - 0x1p-12) {
            best = face;
        }
    }
    return best;
}

static void report(const EnfCollider *collider, const EnfSweep *sweep, EnfSweepHit *hit) {
    const EnfNearTriangle *met = sweep->met;
    hit->t = sweep->t;
    hit->normal = sweep->normal;
    hit->point = sweep->point;
    hit->face = best_face(collider, sweep);
    hit->cluster = met->cluster;
    hit->triangle = met->triangle;
    hit->object = met->solid == ENF_NONE ? ENF_NONE : collider->solids[met->solid].object;
}

static bool refuse(EnfVec3 delta, EnfSweepHit *hit) {
    EnfVec3 back = enf_v3_finite(delta) ? enf_normalize(enf_scale(delta, -1.0)) : enf_v3(0.0, 1.0, 0.0);
    *hit = (EnfSweepHit){0.0, back, back, {0.0, 0.0, 0.0}, ENF_NONE, ENF_NONE, ENF_NONE};
    return true;
}

/* What is numbered `only`, or everything that is not ignored (ENF_NONE). */
static bool counts(const EnfCollider *collider, const EnfNearTriangle *triangle, uint32_t only) {
    if (only != ENF_NONE) {
        return triangle->solid == only;
    }
    return triangle->solid == ENF_NONE || collider->solids[triangle->solid].ignored == 0;
}

static bool sweep_piece(EnfCollider *collider, EnfSweep *sweep, uint32_t only) {
    if (!enf_collide_gather(collider, sweep->box)) {
        return false;
    }
    for (uint32_t i = only == ENF_NONE ? 0 : collider->level_count; i < collider->count; i++) {
        if (counts(collider, &collider->triangles[i], only)) {
            enf_sweep_triangle(sweep, &collider->triangles[i]);
        }
    }
    collider->counters.sweeps++;
    collider->counters.tested += sweep->tested;
    collider->counters.steps += sweep->steps;
    return true;
}

static bool sweep_any(EnfCollider *collider, const EnfCapsule *capsule, const EnfVec3 way[2], uint32_t only, EnfSweepHit *hit) {
    EnfVec3 from = way[0], delta = way[1];
    double length = enf_v3_finite(from) && enf_v3_finite(delta) ? sqrt(enf_dot(delta, delta)) : HUGE_VAL;
    if (!(length <= PIECE * PIECES_MAX)) {
        return refuse(delta, hit);
    }
    uint32_t pieces = length > PIECE ? (uint32_t)ceil(length / PIECE) : 1;
    EnfVec3 part = pieces > 1 ? enf_scale(delta, 1.0 / (double)pieces) : delta;
    for (uint32_t i = 0; i < pieces; i++) {
        EnfSweep sweep = enf_sweep_make(capsule, enf_add(from, enf_scale(part, (double)i)), part);
        if (!sweep_piece(collider, &sweep, only)) {
            (void)refuse(delta, hit);
            hit->t = (double)i / (double)pieces;
            return true;
        }
        if (sweep.met != NULL) {
            report(collider, &sweep, hit);
            hit->t = pieces > 1 ? ((double)i + hit->t) / (double)pieces : hit->t;
            return true;
        }
    }
    *hit = (EnfSweepHit){1.0, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, ENF_NONE, ENF_NONE, ENF_NONE};
    return false;
}

bool enf_collide_sweep(EnfCollider *collider, const EnfCapsule *capsule, EnfVec3 from_ws, EnfVec3 delta, EnfSweepHit *hit) {
    const EnfVec3 way[2] = {from_ws, delta};
    return sweep_any(collider, capsule, way, ENF_NONE, hit);
}

bool enf_collide_sweep_solid(EnfCollider *collider, const EnfCapsule *capsule, EnfVec3 from_ws, EnfVec3 delta, uint32_t solid,
                             EnfSweepHit *hit) {
    const EnfVec3 way[2] = {from_ws, delta};
    return sweep_any(collider, capsule, way, solid, hit);
}

/* ---- overlap ---------------------------------------------------------------------------------------------------- */

bool enf_collide_overlap(EnfCollider *collider, const EnfCapsule *capsule, EnfVec3 at_ws, EnfOverlap *out) {
    EnfOverlap deepest = {0.0, {0.0, 1.0, 0.0}, ENF_NONE, ENF_NONE, ENF_NONE};
    EnfBox3 box = enf_capsule_box(capsule, at_ws, 0.0);
    bool gathered = enf_v3_finite(at_ws) && enf_collide_gather(collider, box);
    for (uint32_t i = 0; gathered && i < collider->count; i++) {
        const EnfNearTriangle *triangle = &collider->triangles[i];
        if (!counts(collider, triangle, ENF_NONE) || !enf_box3_overlaps(box, triangle->box)) {
            continue;
        }
        EnfNearest nearest;
        enf_nearest(triangle, capsule, at_ws, enf_v3(0.0, 0.0, 0.0), &nearest);
        double depth = capsule->radius - nearest.distance;
        if (depth > deepest.depth) {
            uint32_t object = triangle->solid == ENF_NONE ? ENF_NONE : collider->solids[triangle->solid].object;
            deepest = (EnfOverlap){depth, nearest.normal, triangle->cluster, triangle->triangle, object};
        }
    }
    if (!gathered) { /* unknown: as if deep inside */
        deepest.depth = capsule->radius;
    }
    if (out != NULL) {
        *out = deepest;
    }
    return deepest.depth > OVERLAP_MIN;
}

uint32_t enf_collide_ignore_overlapped(EnfCollider *collider, const EnfCapsule *capsule, EnfVec3 at_ws) {
    EnfBox3 box = enf_capsule_box(capsule, at_ws, 0.0);
    uint32_t ignored = 0;
    bool gathered = enf_collide_gather(collider, box);
    for (uint32_t i = collider->level_count; gathered && i < collider->count; i++) {
        const EnfNearTriangle *triangle = &collider->triangles[i];
        if (collider->solids[triangle->solid].ignored != 0 || !enf_box3_overlaps(box, triangle->box)) {
            continue;
        }
        EnfNearest nearest;
        enf_nearest(triangle, capsule, at_ws, enf_v3(0.0, 0.0, 0.0), &nearest);
        if (capsule->radius - nearest.distance > OVERLAP_MIN) {
            enf_collide_ignore(collider, triangle->solid, ENF_IGNORED_OVERLAPPED);
            ignored++;
        }
    }
    return ignored;
}

void enf_collide_ignore(EnfCollider *collider, uint32_t solid, uint8_t why) {
    collider->solids[solid].ignored |= why;
    collider->ignored |= why;
}

void enf_collide_heed(EnfCollider *collider, uint8_t why) {
    for (uint32_t i = 0; (collider->ignored & why) != 0 && i < collider->solid_count; i++) {
        collider->solids[i].ignored &= (uint8_t)~why;
    }
    collider->ignored &= (uint8_t)~why;
}
