/* A frame of visibility: traversal (or a baseline), what leaking cells add, collection, result. The only place where limits are
 * answered, always by listing more (DESIGN §2: draw, never hide). */
#include "vis/vis_internal.h"

#include <string.h>

EnfView enf_view_default(void) {
    EnfView view;
    memset(&view, 0, sizeof view);
    view.camera = enf_camera(enf_v3(0.0, 0.0, 0.0), enf_turn(0.0, 0.0, 0.0), 60.0, 640, 480);
    view.cell = ENF_NONE;
    view.cull = ENF_CULL_WORKLIST;
    view.window = ENF_WINDOW_BOX;
    view.grain = ENF_GRAIN_OBJECTS;
    return view;
}

/* Forgets what was found and starts over with the picture's camera alone. */
static void restart(EnfVis *vis, const EnfView *view) {
    vis->visit_count = 0;
    vis->polygon_count = 0;
    vis->entry_count = 0;
    vis->space_count = 1;
    vis->cameras[0] = view->camera;
}

/* Everything in the picture's pyramid: cells + OUTSIDE visits were reserved when `vis` was made, so this cannot fail. */
static void list_picture(EnfVis *vis, const EnfView *view) {
    restart(vis, view);
    bool ok = enf_vis_list_frustum(vis, 0, enf_window_full(&view->camera));
    ENF_ASSERT(ok);
    (void)ok;
}

/* Whoever sees into a cell whose shell leaks may see anything in that window, in that space (PITFALLS 17). */
static bool list_open_windows(EnfVis *vis) {
    EnfWindow windows[ENF_VIS_SPACES_MAX];
    memset(windows, 0, vis->space_count * sizeof *windows);
    for (uint32_t v = 0; v < vis->visit_count; v++) {
        const EnfVisit *visit = &vis->visits[v];
        if ((vis->map->cells[visit->cell].flags & ENF_CELL_OPEN) != 0) {
            windows[visit->space] = enf_window_union(windows[visit->space], visit->window);
            vis->set.counters.open = true;
        }
    }
    bool ok = true;
    for (uint32_t space = 0; space < vis->space_count && ok && vis->set.counters.open; space++) {
        if (!enf_window_is_empty(windows[space])) {
            ok = enf_vis_list_frustum(vis, space, windows[space]);
        }
    }
    return ok;
}

/* Visits by portals. False when the frustum must answer instead. */
static bool traverse(EnfVis *vis, const EnfPortals *portals, const EnfView *view) {
    EnfTraverseEnd end = ENF_TRAVERSE_LIMIT;
    if (view->cull == ENF_CULL_SEQUENCES) {
        end = enf_vis_sequences(vis, portals, view);
    }
    if (view->cull == ENF_CULL_WORKLIST || end != ENF_TRAVERSE_DONE) {
        vis->set.counters.fell_back = view->cull == ENF_CULL_SEQUENCES;
        end = enf_vis_worklist(vis, portals, view);
    }
    return end == ENF_TRAVERSE_DONE && list_open_windows(vis);
}

static void find_visits(EnfVis *vis, const EnfPortals *portals, const EnfView *view) {
    restart(vis, view);
    if (view->cull == ENF_CULL_NONE) {
        bool ok = enf_vis_list_all(vis);
        ENF_ASSERT(ok);
        (void)ok;
        return;
    }
    bool located = view->cell < vis->map->cells_count;
    vis->set.counters.outside = !located;
    if (view->cull == ENF_CULL_FRUSTUM || !located) {
        list_picture(vis, view);
    } else if (!traverse(vis, portals, view)) {
        vis->set.counters.fell_back = true;
        list_picture(vis, view);
    }
}

static void publish(EnfVis *vis) {
    EnfVisSet *set = &vis->set;
    set->visits = vis->visits;
    set->visit_count = vis->visit_count;
    set->cells = vis->cells;
    set->entries = vis->entries;
    set->entry_count = vis->entry_count;
    set->cameras = vis->cameras;
    set->space_count = vis->space_count;
    set->polygons = vis->polygons;
    set->polygon_count = vis->polygon_count;
    set->counters.visits = vis->visit_count;
    set->counters.cells = set->cell_count;
}

const EnfVisSet *enf_vis_run(EnfVis *vis, const EnfPortals *portals, const EnfView *view) {
    ENF_ASSERT(portals->map == vis->map);
    memset(&vis->set, 0, sizeof vis->set);
    vis->set.objects_failed = view->dbv != NULL && enf_dbv_begin(view->dbv, NULL) != ENF_OK;
    find_visits(vis, portals, view);
    if (!enf_vis_collect(vis, view)) {
        /* No memory for entries of several spaces or primitives: one space, objects, which always fit. */
        EnfView plain = *view;
        plain.grain = ENF_GRAIN_OBJECTS;
        vis->set.counters.fell_back = true;
        list_picture(vis, &plain);
        bool ok = enf_vis_collect(vis, &plain);
        ENF_ASSERT(ok);
        (void)ok;
    }
    publish(vis);
    if (view->dbv != NULL) {
        vis->set.objects = enf_dbv_end(view->dbv, &vis->set.object_count);
        vis->set.objects_failed = vis->set.objects_failed || enf_dbv_failed(view->dbv);
        vis->set.objects_listed = !vis->set.objects_failed;
    }
    return &vis->set;
}

uint64_t enf_vis_hash(const EnfVisSet *set) {
    uint64_t hash = enf_hash64(ENF_HASH_START, set->cells, set->cell_count * sizeof *set->cells);
    for (uint32_t i = 0; i < set->entry_count; i++) {
        uint32_t key[2] = {set->entries[i].space, set->entries[i].cluster};
        hash = enf_hash64(hash, key, sizeof key);
    }
    return hash;
}
