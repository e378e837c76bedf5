/* The octree of the hierarchical Z-buffer: see octree.h. */
#include "enfbench/octree.h"

#include <enfilade/base.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/** The cubes of a depth that a box touches: from and to, in whole steps from the root's corner. */
typedef struct Cubes {
    uint32_t depth, from[3], to[3];
} Cubes;

double bench_octree_side(const Octree *tree, uint32_t depth) {
    return ldexp(tree->leaf, (int)(tree->depth - depth));
}

bool bench_octree_open(Octree *tree, EnfBox3 bounds, double leaf, uint32_t object_count) {
    memset(tree, 0, sizeof *tree);
    EnfVec3 size = enf_sub(bounds.max, bounds.min);
    double largest = fmax(size.x, fmax(size.y, size.z));
    tree->low = bounds.min;
    tree->leaf = leaf;
    while (ldexp(leaf, (int)tree->depth) < largest && tree->depth < 24) {
        tree->depth++;
    }
    tree->object_count = object_count;
    tree->node_capacity = 1024;
    tree->hook_capacity = 1024;
    tree->nodes = calloc(tree->node_capacity, sizeof *tree->nodes);
    tree->hooks = calloc(tree->hook_capacity, sizeof *tree->hooks);
    tree->links = malloc((size_t)object_count * OCTREE_FANOUT * sizeof *tree->links + 1U);
    if (!tree->nodes || !tree->hooks || !tree->links) {
        bench_octree_close(tree);
        return false;
    }
    memset(tree->links, 0xff, (size_t)object_count * OCTREE_FANOUT * sizeof *tree->links);
    tree->nodes[0].polygons = ENF_NONE;
    tree->nodes[0].objects = ENF_NONE;
    tree->node_count = 1;
    return true;
}

void bench_octree_close(Octree *tree) {
    free(tree->nodes);
    free(tree->hooks);
    free(tree->links);
    memset(tree, 0, sizeof *tree);
}

static Cubes cubes_of(const Octree *tree, EnfBox3 box) {
    Cubes cubes;
    EnfVec3 size = enf_sub(box.max, box.min);
    double largest = fmax(size.x, fmax(size.y, size.z));
    double side = tree->leaf;
    for (cubes.depth = tree->depth; cubes.depth > 0 && side < largest; cubes.depth--) {
        side *= 2.0;
    }
    const double low[3] = {box.min.x - tree->low.x, box.min.y - tree->low.y, box.min.z - tree->low.z};
    const double high[3] = {box.max.x - tree->low.x, box.max.y - tree->low.y, box.max.z - tree->low.z};
    double last = ldexp(1.0, (int)cubes.depth) - 1.0;
    for (int a = 0; a < 3; a++) {
        double from = floor(low[a] / side);
        double to = floor(high[a] / side);
        cubes.from[a] = (uint32_t)fmin(fmax(from, 0.0), last);
        cubes.to[a] = (uint32_t)fmin(fmax(to, (double)cubes.from[a]), last);
    }
    return cubes;
}

static uint32_t add_node(Octree *tree) {
    if (tree->node_count == tree->node_capacity) {
        OctreeNode *nodes = realloc(tree->nodes, 2U * (size_t)tree->node_capacity * sizeof *nodes);
        if (nodes == NULL) {
            return 0;
        }
        tree->nodes = nodes;
        tree->node_capacity *= 2U;
    }
    OctreeNode *node = &tree->nodes[tree->node_count];
    memset(node, 0, sizeof *node);
    node->polygons = ENF_NONE;
    node->objects = ENF_NONE;
    return tree->node_count++;
}

/* From the root down to a cube; the root itself without memory. */
static uint32_t descend(Octree *tree, uint32_t depth, const uint32_t at[3]) {
    uint32_t node = 0;
    for (uint32_t d = depth; d-- > 0;) {
        uint32_t k = (at[0] >> d & 1U) | (at[1] >> d & 1U) << 1 | (at[2] >> d & 1U) << 2;
        uint32_t child = tree->nodes[node].child[k];
        if (child == 0) {
            child = add_node(tree);
            if (child == 0) {
                return 0;
            }
            tree->nodes[node].child[k] = child;
        }
        node = child;
    }
    return node;
}

bool bench_octree_add_polygon(Octree *tree, uint32_t polygon, EnfBox3 box) {
    Cubes cubes = cubes_of(tree, box);
    uint32_t at[3];
    for (at[2] = cubes.from[2]; at[2] <= cubes.to[2]; at[2]++) {
        for (at[1] = cubes.from[1]; at[1] <= cubes.to[1]; at[1]++) {
            for (at[0] = cubes.from[0]; at[0] <= cubes.to[0]; at[0]++) {
                if (tree->hook_count == tree->hook_capacity) {
                    OctreeHook *hooks = realloc(tree->hooks, 2U * (size_t)tree->hook_capacity * sizeof *hooks);
                    if (hooks == NULL) {
                        return false;
                    }
                    tree->hooks = hooks;
                    tree->hook_capacity *= 2U;
                }
                uint32_t node = descend(tree, cubes.depth, at);
                OctreeHook hook = {polygon, tree->nodes[node].polygons};
                tree->nodes[node].polygons = tree->hook_count;
                tree->hooks[tree->hook_count++] = hook;
            }
        }
    }
    return true;
}

static void take_off(Octree *tree, uint32_t object) {
    OctreeLink *own = &tree->links[(size_t)object * OCTREE_FANOUT];
    for (uint32_t k = 0; k < OCTREE_FANOUT && own[k].node != ENF_NONE; k++) {
        if (own[k].before != ENF_NONE) {
            tree->links[own[k].before].next = own[k].next;
        } else {
            tree->nodes[own[k].node].objects = own[k].next;
        }
        if (own[k].next != ENF_NONE) {
            tree->links[own[k].next].before = own[k].before;
        }
        own[k].node = ENF_NONE;
    }
}

void bench_octree_move(Octree *tree, uint32_t object, EnfBox3 box) {
    Cubes cubes = cubes_of(tree, box);
    uint32_t at[3];
    uint32_t number = object * OCTREE_FANOUT; /* at most 2 × 2 × 2 cubes: the box is not larger than one */
    take_off(tree, object);
    for (at[2] = cubes.from[2]; at[2] <= cubes.to[2]; at[2]++) {
        for (at[1] = cubes.from[1]; at[1] <= cubes.to[1]; at[1]++) {
            for (at[0] = cubes.from[0]; at[0] <= cubes.to[0]; at[0]++, number++) {
                uint32_t node = descend(tree, cubes.depth, at);
                OctreeLink link = {node, tree->nodes[node].objects, ENF_NONE};
                if (link.next != ENF_NONE) {
                    tree->links[link.next].before = number;
                }
                tree->nodes[node].objects = number;
                tree->links[number] = link;
            }
        }
    }
}
