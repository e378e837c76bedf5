/* Sine, cosine, tangent and arc tangent of our own: the C library's differ in their last bits from machine to machine,
 * and a replay must not. Only + - * / act here, each correctly rounded by IEEE 754 and never contracted.
 *
 * Reduction to |r| <= pi/4 subtracts a multiple of pi/2 in four parts (after Cody & Waite, "Software Manual for the
 * Elementary Functions", 1980); then a polynomial, near-minimax in r² (Chebyshev interpolation at 200 bits, truncation
 * error below 2^-56 of the result). Measured worst errors are in tests/unit/test_math.c. */
#include <enfilade/math.h>

#include <float.h>
#include <math.h>

/* pi/2 in parts of 33, 33, 33 and 53 bits: k times a part is exact for |k| < 2^20, so |x| <= 2^20 is reduced without
 * loss even where x lies close to a multiple of pi/2 (the closest double, 0x1.6c6cbc45dc8dep+5, comes within 2^-60.5). */
#define HALF_PI_1 0x1.921fb54400000p+0
#define HALF_PI_2 0x1.0b4611a600000p-34
#define HALF_PI_3 0x1.3198a2e000000p-69
#define HALF_PI_4 0x1.b839a252049c1p-104
#define TWO_OVER_PI 0x1.45f306dc9c883p-1
#define LARGEST_ANGLE 0x1p20

/* A number as an unevaluated sum: |low| is at most half an ulp of high. */
typedef struct Pair {
    double high, low;
} Pair;

/* Knuth's two-sum: high + low == a + b exactly. */
static Pair exact_sum(double a, double b) {
    double sum = a + b;
    double from_b = sum - a;
    Pair pair = {sum, (a - (sum - from_b)) + (b - from_b)};
    return pair;
}

/* x - k pi/2 with |result| <= pi/4, and *quadrant = k mod 4. */
static Pair reduce(double x, unsigned *quadrant) {
    if (fabs(x) > LARGEST_ANGLE) {
        x = fmod(x, 2.0 * ENF_PI); /* outside the promised range: still a sane angle, and fmod is exact everywhere */
    }
    double turns = x * TWO_OVER_PI;
    int32_t nearest = (int32_t)(turns + (turns < 0.0 ? -0.5 : 0.5));
    double k = (double)nearest;
    *quadrant = (unsigned)nearest & 3u;
    /* The first difference is exact: both are multiples of 2^-53, and the result is below 1. */
    Pair a = exact_sum(x - k * HALF_PI_1, -k * HALF_PI_2);
    Pair b = exact_sum(a.high, -k * HALF_PI_3);
    return exact_sum(b.high, b.low + (a.low - k * HALF_PI_4));
}

/* sin(r) for |r| <= pi/4. */
static Pair sin_kernel(Pair r) {
    double x = r.high, t = x * x;
    double p = 0x1.71de379689090p-19 + t * (-0x1.ae600b01a40ccp-26 + t * 0x1.5e0b1995f429ap-33);
    p = -0x1.5555555555555p-3 + t * (0x1.1111111110bb2p-7 + t * (-0x1.a01a019e83aa2p-13 + t * p));
    /* sin(x + e) = sin x + e cos x, and cos x = 1 - x²/2 is enough for so small an e. */
    return exact_sum(x, x * t * p + r.low * (1.0 - 0.5 * t));
}

/* cos(r) for |r| <= pi/4. */
static Pair cos_kernel(Pair r) {
    double x = r.high, t = x * x;
    double p = -0x1.27e4fa17d9864p-22 + t * (0x1.1eeb68e8b2372p-29 + t * -0x1.907da304ce77bp-37);
    p = 0x1.5555555555555p-5 + t * (-0x1.6c16c16c16967p-10 + t * (0x1.a01a019f4eafap-16 + t * p));
    Pair head = exact_sum(1.0, -0.5 * t);
    return exact_sum(head.high, head.low + (t * t * p - x * r.low));
}

static double rounded(Pair a) {
    return a.high + a.low;
}

/* sin(x) after `quarter_turns` more: 0 for the sine, 1 for the cosine. */
static double sin_turned(double x, unsigned quarter_turns) {
    unsigned quadrant;
    Pair r = reduce(x, &quadrant);
    quadrant = (quadrant + quarter_turns) & 3u;
    double value = rounded(quadrant & 1u ? cos_kernel(r) : sin_kernel(r));
    return quadrant & 2u ? -value : value;
}

/* Below this, sin x and tan x round to x: the next term, x³/3, is under a quarter of an ulp. */
#define TINY_ANGLE 0x1p-27

double enf_sin(double radians) {
    if (!isfinite(radians)) {
        return (double)NAN;
    }
    return fabs(radians) < TINY_ANGLE ? radians : sin_turned(radians, 0);
}

double enf_cos(double radians) {
    return isfinite(radians) ? sin_turned(radians, 1) : (double)NAN;
}

double enf_tan(double radians) {
    if (!isfinite(radians)) {
        return (double)NAN;
    }
    if (fabs(radians) < TINY_ANGLE) {
        return radians;
    }
    unsigned quadrant;
    Pair r = reduce(radians, &quadrant);
    Pair s = sin_kernel(r), c = cos_kernel(r);
    if (quadrant & 1u) {
        Pair swap = s;
        s = (Pair){-c.high, -c.low};
        c = swap;
    }
    /* The quotient of the heads, then what the tails change: their own roundings would make 2.5 ulp. */
    double q = s.high / c.high;
    return q + q * (s.low / s.high - c.low / c.high);
}

/* ---- arc tangent ------------------------------------------------------------------------------------------------ */

static const Pair zero = {0.0, 0.0};
static const Pair pi = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
static const Pair half_pi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
static const Pair quarter_pi = {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55};
static const Pair atan_half = {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56};

/* (atan t - t) / t³ in s = t², |t| <= 7/16. */
static double atan_tail(double s) {
    double p = -0x1.9c616e7e61a95p-5 + s * (0x1.35dd3ba3a06adp-5 + s * -0x1.1f7e7048b0a6fp-6);
    p = 0x1.3b1161c0261b4p-4 + s * (-0x1.10ed20cc03917p-4 + s * (0x1.df0bad09fa62cp-5 + s * p));
    p = -0x1.24924923b09bfp-3 + s * (0x1.c71c71366bfc2p-4 + s * (-0x1.745cff64fb1e8p-4 + s * p));
    return -0x1.5555555555554p-2 + s * (0x1.9999999998863p-3 + s * p);
}

/* base + sign * atan(y / x) for 0 <= y <= x, 0 < x. atan(y/x) = atan c + atan((y - cx) / (x + cy)) with c of 0, 1/2 or
 * 1 keeps |t| <= 7/16; the difference y - cx is exact there, for its two sides are within a factor of two. */
static double atan_octant(double y, double x, Pair base, double sign) {
    double ratio = y / x, t = ratio;
    Pair centre = zero;
    if (ratio >= 0.6875) {
        t = (y - x) / (x + y);
        centre = quarter_pi;
    } else if (ratio >= 0.4375) {
        t = (y - 0.5 * x) / (x + 0.5 * y);
        centre = atan_half;
    }
    double tail = t * (t * t) * atan_tail(t * t);
    Pair head = exact_sum(base.high, sign * centre.high);
    Pair sum = exact_sum(head.high, sign * t);
    return sum.high + (sum.low + (head.low + (base.low + sign * (centre.low + tail))));
}

/* Both arguments zero, or one infinite: the limits of IEEE 754-2019 §9.2.1. `y` and `x` are absolute values. */
static double atan_limit(double y, double x, bool x_negative) {
    if (isinf(y)) {
        return isinf(x) ? (x_negative ? 3.0 * quarter_pi.high : quarter_pi.high) : half_pi.high;
    }
    return x_negative ? pi.high : 0.0;
}

double enf_atan2(double y, double x) {
    if (isnan(x) || isnan(y)) {
        return (double)NAN;
    }
    double height = fabs(y), width = fabs(x), larger = fmax(height, width);
    bool x_negative = signbit(x) != 0;
    if (larger == 0.0 || isinf(larger)) {
        return copysign(atan_limit(height, width, x_negative), y);
    }
    /* Away from the ends, so that x + y cannot overflow and c x is exact. */
    double scale = larger > 0x1p1000 ? 0x1p-100 : larger < 0x1p-900 ? 0x1p100 : 1.0;
    height *= scale;
    width *= scale;
    double angle;
    if (height <= width) {
        angle = x_negative ? atan_octant(height, width, pi, -1.0) : atan_octant(height, width, zero, 1.0);
    } else {
        angle = atan_octant(width, height, half_pi, x_negative ? 1.0 : -1.0);
    }
    return copysign(angle, y);
}
