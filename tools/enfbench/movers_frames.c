/* Times of frames beside what was done in them: where the slowest frames come from is told by counters, not guessed. */
#include "enfbench/movers.h"

#include <stdlib.h>

void bench_frame_counters(MoversFrame *frame, const EnfDbvIndex *index) {
    EnfDbvCounters counters = enf_dbv_frame_counters(index);
    frame->exposed = (uint32_t)counters.exposed;
    frame->appeared = (uint32_t)counters.appeared;
    frame->expired = (uint32_t)counters.expired;
    frame->reinserted = (uint32_t)counters.reinserted;
}

void bench_frames_merge(MoversFrame *frames, const MoversFrame *others, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        frames[i].us = others[i].us < frames[i].us ? others[i].us : frames[i].us;
    }
}

static int by_time(const void *a, const void *b) {
    double x = ((const MoversFrame *)a)->us;
    double y = ((const MoversFrame *)b)->us;
    return (x > y) - (x < y);
}

static int by_exposed(const void *a, const void *b) {
    uint32_t x = ((const MoversFrame *)a)->exposed;
    uint32_t y = ((const MoversFrame *)b)->exposed;
    return (x > y) - (x < y);
}

static uint32_t rank(uint32_t count, double quantile) {
    return (uint32_t)(quantile * (double)(count - 1) + 0.5);
}

/* What the slowest frame did; and the slowest of those with no more in sight than the median. */
static void worst(MoversFrame *frames, uint32_t count, BenchRow *row) {
    const MoversFrame *slowest = &frames[count - 1];
    row->worst_exposed = (double)slowest->exposed;
    row->worst_appeared = (double)slowest->appeared;
    row->worst_expired = (double)slowest->expired;
    row->worst_reinserted = (double)slowest->reinserted;
    qsort(frames, count, sizeof *frames, by_exposed);
    uint32_t median = frames[rank(count, 0.5)].exposed;
    row->median_exposed = (double)median;
    for (uint32_t i = 0; i < count && frames[i].exposed <= median; i++) {
        row->calm_max_us = frames[i].us > row->calm_max_us ? frames[i].us : row->calm_max_us;
    }
}

void bench_frames_row(MoversFrame *frames, uint32_t count, bool volumes, BenchRow *row) {
    if (count == 0) {
        return;
    }
    row->mean_us = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        row->mean_us += frames[i].us / (double)count;
    }
    qsort(frames, count, sizeof *frames, by_time);
    row->max_us = frames[count - 1].us;
    row->p99_us = frames[rank(count, 0.99)].us;
    row->median_us = frames[rank(count, 0.5)].us;
    if (volumes) {
        worst(frames, count, row);
    }
}
