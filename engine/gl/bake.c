/* Makes the light of a map from its lamps: at vertices, and on large flat surfaces at the texels of a light map. Walls and
 * lamps of a map never move, and Lambert's law does not ask for the eye; so a fragment need not evaluate a single light,
 * and a frame costs the same in a hall of a hundred candles. Computed from the map alone: the same for every view. */
#include "gl/bake.h"

#include <math.h>
#include <string.h>

typedef struct Rgb {
    float r, g, b;
} Rgb;

typedef struct Baker {
    EnfGlBake *out;
    const EnfMap *map;
    EnfGlCharts charts;
} Baker;

/* ---- ambient ---------------------------------------------------------------------------------------------------- */

static bool has_vertex_colors(const EnfMap *map) {
    for (uint32_t i = 0; i < map->vertices_count; i++) {
        if (map->vertices[i].color != UINT32_MAX) {
            return true;
        }
    }
    return false;
}

/* Lamps need a little fill; vertex colours without lamps are baked light, to be shown as it is; with neither, a bright
 * hemisphere tells walls, floor and ceiling apart. */
static EnfGlAmbient choose_ambient(const EnfMap *map) {
    static const EnfGlAmbient fill = {{0.070f, 0.065f, 0.062f}, {0.115f, 0.120f, 0.135f}, {0.012f, 0.010f, 0.008f}};
    static const EnfGlAmbient baked = {{1.05f, 1.05f, 1.05f}, {1.30f, 1.30f, 1.30f}, {0.07f, 0.00f, 0.04f}};
    static const EnfGlAmbient plain = {{0.50f, 0.48f, 0.46f}, {0.98f, 1.00f, 1.04f}, {0.16f, 0.05f, 0.09f}};
    return map->lights_count ? fill : has_vertex_colors(map) ? baked : plain;
}

static Rgb ambient_at(const EnfGlAmbient *a, const float n[3]) {
    float up = n[1] * 0.5f + 0.5f, sum[3];
    for (int i = 0; i < 3; i++) {
        float key = n[0] * a->key[0] + n[1] * a->key[1] + n[2] * a->key[2];
        sum[i] = a->ground[i] + (a->sky[i] - a->ground[i]) * up + key;
    }
    Rgb rgb = {sum[0], sum[1], sum[2]};
    return rgb;
}

/* ---- lamps ------------------------------------------------------------------------------------------------------ */

static float clamp01(float x) {
    return x < 0.0f ? 0.0f : x > 1.0f ? 1.0f : x;
}

static float dot3(const float *a, const float *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* How much of a light comes through its windows to p; where two overlap, it counts once. */
static float through(const EnfGlLights *lights, uint32_t windows, const float p[3]) {
    uint32_t first = windows >> 6, last = first + (windows & 63u);
    float lit = 0.0f, window = 1.0f;
    for (uint32_t i = first; i <= last; i++) {
        const float *plane = lights->planes[i];
        if (plane[0] == 0.0f && plane[1] == 0.0f && plane[2] == 0.0f) {
            lit = lit > window ? lit : window;
            window = 1.0f;
        } else {
            float inside = clamp01(dot3(plane, p) + plane[3]);
            window = window < inside ? window : inside;
        }
    }
    return lit;
}

/* Inverse square with glTF's range window and spot cone, times the cosine (KHR_lights_punctual). A surface nearer than a
 * foot gets what it would get there: lamps are no points. `two_sided`: lit from behind as well. */
static float shine(const EnfGlLights *lights, const EnfGlLight *light, const float p[3], const float n[3], bool two_sided) {
    float to[3] = {light->position[0] - p[0], light->position[1] - p[1], light->position[2] - p[2]};
    float d2 = dot3(to, to), in_range = d2 * light->inverse_range2, cosine = dot3(n, to);
    cosine = two_sided && cosine < 0.0f ? -cosine : cosine;
    if (cosine <= 0.0f || in_range >= 1.0f) {
        return 0.0f;
    }
    float nearness = 1.0f / sqrtf(d2 > 0.1f ? d2 : 0.1f);
    float cone = clamp01(light->aim_offset - dot3(light->aim, to) * nearness);
    float k = cosine * nearness * (1.0f - in_range * in_range) * nearness * nearness * cone * cone;
    return k > 0.0f ? k * through(lights, light->windows, p) : 0.0f;
}

static uint32_t encode(const Baker *baker, float light) {
    /* A soft shoulder: linear in the dark, and no lamp burns its wall white. */
    float shown = baker->out->lamps ? light * (1.0f + 0.1f * light) / (1.0f + 0.35f * light) : light;
    return (uint32_t)(sqrtf(clamp01(0.5f * shown)) * 255.0f + 0.5f);
}

static uint32_t light_at(const Baker *baker, uint32_t cluster, const float p[3], const float n[3]) {
    const EnfMaterial *material = &baker->map->materials[baker->map->clusters[cluster].material];
    bool two_sided = (material->flags & ENF_MATERIAL_DOUBLE_SIDED) != 0;
    Rgb sum = ambient_at(&baker->out->ambient, n);
    uint32_t first = baker->out->lights.cluster_lists[cluster] >> 8;
    uint32_t last = first + (baker->out->lights.cluster_lists[cluster] & 255u);
    for (uint32_t i = first; i <= last; i++) {
        const EnfGlLight *light = &baker->out->lights.lights[i];
        float k = shine(&baker->out->lights, light, p, n, two_sided);
        sum.r += light->color[0] * k;
        sum.g += light->color[1] * k;
        sum.b += light->color[2] * k;
    }
    return encode(baker, sum.r) | encode(baker, sum.g) << 8 | encode(baker, sum.b) << 16 | 0xff000000u;
}

/* ---- vertices --------------------------------------------------------------------------------------------------- */

/* Three signed fields of 10 bits, as GL_INT_2_10_10_10_REV. */
static void unpack_normal(uint32_t packed, float n[3]) {
    float length2 = 0.0f;
    for (int i = 0; i < 3; i++) {
        int32_t field = (int32_t)(packed >> (10 * i) & 1023u);
        n[i] = (float)(field >= 512 ? field - 1024 : field);
        length2 += n[i] * n[i];
    }
    float scale = length2 > 0.0f ? 1.0f / sqrtf(length2) : 0.0f;
    for (int i = 0; i < 3; i++) {
        n[i] *= scale;
    }
}

static void place_vertex(const Baker *baker, uint32_t vertex, const EnfGlChart *chart) {
    const float *p = baker->map->vertices[vertex].position;
    for (uint32_t i = 0; i < 2; i++) {
        float texel = p[enf_gl_chart_axis(chart, i)] / chart->step - (float)chart->first[i];
        baker->out->vertex_uv[vertex][i] = (uint16_t)(32.0f * ((float)chart->place[i] + texel + 0.5f) + 0.5f);
    }
    baker->out->vertex_light[vertex] = UINT32_MAX;
}

static void light_vertex(const Baker *baker, uint32_t cluster, uint32_t vertex) {
    const EnfVertex *v = &baker->map->vertices[vertex];
    uint32_t chart = baker->charts.vertex_charts[vertex];
    if (chart != ENF_NONE) {
        place_vertex(baker, vertex, &baker->charts.charts[chart]);
        return;
    }
    float n[3];
    unpack_normal(v->normal, n);
    baker->out->vertex_light[vertex] = light_at(baker, cluster, v->position, n);
    baker->out->vertex_uv[vertex][0] = baker->out->vertex_uv[vertex][1] = 32; /* the middle of the full block */
}

static void light_vertices(const Baker *baker) {
    for (uint32_t c = 0; c < baker->map->clusters_count; c++) {
        const EnfCluster *cluster = &baker->map->clusters[c];
        for (uint32_t i = 0; i < cluster->vertex_count; i++) {
            light_vertex(baker, c, cluster->vertex_first + i);
        }
    }
}

/* ---- texels ----------------------------------------------------------------------------------------------------- */

static void light_chart(const Baker *baker, const EnfGlChart *chart) {
    uint32_t u = enf_gl_chart_axis(chart, 0), v = enf_gl_chart_axis(chart, 1), w = chart->axis;
    for (uint32_t y = 0; y < chart->size[1]; y++) {
        for (uint32_t x = 0; x < chart->size[0]; x++) {
            float p[3];
            p[u] = (float)(chart->first[0] + (int32_t)x) * chart->step;
            p[v] = (float)(chart->first[1] + (int32_t)y) * chart->step;
            p[w] = (chart->distance - chart->normal[u] * p[u] - chart->normal[v] * p[v]) / chart->normal[w];
            uint32_t light = light_at(baker, chart->cluster, p, chart->normal);
            size_t at = (size_t)(chart->place[1] + y) * baker->out->width + chart->place[0] + x;
            memcpy(baker->out->texels + 4 * at, &light, 4);
        }
    }
}

static void light_texels(const Baker *baker) {
    for (uint32_t y = 0; y < 2; y++) {
        memset(baker->out->texels + (size_t)y * baker->out->width * 4, 255, 8);
    }
    for (uint32_t i = 0; i < baker->charts.count; i++) {
        light_chart(baker, &baker->charts.charts[i]);
    }
}

/* ---- build ------------------------------------------------------------------------------------------------------ */

static EnfResult allocate(EnfGlBake *bake, const Baker *baker, EnfError *error) {
    bake->width = baker->charts.width;
    bake->height = baker->charts.height;
    bake->vertex_count = baker->map->vertices_count;
    bake->has_charts = baker->charts.count > 0;
    bake->vertex_light = enf_alloc(NULL, (size_t)bake->vertex_count + 1, sizeof *bake->vertex_light);
    bake->vertex_uv = enf_alloc(NULL, (size_t)bake->vertex_count + 1, sizeof *bake->vertex_uv);
    bake->texels = enf_alloc(NULL, (size_t)bake->width * bake->height, 4);
    if (!bake->vertex_light || !bake->vertex_uv || !bake->texels) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for the light of the map");
    }
    return ENF_OK;
}

EnfResult enf_gl_bake_build(EnfGlBake *bake, const EnfMap *map, uint32_t max_size, EnfError *error) {
    ENF_ASSERT(bake && map);
    memset(bake, 0, sizeof *bake);
    Baker baker = {.out = bake, .map = map};
    bake->ambient = choose_ambient(map);
    bake->lamps = map->lights_count > 0;
    EnfResult result = enf_gl_lights_build(&bake->lights, map, error);
    EnfResult charted = enf_gl_charts_build(&baker.charts, map, max_size, result == ENF_OK ? error : NULL);
    result = result != ENF_OK ? result : charted;
    if (result == ENF_OK && (result = allocate(bake, &baker, error)) == ENF_OK) {
        light_vertices(&baker);
        light_texels(&baker);
    }
    enf_gl_charts_free(&baker.charts);
    return result;
}

void enf_gl_bake_free(EnfGlBake *bake) {
    enf_free(NULL, bake->vertex_light, (size_t)bake->vertex_count + 1, sizeof *bake->vertex_light);
    enf_free(NULL, bake->vertex_uv, (size_t)bake->vertex_count + 1, sizeof *bake->vertex_uv);
    enf_free(NULL, bake->texels, (size_t)bake->width * bake->height, 4);
    enf_gl_lights_free(&bake->lights);
    memset(bake, 0, sizeof *bake);
}
