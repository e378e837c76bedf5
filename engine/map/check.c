/* enf_map_check: the one door between bytes and the engine. After it every index, range and tree of the map can be followed without
 * a thought (PITFALLS 25). */
#include "map/map_internal.h"

EnfResult enf_map_check(const EnfMap *map, EnfError *error) {
    EnfMapCheck check = {map, error, {0}};
    enf_map_offsets(map, check.offsets);
    for (int id = 0; id < ENF_MAP_CHUNK_COUNT; id++) {
        EnfMapChunk chunk = enf_map_chunk(map, (EnfMapChunkId)id);
        if (chunk.count && !chunk.data) {
            return enf_error_set(error, ENF_ERROR_ARGUMENT, UINT64_MAX, "chunk %s: %s: %u records, but no array",
                                 enf_map_chunk_info[id].fourcc, enf_map_chunk_info[id].name, chunk.count);
        }
    }
    EnfResult result = enf_map_check_rules(&check);
    result = result ? result : enf_map_check_tables(&check);
    result = result ? result : enf_map_check_cells(&check);
    result = result ? result : enf_map_check_geometry(&check);
    return result ? result : enf_map_check_movers(&check);
}

EnfKdTree enf_map_cell_tree(const EnfMap *map, uint32_t cell) {
    const EnfCell *c = &map->cells[cell];
    EnfKdTree tree = {NULL, NULL, c->node_count, c->block_count};
    if (c->node_count) {
        tree.nodes = map->kd_nodes + c->node_first;
        tree.blocks = map->kd_blocks + c->block_first;
    }
    return tree;
}
