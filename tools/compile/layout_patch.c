/* Islands of a portal's mesh. Triangles on the grid in; welded, oriented and measured islands out; layout_convex.c makes their
 * polygons. */
#include "compile/layout_patch.h"

#include "compile/exact.h"
#include "compile/union_find.h"

#include <enfilade/tolerances.h>
#include <stdlib.h>
#include <string.h>

/* Two triangles belong to one opening if the angle between their planes is less than 45°: beyond it they are two walls. */
static const double ISLAND_COS = 0.70710678118654752;

void enf_patches_free(EnfPatches *patches) {
    free(patches->patches.data);
    free(patches->pieces.data);
    free(patches->points.data);
    memset(patches, 0, sizeof *patches);
}

typedef struct Corner {
    EnfGrid3 p;
    uint32_t index;
} Corner;

typedef struct Edge {
    uint32_t low, high, triangle;
} Edge;

typedef struct Triangle {
    uint32_t v[3], island, index;
    EnfVec3 area; /* twice the area, along the normal */
} Triangle;

typedef struct Work {
    uint32_t count; /* triangles given */
    Corner *corners;
    EnfGrid3 *vertices;
    uint32_t vertex_count;
    Triangle *triangles;
    uint32_t triangle_count; /* of them, with an area */
    Edge *edges;
    uint32_t *parents; /* union-find over triangles */
    uint32_t (*island)[3];
} Work;

static int compare_corner(const void *pa, const void *pb) {
    const Corner *a = pa, *b = pb;
    int order = enf_grid_compare(a->p, b->p);
    return order != 0 ? order : (a->index > b->index) - (a->index < b->index);
}

static int compare_edge(const void *pa, const void *pb) {
    const Edge *a = pa, *b = pb;
    if (a->low != b->low) {
        return a->low < b->low ? -1 : 1;
    }
    if (a->high != b->high) {
        return a->high < b->high ? -1 : 1;
    }
    return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

static int compare_island(const void *pa, const void *pb) {
    const Triangle *a = pa, *b = pb;
    if (a->island != b->island) {
        return a->island < b->island ? -1 : 1;
    }
    return (a->index > b->index) - (a->index < b->index);
}

static EnfVec3 difference(EnfGrid3 a, EnfGrid3 b) {
    return enf_v3((double)(a.x - b.x) * ENF_GRID_STEP, (double)(a.y - b.y) * ENF_GRID_STEP,
                  (double)(a.z - b.z) * ENF_GRID_STEP);
}

EnfVec3 enf_grid_polygon_area(const EnfGrid3 *points, uint32_t count, EnfVec3 *centre) {
    EnfVec3 area = {0}, moment = {0};
    for (uint32_t i = 1; i + 1 < count; i++) {
        area = enf_add(area, enf_cross(difference(points[i], points[0]), difference(points[i + 1], points[0])));
    }
    EnfVec3 normal = enf_normalize(area);
    for (uint32_t i = 1; i + 1 < count; i++) {
        EnfVec3 u = difference(points[i], points[0]), v = difference(points[i + 1], points[0]);
        moment = enf_add(moment, enf_scale(enf_add(u, v), enf_dot(enf_cross(u, v), normal) / 3.0));
    }
    double length = enf_dot(area, normal);
    *centre = enf_add(enf_grid_point(points[0]), length > 0.0 ? enf_scale(moment, 1.0 / length) : moment);
    return area;
}

static bool work_create(Work *work, uint32_t count) {
    size_t n = count;
    *work = (Work){.count = count};
    work->corners = enf_alloc(NULL, 3 * n, sizeof *work->corners);
    work->vertices = enf_alloc(NULL, 3 * n, sizeof *work->vertices);
    work->triangles = enf_alloc(NULL, n, sizeof *work->triangles);
    work->edges = enf_alloc(NULL, 3 * n, sizeof *work->edges);
    work->parents = enf_alloc(NULL, n, sizeof *work->parents);
    work->island = enf_alloc(NULL, n, sizeof *work->island);
    return work->corners && work->vertices && work->triangles && work->edges && work->parents && work->island;
}

static void work_destroy(Work *work) {
    size_t n = work->count;
    enf_free(NULL, work->corners, 3 * n, sizeof *work->corners);
    enf_free(NULL, work->vertices, 3 * n, sizeof *work->vertices);
    enf_free(NULL, work->triangles, n, sizeof *work->triangles);
    enf_free(NULL, work->edges, 3 * n, sizeof *work->edges);
    enf_free(NULL, work->parents, n, sizeof *work->parents);
    enf_free(NULL, work->island, n, sizeof *work->island);
}

static void sort3(uint32_t v[3]) {
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2 - i; j++) {
            if (v[j] > v[j + 1]) {
                uint32_t t = v[j];
                v[j] = v[j + 1];
                v[j + 1] = t;
            }
        }
    }
}

/* Equal positions become one vertex; triangles without area are left out. */
static void weld(Work *work, const EnfGrid3 *corners) {
    for (uint32_t i = 0; i < 3 * work->count; i++) {
        work->corners[i] = (Corner){corners[i], i};
    }
    qsort(work->corners, 3 * (size_t)work->count, sizeof *work->corners, compare_corner);
    uint32_t *vertex_of = (uint32_t *)work->island; /* 3 a triangle: borrowed until islands are made */
    for (uint32_t i = 0; i < 3 * work->count; i++) {
        if (i == 0 || enf_grid_compare(work->corners[i].p, work->corners[i - 1].p) != 0) {
            work->vertices[work->vertex_count++] = work->corners[i].p;
        }
        vertex_of[work->corners[i].index] = work->vertex_count - 1;
    }
    for (uint32_t t = 0; t < work->count; t++) {
        Triangle triangle = {{vertex_of[3 * t], vertex_of[3 * t + 1], vertex_of[3 * t + 2]}, 0, t, {0, 0, 0}};
        EnfGrid3 a = work->vertices[triangle.v[0]];
        triangle.area = enf_cross(difference(work->vertices[triangle.v[1]], a), difference(work->vertices[triangle.v[2]], a));
        if (enf_length(triangle.area) > 0.0) {
            work->triangles[work->triangle_count++] = triangle;
        }
    }
}

/* A back drawn behind the front (both windings of one triangle) says nothing new: the first one counts. */
static void drop_backs(Work *work) {
    uint32_t kept = 0;
    for (uint32_t t = 0; t < work->triangle_count; t++) {
        uint32_t key[3] = {work->triangles[t].v[0], work->triangles[t].v[1], work->triangles[t].v[2]};
        sort3(key);
        bool known = false;
        /* Portals have a handful of triangles; a sheet of thousands is looked at near its end only, where exporters put backs. */
        uint32_t first = kept > 256 ? kept - 256 : 0;
        for (uint32_t i = first; i < kept && !known; i++) {
            uint32_t other[3] = {work->triangles[i].v[0], work->triangles[i].v[1], work->triangles[i].v[2]};
            sort3(other);
            known = memcmp(key, other, sizeof key) == 0;
        }
        if (!known) {
            work->triangles[kept++] = work->triangles[t];
        }
    }
    work->triangle_count = kept;
}

/* Unites triangles that share an edge at less than 45°, and sorts them by island. */
static void unite(Work *work) {
    uint32_t edges = 0;
    for (uint32_t t = 0; t < work->triangle_count; t++) {
        work->parents[t] = t;
        for (int k = 0; k < 3; k++) {
            uint32_t a = work->triangles[t].v[k], b = work->triangles[t].v[(k + 1) % 3];
            work->edges[edges++] = (Edge){a < b ? a : b, a < b ? b : a, t};
        }
    }
    qsort(work->edges, edges, sizeof *work->edges, compare_edge);
    for (uint32_t i = 1; i < edges; i++) {
        const Edge *e = &work->edges[i];
        for (uint32_t j = i; j > 0 && work->edges[j - 1].low == e->low && work->edges[j - 1].high == e->high; j--) {
            EnfVec3 n = enf_normalize(work->triangles[e->triangle].area);
            double cosine = enf_dot(n, enf_normalize(work->triangles[work->edges[j - 1].triangle].area));
            if (cosine > ISLAND_COS || cosine < -ISLAND_COS) {
                enf_sets_join(work->parents, e->triangle, work->edges[j - 1].triangle);
            }
        }
    }
    for (uint32_t t = 0; t < work->triangle_count; t++) {
        work->triangles[t].island = enf_sets_find(work->parents, t);
    }
    qsort(work->triangles, work->triangle_count, sizeof *work->triangles, compare_island);
}

/* Turns the triangles [first, end) of one island to one side: that of the majority by area. */
static void orient(Work *work, uint32_t first, uint32_t end) {
    EnfVec3 largest = {0}, sum = {0};
    for (uint32_t t = first; t < end; t++) {
        EnfVec3 area = work->triangles[t].area;
        largest = enf_dot(area, area) > enf_dot(largest, largest) ? area : largest;
        sum = enf_add(sum, area);
    }
    EnfVec3 front = enf_dot(sum, largest) < 0.0 ? enf_scale(largest, -1.0) : largest;
    for (uint32_t t = first; t < end; t++) {
        const Triangle *triangle = &work->triangles[t];
        bool turned = enf_dot(triangle->area, front) < 0.0;
        work->island[t - first][0] = triangle->v[0];
        work->island[t - first][1] = triangle->v[turned ? 2 : 1];
        work->island[t - first][2] = triangle->v[turned ? 1 : 2];
    }
}

/* Fills area, normal, centre, box and off_plane from the pieces; returns the perimeter of them all. */
static double measure(EnfPatches *patches, EnfPatch *patch) {
    EnfVec3 sum = {0}, centre = {0};
    double perimeter = 0.0, largest = -1.0;
    patch->box = enf_box3_empty();
    for (uint32_t i = 0; i < patch->piece_count; i++) {
        EnfPiece piece = patches->pieces.data[patch->piece_first + i];
        const EnfGrid3 *p = &patches->points.data[piece.point_first];
        EnfVec3 middle, area = enf_grid_polygon_area(p, piece.point_count, &middle);
        double size = enf_length(area) / 2.0;
        sum = enf_add(sum, area);
        centre = enf_add(centre, enf_scale(middle, size));
        patch->area += size;
        if (size > largest) {
            largest = size;
            patch->centre = middle;
        }
        for (uint32_t k = 0; k < piece.point_count; k++) {
            perimeter += enf_length(difference(p[(k + 1) % piece.point_count], p[k]));
            patch->box = enf_box3_add(patch->box, enf_grid_point(p[k]));
        }
    }
    patch->normal = enf_normalize(sum);
    centre = patch->area > 0.0 ? enf_scale(centre, 1.0 / patch->area) : patch->centre;
    for (uint32_t i = 0; i < patch->piece_count; i++) {
        EnfPiece piece = patches->pieces.data[patch->piece_first + i];
        for (uint32_t k = 0; k < piece.point_count; k++) {
            EnfVec3 p = enf_grid_point(patches->points.data[piece.point_first + k]);
            double d = enf_dot(enf_sub(p, centre), patch->normal);
            d = d < 0.0 ? -d : d;
            patch->off_plane = d > patch->off_plane ? d : patch->off_plane;
        }
    }
    return perimeter;
}

static bool add_island(EnfPatches *patches, Work *work, uint32_t first, uint32_t end, uint32_t *degenerate) {
    if (!ENF_ARRAY_ROOM(&patches->patches, 1)) {
        return false;
    }
    EnfPatch patch = {.piece_first = patches->pieces.count};
    uint32_t points = patches->points.count;
    EnfIsland island = {.vertices = work->vertices, .triangles = work->island, .triangle_count = end - first};
    orient(work, first, end);
    if (!enf_island_pieces(patches, &island)) {
        return false;
    }
    patch.piece_count = patches->pieces.count - patch.piece_first;
    double perimeter = measure(patches, &patch);
    /* Narrower than two steps of the grid: snapping alone may have made it. */
    if (patch.piece_count == 0 || patch.area <= perimeter * ENF_GRID_STEP) {
        patches->pieces.count = patch.piece_first;
        patches->points.count = points;
        *degenerate += 1;
        return true;
    }
    patch.bent = patch.off_plane > ENF_TOL_PORTAL_FLAT;
    patch.concave = !patch.bent && !island.convex;
    patches->patches.data[patches->patches.count++] = patch;
    return true;
}

bool enf_patches_add(EnfPatches *patches, const EnfGrid3 *corners, uint32_t triangle_count, uint32_t *degenerate) {
    Work work;
    if (triangle_count == 0) { /* nothing to sort: NULL is no array, not even an empty one */
        *degenerate += 1;
        return true;
    }
    bool ok = work_create(&work, triangle_count);
    if (ok) {
        weld(&work, corners);
        drop_backs(&work);
        unite(&work);
        if (work.triangle_count == 0) {
            *degenerate += 1;
        }
        for (uint32_t first = 0, end; ok && first < work.triangle_count; first = end) {
            end = first + 1;
            while (end < work.triangle_count && work.triangles[end].island == work.triangles[first].island) {
                end++;
            }
            ok = add_island(patches, &work, first, end, degenerate);
        }
    }
    work_destroy(&work);
    return ok;
}
