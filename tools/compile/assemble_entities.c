/* Entities, cameras and paths of a map: what is not static geometry. */
#include "compile/movers.h"

#include <cJSON.h>
#include <stdlib.h>
#include <string.h>

/* Extras larger than this are kept as text, but not searched for a class name. */
enum { EXTRAS_SEARCHED_MAX = 1 << 16 };

static bool is_entity(const EnfAssemblyParts *parts, uint32_t node) {
    const EnfSourceNode *n = &parts->source->nodes[node];
    EnfRole role = parts->layout->roles[node];
    if (role == ENF_ROLE_IGNORED) {
        return false;
    }
    const uint32_t *movers = parts->layout->node_movers;
    bool carried = role == ENF_ROLE_MOVER && movers[node] != node; /* a piece of something that moves */
    return (role != ENF_ROLE_GEOMETRY && !carried) || n->camera != ENF_NONE || n->light != ENF_NONE || n->extras[0] ||
           n->animated || enf_mover_collides(parts->source, parts->layout, node);
}

/* The text of the key `classname`, interned. */
static uint32_t classname_of(EnfAssembly *assembly, const char *extras) {
    size_t length = strlen(extras);
    if (length == 0 || length > EXTRAS_SEARCHED_MAX || !strstr(extras, "\"classname\"")) {
        return 0;
    }
    cJSON *json = cJSON_ParseWithLength(extras, length);
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(json, "classname");
    uint32_t name = cJSON_IsString(value) ? enf_strings_add(&assembly->texts, value->valuestring) : 0;
    cJSON_Delete(json);
    return name;
}

static uint32_t parent_entity(const EnfAssembly *assembly, const EnfSource *source, uint32_t node) {
    uint32_t parent = source->nodes[node].parent;
    while (parent != ENF_NONE && assembly->node_entities[parent] == ENF_NONE) {
        parent = source->nodes[parent].parent;
    }
    return parent == ENF_NONE ? ENF_NONE : assembly->node_entities[parent];
}

static void place_entity(EnfEntity *entity, const EnfSourceNode *node) {
    EnfVec3 t = node->translation, s = node->scale;
    EnfQuat q = node->rotation;
    bool no_rotation = q.x == 0 && q.y == 0 && q.z == 0 && q.w == 0;
    entity->translation[0] = t.x;
    entity->translation[1] = t.y;
    entity->translation[2] = t.z;
    entity->rotation[0] = (float)q.x;
    entity->rotation[1] = (float)q.y;
    entity->rotation[2] = (float)q.z;
    entity->rotation[3] = no_rotation ? 1.0f : (float)q.w;
    entity->scale[0] = enf_finite_float(s.x);
    entity->scale[1] = enf_finite_float(s.y);
    entity->scale[2] = enf_finite_float(s.z);
}

static bool add_entity(EnfAssembly *assembly, const EnfAssemblyParts *parts, uint32_t number) {
    const EnfSourceNode *node = &parts->source->nodes[number];
    EnfEntity entity;
    memset(&entity, 0, sizeof entity);
    place_entity(&entity, node);
    entity.name = enf_strings_add(&assembly->texts, node->name);
    entity.classname = classname_of(assembly, node->extras);
    entity.extras = enf_strings_add(&assembly->texts, node->extras);
    entity.parent = parent_entity(assembly, parts->source, number);
    entity.cell = enf_assembly_node_cell(assembly, parts, number);
    entity.camera = node->camera;
    entity.light = assembly->node_lights[number];
    if (!ENF_ARRAY_ROOM(&assembly->entities, 1)) {
        return false;
    }
    assembly->node_entities[number] = assembly->entities.count;
    assembly->entities.data[assembly->entities.count++] = entity;
    return true;
}

/* Key times must ascend for the run time to search them; the importer has seen to it that the values are finite. */
static bool usable_path(const EnfAssembly *assembly, const EnfSourcePath *path) {
    bool usable = path->key_count > 0 && assembly->node_entities[path->node] != ENF_NONE;
    for (uint32_t key = 1; key < path->key_count && usable; key++) {
        usable = path->times[key - 1] < path->times[key];
    }
    return usable;
}

static bool add_path(EnfAssembly *assembly, const EnfSourcePath *from) {
    uint64_t width = (from->target == ENF_PATH_ROTATION ? 4 : 3) * (from->kind == ENF_PATH_CUBIC ? 3u : 1u);
    uint64_t value_count = width * from->key_count;
    if (!ENF_ARRAY_ROOM(&assembly->paths, 1) || !ENF_ARRAY_ROOM(&assembly->path_floats, value_count + from->key_count)) {
        return false;
    }
    assembly->paths.data[assembly->paths.count++] = (EnfPath){enf_strings_add(&assembly->texts, from->animation),
                                                              assembly->node_entities[from->node],
                                                              from->target,
                                                              from->kind,
                                                              from->key_count,
                                                              assembly->path_floats.count};
    float *floats = assembly->path_floats.data + assembly->path_floats.count;
    memcpy(floats, from->times, from->key_count * sizeof *floats);
    memcpy(floats + from->key_count, from->values, (size_t)value_count * sizeof *floats);
    assembly->path_floats.count += from->key_count + (uint32_t)value_count;
    return true;
}

bool enf_assemble_entities(EnfAssembly *assembly, const EnfAssemblyParts *parts) {
    const EnfSource *source = parts->source;
    if (!ENF_ARRAY_ROOM(&assembly->cameras, source->camera_count)) {
        return false;
    }
    for (uint32_t i = 0; i < source->camera_count; i++) {
        assembly->cameras.data[assembly->cameras.count++] = source->cameras[i];
    }
    for (uint32_t node = 0; node < source->node_count; node++) {
        if (is_entity(parts, node) && !add_entity(assembly, parts, node)) {
            return false;
        }
    }
    for (uint32_t i = 0; i < source->path_count; i++) {
        if (usable_path(assembly, &source->paths[i]) && !add_path(assembly, &source->paths[i])) {
            return false;
        }
    }
    return true;
}
