/* Reach: in which cells, beside its own, a set of triangles can be seen without looking through a portal (PITFALLS 9, 10, 14).
 *
 * It reaches through a portal if it crosses the portal's polygon, or lies in it like a shut door; and from there through the next. It
 * reaches through a wall if a corner lies inside another cell's shell, or if one who stands just in front of it does (behind it too,
 * where it is two-sided): so a floor that runs on under a door is found, and two rooms that share a wall without thickness are not
 * disturbed. Boxes and slabs reject nearly every pair before a ray is cast. */
#include "compile/regions.h"

#include <enfilade/geom.h>
#include <enfilade/tolerances.h>

/* Depth (metres) at which a point is inside and no longer on the surface: two grid steps, as a snapped point and a snapped plane may
 * each be off by one. */
#define SURFACE (2.0 * ENF_GRID_STEP)
/* Metres in front of a surface at which one looks where it is: far above SURFACE, far below any room. */
static const double IN_FRONT = 1.0 / 64.0;
/* Large triangles are looked at piece by piece: pieces of this size (metres), halved at most so often. */
static const double PIECE = 0.75;
enum { HALVINGS = 6, POINTS_MAX = 512 };

typedef struct Gate {
    EnfVec3 normal;
    double d;
    EnfBox3 box;
    bool walkable; /* a polygon without a transform */
} Gate;

struct EnfReach {
    EnfSpace space;
    Gate *gates;
    uint32_t *cells; /* scratch: a queue, and what the tree found */
    uint32_t *near;
    uint32_t *stamp; /* by cell: the query that listed it last */
    uint32_t query;
};

typedef struct Query {
    EnfReach *reach;
    const uint32_t *triangles;
    uint32_t count;
    EnfBox3 box;
} Query;

EnfReach *enf_reach_create(const EnfLayout *layout, const struct EnfSoup *soup) {
    EnfReach *reach = calloc(1, sizeof *reach);
    if (reach == NULL || !enf_space_create(&reach->space, layout, soup)) {
        free(reach);
        return NULL;
    }
    size_t cells = (size_t)layout->cell_count + 1;
    reach->gates = calloc((size_t)layout->portal_count + 1, sizeof *reach->gates);
    reach->cells = calloc(cells, sizeof *reach->cells);
    reach->near = calloc(cells, sizeof *reach->near);
    reach->stamp = calloc(cells, sizeof *reach->stamp);
    if (!reach->gates || !reach->cells || !reach->near || !reach->stamp) {
        enf_reach_destroy(reach);
        return NULL;
    }
    for (uint32_t p = 0; p < layout->portal_count; p++) {
        const EnfLayoutPortal *portal = &layout->portals[p];
        EnfVec3 points[ENF_POLYGON_MAX];
        Gate *gate = &reach->gates[p];
        gate->box = enf_box3_empty();
        for (uint32_t i = 0; i < portal->point_count; i++) {
            points[i] = enf_grid_point(layout->points[portal->point_first + i]);
            gate->box = enf_box3_add(gate->box, points[i]);
        }
        gate->walkable = portal->point_count >= 3 && !portal->has_transform;
        if (gate->walkable) {
            EnfPlane plane = enf_plane_from_polygon(points, portal->point_count);
            gate->normal = plane.n;
            gate->d = plane.d;
        }
    }
    return reach;
}

void enf_reach_destroy(EnfReach *reach) {
    if (reach != NULL) {
        enf_space_free(&reach->space);
        free(reach->gates);
        free(reach->cells);
        free(reach->near);
        free(reach->stamp);
        free(reach);
    }
}

/* ---- through portals ------------------------------------------------------------------------------------------------------- */

/* Sutherland & Hodgman 1974: the part of a polygon with n·p ≤ d. */
static uint32_t clip(const EnfVec3 *in, uint32_t count, EnfVec3 n, double d, EnfVec3 *out) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        EnfVec3 a = in[i], b = in[(i + 1) % count];
        double da = enf_dot(n, a) - d, db = enf_dot(n, b) - d;
        if (da <= 0.0) {
            out[kept++] = a;
        }
        if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) {
            out[kept++] = enf_add(a, enf_scale(enf_sub(b, a), da / (da - db)));
        }
    }
    return kept;
}

/* The part of a triangle over the portal's polygon, whose edges are moved outward by `grow`. */
static uint32_t clip_to_gate(const EnfReach *reach, uint32_t p, const EnfVec3 triangle[3], double grow, EnfVec3 *out) {
    const EnfLayout *layout = reach->space.layout;
    const EnfLayoutPortal *portal = &layout->portals[p];
    EnfVec3 other[ENF_CLIP_MAX];
    uint32_t count = 3;
    memcpy(out, triangle, 3 * sizeof *out);
    for (uint32_t i = 0; i < portal->point_count && count > 0; i++) {
        EnfVec3 a = enf_grid_point(layout->points[portal->point_first + i]);
        EnfVec3 b = enf_grid_point(layout->points[portal->point_first + (i + 1) % portal->point_count]);
        EnfVec3 outward = enf_normalize(enf_cross(enf_sub(b, a), reach->gates[p].normal));
        count = clip(out, count, outward, enf_dot(outward, a) + grow, other);
        memcpy(out, other, count * sizeof *out);
    }
    return count;
}

/* What is left of a triangle over the gate: does it lie on both sides, and how long is the cut in the gate's plane? */
static bool is_cut(const Gate *gate, const EnfVec3 *part, uint32_t count, double *length) {
    bool behind = false, ahead = false;
    EnfVec3 ends[ENF_CLIP_MAX];
    uint32_t end_count = 0;
    *length = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        EnfVec3 a = part[i], b = part[(i + 1) % count];
        double da = enf_dot(gate->normal, a) + gate->d, db = enf_dot(gate->normal, b) + gate->d;
        behind = behind || da < -SURFACE;
        ahead = ahead || da > SURFACE;
        if ((da <= 0.0) != (db <= 0.0)) {
            ends[end_count++] = enf_add(a, enf_scale(enf_sub(b, a), da / (da - db)));
        }
    }
    if (end_count == 2) {
        *length = enf_length(enf_sub(ends[1], ends[0]));
    }
    return behind && ahead;
}

/* A triangle passes if it straddles the plane within the polygon, or runs through it along the rim (a floor under a door; a touched
 * corner is not enough), or lies flat in the opening like a shut door (the wall around it only touches the rim). */
static bool triangle_passes(const EnfReach *reach, uint32_t p, const EnfVec3 triangle[3]) {
    const Gate *gate = &reach->gates[p];
    EnfVec3 part[ENF_CLIP_MAX];
    double low = 1e300, high = -1e300, length;
    for (int k = 0; k < 3; k++) {
        double d = enf_dot(gate->normal, triangle[k]) + gate->d;
        low = d < low ? d : low;
        high = d > high ? d : high;
    }
    bool flat = low >= -SURFACE && high <= SURFACE;
    if (!flat && (low >= -SURFACE || high <= SURFACE)) {
        return false;
    }
    uint32_t count = clip_to_gate(reach, p, triangle, -SURFACE, part);
    if (flat || is_cut(gate, part, count, &length)) {
        return count >= 3;
    }
    count = clip_to_gate(reach, p, triangle, SURFACE, part);
    return is_cut(gate, part, count, &length) && length > 4.0 * SURFACE;
}

static EnfBox3 grown(EnfBox3 box, double by) {
    EnfVec3 margin = enf_v3(by, by, by);
    return (EnfBox3){enf_sub(box.min, margin), enf_add(box.max, margin)};
}

static bool passes(const Query *query, uint32_t p) {
    const EnfReach *reach = query->reach;
    EnfBox3 gate = grown(reach->gates[p].box, SURFACE);
    if (!reach->gates[p].walkable || !enf_box3_overlaps(query->box, gate)) {
        return false;
    }
    for (uint32_t i = 0; i < query->count; i++) {
        EnfVec3 corners[3];
        EnfBox3 box = enf_box3_empty();
        enf_soup_corners(reach->space.soup, query->triangles[i], corners);
        for (int k = 0; k < 3; k++) {
            box = enf_box3_add(box, corners[k]);
        }
        if (enf_box3_overlaps(box, gate) && triangle_passes(reach, p, corners)) {
            return true;
        }
    }
    return false;
}

/* ---- through walls --------------------------------------------------------------------------------------------------------- */

typedef struct Surface {
    EnfVec3 normal;
    bool both; /* seen from behind too, or by nobody knows whom */
} Surface;

/* Does one who stands just in front of p see it from inside the cell? The triangle itself hides what is behind it, so only rays away
 * from it vote. */
static bool seen_from(EnfShells *shells, uint32_t cell, EnfVec3 p, EnfVec3 normal) {
    EnfVec3 eye = enf_add(p, enf_scale(normal, IN_FRONT));
    return enf_shell_near(&shells->cells[cell], &eye, 1, SURFACE) && enf_shell_open_to(shells, cell, eye, normal);
}

/* Looks at a triangle piece by piece, leaving out pieces that are not near the cell. */
static bool piece_in_cell(EnfShells *shells, uint32_t cell, const EnfVec3 p[3], const Surface *surface, int halvings) {
    EnfVec3 around[6];
    for (int k = 0; k < 3; k++) {
        around[2 * k] = enf_add(p[k], enf_scale(surface->normal, IN_FRONT));
        around[2 * k + 1] = surface->both ? enf_sub(p[k], enf_scale(surface->normal, IN_FRONT)) : p[k];
    }
    if (!enf_shell_near(&shells->cells[cell], around, 6, SURFACE)) {
        return false;
    }
    EnfVec3 ab = enf_scale(enf_add(p[0], p[1]), 0.5), bc = enf_scale(enf_add(p[1], p[2]), 0.5);
    EnfVec3 ca = enf_scale(enf_add(p[2], p[0]), 0.5);
    double size = enf_length(enf_sub(p[1], p[0])) + enf_length(enf_sub(p[2], p[1])) + enf_length(enf_sub(p[0], p[2]));
    if (size > 3.0 * PIECE && halvings > 0) {
        const EnfVec3 parts[4][3] = {{p[0], ab, ca}, {ab, p[1], bc}, {ca, bc, p[2]}, {ab, bc, ca}};
        for (int i = 0; i < 4; i++) {
            if (piece_in_cell(shells, cell, parts[i], surface, halvings - 1)) {
                return true;
            }
        }
        return false;
    }
    EnfVec3 centre = enf_scale(enf_add(p[0], enf_add(p[1], p[2])), 1.0 / 3.0);
    return seen_from(shells, cell, centre, surface->normal) ||
           (surface->both && seen_from(shells, cell, centre, enf_scale(surface->normal, -1.0)));
}

static bool triangle_in_cell(const Query *query, uint32_t cell, uint32_t triangle) {
    EnfSpace *space = &query->reach->space;
    EnfVec3 p[3];
    enf_soup_corners(space->soup, triangle, p);
    const EnfSoupTriangle *record = &space->soup->triangles[triangle];
    Surface surface = {enf_normalize(enf_cross(enf_sub(p[1], p[0]), enf_sub(p[2], p[0]))), false};
    surface.both = (space->faces[record->material] & ENF_FACE_TWO_SIDED) || space->layout->node_cells[record->node] == ENF_NONE;
    EnfVec3 all[6];
    for (int k = 0; k < 3; k++) {
        all[k] = p[k];
        all[3 + k] = enf_add(p[k], enf_scale(surface.normal, surface.both ? -IN_FRONT : IN_FRONT));
    }
    if (!enf_shell_near(&space->shells.cells[cell], all, 6, SURFACE)) {
        return false;
    }
    for (int k = 0; k < 3; k++) {
        if (enf_shell_inside(&space->shells, cell, p[k], SURFACE, false)) {
            return true;
        }
    }
    return piece_in_cell(&space->shells, cell, p, &surface, HALVINGS);
}

/* The cheap test for the whole set first: most sets end at the walls that they share with the cell. */
static bool set_in_cell(const Query *query, uint32_t cell) {
    EnfSpace *space = &query->reach->space;
    EnfVec3 points[POINTS_MAX];
    uint32_t used = 0;
    bool near = false;
    for (uint32_t i = 0; i < query->count && !near; i++) {
        enf_soup_corners(space->soup, query->triangles[i], &points[used]);
        used += 3;
        if (used + 3 > POINTS_MAX || i + 1 == query->count) {
            /* Less than the distance at which surfaces are looked at: a wall shared by two rooms is near both. */
            near = enf_shell_near(&space->shells.cells[cell], points, used, -IN_FRONT);
            used = 0;
        }
    }
    for (uint32_t i = 0; near && i < query->count; i++) {
        if (triangle_in_cell(query, cell, query->triangles[i])) {
            return true;
        }
    }
    return false;
}

/* ---- queries --------------------------------------------------------------------------------------------------------------- */

static bool list(EnfReach *reach, uint32_t cell, uint32_t *count) {
    if (cell >= reach->space.cell_count || reach->stamp[cell] == reach->query) {
        return false;
    }
    reach->stamp[cell] = reach->query;
    reach->cells[(*count)++] = cell;
    return true;
}

static int compare_u32(const void *pa, const void *pb) {
    const uint32_t *a = pa, *b = pb;
    return (*a > *b) - (*a < *b);
}

uint32_t enf_reach_query(const EnfReach *constant, const uint32_t *triangles, uint32_t triangle_count, uint32_t cell,
                         uint32_t *out, uint32_t capacity) {
    EnfReach *reach = (EnfReach *)(uintptr_t)constant; /* its scratch, and trees made when needed: one thread at a time */
    Query query = {reach, triangles, triangle_count, enf_box3_empty()};
    uint32_t count = 0;
    for (uint32_t i = 0; i < triangle_count; i++) {
        EnfVec3 p[3];
        enf_soup_corners(reach->space.soup, triangles[i], p);
        query.box = enf_box3_add(enf_box3_add(enf_box3_add(query.box, p[0]), p[1]), p[2]);
    }
    reach->query++;
    list(reach, cell, &count);
    EnfKdTree tree = enf_kd_tree(&reach->space.tree);
    uint32_t near = enf_kd_overlap(&tree, enf_box3f_outward(query.box), reach->near, reach->space.cell_count);
    for (uint32_t i = 0; i < near; i++) {
        if (reach->stamp[reach->near[i]] != reach->query && set_in_cell(&query, reach->near[i])) {
            list(reach, reach->near[i], &count);
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t from = reach->cells[i];
        for (uint32_t p = reach->space.portal_first[from]; p < reach->space.portal_first[from + 1]; p++) {
            uint32_t target = reach->space.layout->portals[p].target;
            if (target < reach->space.cell_count && reach->stamp[target] != reach->query && passes(&query, p)) {
                list(reach, target, &count);
            }
        }
    }
    uint32_t first = count > 0 && reach->cells[0] == cell ? 1 : 0; /* home is not reached, it is home */
    qsort(&reach->cells[first], count - first, sizeof *reach->cells, compare_u32);
    uint32_t given = count - first < capacity ? count - first : capacity;
    memcpy(out, &reach->cells[first], given * sizeof *out);
    return given;
}
