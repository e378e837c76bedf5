/* The string table: a hash table of offsets over one block of bytes. */
#include "compile/strings.h"

#include "compile/array.h"

#include <stdlib.h>
#include <string.h>

enum { TEXT_MAX = 1 << 20 };

static uint64_t hash_of(const char *text, size_t length) {
    uint64_t hash = enf_hash64(ENF_HASH_START, text, length);
    return hash ^ hash >> 32;
}

/* The slot of a text: where it is, or where it would go. */
static uint32_t find_slot(const EnfStrings *strings, const char *text, size_t length) {
    uint32_t mask = strings->slot_count - 1;
    uint32_t slot = (uint32_t)hash_of(text, length) & mask;
    while (strings->slots[slot] != 0) {
        const char *found = strings->bytes + strings->slots[slot] - 1;
        if (strncmp(found, text, length) == 0 && found[length] == '\0') {
            break;
        }
        slot = (slot + 1) & mask;
    }
    return slot;
}

static bool grow_slots(EnfStrings *strings) {
    uint32_t count = strings->slot_count ? strings->slot_count * 2 : 256;
    uint32_t *slots = calloc(count, sizeof *slots);
    if (!slots) {
        return false;
    }
    uint32_t *old = strings->slots;
    uint32_t old_count = strings->slot_count;
    strings->slots = slots;
    strings->slot_count = count;
    for (uint32_t i = 0; i < old_count; i++) {
        if (old[i] != 0) {
            const char *text = strings->bytes + old[i] - 1;
            slots[find_slot(strings, text, strlen(text))] = old[i];
        }
    }
    free(old);
    return true;
}

static uint32_t append(EnfStrings *strings, const char *text, size_t length) {
    if (!enf_array_reserve(&strings->bytes, &strings->capacity, (uint64_t)strings->count + length + 1, 1)) {
        strings->failed = true;
        return 0;
    }
    uint32_t offset = strings->count;
    memcpy(strings->bytes + offset, text, length);
    strings->bytes[offset + length] = '\0';
    strings->count += (uint32_t)length + 1;
    return offset;
}

uint32_t enf_strings_add(EnfStrings *strings, const char *text) {
    if (strings->count == 0 && !strings->failed) {
        append(strings, "", 0);
    }
    if (!text || !*text || strings->failed) {
        return 0;
    }
    size_t length = strlen(text);
    length = length > TEXT_MAX ? TEXT_MAX : length;
    if (strings->used * 2 >= strings->slot_count && !grow_slots(strings)) {
        strings->failed = true;
        return 0;
    }
    uint32_t slot = find_slot(strings, text, length);
    if (strings->slots[slot] == 0) {
        uint32_t offset = append(strings, text, length);
        if (strings->failed) {
            return 0;
        }
        strings->slots[slot] = offset + 1;
        strings->used++;
    }
    return strings->slots[slot] - 1;
}

void enf_strings_free(EnfStrings *strings) {
    free(strings->bytes);
    free(strings->slots);
    memset(strings, 0, sizeof *strings);
}
