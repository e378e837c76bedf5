/* EnfVisSet → EnfDrawList: plain data for a renderer, no GL type in it.
 *
 * One canonical order (PITFALLS 33): opaque, then masked clusters by material and number; opaque, then masked parts of moving objects
 * by material, object and part; then all that is blended back to front, ties clusters first, then by number. So a culled list is a
 * subsequence of the unculled one, and equal pictures follow. */
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
/** One multi-draw: clusters, or one part of a moving object. */
typedef struct EnfDrawBatch {
    uint32_t material, range_first, range_count;
    uint32_t mover; /**< in EnfDrawList.movers, or ENF_NONE: clusters. A mover's range has no cluster (ENF_NONE) */
} EnfDrawBatch;
/** Where a visible cell lies: (origin − eye) split so that adding it to a stored vertex is exact in float (see draw/README). */
typedef struct EnfDrawCell {
    uint32_t cell;
    float offset[3];
} EnfDrawCell;

/** Cells by whose lights a mover may be lit, at most. */
#define ENF_DRAW_MOVER_CELLS 16

/** A moving object as it is drawn: p_eye = m p + t, columns one after the other. Made from its pose and the eye in double, rounded
 *  once, whatever else is visible. */
typedef struct EnfDrawMover {
    uint32_t object, mesh;    /**< index in the world; in EnfMap.meshes */
    float eye_from_model[12]; /**< m's three columns, t */
    EnfVec3 position_ws;      /**< of the model's origin */
    EnfBox3f box;             /**< of its mesh where it is, relative to position_ws */
    uint32_t cell_count;
    uint32_t cells[ENF_DRAW_MOVER_CELLS]; /**< that the box touches, ascending; of more the first */
} EnfDrawMover;

typedef struct EnfDrawList {
    const EnfDrawBatch *batches;
    uint32_t batch_count, opaque_batch_count; /**< batches [0, opaque_batch_count) are opaque or masked, the rest blended */
    const EnfDrawRange *ranges;
    uint32_t range_count;
    const EnfDrawCell *cells;
    uint32_t cell_count;
    const EnfDrawMover *movers; /**< ascending by object */
    uint32_t mover_count;
    bool movers_failed;      /**< memory ran out: objects are missing */
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
/** The list for the view that made `set` (space 0). Valid until the next call. No heap call when warm: room grows with the most
 *  objects ever shown at once.
 *
 *  `world`: whose objects are drawn, with the map's mesh of the number enf_world_mesh (others are invisible): those that the set
 *  lists, or all if it lists none (EnfVisSet.objects_listed). NULL: nothing moves. `alpha`: how far the picture is from the tick
 *  before (0) to the world's tick (1); counts as 1 without trails (enf_world_set_trail). */
const EnfDrawList *enf_draw_build(EnfDraw *draw, const EnfVisSet *set, double near_plane, EnfWorld *world, double alpha);

#ifdef __cplusplus
}
#endif
#endif
