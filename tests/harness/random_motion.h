/* Motions of every kind, as hostile as they come: keys a millisecond apart, places 100 km off, quaternions of any length, scales of either
 * sign; and ranges of ticks from one to 10^9. */
#ifndef ENF_TESTS_RANDOM_MOTION_H
#define ENF_TESTS_RANDOM_MOTION_H

#include "harness/harness.h"

#include <enfilade/world.h>

#include <string.h>

enum { ENF_RANDOM_KEYS = 12 };

/* A path with arrays of its own. */
typedef struct EnfRandomPath {
    EnfMotion motion;
    float times[3][ENF_RANDOM_KEYS];
    float values[3][ENF_RANDOM_KEYS * 12];
} EnfRandomPath;

static inline EnfTrack enf_random_track(EnfTestRng *rng, float *times, float *values, uint32_t components, double size) {
    EnfTrack track = {(EnfPathKind)enf_test_below(rng, 3), 1 + enf_test_below(rng, ENF_RANDOM_KEYS), times, values};
    float at = enf_test_chance(rng, 2) ? 0.0F : enf_test_float(rng, 0.0F, 1.0F);
    for (uint32_t k = 0; k < track.key_count; k++) {
        times[k] = at;
        at += enf_test_chance(rng, 4) ? 1e-3F : enf_test_float(rng, 0.05F, 3.0F);
    }
    uint32_t count = track.key_count * components * (track.kind == ENF_PATH_CUBIC ? 3U : 1U);
    for (uint32_t i = 0; i < count; i++) {
        values[i] = enf_test_float(rng, (float)-size, (float)size);
    }
    return track;
}

static inline void enf_random_path(EnfTestRng *rng, EnfRandomPath *path) {
    memset(path, 0, sizeof *path);
    path->motion.kind = ENF_MOTION_PATH;
    EnfPathMotion *p = &path->motion.as.path;
    double size = enf_test_chance(rng, 4) ? 1e5 : 10.0;
    p->rest = enf_pose_identity();
    p->rest.rotation = enf_quat_axis_angle(enf_v3(0.6, 0.0, 0.8), enf_test_double(rng, -3.0, 3.0));
    p->rest.position = enf_v3(enf_test_double(rng, -size, size), 0.0, 1.0);
    if (!enf_test_chance(rng, 4)) {
        p->translation = enf_random_track(rng, path->times[0], path->values[0], 3, size);
    }
    if (enf_test_chance(rng, 2)) {
        p->rotation = enf_random_track(rng, path->times[1], path->values[1], 4, 1.0);
    }
    if (enf_test_chance(rng, 3)) {
        p->scale = enf_random_track(rng, path->times[2], path->values[2], 3, 2.0);
    }
    p->wrap = (EnfWrap)enf_test_below(rng, 3);
    p->seconds = enf_test_double(rng, 0.1, 30.0);
    p->period_ticks = 1 + (uint32_t)(p->seconds * ENF_TICK_RATE);
    p->start_tick = (int64_t)enf_test_below(rng, 1000) - 500;
}

static inline EnfMotion enf_random_swing(EnfTestRng *rng, EnfMotionKind kind) {
    EnfMotion motion;
    memset(&motion, 0, sizeof motion);
    motion.kind = kind;
    EnfSwingMotion *swing = &motion.as.swing;
    swing->rest = enf_pose_identity();
    swing->rest.position = enf_v3(enf_test_double(rng, -50, 50), 0.0, 3.0);
    if (enf_test_chance(rng, 2)) {
        swing->rest.rotation = enf_quat_axis_angle(enf_v3(0.0, 0.6, 0.8), enf_test_double(rng, -3.0, 3.0));
        swing->rest.scale = enf_v3(1.5, -0.5, enf_test_double(rng, 0.1, 2.0));
    }
    swing->pivot = enf_add(swing->rest.position, enf_v3(enf_test_double(rng, -1, 1), 0.0, 0.0));
    swing->axis = enf_normalize(enf_v3(enf_test_double(rng, -1, 1), 1.0, enf_test_double(rng, -1, 1)));
    swing->low = -3.0;
    swing->high = 3.0;
    swing->rate = enf_test_double(rng, 1e-3, 20.0);
    return motion;
}

static inline EnfBox3 enf_random_local(EnfTestRng *rng) {
    EnfVec3 a = enf_v3(enf_test_double(rng, -2, 2), enf_test_double(rng, -2, 2), enf_test_double(rng, -2, 2));
    EnfBox3 box = {a, enf_add(a, enf_v3(enf_test_double(rng, 0, 1), enf_test_double(rng, 0, 1), enf_test_double(rng, 0, 1)))};
    return box;
}

static inline int64_t enf_random_tick(EnfTestRng *rng) {
    return enf_test_chance(rng, 3) ? (int64_t)(enf_test_u64(rng) % 1000000000U) : (int64_t)enf_test_below(rng, 4000) - 2000;
}

static inline int64_t enf_random_span(EnfTestRng *rng) {
    static const uint32_t spans[] = {1, 10, 100, 1000, 100000, 1000000000};
    return (int64_t)enf_test_below(rng, spans[enf_test_below(rng, 6)]);
}

#endif
