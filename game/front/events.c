/* Keys, mouse, gamepad, window: who gets them, in menus and in the game. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "front/app.h"

/* Degrees for a pixel of the mouse. */
#define MOUSE_DEGREES 0.09
#define PAD_DEAD 0.18
/* A stick is pushed, as keys are, beyond the first; and let go within the second: of 32,767. */
#define PAD_PUSHED_ON 20000
#define PAD_PUSHED_OFF 12000

static void pause_game(App *app) {
    if (app->mode == APP_PLAYING && menu_page(app) == MENU_NONE) {
        input_release(&app->input);
        menu_open(app, MENU_PAUSE);
        window_capture(app, false);
        if (app->play.recorder) {
            enf_recorder_flush(app->play.recorder, NULL);
        }
    }
}

static void escape(App *app) {
    if (menu_page(app) != MENU_NONE) {
        menu_back(app);
    } else if (app->mode == APP_TOUR) {
        modes_title(app);
    } else if (app->map_shown) {
        app->map_shown = false;
    } else {
        pause_game(app);
    }
}

static void take_shot(App *app) {
    char path[64];
    EnfError error = {0};
    snprintf(path, sizeof path, "enfilade_%03u.png", app->shots++);
    hud_notice(app, frame_shot(app, path, &error) == ENF_OK ? path : error.message);
}

static void menu_key(App *app, SDL_Scancode code) {
    switch (code) {
    case SDL_SCANCODE_UP:
    case SDL_SCANCODE_W:
        menu_move(app, -1);
        break;
    case SDL_SCANCODE_DOWN:
    case SDL_SCANCODE_S:
        menu_move(app, 1);
        break;
    case SDL_SCANCODE_LEFT:
    case SDL_SCANCODE_A:
        menu_change(app, -1);
        break;
    case SDL_SCANCODE_RIGHT:
    case SDL_SCANCODE_D:
        menu_change(app, 1);
        break;
    case SDL_SCANCODE_RETURN:
    case SDL_SCANCODE_KP_ENTER:
    case SDL_SCANCODE_SPACE:
        menu_press(app);
        break;
    case SDL_SCANCODE_BACKSPACE:
        menu_back(app);
        break;
    default:
        break;
    }
}

static void play_key(App *app, SDL_Scancode code, bool down) {
    for (int i = 0; i < ACTION_COUNT; i++) {
        if (app->settings.keys[i] == (int)code) {
            app->input.held[i] = down;
            if (down) {
                input_tap(&app->input, (Action)i);
            }
            if (i == ACTION_MAP && down) {
                app->map_shown = !app->map_shown;
            }
        }
    }
}

static void key(App *app, const SDL_KeyboardEvent *event) {
    SDL_Scancode code = event->keysym.scancode;
    bool down = event->type == SDL_KEYDOWN;
    if (!down) {
        play_key(app, code, false);
        return;
    }
    if (!event->repeat && menu_take_key(app, code)) {
        return;
    }
    if (!event->repeat && code == SDL_SCANCODE_ESCAPE) {
        escape(app);
    } else if (!event->repeat && code == SDL_SCANCODE_F12) {
        take_shot(app);
    } else if (!event->repeat && code == SDL_SCANCODE_F11) {
        app->settings.fullscreen = !app->settings.fullscreen;
        app->fullscreen_once = false;
        window_apply(app);
    } else if (!event->repeat && engineer_key(app, code)) {
        return;
    } else if (menu_page(app) != MENU_NONE) {
        menu_key(app, code);
    } else if (!event->repeat) {
        play_key(app, code, true);
    }
}

static void motion(App *app, const SDL_MouseMotionEvent *event) {
    if (app->captured) {
        double degrees = MOUSE_DEGREES * app->settings.sensitivity;
        app->input.yaw_deg -= (double)event->xrel * degrees;
        app->input.pitch_deg -= (double)event->yrel * degrees * (app->settings.invert ? -1.0 : 1.0);
        return;
    }
    int width = 1, height = 1;
    SDL_GetWindowSize(app->window, &width, &height);
    menu_mouse(app, (double)event->x * app->width_px / (width > 0 ? width : 1),
               (double)event->y * app->height_px / (height > 0 ? height : 1), false);
}

static void button(App *app, const SDL_MouseButtonEvent *event) {
    bool down = event->type == SDL_MOUSEBUTTONDOWN;
    if (app->captured) {
        if (event->button == SDL_BUTTON_LEFT) {
            app->input.mouse_use = down;
            app->input.tapped |= down ? ENF_BUTTON_USE : 0U;
        } else if (event->button == SDL_BUTTON_RIGHT) {
            app->input.mouse_drop = down;
            app->input.tapped |= down ? ENF_BUTTON_DROP : 0U;
        }
    } else if (down && event->button == SDL_BUTTON_LEFT) {
        int width = 1, height = 1;
        SDL_GetWindowSize(app->window, &width, &height);
        menu_mouse(app, (double)event->x * app->width_px / (width > 0 ? width : 1),
                   (double)event->y * app->height_px / (height > 0 ? height : 1), true);
    }
}

/* ---- gamepad ---------------------------------------------------------------------------------------------------------- */

static void pad_added(App *app, int device) {
    if (!app->input.pad && SDL_IsGameController(device)) {
        app->input.pad = SDL_GameControllerOpen(device);
        if (app->input.pad) {
            hud_notice(app, "Gamepad connected");
        }
    }
}

static void pad_removed(App *app, SDL_JoystickID which) {
    SDL_GameController *pad = app->input.pad;
    if (pad && SDL_JoystickInstanceID(SDL_GameControllerGetJoystick(pad)) == which) {
        SDL_GameControllerClose(pad);
        app->input.pad = NULL;
        app->input.pad_used = false;
        input_release(&app->input);
        hud_notice(app, "Gamepad removed");
        pause_game(app);
    }
}

static void pad_menu(App *app, uint8_t pressed);

/* In menus a stick is four keys: pressed when it leaves its middle, let go when it comes back. */
static void pad_stick_menu(App *app, const SDL_ControllerAxisEvent *event) {
    static const uint8_t keys[2][2] = {{SDL_CONTROLLER_BUTTON_DPAD_LEFT, SDL_CONTROLLER_BUTTON_DPAD_RIGHT},
                                       {SDL_CONTROLLER_BUTTON_DPAD_UP, SDL_CONTROLLER_BUTTON_DPAD_DOWN}};
    if (event->axis != SDL_CONTROLLER_AXIS_LEFTX && event->axis != SDL_CONTROLLER_AXIS_LEFTY) {
        return;
    }
    int which = event->axis == SDL_CONTROLLER_AXIS_LEFTY,
        far = abs(event->value) > (app->input.pad_pushed[which] ? PAD_PUSHED_OFF : PAD_PUSHED_ON);
    if (far && !app->input.pad_pushed[which]) {
        pad_menu(app, keys[which][event->value > 0]);
    }
    app->input.pad_pushed[which] = far != 0;
}

static void pad_axis(App *app, const SDL_ControllerAxisEvent *event) {
    if (menu_page(app) != MENU_NONE) {
        pad_stick_menu(app, event);
        return;
    }
    if (event->axis == SDL_CONTROLLER_AXIS_LEFTX || event->axis == SDL_CONTROLLER_AXIS_LEFTY) {
        /* so that a stick that is held when a menu opens chooses nothing before it came back */
        app->input.pad_pushed[event->axis == SDL_CONTROLLER_AXIS_LEFTY] = abs(event->value) > PAD_PUSHED_OFF;
    }
    double value = (double)event->value / 32767.0;
    double size = fabs(value) < PAD_DEAD ? 0.0 : (fabs(value) - PAD_DEAD) / (1.0 - PAD_DEAD);
    value = value < 0.0 ? -size : size;
    Input *input = &app->input;
    switch (event->axis) {
    case SDL_CONTROLLER_AXIS_LEFTX:
        input->pad_right = value;
        break;
    case SDL_CONTROLLER_AXIS_LEFTY:
        input->pad_forward = -value;
        break;
    case SDL_CONTROLLER_AXIS_RIGHTX:
        input->pad_yaw = value * fabs(value);
        break;
    case SDL_CONTROLLER_AXIS_RIGHTY:
        input->pad_pitch = value * fabs(value);
        break;
    case SDL_CONTROLLER_AXIS_TRIGGERRIGHT:
        input->pad_buttons = value > 0.4 ? input->pad_buttons | ENF_BUTTON_RUN : input->pad_buttons & ~(uint32_t)ENF_BUTTON_RUN;
        break;
    default:
        break;
    }
}

static void pad_menu(App *app, uint8_t pressed) {
    switch (pressed) {
    case SDL_CONTROLLER_BUTTON_DPAD_UP:
        menu_move(app, -1);
        break;
    case SDL_CONTROLLER_BUTTON_DPAD_DOWN:
        menu_move(app, 1);
        break;
    case SDL_CONTROLLER_BUTTON_DPAD_LEFT:
        menu_change(app, -1);
        break;
    case SDL_CONTROLLER_BUTTON_DPAD_RIGHT:
        menu_change(app, 1);
        break;
    case SDL_CONTROLLER_BUTTON_A:
        menu_press(app);
        break;
    case SDL_CONTROLLER_BUTTON_B:
        menu_back(app);
        break;
    default:
        break;
    }
}

static void pad_button(App *app, const SDL_ControllerButtonEvent *event) {
    static const struct {
        uint8_t button;
        uint32_t does;
    } table[] = {{SDL_CONTROLLER_BUTTON_A, ENF_BUTTON_JUMP},
                 {SDL_CONTROLLER_BUTTON_B, ENF_BUTTON_CROUCH},
                 {SDL_CONTROLLER_BUTTON_X, ENF_BUTTON_USE},
                 {SDL_CONTROLLER_BUTTON_Y, ENF_BUTTON_DROP},
                 {SDL_CONTROLLER_BUTTON_LEFTSTICK, ENF_BUTTON_RUN}};
    bool down = event->type == SDL_CONTROLLERBUTTONDOWN;
    if (down && event->button == SDL_CONTROLLER_BUTTON_START) {
        escape(app);
    } else if (down && menu_page(app) != MENU_NONE) {
        pad_menu(app, event->button);
    } else if (down && event->button == SDL_CONTROLLER_BUTTON_BACK) {
        app->map_shown = !app->map_shown;
    } else {
        for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
            if (table[i].button == event->button) {
                app->input.tapped |= down ? table[i].does : 0U;
                app->input.pad_buttons = down ? app->input.pad_buttons | table[i].does
                                              : app->input.pad_buttons & ~table[i].does;
            }
        }
    }
}

/* ---- all -------------------------------------------------------------------------------------------------------------- */

static void window_event(App *app, const SDL_WindowEvent *event) {
    switch (event->event) {
    case SDL_WINDOWEVENT_SIZE_CHANGED:
        if (!app->settings.fullscreen) {
            app->settings.width = event->data1 < 320 ? 320.0 : (double)event->data1;
            app->settings.height = event->data2 < 240 ? 240.0 : (double)event->data2;
        }
        window_measure(app);
        break;
    case SDL_WINDOWEVENT_FOCUS_LOST:
        app->focus = false;
        input_release(&app->input);
        pause_game(app);
        window_capture(app, false);
        break;
    case SDL_WINDOWEVENT_FOCUS_GAINED:
        app->focus = true;
        window_capture(app, app->mode != APP_TITLE && menu_page(app) == MENU_NONE);
        break;
    case SDL_WINDOWEVENT_MINIMIZED:
        pause_game(app);
        break;
    default:
        break;
    }
}

/* A sound card that goes away is not the end: the usual one of those left goes on, or none. */
static void audio_event(App *app, const SDL_AudioDeviceEvent *event) {
    if (!event->iscapture && !app->options.mute && event->type == SDL_AUDIODEVICEREMOVED && event->which == app->audio.device) {
        audio_close(&app->audio);
    }
    if (!event->iscapture && !app->options.mute && !app->audio.device && audio_open(&app->audio)) {
        audio_volume(&app->audio, app->settings.volume, app->settings.music);
        audio_loop(&app->audio, AUDIO_SLOT_AMBIENT, app->mode == APP_PLAYING ? (int)AUDIO_NIGHT : -1);
        audio_loop(&app->audio, AUDIO_SLOT_MUSIC, app->mode == APP_PLAYING ? -1 : (int)AUDIO_TITLE);
    }
}

static void handle(App *app, const SDL_Event *event) {
    switch (event->type) {
    case SDL_QUIT:
        app->quit = true;
        break;
    case SDL_KEYDOWN:
    case SDL_KEYUP:
        app->input.pad_used = false;
        key(app, &event->key);
        break;
    case SDL_MOUSEMOTION:
        app->input.pad_used = false;
        motion(app, &event->motion);
        break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
        button(app, &event->button);
        break;
    case SDL_WINDOWEVENT:
        window_event(app, &event->window);
        break;
    case SDL_CONTROLLERDEVICEADDED:
        pad_added(app, event->cdevice.which);
        break;
    case SDL_CONTROLLERDEVICEREMOVED:
        pad_removed(app, event->cdevice.which);
        break;
    case SDL_CONTROLLERAXISMOTION:
        app->input.pad_used = app->input.pad_used || abs(event->caxis.value) > 16000;
        pad_axis(app, &event->caxis);
        break;
    case SDL_CONTROLLERBUTTONDOWN:
    case SDL_CONTROLLERBUTTONUP:
        app->input.pad_used = true;
        pad_button(app, &event->cbutton);
        break;
    case SDL_AUDIODEVICEADDED:
    case SDL_AUDIODEVICEREMOVED:
        audio_event(app, &event->adevice);
        break;
    default:
        break;
    }
}

void events_handle(App *app) {
    SDL_Event event;
    while (SDL_PollEvent(&event)) {
        handle(app, &event);
    }
}
