/* Puts the map, which is read and checked, on the graphics card while the window stays alive: a second context of the same window
 * makes the pictures meanwhile, since the one that will draw belongs to the thread that loads. */
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "front/app.h"

typedef enum LoadStage { LOAD_UPLOAD, LOAD_PREPARE, LOAD_DONE } LoadStage;

typedef struct Loading {
    App *app;
    SDL_GLContext context; /* that will draw */
    atomic_int stage;
    EnfError error;
    EnfResult result;
} Loading;

static const char *const stage_names[] = {"Lighting the rooms", "Opening the doors", ""};
/* Where the bar is when a stage begins, and how long it usually takes, seconds: the bar nears its end without getting there. */
static const double stage_begins[] = {0.0, 0.9, 1.0}, stage_seconds[] = {3.0, 0.5, 1.0};

static EnfResult load(Loading *loading) {
    App *app = loading->app;
    EnfError *error = &loading->error;
    if (SDL_GL_MakeCurrent(app->window, loading->context) != 0) {
        return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "%s", SDL_GetError());
    }
    EnfResult result = enf_gl_create(&app->gl, &app->map, window_load, error);
    atomic_store(&loading->stage, LOAD_PREPARE);
    result = result ? result : scene_create(&app->scene, &app->map, app->gl, window_load, error);
    result = result ? result : plan_create(&app->plan, &app->map, error);
    result = result ? result : modes_tour_world(app, error);
    app->scene.finish ? app->scene.finish() : (void)0;
    SDL_GL_MakeCurrent(app->window, NULL);
    return result;
}

static int SDLCALL load_thread(void *user) {
    Loading *loading = user;
    loading->result = load(loading);
    atomic_store(&loading->stage, LOAD_DONE);
    return 0;
}

static void draw(App *app, int stage, double stage_ms, double share) {
    Canvas *c = &app->canvas;
    SDL_GL_GetDrawableSize(app->window, &app->width_px, &app->height_px);
    uint32_t width = (uint32_t)app->width_px, height = (uint32_t)app->height_px;
    canvas_begin(c, width, height);
    CanvasStyle title = canvas_style(44.0 * c->unit, 0xffc8e0f0u);
    title.align = CANVAS_CENTER;
    title.pen = 0.07;
    title.spread = 6.0;
    canvas_text(c, &title, 0.5 * c->width, 0.46 * c->height, "ENFILADE");
    CanvasStyle small = canvas_style(12.0 * c->unit, canvas_fade(0xffa0a8b0u, 0.8));
    small.align = CANVAS_CENTER;
    canvas_text(c, &small, 0.5 * c->width, 0.46 * c->height + 84.0 * c->unit, stage_names[stage]);
    double bar = 320.0 * c->unit, left = 0.5 * (c->width - bar), y = 0.46 * c->height + 44.0 * c->unit;
    const double whole[4] = {left, y, bar, 3.0 * c->unit}, done[4] = {left, y, bar * share, 3.0 * c->unit};
    canvas_rectangle(c, whole, 0x40ffffffu);
    canvas_rectangle(c, done, 0xff60b0e8u);
    double sweep = stage_ms * 0.0006 - (double)(int)(stage_ms * 0.0006);
    const double glint[4] = {left + bar * share * sweep, y, 18.0 * c->unit, 3.0 * c->unit};
    if (glint[0] + glint[2] < left + bar * share) {
        canvas_rectangle(c, glint, 0xa0ffffffu);
    }
    enf_gl_ui_clear(app->ui, width, height, 0xff14100cu);
    enf_gl_ui_draw(app->ui, c->vertices, c->count, width, height);
    SDL_GL_SwapWindow(app->window);
}

static double progress(int stage, double stage_ms) {
    double t = stage_ms * 1e-3 / stage_seconds[stage],
           room = stage < LOAD_DONE ? stage_begins[stage + 1] - stage_begins[stage] : 0.0;
    return stage_begins[stage] + room * (t / (t + 0.6));
}

/* Shows how far it is; a wish to quit is obeyed when the thread is done. */
static void watch(Loading *loading) {
    App *app = loading->app;
    int shown = LOAD_UPLOAD, stage;
    double since = scene_now_ms();
    while ((stage = atomic_load(&loading->stage)) != LOAD_DONE) {
        double now = scene_now_ms();
        if (stage != shown) {
            shown = stage;
            since = now;
        }
        SDL_Event event;
        while (SDL_PollEvent(&event)) {
            app->quit = app->quit || event.type == SDL_QUIT;
        }
        draw(app, stage, now - since, progress(stage, now - since));
        SDL_Delay(30);
    }
}

EnfResult loading_run(App *app, EnfError *error) {
    Loading loading = {.app = app, .result = ENF_OK};
    SDL_GLContext painter = app->context;
    loading.context = SDL_GL_CreateContext(app->window);
    if (!loading.context || SDL_GL_MakeCurrent(app->window, painter) != 0) {
        return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "no second context: %s", SDL_GetError());
    }
    SDL_Thread *thread = SDL_CreateThread(load_thread, "loading", &loading);
    if (!thread) {
        SDL_GL_DeleteContext(loading.context);
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no thread: %s", SDL_GetError());
    }
    watch(&loading);
    SDL_WaitThread(thread, NULL);
    enf_gl_ui_destroy(app->ui);
    app->ui = NULL;
    app->context = loading.context;
    SDL_GL_MakeCurrent(app->window, app->context);
    SDL_GL_DeleteContext(painter);
    SDL_GL_SetSwapInterval(app->settings.vsync ? 1 : 0);
    if (loading.result != ENF_OK) {
        *error = loading.error;
        return loading.result;
    }
    return window_ui(app, error);
}
