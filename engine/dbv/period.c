/* How long a volume is valid: the policies of Sudarsky & Gotsman 1996 §3.2 and of DESIGN §5. A longer period costs fewer renewals
 * and a looser volume, which is seen sooner. */
#include "dbv/dbv_internal.h"

#include <math.h>

/* A drawn object will be drawn again: its volume is renewed a few times a second, and is hardly looser than itself. */
#define DRAWN_PERIOD ((uint32_t)ENF_DBV_DRAWN_PERIOD)
/* What stands in a seen cell and is not looked at: behind the eye, behind a corner. Longer each time it stays unseen, up to this;
 * volumes in which the eye is interested are cut as soon as they are looked at. */
#define BESIDE_PERIODS 48U
/* How much of the way to the nearest seen cell a volume may take. All of it would need the fewest renewals; but then, when a door
 * comes into sight, the volumes of half the world reach into the room behind it, and that frame wakes them all (PITFALLS 23).
 * At a share k of the way, a room that is d away from what was seen is met by volumes from no farther than k d / (1 - k). How many
 * that are goes with the crowd: where cells hold many, the share is smaller. Measured with 1, 10, 100 objects a cell: 0.4, 0.4 and
 * 0.3 are best. */
#define APPROACH_MOST 0.4
#define APPROACH_LEAST 0.2
#define APPROACH_DOUBLING 0.03
#define APPROACH_CROWD 8U
/* Few rooms hold a volume that walks, so that it is not worth asking for what would fly so many rooms' lengths anyway. */
#define WALK 0.35
/* How much of its time to the portal of a seen cell a volume that walks may last. All of it would hold the room's whole crowd the
 * moment a door opens on it. */
#define WALK_APPROACH 0.6
/* How far a volume may reach through a wall, in rooms' lengths. */
#define NEAR_WALL 0.0625
/* What is shortened ends in that many ticks and a part of so many more, each object at its own. */
#define SHORT_PERIODS 32U
/* The first volumes, made before anything was seen, end over so many ticks. */
#define BLIND_PERIODS 48U

/* The same object gets the same share of a period, and different ones different shares, so that a crowd that was made in one tick
 * does not expire in one (PITFALLS 23). Takes off up to an eighth. */
static uint32_t spread(uint32_t period, uint32_t object) {
    return period - (uint32_t)((uint64_t)period * enf_dbv_hash(object) >> 35);
}

/* A crowd that was made in one tick and whose periods are equal would end in one for ever: the first period is any part of it. */
static uint32_t first_share(uint32_t period, uint32_t object) {
    return 1U + enf_dbv_scatter(object, period);
}

static uint32_t clamp_period(const EnfDbvIndex *index, double ticks) {
    double most = (double)index->def.max_period_ticks;
    return ticks < 1.0 ? 1U : ticks >= most ? index->def.max_period_ticks : (uint32_t)ticks;
}

static EnfBox3f bound_for(EnfDbvIndex *index, uint32_t object, uint32_t period) {
    return enf_world_bound(index->world, object, enf_world_tick(index->world) + (int64_t)period);
}

/* No cell was seen yet, so nothing says how near the eye will be: short, and no two alike, so that the first seconds pay for it in
 * instalments. */
static uint32_t blind(const EnfDbvIndex *index, uint32_t object) {
    return clamp_period(index, (double)(DRAWN_PERIOD + enf_dbv_scatter(object, BLIND_PERIODS)));
}

void enf_dbv_choose_approach(EnfDbvIndex *index) {
    double share = APPROACH_MOST;
    uint32_t few = (index->map->cells_count + 1U) * APPROACH_CROWD;
    for (uint32_t crowd = index->alive_count / few; crowd > 1; crowd /= 2) {
        share -= APPROACH_DOUBLING;
    }
    index->approach = share > APPROACH_LEAST ? share : APPROACH_LEAST;
}

/* Where an object is that gets a new volume. */
typedef struct Here {
    EnfBox3f box;
    double gap; /* metres to the nearest seen cell; below 0: it touches one, or was not asked for */
} Here;

/* May a volume be this near to what is seen, made from an object that is `gap` away? */
static bool keeps_off(EnfDbvIndex *index, EnfBox3f box, double gap) {
    return enf_dbv_distance_to_seen(index, box) >= (1.0 - index->approach) * gap;
}

/* In a seen cell there is nothing to keep off from. */
static uint32_t beside(const EnfDbvIndex *index, uint32_t last, EnfDbvCause cause) {
    double ticks = cause == ENF_DBV_UNSEEN ? 2.0 * (double)last : DRAWN_PERIOD;
    ticks = ticks > BESIDE_PERIODS ? BESIDE_PERIODS : ticks < DRAWN_PERIOD ? DRAWN_PERIOD : ticks;
    return clamp_period(index, ticks);
}

/* Behind the wall of a seen cell the share of the way is nothing, and volumes would end in every tick; that one reaches through the
 * wall a little costs less. */
static uint32_t least_period(const EnfDbvIndex *index, double speed) {
    double ticks = speed > 0.0 ? NEAR_WALL * index->room / speed * ENF_TICK_RATE : DRAWN_PERIOD;
    return clamp_period(index, ticks < DRAWN_PERIOD ? ticks : DRAWN_PERIOD);
}

/* The longest period whose volume keeps off the seen cells: for ever if the whole path lies in a few cells, none of them seen. Else
 * doubled and bisected over the motion's own bounds. */
static uint32_t maximal(EnfDbvIndex *index, uint32_t object, double gap) {
    EnfBox3f whole = bound_for(index, object, index->def.max_period_ticks);
    double whole_gap = enf_dbv_distance_to_seen(index, whole);
    if (whole_gap >= (1.0 - index->approach) * gap || (whole_gap >= 0.0 && enf_dbv_in_few_cells(index, whole))) {
        return index->def.max_period_ticks;
    }
    double speed = enf_world_max_speed(index->world, object);
    uint32_t least = least_period(index, speed);
    if (!keeps_off(index, bound_for(index, object, least), gap)) {
        return least;
    }
    uint32_t good = speed < HUGE_VAL ? clamp_period(index, index->approach * gap / speed * ENF_TICK_RATE) : 1U;
    if (good > 1 && !keeps_off(index, bound_for(index, object, good), gap)) {
        good = 1; /* the box of a turned object grows by corners: the speed is of its points */
    }
    good = good > least ? good : least;
    uint32_t bad = good;
    for (int doublings = 0; doublings < 20; doublings++) {
        bad = clamp_period(index, 2.0 * (double)bad);
        if (!keeps_off(index, bound_for(index, object, bad), gap)) {
            break;
        }
        good = bad;
        if (bad == index->def.max_period_ticks) {
            return bad;
        }
    }
    while (bad - good > good / 4 + 1) { /* a quarter too short costs less than another bound */
        uint32_t middle = good + (bad - good) / 2;
        if (keeps_off(index, bound_for(index, object, middle), gap)) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    return good;
}

/* Free objects move by their speed alone, so that their period follows from the distance in one step. */
static uint32_t maximal_free(EnfDbvIndex *index, uint32_t object, double gap) {
    double speed = enf_world_max_speed(index->world, object);
    uint32_t least = least_period(index, speed);
    uint32_t ticks = speed > 0.0 ? clamp_period(index, index->approach * gap / speed * ENF_TICK_RATE)
                                 : index->def.max_period_ticks;
    return ticks > least ? ticks : least;
}

static uint32_t adaptive(const EnfDbvIndex *index, uint32_t last, EnfDbvCause cause) {
    switch (cause) {
    case ENF_DBV_NEW:
        return index->def.period_ticks;
    case ENF_DBV_UNSEEN:
        return clamp_period(index, 2.0 * (double)last);
    case ENF_DBV_SEEN:
    case ENF_DBV_DRAWN:
        return clamp_period(index, 0.5 * (double)last);
    }
    return last;
}

/* Doubled until seen, then between the longest unseen and the shortest seen. When these meet, time has moved on and the search
 * begins anew from there. */
static uint32_t optimal(EnfDbvIndex *index, EnfDbvVolume *volume, EnfDbvCause cause) {
    uint32_t last = volume->period;
    if (cause == ENF_DBV_NEW) {
        volume->bad_period = 0;
        return index->def.period_ticks;
    }
    if (cause == ENF_DBV_SEEN || cause == ENF_DBV_DRAWN) {
        volume->bad_period = last;
        return clamp_period(index, 0.5 * (double)last);
    }
    if (volume->bad_period == 0) {
        return clamp_period(index, 2.0 * (double)last);
    }
    if (volume->bad_period <= last + last / 8 + 1) {
        volume->bad_period = 0;
        return last;
    }
    return last + (volume->bad_period - last) / 2;
}

static uint32_t choose(EnfDbvIndex *index, uint32_t object, EnfDbvCause cause, Here *here) {
    EnfDbvVolume *volume = &index->volumes[object];
    switch (index->def.policy) {
    case ENF_DBV_CONSTANT:
        return index->def.period_ticks;
    case ENF_DBV_ADAPTIVE:
        return adaptive(index, volume->period, cause);
    case ENF_DBV_OPTIMAL:
        return optimal(index, volume, cause);
    case ENF_DBV_MAXIMAL:
    case ENF_DBV_REACH:
        break;
    }
    if (cause == ENF_DBV_DRAWN) {
        return DRAWN_PERIOD < index->def.max_period_ticks ? DRAWN_PERIOD : index->def.max_period_ticks;
    }
    if (index->hot_frame == 0) {
        return blind(index, object);
    }
    here->box = bound_for(index, object, 0);
    here->gap = enf_dbv_distance_to_seen(index, here->box);
    if (here->gap < 0.0) {
        return beside(index, volume->period, cause);
    }
    return enf_world_is_free(index->world, object) ? maximal_free(index, object, here->gap) : maximal(index, object, here->gap);
}

bool enf_dbv_keeps_off_seen(const EnfDbvIndex *index) {
    return index->def.policy == ENF_DBV_MAXIMAL || index->def.policy == ENF_DBV_REACH;
}

static void hang(EnfDbvIndex *index, uint32_t object, uint32_t period) {
    EnfDbvVolume *volume = &index->volumes[object];
    volume->period = period;
    volume->expiry_tick = enf_world_tick(index->world) + (int64_t)period;
    index->counters.reinserted++;
    enf_dbv_hang(index, object, bound_for(index, object, period));
}

/* A volume that hangs only where the object can walk to, if it lasts a good deal longer than `period`: a flood and several places
 * cost as much as a renewal. */
static bool hang_reaching(EnfDbvIndex *index, uint32_t object, uint32_t period, const Here *here) {
    EnfDbvReach reach;
    double speed = enf_world_max_speed(index->world, object);
    if (!enf_dbv_reach(index, here->box, &reach)) {
        return false;
    }
    bool ever = !(speed > 0.0) || reach.limit == HUGE_VAL;
    uint32_t longer = ever ? index->def.max_period_ticks
                           : clamp_period(index, WALK_APPROACH * reach.limit / speed * ENF_TICK_RATE);
    longer = spread(longer, object);
    double far = 1.001 * speed * (double)longer / ENF_TICK_RATE;
    if (longer - longer / 3 < period || !(far < reach.limit || ever)) {
        return false;
    }
    EnfDbvVolume *volume = &index->volumes[object];
    EnfBox3f box = bound_for(index, object, longer);
    volume->period = longer;
    volume->expiry_tick = enf_world_tick(index->world) + (int64_t)longer;
    enf_dbv_unhang(index, object);
    index->counters.reinserted++;
    enf_dbv_hang_reach(index, object, box, here->box, &reach);
    return true;
}

void enf_dbv_renew(EnfDbvIndex *index, uint32_t object, EnfDbvCause cause) {
    Here here = {{{0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F}}, -1.0};
    uint32_t period = choose(index, object, cause, &here);
    if (!enf_dbv_keeps_off_seen(index) && cause == ENF_DBV_NEW) {
        period = first_share(period, object);
    } else if (index->def.policy != ENF_DBV_CONSTANT) {
        period = spread(period, object);
    }
    enf_dbv_wheel_remove(index, object);
    double way = enf_world_max_speed(index->world, object) * (double)period / ENF_TICK_RATE;
    bool walks = index->portal_boxes != NULL && here.gap >= 0.0 && way < WALK * index->room;
    if (walks && enf_world_is_confined(index->world, object) && hang_reaching(index, object, period, &here)) {
        enf_dbv_wheel_add(index, object);
        return;
    }
    hang(index, object, period);
    enf_dbv_wheel_add(index, object);
}

/* A room that comes into sight shows the volumes of all that is in it, made when it was out of sight: large, and many in one frame.
 * To make them anew in that frame would cost more than the whole frame else does. Cut in place, they are out of the way, and are
 * made anew when they end: few a tick. */
bool enf_dbv_shorten(EnfDbvIndex *index, uint32_t object) {
    EnfDbvVolume *volume = &index->volumes[object];
    uint32_t period = DRAWN_PERIOD + enf_dbv_scatter(object, SHORT_PERIODS);
    int64_t now = enf_world_tick(index->world);
    if (volume->expiry_tick - now <= 2 * (int64_t)period) {
        return false;
    }
    EnfBox3f box = bound_for(index, object, period);
    for (uint32_t i = 0; i < volume->link_count; i++) {
        enf_dbv_cut(index, volume->links[i], box);
    }
    enf_dbv_wheel_remove(index, object);
    volume->period = period;
    volume->expiry_tick = now + (int64_t)period;
    enf_dbv_wheel_add(index, object);
    index->counters.reinserted++;
    return true;
}
