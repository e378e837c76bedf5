/* Lights of a map, their ranges, and the cells that each reaches. */
#include "compile/assemble.h"
#include "compile/light_flow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Where a file gives no range, a light ends where it is this much weaker than the level's typical lamp is at
 * TYPICAL_DISTANCE_M. Files give candela, watts or anything, so a threshold must follow the level's own lamps, as the
 * renderer's exposure does; 1/256 is one step of an 8-bit picture. For the typical lamp that makes 2 m × √256 = 32 m. */
#define VISIBLE_FRACTION (1.0 / 256.0)
#define TYPICAL_DISTANCE_M 2.0

/* A reference of a light before the references are sorted by cell. */
typedef struct Reach {
    uint32_t cell;
    EnfLightRef ref;
} Reach;

typedef struct Lights {
    EnfAssembly *assembly;
    const EnfAssemblyParts *parts;
    EnfLightFlow flow;
    double typical; /* intensity of the median lamp without a range */
    ENF_ARRAY(Reach) reaches;
} Lights;

/* ---- light by light --------------------------------------------------------------------------------------------- */

static bool shines(const EnfAssemblyParts *parts, uint32_t node) {
    return parts->source->nodes[node].light != ENF_NONE && parts->layout->roles[node] != ENF_ROLE_IGNORED;
}

static double brightness(const EnfSourceLight *light) {
    double most = (double)light->color[0];
    most = (double)light->color[1] > most ? (double)light->color[1] : most;
    most = (double)light->color[2] > most ? (double)light->color[2] : most;
    return most * (double)light->intensity;
}

static bool needs_range(const EnfSourceLight *light) {
    return light->kind != ENF_LIGHT_DIRECTIONAL && !(light->range > 0.0f);
}

static int compare_doubles(const void *left, const void *right) {
    double a, b;
    memcpy(&a, left, sizeof a);
    memcpy(&b, right, sizeof b);
    return (a > b) - (a < b);
}

/* The median brightness of the lamps without a range; 1 if there are none. False when out of memory. */
static bool find_typical(Lights *lights) {
    const EnfSource *source = lights->parts->source;
    double *values = malloc(((size_t)source->node_count + 1) * sizeof *values);
    uint32_t count = 0;
    lights->typical = 1;
    for (uint32_t node = 0; values && node < source->node_count; node++) {
        if (shines(lights->parts, node) && needs_range(&source->lights[source->nodes[node].light])) {
            double value = brightness(&source->lights[source->nodes[node].light]);
            if (value > 0) {
                values[count++] = value;
            }
        }
    }
    if (count > 0) {
        qsort(values, count, sizeof *values, compare_doubles);
        lights->typical = values[count / 2];
    }
    free(values);
    return values != NULL;
}

static float range_of(const Lights *lights, const EnfSourceLight *light) {
    if (!needs_range(light)) {
        return light->kind == ENF_LIGHT_DIRECTIONAL ? 0.0f : light->range;
    }
    double ratio = brightness(light) / (lights->typical * VISIBLE_FRACTION);
    double range = TYPICAL_DISTANCE_M * sqrt(ratio > 0 ? ratio : 0);
    return (float)(range < 1e6 ? range : 1e6);
}

/* glTF (KHR_lights_punctual): a light shines down the −Z axis of its node. */
static void set_direction(EnfLight *light, const EnfSourceNode *node) {
    EnfVec3 d = enf_normalize(enf_affine_vector(&node->world, enf_v3(0, 0, -1)));
    bool lost = d.x == 0 && d.y == 0 && d.z == 0;
    light->direction[0] = (float)d.x;
    light->direction[1] = lost ? -1.0f : (float)d.y;
    light->direction[2] = (float)d.z;
}

static bool add_light(Lights *lights, uint32_t number) {
    EnfAssembly *assembly = lights->assembly;
    const EnfSourceNode *node = &lights->parts->source->nodes[number];
    const EnfSourceLight *from = &lights->parts->source->lights[node->light];
    EnfLight light = {.position = {node->world.t.x, node->world.t.y, node->world.t.z},
                      .kind = from->kind,
                      .range = range_of(lights, from),
                      .name = enf_strings_add(&assembly->texts, node->name)};
    set_direction(&light, node);
    for (int i = 0; i < 3; i++) {
        light.color[i] = enf_finite_float((double)from->color[i] * (double)from->intensity);
    }
    if (from->kind == ENF_LIGHT_SPOT) {
        light.outer_cos = (float)enf_cos((double)from->outer);
        light.inner_cos = (float)enf_cos((double)from->inner);
        light.inner_cos = light.inner_cos < light.outer_cos ? light.outer_cos : light.inner_cos;
    }
    bool everywhere = from->kind == ENF_LIGHT_DIRECTIONAL;
    light.cell = everywhere ? ENF_NONE : enf_assembly_node_cell(assembly, lights->parts, number);
    if (!ENF_ARRAY_ROOM(&assembly->lights, 1)) {
        return false;
    }
    assembly->node_lights[number] = assembly->lights.count;
    assembly->lights.data[assembly->lights.count++] = light;
    return true;
}

/* ---- reach ------------------------------------------------------------------------------------------------------ */

static bool add_reach(Lights *lights, uint32_t cell, uint32_t light, const EnfVec3 *planes, uint32_t plane_count) {
    EnfAssembly *assembly = lights->assembly;
    if (!ENF_ARRAY_ROOM(&lights->reaches, 1) || !ENF_ARRAY_ROOM(&assembly->light_planes, plane_count)) {
        return false;
    }
    lights->reaches.data[lights->reaches.count++] = (Reach){cell, {light, assembly->light_planes.count, plane_count}};
    for (uint32_t i = 0; i < plane_count; i++) {
        assembly->light_planes.data[assembly->light_planes.count++] = (EnfPlane4f){
            {(float)planes[i].x, (float)planes[i].y, (float)planes[i].z}, 0.0f};
    }
    return true;
}

static bool cell_in_range(const EnfCell *cell, const EnfLight *light) {
    double distance2 = 0;
    for (int axis = 0; axis < 3; axis++) {
        double p = light->position[axis] - cell->origin[axis];
        double low = (double)cell->min[axis] - p, high = p - (double)cell->max[axis];
        double d = low > 0 ? low : high > 0 ? high : 0;
        distance2 += d * d;
    }
    return distance2 <= (double)light->range * (double)light->range;
}

/* A directional light shines everywhere; a lamp that stands in no cell, into every cell within its range. */
static bool reach_without_portals(Lights *lights, uint32_t number) {
    const EnfAssembly *assembly = lights->assembly;
    const EnfLight *light = &assembly->lights.data[number];
    bool ok = true;
    for (uint32_t cell = 0; cell < assembly->cells.count && ok; cell++) {
        if (light->kind == ENF_LIGHT_DIRECTIONAL || cell_in_range(&assembly->cells.data[cell], light)) {
            ok = add_reach(lights, cell, number, NULL, 0);
        }
    }
    return ok;
}

static bool reach_through_portals(Lights *lights, uint32_t number) {
    const EnfLight *light = &lights->assembly->lights.data[number];
    EnfVec3 position = {light->position[0], light->position[1], light->position[2]};
    bool ok = enf_light_flow_run(&lights->flow, light->cell, position, (double)light->range);
    for (uint32_t i = 0; i < lights->flow.windows.count && ok; i++) {
        const EnfLightWindow *window = &lights->flow.windows.data[i];
        if (window->cell != ENF_NONE) {
            ok = add_reach(lights, window->cell, number, window->planes, window->plane_count);
        }
    }
    return ok;
}

/* References by cell, in the order of the lights. */
static bool sort_reaches(Lights *lights) {
    EnfAssembly *assembly = lights->assembly;
    uint32_t count = lights->reaches.count;
    if (!ENF_ARRAY_ROOM(&assembly->light_refs, count)) {
        return false;
    }
    for (uint32_t i = 0; i < count; i++) {
        assembly->cells.data[lights->reaches.data[i].cell].light_count++;
    }
    uint32_t first = 0;
    for (uint32_t c = 0; c < assembly->cells.count; c++) {
        assembly->cells.data[c].light_first = first;
        first += assembly->cells.data[c].light_count;
        assembly->cells.data[c].light_count = 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        EnfCell *cell = &assembly->cells.data[lights->reaches.data[i].cell];
        assembly->light_refs.data[cell->light_first + cell->light_count++] = lights->reaches.data[i].ref;
    }
    assembly->light_refs.count = count;
    return true;
}

bool enf_assemble_lights(EnfAssembly *assembly, const EnfAssemblyParts *parts) {
    Lights lights;
    memset(&lights, 0, sizeof lights);
    lights.assembly = assembly;
    lights.parts = parts;
    bool ok = find_typical(&lights) && enf_light_flow_create(&lights.flow, parts->layout);
    for (uint32_t node = 0; node < parts->source->node_count && ok; node++) {
        ok = !shines(parts, node) || add_light(&lights, node);
    }
    for (uint32_t i = 0; i < assembly->lights.count && ok; i++) {
        ok = assembly->lights.data[i].cell == ENF_NONE ? reach_without_portals(&lights, i) : reach_through_portals(&lights, i);
    }
    ok = ok && sort_reaches(&lights);
    enf_light_flow_free(&lights.flow);
    free(lights.reaches.data);
    return ok;
}
