/* Makes charts: triangles of a cluster that share vertices, lie in one plane and are large. Their light varies inside of
 * triangles, so it is kept in texels; all others are small or curved, and light at their vertices is enough. */
#include "gl/charts.h"

#include <stdlib.h>
#include <string.h>

static const float STEP = 0.25f;                /* metres a texel, to begin with */
static const float LARGE = 0.75f;               /* metres: what extends less has no chart */
static const float FLAT = 1.0f / 512.0f;        /* metres from the plane: 8 steps of the map's grid */
static const float FARTHEST = 8192.0f;          /* metres from the cell's origin: beyond, no light map is worth its texels */
enum { CHART_MAX = 256, PLAIN = 2, TRIES = 8 }; /* texels: longest side; side of the block that is no chart's */

typedef struct Builder {
    EnfGlCharts *out;
    const EnfMap *map;
    uint8_t *users;    /* clusters that use a vertex: 0, 1 or more */
    uint32_t *parents; /* of the vertices of the cluster at hand: a forest whose trees are its parts */
    uint32_t parent_capacity;
    EnfError *error;
} Builder;

/* ---- parts: triangles that share vertices ----------------------------------------------------------------------- */

static uint32_t find_root(uint32_t *parents, uint32_t i) {
    while (parents[i] != i) {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    return i;
}

/* The lower root wins, so a part is named by its lowest vertex. */
static void join(uint32_t *parents, uint32_t a, uint32_t b) {
    a = find_root(parents, a);
    b = find_root(parents, b);
    parents[a > b ? a : b] = a > b ? b : a;
}

static void find_parts(Builder *builder, const EnfCluster *c) {
    for (uint32_t i = 0; i < c->vertex_count; i++) {
        builder->parents[i] = i;
    }
    for (uint32_t i = 0; i < c->index_count; i += 3) {
        const uint32_t *t = &builder->map->indices[c->index_first + i];
        join(builder->parents, t[0] - c->vertex_first, t[1] - c->vertex_first);
        join(builder->parents, t[0] - c->vertex_first, t[2] - c->vertex_first);
    }
}

/* ---- planes ----------------------------------------------------------------------------------------------------- */

static EnfVec3 position(const EnfMap *map, uint32_t vertex) {
    const float *p = map->vertices[vertex].position;
    return enf_v3((double)p[0], (double)p[1], (double)p[2]);
}

/* Twice the area of a triangle, along its normal. */
static EnfVec3 area_of(const EnfMap *map, const uint32_t *t) {
    EnfVec3 a = position(map, t[0]);
    return enf_cross(enf_sub(position(map, t[1]), a), enf_sub(position(map, t[2]), a));
}

/* The plane and box of a part; false if it is not flat or too small. */
static bool measure(const Builder *builder, const EnfCluster *c, uint32_t part, EnfGlChart *chart, EnfBox3 *box) {
    const EnfMap *map = builder->map;
    EnfVec3 largest = {0, 0, 0}, point = {0, 0, 0};
    *box = enf_box3_empty();
    for (uint32_t i = 0; i < c->index_count; i += 3) {
        const uint32_t *t = &map->indices[c->index_first + i];
        if (builder->parents[t[0] - c->vertex_first] != part) {
            continue;
        }
        EnfVec3 area = area_of(map, t);
        if (enf_dot(area, area) > enf_dot(largest, largest)) {
            largest = area;
            point = position(map, t[0]);
        }
        for (int k = 0; k < 3; k++) {
            if (builder->users[t[k]] > 1) {
                return false;
            }
            *box = enf_box3_add(*box, position(map, t[k]));
        }
    }
    EnfVec3 n = enf_normalize(largest);
    chart->normal[0] = (float)n.x;
    chart->normal[1] = (float)n.y;
    chart->normal[2] = (float)n.z;
    chart->distance = (float)enf_dot(n, point);
    EnfVec3 size = enf_sub(box->max, box->min);
    EnfVec3 far = {(double)FARTHEST, (double)FARTHEST, (double)FARTHEST};
    EnfBox3 near = {enf_scale(far, -1.0), far};
    if (!enf_box3_contains(near, box->min) || !enf_box3_contains(near, box->max)) {
        return false;
    }
    return enf_dot(size, size) >= (double)(LARGE * LARGE) && enf_dot(n, n) > 0.5;
}

static float height_over(const EnfGlChart *chart, const float *p) {
    return chart->normal[0] * p[0] + chart->normal[1] * p[1] + chart->normal[2] * p[2] - chart->distance;
}

/* Do all triangles of the part lie in the plane, and face as it does? */
static bool is_flat(const Builder *builder, const EnfCluster *c, uint32_t part, const EnfGlChart *chart) {
    const EnfMap *map = builder->map;
    EnfVec3 n = enf_v3((double)chart->normal[0], (double)chart->normal[1], (double)chart->normal[2]);
    for (uint32_t i = 0; i < c->index_count; i += 3) {
        const uint32_t *t = &map->indices[c->index_first + i];
        if (builder->parents[t[0] - c->vertex_first] != part) {
            continue;
        }
        if (enf_dot(area_of(map, t), n) < -1e-6) {
            return false;
        }
        for (int k = 0; k < 3; k++) {
            float height = height_over(chart, map->vertices[t[k]].position);
            if (height > FLAT || height < -FLAT) {
                return false;
            }
        }
    }
    return true;
}

/* ---- charts ----------------------------------------------------------------------------------------------------- */

static double along(EnfVec3 v, uint32_t axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static int32_t lattice(double x, float step, bool up) {
    double k = x / (double)step;
    int32_t whole = (int32_t)k;
    return up ? whole + ((double)whole < k) : whole - ((double)whole > k);
}

/* Lays the lattice over the box; coarser, if the chart would be too long. */
static void lay_lattice(EnfGlChart *chart, const EnfBox3 *box, float step) {
    chart->axis = 0;
    for (uint32_t i = 1; i < 3; i++) {
        float a = chart->normal[i], b = chart->normal[chart->axis];
        chart->axis = a * a > b * b ? i : chart->axis;
    }
    chart->step = 0.5f * step;
    do {
        chart->step *= 2.0f;
        for (uint32_t i = 0; i < 2; i++) {
            uint32_t axis = enf_gl_chart_axis(chart, i);
            chart->first[i] = lattice(along(box->min, axis), chart->step, false);
            chart->size[i] = (uint32_t)(lattice(along(box->max, axis), chart->step, true) - chart->first[i]) + 1;
        }
    } while (chart->size[0] > CHART_MAX || chart->size[1] > CHART_MAX);
}

static bool push_chart(Builder *builder, const EnfGlChart *chart) {
    EnfGlCharts *out = builder->out;
    if (out->count == out->capacity) {
        uint32_t wanted = out->capacity ? 2 * out->capacity : 256;
        EnfGlChart *grown = enf_realloc(NULL, out->charts, out->capacity, wanted, sizeof *grown);
        if (!grown) {
            return false;
        }
        out->charts = grown;
        out->capacity = wanted;
    }
    out->charts[out->count++] = *chart;
    return true;
}

/* Gives the part of a cluster whose lowest vertex is `part` a chart, if it deserves one. */
static bool chart_part(Builder *builder, uint32_t cluster, uint32_t part, float step) {
    const EnfCluster *c = &builder->map->clusters[cluster];
    EnfGlChart chart = {.cluster = cluster};
    EnfBox3 box;
    if (!measure(builder, c, part, &chart, &box) || !is_flat(builder, c, part, &chart)) {
        return true;
    }
    lay_lattice(&chart, &box, step);
    for (uint32_t i = part; i < c->vertex_count; i++) {
        if (builder->parents[i] == part) {
            builder->out->vertex_charts[c->vertex_first + i] = builder->out->count;
        }
    }
    return push_chart(builder, &chart);
}

static bool chart_cluster(Builder *builder, uint32_t cluster, float step) {
    const EnfCluster *c = &builder->map->clusters[cluster];
    find_parts(builder, c);
    for (uint32_t i = 0; i < c->vertex_count; i++) {
        builder->parents[i] = find_root(builder->parents, i);
    }
    for (uint32_t i = 0; i < c->vertex_count; i++) {
        if (builder->parents[i] == i && !chart_part(builder, cluster, i, step)) {
            return false;
        }
    }
    return true;
}

/* ---- packing ---------------------------------------------------------------------------------------------------- */

/* Higher charts first, then by number: one order only. */
static int by_height(const void *a, const void *b) {
    const uint64_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* Shelves from left to right, each as high as its first chart. The height may come out too large. */
static bool pack(EnfGlCharts *out, uint32_t width) {
    uint64_t *order = enf_alloc(NULL, (size_t)out->count + 1, sizeof *order);
    if (!order) {
        return false;
    }
    for (uint32_t i = 0; i < out->count; i++) {
        order[i] = (uint64_t)(CHART_MAX - out->charts[i].size[1]) << 32 | i;
    }
    qsort(order, out->count, sizeof *order, by_height);
    uint32_t x = PLAIN, y = 0, shelf = PLAIN;
    for (uint32_t i = 0; i < out->count; i++) {
        EnfGlChart *chart = &out->charts[(uint32_t)order[i]];
        if (x + chart->size[0] > width) {
            x = 0;
            y += shelf;
            shelf = 0;
        }
        chart->place[0] = x;
        chart->place[1] = y;
        x += chart->size[0];
        shelf = shelf > chart->size[1] ? shelf : chart->size[1];
    }
    out->width = width;
    out->height = y + shelf;
    enf_free(NULL, order, (size_t)out->count + 1, sizeof *order);
    return true;
}

/* ---- build ------------------------------------------------------------------------------------------------------ */

/* All charts with texels of `step`. */
static bool chart_map(Builder *builder, float step, uint32_t width) {
    EnfGlCharts *out = builder->out;
    memset(out->vertex_charts, 0xff, (size_t)out->vertex_count * sizeof *out->vertex_charts);
    out->count = 0;
    for (uint32_t c = 0; c < builder->map->clusters_count && builder->map->lights_count > 0; c++) {
        if (!chart_cluster(builder, c, step)) {
            return false;
        }
    }
    return pack(out, width);
}

/* How many clusters use each vertex, and the most vertices of one. */
static void count_users(Builder *builder) {
    const EnfMap *map = builder->map;
    for (uint32_t c = 0; c < map->clusters_count; c++) {
        const EnfCluster *cluster = &map->clusters[c];
        for (uint32_t i = 0; i < cluster->vertex_count; i++) {
            uint8_t *users = &builder->users[cluster->vertex_first + i];
            *users = (uint8_t)(*users < 2 ? *users + 1 : 2);
        }
    }
}

static uint32_t most_vertices(const EnfMap *map) {
    uint32_t most = 1;
    for (uint32_t c = 0; c < map->clusters_count; c++) {
        most = map->clusters[c].vertex_count > most ? map->clusters[c].vertex_count : most;
    }
    return most;
}

EnfResult enf_gl_charts_build(EnfGlCharts *charts, const EnfMap *map, uint32_t max_size, EnfError *error) {
    ENF_ASSERT(charts && map && max_size >= CHART_MAX);
    memset(charts, 0, sizeof *charts);
    Builder builder = {.out = charts, .map = map, .parent_capacity = most_vertices(map), .error = error};
    charts->vertex_count = map->vertices_count;
    charts->vertex_charts = enf_alloc(NULL, (size_t)map->vertices_count + 1, sizeof *charts->vertex_charts);
    builder.users = enf_alloc(NULL, (size_t)map->vertices_count + 1, 1);
    builder.parents = enf_alloc(NULL, builder.parent_capacity, sizeof *builder.parents);
    bool good = charts->vertex_charts && builder.users && builder.parents;
    if (good) {
        count_users(&builder);
        float step = STEP;
        charts->height = UINT32_MAX;
        for (int i = 0; i < TRIES && good && charts->height > max_size; i++, step *= 2.0f) {
            good = chart_map(&builder, step, max_size);
        }
        if (good && charts->height > max_size) { /* millions of charts: vertices must do */
            memset(charts->vertex_charts, 0xff, (size_t)map->vertices_count * sizeof *charts->vertex_charts);
            charts->count = 0;
            charts->height = PLAIN;
        }
    }
    enf_free(NULL, builder.users, (size_t)map->vertices_count + 1, 1);
    enf_free(NULL, builder.parents, builder.parent_capacity, sizeof *builder.parents);
    return good ? ENF_OK : enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a light map");
}

void enf_gl_charts_free(EnfGlCharts *charts) {
    enf_free(NULL, charts->charts, charts->capacity, sizeof *charts->charts);
    enf_free(NULL, charts->vertex_charts, (size_t)charts->vertex_count + 1, sizeof *charts->vertex_charts);
    memset(charts, 0, sizeof *charts);
}
