/* Vectors, matrices, boxes, deterministic trigonometry, exact predicates. Doubles for the world, floats for storage.
 *
 * Space convention (DESIGN §2): right-handed, +Y up, metres; matrices are column-major and multiply column vectors. */
#ifndef ENFILADE_MATH_H
#define ENFILADE_MATH_H

#include <enfilade/base.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ENF_PI 3.14159265358979323846

typedef struct EnfVec3 {
    double x, y, z;
} EnfVec3;
typedef struct EnfVec3f {
    float x, y, z;
} EnfVec3f;
typedef struct EnfQuat {
    double x, y, z, w;
} EnfQuat;
/** Axis-aligned box in world or cell space; empty when min > max. */
typedef struct EnfBox3 {
    EnfVec3 min, max;
} EnfBox3;
typedef struct EnfBox3f {
    EnfVec3f min, max;
} EnfBox3f;
/** n·p + d = 0; n is unit length unless said otherwise. */
typedef struct EnfPlane {
    EnfVec3 n;
    double d;
} EnfPlane;
/** An affine map: p' = m p + t, m column-major (m[3*c + r]). Rigid motions, reflections and node transforms. */
typedef struct EnfAffine {
    double m[9];
    EnfVec3 t;
} EnfAffine;
typedef struct EnfMat4 {
    double m[16];
} EnfMat4; /**< column-major */
typedef struct EnfMat4f {
    float m[16];
} EnfMat4f;

static inline EnfVec3 enf_v3(double x, double y, double z) {
    EnfVec3 v = {x, y, z};
    return v;
}
static inline EnfVec3 enf_v3_from_f(EnfVec3f a) {
    return enf_v3((double)a.x, (double)a.y, (double)a.z);
}
static inline EnfVec3f enf_v3f(EnfVec3 a) {
    EnfVec3f v = {(float)a.x, (float)a.y, (float)a.z};
    return v;
}
static inline EnfVec3 enf_add(EnfVec3 a, EnfVec3 b) {
    return enf_v3(a.x + b.x, a.y + b.y, a.z + b.z);
}
static inline EnfVec3 enf_sub(EnfVec3 a, EnfVec3 b) {
    return enf_v3(a.x - b.x, a.y - b.y, a.z - b.z);
}
static inline EnfVec3 enf_scale(EnfVec3 a, double s) {
    return enf_v3(a.x * s, a.y * s, a.z * s);
}
static inline double enf_dot(EnfVec3 a, EnfVec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline EnfVec3 enf_cross(EnfVec3 a, EnfVec3 b) {
    return enf_v3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
double enf_length(EnfVec3 a);
EnfVec3 enf_normalize(EnfVec3 a); /**< zero stays zero; safe against overflow and underflow */
bool enf_v3_finite(EnfVec3 a);

/* Own sine, cosine and arc tangent: the same bits on every machine and compiler; |error| ≤ 2 ulp for |x| ≤ 2^20. */
double enf_sin(double radians);
double enf_cos(double radians);
double enf_tan(double radians);
double enf_atan2(double y, double x);

EnfBox3 enf_box3_empty(void);
EnfBox3 enf_box3_add(EnfBox3 box, EnfVec3 p);
EnfBox3 enf_box3_union(EnfBox3 a, EnfBox3 b);
bool enf_box3_is_empty(EnfBox3 box);
bool enf_box3_contains(EnfBox3 box, EnfVec3 p); /**< closed */
bool enf_box3_overlaps(EnfBox3 a, EnfBox3 b);   /**< closed: touching counts */
/** Rounded outward to float: contains `box`. @guarantee tests/unit/test_math */
EnfBox3f enf_box3f_outward(EnfBox3 box);
EnfBox3 enf_box3_from_f(EnfBox3f box);
float enf_round_down(double value); /**< the largest float ≤ value (−FLT_MAX for less) */
float enf_round_up(double value);

EnfAffine enf_affine_identity(void);
EnfAffine enf_affine_mul(EnfAffine a, EnfAffine b); /**< a after b */
EnfAffine enf_affine_trs(EnfVec3 t, EnfQuat r, EnfVec3 s);
EnfVec3 enf_affine_point(const EnfAffine *a, EnfVec3 p);
EnfVec3 enf_affine_vector(const EnfAffine *a, EnfVec3 v);
double enf_affine_det(const EnfAffine *a);
/** False, and the identity, if singular. */
bool enf_affine_inverse(const EnfAffine *a, EnfAffine *out);
EnfQuat enf_quat_axis_angle(EnfVec3 axis, double radians);
EnfQuat enf_quat_mul(EnfQuat a, EnfQuat b);

/** Newell's plane of a polygon (exact for planar ones, least-squares-like otherwise), normal by the right-hand rule. A
 *  degenerate polygon gives n = 0. */
EnfPlane enf_plane_from_polygon(const EnfVec3 *points, uint32_t count);

/* Exact predicates on the compiler's grid: coordinates are integers in units of 2^-12 m, |x| ≤ 2^40. Source: determinants
 * in __int128, no rounding anywhere. */
typedef struct EnfGrid3 {
    int64_t x, y, z;
} EnfGrid3;
/** Sign of det(b-a, c-a, d-a): +1 if d lies on the side that the right-hand normal of (a,b,c) points to; 0 coplanar.
 *  @guarantee exact for |differences| ≤ 2^40; tests/property/test_predicates (113-bit and 256-bit twins). */
int enf_orient3(EnfGrid3 a, EnfGrid3 b, EnfGrid3 c, EnfGrid3 d);
/** The grid point nearest to `p` (ties to even), clamped to ±2^40. */
EnfGrid3 enf_grid_snap(EnfVec3 p);
EnfVec3 enf_grid_point(EnfGrid3 g); /**< exact */

#ifdef __cplusplus
}
#endif
#endif
