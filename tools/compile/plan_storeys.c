/* Storeys: cells sorted by floor height are cut at gaps; a group then joins the storey below if hardly any of its floor lies over
 * that storey's, as on terrain and split levels. */
#include "compile/plan_storeys.h"

#include "compile/exact.h"

#include <enfilade/tolerances.h>
#include <stdlib.h>
#include <string.h>

/* Floors whose heights (metres) part by more than this may belong to different storeys. */
#define GAP 1.5
/* Squares of the raster on which floors are compared, each way; and the part of a group's floor that may lie over another. */
enum { RASTER = 256 };
#define OVERLAP 0.04

typedef struct Floor {
    int64_t y;
    uint32_t cell;
} Floor;

typedef struct Raster {
    double min_x, min_z, step; /* metres */
    uint8_t group[RASTER][RASTER], below[RASTER][RASTER];
} Raster;

static int compare_floors(const void *left, const void *right) {
    const Floor *a = left, *b = right;
    if (a->y != b->y) {
        return a->y < b->y ? -1 : 1;
    }
    return (a->cell > b->cell) - (a->cell < b->cell);
}

bool enf_plan_faces_up(const EnfSoup *soup, uint32_t triangle) {
    const EnfSoupTriangle *t = &soup->triangles[triangle];
    EnfVec3 a = enf_grid_point(soup->vertices[t->v[0]].p);
    EnfVec3 n = enf_cross(enf_sub(enf_grid_point(soup->vertices[t->v[1]].p), a),
                          enf_sub(enf_grid_point(soup->vertices[t->v[2]].p), a));
    return n.y > 0.3 * enf_length(n);
}

/* ---- the raster ------------------------------------------------------------------------------------------------- */

static int clamp_square(double position) {
    return position < 0 ? 0 : position > RASTER - 1 ? RASTER - 1 : (int)position;
}

static double side(EnfVec3 a, EnfVec3 b, double x, double z) {
    return (b.z - a.z) * (x - a.x) - (b.x - a.x) * (z - a.z);
}

/* Marks the squares whose middle the triangle covers, seen from above. */
static void mark_triangle(Raster *raster, const EnfSoup *soup, const EnfSoupTriangle *t) {
    EnfVec3 a = enf_grid_point(soup->vertices[t->v[0]].p), b = enf_grid_point(soup->vertices[t->v[1]].p);
    EnfVec3 c = enf_grid_point(soup->vertices[t->v[2]].p);
    EnfBox3 box = enf_box3_add(enf_box3_add(enf_box3_add(enf_box3_empty(), a), b), c);
    int x0 = clamp_square((box.min.x - raster->min_x) / raster->step);
    int x1 = clamp_square((box.max.x - raster->min_x) / raster->step);
    int z0 = clamp_square((box.min.z - raster->min_z) / raster->step);
    int z1 = clamp_square((box.max.z - raster->min_z) / raster->step);
    for (int row = z0; row <= z1; row++) {
        for (int column = x0; column <= x1; column++) {
            double x = raster->min_x + (column + 0.5) * raster->step, z = raster->min_z + (row + 0.5) * raster->step;
            if (side(a, b, x, z) >= 0 && side(b, c, x, z) >= 0 && side(c, a, x, z) >= 0) {
                raster->group[row][column] = 1;
            }
        }
    }
}

static void mark_cell(Raster *raster, const EnfPlanCells *cells, uint32_t cell) {
    for (uint32_t i = cells->first[cell]; i < cells->first[cell + 1]; i++) {
        if (enf_plan_faces_up(cells->soup, cells->triangles[i])) {
            mark_triangle(raster, cells->soup, &cells->soup->triangles[cells->triangles[i]]);
        }
    }
}

/* Adds the group to the storey below, or begins a new one with it: true if new. */
static bool settle_group(Raster *raster) {
    const uint8_t *group = &raster->group[0][0];
    uint8_t *below = &raster->below[0][0];
    uint32_t own = 0, over = 0;
    for (uint32_t i = 0; i < RASTER * RASTER; i++) {
        own += group[i];
        over += group[i] & below[i];
    }
    bool is_new = (double)over > OVERLAP * (double)own;
    for (uint32_t i = 0; i < RASTER * RASTER; i++) {
        below[i] = (uint8_t)(group[i] | (is_new ? 0 : below[i]));
    }
    memset(raster->group, 0, sizeof raster->group);
    return is_new;
}

/* ---- storeys ---------------------------------------------------------------------------------------------------- */

static uint32_t sort_floors(const EnfLayout *layout, Floor *floors, Raster *raster) {
    uint32_t count = 0;
    EnfBox3 all = enf_box3_empty();
    for (uint32_t i = 0; i < layout->cell_count; i++) {
        if (!(layout->cells[i].flags & ENF_CELL_OUTSIDE)) {
            floors[count++] = (Floor){layout->cells[i].min.y, i};
            all = enf_box3_add(all, enf_grid_point(layout->cells[i].min));
            all = enf_box3_add(all, enf_grid_point(layout->cells[i].max));
        }
    }
    qsort(floors, count, sizeof *floors, compare_floors);
    double width = all.max.x - all.min.x, depth = all.max.z - all.min.z, largest = width > depth ? width : depth;
    raster->min_x = all.min.x;
    raster->min_z = all.min.z;
    raster->step = (largest > 1 ? largest : 1) / RASTER;
    return count;
}

bool enf_plan_storeys(const EnfPlanCells *cells, uint32_t *storey, uint32_t *count) {
    Floor *floors = malloc(((size_t)cells->layout->cell_count + 1) * sizeof *floors);
    Raster *raster = calloc(1, sizeof *raster);
    bool ok = floors && raster;
    uint32_t floor_count = ok ? sort_floors(cells->layout, floors, raster) : 0, storeys = 0;
    for (uint32_t first = 0, end; first < floor_count; first = end) {
        for (end = first; end < floor_count; end++) {
            bool gap = end > first && (double)(floors[end].y - floors[end - 1].y) * ENF_GRID_STEP > GAP;
            if (gap) {
                break;
            }
            mark_cell(raster, cells, floors[end].cell);
        }
        storeys += settle_group(raster) || storeys == 0;
        for (uint32_t i = first; i < end; i++) {
            storey[floors[i].cell] = storeys - 1;
        }
    }
    free(floors);
    free(raster);
    *count = storeys;
    return ok;
}
