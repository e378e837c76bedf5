/* Makes a Viewer: a map, its visibility, and (where pictures are wanted) a context and a target. */
#include "enfview/viewer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

EnfResult viewer_open(Viewer *viewer, const Options *options, EnfError *error) {
    memset(viewer, 0, sizeof *viewer);
    viewer->options = options;
    viewer->picture_size = (size_t)options->size[0] * options->size[1] * 4;
    EnfResult result;
    if ((result = enf_map_read(&viewer->map, options->map, NULL, error)) != ENF_OK ||
        (result = enf_portals_create(&viewer->portals, &viewer->map, NULL, error)) != ENF_OK ||
        (result = enf_vis_create(&viewer->vis, &viewer->map, NULL, error)) != ENF_OK ||
        (result = enf_vis_create(&viewer->vis_all, &viewer->map, NULL, error)) != ENF_OK ||
        (result = enf_draw_create(&viewer->draw, &viewer->map, NULL, error)) != ENF_OK) {
        return result;
    }
    result = enf_draw_create(&viewer->draw_all, &viewer->map, NULL, error);
    return result == ENF_OK ? life_open(viewer, error) : result;
}

EnfResult viewer_open_pictures(Viewer *viewer, EnfError *error) {
    const Options *options = viewer->options;
    EnfResult result = enf_context_create(&viewer->context, (EnfContextKind)options->context, error);
    if (result != ENF_OK) {
        return result;
    }
    EnfGlLoadFn *load = enf_context_loader(viewer->context);
    void *finish = load("glFinish");
    memcpy(&viewer->finish, &finish, sizeof finish);
    if (!viewer->finish) {
        return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "OpenGL function glFinish is missing");
    }
    if ((result = enf_gl_create(&viewer->gl, &viewer->map, load, error)) != ENF_OK) {
        return enf_error_file(error, result, options->map);
    }
    return enf_gl_target_create(viewer->gl, &viewer->target, options->size[0], options->size[1], error);
}

void viewer_close(Viewer *viewer) {
    enf_gl_target_destroy(viewer->target);
    enf_gl_destroy(viewer->gl);
    enf_context_destroy(viewer->context);
    life_close(viewer);
    enf_draw_destroy(viewer->draw_all);
    enf_draw_destroy(viewer->draw);
    enf_vis_destroy(viewer->vis_all);
    enf_vis_destroy(viewer->vis);
    enf_portals_destroy(&viewer->portals);
    enf_map_free(&viewer->map);
}

EnfCamera viewer_camera(const Viewer *viewer, const Pose *pose) {
    const Options *o = viewer->options;
    EnfCamera camera = enf_camera(pose->eye_ws, enf_turn(pose->yaw_deg, pose->pitch_deg, o->roll_deg), o->fov_y_deg, o->size[0],
                                  o->size[1]);
    return camera;
}

EnfView viewer_view(const Viewer *viewer, const Pose *pose, uint32_t cell) {
    EnfView view = enf_view_default();
    view.camera = viewer_camera(viewer, pose);
    view.cell = cell;
    view.cull = (EnfCull)viewer->options->cull;
    view.window = (EnfWindowMode)viewer->options->window;
    view.grain = (EnfGrain)viewer->options->grain;
    view.dbv = viewer->dbv;
    return view;
}

EnfResult viewer_cell(const Viewer *viewer, EnfVec3 eye_ws, uint32_t *cell, EnfError *error) {
    const char *name = viewer->options->cell_name;
    if (!name) {
        *cell = enf_map_locate(&viewer->map, eye_ws);
        return ENF_OK;
    }
    *cell = enf_map_find_cell(&viewer->map, name);
    if (*cell == ENF_NONE) {
        return enf_error_set(error, ENF_ERROR_RANGE, UINT64_MAX, "no cell is named %.200s", name);
    }
    return ENF_OK;
}

const char *viewer_cell_name(const Viewer *viewer, uint32_t cell) {
    return cell == ENF_NONE ? "(outside)" : enf_map_string(&viewer->map, viewer->map.cells[cell].name);
}

double viewer_now_us(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e6 + (double)now.tv_nsec * 1e-3;
}

static int by_value(const void *a, const void *b) {
    double x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

double viewer_quantile(double *values, uint32_t count, double quantile) {
    if (count == 0) {
        return 0.0;
    }
    qsort(values, count, sizeof *values, by_value);
    uint32_t at = (uint32_t)(quantile * (double)count);
    return values[at < count ? at : count - 1];
}

int viewer_fail(const EnfError *error) {
    fprintf(stderr, "enfview: %s%s%s\n", error->file, *error->file ? ": " : "",
            *error->message ? error->message : enf_result_text(error->code));
    return 1;
}
