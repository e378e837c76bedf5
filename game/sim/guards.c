/* Guards. On its round a guard is a path and costs nothing that nobody looks at; what it notices makes it stop, go and look, chase,
 * search, and come back to where its round is nearest. */
#include "sim/sim.h"

#include <math.h>
#include <string.h>

enum { LOOK_EVERY = 4, WONDER_TICKS = 150, SEARCH_TICKS = 360, RETURN_TICKS = 1800, WHISTLE_EVERY = 200 };
/* Ticks in which it still knows where somebody went who is out of its sight: round the corner, through the door. */
enum { MEMORY_TICKS = 45 };
/* Ticks of looking round at a place. */
enum { ROUND_LOOK_TICKS = 150 };
/* Ticks from the start in which nobody is seen: one comes in by the door and looks about. */
enum { GRACE_TICKS = 5 * ENF_TICK_RATE };
#define CHASE_SPEED 3.4
#define SEARCH_SPEED 2.5
#define RETURN_SPEED 1.4
#define CATCH_DISTANCE 0.95
#define LOOK_ROUND_RATE 65.0 /* degrees a second */

/* ---- start ------------------------------------------------------------------------------------------------------------ */

void sim_guards_start(Game *game) {
    bool again = game->guard_count > 0; /* a restart: where each begins is known, and a dozen places need not be located */
    game->guard_count = 0;
    game->foot_guard = ENF_NONE;
    for (uint32_t i = 0; i < game->map->movers_count; i++) {
        const EnfMover *mover = &game->map->movers[i];
        if (strcmp(enf_map_string(game->map, game->map->entities[mover->entity].classname), "npc_guard") != 0) {
            continue;
        }
        SimGuard *guard = &game->guards[game->guard_count++];
        uint32_t cell = again ? guard->start_cell : ENF_NONE;
        memset(guard, 0, sizeof *guard);
        guard->object = enf_world_object(game->world, i);
        guard->mover = i;
        guard->start = sim_tick(game);
        guard->seen_at = INT64_MIN / 2;
        guard->last_cell = guard->home_cell = ENF_NONE;
        guard->body.def = enf_character_def_default();
        guard->body.def.walk_speed = CHASE_SPEED;
        guard->body.height = guard->body.def.height;
        guard->body.object = guard->object.index;
        guard->body.cell = cell;
        guard->body.position = enf_world_pose(game->world, guard->object.index).position;
        sim_walk_start(guard);
        enf_collider_set_solid(game->collider, guard->object.index, false);
        sim_guard_follow(game, guard);
        guard->start_cell = guard->body.cell;
    }
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

/* ---- minds -------------------------------------------------------------------------------------------------------------------- */

static void wonder(Game *game, SimGuard *guard) {
    step_off(game, guard);
    guard->mood = GAME_GUARD_WONDERS;
    guard->until = sim_tick(game) + WONDER_TICKS;
    sim_sound(game, GAME_SOUND_GUARD_WONDERS, sim_guard_eye(guard), guard->body.cell, 0.7);
}

void sim_guard_chase(Game *game, SimGuard *guard) {
    if (guard->mood != GAME_GUARD_CHASES) {
        step_off(game, guard);
        guard->mood = GAME_GUARD_CHASES;
        sim_walk_start(guard);
        sim_sound(game, GAME_SOUND_GUARD_SEES, sim_guard_eye(guard), guard->body.cell, 1.0);
        sim_say(game, "A guard has seen you");
    }
    guard->until = sim_tick(game) + SEARCH_TICKS;
}

/* It knows, or thinks, that he is there. */
static void think_of(SimGuard *guard, EnfVec3 at, uint32_t cell) {
    guard->last_seen = at;
    guard->last_cell = cell;
}

/* What it hears it goes to see; who runs from it is followed by ear. */
static void hear(Game *game, SimGuard *guard, EnfVec3 at, double loud) {
    if (guard->sees) {
        return;
    }
    think_of(guard, at, sim_feet_cell(game, &game->player.body));
    if (guard->mood == GAME_GUARD_CHASES || guard->mood == GAME_GUARD_SEARCHES) {
        bool chases = guard->mood == GAME_GUARD_CHASES; /* a search ends in its time, heard or not */
        guard->until = chases ? sim_tick(game) + SEARCH_TICKS : guard->until;
        guard->turned = 0;
        return;
    }
    guard->notice = fmax(guard->notice, fmin(SIM_NOTICE_HEARD_MOST, guard->notice + SIM_NOTICE_HEARD * loud));
    if (guard->notice > SIM_NOTICE_WONDERS && (guard->mood == GAME_GUARD_ROUND || guard->mood == GAME_GUARD_RETURNS)) {
        wonder(game, guard);
    }
}

void sim_guards_hear(Game *game, EnfVec3 at, double metres) {
    bool found = false;
    for (uint32_t i = 0; i < game->guard_count && !game->def.peaceful; i++) {
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
        if (way < metres) {
            hear(game, guard, at, 1.0 - way / metres);
        }
    }
}

/* Looks, every few ticks, guards by turns; what it sees adds up, and fades. */
static void look(Game *game, SimGuard *guard, uint32_t number) {
    const double step = (double)LOOK_EVERY / ENF_TICK_RATE;
    if ((sim_tick(game) + number) % LOOK_EVERY != 0 || game->def.peaceful) {
        return;
    }
    SimEye eye = {sim_guard_eye(guard), guard->yaw_deg, guard->body.cell};
    double sight = sim_tick(game) < GRACE_TICKS ? 0.0 : sim_sight(game, &eye, &game->player.body);
    bool crouched = (game->player.body.flags & ENF_CHARACTER_CROUCHED) != 0;
    sight *= crouched ? SIM_NOTICE_CROUCHED : 1.0;
    guard->sees = sight > 0.01;
    guard->notice += guard->sees ? SIM_NOTICE_RATE * sight * step : -SIM_NOTICE_FADES * step;
    guard->notice = fmin(1.0, fmax(0.0, guard->notice));
    if (guard->sees) {
        guard->seen_at = sim_tick(game);
        think_of(guard, game->player.body.position, sim_feet_cell(game, &game->player.body));
    }
    if (guard->notice >= 1.0 || (guard->sees && guard->mood == GAME_GUARD_CHASES)) {
        sim_guard_chase(game, guard);
    } else if (guard->notice > SIM_NOTICE_WONDERS && (guard->mood == GAME_GUARD_ROUND || guard->mood == GAME_GUARD_RETURNS)) {
        wonder(game, guard);
    }
}

static void go_back(Game *game, SimGuard *guard) {
    sim_sound(game, GAME_SOUND_GUARD_GIVES_UP, sim_guard_eye(guard), guard->body.cell, 0.7);
    guard->mood = GAME_GUARD_RETURNS;
    guard->until = sim_tick(game) + RETURN_TICKS;
    sim_walk_start(guard);
    sim_round_find(game, guard);
}

static SimGoNews go(Game *game, SimGuard *guard, EnfVec3 to, uint32_t cell, double speed) {
    SimErrand errand = {guard->body.position, to, sim_feet_cell(game, &guard->body), cell, ENF_NONE};
    return sim_walk(game, guard, &errand, speed, guard->mood == GAME_GUARD_RETURNS ? 0.1 : 0.5);
}

/* Who finds no way home in half a minute is home all the same. */
static void return_home(Game *game, SimGuard *guard) {
    bool late = sim_tick(game) > guard->until;
    if (go(game, guard, guard->home, guard->home_cell, RETURN_SPEED) == SIM_GO_THERE || late) {
        sim_round_resume(game, guard);
    }
}

static void search(Game *game, SimGuard *guard) {
    guard->mood = GAME_GUARD_SEARCHES;
    guard->until = sim_tick(game) + SEARCH_TICKS;
    guard->turned = 0;
    sim_walk_start(guard);
}

/* Having looked round in vain, it looks through one of the doorways of where it is. */
static void look_elsewhere(Game *game, SimGuard *guard) {
    uint32_t cell = sim_feet_cell(game, &guard->body);
    if (cell >= game->map->cells_count || game->map->cells[cell].portal_count == 0) {
        return;
    }
    const EnfCell *c = &game->map->cells[cell];
    uint32_t portal = c->portal_first + (uint32_t)(sim_random(game) % c->portal_count);
    if (game->gates[portal].walkable) {
        think_of(guard, game->gates[portal].foot, cell);
        sim_walk_start(guard);
    }
    guard->turned = 0;
}

static void act_wonders(Game *game, SimGuard *guard) {
    sim_turn_to(guard, guard->last_seen);
    if (sim_tick(game) < guard->until) {
        return;
    }
    if (guard->notice > 0.3) {
        search(game, guard);
    } else {
        go_back(game, guard);
    }
}

static void act_chases(Game *game, SimGuard *guard) {
    int64_t tick = sim_tick(game);
    if (tick - guard->seen_at < MEMORY_TICKS) {
        think_of(guard, game->player.body.position, sim_feet_cell(game, &game->player.body));
    }
    SimGoNews news = go(game, guard, guard->last_seen, guard->last_cell, CHASE_SPEED);
    if (guard->sees && news != SIM_GO_ON) {
        sim_turn_to(guard, guard->last_seen);
    } else if (news != SIM_GO_ON || tick >= guard->until) {
        search(game, guard);
    }
}

static void act_searches(Game *game, SimGuard *guard) {
    if (guard->turned > 0 || go(game, guard, guard->last_seen, guard->last_cell, SEARCH_SPEED) != SIM_GO_ON) {
        guard->yaw_deg += LOOK_ROUND_RATE / ENF_TICK_RATE;
        guard->turned++;
    }
    if (sim_tick(game) >= guard->until) {
        go_back(game, guard);
    } else if (guard->turned >= ROUND_LOOK_TICKS) {
        look_elsewhere(game, guard);
    }
}

/* Who chases and sees whistles now and then: it can be heard where the chase is. */
static void whistle(Game *game, const SimGuard *guard, uint32_t number) {
    bool calls = guard->mood == GAME_GUARD_CHASES && guard->sees;
    if (calls && (sim_tick(game) + 50 * (int64_t)number) % WHISTLE_EVERY == 0) {
        sim_sound(game, GAME_SOUND_GUARD_WHISTLES, sim_guard_eye(guard), guard->body.cell, 0.9);
    }
}

static void act(Game *game, SimGuard *guard) {
    switch ((GameGuardMood)guard->mood) {
    case GAME_GUARD_ROUND:
        sim_guard_follow(game, guard);
        return;
    case GAME_GUARD_WONDERS:
        act_wonders(game, guard);
        break;
    case GAME_GUARD_CHASES:
        act_chases(game, guard);
        break;
    case GAME_GUARD_SEARCHES:
        act_searches(game, guard);
        break;
    default:
        return_home(game, guard);
        break;
    }
    if (guard->mood != GAME_GUARD_ROUND) {
        sim_guard_push(game, guard);
    }
}

/* At arm's length of a guard who chases and sees: the night is over. */
static void catch_player(Game *game, const SimGuard *guard) {
    EnfVec3 way = enf_sub(game->player.body.position, guard->body.position);
    bool near = sqrt(way.x * way.x + way.z * way.z) < CATCH_DISTANCE && fabs(way.y) < 1.2;
    if (near && guard->sees && guard->mood == GAME_GUARD_CHASES && game->score.phase == GAME_PLAYING) {
        game->score.phase = GAME_LOST;
        sim_sound(game, GAME_SOUND_CAUGHT, sim_guard_eye(guard), guard->body.cell, 1.0);
        sim_sound(game, GAME_SOUND_LOST, game->player.body.position, game->player.body.cell, 1.0);
        sim_say(game, "Caught");
    }
}

void sim_guards_step(Game *game) {
    sim_walk_search(game);
    for (uint32_t i = 0; i < game->guard_count; i++) {
        SimGuard *guard = &game->guards[i];
        act(game, guard);
        look(game, guard, i);
        whistle(game, guard, i);
        catch_player(game, guard);
    }
}
