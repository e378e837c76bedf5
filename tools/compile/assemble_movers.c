/* Movers of a map: a record for each node that moves, after entities, meshes shared. */
#include "compile/movers.h"

#include <math.h>

/* Metres a second of what nothing is said about: a person who runs. */
#define FREE_SPEED 5.0

/* ---- who moves what --------------------------------------------------------------------------------------------- */

static uint32_t *new_list(uint32_t count) {
    uint32_t *list = malloc(((size_t)count + 1) * sizeof *list);
    if (list) {
        memset(list, 0xff, ((size_t)count + 1) * sizeof *list); /* ENF_NONE */
    }
    return list;
}

/* Lists are filled from their ends, so that they come out in the file's order. Nodes stand behind their parents. */
static void fill_lists(EnfMovers *movers) {
    const EnfSource *source = movers->parts->source;
    const uint32_t *roots = movers->parts->layout->node_movers;
    for (uint32_t i = source->path_count; i-- > 0;) {
        uint32_t node = source->paths[i].node;
        movers->next_path[i] = movers->first_path[node];
        movers->first_path[node] = i;
    }
    for (uint32_t i = source->node_count; i-- > 0;) {
        if (roots[i] != ENF_NONE) {
            movers->next_piece[i] = movers->first_piece[roots[i]];
            movers->first_piece[roots[i]] = i;
        }
    }
    for (uint32_t i = 0; i < source->node_count; i++) {
        uint32_t parent = source->nodes[i].parent;
        bool drives = movers->first_path[i] != ENF_NONE && roots[i] == i;
        movers->driver[i] = drives ? i : parent == ENF_NONE ? ENF_NONE : movers->driver[parent];
    }
}

static bool make_lists(EnfMovers *movers) {
    const EnfSource *source = movers->parts->source;
    movers->meshes = new_list(source->mesh_count);
    movers->first_path = new_list(source->node_count);
    movers->next_path = new_list(source->path_count);
    movers->first_piece = new_list(source->node_count);
    movers->next_piece = new_list(source->node_count);
    movers->driver = new_list(source->node_count);
    bool ok = movers->meshes && movers->first_path && movers->next_path && movers->first_piece && movers->next_piece &&
              movers->driver;
    if (ok) {
        fill_lists(movers);
    }
    return ok;
}

static void free_lists(EnfMovers *movers) {
    free(movers->meshes);
    free(movers->first_path);
    free(movers->next_path);
    free(movers->first_piece);
    free(movers->next_piece);
    free(movers->driver);
    free(movers->nodes.data);
}

/* ---- one mover -------------------------------------------------------------------------------------------------- */

EnfAffine enf_mover_rest(const EnfEntity *e) {
    EnfQuat q = {(double)e->rotation[0], (double)e->rotation[1], (double)e->rotation[2], (double)e->rotation[3]};
    double size = sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    q = (EnfQuat){q.x / size, q.y / size, q.z / size, q.w / size};
    return enf_affine_trs(enf_v3(e->translation[0], e->translation[1], e->translation[2]), q,
                          enf_v3((double)e->scale[0], (double)e->scale[1], (double)e->scale[2]));
}

static EnfMover blank(uint32_t entity) {
    EnfMover mover;
    memset(&mover, 0, sizeof mover);
    mover.entity = entity;
    mover.mesh = mover.translation = mover.rotation = mover.scale = mover.portal = ENF_NONE;
    mover.axis[1] = 1.0f;
    mover.rate = 1.0f;
    mover.seconds = 1.0f;
    return mover;
}

static void set_kind(EnfMoverWork *work) {
    const EnfMoverExtras *extras = &work->extras;
    bool guard = strncmp(extras->classname, "npc_", 4) == 0;
    if (work->mover.kind != ENF_MOVER_STILL) {
        if (strncmp(extras->classname, "func_", 5) == 0) { /* guards are: games steer them, others watch them go */
            enf_diagnose(work->parts->diagnosis, ENF_DIAGNOSIS_MOVER_KEY, work->parts->source->nodes[work->node].name,
                         "it is animated and of class '%s': the animation moves it", extras->classname);
        }
        return;
    }
    enf_mover_swing(work);
    if (work->mover.kind == ENF_MOVER_STILL && (guard || (extras->classname[0] == '\0' && extras->dynamic))) {
        work->mover.kind = ENF_MOVER_FREE;
        work->mover.max_speed = (float)fmax(FREE_SPEED, extras->speed);
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
    } else if (work->mover.kind != ENF_MOVER_FREE) {
        work->mover.max_speed = enf_mover_speed(work);
    }
}

/* A loose thing that stands on the floor, or is let into it, has its origin in no room: its middle is asked for, then what lies
 * halfway to the corners of its box. */
static void find_cell(EnfMoverWork *work) {
    EnfEntity *entity = &work->assembly->entities.data[work->mover.entity];
    EnfMap map = enf_assembly_map(work->assembly, 0);
    for (int i = -1; i < 8 && entity->cell == ENF_NONE && work->mover.mesh != ENF_NONE; i++) {
        const EnfMesh *mesh = &work->assembly->meshes.data[work->mover.mesh];
        double at[3];
        for (int axis = 0; axis < 3; axis++) {
            double share = i < 0 ? 0.5 : (i >> axis & 1) ? 0.25 : 0.75;
            at[axis] = (1.0 - share) * (double)mesh->min[axis] + share * (double)mesh->max[axis];
        }
        entity->cell = enf_map_locate(&map, enf_affine_point(&work->rest, enf_v3(at[0], at[1], at[2])));
    }
}

static bool add_mover(EnfMoverWork *work) {
    EnfAssembly *assembly = work->assembly;
    const EnfSourceNode *node = &work->parts->source->nodes[work->node];
    work->extras = enf_mover_extras(node->extras, node->name, work->parts->diagnosis);
    if (!ENF_ARRAY_ROOM(&assembly->movers, 1) || !ENF_ARRAY_ROOM(&work->movers->nodes, 1) || !enf_mover_mesh(work) ||
        !enf_mover_path(work)) {
        return false;
    }
    find_cell(work);
    set_kind(work);
    set_flags(work);
    assembly->movers.data[assembly->movers.count++] = work->mover;
    work->movers->nodes.data[work->movers->nodes.count++] = work->node;
    return true;
}

/* ---- all movers ------------------------------------------------------------------------------------------------- */

static bool add_node(EnfMovers *movers, uint32_t node) {
    const EnfAssemblyParts *parts = movers->parts;
    uint32_t root = parts->layout->node_movers[node], entity = movers->assembly->node_entities[node];
    bool obstacle = root == ENF_NONE && enf_mover_collides(parts->source, parts->layout, node);
    if (entity == ENF_NONE || (root != node && !obstacle)) {
        return true;
    }
    EnfMoverWork work = {.movers = movers, .assembly = movers->assembly, .parts = parts, .node = node};
    work.mover = blank(entity);
    work.rest = enf_mover_rest(&movers->assembly->entities.data[entity]);
    if (obstacle) {
        work.mover.flags = ENF_MOVER_SOLID;
        return enf_mover_obstacle(&work);
    }
    return add_mover(&work);
}

bool enf_assemble_movers(EnfAssembly *assembly, const EnfAssemblyParts *parts) {
    EnfMovers movers = {.assembly = assembly, .parts = parts, .clip = ENF_NONE};
    if (!parts->layout->node_movers) {
        return true;
    }
    bool ok = make_lists(&movers);
    for (uint32_t i = 0; i < parts->source->node_count && ok; i++) {
        ok = add_node(&movers, i);
    }
    ok = ok && enf_movers_close_portals(&movers);
    free_lists(&movers);
    return ok;
}
