/* The program enfview as a user runs it: exit statuses, files, statistics, and that --verify finds what is lost. */
#include "harness/harness.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <enfilade/map.h>

#include "common/png_file.h"
#include "scenes/rooms.h"

enum { COMMAND_SIZE = 2048 };

/* Writes the map of a few rooms; `closed`: with portals shut although nothing fills the doors, so culling must lose pixels. */
static const char *write_map(const char *name, bool closed, uint32_t *cluster_count) {
    EnfRoomsDef def = enf_rooms_def_default();
    EnfRooms rooms;
    EnfError error = {0};
    def.nx = def.nz = 2;
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
    return write_map("rooms.enfmap", false, &count);
}

/* Runs enfview; `output` (NULL: thrown away) gets what it prints on stdout. */
static int view(const char *arguments, const char *output) {
    char command[3 * COMMAND_SIZE];
    snprintf(command, sizeof command, "'%s/enfview' %s > '%s' 2> /dev/null", ENF_BIN_DIR, arguments,
             output ? output : "/dev/null");
    return enf_test_shell(command);
}

/* Skips where this machine draws nothing in that context. */
static void need_context(const char *map, const char *context) {
    char arguments[COMMAND_SIZE];
    snprintf(arguments, sizeof arguments, "'%s' --eye 1,1,1 --size 8x8 --context %s", map, context);
    if (view(arguments, NULL) != 0) {
        printf("no context: %s\n", context);
        skip();
    }
}

static void bad_command_lines_are_refused(void **state) {
    (void)state;
    const char *map = open_map();
    static const char *const wrong[] = {"",
                                        "--eye 0,0,0",
                                        "'%s'",
                                        "'%s' --eye 0,0",
                                        "'%s' --eye 0,0,0 --cull everything",
                                        "'%s' --eye 0,0,0 --size 0x5",
                                        "'%s' --eye 0,0,0 --fov-y 180",
                                        "'%s' --eye 0,0,0 --debug doors",
                                        "'%s' --eye 0,0,0 --freeze 1,2,3",
                                        "'%s' --eye 0,0,0 --verify",
                                        "'%s' --eye 0,0,0 --path x.csv",
                                        "'%s' --path x.csv --every 0",
                                        "'%s' --path x.csv -o x.png",
                                        "'%s' --no-such-option"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char arguments[COMMAND_SIZE];
        const char *hole = strstr(wrong[i], "%s");
        int before = hole ? (int)(hole - wrong[i]) : (int)strlen(wrong[i]);
        snprintf(arguments, sizeof arguments, "%.*s%s%s", before, wrong[i], hole ? map : "", hole ? hole + 2 : "");
        if (view(arguments, NULL) != 2) {
            fail_msg("not refused: enfview %s", arguments);
        }
    }
    assert_int_equal(view("--help", NULL), 0);
    assert_int_equal(view("--version", NULL), 0);
}

static void failures_have_status_1(void **state) {
    (void)state;
    char arguments[COMMAND_SIZE];
    const char *map = open_map();
    assert_int_equal(view("/nonexistent.enfmap --eye 0,0,0", NULL), 1);
    snprintf(arguments, sizeof arguments, "'%s' --eye 1,1,1 --cell nowhere", map);
    assert_int_equal(view(arguments, NULL), 1);
    snprintf(arguments, sizeof arguments, "'%s' --path /nonexistent.csv --verify", map);
    assert_int_equal(view(arguments, NULL), 1);
    snprintf(arguments, sizeof arguments, "'%s' --eye 1,1,1 -o /nonexistent/x.png", map);
    assert_int_equal(view(arguments, NULL), 1);
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
    char arguments[COMMAND_SIZE];
    const char *map = write_map("rooms.enfmap", false, &clusters);
    need_context(map, "any");
    const char *ids = enf_test_temp_path("ids.png"), *stats = enf_test_temp_path("stats.json");
    snprintf(arguments, sizeof arguments, "'%s' --eye 2.5,1.5,4.9 --yaw 30 --size 64x48 --ids '%s' --raw-ids --stats '%s'", map,
             ids, stats);
    assert_int_equal(view(arguments, NULL), 0);
    uint8_t *rgba = read_picture(ids, 64, 48);
    for (uint32_t i = 0; i < 64 * 48; i++) {
        uint32_t id = (uint32_t)rgba[4 * i] | (uint32_t)rgba[4 * i + 1] << 8 | (uint32_t)rgba[4 * i + 2] << 16;
        assert_in_range(id, 0, clusters);
    }
    enf_free(NULL, rgba, (size_t)64 * 48, 4);
    size_t size;
    char *text = (char *)enf_test_read_file(stats, &size);
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
        const char *out = enf_test_temp_path("picture.png");
        snprintf(arguments, sizeof arguments,
                 "'%s' --eye 2.5,1.5,4.9 --yaw 30 --size 160x120 --context %s --debug portals --debug windows --debug cells "
                 "--debug kd -o '%s'",
                 map, contexts[i], out);
        assert_int_equal(view(arguments, NULL), 0);
        pictures[i] = read_picture(out, 160, 120);
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
    const char *out = enf_test_temp_path("vectors.png"), *said = enf_test_temp_path("said.txt");
    uint8_t *pictures[2];
    for (int i = 0; i < 2; i++) {
        char command[3 * COMMAND_SIZE];
        snprintf(command, sizeof command,
                 "LP_NATIVE_VECTOR_WIDTH=%d '%s/enfview' '%s' --eye 2.5,1.5,4.9 --size 64x48 -q -o '%s' 2> '%s'", i ? 512 : 256,
                 ENF_BIN_DIR, map, out, said);
        assert_int_equal(enf_test_shell(command), 0);
        pictures[i] = read_picture(out, 64, 48);
    }
    assert_memory_equal(pictures[0], pictures[1], (size_t)64 * 48 * 4);
    size_t size;
    char *text = (char *)enf_test_read_file(said, &size);
    assert_non_null(strstr(text, "LP_NATIVE_VECTOR_WIDTH=512"));
    free(text);
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
    const char *out = enf_test_temp_path("out.txt"), *cells = enf_test_temp_path("cells.jsonl");
    snprintf(arguments, sizeof arguments, "'%s' --path '%s' --every 4 --verify --size 160x120 --cells '%s'", map, path, cells);
    view(arguments, out); /* T-junctions of this scene may cost a pixel: test_gl says when; here the report counts */
    size_t size;
    char *text = (char *)enf_test_read_file(out, &size), *line = last_line(text);
    assert_int_equal(line[0], '{');
    assert_non_null(strstr(line, "\"views\": 6"));
    static const char *const keys[] = {"lost_pixels",           "lost_views",     "cells_drawn_mean", "clusters_drawn_mean",
                                       "clusters_visible_mean", "overdraw_ratio", "ms_none_median",   "ms_culled_median",
                                       "ratio_median",          "ratio_best",     "vis_us_median",    "vis_us_p99"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        assert_non_null(strstr(line, keys[i]));
    }
    free(text);
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
    const char *map = write_map("closed.enfmap", true, &clusters), *path = write_path(21);
    need_context(map, "any");
    const char *out = enf_test_temp_path("out.txt");
    snprintf(arguments, sizeof arguments, "'%s' --path '%s' --verify --size 160x120 --quiet", map, path);
    assert_int_equal(view(arguments, out), 1);
    size_t size;
    char *text = (char *)enf_test_read_file(out, &size);
    assert_null(strstr(text, "\"lost_pixels\": 0,"));
    free(text);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(bad_command_lines_are_refused),
    cmocka_unit_test(failures_have_status_1),
    cmocka_unit_test(ids_and_statistics_are_written),
    cmocka_unit_test(both_contexts_write_the_same_picture),
    cmocka_unit_test(verification_ends_with_a_line_of_json),
    cmocka_unit_test(what_is_lost_is_found),
    cmocka_unit_test(wide_vectors_are_lowered),
};

ENF_TEST_MAIN(tests)
