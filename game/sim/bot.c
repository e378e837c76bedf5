/* Commands and the game as it is → the input of a tick. */
#include "sim/bot_internal.h"

#include <math.h>
#include <string.h>

enum { AIM_TICKS = 3 * ENF_TICK_RATE, GRABS = 5 };
/* Metres in the plan: near enough to take or press something; to a point. */
#define BESIDE 1.45
#define AT 0.5

EnfResult game_bot_create(GameBot **out, Game *game, const char *script, size_t size, const EnfAllocator *allocator,
                          EnfError *error) {
    ENF_ASSERT(out && game && (script || size == 0));
    *out = NULL;
    GameBot *bot = enf_alloc(allocator, 1, sizeof *bot);
    if (!bot) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a bot");
    }
    bot->allocator = *(allocator ? allocator : enf_default_allocator());
    bot->game = game;
    bot->commands = enf_alloc(&bot->allocator, GAME_BOT_COMMANDS_MAX, sizeof *bot->commands);
    EnfResult result = bot->commands ? bot_parse(bot, script, size, error)
                                     : enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a bot");
    if (result != ENF_OK) {
        game_bot_destroy(bot);
        return result;
    }
    *out = bot;
    return ENF_OK;
}

void game_bot_destroy(GameBot *bot) {
    if (bot) {
        EnfAllocator allocator = bot->allocator;
        enf_free(&allocator, bot->commands, GAME_BOT_COMMANDS_MAX, sizeof *bot->commands);
        enf_free(&allocator, bot, 1, sizeof *bot);
    }
}

/* ---- things ----------------------------------------------------------------------------------------------------------------- */

static uint32_t mover_of(const Game *game, uint32_t entity) {
    for (uint32_t i = 0; i < game->map->movers_count; i++) {
        if (game->map->movers[i].entity == entity) {
            return i;
        }
    }
    return ENF_NONE;
}

static const SimItem *item_of(const Game *game, uint32_t entity) {
    uint32_t mover = mover_of(game, entity);
    for (uint32_t i = 0; i < game->item_count; i++) {
        if (game->items[i].mover == mover) {
            return &game->items[i];
        }
    }
    return NULL;
}

EnfVec3 bot_place_of(const GameBot *bot, uint32_t entity) {
    const Game *game = bot->game;
    const EnfEntity *e = &game->map->entities[entity];
    const SimItem *item = item_of(game, entity);
    if (item) {
        return item->at;
    }
    uint32_t mover = mover_of(game, entity);
    bool lives = mover != ENF_NONE && enf_world_object(game->world, mover).generation != 0;
    return lives ? enf_scale(enf_add(enf_box3_from_f(enf_world_box(game->world, mover)).min,
                                     enf_box3_from_f(enf_world_box(game->world, mover)).max),
                             0.5)
                 : enf_v3(e->translation[0], e->translation[1], e->translation[2]);
}

/* The lowest height of what moves, or of nothing: the middle of a tall door is too high over the floor to be walked to. */
static double foot_of(const GameBot *bot, uint32_t entity) {
    uint32_t mover = mover_of(bot->game, entity);
    bool lives = mover != ENF_NONE && enf_world_object(bot->game->world, mover).generation != 0;
    return lives ? (double)enf_world_box(bot->game->world, mover).min.y + 0.1 : HUGE_VAL;
}

/* ---- commands --------------------------------------------------------------------------------------------------------------- */

static EnfVec3 middle_of_cell(const EnfMap *map, uint32_t cell) {
    const EnfCell *c = &map->cells[cell];
    return enf_v3(c->origin[0] + 0.5 * (double)(c->min[0] + c->max[0]), c->origin[1] + (double)c->min[1],
                  c->origin[2] + 0.5 * (double)(c->min[2] + c->max[2]));
}

/* The trip of a command, at its first tick. */
static void set_out(GameBot *bot, const BotCommand *command) {
    const Game *game = bot->game;
    EnfVec3 to = enf_v3(command->number[0], command->number[1], command->number[2]), up = enf_v3(0.0, 1.0, 0.0);
    if (command->kind == BOT_GOTO_CELL) {
        bot_trip_start(bot, middle_of_cell(game->map, command->index), command->index, AT, true);
    } else if (command->kind == BOT_GOTO_POINT) {
        bot_trip_start(bot, to, enf_map_locate(game->map, enf_add(to, up)), AT, false);
    } else if (command->kind == BOT_GOTO_EXIT) {
        to = enf_scale(enf_add(game->exit_ws.min, game->exit_ws.max), 0.5);
        to.y = game->exit_ws.min.y;
        bot_trip_start(bot, to, enf_map_locate(game->map, enf_add(to, up)), AT, false);
    } else {
        to = bot_place_of(bot, command->index);
        to.y = fmin(to.y, foot_of(bot, command->index));
        uint32_t cell = enf_map_locate(game->map, to);
        bot_trip_start(bot, to, cell != ENF_NONE ? cell : enf_map_locate(game->map, enf_add(to, up)), BESIDE, false);
    }
}

/* After the trip: looks at the thing and uses it; once more, from where it then stands, if an item was missed. */
static GameBotNews grab(GameBot *bot, const BotCommand *command, EnfInput *input, const char **why) {
    const SimItem *item = command->kind == BOT_TAKE ? item_of(bot->game, command->index) : NULL;
    *why = "it is nothing to be taken";
    if (command->kind == BOT_TAKE && !item) {
        return GAME_BOT_FAILED;
    }
    if (item && item->state != SIM_ITEM_LIES) {
        return GAME_BOT_DONE;
    }
    EnfVec3 at = enf_add(bot_place_of(bot, command->index), enf_v3(0.0, item ? 0.15 : 0.0, 0.0));
    uint32_t step = bot->phase++;
    bool aimed = bot_look(bot, at, input) || step % AIM_TICKS == AIM_TICKS - 2;
    *why = "it cannot be reached";
    if (step >= GRABS * AIM_TICKS) {
        return GAME_BOT_FAILED;
    }
    if (!aimed || step % 2) {
        return GAME_BOT_GOES_ON;
    }
    input->yaw = input->pitch = 0;
    input->buttons |= ENF_BUTTON_USE;
    return item ? GAME_BOT_GOES_ON : GAME_BOT_DONE;
}

static GameBotNews travel(GameBot *bot, const BotCommand *command, EnfInput *input, const char **why) {
    if (bot->tick == 0) {
        set_out(bot, command);
    }
    if (bot->game->score.phase != GAME_PLAYING) {
        return GAME_BOT_DONE; /* nobody walks any more: what was to come of it is for `expect` to say */
    }
    if (bot->phase == 0) {
        GameBotNews news = bot_trip_step(bot, input, why);
        if (news != GAME_BOT_DONE) {
            return news;
        }
    }
    if (command->kind == BOT_TAKE || command->kind == BOT_PRESS) {
        return grab(bot, command, input, why);
    }
    return GAME_BOT_DONE;
}

static int16_t share(double value) {
    return (int16_t)floor(fmin(fmax(value, -1.0), 1.0) * 32767.0 + 0.5);
}

static GameBotNews for_seconds(const GameBot *bot, double seconds) {
    return (double)bot->tick + 1.0 >= seconds * ENF_TICK_RATE ? GAME_BOT_DONE : GAME_BOT_GOES_ON;
}

static GameBotNews expect(const GameBot *bot, const BotCommand *command, const char **why) {
    *why = bot->game->score.phase == GAME_LOST ? "a guard has caught the bot" : "the game is not so in time";
    if (bot->game->score.phase == command->index) {
        return GAME_BOT_DONE;
    }
    return for_seconds(bot, command->number[0]) == GAME_BOT_DONE ? GAME_BOT_FAILED : GAME_BOT_GOES_ON;
}

/* Turns by degrees, over as many ticks as a hand would take. */
static GameBotNews turn_by(const GameBot *bot, const BotCommand *command, EnfInput *input) {
    double yaw = command->number[0], pitch = command->number[1];
    double ticks = ceil(fmax(fmax(fabs(yaw), fabs(pitch)) / 6.0, 1.0)), now = (double)bot->tick;
    input->yaw = (int32_t)(floor(yaw * (now + 1.0) / ticks * ENF_INPUT_DEGREE) - floor(yaw * now / ticks * ENF_INPUT_DEGREE));
    input->pitch = (int32_t)(floor(pitch * (now + 1.0) / ticks * ENF_INPUT_DEGREE) -
                             floor(pitch * now / ticks * ENF_INPUT_DEGREE));
    return now + 1.0 >= ticks ? GAME_BOT_DONE : GAME_BOT_GOES_ON;
}

static GameBotNews once(const GameBot *bot, uint32_t button, EnfInput *input) {
    input->buttons |= bot->tick == 0 ? button : 0; /* and a tick without it, so that it can be pressed again */
    return bot->tick > 0 ? GAME_BOT_DONE : GAME_BOT_GOES_ON;
}

static GameBotNews hold(GameBot *bot, uint32_t button, bool on) {
    bot->held = on ? bot->held | button : bot->held & ~button;
    return GAME_BOT_DONE;
}

static GameBotNews obey(GameBot *bot, const BotCommand *command, EnfInput *input, const char **why) {
    const double *number = command->number;
    switch (command->kind) {
    case BOT_LOOK_AT:
        return bot_look(bot, enf_v3(number[0], number[1], number[2]), input) || bot->tick > AIM_TICKS ? GAME_BOT_DONE
                                                                                                      : GAME_BOT_GOES_ON;
    case BOT_LOOK_BY:
        return turn_by(bot, command, input);
    case BOT_USE:
        return once(bot, ENF_BUTTON_USE, input);
    case BOT_DROP:
        return once(bot, ENF_BUTTON_DROP, input);
    case BOT_JUMP:
        return once(bot, ENF_BUTTON_JUMP, input);
    case BOT_CROUCH:
        return hold(bot, ENF_BUTTON_CROUCH, command->index != 0);
    case BOT_RUN:
        return hold(bot, ENF_BUTTON_RUN, command->index != 0);
    case BOT_SNEAK:
        bot->sneak.on = command->index != 0;
        bot->sneak.gait = bot->sneak.crumb_count = 0;
        return GAME_BOT_DONE;
    case BOT_WAIT:
        return for_seconds(bot, number[0]);
    case BOT_WALK:
        input->forward = share(number[0]);
        input->right = share(number[1]);
        return for_seconds(bot, number[2]);
    case BOT_EXPECT:
        return expect(bot, command, why);
    default:
        return travel(bot, command, input, why);
    }
}

GameBotNews game_bot_next(GameBot *bot, EnfInput *input, EnfError *error) {
    memset(input, 0, sizeof *input);
    if (bot->at >= bot->count) {
        return GAME_BOT_DONE;
    }
    const BotCommand *command = &bot->commands[bot->at];
    const char *why = "";
    GameBotNews news = obey(bot, command, input, &why);
    input->buttons |= bot->sneak.on ? (bot->held & ~(uint32_t)ENF_BUTTON_RUN) | bot->sneak.gait : bot->held;
    bot->tick++;
    if (news == GAME_BOT_FAILED) {
        enf_error_set(error, ENF_ERROR_RANGE, UINT64_MAX, "line %u of the bot's script: %s (tick %llu)", command->line, why,
                      (unsigned long long)bot->game->score.tick);
        return news;
    }
    if (news == GAME_BOT_DONE) {
        bot->at++;
        bot->tick = bot->phase = 0;
    }
    return GAME_BOT_GOES_ON;
}
