/* The mesh of a mover: the triangles of its root and of what hangs rigidly below it, in the space of its rest pose, a part a
 * material. A mesh that a single node brings as it is serves every mover that brings the same. */
#include "compile/movers.h"
#include "compile/pack.h"

#include <float.h>
#include <math.h>
#include <meshoptimizer.h>

/* Metres: two rigid placements that agree this well at 100 m from the origin place a mesh alike. */
#define SAME_PLACE 1e-4

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
    const float turned[3] = {(float)normal.x, (float)normal.y, (float)normal.z};
    static const float white[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    EnfVertex vertex = {{enf_finite_float(at.x) + 0.0f, enf_finite_float(at.y) + 0.0f, enf_finite_float(at.z) + 0.0f},
                        enf_pack_normal(turned),
                        {0.0f, 0.0f},
                        enf_pack_color(primitive->colors ? primitive->colors + 4 * (size_t)index : white),
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

static bool is_colonly(const EnfSourceNode *node) {
    EnfSuffix suffix = enf_node_name(node->name).suffix;
    return suffix == ENF_SUFFIX_COLONLY || suffix == ENF_SUFFIX_CONVCOLONLY;
}

bool enf_mover_collides(const EnfSource *source, const EnfLayout *layout, uint32_t node) {
    const EnfSourceNode *n = &source->nodes[node];
    if (n->mesh == ENF_NONE) {
        return false;
    }
    if (layout->roles[node] == ENF_ROLE_COLLISION) {
        return is_colonly(n);
    }
    bool found = false;
    for (uint32_t i = 0; i < source->meshes[n->mesh].primitive_count; i++) {
        found = found || is_clip(source, source->primitives[source->meshes[n->mesh].primitive_first + i].material);
    }
    return found && (layout->roles[node] == ENF_ROLE_GEOMETRY || layout->roles[node] == ENF_ROLE_ROOM);
}

/* The material of what collides and is not drawn, made when it is first asked for; ENF_NONE if memory is out. */
static uint32_t clip_material(EnfMovers *movers) {
    EnfAssembly *assembly = movers->assembly;
    if (movers->clip == ENF_NONE && ENF_ARRAY_ROOM(&assembly->materials, 1)) {
        EnfMaterial material = {.name = enf_strings_add(&assembly->texts, "clip"),
                                .texture = ENF_NONE,
                                .emissive_texture = ENF_NONE,
                                .flags = ENF_MATERIAL_NODRAW | ENF_MATERIAL_CLIP,
                                .base_color = {1.0f, 1.0f, 1.0f, 1.0f},
                                .uv_transform = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}};
        movers->clip = assembly->materials.count;
        assembly->materials.data[assembly->materials.count++] = material;
    }
    return movers->clip;
}

static bool add_primitive(EnfMesher *mesher, const EnfSourcePrimitive *primitive, uint32_t material, const EnfAffine *to_mesh,
                          bool flip) {
    if (!ENF_ARRAY_ROOM(&mesher->corners, primitive->index_count)) {
        return false;
    }
    for (uint32_t k = 0; k < primitive->index_count; k++) {
        uint32_t corner = flip && k % 3 ? k - k % 3 + 3 - k % 3 : k;
        uint32_t order = mesher->corners.count;
        mesher->corners.data[mesher->corners.count++] = (EnfMoverCorner){
            make_vertex(primitive, primitive->indices[corner], to_mesh), material, order};
    }
    return true;
}

bool enf_mesher_add_node(EnfMesher *mesher, uint32_t node, const EnfAffine *to_mesh, bool flip) {
    const EnfSource *source = mesher->movers->parts->source;
    const EnfSourceMesh *mesh = &source->meshes[source->nodes[node].mesh];
    bool only = mesher->movers->parts->layout->roles[node] == ENF_ROLE_COLLISION;
    bool ok = true;
    for (uint32_t i = 0; i < mesh->primitive_count && ok; i++) {
        const EnfSourcePrimitive *primitive = &source->primitives[mesh->primitive_first + i];
        bool clips = only || is_clip(source, primitive->material);
        if (enf_material_is_portal(source, primitive->material) || (only && !is_colonly(&source->nodes[node])) ||
            (mesher->obstacle && !clips)) {
            continue; /* portals are no surfaces, navigation meshes no obstacles; what is drawn stands elsewhere */
        }
        uint32_t material = clips ? clip_material(mesher->movers) : primitive->material;
        ok = material != ENF_NONE && add_primitive(mesher, primitive, material, to_mesh, flip);
    }
    return ok;
}

static int by_material(const void *a, const void *b) {
    const EnfMoverCorner *p = a, *q = b;
    if (p->material != q->material) {
        return p->material < q->material ? -1 : 1;
    }
    return p->order < q->order ? -1 : p->order > q->order;
}

/* Corners [first, end) of one material become a part: vertices shared, triangles in the order that suits a vertex cache. */
static bool add_part(EnfAssembly *assembly, const EnfMoverCorner *corners, uint32_t count, uint32_t mesh) {
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

static void add_bounds(EnfMesh *mesh, const EnfMoverCorner *corners, uint32_t count) {
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

/* Are mesh and place of a size that anything could be made of? Else it is told. */
static bool is_near(const EnfMoverWork *work, const EnfMesh *mesh) {
    bool near = true;
    for (int i = 0; i < 8; i++) {
        EnfVec3 corner = enf_v3((double)(i & 1 ? mesh->max[0] : mesh->min[0]), (double)(i & 2 ? mesh->max[1] : mesh->min[1]),
                                (double)(i & 4 ? mesh->max[2] : mesh->min[2]));
        EnfVec3 at = enf_affine_point(&work->rest, corner);
        near = near && enf_length(corner) <= ENF_MOVER_FAR && enf_length(at) <= ENF_MOVER_FAR;
    }
    if (!near) {
        enf_diagnose(work->parts->diagnosis, ENF_DIAGNOSIS_MOVER_STATIC, work->parts->source->nodes[work->node].name,
                     "it reaches farther than %g m: it is not drawn", ENF_MOVER_FAR);
    }
    return near;
}

bool enf_mesher_add_mesh(EnfMoverWork *work, EnfMoverCorner *corners, uint32_t count) {
    EnfAssembly *assembly = work->assembly;
    if (count == 0 || !ENF_ARRAY_ROOM(&assembly->meshes, 1)) {
        return count == 0;
    }
    EnfMesh mesh = {.part_first = assembly->mesh_parts.count};
    uint32_t number = assembly->meshes.count;
    add_bounds(&mesh, corners, count);
    if (!is_near(work, &mesh)) {
        return true;
    }
    mesh.name = enf_strings_add(&assembly->texts, work->parts->source->nodes[work->node].name);
    qsort(corners, count, sizeof *corners, by_material);
    for (uint32_t first = 0, end; first < count; first = end) {
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

static bool add_pieces(EnfMoverWork *work, EnfMesher *mesher) {
    const EnfSource *source = work->parts->source;
    EnfAffine inverse;
    if (!enf_affine_inverse(&work->rest, &inverse)) {
        enf_diagnose(work->parts->diagnosis, ENF_DIAGNOSIS_MOVER_STATIC, source->nodes[work->node].name,
                     "it has no size: it is not drawn");
        return true;
    }
    bool ok = true;
    for (uint32_t i = work->movers->first_piece[work->node]; i != ENF_NONE && ok; i = work->movers->next_piece[i]) {
        if (source->nodes[i].mesh != ENF_NONE) {
            EnfAffine to_mesh = enf_affine_mul(inverse, source->nodes[i].world);
            ok = enf_mesher_add_node(mesher, i, &to_mesh, enf_affine_det(&source->nodes[i].world) < 0.0);
        }
    }
    return ok;
}

/* The source mesh that is the whole mover, as it is; else ENF_NONE. */
static uint32_t sole_mesh(const EnfMoverWork *work) {
    const EnfSource *source = work->parts->source;
    const EnfSourceNode *root = &source->nodes[work->node];
    uint32_t first = work->movers->first_piece[work->node];
    for (uint32_t i = work->movers->next_piece[first]; i != ENF_NONE; i = work->movers->next_piece[i]) {
        if (source->nodes[i].mesh != ENF_NONE) {
            return ENF_NONE;
        }
    }
    bool as_it_is = work->parts->layout->roles[work->node] == ENF_ROLE_MOVER && enf_affine_det(&work->rest) > 0.0 &&
                    same_place(&work->rest, &root->world);
    return as_it_is ? root->mesh : ENF_NONE;
}

bool enf_mover_mesh(EnfMoverWork *work) {
    static const EnfAffine as_it_is = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
    uint32_t sole = sole_mesh(work), *shared = sole == ENF_NONE ? NULL : &work->movers->meshes[sole];
    if (shared && *shared != ENF_NONE) {
        work->mover.mesh = is_near(work, &work->assembly->meshes.data[*shared]) ? *shared : ENF_NONE;
        return true;
    }
    EnfMesher mesher = {work->movers, false, {NULL, 0, 0}};
    bool ok = shared ? enf_mesher_add_node(&mesher, work->node, &as_it_is, false) : add_pieces(work, &mesher);
    ok = ok && enf_mesher_add_mesh(work, mesher.corners.data, mesher.corners.count);
    if (ok && shared) {
        *shared = work->mover.mesh;
    }
    free(mesher.corners.data);
    return ok;
}
