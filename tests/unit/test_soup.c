/* The soup: transforms, snapping, windings, normals, degenerate triangles. */
#include "compile/exact.h"
#include "compile/soup.h"
#include "harness/harness.h"

#include <math.h>
#include <string.h>

/* A level of one mesh and up to four nodes, all in cell 0. */
typedef struct Level {
    EnfSource source;
    EnfLayout layout;
    EnfSourceNode nodes[4];
    EnfSourceMesh mesh;
    EnfSourcePrimitive primitive;
    EnfMaterial materials[2];
    const char *names[2];
    EnfRole roles[4];
    uint32_t node_cells[4];
    float positions[12], normals[12];
    uint32_t indices[6];
} Level;

/* A unit square in the plane y = 0, front up, as two triangles. */
static void make_level(Level *level, uint32_t node_count) {
    static const float square[12] = {0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 0};
    static const float up[12] = {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0};
    static const uint32_t order[6] = {0, 1, 2, 0, 2, 3};
    memset(level, 0, sizeof *level);
    memcpy(level->positions, square, sizeof square);
    memcpy(level->normals, up, sizeof up);
    memcpy(level->indices, order, sizeof order);
    level->primitive = (EnfSourcePrimitive){4, 6, level->positions, level->normals, NULL, NULL, level->indices, 0};
    level->mesh = (EnfSourceMesh){"square", 0, 1};
    level->names[0] = "stone";
    level->names[1] = "nodraw";
    level->materials[1].flags = ENF_MATERIAL_NODRAW;
    for (uint32_t i = 0; i < node_count; i++) {
        level->nodes[i] = (EnfSourceNode){.name = "node",
                                          .index = i,
                                          .parent = ENF_NONE,
                                          .world = enf_affine_identity(),
                                          .mesh = 0,
                                          .camera = ENF_NONE,
                                          .light = ENF_NONE,
                                          .extras = ""};
        level->roles[i] = ENF_ROLE_GEOMETRY;
    }
    level->source = (EnfSource){.nodes = level->nodes,
                                .node_count = node_count,
                                .meshes = &level->mesh,
                                .mesh_count = 1,
                                .primitives = &level->primitive,
                                .primitive_count = 1,
                                .materials = level->materials,
                                .material_names = level->names,
                                .material_count = 2};
    level->layout.roles = level->roles;
    level->layout.node_cells = level->node_cells;
}

static void bake(Level *level, EnfSoup *soup, EnfDiagnosis *diagnosis, bool weld) {
    EnfCompileSettings settings = enf_compile_settings_default();
    EnfError error;
    settings.weld_tjunctions = weld;
    memset(diagnosis, 0, sizeof *diagnosis);
    assert_int_equal(enf_soup_build(soup, &level->source, &level->layout, &settings, diagnosis, &error), ENF_OK);
}

static EnfVec3 face_normal(const EnfSoup *soup, uint32_t triangle) {
    const uint32_t *v = soup->triangles[triangle].v;
    EnfVec3 a = enf_grid_point(soup->vertices[v[0]].p);
    return enf_normalize(
        enf_cross(enf_sub(enf_grid_point(soup->vertices[v[1]].p), a), enf_sub(enf_grid_point(soup->vertices[v[2]].p), a)));
}

static void release(EnfSoup *soup, EnfDiagnosis *diagnosis) {
    enf_soup_free(soup);
    enf_diagnosis_free(diagnosis);
}

/* ---- cases ------------------------------------------------------------------------------------------------------ */

static void places_on_the_grid(void **state) {
    (void)state;
    Level level;
    EnfSoup soup;
    EnfDiagnosis diagnosis;
    make_level(&level, 1);
    level.nodes[0].world.t = enf_v3(100.00003, -7.5, 1e6);
    bake(&level, &soup, &diagnosis, true);
    assert_int_equal(soup.triangle_count, 2);
    assert_int_equal(soup.source_triangle_count, 2);
    assert_int_equal(soup.vertices[0].p.x, 409600); /* 100.00003 m is 409600.12 steps */
    assert_int_equal(soup.vertices[0].p.y, -30720);
    assert_int_equal(soup.vertices[2].p.z, INT64_C(1000001) * 4096);
    assert_float_equal(soup.vertices[1].color[3], 1, 0);
    assert_int_equal(soup.triangles[1].cell, 0);
    release(&soup, &diagnosis);
}

/* A mirrored node shows its faces on the same side as an unmirrored one, and its normals agree with them. */
static void mirrored_nodes_keep_their_fronts(void **state) {
    (void)state;
    static const double scales[4][3] = {{1, 1, 1}, {-1, 1, 1}, {2, -3, 0.5}, {-1, -1, -1}};
    for (int i = 0; i < 4; i++) {
        Level level;
        EnfSoup soup;
        EnfDiagnosis diagnosis;
        make_level(&level, 1);
        for (int axis = 0; axis < 3; axis++) {
            level.nodes[0].world.m[4 * axis] = scales[i][axis];
        }
        bake(&level, &soup, &diagnosis, true);
        double expected = scales[i][1] > 0 ? 1 : -1; /* a scale along y turns what lies above to below */
        for (uint32_t t = 0; t < soup.triangle_count; t++) {
            assert_float_equal((float)face_normal(&soup, t).y, (float)expected, 1e-6f);
            assert_float_equal(soup.vertices[soup.triangles[t].v[0]].normal[1], (float)expected, 1e-6f);
        }
        release(&soup, &diagnosis);
    }
}

/* A sheared and scaled node: normals by the inverse transpose stay perpendicular to the faces. */
static void normals_follow_faces(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    for (int round = 0; round < 200; round++) {
        Level level;
        EnfSoup soup;
        EnfDiagnosis diagnosis;
        make_level(&level, 1);
        for (int i = 0; i < 9; i++) {
            level.nodes[0].world.m[i] = enf_test_double(&rng, -3, 3) + (i % 4 == 0 ? 4 : 0);
        }
        bake(&level, &soup, &diagnosis, true);
        for (uint32_t t = 0; t < soup.triangle_count; t++) {
            const float *n = soup.vertices[soup.triangles[t].v[0]].normal;
            double cosine = enf_dot(face_normal(&soup, t), enf_v3((double)n[0], (double)n[1], (double)n[2]));
            assert_true(cosine > 0.999);
        }
        release(&soup, &diagnosis);
    }
}

static void degenerate_triangles_are_dropped_and_told(void **state) {
    (void)state;
    Level level;
    EnfSoup soup;
    EnfDiagnosis diagnosis;
    make_level(&level, 2);
    level.positions[8] = 1e-5f; /* the second corner's partner collapses on snapping */
    level.positions[6] = 1e-5f;
    level.nodes[1].world.m[8] = 0; /* flattened into a line */
    bake(&level, &soup, &diagnosis, true);
    assert_int_equal(soup.degenerate_count, 4);
    assert_int_equal(soup.triangle_count, 0);
    assert_int_equal(diagnosis.count, 2);
    assert_int_equal(diagnosis.findings[0].code, ENF_DIAGNOSIS_DEGENERATE_TRIANGLES);
    assert_string_equal(diagnosis.findings[0].node, "node");
    release(&soup, &diagnosis);
}

static void roles_and_materials_decide(void **state) {
    (void)state;
    static const EnfRole roles[4] = {ENF_ROLE_ROOM, ENF_ROLE_PORTAL, ENF_ROLE_COLLISION, ENF_ROLE_IGNORED};
    Level level;
    EnfSoup soup;
    EnfDiagnosis diagnosis;
    make_level(&level, 4);
    memcpy(level.roles, roles, sizeof roles);
    bake(&level, &soup, &diagnosis, false);
    assert_int_equal(soup.triangle_count, 2); /* the room's own mesh is its shell */
    assert_int_equal(soup.triangles[0].node, 0);
    release(&soup, &diagnosis);

    level.primitive.material = 1;
    bake(&level, &soup, &diagnosis, false);
    assert_int_equal(soup.triangle_count, 2);        /* nodraw closes the shell, */
    assert_int_equal(soup.source_triangle_count, 0); /* but does not count */
    release(&soup, &diagnosis);

    level.names[1] = "visportal";
    bake(&level, &soup, &diagnosis, false);
    assert_int_equal(soup.triangle_count, 0);
    release(&soup, &diagnosis);
}

/* Corners at the ends of the grid do not overflow the exact tests. */
static void far_corners_are_exact(void **state) {
    (void)state;
    const int64_t end = INT64_C(1) << 40;
    EnfGrid3 a = {-end, -end, -end}, b = {end, end, end}, c = {0, 0, 0}, d = {0, 0, 1};
    assert_true(enf_grid_collinear(a, b, c));
    assert_false(enf_grid_collinear(a, b, d));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(places_on_the_grid),         cmocka_unit_test(mirrored_nodes_keep_their_fronts),
    cmocka_unit_test(normals_follow_faces),       cmocka_unit_test(degenerate_triangles_are_dropped_and_told),
    cmocka_unit_test(roles_and_materials_decide), cmocka_unit_test(far_corners_are_exact),
};
ENF_TEST_MAIN(tests)
