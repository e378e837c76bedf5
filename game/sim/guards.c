/* Guards. On its round a guard is a path and costs nothing that nobody looks at; what it notices makes it stop, go and look, chase,
 * search, and come back to where its round is at that moment nearest. */
#include "sim/sim.h"

#include <math.h>
#include <string.h>

enum { LOOK_EVERY = 4, ROUTE_EVERY = 20, WONDER_TICKS = 150, SEARCH_TICKS = 480, WHISTLE_EVERY = 200 };
/* Ticks from the start in which nobody is seen: one comes in by the door and looks about. */
enum { GRACE_TICKS = 5 * ENF_TICK_RATE };
#define EYE_HEIGHT 1.65
#define CHASE_SPEED 3.6
#define RETURN_SPEED 1.4
#define CATCH_DISTANCE 0.95
#define TURN_RATE 200.0 /* degrees a second */
#define NOTICE_RATE 1.0 /* a second, of somebody fully seen nearby */
#define NOTICE_FADES 0.12
#define HEARD_MOST 0.6 /* what is only heard is looked for, not chased */
/* A step up is a leap of 0.4 m in one tick: no point of a guard is faster than that and its way. */
#define GUARD_SPEED_MAX 45.0

/* ---- start ------------------------------------------------------------------------------------------------------------ */

static void follow_pose(Game *game, SimGuard *guard) {
    EnfPose pose = enf_world_pose(game->world, guard->object.index);
    EnfVec3 eye = enf_v3(0.0, EYE_HEIGHT, 0.0), from = enf_add(guard->body.position, eye), to = enf_add(pose.position, eye);
    bool known = guard->body.cell != ENF_NONE && enf_length(enf_sub(to, from)) < 3.0;
    guard->body.cell = known ? enf_map_track(game->map, guard->body.cell, from, to) : enf_map_locate(game->map, to);
    guard->body.position = pose.position;
    guard->yaw_deg = sim_yaw(pose.rotation);
}

void sim_guards_start(Game *game) {
    game->guard_count = 0;
    for (uint32_t i = 0; i < game->map->movers_count; i++) {
        const EnfMover *mover = &game->map->movers[i];
        if (strcmp(enf_map_string(game->map, game->map->entities[mover->entity].classname), "npc_guard") != 0) {
            continue;
        }
        SimGuard *guard = &game->guards[game->guard_count++];
        memset(guard, 0, sizeof *guard);
        guard->object = enf_world_object(game->world, i);
        guard->mover = i;
        guard->start = sim_tick(game);
        guard->body.def = enf_character_def_default();
        guard->body.def.walk_speed = CHASE_SPEED;
        guard->body.height = guard->body.def.height;
        guard->body.object = guard->object.index;
        guard->body.cell = ENF_NONE;
        guard->body.position = enf_v3(0.0, -1e6, 0.0);
        enf_collider_set_solid(game->collider, guard->object.index, false);
        follow_pose(game, guard);
    }
}

/* ---- places -------------------------------------------------------------------------------------------------------------- */

static EnfVec3 eye_of(const SimGuard *guard) {
    return enf_add(guard->body.position, enf_v3(0.0, EYE_HEIGHT, 0.0));
}

static EnfPose pose_of(const SimGuard *guard) {
    EnfPose pose = enf_pose_identity();
    pose.position = guard->body.position;
    pose.rotation = enf_quat_axis_angle(enf_v3(0.0, 1.0, 0.0), guard->yaw_deg * (ENF_PI / 180.0));
    return pose;
}

/* From its round into its own hands: a body where the path has it. */
static void step_off(Game *game, SimGuard *guard) {
    if (guard->mood != GAME_GUARD_ROUND) {
        return;
    }
    EnfCharacterDef def = guard->body.def;
    double yaw = guard->yaw_deg;
    enf_character_spawn(&guard->body, game->collider, &def, guard->body.position);
    guard->body.object = guard->object.index;
    guard->yaw_deg = yaw;
}

/* The object is where the body is, from this tick on. Off its path, it walks from where it was. */
static void push_pose(Game *game, SimGuard *guard) {
    EnfPose pose = pose_of(guard);
    if (enf_world_push(game->world, guard->object, &pose)) {
        return;
    }
    EnfMotion motion;
    memset(&motion, 0, sizeof motion);
    motion.kind = ENF_MOTION_FREE;
    motion.as.free.max_speed = GUARD_SPEED_MAX;
    enf_free_push(&motion, sim_world_tick(game), pose);
    enf_world_set_motion(game->world, guard->object, &motion);
}

/* ---- the round ------------------------------------------------------------------------------------------------------------ */

/* The tick of the round at which it comes nearest to a place, of one a third of a second. */
static int64_t nearest_of_round(const Game *game, const EnfMotion *motion, EnfVec3 at, EnfVec3 *place) {
    int64_t best = 0, period = (int64_t)motion->as.path.period_ticks;
    double nearest = HUGE_VAL;
    (void)game;
    for (int64_t tick = 0; tick < period; tick += ENF_TICK_RATE / 3) {
        EnfPose pose = enf_motion_state(motion, motion->as.path.start_tick + tick);
        double away = enf_length(enf_sub(pose.position, at));
        if (away < nearest) {
            nearest = away;
            best = tick;
            *place = pose.position;
        }
    }
    return best;
}

static EnfMotion round_motion(const Game *game, const SimGuard *guard) {
    EnfMotion motion = enf_mover_def(game->map, guard->mover).motion;
    if (motion.kind == ENF_MOTION_PATH) {
        motion.as.path.start_tick += game->begin + guard->start;
    }
    return motion;
}

/* Back on its path, which goes on from the place that it has come to. */
static void resume(Game *game, SimGuard *guard) {
    EnfMotion motion = round_motion(game, guard);
    if (motion.kind == ENF_MOTION_PATH) {
        EnfVec3 place;
        int64_t at = nearest_of_round(game, &motion, guard->body.position, &place);
        int64_t begin = motion.as.path.start_tick - guard->start;
        motion.as.path.start_tick = sim_world_tick(game) - at;
        guard->start = motion.as.path.start_tick - begin;
    }
    enf_world_set_motion(game->world, guard->object, &motion);
    guard->mood = GAME_GUARD_ROUND;
    guard->notice = 0.0;
}

/* ---- going ------------------------------------------------------------------------------------------------------------------ */

static void turn_to(SimGuard *guard, EnfVec3 to) {
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

/* One tick on foot towards the next point of the route (or straight, without one). True when the end is reached. */
static bool go(Game *game, SimGuard *guard, EnfVec3 to, uint32_t to_cell, double speed) {
    int64_t tick = sim_tick(game);
    if (guard->route_count == 0 || tick - guard->route_at >= ROUTE_EVERY) {
        guard->route_count = sim_route(game, guard->body.position, sim_feet_cell(game, &guard->body), to, to_cell,
                                       guard->route);
        guard->route_at = tick;
        if (guard->route_count == 0) {
            guard->route[0] = to;
            guard->route_count = 1;
        }
    }
    EnfVec3 way = enf_sub(guard->route[0], guard->body.position);
    double flat = sqrt(way.x * way.x + way.z * way.z);
    if (flat < 0.35) {
        if (guard->route_count == 1) {
            return true;
        }
        guard->route_count--;
        memmove(guard->route, guard->route + 1, guard->route_count * sizeof *guard->route);
        way = enf_sub(guard->route[0], guard->body.position);
        flat = sqrt(way.x * way.x + way.z * way.z);
    }
    turn_to(guard, guard->route[0]);
    EnfCharacterInput input = {enf_v3(0.0, 0.0, 0.0), false, false, false, ENF_CHARACTER_WALK};
    if (flat > 0.0) {
        input.wish = enf_scale(enf_v3(way.x, 0.0, way.z), speed / CHASE_SPEED / flat);
    }
    EnfCharacterReport report;
    EnfVec3 before = guard->body.position;
    enf_character_move(&guard->body, game->collider, &input, &report);
    if (report.moved & ENF_MOVED_BLOCKED) {
        uint32_t door = sim_door_near(game, eye_of(guard), enf_v3(0.0, 0.0, 0.0), 1.6);
        if (door != ENF_NONE) {
            sim_door_open(game, door, true);
        }
    }
    EnfVec3 moved = enf_sub(guard->body.position, before);
    guard->stride += sqrt(moved.x * moved.x + moved.z * moved.z);
    if (guard->stride > 0.9) {
        guard->stride = 0.0;
        sim_sound(game, GAME_SOUND_GUARD_STEP, guard->body.position, 0.5);
    }
    return false;
}

/* ---- minds -------------------------------------------------------------------------------------------------------------------- */

static void wonder(Game *game, SimGuard *guard) {
    step_off(game, guard);
    guard->mood = GAME_GUARD_WONDERS;
    guard->until = sim_tick(game) + WONDER_TICKS;
    guard->route_count = 0;
    sim_sound(game, GAME_SOUND_GUARD_WONDERS, eye_of(guard), 0.7);
}

static void chase(Game *game, SimGuard *guard) {
    if (guard->mood != GAME_GUARD_CHASES) {
        step_off(game, guard);
        guard->mood = GAME_GUARD_CHASES;
        guard->route_count = 0;
        sim_sound(game, GAME_SOUND_GUARD_SEES, eye_of(guard), 1.0);
        sim_say(game, "A guard has seen you");
    }
    guard->until = sim_tick(game) + SEARCH_TICKS;
}

void sim_guards_hear(Game *game, EnfVec3 at, double metres) {
    if (game->def.peaceful) {
        return;
    }
    bool found = false;
    for (uint32_t i = 0; i < game->guard_count; i++) {
        SimGuard *guard = &game->guards[i];
        uint32_t last;
        if (enf_length(enf_sub(guard->body.position, at)) > metres) {
            continue;
        }
        if (!found) { /* once, and only if somebody is near enough to hear it straight */
            sim_ways_find(game, &game->ears, at, game->player.body.cell, metres);
            game->ears_ready = false;
            found = true;
        }
        double way = sim_ways_to(game, &game->ears, guard->body.position, guard->body.cell, &last);
        if (way < metres && guard->mood != GAME_GUARD_CHASES) {
            guard->last_seen = at;
            guard->notice = fmax(guard->notice, fmin(HEARD_MOST, guard->notice + 0.25 * (1.0 - way / metres)));
            if (guard->notice > 0.35 && (guard->mood == GAME_GUARD_ROUND || guard->mood == GAME_GUARD_RETURNS)) {
                wonder(game, guard);
            }
        }
    }
}

/* Looks, every few ticks, guards by turns; what it sees adds up, and fades. */
static void look(Game *game, SimGuard *guard, uint32_t number) {
    const double step = (double)LOOK_EVERY / ENF_TICK_RATE;
    if ((sim_tick(game) + number) % LOOK_EVERY != 0 || game->def.peaceful) {
        return;
    }
    double sight = sim_tick(game) < GRACE_TICKS ? 0.0 : sim_sight(game, guard, eye_of(guard), sim_look(guard->yaw_deg, 0.0));
    bool crouched = (game->player.body.flags & ENF_CHARACTER_CROUCHED) != 0;
    sight *= crouched ? 0.6 : 1.0;
    guard->sees = sight > 0.01;
    guard->notice += guard->sees ? NOTICE_RATE * sight * step : -NOTICE_FADES * step;
    guard->notice = fmin(1.0, fmax(0.0, guard->notice));
    if (guard->sees) {
        guard->last_seen = game->player.body.position;
    }
    if (guard->notice >= 1.0 || (guard->sees && guard->mood == GAME_GUARD_CHASES)) {
        chase(game, guard);
    } else if (guard->notice > 0.4 && (guard->mood == GAME_GUARD_ROUND || guard->mood == GAME_GUARD_RETURNS)) {
        wonder(game, guard);
    }
}

static void go_back(Game *game, SimGuard *guard) {
    sim_sound(game, GAME_SOUND_GUARD_GIVES_UP, eye_of(guard), 0.7);
    guard->mood = GAME_GUARD_RETURNS;
    guard->route_count = 0;
}

static void return_home(Game *game, SimGuard *guard) {
    EnfMotion motion = round_motion(game, guard);
    EnfVec3 place = guard->body.position;
    if (motion.kind == ENF_MOTION_PATH) {
        nearest_of_round(game, &motion, guard->body.position, &place);
    }
    uint32_t cell = enf_map_locate(game->map, enf_add(place, enf_v3(0.0, 1.0, 0.0)));
    if (go(game, guard, place, cell, RETURN_SPEED) || sim_tick(game) > guard->until + 4 * SEARCH_TICKS) {
        resume(game, guard);
    }
}

/* Who chases and sees whistles now and then: it can be heard where the chase is. */
static void whistle(Game *game, const SimGuard *guard, uint32_t number) {
    bool calls = guard->mood == GAME_GUARD_CHASES && guard->sees;
    if (calls && (sim_tick(game) + 50 * (int64_t)number) % WHISTLE_EVERY == 0) {
        sim_sound(game, GAME_SOUND_GUARD_WHISTLES, eye_of(guard), 0.9);
    }
}

static void act(Game *game, SimGuard *guard) {
    int64_t tick = sim_tick(game);
    uint32_t cell = sim_feet_cell(game, &game->player.body);
    switch ((GameGuardMood)guard->mood) {
    case GAME_GUARD_ROUND:
        follow_pose(game, guard);
        return;
    case GAME_GUARD_WONDERS:
        turn_to(guard, guard->last_seen);
        if (tick >= guard->until) {
            guard->mood = guard->notice > 0.3 ? GAME_GUARD_SEARCHES : GAME_GUARD_RETURNS;
            guard->until = tick + SEARCH_TICKS;
            guard->route_count = 0;
        }
        break;
    case GAME_GUARD_CHASES:
        if (go(game, guard, guard->last_seen,
               guard->sees ? cell : enf_map_locate(game->map, enf_add(guard->last_seen, enf_v3(0.0, 1.0, 0.0))), CHASE_SPEED) &&
            !guard->sees) {
            guard->mood = GAME_GUARD_SEARCHES;
            guard->route_count = 0;
        }
        if (tick >= guard->until) {
            go_back(game, guard);
        }
        break;
    case GAME_GUARD_SEARCHES:
        if (go(game, guard, guard->last_seen, enf_map_locate(game->map, enf_add(guard->last_seen, enf_v3(0.0, 1.0, 0.0))),
               0.7 * CHASE_SPEED)) {
            guard->yaw_deg += TURN_RATE / 3.0 / ENF_TICK_RATE;
        }
        if (tick >= guard->until) {
            go_back(game, guard);
        }
        break;
    default:
        return_home(game, guard);
        break;
    }
    if (guard->mood != GAME_GUARD_ROUND) {
        push_pose(game, guard);
    }
}

/* At arm's length of a guard who chases and sees: the night is over. */
static void catch_player(Game *game, const SimGuard *guard) {
    EnfVec3 way = enf_sub(game->player.body.position, guard->body.position);
    bool near = sqrt(way.x * way.x + way.z * way.z) < CATCH_DISTANCE && fabs(way.y) < 1.2;
    if (near && guard->sees && guard->mood == GAME_GUARD_CHASES && game->score.phase == GAME_PLAYING) {
        game->score.phase = GAME_LOST;
        sim_sound(game, GAME_SOUND_CAUGHT, eye_of(guard), 1.0);
        sim_sound(game, GAME_SOUND_LOST, game->player.body.position, 1.0);
        sim_say(game, "Caught");
    }
}

void sim_guards_step(Game *game) {
    for (uint32_t i = 0; i < game->guard_count; i++) {
        SimGuard *guard = &game->guards[i];
        act(game, guard);
        look(game, guard, i);
        whistle(game, guard, i);
        catch_player(game, guard);
    }
}
