/* A compiled level with things in it that go about: a map like another one, and movers. For what compares pictures of real levels with
 * moving objects in them. */
#ifndef ENF_SCENES_PEOPLED_H
#define ENF_SCENES_PEOPLED_H

#include <enfilade/map.h>

/** Writes `map` with `movers` more: boxes the size of a person, opaque and of glass, on paths (linear and cubic, some turning) from a
 *  point of a cell to others of this cell and of the cells beside it, through walls if need be, at about 2 m/s. */
EnfResult enf_peopled_write(const EnfMap *map, uint32_t movers, uint64_t seed, const char *path, EnfError *error);

#endif
