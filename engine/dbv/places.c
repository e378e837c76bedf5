/* Where volumes hang: the tree over cells, the cells, and the kd-tree of a cell. A volume hangs on the deepest places that cover it,
 * no more than ENF_DBV_LINKS, so a far and long-lived one hangs high and is met only when something near is seen. A changed one
 * climbs from its old place to the least common ancestor of both (Sudarsky & Gotsman 1996, update B).
 *
 * What makes it exact: a cell's list, the lists of its ancestors, and (for volumes wholly within a kd node's box) the node's list
 * are all that enf_dbv_see looks at when the cell is seen; and a place is left out of a cover only if the volume does not touch
 * its box. Boxes of cells may overlap (a tree by objects, not by planes), so a climb ends only at a place whose box holds the
 * volume and which no cell from elsewhere reaches into: `shared` marks the others. */
#include "dbv/dbv_internal.h"

#include <enfilade/tolerances.h>

#include <math.h>
#include <string.h>

/* A node whose longest side is at most so many times that of a volume is not split for it. */
#define SNUG 0.9

/* ---- boxes of places -------------------------------------------------------------------------------------------- */

/* As enf_world_touches has it: an overlap of more than a grid step. */
static bool touches(const EnfBox3 *place, const EnfBox3 *box) {
    const double step = ENF_GRID_STEP;
    return box->max.x > place->min.x + step && box->min.x < place->max.x - step && box->max.y > place->min.y + step &&
           box->min.y < place->max.y - step && box->max.z > place->min.z + step && box->min.z < place->max.z - step;
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

/* Of a node of the cells' tree or a cell. */
static const EnfBox3 *place_box(const EnfDbvPlaces *places, uint32_t place) {
    return &places->boxes[place];
}

static void make_boxes(EnfDbvPlaces *places) {
    const EnfMap *map = places->map;
    for (uint32_t n = 0; n < places->cells_first; n++) {
        places->boxes[n] = node_box(&map->cell_nodes[n], map->tree_origin);
    }
    for (uint32_t c = 0; c < map->cells_count; c++) {
        places->boxes[places->cells_first + c] = cell_box(map, c);
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

/* Does a cell that is not under `place` reach into its box? The items of the cells' tree that overlap, against those under it. */
static bool reached_into(const EnfDbvPlaces *places, uint32_t place) {
    const EnfMap *map = places->map;
    EnfBox3 box = *place_box(places, place);
    uint32_t stack[ENF_KD_MAX_DEPTH + 1];
    uint32_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        uint32_t at = stack[--depth];
        const EnfKdNode *node = &map->cell_nodes[at];
        if (at == place || !touches(place_box(places, at), &box)) {
            continue;
        }
        if (node->block_count == 0) {
            stack[depth++] = node->link;
            stack[depth++] = at + 1;
            continue;
        }
        for (uint32_t i = 0; i < node->block_count * ENF_KD_BLOCK; i++) {
            uint32_t cell = map->cell_blocks[node->link + i / ENF_KD_BLOCK].item[i % ENF_KD_BLOCK];
            bool other = cell != ENF_NONE && places->cells_first + cell != place;
            if (other && touches(place_box(places, places->cells_first + cell), &box)) {
                return true;
            }
        }
    }
    return false;
}

static void mark_shared(EnfDbvPlaces *places) {
    const EnfMap *map = places->map;
    uint32_t last = map->cells_count - 1;
    bool outside = map->cells_count > 0 && (map->cells[last].flags & ENF_CELL_OUTSIDE) != 0;
    EnfBox3 beyond = outside ? cell_box(map, last) : enf_box3_empty();
    for (uint32_t place = 0; place < places->nodes_first && map->cell_nodes_count > 0; place++) {
        const EnfBox3 *box = place_box(places, place);
        places->shared[place] = reached_into(places, place) || (outside && touches(&beyond, box));
    }
}

EnfResult enf_dbv_places_create(EnfDbvPlaces *places, const EnfMap *map, const EnfAllocator *allocator, EnfError *error) {
    places->map = map;
    places->cells_first = map->cell_nodes_count;
    places->nodes_first = places->cells_first + map->cells_count;
    places->count = places->nodes_first + map->kd_nodes_count;
    size_t count = (size_t)places->count + 1;
    places->parents = enf_alloc(allocator, count, sizeof *places->parents);
    places->heads = enf_alloc(allocator, count, sizeof *places->heads);
    places->below = enf_alloc(allocator, count, sizeof *places->below);
    places->hot_frame = enf_alloc(allocator, count, sizeof *places->hot_frame);
    places->shared = enf_alloc(allocator, count, sizeof *places->shared);
    places->boxes = enf_alloc(allocator, (size_t)places->nodes_first + 1, sizeof *places->boxes);
    if (!places->boxes || !places->parents || !places->heads || !places->below || !places->hot_frame || !places->shared) {
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
    }
    make_boxes(places);
    mark_shared(places);
    return ENF_OK;
}

void enf_dbv_places_destroy(EnfDbvPlaces *places, const EnfAllocator *allocator) {
    size_t count = (size_t)places->count + 1;
    enf_free(allocator, places->parents, count, sizeof *places->parents);
    enf_free(allocator, places->heads, count, sizeof *places->heads);
    enf_free(allocator, places->below, count, sizeof *places->below);
    enf_free(allocator, places->hot_frame, count, sizeof *places->hot_frame);
    enf_free(allocator, places->shared, count, sizeof *places->shared);
    enf_free(allocator, places->boxes, (size_t)places->nodes_first + 1, sizeof *places->boxes);
}

/* ---- links ------------------------------------------------------------------------------------------------------ */

/* Counts an entry within a cell's tree in or out, from its node up. */
static void count_below(EnfDbvPlaces *places, uint32_t place, bool in) {
    for (; place != ENF_NONE && place >= places->nodes_first; place = places->parents[place]) {
        places->below[place] += in ? 1U : UINT32_MAX;
    }
}

void enf_dbv_link_to(EnfDbvIndex *index, uint32_t object, uint32_t place, EnfBox3f box) {
    if (enf_dbv_link(index, object, place, box)) {
        count_below(&index->places, place, true);
    } else {
        index->failed = true;
        index->first = true;
    }
}

void enf_dbv_unhang(EnfDbvIndex *index, uint32_t object) {
    EnfDbvVolume *volume = &index->volumes[object];
    while (volume->link_count > 0) {
        uint32_t place = enf_dbv_unlink(index, volume->links[--volume->link_count]);
        count_below(&index->places, place, false);
    }
}

uint32_t enf_dbv_place_of(const EnfDbvIndex *index, uint32_t object) {
    const EnfDbvVolume *volume = &index->volumes[object];
    return volume->link_count == 0 ? ENF_NONE : enf_dbv_block(&index->pool, volume->links[0] / ENF_KD_BLOCK)->place;
}

/* ---- steps down ----------------------------------------------------------------------------------------------- */

static bool is_seen(const EnfDbvIndex *index, uint32_t place) {
    return index->hot_frame != 0 && index->places.hot_frame[place] == index->hot_frame;
}

/* The places one step down from a node of the cells' tree that `box` touches, into out[0..capacity); their number, or ENF_NONE if
 * there are more. */
static uint32_t children(EnfDbvIndex *index, uint32_t place, const EnfBox3 *box, uint32_t *out, uint32_t capacity) {
    const EnfMap *map = index->map;
    const EnfKdNode *node = &map->cell_nodes[place];
    uint32_t count = 0;
    if (node->block_count == 0) {
        const uint32_t pair[2] = {place + 1, node->link};
        for (uint32_t i = 0; i < 2; i++) {
            index->counters.nodes++;
            if (touches(place_box(&index->places, pair[i]), box)) {
                if (count == capacity) {
                    return ENF_NONE;
                }
                out[count++] = pair[i];
            }
        }
        return count;
    }
    for (uint32_t i = 0; i < node->block_count * ENF_KD_BLOCK; i++) {
        uint32_t cell = map->cell_blocks[node->link + i / ENF_KD_BLOCK].item[i % ENF_KD_BLOCK];
        if (cell == ENF_NONE) {
            continue;
        }
        index->counters.nodes++;
        if (touches(place_box(&index->places, index->places.cells_first + cell), box)) {
            if (count == capacity) {
                return ENF_NONE;
            }
            out[count++] = index->places.cells_first + cell;
        }
    }
    return count;
}

/* ---- covers ----------------------------------------------------------------------------------------------------- */

typedef struct Cover {
    uint32_t places[ENF_DBV_LINKS], count;
    bool final[ENF_DBV_LINKS]; /* cannot be split within the limit */
} Cover;

/* Splits the i-th place of a cover into the children that the box touches. False if they do not fit. */
static bool split(EnfDbvIndex *index, Cover *cover, uint32_t i, const EnfBox3 *box) {
    uint32_t parts[ENF_DBV_LINKS];
    uint32_t room = ENF_DBV_LINKS - cover->count + 1;
    uint32_t count = children(index, cover->places[i], box, parts, room);
    if (count == ENF_NONE) {
        return false;
    }
    cover->count--;
    cover->places[i] = cover->places[cover->count];
    cover->final[i] = cover->final[cover->count];
    for (uint32_t k = 0; k < count; k++) {
        cover->places[cover->count] = parts[k];
        cover->final[cover->count] = parts[k] >= index->places.cells_first;
        cover->count++;
    }
    return true;
}

/* Would the parts of a node hardly cover a volume tighter, or cost more than they spare? What hangs on fewer places costs less to
 * keep and to move; but nothing that can sleep hangs above a seen cell. */
static bool enough(const EnfDbvIndex *index, uint32_t place, const EnfBox3 *box) {
    if (is_seen(index, place)) {
        return false;
    }
    const EnfBox3 *node = place_box(&index->places, place);
    EnfVec3 a = enf_sub(node->max, node->min);
    EnfVec3 b = enf_sub(box->max, box->min);
    return larger(larger(a.x, a.y), a.z) <= SNUG * larger(larger(b.x, b.y), b.z);
}

/* The place to split next: a seen one first, so that sleepers keep off it; else the coarsest (the lowest number of a tree in
 * depth-first order is not deeper than what follows it in its branch). ENF_NONE: the cover is done. */
static uint32_t next_split(const EnfDbvIndex *index, const Cover *cover) {
    uint32_t best = ENF_NONE;
    for (uint32_t i = 0; i < cover->count; i++) {
        if (cover->final[i]) {
            continue;
        }
        bool better = best == ENF_NONE;
        if (!better) {
            bool seen = is_seen(index, cover->places[i]);
            bool best_seen = is_seen(index, cover->places[best]);
            better = seen != best_seen ? seen : cover->places[i] < cover->places[best];
        }
        best = better ? i : best;
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

static bool holds(const EnfBox3 *outer, const EnfBox3 *inner) {
    double m = margin(inner);
    return outer->min.x + m <= inner->min.x && outer->min.y + m <= inner->min.y && outer->min.z + m <= inner->min.z &&
           outer->max.x - m >= inner->max.x && outer->max.y - m >= inner->max.y && outer->max.z - m >= inner->max.z;
}

/* Down a cell's kd-tree while one child holds the whole volume: what is outside that child's box needs no look at it. */
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

/* The cell of a place within a cell, or the place itself. */
static uint32_t cell_place(const EnfDbvPlaces *places, uint32_t place) {
    while (place >= places->nodes_first) {
        place = places->parents[place];
    }
    return place;
}

/* The lowest place at or above `from` that holds the whole box alone; ENF_NONE if even the root does not. */
static uint32_t climb(EnfDbvIndex *index, uint32_t from, const EnfBox3 *box) {
    const EnfDbvPlaces *places = &index->places;
    for (uint32_t place = from; place != ENF_NONE; place = places->parents[place]) {
        uint32_t outer = cell_place(places, place);
        bool within = outer != place;
        EnfBox3 here = within ? node_box(&places->map->kd_nodes[place - places->nodes_first],
                                         places->map->cells[outer - places->cells_first].origin)
                              : *place_box(places, place);
        index->counters.nodes++;
        if (holds(&here, box) && !places->shared[outer]) {
            return place;
        }
    }
    return ENF_NONE;
}

/* What lies in no room is under no node of the tree: its cell is asked apart. */
static void cover_outside(EnfDbvIndex *index, uint32_t object, EnfBox3f volume) {
    const EnfMap *map = index->map;
    uint32_t last = map->cells_count - 1;
    bool outside = map->cells_count > 0 && (map->cells[last].flags & ENF_CELL_OUTSIDE) != 0;
    EnfBox3 box = enf_box3_from_f(volume);
    if (outside && touches(place_box(&index->places, index->places.cells_first + last), &box)) {
        enf_dbv_link_to(index, object, index->places.cells_first + last, volume);
    }
}

bool enf_dbv_hang(EnfDbvIndex *index, uint32_t object, EnfBox3f volume, uint32_t from) {
    const EnfDbvPlaces *places = &index->places;
    EnfBox3 box = enf_box3_from_f(volume);
    Cover cover = {{0}, 0, {false}};
    uint32_t start = from == ENF_NONE ? ENF_NONE : climb(index, from, &box);
    bool root_touched = index->map->cell_nodes_count > 0 && touches(place_box(places, 0), &box);
    if (start != ENF_NONE || root_touched) {
        cover.places[0] = start != ENF_NONE ? start : 0;
        cover.final[0] = cover.places[0] >= places->cells_first;
        cover.count = 1;
    }
    cover_outside(index, object, volume);
    /* One link may be gone to the OUTSIDE cell: the cover has the rest. */
    uint32_t limit = ENF_DBV_LINKS - index->volumes[object].link_count;
    for (uint32_t i = next_split(index, &cover); i != ENF_NONE; i = next_split(index, &cover)) {
        Cover before = cover;
        if (enough(index, cover.places[i], &box) || !split(index, &cover, i, &box) || cover.count > limit) {
            cover = before;
            cover.final[i] = true;
        }
    }
    bool seen = false;
    for (uint32_t i = 0; i < cover.count; i++) {
        uint32_t place = cover.places[i];
        uint32_t outer = cell_place(places, place);
        seen = seen || is_seen(index, outer);
        if (outer >= places->cells_first) {
            place = descend(index, outer - places->cells_first, place, &box);
        }
        enf_dbv_link_to(index, object, place, volume);
    }
    return seen;
}

/* ---- seen cells ------------------------------------------------------------------------------------------------- */

bool enf_dbv_cell_is_seen(const EnfDbvIndex *index, uint32_t cell) {
    return is_seen(index, index->places.cells_first + cell);
}

/* Splits down to cells alone. False if they are too many. */
static bool split_to_cells(EnfDbvIndex *index, const EnfBox3 *box, Cover *cover) {
    cover->places[0] = 0;
    cover->count = index->map->cell_nodes_count > 0 ? 1U : 0U;
    for (uint32_t i = 0; i < cover->count; i++) {
        while (i < cover->count && cover->places[i] < index->places.cells_first) {
            if (!split(index, cover, i, box)) {
                return false;
            }
        }
    }
    return true;
}

bool enf_dbv_in_few_cells(EnfDbvIndex *index, EnfBox3f volume) {
    EnfBox3 box = enf_box3_from_f(volume);
    Cover cover = {{0}, 0, {false}};
    return split_to_cells(index, &box, &cover);
}

uint32_t enf_dbv_cells_of(EnfDbvIndex *index, EnfBox3f volume, uint32_t cells[ENF_DBV_LINKS]) {
    EnfBox3 box = enf_box3_from_f(volume);
    Cover cover = {{0}, 0, {false}};
    if (!split_to_cells(index, &box, &cover)) {
        return 0;
    }
    for (uint32_t i = 0; i < cover.count; i++) {
        cells[i] = cover.places[i] - index->places.cells_first;
    }
    return cover.count;
}

/* The squared distance between two boxes; below 0 where they touch as enf_world_touches has it. */
static double gap(const EnfBox3 *place, const EnfBox3 *box) {
    if (touches(place, box)) {
        return -1.0;
    }
    double x = larger(larger(place->min.x - box->max.x, box->min.x - place->max.x), 0.0);
    double y = larger(larger(place->min.y - box->max.y, box->min.y - place->max.y), 0.0);
    double z = larger(larger(place->min.z - box->max.z, box->min.z - place->max.z), 0.0);
    return x * x + y * y + z * z;
}

/* Only places that were seen are looked at, nearest branches first: a handful of steps. */
double enf_dbv_distance_to_seen(EnfDbvIndex *index, EnfBox3f volume) {
    const EnfMap *map = index->map;
    EnfBox3 box = enf_box3_from_f(volume);
    double nearest = HUGE_VAL;
    uint32_t stack[ENF_KD_MAX_DEPTH + 1];
    uint32_t depth = 0;
    if (map->cell_nodes_count > 0 && is_seen(index, 0)) {
        stack[depth++] = 0;
    }
    while (depth > 0 && nearest >= 0.0) {
        uint32_t at = stack[--depth];
        const EnfKdNode *node = &map->cell_nodes[at];
        if (gap(place_box(&index->places, at), &box) >= nearest) {
            continue;
        }
        if (node->block_count == 0) {
            const uint32_t pair[2] = {at + 1, node->link};
            for (uint32_t i = 0; i < 2; i++) {
                if (is_seen(index, pair[i])) {
                    stack[depth++] = pair[i];
                }
            }
            continue;
        }
        for (uint32_t i = 0; i < node->block_count * ENF_KD_BLOCK; i++) {
            uint32_t cell = map->cell_blocks[node->link + i / ENF_KD_BLOCK].item[i % ENF_KD_BLOCK];
            if (cell != ENF_NONE && is_seen(index, index->places.cells_first + cell)) {
                double here = gap(place_box(&index->places, index->places.cells_first + cell), &box);
                nearest = here < nearest ? here : nearest;
            }
        }
    }
    return nearest > 0.0 ? sqrt(nearest) : nearest;
}
