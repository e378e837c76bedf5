/* How near a polygon comes to the eye: decides whether its projection still means anything (PITFALLS 3). */
#include <enfilade/geom.h>

/* Squared distance of the origin to the segment a b. */
static double segment_distance2(EnfVec3 a, EnfVec3 b) {
    EnfVec3 along = enf_sub(b, a);
    double length2 = enf_dot(along, along), t = -enf_dot(a, along);
    if (!(t > 0.0) || !(length2 > 0.0)) {
        return enf_dot(a, a);
    }
    if (t >= length2) {
        return enf_dot(b, b);
    }
    EnfVec3 foot = enf_add(a, enf_scale(along, t / length2));
    return enf_dot(foot, foot);
}

/* True if the origin's foot on the plane of a b c lies inside the triangle: the origin is on the inner side of the three
 * planes that stand on its edges. */
static bool stands_on(EnfVec3 a, EnfVec3 b, EnfVec3 c, EnfVec3 n) {
    return enf_dot(n, enf_cross(a, b)) >= 0.0 && enf_dot(n, enf_cross(b, c)) >= 0.0 && enf_dot(n, enf_cross(c, a)) >= 0.0;
}

static double triangle_distance2(EnfVec3 a, EnfVec3 b, EnfVec3 c) {
    EnfVec3 n = enf_cross(enf_sub(b, a), enf_sub(c, a));
    double n2 = enf_dot(n, n), best = segment_distance2(b, c);
    if (n2 > 0.0 && stands_on(a, b, c, n)) {
        double height = enf_dot(n, a), d2 = height * height / n2;
        best = d2 < best ? d2 : best;
    }
    return best;
}

/* Over a fan of triangles, so that a bent polygon has a distance too. The edges are taken whatever the triangles say:
 * where rounding puts the foot outside a sliver, its edge is as near. */
double enf_polygon_distance2(const EnfVec3 *points, uint32_t count) {
    ENF_ASSERT(count > 0);
    double best = segment_distance2(points[count - 1], points[0]);
    for (uint32_t i = 1; i < count; i++) {
        double d2 = segment_distance2(points[i - 1], points[i]);
        best = d2 < best ? d2 : best;
    }
    for (uint32_t i = 2; i < count; i++) {
        double d2 = triangle_distance2(points[0], points[i - 1], points[i]);
        best = d2 < best ? d2 : best;
    }
    return best;
}
