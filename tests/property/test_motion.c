/* Motions: states are pure functions of the tick, and bounds hold every state. Oracles: dense sampling of every tick (and between
 * ticks, by a finer clock), and interval evaluation of the curves in Bernstein form, which shares no code with the engine. */
#include "harness/random_motion.h"

#include <math.h>

static bool box_holds(EnfBox3 box, EnfVec3 p) {
    return enf_box3_contains(box, p);
}

/* The corners and the middle of the local box at `tick`. */
static void check_state_in(const EnfMotion *motion, const EnfBox3 *local, int64_t tick, EnfBox3 box) {
    EnfPose pose = enf_motion_state(motion, tick);
    for (int i = 0; i < 9; i++) {
        EnfVec3 p = i == 8 ? enf_scale(enf_add(local->min, local->max), 0.5)
                           : enf_v3(i & 1 ? local->max.x : local->min.x, i & 2 ? local->max.y : local->min.y,
                                    i & 4 ? local->max.z : local->min.z);
        EnfVec3 at = enf_pose_point(&pose, p);
        if (!box_holds(box, at)) {
            fail_msg("kind %d tick %lld: (%.17g, %.17g, %.17g) is outside its bound", (int)motion->kind, (long long)tick, at.x,
                     at.y, at.z);
        }
    }
}

/* Every tick of short ranges, a sample of long ones. */
static void check_range(EnfTestRng *rng, const EnfMotion *motion, int64_t tick0, int64_t tick1) {
    EnfBox3 local = enf_random_local(rng);
    EnfBox3 box = enf_motion_bound(motion, &local, tick0, tick1);
    for (int i = 0; i < 60; i++) {
        int64_t span = tick1 - tick0;
        int64_t tick = span < 60 ? tick0 + i % (span + 1) : tick0 + (int64_t)(enf_test_u64(rng) % (uint64_t)(span + 1));
        check_state_in(motion, &local, tick, box);
    }
    check_state_in(motion, &local, tick0, box);
    check_state_in(motion, &local, tick1, box);
}

static void test_path_bounds_hold_every_state(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    for (uint32_t r = 0; r < enf_test_rounds(4000, 200000); r++) {
        EnfRandomPath path;
        enf_random_path(&rng, &path);
        int64_t tick0 = enf_random_tick(&rng);
        check_range(&rng, &path.motion, tick0, tick0 + enf_random_span(&rng));
    }
}

/* A translation alone, cubic, passed once in so many ticks; `times` and `values` must outlive it. */
static EnfMotion cubic_path(uint32_t keys, const float *times, const float *values, uint32_t ticks) {
    EnfMotion motion;
    memset(&motion, 0, sizeof motion);
    motion.kind = ENF_MOTION_PATH;
    motion.as.path.rest = enf_pose_identity();
    motion.as.path.translation = (EnfTrack){ENF_PATH_CUBIC, keys, times, values};
    motion.as.path.seconds = (double)times[keys - 1];
    motion.as.path.period_ticks = ticks;
    return motion;
}

/* One segment of a cubic translation, 1000 ticks long; `values` must outlive it. */
static EnfMotion random_cubic(EnfTestRng *rng, float values[18]) {
    static const float times[2] = {0.0F, 1.0F};
    for (int i = 0; i < 18; i++) {
        values[i] = enf_test_float(rng, -5.0F, 5.0F);
    }
    return cubic_path(2, times, values, 1000);
}

/* A cubic's values over a whole segment lie in the hull of its Bernstein coefficients: the engine's interval must lie within
 * it, and hold a dense sampling of it. So the bound is neither too small nor carelessly large. */
static void test_cubic_bounds_are_tight(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    const EnfBox3 point = {{0, 0, 0}, {0, 0, 0}};
    for (uint32_t r = 0; r < enf_test_rounds(3000, 100000); r++) {
        float values[18];
        EnfMotion motion = random_cubic(&rng, values);
        EnfBox3 box = enf_motion_bound(&motion, &point, 0, 1000);
        double low = HUGE_VAL;
        double high = -HUGE_VAL;
        for (int64_t tick = 0; tick <= 1000; tick++) {
            double x = enf_motion_state(&motion, tick).position.x;
            low = fmin(low, x);
            high = fmax(high, x);
        }
        double p0 = (double)values[3];
        double p1 = (double)values[12];
        const double b[4] = {p0, p0 + (double)values[6] / 3.0, p1 - (double)values[9] / 3.0, p1};
        double hull_low = fmin(fmin(b[0], b[1]), fmin(b[2], b[3]));
        double hull_high = fmax(fmax(b[0], b[1]), fmax(b[2], b[3]));
        assert_true(box.min.x <= low && box.max.x >= high);
        assert_true(box.min.x >= hull_low - 1e-9 && box.max.x <= hull_high + 1e-9);
        assert_true(box.min.x >= low - 1e-4 && box.max.x <= high + 1e-4); /* sampled 1000 times: within second order */
    }
}

/* The blossom of a cubic with these Bernstein coefficients: the coefficients over [t, u] are its values at (t,t,t), (t,t,u), (t,u,u)
 * and (u,u,u). */
static double blossom(const double b[4], double t, double u, double v) {
    double c[3];
    for (int i = 0; i < 3; i++) {
        c[i] = b[i] + (b[i + 1] - b[i]) * t;
    }
    double d0 = c[0] + (c[1] - c[0]) * u;
    double d1 = c[1] + (c[2] - c[1]) * u;
    return d0 + (d1 - d0) * v;
}

/* Intervals that hold the curve between two moments, piece by piece, at every moment and not at ticks alone: the bound must hold all of
 * each, but for what its coefficients stray from the chord (which the curve does not). */
static void check_pieces(const double b[4], double from, double to, double low, double high) {
    enum { PIECES = 32 };
    for (int i = 0; i < PIECES; i++) {
        double t = from + (to - from) * i / PIECES;
        double u = from + (to - from) * (i + 1) / PIECES;
        const double p[4] = {blossom(b, t, t, t), blossom(b, t, t, u), blossom(b, t, u, u), blossom(b, u, u, u)};
        double stray = fmax(fabs(p[1] - (2.0 * p[0] + p[3]) / 3.0), fabs(p[2] - (p[0] + 2.0 * p[3]) / 3.0)) + 1e-9;
        double least = fmin(fmin(p[0], p[1]), fmin(p[2], p[3]));
        double most = fmax(fmax(p[0], p[1]), fmax(p[2], p[3]));
        if (low > least + stray || high < most - stray) {
            fail_msg("[%.17g, %.17g] does not hold [%.17g, %.17g] of the piece [%g, %g]", low, high, least, most, t, u);
        }
    }
}

static void test_bounds_hold_interval_evaluation(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(7);
    const EnfBox3 point = {{0, 0, 0}, {0, 0, 0}};
    for (uint32_t r = 0; r < enf_test_rounds(3000, 100000); r++) {
        float values[18];
        EnfMotion motion = random_cubic(&rng, values);
        int64_t tick0 = enf_test_below(&rng, 1000);
        int64_t tick1 = tick0 + 1 + enf_test_below(&rng, (uint32_t)(1000 - tick0));
        EnfBox3 box = enf_motion_bound(&motion, &point, tick0, tick1);
        const double low[3] = {box.min.x, box.min.y, box.min.z};
        const double high[3] = {box.max.x, box.max.y, box.max.z};
        for (int c = 0; c < 3; c++) {
            double p0 = (double)values[3 + c];
            double p1 = (double)values[12 + c];
            const double b[4] = {p0, p0 + (double)values[6 + c] / 3.0, p1 - (double)values[9 + c] / 3.0, p1};
            check_pieces(b, (double)tick0 / 1000.0, (double)tick1 / 1000.0, low[c], high[c]);
        }
    }
}

/* The state does not depend on what was asked before, nor on how long the world has run. */
static void test_states_are_pure(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(3);
    for (uint32_t r = 0; r < enf_test_rounds(500, 20000); r++) {
        EnfRandomPath path;
        enf_random_path(&rng, &path);
        EnfPathMotion *p = &path.motion.as.path;
        p->wrap = r % 2 ? ENF_WRAP_LOOP : ENF_WRAP_PING_PONG;
        int64_t tick = p->start_tick + (int64_t)enf_test_below(&rng, 2 * p->period_ticks);
        int64_t later = tick + (int64_t)2 * p->period_ticks * (1 + (int64_t)enf_test_below(&rng, 100000));
        EnfPose a = enf_motion_state(&path.motion, tick);
        (void)enf_motion_state(&path.motion, tick + 17);
        EnfPose b = enf_motion_state(&path.motion, later);
        assert_memory_equal(&a, &b, sizeof a);
    }
}

static void test_doors(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(4);
    for (uint32_t r = 0; r < enf_test_rounds(3000, 100000); r++) {
        EnfMotion motion = enf_random_swing(&rng, r % 2 ? ENF_MOTION_HINGE : ENF_MOTION_SLIDE);
        int64_t tick = (int64_t)enf_test_below(&rng, 1000000);
        for (int event = 0; event < 3; event++) {
            double before = enf_swing_position(&motion, tick);
            enf_swing_set(&motion, tick, enf_test_double(&rng, -5.0, 5.0));
            assert_true(enf_swing_position(&motion, tick) == before); /* no jump */
            check_range(&rng, &motion, tick, tick + enf_random_span(&rng) % 5000);
            tick += 1 + (int64_t)enf_test_below(&rng, 200);
            double now = enf_swing_position(&motion, tick);
            assert_true(now >= -3.0 && now <= 3.0);
        }
        assert_true(enf_swing_position(&motion, tick + 1000000000) == motion.as.swing.target);
    }
}

/* A free object anywhere within its speed stays in its bound; the caller's pose is the state. */
static void test_free_objects_stay_within_their_speed(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(5);
    for (uint32_t r = 0; r < enf_test_rounds(3000, 100000); r++) {
        EnfMotion motion;
        memset(&motion, 0, sizeof motion);
        motion.kind = ENF_MOTION_FREE;
        motion.as.free.max_speed = r % 3 ? enf_test_double(&rng, 0.0, 5.0) : 1000.0;
        EnfPose pose = enf_pose_identity();
        pose.position = enf_v3(enf_test_double(&rng, -1e5, 1e5), 0.0, 0.0);
        int64_t pushed = enf_random_tick(&rng);
        enf_free_push(&motion, pushed, pose);
        int64_t tick = pushed + enf_random_span(&rng);
        EnfBox3 local = enf_random_local(&rng);
        EnfBox3 box = enf_motion_bound(&motion, &local, pushed, tick);
        double way = motion.as.free.max_speed * (double)(tick - pushed) / ENF_TICK_RATE;
        EnfVec3 step = enf_normalize(enf_v3(enf_test_double(&rng, -1, 1), enf_test_double(&rng, -1, 1), 1.0));
        EnfMotion moved = motion;
        moved.as.free.pose.position = enf_add(pose.position, enf_scale(step, way));
        check_state_in(&moved, &local, tick, box);
        check_state_in(&motion, &local, tick, box);
    }
}

/* Catmull–Rom passes through its points and has no jump in direction. */
static void test_catmull_rom(void **state) {
    (void)state;
    float times[5] = {0.0F, 1.0F, 2.5F, 3.0F, 5.0F};
    float points[15];
    float values[45];
    EnfTestRng rng = enf_test_rng(6);
    for (int i = 0; i < 15; i++) {
        points[i] = enf_test_float(&rng, -3.0F, 3.0F);
    }
    enf_catmull_rom(times, points, 5, values);
    EnfMotion motion = cubic_path(5, times, values, 300);
    for (int k = 0; k < 5; k++) {
        EnfVec3 at = enf_motion_state(&motion, (int64_t)(60.0F * times[k])).position;
        assert_true(fabs(at.x - (double)points[3 * k]) < 1e-6 && fabs(at.z - (double)points[3 * k + 2]) < 1e-6);
        assert_true(values[9 * k] == values[9 * k + 6]);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_path_bounds_hold_every_state),
    cmocka_unit_test(test_cubic_bounds_are_tight),
    cmocka_unit_test(test_bounds_hold_interval_evaluation),
    cmocka_unit_test(test_states_are_pure),
    cmocka_unit_test(test_doors),
    cmocka_unit_test(test_free_objects_stay_within_their_speed),
    cmocka_unit_test(test_catmull_rom),
};

ENF_TEST_MAIN(tests)
