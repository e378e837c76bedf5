/* A night in the small palace of scenes/night.h, as its tests play it: sounds counted, every block of the heap given back. */
#ifndef ENF_NIGHT_PLAY_H
#define ENF_NIGHT_PLAY_H

#include "harness/purse.h"
#include "scenes/night.h"

#include "sim/bot.h"

#include <string.h>

enum { MOST = 20000 }; /* ticks of a script */

typedef struct Play {
    EnfNight night;
    Game *game;
    Purse purse;
    uint32_t heard[GAME_SOUND_COUNT]; /* how often */
} Play;

static inline void open_play(Play *play, EnfNightDef def, bool peaceful) {
    memset(play, 0, sizeof *play);
    EnfError error = {ENF_OK, 0, "", ""};
    if (!enf_night_create(&play->night, &def, &error)) {
        fail_msg("%s", error.message);
    }
    GameDef game = game_def_default();
    game.peaceful = peaceful;
    play->purse = purse_with(PURSE_FULL);
    EnfAllocator allocator = purse_allocator(&play->purse);
    assert_int_equal(game_create(&play->game, play->night.map, &game, &allocator, &error), ENF_OK);
}

static inline void close_play(Play *play) {
    game_destroy(play->game);
    purse_assert_whole(&play->purse);
    enf_night_destroy(&play->night);
}

static inline void step(Play *play, const EnfInput *input) {
    game_step(play->game, input);
    uint32_t count;
    const GameSound *sounds = game_sounds(play->game, &count);
    for (uint32_t i = 0; i < count; i++) {
        play->heard[sounds[i].kind]++;
    }
}

static inline void wait(Play *play, int ticks) {
    static const EnfInput nothing;
    for (int i = 0; i < ticks; i++) {
        step(play, &nothing);
    }
}

/* Plays a script to its end; inputs and hashes are kept if asked for. Returns the ticks. */
static inline uint32_t run_traced(Play *play, const char *script, EnfInput *inputs, uint64_t *hashes, uint32_t most) {
    EnfError error = {ENF_OK, 0, "", ""};
    GameBot *bot;
    if (game_bot_create(&bot, play->game, script, strlen(script), NULL, &error) != ENF_OK) {
        fail_msg("%s", error.message);
    }
    EnfInput input;
    GameBotNews news;
    uint32_t ticks = 0;
    while ((news = game_bot_next(bot, &input, &error)) == GAME_BOT_GOES_ON && ticks < most) {
        step(play, &input);
        if (inputs) {
            inputs[ticks] = input;
            hashes[ticks] = game_hash(play->game);
        }
        ticks++;
    }
    game_bot_destroy(bot);
    if (news != GAME_BOT_DONE) {
        fail_msg("%s", error.message);
    }
    return ticks;
}

static inline uint32_t run(Play *play, const char *script) {
    return run_traced(play, script, NULL, NULL, MOST);
}

#endif
