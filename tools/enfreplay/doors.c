/* Doors as a visitor meets them who has every key. The state is all in the motions: a target, and since when it is gone to. */
#include "enfreplay/doors.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Metres from the eye to what is used; cosine of the angle to it; metres about a door that must be empty before it closes. */
static const double REACH = 1.8, AHEAD = 0.5, CLEARANCE = 1.3;
enum { STAY_OPEN_TICKS = 240, LOOK_AGAIN_TICKS = 30, NAME_SIZE = 96 };

/* ---- what the map says ------------------------------------------------------------------------------------------ */

/* The text of `"key":"..."` in an entity's extras, "" if there is none. */
static void extras_text(const EnfMap *map, const EnfMover *mover, const char *key, char value[NAME_SIZE]) {
    char wanted[NAME_SIZE];
    int length = snprintf(wanted, sizeof wanted, "\"%s\":\"", key);
    const char *at = strstr(enf_map_string(map, map->entities[mover->entity].extras), wanted);
    value[0] = '\0';
    if (at) {
        at += length;
        size_t size = strcspn(at, "\"");
        if (size < NAME_SIZE) {
            memcpy(value, at, size);
            value[size] = '\0';
        }
    }
}

static bool swings(const EnfMover *mover) {
    return mover->kind == ENF_MOVER_HINGE || mover->kind == ENF_MOVER_SLIDE;
}

static bool is_lift(const EnfMover *mover) {
    return mover->kind == ENF_MOVER_SLIDE && fabsf(mover->axis[1]) > 0.5f;
}

EnfResult doors_create(Doors *doors, EnfWorld *world, EnfPortals *portals, EnfError *error) {
    const EnfMap *map = enf_world_map(world);
    memset(doors, 0, sizeof *doors);
    doors->map = map;
    doors->world = world;
    doors->portals = portals;
    doors->doors = enf_alloc(NULL, (size_t)map->movers_count + 1, sizeof *doors->doors);
    doors->passable = enf_alloc(NULL, (size_t)portals->count + 1, 1);
    if (!doors->doors || !doors->passable) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for doors");
    }
    for (uint32_t i = 0; i < map->movers_count; i++) {
        const EnfMover *mover = &map->movers[i];
        if (swings(mover)) {
            Door *door = &doors->doors[doors->count++];
            door->mover = i;
            door->motion = enf_mover_def(map, i).motion;
            door->open = (double)(mover->high >= -mover->low ? mover->high : mover->low);
            door->close_tick = INT64_MAX;
        }
    }
    doors_tick(doors, enf_v3(0.0, 0.0, 0.0), ENF_NONE);
    return ENF_OK;
}

void doors_destroy(Doors *doors) {
    if (doors->map) {
        enf_free(NULL, doors->doors, (size_t)doors->map->movers_count + 1, sizeof *doors->doors);
        enf_free(NULL, doors->passable, (size_t)doors->portals->count + 1, 1);
        memset(doors, 0, sizeof *doors);
    }
}

/* ---- sending ---------------------------------------------------------------------------------------------------- */

static void send(Doors *doors, Door *door, double target) {
    int64_t tick = enf_world_tick(doors->world);
    double way = fabs(target - enf_swing_position(&door->motion, tick));
    enf_swing_set(&door->motion, tick, target);
    enf_world_swing(doors->world, enf_world_object(doors->world, door->mover), target);
    bool stays = target == 0.0 || is_lift(&doors->map->movers[door->mover]);
    int64_t travel = (int64_t)ceil(way / door->motion.as.swing.rate * ENF_TICK_RATE);
    door->close_tick = stays ? INT64_MAX : tick + travel + STAY_OPEN_TICKS;
}

static Door *door_of(Doors *doors, uint32_t mover) {
    for (uint32_t i = 0; i < doors->count; i++) {
        if (doors->doors[i].mover == mover) {
            return &doors->doors[i];
        }
    }
    return NULL;
}

static void toggle(Doors *doors, Door *door) {
    send(doors, door, door->motion.as.swing.target == 0.0 ? door->open : 0.0);
}

/* Everything named `name` does what its first one does. */
static void toggle_all(Doors *doors, const char *name) {
    double opening = -1.0;
    for (uint32_t i = 0; i < doors->count; i++) {
        char own[NAME_SIZE];
        Door *door = &doors->doors[i];
        extras_text(doors->map, &doors->map->movers[door->mover], "targetname", own);
        if (strcmp(own, name) == 0) {
            opening = opening < 0.0 ? (double)(door->motion.as.swing.target == 0.0) : opening;
            send(doors, door, opening > 0.0 ? door->open : 0.0);
        }
    }
}

static void activate(Doors *doors, uint32_t mover) {
    char name[NAME_SIZE];
    Door *door = door_of(doors, mover);
    extras_text(doors->map, &doors->map->movers[mover], door ? "targetname" : "target", name);
    if (name[0]) {
        toggle_all(doors, name);
    } else if (door) {
        toggle(doors, door);
    }
}

/* ---- using ------------------------------------------------------------------------------------------------------ */

static EnfVec3 nearest_point(EnfBox3f box, EnfVec3 p) {
    double low[3] = {(double)box.min.x, (double)box.min.y, (double)box.min.z};
    double high[3] = {(double)box.max.x, (double)box.max.y, (double)box.max.z};
    double at[3] = {p.x, p.y, p.z};
    for (int i = 0; i < 3; i++) {
        at[i] = at[i] < low[i] ? low[i] : at[i] > high[i] ? high[i] : at[i];
    }
    return enf_v3(at[0], at[1], at[2]);
}

static bool can_be_used(const Doors *doors, uint32_t mover) {
    char target[NAME_SIZE] = "";
    const EnfMover *m = &doors->map->movers[mover];
    if (m->kind == ENF_MOVER_STILL) {
        extras_text(doors->map, m, "target", target);
    }
    return target[0] || (swings(m) && !is_lift(m));
}

void doors_use(Doors *doors, EnfVec3 eye_ws, EnfVec3 forward, uint32_t ground_object) {
    uint32_t used = ENF_NONE;
    double nearest = REACH;
    for (uint32_t i = 0; i < doors->map->movers_count; i++) {
        if (can_be_used(doors, i)) {
            EnfVec3 way = enf_sub(nearest_point(enf_world_box(doors->world, i), eye_ws), eye_ws);
            double distance = enf_length(way);
            if (distance < nearest && enf_dot(way, forward) >= AHEAD * distance) {
                nearest = distance;
                used = i;
            }
        }
    }
    if (used == ENF_NONE && ground_object < doors->map->movers_count && swings(&doors->map->movers[ground_object])) {
        used = ground_object;
    }
    if (used != ENF_NONE) {
        activate(doors, used);
    }
}

/* ---- time ------------------------------------------------------------------------------------------------------- */

static void close_in_time(Doors *doors, Door *door, EnfVec3 feet_ws) {
    int64_t tick = enf_world_tick(doors->world);
    if (tick >= door->close_tick) {
        EnfVec3 way = enf_sub(nearest_point(enf_world_box(doors->world, door->mover), feet_ws), feet_ws);
        if (enf_length(way) < CLEARANCE) {
            door->close_tick = tick + LOOK_AGAIN_TICKS;
        } else {
            send(doors, door, 0.0);
        }
    }
}

/* A portal with several leaves is open where one of them is not shut. */
static void set_portals(Doors *doors) {
    int64_t tick = enf_world_tick(doors->world);
    for (int pass = 0; pass < 3; pass++) {
        for (uint32_t i = 0; i < doors->count; i++) {
            const Door *door = &doors->doors[i];
            uint32_t portal = doors->map->movers[door->mover].portal;
            if (portal == ENF_NONE) {
                continue;
            }
            if (pass == 0) {
                doors->passable[portal] = 0;
            } else if (pass == 1) {
                doors->passable[portal] |= enf_swing_position(&door->motion, tick) != 0.0;
            } else if (enf_portals_is_open(doors->portals, portal) != (doors->passable[portal] != 0)) {
                enf_portals_set_open(doors->portals, portal, doors->passable[portal] != 0);
            }
        }
    }
}

void doors_tick(Doors *doors, EnfVec3 feet_ws, uint32_t squeezed_by) {
    for (uint32_t i = 0; i < doors->count; i++) {
        Door *door = &doors->doors[i];
        if (door->mover == squeezed_by) {
            toggle(doors, door);
        }
        close_in_time(doors, door, feet_ws);
    }
    set_portals(doors);
}

uint64_t doors_hash(const Doors *doors) {
    uint64_t hash = ENF_HASH_START;
    for (uint32_t i = 0; i < doors->count; i++) {
        const EnfSwingMotion *swing = &doors->doors[i].motion.as.swing;
        hash = enf_hash64(hash, &swing->from, sizeof swing->from);
        hash = enf_hash64(hash, &swing->target, sizeof swing->target);
        hash = enf_hash64(hash, &swing->event_tick, sizeof swing->event_tick);
        hash = enf_hash64(hash, &doors->doors[i].close_tick, sizeof doors->doors[i].close_tick);
    }
    return hash;
}
