/* Makes EnfGlLights from the light references of a map. A reference says through which opening a light comes into a cell;
 * the references of one light in one cell are gathered into one light with several windows, so a point that two windows
 * overlap in is lit once. Then each cluster gets the lights whose range and windows touch its box: few. The result depends
 * on the map alone, never on what is visible: shading is the same culled and unculled. */
#include "gl/lights.h"

#include <stdlib.h>
#include <string.h>

enum { LIGHT_LIMIT = 1 << 24, PLANE_LIMIT = 1 << 26 }; /* bits of a list and of EnfGlLight.windows */

static const float WINDOW_SOFT = 0.125f; /* half the width of a window's soft edge, metres: half a texel of a light map */
static const float MIDDLE = 0.75f;       /* what the median lit cluster gets, facing its lights */
static const float FAINTEST = 0.015f;    /* where a light may fade out: below a step of a dark picture */
static const double FAR = 16384.0;       /* metres to a directional light */

typedef struct Builder {
    EnfGlLights *out;
    const EnfMap *map;
    EnfGlLight *cell_lights; /* of the cell at hand */
    uint32_t *cell_numbers;  /* of these lights, in the map */
    uint32_t *order;         /* its references, grouped by light */
    uint32_t *list, *last;   /* of the cluster at hand, and of the one before */
    float *brightness;       /* a lit cluster each */
    uint32_t ref_capacity, cell_light_count, list_count, last_count, bright_count;
    float exposure;
    EnfError *error;
} Builder;

/* ---- growing arrays --------------------------------------------------------------------------------------------- */

/* Room for one more element of `size` bytes; false if memory or `limit` is exhausted. */
static bool reserve(Builder *builder, void **array, uint32_t used, uint32_t *capacity, size_t size, uint32_t limit) {
    if (used < *capacity) {
        return true;
    }
    uint32_t wanted = *capacity ? 2 * *capacity : 256;
    if (used >= limit) {
        enf_error_set(builder->error, ENF_ERROR_SIZE, UINT64_MAX, "the lights of this map need more than %u entries", limit);
        return false;
    }
    void *grown = enf_realloc(NULL, *array, *capacity, wanted, size);
    if (!grown) {
        enf_error_set(builder->error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for lights");
        return false;
    }
    *array = grown;
    *capacity = wanted;
    return true;
}

static bool push_light(Builder *builder, const EnfGlLight *light) {
    EnfGlLights *out = builder->out;
    void *array = out->lights;
    if (!reserve(builder, &array, out->light_count, &out->light_capacity, sizeof *light, LIGHT_LIMIT)) {
        return false;
    }
    out->lights = array;
    out->lights[out->light_count++] = *light;
    return true;
}

static bool push_plane(Builder *builder, const float plane[4]) {
    EnfGlLights *out = builder->out;
    void *array = out->planes;
    if (!reserve(builder, &array, out->plane_count, &out->plane_capacity, sizeof *out->planes, PLANE_LIMIT)) {
        return false;
    }
    out->planes = array;
    memcpy(out->planes[out->plane_count++], plane, sizeof *out->planes);
    return true;
}

/* ---- a light as a cell sees it ---------------------------------------------------------------------------------- */

/* Planes of `count` references; 0 if one of them has no window, for then all is lit, or if there are too many. */
static uint32_t count_planes(const EnfLightRef *refs, const uint32_t *order, uint32_t count) {
    uint64_t planes = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (refs[order[i]].plane_count == 0) {
            return 0;
        }
        planes += (uint64_t)refs[order[i]].plane_count + 1;
    }
    return planes <= ENF_GL_LIGHT_PLANES_MAX ? (uint32_t)planes : 0;
}

/* A plane through the light (or near it), made relative to the cell and scaled to the soft edge. */
static bool push_window_plane(Builder *builder, const EnfPlane4f *from, const float position[3]) {
    const float scale = 0.5f / WINDOW_SOFT;
    float d = from->d - (from->n[0] * position[0] + from->n[1] * position[1] + from->n[2] * position[2]);
    float plane[4] = {from->n[0] * scale, from->n[1] * scale, from->n[2] * scale, d * scale + 0.5f};
    return push_plane(builder, plane);
}

/* Sets light->windows from its references. */
static bool push_windows(Builder *builder, EnfGlLight *light, const EnfLightRef *refs, const uint32_t *order, uint32_t count) {
    static const float end[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    uint32_t first = builder->out->plane_count;
    light->windows = 0; /* plane 0: all is lit */
    if (count_planes(refs, order, count) == 0) {
        return true;
    }
    for (uint32_t i = 0; i < count; i++) {
        const EnfPlane4f *planes = &builder->map->light_planes[refs[order[i]].plane_first];
        for (uint32_t p = 0; p < refs[order[i]].plane_count; p++) {
            if (!push_window_plane(builder, &planes[p], light->position)) {
                return false;
            }
        }
        if (!push_plane(builder, end)) {
            return false;
        }
    }
    light->windows = first << 6 | (builder->out->plane_count - first - 1);
    return true;
}

/* glTF's spot cone as one multiply and add (KHR_lights_punctual, "Inner and Outer Cone Angles"). */
static void set_aim(EnfGlLight *out, const EnfLight *light) {
    memset(out->aim, 0, sizeof out->aim);
    out->aim_offset = 1.0f;
    if (light->kind == ENF_LIGHT_SPOT) {
        float width = light->inner_cos - light->outer_cos;
        float scale = 1.0f / (width > 0.001f ? width : 0.001f);
        for (int i = 0; i < 3; i++) {
            out->aim[i] = light->direction[i] * scale;
        }
        out->aim_offset = -light->outer_cos * scale;
    }
}

static bool add_light(Builder *builder, const EnfCell *cell, const EnfLightRef *refs, const uint32_t *order, uint32_t count) {
    const EnfLight *light = &builder->map->lights[refs[order[0]].light];
    builder->cell_numbers[builder->cell_light_count] = refs[order[0]].light;
    EnfGlLight *out = &builder->cell_lights[builder->cell_light_count++];
    bool directional = light->kind == ENF_LIGHT_DIRECTIONAL;
    for (int i = 0; i < 3; i++) {
        double away = directional ? -(double)light->direction[i] * FAR : light->position[i] - cell->origin[i];
        out->position[i] = (float)away;
        out->color[i] = light->color[i] * (directional ? (float)(FAR * FAR) : 1.0f);
    }
    bool ranged = !directional && light->range > 0.0f;
    out->inverse_range2 = ranged ? 1.0f / (light->range * light->range) : 0.0f;
    set_aim(out, light);
    return push_windows(builder, out, refs, order, count);
}

/* The lights of a cell: its references by light, in the order of their first mention. */
static bool gather_cell(Builder *builder, const EnfCell *cell) {
    const EnfLightRef *refs = builder->map->light_refs + cell->light_first;
    uint32_t *order = builder->order;
    uint32_t left = cell->light_count;
    builder->cell_light_count = 0;
    for (uint32_t i = 0; i < left; i++) {
        order[i] = i;
    }
    while (left) {
        uint32_t light = refs[order[0]].light;
        uint32_t same = 0;
        for (uint32_t i = 0; i < left; i++) { /* stable partition by rotation: lists are short */
            if (refs[order[i]].light == light) {
                uint32_t moved = order[i];
                memmove(&order[same + 1], &order[same], (i - same) * sizeof *order);
                order[same++] = moved;
            }
        }
        if (!add_light(builder, cell, refs, order, same)) {
            return false;
        }
        order += same;
        left -= same;
    }
    return true;
}

/* ---- does a light touch a cluster? ------------------------------------------------------------------------------ */

float enf_gl_light_distance2(const EnfGlLight *light, const float min[3], const float max[3]) {
    const float *p = light->position;
    float sum = 0.0f;
    for (int i = 0; i < 3; i++) {
        float d = p[i] < min[i] ? min[i] - p[i] : p[i] > max[i] ? p[i] - max[i] : 0.0f;
        sum += d * d;
    }
    return sum;
}

static bool is_end(const float plane[4]) {
    return plane[0] == 0.0f && plane[1] == 0.0f && plane[2] == 0.0f;
}

/* Is some point of the box inside a plane or its soft edge? */
static bool box_touches_plane(const float min[3], const float max[3], const float plane[4]) {
    float most = plane[3];
    for (int i = 0; i < 3; i++) {
        most += plane[i] * (plane[i] > 0.0f ? max[i] : min[i]);
    }
    return most > -1e-3f;
}

static bool windows_touch(const EnfGlLights *out, uint32_t windows, const float min[3], const float max[3]) {
    uint32_t first = windows >> 6, last = first + (windows & 63u);
    bool inside = true;
    for (uint32_t i = first; i <= last; i++) {
        if (!is_end(out->planes[i])) {
            inside = inside && box_touches_plane(min, max, out->planes[i]);
        } else if (inside) {
            return true;
        } else {
            inside = true;
        }
    }
    return false;
}

bool enf_gl_light_touches(const EnfGlLights *lights, const EnfGlLight *light, const float min[3], const float max[3]) {
    return enf_gl_light_distance2(light, min, max) * light->inverse_range2 < 1.0f &&
           windows_touch(lights, light->windows, min, max);
}

static bool touches(const EnfGlLights *out, const EnfGlLight *light, const EnfCluster *c) {
    return enf_gl_light_touches(out, light, c->min, c->max);
}

/* ---- exposure --------------------------------------------------------------------------------------------------- */

static float luminance(const EnfGlLight *light) {
    return 0.2126f * light->color[0] + 0.7152f * light->color[1] + 0.0722f * light->color[2];
}

float enf_gl_light_brightness(const EnfGlLight *light, float distance2) {
    float in_range = distance2 * light->inverse_range2;
    float window = 1.0f - in_range * in_range;
    return window > 0.0f ? luminance(light) * window / distance2 : 0.0f;
}

/* How bright a light would be at the middle of a cluster that faces it. */
static float brightness(const EnfGlLight *light, const EnfCluster *c) {
    float distance2 = 0.25f; /* half a metre: no surface counts as nearer */
    for (int i = 0; i < 3; i++) {
        float d = 0.5f * (c->min[i] + c->max[i]) - light->position[i];
        distance2 += d * d;
    }
    return enf_gl_light_brightness(light, distance2);
}

static bool measure_cell(Builder *builder, const EnfCell *cell) {
    for (uint32_t c = cell->cluster_first; c < cell->cluster_first + cell->cluster_count; c++) {
        const EnfCluster *cluster = &builder->map->clusters[c];
        float sum = 0.0f;
        for (uint32_t i = 0; i < builder->cell_light_count; i++) {
            const EnfGlLight *light = &builder->cell_lights[i];
            sum += touches(builder->out, light, cluster) ? brightness(light, cluster) : 0.0f;
        }
        if (sum > 0.0f) {
            builder->brightness[builder->bright_count++] = sum;
        }
    }
    builder->out->plane_count = 1; /* all but the end that lights everything: the second pass makes them again */
    return true;
}

static int by_value(const void *a, const void *b) {
    float x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

/* Files give candela, watts or anything: what half of the lit clusters exceed becomes a middling grey. */
static void expose(Builder *builder) {
    builder->exposure = 1.0f;
    if (builder->bright_count) {
        qsort(builder->brightness, builder->bright_count, sizeof *builder->brightness, by_value);
        builder->exposure = MIDDLE / builder->brightness[builder->bright_count / 2];
    }
}

/* Applies the exposure, and lets lights fade out smoothly where they would be too faint to see: ranges that files give or
 * the compiler derives are generous, and each light on a list costs the same, bright or faint. */
static void expose_light(const Builder *builder, EnfGlLight *light) {
    for (int i = 0; i < 3; i++) {
        light->color[i] *= builder->exposure;
    }
    float faint = FAINTEST / (luminance(light) + 1e-30f); /* 1 / (distance at which it is that faint)² */
    light->inverse_range2 = faint > light->inverse_range2 ? faint : light->inverse_range2;
}

/* ---- lists ------------------------------------------------------------------------------------------------------ */

static bool repeats_last(const Builder *builder) {
    return builder->list_count == builder->last_count &&
           memcmp(builder->list, builder->last, builder->list_count * sizeof *builder->list) == 0;
}

/* The list of a cluster; its neighbour's, if they are equal. */
static bool list_cluster(Builder *builder, uint32_t c, uint32_t *shared) {
    EnfGlLights *out = builder->out;
    builder->list_count = 0;
    for (uint32_t i = 0; i < builder->cell_light_count && builder->list_count < ENF_GL_LIGHTS_MAX; i++) {
        if (touches(out, &builder->cell_lights[i], &builder->map->clusters[c])) {
            builder->list[builder->list_count++] = i;
        }
    }
    if (builder->list_count == 0) {
        out->cluster_lists[c] = 0; /* the dark light alone */
        return true;
    }
    if (!repeats_last(builder)) {
        *shared = out->light_count << 8 | (builder->list_count - 1);
        for (uint32_t i = 0; i < builder->list_count; i++) {
            if (!push_light(builder, &builder->cell_lights[builder->list[i]])) {
                return false;
            }
        }
        memcpy(builder->last, builder->list, builder->list_count * sizeof *builder->list);
        builder->last_count = builder->list_count;
    }
    out->cluster_lists[c] = *shared;
    return true;
}

/* The lights of a cell for what moves there. */
static bool keep_cell(Builder *builder) {
    EnfGlLights *out = builder->out;
    for (uint32_t i = 0; i < builder->cell_light_count && builder->map->meshes_count > 0; i++) {
        void *array = out->cell_lights;
        if (!reserve(builder, &array, out->cell_light_count, &out->cell_light_capacity, sizeof *out->cell_lights,
                     LIGHT_LIMIT)) {
            return false;
        }
        out->cell_lights = array;
        EnfGlCellLight kept = {builder->cell_lights[i], builder->cell_numbers[i]};
        out->cell_lights[out->cell_light_count++] = kept;
    }
    return true;
}

static bool list_cell(Builder *builder, const EnfCell *cell) {
    uint32_t shared = 0;
    builder->last_count = 0;
    for (uint32_t i = 0; i < builder->cell_light_count; i++) {
        expose_light(builder, &builder->cell_lights[i]);
    }
    builder->out->cell_firsts[cell - builder->map->cells] = builder->out->cell_light_count;
    if (!keep_cell(builder)) {
        return false;
    }
    for (uint32_t c = cell->cluster_first; c < cell->cluster_first + cell->cluster_count; c++) {
        if (!list_cluster(builder, c, &shared)) {
            return false;
        }
    }
    return true;
}

/* ---- build ------------------------------------------------------------------------------------------------------ */

static bool each_cell(Builder *builder, bool (*visit)(Builder *, const EnfCell *)) {
    for (uint32_t i = 0; i < builder->map->cells_count; i++) {
        const EnfCell *cell = &builder->map->cells[i];
        if (!gather_cell(builder, cell) || !visit(builder, cell)) {
            return false;
        }
    }
    return true;
}

static bool build(Builder *builder) {
    static const float end[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    static const EnfGlLight dark = {.aim_offset = 1.0f};
    if (!push_light(builder, &dark) || !push_plane(builder, end) || !each_cell(builder, measure_cell)) {
        return false;
    }
    expose(builder);
    if (!each_cell(builder, list_cell)) {
        return false;
    }
    builder->out->cell_firsts[builder->map->cells_count] = builder->out->cell_light_count;
    return true;
}

static uint32_t most_refs(const EnfMap *map) {
    uint32_t most = 0;
    for (uint32_t i = 0; i < map->cells_count; i++) {
        most = map->cells[i].light_count > most ? map->cells[i].light_count : most;
    }
    return most;
}

/* X(array, count): working memory. */
#define ENF_GL_LIGHTS_WORK(X)                                                                                                  \
    X(cell_lights, builder.ref_capacity)                                                                                       \
    X(cell_numbers, builder.ref_capacity)                                                                                      \
    X(order, builder.ref_capacity)                                                                                             \
    X(list, ENF_GL_LIGHTS_MAX)                                                                                                 \
    X(last, ENF_GL_LIGHTS_MAX)                                                                                                 \
    X(brightness, (size_t)map->clusters_count + 1)

EnfResult enf_gl_lights_build(EnfGlLights *lights, const EnfMap *map, EnfError *error) {
    ENF_ASSERT(lights && map);
    memset(lights, 0, sizeof *lights);
    EnfError own = {0};
    Builder builder = {.out = lights, .map = map, .ref_capacity = most_refs(map) + 1, .error = error ? error : &own};
    builder.error->code = ENF_OK;
    lights->cluster_lists = enf_alloc(NULL, (size_t)map->clusters_count + 1, sizeof *lights->cluster_lists);
    lights->cluster_count = map->clusters_count;
    lights->cell_firsts = enf_alloc(NULL, (size_t)map->cells_count + 1, sizeof *lights->cell_firsts);
    lights->cell_count = map->cells_count;
    bool done = lights->cluster_lists && lights->cell_firsts;
#define ENF_GL_LIGHTS_MAKE(array, count)                                                                                       \
    builder.array = enf_alloc(NULL, (count), sizeof *builder.array);                                                           \
    done = done && builder.array;
    ENF_GL_LIGHTS_WORK(ENF_GL_LIGHTS_MAKE)
#undef ENF_GL_LIGHTS_MAKE
    if (!done) {
        enf_error_set(builder.error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for lights");
    }
    done = done && build(&builder);
#define ENF_GL_LIGHTS_FREE(array, count) enf_free(NULL, builder.array, (count), sizeof *builder.array);
    ENF_GL_LIGHTS_WORK(ENF_GL_LIGHTS_FREE)
#undef ENF_GL_LIGHTS_FREE
    return done ? ENF_OK : builder.error->code;
}

void enf_gl_lights_free(EnfGlLights *lights) {
    enf_free(NULL, lights->lights, lights->light_capacity, sizeof *lights->lights);
    enf_free(NULL, lights->planes, lights->plane_capacity, sizeof *lights->planes);
    enf_free(NULL, lights->cluster_lists, (size_t)lights->cluster_count + 1, sizeof *lights->cluster_lists);
    enf_free(NULL, lights->cell_lights, lights->cell_light_capacity, sizeof *lights->cell_lights);
    enf_free(NULL, lights->cell_firsts, (size_t)lights->cell_count + 1, sizeof *lights->cell_firsts);
    memset(lights, 0, sizeof *lights);
}
