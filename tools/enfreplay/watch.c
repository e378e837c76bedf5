/* Visibility and pictures of a game that is being replayed. The context is made at the first picture, so that whoever only
 * wants volumes needs no OpenGL. */
#include "enfreplay/watch.h"

#include <enfilade/gl.h>

#include <string.h>

struct Watch {
    Session *session;
    const Options *options;
    EnfVis *vis;
    EnfDbvIndex *dbv;
    EnfDraw *draw;
    EnfContext *context;
    EnfGl *gl;
    EnfGlTarget *target;
    uint8_t *rgba;
    size_t row, size; /* bytes of a row and of a picture */
    WatchCounts counts;
};

EnfResult watch_create(Watch **watch, Session *session, const Options *options, EnfError *error) {
    *watch = NULL;
    Watch *made = enf_alloc(NULL, 1, sizeof *made);
    if (!made) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory to watch a game");
    }
    made->session = session;
    made->options = options;
    made->row = (size_t)options->size[0] * 4;
    made->size = made->row * options->size[1];
    EnfResult result = enf_vis_create(&made->vis, &session->map, NULL, error);
    if (result == ENF_OK && options->dbv != DBV_OFF) {
        EnfDbvDef def = enf_dbv_def_default();
        def.policy = (EnfDbvPolicy)(options->dbv - 1);
        result = enf_dbv_create(&made->dbv, sim_world(session->sim), &def, NULL, error);
    }
    if (result != ENF_OK) {
        watch_destroy(made);
        return result;
    }
    *watch = made;
    return ENF_OK;
}

void watch_destroy(Watch *watch) {
    if (watch) {
        enf_gl_target_destroy(watch->target);
        enf_gl_destroy(watch->gl);
        enf_context_destroy(watch->context);
        enf_draw_destroy(watch->draw);
        enf_dbv_destroy(watch->dbv);
        enf_vis_destroy(watch->vis);
        enf_free(NULL, watch->rgba, watch->size, 1);
        enf_free(NULL, watch, 1, sizeof *watch);
    }
}

static EnfResult open_pictures(Watch *watch, EnfError *error) {
    const Options *o = watch->options;
    EnfResult result;
    watch->rgba = enf_alloc(NULL, watch->size, 1);
    if (!watch->rgba) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a picture");
    }
    if ((result = enf_draw_create(&watch->draw, &watch->session->map, NULL, error)) != ENF_OK ||
        (result = enf_context_create(&watch->context, (EnfContextKind)o->context, error)) != ENF_OK ||
        (result = enf_gl_create(&watch->gl, &watch->session->map, enf_context_loader(watch->context), error)) != ENF_OK) {
        return result;
    }
    return enf_gl_target_create(watch->gl, &watch->target, o->size[0], o->size[1], error);
}

static EnfView view_of(const Watch *watch) {
    const Options *o = watch->options;
    SimEye eye = sim_eye(watch->session->sim);
    EnfView view = enf_view_default();
    view.camera = enf_camera(eye.eye_ws, enf_turn(eye.yaw_deg, eye.pitch_deg, 0.0), o->fov_y_deg, o->size[0], o->size[1]);
    view.cell = eye.cell;
    view.cull = (EnfCull)o->cull;
    view.dbv = watch->dbv;
    return view;
}

/* OpenGL's rows go from bottom to top. */
static void flip(Watch *watch) {
    uint8_t *low = watch->rgba, *high = watch->rgba + watch->size - watch->row;
    for (; low < high; low += watch->row, high -= watch->row) {
        for (size_t i = 0; i < watch->row; i++) {
            uint8_t byte = low[i];
            low[i] = high[i];
            high[i] = byte;
        }
    }
}

static void count(Watch *watch, const EnfVisSet *set) {
    watch->counts.views++;
    watch->counts.cells += set->cell_count;
    watch->counts.clusters += set->entry_count;
    watch->counts.objects += set->object_count;
}

EnfResult watch_tick(Watch *watch, bool draw, const uint8_t **picture, EnfError *error) {
    *picture = NULL;
    if (!draw && !watch->dbv) {
        return ENF_OK;
    }
    EnfResult result = draw && !watch->target ? open_pictures(watch, error) : ENF_OK;
    if (result != ENF_OK) {
        return result;
    }
    EnfView view = view_of(watch);
    const EnfVisSet *set = enf_vis_run(watch->vis, sim_portals(watch->session->sim), &view);
    count(watch, set);
    if (draw) {
        enf_gl_target_bind(watch->target, ENF_RENDER_COLOR);
        enf_gl_draw(watch->gl, enf_draw_build(watch->draw, set, ENF_DRAW_NEAR, sim_world(watch->session->sim), 1.0),
                    ENF_RENDER_COLOR);
        enf_gl_target_read(watch->target, ENF_RENDER_COLOR, watch->rgba);
        flip(watch);
        watch->counts.pictures++;
        *picture = watch->rgba;
    }
    return ENF_OK;
}

WatchCounts watch_counts(const Watch *watch) {
    WatchCounts counts = watch->counts;
    if (watch->dbv) {
        EnfDbvCounters dbv = enf_dbv_total_counters(watch->dbv);
        counts.exposed = dbv.exposed;
        counts.expired = dbv.expired;
        counts.late = dbv.late;
        counts.avoided = dbv.avoided;
    }
    return counts;
}
