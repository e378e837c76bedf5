/* Memory of an index: volumes, lists, the table of places. Arrays grow and keep their size, so a warm frame makes no heap call. */
#include "dbv/dbv_internal.h"

#include <math.h>
#include <string.h>

_Static_assert(sizeof(EnfDbvVolume) <= 64, "with two boxes in blocks and the lists of a frame: at most 160 bytes an object");

EnfDbvDef enf_dbv_def_default(void) {
    EnfDbvDef def = {ENF_DBV_MAXIMAL, ENF_DBV_LCA, 64, 1U << 30};
    return def;
}

/* The largest coordinate of any cell's box, and a metre. */
static double farthest_cell(const EnfMap *map) {
    double farthest = 0.0;
    for (uint32_t c = 0; c < map->cells_count; c++) {
        const EnfCell *cell = &map->cells[c];
        for (int axis = 0; axis < 3; axis++) {
            farthest = fmax(farthest, fabs(cell->origin[axis] + (double)cell->min[axis]));
            farthest = fmax(farthest, fabs(cell->origin[axis] + (double)cell->max[axis]));
        }
    }
    return farthest + 1.0;
}

/* How long a room is, in the mean. */
static double room_length(const EnfMap *map) {
    double sum = 0.0;
    for (uint32_t c = 0; c < map->cells_count; c++) {
        const EnfCell *cell = &map->cells[c];
        double x = (double)cell->max[0] - (double)cell->min[0];
        double y = (double)cell->max[1] - (double)cell->min[1];
        double z = (double)cell->max[2] - (double)cell->min[2];
        sum += fmax(x, fmax(y, z));
    }
    return map->cells_count > 0 ? sum / (double)map->cells_count : 0.0;
}

EnfResult enf_dbv_create(EnfDbvIndex **out, EnfWorld *world, const EnfDbvDef *def, const EnfAllocator *allocator,
                         EnfError *error) {
    *out = NULL;
    ENF_ASSERT(def->period_ticks >= 1 && def->max_period_ticks >= def->period_ticks);
    EnfDbvIndex *index = enf_alloc(allocator, 1, sizeof *index);
    if (index == NULL) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "an index of volumes");
    }
    index->world = world;
    index->map = enf_world_map(world);
    index->allocator = allocator;
    index->def = *def;
    index->first = true;
    index->pool.free_head = ENF_NONE;
    index->pool.bound = farthest_cell(index->map);
    index->room = room_length(index->map);
    enf_dbv_wheel_create(&index->wheel, enf_world_tick(world));
    EnfResult result = enf_dbv_places_create(&index->places, index->map, allocator, error);
    if (result == ENF_OK && def->policy == ENF_DBV_REACH && enf_dbv_can_reach(index->map)) {
        index->portal_boxes = enf_alloc(allocator, (size_t)index->map->portals_count + 1, sizeof *index->portal_boxes);
        if (index->portal_boxes == NULL) {
            enf_dbv_places_destroy(&index->places, allocator);
            result = enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "boxes of %u portals", index->map->portals_count);
        } else {
            enf_dbv_reach_boxes(index->map, index->portal_boxes);
        }
    }
    if (result != ENF_OK) {
        enf_free(allocator, index, 1, sizeof *index);
        return result;
    }
    *out = index;
    return ENF_OK;
}

static void free_list(const EnfDbvIndex *index, EnfDbvList *list) {
    enf_free(index->allocator, list->items, list->capacity, sizeof *list->items);
}

void enf_dbv_destroy(EnfDbvIndex *index) {
    if (index == NULL) {
        return;
    }
    enf_dbv_places_destroy(&index->places, index->allocator);
    enf_free(index->allocator, index->portal_boxes, (size_t)index->map->portals_count + 1, sizeof *index->portal_boxes);
    enf_dbv_pool_destroy(&index->pool, index->allocator);
    enf_dbv_wheel_destroy(&index->wheel, index->allocator);
    enf_free(index->allocator, index->volumes, index->volume_capacity, sizeof *index->volumes);
    enf_free(index->allocator, index->exposures, index->exposure_capacity, sizeof *index->exposures);
    free_list(index, &index->due);
    free_list(index, &index->drawn);
    free_list(index, &index->blocks);
    free_list(index, &index->loose);
    free_list(index, &index->candidates);
    free_list(index, &index->scratch);
    enf_free(index->allocator, index, 1, sizeof *index);
}

bool enf_dbv_enlarge(EnfDbvIndex *index, void **array, uint32_t used, uint32_t *capacity, uint32_t count, size_t size) {
    if (count <= *capacity) {
        return true;
    }
    uint64_t doubled = (uint64_t)*capacity * 2;
    uint64_t wanted = doubled > count ? doubled : count;
    uint32_t next = wanted > UINT32_MAX / ENF_DBV_LINKS ? UINT32_MAX / ENF_DBV_LINKS : (uint32_t)wanted;
    void *block = next >= count ? enf_alloc(index->allocator, next, size) : NULL;
    if (block == NULL) {
        return false;
    }
    if (used > 0) {
        memcpy(block, *array, used * size);
    }
    enf_free(index->allocator, *array, *capacity, size);
    *array = block;
    *capacity = next;
    return true;
}

bool enf_dbv_list_add(EnfDbvIndex *index, EnfDbvList *list, uint32_t item) {
    void *items = list->items;
    if (!enf_dbv_enlarge(index, &items, list->count, &list->capacity, list->count + 1, sizeof *list->items)) {
        return false;
    }
    list->items = items;
    list->items[list->count++] = item;
    return true;
}

bool enf_dbv_reserve_exposures(EnfDbvIndex *index, uint32_t count) {
    void *exposures = index->exposures;
    if (!enf_dbv_enlarge(index, &exposures, index->exposure_count, &index->exposure_capacity, count,
                         sizeof *index->exposures)) {
        return false;
    }
    index->exposures = exposures;
    return true;
}

/* Room in the lists of a frame, so that frames of worlds of some thousand objects ask no heap; larger worlds' lists grow, doubling, with
 * what a frame ever saw. */
static bool reserve_lists(EnfDbvIndex *index, uint32_t count) {
    enum { LISTED = 4096 };
    uint32_t room = count < LISTED ? count : LISTED;
    EnfDbvList *lists[] = {&index->due, &index->drawn, &index->blocks, &index->loose, &index->candidates, &index->scratch};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        void *items = lists[i]->items;
        if (!enf_dbv_enlarge(index, &items, lists[i]->count, &lists[i]->capacity, room, sizeof *lists[i]->items)) {
            return false;
        }
        lists[i]->items = items;
    }
    return enf_dbv_reserve_exposures(index, room);
}

bool enf_dbv_reserve_volumes(EnfDbvIndex *index, uint32_t count) {
    void *volumes = index->volumes;
    if (!enf_dbv_enlarge(index, &volumes, index->volume_count, &index->volume_capacity, count, sizeof *index->volumes)) {
        return false;
    }
    index->volumes = volumes;
    if (!enf_dbv_wheel_reserve(index, count) || !reserve_lists(index, count)) {
        return false;
    }
    for (; index->volume_count < count; index->volume_count++) {
        index->volumes[index->volume_count].wheel_at = ENF_NONE;
    }
    return true;
}

void enf_dbv_sort(const EnfDbvIndex *index, EnfDbvList *list, EnfDbvBefore *before) {
    static const uint32_t gaps[] = {1, 4, 10, 23, 57, 132, 301, 701, 1577, 3548, 7983, 17961, 40412, 90927, 204585, 460316};
    uint32_t *items = list->items;
    for (size_t g = sizeof gaps / sizeof *gaps; g > 0; g--) {
        uint32_t gap = gaps[g - 1];
        for (uint32_t i = gap; i < list->count; i++) {
            uint32_t moved = items[i];
            uint32_t j = i;
            for (; j >= gap && before(index, moved, items[j - gap]); j -= gap) {
                items[j] = items[j - gap];
            }
            items[j] = moved;
        }
    }
}

static bool ascending(const EnfDbvIndex *index, uint32_t a, uint32_t b) {
    (void)index;
    return a < b;
}

/* One pass: by the byte at `shift`, from one array into the other. */
static void sort_by_byte(const uint32_t *from, uint32_t *to, uint32_t count, uint32_t shift) {
    uint32_t starts[256] = {0};
    for (uint32_t i = 0; i < count; i++) {
        starts[from[i] >> shift & 255U]++;
    }
    uint32_t sum = 0;
    for (uint32_t b = 0; b < 256; b++) {
        uint32_t here = starts[b];
        starts[b] = sum;
        sum += here;
    }
    for (uint32_t i = 0; i < count; i++) {
        to[starts[from[i] >> shift & 255U]++] = from[i];
    }
}

/* Below it a pass over 256 counters costs more than compares. */
enum { FEW = 48 };

void enf_dbv_sort_numbers(EnfDbvIndex *index, EnfDbvList *list, uint32_t first) {
    void *items = index->scratch.items;
    uint32_t count = list->count - first;
    if (count < 2) { /* a list that was never pushed to has no items to point at */
        return;
    }
    uint32_t *numbers = list->items + first;
    if (count < FEW || !enf_dbv_enlarge(index, &items, 0, &index->scratch.capacity, count, sizeof *numbers)) {
        EnfDbvList part = {numbers, count, count};
        enf_dbv_sort(index, &part, ascending);
        return;
    }
    index->scratch.items = items;
    uint32_t *from = numbers;
    uint32_t *to = index->scratch.items;
    for (uint32_t shift = 0; shift < 32 && index->volume_count >> shift > 0; shift += 8) {
        sort_by_byte(from, to, count, shift);
        uint32_t *swapped = from;
        from = to;
        to = swapped;
    }
    if (from != numbers) {
        memcpy(numbers, from, count * sizeof *numbers);
    }
}

bool enf_dbv_failed(const EnfDbvIndex *index) {
    return index->failed;
}

EnfDbvCounters enf_dbv_frame_counters(const EnfDbvIndex *index) {
    return index->counters;
}

EnfDbvCounters enf_dbv_total_counters(const EnfDbvIndex *index) {
    return index->total;
}

bool enf_dbv_volume(const EnfDbvIndex *index, uint32_t object, EnfBox3f *volume, int64_t *expiry_tick) {
    if (object >= index->volume_count || index->volumes[object].link_count == 0) {
        return false;
    }
    const EnfDbvVolume *record = &index->volumes[object];
    EnfBox3f all = enf_dbv_lane(&enf_dbv_block(&index->pool, record->links[0] / ENF_KD_BLOCK)->boxes,
                                record->links[0] % ENF_KD_BLOCK);
    *volume = all;
    *expiry_tick = record->expiry_tick;
    return true;
}

EnfDbvState enf_dbv_state(const EnfDbvIndex *index, uint32_t object) {
    if (object >= index->volume_count || !index->volumes[object].alive) {
        return ENF_DBV_STATE_NONE;
    }
    const EnfDbvVolume *volume = &index->volumes[object];
    if (volume->exposed_frame == index->frame && index->exposure_count > 0) {
        return index->exposures[volume->exposure].drawn ? ENF_DBV_STATE_DRAWN : ENF_DBV_STATE_EXPOSED;
    }
    for (uint32_t i = 0; i < index->due.count; i++) {
        if (index->due.items[i] == object) {
            return ENF_DBV_STATE_EXPIRED;
        }
    }
    return ENF_DBV_STATE_ASLEEP;
}

size_t enf_dbv_bytes(const EnfDbvIndex *index) {
    size_t lists = (size_t)index->due.capacity + index->drawn.capacity + index->blocks.capacity + index->loose.capacity +
                   index->candidates.capacity + index->scratch.capacity;
    size_t portals = index->portal_boxes == NULL ? 0 : (size_t)index->map->portals_count + 1;
    size_t queue = index->wheel.capacity * sizeof *index->wheel.chunks;
    return sizeof *index + queue + portals * sizeof *index->portal_boxes + enf_dbv_pool_bytes(&index->pool) +
           index->volume_capacity * sizeof *index->volumes + lists * sizeof(uint32_t) +
           index->exposure_capacity * sizeof *index->exposures + enf_dbv_places_bytes(&index->places);
}
