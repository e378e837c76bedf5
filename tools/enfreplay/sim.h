/* The simulation that recordings are of, as enfreplay and its tests see it: the game of game/sim. Only sim.c knows it. */
#ifndef ENFREPLAY_SIM_H
#define ENFREPLAY_SIM_H

#include <enfilade/replay.h>
#include <enfilade/world.h>

typedef struct Sim Sim;

/** Where the player looks from after the last tick. */
typedef struct SimEye {
    EnfVec3 eye_ws;
    double yaw_deg, pitch_deg;
    uint32_t cell; /**< or ENF_NONE */
} SimEye;

/** The game's name and version, as recordings name it. */
const char *sim_game(void);

/** A game at its start, on `map` (which must outlive it), as the header's `seed` and `start` say. */
EnfResult sim_create(Sim **sim, const EnfMap *map, const EnfReplayHeader *header, EnfError *error);
void sim_destroy(Sim *sim);

/** What a recording of it says of the game and the map: writes those members of `header`. The game stands at its start. */
void sim_fill_header(const Sim *sim, EnfReplayHeader *header);

void sim_step(Sim *sim, const EnfInput *input);
/** After a step: records it; compares it with what was recorded (as enf_replay_compare). */
EnfResult sim_record(const Sim *sim, EnfRecorder *recorder, const EnfInput *input, EnfError *error);
bool sim_compare(const Sim *sim, const EnfReplay *replay, const EnfReplayTick *tick, EnfReplayDivergence *divergence);
uint64_t sim_hash(const Sim *sim);

SimEye sim_eye(const Sim *sim);
EnfWorld *sim_world(Sim *sim);
const EnfPortals *sim_portals(const Sim *sim);
/** Is it won or lost? */
bool sim_is_over(const Sim *sim);
/** How the game stands, in a few words: "playing in Rotunda-room, 2 of 6 carried out". */
void sim_describe(const Sim *sim, char text[160]);

/* ---- the game's bot --------------------------------------------------------------------------------------------- */

/** Input that the game's own bot makes from a script of its language (game/sim/bot.h). */
typedef struct SimBot SimBot;
bool sim_bot_is_script(const char *text, size_t size);
EnfResult sim_bot_create(SimBot **bot, Sim *sim, const char *script, size_t size, EnfError *error);
void sim_bot_destroy(SimBot *bot);
/** The input of the next tick; false at the end of the script, or where it cannot be followed: then *result and `error` say so. */
bool sim_bot_next(SimBot *bot, EnfInput *input, EnfResult *result, EnfError *error);

#endif
