/* kd-trees against loops over all boxes: random, flat, equal, huge and tiny boxes, 0 to 10,000 items, every SIMD variant. */
#include "harness/purse.h"
#include "simd/simd.h"
#include <enfilade/kd.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ITEMS_MAX = 10000 };

typedef enum Shape { RANDOM, FLAT, EQUAL, HUGE_BOXES, TINY, LINE, POINTS, NESTED, SHAPE_COUNT } Shape;
static const uint32_t sizes[] = {0, 1, 2, 7, 8, 9, 16, 17, 33, 100, 1000, ITEMS_MAX};

/* ---- scenes ----------------------------------------------------------------------------------------------------- */

static EnfVec3f random_point(EnfTestRng *rng, float extent) {
    EnfVec3f p = {enf_test_float(rng, -extent, extent), enf_test_float(rng, -extent, extent),
                  enf_test_float(rng, -extent, extent)};
    return p;
}

static EnfBox3f box_around(EnfVec3f p, float x, float y, float z) {
    EnfBox3f box = {p, {p.x + x, p.y + y, p.z + z}};
    return box;
}

static EnfBox3f random_box(EnfTestRng *rng, Shape shape, uint32_t i) {
    const float big = 0.25f * FLT_MAX;
    EnfVec3f p = random_point(rng, 20.0f);
    EnfVec3f same = {1.0f, 2.0f, -3.0f};
    switch (shape) {
    case FLAT:
        return box_around(p, 2.0f * (float)(i % 3 != 0), 2.0f * (float)(i % 3 != 1), 2.0f * (float)(i % 3 != 2));
    case EQUAL:
        return box_around(same, 1.0f, 1.0f, 1.0f);
    case HUGE_BOXES:
        return i % 2 ? box_around(random_point(rng, big), big, big, big) : box_around(p, 1.0f, 1e30f, 1.0f);
    case TINY:
        return box_around(random_point(rng, 1e-30f), 1e-38f, 0.0f, 1e-37f);
    case LINE:
        return box_around((EnfVec3f){p.x, 0.0f, 0.0f}, 0.5f, 0.0f, 0.0f);
    case POINTS:
        return box_around(p, 0.0f, 0.0f, 0.0f);
    case NESTED: { /* each inside the one before, on and on: the heuristic finds nothing to split */
        float half = ldexpf(64.0f, -(int)(i % 100));
        return (EnfBox3f){{-half, -half, -half}, {half, half, half}};
    }
    default:
        return box_around(p, enf_test_float(rng, 0.0f, 3.0f), enf_test_float(rng, 0.0f, 3.0f), enf_test_float(rng, 0.0f, 3.0f));
    }
}

typedef struct Scene {
    EnfBox3f *boxes;
    uint32_t count;
    EnfKdBuilt built;
    EnfKdTree tree;
} Scene;

static Scene make_scene(EnfTestRng *rng, Shape shape, uint32_t count) {
    Scene scene = {malloc((count + 1) * sizeof(EnfBox3f)), count, {0}, {0}};
    for (uint32_t i = 0; i < count; i++) {
        scene.boxes[i] = random_box(rng, shape, i);
    }
    EnfError error = {0};
    if (enf_kd_build(&scene.built, scene.boxes, NULL, count, NULL, &error)) {
        fail_msg("build: %s", error.message);
    }
    scene.tree = enf_kd_tree(&scene.built);
    if (enf_kd_check(&scene.tree, count, &error)) {
        fail_msg("shape %d, %u items: %s", (int)shape, count, error.message);
    }
    return scene;
}

static void free_scene(Scene *scene) {
    free(scene->boxes);
    enf_kd_built_free(&scene->built);
}

/* A pyramid at random, or hostile planes that belong to no camera. */
static EnfPyramid random_pyramid(EnfTestRng *rng) {
    EnfPyramid pyramid = {0, {0}, {0}, {0}, {0}};
    if (enf_test_chance(rng, 3)) {
        pyramid.count = enf_test_below(rng, ENF_PYRAMID_PLANES + 1);
        for (uint32_t i = 0; i < pyramid.count; i++) {
            float scale = enf_test_chance(rng, 8) ? 1e30f : 1.0f;
            pyramid.nx[i] = enf_test_chance(rng, 5) ? -0.0f : enf_test_float(rng, -scale, scale);
            pyramid.ny[i] = enf_test_chance(rng, 5) ? 0.0f : enf_test_float(rng, -1.0f, 1.0f);
            pyramid.nz[i] = enf_test_chance(rng, 5) ? 0.0f : enf_test_float(rng, -1.0f, 1.0f);
            pyramid.d[i] = enf_test_float(rng, -10.0f, 40.0f);
        }
        return pyramid;
    }
    EnfVec3 eye = enf_v3_from_f(random_point(rng, 30.0f));
    EnfCamera camera = enf_camera(eye, enf_turn(enf_test_double(rng, -180, 180), enf_test_double(rng, -89, 89), 0.0),
                                  enf_test_double(rng, 10, 120), 640, 480);
    EnfBox3f bounds = {{-64, -64, -64}, {64, 64, 64}};
    EnfWindow full = enf_window_full(&camera);
    int32_t x = (int32_t)enf_test_below(rng, (uint32_t)full.x1), y = (int32_t)enf_test_below(rng, (uint32_t)full.y1);
    EnfWindow window = {x, y, x + 1 + (int32_t)enf_test_below(rng, (uint32_t)(full.x1 - x)),
                        y + 1 + (int32_t)enf_test_below(rng, (uint32_t)(full.y1 - y))};
    enf_pyramid(&camera, window, NULL, enf_v3(0, 0, 0), bounds, &pyramid);
    return pyramid;
}

/* ---- lists ------------------------------------------------------------------------------------------------------ */

static int compare_u32(const void *a, const void *b) {
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

static void assert_same(const uint32_t *expected, uint32_t expected_count, uint32_t *found, uint32_t found_count,
                        const char *what) {
    if (found_count > 1) {
        qsort(found, found_count, sizeof *found, compare_u32);
    }
    for (uint32_t i = 0; i < expected_count && i < found_count; i++) {
        if (expected[i] != found[i]) {
            fail_msg("%s: entry %u is %u instead of %u", what, i, found[i], expected[i]);
        }
    }
    if (expected_count != found_count) {
        fail_msg("%s: %u items instead of %u", what, found_count, expected_count);
    }
}

static bool boxes_touch(const EnfBox3f *a, const EnfBox3f *b) {
    return a->min.x <= b->max.x && a->max.x >= b->min.x && a->min.y <= b->max.y && a->max.y >= b->min.y &&
           a->min.z <= b->max.z && a->max.z >= b->min.z;
}

static uint32_t expected_items[ITEMS_MAX], found_items[ITEMS_MAX], other_items[ITEMS_MAX];

/* ---- queries ---------------------------------------------------------------------------------------------------- */

/* Rounding is monotone, so the tree gives exactly the loop's list, and every variant the same one in the same order. */
static void check_pyramid(const Scene *scene, const EnfPyramid *pyramid) {
    uint32_t expected = 0;
    for (uint32_t i = 0; i < scene->count; i++) {
        if (enf_pyramid_box(pyramid, scene->boxes[i])) {
            expected_items[expected++] = i;
        }
    }
    EnfKdCounters counters[ENF_SIMD_KIND_COUNT];
    uint32_t found[ENF_SIMD_KIND_COUNT];
    for (int kind = 0; kind < ENF_SIMD_KIND_COUNT; kind++) {
        if (!enf_simd_force((EnfSimdKind)kind)) {
            continue;
        }
        counters[kind] = (EnfKdCounters){0, 0, 0};
        uint32_t *items = kind ? other_items : found_items;
        found[kind] = enf_kd_query(&scene->tree, pyramid, items, scene->count, &counters[kind]);
        assert_int_equal(counters[kind].found, found[kind]);
        if (kind) {
            assert_int_equal(found[kind], found[0]);
            assert_memory_equal(items, found_items, found[0] * sizeof *items);
            assert_memory_equal(&counters[kind], &counters[0], sizeof counters[0]);
        }
    }
    enf_simd_automatic();
    assert_same(expected_items, expected, found_items, found[0], "pyramid");
}

static void check_overlap(EnfTestRng *rng, const Scene *scene) {
    EnfBox3f box = random_box(rng, enf_test_chance(rng, 4) ? HUGE_BOXES : RANDOM, enf_test_u32(rng));
    uint32_t expected = 0;
    for (uint32_t i = 0; i < scene->count; i++) {
        if (boxes_touch(&scene->boxes[i], &box)) {
            expected_items[expected++] = i;
        }
    }
    uint32_t found = enf_kd_overlap(&scene->tree, box, found_items, scene->count);
    assert_same(expected_items, expected, found_items, found, "overlap");
}

typedef struct RaySeen {
    bool *seen;
    const EnfBox3f *boxes;
} RaySeen;

static double see_all(void *user, uint32_t item, double t_max) {
    RaySeen *ray = user;
    assert_false(ray->seen[item]);
    ray->seen[item] = true;
    return t_max;
}

/* A ray aimed at a point of a box must report that box. */
static void check_ray(EnfTestRng *rng, const Scene *scene) {
    if (scene->count == 0) {
        return;
    }
    RaySeen ray = {calloc(scene->count, 1), scene->boxes};
    uint32_t item = enf_test_below(rng, scene->count);
    const EnfBox3f *box = &scene->boxes[item];
    EnfVec3 target = enf_v3(enf_test_double(rng, (double)box->min.x, (double)box->max.x),
                            enf_test_double(rng, (double)box->min.y, (double)box->max.y),
                            enf_test_double(rng, (double)box->min.z, (double)box->max.z));
    EnfVec3 from = enf_v3_from_f(random_point(rng, 100.0f));
    EnfVec3 direction = enf_sub(target, from);
    if (enf_test_chance(rng, 4)) { /* along an axis, within the slabs of the others */
        from = enf_v3(target.x, target.y, (double)box->min.z - 10.0 - fabs((double)box->min.z));
        direction = enf_v3(0, 0, (double)box->min.z - from.z);
    }
    enf_kd_ray(&scene->tree, from, direction, 1.0 + 1e-12, see_all, &ray);
    assert_true(ray.seen[item]);
    free(ray.seen);
}

static void test_queries(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    for (int shape = 0; shape < SHAPE_COUNT; shape++) {
        for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
            Scene scene = make_scene(&rng, (Shape)shape, sizes[s]);
            uint32_t rounds = enf_test_rounds(sizes[s] > 1000 ? 20 : 100, sizes[s] > 1000 ? 500 : 5000);
            for (uint32_t i = 0; i < rounds; i++) {
                EnfPyramid pyramid = random_pyramid(&rng);
                check_pyramid(&scene, &pyramid);
                check_overlap(&rng, &scene);
                check_ray(&rng, &scene);
            }
            free_scene(&scene);
        }
    }
}

/* A NaN in the pyramid must keep boxes, alike in every variant. */
static void test_nan_keeps(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    Scene scene = make_scene(&rng, RANDOM, 100);
    EnfPyramid pyramid = {2, {0, 1}, {0, 0}, {0, 0}, {NAN, 1e9f}};
    check_pyramid(&scene, &pyramid);
    assert_int_equal(enf_kd_query(&scene.tree, &pyramid, found_items, 100, NULL), 100);
    free_scene(&scene);
}

/* Too small an array is filled as far as it goes, and the count tells. */
static void test_capacity(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(3);
    Scene scene = make_scene(&rng, RANDOM, 100);
    EnfPyramid all = {0, {0}, {0}, {0}, {0}};
    found_items[7] = 12345;
    assert_int_equal(enf_kd_query(&scene.tree, &all, found_items, 7, NULL), 100);
    assert_int_equal(found_items[7], 12345);
    assert_int_equal(enf_kd_query(&scene.tree, &all, NULL, 0, NULL), 100);
    EnfBox3f everything = {{-1e9f, -1e9f, -1e9f}, {1e9f, 1e9f, 1e9f}};
    assert_int_equal(enf_kd_overlap(&scene.tree, everything, found_items, 7), 100);
    assert_int_equal(found_items[7], 12345);
    free_scene(&scene);
}

/* Shrinking t_max prunes: the nearest box is found after few visits. */
typedef struct Nearest {
    const EnfBox3f *boxes;
    uint32_t visits, item;
} Nearest;

static double see_nearest(void *user, uint32_t item, double t_max) {
    Nearest *nearest = user;
    double t = (double)nearest->boxes[item].min.x; /* the ray starts at 0 along +x */
    nearest->visits++;
    if (t < t_max) {
        nearest->item = item;
        return t;
    }
    return t_max;
}

static void test_ray_order(void **state) {
    (void)state;
    enum { COUNT = 1000 };
    EnfBox3f boxes[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        float x = (float)((i * 617) % COUNT) + 1.0f;
        boxes[i] = (EnfBox3f){{x, -1, -1}, {x + 0.5f, 1, 1}};
    }
    EnfKdBuilt built;
    assert_int_equal(enf_kd_build(&built, boxes, NULL, COUNT, NULL, NULL), ENF_OK);
    EnfKdTree tree = enf_kd_tree(&built);
    Nearest nearest = {boxes, 0, ENF_NONE};
    enf_kd_ray(&tree, enf_v3(0, 0, 0), enf_v3(1, 0, 0), HUGE_VAL, see_nearest, &nearest);
    assert_int_equal(nearest.item, 0);
    assert_in_range(nearest.visits, 1, 16);
    enf_kd_built_free(&built);
}

/* ---- building --------------------------------------------------------------------------------------------------- */

static void test_build_deterministic(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(4);
    Scene scene = make_scene(&rng, RANDOM, 1000);
    EnfKdBuilt again;
    assert_int_equal(enf_kd_build(&again, scene.boxes, NULL, 1000, NULL, NULL), ENF_OK);
    assert_int_equal(again.node_count, scene.built.node_count);
    assert_memory_equal(again.nodes, scene.built.nodes, again.node_count * sizeof *again.nodes);
    assert_memory_equal(again.blocks, scene.built.blocks, again.block_count * sizeof *again.blocks);
    enf_kd_built_free(&again);
    free_scene(&scene);
}

static void test_build_item_numbers(void **state) {
    (void)state;
    EnfBox3f boxes[3] = {{{0, 0, 0}, {1, 1, 1}}, {{2, 0, 0}, {3, 1, 1}}, {{4, 0, 0}, {5, 1, 1}}};
    uint32_t items[3] = {70, 50, 60};
    EnfKdBuilt built;
    assert_int_equal(enf_kd_build(&built, boxes, items, 3, NULL, NULL), ENF_OK);
    EnfKdTree tree = enf_kd_tree(&built);
    assert_int_equal(enf_kd_overlap(&tree, boxes[1], found_items, 3), 1);
    assert_int_equal(found_items[0], 50);
    enf_kd_built_free(&built);
}

static void test_build_refuses(void **state) {
    (void)state;
    const EnfBox3f bad[] = {{{0, 0, 0}, {NAN, 1, 1}}, {{0, 0, 0}, {INFINITY, 1, 1}}, {{1, 0, 0}, {0, 1, 1}}};
    for (size_t i = 0; i < 3; i++) {
        EnfKdBuilt built;
        EnfError error = {0};
        EnfBox3f boxes[2] = {{{0, 0, 0}, {1, 1, 1}}, bad[i]};
        assert_int_equal(enf_kd_build(&built, boxes, NULL, 2, NULL, &error), ENF_ERROR_ARGUMENT);
        assert_non_null(strstr(error.message, "box 1"));
        assert_null(built.nodes);
    }
}

/* Memory that ends after a number of blocks, and is all given back. */
static void test_build_without_memory(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(8);
    EnfBox3f boxes[50];
    for (uint32_t i = 0; i < 50; i++) {
        boxes[i] = random_box(&rng, RANDOM, i);
    }
    EnfResult result = ENF_ERROR_MEMORY;
    for (uint32_t blocks = 0; result != ENF_OK; blocks++) {
        Purse purse = purse_with(blocks);
        EnfAllocator allocator = purse_allocator(&purse);
        EnfKdBuilt built;
        EnfError error = {0};
        result = enf_kd_build(&built, boxes, NULL, 50, &allocator, &error);
        assert_int_equal(result, purse.refused ? ENF_ERROR_MEMORY : ENF_OK);
        assert_int_equal(built.nodes != NULL, result == ENF_OK);
        enf_kd_built_free(&built);
        purse_assert_whole(&purse);
        assert_in_range(blocks, result == ENF_OK, 16);
    }
}

/* Near-linear: sixteen times the items cost at most some thirty times the time, and many small trees are cheap. */
static void test_build_time(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(5);
    EnfBox3f *boxes = malloc(160000 * sizeof *boxes);
    for (uint32_t i = 0; i < 160000; i++) {
        boxes[i] = random_box(&rng, RANDOM, i);
    }
    double seconds[3];
    const uint32_t counts[3] = {10000, 160000, 10};
    for (int i = 0; i < 3; i++) {
        clock_t start = clock();
        for (uint32_t round = 0; round < (i == 2 ? 7000 : 1); round++) {
            EnfKdBuilt built;
            assert_int_equal(enf_kd_build(&built, boxes, NULL, counts[i], NULL, NULL), ENF_OK);
            enf_kd_built_free(&built);
        }
        seconds[i] = (double)(clock() - start) / CLOCKS_PER_SEC;
    }
    printf("build: 10,000 items %.1f ms, 160,000 items %.1f ms, 7,000 trees of 10 items %.1f ms\n", 1e3 * seconds[0],
           1e3 * seconds[1], 1e3 * seconds[2]);
    assert_true(seconds[1] < 60.0 * seconds[0] + 0.1);
    free(boxes);
}

/* A narrow pyramid through many boxes: the cost of a node. Printed, and held far above the target: machines differ. */
static void test_query_time(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng_fixed(6, 1);
    Scene scene = make_scene(&rng, RANDOM, ITEMS_MAX);
    enum { PYRAMIDS = 64 };
    EnfPyramid pyramids[PYRAMIDS];
    for (int i = 0; i < PYRAMIDS; i++) {
        do {
            pyramids[i] = random_pyramid(&rng);
        } while (pyramids[i].count != 5);
    }
    for (int kind = 0; kind < ENF_SIMD_KIND_COUNT; kind++) {
        if (!enf_simd_force((EnfSimdKind)kind)) {
            continue;
        }
        EnfKdCounters counters = {0, 0, 0};
        clock_t start = clock();
        for (int i = 0; i < 20 * PYRAMIDS; i++) {
            enf_kd_query(&scene.tree, &pyramids[i % PYRAMIDS], found_items, ITEMS_MAX, &counters);
        }
        double ns = 1e9 * (double)(clock() - start) / CLOCKS_PER_SEC;
        printf("query, %s: %.1f ns a node, %.1f ns an item found\n", enf_simd()->name, ns / (double)counters.nodes,
               ns / (double)counters.found);
    }
    enf_simd_automatic();
    free_scene(&scene);
}

/* ---- check ------------------------------------------------------------------------------------------------------ */

/* A random change of a good tree either fails the check, or leaves a tree that every query survives (ASan and UBSan watch). */
static void test_check_corrupt(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(7);
    Scene scene = make_scene(&rng, RANDOM, 200);
    size_t node_bytes = scene.tree.node_count * sizeof(EnfKdNode), block_bytes = scene.tree.block_count * sizeof(EnfKdBlock);
    EnfKdNode *nodes = malloc(node_bytes);
    EnfKdBlock *blocks = malloc(block_bytes);
    uint32_t refused = 0, rounds = enf_test_rounds(20000, 1000000);
    for (uint32_t round = 0; round < rounds; round++) {
        memcpy(nodes, scene.tree.nodes, node_bytes);
        memcpy(blocks, scene.tree.blocks, block_bytes);
        bool in_nodes = enf_test_chance(&rng, 2);
        uint8_t *bytes = in_nodes ? (uint8_t *)nodes : (uint8_t *)blocks;
        size_t at = enf_test_below(&rng, (uint32_t)(in_nodes ? node_bytes : block_bytes));
        bytes[at] = (uint8_t)enf_test_u32(&rng);
        EnfKdTree tree = {nodes, blocks, scene.tree.node_count, scene.tree.block_count};
        if (enf_test_chance(&rng, 20)) {
            tree.node_count = enf_test_below(&rng, tree.node_count);
        }
        if (enf_kd_check(&tree, 200, NULL)) {
            refused++;
            continue;
        }
        EnfPyramid pyramid = random_pyramid(&rng);
        enf_kd_query(&tree, &pyramid, found_items, ITEMS_MAX, NULL);
        EnfBox3f box = random_box(&rng, RANDOM, 0);
        enf_kd_overlap(&tree, box, found_items, ITEMS_MAX);
    }
    assert_in_range(refused, rounds / 4, rounds);
    free(nodes);
    free(blocks);
    free_scene(&scene);
}

/* A chain deeper than any stack is refused. */
static void test_check_depth(void **state) {
    (void)state;
    for (uint32_t depth = ENF_KD_MAX_DEPTH - 1; depth <= ENF_KD_MAX_DEPTH + 1; depth++) {
        EnfKdNode nodes[2 * ENF_KD_MAX_DEPTH + 8];
        EnfKdBlock blocks[ENF_KD_MAX_DEPTH + 8];
        uint32_t count = 2 * depth + 1, leaf = 0;
        for (uint32_t i = 0; i < count; i++) { /* inner nodes 0..depth-1, then all the leaves, deepest first */
            bool inner = i < depth;
            nodes[i] = (EnfKdNode){{0, 0, 0}, inner ? count - 1 - i + 0 : leaf, {1, 1, 1}, inner ? 0 : 1};
            if (!inner) {
                EnfKdBlock *b = &blocks[leaf++];
                for (int lane = 0; lane < ENF_KD_BLOCK; lane++) {
                    b->min_x[lane] = b->min_y[lane] = b->min_z[lane] = lane ? FLT_MAX : 0.0f;
                    b->max_x[lane] = b->max_y[lane] = b->max_z[lane] = lane ? -FLT_MAX : 1.0f;
                    b->item[lane] = lane ? ENF_NONE : 0;
                }
            }
        }
        EnfKdTree tree = {nodes, blocks, count, leaf};
        EnfError error = {0};
        EnfResult result = enf_kd_check(&tree, 1, &error);
        if (depth <= ENF_KD_MAX_DEPTH) {
            assert_int_equal(result, ENF_OK);
            EnfPyramid halves = {1, {1}, {0}, {0}, {-0.5f}};
            assert_int_equal(enf_kd_query(&tree, &halves, found_items, ITEMS_MAX, NULL), leaf);
            assert_int_equal(enf_kd_overlap(&tree, (EnfBox3f){{0, 0, 0}, {1, 1, 1}}, found_items, ITEMS_MAX), leaf);
        } else {
            assert_int_equal(result, ENF_ERROR_RANGE);
        }
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_queries),
    cmocka_unit_test(test_nan_keeps),
    cmocka_unit_test(test_capacity),
    cmocka_unit_test(test_ray_order),
    cmocka_unit_test(test_build_deterministic),
    cmocka_unit_test(test_build_item_numbers),
    cmocka_unit_test(test_build_refuses),
    cmocka_unit_test(test_build_without_memory),
    cmocka_unit_test(test_build_time),
    cmocka_unit_test(test_query_time),
    cmocka_unit_test(test_check_corrupt),
    cmocka_unit_test(test_check_depth),
};

ENF_TEST_MAIN(tests)
