/* Makes EnfGlLights from the light references of a map. A reference says through which opening a light comes into a cell;
 * the references of one light in one cell are gathered into one record, so a point that two windows overlap in is lit
 * once. Then each cluster gets the records whose range and windows touch its box: a fragment loops over few lights. The
 * result depends on the map alone, never on what is visible, so shading is the same culled and unculled. */
#include "gl/lights.h"

#include <stdlib.h>
#include <string.h>

enum { RECORD_LIMIT = 1 << 22, PLANE_LIMIT = 1 << 24, ITEM_LIMIT = 1 << 24 }; /* exact in a float; 24 bits of a list */

/* Half the width of a window's soft edge in metres; the shader's 10.0 is 1 / (2 × this). */
static const float WINDOW_SOFT = 0.05f;

typedef struct Builder {
    EnfGlLights *lights;
    const EnfMap *map;
    EnfError *error;
} Builder;

/* ---- growing arrays --------------------------------------------------------------------------------------------- */

/* Room for `count` more elements of `size` bytes; false if memory or `limit` is exhausted. */
static bool reserve(Builder *builder, void **array, uint32_t used, uint32_t *capacity, size_t size, uint32_t limit) {
    if (used < *capacity) {
        return true;
    }
    uint32_t wanted = *capacity ? 2 * *capacity : 256;
    if (used >= limit) {
        enf_error_set(builder->error, ENF_ERROR_SIZE, UINT64_MAX, "the lights of this map need more than %u records", limit);
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

static float *push_record(Builder *builder) {
    EnfGlLights *l = builder->lights;
    void *array = l->records;
    if (!reserve(builder, &array, l->record_count, &l->record_capacity, ENF_GL_LIGHT_FLOATS * sizeof(float), RECORD_LIMIT)) {
        return NULL;
    }
    l->records = array;
    return &l->records[(size_t)ENF_GL_LIGHT_FLOATS * l->record_count++];
}

static bool push_plane(Builder *builder, const EnfPlane4f *plane) {
    EnfGlLights *l = builder->lights;
    void *array = l->planes;
    if (!reserve(builder, &array, l->plane_count, &l->plane_capacity, 4 * sizeof(float), PLANE_LIMIT)) {
        return false;
    }
    l->planes = array;
    memcpy(&l->planes[(size_t)4 * l->plane_count++], plane, 4 * sizeof(float));
    return true;
}

static bool push_item(Builder *builder, uint32_t record) {
    EnfGlLights *l = builder->lights;
    void *array = l->items;
    if (!reserve(builder, &array, l->item_count, &l->item_capacity, sizeof *l->items, ITEM_LIMIT)) {
        return false;
    }
    l->items = array;
    l->items[l->item_count++] = record;
    return true;
}

/* ---- records: a light as a cell sees it ------------------------------------------------------------------------- */

/* The planes of `count` references of one light; none if one of them has no window, for then all is lit. */
static bool push_windows(Builder *builder, const EnfLightRef *refs, const uint32_t *order, uint32_t count) {
    static const EnfPlane4f end = {{0.0f, 0.0f, 0.0f}, 0.0f};
    for (uint32_t i = 0; i < count; i++) {
        if (refs[order[i]].plane_count == 0) {
            return true;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        const EnfLightRef *ref = &refs[order[i]];
        for (uint32_t p = 0; p < ref->plane_count; p++) {
            const EnfPlane4f *plane = &builder->map->light_planes[ref->plane_first + p];
            bool degenerate = plane->n[0] == 0.0f && plane->n[1] == 0.0f && plane->n[2] == 0.0f;
            if (!degenerate && !push_plane(builder, plane)) {
                return false;
            }
        }
        if (!push_plane(builder, &end)) {
            return false;
        }
    }
    return true;
}

/* glTF's spot cone as one multiply and add (KHR_lights_punctual, "Inner and Outer Cone Angles"). */
static void spot_terms(const EnfLight *light, float *scale, float *offset) {
    float width = light->inner_cos - light->outer_cos;
    *scale = 1.0f / (width > 0.001f ? width : 0.001f);
    *offset = -light->outer_cos * *scale;
}

static bool push_light(Builder *builder, const EnfCell *cell, const EnfLightRef *refs, const uint32_t *order, uint32_t count) {
    const EnfLight *light = &builder->map->lights[refs[order[0]].light];
    uint32_t plane_first = builder->lights->plane_count;
    float *record = push_record(builder);
    if (!record || !push_windows(builder, refs, order, count)) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        record[i] = (float)(light->position[i] - cell->origin[i]);
        record[4 + i] = light->color[i];
        record[8 + i] = light->direction[i];
    }
    bool ranged = light->kind != ENF_LIGHT_DIRECTIONAL && light->range > 0.0f;
    record[3] = ranged ? 1.0f / (light->range * light->range) : 0.0f;
    record[7] = (float)light->kind;
    spot_terms(light, &record[11], &record[12]);
    record[13] = (float)plane_first;
    record[14] = (float)(builder->lights->plane_count - plane_first);
    record[15] = 0.0f;
    return true;
}

/* Records of a cell: its references by light, in the order of their first mention. */
static bool push_cell(Builder *builder, const EnfCell *cell, uint32_t *order) {
    const EnfLightRef *refs = builder->map->light_refs + cell->light_first;
    uint32_t left = cell->light_count;
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
        if (!push_light(builder, cell, refs, order, same)) {
            return false;
        }
        order += same;
        left -= same;
    }
    return true;
}

/* ---- lists: the lights of a cluster ----------------------------------------------------------------------------- */

/* Squared distance of a point to a box. */
static float box_distance2(const EnfCluster *c, const float *p) {
    float sum = 0.0f;
    for (int i = 0; i < 3; i++) {
        float d = p[i] < c->min[i] ? c->min[i] - p[i] : p[i] > c->max[i] ? p[i] - c->max[i] : 0.0f;
        sum += d * d;
    }
    return sum;
}

/* Is some point of the box inside a plane or its soft edge? */
static bool box_touches_plane(const EnfCluster *c, const float *light, const float *plane) {
    float farthest = plane[3];
    for (int i = 0; i < 3; i++) {
        farthest += plane[i] * ((plane[i] > 0.0f ? c->max[i] : c->min[i]) - light[i]);
    }
    return farthest >= -WINDOW_SOFT;
}

static bool window_touches(const EnfGlLights *lights, const float *record, const EnfCluster *c) {
    uint32_t first = (uint32_t)record[13], count = (uint32_t)record[14];
    bool inside = true;
    for (uint32_t i = first; i < first + count; i++) {
        const float *plane = &lights->planes[(size_t)4 * i];
        if (plane[0] == 0.0f && plane[1] == 0.0f && plane[2] == 0.0f) {
            if (inside) {
                return true;
            }
            inside = true;
        } else {
            inside = inside && box_touches_plane(c, record, plane);
        }
    }
    return count == 0;
}

static bool light_touches(const EnfGlLights *lights, const float *record, const EnfCluster *c) {
    return box_distance2(c, record) * record[3] < 1.0f && window_touches(lights, record, c);
}

/* Appends the list of a cluster; shares the previous one's if they are equal. */
static bool push_list(Builder *builder, uint32_t cluster, uint32_t record_first, uint32_t record_end) {
    EnfGlLights *l = builder->lights;
    const EnfCluster *c = &builder->map->clusters[cluster];
    uint32_t first = l->item_count;
    for (uint32_t r = record_first; r < record_end && l->item_count - first < ENF_GL_LIGHTS_MAX; r++) {
        const float *record = &l->records[(size_t)ENF_GL_LIGHT_FLOATS * r];
        if (light_touches(l, record, c) && !push_item(builder, r)) {
            return false;
        }
    }
    uint32_t count = l->item_count - first;
    if (cluster > 0 && count > 0) {
        uint32_t before = l->cluster_lists[cluster - 1] >> 8, before_count = l->cluster_lists[cluster - 1] & 255u;
        if (before_count == count && memcmp(&l->items[before], &l->items[first], count * sizeof *l->items) == 0) {
            l->item_count = first;
            first = before;
        }
    }
    l->cluster_lists[cluster] = first << 8 | count;
    return true;
}

/* ---- exposure --------------------------------------------------------------------------------------------------- */

/* How bright a light would be at the middle of a cluster, facing it. */
static float brightness(const float *record, const EnfCluster *c) {
    float luminance = 0.2126f * record[4] + 0.7152f * record[5] + 0.0722f * record[6];
    if ((uint32_t)record[7] == ENF_LIGHT_DIRECTIONAL) {
        return luminance;
    }
    float distance2 = 0.25f; /* half a metre: no surface counts as nearer */
    for (int i = 0; i < 3; i++) {
        float d = 0.5f * (c->min[i] + c->max[i]) - record[i];
        distance2 += d * d;
    }
    float window = 1.0f - distance2 * distance2 * record[3] * record[3];
    return window > 0.0f ? luminance * window / distance2 : 0.0f;
}

static int by_value(const void *a, const void *b) {
    float x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

/* Files give candela, watts or anything: what half of the lit clusters exceed becomes a middling grey. */
static bool expose(Builder *builder) {
    EnfGlLights *l = builder->lights;
    float *values = enf_alloc(NULL, l->cluster_count, sizeof *values);
    if (!values && l->cluster_count) {
        enf_error_set(builder->error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for lights");
        return false;
    }
    uint32_t count = 0;
    for (uint32_t i = 0; i < l->cluster_count; i++) {
        float sum = 0.0f;
        for (uint32_t k = 0; k < (l->cluster_lists[i] & 255u); k++) {
            uint32_t record = l->items[(l->cluster_lists[i] >> 8) + k];
            sum += brightness(&l->records[(size_t)ENF_GL_LIGHT_FLOATS * record], &builder->map->clusters[i]);
        }
        if (sum > 0.0f) {
            values[count++] = sum;
        }
    }
    if (count) {
        qsort(values, count, sizeof *values, by_value);
        float exposure = 0.75f / values[count / 2];
        for (uint32_t r = 0; r < l->record_count; r++) {
            for (int i = 4; i < 7; i++) {
                l->records[(size_t)ENF_GL_LIGHT_FLOATS * r + (size_t)i] *= exposure;
            }
        }
    }
    enf_free(NULL, values, l->cluster_count, sizeof *values);
    return true;
}

/* ---- build ------------------------------------------------------------------------------------------------------ */

static uint32_t most_refs(const EnfMap *map) {
    uint32_t most = 0;
    for (uint32_t i = 0; i < map->cells_count; i++) {
        most = map->cells[i].light_count > most ? map->cells[i].light_count : most;
    }
    return most;
}

static bool build_cells(Builder *builder, uint32_t *order) {
    const EnfMap *map = builder->map;
    for (uint32_t i = 0; i < map->cells_count; i++) {
        const EnfCell *cell = &map->cells[i];
        uint32_t record_first = builder->lights->record_count;
        if (!push_cell(builder, cell, order)) {
            return false;
        }
        for (uint32_t c = cell->cluster_first; c < cell->cluster_first + cell->cluster_count; c++) {
            if (!push_list(builder, c, record_first, builder->lights->record_count)) {
                return false;
            }
        }
    }
    return expose(builder);
}

EnfResult enf_gl_lights_build(EnfGlLights *lights, const EnfMap *map, EnfError *error) {
    ENF_ASSERT(lights && map);
    memset(lights, 0, sizeof *lights);
    EnfError own = {0};
    Builder builder = {lights, map, error ? error : &own};
    builder.error->code = ENF_OK;
    uint32_t refs = most_refs(map);
    uint32_t *order = enf_alloc(NULL, (size_t)refs + 1, sizeof *order);
    lights->cluster_lists = enf_alloc(NULL, map->clusters_count, sizeof *lights->cluster_lists);
    lights->cluster_count = map->clusters_count;
    bool done = order && (lights->cluster_lists || map->clusters_count == 0);
    if (!done) {
        enf_error_set(builder.error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for lights");
    }
    done = done && build_cells(&builder, order);
    enf_free(NULL, order, (size_t)refs + 1, sizeof *order);
    return done ? ENF_OK : builder.error->code;
}

void enf_gl_lights_free(EnfGlLights *lights) {
    enf_free(NULL, lights->records, lights->record_capacity, ENF_GL_LIGHT_FLOATS * sizeof(float));
    enf_free(NULL, lights->planes, lights->plane_capacity, 4 * sizeof(float));
    enf_free(NULL, lights->items, lights->item_capacity, sizeof *lights->items);
    enf_free(NULL, lights->cluster_lists, lights->cluster_count, sizeof *lights->cluster_lists);
    memset(lights, 0, sizeof *lights);
}
