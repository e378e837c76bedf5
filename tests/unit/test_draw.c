/* engine/draw: the canonical order, merged ranges, exact offsets, the projection, and no heap call in a warm frame. */
#include "harness/purse.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <enfilade/draw.h>
#include <enfilade/tolerances.h>

#include "draw/order.h"

enum { CELLS = 40, MATERIALS = 12, CLUSTERS = 400, NODRAW = 7 };

/* A map of random clusters: enough of one for draw, which reads cells, clusters and materials only. */
typedef struct Fixture {
    EnfCell cells[CELLS];
    EnfMaterial materials[MATERIALS];
    EnfCluster clusters[CLUSTERS];
    EnfVisEntry entries[2 * CLUSTERS + 1];
    EnfCamera camera;
    EnfMap map;
    EnfVisSet set;
} Fixture;

static double on_grid(EnfTestRng *rng, double extent, double step) {
    return floor(enf_test_double(rng, -extent, extent) / step) * step;
}

static void make_cells(Fixture *fixture, EnfTestRng *rng) {
    for (uint32_t i = 0; i < CELLS; i++) {
        for (int k = 0; k < 3; k++) {
            fixture->cells[i].origin[k] = on_grid(rng, 100.0, ENF_ORIGIN_STEP);
        }
    }
    for (uint32_t i = 0; i < MATERIALS; i++) {
        fixture->materials[i].alpha_mode = i % 3;
        fixture->materials[i].flags = i == NODRAW ? (uint32_t)ENF_MATERIAL_NODRAW : 0u;
    }
}

/* Clusters ascend by (cell, material), as the compiler writes them. */
static void make_clusters(Fixture *fixture, EnfTestRng *rng) {
    uint32_t index = 0;
    for (uint32_t i = 0; i < CLUSTERS; i++) {
        EnfCluster *c = &fixture->clusters[i];
        c->cell = i / (CLUSTERS / CELLS);
        c->material = (i % (CLUSTERS / CELLS)) * MATERIALS / (CLUSTERS / CELLS);
        c->index_first = index;
        c->index_count = 3 * (1 + enf_test_below(rng, 5));
        index += c->index_count;
        for (int k = 0; k < 3; k++) {
            c->min[k] = enf_test_float(rng, -10.0f, 10.0f);
            c->max[k] = c->min[k] + enf_test_float(rng, 0.0f, 3.0f);
        }
    }
}

static Fixture *make_fixture(EnfTestRng *rng) {
    Fixture *fixture = calloc(1, sizeof *fixture);
    assert_non_null(fixture);
    make_cells(fixture, rng);
    make_clusters(fixture, rng);
    fixture->map.cells = fixture->cells;
    fixture->map.cells_count = CELLS;
    fixture->map.materials = fixture->materials;
    fixture->map.materials_count = MATERIALS;
    fixture->map.clusters = fixture->clusters;
    fixture->map.clusters_count = CLUSTERS;
    EnfCamera camera = {{1.0 / 3.0, 1.7, -2.0 / 7.0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, 0.8, 0.6, 640, 480};
    fixture->camera = camera;
    fixture->set.cameras = &fixture->camera;
    fixture->set.space_count = 1;
    fixture->set.entries = fixture->entries;
    return fixture;
}

/* Each cluster with a chance of 1 in `odds` (1: all); some seen by two visits, as at the grain of primitives. */
static void see(Fixture *fixture, EnfTestRng *rng, uint32_t odds) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < CLUSTERS; i++) {
        for (uint32_t visit = 0; enf_test_chance(rng, odds) && visit < 2; visit++) {
            EnfVisEntry entry = {i, 0, visit};
            fixture->entries[count++] = entry;
        }
    }
    fixture->set.entry_count = count;
}

/* The clusters of a list in the order in which their triangles are drawn. */
static uint32_t expand(const Fixture *fixture, const EnfDrawList *list, uint32_t *out) {
    uint32_t count = 0;
    for (uint32_t b = 0; b < list->batch_count; b++) {
        const EnfDrawBatch *batch = &list->batches[b];
        for (uint32_t r = batch->range_first; r < batch->range_first + batch->range_count; r++) {
            uint32_t cluster = list->ranges[r].cluster, left = list->ranges[r].index_count;
            assert_int_equal(list->ranges[r].index_first, fixture->clusters[cluster].index_first);
            while (left) {
                assert_true(left >= fixture->clusters[cluster].index_count);
                assert_int_equal(fixture->clusters[cluster].material, batch->material);
                left -= fixture->clusters[cluster].index_count;
                out[count++] = cluster++;
            }
        }
    }
    return count;
}

static bool is_subsequence(const uint32_t *part, uint32_t part_count, const uint32_t *all, uint32_t all_count) {
    uint32_t matched = 0;
    for (uint32_t i = 0; i < all_count && matched < part_count; i++) {
        matched += all[i] == part[matched];
    }
    return matched == part_count;
}

/* Adds "drawn iff seen and not NODRAW" and the counts of the list. */
static void check_complete(const Fixture *fixture, const EnfDrawList *list, const uint32_t *drawn, uint32_t count) {
    bool expected[CLUSTERS] = {false}, found[CLUSTERS] = {false}, cells[CELLS] = {false};
    for (uint32_t i = 0; i < fixture->set.entry_count; i++) {
        uint32_t cluster = fixture->entries[i].cluster;
        expected[cluster] = fixture->clusters[cluster].material != NODRAW;
    }
    uint32_t triangles = 0;
    for (uint32_t i = 0; i < count; i++) {
        assert_false(found[drawn[i]]);
        found[drawn[i]] = true;
        triangles += fixture->clusters[drawn[i]].index_count / 3;
    }
    assert_memory_equal(expected, found, sizeof expected);
    assert_int_equal(list->cluster_count, count);
    assert_int_equal(list->triangle_count, triangles);
    for (uint32_t i = 0; i < list->cell_count; i++) {
        assert_true(i == 0 || list->cells[i].cell > list->cells[i - 1].cell);
        cells[list->cells[i].cell] = true;
    }
    for (uint32_t i = 0; i < count; i++) {
        assert_true(cells[fixture->clusters[drawn[i]].cell]);
    }
}

static void culled_lists_are_subsequences(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    for (uint32_t round = 0; round < enf_test_rounds(50, 2000); round++) {
        Fixture *fixture = make_fixture(&rng);
        EnfDraw *draw;
        assert_int_equal(enf_draw_create(&draw, &fixture->map, NULL, NULL), ENF_OK);
        uint32_t all[CLUSTERS], part[CLUSTERS];
        see(fixture, &rng, 1);
        const EnfDrawList *list = enf_draw_build(draw, &fixture->set, 0.02, NULL, 1.0);
        uint32_t all_count = expand(fixture, list, all);
        check_complete(fixture, list, all, all_count);
        see(fixture, &rng, 1 + enf_test_below(&rng, 20));
        list = enf_draw_build(draw, &fixture->set, 0.02, NULL, 1.0);
        uint32_t part_count = expand(fixture, list, part);
        check_complete(fixture, list, part, part_count);
        assert_true(is_subsequence(part, part_count, all, all_count));
        enf_draw_destroy(draw);
        free(fixture);
    }
}

static double distance2(const Fixture *fixture, uint32_t cluster) {
    const EnfCluster *c = &fixture->clusters[cluster];
    const double *o = fixture->cells[c->cell].origin;
    EnfVec3 to = {o[0] + 0.5 * ((double)c->min[0] + (double)c->max[0]) - fixture->camera.eye_ws.x,
                  o[1] + 0.5 * ((double)c->min[1] + (double)c->max[1]) - fixture->camera.eye_ws.y,
                  o[2] + 0.5 * ((double)c->min[2] + (double)c->max[2]) - fixture->camera.eye_ws.z};
    return enf_dot(to, to);
}

static void blended_clusters_come_last_and_back_to_front(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    Fixture *fixture = make_fixture(&rng);
    EnfDraw *draw;
    assert_int_equal(enf_draw_create(&draw, &fixture->map, NULL, NULL), ENF_OK);
    see(fixture, &rng, 1);
    const EnfDrawList *list = enf_draw_build(draw, &fixture->set, 0.02, NULL, 1.0);
    double last = (double)INFINITY;
    uint32_t material = 0;
    for (uint32_t b = 0; b < list->batch_count; b++) {
        const EnfDrawBatch *batch = &list->batches[b];
        bool blended = fixture->materials[batch->material].alpha_mode == ENF_ALPHA_BLEND;
        assert_int_equal(blended, b >= list->opaque_batch_count);
        /* Opaque materials ascend, then masked ones. */
        uint32_t rank = fixture->materials[batch->material].alpha_mode * MATERIALS + batch->material;
        assert_true(blended || b == 0 || rank > material);
        material = rank;
        for (uint32_t r = 0; blended && r < batch->range_count; r++) {
            double d = distance2(fixture, list->ranges[batch->range_first + r].cluster);
            assert_true(d <= last);
            last = d;
        }
    }
    enf_draw_destroy(draw);
    free(fixture);
}

static void other_spaces_are_left_out(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(3);
    Fixture *fixture = make_fixture(&rng);
    EnfDraw *draw;
    assert_int_equal(enf_draw_create(&draw, &fixture->map, NULL, NULL), ENF_OK);
    EnfVisEntry entries[] = {{3, 0, 0}, {5, 1, 1}, {0, 2, 2}};
    memcpy(fixture->entries, entries, sizeof entries);
    fixture->set.entry_count = 3;
    const EnfDrawList *list = enf_draw_build(draw, &fixture->set, 0.02, NULL, 1.0);
    assert_int_equal(list->cluster_count, 1);
    assert_int_equal(list->ranges[0].cluster, 3);
    fixture->set.entry_count = 0;
    list = enf_draw_build(draw, &fixture->set, 0.02, NULL, 1.0);
    assert_int_equal(list->batch_count, 0);
    assert_int_equal(list->cell_count, 0);
    enf_draw_destroy(draw);
    free(fixture);
}

/* What the shader does, in the same order. */
static float exact_sum(float position, float offset) {
    volatile float sum = position + offset;
    return sum;
}

/* A point of the world grid, stored in two cells, is one number relative to the eye's grid point. */
static void shared_vertices_are_bit_equal(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(4);
    Fixture *fixture = make_fixture(&rng);
    EnfDraw *draw;
    assert_int_equal(enf_draw_create(&draw, &fixture->map, NULL, NULL), ENF_OK);
    for (uint32_t round = 0; round < enf_test_rounds(2000, 100000); round++) {
        double base = on_grid(&rng, round % 2 ? 100.0 : 1e6, ENF_ORIGIN_STEP);
        double vertex = base + on_grid(&rng, 900.0, ENF_GRID_STEP);
        double eye = base + enf_test_double(&rng, -900.0, 900.0);
        for (uint32_t i = 0; i < 2; i++) {
            fixture->cells[i].origin[0] = base + on_grid(&rng, 900.0, ENF_ORIGIN_STEP);
            EnfVisEntry entry = {i * (CLUSTERS / CELLS), 0, 0};
            fixture->entries[i] = entry;
        }
        fixture->set.entry_count = 2;
        fixture->camera.eye_ws.x = eye;
        const EnfDrawList *list = enf_draw_build(draw, &fixture->set, 0.02, NULL, 1.0);
        assert_int_equal(list->cell_count, 2);
        float sums[2];
        for (uint32_t i = 0; i < 2; i++) {
            sums[i] = exact_sum((float)(vertex - fixture->cells[i].origin[0]), list->cells[i].offset[0]);
        }
        assert_memory_equal(&sums[0], &sums[1], sizeof sums[0]);
        assert_true(fabs((double)list->eye_fraction[0]) <= 0.5 * ENF_GRID_STEP);
        double error = (double)sums[0] - (double)list->eye_fraction[0] - (vertex - eye);
        assert_true(fabs(error) <= 1e-9 * (1.0 + fabs(eye))); /* the fraction's rounding, and the eye's own */
    }
    enf_draw_destroy(draw);
    free(fixture);
}

static void the_projection_has_no_far_plane(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(5);
    Fixture *fixture = make_fixture(&rng);
    EnfDraw *draw;
    assert_int_equal(enf_draw_create(&draw, &fixture->map, NULL, NULL), ENF_OK);
    const float *m = enf_draw_build(draw, &fixture->set, 0.25, NULL, 1.0)->clip_from_eye;
    /* Right edge, upper edge and a depth of 0.25, 1 and 1e6 along −Z. */
    const double depths[] = {0.25, 1.0, 1e6}, depth_ndc[] = {-1.0, 0.5, 1.0};
    for (int i = 0; i < 3; i++) {
        double d = depths[i];
        double p[4] = {0.8 * d, 0.6 * d, -d, 1.0}, clip[4] = {0};
        for (int k = 0; k < 16; k++) {
            clip[k % 4] += (double)m[k] * p[k / 4];
        }
        assert_true(fabs(clip[0] / clip[3] - 1.0) < 1e-6);
        assert_true(fabs(clip[1] / clip[3] - 1.0) < 1e-6);
        assert_true(fabs(clip[2] / clip[3] - depth_ndc[i]) < 1e-6);
    }
    enf_draw_destroy(draw);
    free(fixture);
}

/* ---- heap ------------------------------------------------------------------------------------------------------- */

static void a_frame_makes_no_heap_call(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(6);
    Fixture *fixture = make_fixture(&rng);
    Purse purse = purse_with(PURSE_FULL);
    EnfAllocator allocator = purse_allocator(&purse);
    EnfDraw *draw;
    assert_int_equal(enf_draw_create(&draw, &fixture->map, &allocator, NULL), ENF_OK);
    uint32_t before = purse.calls;
    for (uint32_t round = 0; round < 20; round++) {
        see(fixture, &rng, 1 + round);
        enf_draw_build(draw, &fixture->set, 0.02, NULL, 1.0);
    }
    assert_int_equal(purse.calls, before);
    enf_draw_destroy(draw);
    purse_assert_whole(&purse);
    free(fixture);
}

/* At each site in turn one call fails, and those after it are served. */
static void every_failing_allocation_is_reported(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(7);
    Fixture *fixture = make_fixture(&rng);
    EnfResult result = ENF_ERROR_MEMORY;
    uint32_t site = 0;
    for (; result != ENF_OK; site++) {
        Purse purse = {.budget = site, .once = true};
        EnfAllocator allocator = purse_allocator(&purse);
        EnfDraw *draw = NULL;
        EnfError error = {0};
        result = enf_draw_create(&draw, &fixture->map, &allocator, &error);
        assert_true(result == ENF_OK ? draw != NULL : draw == NULL && error.code == ENF_ERROR_MEMORY);
        assert_int_equal(purse.refused, result != ENF_OK);
        enf_draw_destroy(draw);
        purse_assert_whole(&purse);
    }
    assert_true(site > 7);
    free(fixture);
}

static void keys_are_sorted(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(8);
    for (uint32_t round = 0; round < enf_test_rounds(200, 5000); round++) {
        EnfDrawKey keys[64];
        uint32_t count = enf_test_below(&rng, 65);
        uint64_t sum = 0;
        for (uint32_t i = 0; i < count; i++) {
            keys[i].key = enf_test_below(&rng, 10);
            keys[i].index = i ^ 5u;
            sum += keys[i].key * 1000 + keys[i].index;
        }
        enf_draw_sort(keys, count);
        for (uint32_t i = 0; i < count; i++) {
            sum -= keys[i].key * 1000 + keys[i].index;
            assert_true(i == 0 || keys[i - 1].key < keys[i].key ||
                        (keys[i - 1].key == keys[i].key && keys[i - 1].index < keys[i].index));
        }
        assert_true(sum == 0);
    }
    assert_true(enf_draw_far_first(2.0) < enf_draw_far_first(1.0));
    assert_true(enf_draw_far_first(1.0) < enf_draw_far_first(0.0));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(culled_lists_are_subsequences),
    cmocka_unit_test(blended_clusters_come_last_and_back_to_front),
    cmocka_unit_test(other_spaces_are_left_out),
    cmocka_unit_test(shared_vertices_are_bit_equal),
    cmocka_unit_test(the_projection_has_no_far_plane),
    cmocka_unit_test(a_frame_makes_no_heap_call),
    cmocka_unit_test(every_failing_allocation_is_reported),
    cmocka_unit_test(keys_are_sorted),
};

ENF_TEST_MAIN(tests)
