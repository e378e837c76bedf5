/* Makes the input of a tick from what is held and turned. */
#include <string.h>

#include "front/app.h"

/* Degrees a second of a stick held to its end. */
#define PAD_YAW 170.0
#define PAD_PITCH 110.0

void input_release(Input *input) {
    memset(input->held, 0, sizeof input->held);
    input->mouse_use = input->mouse_drop = false;
    input->tapped = 0;
    input->yaw_deg = input->pitch_deg = 0.0;
    input->pad_forward = input->pad_right = input->pad_yaw = input->pad_pitch = 0.0;
    input->pad_buttons = 0;
}

static int16_t axis(double value) {
    value = value < -1.0 ? -1.0 : value > 1.0 ? 1.0 : value;
    return (int16_t)(value * 32767.0);
}

static const struct {
    Action action;
    uint32_t button;
} action_buttons[] = {{ACTION_JUMP, ENF_BUTTON_JUMP},
                      {ACTION_CROUCH, ENF_BUTTON_CROUCH},
                      {ACTION_RUN, ENF_BUTTON_RUN},
                      {ACTION_USE, ENF_BUTTON_USE},
                      {ACTION_DROP, ENF_BUTTON_DROP}};
enum { ACTION_BUTTONS = sizeof action_buttons / sizeof *action_buttons };

void input_tap(Input *input, Action action) {
    for (size_t i = 0; i < ACTION_BUTTONS; i++) {
        input->tapped |= action_buttons[i].action == action ? action_buttons[i].button : 0U;
    }
}

static uint32_t buttons(const Input *input) {
    uint32_t down = input->pad_buttons | input->tapped;
    for (size_t i = 0; i < ACTION_BUTTONS; i++) {
        down |= input->held[action_buttons[i].action] ? action_buttons[i].button : 0U;
    }
    down |= input->mouse_use ? ENF_BUTTON_USE : 0U;
    down |= input->mouse_drop ? ENF_BUTTON_DROP : 0U;
    down |= input->noclip ? ENF_BUTTON_NOCLIP : 0U;
    down |= input->fly ? ENF_BUTTON_FLY : 0U;
    return down;
}

/* Nobody looks farther up than up: what is turned beyond is forgotten, so that coming back begins at once. */
static double bounded(double turn, double pitch_deg) {
    double most = 89.0 - pitch_deg, least = -89.0 - pitch_deg;
    return turn > most ? most : turn < least ? least : turn;
}

EnfInput input_take(Input *input, const Settings *settings, double pitch_deg) {
    EnfInput out = {0, 0, 0, 0, 0};
    double forward = (double)input->held[ACTION_FORWARD] - (double)input->held[ACTION_BACK] + input->pad_forward;
    double right = (double)input->held[ACTION_RIGHT] - (double)input->held[ACTION_LEFT] + input->pad_right;
    double length = enf_length(enf_v3(forward, right, 0.0));
    if (length > 1.0) {
        forward /= length;
        right /= length;
    }
    out.forward = axis(forward);
    out.right = axis(right);
    double tick = settings->sensitivity / ENF_TICK_RATE;
    double yaw = input->yaw_deg - input->pad_yaw * PAD_YAW * tick;
    double up = settings->invert ? -1.0 : 1.0;
    double pitch = bounded(input->pitch_deg - up * input->pad_pitch * PAD_PITCH * tick, pitch_deg);
    out.yaw = (int32_t)(yaw * ENF_INPUT_DEGREE);
    out.pitch = (int32_t)(pitch * ENF_INPUT_DEGREE);
    out.buttons = buttons(input);
    input->tapped = 0;
    input->yaw_deg = input->pitch_deg = 0.0;
    return out;
}
