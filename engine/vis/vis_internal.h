/* Working memory of a traversal and the steps between its files: traverse.c finds visits, collect.c turns visits into cells and
 * clusters, workspace.c owns the memory. */
#ifndef ENFILADE_VIS_INTERNAL_H
#define ENFILADE_VIS_INTERNAL_H

#include <enfilade/vis.h>

/** A set of small integers that is walked in ascending order and cleared in time proportional to what it holds (and one word for
 *  4,096 possible members): bits, and a bit for each non-zero word of bits. */
typedef struct EnfBits {
    uint64_t *words, *summary;
    uint32_t word_count, summary_count;
} EnfBits;

/** How the traversal reached a space: through `portal` from space `parent`. */
typedef struct EnfSpaceStep {
    uint32_t parent, portal;
} EnfSpaceStep;

/** A visit's place in the queue. */
typedef struct EnfVisitLink {
    uint32_t next;
    uint32_t growths; /**< of its polygon window */
    bool queued;
} EnfVisitLink;

struct EnfVis {
    const EnfMap *map;
    const EnfAllocator *allocator;

    EnfVisit *visits;    /**< grows; a warm frame finds it large enough */
    EnfVisitLink *links; /**< parallel to visits: the queue of those to work on, first in, first out */
    uint32_t visit_count, visit_capacity, queue_head, queue_tail;

    EnfWindowPolygon *polygons; /**< one a visit with polygon windows, none before first use */
    uint32_t polygon_count, polygon_capacity;

    uint32_t *cell_frame; /**< a cell: the frame that last visited it in space 0 (stamps: no clearing a frame) */
    uint32_t *cell_visit; /**< a cell: its visit in that frame */
    uint32_t frame;

    EnfCamera cameras[ENF_VIS_SPACES_MAX];
    EnfSpaceStep steps[ENF_VIS_SPACES_MAX];
    uint32_t space_count;

    EnfBits cell_bits, cluster_bits;
    uint32_t *cluster_visit; /**< a cluster: the visit that saw it first */
    uint32_t *items;         /**< results of one kd query */
    uint32_t items_capacity;
    uint32_t *cells;
    EnfVisEntry *entries; /**< grows (several spaces or primitives) */
    uint32_t entry_count, entry_capacity;

    EnfVisSet set;
};

/** Why a traversal ended. */
typedef enum EnfTraverseEnd { ENF_TRAVERSE_DONE, ENF_TRAVERSE_LIMIT, ENF_TRAVERSE_MEMORY } EnfTraverseEnd;

/* traverse.c: fill vis->visits from the eye's cell. */
EnfTraverseEnd enf_vis_worklist(EnfVis *vis, const EnfPortals *portals, const EnfView *view);
EnfTraverseEnd enf_vis_sequences(EnfVis *vis, const EnfPortals *portals, const EnfView *view);

/* collect.c */
/** Every cell that `window` of space `space` may show, as visits. False when memory ran out. */
bool enf_vis_list_frustum(EnfVis *vis, uint32_t space, EnfWindow window);
/** Every cell of the map, unculled. */
bool enf_vis_list_all(EnfVis *vis);
/** Cells and entries from the visits. False when memory ran out. */
bool enf_vis_collect(EnfVis *vis, const EnfView *view);

/* workspace.c: amortised growth; false when memory ran out, and then nothing has changed. */
bool enf_vis_reserve_visits(EnfVis *vis, uint32_t count);
bool enf_vis_reserve_polygons(EnfVis *vis, uint32_t count);
bool enf_vis_reserve_entries(EnfVis *vis, uint32_t count);
/** Appends a visit; ENF_NONE when memory ran out. */
uint32_t enf_vis_add_visit(EnfVis *vis, EnfVisit visit);
/** Adds a member; true if it is new. */
bool enf_bits_add(EnfBits *bits, uint32_t member);
/** Writes the members in ascending order to out (NULL: nowhere) and empties the set. Returns their count. */
uint32_t enf_bits_drain(EnfBits *bits, uint32_t *out);

#endif
