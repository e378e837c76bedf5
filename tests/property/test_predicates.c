/* The exact side of a point, against 256-bit and 113-bit twins that share no line with it, on random and hostile points. */
#include "harness/harness.h"
#include "harness/quad.h"

#include <enfilade/math.h>
#include <enfilade/tolerances.h>

#include <math.h>
#include <string.h>

#define LIMIT (INT64_C(1) << 40)

/* ---- 256-bit twin ----------------------------------------------------------------------------------------------- */

/* Two's complement, eight limbs of 32 bits, least first. */
typedef struct Wide {
    uint32_t limb[8];
} Wide;

static Wide wide(int64_t v) {
    Wide w;
    for (int i = 0; i < 8; i++) {
        w.limb[i] = i == 0 ? (uint32_t)v : i == 1 ? (uint32_t)((uint64_t)v >> 32) : v < 0 ? UINT32_MAX : 0;
    }
    return w;
}

static Wide wide_add(Wide a, Wide b) {
    uint64_t carry = 0;
    for (int i = 0; i < 8; i++) {
        carry += (uint64_t)a.limb[i] + b.limb[i];
        a.limb[i] = (uint32_t)carry;
        carry >>= 32;
    }
    return a;
}

static Wide wide_negate(Wide a) {
    for (int i = 0; i < 8; i++) {
        a.limb[i] = ~a.limb[i];
    }
    return wide_add(a, wide(1));
}

/* Modulo 2^256: right for two's complement as for natural numbers. */
static Wide wide_multiply(Wide a, Wide b) {
    Wide product = wide(0);
    for (int i = 0; i < 8; i++) {
        uint64_t carry = 0;
        for (int k = 0; i + k < 8; k++) {
            carry += (uint64_t)a.limb[i] * b.limb[k] + product.limb[i + k];
            product.limb[i + k] = (uint32_t)carry;
            carry >>= 32;
        }
    }
    return product;
}

static int wide_sign(Wide a) {
    if (a.limb[7] >> 31) {
        return -1;
    }
    uint32_t any = 0;
    for (int i = 0; i < 8; i++) {
        any |= a.limb[i];
    }
    return any != 0;
}

/* Leibniz: six products of three, over the coordinates' columns; no minors, as the engine has. */
static int orient3_wide(EnfGrid3 a, EnfGrid3 b, EnfGrid3 c, EnfGrid3 d) {
    const int64_t m[3][3] = {
        {b.x - a.x, b.y - a.y, b.z - a.z}, {c.x - a.x, c.y - a.y, c.z - a.z}, {d.x - a.x, d.y - a.y, d.z - a.z}};
    static const int order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}};
    Wide sum = wide(0);
    for (int i = 0; i < 6; i++) {
        Wide term = wide_multiply(wide_multiply(wide(m[0][order[i][0]]), wide(m[1][order[i][1]])), wide(m[2][order[i][2]]));
        sum = wide_add(sum, i < 3 ? term : wide_negate(term));
    }
    return wide_sign(sum);
}

/* Exact while the determinant fits 113 bits: differences below 2^36. */
static int orient3_quad(EnfGrid3 a, EnfGrid3 b, EnfGrid3 c, EnfGrid3 d) {
    Quad ux = (Quad)(b.x - a.x), uy = (Quad)(b.y - a.y), uz = (Quad)(b.z - a.z);
    Quad vx = (Quad)(c.x - a.x), vy = (Quad)(c.y - a.y), vz = (Quad)(c.z - a.z);
    Quad wx = (Quad)(d.x - a.x), wy = (Quad)(d.y - a.y), wz = (Quad)(d.z - a.z);
    Quad det = ux * (vy * wz - vz * wy) + uy * (vz * wx - vx * wz) + uz * (vx * wy - vy * wx);
    return (det > quad(0.0)) - (det < quad(0.0));
}

/* ---- points ----------------------------------------------------------------------------------------------------- */

static int64_t any_coordinate(EnfTestRng *rng, int64_t limit) {
    uint64_t span = 2 * (uint64_t)limit + 1;
    return (int64_t)(enf_test_u64(rng) % span) - limit;
}

static EnfGrid3 any_point(EnfTestRng *rng, int64_t limit) {
    EnfGrid3 p;
    p.x = any_coordinate(rng, limit);
    p.y = any_coordinate(rng, limit);
    p.z = any_coordinate(rng, limit);
    return p;
}

/* a + i (b - a) + k (c - a), then off the plane by `off` in x: coplanar for 0, by a hair otherwise. */
static EnfGrid3 beside_plane(EnfGrid3 a, EnfGrid3 b, EnfGrid3 c, int64_t i, int64_t k, int64_t off) {
    EnfGrid3 p = {a.x + i * (b.x - a.x) + k * (c.x - a.x) + off, a.y + i * (b.y - a.y) + k * (c.y - a.y),
                  a.z + i * (b.z - a.z) + k * (c.z - a.z)};
    return p;
}

static void check(EnfGrid3 a, EnfGrid3 b, EnfGrid3 c, EnfGrid3 d) {
    int side = enf_orient3(a, b, c, d);
    assert_int_equal(side, orient3_wide(a, b, c, d));
    assert_int_equal(-side, enf_orient3(b, a, c, d));
    assert_int_equal(side, enf_orient3(b, c, a, d));
    assert_int_equal(-side, enf_orient3(a, b, d, c));
}

static void sides_are_exact(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    for (uint32_t i = 0; i < enf_test_rounds(300000, 3000000); i++) {
        int64_t limit = LIMIT >> enf_test_below(&rng, 36);
        EnfGrid3 a = any_point(&rng, limit), b = any_point(&rng, limit), c = any_point(&rng, limit);
        check(a, b, c, any_point(&rng, limit));
    }
}

static void sides_of_nearly_coplanar_points_are_exact(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    uint32_t zeros = 0;
    for (uint32_t i = 0; i < enf_test_rounds(300000, 3000000); i++) {
        int64_t limit = (LIMIT >> enf_test_below(&rng, 30)) / 32;
        EnfGrid3 a = any_point(&rng, limit), b = any_point(&rng, limit), c = any_point(&rng, limit);
        int64_t k = (int64_t)enf_test_below(&rng, 15) - 7, m = (int64_t)enf_test_below(&rng, 15) - 7;
        EnfGrid3 d = beside_plane(a, b, c, k, m, (int64_t)enf_test_below(&rng, 3) - 1);
        check(a, b, c, d);
        zeros += enf_orient3(a, b, c, d) == 0;
        if (limit < INT64_C(1) << 30) {
            assert_int_equal(enf_orient3(a, b, c, d), orient3_quad(a, b, c, d));
        }
    }
    assert_true(zeros > 50000);
}

/* The corners of the range: the largest determinant there is, 4 * 2^123, and its neighbours. Sixty-four bits, and even
 * 120, would overflow here. */
static void sides_are_exact_at_the_ends_of_the_range(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(3);
    for (uint32_t i = 0; i < 200000; i++) {
        EnfGrid3 p[4];
        for (int k = 0; k < 4; k++) {
            uint32_t bits = enf_test_u32(&rng);
            p[k].x = (bits & 1 ? 1 : -1) * (LIMIT - (int64_t)(bits >> 3 & 1));
            p[k].y = (bits & 2 ? 1 : -1) * (LIMIT - (int64_t)(bits >> 4 & 1));
            p[k].z = (bits & 4 ? 1 : -1) * (LIMIT - (int64_t)(bits >> 5 & 1));
        }
        check(p[0], p[1], p[2], p[3]);
    }
    EnfGrid3 a = {-LIMIT, -LIMIT, -LIMIT}, b = {LIMIT, LIMIT, -LIMIT}, c = {LIMIT, -LIMIT, LIMIT};
    EnfGrid3 d = {-LIMIT, LIMIT, LIMIT};
    check(a, b, c, d);
    assert_int_not_equal(enf_orient3(a, b, c, d), 0);
}

static void the_side_follows_the_right_hand(void **state) {
    (void)state;
    EnfGrid3 a = {0, 0, 0}, b = {1, 0, 0}, c = {0, 1, 0}, above = {0, 0, 1}, below = {5, 5, -1}, on = {9, -7, 0};
    assert_int_equal(enf_orient3(a, b, c, above), 1);
    assert_int_equal(enf_orient3(a, b, c, below), -1);
    assert_int_equal(enf_orient3(a, b, c, on), 0);
}

/* ---- the grid --------------------------------------------------------------------------------------------------- */

static void snapping_takes_the_nearest_grid_point(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(4);
    for (uint32_t i = 0; i < 100000; i++) {
        EnfVec3 p = {enf_test_double(&rng, -5000, 5000), enf_test_double(&rng, -1, 1), enf_test_double(&rng, -1e6, 1e6)};
        EnfGrid3 g = enf_grid_snap(p);
        EnfVec3 q = enf_grid_point(g);
        assert_true(fabs(p.x - q.x) <= ENF_GRID_STEP / 2 && fabs(p.y - q.y) <= ENF_GRID_STEP / 2 &&
                    fabs(p.z - q.z) <= ENF_GRID_STEP / 2);
        EnfGrid3 again = enf_grid_snap(q); /* a grid point is its own */
        assert_memory_equal(&again, &g, sizeof g);
        if (fabs(q.x) <= 4096.0) { /* ENF_GRID_STEP's promise: a float holds it */
            assert_true((double)(float)q.x == q.x);
        }
    }
    EnfGrid3 even = enf_grid_snap(enf_v3(0.5 * ENF_GRID_STEP, 1.5 * ENF_GRID_STEP, -0.5 * ENF_GRID_STEP));
    assert_true(even.x == 0 && even.y == 2 && even.z == 0);
    EnfGrid3 far = enf_grid_snap(enf_v3(1e300, -(double)INFINITY, (double)NAN));
    assert_true(far.x == LIMIT && far.y == -LIMIT && far.z == 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(sides_are_exact),
    cmocka_unit_test(sides_of_nearly_coplanar_points_are_exact),
    cmocka_unit_test(sides_are_exact_at_the_ends_of_the_range),
    cmocka_unit_test(the_side_follows_the_right_hand),
    cmocka_unit_test(snapping_takes_the_nearest_grid_point),
};

ENF_TEST_MAIN(tests)
