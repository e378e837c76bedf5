/* The allocator, the arena and checked sizes: every byte that the engine takes passes here, and no product of sizes
 * overflows unseen. */
#if defined(__linux__) && !defined(_DEFAULT_SOURCE)
#define _DEFAULT_SOURCE /* madvise */
#endif

#include <enfilade/base.h>

#include <stdlib.h>
#include <string.h>

#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif

/* Boxes and SIMD blocks in an arena start on whole AVX registers. */
enum { ARENA_ALIGN = 32 };

/* ---- checked sizes ---------------------------------------------------------------------------------------------- */

bool enf_size_add(size_t a, size_t b, size_t *out) {
    bool fits = b <= SIZE_MAX - a;
    *out = fits ? a + b : SIZE_MAX;
    return fits;
}

bool enf_size_mul(size_t a, size_t b, size_t *out) {
    bool fits = b == 0 || a <= SIZE_MAX / b;
    *out = fits ? a * b : SIZE_MAX;
    return fits;
}

/* ---- allocator -------------------------------------------------------------------------------------------------- */

/* Blocks of so many bytes hold records that are asked for here and there: in pages of 4 KiB, finding the page costs more than the
 * record itself. */
enum { LARGE_BLOCK = 2 << 20 };

/* Asks the system for large pages, where it leaves that to programs; a hint, which changes no byte of the pages at both ends either. */
static void *on_large_pages(void *block, size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    if (block != NULL && bytes >= LARGE_BLOCK) {
        size_t before = (uintptr_t)block & ((size_t)sysconf(_SC_PAGESIZE) - 1);
        (void)madvise((char *)block - before, bytes + before, MADV_HUGEPAGE);
    }
#else
    (void)bytes;
#endif
    return block;
}

static void *resize_with_libc(void *user, void *block, size_t old_size, size_t new_size) {
    (void)user;
    (void)old_size;
    if (new_size == 0) {
        free(block);
        return NULL;
    }
    return on_large_pages(realloc(block, new_size), new_size);
}

const EnfAllocator *enf_default_allocator(void) {
    static const EnfAllocator libc = {resize_with_libc, NULL};
    return &libc;
}

static const EnfAllocator *or_default(const EnfAllocator *allocator) {
    return allocator ? allocator : enf_default_allocator();
}

void *enf_alloc(const EnfAllocator *allocator, size_t count, size_t size) {
    size_t bytes;
    if (!enf_size_mul(count, size, &bytes) || bytes == 0) {
        return NULL;
    }
    allocator = or_default(allocator);
    if (allocator->resize == resize_with_libc) {
        /* Fresh pages are zero already: a large block is not touched here. */
        return on_large_pages(calloc(1, bytes), bytes);
    }
    void *block = allocator->resize(allocator->user, NULL, 0, bytes);
    return block ? memset(block, 0, bytes) : NULL;
}

void *enf_realloc(const EnfAllocator *allocator, void *block, size_t old_count, size_t new_count, size_t size) {
    size_t bytes;
    if (!enf_size_mul(new_count, size, &bytes)) {
        return NULL;
    }
    allocator = or_default(allocator);
    /* A block's own size was checked when it was made. */
    return allocator->resize(allocator->user, block, old_count * size, bytes);
}

void enf_free(const EnfAllocator *allocator, void *block, size_t count, size_t size) {
    if (block) {
        allocator = or_default(allocator);
        allocator->resize(allocator->user, block, count * size, 0);
    }
}

/* ---- arena ------------------------------------------------------------------------------------------------------ */

EnfResult enf_arena_create(EnfArena *arena, size_t size, const EnfAllocator *allocator, EnfError *error) {
    *arena = (EnfArena){NULL, 0, 0, or_default(allocator)};
    if (size == 0) {
        return ENF_OK;
    }
    arena->base = enf_realloc(arena->allocator, NULL, 0, size, 1);
    if (!arena->base) {
        arena->allocator = NULL;
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for an arena of %zu bytes", size);
    }
    arena->size = size;
    return ENF_OK;
}

void enf_arena_destroy(EnfArena *arena) {
    if (arena->allocator) {
        enf_free(arena->allocator, arena->base, arena->size, 1);
    }
    *arena = (EnfArena){NULL, 0, 0, NULL};
}

void *enf_arena_push(EnfArena *arena, size_t count, size_t size) {
    size_t bytes, end;
    if (!arena->base || !enf_size_mul(count, size, &bytes)) {
        return NULL;
    }
    /* Aligned by address, not by offset: the block itself may be aligned to 16 only. */
    size_t padding = (size_t)(-((uintptr_t)arena->base + arena->used) & (ARENA_ALIGN - 1));
    if (!enf_size_add(bytes, arena->used, &end) || !enf_size_add(end, padding, &end) || end > arena->size) {
        return NULL;
    }
    void *block = arena->base + arena->used + padding;
    arena->used = end;
    return block;
}
