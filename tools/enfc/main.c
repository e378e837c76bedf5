/* enfc: compiles a level (glTF) into a map. The work is done by enf_compile; here are its command line and its reports. */
#include "common/cli.h"
#include "compile/compile.h"
#include "compile/project.h"
#include "enfc/summary.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct Options {
    const char *level, *output, *project, *json, *plan, *overlay;
    bool quiet;
} Options;

static bool has_ending(const char *path, const char *ending) {
    size_t length = strlen(path), ending_length = strlen(ending);
    return length > ending_length && strcmp(path + length - ending_length, ending) == 0;
}

static EnfCliResult parse(Options *options, int argc, char **argv) {
    const EnfOption table[] = {
        {"--output", "-o", ENF_OPTION_TEXT, &options->output, "MAP.enfmap", NULL,
         "the map to write (default: beside the level, with its name)"},
        {"--project", NULL, ENF_OPTION_TEXT, &options->project, "P.json", NULL, "level project: source, output and settings"},
        {"--json", NULL, ENF_OPTION_TEXT, &options->json, "REPORT.json", NULL,
         "counts, times and warnings for programs; - is stdout"},
        {"--plan", NULL, ENF_OPTION_TEXT, &options->plan, "PLAN.svg", NULL, "draw a floor plan"},
        {"--overlay", NULL, ENF_OPTION_TEXT, &options->overlay, "DIAG.glb", NULL,
         "portals and findings as a scene to open beside the level"},
        {"--quiet", "-q", ENF_OPTION_FLAG, &options->quiet, NULL, NULL, "print errors and warnings only"},
    };
    const EnfCli cli = {"enfc", "LEVEL.glb|LEVEL.gltf|PROJECT.json [options]",
                        "Compiles a level made in Blender or any other glTF tool into cells, portals and kd-trees.\n"
                        "Exit status: 0 done (perhaps with warnings), 1 no map could be made, 2 usage.",
                        table, sizeof table / sizeof *table};
    uint32_t count;
    EnfCliResult result = enf_cli_parse(&cli, argc, argv, &options->level, 1, &count);
    if (result != ENF_CLI_RUN) {
        return result;
    }
    if (count == 1 && !options->project && has_ending(options->level, ".json")) {
        options->project = options->level;
        options->level = NULL;
    }
    return options->level || options->project ? ENF_CLI_RUN : enf_cli_fail(&cli, "no level given");
}

/* The level's path with .enfmap in the place of its ending; free() it. */
static char *default_output(const char *level) {
    const char *slash = strrchr(level, '/'), *dot = strrchr(level, '.');
    size_t stem = dot && (!slash || dot > slash + 1) ? (size_t)(dot - level) : strlen(level);
    char *path = malloc(stem + sizeof ".enfmap");
    if (path) {
        memcpy(path, level, stem);
        memcpy(path + stem, ".enfmap", sizeof ".enfmap");
    }
    return path;
}

static EnfResult read_project(const Options *options, EnfLevelProject *project, EnfError *error) {
    memset(project, 0, sizeof *project);
    project->settings = enf_compile_settings_default();
    if (!options->project) {
        return ENF_OK;
    }
    EnfResult result = enf_level_project_read(project, options->project, error);
    for (uint32_t i = 0; i < project->warning_count; i++) {
        fprintf(stderr, "warning: project: %s: %s\n", options->project, project->warnings[i]);
    }
    if (result == ENF_OK && !options->level && !project->source) {
        result = enf_error_set(error, ENF_ERROR_ARGUMENT, UINT64_MAX, "the project names no \"source\"");
        enf_error_file(error, result, options->project);
    }
    return result;
}

static EnfResult compile(const Options *options, EnfLevelProject *project, EnfCompileReport *report, EnfError *error) {
    EnfCompileDef def = enf_compile_def_default();
    def.level = options->level ? options->level : project->source;
    def.plan = options->plan;
    def.overlay = options->overlay;
    def.settings = project->settings;
    def.progress = !options->quiet && isatty(STDERR_FILENO) ? enfc_progress : NULL;
    char *beside = options->output || project->output ? NULL : default_output(def.level);
    def.output = options->output ? options->output : project->output ? project->output : beside;
    EnfResult result = def.output ? enf_compile(&def, report, error)
                                  : enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory");
    enfc_print_findings(&report->diagnosis);
    bool json_on_stdout = options->json && strcmp(options->json, "-") == 0;
    if (result == ENF_OK && !options->quiet && !json_on_stdout) {
        enfc_print_summary(def.level, def.output, report);
    }
    free(beside);
    return result;
}

int main(int argc, char **argv) {
    Options options = {NULL, NULL, NULL, NULL, NULL, NULL, false};
    EnfCliResult parsed = parse(&options, argc, argv);
    if (parsed != ENF_CLI_RUN) {
        return parsed == ENF_CLI_DONE ? ENF_EXIT_OK : ENF_EXIT_USAGE;
    }
    EnfError error;
    EnfCompileReport report;
    EnfLevelProject project;
    memset(&error, 0, sizeof error);
    memset(&report, 0, sizeof report);
    error.offset = UINT64_MAX;
    EnfResult result = read_project(&options, &project, &error);
    const char *level = options.level ? options.level : project.source ? project.source : options.project;
    if (result == ENF_OK) {
        result = compile(&options, &project, &report, &error);
    }
    if (result != ENF_OK) {
        enfc_print_error(&error);
    }
    if (options.json) {
        EnfError json_error = {.offset = UINT64_MAX};
        EnfResult saved = enfc_write_json(options.json, level, &report, result == ENF_OK ? NULL : &error, &json_error);
        if (saved != ENF_OK) {
            enfc_print_error(&json_error);
            result = result == ENF_OK ? saved : result;
        }
    }
    enf_compile_report_free(&report);
    enf_level_project_free(&project);
    return result == ENF_OK ? ENF_EXIT_OK : ENF_EXIT_FAILURE;
}
