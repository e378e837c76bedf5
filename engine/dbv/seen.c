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

void enf_dbv_note_seen(EnfDbvIndex *index, uint32_t cell) {
    EnfDbvPlaces *places = &index->places;
    if (index->hot_frame != index->frame) {
        index->hot_frame = index->frame;
        index->seen_count = 0;
    }
    uint32_t place = places->cells_first + cell;
    if (places->hot_frame[place] == index->frame) {
        return; /* through another window */
    }
    if (index->seen_count < ENF_DBV_SEEN_LISTED) {
        EnfDbvSeen seen = {places->boxes[place], places->limits[place]};
        index->seen[index->seen_count] = seen;
    }
    index->seen_count++;
    for (; place != ENF_NONE && places->hot_frame[place] != index->frame; place = places->parents[place]) {
        places->hot_frame[place] = index->frame;
    }
}

/* ---- cells of a box --------------------------------------------------------------------------------------------- */

uint32_t enf_dbv_cells_of(EnfDbvIndex *index, EnfBox3f volume, uint32_t cells[ENF_DBV_LINKS]) {
    const EnfDbvPlaces *places = &index->places;
    uint32_t found = 0;
    EnfDbvWalk walk = enf_dbv_walk(places);
    for (uint32_t place = enf_dbv_walk_next(&walk); place != ENF_NONE; place = enf_dbv_walk_next(&walk)) {
        if (!enf_dbv_touches(&places->limits[place], &volume)) {
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

/* The squared distance between two boxes. */
static double gap(const EnfBox3 *place, const EnfBox3 *box) {
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

/* Squared; below 0 where a seen cell is touched. Only places that were seen are looked at: a handful of steps. */
static double by_tree(const EnfDbvIndex *index, const EnfBox3f *volume, const EnfBox3 *box) {
    const EnfDbvPlaces *places = &index->places;
    double nearest = HUGE_VAL;
    EnfDbvWalk walk = enf_dbv_walk(places);
    for (uint32_t place = enf_dbv_walk_next(&walk); place != ENF_NONE; place = enf_dbv_walk_next(&walk)) {
        if (!is_seen(index, place)) {
            continue;
        }
        double here = gap(&places->boxes[place], box);
        if (here >= nearest && here > 0.0) {
            continue;
        }
        bool is_cell = place >= places->cells_first;
        if (is_cell && enf_dbv_touches(&places->limits[place], volume)) {
            return -1.0;
        }
        if (is_cell || here > far_from(&places->boxes[place])) {
            nearest = here;
        } else {
            enf_dbv_walk_enter(&walk, place);
        }
    }
    return nearest;
}

double enf_dbv_distance_to_seen(EnfDbvIndex *index, EnfBox3f volume) {
    EnfBox3 box = enf_box3_from_f(volume);
    double nearest = HUGE_VAL;
    if (index->hot_frame == 0) {
        return nearest;
    }
    if (index->seen_count > ENF_DBV_SEEN_LISTED) {
        nearest = by_tree(index, &volume, &box);
    }
    for (uint32_t i = 0; i < index->seen_count && index->seen_count <= ENF_DBV_SEEN_LISTED; i++) {
        const EnfDbvSeen *seen = &index->seen[i];
        double here = gap(&seen->box, &box);
        if (!(here > 0.0) && enf_dbv_touches(&seen->limits, &volume)) {
            return -1.0;
        }
        nearest = here < nearest ? here : nearest;
    }
    return nearest > 0.0 ? sqrt(nearest) : nearest;
}
