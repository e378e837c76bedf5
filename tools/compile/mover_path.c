/* The path of an animated node, in the world. What hangs below something that stands is moved there key by key, exactly; what hangs
 * below something that moves itself is mover_chain.c's. */
#include "compile/movers.h"

#include <enfilade/world.h>

#include <math.h>

/* Seconds: longer passes are slips of the keyboard (enf_map_check allows a year). */
#define PASS_MAX 1e7

static const EnfPathTarget targets[3] = {ENF_PATH_TRANSLATION, ENF_PATH_ROTATION, ENF_PATH_SCALE};

uint32_t enf_mover_ticks(double seconds) {
    double ticks = rint(seconds * ENF_TICK_RATE);
    return ticks < 1.0 ? 1U : ticks > 1e9 ? 1000000000U : (uint32_t)ticks;
}

EnfMoverDrive enf_mover_drive(const EnfMovers *movers, uint32_t node, const EnfMoverExtras *extras) {
    EnfMoverDrive drive = {{NULL, NULL, NULL}, 0.0, 0.0, extras->wrap, extras->phase};
    double first = HUGE_VAL, last = 0.0;
    for (uint32_t i = movers->first_path[node]; i != ENF_NONE; i = movers->next_path[i]) {
        const EnfSourcePath *path = &movers->parts->source->paths[i];
        if (!drive.paths[path->target]) {
            drive.paths[path->target] = path;
            first = fmin(first, (double)path->times[0]);
            last = fmax(last, (double)path->times[path->key_count - 1]);
        }
    }
    drive.first = first < HUGE_VAL ? first : 0.0;
    drive.seconds = last > drive.first ? last - drive.first : 1.0 / ENF_TICK_RATE;
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
float *enf_mover_new_path(EnfMoverWork *work, const char *name, EnfPath path, uint32_t *number) {
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

void enf_mover_shift_times(const float *times, uint32_t count, double first, float *out) {
    for (uint32_t key = 0; key < count; key++) {
        out[key] = (float)((double)times[key] - first);
        if (key > 0 && !(out[key] > out[key - 1])) {
            out[key] = enf_round_up(nextafter((double)out[key - 1], HUGE_VAL));
        }
    }
}

/* The curve with its first moment at 0, in the world. */
static bool move_curve(EnfMoverWork *work, const Placement *place, const EnfMoverDrive *drive, EnfPathTarget target,
                       uint32_t *number) {
    const EnfSourcePath *from = drive->paths[target];
    uint32_t components = target == ENF_PATH_ROTATION ? 4 : 3, rows = from->kind == ENF_PATH_CUBIC ? 3 : 1;
    float *to = enf_mover_new_path(work, from->animation,
                                   (EnfPath){.target = target, .kind = from->kind, .key_count = from->key_count}, number);
    if (!to) {
        return false;
    }
    enf_mover_shift_times(from->times, from->key_count, drive->first, to);
    to += from->key_count;
    for (uint32_t row = 0; row < from->key_count * rows; row++) {
        bool tangent = rows == 3 && row % 3 != 1;
        move_value(place, target, tangent, from->values + (size_t)row * components, to + (size_t)row * components);
    }
    return true;
}

/* Do all its keys lie where something could be? */
static bool is_near(const EnfMoverWork *work, const Placement *place, const EnfMoverDrive *drive) {
    bool near = drive->seconds <= PASS_MAX;
    for (int t = 0; t < 3 && near; t++) {
        const EnfSourcePath *path = targets[t] == ENF_PATH_ROTATION ? NULL : drive->paths[targets[t]];
        size_t count = path ? 3 * (size_t)path->key_count * (path->kind == ENF_PATH_CUBIC ? 3 : 1) : 0;
        for (size_t i = 0; i < count && near; i++) {
            near = fabs((double)path->values[i]) * fmax(fabs(place->scale), 1.0) <= ENF_MOVER_FAR;
        }
    }
    if (!near) {
        enf_diagnose(work->parts->diagnosis, ENF_DIAGNOSIS_MOVER_STATIC, work->parts->source->nodes[work->node].name,
                     "its animation takes more than %g s or goes farther than %g m: it stands still", PASS_MAX, ENF_MOVER_FAR);
    }
    return near;
}

bool enf_mover_path(EnfMoverWork *work) {
    const EnfMovers *movers = work->movers;
    uint32_t driver = movers->driver[work->node], parent = movers->parts->source->nodes[work->node].parent;
    if (driver == ENF_NONE) {
        return true;
    }
    Placement place = placement_of(work->parts->source, work->node);
    if (driver != work->node || !place.rigid || (parent != ENF_NONE && movers->driver[parent] != ENF_NONE)) {
        return enf_mover_chain(work);
    }
    EnfMoverDrive drive = enf_mover_drive(movers, work->node, &work->extras);
    uint32_t *numbers[3] = {&work->mover.translation, &work->mover.rotation, &work->mover.scale};
    if (!is_near(work, &place, &drive)) {
        return true;
    }
    for (int t = 0; t < 3; t++) {
        if (drive.paths[targets[t]] && !move_curve(work, &place, &drive, targets[t], numbers[t])) {
            return false;
        }
    }
    work->mover.kind = ENF_MOVER_PATH;
    work->mover.wrap = drive.wrap;
    work->mover.seconds = (float)drive.seconds;
    work->mover.phase = (float)drive.phase;
    return true;
}
