/* enfreplay: plays, makes and checks recordings of the game without a window. */
#include <stdio.h>
#include <string.h>

#include "enfreplay/enfreplay.h"

static const char usage[] =
    "usage: enfreplay COMMAND [options] FILE.enfreplay...\n"
    "\n"
    "A recording (.enfreplay) holds what a player did in every tick of a game, and a 64-bit hash of the whole game's state\n"
    "after each. Played again on the same map it gives the same states, bit for bit, or enfreplay says where it does not.\n"
    "\n"
    "commands:\n"
    "  run      play a recording; --frames or --video write what the player saw\n"
    "  verify   play recordings and compare the state after every tick; exit status 1 at the first that differs\n"
    "  record   make a recording from a script, from the game's bot or from random input\n"
    "  update   play the input of recordings again and keep what comes of it now, in place\n"
    "  info     print what a recording says of itself\n"
    "\n"
    "enfreplay COMMAND --help lists the options of a command.\n"
    "Exit status: 0, 1 if something failed or differed, 2 for a wrong command line.\n"
    "\n"
    "example:\n"
    "  enfc assets/palace/palace.glb -o palace.enfmap\n"
    "  enfreplay record --map palace.enfmap --mash 7 --ticks 3600 -o minute.enfreplay\n"
    "  enfreplay verify minute.enfreplay\n"
    "  enfreplay run minute.enfreplay --video minute.y4m --every 2\n";

static const char about_run[] =
    "Plays recordings without a window, as fast as the machine can, and compares the states as verify does. With --frames\n"
    "or --video it draws what the player saw; drawing changes no state.";
static const char about_verify[] =
    "Plays recordings without drawing and compares the state after every tick with the recorded one. Names the first tick\n"
    "that differs, and the parts of the state that do.";
static const char about_record[] =
    "Makes a recording on --map from one of: a script (--script), which is a list of inputs if its first line is\n"
    "\"enfinput 1\" (see tools/enfreplay/README.md) and else one for the game's bot; a camera path to walk along (--path); "
    "random input (--mash).";
static const char about_update[] =
    "Plays the input of recordings on the map as it is now, and puts the states that come of it in the place of the recorded\n"
    "ones: after a change that was meant to change them. Accepts that map, game and engine have changed; a --map of another "
    "name\n"
    "only with --force.";
static const char about_info[] = "Prints what recordings say of themselves: versions, map, length, fields.";

/* Options that several commands have; a table is put together from these groups. */
#define MAP_OPTIONS                                                                                                            \
    {"--map", "-m", ENF_OPTION_TEXT, &o->map, "FILE.enfmap", NULL, "the map (default: beside the recording, by its name)"},    \
        {"--maps", NULL, ENF_OPTION_TEXT, &o->maps, "FOLDER", NULL, "look for maps by name in this folder"}, {                 \
        "--salvage", NULL, ENF_OPTION_FLAG, &o->salvage, NULL, NULL,                                                           \
            "take what is sound of a recording that is cut or damaged"                                                         \
    }
#define QUIET_OPTION                                                                                                           \
    { "--quiet", "-q", ENF_OPTION_FLAG, &o->quiet, NULL, NULL, "no progress and no summary" }

typedef struct Arguments {
    int argc;
    char **argv;
} Arguments;

static EnfCliResult parse_table(const EnfCli *cli, Options *o, Arguments arguments) {
    EnfCliResult result = enf_cli_parse(cli, arguments.argc, arguments.argv, o->files, FILES_MAX, &o->file_count);
    if (result == ENF_CLI_RUN && o->map && o->maps) {
        return enf_cli_fail(cli, "--map and --maps exclude each other");
    }
    return result;
}

static EnfCliResult need_files(const EnfCli *cli, const Options *o) {
    return o->file_count > 0 ? ENF_CLI_RUN : enf_cli_fail(cli, "which recording?");
}

/* ---- commands --------------------------------------------------------------------------------------------------- */

static EnfCliResult parse_run(Options *o, Arguments arguments) {
    const EnfOption options[] = {
        MAP_OPTIONS,
        {"--frames", NULL, ENF_OPTION_TEXT, &o->frames, "FOLDER", NULL, "write pictures: FOLDER/000000.png by tick"},
        {"--video", NULL, ENF_OPTION_TEXT, &o->video, "OUT.y4m", NULL, "write a video, uncompressed (- for stdout)"},
        {"--every", NULL, ENF_OPTION_COUNT, &o->every, "N", NULL, "draw each Nth tick (1)"},
        {"--size", NULL, ENF_OPTION_SIZE, o->size, "WxH", NULL, "picture, pixels (640x360)"},
        {"--fov-y", NULL, ENF_OPTION_NUMBER, &o->fov_y_deg, "DEG", NULL, "vertical field of view (60)"},
        {"--cull", NULL, ENF_OPTION_CHOICE, &o->cull, NULL, "none|frustum|sequences|worklist", "default worklist"},
        {"--dbv", NULL, ENF_OPTION_CHOICE, &o->dbv, NULL, "off|constant|adaptive|maximal|optimal|reach",
         "volumes for what moves; with it visibility is run at every tick, drawn or not (off)"},
        {"--context", NULL, ENF_OPTION_CHOICE, &o->context, NULL, "any|egl|osmesa", "default any: EGL, else OSMesa"},
        {"--ticks", NULL, ENF_OPTION_COUNT, &o->ticks, "N", NULL, "stop after N ticks"},
        {"--speed", NULL, ENF_OPTION_NUMBER, &o->speed, "FACTOR", NULL, "1 is the speed of play (0: as fast as it goes)"},
        {"--stats", NULL, ENF_OPTION_TEXT, &o->stats, "OUT.json", NULL, "times and counters (- for stdout)"},
        {"--force", NULL, ENF_OPTION_FLAG, &o->force, NULL, NULL, "play on after the states differ"},
        QUIET_OPTION,
    };
    const EnfCli cli = {"enfreplay run", "[options] FILE.enfreplay", about_run, options, sizeof options / sizeof *options};
    EnfCliResult result = parse_table(&cli, o, arguments);
    if (result != ENF_CLI_RUN || (result = need_files(&cli, o)) != ENF_CLI_RUN) {
        return result;
    }
    if (o->file_count > 1) {
        return enf_cli_fail(&cli, "run plays one recording; verify takes several");
    }
    if (o->every == 0 || o->fov_y_deg <= 0.0 || o->fov_y_deg > 170.0 || o->speed < 0.0) {
        return enf_cli_fail(&cli, "--every must be at least 1, --fov-y within 0..170 and --speed at least 0");
    }
    return ENF_CLI_RUN;
}

static EnfCliResult parse_verify(Options *o, Arguments arguments) {
    const EnfOption options[] = {
        MAP_OPTIONS,
        {"--dbv", NULL, ENF_OPTION_CHOICE, &o->dbv, NULL, "off|constant|adaptive|maximal|optimal|reach",
         "run visibility with volumes at every tick as well: it must change nothing (off)"},
        QUIET_OPTION,
    };
    const EnfCli cli = {"enfreplay verify", "[options] FILE.enfreplay...", about_verify, options,
                        sizeof options / sizeof *options};
    EnfCliResult result = parse_table(&cli, o, arguments);
    return result == ENF_CLI_RUN ? need_files(&cli, o) : result;
}

static EnfCliResult parse_record(Options *o, Arguments arguments) {
    const EnfOption options[] = {
        {"--map", "-m", ENF_OPTION_TEXT, &o->map, "FILE.enfmap", NULL, "the map; needed"},
        {"--script", "-s", ENF_OPTION_TEXT, &o->script, "FILE", NULL, "inputs, or a script for the game's bot"},
        {"--path", NULL, ENF_OPTION_TEXT, &o->path, "PATH.csv", NULL,
         "walk along a camera path (time,x,y,z,yaw,pitch); with --ticks again and again"},
        {"--run", NULL, ENF_OPTION_FLAG, &o->run, NULL, NULL, "--path runs"},
        {"--fly", NULL, ENF_OPTION_FLAG, &o->fly, NULL, NULL, "--path goes straight, through walls"},
        {"--use", NULL, ENF_OPTION_FLAG, &o->use, NULL, NULL, "--fly looks as each row says and uses what is there"},
        {"--mash", NULL, ENF_OPTION_TEXT, &o->mash, "SEED", NULL, "random input"},
        {"--builder", NULL, ENF_OPTION_FLAG, &o->builder, NULL, NULL, "--mash also presses noclip and fly"},
        {"--ticks", NULL, ENF_OPTION_COUNT, &o->ticks, "N", NULL, "stop after N ticks (--mash: 3600)"},
        {"--output", "-o", ENF_OPTION_TEXT, &o->output, "OUT.enfreplay", NULL, "needed"},
        {"--seed", NULL, ENF_OPTION_TEXT, &o->seed, "N", NULL, "of the game (1)"},
        {"--start", NULL, ENF_OPTION_TEXT, &o->start, "TEXT", NULL, "how the game begins, in its own words"},
        {"--title", NULL, ENF_OPTION_TEXT, &o->title, "TEXT", NULL, "for people"},
        {"--map-name", NULL, ENF_OPTION_TEXT, &o->map_name, "NAME", NULL, "what the recording calls its map (the file's name)"},
        {"--fields-every", NULL, ENF_OPTION_COUNT, &o->fields_every, "N", NULL,
         "hashes of the state's parts at each Nth tick only: a smaller file (1)"},
        QUIET_OPTION,
    };
    const EnfCli cli = {"enfreplay record",
                        "--map MAP.enfmap (--script FILE | --path CSV | --mash SEED) -o OUT.enfreplay [options]", about_record,
                        options, sizeof options / sizeof *options};
    EnfCliResult result = parse_table(&cli, o, arguments);
    if (result != ENF_CLI_RUN) {
        return result;
    }
    if (o->file_count > 0) {
        return enf_cli_fail(&cli, "unexpected argument: %s", o->files[0]);
    }
    if (!o->map || !o->output) {
        return enf_cli_fail(&cli, "--map FILE.enfmap and -o OUT.enfreplay are needed");
    }
    if ((o->script != NULL) + (o->mash != NULL) + (o->path != NULL) != 1) {
        return enf_cli_fail(&cli, "one of --script, --path and --mash is needed");
    }
    uint64_t number;
    if (o->mash && !enfreplay_number(o->mash, &number)) {
        return enf_cli_fail(&cli, "--mash wants a number, not %.40s", o->mash);
    }
    if (o->seed && !enfreplay_number(o->seed, &number)) {
        return enf_cli_fail(&cli, "--seed wants a number, not %.40s", o->seed);
    }
    return ENF_CLI_RUN;
}

static EnfCliResult parse_update(Options *o, Arguments arguments) {
    const EnfOption options[] = {
        MAP_OPTIONS,
        {"--force", NULL, ENF_OPTION_FLAG, &o->force, NULL, NULL, "also onto a --map of another name than the recorded one"},
        QUIET_OPTION,
    };
    const EnfCli cli = {"enfreplay update", "[options] FILE.enfreplay...", about_update, options,
                        sizeof options / sizeof *options};
    EnfCliResult result = parse_table(&cli, o, arguments);
    return result == ENF_CLI_RUN ? need_files(&cli, o) : result;
}

static EnfCliResult parse_info(Options *o, Arguments arguments) {
    const EnfOption options[] = {
        {"--json", NULL, ENF_OPTION_FLAG, &o->json, NULL, NULL, "as JSON, a line a recording"},
        {"--salvage", NULL, ENF_OPTION_FLAG, &o->salvage, NULL, NULL,
         "take what is sound of a recording that is cut or damaged"},
    };
    const EnfCli cli = {"enfreplay info", "[options] FILE.enfreplay...", about_info, options, sizeof options / sizeof *options};
    EnfCliResult result = parse_table(&cli, o, arguments);
    return result == ENF_CLI_RUN ? need_files(&cli, o) : result;
}

static const struct {
    const char *name;
    EnfCliResult (*parse)(Options *o, Arguments arguments);
    int (*run)(const Options *o);
} commands[] = {{"run", parse_run, cmd_run},
                {"verify", parse_verify, cmd_verify},
                {"record", parse_record, cmd_record},
                {"update", parse_update, cmd_update},
                {"info", parse_info, cmd_info}};

int main(int argc, char **argv) {
    static Options options = {.every = 1, .size = {640, 360}, .fov_y_deg = 60.0, .cull = 3, .fields_every = 1};
    const char *name = argc > 1 ? argv[1] : "";
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
        if (strcmp(name, commands[i].name) == 0) {
            Arguments arguments = {argc - 1, argv + 1};
            EnfCliResult parsed = commands[i].parse(&options, arguments);
            if (parsed != ENF_CLI_RUN) {
                return parsed == ENF_CLI_DONE ? ENF_EXIT_OK : ENF_EXIT_USAGE;
            }
            return commands[i].run(&options);
        }
    }
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0 || strcmp(name, "help") == 0) {
        fputs(usage, stdout);
        return ENF_EXIT_OK;
    }
    if (strcmp(name, "--version") == 0) {
        printf("enfreplay %s\n", ENF_VERSION);
        return ENF_EXIT_OK;
    }
    fprintf(stderr, "enfreplay: %s%s\nenfreplay --help lists the commands\n", *name ? "no command is named " : "which command?",
            name);
    return ENF_EXIT_USAGE;
}
