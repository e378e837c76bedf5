/* Memory of an EnfVis: sized for the map when made, grown when a frame needs more (several spaces, many sequences), never in a
 * warm frame. And the bit sets that put cells and clusters into canonical order without sorting. */
#include "vis/vis_internal.h"

#include <string.h>

/* Room for cells of the map seen once each, and some more. */
#define FIRST_EXTRA_VISITS 64U

static bool bits_create(EnfBits *bits, uint32_t members, const EnfAllocator *allocator) {
    bits->word_count = members / 64U + 1U;
    bits->summary_count = bits->word_count / 64U + 1U;
    bits->words = enf_alloc(allocator, bits->word_count, sizeof *bits->words);
    bits->summary = enf_alloc(allocator, bits->summary_count, sizeof *bits->summary);
    return bits->words != NULL && bits->summary != NULL;
}

static void bits_destroy(EnfBits *bits, const EnfAllocator *allocator) {
    enf_free(allocator, bits->words, bits->word_count, sizeof *bits->words);
    enf_free(allocator, bits->summary, bits->summary_count, sizeof *bits->summary);
}

bool enf_bits_add(EnfBits *bits, uint32_t member) {
    uint32_t word = member / 64U;
    uint64_t bit = UINT64_C(1) << (member % 64U);
    bool fresh = (bits->words[word] & bit) == 0;
    bits->words[word] |= bit;
    bits->summary[word / 64U] |= UINT64_C(1) << (word % 64U);
    return fresh;
}

/* Index of the lowest set bit; x != 0. */
static uint32_t lowest(uint64_t x) {
#if defined(__GNUC__)
    return (uint32_t)__builtin_ctzll(x);
#else
    uint32_t n = 0;
    while ((x >> n & 1U) == 0) {
        n++;
    }
    return n;
#endif
}

uint32_t enf_bits_drain(EnfBits *bits, uint32_t *out) {
    uint32_t count = 0;
    for (uint32_t s = 0; s < bits->summary_count; s++) {
        for (uint64_t pending = bits->summary[s]; pending != 0; pending &= pending - 1U) {
            uint32_t word = s * 64U + lowest(pending);
            for (uint64_t members = bits->words[word]; members != 0; members &= members - 1U) {
                if (out != NULL) {
                    out[count] = word * 64U + lowest(members);
                }
                count++;
            }
            bits->words[word] = 0;
        }
        bits->summary[s] = 0;
    }
    return count;
}

/* At least `count`, at least double. */
static uint32_t grown(uint32_t capacity, uint32_t count) {
    uint64_t next = (uint64_t)capacity * 2U;
    if (next < count) {
        next = count;
    }
    return next > UINT32_MAX - 1U ? UINT32_MAX - 1U : (uint32_t)next;
}

/* A larger copy of an array, or NULL; the old one stays. */
static void *enlarged(const EnfVis *vis, const void *array, uint32_t count, uint32_t capacity, size_t size) {
    void *block = enf_alloc(vis->allocator, capacity, size);
    if (block != NULL && count > 0) {
        memcpy(block, array, count * size);
    }
    return block;
}

bool enf_vis_reserve_visits(EnfVis *vis, uint32_t count) {
    if (count <= vis->visit_capacity) {
        return true;
    }
    uint32_t next = grown(vis->visit_capacity, count);
    EnfVisit *visits = enlarged(vis, vis->visits, vis->visit_count, next, sizeof *visits);
    EnfVisitLink *links = enlarged(vis, vis->links, vis->visit_count, next, sizeof *links);
    bool ok = visits != NULL && links != NULL;
    if (ok) {
        EnfVisit *old_visits = vis->visits;
        EnfVisitLink *old_links = vis->links;
        uint32_t old = vis->visit_capacity;
        vis->visits = visits;
        vis->links = links;
        vis->visit_capacity = next;
        visits = old_visits;
        links = old_links;
        next = old;
    }
    enf_free(vis->allocator, visits, next, sizeof *visits);
    enf_free(vis->allocator, links, next, sizeof *links);
    return ok;
}

bool enf_vis_reserve_polygons(EnfVis *vis, uint32_t count) {
    if (count <= vis->polygon_capacity) {
        return true;
    }
    uint32_t next = grown(vis->polygon_capacity, count);
    EnfWindowPolygon *polygons = enlarged(vis, vis->polygons, vis->polygon_count, next, sizeof *polygons);
    if (polygons == NULL) {
        return false;
    }
    enf_free(vis->allocator, vis->polygons, vis->polygon_capacity, sizeof *polygons);
    vis->polygons = polygons;
    vis->polygon_capacity = next;
    return true;
}

bool enf_vis_reserve_entries(EnfVis *vis, uint32_t count) {
    if (count <= vis->entry_capacity) {
        return true;
    }
    uint32_t next = grown(vis->entry_capacity, count);
    EnfVisEntry *entries = enlarged(vis, vis->entries, vis->entry_count, next, sizeof *entries);
    if (entries == NULL) {
        return false;
    }
    enf_free(vis->allocator, vis->entries, vis->entry_capacity, sizeof *entries);
    vis->entries = entries;
    vis->entry_capacity = next;
    return true;
}

uint32_t enf_vis_add_visit(EnfVis *vis, EnfVisit visit) {
    if (!enf_vis_reserve_visits(vis, vis->visit_count + 1U)) {
        return ENF_NONE;
    }
    uint32_t index = vis->visit_count++;
    vis->visits[index] = visit;
    vis->links[index].next = ENF_NONE;
    vis->links[index].growths = 0;
    vis->links[index].queued = false;
    return index;
}

/* A kd query returns at most the items of the largest tree. */
static uint32_t largest_tree(const EnfMap *map) {
    uint32_t blocks = map->cell_blocks_count;
    for (uint32_t i = 0; i < map->cells_count; i++) {
        blocks = map->cells[i].block_count > blocks ? map->cells[i].block_count : blocks;
    }
    return blocks * ENF_KD_BLOCK;
}

static bool allocate(EnfVis *vis) {
    const EnfMap *map = vis->map;
    const EnfAllocator *allocator = vis->allocator;
    uint32_t cells = map->cells_count + 1U; /* never an allocation of nothing */
    uint32_t clusters = map->clusters_count + 1U;
    vis->items_capacity = largest_tree(map) + 1U;
    vis->cell_frame = enf_alloc(allocator, cells, sizeof *vis->cell_frame);
    vis->cell_visit = enf_alloc(allocator, cells, sizeof *vis->cell_visit);
    vis->cells = enf_alloc(allocator, cells, sizeof *vis->cells);
    vis->cluster_visit = enf_alloc(allocator, clusters, sizeof *vis->cluster_visit);
    vis->items = enf_alloc(allocator, vis->items_capacity, sizeof *vis->items);
    bool ok = vis->cell_frame != NULL && vis->cell_visit != NULL && vis->cells != NULL && vis->cluster_visit != NULL &&
              vis->items != NULL;
    ok = ok && bits_create(&vis->cell_bits, cells, allocator) && bits_create(&vis->cluster_bits, clusters, allocator);
    return ok && enf_vis_reserve_visits(vis, cells + FIRST_EXTRA_VISITS) && enf_vis_reserve_entries(vis, clusters);
}

EnfResult enf_vis_create(EnfVis **out, const EnfMap *map, const EnfAllocator *allocator, EnfError *error) {
    *out = NULL;
    EnfVis *vis = enf_alloc(allocator, 1, sizeof *vis);
    if (vis != NULL) {
        vis->map = map;
        vis->allocator = allocator;
        if (!allocate(vis)) {
            enf_vis_destroy(vis);
            vis = NULL;
        }
    }
    if (vis == NULL) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "working memory for views of %u cells, %u clusters",
                             map->cells_count, map->clusters_count);
    }
    *out = vis;
    return ENF_OK;
}

void enf_vis_destroy(EnfVis *vis) {
    if (vis == NULL) {
        return;
    }
    const EnfAllocator *allocator = vis->allocator;
    uint32_t cells = vis->map->cells_count + 1U;
    uint32_t clusters = vis->map->clusters_count + 1U;
    enf_free(allocator, vis->visits, vis->visit_capacity, sizeof *vis->visits);
    enf_free(allocator, vis->links, vis->visit_capacity, sizeof *vis->links);
    enf_free(allocator, vis->polygons, vis->polygon_capacity, sizeof *vis->polygons);
    enf_free(allocator, vis->cell_frame, cells, sizeof *vis->cell_frame);
    enf_free(allocator, vis->cell_visit, cells, sizeof *vis->cell_visit);
    enf_free(allocator, vis->cells, cells, sizeof *vis->cells);
    enf_free(allocator, vis->cluster_visit, clusters, sizeof *vis->cluster_visit);
    enf_free(allocator, vis->items, vis->items_capacity, sizeof *vis->items);
    enf_free(allocator, vis->entries, vis->entry_capacity, sizeof *vis->entries);
    bits_destroy(&vis->cell_bits, allocator);
    bits_destroy(&vis->cluster_bits, allocator);
    enf_free(allocator, vis, 1, sizeof *vis);
}
