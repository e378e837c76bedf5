/* S1 and S2 (Sudarsky & Gotsman 1996, section 4.1): one small cube moves, and the trees are updated from the least common ancestor
 * of its old and new places, or naively from the root. They take turns, a batch of ticks each. Only the update of trees counts: the
 * same cube, moving likewise far from the building where no tree is, shows what the rest of a tick costs, and that is taken off. */
#include "enfbench/movers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 108000, BATCHES = 30, WAYS = 3, IDLE = 2 };

/* A cube's way: along x in steps of half its side, or around a point by a degree a tick. */
typedef struct Cube {
    EnfVec3 from;
    double side, length; /* metres; length 0: a circle */
    EnfVec3 circle[360]; /* about `from` */
} Cube;

static Cube make_cube(EnfVec3 from, double side, double length) {
    Cube cube;
    cube.from = from;
    cube.side = side;
    cube.length = length;
    for (int i = 0; i < 360; i++) {
        double angle = (double)i * (ENF_PI / 180.0);
        cube.circle[i] = enf_v3(4.0 * side * enf_cos(angle), 0.0, 4.0 * side * enf_sin(angle));
    }
    return cube;
}

static EnfPose cube_state(const void *user, int64_t tick) {
    const Cube *cube = user;
    EnfPose pose = enf_pose_identity();
    pose.position = cube->from;
    if (cube->length > 0.0) {
        int64_t steps = (int64_t)(cube->length / (0.5 * cube->side)) + 1;
        int64_t at = tick % (2 * steps);
        pose.position.x += 0.5 * cube->side * (double)(at < steps ? at : 2 * steps - at);
    } else {
        pose.position = enf_add(cube->from, cube->circle[tick % 360]);
    }
    return pose;
}

/* For a tick or two at most: where it is, and a step farther. */
static EnfBox3 cube_bound(const void *user, const EnfBox3 *local, int64_t tick0, int64_t tick1) {
    EnfPose a = cube_state(user, tick0);
    EnfPose b = cube_state(user, tick1);
    EnfBox3 first = {enf_add(a.position, local->min), enf_add(a.position, local->max)};
    EnfBox3 last = {enf_add(b.position, local->min), enf_add(b.position, local->max)};
    EnfBox3 both = enf_box3_union(first, last);
    EnfVec3 margin = enf_v3(1e-6, 1e-6, 1e-6);
    both.min = enf_sub(both.min, margin);
    both.max = enf_add(both.max, margin);
    return both;
}

typedef struct Way {
    EnfWorld *world;
    EnfDbvIndex *index;
    double times[BATCHES];
    uint64_t hash; /* of the volumes that it left, a batch each */
} Way;

/* What --set says. */
typedef struct Knobs {
    uint32_t batch; /* ticks */
    uint32_t seed;
    bool rows[IDLE]; /* naive, lca: wanted? Both run, for their ratio. */
} Knobs;

static const char *const names[IDLE] = {"naive", "lca"};

static void read_knobs(BenchRun *run, Knobs *knobs) {
    uint32_t frames = bench_knob_whole(&run->knobs, "frames", FRAMES, BATCHES, 1000000000);
    knobs->batch = frames / BATCHES;
    if (frames % BATCHES != 0) {
        fprintf(stderr, "enfbench: frames=%u: they are timed in %d batches, so that %u are measured\n", frames, BATCHES,
                knobs->batch * BATCHES);
    }
    knobs->seed = bench_knob_whole(&run->knobs, "seed", 1, 0, 4000000000U);
    const char *policy = bench_knob_text(&run->knobs, "policy", "all");
    bool all = strcmp(policy, "all") == 0 || strcmp(policy, "naive,lca") == 0 || strcmp(policy, "lca,naive") == 0;
    knobs->rows[0] = all || strcmp(policy, names[0]) == 0;
    knobs->rows[1] = all || strcmp(policy, names[1]) == 0;
    if (!knobs->rows[0] && !knobs->rows[1]) {
        fprintf(stderr, "enfbench: policy=%s: naive and lca are expected, separated by commas\n", policy);
        exit(2);
    }
}

static bool open_way(Way *way, const EnfMap *map, const Cube *cube, EnfDbvUpdate update) {
    EnfError error = {ENF_OK, 0, "", ""};
    EnfObjectDef object = enf_object_def_default();
    double h = 0.5 * cube->side;
    object.local.min = enf_v3(-h, -h, -h);
    object.local.max = enf_v3(h, h, h);
    object.motion.kind = ENF_MOTION_CALLBACK;
    object.motion.as.callback.state = cube_state;
    object.motion.as.callback.bound = cube_bound;
    object.motion.as.callback.user = cube;
    EnfDbvDef def = {ENF_DBV_CONSTANT, update, 1, 1};
    return enf_world_create(&way->world, map, 1, NULL, &error) == ENF_OK &&
           enf_world_add(way->world, &object, &error).generation != 0 &&
           enf_dbv_create(&way->index, way->world, &def, NULL, &error) == ENF_OK;
}

/* A tick's time. */
static double batch(Way *way, uint32_t ticks) {
    double start = bench_now_us();
    for (uint32_t i = 0; i < ticks; i++) {
        uint32_t count = 0;
        (void)enf_dbv_begin(way->index, NULL);
        (void)enf_dbv_end(way->index, &count);
        enf_world_advance(way->world, 1);
    }
    double spent = (bench_now_us() - start) / ticks;
    EnfBox3f volume = {{0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F}};
    int64_t expiry = 0;
    (void)enf_dbv_volume(way->index, 0, &volume, &expiry);
    way->hash = enf_hash64(way->hash, &volume, sizeof volume);
    way->hash = enf_hash64(way->hash, &expiry, sizeof expiry);
    return spent;
}

/* How many nodes fewer. */
static double ways_nodes(const Way *ways) {
    EnfDbvCounters naive = enf_dbv_total_counters(ways[0].index);
    EnfDbvCounters lca = enf_dbv_total_counters(ways[1].index);
    return (double)naive.nodes / (double)lca.nodes;
}

static void add_rows(BenchRun *run, const char *experiment, const char *params, Way *ways, const Knobs *knobs) {
    double idle = bench_quantile(ways[IDLE].times, BATCHES, 0.5);
    double first = 0.0;
    for (int w = 0; w < IDLE; w++) {
        EnfDbvCounters counters = enf_dbv_total_counters(ways[w].index);
        BenchRow row = bench_row(experiment, "update", names[w]);
        snprintf(row.params, sizeof row.params, "%s", params);
        row.frames = knobs->batch * BATCHES;
        row.hash = ways[w].hash;
        row.nodes = (double)counters.nodes / (double)row.frames;
        row.reinserted = (double)counters.reinserted / (double)row.frames;
        row.late = (double)counters.late;
        row.p99_us = bench_quantile(ways[w].times, BATCHES, 0.99) - idle;
        row.median_us = bench_quantile(ways[w].times, BATCHES, 0.5) - idle;
        first = w == 0 ? row.median_us : first;
        row.ratio_median = first / row.median_us;
        row.ratio_best = w == 0 ? 1.0 : ways_nodes(ways);
        if (knobs->rows[w]) {
            bench_rows_add(&run->rows, &row);
        }
    }
}

static bool compare(BenchRun *run, const char *experiment, const EnfRoomsDef *def, const Cube *cube, const Knobs *knobs) {
    EnfRooms rooms;
    EnfError error = {ENF_OK, 0, "", ""};
    Way ways[WAYS];
    memset(ways, 0, sizeof ways);
    Cube elsewhere = *cube;
    elsewhere.from.y -= 10000.0;
    if (!enf_rooms_create(&rooms, def, &error)) {
        fprintf(stderr, "enfbench: %s\n", error.message);
        return false;
    }
    bool ok = open_way(&ways[0], rooms.map, cube, ENF_DBV_NAIVE) && open_way(&ways[1], rooms.map, cube, ENF_DBV_LCA) &&
              open_way(&ways[IDLE], rooms.map, &elsewhere, ENF_DBV_LCA);
    for (int b = 0; b < BATCHES && ok; b++) {
        for (int w = 0; w < WAYS; w++) {
            Way *way = &ways[(w + b) % WAYS];
            way->times[b] = batch(way, knobs->batch);
        }
    }
    if (ok) {
        char params[BENCH_TEXT];
        snprintf(params, sizeof params, "rooms=%u boxes=%u ratio=%.0f seed=%u", def->nx * def->nz, def->furniture,
                 (double)def->nx * def->room.x / cube->side, knobs->seed);
        add_rows(run, experiment, params, ways, knobs);
    }
    for (int w = 0; w < WAYS; w++) {
        enf_dbv_destroy(ways[w].index);
        if (ways[w].world != NULL) {
            enf_world_destroy(ways[w].world);
        }
    }
    enf_rooms_destroy(&rooms);
    return ok;
}

/* The large cube is a building, through a row of whose rooms the small one goes; its tree is as deep as the ratio of sizes asks. The
 * seed chooses the row. */
bool bench_s1(BenchRun *run) {
    Knobs knobs;
    uint32_t most = bench_knob_whole(&run->knobs, "rooms", 4096, 1, 1000000);
    bool ok = true;
    read_knobs(run, &knobs);
    for (uint32_t n = 1; n * n <= most && ok; n *= 2) {
        EnfRoomsDef def = enf_rooms_def_default();
        def.nx = n;
        def.nz = n;
        def.furniture = 0;
        def.lights = false;
        def.seed = knobs.seed;
        uint32_t row = knobs.seed > 0 ? (knobs.seed - 1) % n : n - 1;
        EnfVec3 from = enf_v3(0.75, 0.75, 0.75 + (double)row * def.room.z);
        Cube cube = make_cube(from, 0.5, (double)n * def.room.x - 1.5);
        ok = compare(run, "S1", &def, &cube, &knobs);
    }
    return ok;
}

/* One table full of things: as many boxes as the paper's table has polygons; the cube goes around a place on it. */
bool bench_s2(BenchRun *run) {
    Knobs knobs;
    bool ok = true;
    read_knobs(run, &knobs);
    uint32_t boxes = bench_knob_whole(&run->knobs, "boxes", 5745, 0, 100000);
    uint32_t most = bench_knob_whole(&run->knobs, "rooms", 64, 1, 10000);
    for (uint32_t n = 1; n * n <= most && ok; n *= 8) {
        EnfRoomsDef def = enf_rooms_def_default();
        def.nx = n;
        def.nz = n;
        def.furniture = boxes;
        def.lights = false;
        def.seed = knobs.seed;
        Cube cube = make_cube(enf_v3(1.625, 0.75, 1.625), 0.03125, 0.0);
        ok = compare(run, "S2", &def, &cube, &knobs);
    }
    return ok;
}
