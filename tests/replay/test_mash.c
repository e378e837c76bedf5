/* Random input, ten times 36,000 ticks in the long label: in the palace, and in a small map that means harm (scenes/trap). Each is
 * recorded by one game and walked again by another while somebody looks on, and every tick's state is the same.
 *
 *   ENF_MASHES   a folder: what is not there yet is recorded into it, what is there is walked again. Builds of other compilers and
 *                other machines that share it must come to the same states (tools/run test --long). */
#include "enfreplay/mash.h"
#include "harness/onlooker.h"

#include "scenes/trap.h"

enum { MASHES = 10, MASH_TICKS = 36000, MASH_FAST_TICKS = 300 };

typedef struct Mashed {
    const char *map, *start;
    uint64_t seed;
    bool builder;
} Mashed;

static const Mashed mashes[MASHES] = {
    {"palace", "", 101, false},
    {"palace", "peaceful", 102, false},
    {"palace", "", 103, true},
    {"palace", "peaceful", 104, true},
    {"palace", "exhibits=1", 105, false},
    {"trap", "", 106, false},
    {"trap", "peaceful", 107, false},
    {"trap", "", 108, true},
    {"trap", "peaceful", 109, false},
    {"trap", "exhibits=1", 110, false},
};

static EnfWalkMaps maps;
static EnfMaker *trap;

static int open_maps(void **state) {
    (void)state;
    EnfError error = {0};
    trap = enf_trap_create(&error);
    if (!trap) {
        fprintf(stderr, "%s\n", error.message);
        return -1;
    }
    return enf_walk_maps(&maps);
}

static int close_maps(void **state) {
    (void)state;
    enf_walk_forget(&maps);
    enf_maker_destroy(trap);
    return 0;
}

static const EnfMap *map_of(const Mashed *mashed) {
    if (strcmp(mashed->map, "trap") == 0) {
        return enf_maker_map(trap);
    }
    const EnfWalkMap *map = enf_walk_map(&maps, mashed->map);
    return map ? &map->map : NULL;
}

/* Plays random input, and records it. */
static void record(const Mashed *mashed, const EnfMap *map, const char *path) {
    EnfReplayHeader header = enf_replay_header_default();
    EnfRecorder *recorder;
    EnfError error = {0};
    Sim *sim;
    header.seed = mashed->seed;
    header.field_every = 60;
    strcpy(header.map, mashed->map);
    strcpy(header.start, mashed->start);
    assert_int_equal(sim_create(&sim, map, &header, &error), ENF_OK);
    sim_fill_header(sim, &header);
    assert_int_equal(enf_recorder_create(&recorder, &header, path, NULL, &error), ENF_OK);
    Mash mash = mash_begin(mashed->seed, mashed->builder);
    for (uint64_t tick = enf_walk_ticks(MASH_FAST_TICKS, MASH_TICKS); tick > 0; tick--) {
        EnfInput input = mash_next(&mash);
        sim_step(sim, &input);
        assert_int_equal(sim_record(sim, recorder, &input, &error), ENF_OK);
    }
    assert_int_equal(enf_recorder_finish(recorder, &error), ENF_OK);
    enf_recorder_destroy(recorder);
    sim_destroy(sim);
}

/* Plays what was recorded, watched, with volumes of one policy; returns the state's hash at the end. */
static uint64_t walk_again(const Mashed *mashed, const EnfMap *map, const char *path, int policy) {
    EnfWalk walk = {.name = path, .map = map};
    EnfError error = {0};
    assert_int_equal(enf_replay_read(&walk.replay, path, ENF_REPLAY_WHOLE, NULL, &error), ENF_OK);
    if (enf_replay_accept(&walk.replay, sim_game(), mashed->map, map->hash, &error) != ENF_OK ||
        sim_create(&walk.sim, map, &walk.replay.header, &error) != ENF_OK) {
        fail_msg("%s: %s", path, error.message);
    }
    assert_true(sim_hash(walk.sim) == walk.replay.header.start_hash);
    EnfOnlooker onlooker = enf_onlooker_begin(walk.sim, map, policy);
    EnfReplayCursor cursor = enf_replay_begin(&walk.replay);
    uint64_t left = enf_walk_ticks(MASH_FAST_TICKS, MASH_TICKS);
    for (const EnfReplayTick *tick; left > 0 && (tick = enf_replay_next(&cursor)) != NULL; left--) {
        enf_walk_step(&walk, tick);
        enf_onlooker_look(&onlooker, walk.sim, ENF_CULL_WORKLIST);
    }
    assert_true(left == 0);
    uint64_t hash = sim_hash(walk.sim);
    char how[160];
    sim_describe(walk.sim, how);
    SimEye eye = sim_eye(walk.sim);
    printf("%-6s seed %3u: state %016llx, %s, eye at %.1f %.1f %.1f\n", mashed->map, (unsigned)mashed->seed,
           (unsigned long long)hash, how, eye.eye_ws.x, eye.eye_ws.y, eye.eye_ws.z);
    enf_onlooker_end(&onlooker);
    enf_walk_close(&walk);
    return hash;
}

static void random_input_comes_to_the_same(void **state) {
    (void)state;
    const char *folder = getenv("ENF_MASHES");
    for (uint32_t i = 0; i < MASHES; i++) {
        const EnfMap *map = map_of(&mashes[i]);
        if (!map) {
            printf("skipped: for want of the map %s\n", mashes[i].map);
            continue;
        }
        char path[1024], name[32];
        snprintf(name, sizeof name, "mash_%u.enfreplay", (unsigned)mashes[i].seed);
        snprintf(path, sizeof path, "%s/%s", folder ? folder : enf_test_temp_folder(), name);
        if (!enf_walk_can_read(path)) {
            record(&mashes[i], map, path);
        }
        walk_again(&mashes[i], map, path, (int)(i % (ENF_DBV_REACH + 1)));
    }
}

/* The map is what it says: doors close the portals that they stand in. */
static void the_trap_is_set(void **state) {
    (void)state;
    const EnfMap *map = enf_maker_map(trap);
    uint32_t doors = 0;
    for (uint32_t i = 0; i < map->movers_count; i++) {
        const EnfMover *mover = &map->movers[i];
        if (mover->portal != ENF_NONE) {
            assert_true(mover->portal == enf_maker_half(trap, doors, 0));
            doors++;
        }
    }
    assert_int_equal(doors, 2);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_trap_is_set),
    cmocka_unit_test(random_input_comes_to_the_same),
};

int main(int argc, char **argv) {
    enf_test_begin(argc, argv);
    return enf_test_end(cmocka_run_group_tests(tests, open_maps, close_maps));
}
