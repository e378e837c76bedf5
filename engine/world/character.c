/* A body that walks: one tick from a wish to a place. Speed approaches the wish at a finite rate; heights are exact
 * parabolas; ground by a sweep downward; steps by up, forward and down. */
#include "world/character_internal.h"

#include <math.h>
#include <string.h>

static const double tick_seconds = 1.0 / ENF_TICK_RATE;
static const EnfVec3 up = {0.0, 1.0, 0.0};

/* On an edge whose face is flat: who walks is held by it until it is beside him, who falls is not caught by the hip. */
#define EDGE_WALKING 0.05
#define EDGE_FALLING 0.5
/* Ticks in the air without getting anywhere until a body between two slopes counts as standing; and metres that are nowhere. */
enum { STILL_TICKS = 8 };
#define STILL_WAY 0x1p-10
/* The eye stays this far below the capsule's top and above its feet, metres. */
#define EYE_MARGIN 0.05
/* Ticks between two looks for the cell of an eye that is in none. */
enum { LOOK_TICKS = 8 };
/* Who is this far outside of all cells, metres, fell out of the level. */
#define FALLEN 4.0
/* Share of the lag left after a tick. */
#define LAG_KEPT 0.85

EnfCharacterDef enf_character_def_default(void) {
    EnfCharacterDef def = {0.3, 1.75, 1.0, 0.12, 2.6, 5.0, 1.3, 8.0, 25.0, 20.0, 5.0, 12.0, 1.0, 40.0, 0.4, 0.0, 4.0};
    def.slope_cos = 0.7071; /* 45°, and a little for the rounding of normals */
    return def;
}

EnfCapsule enf_character_capsule(const EnfCharacter *body) {
    EnfCapsule capsule = {body->def.radius, body->height};
    return capsule;
}

EnfVec3 enf_character_eye(const EnfCharacter *body) {
    double eye = body->height - body->def.eye_below_top - body->lag, top = body->height - EYE_MARGIN;
    eye = eye > top ? top : (eye < EYE_MARGIN ? EYE_MARGIN : eye);
    return enf_v3(body->position.x, body->position.y + eye, body->position.z);
}

/* ---- the eye's cell --------------------------------------------------------------------------------------------- */

static void locate(EnfWalk *walk) {
    walk->body->cell = enf_map_locate(walk->collider->map, enf_character_eye(walk->body));
}

/* Through a leak an eye may get out of its cell without crossing a portal: then it is looked for. */
static bool in_cell_box(const EnfMap *map, uint32_t cell, EnfVec3 eye) {
    const EnfCell *c = &map->cells[cell];
    const double p[3] = {eye.x, eye.y, eye.z};
    for (int axis = 0; axis < 3; axis++) {
        double at = p[axis] - c->origin[axis];
        if (at < (double)c->min[axis] - ENF_TOL_PORTAL_EYE || at > (double)c->max[axis] + ENF_TOL_PORTAL_EYE) {
            return false;
        }
    }
    return true;
}

static void follow(EnfWalk *walk, EnfVec3 from, EnfVec3 to) {
    EnfCharacter *body = walk->body;
    if (body->cell != ENF_NONE) {
        body->cell = enf_map_track(walk->collider->map, body->cell, from, to);
    }
}

static void check_cell(EnfWalk *walk) {
    EnfCharacter *body = walk->body;
    bool in = body->cell != ENF_NONE && in_cell_box(walk->collider->map, body->cell, enf_character_eye(body));
    if (!in && body->lost_ticks % LOOK_TICKS == 0) { /* to look for it costs as much as a hundred moves */
        locate(walk);
        in = body->cell != ENF_NONE;
    }
    body->lost_ticks = in ? 0 : body->lost_ticks + 1;
}

void enf_walk_commit(EnfWalk *walk, const EnfTrial *trial) {
    EnfCharacter *body = walk->body;
    for (uint32_t i = 0; i < trial->path_count; i++) {
        EnfVec3 eye = enf_character_eye(body);
        body->position = trial->path[i];
        follow(walk, eye, enf_character_eye(body));
        if (walk->report->path_count < ENF_CHARACTER_PATH_MAX) {
            walk->report->path[walk->report->path_count++] = body->position;
        }
    }
    body->velocity = trial->velocity;
}

/* ---- speed ------------------------------------------------------------------------------------------------------ */

/* The part of `v` that counts for friction and wishes: all of it, or what is level. */
static EnfVec3 level(EnfVec3 v, bool all) {
    return all ? v : enf_v3(v.x, 0.0, v.z);
}

/* On the ground and flying: towards the wish by so much a tick, and exactly there in the end. */
static void approach(EnfCharacter *body, EnfVec3 wish, bool all) {
    bool wishes = wish.x != 0.0 || wish.y != 0.0 || wish.z != 0.0;
    double most = (wishes ? body->def.acceleration : body->def.friction) * tick_seconds, rise = body->velocity.y;
    EnfVec3 before = level(body->velocity, all), lacking = enf_sub(wish, before);
    double length = sqrt(enf_dot(lacking, lacking));
    body->velocity = length <= most ? wish : enf_add(before, enf_scale(lacking, most / length));
    body->velocity.y = all ? body->velocity.y : rise;
}

/* In the air: wins speed towards the wish, and never more than is wished (or than there was). */
static void steer(EnfCharacter *body, EnfVec3 wish) {
    double wished = sqrt(enf_dot(wish, wish)), won = body->def.air_acceleration * tick_seconds;
    EnfVec3 before = level(body->velocity, false);
    if (wished <= 0.0) {
        return;
    }
    EnfVec3 way = enf_scale(wish, 1.0 / wished);
    double lacking = wished - enf_dot(before, way);
    if (lacking <= 0.0) {
        return;
    }
    EnfVec3 v = enf_add(before, enf_scale(way, won < lacking ? won : lacking));
    double speed = sqrt(enf_dot(v, v)), was = sqrt(enf_dot(before, before));
    double most = was > wished ? was : wished;
    v = speed > most ? enf_scale(v, most / speed) : v;
    body->velocity = enf_v3(v.x, body->velocity.y, v.z);
}

static EnfVec3 wish_of(const EnfCharacter *body, const EnfCharacterInput *input) {
    bool all = body->mode != ENF_CHARACTER_WALK;
    EnfVec3 wish = enf_v3_finite(input->wish) ? level(input->wish, all) : enf_v3(0.0, 0.0, 0.0);
    double length = sqrt(enf_dot(wish, wish));
    wish = length > 1.0 ? enf_scale(wish, 1.0 / length) : wish;
    double speed = input->run ? body->def.run_speed : body->def.walk_speed;
    speed = all ? body->def.fly_speed : speed;
    return enf_scale(wish, body->height < body->def.height && !all ? body->def.crouch_speed : speed);
}

/* ---- ground ----------------------------------------------------------------------------------------------------- */

static void leave_ground(EnfWalk *walk) {
    EnfCharacter *body = walk->body;
    if (body->flags & ENF_CHARACTER_GROUNDED) {
        body->velocity = enf_add(body->velocity, walk->carried); /* who jumps off a train flies on */
    }
    body->flags &= ~(uint32_t)ENF_CHARACTER_GROUNDED;
    body->ground_object = body->ground_cluster = ENF_NONE;
    body->ground_normal = up;
}

/* m/s of a solid at the feet. */
static EnfVec3 speed_of(const EnfWalk *walk, uint32_t object) {
    uint32_t solid = object == ENF_NONE ? ENF_NONE : enf_collide_solid_of(walk->collider, object);
    if (solid == ENF_NONE) {
        return enf_v3(0.0, 0.0, 0.0);
    }
    EnfVec3 ride = enf_solid_ride(&walk->collider->solids[solid], walk->body->position);
    return enf_scale(enf_sub(ride, walk->body->position), ENF_TICK_RATE);
}

static void stand_on(EnfWalk *walk, const EnfSweepHit *hit) {
    EnfCharacter *body = walk->body;
    bool landed = !(body->flags & ENF_CHARACTER_GROUNDED);
    body->flags |= ENF_CHARACTER_GROUNDED;
    body->ground_object = hit->object;
    body->ground_cluster = hit->cluster;
    body->ground_normal = hit->normal.y >= body->def.slope_cos ? hit->normal : up;
    if (landed) {
        EnfVec3 under = speed_of(walk, hit->object);
        walk->report->moved |= ENF_MOVED_LANDED;
        walk->report->fall_speed = under.y - body->velocity.y > 0.0 ? under.y - body->velocity.y : 0.0;
        body->velocity = enf_sub(body->velocity, under);
    }
    body->velocity.y = 0.0;
}

/* Who stood on the ground looks for it a step below; the eye follows later. */
static void find_ground(EnfWalk *walk) {
    EnfCharacter *body = walk->body;
    EnfTrial trial = enf_trial_make(walk);
    EnfSweepHit hit;
    bool wedged = body->still_ticks >= STILL_TICKS;
    bool met = enf_trial_sweep(walk, &trial, enf_v3(0.0, -(body->def.step + 2.0 * ENF_TOL_SKIN), 0.0), &hit);
    if (!met || !(wedged || enf_walk_supports(walk, &hit, EDGE_WALKING))) {
        leave_ground(walk);
        return;
    }
    body->lag -= body->position.y - trial.at.y;
    enf_walk_commit(walk, &trial);
    stand_on(walk, &hit);
}

/* ---- steps ------------------------------------------------------------------------------------------------------ */

/* Up, forward, down. True if it ends on something that can be stood on, no more than a step above. */
static bool climb(const EnfWalk *walk, EnfTrial *trial, EnfVec3 delta) {
    const EnfCharacter *body = walk->body;
    double foot = trial->at.y;
    EnfSweepHit hit;
    (void)enf_trial_sweep(walk, trial, enf_v3(0.0, body->def.step + 2.0 * ENF_TOL_SKIN, 0.0), &hit);
    double risen = trial->at.y - foot;
    trial->ground = up;
    enf_trial_walk(walk, trial, delta);
    if (!enf_trial_sweep(walk, trial, enf_v3(0.0, -risen, 0.0), &hit)) {
        return true; /* over a rail */
    }
    bool low = hit.point.y <= foot + body->def.step + ENF_TOL_SKIN;
    return low && enf_walk_supports(walk, &hit, EDGE_WALKING);
}

static double progress(const EnfTrial *trial, EnfVec3 start, EnfVec3 delta) {
    return enf_dot(enf_sub(trial->at, start), delta);
}

static void walk_along(EnfWalk *walk, EnfVec3 delta) {
    EnfCharacter *body = walk->body;
    EnfTrial direct = enf_trial_make(walk);
    EnfVec3 start = body->position;
    enf_trial_walk(walk, &direct, delta);
    if (direct.blocked) {
        EnfTrial over = enf_trial_make(walk);
        double least = 0x1p-20 * enf_dot(delta, delta);
        if (climb(walk, &over, delta) && progress(&over, start, delta) > progress(&direct, start, delta) + least) {
            over.velocity.y = 0.0;
            body->lag += over.at.y - start.y;
            walk->report->moved |= ENF_MOVED_STEPPED;
            enf_walk_commit(walk, &over);
            return;
        }
        walk->report->moved |= ENF_MOVED_BLOCKED;
    }
    enf_walk_commit(walk, &direct);
}

/* ---- the three ways of moving ----------------------------------------------------------------------------------- */

static void jump(EnfWalk *walk, const EnfCharacterInput *input) {
    EnfCharacter *body = walk->body;
    bool held = (body->flags & ENF_CHARACTER_JUMP_HELD) != 0;
    if (input->jump && !held && (body->flags & ENF_CHARACTER_GROUNDED)) {
        leave_ground(walk);
        body->velocity.y += sqrt(2.0 * body->def.gravity * body->def.jump_height);
        body->still_ticks = 0;
        walk->report->moved |= ENF_MOVED_JUMPED;
    }
    body->flags &= ~(uint32_t)ENF_CHARACTER_JUMP_HELD;
    body->flags |= input->jump ? (uint32_t)ENF_CHARACTER_JUMP_HELD : 0;
}

static void fall(EnfWalk *walk, EnfVec3 wish) {
    EnfCharacter *body = walk->body;
    EnfVec3 start = body->position;
    steer(body, wish);
    EnfVec3 delta = enf_scale(body->velocity, tick_seconds), before = body->velocity;
    if (body->velocity.y > -body->def.fall_speed) {
        delta.y -= 0.5 * body->def.gravity * tick_seconds * tick_seconds;
        body->velocity.y -= body->def.gravity * tick_seconds;
    }
    EnfTrial trial = enf_trial_make(walk);
    enf_trial_slide(walk, &trial, delta);
    double fallen = body->velocity.y;
    enf_walk_commit(walk, &trial);
    EnfVec3 moved = enf_sub(body->position, start);
    body->still_ticks = enf_dot(moved, moved) < STILL_WAY * STILL_WAY ? body->still_ticks + 1 : 0;
    if (trial.landed && before.y <= 0.0) {
        body->velocity.y = fallen;
        stand_on(walk, &trial.landing);
    } else if (body->still_ticks >= STILL_TICKS) {
        body->velocity = enf_v3(0.0, 0.0, 0.0);
        body->flags |= ENF_CHARACTER_GROUNDED;
        find_ground(walk);
    }
}

static void walk_ground(EnfWalk *walk, EnfVec3 wish) {
    EnfCharacter *body = walk->body;
    EnfVec3 start = body->position;
    body->velocity.y = 0.0;
    approach(body, wish, false);
    EnfVec3 delta = enf_scale(body->velocity, tick_seconds);
    if (delta.x != 0.0 || delta.z != 0.0) {
        walk_along(walk, delta);
        EnfVec3 moved = enf_sub(body->position, start);
        body->still_ticks = enf_dot(moved, moved) < STILL_WAY * STILL_WAY ? body->still_ticks : 0;
    }
    find_ground(walk);
}

static void fly(EnfWalk *walk, EnfVec3 wish) {
    EnfCharacter *body = walk->body;
    leave_ground(walk);
    approach(body, wish, true);
    EnfTrial trial = enf_trial_make(walk);
    EnfVec3 delta = enf_scale(body->velocity, tick_seconds);
    if (body->mode == ENF_CHARACTER_FLY) {
        enf_trial_slide(walk, &trial, delta);
    } else {
        trial.at = trial.path[0] = enf_add(trial.at, delta);
        trial.path_count = 1;
    }
    enf_walk_commit(walk, &trial);
}

/* ---- height ----------------------------------------------------------------------------------------------------- */

/* Shrinks at once as far as the rate lets it; grows as far as there is room. */
static void crouch(EnfWalk *walk, bool wanted) {
    EnfCharacter *body = walk->body;
    double rate = body->def.crouch_rate * tick_seconds, target = wanted ? body->def.crouch_height : body->def.height;
    EnfVec3 eye = enf_character_eye(body);
    if (body->height > target) {
        body->height = body->height - rate > target ? body->height - rate : target;
    } else if (body->height < target) {
        double grow = target - body->height < rate ? target - body->height : rate;
        EnfSweepHit hit;
        bool met = enf_collide_sweep(walk->collider, &walk->capsule, body->position, enf_v3(0.0, grow, 0.0), &hit);
        body->height = met ? body->height : (grow < rate ? target : body->height + grow);
    }
    body->flags &= ~(uint32_t)ENF_CHARACTER_CROUCHED;
    body->flags |= body->height < body->def.height ? (uint32_t)ENF_CHARACTER_CROUCHED : 0;
    walk->capsule.height = body->height;
    follow(walk, eye, enf_character_eye(body));
}

static void settle_lag(EnfWalk *walk) {
    EnfCharacter *body = walk->body;
    EnfVec3 eye = enf_character_eye(body);
    body->lag *= LAG_KEPT;
    body->lag = fabs(body->lag) < 0x1p-12 ? 0.0 : body->lag;
    body->lag = body->lag > 0.5 ? 0.5 : (body->lag < -0.5 ? -0.5 : body->lag);
    follow(walk, eye, enf_character_eye(body));
}

/* ---- out of what is solid --------------------------------------------------------------------------------------- */

static void put(EnfWalk *walk, EnfVec3 at) {
    EnfCharacter *body = walk->body;
    body->position = at;
    body->velocity = enf_v3(0.0, 0.0, 0.0);
    body->lag = 0.0;
    walk->report->moved |= ENF_MOVED_RELOCATED;
    walk->report->path[0] = at;
    walk->report->path_count = 1;
    locate(walk);
}

/* Through a leak, and on for ever? */
static bool has_fallen_out(const EnfWalk *walk) {
    EnfVec3 far = enf_v3(FALLEN, FALLEN, FALLEN);
    EnfBox3 box = {enf_sub(walk->collider->bounds.min, far), enf_add(walk->collider->bounds.max, far)};
    return walk->body->cell == ENF_NONE && (walk->body->flags & ENF_CHARACTER_HAS_GOOD) &&
           !enf_box3_contains(box, walk->body->position);
}

static void keep_good(EnfCharacter *body) {
    if (body->cell != ENF_NONE) {
        body->good = body->position;
        body->flags |= ENF_CHARACTER_HAS_GOOD;
    }
}

/* Out by the nearest way, else back to where it was free last, else out by any way. */
static bool free_place(EnfWalk *walk, EnfVec3 *place) {
    static const double near = 1.0, far = 6.0;
    EnfCharacter *body = walk->body;
    if (enf_collide_way_out(walk->collider, &walk->capsule, body->position, near, place)) {
        return true;
    }
    *place = body->good;
    bool good = (body->flags & ENF_CHARACTER_HAS_GOOD) != 0 &&
                !enf_collide_overlap(walk->collider, &walk->capsule, body->good, NULL);
    return good || enf_collide_way_out(walk->collider, &walk->capsule, body->position, far, place);
}

/* Inside the level: after noclip, or put there. */
static void get_out(EnfWalk *walk) {
    EnfCharacter *body = walk->body;
    EnfVec3 place;
    if (has_fallen_out(walk)) {
        put(walk, body->good);
        walk->report->moved |= ENF_MOVED_RETURNED;
    } else if (!enf_collide_overlap(walk->collider, &walk->capsule, body->position, NULL)) {
        keep_good(body);
    } else if (free_place(walk, &place)) {
        put(walk, place);
    }
}

/* ---- a tick ----------------------------------------------------------------------------------------------------- */

static void make_finite(EnfCharacter *body) {
    if (!enf_v3_finite(body->position)) {
        body->position = body->flags & ENF_CHARACTER_HAS_GOOD ? body->good : enf_v3(0.0, 0.0, 0.0);
    }
    if (!enf_v3_finite(body->velocity)) {
        body->velocity = enf_v3(0.0, 0.0, 0.0);
    }
}

static void move_solid(EnfWalk *walk, const EnfCharacterInput *input) {
    EnfCharacter *body = walk->body;
    uint32_t self = body->object == ENF_NONE ? ENF_NONE : enf_collide_solid_of(walk->collider, body->object);
    if (self != ENF_NONE) {
        enf_collide_ignore(walk->collider, self, ENF_IGNORED_SELF);
    }
    enf_walk_pushed(walk);
    get_out(walk);
    crouch(walk, input->crouch && body->mode == ENF_CHARACTER_WALK);
    EnfVec3 wish = wish_of(body, input);
    if (body->mode == ENF_CHARACTER_FLY) {
        fly(walk, wish);
    } else {
        jump(walk, input);
        if (body->flags & ENF_CHARACTER_GROUNDED) {
            walk_ground(walk, wish);
        } else {
            fall(walk, wish);
        }
    }
    enf_collide_heed(walk->collider, ENF_IGNORED_OVERLAPPED | ENF_IGNORED_SELF);
}

static EnfWalk walk_make(EnfCharacter *body, EnfCollider *collider, EnfCharacterReport *report) {
    EnfWalk walk = {body, collider, report, enf_character_capsule(body), {0.0, 0.0, 0.0}};
    report->moved = 0;
    report->squeezed_by = ENF_NONE;
    report->fall_speed = 0.0;
    report->path[0] = body->position;
    report->path_count = 1;
    return walk;
}

void enf_character_move(EnfCharacter *body, EnfCollider *collider, const EnfCharacterInput *input, EnfCharacterReport *report) {
    EnfCharacterReport unwanted;
    make_finite(body);
    EnfWalk walk = walk_make(body, collider, report != NULL ? report : &unwanted);
    body->mode = input->mode;
    if (body->mode == ENF_CHARACTER_NOCLIP) {
        fly(&walk, wish_of(body, input));
        if (body->cell == ENF_NONE || !enf_map_cell_contains(collider->map, body->cell, enf_character_eye(body))) {
            locate(&walk);
        }
    } else {
        move_solid(&walk, input);
    }
    settle_lag(&walk);
    check_cell(&walk);
}

bool enf_character_spawn(EnfCharacter *body, EnfCollider *collider, const EnfCharacterDef *def, EnfVec3 feet_ws) {
    memset(body, 0, sizeof *body);
    body->def = *def;
    body->height = def->height;
    body->ground_normal = up;
    body->cell = body->ground_object = body->ground_cluster = body->object = ENF_NONE;
    EnfCapsule capsule = enf_character_capsule(body);
    bool free = enf_collide_way_out(collider, &capsule, feet_ws, 2.0, &body->position);
    body->good = body->position;
    body->flags = free ? (uint32_t)ENF_CHARACTER_HAS_GOOD : 0;
    EnfCharacterReport report;
    EnfWalk walk = walk_make(body, collider, &report);
    body->flags |= ENF_CHARACTER_GROUNDED; /* if there is ground within a step */
    EnfTrial lift = enf_trial_make(&walk); /* to the skin's distance from a floor on which it was put exactly */
    EnfSweepHit hit;
    (void)enf_trial_sweep(&walk, &lift, enf_v3(0.0, ENF_TOL_SKIN, 0.0), &hit);
    enf_walk_commit(&walk, &lift);
    find_ground(&walk);
    body->lag = 0.0;
    locate(&walk);
    return free;
}
