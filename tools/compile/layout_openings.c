/* Openings. Input: portal nodes, and faces with a portal material; output: planar islands with what their names and extras ask for. */
#include "compile/layout_work.h"

typedef struct Corners {
    ENF_ARRAY(EnfGrid3) grid;
} Corners;

static bool add_primitive(Corners *corners, const EnfSourceNode *node, const EnfSourcePrimitive *primitive) {
    bool mirrored = enf_affine_det(&node->world) < 0.0;
    if (!ENF_ARRAY_ROOM(&corners->grid, primitive->index_count)) {
        return false;
    }
    for (uint32_t t = 0; t < primitive->index_count / 3; t++) {
        EnfVec3 p[3];
        enf_source_triangle(node, primitive, t, mirrored, p);
        for (int k = 0; k < 3; k++) {
            corners->grid.data[corners->grid.count++] = enf_grid_snap(p[k]);
        }
    }
    return true;
}

void enf_opening_show(EnfLayoutWork *work, const EnfOpening *opening) {
    EnfVec3 points[ENF_POLYGON_MAX];
    const EnfPiece *piece = &work->patches.pieces.data[opening->patch.piece_first];
    for (uint32_t i = 0; i < piece->point_count; i++) {
        points[i] = enf_grid_point(work->patches.points.data[piece->point_first + i]);
    }
    enf_diagnose_points(work->diagnosis, points, piece->point_count);
}

/* What is odd about the shape. */
static void judge(EnfLayoutWork *work, const EnfOpening *opening) {
    const char *name = enf_opening_name(work, opening);
    if (opening->patch.bent) {
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_OFF_PLANE, name,
                     "its points lie up to %.4f m off their common plane; it is used as %u flat pieces, seen from both sides",
                     opening->patch.off_plane, opening->patch.piece_count);
        enf_opening_show(work, opening);
    }
    if (opening->patch.concave) {
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_CONCAVE, name, "it is not convex and was split into %u pieces",
                     opening->patch.piece_count);
        enf_opening_show(work, opening);
    }
}

/* Makes openings of the corners gathered at a node. */
static bool add_openings(EnfLayoutWork *work, const Corners *corners, uint32_t node, uint32_t extras) {
    uint32_t first = work->patches.patches.count, degenerate = 0;
    if (!enf_patches_add(&work->patches, corners->grid.data, corners->grid.count / 3, &degenerate)) {
        return false;
    }
    if (degenerate > 0) {
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_DEGENERATE, work->source->nodes[node].name,
                     "%u of its polygons %s no area and %s left out", degenerate, degenerate == 1 ? "has" : "have",
                     degenerate == 1 ? "is" : "are");
    }
    uint32_t added = work->patches.patches.count - first;
    if (!ENF_ARRAY_ROOM(&work->openings, added)) {
        return false;
    }
    for (uint32_t i = 0; i < added; i++) {
        EnfOpening opening = {.node = node, .extras = extras, .patch = work->patches.patches.data[first + i]};
        opening.source = work->layout->node_cells[node];
        opening.target = opening.twin = opening.exit = ENF_NONE;
        if (extras != ENF_NONE) {
            const EnfExtras *asked = &work->extras.data[extras];
            opening.one_way = !asked->two_way;
            opening.closed = !asked->active;
            opening.mirror = asked->mirror;
        }
        work->openings.data[work->openings.count++] = opening;
        judge(work, &opening);
    }
    return true;
}

static bool add_portal_node(EnfLayoutWork *work, Corners *corners, uint32_t index) {
    const EnfSourceNode *node = &work->source->nodes[index];
    corners->grid.count = 0;
    if (node->mesh == ENF_NONE) {
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_DEGENERATE, node->name, "the portal has no mesh");
        return true;
    }
    const EnfSourceMesh *mesh = &work->source->meshes[node->mesh];
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        if (!add_primitive(corners, node, &work->source->primitives[mesh->primitive_first + i])) {
            return false;
        }
    }
    if (!ENF_ARRAY_ROOM(&work->extras, 1)) {
        return false;
    }
    work->extras.data[work->extras.count++] = enf_extras_read(node->extras);
    return add_openings(work, corners, index, work->extras.count - 1);
}

/* Faces of a drawn mesh that wear a portal material. */
static bool add_portal_faces(EnfLayoutWork *work, Corners *corners, uint32_t index) {
    const EnfSourceNode *node = &work->source->nodes[index];
    const EnfSourceMesh *mesh = &work->source->meshes[node->mesh];
    corners->grid.count = 0;
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const EnfSourcePrimitive *primitive = &work->source->primitives[mesh->primitive_first + i];
        if (enf_material_is_portal(work->source, primitive->material) && !add_primitive(corners, node, primitive)) {
            return false;
        }
    }
    return corners->grid.count == 0 || add_openings(work, corners, index, ENF_NONE);
}

bool enf_layout_openings(EnfLayoutWork *work) {
    Corners corners = {.grid = {0}};
    bool ok = true;
    for (uint32_t n = 0; ok && n < work->source->node_count; n++) {
        EnfRole role = work->layout->roles[n];
        if (role == ENF_ROLE_PORTAL) {
            ok = add_portal_node(work, &corners, n);
        } else if ((role == ENF_ROLE_GEOMETRY || role == ENF_ROLE_ROOM) && work->source->nodes[n].mesh != ENF_NONE) {
            ok = add_portal_faces(work, &corners, n);
        }
    }
    free(corners.grid.data);
    return ok;
}
