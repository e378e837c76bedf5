/* The expiry queue: a hierarchical timing wheel (Varghese & Lauck 1987, scheme 7). Adding and removing cost a few words; passing
 * an empty stretch of time costs nothing, as occupied slots are bits. What is due comes out in order of (tick, object), so runs
 * repeat (DESIGN §5). */
#include "dbv/dbv_internal.h"

#include <string.h>

enum { BITS = 8, MASK = ENF_DBV_SLOTS - 1 };

void enf_dbv_wheel_create(EnfDbvWheel *wheel, int64_t now) {
    memset(wheel, 0, sizeof *wheel);
    wheel->now = now;
    for (uint32_t i = 0; i <= ENF_DBV_WAITING; i++) {
        wheel->heads[i] = ENF_NONE;
    }
}

/* The finest level whose present turn holds the tick, and its slot there; what lies beyond the last level's turn waits apart. */
static uint32_t slot_of(const EnfDbvWheel *wheel, int64_t tick) {
    uint64_t differs = (uint64_t)tick ^ (uint64_t)wheel->now;
    for (uint32_t level = 0; level < ENF_DBV_LEVELS; level++) {
        if (differs >> (BITS * (level + 1)) == 0) {
            return level * ENF_DBV_SLOTS + (uint32_t)((uint64_t)tick >> (BITS * level) & MASK);
        }
    }
    return ENF_DBV_WAITING;
}

void enf_dbv_wheel_add(EnfDbvIndex *index, uint32_t object) {
    EnfDbvWheel *wheel = &index->wheel;
    EnfDbvVolume *volume = &index->volumes[object];
    ENF_ASSERT(volume->expiry_tick > wheel->now);
    uint32_t slot = slot_of(wheel, volume->expiry_tick);
    volume->wheel_slot = (uint16_t)slot;
    volume->wheel_previous = ENF_NONE;
    volume->wheel_next = wheel->heads[slot];
    if (volume->wheel_next != ENF_NONE) {
        index->volumes[volume->wheel_next].wheel_previous = object;
    }
    wheel->heads[slot] = object;
    if (slot != ENF_DBV_WAITING) {
        wheel->occupied[slot / ENF_DBV_SLOTS][slot % ENF_DBV_SLOTS / 64] |= UINT64_C(1) << slot % 64;
    }
}

static void empty_slot(EnfDbvWheel *wheel, uint32_t slot) {
    wheel->heads[slot] = ENF_NONE;
    if (slot != ENF_DBV_WAITING) {
        wheel->occupied[slot / ENF_DBV_SLOTS][slot % ENF_DBV_SLOTS / 64] &= ~(UINT64_C(1) << slot % 64);
    }
}

void enf_dbv_wheel_remove(EnfDbvIndex *index, uint32_t object) {
    EnfDbvVolume *volume = &index->volumes[object];
    uint32_t slot = volume->wheel_slot;
    if (slot == ENF_DBV_NO_SLOT) {
        return;
    }
    if (volume->wheel_next != ENF_NONE) {
        index->volumes[volume->wheel_next].wheel_previous = volume->wheel_previous;
    }
    if (volume->wheel_previous != ENF_NONE) {
        index->volumes[volume->wheel_previous].wheel_next = volume->wheel_next;
    } else if (volume->wheel_next != ENF_NONE) {
        index->wheel.heads[slot] = volume->wheel_next;
    } else {
        empty_slot(&index->wheel, slot);
    }
    volume->wheel_slot = ENF_DBV_NO_SLOT;
}

/* The first occupied slot of a level after `slot` in this turn; ENF_DBV_SLOTS if none. */
static uint32_t next_occupied(const EnfDbvWheel *wheel, uint32_t level, uint32_t slot) {
    for (uint32_t i = slot + 1; i < ENF_DBV_SLOTS; i = (i / 64 + 1) * 64) {
        uint64_t bits = wheel->occupied[level][i / 64] >> i % 64;
        if (bits != 0) {
            while ((bits & 1U) == 0) {
                bits >>= 1;
                i++;
            }
            return i;
        }
    }
    return ENF_DBV_SLOTS;
}

/* The next tick at which a slot must be emptied: an occupied one of the finest level's turn, or the beginning of an occupied one of
 * a coarser level; at most `limit`. */
static int64_t next_stop(const EnfDbvWheel *wheel, int64_t limit) {
    for (uint32_t level = 0; level < ENF_DBV_LEVELS; level++) {
        uint32_t shift = BITS * level;
        uint32_t here = (uint32_t)((uint64_t)wheel->now >> shift & MASK);
        uint32_t slot = next_occupied(wheel, level, here);
        if (slot < ENF_DBV_SLOTS) {
            int64_t turn = (int64_t)((uint64_t)wheel->now >> (shift + BITS) << (shift + BITS));
            int64_t stop = turn + ((int64_t)slot << shift);
            return stop < limit ? stop : limit;
        }
    }
    if (wheel->heads[ENF_DBV_WAITING] == ENF_NONE) {
        return limit;
    }
    uint32_t shift = BITS * ENF_DBV_LEVELS;
    int64_t stop = (int64_t)(((uint64_t)wheel->now >> shift) + 1) << shift;
    return stop < limit ? stop : limit;
}

/* Empties a slot: what is due goes to the list, the rest is added again, to finer slots. */
static bool take_slot(EnfDbvIndex *index, uint32_t slot) {
    uint32_t object = index->wheel.heads[slot];
    empty_slot(&index->wheel, slot);
    bool ok = true;
    while (object != ENF_NONE) {
        EnfDbvVolume *volume = &index->volumes[object];
        uint32_t next = volume->wheel_next;
        volume->wheel_slot = ENF_DBV_NO_SLOT;
        if (volume->expiry_tick > index->wheel.now) {
            enf_dbv_wheel_add(index, object);
        } else {
            ok = enf_dbv_list_add(index, &index->due, object) && ok;
        }
        object = next;
    }
    return ok;
}

static bool earlier(const EnfDbvIndex *index, uint32_t a, uint32_t b) {
    int64_t x = index->volumes[a].expiry_tick;
    int64_t y = index->volumes[b].expiry_tick;
    return x != y ? x < y : a < b;
}

bool enf_dbv_wheel_advance(EnfDbvIndex *index, int64_t tick) {
    EnfDbvWheel *wheel = &index->wheel;
    bool ok = true;
    while (wheel->now < tick) {
        int64_t stop = next_stop(wheel, tick);
        int64_t before = wheel->now;
        wheel->now = stop;
        /* Coarse slots that begin now are emptied first: they may hold what is due at this very tick. */
        if ((uint64_t)stop >> (BITS * ENF_DBV_LEVELS) != (uint64_t)before >> (BITS * ENF_DBV_LEVELS)) {
            ok = take_slot(index, ENF_DBV_WAITING) && ok;
        }
        for (uint32_t level = ENF_DBV_LEVELS; level > 0; level--) {
            uint32_t shift = BITS * (level - 1);
            if ((uint64_t)stop >> shift != (uint64_t)before >> shift) {
                uint32_t slot = (level - 1) * ENF_DBV_SLOTS + (uint32_t)((uint64_t)stop >> shift & MASK);
                if (index->wheel.heads[slot] != ENF_NONE) {
                    ok = take_slot(index, slot) && ok;
                }
            }
        }
    }
    enf_dbv_sort(index, &index->due, earlier);
    return ok;
}
