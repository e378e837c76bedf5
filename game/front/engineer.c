/* The engineer's overlay: what the engine does, while it does it. */
#include <stdio.h>
#include <string.h>

#include "front/app.h"

#define TEXT 0xffd0e8d0u
#define HEAD 0xff80d8ffu
#define GROUND 0xa8100c08u

EnfResult engineer_create(App *app, EnfError *error) {
    Engineer *e = &app->engineer;
    e->lit = enf_alloc(NULL, (size_t)app->map.cells_count + 1, 1);
    return e->lit ? ENF_OK : enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for the overlay");
}

void engineer_destroy(App *app) {
    inspect_free(&app->engineer.memory);
    enf_free(NULL, app->engineer.lit, (size_t)app->map.cells_count + 1, 1);
    app->engineer.lit = NULL;
}

/* ---- keys ------------------------------------------------------------------------------------------------------------- */

static void freeze(App *app) {
    Scene *scene = &app->scene;
    scene->frozen = !scene->frozen;
    if (scene->frozen) {
        scene->frozen_view = scene->view;
        scene->frozen_view.camera = scene->camera;
        scene->frozen_view.cell = scene->cell;
    }
    hud_notice(app, scene->frozen ? "The culling camera stands still" : "The culling camera goes along");
}

bool engineer_key(App *app, SDL_Scancode code) {
    Engineer *e = &app->engineer;
    char text[64];
    app->warm = 0;
    switch (code) {
    case SDL_SCANCODE_F1:
        e->counters = !e->counters;
        return true;
    case SDL_SCANCODE_F2:
        e->plan = !e->plan;
        e->lines ^= INSPECT_PORTALS | INSPECT_WINDOWS;
        return true;
    case SDL_SCANCODE_F3:
        freeze(app);
        return true;
    case SDL_SCANCODE_F4:
        e->lines ^= INSPECT_DBV;
        return true;
    case SDL_SCANCODE_F5:
        e->lines ^= INSPECT_KD;
        return true;
    case SDL_SCANCODE_F6:
        e->wireframe = !e->wireframe;
        return true;
    case SDL_SCANCODE_F7:
        app->scene.cull = (EnfCull)(((int)app->scene.cull + 1) % SCENE_CULLS);
        snprintf(text, sizeof text, "Culling: %s", scene_cull_name(app->scene.cull));
        hud_notice(app, text);
        return true;
    case SDL_SCANCODE_F8:
        e->measures = !e->measures;
        memset(e->cull_ms, 0, sizeof e->cull_ms);
        return true;
    case SDL_SCANCODE_F9:
        app->input.noclip = !app->input.noclip;
        hud_notice(app, app->input.noclip ? "Through walls" : "Walls are walls");
        return true;
    case SDL_SCANCODE_F10:
        app->input.fly = !app->input.fly;
        hud_notice(app, app->input.fly ? "Flying" : "Walking");
        return true;
    default:
        return false;
    }
}

/* ---- measuring -------------------------------------------------------------------------------------------------------- */

/* One mode a frame in turn, finished before and after, beside the frame that is shown: so its time is its own. */
void engineer_measure(App *app, double alpha) {
    Engineer *e = &app->engineer;
    if (!e->measures || !app->scene.list) {
        return;
    }
    Scene *scene = &app->scene;
    uint32_t turn = e->cull_turn++ % SCENE_CULLS;
    double ms = scene_measure(scene, (EnfCull)turn, alpha);
    e->cull_ms[turn] = e->cull_ms[turn] > 0.0 ? e->cull_ms[turn] + 0.15 * (ms - e->cull_ms[turn]) : ms;
    scene->view.cull = scene->cull;
}

/* ---- over the picture --------------------------------------------------------------------------------------------------- */

void engineer_lines(App *app) {
    Engineer *e = &app->engineer;
    Scene *scene = &app->scene;
    uint32_t what = e->lines | (scene->frozen ? INSPECT_PYRAMID : 0U);
    if (!scene->list) {
        return;
    }
    if (e->wireframe) {
        enf_gl_draw_wireframe(scene->gl, scene->list, 0x60ffffffu);
    }
    if (!what) {
        return;
    }
    float clip_from_eye[16];
    memcpy(clip_from_eye, scene->list->clip_from_eye, sizeof clip_from_eye);
    Inspect inspect = {.map = scene->map,
                       .portals = scene->portals,
                       .world = scene->world,
                       .dbv = scene->dbv,
                       .gl = scene->gl,
                       .set = scene->set,
                       .observer = scene->camera,
                       .clip_from_eye = clip_from_eye,
                       .what = what};
    EnfError error = {0};
    EnfResult result = scene->frozen ? inspect_draw_culled(&inspect, &e->memory, scene->draw, &error) : ENF_OK;
    result = result ? result : inspect_draw_lines(&inspect, &e->memory, &error);
    if (result != ENF_OK) {
        hud_notice(app, error.message);
    }
}

/* ---- counters ------------------------------------------------------------------------------------------------------------ */

typedef struct Column {
    Canvas *canvas;
    CanvasStyle style;
    double x, y, line;
} Column;

static void put(Column *column, uint32_t rgba, const char *text) {
    column->style.rgba = rgba;
    canvas_text(column->canvas, &column->style, column->x, column->y, text);
    column->y += column->line;
}

static void counters(App *app, Column *column) {
    const Scene *s = &app->scene;
    const EnfVisCounters *v = &s->set->counters;
    char t[160];
    snprintf(t, sizeof t, "cull %s, cell %.40s", scene_cull_name(s->view.cull), scene_cell_name(s));
    put(column, HEAD, t);
    snprintf(t, sizeof t, "vis %.3f ms   list %.3f ms   gl %.2f ms", s->vis_ms, s->list_ms, s->gl_ms);
    put(column, TEXT, t);
    snprintf(t, sizeof t, "portals %u tested, %u passed; visits %u, cells %u of %u%s", v->portals_tested, v->portals_passed,
             v->visits, v->cells, s->map->cells_count,
             v->fell_back ? " (fell back)"
             : v->outside ? " (outside)"
                          : "");
    put(column, TEXT, t);
    snprintf(t, sizeof t, "kd nodes %u, boxes %u; clusters %u of %u", v->kd_nodes, v->boxes, v->clusters,
             s->map->clusters_count);
    put(column, TEXT, t);
    snprintf(t, sizeof t, "drawn: %u triangles, %u batches, %u ranges, %u movers", s->list->triangle_count,
             s->list->batch_count, s->list->range_count, s->list->mover_count);
    put(column, TEXT, t);
    if (s->dbv) {
        EnfDbvCounters d = enf_dbv_frame_counters(s->dbv);
        snprintf(t, sizeof t, "volumes: %llu exposed, %llu drawn, %llu expired, %llu left alone, %llu late",
                 (unsigned long long)d.exposed, (unsigned long long)d.drawn, (unsigned long long)d.expired,
                 (unsigned long long)d.avoided, (unsigned long long)d.late);
        put(column, TEXT, t);
    }
    const EnfVec3 eye = s->eye_ws;
    snprintf(t, sizeof t, "eye %.2f %.2f %.2f", eye.x, eye.y, eye.z);
    put(column, TEXT, t);
}

/* Frame times, newest at the right; the lines are 60 and 30 frames a second. */
static void graph(App *app, double x, double y) {
    Canvas *c = &app->canvas;
    const Engineer *e = &app->engineer;
    double u = c->unit, w = 300.0 * u, h = 60.0 * u, per_ms = h / 50.0;
    const double box[4] = {x, y, w, h};
    canvas_rectangle(c, box, GROUND);
    for (uint32_t i = 0; i < GRAPH_FRAMES; i++) {
        double ms = e->frame_ms[(e->frame + i) % GRAPH_FRAMES], tall = ms * per_ms > h ? h : ms * per_ms;
        const double bar[4] = {x + w * i / GRAPH_FRAMES, y + h - tall, w / GRAPH_FRAMES, tall};
        canvas_rectangle(c, bar, ms < 17.5 ? 0xc060c060u : ms < 34.0 ? 0xc040b0e0u : 0xc04050f0u);
    }
    for (int i = 1; i <= 2; i++) {
        const double line[4] = {x, y + h - i * per_ms * 1000.0 / 60.0, w, 1.0};
        canvas_rectangle(c, line, 0x60ffffffu);
    }
    char t[64];
    double last = e->frame_ms[(e->frame + GRAPH_FRAMES - 1) % GRAPH_FRAMES];
    snprintf(t, sizeof t, "%.1f ms", last);
    CanvasStyle style = canvas_style(10.0 * u, TEXT);
    canvas_text(c, &style, x + 6.0 * u, y + 16.0 * u, t);
}

static void modes(App *app, Column *column) {
    const Engineer *e = &app->engineer;
    char t[96];
    put(column, HEAD, "time of a whole frame, drawn and finished");
    for (int i = 0; i < SCENE_CULLS; i++) {
        snprintf(t, sizeof t, "%-10s %7.2f ms  %5.0f/s", scene_cull_name((EnfCull)i), e->cull_ms[i],
                 e->cull_ms[i] > 0.0 ? 1000.0 / e->cull_ms[i] : 0.0);
        put(column, app->scene.cull == (EnfCull)i ? 0xffffffffu : TEXT, t);
    }
}

/* ---- the plan: visible cells lit, and the fans of their windows ------------------------------------------------------ */

static void fan(App *app, const PlanView *view, const EnfVisit *visit) {
    const EnfCamera *camera = &app->scene.set->cameras[0];
    double from[2], width = 16.0 * (double)camera->width_px;
    plan_place(view, camera->eye_ws.x, camera->eye_ws.z, from);
    const int32_t sides[2] = {visit->window.x0, visit->window.x1};
    for (int i = 0; i < 2; i++) {
        double across = (2.0 * (double)sides[i] / width - 1.0) * camera->tan_x;
        EnfVec3 ray = enf_add(camera->forward, enf_scale(camera->right, across));
        double length = enf_length(enf_v3(ray.x, 0.0, ray.z)), to[2];
        if (length < 1e-6) {
            continue;
        }
        plan_place(view, camera->eye_ws.x + 14.0 * ray.x / length, camera->eye_ws.z + 14.0 * ray.z / length, to);
        const double ends[4] = {from[0], from[1], to[0], to[1]};
        canvas_line(&app->canvas, ends, 1.0, canvas_fade(0xff000000u | inspect_color(visit->cell), 0.6));
    }
}

static void draw_plan(App *app) {
    Canvas *c = &app->canvas;
    Engineer *e = &app->engineer;
    const EnfVisSet *set = app->scene.set;
    double u = c->unit, w = 380.0 * u, h = 300.0 * u;
    const double box[4] = {c->width - w - 16.0 * u, 16.0 * u, w, h};
    static const uint32_t colors[2] = {0x70909090u, 0xff80f0b0u};
    canvas_rectangle(c, box, GROUND);
    memset(e->lit, 0, (size_t)app->map.cells_count);
    for (uint32_t i = 0; i < set->cell_count; i++) {
        e->lit[set->cells[i]] = 1;
    }
    plan_cut(&app->plan, app->scene.eye_ws.y - 1.65);
    PlanView view = plan_fit(&app->plan, box);
    plan_draw(&app->plan, c, &view, e->lit, colors);
    for (uint32_t i = 0; i < set->visit_count; i++) {
        if (set->visits[i].space == 0) {
            fan(app, &view, &set->visits[i]);
        }
    }
    double at[2];
    plan_place(&view, app->scene.eye_ws.x, app->scene.eye_ws.z, at);
    const double dot[4] = {at[0] - 0.5, at[1], at[0] + 0.5, at[1]};
    canvas_line(c, dot, 6.0 * u, 0xff4080ffu);
}

static void help(App *app) {
    Canvas *c = &app->canvas;
    static const char text[] =
        "F1 counters  F2 plan, windows  F3 freeze  F4 volumes  F5 kd-trees  F6 wireframe  F7 culling  F8 compare"
        "  F9 noclip  F10 fly  F11 screen  F12 picture";
    const double ground[4] = {0.0, c->height - 22.0 * c->unit, c->width, 22.0 * c->unit};
    CanvasStyle style = canvas_style_fitted(9.5 * c->unit, 0xffc0c8d0u, text, c->width - 32.0 * c->unit);
    canvas_rectangle(c, ground, GROUND);
    canvas_text(c, &style, 16.0 * c->unit, c->height - 7.0 * c->unit, text);
}

void engineer_draw(App *app) {
    const Engineer *e = &app->engineer;
    Canvas *c = &app->canvas;
    if (!app->scene.list) {
        return;
    }
    double u = c->unit;
    Column column = {c, canvas_style(10.5 * u, TEXT), 26.0 * u, 34.0 * u, 19.0 * u};
    if (e->counters || e->measures) {
        double lines = (e->counters ? 7.0 : 0.0) + (e->measures ? 5.0 : 0.0);
        double beside = c->width - 428.0 * u, wide = e->plan && beside < 560.0 * u ? beside : 560.0 * u;
        const double ground[4] = {16.0 * u, 16.0 * u, wide, lines * column.line + 14.0 * u};
        canvas_rectangle(c, ground, GROUND);
    }
    if (e->counters) {
        counters(app, &column);
    }
    if (e->measures) {
        modes(app, &column);
    }
    if (e->counters) {
        graph(app, 16.0 * u, column.y + 6.0 * u);
        help(app);
    }
    if (e->plan) {
        draw_plan(app);
    }
}
