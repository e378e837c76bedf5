/* Which moving objects a view must draw, by testing every object against every window: the oracle of volumes (engine/dbv). */
#ifndef ENF_SCENES_DRAWN_H
#define ENF_SCENES_DRAWN_H

#include <enfilade/vis.h>

typedef struct EnfSeenWindow {
    uint32_t cell;
    EnfPyramid pyramid; /**< relative to the cell's origin */
} EnfSeenWindow;

/** The windows of a view, and what must be drawn through them. Start from zeroes; enf_drawn_free releases. */
typedef struct EnfDrawnOracle {
    EnfSeenWindow *windows;
    uint32_t window_count, window_capacity;
    bool *drawn; /**< one an object index */
    uint32_t limit, capacity;
    uint32_t drawn_count;
    bool failed; /**< memory ran out */
} EnfDrawnOracle;

/** Runs the view (without its index) and tests every living object of `world`. False if memory ran out. */
bool enf_drawn_look(EnfDrawnOracle *oracle, EnfVis *vis, const EnfPortals *portals, const EnfView *view, EnfWorld *world);

/** The first object on which `objects` (ascending) and the oracle differ; ENF_NONE if they are the same. */
uint32_t enf_drawn_differs(const EnfDrawnOracle *oracle, const uint32_t *objects, uint32_t count);

/** A frame of `index` through the oracle's windows; the first object on which the two differ, or ENF_NONE. */
uint32_t enf_drawn_check(const EnfDrawnOracle *oracle, EnfDbvIndex *index);

void enf_drawn_free(EnfDrawnOracle *oracle);

#endif
