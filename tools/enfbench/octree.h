/* An octree over polygons that stand still and boxes that move, as Greene and Sudarsky & Gotsman use it: each thing hangs on the few
 * nodes that it touches of the level whose cubes are not smaller than it. A box that moved is taken off all its nodes and hung again
 * from the root (update N of Sudarsky & Gotsman). Nodes once made are kept: emptied ones cost less than making them anew. */
#ifndef ENFBENCH_OCTREE_H
#define ENFBENCH_OCTREE_H

#include <enfilade/math.h>

#define OCTREE_FANOUT 8

/** The root is node 0; a child that is not there is 0. Lists end with ENF_NONE. */
typedef struct OctreeNode {
    uint32_t child[8]; /**< bits of the number: 1 upper x, 2 upper y, 4 upper z */
    uint32_t polygons; /**< first of its hooks */
    uint32_t objects;  /**< first of its links */
} OctreeNode;

typedef struct OctreeHook {
    uint32_t polygon, next;
} OctreeHook;

/** Link i belongs to object i / OCTREE_FANOUT; `node` is ENF_NONE while it is unused. */
typedef struct OctreeLink {
    uint32_t node, next, before;
} OctreeLink;

typedef struct Octree {
    OctreeNode *nodes;
    OctreeHook *hooks;
    OctreeLink *links;
    uint32_t node_count, node_capacity, hook_count, hook_capacity, object_count;
    uint32_t depth; /**< of the leaves; the root's is 0 */
    double leaf;    /**< side of a leaf, metres */
    EnfVec3 low;    /**< lowest corner of the root */
} Octree;

/** Over `bounds`, with leaves of this side. False without memory. */
bool bench_octree_open(Octree *tree, EnfBox3 bounds, double leaf, uint32_t object_count);
void bench_octree_close(Octree *tree);
/** Side of a cube at a depth. */
double bench_octree_side(const Octree *tree, uint32_t depth);
/** False without memory. */
bool bench_octree_add_polygon(Octree *tree, uint32_t polygon, EnfBox3 box);
/** Takes an object off and hangs it where its box is; without memory for a node, on the root. */
void bench_octree_move(Octree *tree, uint32_t object, EnfBox3 box);

#endif
