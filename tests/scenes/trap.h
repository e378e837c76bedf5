/* A small map that means harm: whoever walks it is hit, squeezed, dropped and carried through walls. For random input
 * (tests/replay/test_mash): what comes of all this is to be the same on every machine.
 *
 * Pit (x 0..6, z 0..6, its floor half a metre lower beyond x 3 and z 3; a ram crosses it and its walls at 20 m/s), mill (x 6..12,
 * z 0..6; beams turn twice a second, one growing and shrinking) and press (x 6..12, z 6..12, 2 m high; its ceiling comes down twice a
 * second; a plate goes up into it). Leaves fly in both doorways, one at 20 rad/s, one of a slide at 10 m/s that is locked; the far
 * wall of the press opens into the pit. A guard walks about the mill. */
#ifndef ENF_SCENES_TRAP_H
#define ENF_SCENES_TRAP_H

#include "scenes/maker.h"

/** NULL with `error` if it gives no sound map. Its map is enf_maker_map's. */
EnfMaker *enf_trap_create(EnfError *error);

#endif
