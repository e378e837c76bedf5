/* The program enfview as a user runs it: exit statuses, files, statistics, and that --verify finds what is lost. */
#include "harness/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <enfilade/map.h>

#include "common/png_file.h"
#include "scenes/rooms.h"

enum { COMMAND_SIZE = 2048 };

enum { CRATES = 24 };

#define EXPECT(arguments, status) ENF_TEST_EXPECT("enfview", arguments, status, "")

/* Crates that go about the rooms, and two leaves that turn. */
static void add_movers(EnfMaker *maker) {
    enf_maker_mesh(maker, "crate", 1, (EnfBox3){{-0.25, -0.25, -0.25}, {0.25, 0.25, 0.25}});
    enf_maker_mesh(maker, "leaf", 2, (EnfBox3){{0, 0, -0.0625}, {1, 2, 0.0625}});
    for (uint32_t i = 0; i < CRATES + 2; i++) {
        EnfEntity entity = {{1.0 + 0.3 * i, 1.0, 2.5 + 0.2 * i},
                            {0, 0, 0, 1},
                            {1, 1, 1},
                            enf_maker_string(maker, "mover"),
                            0,
                            0,
                            ENF_NONE,
                            0,
                            ENF_NONE,
                            ENF_NONE};
        EnfMover mover = enf_maker_mover_default();
        mover.entity = enf_maker_entity(maker, &entity);
        mover.mesh = i < CRATES ? 0 : 1;
        mover.kind = i < CRATES ? ENF_MOVER_PATH : ENF_MOVER_HINGE;
        mover.wrap = ENF_WRAP_PING_PONG;
        mover.high = 1.5f;
        mover.seconds = 4.0f;
        mover.phase = 0.5f * (float)i;
        if (i < CRATES) {
            float x = 0.5f + 0.37f * (float)i;
            const float floats[12] = {0, 2, 4, x, 0.5f, 0.5f, x, 2.0f, 9.5f, 9.5f - x, 1.0f, 0.5f};
            EnfPath path = {entity.name, mover.entity, ENF_PATH_TRANSLATION, ENF_PATH_LINEAR, 3, 0};
            mover.translation = enf_maker_path(maker, &path, floats, 12);
        } else {
            memcpy(mover.pivot, entity.translation, sizeof mover.pivot);
        }
        enf_maker_mover(maker, &mover);
    }
}

/* Writes the map of a few rooms; `closed`: with portals shut although nothing fills the doors, so culling must lose pixels. */
static const char *write_map(const char *name, bool closed, bool moving, uint32_t *cluster_count) {
    EnfRoomsDef def = enf_rooms_def_default();
    EnfRooms rooms;
    EnfError error = {0};
    def.nx = def.nz = 2;
    def.extend = moving ? add_movers : NULL;
    assert_true(enf_rooms_create(&rooms, &def, &error));
    EnfMap map = *rooms.map;
    EnfPortal *portals = malloc(map.portals_count * sizeof *portals);
    assert_non_null(portals);
    memcpy(portals, map.portals, map.portals_count * sizeof *portals);
    for (uint32_t i = 0; i < map.portals_count && closed; i++) {
        portals[i].flags |= ENF_PORTAL_CLOSED;
    }
    map.portals = portals;
    const char *path = enf_test_temp_path(name);
    assert_int_equal(enf_map_write(&map, path, &error), ENF_OK);
    *cluster_count = map.clusters_count;
    free(portals);
    enf_rooms_destroy(&rooms);
    return path;
}

static const char *open_map(void) {
    uint32_t count;
    return write_map("rooms.enfmap", false, false, &count);
}

/* Runs enfview; what it prints on stdout, to be freed, in *out. */
static int view(const char *arguments, char **out) {
    EnfTestSaid said;
    int status = enf_test_program("enfview", arguments, &said);
    *out = said.out;
    free(said.err);
    return status;
}

/* Skips where this machine draws nothing in that context. */
static void need_context(const char *map, const char *context) {
    char arguments[COMMAND_SIZE], *out;
    snprintf(arguments, sizeof arguments, "'%s' --eye 1,1,1 --size 8x8 --context %s", map, context);
    int status = view(arguments, &out);
    free(out);
    if (status != 0) {
        printf("no context: %s\n", context);
        skip();
    }
}

static void bad_command_lines_are_refused(void **state) {
    (void)state;
    open_map();
    static const char *const wrong[] = {"",
                                        "--eye 0,0,0",
                                        "'@/rooms.enfmap'",
                                        "'@/rooms.enfmap' --eye 0,0",
                                        "'@/rooms.enfmap' --eye 0,0,0 --cull everything",
                                        "'@/rooms.enfmap' --eye 0,0,0 --size 0x5",
                                        "'@/rooms.enfmap' --eye 0,0,0 --fov-y 180",
                                        "'@/rooms.enfmap' --eye 0,0,0 --debug doors",
                                        "'@/rooms.enfmap' --eye 0,0,0 --debug dbv --dbv off",
                                        "'@/rooms.enfmap' --eye 0,0,0 --tick -1",
                                        "'@/rooms.enfmap' --eye 0,0,0 --tick 0.5",
                                        "'@/rooms.enfmap' --eye 0,0,0 --dbv most",
                                        "'@/rooms.enfmap' --eye 0,0,0 --doors open",
                                        "'@/rooms.enfmap' --eye 0,0,0 --freeze 1,2,3",
                                        "'@/rooms.enfmap' --eye 0,0,0 --verify",
                                        "'@/rooms.enfmap' --eye 0,0,0 --path x.csv",
                                        "'@/rooms.enfmap' --path x.csv --every 0",
                                        "'@/rooms.enfmap' --path x.csv -o x.png",
                                        "'@/rooms.enfmap' --no-such-option"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        EXPECT(wrong[i], 2);
    }
    EXPECT("--help", 0);
    EXPECT("--version", 0);
}

static void failures_have_status_1(void **state) {
    (void)state;
    open_map();
    EXPECT("/nonexistent.enfmap --eye 0,0,0", 1);
    EXPECT("'@/rooms.enfmap' --eye 1,1,1 --cell nowhere", 1);
    EXPECT("'@/rooms.enfmap' --path /nonexistent.csv --verify", 1);
    EXPECT("'@/rooms.enfmap' --eye 1,1,1 -o /nonexistent/x.png", 1);
}

static uint8_t *read_picture(const char *path, uint32_t width, uint32_t height) {
    uint8_t *rgba = NULL;
    uint32_t w = 0, h = 0;
    assert_int_equal(enf_png_read(path, &rgba, &w, &h, NULL), ENF_OK);
    assert_int_equal(w, width);
    assert_int_equal(h, height);
    return rgba;
}

static void ids_and_statistics_are_written(void **state) {
    (void)state;
    uint32_t clusters;
    const char *map = write_map("rooms.enfmap", false, false, &clusters);
    need_context(map, "any");
    EXPECT("'@/rooms.enfmap' --eye 2.5,1.5,4.9 --yaw 30 --size 64x48 --ids '@/ids.png' --raw-ids --stats '@/stats.json'", 0);
    uint8_t *rgba = read_picture(enf_test_temp_path("ids.png"), 64, 48);
    for (uint32_t i = 0; i < 64 * 48; i++) {
        uint32_t id = (uint32_t)rgba[4 * i] | (uint32_t)rgba[4 * i + 1] << 8 | (uint32_t)rgba[4 * i + 2] << 16;
        assert_in_range(id, 0, clusters);
    }
    enf_free(NULL, rgba, (size_t)64 * 48, 4);
    size_t size;
    char *text = (char *)enf_test_read_file(enf_test_temp_path("stats.json"), &size);
    static const char *const keys[] = {"portals_tested", "portals_passed", "requeued", "kd_nodes",     "boxes", "fell_back",
                                       "outside",        "vis_us",         "draw_ms",  "picture_hash", "cells"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        if (!strstr(text, keys[i])) {
            fail_msg("statistics lack %s", keys[i]);
        }
    }
    free(text);
}

static void both_contexts_write_the_same_picture(void **state) {
    (void)state;
    static const char *const contexts[] = {"egl", "osmesa"};
    const char *map = open_map();
    uint8_t *pictures[2];
    for (int i = 0; i < 2; i++) {
        char arguments[COMMAND_SIZE];
        need_context(map, contexts[i]);
        snprintf(arguments, sizeof arguments,
                 "'@/rooms.enfmap' --eye 2.5,1.5,4.9 --yaw 30 --size 160x120 --context %s --debug portals --debug windows "
                 "--debug cells --debug kd -o '@/picture.png'",
                 contexts[i]);
        EXPECT(arguments, 0);
        pictures[i] = read_picture(enf_test_temp_path("picture.png"), 160, 120);
    }
    assert_memory_equal(pictures[0], pictures[1], (size_t)160 * 120 * 4);
    for (int i = 0; i < 2; i++) {
        enf_free(NULL, pictures[i], (size_t)160 * 120, 4);
    }
}

/* PITFALLS 32: vectors of 512 bits, which crash llvmpipe with LLVM 15, are lowered, and the picture is the same. */
static void wide_vectors_are_lowered(void **state) {
    (void)state;
    const char *map = open_map();
    need_context(map, "any");
    const char *out = enf_test_temp_path("vectors.png");
    uint8_t *pictures[2];
    char arguments[COMMAND_SIZE];
    snprintf(arguments, sizeof arguments, "'%s' --eye 2.5,1.5,4.9 --size 64x48 -q -o '%s'", map, out);
    for (int i = 0; i < 2; i++) {
        EnfTestSaid said;
        assert_int_equal(setenv("LP_NATIVE_VECTOR_WIDTH", i ? "512" : "256", 1), 0);
        int status = enf_test_program("enfview", arguments, &said);
        assert_int_equal(unsetenv("LP_NATIVE_VECTOR_WIDTH"), 0);
        assert_int_equal(status, 0);
        assert_int_equal(strstr(said.err, "LP_NATIVE_VECTOR_WIDTH=512") != NULL, i);
        enf_test_said_free(&said);
        pictures[i] = read_picture(out, 64, 48);
    }
    assert_memory_equal(pictures[0], pictures[1], (size_t)64 * 48 * 4);
    for (int i = 0; i < 2; i++) {
        enf_free(NULL, pictures[i], (size_t)64 * 48, 4);
    }
}

/* ---- verification ----------------------------------------------------------------------------------------------- */

/* Through the doors of all four rooms, turning. */
static const char *write_path(uint32_t rows) {
    const char *path = enf_test_temp_path("path.csv");
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "time,x,y,z,yaw,pitch\n");
    for (uint32_t i = 0; i < rows; i++) {
        double t = (double)i / (double)rows;
        fprintf(file, "%g,%g,1.5,%g,%g,0\n", t, 0.75 + 8.5 * t, 0.75 + (i % 2 ? 8.5 : 0.0) * t, 360.0 * 5.0 * t);
    }
    assert_int_equal(fclose(file), 0);
    return path;
}

static char *last_line(char *text) {
    size_t length = strlen(text);
    while (length && text[length - 1] == '\n') {
        text[--length] = '\0';
    }
    char *feed = strrchr(text, '\n');
    return feed ? feed + 1 : text;
}

static void verification_ends_with_a_line_of_json(void **state) {
    (void)state;
    char arguments[COMMAND_SIZE];
    const char *map = open_map(), *path = write_path(21);
    need_context(map, "any");
    const char *cells = enf_test_temp_path("cells.jsonl");
    snprintf(arguments, sizeof arguments, "'%s' --path '%s' --every 4 --verify --size 160x120 --cells '%s'", map, path, cells);
    char *text;
    view(arguments, &text); /* T-junctions of this scene may cost a pixel: test_gl says when; here the report counts */
    char *line = last_line(text);
    assert_int_equal(line[0], '{');
    assert_non_null(strstr(line, "\"views\": 6"));
    static const char *const keys[] = {"lost_pixels",           "lost_views",     "cells_drawn_mean", "clusters_drawn_mean",
                                       "clusters_visible_mean", "overdraw_ratio", "ms_none_median",   "ms_culled_median",
                                       "ratio_median",          "ratio_best",     "vis_us_median",    "vis_us_p99"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        assert_non_null(strstr(line, keys[i]));
    }
    free(text);
    size_t size;
    text = (char *)enf_test_read_file(cells, &size);
    uint32_t lines = 0;
    for (size_t i = 0; i < size; i++) {
        lines += text[i] == '\n';
    }
    assert_int_equal(lines, 6);
    assert_non_null(strstr(text, "\"cells\": [\"room_0_0-room\""));
    free(text);
}

static void what_is_lost_is_found(void **state) {
    (void)state;
    uint32_t clusters;
    char arguments[COMMAND_SIZE];
    const char *map = write_map("closed.enfmap", true, false, &clusters), *path = write_path(21);
    need_context(map, "any");
    snprintf(arguments, sizeof arguments, "'%s' --path '%s' --verify --size 160x120 --quiet", map, path);
    char *text;
    assert_int_equal(view(arguments, &text), 1);
    assert_non_null(strstr(text, "\"lost_pixels\": "));
    assert_null(strstr(text, "\"lost_pixels\": 0,"));
    free(text);
}

/* ---- movers ----------------------------------------------------------------------------------------------------- */

static uint64_t count_after(const char *text, const char *key) {
    const char *at = strstr(text, key);
    assert_non_null(at);
    return strtoull(at + strlen(key), NULL, 10);
}

/* In the world's sixtieth tick and later, with each policy: nothing lost, nothing late, objects drawn. */
static void what_moves_is_drawn_and_verified(void **state) {
    (void)state;
    static const char *const policies[] = {"off", "constant", "adaptive", "maximal", "optimal", "reach"};
    uint32_t clusters;
    char arguments[COMMAND_SIZE];
    const char *map = write_map("moving.enfmap", false, true, &clusters), *path = write_path(41);
    need_context(map, "any");
    const char *movers = enf_test_temp_path("movers.csv");
    static const char recorded[] = "object,time,x,y,z\n0,0,1,0,1\n1,0,2,0,2\n0,2,3,0,8\n0,5,8,0,8\n";
    enf_test_write_file(movers, recorded, strlen(recorded));
    for (size_t i = 0; i < sizeof policies / sizeof *policies; i++) {
        snprintf(arguments, sizeof arguments,
                 "'%s' --path '%s' --verify --size 160x120 --quiet --tick 60 --dbv %s --movers '%s'", map, path, policies[i],
                 movers);
        char *text;
        view(arguments, &text); /* a T-junction may cost a pixel: see above */
        assert_true(count_after(text, "\"lost_views\": ") <= 1);
        assert_int_equal(count_after(text, "\"objects\": "), CRATES + 2 + 2);
        assert_true(count_after(text, "\"objects_drawn_mean\": ") > 0);
        if (i > 0) {
            assert_int_equal(count_after(text, "\"late\": "), 0);
            assert_true(count_after(text, "\"exposed\": ") > 0);
        }
        free(text);
    }
}

/* Time moves pictures, volumes do not; and they are shown. */
static void ticks_and_volumes_are_seen(void **state) {
    (void)state;
    uint32_t clusters;
    char arguments[COMMAND_SIZE];
    const char *map = write_map("moving.enfmap", false, true, &clusters);
    need_context(map, "any");
    static const char *const options[] = {"--tick 0", "--tick 90", "--tick 90 --dbv off", "--tick 90 --debug dbv"};
    uint8_t *pictures[4];
    for (int i = 0; i < 4; i++) {
        snprintf(arguments, sizeof arguments,
                 "'@/moving.enfmap' --eye 2.5,1.5,4.5 --yaw 20 --size 160x120 %s -o '@/tick.png' --stats '@/tick.json'",
                 options[i]);
        EXPECT(arguments, 0);
        pictures[i] = read_picture(enf_test_temp_path("tick.png"), 160, 120);
    }
    assert_memory_equal(pictures[1], pictures[2], (size_t)160 * 120 * 4);
    assert_true(memcmp(pictures[0], pictures[1], (size_t)160 * 120 * 4) != 0);
    assert_true(memcmp(pictures[3], pictures[1], (size_t)160 * 120 * 4) != 0);
    for (int i = 0; i < 4; i++) {
        enf_free(NULL, pictures[i], (size_t)160 * 120, 4);
    }
    size_t size;
    char *text = (char *)enf_test_read_file(enf_test_temp_path("tick.json"), &size);
    static const char *const keys[] = {"evaluated", "exposed", "expired", "reinserted", "avoided", "late", "\"tick\": 90"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        if (!strstr(text, keys[i])) {
            fail_msg("statistics lack %s", keys[i]);
        }
    }
    free(text);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(what_moves_is_drawn_and_verified),
    cmocka_unit_test(ticks_and_volumes_are_seen),
    cmocka_unit_test(bad_command_lines_are_refused),
    cmocka_unit_test(failures_have_status_1),
    cmocka_unit_test(ids_and_statistics_are_written),
    cmocka_unit_test(both_contexts_write_the_same_picture),
    cmocka_unit_test(verification_ends_with_a_line_of_json),
    cmocka_unit_test(what_is_lost_is_found),
    cmocka_unit_test(wide_vectors_are_lowered),
};

ENF_TEST_MAIN(tests)
