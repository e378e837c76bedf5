/* Counts the heap calls of our own code (not of SDL or the driver), where the linker sends them here (--wrap; see the build). */
#include "front/heap.h"

#include <stdatomic.h>
#include <stddef.h>

static atomic_ulong calls;
static atomic_llong live;

unsigned long heap_calls(void) {
    return atomic_load(&calls);
}

long long heap_live(void) {
    return atomic_load(&live);
}

#ifdef ENF_COUNT_HEAP
size_t malloc_usable_size(void *block); /* glibc, musl */
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
void __real_free(void *block);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);
void __wrap_free(void *block);

static long long size_of(void *block) {
    return block ? (long long)malloc_usable_size(block) : 0;
}

static void *counted(void *block) {
    atomic_fetch_add(&calls, 1);
    atomic_fetch_add(&live, size_of(block));
    return block;
}

void *__wrap_malloc(size_t size) {
    return counted(__real_malloc(size));
}

void *__wrap_calloc(size_t count, size_t size) {
    return counted(__real_calloc(count, size));
}

void *__wrap_realloc(void *block, size_t size) {
    long long before = size_of(block);
    void *made = __real_realloc(block, size);
    if (made || size == 0) {
        atomic_fetch_sub(&live, before);
    }
    return counted(made);
}

void __wrap_free(void *block) {
    atomic_fetch_sub(&live, size_of(block));
    __real_free(block);
}
#endif
