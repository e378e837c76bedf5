/* Partition of a cell's triangles of one material into compact runs, by recursive halving at the best of a few planes. */
#include "compile/clusters.h"

#include "compile/exact.h"

#include <stdlib.h>
#include <string.h>

enum { BINS = 16, STACK_MAX = 64 };

/* No side of a split is smaller than this: tiny clusters cost a draw range each and cull little. */
enum { SIDE_MIN = 24 };

typedef struct GridBox {
    int64_t min[3], max[3];
} GridBox;

/* A plane that halves a run: triangles whose bin along `axis` is below `bin` go left. */
typedef struct Plane {
    int axis, bin; /* axis −1: none was found */
    double cost;
} Plane;

static GridBox empty_box(void) {
    GridBox box = {{INT64_MAX, INT64_MAX, INT64_MAX}, {INT64_MIN, INT64_MIN, INT64_MIN}};
    return box;
}

static void add(GridBox *box, const int64_t p[3]) {
    for (int axis = 0; axis < 3; axis++) {
        box->min[axis] = p[axis] < box->min[axis] ? p[axis] : box->min[axis];
        box->max[axis] = p[axis] > box->max[axis] ? p[axis] : box->max[axis];
    }
}

static void add_box(GridBox *box, const GridBox *other) {
    if (other->min[0] <= other->max[0]) {
        add(box, other->min);
        add(box, other->max);
    }
}

static double surface(const GridBox *box) {
    double x = (double)(box->max[0] - box->min[0]), y = (double)(box->max[1] - box->min[1]);
    double z = (double)(box->max[2] - box->min[2]);
    return x * y + y * z + z * x;
}

static void corners(const EnfSoup *soup, uint32_t triangle, int64_t out[3][3]) {
    for (int corner = 0; corner < 3; corner++) {
        EnfGrid3 p = soup->vertices[soup->triangles[triangle].v[corner]].p;
        out[corner][0] = p.x;
        out[corner][1] = p.y;
        out[corner][2] = p.z;
    }
}

/* Three times the centroid: an integer. */
static void centroid3(const EnfSoup *soup, uint32_t triangle, int64_t out[3]) {
    int64_t c[3][3];
    corners(soup, triangle, c);
    for (int axis = 0; axis < 3; axis++) {
        out[axis] = c[0][axis] + c[1][axis] + c[2][axis];
    }
}

static int bin_of(int64_t c, int64_t min, int64_t max) {
    return (int)((c - min) * BINS / (max - min + 1));
}

/* The best plane across one axis. */
static void try_axis(const GridBox boxes[BINS], const uint32_t counts[BINS], uint32_t count, int axis, Plane *best) {
    double right_cost[BINS + 1] = {0};
    uint32_t right_count = 0, left_count = 0;
    GridBox box = empty_box();
    for (int bin = BINS - 1; bin > 0; bin--) {
        add_box(&box, &boxes[bin]);
        right_count += counts[bin];
        right_cost[bin] = right_count ? surface(&box) * (double)right_count : 0;
    }
    box = empty_box();
    for (int bin = 1; bin < BINS; bin++) {
        add_box(&box, &boxes[bin - 1]);
        left_count += counts[bin - 1];
        uint32_t smaller = left_count < count - left_count ? left_count : count - left_count;
        if (smaller < SIDE_MIN) {
            continue;
        }
        double cost = surface(&box) * (double)left_count + right_cost[bin];
        if (best->axis < 0 || cost < best->cost) {
            *best = (Plane){axis, bin, cost};
        }
    }
}

static Plane best_plane(const EnfSoup *soup, const uint32_t *triangles, uint32_t count, const GridBox *centroids) {
    Plane best = {-1, 0, 0};
    GridBox boxes[3][BINS];
    uint32_t counts[3][BINS];
    memset(counts, 0, sizeof counts);
    for (int i = 0; i < 3 * BINS; i++) {
        boxes[i / BINS][i % BINS] = empty_box();
    }
    for (uint32_t i = 0; i < count; i++) {
        int64_t c[3][3], center[3];
        corners(soup, triangles[i], c);
        centroid3(soup, triangles[i], center);
        for (int axis = 0; axis < 3; axis++) {
            int bin = bin_of(center[axis], centroids->min[axis], centroids->max[axis]);
            counts[axis][bin]++;
            for (int corner = 0; corner < 3; corner++) {
                add(&boxes[axis][bin], c[corner]);
            }
        }
    }
    for (int axis = 0; axis < 3; axis++) {
        try_axis(boxes[axis], counts[axis], count, axis, &best);
    }
    return best;
}

/* Moves the triangles left of the plane to the front, keeping the order on either side. Returns how many they are. */
static uint32_t move_left(const EnfSoup *soup, uint32_t *triangles, uint32_t count, const GridBox *centroids, Plane plane,
                          uint32_t *scratch) {
    uint32_t left = 0, right = 0;
    int64_t min = centroids->min[plane.axis], max = centroids->max[plane.axis];
    for (uint32_t i = 0; i < count; i++) {
        int64_t center[3];
        centroid3(soup, triangles[i], center);
        if (bin_of(center[plane.axis], min, max) < plane.bin) {
            triangles[left++] = triangles[i];
        } else {
            scratch[right++] = triangles[i];
        }
    }
    memcpy(triangles + left, scratch, right * sizeof *scratch);
    return left;
}

/* Halves a run; both sides are smaller than it. Where no plane parts it well, the order of the file does. */
static uint32_t halve(const EnfSoup *soup, uint32_t *triangles, uint32_t count, uint32_t *scratch) {
    GridBox centroids = empty_box();
    for (uint32_t i = 0; i < count; i++) {
        int64_t center[3];
        centroid3(soup, triangles[i], center);
        add(&centroids, center);
    }
    Plane plane = best_plane(soup, triangles, count, &centroids);
    return plane.axis < 0 ? count / 2 : move_left(soup, triangles, count, &centroids, plane, scratch);
}

void enf_cluster_partition(const EnfSoup *soup, uint32_t *triangles, uint32_t count, uint8_t *starts) {
    struct {
        uint32_t first, count;
    } stack[STACK_MAX];
    uint32_t depth = 0;
    memset(starts, 0, count);
    uint32_t *scratch = count > ENF_CLUSTER_TRIANGLES ? malloc(count * sizeof *scratch) : NULL;
    stack[depth].first = 0;
    stack[depth++].count = count;
    while (depth > 0) {
        uint32_t first = stack[--depth].first, run = stack[depth].count;
        if (run <= ENF_CLUSTER_TRIANGLES) {
            starts[first] = 1;
            continue;
        }
        /* Out of memory, or a stack full of lopsided halves: equal halves need neither. */
        bool plain = !scratch || depth + 2 > STACK_MAX - 32;
        uint32_t left = plain ? run / 2 : halve(soup, triangles + first, run, scratch);
        stack[depth].first = first + left;
        stack[depth++].count = run - left;
        stack[depth].first = first;
        stack[depth++].count = left;
    }
    free(scratch);
}
