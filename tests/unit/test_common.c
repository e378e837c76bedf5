/* What the programs share: options, reports, camera paths, PNG files. */
#include "common/cli.h"
#include "common/mover_csv.h"
#include "common/path_csv.h"
#include "common/png_file.h"
#include "common/report.h"
#include "harness/harness.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- options ---------------------------------------------------------------------------------------------------- */

typedef struct Values {
    bool flag;
    const char *text;
    double number, vector[3];
    uint32_t count, size[2];
    int choice;
    EnfOptionList list;
} Values;

/* Parses a command line given as words; the last is NULL. Messages go nowhere. */
static EnfCliResult parse(Values *values, const char **positional, uint32_t *positional_count, const char **words) {
    const EnfOption table[] = {
        {"--flag", "-f", ENF_OPTION_FLAG, &values->flag, NULL, NULL, "a flag"},
        {"--text", "-t", ENF_OPTION_TEXT, &values->text, "TEXT", NULL, "a text"},
        {"--number", NULL, ENF_OPTION_NUMBER, &values->number, "N", NULL, "a number"},
        {"--count", NULL, ENF_OPTION_COUNT, &values->count, "N", NULL, "a count"},
        {"--eye", NULL, ENF_OPTION_VECTOR, values->vector, "X,Y,Z", NULL, "a vector"},
        {"--size", NULL, ENF_OPTION_SIZE, values->size, "WxH", NULL, "a size"},
        {"--cull", NULL, ENF_OPTION_CHOICE, &values->choice, NULL, "none|frustum|worklist", "a choice"},
        {"--set", NULL, ENF_OPTION_LIST, &values->list, "KEY=VALUE", NULL, "a list"},
    };
    const EnfCli cli = {"test", "FILE", "A test.", table, sizeof table / sizeof *table};
    char *argv[16] = {NULL};
    char copies[16][64];
    int argc = 1;
    memset(values, 0, sizeof *values);
    for (; words[argc - 1]; argc++) {
        strncpy(copies[argc], words[argc - 1], sizeof copies[argc] - 1);
        copies[argc][sizeof copies[argc] - 1] = '\0';
        argv[argc] = copies[argc];
    }
    int saved = dup(STDERR_FILENO);
    assert_non_null(freopen("/dev/null", "w", stderr));
    EnfCliResult result = enf_cli_parse(&cli, argc, argv, positional, 2, positional_count);
    fflush(stderr);
    dup2(saved, STDERR_FILENO);
    close(saved);
    return result;
}

static void options_are_read(void **state) {
    (void)state;
    Values v;
    const char *positional[2];
    uint32_t count;
    assert_int_equal(parse(&v, positional, &count,
                           (const char *[]){"--flag", "--number=-2.5e1", "--eye", "-1,2.5,3e2", "--size", "640x480", "--cull",
                                            "worklist", "--count", "7", "--set", "a=1", "--set=b=2", NULL}),
                     ENF_CLI_RUN);
    assert_true(v.flag);
    assert_true(v.number == -25 && v.vector[0] == -1 && v.vector[1] == 2.5 && v.vector[2] == 300);
    assert_int_equal(v.size[0], 640);
    assert_int_equal(v.size[1], 480);
    assert_int_equal(v.choice, 2);
    assert_int_equal(v.count, 7);
    assert_int_equal(v.list.count, 2);
    assert_int_equal(count, 0);
    assert_int_equal(parse(&v, positional, &count, (const char *[]){"a", "-f", "--", "--flag", NULL}), ENF_CLI_RUN);
    assert_int_equal(count, 2);
}

static void bad_options_are_refused(void **state) {
    (void)state;
    static const char *const bad[][3] = {{"--nothing", NULL, NULL}, {"--number", "x", NULL},    {"--number", "1x", NULL},
                                         {"--number", "inf", NULL}, {"--number", "", NULL},     {"--number", NULL, NULL},
                                         {"--eye", "1,2", NULL},    {"--eye", "1,2,3,4", NULL}, {"--eye", "1, 2,3", NULL},
                                         {"--size", "0x4", NULL},   {"--size", "4", NULL},      {"--size", "4x99999", NULL},
                                         {"--cull", "box", NULL},   {"--cull", "", NULL},       {"--count", "-1", NULL},
                                         {"--count", "4294967296"}, {"--flag=1", NULL, NULL},   {"--number", "nan", NULL}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        Values v;
        const char *positional[2], *words[4] = {bad[i][0], bad[i][1], bad[i][2], NULL};
        uint32_t count;
        if (parse(&v, positional, &count, words) != ENF_CLI_USAGE) {
            fail_msg("%s %s was taken", words[0], words[1] ? words[1] : "");
        }
    }
    Values v;
    const char *positional[2];
    uint32_t count;
    assert_int_equal(parse(&v, positional, &count, (const char *[]){"a", "b", "c", NULL}), ENF_CLI_USAGE);
}

/* ---- reports ---------------------------------------------------------------------------------------------------- */

static void reports_are_json(void **state) {
    (void)state;
    EnfReport r;
    memset(&r, 0, sizeof r);
    enf_report_object(&r, NULL);
    enf_report_text(&r, "text", "a\"b\\c\n\x01 \xc3\xa9 \xff");
    enf_report_number(&r, "tenth", 0.1);
    enf_report_number(&r, "nothing", (double)NAN);
    enf_report_count(&r, "big", UINT64_MAX);
    enf_report_array(&r, "list");
    enf_report_bool(&r, NULL, true);
    enf_report_object(&r, NULL);
    enf_report_end_object(&r);
    enf_report_null(&r, NULL);
    enf_report_end_array(&r);
    enf_report_end_object(&r);
    assert_false(r.failed);
    assert_string_equal(r.text, "{\"text\": \"a\\\"b\\\\c\\u000a\\u0001 \xc3\xa9 \xef\xbf\xbd\", \"tenth\": 0.1, "
                                "\"nothing\": null, \"big\": 18446744073709551615, \"list\": [true, {}, null]}");
    enf_report_free(&r);
}

static void numbers_read_back(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    for (uint32_t i = 0; i < enf_test_rounds(20000, 1000000); i++) {
        uint64_t bits = enf_test_u64(&rng);
        double value;
        char text[32];
        memcpy(&value, &bits, sizeof value);
        enf_report_print_number(value, text);
        assert_true(isfinite(value) ? strtod(text, NULL) == value : strcmp(text, "null") == 0);
    }
}

/* ---- paths ------------------------------------------------------------------------------------------------------ */

static EnfResult read_path(EnfPathCsv *path, const char *text, EnfError *error) {
    const char *name = enf_test_temp_path("path.csv");
    enf_test_write_file(name, text, strlen(text));
    memset(error, 0, sizeof *error);
    return enf_path_csv_read(path, name, error);
}

static void paths_are_read(void **state) {
    (void)state;
    EnfPathCsv path;
    EnfError error;
    assert_int_equal(read_path(&path,
                               "\xef\xbb\xbfz, x,y,time,yaw,extra,inside\r\n3,1,2,0.5,-90,word,1\r\n\r\n# note\n6,4,5,1,90,,0",
                               &error),
                     ENF_OK);
    assert_int_equal(path.count, 2);
    assert_true(path.rows[0].x == 1 && path.rows[0].y == 2 && path.rows[0].z == 3 && path.rows[0].time == 0.5);
    assert_true(path.rows[0].yaw_deg == -90 && path.rows[0].pitch_deg == 0 && path.rows[0].inside);
    assert_false(path.rows[1].inside);
    enf_path_csv_free(&path);
}

static void bad_paths_are_refused(void **state) {
    (void)state;
    static const char *const bad[] = {"",
                                      "\n\n",
                                      "time,x,y,z\n1,2,3,4\n",
                                      "time,x,y,z,yaw\n",
                                      "time,x,y,z,yaw\n1,2,3,4\n",
                                      "time,x,y,z,yaw\n1,2,3,4,west\n",
                                      "time,x,y,z,yaw\n1,2,3,inf,5\n",
                                      "time,x,y,z,yaw\n1,,3,4,5\n"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        EnfPathCsv path;
        EnfError error;
        assert_int_not_equal(read_path(&path, bad[i], &error), ENF_OK);
        assert_non_null(strstr(error.file, "path.csv"));
        assert_null(path.rows);
    }
}

static void real_paths_are_read(void **state) {
    (void)state;
    EnfPathCsv path;
    EnfError error;
    assert_int_equal(enf_path_csv_read(&path, enf_test_data("freedoom/MAP26_rooms.demo.csv"), &error), ENF_OK);
    assert_in_range(path.count, 100, 100000);
    enf_path_csv_free(&path);
}

/* ---- pictures --------------------------------------------------------------------------------------------------- */

static void pictures_come_back(void **state) {
    (void)state;
    enum { WIDTH = 37, HEIGHT = 19 };
    EnfTestRng rng = enf_test_rng(2);
    uint8_t rgba[4 * WIDTH * HEIGHT], *read;
    uint32_t width, height;
    EnfError error;
    for (size_t i = 0; i < sizeof rgba; i++) {
        rgba[i] = (uint8_t)enf_test_u32(&rng);
    }
    for (int opaque = 0; opaque < 2; opaque++) {
        const char *name = enf_test_temp_path("picture.png");
        assert_int_equal(enf_png_write(name, rgba, WIDTH, HEIGHT, opaque, &error), ENF_OK);
        assert_int_equal(enf_png_read(name, &read, &width, &height, &error), ENF_OK);
        assert_int_equal(width, WIDTH);
        assert_int_equal(height, HEIGHT);
        for (size_t i = 0; i < sizeof rgba; i++) {
            assert_int_equal(read[i], opaque && i % 4 == 3 ? 255 : rgba[i]);
        }
        enf_free(NULL, read, (size_t)WIDTH * HEIGHT, 4);
    }
    enf_test_write_file(enf_test_temp_path("bad.png"), "\x89PNG\r\n\x1a\n....", 12);
    assert_int_equal(enf_png_read(enf_test_temp_path("bad.png"), &read, &width, &height, &error), ENF_ERROR_FORMAT);
    assert_int_not_equal(enf_png_write(enf_test_temp_path("none.png"), rgba, 0, 1, true, &error), ENF_OK);
}

/* ---- recorded objects --------------------------------------------------------------------------------------------- */

static EnfResult read_movers(EnfMoverCsv *csv, const char *text, EnfError *error) {
    const char *name = enf_test_temp_path("movers.csv");
    enf_test_write_file(name, text, strlen(text));
    memset(error, 0, sizeof *error);
    return enf_mover_csv_read(csv, name, error);
}

static void recorded_objects(void **state) {
    (void)state;
    EnfMoverCsv csv;
    EnfError error;
    /* Two objects by turns, columns in another order, one row that comes twice. */
    const char *text = "x,y,z,time,object,cell\n0,1,0,5,7,a\n9,9,9,0,8,b\n1,1,0,6,7,a\n5,5,5,6,7,a\n1,1,2,7,7,a\n";
    assert_int_equal(read_movers(&csv, text, &error), ENF_OK);
    assert_int_equal(csv.count, 2);
    assert_true(csv.objects[0].object == 7 && csv.objects[0].count == 3 && csv.objects[1].count == 1);
    assert_true(csv.objects[0].times[0] == 0.0F && csv.objects[0].times[2] == 2.0F);
    EnfMotion straight, smooth;
    assert_true(enf_mover_csv_motion(&csv.objects[0], false, ENF_WRAP_PING_PONG, &straight));
    assert_true(enf_mover_csv_motion(&csv.objects[0], true, ENF_WRAP_LOOP, &smooth));
    assert_int_equal(straight.as.path.period_ticks, 2 * ENF_TICK_RATE);
    for (int64_t second = 0; second <= 2; second++) { /* both go through the points in time */
        const float *p = csv.objects[0].points + 3 * second;
        int64_t tick = second * ENF_TICK_RATE - (second == 2); /* a loop is at its start again at its end */
        EnfVec3 at = enf_motion_state(&smooth, tick).position;
        assert_true(enf_length(enf_sub(at, enf_v3((double)p[0], (double)p[1], (double)p[2]))) < (second == 2 ? 0.05 : 1e-6));
    }
    EnfVec3 back = enf_motion_state(&straight, 3 * ENF_TICK_RATE).position; /* there in 2 s, and half the way back */
    assert_true(enf_length(enf_sub(back, enf_v3(1, 1, 0))) < 1e-6);
    enf_mover_csv_free(&csv);
}

static void recorded_objects_that_are_refused(void **state) {
    (void)state;
    static const char *const texts[][2] = {
        {"", "empty"},
        {"object,time,x,y\n", "`z`"},
        {"object,time,x,y,z\n", "no row"},
        {"object,time,x,y,z\n1,0,0,0\n", "line 2: column `z`"},
        {"object,time,x,y,z\n1,0,0,zero,0\n", "`y` is not a number"},
        {"object,time,x,y,z\n1.5,0,0,0,0\n", "whole number"},
        {"object,time,x,y,z\n1,0,1e300,0,0\n", "float"},
        {"object,time,x,y,z\n1,0,0,0,0\n1,1e9,0,0,0\n", "too long after"},
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        EnfMoverCsv csv;
        EnfError error;
        assert_int_not_equal(read_movers(&csv, texts[i][0], &error), ENF_OK);
        if (!strstr(error.message, texts[i][1])) {
            fail_msg("%s is not in: %s", texts[i][1], error.message);
        }
        assert_true(csv.objects == NULL && csv.count == 0);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(recorded_objects),    cmocka_unit_test(recorded_objects_that_are_refused),
    cmocka_unit_test(options_are_read),    cmocka_unit_test(bad_options_are_refused),
    cmocka_unit_test(reports_are_json),    cmocka_unit_test(numbers_read_back),
    cmocka_unit_test(paths_are_read),      cmocka_unit_test(bad_paths_are_refused),
    cmocka_unit_test(real_paths_are_read), cmocka_unit_test(pictures_come_back),
};
ENF_TEST_MAIN(tests)
