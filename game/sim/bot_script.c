/* A bot's script → commands, each checked against the map. */
#include "sim/bot_internal.h"

#include "sim/text.h"

#include <string.h>

enum { NAME_SIZE = 128 };

static EnfResult bad(EnfError *error, uint32_t line, const char *what, const char *which) {
    return enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "line %u of the bot's script: %s%s%s", line, what,
                         *which ? ": " : "", which);
}

/* What stands left in the line, blanks around it taken off. */
static bool rest_of(SimText line, char out[NAME_SIZE]) {
    while (line.at < line.end && (*line.at == ' ' || *line.at == '\t')) {
        line.at++;
    }
    while (line.end > line.at && (line.end[-1] == ' ' || line.end[-1] == '\t')) {
        line.end--;
    }
    size_t length = (size_t)(line.end - line.at);
    out[0] = '\0';
    if (length == 0 || length >= NAME_SIZE || memchr(line.at, '\0', length)) {
        return false;
    }
    memcpy(out, line.at, length);
    out[length] = '\0';
    return true;
}

static EnfResult numbers(SimText line, uint32_t count, BotCommand *command, EnfError *error) {
    char word[NAME_SIZE];
    for (uint32_t i = 0; i < count; i++) {
        if (!sim_text_word(&line, 0, word, sizeof word) || !sim_text_number(word, &command->number[i])) {
            return bad(error, command->line, "a number is missing", word);
        }
    }
    return sim_text_word(&line, 0, word, sizeof word) ? bad(error, command->line, "too many words", word) : ENF_OK;
}

static uint32_t find_entity(const EnfMap *map, const char *name) {
    char target[NAME_SIZE];
    for (int by_name = 0; by_name < 2; by_name++) {
        for (uint32_t i = 0; i < map->entities_count; i++) {
            const EnfEntity *e = &map->entities[i];
            bool named = !by_name && sim_extra(enf_map_string(map, e->extras), "targetname", target, sizeof target);
            if (strcmp(by_name ? enf_map_string(map, e->name) : named ? target : "", name) == 0) {
                return i;
            }
        }
    }
    return ENF_NONE;
}

static EnfResult named(const Game *game, SimText line, BotCommand *command, EnfError *error) {
    char name[NAME_SIZE];
    if (!rest_of(line, name)) {
        return bad(error, command->line, "a name is missing", "");
    }
    bool cell = command->kind == BOT_GOTO_CELL;
    command->index = cell ? enf_map_find_cell(game->map, name) : find_entity(game->map, name);
    return command->index == ENF_NONE ? bad(error, command->line, cell ? "no such cell" : "no such entity", name) : ENF_OK;
}

/* One word of a list; the rest of the line are `count` numbers. */
static EnfResult choice(SimText line, const char *const words[], uint32_t count, BotCommand *command, EnfError *error) {
    char word[NAME_SIZE];
    sim_text_word(&line, 0, word, sizeof word);
    for (uint32_t i = 0; words[i]; i++) {
        if (strcmp(word, words[i]) == 0) {
            command->index = i;
            return numbers(line, count, command, error);
        }
    }
    return bad(error, command->line, "no such word here", word);
}

static EnfResult arguments(const Game *game, SimText line, BotCommand *command, EnfError *error) {
    static const char *const phases[] = {"playing", "won", "lost", NULL}, *const switched[] = {"off", "on", NULL};
    switch (command->kind) {
    case BOT_GOTO_CELL:
    case BOT_GOTO_ENTITY:
    case BOT_TAKE:
    case BOT_PRESS:
        return named(game, line, command, error);
    case BOT_GOTO_EXIT:
        return enf_box3_is_empty(game->exit_ws) ? bad(error, command->line, "the map has no trigger_exit", "")
                                                : numbers(line, 0, command, error);
    case BOT_GOTO_POINT:
    case BOT_LOOK_AT:
    case BOT_WALK:
        return numbers(line, 3, command, error);
    case BOT_LOOK_BY:
        return numbers(line, 2, command, error);
    case BOT_WAIT:
        return numbers(line, 1, command, error);
    case BOT_CROUCH:
    case BOT_RUN:
    case BOT_SNEAK:
        return choice(line, switched, 0, command, error);
    case BOT_EXPECT:
        return choice(line, phases, 1, command, error);
    default:
        return numbers(line, 0, command, error);
    }
}

/* Takes the words of a command off the line. */
static bool take_words(SimText *line, const char *words) {
    for (const char *at = words; *at;) {
        char word[NAME_SIZE];
        size_t length = strcspn(at, " ");
        if (!sim_text_word(line, 0, word, sizeof word) || strlen(word) != length || memcmp(word, at, length) != 0) {
            return false;
        }
        at += length;
        at += *at == ' ';
    }
    return true;
}

static EnfResult read_command(const Game *game, SimText line, BotCommand *command, EnfError *error) {
    static const char *const words[BOT_COMMAND_COUNT] = {
#define BOT_WORDS(name, text) text,
        BOT_COMMANDS(BOT_WORDS)
#undef BOT_WORDS
    };
    for (int i = 0; i < BOT_COMMAND_COUNT; i++) {
        SimText rest = line;
        if (take_words(&rest, words[i])) {
            command->kind = (BotCommandKind)i;
            return arguments(game, rest, command, error);
        }
    }
    char first[NAME_SIZE];
    sim_text_word(&line, 0, first, sizeof first);
    return bad(error, command->line, "no such command", first);
}

/* Is there a command in the line? */
static bool says_something(SimText line) {
    char word[NAME_SIZE];
    SimText copy = line;
    return (sim_text_word(&copy, 0, word, sizeof word) && word[0] != '#') || (copy.at < copy.end && word[0] == '\0');
}

EnfResult bot_parse(GameBot *bot, const char *script, size_t size, EnfError *error) {
    SimText text = {script, script + size}, line = {script, script};
    bool begun = sim_text_line(&text, &line) && (size_t)(line.end - line.at) == strlen(GAME_BOT_MAGIC) &&
                 memcmp(line.at, GAME_BOT_MAGIC, strlen(GAME_BOT_MAGIC)) == 0;
    if (!begun) {
        return bad(error, 1, "it does not begin with \"" GAME_BOT_MAGIC "\"", "");
    }
    for (uint32_t number = 2; sim_text_line(&text, &line); number++) {
        if (!says_something(line)) {
            continue;
        }
        if (bot->count == GAME_BOT_COMMANDS_MAX) {
            return enf_error_set(error, ENF_ERROR_SIZE, UINT64_MAX, "a bot's script of more than %d commands",
                                 GAME_BOT_COMMANDS_MAX);
        }
        BotCommand *command = &bot->commands[bot->count];
        *command = (BotCommand){BOT_WAIT, number, {0.0, 0.0, 0.0}, 0};
        EnfResult result = read_command(bot->game, line, command, error);
        if (result != ENF_OK) {
            return result;
        }
        bot->count++;
    }
    return ENF_OK;
}
