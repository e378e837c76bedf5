/* Closed parts of a surface. Input: triangles on the grid; output: those that belong to a part without a border.
 *
 * Edges are counted with their direction; what cancels is no border. Portals and walls may subdivide a common edge differently, so what
 * is left is cut at each other's ends and counted once more. */
#include "compile/regions_closed.h"

#include "compile/array.h"
#include "compile/exact.h"
#include "compile/union_find.h"

#include <enfilade/tolerances.h>

enum { LEFTOVERS_MAX = 768 }; /* more borders than this are a flood's task */

typedef struct Point {
    EnfGrid3 p;
    uint32_t corner;
} Point;

/* A directed edge: low < high, sign +1 if walked from low to high. */
typedef struct Edge {
    uint32_t low, high, triangle;
    int sign;
} Edge;

typedef struct Closing {
    const EnfSurface *surface;
    uint32_t *vertex_of; /* by corner */
    EnfGrid3 *vertices;
    uint32_t vertex_count;
    uint32_t *parents; /* union-find over triangles that share edges */
    ENF_ARRAY(Edge) edges;
} Closing;

static int compare_points(const void *pa, const void *pb) {
    const Point *a = pa, *b = pb;
    int order = enf_grid_compare(a->p, b->p);
    return order != 0 ? order : (a->corner > b->corner) - (a->corner < b->corner);
}

static int compare_edges(const void *pa, const void *pb) {
    const Edge *a = pa, *b = pb;
    if (a->low != b->low) {
        return a->low < b->low ? -1 : 1;
    }
    if (a->high != b->high) {
        return a->high < b->high ? -1 : 1;
    }
    return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

static bool weld(Closing *closing) {
    uint32_t count = 3 * closing->surface->triangle_count;
    Point *points = malloc(((size_t)count + 1) * sizeof *points);
    if (points == NULL) {
        return false;
    }
    for (uint32_t i = 0; i < count; i++) {
        points[i] = (Point){closing->surface->corners[i], i};
    }
    qsort(points, count, sizeof *points, compare_points);
    for (uint32_t i = 0; i < count; i++) {
        if (i == 0 || !enf_grid_equal(points[i].p, points[i - 1].p)) {
            closing->vertices[closing->vertex_count++] = points[i].p;
        }
        closing->vertex_of[points[i].corner] = closing->vertex_count - 1;
    }
    free(points);
    return true;
}

static bool push_edge(Closing *closing, uint32_t from, uint32_t to, uint32_t triangle) {
    if (from == to) {
        return true;
    }
    if (!ENF_ARRAY_ROOM(&closing->edges, 1)) {
        return false;
    }
    closing->edges.data[closing->edges.count++] = (Edge){from < to ? from : to, from < to ? to : from, triangle,
                                                         from < to ? 1 : -1};
    return true;
}

/* Sorts the edges, unites triangles on the same edge, and keeps one record for each unit of imbalance. */
static void cancel(Closing *closing) {
    Edge *edges = closing->edges.data;
    uint32_t kept = 0, count = closing->edges.count;
    if (count == 0) {
        return;
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (uint32_t first = 0, end; first < count; first = end) {
        int sum = 0;
        for (end = first; end < count && edges[end].low == edges[first].low && edges[end].high == edges[first].high; end++) {
            sum += edges[end].sign;
            enf_sets_join(closing->parents, edges[first].triangle, edges[end].triangle);
        }
        Edge left = edges[first];
        left.sign = sum < 0 ? -1 : 1;
        for (int i = 0; i < (sum < 0 ? -sum : sum); i++) {
            edges[kept++] = left;
        }
    }
    closing->edges.count = kept;
}

static EnfVec3 metres(EnfGrid3 a, EnfGrid3 b) {
    return enf_scale(enf_v3((double)(a.x - b.x), (double)(a.y - b.y), (double)(a.z - b.z)), ENF_GRID_STEP);
}

/* Where along a → b the point lies, in (0, 1), or −1 if it is not on it: within two steps, as snapping bends edges. */
static double place_on(EnfGrid3 a, EnfGrid3 b, EnfGrid3 p) {
    EnfVec3 along = metres(b, a), to = metres(p, a);
    double length2 = enf_dot(along, along), t = enf_dot(along, to) / length2;
    EnfVec3 off = enf_sub(to, enf_scale(along, t));
    bool on = t > 0.0 && t < 1.0 && enf_dot(off, off) <= 4.0 * ENF_GRID_STEP * ENF_GRID_STEP;
    return on ? t : -1.0;
}

typedef struct Cut {
    double t;
    uint32_t vertex;
} Cut;

static int compare_cuts(const void *pa, const void *pb) {
    const Cut *a = pa, *b = pb;
    if (a->t < b->t || a->t > b->t) {
        return a->t < b->t ? -1 : 1;
    }
    return (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

/* Cuts what is left at each other's ends. */
static bool cut_leftovers(Closing *closing) {
    uint32_t count = closing->edges.count;
    Edge *old = malloc(((size_t)count + 1) * sizeof *old);
    Cut *cuts = malloc((2 * (size_t)count + 2) * sizeof *cuts);
    bool ok = old != NULL && cuts != NULL;
    if (ok) {
        memcpy(old, closing->edges.data, count * sizeof *old);
        closing->edges.count = 0;
    }
    for (uint32_t i = 0; ok && i < count; i++) {
        uint32_t from = old[i].sign > 0 ? old[i].low : old[i].high, to = old[i].sign > 0 ? old[i].high : old[i].low;
        uint32_t cut_count = 0;
        for (uint32_t k = 0; k < 2 * count; k++) {
            uint32_t vertex = k % 2 ? old[k / 2].low : old[k / 2].high;
            double t = vertex == from || vertex == to
                           ? -1.0
                           : place_on(closing->vertices[from], closing->vertices[to], closing->vertices[vertex]);
            if (t > 0.0) {
                cuts[cut_count++] = (Cut){t, vertex};
            }
        }
        qsort(cuts, cut_count, sizeof *cuts, compare_cuts);
        for (uint32_t k = 0; ok && k <= cut_count; k++) {
            uint32_t next = k < cut_count ? cuts[k].vertex : to;
            ok = push_edge(closing, from, next, old[i].triangle);
            from = next;
        }
    }
    free(old);
    free(cuts);
    return ok;
}

static bool close(Closing *closing, bool *out) {
    uint32_t count = closing->surface->triangle_count;
    bool ok = weld(closing);
    for (uint32_t t = 0; ok && t < count; t++) {
        const uint32_t *v = &closing->vertex_of[3 * (size_t)t];
        closing->parents[t] = t;
        ok = push_edge(closing, v[0], v[1], t) && push_edge(closing, v[1], v[2], t) && push_edge(closing, v[2], v[0], t);
    }
    if (!ok) {
        return false;
    }
    cancel(closing);
    if (closing->edges.count > 0 && closing->edges.count <= LEFTOVERS_MAX) {
        if (!cut_leftovers(closing)) {
            return false;
        }
        cancel(closing);
    }
    for (uint32_t t = 0; t < count; t++) {
        out[t] = true;
    }
    for (uint32_t i = 0; i < closing->edges.count; i++) {
        out[enf_sets_find(closing->parents, closing->edges.data[i].triangle)] = false;
    }
    for (uint32_t t = 0; t < count; t++) {
        out[t] = out[enf_sets_find(closing->parents, t)]; /* roots come first */
    }
    return true;
}

bool enf_surface_closed_parts(const EnfSurface *surface, bool *out) {
    size_t n = (size_t)surface->triangle_count + 1;
    Closing closing = {.surface = surface};
    closing.vertex_of = malloc(3 * n * sizeof *closing.vertex_of);
    closing.vertices = malloc(3 * n * sizeof *closing.vertices);
    closing.parents = malloc(n * sizeof *closing.parents);
    bool ok = closing.vertex_of && closing.vertices && closing.parents && close(&closing, out);
    for (uint32_t t = 0; !ok && t < surface->triangle_count; t++) {
        out[t] = false;
    }
    free(closing.vertex_of);
    free(closing.vertices);
    free(closing.parents);
    free(closing.edges.data);
    return ok;
}

/* +1 for a front, −1 for a back, 0 for a miss. */
static int crossing(const EnfGrid3 *corners, EnfVec3 p, EnfVec3 direction) {
    EnfVec3 a = enf_grid_point(corners[0]), u = metres(corners[1], corners[0]), v = metres(corners[2], corners[0]);
    EnfVec3 pv = enf_cross(direction, v);
    double det = enf_dot(u, pv), sign = det < 0.0 ? -1.0 : 1.0, size = det * sign;
    EnfVec3 s = enf_sub(p, a), q = enf_cross(s, u);
    double x = enf_dot(s, pv) * sign, y = enf_dot(direction, q) * sign, t = enf_dot(v, q) * sign;
    bool hit = size > 0.0 && x >= 0.0 && y >= 0.0 && x + y <= size && t > 0.0;
    return hit ? (det > 0.0 ? 1 : -1) : 0;
}

bool enf_surface_encloses(const EnfSurface *surface, const bool *closed, EnfVec3 p) {
    static const EnfVec3 rays[3] = {
        {0.577215, 0.693147, 0.431734}, {-0.618034, 0.302585, 0.725661}, {0.137035, -0.914213, 0.381966}};
    for (int i = 0; i < 3; i++) {
        int sum = 0;
        for (uint32_t t = 0; t < surface->triangle_count; t++) {
            if (closed[t]) {
                sum += crossing(&surface->corners[3 * (size_t)t], p, rays[i]);
            }
        }
        if (sum < 1) {
            return false;
        }
    }
    return true;
}
