/* Makes the table and the summary of a walk. */
#include "enfview/tally.h"

#include <string.h>
#include <unistd.h>

#include "common/report.h"

enum { ROWS = 20 };

EnfResult tally_open(Tally *tally, uint32_t capacity, EnfError *error) {
    memset(tally, 0, sizeof *tally);
    tally->capacity = capacity;
    double **samples[] = {&tally->vis_us, &tally->ms_none, &tally->ms_culled, &tally->ratios};
    for (int i = 0; i < 4; i++) {
        *samples[i] = enf_alloc(NULL, capacity, sizeof **samples[i]);
        if (!*samples[i]) {
            return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for the samples of %u views", capacity);
        }
    }
    return ENF_OK;
}

void tally_close(Tally *tally) {
    double *samples[] = {tally->vis_us, tally->ms_none, tally->ms_culled, tally->ratios};
    for (int i = 0; i < 4; i++) {
        enf_free(NULL, samples[i], tally->capacity, sizeof *samples[i]);
    }
}

void tally_add(Tally *tally, const Measure *measure) {
    ENF_ASSERT(tally->view_count < tally->capacity);
    uint32_t i = tally->view_count++;
    tally->vis_us[i] = measure->vis_us;
    tally->ms_none[i] = measure->ms_none;
    tally->ms_culled[i] = measure->ms_culled;
    tally->ratios[i] = measure->ms_culled > 0.0 ? measure->ms_none / measure->ms_culled : 0.0;
    tally->ratio_best = tally->ratios[i] > tally->ratio_best ? tally->ratios[i] : tally->ratio_best;
    tally->cells += measure->cells;
    tally->clusters += measure->clusters;
    tally->clusters_visible += measure->clusters_visible;
    tally->movers += measure->movers;
    tally->lost_pixels += measure->lost_pixels;
    tally->lost_views += measure->lost_pixels > 0;
}

static void print_head(bool pictures) {
    printf("%8s %9s %-16s %5s %8s", "row", "time", "cell", "cells", "clusters");
    if (pictures) {
        printf(" %7s %6s %8s %8s %6s", "visible", "lost", "none ms", "cull ms", "ratio");
    }
    printf(" %8s\n", "vis us");
}

void tally_print_row(const Tally *tally, const Walk *walk, const Measure *measure, bool pictures) {
    if (walk->viewer->options->quiet) {
        return;
    }
    uint32_t step = (tally->capacity + ROWS - 1) / ROWS;
    if (isatty(STDERR_FILENO)) {
        fprintf(stderr, "\r%u of %u views, %u with lost pixels ", tally->view_count, tally->capacity, tally->lost_views);
        if (tally->view_count == tally->capacity) {
            fprintf(stderr, "\n");
        }
    }
    if (tally->view_count == 1) {
        print_head(pictures);
    }
    if ((tally->view_count - 1) % step != 0 && measure->lost_pixels == 0) {
        return;
    }
    printf("%8u %9.3f %-16.16s %5u %8u", walk->row, walk->time, viewer_cell_name(walk->viewer, walk->cell), measure->cells,
           measure->clusters);
    if (pictures) {
        printf(" %7u %6u %8.3f %8.3f %6.2f", measure->clusters_visible, measure->lost_pixels, measure->ms_none,
               measure->ms_culled, tally->ratios[tally->view_count - 1]);
    }
    printf(" %8.2f\n", measure->vis_us);
}

static double mean(uint64_t sum, uint32_t count) {
    return count ? (double)sum / (double)count : 0.0;
}

void tally_print_summary(Tally *tally, const Viewer *viewer, bool pictures) {
    EnfReport line = {0};
    uint32_t n = tally->view_count;
    enf_report_object(&line, NULL);
    enf_report_count(&line, "views", n);
    if (pictures) {
        enf_report_count(&line, "lost_pixels", tally->lost_pixels);
        enf_report_count(&line, "lost_views", tally->lost_views);
    }
    enf_report_number(&line, "cells_drawn_mean", mean(tally->cells, n));
    enf_report_number(&line, "clusters_drawn_mean", mean(tally->clusters, n));
    if (pictures) {
        enf_report_number(&line, "clusters_visible_mean", mean(tally->clusters_visible, n));
        double visible = (double)tally->clusters_visible;
        enf_report_number(&line, "overdraw_ratio", visible > 0.0 ? (double)tally->clusters / visible : 0.0);
        enf_report_number(&line, "ms_none_median", viewer_quantile(tally->ms_none, n, 0.5));
        enf_report_number(&line, "ms_culled_median", viewer_quantile(tally->ms_culled, n, 0.5));
        enf_report_number(&line, "ratio_median", viewer_quantile(tally->ratios, n, 0.5));
        enf_report_number(&line, "ratio_best", tally->ratio_best);
    }
    enf_report_number(&line, "vis_us_median", viewer_quantile(tally->vis_us, n, 0.5));
    enf_report_number(&line, "vis_us_p99", viewer_quantile(tally->vis_us, n, 0.99));
    if (enf_world_object_limit(viewer->world) > 0) {
        enf_report_count(&line, "objects", enf_world_object_limit(viewer->world));
        enf_report_number(&line, "objects_drawn_mean", mean(tally->movers, n));
        viewer_report_dbv(viewer, &line, "dbv");
    }
    enf_report_end_object(&line);
    printf("%s\n", line.failed ? "{}" : line.text);
    enf_report_free(&line);
}
