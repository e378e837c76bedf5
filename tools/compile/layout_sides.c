/* Which cell lies on which side of an opening. Input: the drawn triangles of the cells; output: votes of rays. The opening itself is
 * a hole in them, so rays start in it and count only the half-space they are sent into. */
#include "compile/layout_work.h"

#include <float.h>

typedef struct SourceTriangles {
    ENF_ARRAY(EnfVec3) corners; /* three a triangle */
    ENF_ARRAY(uint32_t) cells;
} SourceTriangles;

static bool gather(SourceTriangles *out, const EnfSource *source, const EnfSourceNode *node, uint32_t cell) {
    const EnfSourceMesh *mesh = &source->meshes[node->mesh];
    bool mirrored = enf_affine_det(&node->world) < 0.0;
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const EnfSourcePrimitive *primitive = &source->primitives[mesh->primitive_first + i];
        if (!enf_material_seals(source, primitive->material)) {
            continue;
        }
        if (!ENF_ARRAY_ROOM(&out->corners, primitive->index_count) ||
            !ENF_ARRAY_ROOM(&out->cells, primitive->index_count / 3)) {
            return false;
        }
        for (uint32_t t = 0; t < primitive->index_count / 3; t++) {
            enf_source_triangle(node, primitive, t, mirrored, &out->corners.data[out->corners.count]);
            out->corners.count += 3;
            out->cells.data[out->cells.count++] = cell;
        }
    }
    return true;
}

static uint32_t shell_triangle(const void *user, uint32_t i, EnfVec3 corners[3]) {
    const SourceTriangles *triangles = user;
    memcpy(corners, &triangles->corners.data[3 * (size_t)i], 3 * sizeof *corners);
    return triangles->cells.data[i];
}

static bool make_cell_tree(EnfLayoutWork *work) {
    EnfBox3f *boxes = enf_alloc(NULL, work->cells.count, sizeof *boxes);
    if (boxes == NULL) {
        return work->cells.count == 0;
    }
    for (uint32_t c = 0; c < work->cells.count; c++) {
        EnfBox3 box = {enf_grid_point(work->cells.data[c].min), enf_grid_point(work->cells.data[c].max)};
        EnfVec3 margin = enf_v3(ENF_ROOM_REACH, ENF_ROOM_REACH, ENF_ROOM_REACH);
        box = (EnfBox3){enf_sub(box.min, margin), enf_add(box.max, margin)};
        boxes[c] = enf_box3f_outward(box);
    }
    bool ok = enf_kd_build(&work->cell_tree, boxes, NULL, work->cells.count, NULL, NULL) == ENF_OK;
    enf_free(NULL, boxes, work->cells.count, sizeof *boxes);
    return ok;
}

bool enf_layout_shells(EnfLayoutWork *work) {
    SourceTriangles triangles = {.cells = {0}};
    bool ok = true;
    for (uint32_t n = 0; ok && n < work->source->node_count; n++) {
        EnfRole role = work->layout->roles[n];
        uint32_t cell = work->layout->node_cells[n];
        bool drawn = role == ENF_ROLE_GEOMETRY || role == ENF_ROLE_ROOM;
        if (drawn && cell != ENF_NONE && work->source->nodes[n].mesh != ENF_NONE) {
            ok = gather(&triangles, work->source, &work->source->nodes[n], cell);
        }
    }
    ok = ok && enf_shells_create(&work->shells, work->cells.count, triangles.cells.count, shell_triangle, &triangles);
    free(triangles.corners.data);
    free(triangles.cells.data);
    for (uint32_t c = 0; ok && c < work->cells.count; c++) {
        const EnfLayoutCell *cell = &work->cells.data[c];
        EnfBox3 box = {enf_grid_point(cell->min), enf_grid_point(cell->max)};
        enf_shell_set_bound(&work->shells.cells[c], ENF_ARRAY_FROM(&work->planes, cell->bound_first), cell->bound_count, box);
    }
    return ok && make_cell_tree(work);
}

static bool bound_holds(const EnfShell *shell, EnfVec3 p) {
    for (uint32_t i = 0; i < shell->bound_count; i++) {
        if (enf_dot(shell->bound[i].n, p) + shell->bound[i].d > 0.0) {
            return false;
        }
    }
    return true;
}

/* Rays into the half-space of the normal: straight on, four at 50° around it, and four at 80°. The last meet the floor, walls and
 * ceiling right behind the opening, where a room that surrounds another has nothing: they count double. All are turned by an odd
 * angle, so that they run along no wall that is square to the opening. */
int enf_layout_side(EnfLayoutWork *work, uint32_t cell, EnfVec3 from, EnfVec3 normal) {
    enum { RINGS = 2, SPOKES = 4, ALL = 1 + SPOKES + 2 * SPOKES };
    static const double along[RINGS] = {0.64278760968654, 0.17364817766693},
                        across[RINGS] = {0.76604444311898, 0.98480775301221};
    const EnfShell *shell = &work->shells.cells[cell];
    if (shell->bound_count > 0) {
        return bound_holds(shell, enf_add(from, enf_scale(normal, 0.05))) ? ALL : -ALL;
    }
    EnfVec3 helper = normal.y < 0.9 && normal.y > -0.9 ? enf_v3(0.13, 0.98, 0.11) : enf_v3(0.98, 0.11, 0.13);
    EnfVec3 u = enf_normalize(enf_cross(helper, normal)), v = enf_cross(normal, u);
    EnfVec3 sides[SPOKES] = {u, v, enf_scale(u, -1.0), enf_scale(v, -1.0)};
    EnfShellHit hit;
    int score = enf_shell_ray(&work->shells, cell, (EnfShellRay){from, normal, 0.01, 1e9}, &hit) ? (hit.front ? 1 : -1) : 0;
    for (int ring = 0; ring < RINGS; ring++) {
        for (int i = 0; i < SPOKES; i++) {
            EnfVec3 direction = enf_add(enf_scale(normal, along[ring]), enf_scale(sides[i], across[ring]));
            if (enf_shell_ray(&work->shells, cell, (EnfShellRay){from, direction, 0.01, 1e9}, &hit)) {
                score += (hit.front ? 1 : -1) * (1 + ring);
            }
        }
    }
    return score;
}

bool enf_layout_looks_into(EnfLayoutWork *work, const EnfPatch *patch, uint32_t cell) {
    double seams = enf_layout_seams(work, cell, patch), clear = 0.125 * enf_length(enf_sub(patch->box.max, patch->box.min));
    if (seams > clear || seams < -clear) {
        return seams < 0.0;
    }
    return enf_layout_side(work, cell, patch->centre, patch->normal) >
           enf_layout_side(work, cell, patch->centre, enf_scale(patch->normal, -1.0));
}

static double volume(const EnfLayoutCell *cell) {
    EnfVec3 size = enf_sub(enf_grid_point(cell->max), enf_grid_point(cell->min));
    return size.x * size.y * size.z;
}

typedef struct Choice {
    uint32_t cell;
    bool sewn; /* its surfaces end at the opening, fronts that way round */
    int contrast;
} Choice;

/* A room whose surfaces end at the opening is the one. Otherwise: a room and one nested in it are both ahead; the nested one is not behind, and has the higher priority. */
static bool is_better(const EnfLayoutWork *work, Choice a, Choice b) {
    if (b.cell == ENF_NONE || a.sewn != b.sewn) {
        return b.cell == ENF_NONE || a.sewn;
    }
    if (a.contrast != b.contrast) {
        return a.contrast > b.contrast;
    }
    const EnfLayoutCell *ca = &work->cells.data[a.cell], *cb = &work->cells.data[b.cell];
    if (ca->priority != cb->priority) {
        return ca->priority > cb->priority;
    }
    double va = volume(ca), vb = volume(cb);
    return va < vb || (!(va > vb) && a.cell < b.cell);
}

static bool is_on_side(EnfLayoutWork *work, const EnfPatch *patch, EnfVec3 normal, double start, Choice *choice) {
    double seams = enf_layout_seams(work, choice->cell, patch);
    seams = enf_dot(normal, patch->normal) > 0.0 ? -seams : seams; /* positive: the cell lies on the side of `normal` */
    choice->sewn = seams > 0.25 * enf_length(enf_sub(patch->box.max, patch->box.min));
    int score = enf_layout_side(work, choice->cell, enf_add(patch->centre, enf_scale(normal, start)), normal);
    int behind = enf_layout_side(work, choice->cell, patch->centre, enf_scale(normal, -1.0));
    choice->contrast = score - (behind > 0 ? behind : 0);
    return choice->sewn || score > 1;
}

uint32_t enf_layout_cell_on_side(EnfLayoutWork *work, const EnfPatch *patch, EnfVec3 normal, uint32_t except) {
    enum { NEAR = 256 };
    static const double starts[] = {0.0, 0.1, 0.3, ENF_ROOM_REACH}; /* a wall may be thick: its other face has a hole as well */
    uint32_t near[NEAR];
    EnfKdTree tree = enf_kd_tree(&work->cell_tree);
    EnfBox3 box = {patch->centre, patch->centre};
    uint32_t count = enf_kd_overlap(&tree, enf_box3f_outward(box), near, NEAR);
    count = count < NEAR ? count : NEAR;
    for (size_t s = 0; s < sizeof starts / sizeof starts[0]; s++) {
        Choice best = {ENF_NONE, 0, 0};
        for (uint32_t i = 0; i < count; i++) {
            if (near[i] == except) {
                continue;
            }
            Choice choice = {near[i], false, 0};
            if (is_on_side(work, patch, normal, starts[s], &choice)) {
                best = is_better(work, choice, best) ? choice : best;
            }
        }
        if (best.cell != ENF_NONE) {
            return best.cell;
        }
    }
    return ENF_NONE;
}
