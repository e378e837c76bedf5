/* The river: a camera that is carried along a path and can be steered within it. An anchor moves along the authored path at the
 * current's speed; the eye hangs on it by a spring with a damper; where the visitor looks and presses forward, a thrust pushes. Speed,
 * spring, damper and thrust vary along the path, so that small rooms hold the eye tight and halls let it roam. Left alone it looks
 * where the path says. Source: Galyean, Guided Navigation of Virtual Environments, I3D 1995.
 *
 * It is no part of the game's state: a title, a guided tour. Deterministic all the same: equal inputs, equal bits. Memory is taken in
 * game_river_create; a step calls no heap. */
#ifndef ENF_GAME_SIM_RIVER_H
#define ENF_GAME_SIM_RIVER_H

#include <enfilade/collide.h>
#include <enfilade/replay.h>

typedef struct GameRiver GameRiver;

enum { GAME_RIVER_POINTS_MAX = 65536 };

/** What a river is made from. Zero it first. */
typedef struct GameRiverDef {
    const char
        *text; /**< the path: lines `x,y,z,speed,spring,damping,thrust,look_x,look_y,look_z` (metres, world; m/s; 1/s²; 1/s;
                           m/s²), at least two, after a line of headings. Lines that are empty or begin with # are passed over */
    size_t size;
    const EnfMap *map;     /**< tells the eye's cell; must outlive the river */
    EnfCollider *collider; /**< keeps the eye out of walls; or NULL: it passes them */
} GameRiverDef;

/** Errors: ENF_ERROR_FORMAT, ENF_ERROR_RANGE, ENF_ERROR_SIZE (the message names the line), ENF_ERROR_MEMORY. `*river` is then NULL. */
EnfResult game_river_create(GameRiver **river, const GameRiverDef *def, const EnfAllocator *allocator, EnfError *error);
void game_river_destroy(GameRiver *river);

/** Back to the beginning of the path, or to the place on it nearest to `at_ws` (NULL: the beginning). */
void game_river_start(GameRiver *river, const EnfVec3 *at_ws);
/** One tick. `yaw` and `pitch` turn the look, which drifts back when they rest; `forward` and `right` push. NULL: nobody steers. */
void game_river_step(GameRiver *river, const EnfInput *input);

/** Where the eye is. */
typedef struct GameRiverView {
    EnfVec3 eye_ws, eye_before_ws; /**< now, and one tick before (equal after a jump of place) */
    double yaw_deg, pitch_deg, yaw_before_deg,
        pitch_before_deg; /**< unbroken: blending two ticks never turns the long way round */
    uint32_t cell;        /**< or ENF_NONE */
    double along, length; /**< metres of the path gone by, in this round; of the path */
    uint32_t rounds;      /**< times that it came to its end, and began again */
} GameRiverView;
GameRiverView game_river_view(const GameRiver *river);

#endif
