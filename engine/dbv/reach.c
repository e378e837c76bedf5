/* How far a confined object may get: it passes no wall, so that it comes into a cell only through the portals of the cells that it
 * touched before. A flood from where it stands, nearest portal first (Dijkstra 1959), ends at the first portal that leads into a
 * seen cell, or when the cells are more than a volume hangs on. Until the object can have come as far as that portal it is in none
 * but the cells found, and its volume hangs in these alone: it does not leak through the walls between (DESIGN §5).
 *
 * Closed portals count as open: a door may be opened at any tick, and what it guards must not be missed then (PITFALLS 24). A
 * portal's distance is that from the object's own box, and not less than that of the portals before it; nothing is added up along
 * the way, as a long object may stand in two doors at once. */
#include "dbv/dbv_internal.h"

#include <enfilade/tolerances.h>

#include <math.h>
#include <string.h>

/* Portals that lead out of the cells found, at most; a room with more is not worth a flood. */
enum { PENDING = 48 };

static EnfBox3f portal_box(const EnfMap *map, const EnfPortal *portal) {
    const double *o = map->cells[portal->source].origin;
    EnfVec3 origin = enf_v3(o[0], o[1], o[2]);
    EnfBox3 box = enf_box3_empty();
    for (uint32_t v = 0; v < portal->vertex_count; v++) {
        box = enf_box3_add(box, enf_add(origin, enf_v3_from_f(map->portal_vertices[portal->vertex_first + v])));
    }
    return enf_box3f_outward(box);
}

void enf_dbv_reach_boxes(const EnfMap *map, EnfBox3f *boxes) {
    for (uint32_t p = 0; p < map->portals_count; p++) {
        boxes[p] = portal_box(map, &map->portals[p]);
    }
}

static double apart(double low, double high, double other_low, double other_high) {
    double d = low > other_high ? low - other_high : other_low - high;
    return d > 0.0 ? d : 0.0;
}

/* Squared. */
static double distance(const EnfBox3 *a, const EnfBox3f *b) {
    double x = apart(a->min.x, a->max.x, (double)b->min.x, (double)b->max.x);
    double y = apart(a->min.y, a->max.y, (double)b->min.y, (double)b->max.y);
    double z = apart(a->min.z, a->max.z, (double)b->min.z, (double)b->max.z);
    return x * x + y * y + z * z;
}

static bool is_found(const EnfDbvReach *reach, uint32_t cell) {
    for (uint32_t i = 0; i < reach->count; i++) {
        if (reach->cells[i] == cell) {
            return true;
        }
    }
    return false;
}

/* The portals out of the cells found, each with its squared distance. */
typedef struct Pending {
    uint32_t portals[PENDING];
    double distances[PENDING];
    uint32_t count;
} Pending;

/* A cell is found: its portals are pending. False if they are too many. */
static bool add_cell(const EnfDbvIndex *index, EnfDbvReach *reach, const EnfBox3 *now, uint32_t number, double least,
                     Pending *pending) {
    const EnfCell *cell = &index->map->cells[number];
    for (uint32_t p = cell->portal_first; p < cell->portal_first + cell->portal_count; p++) {
        if (pending->count == PENDING) {
            return false;
        }
        /* Cells that overlap are entered anywhere. */
        double d = index->map->portals[p].vertex_count > 0 ? distance(now, &index->portal_boxes[p]) : 0.0;
        pending->portals[pending->count] = p;
        pending->distances[pending->count++] = d > least ? d : least;
    }
    reach->cells[reach->count++] = number;
    return true;
}

/* Takes out the nearest pending portal that leads on; false if there is none. */
static bool take_nearest(const EnfMap *map, const EnfDbvReach *reach, Pending *pending, const EnfPortal **nearest, double *d) {
    for (;;) {
        uint32_t best = ENF_NONE;
        for (uint32_t i = 0; i < pending->count; i++) {
            best = best == ENF_NONE || pending->distances[i] < pending->distances[best] ? i : best;
        }
        if (best == ENF_NONE) {
            return false;
        }
        const EnfPortal *portal = &map->portals[pending->portals[best]];
        *nearest = portal;
        *d = pending->distances[best];
        pending->count--;
        pending->portals[best] = pending->portals[pending->count];
        pending->distances[best] = pending->distances[pending->count];
        if (portal->transform != ENF_NONE || !is_found(reach, portal->target)) {
            return true;
        }
    }
}

bool enf_dbv_can_reach(const EnfMap *map) {
    for (uint32_t p = 0; p < map->portals_count; p++) {
        if (map->portals[p].twin == ENF_NONE && map->portals[p].transform == ENF_NONE) {
            return false; /* who came through could go back unheard of */
        }
    }
    return true;
}

bool enf_dbv_reach(EnfDbvIndex *index, EnfBox3f now, EnfDbvReach *reach) {
    const EnfMap *map = index->map;
    EnfBox3 box = enf_box3_from_f(now);
    uint32_t cells[ENF_DBV_LINKS];
    uint32_t touched = enf_dbv_cells_of(index, now, cells);
    Pending pending;
    pending.count = 0;
    reach->count = 0;
    reach->limit = HUGE_VAL;
    if (touched == 0 || touched == ENF_NONE) {
        return false;
    }
    for (uint32_t i = 0; i < touched; i++) {
        bool outside = (map->cells[cells[i]].flags & ENF_CELL_OUTSIDE) != 0;
        if (outside || enf_dbv_cell_is_seen(index, cells[i]) || !add_cell(index, reach, &box, cells[i], 0.0, &pending)) {
            return false;
        }
    }
    const EnfPortal *portal = NULL;
    double d = 0.0;
    while (take_nearest(map, reach, &pending, &portal, &d)) {
        bool ends = portal->transform != ENF_NONE || reach->count == ENF_DBV_LINKS ||
                    enf_dbv_cell_is_seen(index, portal->target) || (map->cells[portal->target].flags & ENF_CELL_OUTSIDE) != 0;
        if (ends || !add_cell(index, reach, &box, portal->target, d, &pending)) {
            reach->limit = sqrt(d);
            return d > 0.0;
        }
    }
    return true; /* shut in */
}

/* All of an object's box, while it touches a cell, lies no farther from that cell than the box is long. */
static EnfBox3f part(EnfBox3 volume, const EnfBox3 *cell, double size) {
    EnfBox3 out = {enf_v3(fmax(volume.min.x, cell->min.x - size), fmax(volume.min.y, cell->min.y - size),
                          fmax(volume.min.z, cell->min.z - size)),
                   enf_v3(fmin(volume.max.x, cell->max.x + size), fmin(volume.max.y, cell->max.y + size),
                          fmin(volume.max.z, cell->max.z + size))};
    return enf_box3f_outward(out);
}

void enf_dbv_hang_reach(EnfDbvIndex *index, uint32_t object, EnfBox3f volume, EnfBox3f now, const EnfDbvReach *reach) {
    EnfBox3 here = enf_box3_from_f(now);
    EnfBox3 whole = enf_box3_from_f(volume);
    /* However it turns, no side of its box is longer than the diagonal of its box now, which holds two opposite corners. */
    double size = enf_length(enf_sub(here.max, here.min)) + 2.0 * ENF_GRID_STEP;
    if (enf_world_has_trail(index->world)) { /* a box of two ticks is longer by a tick's way */
        size += 1.001 * enf_world_max_speed(index->world, object) / ENF_TICK_RATE;
    }
    for (uint32_t i = 0; i < reach->count; i++) {
        EnfBox3f box = part(whole, &index->places.boxes[index->places.cells_first + reach->cells[i]], size);
        bool near = box.min.x <= box.max.x && box.min.y <= box.max.y && box.min.z <= box.max.z;
        if (near && enf_world_touches(index->map, reach->cells[i], box)) {
            enf_dbv_link_to(index, object, index->places.walks_first + reach->cells[i], box);
        }
    }
}
