/* A night in two rooms: what the game's rules are tested on. West room x 0..8, east room x 8..16, both y 0..6 and z 0..8, between them
 * a doorway at z 3.5..4.5 of 2.25 m. The player starts at (2, 0, 4) and the way out is the corner about (1, 0, 1). */
#ifndef ENF_SCENES_NIGHT_H
#define ENF_SCENES_NIGHT_H

#include "scenes/maker.h"

typedef struct EnfNightDef {
    bool door;   /**< a hinged leaf in the doorway, "door" */
    bool swings; /**< it goes both ways, away from who opens it */
    bool locked; /**< it wants the key "brass", which lies in the west at (2, 0.8, 6.5) as "key" */
    bool guard;  /**< walks z 1 to 7 and back at x 13 in the east, 8 s a way, "guard" */
    bool
        lift; /**< a plate about (6, 0, 7) with stops at 0 and 2 m, "lift", and a button for it, "button", at (7.9, 1.2, 7.9) */
    bool sounds; /**< a fountain in the west at (4, 0, 7); a clock in the east at (14, 2, 6) that shows 0:59:58 at the start */
    bool
        stage; /**< in the west a stage 1.5 m high, x 0..2.5 and z 5.5..8, steps up to it from x 4.5, and a screen of 1.5 m before
                     the doorway at x 6, z 2..6, that one has to go round */
    bool lamps; /**< a lamp in each room; else nothing is lit, which is the same as evenly lit */
} EnfNightDef;

typedef struct EnfNight {
    EnfMaker *maker;
    const EnfMap *map;
    uint32_t west, east; /**< cells */
    uint32_t portal;     /**< half-portal out of the west */
} EnfNight;

/** Always there: the exhibit "vase" (value 3) at (14, 0.8, 4) in the east. False with `error` if it gives no sound map. */
bool enf_night_create(EnfNight *night, const EnfNightDef *def, EnfError *error);
void enf_night_destroy(EnfNight *night);

#endif
