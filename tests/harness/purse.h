/* An allocator that keeps accounts and fails when its budget is used up: what a failing malloc does at each place. */
#ifndef ENF_TESTS_PURSE_H
#define ENF_TESTS_PURSE_H

#include <enfilade/base.h>
#include <stdlib.h>
#include <string.h>

#include "harness/harness.h"

/* `lent`: bytes out now; `budget`: calls that will still be served. */
typedef struct Purse {
    size_t lent;
    int budget;
} Purse;

static void *purse_resize(void *user, void *block, size_t old_size, size_t new_size) {
    Purse *purse = user;
    if (new_size > 0 && purse->budget-- <= 0) {
        return NULL;
    }
    purse->lent += new_size - old_size;
    if (new_size == 0) {
        free(block);
        return NULL;
    }
    void *moved = malloc(new_size); /* always elsewhere, and full of rubbish */
    assert_non_null(moved);
    memset(moved, 0xa5, new_size);
    if (block) {
        memcpy(moved, block, old_size < new_size ? old_size : new_size);
        free(block);
    }
    return moved;
}

#endif
