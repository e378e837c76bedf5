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

/** What a motion does at the ends of its path. */
typedef enum EnfWrap { ENF_WRAP_ONCE, ENF_WRAP_LOOP, ENF_WRAP_PING_PONG } EnfWrap;

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
    int64_t push_tick; /**< when `pose` was true */
    double max_speed;  /**< metres a second, of any point of the object, turning included */
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
    union {
        EnfPose still;
        EnfPathMotion path;
        EnfSwingMotion swing; /**< HINGE and SLIDE */
        EnfFreeMotion free;
        EnfCallbackMotion callback;
    } as;
} EnfMotion;

/** The pose at a tick: a pure function of motion and tick, whatever was asked before, so an object that slept a million ticks
 *  wakes where it would be (DESIGN §5). FREE answers the pose pushed last. @cost O(log keys). */
EnfPose enf_motion_state(const EnfMotion *motion, int64_t tick);

/** A box (world) that contains every point of the object's `local` box at every tick of [tick0, tick1] (tick0 <= tick1), rounded
 *  outward. FREE counts from its push. @guarantee tests/property/test_motion: dense sampling and interval evaluation.
 *  @cost O(keys in the range), O(keys) beyond one pass. Source: extremes of cubic Hermite segments; DESIGN §5. */
EnfBox3 enf_motion_bound(const EnfMotion *motion, const EnfBox3 *local, int64_t tick0, int64_t tick1);

/** Sends a hinge or slide towards `target` (clamped to its range) from where it is at `tick`. */
void enf_swing_set(EnfMotion *motion, int64_t tick, double target);
/** Where a hinge or slide is at `tick`: radians or metres. */
double enf_swing_position(const EnfMotion *motion, int64_t tick);
/** A free object is at `pose` at `tick`. */
void enf_free_push(EnfMotion *motion, int64_t tick, EnfPose pose);

/** A smooth path through points (Catmull–Rom) as a cubic track: writes 9 floats a key into `values` (in-tangent, point,
 *  out-tangent). `times` ascend strictly. Source: Catmull & Rom 1974, in the Hermite form of glTF. */
void enf_catmull_rom(const float *times, const float *points, uint32_t count, float *values);

#ifdef __cplusplus
}
#endif
#endif
