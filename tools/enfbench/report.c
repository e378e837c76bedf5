/* The rows as a table for people, as CSV and as JSON. One list of columns drives CSV and JSON. */
#include "common/report.h"
#include "enfbench/bench.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/** Numeric columns after the text ones: X(name). -1 is left empty in CSV and null in JSON. */
#define COLUMNS(X)                                                                                                             \
    X(median_us)                                                                                                               \
    X(p99_us)                                                                                                                  \
    X(lost_objects)                                                                                                            \
    X(lost_pixels)                                                                                                             \
    X(overdraw)                                                                                                                \
    X(cells)                                                                                                                   \
    X(portals)                                                                                                                 \
    X(nodes)                                                                                                                   \
    X(boxes)                                                                                                                   \
    X(objects)

#define EXTRA_COLUMNS(X)                                                                                                       \
    X(vis_median_us)                                                                                                           \
    X(vis_p99_us)                                                                                                              \
    X(ratio_median)                                                                                                            \
    X(ratio_best)                                                                                                              \
    X(mean_us)                                                                                                                 \
    X(max_us)                                                                                                                  \
    X(ns_object)                                                                                                               \
    X(evaluated)                                                                                                               \
    X(exposed)                                                                                                                 \
    X(expired)                                                                                                                 \
    X(reinserted)                                                                                                              \
    X(avoided)                                                                                                                 \
    X(late)                                                                                                                    \
    X(bytes_object)                                                                                                            \
    X(calm_max_us)                                                                                                             \
    X(median_exposed)                                                                                                          \
    X(worst_exposed)                                                                                                           \
    X(worst_appeared)                                                                                                          \
    X(worst_expired)                                                                                                           \
    X(worst_reinserted)

static void number(FILE *out, double value, const char *absent) {
    if (value < 0.0) {
        fputs(absent, out);
    } else {
        fprintf(out, "%.6g", value);
    }
}

static void quoted(FILE *out, const char *text) {
    fputc('"', out);
    for (; *text != '\0'; text++) {
        if (*text == '"') {
            fputc('"', out);
        }
        fputc(*text, out);
    }
    fputc('"', out);
}

static void csv_row(FILE *out, const BenchRow *row) {
    fprintf(out, "%s,", row->experiment);
    quoted(out, row->scene);
    fprintf(out, ",%s,", row->technique);
    quoted(out, row->params);
    fprintf(out, ",%u", row->frames);
#define PUT(name)                                                                                                              \
    fputc(',', out);                                                                                                           \
    number(out, row->name, "");
    COLUMNS(PUT)
    fprintf(out, ",%016" PRIx64, row->hash);
    EXTRA_COLUMNS(PUT)
#undef PUT
    fputc('\n', out);
}

static void csv(FILE *out, const BenchRows *rows) {
    fputs("experiment,scene,technique,params,frames", out);
#define PUT(name) fputs("," #name, out);
    COLUMNS(PUT)
    fputs(",hash", out);
    EXTRA_COLUMNS(PUT)
#undef PUT
    fputc('\n', out);
    for (uint32_t i = 0; i < rows->count; i++) {
        csv_row(out, &rows->rows[i]);
    }
}

EnfResult bench_write_csv(const BenchRows *rows, const char *path, EnfError *error) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size); /* through memory: the file appears whole or not at all */
    bool ok = out != NULL;
    if (ok) {
        csv(out, rows);
        ok = fclose(out) == 0;
    }
    EnfSpan span = {text, size};
    EnfResult result = ok ? enf_file_write(path, &span, 1, error)
                          : enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for the report");
    free(text);
    return result;
}

static void json_column(EnfReport *json, const char *name, double value) {
    if (value < 0.0) {
        enf_report_null(json, name);
    } else {
        enf_report_number(json, name, value);
    }
}

static void json_row(EnfReport *json, const BenchRow *row) {
    char hash[32];
    snprintf(hash, sizeof hash, "%016" PRIx64, row->hash);
    enf_report_object(json, NULL);
    enf_report_text(json, "experiment", row->experiment);
    enf_report_text(json, "scene", row->scene);
    enf_report_text(json, "technique", row->technique);
    enf_report_text(json, "params", row->params);
    enf_report_count(json, "frames", row->frames);
#define PUT(name) json_column(json, #name, row->name);
    COLUMNS(PUT)
    EXTRA_COLUMNS(PUT)
#undef PUT
    enf_report_text(json, "hash", hash);
    enf_report_end_object(json);
}

EnfResult bench_write_json(const BenchRows *rows, const char *path, EnfError *error) {
    EnfReport json;
    memset(&json, 0, sizeof json);
    json.pretty = true;
    enf_report_object(&json, NULL);
    enf_report_array(&json, "rows");
    for (uint32_t i = 0; i < rows->count; i++) {
        json_row(&json, &rows->rows[i]);
    }
    enf_report_end_array(&json);
    enf_report_end_object(&json);
    EnfResult result = enf_report_save(&json, path, error);
    enf_report_free(&json);
    return result;
}

static void cell(double value, int width, int digits) {
    if (value < 0.0) {
        printf(" %*s", width, "-");
    } else {
        printf(" %*.*f", width, digits, value);
    }
}

/* What made the slowest frame slow: what came into sight, or what nobody sees. */
static void print_worst(const BenchRow *row) {
    if (row->calm_max_us >= 0.0) {
        printf("%-8s   slowest frame %.1f us, %.1f medians: %.0f volumes exposed (%.0f of them new in it; in the median frame "
               "%.0f), "
               "%.0f expired, %.0f hung; of frames that expose no more than the median: %.1f medians\n",
               "", row->max_us, row->max_us / row->median_us, row->worst_exposed, row->worst_appeared, row->median_exposed,
               row->worst_expired, row->worst_reinserted, row->calm_max_us / row->median_us);
    }
}

void bench_print_table(const BenchRows *rows) {
    printf("%-8s %-18s %-18s %-22s %6s %10s %10s %9s %9s %8s %7s %8s %8s %8s %8s %7s %7s  %s\n", "exp", "scene", "technique",
           "params", "frames", "median us", "p99 us", "lost obj", "lost px", "overdraw", "cells", "portals", "nodes", "boxes",
           "objects", "ratio", "best", "hash");
    for (uint32_t i = 0; i < rows->count; i++) {
        const BenchRow *row = &rows->rows[i];
        printf("%-8s %-18s %-18s %-22s %6u", row->experiment, row->scene, row->technique, row->params, row->frames);
        cell(row->median_us, 10, 2);
        cell(row->p99_us, 10, 2);
        cell(row->lost_objects, 9, 0);
        cell(row->lost_pixels, 9, 0);
        cell(row->overdraw, 8, 2);
        cell(row->cells, 7, 1);
        cell(row->portals, 8, 1);
        cell(row->nodes, 8, 1);
        cell(row->boxes, 8, 1);
        cell(row->objects, 8, 1);
        cell(row->ratio_median, 7, 2);
        cell(row->ratio_best, 7, 2);
        printf("  %016" PRIx64 "\n", row->hash);
        print_worst(row);
    }
}
