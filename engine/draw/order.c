/* Makes the canonical order of draw lists (PITFALLS 33) from keys of clusters and materials. qsort is not used: it may
 * call the heap, and a warm frame must not. Source: Floyd, Algorithm 245 (Treesort 3), CACM 1964. */
#include "draw/order.h"

#include <string.h>

static bool precedes(EnfDrawKey a, EnfDrawKey b) {
    return a.key != b.key ? a.key < b.key : a.index < b.index;
}

/* Lets keys[root] sink until no child follows it. */
static void sift(EnfDrawKey *keys, uint32_t root, uint32_t count) {
    EnfDrawKey sinking = keys[root];
    for (;;) {
        uint32_t child = 2 * root + 1;
        if (child >= count) {
            break;
        }
        if (child + 1 < count && precedes(keys[child], keys[child + 1])) {
            child++;
        }
        if (!precedes(sinking, keys[child])) {
            break;
        }
        keys[root] = keys[child];
        root = child;
    }
    keys[root] = sinking;
}

void enf_draw_sort(EnfDrawKey *keys, uint32_t count) {
    ENF_ASSERT(keys || count == 0);
    ENF_ASSERT(count <= INT32_MAX);
    for (uint32_t i = count / 2; i-- > 0;) {
        sift(keys, i, count);
    }
    for (uint32_t end = count; end-- > 1;) {
        EnfDrawKey last = keys[0];
        keys[0] = keys[end];
        keys[end] = last;
        sift(keys, 0, end);
    }
}

uint64_t enf_draw_far_first(double distance2) {
    ENF_ASSERT(distance2 >= 0.0);
    /* The bits of non-negative doubles ascend with their values. */
    uint64_t bits;
    memcpy(&bits, &distance2, sizeof bits);
    return ~bits;
}
