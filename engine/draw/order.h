/* Sorting without the heap: keys are distinct through their second field, so there is one order only. */
#ifndef ENFILADE_DRAW_ORDER_H
#define ENFILADE_DRAW_ORDER_H

#include <enfilade/base.h>

/** Ascending by `key`, ties by `index`. */
typedef struct EnfDrawKey {
    uint64_t key;
    uint32_t index;
} EnfDrawKey;

/** Heap sort in place. @cost O(n log n), no memory. */
void enf_draw_sort(EnfDrawKey *keys, uint32_t count);

/** A key that ascends as `distance2` (≥ 0, not a NaN) descends: back to front. */
uint64_t enf_draw_far_first(double distance2);

#endif
