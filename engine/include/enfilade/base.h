/* Results and errors, allocator, arena, hashes, checked sizes, cursor reader, atomic file write.
 *
 * Three kinds of fault, never mixed (DESIGN §7): a caller's bug is ENF_ASSERT; bad data or a failing system is an
 * EnfResult with an EnfError; an impossible state is ENF_VALIDATE. Nothing in the engine exits or aborts on data. */
#ifndef ENFILADE_BASE_H
#define ENFILADE_BASE_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __FAST_MATH__
#error "Enfilade is exact about floating point: build without -ffast-math"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** No index: the null of every u32 record reference. */
#define ENF_NONE UINT32_MAX

/* ---- results ---------------------------------------------------------------------------------------------------- */

/** The catalogue of errors: X(name, text). One table drives the enum, enf_result_text and the tests. */
#define ENF_RESULTS(X)                                                                                                         \
    X(OK, "no error")                                                                                                          \
    X(ERROR_MEMORY, "out of memory")                                                                                           \
    X(ERROR_IO, "file cannot be read or written")                                                                              \
    X(ERROR_SIZE, "a size or count is too large")                                                                              \
    X(ERROR_TRUNCATED, "data ends too early")                                                                                  \
    X(ERROR_MAGIC, "not a file of this kind")                                                                                  \
    X(ERROR_VERSION, "a version this engine does not read")                                                                    \
    X(ERROR_CHECKSUM, "checksum differs: the file is damaged")                                                                 \
    X(ERROR_FORMAT, "malformed data")                                                                                          \
    X(ERROR_INDEX, "an index points outside its table")                                                                        \
    X(ERROR_RANGE, "a value is outside its range")                                                                             \
    X(ERROR_UNSUPPORTED, "a required feature is not supported")                                                                \
    X(ERROR_ARGUMENT, "bad argument")                                                                                          \
    X(ERROR_LEVEL, "no map can be made from this level")                                                                       \
    X(ERROR_CONTEXT, "no OpenGL context")                                                                                      \
    X(ERROR_SHADER, "a shader does not compile or link")

typedef enum EnfResult {
#define ENF_RESULT_ENUM(name, text) ENF_##name,
    ENF_RESULTS(ENF_RESULT_ENUM)
#undef ENF_RESULT_ENUM
        ENF_RESULT_COUNT
} EnfResult;

/** What went wrong and where. Filled by a failing function, untouched by a succeeding one. */
typedef struct EnfError {
    EnfResult code;
    uint64_t offset;   /**< byte offset in `file`, or UINT64_MAX where there is none */
    char file[256];    /**< file name, or "" */
    char message[512]; /**< one sentence naming node, field or value */
} EnfError;

/** The catalogue text of `result`; never NULL. */
const char *enf_result_text(EnfResult result);

/** Fills `error` (which may be NULL) and returns `code`. `format` as printf. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
EnfResult
enf_error_set(EnfError *error, EnfResult code, uint64_t offset, const char *format, ...);

/** Records the file name in `error` (which may be NULL) if it has none. Returns `code`. */
EnfResult enf_error_file(EnfError *error, EnfResult code, const char *file);

/* ---- assertions ------------------------------------------------------------------------------------------------- */

/** Called by a failing ENF_ASSERT or ENF_VALIDATE; the default prints to stderr and traps. NULL restores it. */
typedef void EnfAssertFn(const char *expression, const char *file, int line);
void enf_set_assert_handler(EnfAssertFn *handler);
void enf_assert_failed(const char *expression, const char *file, int line);

#if defined(NDEBUG) && !defined(ENF_ASSERTS)
#define ENF_ASSERT(expression) ((void)sizeof(!(expression)))
#else
#define ENF_ASSERT(expression) ((expression) ? (void)0 : enf_assert_failed(#expression, __FILE__, __LINE__))
#endif
/** Heavy self-checks of invariants; on in the dev preset. */
#ifdef ENF_VALIDATION
#define ENF_VALIDATE(expression) ENF_ASSERT(expression)
#else
#define ENF_VALIDATE(expression) ((void)sizeof(!(expression)))
#endif

/* ---- memory ----------------------------------------------------------------------------------------------------- */

/** The caller's memory. `resize(user, NULL, 0, n)` allocates, `resize(user, p, n, 0)` frees and returns NULL; a failure
 *  returns NULL and leaves the old block. Blocks are aligned for any type up to 16 bytes. */
typedef struct EnfAllocator {
    void *(*resize)(void *user, void *block, size_t old_size, size_t new_size);
    void *user;
} EnfAllocator;

/** The C library's malloc, realloc and free. */
const EnfAllocator *enf_default_allocator(void);

/** `allocator` or the default for NULL; count * size checked; zeroed. NULL on overflow or exhaustion, or if 0 bytes. */
void *enf_alloc(const EnfAllocator *allocator, size_t count, size_t size);
/** Grows or shrinks; the content is kept, a grown tail is not zeroed. NULL leaves `block` as it was. */
void *enf_realloc(const EnfAllocator *allocator, void *block, size_t old_count, size_t new_count, size_t size);
void enf_free(const EnfAllocator *allocator, void *block, size_t count, size_t size);

/** A bump allocator over one block; freed or reset as a whole. */
typedef struct EnfArena {
    uint8_t *base;
    size_t size, used;
    const EnfAllocator *allocator; /**< owner of base, or NULL where the caller owns it */
} EnfArena;

EnfResult enf_arena_create(EnfArena *arena, size_t size, const EnfAllocator *allocator, EnfError *error);
void enf_arena_destroy(EnfArena *arena);
/** `count * size` bytes aligned to 32, not zeroed; NULL when full (the arena never grows). */
void *enf_arena_push(EnfArena *arena, size_t count, size_t size);

/** Checked arithmetic: false on overflow, and then *out is SIZE_MAX. */
bool enf_size_add(size_t a, size_t b, size_t *out);
bool enf_size_mul(size_t a, size_t b, size_t *out);

/* ---- hashes ----------------------------------------------------------------------------------------------------- */

/** CRC-32C (Castagnoli, reflected), continuing from `crc`; start with 0. */
uint32_t enf_crc32c(uint32_t crc, const void *data, size_t size);
/** A 64-bit hash for results and caches (not for secrets), continuing from `hash`; start with ENF_HASH_START. Equal on
 *  every machine for the same bytes. */
#define ENF_HASH_START UINT64_C(0xcbf29ce484222325)
uint64_t enf_hash64(uint64_t hash, const void *data, size_t size);

/* ---- reading ---------------------------------------------------------------------------------------------------- */

/** A sticky reader: after the first failure every read yields zero, and `failed` and `offset` tell where it began. */
typedef struct EnfCursor {
    const uint8_t *data;
    size_t size, offset;
    bool failed;
} EnfCursor;

EnfCursor enf_cursor(const void *data, size_t size);
const uint8_t *enf_cursor_bytes(EnfCursor *cursor, size_t size); /**< NULL on failure */
uint8_t enf_cursor_u8(EnfCursor *cursor);
uint32_t enf_cursor_u32(EnfCursor *cursor); /**< little-endian */
uint64_t enf_cursor_u64(EnfCursor *cursor);
float enf_cursor_f32(EnfCursor *cursor);
double enf_cursor_f64(EnfCursor *cursor);

/* ---- files ------------------------------------------------------------------------------------------------------ */

/** A whole file in memory (allocator's; free with enf_file_free). Refuses more than `max_size` bytes. */
typedef struct EnfFile {
    uint8_t *data;
    size_t size;
    const EnfAllocator *allocator;
} EnfFile;

EnfResult enf_file_read(EnfFile *file, const char *path, size_t max_size, const EnfAllocator *allocator, EnfError *error);
void enf_file_free(EnfFile *file);

/** A span of bytes to write. */
typedef struct EnfSpan {
    const void *data;
    size_t size;
} EnfSpan;

/** Writes the spans to a temporary beside `path`, fsyncs, and renames: either the old file or the whole new one exists. */
EnfResult enf_file_write(const char *path, const EnfSpan *spans, size_t span_count, EnfError *error);

/** A file that grows while its writer lives: bytes go to `path`.part and are with the system when enf_stream_write returns,
 *  so they outlive a crash of this process (not one of the machine); enf_stream_finish makes them `path`, durably. What is no
 *  regular file (a pipe, a terminal) is written in place. */
typedef struct EnfStream EnfStream;

/** Errors: ENF_ERROR_MEMORY, ENF_ERROR_IO; `*stream` is then NULL. `allocator` may be NULL. */
EnfResult enf_stream_create(EnfStream **stream, const char *path, const EnfAllocator *allocator, EnfError *error);
/** Appends. After an error `path`.part may end with a part of `data`. No heap call. */
EnfResult enf_stream_write(EnfStream *stream, const void *data, size_t size, EnfError *error);
/** Flushes to the disk, closes and renames; afterwards the stream can only be destroyed. After an error `path` is as it was
 *  and `path`.part is left (but for an error that says that it was renamed). */
EnfResult enf_stream_finish(EnfStream *stream, EnfError *error);
/** Closes and frees. A stream that was not finished leaves `path`.part there, or removes it if not `keep`. NULL is allowed. */
void enf_stream_destroy(EnfStream *stream, bool keep);

/* ---- log -------------------------------------------------------------------------------------------------------- */

typedef enum EnfLogLevel { ENF_LOG_INFO, ENF_LOG_WARNING, ENF_LOG_ERROR } EnfLogLevel;
typedef void EnfLogFn(void *user, EnfLogLevel level, const char *message);
/** Where messages go; NULL is silence (the default). Set before threads start. */
void enf_set_log(EnfLogFn *log, void *user);
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void enf_log(EnfLogLevel level, const char *format, ...);

#ifdef __cplusplus
}
#endif
#endif
