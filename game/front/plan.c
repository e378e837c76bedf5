/* Makes the plan of a storey: every triangle of the level that stands upright, cut by a horizontal plane. */
#include "front/plan.h"

#include <math.h>

/* The cut goes this far above the floor, metres: over most furniture, under the tops of doorways. */
#define CUT_ABOVE_FLOOR 1.35
/* A storey is another one if its floor differs by more. */
#define SAME_STOREY 1.1

EnfResult plan_create(Plan *plan, const EnfMap *map, EnfError *error) {
    plan->map = map;
    plan->count = 0;
    plan->made = false;
    plan->walls = enf_alloc(NULL, PLAN_WALLS_MAX, sizeof *plan->walls);
    plan->bounds[0] = plan->bounds[1] = HUGE_VAL;
    plan->bounds[2] = plan->bounds[3] = -HUGE_VAL;
    for (uint32_t i = 0; i < map->cells_count; i++) {
        const EnfCell *cell = &map->cells[i];
        if (cell->flags & ENF_CELL_OUTSIDE) {
            continue;
        }
        plan->bounds[0] = fmin(plan->bounds[0], cell->origin[0] + (double)cell->min[0]);
        plan->bounds[1] = fmin(plan->bounds[1], cell->origin[2] + (double)cell->min[2]);
        plan->bounds[2] = fmax(plan->bounds[2], cell->origin[0] + (double)cell->max[0]);
        plan->bounds[3] = fmax(plan->bounds[3], cell->origin[2] + (double)cell->max[2]);
    }
    return plan->walls ? ENF_OK : enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for the plan");
}

void plan_destroy(Plan *plan) {
    enf_free(NULL, plan->walls, PLAN_WALLS_MAX, sizeof *plan->walls);
    plan->walls = NULL;
}

/* Where the plane y = 0 cuts an edge; p relative to it. */
static void crossing(const double a[3], const double b[3], float out[2]) {
    double t = a[1] / (a[1] - b[1]);
    out[0] = (float)(a[0] + (b[0] - a[0]) * t);
    out[1] = (float)(a[2] + (b[2] - a[2]) * t);
}

static void cut_triangle(Plan *plan, double p[3][3], uint32_t cell) {
    int found = 0;
    PlanWall wall = {{0.0f, 0.0f, 0.0f, 0.0f}, cell};
    for (int i = 0; i < 3 && found < 2; i++) {
        const double *a = p[i], *b = p[(i + 1) % 3];
        if ((a[1] < 0.0) != (b[1] < 0.0)) {
            crossing(a, b, &wall.ends[2 * found]);
            found++;
        }
    }
    double dx = (double)(wall.ends[2] - wall.ends[0]), dz = (double)(wall.ends[3] - wall.ends[1]);
    if (found == 2 && dx * dx + dz * dz > 0.1 * 0.1 && plan->count < PLAN_WALLS_MAX) {
        plan->walls[plan->count++] = wall;
    }
}

static void cut_cluster(Plan *plan, const EnfCluster *cluster) {
    const EnfMap *map = plan->map;
    const double *origin = map->cells[cluster->cell].origin;
    double low = origin[1] + (double)cluster->min[1], high = origin[1] + (double)cluster->max[1];
    const EnfMaterial *material = &map->materials[cluster->material];
    if (plan->height < low || plan->height > high || (material->flags & ENF_MATERIAL_NODRAW)) {
        return;
    }
    for (uint32_t i = 0; i + 2 < cluster->index_count; i += 3) {
        double p[3][3];
        for (int k = 0; k < 3; k++) {
            const float *at = map->vertices[map->indices[cluster->index_first + i + (uint32_t)k]].position;
            for (int axis = 0; axis < 3; axis++) {
                p[k][axis] = origin[axis] + (double)at[axis];
            }
            p[k][1] -= plan->height;
        }
        cut_triangle(plan, p, cluster->cell);
    }
}

void plan_cut(Plan *plan, double floor_ws) {
    double height = floor_ws + CUT_ABOVE_FLOOR;
    if (plan->made && fabs(height - plan->height) < SAME_STOREY) {
        return;
    }
    plan->made = true;
    plan->height = height;
    plan->count = 0;
    for (uint32_t i = 0; i < plan->map->clusters_count; i++) {
        cut_cluster(plan, &plan->map->clusters[i]);
    }
}

PlanView plan_fit(const Plan *plan, const double box[4]) {
    const double *b = plan->bounds;
    double by_x = box[2] / fmax(b[2] - b[0], 1.0), by_z = box[3] / fmax(b[3] - b[1], 1.0);
    PlanView view = {{box[0], box[1], box[2], box[3]}, fmin(by_x, by_z) * 0.96, {0.5 * (b[0] + b[2]), 0.5 * (b[1] + b[3])}};
    return view;
}

void plan_place(const PlanView *view, double x, double z, double out[2]) {
    out[0] = view->box[0] + 0.5 * view->box[2] + (x - view->at[0]) * view->per_metre;
    out[1] = view->box[1] + 0.5 * view->box[3] + (z - view->at[1]) * view->per_metre;
}

static bool inside(const double box[4], const double p[2]) {
    return p[0] >= box[0] && p[1] >= box[1] && p[0] <= box[0] + box[2] && p[1] <= box[1] + box[3];
}

void plan_draw(const Plan *plan, Canvas *canvas, const PlanView *view, const uint8_t *lit, const uint32_t colors[2]) {
    for (int pass = 0; pass < 2; pass++) { /* bright ones over the others */
        for (uint32_t i = 0; i < plan->count; i++) {
            const PlanWall *wall = &plan->walls[i];
            bool bright = !lit || lit[wall->cell];
            double ends[4];
            plan_place(view, (double)wall->ends[0], (double)wall->ends[1], ends);
            plan_place(view, (double)wall->ends[2], (double)wall->ends[3], ends + 2);
            if (bright == (pass == 1) && inside(view->box, ends) && inside(view->box, ends + 2)) {
                canvas_line(canvas, ends, bright ? 1.4 : 1.0, colors[bright]);
            }
        }
    }
}
