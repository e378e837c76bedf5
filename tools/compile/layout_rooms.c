/* Rooms by name. Input: cells; output: two sorted tables of the names by which portals may mean them. */
#include "compile/layout_work.h"

/* A room is meant by its node's name, by that without Blender's number, and by that without `-room` as well. */
enum { KEYS_A_ROOM = 3 };

static int compare_keys(const EnfRoomKey *a, const EnfRoomKey *b, bool folded) {
    int order = enf_name_compare(a->text, a->length, b->text, b->length, folded);
    if (order == 0) {
        order = (a->rank > b->rank) - (a->rank < b->rank);
    }
    return order != 0 ? order : (a->cell > b->cell) - (a->cell < b->cell);
}

static int compare_exact(const void *a, const void *b) {
    return compare_keys(a, b, false);
}

static int compare_folded(const void *a, const void *b) {
    return compare_keys(a, b, true);
}

/* Two rooms with one name cannot both be meant by it: those after the first are named. */
static void warn_of_duplicates(EnfLayoutWork *work) {
    for (uint32_t i = 1; i < work->room_key_count; i++) {
        const EnfRoomKey *a = &work->rooms[i - 1], *b = &work->rooms[i];
        bool same = a->rank == 1 && b->rank == 1 && a->cell != b->cell &&
                    enf_name_compare(a->text, a->length, b->text, b->length, false) == 0;
        EnfNodeName name = enf_node_name(b->text);
        if (same && b->length == name.base) {
            enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_ROOM_DUPLICATE, work->cells.data[b->cell].name,
                         "'%s' has the same name; portals that name it are linked to the nearer of the two",
                         work->cells.data[a->cell].name);
        }
    }
}

bool enf_layout_index_rooms(EnfLayoutWork *work) {
    uint32_t count = 0;
    size_t n = KEYS_A_ROOM * (size_t)work->cells.count;
    work->rooms = enf_alloc(NULL, n, sizeof *work->rooms);
    work->rooms_folded = enf_alloc(NULL, n, sizeof *work->rooms_folded);
    if (n > 0 && (work->rooms == NULL || work->rooms_folded == NULL)) {
        return false;
    }
    for (uint32_t c = 0; c < work->cells.count; c++) {
        const char *text = work->cells.data[c].name;
        EnfNodeName name = enf_node_name(text);
        work->rooms[count++] = (EnfRoomKey){text, strlen(text), c, 0};
        work->rooms[count++] = (EnfRoomKey){text, name.base, c, 1};
        if (name.whole != name.base) {
            work->rooms[count++] = (EnfRoomKey){text, name.whole, c, 1};
        }
    }
    work->room_key_count = count;
    if (count > 0) {
        memcpy(work->rooms_folded, work->rooms, count * sizeof *work->rooms);
        qsort(work->rooms, count, sizeof *work->rooms, compare_exact);
        qsort(work->rooms_folded, count, sizeof *work->rooms_folded, compare_folded);
    }
    warn_of_duplicates(work);
    return true;
}

static uint32_t find_in(const EnfRoomKey *keys, uint32_t count, const EnfRoomKey *wanted, bool folded, uint32_t *out,
                        uint32_t capacity) {
    uint32_t low = 0, high = count, found = 0;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (compare_keys(&keys[middle], wanted, folded) < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    for (uint32_t i = low; i < count && found < capacity; i++) {
        bool match = enf_name_compare(keys[i].text, keys[i].length, wanted->text, wanted->length, folded) == 0;
        if (!match || keys[i].rank != keys[low].rank) {
            break;
        }
        if (found == 0 || out[found - 1] != keys[i].cell) {
            out[found++] = keys[i].cell;
        }
    }
    return found;
}

uint32_t enf_layout_find_rooms(const EnfLayoutWork *work, const char *text, size_t length, uint32_t *out, uint32_t capacity) {
    EnfRoomKey wanted = {text, length, 0, 0};
    if (length == 0) {
        return 0;
    }
    uint32_t found = find_in(work->rooms, work->room_key_count, &wanted, false, out, capacity);
    return found > 0 ? found : find_in(work->rooms_folded, work->room_key_count, &wanted, true, out, capacity);
}
