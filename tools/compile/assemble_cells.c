/* Cells, portals, transforms and bound planes of a map, from the layout. */
#include "compile/assemble.h"

#include "compile/exact.h"

#include <enfilade/tolerances.h>
#include <string.h>

/* A point of the world relative to an origin; exact within 4,096 m of it. */
static EnfVec3f local_point(EnfGrid3 p, EnfGrid3 origin) {
    EnfGrid3 d = enf_grid_sub(p, origin);
    return (EnfVec3f){(float)((double)d.x * ENF_GRID_STEP), (float)((double)d.y * ENF_GRID_STEP),
                      (float)((double)d.z * ENF_GRID_STEP)};
}

static void place_cell(EnfCell *cell, const EnfLayoutCell *from) {
    EnfVec3 origin = enf_grid_point(from->origin);
    cell->origin[0] = origin.x;
    cell->origin[1] = origin.y;
    cell->origin[2] = origin.z;
    /* A cell without shell is a point at its origin, until its contents are known. */
    bool empty = from->min.x > from->max.x || from->min.y > from->max.y || from->min.z > from->max.z;
    EnfBox3 box = {{0, 0, 0}, {0, 0, 0}};
    if (!empty) {
        box.min = enf_grid_point(enf_grid_sub(from->min, from->origin));
        box.max = enf_grid_point(enf_grid_sub(from->max, from->origin));
    }
    EnfBox3f bounds = enf_box3f_outward(box);
    memcpy(cell->min, &bounds.min, sizeof cell->min);
    memcpy(cell->max, &bounds.max, sizeof cell->max);
}

static bool add_bound_planes(EnfAssembly *assembly, const EnfLayout *layout, const EnfLayoutCell *from, EnfCell *cell) {
    cell->bound_first = assembly->bound_planes.count;
    cell->bound_count = from->bound_count;
    if (!ENF_ARRAY_ROOM(&assembly->bound_planes, from->bound_count)) {
        return false;
    }
    for (uint32_t i = 0; i < from->bound_count; i++) {
        EnfPlane plane = layout->bound_planes[from->bound_first + i];
        EnfVec3 origin = {cell->origin[0], cell->origin[1], cell->origin[2]};
        double d = enf_dot(plane.n, origin) + plane.d;
        assembly->bound_planes.data[assembly->bound_planes.count++] = (EnfPlane4f){
            {(float)plane.n.x, (float)plane.n.y, (float)plane.n.z}, (float)d};
    }
    return true;
}

static bool add_cell(EnfAssembly *assembly, const EnfLayout *layout, uint32_t index) {
    const EnfLayoutCell *from = &layout->cells[index];
    EnfCell cell;
    memset(&cell, 0, sizeof cell);
    place_cell(&cell, from);
    cell.name = enf_strings_add(&assembly->texts, from->name);
    cell.flags = from->flags;
    cell.priority = from->priority;
    if (!add_bound_planes(assembly, layout, from, &cell) || !ENF_ARRAY_ROOM(&assembly->cells, 1)) {
        return false;
    }
    assembly->cells.data[assembly->cells.count++] = cell;
    return true;
}

/* Number of the portal's transform; twins of a reflection, and equal ones, are not shared: they are few. */
static bool add_transform(EnfAssembly *assembly, const EnfLayoutPortal *from, uint32_t *number) {
    *number = ENF_NONE;
    if (!from->has_transform) {
        return true;
    }
    if (!ENF_ARRAY_ROOM(&assembly->transforms, 1)) {
        return false;
    }
    EnfTransform transform;
    memcpy(transform.m, from->transform.m, sizeof transform.m);
    memcpy(transform.t, &from->transform.t, sizeof transform.t);
    *number = assembly->transforms.count;
    assembly->transforms.data[assembly->transforms.count++] = transform;
    return true;
}

/* Portals of the layout are sorted by source: their numbers stay. */
static bool add_portal(EnfAssembly *assembly, const EnfLayout *layout, uint32_t index) {
    const EnfLayoutPortal *from = &layout->portals[index];
    EnfCell *source = &assembly->cells.data[from->source];
    EnfPortal portal = {.source = from->source,
                        .target = from->target,
                        .twin = from->twin,
                        .vertex_first = assembly->portal_vertices.count,
                        .vertex_count = from->point_count,
                        .flags = from->flags,
                        .name = enf_strings_add(&assembly->texts, from->name)};
    if (!add_transform(assembly, from, &portal.transform) || !ENF_ARRAY_ROOM(&assembly->portal_vertices, from->point_count) ||
        !ENF_ARRAY_ROOM(&assembly->portals, 1)) {
        return false;
    }
    for (uint32_t i = 0; i < from->point_count; i++) {
        EnfGrid3 p = layout->points[from->point_first + i];
        assembly->portal_vertices.data[assembly->portal_vertices.count++] = local_point(p, layout->cells[from->source].origin);
    }
    if (source->portal_count == 0) {
        source->portal_first = index;
    }
    source->portal_count++;
    assembly->portals.data[assembly->portals.count++] = portal;
    return true;
}

bool enf_assemble_cells(EnfAssembly *assembly, const EnfAssemblyParts *parts) {
    enf_strings_add(&assembly->texts, "");
    for (uint32_t i = 0; i < parts->layout->cell_count; i++) {
        if (!add_cell(assembly, parts->layout, i)) {
            return false;
        }
    }
    for (uint32_t i = 0; i < parts->layout->portal_count; i++) {
        if (!add_portal(assembly, parts->layout, i)) {
            return false;
        }
    }
    return true;
}
