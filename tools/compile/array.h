/* Growing arrays of the compiler. */
#ifndef ENFILADE_COMPILE_ARRAY_H
#define ENFILADE_COMPILE_ARRAY_H

#include <enfilade/base.h>

#include <stdlib.h>
#include <string.h>

/** A typed growing array of malloc's; zero-initialise, free(array.data) at the end. */
#define ENF_ARRAY(Type)                                                                                                        \
    struct {                                                                                                                   \
        Type *data;                                                                                                            \
        uint32_t count, capacity;                                                                                              \
    }

/** Room for `extra` more in `array` (the address of an ENF_ARRAY): false, and no change, when out of memory. */
#define ENF_ARRAY_ROOM(array, extra)                                                                                           \
    enf_array_reserve(&(array)->data, &(array)->capacity, (uint64_t)(array)->count + (extra), sizeof *(array)->data)

/** The elements from `first` on; NULL for an array that never grew (NULL + 0 is undefined in C). */
#define ENF_ARRAY_FROM(array, first) ((array)->data ? (array)->data + (first) : NULL)

/** Makes the block whose pointer lies at `pointer` hold at least `needed` elements of `size` bytes; at least doubles. No more
 *  than 2^31 elements. The pointer is copied as bytes: its own type is the caller's. */
static inline bool enf_array_reserve(void *pointer, uint32_t *capacity, uint64_t needed, size_t size) {
    if (needed <= *capacity) {
        return true;
    }
    const uint64_t most = (uint64_t)1 << 31;
    uint64_t wanted = needed > (uint64_t)*capacity * 2 ? needed : (uint64_t)*capacity * 2;
    wanted = wanted < 16 ? 16 : wanted;
    wanted = wanted > most && needed <= most ? most : wanted;
    void *block;
    memcpy(&block, pointer, sizeof block);
    void *grown = wanted <= most ? realloc(block, (size_t)wanted * size) : NULL;
    if (!grown) {
        return false;
    }
    memcpy(pointer, &grown, sizeof grown);
    *capacity = (uint32_t)wanted;
    return true;
}

#endif
