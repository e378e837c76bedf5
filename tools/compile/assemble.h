/* EnfAssembly: an EnfMap in the making. Every stage of the compiler ends here, in the arrays that the map's file holds. */
#ifndef ENFILADE_COMPILE_ASSEMBLE_H
#define ENFILADE_COMPILE_ASSEMBLE_H

#include "compile/array.h"
#include "compile/clusters.h"
#include "compile/strings.h"

/** One growing array for each chunk of a map, by the map's own table. `strings` is filled at the end, from `texts`. */
typedef struct EnfAssembly {
#define ENF_ASSEMBLY_ARRAY(type, array, fourcc) ENF_ARRAY(type) array;
    ENF_MAP_CHUNKS(ENF_ASSEMBLY_ARRAY)
#undef ENF_ASSEMBLY_ARRAY
    double tree_origin[3];
    EnfStrings texts;
    uint32_t *node_lights;   /**< a source node → its light in `lights`, or ENF_NONE */
    uint32_t *node_entities; /**< a source node → its entity, or ENF_NONE */
} EnfAssembly;

/** What the map is made of. `clusters` is emptied: its arrays move into the map. */
typedef struct EnfAssemblyParts {
    const EnfSource *source;
    const EnfLayout *layout;
    const EnfSoup *soup;
    const EnfReach *reach;
    EnfClusters *clusters;
    const EnfCompileSettings *settings;
    EnfDiagnosis *diagnosis;
} EnfAssemblyParts;

/** Fills a zeroed assembly. Free with enf_assembly_free, also after a failure. */
EnfResult enf_assemble(EnfAssembly *assembly, const EnfAssemblyParts *parts, EnfError *error);
void enf_assembly_free(EnfAssembly *assembly);

/** The assembly seen as a map; valid while the assembly is not changed. */
EnfMap enf_assembly_map(const EnfAssembly *assembly, uint64_t source_hash);

/** A number as a finite float: hostile transforms and intensities overflow. */
static inline float enf_finite_float(double value) {
    const double most = 3.4028234663852886e38; /* FLT_MAX */
    return (float)(value > most ? most : value < -most ? -most : value);
}

/* The stages, in order. Each needs those before it; false when out of memory or when a table has no room. */

/** Cells (without trees and lights), portals, transforms, bound planes. */
bool enf_assemble_cells(EnfAssembly *assembly, const EnfAssemblyParts *parts);
/** Images (halved until they fit), textures, materials. Errors: SIZE when the pixels do not fit a map. */
EnfResult enf_assemble_materials(EnfAssembly *assembly, const EnfAssemblyParts *parts, EnfError *error);
/** Clusters, vertices, indices; each cell's tree over its own clusters and those that reach into it; the cells' bounds; the tree
 *  over all cells. */
EnfResult enf_assemble_trees(EnfAssembly *assembly, const EnfAssemblyParts *parts, EnfError *error);
/** Lights, and what of each cell they reach (lights.c). */
bool enf_assemble_lights(EnfAssembly *assembly, const EnfAssemblyParts *parts);
/** Entities, cameras, paths. */
bool enf_assemble_entities(EnfAssembly *assembly, const EnfAssemblyParts *parts);

/** The cell of a node: by its place in the hierarchy, or, if it is loose, by where it stands; ENF_NONE if in none. */
uint32_t enf_assembly_node_cell(const EnfAssembly *assembly, const EnfAssemblyParts *parts, uint32_t node);

#endif
