/* A point → the cell that it lies in, for spawn and teleport (DESIGN §3; a walking eye is tracked: track.c).
 *
 * A `-bound` decides by its planes. Else a few rays ask what they meet first: the front of a shell or the opening of a portal
 * from within is "inside", their backs "outside"; a leak misleads some rays but not most. A point within a thing (an eye that walks
 * through a barrel) sees that thing's back all round: it is asked again without it. */
#include "map/map_internal.h"
#include <enfilade/tolerances.h>

#include <math.h>
#include <string.h>

/* No axis, no diagonal, no two opposite: a ray along a wall or through an edge decides nothing well. An odd number, each a metre
 * long or nearly, so that a parameter is a distance. */
static const EnfVec3 probes[] = {{0.57735, 0.71934, 0.38621},
                                 {-0.82311, 0.31172, 0.47443},
                                 {0.27413, -0.63177, 0.72514},
                                 {-0.41273, -0.54318, -0.73131},
                                 {0.68713, 0.19136, -0.70092}};
enum { PROBE_COUNT = sizeof probes / sizeof *probes, PROBES_INSIDE = PROBE_COUNT / 2 + 1, CANDIDATES_MAX = 64, THINGS_MAX = 4 };

/* ---- one cell --------------------------------------------------------------------------------------------------- */

static double cell_volume(const EnfCell *cell) {
    double volume = 1.0;
    for (int axis = 0; axis < 3; axis++) {
        volume *= (double)cell->max[axis] - (double)cell->min[axis];
    }
    return volume;
}

/* What counts as the cell's shell. Decals, curtains and leaves are no walls, so a surface seen from both sides is left out; but
 * where most of the cell is double-sided (Blender's default), its winding is all there is to go by. */
typedef struct Shell {
    uint32_t cell;
    bool double_sided;
    bool guests; /* what other cells own and this one shows counts as well: walls that a neighbour was given */
    uint32_t without[THINGS_MAX], without_count; /* names of nodes: the things that the point is inside of */
} Shell;

static double cluster_area(const EnfMap *map, const EnfCluster *cluster) {
    double area = 0.0;
    for (uint32_t i = 0; i < cluster->index_count / 3; i++) {
        EnfVec3 a = enf_map_corner(map, cluster, i, 0);
        EnfVec3 ab = enf_sub(enf_map_corner(map, cluster, i, 1), a), ac = enf_sub(enf_map_corner(map, cluster, i, 2), a);
        area += enf_length(enf_cross(ab, ac));
    }
    return area;
}

/* Which kinds the cell shows at all: bit 0 surfaces of one side, bit 1 of two. */
static uint32_t sides_of(const EnfMap *map, const EnfCell *c) {
    uint32_t kinds = 0;
    for (uint32_t i = c->cluster_first; i < c->cluster_first + c->cluster_count; i++) {
        const EnfMaterial *material = &map->materials[map->clusters[i].material];
        if (material->alpha_mode == ENF_ALPHA_OPAQUE) {
            kinds |= material->flags & ENF_MATERIAL_DOUBLE_SIDED ? 2u : 1u;
        }
    }
    return kinds;
}

static Shell shell_of(const EnfMap *map, uint32_t cell) {
    double single = 0.0, both = 0.0;
    const EnfCell *c = &map->cells[cell];
    uint32_t kinds = sides_of(map, c);
    for (uint32_t i = c->cluster_first; kinds == 3u && i < c->cluster_first + c->cluster_count; i++) {
        const EnfMaterial *material = &map->materials[map->clusters[i].material];
        if (material->alpha_mode ==
            ENF_ALPHA_OPAQUE) { /* only where there are both does their area decide: it costs a millisecond */
            *(material->flags & ENF_MATERIAL_DOUBLE_SIDED ? &both : &single) += cluster_area(map, &map->clusters[i]);
        }
    }
    return (Shell){cell, kinds == 3u ? both > single : kinds == 2u, false, {0}, 0};
}

/* Is the node a thing in the cell, rather than what the cell is made of? Its box is less than half of the cell's. */
static bool is_thing(const EnfMap *map, uint32_t cell, uint32_t node) {
    const EnfCell *c = &map->cells[cell];
    EnfBox3 box = enf_box3_empty();
    for (uint32_t i = c->cluster_first; i < c->cluster_first + c->cluster_count; i++) {
        const EnfCluster *cluster = &map->clusters[i];
        if (cluster->node == node) {
            EnfBox3f own = {{cluster->min[0], cluster->min[1], cluster->min[2]},
                            {cluster->max[0], cluster->max[1], cluster->max[2]}};
            box = enf_box3_union(box, enf_box3_from_f(own));
        }
    }
    EnfVec3 size = enf_sub(box.max, box.min);
    return 2.0 * size.x * size.y * size.z < cell_volume(c);
}

static bool shell_wanted(const EnfMap *map, uint32_t index, const void *user) {
    const Shell *shell = user;
    const EnfCluster *cluster = &map->clusters[index];
    const EnfMaterial *material = &map->materials[cluster->material];
    for (uint32_t i = 0; i < shell->without_count; i++) {
        if (cluster->node == shell->without[i]) {
            return false;
        }
    }
    return (cluster->cell == shell->cell || shell->guests) && material->alpha_mode == ENF_ALPHA_OPAQUE &&
           (shell->double_sided || !(material->flags & ENF_MATERIAL_DOUBLE_SIDED));
}

/* The nearest opening of the cell before *t: from within, a ray leaves by it along its normal. A point on an opening is in both
 * cells, whatever rounding made of it: the ray that leaves counts from a little behind, the one that enters only from beyond. */
static void probe_portals(const EnfMap *map, uint32_t cell, EnfVec3 local, EnfVec3 direction, double *t, bool *inside) {
    const EnfCell *c = &map->cells[cell];
    EnfMapRay ray;
    enf_map_ray_make(&ray, direction);
    for (uint32_t p = c->portal_first; p < c->portal_first + c->portal_count; p++) {
        for (uint32_t i = 2; i < map->portals[p].vertex_count; i++) {
            EnfVec3 v0 = enf_sub(enf_map_portal_vertex(map, p, 0), local);
            EnfVec3 v1 = enf_sub(enf_map_portal_vertex(map, p, i - 1), local);
            EnfVec3 v2 = enf_sub(enf_map_portal_vertex(map, p, i), local);
            double at;
            if (!enf_map_ray_triangle(&ray, v0, v1, v2, &at) || at >= *t) {
                continue;
            }
            bool leaves = enf_dot(enf_cross(enf_sub(v1, v0), enf_sub(v2, v0)), direction) > 0.0;
            if (at >= (leaves ? -ENF_TOL_ROUNDING : ENF_TOL_ROUNDING)) {
                *t = at;
                *inside = leaves;
            }
        }
    }
}

/* What the ray meets first says inside; nothing met is outside. `*behind`: the node whose back it was, or ENF_NONE. */
static bool probe(const EnfMap *map, const Shell *shell, EnfVec3 p_ws, EnfVec3 direction, uint32_t *behind) {
    EnfRayHit hit;
    double t = HUGE_VAL;
    bool inside = false;
    *behind = ENF_NONE;
    EnfMapQuery query = {shell->cell, p_ws, direction, HUGE_VAL, shell_wanted, shell};
    if (enf_map_ray_query(map, &query, &hit)) {
        t = hit.t;
        inside = hit.front;
        *behind = inside ? ENF_NONE : map->clusters[hit.cluster].node;
    }
    probe_portals(map, shell->cell, enf_sub(p_ws, enf_map_origin(map, shell->cell)), direction, &t, &inside);
    return inside;
}

/* The majority of the probes. `*enclosing`: the node whose back most of them met, or ENF_NONE (a thing that stands on the floor hides
 * its underside, so not all need to). */
static bool vote(const EnfMap *map, const Shell *shell, EnfVec3 p_ws, uint32_t *enclosing) {
    uint32_t behind[PROBE_COUNT];
    int votes = 0;
    for (int i = 0; i < PROBE_COUNT; i++) {
        votes += probe(map, shell, p_ws, probes[i], &behind[i]);
    }
    *enclosing = ENF_NONE;
    for (int i = 0; i < PROBE_COUNT; i++) {
        int same = 0;
        for (int k = 0; k < PROBE_COUNT; k++) {
            same += behind[k] == behind[i];
        }
        *enclosing = same >= PROBES_INSIDE ? behind[i] : *enclosing;
    }
    return votes >= PROBES_INSIDE;
}

static bool within_bounds(const EnfCell *cell, EnfVec3 local) {
    const double p[3] = {local.x, local.y, local.z}, e = ENF_TOL_ROUNDING;
    bool within = true;
    for (int axis = 0; axis < 3; axis++) {
        within = within && p[axis] >= (double)cell->min[axis] - e && p[axis] <= (double)cell->max[axis] + e;
    }
    return within;
}

static bool contains(const EnfMap *map, uint32_t cell, EnfVec3 p_ws, bool guests) {
    if (cell >= map->cells_count || map->cells[cell].flags & ENF_CELL_OUTSIDE || !enf_v3_finite(p_ws)) {
        return false;
    }
    const EnfCell *c = &map->cells[cell];
    EnfVec3 local = enf_sub(p_ws, enf_map_origin(map, cell));
    for (uint32_t i = c->bound_first; i < c->bound_first + c->bound_count; i++) {
        const EnfPlane4f *plane = &map->bound_planes[i];
        EnfVec3 n = enf_v3((double)plane->n[0], (double)plane->n[1], (double)plane->n[2]);
        if (enf_dot(n, local) + (double)plane->d > 2.0 * ENF_GRID_STEP) { /* its points and the opening's were snapped apart */
            return false;
        }
    }
    if (c->bound_count) {
        return true;
    }
    if (!within_bounds(c, local)) {
        return false;
    }
    Shell shell = shell_of(map, cell);
    shell.guests = guests;
    for (;;) {
        uint32_t enclosing;
        if (vote(map, &shell, p_ws, &enclosing)) {
            return true;
        }
        if (enclosing == ENF_NONE || shell.without_count == THINGS_MAX || !is_thing(map, cell, enclosing)) {
            return false;
        }
        shell.without[shell.without_count++] = enclosing;
    }
}

bool enf_map_cell_contains(const EnfMap *map, uint32_t cell, EnfVec3 p_ws) {
    return contains(map, cell, p_ws, false);
}

/* ---- all cells -------------------------------------------------------------------------------------------------- */

/* Does `a` win over `b` where both contain the point? */
static bool wins(const EnfMap *map, uint32_t a, uint32_t b) {
    if (b == ENF_NONE) {
        return true;
    }
    const EnfCell *x = &map->cells[a], *y = &map->cells[b];
    if (x->priority != y->priority) {
        return x->priority > y->priority;
    }
    double u = cell_volume(x), v = cell_volume(y);
    return u != v ? u < v : a < b;
}

/* Walls that are boxes show fronts to both sides, and belong to one room: it seems to contain its neighbours, and they, without walls
 * of their own, seem to contain nothing. Then rays ask what is nearest of all that the rivals show, and whose it is. */
typedef struct Rivals {
    Shell shells[CANDIDATES_MAX];
    uint32_t score[CANDIDATES_MAX], count;
    bool sure[CANDIDATES_MAX]; /* their own surfaces say so */
} Rivals;

enum { SCORE_PORTAL = 4, SCORE_SURFACE = 1, SPREAD = 4 };

/* One ray: the rivals that show the nearest surface, whoever owns it. An opening that nothing hides says the most: its two
 * sides are two rooms. */
static void score_ray(const EnfMap *map, Rivals *rivals, EnfVec3 p_ws, EnfVec3 direction) {
    double t[CANDIDATES_MAX], nearest = HUGE_VAL;
    bool front[CANDIDATES_MAX];
    uint32_t worth[CANDIDATES_MAX];
    for (uint32_t i = 0; i < rivals->count; i++) {
        const Shell *shell = &rivals->shells[i];
        EnfRayHit hit;
        EnfMapQuery query = {shell->cell, p_ws, direction, HUGE_VAL, shell_wanted, shell};
        bool met = enf_map_ray_query(map, &query, &hit);
        double before = t[i] = met ? hit.t : HUGE_VAL;
        front[i] = met && hit.front;
        worth[i] = SCORE_SURFACE;
        probe_portals(map, shell->cell, enf_sub(p_ws, enf_map_origin(map, shell->cell)), direction, &t[i], &front[i]);
        worth[i] = t[i] < before ? SCORE_PORTAL : worth[i];
        nearest = t[i] < nearest ? t[i] : nearest;
    }
    for (uint32_t i = 0; i < rivals->count && nearest < HUGE_VAL; i++) {
        if (front[i] && t[i] <= nearest + ENF_TOL_ROUNDING) {
            rivals->score[i] += worth[i];
        }
    }
}

/* Towards the middle of every opening of a rival. */
static void score_portals(const EnfMap *map, Rivals *rivals, uint32_t cell, EnfVec3 p_ws) {
    const EnfCell *c = &map->cells[cell];
    for (uint32_t p = c->portal_first; p < c->portal_first + c->portal_count; p++) {
        EnfVec3 middle = {0};
        for (uint32_t i = 0; i < map->portals[p].vertex_count; i++) {
            middle = enf_add(middle, enf_scale(enf_map_portal_vertex(map, p, i), 1.0 / map->portals[p].vertex_count));
        }
        EnfVec3 way = enf_sub(enf_add(middle, enf_map_origin(map, cell)), p_ws);
        if (map->portals[p].vertex_count > 0 && enf_dot(way, way) > 0.0) {
            score_ray(map, rivals, p_ws, enf_normalize(way));
        }
    }
}

/* The probes, each turned about the axes as well: the more rays, the less the shape of a room matters. */
static void score_all(const EnfMap *map, Rivals *rivals, EnfVec3 p_ws) {
    for (int i = 0; i < PROBE_COUNT; i++) {
        EnfVec3 d = probes[i];
        const EnfVec3 spread[SPREAD] = {d, {d.y, -d.z, d.x}, {-d.z, d.x, d.y}, {-d.x, d.y, -d.z}};
        for (int k = 0; k < SPREAD; k++) {
            score_ray(map, rivals, p_ws, spread[k]);
        }
    }
    for (uint32_t i = 0; i < rivals->count; i++) {
        score_portals(map, rivals, rivals->shells[i].cell, p_ws);
    }
}

/* With its guests; an open cell, whose walls nobody knows, wherever its box does. */
static bool could_contain(const EnfMap *map, uint32_t cell, EnfVec3 p_ws) {
    bool open = (map->cells[cell].flags & ENF_CELL_OPEN) != 0;
    return (open && within_bounds(&map->cells[cell], enf_sub(p_ws, enf_map_origin(map, cell)))) ||
           contains(map, cell, p_ws, true);
}

static void add_rival(const EnfMap *map, Rivals *rivals, uint32_t cell, bool sure) {
    if (rivals->count < CANDIDATES_MAX) {
        rivals->shells[rivals->count] = shell_of(map, cell);
        rivals->sure[rivals->count] = sure;
        rivals->shells[rivals->count++].guests = true;
    }
}

/* `best` (or none) is what the shells say; of the others, one wins to which more belongs of what is near: a quarter more, where
 * its own surfaces do not say so. */
static uint32_t settle(const EnfMap *map, EnfVec3 p_ws, uint32_t best, Rivals *rivals) {
    score_all(map, rivals, p_ws);
    uint32_t most = 0;
    for (uint32_t i = 0; i < rivals->count; i++) {
        most = rivals->shells[i].cell == best ? rivals->score[i] : most;
    }
    for (int sure = 1; sure >= 0; sure--) {
        uint32_t least = sure || best == ENF_NONE ? most : most + most / 4;
        for (uint32_t i = 0; i < rivals->count; i++) {
            if (rivals->sure[i] == (sure == 1) && rivals->score[i] > least) {
                least = most = rivals->score[i];
                best = rivals->shells[i].cell;
            }
        }
    }
    return best;
}

/* Metres behind an opening within which it is asked who is there. */
static const double DOORSTEP = 1.0;

/* Does the point lie straight behind the opening, with nothing between? Then it is in the cell behind, whatever a coarse `-bound` or a
 * wall that belongs to somebody else says. */
static bool is_on_doorstep(const EnfMap *map, uint32_t portal, EnfVec3 p_ws) {
    const EnfPortal *half = &map->portals[portal];
    EnfVec3 points[ENF_POLYGON_MAX], local = enf_sub(p_ws, enf_map_origin(map, half->source));
    if (half->vertex_count < 3 || half->vertex_count > ENF_POLYGON_MAX || half->transform != ENF_NONE ||
        half->twin == ENF_NONE) {
        return false;
    }
    for (uint32_t i = 0; i < half->vertex_count; i++) {
        points[i] = enf_map_portal_vertex(map, portal, i);
    }
    EnfPlane plane = enf_plane_from_polygon(points, half->vertex_count);
    double distance = enf_dot(plane.n, enf_sub(local, points[0]));
    if (!(distance > ENF_TOL_ROUNDING && distance < DOORSTEP)) {
        return false;
    }
    for (uint32_t i = 0; i < half->vertex_count; i++) {
        EnfVec3 along = enf_sub(points[(i + 1) % half->vertex_count], points[i]);
        if (enf_dot(enf_cross(along, enf_sub(local, points[i])), plane.n) < 0.0) {
            return false;
        }
    }
    EnfVec3 back = enf_scale(plane.n, -1.0);
    double t = distance - ENF_TOL_ROUNDING;
    bool leaves = false;
    Shell shell = shell_of(map, half->target);
    shell.guests = true;
    EnfRayHit hit;
    EnfMapQuery query = {half->target, p_ws, back, t, shell_wanted, &shell};
    if (enf_map_ray_query(map, &query, &hit)) {
        return false;
    }
    probe_portals(map, half->target, enf_sub(p_ws, enf_map_origin(map, half->target)), back, &t, &leaves);
    return t >= distance - ENF_TOL_ROUNDING;
}

static uint32_t step_through(const EnfMap *map, uint32_t cell, EnfVec3 p_ws) {
    const EnfCell *c = &map->cells[cell];
    for (uint32_t p = c->portal_first; p < c->portal_first + c->portal_count; p++) {
        if (map->cells[map->portals[p].target].priority >= c->priority && is_on_doorstep(map, p, p_ws)) {
            return map->portals[p].target;
        }
    }
    return cell;
}

uint32_t enf_map_locate(const EnfMap *map, EnfVec3 p_ws) {
    if (!enf_v3_finite(p_ws)) {
        return ENF_NONE;
    }
    EnfKdTree tree = {map->cell_nodes, map->cell_blocks, map->cell_nodes_count, map->cell_blocks_count};
    EnfVec3 p = enf_sub(p_ws, enf_v3(map->tree_origin[0], map->tree_origin[1], map->tree_origin[2]));
    const EnfVec3 e = {ENF_TOL_ROUNDING, ENF_TOL_ROUNDING, ENF_TOL_ROUNDING};
    EnfBox3 point = {enf_sub(p, e), enf_add(p, e)};
    uint32_t candidates[CANDIDATES_MAX];
    uint32_t count = enf_kd_overlap(&tree, enf_box3f_outward(point), candidates, CANDIDATES_MAX);
    const bool all = count > CANDIDATES_MAX; /* a pile of cells: ask every one */
    uint32_t best = ENF_NONE;
    Rivals rivals = {.count = 0};
    for (uint32_t i = 0; i < (all ? map->cells_count : count); i++) {
        uint32_t cell = all ? i : candidates[i];
        if (contains(map, cell, p_ws, false)) {
            bool outranked = best != ENF_NONE && map->cells[best].priority > map->cells[cell].priority;
            if (best != ENF_NONE && map->cells[best].priority < map->cells[cell].priority) {
                rivals.count = 0;
            }
            if (!outranked) {
                best = wins(map, cell, best) ? cell : best;
                add_rival(map, &rivals, cell, true);
            }
        } else if (map->cells[cell].bound_count == 0 && could_contain(map, cell, p_ws)) {
            add_rival(map, &rivals, cell, false);
        }
    }
    bool agreed = rivals.count <= 1 && (rivals.count == 0 || rivals.shells[0].cell == best);
    bool bound = best != ENF_NONE && map->cells[best].bound_count > 0;
    best = agreed || bound ? best : settle(map, p_ws, best, &rivals);
    return best != ENF_NONE ? step_through(map, best, p_ws) : ENF_NONE;
}

/* ---- by name ---------------------------------------------------------------------------------------------------- */

/* The length of a name without `-room` or `_room` at its end (any case; DESIGN §6). */
static size_t length_without_suffix(const char *name) {
    static const char suffix[] = "room";
    size_t length = strlen(name);
    if (length < 5 || (name[length - 5] != '-' && name[length - 5] != '_')) {
        return length;
    }
    for (size_t i = 0; i < 4; i++) {
        if ((name[length - 4 + i] | 0x20) != suffix[i]) {
            return length;
        }
    }
    return length - 5;
}

uint32_t enf_map_find_cell(const EnfMap *map, const char *name) {
    uint32_t by_stem = ENF_NONE;
    for (uint32_t i = 0; i < map->cells_count; i++) {
        const char *candidate = enf_map_string(map, map->cells[i].name);
        if (strcmp(candidate, name) == 0) {
            return i;
        }
        size_t stem = length_without_suffix(candidate);
        if (by_stem == ENF_NONE && stem == strlen(name) && strncmp(candidate, name, stem) == 0) {
            by_stem = i;
        }
    }
    return by_stem;
}
