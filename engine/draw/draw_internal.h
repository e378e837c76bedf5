/* The memory of an EnfDraw, and the steps between its files: draw.c lists clusters, movers.c moving objects. */
#ifndef ENFILADE_DRAW_INTERNAL_H
#define ENFILADE_DRAW_INTERNAL_H

#include <enfilade/draw.h>

#include "draw/order.h"

/** A part of a moving object: an entry of EnfMap.mesh_parts, and whose in EnfDrawList.movers. */
typedef struct EnfDrawPart {
    uint32_t mover, part;
} EnfDrawPart;

struct EnfDraw {
    EnfDrawList list;
    const EnfMap *map;
    EnfAllocator allocator;
    EnfDrawBatch *batches; /**< one a material drawn, one a part of a mover, then one a run of blended ranges */
    EnfDrawRange *ranges;
    EnfDrawCell *cells;
    uint32_t *cell_stamps;   /**< the frame in which a cell was last listed */
    uint32_t *solids;        /**< visible opaque and masked clusters, ascending */
    uint32_t *grouped;       /**< the same by material; a material's stay ascending */
    uint32_t *material_ends; /**< count, then write position, of each material touched; zero between frames */
    EnfDrawKey *materials;   /**< materials touched */
    EnfDrawKey *blends;      /**< visible blended clusters, and blended parts as clusters_count + their place in `parts` */
    EnfDrawMover *movers;
    EnfDrawPart *parts;     /**< parts drawn, ascending by (mover, part) */
    EnfDrawKey *part_order; /**< opaque and masked parts: a place in `parts` each */
    uint32_t mover_capacity, part_capacity;
    uint32_t solid_count, material_count, blend_count, part_count, part_order_count;
    uint32_t stamp;
    EnfVec3 eye_grid; /**< the grid point nearest to the eye */
};

/** draw.c: a new batch at the end of the list. `mover`: in list.movers, or ENF_NONE for clusters. */
EnfDrawBatch *enf_draw_open_batch(EnfDraw *draw, uint32_t material, uint32_t mover);

/** movers.c: arrays for so many movers and parts instead of those there are, their content lost; false without memory, and then
 *  nothing has changed. */
bool enf_draw_reserve_movers(EnfDraw *draw, uint32_t movers, uint32_t parts);
void enf_draw_free_movers(EnfDraw *draw);
/** movers.c: reserves what the set's objects need, before anything of a frame is listed. */
void enf_draw_make_room(EnfDraw *draw, const EnfVisSet *set, const EnfWorld *world);
/** movers.c: the objects of `set`, or of the world if it lists none: list.movers, their parts, and the keys of these. */
void enf_draw_collect_movers(EnfDraw *draw, const EnfVisSet *set, EnfWorld *world, double alpha);
/** movers.c: batches of opaque parts, then of masked ones; by (material, object, part). */
void enf_draw_list_parts(EnfDraw *draw);
/** movers.c: a batch of one part. */
void enf_draw_list_part(EnfDraw *draw, uint32_t place);

#endif
