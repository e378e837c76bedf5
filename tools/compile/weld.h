/* Mending of T-junctions in an EnfSoup: no pixel looks through a crack between two triangles that should meet. */
#ifndef ENFILADE_COMPILE_WELD_H
#define ENFILADE_COMPILE_WELD_H

#include "compile/soup.h"

/** Splits triangles at the vertices that lie on their edges, so that neighbours share edges exactly. Only edges without an
 *  opposite edge (same end points, same cell) take part, and only the vertices of such edges: closed furniture is left alone.
 *  Adds to soup->split_count. Attributes are interpolated along the edge; no split makes a degenerate or turned-over triangle.
 *  The set of triangles does not depend on the order in which they came.
 *  @guarantee tests/unit/test_weld. @cost near-linear: hashing, one tree over the open vertices. */
EnfResult enf_weld(EnfSoup *soup, EnfError *error);

#endif
