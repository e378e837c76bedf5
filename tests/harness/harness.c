/* The harness: seed, generator, folders, files. See harness.h; its own test is tests/unit/test_harness.c. */
#define _XOPEN_SOURCE 700 /* nftw, mkdtemp */
#include "harness/harness.h"

#include <ftw.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { PATH_SIZE = 1024, PATH_RING = 8 };

static uint64_t run_seed;
static bool run_seed_known;
static char temp_folder[PATH_SIZE];

/* ---- seed and generator ----------------------------------------------------------------------------------------- */

uint64_t enf_test_seed(void) {
    if (!run_seed_known) {
        const char *text = getenv("ENF_TEST_SEED");
        run_seed = text ? strtoull(text, NULL, 0) : (uint64_t)time(NULL) * 1000003u + (uint64_t)getpid();
        run_seed_known = true;
        printf("seed %" PRIu64 " (repeat with ENF_TEST_SEED=%" PRIu64 ")\n", run_seed, run_seed);
        fflush(stdout);
    }
    return run_seed;
}

bool enf_test_long(void) {
    const char *text = getenv("ENF_TEST_LONG");
    return text && *text && strcmp(text, "0") != 0;
}

uint32_t enf_test_rounds(uint32_t fast, uint32_t slow) {
    return enf_test_long() ? slow : fast;
}

EnfTestRng enf_test_rng(uint64_t stream) {
    return enf_test_rng_fixed(enf_test_seed(), stream);
}

EnfTestRng enf_test_rng_fixed(uint64_t seed, uint64_t stream) {
    EnfTestRng rng = {0, (stream << 1) | 1u};
    enf_test_u32(&rng);
    rng.state += seed;
    enf_test_u32(&rng);
    return rng;
}

uint32_t enf_test_u32(EnfTestRng *rng) {
    uint64_t old = rng->state;
    rng->state = old * UINT64_C(6364136223846793005) + rng->increment;
    uint32_t folded = (uint32_t)(((old >> 18) ^ old) >> 27);
    uint32_t turn = (uint32_t)(old >> 59);
    return (folded >> turn) | (folded << ((32u - turn) & 31u));
}

uint64_t enf_test_u64(EnfTestRng *rng) {
    uint64_t high = enf_test_u32(rng);
    return high << 32 | enf_test_u32(rng);
}

uint32_t enf_test_below(EnfTestRng *rng, uint32_t bound) {
    if (bound == 0) {
        return 0;
    }
    /* Numbers under 2^32 mod bound would make small results likelier: they are drawn again. */
    uint32_t rejected = (0u - bound) % bound;
    uint32_t drawn = enf_test_u32(rng);
    while (drawn < rejected) {
        drawn = enf_test_u32(rng);
    }
    return drawn % bound;
}

double enf_test_double(EnfTestRng *rng, double low, double high) {
    double unit = (double)(enf_test_u64(rng) >> 11) * 0x1p-53;
    return low + (high - low) * unit;
}

float enf_test_float(EnfTestRng *rng, float low, float high) {
    return (float)enf_test_double(rng, (double)low, (double)high);
}

bool enf_test_chance(EnfTestRng *rng, uint32_t odds) {
    return enf_test_below(rng, odds) == 0;
}

/* ---- folders and files ------------------------------------------------------------------------------------------ */

static char *next_path(void) {
    static char ring[PATH_RING][PATH_SIZE];
    static unsigned next;
    return ring[next++ % PATH_RING];
}

static const char *join(const char *folder, const char *name) {
    char *path = next_path();
    int length = snprintf(path, PATH_SIZE, "%s/%s", folder, name);
    if (length < 0 || length >= PATH_SIZE) {
        fail_msg("path too long: %s/%s", folder, name);
    }
    return path;
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *walk) {
    (void)status, (void)kind, (void)walk;
    return remove(path);
}

static void remove_temp_folder(void) {
    nftw(temp_folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

const char *enf_test_temp_folder(void) {
    if (!temp_folder[0]) {
        const char *parent = getenv("TMPDIR");
        snprintf(temp_folder, sizeof temp_folder, "%s/enf_test_XXXXXX", parent && *parent ? parent : "/tmp");
        if (!mkdtemp(temp_folder)) {
            fprintf(stderr, "cannot make a temporary folder: %s\n", temp_folder);
            exit(1);
        }
        atexit(remove_temp_folder);
    }
    return temp_folder;
}

const char *enf_test_temp_path(const char *name) {
    return join(enf_test_temp_folder(), name);
}

const char *enf_test_data_path(const char *relative) {
    const char *root = getenv("ENF_SHARED_DATA");
    const char *path = join(root && *root ? root : ENF_SHARED_DATA, relative);
    if (access(path, R_OK) == 0) {
        return path;
    }
    printf("shared data is absent: %s\n", path);
    return NULL;
}

const char *enf_test_data(const char *relative) {
    const char *path = enf_test_data_path(relative);
    if (!path) {
        skip();
    }
    return path;
}

const char *enf_test_source_path(const char *relative) {
    return join(ENF_SOURCE_DIR, relative);
}

uint8_t *enf_test_read_file(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END) != 0) {
        fail_msg("cannot read %s", path);
    }
    long length = ftell(file);
    rewind(file);
    uint8_t *data = length < 0 ? NULL : malloc((size_t)length + 1);
    if (!data || fread(data, 1, (size_t)length, file) != (size_t)length) {
        fail_msg("cannot read %s", path);
    }
    fclose(file);
    data[length] = 0;
    *size = (size_t)length;
    return data;
}

void enf_test_write_file(const char *path, const void *data, size_t size) {
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(data, 1, size, file) != size || fclose(file) != 0) {
        fail_msg("cannot write %s", path);
    }
}

int enf_test_shell(const char *command) {
    fflush(NULL);
    int status = system(command);
    if (status == -1) {
        fail_msg("cannot run: %s", command);
    }
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/* ---- main ------------------------------------------------------------------------------------------------------- */

void enf_test_begin(int argc, char **argv) {
    setvbuf(stdout, NULL, _IOLBF, 0); /* a crash must not swallow the lines before it */
    if (argc > 1) {
        cmocka_set_test_filter(argv[1]);
    }
}

int enf_test_end(int failed) {
    return failed == 0 ? 0 : 1;
}
