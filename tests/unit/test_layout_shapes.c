/* Portals of every shape as convex polygons, portals that lead elsewhere, and real levels against what their makers know of them. */
#include "harness/layout_check.h"

#include <cjson/cJSON.h>

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
        double y = 0.5 * (i % 4), z = 1 + 0.25 * (i / 4);
        level_rectangle(level, node, level_box(4, y, z, 4, y + 0.5, z + 0.25), true, 0);
        level_rectangle(level, node, level_box(4, y, z, 4, y + 0.5, z + 0.25), false, 0);
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
    level_rectangle(level, node, level_box(4, 0, 3, 4, 2, 4), true, 0);
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
    static const char *const names[] = {"freedoom/E1M1_rooms",  "freedoom/E1M1_sector", "freedoom/E3M8_rooms",
                                        "freedoom/MAP01_rooms", "freedoom/MAP26_rooms", "buildings/duplex"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        check_truth(names[i]);
    }
}

static const struct CMUnitTest tests[] = {
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
