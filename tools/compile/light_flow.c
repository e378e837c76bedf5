/* Light through portals: depth-first over portal sequences, each narrowing the cone of light (the construction of Luebke &
 * Georges 1995 with a lamp in the place of the eye; shadow volumes of openings). */
#include "compile/light_flow.h"

#include <enfilade/tolerances.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH_MAX = 24, STEPS_MAX = 20000 };

/* A lamp this near (metres) to an opening shines through all of it: planes through both would be noise. */
#define NEAR (8 * ENF_TOL_PORTAL_EYE)

typedef struct Frame {
    uint32_t window, cell, next_portal, end_portal;
    uint32_t entered_by; /* the half-portal, or ENF_NONE */
} Frame;

/* ---- cones ------------------------------------------------------------------------------------------------------ */

static bool inside(EnfVec3 n, EnfVec3 p) {
    return enf_dot(n, p) >= -ENF_TOL_LIGHT * enf_length(p);
}

/* Clips a polygon to n·p ≥ 0 (Sutherland & Hodgman 1974). A convex polygon gains at most one point. */
static uint32_t clip(EnfVec3 *points, uint32_t count, EnfVec3 n) {
    EnfVec3 out[ENF_LIGHT_POINTS + 1];
    uint32_t made = 0;
    for (uint32_t i = 0; i < count; i++) {
        EnfVec3 a = points[i], b = points[(i + 1) % count];
        double da = enf_dot(n, a), db = enf_dot(n, b);
        bool a_in = inside(n, a), b_in = inside(n, b);
        if (a_in && made < ENF_LIGHT_POINTS) {
            out[made++] = a;
        }
        if (a_in != b_in && da != db && made < ENF_LIGHT_POINTS) {
            double t = da / (da - db);
            t = t < 0 ? 0 : t > 1 ? 1 : t;
            out[made++] = enf_add(a, enf_scale(enf_sub(b, a), t));
        }
    }
    memcpy(points, out, made * sizeof *points);
    return made;
}

static bool holds(const EnfLightWindow *window, const EnfVec3 *points, uint32_t count) {
    for (uint32_t i = 0; i < window->plane_count; i++) {
        for (uint32_t k = 0; k < count; k++) {
            if (!inside(window->planes[i], points[k])) {
                return false;
            }
        }
    }
    return true;
}

/* A plane through the light and an edge of the window. */
typedef struct Side {
    EnfVec3 n;
    double length; /* of the edge, as an angle's sine */
} Side;

/* The sides of a polygon's cone that have all its points inside: edges too short for a plane of their own have none. */
static uint32_t find_sides(const EnfVec3 *points, uint32_t count, Side *sides) {
    uint32_t found = 0;
    EnfVec3 middle = {0, 0, 0};
    for (uint32_t i = 0; i < count; i++) {
        middle = enf_add(middle, points[i]);
    }
    for (uint32_t i = 0; i < count; i++) {
        EnfVec3 a = enf_normalize(points[i]), b = enf_normalize(points[(i + 1) % count]);
        EnfVec3 n = enf_cross(a, b);
        double length = enf_length(n);
        if (length < ENF_TOL_LIGHT) {
            continue;
        }
        n = enf_scale(n, (enf_dot(n, middle) < 0 ? -1 : 1) / length);
        bool bounds_all = true;
        for (uint32_t k = 0; k < count && bounds_all; k++) {
            bounds_all = inside(n, points[k]);
        }
        if (bounds_all) {
            sides[found].n = n;
            sides[found++].length = length;
        }
    }
    return found;
}

static void set_planes(EnfLightWindow *window) {
    Side sides[ENF_LIGHT_POINTS];
    uint32_t count = find_sides(window->points, window->point_count, sides);
    while (count > ENF_LIGHT_PLANES) {
        uint32_t shortest = 0;
        for (uint32_t i = 1; i < count; i++) {
            shortest = sides[i].length < sides[shortest].length ? i : shortest;
        }
        count--;
        memmove(&sides[shortest], &sides[shortest + 1], (count - shortest) * sizeof *sides);
    }
    window->plane_count = count;
    for (uint32_t i = 0; i < count; i++) {
        window->planes[i] = sides[i].n;
    }
}

/* The half-spaces that hold both windows' polygons; their points, if they fit. */
static void merge(EnfLightWindow *into, const EnfLightWindow *from) {
    EnfVec3 planes[2 * ENF_LIGHT_PLANES];
    uint32_t count = 0;
    const EnfLightWindow *pair[2] = {into, from};
    for (int which = 0; which < 2; which++) {
        const EnfLightWindow *one = pair[which], *other = pair[1 - which];
        for (uint32_t i = 0; i < one->plane_count && other->point_count > 0; i++) {
            EnfLightWindow single = {.plane_count = 1, .planes = {one->planes[i]}};
            if (holds(&single, other->points, other->point_count)) {
                planes[count++] = one->planes[i];
            }
        }
    }
    into->plane_count = count < ENF_LIGHT_PLANES ? count : ENF_LIGHT_PLANES;
    memcpy(into->planes, planes, into->plane_count * sizeof *planes);
    if (into->point_count + from->point_count > ENF_LIGHT_POINTS) {
        into->plane_count = 0; /* what it holds is no longer known: all is lit */
        into->point_count = 0;
        return;
    }
    memcpy(into->points + into->point_count, from->points, from->point_count * sizeof *from->points);
    into->point_count += from->point_count;
}

static double alignment(const EnfLightWindow *a, const EnfLightWindow *b) {
    EnfVec3 sums[2] = {{0, 0, 0}, {0, 0, 0}};
    const EnfLightWindow *pair[2] = {a, b};
    for (int which = 0; which < 2; which++) {
        for (uint32_t i = 0; i < pair[which]->point_count; i++) {
            sums[which] = enf_add(sums[which], enf_normalize(pair[which]->points[i]));
        }
    }
    return enf_dot(enf_normalize(sums[0]), enf_normalize(sums[1]));
}

/* ---- windows of a cell ------------------------------------------------------------------------------------------ */

/* Is all that the window shows lit already through another one of its cell? Then its continuations are, too. */
static bool covered(const EnfLightFlow *flow, const EnfLightWindow *window) {
    for (uint32_t i = flow->cell_head[window->cell]; i != ENF_NONE; i = flow->windows.data[i].next) {
        const EnfLightWindow *other = &flow->windows.data[i];
        if (other->plane_count == 0 || (window->point_count > 0 && holds(other, window->points, window->point_count))) {
            return true;
        }
    }
    return false;
}

/* Adds a window; *number is its place. */
static bool add_window(EnfLightFlow *flow, const EnfLightWindow *window, uint32_t *number) {
    if (!ENF_ARRAY_ROOM(&flow->windows, 1)) {
        return false;
    }
    *number = flow->windows.count++;
    flow->windows.data[*number] = *window;
    flow->windows.data[*number].next = flow->cell_head[window->cell];
    flow->cell_head[window->cell] = *number;
    return true;
}

/* ---- flow ------------------------------------------------------------------------------------------------------- */

typedef struct Run {
    EnfLightFlow *flow;
    EnfVec3 light;
    double range;
    uint32_t depth, steps;
    Frame *frames;
} Run;

/* The portal's points relative to the light; false if it is out of reach or no light passes. */
static bool reachable(const Run *run, const EnfLayoutPortal *portal, EnfVec3 *points, bool *whole) {
    *whole = portal->point_count == 0;
    if (*whole) {
        return true;
    }
    uint32_t count = portal->point_count < ENF_POLYGON_MAX ? portal->point_count : ENF_POLYGON_MAX;
    for (uint32_t i = 0; i < count; i++) {
        points[i] = enf_sub(enf_grid_point(run->flow->layout->points[portal->point_first + i]), run->light);
    }
    double distance2 = enf_polygon_distance2(points, count);
    if (distance2 > run->range * run->range) {
        return false;
    }
    if (distance2 < NEAR * NEAR || (portal->flags & ENF_PORTAL_NONPLANAR)) {
        *whole = true;
        return true;
    }
    EnfPlane plane = enf_plane_from_polygon(points, count);
    return plane.d < 0; /* the light is behind: in the source */
}

/* The light's window behind a portal of the frame's cell; false if nothing of it gets through. */
static bool narrow(const Run *run, const Frame *frame, const EnfLayoutPortal *portal, EnfLightWindow *out) {
    const EnfLightWindow *parent = &run->flow->windows.data[frame->window];
    bool whole;
    if (!reachable(run, portal, out->points, &whole)) {
        return false;
    }
    if (whole) {
        *out = *parent;
        out->cell = portal->target;
        return true;
    }
    out->cell = portal->target;
    out->point_count = portal->point_count < ENF_POLYGON_MAX ? portal->point_count : ENF_POLYGON_MAX;
    for (uint32_t i = 0; i < parent->plane_count && out->point_count >= 3; i++) {
        out->point_count = clip(out->points, out->point_count, parent->planes[i]);
    }
    if (out->point_count < 3) {
        return false;
    }
    set_planes(out);
    return true;
}

static void push(Run *run, uint32_t window, uint32_t cell, uint32_t entered_by) {
    const EnfLightFlow *flow = run->flow;
    run->frames[run->depth++] = (Frame){window, cell, flow->portal_first[cell], flow->portal_first[cell + 1], entered_by};
    if (entered_by != ENF_NONE) {
        flow->on_chain[entered_by] = 1;
    }
}

static void pop(Run *run) {
    uint32_t entered_by = run->frames[--run->depth].entered_by;
    if (entered_by != ENF_NONE) {
        run->flow->on_chain[entered_by] = 0;
    }
}

/* A limit was hit: lights whole every cell that portals within range lead to. The windows' array is the queue. */
static bool flood(Run *run) {
    EnfLightFlow *flow = run->flow;
    EnfLightWindow all = {.cell = flow->windows.data[0].cell};
    for (uint32_t i = 0; i < flow->windows.count; i++) {
        flow->cell_head[flow->windows.data[i].cell] = ENF_NONE;
    }
    flow->windows.count = 0;
    uint32_t number;
    if (!add_window(flow, &all, &number)) {
        return false;
    }
    for (uint32_t i = 0; i < flow->windows.count; i++) {
        uint32_t cell = flow->windows.data[i].cell;
        for (uint32_t p = flow->portal_first[cell]; p < flow->portal_first[cell + 1]; p++) {
            const EnfLayoutPortal *portal = &flow->layout->portals[p];
            EnfVec3 points[ENF_LIGHT_POINTS];
            double reach2 = run->range * run->range;
            uint32_t count = portal->point_count < ENF_POLYGON_MAX ? portal->point_count : ENF_POLYGON_MAX;
            for (uint32_t k = 0; k < count; k++) {
                points[k] = enf_sub(enf_grid_point(flow->layout->points[portal->point_first + k]), run->light);
            }
            bool near = count == 0 || enf_polygon_distance2(points, count) <= reach2;
            all.cell = portal->target;
            if (near && !portal->has_transform && flow->cell_head[portal->target] == ENF_NONE &&
                !add_window(flow, &all, &number)) {
                return false;
            }
        }
    }
    return true;
}

/* One portal of the innermost frame. *limit: too deep, or too many steps. */
static bool step(Run *run, bool *limit) {
    EnfLightFlow *flow = run->flow;
    Frame *frame = &run->frames[run->depth - 1];
    if (frame->next_portal == frame->end_portal) {
        pop(run);
        return true;
    }
    uint32_t index = frame->next_portal++;
    const EnfLayoutPortal *portal = &flow->layout->portals[index];
    EnfLightWindow window;
    uint32_t number;
    if (portal->has_transform || flow->on_chain[index] || !narrow(run, frame, portal, &window) || covered(flow, &window)) {
        return true;
    }
    *limit = run->depth == DEPTH_MAX || ++run->steps > STEPS_MAX;
    if (*limit) {
        return true;
    }
    if (!add_window(flow, &window, &number)) {
        return false;
    }
    push(run, number, window.cell, index);
    return true;
}

/* Leaves at most ENF_LIGHT_WINDOWS windows a cell: the oldest, widened by the others. Dropped ones get cell ENF_NONE. */
static void merge_windows(EnfLightFlow *flow) {
    for (uint32_t i = 0; i < flow->windows.count; i++) {
        flow->cell_head[flow->windows.data[i].cell] = ENF_NONE;
    }
    for (uint32_t i = 0; i < flow->windows.count; i++) {
        EnfLightWindow *window = &flow->windows.data[i], *nearest = NULL;
        uint32_t kept = 0;
        double best = -2;
        for (uint32_t k = flow->cell_head[window->cell]; k != ENF_NONE; k = flow->windows.data[k].next, kept++) {
            double similar = alignment(&flow->windows.data[k], window);
            if (similar > best) {
                best = similar;
                nearest = &flow->windows.data[k];
            }
        }
        if (kept == ENF_LIGHT_WINDOWS) {
            merge(nearest, window);
            window->cell = ENF_NONE;
        } else {
            window->next = flow->cell_head[window->cell];
            flow->cell_head[window->cell] = i;
        }
    }
    for (uint32_t i = 0; i < flow->windows.count; i++) {
        if (flow->windows.data[i].cell != ENF_NONE) {
            flow->cell_head[flow->windows.data[i].cell] = ENF_NONE;
        }
    }
}

bool enf_light_flow_run(EnfLightFlow *flow, uint32_t cell, EnfVec3 position, double range) {
    Run run = {flow, position, range, 0, 0, flow->frames};
    EnfLightWindow own = {.cell = cell};
    bool ok, limit = false;
    uint32_t number;
    flow->windows.count = 0;
    ok = add_window(flow, &own, &number);
    if (ok) {
        push(&run, number, cell, ENF_NONE);
    }
    while (ok && run.depth > 0 && !limit) {
        ok = step(&run, &limit);
    }
    while (run.depth > 0) {
        pop(&run);
    }
    if (ok && limit) {
        ok = flood(&run);
    }
    merge_windows(flow);
    return ok;
}

/* ---- memory ----------------------------------------------------------------------------------------------------- */

bool enf_light_flow_create(EnfLightFlow *flow, const EnfLayout *layout) {
    memset(flow, 0, sizeof *flow);
    flow->layout = layout;
    flow->portal_first = calloc((size_t)layout->cell_count + 2, sizeof *flow->portal_first);
    flow->cell_head = malloc(((size_t)layout->cell_count + 1) * sizeof *flow->cell_head);
    flow->on_chain = calloc((size_t)layout->portal_count + 1, 1);
    flow->frames = malloc((DEPTH_MAX + 1) * sizeof(Frame));
    if (!flow->portal_first || !flow->cell_head || !flow->on_chain || !flow->frames) {
        return false;
    }
    memset(flow->cell_head, 0xff, ((size_t)layout->cell_count + 1) * sizeof *flow->cell_head);
    for (uint32_t i = 0; i < layout->portal_count; i++) {
        flow->portal_first[layout->portals[i].source + 1]++;
    }
    for (uint32_t c = 0; c < layout->cell_count; c++) {
        flow->portal_first[c + 1] += flow->portal_first[c];
    }
    return true;
}

void enf_light_flow_free(EnfLightFlow *flow) {
    free(flow->portal_first);
    free(flow->cell_head);
    free(flow->on_chain);
    free(flow->frames);
    free(flow->windows.data);
    memset(flow, 0, sizeof *flow);
}
