/* The parts of an EnfDbvIndex and the steps between its files:
 *
 *   blocks.c  the boxes of volumes at their places, eight a block
 *   places.c  where volumes hang: nodes of the tree over cells, cells, nodes of a cell's kd-tree; LCA
 *   fit.c     boxes about what hangs on a place and beneath
 *   seen.c    which cells are seen, and how far a box is from them
 *   wheel.c   the expiry queue
 *   period.c  how long a volume is valid (the policies)
 *   reach.c   where an object may get that passes no wall
 *   frame.c   begin, end
 *   look.c    see
 *   index.c   memory */
#ifndef ENFILADE_DBV_INTERNAL_H
#define ENFILADE_DBV_INTERNAL_H

#include "simd/simd.h"

#include <enfilade/dbv.h>

/** Places that one volume hangs on at most. Most hang on one; on several only what stays within the cells that it can walk to. */
#define ENF_DBV_LINKS 5U

/** A volume: no more than a cache line. Its box stands where it hangs. */
typedef struct EnfDbvVolume {
    int64_t expiry_tick;
    uint32_t wheel_at;      /**< where it stands in the queue: chunk * ENF_DBV_QUEUED + item; ENF_NONE: it is not in it */
    uint32_t period;        /**< ticks that it was made for */
    uint32_t bad_period;    /**< OPTIMAL: the shortest that was seen; 0: none yet */
    uint32_t exposed_frame; /**< the frame that exposed it last */
    uint32_t exposure;      /**< and its exposure there */
    uint8_t link_count;
    bool alive;
    uint32_t links[ENF_DBV_LINKS]; /**< where its boxes are: block * ENF_KD_BLOCK + lane */
} EnfDbvVolume;

/* ---- blocks ----------------------------------------------------------------------------------------------------- */

/** Eight boxes (world) of a place; an item is object * ENF_DBV_LINKS + link. Lanes at and beyond `count` are ENF_NONE. */
typedef struct EnfDbvBlock {
    EnfKdBlock boxes;
    uint32_t next, place, count;
} EnfDbvBlock;

enum { ENF_DBV_CHUNK = 1024 };

typedef struct EnfDbvPool {
    EnfDbvBlock **chunks; /**< ENF_DBV_CHUNK blocks each */
    uint32_t chunk_count, chunk_capacity;
    uint32_t used, free_head; /**< blocks ever taken; given back, chained by `next` */
    double bound;             /**< metres: no coordinate of a cell's box is larger */
} EnfDbvPool;

static inline EnfDbvBlock *enf_dbv_block(const EnfDbvPool *pool, uint32_t number) {
    return &pool->chunks[number / ENF_DBV_CHUNK][number % ENF_DBV_CHUNK];
}

/* ---- places ----------------------------------------------------------------------------------------------------- */

/** What hangs on a place: no box of its volumes reaches out of these (fit.c). */
typedef struct EnfDbvFit {
    EnfBox3f own, all; /**< on the place itself; there and on all places beneath. World; empty: min > max */
    bool loose;        /**< something was taken out since `own` was fitted */
    bool shown;        /**< of a loose one, while a window looks: it shows one of its own volumes */
} EnfDbvFit;

/** All places: the nodes of the map's tree over cells, the cells, the kd nodes of all cells; and again the cells, for what can walk
 *  into these cells alone and is looked at only when they are seen. */
typedef struct EnfDbvPlaces {
    const EnfMap *map;
    uint32_t cells_first, nodes_first, walks_first, count;
    uint32_t *parents;   /**< ENF_NONE at the root of the cells' tree and for the OUTSIDE cell */
    uint32_t *heads;     /**< a place: first block, or ENF_NONE */
    uint32_t *below;     /**< a kd node: entries there and beneath */
    uint32_t *owners;    /**< of a kd node (from nodes_first): the place of its cell */
    EnfBox3 *boxes;      /**< of nodes and cells, world */
    EnfBox3f *limits;    /**< of the same: see enf_dbv_touches */
    EnfDbvFit *fits;     /**< of nodes and cells */
    uint32_t *hot_frame; /**< a node or cell that is or holds a seen cell: the frame that saw it */
} EnfDbvPlaces;

/** The wheel: a slot a tick, 18 minutes a turn; a slot is a chain of chunks, of which only the first has room. */
enum { ENF_DBV_SLOTS = 65536, ENF_DBV_QUEUED = 6 };

/** Objects of one slot: 32 bytes. */
typedef struct EnfDbvChunk {
    uint32_t next;
    uint16_t slot, count;
    uint32_t items[ENF_DBV_QUEUED];
} EnfDbvChunk;

typedef struct EnfDbvWheel {
    int64_t now; /**< everything due at or before it has been taken out */
    uint32_t heads[ENF_DBV_SLOTS];
    uint64_t occupied[ENF_DBV_SLOTS / 64];
    EnfDbvChunk *chunks; /**< enough for every volume, however they are spread */
    uint32_t capacity, used, free_head;
} EnfDbvWheel;

/** An object seen in this frame. */
typedef struct EnfDbvExposure {
    uint32_t object;
    bool drawn;
    EnfBox3f box; /**< its own, at this tick */
} EnfDbvExposure;

/** Seen cells that are kept in a row, to be asked without the tree. */
enum { ENF_DBV_SEEN_LISTED = 16 };

typedef struct EnfDbvSeen {
    EnfBox3 box;
    EnfBox3f limits;
} EnfDbvSeen;

/** A growing list of numbers that keeps its memory. */
typedef struct EnfDbvList {
    uint32_t *items;
    uint32_t count, capacity;
} EnfDbvList;

struct EnfDbvIndex {
    EnfWorld *world;
    const EnfMap *map;
    const EnfAllocator *allocator;
    EnfDbvDef def;
    EnfDbvPlaces places;
    EnfDbvWheel wheel;
    EnfDbvPool pool;
    EnfDbvVolume *volumes;
    uint32_t volume_count, volume_capacity, alive_count;
    EnfDbvExposure *exposures;
    uint32_t exposure_count, exposure_capacity;
    EnfDbvList due, drawn;
    EnfDbvList blocks, loose,
        candidates;     /**< of one look: blocks to be tested, places to be fitted, objects whose volumes show */
    EnfDbvList scratch; /**< of a sort */
    EnfDbvSeen seen[ENF_DBV_SEEN_LISTED]; /**< the first of the cells seen in hot_frame */
    uint32_t seen_count;                  /**< of these cells: all */
    double approach;                      /**< the share of its way to the nearest seen cell that a volume may take */
    double room;                          /**< metres: the mean of the longest sides of cells */
    uint32_t frame;                       /**< stamps; 0 never */
    uint32_t hot_frame;                   /**< the frame whose seen cells count as seen: the last that saw any */
    bool first;             /**< the world's objects have not been taken in yet, or memory ran out while a volume was hung */
    EnfBox3f *portal_boxes; /**< where the map's portals allow REACH, and the policy asks for it; else NULL */
    bool failed;            /**< memory ran out in this frame: something may be missing */
    EnfDbvCounters counters, total;
};

/** Asks for the cache line at `address`; a hint. */
static inline void enf_dbv_prefetch(const void *address) {
#if defined(__GNUC__)
    __builtin_prefetch(address);
#else
    (void)address;
#endif
}

static inline void enf_dbv_prefetch_block(const EnfDbvBlock *block) {
    for (size_t at = 0; at < sizeof *block; at += 64) {
        enf_dbv_prefetch((const char *)block + at);
    }
}

/** Always the same for an object, and different for its neighbours (Knuth 1973, vol. 3, §6.4). */
static inline uint32_t enf_dbv_hash(uint32_t object) {
    return object * UINT32_C(2654435761);
}

/** A number below `count` for an object. By the lower bits: what is scattered here is spread by the upper ones afterwards (period.c),
 *  and would come together again if both went by the same. */
static inline uint32_t enf_dbv_scatter(uint32_t object, uint32_t count) {
    return (enf_dbv_hash(object) >> 8) % count;
}

/* blocks.c */
void enf_dbv_pool_destroy(EnfDbvPool *pool, const EnfAllocator *allocator);
size_t enf_dbv_pool_bytes(const EnfDbvPool *pool);
/** Hangs a box of an object's volume on a place. False without memory. */
bool enf_dbv_link(EnfDbvIndex *index, uint32_t object, uint32_t place, EnfBox3f box);
/** Takes a box out; the place it was on. The record that it belongs to is left to the caller. */
uint32_t enf_dbv_unlink(EnfDbvIndex *index, uint32_t slot);
/** Another box for an object's first link. */
void enf_dbv_relink(EnfDbvIndex *index, uint32_t object, EnfBox3f box);
/** Takes from a box what lies outside of `by`. It stays where it hangs: no box of a place has to grow. */
void enf_dbv_cut(EnfDbvIndex *index, uint32_t slot, EnfBox3f by);
EnfBox3f enf_dbv_lane(const EnfKdBlock *boxes, uint32_t lane);
/** A pyramid relative to a cell's origin, as planes that test the world boxes of blocks: never tighter. */
void enf_dbv_planes(const EnfDbvIndex *index, uint32_t cell, const EnfPyramid *pyramid, EnfSimdPlanes *out);

/* places.c */
EnfResult enf_dbv_places_create(EnfDbvPlaces *places, const EnfMap *map, const EnfAllocator *allocator, EnfError *error);
void enf_dbv_places_destroy(EnfDbvPlaces *places, const EnfAllocator *allocator);
/** The cell that a place within a cell belongs to, as a place; of a node of the cells' tree, itself. */
static inline uint32_t enf_dbv_owner(const EnfDbvPlaces *places, uint32_t place) {
    return place < places->nodes_first   ? place
           : place < places->walks_first ? places->owners[place - places->nodes_first]
                                         : place - places->walks_first + places->cells_first;
}
size_t enf_dbv_places_bytes(const EnfDbvPlaces *places);
/** The box that enf_dbv_touches takes for a place. */
EnfBox3f enf_dbv_limits(const EnfBox3 *place);
/** As enf_world_touches has it: an overlap of more than a grid step. `limits` is the place's box, a grid step smaller, rounded
 *  outward: a float is above a number just if it is above the next float below that number. Without a branch. */
static inline bool enf_dbv_touches(const EnfBox3f *limits, const EnfBox3f *box) {
    return ((box->max.x > limits->min.x) & (box->min.x < limits->max.x) & (box->max.y > limits->min.y) &
            (box->min.y < limits->max.y) & (box->max.z > limits->min.z) & (box->min.z < limits->max.z)) != 0;
}
void enf_dbv_unhang(EnfDbvIndex *index, uint32_t object);
/** Hangs an object's volume in place of its old one: found from the old place upwards, or from the root (EnfDbvUpdate). Without
 *  memory, the index takes all objects in again in the next frame. */
void enf_dbv_hang(EnfDbvIndex *index, uint32_t object, EnfBox3f volume);
/** Hangs a box on a place and counts it. Without memory, the index takes all objects in again in the next frame. */
void enf_dbv_link_to(EnfDbvIndex *index, uint32_t object, uint32_t place, EnfBox3f box);

/** A way down the tree over cells, parents before children: `next` gives a node or cell, `enter` has its children come, before all
 *  else that waits. Where a place is not entered, nothing beneath it comes. */
typedef struct EnfDbvWalk {
    const EnfMap *map;
    uint32_t cells_first;
    uint32_t item, item_end; /**< of cell_blocks: cells of the leaf entered last */
    uint32_t depth, stack[ENF_KD_MAX_DEPTH + 1];
} EnfDbvWalk;

/** Begins with the root. */
static inline EnfDbvWalk enf_dbv_walk(const EnfDbvPlaces *places) {
    EnfDbvWalk walk;
    walk.map = places->map;
    walk.cells_first = places->cells_first;
    walk.item = walk.item_end = 0;
    walk.depth = places->map->cell_nodes_count > 0 ? 1 : 0;
    walk.stack[0] = 0;
    return walk;
}

/** ENF_NONE at the end. */
static inline uint32_t enf_dbv_walk_next(EnfDbvWalk *walk) {
    while (walk->item < walk->item_end) {
        uint32_t i = walk->item++;
        uint32_t cell = walk->map->cell_blocks[i / ENF_KD_BLOCK].item[i % ENF_KD_BLOCK];
        if (cell != ENF_NONE) {
            return walk->cells_first + cell;
        }
    }
    return walk->depth > 0 ? walk->stack[--walk->depth] : ENF_NONE;
}

static inline void enf_dbv_walk_enter(EnfDbvWalk *walk, uint32_t place) {
    if (place >= walk->cells_first) {
        return; /* a cell: nothing of this tree is beneath */
    }
    const EnfKdNode *node = &walk->map->cell_nodes[place];
    if (node->block_count == 0) {
        walk->stack[walk->depth++] = node->link;
        walk->stack[walk->depth++] = place + 1;
    } else {
        walk->item = node->link * ENF_KD_BLOCK;
        walk->item_end = walk->item + node->block_count * ENF_KD_BLOCK;
    }
}

/* fit.c */
/** Nothing hangs anywhere. */
void enf_dbv_fits_clear(EnfDbvPlaces *places);
/** A box was hung on a place. */
void enf_dbv_grow(EnfDbvPlaces *places, uint32_t place, EnfBox3f box);
/** Fits the box of a node's or cell's own volumes, and those above. @cost its volumes */
void enf_dbv_fit(EnfDbvIndex *index, uint32_t place);

/* seen.c */
/** A cell is seen in this frame. */
void enf_dbv_note_seen(EnfDbvIndex *index, uint32_t cell);
/** Was a cell seen in the last frame? */
bool enf_dbv_cell_is_seen(const EnfDbvIndex *index, uint32_t cell);
/** The cells that a box touches; ENF_NONE if they are more than a volume hangs on. */
uint32_t enf_dbv_cells_of(EnfDbvIndex *index, EnfBox3f box, uint32_t cells[ENF_DBV_LINKS]);
bool enf_dbv_in_few_cells(EnfDbvIndex *index, EnfBox3f box);
/** The distance from `box` to the nearest cell seen in the last frame, or a little less; below 0 if it touches one, HUGE_VAL if none
 *  was seen. */
double enf_dbv_distance_to_seen(EnfDbvIndex *index, EnfBox3f box);

/* reach.c */
/** The cells that a confined object touches until it has gone `limit` metres. */
typedef struct EnfDbvReach {
    uint32_t cells[ENF_DBV_LINKS], count;
    double limit; /**< HUGE_VAL: it is shut in */
} EnfDbvReach;
/** Can a map's portals be walked back wherever they are walked through? Else nothing is reached but by flight. */
bool enf_dbv_can_reach(const EnfMap *map);
/** The boxes of all portals (world), one each. */
void enf_dbv_reach_boxes(const EnfMap *map, EnfBox3f *boxes);
/** False where the object stands in a seen cell, in none, in too many, or at the end of its reach already. */
bool enf_dbv_reach(EnfDbvIndex *index, EnfBox3f now, EnfDbvReach *reach);
/** Hangs `volume`, made for a way shorter than the limit, in the cells of a reach alone. */
void enf_dbv_hang_reach(EnfDbvIndex *index, uint32_t object, EnfBox3f volume, EnfBox3f now, const EnfDbvReach *reach);

/* wheel.c */
void enf_dbv_wheel_create(EnfDbvWheel *wheel, int64_t now);
void enf_dbv_wheel_destroy(EnfDbvWheel *wheel, const EnfAllocator *allocator);
/** Room for `count` objects. False without memory. */
bool enf_dbv_wheel_reserve(EnfDbvIndex *index, uint32_t count);
void enf_dbv_wheel_add(EnfDbvIndex *index, uint32_t object);
void enf_dbv_wheel_remove(EnfDbvIndex *index, uint32_t object);
/** Asks for the memory that taking an object out will touch first; a hint. */
void enf_dbv_wheel_prefetch(const EnfDbvIndex *index, uint32_t object);
/** Takes out all that are due at or before `tick`, into index->due, in order of (expiry tick, object). False without memory. */
bool enf_dbv_wheel_advance(EnfDbvIndex *index, int64_t tick);

/* period.c */
/** Why a volume is made anew. */
typedef enum EnfDbvCause { ENF_DBV_NEW, ENF_DBV_UNSEEN, ENF_DBV_SEEN, ENF_DBV_DRAWN } EnfDbvCause;
/** Sets index->approach by how many objects there are. */
void enf_dbv_choose_approach(EnfDbvIndex *index);
/** Does this policy choose volumes off the seen cells? */
bool enf_dbv_keeps_off_seen(const EnfDbvIndex *index);
/** Ticks that the volume of a drawn object is made for, under such a policy. */
enum { ENF_DBV_DRAWN_PERIOD = 16 };
/** Makes and hangs a new volume for a living object. */
void enf_dbv_renew(EnfDbvIndex *index, uint32_t object, EnfDbvCause cause);
/** Cuts a volume that has long to live to what its object may occupy for a short while, where it hangs. False where that would not
 *  be sooner. For policies that keep off seen cells. */
bool enf_dbv_shorten(EnfDbvIndex *index, uint32_t object);

/* index.c */
bool enf_dbv_list_add(EnfDbvIndex *index, EnfDbvList *list, uint32_t item); /**< false without memory */
/** Sorts numbers by `before`, in place, without heap or recursion (Shell sort, Ciura's gaps): for short lists. */
typedef bool EnfDbvBefore(const EnfDbvIndex *index, uint32_t a, uint32_t b);
void enf_dbv_sort(const EnfDbvIndex *index, EnfDbvList *list, EnfDbvBefore *before);
/** Sorts the numbers from the `first` on, ascending (radix sort by bytes). */
void enf_dbv_sort_numbers(EnfDbvIndex *index, EnfDbvList *list, uint32_t first);
/** A larger copy of an array in place of the old one; false leaves all as it was. */
bool enf_dbv_enlarge(EnfDbvIndex *index, void **array, uint32_t used, uint32_t *capacity, uint32_t count, size_t size);
bool enf_dbv_reserve_volumes(EnfDbvIndex *index, uint32_t count);
bool enf_dbv_reserve_exposures(EnfDbvIndex *index, uint32_t count);

#endif
