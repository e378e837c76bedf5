/* A static tree over grid points: which of them lie near a segment? */
#ifndef ENFILADE_COMPILE_POINT_TREE_H
#define ENFILADE_COMPILE_POINT_TREE_H

#include "compile/exact.h"

typedef struct EnfPointTree EnfPointTree;

/** Over points[ids[0..count)]. NULL when out of memory. Keeps `points`, copies `ids`. @cost O(n log n) */
EnfPointTree *enf_point_tree_create(const EnfGrid3 *points, const uint32_t *ids, uint32_t count);
void enf_point_tree_destroy(EnfPointTree *tree);

/** Is `p` strictly between the ends of the short segment a b and within √3 grid steps of it? Each of the three was snapped by at
 *  most √3/2 steps, so a point that lay on the segment before snapping lies this near afterwards. Exact. */
bool enf_point_on_segment(EnfGrid3 p, EnfGrid3 a, EnfGrid3 b);

/** Calls `visit` with the id of every point for which enf_point_on_segment holds; stops and returns false if it does. */
typedef bool EnfPointFn(void *user, uint32_t id);
bool enf_point_tree_segment(const EnfPointTree *tree, EnfGrid3 a, EnfGrid3 b, EnfPointFn *visit, void *user);

#endif
