/* enfbench: lists and runs the experiments of experiments.inl; prints a table, writes CSV and JSON. */
#include "common/cli.h"
#include "enfbench/bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct Experiment {
    const char *name;
    BenchFn *function;
    const char *about, *knobs;
} Experiment;

static const Experiment experiments[] = {
#define BENCH(name, function, about, knobs) {#name, function, about, knobs},
#include "enfbench/experiments.inl"
#undef BENCH
};
enum { EXPERIMENT_COUNT = sizeof experiments / sizeof *experiments };

typedef struct Options {
    const char *csv, *json;
    EnfOptionList sets;
} Options;

static const Experiment *find(const char *name) {
    for (size_t i = 0; i < EXPERIMENT_COUNT; i++) {
        if (strcmp(experiments[i].name, name) == 0) {
            return &experiments[i];
        }
    }
    return NULL;
}

static int list(void) {
    for (size_t i = 0; i < EXPERIMENT_COUNT; i++) {
        printf("%-10s %s\n%-10s knobs: %s\n", experiments[i].name, experiments[i].about, "", experiments[i].knobs);
    }
    return ENF_EXIT_OK;
}

static bool read_knobs(const EnfCli *cli, const EnfOptionList *sets, BenchKnobs *knobs) {
    for (uint32_t i = 0; i < sets->count; i++) {
        const char *equals = strchr(sets->items[i], '=');
        size_t length = equals == NULL ? 0 : (size_t)(equals - sets->items[i]);
        bool fits = length > 0 && length < sizeof knobs->items[0].key && strlen(equals + 1) < BENCH_TEXT;
        if (!fits) {
            (void)enf_cli_fail(cli, "--set %s: KEY=VALUE is expected", sets->items[i]);
            return false;
        }
        memcpy(knobs->items[knobs->count].key, sets->items[i], length);
        snprintf(knobs->items[knobs->count].value, BENCH_TEXT, "%s", equals + 1);
        knobs->count++;
    }
    return true;
}

/* Does any of the chosen experiments know the knob? A knob name stands in `knobs` before '='. */
static bool knob_is_known(const char *key, const char *const *names, uint32_t count) {
    char pattern[40];
    snprintf(pattern, sizeof pattern, "%s=", key);
    for (uint32_t i = 0; i < count; i++) {
        const Experiment *experiment = find(names[i]);
        const char *at = experiment == NULL ? NULL : strstr(experiment->knobs, pattern);
        if (at != NULL && (at == experiment->knobs || at[-1] == ' ')) {
            return true;
        }
    }
    return false;
}

/* Runs one; where the knobs leave none of its cases, they are wrong. */
static int run_one(BenchRun *run, const char *name) {
    uint32_t rows = run->rows.count;
    uint32_t skipped = run->skipped;
    if (!find(name)->function(run)) {
        return ENF_EXIT_FAILURE;
    }
    if (run->rows.count == rows && run->skipped > skipped) {
        fprintf(stderr, "enfbench: %s: every case was skipped\n", name);
        return ENF_EXIT_USAGE;
    }
    return ENF_EXIT_OK;
}

static int run_all(const EnfCli *cli, const Options *options, const char *const *names, uint32_t count) {
    BenchRun run;
    memset(&run, 0, sizeof run);
    run.progress = isatty(STDERR_FILENO) != 0;
    if (!read_knobs(cli, &options->sets, &run.knobs)) {
        return ENF_EXIT_USAGE;
    }
    for (uint32_t i = 0; i < run.knobs.count; i++) {
        if (!knob_is_known(run.knobs.items[i].key, names, count)) {
            (void)enf_cli_fail(cli, "--set %s: no chosen experiment has this knob (see: enfbench list)",
                               run.knobs.items[i].key);
            return ENF_EXIT_USAGE;
        }
    }
    int status = ENF_EXIT_OK;
    for (uint32_t i = 0; i < count; i++) {
        int one = run_one(&run, names[i]);
        status = status == ENF_EXIT_OK ? one : status;
    }
    bench_progress(&run, "%s", "");
    bench_print_table(&run.rows);
    EnfError error = {ENF_OK, 0, "", ""};
    EnfResult written = options->csv == NULL ? ENF_OK : bench_write_csv(&run.rows, options->csv, &error);
    if (written == ENF_OK && options->json != NULL) {
        written = bench_write_json(&run.rows, options->json, &error);
    }
    if (written != ENF_OK) {
        fprintf(stderr, "enfbench: %s: %s\n", error.file, error.message);
    }
    free(run.rows.rows);
    return written == ENF_OK ? status : ENF_EXIT_FAILURE;
}

int main(int argc, char **argv) {
    Options options;
    memset(&options, 0, sizeof options);
    const EnfOption table[] = {
        {"--set", NULL, ENF_OPTION_LIST, &options.sets, "KEY=VALUE", NULL, "a knob of an experiment; may be repeated"},
        {"--csv", NULL, ENF_OPTION_TEXT, &options.csv, "FILE", NULL, "write the rows as CSV"},
        {"--json", NULL, ENF_OPTION_TEXT, &options.json, "FILE", NULL, "write {\"rows\":[...]} with the same columns"},
    };
    const EnfCli cli = {"enfbench", "list | run NAME... [options]",
                        "Benchmarks run time against error: every row carries its time, its error and the hash of its\n"
                        "result. `enfbench list` names the experiments and their knobs.",
                        table, sizeof table / sizeof *table};
    const char *words[1 + EXPERIMENT_COUNT];
    uint32_t count = 0;
    EnfCliResult parsed = enf_cli_parse(&cli, argc, argv, words, 1 + EXPERIMENT_COUNT, &count);
    if (parsed != ENF_CLI_RUN) {
        return parsed == ENF_CLI_DONE ? ENF_EXIT_OK : ENF_EXIT_USAGE;
    }
    if (count == 1 && strcmp(words[0], "list") == 0) {
        return list();
    }
    if (count < 2 || strcmp(words[0], "run") != 0) {
        (void)enf_cli_fail(&cli, "say `list`, or `run` and the names of experiments");
        return ENF_EXIT_USAGE;
    }
    for (uint32_t i = 1; i < count; i++) {
        if (find(words[i]) == NULL) {
            (void)enf_cli_fail(&cli, "no experiment is called '%s' (see: enfbench list)", words[i]);
            return ENF_EXIT_USAGE;
        }
    }
    return run_all(&cli, &options, words + 1, count - 1);
}
