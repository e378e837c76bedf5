/* Disjoint sets over 0..n-1 as an array of parents (Tarjan 1975, path halving); a set's root is its smallest member, so results do not
 * depend on the order of joins. The caller sets parents[i] = i first. */
#ifndef ENFILADE_COMPILE_UNION_FIND_H
#define ENFILADE_COMPILE_UNION_FIND_H

#include <stdint.h>

/** The root of i's set. */
static inline uint32_t enf_sets_find(uint32_t *parents, uint32_t i) {
    while (parents[i] != i) {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    return i;
}

/** Makes one set of those of a and b. */
static inline void enf_sets_join(uint32_t *parents, uint32_t a, uint32_t b) {
    a = enf_sets_find(parents, a);
    b = enf_sets_find(parents, b);
    parents[a > b ? a : b] = a < b ? a : b;
}

#endif
