/* Convex pieces of an island. Its oriented triangles in; convex polygons on the grid out.
 *
 * If the outline is one convex polygon, that is the piece. Otherwise triangles are merged over their shared edges, the longest first,
 * as long as the result is convex and plane: at most four times as many pieces as the best partition has. Source: Hertel &
 * Mehlhorn 1983 (their partition starts, as here, from any triangulation). */
#include "compile/layout_patch.h"

#include <enfilade/tolerances.h>
#include <stdlib.h>
#include <string.h>

typedef struct Step {
    uint32_t from, to;
} Step;

/* A seam between two triangles, and how long it is. */
typedef struct Seam {
    uint32_t a, b, left, right;
    double length;
} Seam;

typedef struct Loop {
    uint32_t *v;
    uint32_t count, capacity;
    uint32_t parent; /* union-find: a merged loop points to the one that holds its polygon */
} Loop;

typedef struct Merge {
    const EnfGrid3 *vertices;
    Loop *loops;
    uint32_t count;
    ENF_ARRAY(Step) steps;
} Merge;

static EnfVec3 metres(EnfGrid3 a, EnfGrid3 b) {
    return enf_v3((double)(a.x - b.x) * ENF_GRID_STEP, (double)(a.y - b.y) * ENF_GRID_STEP,
                  (double)(a.z - b.z) * ENF_GRID_STEP);
}

static double magnitude(double a) {
    return a < 0.0 ? -a : a;
}

/* The coordinate to drop, 0..2, and the sign that makes counter-clockwise positive in the other two. */
static int dominant(EnfVec3 n, int *sign) {
    double x = magnitude(n.x), y = magnitude(n.y), z = magnitude(n.z);
    int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    double along = axis == 0 ? n.x : axis == 1 ? n.y : n.z;
    *sign = along < 0.0 ? -1 : 1;
    return axis;
}

__extension__ typedef __int128 Wide; /* exact for products of differences of grid coordinates (2^41 each) */

/* The exact turn a → b → c seen along the dropped coordinate: 1 left, 0 straight, -1 right. */
static int turn(EnfGrid3 a, EnfGrid3 b, EnfGrid3 c, int axis, int sign) {
    int64_t u[3] = {a.x, b.x, c.x}, v[3] = {a.y, b.y, c.y};
    if (axis == 0) {
        u[0] = a.y, u[1] = b.y, u[2] = c.y;
        v[0] = a.z, v[1] = b.z, v[2] = c.z;
    } else if (axis == 1) {
        u[0] = a.z, u[1] = b.z, u[2] = c.z;
        v[0] = a.x, v[1] = b.x, v[2] = c.x;
    }
    Wide determinant = (Wide)(u[1] - u[0]) * (v[2] - v[1]) - (Wide)(v[1] - v[0]) * (u[2] - u[1]);
    return sign * (determinant > 0 ? 1 : determinant < 0 ? -1 : 0);
}

/* Does b lie within two grid steps of the line a–c? Then a bend at b may be the snap's doing. */
static bool on_chord(EnfGrid3 a, EnfGrid3 b, EnfGrid3 c) {
    EnfVec3 chord = metres(c, a);
    double length = enf_length(chord);
    return enf_length(enf_cross(metres(b, a), chord)) <= 2.0 * ENF_GRID_STEP * length;
}

/* Leaves out straight vertices, and bends inward that the snap may have made (which makes the polygon larger, never smaller). */
static uint32_t simplify(EnfGrid3 *p, uint32_t count, int axis, int sign) {
    for (uint32_t i = 0, kept = 0; count > 3 && kept < count;) {
        uint32_t before = (i + count - 1) % count, after = (i + 1) % count;
        int bend = turn(p[before], p[i], p[after], axis, sign);
        if (bend == 0 || (bend < 0 && on_chord(p[before], p[i], p[after]))) {
            memmove(&p[i], &p[i + 1], (count - i - 1) * sizeof *p);
            count--;
            i = (i + count - 1) % count;
            kept = 0;
        } else {
            i = (i + 1) % count;
            kept++;
        }
    }
    return count;
}

static bool is_convex(const EnfGrid3 *p, uint32_t count, int axis, int sign) {
    for (uint32_t i = 0; i < count; i++) {
        EnfGrid3 a = p[i], b = p[(i + 1) % count], c = p[(i + 2) % count];
        if (turn(a, b, c, axis, sign) < 0 && !on_chord(a, b, c)) {
            return false;
        }
    }
    return true;
}

static bool is_plane(const EnfGrid3 *p, uint32_t count, EnfVec3 normal, EnfVec3 centre) {
    for (uint32_t i = 0; i < count; i++) {
        if (magnitude(enf_dot(enf_sub(enf_grid_point(p[i]), centre), normal)) > ENF_TOL_PORTAL_FLAT) {
            return false;
        }
    }
    return true;
}

/* The vertices of a loop as points; NULL if memory is out. Freed with enf_free(NULL, p, count, sizeof *p). */
static EnfGrid3 *points_of(const Merge *merge, const uint32_t *v, uint32_t count) {
    EnfGrid3 *p = enf_alloc(NULL, count, sizeof *p);
    for (uint32_t i = 0; p != NULL && i < count; i++) {
        p[i] = merge->vertices[v[i]];
    }
    return p;
}

static bool is_piece(const EnfGrid3 *p, uint32_t count) {
    EnfVec3 centre;
    EnfVec3 normal = enf_normalize(enf_grid_polygon_area(p, count, &centre));
    int sign, axis = dominant(normal, &sign);
    return is_convex(p, count, axis, sign) && is_plane(p, count, normal, centre);
}

static int compare_step(const void *pa, const void *pb) {
    const Step *a = pa, *b = pb;
    if (a->from != b->from) {
        return a->from < b->from ? -1 : 1;
    }
    return (a->to > b->to) - (a->to < b->to);
}

static uint32_t find_step(const Step *steps, uint32_t count, uint32_t from) {
    uint32_t low = 0, high = count;
    while (low < high) {
        uint32_t middle = (low + high) / 2;
        if (steps[middle].from < from) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Is the way back b → a among the steps? */
static bool has_step(const Step *steps, uint32_t count, uint32_t from, uint32_t to) {
    for (uint32_t i = find_step(steps, count, from); i < count && steps[i].from == from; i++) {
        if (steps[i].to == to) {
            return true;
        }
    }
    return false;
}

/* Cancels steps that are walked both ways and chains the rest into out (room for `count`). Returns the length of the one loop
 * that remains, or 0 if there are several, or one that meets itself. */
static uint32_t chain(Step *steps, uint32_t count, uint32_t *out) {
    qsort(steps, count, sizeof *steps, compare_step);
    uint32_t borders = 0, length = 0, first = ENF_NONE;
    for (uint32_t i = 0; i < count; i++) {
        if (!has_step(steps, count, steps[i].to, steps[i].from)) {
            first = first == ENF_NONE ? i : first;
            borders++;
        }
    }
    if (borders == 0) {
        return 0;
    }
    for (uint32_t at = first, next; length < borders; at = next) {
        uint32_t exits = 0;
        out[length++] = steps[at].from;
        next = ENF_NONE;
        for (uint32_t i = find_step(steps, count, steps[at].to); i < count && steps[i].from == steps[at].to; i++) {
            if (!has_step(steps, count, steps[i].to, steps[i].from)) {
                next = i;
                exits++;
            }
        }
        if (exits != 1) {
            return 0;
        }
        if (next == first) {
            break;
        }
    }
    return length == borders ? length : 0;
}

static uint32_t find_loop(Merge *merge, uint32_t i) {
    while (merge->loops[i].parent != i) {
        i = merge->loops[i].parent;
    }
    return i;
}

static uint32_t put_steps(Step *steps, uint32_t count, const Loop *loop) {
    for (uint32_t i = 0; i < loop->count; i++) {
        steps[count++] = (Step){loop->v[i], loop->v[(i + 1) % loop->count]};
    }
    return count;
}

/* Merges two loops if the union is one convex, plane polygon. @return false if memory is out. */
static bool try_merge(Merge *merge, uint32_t a, uint32_t b) {
    Loop *left = &merge->loops[a], *right = &merge->loops[b];
    uint32_t total = left->count + right->count;
    uint32_t *out = enf_alloc(NULL, total, sizeof *out);
    if (out == NULL || !ENF_ARRAY_ROOM(&merge->steps, total)) {
        enf_free(NULL, out, total, sizeof *out);
        return false;
    }
    Step *steps = merge->steps.data;
    uint32_t count = chain(steps, put_steps(steps, put_steps(steps, 0, left), right), out);
    EnfGrid3 *points = count >= 3 ? points_of(merge, out, count) : NULL;
    bool keep = points != NULL && is_piece(points, count);
    enf_free(NULL, points, count, sizeof *points);
    if (keep) {
        enf_free(NULL, left->v, left->capacity, sizeof *left->v);
        enf_free(NULL, right->v, right->capacity, sizeof *right->v);
        *left = (Loop){out, count, total, a};
        *right = (Loop){NULL, 0, 0, a};
    } else {
        enf_free(NULL, out, total, sizeof *out);
    }
    return true;
}

static int compare_seam(const void *pa, const void *pb) {
    const Seam *a = pa, *b = pb;
    if (a->length < b->length || a->length > b->length) {
        return a->length > b->length ? -1 : 1;
    }
    if (a->left != b->left) {
        return a->left < b->left ? -1 : 1;
    }
    return (a->right > b->right) - (a->right < b->right);
}

static int compare_ends(const void *pa, const void *pb) {
    const Seam *a = pa, *b = pb;
    if (a->a != b->a) {
        return a->a < b->a ? -1 : 1;
    }
    if (a->b != b->b) {
        return a->b < b->b ? -1 : 1;
    }
    return (a->left > b->left) - (a->left < b->left);
}

/* The edges that two triangles share, longest first; count in *seam_count. The array has 3 × triangle_count elements. */
static Seam *find_seams(const EnfIsland *island, uint32_t *seam_count) {
    size_t n = 3 * (size_t)island->triangle_count;
    Seam *seams = enf_alloc(NULL, n, sizeof *seams);
    uint32_t found = 0;
    if (seams == NULL) {
        return NULL;
    }
    for (uint32_t i = 0; i < n; i++) {
        uint32_t a = island->triangles[i / 3][i % 3], b = island->triangles[i / 3][(i + 1) % 3];
        seams[i] = (Seam){a < b ? a : b, a < b ? b : a, i / 3, ENF_NONE, 0.0};
    }
    qsort(seams, n, sizeof *seams, compare_ends);
    for (uint32_t i = 0; i + 1 < n; i++) {
        if (seams[i].a == seams[i + 1].a && seams[i].b == seams[i + 1].b) {
            Seam seam = seams[i];
            seam.right = seams[i + 1].left;
            seam.length = enf_length(metres(island->vertices[seam.a], island->vertices[seam.b]));
            seams[found++] = seam;
        }
    }
    qsort(seams, found, sizeof *seams, compare_seam);
    *seam_count = found;
    return seams;
}

static bool push_piece(EnfPatches *patches, const EnfGrid3 *p, uint32_t count) {
    if (!ENF_ARRAY_ROOM(&patches->points, count) || !ENF_ARRAY_ROOM(&patches->pieces, 1)) {
        return false;
    }
    memcpy(&patches->points.data[patches->points.count], p, count * sizeof *p);
    patches->pieces.data[patches->pieces.count++] = (EnfPiece){patches->points.count, count};
    patches->points.count += count;
    return true;
}

/* Appends a convex polygon without straight vertices, in parts of at most ENF_POLYGON_MAX points that share p[0]. */
static bool push_polygon(EnfPatches *patches, EnfGrid3 *p, uint32_t count) {
    EnfVec3 centre;
    int sign, axis = dominant(enf_grid_polygon_area(p, count, &centre), &sign);
    count = simplify(p, count, axis, sign);
    bool ok = true;
    for (uint32_t first = 0; ok && first + 2 < count + (first > 0);) {
        EnfGrid3 part[ENF_POLYGON_MAX];
        uint32_t size = 0;
        if (first > 0) {
            part[size++] = p[0];
        }
        while (size < ENF_POLYGON_MAX && first < count) {
            part[size++] = p[first++];
        }
        ok = size < 3 || push_piece(patches, part, size);
        first = first < count ? first - 1 : count;
    }
    return ok;
}

static bool push_loop(EnfPatches *patches, const Merge *merge, const uint32_t *v, uint32_t count) {
    EnfGrid3 *points = points_of(merge, v, count);
    bool ok = points != NULL && push_polygon(patches, points, count);
    enf_free(NULL, points, count, sizeof *points);
    return ok;
}

/* The whole outline, if it is one convex polygon in one plane. */
static bool push_outline(EnfPatches *patches, Merge *merge, EnfIsland *island, bool *memory) {
    uint32_t n = 3 * island->triangle_count;
    uint32_t *out = enf_alloc(NULL, n, sizeof *out);
    *memory = out != NULL && ENF_ARRAY_ROOM(&merge->steps, n);
    if (*memory) {
        Step *steps = merge->steps.data;
        for (uint32_t i = 0; i < n; i++) {
            steps[i] = (Step){island->triangles[i / 3][i % 3], island->triangles[i / 3][(i + 1) % 3]};
        }
        uint32_t count = chain(steps, n, out);
        EnfGrid3 *points = count >= 3 ? points_of(merge, out, count) : NULL;
        if (points != NULL && is_piece(points, count)) {
            *memory = push_polygon(patches, points, count);
            island->convex = true;
        }
        enf_free(NULL, points, count, sizeof *points);
    }
    enf_free(NULL, out, n, sizeof *out);
    return island->convex;
}

static bool merge_triangles(Merge *merge, const EnfIsland *island) {
    uint32_t seam_count = 0;
    Seam *seams = find_seams(island, &seam_count);
    merge->loops = enf_alloc(NULL, island->triangle_count, sizeof *merge->loops);
    bool ok = seams != NULL && merge->loops != NULL;
    for (uint32_t t = 0; ok && t < island->triangle_count; t++) {
        uint32_t *v = enf_alloc(NULL, 3, sizeof *v);
        ok = v != NULL;
        if (ok) {
            memcpy(v, island->triangles[t], 3 * sizeof *v);
            merge->loops[merge->count++] = (Loop){v, 3, 3, t};
        }
    }
    for (uint32_t i = 0; ok && i < seam_count; i++) {
        uint32_t a = find_loop(merge, seams[i].left), b = find_loop(merge, seams[i].right);
        ok = a == b || try_merge(merge, a, b);
    }
    enf_free(NULL, seams, 3 * (size_t)island->triangle_count, sizeof *seams);
    return ok;
}

bool enf_island_pieces(EnfPatches *patches, EnfIsland *island) {
    Merge merge = {.vertices = island->vertices};
    bool ok = true;
    if (!push_outline(patches, &merge, island, &ok) && ok) {
        ok = merge_triangles(&merge, island);
        for (uint32_t i = 0; ok && i < merge.count; i++) {
            if (merge.loops[i].parent == i) {
                ok = push_loop(patches, &merge, merge.loops[i].v, merge.loops[i].count);
            }
        }
    }
    for (uint32_t i = 0; i < merge.count; i++) {
        enf_free(NULL, merge.loops[i].v, merge.loops[i].capacity, sizeof *merge.loops[i].v);
    }
    enf_free(NULL, merge.loops, island->triangle_count, sizeof *merge.loops);
    free(merge.steps.data);
    return ok;
}
