/* What the player hears: a sound comes along the shortest way through doorways, fades by its length and by shut doors, and seems to
 * come from the first doorway of the way, not through the wall. */
#include "sim/sim.h"

#include <math.h>

/* Metres of detour (way less straight line) that muffle a sound by half. */
#define MUFFLE 10.0

void sim_hear(Game *game, GameSound *sound, uint32_t cell) {
    const EnfCharacter *body = &game->player.body;
    EnfVec3 ears = enf_character_eye(body);
    if (!game->ears_ready) { /* once a tick, and only if something sounds */
        sim_ways_find(game, &game->ears, ears, body->cell, SIM_HEARD_MOST);
        game->ears_ready = true;
    }
    uint32_t last;
    double way = sim_ways_to(game, &game->ears, sound->at_ws, cell, &last);
    double straight = enf_length(enf_sub(sound->at_ws, ears));
    if (body->cell == ENF_NONE || cell == ENF_NONE) {
        way = straight; /* outside every cell there are no doorways to go by */
    }
    sound->apparent_ws = sound->at_ws;
    for (uint32_t p = last; p != ENF_NONE; p = game->ears.before[p]) {
        sound->apparent_ws = game->gates[p].middle;
    }
    if (!(way < SIM_HEARD_MOST)) {
        sound->gain = 0.0;
        sound->muffled = 1.0;
        return;
    }
    double fade = 1.0 - way / SIM_HEARD_MOST;
    sound->gain = sound->loudness * fade * fade / fmax(1.0, 0.35 * way);
    sound->muffled = way > straight ? (way - straight) / (way - straight + MUFFLE) : 0.0;
}
