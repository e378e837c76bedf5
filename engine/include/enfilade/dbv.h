/* Dynamic bounding volumes: what moves unseen costs nothing.
 *
 * A volume is a box that holds everything its object may occupy from now until its expiry tick. It hangs on a node of the map's
 * tree over cells, on a cell, or on a node of a cell's own kd-tree. The object is left alone (not moved, animated, simulated
 * or asked for) until a visible window shows its volume (*exposure*) or the volume *expires*. DESIGN §5. Sources: Sudarsky &
 * Gotsman 1996 (temporal bounding volumes; update from the least common ancestor); Paunoo 2006 (with portals and kd-trees). */
#ifndef ENFILADE_DBV_H
#define ENFILADE_DBV_H

#include <enfilade/world.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How long a new volume is valid. */
typedef enum EnfDbvPolicy {
    ENF_DBV_CONSTANT, /**< always `period_ticks` */
    ENF_DBV_ADAPTIVE, /**< twice as long after an expiry unseen, half after an exposure that drew nothing */
    ENF_DBV_MAXIMAL,  /**< as long as the volume keeps most of its distance to the cells seen in the last frame */
    ENF_DBV_OPTIMAL,  /**< for a still eye: doubled until seen, then bisected between the last good and the last bad */
    ENF_DBV_REACH /**< as MAXIMAL, or longer: as long as a confined object (EnfFreeMotion.confined) cannot have come to a portal
                           into a seen cell. Its volume hangs only in cells that it can walk to. Closed portals count as open, so
                           that opening a door is no event; portals must not be moved (enf_portals_move) */
} EnfDbvPolicy;

/** How a volume is hung again after a change: from the least common ancestor of its old and new places, or from the root. */
typedef enum EnfDbvUpdate { ENF_DBV_LCA, ENF_DBV_NAIVE } EnfDbvUpdate;

typedef struct EnfDbvDef {
    EnfDbvPolicy policy;
    EnfDbvUpdate update;
    uint32_t period_ticks;     /**< of CONSTANT, and the first of ADAPTIVE and OPTIMAL */
    uint32_t max_period_ticks; /**< no volume is valid longer; >= 1 */
} EnfDbvDef;
/** Maximal periods, least common ancestor, 64 ticks first, 2^30 at most. */
EnfDbvDef enf_dbv_def_default(void);

typedef struct EnfDbvCounters {
    uint64_t exposed;    /**< volumes seen, their objects evaluated */
    uint64_t appeared;   /**< of these, what was not exposed in the last four frames */
    uint64_t drawn;      /**< of these, with the object itself in a window */
    uint64_t expired;    /**< volumes that ended unseen */
    uint64_t late;       /**< volumes exposed after their expiry tick: must stay 0 */
    uint64_t reinserted; /**< volumes made and hung, or cut where they hang */
    uint64_t avoided;    /**< living objects that the frame did not touch */
    uint64_t nodes;      /**< tree nodes passed while hanging volumes */
    uint64_t tested;     /**< volumes tested against a window */
} EnfDbvCounters;

typedef struct EnfDbvIndex EnfDbvIndex;

/** An index over the objects of `world`; they are taken in by the first enf_dbv_begin. */
EnfResult enf_dbv_create(EnfDbvIndex **index, EnfWorld *world, const EnfDbvDef *def, const EnfAllocator *allocator,
                         EnfError *error);
void enf_dbv_destroy(EnfDbvIndex *index);

/** Begins the frame of the world's tick: takes in what changed and renews what expired, in the order of (tick, index). Call it for
 *  every tick at which the world changed, and before every frame. ERROR_MEMORY leaves objects out of the index: then the frame
 *  must draw without it. */
EnfResult enf_dbv_begin(EnfDbvIndex *index, EnfError *error);

/** A cell is seen through a window: `pyramid` is relative to the cell's origin. Exposes the volumes it shows. A cell may be seen
 *  through several windows in one frame. */
void enf_dbv_see(EnfDbvIndex *index, uint32_t cell, const EnfPyramid *pyramid);

/** Ends the frame: exposed objects get new volumes. The objects drawn, ascending: those whose own box touches a seen cell and
 *  passes its pyramid. Valid until the next begin.
 *  @guarantee equal to testing every object of the world, at every tick, under every policy: tests/property/test_dbv. */
const uint32_t *enf_dbv_end(EnfDbvIndex *index, uint32_t *count);

/** Did memory run out in this frame, so that something may be missing? */
bool enf_dbv_failed(const EnfDbvIndex *index);

/** Counters of the last frame, and of all frames since the index was made. */
EnfDbvCounters enf_dbv_frame_counters(const EnfDbvIndex *index);
EnfDbvCounters enf_dbv_total_counters(const EnfDbvIndex *index);

/** The volume of an object (of several boxes, the first) and its expiry tick, for debug views; false if it hangs in no cell. */
bool enf_dbv_volume(const EnfDbvIndex *index, uint32_t object, EnfBox3f *volume, int64_t *expiry_tick);

/** What the last frame did with an object: for debug views. EXPIRED: its volume ended unseen, and a new one was made. EXPOSED: a window
 *  showed the volume, but not the object. */
typedef enum EnfDbvState {
    ENF_DBV_STATE_NONE, /**< not alive, or not taken in yet */
    ENF_DBV_STATE_ASLEEP,
    ENF_DBV_STATE_EXPIRED,
    ENF_DBV_STATE_EXPOSED,
    ENF_DBV_STATE_DRAWN
} EnfDbvState;
/** @cost the objects that expired in the frame. */
EnfDbvState enf_dbv_state(const EnfDbvIndex *index, uint32_t object);

/** Memory of the index, bytes; without the world's. */
size_t enf_dbv_bytes(const EnfDbvIndex *index);

#ifdef __cplusplus
}
#endif
#endif
