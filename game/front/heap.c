/* Counts the heap calls of our own code (not of SDL or the driver), where the linker sends them here (--wrap; see the build). */
#include "front/heap.h"

#include <stdatomic.h>
#include <stddef.h>

static atomic_ulong calls;

unsigned long heap_calls(void) {
    return atomic_load(&calls);
}

#ifdef ENF_COUNT_HEAP
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);

void *__wrap_malloc(size_t size) {
    atomic_fetch_add(&calls, 1);
    return __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size) {
    atomic_fetch_add(&calls, 1);
    return __real_calloc(count, size);
}

void *__wrap_realloc(void *block, size_t size) {
    atomic_fetch_add(&calls, 1);
    return __real_realloc(block, size);
}
#endif
