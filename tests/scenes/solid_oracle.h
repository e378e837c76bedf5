/* The oracle of collision: every triangle of a map that collides, in a plain grid of its own (no cell, no kd-tree) or in none, and
 * distances by the general formulas for any segment and triangle. The distance along a straight move is convex, so its least is
 * found by golden section and the first contact by halving. Slow, and of no code that it judges. */
#ifndef ENF_SCENES_SOLID_ORACLE_H
#define ENF_SCENES_SOLID_ORACLE_H

#include <enfilade/collide.h>

typedef struct EnfOracleTriangle {
    EnfVec3 corner[3];
    EnfBox3 box;
    uint32_t cluster, triangle;
} EnfOracleTriangle;

typedef struct EnfOracle {
    EnfOracleTriangle *triangles;
    uint32_t count;
    EnfBox3 bounds;
    uint32_t size[3];
    uint32_t *starts, *items; /**< of each grid box: items[starts[i] .. starts[i + 1]) */
    uint32_t *stamps, stamp;
    uint32_t *near, near_count; /**< what enf_oracle_near found */
} EnfOracle;

/** False, and nothing to free, without memory or triangles. */
bool enf_oracle_build(EnfOracle *oracle, const EnfMap *map);
void enf_oracle_free(EnfOracle *oracle);

/** Triangles whose boxes touch `box`: by the grid, or by looking at every one. */
void enf_oracle_near(EnfOracle *oracle, EnfBox3 box, bool every);
/** What a capsule's move sweeps over, widened a little. */
EnfBox3 enf_oracle_box(const EnfCapsule *capsule, EnfVec3 from, EnfVec3 delta);

/** From the axis of an upright capsule with its feet at `at` to a triangle. */
double enf_oracle_distance(const EnfOracleTriangle *triangle, const EnfCapsule *capsule, EnfVec3 at);
/** A straight move. */
typedef struct EnfOracleMove {
    EnfCapsule capsule;
    EnfVec3 from, delta;
} EnfOracleMove;
/** The least distance along a move, and where on it (0..1). */
double enf_oracle_least(const EnfOracleTriangle *triangle, const EnfOracleMove *move, double *where);

/* Of the triangles that enf_oracle_near found: */

/** How deep is the capsule in the deepest? <= 0: in none. */
double enf_oracle_depth(const EnfOracle *oracle, const EnfCapsule *capsule, EnfVec3 at);
/** Does a straight move carry the axis (its ends and its middle) through a surface? */
bool enf_oracle_tunnels(const EnfOracle *oracle, const EnfCapsule *capsule, EnfVec3 from, EnfVec3 to);
/** Is there contact on the way; and how far is it free, 0..1? As enf_collide_sweep has it. */
bool enf_oracle_sweep(const EnfOracle *oracle, const EnfOracleMove *move, double *free);

#endif
