/* What can be taken: exhibits to carry out, keys. And what `use` does: take, open, press. */
#include "sim/sim.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *extras_of(const Game *game, uint32_t mover) {
    return enf_map_string(game->map, game->map->entities[game->map->movers[mover].entity].extras);
}

void sim_items_start(Game *game) {
    bool again = game->item_count > 0; /* a restart: the objects are there, under their ids */
    uint32_t count = 0;
    for (uint32_t i = 0; i < game->map->movers_count; i++) {
        if (!(game->map->movers[i].flags & ENF_MOVER_CARRY)) {
            continue;
        }
        SimItem *item = &game->items[count];
        const EnfEntity *entity = &game->map->entities[game->map->movers[i].entity];
        char key[SIM_KEY_SIZE];
        game->item_objects[count] = again ? game->item_objects[count] : enf_world_object(game->world, i);
        /* Things to take are no obstacles: what is laid down again would have to be one under another index. */
        enf_collider_set_solid(game->collider, game->item_objects[count].index, false);
        memset(item, 0, sizeof *item);
        item->mover = i;
        item->is_key = strcmp(enf_map_string(game->map, entity->classname), "item_key") == 0;
        sim_extra(extras_of(game, i), "key", key, sizeof key);
        item->key = sim_name(key);
        double value = sim_extra_number(extras_of(game, i), "value", 1.0);
        item->value = value > 0.0 && value < 1e6 ? (uint32_t)value : 0;
        item->at = enf_v3(entity->translation[0], entity->translation[1], entity->translation[2]);
        count++;
    }
    game->item_count = count;
}

bool sim_has_key(const Game *game, uint64_t key) {
    for (uint32_t i = 0; i < game->item_count; i++) {
        if (game->items[i].is_key && game->items[i].key == key && game->items[i].state == SIM_ITEM_CARRIED) {
            return true;
        }
    }
    return false;
}

static void title_of(const Game *game, const SimItem *item, char out[GAME_TEXT_SIZE - 16]) {
    if (!sim_extra(extras_of(game, item->mover), "title", out, GAME_TEXT_SIZE - 16)) {
        snprintf(out, GAME_TEXT_SIZE - 16, "%s", item->is_key ? "a key" : "an exhibit");
    }
}

/* The item that lies nearest to where the player looks, within reach. */
static uint32_t item_ahead(const Game *game, EnfVec3 eye, EnfVec3 look) {
    uint32_t best = ENF_NONE;
    double nearest = 0.9; /* the cosine of the angle to the line of sight that is still meant */
    for (uint32_t i = 0; i < game->item_count; i++) {
        EnfVec3 way = enf_sub(enf_add(game->items[i].at, enf_v3(0.0, 0.15, 0.0)), eye);
        double away = enf_length(way);
        double ahead = away > 0.0 ? enf_dot(way, look) / away : 1.0;
        if (game->items[i].state == SIM_ITEM_LIES && away < SIM_REACH + 0.3 && ahead > nearest) {
            nearest = ahead;
            best = i;
        }
    }
    return best;
}

static void take(Game *game, uint32_t index) {
    SimItem *item = &game->items[index];
    char title[GAME_TEXT_SIZE - 16], text[GAME_TEXT_SIZE];
    enf_world_remove(game->world, game->item_objects[index]);
    item->state = SIM_ITEM_CARRIED;
    title_of(game, item, title);
    snprintf(text, sizeof text, "You took %s", title);
    sim_say(game, text);
    sim_sound(game, item->is_key ? GAME_SOUND_TAKE_KEY : GAME_SOUND_TAKE, item->at, game->player.body.cell, 0.5);
}

static uint32_t button_ahead(const Game *game, EnfVec3 eye, EnfVec3 look) {
    for (uint32_t i = 0; i < game->button_count; i++) {
        EnfVec3 way = enf_sub(enf_world_pose(game->world, game->buttons[i].object).position, eye);
        double away = enf_length(way);
        if (away < SIM_REACH && enf_dot(way, look) > 0.8 * away) {
            return i;
        }
    }
    return ENF_NONE;
}

/* The elevator under the player's feet. */
static uint32_t lift_below(const Game *game) {
    for (uint32_t i = 0; i < game->lift_count; i++) {
        if (game->player.body.ground_object == game->lifts[i].object.index &&
            (game->player.body.flags & ENF_CHARACTER_GROUNDED)) {
            return i;
        }
    }
    return ENF_NONE;
}

static bool calls_lift(const Game *game, uint32_t index) {
    bool calls = false;
    for (uint32_t i = 0; i < game->lift_count; i++) {
        calls = calls || game->lifts[i].name == game->buttons[index].target;
    }
    return calls;
}

static void press(Game *game, uint32_t index) {
    const SimButton *button = &game->buttons[index];
    sim_sound(game, GAME_SOUND_SWITCH, enf_world_pose(game->world, button->object).position, game->player.body.cell, 0.5);
    sim_lift_call(game, button->target, button->stop);
    for (uint32_t i = 0; i < game->door_count; i++) {
        if (game->doors[i].name == button->target) {
            sim_door_open(game, i, true, NULL);
        }
    }
}

static void open_door(Game *game, uint32_t index, bool now) {
    const SimDoor *door = &game->doors[index];
    bool barred = door->locked && !(door->key && sim_has_key(game, door->key));
    snprintf(game->shown.prompt, GAME_TEXT_SIZE, "%s",
             barred                ? "try the locked door"
             : door->wanted == 0.0 ? "open the door"
                                   : "");
    if (now && !sim_door_open(game, index, false, &game->player.body.position)) {
        sim_say(game, "The door is locked");
    }
}

void sim_use(Game *game, bool now) {
    EnfVec3 eye = enf_character_eye(&game->player.body);
    EnfVec3 look = sim_look((double)game->player.yaw / ENF_INPUT_DEGREE, (double)game->player.pitch / ENF_INPUT_DEGREE);
    uint32_t item = item_ahead(game, eye, look), button = button_ahead(game, eye, look), lift = lift_below(game), door;
    game->shown.prompt[0] = '\0';
    if (item != ENF_NONE) {
        char title[GAME_TEXT_SIZE - 16];
        title_of(game, &game->items[item], title);
        snprintf(game->shown.prompt, GAME_TEXT_SIZE, "take %s", title);
        if (now) {
            take(game, item);
        }
    } else if (button != ENF_NONE) {
        snprintf(game->shown.prompt, GAME_TEXT_SIZE, "%s",
                 calls_lift(game, button) ? "call the elevator" : "press the switch: it opens a door");
        if (now) {
            press(game, button);
        }
    } else if ((door = sim_door_near(game, eye, look, SIM_REACH)) != ENF_NONE) {
        open_door(game, door, now);
    } else if (lift != ENF_NONE) {
        snprintf(game->shown.prompt, GAME_TEXT_SIZE, "ride the elevator");
        if (now) {
            sim_lift_call(game, game->lifts[lift].name, ENF_NONE);
        }
    }
}

/* Lays the item that was taken last at the player's feet; keys are kept. */
void sim_drop(Game *game) {
    for (uint32_t i = game->item_count; i-- > 0;) {
        SimItem *item = &game->items[i];
        if (item->is_key || item->state != SIM_ITEM_CARRIED) {
            continue;
        }
        EnfObjectDef def = enf_mover_def(game->map, item->mover);
        EnfVec3 ahead = sim_look((double)game->player.yaw / ENF_INPUT_DEGREE, 0.0);
        item->at = enf_add(game->player.body.position, enf_add(enf_scale(ahead, 0.35), enf_v3(0.0, 0.02, 0.0)));
        def.motion.as.still.position = item->at;
        game->item_objects[i] = enf_world_add(game->world, &def, NULL);
        item->state = SIM_ITEM_LIES;
        sim_sound(game, GAME_SOUND_DROP, item->at, game->player.body.cell, 0.5);
        sim_guards_hear(game, item->at, 8.0);
        return;
    }
}

static bool inside(EnfBox3 box, EnfVec3 p) {
    return p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y - 0.5 && p.y <= box.max.y && p.z >= box.min.z &&
           p.z <= box.max.z;
}

/* At the way out, what is carried is carried out. */
void sim_items_step(Game *game) {
    if (game->score.phase != GAME_PLAYING || !inside(game->exit_ws, game->player.body.position)) {
        return;
    }
    uint32_t delivered = 0;
    for (uint32_t i = 0; i < game->item_count; i++) {
        SimItem *item = &game->items[i];
        if (!item->is_key && item->state == SIM_ITEM_CARRIED) {
            item->state = SIM_ITEM_OUT;
            game->score.value += item->value;
            delivered++;
        }
    }
    game->score.delivered += delivered;
    if (delivered > 0) {
        sim_sound(game, GAME_SOUND_DELIVERED, game->player.body.position, game->player.body.cell, 0.8);
        sim_say(game, "Carried out");
    }
    if (game->score.wanted > 0 && game->score.delivered >= game->score.wanted) {
        game->score.phase = GAME_WON;
        sim_sound(game, GAME_SOUND_WON, game->player.body.position, game->player.body.cell, 1.0);
    }
}
