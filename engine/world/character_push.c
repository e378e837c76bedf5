/* What moves the body: the platform it stands on, and doors.
 *
 * A solid that moved is met in its own frame: seen from it the body came from where it would be had it been stuck to the solid, to where it
 * is. That way is swept against the solid at its new pose; what is left of it past the contact slides along, so a door pushes
 * along its normal and does not drag. A fast door passes nobody by. */
#include "world/character_internal.h"

enum { ROUNDS = 2 };

static bool is_zero(EnfVec3 v) {
    return v.x == 0.0 && v.y == 0.0 && v.z == 0.0;
}

/* Slides the body by `delta`, not minding one solid: it is the one that pushes. */
static void shove(EnfWalk *walk, uint32_t solid, EnfVec3 delta) {
    EnfTrial trial = enf_trial_make(walk);
    enf_collide_ignore(walk->collider, solid, ENF_IGNORED_PUSHING);
    enf_trial_slide(walk, &trial, delta);
    enf_collide_heed(walk->collider, ENF_IGNORED_PUSHING);
    trial.velocity = walk->body->velocity;
    enf_walk_commit(walk, &trial);
}

static uint32_t near_solid(const EnfCollider *collider, uint32_t object) {
    for (uint32_t i = 0; i < collider->near_count; i++) {
        if (collider->solids[collider->near[i]].object == object) {
            return collider->near[i];
        }
    }
    return ENF_NONE;
}

static void carry(EnfWalk *walk) {
    EnfCharacter *body = walk->body;
    bool stands = (body->flags & ENF_CHARACTER_GROUNDED) && body->ground_object != ENF_NONE;
    uint32_t solid = stands ? near_solid(walk->collider, body->ground_object) : ENF_NONE;
    if (solid == ENF_NONE) {
        return;
    }
    EnfVec3 delta = enf_sub(enf_solid_ride(&walk->collider->solids[solid], body->position), body->position);
    if (!is_zero(delta)) {
        shove(walk, solid, delta);
        walk->carried = enf_scale(delta, ENF_TICK_RATE);
        walk->report->moved |= ENF_MOVED_CARRIED;
    }
}

/* Pushes the body out of the way of one solid; `start` is where it was before anything moved. */
static bool push(EnfWalk *walk, uint32_t solid, EnfVec3 start) {
    EnfVec3 ride = enf_solid_ride(&walk->collider->solids[solid], start);
    EnfVec3 way = enf_sub(walk->body->position, ride);
    EnfSweepHit hit;
    if (is_zero(enf_sub(ride, start)) || !enf_collide_sweep_solid(walk->collider, &walk->capsule, ride, way, solid, &hit)) {
        return false;
    }
    EnfVec3 rest = enf_scale(way, 1.0 - hit.t);
    EnfVec3 back = enf_scale(hit.normal, -enf_dot(rest, hit.normal)); /* what of the rest goes into it */
    shove(walk, solid, back);
    walk->report->moved |= ENF_MOVED_PUSHED;
    return true;
}

void enf_walk_pushed(EnfWalk *walk) {
    EnfCharacter *body = walk->body;
    EnfCollider *collider = walk->collider;
    EnfVec3 start = body->position;
    if (collider->solid_count == 0 || !enf_collide_gather(collider, enf_capsule_box(&walk->capsule, start, ENF_TOL_SKIN))) {
        return;
    }
    carry(walk);
    for (int round = 0; round < ROUNDS; round++) {
        bool pushed = false;
        for (uint32_t i = 0; i < collider->near_count; i++) {
            bool other = (collider->solids[collider->near[i]].ignored & ENF_IGNORED_SELF) == 0;
            pushed = (other && push(walk, collider->near[i], start)) || pushed;
        }
        if (!pushed) {
            break;
        }
    }
    if (enf_collide_ignore_overlapped(collider, &walk->capsule, body->position) > 0) {
        for (uint32_t i = 0; i < collider->near_count && walk->report->squeezed_by == ENF_NONE; i++) {
            const EnfSolid *solid = &collider->solids[collider->near[i]];
            walk->report->squeezed_by = solid->ignored & ENF_IGNORED_OVERLAPPED ? solid->object : ENF_NONE;
        }
        walk->report->moved |= ENF_MOVED_SQUEEZED;
    }
}
