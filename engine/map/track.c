/* The cell of a moving eye: the portals that its step crosses, in order (PITFALLS 11).
 *
 * A point is on one side of a portal or the other, never on both or neither: both half-portals of a doorway ask the same question of the
 * same world points (grid points: their sums with the cells' origins are exact in double), and the answers are opposite. So an
 * eye that stands on a doorway's plane, or steps to and fro across it, is never lost between the cells. */
#include "map/map_internal.h"
#include <enfilade/tolerances.h>

#include <math.h>

/* Crossing a thousand portals in one step is no walk; it bounds the loop where transforms lead in a ring. */
enum { CROSSINGS_MAX = 1024 };

/* A step in the space of the cell that it has reached. */
typedef struct Step {
    EnfVec3 from, to;
    double t; /* how much of it is surely behind */
} Step;

/* The polygon that decides for a half-portal: its own, or its twin's where that one comes first. */
typedef struct Gate {
    EnfVec3 points[ENF_POLYGON_MAX];
    uint32_t count;
    EnfPlane plane;
    bool turned; /* the plane is the twin's: its front is this half's back */
} Gate;

static Gate gate_of(const EnfMap *map, uint32_t portal) {
    const EnfPortal *p = &map->portals[portal];
    Gate gate;
    gate.turned = p->transform == ENF_NONE && p->twin != ENF_NONE && p->twin < portal;
    uint32_t half = gate.turned ? p->twin : portal;
    EnfVec3 origin = enf_map_origin(map, map->portals[half].source);
    gate.count = map->portals[half].vertex_count;
    for (uint32_t i = 0; i < gate.count; i++) {
        gate.points[i] = enf_add(origin, enf_map_portal_vertex(map, half, i));
    }
    gate.plane = enf_plane_from_polygon(gate.points, gate.count);
    return gate;
}

/* Metres before the plane, from a point of the polygon: at 10 km, n·p + d would have lost a micrometre. */
static double side(const Gate *gate, EnfVec3 p) {
    return enf_dot(gate->plane.n, enf_sub(p, gate->points[0]));
}

/* Where a step leaves through a half-portal. */
typedef struct Crossing {
    double t, doubt; /* the part of the step at which, and how far rounding may have moved it */
    double margin;   /* metres within the border; a little less than 0 on it */
} Crossing;

static double component(EnfVec3 v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* How far inside the polygon's border a point of its plane lies, seen along the axis that the plane faces most: that shortens
 * distances by less than half. */
static double margin_of(const Gate *gate, EnfVec3 p) {
    EnfVec3 n = gate->plane.n;
    int axis = fabs(n.x) > fabs(n.y) ? (fabs(n.x) > fabs(n.z) ? 0 : 2) : (fabs(n.y) > fabs(n.z) ? 1 : 2);
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    double turn = component(n, axis) > 0.0 ? 1.0 : -1.0, margin = HUGE_VAL;
    for (uint32_t i = 0; i < gate->count; i++) {
        EnfVec3 a = gate->points[i], along = enf_sub(gate->points[(i + 1) % gate->count], a), to = enf_sub(p, a);
        double du = component(along, u), dv = component(along, v), length = sqrt(du * du + dv * dv);
        if (length > 0.0) {
            double inside = turn * (du * component(to, v) - dv * component(to, u)) / length;
            margin = inside < margin ? inside : margin;
        }
    }
    return margin;
}

/* Does the step leave its cell through the half-portal? */
static bool leaves_by(const EnfMap *map, uint32_t portal, const Step *step, Crossing *out) {
    if (map->portals[portal].flags & (ENF_PORTAL_OVERLAP | ENF_PORTAL_MIRROR)) {
        return false; /* nobody walks through a mirror, and an overlap has no border */
    }
    Gate gate = gate_of(map, portal);
    double before = side(&gate, step->from), after = side(&gate, step->to);
    /* Arriving through a transform rounds: an eye that it left on the wrong side by that much may go back. */
    double slack = map->portals[portal].transform == ENF_NONE ? 0.0 : ENF_TOL_ROUNDING;
    bool leaves = gate.turned ? before > 0.0 && after <= 0.0 : before <= slack && after > 0.0 && after > before;
    if (!leaves) {
        return false;
    }
    EnfVec3 a = enf_sub(step->from, gate.points[0]), b = enf_sub(step->to, gate.points[0]);
    double t = before / (before - after);
    out->t = t > 0.0 ? t : 0.0;
    /* A side is off by a few roundings of the distances that it is made of; a step along the plane makes much of that. */
    out->doubt = 0x1p-49 * (sqrt(enf_dot(a, a)) + sqrt(enf_dot(b, b))) / fabs(before - after) + 0x1p-49;
    out->margin = margin_of(&gate, enf_add(step->from, enf_scale(enf_sub(step->to, step->from), out->t)));
    return out->margin >= -ENF_TOL_ROUNDING;
}

static EnfVec3 through(const EnfTransform *transform, EnfVec3 p) {
    EnfAffine a;
    for (int i = 0; i < 9; i++) {
        a.m[i] = transform->m[i];
    }
    a.t = enf_v3(transform->t[0], transform->t[1], transform->t[2]);
    return enf_affine_point(&a, p);
}

/* The first portal of `cell` that the rest of the step leaves by, but not `back`: the way it came in by. Of two at one place (they
 * share an edge), the one that it is farther within. */
static uint32_t next_portal(const EnfMap *map, uint32_t cell, Step *step, uint32_t back) {
    const EnfCell *c = &map->cells[cell];
    uint32_t best = ENF_NONE;
    Crossing first = {2.0, 0.0, 0.0};
    for (uint32_t p = c->portal_first; p < c->portal_first + c->portal_count; p++) {
        Crossing at;
        if (p == back || !leaves_by(map, p, step, &at) || at.t + at.doubt < step->t) {
            continue;
        }
        double apart = at.t - first.t, doubt = at.doubt + first.doubt;
        if (apart < -doubt || (apart <= doubt && at.margin > first.margin) || best == ENF_NONE) {
            best = p;
            first = at;
        }
    }
    if (best != ENF_NONE && first.t - first.doubt > step->t) {
        step->t = first.t - first.doubt;
    }
    return best;
}

uint32_t enf_map_track(const EnfMap *map, uint32_t cell, EnfVec3 from_ws, EnfVec3 to_ws) {
    if (cell >= map->cells_count || !enf_v3_finite(from_ws) || !enf_v3_finite(to_ws)) {
        return cell < map->cells_count ? cell : ENF_NONE;
    }
    Step step = {from_ws, to_ws, 0.0};
    uint32_t back = ENF_NONE;
    for (int i = 0; i < CROSSINGS_MAX; i++) {
        uint32_t portal = next_portal(map, cell, &step, back);
        if (portal == ENF_NONE) {
            break;
        }
        const EnfPortal *p = &map->portals[portal];
        if (p->transform != ENF_NONE) {
            step.from = through(&map->transforms[p->transform], step.from);
            step.to = through(&map->transforms[p->transform], step.to);
        }
        cell = p->target;
        back = p->twin;
    }
    return cell;
}
