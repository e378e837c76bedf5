/* From visits to the visible set: a kd query of each visited cell with its window's pyramid, each cluster once, in the canonical
 * order (space, cluster, visit). Cost follows what is found: no work a hidden cell or cluster. DESIGN §4. */
#include "vis/vis_internal.h"

#include <string.h>

static EnfVec3 cell_origin(const EnfMap *map, uint32_t cell) {
    const double *o = map->cells[cell].origin;
    return enf_v3(o[0], o[1], o[2]);
}

static EnfBox3f cell_bounds(const EnfMap *map, uint32_t cell) {
    const EnfCell *c = &map->cells[cell];
    EnfBox3f box = {{c->min[0], c->min[1], c->min[2]}, {c->max[0], c->max[1], c->max[2]}};
    return box;
}

static bool add_plain_visit(EnfVis *vis, uint32_t cell, uint32_t space, EnfWindow window) {
    EnfVisit visit = {cell, space, ENF_NONE, ENF_NONE, window, ENF_NONE};
    return enf_vis_add_visit(vis, visit) != ENF_NONE;
}

bool enf_vis_list_all(EnfVis *vis) {
    EnfWindow window = enf_window_full(&vis->cameras[0]);
    bool ok = true;
    for (uint32_t cell = 0; cell < vis->map->cells_count && ok; cell++) {
        ok = add_plain_visit(vis, cell, 0, window);
    }
    return ok;
}

/* The root box of the cells' tree, in its own space. */
static EnfBox3f tree_bounds(const EnfMap *map) {
    const EnfKdNode *root = map->cell_nodes;
    EnfBox3f box = {{root->min[0], root->min[1], root->min[2]}, {root->max[0], root->max[1], root->max[2]}};
    return box;
}

bool enf_vis_list_frustum(EnfVis *vis, uint32_t space, EnfWindow window) {
    const EnfMap *map = vis->map;
    bool ok = true;
    if (map->cell_nodes_count > 0) {
        EnfPyramid pyramid;
        EnfVec3 origin = enf_v3(map->tree_origin[0], map->tree_origin[1], map->tree_origin[2]);
        enf_pyramid(&vis->cameras[space], window, NULL, origin, tree_bounds(map), &pyramid);
        EnfKdTree tree = {map->cell_nodes, map->cell_blocks, map->cell_nodes_count, map->cell_blocks_count};
        EnfKdCounters counters = {0, 0, 0};
        uint32_t found = enf_kd_query(&tree, &pyramid, vis->items, vis->items_capacity, &counters);
        vis->set.counters.kd_nodes += counters.nodes;
        vis->set.counters.boxes += counters.boxes;
        for (uint32_t i = 0; i < found && ok; i++) {
            ok = add_plain_visit(vis, vis->items[i], space, window);
        }
    }
    /* What lies in no room is in no tree of cells. */
    uint32_t last = map->cells_count - 1U;
    if (map->cells_count > 0 && (map->cells[last].flags & ENF_CELL_OUTSIDE) != 0) {
        ok = ok && add_plain_visit(vis, last, space, window);
    }
    return ok;
}

static uint32_t whole_tree(EnfVis *vis, const EnfKdTree *tree) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < tree->block_count * ENF_KD_BLOCK; i++) {
        uint32_t item = tree->blocks[i / ENF_KD_BLOCK].item[i % ENF_KD_BLOCK];
        if (item != ENF_NONE) {
            vis->items[count++] = item;
        }
    }
    return count;
}

/* Clusters of one cell that its visit's window may show, into vis->items; and exposes the moving objects it shows. */
static uint32_t query_visit(EnfVis *vis, const EnfView *view, const EnfVisit *visit) {
    EnfKdTree tree = enf_map_cell_tree(vis->map, visit->cell);
    bool everything = view->cull == ENF_CULL_NONE;
    if (view->dbv == NULL && (everything || tree.node_count == 0)) {
        return whole_tree(vis, &tree);
    }
    EnfPyramid pyramid;
    const EnfWindowPolygon *polygon = visit->polygon == ENF_NONE ? NULL : &vis->polygons[visit->polygon];
    enf_pyramid(&vis->cameras[visit->space], visit->window, polygon, cell_origin(vis->map, visit->cell),
                cell_bounds(vis->map, visit->cell), &pyramid);
    if (view->dbv != NULL) {
        enf_dbv_see(view->dbv, visit->cell, &pyramid);
    }
    if (everything) {
        return whole_tree(vis, &tree);
    }
    EnfKdCounters counters = {0, 0, 0};
    uint32_t count = enf_kd_query(&tree, &pyramid, vis->items, vis->items_capacity, &counters);
    vis->set.counters.kd_nodes += counters.nodes;
    vis->set.counters.boxes += counters.boxes;
    return count;
}

static void append(EnfVis *vis, uint32_t cluster, uint32_t space, uint32_t visit) {
    EnfVisEntry entry = {cluster, space, visit};
    vis->entries[vis->entry_count++] = entry;
}

/* Marks the clusters of every visit in `space`, then lists them once each in ascending order. */
static bool collect_objects(EnfVis *vis, const EnfView *view, uint32_t space) {
    uint32_t found = 0;
    for (uint32_t v = 0; v < vis->visit_count; v++) {
        const EnfVisit *visit = &vis->visits[v];
        if (visit->space != space) {
            continue;
        }
        uint32_t count = query_visit(vis, view, visit);
        for (uint32_t i = 0; i < count; i++) {
            if (enf_bits_add(&vis->cluster_bits, vis->items[i])) {
                vis->cluster_visit[vis->items[i]] = v;
                found++;
            }
        }
    }
    if (!enf_vis_reserve_entries(vis, vis->entry_count + found)) {
        (void)enf_bits_drain(&vis->cluster_bits, NULL);
        return false;
    }
    /* The drained numbers land where the entries will be: read back to front, a number is never overwritten unread, since an
     * entry is three of them. */
    uint32_t *numbers = (uint32_t *)(void *)(vis->entries + vis->entry_count);
    (void)enf_bits_drain(&vis->cluster_bits, numbers);
    EnfVisEntry *entries = vis->entries + vis->entry_count;
    for (uint32_t i = found; i > 0; i--) {
        uint32_t cluster = numbers[i - 1U];
        EnfVisEntry entry = {cluster, space, vis->cluster_visit[cluster]};
        entries[i - 1U] = entry;
    }
    vis->entry_count += found;
    vis->set.counters.clusters += found;
    return true;
}

static bool entry_less(const EnfVisEntry *a, const EnfVisEntry *b) {
    if (a->space != b->space) {
        return a->space < b->space;
    }
    return a->cluster != b->cluster ? a->cluster < b->cluster : a->visit < b->visit;
}

/* Heapsort: in place, no recursion, n log n at worst. Keys are distinct, so the order is unique. */
static void sift(EnfVisEntry *entries, uint32_t root, uint32_t count) {
    EnfVisEntry moved = entries[root];
    for (uint32_t child = 2U * root + 1U; child < count; child = 2U * root + 1U) {
        if (child + 1U < count && entry_less(&entries[child], &entries[child + 1U])) {
            child++;
        }
        if (!entry_less(&moved, &entries[child])) {
            break;
        }
        entries[root] = entries[child];
        root = child;
    }
    entries[root] = moved;
}

static void sort_entries(EnfVisEntry *entries, uint32_t count) {
    for (uint32_t i = count / 2U; i > 0; i--) {
        sift(entries, i - 1U, count);
    }
    for (uint32_t end = count; end > 1; end--) {
        EnfVisEntry last = entries[end - 1U];
        entries[end - 1U] = entries[0];
        entries[0] = last;
        sift(entries, 0, end - 1U);
    }
}

/* One entry for each (cluster, visit). */
static bool collect_primitives(EnfVis *vis, const EnfView *view) {
    for (uint32_t v = 0; v < vis->visit_count; v++) {
        uint32_t count = query_visit(vis, view, &vis->visits[v]);
        if (!enf_vis_reserve_entries(vis, vis->entry_count + count)) {
            return false;
        }
        for (uint32_t i = 0; i < count; i++) {
            append(vis, vis->items[i], vis->visits[v].space, v);
        }
    }
    sort_entries(vis->entries, vis->entry_count);
    for (uint32_t i = 0; i < vis->entry_count; i++) {
        const EnfVisEntry *entry = &vis->entries[i];
        bool repeated = i > 0 && entry[-1].cluster == entry->cluster && entry[-1].space == entry->space;
        vis->set.counters.clusters += repeated ? 0U : 1U;
    }
    return true;
}

bool enf_vis_collect(EnfVis *vis, const EnfView *view) {
    bool ok = true;
    vis->entry_count = 0;
    if (view->grain == ENF_GRAIN_PRIMITIVES) {
        ok = collect_primitives(vis, view);
    } else {
        for (uint32_t space = 0; space < vis->space_count && ok; space++) {
            ok = collect_objects(vis, view, space);
        }
    }
    for (uint32_t v = 0; v < vis->visit_count; v++) {
        (void)enf_bits_add(&vis->cell_bits, vis->visits[v].cell);
    }
    vis->set.cell_count = enf_bits_drain(&vis->cell_bits, vis->cells);
    return ok;
}
