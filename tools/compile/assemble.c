/* EnfAssembly: the order of the stages, and the view of the result as a map. */
#include "compile/movers.h"

#include <stdlib.h>
#include <string.h>

static EnfResult no_memory(EnfError *error) {
    return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory while assembling the map");
}

static bool make_node_tables(EnfAssembly *assembly, uint32_t node_count) {
    size_t size = ((size_t)node_count + 1) * sizeof *assembly->node_lights;
    assembly->node_lights = malloc(size);
    assembly->node_entities = malloc(size);
    if (!assembly->node_lights || !assembly->node_entities) {
        return false;
    }
    memset(assembly->node_lights, 0xff, size);
    memset(assembly->node_entities, 0xff, size);
    return true;
}

/* The finished texts become the chunk. */
static bool take_strings(EnfAssembly *assembly) {
    enf_strings_add(&assembly->texts, "");
    if (assembly->texts.failed) {
        return false;
    }
    assembly->strings.data = assembly->texts.bytes;
    assembly->strings.count = assembly->texts.count;
    assembly->strings.capacity = assembly->texts.capacity;
    assembly->texts.bytes = NULL;
    return true;
}

EnfResult enf_assemble(EnfAssembly *assembly, const EnfAssemblyParts *parts, EnfError *error) {
    if (!make_node_tables(assembly, parts->source->node_count) || !enf_assemble_cells(assembly, parts)) {
        return no_memory(error);
    }
    EnfResult result = enf_assemble_materials(assembly, parts, error);
    if (result == ENF_OK) {
        result = enf_assemble_trees(assembly, parts, error);
    }
    if (result != ENF_OK) {
        return result;
    }
    if (!enf_assemble_lights(assembly, parts) || !enf_assemble_entities(assembly, parts) ||
        !enf_assemble_movers(assembly, parts) || !take_strings(assembly)) {
        return no_memory(error);
    }
    return ENF_OK;
}

EnfMap enf_assembly_map(const EnfAssembly *assembly, uint64_t source_hash) {
    EnfMap map;
    memset(&map, 0, sizeof map);
#define ENF_ASSEMBLY_VIEW(type, array, fourcc)                                                                                 \
    map.array = assembly->array.data;                                                                                          \
    map.array##_count = assembly->array.count;
    ENF_MAP_CHUNKS(ENF_ASSEMBLY_VIEW)
#undef ENF_ASSEMBLY_VIEW
    memcpy(map.tree_origin, assembly->tree_origin, sizeof map.tree_origin);
    map.source_hash = source_hash;
    return map;
}

uint32_t enf_assembly_node_cell(const EnfAssembly *assembly, const EnfAssemblyParts *parts, uint32_t node) {
    uint32_t cell = parts->layout->node_cells[node];
    if (cell != ENF_NONE) {
        return cell;
    }
    EnfMap map = enf_assembly_map(assembly, 0);
    return enf_map_locate(&map, parts->source->nodes[node].world.t);
}

void enf_assembly_free(EnfAssembly *assembly) {
#define ENF_ASSEMBLY_FREE(type, array, fourcc) free(assembly->array.data);
    ENF_MAP_CHUNKS(ENF_ASSEMBLY_FREE)
#undef ENF_ASSEMBLY_FREE
    enf_strings_free(&assembly->texts);
    free(assembly->node_lights);
    free(assembly->node_entities);
    memset(assembly, 0, sizeof *assembly);
}
