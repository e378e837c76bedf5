/* Bounds of motions, proved by interval arithmetic (scenes/motion_oracle): over a range of ticks, at every moment of it,
 *
 *   what the box was seen to reach  <=  the bound                      (no point of it is ever outside)
 *   what it can reach at all        <=  the bound, widened by ERROR    (nor between the moments that were looked at)
 *   the bound                       <=  what it can reach, widened as its way of reckoning says, and by no more
 *
 * The last is how loose it may be: that a path's box is the sum of its places and of its extents, though they need not fall together;
 * that what turns fills a cube about its pivot; that a hinge's steps bulge. How loose it is is printed. */
#include "harness/random_motion.h"

#include <math.h>
#include <stdio.h>

#include "scenes/motion_oracle.h"

#define ROUNDING 0x1p-36 /* of a motion's size: more than both sides round by, and the engine widens by (2^-40) */

static double size_of(EnfBox3 box) {
    EnfVec3 a = box.min;
    EnfVec3 b = box.max;
    return fabs(a.x) + fabs(a.y) + fabs(a.z) + fabs(b.x) + fabs(b.y) + fabs(b.z);
}

static EnfBox3 widened(EnfBox3 box, double by) {
    EnfBox3 out = {enf_sub(box.min, enf_v3(by, by, by)), enf_add(box.max, enf_v3(by, by, by))};
    return out;
}

static EnfBox3 sum(EnfBox3 a, EnfBox3 b) {
    EnfBox3 out = {enf_add(a.min, b.min), enf_add(a.max, b.max)};
    return out;
}

static bool inside(EnfBox3 box, EnfBox3 in) {
    return enf_box3_contains(in, box.min) && enf_box3_contains(in, box.max);
}

/* ---- what is claimed of a bound --------------------------------------------------------------------------------- */

typedef struct Case {
    const EnfMotion *motion;
    EnfBox3 local;
    int64_t tick0, tick1;
    double error;
    EnfBox3 bound; /* the engine's */
    EnfSweep truth;
    EnfBox3 most; /* what the bound may be at most */
} Case;

typedef struct Looseness {
    const char *name;
    double sum, worst;
    uint64_t count, pieces, unknown;
} Looseness;

static bool holds_what_was_seen(const Case *c) {
    return inside(c->truth.inner, c->bound);
}

static bool holds_all_there_is(const Case *c) {
    return inside(c->truth.outer, widened(c->bound, c->error));
}

static bool is_no_looser_than_said(const Case *c) {
    return inside(c->bound, widened(c->most, ROUNDING * size_of(c->most)));
}

static void fail_case(const Case *c, const char *what) {
    const EnfBox3 *boxes[3] = {&c->bound, &c->truth.outer, &c->most};
    const char *const names[3] = {"bound", "truth", "at most"};
    for (int i = 0; i < 3; i++) {
        printf("%-8s [%.17g %.17g] [%.17g %.17g] [%.17g %.17g]\n", names[i], boxes[i]->min.x, boxes[i]->max.x, boxes[i]->min.y,
               boxes[i]->max.y, boxes[i]->min.z, boxes[i]->max.z);
    }
    fail_msg("kind %d, ticks %lld to %lld, error %g: %s", (int)c->motion->kind, (long long)c->tick0, (long long)c->tick1,
             c->error, what);
}

/* The engine's own states lie where the oracle says: it speaks of the same motion. */
static void check_states(const Case *c, EnfTestRng *rng) {
    EnfBox3 near = widened(c->truth.outer, 1e-9 * (1.0 + size_of(c->truth.outer)));
    uint64_t span = (uint64_t)(c->tick1 - c->tick0);
    for (int i = 0; i < 10; i++) {
        int64_t tick = i == 0 ? c->tick0 : i == 1 ? c->tick1 : c->tick0 + (int64_t)(enf_test_u64(rng) % (span + 1));
        EnfPose pose = enf_motion_state(c->motion, tick);
        for (int k = 0; k < 8; k++) {
            EnfVec3 corner = enf_v3(k & 1 ? c->local.max.x : c->local.min.x, k & 2 ? c->local.max.y : c->local.min.y,
                                    k & 4 ? c->local.max.z : c->local.min.z);
            EnfVec3 at = enf_pose_point(&pose, corner);
            if (!enf_box3_contains(c->bound, at) || !enf_box3_contains(near, at)) {
                fail_case(c, "a state is outside");
            }
        }
    }
}

static void count_looseness(const Case *c, Looseness *loose) {
    EnfVec3 has = enf_sub(c->bound.max, c->bound.min);
    EnfVec3 needs = enf_sub(c->truth.outer.max, c->truth.outer.min);
    double times = (has.x + has.y + has.z) / (needs.x + needs.y + needs.z);
    loose->sum += times;
    loose->worst = fmax(loose->worst, times);
    loose->count++;
    loose->pieces += c->truth.pieces;
    loose->unknown += !c->truth.known;
}

static void check_case(const Case *c, EnfTestRng *rng, Looseness *loose) {
    if (!holds_what_was_seen(c)) {
        fail_case(c, "what the box reached is outside");
    }
    if (!holds_all_there_is(c)) {
        fail_case(c, "what the box may reach is outside");
    }
    if (!is_no_looser_than_said(c)) {
        fail_case(c, "looser than said");
    }
    check_states(c, rng);
    count_looseness(c, loose);
}

/* Prints how much wider than the truth the bounds were; at most `mean` times on average. */
static void report(const Looseness *loose, double mean) {
    double average = loose->sum / (double)(loose->count ? loose->count : 1);
    printf("%s: %llu ranges, %llu intervals; bounds %.4f times as wide as the truth, at worst %.3f\n", loose->name,
           (unsigned long long)loose->count, (unsigned long long)loose->pieces, average, loose->worst);
    assert_true(average <= mean);
    assert_true(loose->unknown == 0);
}

/* ---- paths ------------------------------------------------------------------------------------------------------ */

static const EnfBox3 point = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};

/* All that the scale makes of the box, unturned and in its place. */
static EnfBox3 extents(const EnfMotion *motion, const EnfBox3 *local, int64_t tick0, int64_t tick1) {
    EnfMotion sized = *motion;
    sized.as.path.translation.key_count = sized.as.path.rotation.key_count = 0;
    sized.as.path.rest.position = enf_v3(0.0, 0.0, 0.0);
    sized.as.path.rest.rotation = enf_pose_identity().rotation;
    return enf_motion_oracle(&sized, local, tick0, tick1, 1e-9).outer;
}

static double farthest(EnfBox3 box) {
    double x = fmax(fabs(box.min.x), fabs(box.max.x));
    double y = fmax(fabs(box.min.y), fabs(box.max.y));
    double z = fmax(fabs(box.min.z), fabs(box.max.z));
    return sqrt(x * x + y * y + z * z);
}

/* The sum of places and extents; of what turns, of a cube that holds the extents however turned. */
static EnfBox3 most_of_path(const EnfMotion *motion, const EnfBox3 *local, int64_t tick0, int64_t tick1) {
    EnfMotion still = *motion;
    EnfBox3 extent = extents(motion, local, tick0, tick1);
    still.as.path.rotation.key_count = still.as.path.scale.key_count = 0;
    double size = size_of(enf_motion_oracle(&still, &point, tick0, tick1, HUGE_VAL).inner);
    EnfBox3 places = enf_motion_oracle(&still, &point, tick0, tick1, 1e-9 * (1.0 + size)).outer;
    if (motion->as.path.rotation.key_count > 0) {
        return sum(places, widened(point, farthest(extent)));
    }
    EnfMotion turned = {.kind = ENF_MOTION_STILL, .as.still = enf_pose_identity()};
    turned.as.still.rotation = motion->as.path.rest.rotation;
    return sum(places, enf_motion_oracle(&turned, &extent, 0, 0, 0.0).outer);
}

static bool turns(const EnfPathMotion *path) {
    return path->rotation.key_count > 0;
}

static Case path_case(EnfTestRng *rng, const EnfMotion *motion) {
    Case c = {.motion = motion, .local = enf_random_local(rng), .tick0 = enf_random_tick(rng)};
    c.tick1 = c.tick0 + enf_random_span(rng);
    c.most = most_of_path(motion, &c.local, c.tick0, c.tick1);
    double reach = farthest(extents(motion, &c.local, c.tick0, c.tick1));
    /* Where several tracks run, intervals forget which values fall together, and narrow no faster than the pieces of time. */
    bool one = !turns(&motion->as.path) && (motion->as.path.translation.key_count == 0 || motion->as.path.scale.key_count == 0);
    c.error = one ? 0x1p-30 * size_of(c.most) : 0x1p-10 * reach;
    c.bound = enf_motion_bound(motion, &c.local, c.tick0, c.tick1);
    c.truth = enf_motion_oracle(motion, &c.local, c.tick0, c.tick1, c.error);
    return c;
}

static void test_paths(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    Looseness turning = {.name = "paths that turn"}, sliding = {.name = "paths that do not"};
    for (uint32_t r = 0; r < enf_test_rounds(250, 10000); r++) {
        EnfRandomPath path;
        enf_random_path(&rng, &path);
        Case c = path_case(&rng, &path.motion);
        check_case(&c, &rng, turns(&path.motion.as.path) ? &turning : &sliding);
    }
    report(&turning, 10.0);
    report(&sliding, 10.0);
}

/* ---- doors ------------------------------------------------------------------------------------------------------ */

/* Each of eight steps bulges by r (1 - cos(step / 2)), r being the way from the pivot to the farthest corner of any pose's box. */
static EnfBox3 most_of_swing(const Case *c) {
    const EnfSwingMotion *swing = &c->motion->as.swing;
    if (c->motion->kind == ENF_MOTION_SLIDE) {
        return c->truth.outer;
    }
    double step = fabs(enf_swing_position(c->motion, c->tick1) - enf_swing_position(c->motion, c->tick0)) / 8.0;
    EnfBox3 about = {enf_sub(c->truth.outer.min, swing->pivot), enf_sub(c->truth.outer.max, swing->pivot)};
    return widened(c->truth.outer, farthest(about) * (1.0 - cos(0.5 * step)));
}

static void test_doors(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    Looseness loose[2] = {{.name = "hinges"}, {.name = "slides"}};
    for (uint32_t r = 0; r < enf_test_rounds(400, 20000); r++) {
        EnfMotion motion = enf_random_swing(&rng, r % 2 ? ENF_MOTION_SLIDE : ENF_MOTION_HINGE);
        int64_t tick = (int64_t)enf_test_below(&rng, 1000000);
        for (int event = 0; event < 2; event++) {
            enf_swing_set(&motion, tick, enf_test_double(&rng, -5.0, 5.0));
            Case c = {.motion = &motion, .local = enf_random_local(&rng), .tick0 = tick};
            c.tick1 = tick + enf_random_span(&rng) % 5000;
            c.bound = enf_motion_bound(&motion, &c.local, c.tick0, c.tick1);
            c.error = r % 2 ? 1e-9 : 1e-4;
            c.truth = enf_motion_oracle(&motion, &c.local, c.tick0, c.tick1, c.error);
            c.most = most_of_swing(&c);
            check_case(&c, &rng, &loose[r % 2]);
            tick += 1 + (int64_t)enf_test_below(&rng, 200);
        }
    }
    report(&loose[0], 2.0);
    report(&loose[1], 1.0001);
}

/* ---- what is steered, and what stands --------------------------------------------------------------------------- */

static void test_free_and_still(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(3);
    Looseness loose[2] = {{.name = "steered"}, {.name = "still"}};
    for (uint32_t r = 0; r < enf_test_rounds(2000, 50000); r++) {
        EnfMotion motion;
        memset(&motion, 0, sizeof motion);
        motion.kind = r % 2 ? ENF_MOTION_STILL : ENF_MOTION_FREE;
        EnfPose pose = {enf_v3(enf_test_double(&rng, -1e5, 1e5), 3.0, enf_test_double(&rng, -1.0, 1.0)),
                        enf_quat_axis_angle(enf_v3(0.0, 0.6, 0.8), enf_test_double(&rng, -3.0, 3.0)),
                        enf_v3(enf_test_double(&rng, -2.0, 2.0), 1.0, enf_test_double(&rng, 0.0, 2.0))};
        int64_t pushed = enf_random_tick(&rng);
        if (r % 2) {
            motion.as.still = pose;
        } else {
            motion.as.free.max_speed = enf_test_chance(&rng, 3) ? 1000.0 : enf_test_double(&rng, 0.0, 5.0);
            enf_free_push(&motion, pushed, pose);
        }
        Case c = {.motion = &motion, .local = enf_random_local(&rng), .tick0 = pushed};
        c.tick1 = pushed + enf_random_span(&rng);
        c.bound = enf_motion_bound(&motion, &c.local, c.tick0, c.tick1);
        c.error = 1e-9 * size_of(c.bound);
        c.truth = enf_motion_oracle(&motion, &c.local, c.tick0, c.tick1, c.error);
        c.most = c.truth.outer;
        check_case(&c, &rng, &loose[r % 2]);
    }
    report(&loose[0], 1.001);
    report(&loose[1], 1.001);
}

/* ---- the proof proves ------------------------------------------------------------------------------------------- */

/* A bound drawn in by a little, on one side where it is as near as may be, is found out; and so is one that is much too wide. */
static void test_a_wrong_bound_is_found_out(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(4);
    for (uint32_t r = 0; r < enf_test_rounds(200, 5000); r++) {
        EnfRandomPath path;
        enf_random_path(&rng, &path);
        path.motion.as.path.rotation.key_count = 0;
        path.motion.as.path.scale.key_count = 0;
        Case c = path_case(&rng, &path.motion);
        assert_true(holds_what_was_seen(&c) && is_no_looser_than_said(&c));
        Case narrow = c, wide = c;
        double little = 4.0 * c.error;
        double *const ends[6] = {&narrow.bound.min.x, &narrow.bound.min.y, &narrow.bound.min.z,
                                 &narrow.bound.max.x, &narrow.bound.max.y, &narrow.bound.max.z};
        *ends[r % 6] += r % 6 < 3 ? little : -little;
        assert_false(holds_what_was_seen(&narrow));
        assert_false(holds_all_there_is(&narrow));
        wide.bound = widened(c.bound, little + 1e-8);
        assert_false(is_no_looser_than_said(&wide));
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_paths),
    cmocka_unit_test(test_doors),
    cmocka_unit_test(test_free_and_still),
    cmocka_unit_test(test_a_wrong_bound_is_found_out),
};

ENF_TEST_MAIN(tests)
