/* Intervals of doubles, rounded outward: whatever reals go in, the result of an operation on them lies in what comes out.
 *
 * Each end is computed to nearest and then moved by one step outward (nextafter), which holds it without a change of the rounding
 * mode: the nearest double is within half a step of the real. Sine, cosine and arc tangent are libm's, widened by more than libm errs
 * by (some units in the last place). Source: Moore, Interval Analysis, 1966. */
#ifndef ENF_SCENES_INTERVAL_H
#define ENF_SCENES_INTERVAL_H

#include <math.h>
#include <stdbool.h>

typedef struct EnfInterval {
    double lo, hi;
} EnfInterval;

static inline EnfInterval enf_iv(double x) {
    return (EnfInterval){x, x};
}

static inline EnfInterval enf_iv_span(double a, double b) {
    return (EnfInterval){a < b ? a : b, a < b ? b : a};
}

static inline EnfInterval enf_iv_outward(double lo, double hi) {
    return (EnfInterval){nextafter(lo, -HUGE_VAL), nextafter(hi, HUGE_VAL)};
}

static inline EnfInterval enf_iv_hull(EnfInterval a, EnfInterval b) {
    return (EnfInterval){a.lo < b.lo ? a.lo : b.lo, a.hi > b.hi ? a.hi : b.hi};
}

/** What is known to lie in [lo, hi] also. */
static inline EnfInterval enf_iv_clip(EnfInterval a, double lo, double hi) {
    double low = a.lo > lo ? a.lo : lo;
    double high = a.hi < hi ? a.hi : hi;
    return low <= high ? (EnfInterval){low, high} : (EnfInterval){lo, hi};
}

static inline EnfInterval enf_iv_add(EnfInterval a, EnfInterval b) {
    return enf_iv_outward(a.lo + b.lo, a.hi + b.hi);
}

static inline EnfInterval enf_iv_sub(EnfInterval a, EnfInterval b) {
    return enf_iv_outward(a.lo - b.hi, a.hi - b.lo);
}

static inline EnfInterval enf_iv_neg(EnfInterval a) {
    return (EnfInterval){-a.hi, -a.lo};
}

static inline EnfInterval enf_iv_mul(EnfInterval a, EnfInterval b) {
    EnfInterval x = enf_iv_span(a.lo * b.lo, a.lo * b.hi);
    EnfInterval y = enf_iv_span(a.hi * b.lo, a.hi * b.hi);
    EnfInterval all = enf_iv_hull(x, y);
    return enf_iv_outward(all.lo, all.hi);
}

static inline EnfInterval enf_iv_square(EnfInterval a) {
    EnfInterval ends = enf_iv_span(a.lo * a.lo, a.hi * a.hi);
    EnfInterval out = enf_iv_outward(ends.lo, ends.hi);
    return a.lo <= 0.0 && a.hi >= 0.0 ? (EnfInterval){0.0, out.hi} : enf_iv_clip(out, 0.0, HUGE_VAL);
}

/** Anything, where the divisor may be zero. */
static inline EnfInterval enf_iv_div(EnfInterval a, EnfInterval b) {
    if (b.lo <= 0.0 && b.hi >= 0.0) {
        return (EnfInterval){-HUGE_VAL, HUGE_VAL};
    }
    EnfInterval all = enf_iv_hull(enf_iv_span(a.lo / b.lo, a.lo / b.hi), enf_iv_span(a.hi / b.lo, a.hi / b.hi));
    return enf_iv_outward(all.lo, all.hi);
}

/** Of what of `a` is not negative. */
static inline EnfInterval enf_iv_sqrt(EnfInterval a) {
    EnfInterval at = enf_iv_clip(a, 0.0, HUGE_VAL);
    return enf_iv_clip(enf_iv_outward(sqrt(at.lo), sqrt(at.hi)), 0.0, HUGE_VAL);
}

/* ---- functions of libm ------------------------------------------------------------------------------------------ */

#define ENF_IV_LIBM 0x1p-49 /* eight times what libm may be off for results of about 1 */

/** Does [lo, hi] hold `at` + a whole number of turns, or nearly? */
static inline bool enf_iv_passes(EnfInterval a, double at) {
    const double turn = 6.283185307179586;
    double error = 1e-12 * (1.0 + fabs(a.lo) + fabs(a.hi));
    return floor((a.hi + error - at) / turn) >= ceil((a.lo - error - at) / turn);
}

static inline EnfInterval enf_iv_cos(EnfInterval a) {
    const double half = 3.141592653589793;
    EnfInterval ends = enf_iv_span(cos(a.lo), cos(a.hi));
    double lo = enf_iv_passes(a, half) ? -1.0 : ends.lo - ENF_IV_LIBM;
    double hi = enf_iv_passes(a, 0.0) ? 1.0 : ends.hi + ENF_IV_LIBM;
    return enf_iv_clip((EnfInterval){lo, hi}, -1.0, 1.0);
}

static inline EnfInterval enf_iv_sin(EnfInterval a) {
    const double quarter = 1.5707963267948966;
    EnfInterval ends = enf_iv_span(sin(a.lo), sin(a.hi));
    double lo = enf_iv_passes(a, -quarter) ? -1.0 : ends.lo - ENF_IV_LIBM;
    double hi = enf_iv_passes(a, quarter) ? 1.0 : ends.hi + ENF_IV_LIBM;
    return enf_iv_clip((EnfInterval){lo, hi}, -1.0, 1.0);
}

/** The angle whose sine and cosine these are, both not negative: it grows with the one and falls with the other. */
static inline EnfInterval enf_iv_angle(EnfInterval sine, EnfInterval cosine) {
    return (EnfInterval){atan2(sine.lo, cosine.hi) - ENF_IV_LIBM, atan2(sine.hi, cosine.lo) + ENF_IV_LIBM};
}

#endif
