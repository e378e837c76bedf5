/* What opens when a visitor uses it: doors, lifts, and the buttons that send them. */
#ifndef ENFREPLAY_DOORS_H
#define ENFREPLAY_DOORS_H

#include <enfilade/world.h>

/** A mover that swings or slides. */
typedef struct Door {
    uint32_t mover; /**< also its object in the world */
    EnfMotion motion;
    double open;        /**< radians or metres: where it goes when it opens */
    int64_t close_tick; /**< when it closes by itself; INT64_MAX: never */
} Door;

typedef struct Doors {
    const EnfMap *map;
    EnfWorld *world;
    EnfPortals *portals;
    Door *doors;
    uint32_t count;
    uint8_t *passable; /**< scratch: a byte a half-portal */
} Doors;

/** The doors of a world whose objects are the movers of its map, in order. Borrows world and portals. ERROR_MEMORY. */
EnfResult doors_create(Doors *doors, EnfWorld *world, EnfPortals *portals, EnfError *error);
void doors_destroy(Doors *doors);

/** Uses what is before the eye (within reach, the nearest), else the lift that carries the visitor (`ground_object`, or ENF_NONE). */
void doors_use(Doors *doors, EnfVec3 eye_ws, EnfVec3 forward, uint32_t ground_object);
/** After the world's tick: doors that nobody stands in close by themselves; one that squeezes the visitor (`squeezed_by`, or
 *  ENF_NONE) turns back; portals are open where a leaf is not shut. */
void doors_tick(Doors *doors, EnfVec3 feet_ws, uint32_t squeezed_by);
uint64_t doors_hash(const Doors *doors);

#endif
