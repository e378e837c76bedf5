/* Points → cells, where the answer is known without any search; rays against a loop over every triangle. */
#include "harness/harness.h"
#include "map/map_internal.h"
#include "scenes/rooms.h"
#include <enfilade/tolerances.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static EnfRooms make_rooms(EnfRoomsDef def) {
    EnfRooms rooms;
    EnfError error = {0};
    if (!enf_rooms_create(&rooms, &def, &error)) {
        fail_msg("%s", error.message);
    }
    return rooms;
}

static EnfVec3 random_in(EnfTestRng *rng, EnfBox3 box, double margin) {
    return enf_v3(enf_test_double(rng, box.min.x + margin, box.max.x - margin),
                  enf_test_double(rng, box.min.y + margin, box.max.y - margin),
                  enf_test_double(rng, box.min.z + margin, box.max.z - margin));
}

/* The block of rooms, a little larger. */
static EnfBox3 block_of(const EnfRooms *rooms) {
    const EnfRoomsDef *d = &rooms->def;
    EnfBox3 box = {d->origin, enf_add(d->origin, enf_v3(d->room.x * d->nx, d->room.y, d->room.z * d->nz))};
    return box;
}

/* ---- rooms ------------------------------------------------------------------------------------------------------ */

static void check_points(EnfTestRng *rng, const EnfRooms *rooms, const EnfMap *map, uint32_t rounds) {
    EnfBox3 block = block_of(rooms);
    for (uint32_t i = 0; i < rounds; i++) {
        EnfVec3 p = random_in(rng, block, -1.0);
        /* Inside a chair is inside the room; but on a chair's surface, and in a threshold, which is of one room, who knows. */
        if (enf_rooms_in_furniture(rooms, p, 1e-6) && (rooms->def.thresholds || !enf_rooms_in_furniture(rooms, p, -1e-6))) {
            continue;
        }
        uint32_t expected = enf_rooms_cell_at(rooms, p), found = enf_map_locate(map, p);
        if (found != expected) {
            fail_msg("(%.17g, %.17g, %.17g) is in cell %d, not %d", p.x, p.y, p.z, (int)expected, (int)found);
        }
    }
}

static void test_grids(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    const EnfVec3 origins[] = {{0, 0, 0}, {-10000, 300, 25000}, {0.25, -1000.5, 77}};
    for (int i = 0; i < 6; i++) {
        EnfRoomsDef def = enf_rooms_def_default();
        def.origin = origins[i % 3];
        def.seed = enf_test_u64(&rng);
        def.door_percent = i % 2 ? 60 : 100;
        def.furniture = (uint32_t)i % 3 * 4;
        def.thresholds = i >= 3;
        def.room = enf_v3(enf_test_double(&rng, 3, 9), enf_test_double(&rng, 2.5, 6), enf_test_double(&rng, 3, 9));
        EnfRooms rooms = make_rooms(def);
        check_points(&rng, &rooms, rooms.map, enf_test_rounds(2000, 50000));
        enf_rooms_destroy(&rooms);
    }
}

/* Blender marks every material double-sided unless told otherwise: the winding still tells. */
static void test_double_sided(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    EnfRooms rooms = make_rooms(enf_rooms_def_default());
    EnfMap map = *rooms.map;
    EnfMaterial materials[8];
    memcpy(materials, map.materials, map.materials_count * sizeof *materials);
    for (uint32_t i = 0; i < map.materials_count; i++) {
        materials[i].flags |= ENF_MATERIAL_DOUBLE_SIDED;
    }
    map.materials = materials;
    check_points(&rng, &rooms, &map, enf_test_rounds(2000, 50000));
    enf_rooms_destroy(&rooms);
}

/* On the plane of a door, inside the opening: one of the two rooms, never none. */
static void test_on_portals(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(3);
    EnfRooms rooms = make_rooms(enf_rooms_def_default());
    const EnfMap *map = rooms.map;
    for (uint32_t i = 0; i < enf_test_rounds(2000, 50000); i++) {
        uint32_t portal = enf_test_below(&rng, map->portals_count);
        const EnfPortal *p = &map->portals[portal];
        EnfVec3 origin = enf_map_origin(map, p->source), sum = {0, 0, 0};
        double weight = 0.0;
        for (uint32_t k = 0; k < p->vertex_count; k++) {
            double w = enf_test_double(&rng, 0.05, 1.0);
            sum = enf_add(sum, enf_scale(enf_map_portal_vertex(map, portal, k), w));
            weight += w;
        }
        uint32_t found = enf_map_locate(map, enf_add(origin, enf_scale(sum, 1.0 / weight)));
        assert_true(found == p->source || found == p->target);
    }
    enf_rooms_destroy(&rooms);
}

static void test_bad_points(void **state) {
    (void)state;
    EnfRooms rooms = make_rooms(enf_rooms_def_default());
    const double bad[] = {(double)NAN, (double)INFINITY, (double)-INFINITY, 1e308, -1e30};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(enf_map_locate(rooms.map, enf_v3(bad[i], 1, 1)), ENF_NONE);
        assert_int_equal(enf_map_locate(rooms.map, enf_v3(1, bad[i], 1)), ENF_NONE);
    }
    assert_false(enf_map_cell_contains(rooms.map, ENF_NONE, enf_v3(1, 1, 1)));
    enf_rooms_destroy(&rooms);
}

/* ---- prisms: many-sided, turned, with a hole in the floor plan --------------------------------------------------- */

static double snap(double x) {
    return floor(x / ENF_GRID_STEP + 0.5) * ENF_GRID_STEP;
}

typedef struct Prism {
    EnfVec3 points[16];
    uint32_t count;
    double height;
} Prism;

static Prism random_prism(EnfTestRng *rng, EnfVec3 center) {
    Prism prism = {{{0, 0, 0}}, 3 + enf_test_below(rng, 10), 3.0};
    double turn = enf_test_double(rng, 0, 6.28), radius = enf_test_double(rng, 2, 8);
    for (uint32_t i = 0; i < prism.count; i++) {
        double angle = turn + 2.0 * ENF_PI * i / prism.count;
        prism.points[i] = enf_v3(snap(center.x + radius * enf_cos(angle)), center.y, snap(center.z - radius * enf_sin(angle)));
    }
    return prism;
}

/* Seen from above (+y) the points go round counter-clockwise. `inward`: a room; else a pillar. */
static void add_prism(EnfMaker *m, uint32_t cell, const Prism *prism, bool inward) {
    EnfVec3 floor_points[16], ceiling[16];
    for (uint32_t i = 0; i < prism->count; i++) {
        uint32_t next = (i + 1) % prism->count;
        EnfVec3 a = prism->points[i], b = prism->points[next], up = enf_v3(0, prism->height, 0);
        EnfVec3 wall[4] = {a, enf_add(a, up), enf_add(b, up), b}, outward[4] = {wall[3], wall[2], wall[1], wall[0]};
        enf_maker_polygon(m, cell, 0, inward ? wall : outward, 4);
        floor_points[i] = prism->points[inward ? i : prism->count - 1 - i];
        ceiling[i] = enf_add(prism->points[inward ? prism->count - 1 - i : i], up);
    }
    enf_maker_polygon(m, cell, 0, floor_points, prism->count);
    enf_maker_polygon(m, cell, 0, ceiling, prism->count);
}

/* By the edges of the floor plan: 1 inside, 0 outside, -1 too close to tell. */
static int prism_contains(const Prism *prism, EnfVec3 p) {
    double y = p.y - prism->points[0].y, least = y < prism->height - y ? y : prism->height - y;
    for (uint32_t i = 0; i < prism->count; i++) {
        EnfVec3 a = prism->points[i], b = prism->points[(i + 1) % prism->count];
        double length = hypot(b.x - a.x, b.z - a.z);
        double distance = ((b.z - a.z) * (p.x - a.x) - (b.x - a.x) * (p.z - a.z)) / length;
        least = distance < least ? distance : least;
    }
    return least > 1e-6 ? 1 : least < -1e-6 ? 0 : -1;
}

static void test_prisms(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(4);
    for (uint32_t round = 0; round < enf_test_rounds(50, 2000); round++) {
        EnfMaker *m = enf_maker_create();
        EnfVec3 center = enf_v3(enf_test_double(&rng, -2000, 2000), 0, enf_test_double(&rng, -2000, 2000));
        center = enf_v3(snap(center.x), snap(center.y), snap(center.z));
        Prism room = random_prism(&rng, center), pillar = room; /* hovering: its caps are no part of the floor */
        for (uint32_t i = 0; i < pillar.count; i++) {           /* shrunk about the centre */
            pillar.points[i] = enf_v3(snap(center.x + 0.25 * (room.points[i].x - center.x)), center.y + 0.25,
                                      snap(center.z + 0.25 * (room.points[i].z - center.z)));
        }
        pillar.height = 2.5;
        uint32_t cell;
        enf_maker_cell(m, "prism", center, &cell);
        add_prism(m, cell, &room, true);
        add_prism(m, cell, &pillar, false);
        EnfError error = {0};
        const EnfMap *map = enf_maker_finish(m, &error);
        if (!map) {
            fail_msg("%s", error.message);
        }
        for (int i = 0; i < 100; i++) {
            EnfVec3 p = enf_add(
                center, enf_v3(enf_test_double(&rng, -8, 8), enf_test_double(&rng, -1, 4), enf_test_double(&rng, -8, 8)));
            int in_room = prism_contains(&room, p), in_pillar = prism_contains(&pillar, p);
            if (in_room >= 0 && in_pillar >= 0) {
                assert_int_equal(enf_map_locate(map, p) == cell, in_room == 1 && in_pillar == 0);
            }
        }
        enf_maker_destroy(m);
    }
}

/* ---- overlaps --------------------------------------------------------------------------------------------------- */

/* Three boxes one in another: priority first, then the smallest, and never the outside. */
static void test_overlaps(void **state) {
    (void)state;
    EnfMaker *m = enf_maker_create();
    uint32_t large, small, favoured, outside;
    enf_maker_cell(m, "large", enf_v3(0, 0, 0), &large);
    enf_maker_cell(m, "small", enf_v3(0, 0, 0), &small);
    enf_maker_cell(m, "favoured", enf_v3(0, 0, 0), &favoured)->priority = 3;
    enf_maker_cell(m, "outside", enf_v3(0, 0, 0), &outside)->flags = ENF_CELL_OUTSIDE;
    enf_maker_box(m, large, 0, (EnfBox3){{0, 0, 0}, {16, 4, 16}}, true);
    enf_maker_box(m, small, 0, (EnfBox3){{1, 1, 1}, {3, 3, 3}}, true);
    enf_maker_box(m, favoured, 0, (EnfBox3){{2, 1, 1}, {15, 3, 15}}, true);
    enf_maker_box(m, outside, 0, (EnfBox3){{-8, -8, -8}, {32, 32, 32}}, true);
    EnfError error = {0};
    const EnfMap *map = enf_maker_finish(m, &error);
    if (!map) {
        fail_msg("%s", error.message);
    }
    assert_int_equal(enf_map_locate(map, enf_v3(0.5, 0.5, 0.5)), large);
    assert_int_equal(enf_map_locate(map, enf_v3(1.5, 2, 2)), small);
    assert_int_equal(enf_map_locate(map, enf_v3(2.5, 2, 2)), favoured);
    assert_int_equal(enf_map_locate(map, enf_v3(20, 2, 2)), ENF_NONE);
    enf_maker_destroy(m);
}

/* ---- rays ------------------------------------------------------------------------------------------------------- */

/* The nearest of all triangles that the cell's tree lists. */
static bool brute_ray(const EnfMap *map, uint32_t cell, EnfVec3 from, EnfVec3 direction, double *t) {
    EnfKdTree tree = enf_map_cell_tree(map, cell);
    EnfMapRay ray;
    bool found = false;
    *t = HUGE_VAL;
    enf_map_ray_make(&ray, direction);
    for (uint32_t b = 0; b < tree.block_count; b++) {
        for (int lane = 0; lane < ENF_KD_BLOCK; lane++) {
            uint32_t item = tree.blocks[b].item[lane];
            const EnfCluster *cluster = item == ENF_NONE ? NULL : &map->clusters[item];
            for (uint32_t k = 0; cluster && k < cluster->index_count / 3; k++) {
                EnfVec3 local = enf_sub(from, enf_map_origin(map, cluster->cell)), v[3];
                for (uint32_t c = 0; c < 3; c++) {
                    v[c] = enf_sub(enf_map_corner(map, cluster, k, c), local);
                }
                double at;
                if (enf_map_ray_triangle(&ray, v[0], v[1], v[2], &at) && at >= 0.0 && at < *t) {
                    *t = at;
                    found = true;
                }
            }
        }
    }
    return found;
}

static void test_rays(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(5);
    EnfRoomsDef def = enf_rooms_def_default();
    def.furniture = 30;
    def.thresholds = true;
    def.origin = enf_v3(5000, 0, -9000);
    EnfRooms rooms = make_rooms(def);
    EnfBox3 block = block_of(&rooms);
    for (uint32_t i = 0; i < enf_test_rounds(5000, 200000); i++) {
        EnfVec3 from = random_in(&rng, block, -1.0), to = random_in(&rng, block, -1.0);
        uint32_t cell = enf_test_below(&rng, rooms.map->cells_count);
        EnfVec3 direction = enf_test_chance(&rng, 8) ? enf_v3(0, -1, 0) : enf_sub(to, from);
        double t;
        EnfRayHit hit = {0, 0, 0, false};
        bool expected = brute_ray(rooms.map, cell, from, direction, &t);
        assert_int_equal(enf_map_ray(rooms.map, cell, from, direction, HUGE_VAL, &hit), expected);
        if (expected) {
            assert_true(hit.t == t);
            assert_false(enf_map_ray(rooms.map, cell, from, direction, 0.5 * t, &hit) && hit.t > 0.5 * t);
        }
    }
    enf_rooms_destroy(&rooms);
}

/* From inside a closed box no ray gets out, not even through edges and corners. */
static void test_rays_watertight(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(6);
    EnfMaker *m = enf_maker_create();
    uint32_t cell;
    EnfBox3 box = {{1000.25, 0, 0}, {1003.75, 2.5, 7}};
    enf_maker_cell(m, "box", box.min, &cell);
    enf_maker_box(m, cell, 0, box, true);
    EnfError error = {0};
    const EnfMap *map = enf_maker_finish(m, &error);
    assert_non_null(map);
    for (uint32_t i = 0; i < enf_test_rounds(20000, 1000000); i++) {
        EnfVec3 from = random_in(&rng, box, 1e-3), to = random_in(&rng, box, 0.0);
        EnfVec3 *targets = &to;
        uint32_t edge = enf_test_below(&rng, 8); /* a point on an edge, on a diagonal, or a corner */
        targets->x = edge & 1 ? box.min.x : targets->x;
        targets->y = edge & 2 ? box.max.y : targets->y;
        targets->z = edge & 4 ? box.max.z : targets->z;
        EnfRayHit hit;
        assert_true(enf_map_ray(map, cell, from, enf_sub(to, from), HUGE_VAL, &hit));
        assert_true(hit.front);
    }
    enf_maker_destroy(m);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_grids),      cmocka_unit_test(test_double_sided),    cmocka_unit_test(test_on_portals),
    cmocka_unit_test(test_bad_points), cmocka_unit_test(test_prisms),          cmocka_unit_test(test_overlaps),
    cmocka_unit_test(test_rays),       cmocka_unit_test(test_rays_watertight),
};

ENF_TEST_MAIN(tests)
