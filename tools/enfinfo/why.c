/* Why a cell is seen, or not: the chain of visits that admitted it, or, at the border of what is seen, the portals on the shortest
 * ways to it with the test that each of them failed. */
#include "enfinfo/info.h"
#include "enfinfo/table.h"
#include <enfilade/tolerances.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CUTS_SHOWN = 8, NAMES_SHOWN = 8 };

typedef struct Why {
    const EnfMap *map;
    const Options *options;
    EnfPortals portals;
    EnfVis *vis;
    EnfView view;
    const EnfVisSet *set;
    uint32_t target;
    uint32_t *steps; /**< a cell: portals from it to the target through hidden cells; ENF_NONE: no way */
} Why;

/* ---- windows ---------------------------------------------------------------------------------------------------- */

static const char *window_text(EnfWindow w, char out[64]) {
    const double step = ENF_WINDOW_STEPS;
    snprintf(out, 64, "%.1f..%.1f × %.1f..%.1f", w.x0 / step, w.x1 / step, w.y0 / step, w.y1 / step);
    return out;
}

static double window_share(const Why *why, EnfWindow w) {
    const double steps = ENF_WINDOW_STEPS * ENF_WINDOW_STEPS;
    double pixels = (double)(w.x1 - w.x0) * (double)(w.y1 - w.y0) / steps;
    return 100.0 * pixels / ((double)why->options->size[0] * why->options->size[1]);
}

/* ---- seen ------------------------------------------------------------------------------------------------------- */

static uint32_t find_visit(const Why *why, uint32_t cell) {
    for (uint32_t i = 0; i < why->set->visit_count; i++) {
        if (why->set->visits[i].cell == cell) {
            return i;
        }
    }
    return ENF_NONE;
}

static void add_visit_row(const Why *why, Table *table, uint32_t index) {
    const EnfVisit *visit = &why->set->visits[index];
    char window[64];
    table_cell(table, "  %s", info_cell_name(why->map, visit->cell));
    if (visit->portal != ENF_NONE) {
        table_cell(table, "%s (half-portal %u)", enf_map_string(why->map, why->map->portals[visit->portal].name),
                   visit->portal);
    } else {
        table_cell(table, index == 0 && !why->set->counters.outside ? "the eye is here" : "no portal: all in view is listed");
    }
    table_cell(table, "%s", window_text(visit->window, window));
    table_cell(table, "%.1f %%", window_share(why, visit->window));
}

static uint32_t clusters_in_view(const Why *why) {
    uint32_t count = 0, last = ENF_NONE;
    for (uint32_t i = 0; i < why->set->entry_count; i++) {
        uint32_t cluster = why->set->entries[i].cluster;
        count += cluster != last && why->map->clusters[cluster].cell == why->target;
        last = cluster;
    }
    return count;
}

/* The chain backwards from `visit` by its parents, then printed forwards. */
static int print_chain(const Why *why, uint32_t visit) {
    uint32_t *chain = malloc(why->set->visit_count * sizeof *chain), length = 0;
    if (!chain) {
        fprintf(stderr, "enfinfo: out of memory\n");
        return ENF_EXIT_FAILURE;
    }
    for (uint32_t i = visit; i != ENF_NONE && length < why->set->visit_count; i = why->set->visits[i].parent) {
        chain[length++] = i;
    }
    printf("\"%s\" is seen, through %u %s:\n\n", info_cell_name(why->map, why->target), length - 1,
           length == 2 ? "portal" : "portals");
    Table table = {{0}, {0}, 0, NULL, 0, 0, false};
    table_titles(&table, "  cell|entered by|#window (x × y, px)|#of the picture");
    while (length) {
        add_visit_row(why, &table, chain[--length]);
    }
    table_print(&table, UINT32_MAX, "");
    table_free(&table);
    free(chain);
    printf("\n%u of its %u clusters are in view.\n", clusters_in_view(why), why->map->cells[why->target].cluster_count);
    return ENF_EXIT_OK;
}

/* ---- hidden ----------------------------------------------------------------------------------------------------- */

/* Portals from each hidden cell to the target, closed ones included: passes over all portals until nothing gets nearer. A way that
 * comes back into view is no way from there, but from the cell where it does. */
static bool count_steps(Why *why) {
    const EnfMap *map = why->map;
    why->steps = malloc((map->cells_count + 1) * sizeof *why->steps);
    if (!why->steps) {
        return false;
    }
    memset(why->steps, 0xff, (map->cells_count + 1) * sizeof *why->steps);
    why->steps[why->target] = 0;
    for (bool changed = true; changed;) {
        changed = false;
        for (uint32_t i = 0; i < map->portals_count; i++) {
            uint32_t beyond = why->steps[map->portals[i].target], *here = &why->steps[map->portals[i].source];
            bool nearer = beyond != ENF_NONE && (*here == ENF_NONE || *here > beyond + 1);
            if (nearer && find_visit(why, map->portals[i].source) == ENF_NONE) {
                *here = beyond + 1;
                changed = true;
            }
        }
    }
    return true;
}

/* A half-portal as a visit of its source sees it. */
typedef struct Look {
    const EnfVisit *visit;
    const EnfCamera *camera;
    const EnfPortalState *state;
    EnfVec3 eye; /* relative to the source cell's origin */
    EnfVec3 points[ENF_POLYGON_MAX];
} Look;

static Look look_at(const Why *why, uint32_t visit, uint32_t portal) {
    Look look = {&why->set->visits[visit], NULL, &why->portals.states[portal], {0, 0, 0}, {{0, 0, 0}}};
    look.camera = &why->set->cameras[look.visit->space];
    const double *o = why->map->cells[look.visit->cell].origin;
    look.eye = enf_sub(look.camera->eye_ws, enf_v3(o[0], o[1], o[2]));
    for (uint32_t i = 0; i < look.state->vertex_count; i++) {
        look.points[i] = enf_sub(enf_v3_from_f(why->portals.vertices[look.state->vertex_first + i]), look.eye);
    }
    return look;
}

/* Where the portal's middle lies for somebody who looks along the line of sight. */
static void print_direction(const Look *look) {
    EnfVec3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < look->state->vertex_count; i++) {
        sum = enf_add(sum, look->points[i]);
    }
    double right = enf_dot(sum, look->camera->right), up = enf_dot(sum, look->camera->up);
    double forward = enf_dot(sum, look->camera->forward);
    double aside = enf_atan2(right, forward) * 180.0 / ENF_PI;
    double above = enf_atan2(up, enf_length(enf_v3(right, forward, 0.0))) * 180.0 / ENF_PI;
    printf("its middle is %.1f° to the %s and %.1f° %s", aside < 0.0 ? -aside : aside, aside < 0.0 ? "left" : "right",
           above < 0.0 ? -above : above, above < 0.0 ? "down" : "up");
}

static double farthest_depth(const Look *look) {
    double depth = -1e300;
    for (uint32_t i = 0; i < look->state->vertex_count; i++) {
        double d = enf_dot(look->points[i], look->camera->forward);
        depth = d > depth ? d : depth;
    }
    return depth;
}

/* The tests of the traversal, in its order; the first that fails is the reason. */
static void print_reason(const Why *why, uint32_t visit, uint32_t portal) {
    Look look = look_at(why, visit, portal);
    EnfWindow alone;
    char text[64];
    double beyond = enf_dot(look.state->normal, look.eye) + look.state->d;
    if (look.state->flags & ENF_PORTAL_CLOSED) {
        printf("closed");
    } else if (look.state->flags & ENF_PORTAL_OVERLAP) {
        printf("an overlap, which is always passed: a limit of the traversal was met");
    } else if (visit != 0 && !(look.state->flags & ENF_PORTAL_NONPLANAR) && beyond > (double)look.state->slab) {
        printf("faces away: the eye is %.3f m beyond its plane (more than %.2g m, by which it may bend)", beyond,
               (double)look.state->slab);
    } else if (farthest_depth(&look) < ENF_TOL_EYE_PLANE) {
        printf("behind the eye: it ends %.3f m before the eye's plane", -farthest_depth(&look));
    } else if (enf_project_box(look.camera, look.points, look.state->vertex_count, enf_window_full(look.camera), &alone) ==
               ENF_PROJECT_EMPTY) {
        printf("outside the picture: ");
        print_direction(&look);
    } else {
        bool meet = !enf_window_is_empty(enf_window_intersect(alone, look.visit->window));
        printf("no window left: alone it would show %s px,", window_text(alone, text));
        printf(meet ? "\n      whose shape misses that of \"%s\" within %s" : "\n      but \"%s\" is seen within %s",
               info_cell_name(why->map, look.visit->cell), window_text(look.visit->window, text));
    }
}

/* The cells on a shortest way from `cell` on. */
static void print_way(const Why *why, uint32_t cell) {
    for (uint32_t shown = 0; why->steps[cell] != 0; shown++) {
        if (shown == NAMES_SHOWN) {
            printf(" → …");
            return;
        }
        const EnfCell *c = &why->map->cells[cell];
        uint32_t next = cell;
        for (uint32_t p = c->portal_first; next == cell && p < c->portal_first + c->portal_count; p++) {
            uint32_t beyond = why->map->portals[p].target;
            next = why->steps[beyond] == why->steps[cell] - 1 ? beyond : next;
        }
        cell = next;
        printf(" → %s", info_cell_name(why->map, cell));
    }
}

static void print_cut(const Why *why, uint32_t portal) {
    const EnfPortal *p = &why->map->portals[portal];
    uint32_t visit = find_visit(why, p->source);
    printf("  %s → %s by %s (half-portal %u", info_cell_name(why->map, p->source), info_cell_name(why->map, p->target),
           enf_map_string(why->map, p->name), portal);
    printf("; then %u more", why->steps[p->target]);
    printf("):\n      ");
    print_reason(why, visit, portal);
    printf("\n      way:  %s → %s", info_cell_name(why->map, p->source), info_cell_name(why->map, p->target));
    print_way(why, p->target);
    printf("\n");
}

/* Is the half-portal on the border of what is seen, with a way to the target behind it? */
static bool is_cut(const Why *why, uint32_t portal) {
    const EnfPortal *p = &why->map->portals[portal];
    return why->steps[p->target] != ENF_NONE && find_visit(why, p->source) != ENF_NONE &&
           find_visit(why, p->target) == ENF_NONE;
}

/* The cuts, nearest to the target first. */
static int print_cuts(Why *why) {
    const EnfMap *map = why->map;
    uint32_t shown = 0, total = 0;
    if (!count_steps(why)) {
        fprintf(stderr, "enfinfo: out of memory\n");
        return ENF_EXIT_FAILURE;
    }
    for (uint32_t i = 0; i < map->portals_count; i++) {
        total += is_cut(why, i);
    }
    printf("\"%s\" is hidden", info_cell_name(map, why->target));
    if (why->set->counters.outside) {
        printf(": no part of it is in the picture's frustum.\n");
        return ENF_EXIT_FAILURE;
    }
    printf(total ? ". Every way to it is cut; the shortest ones here:\n" : ": no portals lead to it from what is in view.\n");
    for (uint32_t steps = 0; shown < total && shown < CUTS_SHOWN && steps <= map->cells_count; steps++) {
        for (uint32_t i = 0; i < map->portals_count && shown < CUTS_SHOWN; i++) {
            if (why->steps[map->portals[i].target] == steps && is_cut(why, i)) {
                print_cut(why, i);
                shown++;
            }
        }
    }
    if (shown < total) {
        printf("  ... and %u more on longer ways\n", total - shown);
    }
    return ENF_EXIT_FAILURE;
}

/* ---- the question ----------------------------------------------------------------------------------------------- */

/* The two cells by name; false with a message. */
static bool find_cells(Why *why) {
    const Options *o = why->options;
    const char *absent = NULL;
    why->target = enf_map_find_cell(why->map, o->cell);
    absent = why->target == ENF_NONE ? o->cell : NULL;
    why->view.cell = o->from ? enf_map_find_cell(why->map, o->from) : enf_map_locate(why->map, why->view.camera.eye_ws);
    if (!absent && o->from && why->view.cell == ENF_NONE) {
        absent = o->from;
    }
    if (absent) {
        fprintf(stderr, "enfinfo: the map has no cell '%s'; --cells lists them\n", absent);
    }
    return !absent;
}

static int answer(Why *why) {
    const Options *o = why->options;
    why->set = enf_vis_run(why->vis, &why->portals, &why->view);
    printf("The eye is at (%g, %g, %g), yaw %g°, pitch %g°, in %s%s%s; %u of %u cells are in view.\n", o->eye[0], o->eye[1],
           o->eye[2], o->yaw_deg, o->pitch_deg, why->view.cell == ENF_NONE ? "no cell" : "\"",
           why->view.cell == ENF_NONE ? ": everything in the picture's frustum is shown"
                                      : info_cell_name(why->map, why->view.cell),
           why->view.cell == ENF_NONE ? "" : "\"", why->set->cell_count, why->map->cells_count);
    if (why->set->counters.fell_back) {
        printf("A limit of the traversal was met: more than the portals' windows is shown.\n");
    }
    uint32_t visit = find_visit(why, why->target);
    return visit != ENF_NONE ? print_chain(why, visit) : print_cuts(why);
}

int info_why(const EnfMap *map, const Options *options) {
    Why why = {.map = map, .options = options, .view = enf_view_default()};
    why.view.camera = enf_camera(enf_v3(options->eye[0], options->eye[1], options->eye[2]),
                                 enf_turn(options->yaw_deg, options->pitch_deg, 0.0), options->fov_y_deg, options->size[0],
                                 options->size[1]);
    why.view.window = options->window ? ENF_WINDOW_POLYGON : ENF_WINDOW_BOX;
    EnfError error;
    int status = ENF_EXIT_FAILURE;
    if (!find_cells(&why)) {
        return ENF_EXIT_USAGE;
    }
    if (enf_portals_create(&why.portals, map, NULL, &error) == ENF_OK) {
        if (enf_vis_create(&why.vis, map, NULL, &error) == ENF_OK) {
            status = answer(&why);
            enf_vis_destroy(why.vis);
        } else {
            fprintf(stderr, "enfinfo: %s\n", error.message);
        }
        enf_portals_destroy(&why.portals);
    } else {
        fprintf(stderr, "enfinfo: %s\n", error.message);
    }
    free(why.steps);
    return status;
}
