/* Polygon windows: convex, integer, exact. Hulls by the monotone chain (Andrew, "Another efficient algorithm for convex
 * hulls in two dimensions", 1979); nothing here rounds but outward. */
#include "geom/geom_internal.h"

#include <string.h>

void enf_grid_points_add(EnfGridPoints *points, int32_t x, int32_t y) {
    ENF_ASSERT(points->count < ENF_HULL_MAX);
    points->x[points->count] = x;
    points->y[points->count] = y;
    points->count++;
}

/* The points in use only: the arrays are far larger than what they usually hold. */
static void copy_points(EnfGridPoints *to, const EnfGridPoints *from) {
    to->count = from->count;
    memcpy(to->x, from->x, from->count * sizeof to->x[0]);
    memcpy(to->y, from->y, from->count * sizeof to->y[0]);
}

/* ---- hull ------------------------------------------------------------------------------------------------------- */

/* (b - a) × (c - a): positive if a, b, c turn left. Below 2^61, see ENF_WINDOW_LIMIT. */
static int64_t turn(const int32_t *x, const int32_t *y, uint32_t a, uint32_t b, int32_t cx, int32_t cy) {
    return ((int64_t)x[b] - x[a]) * ((int64_t)cy - y[a]) - ((int64_t)y[b] - y[a]) * ((int64_t)cx - x[a]);
}

/* By x, then y. Insertion: there are some 16 points, often nearly in order, and equal ones are alike. */
static void sort_points(EnfGridPoints *p) {
    for (uint32_t i = 1; i < p->count; i++) {
        int32_t x = p->x[i], y = p->y[i];
        uint32_t at = i;
        for (; at > 0 && (p->x[at - 1] > x || (p->x[at - 1] == x && p->y[at - 1] > y)); at--) {
            p->x[at] = p->x[at - 1];
            p->y[at] = p->y[at - 1];
        }
        p->x[at] = x;
        p->y[at] = y;
    }
}

/* Appends a point to the chain that begins at `first`, removing what no longer turns left. */
static inline void chain_add(EnfGridPoints *chain, uint32_t first, int32_t x, int32_t y) {
    uint32_t count = chain->count;
    while (count >= first + 2 && turn(chain->x, chain->y, count - 2, count - 1, x, y) <= 0) {
        count--;
    }
    chain->x[count] = x;
    chain->y[count] = y;
    chain->count = count + 1;
}

void enf_grid_points_hull(EnfGridPoints *points) {
    if (points->count < 3) {
        points->count = 0;
        return;
    }
    sort_points(points);
    EnfGridPoints hull;
    hull.count = 0;
    for (uint32_t i = 0; i < points->count; i++) {
        chain_add(&hull, 0, points->x[i], points->y[i]);
    }
    uint32_t upper = hull.count - 1;
    for (uint32_t i = points->count - 1; i-- > 0;) {
        chain_add(&hull, upper, points->x[i], points->y[i]);
    }
    hull.count--; /* the first point closed the ring */
    hull.count = hull.count < 3 ? 0 : hull.count;
    copy_points(points, &hull);
}

/* ---- clipping a hull to a box ----------------------------------------------------------------------------------- */

static EnfWindow bounds_of(const int32_t *x, const int32_t *y, uint32_t count) {
    EnfWindow w = {0, 0, 0, 0};
    if (count > 0) {
        w.x0 = w.x1 = x[0];
        w.y0 = w.y1 = y[0];
    }
    for (uint32_t i = 1; i < count; i++) {
        w.x0 = x[i] < w.x0 ? x[i] : w.x0;
        w.x1 = x[i] > w.x1 ? x[i] : w.x1;
        w.y0 = y[i] < w.y0 ? y[i] : w.y0;
        w.y1 = y[i] > w.y1 ? y[i] : w.y1;
    }
    return w;
}

static int64_t floor_divide(int64_t a, int64_t b) {
    int64_t quotient = a / b;
    return quotient - (a % b != 0 && (a < 0) != (b < 0));
}

/* One side, `sign * u >= sign * limit`; u is the coordinate across the side, v along it. A crossing is rational: both its
 * neighbours on the grid are kept, so the result contains the exact clip and lies on the side. */
static void clip_to_side(EnfGridPoints *p, bool vertical, int sign, int32_t limit) {
    const int32_t *u = vertical ? p->y : p->x, *v = vertical ? p->x : p->y;
    EnfGridPoints kept;
    kept.count = 0;
    for (uint32_t i = 0; i < p->count; i++) {
        uint32_t j = i + 1 < p->count ? i + 1 : 0;
        bool inside = sign * (int64_t)u[i] >= sign * (int64_t)limit;
        if (inside) {
            enf_grid_points_add(&kept, p->x[i], p->y[i]);
        }
        if (inside == (sign * (int64_t)u[j] >= sign * (int64_t)limit)) {
            continue;
        }
        int64_t across = (int64_t)u[j] - u[i], rise = ((int64_t)v[j] - v[i]) * ((int64_t)limit - u[i]);
        int32_t low = (int32_t)(v[i] + floor_divide(rise, across));
        int32_t high = (int32_t)(v[i] - floor_divide(-rise, across));
        enf_grid_points_add(&kept, vertical ? low : limit, vertical ? limit : low);
        enf_grid_points_add(&kept, vertical ? high : limit, vertical ? limit : high);
    }
    copy_points(p, &kept);
    enf_grid_points_hull(p);
}

void enf_grid_points_clip(EnfGridPoints *points, EnfWindow box) {
    EnfWindow bounds = bounds_of(points->x, points->y, points->count);
    if (bounds.x0 < box.x0) {
        clip_to_side(points, false, 1, box.x0);
    }
    if (bounds.x1 > box.x1) {
        clip_to_side(points, false, -1, box.x1);
    }
    if (bounds.y0 < box.y0) {
        clip_to_side(points, true, 1, box.y0);
    }
    if (bounds.y1 > box.y1) {
        clip_to_side(points, true, -1, box.y1);
    }
}

/* ---- windows ---------------------------------------------------------------------------------------------------- */

void enf_grid_points_window(const EnfGridPoints *points, EnfWindowPolygon *out) {
    if (points->count > ENF_WINDOW_POLYGON_MAX) {
        *out = enf_window_polygon_from_box(bounds_of(points->x, points->y, points->count));
        return;
    }
    out->count = points->count;
    for (uint32_t i = 0; i < points->count; i++) {
        out->x[i] = points->x[i];
        out->y[i] = points->y[i];
    }
}

EnfWindowPolygon enf_window_polygon_from_box(EnfWindow w) {
    EnfWindowPolygon p = {enf_window_is_empty(w) ? 0u : 4u, {w.x0, w.x1, w.x1, w.x0}, {w.y0, w.y0, w.y1, w.y1}};
    return p;
}

EnfWindow enf_window_polygon_bounds(const EnfWindowPolygon *p) {
    return bounds_of(p->x, p->y, p->count);
}

bool enf_window_polygon_contains(const EnfWindowPolygon *outer, const EnfWindowPolygon *inner) {
    if (inner->count > 0 && outer->count == 0) {
        return false;
    }
    for (uint32_t i = 0; i < outer->count; i++) {
        uint32_t j = i + 1 < outer->count ? i + 1 : 0;
        for (uint32_t k = 0; k < inner->count; k++) {
            if (turn(outer->x, outer->y, i, j, inner->x[k], inner->y[k]) < 0) {
                return false;
            }
        }
    }
    return true;
}

static void add_all(EnfGridPoints *points, const EnfWindowPolygon *p) {
    for (uint32_t i = 0; i < p->count; i++) {
        enf_grid_points_add(points, p->x[i], p->y[i]);
    }
}

void enf_window_polygon_union(const EnfWindowPolygon *a, const EnfWindowPolygon *b, EnfWindowPolygon *out) {
    EnfGridPoints points;
    points.count = 0;
    add_all(&points, a);
    add_all(&points, b);
    enf_grid_points_hull(&points);
    enf_grid_points_window(&points, out);
}
