/* Recorded walks through real levels: at every step the tracked cell is the cell that the recording names, and so is the located one,
 * even where the walker goes through a barrel. */
#include "harness/program.h"
#include <enfilade/map.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The demo's doors are open and the level's are closed: a point in a closed door is in no room, so it is tracked only. */
typedef struct Level {
    const char *level, *walk;
    bool locate;
} Level;

static const Level levels[] = {
    {"freedoom/E1M1_rooms.glb", "freedoom/E1M1_rooms.walk.csv", true},
    {"freedoom/E1M1_sector.glb", "freedoom/E1M1_sector.walk.csv", true},
    {"freedoom/E3M8_rooms.glb", "freedoom/E3M8_rooms.walk.csv", true},
    {"freedoom/MAP01_rooms.glb", "freedoom/MAP01_rooms.walk.csv", true},
    {"freedoom/MAP26_rooms.glb", "freedoom/MAP26_rooms.walk.csv", true},
    {"freedoom/MAP26_rooms.glb", "freedoom/MAP26_rooms.demo.csv", false},
    {"buildings/duplex.glb", "buildings/duplex.walk.csv", true},
};

typedef struct Step {
    EnfVec3 at;
    char name[64];
} Step;

/* A row `time,x,y,z,yaw,pitch,cell…`; false for the title and at the end. */
static bool read_step(FILE *file, Step *step) {
    char line[512];
    double time, yaw, pitch;
    return fgets(line, sizeof line, file) && sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf,%63[^,\r\n]", &time, &step->at.x,
                                                    &step->at.y, &step->at.z, &yaw, &pitch, step->name) == 7;
}

static const char *name_of(const EnfMap *map, uint32_t cell) {
    return cell == ENF_NONE ? "none" : enf_map_string(map, map->cells[cell].name);
}

static void walk(const EnfMap *map, const Level *level) {
    FILE *file = fopen(enf_test_data(level->walk), "r");
    Step step, before;
    uint32_t cell = ENF_NONE, rows = 0;
    assert_non_null(file);
    read_step(file, &before); /* the titles */
    while (read_step(file, &step)) {
        uint32_t expected = enf_map_find_cell(map, step.name);
        uint32_t located = level->locate ? enf_map_locate(map, step.at) : expected;
        cell = rows ? enf_map_track(map, cell, before.at, step.at) : expected;
        if (cell != expected || located != expected) {
            fclose(file);
            fail_msg("%s, row %u (%g, %g, %g): %s, but tracked to %s and located in %s", level->walk, rows, step.at.x,
                     step.at.y, step.at.z, step.name, name_of(map, cell), name_of(map, located));
        }
        before = step;
        rows++;
    }
    fclose(file);
    printf("%s: %u steps\n", level->walk, rows);
    assert_in_range(rows, 100, UINT32_MAX);
}

static void test_walks(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof levels / sizeof *levels; i++) {
        EnfMap map;
        enf_test_compile_map(&map, enf_test_data(levels[i].level));
        walk(&map, &levels[i]);
        enf_map_free(&map);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_walks),
};

ENF_TEST_MAIN(tests)
