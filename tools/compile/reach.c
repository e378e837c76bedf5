/* Reach: in which cells, beside its own, a set of triangles can be seen without looking through a portal (PITFALLS 9, 10, 14).
 *
 * It reaches through a portal if it crosses the portal's polygon, or lies in it like a shut door; and from there through the next. It
 * reaches through a wall if a corner lies inside another cell's shell, or if one who stands just in front of it does (behind it too,
 * where it is two-sided): so a floor that runs on under a door is found. And it touches a cell from behind a wall without thickness
 * if an edge lies on that wall and the surface faces who stands beyond it: along such an edge (the foot of the wall, to the floor
 * of the next room) depths are equal, and rounding alone would decide what a pixel shows (PITFALLS 33). Boxes and slabs reject nearly
 * every pair before a ray is cast. */
#include "compile/regions.h"

#include <enfilade/geom.h>
#include <enfilade/tolerances.h>

/* Depth (metres) at which a point is inside and no longer on the surface: two grid steps, as a snapped point and a snapped plane may
 * each be off by one. */
#define SURFACE (2.0 * ENF_GRID_STEP)
/* Metres in front of a surface at which one looks where it is: far above SURFACE, far below any room. */
static const double IN_FRONT = 1.0 / 64.0;
/* Metres inside another room from which an author did not mean it: more than modelling to the centimetre. */
static const double DEEP = 0.03;
/* Large triangles are looked at piece by piece: pieces of this size (metres), halved at most so often. */
static const double PIECE = 1.25;
enum { HALVINGS = 6, CANDIDATES = 32 };

typedef struct Gate {
    EnfVec3 normal;
    double d;
    EnfBox3 box;
    bool walkable; /* a polygon without a transform */
} Gate;

/* One triangle of a query. */
typedef struct Sheet {
    EnfVec3 p[3], normal;
    EnfBox3 box; /* of its corners */
    uint32_t home, node;
    bool both;  /* seen from behind too, or by nobody knows whom */
    bool loose; /* belongs to no room by its author's word, so its home has no claim on it */
} Sheet;

/* A node deep inside a room that is not its own. */
typedef struct Crossing {
    uint32_t node, cell;
} Crossing;

struct EnfReach {
    EnfSpace space;
    Gate *gates;
    uint32_t *cells; /* scratch: a queue, and what the tree found */
    uint32_t *near;
    uint32_t *stamp; /* by cell: the query that listed it last */
    ENF_ARRAY(Sheet) sheets;
    ENF_ARRAY(EnfVec3) points;
    ENF_ARRAY(Crossing) crossings;
    uint32_t query;
};

typedef struct Query {
    EnfReach *reach;
    const Sheet *sheets;
    uint32_t count;
    EnfBox3 box, eyes; /* of the corners; of the points from which the surfaces are seen as well */
    uint32_t listed;   /* how many of reach->cells */
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
        free(reach->sheets.data);
        free(reach->points.data);
        free(reach->crossings.data);
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
        if (enf_box3_overlaps(query->sheets[i].box, gate) && triangle_passes(reach, p, query->sheets[i].p)) {
            return true;
        }
    }
    return false;
}

/* ---- through walls --------------------------------------------------------------------------------------------------------- */

static bool list(EnfReach *reach, uint32_t cell, uint32_t *count) {
    if (cell >= reach->space.cell_count || reach->stamp[cell] == reach->query) {
        return false;
    }
    reach->stamp[cell] = reach->query;
    reach->cells[(*count)++] = cell;
    return true;
}

static bool is_listed(const EnfReach *reach, uint32_t cell) {
    return reach->stamp[cell] == reach->query;
}

/* Does one who stands just in front of p see it from inside the cell? The triangle itself hides what is behind it, so only rays away
 * from it vote. */
static bool seen_from(EnfShells *shells, uint32_t cell, EnfVec3 p, EnfVec3 normal) {
    EnfVec3 eye = enf_add(p, enf_scale(normal, IN_FRONT));
    return enf_shell_near(&shells->cells[cell], &eye, 1, SURFACE) && enf_shell_open_to(shells, cell, eye, normal);
}

/* Looks at one side of a small piece. Whoever stands there in its own room is in no other: where rooms overlap, a link shows the one
 * with the other anyway. */
static void look(Query *query, const Sheet *sheet, EnfVec3 centre, EnfVec3 normal, const uint32_t *cells, uint32_t count) {
    EnfReach *reach = query->reach;
    EnfShells *shells = &reach->space.shells;
    if (!sheet->loose && sheet->home < reach->space.cell_count && seen_from(shells, sheet->home, centre, normal)) {
        return;
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!is_listed(reach, cells[i]) && seen_from(shells, cells[i], centre, normal)) {
            list(reach, cells[i], &query->listed);
        }
    }
}

/* Which of the cells come near a triangle, or near its front? */
static uint32_t keep_near(const Query *query, const Sheet *sheet, const EnfVec3 p[3], const uint32_t *cells, uint32_t count,
                          uint32_t *out) {
    const EnfReach *reach = query->reach;
    EnfVec3 around[6];
    uint32_t kept = 0;
    for (int k = 0; k < 3; k++) {
        EnfVec3 step = enf_scale(sheet->normal, IN_FRONT);
        around[2 * k] = enf_add(p[k], step);
        around[2 * k + 1] = sheet->both ? enf_sub(p[k], step) : p[k];
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!is_listed(reach, cells[i]) && enf_shell_near(&reach->space.shells.cells[cells[i]], around, 6, SURFACE)) {
            out[kept++] = cells[i];
        }
    }
    return kept;
}

/* A cell without a surface near a piece holds the whole of it or nothing: one look settles that. Keeps the other cells. */
static uint32_t settle_uniform(Query *query, const Sheet *sheet, const EnfVec3 p[3], uint32_t *cells, uint32_t count) {
    EnfReach *reach = query->reach;
    EnfShells *shells = &reach->space.shells;
    EnfVec3 centre = enf_scale(enf_add(p[0], enf_add(p[1], p[2])), 1.0 / 3.0);
    EnfBox3 box = grown(enf_box3_add(enf_box3_add(enf_box3_add(enf_box3_empty(), p[0]), p[1]), p[2]), 2.0 * IN_FRONT);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (enf_shell_touches(shells, cells[i], box)) {
            cells[kept++] = cells[i];
        } else if (seen_from(shells, cells[i], centre, sheet->normal) ||
                   (sheet->both && seen_from(shells, cells[i], centre, enf_scale(sheet->normal, -1.0)))) {
            list(reach, cells[i], &query->listed);
        }
    }
    return kept;
}

/* Looks at a triangle piece by piece. */
static void look_at_pieces(Query *query, const Sheet *sheet, const EnfVec3 p[3], const uint32_t *cells, uint32_t count,
                           int halvings) {
    uint32_t near[CANDIDATES];
    uint32_t near_count = keep_near(query, sheet, p, cells, count, near);
    near_count = settle_uniform(query, sheet, p, near, near_count);
    if (near_count == 0) {
        return;
    }
    EnfVec3 ab = enf_scale(enf_add(p[0], p[1]), 0.5), bc = enf_scale(enf_add(p[1], p[2]), 0.5);
    EnfVec3 ca = enf_scale(enf_add(p[2], p[0]), 0.5);
    double size = enf_length(enf_sub(p[1], p[0])) + enf_length(enf_sub(p[2], p[1])) + enf_length(enf_sub(p[0], p[2]));
    if (size > 3.0 * PIECE && halvings > 0) {
        const EnfVec3 parts[4][3] = {{p[0], ab, ca}, {ab, p[1], bc}, {ca, bc, p[2]}, {ab, bc, ca}};
        for (int i = 0; i < 4; i++) {
            look_at_pieces(query, sheet, parts[i], near, near_count, halvings - 1);
        }
        return;
    }
    EnfVec3 centre = enf_scale(enf_add(p[0], enf_add(p[1], p[2])), 1.0 / 3.0);
    look(query, sheet, centre, sheet->normal, near, near_count);
    if (sheet->both) {
        look(query, sheet, centre, enf_scale(sheet->normal, -1.0), near, near_count);
    }
}

/* Remembers a node of another room that stands in the cell, for the report; loose ones are nobody's fault. */
static void note_crossing(EnfReach *reach, const Sheet *sheet, uint32_t cell, EnfVec3 p) {
    bool deep = !sheet->loose && enf_shell_inside(&reach->space.shells, cell, p, DEEP, true);
    if (deep && ENF_ARRAY_ROOM(&reach->crossings, 1)) {
        reach->crossings.data[reach->crossings.count++] = (Crossing){sheet->node, cell};
    }
}

/* Lists the cells, of at most CANDIDATES, that a triangle reaches into. */
static void look_at_triangle(Query *query, const Sheet *sheet, const uint32_t *cells, uint32_t count) {
    EnfSpace *space = &query->reach->space;
    uint32_t near[CANDIDATES];
    uint32_t near_count = keep_near(query, sheet, sheet->p, cells, count, near);
    for (uint32_t i = 0; i < near_count; i++) {
        for (int k = 0; k < 3 && !is_listed(query->reach, near[i]); k++) {
            if (enf_shell_inside(&space->shells, near[i], sheet->p[k], SURFACE, false)) {
                list(query->reach, near[i], &query->listed);
                note_crossing(query->reach, sheet, near[i], sheet->p[k]);
            }
        }
    }
    if (near_count > 0) {
        look_at_pieces(query, sheet, sheet->p, near, near_count, HALVINGS);
    }
}

/* Most sets end at the walls that they share with the other cell: the box, with the points from which they are seen, tells. */
static void reach_through_walls(Query *query) {
    EnfReach *reach = query->reach;
    EnfKdTree tree = enf_kd_tree(&reach->space.tree);
    uint32_t found = enf_kd_overlap(&tree, enf_box3f_outward(query->eyes), reach->near, reach->space.cell_count), count = 0;
    for (uint32_t i = 0; i < found; i++) {
        const EnfShell *shell = &reach->space.shells.cells[reach->near[i]];
        bool near = !is_listed(reach, reach->near[i]) && enf_shell_near_box(shell, query->eyes, SURFACE) &&
                    enf_shell_near(shell, reach->points.data, reach->points.count, SURFACE);
        if (near) {
            reach->near[count++] = reach->near[i];
        }
    }
    for (uint32_t first = 0; first < count; first += CANDIDATES) {
        uint32_t some = count - first < CANDIDATES ? count - first : CANDIDATES;
        for (uint32_t i = 0; i < query->count; i++) {
            look_at_triangle(query, &query->sheets[i], &reach->near[first], some);
        }
    }
}

/* From the cells listed at `first` and after it. */
static void reach_through_portals(Query *query, uint32_t first) {
    EnfReach *reach = query->reach;
    for (uint32_t i = first; i < query->listed; i++) {
        uint32_t from = reach->cells[i];
        for (uint32_t p = reach->space.portal_first[from]; p < reach->space.portal_first[from + 1]; p++) {
            uint32_t target = reach->space.layout->portals[p].target;
            if (target < reach->space.cell_count && !is_listed(reach, target) && passes(query, p)) {
                list(reach, target, &query->listed);
            }
        }
    }
}

/* ---- into rooms that others close ------------------------------------------------------------------------------------------ */

/* Cells that a triangle closes though it is not theirs (regions_leak.c). */
static void reach_as_guest(Query *query, uint32_t triangle) {
    const EnfLayout *layout = query->reach->space.layout;
    uint32_t low = 0, high = layout->guest_count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (layout->guests[middle].triangle < triangle) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    for (; low < layout->guest_count && layout->guests[low].triangle == triangle; low++) {
        list(query->reach, layout->guests[low].cell, &query->listed);
    }
}

/* ---- by contact ------------------------------------------------------------------------------------------------------------- */

/* Is p on an opening of the cell, or on its rim? Through those, windows show what is beyond. */
static bool on_gate(const EnfReach *reach, uint32_t cell, EnfVec3 p) {
    EnfBox3 point = grown((EnfBox3){p, p}, SURFACE);
    for (uint32_t g = reach->space.portal_first[cell]; g < reach->space.portal_first[cell + 1]; g++) {
        const Gate *gate = &reach->gates[g];
        double d = enf_dot(gate->normal, p) + gate->d;
        if (gate->walkable && d > -SURFACE && d < SURFACE && enf_box3_overlaps(gate->box, point)) {
            return true;
        }
    }
    return false;
}

/* Does the cell begin at point p of an edge: is it inside, a little before the surface and beyond the edge? */
static bool begins_at(EnfReach *reach, uint32_t cell, EnfVec3 p, EnfVec3 beyond, EnfVec3 front) {
    EnfVec3 q = enf_add(p, enf_scale(enf_add(beyond, front), IN_FRONT));
    EnfShells *shells = &reach->space.shells;
    return enf_shell_near(&shells->cells[cell], &q, 1, SURFACE) && !on_gate(reach, cell, p) &&
           enf_shell_inside(shells, cell, q, SURFACE, false);
}

/* Looks along the edges of a triangle, a point a PIECE. */
static bool touches_from_behind(EnfReach *reach, const Sheet *sheet, uint32_t cell) {
    for (int k = 0; k < 3; k++) {
        EnfVec3 a = sheet->p[k], along = enf_sub(sheet->p[(k + 1) % 3], a);
        double length = enf_length(along);
        EnfVec3 beyond = enf_normalize(enf_cross(along, sheet->normal));
        uint32_t points = length < 64.0 * PIECE ? 1 + (uint32_t)(length / PIECE) : 64;
        for (uint32_t i = 0; i < points; i++) {
            EnfVec3 p = enf_add(a, enf_scale(along, ((double)i + 0.5) / points));
            if (begins_at(reach, cell, p, beyond, sheet->normal) ||
                (sheet->both && begins_at(reach, cell, p, beyond, enf_scale(sheet->normal, -1.0)))) {
                return true;
            }
        }
    }
    return false;
}

static void reach_by_contact(Query *query) {
    EnfReach *reach = query->reach;
    EnfKdTree tree = enf_kd_tree(&reach->space.tree);
    EnfBox3f box = enf_box3f_outward(grown(query->box, 2.0 * IN_FRONT));
    uint32_t found = enf_kd_overlap(&tree, box, reach->near, reach->space.cell_count);
    for (uint32_t i = 0; i < found; i++) {
        uint32_t cell = reach->near[i];
        const EnfShell *shell = &reach->space.shells.cells[cell];
        for (uint32_t k = 0; k < query->count && !is_listed(reach, cell); k++) {
            EnfBox3 around = grown(query->sheets[k].box, 2.0 * IN_FRONT);
            if (enf_shell_near_box(shell, around, SURFACE) && touches_from_behind(reach, &query->sheets[k], cell)) {
                list(reach, cell, &query->listed);
            }
        }
    }
}

/* ---- queries --------------------------------------------------------------------------------------------------------------- */

static int compare_u32(const void *pa, const void *pb) {
    const uint32_t *a = pa, *b = pb;
    return (*a > *b) - (*a < *b);
}

static void add_point(Query *query, EnfVec3 p) {
    EnfReach *reach = query->reach;
    reach->points.data[reach->points.count++] = p;
    query->eyes = enf_box3_add(query->eyes, p);
}

/* Corners, normals and the points in front. @return false if memory is out. */
static bool prepare(Query *query, const uint32_t *triangles, uint32_t count) {
    EnfReach *reach = query->reach;
    const EnfSpace *space = &reach->space;
    reach->sheets.count = reach->points.count = 0;
    if (!ENF_ARRAY_ROOM(&reach->sheets, count) || !ENF_ARRAY_ROOM(&reach->points, 9 * (uint64_t)count)) {
        return false;
    }
    for (uint32_t i = 0; i < count; i++) {
        const EnfSoupTriangle *record = &space->soup->triangles[triangles[i]];
        Sheet *sheet = &reach->sheets.data[i];
        *sheet = (Sheet){.home = record->cell, .node = record->node, .box = enf_box3_empty()};
        enf_soup_corners(space->soup, triangles[i], sheet->p);
        sheet->normal = enf_normalize(enf_cross(enf_sub(sheet->p[1], sheet->p[0]), enf_sub(sheet->p[2], sheet->p[0])));
        sheet->loose = space->layout->node_cells[record->node] == ENF_NONE;
        sheet->both = sheet->loose || (space->faces[record->material] & ENF_FACE_TWO_SIDED);
        EnfVec3 step = enf_scale(sheet->normal, IN_FRONT);
        for (int k = 0; k < 3; k++) {
            sheet->box = enf_box3_add(sheet->box, sheet->p[k]);
            add_point(query, sheet->p[k]);
            add_point(query, enf_add(sheet->p[k], step));
            if (sheet->both) {
                add_point(query, enf_sub(sheet->p[k], step));
            }
        }
        query->box = enf_box3_union(query->box, sheet->box);
    }
    query->sheets = reach->sheets.data;
    query->count = count;
    return true;
}

/* Every other cell: what is answered where memory is out, so that nothing is lost. */
static uint32_t everywhere(const EnfReach *reach, uint32_t home, uint32_t *out, uint32_t capacity) {
    uint32_t count = 0;
    for (uint32_t c = 0; c < reach->space.cell_count && count < capacity; c++) {
        if (c != home) {
            out[count++] = c;
        }
    }
    return count;
}

uint32_t enf_reach_query(const EnfReach *constant, const uint32_t *triangles, uint32_t triangle_count, uint32_t cell,
                         uint32_t *out, uint32_t capacity) {
    EnfReach *reach = (EnfReach *)(uintptr_t)constant; /* its scratch, and trees made when needed: one thread at a time */
    Query query = {.reach = reach, .box = enf_box3_empty(), .eyes = enf_box3_empty()};
    if (!prepare(&query, triangles, triangle_count)) {
        return everywhere(reach, cell, out, capacity);
    }
    reach->query++;
    uint32_t first = list(reach, cell, &query.listed) ? 1 : 0; /* home is not reached, it is home */
    reach_through_portals(&query, 0);
    uint32_t through_portals = query.listed;
    for (uint32_t i = 0; i < triangle_count; i++) {
        reach_as_guest(&query, triangles[i]);
    }
    reach_through_walls(&query);
    reach_through_portals(&query, through_portals);
    reach_by_contact(&query);
    uint32_t count = query.listed - first;
    qsort(&reach->cells[first], count, sizeof *reach->cells, compare_u32);
    uint32_t given = count < capacity ? count : capacity;
    memcpy(out, &reach->cells[first], given * sizeof *out);
    return given;
}

static int compare_crossings(const void *pa, const void *pb) {
    const Crossing *a = pa, *b = pb;
    if (a->node != b->node) {
        return a->node < b->node ? -1 : 1;
    }
    return (a->cell > b->cell) - (a->cell < b->cell);
}

void enf_reach_report(EnfReach *reach, EnfDiagnosis *diagnosis) {
    const EnfLayout *layout = reach->space.layout;
    Crossing *crossings = reach->crossings.data;
    if (reach->crossings.count > 0) {
        qsort(crossings, reach->crossings.count, sizeof *crossings, compare_crossings);
    }
    for (uint32_t i = 0; i < reach->crossings.count; i++) {
        if (i > 0 && compare_crossings(&crossings[i], &crossings[i - 1]) == 0) {
            continue;
        }
        uint32_t home = layout->node_cells[crossings[i].node];
        enf_diagnose(diagnosis, ENF_DIAGNOSIS_GEOMETRY_CROSSES, layout->source->nodes[crossings[i].node].name,
                     "it belongs to '%s' but reaches into '%s': it is drawn in both", layout->cells[home].name,
                     layout->cells[crossings[i].cell].name);
    }
    reach->crossings.count = 0;
}
