/* The harness tests itself: its generator against published numbers, its folders, its files, its purse. */
#include "harness/purse.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The first numbers of the reference pcg32 with seed 42 and stream 54, as its demonstration program prints them. */
static void rng_matches_reference(void **state) {
    (void)state;
    static const uint32_t expected[6] = {0xa15c02b7, 0x7b47f409, 0xba1d3330, 0x83d2f293, 0xbfa4784b, 0xcbed606e};
    EnfTestRng rng = enf_test_rng_fixed(42, 54);
    for (int i = 0; i < 6; i++) {
        assert_int_equal(enf_test_u32(&rng), expected[i]);
    }
}

static void rng_stays_in_range(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    uint32_t seen[7] = {0};
    for (int i = 0; i < 7000; i++) {
        seen[enf_test_below(&rng, 7)]++;
        double value = enf_test_double(&rng, -2.0, 3.0);
        assert_true(value >= -2.0 && value < 3.0);
    }
    for (int i = 0; i < 7; i++) {
        assert_in_range(seen[i], 800, 1200); /* mean 1000, deviation 29 */
    }
    assert_int_equal(enf_test_below(&rng, 0), 0);
}

static void streams_differ_and_repeat(void **state) {
    (void)state;
    EnfTestRng one = enf_test_rng(1), again = enf_test_rng(1), two = enf_test_rng(2);
    uint64_t first = enf_test_u64(&one);
    assert_true(first == enf_test_u64(&again));
    assert_true(first != enf_test_u64(&two));
}

static void temporary_files_round_trip(void **state) {
    (void)state;
    static const uint8_t bytes[5] = {0, 1, 2, 0, 255};
    const char *path = enf_test_temp_path("five.bin");
    enf_test_write_file(path, bytes, sizeof bytes);
    size_t size = 0;
    uint8_t *read = enf_test_read_file(path, &size);
    assert_int_equal(size, sizeof bytes);
    assert_memory_equal(read, bytes, sizeof bytes);
    free(read);
}

static void absent_data_is_null(void **state) {
    (void)state;
    assert_null(enf_test_data_path("no such folder/no such file"));
    assert_non_null(enf_test_source_path("tests/suites.inl"));
    assert_int_equal(access(enf_test_source_path("tests/suites.inl"), R_OK), 0);
}

static void shell_gives_the_exit_status(void **state) {
    (void)state;
    assert_int_equal(enf_test_shell("exit 3"), 3);
    assert_int_equal(enf_test_shell("kill -9 $$"), 128 + 9);
}

/* Asks a purse for ten blocks, bit i of the result: the i-th was given; grows each given one, and gives all back. */
static uint32_t ask_ten_times(Purse *purse, uint32_t *most) {
    uint8_t *blocks[10];
    uint32_t given = 0;
    for (uint32_t i = 0; i < 10; i++) {
        blocks[i] = purse_resize(purse, NULL, 0, i + 1);
        given |= (uint32_t)(blocks[i] != NULL) << i;
    }
    *most = purse->blocks;
    for (uint32_t i = 0; i < 10; i++) {
        if (blocks[i]) {
            blocks[i][i] = 7;
            uint8_t *grown = purse_resize(purse, blocks[i], i + 1, i + 9);
            assert_true(!grown || (grown != blocks[i] && grown[i] == 7));
            purse_resize(purse, grown ? grown : blocks[i], grown ? i + 9 : i + 1, 0);
        }
    }
    return given;
}

static void a_purse_refuses_at_each_place(void **state) {
    (void)state;
    for (uint32_t n = 0; n < 10; n++) {
        uint32_t most;
        Purse purse = purse_with(n);
        assert_int_equal(ask_ten_times(&purse, &most), (1u << n) - 1); /* n, and no more; nor does one of them grow */
        assert_true(most == n && purse.calls == 10 + 2 * n && purse.refused == 10);
        purse_assert_whole(&purse);
        purse = (Purse){.budget = n, .once = true};
        assert_int_equal(ask_ten_times(&purse, &most), 0x3ffu ^ 1u << n); /* all but one */
        assert_true(most == 9 && purse.calls == 28 && purse.refused == 1);
        purse_assert_whole(&purse);
    }
}

/* The table of suites, as C reads it. */
static const struct {
    const char *name, *folder, *links;
} suites[] = {
#define ENF_SUITE(name, folder, links) {#name, #folder, #links},
#include "suites.inl"
#undef ENF_SUITE
};

static void suites_are_listed_once(void **state) {
    (void)state;
    size_t count = sizeof suites / sizeof suites[0];
    for (size_t i = 0; i < count; i++) {
        char source[256];
        snprintf(source, sizeof source, "tests/%s/test_%s.c", suites[i].folder, suites[i].name);
        assert_int_equal(access(enf_test_source_path(source), R_OK), 0);
        for (size_t j = 0; j < i; j++) {
            assert_string_not_equal(suites[i].name, suites[j].name);
        }
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(rng_matches_reference),         cmocka_unit_test(rng_stays_in_range),
    cmocka_unit_test(streams_differ_and_repeat),     cmocka_unit_test(temporary_files_round_trip),
    cmocka_unit_test(absent_data_is_null),           cmocka_unit_test(shell_gives_the_exit_status),
    cmocka_unit_test(a_purse_refuses_at_each_place), cmocka_unit_test(suites_are_listed_once),
};

ENF_TEST_MAIN(tests)
