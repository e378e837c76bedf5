/* A box of voxels: surfaces mark every voxel that they touch, and a flood runs through the faces of the others. What is marked is a
 * little too much, so a wall without thickness holds, and an opening narrower than three voxels may count as shut. */
#ifndef ENFILADE_COMPILE_REGIONS_VOXELS_H
#define ENFILADE_COMPILE_REGIONS_VOXELS_H

#include <enfilade/math.h>

typedef struct EnfVoxels {
    EnfVec3 min;
    double size; /**< metres: edge of a voxel */
    int n[3];
    uint8_t *solid;         /**< by voxel: 1 marked, 2 flooded */
    uint32_t *queue, *from; /**< the flood's order, and by voxel which one it came from */
    uint32_t capacity;      /**< voxels that the arrays hold */
} EnfVoxels;

/** Voxels of at most `size` metres over `box` and two rows around it; larger ones if there were more than `limit`. Reuses memory. */
bool enf_voxels_reset(EnfVoxels *voxels, EnfBox3 box, double size, uint32_t limit);
void enf_voxels_free(EnfVoxels *voxels);
void enf_voxels_mark(EnfVoxels *voxels, const EnfVec3 triangle[3]);
/** Is a voxel of the triangle, or one beside it, flooded? What a flood was stopped by is seen from it. */
bool enf_voxels_meets_flood(EnfVoxels *voxels, const EnfVec3 triangle[3]);

/** Voxel that holds p, or ENF_NONE outside the box. */
uint32_t enf_voxels_at(const EnfVoxels *voxels, EnfVec3 p);
/** Floods from `seed_count` voxels. Returns the first voxel of the outermost row that is reached, or ENF_NONE; its way back is in `from`
 *  (seeds point to themselves). Marks made by an earlier flood are forgotten. */
uint32_t enf_voxels_flood(EnfVoxels *voxels, const uint32_t *seeds, uint32_t seed_count);
EnfVec3 enf_voxels_centre(const EnfVoxels *voxels, uint32_t voxel);

#endif
