/* A window's look at the index: which volumes it shows, and which of their objects. What comes into sight was hidden, and its memory
 * is cold. So a look goes in three rows, each of which knows well ahead what it will touch and asks for it: the places, the blocks
 * that hang on them, the objects whose volumes show. */
#include "dbv/dbv_internal.h"

/* So many blocks, objects, and what objects name, are on their way from memory at once. */
enum { BLOCKS_AHEAD = 12, OBJECTS_AHEAD = 12, NAMED_AHEAD = 6 };

/* What was exposed so many frames ago is known still: as many eyes may take turns at one index. */
#define RECENT 4U

/* A window as the steps of one enf_dbv_see use it. */
typedef struct Look {
    uint32_t cell;
    EnfBox3f limits;           /* the cell's, world */
    const EnfPyramid *pyramid; /* relative to the cell */
    const EnfSimd *simd;
    EnfSimdPlanes planes; /* of world boxes */
} Look;

static inline bool is_near(const Look *look, const EnfBox3f *box) {
    return enf_dbv_touches(&look->limits, box);
}

/* ---- places ----------------------------------------------------------------------------------------------------- */

static void add(EnfDbvIndex *index, EnfDbvList *list, uint32_t item) {
    index->failed = !enf_dbv_list_add(index, list, item) || index->failed;
}

/* A block that will be tested after those that wait. */
static void add_block(EnfDbvIndex *index, uint32_t number) {
    if (number != ENF_NONE) {
        add(index, &index->blocks, number);
    }
}

/* The kd nodes of a cell that the pyramid passes and that have entries at or beneath them. Of another cell than the seen one, whose
 * box it reaches into, all. */
static void add_tree(EnfDbvIndex *index, uint32_t cell, const Look *look) {
    const EnfDbvPlaces *places = &index->places;
    const EnfCell *c = &index->map->cells[cell];
    uint32_t first = places->nodes_first + c->node_first;
    uint32_t stack[ENF_KD_MAX_DEPTH + 1];
    uint32_t depth = 0;
    if (c->node_count > 0 && places->below[first] > 0) {
        stack[depth++] = 0;
    }
    while (depth > 0) {
        uint32_t at = stack[--depth];
        const EnfKdNode *node = &index->map->kd_nodes[c->node_first + at];
        EnfBox3f box = {{node->min[0], node->min[1], node->min[2]}, {node->max[0], node->max[1], node->max[2]}};
        if (cell == look->cell && !enf_pyramid_box(look->pyramid, box)) {
            continue;
        }
        add_block(index, places->heads[first + at]);
        const uint32_t pair[2] = {at + 1, node->link};
        for (uint32_t i = 0; i < 2 && node->block_count == 0; i++) {
            if (places->below[first + pair[i]] > 0) {
                stack[depth++] = pair[i];
            }
        }
    }
}

/* A node's or cell's own volumes. A look that comes for nothing fits the box that led to it, afterwards. */
static void add_own(EnfDbvIndex *index, uint32_t place, const Look *look) {
    EnfDbvFit *fit = &index->places.fits[place];
    if (is_near(look, &fit->own)) {
        add_block(index, index->places.heads[place]);
        if (fit->loose) {
            fit->shown = false;
            add(index, &index->loose, place);
        }
    }
}

static void add_place_and_tree(EnfDbvIndex *index, uint32_t place, const Look *look) {
    if (place >= index->places.cells_first) {
        add_tree(index, place - index->places.cells_first, look);
    }
    add_own(index, place, look);
}

/* All places whose volumes reach into the seen cell. */
static void add_places(EnfDbvIndex *index, const Look *look) {
    const EnfDbvPlaces *places = &index->places;
    add_block(index, places->heads[places->walks_first + look->cell]);
    EnfDbvWalk walk = enf_dbv_walk(places);
    for (uint32_t place = enf_dbv_walk_next(&walk); place != ENF_NONE; place = enf_dbv_walk_next(&walk)) {
        if (is_near(look, &places->fits[place].all)) {
            add_place_and_tree(index, place, look);
            enf_dbv_walk_enter(&walk, place);
        }
    }
    uint32_t cell = places->cells_first + look->cell;
    if (places->parents[cell] == ENF_NONE && is_near(look, &places->fits[cell].all)) {
        add_place_and_tree(index, cell, look); /* OUTSIDE: what lies in no room */
    }
}

/* ---- blocks ----------------------------------------------------------------------------------------------------- */

/* Objects of one block whose volumes the window shows. */
static void gather(EnfDbvIndex *index, const Look *look, const EnfDbvBlock *block, uint32_t mask) {
    for (uint32_t shown = mask & 0xff; shown != 0; shown &= shown - 1) {
        uint32_t lane = enf_simd_lowest(shown);
        EnfBox3f box = enf_dbv_lane(&block->boxes, lane);
        if (is_near(look, &box)) {
            add(index, &index->candidates, block->boxes.item[lane] / ENF_DBV_LINKS);
            if (block->place < index->places.nodes_first) {
                index->places.fits[block->place].shown = true;
            }
        }
    }
}

/* Every volume that hangs on a place that was found. A block names the next of its place, which goes to the end of the row: by then
 * it is there. */
static void test_blocks(EnfDbvIndex *index, const Look *look) {
    for (uint32_t i = 0; i < index->blocks.count; i++) {
        const EnfDbvBlock *block = enf_dbv_block(&index->pool, index->blocks.items[i]);
        add_block(index, block->next);
        uint32_t ahead = i + BLOCKS_AHEAD < index->blocks.count ? i + BLOCKS_AHEAD : index->blocks.count - 1;
        enf_dbv_prefetch_block(enf_dbv_block(&index->pool, index->blocks.items[ahead]));
        uint32_t mask = look->simd->boxes(&look->planes, block->boxes.min_x, look->planes.all);
        index->counters.tested += block->count;
        gather(index, look, block, mask);
    }
}

static void fit_loose(EnfDbvIndex *index) {
    for (uint32_t i = 0; i < index->loose.count; i++) {
        if (!index->places.fits[index->loose.items[i]].shown) {
            enf_dbv_fit(index, index->loose.items[i]);
        }
    }
}

/* ---- objects ---------------------------------------------------------------------------------------------------- */

static void prefetch_candidate(const EnfDbvIndex *index, uint32_t i) {
    const uint32_t *candidates = index->candidates.items;
    if (i + OBJECTS_AHEAD < index->candidates.count) {
        enf_dbv_prefetch(&index->volumes[candidates[i + OBJECTS_AHEAD]]);
        enf_world_prefetch(index->world, candidates[i + OBJECTS_AHEAD]);
    }
    if (i + NAMED_AHEAD < index->candidates.count) {
        enf_world_prefetch_named(index->world, candidates[i + NAMED_AHEAD]);
    }
}

/* The exposure of an object in this frame; its motion is evaluated once. NULL without memory. */
static EnfDbvExposure *expose(EnfDbvIndex *index, uint32_t object) {
    EnfDbvVolume *volume = &index->volumes[object];
    if (volume->exposed_frame != index->frame) {
        if (!enf_dbv_reserve_exposures(index, index->exposure_count + 1)) {
            index->failed = true;
            return NULL;
        }
        index->counters.appeared += index->frame - volume->exposed_frame > RECENT ? 1U : 0U;
        volume->exposed_frame = index->frame;
        volume->exposure = index->exposure_count++;
        EnfDbvExposure exposure = {object, false, enf_world_seen_box(index->world, object)};
        index->exposures[volume->exposure] = exposure;
        index->counters.exposed++;
        index->counters.late += volume->expiry_tick < enf_world_tick(index->world) ? 1U : 0U;
    }
    return &index->exposures[volume->exposure];
}

/* Is an object with this box seen? By its touching the cell and passing the pyramid. */
static bool shows(const EnfDbvIndex *index, const Look *look, const EnfBox3f *box) {
    return is_near(look, box) && enf_pyramid_box(look->pyramid, enf_world_box_in_cell(index->map, look->cell, *box));
}

/* The objects themselves: the volumes only said which might be seen. */
static void expose_candidates(EnfDbvIndex *index, const Look *look) {
    for (uint32_t i = 0; i < index->candidates.count; i++) {
        prefetch_candidate(index, i);
        EnfDbvExposure *exposure = expose(index, index->candidates.items[i]);
        if (exposure != NULL && !exposure->drawn && shows(index, look, &exposure->box)) {
            exposure->drawn = true;
        }
    }
}

void enf_dbv_see(EnfDbvIndex *index, uint32_t cell, const EnfPyramid *pyramid) {
    Look look;
    look.cell = cell;
    look.limits = index->places.limits[index->places.cells_first + cell];
    look.pyramid = pyramid;
    look.simd = enf_simd();
    enf_dbv_planes(index, cell, pyramid, &look.planes);
    enf_dbv_note_seen(index, cell);
    index->blocks.count = index->loose.count = index->candidates.count = 0;
    add_places(index, &look);
    test_blocks(index, &look);
    fit_loose(index);
    expose_candidates(index, &look);
}
