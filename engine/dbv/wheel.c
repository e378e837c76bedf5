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
    wheel->now = now;
}

static uint32_t slot_of(const EnfDbvWheel *wheel, uint32_t object, int64_t tick) {
    int64_t ahead = tick - wheel->now;
    if (ahead >= ENF_DBV_SLOTS) {
        uint32_t hash = (object * UINT32_C(2654435761)) >> 16;
        ahead = ENF_DBV_SLOTS / 2 + hash % (ENF_DBV_SLOTS / 2);
    }
    return (uint32_t)(uint64_t)(wheel->now + ahead) & MASK;
}

void enf_dbv_wheel_add(EnfDbvIndex *index, uint32_t object) {
    EnfDbvWheel *wheel = &index->wheel;
    EnfDbvVolume *volume = &index->volumes[object];
    ENF_ASSERT(volume->expiry_tick > wheel->now);
    uint32_t slot = slot_of(wheel, object, volume->expiry_tick);
    volume->wheel_slot = slot;
    volume->wheel_previous = ENF_NONE;
    volume->wheel_next = wheel->heads[slot];
    if (volume->wheel_next != ENF_NONE) {
        index->volumes[volume->wheel_next].wheel_previous = object;
    }
    wheel->heads[slot] = object;
    wheel->occupied[slot / 64] |= UINT64_C(1) << slot % 64;
}

void enf_dbv_wheel_remove(EnfDbvIndex *index, uint32_t object) {
    EnfDbvVolume *volume = &index->volumes[object];
    uint32_t slot = volume->wheel_slot;
    if (slot == ENF_NONE) {
        return;
    }
    if (volume->wheel_next != ENF_NONE) {
        index->volumes[volume->wheel_next].wheel_previous = volume->wheel_previous;
    }
    if (volume->wheel_previous != ENF_NONE) {
        index->volumes[volume->wheel_previous].wheel_next = volume->wheel_next;
    } else {
        index->wheel.heads[slot] = volume->wheel_next; /* an emptied slot's bit is cleared when its tick comes */
    }
    volume->wheel_slot = ENF_NONE;
}

/* Empties a slot: what is due goes to the list, the rest waits on. */
static bool take_slot(EnfDbvIndex *index, uint32_t slot, int64_t tick) {
    uint32_t object = index->wheel.heads[slot];
    index->wheel.heads[slot] = ENF_NONE;
    index->wheel.occupied[slot / 64] &= ~(UINT64_C(1) << slot % 64);
    bool ok = true;
    while (object != ENF_NONE) {
        EnfDbvVolume *volume = &index->volumes[object];
        uint32_t next = volume->wheel_next;
        volume->wheel_slot = ENF_NONE;
        if (volume->expiry_tick > tick) {
            enf_dbv_wheel_add(index, object);
        } else {
            ok = enf_dbv_list_add(index, &index->due, object) && ok;
        }
        object = next;
    }
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

/* More than a turn has passed: every slot's time has come. */
static bool take_all(EnfDbvIndex *index, int64_t tick) {
    bool ok = true;
    index->wheel.now = tick;
    uint32_t waiting = ENF_NONE; /* chained by wheel_next while the slots are emptied */
    for (uint32_t slot = 0; slot < ENF_DBV_SLOTS; slot++) {
        while (index->wheel.heads[slot] != ENF_NONE) {
            uint32_t object = index->wheel.heads[slot];
            EnfDbvVolume *volume = &index->volumes[object];
            enf_dbv_wheel_remove(index, object);
            if (volume->expiry_tick > tick) {
                volume->wheel_next = waiting;
                waiting = object;
            } else {
                ok = enf_dbv_list_add(index, &index->due, object) && ok;
            }
        }
    }
    while (waiting != ENF_NONE) {
        uint32_t object = waiting;
        waiting = index->volumes[object].wheel_next;
        enf_dbv_wheel_add(index, object);
    }
    return ok;
}

bool enf_dbv_wheel_advance(EnfDbvIndex *index, int64_t tick) {
    EnfDbvWheel *wheel = &index->wheel;
    bool ok = true;
    if (tick - wheel->now >= ENF_DBV_SLOTS) {
        ok = take_all(index, tick);
    }
    while (wheel->now < tick) {
        wheel->now = next_occupied(wheel, tick);
        ok = take_slot(index, (uint32_t)(uint64_t)wheel->now & MASK, wheel->now) && ok;
    }
    enf_dbv_sort(index, &index->due, earlier);
    return ok;
}
