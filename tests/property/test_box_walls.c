/* Rooms built as people build with boxes: walls, floors and ceilings are solids with a thickness, and a wall between two rooms belongs to
 * one of them, to the other, or to none. Points are located in their rooms; whoever stands in a room is shown each of its walls. */
#include "harness/harness.h"

#include "compile/assemble.h"
#include "compile/regions.h"
#include "compile/soup.h"
#include "harness/level.h"

#include <enfilade/map.h>

enum { ROOMS = 3, WALLS_MAX = 64, LOOSE = 3 };

typedef struct House {
    Level *level;
    uint32_t rooms[ROOMS];
    uint32_t walls[WALLS_MAX];
    EnfBox3 boxes[WALLS_MAX];
    uint32_t wall_count;
    EnfLayout layout;
    EnfSoup soup;
    EnfDiagnosis diagnosis;
    EnfReach *reach;
    EnfClusters clusters;
    EnfAssembly assembly;
    EnfMap map;
} House;

static void add_wall(House *house, uint32_t owner, EnfBox3 box) {
    uint32_t parent = owner == LOOSE ? ENF_NONE : house->rooms[owner];
    house->boxes[house->wall_count] = box;
    house->walls[house->wall_count++] = level_block(house->level, "wall", parent, box);
}

/* Rooms of 4 × 3 × 5 m in a row along x, a door in each inner wall; `thick` is half a wall. The outer walls are their rooms'. */
static void model(House *house, EnfTestRng *rng, double thick, uint32_t owners) {
    Level *level = house->level = level_new();
    double angle = enf_test_double(rng, 0.0, 2.0 * ENF_PI), s = enf_sin(angle), c = enf_cos(angle);
    level->placed = (EnfAffine){{c, 0, -s, 0, 1, 0, s, 0, c},
                                {enf_test_double(rng, -50, 50), 0, enf_test_double(rng, -50, 50)}};
    for (uint32_t i = 0; i < ROOMS; i++) {
        char name[LEVEL_NAME];
        snprintf(name, sizeof name, "r%u-room", i);
        house->rooms[i] = level_node(level, name, ENF_NONE);
    }
    for (uint32_t i = 0; i < ROOMS; i++) {
        double x = 4.0 * i, t = thick;
        add_wall(house, i, level_box(x, -0.15, 0, x + 4, 0, 5));
        add_wall(house, i, level_box(x, 3, 0, x + 4, 3.15, 5));
        add_wall(house, i, level_box(x - t, 0, -t, x + 4 + t, 3, t));
        add_wall(house, i, level_box(x - t, 0, 5 - t, x + 4 + t, 3, 5 + t));
    }
    add_wall(house, 0, level_box(-thick, 0, 0, thick, 3, 5));
    add_wall(house, ROOMS - 1, level_box(4.0 * ROOMS - thick, 0, 0, 4.0 * ROOMS + thick, 3, 5));
    for (uint32_t i = 0; i + 1 < ROOMS; i++) {
        char name[LEVEL_NAME];
        double x = 4.0 * i + 4.0;
        uint32_t owner = owners == LOOSE ? LOOSE : i + (owners + i) % 2;
        add_wall(house, owner, level_box(x - thick, 0, 0, x + thick, 3, 2));
        add_wall(house, owner, level_box(x - thick, 0, 3, x + thick, 3, 5));
        add_wall(house, owner, level_box(x - thick, 2, 2, x + thick, 3, 3));
        snprintf(name, sizeof name, "r%u_room*%u-portal", i + 1, i); /* the other suffix than the room's */
        level_portal(level, name, house->rooms[i], level_box(x, 0, 2, x, 2, 3), true);
    }
}

static void compile(House *house) {
    EnfCompileSettings settings = enf_compile_settings_default();
    EnfError error = {0};
    const EnfSource *source = &house->level->source;
    assert_int_equal(enf_layout_build(&house->layout, source, &settings, &house->diagnosis, &error), ENF_OK);
    assert_int_equal(enf_soup_build(&house->soup, source, &house->layout, &settings, &house->diagnosis, &error), ENF_OK);
    assert_int_equal(enf_regions_assign(&house->layout, &house->soup, source, &settings, &house->diagnosis), ENF_OK);
    assert_int_equal(enf_clusters_build(&house->clusters, &house->soup, &house->layout, &error), ENF_OK);
    house->reach = enf_reach_create(&house->layout, &house->soup);
    assert_non_null(house->reach);
    EnfAssemblyParts parts = {source,           &house->layout, &house->soup,     house->reach,
                              &house->clusters, &settings,      &house->diagnosis};
    assert_int_equal(enf_assemble(&house->assembly, &parts, &error), ENF_OK);
    house->map = enf_assembly_map(&house->assembly, 1);
    assert_int_equal(enf_map_check(&house->map, &error), ENF_OK);
}

static void destroy(House *house) {
    enf_assembly_free(&house->assembly);
    enf_clusters_free(&house->clusters);
    enf_reach_destroy(house->reach);
    enf_soup_free(&house->soup);
    enf_layout_free(&house->layout);
    enf_diagnosis_free(&house->diagnosis);
    level_free(house->level);
}

static EnfBox3 inside_of(uint32_t room, double thick) {
    return level_box(4.0 * room + thick, 0, thick, 4.0 * room + 4.0 - thick, 3, 5.0 - thick);
}

/* A wall's solid is listed in every room whose inside it touches, by whichever of its triangles; an open room shows everything. */
static void check_listed(const House *house, double thick) {
    for (uint32_t w = 0; w < house->wall_count; w++) {
        uint32_t triangles[64], count = 0, other[ROOMS + 1], home = ENF_NONE;
        for (uint32_t i = 0; i < house->soup.triangle_count && count < 64; i++) {
            if (house->soup.triangles[i].node == house->walls[w]) {
                triangles[count++] = i;
                home = house->soup.triangles[i].cell;
            }
        }
        uint32_t found = enf_reach_query(house->reach, triangles, count, home, other, ROOMS + 1);
        for (uint32_t r = 0; r < ROOMS; r++) {
            EnfBox3 inside = inside_of(r, thick - 0.001);
            bool listed = home == r || (house->layout.cells[r].flags & ENF_CELL_OPEN);
            for (uint32_t k = 0; k < found; k++) {
                listed = listed || other[k] == r;
            }
            if (enf_box3_overlaps(house->boxes[w], inside) && !listed) {
                fail_msg("wall %u is not listed in room %u", w, r);
            }
        }
    }
}

/* Not within half a metre of a neighbour's wall: from there most of what is seen is the neighbour's. */
static void check_located(const House *house, EnfTestRng *rng) {
    for (uint32_t i = 0; i < 60; i++) {
        uint32_t room = i % ROOMS;
        EnfBox3 box = inside_of(room, 0.75);
        EnfVec3 p = enf_v3(enf_test_double(rng, box.min.x, box.max.x), enf_test_double(rng, 0.25, 2.75),
                           enf_test_double(rng, box.min.z, box.max.z));
        if (i % 4 == 3) { /* in a doorway */
            p = enf_v3(4.0 * (room < ROOMS - 1 ? room + 1 : room) + (room < ROOMS - 1 ? -0.03 : 0.03), 1.5, 2.5);
        }
        uint32_t found = enf_map_locate(&house->map, enf_affine_point(&house->level->placed, p));
        if (found != room) {
            fail_msg("(%g, %g, %g) is in room %u, not %d", p.x, p.y, p.z, room, (int)found);
        }
    }
}

static void boxes_make_rooms(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    for (uint32_t round = 0; round < enf_test_rounds(12, 200); round++) {
        static const uint32_t owners[3] = {0, 1, LOOSE};
        double thick = enf_test_double(&rng, 0.05, 0.2);
        House house = {.wall_count = 0};
        model(&house, &rng, thick, owners[round % 3]);
        compile(&house);
        assert_int_equal(house.layout.cell_count, ROOMS);
        assert_int_equal(house.layout.portal_count, 2 * (ROOMS - 1));
        check_listed(&house, thick);
        check_located(&house, &rng);
        destroy(&house);
    }
}

/* A room of which nothing is its own but the portal closes nothing off: it must show everything. */
static void room_without_surfaces_is_open(void **state) {
    (void)state;
    Level *level = level_new();
    EnfBox3 hole = level_box(4, 0, 2, 4, 2, 3);
    level_hole(level, hole);
    uint32_t a = level_room(level, "a-room", level_box(0, 0, 0, 4, 3, 5));
    uint32_t b = level_node(level, "b-room", ENF_NONE);
    level_block(level, "thing", b, level_box(6, 0, 2, 6.5, 1, 3));
    level_faces(level, "shell", ENF_NONE, level_box(4, 0, 0, 8, 3, 5), 0);
    level_portal(level, "b*1-portal", a, hole, true);
    House house = {.level = level};
    compile(&house);
    assert_int_equal(house.layout.cells[0].flags, 0);
    assert_int_equal(house.layout.cells[1].flags, ENF_CELL_OPEN);
    destroy(&house);
}

/* A shut door in the opening's plane shares its edges, but says nothing about its sides. */
static void shut_door_turns_no_portal(void **state) {
    (void)state;
    for (uint32_t turned = 0; turned < 2; turned++) {
        Level *level = level_new();
        EnfBox3 hole = level_box(4, 0, 2, 4, 2, 3);
        level_hole(level, hole);
        uint32_t a = level_room(level, "a-room", level_box(0, 0, 0, 4, 3, 5));
        level_room(level, "b-room", level_box(4, 0, 0, 8, 3, 5));
        uint32_t door = level_node(level, "door", a);
        for (uint32_t i = 0; i < 3; i++) { /* thrice, to outvote the wall */
            level_rectangle(level, door, hole, turned, 0);
        }
        level_portal(level, "b*1-portal", a, hole, true);
        House house = {.level = level};
        compile(&house);
        for (uint32_t i = 0; i < house.diagnosis.count; i++) {
            assert_int_not_equal(house.diagnosis.findings[i].code, ENF_DIAGNOSIS_PORTAL_FLIPPED);
        }
        destroy(&house);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(boxes_make_rooms),
    cmocka_unit_test(room_without_surfaces_is_open),
    cmocka_unit_test(shut_door_turns_no_portal),
};

ENF_TEST_MAIN(tests)
