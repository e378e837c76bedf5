/* The plan of the building: its walls, cut a little above the floor of a storey. */
#ifndef GAME_FRONT_PLAN_H
#define GAME_FRONT_PLAN_H

#include "front/canvas.h"

typedef struct PlanWall {
    float ends[4]; /**< x, z, x, z: metres, world */
    uint32_t cell;
} PlanWall;

enum { PLAN_WALLS_MAX = 24000 };

typedef struct Plan {
    const EnfMap *map;
    PlanWall *walls;
    uint32_t count;
    double height;    /**< of the cut, metres, world */
    double bounds[4]; /**< x, z least; x, z most: of all cells */
    bool made;
} Plan;

/** How the plan lies on the screen. */
typedef struct PlanView {
    double box[4];    /**< pixels */
    double per_metre; /**< pixels */
    double at[2];     /**< x, z in the middle */
} PlanView;

EnfResult plan_create(Plan *plan, const EnfMap *map, EnfError *error);
void plan_destroy(Plan *plan);
/** Cuts anew if `floor_ws` is another storey's. No heap. */
void plan_cut(Plan *plan, double floor_ws);
/** The whole building in a box. */
PlanView plan_fit(const Plan *plan, const double box[4]);
/** A place on the screen. */
void plan_place(const PlanView *view, double x, double z, double out[2]);
/** Walls; those of cells for which lit[cell] is set in `bright` (lit NULL: all). */
void plan_draw(const Plan *plan, Canvas *canvas, const PlanView *view, const uint8_t *lit, const uint32_t colors[2]);

#endif
