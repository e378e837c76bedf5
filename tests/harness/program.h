/* Programs of this build as they are called: run, what they say, their exit status; and levels compiled by enfc. */
#ifndef ENF_TESTS_PROGRAM_H
#define ENF_TESTS_PROGRAM_H

#include "harness/harness.h"

#include <enfilade/map.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/** Runs a program with `arguments`, '@' in them being the run's temporary folder. What it prints and what it complains of, to be
 *  freed, in *text. Returns its exit status. */
static inline int enf_test_program(const char *program, const char *arguments, char **text) {
    char command[6144], out[1024];
    size_t at = (size_t)snprintf(command, sizeof command, "'%s/%s' ", ENF_BIN_DIR, program), size;
    const char *folder = enf_test_temp_folder();
    snprintf(out, sizeof out, "%s/said.txt", folder);
    for (const char *c = arguments; *c; c++) {
        size_t length = *c == '@' ? strlen(folder) : 1;
        assert_true(at + length + strlen(out) + 40 < sizeof command);
        memcpy(command + at, *c == '@' ? folder : c, length);
        at += length;
    }
    snprintf(command + at, sizeof command - at, " > '%s' 2>&1 < /dev/null", out);
    int status = enf_test_shell(command);
    *text = (char *)enf_test_read_file(out, &size);
    return status;
}

/** Fails the case unless the program ends with `status` and says each of `parts` (to NULL). */
static inline void enf_test_expect(const char *program, const char *arguments, int status, const char *const *parts) {
    char *text;
    int got = enf_test_program(program, arguments, &text);
    if (got != status) {
        fail_msg("%s %s: status %d instead of %d:\n%s", program, arguments, got, status, text);
    }
    const char *said = text ? text : ""; /* which it is: but gcc knows that nothing else is without "" */
    for (; *parts; parts++) {
        if (!strstr(said, *parts)) {
            fail_msg("%s %s: no \"%s\" in:\n%s", program, arguments, *parts, said);
        }
    }
    free(text);
}

#define ENF_TEST_EXPECT(program, arguments, status, ...)                                                                       \
    enf_test_expect((program), (arguments), (status), (const char *const[]){__VA_ARGS__, NULL})

/** Compiles a level into the file `output`; `options` as enfc's. Returns enfc's exit status, what it complains of is passed on. */
static inline int enf_test_enfc(const char *level, const char *options, const char *output) {
    char command[6144];
    snprintf(command, sizeof command, "'%s/enfc' '%s' %s -o '%s' --quiet 2>&1 < /dev/null", ENF_BIN_DIR, level, options,
             output);
    return enf_test_shell(command);
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
