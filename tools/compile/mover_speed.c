/* How fast any point of a mover can be, where its motion tells: from its mesh's box and the steepest part of its curves. Volumes of what
 * is slow may last longer (engine/dbv). Whatever jumps, or turns along a cubic, has no such limit here: 0, unknown. */
#include "compile/movers.h"

#include <enfilade/world.h>

#include <math.h>

/* What the run time's rounding may add: poses are doubles, keys floats. */
#define SLACK 1.0001

static const float *path_of(const EnfMoverWork *work, uint32_t number, const EnfPath **path) {
    *path = number == ENF_NONE ? NULL : &work->assembly->paths.data[number];
    return *path ? work->assembly->path_floats.data + (*path)->float_first : NULL;
}

static double length_of(const double *v, uint32_t n) {
    double sum = 0.0;
    for (uint32_t i = 0; i < n; i++) {
        sum += v[i] * v[i];
    }
    return sqrt(sum);
}

/* The largest |derivative| of a segment: of a line its slope; of a cubic no more than the Bezier points of its derivative. */
static double slope(const EnfPath *path, const float *values, uint32_t key, double span) {
    bool cubic = path->kind == ENF_PATH_CUBIC;
    const float *p = values + (size_t)key * (cubic ? 9 : 3) + (cubic ? 3 : 0), *q = p + (cubic ? 9 : 3);
    double chord[3], out[3], in[3], middle[3];
    for (int i = 0; i < 3; i++) {
        chord[i] = ((double)q[i] - (double)p[i]) / span;
        out[i] = cubic ? (double)p[3 + i] : chord[i];
        in[i] = cubic ? (double)q[i - 3] : chord[i];
        middle[i] = 3.0 * chord[i] - out[i] - in[i];
    }
    return cubic ? fmax(fmax(length_of(out, 3), length_of(in, 3)), length_of(middle, 3)) : length_of(chord, 3);
}

/* Radians a second of a spherical blend: its whole angle in its span. */
static double turning(const float *values, uint32_t key, double span) {
    const float *p = values + 4 * (size_t)key, *q = p + 4;
    double a[4], b[4], less[4], more[4], dot = 0.0;
    for (int i = 0; i < 4; i++) {
        a[i] = (double)p[i], b[i] = (double)q[i];
    }
    double size_a = length_of(a, 4), size_b = length_of(b, 4);
    if (!(size_a > 0.0 && size_b > 0.0)) {
        return HUGE_VAL;
    }
    for (int i = 0; i < 4; i++) {
        dot += a[i] / size_a * (b[i] / size_b);
    }
    for (int i = 0; i < 4; i++) {
        double turned = (dot < 0.0 ? -1.0 : 1.0) * b[i] / size_b;
        less[i] = turned - a[i] / size_a, more[i] = turned + a[i] / size_a;
    }
    return 4.0 * enf_atan2(length_of(less, 4), length_of(more, 4)) / span;
}

/* Does a curve come back to where it began? Else a loop jumps. */
static bool closes(const EnfPath *path, const float *values, uint32_t width) {
    uint32_t stride = path->kind == ENF_PATH_CUBIC ? 3 * width : width, first = path->kind == ENF_PATH_CUBIC ? width : 0;
    double same = 1.0, negated = 1.0;
    for (uint32_t i = 0; i < width; i++) {
        double a = (double)values[first + i], b = (double)values[(size_t)(path->key_count - 1) * stride + first + i];
        same = fabs(a - b) > 1e-5 ? 0.0 : same;
        negated = fabs(a + b) > 1e-5 || width != 4 ? 0.0 : negated;
    }
    return same + negated > 0.0;
}

/* The steepest of a curve, a second of its time; HUGE_VAL where it jumps. */
static double steepest(const EnfMoverWork *work, uint32_t number, uint32_t width) {
    const EnfPath *path;
    const float *times = path_of(work, number, &path), *values = path ? times + path->key_count : NULL;
    double most = 0.0;
    if (!path || path->key_count == 1) {
        return 0.0;
    }
    if (path->kind == ENF_PATH_STEP || (width == 4 && path->kind == ENF_PATH_CUBIC) ||
        (work->mover.wrap == ENF_WRAP_LOOP && !closes(path, values, width))) {
        return HUGE_VAL;
    }
    for (uint32_t key = 0; key + 1 < path->key_count; key++) {
        double span = (double)times[key + 1] - (double)times[key];
        most = fmax(most, width == 4 ? turning(values, key, span) : slope(path, values, key, span));
    }
    return most;
}

/* The largest scale of any axis, at rest or at a key; a cubic may overshoot. */
static double largest_scale(const EnfMoverWork *work) {
    const EnfPath *path;
    const float *times = path_of(work, work->mover.scale, &path);
    const float *rest = work->assembly->entities.data[work->mover.entity].scale;
    double most = 0.0;
    for (int i = 0; i < 3 && !path; i++) {
        most = fmax(most, fabs((double)rest[i]));
    }
    for (uint32_t i = 0; path && i < 3 * path->key_count && path->kind != ENF_PATH_CUBIC; i++) {
        most = fmax(most, fabs((double)times[path->key_count + i]));
    }
    return path && path->kind == ENF_PATH_CUBIC ? HUGE_VAL : most;
}

/* A point of the mesh's box: its distance from the mesh's origin, or, after `rest`, from the hinge's axis. */
static double reach(const EnfMoverWork *work, bool from_axis) {
    double most = 0.0;
    if (work->mover.mesh == ENF_NONE) {
        return 0.0;
    }
    const EnfMesh *mesh = &work->assembly->meshes.data[work->mover.mesh];
    const float *a = work->mover.axis;
    const double *pivot = work->mover.pivot;
    EnfVec3 axis = enf_normalize(enf_v3((double)a[0], (double)a[1], (double)a[2]));
    for (int i = 0; i < 8; i++) {
        EnfVec3 p = enf_v3((double)(i & 1 ? mesh->max[0] : mesh->min[0]), (double)(i & 2 ? mesh->max[1] : mesh->min[1]),
                           (double)(i & 4 ? mesh->max[2] : mesh->min[2]));
        if (from_axis) {
            EnfVec3 from = enf_sub(enf_affine_point(&work->rest, p), enf_v3(pivot[0], pivot[1], pivot[2]));
            p = enf_cross(axis, from);
        }
        most = fmax(most, enf_length(p));
    }
    return most;
}

static double path_speed(const EnfMoverWork *work) {
    const EnfMover *mover = &work->mover;
    double passes = (double)mover->seconds * ENF_TICK_RATE / (double)enf_mover_ticks((double)mover->seconds);
    double turn = steepest(work, mover->rotation, 4), stretch = steepest(work, mover->scale, 3);
    double size = reach(work, false), speed = steepest(work, mover->translation, 3);
    speed += turn > 0.0 ? turn * size * largest_scale(work) : 0.0;
    speed += stretch > 0.0 ? stretch * size : 0.0;
    return speed * passes;
}

float enf_mover_speed(const EnfMoverWork *work) {
    double speed = 0.0;
    if (work->mover.kind == ENF_MOVER_SLIDE) {
        speed = (double)work->mover.rate;
    } else if (work->mover.kind == ENF_MOVER_HINGE) {
        speed = (double)work->mover.rate * reach(work, true);
    } else if (work->mover.kind == ENF_MOVER_PATH) {
        speed = path_speed(work);
    }
    return speed < 1e6 ? enf_round_up(speed * SLACK) : 0.0f;
}
