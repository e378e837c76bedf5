/* What an engineer wants to see over a picture. */
#ifndef ENFVIEW_OVERLAY_H
#define ENFVIEW_OVERLAY_H

#include "enfview/viewer.h"

/** What is drawn over: the eye that the picture is taken from, and what the culling eye sees (the same one, unless frozen). */
typedef struct Overlay {
    Viewer *viewer;
    const EnfVisSet *set; /**< of the culling eye; its cameras[0] is that eye */
    EnfCamera observer;
    const float *clip_from_eye; /**< of the observer */
} Overlay;

/** Lines of --debug portals, windows, kd and dbv, and the frozen eye's pyramid; into the bound target. */
EnfResult overlay_draw_lines(const Overlay *overlay, EnfError *error);
/** What the colours of --debug dbv mean, and how many volumes each has, on stderr. */
void overlay_print_legend(const Viewer *viewer);
/** Clusters and objects that are not in the set, as wireframe; into the bound target. */
EnfResult overlay_draw_culled(const Overlay *overlay, EnfError *error);

/** Mixes each pixel with the colour of its cluster's cell, except where it differs from `plain`: lines stay as they are;
 *  and so does what moves. */
void overlay_tint_cells(const EnfMap *map, const uint8_t *ids, const uint8_t *plain, uint8_t *rgba, size_t size);
/** Turns cluster + 1 (or clusters + object + 1) into a colour, 0 into black. */
void overlay_color_ids(uint8_t *ids, size_t size);

/** A colour for a number, far from those of its neighbours; R in the low byte. */
uint32_t overlay_color(uint32_t number);

#endif
