/* The grid level: one mesh a room (its shell, with T-junctions at doors and hatches, as modellers leave them), three shared meshes
 * of openings, one of a table. JSON and buffer are written by hand. */
#include "scenes/grid_level.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROOM ENF_GRID_ROOM
#define STOREY ENF_GRID_STOREY
/* Openings, metres within a room: doors are centred in their wall, hatches lie in a corner. */
#define DOOR_LOW 1.5
#define DOOR_HIGH 2.5
#define DOOR_TOP 2.0
#define HATCH_LOW 0.25
#define HATCH_HIGH 1.25

enum { SIDE_EAST, SIDE_WEST, SIDE_SOUTH, SIDE_NORTH, SIDE_UP, SIDE_DOWN, SIDE_COUNT };
enum { MESH_EAST, MESH_SOUTH, MESH_UP, MESH_TABLE, MESH_ROOMS };

typedef struct Bytes {
    char *data;
    size_t size, capacity;
    bool failed;
} Bytes;

typedef struct Maker {
    const EnfGridLevel *level;
    Bytes meshes, accessors, nodes, buffer;
    uint32_t accessor_count, node_count, mesh_count, triangle_count;
    float min[3], max[3];     /* of the mesh being made */
    uint32_t first, vertices; /* its bytes and vertices */
} Maker;

/* ---- text and bytes --------------------------------------------------------------------------------------------- */

static void put(Bytes *bytes, const void *data, size_t size) {
    if (bytes->size + size > bytes->capacity) {
        size_t capacity = (bytes->size + size) * 2 + 4096;
        char *grown = realloc(bytes->data, capacity);
        if (!grown) {
            bytes->failed = true;
            return;
        }
        bytes->data = grown;
        bytes->capacity = capacity;
    }
    memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
}

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
say(Bytes *bytes, const char *format, ...) {
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    put(bytes, text, length > 0 ? (size_t)length : 0);
}

/* ---- meshes ----------------------------------------------------------------------------------------------------- */

static void begin_mesh(Maker *maker) {
    maker->first = (uint32_t)maker->buffer.size;
    maker->vertices = 0;
    for (int i = 0; i < 3; i++) {
        maker->min[i] = 1e30f;
        maker->max[i] = -1e30f;
    }
}

/* A vertex: position, normal, texture coordinates; 32 bytes. */
static void vertex(Maker *maker, const double p[3], const double n[3], double u, double v) {
    float packed[8] = {(float)p[0], (float)p[1], (float)p[2], (float)n[0], (float)n[1], (float)n[2], (float)u, (float)v};
    for (int i = 0; i < 3; i++) {
        maker->min[i] = packed[i] < maker->min[i] ? packed[i] : maker->min[i];
        maker->max[i] = packed[i] > maker->max[i] ? packed[i] : maker->max[i];
    }
    put(&maker->buffer, packed, sizeof packed);
    maker->vertices++;
}

/* A rectangle across `axis` at `level`, from (u0, v0) to (u1, v1) of the two axes after it, its front towards `sign`. */
static void rectangle(Maker *maker, int axis, double level, double sign, const double uv[4]) {
    static const int order[2][6] = {{0, 1, 2, 0, 2, 3}, {0, 2, 1, 0, 3, 2}};
    const double corners[4][2] = {{uv[0], uv[1]}, {uv[2], uv[1]}, {uv[2], uv[3]}, {uv[0], uv[3]}};
    double n[3] = {0, 0, 0};
    n[axis] = sign;
    for (int i = 0; i < 6; i++) {
        const double *corner = corners[order[sign < 0][i]];
        double p[3];
        p[axis] = level;
        p[(axis + 1) % 3] = corner[0];
        p[(axis + 2) % 3] = corner[1];
        vertex(maker, p, n, corner[0], corner[1]);
    }
}

/* The same with a rectangular hole: strips over the whole height where there is room beside it, and what is left of the middle. */
static void pierced(Maker *maker, int axis, double level, double sign, const double uv[4], const double hole[4]) {
    if (hole[0] > uv[0]) {
        rectangle(maker, axis, level, sign, (const double[4]){uv[0], uv[1], hole[0], uv[3]});
    }
    if (hole[2] < uv[2]) {
        rectangle(maker, axis, level, sign, (const double[4]){hole[2], uv[1], uv[2], uv[3]});
    }
    if (hole[1] > uv[1]) {
        rectangle(maker, axis, level, sign, (const double[4]){hole[0], uv[1], hole[2], hole[1]});
    }
    if (hole[3] < uv[3]) {
        rectangle(maker, axis, level, sign, (const double[4]){hole[0], hole[3], hole[2], uv[3]});
    }
}

static void end_mesh(Maker *maker, const char *name, int material) {
    static const struct {
        int offset;
        const char *shape;
    } attributes[3] = {{0, "VEC3"}, {12, "VEC3"}, {24, "VEC2"}};
    for (int i = 0; i < 3; i++) {
        say(&maker->accessors, "%s{\"bufferView\":0,\"byteOffset\":%zu,\"componentType\":5126,\"count\":%u,\"type\":\"%s\"",
            maker->accessor_count ? "," : "", (size_t)maker->first + (size_t)attributes[i].offset, maker->vertices,
            attributes[i].shape);
        if (i == 0) {
            say(&maker->accessors, ",\"min\":[%g,%g,%g],\"max\":[%g,%g,%g]", (double)maker->min[0], (double)maker->min[1],
                (double)maker->min[2], (double)maker->max[0], (double)maker->max[1], (double)maker->max[2]);
        }
        say(&maker->accessors, "}");
        maker->accessor_count++;
    }
    uint32_t a = maker->accessor_count - 3;
    say(&maker->meshes,
        "%s{\"name\":\"%s\",\"primitives\":[{\"attributes\":{\"POSITION\":%u,\"NORMAL\":%u,\"TEXCOORD_0\":%u},"
        "\"material\":%d}]}",
        maker->mesh_count ? "," : "", name, a, a + 1, a + 2, material);
    maker->mesh_count++;
}

static void box(Maker *maker, const double low[3], const double high[3]) {
    for (int axis = 0; axis < 3; axis++) {
        int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const double uv[4] = {low[u], low[v], high[u], high[v]};
        rectangle(maker, axis, high[axis], 1, uv);
        rectangle(maker, axis, low[axis], -1, uv);
    }
}

/* Four legs and a top. */
static void make_table(Maker *maker) {
    begin_mesh(maker);
    for (int i = 0; i < 4; i++) {
        double x = i & 1 ? 0.4 : -0.45, z = i & 2 ? 0.25 : -0.3;
        box(maker, (const double[3]){x, 0, z}, (const double[3]){x + 0.05, 0.7, z + 0.05});
    }
    box(maker, (const double[3]){-0.5, 0.7, -0.35}, (const double[3]){0.5, 0.75, 0.35});
    end_mesh(maker, "table", 3);
}

/* Openings as seen from the room they belong to: fronts out of it, at the origin of the room. */
static void make_openings(Maker *maker) {
    begin_mesh(maker);
    rectangle(maker, 0, ROOM, 1, (const double[4]){0, DOOR_LOW, DOOR_TOP, DOOR_HIGH});
    end_mesh(maker, "door east", 0);
    begin_mesh(maker);
    rectangle(maker, 2, ROOM, 1, (const double[4]){DOOR_LOW, 0, DOOR_HIGH, DOOR_TOP});
    end_mesh(maker, "door south", 0);
    begin_mesh(maker);
    rectangle(maker, 1, STOREY, 1, (const double[4]){HATCH_LOW, HATCH_LOW, HATCH_HIGH, HATCH_HIGH});
    end_mesh(maker, "hatch", 0);
}

static void make_shell(Maker *maker, const bool open[SIDE_COUNT], const char *name) {
    const double yz[4] = {0, 0, STOREY, ROOM}, zx[4] = {0, 0, ROOM, ROOM}, xy[4] = {0, 0, ROOM, STOREY};
    const double door_yz[4] = {0, DOOR_LOW, DOOR_TOP, DOOR_HIGH}, door_xy[4] = {DOOR_LOW, 0, DOOR_HIGH, DOOR_TOP};
    const double hatch[4] = {HATCH_LOW, HATCH_LOW, HATCH_HIGH, HATCH_HIGH};
    const struct {
        int axis;
        double level;
        const double *uv, *hole;
    } sides[SIDE_COUNT] = {{0, ROOM, yz, door_yz}, {0, 0, yz, door_yz},    {2, ROOM, xy, door_xy},
                           {2, 0, xy, door_xy},    {1, STOREY, zx, hatch}, {1, 0, zx, hatch}};
    begin_mesh(maker);
    for (int i = 0; i < SIDE_COUNT; i++) {
        double sign = sides[i].level > 0 ? -1 : 1; /* fronts look into the room */
        if (open[i]) {
            pierced(maker, sides[i].axis, sides[i].level, sign, sides[i].uv, sides[i].hole);
        } else {
            rectangle(maker, sides[i].axis, sides[i].level, sign, sides[i].uv);
        }
    }
    maker->triangle_count += maker->vertices / 3;
    end_mesh(maker, name, 1 + (int)(maker->mesh_count % 2));
}

/* ---- nodes ------------------------------------------------------------------------------------------------------ */

static uint32_t room_number(const EnfGridLevel *level, uint32_t x, uint32_t y, uint32_t z) {
    return (y * level->rooms_z + z) * level->rooms_x + x;
}

static void comma(Maker *maker) {
    if (maker->node_count++ > 0) {
        say(&maker->nodes, ",");
    }
}

/* A portal to the next room along x, z or y. */
static void add_portal(Maker *maker, uint32_t target, int mesh) {
    comma(maker);
    say(&maker->nodes, "{\"name\":\"r%05u*%d%s\",\"mesh\":%d}", target, mesh, maker->level->named ? "-portal" : "", mesh);
}

static void add_furniture(Maker *maker, uint32_t room) {
    static const double quarter[4][2] = {
        {0, 1}, {0.70710678118654757, 0.70710678118654757}, {1, 0}, {0.70710678118654757, -0.70710678118654757}};
    for (uint32_t i = 0; i < maker->level->tables; i++) {
        double x = 1.75 + 1.5 * (double)(i % 2), z = 2.0 + 1.25 * (double)(i / 2 % 2);
        const double *turn = quarter[(room + i) % 4];
        comma(maker);
        say(&maker->nodes, "{\"name\":\"r%05u_table%u\",\"mesh\":%d,\"translation\":[%g,0,%g],\"rotation\":[0,%.17g,0,%.17g]}",
            room, i, MESH_TABLE, x, z, turn[0], turn[1]);
        maker->triangle_count += 60;
    }
    if (maker->level->lights) {
        comma(maker);
        say(&maker->nodes,
            "{\"name\":\"r%05u_lamp\",\"translation\":[2,2.6,2],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}", room);
    }
}

/* A room with its children; returns its number among the nodes. */
static uint32_t add_room(Maker *maker, uint32_t x, uint32_t y, uint32_t z, uint32_t *portals) {
    const EnfGridLevel *level = maker->level;
    uint32_t room = room_number(level, x, y, z), first = maker->node_count;
    const bool open[SIDE_COUNT] = {x + 1 < level->rooms_x, x > 0, z + 1 < level->rooms_z, z > 0, y + 1 < level->storeys, y > 0};
    char name[32];
    snprintf(name, sizeof name, "r%05u_geo", room);
    comma(maker);
    say(&maker->nodes, "{\"name\":\"%s\",\"mesh\":%u}", name, maker->mesh_count);
    make_shell(maker, open, name);
    const uint32_t targets[3] = {room_number(level, x + 1, y, z), room_number(level, x, y, z + 1),
                                 room_number(level, x, y + 1, z)};
    for (int i = 0; i < 3; i++) {
        if (open[2 * i]) {
            add_portal(maker, targets[i], i);
            (*portals)++;
        }
    }
    add_furniture(maker, room);
    uint32_t end = maker->node_count;
    comma(maker);
    say(&maker->nodes, "{\"name\":\"r%05u%s\",\"translation\":[%g,%g,%g],\"children\":[", room, level->named ? "-room" : "",
        ROOM * x, STOREY * y, ROOM * z);
    for (uint32_t i = first; i < end; i++) {
        say(&maker->nodes, "%s%u", i > first ? "," : "", i);
    }
    /* Extras somewhere, so that nobody is told which box to tick. */
    say(&maker->nodes, "]%s}", room == 0 ? ",\"extras\":{\"kind\":\"grid\"}" : "");
    return end;
}

/* ---- the file --------------------------------------------------------------------------------------------------- */

static void put_head(Bytes *json, const Bytes *roots, const EnfGridLevel *level) {
    say(json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"grid level\"},\"scene\":0,\"scenes\":[{\"nodes\":[");
    put(json, roots->data, roots->size);
    say(json, "]}],");
    if (level->lights) {
        say(json, "\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":["
                  "{\"name\":\"lamp\",\"type\":\"point\",\"color\":[1,0.9,0.75],\"intensity\":30,\"range\":8}]}},");
    }
    say(json, "\"materials\":[");
    static const char *const colors[4] = {"1,1,1", "0.8,0.75,0.7", "0.6,0.65,0.7", "0.45,0.3,0.2"};
    static const char *const names[4] = {"opening", "plaster", "stone", "wood"};
    for (int i = 0; i < 4; i++) {
        say(json, "%s{\"name\":\"%s\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[%s,1],\"metallicFactor\":0}}",
            i ? "," : "", names[i], colors[i]);
    }
    say(json, "],");
}

static EnfResult write_glb(const Maker *maker, Bytes *json, const char *path, EnfError *error) {
    say(json, "\"meshes\":[");
    put(json, maker->meshes.data, maker->meshes.size);
    say(json, "],\"nodes\":[");
    put(json, maker->nodes.data, maker->nodes.size);
    say(json, "],\"accessors\":[");
    put(json, maker->accessors.data, maker->accessors.size);
    say(json, "],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu,\"byteStride\":32}],\"buffers\":[{\"byteLength\":%zu}]}",
        maker->buffer.size, maker->buffer.size);
    while (json->size % 4 != 0) {
        say(json, " ");
    }
    const uint32_t head[5] = {0x46546c67u, 2, (uint32_t)(28 + json->size + maker->buffer.size), (uint32_t)json->size,
                              0x4e4f534au};
    const uint32_t body[2] = {(uint32_t)maker->buffer.size, 0x004e4942u};
    if (json->failed || maker->meshes.failed || maker->nodes.failed || maker->accessors.failed || maker->buffer.failed) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for %s", path);
    }
    const EnfSpan spans[4] = {
        {head, sizeof head}, {json->data, json->size}, {body, sizeof body}, {maker->buffer.data, maker->buffer.size}};
    return enf_file_write(path, spans, 4, error);
}

EnfResult enf_grid_level_write(const EnfGridLevel *level, const char *path, EnfGridLevelCounts *counts, EnfError *error) {
    Maker maker;
    Bytes json = {0}, roots = {0};
    uint32_t portals = 0;
    memset(&maker, 0, sizeof maker);
    maker.level = level;
    make_openings(&maker);
    make_table(&maker);
    for (uint32_t y = 0; y < level->storeys; y++) {
        for (uint32_t z = 0; z < level->rooms_z; z++) {
            for (uint32_t x = 0; x < level->rooms_x; x++) {
                uint32_t node = add_room(&maker, x, y, z, &portals);
                say(&roots, "%s%u", roots.size ? "," : "", node);
            }
        }
    }
    put_head(&json, &roots, level);
    EnfResult result = write_glb(&maker, &json, path, error);
    if (counts) {
        *counts = (EnfGridLevelCounts){level->rooms_x * level->rooms_z * level->storeys, portals, maker.triangle_count};
    }
    Bytes *all[] = {&json, &roots, &maker.meshes, &maker.accessors, &maker.nodes, &maker.buffer};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        free(all[i]->data);
    }
    return result;
}
