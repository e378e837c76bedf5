/* Openings as polygons: the triangles of a portal's mesh become planar islands, each a few convex polygons on the grid.
 *
 * After the snap everything is decided in integers (DESIGN §2): turns are signs of 2×2 determinants in the plane of the two
 * coordinates that the island faces least away from. The one tolerance is the snap's own: a vertex may be two grid steps beside
 * the chord of its neighbours and still count as lying on it. */
#ifndef ENFILADE_COMPILE_LAYOUT_PATCH_H
#define ENFILADE_COMPILE_LAYOUT_PATCH_H

#include "compile/array.h"

#include <enfilade/geom.h>

typedef struct EnfPiece {
    uint32_t point_first, point_count; /**< a convex polygon of 3..ENF_POLYGON_MAX points, counter-clockwise from its front */
} EnfPiece;

/** One opening: a connected, (nearly) planar island of triangles. */
typedef struct EnfPatch {
    uint32_t piece_first, piece_count;
    EnfVec3 normal, centre; /**< area-weighted; centre is that of the largest piece, so it lies in the opening */
    EnfBox3 box;            /**< world */
    double area;            /**< square metres */
    double off_plane;       /**< metres: largest distance of a vertex from the common plane */
    bool bent;              /**< off_plane is beyond ENF_TOL_PORTAL_FLAT */
    bool concave;           /**< planar, yet more than one piece was needed */
} EnfPatch;

/** A growing store of patches, their pieces and points. Zero-initialised; free with enf_patches_free. */
typedef struct EnfPatches {
    ENF_ARRAY(EnfPatch) patches;
    ENF_ARRAY(EnfPiece) pieces;
    ENF_ARRAY(EnfGrid3) points;
} EnfPatches;

/** Appends the islands of `triangle_count` triangles (3 corners each, on the grid). Triangles meeting at more than 45° belong to
 *  different islands. Islands without width are left out and counted in *degenerate. @return false if memory is out. */
bool enf_patches_add(EnfPatches *patches, const EnfGrid3 *corners, uint32_t triangle_count, uint32_t *degenerate);
void enf_patches_free(EnfPatches *patches);

/* ---- between layout_patch.c and layout_convex.c ---- */

/** An island: triangles (indices into vertices), all seen counter-clockwise from the front. */
typedef struct EnfIsland {
    const EnfGrid3 *vertices;
    uint32_t (*triangles)[3];
    uint32_t triangle_count;
    bool convex; /**< out: its outline is one convex polygon in one plane */
} EnfIsland;

/** Appends the convex pieces of `island` to `patches`. @return false if memory is out. */
bool enf_island_pieces(EnfPatches *patches, EnfIsland *island);

/** Newell's area vector of a polygon (twice its area, m²) and its centroid. */
EnfVec3 enf_grid_polygon_area(const EnfGrid3 *points, uint32_t count, EnfVec3 *centre);

#endif
