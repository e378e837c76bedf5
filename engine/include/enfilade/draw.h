/* EnfVisSet → EnfDrawList: plain data for a renderer, no GL type in it.
 *
 * One canonical order (PITFALLS 33): opaque and masked batches by material then cluster, blended triangles clusters back to front
 * with ties by cluster; so a culled list is a subsequence of the unculled one, and equal pictures follow. */
#ifndef ENFILADE_DRAW_H
#define ENFILADE_DRAW_H

#include <enfilade/vis.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A run of indices of one material: clusters adjacent in the index buffer are merged. */
typedef struct EnfDrawRange {
    uint32_t index_first, index_count, vertex_first, cluster;
} EnfDrawRange;
/** One multi-draw. */
typedef struct EnfDrawBatch {
    uint32_t material, range_first, range_count;
} EnfDrawBatch;
/** Where a visible cell lies: (origin − eye) split so that adding it to a stored vertex is exact in float (see draw/README). */
typedef struct EnfDrawCell {
    uint32_t cell;
    float offset[3];
} EnfDrawCell;

typedef struct EnfDrawList {
    const EnfDrawBatch *batches;
    uint32_t batch_count, opaque_batch_count; /**< batches [0, opaque_batch_count) are opaque or masked, the rest blended */
    const EnfDrawRange *ranges;
    uint32_t range_count;
    const EnfDrawCell *cells;
    uint32_t cell_count;
    float eye_fraction[3];   /**< subtracted after the exact sum of vertex and offset */
    float clip_from_eye[16]; /**< column-major: projection × rotation, no translation */
    uint32_t cluster_count, triangle_count;
} EnfDrawList;

/** The near plane of the programs, metres: nearer than any eye comes to a wall, far enough for a 32-bit depth buffer to tell
 *  surfaces a millimetre apart at 50 m. Visibility knows no near plane (PITFALLS 2). */
#define ENF_DRAW_NEAR (1.0 / 64.0)

typedef struct EnfDraw EnfDraw;
EnfResult enf_draw_create(EnfDraw **draw, const EnfMap *map, const EnfAllocator *allocator, EnfError *error);
void enf_draw_destroy(EnfDraw *draw);
/** The list for the view that made `set` (space 0). Valid until the next call. No heap call when warm. */
const EnfDrawList *enf_draw_build(EnfDraw *draw, const EnfVisSet *set, double near_plane);

#ifdef __cplusplus
}
#endif
#endif
