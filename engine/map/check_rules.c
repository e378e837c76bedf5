/* What can be said of a field by itself: it is finite, an index of that table, one of these values. One line a field; what
 * compares fields is in the other check_*.c. */
#include "map/map_internal.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* ---- how a failure is told -------------------------------------------------------------------------------------- */

EnfResult enf_map_bad(const EnfMapCheck *check, EnfMapChunkId id, const void *at, const char *field, EnfResult code,
                      const char *format, ...) {
    const EnfMapChunkInfo *info = &enf_map_chunk_info[id];
    EnfMapChunk chunk = enf_map_chunk(check->map, id);
    size_t bytes = (size_t)((const char *)at - (const char *)chunk.data);
    char text[384];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    int name_length = (int)strcspn(field, "["); /* a component is told by the offset */
    return enf_error_set(check->error, code, check->offsets[id] + bytes, "chunk %s: %s[%zu]%s%.*s: %s", info->fourcc,
                         info->name, bytes / info->record_size, *field ? "." : "", name_length, field, text);
}

/* ---- the rules -------------------------------------------------------------------------------------------------- */

typedef enum RuleKind {
    RULE_F32,      /* `n` finite floats */
    RULE_F64,      /* `n` finite doubles */
    RULE_INDEX,    /* of table n */
    RULE_OPTIONAL, /* of table n, or ENF_NONE */
    RULE_RANGE,    /* first, and count in the next field, of table n */
    RULE_BELOW,    /* an enumerant less than n */
    RULE_FLAGS,    /* no bit but those of n */
} RuleKind;

typedef struct Rule {
    EnfMapChunkId chunk;
    RuleKind kind;
    uint32_t at; /* in the record */
    uint32_t n;
    const char *field;
} Rule;

#define FIELD(type, array, field, kind, n)                                                                                     \
    { ENF_CHUNK_##array, RULE_##kind, (uint32_t)offsetof(type, field), (n), #field }
#define STRING(type, array, field) FIELD(type, array, field, INDEX, ENF_CHUNK_strings)
/* A record that is one value, or n equal ones. */
#define VALUE(array, kind, n)                                                                                                  \
    { ENF_CHUNK_##array, RULE_##kind, 0, (n), "" }

static const Rule rules[] = {
    STRING(EnfImage, images, name),
    FIELD(EnfTexture, textures, image, INDEX, ENF_CHUNK_images),
    STRING(EnfMaterial, materials, name),
    FIELD(EnfMaterial, materials, texture, OPTIONAL, ENF_CHUNK_textures),
    FIELD(EnfMaterial, materials, emissive_texture, OPTIONAL, ENF_CHUNK_textures),
    FIELD(EnfMaterial, materials, alpha_mode, BELOW, ENF_ALPHA_BLEND + 1),
    FIELD(EnfMaterial, materials, flags, FLAGS, 63),
    FIELD(EnfMaterial, materials, base_color, F32, 4),
    FIELD(EnfMaterial, materials, emissive, F32, 3),
    FIELD(EnfMaterial, materials, alpha_cutoff, F32, 1),
    FIELD(EnfMaterial, materials, roughness, F32, 1),
    FIELD(EnfMaterial, materials, metallic, F32, 1),
    FIELD(EnfMaterial, materials, uv_transform, F32, 6),
    FIELD(EnfMaterial, materials, reserved, FLAGS, 0),
    FIELD(EnfCell, cells, origin, F64, 3),
    FIELD(EnfCell, cells, min, F32, 3),
    FIELD(EnfCell, cells, max, F32, 3),
    STRING(EnfCell, cells, name),
    FIELD(EnfCell, cells, flags, FLAGS, ENF_CELL_OUTSIDE | ENF_CELL_OPEN),
    FIELD(EnfCell, cells, portal_first, RANGE, ENF_CHUNK_portals),
    FIELD(EnfCell, cells, node_first, RANGE, ENF_CHUNK_kd_nodes),
    FIELD(EnfCell, cells, block_first, RANGE, ENF_CHUNK_kd_blocks),
    FIELD(EnfCell, cells, cluster_first, RANGE, ENF_CHUNK_clusters),
    FIELD(EnfCell, cells, light_first, RANGE, ENF_CHUNK_light_refs),
    FIELD(EnfCell, cells, bound_first, RANGE, ENF_CHUNK_bound_planes),
    FIELD(EnfCell, cells, reserved, FLAGS, 0),
    FIELD(EnfTransform, transforms, m, F64, 9),
    FIELD(EnfTransform, transforms, t, F64, 3),
    FIELD(EnfPortal, portals, source, INDEX, ENF_CHUNK_cells),
    FIELD(EnfPortal, portals, target, INDEX, ENF_CHUNK_cells),
    FIELD(EnfPortal, portals, twin, OPTIONAL, ENF_CHUNK_portals),
    FIELD(EnfPortal, portals, vertex_first, RANGE, ENF_CHUNK_portal_vertices),
    FIELD(EnfPortal, portals, transform, OPTIONAL, ENF_CHUNK_transforms),
    FIELD(EnfPortal, portals, flags, FLAGS, 15),
    STRING(EnfPortal, portals, name),
    VALUE(portal_vertices, F32, 3),
    VALUE(bound_planes, F32, 4),
    FIELD(EnfVertex, vertices, position, F32, 3),
    FIELD(EnfVertex, vertices, uv, F32, 2),
    FIELD(EnfVertex, vertices, cell, OPTIONAL, ENF_CHUNK_cells),
    VALUE(indices, INDEX, ENF_CHUNK_vertices),
    FIELD(EnfCluster, clusters, min, F32, 3),
    FIELD(EnfCluster, clusters, max, F32, 3),
    FIELD(EnfCluster, clusters, cell, INDEX, ENF_CHUNK_cells),
    FIELD(EnfCluster, clusters, material, INDEX, ENF_CHUNK_materials),
    FIELD(EnfCluster, clusters, index_first, RANGE, ENF_CHUNK_indices),
    FIELD(EnfCluster, clusters, vertex_first, RANGE, ENF_CHUNK_vertices),
    STRING(EnfCluster, clusters, node),
    FIELD(EnfCluster, clusters, reserved, FLAGS, 0),
    FIELD(EnfLight, lights, position, F64, 3),
    FIELD(EnfLight, lights, direction, F32, 3),
    FIELD(EnfLight, lights, color, F32, 3),
    FIELD(EnfLight, lights, range, F32, 1),
    FIELD(EnfLight, lights, inner_cos, F32, 1),
    FIELD(EnfLight, lights, outer_cos, F32, 1),
    FIELD(EnfLight, lights, kind, BELOW, ENF_LIGHT_DIRECTIONAL + 1),
    FIELD(EnfLight, lights, cell, OPTIONAL, ENF_CHUNK_cells),
    STRING(EnfLight, lights, name),
    FIELD(EnfLightRef, light_refs, light, INDEX, ENF_CHUNK_lights),
    FIELD(EnfLightRef, light_refs, plane_first, RANGE, ENF_CHUNK_light_planes),
    VALUE(light_planes, F32, 4),
    VALUE(cameras, F32, 4),
    FIELD(EnfEntity, entities, translation, F64, 3),
    FIELD(EnfEntity, entities, rotation, F32, 4),
    FIELD(EnfEntity, entities, scale, F32, 3),
    STRING(EnfEntity, entities, name),
    STRING(EnfEntity, entities, classname),
    STRING(EnfEntity, entities, extras),
    FIELD(EnfEntity, entities, parent, OPTIONAL, ENF_CHUNK_entities),
    FIELD(EnfEntity, entities, cell, OPTIONAL, ENF_CHUNK_cells),
    FIELD(EnfEntity, entities, camera, OPTIONAL, ENF_CHUNK_cameras),
    FIELD(EnfEntity, entities, light, OPTIONAL, ENF_CHUNK_lights),
    STRING(EnfPath, paths, name),
    FIELD(EnfPath, paths, entity, INDEX, ENF_CHUNK_entities),
    FIELD(EnfPath, paths, target, BELOW, ENF_PATH_SCALE + 1),
    FIELD(EnfPath, paths, kind, BELOW, ENF_PATH_CUBIC + 1),
    VALUE(path_floats, F32, 1),
    FIELD(EnfMesh, meshes, min, F32, 3),
    FIELD(EnfMesh, meshes, max, F32, 3),
    FIELD(EnfMesh, meshes, part_first, RANGE, ENF_CHUNK_mesh_parts),
    STRING(EnfMesh, meshes, name),
    FIELD(EnfMesh, meshes, reserved, FLAGS, 0),
    FIELD(EnfMeshPart, mesh_parts, mesh, INDEX, ENF_CHUNK_meshes),
    FIELD(EnfMeshPart, mesh_parts, material, INDEX, ENF_CHUNK_materials),
    FIELD(EnfMeshPart, mesh_parts, index_first, RANGE, ENF_CHUNK_indices),
    FIELD(EnfMeshPart, mesh_parts, vertex_first, RANGE, ENF_CHUNK_vertices),
    FIELD(EnfMover, movers, pivot, F64, 3),
    FIELD(EnfMover, movers, entity, INDEX, ENF_CHUNK_entities),
    FIELD(EnfMover, movers, mesh, OPTIONAL, ENF_CHUNK_meshes),
    FIELD(EnfMover, movers, kind, BELOW, ENF_MOVER_FREE + 1),
    FIELD(EnfMover, movers, wrap, BELOW, ENF_WRAP_PING_PONG + 1),
    FIELD(EnfMover, movers, translation, OPTIONAL, ENF_CHUNK_paths),
    FIELD(EnfMover, movers, rotation, OPTIONAL, ENF_CHUNK_paths),
    FIELD(EnfMover, movers, scale, OPTIONAL, ENF_CHUNK_paths),
    FIELD(EnfMover, movers, portal, OPTIONAL, ENF_CHUNK_portals),
    FIELD(EnfMover, movers, flags, FLAGS, ENF_MOVER_SOLID | ENF_MOVER_LOCKED | ENF_MOVER_CARRY),
    FIELD(EnfMover, movers, axis, F32, 3),
    FIELD(EnfMover, movers, low, F32, 1),
    FIELD(EnfMover, movers, high, F32, 1),
    FIELD(EnfMover, movers, rate, F32, 1),
    FIELD(EnfMover, movers, seconds, F32, 1),
    FIELD(EnfMover, movers, phase, F32, 1),
    FIELD(EnfMover, movers, max_speed, F32, 1),
    FIELD(EnfMover, movers, reserved, FLAGS, 0),
    VALUE(origin, F64, 3),
};

/* ---- one field -------------------------------------------------------------------------------------------------- */

static uint32_t load_u32(const char *at) {
    uint32_t value;
    memcpy(&value, at, sizeof value);
    return value;
}

static EnfResult fail(const EnfMapCheck *check, const Rule *rule, const char *at, EnfResult code, const char *text,
                      const char *table) {
    return enf_map_bad(check, rule->chunk, at, rule->field, code, "%u (0x%08x) %s%s", load_u32(at), load_u32(at), text, table);
}

static EnfResult check_floats(const EnfMapCheck *check, const Rule *rule, const char *at) {
    for (uint32_t i = 0; i < rule->n; i++) {
        float value;
        memcpy(&value, at + i * sizeof value, sizeof value);
        if (!isfinite(value)) {
            return enf_map_bad(check, rule->chunk, at, rule->field, ENF_ERROR_RANGE, "component %u is not finite", i);
        }
    }
    return ENF_OK;
}

static EnfResult check_doubles(const EnfMapCheck *check, const Rule *rule, const char *at) {
    for (uint32_t i = 0; i < rule->n; i++) {
        double value;
        memcpy(&value, at + i * sizeof value, sizeof value);
        if (!isfinite(value)) {
            return enf_map_bad(check, rule->chunk, at, rule->field, ENF_ERROR_RANGE, "component %u is not finite", i);
        }
    }
    return ENF_OK;
}

static EnfResult check_number(const EnfMapCheck *check, const Rule *rule, const char *at, uint32_t table_count) {
    uint32_t value = load_u32(at);
    switch (rule->kind) {
    case RULE_OPTIONAL:
        if (value == ENF_NONE) {
            return ENF_OK;
        } /* fall through */
    case RULE_INDEX:
        return value < table_count ? ENF_OK
                                   : fail(check, rule, at, ENF_ERROR_INDEX, "is outside ", enf_map_chunk_info[rule->n].name);
    case RULE_RANGE:
        return value <= table_count && load_u32(at + 4) <= table_count - value
                   ? ENF_OK
                   : fail(check, rule, at, ENF_ERROR_INDEX, "and its count reach outside ", enf_map_chunk_info[rule->n].name);
    case RULE_BELOW:
        return value < rule->n ? ENF_OK : fail(check, rule, at, ENF_ERROR_RANGE, "is none of the known values", "");
    case RULE_FLAGS:
        return (value & ~rule->n) == 0 ? ENF_OK : fail(check, rule, at, ENF_ERROR_RANGE, "has bits that mean nothing", "");
    default:
        return ENF_OK;
    }
}

static EnfResult check_rule(const EnfMapCheck *check, const Rule *rule) {
    EnfMapChunk chunk = enf_map_chunk(check->map, rule->chunk);
    const bool refers = rule->kind == RULE_INDEX || rule->kind == RULE_OPTIONAL || rule->kind == RULE_RANGE;
    uint32_t table_count = refers ? enf_map_chunk(check->map, (EnfMapChunkId)rule->n).count : 0;
    const uint32_t record_size = enf_map_chunk_info[rule->chunk].record_size;
    const char *at = (const char *)chunk.data;
    EnfResult result = ENF_OK;
    for (uint32_t i = 0; result == ENF_OK && i < chunk.count; i++, at += record_size) {
        if (rule->kind == RULE_F32) {
            result = check_floats(check, rule, at + rule->at);
        } else if (rule->kind == RULE_F64) {
            result = check_doubles(check, rule, at + rule->at);
        } else {
            result = check_number(check, rule, at + rule->at, table_count);
        }
    }
    return result;
}

EnfResult enf_map_check_rules(const EnfMapCheck *check) {
    const EnfMap *map = check->map;
    if (map->strings_count == 0 || map->strings[0] != 0 || map->strings[map->strings_count - 1] != 0) {
        return enf_error_set(check->error, ENF_ERROR_FORMAT, check->offsets[ENF_CHUNK_strings],
                             "chunk STRS: strings: does not begin with \"\" and end with a zero");
    }
    EnfResult result = ENF_OK;
    for (size_t i = 0; result == ENF_OK && i < sizeof rules / sizeof *rules; i++) {
        result = check_rule(check, &rules[i]);
    }
    return result;
}
