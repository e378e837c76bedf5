/* Cells and portals out of names and extras: what is recognised, what is mended, and that each diagnosis names its node. */
#include "harness/layout_check.h"

#include "compile/names.h"

/* ---- names ----------------------------------------------------------------------------------------------------------------- */

static void suffixes_are_recognised(void **state) {
    (void)state;
    static const struct {
        const char *name;
        EnfSuffix suffix;
        size_t base, target;
    } cases[] = {
        {"hall-room", ENF_SUFFIX_ROOM, 4, 4},
        {"hall_ROOM", ENF_SUFFIX_ROOM, 4, 4},
        {"hall-room.001", ENF_SUFFIX_ROOM, 4, 4},
        {"hall*2-portal", ENF_SUFFIX_PORTAL, 6, 4},
        {"*-portal.012", ENF_SUFFIX_PORTAL, 1, 0},
        {"a_b-Portal", ENF_SUFFIX_PORTAL, 3, 3},
        {"floor1-roomgroup", ENF_SUFFIX_ROOMGROUP, 6, 6},
        {"x-bound", ENF_SUFFIX_BOUND, 1, 1},
        {"x-col", ENF_SUFFIX_COL, 1, 1},
        {"x-colonly", ENF_SUFFIX_COLONLY, 1, 1},
        {"x-noimp", ENF_SUFFIX_NOIMP, 1, 1},
        {"room", ENF_SUFFIX_NONE, 4, 4},
        {"bathroom", ENF_SUFFIX_NONE, 8, 8},
        {"hall-room.old", ENF_SUFFIX_NONE, 13, 13},
        {"-portal", ENF_SUFFIX_PORTAL, 0, 0},
        {"", ENF_SUFFIX_NONE, 0, 0},
        {".001", ENF_SUFFIX_NONE, 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        EnfNodeName name = enf_node_name(cases[i].name);
        assert_int_equal(name.suffix, cases[i].suffix);
        assert_int_equal(name.base, cases[i].base);
        assert_int_equal(name.target, cases[i].target);
        assert_int_equal(name.suspect, ENF_SUFFIX_NONE);
    }
}

static void misspelt_suffixes_are_suspected(void **state) {
    (void)state;
    static const char *const portal[] = {"a-portl", "a-protal", "a-porta", "a_portals", "a-potral", "a-prtal"};
    static const char *const room[] = {"a-romo", "a-rom", "a-rooom", "a-oom"};
    static const char *const innocent[] = {"thatched-roof", "front_door", "north_round", "square-root", "oak_total",
                                           "c0001_geo",     "a-b",        "prop_12",     "lamp",        "gold_metal"};
    for (size_t i = 0; i < sizeof portal / sizeof portal[0]; i++) {
        assert_int_equal(enf_node_name(portal[i]).suspect, ENF_SUFFIX_PORTAL);
    }
    for (size_t i = 0; i < sizeof room / sizeof room[0]; i++) {
        assert_int_equal(enf_node_name(room[i]).suspect, ENF_SUFFIX_ROOM);
    }
    for (size_t i = 0; i < sizeof innocent / sizeof innocent[0]; i++) {
        assert_int_equal(enf_node_name(innocent[i]).suspect, ENF_SUFFIX_NONE);
    }
    assert_int_equal(enf_edit_distance("portal", 6, "Portal", 6, 2), 0);
    assert_int_equal(enf_edit_distance("ab", 2, "ba", 2, 2), 1);
    assert_int_equal(enf_edit_distance("abc", 3, "", 0, 2), 3);
}

static void near_miss_is_warned(void **state) {
    (void)state;
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    level_portal(level, "right*1-portal", left, door_box, true);
    level_node(level, "cellar-romo", ENF_NONE);
    Built built = build(level);
    assert_one_door(&built);
    assert_only(&built, ENF_DIAGNOSIS_SUFFIX_NEAR_MISS, "cellar-romo");
    done(&built, level);
}

/* ---- cells ----------------------------------------------------------------------------------------------------------------- */

static void children_belong_to_their_room(void **state) {
    (void)state;
    Level *level = level_new();
    uint32_t group = level_node(level, "all-roomgroup", ENF_NONE);
    uint32_t hall = level_node(level, "hall-room", group);
    level_faces(level, "walls", hall, left_box, 0);
    uint32_t table = level_block(level, "table", hall, level_box(1, 0, 1, 2, 1, 2));
    uint32_t cup = level_block(level, "cup", table, level_box(1.25, 1, 1.25, 1.5, 1.25, 1.5));
    uint32_t booth = level_node(level, "booth-room", hall);
    level_faces(level, "walls", booth, level_box(2.5, 0, 2.5, 3.5, 2, 3.5), 0);
    uint32_t hint = level_block(level, "hint-colonly", hall, level_box(1, 0, 3, 2, 1, 4));
    uint32_t sketch = level_node(level, "sketch-noimp", hall);
    uint32_t lines = level_block(level, "lines", sketch, level_box(0, 0, 0, 1, 1, 1));
    uint32_t tree = level_block(level, "tree", ENF_NONE, level_box(20, 0, 20, 21, 5, 21));
    level_extras(level, booth, "{\"priority\": 7}");
    Built built = build(level);
    const EnfLayout *layout = &built.layout;
    assert_int_equal(layout->cell_count, 2);
    assert_int_equal(layout->node_cells[cup], 0);
    assert_int_equal(layout->node_cells[booth], 1);
    assert_int_equal(layout->cells[1].parent, 0);
    assert_int_equal(layout->cells[1].priority, 7);
    assert_int_equal(layout->node_cells[tree], ENF_NONE);
    assert_int_equal(layout->roles[hint], ENF_ROLE_COLLISION);
    assert_int_equal(layout->roles[lines], ENF_ROLE_IGNORED);
    assert_int_equal(layout->roles[table], ENF_ROLE_GEOMETRY);
    assert_int_equal(layout->roles[group], ENF_ROLE_MARKER);
    assert_true(layout->cells[0].origin.x % 16 == 0 && layout->cells[0].origin.y == 3 * 4096 / 2);
    /* The booth has no portal, so it is shown with the hall. */
    assert_only(&built, ENF_DIAGNOSIS_ROOM_OVERLAP, "booth-room");
    assert_int_equal(layout->portal_count, 2);
    assert_int_equal(layout->portals[0].flags, ENF_PORTAL_OVERLAP);
    assert_int_equal(layout->portals[0].point_count, 0);
    done(&built, level);
}

static void bound_becomes_planes(void **state) {
    (void)state;
    Level *level = level_new();
    uint32_t hall = level_room(level, "hall-room", left_box);
    level_block(level, "hull-bound", hall, level_box(-0.5, -0.5, -0.5, 4.5, 3.5, 5.5));
    Built built = build(level);
    const EnfLayoutCell *cell = &built.layout.cells[0];
    assert_quiet(&built);
    assert_int_equal(cell->bound_count, 6);
    for (uint32_t i = 0; i < 6; i++) {
        EnfPlane plane = built.layout.bound_planes[cell->bound_first + i];
        assert_true(enf_dot(plane.n, enf_v3(2, 1, 2)) + plane.d < 0.0);
        assert_true(enf_dot(plane.n, enf_v3(2, 1, 2)) + plane.d < -1.4);
    }
    assert_int_equal(cell->min.x, -2048);
    done(&built, level);
}

static void dented_bound_is_warned(void **state) {
    (void)state;
    Level *level = level_new();
    uint32_t hall = level_room(level, "hall-room", left_box);
    uint32_t bound = level_block(level, "hull-bound", hall, left_box);
    EnfVec3 dent[3] = {{2, 1, 2}, {4, 1, 2}, {2, 1, 4}};
    level_triangle(level, bound, dent[0], dent[1], dent[2], 0);
    Built built = build(level);
    assert_only(&built, ENF_DIAGNOSIS_UNSUPPORTED, "hull-bound");
    assert_int_equal(built.layout.cells[0].bound_count, 6);
    done(&built, level);
}

static void level_without_rooms_is_one_cell(void **state) {
    (void)state;
    Level *level = level_new();
    level_block(level, "block", ENF_NONE, left_box);
    level_portal(level, "x-portal", ENF_NONE, door_box, true);
    Built built = build(level);
    assert_int_equal(built.layout.cell_count, 1);
    assert_int_equal(built.layout.node_cells[0], 0);
    assert_int_equal(found(&built, ENF_DIAGNOSIS_NO_ROOMS, NULL), 1);
    assert_int_equal(found(&built, ENF_DIAGNOSIS_PORTAL_OUTSIDE_ROOM, "x-portal"), 1);
    done(&built, level);
}

static void level_without_triangles_is_refused(void **state) {
    (void)state;
    Level *level = level_new();
    level_node(level, "hall-room", ENF_NONE);
    Built built = build(level);
    assert_int_equal(built.result, ENF_ERROR_LEVEL);
    assert_int_equal(found(&built, ENF_DIAGNOSIS_NO_GEOMETRY, NULL), 1);
    done(&built, level);
}

static void oversized_room_is_refused(void **state) {
    (void)state;
    Level *level = level_new();
    level_room(level, "hall-room", level_box(0, 0, 0, 3e5, 3, 5));
    Built built = build(level);
    assert_int_equal(built.result, ENF_ERROR_LEVEL);
    assert_int_equal(found(&built, ENF_DIAGNOSIS_TOO_LARGE, "hall-room"), 1);
    done(&built, level);
}

/* What Blender leaves out unless told otherwise is named, with the box to tick. */
static void missing_extras_and_lights_are_remarked(void **state) {
    (void)state;
    Level *level = level_new();
    level_room(level, "hall-room", left_box);
    level->source.has_extras = level->source.has_lights = false;
    level->source.generator = "Khronos glTF Blender I/O v3.6.27";
    Built built = build(level);
    assert_int_equal(found(&built, ENF_DIAGNOSIS_NO_EXTRAS, NULL), 1);
    assert_int_equal(found(&built, ENF_DIAGNOSIS_NO_LIGHTS, NULL), 1);
    assert_int_equal(built.diagnosis.count, 2);
    assert_non_null(strstr(built.diagnosis.findings[0].message, "Custom Properties"));
    assert_non_null(strstr(built.diagnosis.findings[1].message, "Punctual Lights"));
    done(&built, level);
}

static void empty_and_equal_rooms_are_warned(void **state) {
    (void)state;
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    level_portal(level, "right-portal", left, door_box, true);
    level_node(level, "void-room", ENF_NONE);
    level_room(level, "right-room", level_box(20, 0, 0, 22, 2, 2));
    Built built = build(level);
    assert_int_equal(found(&built, ENF_DIAGNOSIS_ROOM_EMPTY, "void-room"), 1);
    assert_int_equal(found(&built, ENF_DIAGNOSIS_ROOM_DUPLICATE, "right-room"), 1);
    assert_int_equal(built.diagnosis.count, 2);
    assert_int_equal(built.layout.cell_count, 4);
    assert_int_equal(built.layout.portals[0].target, 1); /* the nearer of the two */
    done(&built, level);
}

/* ---- portals --------------------------------------------------------------------------------------------------------------- */

/* Every way of naming the target gives the same two half-portals. */
static void targets_are_found_by_name(void **state) {
    (void)state;
    static const struct {
        const char *name, *extras;
    } cases[] = {{"right*1-portal", ""},
                 {"right-portal", ""},
                 {"RIGHT_portal.003", ""},
                 {"door-portal", "{\"portal_to\": \"right\"}"},
                 {"door-portal", "{\"to\": \"right-room\"}"},
                 {"left-portal", "{\"portal_to\": \"Right\"}"},
                 {"*-portal", ""},
                 {"door-portal", ""},
                 {"opening", "{\"portal_to\": \"right\", \"unknown\": [1, {}]}"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        uint32_t left, right;
        Level *level = two_rooms(&left, &right);
        level_extras(level, level_portal(level, cases[i].name, left, door_box, true), cases[i].extras);
        Built built = build(level);
        assert_quiet(&built);
        assert_one_door(&built);
        done(&built, level);
    }
}

static void portal_given_on_both_sides_is_one(void **state) {
    (void)state;
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    EnfBox3 moved = {{4.01, 0.01, 1}, {4.01, 2, 1.99}};
    level_portal(level, "right-portal", left, door_box, true);
    level_portal(level, "left-portal", right, moved, false);
    Built built = build(level);
    assert_quiet(&built);
    assert_one_door(&built);
    assert_string_equal(built.layout.portals[0].name, "right-portal");
    assert_string_equal(built.layout.portals[1].name, "left-portal");
    done(&built, level);
}

static void one_way_and_closed_are_obeyed(void **state) {
    (void)state;
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    level_extras(level, level_portal(level, "right-portal", left, door_box, true), "{\"two_way\": false, \"active\": 0}");
    Built built = build(level);
    assert_quiet(&built);
    assert_int_equal(built.layout.portal_count, 1);
    assert_int_equal(built.layout.portals[0].twin, ENF_NONE);
    assert_int_equal(built.layout.portals[0].flags, ENF_PORTAL_CLOSED);
    done(&built, level);
}

static void flipped_portal_is_turned(void **state) {
    (void)state;
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    level_portal(level, "right*1-portal", left, door_box, false);
    Built built = build(level);
    assert_only(&built, ENF_DIAGNOSIS_PORTAL_FLIPPED, "right*1-portal");
    assert_one_door(&built);
    done(&built, level);
}

static void doubled_portal_is_left_out(void **state) {
    (void)state;
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    level_portal(level, "right*1-portal", left, door_box, true);
    level_portal(level, "right*2-portal", left, door_box, true);
    Built built = build(level);
    assert_only(&built, ENF_DIAGNOSIS_PORTAL_DOUBLED, "right*2-portal");
    assert_one_door(&built);
    done(&built, level);
}

static void missing_target_is_linked_or_left_out(void **state) {
    (void)state;
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    level_portal(level, "nowhere*1-portal", left, door_box, true);
    Built built = build(level);
    assert_only(&built, ENF_DIAGNOSIS_PORTAL_NO_TARGET, "nowhere*1-portal");
    assert_one_door(&built);
    done(&built, level);

    level = two_rooms(&left, &right);
    level_portal(level, "right*1-portal", left, door_box, true);
    level_portal(level, "nowhere*1-portal", left, level_box(0, 0, 1, 0, 2, 2), false);
    built = build(level);
    assert_only(&built, ENF_DIAGNOSIS_PORTAL_NO_TARGET, "nowhere*1-portal");
    assert_one_door(&built);
    assert_int_equal(built.layout.cells[0].flags, ENF_CELL_OPEN);
    done(&built, level);
}

static void portal_to_itself_is_left_out(void **state) {
    (void)state;
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    level_portal(level, "right-portal", left, door_box, true);
    level_portal(level, "left*1-portal", left, level_box(0, 0, 1, 0, 2, 2), false);
    Built built = build(level);
    assert_only(&built, ENF_DIAGNOSIS_PORTAL_SELF, "left*1-portal");
    assert_one_door(&built);
    done(&built, level);
}

static void portal_far_from_its_room_is_warned(void **state) {
    (void)state;
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    level_portal(level, "right-portal", left, level_box(4, 8, 1, 4, 10, 2), true);
    Built built = build(level);
    assert_only(&built, ENF_DIAGNOSIS_PORTAL_FAR, "right-portal");
    assert_int_equal(built.layout.portal_count, 2);
    done(&built, level);
}

static void loose_portal_joins_what_lies_beside_it(void **state) {
    (void)state;
    static const char *const names[] = {"door-portal", "right-portal", "*-portal"};
    for (int i = 0; i < 6; i++) {
        uint32_t left, right;
        Level *level = two_rooms(&left, &right);
        level_portal(level, names[i / 2], ENF_NONE, door_box, i % 2 == 0);
        Built built = build(level);
        assert_int_equal(found(&built, ENF_DIAGNOSIS_PORTAL_OUTSIDE_ROOM, NULL), 0);
        assert_int_equal(built.layout.portal_count, 2);
        assert_pair(&built.layout, 0);
        assert_true(normal_of(&built.layout, 0).x > 0.99); /* of the left room's half, whichever was given */
        done(&built, level);
    }
}

static void portal_in_no_room_is_left_out(void **state) {
    (void)state;
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    level_portal(level, "right-portal", left, door_box, true);
    level_portal(level, "gate-portal", ENF_NONE, level_box(50, 0, 1, 50, 2, 2), true);
    Built built = build(level);
    assert_only(&built, ENF_DIAGNOSIS_PORTAL_OUTSIDE_ROOM, "gate-portal");
    assert_one_door(&built);
    done(&built, level);
}

static void faces_of_portal_material_are_portals(void **state) {
    (void)state;
    for (int loose = 0; loose < 2; loose++) {
        uint32_t left, right;
        Level *level = two_rooms(&left, &right);
        uint32_t node = level_node(level, "doorway", loose ? ENF_NONE : right);
        level_rectangle(level, node, door_box, true, 1);
        Built built = build(level);
        assert_quiet(&built);
        assert_int_equal(built.layout.portal_count, 2);
        assert_pair(&built.layout, 0);
        assert_true(normal_of(&built.layout, 0).x > 0.99);
        done(&built, level);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(suffixes_are_recognised),
    cmocka_unit_test(misspelt_suffixes_are_suspected),
    cmocka_unit_test(near_miss_is_warned),
    cmocka_unit_test(children_belong_to_their_room),
    cmocka_unit_test(bound_becomes_planes),
    cmocka_unit_test(dented_bound_is_warned),
    cmocka_unit_test(level_without_rooms_is_one_cell),
    cmocka_unit_test(level_without_triangles_is_refused),
    cmocka_unit_test(oversized_room_is_refused),
    cmocka_unit_test(missing_extras_and_lights_are_remarked),
    cmocka_unit_test(empty_and_equal_rooms_are_warned),
    cmocka_unit_test(targets_are_found_by_name),
    cmocka_unit_test(portal_given_on_both_sides_is_one),
    cmocka_unit_test(one_way_and_closed_are_obeyed),
    cmocka_unit_test(flipped_portal_is_turned),
    cmocka_unit_test(doubled_portal_is_left_out),
    cmocka_unit_test(missing_target_is_linked_or_left_out),
    cmocka_unit_test(portal_to_itself_is_left_out),
    cmocka_unit_test(portal_far_from_its_room_is_warned),
    cmocka_unit_test(loose_portal_joins_what_lies_beside_it),
    cmocka_unit_test(portal_in_no_room_is_left_out),
    cmocka_unit_test(faces_of_portal_material_are_portals),
};

ENF_TEST_MAIN(tests)
