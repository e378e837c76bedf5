/* What the files of the program share. */
#ifndef GAME_FRONT_APP_H
#define GAME_FRONT_APP_H

#include <SDL.h>

#include "common/cli.h"
#include "front/audio.h"
#include "front/plan.h"
#include "front/scene.h"
#include "front/settings.h"
#include "inspect/inspect.h"
#include "sim/river.h"

#define APP_NAME "Enfilade"

typedef struct Options {
    const char *map, *record, *play, *config, *river, *shot;
    bool headless, fullscreen, mute, tour, stats, tell;
    uint32_t size[2]; /**< 0: of the settings */
    uint32_t frames;  /**< 0: until the person quits */
    uint32_t seed;
    double speed; /**< of --play */
} Options;
/** Fills zeroed options; a message is on stderr if they make no sense (options.c). */
EnfCliResult options_parse(Options *options, int argc, char **argv);

/* ---- the game that is played, play.c ------------------------------------------------------------------------------ */

/** A game and, if wanted, its recording, or a recording that plays it. */
typedef struct Play {
    GameDef def;
    Game *game;
    EnfRecorder *recorder;
    bool replays;
    EnfReplay replay;
    EnfReplayCursor cursor;
    bool diverged, replay_ended;
    EnfReplayDivergence divergence;
} Play;
EnfResult play_open(Play *play, const EnfMap *map, const Options *options, EnfError *error);
void play_close(Play *play);
/** A tick with this input (ignored by a replay). Errors of a recording are shown once and end it. */
void play_step(Play *play, const EnfInput *input);
/** Ends the recording, if there is one. */
EnfResult play_finish(Play *play, EnfError *error);

/* ---- input.c -------------------------------------------------------------------------------------------------------- */

typedef struct Input {
    bool held[ACTION_COUNT];
    bool mouse_use, mouse_drop;
    uint32_t tapped;           /**< buttons pressed since the last tick: one let go again before it counts */
    double yaw_deg, pitch_deg; /**< turned by the mouse and not yet given to a tick */
    bool noclip, fly;
    SDL_GameController *pad;
    double pad_forward, pad_right, pad_yaw, pad_pitch; /**< -1..1 */
    uint32_t pad_buttons;
    bool pad_used;      /**< the pad was the last to be used, not keys or mouse: what prompts name */
    bool pad_pushed[2]; /**< in a menu: the left stick stands aside, left or right; up or down */
} Input;
void input_release(Input *input); /**< as if every key was let go */
void input_tap(Input *input, Action action);
EnfInput input_take(Input *input, const Settings *settings, double pitch_deg);

/* ---- menu.c ------------------------------------------------------------------------------------------------------ */

typedef enum MenuPage {
    MENU_NONE,
    MENU_TITLE,
    MENU_PAUSE,
    MENU_SETTINGS,
    MENU_CONTROLS,
    MENU_KEYS,
    MENU_PICTURE,
    MENU_SOUND,
    MENU_WON,
    MENU_LOST
} MenuPage;
enum { MENU_DEPTH = 6 };
typedef struct Menu {
    MenuPage stack[MENU_DEPTH];
    uint32_t depth; /**< 0: none */
    uint32_t chosen[MENU_DEPTH];
    int waiting;        /**< the action that waits for a key, or -1 */
    double rows[16][4]; /**< boxes of what was drawn last, for the mouse */
    uint32_t row_count;
} Menu;

/* ---- all ------------------------------------------------------------------------------------------------------------ */

typedef enum AppMode { APP_LOADING, APP_TITLE, APP_PLAYING, APP_TOUR } AppMode;

enum { GRAPH_FRAMES = 240 };

/** The engineer's overlay. */
typedef struct Engineer {
    bool counters, plan, wireframe, measures;
    uint32_t lines; /**< INSPECT_* */
    InspectMemory memory;
    double frame_ms[GRAPH_FRAMES]; /**< a ring */
    uint32_t frame;
    double cull_ms[SCENE_CULLS]; /**< a running mean of each mode */
    uint32_t cull_turn;
    uint8_t *lit; /**< a cell */
} Engineer;

typedef struct App {
    Options options;
    Settings settings;               /**< that hold now */
    Settings kept;                   /**< as the file has them */
    bool size_once, fullscreen_once; /**< of the command line: not the person's own, and never saved */
    char config[SETTINGS_PATH_SIZE]; /**< "" : nowhere to save */
    SDL_Window *window;
    SDL_GLContext context;
    EnfContext *blind;       /**< without a window; else NULL */
    int width_px, height_px; /**< of the window, in pixels */
    EnfGlUi *ui;
    Canvas canvas;
    uint8_t *atlas;
    EnfMap map;
    bool map_read;
    EnfGl *gl;
    Scene scene;
    Play play;
    EnfWorld *tour_world; /**< of title and guided tour: doors stand open */
    EnfPortals tour_portals;
    EnfCollider *tour_collider;
    GameRiver *river; /**< or NULL: the map has none */
    EnfFile river_file;
    Plan plan;
    Audio audio;
    Input input;
    Menu menu;
    Engineer engineer;
    AppMode mode;
    bool quit, focus, captured, map_shown, over_shown;
    double behind_ms;       /**< time that the simulation has not yet seen */
    double over_ms;         /**< since the game was won or lost */
    uint64_t frames, ticks; /**< frames: without those of the loading screen, of which a slow machine shows more */
    uint64_t over_tick;     /**< of the game: the last in which it was neither won nor lost */
    uint32_t shots;
    int told;                /**< --tell: the mode and menu that were told last */
    uint32_t warm;           /**< frames of play since something was opened or changed */
    unsigned long warm_heap; /**< heap calls in warm frames */
    uint64_t warm_frames;
    char notice[128]; /**< of the program, not the game */
    double notice_until_ms;
} App;

/* window.c: the window, its context and the frame that is shown */
EnfResult window_open(App *app, EnfError *error);
void window_close(App *app);
EnfResult window_ui(App *app, EnfError *error); /**< the user interface in the current context */
void window_measure(App *app);                  /**< asks for its size; a target of that size */
void window_apply(App *app);                    /**< size and fullscreen as set */
void window_capture(App *app, bool on);         /**< the mouse turns the head */
void *window_load(const char *name);

/* frame.c */
void frame_draw(App *app);
/** Writes what was drawn last as a picture. */
EnfResult frame_shot(App *app, const char *path, EnfError *error);

/* loading.c */
EnfResult loading_run(App *app, EnfError *error);

/* events.c */
void events_handle(App *app);

/* modes.c: what is going on, tick by tick */
void modes_title(App *app);
EnfResult modes_play(App *app, EnfError *error);  /**< a new game, or the recording of the options */
EnfResult modes_enter(App *app, EnfError *error); /**< the game that is open */
void modes_tour(App *app);
void modes_step(App *app, double elapsed_ms); /**< the ticks of that time, as many as are due; none while paused */
void modes_tick(App *app);                    /**< one */
/** Where the picture is taken from now, and how far it is between ticks. */
double modes_eye(const App *app, EnfVec3 *eye_ws, EnfTurn *turn);
/** The world of title and tour, and the river in it if its file is there. */
EnfResult modes_tour_world(App *app, EnfError *error);
void modes_tour_close(App *app);

/* menu.c */
void menu_open(App *app, MenuPage page); /**< over the others */
void menu_close_all(App *app);
void menu_back(App *app);
void menu_draw(App *app);
void menu_move(App *app, int step);
void menu_change(App *app, int step); /**< a slider or a switch */
void menu_press(App *app);
bool menu_take_key(App *app, SDL_Scancode code); /**< true: it waited for that */
void menu_mouse(App *app, double x, double y, bool pressed);
MenuPage menu_page(const App *app);

/* hud.c */
void hud_draw(App *app);
void hud_notice(App *app, const char *text);

/* engineer.c */
EnfResult engineer_create(App *app, EnfError *error);
void engineer_destroy(App *app);
bool engineer_key(App *app, SDL_Scancode code);
void engineer_lines(App *app); /**< over the picture in the bound target */
void engineer_draw(App *app);  /**< over everything */
void engineer_measure(App *app, double alpha);

/* headless.c */
int headless_run(App *app);
/** All that a frame takes but for a window; the map is read. Its pictures are width × height. */
EnfResult headless_open(App *app, uint32_t width, uint32_t height, EnfError *error);

/* app.c */
/** What needs neither window nor device: the files that were named, and what lies between them and a picture. */
EnfResult app_open(App *app, EnfError *error);
/** Closes whatever is open, and zeroes it. */
void app_close(App *app);
/** The program, with options that were parsed; returns its exit status. Leaves nothing behind. */
int app_run(App *app);
/** Says what went wrong on stderr; returns ENF_EXIT_FAILURE. Nothing waits: who reads it may be a script. */
int app_fail(const EnfError *error);
/** Writes what the person has set, if it has changed; what the command line said for once is not among it. */
EnfResult app_save_settings(App *app, EnfError *error);

#endif
