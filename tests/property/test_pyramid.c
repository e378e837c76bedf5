/* View pyramids in float: a box with a point in the exact pyramid is never rejected; and the planes give away no more than
 * their derived error. Taking the float error of the coordinates (7 u S in pyramid.c) out of d fails this suite at once. */
#include "harness/exact_view.h"

#include <float.h>
#include <stdio.h>

/* ---- one random case -------------------------------------------------------------------------------------------- */

typedef struct Case {
    EnfCamera camera;
    EnfWindow window;
    EnfWindowPolygon polygon;
    bool has_polygon;
    EnfVec3 origin;
    EnfBox3f bounds;
    EnfPyramid pyramid;
} Case;

/* Cells of 1 m to 4 km, the eye in them or far away, the world's origin up to 100 km off. */
static Case any_case(EnfTestRng *rng) {
    Case c;
    c.camera = any_camera(rng);
    c.camera.eye_ws = any_vector(rng, any_size(rng, 0.0, 5.0));
    c.window = any_window(rng, &c.camera);
    c.has_polygon = enf_test_chance(rng, 2);
    EnfWindow corner = c.window, other = c.window;
    corner.x1 = corner.x0 + 1;
    corner.y1 = corner.y0 + 1;
    other.x0 = other.x1 - 1;
    other.y0 = other.y1 - 1;
    EnfWindowPolygon a = enf_window_polygon_from_box(corner), b = enf_window_polygon_from_box(other);
    enf_window_polygon_union(&a, &b, &c.polygon);
    double size = any_size(rng, 0.0, 3.6);
    EnfVec3 origin = enf_add(c.camera.eye_ws, any_vector(rng, enf_test_chance(rng, 3) ? 50.0 * size : size));
    c.origin = enf_v3(floor(origin.x * 256.0) / 256.0, floor(origin.y * 256.0) / 256.0, floor(origin.z * 256.0) / 256.0);
    EnfVec3 half = {size, size * enf_test_double(rng, 0.01, 1.0), size};
    EnfBox3 bounds = {enf_scale(half, -1.0), half};
    c.bounds = enf_box3f_outward(bounds);
    enf_pyramid(&c.camera, c.window, c.has_polygon ? &c.polygon : NULL, c.origin, c.bounds, &c.pyramid);
    return c;
}

/* A point near the border of what the window shows, as a cell stores it; false if it is outside the bounds. */
static bool border_point(EnfTestRng *rng, const Case *c, EnfVec3f *out) {
    double x = c->window.x0, y = c->window.y0;
    uint32_t where = enf_test_below(rng, 4);
    if (c->has_polygon) {
        uint32_t i = enf_test_below(rng, c->polygon.count), j = (i + 1) % c->polygon.count;
        double t = where == 0 ? 0.0 : enf_test_double(rng, 0.0, 1.0);
        x = c->polygon.x[i] + t * ((double)c->polygon.x[j] - c->polygon.x[i]);
        y = c->polygon.y[i] + t * ((double)c->polygon.y[j] - c->polygon.y[i]);
    } else {
        x = where == 1 ? enf_test_double(rng, x, c->window.x1) : where == 2 ? c->window.x1 : x;
        y = where == 3 ? enf_test_double(rng, y, c->window.y1) : where == 2 ? c->window.y1 : y;
    }
    double mx = 8.0 * (double)c->camera.width_px, my = 8.0 * (double)c->camera.height_px;
    double depth = enf_test_chance(rng, 8) ? 0.0 : any_size(rng, -3.0, 4.0);
    EnfVec3 p = from_frame(&c->camera, (x - mx) / mx * c->camera.tan_x * depth, (y - my) / my * c->camera.tan_y * depth, depth);
    if (depth == 0.0) { /* beside the eye, in its plane: seen by no window, but the eye itself is in all */
        p = enf_v3(0, 0, 0);
    }
    p = enf_sub(enf_add(p, c->camera.eye_ws), c->origin);
    *out = enf_v3f(p);
    for (uint32_t n = enf_test_below(rng, 3); n > 0; n--) {
        float *axis = n == 1 ? &out->x : &out->y;
        *axis = nextafterf(*axis, enf_test_chance(rng, 2) ? FLT_MAX : -FLT_MAX);
    }
    EnfBox3 bounds = enf_box3_from_f(c->bounds);
    return enf_box3_contains(bounds, enf_v3_from_f(*out));
}

/* ---- the exact pyramid ------------------------------------------------------------------------------------------ */

/* How far inside the exact half-space left of the line a → b, in units of its unnormalised plane. */
static bool left_of(const Case *c, const ExactPoint *p, double ax, double ay, double bx, double by) {
    Quad mx = quad(8.0) * quad(c->camera.width_px), my = quad(8.0) * quad(c->camera.height_px);
    Quad dx = quad(bx - ax), dy = quad(by - ay);
    Quad side = dx * (p->y * my / quad(c->camera.tan_y) + (my - quad(ay)) * p->w) -
                dy * (p->x * mx / quad(c->camera.tan_x) + (mx - quad(ax)) * p->w);
    return side >= quad(0.0);
}

static bool exactly_inside(const Case *c, EnfVec3f local) {
    Quad v[3] = {quad(c->origin.x) + quad((double)local.x) - quad(c->camera.eye_ws.x),
                 quad(c->origin.y) + quad((double)local.y) - quad(c->camera.eye_ws.y),
                 quad(c->origin.z) + quad((double)local.z) - quad(c->camera.eye_ws.z)};
    EnfVec3 axes[3] = {c->camera.right, c->camera.up, c->camera.forward};
    Quad s[3];
    for (int i = 0; i < 3; i++) {
        s[i] = quad(axes[i].x) * v[0] + quad(axes[i].y) * v[1] + quad(axes[i].z) * v[2];
    }
    ExactPoint p = {s[0], s[1], s[2]};
    double x0 = c->window.x0, y0 = c->window.y0, x1 = c->window.x1, y1 = c->window.y1;
    bool inside = p.w >= quad(0.0) && left_of(c, &p, x0, y0, x1, y0) && left_of(c, &p, x1, y0, x1, y1) &&
                  left_of(c, &p, x1, y1, x0, y1) && left_of(c, &p, x0, y1, x0, y0);
    for (uint32_t i = 0; inside && c->has_polygon && i < c->polygon.count; i++) {
        uint32_t j = (i + 1) % c->polygon.count;
        inside = left_of(c, &p, c->polygon.x[i], c->polygon.y[i], c->polygon.x[j], c->polygon.y[j]);
    }
    return inside;
}

static EnfBox3f box_around(EnfTestRng *rng, const Case *c, EnfVec3f p) {
    EnfVec3 q = enf_v3_from_f(p), low = enf_v3(0, 0, 0), high = low;
    if (!enf_test_chance(rng, 3)) { /* else the point alone */
        low = any_vector(rng, any_size(rng, -4.0, 1.0));
        high = any_vector(rng, any_size(rng, -4.0, 1.0));
    }
    EnfBox3 box = {enf_sub(q, enf_v3(fabs(low.x), fabs(low.y), fabs(low.z))),
                   enf_add(q, enf_v3(fabs(high.x), fabs(high.y), fabs(high.z)))};
    EnfBox3f f = enf_box3f_outward(box);
    f.min.x = fmaxf(f.min.x, c->bounds.min.x);
    f.min.y = fmaxf(f.min.y, c->bounds.min.y);
    f.min.z = fmaxf(f.min.z, c->bounds.min.z);
    f.max.x = fminf(f.max.x, c->bounds.max.x);
    f.max.y = fminf(f.max.y, c->bounds.max.y);
    f.max.z = fminf(f.max.z, c->bounds.max.z);
    return f;
}

static void no_visible_box_is_rejected(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    uint32_t inside = 0, outside = 0, rejected = 0;
    for (uint32_t i = 0; i < enf_test_rounds(60000, 1500000); i++) {
        Case c = any_case(&rng);
        for (int k = 0; k < 8; k++) {
            EnfVec3f p;
            if (!border_point(&rng, &c, &p)) {
                continue;
            }
            EnfBox3f alone = {p, p};
            if (exactly_inside(&c, p)) {
                inside++;
                if (!enf_pyramid_box(&c.pyramid, alone) || !enf_pyramid_box(&c.pyramid, box_around(&rng, &c, p))) {
                    fail_msg("round %u: a box with a visible point is rejected", i);
                }
            } else {
                outside++;
                rejected += !enf_pyramid_box(&c.pyramid, alone);
            }
        }
    }
    printf("%u inside, %u outside by a hair (%u of these rejected)\n", inside, outside, rejected);
    assert_true(inside > 20000 && outside > 20000);
}

/* The slack of a plane is a few float roundings of the coordinates: a box clearly outside is rejected. */
static void what_is_clearly_outside_is_rejected(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    uint32_t tested = 0;
    for (uint32_t i = 0; i < enf_test_rounds(60000, 500000); i++) {
        Case c = any_case(&rng);
        EnfVec3f p;
        if (!border_point(&rng, &c, &p)) {
            continue;
        }
        uint32_t plane = enf_test_below(&rng, c.pyramid.count);
        EnfVec3 n = {(double)c.pyramid.nx[plane], (double)c.pyramid.ny[plane], (double)c.pyramid.nz[plane]};
        EnfVec3 local = enf_v3_from_f(p);
        double size = enf_length(local) + enf_length(enf_sub(c.origin, c.camera.eye_ws)) +
                      enf_length(enf_box3_from_f(c.bounds).max);
        double value = enf_dot(n, local) + enf_dot(n, enf_sub(c.origin, c.camera.eye_ws));
        EnfVec3f q = enf_v3f(enf_sub(local, enf_scale(n, value + 32.0 * 0x1p-24 * size)));
        EnfBox3f box = {q, q};
        assert_false(enf_pyramid_box(&c.pyramid, box));
        assert_true(fabs(enf_length(n) - 1.0) < 1e-6);
        tested++;
    }
    assert_true(tested > 5000);
}

static void planes_are_where_the_header_says(void **state) {
    (void)state;
    EnfCamera camera = enf_camera(enf_v3(0, 0, 0), enf_turn(0, 0, 0), 90, 100, 100);
    EnfBox3f bounds = {{-10, -10, -10}, {10, 10, 10}};
    EnfPyramid p;
    enf_pyramid(&camera, enf_window_full(&camera), NULL, enf_v3(0, 0, 0), bounds, &p);
    assert_int_equal(p.count, 5);
    const float half = (float)sqrt(0.5),
                expected[5][3] = {{half, 0, -half}, {-half, 0, -half}, {0, half, -half}, {0, -half, -half}, {0, 0, -1}};
    for (int i = 0; i < 5; i++) {
        assert_true(fabsf(p.nx[i] - expected[i][0]) < 1e-6f && fabsf(p.ny[i] - expected[i][1]) < 1e-6f &&
                    fabsf(p.nz[i] - expected[i][2]) < 1e-6f && p.d[i] >= 0.0f && p.d[i] < 1e-5f);
    }
    EnfWindowPolygon box = enf_window_polygon_from_box(enf_window_full(&camera));
    enf_pyramid(&camera, enf_window_full(&camera), &box, enf_v3(0, 0, 0), bounds, &p);
    assert_int_equal(p.count, 5); /* a polygon's upright and level edges are the window's sides */
    EnfWindow corner = {0, 0, 100, 100}, other = {1500, 1500, 1600, 1600};
    EnfWindowPolygon a = enf_window_polygon_from_box(corner), b = enf_window_polygon_from_box(other), both;
    enf_window_polygon_union(&a, &b, &both);
    enf_pyramid(&camera, enf_window_full(&camera), &both, enf_v3(0, 0, 0), bounds, &p);
    assert_int_equal(p.count, 7);
    EnfBox3f seen = {{0.1f, 0.1f, -1.1f}, {0.1f, 0.1f, -1.0f}}, cut = {{-0.9f, 0.8f, -1.1f}, {-0.8f, 0.9f, -1.0f}};
    assert_true(enf_pyramid_box(&p, seen) && !enf_pyramid_box(&p, cut));
}

/* Nothing that is not finite hides anything. */
static void what_is_not_finite_is_kept(void **state) {
    (void)state;
    EnfBox3f unit = {{-1, -1, -1}, {1, 1, 1}};
    EnfCamera camera = enf_camera(enf_v3(0, 0, 0), enf_turn(0, 0, 0), 90, 100, 100);
    EnfWindow full = enf_window_full(&camera), step = {800, 800, 801, 801};
    const float bad[] = {NAN, INFINITY, FLT_MAX};
    EnfPyramid p;
    EnfBox3f behind = {{-1, -1, 5}, {1, 1, 6}};
    for (int i = 0; i < 3; i++) {
        EnfBox3f bounds = {{-bad[i], -bad[i], -bad[i]}, {bad[i], bad[i], bad[i]}};
        enf_pyramid(&camera, full, NULL, enf_v3(0, 0, 0), bounds, &p);
        EnfBox3f huge = {{-FLT_MAX, -FLT_MAX, -FLT_MAX}, {FLT_MAX, FLT_MAX, FLT_MAX}};
        assert_true(enf_pyramid_box(&p, huge) && enf_pyramid_box(&p, unit));
        assert_true(i == 0 || enf_pyramid_box(&p, behind));
        enf_pyramid(&camera, step, NULL, enf_v3(0, 0, 0), unit, &p);
        EnfBox3f rubbish = {{bad[i], -1, 5}, {bad[i], 1, 6}};
        assert_true(i > 0 || enf_pyramid_box(&p, rubbish));
    }
    enf_pyramid(&camera, full, NULL, enf_v3((double)NAN, 0, 0), unit, &p);
    assert_true(enf_pyramid_box(&p, behind));
    enf_pyramid(&camera, full, NULL, enf_v3(1e300, 0, 0), unit, &p);
    assert_true(p.count == 5);
    camera.tan_x = (double)INFINITY;
    enf_pyramid(&camera, full, NULL, enf_v3(0, 0, 0), unit, &p);
    assert_true(enf_pyramid_box(&p, unit));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(no_visible_box_is_rejected),
    cmocka_unit_test(what_is_clearly_outside_is_rejected),
    cmocka_unit_test(planes_are_where_the_header_says),
    cmocka_unit_test(what_is_not_finite_is_kept),
};

ENF_TEST_MAIN(tests)
