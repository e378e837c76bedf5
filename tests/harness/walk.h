/* The recordings of tests/replay, their maps, and a simulation that walks one again: for every suite that plays them.
 *
 * The maps are compiled by maps.sh into the folder replay_maps of the build; a build without the compiler (aarch64, MSan) takes those
 * of build/check, or of ENF_REPLAY_MAPS. A map is read once a run: several recordings are of one map.
 *
 *   ENF_REPLAY_MAPS    the folder of the maps
 *   ENF_REPLAY_TICKS   of each recording, no more than so many ticks */
#ifndef ENF_TESTS_WALK_H
#define ENF_TESTS_WALK_H

#include "enfreplay/sim.h"
#include "harness/harness.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ENF_WALK_MAPS = 16 };

typedef struct EnfWalkMap {
    char path[1400];
    EnfMap map;
} EnfWalkMap;

typedef struct EnfWalkMaps {
    char folder[1024];
    EnfWalkMap *read[ENF_WALK_MAPS];
    uint32_t count;
} EnfWalkMaps;

/* A recording with its map and its simulation. */
typedef struct EnfWalk {
    const char *name;
    EnfReplay replay;
    const EnfMap *map;
    Sim *sim;
} EnfWalk;

static inline bool enf_walk_can_read(const char *path) {
    FILE *file = fopen(path, "rb");
    if (file) {
        fclose(file);
    }
    return file != NULL;
}

/** Makes the maps, or finds them. 0, or a status that is none. */
static inline int enf_walk_maps(EnfWalkMaps *maps) {
    const char *given = getenv("ENF_REPLAY_MAPS");
    char enfc[1024], command[4096];
    memset(maps, 0, sizeof *maps);
    snprintf(enfc, sizeof enfc, "%s/enfc", ENF_BIN_DIR);
    if (given) {
        snprintf(maps->folder, sizeof maps->folder, "%s", given);
        return 0;
    }
    if (!enf_walk_can_read(enfc)) {
        snprintf(maps->folder, sizeof maps->folder, "%s", enf_test_source_path("build/check/replay_maps"));
        return 0;
    }
    snprintf(maps->folder, sizeof maps->folder, "%s/../replay_maps", ENF_BIN_DIR);
    snprintf(command, sizeof command, "bash '%s' '%s' '%s' 2>&1", enf_test_source_path("tests/replay/maps.sh"), enfc,
             maps->folder);
    return enf_test_shell(command);
}

static inline void enf_walk_forget(EnfWalkMaps *maps) {
    while (maps->count > 0) {
        EnfWalkMap *last = maps->read[--maps->count];
        enf_map_free(&last->map);
        free(last);
    }
}

/** The map of that name, read at the first call; NULL where it is absent. Fails the case where it cannot be read. */
static inline const EnfWalkMap *enf_walk_map(EnfWalkMaps *maps, const char *name) {
    char path[1400];
    snprintf(path, sizeof path, "%s/%s.enfmap", maps->folder, name);
    for (uint32_t i = 0; i < maps->count; i++) {
        if (strcmp(maps->read[i]->path, path) == 0) {
            return maps->read[i];
        }
    }
    if (!enf_walk_can_read(path)) {
        return NULL;
    }
    assert_true(maps->count < ENF_WALK_MAPS);
    EnfWalkMap *made = calloc(1, sizeof *made);
    EnfError error = {0};
    assert_non_null(made);
    strcpy(made->path, path);
    if (enf_map_read(&made->map, path, NULL, &error) != ENF_OK) {
        free(made);
        fail_msg("%s: %s", path, error.message);
    }
    return maps->read[maps->count++] = made;
}

/** How many ticks to walk of a recording: `fast`, or `slow` in the long label; no more than ENF_REPLAY_TICKS. */
static inline uint64_t enf_walk_ticks(uint64_t fast, uint64_t slow) {
    const char *given = getenv("ENF_REPLAY_TICKS");
    uint64_t most = given ? strtoull(given, NULL, 10) : UINT64_MAX;
    uint64_t wanted = enf_test_long() ? slow : fast;
    return wanted < most ? wanted : most;
}

/** Opens the recording `name` of tests/replay. False, with a message, where its map is absent. Whatever else fails fails the case. */
static inline bool enf_walk_open(EnfWalk *walk, EnfWalkMaps *maps, const char *name) {
    char path[2048];
    EnfError error = {0};
    memset(walk, 0, sizeof *walk);
    walk->name = name;
    snprintf(path, sizeof path, "%s/%s", enf_test_source_path("tests/replay"), name);
    if (enf_replay_read(&walk->replay, path, ENF_REPLAY_WHOLE, NULL, &error) != ENF_OK) {
        fail_msg("%s: %s", name, error.message);
    }
    const EnfWalkMap *map = enf_walk_map(maps, walk->replay.header.map);
    if (!map) {
        printf("skipped: %s, for want of the map %s\n", name, walk->replay.header.map);
        enf_replay_free(&walk->replay);
        return false;
    }
    walk->map = &map->map;
    if (enf_replay_accept(&walk->replay, sim_game(), map->path, map->map.hash, &error) != ENF_OK ||
        sim_create(&walk->sim, walk->map, &walk->replay.header, &error) != ENF_OK) {
        fail_msg("%s: %s (tests/replay/record_all.sh makes the recordings anew)", name, error.message);
    }
    if (sim_hash(walk->sim) != walk->replay.header.start_hash) {
        fail_msg(
            "%s: the game begins otherwise than when it was recorded (tests/replay/record_all.sh makes the recordings anew)",
            name);
    }
    return true;
}

static inline void enf_walk_close(EnfWalk *walk) {
    sim_destroy(walk->sim);
    enf_replay_free(&walk->replay);
}

/** Steps the simulation, and fails, naming tick and fields, where the state is not what was recorded. */
static inline void enf_walk_step(EnfWalk *walk, const EnfReplayTick *tick) {
    EnfReplayDivergence divergence;
    sim_step(walk->sim, &tick->input);
    if (!sim_compare(walk->sim, &walk->replay, tick, &divergence)) {
        char differing[1024] = "";
        for (uint32_t i = 0; i < walk->replay.header.field_count; i++) {
            if (divergence.differing >> i & 1) {
                strcat(strcat(differing, " "), walk->replay.header.fields[i]);
            }
        }
        fail_msg("%s: diverged at tick %llu; fields:%s", walk->name, (unsigned long long)tick->tick, differing);
    }
}

#endif
