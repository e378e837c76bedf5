/* The traversal: which cells are seen, each through which window. Makes EnfVisit records from a view, a map and the state of its
 * portals, after Luebke & Georges 1995 §3, in two ways behind one portal step:
 *
 * - worklist: a cell keeps one window, the union of all through which it was reached, and is worked on again only when that
 *   grows. Windows are fixed point, so it ends; rings and open plans stay cheap (PITFALLS 6, 7, 8).
 * - sequences: depth-first, a window for each sequence of portals, as published. Tighter, and exponential at worst, so it has a
 *   budget beyond which the worklist answers (draw, never hide). */
#include "vis/vis_internal.h"

#include <string.h>

/* Portals a sequences traversal tests before it gives way, where the view names no limit. */
#define SEQUENCE_STEPS 65536U

/* Times a cell's polygon window may grow before it becomes a box. A polygon that comes back round a ring of cells is rounded outward
 * at every portal, so it would grow for long by a sixteenth of a pixel; a box comes back within itself. */
#define POLYGON_GROWTHS 4U

/* What one frame's traversal carries from call to call. */
typedef struct Walk {
    EnfVis *vis;
    const EnfMap *map;
    const EnfPortals *portals;
    const EnfView *view;
    uint32_t steps, max_steps;
    bool no_memory;
} Walk;

/* A window in either mode: `polygon` is read only when the view uses polygons, and `box` bounds it. */
typedef struct Pane {
    EnfWindow box;
    EnfWindowPolygon polygon;
} Pane;

static EnfVec3 eye_in_cell(const EnfMap *map, uint32_t cell, const EnfCamera *camera) {
    const double *o = map->cells[cell].origin;
    return enf_sub(camera->eye_ws, enf_v3(o[0], o[1], o[2]));
}

static bool uses_polygons(const Walk *walk) {
    return walk->view->window == ENF_WINDOW_POLYGON;
}

/* The eye as the far side of a portal with a transform sees it: positions move by p' = m p + t, directions by m. */
static EnfCamera through(const EnfCamera *camera, const EnfTransform *record) {
    EnfAffine affine;
    memcpy(affine.m, record->m, sizeof affine.m);
    affine.t = enf_v3(record->t[0], record->t[1], record->t[2]);
    EnfCamera out = *camera;
    out.eye_ws = enf_affine_point(&affine, camera->eye_ws);
    out.right = enf_affine_vector(&affine, camera->right);
    out.up = enf_affine_vector(&affine, camera->up);
    out.forward = enf_affine_vector(&affine, camera->forward);
    return out;
}

/* The space behind `portal` seen from `space`; ENF_NONE beyond ENF_VIS_SPACES_MAX (mirrors facing mirrors, PITFALLS 20). */
static uint32_t space_behind(EnfVis *vis, const EnfPortalState *state, uint32_t portal, uint32_t space) {
    if (state->transform == ENF_NONE) {
        return space;
    }
    for (uint32_t s = 1; s < vis->space_count; s++) {
        if (vis->steps[s].parent == space && vis->steps[s].portal == portal) {
            return s;
        }
    }
    if (vis->space_count == ENF_VIS_SPACES_MAX) {
        vis->set.counters.fell_back = true;
        return ENF_NONE;
    }
    uint32_t s = vis->space_count++;
    vis->steps[s].parent = space;
    vis->steps[s].portal = portal;
    vis->cameras[s] = through(&vis->cameras[space], &vis->map->transforms[state->transform]);
    return s;
}

/* Is the eye certainly beyond the portal, so that it cannot be looked through from its source? Three-valued: within the slab it
 * is on neither side (PITFALLS 4). The start cell and bent portals have no facing test. */
static bool faces_away(const EnfPortalState *state, EnfVec3 eye, bool start) {
    if (start || (state->flags & ENF_PORTAL_NONPLANAR) != 0) {
        return false;
    }
    return enf_dot(state->normal, eye) + state->d > (double)state->slab;
}

/* The window of one half-portal seen from `eye` (relative to its source cell) through `from`. False: nothing is seen. */
static bool look_through(const Walk *walk, const EnfPortalState *state, const EnfCamera *camera, EnfVec3 eye, const Pane *from,
                         Pane *to) {
    if ((state->flags & ENF_PORTAL_OVERLAP) != 0) {
        *to = *from;
        return true;
    }
    EnfVec3 points[ENF_POLYGON_MAX];
    const EnfVec3f *stored = walk->portals->vertices + state->vertex_first;
    for (uint32_t i = 0; i < state->vertex_count; i++) {
        points[i] = enf_sub(enf_v3_from_f(stored[i]), eye);
    }
    if (uses_polygons(walk)) {
        EnfProject seen = enf_project_polygon(camera, points, state->vertex_count, &from->polygon, &to->polygon);
        to->box = enf_window_polygon_bounds(&to->polygon);
        return seen != ENF_PROJECT_EMPTY;
    }
    return enf_project_box(camera, points, state->vertex_count, from->box, &to->box) != ENF_PROJECT_EMPTY;
}

/* One step of either traversal: looks from visit `index` through half-portal `portal`. False: nothing is seen. */
static bool step(Walk *walk, uint32_t index, uint32_t portal, const Pane *from, Pane *to) {
    EnfVis *vis = walk->vis;
    const EnfVisit *visit = &vis->visits[index];
    const EnfPortalState *state = &walk->portals->states[portal];
    const EnfCamera *camera = &vis->cameras[visit->space];
    walk->steps++;
    vis->set.counters.portals_tested++;
    if ((state->flags & ENF_PORTAL_CLOSED) != 0) {
        return false;
    }
    EnfVec3 eye = eye_in_cell(walk->map, visit->cell, camera);
    if (faces_away(state, eye, index == 0) || !look_through(walk, state, camera, eye, from, to)) {
        return false;
    }
    vis->set.counters.portals_passed++;
    return true;
}

static void pane_of_visit(const Walk *walk, uint32_t index, Pane *pane) {
    const EnfVisit *visit = &walk->vis->visits[index];
    pane->box = visit->window;
    if (uses_polygons(walk)) {
        pane->polygon = walk->vis->polygons[visit->polygon];
    }
}

/* Appends a visit with its window; ENF_NONE (and walk->no_memory) when memory ran out. */
static uint32_t add_visit(Walk *walk, EnfVisit visit, const Pane *pane) {
    EnfVis *vis = walk->vis;
    visit.window = pane->box;
    visit.polygon = ENF_NONE;
    if (uses_polygons(walk)) {
        if (!enf_vis_reserve_polygons(vis, vis->polygon_count + 1U)) {
            walk->no_memory = true;
            return ENF_NONE;
        }
        visit.polygon = vis->polygon_count++;
        vis->polygons[visit.polygon] = pane->polygon;
    }
    uint32_t index = enf_vis_add_visit(vis, visit);
    walk->no_memory = walk->no_memory || index == ENF_NONE;
    return index;
}

static Walk begin(EnfVis *vis, const EnfPortals *portals, const EnfView *view) {
    Walk walk = {vis, vis->map, portals, view, 0, view->max_steps, false};
    vis->visit_count = 0;
    vis->polygon_count = 0;
    vis->queue_head = ENF_NONE;
    vis->queue_tail = ENF_NONE;
    vis->space_count = 1;
    vis->cameras[0] = view->camera;
    vis->frame++;
    if (vis->frame == 0) { /* the counter wrapped: old stamps must not look new */
        memset(vis->cell_frame, 0, vis->map->cells_count * sizeof *vis->cell_frame);
        vis->frame = 1;
    }
    return walk;
}

static uint32_t add_start(Walk *walk) {
    Pane pane;
    pane.box = enf_window_full(&walk->view->camera);
    if (uses_polygons(walk)) {
        pane.polygon = enf_window_polygon_from_box(pane.box);
    }
    EnfVisit visit = {walk->view->cell, 0, ENF_NONE, ENF_NONE, pane.box, ENF_NONE};
    return add_visit(walk, visit, &pane);
}

/* ---- worklist --------------------------------------------------------------------------------------------------- */

static void enqueue(EnfVis *vis, uint32_t index) {
    EnfVisitLink *link = &vis->links[index];
    if (link->queued) {
        return;
    }
    link->queued = true;
    link->next = ENF_NONE;
    if (vis->queue_tail == ENF_NONE) {
        vis->queue_head = index;
    } else {
        vis->links[vis->queue_tail].next = index;
    }
    vis->queue_tail = index;
}

static uint32_t dequeue(EnfVis *vis) {
    uint32_t index = vis->queue_head;
    vis->queue_head = vis->links[index].next;
    if (vis->queue_head == ENF_NONE) {
        vis->queue_tail = ENF_NONE;
    }
    vis->links[index].queued = false;
    return index;
}

/* The visit of (cell, space), or ENF_NONE. Spaces beyond the first hold few cells and are searched. */
static uint32_t find_visit(const EnfVis *vis, uint32_t cell, uint32_t space) {
    if (space == 0) {
        return vis->cell_frame[cell] == vis->frame ? vis->cell_visit[cell] : ENF_NONE;
    }
    for (uint32_t i = 0; i < vis->visit_count; i++) {
        if (vis->visits[i].cell == cell && vis->visits[i].space == space) {
            return i;
        }
    }
    return ENF_NONE;
}

/* Grows the window of a visit. False if it already held all of `pane`. */
static bool widen(const Walk *walk, uint32_t index, const Pane *pane) {
    EnfVis *vis = walk->vis;
    EnfVisit *visit = &vis->visits[index];
    if (uses_polygons(walk)) {
        EnfWindowPolygon *polygon = &vis->polygons[visit->polygon];
        if (enf_window_polygon_contains(polygon, &pane->polygon)) {
            return false;
        }
        EnfWindowPolygon joined;
        enf_window_polygon_union(polygon, &pane->polygon, &joined);
        visit->window = enf_window_polygon_bounds(&joined);
        bool rings = ++vis->links[index].growths > POLYGON_GROWTHS;
        *polygon = rings ? enf_window_polygon_from_box(visit->window) : joined;
        return true;
    }
    if (enf_window_contains(visit->window, pane->box)) {
        return false;
    }
    visit->window = enf_window_union(visit->window, pane->box);
    return true;
}

/* `pane` of (cell, space) was found behind `portal` of visit `from`. */
static void reach(Walk *walk, uint32_t from, uint32_t portal, uint32_t space, const Pane *pane) {
    EnfVis *vis = walk->vis;
    uint32_t cell = walk->portals->states[portal].target;
    uint32_t index = find_visit(vis, cell, space);
    if (index == ENF_NONE) {
        EnfVisit visit = {cell, space, portal, from, pane->box, ENF_NONE};
        index = add_visit(walk, visit, pane);
        if (index == ENF_NONE) {
            return;
        }
        if (space == 0) {
            vis->cell_frame[cell] = vis->frame;
            vis->cell_visit[cell] = index;
        }
        enqueue(vis, index);
    } else if (widen(walk, index, pane)) {
        vis->set.counters.requeued += vis->links[index].queued ? 0U : 1U;
        enqueue(vis, index);
    }
}

EnfTraverseEnd enf_vis_worklist(EnfVis *vis, const EnfPortals *portals, const EnfView *view) {
    Walk walk = begin(vis, portals, view);
    uint32_t start = add_start(&walk);
    if (start == ENF_NONE) {
        return ENF_TRAVERSE_MEMORY;
    }
    vis->cell_frame[view->cell] = vis->frame;
    vis->cell_visit[view->cell] = start;
    enqueue(vis, start);
    while (vis->queue_head != ENF_NONE && !walk.no_memory) {
        uint32_t index = dequeue(vis);
        Pane from;
        Pane to;
        pane_of_visit(&walk, index, &from);
        const EnfCell *cell = &walk.map->cells[vis->visits[index].cell];
        for (uint32_t p = cell->portal_first; p < cell->portal_first + cell->portal_count; p++) {
            if (!step(&walk, index, p, &from, &to)) {
                continue;
            }
            uint32_t space = space_behind(vis, &portals->states[p], p, vis->visits[index].space);
            if (space != ENF_NONE) {
                reach(&walk, index, p, space, &to);
            }
        }
        if (walk.max_steps != 0 && walk.steps > walk.max_steps) {
            return ENF_TRAVERSE_LIMIT;
        }
    }
    return walk.no_memory ? ENF_TRAVERSE_MEMORY : ENF_TRAVERSE_DONE;
}

/* ---- sequences -------------------------------------------------------------------------------------------------- */

/* Has this sequence gone through `portal` (in this space) before? Then its window there held this one, and all that could be
 * found was found. Keeps slivers of tolerance from turning a pair of twins into an endless sequence. */
static bool in_sequence(const EnfVis *vis, uint32_t index, uint32_t portal, uint32_t space) {
    for (uint32_t v = index; v != ENF_NONE; v = vis->visits[v].parent) {
        if (vis->visits[v].portal == portal && vis->visits[v].space == space) {
            return true;
        }
    }
    return false;
}

/* Looks through every portal of a visit and stacks what is seen; the stack is the queue's links, last in, first out. */
static void expand(Walk *walk, uint32_t index) {
    EnfVis *vis = walk->vis;
    Pane from;
    Pane to;
    pane_of_visit(walk, index, &from);
    const EnfCell *cell = &walk->map->cells[vis->visits[index].cell];
    for (uint32_t k = cell->portal_count; k > 0 && !walk->no_memory; k--) {
        uint32_t portal = cell->portal_first + k - 1U;
        if (!step(walk, index, portal, &from, &to)) {
            continue;
        }
        const EnfPortalState *state = &walk->portals->states[portal];
        uint32_t space = space_behind(vis, state, portal, vis->visits[index].space);
        if (space == ENF_NONE || in_sequence(vis, index, portal, space)) {
            continue;
        }
        EnfVisit visit = {state->target, space, portal, index, to.box, ENF_NONE};
        uint32_t child = add_visit(walk, visit, &to);
        if (child != ENF_NONE) {
            vis->links[child].next = vis->queue_head;
            vis->queue_head = child;
        }
    }
}

EnfTraverseEnd enf_vis_sequences(EnfVis *vis, const EnfPortals *portals, const EnfView *view) {
    Walk walk = begin(vis, portals, view);
    walk.max_steps = walk.max_steps != 0 ? walk.max_steps : SEQUENCE_STEPS;
    vis->queue_head = add_start(&walk);
    while (vis->queue_head != ENF_NONE && !walk.no_memory) {
        if (walk.steps > walk.max_steps) {
            return ENF_TRAVERSE_LIMIT;
        }
        uint32_t index = vis->queue_head;
        vis->queue_head = vis->links[index].next;
        expand(&walk, index);
    }
    return walk.no_memory ? ENF_TRAVERSE_MEMORY : ENF_TRAVERSE_DONE;
}
