/* Where volumes hang: the tree over cells, the cells, and the kd-tree of a cell. A volume hangs on one place: the lowest that the
 * middle of its box lies in and that is not much smaller than it; within a cell, on the deepest kd node that holds all of it.
 * Nothing is cut to the place: each place knows a box about all that hangs there, and about all at and beneath it, so that a
 * volume may reach out of its place (a loose tree: Ulrich 2000; boxes fitted from below as in any tree of boxes). A changed
 * volume climbs from its old place to the least common ancestor of both (Sudarsky & Gotsman 1996, update B).
 *
 * What makes it exact: enf_dbv_see goes down from the root into every place whose box touches the seen cell, and these boxes
 * hold what hangs there: they grow at once when something is hung, and shrink only when a look finds that nothing is left. */
#include "dbv/dbv_internal.h"

#include <enfilade/tolerances.h>

#include <math.h>
#include <string.h>

/* A volume hangs on no place whose longest side is smaller than its own by more than this: else one that is larger than the
 * building would hang in some room, and be met one by one. */
#define LOOSE 16.0

/* ---- boxes of places -------------------------------------------------------------------------------------------- */

EnfBox3f enf_dbv_limits(const EnfBox3 *place) {
    EnfVec3 step = enf_v3(ENF_GRID_STEP, ENF_GRID_STEP, ENF_GRID_STEP);
    EnfBox3 inner = {enf_add(place->min, step), enf_sub(place->max, step)};
    return enf_box3f_outward(inner);
}

/* fmax is a call, for the sake of what is not a number. */
static inline double larger(double a, double b) {
    return a > b ? a : b;
}

static EnfBox3 node_box(const EnfKdNode *node, const double origin[3]) {
    EnfBox3 box = {{(double)node->min[0] + origin[0], (double)node->min[1] + origin[1], (double)node->min[2] + origin[2]},
                   {(double)node->max[0] + origin[0], (double)node->max[1] + origin[1], (double)node->max[2] + origin[2]}};
    return box;
}

static EnfBox3 cell_box(const EnfMap *map, uint32_t cell) {
    const EnfCell *c = &map->cells[cell];
    EnfBox3 box = {{(double)c->min[0] + c->origin[0], (double)c->min[1] + c->origin[1], (double)c->min[2] + c->origin[2]},
                   {(double)c->max[0] + c->origin[0], (double)c->max[1] + c->origin[1], (double)c->max[2] + c->origin[2]}};
    return box;
}

static void make_boxes(EnfDbvPlaces *places) {
    const EnfMap *map = places->map;
    for (uint32_t n = 0; n < places->cells_first; n++) {
        places->boxes[n] = node_box(&map->cell_nodes[n], map->tree_origin);
    }
    for (uint32_t c = 0; c < map->cells_count; c++) {
        places->boxes[places->cells_first + c] = cell_box(map, c);
    }
    for (uint32_t place = 0; place < places->nodes_first; place++) {
        places->limits[place] = enf_dbv_limits(&places->boxes[place]);
    }
}

/* ---- the table of places ---------------------------------------------------------------------------------------- */

/* Parents of the nodes of one tree whose place numbers begin at `first`; its root's parent is `top`. Leaves give `leaf_of` for
 * each item, if wanted. */
static void tree_parents(const EnfKdTree *tree, uint32_t first, uint32_t top, uint32_t *parents, uint32_t *item_parents) {
    if (tree->node_count > 0) {
        parents[first] = top;
    }
    for (uint32_t n = 0; n < tree->node_count; n++) {
        const EnfKdNode *node = &tree->nodes[n];
        if (node->block_count == 0) {
            parents[first + n + 1] = first + n;
            parents[first + node->link] = first + n;
            continue;
        }
        for (uint32_t i = 0; i < node->block_count * ENF_KD_BLOCK && item_parents != NULL; i++) {
            uint32_t item = tree->blocks[node->link + i / ENF_KD_BLOCK].item[i % ENF_KD_BLOCK];
            if (item != ENF_NONE) {
                item_parents[item] = first + n;
            }
        }
    }
}

static EnfKdTree cells_tree(const EnfMap *map) {
    EnfKdTree tree = {map->cell_nodes, map->cell_blocks, map->cell_nodes_count, map->cell_blocks_count};
    return tree;
}

EnfResult enf_dbv_places_create(EnfDbvPlaces *places, const EnfMap *map, const EnfAllocator *allocator, EnfError *error) {
    places->map = map;
    places->cells_first = map->cell_nodes_count;
    places->nodes_first = places->cells_first + map->cells_count;
    places->walks_first = places->nodes_first + map->kd_nodes_count;
    places->count = places->walks_first + map->cells_count;
    size_t count = (size_t)places->count + 1;
    size_t outer = (size_t)places->nodes_first + 1;
    places->parents = enf_alloc(allocator, count, sizeof *places->parents);
    places->heads = enf_alloc(allocator, count, sizeof *places->heads);
    places->below = enf_alloc(allocator, count, sizeof *places->below);
    places->owners = enf_alloc(allocator, (size_t)map->kd_nodes_count + 1, sizeof *places->owners);
    places->hot_frame = enf_alloc(allocator, outer, sizeof *places->hot_frame);
    places->boxes = enf_alloc(allocator, outer, sizeof *places->boxes);
    places->limits = enf_alloc(allocator, outer, sizeof *places->limits);
    places->fits = enf_alloc(allocator, outer, sizeof *places->fits);
    bool ok = places->boxes && places->parents && places->heads && places->below && places->owners && places->hot_frame;
    if (!ok || !places->limits || !places->fits) {
        enf_dbv_places_destroy(places, allocator);
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "%u places of volumes", places->count);
    }
    memset(places->parents, 0xff, count * sizeof *places->parents);
    memset(places->heads, 0xff, count * sizeof *places->heads);
    EnfKdTree tree = cells_tree(map);
    tree_parents(&tree, 0, ENF_NONE, places->parents, places->parents + places->cells_first);
    for (uint32_t cell = 0; cell < map->cells_count; cell++) {
        EnfKdTree own = enf_map_cell_tree(map, cell);
        tree_parents(&own, places->nodes_first + map->cells[cell].node_first, places->cells_first + cell, places->parents,
                     NULL);
        for (uint32_t n = 0; n < own.node_count; n++) {
            places->owners[map->cells[cell].node_first + n] = places->cells_first + cell;
        }
    }
    make_boxes(places);
    enf_dbv_fits_clear(places);
    return ENF_OK;
}

void enf_dbv_places_destroy(EnfDbvPlaces *places, const EnfAllocator *allocator) {
    size_t count = (size_t)places->count + 1;
    size_t outer = (size_t)places->nodes_first + 1;
    enf_free(allocator, places->parents, count, sizeof *places->parents);
    enf_free(allocator, places->heads, count, sizeof *places->heads);
    enf_free(allocator, places->below, count, sizeof *places->below);
    enf_free(allocator, places->owners, (size_t)places->walks_first - places->nodes_first + 1, sizeof *places->owners);
    enf_free(allocator, places->hot_frame, outer, sizeof *places->hot_frame);
    enf_free(allocator, places->boxes, outer, sizeof *places->boxes);
    enf_free(allocator, places->limits, outer, sizeof *places->limits);
    enf_free(allocator, places->fits, outer, sizeof *places->fits);
}

size_t enf_dbv_places_bytes(const EnfDbvPlaces *places) {
    size_t outer = sizeof *places->hot_frame + sizeof *places->boxes + sizeof *places->limits + sizeof *places->fits;
    size_t kd = (size_t)places->walks_first - places->nodes_first + 1;
    return ((size_t)places->count + 1) * 3 * sizeof(uint32_t) + kd * sizeof *places->owners +
           ((size_t)places->nodes_first + 1) * outer;
}

/* ---- links ------------------------------------------------------------------------------------------------------ */

/* An entry moves within or between trees of cells: counts it out of one node and those above, and into another. What is above both
 * keeps its count: a node's number is higher than its parent's, so the two ways up meet. ENF_NONE, or no kd node: counts only
 * the other. */
static void count_move(EnfDbvPlaces *places, uint32_t from, uint32_t to) {
    from = from < places->walks_first ? from : 0;
    to = to < places->walks_first ? to : 0;
    while (from != to && (from >= places->nodes_first || to >= places->nodes_first)) {
        if (from > to) {
            places->below[from]--;
            from = places->parents[from];
        } else {
            places->below[to]++;
            to = places->parents[to];
        }
    }
}

/* Counts nothing. */
static void link_uncounted(EnfDbvIndex *index, uint32_t object, uint32_t place, EnfBox3f box) {
    if (enf_dbv_link(index, object, place, box)) {
        enf_dbv_grow(&index->places, place, box);
    } else {
        index->failed = true;
        index->first = true;
    }
}

void enf_dbv_link_to(EnfDbvIndex *index, uint32_t object, uint32_t place, EnfBox3f box) {
    uint32_t before = index->volumes[object].link_count;
    link_uncounted(index, object, place, box);
    if (index->volumes[object].link_count > before) {
        count_move(&index->places, ENF_NONE, place);
    }
}

void enf_dbv_unhang(EnfDbvIndex *index, uint32_t object) {
    EnfDbvVolume *volume = &index->volumes[object];
    while (volume->link_count > 0) {
        uint32_t place = enf_dbv_unlink(index, volume->links[--volume->link_count]);
        count_move(&index->places, place, ENF_NONE);
        if (place < index->places.nodes_first) {
            index->places.fits[place].loose = true;
        }
    }
}

/* The place of an object's first link; ENF_NONE if it has none. */
static uint32_t linked_place(const EnfDbvIndex *index, uint32_t object) {
    const EnfDbvVolume *volume = &index->volumes[object];
    return volume->link_count == 0 ? ENF_NONE : enf_dbv_block(&index->pool, volume->links[0] / ENF_KD_BLOCK)->place;
}

/* ---- the place of a volume -------------------------------------------------------------------------------------- */

/* What decides where a volume hangs. */
typedef struct Middle {
    EnfVec3 at;
    double size; /* the longest side, by LOOSE smaller: no place is smaller */
} Middle;

static Middle middle_of(const EnfBox3 *box) {
    EnfVec3 side = enf_sub(box->max, box->min);
    Middle middle = {enf_scale(enf_add(box->min, box->max), 0.5), larger(larger(side.x, side.y), side.z) / LOOSE};
    return middle;
}

static bool is_large_enough(const EnfBox3 *place, const Middle *middle) {
    EnfVec3 side = enf_sub(place->max, place->min);
    return larger(larger(side.x, side.y), side.z) >= middle->size;
}

/* The squared distance of a point from a box. */
static double strays(const EnfBox3 *box, EnfVec3 p) {
    double x = larger(larger(box->min.x - p.x, p.x - box->max.x), 0.0);
    double y = larger(larger(box->min.y - p.y, p.y - box->max.y), 0.0);
    double z = larger(larger(box->min.z - p.z, p.z - box->max.z), 0.0);
    return x * x + y * y + z * z;
}

/* The child of a node of the cells' tree that the middle lies in or nearest to, if it is large enough; else ENF_NONE. */
static uint32_t step_down(EnfDbvIndex *index, uint32_t place, const Middle *middle) {
    const EnfDbvPlaces *places = &index->places;
    const EnfKdNode *node = &places->map->cell_nodes[place];
    uint32_t best = ENF_NONE;
    double nearest = HUGE_VAL;
    uint32_t count = node->block_count == 0 ? 2 : node->block_count * ENF_KD_BLOCK;
    for (uint32_t i = 0; i < count && nearest > 0.0; i++) {
        uint32_t child = i == 0 ? place + 1 : node->link;
        if (node->block_count > 0) {
            uint32_t cell = places->map->cell_blocks[node->link + i / ENF_KD_BLOCK].item[i % ENF_KD_BLOCK];
            if (cell == ENF_NONE) {
                continue;
            }
            child = places->cells_first + cell;
        }
        index->counters.nodes++;
        double far = strays(&places->boxes[child], middle->at);
        if (far < nearest && is_large_enough(&places->boxes[child], middle)) {
            nearest = far;
            best = child;
        }
    }
    return best;
}

/* Room between a volume and the box of a place that holds it alone: a grid step, and above the rounding to float of a box relative
 * to a cell, so that whatever passes a window there, the place passes too. */
static double margin(const EnfBox3 *box) {
    double size = larger(larger(fabs(box->min.x), fabs(box->max.x)), larger(fabs(box->min.y), fabs(box->max.y)));
    size = larger(size, larger(fabs(box->min.z), fabs(box->max.z)));
    return ENF_GRID_STEP + size * 0x1p-21;
}

static EnfBox3 with_margin(const EnfBox3 *box) {
    double m = margin(box);
    EnfVec3 room = enf_v3(m, m, m);
    EnfBox3 out = {enf_sub(box->min, room), enf_add(box->max, room)};
    return out;
}

static bool holds(const EnfBox3 *outer, const EnfBox3 *inner) {
    return outer->min.x <= inner->min.x && outer->min.y <= inner->min.y && outer->min.z <= inner->min.z &&
           outer->max.x >= inner->max.x && outer->max.y >= inner->max.y && outer->max.z >= inner->max.z;
}

/* Down a cell's kd-tree while one child holds the whole volume (with its margin): what is outside that child's box needs no look at it. */
static uint32_t descend(EnfDbvIndex *index, uint32_t cell, uint32_t from, const EnfBox3 *box) {
    const EnfMap *map = index->map;
    const EnfCell *c = &map->cells[cell];
    uint32_t first = index->places.nodes_first + c->node_first;
    uint32_t place = from;
    uint32_t node = from >= index->places.nodes_first ? from - first : ENF_NONE;
    for (;;) {
        uint32_t pair[2] = {0, ENF_NONE};
        if (node != ENF_NONE) {
            const EnfKdNode *n = &map->kd_nodes[c->node_first + node];
            if (n->block_count != 0) {
                return place;
            }
            pair[0] = node + 1;
            pair[1] = n->link;
        } else if (c->node_count == 0) {
            return place;
        }
        uint32_t next = ENF_NONE;
        for (uint32_t i = 0; i < 2 && next == ENF_NONE; i++) {
            if (pair[i] == ENF_NONE) {
                continue;
            }
            index->counters.nodes++;
            EnfBox3 child = node_box(&map->kd_nodes[c->node_first + pair[i]], c->origin);
            next = holds(&child, box) ? pair[i] : ENF_NONE;
        }
        if (next == ENF_NONE) {
            return place;
        }
        node = next;
        place = first + node;
    }
}

/* From a volume's old place up to the lowest that its middle lies in. */
static uint32_t climb(EnfDbvIndex *index, uint32_t from, const Middle *middle, const EnfBox3 *wide) {
    const EnfDbvPlaces *places = &index->places;
    const EnfMap *map = places->map;
    uint32_t place = from < places->walks_first ? from : enf_dbv_owner(places, from);
    uint32_t cell = enf_dbv_owner(places, place);
    for (; place >= places->nodes_first; place = places->parents[place]) {
        EnfBox3 here = node_box(&map->kd_nodes[place - places->nodes_first], map->cells[cell - places->cells_first].origin);
        index->counters.nodes++;
        if (holds(&here, wide)) {
            return place;
        }
    }
    for (; place != 0 && places->parents[place] != ENF_NONE; place = places->parents[place]) {
        index->counters.nodes++;
        if (is_large_enough(&places->boxes[place], middle) && !(strays(&places->boxes[place], middle->at) > 0.0)) {
            return place;
        }
    }
    return 0;
}

/* Where a volume that touches the root of the cells' tree hangs. */
static uint32_t find_place(EnfDbvIndex *index, const EnfBox3 *box, uint32_t from) {
    const EnfDbvPlaces *places = &index->places;
    Middle middle = middle_of(box);
    EnfBox3 wide = with_margin(box);
    uint32_t place = from == ENF_NONE ? 0 : climb(index, from, &middle, &wide);
    while (place < places->cells_first) {
        uint32_t next = step_down(index, place, &middle);
        if (next == ENF_NONE) {
            return place;
        }
        place = next;
    }
    uint32_t cell = enf_dbv_owner(places, place);
    return descend(index, cell - places->cells_first, place, &wide);
}

static void move_link(EnfDbvIndex *index, uint32_t object, uint32_t from, uint32_t to, EnfBox3f box) {
    EnfDbvVolume *volume = &index->volumes[object];
    volume->link_count = 0;
    (void)enf_dbv_unlink(index, volume->links[0]);
    if (from < index->places.nodes_first) {
        index->places.fits[from].loose = true;
    }
    link_uncounted(index, object, to, box);
    count_move(&index->places, from, volume->link_count > 0 ? to : ENF_NONE);
}

void enf_dbv_hang(EnfDbvIndex *index, uint32_t object, EnfBox3f volume) {
    const EnfDbvPlaces *places = &index->places;
    const EnfMap *map = index->map;
    EnfBox3 box = enf_box3_from_f(volume);
    uint32_t old = linked_place(index, object);
    uint32_t place = ENF_NONE;
    uint32_t last = map->cells_count - 1; /* what lies in no room is under no node of the tree: its cell is asked apart */
    if (map->cell_nodes_count > 0 && enf_dbv_touches(&places->limits[0], &volume)) {
        place = find_place(index, &box, index->def.update == ENF_DBV_LCA ? old : ENF_NONE);
    } else if (map->cells_count > 0 && (map->cells[last].flags & ENF_CELL_OUTSIDE) != 0 &&
               enf_dbv_touches(&places->limits[places->cells_first + last], &volume)) {
        place = places->cells_first + last;
    }
    if (place != ENF_NONE && place == old && index->volumes[object].link_count == 1) {
        enf_dbv_relink(index, object, volume);
        if (place < places->nodes_first) {
            places->fits[place].loose = true; /* the old one may have been larger */
        }
        enf_dbv_grow(&index->places, place, volume);
        return;
    }
    if (place != ENF_NONE && index->volumes[object].link_count == 1) {
        move_link(index, object, old, place, volume);
        return;
    }
    enf_dbv_unhang(index, object);
    if (place != ENF_NONE) {
        enf_dbv_link_to(index, object, place, volume);
    }
}
