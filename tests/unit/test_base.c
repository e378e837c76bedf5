/* Every function of base but those for files, which are in test_file.c. */
#include "base/base_internal.h"
#include "harness/harness.h"
#include "harness/purse.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- results ---------------------------------------------------------------------------------------------------- */

static void results_have_texts(void **state) {
    (void)state;
    for (unsigned i = 0; i < ENF_RESULT_COUNT; i++) {
        assert_true(strlen(enf_result_text((EnfResult)i)) > 3);
        for (unsigned j = 0; j < i; j++) {
            assert_string_not_equal(enf_result_text((EnfResult)i), enf_result_text((EnfResult)j));
        }
    }
    assert_string_equal(enf_result_text(ENF_OK), "no error");
    assert_string_equal(enf_result_text(ENF_RESULT_COUNT), "unknown error");
}

static void error_is_filled(void **state) {
    (void)state;
    EnfError error;
    memset(&error, 0x55, sizeof error);
    assert_int_equal(enf_error_set(&error, ENF_ERROR_FORMAT, 12, "node %d of %s", 3, "hall"), ENF_ERROR_FORMAT);
    assert_int_equal(error.code, ENF_ERROR_FORMAT);
    assert_int_equal(error.offset, 12);
    assert_string_equal(error.message, "node 3 of hall");
    assert_string_equal(error.file, "");
    assert_int_equal(enf_error_file(&error, error.code, "a.glb"), ENF_ERROR_FORMAT);
    assert_int_equal(enf_error_file(&error, error.code, "b.glb"), ENF_ERROR_FORMAT);
    assert_string_equal(error.file, "a.glb"); /* the innermost name stays */
    assert_int_equal(enf_error_set(NULL, ENF_ERROR_IO, 0, "%s", "nobody listens"), ENF_ERROR_IO);
    assert_int_equal(enf_error_file(NULL, ENF_ERROR_IO, "x"), ENF_ERROR_IO);
}

static void error_texts_are_cut_to_fit(void **state) {
    (void)state;
    char text[2000];
    memset(text, 'x', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    EnfError error;
    enf_error_set(&error, ENF_ERROR_FORMAT, 0, "%s", text);
    enf_error_file(&error, error.code, text);
    assert_int_equal(strlen(error.message), sizeof error.message - 1);
    assert_int_equal(strlen(error.file), sizeof error.file - 1);
}

static int asserted_line;
static const char *asserted_expression;

static void note_assert(const char *expression, const char *file, int line) {
    (void)file;
    asserted_expression = expression;
    asserted_line = line;
}

static void assert_handler_is_called(void **state) {
    (void)state;
    enf_set_assert_handler(note_assert);
    enf_assert_failed("a == b", "file.c", 42);
    enf_set_assert_handler(NULL);
    assert_int_equal(asserted_line, 42);
    assert_string_equal(asserted_expression, "a == b");
    ENF_ASSERT(asserted_line == 42);
    ENF_VALIDATE(asserted_line == 42);
}

/* ---- log -------------------------------------------------------------------------------------------------------- */

static char logged[64];

static void note_log(void *user, EnfLogLevel level, const char *message) {
    snprintf(logged, sizeof logged, "%d %d %s", *(int *)user, (int)level, message);
}

static void log_goes_to_the_listener(void **state) {
    (void)state;
    int user = 7;
    enf_log(ENF_LOG_ERROR, "unheard");
    enf_set_log(note_log, &user);
    enf_log(ENF_LOG_WARNING, "%s %d", "cells", 3);
    enf_set_log(NULL, NULL);
    enf_log(ENF_LOG_ERROR, "unheard");
    assert_string_equal(logged, "7 1 cells 3");
}

/* ---- memory ----------------------------------------------------------------------------------------------------- */

static void allocation_is_zeroed_and_checked(void **state) {
    (void)state;
    Purse purse = purse_with(100);
    EnfAllocator own = purse_allocator(&purse);
    const EnfAllocator *allocators[] = {NULL, enf_default_allocator(), &own};
    for (size_t i = 0; i < 3; i++) {
        uint8_t *block = enf_alloc(allocators[i], 10, 10), zeros[100] = {0};
        assert_non_null(block);
        assert_memory_equal(block, zeros, 100);
        memset(block, 9, 100);
        block = enf_realloc(allocators[i], block, 10, 100, 10);
        assert_non_null(block);
        assert_int_equal(block[99], 9);
        assert_null(enf_realloc(allocators[i], block, 100, SIZE_MAX / 5, 10));
        assert_int_equal(block[0], 9);
        enf_free(allocators[i], block, 100, 10);
        assert_null(enf_alloc(allocators[i], SIZE_MAX / 2, 3));
        assert_null(enf_alloc(allocators[i], 0, 3));
        assert_null(enf_alloc(allocators[i], 3, 0));
        enf_free(allocators[i], NULL, 0, 0);
    }
    purse_assert_whole(&purse);
    purse.budget = 0;
    assert_null(enf_alloc(&own, 1, 1));
    assert_null(enf_realloc(&own, NULL, 0, 1, 1));
}

static void sizes_are_checked(void **state) {
    (void)state;
    size_t out = 5;
    assert_true(enf_size_add(3, 4, &out) && out == 7);
    assert_true(enf_size_add(SIZE_MAX, 0, &out) && out == SIZE_MAX);
    assert_false(enf_size_add(SIZE_MAX, 1, &out));
    assert_int_equal(out, SIZE_MAX);
    assert_true(enf_size_mul(3, 4, &out) && out == 12);
    assert_true(enf_size_mul(SIZE_MAX, 0, &out) && out == 0);
    assert_true(enf_size_mul(0, SIZE_MAX, &out) && out == 0);
    assert_true(enf_size_mul(SIZE_MAX, 1, &out) && out == SIZE_MAX);
    out = 5;
    assert_false(enf_size_mul(SIZE_MAX / 2 + 1, 2, &out));
    assert_int_equal(out, SIZE_MAX);
}

static void arena_is_aligned_and_bounded(void **state) {
    (void)state;
    Purse purse = purse_with(1);
    EnfAllocator own = purse_allocator(&purse);
    EnfArena arena;
    EnfError error;
    assert_int_equal(enf_arena_create(&arena, 1000, &own, &error), ENF_OK);
    size_t pushed = 0;
    for (uint8_t *block; (block = enf_arena_push(&arena, 3, 11)) != NULL; pushed++) {
        assert_int_equal((uintptr_t)block % 32, 0);
        memset(block, 1, 33);
    }
    assert_in_range(pushed, 14, 16); /* 64 bytes each in 1000 */
    assert_null(enf_arena_push(&arena, SIZE_MAX / 2, 3));
    assert_null(enf_arena_push(&arena, SIZE_MAX, 1));
    assert_true(arena.used <= arena.size);
    arena.used = 0;
    assert_non_null(enf_arena_push(&arena, 1, 900));
    enf_arena_destroy(&arena);
    purse_assert_whole(&purse);
    assert_null(arena.base);
    assert_null(enf_arena_push(&arena, 1, 1));
    assert_int_equal(enf_arena_create(&arena, 1000, &own, &error), ENF_ERROR_MEMORY);
    assert_int_equal(error.code, ENF_ERROR_MEMORY);
    assert_null(arena.base);
    enf_arena_destroy(&arena);
    assert_int_equal(enf_arena_create(&arena, 0, &own, &error), ENF_OK);
    assert_null(enf_arena_push(&arena, 1, 1));
    enf_arena_destroy(&arena);
    uint8_t room[128]; /* a caller's own block */
    EnfArena lent = {room, sizeof room, 0, NULL};
    assert_non_null(enf_arena_push(&lent, 1, 64));
    enf_arena_destroy(&lent);
}

/* ---- hashes ----------------------------------------------------------------------------------------------------- */

static uint32_t crc_bit_by_bit(uint32_t crc, const uint8_t *p, size_t size) {
    crc = ~crc;
    for (size_t i = 0; i < size; i++) {
        crc ^= p[i];
        for (int b = 0; b < 8; b++) {
            crc = crc >> 1 ^ (crc & 1 ? 0x82f63b78u : 0);
        }
    }
    return ~crc;
}

static void crc_is_castagnoli(void **state) {
    (void)state;
    uint8_t bytes[300];
    assert_int_equal(enf_crc32c(0, "123456789", 9), 0xe3069283u);
    memset(bytes, 0, 32); /* this and the next three: RFC 3720 §B.4 */
    assert_int_equal(enf_crc32c(0, bytes, 32), 0x8a9136aau);
    memset(bytes, 0xff, 32);
    assert_int_equal(enf_crc32c(0, bytes, 32), 0x62a8ab43u);
    for (unsigned i = 0; i < 32; i++) {
        bytes[i] = (uint8_t)i;
    }
    assert_int_equal(enf_crc32c(0, bytes, 32), 0x46dd794eu);
    assert_int_equal(enf_crc32c(0, NULL, 0), 0);
    EnfTestRng rng = enf_test_rng(1);
    for (unsigned i = 0; i < sizeof bytes; i++) {
        bytes[i] = (uint8_t)enf_test_u32(&rng);
    }
    for (unsigned i = 0; i < 2000; i++) {
        size_t from = enf_test_below(&rng, 16), size = enf_test_below(&rng, 280);
        size_t cut = enf_test_below(&rng, (uint32_t)size + 1);
        uint32_t start = enf_test_u32(&rng), expected = crc_bit_by_bit(start, bytes + from, size);
        assert_int_equal(enf_crc32c(start, bytes + from, size), expected);
        uint32_t part = enf_crc32c(start, bytes + from, cut);
        assert_int_equal(enf_crc32c(part, bytes + from + cut, size - cut), expected);
    }
}

static void hash_is_pinned(void **state) {
    (void)state;
    uint8_t bytes[64];
    for (unsigned i = 0; i < sizeof bytes; i++) {
        bytes[i] = (uint8_t)(i * 37 + 11);
    }
    /* Values of the first run; results and caches compare hashes across machines, so they may never change. */
    assert_int_equal(enf_hash64(ENF_HASH_START, NULL, 0), UINT64_C(0xf6349829ac0472c4));
    assert_int_equal(enf_hash64(ENF_HASH_START, bytes, 1), UINT64_C(0xf14bdc58401609ac));
    assert_int_equal(enf_hash64(ENF_HASH_START, bytes, 64), UINT64_C(0xb0ee1fd42581b168));
    assert_int_equal(enf_hash64(enf_hash64(ENF_HASH_START, bytes, 13), bytes + 13, 51), UINT64_C(0x1addfd927b26f786));
}

/* Flipping any bit changes about half of the result's bits, whatever came before and after it. */
static void hash_mixes(void **state) {
    (void)state;
    uint8_t bytes[40] = {0};
    uint64_t whole = enf_hash64(ENF_HASH_START, bytes, sizeof bytes);
    unsigned total = 0, fewest = 64;
    for (unsigned bit = 0; bit < 8 * sizeof bytes; bit++) {
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        unsigned changed = (unsigned)__builtin_popcountll(whole ^ enf_hash64(ENF_HASH_START, bytes, sizeof bytes));
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        total += changed;
        fewest = changed < fewest ? changed : fewest;
    }
    assert_in_range(total / (8 * sizeof bytes), 30, 34);
    assert_true(fewest >= 12);
    for (size_t a = 0; a < sizeof bytes; a++) {
        assert_true(enf_hash64(ENF_HASH_START, bytes, a) != enf_hash64(ENF_HASH_START, bytes, a + 1));
    }
}

static int compare_u64(const void *a, const void *b) {
    uint64_t x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

/* Signs of neighbouring doubles: a hash that multiplies the word into the state unmixed sends these to one value. */
static void hash_tells_signs_apart(void **state) {
    (void)state;
    enum { SIGNS = 12 };
    static uint64_t hashes[1u << SIGNS];
    for (unsigned i = 0; i < 1u << SIGNS; i++) {
        uint8_t bytes[8 * SIGNS] = {0};
        for (unsigned k = 0; k < SIGNS; k++) {
            bytes[8 * k + 7] = (uint8_t)(i >> k & 1u ? 0xbf : 0x3f);
        }
        hashes[i] = enf_hash64(ENF_HASH_START, bytes, sizeof bytes);
    }
    qsort(hashes, 1u << SIGNS, sizeof hashes[0], compare_u64);
    for (unsigned i = 1; i < 1u << SIGNS; i++) {
        assert_true(hashes[i - 1] != hashes[i]);
    }
}

/* ---- cursor ----------------------------------------------------------------------------------------------------- */

static void cursor_reads_little_endian(void **state) {
    (void)state;
    const uint8_t bytes[] = {7, 0x78, 0x56, 0x34, 0x12, 8, 7, 6, 5, 4, 3, 2, 1, 0, 0, 0x80, 0x3f, 0, 0, 0, 0, 0, 0, 4, 0xc0, 9};
    EnfCursor c = enf_cursor(bytes, sizeof bytes);
    assert_int_equal(enf_cursor_u8(&c), 7);
    assert_int_equal(enf_cursor_u32(&c), 0x12345678);
    assert_int_equal(enf_cursor_u64(&c), UINT64_C(0x0102030405060708));
    assert_true(enf_cursor_f32(&c) == 1.0f);
    assert_true(enf_cursor_f64(&c) == -2.5);
    assert_int_equal(*enf_cursor_bytes(&c, 1), 9);
    assert_false(c.failed);
    assert_non_null(enf_cursor_bytes(&c, 0));
    assert_int_equal(enf_cursor_u8(&c), 0);
    assert_true(c.failed);
    assert_int_equal(c.offset, sizeof bytes);
}

/* Each truncation, in a block of exactly that size, so that an over-read shows under a sanitizer. */
static void cursor_failure_is_sticky(void **state) {
    (void)state;
    for (size_t size = 0; size <= 16; size++) {
        uint8_t *bytes = malloc(size + (size == 0));
        assert_non_null(bytes);
        memset(bytes, 1, size);
        EnfCursor c = enf_cursor(bytes, size);
        uint64_t a = enf_cursor_u64(&c), b = enf_cursor_u64(&c);
        assert_true((a != 0) == (size >= 8) && (b != 0) == (size >= 16));
        assert_int_equal(c.failed, size < 16);
        assert_int_equal(c.offset, size / 8 * 8);
        if (c.failed) {
            assert_int_equal(enf_cursor_u8(&c), 0); /* even where a byte is left */
            assert_null(enf_cursor_bytes(&c, 0));
            assert_true(enf_cursor_f32(&c) == 0.0f && enf_cursor_f64(&c) == 0.0);
        }
        free(bytes);
    }
    EnfCursor c = enf_cursor("abc", 3);
    enf_cursor_u8(&c);
    assert_null(enf_cursor_bytes(&c, SIZE_MAX)); /* offset + size would wrap */
    EnfCursor none = enf_cursor(NULL, 0);
    assert_non_null(enf_cursor_bytes(&none, 0));
    assert_null(enf_cursor_bytes(&none, 1));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(results_have_texts),
    cmocka_unit_test(error_is_filled),
    cmocka_unit_test(error_texts_are_cut_to_fit),
    cmocka_unit_test(assert_handler_is_called),
    cmocka_unit_test(log_goes_to_the_listener),
    cmocka_unit_test(allocation_is_zeroed_and_checked),
    cmocka_unit_test(sizes_are_checked),
    cmocka_unit_test(arena_is_aligned_and_bounded),
    cmocka_unit_test(crc_is_castagnoli),
    cmocka_unit_test(hash_is_pinned),
    cmocka_unit_test(hash_mixes),
    cmocka_unit_test(hash_tells_signs_apart),
    cmocka_unit_test(cursor_reads_little_endian),
    cmocka_unit_test(cursor_failure_is_sticky),
};

ENF_TEST_MAIN(tests)
