/* Every recording of this folder, walked again: the state after each tick is what was recorded, with and without somebody who
 * looks, and after a restart, on this compiler and this machine.
 * Recordings of maps that are not there are named and skipped. */
#define _XOPEN_SOURCE 700
#include "harness/onlooker.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { RECORDINGS_MAX = 256, FAST_TICKS = 2000, LOOKED_TICKS = 600, RECORDINGS_WANTED = 12, MOST_BYTES = 300 * 1024 };

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

/* ---- what some of them must do ------------------------------------------------------------------------------------ */

enum { STOPS_MAX = 8 };

/* What a visitor has seen of a map, on foot. */
typedef struct Visit {
    uint8_t *cells;  /* a cell: he was in it */
    uint8_t *opened; /* a half-portal: 1 shut, 2 shut and then open */
    uint8_t *passed; /* cell × cell: he went from one to the other */
    uint32_t stops;  /* of elevators: bits of those at which he stood on the platform */
    double stop[STOPS_MAX];
    uint32_t stop_count, lift; /* the mover */
} Visit;

/* The elevator of the map, and its stops: metres over where it rests. */
static void find_lift(Visit *visit, const EnfMap *map) {
    visit->lift = ENF_NONE;
    for (uint32_t i = 0; i < map->movers_count; i++) {
        const EnfEntity *entity = &map->entities[map->movers[i].entity];
        const char *stops = strstr(enf_map_string(map, entity->extras), "\"stops\":\"");
        if (strcmp(enf_map_string(map, entity->classname), "func_plat") == 0 && stops) {
            visit->lift = i;
            for (const char *at = stops + 8; (*at == '"' || *at == ',') && visit->stop_count < STOPS_MAX;) {
                char *end;
                visit->stop[visit->stop_count++] = strtod(at + 1, &end);
                at = *end == ',' ? end : "";
            }
        }
    }
}

static void look_at_lift(Visit *visit, Sim *sim, double rest, EnfVec3 eye) {
    if (visit->lift == ENF_NONE) {
        return;
    }
    EnfVec3 at = enf_world_pose(sim_world(sim), visit->lift).position;
    bool rides = fabs(eye.x - at.x) < 1.0 && fabs(eye.z - at.z) < 1.0 && eye.y > at.y + 0.9 && eye.y < at.y + 2.0;
    for (uint32_t i = 0; i < visit->stop_count; i++) {
        visit->stops |= rides && fabs(at.y - rest - visit->stop[i]) < 0.01 ? 1u << i : 0u;
    }
}

static void look_at_doors(Visit *visit, const EnfMap *map, Sim *sim) {
    for (uint32_t i = 0; i < map->movers_count; i++) {
        uint32_t portal = map->movers[i].portal;
        if (portal != ENF_NONE) {
            bool open = enf_portals_is_open(sim_portals(sim), portal);
            visit->opened[portal] = open && visit->opened[portal] ? 2 : visit->opened[portal] == 2 ? 2 : !open;
        }
    }
}

/* Plays a recording to its end. He walks: nobody who wants to see rooms flies or goes through walls. */
static void visit(EnfWalk *walk, Visit *visit) {
    const EnfMap *map = walk->map;
    EnfReplayCursor cursor = enf_replay_begin(&walk->replay);
    const EnfReplayTick *tick;
    uint32_t before = ENF_NONE;
    find_lift(visit, map);
    double rest = visit->lift != ENF_NONE ? enf_world_pose(sim_world(walk->sim), visit->lift).position.y : 0.0;
    while ((tick = enf_replay_next(&cursor)) != NULL) {
        assert_int_equal(tick->input.buttons & (ENF_BUTTON_NOCLIP | ENF_BUTTON_FLY), 0);
        sim_step(walk->sim, &tick->input);
        SimEye eye = sim_eye(walk->sim);
        if (eye.cell != ENF_NONE) {
            visit->cells[eye.cell] = true;
            visit->passed[(size_t)(before == ENF_NONE ? eye.cell : before) * map->cells_count + eye.cell] = true;
        }
        before = eye.cell;
        look_at_doors(visit, map, walk->sim);
        look_at_lift(visit, walk->sim, rest, eye.eye_ws);
    }
}

static uint32_t missed_rooms(const EnfMap *map, const Visit *seen) {
    uint32_t missed = 0;
    for (uint32_t i = 0; i < map->cells_count; i++) {
        if (!seen->cells[i]) {
            printf("never in %s\n", enf_map_string(map, map->cells[i].name));
            missed++;
        }
    }
    return missed;
}

static uint32_t missed_doors(const EnfMap *map, const Visit *seen) {
    uint32_t missed = 0, doors = 0;
    for (uint32_t i = 0; i < map->movers_count; i++) {
        uint32_t portal = map->movers[i].portal;
        doors += portal != ENF_NONE;
        if (portal != ENF_NONE && seen->opened[portal] != 2) {
            printf("%s was never opened\n", enf_map_string(map, map->entities[map->movers[i].entity].name));
            missed++;
        }
    }
    assert_true(doors > 0);
    return missed;
}

static uint32_t missed_stairs(const EnfMap *map, const Visit *seen) {
    static const char *const stairs[][2] = {{"GrandStaircase-room", "UpperStaircase-room"},
                                            {"NorthStaircase-room", "NorthLanding-room"},
                                            {"CellarStair-room", "CellarLobby-room"},
                                            {"BarrelRampFoot-room", "BarrelRampHead-room"}};
    uint32_t missed = 0;
    for (size_t i = 0; i < sizeof stairs / sizeof *stairs; i++) {
        size_t low = enf_map_find_cell(map, stairs[i][0]), high = enf_map_find_cell(map, stairs[i][1]);
        assert_true(low < map->cells_count && high < map->cells_count);
        if (!seen->passed[low * map->cells_count + high] || !seen->passed[high * map->cells_count + low]) {
            printf("not up and down between %s and %s\n", stairs[i][0], stairs[i][1]);
            missed++;
        }
    }
    return missed;
}

static uint32_t missed_stops(const EnfMap *map, const Visit *seen) {
    (void)map;
    assert_true(seen->stop_count >= 2);
    printf("%u stops of the elevator\n", seen->stop_count);
    return seen->stops == (1u << seen->stop_count) - 1u ? 0 : 1;
}

/* Every room, every door, all stairs up and down, the elevator at all its stops: none is missed. */
static void nothing_is_missed(void **state) {
    (void)state;
    static const struct {
        const char *name;
        uint32_t (*missed)(const EnfMap *map, const Visit *seen);
    } recordings[] = {{"palace_rooms.enfreplay", missed_rooms},
                      {"palace_doors.enfreplay", missed_doors},
                      {"palace_stairs.enfreplay", missed_stairs},
                      {"palace_lift.enfreplay", missed_stops}};
    if (ENF_TEST_SLOW || getenv("ENF_REPLAY_TICKS")) {
        printf("left to faster builds: what they must do does not depend on the build, as their states do not\n");
        return;
    }
    for (size_t i = 0; i < sizeof recordings / sizeof *recordings; i++) {
        EnfWalk walk;
        if (!enf_walk_open(&walk, &maps, recordings[i].name)) {
            continue;
        }
        size_t cells = walk.map->cells_count, portals = walk.map->portals_count;
        Visit seen = {.cells = calloc(cells + 1, 1), .opened = calloc(portals + 1, 1), .passed = calloc(cells * cells + 1, 1)};
        assert_true(seen.cells && seen.opened && seen.passed);
        visit(&walk, &seen);
        assert_int_equal(recordings[i].missed(walk.map, &seen), 0);
        free(seen.cells);
        free(seen.opened);
        free(seen.passed);
        enf_walk_close(&walk);
    }
}

/* A whole game won past guards who are awake, six exhibits; one lost; ten minutes in one; and none is a burden to the repository. */
static void games_end_as_they_should(void **state) {
    (void)state;
    static const struct {
        const char *name, *start, *ends;
        uint64_t ticks;
    } recordings[] = {{"palace_won.enfreplay", "exhibits=0", "won in Vestibule-room; carries 0, 6 of 6 carried out", 0},
                      {"palace_lost.enfreplay", "exhibits=0", "lost in ", 0},
                      {"palace_long.enfreplay", "", "playing in ", 36000}};
    if (ENF_TEST_SLOW || getenv("ENF_REPLAY_TICKS")) {
        printf("left to faster builds\n");
        return;
    }
    for (size_t i = 0; i < sizeof recordings / sizeof *recordings; i++) {
        EnfWalk walk;
        if (!enf_walk_open(&walk, &maps, recordings[i].name)) {
            continue;
        }
        EnfReplayCursor cursor = enf_replay_begin(&walk.replay);
        const EnfReplayTick *tick;
        uint64_t ticks = 0;
        char text[160];
        for (; (tick = enf_replay_next(&cursor)) != NULL; ticks++) {
            sim_step(walk.sim, &tick->input);
        }
        sim_describe(walk.sim, text);
        printf("%s: %s: %llu ticks, %s\n", recordings[i].name, walk.replay.header.start, (unsigned long long)ticks, text);
        assert_true(strncmp(text, recordings[i].ends, strlen(recordings[i].ends)) == 0);
        assert_true(recordings[i].start[0] == '\0' || strcmp(walk.replay.header.start, recordings[i].start) == 0);
        assert_true(ticks >= recordings[i].ticks);
        enf_walk_close(&walk);
    }
}

static void recordings_are_small(void **state) {
    (void)state;
    for (uint32_t i = 0; i < name_count; i++) {
        char path[1024];
        size_t size;
        snprintf(path, sizeof path, "tests/replay/%s", names[i]);
        free(enf_test_read_file(enf_test_source_path(path), &size));
        if (size > MOST_BYTES) {
            fail_msg("%s has %zu bytes, more than %d", names[i], size, MOST_BYTES);
        }
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
    cmocka_unit_test(list_is_complete),         cmocka_unit_test(every_recording_is_walked_again),
    cmocka_unit_test(looking_changes_nothing),  cmocka_unit_test(nothing_is_missed),
    cmocka_unit_test(games_end_as_they_should), cmocka_unit_test(recordings_are_small),
};

int main(int argc, char **argv) {
    enf_test_begin(argc, argv);
    return enf_test_end(cmocka_run_group_tests(tests, find_recordings, forget_recordings));
}
