/* EnfKdTree from boxes: binned surface-area heuristic, each item once, by the centre of its box.
 *
 * Source: MacDonald & Booth 1990 (the cost model); Wald 2007 (bins). Leaves cost what their SIMD blocks cost, not what
 * their items cost: nine boxes are two tests. Deterministic: no hashing, no threads, ties to the lowest axis and bin. Nodes
 * are written in depth-first order with an explicit stack; a small tree (most cells hold a few clusters) is one leaf. */
#include <enfilade/kd.h>

#include <float.h>
#include <string.h>

enum {
    BINS = 16,
    LEAF_MAX = 4 * ENF_KD_BLOCK, /* more items always split */
    MEDIAN_DEPTH = 26            /* from here halves: 26 + 32 levels hold 2^32 items, less than ENF_KD_MAX_DEPTH */
};
/* The price of visiting a node, in tests of a block of eight boxes. A node is a jump nobody can foretell: of 0.5, 1, 1.5, 2 and 3,
 * two gave the fastest queries of 10 to 10,000 boxes with AVX2. */
#define NODE_COST 2.0

/* An item on its way into a leaf: sorted in place. */
typedef struct BuildItem {
    EnfBox3f box;
    uint32_t item;
    float center[3];
} BuildItem;

typedef struct Builder {
    BuildItem *items;
    EnfKdBuilt *out; /* with room for the worst case */
} Builder;

/* A run of items that becomes a subtree. `parent` is patched for right children. */
typedef struct Task {
    uint32_t first, count, depth, parent;
} Task;

typedef struct Bounds {
    float min[3], max[3];
} Bounds;

typedef struct Split {
    double cost;
    uint32_t larger; /* items on the fuller side: the tie-break, so that boxes without area split evenly */
    int axis;
    uint32_t bin; /* bins below it go left */
} Split;

/* ---- bounds ----------------------------------------------------------------------------------------------------- */

static Bounds bounds_empty(void) {
    return (Bounds){{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
}

static inline void bounds_add(Bounds *b, const float *min, const float *max) {
    for (int axis = 0; axis < 3; axis++) {
        b->min[axis] = min[axis] < b->min[axis] ? min[axis] : b->min[axis];
        b->max[axis] = max[axis] > b->max[axis] ? max[axis] : b->max[axis];
    }
}

/* Half the surface; in double, so that no float box overflows it. */
static double bounds_area(const Bounds *b) {
    double x = (double)b->max[0] - (double)b->min[0], y = (double)b->max[1] - (double)b->min[1],
           z = (double)b->max[2] - (double)b->min[2];
    return x < 0.0 ? 0.0 : x * y + y * z + z * x;
}

static Bounds bounds_of(const BuildItem *items, uint32_t count) {
    Bounds b = bounds_empty();
    for (uint32_t i = 0; i < count; i++) {
        bounds_add(&b, &items[i].box.min.x, &items[i].box.max.x);
    }
    return b;
}

static Bounds centers_of(const BuildItem *items, uint32_t count) {
    Bounds b = bounds_empty();
    for (uint32_t i = 0; i < count; i++) {
        bounds_add(&b, items[i].center, items[i].center);
    }
    return b;
}

/* ---- where to split --------------------------------------------------------------------------------------------- */

static inline uint32_t blocks_for(uint32_t count) {
    return (count + ENF_KD_BLOCK - 1) / ENF_KD_BLOCK;
}

/* The bin of a centre: monotone in the centre, 0..BINS-1. */
static inline uint32_t bin_of(float center, float low, double scale) {
    double bin = ((double)center - (double)low) * scale;
    return bin < BINS - 1 ? (uint32_t)bin : BINS - 1;
}

static double bin_scale(const Bounds *centers, int axis) {
    double extent = (double)centers->max[axis] - (double)centers->min[axis];
    return extent > 0.0 ? BINS / extent : 0.0;
}

/* The cheapest of the planes between the bins of one axis, if cheaper than *best. Costs are not divided by the parent's area. */
static void split_axis(const BuildItem *items, uint32_t count, const Bounds *centers, int axis, Split *best) {
    Bounds bins[BINS];
    uint32_t counts[BINS] = {0};
    double scale = bin_scale(centers, axis);
    if (!(scale > 0.0) || scale > DBL_MAX) {
        return;
    }
    for (int i = 0; i < BINS; i++) {
        bins[i] = bounds_empty();
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t bin = bin_of(items[i].center[axis], centers->min[axis], scale);
        bounds_add(&bins[bin], &items[i].box.min.x, &items[i].box.max.x);
        counts[bin]++;
    }
    double right_cost[BINS];
    Bounds right = bounds_empty(), left = bounds_empty();
    uint32_t right_count = 0, left_count = 0;
    for (uint32_t i = BINS - 1; i > 0; i--) {
        bounds_add(&right, bins[i].min, bins[i].max);
        right_count += counts[i];
        right_cost[i] = bounds_area(&right) * blocks_for(right_count);
    }
    for (uint32_t i = 1; i < BINS; i++) {
        bounds_add(&left, bins[i - 1].min, bins[i - 1].max);
        left_count += counts[i - 1];
        double cost = bounds_area(&left) * blocks_for(left_count) + right_cost[i];
        uint32_t larger = left_count > count - left_count ? left_count : count - left_count;
        if (larger < count && (cost < best->cost || (cost == best->cost && larger < best->larger))) {
            *best = (Split){cost, larger, axis, i};
        }
    }
}

/* Moves the items of the lower bins to the front. */
static uint32_t partition(BuildItem *items, uint32_t count, const Bounds *centers, const Split *split) {
    double scale = bin_scale(centers, split->axis);
    uint32_t left = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (bin_of(items[i].center[split->axis], centers->min[split->axis], scale) < split->bin) {
            BuildItem swap = items[left];
            items[left++] = items[i];
            items[i] = swap;
        }
    }
    return left;
}

/* ---- median, where the heuristic gives nothing ------------------------------------------------------------------ */

/* A total order: no ties, so the result does not depend on the algorithm. */
static inline bool before(const BuildItem *a, const BuildItem *b, int axis) {
    return a->center[axis] != b->center[axis] ? a->center[axis] < b->center[axis] : a->item < b->item;
}

/* Quickselect (Hoare 1961): the smaller half to the front. */
static void halve(BuildItem *items, uint32_t count, int axis) {
    uint32_t middle = count / 2, low = 0, high = count - 1;
    while (low < high) {
        BuildItem pivot = items[low + (high - low) / 2];
        uint32_t i = low, j = high;
        for (;;) {
            while (before(&items[i], &pivot, axis)) {
                i++;
            }
            while (before(&pivot, &items[j], axis)) {
                j--;
            }
            if (i >= j) {
                break;
            }
            BuildItem swap = items[i];
            items[i++] = items[j];
            items[j--] = swap;
        }
        if (middle <= j) {
            high = j;
        } else {
            low = j + 1;
        }
    }
}

static int longest_axis(const Bounds *centers) {
    int longest = 0;
    double extent = -1.0;
    for (int axis = 0; axis < 3; axis++) {
        double e = (double)centers->max[axis] - (double)centers->min[axis];
        if (e > extent) {
            extent = e;
            longest = axis;
        }
    }
    return longest;
}

/* ---- the tree --------------------------------------------------------------------------------------------------- */

/* Splits the task's items; returns how many are on the left, 0 for a leaf. */
static uint32_t split_task(const Builder *b, const Task *task, const Bounds *bounds) {
    BuildItem *items = b->items + task->first;
    if (task->count <= ENF_KD_BLOCK) {
        return 0;
    }
    Bounds centers = centers_of(items, task->count);
    if (task->depth < MEDIAN_DEPTH) {
        Split best = {DBL_MAX, UINT32_MAX, -1, 0};
        for (int axis = 0; axis < 3; axis++) {
            split_axis(items, task->count, &centers, axis, &best);
        }
        double area = bounds_area(bounds);
        if (task->count <= LEAF_MAX && best.cost + NODE_COST * area >= area * blocks_for(task->count)) {
            return 0;
        }
        if (best.axis >= 0) {
            return partition(items, task->count, &centers, &best);
        }
    } else if (task->count <= LEAF_MAX) {
        return 0;
    }
    halve(items, task->count, longest_axis(&centers));
    return task->count / 2;
}

static void leaf_blocks(Builder *b, const Task *task, EnfKdNode *leaf) {
    leaf->link = b->out->block_count;
    leaf->block_count = blocks_for(task->count);
    for (uint32_t i = 0; i < leaf->block_count * ENF_KD_BLOCK; i++) {
        EnfKdBlock *block = &b->out->blocks[leaf->link + i / ENF_KD_BLOCK];
        uint32_t lane = i % ENF_KD_BLOCK;
        const BuildItem empty = {{{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}}, ENF_NONE, {0, 0, 0}};
        const BuildItem *item = i < task->count ? &b->items[task->first + i] : &empty;
        block->min_x[lane] = item->box.min.x, block->max_x[lane] = item->box.max.x;
        block->min_y[lane] = item->box.min.y, block->max_y[lane] = item->box.max.y;
        block->min_z[lane] = item->box.min.z, block->max_z[lane] = item->box.max.z;
        block->item[lane] = item->item;
    }
    b->out->block_count += leaf->block_count;
}

static void build_nodes(Builder *b, uint32_t count) {
    Task stack[ENF_KD_MAX_DEPTH + 2];
    uint32_t stacked = 0;
    stack[stacked++] = (Task){0, count, 0, ENF_NONE};
    while (stacked) {
        Task task = stack[--stacked];
        uint32_t index = b->out->node_count++;
        ENF_ASSERT(task.depth <= ENF_KD_MAX_DEPTH);
        Bounds bounds = bounds_of(b->items + task.first, task.count);
        EnfKdNode *node = &b->out->nodes[index];
        *node = (EnfKdNode){{bounds.min[0], bounds.min[1], bounds.min[2]}, 0, {bounds.max[0], bounds.max[1], bounds.max[2]}, 0};
        if (task.parent != ENF_NONE) {
            b->out->nodes[task.parent].link = index;
        }
        uint32_t left = split_task(b, &task, &bounds);
        if (left == 0) {
            leaf_blocks(b, &task, node);
            continue;
        }
        stack[stacked++] = (Task){task.first + left, task.count - left, task.depth + 1, index};
        stack[stacked++] = (Task){task.first, left, task.depth + 1, ENF_NONE};
    }
}

/* ---- memory ----------------------------------------------------------------------------------------------------- */

static EnfResult read_boxes(BuildItem *to, const EnfBox3f *boxes, const uint32_t *items, uint32_t count, EnfError *error) {
    for (uint32_t i = 0; i < count; i++) {
        const float *min = &boxes[i].min.x, *max = &boxes[i].max.x;
        to[i].box = boxes[i];
        to[i].item = items ? items[i] : i;
        for (int axis = 0; axis < 3; axis++) {
            if (!(min[axis] >= -FLT_MAX && min[axis] <= max[axis] && max[axis] <= FLT_MAX)) {
                return enf_error_set(error, ENF_ERROR_ARGUMENT, UINT64_MAX, "kd: box %u is empty or not finite", i);
            }
            to[i].center[axis] = 0.5f * min[axis] + 0.5f * max[axis]; /* their sum could overflow */
        }
    }
    return ENF_OK;
}

/* The arrays as they are in `work`, without the room that was kept for the worst case. */
static EnfResult copy_exact(EnfKdBuilt *out, const EnfKdBuilt *work, EnfError *error) {
    *out = *work;
    out->nodes = enf_alloc(work->allocator, work->node_count, sizeof *out->nodes);
    out->blocks = enf_alloc(work->allocator, work->block_count, sizeof *out->blocks);
    if (!out->nodes || !out->blocks) {
        enf_kd_built_free(out);
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "kd: no memory for %u nodes", work->node_count);
    }
    memcpy(out->nodes, work->nodes, work->node_count * sizeof *out->nodes);
    memcpy(out->blocks, work->blocks, work->block_count * sizeof *out->blocks);
    return ENF_OK;
}

EnfResult enf_kd_build(EnfKdBuilt *out, const EnfBox3f *boxes, const uint32_t *items, uint32_t count,
                       const EnfAllocator *allocator, EnfError *error) {
    memset(out, 0, sizeof *out);
    out->allocator = allocator;
    if (count == 0) {
        return ENF_OK;
    }
    if (count > UINT32_MAX / 2) {
        return enf_error_set(error, ENF_ERROR_SIZE, UINT64_MAX, "kd: %u boxes are too many", count);
    }
    /* Every leaf holds an item, so there are at most `count` leaves, and no leaf has more blocks than items. */
    const uint32_t node_capacity = 2 * count - 1, block_capacity = count;
    EnfKdBuilt work = {NULL, NULL, 0, 0, allocator};
    work.nodes = enf_alloc(allocator, node_capacity, sizeof *work.nodes);
    work.blocks = enf_alloc(allocator, block_capacity, sizeof *work.blocks);
    Builder b = {enf_alloc(allocator, count, sizeof(BuildItem)), &work};
    EnfResult result = ENF_OK;
    if (!b.items || !work.nodes || !work.blocks) {
        result = enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "kd: no memory for %u boxes", count);
    } else {
        result = read_boxes(b.items, boxes, items, count, error);
    }
    if (result == ENF_OK) {
        build_nodes(&b, count);
        ENF_ASSERT(work.node_count <= node_capacity && work.block_count <= block_capacity);
        result = copy_exact(out, &work, error);
    }
    enf_free(allocator, b.items, count, sizeof(BuildItem));
    enf_free(allocator, work.nodes, node_capacity, sizeof *work.nodes);
    enf_free(allocator, work.blocks, block_capacity, sizeof *work.blocks);
    return result;
}

void enf_kd_built_free(EnfKdBuilt *built) {
    enf_free(built->allocator, built->nodes, built->node_count, sizeof *built->nodes);
    enf_free(built->allocator, built->blocks, built->block_count, sizeof *built->blocks);
    memset(built, 0, sizeof *built);
}
