/* Every recording of this folder, walked again: the state after each tick is what was recorded, with and without somebody who
 * looks, and after a restart, on this compiler and this machine.
 * Recordings of maps that are not there are named and skipped. */
#define _XOPEN_SOURCE 700
#include "harness/onlooker.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { RECORDINGS_MAX = 256, FAST_TICKS = 2000, LOOKED_TICKS = 600, RECORDINGS_WANTED = 12 };

/* ---- maps and recordings ---------------------------------------------------------------------------------------- */

static EnfWalkMaps maps;
static char *names[RECORDINGS_MAX];
static uint32_t name_count;

static int by_name(const void *a, const void *b) {
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static int find_recordings(void **state) {
    (void)state;
    DIR *folder = opendir(enf_test_source_path("tests/replay"));
    struct dirent *entry;
    while (folder && name_count < RECORDINGS_MAX && (entry = readdir(folder)) != NULL) {
        const char *ending = strrchr(entry->d_name, '.');
        if (ending && strcmp(ending, ".enfreplay") == 0) {
            names[name_count++] = strdup(entry->d_name);
        }
    }
    if (folder) {
        closedir(folder);
    }
    qsort(names, name_count, sizeof *names, by_name);
    return enf_walk_maps(&maps);
}

static int forget_recordings(void **state) {
    (void)state;
    enf_walk_forget(&maps);
    while (name_count > 0) {
        free(names[--name_count]);
    }
    return 0;
}

/* ---- walking ---------------------------------------------------------------------------------------------------- */

/* Walks up to `limit` ticks; `policy` < 0: nobody looks. Returns the ticks walked, 0 where the map is absent. */
static uint64_t walk_again(const char *name, uint64_t limit, int policy) {
    EnfWalk walk;
    EnfOnlooker onlooker = {NULL, NULL, 0};
    if (!enf_walk_open(&walk, &maps, name)) {
        return 0;
    }
    if (policy >= 0) {
        onlooker = enf_onlooker_begin(walk.sim, walk.map, policy);
    }
    EnfReplayCursor cursor = enf_replay_begin(&walk.replay);
    const EnfReplayTick *tick;
    uint64_t ticks = 0;
    while (ticks < limit && (tick = enf_replay_next(&cursor)) != NULL) {
        enf_walk_step(&walk, tick);
        if (onlooker.vis) {
            enf_onlooker_look(&onlooker, walk.sim, ticks % 7 == 3 ? ENF_CULL_FRUSTUM : ENF_CULL_WORKLIST);
        }
        ticks++;
    }
    enf_onlooker_end(&onlooker);
    enf_walk_close(&walk);
    return ticks;
}

static void every_recording_is_walked_again(void **state) {
    (void)state;
    uint64_t ticks = 0;
    assert_true(name_count >= RECORDINGS_WANTED);
    for (uint32_t i = 0; i < name_count; i++) {
        ticks += walk_again(names[i], enf_walk_ticks(FAST_TICKS, UINT64_MAX), -1);
    }
    printf("%u recordings, %llu ticks\n", name_count, (unsigned long long)ticks);
}

/* Whoever looks changes nothing: visibility at every tick, with volumes of each policy in turn. */
static void looking_changes_nothing(void **state) {
    (void)state;
    for (uint32_t i = 0; i < name_count; i++) {
        for (int policy = ENF_DBV_CONSTANT; policy <= ENF_DBV_REACH; policy++) {
            if ((enf_test_long() && !getenv("ENF_REPLAY_TICKS")) || policy == (int)(i % (ENF_DBV_REACH + 1))) {
                walk_again(names[i], enf_walk_ticks(LOOKED_TICKS, 10 * LOOKED_TICKS), policy);
            }
        }
    }
}

/* ---- what two of them must do ----------------------------------------------------------------------------------- */

/* Plays a recording of the palace to its end and tells, for each cell, whether it held the eye, and for each half-portal that a
 * door closes, whether it was shut and then open. */
static void visit(EnfWalk *walk, uint8_t *cells, uint8_t *opened) {
    EnfReplayCursor cursor = enf_replay_begin(&walk->replay);
    const EnfReplayTick *tick;
    while ((tick = enf_replay_next(&cursor)) != NULL) {
        sim_step(walk->sim, &tick->input);
        SimEye eye = sim_eye(walk->sim);
        if (eye.cell != ENF_NONE) {
            cells[eye.cell] = true;
        }
        /* Where cells overlap the eye is in others too: asked now and then, as it takes long. */
        for (uint32_t i = 0; i < walk->map->cells_count && tick->tick % 30 == 0; i++) {
            cells[i] = cells[i] || enf_map_cell_contains(walk->map, i, eye.eye_ws);
        }
        for (uint32_t i = 0; i < walk->map->movers_count; i++) {
            uint32_t portal = walk->map->movers[i].portal;
            if (portal != ENF_NONE) {
                bool open = enf_portals_is_open(sim_portals(walk->sim), portal);
                opened[portal] = open && opened[portal] ? 2 : opened[portal] == 2 ? 2 : !open;
            }
        }
    }
}

static void rooms_are_visited_and_doors_opened(void **state) {
    (void)state;
    static const char *const recordings[2] = {"palace_rooms.enfreplay", "palace_doors.enfreplay"};
    if (ENF_TEST_SLOW || getenv("ENF_REPLAY_TICKS")) {
        printf("left to faster builds: what two of them must do does not depend on the build, as their states do not\n");
        return;
    }
    for (int which = 0; which < 2; which++) {
        EnfWalk walk;
        if (!enf_walk_open(&walk, &maps, recordings[which])) {
            continue;
        }
        uint8_t *cells = calloc(walk.map->cells_count + 1, 1), *opened = calloc(walk.map->portals_count + 1, 1);
        assert_true(cells && opened);
        uint32_t missed = 0;
        visit(&walk, cells, opened);
        for (uint32_t i = 0; which == 0 && i < walk.map->cells_count; i++) {
            if (!cells[i] && !(walk.map->cells[i].flags & ENF_CELL_OUTSIDE)) {
                printf("never in %s\n", enf_map_string(walk.map, walk.map->cells[i].name));
                missed++;
            }
        }
        for (uint32_t i = 0; which == 1 && i < walk.map->movers_count; i++) {
            uint32_t portal = walk.map->movers[i].portal;
            if (portal != ENF_NONE && opened[portal] != 2) {
                printf("%s was never opened\n", enf_map_string(walk.map, walk.map->entities[walk.map->movers[i].entity].name));
                missed++;
            }
        }
        /* What is missed is named: a bedroom whose point in rooms.csv lies within a wall. */
        assert_true(missed <= 4);
        free(cells);
        free(opened);
        enf_walk_close(&walk);
    }
}

/* A recording lists itself, and the list names no other. */
static void list_is_complete(void **state) {
    (void)state;
    size_t size;
    char *list = (char *)enf_test_read_file(enf_test_source_path("tests/replay/recordings.list"), &size);
    uint32_t lines = 0;
    for (char *line = strtok(list, "\n"); line; line = strtok(NULL, "\n")) {
        size_t length = strcspn(line, " |");
        if (line[0] == '#' || length == 0) {
            continue;
        }
        char name[256];
        snprintf(name, sizeof name, "%.*s.enfreplay", (int)length, line);
        uint32_t i = 0;
        while (i < name_count && strcmp(names[i], name) != 0) {
            i++;
        }
        if (i == name_count) {
            fail_msg("%s is in recordings.list, and there is no such file", name);
        }
        lines++;
    }
    free(list);
    assert_int_equal(lines, name_count);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(list_is_complete),
    cmocka_unit_test(every_recording_is_walked_again),
    cmocka_unit_test(looking_changes_nothing),
    cmocka_unit_test(rooms_are_visited_and_doors_opened),
};

int main(int argc, char **argv) {
    enf_test_begin(argc, argv);
    return enf_test_end(cmocka_run_group_tests(tests, find_recordings, forget_recordings));
}
