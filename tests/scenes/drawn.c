/* The oracle of moving objects: no tree, no volume, no period; a view's windows, and a loop over everything that lives. */
#include "scenes/drawn.h"

#include <stdlib.h>
#include <string.h>

/* Makes room for `count` elements of `size`; what was there stays. */
static bool reserve(void **array, uint32_t *capacity, uint32_t count, size_t size) {
    if (count <= *capacity) {
        return true;
    }
    uint32_t larger = count + count / 2;
    void *moved = realloc(*array, larger * size);
    if (!moved) {
        return false;
    }
    *array = moved;
    *capacity = larger;
    return true;
}

static bool list_windows(EnfDrawnOracle *oracle, const EnfMap *map, const EnfVisSet *set) {
    void *windows = oracle->windows;
    if (!reserve(&windows, &oracle->window_capacity, set->visit_count, sizeof *oracle->windows)) {
        return false;
    }
    oracle->windows = windows;
    oracle->window_count = set->visit_count;
    for (uint32_t i = 0; i < set->visit_count; i++) {
        const EnfVisit *visit = &set->visits[i];
        const EnfCell *c = &map->cells[visit->cell];
        const EnfWindowPolygon *polygon = visit->polygon == ENF_NONE ? NULL : &set->polygons[visit->polygon];
        EnfBox3f bounds = {{c->min[0], c->min[1], c->min[2]}, {c->max[0], c->max[1], c->max[2]}};
        oracle->windows[i].cell = visit->cell;
        enf_pyramid(&set->cameras[visit->space], visit->window, polygon, enf_v3(c->origin[0], c->origin[1], c->origin[2]),
                    bounds, &oracle->windows[i].pyramid);
    }
    return true;
}

static bool seen(const EnfDrawnOracle *oracle, const EnfMap *map, EnfBox3f box) {
    for (uint32_t i = 0; i < oracle->window_count; i++) {
        const EnfSeenWindow *window = &oracle->windows[i];
        if (enf_world_touches(map, window->cell, box) &&
            enf_pyramid_box(&window->pyramid, enf_world_box_in_cell(map, window->cell, box))) {
            return true;
        }
    }
    return false;
}

bool enf_drawn_look(EnfDrawnOracle *oracle, EnfVis *vis, const EnfPortals *portals, const EnfView *view, EnfWorld *world) {
    EnfView bare = *view;
    bare.dbv = NULL;
    const EnfMap *map = enf_world_map(world);
    const EnfVisSet *set = enf_vis_run(vis, portals, &bare);
    uint32_t limit = enf_world_object_limit(world);
    void *drawn = oracle->drawn;
    if (!list_windows(oracle, map, set) || !reserve(&drawn, &oracle->capacity, limit, sizeof *oracle->drawn)) {
        oracle->failed = true;
        return false;
    }
    oracle->drawn = drawn;
    oracle->limit = limit;
    oracle->drawn_count = 0;
    for (uint32_t object = 0; object < limit; object++) {
        bool alive = enf_world_object(world, object).generation != 0;
        oracle->drawn[object] = alive && seen(oracle, map, enf_world_seen_box(world, object));
        oracle->drawn_count += oracle->drawn[object] ? 1U : 0U;
    }
    return true;
}

uint32_t enf_drawn_differs(const EnfDrawnOracle *oracle, const uint32_t *objects, uint32_t count) {
    uint32_t k = 0;
    for (uint32_t object = 0; object < oracle->limit; object++) {
        bool listed = k < count && objects[k] == object;
        k += listed ? 1U : 0U;
        if (listed != oracle->drawn[object]) {
            return object;
        }
    }
    return k < count ? objects[k] : ENF_NONE;
}

uint32_t enf_drawn_check(const EnfDrawnOracle *oracle, EnfDbvIndex *index) {
    if (enf_dbv_begin(index, NULL) != ENF_OK) {
        return 0;
    }
    for (uint32_t i = 0; i < oracle->window_count; i++) {
        enf_dbv_see(index, oracle->windows[i].cell, &oracle->windows[i].pyramid);
    }
    uint32_t count = 0;
    const uint32_t *objects = enf_dbv_end(index, &count);
    return enf_dbv_failed(index) ? 0 : enf_drawn_differs(oracle, objects, count);
}

void enf_drawn_free(EnfDrawnOracle *oracle) {
    free(oracle->windows);
    free(oracle->drawn);
    memset(oracle, 0, sizeof *oracle);
}
