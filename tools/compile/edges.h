/* Edges of an EnfSoup by position: which vertices coincide, and which edges have no neighbour in their cell. */
#ifndef ENFILADE_COMPILE_EDGES_H
#define ENFILADE_COMPILE_EDGES_H

#include "compile/soup.h"

/** An edge of a triangle: corner → next corner. */
typedef struct EnfEdgeRef {
    uint32_t triangle;
    uint32_t corner; /**< 0..2 */
} EnfEdgeRef;

typedef struct EnfEdges {
    uint32_t *position; /**< a soup vertex → its place in `points`; equal for equal positions */
    EnfGrid3 *points;   /**< distinct positions, in the order of their first vertex */
    uint32_t point_count;
    EnfEdgeRef *open; /**< edges that no opposite edge of the same cell balances, ascending */
    uint32_t open_count;
} EnfEdges;

/** @cost linear but for sorting the few edges that meet at one point. Free with enf_edges_free. */
EnfResult enf_edges_find(EnfEdges *edges, const EnfSoup *soup, EnfError *error);
void enf_edges_free(EnfEdges *edges);

#endif
