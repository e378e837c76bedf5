/* What only collides and stands: `-colonly` nodes and faces of material `clip` become movers that stand still and are not drawn, so that
 * cells, portals and what is seen know nothing of them. A solid has at most ENF_SOLID_TRIANGLES_MAX triangles (beyond, it is its box,
 * collide.h): large meshes are halved, along the longest side of their middles' box, until the pieces are small. */
#include "compile/movers.h"

#include <enfilade/collide.h>

/* A triangle of an obstacle, by the middle of its corners. */
typedef struct Face {
    EnfMoverCorner corners[3];
    EnfVec3 middle;
    double key;
    uint32_t order;
} Face;

static int by_key(const void *a, const void *b) {
    const Face *p = a, *q = b;
    if (p->key < q->key || p->key > q->key) {
        return p->key < q->key ? -1 : 1;
    }
    return p->order < q->order ? -1 : p->order > q->order;
}

static EnfVec3 middle_of(const EnfMoverCorner *corners) {
    EnfVec3 sum = enf_v3(0.0, 0.0, 0.0);
    for (int k = 0; k < 3; k++) {
        const float *p = corners[k].vertex.position;
        sum = enf_add(sum, enf_v3((double)p[0] / 3.0, (double)p[1] / 3.0, (double)p[2] / 3.0));
    }
    return sum;
}

/* Sorts faces along the longest side of the box of their middles. */
static void sort_along(Face *faces, uint32_t count) {
    EnfBox3 box = enf_box3_empty();
    for (uint32_t i = 0; i < count; i++) {
        box = enf_box3_add(box, faces[i].middle);
    }
    EnfVec3 size = enf_sub(box.max, box.min);
    for (uint32_t i = 0; i < count; i++) {
        EnfVec3 m = faces[i].middle;
        faces[i].key = size.x >= size.y && size.x >= size.z ? m.x : size.y >= size.z ? m.y : m.z;
    }
    qsort(faces, count, sizeof *faces, by_key);
}

/* One mover of up to ENF_SOLID_TRIANGLES_MAX faces; `corners` is scratch for them. */
static bool add_solid(EnfMoverWork *work, const Face *faces, uint32_t count, EnfMoverCorner *corners) {
    for (uint32_t i = 0; i < count; i++) {
        memcpy(corners + 3 * (size_t)i, faces[i].corners, sizeof faces[i].corners);
    }
    work->mover.mesh = ENF_NONE;
    EnfAssembly *assembly = work->assembly;
    bool ok = enf_mesher_add_mesh(work, corners, 3 * count) && ENF_ARRAY_ROOM(&assembly->movers, 1) &&
              ENF_ARRAY_ROOM(&work->movers->nodes, 1);
    if (ok && work->mover.mesh != ENF_NONE) {
        assembly->movers.data[assembly->movers.count++] = work->mover;
        work->movers->nodes.data[work->movers->nodes.count++] = work->node;
    }
    return ok;
}

enum { HALVINGS_MAX = 64 };

/* Halves that still wait are on a stack; each is at most half of the one below it. */
static bool add_solids(EnfMoverWork *work, Face *faces, uint32_t count) {
    struct {
        uint32_t first, count;
    } stack[HALVINGS_MAX];
    uint32_t depth = 0;
    EnfMoverCorner *corners = malloc(3 * (size_t)ENF_SOLID_TRIANGLES_MAX * sizeof *corners);
    bool ok = corners != NULL;
    stack[depth].first = 0;
    stack[depth++].count = count;
    while (depth > 0 && ok) {
        uint32_t first = stack[--depth].first, here = stack[depth].count;
        if (here <= ENF_SOLID_TRIANGLES_MAX) {
            ok = add_solid(work, faces + first, here, corners);
            continue;
        }
        sort_along(faces + first, here);
        stack[depth].first = first + here / 2;
        stack[depth++].count = here - here / 2;
        stack[depth].first = first;
        stack[depth++].count = here / 2;
    }
    free(corners);
    return ok;
}

bool enf_mover_obstacle(EnfMoverWork *work) {
    const EnfSourceNode *node = &work->parts->source->nodes[work->node];
    EnfAffine inverse;
    if (!enf_affine_inverse(&work->rest, &inverse)) {
        return true;
    }
    EnfAffine to_mesh = enf_affine_mul(inverse, node->world);
    EnfMesher mesher = {work->movers, true, {NULL, 0, 0}};
    bool ok = enf_mesher_add_node(&mesher, work->node, &to_mesh, enf_affine_det(&node->world) < 0.0);
    uint32_t count = mesher.corners.count / 3;
    Face *faces = malloc(((size_t)count + 1) * sizeof *faces);
    ok = ok && faces;
    for (uint32_t i = 0; i < count && ok; i++) {
        memcpy(faces[i].corners, mesher.corners.data + 3 * (size_t)i, sizeof faces[i].corners);
        faces[i].middle = middle_of(faces[i].corners);
        faces[i].order = i;
    }
    ok = ok && (count == 0 || add_solids(work, faces, count));
    free(faces);
    free(mesher.corners.data);
    return ok;
}
