/* EnfClusters from EnfSoup: triangles sorted by (cell, material), parted into compact runs, and each run made a small mesh. */
#include "compile/clusters.h"

#include "compile/array.h"
#include "compile/exact.h"
#include "compile/pack.h"

#include <enfilade/tolerances.h>
#include <float.h>
#include <meshoptimizer.h>
#include <stdlib.h>
#include <string.h>

enum { CLUSTER_CORNERS = 3 * ENF_CLUSTER_TRIANGLES, TABLE_SIZE = 1024 };

typedef struct Builder {
    EnfClusters *out;
    const EnfSoup *soup;
    const EnfLayout *layout;
    uint32_t vertex_capacity, cluster_capacity;
    EnfVertex local[CLUSTER_CORNERS]; /* distinct vertices of the cluster at hand */
    uint32_t local_count;
    uint16_t table[TABLE_SIZE]; /* hash table over `local`: number + 1, 0 is free */
} Builder;

/* ---- order ------------------------------------------------------------------------------------------------------ */

/* A stable counting sort of `from` into `to` by a key below `key_count`; `first` has room for key_count + 1. */
typedef uint32_t KeyFn(const EnfSoupTriangle *triangle);
static void counting_sort(const EnfSoup *soup, KeyFn *key, uint32_t key_count, const uint32_t *from, uint32_t *to,
                          uint32_t *first) {
    memset(first, 0, ((size_t)key_count + 1) * sizeof *first);
    for (uint32_t i = 0; i < soup->triangle_count; i++) {
        first[key(&soup->triangles[i]) + 1]++;
    }
    for (uint32_t k = 0; k < key_count; k++) {
        first[k + 1] += first[k];
    }
    for (uint32_t i = 0; i < soup->triangle_count; i++) {
        uint32_t triangle = from ? from[i] : i;
        to[first[key(&soup->triangles[triangle])]++] = triangle;
    }
}

static uint32_t material_key(const EnfSoupTriangle *triangle) {
    return triangle->material;
}

static uint32_t cell_key(const EnfSoupTriangle *triangle) {
    return triangle->cell;
}

/* Numbers of all triangles by (cell, material), then by the order of the soup. */
static bool sort_triangles(const Builder *builder) {
    const EnfSoup *soup = builder->soup;
    uint32_t material_count = 0;
    for (uint32_t i = 0; i < soup->triangle_count; i++) {
        uint32_t material = soup->triangles[i].material;
        material_count = material >= material_count ? material + 1 : material_count;
    }
    uint32_t key_count = material_count > builder->layout->cell_count ? material_count : builder->layout->cell_count;
    uint32_t *by_material = malloc(((size_t)soup->triangle_count + 1) * sizeof *by_material);
    uint32_t *first = malloc(((size_t)key_count + 1) * sizeof *first);
    bool ok = by_material && first;
    if (ok) {
        counting_sort(soup, material_key, material_count, NULL, by_material, first);
        counting_sort(soup, cell_key, builder->layout->cell_count, by_material, builder->out->triangles, first);
    }
    free(by_material);
    free(first);
    return ok;
}

/* ---- vertices --------------------------------------------------------------------------------------------------- */

/* Relative to the cell's origin: exact within 4,096 m of it, else rounded to the nearest float. */
static EnfVertex pack_vertex(const EnfSoupVertex *v, EnfGrid3 origin, uint32_t cell) {
    EnfGrid3 d = enf_grid_sub(v->p, origin);
    EnfVertex packed = {
        {(float)((double)d.x * ENF_GRID_STEP), (float)((double)d.y * ENF_GRID_STEP), (float)((double)d.z * ENF_GRID_STEP)},
        enf_pack_normal(v->normal),
        {v->uv[0] + 0.0f, v->uv[1] + 0.0f}, /* no −0: equal values have equal bytes */
        enf_pack_color(v->color),
        cell};
    return packed;
}

/* The number of `vertex` among the cluster's distinct ones. */
static uint32_t intern(Builder *builder, const EnfVertex *vertex) {
    uint64_t hash = enf_hash64(ENF_HASH_START, vertex, sizeof *vertex);
    uint32_t slot = (uint32_t)(hash ^ hash >> 32) % TABLE_SIZE;
    while (builder->table[slot] != 0) {
        uint32_t found = builder->table[slot] - 1u;
        /* Bits, as they are hashed. NOLINTNEXTLINE(bugprone-suspicious-memory-comparison) */
        if (memcmp(&builder->local[found], vertex, sizeof *vertex) == 0) {
            return found;
        }
        slot = (slot + 1) % TABLE_SIZE;
    }
    builder->table[slot] = (uint16_t)(builder->local_count + 1);
    builder->local[builder->local_count] = *vertex;
    return builder->local_count++;
}

/* ---- clusters --------------------------------------------------------------------------------------------------- */

/* Bounds outward of the exact positions; where these are exact in float, tight. */
static void add_bounds(EnfCluster *cluster, EnfGrid3 p, EnfGrid3 origin) {
    EnfGrid3 d = enf_grid_sub(p, origin);
    const double exact[3] = {(double)d.x * ENF_GRID_STEP, (double)d.y * ENF_GRID_STEP, (double)d.z * ENF_GRID_STEP};
    for (int axis = 0; axis < 3; axis++) {
        float low = enf_round_down(exact[axis]), high = enf_round_up(exact[axis]);
        cluster->min[axis] = low < cluster->min[axis] ? low : cluster->min[axis];
        cluster->max[axis] = high > cluster->max[axis] ? high : cluster->max[axis];
    }
}

static bool reserve_cluster(Builder *builder) {
    EnfClusters *out = builder->out;
    return enf_array_reserve(&out->vertices, &builder->vertex_capacity, (uint64_t)out->vertex_count + CLUSTER_CORNERS,
                             sizeof *out->vertices) &&
           enf_array_reserve(&out->clusters, &builder->cluster_capacity, (uint64_t)out->cluster_count + 1,
                             sizeof *out->clusters);
}

/* Makes a cluster of triangles[0..count): appends it, its vertices and its indices. */
static bool append_cluster(Builder *builder, const uint32_t *triangles, uint32_t count) {
    EnfClusters *out = builder->out;
    const EnfSoupTriangle *head = &builder->soup->triangles[triangles[0]];
    EnfGrid3 origin = builder->layout->cells[head->cell].origin;
    EnfCluster cluster = {.min = {FLT_MAX, FLT_MAX, FLT_MAX},
                          .max = {-FLT_MAX, -FLT_MAX, -FLT_MAX},
                          .cell = head->cell,
                          .material = head->material,
                          .index_first = out->index_count,
                          .index_count = 3 * count,
                          .vertex_first = out->vertex_count,
                          .node = head->node};
    unsigned int indices[CLUSTER_CORNERS], ordered[CLUSTER_CORNERS];
    if (!reserve_cluster(builder)) {
        return false;
    }
    builder->local_count = 0;
    memset(builder->table, 0, sizeof builder->table);
    for (uint32_t i = 0; i < 3 * count; i++) {
        const EnfSoupVertex *v = &builder->soup->vertices[builder->soup->triangles[triangles[i / 3]].v[i % 3]];
        EnfVertex packed = pack_vertex(v, origin, head->cell);
        indices[i] = intern(builder, &packed);
        add_bounds(&cluster, v->p, origin);
    }
    meshopt_optimizeVertexCache(ordered, indices, 3 * (size_t)count, builder->local_count);
    cluster.vertex_count = (uint32_t)meshopt_optimizeVertexFetch(out->vertices + out->vertex_count, ordered, 3 * (size_t)count,
                                                                 builder->local, builder->local_count, sizeof *builder->local);
    for (uint32_t i = 0; i < 3 * count; i++) {
        out->indices[out->index_count++] = cluster.vertex_first + ordered[i];
    }
    out->vertex_count += cluster.vertex_count;
    out->clusters[out->cluster_count++] = cluster;
    return true;
}

/* Parts one group (a cell's triangles of one material) and appends its clusters. */
static bool append_group(Builder *builder, uint32_t *triangles, uint32_t count, uint8_t *starts) {
    enf_cluster_partition(builder->soup, triangles, count, starts);
    for (uint32_t first = 0, end; first < count; first = end) {
        for (end = first + 1; end < count && !starts[end]; end++) {
        }
        if (!append_cluster(builder, triangles + first, end - first)) {
            return false;
        }
    }
    return true;
}

static bool append_groups(Builder *builder, uint8_t *starts) {
    EnfClusters *out = builder->out;
    const EnfSoupTriangle *soup = builder->soup->triangles;
    uint32_t cell = 0;
    for (uint32_t first = 0, end; first < builder->soup->triangle_count; first = end) {
        const EnfSoupTriangle *head = &soup[out->triangles[first]];
        for (end = first; end < builder->soup->triangle_count; end++) {
            const EnfSoupTriangle *t = &soup[out->triangles[end]];
            if (t->cell != head->cell || t->material != head->material) {
                break;
            }
        }
        for (; cell <= head->cell; cell++) {
            out->cell_first[cell] = out->cluster_count;
        }
        if (!append_group(builder, out->triangles + first, end - first, starts)) {
            return false;
        }
    }
    for (; cell <= builder->layout->cell_count; cell++) {
        out->cell_first[cell] = out->cluster_count;
    }
    return true;
}

EnfResult enf_clusters_build(EnfClusters *clusters, const EnfSoup *soup, const EnfLayout *layout, EnfError *error) {
    memset(clusters, 0, sizeof *clusters);
    Builder *builder = calloc(1, sizeof *builder);
    uint8_t *starts = malloc((size_t)soup->triangle_count + 1);
    size_t triangle_room = (size_t)soup->triangle_count + 1;
    clusters->triangles = malloc(triangle_room * sizeof *clusters->triangles);
    clusters->indices = malloc(triangle_room * 3 * sizeof *clusters->indices);
    clusters->cell_first = malloc(((size_t)layout->cell_count + 1) * sizeof *clusters->cell_first);
    bool ok = builder && starts && clusters->triangles && clusters->indices && clusters->cell_first;
    if (ok) {
        builder->out = clusters;
        builder->soup = soup;
        builder->layout = layout;
        ok = sort_triangles(builder) && append_groups(builder, starts);
    }
    free(builder);
    free(starts);
    if (!ok) {
        enf_clusters_free(clusters);
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for the clusters of %u triangles",
                             soup->triangle_count);
    }
    return ENF_OK;
}

void enf_clusters_free(EnfClusters *clusters) {
    free(clusters->vertices);
    free(clusters->indices);
    free(clusters->clusters);
    free(clusters->triangles);
    free(clusters->cell_first);
    memset(clusters, 0, sizeof *clusters);
}
