/* Storeys of a level: which cells are drawn on one floor plan. */
#ifndef ENFILADE_COMPILE_PLAN_STOREYS_H
#define ENFILADE_COMPILE_PLAN_STOREYS_H

#include "compile/soup.h"

/** Cells with their triangles: those of cell c are triangles[first[c] .. first[c + 1]). */
typedef struct EnfPlanCells {
    const EnfLayout *layout;
    const EnfSoup *soup;
    const uint32_t *first, *triangles;
} EnfPlanCells;

/** Does the triangle face up, more or less? */
bool enf_plan_faces_up(const EnfSoup *soup, uint32_t triangle);

/** Writes the storey of every cell (OUTSIDE: 0) to storey[0..cell_count) and their number, from the lowest up, to *count: cells
 *  whose floors follow one another without a gap belong together, and so do groups that do not lie above each other. False when
 *  out of memory. */
bool enf_plan_storeys(const EnfPlanCells *cells, uint32_t *storey, uint32_t *count);

#endif
