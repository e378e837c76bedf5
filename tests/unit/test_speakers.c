/* What sounds by itself: clocks strike what they show, water goes on, all of it heard by way of the doorway, and none of it changes the game. */
#include "harness/harness.h"
#include "scenes/night.h"

#include "sim/game.h"

#include <math.h>
#include <string.h>

typedef struct Night {
    EnfNight night;
    Game *game;
    uint32_t heard[GAME_SOUND_COUNT];
    GameSpeaker last[GAME_SOUND_COUNT]; /* of each kind */
} Night;

static void open_night(Night *n, bool door, bool lift) {
    memset(n, 0, sizeof *n);
    const EnfNightDef def = {.sounds = true, .door = door, .lift = lift};
    const GameDef game = game_def_default();
    EnfError error = {ENF_OK, 0, "", ""};
    assert_true(enf_night_create(&n->night, &def, &error));
    assert_int_equal(game_create(&n->game, n->night.map, &game, NULL, &error), ENF_OK);
}

static void close_night(Night *n) {
    game_destroy(n->game);
    enf_night_destroy(&n->night);
}

static void listen(Night *n, uint32_t ticks, const EnfInput *input) {
    for (uint32_t i = 0; i < ticks; i++) {
        uint32_t count;
        game_step(n->game, input);
        const GameSpeaker *speakers = game_speakers(n->game, &count);
        for (uint32_t k = 0; k < count; k++) {
            n->heard[speakers[k].sound.kind]++;
            n->last[speakers[k].sound.kind] = speakers[k];
            assert_true(speakers[k].sound.gain >= GAME_GAIN_LEAST && speakers[k].sound.gain <= speakers[k].sound.loudness);
        }
    }
}

static const EnfInput nothing;

static void test_a_clock_strikes_what_it_shows(void **state) {
    (void)state;
    Night n;
    open_night(&n, false, false);
    listen(&n, 119, &nothing);
    assert_int_equal(n.heard[GAME_SOUND_CLOCK_TICKS] + n.heard[GAME_SOUND_CLOCK_TOCKS], 1);
    assert_int_equal(n.heard[GAME_SOUND_CLOCK_CHIMES], 0);
    listen(&n, 60 * 20, &nothing); /* one o'clock: a chime, and one stroke */
    assert_int_equal(n.heard[GAME_SOUND_CLOCK_CHIMES], 1);
    assert_int_equal(n.heard[GAME_SOUND_CLOCK_STRIKES], 1);
    assert_int_equal(n.heard[GAME_SOUND_CLOCK_TICKS] + n.heard[GAME_SOUND_CLOCK_TOCKS], 21);
    assert_true(n.heard[GAME_SOUND_CLOCK_TICKS] >= 10 && n.heard[GAME_SOUND_CLOCK_TOCKS] >= 10);
    close_night(&n);
}

/* The player stands in the west: the water is there, the clock comes from the doorway, and a door that shuts muffles it. */
static void test_they_are_heard_by_way_of_the_doorway(void **state) {
    (void)state;
    double gain[2] = {0.0, 0.0};
    for (int shut = 0; shut < 2; shut++) {
        Night n;
        open_night(&n, shut, false);
        listen(&n, 121, &nothing);
        const GameSpeaker *water = &n.last[GAME_SOUND_FOUNTAIN], *clock = &n.last[GAME_SOUND_CLOCK_CHIMES];
        assert_true(water->loops && water->sound.muffled <= 0.0);
        assert_true(fabs(water->sound.apparent_ws.x - 4.0) < 1e-9 && fabs(water->sound.apparent_ws.z - 7.0) < 1e-9);
        assert_int_equal(n.heard[GAME_SOUND_FOUNTAIN], 20); /* ten times a second */
        gain[shut] = clock->sound.gain;
        if (n.heard[GAME_SOUND_CLOCK_CHIMES]) {
            assert_false(clock->loops);
            assert_true(clock->id != water->id);
            assert_true(fabs(clock->sound.apparent_ws.x - 8.0) < 1e-6 && fabs(clock->sound.apparent_ws.z - 4.0) < 1e-6);
        }
        close_night(&n);
    }
    assert_true(gain[0] > 0.0);
    assert_true(gain[1] < gain[0]);
}

static void test_an_elevator_hums_on_its_way(void **state) {
    (void)state;
    Night n;
    open_night(&n, false, true);
    EnfInput input = nothing;
    /* From (2, 0, 4) to the plate about (6, 0, 7): turn, walk, stand, use. */
    input.forward = 0, input.yaw = (int32_t)(-127.0 * ENF_INPUT_DEGREE);
    listen(&n, 1, &input);
    input = nothing;
    input.forward = 32767;
    listen(&n, 90, &input);
    assert_int_equal(n.heard[GAME_SOUND_LIFT_HUMS], 0);
    input = nothing;
    input.pitch = (int32_t)(-80.0 * ENF_INPUT_DEGREE);
    input.buttons = ENF_BUTTON_USE;
    listen(&n, 1, &input);
    listen(&n, 30, &nothing);
    assert_true(n.heard[GAME_SOUND_LIFT_HUMS] >= 4);
    assert_true(n.last[GAME_SOUND_LIFT_HUMS].loops);
    listen(&n, 600, &nothing);
    uint32_t hums = n.heard[GAME_SOUND_LIFT_HUMS];
    listen(&n, 60, &nothing);
    assert_int_equal(n.heard[GAME_SOUND_LIFT_HUMS], hums); /* it has arrived */
    close_night(&n);
}

static void test_listening_changes_nothing(void **state) {
    (void)state;
    Night heard, unheard;
    open_night(&heard, true, true);
    open_night(&unheard, true, true);
    EnfTestRng rng = enf_test_rng(1);
    for (int i = 0; i < 1200; i++) {
        EnfInput input = nothing;
        input.forward = (int16_t)(enf_test_below(&rng, 65535) - 32767);
        input.yaw = (int32_t)(enf_test_double(&rng, -20.0, 20.0) * ENF_INPUT_DEGREE);
        input.buttons = enf_test_chance(&rng, 10) ? ENF_BUTTON_USE : 0;
        listen(&heard, 1, &input);
        game_step(unheard.game, &input);
        assert_true(game_hash(heard.game) == game_hash(unheard.game));
    }
    close_night(&heard);
    close_night(&unheard);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_a_clock_strikes_what_it_shows),
    cmocka_unit_test(test_they_are_heard_by_way_of_the_doorway),
    cmocka_unit_test(test_an_elevator_hums_on_its_way),
    cmocka_unit_test(test_listening_changes_nothing),
};
ENF_TEST_MAIN(tests)
