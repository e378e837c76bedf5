/* The plain ways to find moving objects: evaluate every motion in every frame, and then look at arrays. No tree, no volume, no
 * memory of the last frame. A cheap box that may be a little too large decides first; the object's own box decides what is shown,
 * so the answer is the same as everyone's. */
#include "enfbench/movers.h"
#include "simd/simd.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Half the width of a cheap box: a little more than the object's, for what single precision rounds. */
#define CHEAP (MOVER_REACH + 0.0625)

struct Rival {
    const MoversScene *scene;
    bool sweep;
    int64_t tick;
    EnfVec3f *places;          /* flat: where an object is */
    EnfKdBlock *blocks;        /* sweep: the cheap boxes */
    uint32_t *cells, *sorted;  /* flat: the cell of an object; objects by cell */
    uint32_t *starts;          /* flat: where a cell's objects begin, cell_count + 1 */
    uint32_t *seen, *rejected; /* frame stamps: a cell is seen; an object has been asked about */
    uint32_t *found;
    uint32_t block_count, cell_count, frame;
};

void bench_rival_destroy(Rival *rival) {
    if (rival != NULL) {
        free(rival->places);
        free(rival->blocks);
        free(rival->cells);
        free(rival->sorted);
        free(rival->starts);
        free(rival->seen);
        free(rival->rejected);
        free(rival->found);
        free(rival);
    }
}

Rival *bench_rival_create(const MoversScene *scene, bool sweep) {
    Rival *rival = calloc(1, sizeof *rival);
    if (rival == NULL) {
        return NULL;
    }
    uint32_t count = scene->def.movers;
    rival->scene = scene;
    rival->sweep = sweep;
    rival->block_count = (count + ENF_KD_BLOCK - 1) / ENF_KD_BLOCK;
    rival->cell_count = scene->rooms.def.nx * scene->rooms.def.nz;
    rival->places = calloc(count + 1U, sizeof *rival->places);
    rival->blocks = calloc(rival->block_count + 1U, sizeof *rival->blocks);
    rival->cells = calloc(count + 1U, sizeof *rival->cells);
    rival->sorted = calloc(count + 1U, sizeof *rival->sorted);
    rival->starts = calloc(rival->cell_count + 2U, sizeof *rival->starts);
    rival->seen = calloc(rival->cell_count + 1U, sizeof *rival->seen);
    rival->rejected = calloc(count + 1U, sizeof *rival->rejected);
    rival->found = calloc(count + 1U, sizeof *rival->found);
    bool ok = rival->places && rival->blocks && rival->cells && rival->sorted && rival->starts && rival->seen &&
              rival->rejected && rival->found;
    if (!ok) {
        bench_rival_destroy(rival);
        return NULL;
    }
    for (uint32_t b = 0; b < rival->block_count; b++) {
        memset(rival->blocks[b].item, 0xff, sizeof rival->blocks[b].item);
    }
    for (uint32_t i = 0; i < count; i++) {
        rival->blocks[i / ENF_KD_BLOCK].item[i % ENF_KD_BLOCK] = i;
    }
    return rival;
}

static EnfVec3f single(EnfVec3 p) {
    EnfVec3f out = {(float)p.x, (float)p.y, (float)p.z};
    return out;
}

/* Where a motion costs something it is worked out whole; a straight way has nothing but a position. */
static EnfVec3 evaluate(const Mover *mover, int64_t tick) {
    bool plain = (mover->motion == MOVERS_FREE || mover->motion == MOVERS_LINEAR) && mover->polygons == 0;
    return plain ? bench_mover_at(mover, tick) : bench_mover_state(mover, tick).position;
}

static uint32_t cell_at(const Rival *rival, double x, double z) {
    const EnfRoomsDef *d = &rival->scene->rooms.def;
    double ix = (x - d->origin.x) / d->room.x;
    double iz = (z - d->origin.z) / d->room.z;
    uint32_t cx = ix < 0.0 ? 0U : ix >= (double)d->nx ? d->nx - 1 : (uint32_t)ix;
    uint32_t cz = iz < 0.0 ? 0U : iz >= (double)d->nz ? d->nz - 1 : (uint32_t)iz;
    return cz * d->nx + cx;
}

static void look_at(Rival *rival, const MoversWindows *windows, uint32_t object, uint32_t *count) {
    if (rival->rejected[object] != rival->frame) {
        rival->rejected[object] = rival->frame;
        EnfPose pose = bench_mover_state(&rival->scene->movers[object], rival->tick);
        if (bench_movers_shown(rival->scene, windows, bench_mover_box(&pose))) {
            rival->found[(*count)++] = object;
        }
    }
}

/* ---- flat ------------------------------------------------------------------------------------------------------- */

/* A counting sort by the cell of the middle. */
static void bin(Rival *rival) {
    uint32_t count = rival->scene->def.movers;
    memset(rival->starts, 0, (rival->cell_count + 1) * sizeof *rival->starts);
    for (uint32_t i = 0; i < count; i++) {
        const EnfVec3f *p = &rival->places[i];
        rival->cells[i] = cell_at(rival, (double)p->x, (double)p->z);
        rival->starts[rival->cells[i] + 1]++;
    }
    for (uint32_t c = 0; c < rival->cell_count; c++) {
        rival->starts[c + 1] += rival->starts[c];
    }
    for (uint32_t i = count; i > 0; i--) { /* fills each cell from its end, so that starts[] ends where it was */
        rival->sorted[--rival->starts[rival->cells[i - 1] + 1]] = i - 1;
    }
}

/* A seen cell and its neighbours: who stands in one may reach into the other. After `bin`, starts[c + 1] is where c begins. */
static void look_into(Rival *rival, const MoversWindow *window, const MoversWindows *windows, uint32_t *count) {
    const EnfRoomsDef *d = &rival->scene->rooms.def;
    uint32_t cx = window->cell % d->nx;
    uint32_t cz = window->cell / d->nx;
    uint32_t z1 = cz + 1 < d->nz ? cz + 1 : cz;
    uint32_t x1 = cx + 1 < d->nx ? cx + 1 : cx;
    EnfBox3 room = enf_rooms_box(&rival->scene->rooms, window->cell);
    for (uint32_t z = cz > 0 ? cz - 1 : 0; z <= z1; z++) {
        for (uint32_t x = cx > 0 ? cx - 1 : 0; x <= x1; x++) {
            uint32_t cell = z * d->nx + x;
            uint32_t end = cell + 1 < rival->cell_count ? rival->starts[cell + 2] : rival->scene->def.movers;
            for (uint32_t k = rival->starts[cell + 1]; k < end; k++) {
                EnfVec3 p = enf_v3_from_f(rival->places[rival->sorted[k]]);
                bool near = p.x > room.min.x - CHEAP && p.x < room.max.x + CHEAP && p.z > room.min.z - CHEAP &&
                            p.z < room.max.z + CHEAP;
                if (near) {
                    look_at(rival, windows, rival->sorted[k], count);
                }
            }
        }
    }
}

static void evaluate_flat(Rival *rival, int64_t tick) {
    for (uint32_t i = 0; i < rival->scene->def.movers; i++) {
        rival->places[i] = single(evaluate(&rival->scene->movers[i], tick));
    }
    bin(rival);
}

/* ---- sweep ------------------------------------------------------------------------------------------------------ */

static void evaluate_sweep(Rival *rival, int64_t tick) {
    const float w = (float)CHEAP;
    const float h = (float)(MOVER_HEIGHT + 0.0625);
    for (uint32_t i = 0; i < rival->scene->def.movers; i++) {
        EnfVec3f p = single(evaluate(&rival->scene->movers[i], tick));
        EnfKdBlock *block = &rival->blocks[i / ENF_KD_BLOCK];
        uint32_t lane = i % ENF_KD_BLOCK;
        block->min_x[lane] = p.x - w;
        block->min_y[lane] = p.y - h;
        block->min_z[lane] = p.z - w;
        block->max_x[lane] = p.x + w;
        block->max_y[lane] = p.y + h;
        block->max_z[lane] = p.z + w;
    }
}

/* Could a box touch a seen cell? The cells of its corners. */
static bool near_seen(const Rival *rival, const EnfKdBlock *block, uint32_t lane) {
    double x0 = (double)block->min_x[lane];
    double x1 = (double)block->max_x[lane];
    double z0 = (double)block->min_z[lane];
    double z1 = (double)block->max_z[lane];
    return rival->seen[cell_at(rival, x0, z0)] == rival->frame || rival->seen[cell_at(rival, x1, z0)] == rival->frame ||
           rival->seen[cell_at(rival, x0, z1)] == rival->frame || rival->seen[cell_at(rival, x1, z1)] == rival->frame;
}

static void look_everywhere(Rival *rival, const EnfView *view, const MoversWindows *windows, uint32_t *count) {
    const EnfSimd *simd = enf_simd();
    const EnfMap *map = rival->scene->rooms.map;
    EnfBox3 all = enf_box3_union(enf_rooms_box(&rival->scene->rooms, 0),
                                 enf_rooms_box(&rival->scene->rooms, map->cells_count - 1));
    EnfPyramid pyramid;
    EnfSimdPlanes planes;
    enf_pyramid(&view->camera, enf_window_full(&view->camera), NULL, enf_v3(0.0, 0.0, 0.0), enf_box3f_outward(all), &pyramid);
    enf_simd_planes(&planes, &pyramid);
    for (uint32_t i = 0; i < windows->count; i++) {
        rival->seen[windows->items[i].cell] = rival->frame;
    }
    for (uint32_t b = 0; b < rival->block_count; b++) {
        uint32_t mask = simd->boxes(&planes, rival->blocks[b].min_x, planes.all) & 0xff;
        for (; mask != 0; mask &= mask - 1) {
            uint32_t lane = enf_simd_lowest(mask);
            if (near_seen(rival, &rival->blocks[b], lane)) {
                look_at(rival, windows, b * ENF_KD_BLOCK + lane, count);
            }
        }
    }
}

/* ---- both ------------------------------------------------------------------------------------------------------- */

static int ascending(const void *a, const void *b) {
    uint32_t x = *(const uint32_t *)a;
    uint32_t y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

const uint32_t *bench_rival_frame(Rival *rival, const EnfView *view, const MoversWindows *windows, int64_t tick,
                                  uint32_t *count) {
    rival->frame++;
    rival->tick = tick;
    *count = 0;
    if (rival->sweep) {
        evaluate_sweep(rival, tick);
        look_everywhere(rival, view, windows, count);
        return rival->found; /* in order already */
    }
    evaluate_flat(rival, tick);
    for (uint32_t i = 0; i < windows->count; i++) {
        look_into(rival, &windows->items[i], windows, count);
    }
    if (*count > 1) {
        qsort(rival->found, *count, sizeof *rival->found, ascending);
    }
    return rival->found;
}
