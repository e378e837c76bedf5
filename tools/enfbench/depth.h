/* A depth pyramid on the processor: what is in front of what, for Greene's visibility. Samples are the middles of the picture's
 * pixels, so that what it hides shows no pixel; depths are kept for tiles of eight by eight samples and, above these, for squares of
 * two by two. Depth is the inverse of the distance along the line of sight, 1/m: larger is nearer, 0 is infinitely far. */
#ifndef ENFBENCH_DEPTH_H
#define ENFBENCH_DEPTH_H

#include <enfilade/geom.h>

typedef struct DepthPyramid DepthPyramid;

/** For pictures of this size, at most 4,096 pixels a side; NULL without memory. */
DepthPyramid *bench_depth_create(uint32_t width_px, uint32_t height_px);
void bench_depth_destroy(DepthPyramid *depth);
void bench_depth_clear(DepthPyramid *depth);

/** A point as the eye sees it: metres to the right, up and along the line of sight. */
EnfVec3 bench_depth_point(const EnfCamera *camera, EnfVec3 p_ws);

#define DEPTH_POLYGON_MAX 8
/** Draws a convex planar polygon, points as bench_depth_point makes them, counter-clockwise seen from its front; an averted one
 *  hides nothing. Never covers a sample that the polygon does not cover, nor nearer than it is. */
void bench_depth_polygon(DepthPyramid *depth, const EnfCamera *camera, const EnfVec3 *points, uint32_t count);

/** The samples that a box may cover, corners included, and how near it comes. */
typedef struct DepthRect {
    int32_t x0, y0, x1, y1;
    float nearest;
} DepthRect;

typedef enum DepthPlace {
    DEPTH_OUTSIDE, /**< covers no sample */
    DEPTH_RECT,    /**< *rect says which */
    DEPTH_AROUND   /**< reaches behind the eye: nothing can be said */
} DepthPlace;

DepthPlace bench_depth_place(const EnfCamera *camera, EnfBox3 box_ws, DepthRect *rect);
/** Is there something nearer in front of each of these samples? */
bool bench_depth_hides(const DepthPyramid *depth, const DepthRect *rect);

#endif
