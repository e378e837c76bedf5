/* Which cells are seen, and how far a box is from them: what policies ask. A place of the tree is stamped with the frame that saw a
 * cell beneath it, so that a question goes down only where something was seen. */
#include "dbv/dbv_internal.h"

#include <math.h>

/* A branch that is farther away than this many times its size counts as seen all over: a shorter distance than the true one makes
 * a shorter period, never a wrong one, and here by a fifth at most. */
#define FAR 4.0

static bool is_seen(const EnfDbvIndex *index, uint32_t place) {
    return index->hot_frame != 0 && index->places.hot_frame[place] == index->hot_frame;
}

bool enf_dbv_cell_is_seen(const EnfDbvIndex *index, uint32_t cell) {
    return is_seen(index, index->places.cells_first + cell);
}

/* ---- cells of a box --------------------------------------------------------------------------------------------- */

uint32_t enf_dbv_cells_of(EnfDbvIndex *index, EnfBox3f volume, uint32_t cells[ENF_DBV_LINKS]) {
    const EnfDbvPlaces *places = &index->places;
    EnfBox3 box = enf_box3_from_f(volume);
    uint32_t found = 0;
    EnfDbvWalk walk = enf_dbv_walk(places);
    for (uint32_t place = enf_dbv_walk_next(&walk); place != ENF_NONE; place = enf_dbv_walk_next(&walk)) {
        if (!enf_dbv_box_touches(&places->boxes[place], &box)) {
            continue;
        }
        if (place >= places->cells_first) {
            if (found == ENF_DBV_LINKS) {
                return ENF_NONE;
            }
            cells[found++] = place - places->cells_first;
        }
        enf_dbv_walk_enter(&walk, place);
    }
    return found;
}

bool enf_dbv_in_few_cells(EnfDbvIndex *index, EnfBox3f box) {
    uint32_t cells[ENF_DBV_LINKS];
    return enf_dbv_cells_of(index, box, cells) != ENF_NONE;
}

/* ---- distance --------------------------------------------------------------------------------------------------- */

/* fmax is a call, for the sake of what is not a number. */
static inline double larger(double a, double b) {
    return a > b ? a : b;
}

/* The squared distance between two boxes; below 0 where they touch as enf_world_touches has it. */
static double gap(const EnfBox3 *place, const EnfBox3 *box) {
    if (enf_dbv_box_touches(place, box)) {
        return -1.0;
    }
    double x = larger(larger(place->min.x - box->max.x, box->min.x - place->max.x), 0.0);
    double y = larger(larger(place->min.y - box->max.y, box->min.y - place->max.y), 0.0);
    double z = larger(larger(place->min.z - box->max.z, box->min.z - place->max.z), 0.0);
    return x * x + y * y + z * z;
}

static double far_from(const EnfBox3 *place) {
    EnfVec3 side = enf_sub(place->max, place->min);
    double size = larger(larger(side.x, side.y), side.z);
    return FAR * FAR * size * size;
}

/* Only places that were seen are looked at: a handful of steps. */
double enf_dbv_distance_to_seen(EnfDbvIndex *index, EnfBox3f volume) {
    const EnfDbvPlaces *places = &index->places;
    EnfBox3 box = enf_box3_from_f(volume);
    double nearest = HUGE_VAL;
    EnfDbvWalk walk = enf_dbv_walk(places);
    for (uint32_t place = enf_dbv_walk_next(&walk); place != ENF_NONE && nearest >= 0.0; place = enf_dbv_walk_next(&walk)) {
        if (!is_seen(index, place)) {
            continue;
        }
        double here = gap(&places->boxes[place], &box);
        if (here >= nearest) {
            continue;
        }
        if (place >= places->cells_first || here > far_from(&places->boxes[place])) {
            nearest = here;
        } else {
            enf_dbv_walk_enter(&walk, place);
        }
    }
    return nearest > 0.0 ? sqrt(nearest) : nearest;
}
