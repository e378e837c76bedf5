/* EnfClusters: the soup's triangles as the engine draws them: clusters of one cell and one material, ≤ 128 triangles, compact in
 * space, vertices relative to the cell's origin, in the order that suits a vertex cache. */
#ifndef ENFILADE_COMPILE_CLUSTERS_H
#define ENFILADE_COMPILE_CLUSTERS_H

#include "compile/soup.h"

#define ENF_CLUSTER_TRIANGLES 128

/** Arrays as in EnfMap, except that EnfCluster.node is a source node's number. */
typedef struct EnfClusters {
    EnfVertex *vertices;
    uint32_t vertex_count;
    uint32_t *indices;
    uint32_t index_count;
    EnfCluster *clusters; /**< ordered by (cell, material), then by place */
    uint32_t cluster_count;
    uint32_t *triangles;  /**< soup triangles; those of cluster i are [index_first / 3, (index_first + index_count) / 3) */
    uint32_t *cell_first; /**< clusters of cell c: [cell_first[c], cell_first[c + 1]) */
} EnfClusters;

/** Every triangle of the soup must have a home cell. Free with enf_clusters_free.
 *  @guarantee tests/unit/test_clusters: every triangle once, bounds tight, positions exact within 4,096 m of the origin.
 *  @cost O(n log n) */
EnfResult enf_clusters_build(EnfClusters *clusters, const EnfSoup *soup, const EnfLayout *layout, EnfError *error);
void enf_clusters_free(EnfClusters *clusters);

/** Sorts triangles[0..count) (numbers of soup triangles) into runs of at most ENF_CLUSTER_TRIANGLES that are compact in space;
 *  marks the first of each run: starts[i] = 1 if a run begins at i. Deterministic. Source: the surface-area heuristic over
 *  bins, Wald 2007, applied to runs instead of leaves. */
void enf_cluster_partition(const EnfSoup *soup, uint32_t *triangles, uint32_t count, uint8_t *starts);

#endif
