/* The oracle of collision: see the header. */
#include "scenes/solid_oracle.h"

#include <enfilade/tolerances.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ORACLE_STEP 2.0 /* metres */

/* ---- building --------------------------------------------------------------------------------------------------- */

/* The rule of the header, told again. */
static bool oracle_collides(const EnfMaterial *m) {
    bool seen = !(m->flags & ENF_MATERIAL_NODRAW) && m->alpha_mode != ENF_ALPHA_BLEND;
    return !(m->flags & ENF_MATERIAL_NOCOLLIDE) && (seen || (m->flags & ENF_MATERIAL_CLIP));
}

static uint32_t oracle_clamp(double x, uint32_t size) {
    double i = floor(x);
    return i < 0.0 ? 0 : (i >= (double)size ? size - 1 : (uint32_t)i);
}

static void oracle_range(const EnfOracle *o, const EnfBox3 *box, uint32_t low[3], uint32_t high[3]) {
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

static bool oracle_grid(EnfOracle *o) {
    uint32_t low[3], high[3], boxes = 1;
    EnfVec3 size = enf_sub(o->bounds.max, o->bounds.min);
    const double sizes[3] = {size.x, size.y, size.z};
    for (int i = 0; i < 3; i++) {
        o->size[i] = (uint32_t)(sizes[i] / ORACLE_STEP) + 1;
        boxes *= o->size[i];
    }
    o->starts = calloc(boxes + 2, sizeof *o->starts);
    if (o->starts == NULL) {
        return false;
    }
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
    if (o->items == NULL) {
        return false;
    }
    for (uint32_t t = 0; t < o->count; t++) {
        oracle_range(o, &o->triangles[t].box, low, high);
        ORACLE_EACH(o, low, high, at) {
            o->items[o->starts[at + 1]++] = t;
        }
    }
    return true;
}

void enf_oracle_free(EnfOracle *o) {
    free(o->triangles);
    free(o->starts);
    free(o->items);
    free(o->stamps);
    free(o->near);
    memset(o, 0, sizeof *o);
}

static void oracle_add(EnfOracle *o, const EnfMap *map, uint32_t c) {
    const EnfCluster *cluster = &map->clusters[c];
    const double *origin = map->cells[cluster->cell].origin;
    for (uint32_t i = 0; i < cluster->index_count / 3; i++) {
        EnfOracleTriangle *t = &o->triangles[o->count++];
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

bool enf_oracle_build(EnfOracle *o, const EnfMap *map) {
    memset(o, 0, sizeof *o);
    o->bounds = enf_box3_empty();
    o->triangles = calloc(map->indices_count / 3 + 1, sizeof *o->triangles);
    for (uint32_t c = 0; o->triangles != NULL && c < map->clusters_count; c++) {
        if (oracle_collides(&map->materials[map->clusters[c].material])) {
            oracle_add(o, map, c);
        }
    }
    o->stamps = calloc(o->count + 1, sizeof *o->stamps);
    o->near = calloc(o->count + 1, sizeof *o->near);
    bool ok = o->count > 0 && o->stamps != NULL && o->near != NULL && oracle_grid(o);
    if (!ok) {
        enf_oracle_free(o);
    }
    return ok;
}

/* Triangles whose boxes touch `box`: by the grid, or by looking at every one. */
void enf_oracle_near(EnfOracle *o, EnfBox3 box, bool every) {
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

static double oracle_clamp01(double x) {
    return x < 0.0 ? 0.0 : (x > 1.0 ? 1.0 : x);
}

/* Two segments: Ericson, Real-Time Collision Detection, 5.1.9. Squared. */
static double oracle_segments(EnfVec3 p1, EnfVec3 q1, EnfVec3 p2, EnfVec3 q2) {
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
static double oracle_face(EnfVec3 p, const EnfVec3 c[3]) {
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
static bool oracle_pierces(EnfVec3 p, EnfVec3 q, const EnfVec3 c[3]) {
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
double enf_oracle_distance(const EnfOracleTriangle *t, const EnfCapsule *capsule, EnfVec3 at) {
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

static EnfVec3 oracle_at(const EnfOracleMove *move, double t) {
    return enf_add(move->from, enf_scale(move->delta, t));
}

/* Golden section: of a convex function the least lies between two that rise. */
double enf_oracle_least(const EnfOracleTriangle *t, const EnfOracleMove *move, double *where) {
    static const double golden = 0.6180339887498949;
    double a = 0.0, b = 1.0, x = 1.0 - golden, y = golden;
    double fx = enf_oracle_distance(t, &move->capsule, oracle_at(move, x));
    double fy = enf_oracle_distance(t, &move->capsule, oracle_at(move, y));
    for (int i = 0; i < 50; i++) {
        if (fx <= fy) {
            b = y;
            y = x;
            fy = fx;
            x = b - golden * (b - a);
            fx = enf_oracle_distance(t, &move->capsule, oracle_at(move, x));
        } else {
            a = x;
            x = y;
            fx = fy;
            y = a + golden * (b - a);
            fy = enf_oracle_distance(t, &move->capsule, oracle_at(move, y));
        }
    }
    double start = enf_oracle_distance(t, &move->capsule, move->from);
    double end = enf_oracle_distance(t, &move->capsule, oracle_at(move, 1.0)), least = fmin(fx, fy);
    *where = fx < fy ? x : y;
    *where = end < least ? 1.0 : *where;
    least = fmin(least, end);
    *where = start <= least ? 0.0 : *where;
    return fmin(least, start);
}

/* The first part of [0, far] at which the distance is `wanted` or less; it falls all the way to `far`, where it is. */
static double oracle_first(const EnfOracleTriangle *t, const EnfOracleMove *move, double wanted, double far) {
    double low = 0.0, high = far;
    if (enf_oracle_distance(t, &move->capsule, move->from) <= wanted) {
        return 0.0;
    }
    for (int i = 0; i < 60; i++) {
        double middle = 0.5 * (low + high);
        bool there = enf_oracle_distance(t, &move->capsule, oracle_at(move, middle)) <= wanted;
        low = there ? low : middle;
        high = there ? middle : high;
    }
    return high;
}

bool enf_oracle_sweep(const EnfOracle *o, const EnfOracleMove *move, double *free) {
    double contact = move->capsule.radius + 0.5 * ENF_TOL_SKIN, first = 2.0;
    *free = 1.0;
    for (uint32_t i = 0; i < o->near_count; i++) {
        const EnfOracleTriangle *t = &o->triangles[o->near[i]];
        double where, least = enf_oracle_least(t, move, &where);
        if (where <= 0.0 || least > contact) {
            continue; /* it moves away, or passes clear */
        }
        double met = oracle_first(t, move, contact, where);
        if (met < first) {
            first = met;
            *free = oracle_first(t, move, move->capsule.radius + ENF_TOL_SKIN, where);
        }
    }
    return first <= 1.0;
}

EnfBox3 enf_oracle_box(const EnfCapsule *capsule, EnfVec3 from, EnfVec3 delta) {
    double side = capsule->radius + 0.01;
    EnfBox3 box = enf_box3_add(enf_box3_add(enf_box3_empty(), from), enf_add(from, delta));
    box.min = enf_sub(box.min, enf_v3(side, 0.01, side));
    box.max = enf_add(box.max, enf_v3(side, capsule->height + 0.01, side));
    return box;
}

/* Of the triangles that oracle_near found: how deep is the capsule in the deepest? <= 0: in none. */
double enf_oracle_depth(const EnfOracle *o, const EnfCapsule *capsule, EnfVec3 at) {
    double depth = -HUGE_VAL;
    for (uint32_t i = 0; i < o->near_count; i++) {
        depth = fmax(depth, capsule->radius - enf_oracle_distance(&o->triangles[o->near[i]], capsule, at));
    }
    return depth;
}

/* Does a straight move carry the axis (its ends and its middle) through a surface? */
bool enf_oracle_tunnels(const EnfOracle *o, const EnfCapsule *capsule, EnfVec3 from, EnfVec3 to) {
    const double heights[3] = {capsule->radius, 0.5 * capsule->height, capsule->height - capsule->radius};
    for (uint32_t i = 0; i < o->near_count; i++) {
        const EnfOracleTriangle *t = &o->triangles[o->near[i]];
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
