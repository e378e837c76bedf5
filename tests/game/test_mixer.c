/* What is heard of a place that sounds by itself: mixed here, without a sound card. */
#include "harness/harness.h"

#include "front/audio.h"

#include <math.h>
#include <stdio.h>

static float loudest(Audio *audio, int blocks, float side[2]) {
    enum { FRAMES = 441 };
    float out[2 * FRAMES], most = 0.0f;
    side[0] = side[1] = 0.0f;
    for (int b = 0; b < blocks; b++) {
        audio_mix(audio, out, FRAMES);
        for (int i = 0; i < 2 * FRAMES; i++) {
            float size = fabsf(out[i]);
            side[i % 2] = size > side[i % 2] ? size : side[i % 2];
            most = size > most ? size : most;
        }
    }
    return most;
}

static void test_a_place_sounds_until_it_is_left(void **state) {
    (void)state;
    static Audio audio;
    float side[2];
    char folder[1024];
    snprintf(folder, sizeof folder, "%s", enf_test_source_path("assets/sounds"));
    audio_load(&audio, folder);
    assert_int_equal(audio.missing, 0);
    audio.device = 1; /* nobody's: it is mixed here */
    audio.rate = 44100;
    audio_volume(&audio, 1.0, 1.0);
    GameSpeaker water = {{GAME_SOUND_FOUNTAIN, {2, 0, 0}, 0.6, 0.5, {2, 0, 0}, 0.0}, 3, true};
    for (int i = 0; i < 20; i++) {
        audio_hear_speaker(&audio, &water, enf_v3(0, 0, 0), 0.0);
        loudest(&audio, 10, side);
    }
    assert_true(side[1] > 0.02f && side[1] > 3.0f * side[0]); /* it is on the right */
    for (int i = 0; i < 20; i++) {
        audio_hear_speaker(&audio, &water, enf_v3(0, 0, 0), 180.0);
        loudest(&audio, 10, side);
    }
    assert_true(side[0] > 3.0f * side[1]); /* turned round: on the left, and it is the same voice */
    uint32_t voices = 0;
    for (int i = 0; i < AUDIO_PLACES; i++) {
        voices += audio.places[i].clip != NULL;
    }
    assert_int_equal(voices, 1);
    loudest(&audio, 150, side); /* nobody speaks of it any more */
    assert_true(loudest(&audio, 10, side) <= 0.0f);
    audio.device = 0;
    audio_free(&audio);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_a_place_sounds_until_it_is_left),
};
ENF_TEST_MAIN(tests)
