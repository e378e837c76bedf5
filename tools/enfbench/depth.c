/* The depth pyramid: Greene, Kass & Miller 1993 with the coverage masks of Hasselgren, Andersson & Akenine-Möller 2016.
 *
 * A tile knows two layers: `full`, a depth that all of its samples have or exceed, and `part`, one that the samples of `mask` have
 * or exceed. Polygons that meet in an edge so fill a tile together, which polygons one by one never would. Both depths only grow
 * nearer while a frame is drawn; every rounding is away from hiding:
 *
 *   coordinates are some ten roundings of 2^-53 on at most 2^12 px: below 2^-37 px. A span is taken in by SHRINK = 2^-24 px, a
 *   rectangle let out by as much.
 *   depths are a few roundings of 2^-53 and one of 2^-24 to float: NEARER and FARTHER, 2^-20 off, cover both. */
#include "enfbench/depth.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SHRINK 0x1p-24
#define NEARER (1.0 + 0x1p-20)
#define FARTHER (1.0 - 0x1p-20)
/* Metres before the eye where polygons are cut, and where boxes are too near to say. */
#define CUT 0.0625
enum { TILE = 8, LEVELS = 12, SIDE_MAX = 4096, POINTS_MAX = DEPTH_POLYGON_MAX + 2 };

struct DepthPyramid {
    uint32_t width, height, level_count;
    int32_t wide[LEVELS], high[LEVELS]; /* of a level, in squares */
    float *levels[LEVELS];              /* [0] is `full` of the tiles */
    float *part;
    uint64_t *mask;
    uint64_t *outside;    /* the samples of a tile that lie beyond the picture */
    double *left, *right; /* of a polygon in a row of samples */
};

void bench_depth_destroy(DepthPyramid *depth) {
    if (depth != NULL) {
        for (uint32_t i = 0; i < depth->level_count; i++) {
            free(depth->levels[i]);
        }
        free(depth->part);
        free(depth->mask);
        free(depth->outside);
        free(depth->left);
        free(depth->right);
        free(depth);
    }
}

/* Bits of the samples of a tile whose column is below x and whose row is below y. */
static uint64_t first_samples(int32_t x, int32_t y) {
    uint64_t row = x >= TILE ? 0xffU : x <= 0 ? 0U : (1U << x) - 1U;
    uint64_t bits = 0;
    for (int32_t k = 0; k < TILE && k < y; k++) {
        bits |= row << (TILE * k);
    }
    return bits;
}

static void mark_outside(DepthPyramid *depth) {
    for (int32_t y = 0; y < depth->high[0]; y++) {
        for (int32_t x = 0; x < depth->wide[0]; x++) {
            depth->outside[y * depth->wide[0] + x] = ~first_samples((int32_t)depth->width - TILE * x,
                                                                    (int32_t)depth->height - TILE * y);
        }
    }
}

static size_t squares(const DepthPyramid *depth, uint32_t level) {
    return (size_t)depth->wide[level] * (size_t)depth->high[level];
}

static bool add_level(DepthPyramid *depth, int32_t wide, int32_t high) {
    uint32_t level = depth->level_count++;
    depth->wide[level] = wide;
    depth->high[level] = high;
    depth->levels[level] = calloc(squares(depth, level), sizeof(float));
    return depth->levels[level] != NULL;
}

DepthPyramid *bench_depth_create(uint32_t width_px, uint32_t height_px) {
    DepthPyramid *depth = width_px - 1U < SIDE_MAX && height_px - 1U < SIDE_MAX ? calloc(1, sizeof *depth) : NULL;
    if (depth == NULL) {
        return NULL;
    }
    depth->width = width_px;
    depth->height = height_px;
    int32_t wide = ((int32_t)width_px + TILE - 1) / TILE;
    int32_t high = ((int32_t)height_px + TILE - 1) / TILE;
    bool ok = add_level(depth, wide, high);
    while (wide > 1 || high > 1) {
        wide = (wide + 1) / 2;
        high = (high + 1) / 2;
        ok = add_level(depth, wide, high) && ok;
    }
    depth->part = calloc(squares(depth, 0), sizeof *depth->part);
    depth->mask = calloc(squares(depth, 0), sizeof *depth->mask);
    depth->outside = calloc(squares(depth, 0), sizeof *depth->outside);
    depth->left = calloc(height_px, sizeof *depth->left);
    depth->right = calloc(height_px, sizeof *depth->right);
    if (!ok || !depth->part || !depth->mask || !depth->outside || !depth->left || !depth->right) {
        bench_depth_destroy(depth);
        return NULL;
    }
    mark_outside(depth);
    bench_depth_clear(depth);
    return depth;
}

void bench_depth_clear(DepthPyramid *depth) {
    for (uint32_t i = 0; i < depth->level_count; i++) {
        memset(depth->levels[i], 0, squares(depth, i) * sizeof(float));
    }
    memcpy(depth->mask, depth->outside, squares(depth, 0) * sizeof *depth->mask);
    for (size_t i = 0; i < squares(depth, 0); i++) {
        depth->part[i] = FLT_MAX;
    }
}

EnfVec3 bench_depth_point(const EnfCamera *camera, EnfVec3 p_ws) {
    EnfVec3 p = enf_sub(p_ws, camera->eye_ws);
    return enf_v3(enf_dot(camera->right, p), enf_dot(camera->up, p), enf_dot(camera->forward, p));
}

/* ---- drawing ---------------------------------------------------------------------------------------------------- */

/* A polygon on the picture: corners in pixels; depth is ax * x + ay * y + c there, and between `farthest` and infinity. */
typedef struct Flat {
    double x[POINTS_MAX], y[POINTS_MAX];
    uint32_t count;
    double ax, ay, c, farthest;
} Flat;

/* Keeps what is at least CUT before the eye. */
static uint32_t cut(const EnfVec3 *points, uint32_t count, EnfVec3 out[POINTS_MAX]) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        EnfVec3 a = points[i];
        EnfVec3 b = points[i + 1 < count ? i + 1 : 0];
        if (a.z >= CUT) {
            out[kept++] = a;
        }
        if ((a.z >= CUT) != (b.z >= CUT)) {
            EnfVec3 p = enf_add(a, enf_scale(enf_sub(b, a), (CUT - a.z) / (b.z - a.z)));
            p.z = CUT;
            out[kept++] = p;
        }
    }
    return kept;
}

/* False if it is averted or nothing of it is before the eye. */
static bool flatten(const DepthPyramid *depth, const EnfCamera *camera, const EnfVec3 *points, uint32_t count, Flat *flat) {
    EnfVec3 kept[POINTS_MAX];
    EnfVec3 normal = enf_cross(enf_sub(points[1], points[0]), enf_sub(points[2], points[0]));
    double along = enf_dot(normal, points[0]);
    /* The eye's axes are left-handed: a normal made of them points away from those who see the front. */
    if (!(along > 0x1p-30 * sqrt(enf_dot(normal, normal)))) {
        return false;
    }
    flat->count = cut(points, count, kept);
    if (flat->count < 3) {
        return false;
    }
    double sx = 0.5 * (double)depth->width;
    double sy = 0.5 * (double)depth->height;
    flat->farthest = DBL_MAX;
    for (uint32_t i = 0; i < flat->count; i++) {
        double inverse = 1.0 / kept[i].z;
        flat->x[i] = sx + sx / camera->tan_x * kept[i].x * inverse;
        flat->y[i] = sy + sy / camera->tan_y * kept[i].y * inverse;
        flat->farthest = inverse < flat->farthest ? inverse : flat->farthest;
    }
    /* A ray (X, Y, 1) meets the plane where normal · ray * distance = along. */
    flat->ax = normal.x * camera->tan_x / sx / along;
    flat->ay = normal.y * camera->tan_y / sy / along;
    flat->c = normal.z / along - flat->ax * sx - flat->ay * sy;
    return true;
}

static double clamped(double x, double low, double high) {
    return x < low ? low : x > high ? high : x;
}

/* The first sample at or after a place, the last at or before it; samples are in the middles of pixels. Places are limited to the
 * neighbourhood of the picture; adding SIDE_MAX rounds by 2^-40, far below SHRINK. A call of floor or ceil costs more than a span. */
static inline int32_t first_sample(double x) {
    return SIDE_MAX + 2 - (int32_t)((double)SIDE_MAX + 2.5 - clamped(x, -1.0, SIDE_MAX + 1.0));
}

static inline int32_t last_sample(double x) {
    return (int32_t)(clamped(x, -1.0, SIDE_MAX + 1.0) + 1.5) - 2;
}

/* Where an edge lies in each row of samples; those going down are on the left. Both sides of an edge work from its lower end, so that
 * neighbours leave no gap. */
static void trace_edge(DepthPyramid *depth, const Flat *flat, uint32_t i, int32_t first, int32_t last) {
    uint32_t j = i + 1 < flat->count ? i + 1 : 0;
    bool down = flat->y[j] < flat->y[i];
    uint32_t low = down ? j : i;
    uint32_t high = down ? i : j;
    double rise = flat->y[high] - flat->y[low];
    if (!(rise > 0.0)) {
        return;
    }
    double slope = (flat->x[high] - flat->x[low]) / rise;
    /* Rounded outward: an edge may be traced a little beyond its ends, never short of them. */
    int32_t y0 = first_sample(flat->y[low] - SHRINK);
    int32_t y1 = last_sample(flat->y[high] + SHRINK);
    y0 = y0 > first ? y0 : first;
    y1 = y1 < last ? y1 : last;
    for (int32_t y = y0; y <= y1; y++) {
        double x = flat->x[low] + ((double)y + 0.5 - flat->y[low]) * slope;
        if (down) {
            depth->left[y] = x > depth->left[y] ? x : depth->left[y];
        } else {
            depth->right[y] = x < depth->right[y] ? x : depth->right[y];
        }
    }
}

/* The rows of samples that the polygon reaches; its spans in them. False if none. */
static bool trace(DepthPyramid *depth, const Flat *flat, int32_t *first, int32_t *last) {
    double low = DBL_MAX;
    double high = -DBL_MAX;
    for (uint32_t i = 0; i < flat->count; i++) {
        low = flat->y[i] < low ? flat->y[i] : low;
        high = flat->y[i] > high ? flat->y[i] : high;
    }
    *first = first_sample(low + SHRINK);
    *last = last_sample(high - SHRINK);
    *first = *first > 0 ? *first : 0;
    *last = *last < (int32_t)depth->height ? *last : (int32_t)depth->height - 1;
    for (int32_t y = *first; y <= *last; y++) {
        depth->left[y] = -DBL_MAX;
        depth->right[y] = DBL_MAX;
    }
    for (uint32_t i = 0; i < flat->count && *first <= *last; i++) {
        trace_edge(depth, flat, i, *first, *last);
    }
    return *first <= *last;
}

/* What a polygon covers of a row of tiles: columns of samples in each of its eight rows, and from where to where all are covered. */
typedef struct Strip {
    int32_t x0[TILE], x1[TILE]; /* x1 is the last */
    int32_t least, most;        /* of x0, of x1 */
    int32_t whole0, whole1;     /* tiles [whole0, whole1) are covered whole */
} Strip;

static Strip strip_of(const DepthPyramid *depth, int32_t row, int32_t first, int32_t last) {
    Strip strip;
    int32_t most0 = 0;
    int32_t least1 = (int32_t)depth->width - 1;
    strip.least = (int32_t)depth->width;
    strip.most = -1;
    for (int32_t k = 0; k < TILE; k++) {
        int32_t y = TILE * row + k;
        bool in = y >= first && y <= last && depth->left[y] > -DBL_MAX && depth->right[y] < DBL_MAX;
        int32_t x0 = in ? first_sample(depth->left[y] + SHRINK) : SIDE_MAX;
        int32_t x1 = in ? last_sample(depth->right[y] - SHRINK) : -1;
        strip.x0[k] = x0 > 0 ? x0 : 0;
        strip.x1[k] = x1 < (int32_t)depth->width ? x1 : (int32_t)depth->width - 1;
        if (strip.x0[k] <= strip.x1[k]) {
            strip.least = strip.x0[k] < strip.least ? strip.x0[k] : strip.least;
            strip.most = strip.x1[k] > strip.most ? strip.x1[k] : strip.most;
        }
        most0 = strip.x0[k] > most0 ? strip.x0[k] : most0;
        least1 = strip.x1[k] < least1 ? strip.x1[k] : least1;
    }
    strip.whole0 = (most0 + TILE - 1) / TILE;
    strip.whole1 = (least1 + 1) / TILE;
    return strip;
}

/* `outside` counts as covered where anything is. */
static uint64_t covered(const Strip *strip, int32_t tile, uint64_t outside) {
    uint64_t mask = 0;
    for (int32_t k = 0; k < TILE; k++) {
        int32_t x0 = strip->x0[k] - TILE * tile;
        int32_t x1 = strip->x1[k] - TILE * tile;
        x0 = x0 < 0 ? 0 : x0;
        x1 = x1 >= TILE ? TILE - 1 : x1;
        if (x0 <= x1) {
            mask |= (uint64_t)((0xffU >> (TILE - 1 - x1)) & (0xffU << x0)) << (TILE * k);
        }
    }
    return mask != 0 ? mask | outside : 0;
}

/* The squares above these tiles anew: each is as far as the farthest of its four. */
static void lift(DepthPyramid *depth, int32_t x0, int32_t y0, int32_t x1, int32_t y1) {
    for (uint32_t level = 1; level < depth->level_count; level++) {
        const float *below = depth->levels[level - 1];
        int32_t wide = depth->wide[level - 1];
        int32_t high = depth->high[level - 1];
        x0 /= 2;
        y0 /= 2;
        x1 /= 2;
        y1 /= 2;
        for (int32_t y = y0; y <= y1; y++) {
            const float *a = below + 2 * y * wide;
            const float *b = 2 * y + 1 < high ? a + wide : a;
            for (int32_t x = x0; x <= x1; x++) {
                int32_t next = 2 * x + 1 < wide ? 2 * x + 1 : 2 * x;
                float top = a[2 * x] < a[next] ? a[2 * x] : a[next];
                float bottom = b[2 * x] < b[next] ? b[2 * x] : b[next];
                depth->levels[level][y * depth->wide[level] + x] = top < bottom ? top : bottom;
            }
        }
    }
}

/* A row of tiles while a polygon is drawn into it: its layers, and the polygon's depth at tile x: start + step * x, no farther than
 * `farthest`. */
typedef struct Row {
    float *full, *part;
    uint64_t *mask;
    const uint64_t *outside;
    double start, step, farthest;
} Row;

static Row row_of(DepthPyramid *depth, const Flat *flat, int32_t row) {
    size_t at = (size_t)row * (size_t)depth->wide[0];
    /* The farthest corner of a tile, from its lower left one. */
    double reach = (flat->ax < 0.0 ? TILE * flat->ax : 0.0) + (flat->ay < 0.0 ? TILE * flat->ay : 0.0);
    Row out = {depth->levels[0] + at,
               depth->part + at,
               depth->mask + at,
               depth->outside + at,
               (flat->c + flat->ay * TILE * (double)row + reach) * FARTHER,
               flat->ax * TILE * FARTHER,
               flat->farthest * FARTHER};
    return out;
}

static inline float near_at(const Row *row, int32_t tile) {
    double near = row->start + row->step * (double)tile;
    return (float)(near > row->farthest ? near : row->farthest);
}

/* All of a tile; true if its `full` grew nearer. A half-made layer that is no nearer gives way to a new one. */
static inline bool cover_whole(const Row *row, int32_t tile, float near) {
    bool grows = near > row->full[tile];
    row->full[tile] = grows ? near : row->full[tile];
    if (row->part[tile] <= row->full[tile]) {
        row->mask[tile] = row->outside[tile];
        row->part[tile] = FLT_MAX;
    }
    return grows;
}

static inline bool cover_part(const Row *row, int32_t tile, uint64_t mask, float near) {
    if (!(near > row->full[tile]) || mask == 0) {
        return false;
    }
    row->mask[tile] |= mask;
    row->part[tile] = near < row->part[tile] ? near : row->part[tile];
    return row->mask[tile] == UINT64_MAX && cover_whole(row, tile, row->part[tile]);
}

/* Tiles whose `full` grew nearer. */
typedef struct Grown {
    int32_t x0, y0, x1, y1;
} Grown;

static void draw_strip(const Row *row, const Strip *strip, int32_t number, Grown *grown) {
    int32_t first = INT32_MAX;
    int32_t last = -1;
    for (int32_t tile = strip->least / TILE; tile <= strip->most / TILE; tile++) {
        bool whole = tile >= strip->whole0 && tile < strip->whole1;
        float near = near_at(row, tile);
        bool grows = whole ? cover_whole(row, tile, near)
                           : cover_part(row, tile, covered(strip, tile, row->outside[tile]), near);
        first = grows && first == INT32_MAX ? tile : first;
        last = grows ? tile : last;
    }
    if (last >= 0) {
        grown->x0 = first < grown->x0 ? first : grown->x0;
        grown->x1 = last > grown->x1 ? last : grown->x1;
        grown->y0 = number < grown->y0 ? number : grown->y0;
        grown->y1 = number > grown->y1 ? number : grown->y1;
    }
}

void bench_depth_polygon(DepthPyramid *depth, const EnfCamera *camera, const EnfVec3 *points, uint32_t count) {
    Flat flat;
    Grown grown = {SIDE_MAX, SIDE_MAX, -1, -1};
    int32_t first, last;
    if (count < 3 || count > DEPTH_POLYGON_MAX || !flatten(depth, camera, points, count, &flat) ||
        !trace(depth, &flat, &first, &last)) {
        return;
    }
    for (int32_t row = first / TILE; row <= last / TILE; row++) {
        Strip strip = strip_of(depth, row, first, last);
        if (strip.least <= strip.most) {
            Row tiles = row_of(depth, &flat, row);
            draw_strip(&tiles, &strip, row, &grown);
        }
    }
    if (grown.x0 <= grown.x1) {
        lift(depth, grown.x0, grown.y0, grown.x1, grown.y1);
    }
}

/* ---- asking ----------------------------------------------------------------------------------------------------- */

typedef struct Bounds {
    double x0, y0, x1, y1;
} Bounds;

static void widen(Bounds *bounds, double x, double y) {
    bounds->x0 = x < bounds->x0 ? x : bounds->x0;
    bounds->x1 = x > bounds->x1 ? x : bounds->x1;
    bounds->y0 = y < bounds->y0 ? y : bounds->y0;
    bounds->y1 = y > bounds->y1 ? y : bounds->y1;
}

DepthPlace bench_depth_place(const EnfCamera *camera, EnfBox3 box_ws, DepthRect *rect) {
    EnfVec3 base = bench_depth_point(camera, box_ws.min);
    EnfVec3 size = enf_sub(box_ws.max, box_ws.min);
    EnfVec3 steps[3] = {{camera->right.x * size.x, camera->up.x * size.x, camera->forward.x * size.x},
                        {camera->right.y * size.y, camera->up.y * size.y, camera->forward.y * size.y},
                        {camera->right.z * size.z, camera->up.z * size.z, camera->forward.z * size.z}};
    Bounds bounds = {DBL_MAX, DBL_MAX, -DBL_MAX, -DBL_MAX};
    double nearest = 0.0;
    uint32_t behind = 0;
    for (uint32_t corner = 0; corner < 8; corner++) {
        EnfVec3 p = base;
        for (uint32_t axis = 0; axis < 3; axis++) {
            p = corner >> axis & 1U ? enf_add(p, steps[axis]) : p;
        }
        if (!(p.z >= CUT)) {
            behind++;
            continue;
        }
        double inverse = 1.0 / p.z;
        nearest = inverse > nearest ? inverse : nearest;
        widen(&bounds, p.x * inverse, p.y * inverse);
    }
    if (behind > 0) {
        return DEPTH_AROUND;
    }
    double sx = 0.5 * (double)camera->width_px;
    double sy = 0.5 * (double)camera->height_px;
    double kx = sx / camera->tan_x;
    double ky = sy / camera->tan_y;
    rect->x0 = first_sample(sx + kx * bounds.x0 - SHRINK);
    rect->y0 = first_sample(sy + ky * bounds.y0 - SHRINK);
    rect->x1 = last_sample(sx + kx * bounds.x1 + SHRINK);
    rect->y1 = last_sample(sy + ky * bounds.y1 + SHRINK);
    rect->x0 = rect->x0 > 0 ? rect->x0 : 0;
    rect->y0 = rect->y0 > 0 ? rect->y0 : 0;
    rect->x1 = rect->x1 < (int32_t)camera->width_px ? rect->x1 : (int32_t)camera->width_px - 1;
    rect->y1 = rect->y1 < (int32_t)camera->height_px ? rect->y1 : (int32_t)camera->height_px - 1;
    rect->nearest = (float)(nearest * NEARER);
    return rect->x0 <= rect->x1 && rect->y0 <= rect->y1 ? DEPTH_RECT : DEPTH_OUTSIDE;
}

/* Of a tile: is each sample of the rectangle covered nearer? */
static bool tile_hides(const DepthPyramid *depth, const DepthRect *rect, int32_t x, int32_t y) {
    size_t tile = (size_t)y * (size_t)depth->wide[0] + (size_t)x;
    if (depth->levels[0][tile] > rect->nearest) {
        return true;
    }
    uint64_t asked = first_samples(rect->x1 + 1 - TILE * x, rect->y1 + 1 - TILE * y) &
                     ~(first_samples(rect->x0 - TILE * x, TILE) | first_samples(TILE, rect->y0 - TILE * y));
    return depth->part[tile] > rect->nearest && (asked & ~depth->mask[tile]) == 0;
}

static bool square_hides(const DepthPyramid *depth, const DepthRect *rect, uint32_t level, int32_t x, int32_t y) {
    if (depth->levels[level][y * depth->wide[level] + x] > rect->nearest) {
        return true;
    }
    if (level == 0) {
        return tile_hides(depth, rect, x, y);
    }
    int32_t step = TILE << (level - 1); /* a square of the level below, in samples */
    for (int32_t k = 0; k < 4; k++) {
        int32_t cx = 2 * x + (k & 1);
        int32_t cy = 2 * y + (k >> 1);
        bool apart = cx * step > rect->x1 || (cx + 1) * step <= rect->x0 || cy * step > rect->y1 || (cy + 1) * step <= rect->y0;
        if (!apart && !square_hides(depth, rect, level - 1, cx, cy)) {
            return false;
        }
    }
    return true;
}

bool bench_depth_hides(const DepthPyramid *depth, const DepthRect *rect) {
    /* The lowest level of which at most four squares hold the rectangle. */
    uint32_t level = 0;
    int32_t step = TILE;
    while (rect->x1 / step - rect->x0 / step > 1 || rect->y1 / step - rect->y0 / step > 1) {
        level++;
        step *= 2;
    }
    for (int32_t y = rect->y0 / step; y <= rect->y1 / step; y++) {
        for (int32_t x = rect->x0 / step; x <= rect->x1 / step; x++) {
            if (!square_hides(depth, rect, level, x, y)) {
                return false;
            }
        }
    }
    return true;
}
