/* The smallest map that has a record in every table, for what reads, checks and damages maps: two rooms in a row, a cupboard with a
 * bound in one of them, a mirror, a pair of teleports, an overlap, a light through a window, a texture, a camera, entities, paths.
 *
 * Cells: 0 "hall-room", 1 "study_Room", 2 "cupboard". Half-portals by cell: 0 door, 1 link, 2 mirror, 3 teleport; 4 door,
 * 5 teleport; 6 link. */
#ifndef ENF_SCENES_EVERYTHING_H
#define ENF_SCENES_EVERYTHING_H

#include "scenes/maker.h"

/** NULL with `error` if the map is not sound. Its map is enf_maker_map's. */
EnfMaker *enf_everything_create(EnfError *error);

#endif
