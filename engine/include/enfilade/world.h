/* The state of the running world that visibility depends on: portals that open, close and move; and how objects move.
 *
 * A map is immutable; what changes at run time lives here. Time is integer ticks (ENF_TICK_RATE a second); no float ever holds an
 * absolute time (DESIGN §2). */
#ifndef ENFILADE_WORLD_H
#define ENFILADE_WORLD_H

#include <enfilade/map.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A half-portal as the traversal uses it: 64 bytes, one cache line; the plane is derived from the points (PITFALLS 15). */
typedef struct EnfPortalState {
    EnfVec3 normal;        /**< unit, out of the source cell; zero for overlap links */
    double d;              /**< normal·p + d = 0, relative to the source cell's origin */
    float slab;            /**< metres: no vertex strays farther from the plane; sides are three-valued */
    uint32_t vertex_first; /**< in EnfPortals.vertices */
    uint16_t vertex_count;
    uint16_t flags; /**< ENF_PORTAL_* ; CLOSED is the current state */
    uint32_t source, target, twin, transform;
} EnfPortalState;

typedef struct EnfPortals {
    const EnfMap *map;
    EnfPortalState *states; /**< one a half-portal of the map, same indices */
    EnfVec3f *vertices;     /**< a copy of map->portal_vertices that may be moved */
    uint32_t count, vertex_count;
    const EnfAllocator *allocator;
} EnfPortals;

EnfResult enf_portals_create(EnfPortals *portals, const EnfMap *map, const EnfAllocator *allocator, EnfError *error);
void enf_portals_destroy(EnfPortals *portals);

/** Opens or closes a half-portal and its twin. Closing stops traversal only; geometry is still drawn (PITFALLS 10). */
void enf_portals_set_open(EnfPortals *portals, uint32_t portal, bool open);
bool enf_portals_is_open(const EnfPortals *portals, uint32_t portal);

/** Moves a half-portal and its twin: `points_ws`, as many as the portal has vertices, front out of `portal`'s source. Rounded to
 *  the cells' storage; planes derived anew. The caller keeps the opening and the geometry in step. */
void enf_portals_move(EnfPortals *portals, uint32_t portal, const EnfVec3 *points_ws);

/* ---- motions ---------------------------------------------------------------------------------------------------- */

/** Ticks a second. */
#define ENF_TICK_RATE 60

/** Where an object is: p_ws = position + rotation · (scale ∘ p). The quaternion is unit up to rounding. */
typedef struct EnfPose {
    EnfVec3 position;
    EnfQuat rotation;
    EnfVec3 scale;
} EnfPose;

EnfPose enf_pose_identity(void);
EnfVec3 enf_pose_point(const EnfPose *pose, EnfVec3 p);

/** A keyed curve of 3 (translation, scale) or 4 (rotation) components, as glTF has it; borrowed arrays. Times ascend strictly
 *  from `times[0]`, seconds from the path's beginning; before the first and after the last key its value holds. */
typedef struct EnfTrack {
    EnfPathKind kind;
    uint32_t key_count;  /**< 0: the track is absent, the pose's rest value holds */
    const float *times;  /**< key_count */
    const float *values; /**< key_count × components (× 3 for cubic: in-tangent, value, out-tangent) */
} EnfTrack;

/** A path: the tracks of a glTF animation over a rest pose, relative to `parent`. */
typedef struct EnfPathMotion {
    EnfPose rest;
    EnfTrack translation, rotation, scale;
    EnfWrap wrap;
    int64_t start_tick;    /**< the path's time 0 */
    uint32_t period_ticks; /**< of one pass, >= 1: `seconds` is stretched to a whole number of ticks */
    double seconds;        /**< of one pass */
} EnfPathMotion;

/** A door: a turn about an axis through `pivot`, or a shift along it, from rest at a constant rate towards a target, which
 *  events set (enf_swing_set). Bounded for all time by [low, high]. */
typedef struct EnfSwingMotion {
    EnfPose rest;
    EnfVec3 pivot, axis; /**< world; axis unit */
    double low, high;    /**< radians (hinge) or metres (slide) */
    double rate;         /**< a second, > 0 */
    double from, target; /**< position at event_tick, and where it goes */
    int64_t event_tick;
} EnfSwingMotion;

/** Anything of which only a largest speed is known; the caller pushes poses (enf_free_push). */
typedef struct EnfFreeMotion {
    EnfPose pose;
    EnfPose last;                                   /**< where it was before the tick of the last push (enf_free_push) */
    int64_t push_tick;                              /**< when `pose` was true */
    double max_speed;                               /**< metres a second, of any point of the object, turning included */
    EnfPose (*ask)(const void *user, int64_t tick); /**< where it is now (a simulation, a server), or NULL: it is pushed. With
                                                         trails (enf_world_set_trail) also where it was one tick ago */
    const void *user;
    /** It passes no wall and keeps its size: its box comes to touch a cell (enf_world_touches) only by touching a portal that
     *  leads there from a cell touched before. A promise of the caller (with trails: of the box
     *  that holds both ticks); with it volumes need not leak through walls. */
    bool confined;
} EnfFreeMotion;

/** A motion of the caller's. Both functions are pure in (user, ticks). */
typedef struct EnfCallbackMotion {
    EnfPose (*state)(const void *user, int64_t tick);
    EnfBox3 (*bound)(const void *user, const EnfBox3 *local, int64_t tick0, int64_t tick1);
    const void *user;
} EnfCallbackMotion;

typedef enum EnfMotionKind {
    ENF_MOTION_STILL,
    ENF_MOTION_PATH,
    ENF_MOTION_HINGE,
    ENF_MOTION_SLIDE,
    ENF_MOTION_FREE,
    ENF_MOTION_CALLBACK
} EnfMotionKind;

typedef struct EnfMotion {
    EnfMotionKind kind;
    uint32_t set_tick; /**< the world's: low half of the tick in which it was set */
    union {
        EnfPose still;
        EnfPathMotion path;
        EnfSwingMotion swing; /**< HINGE and SLIDE */
        EnfFreeMotion free;
        EnfCallbackMotion callback;
    } as;
} EnfMotion;

/** The pose at a tick: a pure function of motion and tick, whatever was asked before, so an object that slept a million ticks
 *  wakes where it would be (DESIGN §5). FREE asks, or answers the pose pushed last. @cost O(log keys). */
EnfPose enf_motion_state(const EnfMotion *motion, int64_t tick);

/** A box (world) that contains every point of the object's `local` box at every tick of [tick0, tick1] (tick0 <= tick1), rounded
 *  outward. FREE counts from its push. @guarantee tests/property/test_motion: dense sampling; test_motion_proof: interval arithmetic
 *  over every moment of the range, for every kind of motion, and how loose it is. @cost O(keys in the range), O(keys) beyond one pass. Source: extremes of cubic Hermite segments; DESIGN §5. */
EnfBox3 enf_motion_bound(const EnfMotion *motion, const EnfBox3 *local, int64_t tick0, int64_t tick1);

/** Sends a hinge or slide towards `target` (clamped to its range) from where it is at `tick`. */
void enf_swing_set(EnfMotion *motion, int64_t tick, double target);
/** Where a hinge or slide is at `tick`: radians or metres. */
double enf_swing_position(const EnfMotion *motion, int64_t tick);
/** A free object is at `pose` at `tick`; where it was before is kept as `last`. */
void enf_free_push(EnfMotion *motion, int64_t tick, EnfPose pose);

/** A smooth path through points (Catmull–Rom) as a cubic track: writes 9 floats a key into `values` (in-tangent, point,
 *  out-tangent). `times` ascend strictly. Source: Catmull & Rom 1974, in the Hermite form of glTF. */
void enf_catmull_rom(const float *times, const float *points, uint32_t count, float *values);

/* ---- objects ---------------------------------------------------------------------------------------------------- */

/** Names an object for as long as it lives; a removed object's id is never valid again. Generation 0 is null. */
typedef struct EnfObjectId {
    uint32_t index, generation;
} EnfObjectId;

/** What an object is made from; start with enf_object_def_default(). */
typedef struct EnfObjectDef {
    EnfMotion motion; /**< its arrays are borrowed for the object's life */
    EnfBox3 local;    /**< holds the object in its own space, metres */
    double max_speed; /**< metres a second, of any point; HUGE_VAL where unknown (paths and doors are bounded anyway) */
    uint32_t mesh;    /**< the caller's */
    uint64_t user;    /**< the caller's */
} EnfObjectDef;
EnfObjectDef enf_object_def_default(void);

typedef struct EnfWorld EnfWorld;

/** An empty world at tick 0 in `map`, with room for `capacity` objects before it grows. */
EnfResult enf_world_create(EnfWorld **world, const EnfMap *map, uint32_t capacity, const EnfAllocator *allocator,
                           EnfError *error);
void enf_world_destroy(EnfWorld *world);
const EnfMap *enf_world_map(const EnfWorld *world);

int64_t enf_world_tick(const EnfWorld *world);
/** Time passes; nothing moves until it is asked for. Forgets the changes of the ticks before. ticks >= 0. */
void enf_world_advance(EnfWorld *world, int64_t ticks);

/** What an object is made from a mover of the map: its motion from tick 0 on (arrays borrowed from the map), local box, mesh, and
 *  `user` = mover. A FREE mover stands at its entity's pose until somebody steers it. */
EnfObjectDef enf_mover_def(const EnfMap *map, uint32_t mover);
/** Adds every mover of the map, in order; in a fresh world object i is mover i. ERROR_MEMORY leaves those added so far. */
EnfResult enf_world_populate(EnfWorld *world, EnfError *error);

/** Null (generation 0) with `error` when memory is out. */
EnfObjectId enf_world_add(EnfWorld *world, const EnfObjectDef *def, EnfError *error);
/** False if `id` is not alive. */
bool enf_world_remove(EnfWorld *world, EnfObjectId id);
bool enf_world_alive(const EnfWorld *world, EnfObjectId id);
/** Teleports or re-parameterises: the object moves by `motion` from this tick on. */
bool enf_world_set_motion(EnfWorld *world, EnfObjectId id, const EnfMotion *motion);
/** A FREE object (that is not asked) has walked to `pose`, where it is in this tick: as it walks within its largest speed, nobody need
 *  be told, and volumes made before hold it; if it was faster, that is a change. With trails it is blended from where it was, where
 *  enf_world_set_motion would set it down. False if it is not alive, or not FREE. */
bool enf_world_push(EnfWorld *world, EnfObjectId id, const EnfPose *pose);
/** Pushes since the world was made: with its tick and its changes, all that poses depend on. */
uint64_t enf_world_pushes(const EnfWorld *world);
/** Sends a door towards `target` from this tick on. */
bool enf_world_swing(EnfWorld *world, EnfObjectId id, double target);

/** One past the largest index ever used; indices of dead objects are re-used. */
uint32_t enf_world_object_limit(const EnfWorld *world);
/** The id at an index; null if none lives there. */
EnfObjectId enf_world_object(const EnfWorld *world, uint32_t index);
uint32_t enf_world_mesh(const EnfWorld *world, uint32_t index);

/** With trails, enf_world_seen_box and enf_world_bound hold an object also where it was one tick ago, so that a picture between two
 *  ticks, its matrices blended, loses nothing: a blended point lies on the chord between its two places. Objects that were added,
 *  teleported, re-parameterised or sent (a door) in this tick were nowhere else: they do not smear. Off at first. Call it before an
 *  index is made over the world (enf_dbv_create). A door that comes to rest in this tick still gapes in the pictures before it: its
 *  portal is closed one tick later (PITFALLS 10). Poses and enf_world_box know no trails: a simulation is the same with and
 *  without. */
void enf_world_set_trail(EnfWorld *world, bool on);
bool enf_world_has_trail(const EnfWorld *world);

/** How a living object moves; valid until the world is changed. */
const EnfMotion *enf_world_motion(const EnfWorld *world, uint32_t index);

/** Pose and world box (float, rounded outward) of a living object at the world's tick; each counts as one evaluation. */
EnfPose enf_world_pose(EnfWorld *world, uint32_t index);
EnfBox3f enf_world_box(EnfWorld *world, uint32_t index);
/** What pictures of this tick may show of it: its box, and with trails also where it was one tick ago. */
EnfBox3f enf_world_seen_box(EnfWorld *world, uint32_t index);
/** Where a living object was one tick ago. False, and its pose now, without trails or where it was set in this tick. */
bool enf_world_last_pose(EnfWorld *world, uint32_t index, EnfPose *pose);
/** A box that holds the object at every tick from now to `until` (asks a FREE one where it is, first). */
EnfBox3f enf_world_bound(EnfWorld *world, uint32_t index, int64_t until);
double enf_world_max_speed(const EnfWorld *world, uint32_t index);
/** Is its motion FREE: nothing known but a largest speed? */
bool enf_world_is_free(const EnfWorld *world, uint32_t index);
/** Is it FREE, and confined by walls? */
bool enf_world_is_confined(const EnfWorld *world, uint32_t index);
/** Asks the processor for what the three above will read of an object: a hint for those who know what they will ask next. */
void enf_world_prefetch(const EnfWorld *world, uint32_t index);
/** The same, a little later, for what its motion names: the beginning of a path's keys, or of what a callback or `ask` is given. */
void enf_world_prefetch_named(const EnfWorld *world, uint32_t index);
/** Motions evaluated since the world was made. */
uint64_t enf_world_evaluations(const EnfWorld *world);

/** Indices of objects added, removed or changed since the last enf_world_advance, in order, repeats included. Indices over the
 *  map's cells see it once a tick (engine/dbv). */
const uint32_t *enf_world_changes(const EnfWorld *world, uint32_t *count);

/** Does an object with this box touch a cell: do box and cell bounds overlap by more than a grid step? (PITFALLS 9: an object is
 *  in every cell that it touches.) */
bool enf_world_touches(const EnfMap *map, uint32_t cell, EnfBox3f box);

/** `box` relative to the origin of `cell`, rounded outward: for pyramids of that cell. */
EnfBox3f enf_world_box_in_cell(const EnfMap *map, uint32_t cell, EnfBox3f box);

#ifdef __cplusplus
}
#endif
#endif
