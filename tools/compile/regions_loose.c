/* Homes of loose triangles. Input: triangles of nodes under no room; output: each one's cell, or OUTSIDE where it lies in none.
 *
 * What hangs together and is small stays together: it goes where most of it lies, and is listed in the other cells it touches by
 * reach.c. A large mesh is given out triangle by triangle. */
#include "compile/exact.h"
#include "compile/regions.h"
#include "compile/union_find.h"

enum {
    TOGETHER = 128, /* triangles of a group that stay together: a cluster's worth */
    SAMPLES = 24    /* of a group, that vote */
};

/* Metres in front of a surface at which one looks where it is: less than any room is deep, more than the grid's step. */
static const double IN_FRONT = 1.0 / 64.0;

typedef struct Corner {
    EnfGrid3 p;
    uint32_t triangle; /* in Loose.triangles */
} Corner;

typedef struct Loose {
    EnfRegions *regions;
    EnfSpace space;
    uint32_t *triangles; /* of the soup, by node */
    uint32_t count;
    uint32_t *parents; /* union-find over them */
    Corner *corners;   /* of one node */
    uint32_t outside;  /* the number that OUTSIDE has, or will have */
} Loose;

typedef struct Key {
    uint32_t node, triangle;
} Key;

static int compare_key(const void *pa, const void *pb) {
    const Key *a = pa, *b = pb;
    if (a->node != b->node) {
        return a->node < b->node ? -1 : 1;
    }
    return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

static int compare_corner(const void *pa, const void *pb) {
    const Corner *a = pa, *b = pb;
    int order = enf_grid_compare(a->p, b->p);
    return order != 0 ? order : (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

/* Lists loose triangles by node. */
static bool gather(Loose *loose) {
    const EnfSoup *soup = loose->regions->soup;
    for (uint32_t i = 0; i < soup->triangle_count; i++) {
        loose->count += soup->triangles[i].cell == ENF_NONE;
    }
    size_t n = (size_t)loose->count + 1;
    Key *keys = malloc(n * sizeof *keys);
    loose->triangles = malloc(n * sizeof *loose->triangles);
    loose->parents = malloc(n * sizeof *loose->parents);
    loose->corners = malloc(3 * n * sizeof *loose->corners);
    bool ok = keys != NULL && loose->triangles != NULL && loose->parents != NULL && loose->corners != NULL;
    for (uint32_t i = 0, k = 0; ok && i < soup->triangle_count; i++) {
        if (soup->triangles[i].cell == ENF_NONE) {
            keys[k++] = (Key){soup->triangles[i].node, i};
        }
    }
    if (ok) {
        qsort(keys, loose->count, sizeof *keys, compare_key);
        for (uint32_t i = 0; i < loose->count; i++) {
            loose->triangles[i] = keys[i].triangle;
        }
    }
    free(keys);
    return ok;
}

/* Unites the triangles [first, end) of one node that share a point; the root is the first of a group. */
static void unite(Loose *loose, uint32_t first, uint32_t end) {
    const EnfSoup *soup = loose->regions->soup;
    uint32_t count = 0;
    for (uint32_t i = first; i < end; i++) {
        loose->parents[i] = i;
        for (int k = 0; k < 3; k++) {
            loose->corners[count++] = (Corner){soup->vertices[soup->triangles[loose->triangles[i]].v[k]].p, i};
        }
    }
    qsort(loose->corners, count, sizeof *loose->corners, compare_corner);
    for (uint32_t i = 1; i < count; i++) {
        if (enf_grid_equal(loose->corners[i].p, loose->corners[i - 1].p)) {
            enf_sets_join(loose->parents, loose->corners[i].triangle, loose->corners[i - 1].triangle);
        }
    }
}

/* The cell in front of a triangle, or else behind it. */
static uint32_t cell_of(Loose *loose, uint32_t triangle) {
    EnfVec3 p[3];
    enf_soup_corners(loose->regions->soup, triangle, p);
    EnfVec3 centre = enf_scale(enf_add(p[0], enf_add(p[1], p[2])), 1.0 / 3.0);
    EnfVec3 n = enf_scale(enf_normalize(enf_cross(enf_sub(p[1], p[0]), enf_sub(p[2], p[0]))), IN_FRONT);
    uint32_t cell = enf_space_locate(&loose->space, enf_add(centre, n));
    return cell != ENF_NONE ? cell : enf_space_locate(&loose->space, enf_sub(centre, n));
}

typedef struct Votes {
    uint32_t cell[SAMPLES], count[SAMPLES], used;
} Votes;

static void vote(Votes *votes, uint32_t cell) {
    for (uint32_t i = 0; i < votes->used; i++) {
        if (votes->cell[i] == cell) {
            votes->count[i]++;
            return;
        }
    }
    votes->cell[votes->used] = cell;
    votes->count[votes->used++] = 1;
}

/* Being in a cell counts before being in none; then the most votes, then the lower number. */
static uint32_t winner(const Votes *votes) {
    uint32_t best = ENF_NONE, most = 0;
    for (uint32_t i = 0; i < votes->used; i++) {
        bool more = votes->count[i] > most || (votes->count[i] == most && votes->cell[i] < best);
        if (votes->cell[i] != ENF_NONE && more) {
            best = votes->cell[i];
            most = votes->count[i];
        }
    }
    return best;
}

/* Gives homes to the members of one group; returns how many lie in no cell. */
static uint32_t settle_group(Loose *loose, const uint32_t *members, uint32_t count) {
    EnfSoupTriangle *triangles = loose->regions->soup->triangles;
    uint32_t lost = 0, home = ENF_NONE;
    if (count <= TOGETHER) {
        Votes votes = {.used = 0};
        uint32_t samples = count < SAMPLES ? count : SAMPLES;
        for (uint32_t s = 0; s < samples; s++) {
            vote(&votes, cell_of(loose, members[(uint64_t)s * count / samples]));
        }
        home = winner(&votes);
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t cell = count <= TOGETHER ? home : cell_of(loose, members[i]);
        lost += cell == ENF_NONE;
        triangles[members[i]].cell = cell != ENF_NONE ? cell : loose->outside;
    }
    return lost;
}

/* Sorts the triangles of one node by group and settles each. */
static bool settle_node(Loose *loose, uint32_t first, uint32_t end) {
    uint32_t node = loose->regions->soup->triangles[loose->triangles[first]].node;
    uint32_t lost = 0, count = end - first;
    Key *keys = malloc(((size_t)count + 1) * sizeof *keys);
    uint32_t *members = malloc(((size_t)count + 1) * sizeof *members);
    bool ok = keys != NULL && members != NULL;
    if (ok) {
        unite(loose, first, end);
        for (uint32_t i = first; i < end; i++) {
            keys[i - first] = (Key){enf_sets_find(loose->parents, i), loose->triangles[i]};
        }
        qsort(keys, count, sizeof *keys, compare_key);
        for (uint32_t i = 0, from = 0; i < count; i++) {
            members[i] = keys[i].triangle;
            if (i + 1 == count || keys[i + 1].node != keys[i].node) {
                lost += settle_group(loose, &members[from], i + 1 - from);
                from = i + 1;
            }
        }
    }
    free(keys);
    free(members);
    if (lost > 0) {
        enf_diagnose(
            loose->regions->diagnosis, ENF_DIAGNOSIS_NODE_OUTSIDE, loose->regions->source->nodes[node].name,
            "%u of its %u triangles lie in no room: they are drawn only where the eye is outside, or sees into an open room",
            lost, count);
    }
    return ok;
}

/* Appends the OUTSIDE cell if some triangle needs it. */
static bool add_outside(Loose *loose) {
    EnfLayout *layout = loose->regions->layout;
    const EnfSoup *soup = loose->regions->soup;
    EnfGrid3 low = {INT64_MAX, INT64_MAX, INT64_MAX}, high = {INT64_MIN, INT64_MIN, INT64_MIN};
    for (uint32_t i = 0; i < loose->count; i++) {
        const EnfSoupTriangle *triangle = &soup->triangles[loose->triangles[i]];
        for (int k = 0; k < 3 && triangle->cell == loose->outside; k++) {
            EnfGrid3 p = soup->vertices[triangle->v[k]].p;
            low = (EnfGrid3){p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y, p.z < low.z ? p.z : low.z};
            high = (EnfGrid3){p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y, p.z > high.z ? p.z : high.z};
        }
    }
    if (low.x > high.x) {
        return true;
    }
    EnfLayoutCell *grown = realloc(layout->cells, ((size_t)layout->cell_count + 1) * sizeof *grown);
    if (grown == NULL) {
        return false;
    }
    layout->cells = grown;
    EnfLayoutCell cell = {.name = "outside", .node = ENF_NONE, .parent = ENF_NONE, .flags = ENF_CELL_OUTSIDE};
    cell.priority = -1000001; /* below any that extras may give */
    cell.min = low;
    cell.max = high;
    cell.origin = (EnfGrid3){(low.x + high.x) / 32 * 16, (low.y + high.y) / 32 * 16, (low.z + high.z) / 32 * 16};
    layout->cells[layout->cell_count++] = cell;
    return true;
}

bool enf_regions_loose(EnfRegions *regions) {
    Loose loose = {.regions = regions, .outside = regions->layout->cell_count};
    bool ok = gather(&loose);
    if (ok && loose.count > 0) {
        ok = enf_space_create(&loose.space, regions->layout, regions->soup);
        for (uint32_t first = 0, end; ok && first < loose.count; first = end) {
            uint32_t node = regions->soup->triangles[loose.triangles[first]].node;
            for (end = first + 1; end < loose.count; end++) {
                if (regions->soup->triangles[loose.triangles[end]].node != node) {
                    break;
                }
            }
            ok = settle_node(&loose, first, end);
        }
        ok = ok && add_outside(&loose);
        enf_space_free(&loose.space);
    }
    free(loose.triangles);
    free(loose.parents);
    free(loose.corners);
    return ok;
}
