/* Movers of a map: a record for each node that moves, after entities, meshes shared. */
#include "compile/movers.h"

#include <math.h>

/* Metres a second of what nothing is said about: a person who runs. */
#define FREE_SPEED 5.0

/* The entity's floats, as the run time will read them. */
static EnfAffine rest_of(const EnfEntity *e) {
    EnfQuat q = {(double)e->rotation[0], (double)e->rotation[1], (double)e->rotation[2], (double)e->rotation[3]};
    double size = sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    q = (EnfQuat){q.x / size, q.y / size, q.z / size, q.w / size};
    return enf_affine_trs(enf_v3(e->translation[0], e->translation[1], e->translation[2]), q,
                          enf_v3((double)e->scale[0], (double)e->scale[1], (double)e->scale[2]));
}

static void blank(EnfMover *mover, uint32_t entity) {
    memset(mover, 0, sizeof *mover);
    mover->entity = entity;
    mover->mesh = mover->translation = mover->rotation = mover->scale = mover->portal = ENF_NONE;
    mover->axis[1] = 1.0f;
    mover->rate = 1.0f;
    mover->seconds = 1.0f;
}

static void set_kind(EnfMoverWork *work) {
    const EnfMoverExtras *extras = &work->extras;
    bool steered = strncmp(extras->classname, "npc_", 4) == 0 || (extras->classname[0] == '\0' && extras->dynamic);
    if (work->mover.kind != ENF_MOVER_STILL) {
        return; /* animated */
    }
    enf_mover_swing(work);
    if (work->mover.kind == ENF_MOVER_STILL && steered) {
        work->mover.kind = ENF_MOVER_FREE;
        work->mover.max_speed = (float)FREE_SPEED;
    }
}

static void set_flags(EnfMoverWork *work) {
    const EnfMoverExtras *extras = &work->extras;
    bool carried = strcmp(extras->classname, "prop_exhibit") == 0 || strncmp(extras->classname, "item_", 5) == 0;
    work->mover.flags = (extras->solid ? ENF_MOVER_SOLID : 0U) | (extras->locked ? ENF_MOVER_LOCKED : 0U) |
                        (carried ? ENF_MOVER_CARRY : 0U);
    work->mover.validity_ticks = extras->validity > 0.0 ? enf_mover_ticks(extras->validity) : 0;
    if (extras->max_speed > 0.0) {
        work->mover.max_speed = (float)extras->max_speed;
    }
}

static bool add_mover(EnfMoverWork *work, uint32_t *shared) {
    EnfAssembly *assembly = work->assembly;
    const EnfSourceNode *node = &work->parts->source->nodes[work->node];
    uint32_t entity = assembly->node_entities[work->node];
    if (entity == ENF_NONE || !ENF_ARRAY_ROOM(&assembly->movers, 1)) {
        return entity == ENF_NONE;
    }
    blank(&work->mover, entity);
    work->extras = enf_mover_extras(node->extras, node->name, work->parts->diagnosis);
    work->rest = rest_of(&assembly->entities.data[entity]);
    if (!enf_mover_mesh(work, shared) || !enf_mover_path(work)) {
        return false;
    }
    set_kind(work);
    set_flags(work);
    assembly->movers.data[assembly->movers.count++] = work->mover;
    return true;
}

/* The material of what collides and is not drawn, made when it is first asked for; ENF_NONE if memory is out. */
static uint32_t clip_material(EnfAssembly *assembly, uint32_t *clip) {
    if (*clip == ENF_NONE && ENF_ARRAY_ROOM(&assembly->materials, 1)) {
        EnfMaterial material = {.name = enf_strings_add(&assembly->texts, "clip"),
                                .texture = ENF_NONE,
                                .emissive_texture = ENF_NONE,
                                .flags = ENF_MATERIAL_NODRAW | ENF_MATERIAL_CLIP,
                                .base_color = {1.0f, 1.0f, 1.0f, 1.0f},
                                .uv_transform = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}};
        *clip = assembly->materials.count;
        assembly->materials.data[assembly->materials.count++] = material;
    }
    return *clip;
}

/* An obstacle that nobody sees: a mover that stands still, so that cells and their surfaces know nothing of it. */
static bool add_obstacle(EnfMoverWork *work, uint32_t *shared, uint32_t *clip) {
    EnfAssembly *assembly = work->assembly;
    uint32_t entity = assembly->node_entities[work->node];
    work->clip = clip_material(assembly, clip);
    if (entity == ENF_NONE || work->clip == ENF_NONE || !ENF_ARRAY_ROOM(&assembly->movers, 1)) {
        return entity == ENF_NONE;
    }
    blank(&work->mover, entity);
    work->rest = rest_of(&assembly->entities.data[entity]);
    work->mover.flags = ENF_MOVER_SOLID;
    if (!enf_mover_mesh(work, shared)) {
        return false;
    }
    assembly->movers.data[assembly->movers.count++] = work->mover;
    return true;
}

bool enf_assemble_movers(EnfAssembly *assembly, const EnfAssemblyParts *parts) {
    const EnfSource *source = parts->source;
    const uint32_t *movers = parts->layout->node_movers;
    if (!movers) {
        return true;
    }
    uint32_t *shared = malloc(((size_t)source->mesh_count + 1) * sizeof *shared);
    uint32_t *nodes = malloc(((size_t)source->node_count + 2) * sizeof *nodes);
    bool ok = shared && nodes;
    if (ok) {
        memset(shared, 0xff, ((size_t)source->mesh_count + 1) * sizeof *shared);
    }
    uint32_t clip = ENF_NONE;
    for (uint32_t i = 0; i < source->node_count && ok; i++) {
        EnfMoverWork work = {.assembly = assembly, .parts = parts, .node = i, .clip = ENF_NONE};
        nodes[assembly->movers.count] = i;
        if (movers[i] == i) {
            ok = add_mover(&work, shared);
        } else if (enf_mover_collides(source, parts->layout, i)) {
            ok = add_obstacle(&work, shared, &clip);
        }
    }
    ok = ok && enf_movers_close_portals(assembly, parts, nodes);
    free(shared);
    free(nodes);
    return ok;
}
