/* Makes one view: its picture, its id-buffer, what an engineer wants to see over it, and its statistics. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "common/png_file.h"
#include "common/report.h"
#include "enfview/overlay.h"

#include <stdio.h>

/* Volumes are as a still eye has left them after so many ticks. */
enum { VIS_RUNS = 31, FRAMES = 7, WARM_TICKS = 240 };

/* What is seen from where, and what it took. */
typedef struct Shot {
    Viewer *viewer;
    uint32_t cell;  /* of the culling eye */
    EnfView view;   /* the culling eye's */
    EnfVisSet seen; /* as the culling eye saw it, for the camera that takes the picture */
    EnfCamera observer;
    const EnfVisSet *set;
    const EnfDrawList *list;
    uint8_t *plain, *rgba, *ids; /* the picture before and after overlays */
    uint64_t picture_hash, ids_hash;
    double vis_us, draw_us, frame_ms;
} Shot;

/* ---- seeing ----------------------------------------------------------------------------------------------------- */

/* The world runs to its tick, the eye looks on; the last frame is counted. */
static void let_pass(Shot *shot) {
    Viewer *viewer = shot->viewer;
    int64_t end = (int64_t)viewer->options->tick;
    life_run(viewer, end > WARM_TICKS ? end - WARM_TICKS : 0);
    for (;;) {
        uint64_t evaluated = enf_world_evaluations(viewer->world);
        enf_vis_run(viewer->vis, &viewer->portals, &shot->view);
        if (viewer->dbv) {
            viewer->frame_counters = enf_dbv_frame_counters(viewer->dbv);
            viewer->frame_evaluated = enf_world_evaluations(viewer->world) - evaluated;
        }
        if (enf_world_tick(viewer->world) == end) {
            return;
        }
        life_run(viewer, enf_world_tick(viewer->world) + 1);
    }
}

static EnfResult see(Shot *shot, EnfError *error) {
    Viewer *viewer = shot->viewer;
    const Options *o = viewer->options;
    const Pose *from = o->has_freeze ? &o->freeze : &o->pose;
    EnfResult result = viewer_cell(viewer, from->eye_ws, &shot->cell, error);
    if (result != ENF_OK) {
        return result;
    }
    shot->view = viewer_view(viewer, from, shot->cell);
    shot->observer = viewer_camera(viewer, &o->pose);
    let_pass(shot);
    double samples[VIS_RUNS];
    for (int i = 0; i < VIS_RUNS; i++) {
        double start = viewer_now_us();
        shot->set = enf_vis_run(viewer->vis, &viewer->portals, &shot->view);
        samples[i] = viewer_now_us() - start;
    }
    shot->vis_us = viewer_quantile(samples, VIS_RUNS, 0.5);
    shot->seen = *shot->set;
    shot->seen.cameras = &shot->observer;
    for (int i = 0; i < VIS_RUNS; i++) {
        double start = viewer_now_us();
        shot->list = enf_draw_build(viewer->draw, &shot->seen, ENFVIEW_NEAR, viewer->world, 1.0);
        samples[i] = viewer_now_us() - start;
    }
    shot->draw_us = viewer_quantile(samples, VIS_RUNS, 0.5);
    return ENF_OK;
}

/* ---- drawing ---------------------------------------------------------------------------------------------------- */

static void draw_color(Shot *shot) {
    Viewer *viewer = shot->viewer;
    double samples[FRAMES];
    enf_gl_target_bind(viewer->target, ENF_RENDER_COLOR);
    int frames = viewer->options->stats ? FRAMES : 1;
    for (int i = 0; i < frames; i++) {
        viewer->finish();
        double start = viewer_now_us();
        enf_gl_draw(viewer->gl, shot->list, ENF_RENDER_COLOR);
        viewer->finish();
        samples[i] = (viewer_now_us() - start) * 1e-3;
    }
    shot->frame_ms = viewer_quantile(samples, (uint32_t)frames, 0.5);
    enf_gl_target_read(viewer->target, ENF_RENDER_COLOR, shot->rgba);
    memcpy(shot->plain, shot->rgba, viewer->picture_size);
    shot->picture_hash = enf_hash64(ENF_HASH_START, shot->rgba, viewer->picture_size);
}

static void draw_ids(Shot *shot) {
    Viewer *viewer = shot->viewer;
    enf_gl_target_bind(viewer->target, ENF_RENDER_IDS);
    enf_gl_draw(viewer->gl, shot->list, ENF_RENDER_IDS);
    enf_gl_target_read(viewer->target, ENF_RENDER_IDS, shot->ids);
    shot->ids_hash = enf_hash64(ENF_HASH_START, shot->ids, viewer->picture_size);
}

static EnfResult draw_overlays(Shot *shot, EnfError *error) {
    Viewer *viewer = shot->viewer;
    const Options *o = viewer->options;
    if (!o->has_freeze && !(o->debug & (DEBUG_PORTALS | DEBUG_WINDOWS | DEBUG_KD | DEBUG_DBV))) {
        return ENF_OK;
    }
    Inspect inspect = {.map = &viewer->map,
                       .portals = &viewer->portals,
                       .world = viewer->world,
                       .dbv = viewer->dbv,
                       .gl = viewer->gl,
                       .set = shot->set,
                       .observer = shot->observer,
                       .clip_from_eye = shot->list->clip_from_eye,
                       .what = (o->debug & ~(uint32_t)DEBUG_CELLS) | (o->has_freeze ? INSPECT_PYRAMID : 0U)};
    InspectMemory memory = {.vertices = NULL};
    /* Either mode left its depths in the one depth buffer, so lines hide behind what is in front of them. */
    enf_gl_target_bind(viewer->target, ENF_RENDER_COLOR);
    EnfResult result = o->has_freeze ? inspect_draw_culled(&inspect, &memory, viewer->draw_all, error) : ENF_OK;
    if (result == ENF_OK) {
        result = inspect_draw_lines(&inspect, &memory, error);
    }
    inspect_free(&memory);
    enf_gl_target_read(viewer->target, ENF_RENDER_COLOR, shot->rgba);
    return result;
}

/* PNG begins at the top, OpenGL at the bottom. */
static void flip(uint8_t *rgba, uint32_t width, uint32_t height) {
    size_t row = (size_t)width * 4;
    for (uint32_t y = 0; y < height / 2; y++) {
        uint8_t *a = rgba + y * row, *b = rgba + (height - 1 - y) * row;
        for (size_t i = 0; i < row; i++) {
            uint8_t kept = a[i];
            a[i] = b[i];
            b[i] = kept;
        }
    }
}

static EnfResult save_pictures(Shot *shot, EnfError *error) {
    const Options *o = shot->viewer->options;
    EnfResult result = ENF_OK;
    if (o->output) {
        flip(shot->rgba, o->size[0], o->size[1]);
        result = enf_png_write(o->output, shot->rgba, o->size[0], o->size[1], true, error);
    }
    if (o->ids && result == ENF_OK) {
        if (!o->raw_ids) {
            overlay_color_ids(shot->ids, shot->viewer->picture_size);
        }
        flip(shot->ids, o->size[0], o->size[1]);
        result = enf_png_write(o->ids, shot->ids, o->size[0], o->size[1], !o->raw_ids, error);
    }
    return result;
}

/* ---- statistics ------------------------------------------------------------------------------------------------- */

static void report_hash(EnfReport *report, const char *key, uint64_t hash) {
    char text[17];
    snprintf(text, sizeof text, "%016" PRIx64, hash);
    enf_report_text(report, key, text);
}

static void report_view(EnfReport *report, const Shot *shot) {
    static const char *const culls[] = {"none", "frustum", "sequences", "worklist"};
    const Options *o = shot->viewer->options;
    const EnfVec3 eye = shot->view.camera.eye_ws;
    enf_report_text(report, "map", o->map);
    report_hash(report, "map_hash", shot->viewer->map.hash);
    enf_report_array(report, "eye");
    enf_report_number(report, NULL, eye.x);
    enf_report_number(report, NULL, eye.y);
    enf_report_number(report, NULL, eye.z);
    enf_report_end_array(report);
    enf_report_text(report, "cell", viewer_cell_name(shot->viewer, shot->cell));
    enf_report_text(report, "cull", culls[o->cull]);
    enf_report_text(report, "window", o->window == ENF_WINDOW_BOX ? "box" : "polygon");
    enf_report_text(report, "grain", o->grain == ENF_GRAIN_OBJECTS ? "objects" : "primitives");
    enf_report_text(report, "context", enf_context_name(shot->viewer->context));
    enf_report_count(report, "width", o->size[0]);
    enf_report_count(report, "height", o->size[1]);
}

/* X(counter): numbers and flags of EnfVisCounters. */
#define COUNTERS(X) X(portals_tested) X(portals_passed) X(visits) X(cells) X(requeued) X(kd_nodes) X(boxes) X(clusters)
#define COUNTER_FLAGS(X) X(fell_back) X(outside) X(open)

static void report_counters(EnfReport *report, const Shot *shot) {
    const EnfVisCounters *counters = &shot->set->counters;
    enf_report_object(report, "counters");
#define REPORT_COUNTER(name) enf_report_count(report, #name, counters->name);
    COUNTERS(REPORT_COUNTER)
#undef REPORT_COUNTER
#define REPORT_FLAG(name) enf_report_bool(report, #name, counters->name);
    COUNTER_FLAGS(REPORT_FLAG)
#undef REPORT_FLAG
    enf_report_end_object(report);
    enf_report_object(report, "drawn");
    enf_report_count(report, "cells", shot->list->cell_count);
    enf_report_count(report, "clusters", shot->list->cluster_count);
    enf_report_count(report, "objects", shot->list->mover_count);
    enf_report_count(report, "triangles", shot->list->triangle_count);
    enf_report_count(report, "batches", shot->list->batch_count);
    enf_report_count(report, "ranges", shot->list->range_count);
    enf_report_end_object(report);
    enf_report_count(report, "tick", (uint64_t)enf_world_tick(shot->viewer->world));
    enf_report_count(report, "objects", enf_world_object_limit(shot->viewer->world));
    viewer_report_dbv(shot->viewer, report, "dbv");
}

static EnfResult save_stats(const Shot *shot, EnfError *error) {
    EnfReport report = {.pretty = true};
    enf_report_object(&report, NULL);
    report_view(&report, shot);
    report_counters(&report, shot);
    enf_report_number(&report, "vis_us", shot->vis_us);
    enf_report_number(&report, "draw_list_us", shot->draw_us);
    enf_report_number(&report, "draw_ms", shot->frame_ms);
    report_hash(&report, "vis_hash", enf_vis_hash(shot->set));
    report_hash(&report, "picture_hash", shot->picture_hash);
    report_hash(&report, "ids_hash", shot->ids_hash);
    enf_report_array(&report, "cells");
    for (uint32_t i = 0; i < shot->set->cell_count; i++) {
        enf_report_text(&report, NULL, viewer_cell_name(shot->viewer, shot->set->cells[i]));
    }
    enf_report_end_array(&report);
    enf_report_end_object(&report);
    EnfResult result = enf_report_save(&report, shot->viewer->options->stats, error);
    enf_report_free(&report);
    return result;
}

static void print_summary(const Shot *shot) {
    const EnfVisSet *set = shot->set;
    if (shot->viewer->options->quiet) {
        return;
    }
    fprintf(stderr,
            "eye in %s: %u cells, %u clusters, %u objects, %u triangles in %u batches; visibility %.1f us, drawing %.2f ms "
            "(%s)\n",
            viewer_cell_name(shot->viewer, shot->cell), set->cell_count, shot->list->cluster_count, shot->list->mover_count,
            shot->list->triangle_count, shot->list->batch_count, shot->vis_us, shot->frame_ms,
            enf_context_name(shot->viewer->context));
    if (shot->viewer->options->debug & DEBUG_DBV && shot->viewer->dbv) {
        overlay_print_legend(shot->viewer);
    }
    if (set->counters.outside) {
        fprintf(stderr, "enfview: the eye is in no cell: everything in the picture's pyramid was drawn\n");
    }
    if (set->counters.open) {
        fprintf(stderr, "enfview: a cell in view leaks: everything in its window was drawn\n");
    }
}

/* ---- all -------------------------------------------------------------------------------------------------------- */

static EnfResult take(Shot *shot, EnfError *error) {
    const Options *o = shot->viewer->options;
    EnfResult result = see(shot, error);
    if (result != ENF_OK) {
        return result;
    }
    draw_color(shot);
    if (o->ids || o->stats || (o->debug & DEBUG_CELLS)) {
        draw_ids(shot);
    }
    if ((result = draw_overlays(shot, error)) != ENF_OK) {
        return result;
    }
    if (o->debug & DEBUG_CELLS) {
        overlay_tint_cells(&shot->viewer->map, shot->ids, shot->plain, shot->rgba, shot->viewer->picture_size);
    }
    if (o->stats && (result = save_stats(shot, error)) != ENF_OK) {
        return result;
    }
    return save_pictures(shot, error);
}

int run_picture(Viewer *viewer) {
    EnfError error = {0};
    Shot shot = {.viewer = viewer};
    EnfResult result = viewer_open_pictures(viewer, &error);
    shot.plain = enf_alloc(NULL, viewer->picture_size, 1);
    shot.rgba = enf_alloc(NULL, viewer->picture_size, 1);
    shot.ids = enf_alloc(NULL, viewer->picture_size, 1);
    if (result == ENF_OK && (!shot.plain || !shot.rgba || !shot.ids)) {
        result = enf_error_set(&error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a picture");
    }
    if (result == ENF_OK && (result = take(&shot, &error)) == ENF_OK) {
        print_summary(&shot);
    }
    enf_free(NULL, shot.plain, viewer->picture_size, 1);
    enf_free(NULL, shot.rgba, viewer->picture_size, 1);
    enf_free(NULL, shot.ids, viewer->picture_size, 1);
    return result == ENF_OK ? 0 : viewer_fail(&error);
}
