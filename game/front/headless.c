/* Without a window: a recording played as fast as it goes, and frame rates along the guided tour, culled and not. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "common/cli.h"
#include "front/app.h"

enum { TOUR_FRAMES = 240, TOUR_SECONDS_MAX = 1800 };

EnfResult headless_open(App *app, uint32_t width, uint32_t height, EnfError *error) {
    EnfResult result = enf_context_create(&app->blind, ENF_CONTEXT_ANY, error);
    EnfGlLoadFn *load = result ? NULL : enf_context_loader(app->blind);
    app->width_px = (int)width;
    app->height_px = (int)height;
    result = result ? result : enf_gl_create(&app->gl, &app->map, load, error);
    result = result ? result : scene_create(&app->scene, &app->map, app->gl, load, error);
    result = result ? result : scene_resize(&app->scene, width, height, error);
    result = result ? result : plan_create(&app->plan, &app->map, error);
    result = result ? result : engineer_create(app, error);
    result = result ? result : modes_tour_world(app, error);
    result = result ? result : enf_gl_ui_create(&app->ui, load, app->atlas, FONT_ATLAS_WIDTH, FONT_ATLAS_HEIGHT, error);
    return result ? result : scene_attach(&app->scene, app->tour_world, &app->tour_portals, error);
}

static EnfResult open_drawing(App *app, EnfError *error) {
    const uint32_t *size = app->options.size;
    return headless_open(app, size[0] ? size[0] : 1280, size[0] ? size[1] : 720, error);
}

/* The frame as it is now, if a picture is wanted. */
static EnfResult take_shot(App *app, EnfError *error) {
    if (!app->options.shot) {
        return ENF_OK;
    }
    frame_draw(app);
    return frame_shot(app, app->options.shot, error);
}

/* ---- a game --------------------------------------------------------------------------------------------------------------- */

static int tell_replay(const App *app, uint64_t ticks) {
    const Play *play = &app->play;
    if (play->diverged) {
        printf("differs from its recording at tick %llu\n", (unsigned long long)play->divergence.tick);
        return ENF_EXIT_FAILURE;
    }
    const GameState *s = game_state(play->game);
    static const char *const phases[] = {"playing", "won", "lost"};
    printf("%llu ticks as recorded; %s, %u of %u exhibits carried out\n", (unsigned long long)ticks, phases[s->phase],
           s->delivered, s->wanted);
    return ENF_EXIT_OK;
}

/* A recording to its end, or --frames ticks of it; or as many ticks of a game that nobody plays. */
static int run_game(App *app) {
    EnfError error = {0};
    uint64_t ticks = 0, most = app->options.frames ? app->options.frames : app->play.replays ? UINT64_MAX : 1;
    EnfResult result = app->options.shot ? open_drawing(app, &error) : ENF_OK;
    app->mode = APP_PLAYING;
    result = result || !app->options.shot ? result : modes_enter(app, &error);
    if (result != ENF_OK) {
        return app_fail(&error);
    }
    for (; ticks < most; ticks++) {
        modes_tick(app);
        if (app->play.replay_ended) {
            break;
        }
    }
    if (take_shot(app, &error) != ENF_OK) {
        return app_fail(&error);
    }
    return app->play.replays ? tell_replay(app, ticks) : ENF_EXIT_OK;
}

/* ---- the tour ------------------------------------------------------------------------------------------------------------ */

static int by_value(const void *a, const void *b) {
    double x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

static double quantile(double *values, uint32_t count, double q) {
    qsort(values, count, sizeof *values, by_value);
    uint32_t at = (uint32_t)(q * (double)count);
    return count ? values[at < count ? at : count - 1] : 0.0;
}

/* Ticks of the whole tour. */
static uint32_t tour_ticks(App *app) {
    uint32_t ticks = 0, rounds = game_river_view(app->river).rounds;
    game_river_start(app->river, NULL);
    while (game_river_view(app->river).rounds == rounds && ticks < TOUR_SECONDS_MAX * ENF_TICK_RATE) {
        game_river_step(app->river, NULL);
        ticks++;
    }
    return ticks;
}

static void step_tour(App *app, uint32_t ticks) {
    for (uint32_t i = 0; i < ticks; i++) {
        enf_world_advance(app->tour_world, 1);
        scene_tick(&app->scene);
        game_river_step(app->river, NULL);
    }
}

static double cpu_now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* Time by the wall, and what all processors together worked for a frame: the latter is the same on a busy machine. */
static void print_rates(const char *name, double *ms, double *cpu_ms, uint32_t count) {
    double median = quantile(ms, count, 0.5), slow = quantile(ms, count, 0.95), cpu = quantile(cpu_ms, count, 0.5);
    printf("%-10s median %7.2f ms = %6.1f frames/s; 95 %% of frames within %7.2f ms; median of processor time %7.2f ms\n", name,
           median, 1000.0 / median, slow, cpu);
}

/* Each mode draws the same frames, in turn, with one untimed to warm the caches. */
static int run_tour(App *app) {
    static double ms[SCENE_CULLS][TOUR_FRAMES], cpu_ms[SCENE_CULLS][TOUR_FRAMES];
    uint32_t ticks = tour_ticks(app), frames = app->options.frames ? app->options.frames : TOUR_FRAMES;
    frames = frames > TOUR_FRAMES ? TOUR_FRAMES : frames;
    game_river_start(app->river, NULL);
    for (uint32_t frame = 0; frame < frames; frame++) {
        step_tour(app, ticks / frames);
        GameRiverView view = game_river_view(app->river);
        scene_look(&app->scene, view.eye_ws, enf_turn(view.yaw_deg, view.pitch_deg, 0.0), app->settings.fov);
        scene_measure(&app->scene, ENF_CULL_WORKLIST, 1.0);
        for (int cull = 0; app->options.stats && cull < SCENE_CULLS; cull++) {
            double before = cpu_now_ms();
            ms[cull][frame] = scene_measure(&app->scene, (EnfCull)cull, 1.0);
            cpu_ms[cull][frame] = cpu_now_ms() - before;
        }
    }
    if (app->options.stats) {
        printf("the guided tour, %.0f s, %u frames of %u x %u px, finished one by one\n", (double)ticks / ENF_TICK_RATE, frames,
               app->scene.width_px, app->scene.height_px);
        for (int cull = 0; cull < SCENE_CULLS; cull++) {
            print_rates(scene_cull_name((EnfCull)cull), ms[cull], cpu_ms[cull], frames);
        }
    }
    return ENF_EXIT_OK;
}

/* ---- all ------------------------------------------------------------------------------------------------------------------ */

int headless_run(App *app) {
    EnfError error = {0};
    app->settings = settings_default();
    if (!app->options.tour) {
        return run_game(app);
    }
    if (open_drawing(app, &error) != ENF_OK) {
        return app_fail(&error);
    }
    app->mode = APP_TOUR;
    int status = run_tour(app);
    return take_shot(app, &error) == ENF_OK ? status : app_fail(&error);
}
