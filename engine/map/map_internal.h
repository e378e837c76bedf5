/* The file format as one table, for the reader, the writer, the checker and the tests of this room. */
#ifndef ENF_MAP_MAP_INTERNAL_H
#define ENF_MAP_MAP_INTERNAL_H

#include <enfilade/map.h>

/** One name a chunk: ENF_CHUNK_strings, ENF_CHUNK_images …; `origin`, the last, holds EnfMap.tree_origin. */
typedef enum EnfMapChunkId {
#define ENF_MAP_CHUNK_ENUM(type, array, fourcc) ENF_CHUNK_##array,
    ENF_MAP_CHUNKS(ENF_MAP_CHUNK_ENUM)
#undef ENF_MAP_CHUNK_ENUM
        ENF_CHUNK_origin,
    ENF_MAP_CHUNK_COUNT
} EnfMapChunkId;

/* The header, 64 bytes: where each field lies. CRC_HEADER covers header and chunk table, itself taken as 0. */
enum {
    ENF_MAP_AT_MAGIC = 0,        /* 8 bytes */
    ENF_MAP_AT_VERSION = 8,      /* u32 */
    ENF_MAP_AT_ENDIAN = 12,      /* u32 */
    ENF_MAP_AT_FILE_SIZE = 16,   /* u64 */
    ENF_MAP_AT_SOURCE_HASH = 24, /* u64 */
    ENF_MAP_AT_HASH = 32,        /* u64 */
    ENF_MAP_AT_CHUNK_COUNT = 40, /* u32 */
    ENF_MAP_AT_CRC_HEADER = 44,  /* u32 */
    ENF_MAP_AT_RESERVED = 48,    /* 16 bytes of zero */
    ENF_MAP_HEADER_SIZE = 64,
    ENF_MAP_ENTRY_SIZE = 24, /* fourcc u32, record size u32, offset u64, count u32, CRC-32C u32 */
    ENF_MAP_FRONT_SIZE = ENF_MAP_HEADER_SIZE + ENF_MAP_ENTRY_SIZE * ENF_MAP_CHUNK_COUNT,
    ENF_MAP_ALIGN = 16
};

/** "ENFMAP\r\n": the last two bytes show a transfer in text mode. */
extern const uint8_t enf_map_magic[8];
#define ENF_MAP_ENDIAN UINT32_C(0x01020304)

/** A chunk's kind: what does not depend on a map. */
typedef struct EnfMapChunkInfo {
    const char *fourcc, *name; /**< "CELL", "cells" */
    uint32_t record_size;
    size_t array_at, count_at; /**< in EnfMap; unused for `origin` */
} EnfMapChunkInfo;

extern const EnfMapChunkInfo enf_map_chunk_info[ENF_MAP_CHUNK_COUNT];

/** A chunk of a map in memory. */
typedef struct EnfMapChunk {
    const void *data;
    uint32_t count;
    size_t size; /**< bytes */
} EnfMapChunk;

EnfMapChunk enf_map_chunk(const EnfMap *map, EnfMapChunkId id);
/** Points the map's array at `data`, or copies the origin. */
void enf_map_chunk_set(EnfMap *map, EnfMapChunkId id, const void *data, uint32_t count);

/** Where each chunk of a map lies in its file, a pure function of the counts; returns the file's size, or UINT64_MAX if it
 *  cannot be addressed. */
uint64_t enf_map_offsets(const EnfMap *map, uint64_t offsets[ENF_MAP_CHUNK_COUNT]);

/** A check in progress. */
typedef struct EnfMapCheck {
    const EnfMap *map;
    EnfError *error;
    uint64_t offsets[ENF_MAP_CHUNK_COUNT];
} EnfMapCheck;

/** Fails at a field: `at` is its address in the chunk's array, `field` its name ("" for a record that is one value). */
#if defined(__GNUC__)
__attribute__((format(printf, 6, 7)))
#endif
EnfResult
enf_map_bad(const EnfMapCheck *check, EnfMapChunkId id, const void *at, const char *field, EnfResult code, const char *format,
            ...);
/** The same for a member of a record: ENF_MAP_BAD(check, cells, i, origin, code, format, …). */
#define ENF_MAP_BAD(check, array, record, field, ...)                                                                          \
    enf_map_bad((check), ENF_CHUNK_##array, &(check)->map->array[record].field, #field, __VA_ARGS__)

/* The stages of enf_map_check; each relies on those before it. */
EnfResult enf_map_check_rules(const EnfMapCheck *check);    /* fields one by one: indices, ranges, enumerants, finite */
EnfResult enf_map_check_tables(const EnfMapCheck *check);   /* images, textures, lights, entities, paths */
EnfResult enf_map_check_cells(const EnfMapCheck *check);    /* cells, portals, transforms, bounds */
EnfResult enf_map_check_geometry(const EnfMapCheck *check); /* clusters, indices, trees */
EnfResult enf_map_check_movers(const EnfMapCheck *check);   /* meshes, movers */

/* ---- rays (ray.c) ----------------------------------------------------------------------------------------------- */

/** A ray for watertight tests against many triangles: Woop, Benthin & Wald 2013. */
typedef struct EnfMapRay {
    EnfVec3 direction;
    int kx, ky, kz; /* kz: the axis along which the direction is longest */
    double sx, sy, sz;
} EnfMapRay;

/** False for a zero or non-finite direction. */
bool enf_map_ray_make(EnfMapRay *ray, EnfVec3 direction);
/** The parameter at which the line through 0 meets triangle `abc` (relative to the ray's start), edges and corners included; it is
 *  negative behind the start. False if it does not meet it, or lies in its plane. */
bool enf_map_ray_triangle(const EnfMapRay *ray, EnfVec3 a, EnfVec3 b, EnfVec3 c, double *t);
/** Corner `k` of triangle `triangle` of a cluster, relative to the home cell's origin. */
EnfVec3 enf_map_corner(const EnfMap *map, const EnfCluster *cluster, uint32_t triangle, uint32_t k);
/** What a ray is asked: the nearest hit among the clusters of a cell's tree that `wanted` accepts (NULL: all). */
typedef bool EnfMapWanted(const EnfMap *map, uint32_t cluster, const void *user);
typedef struct EnfMapQuery {
    uint32_t cell;
    EnfVec3 from_ws, direction;
    double t_max;
    EnfMapWanted *wanted;
    const void *user; /**< for wanted */
} EnfMapQuery;
bool enf_map_ray_query(const EnfMap *map, const EnfMapQuery *query, EnfRayHit *hit);

static inline EnfVec3 enf_map_origin(const EnfMap *map, uint32_t cell) {
    const double *o = map->cells[cell].origin;
    return enf_v3(o[0], o[1], o[2]);
}

/** Vertex `k` of a half-portal, relative to its source's origin. */
static inline EnfVec3 enf_map_portal_vertex(const EnfMap *map, uint32_t portal, uint32_t k) {
    return enf_v3_from_f(map->portal_vertices[map->portals[portal].vertex_first + k]);
}

#endif
