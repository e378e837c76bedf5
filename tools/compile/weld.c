/* Mending of T-junctions. Where a vertex of one triangle lies inside an edge of another, rasterisers leave pixels between the
 * two uncovered, because the two borders round differently; splitting the other triangle there makes the borders equal.
 *
 * Edges are matched cell by cell: floors of two rooms may share an edge through a wall of no thickness, and would then hide that
 * each of them lacks the vertices of its own wall. So a first round mends every cell by itself. What is open after it are the
 * borders of openings, where surfaces of several cells meet; a second round mends these across cells. */
#include "compile/weld.h"

#include "compile/array.h"
#include "compile/edges.h"
#include "compile/point_tree.h"

#include <stdlib.h>
#include <string.h>

/* A split bends its edge by up to √3 steps, so a further vertex may come within reach: later passes look at the new halves only.
 * Real levels need one or two. */
enum { PASSES_MAX = 8 };

/* A bound against hostile levels (thousands of edges along one line): what exceeds it stays as it was. */
static uint64_t hits_max(uint32_t triangle_count) {
    return (uint64_t)triangle_count * 16 + (1u << 16);
}

typedef ENF_ARRAY(EnfEdgeRef) EdgeList;
typedef ENF_ARRAY(uint32_t) PositionList;

/* A part of a triangle that is being split: corners, and for each edge the new vertices still to be put into it. */
typedef struct Piece {
    uint32_t v[3];
    uint32_t first[3], count[3]; /* in Weld.added, in the edge's direction */
    bool fresh[3];               /* half of an edge that was split */
} Piece;

/* A position as it may be put into the edges of a cell; in the second round the cell is ENF_NONE, and stands for all. */
typedef struct Candidate {
    uint32_t cell, position;
} Candidate;

/* The candidates of one cell. */
typedef struct Grove {
    uint32_t cell;
    EnfPointTree *tree;
} Grove;

typedef struct Weld {
    ENF_ARRAY(EnfSoupVertex) vertices;
    ENF_ARRAY(EnfSoupTriangle) triangles;
    bool across;             /* the second round: vertices of all cells */
    Candidate *candidates;   /* ascending */
    EnfGrid3 *points;        /* of the candidates */
    ENF_ARRAY(Grove) groves; /* ascending by cell */
    EdgeList work, next;     /* edges of this pass and of the next, ascending */
    PositionList hits;       /* candidates on the edges of `work`, edge by edge, in the edge's direction */
    uint32_t *hit_first;     /* edge i: hits [hit_first[i], hit_first[i + 1]) */
    PositionList added;      /* soup vertices made for the triangle at hand */
    ENF_ARRAY(Piece) pieces;
    EnfGrid3 normal; /* of the triangle at hand, before this pass */
    uint32_t split_count;
    uint64_t hits_max;
    EnfGrid3 apex; /* of the triangle whose edge is being asked about */
    bool failed;   /* out of memory */
} Weld;

/* ---- which vertices lie on which edges -------------------------------------------------------------------------- */

static EnfGrid3 corner_point(const Weld *weld, EnfEdgeRef edge, uint32_t step) {
    return weld->vertices.data[weld->triangles.data[edge.triangle].v[(edge.corner + step) % 3]].p;
}

static const EnfPointTree *find_tree(const Weld *weld, uint32_t cell) {
    uint32_t wanted = weld->across ? ENF_NONE : cell, low = 0, high = weld->groves.count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (weld->groves.data[middle].cell < wanted) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < weld->groves.count && weld->groves.data[low].cell == wanted ? weld->groves.data[low].tree : NULL;
}

static bool take_hit(void *user, uint32_t id) {
    Weld *weld = user;
    if (enf_grid_equal(weld->points[id], weld->apex)) {
        return true;
    }
    if (weld->hits.count >= weld->hits_max) {
        return false;
    }
    if (!ENF_ARRAY_ROOM(&weld->hits, 1)) {
        weld->failed = true;
        return false;
    }
    weld->hits.data[weld->hits.count++] = id;
    return true;
}

/* Is position `a` nearer to the edge's start than `b`? Ties by coordinates, so that the order of the input does not matter. */
static bool comes_before(const EnfGrid3 *points, uint32_t a, uint32_t b, EnfGrid3 start, EnfGrid3 along) {
    int64_t da = enf_grid_dot(enf_grid_sub(points[a], start), along);
    int64_t db = enf_grid_dot(enf_grid_sub(points[b], start), along);
    return da != db ? da < db : enf_grid_compare(points[a], points[b]) < 0;
}

/* Shell sort with Ciura's gaps: the lists are short, and qsort takes no context in C11. */
static void sort_along(uint32_t *ids, uint32_t count, const EnfGrid3 *points, EnfGrid3 start, EnfGrid3 along) {
    static const uint32_t gaps[] = {1750, 701, 301, 132, 57, 23, 10, 4, 1};
    for (size_t g = 0; g < sizeof gaps / sizeof *gaps; g++) {
        for (uint32_t i = gaps[g]; i < count; i++) {
            uint32_t moved = ids[i], j = i;
            for (; j >= gaps[g] && comes_before(points, moved, ids[j - gaps[g]], start, along); j -= gaps[g]) {
                ids[j] = ids[j - gaps[g]];
            }
            ids[j] = moved;
        }
    }
}

static bool find_hits(Weld *weld) {
    weld->hits.count = 0;
    free(weld->hit_first);
    weld->hit_first = malloc(((size_t)weld->work.count + 1) * sizeof *weld->hit_first);
    if (!weld->hit_first) {
        return false;
    }
    for (uint32_t i = 0; i < weld->work.count; i++) {
        uint32_t first = weld->hits.count;
        EnfGrid3 a = corner_point(weld, weld->work.data[i], 0), b = corner_point(weld, weld->work.data[i], 1);
        weld->apex = corner_point(weld, weld->work.data[i], 2);
        weld->hit_first[i] = first;
        if (!enf_grid_short(enf_grid_sub(b, a)) || !enf_grid_short(enf_grid_sub(weld->apex, a))) {
            continue;
        }
        const EnfPointTree *tree = find_tree(weld, weld->triangles.data[weld->work.data[i].triangle].cell);
        if (tree) {
            enf_point_tree_segment(tree, a, b, take_hit, weld);
        }
        sort_along(ENF_ARRAY_FROM(&weld->hits, first), weld->hits.count - first, weld->points, a, enf_grid_sub(b, a));
    }
    weld->hit_first[weld->work.count] = weld->hits.count;
    return !weld->failed;
}

/* ---- splitting -------------------------------------------------------------------------------------------------- */

static float mix(float a, float b, double t) {
    return (float)((double)a + ((double)b - (double)a) * t);
}

/* A vertex on the edge a b at position p; returns its number. */
static uint32_t add_vertex(Weld *weld, uint32_t a, uint32_t b, EnfGrid3 p) {
    if (!ENF_ARRAY_ROOM(&weld->vertices, 1)) {
        weld->failed = true;
        return a;
    }
    const EnfSoupVertex *from = &weld->vertices.data[a], *to = &weld->vertices.data[b];
    EnfGrid3 along = enf_grid_sub(to->p, from->p);
    double t = (double)enf_grid_dot(enf_grid_sub(p, from->p), along) / (double)enf_grid_dot(along, along);
    EnfSoupVertex made = {.p = p, .uv = {mix(from->uv[0], to->uv[0], t), mix(from->uv[1], to->uv[1], t)}};
    for (int i = 0; i < 4; i++) {
        made.color[i] = mix(from->color[i], to->color[i], t);
    }
    EnfVec3 n = {(double)mix(from->normal[0], to->normal[0], t), (double)mix(from->normal[1], to->normal[1], t),
                 (double)mix(from->normal[2], to->normal[2], t)};
    n = enf_normalize(n);
    bool lost = n.x == 0 && n.y == 0 && n.z == 0; /* opposite normals */
    for (int i = 0; i < 3; i++) {
        const double component[3] = {n.x, n.y, n.z};
        made.normal[i] = lost ? from->normal[i] : (float)component[i];
    }
    weld->vertices.data[weld->vertices.count] = made;
    return weld->vertices.count++;
}

static EnfGrid3 triangle_normal(const Weld *weld, uint32_t a, uint32_t b, uint32_t c) {
    const EnfSoupVertex *v = weld->vertices.data;
    return enf_grid_cross(enf_grid_sub(v[b].p, v[a].p), enf_grid_sub(v[c].p, v[a].p));
}

/* Would a triangle of these corners have an area, and face as the whole did? */
static bool faces_right(const Weld *weld, uint32_t a, uint32_t b, uint32_t c) {
    return enf_grid_dot_wide(triangle_normal(weld, a, b, c), weld->normal) > 0;
}

static void push_piece(Weld *weld, Piece piece) {
    if (!ENF_ARRAY_ROOM(&weld->pieces, 1)) {
        weld->failed = true;
        return;
    }
    weld->pieces.data[weld->pieces.count++] = piece;
}

/* Splits `piece` at the middle vertex of edge `e`: into the part with the edge's start and the part with its end. */
static void halve(Weld *weld, Piece piece, uint32_t e) {
    uint32_t f = (e + 1) % 3, g = (e + 2) % 3;
    uint32_t before = piece.count[e] / 2, at = piece.first[e] + before;
    uint32_t middle = weld->added.data[at];
    if (!faces_right(weld, piece.v[e], middle, piece.v[g]) || !faces_right(weld, middle, piece.v[f], piece.v[g])) {
        uint32_t after = piece.count[e] - before - 1;
        memmove(&weld->added.data[at], &weld->added.data[at + 1], after * sizeof *weld->added.data);
        piece.count[e]--;
        push_piece(weld, piece);
        return;
    }
    Piece start = piece, end = piece;
    start.v[f] = middle;
    start.count[e] = before;
    start.fresh[e] = end.fresh[e] = true;
    start.count[f] = 0; /* the new inner edge: whole, and shared by the two parts */
    start.fresh[f] = false;
    end.v[e] = middle;
    end.first[e] = at + 1;
    end.count[e] = piece.count[e] - before - 1;
    end.count[g] = 0;
    end.fresh[g] = false;
    weld->split_count++;
    push_piece(weld, end);
    push_piece(weld, start);
}

static bool remember(EdgeList *list, uint32_t triangle, uint32_t corner) {
    if (!ENF_ARRAY_ROOM(list, 1)) {
        return false;
    }
    list->data[list->count++] = (EnfEdgeRef){triangle, corner};
    return true;
}

/* Puts a finished piece in the place of its triangle (the first one), or at the end. */
static void emit(Weld *weld, const Piece *piece, uint32_t triangle, bool first) {
    uint32_t place = first ? triangle : weld->triangles.count;
    if (!first && !ENF_ARRAY_ROOM(&weld->triangles, 1)) {
        weld->failed = true;
        return;
    }
    EnfSoupTriangle made = weld->triangles.data[triangle];
    memcpy(made.v, piece->v, sizeof made.v);
    weld->triangles.data[place] = made;
    weld->triangles.count += !first;
    for (uint32_t e = 0; e < 3; e++) {
        if (piece->fresh[e] && !remember(&weld->next, place, e)) {
            weld->failed = true;
        }
    }
}

static void split_triangle(Weld *weld, uint32_t triangle, Piece whole) {
    bool first = true;
    weld->normal = triangle_normal(weld, whole.v[0], whole.v[1], whole.v[2]);
    weld->pieces.count = 0;
    push_piece(weld, whole);
    while (weld->pieces.count > 0 && !weld->failed) {
        Piece piece = weld->pieces.data[--weld->pieces.count];
        uint32_t e = piece.count[1] > piece.count[0] ? 1 : 0;
        e = piece.count[2] > piece.count[e] ? 2 : e;
        if (piece.count[e] > 0) {
            halve(weld, piece, e);
        } else {
            emit(weld, &piece, triangle, first);
            first = false;
        }
    }
}

/* Splits the triangle whose edges are work[first..end); vertices for its hits are made here. */
static void split_at_hits(Weld *weld, uint32_t first, uint32_t end) {
    uint32_t triangle = weld->work.data[first].triangle;
    Piece whole = {{0}, {0}, {0}, {false}};
    memcpy(whole.v, weld->triangles.data[triangle].v, sizeof whole.v);
    weld->added.count = 0;
    for (uint32_t i = first; i < end && !weld->failed; i++) {
        uint32_t e = weld->work.data[i].corner, count = weld->hit_first[i + 1] - weld->hit_first[i];
        if (!ENF_ARRAY_ROOM(&weld->added, count)) {
            weld->failed = true;
            return;
        }
        whole.first[e] = weld->added.count;
        whole.count[e] = count;
        for (uint32_t hit = weld->hit_first[i]; hit < weld->hit_first[i + 1]; hit++) {
            EnfGrid3 p = weld->points[weld->hits.data[hit]];
            weld->added.data[weld->added.count++] = add_vertex(weld, whole.v[e], whole.v[(e + 1) % 3], p);
        }
    }
    split_triangle(weld, triangle, whole);
}

/* ---- passes ----------------------------------------------------------------------------------------------------- */

static int compare_edges(const void *left, const void *right) {
    const EnfEdgeRef *a = left, *b = right;
    if (a->triangle != b->triangle) {
        return a->triangle < b->triangle ? -1 : 1;
    }
    return (a->corner > b->corner) - (a->corner < b->corner);
}

static bool pass(Weld *weld) {
    if (!find_hits(weld)) {
        return false;
    }
    weld->next.count = 0;
    for (uint32_t first = 0, end; first < weld->work.count && !weld->failed; first = end) {
        for (end = first; end < weld->work.count; end++) {
            if (weld->work.data[end].triangle != weld->work.data[first].triangle) {
                break;
            }
        }
        if (weld->hit_first[end] > weld->hit_first[first]) {
            split_at_hits(weld, first, end);
        }
    }
    EdgeList done = weld->work;
    weld->work = weld->next;
    weld->next = done;
    if (weld->work.count > 0) {
        qsort(weld->work.data, weld->work.count, sizeof *weld->work.data, compare_edges);
    }
    return !weld->failed;
}

static int compare_candidates(const void *left, const void *right) {
    const Candidate *a = left, *b = right;
    if (a->cell != b->cell) {
        return a->cell < b->cell ? -1 : 1;
    }
    return (a->position > b->position) - (a->position < b->position);
}

/* The end points of open edges, each once (in the first round, once a cell). Returns how many. */
static uint32_t list_candidates(Weld *weld, const EnfEdges *edges) {
    uint32_t count = 0, kept = 0;
    for (uint32_t i = 0; i < edges->open_count; i++) {
        const EnfSoupTriangle *t = &weld->triangles.data[edges->open[i].triangle];
        for (uint32_t end = 0; end < 2; end++) {
            uint32_t position = edges->position[t->v[(edges->open[i].corner + end) % 3]];
            weld->candidates[count++] = (Candidate){weld->across ? ENF_NONE : t->cell, position};
        }
    }
    qsort(weld->candidates, count, sizeof *weld->candidates, compare_candidates);
    for (uint32_t i = 0; i < count; i++) {
        if (i == 0 || compare_candidates(&weld->candidates[i], &weld->candidates[kept - 1]) != 0) {
            weld->candidates[kept] = weld->candidates[i];
            weld->points[kept++] = edges->points[weld->candidates[i].position];
        }
    }
    return kept;
}

/* A tree for each run of candidates of one cell. */
static bool plant_trees(Weld *weld, uint32_t count, uint32_t *ids) {
    for (uint32_t first = 0, end; first < count; first = end) {
        uint32_t cell = weld->candidates[first].cell;
        for (end = first; end < count && weld->candidates[end].cell == cell; end++) {
            ids[end - first] = end;
        }
        EnfPointTree *tree = ENF_ARRAY_ROOM(&weld->groves, 1) ? enf_point_tree_create(weld->points, ids, end - first) : NULL;
        if (!tree) {
            return false;
        }
        weld->groves.data[weld->groves.count++] = (Grove){cell, tree};
    }
    return true;
}

static bool plant(Weld *weld, const EnfEdges *edges) {
    size_t room = (size_t)edges->open_count * 2 + 1;
    weld->candidates = malloc(room * sizeof *weld->candidates);
    weld->points = malloc(room * sizeof *weld->points);
    uint32_t *ids = malloc(room * sizeof *ids);
    bool ok = weld->candidates && weld->points && ids && plant_trees(weld, list_candidates(weld, edges), ids);
    free(ids);
    return ok;
}

static bool weld_edges(Weld *weld, EnfEdges *edges) {
    if (!plant(weld, edges)) {
        return false;
    }
    weld->hits_max = hits_max(weld->triangles.count);
    weld->work.data = edges->open;
    weld->work.count = weld->work.capacity = edges->open_count;
    edges->open = NULL;
    for (int i = 0; i < PASSES_MAX && weld->work.count > 0; i++) {
        if (!pass(weld)) {
            return false;
        }
    }
    return true;
}

static EnfResult weld_round(EnfSoup *soup, bool across, EnfError *error) {
    EnfEdges edges;
    Weld weld;
    memset(&weld, 0, sizeof weld);
    EnfResult result = enf_edges_find(&edges, soup, error);
    if (result != ENF_OK) {
        return result;
    }
    weld.across = across;
    weld.vertices.data = soup->vertices;
    weld.vertices.count = weld.vertices.capacity = soup->vertex_count;
    weld.triangles.data = soup->triangles;
    weld.triangles.count = weld.triangles.capacity = soup->triangle_count;
    if (!weld_edges(&weld, &edges)) {
        result = enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory while welding %u triangles",
                               soup->triangle_count);
    }
    soup->vertices = weld.vertices.data;
    soup->vertex_count = weld.vertices.count;
    soup->triangles = weld.triangles.data;
    soup->triangle_count = weld.triangles.count;
    soup->split_count += weld.split_count;
    for (uint32_t i = 0; i < weld.groves.count; i++) {
        enf_point_tree_destroy(weld.groves.data[i].tree);
    }
    free(weld.groves.data);
    free(weld.candidates);
    free(weld.points);
    free(weld.work.data);
    free(weld.next.data);
    free(weld.hits.data);
    free(weld.hit_first);
    free(weld.added.data);
    free(weld.pieces.data);
    enf_edges_free(&edges);
    return result;
}

EnfResult enf_weld(EnfSoup *soup, EnfError *error) {
    EnfResult result = weld_round(soup, false, error);
    return result == ENF_OK ? weld_round(soup, true, error) : result;
}
