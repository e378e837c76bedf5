/* The player: looks, walks with the engine's body, makes footsteps, uses and drops. */
#include "sim/sim.h"

#include <math.h>
#include <string.h>

enum { QUARTER = 90 * ENF_INPUT_DEGREE };
/* Metres of a stride. */
#define STRIDE_WALK 0.75
#define STRIDE_RUN 1.1

void sim_player_start(Game *game) {
    SimPlayer *player = &game->player;
    memset(player, 0, sizeof *player);
    EnfCharacterDef def = enf_character_def_default();
    enf_character_spawn(&player->body, game->collider, &def, game->spawn);
    player->body.object = ENF_NONE;
    player->yaw = game->spawn_yaw;
}

/* Whole turns are taken off, so that the yaw never overflows. */
static void turn(SimPlayer *player, const EnfInput *input) {
    int64_t circle = (int64_t)4 * QUARTER;
    int64_t yaw = ((int64_t)player->yaw + input->yaw) % circle;
    int64_t pitch = (int64_t)player->pitch + input->pitch;
    player->yaw = (int32_t)(yaw > 2 * QUARTER ? yaw - circle : yaw < -2 * (int64_t)QUARTER ? yaw + circle : yaw);
    player->pitch = (int32_t)(pitch > QUARTER ? QUARTER : pitch < -QUARTER ? -QUARTER : pitch);
}

static EnfVec3 wish_of(const SimPlayer *player, const EnfInput *input, bool flies) {
    double yaw = (double)player->yaw / ENF_INPUT_DEGREE, pitch = flies ? (double)player->pitch / ENF_INPUT_DEGREE : 0.0;
    EnfVec3 ahead = sim_look(yaw, pitch), right = sim_look(yaw - 90.0, 0.0);
    EnfVec3 wish = enf_add(enf_scale(ahead, (double)input->forward / 32767.0),
                           enf_scale(right, (double)input->right / 32767.0));
    double size = enf_length(wish);
    if (flies) {
        wish.y += (input->buttons & ENF_BUTTON_JUMP ? 1.0 : 0.0) - (input->buttons & ENF_BUTTON_CROUCH ? 1.0 : 0.0);
        size = enf_length(wish);
    }
    return size > 1.0 ? enf_scale(wish, 1.0 / size) : wish;
}

/* What the ground sounds of, by the name of its material. */
static GameSoundKind step_kind(const Game *game) {
    static const char *const wood[] = {"wood", "parquet", "plank", "floor"}, *const soft[] = {"carpet", "rug", "cloth",
                                                                                              "grass"};
    uint32_t cluster = game->player.body.ground_cluster;
    if (cluster >= game->map->clusters_count) {
        return GAME_SOUND_STEP_WOOD;
    }
    const char *name = enf_map_string(game->map, game->map->materials[game->map->clusters[cluster].material].name);
    for (int i = 0; i < 4; i++) {
        if (strstr(name, soft[i])) {
            return GAME_SOUND_STEP_CARPET;
        }
        if (strstr(name, wood[i])) {
            return GAME_SOUND_STEP_WOOD;
        }
    }
    return GAME_SOUND_STEP_STONE;
}

static void footsteps(Game *game, const EnfInput *input, EnfVec3 before, const EnfCharacterReport *report) {
    SimPlayer *player = &game->player;
    EnfVec3 feet = player->body.position;
    uint32_t cell = player->body.cell;
    bool crouched = (player->body.flags & ENF_CHARACTER_CROUCHED) != 0, runs = (input->buttons & ENF_BUTTON_RUN) != 0;
    if (report->moved & ENF_MOVED_JUMPED) {
        sim_sound(game, GAME_SOUND_JUMP, feet, cell, 0.4);
    }
    if ((report->moved & ENF_MOVED_LANDED) && report->fall_speed > 2.0) {
        sim_sound(game, GAME_SOUND_LAND, feet, cell, 0.7);
        sim_guards_hear(game, feet, SIM_HEARD_WALK + report->fall_speed);
    }
    if (!(player->body.flags & ENF_CHARACTER_GROUNDED) || (report->moved & ENF_MOVED_RELOCATED)) {
        return;
    }
    EnfVec3 way = enf_sub(feet, before);
    player->stride += sqrt(way.x * way.x + way.z * way.z);
    if (player->stride >= (runs ? STRIDE_RUN : STRIDE_WALK)) {
        player->stride = 0.0;
        player->steps++;
        sim_sound(game, step_kind(game), feet, cell, crouched ? 0.08 : runs ? 0.7 : 0.35);
        sim_guards_hear(game, feet, crouched ? SIM_HEARD_CROUCH : runs ? SIM_HEARD_RUN : SIM_HEARD_WALK);
    }
}

void sim_player_step(Game *game, const EnfInput *input) {
    SimPlayer *player = &game->player;
    uint32_t pressed = input->buttons & ~player->buttons;
    EnfCharacterMode mode = (EnfCharacterMode)player->body.mode;
    mode = pressed & ENF_BUTTON_NOCLIP ? mode == ENF_CHARACTER_NOCLIP ? ENF_CHARACTER_WALK : ENF_CHARACTER_NOCLIP : mode;
    mode = pressed & ENF_BUTTON_FLY ? mode == ENF_CHARACTER_FLY ? ENF_CHARACTER_WALK : ENF_CHARACTER_FLY : mode;
    player->buttons = input->buttons;
    turn(player, input);
    bool flies = mode != ENF_CHARACTER_WALK;
    EnfCharacterInput told = {wish_of(player, input, flies), (input->buttons & ENF_BUTTON_JUMP) != 0,
                              (input->buttons & ENF_BUTTON_CROUCH) != 0, (input->buttons & ENF_BUTTON_RUN) != 0, mode};
    EnfCharacterReport report;
    EnfVec3 before = player->body.position;
    enf_character_move(&player->body, game->collider, &told, &report);
    if (report.moved & ENF_MOVED_SQUEEZED) {
        sim_turn_back(game, report.squeezed_by);
    }
    if (report.moved & ENF_MOVED_RELOCATED) {
        game->shown.eye_before_ws = enf_character_eye(&player->body);
    }
    footsteps(game, input, before, &report);
    sim_use(game, (pressed & ENF_BUTTON_USE) != 0);
    if (pressed & ENF_BUTTON_DROP) {
        sim_drop(game);
    }
}
