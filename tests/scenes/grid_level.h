/* A level of any size as a .glb file: storeys of rooms on a square grid, a door in every wall between two rooms, a hatch in every
 * floor between two storeys, furniture instanced. For the benchmark of the compiler and for its tests. */
#ifndef ENF_TESTS_SCENES_GRID_LEVEL_H
#define ENF_TESTS_SCENES_GRID_LEVEL_H

#include <enfilade/base.h>

typedef struct EnfGridLevel {
    uint32_t rooms_x, rooms_z, storeys;
    uint32_t tables; /**< a room; 60 triangles each */
    bool lights;     /**< a lamp in every room */
    bool named;      /**< false: without any `-room` and `-portal` name */
} EnfGridLevel;

typedef struct EnfGridLevelCounts {
    uint32_t cells, portals, triangles;
} EnfGridLevelCounts;

/** Metres: rooms are ENF_GRID_ROOM square and ENF_GRID_STOREY high; room (0, 0, 0) begins at the origin. */
#define ENF_GRID_ROOM 4.0
#define ENF_GRID_STOREY 3.0

/** Writes the level; `counts` (may be NULL) says what is in it. */
EnfResult enf_grid_level_write(const EnfGridLevel *level, const char *path, EnfGridLevelCounts *counts, EnfError *error);

#endif
