/* Cells that are not closed (PITFALLS 17). Input: shells; output: a warning with the way out, and ENF_CELL_OPEN.
 *
 * Most cells are proved closed: their surfaces and portals have no border and wind around the points just inside the portals. For the
 * others a ball of settings.leak_gap tries to get out, in voxels (regions_voxels.c). Never is a cell called closed because voxels were
 * too coarse to see the room at all: then nothing is said, as with openings narrower than the gap. */
#include "compile/regions.h"
#include "compile/regions_closed.h"
#include "compile/regions_voxels.h"

enum {
    SEEDS = 96,
    SURFACE_SEEDS = 24,
    PATH_POINTS = 96,
    SMALL_CELL = 2048,        /* triangles up to which a proof from all of them is tried, not only from the walls */
    VOXELS_IN_ALL = 24000000, /* shared by the cells that need a flood */
    VOXELS_LEAST = 16384,
    VOXELS_MOST = 2000000
};

/* Metres from a portal or surface to the point just inside that is asked about. */
static const double JUST_INSIDE = 1.0 / 64.0;

/* A node whose box is at least this much of its cell's (by the diagonals) is taken for walls. */
static const double WALLS = 0.4;

typedef struct Leaks {
    EnfRegions *regions;
    EnfSpace *space;
    uint32_t *order, *first; /* the soup's triangles by home: of cell c, order[first[c] .. first[c + 1]) */
    ENF_ARRAY(EnfGrid3) corners;
    ENF_ARRAY(bool) closed;
    ENF_ARRAY(uint32_t) floods; /* cells without a proof */
    uint32_t *near;
    ENF_ARRAY(EnfLayoutGuest) guests;
    EnfVoxels voxels;
    EnfVec3 seeds[SEEDS]; /* points inside, with the direction inward */
    EnfVec3 inward[SEEDS];
    uint32_t seed_count;
} Leaks;

static bool sort_triangles(Leaks *leaks) {
    const EnfSoup *soup = leaks->regions->soup;
    uint32_t cells = leaks->regions->layout->cell_count;
    leaks->first = calloc((size_t)cells + 2, sizeof *leaks->first);
    leaks->order = malloc(((size_t)soup->triangle_count + 1) * sizeof *leaks->order);
    leaks->near = malloc(((size_t)cells + 1) * sizeof *leaks->near);
    if (!leaks->first || !leaks->order || !leaks->near) {
        return false;
    }
    for (uint32_t i = 0; i < soup->triangle_count; i++) {
        leaks->first[soup->triangles[i].cell + 2]++;
    }
    for (uint32_t c = 0; c <= cells; c++) {
        leaks->first[c + 1] += leaks->first[c];
    }
    for (uint32_t i = 0; i < soup->triangle_count; i++) {
        leaks->order[leaks->first[soup->triangles[i].cell + 1]++] = i;
    }
    return true;
}

static bool seals(const Leaks *leaks, uint32_t triangle) {
    return !(leaks->space->faces[leaks->regions->soup->triangles[triangle].material] & ENF_FACE_OPEN);
}

/* The middle of a portal's polygon, and its normal into the cell that it leaves. */
static EnfVec3 portal_middle(const EnfLayout *layout, const EnfLayoutPortal *portal, EnfVec3 *inward) {
    EnfVec3 middle = {0}, points[ENF_POLYGON_MAX];
    for (uint32_t i = 0; i < portal->point_count; i++) {
        points[i] = enf_grid_point(layout->points[portal->point_first + i]);
        middle = enf_add(middle, enf_scale(points[i], 1.0 / portal->point_count));
    }
    *inward = enf_scale(enf_plane_from_polygon(points, portal->point_count).n, -1.0);
    return middle;
}

static double diagonal(EnfBox3 box) {
    return enf_length(enf_sub(box.max, box.min));
}

/* The end of the run of triangles of one node that begins at `i`, and the box of the run. */
static uint32_t run_of_node(const Leaks *leaks, uint32_t i, uint32_t end, EnfBox3 *box) {
    const EnfSoup *soup = leaks->regions->soup;
    uint32_t node = soup->triangles[leaks->order[i]].node;
    *box = enf_box3_empty();
    for (; i < end && soup->triangles[leaks->order[i]].node == node; i++) {
        EnfVec3 p[3];
        enf_soup_corners(soup, leaks->order[i], p);
        *box = enf_box3_add(enf_box3_add(enf_box3_add(*box, p[0]), p[1]), p[2]);
    }
    return i;
}

static bool gather_portals(Leaks *leaks, uint32_t cell) {
    const EnfLayout *layout = leaks->regions->layout;
    for (uint32_t p = leaks->space->portal_first[cell]; p < leaks->space->portal_first[cell + 1]; p++) {
        if (layout->portals[p].point_count == 0) {
            continue; /* a link, and perhaps no portal in the level has points at all */
        }
        const EnfGrid3 *points = &layout->points[layout->portals[p].point_first];
        for (uint32_t k = 2; k < layout->portals[p].point_count; k++) {
            if (!ENF_ARRAY_ROOM(&leaks->corners, 3)) {
                return false;
            }
            leaks->corners.data[leaks->corners.count++] = points[0];
            leaks->corners.data[leaks->corners.count++] = points[k];
            leaks->corners.data[leaks->corners.count++] = points[k - 1];
        }
    }
    return true;
}

/* Surfaces and portals of a cell, fronts inward; of the surfaces only nodes that span `share` of the cell: its walls, rather than what
 * stands between them. */
static bool gather(Leaks *leaks, uint32_t cell, double share) {
    const EnfSoup *soup = leaks->regions->soup;
    double least = share * diagonal(leaks->space->shells.cells[cell].box);
    leaks->corners.count = 0;
    for (uint32_t first = leaks->first[cell], end; first < leaks->first[cell + 1]; first = end) {
        EnfBox3 box;
        end = run_of_node(leaks, first, leaks->first[cell + 1], &box);
        if (diagonal(box) < least) {
            continue;
        }
        if (!ENF_ARRAY_ROOM(&leaks->corners, 3 * (uint64_t)(end - first))) {
            return false;
        }
        for (uint32_t i = first; i < end; i++) {
            for (int k = 0; k < 3 && seals(leaks, leaks->order[i]); k++) {
                leaks->corners.data[leaks->corners.count++] = soup->vertices[soup->triangles[leaks->order[i]].v[k]].p;
            }
        }
    }
    leaks->closed.count = 0;
    return gather_portals(leaks, cell) && ENF_ARRAY_ROOM(&leaks->closed, leaks->corners.count / 3 + 1);
}

static void add_seed(Leaks *leaks, EnfVec3 at, EnfVec3 inward) {
    if (leaks->seed_count < SEEDS) {
        leaks->seeds[leaks->seed_count] = at;
        leaks->inward[leaks->seed_count++] = inward;
    }
}

/* Portals come first: `portal_seeds` of them. */
static uint32_t find_seeds(Leaks *leaks, uint32_t cell) {
    const EnfLayout *layout = leaks->regions->layout;
    leaks->seed_count = 0;
    for (uint32_t p = leaks->space->portal_first[cell]; p < leaks->space->portal_first[cell + 1]; p++) {
        EnfVec3 inward, middle;
        if (layout->portals[p].point_count >= 3 && leaks->seed_count < SEEDS - SURFACE_SEEDS) {
            middle = portal_middle(layout, &layout->portals[p], &inward);
            add_seed(leaks, middle, inward);
        }
    }
    uint32_t portal_seeds = leaks->seed_count, count = leaks->first[cell + 1] - leaks->first[cell];
    for (uint32_t s = 0; s < SURFACE_SEEDS && s < count; s++) {
        uint32_t triangle = leaks->order[leaks->first[cell] + (uint32_t)((uint64_t)s * count / SURFACE_SEEDS)];
        EnfVec3 p[3];
        enf_soup_corners(leaks->regions->soup, triangle, p);
        EnfVec3 n = enf_normalize(enf_cross(enf_sub(p[1], p[0]), enf_sub(p[2], p[0])));
        add_seed(leaks, enf_scale(enf_add(p[0], enf_add(p[1], p[2])), 1.0 / 3.0),
                 leaks->space->shells.cells[cell].inverted ? enf_scale(n, -1.0) : n);
    }
    return portal_seeds;
}

/* Every way in is enclosed; a cell without portals needs one enclosed point. */
static bool is_proved_closed(Leaks *leaks, uint32_t cell) {
    uint32_t portal_seeds = find_seeds(leaks, cell);
    EnfSurface surface = {leaks->corners.data, leaks->corners.count / 3};
    if (!enf_surface_closed_parts(&surface, leaks->closed.data)) {
        return false;
    }
    uint32_t asked = portal_seeds > 0 ? portal_seeds : leaks->seed_count, enclosed = 0;
    for (uint32_t i = 0; i < asked; i++) {
        EnfVec3 p = enf_add(leaks->seeds[i], enf_scale(leaks->inward[i], JUST_INSIDE));
        enclosed += enf_surface_encloses(&surface, leaks->closed.data, p);
        if (portal_seeds > 0 && enclosed <= i) {
            return false;
        }
    }
    return enclosed > 0;
}

/* ---- floods ---------------------------------------------------------------------------------------------------------------- */

static void mark_own(Leaks *leaks) {
    for (uint32_t i = 0; i + 2 < leaks->corners.count; i += 3) {
        EnfVec3 p[3];
        for (uint32_t k = 0; k < 3; k++) {
            p[k] = enf_grid_point(leaks->corners.data[i + k]);
        }
        enf_voxels_mark(&leaks->voxels, p);
    }
}

/* A neighbour's surface closes the cell where one who stands in the cell sees it: two-sided, or with its front. */
static bool closes(Leaks *leaks, uint32_t cell, uint32_t triangle, const EnfVec3 p[3]) {
    const EnfSoupTriangle *record = &leaks->regions->soup->triangles[triangle];
    bool loose = leaks->regions->layout->node_cells[record->node] == ENF_NONE;
    if (loose || (leaks->space->faces[record->material] & ENF_FACE_TWO_SIDED)) {
        return true;
    }
    EnfVec3 n = enf_normalize(enf_cross(enf_sub(p[1], p[0]), enf_sub(p[2], p[0])));
    EnfVec3 centre = enf_scale(enf_add(p[0], enf_add(p[1], p[2])), 1.0 / 3.0);
    return enf_shell_open_to(&leaks->space->shells, cell, enf_add(centre, enf_scale(n, JUST_INSIDE)), n);
}

/* Cells whose boxes meet that of `cell`, into leaks->near. */
static uint32_t find_near(Leaks *leaks, EnfBox3 box) {
    const EnfLayout *layout = leaks->regions->layout;
    EnfKdTree tree = enf_kd_tree(&leaks->space->tree);
    uint32_t count = enf_kd_overlap(&tree, enf_box3f_outward(box), leaks->near, layout->cell_count);
    if (leaks->space->cell_count < layout->cell_count) {
        leaks->near[count++] = leaks->space->cell_count; /* OUTSIDE */
    }
    return count;
}

static void mark_neighbours(Leaks *leaks, uint32_t cell) {
    EnfBox3 box = leaks->space->shells.cells[cell].box;
    uint32_t count = find_near(leaks, box);
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = leaks->first[leaks->near[i]]; leaks->near[i] != cell && k < leaks->first[leaks->near[i] + 1]; k++) {
            EnfVec3 p[3];
            enf_soup_corners(leaks->regions->soup, leaks->order[k], p);
            EnfBox3 around = enf_box3_add(enf_box3_add(enf_box3_add(enf_box3_empty(), p[0]), p[1]), p[2]);
            if (seals(leaks, leaks->order[k]) && enf_box3_overlaps(around, box) && closes(leaks, cell, leaks->order[k], p)) {
                enf_voxels_mark(&leaks->voxels, p);
            }
        }
    }
}

/* What stopped the flood is seen from inside, whoever's it is. @return false if memory is out. */
static bool invite_guests(Leaks *leaks, uint32_t cell) {
    EnfBox3 box = leaks->space->shells.cells[cell].box;
    uint32_t count = find_near(leaks, box);
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = leaks->first[leaks->near[i]]; leaks->near[i] != cell && k < leaks->first[leaks->near[i] + 1]; k++) {
            EnfVec3 p[3];
            enf_soup_corners(leaks->regions->soup, leaks->order[k], p);
            EnfBox3 around = enf_box3_add(enf_box3_add(enf_box3_add(enf_box3_empty(), p[0]), p[1]), p[2]);
            if (!enf_box3_overlaps(around, box) || !enf_voxels_meets_flood(&leaks->voxels, p)) {
                continue;
            }
            if (!ENF_ARRAY_ROOM(&leaks->guests, 1)) {
                return false;
            }
            leaks->guests.data[leaks->guests.count++] = (EnfLayoutGuest){leaks->order[k], cell};
        }
    }
    return true;
}

static int compare_guests(const void *pa, const void *pb) {
    const EnfLayoutGuest *a = pa, *b = pb;
    if (a->triangle != b->triangle) {
        return a->triangle < b->triangle ? -1 : 1;
    }
    return (a->cell > b->cell) - (a->cell < b->cell);
}

/* Voxels that certainly lie inside: free, a few steps in from a portal or surface, and every ray from there sees fronts. */
static uint32_t seed_voxels(Leaks *leaks, uint32_t cell, uint32_t *voxels) {
    static const double steps[] = {1.0, 2.0, 3.0, 5.0};
    uint32_t count = 0;
    for (uint32_t i = 0; i < leaks->seed_count; i++) {
        for (size_t s = 0; s < sizeof steps / sizeof steps[0]; s++) {
            EnfVec3 p = enf_add(leaks->seeds[i], enf_scale(leaks->inward[i], steps[s] * leaks->voxels.size));
            uint32_t voxel = enf_voxels_at(&leaks->voxels, p);
            bool free_voxel = voxel != ENF_NONE && leaks->voxels.solid[voxel] != 1;
            if (free_voxel &&
                enf_shell_inside(&leaks->space->shells, cell, enf_voxels_centre(&leaks->voxels, voxel), 0.0, true)) {
                voxels[count++] = voxel;
                break;
            }
        }
    }
    return count;
}

/* Walls given to no room, or to the neighbours, may leave a room without any point that is surely inside: what its surfaces close off
 * cannot be told, so whoever sees into it is shown everything. */
static void report_unclosed(Leaks *leaks, uint32_t cell) {
    leaks->regions->layout->cells[cell].flags |= ENF_CELL_OPEN;
    enf_diagnose(
        leaks->regions->diagnosis, ENF_DIAGNOSIS_ROOM_LEAK, leaks->regions->layout->cells[cell].name,
        "its own surfaces close off nothing (are its walls under another node?): whoever sees into it is shown everything");
}

static void report(Leaks *leaks, uint32_t cell, uint32_t exit) {
    EnfLayout *layout = leaks->regions->layout;
    EnfBox3 box = leaks->space->shells.cells[cell].box;
    EnfVec3 points[PATH_POINTS], hole = enf_voxels_centre(&leaks->voxels, exit);
    uint32_t length = 1, count = 0;
    for (uint32_t v = exit; leaks->voxels.from[v] != v; v = leaks->voxels.from[v]) {
        length++;
    }
    uint32_t step = length / PATH_POINTS + 1, at = 0;
    bool inside = false;
    for (uint32_t v = exit;; v = leaks->voxels.from[v], at++) {
        EnfVec3 p = enf_voxels_centre(&leaks->voxels, v);
        if (!inside && enf_box3_contains(box, p)) {
            inside = true;
            hole = p;
        }
        bool last = leaks->voxels.from[v] == v;
        if ((at % step == 0 || last) && count < PATH_POINTS) {
            points[count++] = p;
        }
        if (last) {
            break;
        }
    }
    layout->cells[cell].flags |= ENF_CELL_OPEN;
    enf_diagnose(
        leaks->regions->diagnosis, ENF_DIAGNOSIS_ROOM_LEAK, layout->cells[cell].name,
        "a gap of about %.2f m or more leads out of the room near (%.2f, %.2f, %.2f): whoever sees into it is shown everything",
        leaks->voxels.size * 2.0, hole.x, hole.y, hole.z);
    enf_diagnose_points(leaks->regions->diagnosis, points, count);
}

static double voxel_size(const Leaks *leaks, EnfBox3 box) {
    EnfVec3 size = enf_sub(box.max, box.min);
    double least = size.x < size.y ? size.x : size.y, wanted = leaks->regions->settings->leak_gap / 2.0;
    least = size.z < least ? size.z : least;
    wanted = wanted < least / 6.0 ? wanted : least / 6.0; /* a thin cell still has an inside */
    return wanted > 0.02 ? wanted : 0.02;
}

static bool flood(Leaks *leaks, uint32_t cell, uint32_t limit) {
    EnfBox3 box = leaks->space->shells.cells[cell].box;
    if (enf_box3_is_empty(box)) {
        report_unclosed(leaks, cell);
        return true;
    }
    uint32_t voxels[SEEDS], seeds;
    if (!gather(leaks, cell, 0.0) || !enf_voxels_reset(&leaks->voxels, box, voxel_size(leaks, box), limit)) {
        return false;
    }
    mark_own(leaks);
    find_seeds(leaks, cell);
    seeds = seed_voxels(leaks, cell, voxels);
    if (seeds == 0) {
        report_unclosed(leaks, cell);
        return true;
    }
    uint32_t exit = enf_voxels_flood(&leaks->voxels, voxels, seeds);
    if (exit != ENF_NONE) {
        mark_neighbours(leaks, cell);
        exit = enf_voxels_flood(&leaks->voxels, voxels, seed_voxels(leaks, cell, voxels));
    }
    if (exit == ENF_NONE && !invite_guests(leaks, cell)) {
        return false;
    }
    if (exit != ENF_NONE) {
        report(leaks, cell, exit);
    }
    return true;
}

static bool find_all(Leaks *leaks) {
    const EnfLayout *layout = leaks->regions->layout;
    for (uint32_t c = 0; c < leaks->space->cell_count; c++) {
        if (layout->cells[c].flags & ENF_CELL_OPEN) {
            continue;
        }
        bool proved = false;
        uint32_t all = leaks->first[c + 1] - leaks->first[c];
        for (int attempt = 0; attempt < (all <= SMALL_CELL ? 2 : 1) && !proved; attempt++) {
            if (!gather(leaks, c, attempt == 0 ? WALLS : 0.0) || !ENF_ARRAY_ROOM(&leaks->floods, 1)) {
                return false;
            }
            proved = is_proved_closed(leaks, c);
        }
        if (!proved) {
            leaks->floods.data[leaks->floods.count++] = c;
        }
    }
    uint32_t share = leaks->floods.count > 0 ? VOXELS_IN_ALL / leaks->floods.count : 0;
    share = share < VOXELS_LEAST ? VOXELS_LEAST : share > VOXELS_MOST ? VOXELS_MOST : share;
    for (uint32_t i = 0; i < leaks->floods.count; i++) {
        if (!flood(leaks, leaks->floods.data[i], share)) {
            return false;
        }
    }
    return true;
}

bool enf_regions_leaks(EnfRegions *regions, EnfSpace *space) {
    Leaks *leaks = calloc(1, sizeof *leaks);
    bool ok = leaks != NULL;
    if (ok) {
        leaks->regions = regions;
        leaks->space = space;
        ok = sort_triangles(leaks) && find_all(leaks);
        if (leaks->guests.count > 0) {
            qsort(leaks->guests.data, leaks->guests.count, sizeof *leaks->guests.data, compare_guests);
        }
        free(regions->layout->guests);
        regions->layout->guests = leaks->guests.data;
        regions->layout->guest_count = leaks->guests.count;
        free(leaks->order);
        free(leaks->first);
        free(leaks->near);
        free(leaks->corners.data);
        free(leaks->closed.data);
        free(leaks->floods.data);
        enf_voxels_free(&leaks->voxels);
    }
    free(leaks);
    return ok;
}
