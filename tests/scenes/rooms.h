/* A grid of box rooms with doors: the first scene of most suites. Rooms touch (walls have no thickness), so every point of the block
 * but those on walls lies in exactly one room, and which one is known without any search. */
#ifndef ENF_SCENES_ROOMS_H
#define ENF_SCENES_ROOMS_H

#include "scenes/maker.h"

typedef struct EnfRoomsDef {
    uint32_t nx, nz;                /**< rooms along x and z */
    EnfVec3 origin;                 /**< world position of the block's lowest corner */
    EnfVec3 room;                   /**< size of a room, metres */
    double door_width, door_height; /**< metres; 0 by 0: no doors */
    uint32_t door_percent;          /**< share of the inner walls that have a door */
    uint32_t furniture;             /**< boxes a room, a cluster each, none touching another or a wall */
    bool thresholds;                /**< a flat box through each door, listed in both rooms */
    bool lights;                    /**< a lamp a room */
    uint64_t seed;
    void (*extend)(EnfMaker *maker); /**< adds what a scene needs beside rooms (meshes, materials), or NULL */
} EnfRoomsDef;

/** 4 × 4 rooms of 5 × 3 × 5 m at the origin, doors of 1 × 2 m in every wall, 4 boxes a room. */
EnfRoomsDef enf_rooms_def_default(void);

typedef struct EnfRooms {
    EnfRoomsDef def; /**< sizes rounded to 2^-8 m */
    const EnfMap *map;
    EnfMaker *maker;
} EnfRooms;

/** False with `error` if the definition gives no sound map. Sizes are rounded to 2^-8 m. */
bool enf_rooms_create(EnfRooms *rooms, const EnfRoomsDef *def, EnfError *error);
void enf_rooms_destroy(EnfRooms *rooms);

/** Cell (ix, iz) is number iz * nx + ix. The cell of a point by arithmetic; ENF_NONE outside the block. */
uint32_t enf_rooms_cell_at(const EnfRooms *rooms, EnfVec3 p_ws);
/** World box of a room. */
EnfBox3 enf_rooms_box(const EnfRooms *rooms, uint32_t cell);
/** Is `p_ws` within `margin` of a box of furniture or a threshold? */
bool enf_rooms_in_furniture(const EnfRooms *rooms, EnfVec3 p_ws, double margin);

#endif
