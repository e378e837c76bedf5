/* The expiry queue: a timing wheel (Varghese & Lauck 1987, scheme 5) of one slot a tick. Adding and removing cost a few words; passing
 * an empty stretch of time costs a scan of bits. What expires beyond the wheel's turn waits in a slot of its own choice in the
 * turn's second half, is looked at there and goes on waiting: so no tick has to move a whole slot of a coarser wheel at once
 * (PITFALLS 23). What is due comes out in order of (tick, object), so runs repeat (DESIGN §5). */
#include "dbv/dbv_internal.h"

#include <string.h>

enum { MASK = ENF_DBV_SLOTS - 1 };

void enf_dbv_wheel_create(EnfDbvWheel *wheel, int64_t now) {
    memset(wheel->occupied, 0, sizeof wheel->occupied);
    memset(wheel->heads, 0xff, sizeof wheel->heads); /* ENF_NONE */
    wheel->free_head = ENF_NONE;
    wheel->now = now;
}

void enf_dbv_wheel_destroy(EnfDbvWheel *wheel, const EnfAllocator *allocator) {
    enf_free(allocator, wheel->chunks, wheel->capacity, sizeof *wheel->chunks);
}

bool enf_dbv_wheel_reserve(EnfDbvIndex *index, uint32_t count) {
    EnfDbvWheel *wheel = &index->wheel;
    uint32_t slots = count < ENF_DBV_SLOTS ? count : ENF_DBV_SLOTS; /* a chunk that is not full, each */
    void *chunks = wheel->chunks;
    if (!enf_dbv_enlarge(index, &chunks, wheel->used, &wheel->capacity, count / ENF_DBV_QUEUED + slots + 1,
                         sizeof *wheel->chunks)) {
        return false;
    }
    wheel->chunks = chunks;
    return true;
}

/* An empty chunk at the head of a slot's chain. */
static EnfDbvChunk *add_chunk(EnfDbvWheel *wheel, uint32_t slot) {
    uint32_t number = wheel->free_head;
    if (number != ENF_NONE) {
        wheel->free_head = wheel->chunks[number].next;
    } else {
        ENF_ASSERT(wheel->used < wheel->capacity);
        number = wheel->used++;
    }
    EnfDbvChunk *chunk = &wheel->chunks[number];
    chunk->next = wheel->heads[slot];
    chunk->slot = (uint16_t)slot;
    chunk->count = 0;
    wheel->heads[slot] = number;
    return chunk;
}

static void drop_chunk(EnfDbvWheel *wheel, uint32_t slot) {
    uint32_t number = wheel->heads[slot];
    wheel->heads[slot] = wheel->chunks[number].next;
    wheel->chunks[number].next = wheel->free_head;
    wheel->free_head = number;
}

static uint32_t slot_of(const EnfDbvWheel *wheel, uint32_t object, int64_t tick) {
    int64_t ahead = tick - wheel->now;
    if (ahead >= ENF_DBV_SLOTS) {
        ahead = ENF_DBV_SLOTS / 2 + enf_dbv_scatter(object, ENF_DBV_SLOTS / 2);
    }
    return (uint32_t)(uint64_t)(wheel->now + ahead) & MASK;
}

void enf_dbv_wheel_add(EnfDbvIndex *index, uint32_t object) {
    EnfDbvWheel *wheel = &index->wheel;
    EnfDbvVolume *volume = &index->volumes[object];
    ENF_ASSERT(volume->expiry_tick > wheel->now);
    uint32_t slot = slot_of(wheel, object, volume->expiry_tick);
    uint32_t head = wheel->heads[slot];
    EnfDbvChunk *chunk = head == ENF_NONE || wheel->chunks[head].count == ENF_DBV_QUEUED ? add_chunk(wheel, slot)
                                                                                         : &wheel->chunks[head];
    volume->wheel_at = wheel->heads[slot] * ENF_DBV_QUEUED + chunk->count;
    chunk->items[chunk->count++] = object;
    wheel->occupied[slot / 64] |= UINT64_C(1) << slot % 64;
}

void enf_dbv_wheel_prefetch(const EnfDbvIndex *index, uint32_t object) {
    uint32_t at = index->volumes[object].wheel_at;
    if (at != ENF_NONE) {
        enf_dbv_prefetch(&index->wheel.chunks[at / ENF_DBV_QUEUED]);
    }
}

void enf_dbv_wheel_remove(EnfDbvIndex *index, uint32_t object) {
    EnfDbvWheel *wheel = &index->wheel;
    uint32_t at = index->volumes[object].wheel_at;
    if (at == ENF_NONE) {
        return;
    }
    EnfDbvChunk *chunk = &wheel->chunks[at / ENF_DBV_QUEUED];
    EnfDbvChunk *first = &wheel->chunks[wheel->heads[chunk->slot]];
    uint32_t last = first->items[--first->count]; /* takes its place */
    chunk->items[at % ENF_DBV_QUEUED] = last;
    index->volumes[last].wheel_at = at;
    index->volumes[object].wheel_at = ENF_NONE;
    if (first->count == 0) {
        drop_chunk(wheel, chunk->slot); /* an emptied slot's bit is cleared when its tick comes */
    }
}

/* Empties a slot: what is due goes to the list, the rest waits on. The volumes are asked for while the slot is read, and looked at
 * afterwards. */
static bool take_slot(EnfDbvIndex *index, uint32_t slot, int64_t tick) {
    EnfDbvWheel *wheel = &index->wheel;
    EnfDbvList *due = &index->due;
    uint32_t number = wheel->heads[slot];
    uint32_t first = due->count;
    wheel->heads[slot] = ENF_NONE;
    wheel->occupied[slot / 64] &= ~(UINT64_C(1) << slot % 64);
    bool ok = true;
    while (number != ENF_NONE) {
        EnfDbvChunk chunk = wheel->chunks[number];
        wheel->chunks[number].next = wheel->free_head;
        wheel->free_head = number;
        for (uint32_t i = 0; i < chunk.count; i++) {
            enf_dbv_prefetch(&index->volumes[chunk.items[i]]);
            if (!enf_dbv_list_add(index, due, chunk.items[i])) {
                index->volumes[chunk.items[i]].wheel_at = ENF_NONE;
                index->first = true; /* nobody would wake it: all are taken in anew */
                ok = false;
            }
        }
        number = chunk.next;
    }
    uint32_t kept = first;
    for (uint32_t i = first; i < due->count; i++) {
        uint32_t object = due->items[i];
        index->volumes[object].wheel_at = ENF_NONE;
        if (index->volumes[object].expiry_tick > tick) {
            enf_dbv_wheel_add(index, object);
        } else {
            due->items[kept++] = object;
        }
    }
    due->count = kept;
    return ok;
}

/* The first tick after `now` whose slot is occupied; at most `limit`, which is less than a turn away. */
static int64_t next_occupied(const EnfDbvWheel *wheel, int64_t limit) {
    int64_t tick = wheel->now + 1;
    while (tick < limit) {
        uint32_t slot = (uint32_t)(uint64_t)tick & MASK;
        uint64_t bits = wheel->occupied[slot / 64] >> slot % 64;
        if ((bits & 1U) != 0) {
            return tick;
        }
        tick += bits == 0 ? 64 - slot % 64 : 1;
    }
    return limit;
}

static bool earlier(const EnfDbvIndex *index, uint32_t a, uint32_t b) {
    int64_t x = index->volumes[a].expiry_tick;
    int64_t y = index->volumes[b].expiry_tick;
    return x != y ? x < y : a < b;
}

/* More than a turn has passed: every slot's time has come. Chunks are taken from the slots first, as those who wait on may choose any
 * slot. */
static bool take_all(EnfDbvIndex *index, int64_t tick) {
    EnfDbvWheel *wheel = &index->wheel;
    bool ok = true;
    wheel->now = tick;
    uint32_t taken = ENF_NONE;
    for (uint32_t slot = 0; slot < ENF_DBV_SLOTS; slot++) {
        while (wheel->heads[slot] != ENF_NONE) {
            uint32_t number = wheel->heads[slot];
            wheel->heads[slot] = wheel->chunks[number].next;
            wheel->chunks[number].next = taken;
            taken = number;
        }
    }
    memset(wheel->occupied, 0, sizeof wheel->occupied);
    wheel->heads[0] = taken; /* one chain of all, emptied as any other */
    return take_slot(index, 0, tick) && ok;
}

bool enf_dbv_wheel_advance(EnfDbvIndex *index, int64_t tick) {
    EnfDbvWheel *wheel = &index->wheel;
    bool ok = true;
    if (tick - wheel->now >= ENF_DBV_SLOTS) {
        ok = take_all(index, tick);
        enf_dbv_sort(index, &index->due, earlier);
    }
    while (wheel->now < tick) {
        wheel->now = next_occupied(wheel, tick);
        uint32_t first = index->due.count; /* what is due in one tick is in order by number */
        ok = take_slot(index, (uint32_t)(uint64_t)wheel->now & MASK, wheel->now) && ok;
        enf_dbv_sort_numbers(index, &index->due, first);
    }
    return ok;
}
