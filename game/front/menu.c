/* Makes the menus: tables of rows; what a row shows and does is in one place. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "front/app.h"

typedef enum RowKind { ROW_ACT, ROW_PAGE, ROW_BACK, ROW_NUMBER, ROW_FLAG, ROW_KEY, ROW_SIZE } RowKind;
typedef struct Row {
    RowKind kind;
    const char *label;
    int what;                     /* ROW_ACT: an Act; ROW_PAGE: a MenuPage; ROW_KEY: an Action */
    size_t field;                 /* in Settings */
    double step, range[2], shown; /* ROW_NUMBER; shown: factor of what is printed */
} Row;
typedef enum Act { ACT_NEW, ACT_TOUR, ACT_QUIT, ACT_RESUME, ACT_RESTART, ACT_TITLE, ACT_DEFAULTS } Act;
typedef struct Page {
    const char *title;
    const Row *rows;
    uint32_t count;
} Page;

#define FIELD(name) offsetof(Settings, name)
#define NUMBER(label, name, step, least, most, shown)                                                                          \
    { ROW_NUMBER, label, 0, FIELD(name), step, {least, most}, shown }
#define FLAG(label, name)                                                                                                      \
    { ROW_FLAG, label, 0, FIELD(name), 0.0, {0.0, 0.0}, 0.0 }
#define PLAIN(kind, label, what)                                                                                               \
    { kind, label, what, 0, 0.0, {0.0, 0.0}, 0.0 }

static const Row title_rows[] = {PLAIN(ROW_ACT, "New game", ACT_NEW), PLAIN(ROW_ACT, "Guided tour", ACT_TOUR),
                                 PLAIN(ROW_PAGE, "Settings", MENU_SETTINGS), PLAIN(ROW_ACT, "Quit", ACT_QUIT)};
static const Row pause_rows[] = {PLAIN(ROW_ACT, "Resume", ACT_RESUME), PLAIN(ROW_ACT, "Start again", ACT_RESTART),
                                 PLAIN(ROW_PAGE, "Settings", MENU_SETTINGS), PLAIN(ROW_ACT, "Back to the title", ACT_TITLE),
                                 PLAIN(ROW_ACT, "Quit", ACT_QUIT)};
static const Row settings_rows[] = {PLAIN(ROW_PAGE, "Controls", MENU_CONTROLS), PLAIN(ROW_PAGE, "Keys", MENU_KEYS),
                                    PLAIN(ROW_PAGE, "Picture", MENU_PICTURE),   PLAIN(ROW_PAGE, "Sound", MENU_SOUND),
                                    PLAIN(ROW_ACT, "Defaults", ACT_DEFAULTS),   PLAIN(ROW_BACK, "Back", 0)};
static const Row control_rows[] = {NUMBER("Sensitivity", sensitivity, 0.1, 0.1, 5.0, 1.0), FLAG("Invert up and down", invert),
                                   PLAIN(ROW_BACK, "Back", 0)};
static const Row picture_rows[] = {NUMBER("Field of view", fov, 1.0, 45.0, 100.0, 1.0),
                                   PLAIN(ROW_SIZE, "Window", 0),
                                   FLAG("Full screen", fullscreen),
                                   NUMBER("Drawn at, %", render_scale, 0.05, 0.25, 1.0, 100.0),
                                   FLAG("Wait for the screen", vsync),
                                   PLAIN(ROW_BACK, "Back", 0)};
static const Row sound_rows[] = {NUMBER("Volume, %", volume, 0.05, 0.0, 1.0, 100.0),
                                 NUMBER("Music, %", music, 0.05, 0.0, 1.0, 100.0), PLAIN(ROW_BACK, "Back", 0)};
static const Row key_rows[] = {
#define KEY_ROW(name, key, label, code) PLAIN(ROW_KEY, label, ACTION_##name),
    SETTINGS_ACTIONS(KEY_ROW)
#undef KEY_ROW
        PLAIN(ROW_BACK, "Back", 0)};
static const Row over_rows[] = {PLAIN(ROW_ACT, "Play again", ACT_RESTART), PLAIN(ROW_ACT, "Back to the title", ACT_TITLE),
                                PLAIN(ROW_ACT, "Quit", ACT_QUIT)};

#define PAGE(title, rows)                                                                                                      \
    { title, rows, sizeof rows / sizeof *rows }
static const Page pages[] = {
    [MENU_TITLE] = PAGE("ENFILADE", title_rows),
    [MENU_PAUSE] = PAGE("Paused", pause_rows),
    [MENU_SETTINGS] = PAGE("Settings", settings_rows),
    [MENU_CONTROLS] = PAGE("Controls", control_rows),
    [MENU_KEYS] = PAGE("Keys", key_rows),
    [MENU_PICTURE] = PAGE("Picture", picture_rows),
    [MENU_SOUND] = PAGE("Sound", sound_rows),
    [MENU_WON] = PAGE("You got away with it", over_rows),
    [MENU_LOST] = PAGE("They have you", over_rows),
};

/* Windows that the menu offers. */
static const double sizes[][2] = {{960, 540}, {1280, 720}, {1600, 900}, {1920, 1080}, {2560, 1440}};
enum { SIZES = sizeof sizes / sizeof *sizes };

/* ---- the stack ------------------------------------------------------------------------------------------------------ */

MenuPage menu_page(const App *app) {
    return app->menu.depth ? app->menu.stack[app->menu.depth - 1] : MENU_NONE;
}

void menu_open(App *app, MenuPage page) {
    Menu *menu = &app->menu;
    if (menu->depth < MENU_DEPTH) {
        menu->stack[menu->depth] = page;
        menu->chosen[menu->depth++] = 0;
        menu->waiting = -1;
        menu->row_count = 0;
    }
}

void menu_close_all(App *app) {
    app->menu.depth = 0;
    app->menu.waiting = -1;
    app->menu.row_count = 0;
}

static void save(App *app) {
    EnfError error = {0};
    if (app_save_settings(app, &error) != ENF_OK) {
        hud_notice(app, "The settings could not be saved");
        SDL_Log("%s: %s", error.file, error.message);
    }
}

static void apply(App *app) {
    audio_volume(&app->audio, app->settings.volume, app->settings.music);
    window_apply(app);
}

void menu_back(App *app) {
    Menu *menu = &app->menu;
    MenuPage page = menu_page(app);
    if (menu->waiting >= 0) {
        menu->waiting = -1;
    } else if (page == MENU_PAUSE) {
        menu_close_all(app);
        window_capture(app, true);
    } else if (menu->depth > 1) {
        if (page == MENU_SETTINGS) {
            save(app);
        }
        menu->depth--;
        menu->row_count = 0;
        audio_play(&app->audio, AUDIO_MENU_BACK);
    }
}

/* ---- what rows do ------------------------------------------------------------------------------------------------- */

static const Page *page_of(const App *app) {
    return &pages[menu_page(app)];
}

static const Row *chosen_row(const App *app) {
    return &page_of(app)->rows[app->menu.chosen[app->menu.depth - 1]];
}

static double *number_of(App *app, const Row *row) {
    return (double *)(void *)((char *)&app->settings + row->field);
}

static bool *flag_of(App *app, const Row *row) {
    return (bool *)(void *)((char *)&app->settings + row->field);
}

static void start_game(App *app) {
    EnfError error = {0};
    if (modes_play(app, &error) != ENF_OK) {
        hud_notice(app, error.message);
    }
}

static void restart_game(App *app) {
    if (app->play.replays) {
        start_game(app);
        return;
    }
    EnfInput again = {0, 0, 0, 0, GAME_BUTTON_RESTART};
    play_step(&app->play, &again);
    scene_tick(&app->scene);
    app->over_ms = 0.0;
    app->over_shown = false;
    input_release(&app->input);
    menu_close_all(app);
    window_capture(app, true);
}

static void act(App *app, Act what) {
    switch (what) {
    case ACT_NEW:
        start_game(app);
        break;
    case ACT_TOUR:
        modes_tour(app);
        break;
    case ACT_QUIT:
        app->quit = true;
        break;
    case ACT_RESUME:
        menu_back(app);
        break;
    case ACT_RESTART:
        restart_game(app);
        break;
    case ACT_TITLE:
        modes_title(app);
        break;
    case ACT_DEFAULTS:
        app->settings = settings_default();
        app->size_once = app->fullscreen_once = false;
        hud_notice(app, "All settings are as they were at first");
        apply(app);
        break;
    }
}

void menu_move(App *app, int step) {
    Menu *menu = &app->menu;
    if (menu->depth && menu->waiting < 0) {
        uint32_t count = page_of(app)->count, *chosen = &menu->chosen[menu->depth - 1];
        *chosen = (*chosen + count + (step > 0 ? 1U : count - 1U)) % count;
        audio_play(&app->audio, AUDIO_MENU_MOVE);
    }
}

static void change_size(App *app, int step) {
    Settings *s = &app->settings;
    int at = 0;
    while (at + 1 < SIZES && sizes[at][0] < s->width) {
        at++;
    }
    at += step;
    at = at < 0 ? 0 : at >= SIZES ? SIZES - 1 : at;
    app->size_once = false;
    s->width = sizes[at][0];
    s->height = sizes[at][1];
}

void menu_change(App *app, int step) {
    if (!app->menu.depth || app->menu.waiting >= 0) {
        return;
    }
    const Row *row = chosen_row(app);
    if (row->kind == ROW_NUMBER) {
        double *value = number_of(app, row);
        double steps = floor(*value / row->step + 0.5) + (double)step, wanted = steps * row->step;
        *value = wanted < row->range[0] ? row->range[0] : wanted > row->range[1] ? row->range[1] : wanted;
    } else if (row->kind == ROW_FLAG) {
        app->fullscreen_once = app->fullscreen_once && row->field != FIELD(fullscreen);
        *flag_of(app, row) = !*flag_of(app, row);
    } else if (row->kind == ROW_SIZE) {
        change_size(app, step);
    } else {
        return;
    }
    audio_play(&app->audio, AUDIO_MENU_MOVE);
    apply(app);
}

void menu_press(App *app) {
    if (!app->menu.depth || app->menu.waiting >= 0) {
        return;
    }
    const Row *row = chosen_row(app);
    audio_play(&app->audio, row->kind == ROW_BACK ? AUDIO_MENU_BACK : AUDIO_MENU_SELECT);
    switch (row->kind) {
    case ROW_ACT:
        act(app, (Act)row->what);
        break;
    case ROW_PAGE:
        menu_open(app, (MenuPage)row->what);
        break;
    case ROW_BACK:
        menu_back(app);
        break;
    case ROW_KEY:
        app->menu.waiting = row->what;
        break;
    case ROW_NUMBER:
    case ROW_FLAG:
    case ROW_SIZE:
        menu_change(app, 1);
        break;
    }
}

/* Whatever had the key before loses it: no key does two things. */
bool menu_take_key(App *app, SDL_Scancode code) {
    int action = app->menu.waiting;
    if (action < 0) {
        return false;
    }
    app->menu.waiting = -1;
    bool reserved = code == SDL_SCANCODE_ESCAPE || (code >= SDL_SCANCODE_F1 && code <= SDL_SCANCODE_F12);
    if (!reserved) {
        for (int i = 0; i < ACTION_COUNT; i++) {
            if (app->settings.keys[i] == (int)code) {
                app->settings.keys[i] = app->settings.keys[action];
            }
        }
        app->settings.keys[action] = (int)code;
        audio_play(&app->audio, AUDIO_MENU_SELECT);
    }
    return true;
}

void menu_mouse(App *app, double x, double y, bool pressed) {
    Menu *menu = &app->menu;
    for (uint32_t i = 0; menu->depth && menu->waiting < 0 && i < menu->row_count; i++) {
        const double *box = menu->rows[i];
        if (x >= box[0] && y >= box[1] && x < box[0] + box[2] && y < box[1] + box[3]) {
            if (menu->chosen[menu->depth - 1] != i) {
                menu->chosen[menu->depth - 1] = i;
                audio_play(&app->audio, AUDIO_MENU_MOVE);
            }
            if (pressed) {
                menu_press(app);
            }
            return;
        }
    }
}

/* ---- drawing -------------------------------------------------------------------------------------------------------- */

static void value_text(App *app, const Row *row, char text[64]) {
    text[0] = '\0';
    if (row->kind == ROW_NUMBER) {
        double value = *number_of(app, row) * row->shown;
        snprintf(text, 64, row->step * row->shown < 1.0 ? "< %.1f >" : "< %.0f >", value);
    } else if (row->kind == ROW_FLAG) {
        snprintf(text, 64, "%s", *flag_of(app, row) ? "yes" : "no");
    } else if (row->kind == ROW_SIZE) {
        snprintf(text, 64, "< %.0f x %.0f >", app->settings.width, app->settings.height);
    } else if (row->kind == ROW_KEY) {
        bool waits = app->menu.waiting == row->what;
        snprintf(text, 64, "%.60s", waits ? "press a key" : SDL_GetScancodeName((SDL_Scancode)app->settings.keys[row->what]));
    }
}

static void draw_row(App *app, const Row *row, bool chosen, const double box[4]) {
    Canvas *c = &app->canvas;
    if (chosen) {
        const double mark[4] = {box[0], box[1] + 0.2 * box[3], 3.0 * c->unit, 0.6 * box[3]};
        canvas_gradient(c, box, 0x5060b0e8u, 0x1060b0e8u);
        canvas_rectangle(c, mark, 0xff60b0e8u);
    }
    CanvasStyle style = canvas_style(0.34 * box[3], chosen ? 0xffffffffu : 0xffc8ccd0u);
    double base = box[1] + 0.67 * box[3];
    canvas_text(c, &style, box[0] + 16.0 * c->unit, base, row->label);
    char text[64];
    value_text(app, row, text);
    style.align = CANVAS_RIGHT;
    style.rgba = chosen ? 0xff90d0f8u : 0xff9098a0u;
    canvas_text(c, &style, box[0] + box[2] - 14.0 * c->unit, base, text);
}

static const char *subtitle(const App *app, char text[96]) {
    MenuPage page = menu_page(app);
    const GameState *s = app->play.game ? game_state(app->play.game) : NULL;
    if (page == MENU_TITLE) {
        snprintf(text, 96, "Night at the palace");
    } else if (s && (page == MENU_WON || page == MENU_LOST)) {
        unsigned seconds = (unsigned)(app->over_tick / ENF_TICK_RATE);
        snprintf(text, 96, "%u of %u exhibits carried out, worth %u, in %u:%02u", s->delivered, s->wanted, s->score,
                 seconds / 60, seconds % 60);
    } else if (s && page == MENU_PAUSE) {
        snprintf(text, 96, "%u of %u exhibits carried out", s->delivered, s->wanted);
    } else {
        text[0] = '\0';
    }
    return text;
}

/* How a menu is used, at its foot. */
static void draw_hint(App *app) {
    Canvas *c = &app->canvas;
    CanvasStyle style = canvas_style(11.0 * c->unit, 0xffa0a8b0u);
    bool last = menu_page(app) == MENU_TITLE || app->over_shown, pad = app->input.pad_used; /* nothing lies behind it */
    const char *text = app->menu.waiting >= 0 ? "Press the key that shall do this. Esc: leave it as it is"
                       : pad                  ? "Stick: choose, change    A: do it    B: back"
                       : last                 ? "Arrows or mouse: choose    Enter: do it"
                                              : "Arrows or mouse: choose, change    Enter: do it    Esc: back";
    canvas_text(c, &style, 64.0 * c->unit, c->height - 28.0 * c->unit, text);
}

void menu_draw(App *app) {
    if (!app->menu.depth) {
        return;
    }
    Canvas *c = &app->canvas;
    const Page *page = page_of(app);
    bool is_title = menu_page(app) == MENU_TITLE;
    double left = 64.0 * c->unit, wide = left + 420.0 * c->unit;
    const double all[4] = {0.0, 0.0, c->width, c->height}, side[4] = {0.0, 0.0, wide, c->height};
    const double edge[4] = {wide, 0.0, 160.0 * c->unit, c->height};
    canvas_rectangle(c, all, is_title ? 0x20000000u : 0x50080604u);
    canvas_gradient(c, side, 0xe0120c08u, 0xb0120c08u); /* dark enough to read values on, whatever is behind */
    canvas_gradient(c, edge, 0xb0120c08u, 0x00120c08u);
    double row_height = (page->count > 8 ? 36.0 : 44.0) * c->unit;
    double top = 0.5 * c->height - 0.5 * row_height * (double)page->count + 40.0 * c->unit;
    CanvasStyle title = canvas_style((is_title ? 46.0 : 28.0) * c->unit, 0xffe8f0f8u);
    title.pen = is_title ? 0.075 : 0.09;
    title.spread = is_title ? 5.0 : 1.0;
    canvas_text(c, &title, left, top - 64.0 * c->unit, page->title);
    char text[96];
    CanvasStyle small = canvas_style(13.0 * c->unit, 0xff78b8e8u);
    canvas_text(c, &small, left + 2.0, top - 30.0 * c->unit, subtitle(app, text));
    app->menu.row_count = page->count;
    for (uint32_t i = 0; i < page->count; i++) {
        double *box = app->menu.rows[i];
        box[0] = left - 16.0 * c->unit;
        box[1] = top + row_height * (double)i;
        box[2] = 400.0 * c->unit;
        box[3] = row_height;
        draw_row(app, &page->rows[i], app->menu.chosen[app->menu.depth - 1] == i, box);
    }
    draw_hint(app);
}
