/* Regions on grids of rooms, turned at random: what is closed is called closed, what leaks or overlaps is found, and furniture is listed
 * where it can be seen. Voxels and closed parts against solids whose inside is known. */
#include "harness/harness.h"

#include "compile/regions.h"
#include "compile/regions_closed.h"
#include "compile/regions_voxels.h"
#include "compile/soup.h"
#include "harness/level.h"

typedef struct Built {
    EnfLayout layout;
    EnfSoup soup;
    EnfDiagnosis diagnosis;
    EnfReach *reach;
} Built;

static void build(Built *built, const EnfSource *source) {
    EnfCompileSettings settings = enf_compile_settings_default();
    EnfError error = {0};
    assert_int_equal(enf_layout_build(&built->layout, source, &settings, &built->diagnosis, &error), ENF_OK);
    assert_int_equal(enf_soup_build(&built->soup, source, &built->layout, &settings, &built->diagnosis, &error), ENF_OK);
    assert_int_equal(enf_regions_assign(&built->layout, &built->soup, source, &settings, &built->diagnosis), ENF_OK);
    built->reach = enf_reach_create(&built->layout, &built->soup);
    assert_non_null(built->reach);
    for (uint32_t i = 0; i < built->soup.triangle_count; i++) {
        assert_true(built->soup.triangles[i].cell < built->layout.cell_count);
    }
}

static void destroy(Built *built) {
    enf_reach_destroy(built->reach);
    enf_soup_free(&built->soup);
    enf_layout_free(&built->layout);
    enf_diagnosis_free(&built->diagnosis);
}

static uint32_t found(const Built *built, EnfDiagnosisCode code, const char *node) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < built->diagnosis.count; i++) {
        const EnfFinding *finding = &built->diagnosis.findings[i];
        count += finding->code == code && (node == NULL || strcmp(finding->node, node) == 0);
    }
    return count;
}

static void assert_count(const Built *built, uint32_t count) {
    for (uint32_t i = 0; built->diagnosis.count != count && i < built->diagnosis.count; i++) {
        const EnfFinding *finding = &built->diagnosis.findings[i];
        print_message("%s [%s] %s\n", enf_diagnosis_text(finding->code), finding->node, finding->message);
    }
    assert_int_equal(built->diagnosis.count, count);
}

/* The cells in which a node's triangles are listed beside their home; the home in *home. */
static uint32_t reached(const Built *built, uint32_t node, uint32_t *home, uint32_t *out, uint32_t capacity) {
    uint32_t triangles[128], count = 0;
    for (uint32_t i = 0; i < built->soup.triangle_count; i++) {
        if (built->soup.triangles[i].node == node && count < 128) {
            triangles[count++] = i;
            *home = built->soup.triangles[i].cell;
        }
    }
    assert_true(count > 0);
    return enf_reach_query(built->reach, triangles, count, *home, out, capacity);
}

static void turn(Level *level, EnfTestRng *rng) {
    double angle = enf_test_double(rng, 0.0, 2.0 * ENF_PI), s = enf_sin(angle), c = enf_cos(angle);
    level->placed = (EnfAffine){{c, 0, -s, 0, 1, 0, s, 0, c},
                                {enf_test_double(rng, -50, 50), enf_test_double(rng, -5, 5), enf_test_double(rng, -50, 50)}};
}

enum { WIDE = 3, DEEP = 3 };

static EnfBox3 room_box(int x, int z) {
    return level_box(4.0 * x, 0, 5.0 * z, 4.0 * x + 4.0, 3, 5.0 * z + 5.0);
}

/* Rooms side by side, a door in each inner wall; walls have no thickness. */
static Level *grid(EnfTestRng *rng, uint32_t rooms[WIDE * DEEP]) {
    Level *level = level_new();
    char name[LEVEL_NAME];
    turn(level, rng);
    for (int x = 0; x < WIDE; x++) {
        for (int z = 0; z < DEEP; z++) {
            if (x + 1 < WIDE) {
                level_hole(level, level_box(4.0 * x + 4, 0, 5.0 * z + 2, 4.0 * x + 4, 2, 5.0 * z + 3));
            }
            if (z + 1 < DEEP) {
                level_hole(level, level_box(4.0 * x + 1.5, 0, 5.0 * z + 5, 4.0 * x + 2.5, 2.25, 5.0 * z + 5));
            }
        }
    }
    for (int i = 0; i < WIDE * DEEP; i++) {
        snprintf(name, sizeof name, "r%d-room", i);
        rooms[i] = level_room(level, name, room_box(i % WIDE, i / WIDE));
    }
    for (uint32_t h = 0; h < level->hole_count; h++) {
        EnfBox3 hole = level->holes[h];
        bool along_x = hole.max.x <= hole.min.x;
        int x = (int)((hole.min.x - (along_x ? 0.1 : 0.0)) / 4.0), z = (int)((hole.min.z - (along_x ? 0.0 : 0.1)) / 5.0);
        snprintf(name, sizeof name, "r%d*%u-portal", along_x ? z * WIDE + x + 1 : (z + 1) * WIDE + x, h);
        level_portal(level, name, rooms[z * WIDE + x], hole, true);
    }
    return level;
}

/* Rooms behind walls without thickness touch along the feet of the walls, where depths are equal: a room's surfaces are listed in the
 * rooms beside it, and in no other. */
static void expect_beside(int room, const uint32_t *others, uint32_t count) {
    uint32_t expected = 0;
    for (int i = 0; i < WIDE * DEEP; i++) {
        int dx = i % WIDE - room % WIDE, dz = i / WIDE - room / WIDE;
        if (dx * dx + dz * dz == 1) {
            assert_true(expected < count && others[expected] == (uint32_t)i);
            expected++;
        }
    }
    assert_int_equal(count, expected);
}

static void closed_grids_are_quiet(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    for (uint32_t round = 0; round < enf_test_rounds(12, 300); round++) {
        uint32_t rooms[WIDE * DEEP], home = ENF_NONE, other[8];
        Level *level = grid(&rng, rooms);
        uint32_t table = level_block(level, "table", rooms[4], level_box(5, 0, 6, 7, 1, 7));
        Built built = {.reach = NULL};
        build(&built, &level->source);
        assert_count(&built, 0);
        assert_int_equal(built.layout.cell_count, WIDE * DEEP);
        assert_int_equal(built.layout.portal_count, 2 * level->hole_count);
        for (int i = 0; i < WIDE * DEEP; i++) {
            assert_int_equal(built.layout.cells[i].flags, 0);
            uint32_t beside = reached(&built, rooms[i] + 1, &home, other, 8);
            assert_int_equal(home, i);
            expect_beside(i, other, beside);
        }
        assert_int_equal(reached(&built, table, &home, other, 8), 0);
        destroy(&built);
        level_free(level);
    }
}

/* A table in a doorway, loose or in a room, is listed on both sides; a door leaf in the opening's plane as well; what stands in a corner
 * only at home. */
static void furniture_in_doors_is_listed_on_both_sides(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    for (uint32_t round = 0; round < enf_test_rounds(12, 300); round++) {
        uint32_t rooms[WIDE * DEEP], home = ENF_NONE, other[8];
        Level *level = grid(&rng, rooms);
        uint32_t owned = level_block(level, "owned", rooms[0], level_box(3, 0.25, 2.25, 4.5, 1, 2.75));
        uint32_t loose = level_block(level, "loose", ENF_NONE, level_box(3.75, 0.25, 2.25, 6, 1, 2.75));
        uint32_t corner = level_block(level, "corner", ENF_NONE, level_box(5, 0.25, 1, 6, 1, 2));
        uint32_t leaf = level_block(level, "leaf", rooms[1], level_box(4, 0, 2, 4.04, 2, 3));
        uint32_t sheet = level_node(level, "sheet", rooms[1]);
        level_rectangle(level, sheet, level_box(4, 0, 2, 4, 2, 3), true, 3);
        Built built = {.reach = NULL};
        build(&built, &level->source);
        assert_count(&built, 0);
        assert_int_equal(reached(&built, owned, &home, other, 8), 1);
        assert_int_equal(home, 0);
        assert_int_equal(other[0], 1);
        assert_int_equal(reached(&built, loose, &home, other, 8), 1);
        assert_int_equal(home, 1); /* most of it lies there */
        assert_int_equal(other[0], 0);
        assert_int_equal(reached(&built, corner, &home, other, 8), 0);
        assert_int_equal(home, 1);
        assert_int_equal(reached(&built, leaf, &home, other, 8), 1);
        assert_int_equal(reached(&built, sheet, &home, other, 8), 1);
        destroy(&built);
        level_free(level);
    }
}

/* A long beam through two doors in a row is listed in all three rooms; one through a wall in the room behind it; a loose carpet under
 * everything in every room. */
static void long_things_are_listed_where_they_go(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(3);
    for (uint32_t round = 0; round < enf_test_rounds(8, 200); round++) {
        uint32_t rooms[WIDE * DEEP], home = ENF_NONE, other[16];
        Level *level = grid(&rng, rooms);
        uint32_t beam = level_block(level, "beam", rooms[0], level_box(1, 0.5, 2.25, 10, 0.75, 2.5));
        uint32_t pole = level_block(level, "pole", rooms[0], level_box(3, 2.5, 1, 6, 2.75, 1.25));
        uint32_t carpet = level_node(level, "carpet", ENF_NONE);
        level_rectangle(level, carpet, level_box(0.5, 0.01, 0.5, 11.5, 0.01, 14.5), true, 0);
        Built built = {.reach = NULL};
        build(&built, &level->source);
        assert_int_equal(reached(&built, beam, &home, other, 16), 2);
        assert_int_equal(other[0], 1);
        assert_int_equal(other[1], 2);
        assert_int_equal(reached(&built, pole, &home, other, 16), 1);
        assert_int_equal(other[0], 1);
        assert_int_equal(reached(&built, carpet, &home, other, 16), WIDE * DEEP - 1);
        enf_reach_report(built.reach, &built.diagnosis);
        assert_int_equal(found(&built, ENF_DIAGNOSIS_GEOMETRY_CROSSES, "pole"), 1);
        assert_count(&built, 1); /* not the beam, which goes through doors, nor the carpet, which is nobody's */
        destroy(&built);
        level_free(level);
    }
}

/* Without the wall between them on one side, a room sees the back of its neighbour's wall, and through it. */
static void missing_wall_is_a_leak(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(4);
    for (uint32_t round = 0; round < enf_test_rounds(18, 400); round++) {
        uint32_t rooms[WIDE * DEEP];
        char name[LEVEL_NAME];
        Level *level = grid(&rng, rooms);
        uint32_t victim = enf_test_below(&rng, WIDE * DEEP), walls = rooms[victim] + 1;
        LevelMesh *mesh = &level->data[walls];
        uint32_t quad = enf_test_below(&rng, mesh->count / 6); /* any rectangle of the room: the smallest are 1 m by 0.75 m */
        memmove(&mesh->positions[18 * quad], &mesh->positions[18 * (quad + 1)],
                (mesh->count - 6 * (quad + 1)) * 3 * sizeof(float));
        memmove(&mesh->normals[18 * quad], &mesh->normals[18 * (quad + 1)], (mesh->count - 6 * (quad + 1)) * 3 * sizeof(float));
        level->primitives[walls].index_count -= 6;
        level->primitives[walls].vertex_count -= 6;
        Built built = {.reach = NULL};
        build(&built, &level->source);
        snprintf(name, sizeof name, "r%u-room", victim);
        assert_int_equal(found(&built, ENF_DIAGNOSIS_ROOM_LEAK, name), 1);
        assert_count(&built, 1);
        assert_true(built.diagnosis.findings[0].point_count >= 2);
        for (uint32_t i = 0; i < WIDE * DEEP; i++) {
            assert_int_equal(built.layout.cells[i].flags, i == victim ? ENF_CELL_OPEN : 0);
        }
        destroy(&built);
        level_free(level);
    }
}

static void overlap_is_measured_and_linked(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(5);
    for (uint32_t round = 0; round < enf_test_rounds(12, 200); round++) {
        Level *level = level_new();
        bool apart = enf_test_chance(&rng, 3);
        double by = apart ? -enf_test_double(&rng, 0.0, 0.5) : enf_test_double(&rng, 0.3, 2.0);
        turn(level, &rng);
        level_room(level, "a-room", level_box(0, 0, 0, 5, 3, 5));
        level_room(level, "b-room", level_box(5 - by, 0, 1, 10, 3, 4));
        Built built = {.reach = NULL};
        build(&built, &level->source);
        assert_count(&built, apart ? 0 : 1);
        assert_int_equal(built.layout.portal_count, apart ? 0 : 2);
        if (!apart) {
            double measured = 0.0;
            assert_int_equal(found(&built, ENF_DIAGNOSIS_ROOM_OVERLAP, "a-room"), 1);
            assert_int_equal(sscanf(built.diagnosis.findings[0].message, "it shares about %lf", &measured), 1);
            assert_true(measured > 0.6 * by * 9.0 && measured < 1.3 * by * 9.0);
            assert_int_equal(built.layout.portals[0].flags, ENF_PORTAL_OVERLAP);
            assert_int_equal(built.layout.portals[0].twin, 1);
            assert_int_equal(built.layout.portals[1].twin, 0);
        }
        destroy(&built);
        level_free(level);
    }
}

/* A booth in a hall, joined by a portal, is neither an overlap nor a leak; a stove in it belongs to the booth, loose or not. */
static void nested_room_is_quiet(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(6);
    for (uint32_t round = 0; round < enf_test_rounds(6, 60); round++) {
        Level *level = level_new();
        uint32_t home = ENF_NONE, other[4];
        EnfBox3 booth_box = level_box(2, 0, 2, 4, 2, 4), door = level_box(4, 0, 2.5, 4, 1.75, 3.5);
        turn(level, &rng);
        uint32_t hall = level_room(level, "hall-room", level_box(0, 0, 0, 8, 4, 8));
        level_block(level, "booth outside", hall, level_box(1.9, 0.01, 1.9, 3.9, 2.1, 4.1));
        level_hole(level, door);
        uint32_t booth = level_node(level, "booth-room", hall);
        level_faces(level, "booth inside", booth, booth_box, 0);
        level_portal(level, "hall-portal", booth, door, true);
        uint32_t stove = level_block(level, "stove", ENF_NONE, level_box(2.5, 0.25, 2.5, 3, 1, 3));
        Built built = {.reach = NULL};
        build(&built, &level->source);
        assert_count(&built, 0);
        reached(&built, stove, &home, other, 4);
        assert_int_equal(home, 1);
        destroy(&built);
        level_free(level);
    }
}

static void what_is_in_no_room_is_outside(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng_fixed(7, 7);
    uint32_t rooms[WIDE * DEEP], home = ENF_NONE, other[4];
    Level *level = grid(&rng, rooms);
    uint32_t tree = level_block(level, "tree", ENF_NONE, level_box(40, 0, 40, 41, 5, 41));
    Built built = {.reach = NULL};
    build(&built, &level->source);
    assert_int_equal(found(&built, ENF_DIAGNOSIS_NODE_OUTSIDE, "tree"), 1);
    assert_count(&built, 1);
    assert_int_equal(built.layout.cell_count, WIDE * DEEP + 1);
    assert_int_equal(built.layout.cells[WIDE * DEEP].flags, ENF_CELL_OUTSIDE);
    assert_int_equal(reached(&built, tree, &home, other, 4), 0);
    assert_int_equal(home, WIDE * DEEP);
    destroy(&built);
    level_free(level);
}

/* ---- parts ----------------------------------------------------------------------------------------------------------------- */

/* The faces of a box as a mesh of n × n squares a face, turned by `a`, fronts inward; triangles in out (12 n² of them). */
static uint32_t turned_box(const EnfAffine *a, EnfVec3 size, int n, EnfVec3 (*out)[3]) {
    uint32_t count = 0;
    for (int face = 0; face < 6; face++) {
        for (int i = 0; i < n * n; i++) {
            EnfVec3 corners[4];
            for (int k = 0; k < 4; k++) {
                double u = (double)(i % n + (k == 1 || k == 2)) / n - 0.5, v = (double)(i / n + (k >= 2)) / n - 0.5;
                EnfVec3 p = level_on_face(face / 2, face % 2 ? 0.5 : -0.5, u, v);
                corners[k] = enf_affine_point(a, enf_v3(p.x * size.x, p.y * size.y, p.z * size.z));
            }
            int second = face % 2 ? 2 : 1, third = face % 2 ? 1 : 2;
            EnfVec3 *t = out[count++];
            t[0] = corners[0], t[second] = corners[1], t[third] = corners[2];
            t = out[count++];
            t[0] = corners[0], t[second] = corners[2], t[third] = corners[3];
        }
    }
    return count;
}

static EnfAffine random_turn(EnfTestRng *rng) {
    EnfVec3 axis = enf_normalize(
        enf_v3(enf_test_double(rng, -1, 1), enf_test_double(rng, -1, 1), enf_test_double(rng, 0.1, 1)));
    EnfVec3 t = enf_v3(enf_test_double(rng, -9, 9), enf_test_double(rng, -9, 9), enf_test_double(rng, -9, 9));
    return enf_affine_trs(t, enf_quat_axis_angle(axis, enf_test_double(rng, 0, 6)), enf_v3(1, 1, 1));
}

/* No flood gets out of a turned box however coarse the voxels, and one gets out through a square hole four voxels wide. */
static void voxels_hold_thin_walls(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(8);
    static EnfVec3 triangles[12 * 36][3];
    EnfVoxels voxels = {.size = 0};
    for (uint32_t round = 0; round < enf_test_rounds(100, 3000); round++) {
        EnfAffine placed = random_turn(&rng);
        EnfVec3 size = enf_v3(enf_test_double(&rng, 3, 9), enf_test_double(&rng, 3, 9), enf_test_double(&rng, 3, 9));
        uint32_t count = turned_box(&placed, size, 6, triangles), hole = enf_test_below(&rng, count / 2);
        double least = size.x < size.y ? size.x : size.y;
        least = size.z < least ? size.z : least;
        EnfBox3 box = enf_box3_empty();
        for (uint32_t i = 0; i < count; i++) {
            for (int k = 0; k < 3; k++) {
                box = enf_box3_add(box, triangles[i][k]);
            }
        }
        for (int open = 0; open < 2; open++) {
            double edge = open ? least / 6.0 / 4.0 : enf_test_double(&rng, 0.05, 0.4) * least;
            assert_true(enf_voxels_reset(&voxels, box, edge, 4000000));
            for (uint32_t i = 0; i < count; i++) {
                if (!open || i / 2 != hole) {
                    enf_voxels_mark(&voxels, triangles[i]);
                }
            }
            uint32_t seed = enf_voxels_at(&voxels, placed.t);
            assert_int_not_equal(seed, ENF_NONE);
            uint32_t exit = enf_voxels_flood(&voxels, &seed, 1);
            assert_true((exit != ENF_NONE) == open);
        }
    }
    enf_voxels_free(&voxels);
}

/* A turned box is closed although one face is subdivided otherwise than its neighbours; without one triangle it is not. */
static void closed_parts_are_found(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(9);
    static EnfVec3 fine[12 * 16][3], coarse[12][3];
    for (uint32_t round = 0; round < enf_test_rounds(100, 3000); round++) {
        EnfAffine placed = random_turn(&rng);
        EnfVec3 size = enf_v3(enf_test_double(&rng, 1, 9), enf_test_double(&rng, 1, 9), enf_test_double(&rng, 1, 9));
        EnfGrid3 corners[3 * 12 * 16];
        bool closed[12 * 16];
        uint32_t count = 0, face = enf_test_below(&rng, 6);
        turned_box(&placed, size, 4, fine);
        turned_box(&placed, size, 1, coarse);
        for (uint32_t i = 0; i < 6; i++) {
            uint32_t n = i == face ? 2 : 32;
            for (uint32_t t = 0; t < n; t++, count++) {
                const EnfVec3 *p = i == face ? coarse[2 * i + t] : fine[32 * i + t];
                for (int k = 0; k < 3; k++) {
                    corners[3 * count + (uint32_t)k] = enf_grid_snap(p[k]);
                }
            }
        }
        EnfSurface surface = {corners, count};
        EnfVec3 outside = enf_affine_point(&placed, enf_v3(size.x, 0, 0));
        assert_true(enf_surface_closed_parts(&surface, closed));
        assert_true(closed[0] && closed[count - 1]);
        assert_true(enf_surface_encloses(&surface, closed, placed.t));
        assert_false(enf_surface_encloses(&surface, closed, outside));
        surface.triangle_count--;
        assert_true(enf_surface_closed_parts(&surface, closed));
        assert_false(closed[0]);
        assert_false(enf_surface_encloses(&surface, closed, placed.t));
    }
}

/* ---- real levels ----------------------------------------------------------------------------------------------------------- */

static void real_levels_do_not_leak(void **state) {
    (void)state;
    static const char *const names[] = {"freedoom/E1M1_rooms.glb",  "freedoom/E1M1_sector.glb", "freedoom/E3M8_rooms.glb",
                                        "freedoom/MAP01_rooms.glb", "freedoom/MAP26_rooms.glb", "buildings/duplex.glb"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        EnfSource source = {0};
        EnfError error = {0};
        Built built = {.reach = NULL};
        assert_int_equal(enf_source_import(&source, enf_test_data(names[i]), &built.diagnosis, &error), ENF_OK);
        build(&built, &source);
        assert_int_equal(found(&built, ENF_DIAGNOSIS_ROOM_LEAK, NULL), 0);
        assert_int_equal(found(&built, ENF_DIAGNOSIS_ROOM_OVERLAP, NULL), 0);
        assert_int_equal(found(&built, ENF_DIAGNOSIS_NODE_OUTSIDE, NULL), 0);
        print_message("%s: %u cells, none leaks or overlaps\n", names[i], built.layout.cell_count);
        destroy(&built);
        enf_source_free(&source);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(closed_grids_are_quiet),
    cmocka_unit_test(furniture_in_doors_is_listed_on_both_sides),
    cmocka_unit_test(long_things_are_listed_where_they_go),
    cmocka_unit_test(missing_wall_is_a_leak),
    cmocka_unit_test(overlap_is_measured_and_linked),
    cmocka_unit_test(nested_room_is_quiet),
    cmocka_unit_test(what_is_in_no_room_is_outside),
    cmocka_unit_test(voxels_hold_thin_walls),
    cmocka_unit_test(closed_parts_are_found),
    cmocka_unit_test(real_levels_do_not_leak),
};

ENF_TEST_MAIN(tests)
