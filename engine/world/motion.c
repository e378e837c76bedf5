/* Motions: pose at a tick, and a box for a range of ticks. Pure functions of motion and tick; integer time (DESIGN §2, §5).
 *
 * A path's tick is reduced to its pass in integers first, so a world that has run 10^9 ticks moves as one that began. Boxes are
 * intervals of position plus a box of the turned and scaled extents: exact where the rotation is constant, the sphere about the
 * pivot where it turns; widened by BOUND_ERROR of the magnitudes, far above the rounding of either side. */
#include "world/world_internal.h"

#include <math.h>

#define BOUND_ERROR 0x1p-40
/* The box of one pose is widened by half as much, so that the box of any state lies within the bound of any range holding it. */
#define POSE_ERROR 0x1p-41

static const double tick_seconds = 1.0 / ENF_TICK_RATE;

EnfPose enf_pose_identity(void) {
    EnfPose pose = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}, {1.0, 1.0, 1.0}};
    return pose;
}

static EnfVec3 rotate(EnfQuat q, EnfVec3 p) {
    EnfVec3 u = enf_v3(q.x, q.y, q.z);
    EnfVec3 t = enf_scale(enf_cross(u, p), 2.0);
    return enf_add(enf_add(p, enf_scale(t, q.w)), enf_cross(u, t));
}

EnfVec3 enf_pose_point(const EnfPose *pose, EnfVec3 p) {
    EnfVec3 scaled = enf_v3(p.x * pose->scale.x, p.y * pose->scale.y, p.z * pose->scale.z);
    return enf_add(pose->position, rotate(pose->rotation, scaled));
}

/* ---- paths ------------------------------------------------------------------------------------------------------ */

/* Ticks from the beginning of the pass, 0..period, and its time. Integers until the last step. */
static uint32_t path_phase(const EnfPathMotion *path, int64_t tick) {
    int64_t period = path->period_ticks;
    int64_t elapsed = tick - path->start_tick;
    if (path->wrap == ENF_WRAP_ONCE) {
        return (uint32_t)(elapsed < 0 ? 0 : elapsed > period ? period : elapsed);
    }
    int64_t cycle = path->wrap == ENF_WRAP_LOOP ? period : 2 * period;
    int64_t phase = elapsed % cycle;
    phase = phase < 0 ? phase + cycle : phase;
    return (uint32_t)(phase > period ? cycle - phase : phase);
}

static double phase_seconds(const EnfPathMotion *path, uint32_t phase) {
    return path->seconds * ((double)phase / (double)path->period_ticks);
}

static EnfPose path_state(const EnfPathMotion *path, int64_t tick) {
    double seconds = phase_seconds(path, path_phase(path, tick));
    EnfPose pose = path->rest;
    double v[ENF_TRACK_MAX];
    if (path->translation.key_count > 0) {
        enf_track_value(&path->translation, 3, seconds, v);
        pose.position = enf_v3(v[0], v[1], v[2]);
    }
    if (path->rotation.key_count > 0) {
        enf_track_value(&path->rotation, 4, seconds, v);
        EnfQuat q = {v[0], v[1], v[2], v[3]};
        pose.rotation = q;
    }
    if (path->scale.key_count > 0) {
        enf_track_value(&path->scale, 3, seconds, v);
        pose.scale = enf_v3(v[0], v[1], v[2]);
    }
    return pose;
}

/* The phases that a range of ticks passes, as one or two runs. Returns how many. */
static int path_runs(const EnfPathMotion *path, int64_t tick0, int64_t tick1, uint32_t runs[2][2]) {
    uint32_t a = path_phase(path, tick0);
    uint32_t b = path_phase(path, tick1);
    runs[0][0] = a < b ? a : b;
    runs[0][1] = a < b ? b : a;
    if (path->wrap == ENF_WRAP_ONCE) {
        return 1;
    }
    int64_t period = path->period_ticks;
    int64_t elapsed = tick0 - path->start_tick;
    int64_t pass0 = elapsed / period - (elapsed % period < 0 ? 1 : 0);
    elapsed = tick1 - path->start_tick;
    int64_t pass1 = elapsed / period - (elapsed % period < 0 ? 1 : 0);
    if (pass1 == pass0) {
        return 1;
    }
    runs[0][0] = 0;
    runs[0][1] = path->period_ticks;
    if (pass1 - pass0 > 1) {
        return 1;
    }
    if (path->wrap == ENF_WRAP_LOOP) { /* over the end and on from the beginning */
        runs[0][0] = a;
        runs[1][0] = 0;
        runs[1][1] = b;
        return 2;
    }
    bool turns_at_end = pass0 % 2 == 0; /* ping-pong: there and back over one end */
    runs[0][0] = turns_at_end ? (a < b ? a : b) : 0;
    runs[0][1] = turns_at_end ? path->period_ticks : (a < b ? b : a);
    return 1;
}

static EnfTrackRange empty_range(void) {
    EnfTrackRange range;
    for (int i = 0; i < ENF_TRACK_MAX; i++) {
        range.low[i] = HUGE_VAL;
        range.high[i] = -HUGE_VAL;
    }
    return range;
}

static EnfBox3 range_over(const EnfPathMotion *path, const EnfTrack *track, EnfVec3 rest, uint32_t runs[2][2], int count) {
    if (track->key_count == 0) {
        EnfBox3 still = {rest, rest};
        return still;
    }
    EnfTrackRange range = empty_range();
    for (int i = 0; i < count; i++) {
        enf_track_range(track, 3, phase_seconds(path, runs[i][0]), phase_seconds(path, runs[i][1]), &range);
    }
    EnfBox3 box = {{range.low[0], range.low[1], range.low[2]}, {range.high[0], range.high[1], range.high[2]}};
    return box;
}

/* ---- extents ---------------------------------------------------------------------------------------------------- */

/* fmin and fmax are calls, for the sake of what is not a number. */
static inline double smaller(double a, double b) {
    return a < b ? a : b;
}

static inline double larger(double a, double b) {
    return a > b ? a : b;
}

/* [a0,a1] × [b0,b1]. */
static void multiply(double a0, double a1, double b0, double b1, double *low, double *high) {
    const double p[4] = {a0 * b0, a0 * b1, a1 * b0, a1 * b1};
    *low = smaller(smaller(p[0], p[1]), smaller(p[2], p[3]));
    *high = larger(larger(p[0], p[1]), larger(p[2], p[3]));
}

/* The local box under every scale of an interval. */
static EnfBox3 scaled_box(const EnfBox3 *local, const EnfBox3 *scale) {
    EnfBox3 out;
    multiply(local->min.x, local->max.x, scale->min.x, scale->max.x, &out.min.x, &out.max.x);
    multiply(local->min.y, local->max.y, scale->min.y, scale->max.y, &out.min.y, &out.max.y);
    multiply(local->min.z, local->max.z, scale->min.z, scale->max.z, &out.min.z, &out.max.z);
    return out;
}

/* A turned box: all eight corners. */
static EnfBox3 turned_box(const EnfBox3 *box, EnfQuat rotation) {
    if (rotation.x == 0.0 && rotation.y == 0.0 && rotation.z == 0.0) { /* what the corners would give */
        return *box;
    }
    EnfBox3 out = enf_box3_empty();
    for (int i = 0; i < 8; i++) {
        EnfVec3 corner = enf_v3(i & 1 ? box->max.x : box->min.x, i & 2 ? box->max.y : box->min.y,
                                i & 4 ? box->max.z : box->min.z);
        out = enf_box3_add(out, rotate(rotation, corner));
    }
    return out;
}

static double farthest(const EnfBox3 *box) {
    EnfVec3 reach = enf_v3(larger(fabs(box->min.x), fabs(box->max.x)), larger(fabs(box->min.y), fabs(box->max.y)),
                           larger(fabs(box->min.z), fabs(box->max.z)));
    return enf_length(reach);
}

/* No less than the distance of any point of the box from the origin. */
static double magnitude(const EnfBox3 *box) {
    return larger(fabs(box->min.x), fabs(box->max.x)) + larger(fabs(box->min.y), fabs(box->max.y)) +
           larger(fabs(box->min.z), fabs(box->max.z));
}

static EnfBox3 cube(double radius) {
    EnfBox3 box = {{-radius, -radius, -radius}, {radius, radius, radius}};
    return box;
}

/* Box sum, widened outward by the error of what made it. */
static EnfBox3 swept(EnfBox3 position, EnfBox3 extent, double error) {
    EnfBox3 out = {enf_add(position.min, extent.min), enf_add(position.max, extent.max)};
    double size = larger(magnitude(&position), 0.0) + magnitude(&extent);
    EnfVec3 margin = enf_v3(error * size, error * size, error * size);
    out.min = enf_sub(out.min, margin);
    out.max = enf_add(out.max, margin);
    return out;
}

static EnfBox3 path_bound(const EnfPathMotion *path, const EnfBox3 *local, int64_t tick0, int64_t tick1) {
    uint32_t runs[2][2] = {{0, 0}, {0, 0}};
    int count = path_runs(path, tick0, tick1, runs);
    EnfBox3 position = range_over(path, &path->translation, path->rest.position, runs, count);
    EnfBox3 scale = range_over(path, &path->scale, path->rest.scale, runs, count);
    EnfBox3 extent = scaled_box(local, &scale);
    bool turns = path->rotation.key_count > 0;
    return swept(position, turns ? cube(farthest(&extent)) : turned_box(&extent, path->rest.rotation), BOUND_ERROR);
}

/* The local box under one scale. */
static EnfBox3 sized_box(const EnfBox3 *local, EnfVec3 scale) {
    EnfVec3 a = enf_v3(local->min.x * scale.x, local->min.y * scale.y, local->min.z * scale.z);
    EnfVec3 b = enf_v3(local->max.x * scale.x, local->max.y * scale.y, local->max.z * scale.z);
    EnfBox3 out = {enf_v3(smaller(a.x, b.x), smaller(a.y, b.y), smaller(a.z, b.z)),
                   enf_v3(larger(a.x, b.x), larger(a.y, b.y), larger(a.z, b.z))};
    return out;
}

static EnfBox3 pose_bound(const EnfPose *pose, const EnfBox3 *local) {
    EnfBox3 extent = sized_box(local, pose->scale);
    EnfBox3 position = {pose->position, pose->position};
    return swept(position, turned_box(&extent, pose->rotation), POSE_ERROR);
}

/* ---- doors ------------------------------------------------------------------------------------------------------ */

static double clamp(double x, double low, double high) {
    return x < low ? low : x > high ? high : x;
}

static double swing_at(const EnfSwingMotion *swing, int64_t tick) {
    int64_t elapsed = tick > swing->event_tick ? tick - swing->event_tick : 0;
    double way = swing->rate * tick_seconds * (double)elapsed;
    double gap = swing->target - swing->from;
    if (way >= fabs(gap)) {
        return swing->target;
    }
    return gap < 0.0 ? swing->from - way : swing->from + way;
}

static EnfPose hinge_pose(const EnfSwingMotion *swing, double angle) {
    EnfQuat turn = enf_quat_axis_angle(swing->axis, angle);
    EnfPose pose = swing->rest;
    pose.rotation = enf_quat_mul(turn, swing->rest.rotation);
    pose.position = enf_add(swing->pivot, rotate(turn, enf_sub(swing->rest.position, swing->pivot)));
    return pose;
}

static EnfPose slide_pose(const EnfSwingMotion *swing, double way) {
    EnfPose pose = swing->rest;
    pose.position = enf_add(pose.position, enf_scale(swing->axis, way));
    return pose;
}

/* A point turning about the axis stays on a circle: over a small angle between two poses it strays from their chord by at most
 * r (1 - cos(step / 2)) in any direction; the range is cut into steps so that this is small. */
static EnfBox3 hinge_bound(const EnfSwingMotion *swing, const EnfBox3 *local, double from, double to) {
    enum { STEPS = 8 };
    EnfBox3 all = enf_box3_empty();
    double radius = 0.0;
    for (int i = 0; i <= STEPS; i++) {
        EnfPose pose = hinge_pose(swing, from + (to - from) * ((double)i / STEPS));
        EnfBox3 box = pose_bound(&pose, local);
        EnfBox3 about = {enf_sub(box.min, swing->pivot), enf_sub(box.max, swing->pivot)};
        radius = fmax(radius, farthest(&about));
        all = enf_box3_union(all, box);
    }
    double half = 0.5 * fabs(to - from) / STEPS;
    double bulge = radius * (half < 0.5 * ENF_PI ? 1.0 - enf_cos(half) : 2.0) + BOUND_ERROR * radius;
    return swept(all, cube(bulge), BOUND_ERROR);
}

static EnfBox3 swing_bound(const EnfMotion *motion, const EnfBox3 *local, int64_t tick0, int64_t tick1) {
    const EnfSwingMotion *swing = &motion->as.swing;
    double from = swing_at(swing, tick0); /* monotone between events, so the ends bound it */
    double to = swing_at(swing, tick1);
    if (motion->kind == ENF_MOTION_HINGE) {
        return hinge_bound(swing, local, from, to);
    }
    EnfPose a = slide_pose(swing, from);
    EnfPose b = slide_pose(swing, to);
    return swept(enf_box3_union(pose_bound(&a, local), pose_bound(&b, local)), cube(0.0), BOUND_ERROR);
}

void enf_swing_set(EnfMotion *motion, int64_t tick, double target) {
    ENF_ASSERT(motion->kind == ENF_MOTION_HINGE || motion->kind == ENF_MOTION_SLIDE);
    EnfSwingMotion *swing = &motion->as.swing;
    swing->from = swing_at(swing, tick);
    swing->target = clamp(target, swing->low, swing->high);
    swing->event_tick = tick;
}

double enf_swing_position(const EnfMotion *motion, int64_t tick) {
    ENF_ASSERT(motion->kind == ENF_MOTION_HINGE || motion->kind == ENF_MOTION_SLIDE);
    return swing_at(&motion->as.swing, tick);
}

/* ---- any motion ------------------------------------------------------------------------------------------------- */

void enf_free_push(EnfMotion *motion, int64_t tick, EnfPose pose) {
    ENF_ASSERT(motion->kind == ENF_MOTION_FREE);
    if (tick > motion->as.free.push_tick) {
        motion->as.free.last = motion->as.free.pose;
    }
    motion->as.free.pose = pose;
    motion->as.free.push_tick = tick;
}

static EnfBox3 free_bound(const EnfFreeMotion *free, const EnfBox3 *local, int64_t tick1) {
    int64_t elapsed = tick1 > free->push_tick ? tick1 - free->push_tick : 0;
    return swept(pose_bound(&free->pose, local), cube(free->max_speed * tick_seconds * (double)elapsed), BOUND_ERROR);
}

EnfPose enf_motion_state(const EnfMotion *motion, int64_t tick) {
    switch (motion->kind) {
    case ENF_MOTION_PATH:
        return path_state(&motion->as.path, tick);
    case ENF_MOTION_HINGE:
        return hinge_pose(&motion->as.swing, swing_at(&motion->as.swing, tick));
    case ENF_MOTION_SLIDE:
        return slide_pose(&motion->as.swing, swing_at(&motion->as.swing, tick));
    case ENF_MOTION_FREE:
        if (motion->as.free.ask != NULL) {
            return motion->as.free.ask(motion->as.free.user, tick);
        }
        return tick < motion->as.free.push_tick ? motion->as.free.last : motion->as.free.pose;
    case ENF_MOTION_CALLBACK:
        return motion->as.callback.state(motion->as.callback.user, tick);
    case ENF_MOTION_STILL:
        break;
    }
    return motion->as.still;
}

EnfBox3 enf_motion_bound(const EnfMotion *motion, const EnfBox3 *local, int64_t tick0, int64_t tick1) {
    ENF_ASSERT(tick0 <= tick1);
    switch (motion->kind) {
    case ENF_MOTION_PATH:
        return path_bound(&motion->as.path, local, tick0, tick1);
    case ENF_MOTION_HINGE:
    case ENF_MOTION_SLIDE:
        return swing_bound(motion, local, tick0, tick1);
    case ENF_MOTION_FREE:
        return free_bound(&motion->as.free, local, tick1);
    case ENF_MOTION_CALLBACK:
        return motion->as.callback.bound(motion->as.callback.user, local, tick0, tick1);
    case ENF_MOTION_STILL:
        break;
    }
    return pose_bound(&motion->as.still, local);
}
