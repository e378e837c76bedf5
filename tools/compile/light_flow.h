/* Where a light shines: the windows through which it comes into each cell. */
#ifndef ENFILADE_COMPILE_LIGHT_FLOW_H
#define ENFILADE_COMPILE_LIGHT_FLOW_H

#include "compile/array.h"
#include "compile/layout.h"

/** Planes of a window; with more, those of the shortest edges are left out: more is lit, nothing less. */
#define ENF_LIGHT_PLANES 8
/** Windows of one light in one cell; further ones are merged into the nearest. */
#define ENF_LIGHT_WINDOWS 4

/** Points of a window's polygon: a portal clipped by ENF_LIGHT_PLANES planes, each of which adds at most one. */
#define ENF_LIGHT_POINTS (ENF_POLYGON_MAX + ENF_LIGHT_PLANES)

/** A convex cone from the light: p (relative to it) is lit if n·p ≥ 0 for every plane. No planes: all is lit. */
typedef struct EnfLightWindow {
    uint32_t cell;
    uint32_t next; /**< the next window of the same cell, or ENF_NONE */
    uint32_t plane_count, point_count;
    EnfVec3 planes[ENF_LIGHT_PLANES]; /**< unit normals */
    EnfVec3 points[ENF_LIGHT_POINTS]; /**< of the polygon seen through it, relative to the light; none: unknown */
} EnfLightWindow;

/** Working memory for the lights of one layout. */
typedef struct EnfLightFlow {
    const EnfLayout *layout;
    uint32_t *portal_first;            /* half-portals of cell c: [portal_first[c], portal_first[c + 1]) */
    uint32_t *cell_head;               /* first window of a cell, or ENF_NONE */
    uint8_t *on_chain;                 /* a half-portal that the current sequence passed */
    ENF_ARRAY(EnfLightWindow) windows; /**< the result of the last enf_light_flow_run; [0] is the light's own cell */
    void *frames;
} EnfLightFlow;

/** False when out of memory. Free with enf_light_flow_free, also after a failure. */
bool enf_light_flow_create(EnfLightFlow *flow, const EnfLayout *layout);
void enf_light_flow_free(EnfLightFlow *flow);

/** Follows the light that stands at `position` (world, metres) in `cell` through every portal within `range`, closed ones too,
 *  since they may open; transforms (mirrors, teleports) do not pass light. A straight ray crosses a plane once, so a sequence
 *  never repeats a half-portal. Beyond the limits on depth and steps, every cell that portals within range lead to is lit whole.
 *  False when out of memory.
 *  @guarantee every point with a straight way to the light through portals is lit: tests/unit/test_lights */
bool enf_light_flow_run(EnfLightFlow *flow, uint32_t cell, EnfVec3 position, double range);

#endif
