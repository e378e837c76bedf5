/* The grid of rooms with life in it: doors that turn on their hinges and close their portals, lifts and drawers that slide, things on
 * paths (linear, cubic, turning, growing, mirrored), free ones that walk a circle, glass and lattice among them; and events: doors
 * sent, objects teleported, dying, born. For tests, benchmarks and pictures; everything follows from the seed and the tick. */
#ifndef ENF_SCENES_MOVING_ROOMS_H
#define ENF_SCENES_MOVING_ROOMS_H

#include <enfilade/world.h>

#include "scenes/rooms.h"

typedef struct EnfMovingRoomsDef {
    EnfRoomsDef rooms;
    uint32_t movers; /**< a room, beside its doors */
    bool events;     /**< things are sent, teleported, removed and added; else only motions run */
    bool trail;      /**< enf_world_set_trail */
} EnfMovingRoomsDef;

/** 4 × 4 rooms with 8 movers each, events, no trails. */
EnfMovingRoomsDef enf_moving_rooms_def_default(void);

typedef struct EnfMovingThing EnfMovingThing;
typedef struct EnfMovingRooms {
    EnfMovingRoomsDef def;
    EnfRooms rooms;
    EnfPortals portals;
    EnfWorld *world;
    EnfMovingThing *things; /**< what each object was made from: doors first */
    uint32_t thing_count, door_count;
} EnfMovingRooms;

/** False with `error` if there is no sound map. */
bool enf_moving_rooms_create(EnfMovingRooms *moving, const EnfMovingRoomsDef *def, EnfError *error);
void enf_moving_rooms_destroy(EnfMovingRooms *moving);

/** One tick on: the world, its events, the portals of doors that came to rest or left it. */
void enf_moving_rooms_step(EnfMovingRooms *moving);

#endif
