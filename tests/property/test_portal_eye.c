/* The eye at a portal: within ENF_TOL_PORTAL_EYE of the *polygon* the parent's window passes whole, and one step farther it
 * does not. PITFALLS 2 and 3: without the rule the next room vanishes while one walks through the door; with the distance
 * to the *plane* in its place, every opening of a long wall passes everything, and the traversal explodes. Taking the rule
 * out of project.c, or putting the plane's distance in, fails this suite. */
#include "harness/exact_view.h"

#include <stdio.h>

static const EnfWindow parent = {100, 200, 4000, 3000};

static EnfProject project(const EnfCamera *camera, const EnfVec3 *points, uint32_t count, EnfWindow *out) {
    return enf_project_box(camera, points, count, parent, out);
}

static bool is_parent(EnfWindow w) {
    return enf_window_contains(w, parent) && enf_window_contains(parent, w);
}

static void tolerances_fit_together(void **state) {
    (void)state;
    /* What is seen of a polygon beyond the tolerance lies deeper than the plane that portals are cut at, even in the
     * corner of the widest picture. */
    EnfCamera widest = enf_camera(enf_v3(0, 0, 0), enf_turn(0, 0, 0), 170, 1920, 1080);
    double corner = sqrt(1.0 + widest.tan_x * widest.tan_x + widest.tan_y * widest.tan_y);
    assert_true(ENF_TOL_PORTAL_EYE / corner > 2.0 * ENF_TOL_EYE_PLANE);
    assert_true(ENF_TOL_PORTAL_EYE > 8.0 * ENF_GRID_STEP * sqrt(3.0)); /* an opening may be a step off */
    assert_true(ENF_TOL_PAD_PX * ENF_WINDOW_STEPS < 1.0);
}

static void distance_is_that_of_the_polygon(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    EnfCamera camera = any_camera(&rng);
    for (uint32_t i = 0; i < enf_test_rounds(40000, 1000000); i++) {
        static const PortalKind kinds[] = {PORTAL_AROUND, PORTAL_NEAR, PORTAL_EDGE_ON, PORTAL_GRID, PORTAL_DOUBLED};
        Portal p = any_portal(&rng, &camera, kinds[i % 5]);
        double size = 0.0, d2 = enf_polygon_distance2(p.points, p.count);
        for (uint32_t k = 0; k < p.count; k++) {
            size = fmax(size, enf_length(p.points[k]));
        }
        double exact = sqrt((double)exact_distance2(p.points, p.count));
        /* A sliver of height h turns by 2^-52 size / h when it is rounded, and its distance by as much of its size; portals of these
         * kinds are 10^-5 of their size high at least. A millionth of the grid's step a metre is still nothing. */
        if (!(fabs(sqrt(d2) - exact) <= 1e-10 * size)) {
            fail_msg("round %u: %.17g, exact %.17g, size %g", i, sqrt(d2), exact, size);
        }
    }
    EnfVec3 dot[3] = {{3, 4, 0}, {3, 4, 0}, {3, 4, 0}};
    assert_true(enf_polygon_distance2(dot, 3) == 25.0);
    assert_true(enf_polygon_distance2(dot, 1) == 25.0);
}

static void near_polygons_pass_the_parent(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    uint32_t near = 0, far = 0;
    for (uint32_t i = 0; i < enf_test_rounds(200000, 2000000); i++) {
        EnfCamera camera = any_camera(&rng);
        Portal p = near_portal(&rng);
        EnfWindow full = enf_window_full(&camera), out;
        EnfProject what = enf_project_box(&camera, p.points, p.count, full, &out);
        EnfWindowPolygon polygon = enf_window_polygon_from_box(full);
        EnfProject polygon_what = enf_project_polygon(&camera, p.points, p.count, &polygon, &polygon);
        double distance = sqrt((double)exact_distance2(p.points, p.count));
        if (distance <= ENF_TOL_PORTAL_EYE) {
            near++;
            assert_int_equal(what, ENF_PROJECT_PARENT);
            assert_int_equal(polygon_what, ENF_PROJECT_PARENT);
            assert_true(enf_window_contains(out, full));
            assert_true(enf_window_contains(enf_window_polygon_bounds(&polygon), full));
        } else if (distance > ENF_TOL_PORTAL_EYE + 1e-9) {
            far++;
            assert_int_not_equal(what, ENF_PROJECT_PARENT);
            assert_int_not_equal(polygon_what, ENF_PROJECT_PARENT);
        }
    }
    printf("%u near, %u beyond\n", near, far);
    assert_true(near > 1000 && far > 1000);
}

/* Through a doorway in steps of 1 mm, looking ahead, aside, up and back: until the eye is through, the next room is never
 * lost; at the frame, when the doorway fills the picture, all of it stays. */
static void the_next_room_stays_while_walking_in(void **state) {
    (void)state;
    const double sides[] = {0.0, 0.3, 0.4999};
    for (int s = 0; s < 3; s++) {
        for (int mm = -1000; mm <= 0; mm++) {
            double z = (double)mm / 1000.0; /* the doorway is at z = 0, one walks towards +z */
            EnfVec3 eye = {sides[s], 1.6, z};
            EnfVec3 door[4] = {{-0.5, 0, 0}, {0.5, 0, 0}, {0.5, 2, 0}, {-0.5, 2, 0}};
            for (int i = 0; i < 4; i++) {
                door[i] = enf_sub(door[i], eye);
            }
            for (int yaw = 110; yaw <= 250; yaw += 35) {
                EnfCamera camera = enf_camera(eye, enf_turn(yaw, 0, 0), 60, 640, 480);
                EnfWindow full = enf_window_full(&camera), out;
                EnfProject what = enf_project_box(&camera, door, 4, full, &out);
                /* beside the jamb and looking away from the doorway, it is out of the picture */
                bool away = yaw != 180 && (z < -0.05 || (s == 2 && yaw == 250 && z < -ENF_TOL_PORTAL_EYE));
                assert_true(what != ENF_PROJECT_EMPTY || away);
                if (yaw == 180 && z > -0.1) {
                    assert_true(s == 0 ? out.x0 == 0 && out.x1 == full.x1 : out.x1 - out.x0 > full.x1 / 2);
                }
                assert_true(what != ENF_PROJECT_PARENT || z >= -ENF_TOL_PORTAL_EYE - 1e-9);
            }
        }
    }
}

/* A wall with a thousand openings, the eye a millimetre from its plane: only the one that the eye stands in may pass the
 * parent's window (PITFALLS 3, the game that froze). */
static void openings_of_one_plane_stay_apart(void **state) {
    (void)state;
    EnfCamera camera = enf_camera(enf_v3(0, 0, 0), enf_turn(90, 0, 0), 60, 640, 480);
    uint32_t parents = 0;
    for (int i = -500; i < 500; i++) {
        double x0 = (double)i + 0.25, x1 = (double)i + 0.75;
        EnfVec3 opening[4] = {{x0 - 0.5, -1, 0.001}, {x1 - 0.5, -1, 0.001}, {x1 - 0.5, 1, 0.001}, {x0 - 0.5, 1, 0.001}};
        EnfWindow out;
        EnfProject what = project(&camera, opening, 4, &out);
        parents += what == ENF_PROJECT_PARENT;
        assert_true(what != ENF_PROJECT_PARENT || (i == 0 && is_parent(out)));
    }
    assert_int_equal(parents, 1);
}

/* An eye that a rounding or a grid step has put beyond a portal's plane still sees through it. */
static void a_step_beyond_the_plane_is_still_inside(void **state) {
    (void)state;
    for (int steps = -2; steps <= 2; steps++) {
        double z = (double)steps * ENF_GRID_STEP;
        EnfVec3 door[4] = {{-0.5, -1.6, z}, {0.5, -1.6, z}, {0.5, 0.4, z}, {-0.5, 0.4, z}};
        for (int yaw = 0; yaw < 360; yaw += 30) {
            EnfCamera camera = enf_camera(enf_v3(0, 0, 0), enf_turn(yaw, 0, 0), 60, 640, 480);
            EnfWindow out;
            assert_int_equal(project(&camera, door, 4, &out), ENF_PROJECT_PARENT);
            assert_true(is_parent(out));
        }
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(tolerances_fit_together),          cmocka_unit_test(distance_is_that_of_the_polygon),
    cmocka_unit_test(near_polygons_pass_the_parent),    cmocka_unit_test(the_next_room_stays_while_walking_in),
    cmocka_unit_test(openings_of_one_plane_stay_apart), cmocka_unit_test(a_step_beyond_the_plane_is_still_inside),
};

ENF_TEST_MAIN(tests)
