/* A map's movers as objects of a world: EnfMover → EnfObjectDef. */
#include <enfilade/world.h>

#include <math.h>
#include <string.h>

static EnfPose rest_pose(const EnfEntity *entity) {
    EnfPose pose = enf_pose_identity();
    const float *q = entity->rotation;
    pose.position = enf_v3(entity->translation[0], entity->translation[1], entity->translation[2]);
    EnfQuat turn = {(double)q[0], (double)q[1], (double)q[2], (double)q[3]};
    double length = sqrt(turn.x * turn.x + turn.y * turn.y + turn.z * turn.z + turn.w * turn.w);
    pose.rotation = (EnfQuat){turn.x / length, turn.y / length, turn.z / length, turn.w / length}; /* the map's is not zero */
    pose.scale = enf_v3((double)entity->scale[0], (double)entity->scale[1], (double)entity->scale[2]);
    return pose;
}

static EnfTrack track_of(const EnfMap *map, uint32_t path) {
    EnfTrack track = {ENF_PATH_LINEAR, 0, NULL, NULL};
    if (path != ENF_NONE) {
        const EnfPath *p = &map->paths[path];
        track = (EnfTrack){(EnfPathKind)p->kind, p->key_count, map->path_floats + p->float_first, NULL};
        track.values = track.times + p->key_count;
    }
    return track;
}

/* A pass takes a whole number of ticks, one at least; the phase, too, is rounded to ticks. */
static void make_path(const EnfMap *map, const EnfMover *mover, EnfPose rest, EnfPathMotion *path) {
    double ticks = rint((double)mover->seconds * ENF_TICK_RATE);
    path->rest = rest;
    path->translation = track_of(map, mover->translation);
    path->rotation = track_of(map, mover->rotation);
    path->scale = track_of(map, mover->scale);
    path->wrap = (EnfWrap)mover->wrap;
    path->seconds = (double)mover->seconds;
    path->period_ticks = ticks < 1.0 ? 1U : (uint32_t)ticks;
    path->start_tick = -llrint((double)mover->phase * ENF_TICK_RATE);
}

static void make_swing(const EnfMover *mover, EnfPose rest, EnfSwingMotion *swing) {
    swing->rest = rest;
    swing->pivot = enf_v3(mover->pivot[0], mover->pivot[1], mover->pivot[2]);
    swing->axis = enf_normalize(enf_v3((double)mover->axis[0], (double)mover->axis[1], (double)mover->axis[2]));
    swing->low = (double)mover->low;
    swing->high = (double)mover->high;
    swing->rate = (double)mover->rate;
}

static EnfMotion motion_of(const EnfMap *map, const EnfMover *mover) {
    EnfMotion motion;
    memset(&motion, 0, sizeof motion);
    EnfPose rest = rest_pose(&map->entities[mover->entity]);
    switch ((EnfMoverKind)mover->kind) {
    case ENF_MOVER_PATH:
        motion.kind = ENF_MOTION_PATH;
        make_path(map, mover, rest, &motion.as.path);
        break;
    case ENF_MOVER_HINGE:
    case ENF_MOVER_SLIDE:
        motion.kind = mover->kind == ENF_MOVER_HINGE ? ENF_MOTION_HINGE : ENF_MOTION_SLIDE;
        make_swing(mover, rest, &motion.as.swing);
        break;
    case ENF_MOVER_FREE:
        motion.kind = ENF_MOTION_FREE;
        motion.as.free.pose = rest;
        motion.as.free.max_speed = (double)mover->max_speed;
        break;
    default:
        motion.kind = ENF_MOTION_STILL;
        motion.as.still = rest;
        break;
    }
    return motion;
}

EnfObjectDef enf_mover_def(const EnfMap *map, uint32_t mover) {
    ENF_ASSERT(mover < map->movers_count);
    const EnfMover *m = &map->movers[mover];
    EnfObjectDef def = enf_object_def_default();
    def.motion = motion_of(map, m);
    def.mesh = m->mesh;
    def.user = mover;
    def.max_speed = m->max_speed > 0.0f ? (double)m->max_speed : def.max_speed;
    def.local.min = def.local.max = enf_v3(0.0, 0.0, 0.0);
    if (m->mesh != ENF_NONE) {
        const EnfMesh *mesh = &map->meshes[m->mesh];
        def.local.min = enf_v3((double)mesh->min[0], (double)mesh->min[1], (double)mesh->min[2]);
        def.local.max = enf_v3((double)mesh->max[0], (double)mesh->max[1], (double)mesh->max[2]);
    }
    return def;
}

EnfResult enf_world_populate(EnfWorld *world, EnfError *error) {
    const EnfMap *map = enf_world_map(world);
    for (uint32_t mover = 0; mover < map->movers_count; mover++) {
        EnfObjectDef def = enf_mover_def(map, mover);
        if (enf_world_add(world, &def, error).generation == 0) {
            return ENF_ERROR_MEMORY;
        }
    }
    return ENF_OK;
}
