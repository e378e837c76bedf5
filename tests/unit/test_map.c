/* Map files: what is written is read, what is damaged is refused by name, and nothing that passes harms whoever uses it. */
#include "harness/harness.h"
#include "map/map_internal.h"
#include "scenes/rooms.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- a map with a record in every table ------------------------------------------------------------------------- */

static void put_tables(EnfMaker *m, uint32_t cell) {
    static const uint8_t rgba[2 * 2 * 4] = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255};
    uint32_t texture = enf_maker_texture(m, enf_maker_image(m, 2, 2, rgba));
    EnfMaterial *material = enf_maker_material(m, "tiles", 1, 1, 1);
    material->texture = material->emissive_texture = texture;
    material->alpha_mode = ENF_ALPHA_MASK;
    EnfMapCamera camera = {1.0f, 1.5f, 0.1f, 100.0f};
    EnfEntity root = {{1, 1, 1},
                      {0, 0, 0, 1},
                      {1, 1, 1},
                      enf_maker_string(m, "lift"),
                      enf_maker_string(m, "func_lift"),
                      enf_maker_string(m, "{\"speed\":2}"),
                      ENF_NONE,
                      cell,
                      enf_maker_camera(m, &camera),
                      0};
    EnfEntity child = root;
    child.parent = enf_maker_entity(m, &root);
    enf_maker_entity(m, &child);
    EnfPath path = {enf_maker_string(m, "up"), 0, ENF_PATH_TRANSLATION, ENF_PATH_LINEAR, 2, 0};
    const float floats[] = {0.0f, 1.0f, 0, 0, 0, 0, 2, 0};
    enf_maker_path(m, &path, floats, 8);
    EnfPath turn = {path.name, 1, ENF_PATH_ROTATION, ENF_PATH_CUBIC, 1, 0};
    const float turn_floats[13] = {0.5f, [8] = 1.0f};
    enf_maker_path(m, &turn, turn_floats, 13);
}

/* Two rooms in a row, a cupboard in one of them, a mirror, a pair of teleports, a light through a window. */
static EnfMaker *make_everything(void) {
    EnfMaker *m = enf_maker_create();
    uint32_t a, b, cupboard;
    enf_maker_cell(m, "hall-room", enf_v3(0, 0, 0), &a);
    enf_maker_light(m, a, enf_v3(1, 2, 1), (EnfVec3f){1, 1, 1}, 10);
    enf_maker_cell(m, "study_Room", enf_v3(4, 0, 0), &b);
    enf_maker_light(m, b, enf_v3(6, 2, 1), (EnfVec3f){1, 1, 1}, 10);
    const EnfPlane4f window[2] = {{{1, 0, 0}, 0}, {{0, 1, 0}, 1}};
    enf_maker_light_window(m, window, 2);
    enf_maker_cell(m, "cupboard", enf_v3(1, 0, 1), &cupboard)->priority = 1;
    enf_maker_bound(m, enf_v3(1, 0, 0), enf_v3(2, 0, 1));
    enf_maker_bound(m, enf_v3(-1, 0, 0), enf_v3(1, 0, 1));
    enf_maker_bound(m, enf_v3(0, 1, 0), enf_v3(1, 1, 1));
    enf_maker_bound(m, enf_v3(0, -1, 0), enf_v3(1, 0, 1));
    enf_maker_bound(m, enf_v3(0, 0, 1), enf_v3(1, 0, 2));
    enf_maker_bound(m, enf_v3(0, 0, -1), enf_v3(1, 0, 1));
    put_tables(m, a);
    enf_maker_box(m, a, 0, (EnfBox3){{0, 0, 0}, {4, 3, 4}}, true);
    enf_maker_box(m, b, 0, (EnfBox3){{4, 0, 0}, {8, 3, 4}}, true);
    enf_maker_group(m);
    enf_maker_box(m, cupboard, 1, (EnfBox3){{1.25, 0.25, 1.25}, {1.75, 0.75, 1.75}}, false);
    enf_maker_reach(m, a);
    const EnfVec3 door[4] = {{4, 0, 1}, {4, 2, 1}, {4, 2, 2}, {4, 0, 2}};
    enf_maker_portal(m, "door-portal", a, b, door, 4, 0);
    enf_maker_portal(m, "link", a, cupboard, NULL, 0, ENF_PORTAL_OVERLAP);
    const EnfVec3 glass[3] = {{0, 1, 1}, {0, 2, 1}, {0, 1, 2}};
    EnfAffine flip = enf_affine_identity();
    flip.m[0] = -1;
    enf_maker_teleport(m, a, a, glass, 3, &flip, ENF_NONE);
    const EnfVec3 there[3] = {{8, 0, 1}, {8, 1, 1}, {8, 1, 2}}, back[3] = {{0, 1, 3}, {0, 1, 2}, {0, 0, 3}};
    EnfAffine shift = enf_affine_identity(), unshift = enf_affine_identity();
    shift.t = enf_v3(-8, 0, 0);
    unshift.t = enf_v3(8, 0, 0);
    uint32_t one = enf_maker_teleport(m, b, a, there, 3, &shift, ENF_NONE);
    enf_maker_teleport(m, a, b, back, 3, &unshift, one);
    EnfError error = {0};
    if (!enf_maker_finish(m, &error)) {
        fail_msg("%s", error.message);
    }
    return m;
}

/* The map's file in memory that is exactly as large as it, 16-byte aligned. */
static uint8_t *file_of(const EnfMap *map, size_t *size) {
    const char *path = enf_test_temp_path("map.enfmap");
    EnfError error = {0};
    if (enf_map_write(map, path, &error)) {
        fail_msg("%s", error.message);
    }
    return enf_test_read_file(path, size);
}

static uint8_t *everything_file(size_t *size) {
    EnfMaker *maker = make_everything();
    uint8_t *file = file_of(enf_maker_map(maker), size);
    enf_maker_destroy(maker);
    return file;
}

/* Bytes in a fresh block of their exact size: an over-read shows under ASan. */
static uint8_t *exact_copy(const uint8_t *bytes, size_t size) {
    uint8_t *copy = malloc(size ? size : 1);
    memcpy(copy, bytes, size);
    return copy;
}

/* ---- round trip ------------------------------------------------------------------------------------------------- */

static void assert_same_map(const EnfMap *a, const EnfMap *b) {
    for (int id = 0; id < ENF_MAP_CHUNK_COUNT; id++) {
        EnfMapChunk x = enf_map_chunk(a, (EnfMapChunkId)id), y = enf_map_chunk(b, (EnfMapChunkId)id);
        assert_int_equal(x.count, y.count);
        if (x.size) {
            assert_memory_equal(x.data, y.data, x.size);
        }
    }
    assert_memory_equal(a->tree_origin, b->tree_origin, sizeof a->tree_origin);
}

static void check_round_trip(const EnfMap *map) {
    EnfMap copy = *map, read;
    EnfError error = {0};
    copy.source_hash = UINT64_C(0x0123456789abcdef);
    const char *path = enf_test_temp_path("round.enfmap"), *again = enf_test_temp_path("again.enfmap");
    assert_int_equal(enf_map_write(&copy, path, &error), ENF_OK);
    if (enf_map_read(&read, path, NULL, &error)) {
        fail_msg("%s", error.message);
    }
    assert_same_map(map, &read);
    assert_true(read.hash == enf_map_content_hash(map));
    assert_true(read.source_hash == copy.source_hash);
    assert_int_equal(enf_map_write(&read, again, &error), ENF_OK);
    size_t size, again_size;
    uint8_t *first = enf_test_read_file(path, &size), *second = enf_test_read_file(again, &again_size);
    assert_int_equal(size, again_size);
    assert_memory_equal(first, second, size);
    free(first);
    free(second);
    enf_map_free(&read);
    assert_null(read.cells);
}

static void test_round_trip(void **state) {
    (void)state;
    EnfRooms rooms;
    EnfRoomsDef def = enf_rooms_def_default();
    EnfError error = {0};
    def.thresholds = true;
    def.origin = enf_v3(10000, -50, 20000);
    if (!enf_rooms_create(&rooms, &def, &error)) {
        fail_msg("%s", error.message);
    }
    check_round_trip(rooms.map);
    enf_rooms_destroy(&rooms);
    EnfMaker *everything = make_everything();
    for (int id = 0; id < ENF_MAP_CHUNK_COUNT; id++) {
        assert_int_not_equal(enf_map_chunk(enf_maker_map(everything), (EnfMapChunkId)id).count, 0);
    }
    check_round_trip(enf_maker_map(everything));
    enf_maker_destroy(everything);
}

static void test_layout(void **state) {
    (void)state;
    size_t size;
    uint8_t *file = everything_file(&size);
    assert_memory_equal(file, "ENFMAP\r\n", 8);
    EnfCursor cursor = enf_cursor(file, size);
    enf_cursor_bytes(&cursor, ENF_MAP_HEADER_SIZE);
    uint64_t end = 0;
    for (int id = 0; id < ENF_MAP_CHUNK_COUNT; id++) {
        assert_memory_equal(enf_cursor_bytes(&cursor, 4), enf_map_chunk_info[id].fourcc, 4);
        uint32_t record = enf_cursor_u32(&cursor);
        uint64_t offset = enf_cursor_u64(&cursor);
        uint32_t count = enf_cursor_u32(&cursor);
        enf_cursor_u32(&cursor);
        assert_int_equal(offset % 16, 0);
        assert_true(offset >= end);
        end = offset + (uint64_t)record * count;
    }
    assert_true(end == size);
    free(file);
}

static void test_read_errors(void **state) {
    (void)state;
    EnfMap map;
    EnfError error = {0};
    assert_int_equal(enf_map_read(&map, enf_test_temp_path("absent.enfmap"), NULL, &error), ENF_ERROR_IO);
    assert_non_null(strstr(error.file, "absent.enfmap"));
    const char *path = enf_test_temp_path("empty.enfmap");
    enf_test_write_file(path, "", 0);
    assert_int_equal(enf_map_read(&map, path, NULL, &error), ENF_ERROR_TRUNCATED);
    enf_test_write_file(path, "glTF\2\0\0\0 and something else", 24);
    assert_int_equal(enf_map_read(&map, path, NULL, &error), ENF_ERROR_MAGIC);
    assert_int_equal(enf_map_view(&map, NULL, 0, &error), ENF_ERROR_ARGUMENT);
    assert_null(map.cells);
}

/* ---- damage ----------------------------------------------------------------------------------------------------- */

static void test_truncation(void **state) {
    (void)state;
    size_t size;
    uint8_t *file = everything_file(&size);
    for (size_t length = 0; length < size; length++) {
        uint8_t *part = exact_copy(file, length);
        EnfMap map;
        EnfError error = {0};
        assert_int_not_equal(enf_map_view(&map, part, length, &error), ENF_OK);
        assert_int_not_equal(error.message[0], 0);
        free(part);
    }
    free(file);
}

static void test_bit_flips(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    size_t size;
    uint8_t *file = everything_file(&size);
    uint8_t *copy = exact_copy(file, size);
    for (uint32_t i = 0; i < enf_test_rounds(10000, 200000); i++) {
        EnfMap map;
        size_t at = enf_test_below(&rng, (uint32_t)size);
        copy[at] ^= (uint8_t)(1u << enf_test_below(&rng, 8));
        assert_int_not_equal(enf_map_view(&map, copy, size, NULL), ENF_OK);
        copy[at] = file[at];
    }
    free(copy);
    free(file);
}

/* Whoever damages a map on purpose mends its checksums too. */
static void store_u32(uint8_t *to, uint32_t value) {
    memcpy(to, &value, sizeof value);
}

static void reseal(uint8_t *file, size_t size) {
    uint64_t hash = ENF_HASH_START, size_field = size;
    memcpy(file + ENF_MAP_AT_FILE_SIZE, &size_field, 8);
    for (int id = 0; id < ENF_MAP_CHUNK_COUNT; id++) {
        uint8_t *entry = file + ENF_MAP_HEADER_SIZE + ENF_MAP_ENTRY_SIZE * id;
        EnfCursor cursor = enf_cursor(entry, ENF_MAP_ENTRY_SIZE);
        enf_cursor_u32(&cursor);
        uint64_t record = enf_cursor_u32(&cursor), offset = enf_cursor_u64(&cursor), count = enf_cursor_u32(&cursor);
        if (offset > size || record * count > size - offset) {
            continue;
        }
        store_u32(entry + 20, enf_crc32c(0, file + offset, (size_t)(record * count)));
        hash = enf_hash64(hash, entry, 4);
        hash = enf_hash64(hash, file + offset, (size_t)(record * count));
    }
    memcpy(file + ENF_MAP_AT_HASH, &hash, 8);
    store_u32(file + ENF_MAP_AT_CRC_HEADER, 0);
    store_u32(file + ENF_MAP_AT_CRC_HEADER, enf_crc32c(0, file, ENF_MAP_FRONT_SIZE));
}

/* Every question that can be put to a map. */
static void use_map(const EnfMap *map, EnfTestRng *rng) {
    EnfVec3 p = enf_v3(enf_test_double(rng, -1, 9), enf_test_double(rng, -1, 4), enf_test_double(rng, -1, 5));
    EnfVec3 q = enf_v3(enf_test_double(rng, -1, 9), enf_test_double(rng, -1, 4), enf_test_double(rng, -1, 5));
    uint32_t cell = enf_map_locate(map, p), items[16];
    EnfRayHit hit;
    enf_map_track(map, cell, p, q);
    enf_map_find_cell(map, "study");
    for (uint32_t i = 0; i < map->cells_count; i++) {
        EnfKdTree tree = enf_map_cell_tree(map, i);
        EnfPyramid all = {1, {1}, {0}, {0}, {1}};
        enf_kd_query(&tree, &all, items, 16, NULL);
        enf_map_ray(map, i, p, enf_sub(q, p), HUGE_VAL, &hit);
        enf_map_string(map, map->cells[i].name);
    }
}

static void test_resealed_damage(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    size_t size;
    uint8_t *file = everything_file(&size);
    uint8_t *copy = exact_copy(file, size);
    uint32_t passed = 0, rounds = enf_test_rounds(10000, 300000);
    for (uint32_t i = 0; i < rounds; i++) {
        EnfMap map;
        EnfError error = {0};
        bool in_front = enf_test_chance(&rng, 4);
        size_t at = in_front ? enf_test_below(&rng, ENF_MAP_FRONT_SIZE)
                             : ENF_MAP_FRONT_SIZE + enf_test_below(&rng, (uint32_t)size - ENF_MAP_FRONT_SIZE);
        copy[at] = enf_test_chance(&rng, 2) ? (uint8_t)(copy[at] ^ 1u << enf_test_below(&rng, 8)) : (uint8_t)enf_test_u32(&rng);
        reseal(copy, size);
        if (enf_map_view(&map, copy, size, &error) == ENF_OK) {
            passed++;
            use_map(&map, &rng);
        } else {
            assert_int_not_equal(error.message[0], 0);
        }
        memcpy(copy, file, size);
    }
    printf("%u of %u resealed maps pass (a changed colour is no damage); all were used\n", passed, rounds);
    free(copy);
    free(file);
}

/* Truncated, with the header telling so: the table is compared with what is there. */
static void test_resealed_truncation(void **state) {
    (void)state;
    size_t size;
    uint8_t *file = everything_file(&size);
    for (size_t length = ENF_MAP_FRONT_SIZE; length < size; length += 3) {
        EnfMap map;
        uint8_t *part = exact_copy(file, length);
        reseal(part, length);
        assert_int_not_equal(enf_map_view(&map, part, length, NULL), ENF_OK);
        free(part);
    }
    uint8_t *longer = calloc(1, size + 16);
    EnfMap map;
    EnfError error = {0};
    memcpy(longer, file, size);
    reseal(longer, size + 16);
    assert_int_equal(enf_map_view(&map, longer, size + 16, &error), ENF_ERROR_FORMAT);
    assert_non_null(strstr(error.message, "follow the last chunk"));
    free(longer);
    free(file);
}

/* ---- every field ------------------------------------------------------------------------------------------------ */

/* A map whose records can be changed. */
typedef struct Draft {
#define DRAFT_FIELD(type, array, fourcc) type *array;
    ENF_MAP_CHUNKS(DRAFT_FIELD)
#undef DRAFT_FIELD
    EnfMap map;
    uint8_t *bytes;
} Draft;

static Draft draft_of(const uint8_t *file, size_t size) {
    Draft draft;
    draft.bytes = exact_copy(file, size);
    EnfError error = {0};
    if (enf_map_view(&draft.map, draft.bytes, size, &error)) {
        fail_msg("%s", error.message);
    }
#define DRAFT_POINT(type, array, fourcc)                                                                                       \
    draft.array = (type *)(void *)(draft.bytes + ((const uint8_t *)draft.map.array - draft.bytes));
    ENF_MAP_CHUNKS(DRAFT_POINT)
#undef DRAFT_POINT
    return draft;
}

static void expect_refused(Draft *draft, const char *field, EnfResult code) {
    EnfError error = {0};
    EnfResult result = enf_map_check(&draft->map, &error);
    if (result == ENF_OK) {
        fail_msg("%s: accepted", field);
    }
    if (!strstr(error.message, field) || !strstr(error.message, "chunk ")) {
        fail_msg("%s: not named in: %s", field, error.message);
    }
    if (result != code) {
        fail_msg("%s: %s instead of %s", field, enf_result_text(result), enf_result_text(code));
    }
    free(draft->bytes);
}

#define HUGE_INDEX 0x7fffffffu
/* Portals by cell: 0 hall: 0 door, 1 link, 2 mirror, 3 teleport; 1 study: 4 door, 5 teleport; 2 cupboard: 6 link. */
/* clang-format off */
#define CORRUPTIONS(X)                                                          \
    X("strings", FORMAT, strings[0] = 'x')                                      \
    X("strings", FORMAT, strings[d.map.strings_count - 1] = 'x')                \
    X("images[0].width", RANGE, images[0].width = 0)                            \
    X("images[0].height", RANGE, images[0].height = 16385)                      \
    X("images[0].byte_first", INDEX, images[0].byte_first = 4)                  \
    X("images[0].name", INDEX, images[0].name = HUGE_INDEX)                     \
    X("textures[0].image", INDEX, textures[0].image = 1)                        \
    X("textures[0].mag_filter", RANGE, textures[0].mag_filter = 0)              \
    X("textures[0].min_filter", RANGE, textures[0].min_filter = 9988)           \
    X("textures[0].wrap_s", RANGE, textures[0].wrap_s = 1)                      \
    X("textures[0].wrap_t", RANGE, textures[0].wrap_t = 1)                      \
    X("materials[1].name", INDEX, materials[1].name = HUGE_INDEX)               \
    X("materials[1].texture", INDEX, materials[1].texture = 1)                  \
    X("materials[1].emissive_texture", INDEX, materials[1].emissive_texture = 7)\
    X("materials[1].alpha_mode", RANGE, materials[1].alpha_mode = 3)            \
    X("materials[1].flags", RANGE, materials[1].flags = 16)                     \
    X("materials[0].base_color", RANGE, materials[0].base_color[3] = NAN)       \
    X("materials[0].emissive", RANGE, materials[0].emissive[2] = INFINITY)      \
    X("materials[0].alpha_cutoff", RANGE, materials[0].alpha_cutoff = NAN)      \
    X("materials[0].roughness", RANGE, materials[0].roughness = NAN)            \
    X("materials[0].metallic", RANGE, materials[0].metallic = NAN)              \
    X("materials[0].uv_transform", RANGE, materials[0].uv_transform[5] = NAN)   \
    X("materials[0].reserved", RANGE, materials[0].reserved = 1)                \
    X("cells[0].origin", RANGE, cells[0].origin[1] = (double)NAN)               \
    X("cells[0].origin", RANGE, cells[0].origin[1] = 1.0 / 512.0)               \
    X("cells[0].origin", RANGE, cells[0].origin[1] = 1e9)                       \
    X("cells[0].min", RANGE, cells[0].min[0] = NAN)                             \
    X("cells[0].min", RANGE, cells[0].min[0] = 100)                             \
    X("cells[0].max", RANGE, cells[0].max[2] = INFINITY)                        \
    X("cells[1].name", INDEX, cells[1].name = HUGE_INDEX)                       \
    X("cells[1].flags", RANGE, cells[1].flags = 4)                              \
    X("flags", FORMAT, cells[1].flags = d.cells[0].flags = ENF_CELL_OUTSIDE)    \
    X("cells[1].portal_first", INDEX, cells[1].portal_first = HUGE_INDEX)       \
    X("cells[1].portal_first", INDEX, cells[1].portal_count = HUGE_INDEX)       \
    X("cells[1].portal_first", INDEX, cells[1].portal_first = 3)                \
    X("portals[6].source", INDEX, cells[2].portal_count = 0)                    \
    X("cells[1].node_first", INDEX, cells[1].node_first = HUGE_INDEX)           \
    X("cells[1].block_first", INDEX, cells[1].block_count = HUGE_INDEX)         \
    X("kd_nodes", FORMAT, cells[2].node_count = 0)                              \
    X("cells[1].cluster_first", INDEX, cells[1].cluster_first = HUGE_INDEX)     \
    X("cells[1].cluster_first", INDEX, cells[1].cluster_first = 0)              \
    X("cells[1].light_first", INDEX, cells[1].light_first = HUGE_INDEX)         \
    X("cells[2].bound_first", INDEX, cells[2].bound_count = 7)                  \
    X("cells[2].reserved", RANGE, cells[2].reserved = 1)                        \
    X("transforms[0].m", RANGE, transforms[0].m[4] = (double)NAN)               \
    X("transforms[0].m", RANGE, transforms[0].m[4] = 1.0000000001)              \
    X("transforms[1].m", RANGE, transforms[1].m[1] = 1e-9)                      \
    X("transforms[1].t", RANGE, transforms[1].t[0] = 1e300)                     \
    X("portals[0].source", INDEX, portals[0].source = 3)                        \
    X("cells[0].portal_first", INDEX, portals[0].source = 1)                    \
    X("portals[0].target", INDEX, portals[0].target = HUGE_INDEX)               \
    X("portals[0].target", INDEX, portals[0].target = 0)                        \
    X("portals[0].twin", INDEX, portals[0].twin = 7)                            \
    X("portals[0].twin", INDEX, portals[0].twin = 0)                            \
    X("portals[0].twin", INDEX, portals[0].twin = 5)                            \
    X("portals[0].twin", INDEX, portals[0].target = 2)                          \
    X("portals[0].twin", FORMAT, portals[0].transform = 1)                      \
    X("portals[0].vertex_first", INDEX, portals[0].vertex_first = HUGE_INDEX)   \
    X("portals[0].vertex_count", RANGE, portals[0].vertex_count = 2)            \
    X("portals[1].vertex_count", RANGE, portals[1].vertex_count = 3)            \
    X("portals[1].transform", FORMAT, portals[1].transform = 1)                 \
    X("portals[0].transform", INDEX, portals[0].transform = 3)                  \
    X("portals[0].flags", RANGE, portals[0].flags = 16)                         \
    X("portals[0].flags", FORMAT, portals[0].flags = ENF_PORTAL_MIRROR)         \
    X("portals[2].flags", FORMAT, portals[2].flags = 0)                         \
    X("portals[0].name", INDEX, portals[0].name = HUGE_INDEX)                   \
    X("portal_vertices[2]", RANGE, portal_vertices[2].y = NAN)                  \
    X("bound_planes[1]", RANGE, bound_planes[1].d = INFINITY)                   \
    X("bound_planes[0].n", RANGE, bound_planes[0].n[0] = 0)                     \
    X("vertices[3].position", RANGE, vertices[3].position[2] = NAN)             \
    X("vertices[3].position", RANGE, vertices[3].position[2] = 100)             \
    X("vertices[3].uv", RANGE, vertices[3].uv[1] = NAN)                         \
    X("vertices[3].cell", INDEX, vertices[3].cell = 3)                          \
    X("vertices[3].cell", INDEX, vertices[3].cell = 1)                          \
    X("indices[5]", INDEX, indices[5] = HUGE_INDEX)                             \
    X("indices[5]", INDEX, indices[5] = 30)                                     \
    X("clusters[0].min", RANGE, clusters[0].min[0] = NAN)                       \
    X("clusters[0].min", RANGE, clusters[0].min[0] = 50)                        \
    X("clusters[0].max", RANGE, clusters[0].max[0] = INFINITY)                  \
    X("clusters[0].cell", INDEX, clusters[0].cell = 3)                          \
    X("cells[0].cluster_first", INDEX, clusters[0].cell = 1)                    \
    X("clusters[0].material", INDEX, clusters[0].material = 2)                  \
    X("clusters[0].index_first", INDEX, clusters[0].index_first = HUGE_INDEX)   \
    X("clusters[0].index_count", RANGE, clusters[0].index_count = 4)            \
    X("clusters[0].index_count", RANGE, clusters[0].index_count = 0)            \
    X("clusters[0].vertex_first", INDEX, clusters[0].vertex_count = HUGE_INDEX) \
    X("indices", INDEX, clusters[0].vertex_count = 20)                          \
    X("clusters[2].node", INDEX, clusters[2].node = HUGE_INDEX)                 \
    X("clusters[2].reserved", RANGE, clusters[2].reserved = 1)                  \
    X("kd_nodes[0]", INDEX, kd_nodes[0].block_count = 2)                        \
    X("kd_nodes[1]", RANGE, kd_nodes[1].min[0] = NAN)                           \
    X("the tree of cell 1", FORMAT, kd_nodes[1].link = 1)                       \
    X("the tree of cell 1", RANGE, kd_nodes[1].max[0] = 1)                      \
    X("the tree of cell 0", INDEX, kd_blocks[0].item[0] = 3)                    \
    X("the tree of cell 0", FORMAT, kd_blocks[0].item[0] = ENF_NONE)            \
    X("kd_blocks[0].item", INDEX, kd_blocks[0].item[1] = 0)                     \
    X("kd_blocks[0].min_x", RANGE, kd_blocks[0].min_x[0] = 1)                   \
    X("lights[0].position", RANGE, lights[0].position[0] = (double)NAN)         \
    X("lights[0].direction", RANGE, lights[0].direction[0] = NAN)               \
    X("lights[0].direction", RANGE, lights[0].direction[1] = (float)(d.lights[0].kind = ENF_LIGHT_SPOT) - 1) \
    X("lights[0].color", RANGE, lights[0].color[0] = NAN)                       \
    X("lights[0].range", RANGE, lights[0].range = -1)                           \
    X("lights[0].inner_cos", RANGE, lights[0].inner_cos = NAN)                  \
    X("lights[0].outer_cos", RANGE, lights[0].outer_cos = NAN)                  \
    X("lights[0].outer_cos", RANGE, lights[0].outer_cos = 1.0f + (float)(d.lights[0].kind = ENF_LIGHT_SPOT)) \
    X("lights[0].kind", RANGE, lights[0].kind = 3)                              \
    X("lights[0].cell", INDEX, lights[0].cell = 3)                              \
    X("lights[0].name", INDEX, lights[0].name = HUGE_INDEX)                     \
    X("light_refs[1].light", INDEX, light_refs[1].light = 2)                    \
    X("light_refs[1].plane_first", INDEX, light_refs[1].plane_count = 3)        \
    X("light_planes[1]", RANGE, light_planes[1].d = NAN)                        \
    X("light_planes[1].n", RANGE, light_planes[1].n[1] = 0)                     \
    X("cameras[0]", RANGE, cameras[0].far_plane = INFINITY)                     \
    X("cameras[0].fov_y", RANGE, cameras[0].fov_y = -1)                         \
    X("entities[0].translation", RANGE, entities[0].translation[0] = (double)NAN) \
    X("entities[0].rotation", RANGE, entities[0].rotation[0] = NAN)             \
    X("entities[0].rotation", RANGE, entities[0].rotation[3] = 0)               \
    X("entities[0].scale", RANGE, entities[0].scale[2] = NAN)                   \
    X("entities[0].name", INDEX, entities[0].name = HUGE_INDEX)                 \
    X("entities[0].classname", INDEX, entities[0].classname = HUGE_INDEX)       \
    X("entities[0].extras", INDEX, entities[0].extras = HUGE_INDEX)             \
    X("entities[0].parent", INDEX, entities[0].parent = HUGE_INDEX)             \
    X("entities[0].parent", INDEX, entities[0].parent = 0)                      \
    X("entities[0].parent", INDEX, entities[0].parent = 1)                      \
    X("entities[0].cell", INDEX, entities[0].cell = 3)                          \
    X("entities[0].camera", INDEX, entities[0].camera = 1)                      \
    X("entities[0].light", INDEX, entities[0].light = 2)                        \
    X("paths[0].name", INDEX, paths[0].name = HUGE_INDEX)                       \
    X("paths[0].entity", INDEX, paths[0].entity = 2)                            \
    X("paths[0].target", RANGE, paths[0].target = 3)                            \
    X("paths[0].kind", RANGE, paths[0].kind = 3)                                \
    X("paths[0].key_count", RANGE, paths[0].key_count = 0)                      \
    X("paths[0].float_first", INDEX, paths[0].key_count = HUGE_INDEX)           \
    X("paths[1].float_first", INDEX, paths[1].float_first = 9)                  \
    X("path_floats[3]", RANGE, path_floats[3] = NAN)                            \
    X("path_floats[1]", RANGE, path_floats[1] = 0)                              \
    X("the tree of all cells", INDEX, cell_blocks[0].item[0] = 3)               \
    X("cell_blocks[0].item", INDEX, cell_blocks[0].item[1] = 0)                 \
    X("cell_blocks[0].min_x", RANGE, cell_blocks[0].min_x[0] = 1)               \
    X("cell_blocks", FORMAT, map.cell_nodes_count = d.map.cell_blocks_count = 0)\
    X("tree_origin[0]", RANGE, map.tree_origin[1] = (double)NAN)
/* clang-format on */

static void test_corruptions(void **state) {
    (void)state;
    size_t size;
    uint8_t *file = everything_file(&size);
#define CORRUPT(field, code, statement)                                                                                        \
    {                                                                                                                          \
        Draft d = draft_of(file, size);                                                                                        \
        d.statement;                                                                                                           \
        expect_refused(&d, field, ENF_ERROR_##code);                                                                           \
    }
    CORRUPTIONS(CORRUPT)
#undef CORRUPT
    free(file);
}

/* The offset is that of the field in the file. */
static void test_error_offset(void **state) {
    (void)state;
    size_t size;
    uint8_t *file = everything_file(&size);
    Draft d = draft_of(file, size);
    d.portals[4].name = HUGE_INDEX;
    EnfError error = {0};
    assert_int_equal(enf_map_check(&d.map, &error), ENF_ERROR_INDEX);
    uint32_t there;
    memcpy(&there, d.bytes + error.offset, sizeof there);
    assert_int_equal(there, HUGE_INDEX);
    assert_non_null(strstr(error.message, "chunk PORT: portals[4].name"));
    free(d.bytes);
    free(file);
}

static void test_find_cell(void **state) {
    (void)state;
    EnfMaker *maker = make_everything();
    const EnfMap *map = enf_maker_map(maker);
    assert_int_equal(enf_map_find_cell(map, "hall-room"), 0);
    assert_int_equal(enf_map_find_cell(map, "hall"), 0);
    assert_int_equal(enf_map_find_cell(map, "study"), 1);
    assert_int_equal(enf_map_find_cell(map, "cupboard"), 2);
    assert_int_equal(enf_map_find_cell(map, "cup"), ENF_NONE);
    assert_int_equal(enf_map_find_cell(map, ""), ENF_NONE);
    enf_maker_destroy(maker);
}

/* Memory that ends after a number of blocks, and is all given back. */
typedef struct Scarce {
    uint32_t left, held;
} Scarce;

static void *scarce_resize(void *user, void *block, size_t old_size, size_t new_size) {
    Scarce *scarce = user;
    (void)old_size;
    if (new_size == 0) {
        scarce->held -= block != NULL;
        free(block);
        return NULL;
    }
    if (scarce->left == 0) {
        return NULL;
    }
    scarce->left--;
    scarce->held += block == NULL;
    return realloc(block, new_size);
}

static void test_read_without_memory(void **state) {
    (void)state;
    size_t size;
    free(everything_file(&size)); /* leaves map.enfmap */
    const char *path = enf_test_temp_path("map.enfmap");
    EnfResult result = ENF_ERROR_MEMORY;
    for (uint32_t blocks = 0; result != ENF_OK; blocks++) {
        Scarce scarce = {blocks, 0};
        EnfAllocator allocator = {scarce_resize, &scarce};
        EnfMap map;
        EnfError error = {0};
        result = enf_map_read(&map, path, &allocator, &error);
        assert_true(result == ENF_OK || result == ENF_ERROR_MEMORY);
        assert_int_equal(map.cells != NULL, result == ENF_OK);
        enf_map_free(&map);
        assert_int_equal(scarce.held, 0);
        assert_in_range(blocks, 0, 16);
    }
}

/* An empty map is sound, and answers. */
static void test_empty(void **state) {
    (void)state;
    EnfMap map;
    EnfError error = {0};
    memset(&map, 0, sizeof map);
    map.strings = "";
    map.strings_count = 1;
    assert_int_equal(enf_map_check(&map, &error), ENF_OK);
    size_t size;
    uint8_t *file = file_of(&map, &size);
    EnfMap read;
    assert_int_equal(enf_map_view(&read, file, size, &error), ENF_OK);
    assert_int_equal(enf_map_locate(&read, enf_v3(0, 0, 0)), ENF_NONE);
    assert_int_equal(enf_map_find_cell(&read, "x"), ENF_NONE);
    free(file);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_round_trip),          cmocka_unit_test(test_layout),      cmocka_unit_test(test_read_errors),
    cmocka_unit_test(test_truncation),          cmocka_unit_test(test_bit_flips),   cmocka_unit_test(test_resealed_damage),
    cmocka_unit_test(test_resealed_truncation), cmocka_unit_test(test_corruptions), cmocka_unit_test(test_error_offset),
    cmocka_unit_test(test_find_cell),           cmocka_unit_test(test_empty),       cmocka_unit_test(test_read_without_memory),
};

ENF_TEST_MAIN(tests)
