/* The mesh of a mover: the triangles of its root and of what hangs rigidly below it, in the space of its rest pose, a part a
 * material. A mesh that a single node brings as it is serves every mover that brings the same. */
#include "compile/movers.h"

#include <float.h>
#include <math.h>
#include <meshoptimizer.h>

/* Metres: two rigid placements that agree this well at 100 m from the origin place a mesh alike. */
#define SAME_PLACE 1e-4

/* A corner before corners are shared. */
typedef struct Corner {
    EnfVertex vertex;
    uint32_t material, order;
} Corner;

typedef struct Mesher {
    const EnfSource *source;
    uint32_t clip; /* all takes this material, and of drawn nodes only the faces that collide are taken; or ENF_NONE */
    bool drawn;
    ENF_ARRAY(Corner) corners; /* three a triangle */
} Mesher;

static uint32_t pack_normal(EnfVec3 n) {
    const double v[3] = {n.x, n.y, n.z};
    uint32_t packed = 0;
    for (int axis = 0; axis < 3; axis++) {
        double scaled = floor(v[axis] * 511.0 + 0.5);
        int32_t rounded = scaled > 511.0 ? 511 : scaled < -511.0 ? -511 : (int32_t)scaled;
        packed |= ((uint32_t)rounded & 0x3ffu) << (10 * axis);
    }
    return packed;
}

static uint32_t pack_color(const float *color) {
    uint32_t packed = 0;
    for (int channel = 0; channel < 4; channel++) {
        double c = color ? (double)color[channel] : 1.0;
        c = c > 0 ? (c < 1 ? c : 1) : 0;
        packed |= (uint32_t)(c * 255.0 + 0.5) << (8 * channel);
    }
    return packed;
}

/* The direction that stays normal to a surface moved by `a`: the cofactors' product, with the determinant's sign. */
static EnfVec3 turn_normal(const EnfAffine *a, EnfVec3 n) {
    EnfVec3 x = enf_v3(a->m[0], a->m[1], a->m[2]), y = enf_v3(a->m[3], a->m[4], a->m[5]), z = enf_v3(a->m[6], a->m[7], a->m[8]);
    EnfVec3 turned = enf_add(enf_add(enf_scale(enf_cross(y, z), n.x), enf_scale(enf_cross(z, x), n.y)),
                             enf_scale(enf_cross(x, y), n.z));
    return enf_normalize(enf_affine_det(a) < 0.0 ? enf_scale(turned, -1.0) : turned);
}

static EnfVertex make_vertex(const EnfSourcePrimitive *primitive, uint32_t index, const EnfAffine *to_mesh) {
    const float *p = primitive->positions + 3 * (size_t)index, *n = primitive->normals + 3 * (size_t)index;
    EnfVec3 at = enf_affine_point(to_mesh, enf_v3((double)p[0], (double)p[1], (double)p[2]));
    EnfVec3 normal = turn_normal(to_mesh, enf_v3((double)n[0], (double)n[1], (double)n[2]));
    EnfVertex vertex = {{enf_finite_float(at.x) + 0.0f, enf_finite_float(at.y) + 0.0f, enf_finite_float(at.z) + 0.0f},
                        pack_normal(normal),
                        {0.0f, 0.0f},
                        pack_color(primitive->colors ? primitive->colors + 4 * (size_t)index : NULL),
                        ENF_NONE};
    if (primitive->uvs) {
        vertex.uv[0] = primitive->uvs[2 * (size_t)index] + 0.0f;
        vertex.uv[1] = primitive->uvs[2 * (size_t)index + 1] + 0.0f;
    }
    return vertex;
}

static bool is_clip(const EnfSource *source, uint32_t material) {
    return enf_material_is_open(source, material) && !enf_material_is_portal(source, material);
}

/* Portals are no surfaces; what only collides is no part of what is drawn, nor the other way around. */
static bool is_left_out(const Mesher *mesher, uint32_t material) {
    if (mesher->clip == ENF_NONE) {
        return enf_material_is_open(mesher->source, material);
    }
    return enf_material_is_portal(mesher->source, material) || (mesher->drawn && !is_clip(mesher->source, material));
}

bool enf_mover_collides(const EnfSource *source, const EnfLayout *layout, uint32_t node) {
    const EnfSourceNode *n = &source->nodes[node];
    if (n->mesh == ENF_NONE) {
        return false;
    }
    if (layout->roles[node] == ENF_ROLE_COLLISION) {
        EnfSuffix suffix = enf_node_name(n->name).suffix;
        return suffix == ENF_SUFFIX_COLONLY || suffix == ENF_SUFFIX_CONVCOLONLY;
    }
    bool found = false;
    for (uint32_t i = 0; i < source->meshes[n->mesh].primitive_count; i++) {
        found = found || is_clip(source, source->primitives[source->meshes[n->mesh].primitive_first + i].material);
    }
    return found && (layout->roles[node] == ENF_ROLE_GEOMETRY || layout->roles[node] == ENF_ROLE_ROOM);
}

/* The triangles of a node. `to_mesh` leads from the node's mesh to the mover's; `flip`: the node turns its windings around. */
static bool add_node(Mesher *mesher, uint32_t node, const EnfAffine *to_mesh, bool flip) {
    const EnfSourceMesh *mesh = &mesher->source->meshes[mesher->source->nodes[node].mesh];
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const EnfSourcePrimitive *primitive = &mesher->source->primitives[mesh->primitive_first + i];
        if (is_left_out(mesher, primitive->material)) {
            continue;
        }
        uint32_t material = mesher->clip == ENF_NONE ? primitive->material : mesher->clip;
        if (!ENF_ARRAY_ROOM(&mesher->corners, primitive->index_count)) {
            return false;
        }
        for (uint32_t k = 0; k < primitive->index_count; k++) {
            uint32_t corner = flip && k % 3 ? k - k % 3 + 3 - k % 3 : k;
            uint32_t order = mesher->corners.count;
            mesher->corners.data[mesher->corners.count++] = (Corner){
                make_vertex(primitive, primitive->indices[corner], to_mesh), material, order};
        }
    }
    return true;
}

static int by_material(const void *a, const void *b) {
    const Corner *p = a, *q = b;
    if (p->material != q->material) {
        return p->material < q->material ? -1 : 1;
    }
    return p->order < q->order ? -1 : p->order > q->order;
}

/* Corners [first, end) of one material become a part: vertices shared, triangles in the order that suits a vertex cache. */
static bool add_part(EnfAssembly *assembly, const Corner *corners, uint32_t count, uint32_t mesh) {
    unsigned int *index = malloc(2 * (size_t)count * sizeof *index);
    EnfVertex *all = malloc(2 * (size_t)count * sizeof *all);
    bool ok = index && all && ENF_ARRAY_ROOM(&assembly->vertices, count) && ENF_ARRAY_ROOM(&assembly->indices, count) &&
              ENF_ARRAY_ROOM(&assembly->mesh_parts, 1);
    if (ok) {
        for (uint32_t i = 0; i < count; i++) {
            all[i] = corners[i].vertex;
        }
        unsigned int *ordered = index + count;
        EnfVertex *distinct = all + count;
        size_t distinct_count = meshopt_generateVertexRemap(ordered, NULL, count, all, count, sizeof *all);
        meshopt_remapVertexBuffer(distinct, all, count, sizeof *all, ordered);
        meshopt_remapIndexBuffer(index, NULL, count, ordered);
        meshopt_optimizeVertexCache(ordered, index, count, distinct_count);
        EnfMeshPart part = {mesh, corners[0].material, assembly->indices.count, count, assembly->vertices.count, 0};
        part.vertex_count = (uint32_t)meshopt_optimizeVertexFetch(assembly->vertices.data + part.vertex_first, ordered, count,
                                                                  distinct, distinct_count, sizeof *distinct);
        for (uint32_t i = 0; i < count; i++) {
            assembly->indices.data[part.index_first + i] = part.vertex_first + ordered[i];
        }
        assembly->vertices.count += part.vertex_count;
        assembly->indices.count += count;
        assembly->mesh_parts.data[assembly->mesh_parts.count++] = part;
    }
    free(index);
    free(all);
    return ok;
}

static void add_bounds(EnfMesh *mesh, const Corner *corners, uint32_t count) {
    for (int axis = 0; axis < 3; axis++) {
        mesh->min[axis] = FLT_MAX;
        mesh->max[axis] = -FLT_MAX;
        for (uint32_t i = 0; i < count; i++) {
            float p = corners[i].vertex.position[axis];
            mesh->min[axis] = p < mesh->min[axis] ? p : mesh->min[axis];
            mesh->max[axis] = p > mesh->max[axis] ? p : mesh->max[axis];
        }
    }
}

static bool add_mesh(EnfMoverWork *work, Mesher *mesher) {
    EnfAssembly *assembly = work->assembly;
    if (!ENF_ARRAY_ROOM(&assembly->meshes, 1)) {
        return false;
    }
    EnfMesh mesh = {.part_first = assembly->mesh_parts.count,
                    .name = enf_strings_add(&assembly->texts, mesher->source->nodes[work->node].name)};
    uint32_t number = assembly->meshes.count, count = mesher->corners.count;
    add_bounds(&mesh, mesher->corners.data, count);
    qsort(mesher->corners.data, count, sizeof *mesher->corners.data, by_material);
    for (uint32_t first = 0, end; first < count; first = end) {
        const Corner *corners = mesher->corners.data;
        for (end = first + 1; end < count && corners[end].material == corners[first].material; end++) {
        }
        if (!add_part(assembly, corners + first, end - first, number)) {
            return false;
        }
    }
    mesh.part_count = assembly->mesh_parts.count - mesh.part_first;
    assembly->meshes.data[assembly->meshes.count++] = mesh;
    work->mover.mesh = number;
    return true;
}

/* Do two placements put a mesh at the same place? */
static bool same_place(const EnfAffine *a, const EnfAffine *b) {
    double worst = enf_length(enf_sub(a->t, b->t));
    for (int i = 0; i < 9; i++) {
        double turned = fabs(a->m[i] - b->m[i]) * 100.0;
        worst = turned > worst ? turned : worst;
    }
    return worst <= SAME_PLACE;
}

/* Nodes stand in the order of a depth-first walk: those below `root` follow it, and their parents do not come before it. */
static bool is_below(const EnfSource *source, uint32_t node, uint32_t root) {
    return source->nodes[node].parent != ENF_NONE && source->nodes[node].parent >= root;
}

static bool add_nodes(EnfMoverWork *work, Mesher *mesher) {
    const EnfSource *source = work->parts->source;
    EnfAffine inverse;
    if (!enf_affine_inverse(&work->rest, &inverse)) {
        enf_diagnose(work->parts->diagnosis, ENF_DIAGNOSIS_MOVER_STATIC, source->nodes[work->node].name,
                     "it has no size: it is not drawn");
        return true;
    }
    for (uint32_t i = work->node; i < source->node_count && (i == work->node || is_below(source, i, work->node)); i++) {
        if (work->parts->layout->node_movers[i] != work->node || source->nodes[i].mesh == ENF_NONE ||
            work->parts->layout->roles[i] != ENF_ROLE_MOVER) {
            continue;
        }
        EnfAffine to_mesh = enf_affine_mul(inverse, source->nodes[i].world);
        if (!add_node(mesher, i, &to_mesh, enf_affine_det(&source->nodes[i].world) < 0.0)) {
            return false;
        }
    }
    return true;
}

/* The source mesh that is the whole mover, as it is; else ENF_NONE. */
static uint32_t sole_mesh(const EnfMoverWork *work) {
    const EnfSource *source = work->parts->source;
    const EnfSourceNode *root = &source->nodes[work->node];
    for (uint32_t i = work->node + 1; i < source->node_count && is_below(source, i, work->node); i++) {
        if (work->parts->layout->node_movers[i] == work->node && source->nodes[i].mesh != ENF_NONE) {
            return ENF_NONE;
        }
    }
    bool as_it_is = root->mesh != ENF_NONE && enf_affine_det(&work->rest) > 0.0 && same_place(&work->rest, &root->world);
    return as_it_is ? root->mesh : ENF_NONE;
}

/* A node that only collides brings its own mesh, whatever moves beside it. */
static bool add_clip(EnfMoverWork *work, Mesher *mesher) {
    const EnfSourceNode *node = &work->parts->source->nodes[work->node];
    EnfAffine inverse;
    if (!enf_affine_inverse(&work->rest, &inverse)) {
        return true;
    }
    EnfAffine to_mesh = enf_affine_mul(inverse, node->world);
    return add_node(mesher, work->node, &to_mesh, enf_affine_det(&node->world) < 0.0);
}

bool enf_mover_mesh(EnfMoverWork *work, uint32_t *shared) {
    bool clips = work->clip != ENF_NONE;
    uint32_t sole = clips ? ENF_NONE : sole_mesh(work);
    if (sole != ENF_NONE && shared[sole] != ENF_NONE) {
        work->mover.mesh = shared[sole];
        return true;
    }
    Mesher mesher = {
        work->parts->source, work->clip, work->parts->layout->roles[work->node] != ENF_ROLE_COLLISION, {NULL, 0, 0}};
    bool ok = clips              ? add_clip(work, &mesher)
              : sole != ENF_NONE ? add_node(&mesher, work->node, &(EnfAffine){{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}}, false)
                                 : add_nodes(work, &mesher);
    ok = ok && (mesher.corners.count == 0 || add_mesh(work, &mesher));
    if (ok && sole != ENF_NONE) {
        shared[sole] = work->mover.mesh;
    }
    free(mesher.corners.data);
    return ok;
}
