/* Boxes about what hangs on places: of each node of the cells' tree and each cell, one about its own volumes and one about these and
 * all beneath. They grow when something is hung. They are fitted anew only when a look has come for nothing, so that hanging
 * costs a few compares. Always: a place's `all` holds its `own`, and the `all` of every place beneath. */
#include "dbv/dbv_internal.h"

#include <math.h>

static EnfBox3f nothing(void) {
    EnfBox3f box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    return box;
}

static bool holds(const EnfBox3f *outer, const EnfBox3f *inner) {
    return outer->min.x <= inner->min.x && outer->min.y <= inner->min.y && outer->min.z <= inner->min.z &&
           outer->max.x >= inner->max.x && outer->max.y >= inner->max.y && outer->max.z >= inner->max.z;
}

static void widen(EnfBox3f *box, const EnfBox3f *by) {
    box->min.x = by->min.x < box->min.x ? by->min.x : box->min.x;
    box->min.y = by->min.y < box->min.y ? by->min.y : box->min.y;
    box->min.z = by->min.z < box->min.z ? by->min.z : box->min.z;
    box->max.x = by->max.x > box->max.x ? by->max.x : box->max.x;
    box->max.y = by->max.y > box->max.y ? by->max.y : box->max.y;
    box->max.z = by->max.z > box->max.z ? by->max.z : box->max.z;
}

void enf_dbv_fits_clear(EnfDbvPlaces *places) {
    for (uint32_t place = 0; place < places->nodes_first; place++) {
        places->fits[place].own = nothing();
        places->fits[place].all = nothing();
        places->fits[place].loose = false;
    }
}

void enf_dbv_grow(EnfDbvPlaces *places, uint32_t place, EnfBox3f box) {
    if (place >= places->walks_first) {
        return; /* looked at whenever its cell is seen */
    }
    if (place < places->nodes_first) {
        widen(&places->fits[place].own, &box);
    }
    place = enf_dbv_owner(places, place); /* a kd node's volumes are its cell's */
    for (; place != ENF_NONE && !holds(&places->fits[place].all, &box); place = places->parents[place]) {
        widen(&places->fits[place].all, &box);
    }
}

static EnfBox3f box_of_block(const EnfDbvBlock *block) {
    EnfBox3f box = nothing();
    for (uint32_t lane = 0; lane < block->count; lane++) {
        EnfBox3f one = enf_dbv_lane(&block->boxes, lane);
        widen(&box, &one);
    }
    return box;
}

/* The box about a place's own volumes and the boxes of the places one step down. */
static EnfBox3f box_of_all(const EnfDbvPlaces *places, uint32_t place) {
    const EnfMap *map = places->map;
    EnfBox3f all = places->fits[place].own;
    if (place >= places->cells_first) {
        const EnfCell *cell = &map->cells[place - places->cells_first];
        if (cell->node_count > 0 && places->below[places->nodes_first + cell->node_first] > 0) {
            EnfBox3f within = enf_box3f_outward(places->boxes[place]);
            widen(&all, &within);
        }
        return all;
    }
    const EnfKdNode *node = &map->cell_nodes[place];
    if (node->block_count == 0) {
        widen(&all, &places->fits[place + 1].all);
        widen(&all, &places->fits[node->link].all);
        return all;
    }
    for (uint32_t i = 0; i < node->block_count * ENF_KD_BLOCK; i++) {
        uint32_t cell = map->cell_blocks[node->link + i / ENF_KD_BLOCK].item[i % ENF_KD_BLOCK];
        if (cell != ENF_NONE) {
            widen(&all, &places->fits[places->cells_first + cell].all);
        }
    }
    return all;
}

void enf_dbv_fit(EnfDbvIndex *index, uint32_t place) {
    EnfDbvPlaces *places = &index->places;
    EnfBox3f own = nothing();
    for (uint32_t number = places->heads[place]; number != ENF_NONE;) {
        const EnfDbvBlock *block = enf_dbv_block(&index->pool, number);
        EnfBox3f box = box_of_block(block);
        widen(&own, &box);
        number = block->next;
    }
    places->fits[place].own = own;
    places->fits[place].loose = false;
    for (; place != ENF_NONE; place = places->parents[place]) {
        EnfBox3f all = box_of_all(places, place);
        if (holds(&all, &places->fits[place].all)) {
            return; /* as large as before */
        }
        places->fits[place].all = all;
    }
}
