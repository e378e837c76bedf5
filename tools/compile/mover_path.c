/* The path of an animated node, in the world. What hangs below something that stands is moved there key by key, exactly; what hangs
 * below something that moves itself is sampled at every tick, which is all that the run time ever asks for (a state is asked at
 * ticks alone, so between samples nothing is lost). */
#include "compile/movers.h"

#include <math.h>

/* Ticks a second of the run time (ENF_TICK_RATE, world.h: a room that the compiler does not see). */
#define TICK_RATE 60.0
/* A composed pass is at most ten minutes; longer ones begin again there, with a warning. */
enum { SAMPLES_MAX = 36000 };

static const EnfPathTarget targets[3] = {ENF_PATH_TRANSLATION, ENF_PATH_ROTATION, ENF_PATH_SCALE};

uint32_t enf_mover_ticks(double seconds) {
    double ticks = rint(seconds * TICK_RATE);
    return ticks < 1.0 ? 1U : ticks > 1e9 ? 1000000000U : (uint32_t)ticks;
}

/* The curves of one node: of each target the first animation that drives it. */
typedef struct Drive {
    const EnfSourcePath *paths[3]; /* by target; NULL: as at rest */
    double first, seconds;         /* of all curves: when they begin, how long they take */
    EnfWrap wrap;
    double phase;
} Drive;

static Drive drive_of(const EnfMoverWork *work, uint32_t node, const EnfMoverExtras *extras) {
    const EnfSource *source = work->parts->source;
    Drive drive = {{NULL, NULL, NULL}, 0.0, 0.0, extras->wrap, extras->phase};
    double first = HUGE_VAL, last = 0.0;
    for (uint32_t i = 0; i < source->path_count; i++) {
        const EnfSourcePath *path = &source->paths[i];
        if (path->node == node && !drive.paths[path->target]) {
            drive.paths[path->target] = path;
            first = fmin(first, (double)path->times[0]);
            last = fmax(last, (double)path->times[path->key_count - 1]);
        }
    }
    drive.first = first < HUGE_VAL ? first : 0.0;
    drive.seconds = last > drive.first ? last - drive.first : 1.0 / TICK_RATE;
    return drive;
}

/* ---- keys into the world ---------------------------------------------------------------------------------------- */

/* Where the parent puts its children; the identity for a root. */
typedef struct Placement {
    EnfAffine world;
    EnfQuat rotation;
    double scale;
    bool rigid; /* a rotation and one positive scale for all axes */
} Placement;

static Placement placement_of(const EnfSource *source, uint32_t node) {
    Placement place = {enf_affine_identity(), {0.0, 0.0, 0.0, 1.0}, 1.0, true};
    uint32_t parent = source->nodes[node].parent;
    if (parent != ENF_NONE) {
        const EnfSourceNode *p = &source->nodes[parent];
        place.world = p->world;
        place.rotation = p->rotation;
        place.scale = p->scale.x;
        EnfAffine same = enf_affine_trs(p->translation, p->rotation, enf_v3(p->scale.x, p->scale.x, p->scale.x));
        for (int i = 0; i < 9; i++) {
            place.rigid = place.rigid && fabs(same.m[i] - p->world.m[i]) <= 1e-6 * fabs(place.scale);
        }
        place.rigid = place.rigid && place.scale > 0.0;
    }
    return place;
}

/* One value of a curve: a key's, or a tangent (`tangent`: a difference, which no translation shifts). */
static void move_value(const Placement *place, EnfPathTarget target, bool tangent, const float *from, float *to) {
    double v[4] = {(double)from[0], (double)from[1], (double)from[2], target == ENF_PATH_ROTATION ? (double)from[3] : 0.0};
    if (target == ENF_PATH_TRANSLATION) {
        EnfVec3 p = enf_v3(v[0], v[1], v[2]);
        p = tangent ? enf_affine_vector(&place->world, p) : enf_affine_point(&place->world, p);
        v[0] = p.x, v[1] = p.y, v[2] = p.z;
    } else if (target == ENF_PATH_ROTATION) {
        EnfQuat q = enf_quat_mul(place->rotation, (EnfQuat){v[0], v[1], v[2], v[3]});
        v[0] = q.x, v[1] = q.y, v[2] = q.z, v[3] = q.w;
    } else {
        v[0] *= place->scale, v[1] *= place->scale, v[2] *= place->scale;
    }
    for (int i = 0; i < (target == ENF_PATH_ROTATION ? 4 : 3); i++) {
        to[i] = enf_finite_float(v[i]);
    }
}

/* Room for a path of the mover's entity; its floats are at the returned place, NULL if memory is out. */
static float *new_path(EnfMoverWork *work, const char *name, EnfPath path, uint32_t *number) {
    EnfAssembly *assembly = work->assembly;
    uint64_t width = (path.target == ENF_PATH_ROTATION ? 4 : 3) * (path.kind == ENF_PATH_CUBIC ? 3u : 1u);
    uint64_t floats = (1 + width) * path.key_count;
    if (!ENF_ARRAY_ROOM(&assembly->paths, 1) || !ENF_ARRAY_ROOM(&assembly->path_floats, floats)) {
        return NULL;
    }
    path.name = enf_strings_add(&assembly->texts, name);
    path.entity = work->mover.entity;
    path.float_first = assembly->path_floats.count;
    *number = assembly->paths.count;
    assembly->paths.data[assembly->paths.count++] = path;
    assembly->path_floats.count += (uint32_t)floats;
    return assembly->path_floats.data + path.float_first;
}

/* The curve with its first moment at 0, in the world. Times that floats cannot tell apart once shifted are pushed apart. */
static bool move_curve(EnfMoverWork *work, const Placement *place, const Drive *drive, EnfPathTarget target, uint32_t *number) {
    const EnfSourcePath *from = drive->paths[target];
    uint32_t components = target == ENF_PATH_ROTATION ? 4 : 3, rows = from->kind == ENF_PATH_CUBIC ? 3 : 1;
    float *to = new_path(work, from->animation, (EnfPath){.target = target, .kind = from->kind, .key_count = from->key_count},
                         number);
    if (!to) {
        return false;
    }
    for (uint32_t key = 0; key < from->key_count; key++) {
        to[key] = (float)((double)from->times[key] - drive->first);
        if (key > 0 && !(to[key] > to[key - 1])) {
            to[key] = enf_round_up(nextafter((double)to[key - 1], HUGE_VAL));
        }
    }
    to += from->key_count;
    for (uint32_t row = 0; row < from->key_count * rows; row++) {
        bool tangent = rows == 3 && row % 3 != 1;
        move_value(place, target, tangent, from->values + (size_t)row * components, to + (size_t)row * components);
    }
    return true;
}

/* ---- values ----------------------------------------------------------------------------------------------------- */

static void unit4(double *q) {
    double size = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4 && size > 0.0; i++) {
        q[i] /= size;
    }
}

/* glTF 2.0 appendix C; a rotation is blended along the chord of the shorter way, as accurate as a tick's step needs. */
static void value_at(const EnfSourcePath *path, double seconds, double *out) {
    uint32_t n = path->target == ENF_PATH_ROTATION ? 4 : 3, low = 0, high = path->key_count;
    uint32_t stride = path->kind == ENF_PATH_CUBIC ? 3 * n : n, middle_row = path->kind == ENF_PATH_CUBIC ? n : 0;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        low = (double)path->times[middle] <= seconds ? middle : low;
        high = (double)path->times[middle] <= seconds ? high : middle;
    }
    const float *a = path->values + (size_t)low * stride + middle_row;
    bool last = low + 1 >= path->key_count;
    double span = last ? 1.0 : (double)path->times[low + 1] - (double)path->times[low];
    double s = last ? 0.0 : fmin(fmax((seconds - (double)path->times[low]) / span, 0.0), 1.0);
    const float *b = last ? a : a + stride;
    double dot = 0.0;
    for (uint32_t i = 0; i < n; i++) {
        dot += (double)a[i] * (double)b[i];
    }
    double sign = n == 4 && path->kind == ENF_PATH_LINEAR && dot < 0.0 ? -1.0 : 1.0;
    for (uint32_t i = 0; i < n; i++) {
        double p = (double)a[i], q = sign * (double)b[i];
        if (path->kind == ENF_PATH_STEP || last) {
            out[i] = p;
        } else if (path->kind == ENF_PATH_LINEAR) {
            out[i] = p + s * (q - p);
        } else {
            double m0 = span * (double)a[n + i], m1 = span * (double)b[(int)i - (int)n];
            out[i] = ((2 * (p - q) + m0 + m1) * s + (3 * (q - p) - 2 * m0 - m1)) * s * s + m0 * s + p;
        }
    }
    if (n == 4) {
        unit4(out);
    }
}

/* Seconds into the curves at a tick. */
static double time_at(const Drive *drive, int64_t tick) {
    int64_t period = (int64_t)enf_mover_ticks(drive->seconds);
    int64_t at = tick + llrint(drive->phase * TICK_RATE);
    if (drive->wrap == ENF_WRAP_ONCE) {
        at = at < 0 ? 0 : at > period ? period : at;
    } else if (drive->wrap == ENF_WRAP_LOOP) {
        at = (at % period + period) % period;
    } else {
        at = (at % (2 * period) + 2 * period) % (2 * period);
        at = at > period ? 2 * period - at : at;
    }
    return drive->first + (double)at / (double)period * drive->seconds;
}

/* The node's transform relative to its parent at a tick. */
static EnfAffine local_at(const EnfSource *source, uint32_t node, const Drive *drive, int64_t tick) {
    uint32_t parent = source->nodes[node].parent;
    EnfSourceNode local = source->nodes[node];
    EnfAffine inverse;
    if (parent != ENF_NONE && enf_affine_inverse(&source->nodes[parent].world, &inverse)) {
        local.world = enf_affine_mul(inverse, local.world);
        enf_source_decompose(&local);
    }
    double v[4];
    double seconds = time_at(drive, tick);
    if (drive->paths[ENF_PATH_TRANSLATION]) {
        value_at(drive->paths[ENF_PATH_TRANSLATION], seconds, v);
        local.translation = enf_v3(v[0], v[1], v[2]);
    }
    if (drive->paths[ENF_PATH_ROTATION]) {
        value_at(drive->paths[ENF_PATH_ROTATION], seconds, v);
        local.rotation = (EnfQuat){v[0], v[1], v[2], v[3]};
    }
    if (drive->paths[ENF_PATH_SCALE]) {
        value_at(drive->paths[ENF_PATH_SCALE], seconds, v);
        local.scale = enf_v3(v[0], v[1], v[2]);
    }
    return enf_affine_trs(local.translation, local.rotation, local.scale);
}

/* ---- what hangs below something that moves ---------------------------------------------------------------------- */

enum { DEPTH_MAX = 16 };

/* The animated nodes from the outermost to the mover itself, and the nodes between them rest relative to them. */
typedef struct Chain {
    uint32_t nodes[DEPTH_MAX];
    Drive drives[DEPTH_MAX];
    uint32_t count;
} Chain;

static bool is_driven(const Drive *drive) {
    return drive->paths[0] || drive->paths[1] || drive->paths[2];
}

static Chain chain_of(EnfMoverWork *work) {
    const EnfSource *source = work->parts->source;
    Chain chain = {.count = 0};
    for (uint32_t n = work->node; n != ENF_NONE && chain.count < DEPTH_MAX; n = source->nodes[n].parent) {
        EnfMoverExtras extras = n == work->node ? work->extras : enf_mover_extras(source->nodes[n].extras, "", NULL);
        Drive drive = drive_of(work, n, &extras);
        if (is_driven(&drive)) {
            chain.nodes[chain.count] = n;
            chain.drives[chain.count++] = drive;
        }
    }
    return chain;
}

/* The mover's transform at a tick: outermost first; what stands between two animated nodes is the quotient of their rest transforms. */
static EnfAffine world_at(const EnfSource *source, const Chain *chain, uint32_t mover, int64_t tick) {
    EnfAffine world = enf_affine_identity();
    for (uint32_t i = chain->count; i-- > 0;) {
        uint32_t node = chain->nodes[i], parent = source->nodes[node].parent;
        if (i + 1 == chain->count) {
            world = parent == ENF_NONE ? world : source->nodes[parent].world;
        } else if (parent != chain->nodes[i + 1]) {
            EnfAffine inverse = enf_affine_identity();
            enf_affine_inverse(&source->nodes[chain->nodes[i + 1]].world, &inverse);
            world = enf_affine_mul(world, enf_affine_mul(inverse, source->nodes[parent].world));
        }
        world = enf_affine_mul(world, local_at(source, node, &chain->drives[i], tick));
    }
    EnfAffine inverse = enf_affine_identity();
    enf_affine_inverse(&source->nodes[chain->nodes[0]].world, &inverse);
    return mover == chain->nodes[0] ? world : enf_affine_mul(world, enf_affine_mul(inverse, source->nodes[mover].world));
}

/* The ticks after which all of the chain is where it was; SAMPLES_MAX at most. `once`: nothing repeats. */
static uint32_t common_period(const Chain *chain, bool *once, bool *cut) {
    uint64_t period = 1;
    *once = true;
    for (uint32_t i = 0; i < chain->count; i++) {
        const Drive *drive = &chain->drives[i];
        uint64_t own = enf_mover_ticks(drive->seconds) * (drive->wrap == ENF_WRAP_PING_PONG ? UINT64_C(2) : 1);
        *once = *once && drive->wrap == ENF_WRAP_ONCE;
        uint64_t a = period, b = own;
        while (b != 0) {
            uint64_t rest = a % b;
            a = b;
            b = rest;
        }
        period = period > SAMPLES_MAX ? period : period / a * own;
    }
    *cut = period > SAMPLES_MAX;
    return *cut ? SAMPLES_MAX : (uint32_t)period;
}

static bool sample_chain(EnfMoverWork *work, const Chain *chain) {
    const EnfSource *source = work->parts->source;
    const char *name = source->nodes[work->node].name;
    bool once, cut;
    uint32_t ticks = common_period(chain, &once, &cut);
    uint32_t *numbers[3] = {&work->mover.translation, &work->mover.rotation, &work->mover.scale};
    if (cut) {
        enf_diagnose(work->parts->diagnosis, ENF_DIAGNOSIS_MOVER_KEY, name,
                     "its motion and those it hangs on repeat together after more than ten minutes: it begins again after ten");
    }
    for (int t = 0; t < 3; t++) {
        uint32_t components = targets[t] == ENF_PATH_ROTATION ? 4 : 3;
        EnfPath path = {.target = targets[t], .kind = ENF_PATH_LINEAR, .key_count = ticks + 1};
        float *to = new_path(work, name, path, numbers[t]);
        if (!to) {
            return false;
        }
        for (uint32_t tick = 0; tick <= ticks; tick++) {
            EnfSourceNode node = {.world = world_at(source, chain, work->node, once ? tick : tick % ticks)};
            enf_source_decompose(&node);
            const double values[3][4] = {{node.translation.x, node.translation.y, node.translation.z},
                                         {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w},
                                         {node.scale.x, node.scale.y, node.scale.z}};
            to[tick] = (float)((double)tick / TICK_RATE);
            for (uint32_t i = 0; i < components; i++) {
                to[ticks + 1 + tick * components + i] = enf_finite_float(values[t][i]);
            }
        }
    }
    work->mover.wrap = once ? ENF_WRAP_ONCE : ENF_WRAP_LOOP;
    work->mover.seconds = (float)((double)ticks / TICK_RATE);
    work->mover.phase = 0.0f;
    return true;
}

/* ---- offered ---------------------------------------------------------------------------------------------------- */

bool enf_mover_path(EnfMoverWork *work) {
    const EnfSource *source = work->parts->source;
    Chain chain = chain_of(work);
    if (chain.count == 0) {
        return true;
    }
    work->mover.kind = ENF_MOVER_PATH;
    Placement place = placement_of(source, work->node);
    if (chain.count > 1 || chain.nodes[0] != work->node || !place.rigid) {
        return sample_chain(work, &chain);
    }
    const Drive *drive = &chain.drives[0];
    uint32_t *numbers[3] = {&work->mover.translation, &work->mover.rotation, &work->mover.scale};
    for (int t = 0; t < 3; t++) {
        if (drive->paths[targets[t]] && !move_curve(work, &place, drive, targets[t], numbers[t])) {
            return false;
        }
    }
    work->mover.wrap = drive->wrap;
    work->mover.seconds = (float)drive->seconds;
    work->mover.phase = (float)drive->phase;
    return true;
}
