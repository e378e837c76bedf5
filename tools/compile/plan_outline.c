/* Outlines from triangles: edges of what faces up, seen from above, cancel where two of them meet; what is left is walked into
 * loops. Treads of stairs meet in the plan though risers part them, so heights are left out of the comparison. */
#include "compile/plan_outline.h"

#include "compile/exact.h"
#include "compile/plan_storeys.h"

#include <enfilade/tolerances.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Loops smaller than this (square metres) are clutter. */
#define AREA_MIN 0.02
/* With this many loops, only those of the size of a table or more are drawn. */
enum { LOOPS_MANY = 150, LOOPS_MAX = 1000 };
/* Points compared with borders while a place for a name is sought. */
#define LABEL_WORK 300000.0
#define AREA_MIN_MANY 0.3
/* How far off an edge (metres) the plan is looked at. */
#define OFFSET 0.002

typedef struct Flat {
    int64_t x, z;
} Flat;

typedef struct FlatEdge {
    Flat from, to;
    bool used;
} FlatEdge;

static int compare_flat(Flat a, Flat b) {
    if (a.x != b.x) {
        return a.x < b.x ? -1 : 1;
    }
    return (a.z > b.z) - (a.z < b.z);
}

static Flat smaller(const FlatEdge *e) {
    return compare_flat(e->from, e->to) < 0 ? e->from : e->to;
}

static Flat larger(const FlatEdge *e) {
    return compare_flat(e->from, e->to) < 0 ? e->to : e->from;
}

/* Edges with the same ends come together, whichever way they run. */
static int compare_ends(const void *left, const void *right) {
    int first = compare_flat(smaller(left), smaller(right));
    return first ? first : compare_flat(larger(left), larger(right));
}

static int compare_starts(const void *left, const void *right) {
    const FlatEdge *a = left, *b = right;
    int first = compare_flat(a->from, b->from);
    return first ? first : compare_flat(a->to, b->to);
}

/* ---- edges ------------------------------------------------------------------------------------------------------ */

static uint32_t find_edges(const EnfSoup *soup, const uint32_t *triangles, uint32_t count, FlatEdge *edges) {
    uint32_t made = 0;
    for (uint32_t i = 0; i < count; i++) {
        const EnfSoupTriangle *t = &soup->triangles[triangles[i]];
        for (int corner = 0; corner < 3 && enf_plan_faces_up(soup, triangles[i]); corner++) {
            EnfGrid3 a = soup->vertices[t->v[corner]].p, b = soup->vertices[t->v[(corner + 1) % 3]].p;
            FlatEdge edge = {{a.x, a.z}, {b.x, b.z}, false};
            if (compare_flat(edge.from, edge.to) != 0) {
                edges[made++] = edge;
            }
        }
    }
    return made;
}

/* Leaves, of edges with the same ends, as many as run one way more than the other: what is left still closes everywhere. */
static uint32_t cancel(FlatEdge *edges, uint32_t count) {
    uint32_t kept = 0;
    qsort(edges, count, sizeof *edges, compare_ends);
    for (uint32_t first = 0, end; first < count; first = end) {
        int balance = 0;
        Flat low = smaller(&edges[first]), high = larger(&edges[first]);
        for (end = first;
             end < count && compare_flat(smaller(&edges[end]), low) == 0 && compare_flat(larger(&edges[end]), high) == 0;
             end++) {
            balance += compare_flat(edges[end].from, low) == 0 ? 1 : -1;
        }
        for (int i = 0; i < abs(balance); i++) {
            edges[kept++] = balance > 0 ? (FlatEdge){low, high, false} : (FlatEdge){high, low, false};
        }
    }
    return kept;
}

/* ---- loops ------------------------------------------------------------------------------------------------------ */

/* How far to the left the way turns from one edge to the next, −π to π; turning back counts as left. */
static double turn(const FlatEdge *from, const FlatEdge *to) {
    double ax = (double)(from->to.x - from->from.x), az = (double)(from->to.z - from->from.z);
    double bx = (double)(to->to.x - to->from.x), bz = (double)(to->to.z - to->from.z);
    double cross = ax * bz - az * bx, dot = ax * bx + az * bz;
    return cross == 0 && dot < 0 ? ENF_PI : enf_atan2(cross, dot);
}

/* The unused edge that goes on from the end of `edge`: where several do, the rightmost, on whose side the floor is, so that loops
 * which touch at a corner stay apart. */
static FlatEdge *next_edge(FlatEdge *edges, uint32_t count, const FlatEdge *edge) {
    uint32_t low = 0, high = count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (compare_flat(edges[middle].from, edge->to) < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    FlatEdge *best = NULL;
    for (; low < count && compare_flat(edges[low].from, edge->to) == 0; low++) {
        if (!edges[low].used && (!best || turn(edge, &edges[low]) < turn(edge, best))) {
            best = &edges[low];
        }
    }
    return best;
}

static void add_point(EnfPlanOutline *outline, Flat p) {
    if (!ENF_ARRAY_ROOM(&outline->points, 1)) {
        outline->failed = true;
        return;
    }
    outline->points.data[outline->points.count++] = (EnfPlanPoint){(double)p.x * ENF_GRID_STEP, (double)p.z * ENF_GRID_STEP};
}

/* Leaves out points between collinear neighbours; returns the new count. */
static uint32_t straighten(EnfPlanPoint *points, uint32_t count) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count && count > 3; i++) {
        EnfPlanPoint a = points[kept ? kept - 1 : count - 1], b = points[i], c = points[(i + 1) % count];
        double cross = (b.x - a.x) * (c.z - b.z) - (b.z - a.z) * (c.x - b.x);
        if (fabs(cross) > 1e-6) {
            points[kept++] = b;
        }
    }
    return count > 3 ? kept : count;
}

static double loop_area(const EnfPlanPoint *points, uint32_t count) {
    double twice = 0;
    for (uint32_t i = 0; i < count; i++) {
        EnfPlanPoint a = points[i], b = points[(i + 1) % count];
        twice += b.x * a.z - a.x * b.z;
    }
    return 0.5 * twice;
}

static void walk(EnfPlanOutline *outline, FlatEdge *edges, uint32_t count, FlatEdge *edge) {
    EnfPlanLoop loop = {outline->points.count, 0, 0, false, false};
    Flat start = edge->from;
    while (edge && !outline->failed) {
        edge->used = true;
        add_point(outline, edge->from);
        edge = compare_flat(edge->to, start) == 0 ? NULL : next_edge(edges, count, edge);
    }
    EnfPlanPoint *points = outline->points.data + loop.point_first;
    loop.point_count = straighten(points, outline->points.count - loop.point_first);
    outline->points.count = loop.point_first + loop.point_count;
    loop.area = loop_area(points, loop.point_count);
    if (loop.point_count < 3 || fabs(loop.area) < AREA_MIN || !ENF_ARRAY_ROOM(&outline->loops, 1)) {
        outline->points.count = loop.point_first;
        return;
    }
    outline->loops.data[outline->loops.count++] = loop;
}

static int compare_loops(const void *left, const void *right) {
    const EnfPlanLoop *a = left, *b = right;
    double difference = fabs(b->area) - fabs(a->area);
    return difference != 0 ? (difference > 0 ? 1 : -1) : (a->point_first > b->point_first) - (a->point_first < b->point_first);
}

static bool point_inside(const EnfPlanOutline *outline, const EnfPlanLoop *loop, EnfPlanPoint p) {
    bool in = false;
    for (uint32_t i = 0; i < loop->point_count; i++) {
        EnfPlanPoint a = outline->points.data[loop->point_first + i];
        EnfPlanPoint b = outline->points.data[loop->point_first + (i + 1) % loop->point_count];
        if ((a.z > p.z) != (b.z > p.z) && p.x < a.x + (p.z - a.z) / (b.z - a.z) * (b.x - a.x)) {
            in = !in;
        }
    }
    return in;
}

/* How many layers of floor lie at `p`. */
static int layers(const EnfPlanOutline *outline, EnfPlanPoint p) {
    int count = 0;
    for (uint32_t i = 0; i < outline->loops.count; i++) {
        if (point_inside(outline, &outline->loops.data[i], p)) {
            count += outline->loops.data[i].area > 0 ? 1 : -1;
        }
    }
    return count;
}

/* A point just off the loop's longest edge, on the side where it has no floor. */
static EnfPlanPoint just_off(const EnfPlanOutline *outline, const EnfPlanLoop *loop) {
    EnfPlanPoint best = {0, 0};
    double longest = -1;
    for (uint32_t i = 0; i < loop->point_count; i++) {
        EnfPlanPoint a = outline->points.data[loop->point_first + i];
        EnfPlanPoint b = outline->points.data[loop->point_first + (i + 1) % loop->point_count];
        double dx = b.x - a.x, dz = b.z - a.z, length = sqrt(dx * dx + dz * dz);
        if (length > longest) {
            longest = length;
            best = (EnfPlanPoint){(a.x + b.x) / 2 - OFFSET * dz / length, (a.z + b.z) / 2 + OFFSET * dx / length};
        }
    }
    return best;
}

/* Drops clutter, and finds which loops border on further floor: those are things, or holes in things. */
static void sort_loops(EnfPlanOutline *outline) {
    if (outline->loops.count == 0) {
        return;
    }
    qsort(outline->loops.data, outline->loops.count, sizeof *outline->loops.data, compare_loops);
    while (outline->loops.count > LOOPS_MANY &&
           (outline->loops.count > LOOPS_MAX || fabs(outline->loops.data[outline->loops.count - 1].area) < AREA_MIN_MANY)) {
        outline->loops.count--;
    }
    for (uint32_t i = 0; i < outline->loops.count; i++) {
        EnfPlanLoop *loop = &outline->loops.data[i];
        loop->inner = layers(outline, just_off(outline, loop)) > 0;
        loop->thing = loop->inner && fabs(loop->area) < 0.5 * fabs(outline->loops.data[0].area);
    }
}

/* ---- the label -------------------------------------------------------------------------------------------------- */

/* Metres from `p` to the nearest border of the floor; negative if it is not on it. */
static double clearance(const EnfPlanOutline *outline, EnfPlanPoint p) {
    double nearest = 1e300;
    for (uint32_t i = 0; i < outline->loops.count; i++) {
        const EnfPlanLoop *loop = &outline->loops.data[i];
        for (uint32_t k = 0; k < loop->point_count && (!loop->inner || i == 0); k++) {
            EnfPlanPoint a = outline->points.data[loop->point_first + k];
            EnfPlanPoint b = outline->points.data[loop->point_first + (k + 1) % loop->point_count];
            double dx = b.x - a.x, dz = b.z - a.z, length2 = dx * dx + dz * dz;
            double t = length2 > 0 ? ((p.x - a.x) * dx + (p.z - a.z) * dz) / length2 : 0;
            t = t < 0 ? 0 : t > 1 ? 1 : t;
            double x = a.x + t * dx - p.x, z = a.z + t * dz - p.z;
            nearest = fmin(nearest, x * x + z * z);
        }
    }
    return layers(outline, p) > 0 ? sqrt(nearest) : -1;
}

static EnfPlanPoint centroid(const EnfPlanOutline *outline, const EnfPlanLoop *loop) {
    double x = 0, z = 0, twice = 0;
    for (uint32_t i = 0; i < loop->point_count; i++) {
        EnfPlanPoint a = outline->points.data[loop->point_first + i];
        EnfPlanPoint b = outline->points.data[loop->point_first + (i + 1) % loop->point_count];
        double cross = b.x * a.z - a.x * b.z;
        twice += cross;
        x += (a.x + b.x) * cross;
        z += (a.z + b.z) * cross;
    }
    return (EnfPlanPoint){x / (3 * twice), z / (3 * twice)};
}

/* The middle of the largest loop, unless a point of a raster over it is clearly farther from every border: rooms are not convex,
 * and have holes. The raster is coarser where there is more to compare with. */
static void place_label(EnfPlanOutline *outline) {
    const EnfPlanLoop *loop = &outline->loops.data[0];
    EnfPlanPoint low = outline->points.data[loop->point_first], high = low;
    for (uint32_t i = 1; i < loop->point_count; i++) {
        EnfPlanPoint p = outline->points.data[loop->point_first + i];
        low = (EnfPlanPoint){fmin(low.x, p.x), fmin(low.z, p.z)};
        high = (EnfPlanPoint){fmax(high.x, p.x), fmax(high.z, p.z)};
    }
    outline->label = centroid(outline, loop);
    double best = 1.5 * clearance(outline, outline->label);
    int steps = (int)sqrt(LABEL_WORK / (double)outline->points.count);
    steps = steps < 4 ? 4 : steps > 20 ? 20 : steps;
    for (int i = 0; i < steps * steps; i++) {
        int column = i % steps, row = i / steps;
        EnfPlanPoint p = {low.x + (high.x - low.x) * (column + 0.5) / steps, low.z + (high.z - low.z) * (row + 0.5) / steps};
        double clear = clearance(outline, p);
        if (clear > best) {
            best = clear;
            outline->label = p;
        }
    }
    outline->clearance = clearance(outline, outline->label);
}

void enf_plan_outline(EnfPlanOutline *outline, const EnfSoup *soup, const uint32_t *triangles, uint32_t count) {
    memset(outline, 0, sizeof *outline);
    FlatEdge *edges = malloc(((size_t)count * 3 + 1) * sizeof *edges);
    if (!edges) {
        outline->failed = true;
        return;
    }
    uint32_t edge_count = cancel(edges, find_edges(soup, triangles, count, edges));
    qsort(edges, edge_count, sizeof *edges, compare_starts);
    for (uint32_t i = 0; i < edge_count && !outline->failed; i++) {
        if (!edges[i].used) {
            walk(outline, edges, edge_count, &edges[i]);
        }
    }
    free(edges);
    sort_loops(outline);
    if (outline->loops.count > 0) {
        place_label(outline);
    }
}

void enf_plan_outline_free(EnfPlanOutline *outline) {
    free(outline->points.data);
    free(outline->loops.data);
    memset(outline, 0, sizeof *outline);
}
