/* Proof that a cell is closed: its surfaces and portals, or those parts of them that have no border, enclose a point. */
#ifndef ENFILADE_COMPILE_REGIONS_CLOSED_H
#define ENFILADE_COMPILE_REGIONS_CLOSED_H

#include <enfilade/math.h>

/** Triangles on the grid, three corners each, fronts inward. */
typedef struct EnfSurface {
    const EnfGrid3 *corners;
    uint32_t triangle_count;
} EnfSurface;

/** Which triangles belong to parts without a border (out[i], one a triangle): every edge is walked as often one way as the other,
 *  subdivided edges included. @return false if memory is out, and then out is all false. */
bool enf_surface_closed_parts(const EnfSurface *surface, bool *out);

/** Do the triangles chosen by `closed` enclose p, fronts inward? Then no way leads out of there. Asked of three rays, which must agree:
 *  the sum of signed crossings is the winding number. */
bool enf_surface_encloses(const EnfSurface *surface, const bool *closed, EnfVec3 p);

#endif
