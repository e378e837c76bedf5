/* What the room's files share: hulls of integer points. */
#ifndef ENFILADE_GEOM_INTERNAL_H
#define ENFILADE_GEOM_INTERNAL_H

#include <enfilade/geom.h>

/** Vertices of a portal (32) clipped by the eye plane and a window polygon's edges (32). A convex one stays within; what
 *  does not is not convex, and falls back to the parent's window. */
#define ENF_CLIPPED_MAX (ENF_POLYGON_MAX + ENF_WINDOW_POLYGON_MAX + 8)

/** Coordinates of window polygons are at most 2^29 in absolute value (a picture of 2^25 px): differences are below 2^30,
 *  cross products below 2^61, and int64 never overflows. */
#define ENF_WINDOW_LIMIT (INT32_C(1) << 29)

/** Each clipped vertex gives four grid points, the corners of the box that surely holds it; a hull in the making repeats its
 *  first point, and each side of a box may cut off one corner and leave four points for it. */
#define ENF_HULL_MAX (4 * ENF_CLIPPED_MAX + 16)

/** Integer points, or a convex polygon of them, counter-clockwise from the leftmost lowest vertex. */
typedef struct EnfGridPoints {
    uint32_t count;
    int32_t x[ENF_HULL_MAX], y[ENF_HULL_MAX];
} EnfGridPoints;

void enf_grid_points_add(EnfGridPoints *points, int32_t x, int32_t y);
/** Replaces points by their strict convex hull; fewer than 3 vertices (no area) give 0. */
void enf_grid_points_hull(EnfGridPoints *points);
/** A convex polygon that contains the part of hull `points` within `box`, itself within `box`. */
void enf_grid_points_clip(EnfGridPoints *points, EnfWindow box);
/** A hull as a window; beyond ENF_WINDOW_POLYGON_MAX vertices, its bounding box. */
void enf_grid_points_window(const EnfGridPoints *points, EnfWindowPolygon *out);

#endif
