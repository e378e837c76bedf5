/* What every suite needs beside cmocka: a printed seed, a generator that gives the same numbers everywhere, a temporary
 * folder, and the real data beside the repository.
 *
 * A suite includes this header alone (it brings cmocka), lists its cases and ends with ENF_TEST_MAIN(tests).
 *
 *   ENF_TEST_SEED=N   repeats a run: its first line of output names the seed
 *   ENF_TEST_LONG=1   makes property tests larger (CTest's label "long")
 *   ENF_SHARED_DATA   the folder of real data, if it is not where CMake was told */
#ifndef ENF_TESTS_HARNESS_H
#define ENF_TESTS_HARNESS_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/** The run's seed: ENF_TEST_SEED, or one from the clock. The first call prints it with the way to repeat the run. */
uint64_t enf_test_seed(void);

/** True under ENF_TEST_LONG. */
bool enf_test_long(void);

/** `fast`, or `slow` under ENF_TEST_LONG: how many rounds a property test makes. */
uint32_t enf_test_rounds(uint32_t fast, uint32_t slow);

/** A pcg32 generator (O'Neill 2014, XSH-RR 64/32): same seed, same numbers, on every machine. */
typedef struct EnfTestRng {
    uint64_t state, increment;
} EnfTestRng;

/** A generator from the run's seed. Each test takes a `stream` of its own, so running one alone changes nothing. */
EnfTestRng enf_test_rng(uint64_t stream);
/** A generator that ignores the run's seed: for fixed scenes. */
EnfTestRng enf_test_rng_fixed(uint64_t seed, uint64_t stream);
uint32_t enf_test_u32(EnfTestRng *rng);
uint64_t enf_test_u64(EnfTestRng *rng);
/** Uniform in [0, bound), without bias; 0 if `bound` is 0. */
uint32_t enf_test_below(EnfTestRng *rng, uint32_t bound);
/** Uniform in [low, high), 53 bits. */
double enf_test_double(EnfTestRng *rng, double low, double high);
/** Uniform in [low, high], rounded to float. */
float enf_test_float(EnfTestRng *rng, float low, float high);
/** True once in `odds` calls. */
bool enf_test_chance(EnfTestRng *rng, uint32_t odds);

/** A folder of this run's own, made at the first call and removed with its content when the suite ends. */
const char *enf_test_temp_folder(void);
/** The path of `name` in that folder. The string is valid until the eighth call after this one. */
const char *enf_test_temp_path(const char *name);

/** The path of `relative` in the shared data, e.g. "freedoom/map01.glb"; NULL with a message where it is absent.
 *  The string is valid until the eighth call after this one. */
const char *enf_test_data_path(const char *relative);
/** As enf_test_data_path, but skips the running case where the data is absent; never NULL. */
const char *enf_test_data(const char *relative);
/** The path of `relative` in the source tree. Valid until the eighth call after this one. */
const char *enf_test_source_path(const char *relative);

/** A whole file, with a NUL after its end that is not counted; fails the running case if it cannot be read. The block
 *  has exactly the size of the file (plus that NUL), so an over-read shows under ASan. Free it with free(). */
uint8_t *enf_test_read_file(const char *path, size_t *size);
/** Writes a whole file; fails the running case if it cannot. */
void enf_test_write_file(const char *path, const void *data, size_t size);

/** Runs a command line of the shell; returns its exit status, or 128 + the signal that ended it. */
int enf_test_shell(const char *command);

/** Used by ENF_TEST_MAIN. */
void enf_test_begin(int argc, char **argv);
int enf_test_end(int failed);

/** The suite's main. `tests` is an array of struct CMUnitTest. An argument is a pattern of case names ("round*"). */
#define ENF_TEST_MAIN(tests)                                                                                                   \
    int main(int argc, char **argv) {                                                                                          \
        enf_test_begin(argc, argv);                                                                                            \
        return enf_test_end(cmocka_run_group_tests(tests, NULL, NULL));                                                        \
    }

#endif
