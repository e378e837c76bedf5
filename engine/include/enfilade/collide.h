/* Collision and walking: an upright capsule swept against the level and against what moves in it, and a body that walks with it.
 *
 * All of it is double arithmetic of +, −, ×, ÷ and √ in a fixed order: the same moves give the same bits everywhere. Positions of
 * capsules are world metres, of the LOWEST point (the feet). Surfaces are two-sided and need no thickness.
 *
 * What collides: clusters whose material is drawn and not blended (opaque or masked), or is NODRAW and CLIP; not what is marked
 * NOCOLLIDE. Portals never do, open or closed: a shut door stops a walker because its leaf does. Movers of the map with the SOLID
 * flag collide as the triangles of their mesh at their pose, or as the oriented box of it where the mesh has more than
 * ENF_SOLID_TRIANGLES_MAX, or is FREE (guards). A capsule keeps ENF_TOL_SKIN from surfaces.
 *
 * Threads: one collider a thread. Memory: create, add and set_bounds use the heap (and the move after an add); other moves do not (a larger
 * crowd of triangles than ever before grows a buffer; if that fails, the sweep is refused, as if it had hit at once). */
#ifndef ENFILADE_COLLIDE_H
#define ENFILADE_COLLIDE_H

#include <enfilade/world.h>

#ifdef __cplusplus
extern "C" {
#endif

/** An upright capsule: half-spheres of `radius` above the lowest and below the highest point. height >= 2 radius > 0, metres. */
typedef struct EnfCapsule {
    double radius, height;
} EnfCapsule;

typedef struct EnfCollider EnfCollider;

/** Over the level alone (`world` NULL), or with the solid movers of `world`, a world over the same map in which the movers of
 *  the map were added first and in order (enf_world_populate). Borrows both. ERROR_MEMORY. */
EnfResult enf_collider_create(EnfCollider **collider, const EnfMap *map, EnfWorld *world, const EnfAllocator *allocator,
                              EnfError *error);
void enf_collider_destroy(EnfCollider *collider);
/** Forgets where solids were a tick ago: after a restart, a loaded state, or any other jump of the world's time. No heap. */
void enf_collider_reset(EnfCollider *collider);

/* ---- solids ----------------------------------------------------------------------------------------------------- */

#define ENF_SOLID_TRIANGLES_MAX 512

/** An object of the world that collides, beyond those the map says. */
typedef struct EnfSolidDef {
    uint32_t object;           /**< index in the world */
    const EnfVec3f *triangles; /**< 3 × triangle_count corners in the object's own space; copied */
    uint32_t triangle_count;   /**< 1 .. ENF_SOLID_TRIANGLES_MAX */
    EnfBox3 bounds_ws; /**< holds it at every tick for ever; empty (min > max): it roams, and is asked for at every move */
} EnfSolidDef;

/** Adds a solid; its number through `solid`. Solids of the map come first, in the order of their movers. ERROR_MEMORY,
 *  ERROR_ARGUMENT. */
EnfResult enf_collider_add(EnfCollider *collider, const EnfSolidDef *def, uint32_t *solid, EnfError *error);
/** Eight corners of `box` as the 12 triangles (36 corners) of an EnfSolidDef. */
void enf_solid_box(EnfBox3 box, EnfVec3f corners[36]);
/** Switches an object's collision (of all solids with that object): a thing picked up, a ghost. */
void enf_collider_set_solid(EnfCollider *collider, uint32_t object, bool solid);
/** Another box for all time, after enf_world_set_motion (empty: it roams from now on). The next move sorts them anew, with the
 *  heap. */
void enf_collider_set_bounds(EnfCollider *collider, uint32_t object, EnfBox3 bounds_ws);
/** Is the object a solid that is switched on? */
bool enf_collider_is_solid(const EnfCollider *collider, uint32_t object);

/* ---- queries ---------------------------------------------------------------------------------------------------- */

/** What a sweep met. */
typedef struct EnfSweepHit {
    double t;         /**< the part of the way that is free, 0..1 */
    EnfVec3 normal;   /**< unit, out of what was met, towards the capsule's axis */
    EnfVec3 face;     /**< unit normal of the triangle, on the capsule's side of it; of several met in one place (the edge of
                           a step) the one that faces up most */
    EnfVec3 point;    /**< world: the nearest point of what was met */
    uint32_t cluster; /**< of the map, or ENF_NONE */
    uint32_t triangle;
    uint32_t object; /**< of the world, or ENF_NONE */
} EnfSweepHit;

/** Moves a capsule from `from_ws` along `delta` until it comes within the skin of something. True if something is in the way:
 *  `hit` (may not be NULL) tells what; else hit->t is 1. Triangles that it is moving away from, or overlaps and moves out of, do
 *  not stop it. Anything not finite is refused: true, t = 0.
 *  @guarantee between from_ws and from_ws + t·delta the capsule comes no nearer to any surface than ENF_TOL_SKIN / 2, and no
 *  nearer than it began where it began nearer (2^-24 m of rounding); t falls short of the true way by at most what
 *  keeps the skin. tests/property/test_collide, against every triangle. @cost µs; a tenth of one a triangle nearby. */
bool enf_collide_sweep(EnfCollider *collider, const EnfCapsule *capsule, EnfVec3 from_ws, EnfVec3 delta, EnfSweepHit *hit);

/** The deepest overlap of a capsule with the level and the solids. */
typedef struct EnfOverlap {
    double depth;      /**< metres that the nearest surface is inside the radius; > 0 where it overlaps */
    EnfVec3 direction; /**< unit: the way out of that surface */
    uint32_t cluster, triangle, object;
} EnfOverlap;

/** Does the capsule overlap a surface (by more than rounding, 2^-20 m)? `out` may be NULL. */
bool enf_collide_overlap(EnfCollider *collider, const EnfCapsule *capsule, EnfVec3 at_ws, EnfOverlap *out);

/** A free place for the capsule near `at_ws` by pushing it out of what it overlaps, else by trying places around it, out to
 *  `reach` metres. False, and *out = at_ws, if there is none. Bounded work. */
bool enf_collide_way_out(EnfCollider *collider, const EnfCapsule *capsule, EnfVec3 at_ws, double reach, EnfVec3 *out);

typedef struct EnfColliderCounters {
    uint64_t sweeps, gathers, triangles, tested, steps; /**< triangles gathered; tested beyond their box; steps of the search */
} EnfColliderCounters;
EnfColliderCounters enf_collider_counters(const EnfCollider *collider);

/* ---- walking ---------------------------------------------------------------------------------------------------- */

typedef enum EnfCharacterMode { ENF_CHARACTER_WALK, ENF_CHARACTER_FLY, ENF_CHARACTER_NOCLIP } EnfCharacterMode;

/** How a body moves; start with enf_character_def_default(). Metres, seconds. */
typedef struct EnfCharacterDef {
    double radius, height, crouch_height;
    double eye_below_top; /**< of the capsule */
    double walk_speed, run_speed, crouch_speed, fly_speed;
    double acceleration;     /**< m/s² towards the wished speed, on the ground and flying */
    double friction;         /**< m/s² at which it stops, where nothing is wished */
    double air_acceleration; /**< m/s² */
    double gravity;          /**< m/s² */
    double jump_height;      /**< metres that the feet rise */
    double fall_speed;       /**< m/s at most */
    double step;             /**< metres: the highest step walked up and down */
    double slope_cos;        /**< the least y of the normal of ground that can be stood on */
    double crouch_rate;      /**< m/s at which the capsule shrinks and grows */
} EnfCharacterDef;
EnfCharacterDef enf_character_def_default(void); /**< 0.3 × 1.75 m; steps of 0.4 m, slopes of 45° */

/** Flags of a character. */
enum { ENF_CHARACTER_GROUNDED = 1, ENF_CHARACTER_CROUCHED = 2, ENF_CHARACTER_JUMP_HELD = 4, ENF_CHARACTER_HAS_GOOD = 8 };

/** The whole state of a body: plain data without padding, so that it can be copied, hashed and put back. */
typedef struct EnfCharacter {
    EnfCharacterDef def;
    EnfVec3 position;      /**< world: the feet */
    EnfVec3 velocity;      /**< m/s; while grounded, its own, not that of what it stands on */
    EnfVec3 ground_normal; /**< unit, where grounded */
    EnfVec3 good;          /**< the last place that was free, with the eye in a cell */
    double height;         /**< of the capsule now: it crouches and stands up at a finite speed */
    double lag;            /**< metres that the eye is still below where it belongs: a step taken a moment ago, smoothed */
    uint32_t object; /**< of the world, that is this very body and so never in its way; set it after the spawn, or ENF_NONE */
    uint32_t cell;   /**< of the eye, or ENF_NONE */
    uint32_t ground_object;  /**< in the world, or ENF_NONE */
    uint32_t ground_cluster; /**< of the map, or ENF_NONE: its material is what footsteps sound of */
    uint32_t mode;           /**< EnfCharacterMode */
    uint32_t flags;
    uint32_t still_ticks; /**< ticks in the air without getting anywhere: after some, it may walk as on the ground */
    uint32_t lost_ticks;  /**< since the eye was in a cell last */
} EnfCharacter;

/** What a body is told for one tick. */
typedef struct EnfCharacterInput {
    EnfVec3
        wish; /**< direction in the world times the share of full speed, at most 1 long; y counts for FLY and NOCLIP alone */
    bool jump, crouch, run;
    EnfCharacterMode mode;
} EnfCharacterInput;

enum {
    ENF_MOVED_JUMPED = 1,
    ENF_MOVED_LANDED = 2,
    ENF_MOVED_STEPPED = 4,
    ENF_MOVED_BLOCKED = 8,    /**< something upright was in the way */
    ENF_MOVED_PUSHED = 16,    /**< by a door, or carried against its will */
    ENF_MOVED_SQUEEZED = 32,  /**< between a solid and a wall: the solid should turn back */
    ENF_MOVED_RELOCATED = 64, /**< out of something solid, not along `path` */
    ENF_MOVED_CARRIED = 128,
    ENF_MOVED_RETURNED = 256, /**< and RELOCATED: fell out of the level through a leak, and is back where it was in a cell */
};

#define ENF_CHARACTER_PATH_MAX 48

/** What happened in one tick. */
typedef struct EnfCharacterReport {
    uint32_t moved;       /**< ENF_MOVED_* */
    uint32_t squeezed_by; /**< object, or ENF_NONE */
    double fall_speed;    /**< m/s, where LANDED */
    uint32_t path_count;
    EnfVec3 path[ENF_CHARACTER_PATH_MAX]; /**< places of the feet in order; between two of them every move was a straight sweep.
                                               After RELOCATED it begins where the body was put */
} EnfCharacterReport;

/** Puts a body at `feet_ws`, standing, at rest, or at the nearest free place (see enf_collide_way_out, 2 m); locates its eye.
 *  False if there is no free place (it is put there all the same). */
bool enf_character_spawn(EnfCharacter *character, EnfCollider *collider, const EnfCharacterDef *def, EnfVec3 feet_ws);

/** One tick (1 / ENF_TICK_RATE s), after enf_world_advance(world, 1). Carried and pushed by solids first, then moves by itself:
 *  walks up and down steps, slides along walls and creases, falls, jumps, crouches (and stays so under what is low).
 *  `report` may be NULL.
 *  @guarantee it is never inside the level and never passes a surface, at any speed; at rest not a bit of it
 *  changes. tests/property/test_collide, tests/unit/test_character */
void enf_character_move(EnfCharacter *character, EnfCollider *collider, const EnfCharacterInput *input,
                        EnfCharacterReport *report);

/** The eye, world. It never leaves the capsule. */
EnfVec3 enf_character_eye(const EnfCharacter *character);
EnfCapsule enf_character_capsule(const EnfCharacter *character);

#ifdef __cplusplus
}
#endif
#endif
