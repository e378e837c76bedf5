/* Where a mover's box can be, by interval arithmetic: see the header. A place of the box is T + R (S p), p in the box; over an interval
 * of time T, R and S are intervals, and the box's farthest point along an axis is the sum of the farther ends. */
#include "scenes/motion_oracle.h"
#include "scenes/interval.h"

#include <string.h>

enum { PIECES_MAX = 400000, DEPTH_MAX = 60, COARSE = 64 };

/* The farthest points of a box along each axis, for times of an interval: both ends of the box are known to within intervals. */
typedef struct Reach {
    EnfInterval top[3], bottom[3];
} Reach;

typedef struct Turner {
    EnfInterval still[3], cosine[3], sine[3]; /* of one corner: still + cosine cos(angle) + sine sin(angle) */
} Turner;

typedef struct Search Search;
typedef void (*OverFn)(const Search *search, double from, double to, Reach *reach);

struct Search {
    const EnfMotion *motion;
    const EnfBox3 *local;
    OverFn over;
    uint32_t keys[3]; /* of a path: the segment of translation, rotation and scale that holds the piece */
    Turner corners[8];
    double error;
    EnfSweep sweep;
};

/* ---- boxes ------------------------------------------------------------------------------------------------------ */

static void at_of(EnfVec3 v, EnfInterval out[3]) {
    out[0] = enf_iv(v.x);
    out[1] = enf_iv(v.y);
    out[2] = enf_iv(v.z);
}

/* The rotation of a quaternion of any length; entries are sines and cosines, whatever the intervals make of them. */
static void matrix(const EnfInterval q[4], EnfInterval m[3][3]) {
    EnfInterval s[4], size = enf_iv(0.0);
    for (int i = 0; i < 4; i++) {
        s[i] = enf_iv_square(q[i]);
        size = enf_iv_add(size, s[i]);
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        int k = (i + 2) % 3;
        EnfInterval two = enf_iv_div(enf_iv(2.0), size);
        EnfInterval product = enf_iv_mul(q[i], q[j]);
        EnfInterval turn = enf_iv_mul(q[3], q[k]);
        EnfInterval straight = enf_iv_sub(enf_iv_add(s[3], s[i]), enf_iv_add(s[j], s[k]));
        m[i][i] = enf_iv_clip(enf_iv_div(straight, size), -1.0, 1.0);
        m[i][j] = enf_iv_clip(enf_iv_mul(two, enf_iv_sub(product, turn)), -1.0, 1.0);
        m[j][i] = enf_iv_clip(enf_iv_mul(two, enf_iv_add(product, turn)), -1.0, 1.0);
        if (size.lo <= 0.0) {
            m[i][i] = m[i][j] = m[j][i] = (EnfInterval){-1.0, 1.0};
        }
    }
}

/* Of the points T + R (S p), the farthest. */
static void reach_of(const EnfInterval t[3], const EnfInterval q[4], const EnfInterval s[3], const EnfBox3 *local,
                     Reach *reach) {
    const double low[3] = {local->min.x, local->min.y, local->min.z};
    const double high[3] = {local->max.x, local->max.y, local->max.z};
    EnfInterval m[3][3];
    matrix(q, m);
    for (int d = 0; d < 3; d++) {
        reach->top[d] = reach->bottom[d] = t[d];
        for (int i = 0; i < 3; i++) {
            EnfInterval factor = enf_iv_mul(m[d][i], s[i]);
            EnfInterval a = enf_iv_mul(factor, enf_iv(low[i]));
            EnfInterval b = enf_iv_mul(factor, enf_iv(high[i]));
            EnfInterval most = {a.lo > b.lo ? a.lo : b.lo, a.hi > b.hi ? a.hi : b.hi};
            EnfInterval least = {a.lo < b.lo ? a.lo : b.lo, a.hi < b.hi ? a.hi : b.hi};
            reach->top[d] = enf_iv_add(reach->top[d], most);
            reach->bottom[d] = enf_iv_add(reach->bottom[d], least);
        }
    }
}

static void reach_of_pose(const EnfPose *pose, const EnfInterval t[3], const EnfBox3 *local, Reach *reach) {
    const EnfInterval q[4] = {enf_iv(pose->rotation.x), enf_iv(pose->rotation.y), enf_iv(pose->rotation.z),
                              enf_iv(pose->rotation.w)};
    EnfInterval s[3];
    at_of(pose->scale, s);
    reach_of(t, q, s, local, reach);
}

/* ---- tracks ----------------------------------------------------------------------------------------------------- */

static const float *value_of(const EnfTrack *track, uint32_t components, uint32_t key) {
    return track->kind == ENF_PATH_CUBIC ? track->values + (size_t)(3 * key + 1) * components
                                         : track->values + (size_t)key * components;
}

/* The blossom of a cubic in Bernstein form: over [a, b] the coefficients are its values at (a,a,a), (a,a,b), (a,b,b), (b,b,b), and the
 * curve lies in their hull (Farin). */
static EnfInterval blossom(const EnfInterval b[4], double t, double u, double v) {
    const double at[3] = {t, u, v};
    EnfInterval c[4];
    memcpy(c, b, sizeof c);
    for (int round = 0; round < 3; round++) {
        for (int i = 0; i < 3 - round; i++) {
            c[i] = enf_iv_add(c[i], enf_iv_mul(enf_iv_sub(c[i + 1], c[i]), enf_iv(at[round])));
        }
    }
    return c[0];
}

static EnfInterval cubic_over(const EnfInterval b[4], EnfInterval s) {
    EnfInterval all = blossom(b, s.lo, s.lo, s.lo);
    all = enf_iv_hull(all, blossom(b, s.lo, s.lo, s.hi));
    all = enf_iv_hull(all, blossom(b, s.lo, s.hi, s.hi));
    return enf_iv_hull(all, blossom(b, s.hi, s.hi, s.hi));
}

static void normalize(const float *from, EnfInterval out[4]) {
    EnfInterval size = enf_iv(0.0);
    for (int i = 0; i < 4; i++) {
        size = enf_iv_add(size, enf_iv_square(enf_iv((double)from[i])));
    }
    for (int i = 0; i < 4; i++) {
        out[i] = enf_iv_div(enf_iv((double)from[i]), enf_iv_sqrt(size));
    }
}

/* Along the great circle from p to q: p cos + r sin of a part of the angle between them, r in their plane and upright to p. */
static void arc(const EnfInterval p[4], const EnfInterval q[4], EnfInterval cosine, EnfInterval s, EnfInterval out[4]) {
    EnfInterval sine = enf_iv_sqrt(enf_iv_sub(enf_iv(1.0), enf_iv_square(cosine)));
    EnfInterval part = enf_iv_mul(s, enf_iv_angle(sine, cosine));
    EnfInterval c = enf_iv_cos(part);
    EnfInterval d = enf_iv_div(enf_iv_sin(part), sine);
    for (int i = 0; i < 4; i++) {
        EnfInterval upright = enf_iv_sub(q[i], enf_iv_mul(cosine, p[i]));
        out[i] = enf_iv_add(enf_iv_mul(p[i], c), enf_iv_mul(upright, d));
    }
}

/* Rotations of linear tracks: the short way round, and along the chord where the two are nearly the same (cosine 0.9999). */
static void slerp_over(const float *a, const float *b, EnfInterval s, EnfInterval out[4]) {
    EnfInterval p[4], q[4], cosine = enf_iv(0.0);
    normalize(a, p);
    normalize(b, q);
    for (int i = 0; i < 4; i++) {
        cosine = enf_iv_add(cosine, enf_iv_mul(p[i], q[i]));
    }
    if (cosine.lo <= 0.0 && cosine.hi >= 0.0) { /* either way round */
        out[0] = out[1] = out[2] = out[3] = (EnfInterval){-1.0, 1.0};
        return;
    }
    for (int i = 0; i < 4 && cosine.hi < 0.0; i++) {
        q[i] = enf_iv_neg(q[i]);
    }
    cosine = cosine.hi < 0.0 ? enf_iv_neg(cosine) : cosine;
    if (cosine.lo < 0.9999) {
        arc(p, q, enf_iv_clip(cosine, 0.0, 0.9999), s, out);
    }
    for (int i = 0; i < 4 && cosine.hi >= 0.9999; i++) {
        EnfInterval chord = enf_iv_add(p[i], enf_iv_mul(enf_iv_sub(q[i], p[i]), s));
        out[i] = cosine.lo < 0.9999 ? enf_iv_hull(out[i], chord) : chord;
    }
}

/* One component of a segment, over a part of it. */
static EnfInterval component_over(const EnfTrack *track, uint32_t components, uint32_t key, uint32_t c, EnfInterval s) {
    const float *p0 = value_of(track, components, key);
    EnfInterval v0 = enf_iv((double)p0[c]);
    if (track->kind == ENF_PATH_STEP) {
        return v0;
    }
    const float *p1 = value_of(track, components, key + 1);
    EnfInterval v1 = enf_iv((double)p1[c]);
    if (track->kind == ENF_PATH_LINEAR) {
        return enf_iv_add(v0, enf_iv_mul(enf_iv_sub(v1, v0), s));
    }
    EnfInterval span = enf_iv_sub(enf_iv((double)track->times[key + 1]), enf_iv((double)track->times[key]));
    EnfInterval third = enf_iv_div(span, enf_iv(3.0));
    EnfInterval rise = enf_iv_mul(third, enf_iv((double)p0[components + c]));
    EnfInterval fall = enf_iv_mul(third, enf_iv((double)(p1 - components)[c]));
    const EnfInterval b[4] = {v0, enf_iv_add(v0, rise), enf_iv_sub(v1, fall), v1};
    return cubic_over(b, s);
}

/* A track over a piece of time that crosses no key, `key` being the last one not after it. */
static void track_over(const EnfTrack *track, uint32_t components, uint32_t key, EnfInterval time, EnfInterval *out) {
    if (key + 1 >= track->key_count || time.lo < (double)track->times[0]) {
        for (uint32_t c = 0; c < components; c++) {
            out[c] = enf_iv((double)value_of(track, components, key)[c]);
        }
        return;
    }
    EnfInterval begin = enf_iv((double)track->times[key]);
    EnfInterval span = enf_iv_sub(enf_iv((double)track->times[key + 1]), begin);
    EnfInterval s = enf_iv_clip(enf_iv_div(enf_iv_sub(time, begin), span), 0.0, 1.0);
    if (track->kind == ENF_PATH_LINEAR && components == 4) {
        slerp_over(value_of(track, 4, key), value_of(track, 4, key + 1), s, out);
        return;
    }
    for (uint32_t c = 0; c < components; c++) {
        out[c] = component_over(track, components, key, c, s);
    }
}

static uint32_t key_at(const EnfTrack *track, double seconds) {
    uint32_t key = 0;
    while (key + 1 < track->key_count && (double)track->times[key + 1] <= seconds) {
        key++;
    }
    return key;
}

static void path_over(const Search *search, double from, double to, Reach *reach) {
    const EnfPathMotion *path = &search->motion->as.path;
    EnfInterval time = {from, to}, t[3], q[4], s[3];
    at_of(path->rest.position, t);
    at_of(path->rest.scale, s);
    q[0] = enf_iv(path->rest.rotation.x);
    q[1] = enf_iv(path->rest.rotation.y);
    q[2] = enf_iv(path->rest.rotation.z);
    q[3] = enf_iv(path->rest.rotation.w);
    if (path->translation.key_count > 0) {
        track_over(&path->translation, 3, search->keys[0], time, t);
    }
    if (path->rotation.key_count > 0) {
        track_over(&path->rotation, 4, search->keys[1], time, q);
    }
    if (path->scale.key_count > 0) {
        track_over(&path->scale, 3, search->keys[2], time, s);
    }
    reach_of(t, q, s, search->local, reach);
}

/* ---- doors ------------------------------------------------------------------------------------------------------ */

static EnfInterval swing_position(const EnfSwingMotion *swing, int64_t tick) {
    double elapsed = tick > swing->event_tick ? (double)(tick - swing->event_tick) : 0.0;
    EnfInterval way = enf_iv_div(enf_iv_mul(enf_iv(swing->rate), enf_iv(elapsed)), enf_iv(ENF_TICK_RATE));
    EnfInterval gap = enf_iv_sub(enf_iv(swing->target), enf_iv(swing->from));
    if (gap.hi < 0.0) {
        EnfInterval at = enf_iv_sub(enf_iv(swing->from), way);
        return (EnfInterval){fmax(at.lo, swing->target), fmax(at.hi, swing->target)};
    }
    EnfInterval at = enf_iv_add(enf_iv(swing->from), way);
    return (EnfInterval){fmin(at.lo, swing->target), fmin(at.hi, swing->target)};
}

/* Rodrigues: a point v from the axis k turns to k(k.v) + (v - k(k.v)) cos + (k x v) sin. */
static void make_turner(const EnfSwingMotion *swing, const EnfInterval point[3], Turner *turner) {
    EnfInterval k[3], pivot[3], v[3], along = enf_iv(0.0);
    at_of(swing->axis, k);
    at_of(swing->pivot, pivot);
    for (int d = 0; d < 3; d++) {
        v[d] = enf_iv_sub(point[d], pivot[d]);
        along = enf_iv_add(along, enf_iv_mul(k[d], v[d]));
    }
    for (int d = 0; d < 3; d++) {
        int e = (d + 1) % 3;
        int f = (d + 2) % 3;
        EnfInterval axial = enf_iv_mul(k[d], along);
        turner->still[d] = enf_iv_add(pivot[d], axial);
        turner->cosine[d] = enf_iv_sub(v[d], axial);
        turner->sine[d] = enf_iv_sub(enf_iv_mul(k[e], v[f]), enf_iv_mul(k[f], v[e]));
    }
}

static void make_turners(const EnfSwingMotion *swing, const EnfBox3 *local, Turner turners[8]) {
    EnfInterval at[3];
    at_of(swing->rest.position, at);
    for (int i = 0; i < 8; i++) {
        EnfVec3 corner = enf_v3(i & 1 ? local->max.x : local->min.x, i & 2 ? local->max.y : local->min.y,
                                i & 4 ? local->max.z : local->min.z);
        EnfBox3 point = {corner, corner};
        Reach reach;
        reach_of_pose(&swing->rest, at, &point, &reach);
        make_turner(swing, reach.top, &turners[i]);
    }
}

static void hinge_over(const Search *search, double from, double to, Reach *reach) {
    EnfInterval angle = {from, to};
    EnfInterval cosine = enf_iv_cos(angle);
    EnfInterval sine = enf_iv_sin(angle);
    for (int i = 0; i < 8; i++) {
        const Turner *turner = &search->corners[i];
        for (int d = 0; d < 3; d++) {
            EnfInterval turned = enf_iv_add(enf_iv_mul(turner->cosine[d], cosine), enf_iv_mul(turner->sine[d], sine));
            EnfInterval at = enf_iv_add(turner->still[d], turned);
            if (i == 0) {
                reach->top[d] = reach->bottom[d] = at;
            }
            reach->top[d].lo = fmax(reach->top[d].lo, at.lo);
            reach->top[d].hi = fmax(reach->top[d].hi, at.hi);
            reach->bottom[d].lo = fmin(reach->bottom[d].lo, at.lo);
            reach->bottom[d].hi = fmin(reach->bottom[d].hi, at.hi);
        }
    }
}

static void slide_over(const Search *search, double from, double to, Reach *reach) {
    const EnfSwingMotion *swing = &search->motion->as.swing;
    EnfInterval at[3], axis[3];
    at_of(swing->rest.position, at);
    at_of(swing->axis, axis);
    for (int d = 0; d < 3; d++) {
        at[d] = enf_iv_add(at[d], enf_iv_mul(axis[d], (EnfInterval){from, to}));
    }
    reach_of_pose(&swing->rest, at, search->local, reach);
}

/* ---- what only stands, or may go anywhere ----------------------------------------------------------------------- */

static void pose_over(const Search *search, double from, double to, Reach *reach) {
    bool free = search->motion->kind == ENF_MOTION_FREE;
    const EnfPose *pose = free ? &search->motion->as.free.pose : &search->motion->as.still;
    EnfInterval at[3], way = {from, to};
    at_of(pose->position, at);
    reach_of_pose(pose, at, search->local, reach);
    for (int d = 0; d < 3; d++) {
        reach->top[d] = enf_iv_add(reach->top[d], way);
        reach->bottom[d] = enf_iv_sub(reach->bottom[d], way);
    }
}

static EnfInterval free_way(const EnfFreeMotion *free, int64_t tick) {
    double elapsed = tick > free->push_tick ? (double)(tick - free->push_tick) : 0.0;
    return enf_iv_div(enf_iv_mul(enf_iv(free->max_speed), enf_iv(elapsed)), enf_iv(ENF_TICK_RATE));
}

/* ---- the search ------------------------------------------------------------------------------------------------- */

static EnfBox3 widened(EnfBox3 box, double by) {
    EnfBox3 out = {enf_sub(box.min, enf_v3(by, by, by)), enf_add(box.max, enf_v3(by, by, by))};
    return out;
}

/* What is held by any time of an interval; and what every one of them holds, of a moment: attained. */
static EnfBox3 outer_of(const Reach *reach) {
    EnfBox3 box = {{reach->bottom[0].lo, reach->bottom[1].lo, reach->bottom[2].lo},
                   {reach->top[0].hi, reach->top[1].hi, reach->top[2].hi}};
    return box;
}

static EnfBox3 inner_of(const Reach *reach) {
    EnfBox3 box = {{reach->bottom[0].hi, reach->bottom[1].hi, reach->bottom[2].hi},
                   {reach->top[0].lo, reach->top[1].lo, reach->top[2].lo}};
    return box;
}

/* Side by side: an inner box of a point may be inside out by a rounding, and is not empty for that. */
static EnfBox3 both(EnfBox3 a, EnfBox3 b) {
    EnfBox3 out = {enf_v3(fmin(a.min.x, b.min.x), fmin(a.min.y, b.min.y), fmin(a.min.z, b.min.z)),
                   enf_v3(fmax(a.max.x, b.max.x), fmax(a.max.y, b.max.y), fmax(a.max.z, b.max.z))};
    return out;
}

static void attain(Search *search, double at) {
    Reach reach;
    search->over(search, at, at, &reach);
    search->sweep.inner = both(search->sweep.inner, inner_of(&reach));
}

static void give_up(Search *search, EnfBox3 held) {
    EnfSweep *sweep = &search->sweep;
    sweep->outer = both(sweep->outer, held);
    sweep->known = false;
}

static bool inside(EnfBox3 box, EnfBox3 in) {
    return enf_box3_contains(in, box.min) && enf_box3_contains(in, box.max);
}

/* Halves the piece until what it holds is near what was attained. */
static void search_piece(Search *search, double from, double to, int depth) {
    Reach reach;
    search->over(search, from, to, &reach);
    search->sweep.pieces++;
    EnfBox3 held = outer_of(&reach);
    if (inside(held, widened(search->sweep.inner, search->error))) {
        return;
    }
    double middle = from + 0.5 * (to - from);
    if (depth >= DEPTH_MAX || search->sweep.pieces >= PIECES_MAX || middle <= from || middle >= to) {
        give_up(search, held);
        return;
    }
    attain(search, middle);
    search_piece(search, from, middle, depth + 1);
    search_piece(search, middle, to, depth + 1);
}

static void search_span(Search *search, double from, double to) {
    for (int i = 0; i <= COARSE; i++) { /* so that the first pieces are judged by what is nearly all */
        attain(search, i == COARSE ? to : from + (to - from) * ((double)i / COARSE));
    }
    search_piece(search, from, to, 0);
}

static void choose_keys(Search *search, double seconds) {
    const EnfPathMotion *path = &search->motion->as.path;
    search->keys[0] = key_at(&path->translation, seconds);
    search->keys[1] = key_at(&path->rotation, seconds);
    search->keys[2] = key_at(&path->scale, seconds);
}

/* The first key of any track after `seconds`, or `end`. */
static double next_key(const EnfPathMotion *path, double seconds, double end) {
    const EnfTrack *tracks[3] = {&path->translation, &path->rotation, &path->scale};
    for (int i = 0; i < 3; i++) {
        for (uint32_t k = 0; k < tracks[i]->key_count; k++) {
            double at = (double)tracks[i]->times[k];
            end = at > seconds && at < end ? at : end;
        }
    }
    return end;
}

/* Ticks of one pass, as its times: cut at the keys, so that no piece crosses one. The moment `to` may itself be a key. */
static void search_phases(Search *search, int64_t first, int64_t last) {
    const EnfPathMotion *path = &search->motion->as.path;
    double from = path->seconds * ((double)first / (double)path->period_ticks);
    double to = path->seconds * ((double)last / (double)path->period_ticks);
    while (from < to) {
        double next = next_key(path, from, to);
        choose_keys(search, from);
        search_span(search, from, next);
        from = next;
    }
    choose_keys(search, to);
    search_span(search, to, to);
}

static int64_t pass_of(int64_t elapsed, int64_t period) {
    return elapsed >= 0 ? elapsed / period : -((period - 1 - elapsed) / period);
}

static void search_path(Search *search, int64_t tick0, int64_t tick1) {
    const EnfPathMotion *path = &search->motion->as.path;
    int64_t period = path->period_ticks;
    int64_t a = tick0 - path->start_tick;
    int64_t b = tick1 - path->start_tick;
    if (path->wrap == ENF_WRAP_ONCE) {
        a = a < 0 ? 0 : a > period ? period : a;
        b = b < 0 ? 0 : b > period ? period : b;
        search_phases(search, a, b);
        return;
    }
    if (b - a >= 2 * period) { /* a whole pass is among it */
        search_phases(search, 0, period);
        return;
    }
    for (int64_t pass = pass_of(a, period); pass <= pass_of(b, period); pass++) {
        int64_t first = (a > pass * period ? a : pass * period) - pass * period;
        int64_t last = (b < (pass + 1) * period ? b : (pass + 1) * period) - pass * period;
        bool back = path->wrap == ENF_WRAP_PING_PONG && pass % 2 != 0;
        search_phases(search, back ? period - last : first, back ? period - first : last);
    }
}

static void search_swing(Search *search, int64_t tick0, int64_t tick1) {
    EnfInterval both = enf_iv_hull(swing_position(&search->motion->as.swing, tick0),
                                   swing_position(&search->motion->as.swing, tick1));
    if (search->motion->kind == ENF_MOTION_HINGE) {
        make_turners(&search->motion->as.swing, search->local, search->corners);
        search->over = hinge_over;
    } else {
        search->over = slide_over;
    }
    search_span(search, both.lo, both.hi);
}

EnfSweep enf_motion_oracle(const EnfMotion *motion, const EnfBox3 *local, int64_t tick0, int64_t tick1, double error) {
    Search search;
    memset(&search, 0, sizeof search);
    search.motion = motion;
    search.local = local;
    search.error = error;
    search.sweep.inner = search.sweep.outer = enf_box3_empty();
    search.sweep.known = true;
    if (motion->kind == ENF_MOTION_PATH) {
        search.over = path_over;
        search_path(&search, tick0, tick1);
    } else if (motion->kind == ENF_MOTION_HINGE || motion->kind == ENF_MOTION_SLIDE) {
        search_swing(&search, tick0, tick1);
    } else {
        EnfInterval way = motion->kind == ENF_MOTION_FREE ? free_way(&motion->as.free, tick1) : enf_iv(0.0);
        search.over = pose_over;
        search_span(&search, way.lo, way.hi);
    }
    search.sweep.outer = both(search.sweep.outer, widened(search.sweep.inner, error));
    return search.sweep;
}
