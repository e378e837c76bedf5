/* The motion of what hangs below something that moves: the composition of all the curves above it, sampled at every tick (a state is
 * asked at ticks alone, so nothing is lost between them) and thinned where the run time's own blending gives the samples back: within
 * POSITION_ERROR, TURN_ERROR and SCALE_ERROR. */
#include "compile/movers.h"

#include <enfilade/world.h>

#include <math.h>

enum {
    SAMPLES_MAX = 36000,     /* ticks of a composed pass, ten minutes; longer ones begin again there, with a warning */
    SAMPLES_TOTAL = 1 << 21, /* of a level */
    DEPTH_MAX = 16,          /* animated nodes above one another */
    SEGMENT_MAX = 64         /* ticks between keys */
};
/* Metres (and a part in 10^7 of far coordinates, what floats hold); of a quaternion's components: half as many radians; of 1. */
#define POSITION_ERROR 1e-5
#define TURN_ERROR 2e-6
#define SCALE_ERROR 1e-6
#define FLOAT_ERROR 2e-7

static const EnfPathTarget targets[3] = {ENF_PATH_TRANSLATION, ENF_PATH_ROTATION, ENF_PATH_SCALE};
static const uint32_t widths[3] = {3, 4, 3};
static const double errors[3] = {POSITION_ERROR, TURN_ERROR, SCALE_ERROR};

/* An animated node of the chain, relative to its parent; the floats are its key times from 0. */
typedef struct Link {
    uint32_t node;
    EnfMotion motion;
    float *times;
} Link;

/* From the mover outwards. */
typedef struct Chain {
    Link links[DEPTH_MAX];
    uint32_t count;
    bool cut; /* more hang above it than there is room for */
} Chain;

/* ---- links ------------------------------------------------------------------------------------------------------ */

static EnfPose local_rest(const EnfSource *source, uint32_t node) {
    EnfSourceNode local = source->nodes[node];
    EnfAffine inverse;
    if (local.parent != ENF_NONE && enf_affine_inverse(&source->nodes[local.parent].world, &inverse)) {
        local.world = enf_affine_mul(inverse, local.world);
        enf_source_decompose(&local);
    }
    EnfPose pose = enf_pose_identity();
    pose.position = local.translation;
    pose.rotation = local.rotation;
    pose.scale = local.scale;
    return pose;
}

static bool make_link(const EnfMovers *movers, uint32_t node, const EnfMoverExtras *extras, Link *link) {
    EnfMoverDrive drive = enf_mover_drive(movers, node, extras);
    EnfPathMotion *path = &link->motion.as.path;
    EnfTrack *tracks[3] = {&path->translation, &path->rotation, &path->scale};
    size_t keys = 0;
    memset(link, 0, sizeof *link);
    link->node = node;
    link->motion.kind = ENF_MOTION_PATH;
    path->rest = local_rest(movers->parts->source, node);
    path->wrap = drive.wrap;
    path->seconds = drive.seconds;
    path->period_ticks = enf_mover_ticks(drive.seconds);
    path->start_tick = -llrint(drive.phase * ENF_TICK_RATE);
    for (int t = 0; t < 3; t++) {
        keys += drive.paths[targets[t]] ? drive.paths[targets[t]]->key_count : 0;
    }
    float *times = link->times = malloc((keys + 1) * sizeof *times);
    for (int t = 0; t < 3 && times; t++) {
        const EnfSourcePath *from = drive.paths[targets[t]];
        if (from) {
            enf_mover_shift_times(from->times, from->key_count, drive.first, times);
            *tracks[t] = (EnfTrack){from->kind, from->key_count, times, from->values};
            times += from->key_count;
        }
    }
    return times != NULL;
}

static bool make_chain(const EnfMoverWork *work, Chain *chain) {
    const EnfMovers *movers = work->movers;
    const EnfSource *source = work->parts->source;
    uint32_t n = movers->driver[work->node];
    chain->count = 0;
    while (n != ENF_NONE && chain->count < DEPTH_MAX) {
        EnfMoverExtras extras = n == work->node ? work->extras
                                                : enf_mover_extras(source->nodes[n].extras, source->nodes[n].name, NULL);
        if (!make_link(movers, n, &extras, &chain->links[chain->count++])) {
            return false;
        }
        n = source->nodes[n].parent == ENF_NONE ? ENF_NONE : movers->driver[source->nodes[n].parent];
    }
    chain->cut = n != ENF_NONE;
    return true;
}

static void free_chain(Chain *chain) {
    for (uint32_t i = 0; i < chain->count; i++) {
        free(chain->links[i].times);
    }
}

/* ---- samples ---------------------------------------------------------------------------------------------------- */

/* What leads from `node`'s frame to `from`'s at rest: the nodes between two that are animated stand to one another. */
static EnfAffine between(const EnfSource *source, uint32_t from, uint32_t node) {
    EnfAffine inverse = enf_affine_identity();
    enf_affine_inverse(&source->nodes[from].world, &inverse);
    return from == node ? enf_affine_identity() : enf_affine_mul(inverse, source->nodes[node].world);
}

/* The mover's transform at a tick, outermost link first. */
static EnfAffine world_at(const EnfSource *source, const Chain *chain, uint32_t mover, int64_t tick) {
    EnfAffine world = enf_affine_identity();
    for (uint32_t i = chain->count; i-- > 0;) {
        uint32_t node = chain->links[i].node, parent = source->nodes[node].parent;
        if (i + 1 < chain->count) {
            world = enf_affine_mul(world, between(source, chain->links[i + 1].node, parent));
        } else if (parent != ENF_NONE) {
            world = source->nodes[parent].world;
        }
        EnfPose pose = enf_motion_state(&chain->links[i].motion, tick);
        world = enf_affine_mul(world, enf_affine_trs(pose.position, pose.rotation, pose.scale));
    }
    return enf_affine_mul(world, between(source, chain->links[0].node, mover));
}

/* Ten numbers a tick: translation, rotation, scale. False if one is too large. */
static bool sample(const EnfMoverWork *work, const Chain *chain, int64_t tick, double out[10]) {
    EnfSourceNode node = {.world = world_at(work->parts->source, chain, work->node, tick)};
    enf_source_decompose(&node);
    EnfVec3 p = node.translation, s = node.scale;
    EnfQuat q = node.rotation;
    const double values[10] = {p.x, p.y, p.z, q.x, q.y, q.z, q.w, s.x, s.y, s.z};
    bool near = true;
    for (int i = 0; i < 10; i++) {
        out[i] = values[i];
        near = near && fabs(values[i]) <= ENF_MOVER_FAR;
    }
    return near;
}

/* ---- how long --------------------------------------------------------------------------------------------------- */

static uint64_t common_multiple(uint64_t a, uint64_t b) {
    uint64_t x = a, y = b;
    while (y != 0) {
        uint64_t rest = x % y;
        x = y;
        y = rest;
    }
    return x > 0 ? a / x * b : b;
}

/* The ticks after which the whole chain is where it was, or, where nothing repeats (`once`), comes to rest. */
static uint64_t pass_of(const Chain *chain, bool *once) {
    uint64_t period = 1, end = 1;
    *once = true;
    for (uint32_t i = 0; i < chain->count; i++) {
        const EnfPathMotion *path = &chain->links[i].motion.as.path;
        int64_t rest = path->start_tick + (int64_t)path->period_ticks;
        uint64_t own = path->period_ticks * (path->wrap == ENF_WRAP_PING_PONG ? UINT64_C(2) : UINT64_C(1));
        *once = *once && path->wrap == ENF_WRAP_ONCE;
        end = rest > 0 && (uint64_t)rest > end ? (uint64_t)rest : end;
        period = period > SAMPLES_MAX ? period : common_multiple(period, own);
    }
    return *once ? end : period;
}

/* ---- keys ------------------------------------------------------------------------------------------------------- */

/* Does the run time, from keys at the ends alone, give back the samples between? `rows`: samples of the segment. */
static bool blends(const double *rows, uint32_t ticks, int target) {
    float times[2] = {0.0f, 1.0f}, values[8];
    uint32_t width = widths[target], offset = target == 0 ? 0 : target == 1 ? 3 : 7;
    EnfMotion motion = {.kind = ENF_MOTION_PATH};
    EnfPathMotion *path = &motion.as.path;
    EnfTrack *tracks[3] = {&path->translation, &path->rotation, &path->scale};
    path->rest = enf_pose_identity();
    path->period_ticks = ticks;
    path->seconds = 1.0;
    *tracks[target] = (EnfTrack){ENF_PATH_LINEAR, 2, times, values};
    for (uint32_t i = 0; i < width; i++) {
        values[i] = (float)rows[offset + i];
        values[width + i] = (float)rows[10 * (size_t)ticks + offset + i];
    }
    for (uint32_t tick = 1; tick < ticks; tick++) {
        const double *row = rows + 10 * (size_t)tick + offset;
        EnfPose pose = enf_motion_state(&motion, tick);
        EnfVec3 v = target == 0 ? pose.position : pose.scale;
        const double got[4] = {target == 1 ? pose.rotation.x : v.x, target == 1 ? pose.rotation.y : v.y,
                               target == 1 ? pose.rotation.z : v.z, target == 1 ? pose.rotation.w : 0.0};
        double dot = 0.0;
        for (uint32_t i = 0; i < width; i++) {
            dot += got[i] * row[i];
        }
        double sign = target == 1 && dot < 0.0 ? -1.0 : 1.0;
        for (uint32_t i = 0; i < width; i++) {
            if (fabs(sign * got[i] - row[i]) > errors[target] + FLOAT_ERROR * fabs(row[i])) {
                return false;
            }
        }
    }
    return true;
}

/* Do all samples stand where the mover rests, so that there is nothing to store? */
static bool stands(const EnfMoverWork *work, const double *samples, uint32_t ticks, int target) {
    const EnfEntity *e = &work->assembly->entities.data[work->mover.entity];
    const double rest[10] = {e->translation[0],      e->translation[1],      e->translation[2],      (double)e->rotation[0],
                             (double)e->rotation[1], (double)e->rotation[2], (double)e->rotation[3], (double)e->scale[0],
                             (double)e->scale[1],    (double)e->scale[2]};
    uint32_t offset = target == 0 ? 0 : target == 1 ? 3 : 7;
    for (uint32_t tick = 0; tick <= ticks; tick++) {
        for (uint32_t i = offset; i < offset + widths[target]; i++) {
            if (fabs(samples[10 * (size_t)tick + i] - rest[i]) > errors[target]) {
                return false;
            }
        }
    }
    return true;
}

/* The ticks of the keys, ascending, 0 and the last among them. Returns how many. */
static uint32_t choose_keys(const double *samples, uint32_t ticks, int target, uint32_t *keys) {
    uint32_t count = 0;
    keys[count++] = 0;
    for (uint32_t at = 0; at < ticks;) {
        uint32_t step = 1;
        for (uint32_t longer = 2; longer <= SEGMENT_MAX && at + longer <= ticks; longer *= 2) {
            if (!blends(samples + 10 * (size_t)at, longer, target)) {
                break;
            }
            step = longer;
        }
        at += step;
        keys[count++] = at;
    }
    return count;
}

static bool store_track(EnfMoverWork *work, const double *samples, uint32_t ticks, int target, uint32_t *scratch) {
    uint32_t *numbers[3] = {&work->mover.translation, &work->mover.rotation, &work->mover.scale};
    uint32_t width = widths[target], offset = target == 0 ? 0 : target == 1 ? 3 : 7;
    if (stands(work, samples, ticks, target)) {
        return true;
    }
    uint32_t count = choose_keys(samples, ticks, target, scratch);
    EnfPath path = {.target = targets[target], .kind = ENF_PATH_LINEAR, .key_count = count};
    float *to = enf_mover_new_path(work, work->parts->source->nodes[work->node].name, path, numbers[target]);
    for (uint32_t key = 0; key < count && to; key++) {
        to[key] = (float)((double)scratch[key] / ENF_TICK_RATE);
        for (uint32_t i = 0; i < width; i++) {
            to[count + key * width + i] = enf_finite_float(samples[10 * (size_t)scratch[key] + offset + i]);
        }
    }
    return to != NULL;
}

/* ---- offered ---------------------------------------------------------------------------------------------------- */

static void complain(const EnfMoverWork *work, const char *what) {
    enf_diagnose(work->parts->diagnosis, ENF_DIAGNOSIS_MOVER_STATIC, work->parts->source->nodes[work->node].name, "%s", what);
}

/* Samples 0 to `ticks`; the last of a pass that repeats is its first again. */
static bool sample_all(EnfMoverWork *work, const Chain *chain, uint32_t ticks, bool once, double *samples) {
    bool near = true;
    for (uint32_t tick = 0; tick <= ticks && near; tick++) {
        near = sample(work, chain, once || tick < ticks ? tick : 0, samples + 10 * (size_t)tick);
    }
    return near;
}

static bool store(EnfMoverWork *work, const Chain *chain, uint32_t ticks, bool once) {
    double *samples = malloc(10 * ((size_t)ticks + 1) * sizeof *samples);
    uint32_t *keys = malloc(((size_t)ticks + 1) * sizeof *keys);
    bool ok = samples && keys;
    if (ok && !sample_all(work, chain, ticks, once, samples)) {
        complain(work, "its animation leads farther than there is room: it stands still");
    } else if (ok) {
        for (int t = 0; t < 3 && ok; t++) {
            ok = store_track(work, samples, ticks, t, keys);
        }
        work->mover.kind = ENF_MOVER_PATH;
        work->mover.wrap = once ? ENF_WRAP_ONCE : ENF_WRAP_LOOP;
        work->mover.seconds = (float)((double)ticks / ENF_TICK_RATE);
    }
    free(samples);
    free(keys);
    return ok;
}

bool enf_mover_chain(EnfMoverWork *work) {
    Chain chain;
    bool once = false, ok = make_chain(work, &chain);
    uint64_t pass = ok ? pass_of(&chain, &once) : 0;
    uint32_t ticks = pass > SAMPLES_MAX ? SAMPLES_MAX : (uint32_t)pass;
    if (ok && work->movers->samples + ticks > SAMPLES_TOTAL) {
        complain(work, "too much of the level hangs on what moves: it stands still");
    } else if (ok) {
        if (pass > SAMPLES_MAX) {
            complain(work,
                     "its motion and those it hangs on repeat together after more than ten minutes: it begins again then");
        }
        if (chain.cut) {
            complain(work, "it hangs on more than 16 animated nodes: the outer ones do not move it");
        }
        work->movers->samples += ticks;
        ok = store(work, &chain, ticks, once);
    }
    free_chain(&chain);
    return ok;
}
