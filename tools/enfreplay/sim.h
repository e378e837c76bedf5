/* The simulation that recordings are of, as enfreplay sees it. Only sim.c knows it. */
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

void sim_step(Sim *sim, const EnfInput *input);
uint64_t sim_hash(const Sim *sim);
/** Writes names and number of the fields into `header`. */
void sim_name_fields(const Sim *sim, EnfReplayHeader *header);
void sim_fields(const Sim *sim, uint64_t hashes[ENF_REPLAY_FIELDS_MAX]);

SimEye sim_eye(const Sim *sim);
EnfWorld *sim_world(Sim *sim);
const EnfPortals *sim_portals(const Sim *sim);
/** How the game stands: "playing", "won", ... */
const char *sim_phase(const Sim *sim);

/** Input that the game's own bot makes from a script of the game's. */
typedef struct SimBot SimBot;
EnfResult sim_bot_create(SimBot **bot, Sim *sim, const char *script, size_t size, EnfError *error);
void sim_bot_destroy(SimBot *bot);
/** The input of the next tick; false when the script is at its end. ENF_ERROR in `*failed` is left to the caller: a bot that
 *  cannot do what its script says stops with a message. */
bool sim_bot_next(SimBot *bot, EnfInput *input, EnfResult *result, EnfError *error);

#endif
