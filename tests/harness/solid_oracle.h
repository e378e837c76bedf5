/* The oracle of collision: every triangle of a map that collides, in a plain grid of its own (no cell, no kd-tree), and distances
 * by the general formulas for any segment and triangle. Convexity of the distance along a straight move makes its least exact. */
#ifndef ENF_TESTS_SOLID_ORACLE_H
#define ENF_TESTS_SOLID_ORACLE_H

#include "harness/harness.h"

#include <enfilade/collide.h>
#include <enfilade/tolerances.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ORACLE_STEP 2.0 /* metres */

typedef struct OracleTriangle {
    EnfVec3 corner[3];
    EnfBox3 box;
    uint32_t cluster, triangle;
} OracleTriangle;

typedef struct Oracle {
    OracleTriangle *triangles;
    uint32_t count;
    EnfBox3 bounds;
    uint32_t size[3];
    uint32_t *starts, *items; /* of each grid box: items[starts[i] .. starts[i + 1]) */
    uint32_t *stamps, stamp;
    uint32_t *near, near_count;
} Oracle;

/* ---- building --------------------------------------------------------------------------------------------------- */

/* The rule of the header, told again. */
static inline bool oracle_collides(const EnfMaterial *m) {
    bool seen = !(m->flags & ENF_MATERIAL_NODRAW) && m->alpha_mode != ENF_ALPHA_BLEND;
    return !(m->flags & ENF_MATERIAL_NOCOLLIDE) && (seen || (m->flags & ENF_MATERIAL_CLIP));
}

static inline uint32_t oracle_clamp(double x, uint32_t size) {
    double i = floor(x);
    return i < 0.0 ? 0 : (i >= (double)size ? size - 1 : (uint32_t)i);
}

static inline void oracle_range(const Oracle *o, const EnfBox3 *box, uint32_t low[3], uint32_t high[3]) {
    const double a[3] = {box->min.x - o->bounds.min.x, box->min.y - o->bounds.min.y, box->min.z - o->bounds.min.z};
    const double b[3] = {box->max.x - o->bounds.min.x, box->max.y - o->bounds.min.y, box->max.z - o->bounds.min.z};
    for (int i = 0; i < 3; i++) {
        low[i] = oracle_clamp(a[i] / ORACLE_STEP, o->size[i]);
        high[i] = oracle_clamp(b[i] / ORACLE_STEP, o->size[i]);
    }
}

#define ORACLE_EACH(o, low, high, at)                                                                                          \
    for (uint32_t z_ = (low)[2]; z_ <= (high)[2]; z_++)                                                                        \
        for (uint32_t y_ = (low)[1]; y_ <= (high)[1]; y_++)                                                                    \
            for (uint32_t x_ = (low)[0], at = (z_ * (o)->size[1] + y_) * (o)->size[0] + x_; x_ <= (high)[0]; x_++, at++)

static inline void oracle_grid(Oracle *o) {
    uint32_t low[3], high[3], boxes = 1;
    EnfVec3 size = enf_sub(o->bounds.max, o->bounds.min);
    const double sizes[3] = {size.x, size.y, size.z};
    for (int i = 0; i < 3; i++) {
        o->size[i] = (uint32_t)(sizes[i] / ORACLE_STEP) + 1;
        boxes *= o->size[i];
    }
    o->starts = calloc(boxes + 2, sizeof *o->starts);
    assert_non_null(o->starts);
    for (uint32_t t = 0; t < o->count; t++) {
        oracle_range(o, &o->triangles[t].box, low, high);
        ORACLE_EACH(o, low, high, at) {
            o->starts[at + 2]++;
        }
    }
    for (uint32_t i = 1; i < boxes + 2; i++) {
        o->starts[i] += o->starts[i - 1];
    }
    o->items = calloc(o->starts[boxes + 1] + 1, sizeof *o->items);
    assert_non_null(o->items);
    for (uint32_t t = 0; t < o->count; t++) {
        oracle_range(o, &o->triangles[t].box, low, high);
        ORACLE_EACH(o, low, high, at) {
            o->items[o->starts[at + 1]++] = t;
        }
    }
}

static inline void oracle_build(Oracle *o, const EnfMap *map) {
    memset(o, 0, sizeof *o);
    o->bounds = enf_box3_empty();
    o->triangles = calloc(map->indices_count / 3 + 1, sizeof *o->triangles);
    assert_non_null(o->triangles);
    for (uint32_t c = 0; c < map->clusters_count; c++) {
        const EnfCluster *cluster = &map->clusters[c];
        const double *origin = map->cells[cluster->cell].origin;
        for (uint32_t i = 0; i < cluster->index_count / 3 && oracle_collides(&map->materials[cluster->material]); i++) {
            OracleTriangle *t = &o->triangles[o->count++];
            t->cluster = c;
            t->triangle = i;
            t->box = enf_box3_empty();
            for (uint32_t k = 0; k < 3; k++) {
                const float *p = map->vertices[map->indices[cluster->index_first + 3 * i + k]].position;
                t->corner[k] = enf_v3(origin[0] + (double)p[0], origin[1] + (double)p[1], origin[2] + (double)p[2]);
                t->box = enf_box3_add(t->box, t->corner[k]);
            }
            o->bounds = enf_box3_union(o->bounds, t->box);
        }
    }
    o->stamps = calloc(o->count + 1, sizeof *o->stamps);
    o->near = calloc(o->count + 1, sizeof *o->near);
    assert_true(o->count > 0 && o->stamps && o->near);
    oracle_grid(o);
}

static inline void oracle_free(Oracle *o) {
    free(o->triangles);
    free(o->starts);
    free(o->items);
    free(o->stamps);
    free(o->near);
}

/* Triangles whose boxes touch `box`: by the grid, or by looking at every one. */
static inline void oracle_near(Oracle *o, EnfBox3 box, bool every) {
    o->near_count = 0;
    o->stamp++;
    for (uint32_t t = 0; every && t < o->count; t++) {
        if (enf_box3_overlaps(o->triangles[t].box, box)) {
            o->near[o->near_count++] = t;
        }
    }
    if (every || !enf_box3_overlaps(o->bounds, box)) {
        return;
    }
    uint32_t low[3], high[3];
    oracle_range(o, &box, low, high);
    ORACLE_EACH(o, low, high, at) {
        for (uint32_t i = o->starts[at]; i < o->starts[at + 1]; i++) {
            uint32_t t = o->items[i];
            if (o->stamps[t] != o->stamp && enf_box3_overlaps(o->triangles[t].box, box)) {
                o->near[o->near_count++] = t;
            }
            o->stamps[t] = o->stamp;
        }
    }
}

/* ---- distances -------------------------------------------------------------------------------------------------- */

static inline double oracle_clamp01(double x) {
    return x < 0.0 ? 0.0 : (x > 1.0 ? 1.0 : x);
}

/* Two segments: Ericson, Real-Time Collision Detection, 5.1.9. Squared. */
static inline double oracle_segments(EnfVec3 p1, EnfVec3 q1, EnfVec3 p2, EnfVec3 q2) {
    EnfVec3 d1 = enf_sub(q1, p1), d2 = enf_sub(q2, p2), r = enf_sub(p1, p2);
    double a = enf_dot(d1, d1), e = enf_dot(d2, d2), f = enf_dot(d2, r), s = 0.0, t = 0.0;
    if (a > 0.0 && e > 0.0) {
        double c = enf_dot(d1, r), b = enf_dot(d1, d2), denominator = a * e - b * b;
        s = denominator > 0.0 ? oracle_clamp01((b * f - c * e) / denominator) : 0.0;
        t = (b * s + f) / e;
        if (t < 0.0 || t > 1.0) {
            t = oracle_clamp01(t);
            s = oracle_clamp01((b * t - c) / a);
        }
    } else if (e > 0.0) {
        t = oracle_clamp01(f / e);
    } else if (a > 0.0) {
        s = oracle_clamp01(-enf_dot(d1, r) / a);
    }
    EnfVec3 apart = enf_sub(enf_add(p1, enf_scale(d1, s)), enf_add(p2, enf_scale(d2, t)));
    return enf_dot(apart, apart);
}

/* A point's foot within the triangle: its distance to the plane, squared; else huge. By areas. */
static inline double oracle_face(EnfVec3 p, const EnfVec3 c[3]) {
    EnfVec3 n = enf_cross(enf_sub(c[1], c[0]), enf_sub(c[2], c[0]));
    double square = enf_dot(n, n), side = enf_dot(n, enf_sub(p, c[0]));
    for (int i = 0; i < 3; i++) {
        EnfVec3 a = enf_sub(c[i], p), b = enf_sub(c[(i + 1) % 3], p);
        if (enf_dot(enf_cross(a, b), n) < 0.0) {
            return HUGE_VAL;
        }
    }
    return square > 0.0 ? side * side / square : HUGE_VAL;
}

/* Does the segment pass through the triangle? By the signs of volumes. */
static inline bool oracle_pierces(EnfVec3 p, EnfVec3 q, const EnfVec3 c[3]) {
    EnfVec3 n = enf_cross(enf_sub(c[1], c[0]), enf_sub(c[2], c[0])), d = enf_sub(q, p);
    double before = enf_dot(n, enf_sub(p, c[0])), after = enf_dot(n, enf_sub(q, c[0]));
    if ((before > 0.0) == (after > 0.0)) {
        return false;
    }
    double turn = before > 0.0 ? -1.0 : 1.0;
    for (int i = 0; i < 3; i++) {
        EnfVec3 a = enf_sub(c[i], p), b = enf_sub(c[(i + 1) % 3], p);
        if (turn * enf_dot(d, enf_cross(a, b)) < 0.0) {
            return false;
        }
    }
    return true;
}

/* From the axis of an upright capsule with its feet at `at` to a triangle. */
static inline double oracle_distance(const OracleTriangle *t, const EnfCapsule *capsule, EnfVec3 at) {
    EnfVec3 low = enf_v3(at.x, at.y + capsule->radius, at.z),
            high = enf_v3(at.x, at.y + capsule->height - capsule->radius, at.z);
    EnfVec3 c[3], length = enf_sub(high, low), zero = enf_v3(0.0, 0.0, 0.0);
    for (int i = 0; i < 3; i++) {
        c[i] = enf_sub(t->corner[i], low); /* about the axis, so that nothing is lost far from the origin */
    }
    if (oracle_pierces(zero, length, c)) {
        return 0.0;
    }
    double least = fmin(oracle_face(zero, c), oracle_face(length, c));
    for (int i = 0; i < 3; i++) {
        least = fmin(least, oracle_segments(zero, length, c[i], c[(i + 1) % 3]));
    }
    return sqrt(least);
}

/* The least distance along a straight move: it is convex, so its least lies between two that rise (golden section). */
static inline double oracle_least(const OracleTriangle *t, const EnfCapsule *capsule, EnfVec3 from, EnfVec3 delta,
                                  double *where) {
    static const double golden = 0.6180339887498949;
    double a = 0.0, b = 1.0, x = 1.0 - golden, y = golden;
    double fx = oracle_distance(t, capsule, enf_add(from, enf_scale(delta, x)));
    double fy = oracle_distance(t, capsule, enf_add(from, enf_scale(delta, y)));
    for (int i = 0; i < 50; i++) {
        if (fx <= fy) {
            b = y;
            y = x;
            fy = fx;
            x = b - golden * (b - a);
            fx = oracle_distance(t, capsule, enf_add(from, enf_scale(delta, x)));
        } else {
            a = x;
            x = y;
            fx = fy;
            y = a + golden * (b - a);
            fy = oracle_distance(t, capsule, enf_add(from, enf_scale(delta, y)));
        }
    }
    double ends[2] = {oracle_distance(t, capsule, from), oracle_distance(t, capsule, enf_add(from, delta))};
    double least = fmin(fx, fy);
    *where = fx < fy ? x : y;
    if (ends[0] <= least) {
        least = ends[0];
        *where = 0.0;
    }
    if (ends[1] < least) {
        least = ends[1];
        *where = 1.0;
    }
    return least;
}

/* Of the triangles that oracle_near found: how deep is the capsule in the deepest? <= 0: in none. */
static inline double oracle_depth(const Oracle *o, const EnfCapsule *capsule, EnfVec3 at) {
    double depth = -HUGE_VAL;
    for (uint32_t i = 0; i < o->near_count; i++) {
        depth = fmax(depth, capsule->radius - oracle_distance(&o->triangles[o->near[i]], capsule, at));
    }
    return depth;
}

/* Does a straight move carry the axis (its ends and its middle) through a surface? */
static inline bool oracle_tunnels(const Oracle *o, const EnfCapsule *capsule, EnfVec3 from, EnfVec3 to) {
    const double heights[3] = {capsule->radius, 0.5 * capsule->height, capsule->height - capsule->radius};
    for (uint32_t i = 0; i < o->near_count; i++) {
        const OracleTriangle *t = &o->triangles[o->near[i]];
        for (int k = 0; k < 3; k++) {
            EnfVec3 base = enf_v3(from.x, from.y + heights[k], from.z);
            EnfVec3 c[3] = {enf_sub(t->corner[0], base), enf_sub(t->corner[1], base), enf_sub(t->corner[2], base)};
            if (oracle_pierces(enf_v3(0.0, 0.0, 0.0), enf_sub(to, from), c)) {
                return true;
            }
        }
    }
    return false;
}

#endif
