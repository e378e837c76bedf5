/* Vectors, boxes, planes: the small pieces that are too long for the header. */
#include <enfilade/math.h>

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- vectors ---------------------------------------------------------------------------------------------------- */

static double largest_component(EnfVec3 a) {
    return fmax(fmax(fabs(a.x), fabs(a.y)), fabs(a.z));
}

/* A power of two that brings `size` to where squares neither overflow nor lose bits. 2^600 lifts the least subnormal
 * (2^-1074) and lowers the largest double alike; scaling by it is exact. */
static double safe_scale(double size) {
    return size > 0x1p500 ? 0x1p-600 : size < 0x1p-400 ? 0x1p600 : 1.0;
}

double enf_length(EnfVec3 a) {
    double scale = safe_scale(largest_component(a));
    EnfVec3 b = enf_scale(a, scale);
    return sqrt(enf_dot(b, b)) / scale;
}

EnfVec3 enf_normalize(EnfVec3 a) {
    double size = largest_component(a);
    if (!(size > 0.0) || !enf_v3_finite(a)) {
        return enf_v3(0.0, 0.0, 0.0);
    }
    EnfVec3 b = enf_scale(a, safe_scale(size));
    double length = sqrt(enf_dot(b, b));
    return enf_v3(b.x / length, b.y / length, b.z / length);
}

bool enf_v3_finite(EnfVec3 a) {
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

/* ---- boxes ------------------------------------------------------------------------------------------------------ */

EnfBox3 enf_box3_empty(void) {
    EnfBox3 box = {{DBL_MAX, DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX, -DBL_MAX}};
    return box;
}

static EnfVec3 min_each(EnfVec3 a, EnfVec3 b) {
    return enf_v3(a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z);
}

static EnfVec3 max_each(EnfVec3 a, EnfVec3 b) {
    return enf_v3(a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z);
}

EnfBox3 enf_box3_add(EnfBox3 box, EnfVec3 p) {
    EnfBox3 sum = {min_each(box.min, p), max_each(box.max, p)};
    return sum;
}

EnfBox3 enf_box3_union(EnfBox3 a, EnfBox3 b) {
    if (enf_box3_is_empty(a)) {
        return b;
    }
    if (enf_box3_is_empty(b)) {
        return a;
    }
    EnfBox3 sum = {min_each(a.min, b.min), max_each(a.max, b.max)};
    return sum;
}

bool enf_box3_is_empty(EnfBox3 box) {
    return box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z;
}

bool enf_box3_contains(EnfBox3 box, EnfVec3 p) {
    return p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y && p.y <= box.max.y && p.z >= box.min.z && p.z <= box.max.z;
}

bool enf_box3_overlaps(EnfBox3 a, EnfBox3 b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y && a.min.z <= b.max.z &&
           b.min.z <= a.max.z;
}

/* ---- rounding outward ------------------------------------------------------------------------------------------- */

/* What is not a number goes to the far end: a box of it contains everything, and nothing is hidden. */
/* Without a branch: volumes are rounded by the thousand. What is not a number counts as the lowest. */
static inline float round_down(double value) {
    value = value > (double)-FLT_MAX ? value : (double)-FLT_MAX;
    value = value < (double)FLT_MAX ? value : (double)FLT_MAX;
    /* The next float below, where rounding went up: as nextafterf(nearest, -FLT_MAX). What is below 0 rounds to -0 at most, so that
     * +0 has never to be lowered. */
    float nearest = (float)value;
    uint32_t bits = 0;
    memcpy(&bits, &nearest, sizeof bits);
    uint32_t lower = (double)nearest > value ? 1U : 0U;
    bits += lower * (2U * (bits >> 31) - 1U);
    memcpy(&nearest, &bits, sizeof nearest);
    return nearest;
}

float enf_round_down(double value) {
    return round_down(value);
}

float enf_round_up(double value) {
    return -round_down(-value);
}

EnfBox3f enf_box3f_outward(EnfBox3 box) {
    EnfBox3f out = {{round_down(box.min.x), round_down(box.min.y), round_down(box.min.z)},
                    {-round_down(-box.max.x), -round_down(-box.max.y), -round_down(-box.max.z)}};
    return out;
}

EnfBox3 enf_box3_from_f(EnfBox3f box) {
    EnfBox3 out = {enf_v3_from_f(box.min), enf_v3_from_f(box.max)};
    return out;
}

/* ---- planes ----------------------------------------------------------------------------------------------------- */

EnfPlane enf_plane_from_polygon(const EnfVec3 *points, uint32_t count) {
    EnfPlane plane = {{0.0, 0.0, 0.0}, 0.0};
    if (count < 3) {
        return plane;
    }
    /* Relative to the first vertex: far from the world's origin the products would cancel away the small differences.
     * The sum of the fan's cross products is Newell's normal. */
    EnfVec3 normal = enf_v3(0.0, 0.0, 0.0), sum = normal;
    EnfVec3 previous = enf_sub(points[1], points[0]);
    for (uint32_t i = 2; i < count; i++) {
        EnfVec3 next = enf_sub(points[i], points[0]);
        normal = enf_add(normal, enf_cross(previous, next));
        sum = enf_add(sum, previous);
        previous = next;
    }
    sum = enf_add(sum, previous);
    plane.n = enf_normalize(normal);
    EnfVec3 middle = enf_add(points[0], enf_scale(sum, 1.0 / (double)count));
    plane.d = -enf_dot(plane.n, middle);
    return plane;
}
