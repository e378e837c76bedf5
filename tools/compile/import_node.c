/* Source nodes: what the default scene reaches, parents before children, with world transforms in double. A node with
 * EXT_mesh_gpu_instancing hands its mesh to copies that follow it. */
#include "compile/import.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The grid of the compiler ends at 2^28 m (math.h); a transform beyond it would only be clamped there. */
#define WORLD_LIMIT 268435456.0

typedef struct Visit {
    uint32_t file_node, parent; /* parent: in source nodes */
} Visit;

typedef struct Walk {
    EnfImport *import;
    EnfSourceNode *nodes;
    uint32_t count, capacity;
    Visit *stack;
    uint32_t depth;
    bool *moved; /* a file node that an animation moves */
} Walk;

/* ---- transforms ------------------------------------------------------------------------------------------------- */

static EnfQuat unit_quat(const double *r) {
    double largest = fmax(fmax(fabs(r[0]), fabs(r[1])), fmax(fabs(r[2]), fabs(r[3])));
    if (!(largest > 0.0) || isinf(largest)) {
        return (EnfQuat){0.0, 0.0, 0.0, 1.0};
    }
    double q[4], sum = 0.0;
    for (int i = 0; i < 4; i++) {
        q[i] = r[i] / largest; /* no square overflows or vanishes */
        sum += q[i] * q[i];
    }
    double length = sqrt(sum);
    return (EnfQuat){q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

static EnfAffine local_transform(const EnfGltfNode *node) {
    if (!node->has_matrix) {
        const double *t = node->translation, *s = node->scale;
        return enf_affine_trs(enf_v3(t[0], t[1], t[2]), unit_quat(node->rotation), enf_v3(s[0], s[1], s[2]));
    }
    EnfAffine out;
    for (int column = 0; column < 3; column++) {
        for (int row = 0; row < 3; row++) {
            out.m[3 * column + row] = node->matrix[4 * column + row];
        }
    }
    out.t = enf_v3(node->matrix[12], node->matrix[13], node->matrix[14]);
    return out;
}

static bool is_usable(const EnfAffine *a) {
    for (int i = 0; i < 9; i++) {
        if (!isfinite(a->m[i])) {
            return false;
        }
    }
    return fabs(a->t.x) <= WORLD_LIMIT && fabs(a->t.y) <= WORLD_LIMIT && fabs(a->t.z) <= WORLD_LIMIT;
}

/* Quaternion of an orthonormal matrix of determinant 1, from its largest component (Shepperd 1978). */
static EnfQuat quat_of(const EnfVec3 x, const EnfVec3 y, const EnfVec3 z) {
    double q[4];
    double trace = x.x + y.y + z.z;
    if (trace >= x.x && trace >= y.y && trace >= z.z) {
        q[3] = 1.0 + trace, q[0] = y.z - z.y, q[1] = z.x - x.z, q[2] = x.y - y.x;
    } else if (x.x >= y.y && x.x >= z.z) {
        q[0] = 1.0 + x.x - y.y - z.z, q[3] = y.z - z.y, q[1] = x.y + y.x, q[2] = z.x + x.z;
    } else if (y.y >= z.z) {
        q[1] = 1.0 + y.y - x.x - z.z, q[3] = z.x - x.z, q[0] = x.y + y.x, q[2] = y.z + z.y;
    } else {
        q[2] = 1.0 + z.z - x.x - y.y, q[3] = x.y - y.x, q[0] = z.x + x.z, q[1] = y.z + z.y;
    }
    return unit_quat(q);
}

static EnfVec3 column(const EnfAffine *a, int c) {
    return enf_v3(a->m[3 * c], a->m[3 * c + 1], a->m[3 * c + 2]);
}

void enf_source_decompose(EnfSourceNode *node) {
    const EnfAffine *world = &node->world;
    double sign = enf_affine_det(world) < 0.0 ? -1.0 : 1.0;
    EnfVec3 x = column(world, 0), y = column(world, 1), z = column(world, 2);
    node->translation = world->t;
    node->scale = enf_v3(sign * enf_length(x), enf_length(y), enf_length(z));
    x = enf_normalize(enf_scale(x, sign));
    y = enf_normalize(enf_sub(y, enf_scale(x, enf_dot(x, y))));
    bool degenerate = enf_dot(x, x) == 0.0 || enf_dot(y, y) == 0.0;
    node->rotation = degenerate ? (EnfQuat){0.0, 0.0, 0.0, 1.0} : quat_of(x, y, enf_cross(x, y));
}

/* ---- extras ----------------------------------------------------------------------------------------------------- */

static const char *add_spawn_class(EnfImport *import, const char *extras, uint32_t classname) {
    static const char spawn[] = "{\"classname\":\"info_player_start\"";
    if (classname != ENF_NONE) {
        return extras;
    }
    bool empty = extras[0] == '\0' || strcmp(extras, "{}") == 0;
    size_t size = strlen(extras) + sizeof spawn + 2;
    char *joined = enf_import_keep(import, size, 1);
    if (joined) {
        snprintf(joined, size, "%s%s%s", spawn, empty ? "}" : ",", empty ? "" : extras + 1);
    }
    return joined;
}

/* The node's extras as compact JSON, if they are an object; OMI_spawn_point becomes the class that it means (DESIGN section 6). */
static const char *read_extras(Walk *walk, uint32_t file_node) {
    EnfImport *import = walk->import;
    const EnfJson *json = &import->json;
    uint32_t value = enf_json_member(json, import->node_values[file_node], "extras");
    const char *extras = "";
    if (value != ENF_NONE && json->values[value].type == ENF_JSON_OBJECT) {
        char *text = enf_import_keep(import, json->values[value].end - json->values[value].start + 1, 1);
        if (text) {
            enf_json_compact(json, value, text);
        }
        extras = text;
    }
    if (extras && import->gltf.nodes[file_node].spawn_point) {
        extras = add_spawn_class(import, extras, enf_json_member(json, value, "classname"));
    }
    return extras;
}

/* ---- the walk --------------------------------------------------------------------------------------------------- */

static EnfResult fill_node(Walk *walk, EnfSourceNode *node, Visit visit) {
    EnfImport *import = walk->import;
    const EnfGltfNode *from = &import->gltf.nodes[visit.file_node];
    const EnfSourceNode *parent = visit.parent == ENF_NONE ? NULL : &walk->nodes[visit.parent];
    char fallback[32];
    snprintf(fallback, sizeof fallback, "node %u", visit.file_node);
    *node = (EnfSourceNode){.name = enf_import_text(import, from->name[0] ? from->name : fallback),
                            .index = visit.file_node,
                            .parent = visit.parent,
                            .world = local_transform(from),
                            .mesh = from->mesh,
                            .camera = from->camera,
                            .light = from->light,
                            .extras = read_extras(walk, visit.file_node),
                            .animated = walk->moved[visit.file_node] || (parent && parent->animated)};
    if (parent) {
        node->world = enf_affine_mul(parent->world, node->world);
    }
    if (!node->name || !node->extras) {
        return import->failure;
    }
    if (!is_usable(&node->world)) {
        return enf_error_set(import->error, ENF_ERROR_RANGE, UINT64_MAX,
                             "nodes[%u]: '%.100s' lies more than 2^28 m away, or its transform overflows", visit.file_node,
                             node->name);
    }
    enf_source_decompose(node);
    if (from->skinned) {
        enf_diagnose(import->diagnosis, ENF_DIAGNOSIS_UNSUPPORTED, node->name, "skinning is not supported; drawn as modelled");
    }
    return ENF_OK;
}

/* How many copies the node's instancing makes; ENF_NONE if it has none. */
static uint32_t instance_count(const EnfGltf *gltf, const EnfGltfNode *node) {
    const uint32_t accessors[3] = {node->instance_translation, node->instance_rotation, node->instance_scale};
    for (int i = 0; i < 3; i++) {
        if (accessors[i] != ENF_NONE) {
            return (uint32_t)gltf->accessors[accessors[i]].count;
        }
    }
    return ENF_NONE;
}

static EnfResult read_instances(Walk *walk, const EnfGltfNode *from, uint32_t count, float *trs[3]) {
    const uint32_t accessors[3] = {from->instance_translation, from->instance_rotation, from->instance_scale};
    static const float missing[3][4] = {{0, 0, 0, 0}, {0, 0, 0, 1}, {1, 1, 1, 0}};
    for (int i = 0; i < 3; i++) {
        uint32_t components = i == 1 ? 4 : 3;
        trs[i] = enf_import_scratch(walk->import, count, components * sizeof(float));
        if (!trs[i]) {
            return walk->import->failure;
        }
        for (size_t k = 0; k < (size_t)count * components; k++) {
            trs[i][k] = missing[i][k % components];
        }
        if (accessors[i] == ENF_NONE) {
            continue;
        }
        EnfResult result = enf_import_floats(walk->import, accessors[i], (EnfImportRange){0, count}, components, trs[i]);
        if (result != ENF_OK) {
            return result;
        }
    }
    return ENF_OK;
}

static EnfAffine instance_transform(float *const trs[3], uint32_t i) {
    double r[4];
    for (int k = 0; k < 4; k++) {
        r[k] = (double)trs[1][4 * (size_t)i + (size_t)k];
    }
    const float *t = trs[0] + 3 * (size_t)i, *s = trs[2] + 3 * (size_t)i;
    return enf_affine_trs(enf_v3((double)t[0], (double)t[1], (double)t[2]), unit_quat(r),
                          enf_v3((double)s[0], (double)s[1], (double)s[2]));
}

/* Copies of node `owner` behind it. Only the mesh is copied, as the extension says. */
static EnfResult add_instances(Walk *walk, uint32_t owner, uint32_t count) {
    EnfImport *import = walk->import;
    EnfSourceNode *node = &walk->nodes[owner];
    float *trs[3];
    EnfResult result = read_instances(walk, &import->gltf.nodes[node->index], count, trs);
    for (uint32_t i = 0; i < count && result == ENF_OK; i++) {
        EnfSourceNode *copy = &walk->nodes[walk->count++];
        EnfAffine local = instance_transform(trs, i);
        *copy = *node;
        copy->parent = owner;
        copy->camera = copy->light = ENF_NONE;
        copy->extras = "";
        copy->world = enf_affine_mul(node->world, local);
        if (!is_usable(&copy->world)) {
            result = enf_error_set(import->error, ENF_ERROR_RANGE, UINT64_MAX, "nodes[%u]: instance %u has no usable transform",
                                   node->index, i);
        }
        enf_source_decompose(copy);
    }
    node->mesh = ENF_NONE;
    return result;
}

static EnfResult visit_node(Walk *walk, Visit visit) {
    EnfImport *import = walk->import;
    const EnfGltf *gltf = &import->gltf;
    const EnfGltfNode *from = &gltf->nodes[visit.file_node];
    if (import->source_nodes[visit.file_node] != ENF_NONE) {
        return enf_error_set(import->error, ENF_ERROR_FORMAT, UINT64_MAX, "nodes[%u]: is its own ancestor, or has two parents",
                             visit.file_node);
    }
    uint32_t index = walk->count++;
    import->source_nodes[visit.file_node] = index;
    EnfResult result = fill_node(walk, &walk->nodes[index], visit);
    if (result != ENF_OK) {
        return result;
    }
    for (uint32_t i = from->child_count; i-- > 0;) {
        walk->stack[walk->depth++] = (Visit){gltf->links[from->child_first + i], index};
    }
    uint32_t copies = instance_count(gltf, from);
    if (from->mesh != ENF_NONE) {
        uint32_t *first = &import->mesh_nodes[from->mesh];
        *first = *first == ENF_NONE ? index : *first;
        if (copies != ENF_NONE) {
            result = add_instances(walk, index, copies);
        }
    }
    return result;
}

/* ---- preparation ------------------------------------------------------------------------------------------------ */

static EnfResult prepare(Walk *walk) {
    EnfImport *import = walk->import;
    const EnfGltf *gltf = &import->gltf;
    uint64_t capacity = gltf->node_count;
    for (uint32_t i = 0; i < gltf->node_count; i++) {
        uint32_t copies = gltf->nodes[i].mesh == ENF_NONE ? ENF_NONE : instance_count(gltf, &gltf->nodes[i]);
        capacity += copies == ENF_NONE ? 0 : copies;
    }
    if (capacity > ENF_IMPORT_MAX_NODES) {
        return enf_error_set(import->error, ENF_ERROR_SIZE, UINT64_MAX, "nodes: %llu with their instances; at most %u are read",
                             (unsigned long long)capacity, ENF_IMPORT_MAX_NODES);
    }
    walk->nodes = enf_import_keep(import, (size_t)capacity, sizeof *walk->nodes);
    walk->stack = enf_import_scratch(import, gltf->link_count + gltf->node_count, sizeof *walk->stack);
    walk->moved = enf_import_scratch(import, gltf->node_count, sizeof *walk->moved);
    import->source_nodes = enf_import_scratch(import, gltf->node_count, sizeof *import->source_nodes);
    if (!walk->nodes || !walk->stack || !walk->moved || !import->source_nodes) {
        return import->failure;
    }
    memset(import->source_nodes, 0xFF, gltf->node_count * sizeof *import->source_nodes);
    for (uint32_t i = 0; i < gltf->channel_count; i++) {
        walk->moved[gltf->channels[i].node] |= strcmp(gltf->channels[i].path, "weights") != 0;
    }
    return ENF_OK;
}

/* The roots, last first: of the scene, or all nodes without a parent where the file has no scene. */
static EnfResult push_roots(Walk *walk) {
    EnfImport *import = walk->import;
    const EnfGltf *gltf = &import->gltf;
    if (gltf->scene_count > 0) {
        for (uint32_t i = gltf->root_count; i-- > 0;) {
            walk->stack[walk->depth++] = (Visit){gltf->links[gltf->root_first + i], ENF_NONE};
        }
        return ENF_OK;
    }
    bool *child = enf_import_scratch(import, gltf->node_count, sizeof *child);
    if (!child) {
        return import->failure;
    }
    for (uint32_t i = 0; i < gltf->root_first; i++) {
        child[gltf->links[i]] = true;
    }
    for (uint32_t i = gltf->node_count; i-- > 0;) {
        if (!child[i]) {
            walk->stack[walk->depth++] = (Visit){i, ENF_NONE};
        }
    }
    return ENF_OK;
}

EnfResult enf_import_nodes(EnfImport *import) {
    Walk walk = {.import = import};
    EnfResult result = prepare(&walk);
    if (result == ENF_OK) {
        result = push_roots(&walk);
    }
    while (result == ENF_OK && walk.depth > 0) {
        result = visit_node(&walk, walk.stack[--walk.depth]);
    }
    import->source->nodes = walk.nodes;
    import->source->node_count = result == ENF_OK ? walk.count : 0;
    return result;
}
