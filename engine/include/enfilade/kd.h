/* kd-trees: built by surface-area heuristic in the compiler, queried with pyramids, boxes and rays at run time.
 *
 * A tree is three plain arrays inside an EnfMap (or anyone's): nodes in depth-first order with tight bounds, and leaf blocks
 * of eight boxes in SoA form for SIMD. Item numbers are the caller's (cluster indices in a map). DESIGN §4. */
#ifndef ENFILADE_KD_H
#define ENFILADE_KD_H

#include <enfilade/geom.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ENF_KD_BLOCK 8      /**< boxes in a leaf block */
#define ENF_KD_MAX_DEPTH 60 /**< no path from the root is longer: the builder keeps it, map_check verifies it */

/** 32 bytes. Inner node: block_count 0, the left child follows at index + 1, the right child is node `link`. Leaf: blocks
 *  [link, link + block_count). Indices are relative to the tree's own arrays. */
typedef struct EnfKdNode {
    float min[3];
    uint32_t link;
    float max[3];
    uint32_t block_count;
} EnfKdNode;

/** 224 bytes. Unused lanes hold an empty box (min +FLT_MAX, max −FLT_MAX) and item ENF_NONE. */
typedef struct EnfKdBlock {
    float min_x[ENF_KD_BLOCK], min_y[ENF_KD_BLOCK], min_z[ENF_KD_BLOCK];
    float max_x[ENF_KD_BLOCK], max_y[ENF_KD_BLOCK], max_z[ENF_KD_BLOCK];
    uint32_t item[ENF_KD_BLOCK];
} EnfKdBlock;

/** A view of a tree; owns nothing. node_count 0 is the empty tree. */
typedef struct EnfKdTree {
    const EnfKdNode *nodes;
    const EnfKdBlock *blocks;
    uint32_t node_count, block_count;
} EnfKdTree;

typedef struct EnfKdCounters {
    uint32_t nodes, boxes, found;
} EnfKdCounters;

/** A built tree in memory of its own. */
typedef struct EnfKdBuilt {
    EnfKdNode *nodes;
    EnfKdBlock *blocks;
    uint32_t node_count, block_count;
    const EnfAllocator *allocator;
} EnfKdBuilt;

/** Builds over `count` boxes with item numbers `items` (NULL: 0..count-1). Deterministic; binned surface-area heuristic,
 *  each item in exactly one leaf, by centroid. @cost O(n log n). Source: MacDonald & Booth 1990; Wald 2007. */
EnfResult enf_kd_build(EnfKdBuilt *out, const EnfBox3f *boxes, const uint32_t *items, uint32_t count,
                       const EnfAllocator *allocator, EnfError *error);
void enf_kd_built_free(EnfKdBuilt *built);
static inline EnfKdTree enf_kd_tree(const EnfKdBuilt *b) {
    EnfKdTree t = {b->nodes, b->blocks, b->node_count, b->block_count};
    return t;
}

/** Structure check of untrusted arrays: links in range and ascending, depth, block ranges, children inside parents, items <
 *  item_count or ENF_NONE. After it, no query can leave the arrays or loop. */
EnfResult enf_kd_check(const EnfKdTree *tree, uint32_t item_count, EnfError *error);

/** Items whose box the pyramid may see, in depth-first order, into out[0..capacity). Returns how many there are in all (a
 *  result > capacity means that out was too small; no more than capacity are written). Adds to *counters (may be NULL).
 *  @guarantee exactly the items that a loop of enf_pyramid_box over all boxes keeps, on every SIMD variant: rounding is monotone, so a
 *  rejected node holds no box that would be kept.
 *  tests/property/test_kd */
uint32_t enf_kd_query(const EnfKdTree *tree, const EnfPyramid *pyramid, uint32_t *out, uint32_t capacity,
                      EnfKdCounters *counters);
/** Items whose boxes overlap `box` (closed), as above. */
uint32_t enf_kd_overlap(const EnfKdTree *tree, EnfBox3f box, uint32_t *out, uint32_t capacity);
/** Calls `visit` for items whose boxes a ray may hit, roughly near to far; `visit` returns the new maximal parameter. */
typedef double EnfKdRayFn(void *user, uint32_t item, double t_max);
void enf_kd_ray(const EnfKdTree *tree, EnfVec3 origin, EnfVec3 direction, double t_max, EnfKdRayFn *visit, void *user);

#ifdef __cplusplus
}
#endif
#endif
