/* The rules of the game in two rooms: won, lost, doors and their portals, keys, elevator, sight, hearing, restart, heap, hashes. */
#include "unit/night_play.h"

#include <math.h>
#include <string.h>

static const char THEFT[] = "enfbot 1\nrun on\ntake vase\ngoto exit\nexpect won 1\n";
static EnfInput inputs[MOST];
static uint64_t hashes[MOST];

static void test_a_theft_is_won(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.door = true}, false);
    const GameState *shown = game_state(play.game);
    assert_int_equal(shown->exhibits, 1);
    assert_int_equal(shown->wanted, 1);
    assert_true(run(&play, THEFT) > 60);
    assert_int_equal(shown->phase, GAME_WON);
    assert_int_equal(shown->score, 3);
    assert_int_equal(shown->delivered, 1);
    assert_int_equal(shown->carried, 0);
    assert_int_equal(play.heard[GAME_SOUND_WON], 1);
    assert_int_equal(play.heard[GAME_SOUND_TAKE], 1);
    assert_true(play.heard[GAME_SOUND_STEP_STONE] + play.heard[GAME_SOUND_STEP_WOOD] > 8);
    wait(&play, 60);
    EnfVec3 eye = shown->eye_ws;
    const EnfInput ahead = {32767, 0, 0, 0, 0};
    for (int i = 0; i < 60; i++) {
        step(&play, &ahead);
    }
    assert_true(enf_length(enf_sub(shown->eye_ws, eye)) == 0.0); /* it is over */
    close_play(&play);
}

static void test_a_door_opens_its_portal_and_shuts_it(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.door = true}, false);
    assert_false(enf_portals_is_open(game_portals(play.game), play.night.portal));
    run(&play, "enfbot 1\ngoto point 6.5 0 4\npress door\n");
    assert_true(enf_portals_is_open(game_portals(play.game), play.night.portal)); /* with the first tick of its turn */
    assert_int_equal(play.heard[GAME_SOUND_DOOR_OPEN], 1);
    run(&play, "enfbot 1\ngoto point 2 0 4\n");
    int ticks = 0;
    for (; play.heard[GAME_SOUND_DOOR_SHUT] == 0 && ticks < 1200; ticks++) {
        assert_true(enf_portals_is_open(game_portals(play.game), play.night.portal)); /* while it gapes */
        wait(&play, 1);
    }
    assert_true(ticks < 1200);
    assert_false(enf_portals_is_open(game_portals(play.game), play.night.portal));
    close_play(&play);
}

static void test_a_door_does_not_shut_on_somebody(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.door = true}, false);
    run(&play, "enfbot 1\ngoto point 6.5 0 4\npress door\nwait 1.5\ngoto point 7.8 0 4\n");
    wait(&play, 1200);
    assert_int_equal(play.heard[GAME_SOUND_DOOR_SHUT], 0);
    assert_true(enf_portals_is_open(game_portals(play.game), play.night.portal));
    close_play(&play);
}

/* The middle of a leaf in the plane x = 8 after a script, along x. */
static double leaf_after(const char *script) {
    Play play;
    open_play(&play, (EnfNightDef){.door = true, .swings = true}, false);
    run(&play, script);
    uint32_t door = ENF_NONE;
    for (uint32_t i = 0; i < play.night.map->movers_count; i++) {
        door = play.night.map->movers[i].kind == ENF_MOVER_HINGE ? i : door;
    }
    assert_true(door != ENF_NONE);
    EnfBox3f box = enf_world_box(game_world(play.game), door);
    close_play(&play);
    return 0.5 * ((double)box.min.x + (double)box.max.x);
}

static void test_a_door_swings_away_from_who_opens_it(void **state) {
    (void)state;
    assert_true(leaf_after("enfbot 1\ngoto point 6.5 0 4\npress door\nwait 1\n") > 8.3);
    assert_true(leaf_after("enfbot 1\ngoto point 12 0 4\ngoto point 9.5 0 4\nwait 8\npress door\nwait 1\n") < 7.7);
    /* Close by, with an eye on the sill: it is the door ahead that is meant. */
    assert_true(leaf_after("enfbot 1\ngoto point 7.4 0 4\nlook at 8 0 4\nuse\nwait 1\n") > 8.3);
}

static void test_a_lock_wants_its_key(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.door = true, .locked = true}, false);
    run(&play, "enfbot 1\ngoto point 6.5 0 4\npress door\nwait 0.5\n");
    assert_int_equal(play.heard[GAME_SOUND_DOOR_LOCKED], 1);
    assert_false(enf_portals_is_open(game_portals(play.game), play.night.portal));
    run(&play, "enfbot 1\ntake key\ntake vase\ngoto exit\nexpect won 1\n");
    assert_int_equal(game_state(play.game)->exhibits, 1); /* a key is none */
    assert_int_equal(play.heard[GAME_SOUND_TAKE_KEY], 1);
    assert_int_equal(play.heard[GAME_SOUND_DOOR_UNLOCKED], 1);
    close_play(&play);
}

static void test_a_bot_says_why_it_fails(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.door = true, .locked = true}, false);
    EnfError error = {ENF_OK, 0, "", ""};
    GameBot *bot;
    const char script[] = "enfbot 1\n\n# no key\ntake vase\n";
    assert_int_equal(game_bot_create(&bot, play.game, script, sizeof script - 1, NULL, &error), ENF_OK);
    EnfInput input;
    GameBotNews news = GAME_BOT_GOES_ON;
    for (int i = 0; i < MOST && (news = game_bot_next(bot, &input, &error)) == GAME_BOT_GOES_ON; i++) {
        step(&play, &input);
    }
    assert_int_equal(news, GAME_BOT_FAILED);
    assert_non_null(strstr(error.message, "line 4"));
    assert_non_null(strstr(error.message, "locked"));
    game_bot_destroy(bot);
    close_play(&play);
}

static void test_an_elevator_carries(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.lift = true}, false);
    run(&play, "enfbot 1\ngoto point 6 0 7\nlook by 0 -80\nuse\n");
    wait(&play, 240);
    const GameState *shown = game_state(play.game);
    assert_true(fabs(shown->eye_ws.y - (2.125 + 1.63)) < 0.05);
    assert_int_equal(play.heard[GAME_SOUND_LIFT], 1);
    assert_int_equal(play.heard[GAME_SOUND_LIFT_STOPS], 1);
    assert_int_equal(play.heard[GAME_SOUND_LIFT_RINGS], 1);
    close_play(&play);
    open_play(&play, (EnfNightDef){.lift = true}, false);
    run(&play, "enfbot 1\npress button\nwait 3\n");
    assert_int_equal(play.heard[GAME_SOUND_SWITCH], 1);
    assert_int_equal(play.heard[GAME_SOUND_LIFT_STOPS], 1);
    close_play(&play);
}

static void test_a_guard_catches_whom_it_sees(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.guard = true}, false);
    run(&play, "enfbot 1\nwait 5\ngoto point 11.5 0 4\nexpect lost 40\n");
    assert_int_equal(play.heard[GAME_SOUND_LOST], 1);
    assert_int_equal(play.heard[GAME_SOUND_CAUGHT], 1);
    assert_true(play.heard[GAME_SOUND_GUARD_SEES] > 0);
    close_play(&play);
    open_play(&play, (EnfNightDef){.guard = true}, true);
    run(&play, "enfbot 1\nwait 5\ngoto point 10 0 4\nwait 40\nexpect playing 1\n");
    close_play(&play);
}

/* The player stands three metres behind a shut door, in the guard's line, and out of hearing: he does not move. */
static void test_nobody_is_seen_through_a_shut_door(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.door = true, .guard = true}, false);
    wait(&play, 3600);
    assert_int_equal(game_state(play.game)->phase, GAME_PLAYING);
    assert_true(game_state(play.game)->noticed == 0.0);
    close_play(&play);
}

static void test_noise_brings_a_guard(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.door = true, .guard = true}, false);
    for (int i = 0; i < 12 && play.heard[GAME_SOUND_GUARD_WONDERS] == 0; i++) { /* up and down behind the shut door */
        run(&play, "enfbot 1\nrun on\ngoto point 7 0 2\ngoto point 7 0 6\n");
    }
    uint32_t wonders = play.heard[GAME_SOUND_GUARD_WONDERS];
    assert_true(wonders > 0);
    close_play(&play);
    open_play(&play, (EnfNightDef){.door = true, .guard = true}, false);
    for (int i = 0; i < 4; i++) {
        run(&play, "enfbot 1\ncrouch on\ngoto point 7 0 2\ngoto point 7 0 6\n");
    }
    assert_int_equal(play.heard[GAME_SOUND_GUARD_WONDERS], 0);
    close_play(&play);
}

static void test_sounds_come_from_the_doorway(void **state) {
    (void)state;
    Play play;
    /* The lift stops in the west while the player is in the east. */
    open_play(&play, (EnfNightDef){.lift = true}, true);
    run(&play, "enfbot 1\nrun on\ngoto point 7 0 6\npress button\ngoto cell east-room\nlook by 1 0\n");
    bool found = false;
    for (int i = 0; i < 600 && !found; i++) {
        uint32_t count;
        const GameSound *sounds = game_sounds(play.game, &count);
        for (uint32_t k = 0; k < count; k++) {
            if (sounds[k].kind == GAME_SOUND_LIFT_STOPS && game_state(play.game)->cell == play.night.east) {
                found = true;
                assert_true(fabs(sounds[k].apparent_ws.x - 8.0) < 1e-6 && fabs(sounds[k].apparent_ws.z - 4.0) < 1e-6);
                assert_true(sounds[k].gain > 0.0 && sounds[k].gain < sounds[k].loudness);
                assert_true(sounds[k].muffled > 0.0);
            }
        }
        if (!found) {
            wait(&play, 1);
        }
    }
    assert_true(found);
    close_play(&play);
}

/* The same inputs give the same game: in a new one, and in one that was restarted. */
static void test_games_repeat_bit_for_bit(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.door = true, .guard = true, .lamps = true}, false);
    GameField before[GAME_FIELDS_MAX], after[GAME_FIELDS_MAX];
    uint32_t fields = game_fields(play.game, before);
    uint64_t start = game_hash(play.game);
    uint32_t ticks = run_traced(&play, "enfbot 1\nwait 5\nrun on\ngoto point 9 0 6\ngoto point 10 0 4\nwait 30\nwalk 1 0 2\n",
                                inputs, hashes, MOST);
    for (int again = 0; again < 2; again++) {
        if (again) {
            close_play(&play);
            open_play(&play, (EnfNightDef){.door = true, .guard = true, .lamps = true}, false);
        } else {
            game_restart(play.game);
        }
        game_fields(play.game, after);
        for (uint32_t i = 0; i < fields; i++) {
            if (before[i].hash != after[i].hash) {
                fail_msg("the start differs in \"%s\"", before[i].name);
            }
        }
        assert_true(game_hash(play.game) == start);
        for (uint32_t i = 0; i < ticks; i++) {
            step(&play, &inputs[i]);
            if (game_hash(play.game) != hashes[i]) {
                fail_msg("tick %u of %u differs", i, ticks);
            }
        }
    }
    close_play(&play);
}

static void test_no_heap_in_warm_ticks_and_restarts(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.door = true, .guard = true, .lift = true, .lamps = true}, false);
    uint32_t ticks = run_traced(&play, "enfbot 1\nrun on\ntake vase\ngoto point 4 0 4\ndrop\nwait 1\n", inputs, hashes, MOST);
    uint64_t calls = 0;
    size_t bytes = 0;
    uint32_t rounds = enf_test_rounds(100, 400), done = 0;
    for (uint32_t round = 0; round < rounds || done < 36000; round++) {
        game_restart(play.game);
        for (uint32_t i = 0; i < ticks; i++) {
            step(&play, &inputs[i]);
        }
        done += ticks;
        if (round == 0) { /* warm */
            calls = play.purse.calls;
            bytes = play.purse.lent;
        }
    }
    for (int i = 0; i < 1000; i++) {
        game_restart(play.game);
    }
    assert_int_equal(play.purse.calls, calls);
    assert_int_equal(play.purse.lent, bytes);
    close_play(&play);
}

static void test_memory_that_runs_out_is_an_error(void **state) {
    (void)state;
    EnfNight night;
    EnfError error = {ENF_OK, 0, "", ""};
    EnfNightDef def = {.door = true, .guard = true};
    assert_true(enf_night_create(&night, &def, &error));
    GameDef game_def = game_def_default();
    EnfResult result = ENF_ERROR_MEMORY;
    uint32_t calls = 0;
    for (; result != ENF_OK && calls < 1000; calls++) {
        Purse purse = purse_with(calls);
        EnfAllocator allocator = purse_allocator(&purse);
        Game *game;
        result = game_create(&game, night.map, &game_def, &allocator, &error);
        assert_int_equal(result, purse.refused ? ENF_ERROR_MEMORY : ENF_OK);
        assert_int_equal(game != NULL, result == ENF_OK);
        game_destroy(game);
        purse_assert_whole(&purse);
    }
    assert_true(calls > 20 && calls < 1000);
    enf_night_destroy(&night);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_a_theft_is_won),
    cmocka_unit_test(test_a_door_opens_its_portal_and_shuts_it),
    cmocka_unit_test(test_a_door_does_not_shut_on_somebody),
    cmocka_unit_test(test_a_door_swings_away_from_who_opens_it),
    cmocka_unit_test(test_a_lock_wants_its_key),
    cmocka_unit_test(test_a_bot_says_why_it_fails),
    cmocka_unit_test(test_an_elevator_carries),
    cmocka_unit_test(test_a_guard_catches_whom_it_sees),
    cmocka_unit_test(test_nobody_is_seen_through_a_shut_door),
    cmocka_unit_test(test_noise_brings_a_guard),
    cmocka_unit_test(test_sounds_come_from_the_doorway),
    cmocka_unit_test(test_games_repeat_bit_for_bit),
    cmocka_unit_test(test_no_heap_in_warm_ticks_and_restarts),
    cmocka_unit_test(test_memory_that_runs_out_is_an_error),
};

ENF_TEST_MAIN(tests)
