/* Exact integer geometry on the grid, beyond the orientation predicate of <enfilade/math.h>: cross and dot products. */
#ifndef ENFILADE_COMPILE_EXACT_H
#define ENFILADE_COMPILE_EXACT_H

#include <enfilade/math.h>

__extension__ typedef __int128 EnfInt128;

/** Edges below this (in grid steps; 2^29 steps are 131 km) keep the differences of a triangle's points within 2^30, their cross
 *  products within 2^61 and the dot products of these within 2^124, so that 64 and 128 bits suffice. Longer edges are legal,
 *  but are not welded. */
#define ENF_EXACT_LENGTH ((int64_t)1 << 29)

static inline EnfGrid3 enf_grid_sub(EnfGrid3 a, EnfGrid3 b) {
    return (EnfGrid3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline bool enf_grid_equal(EnfGrid3 a, EnfGrid3 b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/** Ascending by x, y, z. */
static inline int enf_grid_compare(EnfGrid3 a, EnfGrid3 b) {
    if (a.x != b.x) {
        return a.x < b.x ? -1 : 1;
    }
    if (a.y != b.y) {
        return a.y < b.y ? -1 : 1;
    }
    return (a.z > b.z) - (a.z < b.z);
}

static inline bool enf_grid_short(EnfGrid3 d) {
    return d.x < ENF_EXACT_LENGTH && d.x > -ENF_EXACT_LENGTH && d.y < ENF_EXACT_LENGTH && d.y > -ENF_EXACT_LENGTH &&
           d.z < ENF_EXACT_LENGTH && d.z > -ENF_EXACT_LENGTH;
}

/** u · v for short vectors. */
static inline int64_t enf_grid_dot(EnfGrid3 u, EnfGrid3 v) {
    return u.x * v.x + u.y * v.y + u.z * v.z;
}

/** u × v for short vectors. */
static inline EnfGrid3 enf_grid_cross(EnfGrid3 u, EnfGrid3 v) {
    return (EnfGrid3){u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

/** u · v of two cross products of short vectors. */
static inline EnfInt128 enf_grid_dot_wide(EnfGrid3 u, EnfGrid3 v) {
    return (EnfInt128)u.x * v.x + (EnfInt128)u.y * v.y + (EnfInt128)u.z * v.z;
}

/** Have the three points no area? Exact for all points of the grid. */
static inline bool enf_grid_collinear(EnfGrid3 a, EnfGrid3 b, EnfGrid3 c) {
    EnfGrid3 u = enf_grid_sub(b, a), v = enf_grid_sub(c, a);
    return (EnfInt128)u.y * v.z == (EnfInt128)u.z * v.y && (EnfInt128)u.z * v.x == (EnfInt128)u.x * v.z &&
           (EnfInt128)u.x * v.y == (EnfInt128)u.y * v.x;
}

#endif
