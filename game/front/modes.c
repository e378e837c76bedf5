/* Title, guided tour, play: what goes on in a tick, and from where it is seen. */
#include <string.h>

#include "front/app.h"

#define TICK_MS (1000.0 / ENF_TICK_RATE)
/* More ticks are not made up for: a machine that is too slow, or was asleep, plays slower. */
#define CATCH_UP_MS 250.0
#define OVER_MENU_MS 1800.0

/* ---- the world of the tour: everything lives, every door stands open -------------------------------------------------- */

static void open_doors(App *app) {
    for (uint32_t i = 0; i < app->map.movers_count; i++) {
        const EnfMover *mover = &app->map.movers[i];
        bool door = mover->portal != ENF_NONE && (mover->kind == ENF_MOVER_HINGE || mover->kind == ENF_MOVER_SLIDE);
        if (door) {
            double far = (double)(mover->high >= -mover->low ? mover->high : mover->low);
            enf_world_swing(app->tour_world, enf_world_object(app->tour_world, i), far);
        }
    }
    for (uint32_t i = 0; i < app->tour_portals.count; i++) {
        enf_portals_set_open(&app->tour_portals, i, true);
    }
    enf_world_advance(app->tour_world, 10 * ENF_TICK_RATE);
}

EnfResult modes_tour_world(App *app, EnfError *error) {
    EnfResult result = enf_world_create(&app->tour_world, &app->map, app->map.movers_count, NULL, error);
    result = result ? result : enf_world_populate(app->tour_world, error);
    result = result ? result : enf_portals_create(&app->tour_portals, &app->map, NULL, error);
    result = result ? result : enf_collider_create(&app->tour_collider, &app->map, app->tour_world, NULL, error);
    if (result == ENF_OK) {
        open_doors(app);
    }
    if (result == ENF_OK && app->river_file.size) {
        GameRiverDef def = {(const char *)app->river_file.data, app->river_file.size, &app->map, app->tour_collider};
        result = game_river_create(&app->river, &def, NULL, error);
        result = enf_error_file(error, result, "the guided tour");
    }
    return result;
}

void modes_tour_close(App *app) {
    game_river_destroy(app->river);
    enf_collider_destroy(app->tour_collider);
    enf_world_destroy(app->tour_world);
    enf_portals_destroy(&app->tour_portals);
    enf_file_free(&app->river_file);
    app->river = NULL;
    app->tour_collider = NULL;
    app->tour_world = NULL;
}

/* ---- changing ------------------------------------------------------------------------------------------------------- */

static void begin(App *app, AppMode mode) {
    app->mode = mode;
    app->behind_ms = 0.0;
    app->over_ms = 0.0;
    app->over_shown = false;
    app->map_shown = false;
    input_release(&app->input);
    app->input.noclip = app->input.fly = false;
    audio_silence(&app->audio);
}

static void show_tour_world(App *app) {
    EnfError error = {0};
    if (scene_attach(&app->scene, app->tour_world, &app->tour_portals, &error) != ENF_OK) {
        hud_notice(app, error.message);
    }
}

void modes_title(App *app) {
    begin(app, APP_TITLE);
    show_tour_world(app); /* first: volumes must not outlive their world */
    play_close(&app->play);
    app->options.play = NULL; /* a new game is the person's own */
    menu_close_all(app);
    menu_open(app, MENU_TITLE);
    window_capture(app, false);
    audio_loop(&app->audio, AUDIO_SLOT_MUSIC, AUDIO_TITLE);
    audio_loop(&app->audio, AUDIO_SLOT_AMBIENT, -1);
}

void modes_tour(App *app) {
    begin(app, APP_TOUR);
    menu_close_all(app);
    window_capture(app, true);
    if (app->river) {
        game_river_start(app->river, NULL);
    }
    hud_notice(app, "You are carried along: look around, push where you look. Esc: back");
}

EnfResult modes_enter(App *app, EnfError *error) {
    EnfResult result = scene_attach(&app->scene, game_world(app->play.game), game_portals(app->play.game), error);
    app->options.record = NULL; /* one game: the next must not overwrite it */
    if (result != ENF_OK) {
        modes_title(app);
        return result;
    }
    begin(app, APP_PLAYING);
    menu_close_all(app);
    window_capture(app, true);
    audio_loop(&app->audio, AUDIO_SLOT_MUSIC, -1);
    audio_loop(&app->audio, AUDIO_SLOT_AMBIENT, AUDIO_NIGHT);
    return ENF_OK;
}

EnfResult modes_play(App *app, EnfError *error) {
    show_tour_world(app);
    play_close(&app->play);
    /* In place: a replay's cursor points into it. */
    EnfResult result = play_open(&app->play, &app->map, &app->options, error);
    if (result != ENF_OK) {
        modes_title(app);
        return result;
    }
    return modes_enter(app, error);
}

/* ---- a tick --------------------------------------------------------------------------------------------------------- */

static void hear(App *app, const GameState *state) {
    uint32_t count = 0;
    const GameSound *sounds = game_sounds(app->play.game, &count);
    for (uint32_t i = 0; i < count; i++) {
        audio_hear(&app->audio, &sounds[i], state->eye_ws, state->yaw_deg);
    }
    const GameSpeaker *speakers = app->audio.device ? game_speakers(app->play.game, &count) : NULL;
    for (uint32_t i = 0; speakers && i < count; i++) {
        audio_hear_speaker(&app->audio, &speakers[i], state->eye_ws, state->yaw_deg);
    }
}

static void play_tick(App *app) {
    const GameState *state = game_state(app->play.game);
    EnfInput input = input_take(&app->input, &app->settings, state->pitch_deg);
    play_step(&app->play, &input);
    scene_tick(&app->scene);
    state = game_state(app->play.game);
    hear(app, state);
    if (state->phase == GAME_PLAYING) {
        app->over_tick = state->tick; /* the night ends then, whatever goes on behind the menu */
    } else {
        app->over_ms += TICK_MS;
        if (!app->over_shown && app->over_ms > OVER_MENU_MS) {
            app->over_shown = true;
            menu_open(app, state->phase == GAME_WON ? MENU_WON : MENU_LOST);
            window_capture(app, false);
        }
    }
}

static void tour_tick(App *app) {
    enf_world_advance(app->tour_world, 1);
    scene_tick(&app->scene);
    EnfInput input = input_take(&app->input, &app->settings, 0.0);
    if (app->river) {
        game_river_step(app->river, app->mode == APP_TOUR ? &input : NULL);
    }
}

void modes_tick(App *app) {
    app->ticks++;
    if (app->mode == APP_PLAYING) {
        play_tick(app);
    } else {
        tour_tick(app);
    }
}

static bool paused(const App *app) {
    return app->mode == APP_PLAYING && menu_page(app) != MENU_NONE && !app->over_shown;
}

void modes_step(App *app, double elapsed_ms) {
    if (paused(app)) {
        return;
    }
    double speed = app->mode == APP_PLAYING && app->play.replays ? app->options.speed : 1.0;
    app->behind_ms += elapsed_ms * speed;
    double most = CATCH_UP_MS * (speed > 1.0 ? speed : 1.0);
    app->behind_ms = app->behind_ms > most ? most : app->behind_ms;
    while (app->behind_ms >= TICK_MS) {
        app->behind_ms -= TICK_MS;
        modes_tick(app);
    }
}

/* ---- the eye -------------------------------------------------------------------------------------------------------- */

static EnfVec3 mix(EnfVec3 a, EnfVec3 b, double t) {
    return enf_add(a, enf_scale(enf_sub(b, a), t));
}

static double turn_between(double before, double now, double t) {
    double d = now - before;
    d -= d > 180.0 ? 360.0 : d < -180.0 ? -360.0 : 0.0;
    return before + d * t;
}

/* A person's own look is shown at once, with what the mouse has turned since the last tick; a replay's is between its ticks. */
static void play_eye(const App *app, double alpha, EnfVec3 *eye_ws, EnfTurn *turn) {
    const GameState *s = game_state(app->play.game);
    *eye_ws = mix(s->eye_before_ws, s->eye_ws, alpha);
    if (app->play.replays) {
        *turn = enf_turn(turn_between(s->yaw_before_deg, s->yaw_deg, alpha),
                         turn_between(s->pitch_before_deg, s->pitch_deg, alpha), 0.0);
        return;
    }
    double pitch = s->pitch_deg + app->input.pitch_deg;
    pitch = pitch > 89.0 ? 89.0 : pitch < -89.0 ? -89.0 : pitch;
    *turn = enf_turn(s->yaw_deg + app->input.yaw_deg, pitch, 0.0);
}

static void tour_eye(const App *app, double alpha, EnfVec3 *eye_ws, EnfTurn *turn) {
    if (app->river) {
        GameRiverView r = game_river_view(app->river);
        *eye_ws = mix(r.eye_before_ws, r.eye_ws, alpha);
        double pitch = r.pitch_before_deg + (r.pitch_deg - r.pitch_before_deg) * alpha;
        *turn = enf_turn(r.yaw_before_deg + (r.yaw_deg - r.yaw_before_deg) * alpha, pitch, 0.0);
        return;
    }
    /* A map without a tour: the middle of its first room, slowly turning. */
    const EnfCell *c = &app->map.cells[0];
    for (uint32_t i = 0; i < app->map.cells_count && (c->flags & ENF_CELL_OUTSIDE); i++) {
        c = &app->map.cells[i];
    }
    *eye_ws = enf_v3(c->origin[0] + 0.5 * (double)(c->min[0] + c->max[0]), c->origin[1] + (double)c->min[1] + 1.6,
                     c->origin[2] + 0.5 * (double)(c->min[2] + c->max[2]));
    *turn = enf_turn((double)(app->ticks % 7200) * 0.05, 0.0, 0.0);
}

double modes_eye(const App *app, EnfVec3 *eye_ws, EnfTurn *turn) {
    double alpha = app->behind_ms / TICK_MS;
    alpha = alpha < 0.0 ? 0.0 : alpha > 1.0 ? 1.0 : alpha;
    if (app->mode == APP_PLAYING) {
        play_eye(app, alpha, eye_ws, turn);
    } else {
        tour_eye(app, alpha, eye_ws, turn);
    }
    return alpha;
}
