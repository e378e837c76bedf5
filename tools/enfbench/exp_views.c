/* L1 and vis: every traversal and window along recorded paths. L1 times whole frames (visibility, draw list, drawing) as Luebke &
 * Georges 1995 did; vis times visibility alone. Both compare with the picture of everything: pixels of colour and of the
 * id-buffer, and the objects that show in it. */
#include "enfbench/bench.h"
#include "enfbench/views.h"

#include <enfilade/gl.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What one technique gathers over the frames of a scene. */
typedef struct Tally {
    double *frame_us, *vis_us, *ratios;
    double lost_objects, lost_pixels, listed, shown;
    double cells, portals, nodes, boxes;
    uint32_t frames, checked;
    uint64_t hash;
} Tally;

/* A scene on the screen. */
typedef struct Stage {
    EnfVis *vis;
    EnfDraw *draw;
    EnfContext *context;
    EnfGl *gl;
    EnfGlTarget *target;
    void (*finish)(void);
    uint8_t *expected, *expected_ids, *pixels;
    uint8_t *visible; /**< a cluster: shows a pixel of the frame at hand */
    size_t bytes;
    uint32_t visible_count;
} Stage;

/* What an experiment on views does a frame. */
typedef struct Plan {
    const char *experiment;
    bool draw;              /**< frames are drawn and timed as a whole */
    uint32_t repeat, check; /**< runs of visibility a frame (the fastest counts); every check-th frame is compared */
} Plan;

static void close_stage(Stage *stage) {
    if (stage->target != NULL) {
        enf_gl_target_destroy(stage->target);
    }
    if (stage->gl != NULL) {
        enf_gl_destroy(stage->gl);
    }
    if (stage->context != NULL) {
        enf_context_destroy(stage->context);
    }
    if (stage->draw != NULL) {
        enf_draw_destroy(stage->draw);
    }
    enf_vis_destroy(stage->vis);
    free(stage->expected);
    free(stage->expected_ids);
    free(stage->pixels);
    free(stage->visible);
}

static EnfContextKind context_kind(BenchRun *run) {
    const char *name = bench_knob_text(&run->knobs, "context", "any");
    if (strcmp(name, "osmesa") == 0) {
        return ENF_CONTEXT_OSMESA;
    }
    return strcmp(name, "egl") == 0 ? ENF_CONTEXT_EGL : ENF_CONTEXT_ANY;
}

static bool open_stage(BenchRun *run, Stage *stage, const BenchScene *scene) {
    memset(stage, 0, sizeof *stage);
    const EnfCamera *camera = &scene->views[0].camera;
    EnfError error = {ENF_OK, 0, "", ""};
    EnfResult result = enf_vis_create(&stage->vis, &scene->map, NULL, &error);
    result = result == ENF_OK ? enf_draw_create(&stage->draw, &scene->map, NULL, &error) : result;
    result = result == ENF_OK ? enf_context_create(&stage->context, context_kind(run), &error) : result;
    if (result == ENF_OK) {
        result = enf_gl_create(&stage->gl, &scene->map, enf_context_loader(stage->context), &error);
    }
    if (result == ENF_OK) {
        result = enf_gl_target_create(stage->gl, &stage->target, camera->width_px, camera->height_px, &error);
    }
    stage->bytes = (size_t)camera->width_px * camera->height_px * 4;
    stage->expected = malloc(stage->bytes);
    stage->expected_ids = malloc(stage->bytes);
    stage->pixels = malloc(stage->bytes);
    stage->visible = calloc(scene->map.clusters_count + 1U, 1);
    bool memory = stage->expected && stage->expected_ids && stage->pixels && stage->visible;
    if (result != ENF_OK || !memory) {
        fprintf(stderr, "enfbench: %s: %s\n", scene->name, result != ENF_OK ? error.message : "out of memory");
        close_stage(stage);
        return false;
    }
    void *finish = enf_context_loader(stage->context)("glFinish");
    memcpy(&stage->finish, &finish, sizeof finish);
    return true;
}

static const EnfDrawList *draw_once(Stage *stage, const EnfVisSet *set, EnfRenderMode mode) {
    enf_gl_target_bind(stage->target, mode);
    const EnfDrawList *list = enf_draw_build(stage->draw, set, ENF_DRAW_NEAR, NULL, 1.0);
    enf_gl_draw(stage->gl, list, mode);
    return list;
}

/* Marks the clusters of the expected id-buffer. */
static void mark_visible(Stage *stage, uint32_t cluster_count) {
    memset(stage->visible, 0, cluster_count);
    stage->visible_count = 0;
    for (size_t i = 0; i < stage->bytes; i += 4) {
        const uint8_t *p = stage->expected_ids + i;
        uint32_t id = p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
        if (id != 0 && id <= cluster_count && !stage->visible[id - 1]) {
            stage->visible[id - 1] = 1;
            stage->visible_count++;
        }
    }
}

static double differing_pixels(const uint8_t *a, const uint8_t *b, size_t bytes) {
    size_t count = 0;
    for (size_t i = 0; i < bytes; i += 4) {
        count += memcmp(a + i, b + i, 4) != 0;
    }
    return (double)count;
}

/* Draws the frame again and compares colours and ids with those of everything; `set` is still valid. */
static void compare(Stage *stage, const EnfVisSet *set, bool baseline, uint32_t cluster_count, Tally *tally) {
    uint8_t *colour = baseline ? stage->expected : stage->pixels;
    (void)draw_once(stage, set, ENF_RENDER_COLOR);
    enf_gl_target_read(stage->target, ENF_RENDER_COLOR, colour);
    double lost = baseline ? 0.0 : differing_pixels(stage->expected, colour, stage->bytes);
    uint8_t *ids = baseline ? stage->expected_ids : stage->pixels;
    (void)draw_once(stage, set, ENF_RENDER_IDS);
    enf_gl_target_read(stage->target, ENF_RENDER_IDS, ids);
    lost += baseline ? 0.0 : differing_pixels(stage->expected_ids, ids, stage->bytes);
    if (baseline) {
        mark_visible(stage, cluster_count);
    }
    uint32_t found = 0;
    for (uint32_t i = 0; i < set->entry_count; i++) {
        found += stage->visible[set->entries[i].cluster];
    }
    tally->lost_pixels += lost;
    tally->lost_objects += (double)(stage->visible_count - found);
    tally->listed += (double)set->entry_count;
    tally->shown += (double)stage->visible_count;
    tally->checked++;
}

static void count(Tally *tally, const EnfVisSet *set) {
    uint64_t hash = enf_vis_hash(set);
    tally->hash = enf_hash64(tally->hash, &hash, sizeof hash);
    tally->cells += (double)set->cell_count;
    tally->portals += (double)set->counters.portals_tested;
    tally->nodes += (double)set->counters.kd_nodes;
    tally->boxes += (double)set->counters.boxes;
}

static void one_frame(const Plan *plan, Stage *stage, BenchScene *scene, uint32_t frame, uint32_t t, Tally *tally) {
    const BenchTechnique *technique = &bench_techniques[t];
    EnfView view = scene->views[frame];
    view.cull = technique->cull;
    view.window = technique->window;
    const EnfVisSet *set = NULL;
    double best = 1e300;
    for (uint32_t r = 0; r < plan->repeat; r++) {
        double start = bench_now_us();
        set = enf_vis_run(stage->vis, &scene->portals, &view);
        double spent = bench_now_us() - start;
        best = spent < best ? spent : best;
    }
    tally->vis_us[frame] = best;
    tally->frame_us[frame] = best;
    if (plan->draw) {
        double start = bench_now_us();
        (void)draw_once(stage, set, ENF_RENDER_COLOR);
        stage->finish();
        tally->frame_us[frame] += bench_now_us() - start;
    }
    count(tally, set);
    if (frame % plan->check == 0) {
        compare(stage, set, t == 0, scene->map.clusters_count, tally);
    }
    tally->frames++;
}

static void add_row(BenchRun *run, const Plan *plan, const BenchScene *scene, uint32_t t, Tally *tally) {
    BenchRow row = bench_row(plan->experiment, scene->name, bench_techniques[t].name);
    const EnfCamera *camera = &scene->views[0].camera;
    double frames = (double)tally->frames;
    snprintf(row.params, sizeof row.params, "%ux%u", camera->width_px, camera->height_px);
    row.frames = tally->frames;
    row.lost_objects = tally->lost_objects;
    row.lost_pixels = tally->lost_pixels;
    row.overdraw = tally->shown > 0.0 ? tally->listed / tally->shown : -1.0;
    row.objects = tally->checked > 0 ? tally->listed / (double)tally->checked : -1.0;
    row.cells = tally->cells / frames;
    row.portals = tally->portals / frames;
    row.nodes = tally->nodes / frames;
    row.boxes = tally->boxes / frames;
    row.hash = tally->hash;
    row.ratio_best = bench_quantile(tally->ratios, tally->frames, 1.0);
    row.ratio_median = bench_quantile(tally->ratios, tally->frames, 0.5);
    row.vis_p99_us = bench_quantile(tally->vis_us, tally->frames, 0.99);
    row.vis_median_us = bench_quantile(tally->vis_us, tally->frames, 0.5);
    row.p99_us = bench_quantile(tally->frame_us, tally->frames, 0.99);
    row.median_us = bench_quantile(tally->frame_us, tally->frames, 0.5);
    bench_rows_add(&run->rows, &row);
}

static bool make_tallies(Tally *tallies, uint32_t frames) {
    bool ok = true;
    for (uint32_t t = 0; t < BENCH_TECHNIQUE_COUNT; t++) {
        tallies[t].hash = ENF_HASH_START;
        tallies[t].frame_us = calloc(frames, sizeof(double));
        tallies[t].vis_us = calloc(frames, sizeof(double));
        tallies[t].ratios = calloc(frames, sizeof(double));
        ok = ok && tallies[t].frame_us && tallies[t].vis_us && tallies[t].ratios;
    }
    return ok;
}

static bool run_scene(BenchRun *run, BenchScene *scene, const void *user) {
    const Plan *plan = user;
    Stage stage;
    Tally tallies[BENCH_TECHNIQUE_COUNT];
    memset(tallies, 0, sizeof tallies);
    if (!open_stage(run, &stage, scene)) {
        return false;
    }
    bool ok = make_tallies(tallies, scene->view_count);
    for (uint32_t frame = 0; frame < scene->view_count && ok; frame++) {
        for (uint32_t t = 0; t < BENCH_TECHNIQUE_COUNT; t++) {
            one_frame(plan, &stage, scene, frame, t, &tallies[t]);
            tallies[t].ratios[frame] = tallies[0].frame_us[frame] / tallies[t].frame_us[frame];
        }
        bench_progress(run, "%s %s: frame %u of %u", plan->experiment, scene->name, frame + 1, scene->view_count);
    }
    for (uint32_t t = 0; t < BENCH_TECHNIQUE_COUNT; t++) {
        if (ok) {
            add_row(run, plan, scene, t, &tallies[t]);
        }
        free(tallies[t].frame_us);
        free(tallies[t].vis_us);
        free(tallies[t].ratios);
    }
    close_stage(&stage);
    return ok;
}

bool bench_l1(BenchRun *run) {
    Plan plan;
    plan.experiment = "L1";
    plan.draw = true;
    plan.repeat = bench_knob_whole(&run->knobs, "repeat", 3, 1, 1000);
    plan.check = bench_knob_whole(&run->knobs, "check", 1, 1, 1000000);
    return bench_each_scene(run, bench_knob_whole(&run->knobs, "frames", 500, 1, 1000000), run_scene, &plan);
}

bool bench_vis(BenchRun *run) {
    Plan plan;
    plan.experiment = "vis";
    plan.draw = false;
    plan.repeat = bench_knob_whole(&run->knobs, "repeat", 5, 1, 1000);
    plan.check = bench_knob_whole(&run->knobs, "check", 20, 1, 1000000);
    return bench_each_scene(run, bench_knob_whole(&run->knobs, "frames", 2000, 1, 1000000), run_scene, &plan);
}
