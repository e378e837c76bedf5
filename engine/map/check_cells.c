/* Cells, the portals between them, and the transforms that portals carry. */
#include "map/map_internal.h"
#include <enfilade/tolerances.h>

#include <math.h>

/* The compiler's grid ends at 2^40 steps of 2^-12 m. */
#define ORIGIN_MAX 0x1p28

/* ---- cells ------------------------------------------------------------------------------------------------------ */

static EnfResult check_cell(const EnfMapCheck *check, uint32_t i) {
    const EnfCell *cell = &check->map->cells[i];
    for (int axis = 0; axis < 3; axis++) {
        double steps = cell->origin[axis] / ENF_ORIGIN_STEP; /* a power of two: exact */
        if (steps != floor(steps) || fabs(cell->origin[axis]) > ORIGIN_MAX) {
            return ENF_MAP_BAD(check, cells, i, origin[axis], ENF_ERROR_RANGE, "%.17g is not on the grid of origins",
                               cell->origin[axis]);
        }
        if (cell->min[axis] > cell->max[axis]) {
            return ENF_MAP_BAD(check, cells, i, min[axis], ENF_ERROR_RANGE, "%g is above max %g", (double)cell->min[axis],
                               (double)cell->max[axis]);
        }
    }
    for (uint32_t p = cell->portal_first; p < cell->portal_first + cell->portal_count; p++) {
        if (check->map->portals[p].source != i) {
            return ENF_MAP_BAD(check, cells, i, portal_first, ENF_ERROR_INDEX, "portal %u does not leave this cell", p);
        }
    }
    for (uint32_t c = cell->cluster_first; c < cell->cluster_first + cell->cluster_count; c++) {
        if (check->map->clusters[c].cell != i) {
            return ENF_MAP_BAD(check, cells, i, cluster_first, ENF_ERROR_INDEX, "cluster %u is not at home here", c);
        }
    }
    for (uint32_t b = cell->bound_first; b < cell->bound_first + cell->bound_count; b++) {
        const float *n = check->map->bound_planes[b].n;
        if (n[0] == 0.0f && n[1] == 0.0f && n[2] == 0.0f) {
            return ENF_MAP_BAD(check, bound_planes, b, n, ENF_ERROR_RANGE, "is zero");
        }
    }
    return ENF_OK;
}

/* With each member of a range naming its cell, full counts mean that the ranges are disjoint and nothing is left over. */
static EnfResult check_cell_sums(const EnfMapCheck *check) {
    const EnfMap *map = check->map;
    uint64_t portals = 0, clusters = 0, nodes = 0, blocks = 0, outside = 0;
    for (uint32_t i = 0; i < map->cells_count; i++) {
        portals += map->cells[i].portal_count;
        clusters += map->cells[i].cluster_count;
        nodes += map->cells[i].node_count;
        blocks += map->cells[i].block_count;
        outside += map->cells[i].flags & ENF_CELL_OUTSIDE;
    }
    const char *wrong = portals != map->portals_count     ? "portals"
                        : clusters != map->clusters_count ? "clusters"
                        : nodes != map->kd_nodes_count    ? "kd_nodes"
                        : blocks != map->kd_blocks_count  ? "kd_blocks"
                                                          : NULL;
    if (wrong) {
        return enf_error_set(check->error, ENF_ERROR_FORMAT, check->offsets[ENF_CHUNK_cells],
                             "chunk CELL: cells: their ranges do not add up to all %s", wrong);
    }
    if (outside > 1) {
        return enf_error_set(check->error, ENF_ERROR_FORMAT, check->offsets[ENF_CHUNK_cells],
                             "chunk CELL: cells: flags: %llu cells are the outside", (unsigned long long)outside);
    }
    return ENF_OK;
}

/* ---- transforms ------------------------------------------------------------------------------------------------- */

/* Columns are unit and orthogonal: mᵀm = 1 within ENF_TOL_RIGID. */
static EnfResult check_transform(const EnfMapCheck *check, uint32_t i) {
    const EnfTransform *transform = &check->map->transforms[i];
    for (int a = 0; a < 3; a++) {
        for (int b = a; b < 3; b++) {
            const double *u = transform->m + 3 * a, *v = transform->m + 3 * b;
            double dot = u[0] * v[0] + u[1] * v[1] + u[2] * v[2] - (a == b ? 1.0 : 0.0);
            if (!(fabs(dot) <= ENF_TOL_RIGID)) {
                return ENF_MAP_BAD(check, transforms, i, m, ENF_ERROR_RANGE, "columns %d and %d are off by %g from orthonormal",
                                   a, b, dot);
            }
        }
    }
    for (int axis = 0; axis < 3; axis++) {
        if (fabs(transform->t[axis]) > 2.0 * ORIGIN_MAX) {
            return ENF_MAP_BAD(check, transforms, i, t, ENF_ERROR_RANGE, "%g leaves the world", transform->t[axis]);
        }
    }
    return ENF_OK;
}

static bool reflects(const EnfTransform *transform) {
    EnfAffine a;
    for (int i = 0; i < 9; i++) {
        a.m[i] = transform->m[i];
    }
    a.t = enf_v3(transform->t[0], transform->t[1], transform->t[2]);
    return enf_affine_det(&a) < 0.0;
}

/* ---- portals ---------------------------------------------------------------------------------------------------- */

static EnfResult check_twin(const EnfMapCheck *check, uint32_t i) {
    const EnfMap *map = check->map;
    const EnfPortal *portal = &map->portals[i];
    if (portal->twin == ENF_NONE) {
        return ENF_OK;
    }
    const EnfPortal *twin = &map->portals[portal->twin];
    if (portal->twin == i && !(portal->flags & ENF_PORTAL_MIRROR)) {
        return ENF_MAP_BAD(check, portals, i, twin, ENF_ERROR_INDEX, "is the portal itself");
    }
    if (twin->twin != i) {
        return ENF_MAP_BAD(check, portals, i, twin, ENF_ERROR_INDEX, "%u names another twin, %u", portal->twin, twin->twin);
    }
    if (twin->source != portal->target || twin->target != portal->source) {
        return ENF_MAP_BAD(check, portals, i, twin, ENF_ERROR_INDEX, "%u does not lead back", portal->twin);
    }
    if ((twin->transform == ENF_NONE) != (portal->transform == ENF_NONE)) {
        return ENF_MAP_BAD(check, portals, i, twin, ENF_ERROR_FORMAT, "%u: only one of the two has a transform", portal->twin);
    }
    return ENF_OK;
}

static EnfResult check_portal(const EnfMapCheck *check, uint32_t i) {
    const EnfMap *map = check->map;
    const EnfPortal *portal = &map->portals[i];
    const bool overlap = portal->flags & ENF_PORTAL_OVERLAP;
    if (overlap ? portal->vertex_count != 0 : (portal->vertex_count < 3 || portal->vertex_count > ENF_POLYGON_MAX)) {
        return ENF_MAP_BAD(check, portals, i, vertex_count, ENF_ERROR_RANGE, "%u is not %s", portal->vertex_count,
                           overlap ? "0, as for an overlap" : "in 3..32");
    }
    if (overlap && portal->transform != ENF_NONE) {
        return ENF_MAP_BAD(check, portals, i, transform, ENF_ERROR_FORMAT, "an overlap has none");
    }
    if (portal->source == portal->target && portal->transform == ENF_NONE) {
        return ENF_MAP_BAD(check, portals, i, target, ENF_ERROR_INDEX, "%u is the source", portal->target);
    }
    bool mirror = portal->transform != ENF_NONE && reflects(&map->transforms[portal->transform]);
    if (mirror != ((portal->flags & ENF_PORTAL_MIRROR) != 0)) {
        return ENF_MAP_BAD(check, portals, i, flags, ENF_ERROR_FORMAT, "MIRROR, but its transform %s",
                           mirror ? "reflects (the flag is missing)" : "does not reflect");
    }
    if (map->cells[portal->source].portal_first > i ||
        i - map->cells[portal->source].portal_first >= map->cells[portal->source].portal_count) {
        return ENF_MAP_BAD(check, portals, i, source, ENF_ERROR_INDEX, "%u does not list this portal", portal->source);
    }
    return check_twin(check, i);
}

EnfResult enf_map_check_cells(const EnfMapCheck *check) {
    EnfResult result = ENF_OK;
    for (uint32_t i = 0; result == ENF_OK && i < check->map->cells_count; i++) {
        result = check_cell(check, i);
    }
    for (uint32_t i = 0; result == ENF_OK && i < check->map->transforms_count; i++) {
        result = check_transform(check, i);
    }
    for (uint32_t i = 0; result == ENF_OK && i < check->map->portals_count; i++) {
        result = check_portal(check, i);
    }
    return result ? result : check_cell_sums(check);
}
