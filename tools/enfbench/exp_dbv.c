/* The experiments that were published on dynamic bounding volumes, as cases of one scene with other knobs: Sudarsky & Gotsman 1996
 * (S3 to S6: figures 6a, 6b, 6c and section 3.2), Paunoo 2006 (B1 to B4: its four scenes with their tests of polygons, number
 * and speed), and the sizes at which other engines were measured. */
#include "enfbench/movers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EVERY "update-all,flat,sweep,plain,frustum,constant,adaptive,maximal,optimal,reach"

MoversDef bench_movers_default(void) {
    MoversDef def;
    memset(&def, 0, sizeof def);
    def.rooms = 1024;
    def.movers = 10000;
    def.frames = 600;
    def.seed = 1;
    def.check = 50;
    def.period = 64;
    def.speed = 1.4;
    def.doors = 75.0;
    def.door_width = 1.25;
    def.budget = 20.0;
    def.motion = MOVERS_FREE;
    def.eye = MOVERS_WALK;
    snprintf(def.techniques, sizeof def.techniques, "%s", EVERY);
    return def;
}

/* The number of a word in a list; -1 if it is not there. */
static int word(const char *text, const char *const *words, int count) {
    for (int i = 0; i < count; i++) {
        if (strcmp(text, words[i]) == 0) {
            return i;
        }
    }
    return -1;
}

bool bench_movers_knobs(BenchRun *run, MoversDef *def) {
    static const char *const motions[] = {"free", "linear", "spline", "character"};
    static const char *const eyes[] = {"still", "walk", "jump"};
    BenchKnobs *knobs = &run->knobs;
    def->rooms = (uint32_t)bench_knob(knobs, "rooms", def->rooms, 1.0, 1e6);
    def->movers = (uint32_t)bench_knob(knobs, "movers", def->movers, 1.0, 1e7);
    def->visible = (uint32_t)bench_knob(knobs, "visible", def->visible, 0.0, 1e6);
    def->frames = (uint32_t)bench_knob(knobs, "frames", def->frames, 3.0, 1e7);
    def->seed = (uint32_t)bench_knob(knobs, "seed", def->seed, 0.0, 4e9);
    def->check = (uint32_t)bench_knob(knobs, "check", def->check, 1.0, 1e7);
    def->period = (uint32_t)bench_knob(knobs, "period", def->period, 1.0, 1e9);
    def->polygons = (uint32_t)bench_knob(knobs, "polygons", def->polygons, 0.0, 1e6);
    def->speed = bench_knob(knobs, "speed", def->speed, 1e-6, 1e3);
    def->doors = bench_knob(knobs, "doors", def->doors, 0.0, 100.0);
    def->door_width = bench_knob(knobs, "door_width", def->door_width, 0.25, 7.5);
    def->budget = bench_knob(knobs, "budget", def->budget, 0.001, 1e6);
    int motion = word(bench_knob_text(knobs, "motion", motions[def->motion]), motions, 4);
    int eye = word(bench_knob_text(knobs, "eye", eyes[def->eye]), eyes, 3);
    if (motion < 0 || eye < 0) {
        fputs("enfbench: motion=free|linear|spline|character and eye=still|walk|jump are expected\n", stderr);
        return false;
    }
    def->motion = (MoversMotion)motion;
    def->eye = (MoversEye)eye;
    def->visible = def->visible > def->movers ? def->movers : def->visible;
    const char *policy = bench_knob_text(knobs, "policy", NULL);
    if (policy != NULL) {
        snprintf(def->techniques, sizeof def->techniques, "%s", policy);
    }
    return true;
}

/* One case: the defaults of an experiment, then what the user says. */
static bool one(BenchRun *run, const char *experiment, const char *name, MoversDef def) {
    return bench_movers_knobs(run, &def) && bench_movers_case(run, experiment, name, &def);
}

bool bench_movers(BenchRun *run) {
    static const uint32_t sizes[][2] = {{100, 1000}, {1024, 10000}, {10000, 10000}, {10000, 100000}};
    bool sized = bench_knob_text(&run->knobs, "rooms", NULL) != NULL || bench_knob_text(&run->knobs, "movers", NULL) != NULL;
    bool ok = true;
    for (uint32_t i = 0; i < (sized ? 1U : 4U) && ok; i++) {
        MoversDef def = bench_movers_default();
        def.rooms = sized ? def.rooms : sizes[i][0];
        def.movers = sized ? def.movers : sizes[i][1];
        ok = one(run, "movers", "grid", def);
    }
    return ok;
}

/* ---- Sudarsky & Gotsman ----------------------------------------------------------------------------------------- */

static MoversDef chairs(void) {
    MoversDef def = bench_movers_default();
    def.motion = MOVERS_LINEAR;
    def.eye = MOVERS_STILL;
    def.furniture = 1;
    def.polygons = 12;
    def.frames = 300;
    snprintf(def.techniques, sizeof def.techniques, "zbuffer,update-all,flat,constant,adaptive,maximal,optimal,reach");
    return def;
}

/* 1,100 polygons move: 92 boxes of 12. */
bool bench_s3(BenchRun *run) {
    static const uint32_t rooms[] = {8, 27, 64, 125, 343, 1000};
    bool ok = true;
    for (size_t i = 0; i < sizeof rooms / sizeof *rooms && ok; i++) {
        MoversDef def = chairs();
        def.rooms = rooms[i];
        def.movers = 92;
        ok = one(run, "S3", "static varies", def);
    }
    return ok;
}

bool bench_s4(BenchRun *run) {
    static const uint32_t rooms[] = {8, 27, 64, 125, 343, 1000, 10000};
    bool ok = true;
    for (size_t i = 0; i < sizeof rooms / sizeof *rooms && ok; i++) {
        MoversDef def = chairs();
        def.rooms = rooms[i];
        def.movers = 4 * rooms[i];
        ok = one(run, "S4", "four a room", def);
    }
    return ok;
}

bool bench_s5(BenchRun *run) {
    static const uint32_t movers[] = {10, 100, 1000, 10000, 100000};
    bool ok = true;
    for (size_t i = 0; i < sizeof movers / sizeof *movers && ok; i++) {
        MoversDef def = chairs();
        def.rooms = 125;
        def.movers = movers[i];
        ok = one(run, "S5", "125 rooms", def);
    }
    return ok;
}

/* Cost against looseness: overdraw is what was evaluated for each object drawn. */
bool bench_s6(BenchRun *run) {
    static const uint32_t periods[] = {1, 4, 16, 64, 256, 1024};
    bool ok = true;
    for (uint32_t e = 0; e < 2 && ok; e++) {
        MoversDef def = bench_movers_default();
        def.eye = e == 0 ? MOVERS_STILL : MOVERS_WALK;
        snprintf(def.techniques, sizeof def.techniques, "adaptive,maximal,optimal,reach");
        ok = one(run, "S6", e == 0 ? "policies, still" : "policies, walk", def);
        for (size_t i = 0; i < sizeof periods / sizeof *periods && ok; i++) {
            char name[32];
            snprintf(name, sizeof name, "period=%u, %s", periods[i], e == 0 ? "still" : "walk");
            snprintf(def.techniques, sizeof def.techniques, "constant");
            def.period = periods[i];
            ok = one(run, "S6", name, def);
        }
    }
    return ok;
}

/* ---- Paunoo ----------------------------------------------------------------------------------------------------- */

typedef struct ThesisScene {
    const char *name;
    uint32_t rooms, movers, visible, furniture;
} ThesisScene;

static MoversDef thesis(const ThesisScene *scene) {
    MoversDef def = bench_movers_default();
    def.rooms = scene->rooms;
    def.movers = scene->movers;
    def.visible = scene->visible;
    def.furniture = scene->furniture;
    def.motion = MOVERS_LINEAR;
    def.eye = MOVERS_STILL;
    def.polygons = 100;
    def.frames = 300;
    snprintf(def.techniques, sizeof def.techniques, "update-all,flat,sweep,constant,adaptive,maximal,optimal,reach");
    return def;
}

static bool thesis_polygons(BenchRun *run, const ThesisScene *scene) {
    static const uint32_t polygons[] = {12, 100, 1000, 10000};
    bool ok = true;
    for (size_t i = 0; i < sizeof polygons / sizeof *polygons && ok; i++) {
        MoversDef def = thesis(scene);
        def.polygons = polygons[i];
        ok = one(run, scene->name, "test 1: polygons", def);
    }
    return ok;
}

static bool thesis_number(BenchRun *run, const ThesisScene *scene) {
    static const uint32_t movers[] = {2, 4, 6, 8, 10, 1000, 100000};
    bool ok = true;
    for (size_t i = 0; i < sizeof movers / sizeof *movers && ok; i++) {
        MoversDef def = thesis(scene);
        def.movers = movers[i];
        def.rooms = movers[i] > 10 ? 1024 : scene->rooms;
        def.visible = scene->visible > 1 ? (movers[i] + 1) / 2 : scene->visible;
        def.visible = def.visible > 100 ? 100 : def.visible;
        def.polygons = movers[i] > 10 ? 12 : def.polygons;
        ok = one(run, scene->name, "test 2: number", def);
    }
    return ok;
}

/* Up to speeds at which volumes lose: that is shown too. */
static bool thesis_speed(BenchRun *run, const ThesisScene *scene) {
    static const double speeds[] = {0.1, 1.0, 10.0, 100.0, 1000.0};
    bool ok = true;
    for (size_t i = 0; i < sizeof speeds / sizeof *speeds && ok; i++) {
        MoversDef def = thesis(scene);
        def.speed = speeds[i];
        def.motion = MOVERS_FREE;
        ok = one(run, scene->name, "test 3: speed", def);
    }
    return ok;
}

static bool thesis_scene(BenchRun *run, const ThesisScene *scene) {
    bool several = scene->movers > 1;
    return thesis_polygons(run, scene) && (!several || thesis_number(run, scene)) && thesis_speed(run, scene);
}

bool bench_b1(BenchRun *run) {
    static const ThesisScene scene = {"B1", 16, 1, 1, 0};
    return thesis_scene(run, &scene);
}

bool bench_b2(BenchRun *run) {
    static const ThesisScene scene = {"B2", 16, 10, 1, 0};
    return thesis_scene(run, &scene);
}

bool bench_b3(BenchRun *run) {
    static const ThesisScene scene = {"B3", 16, 10, 5, 0};
    return thesis_scene(run, &scene);
}

bool bench_b4(BenchRun *run) {
    static const ThesisScene scene = {"B4", 16, 10, 5, 16};
    return thesis_scene(run, &scene);
}
