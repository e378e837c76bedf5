/* Makes what is heard. The callback takes no lock, calls no heap and reads no file: commands come through a ring. */
#include "front/audio.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* How much of the way to its new gains a voice goes in a frame of the card: some 20 ms. */
#define GLIDE 0.001f

enum { WAV_MAX = 64 << 20, CARD_RATE = 44100, CARD_SAMPLES = 1024 };

/* ---- files ------------------------------------------------------------------------------------------------------ */

static const char *file_of(int kind) {
    static const char *const own[AUDIO_OWN_COUNT] = {
#define AUDIO_FILE(name, file) file,
        AUDIO_SOUNDS(AUDIO_FILE)
#undef AUDIO_FILE
    };
    return kind < AUDIO_OWN_COUNT ? own[kind] : game_sound_file((GameSoundKind)(kind - AUDIO_OWN_COUNT));
}

/* SDL reads the file, whatever its format, and converts it. */
static bool read_clip(AudioClip *clip, const char *path) {
    SDL_AudioSpec spec;
    Uint8 *data = NULL;
    Uint32 size = 0;
    if (!SDL_LoadWAV(path, &spec, &data, &size)) {
        return false;
    }
    SDL_AudioCVT convert;
    bool good = size <= WAV_MAX && spec.freq > 0 &&
                SDL_BuildAudioCVT(&convert, spec.format, spec.channels, spec.freq, AUDIO_S16SYS, 1, spec.freq) >= 0;
    if (good) {
        convert.len = (int)size;
        size_t room = (size_t)size * (size_t)convert.len_mult;
        convert.buf = SDL_malloc(room);
        if (convert.buf) {
            memcpy(convert.buf, data, size);
        }
        good = convert.buf && (!convert.needed || SDL_ConvertAudio(&convert) == 0);
        size_t bytes = good ? (size_t)(convert.needed ? convert.len_cvt : convert.len) : 0;
        clip->count = (uint32_t)(bytes / sizeof *clip->samples);
        clip->rate = (uint32_t)spec.freq;
        clip->samples = enf_alloc(NULL, clip->count, sizeof *clip->samples);
        good = clip->samples != NULL;
        if (good) {
            memcpy(clip->samples, convert.buf, (size_t)clip->count * sizeof *clip->samples);
        }
        SDL_free(convert.buf);
    }
    SDL_FreeWAV(data);
    return good;
}

static void load_kind(Audio *audio, int kind, const char *folder) {
    char path[1200];
    snprintf(path, sizeof path, "%s/%s.wav", folder, file_of(kind));
    if (read_clip(&audio->clips[kind][0], path)) {
        audio->variants[kind] = 1;
        return;
    }
    for (uint32_t i = 0; i < AUDIO_VARIANTS; i++) {
        snprintf(path, sizeof path, "%s/%s_%u.wav", folder, file_of(kind), i + 1);
        if (!read_clip(&audio->clips[kind][audio->variants[kind]], path)) {
            break;
        }
        audio->variants[kind]++;
    }
    audio->missing += audio->variants[kind] == 0;
}

void audio_load(Audio *audio, const char *folder) {
    memset(audio, 0, sizeof *audio);
    for (int kind = 0; kind < AUDIO_KINDS; kind++) {
        load_kind(audio, kind, folder);
    }
}

void audio_free(Audio *audio) {
    audio_close(audio);
    for (int kind = 0; kind < AUDIO_KINDS; kind++) {
        for (int i = 0; i < AUDIO_VARIANTS; i++) {
            AudioClip *clip = &audio->clips[kind][i];
            enf_free(NULL, clip->samples, clip->count, sizeof *clip->samples);
        }
    }
    memset(audio, 0, sizeof *audio);
}

/* ---- the mixer, on the card's thread ---------------------------------------------------------------------------- */

static void begin_voice(Audio *audio, AudioVoice *voice, const AudioCommand *command, bool loops) {
    memset(voice, 0, sizeof *voice);
    voice->clip = command->clip;
    voice->step = command->clip ? (double)command->clip->rate / (double)audio->rate : 0.0;
    float right = 0.5f * (command->pan + 1.0f);
    voice->left = command->gain * (1.0f - right * right);
    voice->right = command->gain * (1.0f - (1.0f - right) * (1.0f - right));
    voice->smooth = 1.0f - 0.93f * command->muffled; /* about 500 Hz at the most muffled */
    voice->loops = loops;
    voice->fade = loops ? 0.0f : 1.0f;
    voice->fade_step = loops ? 1.0f / (float)audio->rate : 0.0f;
    voice->left_to = voice->left;
    voice->right_to = voice->right;
    voice->smooth_to = voice->smooth;
}

/* Where the speaker sounds already, it goes softly to what it is heard as now. */
static void begin_place(Audio *audio, const AudioCommand *command) {
    AudioVoice *place = NULL, told;
    begin_voice(audio, &told, command, true);
    for (int i = 0; i < AUDIO_PLACES; i++) {
        AudioVoice *p = &audio->places[i];
        if (p->clip == command->clip && p->id == command->slot) {
            place = p;
            break;
        }
        place = !p->clip ? p : place;
    }
    if (!place) {
        return; /* more than can be told apart */
    }
    if (place->clip) {
        place->left_to = told.left;
        place->right_to = told.right;
        place->smooth_to = told.smooth;
        place->fade_step = fabsf(told.fade_step);
    } else {
        *place = told;
        place->id = command->slot;
    }
    place->stays = audio->rate / 2;
}

/* The voice that is free, or nearest to its end. */
static AudioVoice *free_voice(Audio *audio) {
    AudioVoice *best = &audio->voices[0];
    double least = 1e30;
    for (int i = 0; i < AUDIO_VOICES; i++) {
        AudioVoice *voice = &audio->voices[i];
        if (!voice->clip) {
            return voice;
        }
        double left = (double)voice->clip->count - voice->at;
        if (left < least) {
            least = left;
            best = voice;
        }
    }
    return best;
}

static void obey(Audio *audio, const AudioCommand *command) {
    switch (command->what) {
    case AUDIO_PLAY:
        begin_voice(audio, free_voice(audio), command, false);
        break;
    case AUDIO_PLACE:
        begin_place(audio, command);
        break;
    case AUDIO_LOOP:
        if (command->slot < AUDIO_SLOTS && audio->loops[command->slot].clip != command->clip) {
            begin_voice(audio, &audio->loops[command->slot], command, true);
        }
        break;
    case AUDIO_VOLUME:
        audio->volume = command->gain;
        audio->music = command->pan;
        break;
    case AUDIO_SILENCE:
        memset(audio->voices, 0, sizeof audio->voices);
        memset(audio->places, 0, sizeof audio->places);
        break;
    }
}

static void mix_voice(AudioVoice *voice, float volume, float *out, int frames) {
    const AudioClip *clip = voice->clip;
    for (int i = 0; i < frames && voice->clip; i++) {
        uint32_t at = (uint32_t)voice->at;
        if (at >= clip->count) {
            if (!voice->loops) {
                voice->clip = NULL;
                return;
            }
            voice->at -= (double)clip->count;
            at = (uint32_t)voice->at;
        }
        uint32_t next = at + 1 < clip->count ? at + 1 : voice->loops ? 0 : at;
        float share = (float)(voice->at - (double)at);
        float sample = (float)clip->samples[at] * (1.0f - share) + (float)clip->samples[next] * share;
        voice->low += voice->smooth * (sample - voice->low);
        float value = voice->low * (volume / 32768.0f) * voice->fade;
        float fade = voice->fade + voice->fade_step;
        voice->fade = fade > 1.0f ? 1.0f : fade < 0.0f ? 0.0f : fade;
        voice->left += GLIDE * (voice->left_to - voice->left);
        voice->right += GLIDE * (voice->right_to - voice->right);
        voice->smooth += GLIDE * (voice->smooth_to - voice->smooth);
        out[2 * i] += value * voice->left;
        out[2 * i + 1] += value * voice->right;
        voice->at += voice->step;
    }
}

/* A place that is not told of any more fades in half a second. */
static void mix_place(Audio *audio, AudioVoice *place, float *out, int frames) {
    place->stays -= place->stays > 0 ? frames : 0;
    if (place->stays <= 0) {
        place->fade_step = -2.0f / (float)audio->rate;
    }
    mix_voice(place, audio->volume, out, frames);
    if (place->stays <= 0 && place->fade <= 0.0f) {
        place->clip = NULL;
    }
}

void audio_mix(Audio *audio, float *out, int frames) {
    memset(out, 0, (size_t)frames * 2 * sizeof *out);
    unsigned tail = atomic_load_explicit(&audio->tail, memory_order_relaxed);
    while (tail != atomic_load_explicit(&audio->head, memory_order_acquire)) {
        obey(audio, &audio->ring[tail % AUDIO_RING]);
        atomic_store_explicit(&audio->tail, ++tail, memory_order_release);
    }
    for (int i = 0; i < AUDIO_VOICES; i++) {
        mix_voice(&audio->voices[i], audio->volume, out, frames);
    }
    for (int i = 0; i < AUDIO_PLACES; i++) {
        mix_place(audio, &audio->places[i], out, frames);
    }
    for (int i = 0; i < AUDIO_SLOTS; i++) {
        mix_voice(&audio->loops[i], i == AUDIO_SLOT_MUSIC ? audio->music * audio->volume : audio->volume, out, frames);
    }
    for (int i = 0; i < 2 * frames; i++) {
        float x = out[i];
        out[i] = x > 1.0f ? 1.0f : x < -1.0f ? -1.0f : x;
    }
    atomic_fetch_add_explicit(&audio->frames, (unsigned)frames, memory_order_relaxed);
}

static void SDLCALL mix(void *user, Uint8 *stream, int size) {
    float *out = (float *)(void *)stream;
    audio_mix(user, out, size / (int)(2 * sizeof *out));
}

bool audio_open(Audio *audio) {
    SDL_AudioSpec wanted, got;
    memset(&wanted, 0, sizeof wanted);
    wanted.freq = CARD_RATE;
    wanted.format = AUDIO_F32SYS;
    wanted.channels = 2;
    wanted.samples = CARD_SAMPLES;
    wanted.callback = mix;
    wanted.userdata = audio;
    audio->rate = CARD_RATE;
    audio->device = SDL_OpenAudioDevice(NULL, 0, &wanted, &got, 0);
    if (audio->device) {
        SDL_PauseAudioDevice(audio->device, 0);
    }
    return audio->device != 0;
}

void audio_close(Audio *audio) {
    if (audio->device) {
        SDL_CloseAudioDevice(audio->device);
        audio->device = 0;
    }
    atomic_store(&audio->tail, atomic_load(&audio->head));
}

/* ---- commands ----------------------------------------------------------------------------------------------------- */

/* A full ring drops the command: a sound less, and never a wait. */
static void tell(Audio *audio, const AudioCommand *command) {
    unsigned head = atomic_load_explicit(&audio->head, memory_order_relaxed);
    if (!audio->device || head - atomic_load_explicit(&audio->tail, memory_order_acquire) >= AUDIO_RING) {
        return;
    }
    audio->ring[head % AUDIO_RING] = *command;
    atomic_store_explicit(&audio->head, head + 1, memory_order_release);
}

/* Variants in turn: no step sounds like the one before. */
static const AudioClip *next_clip(Audio *audio, int kind) {
    uint32_t count = audio->variants[kind];
    return count ? &audio->clips[kind][audio->turn[kind]++ % count] : NULL;
}

void audio_volume(Audio *audio, double volume, double music) {
    AudioCommand command = {.what = AUDIO_VOLUME, .gain = (float)volume, .pan = (float)music};
    tell(audio, &command);
}

void audio_play(Audio *audio, int kind) {
    AudioCommand command = {.what = AUDIO_PLAY, .clip = next_clip(audio, kind), .gain = 1.0f};
    if (command.clip) {
        tell(audio, &command);
    }
}

void audio_loop(Audio *audio, uint32_t slot, int kind) {
    AudioCommand command = {.what = AUDIO_LOOP, .gain = 1.0f, .slot = slot};
    command.clip = kind >= 0 ? next_clip(audio, kind) : NULL;
    tell(audio, &command);
}

void audio_silence(Audio *audio) {
    AudioCommand command = {.what = AUDIO_SILENCE};
    tell(audio, &command);
}

/* A sound of the game as the ears at `ear_ws` have it; no clip: there is none, or it is too faint. */
static AudioCommand as_heard(Audio *audio, const GameSound *sound, EnfVec3 ear_ws, double yaw_deg) {
    AudioCommand command = {.what = AUDIO_PLAY, .gain = (float)sound->gain, .muffled = (float)sound->muffled};
    EnfVec3 to = enf_sub(sound->apparent_ws, ear_ws);
    double distance = enf_length(to), yaw = yaw_deg * (ENF_PI / 180.0);
    if (distance > 0.3) {
        double right = enf_cos(yaw) * to.x - enf_sin(yaw) * to.z;
        command.pan = (float)(0.85 * right / distance);
    }
    if (sound->gain >= GAME_GAIN_LEAST) {
        command.clip = next_clip(audio, AUDIO_OWN_COUNT + (int)sound->kind);
    }
    return command;
}

void audio_hear(Audio *audio, const GameSound *sound, EnfVec3 ear_ws, double yaw_deg) {
    AudioCommand command = as_heard(audio, sound, ear_ws, yaw_deg);
    if (command.clip) {
        tell(audio, &command);
    }
}

void audio_hear_speaker(Audio *audio, const GameSpeaker *speaker, EnfVec3 ear_ws, double yaw_deg) {
    AudioCommand command = as_heard(audio, &speaker->sound, ear_ws, yaw_deg);
    command.what = speaker->loops ? AUDIO_PLACE : AUDIO_PLAY;
    command.slot = speaker->id;
    if (command.clip) {
        tell(audio, &command);
    }
}
