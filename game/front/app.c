/* Opens what was named, runs the program frame by frame, closes everything. What can be wrong with a map or a recording is found
 * before any window opens: who starts the program from a script reads one line on stderr and an exit status, at once. */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/cli.h"
#include "front/app.h"
#include "front/heap.h"

/* ---- files -------------------------------------------------------------------------------------------------------------- */

static bool is_there(const char *path) {
    return access(path, R_OK) == 0;
}

/* A file of the source tree, where it was built, or beside the program's build folder. */
static bool find_file(const char *relative, char path[PATH_MAX]) {
    const char *const roots[] = {".", ENF_SOURCE_DIR};
    for (size_t i = 0; i < sizeof roots / sizeof *roots; i++) {
        if (snprintf(path, PATH_MAX, "%s/%s", roots[i], relative) < PATH_MAX && is_there(path)) {
            return true;
        }
    }
    char *base = SDL_GetBasePath();
    bool found = false;
    static const char *const ups[] = {"", "../share/enfilade/", "../../../"};
    for (size_t i = 0; base && !found && i < sizeof ups / sizeof *ups; i++) {
        found = snprintf(path, PATH_MAX, "%s%s%s", base, ups[i], relative) < PATH_MAX && is_there(path);
    }
    SDL_free(base);
    return found;
}

static bool find_map(Options *options, char path[PATH_MAX]) {
    if (!options->map && find_file("build/demo/palace.enfmap", path)) {
        options->map = path;
    }
    if (!options->map) {
        fprintf(stderr,
                "enfilade: the palace is not compiled: run tools/run demo, or\n"
                "enfilade: enfc assets/palace/palace.glb --project maps/palace/palace.json -o build/demo/palace.enfmap,\n"
                "enfilade: or name another level with --map\n");
    }
    return options->map != NULL;
}

/* maps/NAME/river.csv for NAME.enfmap; a map without one has no tour. */
static EnfResult open_river(App *app, EnfError *error) {
    char name[256], relative[300], path[PATH_MAX];
    const char *base = strrchr(app->options.map, '/');
    snprintf(name, sizeof name, "%s", base ? base + 1 : app->options.map);
    char *dot = strrchr(name, '.');
    if (dot) {
        *dot = '\0';
    }
    snprintf(relative, sizeof relative, "maps/%s/river.csv", name);
    const char *file = app->options.river ? app->options.river : find_file(relative, path) ? path : NULL;
    if (!file && app->options.tour) {
        return enf_error_set(error, ENF_ERROR_ARGUMENT, UINT64_MAX, "this map has no guided tour: name one with --river");
    }
    return file ? enf_file_read(&app->river_file, file, (size_t)1 << 24, NULL, error) : ENF_OK;
}

/* Everything that was named, and what can be done with it without a window. */
static EnfResult open_files(App *app, EnfError *error) {
    EnfResult result = enf_map_read(&app->map, app->options.map, NULL, error);
    app->map_read = result == ENF_OK;
    result = result ? result : open_river(app, error);
    const Options *o = &app->options;
    if (result == ENF_OK && (o->play || o->record || (o->headless && !o->tour))) {
        result = play_open(&app->play, &app->map, &app->options, error);
    }
    return result;
}

static void find_sounds(App *app) {
    char path[PATH_MAX];
    if (!app->options.mute && find_file("assets/sounds/menu_move.wav", path)) {
        *strrchr(path, '/') = '\0';
        audio_load(&app->audio, path);
        if (SDL_InitSubSystem(SDL_INIT_AUDIO) != 0 || !audio_open(&app->audio)) {
            fprintf(stderr, "enfilade: no sound: %s\n", SDL_GetError());
        }
        audio_volume(&app->audio, app->settings.volume, app->settings.music);
    }
}

static void find_settings(App *app) {
    const Options *o = &app->options;
    app->settings = settings_default();
    if (o->config) {
        snprintf(app->config, sizeof app->config, "%s", o->config);
    } else if (!settings_find_path(app->config)) {
        app->config[0] = '\0';
    }
    EnfError error = {0};
    if (*app->config && settings_read(&app->settings, app->config, &error) != ENF_OK) {
        fprintf(stderr, "enfilade: %s: %s; the defaults are used\n", error.file, error.message);
    }
    app->kept = app->settings;
    app->size_once = o->size[0] != 0;
    app->fullscreen_once = o->fullscreen;
    if (app->size_once) {
        app->settings.width = (double)o->size[0];
        app->settings.height = (double)o->size[1];
    }
    app->settings.fullscreen = app->settings.fullscreen || o->fullscreen;
}

EnfResult app_save_settings(App *app, EnfError *error) {
    Settings s = app->settings;
    if (app->size_once) {
        s.width = app->kept.width;
        s.height = app->kept.height;
    }
    if (app->fullscreen_once) {
        s.fullscreen = app->kept.fullscreen;
    }
    if (!*app->config || settings_equal(&s, &app->kept)) {
        return ENF_OK;
    }
    app->kept = s;
    return settings_write(&s, app->config, error);
}

int app_fail(const EnfError *error) {
    fprintf(stderr, "enfilade: %s%s%s\n", error->file, *error->file ? ": " : "",
            *error->message ? error->message : enf_result_text(error->code));
    return ENF_EXIT_FAILURE;
}

/* ---- telling a test --------------------------------------------------------------------------------------------------------- */

static void tell(App *app) {
    static const char *const modes[] = {"loading", "title", "playing", "tour"};
    static const char *const menus[] = {"none", "title",   "pause", "settings", "controls",
                                        "keys", "picture", "sound", "won",      "lost"};
    int now = (int)app->mode * 64 + (int)menu_page(app) + 1;
    if (app->options.tell && now != app->told) {
        app->told = now;
        printf("mode %s menu %s\n", modes[app->mode], menus[menu_page(app)]);
        fflush(stdout);
    }
}

enum { WARM_FRAMES = 12 };

/* Heap calls of frames of undisturbed play. */
static void count_heap(App *app, unsigned long before) {
    bool plays = app->mode == APP_PLAYING && menu_page(app) == MENU_NONE;
    app->warm = plays ? app->warm + 1 : 0;
    if (app->warm > WARM_FRAMES) {
        app->warm_frames++;
        app->warm_heap += heap_calls() - before;
    }
}

static void tell_end(const App *app) {
    if (app->options.tell) {
        printf("frames %llu ticks %llu warm %llu heap %lu sounds %u mixed %u\n", (unsigned long long)app->frames,
               (unsigned long long)app->ticks, (unsigned long long)app->warm_frames, app->warm_heap,
               (unsigned)AUDIO_KINDS - app->audio.missing, atomic_load(&app->audio.frames));
    }
}

static int run_frames(App *app, EnfError *error) {
    double last = scene_now_ms();
    int status = ENF_EXIT_OK;
    while (!app->quit) {
        events_handle(app);
        tell(app);
        unsigned long heap = heap_calls();
        double now = scene_now_ms();
        modes_step(app, now - last);
        app->engineer.frame_ms[app->engineer.frame++ % GRAPH_FRAMES] = now - last;
        last = now;
        if (app->width_px > 0 && app->height_px > 0 && app->scene.target) {
            frame_draw(app);
        }
        count_heap(app, heap);
        app->frames++;
        bool ends = app->options.frames && app->frames >= app->options.frames;
        ends = ends || (app->options.frames && app->play.replays && app->play.replay_ended);
        if (ends && app->options.shot && frame_shot(app, app->options.shot, error) != ENF_OK) {
            status = app_fail(error);
        }
        SDL_GL_SwapWindow(app->window);
        app->quit = app->quit || ends;
        if (!app->focus) {
            SDL_Delay(30);
        }
    }
    return status;
}

static EnfResult begin(App *app, EnfError *error) {
    window_measure(app);
    EnfResult result = engineer_create(app, error);
    if (result != ENF_OK) {
        return result;
    }
    if (app->play.game) {
        return modes_enter(app, error);
    }
    modes_title(app);
    if (app->options.tour) {
        modes_tour(app);
    }
    return ENF_OK;
}

static int finish(App *app, int status) {
    EnfError error = {0};
    if (app_save_settings(app, &error) != ENF_OK) {
        fprintf(stderr, "enfilade: %s: %s\n", error.file, error.message);
    }
    if (app->play.recorder && play_finish(&app->play, &error) != ENF_OK) {
        status = app_fail(&error);
    }
    if (app->play.diverged) {
        fprintf(stderr, "enfilade: the replay differs from its recording at tick %llu\n",
                (unsigned long long)app->play.divergence.tick);
        status = ENF_EXIT_FAILURE;
    }
    return status;
}

static const char *variable(const char *name) {
    const char *value = SDL_getenv(name);
    return value && *value ? value : NULL;
}

/* SDL takes a driver that shows nothing where it finds no display; only who asks for it by name wants it. */
static bool shows_something(void) {
    static const char *const blind[] = {"offscreen", "dummy", "evdev"};
    bool shows = true;
    for (size_t i = 0; i < sizeof blind / sizeof *blind && !variable("SDL_VIDEODRIVER"); i++) {
        shows = shows && strcmp(SDL_GetCurrentVideoDriver(), blind[i]) != 0;
    }
    return shows;
}

static bool open_display(void) {
    if (!variable("SDL_VIDEODRIVER") && !variable("XDG_RUNTIME_DIR")) {
        SDL_SetHint(SDL_HINT_VIDEODRIVER, "x11,KMSDRM"); /* Wayland's library would complain in a line of its own */
    }
    if (SDL_Init(SDL_INIT_VIDEO) == 0 && shows_something()) {
        return true;
    }
    const char *named = variable("SDL_VIDEODRIVER"), *x11 = variable("DISPLAY"), *wayland = variable("WAYLAND_DISPLAY");
    const char *why = named     ? SDL_GetError()
                      : x11     ? "nothing answers at DISPLAY="
                      : wayland ? "nothing answers at WAYLAND_DISPLAY="
                                : "neither DISPLAY nor WAYLAND_DISPLAY is set";
    const char *where = named ? "" : x11 ? x11 : wayland ? wayland : "";
    fprintf(stderr, "enfilade: no display: %s%s; --headless plays recordings and the tour without one\n", why, where);
    return false;
}

static int run_window(App *app) {
    EnfError error = {0};
    if (!open_display()) {
        return ENF_EXIT_FAILURE;
    }
    SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER); /* the game goes on without */
    find_settings(app);
    find_sounds(app);
    EnfResult result = window_open(app, &error);
    result = result ? result : loading_run(app, &error);
    result = result || app->quit ? result : begin(app, &error);
    int status = result ? app_fail(&error) : run_frames(app, &error);
    if (result == ENF_OK) {
        tell_end(app);
        status = finish(app, status);
    }
    return status;
}

void app_close(App *app) {
    engineer_destroy(app);
    plan_destroy(&app->plan);
    scene_destroy(&app->scene);
    play_close(&app->play);
    enf_gl_destroy(app->gl);
    modes_tour_close(app);
    audio_free(&app->audio);
    if (app->input.pad) {
        SDL_GameControllerClose(app->input.pad);
    }
    window_close(app);
    enf_context_destroy(app->blind);
    if (app->map_read) {
        enf_map_free(&app->map);
    }
    canvas_destroy(&app->canvas);
    enf_free(NULL, app->atlas, FONT_ATLAS_WIDTH, FONT_ATLAS_HEIGHT);
    SDL_Quit();
    memset(app, 0, sizeof *app);
}

EnfResult app_open(App *app, EnfError *error) {
    app->menu.waiting = -1;
    app->atlas = enf_alloc(NULL, FONT_ATLAS_WIDTH, FONT_ATLAS_HEIGHT);
    if (!app->atlas) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for the letters");
    }
    font_draw_atlas(app->atlas);
    EnfResult result = canvas_create(&app->canvas, error);
    return result ? result : open_files(app, error);
}

int app_run(App *app) {
    char map_path[PATH_MAX];
    EnfError error = {0};
    if (!find_map(&app->options, map_path)) {
        return ENF_EXIT_FAILURE;
    }
    int status = app_open(app, &error) ? app_fail(&error) : app->options.headless ? headless_run(app) : run_window(app);
    app_close(app);
    return status;
}
