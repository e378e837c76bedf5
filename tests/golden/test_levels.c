/* Real levels: each compiles, loses no pixel along its recorded paths, and shows the cells that its brute-force visibility
 * names (`must`: cells with at least four solid 2 × 2 blocks of pixels). The programs do the work, as a user runs them. */
#include "harness/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/peopled.h"

/** A level of the shared data, and a path through it. */
typedef struct Level {
    const char *name; /**< "freedoom/MAP01_rooms" */
    const char *path; /**< "walk" */
} Level;

enum { COMMAND_SIZE = 4096, TEXT_SIZE = 1 << 16 };

/* ---- commands --------------------------------------------------------------------------------------------------- */

/* "freedoom/MAP01_rooms" + ".walk.csv" in the shared data; skips where it is absent. */
static const char *data_file(const Level *level, const char *path, const char *ending) {
    char relative[256];
    snprintf(relative, sizeof relative, "%s%s%s%s", level->name, *path ? "." : "", path, ending);
    return enf_test_data(relative);
}

/* The compiled map; compiled at its first use. */
static const char *map_of(const Level *level) {
    char name[256];
    const char *slash = strrchr(level->name, '/');
    snprintf(name, sizeof name, "%s.enfmap", slash ? slash + 1 : level->name);
    const char *map = enf_test_temp_path(name);
    FILE *there = fopen(map, "rb");
    if (there) {
        fclose(there);
        return map;
    }
    assert_int_equal(enf_test_enfc(data_file(level, "", ".glb"), "", map), 0);
    return map;
}

/* Skips where this machine draws nothing. */
static void need_pictures(const char *map) {
    char arguments[COMMAND_SIZE];
    snprintf(arguments, sizeof arguments, "'%s' --eye 0,0,0 --size 16x16 --quiet", map);
    if (enf_test_program("enfview", arguments, NULL) != 0) {
        printf("no picture can be drawn here\n");
        skip();
    }
}

/* Verifies each `every`th row of a path; the cells seen go to `cells` unless NULL. */
static void verify(const char *map, const char *path, uint32_t every, const char *cells, const char *more) {
    char arguments[COMMAND_SIZE];
    snprintf(arguments, sizeof arguments, "'%s' --path '%s' --every %u --verify --quiet %s %s%s%s", map, path, every, more,
             cells ? "--cells '" : "", cells ? cells : "", cells ? "'" : "");
    assert_int_equal(enf_test_program("enfview", arguments, NULL), 0);
}

/* ---- visible cells ---------------------------------------------------------------------------------------------- */

/* The number after `key` in a line of JSON. */
static double number_after(const char *line, const char *key) {
    const char *at = strstr(line, key);
    if (!at) {
        fail_msg("%s is missing in: %.80s", key, line);
        return 0.0;
    }
    return strtod(at + strlen(key), NULL);
}

/* Writes the eyes of every `every`th line of a .vis.jsonl as a path; returns how many. */
static uint32_t write_eyes(const char *vis, uint32_t every, const char *path) {
    FILE *in = fopen(vis, "r"), *out = fopen(path, "w");
    assert_true(in && out);
    char *line = malloc(TEXT_SIZE);
    assert_non_null(line);
    uint32_t rows = 0;
    fprintf(out, "time,x,y,z,yaw,pitch\n");
    for (uint32_t i = 0; fgets(line, TEXT_SIZE, in); i++) {
        double eye[3] = {0};
        const char *pos = strstr(line, "\"pos\":[");
        if (i % every != 0) {
            continue;
        }
        assert_true(pos && sscanf(pos, "\"pos\":[%lf,%lf,%lf]", &eye[0], &eye[1], &eye[2]) == 3);
        fprintf(out, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", number_after(line, "\"time\":"), eye[0], eye[1], eye[2],
                number_after(line, "\"yaw\":"), number_after(line, "\"pitch\":"));
        rows++;
    }
    free(line);
    fclose(in);
    assert_int_equal(fclose(out), 0);
    return rows;
}

/* Is every name of `must` (["a","b"]) a cell of the line that enfview wrote (["a-room",...])? */
static void check_must(const char *must_line, const char *cells_line) {
    const char *at = strstr(must_line, "\"must\":[");
    assert_non_null(at);
    const char *end = strchr(at, ']');
    at += strlen("\"must\":[");
    while (at < end && *at == '"') {
        const char *close = strchr(at + 1, '"');
        char cell[128], room[128];
        snprintf(cell, sizeof cell, "%.*s\"", (int)(close - at), at);
        snprintf(room, sizeof room, "%.*s-room\"", (int)(close - at), at);
        if (!strstr(cells_line, cell) && !strstr(cells_line, room)) {
            fail_msg("cell %s is visible and not among: %s at %.120s", cell, cells_line, must_line);
        }
        at = close + 1 + (close[1] == ',');
    }
}

static uint32_t check_cells(const char *vis, uint32_t every, const char *cells) {
    FILE *must = fopen(vis, "r"), *seen = fopen(cells, "r");
    assert_true(must && seen);
    char *must_line = malloc(TEXT_SIZE), *seen_line = malloc(TEXT_SIZE);
    assert_true(must_line && seen_line);
    uint32_t rows = 0;
    for (uint32_t i = 0; fgets(must_line, TEXT_SIZE, must); i++) {
        if (i % every == 0) {
            assert_non_null(fgets(seen_line, TEXT_SIZE, seen));
            check_must(must_line, seen_line);
            rows++;
        }
    }
    free(must_line);
    free(seen_line);
    fclose(must);
    fclose(seen);
    return rows;
}

/* ---- cases ------------------------------------------------------------------------------------------------------ */

static void no_pixel_is_lost(void **state) {
    const Level *level = *state;
    const char *path = data_file(level, level->path, ".csv");
    const char *map = map_of(level);
    need_pictures(map);
    verify(map, path, enf_test_long() ? 10 : 601, NULL, "");
}

static void cells_that_must_be_seen_are(void **state) {
    const Level *level = *state;
    const char *vis = data_file(level, level->path, ".vis.jsonl");
    const char *map = map_of(level);
    need_pictures(map);
    const char *eyes = enf_test_temp_path("eyes.csv"), *cells = enf_test_temp_path("cells.jsonl");
    uint32_t every = enf_test_long() ? 1 : 17;
    uint32_t rows = write_eyes(vis, every, eyes);
    assert_true(rows > 0);
    verify(map, eyes, 1, cells, "");
    assert_int_equal(check_cells(vis, every, cells), rows);
}

/* Among 200 objects that go about, with volumes of two policies. */
static void no_pixel_is_lost_among_movers(void **state) {
    const Level *level = *state;
    static const char *const options[] = {"--dbv maximal", "--dbv adaptive --cull sequences --window polygon"};
    const char *path = data_file(level, level->path, ".csv");
    char name[128];
    const char *from = map_of(level), *slash = strrchr(level->name, '/');
    snprintf(name, sizeof name, "peopled_%s.enfmap", slash ? slash + 1 : level->name);
    const char *peopled = enf_test_temp_path(name);
    EnfMap map;
    EnfError error = {0};
    assert_int_equal(enf_map_read(&map, from, NULL, &error), ENF_OK);
    if (enf_peopled_write(&map, 200, enf_test_seed(), peopled, &error) != ENF_OK) {
        fail_msg("%s", error.message);
    }
    enf_map_free(&map);
    need_pictures(peopled);
    for (int i = 0; i < 2; i++) {
        verify(peopled, path, enf_test_long() ? 60 : 1201, NULL, options[i]);
    }
}

/* The palace with its own life, and doors that close their portals while they are shut: what closes a portal must hide all beyond. */
static void the_palace_loses_nothing(void **state) {
    (void)state;
    const char *map = enf_test_temp_path("palace.enfmap");
    assert_int_equal(enf_test_compile_palace(map), 0);
    need_pictures(map);
    verify(map, enf_test_source_path("maps/palace/tour.csv"), enf_test_long() ? 30 : 2000, NULL, "--doors close --dbv reach");
}

/* X(level, path): levels with cells and portals made by others. */
#define LEVELS(X)                                                                                                              \
    X("freedoom/E1M1_rooms", "walk")                                                                                           \
    X("freedoom/E1M1_sector", "walk")                                                                                          \
    X("freedoom/E3M8_rooms", "walk")                                                                                           \
    X("freedoom/MAP01_rooms", "walk")                                                                                          \
    X("freedoom/MAP26_rooms", "walk")                                                                                          \
    X("freedoom/MAP26_rooms", "demo")                                                                                          \
    X("buildings/duplex", "walk")

#define LEVEL_STATE(name, path)                                                                                                \
    &(Level) {                                                                                                                 \
        name, path                                                                                                             \
    }
#define LEVEL_TESTS(name, path)                                                                                                \
    {"no_pixel_is_lost:" name "." path, no_pixel_is_lost, NULL, NULL, LEVEL_STATE(name, path)},                                \
        {"no_pixel_is_lost_among_movers:" name "." path, no_pixel_is_lost_among_movers, NULL, NULL, LEVEL_STATE(name, path)},  \
        {"cells_that_must_be_seen_are:" name "." path, cells_that_must_be_seen_are, NULL, NULL, LEVEL_STATE(name, path)},

static const struct CMUnitTest tests[] = {LEVELS(LEVEL_TESTS) cmocka_unit_test(the_palace_loses_nothing)};

ENF_TEST_MAIN(tests)
