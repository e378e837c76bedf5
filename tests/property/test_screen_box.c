/* Windows of portals against 113-bit arithmetic: a million random and hostile portals a run, none of whose visible points
 * may lie outside their window; and how loose the windows are.
 *
 * Taken out one at a time, each of these made the suite fail: the clip before the divide, rounding outward, the outward
 * move of the clipping sides, the fallback for what is not finite or too coarse; and the pad together with the error bound
 * (either alone still contains everything here). test_portal_eye.c does the same for the eye near a portal. */
#include "harness/exact_view.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct Counts {
    uint32_t windows, empties, parents;
    double loose; /* sum over sides of portals ahead, px */
    uint32_t sides;
    double loosest; /* among portals that need no clipping, px */
} Counts;

/* What is seen of the portal through the window, or false if that has no extent. */
static bool exact_range(const EnfCamera *camera, const Portal *portal, EnfWindow parent, Quad range[4]) {
    ExactPolygon p = exact_polygon(camera, portal->points, portal->count);
    exact_clip_eye(&p);
    exact_clip_window(&p, camera, parent);
    for (uint32_t i = 0; i < p.count; i++) {
        Quad x = exact_x(camera, &p.points[i]), y = exact_y(camera, &p.points[i]);
        range[0] = i == 0 ? x : quad_min(range[0], x);
        range[1] = i == 0 ? y : quad_min(range[1], y);
        range[2] = i == 0 ? x : quad_max(range[2], x);
        range[3] = i == 0 ? y : quad_max(range[3], y);
    }
    return p.count > 0;
}

/* The oracle's own rounding: 2^-100 of the largest values in play, far below anything a window could lose. */
static const double oracle_error = 1e-15;

static bool holds(EnfWindow w, const Quad range[4]) {
    Quad e = quad(oracle_error);
    return quad(w.x0) <= range[0] + e && quad(w.y0) <= range[1] + e && quad(w.x1) >= range[2] - e && quad(w.y1) >= range[3] - e;
}

/* A polygon that only touches the border of the parent's window shows nothing through it. */
static bool touches_only(EnfWindow parent, const Quad range[4]) {
    Quad e = quad(oracle_error);
    return range[2] <= quad(parent.x0) + e || range[0] >= quad(parent.x1) - e || range[3] <= quad(parent.y0) + e ||
           range[1] >= quad(parent.y1) - e;
}

static void describe(const EnfCamera *c, const Portal *p, EnfWindow parent, EnfWindow out, const Quad range[4]) {
    printf("camera r %a %a %a u %a %a %a f %a %a %a tan %a %a, %u x %u px\n", c->right.x, c->right.y, c->right.z, c->up.x,
           c->up.y, c->up.z, c->forward.x, c->forward.y, c->forward.z, c->tan_x, c->tan_y, c->width_px, c->height_px);
    for (uint32_t i = 0; i < p->count; i++) {
        printf("  %a %a %a  depth %g\n", p->points[i].x, p->points[i].y, p->points[i].z, enf_dot(p->points[i], c->forward));
    }
    printf("parent %d %d %d %d, window %d %d %d %d, exact %.6f %.6f %.6f %.6f\n", parent.x0, parent.y0, parent.x1, parent.y1,
           out.x0, out.y0, out.x1, out.y1, (double)range[0], (double)range[1], (double)range[2], (double)range[3]);
}

/* Looseness, of what lies wholly ahead. Without clipping a side is at most a step's rounding and two pads out. */
static void measure(const EnfCamera *camera, const Portal *portal, EnfWindow parent, EnfWindow out, const Quad range[4],
                    Counts *counts) {
    bool clipped = false;
    for (uint32_t i = 0; i < portal->count; i++) {
        if (enf_dot(portal->points[i], camera->forward) < 0.125) {
            return;
        }
    }
    double inside[4] = {(double)(range[0] - quad(parent.x0)), (double)(range[1] - quad(parent.y0)),
                        (double)(quad(parent.x1) - range[2]), (double)(quad(parent.y1) - range[3])};
    double out_by[4] = {(double)(range[0] - quad(out.x0)), (double)(range[1] - quad(out.y0)), (double)(quad(out.x1) - range[2]),
                        (double)(quad(out.y1) - range[3])};
    for (int i = 0; i < 4; i++) {
        clipped = clipped || inside[i] < 0.125;
    }
    for (int i = 0; i < 4; i++) {
        double px = out_by[i] / ENF_WINDOW_STEPS;
        counts->loose += px;
        counts->sides++;
        counts->loosest = !clipped && px > counts->loosest ? px : counts->loosest;
    }
}

/* How much nearer than it is a polygon may seem: the rounding of the frame, and of a sliver's normal (which grows with
 * its size over its width; it may only pass more). */
static double granted(const EnfCamera *camera, const Portal *portal) {
    double size = 0.0;
    EnfVec3 normal = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < portal->count; i++) {
        EnfVec3 a = enf_sub(portal->points[i], portal->points[0]);
        normal = enf_add(normal, enf_cross(a, enf_sub(portal->points[(i + 1) % portal->count], portal->points[0])));
        size = fmax(size, enf_length(portal->points[i]));
    }
    double slimness = size * size / fmax(enf_length(normal), DBL_MIN);
    return 1e-6 + 0x1p-44 * size * (1.0 + camera->tan_x + camera->tan_y) + 0x1p-48 * size * slimness;
}

static void check_portal(const EnfCamera *camera, const Portal *portal, EnfWindow parent, Counts *counts) {
    Quad range[4] = {quad(0.0), quad(0.0), quad(0.0), quad(0.0)};
    bool seen = exact_range(camera, portal, parent, range);
    EnfWindow out = {9, 9, 9, 9};
    EnfProject what = enf_project_box(camera, portal->points, portal->count, parent, &out);
    bool right = enf_window_contains(parent, out);
    if (what == ENF_PROJECT_EMPTY) {
        counts->empties++;
        right = right && enf_window_is_empty(out) && (!seen || touches_only(parent, range));
    } else if (what == ENF_PROJECT_PARENT) {
        counts->parents++;
        Quad reach = quad(ENF_TOL_PORTAL_EYE + granted(camera, portal));
        right = enf_window_contains(out, parent) && exact_distance2(portal->points, portal->count) <= reach * reach;
    } else {
        counts->windows++;
        right = right && !enf_window_is_empty(out) && (!seen || holds(out, range));
        if (seen && right) {
            measure(camera, portal, parent, out, range, counts);
        }
    }
    if (!right) {
        describe(camera, portal, parent, out, range);
        fail_msg("a portal shows more than its window (result %d, seen %d)", (int)what, (int)seen);
    }
}

static void run_kind(PortalKind kind, uint32_t rounds, Counts *counts) {
    EnfTestRng rng = enf_test_rng(100 + (uint64_t)kind);
    for (uint32_t i = 0; i < rounds; i += 8) {
        EnfCamera camera = any_camera(&rng);
        for (uint32_t k = 0; k < 8; k++) {
            Portal portal = any_portal(&rng, &camera, kind);
            check_portal(&camera, &portal, any_window(&rng, &camera), counts);
        }
    }
}

static void a_million_portals_are_contained(void **state) {
    (void)state;
    static const char *const names[PORTAL_KIND_COUNT] = {"door", "around",  "near",      "edge-on", "sliver",
                                                         "far",  "doubled", "eye plane", "grid",    "fitted"};
    uint32_t rounds = enf_test_rounds(100000, 2000000);
    for (int kind = 0; kind < PORTAL_KIND_COUNT; kind++) {
        Counts c = {0, 0, 0, 0.0, 0, 0.0};
        run_kind((PortalKind)kind, rounds, &c);
        double mean = c.sides ? c.loose / (double)c.sides : 0.0;
        printf("%-9s windows %7u, empty %7u, parent %6u; loose by %.4f px a side, unclipped at most %.4f\n", names[kind],
               c.windows, c.empties, c.parents, mean, c.loosest);
        assert_true(c.windows > rounds / 50); /* the generator still makes what it is for */
        assert_true(mean < 0.125);
        assert_true(c.loosest <= (1.0 + 2.0 / 16 + 0.01) / ENF_WINDOW_STEPS);
    }
}

/* ---- single cases ----------------------------------------------------------------------------------------------- */

static EnfCamera plain_camera(void) {
    return enf_camera(enf_v3(0, 0, 0), enf_turn(0, 0, 0), 60, 640, 480);
}

static void what_is_not_finite_passes_the_parent(void **state) {
    (void)state;
    EnfCamera camera = plain_camera();
    EnfWindow parent = {10, 20, 300, 400}, out;
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, 1e300, 1e12};
    for (uint32_t i = 0; i < 5; i++) {
        for (uint32_t vertex = 0; vertex < 4; vertex++) {
            for (uint32_t axis = 0; axis < 3; axis++) {
                EnfVec3 square[4] = {{-1, -1, -3}, {1, -1, -3}, {1, 1, -3}, {-1, 1, -3}};
                *(axis == 0 ? &square[vertex].x : axis == 1 ? &square[vertex].y : &square[vertex].z) = bad[i];
                assert_int_equal(enf_project_box(&camera, square, 4, parent, &out), ENF_PROJECT_PARENT);
                assert_true(enf_window_contains(out, parent) && enf_window_contains(parent, out));
            }
        }
    }
    EnfVec3 square[4] = {{-1, -1, -3}, {1, -1, -3}, {1, 1, -3}, {-1, 1, -3}};
    for (uint32_t count = 0; count < 3; count++) {
        assert_int_equal(enf_project_box(&camera, square, count, parent, &out), ENF_PROJECT_PARENT);
    }
    camera.forward.x = (double)NAN;
    assert_int_equal(enf_project_box(&camera, square, 4, parent, &out), ENF_PROJECT_PARENT);
}

/* A ring that crosses the eye plane at every vertex has more corners after the clip than a convex one could have. */
static void a_wild_ring_stays_in_bounds(void **state) {
    (void)state;
    EnfCamera camera = plain_camera();
    EnfTestRng rng = enf_test_rng(7);
    EnfWindow parent = enf_window_full(&camera), out;
    EnfWindowPolygon polygon = enf_window_polygon_from_box(parent), clipped;
    for (uint32_t i = 0; i < 20000; i++) {
        Portal p;
        p.count = ENF_POLYGON_MAX;
        for (uint32_t k = 0; k < p.count; k++) {
            p.points[k] = enf_v3(enf_test_double(&rng, -9, 9), enf_test_double(&rng, -9, 9), k % 2 ? -4.0 : 1.0);
        }
        enf_project_box(&camera, p.points, p.count, parent, &out);
        assert_true(enf_window_contains(parent, out));
        enf_project_polygon(&camera, p.points, p.count, &polygon, &clipped);
        assert_true(enf_window_polygon_contains(&polygon, &clipped));
    }
}

static void known_portals_have_known_windows(void **state) {
    (void)state;
    EnfCamera camera = enf_camera(enf_v3(0, 0, 0), enf_turn(0, 0, 0), 90, 640, 640);
    EnfWindow full = enf_window_full(&camera), out, none = {0, 0, 0, 0};
    assert_true(full.x0 == 0 && full.y0 == 0 && full.x1 == 10240 && full.y1 == 10240);
    /* A square of half the picture's width: corners at pixels 160 and 480, one step out for the pad. */
    EnfVec3 square[4] = {{-1, -1, -2}, {1, -1, -2}, {1, 1, -2}, {-1, 1, -2}};
    assert_int_equal(enf_project_box(&camera, square, 4, full, &out), ENF_PROJECT_WINDOW);
    assert_true(out.x0 == 2559 && out.y0 == 2559 && out.x1 == 7681 && out.y1 == 7681);
    assert_int_equal(enf_project_box(&camera, square, 4, none, &out), ENF_PROJECT_EMPTY);
    /* The floor under the eye: it fills the lower half of the picture, up to the horizon. */
    EnfVec3 floor_plan[4] = {{-50, -1, 50}, {50, -1, 50}, {50, -1, -50}, {-50, -1, -50}};
    assert_int_equal(enf_project_box(&camera, floor_plan, 4, full, &out), ENF_PROJECT_WINDOW);
    assert_true(out.x0 == 0 && out.x1 == 10240 && out.y0 == 0 && out.y1 > 5000 && out.y1 < 5120);
    for (int i = 0; i < 4; i++) {
        square[i].z = 2;
    }
    assert_int_equal(enf_project_box(&camera, square, 4, full, &out), ENF_PROJECT_EMPTY);
    assert_true(enf_window_is_empty(out));
}

static void cameras_look_where_they_are_told(void **state) {
    (void)state;
    EnfCamera c = enf_camera(enf_v3(1, 2, 3), enf_turn(90, 0, 0), 90, 200, 100);
    assert_true(c.forward.x == -1.0 && c.forward.y == 0.0 && c.forward.z == 0.0);
    assert_true(c.right.x == 0.0 && c.right.z == -1.0 && c.up.y == 1.0 && c.eye_ws.y == 2.0);
    assert_true(fabs(c.tan_y - 1.0) < 1e-15 && fabs(c.tan_x - 2.0) < 1e-15);
    c = enf_camera(enf_v3(0, 0, 0), enf_turn(0, 90, 0), 60, 200, 100);
    assert_true(c.forward.y == 1.0 && c.forward.z == 0.0 && c.up.z == 1.0 && c.right.x == 1.0);
    c = enf_camera(enf_v3(0, 0, 0), enf_turn(0, 0, 90), 60, 200, 100); /* the head on the right shoulder: up is to the right */
    assert_true(c.up.x == 1.0 && c.up.y == 0.0 && c.right.y == -1.0 && c.forward.z == -1.0);
    EnfTestRng rng = enf_test_rng(8);
    for (int i = 0; i < 1000; i++) {
        c = any_camera(&rng);
        EnfVec3 r = enf_cross(c.forward, c.up);
        assert_true(enf_length(enf_sub(r, c.right)) < 1e-15 * 8);
        assert_true(fabs(enf_length(c.forward) - 1.0) < 1e-15 && fabs(enf_length(c.up) - 1.0) < 1e-15);
    }
}

static void box_windows_add_and_cut(void **state) {
    (void)state;
    EnfWindow a = {0, 0, 10, 10}, b = {5, -5, 20, 5}, none = {7, 7, 7, 9}, far = {30, 0, 40, 10};
    EnfWindow both = enf_window_union(a, b), common = enf_window_intersect(a, b);
    assert_true(both.x0 == 0 && both.y0 == -5 && both.x1 == 20 && both.y1 == 10);
    assert_true(common.x0 == 5 && common.y0 == 0 && common.x1 == 10 && common.y1 == 5);
    assert_true(enf_window_is_empty(none) && enf_window_is_empty(enf_window_intersect(a, far)));
    both = enf_window_union(a, none);
    assert_true(both.x1 == 10 && both.y1 == 10);
    both = enf_window_union(none, a);
    assert_true(both.x1 == 10 && both.y1 == 10);
    assert_true(enf_window_contains(a, a) && enf_window_contains(a, none) && !enf_window_contains(a, b));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_million_portals_are_contained),  cmocka_unit_test(what_is_not_finite_passes_the_parent),
    cmocka_unit_test(a_wild_ring_stays_in_bounds),      cmocka_unit_test(known_portals_have_known_windows),
    cmocka_unit_test(cameras_look_where_they_are_told), cmocka_unit_test(box_windows_add_and_cut),
};

ENF_TEST_MAIN(tests)
