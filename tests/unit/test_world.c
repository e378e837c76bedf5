/* Portal state: derived planes, opening and closing, moving, bent polygons. */
#include "harness/harness.h"
#include "scenes/everything.h"

#include <enfilade/tolerances.h>
#include <enfilade/world.h>

#include <math.h>

typedef struct Pair {
    EnfMaker *maker;
    EnfPortals portals;
    uint32_t there, back; /* half-portals */
} Pair;

/* Two rooms of 4 m side by side; `bend` moves one corner of the opening out of its plane. */
static void open_pair(Pair *pair, double bend) {
    EnfError error = {ENF_OK, 0, "", ""};
    pair->maker = enf_maker_create();
    assert_non_null(pair->maker);
    uint32_t a = 0;
    uint32_t b = 0;
    assert_non_null(enf_maker_cell(pair->maker, "a-room", enf_v3(0.0, 0.0, 0.0), &a));
    EnfBox3 left = {{0, 0, 0}, {4, 3, 4}};
    enf_maker_box(pair->maker, a, 0, left, true);
    assert_non_null(enf_maker_cell(pair->maker, "b-room", enf_v3(4.0, 0.0, 0.0), &b));
    EnfBox3 right = {{4, 0, 0}, {8, 3, 4}};
    enf_maker_box(pair->maker, b, 0, right, true);
    const EnfVec3 points[4] = {{4, 0, 1}, {4, 2, 1}, {4 + bend, 2, 2}, {4, 0, 2}};
    uint32_t number = enf_maker_portal(pair->maker, "b*1-portal", a, b, points, 4, 0);
    const EnfMap *map = enf_maker_finish(pair->maker, &error);
    if (map == NULL) {
        fail_msg("%s", error.message);
        return;
    }
    assert_int_equal(enf_portals_create(&pair->portals, map, NULL, &error), ENF_OK);
    pair->there = enf_maker_half(pair->maker, number, 0);
    pair->back = enf_maker_half(pair->maker, number, 1);
}

static void close_pair(Pair *pair) {
    enf_portals_destroy(&pair->portals);
    enf_maker_destroy(pair->maker);
}

static void test_planes_point_out(void **state) {
    (void)state;
    Pair pair;
    open_pair(&pair, 0.0);
    const EnfPortalState *there = &pair.portals.states[pair.there];
    const EnfPortalState *back = &pair.portals.states[pair.back];
    assert_true(there->normal.x == 1.0 && there->d == -4.0); /* relative to a's origin */
    assert_true(back->normal.x == -1.0 && back->d == 0.0);   /* relative to b's */
    assert_true((double)there->slab >= ENF_GRID_STEP && (double)there->slab < 2.0 * ENF_GRID_STEP);
    assert_int_equal(there->flags & ENF_PORTAL_NONPLANAR, 0);
    close_pair(&pair);
}

/* ENF_TOL_PORTAL_FLAT: what snapping does to a flat polygon keeps its facing test, a bend loses it. */
static void test_bent_portals_have_no_side(void **state) {
    (void)state;
    Pair pair;
    open_pair(&pair, ENF_GRID_STEP);
    assert_int_equal(pair.portals.states[pair.there].flags & ENF_PORTAL_NONPLANAR, 0);
    close_pair(&pair);
    open_pair(&pair, 128.0 * ENF_GRID_STEP);
    assert_int_not_equal(pair.portals.states[pair.there].flags & ENF_PORTAL_NONPLANAR, 0);
    assert_int_not_equal(pair.portals.states[pair.back].flags & ENF_PORTAL_NONPLANAR, 0);
    close_pair(&pair);
}

static void test_twins_open_and_close_together(void **state) {
    (void)state;
    Pair pair;
    open_pair(&pair, 0.0);
    assert_true(enf_portals_is_open(&pair.portals, pair.there));
    enf_portals_set_open(&pair.portals, pair.back, false);
    assert_false(enf_portals_is_open(&pair.portals, pair.there));
    assert_false(enf_portals_is_open(&pair.portals, pair.back));
    enf_portals_set_open(&pair.portals, pair.there, true);
    assert_true(enf_portals_is_open(&pair.portals, pair.back));
    close_pair(&pair);
}

static void test_moving_moves_both_halves(void **state) {
    (void)state;
    Pair pair;
    open_pair(&pair, 0.0);
    const EnfVec3 points[4] = {{4.5, 0, 1}, {4.5, 2, 1}, {4.5, 2, 2}, {4.5, 0, 2}};
    enf_portals_move(&pair.portals, pair.there, points);
    const EnfPortalState *there = &pair.portals.states[pair.there];
    const EnfPortalState *back = &pair.portals.states[pair.back];
    assert_true(there->d == -4.5 && back->d == 0.5 && back->normal.x == -1.0);
    const EnfVec3 bent[4] = {{4.5, 0, 1}, {4.5, 2, 1}, {4.9, 2, 2}, {4.5, 0, 2}};
    enf_portals_move(&pair.portals, pair.there, bent);
    assert_int_not_equal(there->flags & ENF_PORTAL_NONPLANAR, 0);
    enf_portals_move(&pair.portals, pair.there, points); /* flat again: the flag goes */
    assert_int_equal(there->flags & ENF_PORTAL_NONPLANAR, 0);
    close_pair(&pair);
}

/* Every mover of the map becomes the object of its number, with its mesh's box and its entity's pose. */
static void test_a_map_populates_its_world(void **state) {
    (void)state;
    EnfMaker *maker = enf_everything_create(NULL);
    assert_non_null(maker);
    const EnfMap *map = enf_maker_map(maker);
    EnfWorld *world = NULL;
    assert_int_equal(enf_world_create(&world, map, 1, NULL, NULL), ENF_OK);
    assert_int_equal(enf_world_populate(world, NULL), ENF_OK);
    assert_int_equal(enf_world_object_limit(world), map->movers_count);
    for (uint32_t i = 0; i < map->movers_count; i++) {
        EnfBox3f box = enf_world_box(world, i);
        assert_int_equal(enf_world_mesh(world, i), map->movers[i].mesh);
        float at = i == 1 ? 0.0F : 1.0F; /* a path's translation replaces the entity's */
        assert_true(box.min.x <= at && box.max.x >= at && box.min.y <= at && box.max.y > at);
    }
    assert_true(enf_world_is_free(world, 5));
    /* Mover 1 goes from 0 to 2 m along y in the first second, relative to the world, and back in the next. */
    enf_world_advance(world, ENF_TICK_RATE);
    assert_true(fabs(enf_world_pose(world, 1).position.y - 2.0) < 1e-6);
    enf_world_advance(world, ENF_TICK_RATE / 2);
    assert_true(fabs(enf_world_pose(world, 1).position.y - 1.0) < 1e-6);
    assert_true(enf_world_swing(world, enf_world_object(world, 3), 9.0)); /* the hinge stops at its end */
    enf_world_advance(world, 10 * ENF_TICK_RATE);
    EnfBox3f open = enf_world_box(world, 3);
    assert_true(open.max.x > 1.9F && open.max.z < 1.3F);
    enf_world_destroy(world);
    enf_maker_destroy(maker);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_a_map_populates_its_world), cmocka_unit_test(test_planes_point_out),
    cmocka_unit_test(test_bent_portals_have_no_side), cmocka_unit_test(test_twins_open_and_close_together),
    cmocka_unit_test(test_moving_moves_both_halves),
};

ENF_TEST_MAIN(tests)
