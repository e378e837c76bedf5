/* The diagnosis as a .glb that opens in Blender beside the level: portals, and a node for each finding that has a place. */
#ifndef ENFILADE_COMPILE_OVERLAY_GLB_H
#define ENFILADE_COMPILE_OVERLAY_GLB_H

#include "compile/layout.h"

/** Writes the overlay atomically. Portals are translucent polygons under the node `portals`; findings, under `findings`, are
 *  named by code and node: a closed polygon in red (errors) or orange, a polyline for leaks, a small cross for a point.
 *  Byte-identical for equal input. */
EnfResult enf_overlay_write(const char *path, const EnfLayout *layout, const EnfDiagnosis *diagnosis, EnfError *error);

#endif
