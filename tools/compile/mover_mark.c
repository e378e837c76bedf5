/* Which nodes move. Input: nodes with their animations and extras; output: EnfLayout.node_movers and roles. */
#include "compile/movers.h"

static bool may_move(EnfRole role) {
    return role == ENF_ROLE_GEOMETRY || role == ENF_ROLE_MARKER || role == ENF_ROLE_COLLISION;
}

static bool says_so(const EnfSourceNode *node) {
    if (!node->extras[0]) {
        return false;
    }
    EnfMoverExtras extras = enf_mover_extras(node->extras, node->name, NULL);
    return enf_mover_class(extras.classname) || (extras.dynamic && node->mesh != ENF_NONE);
}

/* Does anything stand once the movers are taken out? */
static bool something_stands(const EnfLayoutWork *work) {
    const EnfSource *source = work->source;
    for (uint32_t i = 0; i < source->node_count; i++) {
        EnfRole role = work->layout->roles[i];
        bool drawn = role == ENF_ROLE_ROOM || (role == ENF_ROLE_GEOMETRY && work->layout->node_movers[i] == ENF_NONE);
        if (drawn && source->nodes[i].mesh != ENF_NONE && source->meshes[source->nodes[i].mesh].primitive_count > 0) {
            return true;
        }
    }
    return false;
}

static void find_roots(EnfLayoutWork *work, bool *driven) {
    const EnfSource *source = work->source;
    uint32_t *movers = work->layout->node_movers;
    for (uint32_t i = 0; i < source->path_count; i++) {
        driven[source->paths[i].node] = true;
    }
    for (uint32_t i = 0; i < source->node_count; i++) {
        const EnfSourceNode *node = &source->nodes[i];
        EnfRole role = work->layout->roles[i];
        movers[i] = node->parent != ENF_NONE && may_move(role) ? movers[node->parent] : ENF_NONE;
        if (may_move(role) && (driven[i] || says_so(node))) {
            movers[i] = i;
        } else if (driven[i] && role != ENF_ROLE_IGNORED) {
            enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_MOVER_STATIC, node->name,
                         "rooms, portals and bounds do not move: its animation is left out");
        }
    }
}

bool enf_movers_mark(EnfLayoutWork *work) {
    const EnfSource *source = work->source;
    uint32_t *movers = malloc(((size_t)source->node_count + 1) * sizeof *movers);
    bool *driven = calloc((size_t)source->node_count + 1, sizeof *driven);
    work->layout->node_movers = movers;
    if (!movers || !driven) {
        free(driven);
        return false;
    }
    find_roots(work, driven);
    free(driven);
    bool moves = something_stands(work);
    for (uint32_t i = 0; i < source->node_count; i++) {
        if (!moves) {
            movers[i] = ENF_NONE;
        } else if (movers[i] != ENF_NONE && work->layout->roles[i] == ENF_ROLE_GEOMETRY) {
            work->layout->roles[i] = ENF_ROLE_MOVER;
        }
    }
    if (!moves && source->path_count > 0) {
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_MOVER_STATIC, "",
                     "nothing in the level stands still: its animations are left out, everything stands as at rest");
    }
    return true;
}
