/* The traversal's rules one by one, on a handful of rooms: closed, moved and bent portals, overlap links, leaking cells, an eye
 * outside, mirrors and teleports, limits that list more. Each names the pitfall whose remedy it is. */
#include "harness/harness.h"
#include "scenes/maker.h"

#include <enfilade/tolerances.h>
#include <enfilade/vis.h>

#include <string.h>

enum { ROOMS = 4 };

/* A row of rooms of 4 m along +x with doors of 1 × 2 m in one line: a small enfilade. */
typedef struct Row {
    EnfMaker *maker;
    const EnfMap *map;
    EnfPortals portals;
    EnfVis *vis;
    uint32_t doors[ROOMS - 1];
} Row;

static void add_rooms(Row *row, uint32_t flags) {
    static const char *const names[ROOMS] = {"a-room", "b-room", "c-room", "d-room"};
    row->maker = enf_maker_create();
    assert_non_null(row->maker);
    for (uint32_t i = 0; i < ROOMS; i++) {
        uint32_t cell = 0;
        double x = 4.0 * i;
        EnfCell *record = enf_maker_cell(row->maker, names[i], enf_v3(x, 0.0, 0.0), &cell);
        record->flags = i == 0 ? flags : 0;
        EnfBox3 box = {{x, 0, 0}, {x + 4.0, 3, 4}};
        enf_maker_group(row->maker);
        enf_maker_box(row->maker, cell, 0, box, true);
    }
}

static void add_doors(Row *row) {
    for (uint32_t i = 0; i + 1 < ROOMS; i++) {
        double x = 4.0 * (i + 1);
        const EnfVec3 points[4] = {{x, 0, 1.5}, {x, 2, 1.5}, {x, 2, 2.5}, {x, 0, 2.5}};
        row->doors[i] = enf_maker_portal(row->maker, "door-portal", i, i + 1, points, 4, 0);
    }
}

static void finish(Row *row) {
    EnfError error = {ENF_OK, 0, "", ""};
    row->map = enf_maker_finish(row->maker, &error);
    if (row->map == NULL) {
        fail_msg("%s", error.message);
        return;
    }
    assert_int_equal(enf_portals_create(&row->portals, row->map, NULL, &error), ENF_OK);
    assert_int_equal(enf_vis_create(&row->vis, row->map, NULL, &error), ENF_OK);
}

static void open_row(Row *row) {
    memset(row, 0, sizeof *row);
    add_rooms(row, 0);
    add_doors(row);
    finish(row);
}

static void close_row(Row *row) {
    enf_vis_destroy(row->vis);
    enf_portals_destroy(&row->portals);
    enf_maker_destroy(row->maker);
}

/* From room a, looking along the doors (yaw -90 is +x). */
static EnfView along_the_doors(void) {
    EnfView view = enf_view_default();
    view.camera = enf_camera(enf_v3(1.0, 1.0, 2.0), enf_turn(-90.0, 0.0, 0.0), 60.0, 640, 480);
    view.cell = 0;
    return view;
}

static bool sees(const EnfVisSet *set, uint32_t cell) {
    for (uint32_t i = 0; i < set->cell_count; i++) {
        if (set->cells[i] == cell) {
            return true;
        }
    }
    return false;
}

static const EnfVisSet *look(Row *row, const EnfView *view) {
    return enf_vis_run(row->vis, &row->portals, view);
}

static void test_an_enfilade_is_seen_to_its_end(void **state) {
    (void)state;
    Row row;
    open_row(&row);
    EnfView view = along_the_doors();
    for (int cull = ENF_CULL_SEQUENCES; cull <= ENF_CULL_WORKLIST; cull++) {
        for (int window = 0; window < 2; window++) {
            view.cull = (EnfCull)cull;
            view.window = (EnfWindowMode)window;
            const EnfVisSet *set = look(&row, &view);
            assert_int_equal(set->cell_count, ROOMS);
            assert_int_equal(set->visit_count, ROOMS);
            for (uint32_t v = 1; v < set->visit_count; v++) { /* windows nest */
                assert_true(enf_window_contains(set->visits[set->visits[v].parent].window, set->visits[v].window));
                assert_int_equal(set->visits[v].polygon != ENF_NONE, window == 1);
            }
        }
    }
    view.camera = enf_camera(enf_v3(1.0, 1.0, 2.0), enf_turn(90.0, 0.0, 0.0), 60.0, 640, 480); /* looking at the wall */
    assert_int_equal(look(&row, &view)->cell_count, 1);
    close_row(&row);
}

/* PITFALLS 7: no depth hides a room, however many doors stand in one line. */
static void test_no_depth_hides_a_room(void **state) {
    (void)state;
    enum { MANY = 64 };
    Row row;
    memset(&row, 0, sizeof row);
    row.maker = enf_maker_create();
    assert_non_null(row.maker);
    for (uint32_t i = 0; i < MANY; i++) {
        uint32_t cell = 0;
        double x = 0.5 * i;
        (void)enf_maker_cell(row.maker, "room", enf_v3(x, 0.0, 0.0), &cell);
        EnfBox3 box = {{x, 0, 0}, {x + 0.5, 3, 4}};
        enf_maker_group(row.maker);
        enf_maker_box(row.maker, cell, 0, box, true);
        const EnfVec3 points[4] = {{x, 0, 1}, {x, 2, 1}, {x, 2, 3}, {x, 0, 3}};
        if (i > 0) {
            (void)enf_maker_portal(row.maker, "door", i - 1, i, points, 4, 0);
        }
    }
    finish(&row);
    EnfView view = along_the_doors();
    view.camera = enf_camera(enf_v3(0.25, 1.0, 2.0), enf_turn(-90.0, 0.0, 0.0), 60.0, 640, 480);
    for (int cull = ENF_CULL_SEQUENCES; cull <= ENF_CULL_WORKLIST; cull++) {
        view.cull = (EnfCull)cull;
        const EnfVisSet *set = look(&row, &view);
        assert_int_equal(set->cell_count, MANY);
        assert_int_equal(set->visit_count, MANY);
    }
    close_row(&row);
}

/* PITFALLS 10: closing stops the traversal, not the drawing of what stands before the door. */
static void test_closed_doors_stop_the_eye(void **state) {
    (void)state;
    Row row;
    open_row(&row);
    EnfView view = along_the_doors();
    uint32_t half = enf_maker_half(row.maker, row.doors[1], 0);
    enf_portals_set_open(&row.portals, half, false);
    const EnfVisSet *set = look(&row, &view);
    assert_int_equal(set->cell_count, 2);
    assert_true(sees(set, 0) && sees(set, 1));
    enf_portals_set_open(&row.portals, half, true);
    assert_int_equal(look(&row, &view)->cell_count, ROOMS);
    close_row(&row);
}

static void test_moved_doors_are_seen_where_they_are(void **state) {
    (void)state;
    Row row;
    open_row(&row);
    EnfView view = along_the_doors();
    const EnfVec3 aside[4] = {{4, 0, 3.5}, {4, 0.5, 3.5}, {4, 0.5, 3.75}, {4, 0, 3.75}};
    enf_portals_move(&row.portals, enf_maker_half(row.maker, row.doors[0], 0), aside);
    const EnfVisSet *set = look(&row, &view);
    assert_true(sees(set, 1));
    assert_false(sees(set, 3)); /* the small opening in the corner does not show the far door */
    close_row(&row);
}

/* PITFALLS 3: an eye in the doorway, on the plane, or a hair beyond it without having changed cell, keeps both rooms. */
static void test_the_eye_in_the_doorway(void **state) {
    (void)state;
    Row row;
    open_row(&row);
    static const double beside[] = {-0.007, -1e-9, 0.0, 1e-9, 0.007};
    for (size_t i = 0; i < sizeof beside / sizeof *beside; i++) {
        for (uint32_t cell = 0; cell < 2; cell++) {
            for (double yaw = 0.0; yaw < 360.0; yaw += 15.0) {
                EnfView view = along_the_doors();
                view.camera = enf_camera(enf_v3(4.0 + beside[i], 1.0, 2.0), enf_turn(yaw, 0.0, 0.0), 60.0, 640, 480);
                view.cell = cell;
                const EnfVisSet *set = look(&row, &view);
                assert_true(sees(set, 0) && sees(set, 1));
            }
        }
    }
    close_row(&row);
}

/* PITFALLS 4: two doors in one plane with nothing between; an eye that rounding has put a hair beyond both looks through both, not
 * only through that of its own cell. */
static void test_a_hair_beyond_is_on_neither_side(void **state) {
    (void)state;
    Row row;
    open_row(&row);
    const EnfVec3 here[4] = {{4, 0, 1.5}, {4, 2, 1.5}, {4, 2, 2.5}, {4, 0, 2.5}};
    enf_portals_move(&row.portals, enf_maker_half(row.maker, row.doors[1], 0), here);
    static const double beyond[] = {0.0, 1e-9, 0.5 * ENF_GRID_STEP};
    for (size_t i = 0; i < sizeof beyond / sizeof *beyond; i++) {
        for (int cull = ENF_CULL_SEQUENCES; cull <= ENF_CULL_WORKLIST; cull++) {
            EnfView view = along_the_doors();
            view.camera = enf_camera(enf_v3(4.0 + beyond[i], 1.0, 2.0), enf_turn(-90.0, 0.0, 0.0), 60.0, 640, 480);
            view.cull = (EnfCull)cull;
            const EnfVisSet *set = look(&row, &view);
            assert_true(sees(set, 1) && sees(set, 2));
        }
    }
    close_row(&row);
}

/* PITFALLS 12: an eye in no cell sees what the frustum holds, and the counters say so. */
static void test_an_eye_outside_sees_the_frustum(void **state) {
    (void)state;
    Row row;
    open_row(&row);
    EnfView view = along_the_doors();
    view.cell = ENF_NONE;
    view.camera = enf_camera(enf_v3(-5.0, 1.0, 2.0), enf_turn(-90.0, 0.0, 0.0), 60.0, 640, 480);
    const EnfVisSet *set = look(&row, &view);
    assert_true(set->counters.outside);
    assert_int_equal(set->cell_count, ROOMS);
    close_row(&row);
}

/* PITFALLS 17: who sees into a leaking cell is shown everything in that window. */
static void test_open_cells_hide_nothing(void **state) {
    (void)state;
    Row row;
    memset(&row, 0, sizeof row);
    add_rooms(&row, ENF_CELL_OPEN);
    finish(&row); /* no doors at all */
    EnfView view = along_the_doors();
    const EnfVisSet *set = look(&row, &view);
    assert_true(set->counters.open);
    assert_int_equal(set->cell_count, ROOMS);
    view.cell = 1;
    view.camera = enf_camera(enf_v3(6.0, 1.0, 2.0), enf_turn(-90.0, 0.0, 0.0), 60.0, 640, 480);
    assert_int_equal(look(&row, &view)->cell_count, 1);
    close_row(&row);
}

/* PITFALLS 11: cells that share space pass the whole window on. */
static void test_overlap_links_pass_the_window(void **state) {
    (void)state;
    Row row;
    memset(&row, 0, sizeof row);
    add_rooms(&row, 0);
    (void)enf_maker_portal(row.maker, "overlap", 0, 2, NULL, 0, ENF_PORTAL_OVERLAP);
    finish(&row);
    EnfView view = along_the_doors();
    const EnfVisSet *set = look(&row, &view);
    assert_int_equal(set->cell_count, 2);
    assert_true(sees(set, 0) && sees(set, 2));
    EnfWindow full = enf_window_full(&view.camera);
    assert_memory_equal(&set->visits[1].window, &full, sizeof full);
    close_row(&row);
}

/* ---- transforms ------------------------------------------------------------------------------------------------- */

/* p' = p + t. */
static EnfAffine translation(double x) {
    EnfAffine a = enf_affine_identity();
    a.t = enf_v3(x, 0.0, 0.0);
    return a;
}

/* A door of room a leads into room d, 8 m farther: the camera moves with it, and nothing else knows. */
static void test_a_teleport_moves_the_eye(void **state) {
    (void)state;
    Row row;
    memset(&row, 0, sizeof row);
    add_rooms(&row, 0);
    const EnfVec3 points[4] = {{4, 0, 1.5}, {4, 2, 1.5}, {4, 2, 2.5}, {4, 0, 2.5}};
    EnfAffine there = translation(8.0);
    (void)enf_maker_teleport(row.maker, 0, 3, points, 4, &there, ENF_NONE);
    finish(&row);
    EnfView view = along_the_doors();
    for (int cull = ENF_CULL_SEQUENCES; cull <= ENF_CULL_WORKLIST; cull++) {
        view.cull = (EnfCull)cull;
        const EnfVisSet *set = look(&row, &view);
        assert_int_equal(set->space_count, 2);
        assert_true(set->cameras[1].eye_ws.x == view.camera.eye_ws.x + 8.0);
        assert_true(sees(set, 3) && set->cell_count == 2);
        assert_int_equal(set->entries[set->entry_count - 1].space, 1);
    }
    close_row(&row);
}

/* The plane x = `at` as a mirror. */
static EnfAffine mirror_at(double at) {
    EnfAffine a = enf_affine_identity();
    a.m[0] = -1.0;
    a.t = enf_v3(2.0 * at, 0.0, 0.0);
    return a;
}

static void add_mirror(Row *row, uint32_t cell, double at, bool facing_minus_x) {
    const EnfVec3 points[4] = {{at, 0.5, 1}, {at, 2.5, 1}, {at, 2.5, 3}, {at, 0.5, 3}};
    const EnfVec3 turned[4] = {{at, 0.5, 3}, {at, 2.5, 3}, {at, 2.5, 1}, {at, 0.5, 1}};
    EnfAffine reflection = mirror_at(at);
    (void)enf_maker_teleport(row->maker, cell, cell, facing_minus_x ? points : turned, 4, &reflection, ENF_NONE);
}

/* PITFALLS 20: two mirrors face each other; the traversal ends at its limit of spaces and says so. */
static void test_mirrors_facing_mirrors_end(void **state) {
    (void)state;
    Row row;
    memset(&row, 0, sizeof row);
    add_rooms(&row, 0);
    add_mirror(&row, 0, 4.0 - 1.0 / 64.0, true);
    add_mirror(&row, 0, 1.0 / 64.0, false);
    finish(&row);
    EnfView view = along_the_doors();
    for (int cull = ENF_CULL_SEQUENCES; cull <= ENF_CULL_WORKLIST; cull++) {
        view.cull = (EnfCull)cull;
        const EnfVisSet *set = look(&row, &view);
        assert_in_range(set->space_count, 3, ENF_VIS_SPACES_MAX);
        EnfVec3 e = set->cameras[1].eye_ws;
        assert_true(e.x == 2.0 * (4.0 - 1.0 / 64.0) - 1.0 && e.y == 1.0 && e.z == 2.0);
        assert_true(set->cameras[1].right.z == view.camera.right.z && set->cameras[1].forward.x == -view.camera.forward.x);
        assert_true(set->entries[0].space == 0);
    }
    close_row(&row);
}

/* ---- limits ----------------------------------------------------------------------------------------------------- */

/* A traversal that may not finish lists the frustum: more, never less. */
static void test_limits_list_more(void **state) {
    (void)state;
    Row row;
    open_row(&row);
    EnfView view = along_the_doors();
    uint32_t whole = look(&row, &view)->entry_count;
    for (int cull = ENF_CULL_SEQUENCES; cull <= ENF_CULL_WORKLIST; cull++) {
        view.cull = (EnfCull)cull;
        view.max_steps = 1;
        const EnfVisSet *set = look(&row, &view);
        assert_true(set->counters.fell_back);
        assert_true(set->entry_count >= whole);
    }
    close_row(&row);
}

static void test_primitives_name_every_visit(void **state) {
    (void)state;
    Row row;
    open_row(&row);
    EnfView view = along_the_doors();
    view.grain = ENF_GRAIN_PRIMITIVES;
    const EnfVisSet *set = look(&row, &view);
    for (uint32_t i = 0; i < set->entry_count; i++) {
        assert_in_range(set->entries[i].visit, 0, set->visit_count - 1);
        assert_true(i == 0 || set->entries[i - 1].cluster < set->entries[i].cluster ||
                    set->entries[i - 1].visit < set->entries[i].visit);
    }
    close_row(&row);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_an_enfilade_is_seen_to_its_end),      cmocka_unit_test(test_closed_doors_stop_the_eye),
    cmocka_unit_test(test_moved_doors_are_seen_where_they_are), cmocka_unit_test(test_the_eye_in_the_doorway),
    cmocka_unit_test(test_an_eye_outside_sees_the_frustum),     cmocka_unit_test(test_open_cells_hide_nothing),
    cmocka_unit_test(test_overlap_links_pass_the_window),       cmocka_unit_test(test_a_teleport_moves_the_eye),
    cmocka_unit_test(test_mirrors_facing_mirrors_end),          cmocka_unit_test(test_limits_list_more),
    cmocka_unit_test(test_primitives_name_every_visit),         cmocka_unit_test(test_no_depth_hides_a_room),
    cmocka_unit_test(test_a_hair_beyond_is_on_neither_side),
};

ENF_TEST_MAIN(tests)
