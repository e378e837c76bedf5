/* Cells as regions of space. Input: the layout and the soup; output: shells that rays can ask, portals included. */
#include "compile/layout_work.h"
#include "compile/regions.h"

#include <float.h>

static bool note_materials(EnfSpace *space) {
    const EnfSource *source = space->layout->source;
    space->material_count = source->material_count;
    space->faces = calloc((size_t)source->material_count + 1, sizeof *space->faces);
    for (uint32_t m = 0; space->faces != NULL && m < source->material_count; m++) {
        bool both = (source->materials[m].flags & ENF_MATERIAL_DOUBLE_SIDED) != 0;
        space->faces[m] = (uint8_t)((enf_material_seals(source, m) ? 0 : ENF_FACE_OPEN) | (both ? ENF_FACE_TWO_SIDED : 0));
    }
    return space->faces != NULL;
}

static bool number_portals(EnfSpace *space) {
    const EnfLayout *layout = space->layout;
    space->portal_first = calloc((size_t)layout->cell_count + 2, sizeof *space->portal_first);
    space->fan_first = calloc((size_t)layout->portal_count + 1, sizeof *space->fan_first);
    if (space->portal_first == NULL || space->fan_first == NULL) {
        return false;
    }
    for (uint32_t p = 0; p < layout->portal_count; p++) {
        uint32_t points = layout->portals[p].point_count;
        space->portal_first[layout->portals[p].source + 1]++;
        space->fan_first[p + 1] = space->fan_first[p] + (points > 2 ? points - 2 : 0);
    }
    for (uint32_t c = 0; c < layout->cell_count; c++) {
        space->portal_first[c + 1] += space->portal_first[c];
    }
    return true;
}

static uint32_t portal_of_fan(const EnfSpace *space, uint32_t triangle) {
    uint32_t low = 0, high = space->portal_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (space->fan_first[middle] <= triangle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

static bool is_sealing(const EnfSpace *space, const EnfSoupTriangle *triangle) {
    return triangle->cell < space->cell_count && !(space->faces[triangle->material] & ENF_FACE_OPEN);
}

static bool is_loose(const EnfSpace *space, const EnfSoupTriangle *triangle) {
    return space->layout->node_cells[triangle->node] == ENF_NONE;
}

static bool note_furnished(EnfSpace *space) {
    space->furnished = calloc((size_t)space->cell_count + 1, sizeof *space->furnished);
    for (uint32_t i = 0; space->furnished != NULL && i < space->soup->triangle_count; i++) {
        const EnfSoupTriangle *triangle = &space->soup->triangles[i];
        if (is_sealing(space, triangle) && !is_loose(space, triangle)) {
            space->furnished[triangle->cell] = true;
        }
    }
    return space->furnished != NULL;
}

/* Soup triangles first, then the portals as seen from inside. */
static uint32_t shell_triangle(const void *user, uint32_t i, EnfVec3 corners[3]) {
    const EnfSpace *space = user;
    if (i < space->soup->triangle_count) {
        const EnfSoupTriangle *triangle = &space->soup->triangles[i];
        if (!is_sealing(space, triangle) || (is_loose(space, triangle) && space->furnished[triangle->cell])) {
            return ENF_NONE;
        }
        enf_soup_corners(space->soup, i, corners);
        return triangle->cell;
    }
    uint32_t fan = i - space->soup->triangle_count, p = portal_of_fan(space, fan);
    const EnfLayoutPortal *portal = &space->layout->portals[p];
    const EnfGrid3 *points = &space->layout->points[portal->point_first];
    uint32_t k = fan - space->fan_first[p];
    corners[0] = enf_grid_point(points[0]);
    corners[1] = enf_grid_point(points[k + 2]);
    corners[2] = enf_grid_point(points[k + 1]);
    return portal->source;
}

static bool build_tree(EnfSpace *space) {
    EnfBox3f *boxes = calloc((size_t)space->cell_count + 1, sizeof *boxes);
    bool ok = boxes != NULL;
    for (uint32_t c = 0; ok && c < space->cell_count; c++) {
        EnfBox3 box = space->shells.cells[c].box;
        EnfVec3 at = enf_grid_point(space->layout->cells[c].origin);
        boxes[c] = enf_box3f_outward(enf_box3_is_empty(box) ? (EnfBox3){at, at} : box);
    }
    ok = ok && enf_kd_build(&space->tree, boxes, NULL, space->cell_count, NULL, NULL) == ENF_OK;
    free(boxes);
    return ok;
}

bool enf_space_create(EnfSpace *space, const EnfLayout *layout, const EnfSoup *soup) {
    *space = (EnfSpace){.layout = layout, .soup = soup, .cell_count = layout->cell_count, .portal_count = layout->portal_count};
    if (layout->cell_count > 0 && (layout->cells[layout->cell_count - 1].flags & ENF_CELL_OUTSIDE)) {
        space->cell_count--;
    }
    bool ok = note_materials(space) && number_portals(space) && note_furnished(space);
    uint32_t count = ok ? soup->triangle_count + space->fan_first[layout->portal_count] : 0;
    ok = ok && enf_shells_create(&space->shells, space->cell_count, count, shell_triangle, space);
    if (ok) {
        enf_shells_find_slabs(&space->shells);
    }
    for (uint32_t c = 0; ok && c < space->cell_count; c++) {
        const EnfLayoutCell *cell = &layout->cells[c];
        EnfBox3 box = {enf_grid_point(cell->min), enf_grid_point(cell->max)};
        if (cell->bound_count > 0) {
            enf_shell_set_bound(&space->shells.cells[c], &layout->bound_planes[cell->bound_first], cell->bound_count, box);
        }
    }
    ok = ok && build_tree(space);
    if (!ok) {
        enf_space_free(space);
    }
    return ok;
}

void enf_space_free(EnfSpace *space) {
    free(space->faces);
    free(space->portal_first);
    free(space->fan_first);
    free(space->furnished);
    enf_shells_free(&space->shells);
    enf_kd_built_free(&space->tree);
    memset(space, 0, sizeof *space);
}

static double volume(EnfBox3 box) {
    EnfVec3 size = enf_sub(box.max, box.min);
    return size.x * size.y * size.z;
}

uint32_t enf_space_locate(EnfSpace *space, EnfVec3 p) {
    enum { FOUND = 512 };
    uint32_t found[FOUND], best = ENF_NONE;
    EnfKdTree tree = enf_kd_tree(&space->tree);
    uint32_t count = enf_kd_overlap(&tree, enf_box3f_outward((EnfBox3){p, p}), found, FOUND);
    count = count < FOUND ? count : FOUND;
    for (uint32_t i = 0; i < count; i++) {
        if (!enf_shell_inside(&space->shells, found[i], p, 0.0, false)) {
            continue;
        }
        if (best != ENF_NONE) {
            int32_t ours = space->layout->cells[found[i]].priority, theirs = space->layout->cells[best].priority;
            double small = volume(space->shells.cells[found[i]].box), large = volume(space->shells.cells[best].box);
            bool wins = ours != theirs ? ours > theirs : small < large || (!(small > large) && found[i] < best);
            best = wins ? found[i] : best;
        } else {
            best = found[i];
        }
    }
    return best;
}
