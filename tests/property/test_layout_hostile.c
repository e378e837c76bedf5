/* Levels that nobody would build: random nodes, names, extras and polygons. Whatever comes in, what comes out keeps the rules that
 * enf_map_check will ask for, and a second run gives the same bytes. */
#include "harness/harness.h"

#include "compile/soup.h"
#include "harness/level.h"

#include <enfilade/tolerances.h>

static const char *const stems[] = {"hall", "left", "right", "*", "left*1", "hall*2", "nowhere*3", "", "a_b", "left-room"};
static const char *const endings[] = {"-room",    "-room",  "-portal",    "-portal", "-portal.001",
                                      "_PORTAL",  "-bound", "-roomgroup", "-noimp",  "-col",
                                      "-colonly", "-portl", "",           "",        "-room.002"};
static const char *const extras[] = {"",
                                     "",
                                     "",
                                     "{\"two_way\": false}",
                                     "{\"mirror\": true}",
                                     "{\"teleport_to\": \"left\"}",
                                     "{\"teleport_to\": \"hall*2\", \"two_way\": 0}",
                                     "{\"portal_to\": \"right\"}",
                                     "{\"portal_to\": \"hall\", \"transform\": [0,0,1,0, 0,1,0,0, -1,0,0,0, 3,4,5,1]}",
                                     "{\"portal_to\": \"hall\", \"transform\": [2,0,1,0, 0,1,0,0, -1,0,0,0, 3,4,5,1]}",
                                     "{\"active\": \"false\", \"from\": \"left\"}",
                                     "{\"priority\": 9}",
                                     "{\"target\": \"gate\"}",
                                     "{\"targetname\": \"gate\"}",
                                     "[1, 2",
                                     "{\"to\": 7, \"two_way\": {}}"};

#define PICK(rng, table) (table)[enf_test_below(rng, (uint32_t)(sizeof(table) / sizeof((table)[0])))]

/* Coarse coordinates make coincidences: shared planes, equal openings, folded polygons. */
static double coordinate(EnfTestRng *rng) {
    static const double far[] = {1e3, -1e5, 1e-5, 2e5};
    return enf_test_chance(rng, 400) ? PICK(rng, far) : 0.5 * enf_test_below(rng, 13) + (enf_test_chance(rng, 9) ? 1e-3 : 0.0);
}

static EnfVec3 point(EnfTestRng *rng) {
    return enf_v3(coordinate(rng), coordinate(rng), coordinate(rng));
}

static void add_shape(Level *level, uint32_t node, EnfTestRng *rng) {
    EnfVec3 a = point(rng), b = point(rng);
    uint32_t material = enf_test_chance(rng, 12) ? 1 : enf_test_below(rng, 4);
    EnfBox3 box = enf_box3_add(enf_box3_add(enf_box3_empty(), a), b);
    switch (enf_test_below(rng, 4)) {
    case 0:
        for (uint32_t i = enf_test_below(rng, 30); i < 30; i++) {
            level_triangle(level, node, point(rng), point(rng), point(rng), material);
        }
        break;
    case 1:
        for (int axis = 0; axis < 3; axis++) {
            level_face(level, node, box, axis, false, material);
            level_face(level, node, box, axis, true, material);
        }
        break;
    case 2:
        box.max.x = box.min.x;
        level_rectangle(level, node, box, enf_test_chance(rng, 2), material);
        break;
    default: {
        EnfVec3 p[4] = {a, enf_v3(a.x, b.y, a.z), b, enf_v3(b.x, a.y, point(rng).z)};
        level_quad(level, node, p, material);
    }
    }
}

static Level *random_level(EnfTestRng *rng) {
    Level *level = level_new();
    char name[LEVEL_NAME];
    uint32_t nodes = 2 + enf_test_below(rng, 30);
    for (uint32_t i = 0; i < nodes; i++) {
        snprintf(name, sizeof name, "%s%s", PICK(rng, stems), PICK(rng, endings));
        bool child = i > 0 && enf_test_chance(rng, 2);
        uint32_t node = level_node(level, name, child ? enf_test_below(rng, i) : ENF_NONE);
        level_extras(level, node, PICK(rng, extras));
        if (!enf_test_chance(rng, 4)) {
            add_shape(level, node, rng);
        }
        if (enf_test_chance(rng, 5)) { /* mirrored, squashed or turned */
            level->nodes[node].world.m[0] = enf_test_chance(rng, 2) ? -1.0 : 0.0;
            level->nodes[node].world.m[5] = 0.25;
        }
    }
    return level;
}

typedef struct Built {
    EnfLayout layout;
    EnfSoup soup;
    EnfDiagnosis diagnosis;
    EnfReach *reach;
    bool made;
} Built;

static void build(Built *built, const Level *level) {
    EnfCompileSettings settings = enf_compile_settings_default();
    EnfError error = {0};
    memset(built, 0, sizeof *built);
    if (enf_layout_build(&built->layout, &level->source, &settings, &built->diagnosis, &error) != ENF_OK) {
        assert_int_equal(error.code, ENF_ERROR_LEVEL);
        return;
    }
    assert_int_equal(enf_soup_build(&built->soup, &level->source, &built->layout, &settings, &built->diagnosis, &error),
                     ENF_OK);
    assert_int_equal(enf_regions_assign(&built->layout, &built->soup, &level->source, &settings, &built->diagnosis), ENF_OK);
    built->reach = enf_reach_create(&built->layout, &built->soup);
    assert_non_null(built->reach);
    built->made = true;
}

static void destroy(Built *built) {
    enf_reach_destroy(built->reach);
    enf_soup_free(&built->soup);
    enf_layout_free(&built->layout);
    enf_diagnosis_free(&built->diagnosis);
}

static void check_transform(const EnfLayoutPortal *portal) {
    const double *m = portal->transform.m;
    for (int a = 0; a < 3; a++) {
        for (int b = 0; b < 3; b++) {
            double dot = m[3 * a] * m[3 * b] + m[3 * a + 1] * m[3 * b + 1] + m[3 * a + 2] * m[3 * b + 2] - (a == b);
            assert_true(dot < ENF_TOL_RIGID && dot > -ENF_TOL_RIGID);
        }
    }
    assert_int_equal(enf_affine_det(&portal->transform) < 0.0, (portal->flags & ENF_PORTAL_MIRROR) != 0);
}

static void check_portals(const EnfLayout *layout) {
    for (uint32_t i = 0; i < layout->portal_count; i++) {
        const EnfLayoutPortal *portal = &layout->portals[i];
        assert_true(portal->source < layout->cell_count && portal->target < layout->cell_count);
        assert_true(i == 0 || layout->portals[i - 1].source <= portal->source);
        assert_true(portal->source != portal->target || portal->has_transform);
        if (portal->flags & ENF_PORTAL_OVERLAP) {
            assert_int_equal(portal->point_count, 0);
        } else {
            assert_in_range(portal->point_count, 3, ENF_POLYGON_MAX);
            assert_true(portal->point_first + portal->point_count <= layout->point_count);
        }
        if (portal->has_transform) {
            check_transform(portal);
        } else {
            assert_false(portal->flags & ENF_PORTAL_MIRROR);
        }
        if (portal->twin != ENF_NONE) {
            const EnfLayoutPortal *twin = &layout->portals[portal->twin];
            assert_true(portal->twin < layout->portal_count && portal->twin != i);
            assert_true(twin->twin == i && twin->source == portal->target && twin->target == portal->source);
            assert_int_equal(twin->has_transform, portal->has_transform);
        }
    }
}

static void check_cells(const Built *built) {
    const EnfLayout *layout = &built->layout;
    for (uint32_t c = 0; c < layout->cell_count; c++) {
        const EnfLayoutCell *cell = &layout->cells[c];
        assert_non_null(cell->name);
        assert_true(cell->origin.x % 16 == 0 && cell->origin.y % 16 == 0 && cell->origin.z % 16 == 0);
        assert_true(cell->min.x <= cell->max.x && cell->min.y <= cell->max.y && cell->min.z <= cell->max.z);
        assert_true(cell->bound_first + cell->bound_count <= layout->bound_plane_count);
        assert_true(cell->parent == ENF_NONE || cell->parent < c);
        assert_true(!(cell->flags & ENF_CELL_OUTSIDE) || c + 1 == layout->cell_count);
    }
    for (uint32_t i = 0; i < built->soup.triangle_count; i++) {
        const EnfSoupTriangle *triangle = &built->soup.triangles[i];
        uint32_t other[64];
        assert_true(triangle->cell < layout->cell_count);
        const EnfLayoutCell *cell = &layout->cells[triangle->cell];
        for (int k = 0; k < 3; k++) {
            EnfGrid3 p = built->soup.vertices[triangle->v[k]].p;
            assert_true(p.x >= cell->min.x && p.x <= cell->max.x && p.y >= cell->min.y && p.y <= cell->max.y &&
                        p.z >= cell->min.z && p.z <= cell->max.z);
        }
        uint32_t count = enf_reach_query(built->reach, &i, 1, triangle->cell, other, 64);
        for (uint32_t k = 0; k < count; k++) {
            assert_true(other[k] < layout->cell_count && other[k] != triangle->cell);
            assert_true(k == 0 || other[k - 1] < other[k]);
        }
    }
}

static void assert_same(const Built *a, const Built *b) {
    assert_int_equal(a->layout.cell_count, b->layout.cell_count);
    assert_int_equal(a->layout.portal_count, b->layout.portal_count);
    assert_int_equal(a->layout.point_count, b->layout.point_count);
    assert_int_equal(a->diagnosis.count, b->diagnosis.count);
    if (a->layout.point_count > 0) {
        assert_memory_equal(a->layout.points, b->layout.points, a->layout.point_count * sizeof *a->layout.points);
    }
    for (uint32_t i = 0; i < a->layout.portal_count; i++) {
        const EnfLayoutPortal *p = &a->layout.portals[i], *q = &b->layout.portals[i];
        assert_true(p->source == q->source && p->target == q->target && p->twin == q->twin && p->flags == q->flags);
        assert_memory_equal(&p->transform, &q->transform, sizeof p->transform);
    }
    for (uint32_t i = 0; i < a->soup.triangle_count; i++) {
        assert_int_equal(a->soup.triangles[i].cell, b->soup.triangles[i].cell);
    }
    for (uint32_t i = 0; i < a->diagnosis.count; i++) {
        assert_string_equal(a->diagnosis.findings[i].message, b->diagnosis.findings[i].message);
    }
}

static void any_level_keeps_the_rules(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    uint32_t made = 0, portals = 0, codes[ENF_DIAGNOSIS_COUNT] = {0};
    for (uint32_t round = 0; round < enf_test_rounds(250, 3000); round++) {
        Level *level = random_level(&rng);
        Built built, again;
        build(&built, level);
        if (built.made) {
            build(&again, level);
            check_portals(&built.layout);
            check_cells(&built);
            assert_same(&built, &again);
            destroy(&again);
            made++;
            portals += built.layout.portal_count;
        }
        for (uint32_t i = 0; i < built.diagnosis.count; i++) {
            codes[built.diagnosis.findings[i].code]++;
        }
        destroy(&built);
        level_free(level);
    }
    print_message("%u levels made, %u half-portals;", made, portals);
    for (int i = 0; i < ENF_DIAGNOSIS_COUNT; i++) {
        if (codes[i] > 0) {
            print_message(" %s %u", enf_diagnosis_text((EnfDiagnosisCode)i), codes[i]);
        }
    }
    print_message("\n");
    assert_true(made > 0 && portals > 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(any_level_keeps_the_rules),
};

ENF_TEST_MAIN(tests)
