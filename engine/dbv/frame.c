/* A frame of the index: begin (changes and expiries), see (look.c), end (new volumes for what was exposed). Its cost follows what is
 * seen, what expired and what changed; hidden objects are not touched (DESIGN §5). */
#include "dbv/dbv_internal.h"

#include <string.h>

/* Objects that were exposed and not drawn get new volumes, so many a frame and a share of them, of which a share of what came into
 * sight is taken off: when a long view opens, or the eye jumps, it is paid for in instalments, the first of which is finding what is
 * there. The others are exposed again in the next frame, which costs less. */
#define RENEWED_A_FRAME 8U
#define RENEWED_SHARE 8U
#define APPEARED_SHARE 4U

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
    uint32_t share = (index->exposure_count - index->drawn.count) / RENEWED_SHARE;
    uint32_t found = (uint32_t)index->counters.appeared / APPEARED_SHARE;
    uint32_t most = RENEWED_A_FRAME + (share > found ? share - found : 0);
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
    enf_dbv_sort_numbers(index, &index->drawn, 0);
    index->counters.drawn = index->drawn.count;
    renew_exposed(index);
    uint64_t touched = index->counters.exposed + index->counters.expired;
    index->counters.avoided = index->alive_count > touched ? index->alive_count - touched : 0;
    add_counters(&index->total, &index->counters);
    *count = index->drawn.count;
    return index->drawn.items;
}
