/* Doors and elevators: how they swing or slide. */
#include "compile/movers.h"

#include <math.h>

static void swing(EnfMoverWork *work) {
    EnfMover *mover = &work->mover;
    const EnfMoverExtras *extras = &work->extras;
    const double radians = ENF_PI / 180.0;
    EnfVec3 axis = enf_normalize(extras->axis);
    double angle = extras->angle < 0.0 || extras->angle > 0.0 ? extras->angle : 90.0;
    double other = fabs(extras->swing_low);
    mover->kind = ENF_MOVER_HINGE;
    mover->low = (float)(radians * (angle < 0.0 ? angle : 0.0 - other));
    mover->high = (float)(radians * (angle < 0.0 ? other : angle));
    mover->rate = (float)(radians * (extras->speed > 0.0 ? extras->speed : 90.0));
    mover->axis[0] = (float)axis.x, mover->axis[1] = (float)axis.y, mover->axis[2] = (float)axis.z;
}

static void slide(EnfMoverWork *work, EnfVec3 move) {
    EnfMover *mover = &work->mover;
    EnfVec3 axis = enf_normalize(move);
    mover->kind = ENF_MOVER_SLIDE;
    mover->high = (float)enf_length(move);
    mover->rate = (float)(work->extras.speed > 0.0 ? work->extras.speed : 1.0);
    mover->axis[0] = (float)axis.x, mover->axis[1] = (float)axis.y, mover->axis[2] = (float)axis.z;
}

static void lift(EnfMoverWork *work) {
    const EnfMoverExtras *extras = &work->extras;
    slide(work, enf_v3(0.0, 1.0, 0.0));
    work->mover.high = 0.0f;
    for (uint32_t i = 0; i < extras->stop_count; i++) {
        work->mover.low = fminf(work->mover.low, (float)extras->stops[i]);
        work->mover.high = fmaxf(work->mover.high, (float)extras->stops[i]);
    }
}

/* A class of the family that moves, but none that is known: likely a slip of the pen. */
static bool is_unknown(const char *classname) {
    static const char *const known[] = {"func_door", "func_door_rotating", "func_plat", "func_button"};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (strcmp(classname, known[i]) == 0) {
            return false;
        }
    }
    return strncmp(classname, "func_", 5) == 0;
}

void enf_mover_swing(EnfMoverWork *work) {
    const EnfMoverExtras *extras = &work->extras;
    const char *name = work->parts->source->nodes[work->node].name;
    EnfVec3 pivot = work->rest.t;
    work->mover.pivot[0] = pivot.x, work->mover.pivot[1] = pivot.y, work->mover.pivot[2] = pivot.z;
    if (strcmp(extras->classname, "func_door_rotating") == 0) {
        swing(work);
    } else if (strcmp(extras->classname, "func_door") == 0 && extras->has_move) {
        slide(work, extras->move);
    } else if (strcmp(extras->classname, "func_plat") == 0 && extras->stop_count > 0) {
        lift(work);
    } else if (strcmp(extras->classname, "func_door") == 0 || strcmp(extras->classname, "func_plat") == 0) {
        enf_diagnose(work->parts->diagnosis, ENF_DIAGNOSIS_MOVER_KEY, name, "a %s needs '%s': it stands still",
                     extras->classname, strcmp(extras->classname, "func_door") == 0 ? "move" : "stops");
    } else if (is_unknown(extras->classname)) {
        enf_diagnose(work->parts->diagnosis, ENF_DIAGNOSIS_MOVER_KEY, name, "'%s' is no known class: it stands still",
                     extras->classname);
    }
}
