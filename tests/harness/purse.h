/* An allocator that keeps accounts and refuses when its budget is used up: what a failing malloc does at each place. A case that
 * lets memory run out looks at `refused` too: where nothing was refused, nothing was tried. */
#ifndef ENF_TESTS_PURSE_H
#define ENF_TESTS_PURSE_H

#include <enfilade/base.h>
#include <stdlib.h>
#include <string.h>

#include "harness/harness.h"

#define PURSE_FULL UINT32_MAX /* a budget that no suite uses up */

typedef struct Purse {
    size_t lent;      /* bytes out now */
    uint32_t blocks;  /* blocks out now */
    uint32_t budget;  /* calls for memory that will still be served */
    uint32_t calls;   /* calls of any kind so far: for memory, for less of it, to give it back */
    uint32_t refused; /* of them, for want of budget */
    bool once;        /* only the first call beyond the budget is refused: then the purse is full */
} Purse;

static inline Purse purse_with(uint32_t budget) {
    return (Purse){.budget = budget};
}

static inline void *purse_refuse(Purse *purse) {
    purse->refused++;
    purse->budget = purse->once ? PURSE_FULL : 0;
    return NULL;
}

static inline void *purse_free(Purse *purse, void *block, size_t size) {
    assert_true(size <= purse->lent && (block ? purse->blocks > 0 : size == 0));
    purse->lent -= size;
    purse->blocks -= block != NULL;
    free(block);
    return NULL;
}

/* Always elsewhere, and full of rubbish: a pointer kept over a growth, or a byte that nobody wrote, shows. */
static inline void *purse_resize(void *user, void *block, size_t old_size, size_t new_size) {
    Purse *purse = user;
    purse->calls++;
    if (new_size == 0) {
        return purse_free(purse, block, old_size);
    }
    if (purse->budget == 0) {
        return purse_refuse(purse);
    }
    purse->budget -= purse->budget != PURSE_FULL;
    void *moved = malloc(new_size);
    assert_non_null(moved);
#ifdef __has_feature
#if __has_feature(memory_sanitizer)
#define PURSE_KEEPS_UNWRITTEN /* MSan knows which bytes nobody wrote, as long as nobody writes them */
#endif
#endif
#ifndef PURSE_KEEPS_UNWRITTEN
    memset(moved, 0xa5, new_size);
#endif
    purse->lent += new_size;
    purse->blocks++;
    if (block) {
        memcpy(moved, block, old_size < new_size ? old_size : new_size);
        purse_free(purse, block, old_size);
    }
    return moved;
}

/** The purse as the engine's allocator; it stays the caller's, and where it is. */
static inline EnfAllocator purse_allocator(Purse *purse) {
    return (EnfAllocator){purse_resize, purse};
}

/** Fails the case unless all was given back. */
static inline void purse_assert_whole(const Purse *purse) {
    assert_int_equal(purse->lent, 0);
    assert_int_equal(purse->blocks, 0);
}

#endif
