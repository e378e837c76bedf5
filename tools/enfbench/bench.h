/* enfbench: run time against error. An experiment makes rows; a row carries its time, its error and the hash of its result.
 *
 * Ratios are measured side by side: the techniques of one experiment take turns within one run, so that a machine whose speed
 * drifts slows all of them. */
#ifndef ENFBENCH_BENCH_H
#define ENFBENCH_BENCH_H

#include <enfilade/base.h>

#define BENCH_TEXT 256

/** One line of the result: a technique on a scene. Counts are means over the frames; -1 where a column does not apply. */
typedef struct BenchRow {
    char experiment[32], scene[64], technique[32], params[BENCH_TEXT];
    uint32_t frames;
    double median_us, p99_us; /**< of what the experiment times, a frame */
    double lost_objects;      /**< objects that show a pixel (or that brute force finds) and were not listed, all frames */
    double lost_pixels;       /**< pixels that differ from the unculled picture, all frames */
    double overdraw;          /**< objects listed / objects that show a pixel */
    double cells, portals, nodes, boxes, objects;
    uint64_t hash;
    double vis_median_us, vis_p99_us;  /**< visibility alone, where median_us is the whole frame */
    double ratio_median, ratio_best;   /**< time of the baseline / time of this technique, frame by frame */
    double mean_us, max_us, ns_object; /**< moving objects: of frames; the mean divided by the objects that are not drawn */
    double evaluated, exposed, expired, reinserted, avoided, late; /**< of an EnfDbvIndex, a frame; `late` in all */
    double bytes_object;                                           /**< of the index */
    /** What the slowest frame (that of max_us) did: volumes exposed, of these such as were not in the frame before, expired, hung. */
    double worst_exposed, worst_appeared, worst_expired, worst_reinserted;
    /** The median frame exposes that many; and the slowest of the frames that expose no more: what is hidden costs that at most. */
    double median_exposed, calm_max_us;
} BenchRow;

/** A row with every optional column at -1. */
BenchRow bench_row(const char *experiment, const char *scene, const char *technique);

typedef struct BenchRows {
    BenchRow *rows;
    uint32_t count, capacity;
} BenchRows;

/** Appends a copy; ends the program when memory is out. */
void bench_rows_add(BenchRows *rows, const BenchRow *row);

/** The knobs given by --set KEY=VALUE. */
typedef struct BenchKnobs {
    struct {
        char key[32], value[BENCH_TEXT];
        bool used;
    } items[64];
    uint32_t count;
} BenchKnobs;

/** A value that is none of a knob's ends the program with the status of a wrong command line. */
double bench_knob(BenchKnobs *knobs, const char *key, double fallback, double min, double max);
/** The same of a knob that counts something: a fraction is refused, not cut off. */
uint32_t bench_knob_whole(BenchKnobs *knobs, const char *key, uint32_t fallback, uint32_t min, uint32_t max);
/** Numbers that count, separated by commas, into `out`; how many, 1 to `capacity`. */
uint32_t bench_knob_list(BenchKnobs *knobs, const char *key, const char *fallback, uint32_t max, uint32_t *out,
                         uint32_t capacity);
/** One of `count` words: its number. */
int bench_knob_word(BenchKnobs *knobs, const char *key, const char *const *words, int count, int fallback);
/** `fallback`, which may be NULL, where it is not given. */
const char *bench_knob_text(BenchKnobs *knobs, const char *key, const char *fallback);

typedef struct BenchRun {
    BenchRows rows;
    BenchKnobs knobs;
    uint32_t skipped; /**< cases that the knobs leave no room for, each told on stderr */
    bool progress;    /**< stderr is a terminal */
} BenchRun;

/** Runs an experiment; false (after a message on stderr) if it could not. */
typedef bool BenchFn(BenchRun *run);

/** The table of experiments: BENCH(name, function, "what it shows", "knobs"). */
#define BENCH(name, function, about, knobs) BenchFn function;
#include "enfbench/experiments.inl"
#undef BENCH

/** Makes a folder of the run's own where the system keeps such (TMPDIR); false after a message. The caller removes it. */
bool bench_temporary_folder(char *folder, size_t size);

/* ---- timing ---- */
double bench_now_us(void);
/** Of this thread alone: what other programs take is not in it. Coarser, and dearer to ask. */
double bench_cpu_us(void);
/** A sample's quantile in [0,1]; sorts `values`. */
double bench_quantile(double *values, uint32_t count, double quantile);
void bench_progress(const BenchRun *run, const char *format, ...);

/* ---- report.c ---- */
void bench_print_table(const BenchRows *rows);
EnfResult bench_write_csv(const BenchRows *rows, const char *path, EnfError *error);
EnfResult bench_write_json(const BenchRows *rows, const char *path, EnfError *error);

#endif
