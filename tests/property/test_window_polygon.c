/* Polygon windows: the exact clip lies within, hulls and containment are exact, beyond the limit the bounding box takes
 * over. Against 113-bit and 128-bit arithmetic. Rounding the vertices to the nearest step, leaving out the pads, or
 * clamping the hull into the box vertex by vertex instead of clipping it, each failed this suite when tried. */
#include "harness/exact_view.h"

#include <stdio.h>
#include <string.h>

__extension__ typedef __int128 Int128;

/* ---- random convex polygons ------------------------------------------------------------------------------------- */

static EnfWindow any_box(EnfTestRng *rng, int32_t width, int32_t height, uint32_t most) {
    EnfWindow w;
    w.x0 = (int32_t)enf_test_below(rng, (uint32_t)width);
    w.y0 = (int32_t)enf_test_below(rng, (uint32_t)height);
    w.x1 = w.x0 + 1 + (int32_t)enf_test_below(rng, most);
    w.y1 = w.y0 + 1 + (int32_t)enf_test_below(rng, most);
    w.x1 = w.x1 < width ? w.x1 : width;
    w.y1 = w.y1 < height ? w.y1 : height;
    return w;
}

/* The hull of a few small boxes: up to some 20 vertices at any angle. */
static EnfWindowPolygon any_polygon(EnfTestRng *rng, int32_t width, int32_t height) {
    EnfWindowPolygon p = enf_window_polygon_from_box(any_box(rng, width, height, 30));
    for (uint32_t n = enf_test_below(rng, 8); n > 0; n--) {
        EnfWindowPolygon more = enf_window_polygon_from_box(any_box(rng, width, height, 3));
        enf_window_polygon_union(&p, &more, &p);
    }
    return p;
}

/* ---- exact judges ----------------------------------------------------------------------------------------------- */

static Int128 turn(const EnfWindowPolygon *p, uint32_t i, int64_t x, int64_t y) {
    uint32_t j = (i + 1) % p->count;
    return (Int128)((int64_t)p->x[j] - p->x[i]) * (y - p->y[i]) - (Int128)((int64_t)p->y[j] - p->y[i]) * (x - p->x[i]);
}

static void expect_strictly_convex(const EnfWindowPolygon *p) {
    assert_true(p->count == 0 || p->count >= 3);
    assert_true(p->count <= ENF_WINDOW_POLYGON_MAX);
    for (uint32_t i = 0; i < p->count; i++) {
        for (uint32_t k = 0; k < p->count; k++) {
            bool on_edge = k == i || k == (i + 1) % p->count;
            assert_true(on_edge ? turn(p, i, p->x[k], p->y[k]) == 0 : turn(p, i, p->x[k], p->y[k]) > 0);
        }
    }
}

static bool contains(const EnfWindowPolygon *outer, const EnfWindowPolygon *inner) {
    for (uint32_t k = 0; k < inner->count; k++) {
        for (uint32_t i = 0; i < outer->count; i++) {
            if (turn(outer, i, inner->x[k], inner->y[k]) < 0) {
                return false;
            }
        }
    }
    return inner->count == 0 || outer->count > 0;
}

static bool has_vertex(const EnfWindowPolygon *p, int32_t x, int32_t y) {
    for (uint32_t i = 0; i < p->count; i++) {
        if (p->x[i] == x && p->y[i] == y) {
            return true;
        }
    }
    return false;
}

/* The least distance, in steps, by which a point is inside a polygon (negative: outside). */
static Quad depth_inside(const EnfWindowPolygon *p, Quad x, Quad y) {
    Quad least = quad(1e30);
    for (uint32_t i = 0; i < p->count; i++) {
        uint32_t j = (i + 1) % p->count;
        double dx = (double)p->x[j] - p->x[i], dy = (double)p->y[j] - p->y[i];
        Quad side = quad(dx) * (y - quad(p->y[i])) - quad(dy) * (x - quad(p->x[i]));
        least = quad_min(least, side / quad(sqrt(dx * dx + dy * dy)));
    }
    return least;
}

/* ---- projection ------------------------------------------------------------------------------------------------- */

static ExactPolygon exact_seen(const EnfCamera *camera, const Portal *portal, const EnfWindowPolygon *parent) {
    ExactPolygon p = exact_polygon(camera, portal->points, portal->count);
    exact_clip_eye(&p);
    for (uint32_t i = 0; i < parent->count && p.count > 0; i++) {
        uint32_t j = (i + 1) % parent->count;
        exact_clip_edge(&p, camera, enf_v3(parent->x[i], parent->y[i], 0), enf_v3(parent->x[j], parent->y[j], 0));
    }
    return p;
}

static double area(const EnfWindowPolygon *p) {
    double twice = 0.0;
    for (uint32_t i = 0; i < p->count; i++) {
        uint32_t j = (i + 1) % p->count;
        twice += (double)((int64_t)p->x[i] * p->y[j] - (int64_t)p->x[j] * p->y[i]);
    }
    return 0.5 * twice;
}

typedef struct Areas {
    double polygon, box;
    uint32_t windows;
} Areas;

static void check_window(const EnfCamera *camera, const Portal *portal, const EnfWindowPolygon *parent, Areas *areas) {
    EnfWindowPolygon out = *parent; /* one object for both, as callers may */
    EnfProject what = enf_project_polygon(camera, portal->points, portal->count, &out, &out);
    ExactPolygon seen = exact_seen(camera, portal, parent);
    Quad x = quad(0.0), y = quad(0.0), worst = quad(0.0);
    for (uint32_t i = 0; i < seen.count; i++) {
        Quad px = exact_x(camera, &seen.points[i]), py = exact_y(camera, &seen.points[i]);
        x += px / quad(seen.count);
        y += py / quad(seen.count);
        worst = quad_min(worst, out.count ? depth_inside(&out, px, py) : quad(0.0));
    }
    if (what == ENF_PROJECT_EMPTY) { /* nothing is seen, or the portal touches the parent's border from outside */
        assert_int_equal(out.count, 0);
        assert_true(seen.count == 0 || depth_inside(parent, x, y) < quad(1e-9));
        return;
    }
    expect_strictly_convex(&out);
    assert_true(out.count >= 3);
    assert_true(enf_window_contains(enf_window_polygon_bounds(parent), enf_window_polygon_bounds(&out)));
    if (worst < quad(-1e-12)) {
        fail_msg("%g steps outside its window", -(double)worst);
    }
    EnfWindow box;
    if (what == ENF_PROJECT_WINDOW &&
        enf_project_box(camera, portal->points, portal->count, enf_window_polygon_bounds(parent), &box) == ENF_PROJECT_WINDOW) {
        areas->polygon += area(&out);
        areas->box += ((double)box.x1 - box.x0) * ((double)box.y1 - box.y0);
        areas->windows++;
    }
}

static void exact_clips_are_contained(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    for (int kind = 0; kind < PORTAL_KIND_COUNT; kind++) {
        Areas areas = {0.0, 0.0, 0};
        for (uint32_t i = 0; i < enf_test_rounds(15000, 300000); i++) {
            EnfCamera camera = any_camera(&rng);
            EnfWindow full = enf_window_full(&camera);
            EnfWindowPolygon parent = any_polygon(&rng, full.x1, full.y1);
            Portal portal = any_portal(&rng, &camera, (PortalKind)kind);
            check_window(&camera, &portal, &parent, &areas);
        }
        printf("kind %d: %u windows, %.2f of the boxes' area\n", kind, areas.windows, areas.polygon / areas.box);
        assert_true(areas.windows > 100);
    }
}

/* Through three portals in a row: what all of them show is within the last window. */
static void chains_are_contained(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    uint32_t open = 0;
    for (uint32_t i = 0; i < enf_test_rounds(20000, 400000); i++) {
        EnfCamera camera = enf_camera(enf_v3(0, 0, 0), enf_turn(enf_test_double(&rng, 0, 360), 10, 0), 60, 640, 480);
        EnfWindowPolygon window = enf_window_polygon_from_box(enf_window_full(&camera)), whole = window;
        ExactPolygon seen = {0, {{quad(0.0), quad(0.0), quad(0.0)}}};
        for (int k = 0; k < 3; k++) {
            Portal portal = door_portal(&rng, &camera, 0.3, 0.6 + 0.4 * k);
            enf_project_polygon(&camera, portal.points, portal.count, &window, &window);
            if (k == 0) {
                seen = exact_seen(&camera, &portal, &whole);
                continue;
            }
            ExactPolygon next = exact_polygon(&camera, portal.points, portal.count);
            exact_clip_eye(&next);
            seen.count = next.count > 0 ? seen.count : 0; /* a portal behind the eye shows nothing */
            Quad twice = quad(0.0);                       /* the ring's direction, to clip by its edges */
            for (uint32_t a = 0; a < next.count; a++) {
                const ExactPoint *p = &next.points[a], *q = &next.points[(a + 1) % next.count];
                twice += p->x / p->w * (q->y / q->w) - q->x / q->w * (p->y / p->w);
            }
            for (uint32_t a = 0; a < next.count; a++) { /* the plane through the eye and an edge */
                const ExactPoint *p = &next.points[a], *q = &next.points[(a + 1) % next.count];
                Quad s = twice < quad(0.0) ? quad(-1.0) : quad(1.0);
                exact_clip(&seen, s * (p->y * q->w - p->w * q->y), s * (p->w * q->x - p->x * q->w),
                           s * (p->x * q->y - p->y * q->x), quad(0.0));
            }
        }
        for (uint32_t a = 0; a < seen.count; a++) {
            Quad x = exact_x(&camera, &seen.points[a]), y = exact_y(&camera, &seen.points[a]);
            assert_true(window.count > 0 && depth_inside(&window, x, y) > quad(-1e-9));
        }
        open += seen.count > 0;
    }
    assert_true(open > 100);
}

/* ---- unions ----------------------------------------------------------------------------------------------------- */

static void unions_are_hulls(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(3);
    for (uint32_t i = 0; i < enf_test_rounds(20000, 300000); i++) {
        int32_t size = enf_test_chance(&rng, 2) ? 40 : 1 << 20;
        EnfWindowPolygon a = any_polygon(&rng, size, size), b = any_polygon(&rng, size, size), both;
        enf_window_polygon_union(&a, &b, &both);
        expect_strictly_convex(&both);
        assert_true(contains(&both, &a) && contains(&both, &b));
        for (uint32_t k = 0; k < both.count; k++) { /* no larger than it must be */
            assert_true(has_vertex(&a, both.x[k], both.y[k]) || has_vertex(&b, both.x[k], both.y[k]));
        }
        assert_int_equal(enf_window_polygon_contains(&a, &b), contains(&a, &b));
        assert_true(enf_window_polygon_contains(&both, &a) && enf_window_polygon_contains(&a, &a));
        EnfWindowPolygon again;
        enf_window_polygon_union(&both, &a, &again); /* growing ends */
        assert_int_equal(again.count, both.count);
        assert_memory_equal(again.x, both.x, both.count * sizeof both.x[0]);
        assert_memory_equal(again.y, both.y, both.count * sizeof both.y[0]);
    }
}

static void empty_windows_add_nothing(void **state) {
    (void)state;
    EnfWindow box = {3, 4, 50, 60}, none = {5, 5, 5, 9};
    EnfWindowPolygon a = enf_window_polygon_from_box(box), empty = enf_window_polygon_from_box(none), sum;
    assert_int_equal(a.count, 4);
    assert_int_equal(empty.count, 0);
    enf_window_polygon_union(&a, &empty, &sum);
    assert_true(contains(&sum, &a) && contains(&a, &sum));
    enf_window_polygon_union(&empty, &empty, &sum);
    assert_int_equal(sum.count, 0);
    assert_true(enf_window_is_empty(enf_window_polygon_bounds(&empty)));
    EnfWindow bounds = enf_window_polygon_bounds(&a);
    assert_memory_equal(&bounds, &box, sizeof box);
    assert_true(enf_window_polygon_contains(&a, &empty) && !enf_window_polygon_contains(&empty, &a));
    assert_true(enf_window_polygon_contains(&empty, &empty));
}

/* Points on a parabola are all on their hull. */
static void too_many_vertices_become_the_box(void **state) {
    (void)state;
    EnfWindowPolygon a, b, both;
    a.count = b.count = 20;
    for (int32_t i = 0; i < 20; i++) {
        a.x[i] = i;
        a.y[i] = i * i;
        b.x[i] = 39 - i;
        b.y[i] = 3000 - i * i;
    }
    EnfWindowPolygon none = {0, {0}, {0}}, left, right;
    enf_window_polygon_union(&a, &none, &left);
    enf_window_polygon_union(&b, &none, &right);
    expect_strictly_convex(&left);
    assert_int_equal(left.count, 20);
    enf_window_polygon_union(&left, &right, &both);
    assert_int_equal(both.count, 4);
    assert_true(contains(&both, &left) && contains(&both, &right));
    EnfWindow bounds = enf_window_polygon_bounds(&both), expected = {0, 0, 39, 3000};
    assert_memory_equal(&bounds, &expected, sizeof bounds);
}

/* The largest coordinates that windows may have: 2^29. */
static void large_coordinates_do_not_overflow(void **state) {
    (void)state;
    const int32_t far = INT32_C(1) << 29;
    EnfWindow all = {-far, -far, far, far}, corner = {far - 1, far - 1, far, far}, middle = {0, 0, 1, 1};
    EnfWindowPolygon a = enf_window_polygon_from_box(all), b = enf_window_polygon_from_box(corner), both;
    EnfWindowPolygon c = enf_window_polygon_from_box(middle);
    assert_true(enf_window_polygon_contains(&a, &b) && !enf_window_polygon_contains(&b, &a));
    enf_window_polygon_union(&b, &c, &both);
    expect_strictly_convex(&both);
    assert_int_equal(both.count, 6);
    assert_true(contains(&both, &b) && contains(&both, &c) && contains(&a, &both));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(exact_clips_are_contained),
    cmocka_unit_test(chains_are_contained),
    cmocka_unit_test(unions_are_hulls),
    cmocka_unit_test(empty_windows_add_nothing),
    cmocka_unit_test(too_many_vertices_become_the_box),
    cmocka_unit_test(large_coordinates_do_not_overflow),
};

ENF_TEST_MAIN(tests)
