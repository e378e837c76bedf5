/* Cells that share space (PITFALLS 11). Input: shells; output: a warning with the measured volume, and links that pass the whole window,
 * so that nothing is lost. Sampled: points of a lattice in the common box, and points before the surfaces that reach into it. */
#include "compile/layout_work.h"
#include "compile/regions.h"

enum { LATTICE = 6, SURFACE_SAMPLES = 48, FINE_LATTICE = 16 };

/* A point must be this deep (metres) inside both cells: rooms modelled to the centimetre do not overlap. */
static const double DEPTH = 0.03;

typedef struct Overlap {
    EnfRegions *regions;
    EnfSpace *space;
    uint32_t a, b;
    EnfBox3 box; /* common */
} Overlap;

static bool is_ancestor(const EnfLayout *layout, uint32_t above, uint32_t below) {
    for (uint32_t c = below; c != ENF_NONE; c = layout->cells[c].parent) {
        if (c == above) {
            return true;
        }
    }
    return false;
}

static bool in_both(const Overlap *overlap, EnfVec3 p) {
    EnfShells *shells = &overlap->space->shells;
    return enf_shell_near(&shells->cells[overlap->a], &p, 1, DEPTH) &&
           enf_shell_near(&shells->cells[overlap->b], &p, 1, DEPTH) && enf_shell_inside(shells, overlap->a, p, DEPTH, true) &&
           enf_shell_inside(shells, overlap->b, p, DEPTH, true);
}

static uint32_t count_lattice(const Overlap *overlap, int n) {
    EnfVec3 size = enf_sub(overlap->box.max, overlap->box.min);
    uint32_t inside = 0;
    for (int i = 0; i < n * n * n; i++) {
        int x = i % n, y = i / n % n, z = i / n / n;
        EnfVec3 step = enf_v3((x + 0.5) / n, (y + 0.5) / n, (z + 0.5) / n);
        inside += in_both(overlap, enf_add(overlap->box.min, enf_v3(step.x * size.x, step.y * size.y, step.z * size.z)));
    }
    return inside;
}

/* Points just before the surfaces of a cell: where a corner of it pokes into the other. */
static bool surface_pokes(const Overlap *overlap, uint32_t cell) {
    const EnfShells *shells = &overlap->space->shells;
    const EnfShell *shell = &shells->cells[cell];
    uint32_t step = shell->count / SURFACE_SAMPLES + 1;
    for (uint32_t i = 0; i < shell->count; i += step) {
        EnfVec3 p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = enf_add(shell->origin, enf_v3_from_f(shells->triangles[shell->first + i][k]));
        }
        EnfVec3 n = enf_normalize(enf_cross(enf_sub(p[1], p[0]), enf_sub(p[2], p[0])));
        EnfVec3 centre = enf_scale(enf_add(p[0], enf_add(p[1], p[2])), 1.0 / 3.0);
        EnfVec3 before = enf_add(centre, enf_scale(n, shell->inverted ? -3.0 * DEPTH : 3.0 * DEPTH));
        if (enf_box3_contains(overlap->box, before) && in_both(overlap, before)) {
            return true;
        }
    }
    return false;
}

static bool push_links(EnfLayout *layout, uint32_t a, uint32_t b) {
    EnfLayoutPortal *grown = realloc(layout->portals, ((size_t)layout->portal_count + 2) * sizeof *grown);
    if (grown == NULL) {
        return false;
    }
    layout->portals = grown;
    uint32_t first = layout->portal_count;
    EnfLayoutPortal link = {
        .name = "", .node = ENF_NONE, .source = a, .target = b, .twin = first + 1, .flags = ENF_PORTAL_OVERLAP};
    grown[layout->portal_count++] = link;
    link.source = b, link.target = a, link.twin = first;
    grown[layout->portal_count++] = link;
    return true;
}

static bool test_pair(Overlap *overlap) {
    EnfLayout *layout = overlap->regions->layout;
    const EnfShell *a = &overlap->space->shells.cells[overlap->a], *b = &overlap->space->shells.cells[overlap->b];
    EnfVec3 low = enf_v3(a->box.min.x > b->box.min.x ? a->box.min.x : b->box.min.x,
                         a->box.min.y > b->box.min.y ? a->box.min.y : b->box.min.y,
                         a->box.min.z > b->box.min.z ? a->box.min.z : b->box.min.z);
    EnfVec3 high = enf_v3(a->box.max.x < b->box.max.x ? a->box.max.x : b->box.max.x,
                          a->box.max.y < b->box.max.y ? a->box.max.y : b->box.max.y,
                          a->box.max.z < b->box.max.z ? a->box.max.z : b->box.max.z);
    overlap->box = (EnfBox3){enf_add(low, enf_v3(DEPTH, DEPTH, DEPTH)), enf_sub(high, enf_v3(DEPTH, DEPTH, DEPTH))};
    if (enf_box3_is_empty(overlap->box)) {
        return true;
    }
    bool found = count_lattice(overlap, LATTICE) > 0 || surface_pokes(overlap, overlap->a) ||
                 surface_pokes(overlap, overlap->b);
    if (!found) {
        return true;
    }
    EnfVec3 size = enf_sub(high, low);
    double share = count_lattice(overlap, FINE_LATTICE) / (double)(FINE_LATTICE * FINE_LATTICE * FINE_LATTICE);
    enf_diagnose(overlap->regions->diagnosis, ENF_DIAGNOSIS_ROOM_OVERLAP, layout->cells[overlap->a].name,
                 "it shares about %.2f m³ with '%s'; each is shown wherever the other is", share * size.x * size.y * size.z,
                 layout->cells[overlap->b].name);
    const EnfVec3 corners[2] = {low, high};
    enf_diagnose_points(overlap->regions->diagnosis, corners, 2);
    return push_links(layout, overlap->a, overlap->b);
}

bool enf_regions_overlaps(EnfRegions *regions, EnfSpace *space) {
    EnfLayout *layout = regions->layout;
    uint32_t *near = malloc(((size_t)space->cell_count + 1) * sizeof *near);
    EnfKdTree tree = enf_kd_tree(&space->tree);
    bool ok = near != NULL;
    for (uint32_t a = 0; ok && a < space->cell_count; a++) {
        EnfBox3 box = space->shells.cells[a].box;
        if (enf_box3_is_empty(box)) {
            continue;
        }
        uint32_t count = enf_kd_overlap(&tree, enf_box3f_outward(box), near, space->cell_count);
        for (uint32_t i = 0; ok && i < count; i++) {
            uint32_t b = near[i];
            bool nested = b <= a || is_ancestor(layout, a, b) || is_ancestor(layout, b, a);
            Overlap overlap = {.regions = regions, .space = space, .a = a, .b = b};
            ok = nested || enf_box3_is_empty(space->shells.cells[b].box) || test_pair(&overlap);
        }
    }
    free(near);
    return ok && enf_layout_sort_portals(layout->portals, layout->portal_count, layout->cell_count);
}
