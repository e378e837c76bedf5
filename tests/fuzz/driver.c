/* Runs a fuzz target without libFuzzer: over its seeds (files, or folders of files, from the command line), over random
 * bytes, and over damaged copies of the seeds: bits flipped, bytes set to extremes, tails cut. Each input lies in a block
 * of exactly its size, so an over-read shows under ASan. */
#define _XOPEN_SOURCE 700
#include "harness/harness.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "fuzz/fuzz.h"

enum { ROUNDS_FAST = 300, ROUNDS_LONG = 20000, RANDOM_SIZE_MAX = 2048 };

static void run_copy(const uint8_t *data, size_t size) {
    uint8_t *copy = malloc(size ? size : 1);
    if (copy) {
        if (size) {
            memcpy(copy, data, size);
        }
        LLVMFuzzerTestOneInput(copy, size);
    }
    free(copy);
}

/* One to eight damages: a flipped bit, an extreme byte, a 32-bit number set to an extreme. */
static void damage(EnfTestRng *rng, uint8_t *data, size_t size) {
    static const uint8_t extremes[4] = {0x00, 0x7f, 0x80, 0xff};
    uint32_t count = 1 + enf_test_below(rng, 8);
    for (uint32_t i = 0; i < count && size > 0; i++) {
        size_t at = enf_test_below(rng, (uint32_t)size);
        uint32_t kind = enf_test_below(rng, 3);
        if (kind == 0) {
            data[at] = (uint8_t)(data[at] ^ (1u << enf_test_below(rng, 8)));
        } else if (kind == 1) {
            data[at] = extremes[enf_test_below(rng, 4)];
        } else {
            size_t start = at & ~(size_t)3;
            memset(data + start, extremes[enf_test_below(rng, 4)], size - start < 4 ? size - start : 4);
        }
    }
}

static void run_damaged(EnfTestRng *rng, const uint8_t *seed, size_t size, uint32_t rounds) {
    uint8_t *data = malloc(size + 1);
    for (uint32_t i = 0; data && i < rounds; i++) {
        memcpy(data, seed, size);
        size_t left = enf_test_chance(rng, 4) ? enf_test_below(rng, (uint32_t)size + 1) : size;
        damage(rng, data, left);
        run_copy(data, left);
    }
    free(data);
}

static uint32_t run_file(EnfTestRng *rng, const char *path, uint32_t rounds) {
    size_t size = 0;
    uint8_t *seed = enf_test_read_file(path, &size);
    run_copy(seed, size);
    run_damaged(rng, seed, size, rounds);
    free(seed);
    return 1 + rounds;
}

static uint32_t run_folder(EnfTestRng *rng, const char *folder, uint32_t rounds) {
    struct dirent **names = NULL;
    uint32_t runs = 0;
    int count = scandir(folder, &names, NULL, alphasort);
    for (int i = 0; i < count; i++) {
        char path[1024];
        struct stat status;
        snprintf(path, sizeof path, "%s/%s", folder, names[i]->d_name);
        if (stat(path, &status) == 0 && S_ISREG(status.st_mode)) {
            runs += run_file(rng, path, rounds);
        }
        free(names[i]);
    }
    free(names);
    return runs;
}

static uint32_t run_random(EnfTestRng *rng, uint32_t rounds) {
    uint8_t data[RANDOM_SIZE_MAX];
    for (uint32_t i = 0; i < rounds; i++) {
        size_t size = enf_test_below(rng, RANDOM_SIZE_MAX);
        for (size_t k = 0; k < size; k++) {
            data[k] = (uint8_t)enf_test_u32(rng);
        }
        run_copy(data, size);
    }
    return rounds;
}

int main(int argc, char **argv) {
    EnfTestRng rng = enf_test_rng(1);
    uint32_t rounds = enf_test_rounds(ROUNDS_FAST, ROUNDS_LONG), runs = run_random(&rng, rounds);
    for (int i = 1; i < argc; i++) {
        struct stat status;
        if (stat(argv[i], &status) != 0) {
            continue; /* a target without seeds */
        }
        runs += S_ISDIR(status.st_mode) ? run_folder(&rng, argv[i], rounds) : run_file(&rng, argv[i], rounds);
    }
    printf("%u inputs\n", runs);
    return 0;
}
