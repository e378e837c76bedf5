/* What the files of collision share: triangles near a capsule, solids with their poses, and the distance that all rests on. */
#ifndef ENFILADE_COLLIDE_INTERNAL_H
#define ENFILADE_COLLIDE_INTERNAL_H

#include <enfilade/collide.h>
#include <enfilade/tolerances.h>

/** A triangle that was gathered: world corners, of the level exact (they lie on its grid). */
typedef struct EnfNearTriangle {
    EnfVec3 corner[3];
    EnfVec3 normal; /**< unit, by the right-hand rule; zero for a degenerate one */
    EnfBox3 box;
    uint32_t cluster, triangle; /**< cluster ENF_NONE: of a solid */
    uint32_t solid;             /**< number of the solid, or ENF_NONE */
} EnfNearTriangle;

/** From a triangle to the axis of a capsule. */
typedef struct EnfNearest {
    double distance;
    EnfVec3 normal; /**< unit, from the triangle's nearest point to the axis; its front where they cross */
    EnfVec3 point;  /**< the triangle's nearest point, relative to the place that was asked for */
} EnfNearest;

/** `from` + `offset` is where the capsule's feet are. */
void enf_nearest(const EnfNearTriangle *triangle, const EnfCapsule *capsule, EnfVec3 from, EnfVec3 offset, EnfNearest *out);

/** A capsule under way. */
typedef struct EnfSweep {
    EnfCapsule capsule;
    EnfVec3 from, delta;
    double length;     /**< of delta */
    EnfBox3 box;       /**< everything that it sweeps over, with the skin */
    double t, contact; /**< the best so far: free until t, in contact at `contact` */
    EnfVec3 normal, point;
    const EnfNearTriangle *met; /**< or NULL */
    uint64_t tested, steps;
} EnfSweep;

EnfSweep enf_sweep_make(const EnfCapsule *capsule, EnfVec3 from, EnfVec3 delta);
void enf_sweep_triangle(EnfSweep *sweep, const EnfNearTriangle *triangle);

/** Why a solid does not count: it is the body itself; it is what pushes; the body is squeezed by it. */
enum { ENF_IGNORED_SELF = 1, ENF_IGNORED_PUSHING = 2, ENF_IGNORED_OVERLAPPED = 4 };

/** A thing that collides and moves. */
typedef struct EnfSolid {
    EnfVec3f *corners; /**< 3 × count */
    uint32_t count, object;
    EnfBox3 local, bounds; /**< bounds: for all time, world; empty where it roams */
    EnfPose pose, before;  /**< at `tick`, and one tick earlier where that is known (else the same) */
    int64_t tick;          /**< of `pose`; INT64_MIN: never asked */
    bool on;
    uint8_t ignored; /**< ENF_IGNORED_*: by the move that is being made */
} EnfSolid;

struct EnfCollider {
    const EnfMap *map;
    EnfWorld *world;
    const EnfAllocator *allocator;
    uint8_t *collides;          /* a material */
    uint32_t *cells, *clusters; /* what a gathering finds: room for all of the map's */
    uint32_t *stamps, stamp;    /* a cluster: the gathering that took it last */
    uint32_t *outside;          /* cells that the tree over cells lacks */
    uint32_t outside_count;
    EnfBox3 bounds;             /* of all cells */
    EnfNearTriangle *triangles; /* of the level first, then of the solids */
    uint32_t level_count, count, capacity;
    EnfBox3 region; /* that they were gathered for; empty: none */
    int64_t tick;   /* at which the solids' triangles were taken */
    uint32_t changes;
    uint64_t pushes;
    bool failed;     /* no memory for all of them */
    uint8_t ignored; /* of any solid */
    EnfSolid *solids;
    uint32_t solid_count, solid_capacity;
    EnfKdBuilt tree; /* over the bounds of those that have some */
    bool tree_stale;
    uint32_t *near; /* solids whose bounds touch the region, and all that roam; ascending */
    uint32_t near_count;
    EnfColliderCounters counters;
};

/** Gathers what may touch `box`; nothing to do where it lies within what is there. False without memory. */
bool enf_collide_gather(EnfCollider *collider, EnfBox3 box);
/** The box of a capsule at a place, widened by `margin`. */
EnfBox3 enf_capsule_box(const EnfCapsule *capsule, EnfVec3 at, double margin);
/** Appends triangles of solids near the region; called by the gathering. */
bool enf_collide_gather_solids(EnfCollider *collider);
/** The tree over the solids that have bounds; false without memory. */
bool enf_collide_sort_solids(EnfCollider *collider);
/** Room for `more` triangles. */
bool enf_collide_reserve(EnfCollider *collider, uint32_t more);
void enf_collide_put(EnfCollider *collider, const EnfVec3 corner[3], uint32_t cluster, uint32_t triangle, uint32_t solid);
/** The solids of the map, at creation. */
EnfResult enf_collide_add_movers(EnfCollider *collider, EnfError *error);
/** enf_collider_add, for an object that may yet have to be added to the world. */
EnfResult enf_collide_add_solid(EnfCollider *collider, const EnfSolidDef *def, uint32_t *number, EnfError *error);
bool enf_material_collides(const EnfMaterial *material);
/** As enf_collide_sweep, against one solid alone. */
bool enf_collide_sweep_solid(EnfCollider *collider, const EnfCapsule *capsule, EnfVec3 from_ws, EnfVec3 delta, uint32_t solid,
                             EnfSweepHit *hit);
/** Solids that the capsule overlaps are ignored from now on, until enf_collide_heed; returns how many. */
uint32_t enf_collide_ignore_overlapped(EnfCollider *collider, const EnfCapsule *capsule, EnfVec3 at_ws);
void enf_collide_ignore(EnfCollider *collider, uint32_t solid, uint8_t why);
/** Solids count again that were ignored for one of these reasons. */
void enf_collide_heed(EnfCollider *collider, uint8_t why);
/** Where a point that is fixed to a solid, and now (a tick ago) at `p`, is after this tick's motion. */
EnfVec3 enf_solid_ride(const EnfSolid *solid, EnfVec3 p);
/** The solid of an object; ENF_NONE if there is none. */
uint32_t enf_collide_solid_of(const EnfCollider *collider, uint32_t object);

#endif
