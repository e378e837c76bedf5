/* The set of drawn objects is the same with volumes and without, at every tick, under every policy and update: with objects that move
 * by every kind of motion, teleport, spawn and die, and an eye that stands, walks and jumps. The oracle tests every object against
 * every window. */
#include "harness/harness.h"
#include "scenes/drawn.h"
#include "scenes/rooms.h"

#include <enfilade/dbv.h>
#include <enfilade/vis.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { OBJECTS = 300, KEYS = 6, VARIANTS = 6, POINTS = 4 };

static const EnfDbvDef variants[VARIANTS] = {
    {ENF_DBV_CONSTANT, ENF_DBV_LCA, 7, 1U << 30}, {ENF_DBV_ADAPTIVE, ENF_DBV_NAIVE, 4, 1U << 30},
    {ENF_DBV_MAXIMAL, ENF_DBV_LCA, 16, 1U << 30}, {ENF_DBV_OPTIMAL, ENF_DBV_LCA, 8, 1U << 30},
    {ENF_DBV_MAXIMAL, ENF_DBV_NAIVE, 16, 500},    {ENF_DBV_REACH, ENF_DBV_LCA, 16, 1U << 30},
};

/* An object's own arrays. */
typedef struct Mover {
    EnfObjectId id;
    float times[KEYS], values[KEYS * 3];
    EnfVec3 centre; /* of a free one's circle */
    double turn;
    EnfVec3 points[POINTS]; /* of a confined one's way there and back through a door */
    int64_t leg_ticks;
    bool small; /* its box fits through doors */
} Mover;

typedef struct Stage {
    EnfRooms rooms;
    EnfPortals portals;
    EnfVis *vis;
    EnfWorld *world;
    EnfDbvIndex *indices[VARIANTS];
    Mover movers[OBJECTS];
    EnfDrawnOracle oracle;
    uint64_t drawn, object_ticks;
} Stage;

static void open_stage(Stage *stage, uint64_t seed) {
    memset(stage, 0, sizeof *stage);
    EnfRoomsDef def = enf_rooms_def_default();
    def.nx = 6;
    def.nz = 5;
    def.seed = seed;
    def.door_percent = 70;
    EnfError error = {ENF_OK, 0, "", ""};
    assert_true(enf_rooms_create(&stage->rooms, &def, &error));
    assert_int_equal(enf_portals_create(&stage->portals, stage->rooms.map, NULL, &error), ENF_OK);
    assert_int_equal(enf_vis_create(&stage->vis, stage->rooms.map, NULL, &error), ENF_OK);
    assert_int_equal(enf_world_create(&stage->world, stage->rooms.map, 8, NULL, &error), ENF_OK);
    for (uint32_t v = 0; v < VARIANTS; v++) {
        assert_int_equal(enf_dbv_create(&stage->indices[v], stage->world, &variants[v], NULL, &error), ENF_OK);
    }
}

static void close_stage(Stage *stage) {
    enf_drawn_free(&stage->oracle);
    for (uint32_t v = 0; v < VARIANTS; v++) {
        enf_dbv_destroy(stage->indices[v]);
    }
    enf_world_destroy(stage->world);
    enf_vis_destroy(stage->vis);
    enf_portals_destroy(&stage->portals);
    enf_rooms_destroy(&stage->rooms);
}

/* ---- movers ----------------------------------------------------------------------------------------------------- */

static EnfVec3 random_place(EnfTestRng *rng) {
    return enf_v3(enf_test_double(rng, 0.3, 29.7), enf_test_double(rng, 0.2, 2.5), enf_test_double(rng, 0.3, 24.7));
}

/* A free object circles at 1 m/s; asked, it tells where it is. */
static EnfPose on_circle(const void *user, int64_t tick) {
    const Mover *mover = user;
    double angle = (double)tick / ENF_TICK_RATE / 2.0 + mover->turn;
    EnfPose pose = enf_pose_identity();
    pose.position = enf_add(mover->centre, enf_v3(2.0 * enf_cos(angle), 0.0, 2.0 * enf_sin(angle)));
    return pose;
}

/* A confined object goes straight from point to point, a leg in equal ticks. */
static EnfPose on_way(const void *user, int64_t tick) {
    const Mover *mover = user;
    int64_t once = (POINTS - 1) * mover->leg_ticks;
    int64_t at = tick % (2 * once);
    at = at > once ? 2 * once - at : at;
    int64_t leg = at / mover->leg_ticks < POINTS - 1 ? at / mover->leg_ticks : POINTS - 2;
    double share = (double)(at - leg * mover->leg_ticks) / (double)mover->leg_ticks;
    EnfVec3 a = mover->points[leg];
    EnfVec3 b = mover->points[leg + 1];
    EnfPose pose = enf_pose_identity();
    pose.position = enf_add(a, enf_scale(enf_sub(b, a), share));
    return pose;
}

static EnfVec3 random_in_room(const Stage *stage, EnfTestRng *rng, uint32_t cell) {
    EnfBox3 box = enf_rooms_box(&stage->rooms, cell);
    return enf_v3(enf_test_double(rng, box.min.x + 0.5, box.max.x - 0.5), 1.0,
                  enf_test_double(rng, box.min.z + 0.5, box.max.z - 0.5));
}

/* From a room through the middle of a door into the next, or only about the room. It is 0.4 m wide at most: it touches no wall. */
static void make_way(const Stage *stage, EnfTestRng *rng, Mover *mover, EnfFreeMotion *free) {
    const EnfMap *map = stage->rooms.map;
    uint32_t cell = enf_test_below(rng, map->cells_count);
    const EnfCell *c = &map->cells[cell];
    for (int i = 0; i < POINTS; i++) {
        mover->points[i] = random_in_room(stage, rng, cell);
    }
    if (c->portal_count > 0) {
        const EnfPortal *portal = &map->portals[c->portal_first + enf_test_below(rng, c->portal_count)];
        EnfVec3 middle = enf_v3(c->origin[0], 0.0, c->origin[2]);
        for (uint32_t v = 0; v < portal->vertex_count; v++) {
            EnfVec3 p = enf_v3_from_f(map->portal_vertices[portal->vertex_first + v]);
            middle = enf_add(middle, enf_scale(enf_v3(p.x, 0.0, p.z), 1.0 / (double)portal->vertex_count));
        }
        EnfVec3 to = random_in_room(stage, rng, portal->target);
        EnfVec3 box = enf_rooms_box(&stage->rooms, cell).min;
        EnfVec3 next = enf_rooms_box(&stage->rooms, portal->target).min;
        EnfVec3 out = enf_scale(enf_sub(next, box), 0.5 / enf_length(enf_sub(next, box)));
        middle.y = 1.0;
        mover->points[1] = enf_sub(middle, out);
        mover->points[2] = enf_add(middle, out);
        mover->points[3] = to;
    }
    double longest = 0.1;
    for (int i = 0; i + 1 < POINTS; i++) {
        longest = fmax(longest, enf_length(enf_sub(mover->points[i + 1], mover->points[i])));
    }
    mover->leg_ticks = (int64_t)(longest * ENF_TICK_RATE) + 1;
    free->max_speed = 1.02;
    free->ask = on_way;
    free->user = mover;
    free->confined = true;
}

static void make_path(EnfTestRng *rng, Mover *mover, EnfPathMotion *path) {
    path->rest = enf_pose_identity();
    path->wrap = (EnfWrap)enf_test_below(rng, 3);
    path->translation = (EnfTrack){(EnfPathKind)enf_test_below(rng, 2), KEYS, mover->times, mover->values};
    EnfVec3 at = random_place(rng);
    for (uint32_t k = 0; k < KEYS; k++) {
        mover->times[k] = 2.0F * (float)k;
        mover->values[3 * k] = (float)at.x;
        mover->values[3 * k + 1] = (float)at.y;
        mover->values[3 * k + 2] = (float)at.z;
        at = enf_test_chance(rng, 3) ? random_place(rng) : enf_add(at, enf_v3(enf_test_double(rng, -2, 2), 0.0, 0.5));
    }
    path->seconds = 2.0 * (KEYS - 1);
    path->period_ticks = 60 + enf_test_below(rng, 1200);
}

static EnfObjectDef random_object(const Stage *stage, EnfTestRng *rng, Mover *mover) {
    EnfObjectDef def = enf_object_def_default();
    int64_t tick = enf_world_tick(stage->world);
    double size = enf_test_chance(rng, 20) ? enf_test_double(rng, 1.0, 40.0) : enf_test_double(rng, 0.001, 0.6);
    def.local.min = enf_v3(-size, -0.5 * size, -size);
    def.local.max = enf_v3(size, size, 0.5 * size);
    mover->centre = random_place(rng);
    mover->turn = enf_test_double(rng, 0.0, 6.0);
    switch (enf_test_below(rng, 5)) {
    case 0:
        def.motion.kind = ENF_MOTION_PATH;
        make_path(rng, mover, &def.motion.as.path);
        def.motion.as.path.start_tick = tick;
        break;
    case 1:
        def.motion.kind = ENF_MOTION_FREE;
        def.motion.as.free.max_speed = 1.01;
        def.motion.as.free.ask = on_circle;
        def.motion.as.free.user = mover;
        enf_free_push(&def.motion, tick, on_circle(mover, tick));
        break;
    case 2:
        def.motion.kind = enf_test_chance(rng, 2) ? ENF_MOTION_HINGE : ENF_MOTION_SLIDE;
        def.motion.as.swing.rest = enf_pose_identity();
        def.motion.as.swing.rest.position = mover->centre;
        def.motion.as.swing.pivot = enf_add(mover->centre, enf_v3(0.5, 0.0, 0.0));
        def.motion.as.swing.axis = enf_v3(0.0, 1.0, 0.0);
        def.motion.as.swing.high = 1.5;
        def.motion.as.swing.rate = 2.0;
        break;
    case 3:
        def.motion.kind = ENF_MOTION_FREE;
        make_way(stage, rng, mover, &def.motion.as.free);
        def.local.min = enf_v3(-0.2, -0.5, -0.2);
        def.local.max = enf_v3(0.2, 0.5, 0.2);
        break;
    default:
        def.motion.as.still.position = mover->centre;
        break;
    }
    return def;
}

static void spawn(Stage *stage, EnfTestRng *rng, uint32_t i) {
    EnfObjectDef def = random_object(stage, rng, &stage->movers[i]);
    stage->movers[i].small = def.motion.kind == ENF_MOTION_FREE && def.motion.as.free.confined;
    stage->movers[i].id = enf_world_add(stage->world, &def, NULL);
    assert_int_not_equal(stage->movers[i].id.generation, 0);
}

/* A few events a tick: portals that open and close, doors that move, teleports, deaths and births. */
static void disturb(Stage *stage, EnfTestRng *rng) {
    uint32_t portal = enf_test_below(rng, stage->portals.count);
    enf_portals_set_open(&stage->portals, portal, enf_test_chance(rng, 2));
    for (uint32_t e = enf_test_below(rng, 4); e > 0; e--) {
        uint32_t i = enf_test_below(rng, OBJECTS);
        Mover *mover = &stage->movers[i];
        if (enf_test_chance(rng, 3)) {
            EnfObjectId dead = mover->id;
            assert_true(enf_world_remove(stage->world, dead));
            assert_false(enf_world_alive(stage->world, dead));
            spawn(stage, rng, i);
        } else {
            EnfObjectDef def = random_object(stage, rng, mover);
            if (def.motion.kind == ENF_MOTION_FREE) { /* it keeps its old size */
                def.motion.as.free.confined = def.motion.as.free.confined && mover->small;
            }
            assert_true(enf_world_set_motion(stage->world, mover->id, &def.motion));
            bool door = def.motion.kind == ENF_MOTION_HINGE || def.motion.kind == ENF_MOTION_SLIDE;
            assert_true(!door || enf_world_swing(stage->world, mover->id, enf_test_double(rng, 0.0, 1.5)));
        }
    }
}

/* ---- the oracle ------------------------------------------------------------------------------------------------- */

static void check_frame(Stage *stage, const EnfView *view) {
    EnfDrawnOracle *oracle = &stage->oracle;
    assert_true(enf_drawn_look(oracle, stage->vis, &stage->portals, view, stage->world));
    stage->drawn += oracle->drawn_count;
    stage->object_ticks += oracle->limit;
    for (uint32_t v = 0; v < VARIANTS; v++) {
        uint32_t object = enf_drawn_check(oracle, stage->indices[v]);
        if (object != ENF_NONE) {
            fail_msg("variant %u tick %lld: object %u is %s", v, (long long)enf_world_tick(stage->world), object,
                     object < oracle->limit && oracle->drawn[object] ? "visible and not listed" : "listed and not visible");
        }
    }
}

/* ---- the tests -------------------------------------------------------------------------------------------------- */

typedef enum Eye { EYE_STILL, EYE_WALKS, EYE_JUMPS } Eye;

static void move_eye(Stage *stage, EnfTestRng *rng, Eye eye, int64_t tick, EnfView *view) {
    EnfVec3 at = view->camera.eye_ws;
    if (eye == EYE_JUMPS || tick == 0) {
        at = enf_v3(enf_test_double(rng, 0.2, 29.8), 1.6, enf_test_double(rng, 0.2, 24.8));
    } else if (eye == EYE_WALKS) {
        double t = (double)tick / 400.0;
        at = enf_v3(15.0 + 14.0 * enf_sin(t), 1.6, 12.5 + 11.0 * enf_cos(1.7 * t));
    }
    double yaw = eye == EYE_STILL ? 40.0 : enf_test_double(rng, 0.0, 4.0) + (double)tick;
    view->camera = enf_camera(at, enf_turn(yaw, 0.0, 0.0), 75.0, 640, 480);
    view->cell = enf_rooms_cell_at(&stage->rooms, at);
}

static void run(Eye eye, uint64_t stream, uint32_t ticks) {
    Stage stage;
    EnfTestRng rng = enf_test_rng(stream);
    open_stage(&stage, enf_test_u64(&rng));
    for (uint32_t i = 0; i < OBJECTS; i++) {
        spawn(&stage, &rng, i);
    }
    EnfView view = enf_view_default();
    for (uint32_t t = 0; t < ticks; t++) {
        move_eye(&stage, &rng, eye, (int64_t)t, &view);
        check_frame(&stage, &view);
        enf_world_advance(stage.world, enf_test_chance(&rng, 50) ? (int64_t)enf_test_below(&rng, 100000) : 1);
        disturb(&stage, &rng);
    }
    assert_true(stage.drawn > 0);
    printf("%llu object-ticks a policy, %llu drawn\n", (unsigned long long)stage.object_ticks, (unsigned long long)stage.drawn);
    for (uint32_t v = 0; v < VARIANTS; v++) {
        assert_int_equal(enf_dbv_total_counters(stage.indices[v]).late, 0);
    }
    close_stage(&stage);
}

static void test_a_still_eye(void **state) {
    (void)state;
    run(EYE_STILL, 1, enf_test_rounds(400, 36000));
}

static void test_a_walking_eye(void **state) {
    (void)state;
    run(EYE_WALKS, 2, enf_test_rounds(400, 36000));
}

static void test_a_jumping_eye(void **state) {
    (void)state;
    run(EYE_JUMPS, 3, enf_test_rounds(400, 36000));
}

/* The traversal exposes as the windows do that it made. */
static void test_the_traversal_exposes(void **state) {
    (void)state;
    Stage stage;
    EnfTestRng rng = enf_test_rng(4);
    open_stage(&stage, 4);
    for (uint32_t i = 0; i < OBJECTS; i++) {
        spawn(&stage, &rng, i);
    }
    EnfView view = enf_view_default();
    for (uint32_t t = 0; t < 200; t++) {
        move_eye(&stage, &rng, EYE_WALKS, (int64_t)t, &view);
        assert_true(enf_drawn_look(&stage.oracle, stage.vis, &stage.portals, &view, stage.world));
        view.dbv = stage.indices[2];
        const EnfVisSet *set = enf_vis_run(stage.vis, &stage.portals, &view);
        assert_false(set->objects_failed);
        uint32_t object = enf_drawn_differs(&stage.oracle, set->objects, set->object_count);
        if (object != ENF_NONE) {
            fail_msg("tick %u: object %u differs (%u listed)", t, object, set->object_count);
        }
        enf_world_advance(stage.world, 1);
        disturb(&stage, &rng);
    }
    close_stage(&stage);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_a_still_eye),
    cmocka_unit_test(test_a_walking_eye),
    cmocka_unit_test(test_a_jumping_eye),
    cmocka_unit_test(test_the_traversal_exposes),
};

ENF_TEST_MAIN(tests)
