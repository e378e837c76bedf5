/* Cells and portals out of names, extras and meshes: what is recognised, what is mended, and that each diagnosis names its node. */
#include "harness/harness.h"

#include "compile/layout.h"
#include "compile/names.h"
#include "harness/level.h"

#include <cjson/cJSON.h>

typedef struct Built {
    EnfLayout layout;
    EnfDiagnosis diagnosis;
    EnfResult result;
} Built;

static Built build(const Level *level) {
    Built built = {.result = ENF_OK};
    EnfCompileSettings settings = enf_compile_settings_default();
    EnfError error = {0};
    built.result = enf_layout_build(&built.layout, &level->source, &settings, &built.diagnosis, &error);
    assert_true(built.result == ENF_OK || error.message[0] != '\0');
    return built;
}

static void done(Built *built, Level *level) {
    enf_layout_free(&built->layout);
    enf_diagnosis_free(&built->diagnosis);
    level_free(level);
}

/* How many findings have this code and name this node (any, if NULL). */
static uint32_t found(const Built *built, EnfDiagnosisCode code, const char *node) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < built->diagnosis.count; i++) {
        const EnfFinding *finding = &built->diagnosis.findings[i];
        count += finding->code == code && (node == NULL || strcmp(finding->node, node) == 0);
    }
    return count;
}

/* One finding with this code and node, and nothing else. */
static void assert_only(const Built *built, EnfDiagnosisCode code, const char *node) {
    for (uint32_t i = 0; i < built->diagnosis.count; i++) {
        const EnfFinding *finding = &built->diagnosis.findings[i];
        if (finding->code != code || strcmp(finding->node, node) != 0) {
            print_message("unexpected: %s [%s] %s\n", enf_diagnosis_text(finding->code), finding->node, finding->message);
        }
    }
    assert_int_equal(found(built, code, node), 1);
    assert_int_equal(built->diagnosis.count, 1);
}

static void assert_quiet(const Built *built) {
    for (uint32_t i = 0; i < built->diagnosis.count; i++) {
        const EnfFinding *finding = &built->diagnosis.findings[i];
        print_message("unexpected: %s [%s] %s\n", enf_diagnosis_text(finding->code), finding->node, finding->message);
    }
    assert_int_equal(built->diagnosis.count, 0);
}

/* Two rooms side by side along x, a door between them at x = 4. */
static const EnfBox3 left_box = {{0, 0, 0}, {4, 3, 5}}, right_box = {{4, 0, 0}, {9, 3, 5}}, door_box = {{4, 0, 1}, {4, 2, 2}};

static Level *two_rooms(uint32_t *left, uint32_t *right) {
    Level *level = level_new();
    level_hole(level, door_box);
    *left = level_room(level, "left-room", left_box);
    *right = level_room(level, "right-room", right_box);
    return level;
}

/* The two half-portals of one opening lead there and back over bit-equal points. */
static void assert_pair(const EnfLayout *layout, uint32_t i) {
    const EnfLayoutPortal *portal = &layout->portals[i];
    assert_true(portal->twin < layout->portal_count);
    const EnfLayoutPortal *twin = &layout->portals[portal->twin];
    assert_int_equal(twin->twin, i);
    assert_int_equal(twin->source, portal->target);
    assert_int_equal(twin->target, portal->source);
    assert_int_equal(twin->point_count, portal->point_count);
    for (uint32_t k = 0; k < portal->point_count; k++) {
        assert_memory_equal(&layout->points[portal->point_first + k],
                            &layout->points[twin->point_first + portal->point_count - 1 - k], sizeof(EnfGrid3));
    }
}

static EnfVec3 normal_of(const EnfLayout *layout, uint32_t i) {
    EnfVec3 points[ENF_POLYGON_MAX];
    for (uint32_t k = 0; k < layout->portals[i].point_count; k++) {
        points[k] = enf_grid_point(layout->points[layout->portals[i].point_first + k]);
    }
    return enf_plane_from_polygon(points, layout->portals[i].point_count).n;
}

/* The level of two_rooms with one door, as it should come out. */
static void assert_one_door(const Built *built) {
    const EnfLayout *layout = &built->layout;
    assert_int_equal(built->result, ENF_OK);
    assert_int_equal(layout->cell_count, 2);
    assert_int_equal(layout->portal_count, 2);
    assert_int_equal(layout->portals[0].source, 0);
    assert_int_equal(layout->portals[0].target, 1);
    assert_pair(layout, 0);
    assert_true(normal_of(layout, 0).x > 0.99);
    assert_true(normal_of(layout, 1).x < -0.99);
}

/* ---- names ----------------------------------------------------------------------------------------------------------------- */

static void suffixes_are_recognised(void **state) {
    (void)state;
    static const struct {
        const char *name;
        EnfSuffix suffix;
        size_t base, target;
    } cases[] = {
        {"hall-room", ENF_SUFFIX_ROOM, 4, 4},          {"hall_ROOM", ENF_SUFFIX_ROOM, 4, 4},
        {"hall-room.001", ENF_SUFFIX_ROOM, 4, 4},      {"hall*2-portal", ENF_SUFFIX_PORTAL, 6, 4},
        {"*-portal.012", ENF_SUFFIX_PORTAL, 1, 0},     {"a_b-Portal", ENF_SUFFIX_PORTAL, 3, 3},
        {"floor1-roomgroup", ENF_SUFFIX_ROOMGROUP, 6, 6}, {"x-bound", ENF_SUFFIX_BOUND, 1, 1},
        {"x-col", ENF_SUFFIX_COL, 1, 1},               {"x-colonly", ENF_SUFFIX_COLONLY, 1, 1},
        {"x-noimp", ENF_SUFFIX_NOIMP, 1, 1},           {"room", ENF_SUFFIX_NONE, 4, 4},
        {"bathroom", ENF_SUFFIX_NONE, 8, 8},           {"hall-room.old", ENF_SUFFIX_NONE, 13, 13},
        {"-portal", ENF_SUFFIX_PORTAL, 0, 0},          {"", ENF_SUFFIX_NONE, 0, 0},
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
    } cases[] = {{"right*1-portal", ""},      {"right-portal", ""},
                 {"RIGHT_portal.003", ""},    {"door-portal", "{\"portal_to\": \"right\"}"},
                 {"door-portal", "{\"to\": \"right-room\"}"}, {"left-portal", "{\"portal_to\": \"Right\"}"},
                 {"*-portal", ""},            {"door-portal", ""},
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
        const double u[2] = {0, 2}, v[2] = {1, 2};
        level_rectangle(level, node, 0, 4.0, u, v, true, 1);
        Built built = build(level);
        assert_quiet(&built);
        assert_int_equal(built.layout.portal_count, 2);
        assert_pair(&built.layout, 0);
        assert_true(normal_of(&built.layout, 0).x > 0.99);
        done(&built, level);
    }
}

/* ---- shapes ---------------------------------------------------------------------------------------------------------------- */

static uint32_t shape(Level *level, const char *name, uint32_t parent, const EnfVec3 *points, const uint32_t (*triangles)[3],
                      uint32_t count) {
    uint32_t node = level_node(level, name, parent);
    for (uint32_t i = 0; i < count; i++) {
        level_triangle(level, node, points[triangles[i][0]], points[triangles[i][1]], points[triangles[i][2]], 0);
    }
    return node;
}

static double total_area(const EnfLayout *layout, uint32_t source) {
    double area = 0.0;
    for (uint32_t i = 0; i < layout->portal_count; i++) {
        EnfVec3 sum = {0}, first = enf_grid_point(layout->points[layout->portals[i].point_first]);
        for (uint32_t k = 1; k + 1 < layout->portals[i].point_count; k++) {
            EnfVec3 a = enf_sub(enf_grid_point(layout->points[layout->portals[i].point_first + k]), first);
            EnfVec3 b = enf_sub(enf_grid_point(layout->points[layout->portals[i].point_first + k + 1]), first);
            sum = enf_add(sum, enf_cross(a, b));
        }
        area += layout->portals[i].source == source ? enf_length(sum) / 2.0 : 0.0;
    }
    return area;
}

static void concave_portal_is_split(void **state) {
    (void)state;
    static const EnfVec3 points[6] = {{4, 0, 1}, {4, 2, 1}, {4, 2, 2}, {4, 1, 2}, {4, 1, 3}, {4, 0, 3}};
    static const uint32_t triangles[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    shape(level, "right*L-portal", left, points, triangles, 4);
    Built built = build(level);
    assert_only(&built, ENF_DIAGNOSIS_PORTAL_CONCAVE, "right*L-portal");
    assert_int_equal(built.layout.portal_count, 4); /* two convex pieces, both ways */
    assert_true(total_area(&built.layout, 0) > 2.9999 && total_area(&built.layout, 0) < 3.0001);
    for (uint32_t i = 0; i < 4; i++) {
        assert_pair(&built.layout, i);
    }
    done(&built, level);
}

static void bent_portal_is_flat_pieces(void **state) {
    (void)state;
    static const EnfVec3 points[4] = {{4, 0, 1}, {4, 2, 1}, {4.2, 2, 2}, {4, 0, 2}};
    static const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    shape(level, "right*1-portal", left, points, triangles, 2);
    Built built = build(level);
    assert_only(&built, ENF_DIAGNOSIS_PORTAL_OFF_PLANE, "right*1-portal");
    assert_int_equal(built.layout.portal_count, 4);
    for (uint32_t i = 0; i < 4; i++) {
        assert_int_equal(built.layout.portals[i].flags, ENF_PORTAL_NONPLANAR);
        assert_int_equal(built.layout.portals[i].point_count, 3);
    }
    done(&built, level);
}

static void degenerate_portal_is_left_out(void **state) {
    (void)state;
    static const EnfVec3 points[4] = {{4, 0, 1}, {4, 2, 1}, {4, 1, 1}, {4, 1, 1.0001}};
    static const uint32_t line[1][3] = {{0, 1, 2}}, sliver[1][3] = {{0, 1, 3}};
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    level_portal(level, "right-portal", left, door_box, true);
    shape(level, "right*1-portal", left, points, line, 1);
    shape(level, "right*2-portal", left, points, sliver, 1);
    level_node(level, "right*3-portal", left);
    Built built = build(level);
    assert_int_equal(found(&built, ENF_DIAGNOSIS_PORTAL_DEGENERATE, "right*1-portal"), 1);
    assert_int_equal(found(&built, ENF_DIAGNOSIS_PORTAL_DEGENERATE, "right*2-portal"), 1);
    assert_int_equal(found(&built, ENF_DIAGNOSIS_PORTAL_DEGENERATE, "right*3-portal"), 1);
    assert_int_equal(built.diagnosis.count, 3);
    assert_one_door(&built);
    done(&built, level);
}

/* A plane of many triangles, drawn from both sides, is one rectangle of four points. */
static void subdivided_plane_is_one_polygon(void **state) {
    (void)state;
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    uint32_t node = level_node(level, "right-portal", left);
    for (int i = 0; i < 16; i++) {
        double u[2] = {0.5 * (i % 4), 0.5 * (i % 4) + 0.5}, v[2] = {1 + 0.25 * (i / 4), 1.25 + 0.25 * (i / 4)};
        level_rectangle(level, node, 0, 4.0, u, v, true, 0);
        level_rectangle(level, node, 0, 4.0, u, v, false, 0);
    }
    Built built = build(level);
    assert_quiet(&built);
    assert_one_door(&built);
    assert_int_equal(built.layout.portals[0].point_count, 4);
    done(&built, level);
}

static void two_openings_of_one_node_are_two_portals(void **state) {
    (void)state;
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    uint32_t node = level_portal(level, "right-portal", left, door_box, true);
    const double u[2] = {0, 2}, v[2] = {3, 4};
    level_rectangle(level, node, 0, 4.0, u, v, true, 0);
    Built built = build(level);
    assert_quiet(&built);
    assert_int_equal(built.layout.portal_count, 4);
    done(&built, level);
}

/* Sixty-four corners do not fit in one portal: two that cover the same area. */
static void many_cornered_portal_is_split(void **state) {
    (void)state;
    uint32_t left, right;
    Level *level = two_rooms(&left, &right);
    uint32_t node = level_node(level, "right-portal", left);
    EnfVec3 rim[64];
    for (int i = 0; i < 64; i++) {
        double angle = 2.0 * ENF_PI * i / 64.0;
        rim[i] = enf_v3(4.0, 1.0 + enf_cos(angle), 1.5 + enf_sin(angle));
    }
    for (int i = 1; i < 63; i++) {
        level_triangle(level, node, rim[0], rim[i], rim[i + 1], 0);
    }
    Built built = build(level);
    assert_quiet(&built);
    assert_true(built.layout.portal_count >= 4);
    for (uint32_t i = 0; i < built.layout.portal_count; i++) {
        assert_in_range(built.layout.portals[i].point_count, 3, ENF_POLYGON_MAX);
        assert_pair(&built.layout, i);
    }
    assert_true(total_area(&built.layout, 0) > 3.13 && total_area(&built.layout, 0) < 3.14);
    done(&built, level);
}

/* ---- transforms ------------------------------------------------------------------------------------------------------------ */

static double distance(EnfVec3 a, EnfVec3 b) {
    return enf_length(enf_sub(a, b));
}

static void mirror_reflects(void **state) {
    (void)state;
    Level *level = level_new();
    uint32_t hall = level_room(level, "hall-room", left_box);
    uint32_t glass = level_portal(level, "glass-portal", hall, level_box(4, 0.5, 1, 4, 2, 2), true);
    level_extras(level, glass, "{\"mirror\": true}");
    Built built = build(level);
    assert_quiet(&built);
    const EnfLayoutPortal *portal = &built.layout.portals[0];
    assert_int_equal(built.layout.portal_count, 1);
    assert_int_equal(portal->source, 0);
    assert_int_equal(portal->target, 0);
    assert_int_equal(portal->flags, ENF_PORTAL_MIRROR);
    assert_true(portal->has_transform);
    assert_true(distance(enf_affine_point(&portal->transform, enf_v3(3, 1, 2)), enf_v3(5, 1, 2)) < 1e-12);
    done(&built, level);
}

static void teleport_leads_out_of_the_other_portal(void **state) {
    (void)state;
    Level *level = level_new();
    uint32_t hall = level_room(level, "hall-room", left_box);
    uint32_t attic = level_room(level, "attic-room", level_box(0, 10, 0, 4, 13, 5));
    uint32_t in = level_portal(level, "in-portal", hall, level_box(4, 0, 1, 4, 2, 2), true);
    level_portal(level, "out-portal", attic, level_box(1, 10, 0, 2, 12, 0), false);
    level_extras(level, in, "{\"teleport_to\": \"out\"}");
    Built built = build(level);
    assert_quiet(&built);
    const EnfLayout *layout = &built.layout;
    assert_int_equal(layout->portal_count, 2);
    assert_int_equal(layout->portals[0].target, 1);
    assert_int_equal(layout->portals[0].twin, 1);
    assert_int_equal(layout->portals[1].twin, 0);
    /* A step before the entrance is a step behind the exit: from x = 3.5 in the hall to beyond z = 0, upright. */
    EnfVec3 there = enf_affine_point(&layout->portals[0].transform, enf_v3(3.5, 1, 1.5));
    assert_true(distance(there, enf_v3(1.5, 11, -0.5)) < 1e-12);
    assert_true(enf_affine_vector(&layout->portals[0].transform, enf_v3(0, 1, 0)).y > 1.0 - 1e-12);
    EnfVec3 back = enf_affine_point(&layout->portals[1].transform, there);
    assert_true(distance(back, enf_v3(3.5, 1, 1.5)) < 1e-12);
    assert_true(enf_affine_det(&layout->portals[0].transform) > 0.0);
    done(&built, level);
}

static void teleport_to_nothing_is_warned(void **state) {
    (void)state;
    Level *level = level_new();
    uint32_t hall = level_room(level, "hall-room", left_box);
    uint32_t in = level_portal(level, "in-portal", hall, level_box(4, 0, 1, 4, 2, 2), true);
    level_extras(level, in, "{\"portal_to_portal\": \"missing\"}");
    Built built = build(level);
    assert_only(&built, ENF_DIAGNOSIS_PORTAL_NO_TARGET, "in-portal");
    assert_int_equal(built.layout.portal_count, 0);
    done(&built, level);
}

/* ---- real levels ----------------------------------------------------------------------------------------------------------- */

static const char *text_of(const cJSON *object, const char *key) {
    return cJSON_GetObjectItemCaseSensitive(object, key)->valuestring;
}

static uint32_t number_of(const cJSON *object, const char *key) {
    return (uint32_t)cJSON_GetObjectItemCaseSensitive(object, key)->valuedouble;
}

/* Is there a half-portal from a to b with this name and the truth's four points? */
static bool has_portal(const EnfLayout *layout, const cJSON *truth, const uint32_t *cell_of) {
    const cJSON *quad = cJSON_GetObjectItemCaseSensitive(truth, "quad");
    for (uint32_t i = 0; i < layout->portal_count; i++) {
        const EnfLayoutPortal *portal = &layout->portals[i];
        if (portal->source != cell_of[number_of(truth, "a")] || portal->target != cell_of[number_of(truth, "b")] ||
            strcmp(portal->name, text_of(truth, "node")) != 0) {
            continue;
        }
        uint32_t matched = 0;
        const cJSON *corner;
        cJSON_ArrayForEach(corner, quad) {
            EnfVec3 p = enf_v3(cJSON_GetArrayItem(corner, 0)->valuedouble, cJSON_GetArrayItem(corner, 1)->valuedouble,
                               cJSON_GetArrayItem(corner, 2)->valuedouble);
            for (uint32_t k = 0; k < portal->point_count; k++) {
                if (distance(enf_grid_point(layout->points[portal->point_first + k]), p) < 2e-3) {
                    matched++;
                    break;
                }
            }
        }
        return matched == 4 && portal->twin != ENF_NONE;
    }
    return false;
}

static void check_truth(const char *name) {
    char path[128];
    snprintf(path, sizeof path, "%s.truth.json", name);
    size_t size = 0;
    uint8_t *text = enf_test_read_file(enf_test_data(path), &size);
    cJSON *truth = cJSON_Parse((const char *)text);
    snprintf(path, sizeof path, "%s.glb", name);
    EnfSource source = {0};
    Built built = {.result = ENF_OK};
    EnfCompileSettings settings = enf_compile_settings_default();
    EnfError error = {0};
    assert_non_null(truth);
    assert_int_equal(enf_source_import(&source, enf_test_data(path), &built.diagnosis, &error), ENF_OK);
    assert_int_equal(enf_layout_build(&built.layout, &source, &settings, &built.diagnosis, &error), ENF_OK);
    assert_int_equal(built.diagnosis.count, found(&built, ENF_DIAGNOSIS_NO_LIGHTS, NULL)); /* the house has none */
    const cJSON *cells = cJSON_GetObjectItemCaseSensitive(truth, "cells"), *item;
    const cJSON *portals = cJSON_GetObjectItemCaseSensitive(truth, "portals");
    uint32_t cell_of[256] = {0};
    assert_int_equal(built.layout.cell_count, cJSON_GetArraySize(cells));
    assert_int_equal(built.layout.portal_count, 2 * cJSON_GetArraySize(portals));
    cJSON_ArrayForEach(item, cells) {
        uint32_t c = 0;
        size_t length = strlen(text_of(item, "name"));
        while (c < built.layout.cell_count && strncmp(built.layout.cells[c].name, text_of(item, "name"), length) != 0) {
            c++;
        }
        assert_true(c < built.layout.cell_count);
        cell_of[number_of(item, "id")] = c;
    }
    cJSON_ArrayForEach(item, portals) {
        assert_true(has_portal(&built.layout, item, cell_of));
    }
    print_message("%s: %u cells, %u portals as in its truth\n", name, built.layout.cell_count, built.layout.portal_count / 2);
    cJSON_Delete(truth);
    free(text);
    enf_layout_free(&built.layout);
    enf_diagnosis_free(&built.diagnosis);
    enf_source_free(&source);
}

static void real_levels_match_their_truth(void **state) {
    (void)state;
    static const char *const names[] = {"freedoom/E1M1_rooms", "freedoom/E1M1_sector", "freedoom/E3M8_rooms",
                                        "freedoom/MAP01_rooms", "freedoom/MAP26_rooms", "buildings/duplex"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        check_truth(names[i]);
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
    cmocka_unit_test(concave_portal_is_split),
    cmocka_unit_test(bent_portal_is_flat_pieces),
    cmocka_unit_test(degenerate_portal_is_left_out),
    cmocka_unit_test(subdivided_plane_is_one_polygon),
    cmocka_unit_test(two_openings_of_one_node_are_two_portals),
    cmocka_unit_test(many_cornered_portal_is_split),
    cmocka_unit_test(mirror_reflects),
    cmocka_unit_test(teleport_leads_out_of_the_other_portal),
    cmocka_unit_test(teleport_to_nothing_is_warned),
    cmocka_unit_test(real_levels_match_their_truth),
};

ENF_TEST_MAIN(tests)
