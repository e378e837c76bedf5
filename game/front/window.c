/* Makes the window and the context of OpenGL 3.3. */
#include <stdio.h>
#include <string.h>

#include "front/app.h"

static EnfResult sdl_error(EnfError *error, const char *what) {
    return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "%s: %s", what, SDL_GetError());
}

void *window_load(const char *name) {
    return SDL_GL_GetProcAddress(name);
}

static void set_attributes(void) {
    static const int wanted[][2] = {{SDL_GL_CONTEXT_MAJOR_VERSION, 3},
                                    {SDL_GL_CONTEXT_MINOR_VERSION, 3},
                                    {SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_CORE},
                                    {SDL_GL_DOUBLEBUFFER, 1},
                                    {SDL_GL_DEPTH_SIZE, 0}, /* depth is the target's */
                                    {SDL_GL_ALPHA_SIZE, 0}};
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        SDL_GL_SetAttribute((SDL_GLattr)wanted[i][0], wanted[i][1]);
    }
}

EnfResult window_open(App *app, EnfError *error) {
    const Settings *s = &app->settings;
    set_attributes();
    uint32_t flags = SDL_WINDOW_OPENGL | SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI;
    flags |= s->fullscreen ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0U;
    app->window = SDL_CreateWindow(APP_NAME, SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, (int)s->width, (int)s->height,
                                   flags);
    if (!app->window) {
        return sdl_error(error, "no window");
    }
    SDL_SetWindowMinimumSize(app->window, 320, 240);
    app->context = SDL_GL_CreateContext(app->window);
    if (!app->context) {
        return sdl_error(error, "no context of OpenGL 3.3 core");
    }
    SDL_GL_SetSwapInterval(s->vsync ? 1 : 0);
    SDL_GL_GetDrawableSize(app->window, &app->width_px, &app->height_px);
    app->focus = true;
    return window_ui(app, error);
}

EnfResult window_ui(App *app, EnfError *error) {
    enf_gl_ui_destroy(app->ui);
    app->ui = NULL;
    return enf_gl_ui_create(&app->ui, window_load, app->atlas, FONT_ATLAS_WIDTH, FONT_ATLAS_HEIGHT, error);
}

void window_close(App *app) {
    if (app->context || app->blind) {
        enf_gl_ui_destroy(app->ui);
    }
    if (app->context) {
        SDL_GL_DeleteContext(app->context);
    }
    if (app->window) {
        SDL_DestroyWindow(app->window);
    }
    app->ui = NULL;
    app->context = NULL;
    app->window = NULL;
}

/* The picture may be made smaller than the window, for slow machines. */
static uint32_t scaled(const App *app, int size_px) {
    double size = (double)size_px * app->settings.render_scale;
    return size < 16.0 ? 16 : (uint32_t)size;
}

void window_measure(App *app) {
    SDL_GL_GetDrawableSize(app->window, &app->width_px, &app->height_px);
    EnfError error = {0};
    if (app->scene.gl && app->width_px > 0 && app->height_px > 0 &&
        scene_resize(&app->scene, scaled(app, app->width_px), scaled(app, app->height_px), &error) != ENF_OK) {
        hud_notice(app, error.message); /* the old target goes on, scaled */
    }
}

void window_apply(App *app) {
    const Settings *s = &app->settings;
    if (!app->window) {
        return;
    }
    SDL_SetWindowFullscreen(app->window, s->fullscreen ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0U);
    if (!s->fullscreen) {
        int width = 0, height = 0;
        SDL_GetWindowSize(app->window, &width, &height);
        if (width != (int)s->width || height != (int)s->height) {
            SDL_SetWindowSize(app->window, (int)s->width, (int)s->height);
            SDL_SetWindowPosition(app->window, SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED); /* not half out of the screen */
        }
    }
    SDL_GL_SetSwapInterval(s->vsync ? 1 : 0);
    window_measure(app);
}

void window_capture(App *app, bool on) {
    bool changes = on != app->captured;
    app->captured = on;
    if (changes && app->window) {
        SDL_SetRelativeMouseMode(on ? SDL_TRUE : SDL_FALSE);
        SDL_GetRelativeMouseState(NULL, NULL);
    }
}
