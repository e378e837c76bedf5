/* Rounds: a guard as a path of the map, and how it leaves that path and comes back to it. */
#include "sim/sim.h"

#include <math.h>
#include <string.h>

#define EYE_HEIGHT 1.65
/* A step up is a leap of 0.4 m in one tick: no point of a guard is faster than that and its way. */
#define GUARD_SPEED_MAX 45.0
enum { HOME_EVERY = ENF_TICK_RATE / 3 };

EnfVec3 sim_guard_eye(const SimGuard *guard) {
    return enf_add(guard->body.position, enf_v3(0.0, EYE_HEIGHT, 0.0));
}

void sim_guard_follow(Game *game, SimGuard *guard) {
    EnfPose pose = enf_world_pose(game->world, guard->object.index);
    EnfVec3 from = sim_guard_eye(guard), to = enf_add(pose.position, enf_v3(0.0, EYE_HEIGHT, 0.0));
    bool known = guard->body.cell != ENF_NONE && enf_length(enf_sub(to, from)) < 3.0;
    guard->body.cell = known ? enf_map_track(game->map, guard->body.cell, from, to) : enf_map_locate(game->map, to);
    guard->body.position = pose.position;
    guard->yaw_deg = sim_yaw(pose.rotation);
}

static EnfPose pose_of(const SimGuard *guard) {
    EnfPose pose = enf_pose_identity();
    pose.position = guard->body.position;
    pose.rotation = enf_quat_axis_angle(enf_v3(0.0, 1.0, 0.0), guard->yaw_deg * (ENF_PI / 180.0));
    return pose;
}

/* Off its path, it walks from where it was. */
void sim_guard_push(Game *game, SimGuard *guard) {
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

EnfMotion sim_round(const Game *game, const SimGuard *guard) {
    EnfMotion motion = enf_mover_def(game->map, guard->mover).motion;
    if (motion.kind == ENF_MOTION_PATH) {
        motion.as.path.start_tick += game->begin + guard->start;
    }
    return motion;
}

/* The nearest place of the round, of one every third of a second; on another storey only if there is none on this. Once a return: in
 * every tick it would be most of what a tick costs. */
void sim_round_find(Game *game, SimGuard *guard) {
    EnfMotion motion = sim_round(game, guard);
    EnfVec3 here = guard->body.position;
    guard->home = here;
    guard->home_at = 0;
    double nearest = HUGE_VAL;
    int64_t period = motion.kind == ENF_MOTION_PATH ? (int64_t)motion.as.path.period_ticks : 0;
    for (int64_t tick = 0; tick < period; tick += HOME_EVERY) {
        EnfVec3 place = enf_motion_state(&motion, motion.as.path.start_tick + tick).position;
        double away = enf_length(enf_sub(place, here)) + 4.0 * fabs(place.y - here.y);
        if (away < nearest) {
            nearest = away;
            guard->home = place;
            guard->home_at = tick;
        }
    }
    guard->home_cell = enf_map_locate(game->map, enf_add(guard->home, enf_v3(0.0, 1.0, 0.0)));
}

void sim_round_resume(Game *game, SimGuard *guard) {
    EnfMotion motion = sim_round(game, guard);
    if (motion.kind == ENF_MOTION_PATH) {
        int64_t begin = motion.as.path.start_tick - guard->start;
        motion.as.path.start_tick = sim_world_tick(game) - guard->home_at;
        guard->start = motion.as.path.start_tick - begin;
    }
    enf_world_set_motion(game->world, guard->object, &motion);
    guard->mood = GAME_GUARD_ROUND;
    guard->notice = 0.0;
}
