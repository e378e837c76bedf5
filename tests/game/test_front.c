/* The program behind the window, driven without one: gamepads that come and go, focus, menus, the screens of a game won and lost, the
 * elevator by the use key, and what 36,000 frames and a hundred games cost. tests/game/play.sh drives the window itself. */
#include "harness/program.h"
#include "scenes/night.h"

#include "front/app.h"
#include "front/heap.h"
#include "sim/bot.h"
#include "sim/record.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TICK (1000.0 / ENF_TICK_RATE)

static App app;

/* ---- opening ------------------------------------------------------------------------------------------------------- */

static void open_app(const char *map, const char *play, uint32_t width, uint32_t height) {
    EnfError error = {ENF_OK, 0, "", ""};
    memset(&app, 0, sizeof app);
    app.options = (Options){.map = map, .play = play, .headless = true, .mute = true, .seed = 1, .speed = 1.0};
    app.settings = settings_default();
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");
    SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1"); /* there is no window to have the focus */
    assert_int_equal(SDL_Init(SDL_INIT_VIDEO | SDL_INIT_GAMECONTROLLER), 0);
    if (app_open(&app, &error) != ENF_OK || headless_open(&app, width, height, &error) != ENF_OK ||
        modes_enter(&app, &error) != ENF_OK) {
        fail_msg("%s %s", error.file, error.message);
    }
    app.focus = true;
}

static const char *night(EnfNightDef def) {
    static char path[1024];
    EnfNight made;
    EnfError error = {ENF_OK, 0, "", ""};
    snprintf(path, sizeof path, "%s", enf_test_temp_path("night.enfmap"));
    assert_true(enf_night_create(&made, &def, &error));
    assert_int_equal(enf_map_write(made.map, path, &error), ENF_OK);
    enf_night_destroy(&made);
    return path;
}

static const char *palace(void) {
    static char path[1024];
    if (!*path) {
        snprintf(path, sizeof path, "%s", enf_test_temp_path("palace.enfmap"));
        assert_int_equal(enf_test_compile_palace(path), 0);
    }
    return path;
}

/* A script of the bot, played and recorded as somebody's game on this map. */
static const char *recorded(const char *map_path, const char *script) {
    static char path[1024];
    EnfError error = {ENF_OK, 0, "", ""};
    EnfMap map;
    Game *game;
    GameBot *bot;
    EnfRecorder *recorder;
    GameDef def = game_def_default();
    snprintf(path, sizeof path, "%s", enf_test_temp_path("game.enfreplay"));
    assert_int_equal(enf_map_read(&map, map_path, NULL, &error), ENF_OK);
    assert_int_equal(game_create(&game, &map, &def, NULL, &error), ENF_OK);
    assert_int_equal(game_bot_create(&bot, game, script, strlen(script), NULL, &error), ENF_OK);
    EnfReplayHeader header = game_replay_header(game, &def, &map, "night");
    assert_int_equal(enf_recorder_create(&recorder, &header, path, NULL, &error), ENF_OK);
    EnfInput input;
    GameBotNews news;
    while ((news = game_bot_next(bot, &input, &error)) == GAME_BOT_GOES_ON) {
        game_step(game, &input);
        assert_int_equal(game_record(recorder, game, &input, &error), ENF_OK);
    }
    if (news != GAME_BOT_DONE) {
        fail_msg("%s", error.message);
    }
    assert_int_equal(enf_recorder_finish(recorder, &error), ENF_OK);
    enf_recorder_destroy(recorder);
    game_bot_destroy(bot);
    game_destroy(game);
    enf_map_free(&map);
    return path;
}

/* ---- a person's hands -------------------------------------------------------------------------------------------------- */

static void frames(uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        events_handle(&app);
        modes_step(&app, TICK);
        frame_draw(&app);
        app.frames++;
    }
}

static void push_key(SDL_Scancode code, bool down) {
    SDL_Event event;
    memset(&event, 0, sizeof event);
    event.type = down ? SDL_KEYDOWN : SDL_KEYUP;
    event.key.keysym.scancode = code;
    assert_int_equal(SDL_PushEvent(&event), 1);
}

static void press(SDL_Scancode code) {
    push_key(code, true);
    frames(2);
    push_key(code, false);
    frames(2);
}

static void turn(int x_px, int y_px) {
    SDL_Event event;
    memset(&event, 0, sizeof event);
    event.type = SDL_MOUSEMOTION;
    event.motion.xrel = x_px;
    event.motion.yrel = y_px;
    assert_int_equal(SDL_PushEvent(&event), 1);
    frames(2);
}

static void window_event(uint8_t what) {
    SDL_Event event;
    memset(&event, 0, sizeof event);
    event.type = SDL_WINDOWEVENT;
    event.window.event = what;
    assert_int_equal(SDL_PushEvent(&event), 1);
    frames(2);
}

/* What the frame shows: bytes that are not of one colour. */
static uint32_t colours(void) {
    size_t size = (size_t)app.width_px * (size_t)app.height_px * 4;
    uint8_t *rgba = malloc(size), seen[4096];
    uint32_t count = 0;
    memset(seen, 0, sizeof seen);
    enf_gl_target_read(app.scene.target, ENF_RENDER_COLOR, rgba);
    for (size_t i = 0; i < size; i += 4) {
        uint32_t color = (uint32_t)(rgba[i] >> 4) << 8 | (uint32_t)(rgba[i + 1] >> 4) << 4 | rgba[i + 2] >> 4;
        count += !seen[color];
        seen[color] = 1;
    }
    free(rgba);
    return count;
}

static const GameState *shown(void) {
    return game_state(app.play.game);
}

/* ---- gamepads -------------------------------------------------------------------------------------------------------------- */

static int pad_index;
static SDL_Joystick *attach_pad(void) {
    SDL_VirtualJoystickDesc desc;
    memset(&desc, 0, sizeof desc);
    desc.version = SDL_VIRTUAL_JOYSTICK_DESC_VERSION;
    desc.type = SDL_JOYSTICK_TYPE_GAMECONTROLLER;
    desc.naxes = SDL_CONTROLLER_AXIS_MAX;
    desc.nbuttons = SDL_CONTROLLER_BUTTON_MAX;
    pad_index = SDL_JoystickAttachVirtualEx(&desc);
    assert_true(pad_index >= 0);
    frames(3);
    assert_non_null(app.input.pad);
    return SDL_GameControllerGetJoystick(app.input.pad);
}

static void pad_button(SDL_Joystick *pad, SDL_GameControllerButton button) {
    SDL_JoystickSetVirtualButton(pad, (int)button, 1);
    frames(3);
    SDL_JoystickSetVirtualButton(pad, (int)button, 0);
    frames(3);
}

static void pad_axis(SDL_Joystick *pad, SDL_GameControllerAxis axis, int16_t value) {
    SDL_JoystickSetVirtualAxis(pad, (int)axis, value);
}

/* Lets go of the stick and takes what is marked, which goes on with the game. */
static void pad_back_to_the_game(SDL_Joystick *pad) {
    pad_axis(pad, SDL_CONTROLLER_AXIS_LEFTY, 0);
    frames(2);
    pad_button(pad, SDL_CONTROLLER_BUTTON_A);
    assert_int_equal(menu_page(&app), MENU_NONE);
}

static void test_a_gamepad_plays(void **state) {
    (void)state;
    open_app(night((EnfNightDef){.door = true}), NULL, 320, 180);
    frames(30);
    SDL_Joystick *pad = attach_pad();
    EnfVec3 before = shown()->eye_ws;
    double yaw = shown()->yaw_deg;
    pad_axis(pad, SDL_CONTROLLER_AXIS_LEFTY, -32768); /* ahead: towards -z, where the player looks at first */
    frames(30);
    assert_true(app.input.pad_used);
    double walked = enf_length(enf_sub(shown()->eye_ws, before));
    assert_true(walked > 0.5 && shown()->eye_ws.z < before.z - 0.5);
    pad_axis(pad, SDL_CONTROLLER_AXIS_LEFTY, 0);
    frames(20);
    before = shown()->eye_ws;
    frames(10);
    assert_true(enf_length(enf_sub(shown()->eye_ws, before)) < 1e-3);
    pad_axis(pad, SDL_CONTROLLER_AXIS_RIGHTX, 32767);
    frames(20);
    pad_axis(pad, SDL_CONTROLLER_AXIS_RIGHTX, 0);
    frames(3);
    assert_true(shown()->yaw_deg < yaw - 20.0);      /* to the right */
    pad_axis(pad, SDL_CONTROLLER_AXIS_RIGHTX, 4000); /* what a worn stick says at rest */
    frames(3);
    yaw = shown()->yaw_deg;
    frames(10);
    assert_true(fabs(shown()->yaw_deg - yaw) < 1e-9);
    double floor = shown()->eye_ws.y, top = floor;
    SDL_JoystickSetVirtualButton(pad, SDL_CONTROLLER_BUTTON_A, 1);
    for (int i = 0; i < 30; i++) {
        frames(1);
        top = fmax(top, shown()->eye_ws.y);
    }
    SDL_JoystickSetVirtualButton(pad, SDL_CONTROLLER_BUTTON_A, 0);
    assert_true(top > floor + 0.3);
    frames(30);
    SDL_JoystickSetVirtualButton(pad, SDL_CONTROLLER_BUTTON_B, 1);
    frames(30);
    assert_true(shown()->crouched);
    SDL_JoystickSetVirtualButton(pad, SDL_CONTROLLER_BUTTON_B, 0);
    frames(30);
    assert_false(shown()->crouched);
    pad_button(pad, SDL_CONTROLLER_BUTTON_BACK);
    assert_true(app.map_shown);
    pad_button(pad, SDL_CONTROLLER_BUTTON_BACK);
    press(SDL_SCANCODE_D);
    assert_false(app.input.pad_used); /* prompts name keys again */
    app_close(&app);
}

static void test_a_gamepad_goes_through_menus(void **state) {
    (void)state;
    open_app(night((EnfNightDef){.door = true}), NULL, 320, 180);
    SDL_Joystick *pad = attach_pad();
    frames(5);
    pad_button(pad, SDL_CONTROLLER_BUTTON_START);
    assert_int_equal(menu_page(&app), MENU_PAUSE);
    uint64_t tick = shown()->tick;
    frames(20);
    assert_true(shown()->tick == tick); /* paused */
    pad_button(pad, SDL_CONTROLLER_BUTTON_DPAD_DOWN);
    pad_button(pad, SDL_CONTROLLER_BUTTON_DPAD_DOWN);
    pad_button(pad, SDL_CONTROLLER_BUTTON_A);
    assert_int_equal(menu_page(&app), MENU_SETTINGS);
    pad_button(pad, SDL_CONTROLLER_BUTTON_A);
    assert_int_equal(menu_page(&app), MENU_CONTROLS);
    double sensitivity = app.settings.sensitivity;
    pad_button(pad, SDL_CONTROLLER_BUTTON_DPAD_RIGHT);
    assert_true(app.settings.sensitivity > sensitivity);
    pad_button(pad, SDL_CONTROLLER_BUTTON_B);
    pad_button(pad, SDL_CONTROLLER_BUTTON_B);
    assert_int_equal(menu_page(&app), MENU_PAUSE);
    /* The stick moves the mark, too: a step a push. */
    app.menu.chosen[0] = 0;
    pad_axis(pad, SDL_CONTROLLER_AXIS_LEFTY, 32767);
    frames(5);
    assert_int_equal(app.menu.chosen[0], 1);
    pad_axis(pad, SDL_CONTROLLER_AXIS_LEFTY, 0);
    frames(5);
    pad_axis(pad, SDL_CONTROLLER_AXIS_LEFTY, -32768);
    frames(5);
    assert_int_equal(app.menu.chosen[0], 0);
    pad_back_to_the_game(pad);
    /* Who holds it while a menu opens chooses nothing by it. */
    pad_axis(pad, SDL_CONTROLLER_AXIS_LEFTY, 32767);
    frames(5);
    pad_button(pad, SDL_CONTROLLER_BUTTON_START);
    assert_int_equal(menu_page(&app), MENU_PAUSE);
    app.menu.chosen[0] = 0;
    pad_axis(pad, SDL_CONTROLLER_AXIS_LEFTY, 32000);
    frames(5);
    assert_int_equal(app.menu.chosen[0], 0);
    pad_back_to_the_game(pad);
    tick = shown()->tick;
    frames(10);
    assert_true(shown()->tick > tick);
    app_close(&app);
}

static void test_a_gamepad_may_be_pulled_out(void **state) {
    (void)state;
    open_app(night((EnfNightDef){.door = true}), NULL, 320, 180);
    SDL_Joystick *pad = attach_pad();
    frames(5);
    pad_axis(pad, SDL_CONTROLLER_AXIS_LEFTY, -32768);
    SDL_JoystickSetVirtualButton(pad, SDL_CONTROLLER_BUTTON_LEFTSTICK, 1);
    frames(10);
    assert_int_equal(SDL_JoystickDetachVirtual(pad_index), 0);
    frames(3);
    assert_null(app.input.pad);
    assert_int_equal(menu_page(&app), MENU_PAUSE);
    press(SDL_SCANCODE_ESCAPE);
    assert_int_equal(menu_page(&app), MENU_NONE);
    frames(20); /* it does not walk on */
    EnfVec3 before = shown()->eye_ws;
    frames(20);
    assert_true(enf_length(enf_sub(shown()->eye_ws, before)) < 1e-3);
    pad = attach_pad(); /* and it may be put in again */
    pad_axis(pad, SDL_CONTROLLER_AXIS_LEFTY, -32768);
    frames(20);
    assert_true(enf_length(enf_sub(shown()->eye_ws, before)) > 0.2);
    app_close(&app);
}

/* ---- the window's events ----------------------------------------------------------------------------------------------- */

static void test_losing_the_focus_pauses_and_frees_the_mouse(void **state) {
    (void)state;
    open_app(night((EnfNightDef){.door = true}), NULL, 320, 180);
    frames(5);
    assert_true(app.captured);
    push_key(SDL_SCANCODE_W, true);
    frames(10);
    window_event(SDL_WINDOWEVENT_FOCUS_LOST);
    assert_int_equal(menu_page(&app), MENU_PAUSE);
    assert_false(app.captured);
    assert_false(app.input.held[ACTION_FORWARD]);
    window_event(SDL_WINDOWEVENT_FOCUS_GAINED);
    assert_int_equal(menu_page(&app), MENU_PAUSE);
    assert_false(app.captured); /* the menu needs the mouse */
    press(SDL_SCANCODE_ESCAPE);
    assert_int_equal(menu_page(&app), MENU_NONE);
    assert_true(app.captured);
    window_event(SDL_WINDOWEVENT_MINIMIZED);
    assert_int_equal(menu_page(&app), MENU_PAUSE);
    press(SDL_SCANCODE_DOWN); /* start again; settings; back to the title */
    press(SDL_SCANCODE_DOWN);
    press(SDL_SCANCODE_DOWN);
    press(SDL_SCANCODE_RETURN);
    assert_int_equal(app.mode, APP_TITLE);
    window_event(SDL_WINDOWEVENT_FOCUS_LOST);
    window_event(SDL_WINDOWEVENT_FOCUS_GAINED);
    assert_int_equal(menu_page(&app), MENU_TITLE);
    assert_false(app.captured);
    app_close(&app);
}

static void test_full_screen_is_the_persons_own(void **state) {
    (void)state;
    open_app(night((EnfNightDef){.door = true}), NULL, 320, 180);
    EnfError error = {ENF_OK, 0, "", ""};
    snprintf(app.config, sizeof app.config, "%s", enf_test_temp_path("settings.json"));
    app.kept = app.settings;
    app.size_once = app.fullscreen_once = true; /* as after --size 640x480 --fullscreen */
    app.settings.width = 640.0, app.settings.height = 480.0;
    app.settings.fullscreen = true;
    Settings saved;
    app.settings.volume = 0.5;
    assert_int_equal(app_save_settings(&app, &error), ENF_OK);
    assert_int_equal(settings_read(&saved, app.config, &error), ENF_OK);
    assert_true(fabs(saved.volume - 0.5) < 1e-9 && fabs(saved.width - 1280.0) < 1e-9 && !saved.fullscreen);
    press(SDL_SCANCODE_F11); /* off, and on again: now it is wanted */
    assert_false(app.settings.fullscreen);
    press(SDL_SCANCODE_F11);
    assert_true(app.settings.fullscreen);
    assert_int_equal(app_save_settings(&app, &error), ENF_OK);
    assert_int_equal(settings_read(&saved, app.config, &error), ENF_OK);
    assert_true(saved.fullscreen && fabs(saved.width - 1280.0) < 1e-9);
    app_close(&app);
}

/* ---- the game, seen ------------------------------------------------------------------------------------------------------ */

static void over_screen(EnfNightDef def, const char *script, MenuPage page) {
    const char *map = night(def), *play = recorded(map, script);
    open_app(map, play, 640, 360);
    for (int i = 0; i < 20000 && menu_page(&app) == MENU_NONE; i++) {
        events_handle(&app);
        modes_step(&app, TICK);
    }
    assert_int_equal(menu_page(&app), page);
    assert_false(app.captured);
    assert_false(app.play.diverged);
    frames(3);
    assert_true(colours() > 20);
    press(SDL_SCANCODE_RETURN); /* again */
    assert_int_equal(menu_page(&app), MENU_NONE);
    assert_int_equal(shown()->phase, GAME_PLAYING);
    assert_true(app.captured);
    app_close(&app);
}

static void test_the_screen_of_a_game_won(void **state) {
    (void)state;
    over_screen((EnfNightDef){.door = true}, "enfbot 1\nrun on\ntake vase\ngoto exit\nexpect won 1\nwait 4\n", MENU_WON);
}

static void test_the_screen_of_a_game_lost(void **state) {
    (void)state;
    over_screen((EnfNightDef){.guard = true}, "enfbot 1\nwait 5\ngoto point 11.5 0 4\nexpect lost 40\nwait 4\n", MENU_LOST);
}

/* From (2, 0, 4) to the plate about (6, 0, 7), down at it, E, and up with it. */
static void test_the_elevator_by_the_use_key(void **state) {
    (void)state;
    open_app(night((EnfNightDef){.lift = true}), NULL, 320, 180);
    frames(10);
    turn(1411, 0);
    push_key(SDL_SCANCODE_W, true);
    frames(90);
    push_key(SDL_SCANCODE_W, false);
    frames(20);
    turn(0, 900);
    assert_true(shown()->prompt[0] != '\0');
    double floor = shown()->eye_ws.y;
    press(SDL_SCANCODE_E);
    frames(240);
    assert_true(shown()->eye_ws.y > floor + 1.9);
    app_close(&app);
}

/* A key that is down and up between two ticks, as on a slow machine, is a key that was pressed; and pressed once. */
static void test_a_quick_tap_counts(void **state) {
    (void)state;
    open_app(night((EnfNightDef){.lift = true}), NULL, 320, 180);
    frames(10);
    double floor = shown()->eye_ws.y, top = floor;
    push_key(SDL_SCANCODE_SPACE, true);
    push_key(SDL_SCANCODE_SPACE, false);
    for (int i = 0; i < 120; i++) {
        frames(1);
        top = fmax(top, shown()->eye_ws.y);
    }
    assert_true(top > floor + 0.3);
    assert_true(fabs(shown()->eye_ws.y - floor) < 0.01);
    app_close(&app);
}

/* ---- sound ------------------------------------------------------------------------------------------------------------------ */

/* The one that is left is taken; what sounded goes on. */
static void test_a_sound_card_may_go_away(void **state) {
    (void)state;
    char folder[1024];
    open_app(night((EnfNightDef){.sounds = true}), NULL, 320, 180);
    app.options.mute = false;
    snprintf(folder, sizeof folder, "%s", enf_test_source_path("assets/sounds"));
    SDL_SetHint(SDL_HINT_AUDIODRIVER, "dummy");
    assert_int_equal(SDL_InitSubSystem(SDL_INIT_AUDIO), 0);
    audio_load(&app.audio, folder);
    assert_true(audio_open(&app.audio));
    audio_loop(&app.audio, AUDIO_SLOT_AMBIENT, AUDIO_NIGHT);
    frames(10);
    SDL_Event event;
    memset(&event, 0, sizeof event);
    event.type = SDL_AUDIODEVICEREMOVED;
    event.adevice.which = app.audio.device;
    assert_int_equal(SDL_PushEvent(&event), 1);
    frames(2);
    assert_true(app.audio.device != 0);
    unsigned mixed = atomic_load(&app.audio.frames);
    for (int i = 0; i < 200 && atomic_load(&app.audio.frames) == mixed; i++) {
        SDL_Delay(10);
    }
    assert_true(atomic_load(&app.audio.frames) > mixed);
    assert_int_equal(menu_page(&app), MENU_NONE); /* the game goes on meanwhile */
    app_close(&app);
}

/* From where a game in the palace begins: what the level's nodes say of sounds, found and heard. */
static void test_the_palace_sounds(void **state) {
    (void)state;
    uint32_t heard[GAME_SOUND_COUNT] = {0}, count;
    open_app(palace(), NULL, 128, 72);
    for (int i = 0; i < 20 * ENF_TICK_RATE; i++) {
        modes_tick(&app);
        const GameSpeaker *speakers = game_speakers(app.play.game, &count);
        for (uint32_t k = 0; k < count; k++) {
            heard[speakers[k].sound.kind]++;
        }
    }
    printf("in 20 s: water %u, ticks %u, tocks %u, birds %u\n", heard[GAME_SOUND_FOUNTAIN], heard[GAME_SOUND_CLOCK_TICKS],
           heard[GAME_SOUND_CLOCK_TOCKS], heard[GAME_SOUND_BIRD]);
    assert_int_equal(heard[GAME_SOUND_FOUNTAIN], 20 * ENF_TICK_RATE / 6);
    assert_true(heard[GAME_SOUND_CLOCK_TICKS] > 5 && heard[GAME_SOUND_CLOCK_TOCKS] > 5);
    assert_true(heard[GAME_SOUND_BIRD] > 0);
    app_close(&app);
}

/* ---- what it costs ----------------------------------------------------------------------------------------------------- */

/* Keys and mouse by chance; what ends the game is answered. */
static void play_by_chance(EnfTestRng *rng) {
    static const Action actions[] = {ACTION_FORWARD, ACTION_LEFT, ACTION_RIGHT,  ACTION_FORWARD, ACTION_JUMP,
                                     ACTION_FORWARD, ACTION_USE,  ACTION_CROUCH, ACTION_RUN};
    if (enf_test_chance(rng, 15)) {
        Action action = actions[enf_test_below(rng, sizeof actions / sizeof *actions)];
        app.input.held[action] = enf_test_chance(rng, 2);
    }
    app.input.yaw_deg += enf_test_double(rng, -6.0, 6.5);
    app.input.pitch_deg += enf_test_double(rng, -1.0, 1.0);
    if (enf_test_chance(rng, 500)) {
        app.map_shown = !app.map_shown;
    }
    if (menu_page(&app) == MENU_WON || menu_page(&app) == MENU_LOST) {
        menu_press(&app);
    }
}

static void test_warm_frames_call_no_heap(void **state) {
    (void)state;
    enum { WARM = 300 };
    uint32_t count = enf_test_rounds(900, 36000);
    open_app(palace(), NULL, 128, 72);
    app.engineer.counters = app.engineer.plan = true;
    EnfTestRng rng = enf_test_rng(1);
    unsigned long before = 0;
    for (uint32_t i = 0; i < WARM + count; i++) {
        before = i == WARM ? heap_calls() : before;
        play_by_chance(&rng);
        frames(1);
    }
    unsigned long calls = heap_calls() - before;
    printf("%u frames drawn, %llu ticks: %lu heap calls%s\n", count, (unsigned long long)app.ticks, calls,
           heap_calls() ? "" : " (not counted in this build)");
    assert_int_equal(calls, 0);
    app_close(&app);
}

/* Each begun anew after some frames. What is not asked of the heap cannot grow. */
static void test_a_hundred_restarts_keep_the_memory(void **state) {
    (void)state;
    enum { RESTARTS = 100, WARM = 10 };
    uint32_t length = enf_test_rounds(4, 60);
    open_app(palace(), NULL, 128, 72);
    EnfTestRng rng = enf_test_rng(2);
    unsigned long before = 0;
    for (uint32_t i = 0; i < WARM + RESTARTS; i++) {
        before = i == WARM ? heap_calls() : before;
        for (uint32_t k = 0; k < length; k++) {
            play_by_chance(&rng);
            frames(1);
        }
        if (menu_page(&app) == MENU_NONE) {
            menu_open(&app, MENU_PAUSE);
            menu_move(&app, 1); /* start again */
        }
        menu_press(&app);
        assert_int_equal(menu_page(&app), MENU_NONE);
        assert_true(shown()->tick == 0);
    }
    unsigned long calls = heap_calls() - before;
    printf("%u restarts after %u frames each: %lu heap calls\n", (unsigned)RESTARTS, length, calls);
    assert_int_equal(calls, 0);
    app_close(&app);
}

/* From the title, game after game: everything of a game comes, and all of it goes. */
static void test_new_games_keep_the_memory(void **state) {
    (void)state;
    enum { WARM = 3 };
    uint32_t games = enf_test_rounds(12, 200);
    long long memory = 0, now = 0;
    open_app(palace(), NULL, 128, 72);
    for (uint32_t i = 0; i < WARM + games; i++) {
        frames(3);
        modes_title(&app);
        frames(2);
        menu_press(&app); /* new game */
        assert_int_equal(app.mode, APP_PLAYING);
        frames(1);
        now = heap_live();
        memory = i == WARM ? now : memory;
    }
    printf("%u new games from the title: %lld bytes of ours, %lld more than after the first\n", games, now, now - memory);
    assert_true(llabs(now - memory) < 4096); /* usable sizes of blocks differ by some bytes from one time to the next */
    app_close(&app);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_a_gamepad_plays),
    cmocka_unit_test(test_a_gamepad_goes_through_menus),
    cmocka_unit_test(test_a_gamepad_may_be_pulled_out),
    cmocka_unit_test(test_losing_the_focus_pauses_and_frees_the_mouse),
    cmocka_unit_test(test_full_screen_is_the_persons_own),
    cmocka_unit_test(test_the_screen_of_a_game_won),
    cmocka_unit_test(test_the_screen_of_a_game_lost),
    cmocka_unit_test(test_the_elevator_by_the_use_key),
    cmocka_unit_test(test_a_quick_tap_counts),
    cmocka_unit_test(test_a_sound_card_may_go_away),
    cmocka_unit_test(test_the_palace_sounds),
    cmocka_unit_test(test_warm_frames_call_no_heap),
    cmocka_unit_test(test_a_hundred_restarts_keep_the_memory),
    cmocka_unit_test(test_new_games_keep_the_memory),
};
ENF_TEST_MAIN(tests)
