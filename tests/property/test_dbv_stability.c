/* Volumes at the ends of their ranges: periods from 1 tick to 10^9, worlds that have run for 10^9 ticks, speeds from 10^-6 to 10^3 m/s,
 * objects from a millimetre to larger than the block of rooms, volumes larger than the world, ten thousand objects at one point, and
 * all that 100 km from the world's origin. Drawn is what testing every object draws; nothing is late; who slept wakes where it would
 * be had it stepped every tick. DESIGN §5; PITFALLS 23. */
#include "harness/harness.h"
#include "harness/purse.h"
#include "scenes/drawn.h"
#include "scenes/rooms.h"

#include <enfilade/dbv.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POLICIES = 5, TRIALS = 24, FRAMES = 40, OBJECTS = 160, CROWD = 10000 };

static const int64_t old_age = 1000000000; /* ticks: half a year */

/* What one trial stretches. */
typedef struct Trial {
    EnfVec3 origin;        /* of the block of rooms */
    uint32_t period_ticks; /* of CONSTANT, the first of others */
    double least_speed, most_speed, least_size, most_size;
    uint32_t objects;
    bool one_point;    /* all objects at one place */
    int64_t age_ticks; /* the world's before the first frame */
    int64_t most_step; /* ticks between frames */
} Trial;

/* A free object: on a circle of `radius` about `centre`, `speed` along it. */
typedef struct Mover {
    EnfVec3 centre;
    double radius, speed, turn;
    float times[2], values[6]; /* of a path there and back */
} Mover;

typedef struct Stage {
    const Trial *trial;
    EnfRooms rooms;
    EnfPortals portals;
    EnfVis *vis;
    EnfWorld *world;
    EnfDbvIndex *indices[POLICIES];
    EnfDrawnOracle oracle;
    Mover *movers;
    EnfVec3 centre;
    uint64_t drawn;
} Stage;

/* 10^uniform: every decade alike. */
static double log_uniform(EnfTestRng *rng, double low, double high) {
    return pow(10.0, enf_test_double(rng, log10(low), log10(high)));
}

/* ---- objects ---------------------------------------------------------------------------------------------------- */

/* The angle is reduced before the sine is asked, in whole turns: after 10^9 ticks at 10^3 m/s it is large. */
static EnfPose on_circle(const void *user, int64_t tick) {
    const Mover *mover = user;
    double turns = mover->speed / (2.0 * ENF_PI * mover->radius) * ((double)tick / ENF_TICK_RATE) + mover->turn;
    double angle = (turns - floor(turns)) * 2.0 * ENF_PI;
    EnfPose pose = enf_pose_identity();
    pose.position = enf_add(mover->centre, enf_v3(mover->radius * enf_cos(angle), 0.0, mover->radius * enf_sin(angle)));
    return pose;
}

static void make_free(const Stage *stage, Mover *mover, EnfObjectDef *def) {
    def->motion.kind = ENF_MOTION_FREE;
    EnfFreeMotion *free_motion = &def->motion.as.free;
    /* Half as much again as it moves along its circle, and what doubles and the sine round off a place 100 km away. */
    double rounding = (enf_length(stage->trial->origin) + 100.0) * 1e-15 * ENF_TICK_RATE * 16.0;
    free_motion->max_speed = 1.5 * mover->speed + rounding + mover->radius * 1e-8 * (mover->speed > 1.0 ? ENF_TICK_RATE : 0.0);
    free_motion->ask = on_circle;
    free_motion->user = mover;
    enf_free_push(&def->motion, enf_world_tick(stage->world), on_circle(mover, enf_world_tick(stage->world)));
}

/* There and back along z, a pass in as many ticks as its speed wants. */
static void make_path(const Stage *stage, Mover *mover, EnfObjectDef *def) {
    def->motion.kind = ENF_MOTION_PATH;
    EnfPathMotion *path = &def->motion.as.path;
    *path = (EnfPathMotion){.rest = enf_pose_identity(), .wrap = ENF_WRAP_PING_PONG, .seconds = 1.0};
    double ticks = 8.0 / mover->speed * ENF_TICK_RATE;
    path->period_ticks = ticks < 1.0 ? 1U : ticks > 4e9 ? 4000000000U : (uint32_t)ticks;
    path->start_tick = -(int64_t)(mover->turn * (double)path->period_ticks);
    mover->times[1] = 1.0F;
    mover->values[5] = 8.0F;
    path->translation = (EnfTrack){ENF_PATH_LINEAR, 2, mover->times, mover->values};
    (void)stage;
}

static void spawn(Stage *stage, EnfTestRng *rng, Mover *mover) {
    const Trial *trial = stage->trial;
    EnfObjectDef def = enf_object_def_default();
    double size = log_uniform(rng, trial->least_size, trial->most_size);
    def.local.min = enf_v3(-size, -0.5 * size, -0.7 * size);
    def.local.max = enf_v3(size, 0.5 * size, 0.7 * size);
    EnfVec3 spread = enf_v3(enf_test_double(rng, -14, 14), enf_test_double(rng, -1.2, 1.2), enf_test_double(rng, -14, 14));
    mover->centre = trial->one_point ? enf_add(stage->centre, enf_v3(5.7, 0.1, 3.2)) : enf_add(stage->centre, spread);
    mover->radius = enf_test_double(rng, 0.5, 4.0);
    mover->turn = enf_test_double(rng, 0.0, 1.0);
    mover->speed = log_uniform(rng, trial->least_speed, trial->most_speed);
    /* A path's values are floats, so it stays where they are small. */
    bool far_off = enf_length(trial->origin) > 1000.0;
    if (enf_test_chance(rng, 3) && !far_off) {
        mover->values[0] = mover->values[3] = (float)mover->centre.x;
        mover->values[1] = mover->values[4] = (float)mover->centre.y;
        make_path(stage, mover, &def);
    } else {
        make_free(stage, mover, &def);
    }
    assert_int_not_equal(enf_world_add(stage->world, &def, NULL).generation, 0);
}

/* ---- the stage -------------------------------------------------------------------------------------------------- */

static void open_stage(Stage *stage, const Trial *trial, EnfTestRng *rng) {
    memset(stage, 0, sizeof *stage);
    stage->trial = trial;
    EnfRoomsDef def = enf_rooms_def_default();
    def.nx = def.nz = 6;
    def.origin = trial->origin;
    def.door_percent = 80;
    def.seed = enf_test_u64(rng);
    EnfError error = {ENF_OK, 0, "", ""};
    if (!enf_rooms_create(&stage->rooms, &def, &error)) {
        fail_msg("no rooms: %s", error.message);
    }
    stage->centre = enf_add(trial->origin, enf_v3(15.0, 1.5, 15.0));
    assert_int_equal(enf_portals_create(&stage->portals, stage->rooms.map, NULL, &error), ENF_OK);
    assert_int_equal(enf_vis_create(&stage->vis, stage->rooms.map, NULL, &error), ENF_OK);
    assert_int_equal(enf_world_create(&stage->world, stage->rooms.map, trial->objects, NULL, &error), ENF_OK);
    enf_world_advance(stage->world, trial->age_ticks);
    stage->movers = calloc(trial->objects, sizeof *stage->movers);
    assert_non_null(stage->movers);
    for (uint32_t i = 0; i < trial->objects; i++) {
        spawn(stage, rng, &stage->movers[i]);
    }
    for (uint32_t p = 0; p < POLICIES; p++) {
        EnfDbvDef dbv = {(EnfDbvPolicy)p, ENF_DBV_LCA, trial->period_ticks, 1U << 30};
        assert_int_equal(enf_dbv_create(&stage->indices[p], stage->world, &dbv, NULL, &error), ENF_OK);
    }
}

static void close_stage(Stage *stage) {
    for (uint32_t p = 0; p < POLICIES; p++) {
        enf_dbv_destroy(stage->indices[p]);
    }
    enf_drawn_free(&stage->oracle);
    enf_world_destroy(stage->world);
    enf_vis_destroy(stage->vis);
    enf_portals_destroy(&stage->portals);
    enf_rooms_destroy(&stage->rooms);
    free(stage->movers);
}

static void place_eye(const Stage *stage, EnfTestRng *rng, uint32_t frame, EnfView *view) {
    double angle = 0.05 * (double)frame;
    EnfVec3 way = enf_v3(9.0 * enf_cos(angle), enf_test_double(rng, -0.3, 0.3), 9.0 * enf_sin(angle));
    EnfVec3 eye = enf_add(stage->centre, way);
    EnfVec3 turn = enf_v3(enf_test_double(rng, 0.0, 360.0), enf_test_double(rng, -30, 30), enf_test_double(rng, -20, 20));
    view->camera = enf_camera(eye, enf_turn(turn.x, turn.y, turn.z), 75.0, 640, 480);
    view->cell = enf_rooms_cell_at(&stage->rooms, eye);
}

static void check_frame(Stage *stage, const EnfView *view) {
    assert_true(enf_drawn_look(&stage->oracle, stage->vis, &stage->portals, view, stage->world));
    stage->drawn += stage->oracle.drawn_count;
    for (uint32_t p = 0; p < POLICIES; p++) {
        uint32_t object = enf_drawn_check(&stage->oracle, stage->indices[p]);
        if (object != ENF_NONE) {
            const Trial *t = stage->trial;
            fail_msg("policy %u, tick %lld, object %u differs: origin %g, period %u, speed %g, age %lld", p,
                     (long long)enf_world_tick(stage->world), object, t->origin.x, t->period_ticks,
                     object < t->objects ? stage->movers[object].speed : 0.0, (long long)t->age_ticks);
        }
        assert_int_equal(enf_dbv_total_counters(stage->indices[p]).late, 0);
    }
}

static uint64_t run(const Trial *trial, EnfTestRng *rng, uint32_t frames) {
    Stage stage;
    open_stage(&stage, trial, rng);
    EnfView view = enf_view_default();
    for (uint32_t frame = 0; frame < frames; frame++) {
        place_eye(&stage, rng, frame, &view);
        check_frame(&stage, &view);
        bool leap = enf_test_chance(rng, 4);
        int64_t most = trial->most_step;
        enf_world_advance(stage.world, leap ? (int64_t)enf_test_below(rng, (uint32_t)most) + 1 : 1);
    }
    uint64_t drawn = stage.drawn;
    close_stage(&stage);
    return drawn;
}

/* ---- the tests -------------------------------------------------------------------------------------------------- */

static const Trial plain = {{0, 0, 0}, 16, 0.1, 3.0, 0.05, 0.5, OBJECTS, false, 0, 100};

static void test_periods(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    for (uint32_t period = 1; period <= 1000000000U; period *= 10) {
        Trial trial = plain;
        trial.period_ticks = period;
        trial.most_step = 3000;
        assert_true(run(&trial, &rng, enf_test_rounds(FRAMES, 10 * FRAMES)) > 0);
    }
}

static void test_an_old_world(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    Trial trial = plain;
    trial.age_ticks = old_age;
    assert_true(run(&trial, &rng, enf_test_rounds(FRAMES, 10 * FRAMES)) > 0);
    trial.age_ticks = 0;
    trial.most_step = 100000000; /* ages while it is watched: a quarter of the frames leaps half a hundred million ticks */
    assert_true(run(&trial, &rng, 2 * FRAMES) > 0);
}

static void test_speeds_and_sizes(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(3);
    Trial trial = plain;
    trial.least_speed = 1e-6;
    trial.most_speed = 1e3;
    trial.least_size = 1e-3;
    trial.most_size = 60.0; /* the block is 30 m wide */
    trial.most_step = 1000000;
    assert_true(run(&trial, &rng, enf_test_rounds(3 * FRAMES, 30 * FRAMES)) > 0);
}

/* At 10^3 m/s for 10^9 ticks a volume is tens of millions of kilometres wide: it meets every window, and is no number that
 * overflows. */
static void test_volumes_larger_than_the_world(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(4);
    Trial trial = plain;
    trial.least_speed = trial.most_speed = 1e3;
    trial.period_ticks = 1000000000;
    assert_true(run(&trial, &rng, enf_test_rounds(FRAMES, 10 * FRAMES)) > 0);
}

static void test_a_crowd_at_one_point(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(5);
    Trial trial = plain;
    trial.objects = CROWD;
    trial.one_point = true;
    assert_true(run(&trial, &rng, enf_test_rounds(2 * FRAMES, 10 * FRAMES)) > 0);
}

static void test_far_from_the_origin(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(6);
    for (uint32_t corner = 0; corner < 4; corner++) {
        Trial trial = plain;
        trial.origin = enf_v3(corner & 1 ? 1e5 : -1e5, corner & 1 ? -1e5 : 1e5, corner & 2 ? 1e5 : -1e5);
        trial.least_speed = 1e-6;
        assert_true(run(&trial, &rng, enf_test_rounds(FRAMES, 10 * FRAMES)) > 0);
    }
}

static void test_everything_at_random(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(7);
    uint64_t drawn = 0;
    for (uint32_t i = 0; i < enf_test_rounds(TRIALS, 20 * TRIALS); i++) {
        double away = enf_test_chance(&rng, 2) ? 0.0 : log_uniform(&rng, 1.0, 1e5);
        Trial trial = {.origin = enf_v3(away, -0.3 * away, enf_test_chance(&rng, 2) ? away : -away),
                       .period_ticks = (uint32_t)log_uniform(&rng, 1.0, 1e9),
                       .least_speed = 1e-6,
                       .most_speed = log_uniform(&rng, 1e-5, 1e3),
                       .least_size = 1e-3,
                       .most_size = log_uniform(&rng, 1e-2, 60.0),
                       .objects = 1 + enf_test_below(&rng, OBJECTS),
                       .one_point = enf_test_chance(&rng, 5),
                       .age_ticks = (int64_t)log_uniform(&rng, 1.0, 1e9),
                       .most_step = (int64_t)log_uniform(&rng, 1.0, 1e8)};
        drawn += run(&trial, &rng, FRAMES);
    }
    assert_true(drawn > 0);
}

/* Two worlds with the same objects: one asks for every state at every tick, the other at random ticks only. */
static void test_who_slept_wakes_where_it_would_be(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(8);
    Trial trial = plain;
    trial.least_speed = 1e-6;
    trial.most_speed = 1e3;
    Stage awake, asleep;
    EnfTestRng again = rng;
    open_stage(&awake, &trial, &rng);
    open_stage(&asleep, &trial, &again);
    uint64_t compared = 0;
    for (int64_t tick = 0; tick < (int64_t)enf_test_rounds(2000, 50000); tick++) {
        for (uint32_t i = 0; i < trial.objects; i++) {
            EnfPose stepped = enf_world_pose(awake.world, i);
            if (enf_test_chance(&rng, 200)) {
                EnfPose woken = enf_world_pose(asleep.world, i);
                assert_memory_equal(&stepped, &woken, sizeof stepped);
                compared++;
            }
        }
        enf_world_advance(awake.world, 1);
        enf_world_advance(asleep.world, 1);
    }
    assert_true(compared > 0);
    close_stage(&awake);
    close_stage(&asleep);
}

/* Has no volume ended? What touches no room has none. */
static void check_all_wait(const EnfDbvIndex *index, const EnfWorld *world) {
    uint32_t waiting = 0;
    for (uint32_t i = 0; i < enf_world_object_limit(world); i++) {
        EnfBox3f volume;
        int64_t expiry = INT64_MIN;
        if (enf_dbv_volume(index, i, &volume, &expiry)) {
            assert_true(expiry >= enf_world_tick(world));
            waiting++;
        }
    }
    assert_true(waiting > enf_world_object_limit(world) / 2);
}

/* Thousands are due at once, and there is no memory for the list of them: the frame says so, and when there is memory again nobody was
 * forgotten. */
static void test_memory_runs_out_when_all_are_due(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(9);
    Trial trial = plain;
    trial.objects = 6000;
    Stage stage;
    open_stage(&stage, &trial, &rng);
    for (uint32_t p = 0; p < POLICIES; p++) {
        Purse purse = purse_with(PURSE_FULL);
        EnfAllocator allocator = purse_allocator(&purse);
        EnfDbvDef def = {(EnfDbvPolicy)p, ENF_DBV_LCA, 64, 256};
        EnfDbvIndex *index = NULL;
        EnfError error = {ENF_OK, 0, "", ""};
        uint32_t count = 0;
        assert_int_equal(enf_dbv_create(&index, stage.world, &def, &allocator, &error), ENF_OK);
        assert_int_equal(enf_dbv_begin(index, &error), ENF_OK);
        (void)enf_dbv_end(index, &count);
        enf_world_advance(stage.world, 1000);
        purse.budget = 0;
        assert_int_equal(enf_dbv_begin(index, &error), ENF_ERROR_MEMORY);
        assert_true(purse.refused > 0);
        (void)enf_dbv_end(index, &count);
        purse.budget = PURSE_FULL;
        enf_world_advance(stage.world, 1);
        assert_int_equal(enf_dbv_begin(index, &error), ENF_OK);
        (void)enf_dbv_end(index, &count);
        check_all_wait(index, stage.world);
        enf_dbv_destroy(index);
        purse_assert_whole(&purse);
    }
    close_stage(&stage);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_periods),
    cmocka_unit_test(test_an_old_world),
    cmocka_unit_test(test_speeds_and_sizes),
    cmocka_unit_test(test_volumes_larger_than_the_world),
    cmocka_unit_test(test_a_crowd_at_one_point),
    cmocka_unit_test(test_far_from_the_origin),
    cmocka_unit_test(test_everything_at_random),
    cmocka_unit_test(test_who_slept_wakes_where_it_would_be),
    cmocka_unit_test(test_memory_runs_out_when_all_are_due),
};

ENF_TEST_MAIN(tests)
