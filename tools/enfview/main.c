/* enfview: pictures of a compiled level from any eye, and the proof that culling loses none of their pixels. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/cli.h"
#include "enfview/viewer.h"

/* What the table of options fills; main turns it into Options. */
typedef struct Raw {
    double eye[3];
    const char *freeze;
    EnfOptionList debug;
} Raw;

static const char about[] =
    "Draws a compiled level as seen from --eye, culled as --cull says, without a window system.\n"
    "With --path it goes along a recorded path instead (CSV: time,x,y,z,yaw,pitch); with --verify it draws every\n"
    "view culled and unculled, compares each byte of colour and of the id-buffer, and ends with a line of JSON.\n"
    "Exit status: 0, 1 if a pixel was lost or something failed, 2 for a wrong command line.";

/* "X,Y,Z,YAW,PITCH" */
static bool parse_pose(const char *text, Pose *pose) {
    double values[5];
    char copy[256];
    if (strlen(text) >= sizeof copy) {
        return false;
    }
    strcpy(copy, text);
    char *at = copy;
    for (int i = 0; i < 5; i++) {
        char *comma = strchr(at, ',');
        if ((comma != NULL) != (i < 4)) {
            return false;
        }
        if (comma) {
            *comma = '\0';
        }
        if (!enf_parse_number(at, &values[i])) {
            return false;
        }
        at = comma ? comma + 1 : at;
    }
    pose->eye_ws = enf_v3(values[0], values[1], values[2]);
    pose->yaw_deg = values[3];
    pose->pitch_deg = values[4];
    return true;
}

static bool parse_debug(const EnfOptionList *list, uint32_t *debug) {
    static const char *const names[] = {"portals", "cells", "windows", "kd", "dbv"};
    for (uint32_t i = 0; i < list->count; i++) {
        uint32_t k = 0;
        while (k < 5 && strcmp(list->items[i], names[k]) != 0) {
            k++;
        }
        if (k == 5) {
            return false;
        }
        *debug |= 1u << k;
    }
    return true;
}

/* What no table can say about options. */
static EnfCliResult check(const EnfCli *cli, Options *o, const Raw *raw, uint32_t positional_count) {
    if (positional_count != 1) {
        return enf_cli_fail(cli, "which map? Compile one with enfc");
    }
    o->has_eye = !isnan(raw->eye[0]);
    o->pose.eye_ws = enf_v3(raw->eye[0], raw->eye[1], raw->eye[2]);
    o->has_freeze = raw->freeze != NULL;
    if (raw->freeze && !parse_pose(raw->freeze, &o->freeze)) {
        return enf_cli_fail(cli, "--freeze: '%s' is not X,Y,Z,YAW,PITCH", raw->freeze);
    }
    if (!parse_debug(&raw->debug, &o->debug)) {
        return enf_cli_fail(cli, "--debug takes portals, cells, windows, kd or dbv");
    }
    if (o->has_eye == (o->path != NULL)) {
        return enf_cli_fail(cli, o->path ? "--eye and --path exclude each other" : "--eye X,Y,Z or --path FILE.csv is needed");
    }
    if (o->fov_y_deg <= 0.0 || o->fov_y_deg > 170.0) {
        return enf_cli_fail(cli, "--fov-y must be above 0 and at most 170 degrees");
    }
    if (!(o->tick >= 0.0 && o->tick <= 1e9) || o->tick != floor(o->tick)) {
        return enf_cli_fail(cli, "--tick takes a whole number from 0 to 10^9");
    }
    if ((o->debug & DEBUG_DBV) && o->dbv == DBV_OFF) {
        return enf_cli_fail(cli, "--debug dbv shows what --dbv off leaves out");
    }
    if (o->every == 0) {
        return enf_cli_fail(cli, "--every must be at least 1");
    }
    if (o->path && (o->output || o->ids || o->stats || o->has_freeze || o->debug)) {
        return enf_cli_fail(cli, "-o, --ids, --stats, --freeze and --debug are for one view: use --eye");
    }
    if (!o->path && (o->verify || o->cells)) {
        return enf_cli_fail(cli, "--verify and --cells go along a path: use --path FILE.csv");
    }
    return ENF_CLI_RUN;
}

static EnfCliResult parse(Options *o, int argc, char **argv) {
    Raw raw = {{(double)NAN, (double)NAN, (double)NAN}, NULL, {{NULL}, 0}};
    const EnfOption options[] = {
        {"--eye", NULL, ENF_OPTION_VECTOR, raw.eye, "X,Y,Z", NULL, "the eye, metres; y is up"},
        {"--yaw", NULL, ENF_OPTION_NUMBER, &o->pose.yaw_deg, "DEG", NULL, "counter-clockwise about +Y; 0 looks down -Z"},
        {"--pitch", NULL, ENF_OPTION_NUMBER, &o->pose.pitch_deg, "DEG", NULL, "up is positive"},
        {"--roll", NULL, ENF_OPTION_NUMBER, &o->roll_deg, "DEG", NULL, "about the line of sight"},
        {"--fov-y", NULL, ENF_OPTION_NUMBER, &o->fov_y_deg, "DEG", NULL, "vertical field of view (60)"},
        {"--size", NULL, ENF_OPTION_SIZE, o->size, "WxH", NULL, "picture, pixels (640x480)"},
        {"--cull", NULL, ENF_OPTION_CHOICE, &o->cull, NULL, "none|frustum|sequences|worklist", "default worklist"},
        {"--window", NULL, ENF_OPTION_CHOICE, &o->window, NULL, "box|polygon", "default box"},
        {"--grain", NULL, ENF_OPTION_CHOICE, &o->grain, NULL, "objects|primitives", "default objects"},
        {"--dbv", NULL, ENF_OPTION_CHOICE, &o->dbv, NULL, "off|constant|adaptive|maximal|optimal|reach",
         "volumes of what moves; default maximal"},
        {"--tick", NULL, ENF_OPTION_NUMBER, &o->tick, "N", NULL, "the world's time, 1/60 s; of a path: at its time 0 (0)"},
        {"--doors", NULL, ENF_OPTION_CHOICE, &o->doors, NULL, "rest|swing|close",
         "stay shut; open and shut in turn (default); and close their portals while shut"},
        {"--movers", NULL, ENF_OPTION_TEXT, &o->movers, "FILE.csv", NULL,
         "also what moves through recorded points: object,time,x,y,z"},
        {"--cell", NULL, ENF_OPTION_TEXT, &o->cell_name, "NAME", NULL, "the eye's cell, instead of locating it"},
        {"--context", NULL, ENF_OPTION_CHOICE, &o->context, NULL, "any|egl|osmesa", "default any: EGL, else OSMesa"},
        {"--output", "-o", ENF_OPTION_TEXT, &o->output, "OUT.png", NULL, "the picture"},
        {"--ids", NULL, ENF_OPTION_TEXT, &o->ids, "IDS.png", NULL, "the id-buffer, a colour for each cluster"},
        {"--raw-ids", NULL, ENF_OPTION_FLAG, &o->raw_ids, NULL, NULL, "--ids holds cluster + 1, little-endian in RGBA"},
        {"--stats", NULL, ENF_OPTION_TEXT, &o->stats, "STATS.json", NULL, "counters, times and hashes (- for stdout)"},
        {"--debug", NULL, ENF_OPTION_LIST, &raw.debug, "WHAT", NULL,
         "draw portals, cells, windows, kd or dbv; may be repeated"},
        {"--freeze", NULL, ENF_OPTION_TEXT, &raw.freeze, "X,Y,Z,YAW,PITCH", NULL,
         "cull from there; what is culled is drawn as wireframe"},
        {"--path", NULL, ENF_OPTION_TEXT, &o->path, "PATH.csv", NULL, "go along a path: time,x,y,z,yaw,pitch,..."},
        {"--every", NULL, ENF_OPTION_COUNT, &o->every, "N", NULL, "take each Nth row of the path"},
        {"--verify", NULL, ENF_OPTION_FLAG, &o->verify, NULL, NULL, "compare culled and unculled pictures along the path"},
        {"--cells", NULL, ENF_OPTION_TEXT, &o->cells, "OUT.jsonl", NULL, "a line a view: {\"time\":..,\"cells\":[names]}"},
        {"--quiet", "-q", ENF_OPTION_FLAG, &o->quiet, NULL, NULL, "no table and no progress"},
    };
    const EnfCli cli = {"enfview", "MAP.enfmap (--eye X,Y,Z | --path PATH.csv) [options]", about, options,
                        sizeof options / sizeof *options};
    uint32_t positional_count = 0;
    EnfCliResult result = enf_cli_parse(&cli, argc, argv, &o->map, 1, &positional_count);
    return result == ENF_CLI_RUN ? check(&cli, o, &raw, positional_count) : result;
}

static void print_message(void *user, EnfLogLevel level, const char *message) {
    (void)user;
    (void)level;
    fprintf(stderr, "enfview: %s\n", message);
}

int main(int argc, char **argv) {
    Options options = {.fov_y_deg = 60.0, .size = {640, 480}, .cull = ENF_CULL_WORKLIST, .every = 1};
    options.dbv = ENF_DBV_MAXIMAL + 1;
    options.doors = DOORS_SWING;
    EnfCliResult parsed = parse(&options, argc, argv);
    if (parsed != ENF_CLI_RUN) {
        return parsed == ENF_CLI_DONE ? ENF_EXIT_OK : ENF_EXIT_USAGE;
    }
    enf_set_log(print_message, NULL);
    EnfError error = {0};
    Viewer viewer;
    int status;
    if (viewer_open(&viewer, &options, &error) != ENF_OK) {
        status = viewer_fail(&error);
    } else {
        status = options.verify ? run_verify(&viewer) : options.path ? run_path(&viewer) : run_picture(&viewer);
    }
    viewer_close(&viewer);
    return status;
}
