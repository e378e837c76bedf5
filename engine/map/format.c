/* The format's table, and the file: EnfMap → bytes. Reading is read.c. */
#include "map/map_internal.h"

#include <string.h>

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "A map's records are used as they lie in the file: a big-endian machine needs a converting reader"
#endif

/* Records are the file's layout: no padding, 8-byte fields first. */
_Static_assert(sizeof(EnfCell) == 112, "EnfCell");
_Static_assert(sizeof(EnfPortal) == 32, "EnfPortal");
_Static_assert(sizeof(EnfTransform) == 96, "EnfTransform");
_Static_assert(sizeof(EnfCluster) == 56, "EnfCluster");
_Static_assert(sizeof(EnfVertex) == 32, "EnfVertex");
_Static_assert(sizeof(EnfMaterial) == 88, "EnfMaterial");
_Static_assert(sizeof(EnfTexture) == 20, "EnfTexture");
_Static_assert(sizeof(EnfImage) == 16, "EnfImage");
_Static_assert(sizeof(EnfLight) == 72, "EnfLight");
_Static_assert(sizeof(EnfLightRef) == 12, "EnfLightRef");
_Static_assert(sizeof(EnfEntity) == 80, "EnfEntity");
_Static_assert(sizeof(EnfPath) == 24, "EnfPath");
_Static_assert(sizeof(EnfMesh) == 40, "EnfMesh");
_Static_assert(sizeof(EnfMeshPart) == 24, "EnfMeshPart");
_Static_assert(sizeof(EnfMover) == 104, "EnfMover");
_Static_assert(sizeof(EnfKdNode) == 32, "EnfKdNode");
_Static_assert(sizeof(EnfKdBlock) == 224, "EnfKdBlock");

const uint8_t enf_map_magic[8] = {'E', 'N', 'F', 'M', 'A', 'P', '\r', '\n'};

const EnfMapChunkInfo enf_map_chunk_info[ENF_MAP_CHUNK_COUNT] = {
#define ENF_MAP_CHUNK_INFO(type, array, fourcc)                                                                                \
    {fourcc, #array, (uint32_t)sizeof(type), offsetof(EnfMap, array), offsetof(EnfMap, array##_count)},
    ENF_MAP_CHUNKS(ENF_MAP_CHUNK_INFO)
#undef ENF_MAP_CHUNK_INFO
        {"ORIG", "tree_origin", (uint32_t)sizeof(double[3]), 0, 0}};

EnfMapChunk enf_map_chunk(const EnfMap *map, EnfMapChunkId id) {
    const EnfMapChunkInfo *info = &enf_map_chunk_info[id];
    EnfMapChunk chunk = {map->tree_origin, 1, info->record_size};
    if (id != ENF_CHUNK_origin) {
        memcpy(&chunk.data, (const char *)map + info->array_at, sizeof chunk.data);
        memcpy(&chunk.count, (const char *)map + info->count_at, sizeof chunk.count);
        chunk.size = (size_t)chunk.count * info->record_size;
    }
    return chunk;
}

void enf_map_chunk_set(EnfMap *map, EnfMapChunkId id, const void *data, uint32_t count) {
    const EnfMapChunkInfo *info = &enf_map_chunk_info[id];
    if (id == ENF_CHUNK_origin) {
        memcpy(map->tree_origin, data, sizeof map->tree_origin);
        return;
    }
    memcpy((char *)map + info->array_at, &data, sizeof data);
    memcpy((char *)map + info->count_at, &count, sizeof count);
}

uint64_t enf_map_offsets(const EnfMap *map, uint64_t offsets[ENF_MAP_CHUNK_COUNT]) {
    uint64_t at = ENF_MAP_FRONT_SIZE;
    for (int id = 0; id < ENF_MAP_CHUNK_COUNT; id++) {
        EnfMapChunk chunk = enf_map_chunk(map, (EnfMapChunkId)id);
        /* Counts are 32 bits and records at most 224 bytes: 28 chunks stay far below 2^64. */
        at = (at + ENF_MAP_ALIGN - 1) & ~(uint64_t)(ENF_MAP_ALIGN - 1);
        offsets[id] = at;
        at += (uint64_t)chunk.count * enf_map_chunk_info[id].record_size;
    }
    return at;
}

/* ---- writing ---------------------------------------------------------------------------------------------------- */

static void put_u32(uint8_t *to, uint32_t value) {
    for (int i = 0; i < 4; i++) {
        to[i] = (uint8_t)(value >> (8 * i));
    }
}

static void put_u64(uint8_t *to, uint64_t value) {
    put_u32(to, (uint32_t)value);
    put_u32(to + 4, (uint32_t)(value >> 32));
}

uint64_t enf_map_content_hash(const EnfMap *map) {
    uint64_t hash = ENF_HASH_START;
    for (int id = 0; id < ENF_MAP_CHUNK_COUNT; id++) {
        EnfMapChunk chunk = enf_map_chunk(map, (EnfMapChunkId)id);
        hash = enf_hash64(hash, enf_map_chunk_info[id].fourcc, 4);
        hash = enf_hash64(hash, chunk.data, chunk.size);
    }
    return hash;
}

/* Header and chunk table. */
static void put_front(uint8_t front[ENF_MAP_FRONT_SIZE], const EnfMap *map, const uint64_t *offsets, uint64_t size) {
    memset(front, 0, ENF_MAP_FRONT_SIZE);
    memcpy(front + ENF_MAP_AT_MAGIC, enf_map_magic, sizeof enf_map_magic);
    put_u32(front + ENF_MAP_AT_VERSION, ENF_MAP_VERSION);
    put_u32(front + ENF_MAP_AT_ENDIAN, ENF_MAP_ENDIAN);
    put_u64(front + ENF_MAP_AT_FILE_SIZE, size);
    put_u64(front + ENF_MAP_AT_SOURCE_HASH, map->source_hash);
    put_u64(front + ENF_MAP_AT_HASH, enf_map_content_hash(map));
    put_u32(front + ENF_MAP_AT_CHUNK_COUNT, ENF_MAP_CHUNK_COUNT);
    for (int id = 0; id < ENF_MAP_CHUNK_COUNT; id++) {
        EnfMapChunk chunk = enf_map_chunk(map, (EnfMapChunkId)id);
        uint8_t *entry = front + ENF_MAP_HEADER_SIZE + ENF_MAP_ENTRY_SIZE * id;
        memcpy(entry, enf_map_chunk_info[id].fourcc, 4);
        put_u32(entry + 4, enf_map_chunk_info[id].record_size);
        put_u64(entry + 8, offsets[id]);
        put_u32(entry + 16, chunk.count);
        put_u32(entry + 20, enf_crc32c(0, chunk.data, chunk.size));
    }
    put_u32(front + ENF_MAP_AT_CRC_HEADER, enf_crc32c(0, front, ENF_MAP_FRONT_SIZE));
}

EnfResult enf_map_write(const EnfMap *map, const char *path, EnfError *error) {
    static const uint8_t zeros[ENF_MAP_ALIGN];
    uint8_t front[ENF_MAP_FRONT_SIZE];
    uint64_t offsets[ENF_MAP_CHUNK_COUNT];
    uint64_t size = enf_map_offsets(map, offsets);
    if (size > SIZE_MAX) {
        enf_error_set(error, ENF_ERROR_SIZE, UINT64_MAX, "the map is too large to write");
        return enf_error_file(error, ENF_ERROR_SIZE, path);
    }
    put_front(front, map, offsets, size);
    EnfSpan spans[1 + 2 * ENF_MAP_CHUNK_COUNT];
    size_t span_count = 0;
    uint64_t at = ENF_MAP_FRONT_SIZE;
    spans[span_count++] = (EnfSpan){front, sizeof front};
    for (int id = 0; id < ENF_MAP_CHUNK_COUNT; id++) {
        EnfMapChunk chunk = enf_map_chunk(map, (EnfMapChunkId)id);
        spans[span_count++] = (EnfSpan){zeros, (size_t)(offsets[id] - at)};
        spans[span_count++] = (EnfSpan){chunk.data, chunk.size};
        at = offsets[id] + chunk.size;
    }
    return enf_file_write(path, spans, span_count, error);
}
