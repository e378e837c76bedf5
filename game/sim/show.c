/* GameState: what is to be shown, out of what is so. */
#include "sim/sim.h"

#include <math.h>
#include <string.h>

static void show_items(Game *game, GameState *shown) {
    shown->carried = shown->carried_value = shown->exhibits = shown->exhibits_left = 0;
    for (uint32_t i = 0; i < game->item_count; i++) {
        const SimItem *item = &game->items[i];
        if (item->is_key) {
            continue;
        }
        game->exhibit_views[shown->exhibits++] = (GameExhibitView){item->at, item->state == SIM_ITEM_LIES};
        shown->exhibits_left += item->state == SIM_ITEM_LIES;
        shown->carried += item->state == SIM_ITEM_CARRIED;
        shown->carried_value += item->state == SIM_ITEM_CARRIED ? item->value : 0;
    }
    shown->exhibit_views = game->exhibit_views;
}

static void show_guards(Game *game, GameState *shown) {
    shown->noticed = 0.0;
    for (uint32_t i = 0; i < game->guard_count; i++) {
        const SimGuard *guard = &game->guards[i];
        game->guard_views[i] = (GameGuardView){guard->body.position, guard->yaw_deg, guard->notice, (GameGuardMood)guard->mood};
        shown->noticed = fmax(shown->noticed, guard->notice);
    }
    shown->guards = game->guard_views;
    shown->guard_count = game->guard_count;
}

void sim_show(Game *game) {
    GameState *shown = &game->shown;
    const EnfCharacter *body = &game->player.body;
    shown->phase = (GamePhase)game->score.phase;
    shown->tick = game->score.tick;
    shown->eye_ws = enf_character_eye(body);
    shown->yaw_deg = (double)game->player.yaw / ENF_INPUT_DEGREE;
    shown->pitch_deg = (double)game->player.pitch / ENF_INPUT_DEGREE;
    shown->cell = body->cell;
    shown->crouched = (body->flags & ENF_CHARACTER_CROUCHED) != 0;
    shown->flying = body->mode != ENF_CHARACTER_WALK;
    shown->delivered = game->score.delivered;
    shown->wanted = game->score.wanted;
    shown->score = game->score.value;
    shown->light = sim_light(game, body->cell, enf_add(body->position, enf_v3(0.0, 1.0, 0.0)));
    show_items(game, shown);
    show_guards(game, shown);
    if (shown->tick == 0) {
        shown->eye_before_ws = shown->eye_ws;
        shown->yaw_before_deg = shown->yaw_deg;
        shown->pitch_before_deg = shown->pitch_deg;
    }
    if (game->message_until < sim_tick(game)) {
        shown->message[0] = '\0';
    }
}
