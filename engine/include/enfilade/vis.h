/* EnfView → EnfVisSet: what the eye can see. Luebke–Georges traversal of cells and portals with screen-space windows, then a
 * kd query of each visible cell. DESIGN §2–3; PITFALLS 1–12, 27. Source: Luebke & Georges, Portals and Mirrors, I3D 1995. */
#ifndef ENFILADE_VIS_H
#define ENFILADE_VIS_H

#include <enfilade/dbv.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum EnfCull {
    ENF_CULL_NONE,      /**< everything in the map */
    ENF_CULL_FRUSTUM,   /**< every cell's kd-tree with the picture's pyramid; portals unused */
    ENF_CULL_SEQUENCES, /**< depth-first over portal sequences, a window each (the paper's) */
    ENF_CULL_WORKLIST   /**< one accumulated window a cell, re-queued only when it grows */
} EnfCull;
typedef enum EnfWindowMode { ENF_WINDOW_BOX, ENF_WINDOW_POLYGON } EnfWindowMode;
/** OBJECTS: a cluster is listed once, if any window sees it. PRIMITIVES: one entry for each (cluster, visit), to be drawn
 *  clipped to the visit's window (the paper's primitive-level clipping). */
typedef enum EnfGrain { ENF_GRAIN_OBJECTS, ENF_GRAIN_PRIMITIVES } EnfGrain;

typedef struct EnfView {
    EnfDbvIndex *dbv; /**< moving objects to be found (one frame of the index a run), or NULL */
    EnfCamera camera;
    uint32_t cell; /**< the eye's cell, or ENF_NONE: outside every cell, everything in the frustum is listed */
    EnfCull cull;
    EnfWindowMode window;
    EnfGrain grain;
    uint32_t max_steps; /**< portals tested before the traversal gives up and lists the frustum; 0: no limit for worklist,
                                   65,536 for sequences, which then falls back to worklist (draw, never hide) */
} EnfView;

/** The defaults: worklist, boxes, objects. */
EnfView enf_view_default(void);

/** A cell seen through a window, in the space of transform `space` (0: the world as it is; others: through mirrors and
 *  teleports, see EnfVisSet.cameras). With worklist one for each (cell, space); with sequences one for each sequence. */
typedef struct EnfVisit {
    uint32_t cell;
    uint32_t space;
    uint32_t portal; /**< half-portal first entered through, ENF_NONE for the eye's cell */
    uint32_t parent; /**< visit it was first entered from, or ENF_NONE */
    EnfWindow window;
    uint32_t polygon; /**< in EnfVisSet.polygons, or ENF_NONE (box windows) */
} EnfVisit;

typedef struct EnfVisEntry {
    uint32_t cluster, space, visit;
} EnfVisEntry;

typedef struct EnfVisCounters {
    uint32_t portals_tested; /**< half-portals looked at, closed and averted ones included */
    uint32_t portals_passed; /**< of these, with a window left */
    uint32_t visits, cells;
    uint32_t requeued;        /**< cells whose window grew after they had been worked on */
    uint32_t kd_nodes, boxes; /**< tested against a pyramid */
    uint32_t clusters;        /**< distinct (space, cluster) */
    bool fell_back;           /**< a limit was hit: the frustum (or worklist) answered instead */
    bool outside;             /**< the eye was in no cell */
    bool open;                /**< a cell with a leaking shell was seen */
} EnfVisCounters;

/** Spaces (worlds through mirrors and teleports) a view may reach; beyond it they are not entered and fell_back says so. */
#define ENF_VIS_SPACES_MAX 64

/** Valid until the next enf_vis_run of its EnfVis. */
typedef struct EnfVisSet {
    const EnfVisit *visits;
    uint32_t visit_count;
    const uint32_t *cells; /**< distinct visible cells, ascending */
    uint32_t cell_count;
    const EnfVisEntry *entries; /**< visible clusters, ascending by (space, cluster[, visit]): the canonical order */
    uint32_t entry_count;
    const uint32_t *objects; /**< moving objects drawn, ascending (EnfView.dbv; any space) */
    uint32_t object_count;
    bool objects_listed;      /**< an index answered: what is not in `objects` is hidden. Else every object must be drawn */
    bool objects_failed;      /**< memory ran out in the index: every object must be drawn */
    const EnfCamera *cameras; /**< one a space: the eye as that space sees it; [0] is the view's camera */
    uint32_t space_count;
    const EnfWindowPolygon *polygons;
    uint32_t polygon_count;
    EnfVisCounters counters;
} EnfVisSet;

typedef struct EnfVis EnfVis;

/** Working memory for views of one map; sized so that a warm frame makes no heap call. */
EnfResult enf_vis_create(EnfVis **vis, const EnfMap *map, const EnfAllocator *allocator, EnfError *error);
void enf_vis_destroy(EnfVis *vis);

/** What `view` sees. Never fails: every limit falls back to listing more.
 *  @guarantee no cluster with a visible point is missing: tests/property/test_vis (id-buffer and exact oracles), every
 *  traversal, window and cell count. @cost follows what is visible; no work a hidden cell or object. */
const EnfVisSet *enf_vis_run(EnfVis *vis, const EnfPortals *portals, const EnfView *view);

/** A 64-bit hash of cells and entries: equal for equal results. */
uint64_t enf_vis_hash(const EnfVisSet *set);

#ifdef __cplusplus
}
#endif
#endif
