/* A tree of boxes over points in Morton order (Morton 1966): consecutive points are near each other, so an implicit binary heap
 * over blocks of them is a good hierarchy without any choice of split planes. */
#include "compile/point_tree.h"

#include <stdlib.h>
#include <string.h>

enum { BLOCK = 8, MORTON_BITS = 21 };

/* Boxes are tested in double: coordinates below 2^41 are exact, and this many steps cover √3 and every rounding. */
#define MARGIN_STEPS 3.0

typedef struct Box {
    double center[3], extent[3]; /* half sizes, with the margin; negative: empty */
} Box;

typedef struct Keyed {
    uint64_t key;
    uint32_t id;
} Keyed;

struct EnfPointTree {
    const EnfGrid3 *points;
    uint32_t *ids;
    uint32_t count, leaf_count; /* leaf_count: a power of two */
    Box *boxes;                 /* heap order from 1: children of k are 2k and 2k + 1; leaf i is node leaf_count + i */
};

/* ---- building --------------------------------------------------------------------------------------------------- */

static uint64_t spread_bits(uint64_t x) {
    x = (x | x << 32) & UINT64_C(0x001f00000000ffff);
    x = (x | x << 16) & UINT64_C(0x001f0000ff0000ff);
    x = (x | x << 8) & UINT64_C(0x100f00f00f00f00f);
    x = (x | x << 4) & UINT64_C(0x10c30c30c30c30c3);
    return (x | x << 2) & UINT64_C(0x1249249249249249);
}

static int compare_keys(const void *left, const void *right) {
    const Keyed *a = left, *b = right;
    if (a->key != b->key) {
        return a->key < b->key ? -1 : 1;
    }
    return (a->id > b->id) - (a->id < b->id);
}

static void sort_by_morton(EnfPointTree *tree, Keyed *keyed, const uint32_t *ids) {
    EnfGrid3 low = tree->points[ids[0]], high = low;
    for (uint32_t i = 1; i < tree->count; i++) {
        EnfGrid3 p = tree->points[ids[i]];
        low = (EnfGrid3){p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y, p.z < low.z ? p.z : low.z};
        high = (EnfGrid3){p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y, p.z > high.z ? p.z : high.z};
    }
    EnfGrid3 size = enf_grid_sub(high, low);
    int64_t largest = size.x > size.y ? size.x : size.y;
    largest = size.z > largest ? size.z : largest;
    int shift = 0;
    while (largest >> shift >> MORTON_BITS) {
        shift++;
    }
    for (uint32_t i = 0; i < tree->count; i++) {
        EnfGrid3 p = enf_grid_sub(tree->points[ids[i]], low);
        keyed[i].key = spread_bits((uint64_t)(p.x >> shift)) | spread_bits((uint64_t)(p.y >> shift)) << 1 |
                       spread_bits((uint64_t)(p.z >> shift)) << 2;
        keyed[i].id = ids[i];
    }
    qsort(keyed, tree->count, sizeof *keyed, compare_keys);
    for (uint32_t i = 0; i < tree->count; i++) {
        tree->ids[i] = keyed[i].id;
    }
}

/* The box of points of the block `leaf`; false if there is none. */
static bool block_range(const EnfPointTree *tree, uint32_t leaf, double min[3], double max[3]) {
    uint64_t first = (uint64_t)leaf * BLOCK;
    for (uint64_t i = first; i < tree->count && i < first + BLOCK; i++) {
        EnfGrid3 p = tree->points[tree->ids[i]];
        const double c[3] = {(double)p.x, (double)p.y, (double)p.z};
        for (int axis = 0; axis < 3; axis++) {
            min[axis] = i == first || c[axis] < min[axis] ? c[axis] : min[axis];
            max[axis] = i == first || c[axis] > max[axis] ? c[axis] : max[axis];
        }
    }
    return first < tree->count;
}

static Box make_box(const double min[3], const double max[3], bool filled) {
    Box box;
    for (int axis = 0; axis < 3; axis++) {
        box.center[axis] = filled ? 0.5 * (min[axis] + max[axis]) : 0;
        box.extent[axis] = filled ? 0.5 * (max[axis] - min[axis]) + MARGIN_STEPS : -0x1p62;
    }
    return box;
}

/* Both halves are at least as far out as their points, so the box of both is. */
static Box join(const Box *left, const Box *right) {
    if (left->extent[0] < 0 || right->extent[0] < 0) {
        return left->extent[0] < 0 ? *right : *left;
    }
    Box box;
    for (int axis = 0; axis < 3; axis++) {
        double low = left->center[axis] - left->extent[axis], other_low = right->center[axis] - right->extent[axis];
        double high = left->center[axis] + left->extent[axis], other_high = right->center[axis] + right->extent[axis];
        low = other_low < low ? other_low : low;
        high = other_high > high ? other_high : high;
        box.center[axis] = 0.5 * (low + high);
        box.extent[axis] = 0.5 * (high - low);
    }
    return box;
}

static void fit_boxes(EnfPointTree *tree) {
    for (uint32_t leaf = 0; leaf < tree->leaf_count; leaf++) {
        double min[3] = {0}, max[3] = {0};
        bool filled = block_range(tree, leaf, min, max);
        tree->boxes[tree->leaf_count + leaf] = make_box(min, max, filled);
    }
    for (uint32_t node = tree->leaf_count - 1; node > 0; node--) {
        tree->boxes[node] = join(&tree->boxes[2 * node], &tree->boxes[2 * node + 1]);
    }
}

EnfPointTree *enf_point_tree_create(const EnfGrid3 *points, const uint32_t *ids, uint32_t count) {
    EnfPointTree *tree = calloc(1, sizeof *tree);
    Keyed *keyed = malloc(((size_t)count + 1) * sizeof *keyed);
    if (tree) {
        tree->points = points;
        tree->count = count;
        tree->leaf_count = 1;
        while ((uint64_t)tree->leaf_count * BLOCK < count) {
            tree->leaf_count *= 2;
        }
        tree->ids = malloc(((size_t)count + 1) * sizeof *tree->ids);
        tree->boxes = malloc(2 * (size_t)tree->leaf_count * sizeof *tree->boxes);
    }
    if (!tree || !keyed || !tree->ids || !tree->boxes) {
        free(keyed);
        enf_point_tree_destroy(tree);
        return NULL;
    }
    if (count > 0) {
        sort_by_morton(tree, keyed, ids);
    }
    fit_boxes(tree);
    free(keyed);
    return tree;
}

void enf_point_tree_destroy(EnfPointTree *tree) {
    if (tree) {
        free(tree->ids);
        free(tree->boxes);
        free(tree);
    }
}

/* ---- asking ----------------------------------------------------------------------------------------------------- */

bool enf_point_on_segment(EnfGrid3 p, EnfGrid3 a, EnfGrid3 b) {
    EnfGrid3 along = enf_grid_sub(b, a), to = enf_grid_sub(p, a);
    if (!enf_grid_short(along) || !enf_grid_short(to)) {
        return false;
    }
    int64_t dot = enf_grid_dot(to, along), length2 = enf_grid_dot(along, along);
    if (dot <= 0 || dot >= length2) {
        return false;
    }
    EnfGrid3 cross = enf_grid_cross(to, along);
    return enf_grid_dot_wide(cross, cross) <= (EnfInt128)3 * length2;
}

/* The segment as centre and half vector, for the separating-axis test against boxes. */
typedef struct Segment {
    double center[3], half[3], reach[3];
} Segment;

static Segment make_segment(EnfGrid3 a, EnfGrid3 b) {
    const double p[3] = {(double)a.x, (double)a.y, (double)a.z}, q[3] = {(double)b.x, (double)b.y, (double)b.z};
    Segment s;
    for (int axis = 0; axis < 3; axis++) {
        s.center[axis] = 0.5 * (p[axis] + q[axis]);
        s.half[axis] = 0.5 * (q[axis] - p[axis]);
        s.reach[axis] = s.half[axis] < 0 ? -s.half[axis] : s.half[axis];
    }
    return s;
}

static double magnitude(double x) {
    return x < 0 ? -x : x;
}

/* May the segment, MARGIN_STEPS thick, touch the box? Separating axes: the box's three and their products with the segment. */
static bool touches(const Segment *s, const Box *box) {
    double between[3];
    for (int axis = 0; axis < 3; axis++) {
        between[axis] = s->center[axis] - box->center[axis];
        if (magnitude(between[axis]) > box->extent[axis] + s->reach[axis]) {
            return false;
        }
    }
    for (int axis = 0; axis < 3; axis++) {
        int i = (axis + 1) % 3, j = (axis + 2) % 3;
        double apart = magnitude(between[i] * s->half[j] - between[j] * s->half[i]);
        if (apart > box->extent[i] * s->reach[j] + box->extent[j] * s->reach[i]) {
            return false;
        }
    }
    return true;
}

bool enf_point_tree_segment(const EnfPointTree *tree, EnfGrid3 a, EnfGrid3 b, EnfPointFn *visit, void *user) {
    uint32_t stack[64], depth = 0;
    Segment segment = make_segment(a, b);
    stack[depth++] = 1;
    while (depth > 0) {
        uint32_t node = stack[--depth];
        if (!touches(&segment, &tree->boxes[node])) {
            continue;
        }
        if (node < tree->leaf_count) {
            stack[depth++] = 2 * node + 1;
            stack[depth++] = 2 * node;
            continue;
        }
        uint64_t first = (uint64_t)(node - tree->leaf_count) * BLOCK;
        for (uint64_t i = first; i < tree->count && i < first + BLOCK; i++) {
            if (enf_point_on_segment(tree->points[tree->ids[i]], a, b) && !visit(user, tree->ids[i])) {
                return false;
            }
        }
    }
    return true;
}
