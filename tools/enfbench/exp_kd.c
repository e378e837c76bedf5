/* kd query against brute force: random boxes in a room-like volume, pyramids from random eyes inside it. The brute loop is the
 * oracle (enf_pyramid_box over all boxes) and the time to beat; every variant must find the same set. */
#include "enfbench/bench.h"
#include "simd/simd.h"

#include <enfilade/kd.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct KdScene {
    EnfBox3f *boxes;
    uint32_t count;
    EnfKdBuilt built;
    EnfPyramid *pyramids;
    uint32_t frames;
    uint32_t *items, *brute;
    uint8_t *marks;
} KdScene;

/* SplitMix64: the seed names the scene on every machine. */
static double random_unit(uint64_t *state) {
    *state += UINT64_C(0x9e3779b97f4a7c15);
    uint64_t z = *state;
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static void free_scene(KdScene *scene) {
    free(scene->boxes);
    free(scene->pyramids);
    free(scene->items);
    free(scene->brute);
    free(scene->marks);
    enf_kd_built_free(&scene->built);
}

static void fill_boxes(KdScene *scene, double side, uint64_t *seed) {
    for (uint32_t i = 0; i < scene->count; i++) {
        EnfVec3 p = enf_v3(random_unit(seed) * side, random_unit(seed) * 4.0, random_unit(seed) * side);
        EnfVec3 size = enf_v3(random_unit(seed), random_unit(seed), random_unit(seed));
        EnfBox3 box = {p, enf_add(p, size)};
        scene->boxes[i] = enf_box3f_outward(box);
    }
}

/* Views of a quarter of the picture, as through a door. */
static void fill_pyramids(KdScene *scene, double side, uint64_t *seed) {
    EnfBox3f bounds = {{0.0F, 0.0F, 0.0F}, {(float)side + 1.0F, 5.0F, (float)side + 1.0F}};
    for (uint32_t i = 0; i < scene->frames; i++) {
        EnfVec3 eye = enf_v3(random_unit(seed) * side, 1.7, random_unit(seed) * side);
        EnfCamera camera = enf_camera(eye, enf_turn(random_unit(seed) * 360.0, random_unit(seed) * 40.0 - 20.0, 0.0), 60.0, 640,
                                      480);
        EnfWindow full = enf_window_full(&camera);
        EnfWindow window = {full.x1 / 4, full.y1 / 4, full.x1 * 3 / 4, full.y1 * 3 / 4};
        enf_pyramid(&camera, window, NULL, enf_v3(0.0, 0.0, 0.0), bounds, &scene->pyramids[i]);
    }
}

static bool make_scene(KdScene *scene, uint32_t count, uint32_t frames, uint64_t seed) {
    memset(scene, 0, sizeof *scene);
    scene->count = count;
    scene->frames = frames;
    scene->boxes = calloc(count, sizeof *scene->boxes);
    scene->pyramids = calloc(frames, sizeof *scene->pyramids);
    scene->items = calloc(count, sizeof *scene->items);
    scene->brute = calloc(count, sizeof *scene->brute);
    scene->marks = calloc(count, 1);
    bool ok = scene->boxes && scene->pyramids && scene->items && scene->brute && scene->marks;
    if (ok) {
        double side = 4.0;
        while (side * side < (double)count) {
            side *= 1.25;
        }
        fill_boxes(scene, side, &seed);
        fill_pyramids(scene, side, &seed);
        ok = enf_kd_build(&scene->built, scene->boxes, NULL, count, NULL, NULL) == ENF_OK;
    }
    if (!ok) {
        fprintf(stderr, "enfbench: no memory for %u boxes\n", count);
        free_scene(scene);
    }
    return ok;
}

static uint32_t brute_query(const KdScene *scene, const EnfPyramid *pyramid) {
    uint32_t found = 0;
    for (uint32_t i = 0; i < scene->count; i++) {
        if (enf_pyramid_box(pyramid, scene->boxes[i])) {
            scene->brute[found++] = i;
        }
    }
    return found;
}

/* How many of brute force's items `items` lacks; marks are cleared again. */
static uint32_t missing(const KdScene *scene, uint32_t brute_count, uint32_t count) {
    uint32_t lost = 0;
    for (uint32_t i = 0; i < count; i++) {
        scene->marks[scene->items[i]] = 1;
    }
    for (uint32_t i = 0; i < brute_count; i++) {
        lost += scene->marks[scene->brute[i]] ? 0U : 1U;
    }
    for (uint32_t i = 0; i < count; i++) {
        scene->marks[scene->items[i]] = 0;
    }
    return lost;
}

/* A set's hash does not depend on the order in which a technique lists it. */
static uint64_t set_hash(const uint32_t *items, uint32_t count) {
    uint64_t sum = count;
    for (uint32_t i = 0; i < count; i++) {
        sum += enf_hash64(ENF_HASH_START, &items[i], sizeof items[i]);
    }
    return sum;
}

static void measure(BenchRun *run, KdScene *scene, const char *technique, const char *params) {
    double *times = calloc(scene->frames, sizeof *times);
    if (times == NULL) {
        return;
    }
    bool brute = strcmp(technique, "brute") == 0;
    EnfKdTree tree = enf_kd_tree(&scene->built);
    EnfKdCounters counters = {0, 0, 0};
    BenchRow row = bench_row("kd", "random boxes", technique);
    double lost = 0.0;
    double objects = 0.0;
    for (uint32_t f = 0; f < scene->frames; f++) {
        const EnfPyramid *pyramid = &scene->pyramids[f];
        uint32_t expected = brute_query(scene, pyramid);
        double start = bench_now_us();
        uint32_t count = brute ? brute_query(scene, pyramid)
                               : enf_kd_query(&tree, pyramid, scene->items, scene->count, &counters);
        times[f] = bench_now_us() - start;
        lost += brute ? 0.0 : (double)missing(scene, expected, count);
        objects += (double)count;
        uint64_t hash = set_hash(brute ? scene->brute : scene->items, count);
        row.hash = enf_hash64(row.hash, &hash, sizeof hash);
    }
    double frames = (double)scene->frames;
    snprintf(row.params, sizeof row.params, "%s", params);
    row.frames = scene->frames;
    row.lost_objects = lost;
    row.objects = objects / frames;
    row.nodes = brute ? 0.0 : (double)counters.nodes / frames;
    row.boxes = brute ? (double)scene->count : (double)counters.boxes / frames;
    row.p99_us = bench_quantile(times, scene->frames, 0.99);
    row.median_us = bench_quantile(times, scene->frames, 0.5);
    bench_rows_add(&run->rows, &row);
    free(times);
}

bool bench_kd(BenchRun *run) {
    uint32_t sizes[64];
    uint32_t size_count = bench_knob_list(&run->knobs, "boxes", "1000,10000,100000", 10000000, sizes, 64);
    uint32_t frames = bench_knob_whole(&run->knobs, "frames", 200, 1, 1000000);
    uint32_t seed = bench_knob_whole(&run->knobs, "seed", 1, 0, 1000000000);
    for (uint32_t n = 0; n < size_count; n++) {
        KdScene scene;
        if (!make_scene(&scene, sizes[n], frames, seed)) {
            return false;
        }
        char params[64];
        snprintf(params, sizeof params, "boxes=%u seed=%u", sizes[n], seed);
        bench_progress(run, "kd: %u boxes", sizes[n]);
        measure(run, &scene, "brute", params);
        static const struct {
            EnfSimdKind kind;
            const char *name;
        } variants[] = {{ENF_SIMD_SCALAR, "kd-scalar"}, {ENF_SIMD_SSE2, "kd-sse2"}, {ENF_SIMD_AVX2, "kd-avx2"}};
        for (size_t v = 0; v < sizeof variants / sizeof *variants; v++) {
            if (enf_simd_force(variants[v].kind)) {
                measure(run, &scene, variants[v].name, params);
            }
        }
        enf_simd_automatic();
        free_scene(&scene);
    }
    return true;
}
