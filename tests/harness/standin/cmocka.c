/* Runs a group of cases as cmocka does: a failing or skipped case leaves by longjmp. See cmocka.h beside this. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fnmatch.h>

#include "cmocka.h"

enum { LEFT_FAILED = 1, LEFT_SKIPPED = 2 };

static jmp_buf leave;
static const char *filter;

void cmocka_set_test_filter(const char *pattern) {
    filter = pattern;
}

void standin_fail(const char *file, int line, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "[  ERROR   ] --- %s:%d: ", file, line);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    longjmp(leave, LEFT_FAILED);
}

void print_message(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
}

void standin_skip(void) {
    longjmp(leave, LEFT_SKIPPED);
}

void standin_equal(uintmax_t a, uintmax_t b, int equal, const char *file, int line) {
    if ((a == b) != equal) {
        standin_fail(file, line, "0x%jx %s 0x%jx", a, equal ? "!=" : "==", b);
    }
}

void standin_strings(const char *a, const char *b, int equal, const char *file, int line) {
    if ((strcmp(a, b) == 0) != equal) {
        standin_fail(file, line, "\"%s\" %s \"%s\"", a, equal ? "!=" : "==", b);
    }
}

void standin_memory(const void *a, const void *b, size_t size, const char *file, int line) {
    if (memcmp(a, b, size) != 0) {
        standin_fail(file, line, "%zu bytes differ", size);
    }
}

/* How the case ended: 0, LEFT_FAILED or LEFT_SKIPPED. */
static int run_case(const struct CMUnitTest *test) {
    void *state = test->initial_state;
    int left = setjmp(leave);
    if (left == 0) {
        if (test->setup_func && test->setup_func(&state) != 0) {
            return LEFT_FAILED;
        }
        test->test_func(&state);
        if (test->teardown_func && test->teardown_func(&state) != 0) {
            return LEFT_FAILED;
        }
    }
    return left;
}

int standin_run(const struct CMUnitTest *tests, size_t count, CMFixtureFunction setup, CMFixtureFunction teardown) {
    static const char *const words[3] = {"       OK ", "  FAILED  ", "  SKIPPED "};
    int ended[3] = {0};
    void *group = NULL;
    if (setup && setup(&group) != 0) {
        return (int)count;
    }
    for (size_t i = 0; i < count; i++) {
        if (filter && fnmatch(filter, tests[i].name, 0) != 0) {
            continue;
        }
        printf("[ RUN      ] %s\n", tests[i].name);
        int left = run_case(&tests[i]);
        ended[left]++;
        printf("[%s] %s\n", words[left], tests[i].name);
    }
    if (teardown) {
        teardown(&group);
    }
    printf("[  PASSED  ] %d test(s).\n", ended[0]);
    if (ended[LEFT_SKIPPED]) {
        printf("[  SKIPPED ] %d test(s)\n", ended[LEFT_SKIPPED]);
    }
    if (ended[LEFT_FAILED]) {
        printf("[  FAILED  ] %d test(s)\n", ended[LEFT_FAILED]);
    }
    return ended[LEFT_FAILED];
}
