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
    const EnfMap *map = index->map;
    const EnfDbvPlaces *places = &index->places;
    EnfBox3 box = enf_box3_from_f(volume);
    uint32_t found = 0;
    uint32_t stack[ENF_KD_MAX_DEPTH + 1];
    uint32_t depth = 0;
    if (map->cell_nodes_count > 0) {
        stack[depth++] = 0;
    }
    while (depth > 0) {
        uint32_t at = stack[--depth];
        const EnfKdNode *node = &map->cell_nodes[at];
        if (!enf_dbv_box_touches(&places->boxes[at], &box)) {
            continue;
        }
        if (node->block_count == 0) {
            stack[depth++] = node->link;
            stack[depth++] = at + 1;
            continue;
        }
        for (uint32_t i = 0; i < node->block_count * ENF_KD_BLOCK; i++) {
            uint32_t cell = map->cell_blocks[node->link + i / ENF_KD_BLOCK].item[i % ENF_KD_BLOCK];
            if (cell != ENF_NONE && enf_dbv_box_touches(&places->boxes[places->cells_first + cell], &box)) {
                if (found == ENF_DBV_LINKS) {
                    return ENF_NONE;
                }
                cells[found++] = cell;
            }
        }
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
    const EnfMap *map = index->map;
    const EnfDbvPlaces *places = &index->places;
    EnfBox3 box = enf_box3_from_f(volume);
    double nearest = HUGE_VAL;
    uint32_t stack[ENF_KD_MAX_DEPTH + 1];
    uint32_t depth = 0;
    if (map->cell_nodes_count > 0 && is_seen(index, 0)) {
        stack[depth++] = 0;
    }
    while (depth > 0 && nearest >= 0.0) {
        uint32_t at = stack[--depth];
        const EnfKdNode *node = &map->cell_nodes[at];
        double here = gap(&places->boxes[at], &box);
        if (here >= nearest) {
            continue;
        }
        if (here > far_from(&places->boxes[at])) {
            nearest = here;
            continue;
        }
        const uint32_t pair[2] = {at + 1, node->link};
        for (uint32_t i = 0; i < 2 && node->block_count == 0; i++) {
            if (is_seen(index, pair[i])) {
                stack[depth++] = pair[i];
            }
        }
        for (uint32_t i = 0; i < node->block_count * ENF_KD_BLOCK; i++) {
            uint32_t cell = map->cell_blocks[node->link + i / ENF_KD_BLOCK].item[i % ENF_KD_BLOCK];
            if (cell != ENF_NONE && is_seen(index, places->cells_first + cell)) {
                double d = gap(&places->boxes[places->cells_first + cell], &box);
                nearest = d < nearest ? d : nearest;
            }
        }
    }
    return nearest > 0.0 ? sqrt(nearest) : nearest;
}
