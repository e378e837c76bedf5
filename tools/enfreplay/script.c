/* Parses scripts of inputs, line by line; see script.h for the language. */
#include "enfreplay/script.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/cli.h"

enum { LINE_MAX = 512, DEPTH_MAX = 8, TURN_MAX_DEG = 36000 };

static const struct {
    const char *name;
    uint32_t bit;
} buttons[] = {{"jump", ENF_BUTTON_JUMP}, {"crouch", ENF_BUTTON_CROUCH}, {"run", ENF_BUTTON_RUN}, {"use", ENF_BUTTON_USE},
               {"drop", ENF_BUTTON_DROP}, {"noclip", ENF_BUTTON_NOCLIP}, {"fly", ENF_BUTTON_FLY}};

/* A "repeat" that is open: where its ticks begin, and how often they come. */
typedef struct Loop {
    uint32_t first, times, line;
} Loop;

typedef struct Parser {
    Script *script;
    EnfError *error;
    uint32_t line;
    Loop loops[DEPTH_MAX];
    uint32_t depth;
} Parser;

static EnfResult fail(const Parser *parser, const char *what, const char *word) {
    return enf_error_set(parser->error, ENF_ERROR_FORMAT, UINT64_MAX, "line %u: %s%s%s", parser->line, what, word ? ": " : "",
                         word ? word : "");
}

/* Room for `more` further ticks. */
static EnfResult reserve(Parser *parser, uint32_t more) {
    Script *script = parser->script;
    if (more > SCRIPT_TICKS_MAX - script->count) {
        return fail(parser, "the script is longer than 3000000 ticks", NULL);
    }
    if (script->count + more > script->capacity) {
        uint32_t wanted = 2 * (script->count + more);
        EnfInput *grown = enf_realloc(NULL, script->inputs, script->capacity, wanted, sizeof *grown);
        if (!grown) {
            return enf_error_set(parser->error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a script");
        }
        script->inputs = grown;
        script->capacity = wanted;
    }
    return ENF_OK;
}

/* What a line asks for: of one tick, but for the turn, which is of all its ticks. */
typedef struct Ask {
    double forward, right, yaw_deg, pitch_deg;
    uint32_t buttons;
} Ask;

/* "word" or "word=number"; `value` is NAN without a number. */
static EnfResult take_word(const Parser *parser, char *word, Ask *ask) {
    char *equals = strchr(word, '=');
    double value = (double)NAN;
    if (equals) {
        *equals = '\0';
        if (!enf_parse_number(equals + 1, &value)) {
            return fail(parser, "not a number", equals + 1);
        }
    }
    double speed = equals ? value : 1.0;
    bool is_speed = speed >= 0.0 && speed <= 1.0, is_turn = equals && fabs(value) <= TURN_MAX_DEG;
    if (strcmp(word, "forward") == 0 && is_speed) {
        ask->forward = speed;
    } else if (strcmp(word, "back") == 0 && is_speed) {
        ask->forward = -speed;
    } else if (strcmp(word, "right") == 0 && is_speed) {
        ask->right = speed;
    } else if (strcmp(word, "left") == 0 && is_speed) {
        ask->right = -speed;
    } else if (strcmp(word, "yaw") == 0 && is_turn) {
        ask->yaw_deg = value;
    } else if (strcmp(word, "pitch") == 0 && is_turn) {
        ask->pitch_deg = value;
    } else if (strcmp(word, "button") == 0 && equals && value >= 0.0 && value <= 31.0) {
        ask->buttons |= UINT32_C(1) << (uint32_t)value;
    } else {
        for (size_t i = 0; i < sizeof buttons / sizeof *buttons; i++) {
            if (!equals && strcmp(word, buttons[i].name) == 0) {
                ask->buttons |= buttons[i].bit;
                return ENF_OK;
            }
        }
        return fail(parser, "not understood", word);
    }
    return ENF_OK;
}

/* The part of a whole turn that falls to tick `i` of `count`: the parts differ by at most one unit and add up. */
static int32_t part_of(int64_t whole, uint32_t i, uint32_t count) {
    return (int32_t)(whole * ((int64_t)i + 1) / count - whole * (int64_t)i / count);
}

static EnfResult add_ticks(Parser *parser, uint32_t count, const Ask *ask) {
    EnfResult result = reserve(parser, count);
    if (result != ENF_OK) {
        return result;
    }
    int64_t yaw = llround(ask->yaw_deg * ENF_INPUT_DEGREE), pitch = llround(ask->pitch_deg * ENF_INPUT_DEGREE);
    for (uint32_t i = 0; i < count; i++) {
        EnfInput input = {(int16_t)lround(ask->forward * 32767.0), (int16_t)lround(ask->right * 32767.0),
                          part_of(yaw, i, count), part_of(pitch, i, count), ask->buttons};
        parser->script->inputs[parser->script->count++] = input;
    }
    return ENF_OK;
}

static EnfResult end_loop(Parser *parser) {
    if (parser->depth == 0) {
        return fail(parser, "\"end\" without \"repeat\"", NULL);
    }
    Loop loop = parser->loops[--parser->depth];
    uint32_t length = parser->script->count - loop.first;
    if ((uint64_t)length * loop.times > SCRIPT_TICKS_MAX) {
        return fail(parser, "the script is longer than 3000000 ticks", NULL);
    }
    EnfResult result = reserve(parser, length * (loop.times - 1));
    for (uint32_t i = 1; i < loop.times && result == ENF_OK; i++) {
        EnfInput *inputs = parser->script->inputs;
        memcpy(inputs + parser->script->count, inputs + loop.first, length * sizeof *inputs);
        parser->script->count += length;
    }
    return result;
}

static EnfResult begin_loop(Parser *parser, const char *times) {
    Loop loop = {parser->script->count, 0, parser->line};
    if (!times || !enf_parse_count(times, &loop.times) || loop.times < 1 || loop.times > SCRIPT_TICKS_MAX) {
        return fail(parser, "\"repeat\" wants a number", times);
    }
    if (parser->depth == DEPTH_MAX) {
        return fail(parser, "more than 8 repeats in one another", NULL);
    }
    parser->loops[parser->depth++] = loop;
    return ENF_OK;
}

/* The next word of a line, split off; NULL at its end. */
static char *next_word(char **line) {
    char *word = *line + strspn(*line, " \t\r");
    if (*word == '\0' || *word == '#') {
        return NULL;
    }
    size_t length = strcspn(word, " \t\r");
    *line = word + length + (word[length] != '\0');
    word[length] = '\0';
    return word;
}

static EnfResult parse_line(Parser *parser, char *line) {
    Ask ask = {0.0, 0.0, 0.0, 0.0, 0};
    char *word = next_word(&line);
    uint32_t count;
    if (!word) {
        return ENF_OK;
    }
    if (strcmp(word, "repeat") == 0) {
        return begin_loop(parser, next_word(&line));
    }
    if (strcmp(word, "end") == 0) {
        return end_loop(parser);
    }
    if (!enf_parse_count(word, &count) || count < 1 || count > SCRIPT_TICKS_MAX) {
        return fail(parser, "a line begins with a number of ticks, \"repeat\" or \"end\", not with", word);
    }
    while ((word = next_word(&line)) != NULL) {
        EnfResult result = take_word(parser, word, &ask);
        if (result != ENF_OK) {
            return result;
        }
    }
    return add_ticks(parser, count, &ask);
}

bool script_is_one(const char *text, size_t size) {
    size_t length = strlen(SCRIPT_MAGIC);
    return size >= length && memcmp(text, SCRIPT_MAGIC, length) == 0 &&
           (size == length || text[length] == '\n' || text[length] == '\r');
}

EnfResult script_parse(Script *script, const char *text, size_t size, EnfError *error) {
    Parser parser = {.script = script, .error = error, .line = 1};
    memset(script, 0, sizeof *script);
    if (!script_is_one(text, size)) {
        return fail(&parser, "a script of inputs begins with \"" SCRIPT_MAGIC "\"", NULL);
    }
    for (size_t at = 0; at < size; parser.line++) {
        const char *end = memchr(text + at, '\n', size - at);
        size_t length = end ? (size_t)(end - text) - at : size - at;
        char line[LINE_MAX];
        if (length >= sizeof line || memchr(text + at, '\0', length)) {
            return fail(&parser, "not a line of text of at most 511 bytes", NULL);
        }
        memcpy(line, text + at, length);
        line[length] = '\0';
        EnfResult result = parser.line > 1 ? parse_line(&parser, line) : ENF_OK;
        if (result != ENF_OK) {
            return result;
        }
        at += length + (end != NULL);
    }
    parser.line = parser.depth ? parser.loops[parser.depth - 1].line : parser.line;
    return parser.depth ? fail(&parser, "\"repeat\" without \"end\"", NULL) : ENF_OK;
}

void script_free(Script *script) {
    enf_free(NULL, script->inputs, script->capacity, sizeof *script->inputs);
    memset(script, 0, sizeof *script);
}
