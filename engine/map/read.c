/* Bytes → EnfMap: header, chunk table, checksums; then enf_map_check. Nothing in the bytes is trusted: offsets are not followed but
 * compared with the only ones that the counts allow. */
#include "map/map_internal.h"

#include <string.h>

/* 8 GiB: twice what the largest chunk, pixels, can address. */
#define MAP_SIZE_MAX (UINT64_C(1) << 33)

static EnfResult read_header(EnfMap *map, EnfCursor *cursor, EnfError *error) {
    const uint8_t *magic = enf_cursor_bytes(cursor, sizeof enf_map_magic);
    uint32_t version = enf_cursor_u32(cursor), endian = enf_cursor_u32(cursor);
    uint64_t size = enf_cursor_u64(cursor);
    map->source_hash = enf_cursor_u64(cursor);
    map->hash = enf_cursor_u64(cursor);
    uint32_t chunk_count = enf_cursor_u32(cursor);
    if (magic && memcmp(magic, enf_map_magic, sizeof enf_map_magic) != 0) {
        return enf_error_set(error, ENF_ERROR_MAGIC, ENF_MAP_AT_MAGIC, "header: not an Enfilade map");
    }
    if (cursor->size < ENF_MAP_FRONT_SIZE) {
        return enf_error_set(error, ENF_ERROR_TRUNCATED, cursor->size, "header: %zu bytes are too few for a map", cursor->size);
    }
    if (version != ENF_MAP_VERSION) {
        return enf_error_set(error, ENF_ERROR_VERSION, ENF_MAP_AT_VERSION,
                             "header.version: %u, but this engine reads version %d; compile the level again", version,
                             ENF_MAP_VERSION);
    }
    if (endian != ENF_MAP_ENDIAN) {
        return enf_error_set(error, ENF_ERROR_FORMAT, ENF_MAP_AT_ENDIAN, "header.endian: 0x%08x, not little-endian", endian);
    }
    if (chunk_count != ENF_MAP_CHUNK_COUNT) {
        return enf_error_set(error, ENF_ERROR_FORMAT, ENF_MAP_AT_CHUNK_COUNT, "header.chunk_count: %u instead of %d",
                             chunk_count, ENF_MAP_CHUNK_COUNT);
    }
    if (size != cursor->size) {
        return enf_error_set(error, size > cursor->size ? ENF_ERROR_TRUNCATED : ENF_ERROR_FORMAT, ENF_MAP_AT_FILE_SIZE,
                             "header.file_size: %llu, but there are %zu bytes", (unsigned long long)size, cursor->size);
    }
    return ENF_OK;
}

static EnfResult check_front(const uint8_t *data, EnfError *error) {
    static const uint8_t zeros[ENF_MAP_HEADER_SIZE - ENF_MAP_AT_RESERVED];
    uint8_t front[ENF_MAP_FRONT_SIZE];
    memcpy(front, data, sizeof front);
    EnfCursor stored = enf_cursor(data + ENF_MAP_AT_CRC_HEADER, 4);
    memset(front + ENF_MAP_AT_CRC_HEADER, 0, 4);
    if (enf_crc32c(0, front, sizeof front) != enf_cursor_u32(&stored)) {
        return enf_error_set(error, ENF_ERROR_CHECKSUM, ENF_MAP_AT_CRC_HEADER, "header.crc: header or chunk table is damaged");
    }
    if (memcmp(front + ENF_MAP_AT_RESERVED, zeros, sizeof zeros) != 0) {
        return enf_error_set(error, ENF_ERROR_FORMAT, ENF_MAP_AT_RESERVED, "header.reserved: not zero");
    }
    return ENF_OK;
}

/* One entry of the table against the only place the chunk can have; `*end` is where the one before ended. */
static EnfResult read_chunk(EnfMap *map, EnfMapChunkId id, EnfCursor *table, uint64_t *end, EnfError *error) {
    const EnfMapChunkInfo *info = &enf_map_chunk_info[id];
    const size_t entry = table->offset;
    const uint8_t *fourcc = enf_cursor_bytes(table, 4);
    uint32_t record_size = enf_cursor_u32(table);
    uint64_t offset = enf_cursor_u64(table);
    uint32_t count = enf_cursor_u32(table), crc = enf_cursor_u32(table);
    if (!fourcc || memcmp(fourcc, info->fourcc, 4) != 0) {
        return enf_error_set(error, ENF_ERROR_FORMAT, entry, "chunk %d: is not %s", id, info->fourcc);
    }
    if (record_size != info->record_size) {
        return enf_error_set(error, ENF_ERROR_FORMAT, entry + 4, "chunk %s: record_size: %u instead of %u", info->fourcc,
                             record_size, info->record_size);
    }
    uint64_t start = (*end + ENF_MAP_ALIGN - 1) & ~(uint64_t)(ENF_MAP_ALIGN - 1);
    if (offset != start) {
        return enf_error_set(error, ENF_ERROR_FORMAT, entry + 8, "chunk %s: offset: %llu instead of %llu", info->fourcc,
                             (unsigned long long)offset, (unsigned long long)start);
    }
    uint64_t size = (uint64_t)count * record_size;
    if (start > table->size || size > table->size - start) {
        return enf_error_set(error, ENF_ERROR_TRUNCATED, entry + 16, "chunk %s: count: %u records reach beyond the file",
                             info->fourcc, count);
    }
    if (id == ENF_CHUNK_origin && count != 1) {
        return enf_error_set(error, ENF_ERROR_FORMAT, entry + 16, "chunk %s: count: %u instead of 1", info->fourcc, count);
    }
    for (uint64_t i = *end; i < start; i++) {
        if (table->data[i]) {
            return enf_error_set(error, ENF_ERROR_FORMAT, i, "chunk %s: the padding before it is not zero", info->fourcc);
        }
    }
    if (enf_crc32c(0, table->data + start, (size_t)size) != crc) {
        return enf_error_set(error, ENF_ERROR_CHECKSUM, start, "chunk %s: its bytes differ from their checksum", info->fourcc);
    }
    enf_map_chunk_set(map, id, table->data + start, count);
    *end = start + size;
    return ENF_OK;
}

static EnfResult read_chunks(EnfMap *map, const void *data, size_t size, EnfError *error) {
    EnfCursor cursor = enf_cursor(data, size);
    EnfResult result = read_header(map, &cursor, error);
    if (result == ENF_OK) {
        result = check_front(data, error);
    }
    cursor = enf_cursor(data, size);
    enf_cursor_bytes(&cursor, ENF_MAP_HEADER_SIZE);
    uint64_t end = ENF_MAP_FRONT_SIZE;
    for (int id = 0; result == ENF_OK && id < ENF_MAP_CHUNK_COUNT; id++) {
        result = read_chunk(map, (EnfMapChunkId)id, &cursor, &end, error);
    }
    if (result == ENF_OK && end != size) {
        result = enf_error_set(error, ENF_ERROR_FORMAT, end, "%llu bytes follow the last chunk",
                               (unsigned long long)(size - end));
    }
    if (result == ENF_OK && enf_map_content_hash(map) != map->hash) {
        result = enf_error_set(error, ENF_ERROR_CHECKSUM, ENF_MAP_AT_HASH, "header.hash: differs from the content");
    }
    return result;
}

/* `allocator`: for the check's scratch memory. */
static EnfResult view(EnfMap *map, EnfSpan bytes, const EnfAllocator *allocator, EnfError *error) {
    memset(map, 0, sizeof *map);
    if (!bytes.data || (uintptr_t)bytes.data % ENF_MAP_ALIGN != 0) {
        return enf_error_set(error, ENF_ERROR_ARGUMENT, UINT64_MAX, "a map's bytes must be 16-byte aligned");
    }
    map->file.allocator = allocator;
    EnfResult result = read_chunks(map, bytes.data, bytes.size, error);
    if (result == ENF_OK) {
        result = enf_map_check(map, error);
    }
    if (result != ENF_OK) {
        memset(map, 0, sizeof *map);
    }
    return result;
}

EnfResult enf_map_view(EnfMap *map, const void *data, size_t size, EnfError *error) {
    return view(map, (EnfSpan){data, size}, NULL, error);
}

EnfResult enf_map_read(EnfMap *map, const char *path, const EnfAllocator *allocator, EnfError *error) {
    memset(map, 0, sizeof *map);
    EnfFile file = {NULL, 0, allocator};
    size_t limit = MAP_SIZE_MAX < SIZE_MAX ? (size_t)MAP_SIZE_MAX : SIZE_MAX;
    EnfResult result = enf_file_read(&file, path, limit, allocator, error);
    if (result != ENF_OK) {
        return enf_error_file(error, result, path);
    }
    if (file.size == 0) {
        result = enf_error_set(error, ENF_ERROR_TRUNCATED, 0, "the file is empty");
    } else {
        result = view(map, (EnfSpan){file.data, file.size}, allocator, error);
    }
    if (result != ENF_OK) {
        enf_file_free(&file);
        return enf_error_file(error, result, path);
    }
    map->file = file;
    return ENF_OK;
}

void enf_map_free(EnfMap *map) {
    enf_file_free(&map->file);
    memset(map, 0, sizeof *map);
}
