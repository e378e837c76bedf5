/* The game as the simulation of recordings. */
#include "enfreplay/sim.h"

#include <stdio.h>
#include <string.h>

#include "sim/bot.h"
#include "sim/record.h"

struct Sim {
    const EnfMap *map;
    GameDef def;
    Game *game;
};

const char *sim_game(void) {
    return GAME_NAME;
}

EnfResult sim_create(Sim **sim, const EnfMap *map, const EnfReplayHeader *header, EnfError *error) {
    *sim = NULL;
    Sim *made = enf_alloc(NULL, 1, sizeof *made);
    if (!made) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a game");
    }
    made->map = map;
    EnfResult result = game_def_from_header(&made->def, header, error);
    if (result == ENF_OK) {
        result = game_create(&made->game, map, &made->def, NULL, error);
    }
    if (result != ENF_OK) {
        sim_destroy(made);
        return result;
    }
    *sim = made;
    return ENF_OK;
}

void sim_destroy(Sim *sim) {
    if (sim) {
        game_destroy(sim->game);
        enf_free(NULL, sim, 1, sizeof *sim);
    }
}

void sim_fill_header(const Sim *sim, EnfReplayHeader *header) {
    EnfReplayHeader own = game_replay_header(sim->game, &sim->def, sim->map, header->map);
    memcpy(own.title, header->title, sizeof own.title);
    memcpy(own.script, header->script, sizeof own.script);
    own.field_every = header->field_every;
    *header = own;
}

void sim_step(Sim *sim, const EnfInput *input) {
    game_step(sim->game, input);
}

EnfResult sim_record(const Sim *sim, EnfRecorder *recorder, const EnfInput *input, EnfError *error) {
    return game_record(recorder, sim->game, input, error);
}

bool sim_compare(const Sim *sim, const EnfReplay *replay, const EnfReplayTick *tick, EnfReplayDivergence *divergence) {
    return game_compare(sim->game, replay, tick, divergence);
}

uint64_t sim_hash(const Sim *sim) {
    return game_hash(sim->game);
}

SimEye sim_eye(const Sim *sim) {
    const GameState *state = game_state(sim->game);
    SimEye eye = {state->eye_ws, state->yaw_deg, state->pitch_deg, state->cell};
    return eye;
}

EnfWorld *sim_world(Sim *sim) {
    return game_world(sim->game);
}

const EnfPortals *sim_portals(const Sim *sim) {
    return game_portals(sim->game);
}

bool sim_is_over(const Sim *sim) {
    return game_state(sim->game)->phase != GAME_PLAYING;
}

void sim_describe(const Sim *sim, char text[160]) {
    static const char *const phases[] = {"playing", "won", "lost"};
    const GameState *state = game_state(sim->game);
    const char *cell = state->cell == ENF_NONE ? "no room" : enf_map_string(sim->map, sim->map->cells[state->cell].name);
    snprintf(text, 160, "%s in %.60s; carries %u, %u of %u carried out", phases[state->phase], cell, state->carried,
             state->delivered, state->wanted);
}

/* ---- bot -------------------------------------------------------------------------------------------------------- */

struct SimBot {
    GameBot *bot;
};

bool sim_bot_is_script(const char *text, size_t size) {
    size_t length = strlen(GAME_BOT_MAGIC);
    return size >= length && memcmp(text, GAME_BOT_MAGIC, length) == 0;
}

EnfResult sim_bot_create(SimBot **bot, Sim *sim, const char *script, size_t size, EnfError *error) {
    *bot = enf_alloc(NULL, 1, sizeof **bot);
    if (!*bot) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a bot");
    }
    EnfResult result = game_bot_create(&(*bot)->bot, sim->game, script, size, NULL, error);
    if (result != ENF_OK) {
        sim_bot_destroy(*bot);
        *bot = NULL;
    }
    return result;
}

void sim_bot_destroy(SimBot *bot) {
    if (bot) {
        game_bot_destroy(bot->bot);
        enf_free(NULL, bot, 1, sizeof *bot);
    }
}

bool sim_bot_next(SimBot *bot, EnfInput *input, EnfResult *result, EnfError *error) {
    GameBotNews news = game_bot_next(bot->bot, input, error);
    if (news == GAME_BOT_FAILED) {
        *result = ENF_ERROR_ARGUMENT;
    }
    return news == GAME_BOT_GOES_ON;
}
