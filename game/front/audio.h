/* Sounds: read once, mixed by the sound card's own thread. Without a sound card, or without sounds, everything stays silent. */
#ifndef GAME_FRONT_AUDIO_H
#define GAME_FRONT_AUDIO_H

#include <SDL.h>
#include <stdatomic.h>

#include "sim/game.h"

/** Sounds that are not the game's: X(NAME, "file stem", loops). */
#define AUDIO_SOUNDS(X)                                                                                                        \
    X(MENU_MOVE, "menu_move")                                                                                                  \
    X(MENU_SELECT, "menu_select")                                                                                              \
    X(MENU_BACK, "menu_back")                                                                                                  \
    X(TITLE, "title")                                                                                                          \
    X(NIGHT, "night")
enum {
#define AUDIO_ENUM(name, file) AUDIO_##name,
    AUDIO_SOUNDS(AUDIO_ENUM)
#undef AUDIO_ENUM
        AUDIO_OWN_COUNT,
    AUDIO_VARIANTS = 4,
    AUDIO_KINDS = AUDIO_OWN_COUNT + GAME_SOUND_COUNT,
    AUDIO_VOICES = 32,
    AUDIO_PLACES = 12, /**< sounds that go on somewhere, heard at once */
    AUDIO_RING = 256   /**< a power of two */
};

/** 16 bits, mono. */
typedef struct AudioClip {
    int16_t *samples;
    uint32_t count, rate;
} AudioClip;

/** What the game's thread tells the mixer. */
typedef struct AudioCommand {
    enum { AUDIO_PLAY, AUDIO_PLACE, AUDIO_LOOP, AUDIO_VOLUME, AUDIO_SILENCE } what;
    const AudioClip *clip;
    float gain, pan, muffled; /**< pan -1 left .. 1 right; muffled 0..1; of VOLUME gain is sounds', pan is music's */
    uint32_t slot; /**< of LOOP: a loop replaces the one of its slot; clip NULL ends it. Of PLACE: the speaker's id */
} AudioCommand;

enum { AUDIO_SLOT_MUSIC, AUDIO_SLOT_AMBIENT, AUDIO_SLOTS };

typedef struct AudioVoice {
    const AudioClip *clip;
    double at, step;                /**< sample; samples of the clip a sample of the card */
    float left, right, smooth, low; /**< gains; the low-pass's coefficient and state */
    float fade, fade_step;          /**< loops come and go softly */
    bool loops;
    /* Of a place: the gains that it goes to, which speaker it is, and frames of the card left to hear of it again. */
    float left_to, right_to, smooth_to;
    uint32_t id;
    int32_t stays;
} AudioVoice;

typedef struct Audio {
    AudioClip clips[AUDIO_KINDS][AUDIO_VARIANTS];
    uint32_t variants[AUDIO_KINDS], turn[AUDIO_KINDS];
    uint32_t missing; /**< kinds without a file */
    SDL_AudioDeviceID device;
    int rate;
    /* A ring with one writer (the game) and one reader (the card's thread). */
    AudioCommand ring[AUDIO_RING];
    atomic_uint head, tail;
    /* The mixer's own: */
    AudioVoice voices[AUDIO_VOICES], places[AUDIO_PLACES], loops[AUDIO_SLOTS];
    float volume, music;
    atomic_uint frames; /**< mixed so far, in thousands: for tests */
} Audio;

/** Reads the sounds of `folder`; opens no device. Missing files are counted, not fatal. */
void audio_load(Audio *audio, const char *folder);
/** Opens the usual sound card; false if there is none (SDL_GetError says why). */
bool audio_open(Audio *audio);
void audio_close(Audio *audio); /**< the device alone */
void audio_free(Audio *audio);

void audio_volume(Audio *audio, double volume, double music);
/** One of AUDIO_*, straight ahead. */
void audio_play(Audio *audio, int kind);
void audio_loop(Audio *audio, uint32_t slot, int kind); /**< kind < 0: none */
/** A sound of the game, for ears at `ear_ws` that look along yaw. */
void audio_hear(Audio *audio, const GameSound *sound, EnfVec3 ear_ws, double yaw_deg);
/** What a place sounds like. One that goes on ends softly when it is not told of for half a second. */
void audio_hear_speaker(Audio *audio, const GameSpeaker *speaker, EnfVec3 ear_ws, double yaw_deg);
/** The mixer: `frames` of left and right. The card's thread calls it; a test may, where there is no device. */
void audio_mix(Audio *audio, float *out, int frames);
void audio_silence(Audio *audio);

#endif
