/* Clusters, what their indices reach, and the trees over them. */
#include "map/map_internal.h"
#include <enfilade/tolerances.h>

#include <string.h>

enum { CLUSTER_TRIANGLES_MAX = 128 };

/* ---- clusters --------------------------------------------------------------------------------------------------- */

/* Culling trusts these bounds: a vertex outside them would be lost. */
static EnfResult check_cluster_indices(const EnfMapCheck *check, uint32_t i) {
    const EnfMap *map = check->map;
    const EnfCluster *cluster = &map->clusters[i];
    for (uint32_t k = cluster->index_first; k < cluster->index_first + cluster->index_count; k++) {
        uint32_t index = map->indices[k];
        if (index < cluster->vertex_first || index - cluster->vertex_first >= cluster->vertex_count) {
            return enf_map_bad(check, ENF_CHUNK_indices, &map->indices[k], "", ENF_ERROR_INDEX,
                               "%u is outside the vertex range of cluster %u", index, i);
        }
        const EnfVertex *vertex = &map->vertices[index];
        if (vertex->cell != cluster->cell) {
            return ENF_MAP_BAD(check, vertices, index, cell, ENF_ERROR_INDEX, "%u is not the cell of cluster %u", vertex->cell,
                               i);
        }
        for (int axis = 0; axis < 3; axis++) {
            if (vertex->position[axis] < cluster->min[axis] || vertex->position[axis] > cluster->max[axis]) {
                return ENF_MAP_BAD(check, vertices, index, position[axis], ENF_ERROR_RANGE,
                                   "%g is outside the bounds of cluster %u", (double)vertex->position[axis], i);
            }
        }
    }
    return ENF_OK;
}

static EnfResult check_cluster(const EnfMapCheck *check, uint32_t i) {
    const EnfMap *map = check->map;
    const EnfCluster *cluster = &map->clusters[i];
    if (cluster->index_count == 0 || cluster->index_count % 3 || cluster->index_count > 3 * CLUSTER_TRIANGLES_MAX) {
        return ENF_MAP_BAD(check, clusters, i, index_count, ENF_ERROR_RANGE, "%u is not 3 times 1..%d", cluster->index_count,
                           CLUSTER_TRIANGLES_MAX);
    }
    for (int axis = 0; axis < 3; axis++) {
        if (cluster->min[axis] > cluster->max[axis]) {
            return ENF_MAP_BAD(check, clusters, i, min[axis], ENF_ERROR_RANGE, "%g is above max %g", (double)cluster->min[axis],
                               (double)cluster->max[axis]);
        }
    }
    const EnfCluster *before = i ? cluster - 1 : cluster;
    if (before->cell > cluster->cell) {
        return ENF_MAP_BAD(check, clusters, i, cell, ENF_ERROR_FORMAT, "clusters are not ordered by cell");
    }
    if (before->cell == cluster->cell && before->material > cluster->material) {
        return ENF_MAP_BAD(check, clusters, i, material, ENF_ERROR_FORMAT, "clusters of a cell are not ordered by material");
    }
    return check_cluster_indices(check, i);
}

/* ---- trees ------------------------------------------------------------------------------------------------------ */

/* Which tree an item was last seen in, to find doubles. */
typedef struct Stamps {
    uint32_t *seen; /* tree + 1 */
    uint32_t count;
} Stamps;

static EnfResult tree_bad(const EnfMapCheck *check, EnfMapChunkId id, uint32_t node_first, const char *whose, uint32_t cell,
                          const EnfError *inner) {
    EnfMapChunk chunk = enf_map_chunk(check->map, id);
    return enf_map_bad(check, id, (const EnfKdNode *)chunk.data + node_first, "", inner->code, "the tree of %s %u: %s", whose,
                       cell, inner->message);
}

static bool lane_holds(const EnfKdBlock *b, uint32_t lane, const float *min, const float *max) {
    return b->min_x[lane] <= min[0] && b->min_y[lane] <= min[1] && b->min_z[lane] <= min[2] && b->max_x[lane] >= max[0] &&
           b->max_y[lane] >= max[1] && b->max_z[lane] >= max[2];
}

static EnfResult check_cell_block(const EnfMapCheck *check, uint32_t cell, uint32_t block, Stamps *stamps, uint32_t *own) {
    const EnfMap *map = check->map;
    const EnfKdBlock *b = &map->kd_blocks[block];
    for (uint32_t lane = 0; lane < ENF_KD_BLOCK; lane++) {
        uint32_t item = b->item[lane];
        if (item == ENF_NONE) {
            continue;
        }
        if (stamps->seen[item] == cell + 1) {
            return ENF_MAP_BAD(check, kd_blocks, block, item[lane], ENF_ERROR_INDEX, "%u is in the tree of cell %u twice", item,
                               cell);
        }
        stamps->seen[item] = cell + 1;
        const EnfCluster *cluster = &map->clusters[item];
        if (cluster->cell != cell) {
            continue;
        }
        (*own)++;
        if (!lane_holds(b, lane, cluster->min, cluster->max)) {
            return ENF_MAP_BAD(check, kd_blocks, block, min_x[lane], ENF_ERROR_RANGE, "the box does not hold cluster %u", item);
        }
    }
    return ENF_OK;
}

static EnfResult check_cell_tree(const EnfMapCheck *check, uint32_t i, Stamps *stamps) {
    const EnfMap *map = check->map;
    const EnfCell *cell = &map->cells[i];
    EnfKdTree tree = enf_map_cell_tree(map, i);
    EnfError inner;
    uint32_t own = 0;
    if (enf_kd_check(&tree, map->clusters_count, &inner)) {
        return tree_bad(check, ENF_CHUNK_kd_nodes, cell->node_first, "cell", i, &inner);
    }
    EnfResult result = ENF_OK;
    for (uint32_t b = 0; result == ENF_OK && b < cell->block_count; b++) {
        result = check_cell_block(check, i, cell->block_first + b, stamps, &own);
    }
    if (result == ENF_OK && own != cell->cluster_count) {
        return ENF_MAP_BAD(check, cells, i, node_first, ENF_ERROR_INDEX, "its tree holds %u of its %u clusters", own,
                           cell->cluster_count);
    }
    return result;
}

/* The box of a cell in the tree of cells, rounded outward by whoever wrote it; a grid step covers the rounding of the
 * subtraction here, and nothing smaller is placed. */
static bool cell_box_holds(const EnfMap *map, const EnfKdBlock *b, uint32_t lane, const EnfCell *cell) {
    const float low[3] = {b->min_x[lane], b->min_y[lane], b->min_z[lane]};
    const float high[3] = {b->max_x[lane], b->max_y[lane], b->max_z[lane]};
    bool holds = true;
    for (int axis = 0; axis < 3; axis++) {
        double shift = cell->origin[axis] - map->tree_origin[axis];
        holds = holds && (double)low[axis] <= shift + (double)cell->min[axis] + ENF_GRID_STEP &&
                (double)high[axis] >= shift + (double)cell->max[axis] - ENF_GRID_STEP;
    }
    return holds;
}

static EnfResult check_tree_of_cells(const EnfMapCheck *check, Stamps *stamps) {
    const EnfMap *map = check->map;
    EnfKdTree tree = {map->cell_nodes, map->cell_blocks, map->cell_nodes_count, map->cell_blocks_count};
    EnfError inner;
    uint32_t found = 0, expected = 0;
    if (enf_kd_check(&tree, map->cells_count, &inner)) {
        return tree_bad(check, ENF_CHUNK_cell_nodes, 0, "all cells", map->cells_count, &inner);
    }
    for (uint32_t b = 0; b < map->cell_blocks_count; b++) {
        for (uint32_t lane = 0; lane < ENF_KD_BLOCK; lane++) {
            uint32_t item = map->cell_blocks[b].item[lane];
            if (item == ENF_NONE) {
                continue;
            }
            if (stamps->seen[item] || map->cells[item].flags & ENF_CELL_OUTSIDE) {
                return ENF_MAP_BAD(check, cell_blocks, b, item[lane], ENF_ERROR_INDEX,
                                   "cell %u is there twice, or is the outside", item);
            }
            stamps->seen[item] = 1;
            found++;
            if (!cell_box_holds(map, &map->cell_blocks[b], lane, &map->cells[item])) {
                return ENF_MAP_BAD(check, cell_blocks, b, min_x[lane], ENF_ERROR_RANGE, "the box does not hold cell %u", item);
            }
        }
    }
    for (uint32_t i = 0; i < map->cells_count; i++) {
        expected += !(map->cells[i].flags & ENF_CELL_OUTSIDE);
    }
    return found == expected ? ENF_OK
                             : enf_error_set(check->error, ENF_ERROR_FORMAT, check->offsets[ENF_CHUNK_cell_blocks],
                                             "chunk CKDB: cell_blocks: %u of %u cells are in the tree", found, expected);
}

EnfResult enf_map_check_geometry(const EnfMapCheck *check) {
    const EnfMap *map = check->map;
    const EnfAllocator *allocator = map->file.allocator;
    EnfResult result = ENF_OK;
    for (uint32_t i = 0; result == ENF_OK && i < map->clusters_count; i++) {
        result = check_cluster(check, i);
    }
    if (result != ENF_OK) {
        return result;
    }
    Stamps stamps = {NULL, (map->clusters_count > map->cells_count ? map->clusters_count : map->cells_count) + 1};
    stamps.seen = enf_alloc(allocator, stamps.count, sizeof *stamps.seen);
    if (!stamps.seen) {
        return enf_error_set(check->error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory to check the trees");
    }
    for (uint32_t i = 0; result == ENF_OK && i < map->cells_count; i++) {
        result = check_cell_tree(check, i, &stamps);
    }
    if (result == ENF_OK) {
        memset(stamps.seen, 0, stamps.count * sizeof *stamps.seen);
        result = check_tree_of_cells(check, &stamps);
    }
    enf_free(allocator, stamps.seen, stamps.count, sizeof *stamps.seen);
    return result;
}
