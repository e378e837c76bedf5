/* A frame of the index: begin (changes and expiries), see (exposure by visible windows), end (new volumes for what was exposed).
 * Its cost follows what is seen, what expired and what changed; hidden objects are not touched (DESIGN §5). */
#include "dbv/dbv_internal.h"

#include <string.h>

/* Objects that were exposed and not drawn get new volumes, so many a frame and a share of the rest: when a long view opens, or the eye
 * jumps, it is paid for in instalments. The others are exposed again in the next frame, which costs less. */
#define RENEWED_A_FRAME 8U
#define RENEWED_SHARE 8U

/* ---- begin ------------------------------------------------------------------------------------------------------ */

static void forget(EnfDbvIndex *index, uint32_t object) {
    EnfDbvVolume *volume = &index->volumes[object];
    if (volume->alive) {
        enf_dbv_wheel_remove(index, object);
        enf_dbv_unhang(index, object);
        volume->alive = false;
        index->alive_count--;
    }
}

/* An object was added, removed or changed; or not, if this is a repeat. */
static bool take_in(EnfDbvIndex *index, uint32_t object) {
    if (!enf_dbv_reserve_volumes(index, object + 1)) {
        return false;
    }
    forget(index, object);
    if (enf_world_object(index->world, object).generation != 0) {
        index->volumes[object].alive = true;
        index->alive_count++;
        enf_dbv_renew(index, object, ENF_DBV_NEW);
    }
    return true;
}

static bool take_in_changes(EnfDbvIndex *index) {
    bool ok = true;
    if (index->first) {
        index->failed = false; /* everything is tried anew */
        uint32_t limit = enf_world_object_limit(index->world);
        ok = enf_dbv_reserve_volumes(index, limit);
        for (uint32_t object = 0; object < limit && ok; object++) {
            ok = take_in(index, object);
        }
        ok = ok && !index->failed; /* a volume that could not be hung sets `first` again */
        index->first = !ok;
        return ok;
    }
    uint32_t count = 0;
    const uint32_t *changes = enf_world_changes(index->world, &count);
    for (uint32_t i = 0; i < count && ok; i++) {
        ok = take_in(index, changes[i]);
    }
    return ok;
}

/* The due are many and far apart in memory: the next ones are asked for while one is worked on; first the record, then what it
 * names. */
static void prefetch_due(const EnfDbvIndex *index, uint32_t i) {
    const EnfDbvPool *pool = &index->pool;
    const uint32_t *due = index->due.items;
    if (i + 12 < index->due.count) {
        enf_dbv_prefetch(&index->volumes[due[i + 12]]);
        enf_world_prefetch(index->world, due[i + 12]);
    }
    if (i + 8 < index->due.count) {
        const EnfDbvVolume *volume = &index->volumes[due[i + 8]];
        for (uint32_t k = 0; k < volume->link_count; k++) {
            enf_dbv_prefetch_block(enf_dbv_block(pool, volume->links[k] / ENF_KD_BLOCK));
        }
        enf_world_prefetch_named(index->world, due[i + 8]);
    }
    if (i + 4 < index->due.count) {
        const EnfDbvVolume *volume = &index->volumes[due[i + 4]];
        for (uint32_t k = 0; k < volume->link_count; k++) {
            uint32_t place = enf_dbv_block(pool, volume->links[k] / ENF_KD_BLOCK)->place;
            enf_dbv_prefetch_block(enf_dbv_block(pool, index->places.heads[place]));
        }
    }
}

static bool renew_expired(EnfDbvIndex *index) {
    index->due.count = 0;
    bool ok = enf_dbv_wheel_advance(index, enf_world_tick(index->world));
    for (uint32_t i = 0; i < index->due.count; i++) {
        prefetch_due(index, i);
        index->counters.expired++;
        enf_dbv_renew(index, index->due.items[i], ENF_DBV_UNSEEN);
    }
    return ok;
}

EnfResult enf_dbv_begin(EnfDbvIndex *index, EnfError *error) {
    memset(&index->counters, 0, sizeof index->counters);
    index->exposure_count = 0;
    index->drawn.count = 0;
    index->failed = false;
    enf_dbv_choose_approach(index);
    bool ok = renew_expired(index);
    ok = take_in_changes(index) && ok && !index->failed;
    index->frame++;
    if (index->frame == 0) { /* stamps of the last round must not look new */
        memset(index->places.hot_frame, 0, index->places.nodes_first * sizeof *index->places.hot_frame);
        for (uint32_t i = 0; i < index->volume_count; i++) {
            index->volumes[i].exposed_frame = 0;
        }
        index->frame = 1;
        index->hot_frame = 0;
    }
    index->failed = !ok;
    return ok ? ENF_OK : enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for volumes");
}

/* ---- see -------------------------------------------------------------------------------------------------------- */

/* The exposure of an object in this frame; its motion is evaluated once. NULL without memory. */
static EnfDbvExposure *expose(EnfDbvIndex *index, uint32_t object) {
    EnfDbvVolume *volume = &index->volumes[object];
    if (volume->exposed_frame != index->frame) {
        if (!enf_dbv_reserve_exposures(index, index->exposure_count + 1)) {
            index->failed = true;
            return NULL;
        }
        index->counters.appeared += volume->exposed_frame != index->frame - 1 ? 1U : 0U;
        volume->exposed_frame = index->frame;
        volume->exposure = index->exposure_count++;
        EnfDbvExposure exposure = {object, false, enf_world_seen_box(index->world, object)};
        index->exposures[volume->exposure] = exposure;
        index->counters.exposed++;
        index->counters.late += volume->expiry_tick < enf_world_tick(index->world) ? 1U : 0U;
    }
    return &index->exposures[volume->exposure];
}

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

/* Is an object with this box seen? By its touching the cell and passing the pyramid. */
static bool shows(const EnfDbvIndex *index, const Look *look, const EnfBox3f *box) {
    return is_near(look, box) && enf_pyramid_box(look->pyramid, enf_world_box_in_cell(index->map, look->cell, *box));
}

/* Objects of one block whose volumes the window shows; how many. */
static uint32_t gather(EnfDbvIndex *index, const Look *look, const EnfDbvBlock *block, uint32_t mask) {
    uint32_t count = 0;
    for (uint32_t shown = mask & 0xff; shown != 0; shown &= shown - 1) {
        uint32_t lane = enf_simd_lowest(shown);
        uint32_t object = block->boxes.item[lane] / ENF_DBV_LINKS;
        EnfBox3f box = enf_dbv_lane(&block->boxes, lane);
        if (is_near(look, &box)) {
            index->failed = !enf_dbv_list_add(index, &index->candidates, object) || index->failed;
            count++;
        }
    }
    return count;
}

/* Every volume that hangs on a place; how many the window shows. */
static uint32_t test_place(EnfDbvIndex *index, uint32_t place, const Look *look) {
    uint32_t number = index->places.heads[place];
    uint32_t count = 0;
    while (number != ENF_NONE) {
        const EnfDbvBlock *block = enf_dbv_block(&index->pool, number);
        number = block->next;
        if (number != ENF_NONE) {
            enf_dbv_prefetch_block(enf_dbv_block(&index->pool, number));
        }
        uint32_t mask = look->simd->boxes(&look->planes, block->boxes.min_x, look->planes.all);
        index->counters.tested += block->count;
        count += gather(index, look, block, mask);
    }
    return count;
}

/* The kd nodes of a cell that the pyramid passes and that have entries at or beneath them. Of another cell than the seen one, whose
 * box it reaches into, all. */
static void test_tree(EnfDbvIndex *index, uint32_t cell, const Look *look) {
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
        (void)test_place(index, first + at, look);
        const uint32_t pair[2] = {at + 1, node->link};
        for (uint32_t i = 0; i < 2 && node->block_count == 0; i++) {
            if (places->below[first + pair[i]] > 0) {
                stack[depth++] = pair[i];
            }
        }
    }
}

/* A node's or cell's own volumes. A look that came for nothing fits the box that led to it. */
static void test_own(EnfDbvIndex *index, uint32_t place, const Look *look) {
    const EnfDbvFit *fit = &index->places.fits[place];
    if (is_near(look, &fit->own) && test_place(index, place, look) == 0 && fit->loose) {
        enf_dbv_fit(index, place);
    }
}

static void test_place_and_tree(EnfDbvIndex *index, uint32_t place, const Look *look) {
    if (place >= index->places.cells_first) {
        test_tree(index, place - index->places.cells_first, look);
    }
    test_own(index, place, look);
}

/* All places whose volumes reach into the seen cell. */
static void test_all(EnfDbvIndex *index, const Look *look) {
    const EnfDbvPlaces *places = &index->places;
    EnfDbvWalk walk = enf_dbv_walk(places);
    for (uint32_t place = enf_dbv_walk_next(&walk); place != ENF_NONE; place = enf_dbv_walk_next(&walk)) {
        if (is_near(look, &places->fits[place].all)) {
            test_place_and_tree(index, place, look);
            enf_dbv_walk_enter(&walk, place);
        }
    }
    uint32_t cell = places->cells_first + look->cell;
    if (places->parents[cell] == ENF_NONE && is_near(look, &places->fits[cell].all)) {
        test_place_and_tree(index, cell, look); /* OUTSIDE: what lies in no room */
    }
}

/* What comes into sight was hidden, and its memory is cold: asked for ahead of its turn, and what its motion names a little later. */
static void prefetch_candidate(const EnfDbvIndex *index, uint32_t i) {
    const uint32_t *candidates = index->candidates.items;
    if (i + 12 < index->candidates.count) {
        enf_dbv_prefetch(&index->volumes[candidates[i + 12]]);
        enf_world_prefetch(index->world, candidates[i + 12]);
    }
    if (i + 6 < index->candidates.count) {
        enf_world_prefetch_named(index->world, candidates[i + 6]);
    }
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
    const EnfDbvPlaces *places = &index->places;
    Look look;
    look.cell = cell;
    look.limits = places->limits[places->cells_first + cell];
    look.pyramid = pyramid;
    look.simd = enf_simd();
    enf_dbv_planes(index, cell, pyramid, &look.planes);
    enf_dbv_note_seen(index, cell);
    index->candidates.count = 0;
    (void)test_place(index, places->walks_first + cell, &look);
    test_all(index, &look);
    expose_candidates(index, &look);
}

/* ---- end -------------------------------------------------------------------------------------------------------- */

/* Is a volume left until it ends? A drawn object will be evaluated in the next frame whatever its volume; one that showed and its
 * object not would not get a tighter one while it is young and short. */
static bool stays(const EnfDbvIndex *index, const EnfDbvExposure *exposure) {
    const EnfDbvVolume *volume = &index->volumes[exposure->object];
    if (index->def.policy == ENF_DBV_CONSTANT || volume->period <= 1) {
        return true;
    }
    if (!enf_dbv_keeps_off_seen(index)) {
        return exposure->drawn && volume->period <= (uint32_t)ENF_DBV_DRAWN_PERIOD;
    }
    int64_t left = volume->expiry_tick - enf_world_tick(index->world);
    bool young = left > (int64_t)(volume->period / 2);
    return exposure->drawn || (young && volume->period <= (uint32_t)ENF_DBV_DRAWN_PERIOD);
}

static void prefetch_exposed(const EnfDbvIndex *index, uint32_t i) {
    if (i + 6 < index->exposure_count && !index->exposures[i + 6].drawn) {
        const EnfDbvVolume *volume = &index->volumes[index->exposures[i + 6].object];
        for (uint32_t k = 0; k < volume->link_count; k++) {
            enf_dbv_prefetch_block(enf_dbv_block(&index->pool, volume->links[k] / ENF_KD_BLOCK));
        }
        enf_dbv_wheel_prefetch(index, index->exposures[i + 6].object);
    }
}

/* New volumes for what was exposed, or the old ones cut. */
static void renew_exposed(EnfDbvIndex *index) {
    uint32_t renewed = 0;
    uint32_t most = RENEWED_A_FRAME + (index->exposure_count - index->drawn.count) / RENEWED_SHARE;
    bool shortens = enf_dbv_keeps_off_seen(index);
    for (uint32_t i = 0; i < index->exposure_count; i++) {
        const EnfDbvExposure *exposure = &index->exposures[i];
        prefetch_exposed(index, i);
        if (stays(index, exposure)) {
            continue;
        }
        if (exposure->drawn) {
            enf_dbv_renew(index, exposure->object, ENF_DBV_DRAWN);
        } else if (renewed < most) {
            renewed++;
            if (!shortens || !enf_dbv_shorten(index, exposure->object)) {
                enf_dbv_renew(index, exposure->object, ENF_DBV_SEEN);
            }
        }
    }
}

static bool ascending(const EnfDbvIndex *index, uint32_t a, uint32_t b) {
    (void)index;
    return a < b;
}

static void add_counters(EnfDbvCounters *total, const EnfDbvCounters *frame) {
    total->exposed += frame->exposed;
    total->appeared += frame->appeared;
    total->drawn += frame->drawn;
    total->expired += frame->expired;
    total->late += frame->late;
    total->reinserted += frame->reinserted;
    total->avoided += frame->avoided;
    total->nodes += frame->nodes;
    total->tested += frame->tested;
}

const uint32_t *enf_dbv_end(EnfDbvIndex *index, uint32_t *count) {
    for (uint32_t i = 0; i < index->exposure_count; i++) {
        if (index->exposures[i].drawn && !enf_dbv_list_add(index, &index->drawn, index->exposures[i].object)) {
            index->failed = true;
        }
    }
    enf_dbv_sort(index, &index->drawn, ascending);
    index->counters.drawn = index->drawn.count;
    renew_exposed(index);
    uint64_t touched = index->counters.exposed + index->counters.expired;
    index->counters.avoided = index->alive_count > touched ? index->alive_count - touched : 0;
    add_counters(&index->total, &index->counters);
    *count = index->drawn.count;
    return index->drawn.items;
}
