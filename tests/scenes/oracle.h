/* Brute-force visibility: rays from the eye through points of the picture against every triangle of the map, no cell, portal, tree
 * or window involved. What a ray meets first is visible, without a doubt; so it must be in the visible set. */
#ifndef ENF_SCENES_ORACLE_H
#define ENF_SCENES_ORACLE_H

#include <enfilade/vis.h>

/** The first front (or double-sided) surface met by the ray through picture point (x_px, y_px), y up. False if none, or if the
 *  ray passes so close to an edge (relative 1e-7) that what it meets is open to doubt. `triangle` counts within the cluster. */
bool enf_oracle_ray(const EnfMap *map, const EnfCamera *camera, double x_px, double y_px, uint32_t *cluster, double *t);

/** Is `cluster` among the entries of space 0? */
bool enf_oracle_listed(const EnfVisSet *set, uint32_t cluster);

#endif
