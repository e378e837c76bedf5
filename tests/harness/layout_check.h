/* Layouts of small levels, built and judged: for the suites of the compiler's layout. */
#ifndef ENF_TESTS_LAYOUT_CHECK_H
#define ENF_TESTS_LAYOUT_CHECK_H

#include "harness/harness.h"

#include "compile/layout.h"
#include "harness/level.h"

typedef struct Built {
    EnfLayout layout;
    EnfDiagnosis diagnosis;
    EnfResult result;
} Built;

static inline Built build(const Level *level) {
    Built built = {.result = ENF_OK};
    EnfCompileSettings settings = enf_compile_settings_default();
    EnfError error = {0};
    built.result = enf_layout_build(&built.layout, &level->source, &settings, &built.diagnosis, &error);
    assert_true(built.result == ENF_OK || error.message[0] != '\0');
    return built;
}

static inline void done(Built *built, Level *level) {
    enf_layout_free(&built->layout);
    enf_diagnosis_free(&built->diagnosis);
    level_free(level);
}

/* How many findings have this code and name this node (any, if NULL). */
static inline uint32_t found(const Built *built, EnfDiagnosisCode code, const char *node) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < built->diagnosis.count; i++) {
        const EnfFinding *finding = &built->diagnosis.findings[i];
        count += finding->code == code && (node == NULL || strcmp(finding->node, node) == 0);
    }
    return count;
}

/* One finding with this code and node, and nothing else. */
static inline void assert_only(const Built *built, EnfDiagnosisCode code, const char *node) {
    for (uint32_t i = 0; i < built->diagnosis.count; i++) {
        const EnfFinding *finding = &built->diagnosis.findings[i];
        if (finding->code != code || strcmp(finding->node, node) != 0) {
            print_message("unexpected: %s [%s] %s\n", enf_diagnosis_text(finding->code), finding->node, finding->message);
        }
    }
    assert_int_equal(found(built, code, node), 1);
    assert_int_equal(built->diagnosis.count, 1);
}

static inline void assert_quiet(const Built *built) {
    for (uint32_t i = 0; i < built->diagnosis.count; i++) {
        const EnfFinding *finding = &built->diagnosis.findings[i];
        print_message("unexpected: %s [%s] %s\n", enf_diagnosis_text(finding->code), finding->node, finding->message);
    }
    assert_int_equal(built->diagnosis.count, 0);
}

/* Two rooms side by side along x, a door between them at x = 4. */
static const EnfBox3 left_box = {{0, 0, 0}, {4, 3, 5}}, right_box = {{4, 0, 0}, {9, 3, 5}}, door_box = {{4, 0, 1}, {4, 2, 2}};

static inline Level *two_rooms(uint32_t *left, uint32_t *right) {
    Level *level = level_new();
    level_hole(level, door_box);
    *left = level_room(level, "left-room", left_box);
    *right = level_room(level, "right-room", right_box);
    return level;
}

/* The two half-portals of one opening lead there and back over bit-equal points. */
static inline void assert_pair(const EnfLayout *layout, uint32_t i) {
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

static inline EnfVec3 normal_of(const EnfLayout *layout, uint32_t i) {
    EnfVec3 points[ENF_POLYGON_MAX];
    for (uint32_t k = 0; k < layout->portals[i].point_count; k++) {
        points[k] = enf_grid_point(layout->points[layout->portals[i].point_first + k]);
    }
    return enf_plane_from_polygon(points, layout->portals[i].point_count).n;
}

/* The level of two_rooms with one door, as it should come out. */
static inline void assert_one_door(const Built *built) {
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

#endif
