/* What the files of walking share: a tick's work in progress. */
#ifndef ENFILADE_CHARACTER_INTERNAL_H
#define ENFILADE_CHARACTER_INTERNAL_H

#include "world/collide_internal.h"

enum { ENF_TRIAL_PATH_MAX = 24, ENF_TRIAL_PLANES_MAX = 6 };

/** A move that may yet be thrown away. */
typedef struct EnfTrial {
    EnfVec3 at, velocity;
    EnfVec3 path[ENF_TRIAL_PATH_MAX];
    uint32_t path_count;
    EnfVec3 ground; /**< normal of what the feet follow */
    EnfVec3 planes[ENF_TRIAL_PLANES_MAX];
    uint32_t plane_count;
    bool blocked; /**< by something upright */
    bool landed;
    EnfSweepHit landing;
} EnfTrial;

/** A body in one tick. */
typedef struct EnfWalk {
    EnfCharacter *body;
    EnfCollider *collider;
    EnfCharacterReport *report;
    EnfCapsule capsule;
    EnfVec3 carried; /**< m/s: of what it stands on */
} EnfWalk;

EnfTrial enf_trial_make(const EnfWalk *walk);
/** Takes the trial's place and path for the body's; the eye's cell follows. */
void enf_walk_commit(EnfWalk *walk, const EnfTrial *trial);
/** Slides through the air, or as it is pushed: all three dimensions. */
void enf_trial_slide(const EnfWalk *walk, EnfTrial *trial, EnfVec3 delta);
/** Slides along the ground: `delta` is horizontal, the height follows trial->ground. */
void enf_trial_walk(const EnfWalk *walk, EnfTrial *trial, EnfVec3 delta);
/** One straight sweep; true if it was cut short. */
bool enf_trial_sweep(const EnfWalk *walk, EnfTrial *trial, EnfVec3 delta, EnfSweepHit *hit);
/** Can a body stand on what was hit? `least_y`: of the normal, where only the face is flat enough (an edge of it is touched). */
bool enf_walk_supports(const EnfWalk *walk, const EnfSweepHit *hit, double least_y);

/** Solids carry and push the body; solids that it is squeezed by are ignored for the rest of the tick. */
void enf_walk_pushed(EnfWalk *walk);

#endif
