/* Command lines of the programs: one table of options a program, from which parsing, --help and error messages come. */
#ifndef ENFILADE_COMMON_CLI_H
#define ENFILADE_COMMON_CLI_H

#include <stdbool.h>
#include <stdint.h>

/** Exit statuses of every program. */
enum { ENF_EXIT_OK = 0, ENF_EXIT_FAILURE = 1, ENF_EXIT_USAGE = 2 };

typedef enum EnfOptionKind {
    ENF_OPTION_FLAG,   /**< no argument; value: bool, set to true */
    ENF_OPTION_TEXT,   /**< value: const char *, points into argv */
    ENF_OPTION_NUMBER, /**< value: double, finite */
    ENF_OPTION_COUNT,  /**< value: uint32_t */
    ENF_OPTION_VECTOR, /**< value: double[3], from "X,Y,Z" */
    ENF_OPTION_SIZE,   /**< value: uint32_t[2], from "WxH", both in 1..16384 */
    ENF_OPTION_CHOICE, /**< value: int, the index of the word in `choices` ("a|b|c") */
    ENF_OPTION_LIST    /**< value: EnfOptionList; may be given several times */
} EnfOptionKind;

#define ENF_OPTION_LIST_MAX 64
typedef struct EnfOptionList {
    const char *items[ENF_OPTION_LIST_MAX];
    uint32_t count;
} EnfOptionList;

typedef struct EnfOption {
    const char *name;  /**< "--json" */
    const char *alias; /**< "-o", or NULL */
    EnfOptionKind kind;
    void *value;          /**< where the parsed value goes; left alone if the option is not given */
    const char *argument; /**< what --help calls the argument ("FILE"), NULL for flags and choices */
    const char *choices;  /**< ENF_OPTION_CHOICE: "a|b|c" */
    const char *help;     /**< one line */
} EnfOption;

typedef struct EnfCli {
    const char *program;   /**< "enfc" */
    const char *arguments; /**< what follows the program's name in the usage line: "LEVEL.glb [options]" */
    const char *about;     /**< a sentence or paragraph for --help */
    const EnfOption *options;
    uint32_t option_count;
} EnfCli;

typedef enum EnfCliResult {
    ENF_CLI_RUN,  /**< parsed: go on */
    ENF_CLI_DONE, /**< --help or --version was printed: exit with ENF_EXIT_OK */
    ENF_CLI_USAGE /**< a message is on stderr: exit with ENF_EXIT_USAGE */
} EnfCliResult;

/** Parses argv[1..argc). `--name VALUE`, `--name=VALUE` and `-- rest` are understood; options and positional arguments mix.
 *  --help and --version are built in. Positional arguments go to positional[0..capacity), their number to *count; one too
 *  many is a usage error. */
EnfCliResult enf_cli_parse(const EnfCli *cli, int argc, char **argv, const char **positional, uint32_t capacity,
                           uint32_t *count);

/** Prints "program: message" and the hint to --help on stderr; returns ENF_CLI_USAGE. `format` as printf. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
EnfCliResult
enf_cli_fail(const EnfCli *cli, const char *format, ...);

/* Strict parsers: the whole text must match, and nothing is stored otherwise. */
bool enf_parse_number(const char *text, double *value); /**< finite */
bool enf_parse_count(const char *text, uint32_t *value);
bool enf_parse_vector(const char *text, double value[3]);
bool enf_parse_size(const char *text, uint32_t value[2]);

#endif
