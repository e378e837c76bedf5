/* Command lines from a table of options; see cli.h. */
#include "common/cli.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE_MAX_PX = 16384, HELP_COLUMN = 28 };

/* ---- values ----------------------------------------------------------------------------------------------------- */

/* Parses a number at `text`; false if there is none, or if it is not finite. Blanks and signs of other alphabets are not numbers. */
static bool take_number(const char *text, const char **end, double *value) {
    if (!strchr("+-.0123456789", *text) || *text == '\0') {
        return false;
    }
    char *stop;
    errno = 0;
    double parsed = strtod(text, &stop);
    if (stop == text || !isfinite(parsed)) {
        return false;
    }
    *value = parsed;
    *end = stop;
    return true;
}

bool enf_parse_number(const char *text, double *value) {
    const char *end;
    double parsed;
    if (!take_number(text, &end, &parsed) || *end) {
        return false;
    }
    *value = parsed;
    return true;
}

static bool take_count(const char *text, const char **end, uint32_t *value) {
    uint64_t parsed = 0;
    const char *at = text;
    for (; *at >= '0' && *at <= '9'; at++) {
        parsed = parsed * 10 + (uint64_t)(*at - '0');
        if (parsed > UINT32_MAX) {
            return false;
        }
    }
    *value = (uint32_t)parsed;
    *end = at;
    return at != text;
}

bool enf_parse_count(const char *text, uint32_t *value) {
    const char *end;
    uint32_t parsed;
    if (!take_count(text, &end, &parsed) || *end) {
        return false;
    }
    *value = parsed;
    return true;
}

bool enf_parse_vector(const char *text, double value[3]) {
    double parsed[3];
    for (int axis = 0; axis < 3; axis++) {
        if (!take_number(text, &text, &parsed[axis]) || *text != (axis < 2 ? ',' : '\0')) {
            return false;
        }
        text++;
    }
    memcpy(value, parsed, sizeof parsed);
    return true;
}

bool enf_parse_size(const char *text, uint32_t value[2]) {
    uint32_t width, height;
    const char *end;
    if (!take_count(text, &end, &width) || *end != 'x' || !enf_parse_count(end + 1, &height)) {
        return false;
    }
    if (width < 1 || width > SIZE_MAX_PX || height < 1 || height > SIZE_MAX_PX) {
        return false;
    }
    value[0] = width;
    value[1] = height;
    return true;
}

static bool parse_choice(const char *choices, const char *text, int *value) {
    size_t length = strlen(text);
    int index = 0;
    for (const char *word = choices; word; index++) {
        const char *bar = strchr(word, '|');
        size_t word_length = bar ? (size_t)(bar - word) : strlen(word);
        if (word_length == length && memcmp(word, text, length) == 0) {
            *value = index;
            return true;
        }
        word = bar ? bar + 1 : NULL;
    }
    return false;
}

static bool append(EnfOptionList *list, const char *text) {
    if (list->count == ENF_OPTION_LIST_MAX) {
        return false;
    }
    list->items[list->count++] = text;
    return true;
}

static bool store(const EnfOption *option, const char *text) {
    switch (option->kind) {
    case ENF_OPTION_FLAG:
        *(bool *)option->value = true;
        return true;
    case ENF_OPTION_TEXT:
        *(const char **)option->value = text;
        return true;
    case ENF_OPTION_NUMBER:
        return enf_parse_number(text, option->value);
    case ENF_OPTION_COUNT:
        return enf_parse_count(text, option->value);
    case ENF_OPTION_VECTOR:
        return enf_parse_vector(text, option->value);
    case ENF_OPTION_SIZE:
        return enf_parse_size(text, option->value);
    case ENF_OPTION_CHOICE:
        return parse_choice(option->choices, text, option->value);
    case ENF_OPTION_LIST:
        return append(option->value, text);
    }
    return false;
}

/* ---- help ------------------------------------------------------------------------------------------------------- */

static void print_row(const char *left, const char *help) {
    if (strlen(left) >= HELP_COLUMN) {
        printf("%s\n%*s%s\n", left, HELP_COLUMN, "", help);
    } else {
        printf("%-*s%s\n", HELP_COLUMN, left, help);
    }
}

static void print_help(const EnfCli *cli) {
    printf("usage: %s %s\n\n%s\n\noptions:\n", cli->program, cli->arguments, cli->about);
    for (uint32_t i = 0; i < cli->option_count; i++) {
        const EnfOption *option = &cli->options[i];
        char left[160];
        const char *argument = option->kind == ENF_OPTION_CHOICE ? option->choices : option->argument;
        snprintf(left, sizeof left, "  %s%s%s%s%s", option->alias ? option->alias : "", option->alias ? ", " : "", option->name,
                 argument ? " " : "", argument ? argument : "");
        print_row(left, option->help);
    }
    print_row("  --help", "print this text");
    print_row("  --version", "print the version");
}

EnfCliResult enf_cli_fail(const EnfCli *cli, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "%s: ", cli->program);
    vfprintf(stderr, format, arguments);
    fprintf(stderr, "\n%s --help lists the options\n", cli->program);
    va_end(arguments);
    return ENF_CLI_USAGE;
}

/* ---- parsing ---------------------------------------------------------------------------------------------------- */

/* The option that `text` names, with *inline_value after its "=", if any. */
static const EnfOption *find_option(const EnfCli *cli, const char *text, const char **inline_value) {
    const char *equals = text[1] == '-' ? strchr(text, '=') : NULL;
    size_t length = equals ? (size_t)(equals - text) : strlen(text);
    *inline_value = equals ? equals + 1 : NULL;
    for (uint32_t i = 0; i < cli->option_count; i++) {
        const EnfOption *option = &cli->options[i];
        if (strlen(option->name) == length && memcmp(option->name, text, length) == 0) {
            return option;
        }
        if (option->alias && strcmp(option->alias, text) == 0) {
            return option;
        }
    }
    return NULL;
}

static EnfCliResult take_option(const EnfCli *cli, int argc, char **argv, int *at) {
    const char *value;
    const EnfOption *option = find_option(cli, argv[*at], &value);
    if (!option) {
        return enf_cli_fail(cli, "unknown option %s", argv[*at]);
    }
    if (option->kind == ENF_OPTION_FLAG) {
        if (value) {
            return enf_cli_fail(cli, "%s takes no value", option->name);
        }
    } else if (!value) {
        if (*at + 1 >= argc) {
            return enf_cli_fail(cli, "%s needs a value", option->name);
        }
        value = argv[++*at];
    }
    if (!store(option, value)) {
        const char *wanted = option->kind == ENF_OPTION_CHOICE ? option->choices : option->argument;
        return enf_cli_fail(cli, "%s: not %s: %s", option->name, wanted ? wanted : "valid", value ? value : "");
    }
    return ENF_CLI_RUN;
}

static bool built_in(const EnfCli *cli, const char *text) {
    if (strcmp(text, "--help") == 0 || strcmp(text, "-h") == 0) {
        print_help(cli);
        return true;
    }
    if (strcmp(text, "--version") == 0) {
        printf("%s %s\n", cli->program, ENF_VERSION);
        return true;
    }
    return false;
}

EnfCliResult enf_cli_parse(const EnfCli *cli, int argc, char **argv, const char **positional, uint32_t capacity,
                           uint32_t *count) {
    bool only_positional = false;
    *count = 0;
    for (int at = 1; at < argc; at++) {
        const char *text = argv[at];
        if (!only_positional && strcmp(text, "--") == 0) {
            only_positional = true;
            continue;
        }
        /* A lone "-" and negative numbers are values, not options. */
        bool is_option = text[0] == '-' && text[1] != '\0' && !strchr(".0123456789", text[1]);
        if (only_positional || !is_option) {
            if (*count == capacity) {
                return enf_cli_fail(cli, "unexpected argument: %s", text);
            }
            positional[(*count)++] = text;
            continue;
        }
        if (built_in(cli, text)) {
            return ENF_CLI_DONE;
        }
        EnfCliResult result = take_option(cli, argc, argv, &at);
        if (result != ENF_CLI_RUN) {
            return result;
        }
    }
    return ENF_CLI_RUN;
}
