/* The experiments on moving objects as they are called: every technique that goes by walls lists the same objects, those that go by
 * the picture lose no pixel of it, none is lost and no volume is late; knobs that are wrong are refused. Times are not looked at. */
#include "harness/program.h"

#include "enfbench/movers_lists.c" /* the benchmark is a program, no library */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Runs enfbench, which must succeed and tell `told`; its CSV, to be freed. */
static char *run_telling(const char *arguments, const char *told) {
    char all[2048];
    size_t size;
    snprintf(all, sizeof all, "run %s --csv '@/rows.csv' --json '@/rows.json'", arguments);
    ENF_TEST_EXPECT("enfbench", all, 0, told);
    return (char *)enf_test_read_file(enf_test_temp_path("rows.csv"), &size);
}

static char *run(const char *arguments) {
    return run_telling(arguments, "");
}

/* Runs enfbench, which must refuse and tell `told`. */
static void refused(const char *arguments, const char *told) {
    char all[2048];
    snprintf(all, sizeof all, "run %s --csv '@/wrong.csv'", arguments);
    ENF_TEST_EXPECT("enfbench", all, 2, told);
}

enum {
    FRAMES = 4,
    MEDIAN = 5,
    LOST = 7,
    OVERDRAW = 9,
    OBJECTS = 14,
    HASH = 15,
    EVALUATED = 23,
    AVOIDED = 27,
    LATE = 28,
    COLUMNS = 36
};

/* Splits a line of the CSV at commas outside quotes. */
static uint32_t split(char *line, char *columns[COLUMNS]) {
    uint32_t count = 0;
    bool quoted = false;
    columns[count++] = line;
    for (char *at = line; *at != '\0'; at++) {
        quoted = *at == '"' ? !quoted : quoted;
        if (*at == ',' && !quoted && count < COLUMNS) {
            *at = '\0';
            columns[count++] = at + 1;
        }
    }
    return count;
}

/* Rows with these techniques: all but `plain` and those without portals list the same. */
static uint32_t check_rows(char *text) {
    char hash[32] = "";
    uint32_t rows = 0;
    char *rest = NULL;
    char *line = strtok_r(text, "\n", &rest);
    assert_non_null(strstr(line, "lost_objects"));
    for (line = strtok_r(NULL, "\n", &rest); line != NULL; line = strtok_r(NULL, "\n", &rest), rows++) {
        char *columns[COLUMNS] = {NULL};
        assert_int_equal(split(line, columns), COLUMNS);
        assert_string_equal(columns[LOST], "0");
        assert_true(columns[LATE][0] == '\0' || strcmp(columns[LATE], "0") == 0);
        if (hash[0] == '\0') {
            snprintf(hash, sizeof hash, "%s", columns[HASH]);
        }
        if (strcmp(hash, columns[HASH]) != 0) {
            fail_msg("%s lists other objects: %s, not %s", columns[2], columns[HASH], hash);
        }
    }
    return rows;
}

#define SAME "policy=update-all,flat,sweep,constant,adaptive,maximal,optimal,reach"

static void test_every_technique_lists_the_same(void **state) {
    (void)state;
    static const char *const motions[] = {"free", "linear", "spline", "character"};
    static const char *const eyes[] = {"still", "walk", "jump"};
    for (int i = 0; i < 12; i++) {
        char arguments[512];
        snprintf(
            arguments, sizeof arguments,
            "movers --set rooms=36 --set movers=%d --set frames=150 --set check=7 --set motion=%s --set eye=%s --set seed=%d "
            "--set speed=%g --set visible=%d --set " SAME,
            97 + 10 * i, motions[i % 4], eyes[i / 4], i, i % 5 == 0 ? 20.0 : 1.4, i % 3 == 0 ? 10 : 0);
        char *text = run(arguments);
        assert_int_equal(check_rows(text), 8);
        free(text);
    }
}

/* The hierarchical Z-buffer and volumes in its octree against the picture: no object that shows a pixel is lost, and few others are
 * listed. The one evaluates every object, the other leaves hidden ones alone. */
static void check_greene(char *text, double movers) {
    char *rest = NULL;
    (void)strtok_r(text, "\n", &rest);
    for (int row = 0; row < 2; row++) {
        char *columns[COLUMNS] = {NULL};
        char *line = strtok_r(NULL, "\n", &rest);
        assert_non_null(line);
        assert_int_equal(split(line, columns), COLUMNS);
        assert_string_equal(columns[2], row == 0 ? "hierarchical-z" : "tbv");
        assert_string_equal(columns[LOST], "0");
        double evaluated = strtod(columns[EVALUATED], NULL);
        double avoided = strtod(columns[AVOIDED], NULL);
        assert_true(row == 0 ? evaluated == movers && avoided == 0.0 : evaluated < 0.7 * movers && avoided > 0.3 * movers);
        assert_true(columns[OVERDRAW][0] == '\0' || strtod(columns[OVERDRAW], NULL) >= 1.0);
        if (!(strtod(columns[OBJECTS], NULL) < 0.5 * movers)) {
            fail_msg("%s lists %s of %g objects: it hides nothing", columns[2], columns[OBJECTS], movers);
        }
    }
}

static void test_hierarchical_z_loses_no_pixel(void **state) {
    (void)state;
    static const char *const motions[] = {"free", "linear", "spline", "character"};
    static const char *const eyes[] = {"still", "walk", "jump"};
    static const double leaves[] = {4.0, 1.5, 30.0};
    for (int i = 0; i < 12; i++) {
        char arguments[512];
        int movers = 60 + 20 * i;
        snprintf(arguments, sizeof arguments,
                 "S4 --set rooms=49 --set movers=%d --set frames=90 --set check=10 --set motion=%s --set eye=%s --set seed=%d "
                 "--set leaf=%g --set occluders=%s --set doors=%d --set door_width=%g --set period=%d --set budget=1000 "
                 "--set policy=hierarchical-z,tbv",
                 movers, motions[i % 4], eyes[i / 4], i, leaves[i % 3], i % 2 == 0 ? "all" : "static", i % 5 == 4 ? 100 : 75,
                 i % 5 == 4 ? 5.0 : 1.25, i % 7 == 6 ? 1 : 64);
        char *text = run(arguments);
        check_greene(text, movers);
        free(text);
    }
}

/* Any first period is a period of its own: longer than the ring of expiries has places, too, and for longer than one of its rounds. */
static void test_volumes_of_the_octree_take_any_period(void **state) {
    (void)state;
    static const char *const periods[] = {"1100", "3000", "1000000000"};
    char evaluated[3][32];
    for (int i = 0; i < 3; i++) {
        char arguments[256];
        char *rest = NULL;
        char *columns[COLUMNS] = {NULL};
        snprintf(arguments, sizeof arguments,
                 "S4 --set rooms=25 --set movers=40 --set frames=4200 --set check=420 --set budget=1000 --set policy=tbv --set "
                 "period=%s",
                 periods[i]);
        char *text = run(arguments);
        (void)strtok_r(text, "\n", &rest);
        assert_int_equal(split(strtok_r(NULL, "\n", &rest), columns), COLUMNS);
        assert_string_equal(columns[LOST], "0");
        snprintf(evaluated[i], sizeof evaluated[i], "%s", columns[EVALUATED]);
        assert_true(i == 0 || strcmp(evaluated[i], evaluated[i - 1]) != 0);
        free(text);
    }
}

/* Rounds of one technique must list the same, and so must all that go by walls: one list that differs in one frame is found, with its
 * frame, and fails the run; a technique that went on for longer, or that has a list of its own, does not. */
static void test_lists_that_differ_are_found(void **state) {
    (void)state;
    const uint64_t model[] = {11, 22, 33, 44}, other[] = {11, 22, 34, 45}, own[] = {1, 2, 3, 4};
    const MoversLists whole = {"whole", model, 4, true}, part = {"part", model, 2, true};
    const MoversLists bad = {"bad", other, 4, true}, early = {"early", other, 2, true}, apart = {"apart", own, 4, false};
    assert_int_equal(bench_lists_part(&whole, &whole), ENF_NONE);
    assert_int_equal(bench_lists_part(&whole, &part), ENF_NONE);
    assert_int_equal(bench_lists_part(&whole, &bad), 2);
    assert_int_equal(bench_lists_part(&bad, &early), ENF_NONE); /* both have but frames that agree */

    const MoversLists agree[] = {part, apart, whole, early};
    const MoversLists differ[] = {early, part, whole, apart, bad};
    assert_true(bench_lists_agree("none", "all agree", agree, 4));
    assert_false(bench_lists_agree("this is a test", "one differs", differ, 5));
    assert_true(bench_lists_agree("none", "nobody", NULL, 0));

    const MoversLists first[] = {whole, apart}, again[] = {part, apart}, wrong[] = {whole, bad};
    assert_true(bench_lists_repeat("none", "the same", 2, first, again, 2));
    assert_false(
        bench_lists_repeat("this is a test", "one differs", 2, first, wrong, 2)); /* also of those with lists of their own */
}

/* Rounds are compared where there are several, and there are as many rows as without. */
static void test_rounds_list_the_same(void **state) {
    (void)state;
    char *text = run("movers --set rooms=16 --set movers=60 --set frames=40 --set rounds=3 --set " SAME);
    assert_int_equal(check_rows(text), 8);
    free(text);
}

static void test_updates_from_both_ends_are_measured(void **state) {
    (void)state;
    static const char *const runs[] = {"S1 --set rooms=16 --set frames=3000 --set seed=3",
                                       "S2 --set boxes=500 --set frames=3000"};
    for (size_t i = 0; i < sizeof runs / sizeof *runs; i++) {
        char *rest = NULL;
        char hash[32] = "";
        char *text = run(runs[i]);
        (void)strtok_r(text, "\n", &rest);
        char *line = strtok_r(NULL, "\n", &rest);
        for (int row = 0; line != NULL; row++, line = strtok_r(NULL, "\n", &rest)) {
            char *columns[COLUMNS] = {NULL};
            assert_int_equal(split(line, columns), COLUMNS);
            assert_string_equal(columns[2], row % 2 == 0 ? "naive" : "lca");
            assert_true(row % 2 == 0 || strcmp(hash, columns[HASH]) == 0); /* the same volumes from both ends */
            snprintf(hash, sizeof hash, "%s", columns[HASH]);
        }
        free(text);
    }
}

/* Knobs that leave nothing of what an experiment varies leave one case of it. What an experiment says of its cases still holds. */
static void test_a_case_is_measured_once(void **state) {
    (void)state;
    char *text = run("S4 --set rooms=8 --set movers=30 --set frames=20 --set policy=flat,reach --set seed=5");
    assert_non_null(strstr(text, "seed=5"));
    assert_int_equal(check_rows(text), 2);
    free(text);
    text = run("S4 --set rooms=9 --set frames=20 --set policy=flat,reach");
    assert_non_null(strstr(text, "movers=36 ")); /* four a room */
    assert_int_equal(check_rows(text), 2);
    free(text);
    text = run("S3 --set rooms=9 --set movers=30 --set frames=20 --set policy=flat,reach");
    assert_int_equal(check_rows(text), 2); /* also where a variant is called by its movers */
    free(text);
}

/* Rows whose scene is `name`, of all. */
static uint32_t count_scene(const char *text, const char *name, uint32_t *all) {
    char begin[64];
    uint32_t count = 0;
    *all = 0;
    snprintf(begin, sizeof begin, ",\"%s\",", name);
    for (const char *line = strchr(text, '\n'); line != NULL && line[1] != '\0'; line = strchr(line + 1, '\n')) {
        const char *comma = strchr(line, ',');
        count += comma != NULL && strncmp(comma, begin, strlen(begin)) == 0 ? 1U : 0U;
        ++*all;
    }
    return count;
}

/* S6 is about periods: who has none is measured once with each eye, who has one with each, and beside it who has none; rows name no
 * knob that their technique has not. Its scenes are called by the eye that there is. */
static void test_periods_vary_for_those_who_have_one(void **state) {
    (void)state;
    uint32_t all = 0;
#define FEW "S6 --set rooms=16 --set movers=40 --set frames=12 "
    char *text = run(FEW "--set policy=maximal,reach");
    assert_int_equal(count_scene(text, "still", &all), 2);
    assert_int_equal(count_scene(text, "walk", &all), 2);
    assert_int_equal(all, 4);
    assert_null(strstr(text, "period="));
    assert_null(strstr(text, "leaf="));
    free(text);
    text = run(FEW "--set policy=constant,reach --set eye=jump");
    assert_int_equal(count_scene(text, "jump", &all), 12);
    assert_int_equal(all, 12);
    assert_non_null(strstr(text, "period=256"));
    free(text);
    text = run(FEW "--set period=9 --set policy=optimal --set eye=still");
    assert_int_equal(count_scene(text, "still", &all), 1);
    assert_int_equal(all, 1);
    free(text);
}

/* Visible ones are some of the movers: more of them are refused, or cases that have fewer are left out, and it is told. Scenes are
 * called by what there is. */
static void test_no_more_are_visible_than_there_are(void **state) {
    (void)state;
    uint32_t all = 0;
    refused("movers --set movers=10 --set visible=11", "visible=11 movers=10");
    refused("losing --set rooms=9 --set visible=1000000 --set policy=reach", "every case was skipped");
    char *text = run_telling(
        "losing --set rooms=9 --set visible=100 --set frames=9 --set speed=1 --set door_width=1 --set doors=50 "
        "--set policy=reach",
        "losing, all visible: movers=10 visible=100: skipped");
    assert_int_equal(count_scene(text, "all visible", &all), 2); /* 100 and 1,000 */
    free(text);
    text = run_telling("million --set rooms=9 --set movers=30 --set frames=9 --set motion=linear --set policy=reach",
                       "movers=30 visible=1000: all movers are visible");
    assert_non_null(strstr(text, "visible=30 "));
    assert_int_equal(count_scene(text, "linear", &all), 1); /* whatever motion a case is meant to have */
    assert_int_equal(count_scene(text, "hidden", &all), 1);
    assert_int_equal(all, 2);
    free(text);
}

/* Scene 1 of the thesis, which hides nothing, goes on to as many movers as the others in each of its tests. */
static void test_scene_1_goes_on(void **state) {
    (void)state;
    char *rest = NULL;
    uint32_t many = 0;
    char *text = run("B1 --set rooms=9 --set movers=40 --set frames=12 --set check=5 --set polygons=12 --set speed=1 "
                     "--set policy=flat,reach");
    (void)strtok_r(text, "\n", &rest);
    for (char *line = strtok_r(NULL, "\n", &rest); line != NULL; line = strtok_r(NULL, "\n", &rest)) {
        char *columns[COLUMNS] = {NULL};
        assert_int_equal(split(line, columns), COLUMNS);
        assert_string_equal(columns[LOST], "0");
        many += strstr(columns[1], ", 40 movers") != NULL && strstr(columns[3], "visible=40 ") != NULL ? 1U : 0U;
    }
    assert_int_equal(many, 4); /* polygons and speed, flat and reach */
    free(text);
}

/* It goes on to as many polygons with many movers as with one; the more a frame takes the fewer there are, but what a row says is the
 * time of three at least. */
static void test_dear_frames_are_few_and_timed(void **state) {
    (void)state;
    static const char *const polygons[] = {"polygons=12 ", "polygons=100 ", "polygons=1000 ", "polygons=10000 "};
    /* Where checks are far apart the first two are not timed; of dear ones all are. */
    static const uint32_t frames[] = {5, 5, 5, 3};
    char *rest = NULL;
    uint32_t many = 0;
    char *text = run("B1 --set rooms=9 --set movers=2000 --set frames=12 --set speed=1 --set budget=0.001 --set policy=reach");
    assert_null(strstr(text, "nan"));
    (void)strtok_r(text, "\n", &rest);
    for (char *line = strtok_r(NULL, "\n", &rest); line != NULL; line = strtok_r(NULL, "\n", &rest)) {
        char *columns[COLUMNS] = {NULL};
        assert_int_equal(split(line, columns), COLUMNS);
        assert_true(strtod(columns[MEDIAN], NULL) > 0.0);
        if (strstr(columns[1], "polygons, 2000 movers") != NULL) {
            assert_non_null(strstr(columns[3], polygons[many]));
            assert_true(strtoul(columns[FRAMES], NULL, 10) >= frames[many]);
            assert_true(many < 3 || strtoul(columns[FRAMES], NULL, 10) == 3);
            many++;
        }
    }
    assert_int_equal(many, 4);
    free(text);
}

static void test_wrong_knobs_are_refused(void **state) {
    (void)state;
    static const char *const wrong[] = {
        "movers --set motion=teleport", "movers --set eye=shut",        "movers --set rooms=0",
        "movers --set policy=fastest",  "movers --set colour=red",      "S7000",
        "S1 --set policy=reach",        "movers --set movers",          "S3 --set leaf=0",
        "S3 --set occluders=chairs",    "S5 --set policy=hierarchical", "movers --set movers=10.5",
        "movers --set doors=37.5",      "B1 --set rooms=9.25"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        refused(wrong[i], "");
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_every_technique_lists_the_same),
    cmocka_unit_test(test_hierarchical_z_loses_no_pixel),
    cmocka_unit_test(test_volumes_of_the_octree_take_any_period),
    cmocka_unit_test(test_lists_that_differ_are_found),
    cmocka_unit_test(test_rounds_list_the_same),
    cmocka_unit_test(test_updates_from_both_ends_are_measured),
    cmocka_unit_test(test_a_case_is_measured_once),
    cmocka_unit_test(test_periods_vary_for_those_who_have_one),
    cmocka_unit_test(test_no_more_are_visible_than_there_are),
    cmocka_unit_test(test_scene_1_goes_on),
    cmocka_unit_test(test_dear_frames_are_few_and_timed),
    cmocka_unit_test(test_wrong_knobs_are_refused),
};

ENF_TEST_MAIN(tests)
