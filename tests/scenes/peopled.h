/* A compiled level with things in it that go about: a map like another one, and movers. For what compares pictures of real levels with
 * moving objects in them. */
#ifndef ENF_SCENES_PEOPLED_H
#define ENF_SCENES_PEOPLED_H

#include <enfilade/map.h>

/** Writes `map` with `movers` more: boxes the size of a person, opaque and of glass, on paths (linear and cubic) about a cell or through
 *  a portal into the next, at about 2 m/s, through walls and furniture if need be. */
EnfResult enf_peopled_write(const EnfMap *map, uint32_t movers, uint64_t seed, const char *path, EnfError *error);

#endif
