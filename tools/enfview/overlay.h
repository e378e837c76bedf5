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

/** Lines of --debug portals, windows and kd, and the frozen eye's pyramid; into the bound target. */
EnfResult overlay_draw_lines(const Overlay *overlay, EnfError *error);
/** Clusters that are not in the set, as wireframe; into the bound target. */
EnfResult overlay_draw_culled(const Overlay *overlay, EnfError *error);

/** Mixes each pixel with the colour of its cluster's cell, except where it differs from `plain`: lines stay as they are. */
void overlay_tint_cells(const EnfMap *map, const uint8_t *ids, const uint8_t *plain, uint8_t *rgba, size_t size);
/** Turns cluster + 1 into a colour, 0 into black. */
void overlay_color_ids(uint8_t *ids, size_t size);

/** A colour for a number, far from those of its neighbours; R in the low byte. */
uint32_t overlay_color(uint32_t number);

#endif
