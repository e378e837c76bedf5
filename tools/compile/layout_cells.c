/* Roles and cells. Input: nodes with their names and extras; output: what each node is, the cells, and which cell each node belongs
 * to. Source: DESIGN §6. */
#include "compile/layout_work.h"

#include <float.h>

/* Suffix and the extras that outrank it. */
static EnfRole role_of(const EnfSourceNode *node, const EnfNodeName *name, const EnfExtras *extras) {
    bool has_mesh = node->mesh != ENF_NONE;
    switch (name->suffix) {
    case ENF_SUFFIX_NOIMP:
        return ENF_ROLE_IGNORED;
    case ENF_SUFFIX_ROOM:
        return ENF_ROLE_ROOM;
    case ENF_SUFFIX_PORTAL:
        return ENF_ROLE_PORTAL;
    case ENF_SUFFIX_BOUND:
        return ENF_ROLE_BOUND;
    case ENF_SUFFIX_COLONLY:
    case ENF_SUFFIX_CONVCOLONLY:
    case ENF_SUFFIX_NAVMESH:
    case ENF_SUFFIX_OCCONLY:
        return ENF_ROLE_COLLISION;
    default:
        break;
    }
    if (has_mesh && extras->makes_portal) {
        return ENF_ROLE_PORTAL;
    }
    return has_mesh ? ENF_ROLE_GEOMETRY : ENF_ROLE_MARKER;
}

static bool add_cell(EnfLayoutWork *work, uint32_t node, uint32_t parent, const EnfExtras *extras) {
    if (!ENF_ARRAY_ROOM(&work->cells, 1)) {
        return false;
    }
    EnfLayoutCell cell = {.name = work->source->nodes[node].name, .node = node, .parent = parent};
    cell.priority = parent == ENF_NONE ? 0 : work->cells.data[parent].priority + 1;
    if (extras->has_priority) {
        cell.priority = extras->priority;
    }
    work->cells.data[work->cells.count++] = cell;
    return true;
}

static void warn_of_suspect(EnfLayoutWork *work, const EnfNodeName *name) {
    if (name->suspect != ENF_SUFFIX_NONE) {
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_SUFFIX_NEAR_MISS, name->text,
                     "the name ends almost like '-%s'; it is taken as an ordinary node", enf_suffix_text(name->suspect));
    }
}

bool enf_layout_roles(EnfLayoutWork *work) {
    const EnfSource *source = work->source;
    EnfLayout *layout = work->layout;
    for (uint32_t i = 0; i < source->node_count; i++) {
        const EnfSourceNode *node = &source->nodes[i];
        EnfNodeName name = enf_node_name(node->name);
        EnfExtras extras = enf_extras_read(node->extras);
        bool ignored = node->parent != ENF_NONE && layout->roles[node->parent] == ENF_ROLE_IGNORED;
        layout->roles[i] = ignored ? ENF_ROLE_IGNORED : role_of(node, &name, &extras);
        layout->node_cells[i] = node->parent != ENF_NONE ? layout->node_cells[node->parent] : ENF_NONE;
        if (layout->roles[i] == ENF_ROLE_ROOM) {
            if (!add_cell(work, i, layout->node_cells[i], &extras)) {
                return false;
            }
            layout->node_cells[i] = work->cells.count - 1;
        }
        if (!ignored) {
            warn_of_suspect(work, &name);
        }
    }
    return true;
}

/* ---- triangles ------------------------------------------------------------------------------------------------------------- */

/* Is the material's name `word`, perhaps with an ending after '.' or '_'? */
static bool is_named(const EnfSource *source, uint32_t material, const char *word) {
    const char *name = source->material_names != NULL ? source->material_names[material] : NULL;
    size_t length = strlen(word);
    if (name == NULL || strlen(name) < length || enf_name_compare(name, length, word, length, true) != 0) {
        return false;
    }
    return name[length] == '\0' || name[length] == '.' || name[length] == '_';
}

bool enf_material_is_portal(const EnfSource *source, uint32_t material) {
    return is_named(source, material, "visportal") || is_named(source, material, "areaportal");
}

bool enf_material_is_open(const EnfSource *source, uint32_t material) {
    return enf_material_is_portal(source, material) || is_named(source, material, "clip");
}

bool enf_material_seals(const EnfSource *source, uint32_t material) {
    return source->materials[material].alpha_mode == ENF_ALPHA_OPAQUE && !enf_material_is_open(source, material);
}

void enf_source_triangle(const EnfSourceNode *node, const EnfSourcePrimitive *primitive, uint32_t triangle, bool mirrored,
                         EnfVec3 corners[3]) {
    for (uint32_t k = 0; k < 3; k++) {
        const float *p = &primitive->positions[3 * (size_t)primitive->indices[3 * (size_t)triangle + k]];
        uint32_t at = mirrored && k > 0 ? 3 - k : k;
        corners[at] = enf_affine_point(&node->world, enf_v3((double)p[0], (double)p[1], (double)p[2]));
    }
}

static EnfBox3 node_box(const EnfSource *source, const EnfSourceNode *node) {
    EnfBox3 box = enf_box3_empty();
    const EnfSourceMesh *mesh = &source->meshes[node->mesh];
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const EnfSourcePrimitive *primitive = &source->primitives[mesh->primitive_first + i];
        for (uint32_t t = 0; t < primitive->index_count / 3; t++) {
            EnfVec3 p[3];
            enf_source_triangle(node, primitive, t, false, p);
            box = enf_box3_add(enf_box3_add(enf_box3_add(box, p[0]), p[1]), p[2]);
        }
    }
    return box;
}

/* ---- bounds ---------------------------------------------------------------------------------------------------------------- */

typedef struct Bound {
    ENF_ARRAY(EnfVec3) corners; /* three a triangle */
    EnfVec3 centre;
    uint32_t cell, node;
} Bound;

/* How far the corners reach beyond the plane (metres); 0 for a plane of their convex hull. */
static double beyond(const Bound *bound, EnfPlane plane) {
    double most = -DBL_MAX;
    for (uint32_t i = 0; i < bound->corners.count; i++) {
        double d = enf_dot(plane.n, bound->corners.data[i]) + plane.d;
        most = d > most ? d : most;
    }
    return most;
}

static bool push_plane(EnfLayoutWork *work, uint32_t first, EnfPlane plane) {
    for (uint32_t i = first; i < work->planes.count; i++) {
        EnfPlane other = work->planes.data[i];
        if (enf_dot(other.n, plane.n) > 1.0 - 1e-9 && other.d - plane.d < 1e-3 && plane.d - other.d < 1e-3) {
            return true;
        }
    }
    if (!ENF_ARRAY_ROOM(&work->planes, 1)) {
        return false;
    }
    work->planes.data[work->planes.count++] = plane;
    return true;
}

/* The planes of the bound's faces that have everything behind them, and its box. A convex mesh is described by its faces alone; one
 * that is not gets the warning and the box. */
static bool make_bound(EnfLayoutWork *work, Bound *bound, EnfBox3 box) {
    uint32_t first = work->planes.count;
    double worst = 0.0;
    for (uint32_t t = 0; t + 2 < bound->corners.count; t += 3) {
        const EnfVec3 *p = &bound->corners.data[t];
        EnfPlane plane = enf_plane_from_polygon(p, 3);
        if (enf_dot(plane.n, plane.n) < 0.5) {
            continue;
        }
        if (enf_dot(plane.n, bound->centre) + plane.d >
            0.0) { /* whichever way the face is wound, outward is away from the middle */
            plane = (EnfPlane){enf_scale(plane.n, -1.0), -plane.d};
        }
        double over = beyond(bound, plane);
        worst = over > worst ? over : worst;
        if (over <= 1e-3 && !push_plane(work, first, plane)) {
            return false;
        }
    }
    if (worst > 1e-2) {
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_UNSUPPORTED, work->source->nodes[bound->node].name,
                     "the bound is not convex (by %.2f m): its hull is used", worst);
    }
    const EnfVec3 normals[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int axis = 0; axis < 3; axis++) {
        EnfPlane low = {enf_scale(normals[axis], -1.0), enf_dot(normals[axis], box.min)};
        EnfPlane high = {normals[axis], -enf_dot(normals[axis], box.max)};
        if (!push_plane(work, first, low) || !push_plane(work, first, high)) {
            return false;
        }
    }
    EnfLayoutCell *cell = &work->cells.data[bound->cell];
    cell->bound_first = first;
    cell->bound_count = work->planes.count - first;
    return true;
}

static bool gather_bound(EnfLayoutWork *work, Bound *bound, const EnfSourceNode *node) {
    const EnfSourceMesh *mesh = &work->source->meshes[node->mesh];
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const EnfSourcePrimitive *primitive = &work->source->primitives[mesh->primitive_first + i];
        if (!ENF_ARRAY_ROOM(&bound->corners, primitive->index_count)) {
            return false;
        }
        for (uint32_t t = 0; t < primitive->index_count / 3; t++) {
            enf_source_triangle(node, primitive, t, false, &bound->corners.data[bound->corners.count]);
            bound->corners.count += 3;
        }
    }
    return true;
}

typedef struct BoundNode {
    uint32_t cell, node;
} BoundNode;

static int compare_bound_nodes(const void *pa, const void *pb) {
    const BoundNode *a = pa, *b = pb;
    if (a->cell != b->cell) {
        return a->cell < b->cell ? -1 : 1;
    }
    return (a->node > b->node) - (a->node < b->node);
}

/* The bound of one cell from all its `-bound` meshes. */
static bool bound_cell(EnfLayoutWork *work, const BoundNode *nodes, uint32_t node_count) {
    Bound bound = {.cell = nodes[0].cell, .node = nodes[0].node};
    EnfBox3 box = enf_box3_empty();
    bool ok = true;
    for (uint32_t i = 0; ok && i < node_count; i++) {
        ok = gather_bound(work, &bound, &work->source->nodes[nodes[i].node]);
    }
    for (uint32_t i = 0; i < bound.corners.count; i++) {
        box = enf_box3_add(box, bound.corners.data[i]);
        bound.centre = enf_add(bound.centre, enf_scale(bound.corners.data[i], 1.0 / bound.corners.count));
    }
    ok = ok && (bound.corners.count == 0 || make_bound(work, &bound, box));
    free(bound.corners.data);
    return ok;
}

static bool make_bounds(EnfLayoutWork *work) {
    ENF_ARRAY(BoundNode) nodes = {0};
    bool ok = true;
    for (uint32_t n = 0; ok && n < work->source->node_count; n++) {
        uint32_t cell = work->layout->node_cells[n];
        bool bound = work->layout->roles[n] == ENF_ROLE_BOUND && work->source->nodes[n].mesh != ENF_NONE;
        if (bound && cell != ENF_NONE) {
            ok = ENF_ARRAY_ROOM(&nodes, 1);
            if (ok) {
                nodes.data[nodes.count++] = (BoundNode){cell, n};
            }
        }
    }
    if (nodes.count > 0) {
        qsort(nodes.data, nodes.count, sizeof *nodes.data, compare_bound_nodes);
    }
    for (uint32_t i = 0, end; ok && i < nodes.count; i = end) {
        end = i + 1;
        while (end < nodes.count && nodes.data[end].cell == nodes.data[i].cell) {
            end++;
        }
        ok = bound_cell(work, &nodes.data[i], end - i);
    }
    free(nodes.data);
    return ok;
}

bool enf_layout_bounds(EnfLayoutWork *work) {
    uint32_t count = work->cells.count;
    EnfBox3 *boxes = enf_alloc(NULL, count, sizeof *boxes);
    if (boxes == NULL && count > 0) {
        return false;
    }
    for (uint32_t c = 0; c < count; c++) {
        boxes[c] = enf_box3_empty();
    }
    for (uint32_t n = 0; n < work->source->node_count; n++) {
        const EnfSourceNode *node = &work->source->nodes[n];
        uint32_t cell = work->layout->node_cells[n];
        EnfRole role = work->layout->roles[n];
        bool counts = role == ENF_ROLE_GEOMETRY || role == ENF_ROLE_ROOM || role == ENF_ROLE_BOUND;
        if (counts && node->mesh != ENF_NONE && cell != ENF_NONE) {
            boxes[cell] = enf_box3_union(boxes[cell], node_box(work->source, node));
        }
    }
    for (uint32_t c = 0; c < count; c++) {
        EnfLayoutCell *cell = &work->cells.data[c];
        if (enf_box3_is_empty(boxes[c])) {
            EnfVec3 at = cell->node != ENF_NONE ? work->source->nodes[cell->node].world.t : enf_v3(0, 0, 0);
            boxes[c] = (EnfBox3){at, at};
            enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_ROOM_EMPTY, cell->name, "the room has no geometry");
        }
        cell->min = enf_grid_snap(boxes[c].min);
        cell->max = enf_grid_snap(boxes[c].max);
    }
    enf_free(NULL, boxes, count, sizeof *boxes);
    return make_bounds(work);
}
