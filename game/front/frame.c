/* Makes a frame: what is seen, and over it what a person is told; in the window, or in the target where there is none. */
#include <string.h>

#include "common/png_file.h"
#include "front/app.h"

void frame_draw(App *app) {
    EnfVec3 eye_ws;
    EnfTurn turn;
    double alpha = modes_eye(app, &eye_ws, &turn);
    uint32_t width = (uint32_t)app->width_px, height = (uint32_t)app->height_px;
    scene_look(&app->scene, eye_ws, turn, app->settings.fov);
    engineer_measure(app, alpha);
    scene_see(&app->scene, alpha);
    scene_paint(&app->scene);
    engineer_lines(app);
    if (app->blind) {
        enf_gl_target_bind(app->scene.target, ENF_RENDER_COLOR);
    } else {
        enf_gl_target_show(app->scene.target, width, height);
    }
    canvas_begin(&app->canvas, width, height);
    hud_draw(app);
    engineer_draw(app);
    menu_draw(app);
    enf_gl_ui_draw(app->ui, app->canvas.vertices, app->canvas.count, width, height);
}

EnfResult frame_shot(App *app, const char *path, EnfError *error) {
    uint32_t width = (uint32_t)app->width_px, height = (uint32_t)app->height_px;
    size_t row = (size_t)width * 4;
    uint8_t *rgba = enf_alloc(NULL, 2 * (size_t)height, row);
    if (!rgba) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a picture");
    }
    if (app->blind) {
        enf_gl_target_read(app->scene.target, ENF_RENDER_COLOR, rgba);
    } else {
        enf_gl_ui_read(app->ui, width, height, rgba);
    }
    uint8_t *flipped = rgba + row * height;
    for (uint32_t y = 0; y < height; y++) {
        memcpy(flipped + y * row, rgba + (height - 1 - y) * row, row);
    }
    EnfResult result = enf_png_write(path, flipped, width, height, true, error);
    enf_free(NULL, rgba, 2 * (size_t)height, row);
    return result;
}
