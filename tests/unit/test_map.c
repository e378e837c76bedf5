/* Map files: what is written is read, what is damaged is refused by name, and nothing that passes harms whoever uses it. */
#include "harness/purse.h"
#include "map/map_internal.h"
#include "scenes/everything.h"
#include "scenes/rooms.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static EnfMaker *make_everything(void) {
    EnfError error = {0};
    EnfMaker *maker = enf_everything_create(&error);
    if (!maker) {
        fail_msg("%s", error.message);
    }
    return maker;
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

/* ---- the rest ---------------------------------------------------------------------------------------------------------- */

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
static void test_read_without_memory(void **state) {
    (void)state;
    size_t size;
    free(everything_file(&size)); /* leaves map.enfmap */
    const char *path = enf_test_temp_path("map.enfmap");
    EnfResult result = ENF_ERROR_MEMORY;
    for (uint32_t blocks = 0; result != ENF_OK; blocks++) {
        Purse purse = purse_with(blocks);
        EnfAllocator allocator = purse_allocator(&purse);
        EnfMap map;
        EnfError error = {0};
        result = enf_map_read(&map, path, &allocator, &error);
        assert_int_equal(result, purse.refused ? ENF_ERROR_MEMORY : ENF_OK);
        assert_int_equal(map.cells != NULL, result == ENF_OK);
        enf_map_free(&map);
        purse_assert_whole(&purse);
        assert_in_range(blocks, result == ENF_OK, 16);
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
    cmocka_unit_test(test_round_trip),          cmocka_unit_test(test_layout),    cmocka_unit_test(test_read_errors),
    cmocka_unit_test(test_truncation),          cmocka_unit_test(test_bit_flips), cmocka_unit_test(test_resealed_damage),
    cmocka_unit_test(test_resealed_truncation), cmocka_unit_test(test_find_cell), cmocka_unit_test(test_empty),
    cmocka_unit_test(test_read_without_memory),
};

ENF_TEST_MAIN(tests)
