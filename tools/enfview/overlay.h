/* What an engineer wants to see over a picture. */
#ifndef ENFVIEW_OVERLAY_H
#define ENFVIEW_OVERLAY_H

#include "enfview/viewer.h"
#include "inspect/inspect.h"

/** What the colours of --debug dbv mean, and how many volumes each has, on stderr. */
void overlay_print_legend(const Viewer *viewer);

/** Mixes each pixel with the colour of its cluster's cell, except where it differs from `plain`: lines stay as they are;
 *  and so does what moves. */
void overlay_tint_cells(const EnfMap *map, const uint8_t *ids, const uint8_t *plain, uint8_t *rgba, size_t size);
/** Turns cluster + 1 (or clusters + object + 1) into a colour, 0 into black. */
void overlay_color_ids(uint8_t *ids, size_t size);

#endif
