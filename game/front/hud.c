/* What a player sees over the picture: crosshair, prompts, what is carried, whether they are seen; the map of the building. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "front/app.h"

#define WARM 0xff60b0e8u
#define PALE 0xffd8e0e8u
#define DIM 0xff9098a0u
#define ALARM 0xff3838f0u
#define CALM 0xff90c060u
#define NOTICE_MS 3500.0

void hud_notice(App *app, const char *text) {
    snprintf(app->notice, sizeof app->notice, "%s", text);
    app->notice_until_ms = scene_now_ms() + NOTICE_MS;
}

static void crosshair(Canvas *c, bool warm) {
    double r = (warm ? 3.2 : 1.8) * c->unit, x = 0.5 * c->width, y = 0.5 * c->height;
    const double dot[4] = {x - 0.5 * r, y, x + 0.5 * r, y};
    canvas_line(c, dot, r + 2.0, 0x60000000u);
    canvas_line(c, dot, r, warm ? 0xff80d0ffu : 0xc0ffffffu);
}

/* Of the device that was used last. */
static const char *key_name(const App *app, Action action) {
    static const char *const pad[ACTION_COUNT] = {[ACTION_FORWARD] = "Left stick",
                                                  [ACTION_JUMP] = "A",
                                                  [ACTION_CROUCH] = "B",
                                                  [ACTION_RUN] = "Right trigger",
                                                  [ACTION_USE] = "X",
                                                  [ACTION_DROP] = "Y",
                                                  [ACTION_MAP] = "Back"};
    return app->input.pad_used && pad[action] ? pad[action] : SDL_GetScancodeName((SDL_Scancode)app->settings.keys[action]);
}

/* A line of text on a soft ground, in the middle. */
static void caption(Canvas *c, double y, double size, uint32_t rgba, const char *text) {
    if (!*text) {
        return;
    }
    CanvasStyle style = canvas_style_fitted(size, rgba, text, c->width - 4.4 * size);
    style.align = CANVAS_CENTER;
    double width = canvas_text_width(&style, text) + 2.4 * size;
    const double ground[4] = {0.5 * (c->width - width), y - 1.75 * size, width, 2.6 * size};
    canvas_rectangle(c, ground, 0xa8100c08u);
    canvas_text(c, &style, 0.5 * c->width, y, text);
}

/* What `use` would do, and the key for it. */
static void prompt(App *app, const GameState *s) {
    char text[GAME_TEXT_SIZE + 64];
    snprintf(text, sizeof text, "%.40s: %s", key_name(app, ACTION_USE), s->prompt);
    caption(&app->canvas, 0.62 * app->canvas.height, 14.0 * app->canvas.unit, 0xff90d0f8u, *s->prompt ? text : "");
}

/* An eye that opens as guards notice; and how bright it is where you stand. */
static void visibility(Canvas *c, const GameState *s, double foot) {
    double u = c->unit, x = 0.5 * c->width, y = foot - 40.0 * u, wide = 120.0 * u;
    const double whole[4] = {x - 0.5 * wide, y, wide, 5.0 * u};
    const double lit[4] = {x - 0.5 * wide * s->light, y, wide * s->light, 5.0 * u};
    const double ground[4] = {whole[0] - 8.0 * u, y - 6.0 * u, wide + 16.0 * u, 32.0 * u};
    canvas_rectangle(c, ground, 0x88100c08u);
    canvas_rectangle(c, whole, 0xa0000000u);
    canvas_gradient(c, lit, 0xff50a0d8u, 0xff50a0d8u);
    CanvasStyle said = canvas_style(10.0 * u, 0xffc8d0d8u);
    said.align = CANVAS_CENTER;
    canvas_text(c, &said, x, y + 20.0 * u,
                s->light < 0.25  ? "in the dark"
                : s->light < 0.6 ? "half in the light"
                                 : "in the light");
    if (s->noticed <= 0.0) {
        return;
    }
    uint32_t color = s->noticed >= 1.0 ? ALARM : WARM;
    double half = 26.0 * u, top = y - 30.0 * u, open = 11.0 * u * (s->noticed < 1.0 ? s->noticed : 1.0);
    for (int side = -1; side <= 1; side += 2) {
        double px = x - half, py = top;
        for (int i = 1; i <= 12; i++) {
            double t = i / 12.0, nx = x - half + 2.0 * half * t, ny = top + (double)side * open * 4.0 * t * (1.0 - t);
            const double ends[4] = {px, py, nx, ny};
            canvas_line(c, ends, 2.0 * u, color);
            px = nx;
            py = ny;
        }
    }
    const double pupil[4] = {x - 0.5, top, x + 0.5, top};
    canvas_line(c, pupil, 2.0 * open * 0.6 + 2.0, color);
}

static void possessions(Canvas *c, const GameState *s, uint64_t tick, double foot) {
    double u = c->unit, left = 24.0 * u, base = foot - 30.0 * u;
    char text[96];
    const double ground[4] = {0.0, base - (s->carried ? 76.0 : 48.0) * u, 260.0 * u,
                              c->height - base + (s->carried ? 76.0 : 48.0) * u};
    const double corner[4] = {c->width - 130.0 * u, base - 22.0 * u, 130.0 * u, c->height - base + 22.0 * u};
    if (s->wanted) {
        canvas_gradient(c, ground, 0xa0100c08u, 0x00100c08u);
    }
    canvas_gradient(c, corner, 0x00100c08u, 0xa0100c08u);
    CanvasStyle style = canvas_style(13.0 * u, PALE);
    if (s->wanted) {
        snprintf(text, sizeof text, "%u of %u carried out", s->delivered, s->wanted);
        canvas_text(c, &style, left, base, text);
    }
    for (uint32_t i = 0; i < s->wanted && i < 24; i++) {
        const double box[4] = {left + 16.0 * u * i, base - 38.0 * u, 11.0 * u, 11.0 * u};
        bool out = i < s->delivered, hand = !out && i < s->delivered + s->carried;
        canvas_rectangle(c, box, out ? 0xff60c890u : hand ? WARM : 0x60000000u);
        canvas_frame(c, box, 1.0 * u, 0xa0ffffffu);
    }
    if (s->carried) {
        snprintf(text, sizeof text, "In hand: %u, worth %u", s->carried, s->carried_value);
        style.rgba = WARM;
        canvas_text(c, &style, left, base - 56.0 * u, text);
    }
    style.align = CANVAS_RIGHT;
    style.rgba = PALE;
    snprintf(text, sizeof text, "%u:%02u", (unsigned)(tick / ENF_TICK_RATE / 60), (unsigned)(tick / ENF_TICK_RATE % 60));
    canvas_text(c, &style, c->width - 24.0 * u, base, text);
    if (s->crouched || s->flying) {
        canvas_text(c, &style, c->width - 24.0 * u, base - 24.0 * u, s->flying ? "flying" : "crouched");
    }
}

/* ---- the map ---------------------------------------------------------------------------------------------------------- */

static void arrow(Canvas *c, const double at[2], double yaw_deg, double size, uint32_t rgba) {
    double yaw = yaw_deg * (ENF_PI / 180.0), dx = -enf_sin(yaw), dy = -enf_cos(yaw);
    const double corners[6] = {at[0] + dx * size,
                               at[1] + dy * size,
                               at[0] - dx * 0.6 * size - dy * 0.6 * size,
                               at[1] - dy * 0.6 * size + dx * 0.6 * size,
                               at[0] - dx * 0.6 * size + dy * 0.6 * size,
                               at[1] - dy * 0.6 * size - dx * 0.6 * size};
    canvas_triangle(c, corners, rgba);
}

/* "GreatHall-room" → "Great Hall": what an author calls a cell, as a person says it. */
static void room_name(const App *app, uint32_t cell, char out[64]) {
    const char *name = cell == ENF_NONE ? "Outside" : enf_map_string(&app->map, app->map.cells[cell].name);
    const char *end = strstr(name, "-room");
    size_t used = 0;
    for (const char *c = name; *c && c != end && used < 62; c++) {
        bool begins = *c >= 'A' && *c <= 'Z' && c > name && c[-1] >= 'a' && c[-1] <= 'z';
        if (begins) {
            out[used++] = ' ';
        }
        out[used++] = *c == '_' ? ' ' : *c;
    }
    out[used] = '\0';
}

/* Where exhibits lie: those of this storey full, those above or below as frames. */
static void exhibits(Canvas *c, const PlanView *view, const GameState *s) {
    for (uint32_t i = 0; i < s->exhibits; i++) {
        const GameExhibitView *exhibit = &s->exhibit_views[i];
        double above = exhibit->at_ws.y - s->eye_ws.y, at[2], half = 4.0 * c->unit;
        if (exhibit->lies) {
            plan_place(view, exhibit->at_ws.x, exhibit->at_ws.z, at);
            const double mark[4] = {at[0] - half, at[1] - half, 2.0 * half, 2.0 * half};
            if (above > -2.5 && above < 2.0) {
                canvas_rectangle(c, mark, WARM);
            } else {
                canvas_frame(c, mark, c->unit, DIM);
            }
        }
    }
}

static void map_screen(App *app, const GameState *s) {
    Canvas *c = &app->canvas;
    double u = c->unit;
    const double all[4] = {0.0, 0.0, c->width, c->height};
    const double box[4] = {40.0 * u, 76.0 * u, c->width - 80.0 * u, c->height - 150.0 * u};
    static const uint32_t colors[2] = {0x909098a0u, 0xffb8d8f0u};
    canvas_rectangle(c, all, 0xd0100c0au);
    plan_cut(&app->plan, s->eye_ws.y - 1.65);
    PlanView view = plan_fit(&app->plan, box);
    plan_draw(&app->plan, c, &view, NULL, colors);
    double at[2];
    for (uint32_t i = 0; i < app->map.entities_count; i++) {
        const EnfEntity *e = &app->map.entities[i];
        if (strcmp(enf_map_string(&app->map, e->classname), "trigger_exit") == 0) {
            plan_place(&view, e->translation[0], e->translation[2], at);
            const double mark[4] = {at[0] - 5.0 * u, at[1] - 5.0 * u, 10.0 * u, 10.0 * u};
            canvas_frame(c, mark, 2.0 * u, 0xff60c890u);
            CanvasStyle way = canvas_style(10.0 * u, 0xff60c890u);
            const double ground[4] = {at[0] + 7.0 * u, at[1] - 8.0 * u, canvas_text_width(&way, "way out") + 4.0 * u, 14.0 * u};
            canvas_rectangle(c, ground, 0xd0100c0au);
            canvas_text(c, &way, at[0] + 9.0 * u, at[1] + 4.0 * u, "way out");
        }
    }
    exhibits(c, &view, s);
    plan_place(&view, s->eye_ws.x, s->eye_ws.z, at);
    arrow(c, at, s->yaw_deg, 9.0 * u, 0xff4080ffu);
    CanvasStyle style = canvas_style(20.0 * u, PALE);
    char room[64];
    room_name(app, s->cell, room);
    canvas_text(c, &style, 40.0 * u, 52.0 * u, room);
    char text[160];
    snprintf(text, sizeof text,
             "Carry %u of %u exhibits to the way out. Full squares: on this storey. Guards see by light: keep to the dark.",
             s->wanted, s->exhibits);
    style = canvas_style_fitted(12.0 * u, 0xffb0b8c0u, text, c->width - 80.0 * u);
    canvas_text(c, &style, 40.0 * u, c->height - 40.0 * u, text);
}

/* ---- all -------------------------------------------------------------------------------------------------------------- */

/* What a stranger has to know, at the start: what for, and with which keys. */
static void objective(App *app, const GameState *s) {
    Canvas *c = &app->canvas;
    char text[320];
    if (s->tick < 7 * ENF_TICK_RATE && s->wanted) {
        snprintf(text, sizeof text, "Carry %u exhibits out of the palace. Let no guard see you.", s->wanted);
        caption(c, 0.24 * c->height, 17.0 * c->unit, PALE, text);
    }
    if (s->tick < 15 * ENF_TICK_RATE && !app->play.replays) {
        char walk[96];
        snprintf(walk, sizeof walk, "%.20s %.20s %.20s %.20s", key_name(app, ACTION_FORWARD), key_name(app, ACTION_LEFT),
                 key_name(app, ACTION_BACK), key_name(app, ACTION_RIGHT));
        bool pad = app->input.pad_used;
        snprintf(text, sizeof text, "%.90s: walk    %.20s: run    %.20s: crouch    %.20s: take, open    %.20s: map    %s: menu",
                 pad ? key_name(app, ACTION_FORWARD) : walk, key_name(app, ACTION_RUN), key_name(app, ACTION_CROUCH),
                 key_name(app, ACTION_USE), key_name(app, ACTION_MAP), pad ? "Start" : "Esc");
        caption(c, 0.33 * c->height, 12.0 * c->unit, PALE, text);
    }
}

static void over(App *app, const GameState *s) {
    if (s->phase != GAME_PLAYING && !app->over_shown) {
        Canvas *c = &app->canvas;
        double share = app->over_ms / 1800.0;
        const double all[4] = {0.0, 0.0, c->width, c->height};
        canvas_rectangle(c, all, canvas_fade(s->phase == GAME_WON ? 0xff302418u : 0xff080828u, share));
        caption(c, 0.5 * c->height, 30.0 * c->unit, PALE, s->phase == GAME_WON ? "Away into the night" : "Caught");
    }
}

static void replay_lines(App *app) {
    const Play *play = &app->play;
    if (!play->replays) {
        return;
    }
    char text[160];
    if (play->diverged) {
        snprintf(text, sizeof text, "the replay differs from its recording at tick %llu",
                 (unsigned long long)play->divergence.tick);
    } else {
        snprintf(text, sizeof text, play->replay_ended ? "end of the recording, every tick as recorded" : "replay");
    }
    CanvasStyle style = canvas_style(13.0 * app->canvas.unit, play->diverged ? ALARM : CALM);
    canvas_text(&app->canvas, &style, 24.0 * app->canvas.unit, 34.0 * app->canvas.unit, text);
}

void hud_draw(App *app) {
    Canvas *c = &app->canvas;
    if (app->mode == APP_PLAYING) {
        const GameState *s = game_state(app->play.game);
        if (app->map_shown) {
            map_screen(app, s);
        } else if (menu_page(app) == MENU_NONE) {
            double foot = c->height - (app->engineer.counters ? 16.0 * c->unit : 0.0); /* its keys stand below */
            if (s->phase == GAME_PLAYING) {
                crosshair(c, *s->prompt != '\0');
                prompt(app, s);
                caption(c, 0.16 * c->height, 16.0 * c->unit, PALE, s->message);
                visibility(c, s, foot);
                if (!app->engineer.counters && !app->engineer.plan) {
                    objective(app, s);
                }
            }
            possessions(c, s, app->over_tick, foot);
            over(app, s);
        }
        replay_lines(app);
    }
    if (scene_now_ms() < app->notice_until_ms) {
        caption(c, c->height - 90.0 * c->unit, 13.0 * c->unit, PALE, app->notice);
    }
}
