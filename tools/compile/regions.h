/* What the parts of the regions share: regions.c (the order of work), regions_loose.c (homes of loose triangles), regions_overlap.c
 * (cells that share space), regions_leak.c and regions_voxels.c (cells that are not closed), reach.c (clusters in several cells). */
#ifndef ENFILADE_COMPILE_REGIONS_H
#define ENFILADE_COMPILE_REGIONS_H

#include "compile/array.h"
#include "compile/shell.h"
#include "compile/soup.h"

/** What is known of a material's faces. */
enum { ENF_FACE_OPEN = 1 /**< closes nothing off */, ENF_FACE_TWO_SIDED = 2 };

/** Cells as regions of space: shells of the soup and the portals, a tree over their boxes. */
typedef struct EnfSpace {
    const EnfLayout *layout;
    const EnfSoup *soup;
    uint8_t *faces; /**< ENF_FACE_* by material */
    uint32_t material_count;
    uint32_t *portal_first; /**< half-portals of cell c: [portal_first[c], portal_first[c + 1]) */
    uint32_t *fan_first;    /**< triangles of portal p, as a fan: [fan_first[p], fan_first[p + 1]) */
    bool *furnished;        /**< by cell: its author put sealing triangles into it */
    uint32_t cell_count, portal_count;
    EnfShells shells;
    EnfKdBuilt tree; /**< items are cells, world boxes */
} EnfSpace;

/** Shells of every cell but OUTSIDE, from its triangles and portals. What is loose counts only where the author gave the cell nothing:
 *  a carpet under many rooms is the shell of none. Free with enf_space_free. */
bool enf_space_create(EnfSpace *space, const EnfLayout *layout, const EnfSoup *soup);
void enf_space_free(EnfSpace *space);

/** The world corners of a soup triangle. */
static inline void enf_soup_corners(const EnfSoup *soup, uint32_t triangle, EnfVec3 corners[3]) {
    for (int k = 0; k < 3; k++) {
        corners[k] = enf_grid_point(soup->vertices[soup->triangles[triangle].v[k]].p);
    }
}

/** The cell that p lies in: highest priority, then smallest box. ENF_NONE for none. */
uint32_t enf_space_locate(EnfSpace *space, EnfVec3 p);

typedef struct EnfRegions {
    EnfLayout *layout;
    EnfSoup *soup;
    const EnfSource *source;
    const EnfCompileSettings *settings;
    EnfDiagnosis *diagnosis;
} EnfRegions;

/** regions_loose.c. @return false if memory is out. */
bool enf_regions_loose(EnfRegions *regions);
/** regions_overlap.c: warns, and adds OVERLAP half-portals. */
bool enf_regions_overlaps(EnfRegions *regions, EnfSpace *space);
/** regions_leak.c: warns, and sets ENF_CELL_OPEN. */
bool enf_regions_leaks(EnfRegions *regions, EnfSpace *space);

#endif
