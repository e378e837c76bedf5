/* What a walk measured, view by view, and its summary. */
#ifndef ENFVIEW_TALLY_H
#define ENFVIEW_TALLY_H

#include "enfview/walk.h"

/** One view. */
typedef struct Measure {
    uint32_t cells, clusters, clusters_visible, movers, lost_pixels;
    double vis_us, ms_none, ms_culled;
} Measure;

typedef struct Tally {
    uint32_t view_count, capacity; /**< capacity: views of the walk */
    uint64_t lost_pixels, cells, clusters, clusters_visible, movers;
    uint32_t lost_views;
    double ratio_best;                             /**< of ms_none / ms_culled */
    double *vis_us, *ms_none, *ms_culled, *ratios; /**< a view each */
} Tally;

EnfResult tally_open(Tally *tally, uint32_t capacity, EnfError *error);
void tally_close(Tally *tally);
void tally_add(Tally *tally, const Measure *measure);

/** The table on stdout: a row for about a twentieth of the walk each, and every view that lost a pixel; progress on
 *  stderr if that is a terminal. `pictures`: with times and losses. */
void tally_print_row(const Tally *tally, const Walk *walk, const Measure *measure, bool pictures);
/** The line of JSON that ends the output. Sorts the samples. */
void tally_print_summary(Tally *tally, const Viewer *viewer, bool pictures);

#endif
