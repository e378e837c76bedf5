/* Keyed curves: their value at a time, and the interval of their values over a range of times. glTF 2.0 appendix C: step, linear
 * (spherical for rotations), cubic Hermite.
 *
 * Ranges are exact up to rounding: a cubic's extremes lie at the range's ends and at the roots of its derivative. They are then
 * widened by RANGE_ERROR of the coefficients' sizes, which is above the rounding of either evaluation (some 20 operations of
 * 2^-53 each) and above what a root off by its own rounding changes (second order). */
#include "world/world_internal.h"

#include <math.h>

#define RANGE_ERROR 0x1p-40

/* The segment that holds `seconds`: keys k and k+1; k = key_count-1 at and after the last. */
static uint32_t find_segment(const EnfTrack *track, double seconds) {
    uint32_t low = 0;
    uint32_t high = track->key_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if ((double)track->times[middle] <= seconds) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

static const float *key_value(const EnfTrack *track, uint32_t components, uint32_t key) {
    bool cubic = track->kind == ENF_PATH_CUBIC;
    return track->values + (size_t)key * components * (cubic ? 3U : 1U) + (cubic ? components : 0U);
}

/* Where in segment `key` a time lies, 0 to 1; monotone in `seconds`, as subtraction and division by a constant round monotonely. */
static double segment_parameter(const EnfTrack *track, uint32_t key, double seconds) {
    double begin = (double)track->times[key];
    double s = (seconds - begin) / ((double)track->times[key + 1] - begin);
    return s < 0.0 ? 0.0 : s > 1.0 ? 1.0 : s;
}

/* Power coefficients of one component of a cubic segment: ((a s + b) s + c) s + d. */
static void cubic_coefficients(const EnfTrack *track, uint32_t components, uint32_t key, uint32_t component, double out[4]) {
    double span = (double)track->times[key + 1] - (double)track->times[key];
    const float *p0 = key_value(track, components, key);
    const float *p1 = key_value(track, components, key + 1);
    double v0 = (double)p0[component];
    double v1 = (double)p1[component];
    double m0 = span * (double)p0[components + component];   /* out-tangent of this key */
    double m1 = span * (double)(p1 - components)[component]; /* in-tangent of the next */
    out[0] = 2.0 * (v0 - v1) + m0 + m1;
    out[1] = 3.0 * (v1 - v0) - 2.0 * m0 - m1;
    out[2] = m0;
    out[3] = v0;
}

static double cubic_at(const double k[4], double s) {
    return ((k[0] * s + k[1]) * s + k[2]) * s + k[3];
}

static void normalize4(double *q) {
    double size = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++) {
        q[i] = size > 0.0 ? q[i] / size : (i == 3 ? 1.0 : 0.0);
    }
}

/* Spherical interpolation the short way round; nearly equal rotations are interpolated linearly (Shoemake 1985). */
static void slerp(const float *a, const float *b, double s, double *out) {
    double p[4];
    double q[4];
    for (int i = 0; i < 4; i++) {
        p[i] = (double)a[i];
        q[i] = (double)b[i];
    }
    normalize4(p);
    normalize4(q);
    double cosine = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
    double sign = cosine < 0.0 ? -1.0 : 1.0;
    cosine *= sign;
    double wp = 1.0 - s;
    double wq = s;
    if (cosine < 0.9999) {
        double angle = enf_atan2(sqrt(1.0 - cosine * cosine), cosine);
        double sine = enf_sin(angle);
        wp = enf_sin((1.0 - s) * angle) / sine;
        wq = enf_sin(s * angle) / sine;
    }
    for (int i = 0; i < 4; i++) {
        out[i] = wp * p[i] + sign * wq * q[i];
    }
}

static void segment_value(const EnfTrack *track, uint32_t components, uint32_t key, double s, double *out) {
    const float *p0 = key_value(track, components, key);
    if (track->kind == ENF_PATH_LINEAR && components == 4) {
        slerp(p0, key_value(track, components, key + 1), s, out);
        return;
    }
    for (uint32_t c = 0; c < components; c++) {
        double v0 = (double)p0[c];
        if (track->kind == ENF_PATH_STEP) {
            out[c] = v0;
        } else if (track->kind == ENF_PATH_LINEAR) {
            out[c] = v0 + ((double)key_value(track, components, key + 1)[c] - v0) * s;
        } else {
            double k[4];
            cubic_coefficients(track, components, key, c, k);
            out[c] = cubic_at(k, s);
        }
    }
}

void enf_track_value(const EnfTrack *track, uint32_t components, double seconds, double *out) {
    uint32_t key = find_segment(track, seconds);
    if (key + 1 >= track->key_count || seconds < (double)track->times[0]) {
        const float *held = key_value(track, components, key);
        for (uint32_t c = 0; c < components; c++) {
            out[c] = (double)held[c];
        }
    } else {
        segment_value(track, components, key, segment_parameter(track, key, seconds), out);
    }
    if (components == 4) {
        normalize4(out);
    }
}

/* ---- ranges ----------------------------------------------------------------------------------------------------- */

static void include(EnfTrackRange *range, uint32_t component, double value, double error) {
    double low = value - error;
    double high = value + error;
    range->low[component] = low < range->low[component] ? low : range->low[component];
    range->high[component] = high > range->high[component] ? high : range->high[component];
}

/* Roots of the derivative 3a s^2 + 2b s + c without cancellation; returns how many. */
static int turning_points(const double k[4], double roots[2]) {
    double a = 3.0 * k[0];
    double b = k[1]; /* half of the linear term */
    double c = k[2];
    double discriminant = b * b - a * c;
    if (discriminant < 0.0) {
        return 0;
    }
    double q = -(b + (b < 0.0 ? -sqrt(discriminant) : sqrt(discriminant)));
    int count = 0;
    if (a != 0.0) {
        roots[count++] = q / a;
    }
    if (q != 0.0) {
        roots[count++] = c / q;
    }
    return count;
}

static void include_cubic(EnfTrackRange *range, uint32_t component, const double k[4], double s0, double s1) {
    double error = RANGE_ERROR * (fabs(k[0]) + fabs(k[1]) + fabs(k[2]) + fabs(k[3]));
    double roots[2];
    int count = turning_points(k, roots);
    include(range, component, cubic_at(k, s0), error);
    include(range, component, cubic_at(k, s1), error);
    for (int i = 0; i < count; i++) {
        if (roots[i] > s0 && roots[i] < s1) {
            include(range, component, cubic_at(k, roots[i]), error);
        }
    }
}

static void include_segment(const EnfTrack *track, uint32_t components, uint32_t key, const double s[2], EnfTrackRange *range) {
    const float *p0 = key_value(track, components, key);
    for (uint32_t c = 0; c < components; c++) {
        if (track->kind == ENF_PATH_CUBIC) {
            double k[4];
            cubic_coefficients(track, components, key, c, k);
            include_cubic(range, c, k, s[0], s[1]);
            continue;
        }
        double v0 = (double)p0[c];
        double v1 = track->kind == ENF_PATH_STEP ? v0 : (double)key_value(track, components, key + 1)[c];
        double error = RANGE_ERROR * (fabs(v0) + fabs(v1));
        include(range, c, v0 + (v1 - v0) * s[0], error);
        include(range, c, v0 + (v1 - v0) * s[1], error);
    }
}

void enf_track_range(const EnfTrack *track, uint32_t components, double from, double to, EnfTrackRange *range) {
    uint32_t first = find_segment(track, from);
    uint32_t last = find_segment(track, to);
    for (uint32_t key = first; key <= last; key++) {
        bool held = key + 1 >= track->key_count || (key == 0 && from < (double)track->times[0]);
        if (held) { /* after the last key, or before the first: its own value */
            const float *value = key_value(track, components, key);
            for (uint32_t c = 0; c < components; c++) {
                include(range, c, (double)value[c], 0.0);
            }
        }
        if (key + 1 < track->key_count) {
            double s[2] = {key == first ? segment_parameter(track, key, from) : 0.0,
                           key == last ? segment_parameter(track, key, to) : 1.0};
            include_segment(track, components, key, s, range);
        }
    }
}

void enf_catmull_rom(const float *times, const float *points, uint32_t count, float *values) {
    for (uint32_t i = 0; i < count; i++) {
        uint32_t before = i > 0 ? i - 1 : 0;
        uint32_t after = i + 1 < count ? i + 1 : i;
        double span = (double)times[after] - (double)times[before];
        for (uint32_t c = 0; c < 3; c++) {
            double rise = (double)points[3 * after + c] - (double)points[3 * before + c];
            float tangent = span > 0.0 ? (float)(rise / span) : 0.0F;
            values[9 * i + c] = tangent;
            values[9 * i + 3 + c] = points[3 * i + c];
            values[9 * i + 6 + c] = tangent;
        }
    }
}
