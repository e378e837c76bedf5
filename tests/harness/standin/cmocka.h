/* The part of cmocka's interface that the suites use, for builds where no cmocka library is at hand: cross builds, and
 * MemorySanitizer, which wants every line instrumented. Same names, same output lines. */
#ifndef ENF_TESTS_STANDIN_CMOCKA_H
#define ENF_TESTS_STANDIN_CMOCKA_H

#include <stddef.h>
#include <stdint.h>

typedef uintmax_t LargestIntegralType;
typedef void (*CMUnitTestFunction)(void **state);
typedef int (*CMFixtureFunction)(void **state);

struct CMUnitTest {
    const char *name;
    CMUnitTestFunction test_func;
    CMFixtureFunction setup_func, teardown_func;
    void *initial_state;
};

#define cmocka_unit_test(f)                                                                                                    \
    { #f, f, NULL, NULL, NULL }
#define cmocka_unit_test_setup_teardown(f, setup, teardown)                                                                    \
    { #f, f, setup, teardown, NULL }
#define cmocka_unit_test_prestate(f, state)                                                                                    \
    { #f, f, NULL, NULL, state }
#define cmocka_run_group_tests(tests, setup, teardown) standin_run(tests, sizeof(tests) / sizeof((tests)[0]), setup, teardown)

int standin_run(const struct CMUnitTest *tests, size_t count, CMFixtureFunction setup, CMFixtureFunction teardown);
void cmocka_set_test_filter(const char *pattern);

#if defined(__GNUC__)
__attribute__((noreturn, format(printf, 3, 4)))
#endif
void standin_fail(const char *file, int line, const char *format, ...);
#if defined(__GNUC__)
__attribute__((noreturn))
#endif
void standin_skip(void);
void standin_equal(uintmax_t a, uintmax_t b, int equal, const char *file, int line);
void standin_strings(const char *a, const char *b, int equal, const char *file, int line);
void standin_memory(const void *a, const void *b, size_t size, const char *file, int line);

#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
void print_message(const char *format, ...);

#define skip() standin_skip()
#define fail() standin_fail(__FILE__, __LINE__, "failed")
#define fail_msg(...) standin_fail(__FILE__, __LINE__, __VA_ARGS__)
#define assert_true(c) ((c) ? (void)0 : standin_fail(__FILE__, __LINE__, "not true: %s", #c))
#define assert_false(c) ((c) ? standin_fail(__FILE__, __LINE__, "not false: %s", #c) : (void)0)
#define assert_null(p) assert_true((p) == NULL)
#define assert_non_null(p) assert_true((p) != NULL)
#define assert_ptr_equal(a, b) assert_true((const void *)(a) == (const void *)(b))
#define assert_ptr_not_equal(a, b) assert_true((const void *)(a) != (const void *)(b))
#define assert_int_equal(a, b) standin_equal((uintmax_t)(a), (uintmax_t)(b), 1, __FILE__, __LINE__)
#define assert_int_not_equal(a, b) standin_equal((uintmax_t)(a), (uintmax_t)(b), 0, __FILE__, __LINE__)
#define assert_string_equal(a, b) standin_strings(a, b, 1, __FILE__, __LINE__)
#define assert_string_not_equal(a, b) standin_strings(a, b, 0, __FILE__, __LINE__)
#define assert_memory_equal(a, b, size) standin_memory(a, b, size, __FILE__, __LINE__)
#define assert_in_range(v, low, high) assert_true((uintmax_t)(v) >= (uintmax_t)(low) && (uintmax_t)(v) <= (uintmax_t)(high))
#define assert_float_equal(a, b, epsilon)                                                                                      \
    assert_true((double)(a) - (double)(b) <= (double)(epsilon) && (double)(b) - (double)(a) <= (double)(epsilon))
#define assert_double_equal(a, b, epsilon) assert_float_equal(a, b, epsilon)

#endif
