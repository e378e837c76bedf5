/* One capsule, one triangle: distance, and the first time of contact under way.
 *
 * The distance between an upright segment and a triangle is the smallest of: an end of the segment to the triangle; the segment
 * to an edge, seen from above, where they meet within the segment's height; zero where the segment passes through. As a
 * function of the way t it is CONVEX (the distance of a moving point to a convex set: the triangle drawn out along the axis). So Newton's
 * steps from its left never pass the first contact (a tangent lies below the curve), whatever the speed: nothing is tunnelled. */
#include "world/collide_internal.h"

#include <math.h>
#include <string.h>

/* More steps than a graze halving its gap from a kilometre to the tolerance takes. */
enum { STEPS_MAX = 64 };

static inline double clamp01(double x) {
    return x < 0.0 ? 0.0 : (x > 1.0 ? 1.0 : x);
}

/* A triangle as seen from the centre of the lower half-sphere. */
typedef struct Seen {
    EnfVec3 v[3], e[3]; /* corners; edges from each to the next */
    EnfVec3 n;
} Seen;

typedef struct Best {
    double square;
    EnfVec3 away, point; /* from the nearest point to the axis; that point */
    bool face;
    double side; /* metres before the face, where that is nearest */
} Best;

/* Is the foot of `p` on the triangle's plane within its border? */
static bool over_face(const Seen *s, EnfVec3 p) {
    for (int i = 0; i < 3; i++) {
        if (enf_dot(enf_cross(s->n, s->e[i]), enf_sub(p, s->v[i])) < 0.0) {
            return false;
        }
    }
    return true;
}

static inline void take(Best *best, EnfVec3 axis, EnfVec3 point) {
    EnfVec3 away = enf_sub(axis, point);
    double square = enf_dot(away, away);
    if (square < best->square) {
        *best = (Best){square, away, point, false, 0.0};
    }
}

/* An end of the axis. Over the face it is the plane that counts: its normal is exact, so a flat floor is flat. */
static void take_end(const Seen *s, bool flat, EnfVec3 end, Best *best) {
    if (flat && over_face(s, end)) {
        double side = enf_dot(s->n, enf_sub(end, s->v[0]));
        if (side * side < best->square) {
            *best = (Best){side * side, s->n, enf_sub(end, enf_scale(s->n, side)), true, side};
        }
        return;
    }
    for (int i = 0; i < 3; i++) {
        double square = enf_dot(s->e[i], s->e[i]);
        double t = square > 0.0 ? clamp01(enf_dot(s->e[i], enf_sub(end, s->v[i])) / square) : 0.0;
        take(best, end, enf_add(s->v[i], enf_scale(s->e[i], t)));
    }
}

/* The side of the axis. Where the edge's point is above or below, an end is nearer to some point of it. */
static void take_side(const Seen *s, double length, Best *best) {
    for (int i = 0; i < 3; i++) {
        EnfVec3 v = s->v[i], e = s->e[i];
        double square = e.x * e.x + e.z * e.z;
        double t = square > 0.0 ? clamp01(-(v.x * e.x + v.z * e.z) / square) : 0.0;
        EnfVec3 point = enf_add(v, enf_scale(e, t));
        if (point.y > 0.0 && point.y < length) {
            take(best, enf_v3(0.0, point.y, 0.0), point);
        }
    }
}

static bool crosses(const Seen *s, double length, double *y) {
    if (s->n.y == 0.0) {
        return false;
    }
    *y = enf_dot(s->n, s->v[0]) / s->n.y;
    return *y >= 0.0 && *y <= length && over_face(s, enf_v3(0.0, *y, 0.0));
}

void enf_nearest(const EnfNearTriangle *triangle, const EnfCapsule *capsule, EnfVec3 from, EnfVec3 offset, EnfNearest *out) {
    Seen s;
    const EnfVec3 *corner = triangle->corner;
    double length = capsule->height - 2.0 * capsule->radius, y = 0.0;
    for (int i = 0; i < 3; i++) {
        s.v[i] = enf_sub(enf_sub(corner[i], from), offset);
        s.v[i].y -= capsule->radius;
        s.e[i] = enf_sub(corner[(i + 1) % 3], corner[i]);
    }
    s.n = triangle->normal;
    bool flat = s.n.x != 0.0 || s.n.y != 0.0 || s.n.z != 0.0;
    Best best = {HUGE_VAL, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, false, 0.0};
    take_end(&s, flat, enf_v3(0.0, 0.0, 0.0), &best);
    if (length > 0.0) {
        take_end(&s, flat, enf_v3(0.0, length, 0.0), &best);
        take_side(&s, length, &best);
    }
    if (flat && length > 0.0 && crosses(&s, length, &y)) {
        best = (Best){0.0, s.n, enf_v3(0.0, y, 0.0), true, 0.0};
    }
    out->distance = best.face ? fabs(best.side) : sqrt(best.square);
    if (best.face) {
        out->normal = best.side < 0.0 ? enf_scale(s.n, -1.0) : s.n;
    } else {
        out->normal = out->distance > 0.0 ? enf_scale(best.away, 1.0 / out->distance) : (flat ? s.n : enf_v3(0.0, 1.0, 0.0));
    }
    out->point = best.point;
    out->point.y += capsule->radius;
}

/* ---- under way -------------------------------------------------------------------------------------------------- */

EnfBox3 enf_capsule_box(const EnfCapsule *capsule, EnfVec3 at, double margin) {
    double side = capsule->radius + margin;
    EnfBox3 box = {{at.x - side, at.y - margin, at.z - side}, {at.x + side, at.y + capsule->height + margin, at.z + side}};
    return box;
}

EnfSweep enf_sweep_make(const EnfCapsule *capsule, EnfVec3 from, EnfVec3 delta) {
    EnfSweep sweep;
    memset(&sweep, 0, sizeof sweep);
    sweep.capsule = *capsule;
    sweep.from = from;
    sweep.delta = delta;
    sweep.t = sweep.contact = 1.0;
    sweep.length = sqrt(enf_dot(delta, delta));
    sweep.box = enf_box3_union(enf_capsule_box(capsule, from, 2.0 * ENF_TOL_SKIN),
                               enf_capsule_box(capsule, enf_add(from, delta), 2.0 * ENF_TOL_SKIN));
    return sweep;
}

static bool boxes_apart(const EnfBox3 *a, const EnfBox3 *b) {
    return a->min.x > b->max.x || b->min.x > a->max.x || a->min.y > b->max.y || b->min.y > a->max.y || a->min.z > b->max.z ||
           b->min.z > a->max.z;
}

/* Does the capsule stay on one side of the triangle's plane all the way, and clear of it? */
static bool planes_apart(const EnfSweep *sweep, const EnfNearTriangle *triangle) {
    EnfVec3 n = triangle->normal, feet = enf_sub(sweep->from, triangle->corner[0]);
    double side = enf_dot(n, feet) + n.y * sweep->capsule.radius;
    double up = n.y * (sweep->capsule.height - 2.0 * sweep->capsule.radius), way = enf_dot(n, sweep->delta);
    double low = side + (up < 0.0 ? up : 0.0) + (way < 0.0 ? way : 0.0);
    double high = side + (up > 0.0 ? up : 0.0) + (way > 0.0 ? way : 0.0);
    double clear = sweep->capsule.radius + 2.0 * ENF_TOL_SKIN;
    return low > clear || high < -clear; /* never of a degenerate one: its sides are 0 */
}

static void keep(EnfSweep *sweep, double t, double contact, const EnfNearest *at, const EnfNearTriangle *met) {
    sweep->t = t;
    sweep->contact = contact;
    sweep->normal = at->normal;
    sweep->point = enf_add(sweep->from, at->point);
    sweep->met = met;
}

/* Of two met at once the one of lower number: what is met must not depend on the order of gathering. */
static bool comes_before(const EnfNearTriangle *a, const EnfNearTriangle *b) {
    if (b == NULL || a->cluster != b->cluster) {
        return b == NULL || a->cluster < b->cluster;
    }
    return a->solid != b->solid ? a->solid < b->solid : a->triangle < b->triangle;
}

/* Free until the skin is reached, in contact at half of it; one search finds both, as it comes by the first on its way to the second. What
 * is in contact at the start stops what moves against it, by more than rounding; what comes no nearer never does. */
void enf_sweep_triangle(EnfSweep *sweep, const EnfNearTriangle *triangle) {
    if (boxes_apart(&sweep->box, &triangle->box) || planes_apart(sweep, triangle)) {
        return;
    }
    sweep->tested++;
    double contact = sweep->capsule.radius + 0.5 * ENF_TOL_SKIN, skin = sweep->capsule.radius + ENF_TOL_SKIN;
    double t = 0.0, kept = -1.0; /* kept: where the skin was reached */
    EnfNearest at;
    for (int i = 0; i < STEPS_MAX; i++) {
        EnfVec3 way = enf_scale(sweep->delta, t);
        enf_nearest(triangle, &sweep->capsule, sweep->from, way, &at);
        at.point = enf_add(at.point, way);
        sweep->steps++;
        double slope = enf_dot(sweep->delta, at.normal);
        if (slope >= -0x1p-40 * sweep->length) {
            return;
        }
        if (kept < 0.0 && at.distance - skin <= (i == 0 ? 2.0 : 1.0) * ENF_TOL_CONTACT) {
            kept = t; /* twice the tolerance at the start: who has come so near stays where he is, to the bit */
        }
        if (at.distance - contact <= ENF_TOL_CONTACT) {
            break;
        }
        t += (at.distance - (kept < 0.0 ? skin : contact)) / -slope;
        if (!(t <= sweep->contact)) {
            return;
        }
    }
    if (t < sweep->contact || comes_before(triangle, sweep->met)) {
        keep(sweep, kept < 0.0 ? t : kept, t, &at, triangle);
    }
}
