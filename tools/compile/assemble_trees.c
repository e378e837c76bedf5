/* The kd-trees of a map: one a cell over the clusters that lie in it or reach into it, and one over all cells. */
#include "compile/assemble.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* A cluster in a cell that is not its home. */
typedef struct Guest {
    uint32_t cell, cluster;
} Guest;

typedef struct Trees {
    EnfAssembly *assembly;
    const EnfAssemblyParts *parts;
    ENF_ARRAY(Guest) guests;
    uint32_t *guest_first; /* guests of cell c: [guest_first[c], guest_first[c + 1]), once sorted */
    ENF_ARRAY(EnfBox3f) boxes;
    ENF_ARRAY(uint32_t) items;
} Trees;

/* ---- guests ----------------------------------------------------------------------------------------------------- */

static bool find_guests(Trees *trees) {
    const EnfClusters *clusters = trees->parts->clusters;
    uint32_t cell_count = trees->parts->layout->cell_count;
    uint32_t *found = malloc(((size_t)cell_count + 1) * sizeof *found);
    bool ok = found != NULL;
    for (uint32_t i = 0; i < clusters->cluster_count && ok; i++) {
        const EnfCluster *cluster = &clusters->clusters[i];
        const uint32_t *triangles = clusters->triangles + cluster->index_first / 3;
        uint32_t count = enf_reach_query(trees->parts->reach, triangles, cluster->index_count / 3, cluster->cell, found,
                                         cell_count);
        ok = ENF_ARRAY_ROOM(&trees->guests, count);
        for (uint32_t k = 0; k < count && ok; k++) {
            trees->guests.data[trees->guests.count++] = (Guest){found[k], i};
        }
    }
    free(found);
    return ok;
}

/* Stable, by cell: within a cell the guests stay ordered by cluster. */
static bool sort_guests(Trees *trees) {
    uint32_t cell_count = trees->parts->layout->cell_count;
    uint32_t *first = calloc((size_t)cell_count + 2, sizeof *first);
    Guest *sorted = malloc(((size_t)trees->guests.count + 1) * sizeof *sorted);
    if (!first || !sorted) {
        free(first);
        free(sorted);
        return false;
    }
    for (uint32_t i = 0; i < trees->guests.count; i++) {
        first[trees->guests.data[i].cell + 2]++;
    }
    for (uint32_t c = 2; c < cell_count + 2; c++) {
        first[c] += first[c - 1];
    }
    for (uint32_t i = 0; i < trees->guests.count; i++) {
        sorted[first[trees->guests.data[i].cell + 1]++] = trees->guests.data[i];
    }
    free(trees->guests.data);
    trees->guests.data = sorted;
    trees->guests.capacity = trees->guests.count + 1;
    trees->guest_first = first;
    return true;
}

/* ---- a cell's tree ---------------------------------------------------------------------------------------------- */

/* The cluster's box in the coordinates of `cell`: as stored in its home, outward elsewhere. */
static EnfBox3f box_in_cell(const EnfAssembly *assembly, const EnfCluster *cluster, uint32_t cell) {
    EnfBox3f box;
    memcpy(&box.min, cluster->min, sizeof box.min);
    memcpy(&box.max, cluster->max, sizeof box.max);
    if (cluster->cell == cell) {
        return box;
    }
    const double *home = assembly->cells.data[cluster->cell].origin, *here = assembly->cells.data[cell].origin;
    EnfVec3 shift = {home[0] - here[0], home[1] - here[1], home[2] - here[2]};
    EnfBox3 wide = enf_box3_from_f(box);
    wide.min = enf_add(wide.min, shift);
    wide.max = enf_add(wide.max, shift);
    return enf_box3f_outward(wide);
}

static bool add_item(Trees *trees, uint32_t cell, uint32_t cluster) {
    if (!ENF_ARRAY_ROOM(&trees->boxes, 1) || !ENF_ARRAY_ROOM(&trees->items, 1)) {
        return false;
    }
    trees->boxes.data[trees->boxes.count++] = box_in_cell(trees->assembly, &trees->assembly->clusters.data[cluster], cell);
    trees->items.data[trees->items.count++] = cluster;
    return true;
}

static bool append_tree(EnfAssembly *assembly, EnfCell *cell, const EnfKdBuilt *built) {
    cell->node_first = assembly->kd_nodes.count;
    cell->node_count = built->node_count;
    cell->block_first = assembly->kd_blocks.count;
    cell->block_count = built->block_count;
    if (!ENF_ARRAY_ROOM(&assembly->kd_nodes, built->node_count) || !ENF_ARRAY_ROOM(&assembly->kd_blocks, built->block_count)) {
        return false;
    }
    if (built->node_count > 0) {
        memcpy(assembly->kd_nodes.data + cell->node_first, built->nodes, built->node_count * sizeof *built->nodes);
        memcpy(assembly->kd_blocks.data + cell->block_first, built->blocks, built->block_count * sizeof *built->blocks);
    }
    assembly->kd_nodes.count += built->node_count;
    assembly->kd_blocks.count += built->block_count;
    return true;
}

static void widen(EnfCell *cell, EnfBox3f box) {
    const float min[3] = {box.min.x, box.min.y, box.min.z}, max[3] = {box.max.x, box.max.y, box.max.z};
    for (int axis = 0; axis < 3; axis++) {
        cell->min[axis] = min[axis] < cell->min[axis] ? min[axis] : cell->min[axis];
        cell->max[axis] = max[axis] > cell->max[axis] ? max[axis] : cell->max[axis];
    }
}

static EnfResult build_cell(Trees *trees, uint32_t index, EnfError *error) {
    EnfAssembly *assembly = trees->assembly;
    const EnfClusters *clusters = trees->parts->clusters;
    EnfCell *cell = &assembly->cells.data[index];
    cell->cluster_first = clusters->cell_first[index];
    cell->cluster_count = clusters->cell_first[index + 1] - cell->cluster_first;
    trees->boxes.count = trees->items.count = 0;
    bool ok = true;
    for (uint32_t i = 0; i < cell->cluster_count && ok; i++) {
        ok = add_item(trees, index, cell->cluster_first + i);
    }
    for (uint32_t i = trees->guest_first[index]; i < trees->guest_first[index + 1] && ok; i++) {
        ok = add_item(trees, index, trees->guests.data[i].cluster);
    }
    if (!ok) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for the tree of a cell");
    }
    for (uint32_t i = 0; i < trees->boxes.count; i++) {
        widen(cell, trees->boxes.data[i]);
    }
    EnfKdBuilt built;
    EnfResult result = enf_kd_build(&built, trees->boxes.data, trees->items.data, trees->items.count, NULL, error);
    if (result == ENF_OK) {
        ok = append_tree(assembly, cell, &built);
        enf_kd_built_free(&built);
    }
    return ok ? result : enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for the trees");
}

/* ---- the tree of cells ------------------------------------------------------------------------------------------ */

static bool add_cell_box(Trees *trees, uint32_t index) {
    const EnfCell *cell = &trees->assembly->cells.data[index];
    const double *origin = trees->assembly->tree_origin;
    EnfVec3 shift = {cell->origin[0] - origin[0], cell->origin[1] - origin[1], cell->origin[2] - origin[2]};
    EnfBox3 box = {{(double)cell->min[0], (double)cell->min[1], (double)cell->min[2]},
                   {(double)cell->max[0], (double)cell->max[1], (double)cell->max[2]}};
    box.min = enf_add(box.min, shift);
    box.max = enf_add(box.max, shift);
    if (!ENF_ARRAY_ROOM(&trees->boxes, 1) || !ENF_ARRAY_ROOM(&trees->items, 1)) {
        return false;
    }
    trees->boxes.data[trees->boxes.count++] = enf_box3f_outward(box);
    trees->items.data[trees->items.count++] = index;
    return true;
}

static EnfResult build_tree_of_cells(Trees *trees, EnfError *error) {
    EnfAssembly *assembly = trees->assembly;
    bool ok = true;
    trees->boxes.count = trees->items.count = 0;
    if (assembly->cells.count > 0) {
        memcpy(assembly->tree_origin, assembly->cells.data[0].origin, sizeof assembly->tree_origin);
    }
    for (uint32_t i = 0; i < assembly->cells.count && ok; i++) {
        bool outside = assembly->cells.data[i].flags & ENF_CELL_OUTSIDE;
        ok = outside || add_cell_box(trees, i);
    }
    EnfKdBuilt built;
    EnfResult result = ENF_OK;
    if (ok) {
        result = enf_kd_build(&built, trees->boxes.data, trees->items.data, trees->items.count, NULL, error);
    }
    if (!ok || result != ENF_OK) {
        return ok ? result : enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for the tree of cells");
    }
    ok = ENF_ARRAY_ROOM(&assembly->cell_nodes, built.node_count) && ENF_ARRAY_ROOM(&assembly->cell_blocks, built.block_count);
    if (ok && built.node_count > 0) {
        memcpy(assembly->cell_nodes.data, built.nodes, built.node_count * sizeof *built.nodes);
        memcpy(assembly->cell_blocks.data, built.blocks, built.block_count * sizeof *built.blocks);
        assembly->cell_nodes.count = built.node_count;
        assembly->cell_blocks.count = built.block_count;
    }
    enf_kd_built_free(&built);
    return ok ? ENF_OK : enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for the tree of cells");
}

/* ---- all -------------------------------------------------------------------------------------------------------- */

/* The arrays of EnfClusters become the map's; the nodes of clusters become names. */
static void take_clusters(EnfAssembly *assembly, const EnfAssemblyParts *parts) {
    EnfClusters *clusters = parts->clusters;
    assembly->vertices.data = clusters->vertices;
    assembly->vertices.count = assembly->vertices.capacity = clusters->vertex_count;
    assembly->indices.data = clusters->indices;
    assembly->indices.count = assembly->indices.capacity = clusters->index_count;
    assembly->clusters.data = clusters->clusters;
    assembly->clusters.count = assembly->clusters.capacity = clusters->cluster_count;
    clusters->vertices = NULL;
    clusters->indices = NULL;
    clusters->clusters = NULL;
    for (uint32_t i = 0; i < assembly->clusters.count; i++) {
        EnfCluster *cluster = &assembly->clusters.data[i];
        cluster->node = enf_strings_add(&assembly->texts, parts->source->nodes[cluster->node].name);
    }
}

EnfResult enf_assemble_trees(EnfAssembly *assembly, const EnfAssemblyParts *parts, EnfError *error) {
    Trees trees;
    memset(&trees, 0, sizeof trees);
    trees.assembly = assembly;
    trees.parts = parts;
    EnfResult result = ENF_OK;
    if (!find_guests(&trees) || !sort_guests(&trees)) {
        result = enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for clusters that reach into cells");
    } else {
        take_clusters(assembly, parts);
    }
    for (uint32_t i = 0; i < assembly->cells.count && result == ENF_OK; i++) {
        result = build_cell(&trees, i, error);
    }
    if (result == ENF_OK) {
        result = build_tree_of_cells(&trees, error);
    }
    free(trees.guests.data);
    free(trees.guest_first);
    free(trees.boxes.data);
    free(trees.items.data);
    return result;
}
