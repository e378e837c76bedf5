/* Rows, knobs, clocks and quantiles: what every experiment needs. */
#include "enfbench/bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

BenchRow bench_row(const char *experiment, const char *scene, const char *technique) {
    BenchRow row;
    memset(&row, 0, sizeof row);
    snprintf(row.experiment, sizeof row.experiment, "%s", experiment);
    snprintf(row.scene, sizeof row.scene, "%s", scene);
    snprintf(row.technique, sizeof row.technique, "%s", technique);
    row.lost_objects = row.lost_pixels = row.overdraw = -1.0;
    row.cells = row.portals = row.nodes = row.boxes = row.objects = -1.0;
    row.mean_us = row.max_us = row.ns_object = row.evaluated = row.exposed = row.expired = -1.0;
    row.reinserted = row.avoided = row.late = row.bytes_object = -1.0;
    row.worst_exposed = row.worst_appeared = row.worst_expired = row.worst_reinserted = -1.0;
    row.median_exposed = row.calm_max_us = -1.0;
    row.vis_median_us = row.vis_p99_us = row.ratio_median = row.ratio_best = -1.0;
    return row;
}

void bench_rows_add(BenchRows *rows, const BenchRow *row) {
    if (rows->count == rows->capacity) {
        uint32_t capacity = rows->capacity == 0 ? 64 : rows->capacity * 2;
        BenchRow *grown = realloc(rows->rows, capacity * sizeof *grown);
        if (grown == NULL) {
            fputs("enfbench: out of memory\n", stderr);
            exit(1);
        }
        rows->rows = grown;
        rows->capacity = capacity;
    }
    rows->rows[rows->count++] = *row;
}

const char *bench_knob_text(BenchKnobs *knobs, const char *key, const char *fallback) {
    for (uint32_t i = knobs->count; i > 0; i--) {
        if (strcmp(knobs->items[i - 1].key, key) == 0) {
            knobs->items[i - 1].used = true;
            return knobs->items[i - 1].value;
        }
    }
    return fallback;
}

double bench_knob(BenchKnobs *knobs, const char *key, double fallback, double min, double max) {
    const char *text = bench_knob_text(knobs, key, NULL);
    if (text == NULL) {
        return fallback;
    }
    char *end = NULL;
    double value = strtod(text, &end);
    if (end == text || *end != '\0' || !(value >= min && value <= max)) {
        fprintf(stderr, "enfbench: %s=%s: a number in [%g, %g] is expected\n", key, text, min, max);
        exit(2);
    }
    return value;
}

uint32_t bench_knob_whole(BenchKnobs *knobs, const char *key, uint32_t fallback, uint32_t min, uint32_t max) {
    double value = bench_knob(knobs, key, (double)fallback, (double)min, (double)max);
    if ((double)(uint32_t)value != value) {
        fprintf(stderr, "enfbench: %s=%s: a whole number is expected\n", key, bench_knob_text(knobs, key, ""));
        exit(2);
    }
    return (uint32_t)value;
}

uint32_t bench_knob_list(BenchKnobs *knobs, const char *key, const char *fallback, uint32_t max, uint32_t *out,
                         uint32_t capacity) {
    const char *text = bench_knob_text(knobs, key, fallback);
    uint32_t count = 0;
    for (const char *at = text;; at++) {
        char *end = NULL;
        double value = strtod(at, &end);
        bool whole = end != at && value >= 1.0 && value <= (double)max && (double)(uint32_t)value == value;
        if (!whole || count == capacity || (*end != ',' && *end != '\0')) {
            fprintf(stderr, "enfbench: %s=%s: at most %u whole numbers in [1, %u] are expected, separated by commas\n", key,
                    text, capacity, max);
            exit(2);
        }
        out[count++] = (uint32_t)value;
        if (*end == '\0') {
            return count;
        }
        at = end;
    }
}

int bench_knob_word(BenchKnobs *knobs, const char *key, const char *const *words, int count, int fallback) {
    const char *text = bench_knob_text(knobs, key, words[fallback]);
    for (int i = 0; i < count; i++) {
        if (strcmp(text, words[i]) == 0) {
            return i;
        }
    }
    fprintf(stderr, "enfbench: %s=%s: ", key, text);
    for (int i = 0; i < count; i++) {
        fprintf(stderr, "%s%s", i == 0 ? "" : "|", words[i]);
    }
    fputs(" is expected\n", stderr);
    exit(2);
}

bool bench_temporary_folder(char *folder, size_t size) {
    const char *place = getenv("TMPDIR");
    int length = snprintf(folder, size, "%s/enfbench-XXXXXX", place == NULL ? "/tmp" : place);
    if (length < 0 || (size_t)length >= size || mkdtemp(folder) == NULL) {
        fputs("enfbench: no temporary folder\n", stderr);
        return false;
    }
    return true;
}

double bench_now_us(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e6 + (double)now.tv_nsec * 1e-3;
}

double bench_cpu_us(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e6 + (double)now.tv_nsec * 1e-3;
}

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

double bench_quantile(double *values, uint32_t count, double quantile) {
    if (count == 0) {
        return -1.0;
    }
    qsort(values, count, sizeof *values, ascending);
    return values[(uint32_t)(quantile * (double)(count - 1) + 0.5)];
}

void bench_progress(const BenchRun *run, const char *format, ...) {
    if (!run->progress) {
        return;
    }
    va_list args;
    va_start(args, format);
    fputs("\r\x1b[K", stderr);
    vfprintf(stderr, format, args);
    va_end(args);
    fflush(stderr);
}
