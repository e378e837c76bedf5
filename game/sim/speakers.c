/* What sounds by itself: places and things whose node says so by the key `sound`, and elevators on their way. It is looked for when
 * somebody listens, and is no part of the state: a game that nobody hears is the same. */
#include "sim/sim.h"

#include <math.h>
#include <string.h>

enum { LOOP_EVERY = 6 };

/** What a speaker does at a tick. */
typedef void Voice(Game *game, const SimSpeaker *speaker);

/* ---- saying something ------------------------------------------------------------------------------------------------ */

/* Where it is now, and in which cell: asked only of who says something, for to find the cell of a place takes long. */
static EnfVec3 place_of(const Game *game, const SimSpeaker *speaker) {
    if (speaker->mover == ENF_NONE) {
        return speaker->at;
    }
    EnfVec3 origin = enf_world_pose(game->world, enf_world_object(game->world, speaker->mover).index).position;
    return enf_add(origin, speaker->at);
}

static uint32_t cell_of(const Game *game, const SimSpeaker *speaker, EnfVec3 at_ws) {
    bool stays = speaker->mover == ENF_NONE;
    bool known = speaker->cell != ENF_NONE && (stays || enf_map_cell_contains(game->map, speaker->cell, at_ws));
    return known || stays ? speaker->cell : enf_map_locate(game->map, at_ws);
}

/* Adds it if it can be heard. */
static void say(Game *game, const SimSpeaker *speaker, GameSoundKind kind, double loudness) {
    EnfVec3 at_ws = place_of(game, speaker);
    double away = enf_length(enf_sub(at_ws, enf_character_eye(&game->player.body)));
    if (game->spoken_count >= SIM_SPOKEN_MAX || away > SIM_HEARD_MOST) {
        return;
    }
    GameSpeaker *out = &game->spoken[game->spoken_count];
    *out = (GameSpeaker){{kind, at_ws, loudness, 0.0, at_ws, 0.0}, speaker->id, false};
    sim_hear(game, &out->sound, cell_of(game, speaker, at_ws));
    game->spoken_count += out->sound.gain >= GAME_GAIN_LEAST;
}

/* A sound that goes on. */
static void hum(Game *game, const SimSpeaker *speaker, GameSoundKind kind, double loudness) {
    uint32_t before = game->spoken_count;
    if (sim_tick(game) % LOOP_EVERY == 0) {
        say(game, speaker, kind, loudness);
    }
    if (game->spoken_count > before) {
        game->spoken[before].loops = true;
    }
}

/* Is it time, every so many ticks? Speakers go by turns. */
static bool due(const Game *game, const SimSpeaker *speaker, int64_t ticks) {
    return (sim_tick(game) + (int64_t)(speaker->id % 97) * 31) % ticks == 0;
}

/* ---- voices ------------------------------------------------------------------------------------------------------------ */

/* `phase` is what the clock shows at the start, seconds past twelve: tick and tock by turns, a chime at each quarter, and at the hour as
 * many strokes as it is. */
static void clock_voice(Game *game, const SimSpeaker *speaker) {
    int64_t ticks = sim_tick(game) + speaker->phase_ticks, second = ticks / ENF_TICK_RATE;
    if (ticks % ENF_TICK_RATE != 0) {
        return;
    }
    int64_t hour = second / 3600 % 12, past = second % 3600, strokes = hour ? hour : 12;
    say(game, speaker, second % 2 ? GAME_SOUND_CLOCK_TOCKS : GAME_SOUND_CLOCK_TICKS, 0.3);
    if (past % 900 == 0) {
        say(game, speaker, GAME_SOUND_CLOCK_CHIMES, 0.7);
    } else if (past >= 4 && past < 4 + 2 * strokes && past % 2 == 0) {
        say(game, speaker, GAME_SOUND_CLOCK_STRIKES, 0.8);
    }
}

static void train_voice(Game *game, const SimSpeaker *speaker) {
    hum(game, speaker, GAME_SOUND_TRAIN, 0.5);
    if (due(game, speaker, 35 * ENF_TICK_RATE)) {
        say(game, speaker, GAME_SOUND_TRAIN_WHISTLES, 0.6);
    }
}

static void fountain_voice(Game *game, const SimSpeaker *speaker) {
    hum(game, speaker, GAME_SOUND_FOUNTAIN, 0.6);
}

static void bird_voice(Game *game, const SimSpeaker *speaker) {
    if (due(game, speaker, 420 + 53 * (int64_t)(speaker->id % 11))) {
        say(game, speaker, GAME_SOUND_BIRD, 0.5);
    }
}

/* A revolving door: a wing goes by every `sound_every` seconds. */
static void wings_voice(Game *game, const SimSpeaker *speaker) {
    if (sim_tick(game) % speaker->every_ticks == 0) {
        say(game, speaker, GAME_SOUND_WINGS, 0.5);
    }
}

static const struct {
    const char *word; /* what a node says */
    Voice *voice;
} voices[] = {
    {"clock", clock_voice}, {"train", train_voice}, {"fountain", fountain_voice}, {"bird", bird_voice}, {"wings", wings_voice},
};
enum { VOICES = sizeof voices / sizeof *voices };

/* ---- who speaks ---------------------------------------------------------------------------------------------------------- */

static uint32_t voice_of(const EnfMap *map, const EnfEntity *entity) {
    char word[SIM_KEY_SIZE];
    uint32_t voice = 0;
    sim_extra(enf_map_string(map, entity->extras), "sound", word, sizeof word);
    while (voice < VOICES && strcmp(voices[voice].word, word) != 0) {
        voice++;
    }
    return voice;
}

static int64_t ticks_of(const EnfMap *map, const EnfEntity *entity, const char *key, double standard) {
    double seconds = sim_extra_number(enf_map_string(map, entity->extras), key, standard);
    return seconds >= 0.0 && seconds < 1e6 ? llrint(seconds * ENF_TICK_RATE) : 0;
}

static void add(Game *game, uint32_t index, uint32_t voice) {
    const EnfMap *map = game->map;
    const EnfEntity *entity = &map->entities[index];
    SimSpeaker *speaker = &game->speakers[game->speaker_count];
    *speaker = (SimSpeaker){.id = game->speaker_count, .voice = voice, .mover = ENF_NONE, .cell = entity->cell};
    speaker->at = enf_v3(entity->translation[0], entity->translation[1], entity->translation[2]);
    speaker->phase_ticks = ticks_of(map, entity, "phase", 0.0);
    speaker->every_ticks = ticks_of(map, entity, "sound_every", 4.0);
    speaker->every_ticks = speaker->every_ticks > 0 ? speaker->every_ticks : ENF_TICK_RATE;
    for (uint32_t i = 0; i < map->movers_count; i++) {
        if (map->movers[i].entity == index && !(map->movers[i].flags & ENF_MOVER_CARRY)) {
            speaker->mover = i;
            speaker->at = enf_v3(0.0, 0.0, 0.0);
        }
    }
    game->speaker_count++;
}

bool sim_speakers_create(Game *game) {
    const EnfMap *map = game->map;
    for (uint32_t i = 0; i < map->entities_count; i++) {
        game->speaker_room += voice_of(map, &map->entities[i]) < VOICES;
    }
    game->speakers = enf_alloc(&game->allocator, game->speaker_room, sizeof *game->speakers);
    if (!game->speakers && game->speaker_room) {
        return false;
    }
    for (uint32_t i = 0; i < map->entities_count; i++) {
        uint32_t voice = voice_of(map, &map->entities[i]);
        if (voice < VOICES) {
            add(game, i, voice);
        }
    }
    return true;
}

/* ---- listening ------------------------------------------------------------------------------------------------------------ */

const GameSpeaker *game_speakers(Game *game, uint32_t *count) {
    game->spoken_count = 0;
    for (uint32_t i = 0; i < game->speaker_count; i++) {
        voices[game->speakers[i].voice].voice(game, &game->speakers[i]);
    }
    for (uint32_t i = 0; i < game->lift_count; i++) {
        const SimLift *lift = &game->lifts[i];
        if (lift->moving && sim_tick(game) % LOOP_EVERY == 0) {
            SimSpeaker speaker = {.id = game->speaker_count + i, .mover = lift->mover, .cell = lift->cell};
            speaker.at = enf_v3(0.0, 0.3, 0.0); /* over its plate */
            hum(game, &speaker, GAME_SOUND_LIFT_HUMS, 0.6);
        }
    }
    *count = game->spoken_count;
    return game->spoken;
}
