/* What a portal shows through a window, in 113 bits; and the portals, cameras and windows that are hard on an engine.
 * For the suites of geom: their oracle shares no line with what it judges. */
#ifndef ENF_TESTS_EXACT_VIEW_H
#define ENF_TESTS_EXACT_VIEW_H

#include "harness/harness.h"
#include "harness/quad.h"

#include <enfilade/geom.h>
#include <enfilade/tolerances.h>

#include <math.h>

/* ---- oracle ----------------------------------------------------------------------------------------------------- */

/** In the eye's frame: right, up, forward. */
typedef struct ExactPoint {
    Quad x, y, w;
} ExactPoint;

typedef struct ExactPolygon {
    uint32_t count;
    ExactPoint points[160];
} ExactPolygon;

static inline Quad exact_dot(EnfVec3 a, EnfVec3 b) {
    return quad(a.x) * quad(b.x) + quad(a.y) * quad(b.y) + quad(a.z) * quad(b.z);
}

static inline ExactPolygon exact_polygon(const EnfCamera *camera, const EnfVec3 *points_eye, uint32_t count) {
    ExactPolygon p;
    p.count = count;
    for (uint32_t i = 0; i < count; i++) {
        p.points[i].x = exact_dot(points_eye[i], camera->right);
        p.points[i].y = exact_dot(points_eye[i], camera->up);
        p.points[i].w = exact_dot(points_eye[i], camera->forward);
    }
    return p;
}

/** Keeps a x + b y + c w + d >= 0. */
static inline void exact_clip(ExactPolygon *p, Quad a, Quad b, Quad c, Quad d) {
    Quad side[160];
    bool all = true;
    for (uint32_t i = 0; i < p->count; i++) {
        side[i] = a * p->points[i].x + b * p->points[i].y + c * p->points[i].w + d;
        all = all && side[i] >= quad(0.0);
    }
    if (all) {
        return;
    }
    ExactPolygon kept;
    kept.count = 0;
    for (uint32_t i = 0; i < p->count; i++) {
        uint32_t j = (i + 1) % p->count;
        const ExactPoint *u = &p->points[i], *v = &p->points[j];
        bool in = side[i] >= quad(0.0);
        if (in) {
            kept.points[kept.count++] = *u;
        }
        if (in != (side[j] >= quad(0.0))) {
            Quad t = side[i] / (side[i] - side[j]);
            ExactPoint cut = {u->x + t * (v->x - u->x), u->y + t * (v->y - u->y), u->w + t * (v->w - u->w)};
            kept.points[kept.count++] = cut;
        }
    }
    *p = kept;
}

static inline void exact_clip_eye(ExactPolygon *p) {
    exact_clip(p, quad(0.0), quad(0.0), quad(1.0), quad(-ENF_TOL_EYE_PLANE));
}

/** Keeps what is seen left of the line a → b of the picture (window steps). With m the picture's middle and k the tangent
 *  of a step: dx (m + y/(w k) - ay) - dy (m + x/(w k) - ax) >= 0, times w. */
static inline void exact_clip_edge(ExactPolygon *p, const EnfCamera *camera, EnfVec3 a, EnfVec3 b) {
    Quad mx = quad(8.0) * quad((double)camera->width_px), my = quad(8.0) * quad((double)camera->height_px);
    Quad dx = quad(b.x) - quad(a.x), dy = quad(b.y) - quad(a.y);
    exact_clip(p, -dy * mx / quad(camera->tan_x), dx * my / quad(camera->tan_y), dx * (my - quad(a.y)) - dy * (mx - quad(a.x)),
               quad(0.0));
}

static inline void exact_clip_window(ExactPolygon *p, const EnfCamera *camera, EnfWindow w) {
    EnfVec3 corner[4] = {{w.x0, w.y0, 0}, {w.x1, w.y0, 0}, {w.x1, w.y1, 0}, {w.x0, w.y1, 0}};
    for (int i = 0; i < 4; i++) {
        exact_clip_edge(p, camera, corner[i], corner[(i + 1) % 4]);
    }
}

/** Where a point is seen, in window steps. */
static inline Quad exact_x(const EnfCamera *camera, const ExactPoint *p) {
    Quad m = quad(8.0) * quad((double)camera->width_px);
    return m + p->x / p->w * (m / quad(camera->tan_x));
}

static inline Quad exact_y(const EnfCamera *camera, const ExactPoint *p) {
    Quad m = quad(8.0) * quad((double)camera->height_px);
    return m + p->y / p->w * (m / quad(camera->tan_y));
}

/* ---- hostile input ---------------------------------------------------------------------------------------------- */

/** 10 to a random power in [low, high). */
static inline double any_size(EnfTestRng *rng, double low, double high) {
    return pow(10.0, enf_test_double(rng, low, high));
}

static inline EnfVec3 any_vector(EnfTestRng *rng, double size) {
    double x = enf_test_double(rng, -size, size), y = enf_test_double(rng, -size, size);
    return enf_v3(x, y, enf_test_double(rng, -size, size));
}

/** Looks along an axis once in four; narrow and wide, tiny and large pictures. */
static inline EnfCamera any_camera(EnfTestRng *rng) {
    bool straight = enf_test_chance(rng, 4);
    double yaw = straight ? 90.0 * (double)enf_test_below(rng, 4) : enf_test_double(rng, -180.0, 180.0);
    double pitch = straight ? 0.0 : enf_test_double(rng, -89.0, 89.0);
    double roll = enf_test_chance(rng, 3) ? enf_test_double(rng, -180.0, 180.0) : 0.0;
    double fov = enf_test_chance(rng, 8) ? any_size(rng, -1.0, 2.2304) : enf_test_double(rng, 30.0, 110.0);
    uint32_t width = enf_test_chance(rng, 8) ? 1 + enf_test_below(rng, 8192) : 640;
    uint32_t height = width == 640 ? 480 : width / 2 + 1;
    return enf_camera(enf_v3(0, 0, 0), enf_turn(yaw, pitch, roll), fov, width, height);
}

/** Usually a part of the picture; sometimes all of it, sometimes a step or two. */
static inline EnfWindow any_window(EnfTestRng *rng, const EnfCamera *camera) {
    EnfWindow w = enf_window_full(camera);
    if (enf_test_chance(rng, 4)) {
        return w;
    }
    uint32_t most_x = (uint32_t)w.x1, most_y = (uint32_t)w.y1;
    if (enf_test_chance(rng, 8)) {
        most_x = most_y = 3;
    }
    w.x0 = (int32_t)enf_test_below(rng, (uint32_t)w.x1);
    w.y0 = (int32_t)enf_test_below(rng, (uint32_t)w.y1);
    int32_t width = 1 + (int32_t)enf_test_below(rng, most_x), height = 1 + (int32_t)enf_test_below(rng, most_y);
    w.x1 = w.x1 - w.x0 < width ? w.x1 : w.x0 + width;
    w.y1 = w.y1 - w.y0 < height ? w.y1 : w.y0 + height;
    return w;
}

/** A point that the camera has at (x, y, depth) of its frame. */
static inline EnfVec3 from_frame(const EnfCamera *camera, double x, double y, double depth) {
    return enf_add(enf_scale(camera->right, x), enf_add(enf_scale(camera->up, y), enf_scale(camera->forward, depth)));
}

typedef struct Portal {
    uint32_t count;
    EnfVec3 points[ENF_POLYGON_MAX];
} Portal;

/** A convex polygon inscribed in the ellipse middle + u cos + v sin. */
static inline Portal ellipse_portal(EnfTestRng *rng, EnfVec3 middle, EnfVec3 u, EnfVec3 v) {
    Portal p;
    p.count = enf_test_chance(rng, 16) ? 3 + enf_test_below(rng, 30) : 3 + enf_test_below(rng, 3);
    double start = enf_test_double(rng, 0.0, 6.0);
    for (uint32_t i = 0; i < p.count; i++) {
        double angle = start + ((double)i + enf_test_double(rng, 0.0, 0.9)) * (2.0 * ENF_PI / (double)p.count);
        p.points[i] = enf_add(middle, enf_add(enf_scale(u, enf_cos(angle)), enf_scale(v, enf_sin(angle))));
    }
    return p;
}

typedef enum PortalKind {
    PORTAL_DOOR,      /* some metres ahead */
    PORTAL_AROUND,    /* anywhere around the eye, often crossing its plane */
    PORTAL_NEAR,      /* a vertex, an edge or the inside near the eye */
    PORTAL_EDGE_ON,   /* the eye in or nearly in its plane */
    PORTAL_SLIVER,    /* of no width to speak of */
    PORTAL_FAR,       /* 100 km away; or 10,000 km large, and near */
    PORTAL_DOUBLED,   /* vertices that coincide or lie on a line */
    PORTAL_EYE_PLANE, /* vertices at the depth where portals are cut */
    PORTAL_GRID,      /* on the compiler's grid, parallel to the axes */
    PORTAL_FITTED,    /* corners where window steps are */
    PORTAL_KIND_COUNT
} PortalKind;

static inline Portal door_portal(EnfTestRng *rng, const EnfCamera *camera, double low, double high) {
    double depth = any_size(rng, low, high);
    double x = enf_test_double(rng, -1.5, 1.5) * camera->tan_x, y = enf_test_double(rng, -1.5, 1.5) * camera->tan_y;
    EnfVec3 middle = from_frame(camera, x * depth, y * depth, depth);
    EnfVec3 u = any_vector(rng, any_size(rng, -1.0, 1.0)), v = any_vector(rng, any_size(rng, -1.0, 1.0));
    return ellipse_portal(rng, middle, u, v);
}

static inline Portal near_portal(EnfTestRng *rng) {
    EnfVec3 u = any_vector(rng, any_size(rng, -2.0, 1.0)), v = any_vector(rng, any_size(rng, -2.0, 1.0));
    EnfVec3 n = enf_normalize(enf_cross(u, v));
    Portal p = ellipse_portal(rng, enf_v3(0, 0, 0), u, v);
    EnfVec3 nearest = enf_v3(0, 0, 0); /* the inside */
    uint32_t i = enf_test_below(rng, p.count), what = enf_test_below(rng, 3);
    if (what == 1) {
        nearest = p.points[i];
    } else if (what == 2) {
        nearest = enf_scale(enf_add(p.points[i], p.points[(i + 1) % p.count]), 0.5);
    }
    EnfVec3 away = enf_add(enf_scale(n, any_size(rng, -9.0, -1.0)), any_vector(rng, any_size(rng, -9.0, -1.0)));
    for (i = 0; i < p.count; i++) {
        p.points[i] = enf_add(enf_sub(p.points[i], nearest), away);
    }
    return p;
}

static inline Portal edge_on_portal(EnfTestRng *rng) {
    EnfVec3 u = any_vector(rng, 2.0), v = any_vector(rng, 2.0), n = enf_normalize(enf_cross(u, v));
    double off = enf_test_chance(rng, 3) ? 0.0 : any_size(rng, -14.0, -2.0);
    EnfVec3 middle = enf_add(enf_scale(u, enf_test_double(rng, -5.0, 5.0)), enf_scale(v, enf_test_double(rng, -5.0, 5.0)));
    return ellipse_portal(rng, enf_add(middle, enf_scale(n, off)), u, v);
}

static inline Portal doubled_portal(EnfTestRng *rng, const EnfCamera *camera) {
    Portal p = door_portal(rng, camera, -1.0, 1.5);
    uint32_t i = enf_test_below(rng, p.count), j = (i + 1) % p.count;
    if (enf_test_chance(rng, 2)) {
        p.points[i] = p.points[j];
    } else {
        p.points[j] = enf_scale(enf_add(p.points[i], p.points[(j + 1) % p.count]), 0.5);
    }
    return p;
}

static inline Portal eye_plane_portal(EnfTestRng *rng, const EnfCamera *camera) {
    Portal p;
    p.count = 3; /* flat whatever its corners are */
    double side = any_size(rng, -2.0, 1.0);
    for (uint32_t i = 0; i < 3; i++) {
        double depth = ENF_TOL_EYE_PLANE * (enf_test_chance(rng, 2) ? 1.0 : enf_test_double(rng, -2.0, 4.0));
        depth = i < 2 ? depth : any_size(rng, -4.0, 1.0);
        double x = i == 0 ? -side : enf_test_double(rng, -side, side);
        p.points[i] = from_frame(camera, x, enf_test_double(rng, -1.0, 1.0), depth);
    }
    return p;
}

static inline Portal grid_portal(EnfTestRng *rng) {
    double step = enf_test_chance(rng, 2) ? 0.25 : ENF_GRID_STEP;
    double at[3], size[2];
    for (int i = 0; i < 3; i++) {
        at[i] = ((double)enf_test_below(rng, 81) - 40.0) * step;
    }
    size[0] = (double)(1 + enf_test_below(rng, 40)) * step;
    size[1] = (double)(1 + enf_test_below(rng, 40)) * step;
    uint32_t axis = enf_test_below(rng, 3);
    Portal p;
    p.count = 4;
    for (uint32_t i = 0; i < 4; i++) {
        double a = i == 1 || i == 2 ? size[0] : 0.0, b = i >= 2 ? size[1] : 0.0;
        p.points[i] = enf_v3(at[0] + (axis == 0 ? 0.0 : a),
                             at[1] + (axis == 1   ? 0.0
                                      : axis == 0 ? a
                                                  : b),
                             at[2] + (axis == 2 ? 0.0 : b));
    }
    return p;
}

/** Corners seen exactly (but for rounding) on the window grid. */
static inline Portal fitted_portal(EnfTestRng *rng, const EnfCamera *camera) {
    Portal p;
    p.count = 4;
    double depth = any_size(rng, -1.0, 2.0), w = 8.0 * (double)camera->width_px, h = 8.0 * (double)camera->height_px;
    double x[2], y[2];
    for (int i = 0; i < 2; i++) {
        x[i] = (floor(enf_test_double(rng, -0.2, 2.2) * w) - w) / w * camera->tan_x;
        y[i] = (floor(enf_test_double(rng, -0.2, 2.2) * h) - h) / h * camera->tan_y;
    }
    for (uint32_t i = 0; i < 4; i++) {
        p.points[i] = from_frame(camera, x[i == 1 || i == 2] * depth, y[i >= 2] * depth, depth);
    }
    return p;
}

static inline Portal any_portal(EnfTestRng *rng, const EnfCamera *camera, PortalKind kind) {
    switch (kind) {
    case PORTAL_AROUND: {
        EnfVec3 middle = any_vector(rng, any_size(rng, -1.0, 1.0)), u = any_vector(rng, any_size(rng, -1.0, 1.0));
        return ellipse_portal(rng, middle, u, any_vector(rng, any_size(rng, -1.0, 1.0)));
    }
    case PORTAL_NEAR:
        return near_portal(rng);
    case PORTAL_EDGE_ON:
        return edge_on_portal(rng);
    case PORTAL_SLIVER: {
        EnfVec3 middle = any_vector(rng, 5.0), u = any_vector(rng, 3.0);
        return ellipse_portal(rng, middle, u, any_vector(rng, any_size(rng, -12.0, -3.0)));
    }
    case PORTAL_FAR: {
        /* once in four a wall of a thousand kilometres and more that passes close by: the pad alone is too small for it */
        bool vast = enf_test_chance(rng, 4);
        double least = vast ? 6.0 : 0.0, most = vast ? 7.0 : 5.0;
        EnfVec3 middle = any_vector(rng, vast ? any_size(rng, -1.5, 0.0) : any_size(rng, 2.0, 5.0));
        EnfVec3 u = any_vector(rng, any_size(rng, least, most));
        return ellipse_portal(rng, middle, u, any_vector(rng, any_size(rng, least, most)));
    }
    case PORTAL_DOUBLED:
        return doubled_portal(rng, camera);
    case PORTAL_EYE_PLANE:
        return eye_plane_portal(rng, camera);
    case PORTAL_GRID:
        return grid_portal(rng);
    case PORTAL_FITTED:
        return fitted_portal(rng, camera);
    default:
        return door_portal(rng, camera, -1.0, 2.0);
    }
}

/** Squared distance of the eye to a convex planar polygon, in 113 bits: to its edges, and to its plane where the foot is
 *  inside. */
static inline Quad exact_distance2(const EnfVec3 *points, uint32_t count) {
    ExactPoint n = {quad(0.0), quad(0.0), quad(0.0)};
    Quad best = quad(0.0);
    for (uint32_t i = 0; i < count; i++) {
        EnfVec3 a = points[i], b = points[(i + 1) % count];
        n.x += quad(a.y) * quad(b.z) - quad(a.z) * quad(b.y);
        n.y += quad(a.z) * quad(b.x) - quad(a.x) * quad(b.z);
        n.w += quad(a.x) * quad(b.y) - quad(a.y) * quad(b.x);
        ExactPoint ab = {quad(b.x) - quad(a.x), quad(b.y) - quad(a.y), quad(b.z) - quad(a.z)};
        Quad length2 = ab.x * ab.x + ab.y * ab.y + ab.w * ab.w;
        Quad t = -(quad(a.x) * ab.x + quad(a.y) * ab.y + quad(a.z) * ab.w);
        t = length2 > quad(0.0) ? quad_max(quad(0.0), quad_min(quad(1.0), t / length2)) : quad(0.0);
        ExactPoint foot = {quad(a.x) + t * ab.x, quad(a.y) + t * ab.y, quad(a.z) + t * ab.w};
        Quad d2 = foot.x * foot.x + foot.y * foot.y + foot.w * foot.w;
        best = i == 0 ? d2 : quad_min(best, d2);
    }
    bool inside = true;
    for (uint32_t i = 0; i < count; i++) {
        EnfVec3 a = points[i], b = points[(i + 1) % count];
        Quad side = n.x * (quad(a.y) * quad(b.z) - quad(a.z) * quad(b.y)) +
                    n.y * (quad(a.z) * quad(b.x) - quad(a.x) * quad(b.z)) +
                    n.w * (quad(a.x) * quad(b.y) - quad(a.y) * quad(b.x));
        inside = inside && side >= quad(0.0);
    }
    Quad n2 = n.x * n.x + n.y * n.y + n.w * n.w;
    Quad height = n.x * quad(points[0].x) + n.y * quad(points[0].y) + n.w * quad(points[0].z);
    return inside && n2 > quad(0.0) ? quad_min(best, height * height / n2) : best;
}

#endif
