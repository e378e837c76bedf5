/* Makes pictures of a world. */
#include "front/scene.h"

#include <string.h>
#include <time.h>

/* A drawn eye goes less than this in a frame unless it was put elsewhere, metres. */
#define LEAP 1.5

double scene_now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

const char *scene_cull_name(EnfCull cull) {
    static const char *const names[SCENE_CULLS] = {"none", "frustum", "sequences", "worklist"};
    return names[cull];
}

const char *scene_cell_name(const Scene *scene) {
    return scene->cell == ENF_NONE ? "(outside)" : enf_map_string(scene->map, scene->map->cells[scene->cell].name);
}

EnfResult scene_create(Scene *scene, const EnfMap *map, EnfGl *gl, EnfGlLoadFn *load, EnfError *error) {
    memset(scene, 0, sizeof *scene);
    scene->map = map;
    scene->gl = gl;
    scene->cull = ENF_CULL_WORKLIST;
    scene->cell = ENF_NONE;
    void *finish = load("glFinish");
    memcpy(&scene->finish, &finish, sizeof finish);
    if (!scene->finish) {
        return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "OpenGL function glFinish is missing");
    }
    EnfResult result = enf_vis_create(&scene->vis, map, NULL, error);
    return result ? result : enf_draw_create(&scene->draw, map, NULL, error);
}

void scene_destroy(Scene *scene) {
    enf_gl_target_destroy(scene->target);
    enf_dbv_destroy(scene->dbv);
    enf_draw_destroy(scene->draw);
    enf_vis_destroy(scene->vis);
    memset(scene, 0, sizeof *scene);
}

EnfResult scene_attach(Scene *scene, EnfWorld *world, const EnfPortals *portals, EnfError *error) {
    enf_dbv_destroy(scene->dbv);
    scene->dbv = NULL;
    scene->world = world;
    scene->portals = portals;
    scene->has_eye = false;
    scene->frozen = false;
    scene->set = NULL;
    scene->list = NULL;
    if (!world) {
        return ENF_OK;
    }
    enf_world_set_trail(world, true);
    EnfDbvDef def = enf_dbv_def_default();
    return enf_dbv_create(&scene->dbv, world, &def, NULL, error);
}

EnfResult scene_resize(Scene *scene, uint32_t width_px, uint32_t height_px, EnfError *error) {
    if (scene->target && width_px == scene->width_px && height_px == scene->height_px) {
        return ENF_OK;
    }
    EnfGlTarget *made = NULL;
    EnfResult result = enf_gl_target_create(scene->gl, &made, width_px, height_px, error);
    if (result != ENF_OK) {
        return result;
    }
    enf_gl_target_destroy(scene->target);
    scene->target = made;
    scene->width_px = width_px;
    scene->height_px = height_px;
    return ENF_OK;
}

void scene_tick(Scene *scene) {
    if (scene->dbv && enf_dbv_begin(scene->dbv, NULL) != ENF_OK) {
        /* Memory is out: everything that moves is drawn, hidden or not. */
        enf_dbv_destroy(scene->dbv);
        scene->dbv = NULL;
    }
}

void scene_look(Scene *scene, EnfVec3 eye_ws, EnfTurn turn, double fov_y_deg) {
    bool near = scene->has_eye && scene->cell != ENF_NONE && enf_length(enf_sub(eye_ws, scene->eye_ws)) < LEAP;
    uint32_t cell = near ? enf_map_track(scene->map, scene->cell, scene->eye_ws, eye_ws) : ENF_NONE;
    if (cell == ENF_NONE || !enf_map_cell_contains(scene->map, cell, eye_ws)) {
        uint32_t found = enf_map_locate(scene->map, eye_ws);
        cell = found != ENF_NONE ? found : cell;
    }
    scene->cell = cell;
    scene->eye_ws = eye_ws;
    scene->has_eye = true;
    scene->camera = enf_camera(eye_ws, turn, fov_y_deg, scene->width_px, scene->height_px);
    scene->view = enf_view_default();
    scene->view.camera = scene->camera;
    scene->view.cell = cell;
    scene->view.cull = scene->cull;
    if (scene->frozen) {
        scene->view.camera = scene->frozen_view.camera;
        scene->view.cell = scene->frozen_view.cell;
    }
    scene->view.dbv = scene->dbv;
}

void scene_see(Scene *scene, double alpha) {
    double start = scene_now_ms();
    scene->set = enf_vis_run(scene->vis, scene->portals, &scene->view);
    double between = scene_now_ms();
    scene->seen = *scene->set;
    scene->seen.cameras = &scene->camera;
    scene->list = enf_draw_build(scene->draw, &scene->seen, ENF_DRAW_NEAR, scene->world, alpha);
    scene->vis_ms = between - start;
    scene->list_ms = scene_now_ms() - between;
}

void scene_paint(Scene *scene) {
    double start = scene_now_ms();
    enf_gl_target_bind(scene->target, ENF_RENDER_COLOR);
    enf_gl_draw(scene->gl, scene->list, ENF_RENDER_COLOR);
    scene->gl_ms = scene_now_ms() - start;
}

double scene_measure(Scene *scene, EnfCull cull, double alpha) {
    scene->finish();
    double start = scene_now_ms();
    scene->view.cull = cull;
    scene_see(scene, alpha);
    scene_paint(scene);
    scene->finish();
    return scene_now_ms() - start;
}
