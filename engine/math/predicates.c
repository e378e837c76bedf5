/* Exact predicates on the compiler's grid: after a level is snapped once, every side is decided without rounding
 * (PITFALLS 26: no second tolerance). */
#include <enfilade/math.h>
#include <enfilade/tolerances.h>

#include <math.h>

__extension__ typedef __int128 Int128;

/* Coordinates are clamped to this by enf_grid_snap: 2^28 m. */
#define GRID_LIMIT 0x1p40

/* Coordinates of at most 2^40 have differences of at most 2^41. A minor is two products of two differences, at most
 * 2 * 2^82 = 2^83; a term is a minor times a difference, at most 2^124; three of them are below 2^126 < 2^127. So no
 * intermediate value overflows 128 bits. */
int enf_orient3(EnfGrid3 a, EnfGrid3 b, EnfGrid3 c, EnfGrid3 d) {
    int64_t ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    int64_t vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    int64_t wx = d.x - a.x, wy = d.y - a.y, wz = d.z - a.z;
    Int128 nx = (Int128)uy * vz - (Int128)uz * vy;
    Int128 ny = (Int128)uz * vx - (Int128)ux * vz;
    Int128 nz = (Int128)ux * vy - (Int128)uy * vx;
    Int128 det = nx * wx + ny * wy + nz * wz;
    return (det > 0) - (det < 0);
}

static int64_t snap(double metres) {
    double steps = metres * (1.0 / ENF_GRID_STEP); /* a power of two: exact */
    if (!(steps > -GRID_LIMIT)) {
        return isnan(steps) ? 0 : -(int64_t)GRID_LIMIT;
    }
    return steps >= GRID_LIMIT ? (int64_t)GRID_LIMIT : (int64_t)rint(steps);
}

EnfGrid3 enf_grid_snap(EnfVec3 p) {
    EnfGrid3 g = {snap(p.x), snap(p.y), snap(p.z)};
    return g;
}

EnfVec3 enf_grid_point(EnfGrid3 g) {
    return enf_v3((double)g.x * ENF_GRID_STEP, (double)g.y * ENF_GRID_STEP, (double)g.z * ENF_GRID_STEP);
}
