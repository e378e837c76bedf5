/* Scripts of the bot as strangers write them: every line right or named, every cut and every flipped byte survived. */
#include "harness/harness.h"
#include "scenes/night.h"

#include "sim/bot.h"
#include "sim/text.h"

#include <stdlib.h>
#include <string.h>

static const char SCRIPT[] =
    "enfbot 1\r\n"
    "# all there is\n"
    "goto cell east\n  goto point 1.5 0 -2\ngoto entity vase\ngoto exit\ntake vase\npress door\n"
    "look at 1 2 3\nlook by 90 -10\nuse\ndrop\njump\ncrouch on\ncrouch off\nrun on\nsneak on\nwait 0.5\n"
    "walk 1 -0.5 2\nexpect playing 3\n\nexpect won 1";

typedef struct Stage {
    EnfNight night;
    Game *game;
} Stage;

static void open_stage(Stage *stage) {
    EnfError error = {ENF_OK, 0, "", ""};
    EnfNightDef def = {.door = true};
    GameDef game = game_def_default();
    assert_true(enf_night_create(&stage->night, &def, &error));
    assert_int_equal(game_create(&stage->game, stage->night.map, &game, NULL, &error), ENF_OK);
}

static void close_stage(Stage *stage) {
    game_destroy(stage->game);
    enf_night_destroy(&stage->night);
}

/* The text in a block of just its size, so that a byte read too far is seen by the sanitizers. */
static EnfResult read_tight(Stage *stage, const char *text, size_t size, EnfError *error) {
    char *tight = malloc(size ? size : 1);
    assert_non_null(tight);
    memcpy(tight, text, size);
    GameBot *bot;
    EnfResult result = game_bot_create(&bot, stage->game, tight, size, NULL, error);
    assert_true((result == ENF_OK) == (bot != NULL));
    free(tight);
    game_bot_destroy(bot);
    return result;
}

static void test_every_command_is_read(void **state) {
    (void)state;
    Stage stage;
    EnfError error = {ENF_OK, 0, "", ""};
    open_stage(&stage);
    if (read_tight(&stage, SCRIPT, sizeof SCRIPT - 1, &error) != ENF_OK) {
        fail_msg("%s", error.message);
    }
    close_stage(&stage);
}

static void test_what_is_wrong_is_named(void **state) {
    (void)state;
    static const char *const wrong[][2] = {
        {"", "line 1"},
        {"enfbot 2\n", "line 1"},
        {"enfbot 1\nfly\n", "no such command: fly"},
        {"enfbot 1\n\ngoto\n", "line 3"},
        {"enfbot 1\ngoto cell\n", "a name is missing"},
        {"enfbot 1\ngoto cell attic\n", "no such cell: attic"},
        {"enfbot 1\ntake crown\n", "no such entity: crown"},
        {"enfbot 1\ngoto point 1 2\n", "a number is missing"},
        {"enfbot 1\ngoto point 1 2 3 4\n", "too many words: 4"},
        {"enfbot 1\nwait 1e9\n", "a number is missing: 1e9"},
        {"enfbot 1\nwait nan\n", "a number is missing: nan"},
        {"enfbot 1\ncrouch down\n", "no such word here: down"},
        {"enfbot 1\nexpect won\n", "a number is missing"},
        {"enfbot 1\nuse it\n", "too many words: it"},
    };
    Stage stage;
    open_stage(&stage);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        EnfError error = {ENF_OK, 0, "", ""};
        assert_int_equal(read_tight(&stage, wrong[i][0], strlen(wrong[i][0]), &error), ENF_ERROR_FORMAT);
        if (!strstr(error.message, wrong[i][1])) {
            fail_msg("\"%s\" gives \"%s\"", wrong[i][0], error.message);
        }
    }
    close_stage(&stage);
}

static void test_cuts_and_flipped_bytes(void **state) {
    (void)state;
    Stage stage;
    open_stage(&stage);
    EnfTestRng rng = enf_test_rng(1);
    char text[sizeof SCRIPT];
    for (size_t size = 0; size < sizeof SCRIPT; size++) {
        read_tight(&stage, SCRIPT, size, NULL);
    }
    uint32_t rounds = enf_test_rounds(2000, 50000);
    for (uint32_t i = 0; i < rounds; i++) {
        memcpy(text, SCRIPT, sizeof text);
        for (uint32_t k = 1 + enf_test_below(&rng, 4); k > 0; k--) {
            text[enf_test_below(&rng, sizeof SCRIPT - 1)] = (char)enf_test_below(&rng, 256);
        }
        read_tight(&stage, text, sizeof SCRIPT - 1, NULL);
    }
    close_stage(&stage);
}

static void test_too_many_commands(void **state) {
    (void)state;
    Stage stage;
    open_stage(&stage);
    size_t size = 9 + 5 * (GAME_BOT_COMMANDS_MAX + 1);
    char *text = malloc(size + 1);
    assert_non_null(text);
    memcpy(text, "enfbot 1\n", 9);
    for (size_t at = 9; at < size; at += 5) {
        memcpy(text + at, "drop\n", 5);
    }
    assert_int_equal(read_tight(&stage, text, size - 5, NULL), ENF_OK);
    assert_int_equal(read_tight(&stage, text, size, NULL), ENF_ERROR_SIZE);
    free(text);
    close_stage(&stage);
}

static void test_numbers(void **state) {
    (void)state;
    static const char *const none[] = {"",     "-",  ".",   "+.",    "1e3",        "inf",
                                       "0x10", "1 ", "--1", "1.2.3", "9999999999", "1234567890.1234567"};
    double value = 7.0;
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        if (sim_text_number(none[i], &value)) {
            fail_msg("\"%s\" is taken for a number", none[i]);
        }
    }
    assert_true(value == 7.0);
    assert_true(sim_text_number("-12.375", &value) && value == -12.375);
    assert_true(sim_text_number("+.5", &value) && value == 0.5);
    assert_true(sim_text_number("3.", &value) && value == 3.0);
    assert_true(sim_text_number("0.1", &value) && value == 0.1);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_every_command_is_read),
    cmocka_unit_test(test_what_is_wrong_is_named),
    cmocka_unit_test(test_cuts_and_flipped_bytes),
    cmocka_unit_test(test_too_many_commands),
    cmocka_unit_test(test_numbers),
};

ENF_TEST_MAIN(tests)
