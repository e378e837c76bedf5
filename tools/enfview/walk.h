/* An eye that walks along a recorded path, its cell tracked through portals. */
#ifndef ENFVIEW_WALK_H
#define ENFVIEW_WALK_H

#include <stdio.h>

#include "common/path_csv.h"
#include "enfview/viewer.h"

typedef struct Walk {
    const Viewer *viewer;
    EnfPathCsv path;
    uint32_t next; /**< row */
    uint32_t row;  /**< the row that walk_step gave */
    double time;   /**< its time, seconds */
    Pose pose;     /**< its eye */
    uint32_t cell; /**< where that eye is, or ENF_NONE */
    FILE *cells;   /**< --cells, or NULL */
    bool cells_failed;
} Walk;

/** Reads --path and opens --cells. Close with walk_close, also after a failure. */
EnfResult walk_open(Walk *walk, const Viewer *viewer, EnfError *error);
/** Goes on to the next row that --every takes; false at the end. Every row between is walked, too: cells are tracked by
 *  the portals that the way crosses. */
bool walk_step(Walk *walk);
/** The world's tick at the row that walk_step gave: sixty a second from --tick on. */
int64_t walk_tick(const Walk *walk);
/** Rows that walk_step will give in all. */
uint32_t walk_view_count(const Walk *walk);
/** Writes the line of --cells for what is seen from here. */
void walk_write_cells(Walk *walk, const EnfVisSet *set);
/** IO if --cells could not be written. */
EnfResult walk_close(Walk *walk, EnfError *error);

#endif
