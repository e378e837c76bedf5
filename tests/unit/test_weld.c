/* The welder: T-junctions are mended, closed things are left alone, and the order of the input does not matter. */
#include "compile/edges.h"
#include "compile/exact.h"
#include "compile/point_tree.h"
#include "compile/weld.h"
#include "harness/harness.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TRIANGLES_MAX = 4096 };

static EnfGrid3 grid(int64_t x, int64_t y, int64_t z) {
    return (EnfGrid3){x, y, z};
}

static void soup_begin(EnfSoup *soup) {
    memset(soup, 0, sizeof *soup);
    soup->vertices = calloc(3 * TRIANGLES_MAX, sizeof *soup->vertices);
    soup->triangles = calloc(TRIANGLES_MAX, sizeof *soup->triangles);
}

/* A triangle with corners of its own; texture coordinates follow x and z, so that interpolation can be checked. */
static void soup_add(EnfSoup *soup, uint32_t cell, EnfGrid3 a, EnfGrid3 b, EnfGrid3 c) {
    const EnfGrid3 corners[3] = {a, b, c};
    assert_true(soup->triangle_count < TRIANGLES_MAX);
    for (uint32_t i = 0; i < 3; i++) {
        EnfSoupVertex *v = &soup->vertices[soup->vertex_count + i];
        v->p = corners[i];
        v->normal[1] = 1;
        v->uv[0] = (float)corners[i].x / 4096.0f;
        v->uv[1] = (float)corners[i].z / 4096.0f;
        v->color[3] = 1;
    }
    uint32_t first = soup->vertex_count;
    soup->vertex_count += 3;
    soup->triangles[soup->triangle_count++] = (EnfSoupTriangle){{first, first + 1, first + 2}, 0, 0, cell};
}

static void weld(EnfSoup *soup) {
    EnfError error;
    assert_int_equal(enf_weld(soup, &error), ENF_OK);
}

static EnfGrid3 corner(const EnfSoup *soup, uint32_t triangle, uint32_t i) {
    return soup->vertices[soup->triangles[triangle].v[i % 3]].p;
}

/* Brute force: open edges (by cell if `by_cell`) that have an end of another open edge inside them. */
static uint32_t count_tjunctions(const EnfSoup *soup, bool by_cell) {
    EnfEdges edges;
    EnfError error;
    uint32_t found = 0;
    assert_int_equal(enf_edges_find(&edges, soup, &error), ENF_OK);
    for (uint32_t i = 0; i < edges.open_count; i++) {
        EnfEdgeRef e = edges.open[i];
        EnfGrid3 a = corner(soup, e.triangle, e.corner), b = corner(soup, e.triangle, e.corner + 1);
        bool hit = false;
        for (uint32_t k = 0; k < edges.open_count && !hit; k++) {
            EnfGrid3 p = corner(soup, edges.open[k].triangle, edges.open[k].corner);
            bool same = !by_cell || soup->triangles[e.triangle].cell == soup->triangles[edges.open[k].triangle].cell;
            hit = same && enf_point_on_segment(p, a, b) && !enf_grid_equal(p, corner(soup, e.triangle, e.corner + 2));
        }
        found += hit;
    }
    enf_edges_free(&edges);
    return found;
}

static double total_area(const EnfSoup *soup) {
    double area = 0;
    for (uint32_t t = 0; t < soup->triangle_count; t++) {
        EnfVec3 a = enf_grid_point(corner(soup, t, 0)), b = enf_grid_point(corner(soup, t, 1));
        area += 0.5 * enf_length(enf_cross(enf_sub(b, a), enf_sub(enf_grid_point(corner(soup, t, 2)), a)));
    }
    return area;
}

/* ---- cases ------------------------------------------------------------------------------------------------------ */

/* One long triangle below, two short ones above: the classical crack. */
static void mends_a_tjunction(void **state) {
    (void)state;
    EnfSoup soup;
    soup_begin(&soup);
    soup_add(&soup, 0, grid(0, 0, 0), grid(4096, 0, 0), grid(0, 0, -4096));
    soup_add(&soup, 0, grid(0, 0, 0), grid(0, 0, 4096), grid(1024, 0, 0));
    soup_add(&soup, 0, grid(1024, 0, 0), grid(4096, 0, 4096), grid(4096, 0, 0));
    double before = total_area(&soup);
    weld(&soup);
    assert_int_equal(soup.split_count, 1);
    assert_int_equal(soup.triangle_count, 4);
    assert_int_equal(count_tjunctions(&soup, false), 0);
    assert_true(fabs(total_area(&soup) - before) < 1e-9);
    bool found = false;
    for (uint32_t i = 0; i < soup.vertex_count; i++) {
        assert_float_equal(soup.vertices[i].uv[0], (float)soup.vertices[i].p.x / 4096.0f, 1e-6f);
        found = found || (i >= 9 && soup.vertices[i].p.x == 1024);
    }
    assert_true(found);
    enf_soup_free(&soup);
}

/* Several vertices on all three edges of one triangle. */
static void splits_many_times(void **state) {
    (void)state;
    EnfSoup soup;
    const EnfGrid3 big[3] = {{0, 0, 0}, {0, 0, 8192}, {8192, 0, 0}};
    soup_begin(&soup);
    soup_add(&soup, 0, big[0], big[1], big[2]);
    for (int e = 0; e < 3; e++) {
        EnfGrid3 a = big[e], b = big[(e + 1) % 3];
        for (int k = 0; k < 4; k++) {
            EnfGrid3 p = {a.x + (b.x - a.x) * k / 4, 0, a.z + (b.z - a.z) * k / 4};
            EnfGrid3 q = {a.x + (b.x - a.x) * (k + 1) / 4, 0, a.z + (b.z - a.z) * (k + 1) / 4};
            soup_add(&soup, 0, q, p, grid((p.x + q.x) / 2, 4096, (p.z + q.z) / 2));
        }
    }
    weld(&soup);
    assert_int_equal(soup.split_count, 9);
    assert_int_equal(soup.triangle_count, 13 + 9);
    assert_int_equal(count_tjunctions(&soup, false), 0);
    enf_soup_free(&soup);
}

/* A closed box standing on a floor whose vertices touch its edges stays as it is. */
static void leaves_closed_things_alone(void **state) {
    (void)state;
    EnfSoup soup;
    soup_begin(&soup);
    const int64_t s = 4096;
    for (int face = 0; face < 6; face++) {
        int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        EnfGrid3 c[4];
        for (int i = 0; i < 4; i++) {
            int64_t p[3];
            p[axis] = face % 2 ? s : 0;
            p[u] = (i == 1 || i == 2) ? s : 0;
            p[v] = i >= 2 ? s : 0;
            c[i] = grid(p[0], p[1], p[2]);
        }
        soup_add(&soup, 0, c[0], face % 2 ? c[1] : c[2], face % 2 ? c[2] : c[1]);
        soup_add(&soup, 0, c[0], face % 2 ? c[2] : c[3], face % 2 ? c[3] : c[2]);
    }
    soup_add(&soup, 0, grid(s / 2, 0, 0), grid(0, 0, -s), grid(s, 0, -s)); /* open, its tip on an edge of the box */
    weld(&soup);
    assert_int_equal(soup.triangle_count, 13);
    enf_soup_free(&soup);
}

/* Along the border of an opening the walls of two cells meet; elsewhere each cell is its own. */
static void mends_across_openings(void **state) {
    (void)state;
    EnfSoup soup;
    soup_begin(&soup);
    soup_add(&soup, 0, grid(0, 0, 0), grid(4096, 0, 0), grid(0, 0, -4096));
    soup_add(&soup, 1, grid(0, 0, 0), grid(0, 0, 4096), grid(1000, 0, 0));
    soup_add(&soup, 1, grid(1000, 0, 0), grid(4096, 0, 4096), grid(4096, 0, 0));
    weld(&soup);
    assert_int_equal(soup.split_count, 1);
    assert_int_equal(count_tjunctions(&soup, false), 0);
    enf_soup_free(&soup);
}

/* A vertex that snapping moved off a slanted edge by a step is still on it, and the split turns no triangle over. */
static void takes_snapped_vertices(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(7);
    uint32_t splits = 0;
    for (int round = 0; round < 300; round++) {
        EnfSoup soup;
        soup_begin(&soup);
        EnfVec3 a = {enf_test_double(&rng, -50, 50), enf_test_double(&rng, -5, 5), enf_test_double(&rng, -50, 50)};
        EnfVec3 d = {enf_test_double(&rng, 1, 9), enf_test_double(&rng, -3, 3), enf_test_double(&rng, 1, 9)};
        EnfVec3 side = {enf_test_double(&rng, -9, -1), enf_test_double(&rng, -3, 3), enf_test_double(&rng, 1, 9)};
        double t = enf_test_double(&rng, 0.1, 0.9);
        EnfGrid3 ga = enf_grid_snap(a), gb = enf_grid_snap(enf_add(a, d)), gm = enf_grid_snap(enf_add(a, enf_scale(d, t)));
        soup_add(&soup, 0, ga, gb, enf_grid_snap(enf_add(a, side)));
        soup_add(&soup, 0, gm, ga, enf_grid_snap(enf_sub(a, side)));
        soup_add(&soup, 0, gb, gm, enf_grid_snap(enf_sub(a, side)));
        weld(&soup);
        splits += soup.split_count;
        assert_int_equal(count_tjunctions(&soup, false), 0);
        for (uint32_t i = 0; i < soup.triangle_count; i++) {
            assert_false(enf_grid_collinear(corner(&soup, i, 0), corner(&soup, i, 1), corner(&soup, i, 2)));
        }
        enf_soup_free(&soup);
    }
    assert_true(splits >= 300);
}

/* ---- random walls ----------------------------------------------------------------------------------------------- */

/* A rectangle cut into random strips, each cut again at other places: T-junctions along every cut. */
static void add_random_floor(EnfSoup *soup, EnfTestRng *rng, uint32_t cell, int64_t x0) {
    int64_t x = x0, end = x0 + 20 * 4096;
    while (x < end) {
        int64_t next = x + 1024 + (int64_t)enf_test_below(rng, 9000);
        next = next > end - 1024 ? end : next;
        int64_t z = 0;
        while (z < 40960) {
            int64_t z_next = z + 512 + (int64_t)enf_test_below(rng, 16384);
            z_next = z_next > 40960 - 512 ? 40960 : z_next;
            soup_add(soup, cell, grid(x, 0, z), grid(x, 0, z_next), grid(next, 0, z_next));
            soup_add(soup, cell, grid(x, 0, z), grid(next, 0, z_next), grid(next, 0, z));
            z = z_next;
        }
        x = next;
    }
}

/* Inside the floor, every edge must be matched by an opposite one. */
static void random_floors_become_watertight(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(3);
    for (uint32_t round = 0; round < enf_test_rounds(20, 500); round++) {
        EnfSoup soup;
        soup_begin(&soup);
        add_random_floor(&soup, &rng, 0, 0);
        add_random_floor(&soup, &rng, 1, 20 * 4096);
        double before = total_area(&soup);
        weld(&soup);
        assert_true(fabs(total_area(&soup) - before) < 1e-6);
        assert_int_equal(count_tjunctions(&soup, false), 0);
        for (uint32_t t = 0; t < soup.triangle_count; t++) {
            soup.triangles[t].cell = 0;
        }
        EnfEdges edges;
        EnfError error;
        assert_int_equal(enf_edges_find(&edges, &soup, &error), ENF_OK);
        for (uint32_t i = 0; i < edges.open_count; i++) {
            EnfGrid3 a = corner(&soup, edges.open[i].triangle, edges.open[i].corner);
            EnfGrid3 b = corner(&soup, edges.open[i].triangle, edges.open[i].corner + 1);
            bool border = (a.x == b.x && (a.x == 0 || a.x == 40 * 4096)) || (a.z == b.z && (a.z == 0 || a.z == 40960));
            assert_true(border);
        }
        enf_edges_free(&edges);
        enf_soup_free(&soup);
    }
}

typedef struct Shape {
    EnfGrid3 p[3];
    uint32_t cell;
    float uv[3][2];
} Shape;

static int compare_shapes(const void *left, const void *right) {
    const Shape *a = left, *b = right;
    for (int i = 0; i < 3; i++) {
        int order = enf_grid_compare(a->p[i], b->p[i]);
        if (order != 0) {
            return order;
        }
    }
    return (a->cell > b->cell) - (a->cell < b->cell);
}

static Shape *shapes_of(const EnfSoup *soup) {
    Shape *shapes = calloc(soup->triangle_count, sizeof *shapes);
    for (uint32_t t = 0; t < soup->triangle_count; t++) {
        uint32_t first = 0; /* begin with the smallest corner */
        for (uint32_t i = 1; i < 3; i++) {
            first = enf_grid_compare(corner(soup, t, i), corner(soup, t, first)) < 0 ? i : first;
        }
        for (uint32_t i = 0; i < 3; i++) {
            shapes[t].p[i] = corner(soup, t, first + i);
            memcpy(shapes[t].uv[i], soup->vertices[soup->triangles[t].v[(first + i) % 3]].uv, sizeof shapes[t].uv[i]);
        }
        shapes[t].cell = soup->triangles[t].cell;
    }
    qsort(shapes, soup->triangle_count, sizeof *shapes, compare_shapes);
    return shapes;
}

static void order_does_not_matter(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(4);
    for (uint32_t round = 0; round < enf_test_rounds(10, 200); round++) {
        EnfSoup soup, shuffled;
        soup_begin(&soup);
        add_random_floor(&soup, &rng, 0, 0);
        add_random_floor(&soup, &rng, 1, 20 * 4096);
        soup_begin(&shuffled);
        shuffled.vertex_count = soup.vertex_count;
        shuffled.triangle_count = soup.triangle_count;
        memcpy(shuffled.vertices, soup.vertices, soup.vertex_count * sizeof *soup.vertices);
        memcpy(shuffled.triangles, soup.triangles, soup.triangle_count * sizeof *soup.triangles);
        for (uint32_t i = soup.triangle_count - 1; i > 0; i--) {
            uint32_t k = enf_test_below(&rng, i + 1);
            EnfSoupTriangle swap = shuffled.triangles[i];
            shuffled.triangles[i] = shuffled.triangles[k];
            shuffled.triangles[k] = swap;
        }
        weld(&soup);
        weld(&shuffled);
        assert_int_equal(soup.triangle_count, shuffled.triangle_count);
        Shape *a = shapes_of(&soup), *b = shapes_of(&shuffled);
        assert_memory_equal(a, b, soup.triangle_count * sizeof *a);
        free(a);
        free(b);
        enf_soup_free(&soup);
        enf_soup_free(&shuffled);
    }
}

/* ---- the tree --------------------------------------------------------------------------------------------------- */

typedef struct Found {
    uint8_t *seen;
    uint32_t count;
} Found;

static bool mark(void *user, uint32_t id) {
    Found *found = user;
    assert_int_equal(found->seen[id], 0);
    found->seen[id] = 1;
    found->count++;
    return true;
}

static void the_tree_finds_what_a_loop_finds(void **state) {
    (void)state;
    enum { POINTS = 3000 };
    EnfTestRng rng = enf_test_rng(5);
    EnfGrid3 *points = calloc(POINTS, sizeof *points);
    uint32_t *ids = calloc(POINTS, sizeof *ids);
    Found found = {calloc(POINTS, 1), 0};
    for (uint32_t i = 0; i < POINTS; i++) {
        points[i] = grid((int64_t)enf_test_below(&rng, 40) * 100, (int64_t)enf_test_below(&rng, 3) * 100,
                         (int64_t)enf_test_below(&rng, 40) * 100 + (int64_t)enf_test_below(&rng, 3));
        ids[i] = i;
    }
    EnfPointTree *tree = enf_point_tree_create(points, ids, POINTS);
    assert_non_null(tree);
    for (int round = 0; round < 500; round++) {
        EnfGrid3 a = points[enf_test_below(&rng, POINTS)], b = points[enf_test_below(&rng, POINTS)];
        memset(found.seen, 0, POINTS);
        found.count = 0;
        enf_point_tree_segment(tree, a, b, mark, &found);
        uint32_t expected = 0;
        for (uint32_t i = 0; i < POINTS; i++) {
            expected += enf_point_on_segment(points[i], a, b);
        }
        assert_int_equal(found.count, expected);
    }
    enf_point_tree_destroy(tree);
    free(points);
    free(ids);
    free(found.seen);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(mends_a_tjunction),          cmocka_unit_test(splits_many_times),
    cmocka_unit_test(leaves_closed_things_alone), cmocka_unit_test(mends_across_openings),
    cmocka_unit_test(takes_snapped_vertices),     cmocka_unit_test(random_floors_become_watertight),
    cmocka_unit_test(order_does_not_matter),      cmocka_unit_test(the_tree_finds_what_a_loop_finds),
};
ENF_TEST_MAIN(tests)
