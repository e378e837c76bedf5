/* Trails: with them a box holds an object where it is and where it was one tick ago, what was set in this tick does not smear, and the
 * objects drawn are the same with volumes and without, under every policy. */
#include "harness/harness.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/drawn.h"
#include "scenes/moving_rooms.h"

enum { POLICIES = 7 };

static const EnfDbvDef policies[POLICIES] = {
    {ENF_DBV_CONSTANT, ENF_DBV_LCA, 7, 1U << 30}, {ENF_DBV_ADAPTIVE, ENF_DBV_NAIVE, 4, 1U << 30},
    {ENF_DBV_MAXIMAL, ENF_DBV_LCA, 16, 1U << 30}, {ENF_DBV_OPTIMAL, ENF_DBV_LCA, 8, 1U << 30},
    {ENF_DBV_REACH, ENF_DBV_LCA, 16, 1U << 30},   {ENF_DBV_CONSTANT, ENF_DBV_NAIVE, 1, 1U << 30},
    {ENF_DBV_MAXIMAL, ENF_DBV_LCA, 3, 3},
};

static void create(EnfMovingRooms *moving, EnfTestRng *rng) {
    EnfMovingRoomsDef def = enf_moving_rooms_def_default();
    EnfError error = {0};
    def.trail = true;
    def.rooms.seed = enf_test_u64(rng);
    if (!enf_moving_rooms_create(moving, &def, &error)) {
        fail_msg("%s", error.message);
    }
}

/* ---- boxes ------------------------------------------------------------------------------------------------------ */

static void check_inside(EnfBox3f box, const EnfBox3 *local, const EnfPose *pose) {
    EnfBox3 outer = enf_box3_from_f(box);
    for (int i = 0; i < 8; i++) {
        EnfVec3 corner = enf_v3(i & 1 ? local->max.x : local->min.x, i & 2 ? local->max.y : local->min.y,
                                i & 4 ? local->max.z : local->min.z);
        assert_true(enf_box3_contains(outer, enf_pose_point(pose, corner)));
    }
}

static bool has_changed(const EnfWorld *world, uint32_t object) {
    uint32_t count;
    const uint32_t *changes = enf_world_changes(world, &count);
    for (uint32_t i = 0; i < count; i++) {
        if (changes[i] == object) {
            return true;
        }
    }
    return false;
}

static EnfBox3 local_of(const EnfMovingRooms *moving, uint32_t object) {
    const EnfMesh *mesh = &moving->rooms.map->meshes[enf_world_mesh(moving->world, object)];
    EnfBox3 local = {{(double)mesh->min[0], (double)mesh->min[1], (double)mesh->min[2]},
                     {(double)mesh->max[0], (double)mesh->max[1], (double)mesh->max[2]}};
    return local;
}

/* `before`: where it was when the last tick was the world's; false if it did not live. */
static void check_object(const EnfMovingRooms *moving, uint32_t object, const EnfPose *before) {
    EnfWorld *world = moving->world;
    EnfPose now = enf_world_pose(world, object), last;
    EnfBox3 local = local_of(moving, object);
    EnfBox3f box = enf_world_seen_box(world, object), bound = enf_world_bound(world, object, enf_world_tick(world) + 9);
    EnfBox3f alone = enf_world_box(world, object);
    bool trails = enf_world_last_pose(world, object, &last);
    assert_int_equal(trails, !has_changed(world, object));
    check_inside(box, &local, &now);
    check_inside(box, &local, &last);
    check_inside(bound, &local, &now);
    check_inside(bound, &local, &last);
    if (trails) {
        assert_memory_equal(&last, before, sizeof last);
    } else {
        assert_memory_equal(&last, &now, sizeof last);
        assert_memory_equal(&alone, &box, sizeof box);
    }
    enf_world_set_trail(world, false); /* what a simulation reads is the same with trails and without */
    EnfBox3f without = enf_world_box(world, object), seen = enf_world_seen_box(world, object);
    enf_world_set_trail(world, true);
    assert_memory_equal(&alone, &without, sizeof alone);
    assert_memory_equal(&alone, &seen, sizeof alone);
}

static void boxes_hold_the_tick_before(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    EnfMovingRooms moving;
    create(&moving, &rng);
    uint32_t limit = enf_world_object_limit(moving.world);
    EnfPose *before = calloc(limit, sizeof *before);
    assert_non_null(before);
    for (uint32_t tick = 0; tick < enf_test_rounds(200, 5000); tick++) {
        for (uint32_t i = 0; i < limit; i++) {
            if (enf_world_object(moving.world, i).generation != 0) {
                before[i] = enf_world_pose(moving.world, i);
            }
        }
        enf_moving_rooms_step(&moving);
        assert_int_equal(enf_world_object_limit(moving.world), limit);
        for (uint32_t i = 0; i < limit; i++) {
            if (enf_world_object(moving.world, i).generation != 0) {
                check_object(&moving, i, &before[i]);
            }
        }
    }
    free(before);
    enf_moving_rooms_destroy(&moving);
}

/* A walker that is pushed from tick to tick: blended from where it was; nobody is told while it keeps its speed, and volumes made
 * before hold it. */
static void what_is_pushed_walks(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(3);
    EnfMovingRooms moving;
    create(&moving, &rng);
    EnfWorld *world = moving.world;
    EnfObjectDef def = enf_object_def_default();
    def.motion.kind = ENF_MOTION_FREE;
    def.motion.as.free.pose = enf_pose_identity();
    def.motion.as.free.pose.position = enf_v3(7.0, 1.0, 7.0);
    def.motion.as.free.max_speed = 1.5;
    EnfObjectId id = enf_world_add(world, &def, NULL);
    assert_true(id.generation != 0);
    EnfBox3 volume = enf_box3_empty();
    int64_t until = 0;
    EnfPose pose = def.motion.as.free.pose, last, before = pose;
    for (uint32_t tick = 0; tick < enf_test_rounds(2000, 200000); tick++) {
        enf_world_advance(world, 1);
        if (enf_world_tick(world) >= until) {
            until = enf_world_tick(world) + 1 + enf_test_below(&rng, 100);
            volume = enf_box3_from_f(enf_world_bound(world, id.index, until));
        }
        bool leaps = tick % 97 == 96;
        double way = leaps ? 1.0 : 1.4 / ENF_TICK_RATE;
        pose.position = enf_add(pose.position, enf_v3(enf_test_double(&rng, -way, way), 0.0, enf_test_double(&rng, -way, way)));
        pose.position.x = pose.position.x < 1.0 ? 1.0 : pose.position.x;
        assert_true(enf_world_push(world, id, &pose));
        assert_true(enf_world_last_pose(world, id.index, &last));
        assert_memory_equal(&last, &before, sizeof last);
        if (has_changed(world, id.index)) {
            assert_true(leaps); /* a leap may also be a short one */
            volume = enf_box3_from_f(enf_world_bound(world, id.index, until));
        }
        EnfBox3 box = enf_box3_from_f(enf_world_seen_box(world, id.index));
        assert_true(enf_box3_contains(volume, box.min) && enf_box3_contains(volume, box.max));
        before = pose;
    }
    enf_world_remove(world, id);
    assert_false(enf_world_push(world, id, &pose));
    assert_false(enf_world_push(world, enf_world_object(world, 0), &pose)); /* a door */
    enf_moving_rooms_destroy(&moving);
}

/* ---- volumes ---------------------------------------------------------------------------------------------------- */

/* Stands, walks to and fro, or jumps. */
static EnfView next_view(const EnfMovingRooms *moving, EnfTestRng *rng, uint32_t tick, const EnfView *last) {
    EnfView view = *last;
    if (tick % 50 == 0) {
        EnfBox3 room = enf_rooms_box(&moving->rooms, enf_test_below(rng, moving->rooms.map->cells_count));
        EnfVec3 eye = enf_v3(enf_test_double(rng, room.min.x + 0.2, room.max.x - 0.2), 1.5,
                             enf_test_double(rng, room.min.z + 0.2, room.max.z - 0.2));
        view.camera = enf_camera(eye, enf_turn(enf_test_double(rng, -180.0, 180.0), 0.0, 0.0), 75.0, 320, 240);
    } else if (tick / 50 % 2) {
        EnfVec3 ahead = enf_add(view.camera.eye_ws, enf_scale(view.camera.forward, 0.05));
        view.camera.eye_ws = enf_rooms_cell_at(&moving->rooms, ahead) == ENF_NONE ? view.camera.eye_ws : ahead;
    }
    view.cell = enf_rooms_cell_at(&moving->rooms, view.camera.eye_ws);
    return view;
}

static void drawn_sets_are_those_of_testing_all(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    EnfMovingRooms moving;
    create(&moving, &rng);
    EnfVis *vis;
    EnfDbvIndex *indices[POLICIES];
    EnfDrawnOracle oracle = {0};
    assert_int_equal(enf_vis_create(&vis, moving.rooms.map, NULL, NULL), ENF_OK);
    for (uint32_t i = 0; i < POLICIES; i++) {
        assert_int_equal(enf_dbv_create(&indices[i], moving.world, &policies[i], NULL, NULL), ENF_OK);
    }
    EnfView view = enf_view_default();
    uint64_t drawn = 0;
    for (uint32_t tick = 0; tick < enf_test_rounds(1500, 40000); tick++) {
        enf_moving_rooms_step(&moving);
        view = next_view(&moving, &rng, tick, &view);
        assert_true(enf_drawn_look(&oracle, vis, &moving.portals, &view, moving.world));
        drawn += oracle.drawn_count;
        for (uint32_t i = 0; i < POLICIES; i++) {
            uint32_t object = enf_drawn_check(&oracle, indices[i]);
            if (object != ENF_NONE) {
                fail_msg("tick %u, policy %u: object %u is drawn by one and not by the other", tick, i, object);
            }
        }
    }
    assert_true(drawn > 1000);
    for (uint32_t i = 0; i < POLICIES; i++) {
        assert_int_equal(enf_dbv_total_counters(indices[i]).late, 0);
        enf_dbv_destroy(indices[i]);
    }
    enf_drawn_free(&oracle);
    enf_vis_destroy(vis);
    enf_moving_rooms_destroy(&moving);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(boxes_hold_the_tick_before),
    cmocka_unit_test(what_is_pushed_walks),
    cmocka_unit_test(drawn_sets_are_those_of_testing_all),
};

ENF_TEST_MAIN(tests)
