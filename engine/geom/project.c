/* The window of a portal: the heart of the promise that nothing visible is lost.
 *
 * In: a polygon relative to the eye, the window of the cell it is seen from. Out: a window in 1/16 px that contains
 * whatever of the polygon is seen through the parent's. After Luebke & Georges 1995 §3, made safe:
 *   - the eye near the polygon (not its plane): the parent's window (PITFALLS 2, 3);
 *   - clipped in homogeneous coordinates before the divide, by the eye plane and by the parent's sides (PITFALLS 1);
 *   - everything that may round is widened by a bound on its error, then by ENF_TOL_PAD_PX, then rounded outward to the
 *     grid (PITFALLS 27); what is not finite or does not fit gives the parent's window.
 *
 * Error bound. A vertex becomes (x, y, w) = (p·right, p·up, p·forward) with an absolute error below 4 u L each, u = 2^-53
 * and L the largest |p|_1. A clip is a convex combination: it stays below L and adds a few u L; at most five (boxes) or
 * 33 (polygons) clips follow, each acting on the same magnitudes. E = 2^-46 L (1 + tan_x + tan_y) = 128 u L (...) is
 * above the error of x, y and w, and of x - k w for every k within the picture. Sides move outward by E (and the pad)
 * before they clip, so a vertex on the wrong side by rounding never costs a visible point; and x / w is widened by E / w.
 *
 * Sutherland–Hodgman on the ring of vertices keeps every point around which the ring winds: so a bent polygon is right
 * too, as every line of sight through its opening crosses a surface spanned by the ring. */
#include "geom/geom_internal.h"

#include <enfilade/tolerances.h>

#include <math.h>
#include <string.h>

#define PAD_STEPS (ENF_TOL_PAD_PX * ENF_WINDOW_STEPS)

/* Camera and polygon in the eye's frame: points are (x right, y up, z = depth forward). */
typedef struct Sight {
    double middle_x, middle_y; /* of the picture, in window steps */
    double kx, ky;             /* window step → tangent */
    double sx, sy;             /* tangent → window step */
    double error;              /* E above, metres */
    double depth_min, depth_max;
    uint32_t count;
    EnfVec3 points[ENF_CLIPPED_MAX];
} Sight;

typedef enum SightKind {
    SIGHT_BEHIND,  /* no point in front of the eye plane */
    SIGHT_UNSURE,  /* near the eye, not finite, too large: pass the parent's window */
    SIGHT_AHEAD,   /* every vertex at ENF_TOL_EYE_PLANE or beyond */
    SIGHT_CROSSING /* some vertices ahead, some not */
} SightKind;

/* ---- into the eye's frame --------------------------------------------------------------------------------------- */

/* True if all coordinates along one axis lie beyond `reach` on one side. */
static bool apart(double low, double high, double reach) {
    return low > reach || high < -reach;
}

static bool box_apart(const EnfVec3 *points, uint32_t count, double reach) {
    EnfVec3 low = points[0], high = points[0];
    for (uint32_t i = 1; i < count; i++) {
        EnfVec3 p = points[i];
        low.x = p.x < low.x ? p.x : low.x;
        low.y = p.y < low.y ? p.y : low.y;
        low.z = p.z < low.z ? p.z : low.z;
        high.x = p.x > high.x ? p.x : high.x;
        high.y = p.y > high.y ? p.y : high.y;
        high.z = p.z > high.z ? p.z : high.z;
    }
    return apart(low.x, high.x, reach) || apart(low.y, high.y, reach) || apart(low.z, high.z, reach);
}

/* Exact distance is dear, so it is asked last: boxes in the eye's frame and along the world's axes (where most portals
 * are flat) settle nearly all. What is not a number is near. */
static bool is_near(const Sight *s, const EnfVec3 *points_eye) {
    double reach = ENF_TOL_PORTAL_EYE + s->error;
    if (apart(s->depth_min, s->depth_max, reach) || box_apart(s->points, s->count, reach) ||
        box_apart(points_eye, s->count, reach)) {
        return false;
    }
    return !(enf_polygon_distance2(points_eye, s->count) > reach * reach);
}

/* Fills `s`; false if a coordinate (of the camera's, too) is not finite. */
static bool look(Sight *s, const EnfCamera *camera, const EnfVec3 *points_eye, uint32_t count) {
    double size = 0.0, sum = 0.0, depth_min = HUGE_VAL, depth_max = -HUGE_VAL;
    for (uint32_t i = 0; i < count; i++) {
        EnfVec3 p = points_eye[i];
        double l1 = fabs(p.x) + fabs(p.y) + fabs(p.z);
        double depth = enf_dot(p, camera->forward);
        s->points[i] = enf_v3(enf_dot(p, camera->right), enf_dot(p, camera->up), depth);
        size = size > l1 ? size : l1;
        sum += s->points[i].x + s->points[i].y + depth; /* keeps a NaN, as the maxima do not */
        depth_min = depth_min < depth ? depth_min : depth;
        depth_max = depth_max > depth ? depth_max : depth;
    }
    s->count = count;
    s->depth_min = depth_min;
    s->depth_max = depth_max;
    s->error = 0x1p-46 * size * (1.0 + camera->tan_x + camera->tan_y);
    s->middle_x = 0.5 * ENF_WINDOW_STEPS * (double)camera->width_px;
    s->middle_y = 0.5 * ENF_WINDOW_STEPS * (double)camera->height_px;
    s->kx = camera->tan_x / s->middle_x;
    s->ky = camera->tan_y / s->middle_y;
    s->sx = s->middle_x / camera->tan_x;
    s->sy = s->middle_y / camera->tan_y;
    return fabs(sum) < HUGE_VAL;
}

static SightKind sight(Sight *s, const EnfCamera *camera, const EnfVec3 *points_eye, uint32_t count) {
    if (count < 3 || count > ENF_POLYGON_MAX || !look(s, camera, points_eye, count)) {
        return SIGHT_UNSURE;
    }
    /* So coarse that the depth of the eye plane is lost in it: farther than some 10^9 m. */
    if (!(s->error <= 0.5 * ENF_TOL_EYE_PLANE)) {
        return SIGHT_UNSURE;
    }
    if (is_near(s, points_eye)) {
        return SIGHT_UNSURE;
    }
    if (s->depth_max + s->error < ENF_TOL_EYE_PLANE) {
        return SIGHT_BEHIND;
    }
    return s->depth_min >= ENF_TOL_EYE_PLANE ? SIGHT_AHEAD : SIGHT_CROSSING;
}

/* ---- clipping before the divide --------------------------------------------------------------------------------- */

/* From the kept side to the dropped one, whichever way the ring runs: an edge shared by two portals is cut at one place. */
static EnfVec3 crossing(EnfVec3 kept, EnfVec3 dropped, double side_kept, double side_dropped) {
    double t = side_kept / (side_kept - side_dropped);
    return enf_add(kept, enf_scale(enf_sub(dropped, kept), t));
}

/* Keeps the part where a x + b y + c w + margin >= 0 (Sutherland & Hodgman 1974). False if the result has more vertices
 * than a convex polygon could have. */
static bool clip(Sight *s, double a, double b, double c, double margin) {
    double side[ENF_CLIPPED_MAX];
    bool all_inside = true;
    for (uint32_t i = 0; i < s->count; i++) {
        EnfVec3 p = s->points[i];
        side[i] = a * p.x + b * p.y + c * p.z + margin;
        all_inside = all_inside && side[i] >= 0.0;
    }
    if (all_inside) {
        return true;
    }
    EnfVec3 kept[ENF_CLIPPED_MAX];
    uint32_t kept_count = 0;
    for (uint32_t i = 0; i < s->count; i++) {
        uint32_t j = i + 1 < s->count ? i + 1 : 0;
        bool inside = side[i] >= 0.0, next_inside = side[j] >= 0.0;
        if (kept_count + 2 > ENF_CLIPPED_MAX) {
            return false;
        }
        if (inside) {
            kept[kept_count++] = s->points[i];
        }
        if (inside && !next_inside) {
            kept[kept_count++] = crossing(s->points[i], s->points[j], side[i], side[j]);
        } else if (!inside && next_inside) {
            kept[kept_count++] = crossing(s->points[j], s->points[i], side[j], side[i]);
        }
    }
    memcpy(s->points, kept, kept_count * sizeof kept[0]);
    s->count = kept_count;
    return true;
}

static bool clip_to_eye_plane(Sight *s) {
    return clip(s, 0.0, 0.0, 1.0, s->error - ENF_TOL_EYE_PLANE);
}

static bool clip_to_box(Sight *s, EnfWindow box) {
    double left = ((double)box.x0 - PAD_STEPS - s->middle_x) * s->kx;
    double right = ((double)box.x1 + PAD_STEPS - s->middle_x) * s->kx;
    double bottom = ((double)box.y0 - PAD_STEPS - s->middle_y) * s->ky;
    double top = ((double)box.y1 + PAD_STEPS - s->middle_y) * s->ky;
    return clip(s, 1.0, 0.0, -left, s->error) && clip(s, -1.0, 0.0, right, s->error) && clip(s, 0.0, 1.0, -bottom, s->error) &&
           clip(s, 0.0, -1.0, top, s->error);
}

/* ---- boxes ------------------------------------------------------------------------------------------------------ */

/* A box in window steps, not rounded. */
typedef struct Range {
    double x0, y0, x1, y1;
} Range;

/* What the vertices surely lie within; all depths are positive. */
static Range range_of(const Sight *s) {
    Range r = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (uint32_t i = 0; i < s->count; i++) {
        EnfVec3 p = s->points[i];
        double inverse = 1.0 / p.z;
        double x0 = (p.x - s->error) * inverse, x1 = (p.x + s->error) * inverse;
        double y0 = (p.y - s->error) * inverse, y1 = (p.y + s->error) * inverse;
        r.x0 = x0 < r.x0 ? x0 : r.x0;
        r.y0 = y0 < r.y0 ? y0 : r.y0;
        r.x1 = x1 > r.x1 ? x1 : r.x1;
        r.y1 = y1 > r.y1 ? y1 : r.y1;
    }
    r.x0 = s->middle_x + r.x0 * s->sx - PAD_STEPS;
    r.x1 = s->middle_x + r.x1 * s->sx + PAD_STEPS;
    r.y0 = s->middle_y + r.y0 * s->sy - PAD_STEPS;
    r.y1 = s->middle_y + r.y1 * s->sy + PAD_STEPS;
    return r;
}

/* Conversions truncate; a call of floor costs more than the vertex did. The value fits, see the callers. */
static int32_t floor_step(double v) {
    int32_t i = (int32_t)v;
    return i - (v < (double)i);
}

static int32_t ceil_step(double v) {
    int32_t i = (int32_t)v;
    return i + (v > (double)i);
}

/* Rounded outward within `box`; empty if apart from it. Both ends are brought into the box before they are converted. */
static EnfWindow window_of(Range r, EnfWindow box) {
    EnfWindow none = {0, 0, 0, 0};
    double x0 = (double)box.x0, y0 = (double)box.y0, x1 = (double)box.x1, y1 = (double)box.y1;
    if (!(r.x0 < x1 && r.x1 > x0 && r.y0 < y1 && r.y1 > y0)) {
        return none;
    }
    EnfWindow w = {r.x0 > x0 ? floor_step(r.x0) : box.x0, r.y0 > y0 ? floor_step(r.y0) : box.y0,
                   r.x1 < x1 ? ceil_step(r.x1) : box.x1, r.y1 < y1 ? ceil_step(r.y1) : box.y1};
    return w;
}

static bool range_within(Range r, EnfWindow box) {
    return r.x0 >= (double)box.x0 && r.x1 <= (double)box.x1 && r.y0 >= (double)box.y0 && r.y1 <= (double)box.y1;
}

EnfProject enf_project_box(const EnfCamera *camera, const EnfVec3 *points_eye, uint32_t count, EnfWindow parent,
                           EnfWindow *out) {
    Sight s;
    EnfWindow none = {0, 0, 0, 0};
    SightKind kind = enf_window_is_empty(parent) ? SIGHT_BEHIND : sight(&s, camera, points_eye, count);
    if (kind == SIGHT_UNSURE) {
        *out = parent;
        return ENF_PROJECT_PARENT;
    }
    *out = none;
    if (kind == SIGHT_BEHIND) {
        return ENF_PROJECT_EMPTY;
    }
    if (kind == SIGHT_AHEAD) {
        Range plain = range_of(&s);
        *out = window_of(plain, parent);
        if (enf_window_is_empty(*out) || range_within(plain, parent)) {
            return enf_window_is_empty(*out) ? ENF_PROJECT_EMPTY : ENF_PROJECT_WINDOW;
        }
    }
    /* It reaches beyond the parent's window: cut there first, or its far corners make the box too large. */
    if (!clip_to_eye_plane(&s) || !clip_to_box(&s, parent)) {
        *out = parent;
        return ENF_PROJECT_PARENT;
    }
    *out = s.count > 0 ? window_of(range_of(&s), parent) : none;
    return enf_window_is_empty(*out) ? ENF_PROJECT_EMPTY : ENF_PROJECT_WINDOW;
}

/* ---- polygons --------------------------------------------------------------------------------------------------- */

/* Left of each edge a → b: dx (Y - ay) - dy (X - ax) >= 0, times the depth; |dx| + |dy| is at least the edge's length, so
 * the pad moves the edge outward by no less than PAD_STEPS. */
static bool clip_to_polygon(Sight *s, const EnfWindowPolygon *p) {
    for (uint32_t i = 0; i < p->count && s->count > 0; i++) {
        uint32_t j = i + 1 < p->count ? i + 1 : 0;
        double dx = (double)p->x[j] - (double)p->x[i], dy = (double)p->y[j] - (double)p->y[i];
        double across = fabs(dx) + fabs(dy);
        double depth = dy * ((double)p->x[i] - s->middle_x) - dx * ((double)p->y[i] - s->middle_y) + across * PAD_STEPS;
        double margin = (fabs(dx) * s->sy + fabs(dy) * s->sx) * s->error;
        if (!clip(s, -dy * s->sx, dx * s->sy, depth, margin)) {
            return false;
        }
    }
    return true;
}

/* The grid points around each vertex; false if one is out of range. */
static bool add_vertices(EnfGridPoints *points, const Sight *s) {
    const double limit = (double)ENF_WINDOW_LIMIT - 1.0;
    for (uint32_t i = 0; i < s->count; i++) {
        EnfVec3 p = s->points[i];
        double inverse = 1.0 / p.z, spread = s->error * inverse;
        double x = s->middle_x + p.x * inverse * s->sx, y = s->middle_y + p.y * inverse * s->sy;
        double wide_x = PAD_STEPS + spread * s->sx, wide_y = PAD_STEPS + spread * s->sy;
        if (!(fabs(x) + wide_x < limit && fabs(y) + wide_y < limit)) {
            return false;
        }
        int32_t x0 = floor_step(x - wide_x), x1 = ceil_step(x + wide_x);
        int32_t y0 = floor_step(y - wide_y), y1 = ceil_step(y + wide_y);
        enf_grid_points_add(points, x0, y0);
        enf_grid_points_add(points, x0, y1);
        enf_grid_points_add(points, x1, y0);
        enf_grid_points_add(points, x1, y1);
    }
    return true;
}

static EnfProject pass_parent(const EnfWindowPolygon *parent, EnfWindowPolygon *out) {
    EnfWindowPolygon copy = *parent; /* they may be the same object */
    *out = copy;
    return ENF_PROJECT_PARENT;
}

EnfProject enf_project_polygon(const EnfCamera *camera, const EnfVec3 *points_eye, uint32_t count,
                               const EnfWindowPolygon *parent, EnfWindowPolygon *out) {
    Sight s;
    SightKind kind = parent->count < 3 ? SIGHT_BEHIND : sight(&s, camera, points_eye, count);
    EnfWindow box = enf_window_polygon_bounds(parent);
    if (kind == SIGHT_UNSURE) {
        return pass_parent(parent, out);
    }
    if (kind == SIGHT_BEHIND || (kind == SIGHT_AHEAD && enf_window_is_empty(window_of(range_of(&s), box)))) {
        out->count = 0;
        return ENF_PROJECT_EMPTY;
    }
    EnfGridPoints points;
    points.count = 0;
    if (!clip_to_eye_plane(&s) || !clip_to_polygon(&s, parent) || !add_vertices(&points, &s)) {
        return pass_parent(parent, out);
    }
    enf_grid_points_hull(&points);
    enf_grid_points_clip(&points, box);
    enf_grid_points_window(&points, out);
    return out->count > 0 ? ENF_PROJECT_WINDOW : ENF_PROJECT_EMPTY;
}
