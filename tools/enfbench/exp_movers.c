/* The experiments on moving objects (EXPERIMENTS S1–S6, B1–B4, and the sizes of PEERS): every technique finds the same objects in
 * the same frames, taking turns. A frame's time is the motions evaluated, the index, the traversal; drawing is apart. */
#include "enfbench/movers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum Kind { KIND_INDEX, KIND_FRUSTUM, KIND_FLAT, KIND_SWEEP, KIND_PLAIN, KIND_GREENE, KIND_NONE } Kind;

/* The techniques by the names that --set techniques= takes. */
static const struct {
    const char *name;
    Kind kind;
    EnfDbvPolicy policy;
    EnfDbvUpdate update;
    uint32_t period; /* 0: the scene's */
} techniques[] = {
    {"zbuffer", KIND_NONE, ENF_DBV_CONSTANT, ENF_DBV_LCA, 1},
    {"hierarchical-z", KIND_GREENE, ENF_DBV_CONSTANT, ENF_DBV_NAIVE, 1},
    {"tbv", KIND_GREENE, ENF_DBV_ADAPTIVE, ENF_DBV_NAIVE, 0},
    {"update-all", KIND_INDEX, ENF_DBV_CONSTANT, ENF_DBV_LCA, 1},
    {"naive", KIND_INDEX, ENF_DBV_CONSTANT, ENF_DBV_NAIVE, 1},
    {"lca", KIND_INDEX, ENF_DBV_CONSTANT, ENF_DBV_LCA, 1},
    {"flat", KIND_FLAT, ENF_DBV_CONSTANT, ENF_DBV_LCA, 1},
    {"sweep", KIND_SWEEP, ENF_DBV_CONSTANT, ENF_DBV_LCA, 1},
    {"plain", KIND_PLAIN, ENF_DBV_CONSTANT, ENF_DBV_LCA, 1},
    {"frustum", KIND_FRUSTUM, ENF_DBV_CONSTANT, ENF_DBV_LCA, 1},
    {"constant", KIND_INDEX, ENF_DBV_CONSTANT, ENF_DBV_LCA, 0},
    {"adaptive", KIND_INDEX, ENF_DBV_ADAPTIVE, ENF_DBV_LCA, 0},
    {"maximal", KIND_INDEX, ENF_DBV_MAXIMAL, ENF_DBV_LCA, 0},
    {"optimal", KIND_INDEX, ENF_DBV_OPTIMAL, ENF_DBV_LCA, 0},
    {"reach", KIND_INDEX, ENF_DBV_REACH, ENF_DBV_LCA, 0},
};
enum { TECHNIQUES = sizeof techniques / sizeof *techniques };

/* A technique on a scene. */
typedef struct Runner {
    uint32_t technique;
    EnfWorld *world;
    EnfDbvIndex *index;
    Rival *rival;
    Plain *plain;
    Greene *greene;
    uint32_t *all; /* zbuffer: everything */
    MoversFrame *times;
    double spent_us;
    double *look_times;                /* greene: visibility alone */
    double drawn, lost, listed, shown; /* listed, shown: objects of compared frames, where pixels are what is compared */
    uint32_t frames, timed;            /* timed: of the frames, those that count for time */
    uint64_t *hashes;                  /* a frame each: of its list and of all before it */
    uint64_t hash, evaluations;        /* evaluations: when the first frame began */
} Runner;

/* A scene while it is measured. */
typedef struct Case {
    const char *experiment, *name;
    MoversScene scene;
    MoversWindows windows;
    Truth *truth;
    bool same; /* no technique listed what it must not: else the run fails, but its rows are told */
} Case;

static void close_runner(Runner *runner) {
    enf_dbv_destroy(runner->index);
    if (runner->world != NULL) {
        enf_world_destroy(runner->world);
    }
    bench_rival_destroy(runner->rival);
    bench_plain_destroy(runner->plain);
    bench_greene_destroy(runner->greene);
    free(runner->all);
    free(runner->times);
    free(runner->hashes);
    free(runner->look_times);
}

static bool open_index(Runner *runner, const MoversScene *scene) {
    const MoversDef *def = &scene->def;
    EnfError error = {ENF_OK, 0, "", ""};
    if (enf_world_create(&runner->world, scene->rooms.map, def->movers, NULL, &error) != ENF_OK) {
        return false;
    }
    for (uint32_t i = 0; i < def->movers; i++) {
        EnfObjectDef object = bench_mover_object(&scene->movers[i], techniques[runner->technique].period == 1);
        if (enf_world_add(runner->world, &object, &error).generation == 0) {
            return false;
        }
    }
    EnfDbvDef dbv = enf_dbv_def_default();
    dbv.policy = techniques[runner->technique].policy;
    dbv.update = techniques[runner->technique].update;
    dbv.period_ticks = techniques[runner->technique].period > 0 ? techniques[runner->technique].period : def->period;
    return enf_dbv_create(&runner->index, runner->world, &dbv, NULL, &error) == ENF_OK;
}

static bool open_runner(Runner *runner, uint32_t technique, const MoversScene *scene) {
    memset(runner, 0, sizeof *runner);
    runner->technique = technique;
    runner->hash = ENF_HASH_START;
    runner->times = calloc(scene->def.frames, sizeof *runner->times);
    runner->hashes = calloc(scene->def.frames, sizeof *runner->hashes);
    bool ok = runner->times != NULL && runner->hashes != NULL;
    switch (techniques[technique].kind) {
    case KIND_INDEX:
    case KIND_FRUSTUM:
        return ok && open_index(runner, scene);
    case KIND_FLAT:
    case KIND_SWEEP:
        runner->rival = bench_rival_create(scene, techniques[technique].kind == KIND_SWEEP);
        return ok && runner->rival != NULL;
    case KIND_PLAIN:
        runner->plain = bench_plain_create(scene);
        return ok && runner->plain != NULL;
    case KIND_GREENE:
        runner->look_times = calloc(scene->def.frames, sizeof *runner->look_times);
        runner->greene = bench_greene_create(scene, techniques[technique].period == 0);
        return ok && runner->look_times != NULL && runner->greene != NULL;
    case KIND_NONE:
        runner->all = calloc(scene->def.movers + 1U, sizeof *runner->all);
        break;
    }
    return ok && runner->all != NULL;
}

/* ---- a frame ---------------------------------------------------------------------------------------------------- */

/* Every cell in the picture, portals unused. */
static const uint32_t *frustum_frame(const MoversScene *scene, Runner *runner, EnfView view, uint32_t *count) {
    view.cull = ENF_CULL_FRUSTUM;
    view.dbv = runner->index;
    const EnfVisSet *set = enf_vis_run(scene->vis, &scene->portals, &view);
    *count = set->object_count;
    return set->objects;
}

static const uint32_t *greene_frame(Runner *runner, const EnfView *view, uint32_t frame, uint32_t *count) {
    bench_greene_move(runner->greene, (int64_t)frame);
    double start = bench_now_us();
    const uint32_t *list = bench_greene_look(runner->greene, view, count);
    runner->look_times[runner->timed] = bench_now_us() - start;
    return list;
}

/* The moving objects that a technique lists. */
static const uint32_t *find(const MoversScene *scene, Runner *runner, uint32_t frame, MoversWindows *windows, uint32_t *count) {
    EnfView view = scene->views[frame];
    const EnfVisSet *set = NULL;
    switch (techniques[runner->technique].kind) {
    case KIND_INDEX:
        view.dbv = runner->index;
        set = enf_vis_run(scene->vis, &scene->portals, &view);
        *count = set->object_count;
        return set->objects;
    case KIND_FRUSTUM:
        return frustum_frame(scene, runner, view, count);
    case KIND_FLAT:
    case KIND_SWEEP:
        set = enf_vis_run(scene->vis, &scene->portals, &view);
        *count = 0;
        return bench_movers_windows(scene, set, windows)
                   ? bench_rival_frame(runner->rival, &scene->views[frame], windows, (int64_t)frame, count)
                   : runner->all;
    case KIND_PLAIN:
        return bench_plain_frame(runner->plain, &view, (int64_t)frame, count);
    case KIND_GREENE:
        return greene_frame(runner, &view, frame, count);
    case KIND_NONE:
        view.cull = ENF_CULL_NONE;
        (void)enf_vis_run(scene->vis, &scene->portals, &view);
        break;
    }
    for (uint32_t i = 0; i < scene->def.movers; i++) { /* evaluated and handed on: the depth buffer does the rest */
        EnfPose pose = bench_mover_state(&scene->movers[i], (int64_t)frame);
        runner->all[i] = pose.position.y < 1e30 ? i : 0U;
    }
    *count = scene->def.movers;
    return runner->all;
}

/* Objects that brute force finds and the list lacks. */
static uint32_t lost(const MoversScene *scene, uint32_t frame, const MoversWindows *windows, const uint32_t *list,
                     uint32_t count) {
    uint32_t missing = 0;
    uint32_t k = 0;
    for (uint32_t i = 0; i < scene->def.movers; i++) {
        while (k < count && list[k] < i) {
            k++;
        }
        bool listed = k < count && list[k] == i;
        if (!listed) {
            EnfPose pose = bench_mover_pose(&scene->movers[i], (int64_t)frame);
            missing += bench_movers_shown(scene, windows, bench_mover_box(&pose)) ? 1U : 0U;
        }
    }
    return missing;
}

/* The same against the picture itself, where walls alone do not decide. */
static void compare_pixels(const MoversScene *scene, Runner *runner, const bool *shown, const uint32_t *list, uint32_t count) {
    uint32_t k = 0;
    for (uint32_t i = 0; i < scene->def.movers; i++) {
        bool listed = k < count && list[k] == i;
        k += listed ? 1U : 0U;
        runner->lost += shown[i] && !listed ? 1.0 : 0.0;
        runner->shown += shown[i] ? 1.0 : 0.0;
    }
    runner->listed += (double)count;
}

static bool compare(Case *current, Runner *runner, uint32_t frame, const uint32_t *list, uint32_t count) {
    const MoversScene *scene = &current->scene;
    if (runner->greene != NULL) {
        current->truth = current->truth != NULL ? current->truth : bench_truth_create(scene);
        if (current->truth != NULL) {
            compare_pixels(scene, runner, bench_truth_shown(current->truth, frame), list, count);
        }
        return current->truth != NULL;
    }
    uint32_t *copy = malloc((count + 1U) * sizeof *copy);
    if (copy == NULL) {
        return false;
    }
    if (count > 0) { /* an empty list may be no array at all */
        memcpy(copy, list, count * sizeof *copy);
    }
    const EnfVisSet *set = enf_vis_run(scene->vis, &scene->portals, &scene->views[frame]);
    bool ok = bench_movers_windows(scene, set, &current->windows);
    runner->lost += ok ? (double)lost(scene, frame, &current->windows, copy, count) : 0.0;
    free(copy);
    return ok;
}

static bool has_volumes(uint32_t technique) {
    Kind kind = techniques[technique].kind;
    return techniques[technique].period == 0 && (kind == KIND_INDEX || kind == KIND_GREENE);
}

/* Does a frame take tenths of a second, as twenty million polygons do? Then what a check leaves in the caches is nothing to it. */
static bool is_dear(const MoversDef *def, uint32_t technique) {
    uint32_t evaluated = has_volumes(technique) ? def->visible : def->movers;
    return (uint64_t)evaluated * def->polygons >= 20000000U;
}

static bool turn(Case *current, Runner *runner, uint32_t frame) {
    const MoversScene *scene = &current->scene;
    uint32_t count = 0;
    double cpu = bench_cpu_us();
    double start = bench_now_us();
    const uint32_t *list = find(scene, runner, frame, &current->windows, &count);
    double spent = bench_now_us() - start;
    cpu = bench_cpu_us() - cpu;
    spent = cpu < spent ? cpu : spent; /* another program may have had the processor in between */
    if (scene->def.check <= 2 || frame % scene->def.check > 1 || is_dear(&scene->def, runner->technique)) {
        /* a check, of this technique or of one before it, sweeps the caches */
        MoversFrame *timed = &runner->times[runner->timed++];
        timed->us = spent;
        if (runner->index != NULL) {
            bench_frame_counters(timed, runner->index);
        }
    }
    runner->spent_us += spent;
    runner->drawn += (double)count;
    runner->hash = enf_hash64(runner->hash, list, count * sizeof *list);
    runner->hashes[runner->frames++] = runner->hash;
    bool compared = frame % scene->def.check == 0 && runner->plain == NULL; /* what `plain` lists is its own affair */
    return !compared || compare(current, runner, frame, list, count);
}

/* ---- rows ------------------------------------------------------------------------------------------------------- */

static void add_greene_counters(const MoversScene *scene, const Runner *runner, BenchRow *row) {
    double frames = (double)runner->frames;
    GreeneCounters counters = bench_greene_counters(runner->greene);
    row->nodes = (double)counters.nodes / frames;
    row->boxes = (double)counters.boxes / frames;
    row->evaluated = (double)counters.evaluated / frames;
    row->exposed = (double)counters.exposed / frames;
    row->expired = (double)counters.expired / frames;
    row->reinserted = (double)counters.reinserted / frames;
    row->avoided = (double)counters.avoided / frames;
    row->overdraw = runner->shown > 0.0 ? runner->listed / runner->shown : -1.0;
    row->bytes_object = (double)bench_greene_bytes(runner->greene) / (double)scene->def.movers;
    row->vis_median_us = bench_quantile(runner->look_times, runner->timed, 0.5);
    row->vis_p99_us = bench_quantile(runner->look_times, runner->timed, 0.99);
}

static void add_counters(const MoversScene *scene, const Runner *runner, BenchRow *row) {
    double frames = (double)runner->frames;
    if (runner->greene != NULL) {
        add_greene_counters(scene, runner, row);
        return;
    }
    if (runner->index == NULL) {
        row->evaluated = (double)scene->def.movers;
        return;
    }
    EnfDbvCounters counters = enf_dbv_total_counters(runner->index);
    row->exposed = (double)counters.exposed / frames;
    row->expired = (double)counters.expired / frames;
    row->reinserted = (double)counters.reinserted / frames;
    bool moved = techniques[runner->technique].period == 1 && scene->def.motion != MOVERS_FREE; /* with its bound, once */
    double asked = (double)(enf_world_evaluations(runner->world) - runner->evaluations) / frames;
    row->evaluated = moved ? row->reinserted : asked;
    row->avoided = (double)counters.avoided / frames;
    row->nodes = (double)counters.nodes / frames;
    row->boxes = (double)counters.tested / frames;
    row->late = (double)counters.late;
    row->overdraw = counters.drawn > 0 ? (double)counters.exposed / (double)counters.drawn : -1.0;
    row->bytes_object = (double)enf_dbv_bytes(runner->index) / (double)scene->def.movers;
}

static bool has_period(uint32_t technique) {
    EnfDbvPolicy policy = techniques[technique].policy;
    return techniques[technique].period == 0 &&
           (policy == ENF_DBV_CONSTANT || policy == ENF_DBV_ADAPTIVE || policy == ENF_DBV_OPTIMAL);
}

/* The knobs that a technique has: of others it says nothing. */
static void write_params(const MoversDef *def, uint32_t technique, char params[BENCH_TEXT]) {
    char period[32] = "";
    char octree[64] = "";
    if (has_period(technique)) {
        snprintf(period, sizeof period, " period=%u", def->period);
    }
    if (techniques[technique].kind == KIND_GREENE) {
        snprintf(octree, sizeof octree, " leaf=%g occluders=%s", def->leaf, def->occluders ? "all" : "static");
    }
    snprintf(params, BENCH_TEXT,
             "rooms=%u movers=%u visible=%u speed=%g motion=%s eye=%s doors=%g door_width=%g polygons=%u%s seed=%u%s",
             def->rooms, def->movers, def->visible, def->speed, bench_movers_motions[def->motion], bench_movers_eyes[def->eye],
             def->doors, def->door_width, def->polygons, period, def->seed, octree);
}

static void add_row(BenchRun *run, const Case *current, Runner *runner) {
    const MoversScene *scene = &current->scene;
    const MoversDef *def = &scene->def;
    BenchRow row = bench_row(current->experiment, current->name, techniques[runner->technique].name);
    write_params(def, runner->technique, row.params);
    row.frames = runner->frames;
    row.lost_objects = runner->plain == NULL ? runner->lost : -1.0;
    row.objects = runner->drawn / (double)runner->frames;
    row.hash = runner->hash;
    add_counters(scene, runner, &row);
    /* The first two seconds are apart: everything is made anew there. Of a short run, a third. */
    uint32_t skip = runner->timed > 180 ? 120 : runner->timed / 3;
    uint32_t rest = runner->timed - skip;
    double hidden = (double)def->movers - row.objects;
    bench_frames_row(runner->times + skip, rest, runner->index != NULL, &row);
    row.ns_object = hidden > 0.0 ? 1000.0 * row.mean_us / hidden : -1.0;
    bench_rows_add(&run->rows, &row);
}

static bool is_chosen(const char *list, const char *name) {
    size_t length = strlen(name);
    for (const char *at = list; at != NULL && *at != '\0'; at = strchr(at, ',')) {
        at += *at == ',' ? 1 : 0;
        if (strncmp(at, name, length) == 0 && (at[length] == ',' || at[length] == '\0')) {
            return true;
        }
    }
    return false;
}

bool bench_movers_known(const char *list) {
    size_t known = 0;
    for (uint32_t t = 0; t < TECHNIQUES; t++) {
        known += is_chosen(list, techniques[t].name) ? 1U : 0U;
    }
    size_t words = 1;
    for (const char *at = list; *at != '\0'; at++) {
        words += *at == ',' ? 1U : 0U;
    }
    return known == words;
}

/* Of the same scene: what follows a comma says how many movers a variant has, and so do its parameters. */
static bool is_row_of(const BenchRow *row, const char *experiment, const char *name) {
    size_t length = strcspn(name, ",");
    return strcmp(row->experiment, experiment) == 0 && strcspn(row->scene, ",") == length &&
           strncmp(row->scene, name, length) == 0;
}

static bool is_technique_measured(const BenchRows *rows, const char *experiment, const char *name, const MoversDef *def,
                                  uint32_t technique) {
    char params[BENCH_TEXT];
    write_params(def, technique, params);
    for (uint32_t i = 0; i < rows->count; i++) {
        const BenchRow *row = &rows->rows[i];
        if (is_row_of(row, experiment, name) && strcmp(row->params, params) == 0 &&
            strcmp(row->technique, techniques[technique].name) == 0) {
            return true;
        }
    }
    return false;
}

/* Was all of this case measured before? So it is where knobs given with --set leave nothing of what an experiment varies, or where
 * that is nothing to the techniques that were chosen. If it is something to one of them, the others are measured beside it again. */
static bool is_measured(const BenchRun *run, const char *experiment, const char *name, const MoversDef *def) {
    bool all = true;
    for (uint32_t t = 0; t < TECHNIQUES && all; t++) {
        all = !is_chosen(def->techniques, techniques[t].name) || is_technique_measured(&run->rows, experiment, name, def, t);
    }
    return all;
}

/* Timed frames that each technique has, whatever they take: the first of three is left out. */
enum { LEAST_TIMED = 3 };

/* Does it take another turn? A million volumes are made in the first second: that is not what shall use up the time. */
static bool goes_on(const MoversDef *def, Runner *runner) {
    bool volumes = runner->index != NULL || has_volumes(runner->technique);
    if (volumes && runner->frames == 150) {
        runner->spent_us = 0.0;
    }
    double patience = volumes && runner->frames < 150 ? 4.0 : 1.0;
    return runner->timed < LEAST_TIMED || runner->spent_us <= 1e6 * def->budget * patience;
}

static bool run_frames(BenchRun *run, Case *current, Runner *runners, uint32_t count) {
    const MoversDef *def = &current->scene.def;
    bool ok = true;
    for (uint32_t f = 0; f < def->frames && ok; f++) {
        for (uint32_t i = 0; i < count && ok; i++) {
            Runner *runner = &runners[(i + f) % count];
            if (goes_on(def, runner)) {
                ok = turn(current, runner, f);
                if (runner->world != NULL) {
                    enf_world_advance(runner->world, 1);
                }
            }
        }
        bench_progress(run, "%u objects: frame %u of %u", def->movers, f + 1, def->frames);
    }
    return ok;
}

static bool open_runners(const MoversScene *scene, Runner *runners, uint32_t *count) {
    bool ok = true;
    *count = 0;
    for (uint32_t t = 0; t < TECHNIQUES && ok; t++) {
        if (is_chosen(scene->def.techniques, techniques[t].name)) {
            ok = open_runner(&runners[(*count)++], t, scene);
        }
    }
    return ok;
}

static void close_runners(Runner *runners, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        close_runner(&runners[i]);
    }
}

/* What a runner listed. Index, flat and sweep go by portals and windows; those that go by the picture, and those that do without
 * portals or care, have lists of their own. */
static MoversLists lists_of(const Runner *runner) {
    Kind kind = techniques[runner->technique].kind;
    MoversLists lists = {techniques[runner->technique].name, runner->hashes, runner->frames,
                         kind == KIND_INDEX || kind == KIND_FLAT || kind == KIND_SWEEP};
    return lists;
}

static void all_lists(const Runner *runners, uint32_t count, MoversLists lists[TECHNIQUES]) {
    for (uint32_t i = 0; i < count; i++) {
        lists[i] = lists_of(&runners[i]);
    }
}

/* The same frames once more, everything made anew: the work is the same, what the machine does besides is not. */
static bool run_again(BenchRun *run, Case *current, uint32_t round, Runner *runners, uint32_t count) {
    Runner others[TECHNIQUES];
    MoversLists first[TECHNIQUES];
    MoversLists again[TECHNIQUES];
    uint32_t other_count = 0;
    bool ok = open_runners(&current->scene, others, &other_count) && run_frames(run, current, others, other_count);
    for (uint32_t i = 0; i < count && ok; i++) {
        uint32_t both = others[i].timed < runners[i].timed ? others[i].timed : runners[i].timed;
        bench_frames_merge(runners[i].times, others[i].times, both);
        runners[i].lost += others[i].lost;
    }
    if (ok) {
        all_lists(runners, count, first);
        all_lists(others, count, again);
        current->same = bench_lists_repeat(current->experiment, current->name, round, first, again, count) && current->same;
    }
    close_runners(others, other_count);
    return ok;
}

static void add_rows(BenchRun *run, const Case *current, Runner *runners, uint32_t count) {
    uint32_t first = run->rows.count;
    for (uint32_t i = 0; i < count; i++) {
        add_row(run, current, &runners[i]);
        BenchRow *rows = run->rows.rows;
        rows[first + i].ratio_median = rows[first].median_us / rows[first + i].median_us;
    }
}

/* Everything but the rows. False without memory. */
static bool measure(BenchRun *run, Case *current, Runner *runners, uint32_t *count) {
    bool ok = open_runners(&current->scene, runners, count) && run_frames(run, current, runners, *count);
    for (uint32_t round = 2; round <= current->scene.def.rounds && ok; round++) {
        ok = run_again(run, current, round, runners, *count);
    }
    if (ok) {
        MoversLists lists[TECHNIQUES];
        all_lists(runners, *count, lists);
        current->same = bench_lists_agree(current->experiment, current->name, lists, *count) && current->same;
    }
    return ok;
}

/* A way takes a thousand million ticks at most: over the longest ones nobody is as slow as the least speeds that may be asked for. Rows
 * carry the speed that there is. */
static void tell_speed(Case *current) {
    MoversDef *def = &current->scene.def;
    double most = 0.0;
    for (uint32_t i = 0; i < def->movers; i++) {
        double speed = (double)current->scene.movers[i].speed * ENF_TICK_RATE;
        most = speed > most ? speed : most;
    }
    if (most > 1.1 * def->speed) { /* a mover's own is rounded up a little */
        fprintf(stderr, "enfbench: %s, %s: speed=%g: a way of 10^9 ticks needs up to %g\n", current->experiment, current->name,
                def->speed, most);
        def->speed = most;
    }
}

bool bench_movers_case(BenchRun *run, const char *experiment, const char *name, const MoversDef *def) {
    Case current = {.experiment = experiment, .name = name, .windows = {NULL, 0, 0}, .truth = NULL, .same = true};
    Runner runners[TECHNIQUES];
    uint32_t count = 0;
    if (!bench_movers_open(&current.scene, def)) {
        return false;
    }
    tell_speed(&current);
    def = &current.scene.def; /* rooms are rounded up to a grid */
    if (is_measured(run, experiment, name, def)) {
        bench_movers_close(&current.scene);
        return true;
    }
    bool ok = measure(run, &current, runners, &count);
    if (ok) {
        add_rows(run, &current, runners, count);
    } else {
        fprintf(stderr, "enfbench: no memory for %u objects\n", def->movers);
    }
    close_runners(runners, count);
    free(current.windows.items);
    bench_truth_destroy(current.truth);
    bench_movers_close(&current.scene);
    return ok && current.same;
}
