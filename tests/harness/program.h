/* Programs of this build as they are called: run, what they say, their exit status; and levels compiled by enfc. */
#ifndef ENF_TESTS_PROGRAM_H
#define ENF_TESTS_PROGRAM_H

#include "harness/harness.h"

#include <enfilade/map.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/** What a program said, on its two ways out. Free it with enf_test_said_free. */
typedef struct EnfTestSaid {
    char *out, *err;
} EnfTestSaid;

static inline void enf_test_said_free(EnfTestSaid *said) {
    free(said->out);
    free(said->err);
    *said = (EnfTestSaid){NULL, NULL};
}

/** Runs a program in `folder`, with `arguments` as a shell takes them. What it says in *said, or passed on where that is NULL.
 *  Returns its exit status. */
static inline int enf_test_program_in(const char *folder, const char *program, const char *arguments, EnfTestSaid *said) {
    char command[8192], out[1024], err[1024], to[2100] = "2>&1";
    size_t size;
    snprintf(out, sizeof out, "%s/said.out", enf_test_temp_folder()); /* the caller holds paths of the ring */
    snprintf(err, sizeof err, "%s/said.err", enf_test_temp_folder());
    if (said) {
        snprintf(to, sizeof to, "> '%s' 2> '%s'", out, err);
    }
    int length = snprintf(command, sizeof command, "(cd '%s' && '%s/%s' %s) %s < /dev/null", folder, ENF_BIN_DIR, program,
                          arguments, to);
    assert_in_range(length, 1, sizeof command - 1);
    int status = enf_test_shell(command);
    if (said) {
        said->out = (char *)enf_test_read_file(out, &size);
        said->err = (char *)enf_test_read_file(err, &size);
    }
    return status;
}

/** As enf_test_program_in, where the suite itself runs. */
static inline int enf_test_program(const char *program, const char *arguments, EnfTestSaid *said) {
    return enf_test_program_in(".", program, arguments, said);
}

/** Fails the case unless the program ends with `status` and says each of `parts` (to NULL). '@' in `arguments` is the run's
 *  temporary folder. */
static inline void enf_test_expect(const char *program, const char *arguments, int status, const char *const *parts) {
    char all[6144];
    size_t at = 0;
    const char *folder = enf_test_temp_folder();
    for (const char *c = arguments; *c; c++) {
        size_t length = *c == '@' ? strlen(folder) : 1;
        assert_true(at + length < sizeof all);
        memcpy(all + at, *c == '@' ? folder : c, length);
        at += length;
    }
    all[at] = '\0';
    EnfTestSaid said;
    int got = enf_test_program(program, all, &said);
    if (got != status) {
        fail_msg("%s %s: status %d instead of %d:\n%s%s", program, all, got, status, said.out, said.err);
    }
    for (; *parts; parts++) {
        if (!strstr(said.out, *parts) && !strstr(said.err, *parts)) {
            fail_msg("%s %s: no \"%s\" in:\n%s%s", program, all, *parts, said.out, said.err);
        }
    }
    enf_test_said_free(&said);
}

#define ENF_TEST_EXPECT(program, arguments, status, ...)                                                                       \
    enf_test_expect((program), (arguments), (status), (const char *const[]){__VA_ARGS__, NULL})

/** Compiles a level into the file `output`; `options` as enfc's. Returns enfc's exit status, what it complains of is passed on. */
static inline int enf_test_enfc(const char *level, const char *options, const char *output) {
    char arguments[6144];
    snprintf(arguments, sizeof arguments, "'%s' %s -o '%s' --quiet", level, options, output);
    return enf_test_program("enfc", arguments, NULL);
}

/** The palace, as its project says. */
static inline int enf_test_compile_palace(const char *output) {
    char options[1200];
    snprintf(options, sizeof options, "--project '%s'", enf_test_source_path("maps/palace/palace.json"));
    return enf_test_enfc(enf_test_source_path("assets/palace/palace.glb"), options, output);
}

/** Compiles a level and reads its map; fails the case where that fails. */
static inline void enf_test_compile_map(EnfMap *map, const char *level) {
    char out[1024];
    EnfError error = {ENF_OK, 0, "", ""};
    snprintf(out, sizeof out, "%s", enf_test_temp_path("level.enfmap"));
    assert_int_equal(enf_test_enfc(level, "", out), 0);
    if (enf_map_read(map, out, NULL, &error) != ENF_OK) {
        fail_msg("%s: %s", level, error.message);
    }
}

#endif
