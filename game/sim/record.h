/* Recordings of the game: what a header says of it, a tick recorded, a tick compared. For the window and for enfreplay alike. */
#ifndef ENF_GAME_SIM_RECORD_H
#define ENF_GAME_SIM_RECORD_H

#include "sim/game.h"

/** The game as recordings name it. Raise its number with every change after which an old input plays otherwise: then an older
 *  recording is refused by name instead of diverging. */
#define GAME_NAME "Night at the palace 1"

/** The header of a recording of `game`, which stands at its start, made as `def` says on `map`. `map_name`: as its user knows it (cut
 *  if too long). Title and script are left empty. */
EnfReplayHeader game_replay_header(const Game *game, const GameDef *def, const EnfMap *map, const char *map_name);

/** What the game of a recording was made from. ENF_ERROR_FORMAT if `start` is not of this game. */
EnfResult game_def_from_header(GameDef *def, const EnfReplayHeader *header, EnfError *error);

/** Records the tick that game_step has just taken with `input`. Errors as enf_recorder_tick. No heap. */
EnfResult game_record(EnfRecorder *recorder, const Game *game, const EnfInput *input, EnfError *error);

/** Is the state after game_step what was recorded? As enf_replay_compare. */
bool game_compare(const Game *game, const EnfReplay *replay, const EnfReplayTick *tick, EnfReplayDivergence *divergence);

#endif
