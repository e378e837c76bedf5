/* Polygon clipping, projected screen windows with outward rounding, view pyramids, convex hulls in the window plane.
 *
 * Screen space: px, x right, y up, (0,0) the lower left corner of the picture. Windows are fixed point, 1/16 px, so that
 * growing them terminates (DESIGN §2, §3). Everything here is pure: arrays in, arrays out, no memory of its own. */
#ifndef ENFILADE_GEOM_H
#define ENFILADE_GEOM_H

#include <enfilade/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A box window: [x0,x1] × [y0,y1] in 1/16 px; empty when x0 >= x1 or y0 >= y1. */
typedef struct EnfWindow {
    int32_t x0, y0, x1, y1;
} EnfWindow;

#define ENF_POLYGON_MAX 32        /**< vertices of a portal (DESIGN §3) */
#define ENF_WINDOW_POLYGON_MAX 32 /**< vertices of a polygon window */
#define ENF_CLIP_MAX 40           /**< room for a portal clipped by eye plane and a window's four sides */

/** A convex polygon window, counter-clockwise, integer vertices in 1/16 px; count 0 is empty. */
typedef struct EnfWindowPolygon {
    uint32_t count;
    int32_t x[ENF_WINDOW_POLYGON_MAX], y[ENF_WINDOW_POLYGON_MAX];
} EnfWindowPolygon;

/** The camera as visibility needs it. Directions are unit and orthogonal; forward = the direction looked in. */
typedef struct EnfCamera {
    EnfVec3 eye_ws;
    EnfVec3 right, up, forward;
    double tan_x, tan_y; /**< tangents of the half fields of view */
    uint32_t width_px, height_px;
} EnfCamera;

/** Which way a head is turned, degrees: yaw counter-clockwise about +Y with 0 looking down −Z, pitch up positive, roll about the
 *  line of sight (the head tilts to its right). */
typedef struct EnfTurn {
    double yaw_deg, pitch_deg, roll_deg;
} EnfTurn;
EnfTurn enf_turn(double yaw_deg, double pitch_deg, double roll_deg);

/** The camera of an eye; `fov_y_deg` in (0, 170], width and height at least 1. */
EnfCamera enf_camera(EnfVec3 eye_ws, EnfTurn turn, double fov_y_deg, uint32_t width_px, uint32_t height_px);

EnfWindow enf_window_full(const EnfCamera *camera); /**< [0, 16 w] × [0, 16 h] */
bool enf_window_is_empty(EnfWindow w);
EnfWindow enf_window_intersect(EnfWindow a, EnfWindow b);
EnfWindow enf_window_union(EnfWindow a, EnfWindow b); /**< smallest box holding both; an empty one adds nothing */
bool enf_window_contains(EnfWindow outer, EnfWindow inner);

/** What became of a portal seen through a window. */
typedef enum EnfProject {
    ENF_PROJECT_EMPTY,  /**< certainly not visible through the parent's window */
    ENF_PROJECT_WINDOW, /**< *out is its window */
    ENF_PROJECT_PARENT  /**< too near, degenerate or non-finite: the parent's window was passed on */
} EnfProject;

/** The window of a polygon seen through `parent`.
 *  `points_eye`: `count` (3..ENF_POLYGON_MAX) vertices relative to the eye, world axes, metres.
 *  `*out` is conservative: it contains every point of `parent` through which a point of the polygon with depth >=
 *  ENF_TOL_EYE_PLANE is seen; and polygons within ENF_TOL_PORTAL_EYE of the eye pass `parent` whole.
 *  @guarantee tests/property/test_screen_box: 10^6 random and hostile portals a run against 113-bit arithmetic.
 *  Source: Luebke & Georges 1995 §3 (cull boxes); DESIGN §2. */
EnfProject enf_project_box(const EnfCamera *camera, const EnfVec3 *points_eye, uint32_t count, EnfWindow parent,
                           EnfWindow *out);
/** The same with a convex polygon window: the polygon clipped to the parent's, rounded outward to the grid. `parent` and
 *  `out` may be the same object. */
EnfProject enf_project_polygon(const EnfCamera *camera, const EnfVec3 *points_eye, uint32_t count,
                               const EnfWindowPolygon *parent, EnfWindowPolygon *out);

EnfWindowPolygon enf_window_polygon_from_box(EnfWindow w);
EnfWindow enf_window_polygon_bounds(const EnfWindowPolygon *p);
bool enf_window_polygon_contains(const EnfWindowPolygon *outer, const EnfWindowPolygon *inner); /**< exact */
/** A convex polygon containing both: their hull, exact in integers; beyond ENF_WINDOW_POLYGON_MAX vertices, the bounding
 *  box (more is drawn, nothing hidden). */
void enf_window_polygon_union(const EnfWindowPolygon *a, const EnfWindowPolygon *b, EnfWindowPolygon *out);

/** Squared distance of the origin to a convex planar polygon in space. */
double enf_polygon_distance2(const EnfVec3 *points, uint32_t count);

/** Half-spaces through (or near) the eye that bound what a window shows: p is inside plane i if
 *  nx[i]*x + ny[i]*y + nz[i]*z + d[i] >= 0 in float32, for every point p of a *box* tested as enf_kd does, with the error
 *  of float arithmetic already added to d: a box with a point inside the exact pyramid is never rejected.
 *  Planes 0..3 are the window's sides, 4 the eye plane, further ones a polygon window's edges. */
#define ENF_PYRAMID_PLANES (5 + ENF_WINDOW_POLYGON_MAX)
typedef struct EnfPyramid {
    uint32_t count;
    float nx[ENF_PYRAMID_PLANES], ny[ENF_PYRAMID_PLANES], nz[ENF_PYRAMID_PLANES], d[ENF_PYRAMID_PLANES];
} EnfPyramid;

/** The pyramid of `window` (and of `polygon` unless NULL) for points stored relative to `origin_ws` inside `bounds` (local):
 *  the box that limits the coordinates which will be tested, from which the float error is derived.
 *  @guarantee tests/property/test_pyramid: no box with a point in the exact pyramid is rejected. */
void enf_pyramid(const EnfCamera *camera, EnfWindow window, const EnfWindowPolygon *polygon, EnfVec3 origin_ws, EnfBox3f bounds,
                 EnfPyramid *out);
/** The scalar test every query agrees with: false only if the box is certainly outside one plane. */
bool enf_pyramid_box(const EnfPyramid *pyramid, EnfBox3f box);

#ifdef __cplusplus
}
#endif
#endif
