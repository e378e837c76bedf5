/* The experiments that were published on dynamic bounding volumes, as cases of one scene with other knobs: Sudarsky & Gotsman 1996
 * (S3 to S6: figures 6a, 6b, 6c and section 3.2), Paunoo 2006 (B1 to B4: its four scenes with their tests of polygons, number
 * and speed), and the sizes at which other engines were measured. */
#include "enfbench/movers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* As many movers as the sources had not. */
enum { MANY = 100000 };

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
    def.leaf = 4.0;
    def.occluders = true;
    def.rounds = 1;
    def.budget = 20.0;
    def.motion = MOVERS_FREE;
    def.eye = MOVERS_WALK;
    snprintf(def.techniques, sizeof def.techniques, "%s", EVERY);
    return def;
}

const char *const bench_movers_motions[4] = {"free", "linear", "spline", "character"};
const char *const bench_movers_eyes[3] = {"still", "walk", "jump"};

static bool is_set(BenchRun *run, const char *knob) {
    return bench_knob_text(&run->knobs, knob, NULL) != NULL;
}

void bench_movers_knobs(BenchRun *run, MoversDef *def) {
    static const char *const occluders[] = {"static", "all"};
    BenchKnobs *knobs = &run->knobs;
    def->rooms = bench_knob_whole(knobs, "rooms", def->rooms, 1, 1000000);
    def->movers = bench_knob_whole(knobs, "movers", def->movers, 1, 10000000);
    def->visible = bench_knob_whole(knobs, "visible", def->visible, 0, 1000000);
    def->frames = bench_knob_whole(knobs, "frames", def->frames, 3, 10000000);
    def->seed = bench_knob_whole(knobs, "seed", def->seed, 0, 4000000000U);
    def->check = bench_knob_whole(knobs, "check", def->check, 1, 10000000);
    def->period = bench_knob_whole(knobs, "period", def->period, 1, 1000000000);
    def->polygons = bench_knob_whole(knobs, "polygons", def->polygons, 0, 1000000);
    def->speed = bench_knob(knobs, "speed", def->speed, 1e-6, 1e3);
    def->doors = (double)bench_knob_whole(knobs, "doors", (uint32_t)def->doors, 0, 100);
    def->door_width = bench_knob(knobs, "door_width", def->door_width, 0.25, 7.5);
    def->leaf = bench_knob(knobs, "leaf", def->leaf, 0.5, 64.0);
    def->rounds = bench_knob_whole(knobs, "rounds", def->rounds, 1, 100);
    def->budget = bench_knob(knobs, "budget", def->budget, 0.001, 1e6);
    def->motion = (MoversMotion)bench_knob_word(knobs, "motion", bench_movers_motions, 4, (int)def->motion);
    def->eye = (MoversEye)bench_knob_word(knobs, "eye", bench_movers_eyes, 3, (int)def->eye);
    def->occluders = bench_knob_word(knobs, "occluders", occluders, 2, def->occluders) == 1;
    if (def->visible > def->movers && is_set(run, "visible") && is_set(run, "movers")) {
        fprintf(stderr,
                "enfbench: visible=%u movers=%u: visible are some of the movers, so that there cannot be more of them\n",
                def->visible, def->movers);
        exit(2);
    }
    const char *policy = bench_knob_text(knobs, "policy", "all");
    if (strcmp(policy, "all") != 0) {
        if (!bench_movers_known(policy)) {
            fprintf(stderr,
                    "enfbench: policy=%s: techniques are expected, separated by commas: zbuffer, hierarchical-z, tbv, naive, "
                    "lca, " EVERY "\n",
                    policy);
            exit(2);
        }
        snprintf(def->techniques, sizeof def->techniques, "%s", policy);
    }
}

/* A case as it is with what the user says of it: scenes are called by what there is. */
static MoversDef told(BenchRun *run, MoversDef def) {
    bench_movers_knobs(run, &def);
    return def;
}

/* Visible ones are some of the movers. What the user said of one of the two stands: a case with fewer movers than shall be visible is
 * left out, one of whose few movers the experiment wants more to be visible shows them all; and either is told. */
static bool fits(BenchRun *run, const char *experiment, const char *name, MoversDef *def) {
    if (def->visible <= def->movers) {
        return true;
    }
    bool skip = is_set(run, "visible");
    run->skipped += skip ? 1U : 0U;
    fprintf(stderr, "enfbench: %s, %s: movers=%u visible=%u: %s\n", experiment, name, def->movers, def->visible,
            skip ? "skipped, as it has fewer movers than shall be visible" : "all movers are visible");
    def->visible = def->movers;
    return !skip;
}

/* One case: the defaults of an experiment, then what the user says. */
static bool one(BenchRun *run, const char *experiment, const char *name, MoversDef def) {
    bench_movers_knobs(run, &def);
    return !fits(run, experiment, name, &def) || bench_movers_case(run, experiment, name, &def);
}

/* The same of a case that has very many movers, as its name says. */
static bool one_of_many(BenchRun *run, const char *experiment, const char *name, MoversDef def) {
    char text[64];
    bench_movers_knobs(run, &def);
    snprintf(text, sizeof text, "%s, %u movers", name, def.movers);
    return !fits(run, experiment, text, &def) || bench_movers_case(run, experiment, text, &def);
}

bool bench_movers(BenchRun *run) {
    static const uint32_t sizes[][2] = {{100, 1000}, {1024, 10000}, {10000, 10000}, {10000, 100000}};
    bool sized = is_set(run, "rooms") || is_set(run, "movers");
    bool ok = true;
    for (uint32_t i = 0; i < (sized ? 1U : 4U) && ok; i++) {
        MoversDef def = bench_movers_default();
        def.rooms = sized ? def.rooms : sizes[i][0];
        def.movers = sized ? def.movers : sizes[i][1];
        ok = one(run, "movers", "grid", def);
    }
    return ok;
}

/* Every motion; and a few that are visible, with few and with very many hidden: there without those who move everything, as these
 * leave cold caches behind where they are many. */
bool bench_million(BenchRun *run) {
    bool ok = true;
    for (int motion = MOVERS_FREE; motion <= MOVERS_CHARACTER && ok; motion++) {
        MoversDef def = bench_movers_default();
        def.rooms = 10000;
        def.movers = 1000000;
        def.check = 450;
        def.frames = 900;
        def.budget = 6.0;
        def.motion = (MoversMotion)motion;
        snprintf(def.techniques, sizeof def.techniques, "update-all,flat,sweep,plain,maximal,reach");
        ok = one(run, "million", bench_movers_motions[told(run, def).motion], def);
    }
    for (uint32_t movers = 10000; movers <= 1000000 && ok; movers *= 100) {
        MoversDef def = bench_movers_default();
        def.rooms = 10000;
        def.movers = movers;
        def.visible = 1000;
        def.check = 450;
        def.frames = 900;
        def.budget = 6.0;
        def.motion = MOVERS_LINEAR;
        snprintf(def.techniques, sizeof def.techniques, "maximal,reach");
        ok = one(run, "million", "hidden", def);
    }
    return ok;
}

/* Where volumes have little to win: fast movers of which nothing else is known, doors as wide as the walls, nothing but what is
 * visible. */
bool bench_losing(BenchRun *run) {
    static const double speeds[] = {1.0, 4.0, 16.0, 64.0, 256.0, 1000.0};
    static const double widths[] = {1.25, 2.5, 5.0, 7.5};
    bool ok = true;
    for (size_t i = 0; i < sizeof speeds / sizeof *speeds && ok; i++) {
        MoversDef def = bench_movers_default();
        def.speed = speeds[i];
        def.budget = 1.0;
        def.check = 300;
        ok = one(run, "losing", "fast movers", def);
    }
    for (size_t i = 0; i < sizeof widths / sizeof *widths && ok; i++) {
        MoversDef def = bench_movers_default();
        def.door_width = widths[i];
        def.doors = 100.0;
        def.budget = 1.0;
        def.check = 300;
        ok = one(run, "losing", "open plan", def);
    }
    for (uint32_t movers = 10; movers <= 1000 && ok; movers *= 10) {
        MoversDef def = bench_movers_default();
        def.movers = movers;
        def.visible = movers;
        def.rooms = 16;
        def.eye = MOVERS_STILL;
        def.budget = 1.0;
        def.check = 300;
        ok = one(run, "losing", "all visible", def);
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
    def.frames = 900;
    def.check = 300;
    def.budget = 0.6;
    snprintf(def.techniques, sizeof def.techniques,
             "zbuffer,hierarchical-z,tbv,update-all,flat,constant,adaptive,maximal,optimal,reach");
    return def;
}

/* 1,100 polygons move: 92 boxes of 12. And 100,000 boxes. */
bool bench_s3(BenchRun *run) {
    static const uint32_t rooms[] = {8, 27, 64, 125, 343, 1000, 10000};
    bool ok = true;
    for (size_t i = 0; i < 2 * (sizeof rooms / sizeof *rooms) && ok; i++) {
        MoversDef def = chairs();
        bool many = i >= sizeof rooms / sizeof *rooms;
        def.rooms = rooms[i % (sizeof rooms / sizeof *rooms)];
        def.movers = many ? MANY : 92;
        ok = (many ? one_of_many : one)(run, "S3", "static varies", def);
    }
    return ok;
}

bool bench_s4(BenchRun *run) {
    static const uint32_t rooms[] = {8, 27, 64, 125, 343, 1000, 10000, 25000};
    bool ok = true;
    for (size_t i = 0; i < sizeof rooms / sizeof *rooms && ok; i++) {
        MoversDef def = chairs();
        def.rooms = bench_knob_whole(&run->knobs, "rooms", rooms[i], 1, 1000000);
        def.movers = 4 * def.rooms;
        ok = one(run, "S4", told(run, def).movers == def.movers ? "four a room" : "movers given", def);
    }
    return ok;
}

bool bench_s5(BenchRun *run) {
    static const uint32_t movers[] = {10, 100, 1000, 10000, 100000, 1000000};
    bool ok = true;
    for (size_t i = 0; i < sizeof movers / sizeof *movers && ok; i++) {
        MoversDef def = chairs();
        char name[64];
        def.rooms = bench_knob_whole(&run->knobs, "rooms", 125, 1, 1000000);
        def.movers = movers[i];
        snprintf(name, sizeof name, "%u rooms", def.rooms);
        ok = one(run, "S5", name, def);
    }
    return ok;
}

/* Cost against looseness: overdraw is what was evaluated for each object drawn. The scene is called by what the eye does, whoever
 * says so. */
static bool policies(BenchRun *run, MoversDef def) {
    static const uint32_t periods[] = {1, 4, 16, 64, 256, 1024};
    bool (*measure)(BenchRun *, const char *, const char *, MoversDef) = def.movers == MANY ? one_of_many : one;
    const char *name = bench_movers_eyes[told(run, def).eye];
    snprintf(def.techniques, sizeof def.techniques, "adaptive,maximal,optimal,reach");
    bool ok = measure(run, "S6", name, def);
    for (size_t i = 0; i < sizeof periods / sizeof *periods && ok; i++) {
        snprintf(def.techniques, sizeof def.techniques, "constant");
        def.period = periods[i];
        ok = measure(run, "S6", name, def);
    }
    return ok;
}

bool bench_s6(BenchRun *run) {
    MoversDef def = bench_movers_default();
    def.frames = 1800;
    def.check = 600;
    def.budget = 1.5;
    def.eye = MOVERS_STILL;
    bool ok = policies(run, def);
    def.eye = MOVERS_WALK;
    ok = ok && policies(run, def);
    def.rooms = 10000;
    def.movers = MANY;
    return ok && policies(run, def);
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
    def.frames = 900;
    def.check = 300;
    def.budget = 0.6;
    snprintf(def.techniques, sizeof def.techniques, "zbuffer,update-all,flat,sweep,constant,adaptive,maximal,optimal,reach");
    return def;
}

/* Of scene 1, which hides nothing, all are visible. */
static bool is_alone(const ThesisScene *scene) {
    return scene->movers == scene->visible;
}

/* The same with as many as the thesis had not: most of them hidden, but of scene 1 none. */
static MoversDef with_many(const ThesisScene *scene) {
    MoversDef def = thesis(scene);
    def.rooms = is_alone(scene) ? scene->rooms : 1024;
    def.movers = MANY;
    def.visible = is_alone(scene) ? MANY : scene->visible > 1 ? 100 : 1;
    def.polygons = 12;
    def.budget = 0.4;
    if (is_alone(scene)) { /* every frame is dear: fewer frames, fewer techniques */
        def.frames = 90;
        def.check = 45;
        def.budget = 0.3;
        snprintf(def.techniques, sizeof def.techniques, "zbuffer,update-all,flat,sweep,adaptive,reach");
    }
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
    for (size_t i = 0; i < sizeof polygons / sizeof *polygons && ok; i++) {
        MoversDef def = with_many(scene);
        def.polygons = polygons[i];
        if (polygons[i] ==
            10000) { /* a thousand million take a quarter of a minute a frame: those two that the claim is about */
            snprintf(def.techniques, sizeof def.techniques, "update-all,reach");
        }
        ok = one_of_many(run, scene->name, "test 1: polygons", def);
    }
    return ok;
}

static bool thesis_number(BenchRun *run, const ThesisScene *scene) {
    static const uint32_t movers[] = {1, 2, 4, 6, 8, 10, 1000, 10000, 100000};
    bool alone = is_alone(scene);
    bool ok = true;
    for (size_t i = alone ? 0 : 1; i < sizeof movers / sizeof *movers && ok; i++) {
        MoversDef def = movers[i] > (alone ? 1000U : 10U) ? with_many(scene) : thesis(scene);
        def.movers = movers[i];
        def.polygons = 12;
        def.visible = scene->visible > 1 ? (movers[i] + 1) / 2 : scene->visible;
        def.visible = alone ? movers[i] : def.visible > 100 ? 100 : def.visible;
        ok = one(run, scene->name, "test 2: number", def);
    }
    return ok;
}

/* Up to speeds at which volumes lose: that is shown too. */
static bool thesis_speed(BenchRun *run, const ThesisScene *scene) {
    static const double speeds[] = {0.1, 1.0, 10.0, 100.0, 1000.0};
    bool ok = true;
    for (size_t i = 0; i < 2 * (sizeof speeds / sizeof *speeds) && ok; i++) {
        bool many = i >= sizeof speeds / sizeof *speeds;
        MoversDef def = many ? with_many(scene) : thesis(scene);
        def.speed = speeds[i % (sizeof speeds / sizeof *speeds)];
        def.motion = MOVERS_FREE;
        ok = (many ? one_of_many : one)(run, scene->name, "test 3: speed", def);
    }
    return ok;
}

static bool thesis_scene(BenchRun *run, const ThesisScene *scene) {
    return thesis_polygons(run, scene) && thesis_number(run, scene) && thesis_speed(run, scene);
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
