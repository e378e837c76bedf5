/* enfilade: Night at the palace, and a walk through any compiled level. */
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/cli.h"
#include "front/app.h"
#include "front/heap.h"

static const char about[] =
    "A night at the palace: find exhibits and carry them out past the guards. Any other compiled level can be walked.\n"
    "Without --map it opens build/demo/palace.enfmap, which tools/run demo makes. Esc is the menu, where the keys are; F1 "
    "tells\n"
    "what the engine does. --record writes what you do as a recording that enfreplay verifies; --play shows one.\n"
    "Exit status: 0, 1 if something failed (with --play: or a tick differed), 2 for a wrong command line.";

static EnfCliResult parse(Options *o, int argc, char **argv) {
    double seed = 1.0;
    const EnfOption options[] = {
        {"--map", "-m", ENF_OPTION_TEXT, &o->map, "MAP.enfmap", NULL, "the level (the palace)"},
        {"--record", NULL, ENF_OPTION_TEXT, &o->record, "FILE", NULL, "record the game (.enfreplay)"},
        {"--play", NULL, ENF_OPTION_TEXT, &o->play, "FILE", NULL, "show a recording"},
        {"--speed", NULL, ENF_OPTION_NUMBER, &o->speed, "X", NULL, "of --play, times as fast (1)"},
        {"--headless", NULL, ENF_OPTION_FLAG, &o->headless, NULL, NULL, "no window; with --play, --tour or --shot"},
        {"--tour", NULL, ENF_OPTION_FLAG, &o->tour, NULL, NULL, "the guided tour at once"},
        {"--stats", NULL, ENF_OPTION_FLAG, &o->stats, NULL, NULL, "with --headless --tour: frame rates, culled and not"},
        {"--frames", NULL, ENF_OPTION_COUNT, &o->frames, "N", NULL, "quit after N frames"},
        {"--shot", NULL, ENF_OPTION_TEXT, &o->shot, "OUT.png", NULL, "write the last of --frames"},
        {"--size", NULL, ENF_OPTION_SIZE, o->size, "WxH", NULL, "of the window, pixels (as set; at first 1280x720)"},
        {"--fullscreen", NULL, ENF_OPTION_FLAG, &o->fullscreen, NULL, NULL, "the whole screen"},
        {"--seed", NULL, ENF_OPTION_NUMBER, &seed, "N", NULL, "of the game's dice (1)"},
        {"--river", NULL, ENF_OPTION_TEXT, &o->river, "FILE.csv", NULL, "the guided tour (maps/MAP/river.csv)"},
        {"--config", NULL, ENF_OPTION_TEXT, &o->config, "FILE.json", NULL, "the settings"},
        {"--tell", NULL, ENF_OPTION_FLAG, &o->tell, NULL, NULL, "say on stdout what goes on (for tests)"},
        {"--mute", NULL, ENF_OPTION_FLAG, &o->mute, NULL, NULL, "no sound"},
    };
    const EnfCli cli = {"enfilade", "[options]", about, options, sizeof options / sizeof *options};
    uint32_t count = 0;
    EnfCliResult result = enf_cli_parse(&cli, argc, argv, NULL, 0, &count);
    if (result != ENF_CLI_RUN) {
        return result;
    }
    if (!(seed >= 0.0 && seed <= (double)UINT32_MAX) || seed != floor(seed)) {
        return enf_cli_fail(&cli, "--seed takes a whole number from 0 to 2^32 - 1");
    }
    o->seed = (uint32_t)seed;
    if (!(o->speed > 0.0 && o->speed <= 1000.0)) {
        return enf_cli_fail(&cli, "--speed must be above 0 and at most 1000");
    }
    if (o->record && o->play) {
        return enf_cli_fail(&cli, "--record and --play exclude each other");
    }
    if (o->headless && !o->play && !o->tour) {
        return enf_cli_fail(&cli, "--headless needs --play FILE or --tour");
    }
    return ENF_CLI_RUN;
}

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
static void find_river(App *app) {
    char name[256], relative[300], path[PATH_MAX];
    const char *base = strrchr(app->options.map, '/');
    snprintf(name, sizeof name, "%s", base ? base + 1 : app->options.map);
    char *dot = strrchr(name, '.');
    if (dot) {
        *dot = '\0';
    }
    snprintf(relative, sizeof relative, "maps/%s/river.csv", name);
    const char *file = app->options.river ? app->options.river : find_file(relative, path) ? path : NULL;
    EnfError error = {0};
    if (file && enf_file_read(&app->river_file, file, (size_t)1 << 24, NULL, &error) != ENF_OK) {
        fprintf(stderr, "enfilade: %s: %s\n", error.file, error.message);
    }
}

static void find_sounds(App *app) {
    char path[PATH_MAX];
    if (!app->options.mute && find_file("assets/sounds/menu_move.wav", path)) {
        *strrchr(path, '/') = '\0';
        audio_load(&app->audio, path);
        if (!audio_open(&app->audio)) {
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
    if (o->size[0]) {
        app->settings.width = (double)o->size[0];
        app->settings.height = (double)o->size[1];
    }
    app->settings.fullscreen = app->settings.fullscreen || o->fullscreen;
}

int app_fail(App *app, const EnfError *error) {
    char text[1024];
    snprintf(text, sizeof text, "%s%s%s", error->file, *error->file ? ": " : "",
             *error->message ? error->message : enf_result_text(error->code));
    fprintf(stderr, "enfilade: %s\n", text);
    if (app->window && app->frames > 0 && !app->options.frames) {
        SDL_ShowSimpleMessageBox(SDL_MESSAGEBOX_ERROR, APP_NAME, text, app->window);
    }
    return ENF_EXIT_FAILURE;
}

/* ---- a frame ------------------------------------------------------------------------------------------------------------ */

static void draw_frame(App *app) {
    EnfVec3 eye_ws;
    EnfTurn turn;
    double alpha = modes_eye(app, &eye_ws, &turn);
    uint32_t width = (uint32_t)app->width_px, height = (uint32_t)app->height_px;
    scene_look(&app->scene, eye_ws, turn, app->settings.fov);
    engineer_measure(app, alpha);
    scene_see(&app->scene, alpha);
    scene_paint(&app->scene);
    engineer_lines(app);
    enf_gl_target_show(app->scene.target, width, height);
    canvas_begin(&app->canvas, width, height);
    hud_draw(app);
    engineer_draw(app);
    menu_draw(app);
    enf_gl_ui_draw(app->ui, app->canvas.vertices, app->canvas.count, width, height);
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
            draw_frame(app);
        }
        count_heap(app, heap);
        app->frames++;
        bool ends = app->options.frames && app->frames >= app->options.frames;
        ends = ends || (app->options.frames && app->play.replays && app->play.replay_ended);
        if (ends && app->options.shot && window_shot(app, app->options.shot, error) != ENF_OK) {
            status = app_fail(app, error);
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
    const char *replay = app->options.play;
    modes_title(app);
    app->options.play = replay;
    if (app->options.play || app->options.record) {
        result = modes_play(app, error);
    } else if (app->options.tour) {
        modes_tour(app);
    }
    return result;
}

static void save_at_end(App *app) {
    EnfError error = {0};
    if (*app->config && !app->options.size[0] && !app->options.fullscreen &&
        settings_write(&app->settings, app->config, &error) != ENF_OK) {
        fprintf(stderr, "enfilade: %s: %s\n", error.file, error.message);
    }
}

static int finish(App *app, int status) {
    EnfError error = {0};
    if (app->play.recorder && play_finish(&app->play, &error) != ENF_OK) {
        status = app_fail(app, &error);
    }
    if (app->play.diverged) {
        fprintf(stderr, "enfilade: the replay differs from its recording at tick %llu\n",
                (unsigned long long)app->play.divergence.tick);
        status = ENF_EXIT_FAILURE;
    }
    return status;
}

static int run_window(App *app) {
    EnfError error = {0};
    if (SDL_Init(SDL_INIT_VIDEO | SDL_INIT_GAMECONTROLLER | (app->options.mute ? 0U : SDL_INIT_AUDIO)) != 0 &&
        SDL_Init(SDL_INIT_VIDEO) != 0) {
        fprintf(stderr, "enfilade: no window system: %s\n", SDL_GetError());
        return ENF_EXIT_FAILURE;
    }
    find_settings(app);
    find_sounds(app);
    EnfResult result = window_open(app, &error);
    result = result ? result : loading_run(app, &error);
    result = result || app->quit ? result : begin(app, &error);
    int status = result ? app_fail(app, &error) : run_frames(app, &error);
    if (result == ENF_OK) {
        tell_end(app);
        save_at_end(app);
        status = finish(app, status);
    }
    return status;
}

static void close_all(App *app) {
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
    if (app->map_read) {
        enf_map_free(&app->map);
    }
    canvas_destroy(&app->canvas);
    enf_free(NULL, app->atlas, FONT_ATLAS_WIDTH, FONT_ATLAS_HEIGHT);
    SDL_Quit();
}

int main(int argc, char **argv) {
    static App app; /* some hundred KB: too much for a stack */
    char map_path[PATH_MAX];
    app.menu.waiting = -1;
    app.options.speed = 1.0;
    EnfCliResult parsed = parse(&app.options, argc, argv);
    if (parsed != ENF_CLI_RUN) {
        return parsed == ENF_CLI_DONE ? ENF_EXIT_OK : ENF_EXIT_USAGE;
    }
    if (!find_map(&app.options, map_path)) {
        return ENF_EXIT_FAILURE;
    }
    EnfError error = {0};
    int status;
    app.atlas = enf_alloc(NULL, FONT_ATLAS_WIDTH, FONT_ATLAS_HEIGHT);
    if (!app.atlas || canvas_create(&app.canvas, &error) != ENF_OK) {
        fprintf(stderr, "enfilade: no memory\n");
        status = ENF_EXIT_FAILURE;
    } else {
        font_draw_atlas(app.atlas);
        find_river(&app);
        status = app.options.headless ? headless_run(&app) : run_window(&app);
    }
    close_all(&app);
    return status;
}
