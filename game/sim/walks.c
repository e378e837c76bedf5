/* Guards on foot, off their rounds: a way through the portal graph, and where its next stop is not reached by going straight (round
 * furniture, up a winding stair) a track of footholds, searched a few a tick. Who comes no nearer searches again, then tries another
 * way, then says that it leads nowhere. */
#include "sim/sim.h"

#include <math.h>
#include <string.h>

enum { WAY_EVERY = 20, LOOK_AHEAD_EVERY = 16, STILL_TICKS = 24, TRIES = 3, SHUNS = 3, DOOR_TICKS = 90 };
/* Footholds settled in a tick, some 20 sweeps each; of one search. */
enum { PLACES_A_TICK = 3, PLACES = 2500 };
#define WALK_SPEED 3.4  /* what a wish of 1 is */
#define TURN_RATE 200.0 /* degrees a second */
#define STOP_NEAR 0.35
#define FOOT_NEAR 0.13
#define STRAIGHT 12.0 /* metres of a way that are tried beforehand */
#define DOOR_AHEAD 1.8
/* A track to a stop is no longer than so many times the straight line, and so many metres. */
#define DETOUR 3.0
#define DETOUR_MORE 12.0
#define LEVEL 0.5 /* metres of height within which a stop is reached */

static double flat(EnfVec3 a, EnfVec3 b) {
    double x = a.x - b.x, z = a.z - b.z;
    return sqrt(x * x + z * z);
}

void sim_turn_to(SimGuard *guard, EnfVec3 to) {
    EnfVec3 way = enf_sub(to, guard->body.position);
    if (way.x * way.x + way.z * way.z < 1e-4) {
        return;
    }
    double wanted = enf_atan2(-way.x, -way.z) * (180.0 / ENF_PI), turn = wanted - guard->yaw_deg;
    turn -= 360.0 * floor((turn + 180.0) / 360.0);
    double most = TURN_RATE / ENF_TICK_RATE;
    guard->yaw_deg += turn > most ? most : turn < -most ? -most : turn;
    guard->yaw_deg -= 360.0 * floor((guard->yaw_deg + 180.0) / 360.0);
}

void sim_walk_start(SimGuard *guard) {
    memset(&guard->walk, 0, sizeof guard->walk);
    guard->walk.shun = ENF_NONE;
    guard->walk.nearest = HUGE_VAL;
}

/* ---- the way -------------------------------------------------------------------------------------------------------- */

/* Heads for the next stop: straight, if that can be walked. */
static void head_for_stop(Game *game, SimGuard *guard) {
    SimWalk *walk = &guard->walk;
    walk->track_count = walk->track_next = walk->still = 0;
    walk->nearest = HUGE_VAL;
    walk->wants = !walk->lost && !sim_foot_straight(game->collider, &guard->body, walk->way.at[walk->way.next], STRAIGHT);
}

/* A new way. Who stands in a doorway already does not go back to the point before it. */
static void find_way(Game *game, SimGuard *guard, const SimErrand *errand) {
    SimWalk *walk = &guard->walk;
    SimWay *way = &walk->way;
    SimErrand asked = *errand;
    asked.shun = walk->shun;
    walk->lost = !sim_route(game, &asked, way);
    if (walk->lost) { /* straight, and no search for a place that may be nowhere */
        way->at[0] = errand->to;
        way->gate[0] = ENF_NONE;
        way->count = 1;
    }
    bool twice = way->count > 2 && way->gate[0] == way->gate[1];
    if (twice && flat(guard->body.position, way->at[1]) < flat(way->at[0], way->at[1])) {
        way->next = 1;
    }
    walk->way_at = sim_tick(game);
    walk->to = errand->to;
    walk->to_cell = errand->to_cell;
    bool same = walk->track_count > 0 && enf_length(enf_sub(walk->track_to, way->at[way->next])) < 1.0;
    if (!same) {
        head_for_stop(game, guard);
    }
}

/* What the errand is now: a goal that moves takes the end of the way with it, and in another cell needs another way. */
static void update_way(Game *game, SimGuard *guard, const SimErrand *errand) {
    SimWalk *walk = &guard->walk;
    int64_t tick = sim_tick(game);
    if (walk->way.count == 0 || (errand->to_cell != walk->to_cell && tick - walk->way_at >= WAY_EVERY)) {
        find_way(game, guard, errand);
    } else if (errand->to_cell == walk->to_cell) {
        walk->way.at[walk->way.count - 1] = errand->to;
        walk->to = errand->to;
    }
    bool last = walk->way.next + 1 == walk->way.count, moved = enf_length(enf_sub(walk->track_to, errand->to)) > 1.0;
    if (last && moved && tick % LOOK_AHEAD_EVERY == 0 && !walk->wants &&
        !walk->lost) { /* until there is another, the old track will do */
        walk->wants = !sim_foot_straight(game->collider, &guard->body, errand->to, STRAIGHT);
        walk->track_count = walk->wants ? walk->track_count : 0;
        walk->track_to = errand->to;
    }
}

/* ---- a step --------------------------------------------------------------------------------------------------------- */

/* Past the footholds that are reached. */
static EnfVec3 next_place(SimWalk *walk, EnfVec3 feet) {
    uint32_t end = walk->track_next + 4 < walk->track_count ? walk->track_next + 4 : walk->track_count;
    for (uint32_t i = walk->track_next; i < end; i++) {
        if (flat(walk->track[i], feet) < FOOT_NEAR) {
            walk->track_next = i + 1;
            walk->nearest = HUGE_VAL;
        }
    }
    return walk->track_next < walk->track_count ? walk->track[walk->track_next] : walk->way.at[walk->way.next];
}

/* Opens a door on the way; true if it is still opening and near. */
static bool waits_for_door(Game *game, const SimGuard *guard, EnfVec3 to) {
    EnfVec3 feet = guard->body.position, way = enf_sub(to, feet);
    double away = flat(to, feet);
    EnfVec3 end = away > DOOR_AHEAD ? enf_add(feet, enf_scale(way, DOOR_AHEAD / away)) : to;
    uint32_t index = sim_door_between(game, feet, end);
    if (index == ENF_NONE) {
        return false;
    }
    const SimDoor *door = &game->doors[index];
    if (door->wanted == 0.0) {
        sim_door_open(game, index, true, &feet);
    }
    return door->moving != 0;
}

static void step_towards(Game *game, SimGuard *guard, EnfVec3 to, double speed) {
    EnfCharacterInput input = {enf_v3(0.0, 0.0, 0.0), false, false, false, ENF_CHARACTER_WALK};
    EnfVec3 before = guard->body.position, way = enf_sub(to, before);
    double away = flat(to, before);
    if (away > 0.0) {
        input.wish = enf_scale(enf_v3(way.x, 0.0, way.z), fmin(speed, away * ENF_TICK_RATE) / WALK_SPEED / away);
    }
    EnfCharacterReport report;
    enf_character_move(&guard->body, game->collider, &input, &report);
    if (report.moved & ENF_MOVED_SQUEEZED) {
        sim_turn_back(game, report.squeezed_by);
    }
    guard->stride += flat(guard->body.position, before);
    if (guard->stride > 0.9) {
        guard->stride = 0.0;
        sim_sound(game, GAME_SOUND_GUARD_STEP, guard->body.position, guard->body.cell, 0.5);
    }
}

/* ---- getting on ----------------------------------------------------------------------------------------------------- */

/* This stop is not to be had from here: another way round, if there is one. */
static SimGoNews give_up_stop(SimWalk *walk) {
    uint32_t gate = walk->way.gate[walk->way.next];
    walk->tries = walk->track_count = walk->way.count = walk->wants = 0;
    if (gate != ENF_NONE && walk->shuns < SHUNS) {
        walk->shun = gate;
        walk->shuns++;
        return SIM_GO_ON;
    }
    walk->shun = ENF_NONE;
    walk->shuns = 0;
    return SIM_GO_NOWHERE;
}

/* After the step: does it come nearer to what it heads for? */
static SimGoNews watch(SimGuard *guard, EnfVec3 to) {
    SimWalk *walk = &guard->walk;
    double away = flat(to, guard->body.position);
    if (away < walk->nearest - 0.02) {
        walk->nearest = away;
        walk->still = 0;
        return SIM_GO_ON;
    }
    if (++walk->still < STILL_TICKS || walk->wants) {
        return SIM_GO_ON;
    }
    walk->still = walk->track_count = 0;
    walk->nearest = HUGE_VAL;
    walk->wants = !walk->lost;
    return ++walk->tries > TRIES ? give_up_stop(walk) : SIM_GO_ON;
}

/* At a stop: on to the next. */
static bool pass_stop(Game *game, SimGuard *guard) {
    SimWalk *walk = &guard->walk;
    if (walk->way.next + 1 == walk->way.count) {
        return true;
    }
    walk->way.next++;
    walk->tries = 0;
    head_for_stop(game, guard);
    return false;
}

/* While a search is on: straight on, as long as there is ground. */
static bool can_go_on(Game *game, const SimGuard *guard, EnfVec3 to) {
    return guard->walk.tries == 0 &&
           (guard->walk.track_next < guard->walk.track_count || sim_foot_straight(game->collider, &guard->body, to, 0.5));
}

SimGoNews sim_walk(Game *game, SimGuard *guard, const SimErrand *errand, double speed, double near) {
    SimWalk *walk = &guard->walk;
    update_way(game, guard, errand);
    EnfVec3 feet = guard->body.position, stop = walk->way.at[walk->way.next];
    bool last = walk->way.next + 1 == walk->way.count;
    bool level = fabs(stop.y - feet.y) < (last ? 1.2 : LEVEL);
    if (flat(stop, feet) < (last ? near : STOP_NEAR) && level && pass_stop(game, guard)) {
        step_towards(game, guard, feet, 0.0);
        return SIM_GO_THERE;
    }
    EnfVec3 to = next_place(walk, feet);
    bool stands = waits_for_door(game, guard, to);
    if (walk->door > 0 && !stands) {
        head_for_stop(game, guard);
    }
    walk->door = stands ? walk->door + 1 : 0;
    stands = stands && walk->door < DOOR_TICKS; /* somebody may stand behind it, so that it never opens */
    walk->wants = walk->wants && !stands;       /* what is to be searched is the way past the open leaf */
    stands = stands || (walk->wants && !can_go_on(game, guard, to));
    sim_turn_to(guard, to);
    step_towards(game, guard, stands ? feet : to, speed);
    return stands ? SIM_GO_ON : watch(guard, to);
}

/* ---- footholds ------------------------------------------------------------------------------------------------------ */

/* From the foothold nearest to where the guard has come meanwhile. */
static void take_track(Game *game, SimGuard *guard, bool leads) {
    SimWalk *walk = &guard->walk;
    const SimFoot *foot = &game->foot;
    double nearest = HUGE_VAL;
    walk->track_count = foot->path_count < SIM_TRACK_MAX ? foot->path_count : SIM_TRACK_MAX;
    for (uint32_t i = 0; i < walk->track_count; i++) {
        walk->track[i] = foot->path[i];
        double away = enf_length(enf_sub(walk->track[i], guard->body.position));
        if (away < nearest) {
            nearest = away;
            walk->track_next = i;
        }
    }
    walk->track_to = game->foot_to;
    walk->wants = 0;
    walk->still = 0;
    walk->nearest = HUGE_VAL;
    walk->tries += !leads && foot->path_count <= 2;
}

static void begin_search(Game *game, const SimGuard *guard, EnfVec3 stop) {
    EnfVec3 feet = guard->body.position;
    double farthest = DETOUR * enf_length(enf_sub(stop, feet)) + DETOUR_MORE;
    SimFootAsk ask = {feet, stop, 0.3, farthest, PLACES};
    sim_foot_begin(&game->foot, game->collider, &guard->body.def, &ask);
    game->foot_to = stop;
}

void sim_walk_search(Game *game) {
    if (game->foot_guard != ENF_NONE) {
        const SimGuard *guard = &game->guards[game->foot_guard];
        bool wanted = guard->mood != GAME_GUARD_ROUND && guard->mood != GAME_GUARD_WONDERS && guard->walk.wants &&
                      guard->walk.way.count > 0;
        bool same = wanted && enf_length(enf_sub(guard->walk.way.at[guard->walk.way.next], game->foot_to)) < 1.0;
        game->foot_guard = same ? game->foot_guard : ENF_NONE;
    }
    for (uint32_t i = 0; i < game->guard_count && game->foot_guard == ENF_NONE; i++) {
        SimGuard *guard = &game->guards[i];
        const SimWay *way = &guard->walk.way;
        if (guard->mood != GAME_GUARD_ROUND && guard->mood != GAME_GUARD_WONDERS && guard->walk.wants && way->count > 0) {
            game->foot_guard = i;
            begin_search(game, guard, way->at[way->next]);
        }
    }
    if (game->foot_guard == ENF_NONE) {
        return;
    }
    SimFootNews news = sim_foot_more(&game->foot, game->collider, PLACES_A_TICK);
    if (news != SIM_FOOT_GOES_ON) {
        take_track(game, &game->guards[game->foot_guard], news == SIM_FOOT_LEADS);
        game->foot_guard = ENF_NONE;
    }
}
