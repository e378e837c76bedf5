/* Real motion: movers of real levels along their recorded walks, the monsters of a real game with its player's own eye, and recorded
 * pedestrians. Under every policy, and whether a path is known or only a largest speed, what is drawn is what testing every object
 * draws, and nothing is late; the share of objects that no frame touched is printed. */
#include "common/mover_csv.h"
#include "common/path_csv.h"
#include "harness/program.h"
#include "scenes/drawn.h"
#include "scenes/rooms.h"

#include <enfilade/dbv.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POLICIES = 5, OBJECTS_MAX = 512 };

/* ---- recorded objects ------------------------------------------------------------------------------------------- */

/* The same motion twice: as a path, and as something of which only a largest speed is known. */
typedef struct Recorded {
    EnfMotion path;
    double max_speed;
} Recorded;

typedef struct Cast {
    EnfMoverCsv csv;
    Recorded objects[OBJECTS_MAX];
    uint32_t count;
} Cast;

/* States are only ever asked at ticks, so the largest step between two is the largest speed. */
static double largest_speed(const EnfMotion *path) {
    double speed = 0.0;
    EnfPose before = enf_motion_state(path, 0);
    for (int64_t tick = 1; tick <= (int64_t)path->as.path.period_ticks; tick++) {
        EnfPose now = enf_motion_state(path, tick);
        speed = fmax(speed, enf_length(enf_sub(now.position, before.position)) * ENF_TICK_RATE);
        before = now;
    }
    return speed * 1.001 + 1e-6;
}

/* There and back along each object's points; `shift` is added to them. */
static void read_cast(Cast *cast, const char *file_name, EnfVec3 shift, bool smooth) {
    EnfError error = {0};
    if (enf_mover_csv_read(&cast->csv, file_name, &error)) {
        fail_msg("%s", error.message);
    }
    assert_in_range(cast->csv.count, 1, OBJECTS_MAX);
    cast->count = cast->csv.count;
    for (uint32_t i = 0; i < cast->count; i++) {
        EnfMoverRows *rows = &cast->csv.objects[i];
        for (uint32_t k = 0; k < rows->count; k++) {
            rows->points[3 * k] += (float)shift.x;
            rows->points[3 * k + 1] += (float)shift.y;
            rows->points[3 * k + 2] += (float)shift.z;
        }
        assert_true(enf_mover_csv_motion(rows, smooth, ENF_WRAP_PING_PONG, &cast->objects[i].path));
        cast->objects[i].max_speed = largest_speed(&cast->objects[i].path);
    }
}

static void free_cast(Cast *cast) {
    enf_mover_csv_free(&cast->csv);
    free(cast);
}

/* ---- the stage -------------------------------------------------------------------------------------------------- */

typedef struct Stage {
    const EnfMap *map;
    EnfPortals portals;
    EnfVis *vis;
    EnfWorld *worlds[2]; /* paths known; only speeds known */
    EnfDbvIndex *indices[2][POLICIES];
    EnfDrawnOracle oracle;
    uint64_t frames, drawn;
} Stage;

static EnfPose ask_recorded(const void *user, int64_t tick) {
    return enf_motion_state(&((const Recorded *)user)->path, tick);
}

static void add_object(Stage *stage, Recorded *object) {
    EnfObjectDef def = enf_object_def_default();
    def.local.min = enf_v3(-0.4, 0.0, -0.4);
    def.local.max = enf_v3(0.4, 1.75, 0.4);
    def.max_speed = object->max_speed;
    def.motion = object->path;
    assert_int_not_equal(enf_world_add(stage->worlds[0], &def, NULL).generation, 0);
    memset(&def.motion, 0, sizeof def.motion);
    def.motion.kind = ENF_MOTION_FREE;
    def.motion.as.free.max_speed = object->max_speed;
    def.motion.as.free.ask = ask_recorded;
    def.motion.as.free.user = object;
    enf_free_push(&def.motion, 0, ask_recorded(object, 0));
    assert_int_not_equal(enf_world_add(stage->worlds[1], &def, NULL).generation, 0);
}

static void open_stage(Stage *stage, const EnfMap *map, Cast *cast) {
    memset(stage, 0, sizeof *stage);
    stage->map = map;
    assert_int_equal(enf_portals_create(&stage->portals, map, NULL, NULL), ENF_OK);
    assert_int_equal(enf_vis_create(&stage->vis, map, NULL, NULL), ENF_OK);
    for (int w = 0; w < 2; w++) {
        assert_int_equal(enf_world_create(&stage->worlds[w], map, cast->count, NULL, NULL), ENF_OK);
    }
    for (uint32_t i = 0; i < cast->count; i++) {
        add_object(stage, &cast->objects[i]);
    }
    for (int w = 0; w < 2; w++) {
        for (uint32_t p = 0; p < POLICIES; p++) {
            EnfDbvDef def = enf_dbv_def_default();
            def.policy = (EnfDbvPolicy)p;
            assert_int_equal(enf_dbv_create(&stage->indices[w][p], stage->worlds[w], &def, NULL, NULL), ENF_OK);
        }
    }
}

/* Drawn sets of the two worlds are the same, as the motions are; each is compared with its own oracle. */
static void frame(Stage *stage, int64_t tick, const EnfView *view) {
    for (int w = 0; w < 2; w++) {
        enf_world_advance(stage->worlds[w], tick - enf_world_tick(stage->worlds[w]));
        assert_true(enf_drawn_look(&stage->oracle, stage->vis, &stage->portals, view, stage->worlds[w]));
        for (uint32_t p = 0; p < POLICIES; p++) {
            uint32_t object = enf_drawn_check(&stage->oracle, stage->indices[w][p]);
            if (object != ENF_NONE) {
                fail_msg("%s, policy %u, tick %lld: object %u differs", w ? "speeds known" : "paths known", p, (long long)tick,
                         object);
            }
        }
    }
    stage->frames++;
    stage->drawn += stage->oracle.drawn_count;
}

static void close_stage(Stage *stage, const char *what, const Cast *cast) {
    static const char *const names[POLICIES] = {"constant", "adaptive", "maximal", "optimal", "reach"};
    printf("%s: %u objects, %llu frames, %llu drawn; share avoided, paths / speeds:", what, cast->count,
           (unsigned long long)stage->frames, (unsigned long long)stage->drawn);
    for (uint32_t p = 0; p < POLICIES; p++) {
        double share[2];
        for (int w = 0; w < 2; w++) {
            EnfDbvCounters counters = enf_dbv_total_counters(stage->indices[w][p]);
            assert_int_equal(counters.late, 0);
            share[w] = (double)counters.avoided / ((double)stage->frames * (double)cast->count);
            enf_dbv_destroy(stage->indices[w][p]);
        }
        printf(" %s %.3f / %.3f", names[p], share[0], share[1]);
    }
    printf("\n");
    for (int w = 0; w < 2; w++) {
        enf_world_destroy(stage->worlds[w]);
    }
    enf_drawn_free(&stage->oracle);
    enf_vis_destroy(stage->vis);
    enf_portals_destroy(&stage->portals);
    assert_true(stage->drawn > 0);
}

/* ---- real levels ------------------------------------------------------------------------------------------------ */

typedef struct Level {
    const char *level, *movers, *walk;
    bool smooth; /* points are control points of a curve; else positions of every moment that mattered */
} Level;

static void walk_level(Stage *stage, const EnfPathCsv *walk, uint32_t every) {
    EnfView view = enf_view_default();
    uint32_t cell = ENF_NONE;
    EnfVec3 before = {0};
    for (uint32_t i = 0; i < walk->count; i++) {
        const EnfPathRow *row = &walk->rows[i];
        EnfVec3 eye = enf_v3(row->x, row->y, row->z);
        cell = cell == ENF_NONE ? enf_map_locate(stage->map, eye) : enf_map_track(stage->map, cell, before, eye);
        before = eye;
        if (i % every != 0) {
            continue;
        }
        view.camera = enf_camera(eye, enf_turn(row->yaw_deg, row->pitch_deg, 0.0), 60.0, 640, 480);
        view.cell = row->inside ? cell : ENF_NONE;
        frame(stage, llround(row->time * ENF_TICK_RATE), &view);
    }
}

static void check_level(const Level *level) {
    EnfMap map;
    EnfPathCsv walk;
    EnfError error = {0};
    const char *movers = enf_test_data(level->movers), *path = enf_test_data(level->walk);
    Cast *cast = calloc(1, sizeof *cast);
    Stage *stage = malloc(sizeof *stage);
    assert_true(cast && stage);
    read_cast(cast, movers, enf_v3(0.0, 0.0, 0.0), level->smooth);
    enf_test_compile_map(&map, enf_test_data(level->level));
    if (enf_path_csv_read(&walk, path, &error)) {
        fail_msg("%s: %s", path, error.message);
    }
    open_stage(stage, &map, cast);
    walk_level(stage, &walk, enf_test_rounds(walk.count / 250 + 1, 1));
    close_stage(stage, level->movers, cast);
    free(stage);
    enf_path_csv_free(&walk);
    enf_map_free(&map);
    free_cast(cast);
}

static void test_movers_of_real_levels(void **state) {
    (void)state;
    static const Level levels[] = {
        {"freedoom/E1M1_rooms.glb", "freedoom/E1M1_rooms.movers.csv", "freedoom/E1M1_rooms.walk.csv", true},
        {"freedoom/E1M1_sector.glb", "freedoom/E1M1_sector.movers.csv", "freedoom/E1M1_sector.walk.csv", true},
        {"freedoom/E3M8_rooms.glb", "freedoom/E3M8_rooms.movers.csv", "freedoom/E3M8_rooms.walk.csv", true},
        {"freedoom/MAP01_rooms.glb", "freedoom/MAP01_rooms.movers.csv", "freedoom/MAP01_rooms.walk.csv", true},
        {"freedoom/MAP26_rooms.glb", "freedoom/MAP26_rooms.movers.csv", "freedoom/MAP26_rooms.walk.csv", true},
        {"buildings/duplex.glb", "buildings/duplex.movers.csv", "buildings/duplex.walk.csv", true},
    };
    for (size_t i = 0; i < sizeof levels / sizeof *levels; i++) {
        check_level(&levels[i]);
    }
}

static void test_monsters_of_a_real_game(void **state) {
    (void)state;
    Level level = {"freedoom/MAP26_rooms.glb", "freedoom/MAP26_rooms.demo_objects.csv", "freedoom/MAP26_rooms.demo.csv", false};
    check_level(&level);
}

/* ---- pedestrians ------------------------------------------------------------------------------------------------ */

/* Pedestrians in a block of rooms of ours: recorded feet, and doors that they do not care for. */
static void check_pedestrians(const char *file_name, EnfVec3 shift, uint64_t stream) {
    EnfTestRng rng = enf_test_rng(stream);
    EnfRooms rooms;
    EnfRoomsDef def = enf_rooms_def_default();
    def.nx = 6;
    def.nz = 4;
    def.door_percent = 80;
    def.seed = enf_test_u64(&rng);
    Cast *cast = calloc(1, sizeof *cast);
    Stage *stage = malloc(sizeof *stage);
    assert_true(cast && stage && enf_rooms_create(&rooms, &def, NULL));
    read_cast(cast, enf_test_data(file_name), shift, true);
    open_stage(stage, rooms.map, cast);
    EnfView view = enf_view_default();
    for (uint32_t i = 0; i < enf_test_rounds(400, 8000); i++) {
        double angle = 0.01 * (double)i;
        EnfVec3 eye = enf_v3(15.0 + 13.0 * enf_cos(angle), 1.6, 10.0 + 8.0 * enf_sin(2.3 * angle));
        view.camera = enf_camera(eye, enf_turn(3.0 * (double)i, enf_test_double(&rng, -20, 20), 0.0), 75.0, 640, 480);
        view.cell = enf_rooms_cell_at(&rooms, eye);
        enf_portals_set_open(&stage->portals, enf_test_below(&rng, stage->portals.count), enf_test_chance(&rng, 2));
        frame(stage, (int64_t)i * 12, &view);
    }
    close_stage(stage, file_name, cast);
    free(stage);
    enf_rooms_destroy(&rooms);
    free_cast(cast);
}

static void test_pedestrians_in_a_bottleneck(void **state) {
    (void)state;
    check_pedestrians("trajectories/bottleneck_040_c_56_h-.csv", enf_v3(13.0, 0.0, 11.0), 1);
}

static void test_an_evacuation(void **state) {
    (void)state;
    check_pedestrians("trajectories/pathfinder_rooms.csv", enf_v3(14.0, 0.0, 10.0), 2);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_movers_of_real_levels),
    cmocka_unit_test(test_monsters_of_a_real_game),
    cmocka_unit_test(test_pedestrians_in_a_bottleneck),
    cmocka_unit_test(test_an_evacuation),
};

ENF_TEST_MAIN(tests)
