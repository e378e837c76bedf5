/* Pyramid, box and ray queries: loops with an explicit stack over nodes in depth-first order.
 *
 * A tree that enf_kd_check passed has each node once in pre-order, so a subtree is a run of nodes and, leaves being numbered in
 * order, a run of blocks; and no path longer than ENF_KD_MAX_DEPTH, so one pending sibling a level is all a stack must hold. */
#include "simd/simd.h"
#include <enfilade/kd.h>

#include <math.h>

_Static_assert(offsetof(EnfKdNode, max) == 4 * sizeof(float), "enf_simd's node test reads a node as eight floats");
_Static_assert(offsetof(EnfKdBlock, item) == ENF_SIMD_BOX8 * sizeof(float), "enf_simd's boxes are a block's");

/* The items a query finds; what does not fit is counted only. */
typedef struct Found {
    uint32_t *out, capacity, count;
} Found;

/* The lanes of a mask, in order; all of them are in use. */
static inline void found_lanes(Found *found, const EnfKdBlock *block, uint32_t mask) {
    if (found->count < found->capacity && found->capacity - found->count >= ENF_KD_BLOCK) {
        for (; mask; mask &= mask - 1) {
            found->out[found->count++] = block->item[enf_simd_lowest(mask)];
        }
    }
    for (; mask; mask &= mask - 1, found->count++) { /* near the end of the array */
        if (found->count < found->capacity) {
            found->out[found->count] = block->item[enf_simd_lowest(mask)];
        }
    }
}

static inline uint32_t used_lanes(const EnfKdBlock *block) {
    uint32_t mask = 0;
    for (uint32_t i = 0; i < ENF_KD_BLOCK; i++) {
        mask |= (uint32_t)(block->item[i] != ENF_NONE) << i;
    }
    return mask;
}

/* ---- pyramid ---------------------------------------------------------------------------------------------------- */

/* Still to visit: the subtree [node, end), of whose planes only `active` can reject anything. */
typedef struct Pending {
    uint64_t active;
    uint32_t node, end;
} Pending;

/* Everything in the subtree [node, end), untested: it lies inside the pyramid. */
static void found_subtree(Found *found, const EnfKdTree *tree, uint32_t node, uint32_t end) {
    for (; node < end; node++) {
        const EnfKdNode *n = &tree->nodes[node];
        for (uint32_t b = 0; b < n->block_count; b++) {
            const EnfKdBlock *block = &tree->blocks[n->link + b];
            found_lanes(found, block, used_lanes(block));
        }
    }
}

/* Returns how many boxes were tested. */
static uint32_t found_leaf(Found *found, const EnfKdTree *tree, const EnfKdNode *leaf, const EnfSimd *simd,
                           const EnfSimdPlanes *planes, uint64_t active) {
    uint32_t tested = 0;
    for (uint32_t b = 0; b < leaf->block_count; b++) {
        const EnfKdBlock *block = &tree->blocks[leaf->link + b];
        uint32_t mask = simd->boxes(planes, (const float *)(const void *)block, active);
        tested += enf_simd_bits(mask >> 8);
        found_lanes(found, block, mask & 0xff);
    }
    return tested;
}

uint32_t enf_kd_query(const EnfKdTree *tree, const EnfPyramid *pyramid, uint32_t *out, uint32_t capacity,
                      EnfKdCounters *counters) {
    Found found = {NULL, capacity, 0};
    found.out = out;
    if (tree->node_count == 0) {
        return 0;
    }
    const EnfSimd *simd = enf_simd();
    EnfSimdPlanes planes;
    enf_simd_planes(&planes, pyramid);
    EnfKdCounters counted = {0, 0, 0};
    Pending stack[ENF_KD_MAX_DEPTH + 1];
    uint32_t depth = 0;
    Pending at = {planes.all, 0, tree->node_count};
    for (;;) {
        const EnfKdNode *node = &tree->nodes[at.node];
        counted.nodes++;
        if (simd->node(&planes, (const float *)(const void *)node, &at.active)) {
            if (!at.active) {
                found_subtree(&found, tree, at.node, at.end);
            } else if (node->block_count) {
                counted.boxes += found_leaf(&found, tree, node, simd, &planes, at.active);
            } else {
                stack[depth++] = (Pending){at.active, node->link, at.end};
                at.end = node->link;
                at.node++;
                continue;
            }
        }
        if (depth == 0) {
            break;
        }
        at = stack[--depth];
    }
    if (counters) {
        counters->nodes += counted.nodes;
        counters->boxes += counted.boxes;
        counters->found += found.count;
    }
    return found.count;
}

/* ---- box -------------------------------------------------------------------------------------------------------- */

/* Closed: touching counts. A NaN overlaps nothing. */
static inline bool overlaps(const float *low, const float *high, uint32_t step, const EnfBox3f *box) {
    return low[0] <= box->max.x && high[0] >= box->min.x && low[step] <= box->max.y && high[step] >= box->min.y &&
           low[2 * step] <= box->max.z && high[2 * step] >= box->min.z;
}

uint32_t enf_kd_overlap(const EnfKdTree *tree, EnfBox3f box, uint32_t *out, uint32_t capacity) {
    Found found = {NULL, capacity, 0};
    found.out = out;
    uint32_t stack[ENF_KD_MAX_DEPTH + 1], depth = 0;
    if (tree->node_count) {
        stack[depth++] = 0;
    }
    while (depth) {
        uint32_t at = stack[--depth];
        const EnfKdNode *node = &tree->nodes[at];
        if (!overlaps(node->min, node->max, 1, &box)) {
            continue;
        }
        if (!node->block_count) {
            stack[depth++] = node->link;
            stack[depth++] = at + 1;
            continue;
        }
        for (uint32_t b = 0; b < node->block_count; b++) {
            const EnfKdBlock *block = &tree->blocks[node->link + b];
            uint32_t mask = 0;
            for (uint32_t i = 0; i < ENF_KD_BLOCK; i++) {
                mask |= (uint32_t)overlaps(block->min_x + i, block->max_x + i, ENF_KD_BLOCK, &box) << i;
            }
            found_lanes(&found, block, mask & used_lanes(block));
        }
    }
    return found.count;
}

/* ---- ray -------------------------------------------------------------------------------------------------------- */

typedef struct Ray {
    double origin[3], inverse[3];
    bool parallel[3];
} Ray;

static Ray ray_make(EnfVec3 origin, EnfVec3 direction) {
    double o[3] = {origin.x, origin.y, origin.z}, d[3] = {direction.x, direction.y, direction.z};
    Ray ray;
    for (int axis = 0; axis < 3; axis++) {
        ray.origin[axis] = o[axis];
        ray.inverse[axis] = 1.0 / d[axis];
        ray.parallel[axis] = !isfinite(ray.inverse[axis]); /* zero, or too small to leave the slab */
    }
    return ray;
}

/* Does the ray hit the box before t_max; and where it enters. Slabs (Kay & Kajiya 1986); each t is off by at most two roundings,
 * so the far end is widened by four: a box that is hit is never missed (Ize 2013). */
static bool ray_hits(const Ray *ray, const float *low, const float *high, uint32_t step, double t_max, double *t) {
    const double wider = 1.0 + 0x1p-50;
    double near = 0.0, far = t_max * wider;
    for (uint32_t axis = 0; axis < 3; axis++) {
        double a = (double)low[axis * step] - ray->origin[axis], b = (double)high[axis * step] - ray->origin[axis];
        if (ray->parallel[axis]) {
            if (a > 0.0 || b < 0.0) {
                return false;
            }
            continue;
        }
        double ta = a * ray->inverse[axis], tb = b * ray->inverse[axis];
        double t0 = ta < tb ? ta : tb, t1 = (ta < tb ? tb : ta) * wider;
        near = t0 > near ? t0 : near;
        far = t1 < far ? t1 : far;
    }
    *t = near;
    return near <= far;
}

static double ray_leaf(const EnfKdTree *tree, const EnfKdNode *leaf, const Ray *ray, double t_max, EnfKdRayFn *visit,
                       void *user) {
    for (uint32_t b = 0; b < leaf->block_count; b++) {
        const EnfKdBlock *block = &tree->blocks[leaf->link + b];
        for (uint32_t i = 0; i < ENF_KD_BLOCK; i++) {
            double t;
            if (block->item[i] != ENF_NONE && ray_hits(ray, block->min_x + i, block->max_x + i, ENF_KD_BLOCK, t_max, &t)) {
                t_max = visit(user, block->item[i], t_max);
            }
        }
    }
    return t_max;
}

void enf_kd_ray(const EnfKdTree *tree, EnfVec3 origin, EnfVec3 direction, double t_max, EnfKdRayFn *visit, void *user) {
    uint32_t stack[ENF_KD_MAX_DEPTH + 1], depth = 0;
    Ray ray = ray_make(origin, direction);
    if (tree->node_count) {
        stack[depth++] = 0;
    }
    while (depth) {
        uint32_t at = stack[--depth];
        const EnfKdNode *node = &tree->nodes[at];
        double t[2] = {0.0, 0.0}; /* a child that is missed has none */
        if (!ray_hits(&ray, node->min, node->max, 1, t_max, &t[0])) {
            continue; /* t_max may have shrunk since it was stacked */
        }
        if (node->block_count) {
            t_max = ray_leaf(tree, node, &ray, t_max, visit, user);
            continue;
        }
        const uint32_t child[2] = {at + 1, node->link};
        bool hit[2];
        for (int i = 0; i < 2; i++) {
            const EnfKdNode *n = &tree->nodes[child[i]];
            hit[i] = ray_hits(&ray, n->min, n->max, 1, t_max, &t[i]);
        }
        int farther = t[1] >= t[0];
        for (int i = 0; i < 2; i++, farther ^= 1) { /* the nearer one on top */
            if (hit[farther]) {
                stack[depth++] = child[farther];
            }
        }
    }
}
