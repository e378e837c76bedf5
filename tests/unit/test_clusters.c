/* Clusters: every triangle once, never too many, bounds tight, positions exact. */
#include "compile/clusters.h"
#include "compile/exact.h"
#include "harness/harness.h"

#include <enfilade/tolerances.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct World {
    EnfSoup soup;
    EnfLayout layout;
    EnfLayoutCell cells[5];
} World;

static int64_t coordinate(EnfTestRng *rng, double span) {
    return (int64_t)floor(enf_test_double(rng, -span, span) * 4096);
}

/* `count` triangles of random cells and materials; some share vertices, some are equal. */
static void make_world(World *world, EnfTestRng *rng, uint32_t count, double span) {
    memset(world, 0, sizeof *world);
    world->layout.cells = world->cells;
    world->layout.cell_count = 5;
    for (uint32_t c = 0; c < 5; c++) {
        world->cells[c].origin = (EnfGrid3){16 * coordinate(rng, span), 16 * coordinate(rng, 1), 16 * coordinate(rng, span)};
    }
    world->soup.vertices = calloc(3 * (size_t)count + 1, sizeof *world->soup.vertices);
    world->soup.triangles = calloc((size_t)count + 1, sizeof *world->soup.triangles);
    for (uint32_t t = 0; t < count; t++) {
        EnfSoupTriangle *triangle = &world->soup.triangles[t];
        uint32_t cell = enf_test_below(rng, 4) + (enf_test_chance(rng, 9) ? 1 : 0); /* cell 0 now and then empty */
        EnfGrid3 origin = world->cells[cell].origin;
        int64_t x = coordinate(rng, 20), y = coordinate(rng, 3), z = coordinate(rng, 20);
        for (uint32_t i = 0; i < 3; i++) {
            EnfSoupVertex *v = &world->soup.vertices[3 * t + i];
            v->p = (EnfGrid3){origin.x + x + (i == 1) * 4096, origin.y + y, origin.z + z + (i == 2) * 4096};
            v->normal[1] = 1;
            v->color[0] = v->color[3] = 1;
            triangle->v[i] = 3 * t + i;
        }
        triangle->cell = cell;
        triangle->material = enf_test_below(rng, 3);
        triangle->node = t;
        if (t > 0 && enf_test_chance(rng, 5)) {
            *triangle = world->soup.triangles[t - 1];
        }
    }
    world->soup.vertex_count = 3 * count;
    world->soup.triangle_count = count;
}

static void free_world(World *world) {
    enf_soup_free(&world->soup);
}

static EnfGrid3 stored(const EnfVertex *v, EnfGrid3 origin) {
    return (EnfGrid3){origin.x + (int64_t)((double)v->position[0] * 4096), origin.y + (int64_t)((double)v->position[1] * 4096),
                      origin.z + (int64_t)((double)v->position[2] * 4096)};
}

/* A triangle's corners, rotated so that the smallest comes first. */
static void corners_of(EnfGrid3 p[3]) {
    uint32_t first = 0;
    for (uint32_t i = 1; i < 3; i++) {
        first = enf_grid_compare(p[i], p[first]) < 0 ? i : first;
    }
    EnfGrid3 rotated[3] = {p[first], p[(first + 1) % 3], p[(first + 2) % 3]};
    memcpy(p, rotated, sizeof rotated);
}

static int compare_corners(const void *left, const void *right) {
    const EnfGrid3 *a = left, *b = right;
    for (int i = 0; i < 3; i++) {
        int order = enf_grid_compare(a[i], b[i]);
        if (order != 0) {
            return order;
        }
    }
    return 0;
}

/* The triangles of a cluster as stored are those of the soup that it names. */
static void check_triangles(const World *world, const EnfClusters *clusters, const EnfCluster *cluster) {
    EnfGrid3 expected[ENF_CLUSTER_TRIANGLES][3], found[ENF_CLUSTER_TRIANGLES][3];
    EnfGrid3 origin = world->cells[cluster->cell].origin;
    uint32_t count = cluster->index_count / 3;
    for (uint32_t t = 0; t < count; t++) {
        const EnfSoupTriangle *triangle = &world->soup.triangles[clusters->triangles[cluster->index_first / 3 + t]];
        assert_int_equal(triangle->cell, cluster->cell);
        assert_int_equal(triangle->material, cluster->material);
        for (uint32_t i = 0; i < 3; i++) {
            uint32_t index = clusters->indices[cluster->index_first + 3 * t + i];
            assert_in_range(index, cluster->vertex_first, cluster->vertex_first + cluster->vertex_count - 1);
            expected[t][i] = world->soup.vertices[triangle->v[i]].p;
            found[t][i] = stored(&clusters->vertices[index], origin);
        }
        corners_of(expected[t]);
        corners_of(found[t]);
    }
    qsort(expected, count, sizeof *expected, compare_corners);
    qsort(found, count, sizeof *found, compare_corners);
    assert_memory_equal(expected, found, count * sizeof *expected);
}

/* Each side of the box is touched, and nothing is outside. */
static void check_bounds(const EnfClusters *clusters, const EnfCluster *cluster) {
    float min[3] = {1e30f, 1e30f, 1e30f}, max[3] = {-1e30f, -1e30f, -1e30f};
    for (uint32_t i = 0; i < cluster->vertex_count; i++) {
        const EnfVertex *v = &clusters->vertices[cluster->vertex_first + i];
        assert_int_equal(v->cell, cluster->cell);
        for (int axis = 0; axis < 3; axis++) {
            min[axis] = fminf(min[axis], v->position[axis]);
            max[axis] = fmaxf(max[axis], v->position[axis]);
        }
    }
    assert_memory_equal(min, cluster->min, sizeof min);
    assert_memory_equal(max, cluster->max, sizeof max);
}

static void check_all(const World *world, const EnfClusters *clusters) {
    uint8_t *seen = calloc((size_t)world->soup.triangle_count + 1, 1);
    uint32_t vertices = 0, indices = 0;
    for (uint32_t i = 0; i < clusters->cluster_count; i++) {
        const EnfCluster *cluster = &clusters->clusters[i], *before = i ? cluster - 1 : cluster;
        assert_in_range(cluster->index_count, 3, 3 * ENF_CLUSTER_TRIANGLES);
        assert_int_equal(cluster->index_first, indices);
        assert_int_equal(cluster->vertex_first, vertices);
        assert_true(before->cell < cluster->cell || (before->cell == cluster->cell && before->material <= cluster->material));
        assert_in_range(i, clusters->cell_first[cluster->cell], clusters->cell_first[cluster->cell + 1] - 1);
        check_triangles(world, clusters, cluster);
        check_bounds(clusters, cluster);
        indices += cluster->index_count;
        vertices += cluster->vertex_count;
    }
    for (uint32_t t = 0; t < world->soup.triangle_count; t++) {
        assert_int_equal(seen[clusters->triangles[t]]++, 0);
    }
    assert_int_equal(indices, 3 * world->soup.triangle_count);
    assert_int_equal(indices, clusters->index_count);
    assert_int_equal(clusters->cell_first[5], clusters->cluster_count);
    free(seen);
}

/* ---- cases ------------------------------------------------------------------------------------------------------ */

static void every_triangle_once(void **state) {
    (void)state;
    static const uint32_t counts[] = {0, 1, 127, 128, 129, 300, 5000};
    EnfTestRng rng = enf_test_rng(1);
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        World world;
        EnfClusters clusters;
        EnfError error;
        make_world(&world, &rng, counts[i], 1000);
        assert_int_equal(enf_clusters_build(&clusters, &world.soup, &world.layout, &error), ENF_OK);
        check_all(&world, &clusters);
        enf_clusters_free(&clusters);
        free_world(&world);
    }
}

/* A thousand triangles on one spot cannot be parted by place, but must be parted. */
static void crowded_triangles_are_parted(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    World world;
    EnfClusters clusters;
    EnfError error;
    make_world(&world, &rng, 1000, 10);
    for (uint32_t t = 0; t < 1000; t++) {
        world.soup.triangles[t] = world.soup.triangles[0];
    }
    assert_int_equal(enf_clusters_build(&clusters, &world.soup, &world.layout, &error), ENF_OK);
    check_all(&world, &clusters);
    assert_in_range(clusters.cluster_count, 8, 20);
    assert_in_range(clusters.clusters[0].vertex_count, 1, 3);
    enf_clusters_free(&clusters);
    free_world(&world);
}

/* Of a long corridor, each cluster takes a part: their boxes hardly overlap. */
static void clusters_are_compact(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(3);
    World world;
    EnfClusters clusters;
    EnfError error;
    make_world(&world, &rng, 4000, 10);
    for (uint32_t t = 0; t < 4000; t++) {
        world.soup.triangles[t].cell = 0;
        world.soup.triangles[t].material = 0;
        world.soup.triangles[t].v[0] = 3 * t;
        world.soup.triangles[t].v[1] = 3 * t + 1;
        world.soup.triangles[t].v[2] = 3 * t + 2;
        int64_t x = (int64_t)enf_test_below(&rng, 4096 * 400);
        for (uint32_t i = 0; i < 3; i++) {
            world.soup.vertices[3 * t + i].p = (EnfGrid3){x + (i == 1) * 400, 0, (i == 2) * 400};
        }
    }
    memset(&world.cells[0].origin, 0, sizeof world.cells[0].origin);
    assert_int_equal(enf_clusters_build(&clusters, &world.soup, &world.layout, &error), ENF_OK);
    check_all(&world, &clusters);
    double length = 0;
    for (uint32_t i = 0; i < clusters.cluster_count; i++) {
        length += (double)(clusters.clusters[i].max[0] - clusters.clusters[i].min[0]);
    }
    assert_true(length < 1.1 * 400);
    assert_true(clusters.cluster_count < 80);
    enf_clusters_free(&clusters);
    free_world(&world);
}

/* Far from its cell's origin a position is rounded, and the bounds still hold the exact one. */
static void far_positions_stay_inside(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(4);
    World world;
    EnfClusters clusters;
    EnfError error;
    make_world(&world, &rng, 300, 10);
    for (uint32_t i = 0; i < world.soup.vertex_count; i++) {
        world.soup.vertices[i].p.x += (INT64_C(1) << 34) + (int64_t)enf_test_below(&rng, 5000);
    }
    assert_int_equal(enf_clusters_build(&clusters, &world.soup, &world.layout, &error), ENF_OK);
    for (uint32_t i = 0; i < clusters.cluster_count; i++) {
        const EnfCluster *cluster = &clusters.clusters[i];
        for (uint32_t k = 0; k < cluster->index_count; k++) {
            const EnfSoupTriangle *t = &world.soup.triangles[clusters.triangles[(cluster->index_first + k) / 3]];
            int64_t x = world.soup.vertices[t->v[k % 3]].p.x - world.cells[cluster->cell].origin.x;
            assert_true((double)cluster->min[0] <= (double)x * ENF_GRID_STEP);
            assert_true((double)cluster->max[0] >= (double)x * ENF_GRID_STEP);
            float packed = clusters.vertices[clusters.indices[cluster->index_first + k]].position[0];
            assert_true(packed >= cluster->min[0] && packed <= cluster->max[0]);
        }
    }
    enf_clusters_free(&clusters);
    free_world(&world);
}

static void same_input_same_bytes(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(5);
    World world;
    EnfClusters first, second;
    EnfError error;
    make_world(&world, &rng, 2000, 100);
    assert_int_equal(enf_clusters_build(&first, &world.soup, &world.layout, &error), ENF_OK);
    assert_int_equal(enf_clusters_build(&second, &world.soup, &world.layout, &error), ENF_OK);
    assert_int_equal(first.vertex_count, second.vertex_count);
    assert_memory_equal(first.vertices, second.vertices, first.vertex_count * sizeof *first.vertices);
    assert_memory_equal(first.indices, second.indices, first.index_count * sizeof *first.indices);
    assert_memory_equal(first.clusters, second.clusters, first.cluster_count * sizeof *first.clusters);
    enf_clusters_free(&first);
    enf_clusters_free(&second);
    free_world(&world);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_triangle_once),   cmocka_unit_test(crowded_triangles_are_parted),
    cmocka_unit_test(clusters_are_compact),  cmocka_unit_test(far_positions_stay_inside),
    cmocka_unit_test(same_input_same_bytes),
};
ENF_TEST_MAIN(tests)
