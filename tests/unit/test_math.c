/* Trigonometry against 113-bit series, rounding outward, boxes, affine maps, planes. */
#include "harness/harness.h"
#include "harness/quad.h"

#include <enfilade/math.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- trigonometry ----------------------------------------------------------------------------------------------- */

typedef struct SinCos {
    Quad sin, cos;
} SinCos;

/* Taylor series for |r| <= 0.8: the term r^30 / 30! is below 2^-117. */
static SinCos series(Quad r) {
    SinCos s = {quad(0.0), quad(0.0)};
    Quad term = quad(1.0);
    for (int n = 0; n < 32; n++) {
        Quad signed_term = n & 2 ? -term : term;
        if (n & 1) {
            s.sin += signed_term;
        } else {
            s.cos += signed_term;
        }
        term = term * r / quad(n + 1);
    }
    return s;
}

/* pi/2 to 228 bits, in parts short enough that every product below is exact. */
static SinCos reference(double x) {
    static const double parts[] = {0x1.921fb54400000p+0,   0x1.0b4611a600000p-34,  0x1.3198a2e000000p-69,
                                   0x1.b839a25200000p-104, 0x1.2704453300000p-142, 0x1.cc74020bbea63p-175};
    double k = rint(x / (ENF_PI / 2));
    Quad r = quad(x);
    for (int i = 0; i < 6; i++) {
        r -= quad(k) * quad(parts[i]);
    }
    SinCos s = series(r), turned[4] = {{s.sin, s.cos}, {s.cos, -s.sin}, {-s.sin, -s.cos}, {-s.cos, s.sin}};
    return turned[(int64_t)k & 3];
}

/* The distance of two values in units in the last place of the first. */
static double ulps(double value, Quad exact) {
    double size = fabs(value) > DBL_MIN ? fabs(value) : DBL_MIN;
    int exponent;
    frexp(size, &exponent);
    return (double)(quad_abs(quad(value) - exact) / quad(ldexp(1.0, exponent - 53)));
}

/* One draw a statement: compilers evaluate operands in orders of their own, and the numbers must not depend on that. */
static double hostile_angle(EnfTestRng *rng, unsigned kind) {
    double x = enf_test_double(rng, -1.0, 1.0);
    uint32_t n = enf_test_u32(rng);
    switch (kind) {
    case 0:
        return 4.0 * x;
    case 1:
        return 0x1p20 * x;
    case 2:
        return ldexp(x, -(int)(n % 60));
    case 3: { /* next to a multiple of pi/2 */
        double near = (double)(n % 667000) * (ENF_PI / 2);
        for (uint32_t steps = n >> 30; steps > 0; steps--) {
            near = nextafter(near, 1e9);
        }
        return x < 0.0 ? near : -near;
    }
    case 4: /* next to a multiple of pi/4, where the kernels change */
        return (double)(n % 1000) * (ENF_PI / 4) + 1e-9 * x;
    default: { /* the doubles closest to a multiple of pi/2: 2^-60.5 and 2^-54.3 */
        static const double closest[] = {0x1.6c6cbc45dc8dep+5, 0x1.39c6fd67805a7p+18, 0x1.921fb54442d18p+0};
        return ldexp(closest[n % 3], (int)(n >> 31));
    }
    }
}

/* Measured worst: sine and cosine 0.83 ulp, tangent 1.5. The bound promised is 2. The closest doubles fail by many ulp if
 * pi/2 has three parts instead of four. */
static void sine_cosine_tangent_are_accurate(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    double worst[3] = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < enf_test_rounds(60000, 2000000); i++) {
        double x = hostile_angle(&rng, i % 6);
        SinCos exact = reference(x);
        double errors[3] = {ulps(enf_sin(x), exact.sin), ulps(enf_cos(x), exact.cos), ulps(enf_tan(x), exact.sin / exact.cos)};
        for (int k = 0; k < 3; k++) {
            worst[k] = fmax(worst[k], errors[k]);
        }
        if (!(errors[0] <= 1.0 && errors[1] <= 1.0 && errors[2] <= 1.7)) {
            fail_msg("x = %a: %g %g %g ulp", x, errors[0], errors[1], errors[2]);
        }
    }
    printf("worst: sin %.3f, cos %.3f, tan %.3f ulp\n", worst[0], worst[1], worst[2]);
}

/* The angle whose sine and cosine are known is corrected by one step: atan2(y, x) - a = atan((y c - x s) / (x c + y s)),
 * and that argument is so small that it is its own arc tangent to 2^-150. */
static Quad reference_atan2(double y, double x, double angle) {
    SinCos a = reference(angle);
    return quad(angle) + (quad(y) * a.cos - quad(x) * a.sin) / (quad(x) * a.cos + quad(y) * a.sin);
}

static void arc_tangent_is_accurate(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    double worst = 0.0;
    for (uint32_t i = 0; i < enf_test_rounds(60000, 2000000); i++) {
        double y = enf_test_double(&rng, -4.0, 4.0), x = enf_test_double(&rng, -4.0, 4.0);
        if (i % 4 == 1) { /* near the seams of the reduction */
            static const double seams[] = {0.4375, 0.5, 0.6875, 1.0, 0.0};
            y = x * (seams[enf_test_below(&rng, 5)] + enf_test_double(&rng, -1e-6, 1e-6));
        } else if (i % 4 == 2) {
            y = ldexp(y, (int)enf_test_below(&rng, 200) - 100);
        } else if (i % 4 == 3) {
            double huge = ldexp(1.0, (int)enf_test_below(&rng, 1900) - 950);
            y *= huge;
            x *= huge;
        }
        double angle = enf_atan2(y, x), error = ulps(angle, reference_atan2(y, x, angle));
        worst = fmax(worst, error);
        if (!(error <= 1.7)) {
            fail_msg("atan2(%a, %a) = %a: %g ulp", y, x, angle, error);
        }
    }
    printf("worst: atan2 %.3f ulp\n", worst);
}

static bool same_bits(double a, double b) {
    return memcmp(&a, &b, sizeof a) == 0;
}

static void trigonometry_knows_its_limits(void **state) {
    (void)state;
    const double inf = (double)INFINITY;
    assert_true(same_bits(enf_sin(0.0), 0.0) && same_bits(enf_sin(-0.0), -0.0) && same_bits(enf_tan(-0.0), -0.0));
    assert_true(enf_cos(0.0) == 1.0 && enf_sin(ENF_PI / 2) == 1.0);
    assert_true(isnan(enf_sin(inf)) && isnan(enf_cos(-inf)) && isnan(enf_tan((double)NAN)));
    assert_true(fabs(enf_sin(1e300)) <= 1.0 && fabs(enf_cos(-1e18)) <= 1.0);
    assert_true(same_bits(enf_atan2(0.0, 1.0), 0.0) && same_bits(enf_atan2(-0.0, 1.0), -0.0));
    assert_true(same_bits(enf_atan2(0.0, 0.0), 0.0) && same_bits(enf_atan2(-0.0, 0.0), -0.0));
    assert_true(same_bits(enf_atan2(0.0, -0.0), ENF_PI) && same_bits(enf_atan2(-0.0, -1.0), -ENF_PI));
    assert_true(enf_atan2(1.0, 0.0) == ENF_PI / 2 && enf_atan2(-1.0, -0.0) == -ENF_PI / 2);
    assert_true(enf_atan2(1.0, 1.0) == ENF_PI / 4 && enf_atan2(1.0, -1.0) == 3 * (ENF_PI / 4));
    assert_true(enf_atan2(inf, inf) == ENF_PI / 4 && enf_atan2(-inf, -inf) == -3 * (ENF_PI / 4));
    assert_true(enf_atan2(inf, 1.0) == ENF_PI / 2 && enf_atan2(1.0, -inf) == ENF_PI && enf_atan2(1.0, inf) == 0.0);
    assert_true(isnan(enf_atan2((double)NAN, 1.0)) && isnan(enf_atan2(1.0, (double)NAN)));
    assert_true(enf_atan2(DBL_MAX, DBL_MAX) == ENF_PI / 4 && enf_atan2(0x1p-1074, 0x1p-1074) == ENF_PI / 4);
}

/* One number for every compiler, level of optimisation and processor. */
static void trigonometry_has_the_same_bits_everywhere(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng_fixed(1, 1);
    uint64_t hash = ENF_HASH_START;
    for (uint32_t i = 0; i < 20000; i++) {
        double x = hostile_angle(&rng, i % 6), y = enf_test_double(&rng, -4.0, 4.0);
        double values[4] = {enf_sin(x), enf_cos(x), enf_tan(x), enf_atan2(y, x)};
        hash = enf_hash64(hash, values, sizeof values);
    }
    if (hash != UINT64_C(0xad6b93af50b34f8)) {
        fail_msg("hash %#llx", (unsigned long long)hash);
    }
}

/* ---- outward rounding ------------------------------------------------------------------------------------------- */

static void check_rounding(double value) {
    float low = enf_round_down(value), high = enf_round_up(value);
    if (fabs(value) > (double)FLT_MAX) {
        assert_true(value > 0 ? high == FLT_MAX && low == FLT_MAX : low == -FLT_MAX && high == -FLT_MAX);
        return;
    }
    assert_true((double)low <= value && value <= (double)high);
    assert_true(value >= (double)FLT_MAX || (double)nextafterf(low, FLT_MAX) > value);
    assert_true(value <= (double)-FLT_MAX || (double)nextafterf(high, -FLT_MAX) < value);
}

static void rounding_is_outward_and_tight(void **state) {
    (void)state;
    const double known[] = {0.0,
                            -0.0,
                            1.0,
                            0.1,
                            -0.1,
                            1e-50,
                            -1e-50,
                            1e50,
                            -1e50,
                            (double)FLT_MAX,
                            (double)-FLT_MAX,
                            (double)FLT_MIN,
                            0x1p-149,
                            0x1p-150,
                            0x1.8p-149,
                            0x1.fffffefp127,
                            (double)INFINITY,
                            -(double)INFINITY,
                            0x1.0000001p0,
                            0x1.ffffffffp0};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        check_rounding(known[i]);
    }
    EnfTestRng rng = enf_test_rng(3);
    for (uint32_t i = 0; i < enf_test_rounds(100000, 1000000); i++) {
        check_rounding(ldexp(enf_test_double(&rng, -1.0, 1.0), (int)enf_test_below(&rng, 320) - 170));
    }
    assert_true(enf_round_down((double)NAN) == -FLT_MAX && enf_round_up((double)NAN) == FLT_MAX);
    EnfBox3 box = {{0.1, -0.1, 1e9 + 1}, {0.3, 0.7, 1e9 + 3}};
    EnfBox3 wide = enf_box3_from_f(enf_box3f_outward(box));
    assert_true(enf_box3_contains(wide, box.min) && enf_box3_contains(wide, box.max));
}

/* ---- boxes, vectors, planes ------------------------------------------------------------------------------------- */

static bool near_to(EnfVec3 a, EnfVec3 b, double tolerance) {
    return enf_length(enf_sub(a, b)) <= tolerance;
}

static void boxes_add_up(void **state) {
    (void)state;
    EnfBox3 none = enf_box3_empty();
    assert_true(enf_box3_is_empty(none));
    EnfBox3 point = enf_box3_add(none, enf_v3(1, 2, 3));
    assert_false(enf_box3_is_empty(point));
    assert_true(enf_box3_contains(point, enf_v3(1, 2, 3)) && !enf_box3_contains(point, enf_v3(1, 2, 3.1)));
    EnfBox3 box = enf_box3_union(point, enf_box3_add(none, enf_v3(-1, 5, 0)));
    assert_true(near_to(box.min, enf_v3(-1, 2, 0), 0) && near_to(box.max, enf_v3(1, 5, 3), 0));
    EnfBox3 crossed = {{5, 0, 0}, {4, 9, 9}};
    assert_true(near_to(enf_box3_union(crossed, box).max, box.max, 0));
    assert_true(near_to(enf_box3_union(box, crossed).min, box.min, 0));
    EnfBox3 touching = {{1, 5, 3}, {2, 6, 4}}, apart = {{1.5, 2, 0}, {2, 5, 3}};
    assert_true(enf_box3_overlaps(box, touching) && !enf_box3_overlaps(box, apart) && enf_box3_overlaps(apart, apart));
}

static void lengths_survive_the_extremes(void **state) {
    (void)state;
    assert_true(enf_length(enf_v3(3, 0, 4)) == 5.0);
    assert_true(enf_length(enf_v3(3e300, 0, 4e300)) > 4.99e300 && enf_length(enf_v3(3e300, 0, 4e300)) < 5.01e300);
    const double scales[] = {1.0, 0x1p-1070, 0x1p-500, 0x1p500, 0x1p1021};
    for (size_t i = 0; i < 5; i++) {
        EnfVec3 n = enf_normalize(enf_v3(0.0, 3 * scales[i], -4 * scales[i]));
        assert_true(near_to(n, enf_v3(0.0, 0.6, -0.8), 1e-15));
    }
    assert_true(near_to(enf_normalize(enf_v3(0, 0, 0)), enf_v3(0, 0, 0), 0));
    assert_true(near_to(enf_normalize(enf_v3((double)INFINITY, 0, 0)), enf_v3(0, 0, 0), 0));
    assert_false(enf_v3_finite(enf_v3(0, (double)NAN, 0)));
    assert_true(enf_v3_finite(enf_v3(1, 2, 3)));
}

/* Far from the origin, products of the coordinates themselves would leave nothing of a small polygon's normal. */
static void planes_are_found_far_away(void **state) {
    (void)state;
    const EnfVec3 far = {1e5, 2e5, -3e5};
    EnfVec3 square[4] = {{0, 0, 0}, {0.01, 0, 0}, {0.01, 0, -0.01}, {0, 0, -0.01}};
    for (int i = 0; i < 4; i++) {
        square[i] = enf_add(square[i], far);
    }
    EnfPlane plane = enf_plane_from_polygon(square, 4);
    assert_true(near_to(plane.n, enf_v3(0, 1, 0), 1e-9));
    for (int i = 0; i < 4; i++) {
        assert_true(fabs(enf_dot(plane.n, square[i]) + plane.d) < 1e-9);
    }
    EnfVec3 line[3] = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
    EnfPlane none = enf_plane_from_polygon(line, 3);
    assert_true(near_to(none.n, enf_v3(0, 0, 0), 0) && none.d == 0.0);
    assert_true(near_to(enf_plane_from_polygon(line, 2).n, enf_v3(0, 0, 0), 0));
}

/* ---- affine maps ------------------------------------------------------------------------------------------------ */

static EnfAffine random_affine(EnfTestRng *rng) {
    EnfVec3 axis = {enf_test_double(rng, -1, 1), enf_test_double(rng, -1, 1), enf_test_double(rng, -1, 1)};
    EnfVec3 t = {enf_test_double(rng, -9, 9), enf_test_double(rng, -9, 9), enf_test_double(rng, -9, 9)};
    EnfVec3 s = {enf_test_double(rng, 0.5, 2), enf_test_double(rng, 0.5, 2), enf_test_double(rng, -2, -0.5)};
    return enf_affine_trs(t, enf_quat_axis_angle(axis, enf_test_double(rng, -4, 4)), s);
}

static void affine_maps_compose_and_invert(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(4);
    for (int i = 0; i < 1000; i++) {
        EnfAffine a = random_affine(&rng), b = random_affine(&rng), ab = enf_affine_mul(a, b), inverse;
        EnfVec3 p = {enf_test_double(&rng, -9, 9), enf_test_double(&rng, -9, 9), enf_test_double(&rng, -9, 9)};
        EnfVec3 b_p = enf_affine_point(&b, p), ab_p = enf_affine_point(&a, b_p);
        assert_true(near_to(enf_affine_point(&ab, p), ab_p, 1e-12));
        assert_true(fabs(enf_affine_det(&ab) - enf_affine_det(&a) * enf_affine_det(&b)) < 1e-10);
        assert_true(enf_affine_det(&a) < 0.0); /* one scale is negative: a reflection */
        assert_true(enf_affine_inverse(&a, &inverse));
        assert_true(near_to(enf_affine_point(&inverse, ab_p), b_p, 1e-11));
        EnfVec3 v = enf_affine_vector(&a, p);
        assert_true(near_to(enf_add(v, a.t), enf_affine_point(&a, p), 1e-12));
    }
    EnfAffine tiny = enf_affine_trs(enf_v3(1, 2, 3), (EnfQuat){0, 0, 0, 1}, enf_v3(1e-90, 1e-90, 1e-90)), back;
    assert_true(enf_affine_inverse(&tiny, &back)); /* small is not singular */
}

static void singular_maps_give_the_identity(void **state) {
    (void)state;
    EnfAffine flat = enf_affine_trs(enf_v3(1, 2, 3), (EnfQuat){0.1, 0.2, 0.3, 0.9}, enf_v3(1, 0, 1));
    EnfAffine bad = enf_affine_identity(), inverse;
    EnfAffine skew = {{0.1, 0.2, 0.3, 0.7, 0.5, 0.9, 0.8, 0.7, 1.2}, {0, 0, 0}}; /* third = first + second, rounded */
    bad.m[4] = (double)NAN;
    const EnfAffine *maps[] = {&flat, &bad, &skew};
    for (int i = 0; i < 3; i++) {
        memset(&inverse, 1, sizeof inverse);
        assert_false(enf_affine_inverse(maps[i], &inverse));
        EnfVec3 p = {4, 5, 6};
        assert_true(near_to(enf_affine_point(&inverse, p), p, 0));
    }
}

static void quaternions_turn_by_the_right_hand(void **state) {
    (void)state;
    EnfVec3 one = {1, 1, 1}, origin = {0, 0, 0};
    EnfQuat quarter = enf_quat_axis_angle(enf_v3(0, 3, 0), ENF_PI / 2);
    EnfAffine turn = enf_affine_trs(origin, quarter, one);
    assert_true(near_to(enf_affine_vector(&turn, enf_v3(0, 0, -1)), enf_v3(-1, 0, 0), 1e-15));
    EnfAffine half = enf_affine_trs(origin, enf_quat_mul(quarter, quarter), one);
    assert_true(near_to(enf_affine_vector(&half, enf_v3(1, 0, 0)), enf_v3(-1, 0, 0), 1e-15));
    EnfQuat tilt = enf_quat_axis_angle(enf_v3(1, 0, 0), 0.3);
    EnfAffine both = enf_affine_trs(origin, enf_quat_mul(quarter, tilt), one), first = enf_affine_trs(origin, tilt, one);
    EnfVec3 v = {0.3, -0.2, 0.9}, expected = enf_affine_vector(&turn, enf_affine_vector(&first, v));
    assert_true(near_to(enf_affine_vector(&both, v), expected, 1e-15));
    EnfQuat long_one = {0, 5, 0, 5}, zero = {0, 0, 0, 0};
    EnfAffine scaled = enf_affine_trs(origin, long_one, one), still = enf_affine_trs(origin, zero, one);
    assert_true(near_to(enf_affine_vector(&scaled, enf_v3(0, 0, -1)), enf_v3(-1, 0, 0), 1e-15));
    assert_true(near_to(enf_affine_vector(&still, v), v, 0));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(sine_cosine_tangent_are_accurate),   cmocka_unit_test(arc_tangent_is_accurate),
    cmocka_unit_test(trigonometry_knows_its_limits),      cmocka_unit_test(trigonometry_has_the_same_bits_everywhere),
    cmocka_unit_test(rounding_is_outward_and_tight),      cmocka_unit_test(boxes_add_up),
    cmocka_unit_test(lengths_survive_the_extremes),       cmocka_unit_test(planes_are_found_far_away),
    cmocka_unit_test(affine_maps_compose_and_invert),     cmocka_unit_test(singular_maps_give_the_identity),
    cmocka_unit_test(quaternions_turn_by_the_right_hand),
};

ENF_TEST_MAIN(tests)
