/* Doors, elevators, and the portals that doors close. A portal is open as soon as a leaf leaves its frame, and closed once all its
 * leaves stand in theirs: closing stops sight, never the other way around (PITFALLS 10, 24). */
#include "sim/sim.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define AUTO_CLOSE_SECONDS 4.0
enum { TURN_BACK_TICKS = ENF_TICK_RATE / 2 };

static bool class_is(const Game *game, const EnfMover *mover, const char *name) {
    return strcmp(enf_map_string(game->map, game->map->entities[mover->entity].classname), name) == 0;
}

static const char *extras_of(const Game *game, const EnfMover *mover) {
    return enf_map_string(game->map, game->map->entities[mover->entity].extras);
}

static uint64_t name_in(const Game *game, const EnfMover *mover, const char *key) {
    char text[SIM_KEY_SIZE * 2];
    sim_extra(extras_of(game, mover), key, text, sizeof text);
    return sim_name(text);
}

/* ---- doors ------------------------------------------------------------------------------------------------------------ */

static EnfVec3 door_place(const Game *game, const SimDoor *door) {
    EnfBox3f box = enf_world_box(game->world, door->object.index);
    return enf_v3(0.5 * ((double)box.min.x + (double)box.max.x), 0.5 * ((double)box.min.y + (double)box.max.y),
                  0.5 * ((double)box.min.z + (double)box.max.z));
}

static void add_door(Game *game, uint32_t index) {
    const EnfMover *mover = &game->map->movers[index];
    SimDoor *door = &game->doors[game->door_count++];
    memset(door, 0, sizeof *door);
    door->object = enf_world_object(game->world, index);
    door->mover = index;
    door->portal = mover->portal;
    door->name = name_in(game, mover, "targetname");
    door->open = (double)(-mover->low > mover->high ? mover->low : mover->high);
    door->locked = (mover->flags & ENF_MOVER_LOCKED) != 0;
    door->key = door->locked ? name_in(game, mover, "locked") : 0;
    door->shut_at = INT64_MAX;
    door->turned = INT64_MIN / 2;
    door->cell = door->portal != ENF_NONE ? game->map->portals[door->portal].source
                                          : enf_map_locate(game->map, door_place(game, door));
    double seconds = sim_extra_number(extras_of(game, mover), "auto_close", AUTO_CLOSE_SECONDS);
    door->stays = seconds > 0.0 && seconds < 1e6 ? llrint(seconds * ENF_TICK_RATE) : 0;
    if (door->portal != ENF_NONE) {
        enf_portals_set_open(&game->portals, door->portal, false);
    }
}

void sim_doors_start(Game *game) {
    game->door_count = 0;
    for (uint32_t i = 0; i < game->portals.count; i++) {
        enf_portals_set_open(&game->portals, i, !(game->map->portals[i].flags & ENF_PORTAL_CLOSED));
    }
    for (uint32_t i = 0; i < game->map->movers_count; i++) {
        const EnfMover *mover = &game->map->movers[i];
        bool swings = mover->kind == ENF_MOVER_HINGE || mover->kind == ENF_MOVER_SLIDE;
        if (swings && (class_is(game, mover, "func_door") || class_is(game, mover, "func_door_rotating"))) {
            add_door(game, i);
        }
    }
}

/* Sends one leaf; its portal opens with it. */
static void send(Game *game, SimDoor *door, double wanted) {
    if (door->wanted == wanted) {
        return;
    }
    bool shuts = wanted == 0.0;
    if (!door->moving && !shuts) {
        bool slides = game->map->movers[door->mover].kind == ENF_MOVER_SLIDE;
        sim_sound(game, slides ? GAME_SOUND_DOOR_SLIDES : GAME_SOUND_DOOR_OPEN, door_place(game, door), door->cell, 0.8);
    }
    door->wanted = wanted;
    door->moving = 1;
    enf_world_swing(game->world, door->object, wanted);
    if (door->portal != ENF_NONE) {
        enf_portals_set_open(&game->portals, door->portal, true);
    }
}

/* A leaf that can swing both ways goes away from whom opens it: nobody is caught between it and a wall. */
static void turn_away(const Game *game, SimDoor *leaf, EnfVec3 from) {
    const EnfMover *mover = &game->map->movers[leaf->mover];
    bool rests = leaf->wanted == 0.0 && !leaf->moving;
    if (!rests || mover->kind != ENF_MOVER_HINGE || !(mover->low < 0.0f && mover->high > 0.0f)) {
        return;
    }
    EnfVec3 hinge = enf_v3(mover->pivot[0], mover->pivot[1], mover->pivot[2]);
    EnfVec3 axis = enf_v3((double)mover->axis[0], (double)mover->axis[1], (double)mover->axis[2]);
    EnfVec3 ahead = enf_cross(axis, enf_sub(door_place(game, leaf), hinge)); /* where a positive angle takes it */
    leaf->open = (double)(enf_dot(ahead, enf_sub(from, hinge)) > 0.0 ? mover->low : mover->high);
}

bool sim_door_open(Game *game, uint32_t index, bool keys, const EnfVec3 *from) {
    SimDoor *door = &game->doors[index];
    if (door->locked && !keys && !(door->key && sim_has_key(game, door->key))) {
        sim_sound(game, GAME_SOUND_DOOR_LOCKED, door_place(game, door), door->cell, 0.6);
        return false;
    }
    if (door->locked && door->wanted != door->open) { /* once, not at every push of a guard against it */
        sim_sound(game, GAME_SOUND_DOOR_UNLOCKED, door_place(game, door), door->cell, 0.5);
    }
    for (uint32_t i = 0; i < game->door_count; i++) {
        SimDoor *leaf = &game->doors[i];
        bool together = i == index || (door->name && leaf->name == door->name) ||
                        (door->portal != ENF_NONE && leaf->portal == door->portal);
        if (together) {
            leaf->locked = keys ? leaf->locked : 0;
            leaf->shut_at = leaf->stays ? sim_tick(game) + leaf->stays : INT64_MAX;
            if (from) {
                turn_away(game, leaf, *from);
            }
            send(game, leaf, leaf->open);
        }
    }
    return true;
}

uint32_t sim_door_near(const Game *game, EnfVec3 at, EnfVec3 look, double reach) {
    uint32_t best = ENF_NONE;
    double nearest = reach;
    for (uint32_t i = 0; i < game->door_count; i++) {
        EnfBox3f box = enf_world_box(game->world, game->doors[i].object.index);
        EnfVec3 p = enf_v3(fmin(fmax(at.x, (double)box.min.x), (double)box.max.x),
                           fmin(fmax(at.y, (double)box.min.y), (double)box.max.y),
                           fmin(fmax(at.z, (double)box.min.z), (double)box.max.z));
        EnfVec3 way = enf_sub(p, at);
        double away = enf_length(way);
        /* In the plan alone: who stands at a door and looks at its handle looks down more than ahead. */
        bool ahead = way.x * look.x + way.z * look.z >=
                     0.5 * sqrt((way.x * way.x + way.z * way.z) * (look.x * look.x + look.z * look.z));
        if (away < nearest && ahead) {
            nearest = away;
            best = i;
        }
    }
    return best;
}

/* Does the segment meet the box, widened? (Slabs.) */
static bool crosses(EnfBox3f box, EnfVec3 from, EnfVec3 to, double margin) {
    const double a[3] = {from.x, from.y, from.z}, b[3] = {to.x, to.y, to.z};
    const double low[3] = {(double)box.min.x, (double)box.min.y, (double)box.min.z};
    const double high[3] = {(double)box.max.x, (double)box.max.y, (double)box.max.z};
    double t0 = 0.0, t1 = 1.0;
    for (int i = 0; i < 3; i++) {
        double d = b[i] - a[i], l = low[i] - margin - a[i], h = high[i] + margin - a[i];
        if (fabs(d) < 1e-9) {
            if (l > 0.0 || h < 0.0) {
                return false;
            }
            continue;
        }
        t0 = fmax(t0, fmin(l / d, h / d));
        t1 = fmin(t1, fmax(l / d, h / d));
    }
    return t0 <= t1;
}

uint32_t sim_door_between(const Game *game, EnfVec3 from, EnfVec3 to) {
    EnfVec3 up = enf_v3(0.0, 1.0, 0.0);
    for (uint32_t i = 0; i < game->door_count; i++) {
        const SimDoor *door = &game->doors[i];
        if ((door->wanted == 0.0 || door->moving) &&
            crosses(enf_world_box(game->world, door->object.index), enf_add(from, up), enf_add(to, up), 0.2)) {
            return i;
        }
    }
    return ENF_NONE;
}

/* Is somebody where the leaf would go? */
static bool in_the_way(const Game *game, const SimDoor *door) {
    EnfBox3f box = enf_world_box(game->world, door->object.index);
    EnfVec3 middle = door_place(game, door);
    double reach = 0.5 * fmax((double)box.max.x - (double)box.min.x, (double)box.max.z - (double)box.min.z) + 0.9;
    EnfVec3 way = enf_sub(game->player.body.position, middle);
    if (fabs(way.y) < 2.5 && way.x * way.x + way.z * way.z < reach * reach) {
        return true;
    }
    for (uint32_t g = 0; g < game->guard_count; g++) {
        way = enf_sub(game->guards[g].body.position, middle);
        if (fabs(way.y) < 2.5 && way.x * way.x + way.z * way.z < reach * reach) {
            return true;
        }
    }
    return false;
}

static bool all_shut(const Game *game, uint32_t portal) {
    for (uint32_t i = 0; i < game->door_count; i++) {
        if (game->doors[i].portal == portal && game->doors[i].moving) {
            return false;
        }
        if (game->doors[i].portal == portal && game->doors[i].wanted != 0.0) {
            return false;
        }
    }
    return true;
}

/* A leaf that was opening shuts again, one that was shutting opens; and with it the leaves of its name. */
static void turn_door_back(Game *game, const SimDoor *met) {
    double wanted = met->wanted == 0.0 ? 1.0 : 0.0;
    int64_t tick = sim_tick(game);
    uint64_t name = met->name;
    uint32_t portal = met->portal;
    for (uint32_t i = 0; i < game->door_count; i++) {
        SimDoor *leaf = &game->doors[i];
        if (leaf == met || (name && leaf->name == name) || (portal != ENF_NONE && leaf->portal == portal)) {
            leaf->turned = tick;
            leaf->shut_at = wanted != 0.0 && leaf->stays ? tick + leaf->stays : INT64_MAX;
            send(game, leaf, wanted * leaf->open);
        }
    }
}

static void turn_lift_back(Game *game, SimLift *lift) {
    uint32_t from = lift->from;
    lift->turned = sim_tick(game);
    lift->from = lift->stop;
    lift->stop = from;
    enf_world_swing(game->world, lift->object, lift->stops[from]);
}

/* At most once in a while: somebody wedged on both sides is not shaken. */
void sim_turn_back(Game *game, uint32_t object) {
    int64_t tick = sim_tick(game);
    for (uint32_t i = 0; i < game->door_count; i++) {
        SimDoor *door = &game->doors[i];
        if (door->object.index == object && door->moving && tick - door->turned >= TURN_BACK_TICKS) {
            turn_door_back(game, door);
        }
    }
    for (uint32_t i = 0; i < game->lift_count; i++) {
        SimLift *lift = &game->lifts[i];
        if (lift->object.index == object && lift->moving && tick - lift->turned >= TURN_BACK_TICKS) {
            turn_lift_back(game, lift);
        }
    }
}

static double position_of(const Game *game, EnfObjectId id) {
    const EnfMotion *motion = enf_world_motion(game->world, id.index);
    return enf_swing_position(motion, sim_world_tick(game));
}

void sim_doors_step(Game *game) {
    int64_t tick = sim_tick(game);
    for (uint32_t i = 0; i < game->door_count; i++) {
        SimDoor *door = &game->doors[i];
        if (tick >= door->shut_at) {
            if (in_the_way(game, door)) {
                door->shut_at = tick + ENF_TICK_RATE / 2;
            } else {
                door->shut_at = INT64_MAX;
                send(game, door, 0.0);
            }
        }
        if (door->moving && position_of(game, door->object) == door->wanted && door->moving++ > 1) {
            /* One tick at rest: the picture between two ticks still saw it gape. */
            door->moving = 0;
            if (door->wanted == 0.0) {
                sim_sound(game, GAME_SOUND_DOOR_SHUT, door_place(game, door), door->cell, 0.7);
                if (door->portal != ENF_NONE && all_shut(game, door->portal)) {
                    enf_portals_set_open(&game->portals, door->portal, false);
                }
            }
        }
    }
}

/* ---- elevators ----------------------------------------------------------------------------------------------------------- */

static uint32_t read_stops(const char *extras, double out[SIM_STOPS_MAX]) {
    char text[256];
    uint32_t count = 0;
    sim_extra(extras, "stops", text, sizeof text);
    for (const char *at = text; *at && count < SIM_STOPS_MAX;) {
        char wrapped[64];
        size_t length = strcspn(at, ",] ");
        if (length > 0 && length < sizeof wrapped - 8 && at[0] != '[') {
            snprintf(wrapped, sizeof wrapped, "{\"v\":%.*s}", (int)length, at);
            out[count++] = sim_extra_number(wrapped, "v", 0.0);
        }
        at += length + (at[length] != '\0');
        at += *at == '[';
    }
    return count;
}

void sim_lifts_start(Game *game) {
    game->lift_count = game->button_count = 0;
    for (uint32_t i = 0; i < game->map->movers_count; i++) {
        const EnfMover *mover = &game->map->movers[i];
        if (mover->kind == ENF_MOVER_SLIDE && class_is(game, mover, "func_plat")) {
            SimLift *lift = &game->lifts[game->lift_count++];
            memset(lift, 0, sizeof *lift);
            lift->object = enf_world_object(game->world, i);
            lift->mover = i;
            lift->name = name_in(game, mover, "targetname");
            lift->stop_count = read_stops(extras_of(game, mover), lift->stops);
            lift->turned = INT64_MIN / 2;
            lift->start = enf_add(enf_world_pose(game->world, i).position, enf_v3(0.0, 0.3, 0.0));
            lift->cell = enf_map_locate(game->map, lift->start);
        } else if (class_is(game, mover, "func_button")) {
            SimButton *button = &game->buttons[game->button_count++];
            memset(button, 0, sizeof *button);
            button->object = i;
            button->target = name_in(game, mover, "target");
            double stop = sim_extra_number(extras_of(game, mover), "stop", -1.0);
            button->stop = stop >= 0.0 && stop < SIM_STOPS_MAX ? (uint32_t)stop : ENF_NONE;
        }
    }
}

/* The platform's place and cell, for ears. */
static void sound_of_lift(Game *game, const SimLift *lift, GameSoundKind kind, double loudness) {
    EnfVec3 at = enf_world_pose(game->world, lift->object.index).position;
    EnfVec3 above = enf_add(at, enf_v3(0.0, 0.3, 0.0));
    sim_sound(game, kind, at, enf_map_track(game->map, lift->cell, lift->start, above), loudness);
}

void sim_lift_call(Game *game, uint64_t name, uint32_t stop) {
    for (uint32_t i = 0; i < game->lift_count; i++) {
        SimLift *lift = &game->lifts[i];
        if (lift->name != name || lift->stop_count == 0) {
            continue;
        }
        uint32_t to = (stop == ENF_NONE ? lift->stop + 1 : stop) % lift->stop_count;
        if (to != lift->stop) {
            lift->from = lift->stop;
            lift->stop = to;
            lift->moving = 1;
            enf_world_swing(game->world, lift->object, lift->stops[to]);
            sound_of_lift(game, lift, GAME_SOUND_LIFT, 0.8);
        }
    }
}

void sim_lifts_step(Game *game) {
    for (uint32_t i = 0; i < game->lift_count; i++) {
        SimLift *lift = &game->lifts[i];
        const EnfMotion *motion = enf_world_motion(game->world, lift->object.index);
        if (lift->moving && enf_swing_position(motion, sim_world_tick(game)) == motion->as.swing.target) {
            lift->moving = 0;
            sound_of_lift(game, lift, GAME_SOUND_LIFT_STOPS, 0.6);
            sound_of_lift(game, lift, GAME_SOUND_LIFT_RINGS, 0.5);
        }
    }
}
