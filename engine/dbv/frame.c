/* A frame of the index: begin (changes and expiries), see (exposure by visible windows), end (new volumes for what was exposed).
 * Its cost follows what is seen, what expired and what changed; hidden objects are not touched (DESIGN §5). */
#include "dbv/dbv_internal.h"

#include <string.h>

/* Sleepers found on a node of the cells' tree above a seen cell are hung anew, lower down, so many a frame: the eye's approach is
 * paid for in instalments. Until then they are tested, never missed. */
#define DISTURBED_A_FRAME 512U

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
        uint32_t limit = enf_world_object_limit(index->world);
        ok = enf_dbv_reserve_volumes(index, limit);
        for (uint32_t object = 0; object < limit && ok; object++) {
            ok = take_in(index, object);
        }
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

/* The due are many and far apart in memory: the next ones are asked for while one is worked on. */
static void prefetch(const EnfDbvIndex *index, uint32_t i) {
#if defined(__GNUC__)
    if (i < index->due.count) {
        const EnfDbvVolume *volume = &index->volumes[index->due.items[i]];
        __builtin_prefetch(volume);
        __builtin_prefetch((const char *)volume + 64);
    }
#else
    (void)index;
    (void)i;
#endif
}

static bool renew_expired(EnfDbvIndex *index) {
    index->due.count = 0;
    bool ok = enf_dbv_wheel_advance(index, enf_world_tick(index->world));
    for (uint32_t i = 0; i < index->due.count; i++) {
        prefetch(index, i + 8);
        index->counters.expired++;
        enf_dbv_renew(index, index->due.items[i], ENF_DBV_UNSEEN);
    }
    return ok;
}

EnfResult enf_dbv_begin(EnfDbvIndex *index, EnfError *error) {
    memset(&index->counters, 0, sizeof index->counters);
    index->exposure_count = 0;
    index->disturbed.count = 0;
    index->drawn.count = 0;
    bool ok = renew_expired(index);
    ok = take_in_changes(index) && ok;
    index->frame++;
    if (index->frame == 0) { /* stamps of the last round must not look new */
        memset(index->places.hot_frame, 0, index->places.count * sizeof *index->places.hot_frame);
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
        volume->exposed_frame = index->frame;
        volume->exposure = index->exposure_count++;
        EnfDbvExposure exposure = {object, false, enf_world_box(index->world, object)};
        index->exposures[volume->exposure] = exposure;
        index->counters.exposed++;
    }
    return &index->exposures[volume->exposure];
}

static bool shows(const EnfDbvIndex *index, uint32_t cell, const EnfPyramid *pyramid, EnfBox3f box) {
    return enf_world_touches(index->map, cell, box) && enf_pyramid_box(pyramid, enf_world_box_in_cell(index->map, cell, box));
}

static void test_volume(EnfDbvIndex *index, uint32_t object, uint32_t cell, const EnfPyramid *pyramid) {
    index->counters.tested++;
    index->counters.late += index->volumes[object].expiry_tick < enf_world_tick(index->world) ? 1U : 0U;
    if (!shows(index, cell, pyramid, index->volumes[object].box)) {
        return;
    }
    EnfDbvExposure *exposure = expose(index, object);
    if (exposure != NULL && !exposure->drawn && shows(index, cell, pyramid, exposure->box)) {
        exposure->drawn = true;
    }
}

/* Every volume that hangs on a place. `high`: a node of the cells' tree, where those who would rather sleep should not hang. */
static void test_place(EnfDbvIndex *index, uint32_t place, uint32_t cell, const EnfPyramid *pyramid, bool high) {
    for (uint32_t entry = index->places.heads[place]; entry != ENF_NONE;) {
        uint32_t object = entry / ENF_DBV_LINKS;
        const EnfDbvLink *link = &index->volumes[object].links[entry % ENF_DBV_LINKS];
        test_volume(index, object, cell, pyramid);
        if (high && index->disturbed.count < DISTURBED_A_FRAME) {
            (void)enf_dbv_list_add(index, &index->disturbed, object);
        }
        entry = link->next;
    }
}

/* The kd nodes of a cell that the pyramid passes and that have entries at or beneath them. */
static void test_tree(EnfDbvIndex *index, uint32_t cell, const EnfPyramid *pyramid) {
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
        if (!enf_pyramid_box(pyramid, box)) {
            continue;
        }
        test_place(index, first + at, cell, pyramid, false);
        const uint32_t pair[2] = {at + 1, node->link};
        for (uint32_t i = 0; i < 2 && node->block_count == 0; i++) {
            if (places->below[first + pair[i]] > 0) {
                stack[depth++] = pair[i];
            }
        }
    }
}

void enf_dbv_see(EnfDbvIndex *index, uint32_t cell, const EnfPyramid *pyramid) {
    EnfDbvPlaces *places = &index->places;
    uint32_t place = places->cells_first + cell;
    index->hot_frame = index->frame;
    test_place(index, place, cell, pyramid, false);
    test_tree(index, cell, pyramid);
    for (; place != ENF_NONE; place = places->parents[place]) {
        places->hot_frame[place] = index->frame;
        if (place < places->cells_first) {
            test_place(index, place, cell, pyramid, true);
        }
    }
}

/* ---- end -------------------------------------------------------------------------------------------------------- */

/* New volumes for what was exposed: a drawn object keeps its volume until it expires if that is short already; one that was shown
 * only by its volume gets a tighter one. */
static void renew_exposed(EnfDbvIndex *index) {
    for (uint32_t i = 0; i < index->exposure_count; i++) {
        const EnfDbvExposure *exposure = &index->exposures[i];
        const EnfDbvVolume *volume = &index->volumes[exposure->object];
        bool constant = index->def.policy == ENF_DBV_CONSTANT;
        bool shortest = volume->period <= (exposure->drawn ? (uint32_t)ENF_DBV_DRAWN_PERIOD : 1U);
        if (!constant && !shortest) {
            enf_dbv_renew(index, exposure->object, exposure->drawn ? ENF_DBV_DRAWN : ENF_DBV_SEEN);
        }
    }
}

static void renew_disturbed(EnfDbvIndex *index) {
    for (uint32_t i = 0; i < index->disturbed.count && enf_dbv_keeps_off_seen(index); i++) {
        uint32_t object = index->disturbed.items[i];
        const EnfDbvVolume *volume = &index->volumes[object];
        bool fresh = volume->expiry_tick - (int64_t)volume->period == enf_world_tick(index->world);
        if (volume->exposed_frame != index->frame && !fresh) {
            enf_dbv_renew(index, object, ENF_DBV_DISTURBED);
        }
    }
}

static bool ascending(const EnfDbvIndex *index, uint32_t a, uint32_t b) {
    (void)index;
    return a < b;
}

static void add_counters(EnfDbvCounters *total, const EnfDbvCounters *frame) {
    total->exposed += frame->exposed;
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
    renew_disturbed(index);
    uint64_t touched = index->counters.exposed + index->counters.expired;
    index->counters.avoided = index->alive_count > touched ? index->alive_count - touched : 0;
    add_counters(&index->total, &index->counters);
    *count = index->drawn.count;
    return index->drawn.items;
}
