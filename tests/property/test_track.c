/* The cell of a moving eye: segments through doors against arithmetic, steps to and fro across a doorway's plane, teleports. */
#include "harness/harness.h"
#include "map/map_internal.h"
#include "scenes/rooms.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static EnfRooms make_rooms(EnfRoomsDef def) {
    EnfRooms rooms;
    EnfError error = {0};
    if (!enf_rooms_create(&rooms, &def, &error)) {
        fail_msg("%s", error.message);
    }
    return rooms;
}

static EnfVec3 random_in_room(EnfTestRng *rng, const EnfRooms *rooms, uint32_t cell) {
    EnfBox3 box = enf_rooms_box(rooms, cell);
    return enf_v3(enf_test_double(rng, box.min.x, box.max.x), enf_test_double(rng, box.min.y, box.max.y),
                  enf_test_double(rng, box.min.z, box.max.z));
}

/* A point in the opening of a half-portal, never on its border. */
static EnfVec3 random_in_portal(EnfTestRng *rng, const EnfMap *map, uint32_t portal) {
    EnfVec3 sum = {0, 0, 0};
    double weight = 0.0;
    for (uint32_t k = 0; k < map->portals[portal].vertex_count; k++) {
        double w = enf_test_double(rng, 0.02, 1.0);
        sum = enf_add(sum, enf_scale(enf_map_portal_vertex(map, portal, k), w));
        weight += w;
    }
    return enf_add(enf_map_origin(map, map->portals[portal].source), enf_scale(sum, 1.0 / weight));
}

/* ---- through one door ------------------------------------------------------------------------------------------- */

static void test_one_door(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    EnfRoomsDef def = enf_rooms_def_default();
    def.origin = enf_v3(-7000, 12, 9000);
    EnfRooms rooms = make_rooms(def);
    const EnfMap *map = rooms.map;
    for (uint32_t i = 0; i < enf_test_rounds(20000, 500000); i++) {
        uint32_t portal = enf_test_below(&rng, map->portals_count);
        const EnfPortal *p = &map->portals[portal];
        EnfVec3 opening = random_in_portal(&rng, map, portal), from = random_in_room(&rng, &rooms, p->source);
        EnfVec3 on = enf_sub(opening, from);
        double reach = enf_test_double(&rng, 1e-6, 0.2);
        EnfVec3 to = enf_add(opening, enf_scale(on, reach));
        if (enf_rooms_cell_at(&rooms, to) != p->target || enf_rooms_cell_at(&rooms, from) != p->source) {
            continue;
        }
        assert_int_equal(enf_map_track(map, p->source, from, to), p->target);
        assert_int_equal(enf_map_track(map, p->target, to, from), p->source);
        assert_int_equal(enf_map_track(map, p->source, from, enf_add(opening, enf_scale(on, -1e-3))), p->source);
        assert_int_equal(enf_map_track(map, p->source, from, from), p->source);
    }
    enf_rooms_destroy(&rooms);
}

/* ---- through many ----------------------------------------------------------------------------------------------- */

/* Does the segment pass only through doors, well inside them? In a grid with doors as wide as rooms, that is: below the lintels
 * and away from the pillars. */
static bool only_through_doors(const EnfRooms *rooms, EnfVec3 from, EnfVec3 to) {
    const EnfRoomsDef *d = &rooms->def;
    const double margin = 1e-6, side_x = (d->room.x - d->door_width) / 2, side_z = (d->room.z - d->door_width) / 2;
    for (uint32_t axis = 0; axis < 2; axis++) {
        uint32_t walls = axis ? d->nz : d->nx;
        for (uint32_t i = 0; i <= walls; i++) {
            double plane = axis ? d->origin.z + d->room.z * i : d->origin.x + d->room.x * i;
            double a = axis ? from.z : from.x, b = axis ? to.z : to.x;
            if ((a < plane) == (b < plane)) {
                continue;
            }
            EnfVec3 p = enf_add(from, enf_scale(enf_sub(to, from), (plane - a) / (b - a)));
            double along = axis ? fmod(p.x - d->origin.x, d->room.x) : fmod(p.z - d->origin.z, d->room.z);
            double size = axis ? d->room.x : d->room.z, pillar = (axis ? side_x : side_z) + margin;
            if (along < pillar || along > size - pillar || p.y > d->origin.y + d->door_height - margin ||
                p.y < d->origin.y + margin) {
                return false;
            }
        }
    }
    return true;
}

static void test_many_doors(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    EnfRoomsDef def = enf_rooms_def_default();
    def.nx = def.nz = 9;
    def.door_width = 4.5; /* of 5: each in the middle */
    def.door_height = 2.75;
    EnfRooms rooms = make_rooms(def);
    uint32_t tried = 0, farthest = 0;
    for (uint32_t i = 0; i < enf_test_rounds(50000, 1000000); i++) {
        uint32_t a = enf_test_below(&rng, 81), b = enf_test_below(&rng, 81);
        EnfVec3 from = random_in_room(&rng, &rooms, a), to = random_in_room(&rng, &rooms, b);
        if (!only_through_doors(&rooms, from, to)) {
            continue;
        }
        uint32_t apart = (uint32_t)abs((int)(a % 9) - (int)(b % 9)) + (uint32_t)abs((int)(a / 9) - (int)(b / 9));
        farthest = apart > farthest ? apart : farthest;
        tried++;
        assert_int_equal(enf_map_track(rooms.map, a, from, to), b);
    }
    printf("%u segments, through up to %u doors\n", tried, farthest);
    assert_in_range(farthest, 4, 16);
    enf_rooms_destroy(&rooms);
}

/* A walk of small steps through the grid, only ever through doors, ends where arithmetic says. */
static void test_walk(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(3);
    EnfRoomsDef def = enf_rooms_def_default();
    def.origin = enf_v3(123456, 0, -654321);
    EnfRooms rooms = make_rooms(def);
    const EnfMap *map = rooms.map;
    EnfVec3 at = random_in_room(&rng, &rooms, 5);
    uint32_t cell = 5;
    for (uint32_t i = 0; i < enf_test_rounds(5000, 100000); i++) {
        const EnfCell *c = &map->cells[cell];
        uint32_t portal = c->portal_first + enf_test_below(&rng, c->portal_count);
        EnfVec3 stations[2] = {random_in_portal(&rng, map, portal), random_in_room(&rng, &rooms, map->portals[portal].target)};
        for (int s = 0; s < 2; s++) {
            EnfVec3 start = at;
            for (int k = 1; k <= 7; k++) {
                EnfVec3 next = k == 7 ? stations[s] : enf_add(start, enf_scale(enf_sub(stations[s], start), k / 7.0));
                cell = enf_map_track(map, cell, at, next);
                at = next;
            }
        }
        assert_int_equal(cell, map->portals[portal].target);
    }
    enf_rooms_destroy(&rooms);
}

/* ---- on the plane ----------------------------------------------------------------------------------------------- */

/* Two cells with an oblique doorway, far away; their origins differ, so their stored vertices do. */
typedef struct Doorway {
    EnfMaker *maker;
    const EnfMap *map;
    EnfVec3 points[4], normal; /* into cell 1 */
} Doorway;

static Doorway make_doorway(EnfVec3 o) {
    Doorway d = {enf_maker_create(), NULL, {{0, 0, 0}}, {0, 0, 0}};
    uint32_t a, b;
    enf_maker_cell(d.maker, "a", enf_sub(o, enf_v3(3.5, 1, 2.75)), &a);
    enf_maker_cell(d.maker, "b", enf_add(o, enf_v3(1.25, 0.5, 1)), &b);
    EnfVec3 along = enf_v3(1.2822265625, 0, 0.75146484375), up = enf_v3(0.1875, 2, 0);
    d.points[0] = o;
    d.points[1] = enf_add(o, up);
    d.points[2] = enf_add(enf_add(o, up), along);
    d.points[3] = enf_add(o, along);
    d.normal = enf_plane_from_polygon(d.points, 4).n;
    enf_maker_polygon(d.maker, a, 0, d.points, 4);
    enf_maker_polygon(d.maker, b, 0, d.points, 4);
    enf_maker_portal(d.maker, "doorway", a, b, d.points, 4, 0);
    EnfError error = {0};
    d.map = enf_maker_finish(d.maker, &error);
    if (!d.map) {
        fail_msg("%s", error.message);
    }
    return d;
}

/* Random steps to points on, just before and just behind the plane: wherever the side is beyond doubt, the cell is right. */
static void test_to_and_fro(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(4);
    const double offsets[] = {0, 0, 1e-300, -1e-300, 1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9, 1e-3, -1e-3, 0.5, -0.5};
    const EnfVec3 places[] = {{0, 0, 0}, {10000, -3, -20000}, {-1e6, 0, 1e6}};
    for (int place = 0; place < 3; place++) {
        Doorway d = make_doorway(places[place]);
        double doubt = place == 2 ? 1e-8 : 1e-10; /* doubles are this coarse there */
        EnfVec3 at = enf_add(enf_scale(enf_add(d.points[0], d.points[2]), 0.5), enf_scale(d.normal, -1.0));
        uint32_t cell = 0;
        for (uint32_t i = 0; i < enf_test_rounds(20000, 1000000); i++) {
            double offset = offsets[enf_test_below(&rng, sizeof offsets / sizeof *offsets)];
            double u = enf_test_double(&rng, 0.3, 0.7), v = enf_test_double(&rng, 0.3, 0.7);
            EnfVec3 next = enf_add(d.points[0], enf_add(enf_scale(enf_sub(d.points[3], d.points[0]), u),
                                                        enf_scale(enf_sub(d.points[1], d.points[0]), v)));
            next = enf_add(next, enf_scale(d.normal, offset));
            cell = enf_map_track(d.map, cell, at, next);
            at = next;
            if (fabs(offset) > doubt) {
                assert_int_equal(cell, offset > 0);
            }
        }
        enf_maker_destroy(d.maker);
    }
}

static void test_outside_stays(void **state) {
    (void)state;
    EnfRooms rooms = make_rooms(enf_rooms_def_default());
    EnfVec3 in = enf_v3(2, 1, 2), bad = enf_v3((double)NAN, 0, 0);
    assert_int_equal(enf_map_track(rooms.map, ENF_NONE, enf_v3(-5, 1, 2), in), ENF_NONE);
    assert_int_equal(enf_map_track(rooms.map, 99, in, in), ENF_NONE);
    assert_int_equal(enf_map_track(rooms.map, 0, in, bad), 0);
    enf_rooms_destroy(&rooms);
}

/* ---- transforms ------------------------------------------------------------------------------------------------- */

/* A corridor whose far end is its near end: a long step passes it again and again, a mirror is not walked through. */
static void test_teleport(void **state) {
    (void)state;
    EnfMaker *m = enf_maker_create();
    uint32_t hall, side;
    enf_maker_cell(m, "hall", enf_v3(0, 0, 0), &hall);
    enf_maker_cell(m, "side", enf_v3(0, 0, 0), &side);
    enf_maker_box(m, hall, 0, (EnfBox3){{0, 0, 0}, {4, 3, 4}}, true);
    enf_maker_box(m, side, 0, (EnfBox3){{100, 0, 0}, {104, 3, 4}}, true);
    const EnfVec3 east[4] = {{4, 0, 1}, {4, 2, 1}, {4, 2, 3}, {4, 0, 3}};         /* front +x, out of the hall */
    const EnfVec3 west[4] = {{100, 0, 3}, {100, 2, 3}, {100, 2, 1}, {100, 0, 1}}; /* front -x, out of the side room */
    const EnfVec3 end[4] = {{104, 0, 1}, {104, 2, 1}, {104, 2, 3}, {104, 0, 3}};
    EnfAffine there = enf_affine_identity(), back = there, ring = there, mirror = there;
    there.t = enf_v3(96, 0, 0);
    back.t = enf_v3(-96, 0, 0);
    ring.t = enf_v3(-4, 0, 0);
    mirror.m[8] = -1;
    uint32_t first = enf_maker_teleport(m, hall, side, east, 4, &there, ENF_NONE);
    enf_maker_teleport(m, side, hall, west, 4, &back, first);
    enf_maker_teleport(m, side, side, end, 4, &ring, ENF_NONE);
    const EnfVec3 glass[4] = {{1, 0, 0}, {1, 2, 0}, {3, 2, 0}, {3, 0, 0}}; /* front -z, out of the hall */
    enf_maker_teleport(m, hall, hall, glass, 4, &mirror, ENF_NONE);
    EnfError error = {0};
    const EnfMap *map = enf_maker_finish(m, &error);
    if (!map) {
        fail_msg("%s", error.message);
    }
    assert_int_equal(enf_map_track(map, hall, enf_v3(3, 1, 2), enf_v3(5, 1, 2)), side);
    assert_int_equal(enf_map_track(map, side, enf_v3(101, 1, 2), enf_v3(99, 1, 2)), hall);
    assert_int_equal(enf_map_track(map, hall, enf_v3(3, 1, 2), enf_v3(3.5, 1, 2)), hall);
    assert_int_equal(enf_map_track(map, hall, enf_v3(2, 1, 2), enf_v3(2, 1, -2)), hall);
    assert_int_equal(enf_map_track(map, hall, enf_v3(3, 1, 2), enf_v3(23, 1, 2)), side);
    assert_int_equal(enf_map_track(map, hall, enf_v3(3, 1, 2), enf_v3(1e9, 1, 2)), side); /* and it ends */
    enf_maker_destroy(m);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_one_door),   cmocka_unit_test(test_many_doors),    cmocka_unit_test(test_walk),
    cmocka_unit_test(test_to_and_fro), cmocka_unit_test(test_outside_stays), cmocka_unit_test(test_teleport),
};

ENF_TEST_MAIN(tests)
