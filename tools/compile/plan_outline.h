/* Outlines of cells seen from above: the borders of what faces up in them. */
#ifndef ENFILADE_COMPILE_PLAN_OUTLINE_H
#define ENFILADE_COMPILE_PLAN_OUTLINE_H

#include "compile/array.h"
#include "compile/soup.h"

/** A point of the plan, metres: x to the right, z down. */
typedef struct EnfPlanPoint {
    double x, z;
} EnfPlanPoint;

/** A closed border. Positive area: what faces up lies inside; negative: a hole. */
typedef struct EnfPlanLoop {
    uint32_t point_first, point_count;
    double area; /**< square metres */
    bool thing;  /**< inner, and clearly smaller than the floor */
    bool inner;  /**< there is floor on both sides of it: the border of a thing, or a hole in one */
} EnfPlanLoop;

typedef struct EnfPlanOutline {
    ENF_ARRAY(EnfPlanPoint) points;
    ENF_ARRAY(EnfPlanLoop) loops; /**< the largest first */
    EnfPlanPoint label;           /**< a point inside, where a name may stand */
    double clearance;             /**< metres from there to the nearest border that is not inner; negative: unknown */
    bool failed;                  /**< out of memory */
} EnfPlanOutline;

/** The outline of what faces up among `triangles` (numbers of soup triangles); no loops if nothing does. Free with
 *  enf_plan_outline_free. @cost O(n log n) but for loops inside loops */
void enf_plan_outline(EnfPlanOutline *outline, const EnfSoup *soup, const uint32_t *triangles, uint32_t count);
void enf_plan_outline_free(EnfPlanOutline *outline);

#endif
