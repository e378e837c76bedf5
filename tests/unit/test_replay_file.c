/* Recordings as files: what goes in comes out; every truncation and every changed byte is refused; a dead writer's ticks are
 * salvaged; every failing malloc and system call is survived. */
#include "base/base_internal.h"
#include "harness/harness.h"
#include "harness/purse.h"
#include "replay/replay_internal.h"
#include "scenes/pacer.h"

#include <errno.h>
#include <stdio.h>
#include <unistd.h>

/* ---- input ------------------------------------------------------------------------------------------------------ */

/* Input as people give it (held for a while), with extremes among it. */
static EnfInput next_input(EnfTestRng *rng, const EnfInput *last) {
    static const int16_t speeds[4] = {0, 32767, -32767, -32768};
    EnfInput input = *last;
    if (enf_test_chance(rng, 4)) {
        input.forward = speeds[enf_test_below(rng, 4)];
        input.right = (int16_t)enf_test_u32(rng);
    }
    if (enf_test_chance(rng, 3)) {
        input.yaw = enf_test_chance(rng, 9) ? INT32_MIN : (int32_t)enf_test_below(rng, 200000) - 100000;
        input.pitch = enf_test_chance(rng, 9) ? INT32_MAX : 0;
    }
    if (enf_test_chance(rng, 5)) {
        input.buttons = enf_test_chance(rng, 2) ? enf_test_u32(rng) : ENF_BUTTON_USE;
    }
    return input;
}

/* Records `ticks` of a pacer into `path`; the input is of `stream`. */
static EnfResult record(const char *path, const EnfReplayHeader *header, uint64_t stream, uint32_t ticks,
                        const EnfAllocator *allocator, EnfError *error) {
    EnfTestRng rng = enf_test_rng_fixed(1, stream);
    Pacer pacer = pacer_start(header->seed);
    EnfInput input = {0, 0, 0, 0, 0};
    EnfRecorder *recorder;
    EnfResult result = enf_recorder_create(&recorder, header, path, allocator, error);
    for (uint32_t i = 0; i < ticks && result == ENF_OK; i++) {
        uint64_t fields[PACER_FIELDS];
        input = next_input(&rng, &input);
        pacer_step(&pacer, &input);
        pacer_fields(&pacer, fields);
        result = enf_recorder_tick(recorder, &input, pacer_hash(&pacer), fields, error);
    }
    if (result == ENF_OK) {
        result = enf_recorder_finish(recorder, error);
    }
    enf_recorder_destroy(recorder);
    return result;
}

static EnfReplayHeader header_of_seed(uint64_t seed, uint32_t field_every) {
    Pacer pacer = pacer_start(seed);
    EnfReplayHeader header = pacer_header(&pacer);
    header.seed = seed;
    header.field_every = field_every;
    return header;
}

/* Walks a pacer along the recording; the tick before which all were equal. */
static uint64_t walk(const EnfReplay *replay, Pacer pacer, EnfReplayDivergence *divergence) {
    EnfReplayCursor cursor = enf_replay_begin(replay);
    const EnfReplayTick *tick;
    uint64_t count = 0;
    while ((tick = enf_replay_next(&cursor)) != NULL) {
        uint64_t fields[PACER_FIELDS];
        assert_int_equal(tick->tick, count++);
        pacer_step(&pacer, &tick->input);
        pacer_fields(&pacer, fields);
        if (!enf_replay_compare(replay, tick, pacer_hash(&pacer), fields, divergence)) {
            return tick->tick;
        }
        for (int i = 0; tick->has_fields && i < PACER_FIELDS; i++) {
            assert_int_equal(tick->fields[i], enf_replay_fold(fields[i]));
        }
    }
    assert_null(enf_replay_next(&cursor));
    assert_int_equal(count, replay->ticks);
    return count;
}

/* ---- round trips ------------------------------------------------------------------------------------------------ */

static void recording_comes_back(void **state) {
    (void)state;
    static const uint32_t lengths[] = {0, 1, 255, 256, 257, 1000};
    for (uint32_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        const char *path = enf_test_temp_path("walk.enfreplay");
        EnfReplayHeader header = header_of_seed(i + 1, i % 3 == 0 ? 1 : 60);
        EnfError error;
        EnfReplay replay;
        assert_int_equal(record(path, &header, i, lengths[i], NULL, &error), ENF_OK);
        assert_int_equal(enf_replay_read(&replay, path, ENF_REPLAY_WHOLE, NULL, &error), ENF_OK);
        strcpy(header.engine, enf_replay_engine());
        assert_memory_equal(&replay.header, &header, sizeof header);
        assert_true(replay.complete && replay.ticks == lengths[i] && replay.end + ENF_REPLAY_CHUNK_HEAD == replay.size);
        assert_int_equal(walk(&replay, pacer_start(header.seed), NULL), lengths[i]);
        enf_replay_free(&replay);
        enf_replay_free(&replay);
    }
}

/* The very same inputs, extremes of all sizes among them. */
static void inputs_come_back(void **state) {
    (void)state;
    enum { COUNT = 5000 };
    static EnfInput inputs[COUNT];
    EnfTestRng rng = enf_test_rng(1);
    EnfReplayHeader header = enf_replay_header_default();
    const char *path = enf_test_temp_path("inputs.enfreplay");
    EnfRecorder *recorder;
    EnfError error;
    assert_int_equal(enf_recorder_create(&recorder, &header, path, NULL, &error), ENF_OK);
    for (uint32_t i = 0; i < COUNT; i++) {
        inputs[i] = next_input(&rng, &inputs[i ? i - 1 : 0]);
        assert_int_equal(enf_recorder_tick(recorder, &inputs[i], i * UINT64_C(0x0123456789), NULL, &error), ENF_OK);
        if (enf_test_chance(&rng, 300)) {
            assert_int_equal(enf_recorder_flush(recorder, &error), ENF_OK);
        }
    }
    assert_int_equal(enf_recorder_ticks(recorder), COUNT);
    assert_int_equal(enf_recorder_finish(recorder, &error), ENF_OK);
    enf_recorder_destroy(recorder);
    EnfReplay replay;
    assert_int_equal(enf_replay_read(&replay, path, ENF_REPLAY_WHOLE, NULL, &error), ENF_OK);
    EnfReplayCursor cursor = enf_replay_begin(&replay);
    for (uint32_t i = 0; i < COUNT; i++) {
        const EnfReplayTick *tick = enf_replay_next(&cursor);
        assert_non_null(tick);
        assert_memory_equal(&tick->input, &inputs[i], sizeof *inputs);
        assert_true(tick->hash == i * UINT64_C(0x0123456789) && !tick->has_fields);
    }
    assert_true(replay.final_hash == (COUNT - 1) * UINT64_C(0x0123456789));
    enf_replay_free(&replay);
}

/* A person who stands still costs the hashes and next to nothing more. */
static void recording_is_small(void **state) {
    (void)state;
    enum { COUNT = 36000 };
    EnfReplayHeader header = enf_replay_header_default();
    const char *path = enf_test_temp_path("still.enfreplay");
    EnfRecorder *recorder;
    EnfError error;
    EnfReplay replay;
    const EnfInput input = {32767, 0, 0, 0, ENF_BUTTON_RUN};
    assert_int_equal(enf_recorder_create(&recorder, &header, path, NULL, &error), ENF_OK);
    for (uint32_t i = 0; i < COUNT; i++) {
        assert_int_equal(enf_recorder_tick(recorder, &input, i, NULL, &error), ENF_OK);
    }
    assert_int_equal(enf_recorder_finish(recorder, &error), ENF_OK);
    enf_recorder_destroy(recorder);
    assert_int_equal(enf_replay_read(&replay, path, ENF_REPLAY_WHOLE, NULL, &error), ENF_OK);
    assert_true(replay.size < 8 * COUNT + 32 * (COUNT / 256) + 400);
    enf_replay_free(&replay);
}

/* ---- divergence, refusal ---------------------------------------------------------------------------------------- */

static void divergence_is_named(void **state) {
    (void)state;
    const char *path = enf_test_temp_path("other.enfreplay");
    EnfReplayHeader header = header_of_seed(7, 1);
    EnfError error;
    EnfReplay replay;
    EnfReplayDivergence divergence;
    assert_int_equal(record(path, &header, 3, 600, NULL, &error), ENF_OK);
    assert_int_equal(enf_replay_read(&replay, path, ENF_REPLAY_WHOLE, NULL, &error), ENF_OK);
    assert_int_equal(walk(&replay, pacer_start(9), &divergence), 0);
    assert_true(divergence.tick == 0 && divergence.has_fields && divergence.differing == 2);
    assert_true(divergence.recorded != divergence.replayed);
    Pacer elsewhere = pacer_start(7);
    elsewhere.x = 1;
    assert_int_equal(walk(&replay, elsewhere, &divergence), 0);
    assert_int_equal(divergence.differing, 1);
    elsewhere = pacer_start(7);
    elsewhere.used = 1;
    assert_int_equal(walk(&replay, elsewhere, NULL), 0);
    enf_replay_free(&replay);
}

static void foreign_recording_is_refused_by_name(void **state) {
    (void)state;
    const char *path = enf_test_temp_path("foreign.enfreplay");
    EnfReplayHeader header = header_of_seed(7, 1);
    EnfError error;
    EnfReplay replay;
    strcpy(header.engine, "0.0.9");
    assert_int_equal(record(path, &header, 3, 5, NULL, &error), ENF_OK);
    assert_int_equal(enf_replay_read(&replay, path, ENF_REPLAY_WHOLE, NULL, &error), ENF_OK);
    assert_int_equal(enf_replay_accept(&replay, "pacer 1", "floor", header.map_hash, &error), ENF_ERROR_VERSION);
    assert_non_null(strstr(error.message, "recorded with Enfilade 0.0.9, this is Enfilade"));
    strcpy(replay.header.engine, enf_replay_engine());
    assert_int_equal(enf_replay_accept(&replay, "pacer 1", "floor", header.map_hash, &error), ENF_OK);
    assert_int_equal(enf_replay_accept(&replay, NULL, NULL, header.map_hash, NULL), ENF_OK);
    assert_int_equal(enf_replay_accept(&replay, "pacer 2", "floor", header.map_hash, &error), ENF_ERROR_VERSION);
    assert_non_null(strstr(error.message, "'pacer 1', this is the game 'pacer 2'"));
    assert_int_equal(enf_replay_accept(&replay, "pacer 1", "roof", 5, &error), ENF_ERROR_ARGUMENT);
    assert_non_null(
        strstr(error.message, "recorded with the map floor (0123456789abcdef), this is the map roof (00000000000000"));
    enf_replay_free(&replay);
}

static void expect_bad_header(const EnfReplayHeader *header, const char *message) {
    EnfRecorder *recorder = (EnfRecorder *)8;
    EnfError error;
    assert_int_equal(enf_recorder_create(&recorder, header, enf_test_temp_path("bad"), NULL, &error), ENF_ERROR_ARGUMENT);
    assert_null(recorder);
    assert_non_null(strstr(error.message, message));
}

static void bad_header_is_refused(void **state) {
    (void)state;
    const EnfReplayHeader good = header_of_seed(7, 1);
    EnfReplayHeader header = good;
    strcpy(header.title, "two\nlines");
    expect_bad_header(&header, "'title'");
    memset(header.title, 'x', sizeof header.title);
    expect_bad_header(&header, "'title'");
    header = good;
    strcpy(header.engine, "\x7f");
    expect_bad_header(&header, "'engine'");
    header = good;
    header.tick_rate = 0;
    expect_bad_header(&header, "tick_rate");
    header = good;
    header.field_every = 65537;
    expect_bad_header(&header, "field_every");
    header = good;
    header.field_count = 33;
    expect_bad_header(&header, "32 fields");
    header = good;
    strcpy(header.fields[1], "walker");
    expect_bad_header(&header, "one name");
    strcpy(header.fields[1], "Walker");
    expect_bad_header(&header, "a field's name");
    memset(header.fields[1], 'x', sizeof header.fields[1]);
    expect_bad_header(&header, "a field's name");
    assert_int_not_equal(access(enf_test_temp_path("bad.part"), F_OK), 0);
}

/* The longest header that may be recorded can be read. */
static void longest_header_comes_back(void **state) {
    (void)state;
    EnfReplayHeader header = enf_replay_header_default();
    char *const texts[5] = {header.game, header.map, header.start, header.title, header.script};
    for (int i = 0; i < 5; i++) {
        memset(texts[i], 'a' + i, ENF_REPLAY_TEXT_SIZE - 1);
    }
    memset(header.engine, '9', sizeof header.engine - 1);
    header.map_hash = header.seed = header.start_hash = UINT64_MAX;
    header.tick_rate = 1000;
    header.field_every = 65536;
    header.field_count = ENF_REPLAY_FIELDS_MAX;
    for (int i = 0; i < ENF_REPLAY_FIELDS_MAX; i++) {
        memset(header.fields[i], 'a' + i % 26, ENF_REPLAY_NAME_SIZE - 1);
        header.fields[i][0] = (char)('0' + i / 26);
    }
    EnfRecorder *recorder;
    EnfError error;
    EnfReplay replay;
    const char *path = enf_test_temp_path("long.enfreplay");
    uint64_t fields[ENF_REPLAY_FIELDS_MAX];
    const EnfInput input = {INT16_MIN, INT16_MAX, INT32_MIN, INT32_MAX, UINT32_MAX};
    assert_int_equal(enf_recorder_create(&recorder, &header, path, NULL, &error), ENF_OK);
    for (uint64_t tick = 0; tick < 600; tick++) { /* the largest chunks, too */
        for (uint64_t i = 0; i < ENF_REPLAY_FIELDS_MAX; i++) {
            fields[i] = tick + i + 1;
        }
        const EnfInput opposite = {INT16_MAX, INT16_MIN, INT32_MAX, INT32_MIN, 0};
        assert_int_equal(enf_recorder_tick(recorder, tick % 2 ? &input : &opposite, tick, fields, &error), ENF_OK);
    }
    assert_int_equal(enf_recorder_finish(recorder, &error), ENF_OK);
    enf_recorder_destroy(recorder);
    assert_int_equal(enf_replay_read(&replay, path, ENF_REPLAY_WHOLE, NULL, &error), ENF_OK);
    assert_memory_equal(&replay.header, &header, sizeof header);
    assert_int_equal(replay.ticks, 600);
    enf_replay_free(&replay);
}

/* ---- damage ----------------------------------------------------------------------------------------------------- */

/* A block of exactly `size` bytes: an over-read shows under ASan. */
static EnfResult view_copy(const uint8_t *data, size_t size, EnfReplayMode mode, EnfReplay *replay, EnfError *error) {
    uint8_t *copy = malloc(size ? size : 1);
    assert_non_null(copy);
    memcpy(copy, data, size);
    EnfResult result = enf_replay_view(replay, copy, size, mode, error);
    if (result == ENF_OK) {
        EnfReplayCursor cursor = enf_replay_begin(replay);
        uint64_t ticks = 0;
        while (enf_replay_next(&cursor)) {
            ticks++;
        }
        assert_true(ticks == replay->ticks);
    }
    free(copy);
    return result;
}

static uint8_t *recorded_bytes(uint32_t ticks, size_t *size) {
    const char *path = enf_test_temp_path("damage.enfreplay");
    EnfReplayHeader header = header_of_seed(11, 16);
    EnfError error;
    assert_int_equal(record(path, &header, 5, ticks, NULL, &error), ENF_OK);
    return enf_test_read_file(path, size);
}

static void every_truncation_is_refused_or_salvaged(void **state) {
    (void)state;
    size_t size;
    uint8_t *bytes = recorded_bytes(600, &size);
    uint64_t last = 0;
    for (size_t length = 0; length < size; length++) {
        EnfReplay replay;
        EnfError error = {0};
        EnfResult result = view_copy(bytes, length, ENF_REPLAY_WHOLE, &replay, &error);
        assert_int_equal(result, length < strlen("enfreplay ") ? ENF_ERROR_MAGIC : ENF_ERROR_TRUNCATED);
        assert_true(error.offset <= length && error.message[0] && !replay.data);
        if (view_copy(bytes, length, ENF_REPLAY_SALVAGE, &replay, &error) == ENF_OK) {
            assert_true(!replay.complete && replay.damage.code == ENF_ERROR_TRUNCATED && replay.ticks >= last);
            last = replay.ticks;
        }
    }
    assert_int_equal(last, 600);
    free(bytes);
}

static void every_changed_byte_is_refused(void **state) {
    (void)state;
    size_t size;
    uint8_t *bytes = recorded_bytes(300, &size);
    for (size_t at = 0; at < size; at++) {
        for (unsigned change = 1; change < 256; change = change << 1 | (change >> 6 & 1)) {
            EnfReplay replay;
            EnfError error = {0};
            bytes[at] = (uint8_t)(bytes[at] ^ change);
            EnfResult result = view_copy(bytes, size, ENF_REPLAY_WHOLE, &replay, &error);
            assert_int_not_equal(result, ENF_OK);
            assert_true(error.message[0] && error.offset <= size);
            view_copy(bytes, size, ENF_REPLAY_SALVAGE, &replay, &error);
            bytes[at] = (uint8_t)(bytes[at] ^ change);
        }
    }
    free(bytes);
}

/* Past the checksums: damage under a checksum made right again is refused or decodes, and never reads outside. */
static void damage_under_a_right_checksum_is_survived(void **state) {
    (void)state;
    size_t size;
    uint8_t *bytes = recorded_bytes(200, &size);
    EnfReplay whole, replay;
    EnfError error;
    assert_int_equal(enf_replay_view(&whole, bytes, size, ENF_REPLAY_WHOLE, &error), ENF_OK);
    uint8_t *head = bytes + whole.body, *streams = head + ENF_REPLAY_CHUNK_HEAD;
    size_t length = whole.end - whole.body - ENF_REPLAY_CHUNK_HEAD;
    EnfTestRng rng = enf_test_rng(2);
    uint32_t refused = 0, rounds = enf_test_rounds(5000, 200000);
    for (uint32_t i = 0; i < rounds; i++) {
        uint8_t *at = enf_test_chance(&rng, 5) ? head + enf_test_below(&rng, 16)
                                               : streams + enf_test_below(&rng, (uint32_t)length);
        uint8_t old = *at;
        *at = (uint8_t)enf_test_u32(&rng);
        uint32_t crc = enf_crc32c(enf_crc32c(0, head, 16), streams, length);
        for (unsigned k = 0; k < 4; k++) {
            head[16 + k] = (uint8_t)(crc >> (8 * k));
        }
        refused += view_copy(bytes, size, ENF_REPLAY_WHOLE, &replay, &error) != ENF_OK;
        *at = old;
    }
    assert_true(refused > rounds / 20);
    free(bytes);
}

static void later_format_is_refused(void **state) {
    (void)state;
    EnfReplay replay;
    EnfError error;
    static const char later[] = "enfreplay 2\nengine 9\n";
    assert_int_equal(enf_replay_view(&replay, later, sizeof later - 1, ENF_REPLAY_WHOLE, &error), ENF_ERROR_VERSION);
    assert_non_null(strstr(error.message, "format 2"));
    assert_int_equal(enf_replay_view(&replay, "glTF", 4, ENF_REPLAY_SALVAGE, &error), ENF_ERROR_MAGIC);
    assert_int_equal(enf_replay_read(&replay, enf_test_temp_path("absent"), ENF_REPLAY_WHOLE, NULL, &error), ENF_ERROR_IO);
}

static void what_follows_the_end_is_refused(void **state) {
    (void)state;
    size_t size;
    uint8_t *bytes = recorded_bytes(10, &size);
    uint8_t *longer = malloc(size + 1);
    assert_non_null(longer);
    memcpy(longer, bytes, size);
    longer[size] = 0;
    EnfReplay replay;
    EnfError error;
    assert_int_equal(view_copy(longer, size + 1, ENF_REPLAY_WHOLE, &replay, &error), ENF_ERROR_FORMAT);
    assert_int_equal(error.offset, size);
    free(longer);
    free(bytes);
}

/* ---- death of the writer, failures ------------------------------------------------------------------------------ */

static void unfinished_recording_is_salvaged(void **state) {
    (void)state;
    const char *path = enf_test_temp_path("died.enfreplay"), *part = enf_test_temp_path("died.enfreplay.part");
    EnfReplayHeader header = header_of_seed(2, 1);
    EnfRecorder *recorder;
    EnfError error;
    EnfReplay replay;
    const EnfInput input = {1, 2, 3, 4, 5};
    const uint64_t fields[PACER_FIELDS] = {1, 2, 3};
    enf_test_write_file(path, "old", 3);
    assert_int_equal(enf_recorder_create(&recorder, &header, path, NULL, &error), ENF_OK);
    for (uint32_t i = 0; i < 700; i++) {
        assert_int_equal(enf_recorder_tick(recorder, &input, i, fields, &error), ENF_OK);
    }
    /* The file is read while its writer lives, as after its death: two chunks are there. */
    assert_int_equal(enf_replay_read(&replay, part, ENF_REPLAY_WHOLE, NULL, &error), ENF_ERROR_TRUNCATED);
    assert_non_null(strstr(error.message, "never finished: it ends after 512 ticks"));
    assert_int_equal(enf_replay_read(&replay, part, ENF_REPLAY_SALVAGE, NULL, &error), ENF_OK);
    assert_true(replay.ticks == 512 && !replay.complete && replay.final_hash == 511);
    assert_string_equal(replay.damage.file, part);
    enf_replay_free(&replay);
    assert_int_equal(enf_recorder_flush(recorder, &error), ENF_OK);
    enf_recorder_destroy(recorder);
    assert_int_equal(enf_replay_read(&replay, part, ENF_REPLAY_SALVAGE, NULL, &error), ENF_OK);
    assert_int_equal(replay.ticks, 700);
    enf_replay_free(&replay);
    size_t size;
    uint8_t *old = enf_test_read_file(path, &size);
    assert_true(size == 3 && memcmp(old, "old", 3) == 0); /* what was there is there */
    free(old);
    assert_int_equal(enf_recorder_create(&recorder, &header, path, NULL, &error), ENF_OK);
    enf_recorder_destroy(recorder); /* of no tick */
    assert_int_not_equal(access(part, F_OK), 0);
}

static void every_failing_malloc_is_survived(void **state) {
    (void)state;
    const char *path = enf_test_temp_path("poor.enfreplay");
    EnfReplayHeader header = header_of_seed(2, 1);
    for (uint32_t budget = 0;; budget++) {
        Purse purse = purse_with(budget);
        const EnfAllocator allocator = purse_allocator(&purse);
        EnfError error = {0};
        EnfReplay replay;
        EnfResult result = record(path, &header, 1, 300, &allocator, &error);
        if (result == ENF_OK && (result = enf_replay_read(&replay, path, ENF_REPLAY_WHOLE, &allocator, &error)) == ENF_OK) {
            enf_replay_free(&replay);
        }
        purse_assert_whole(&purse);
        assert_int_equal(purse.refused > 0, result != ENF_OK);
        if (result == ENF_OK) {
            assert_true(budget >= 3);
            return;
        }
        assert_int_equal(result, ENF_ERROR_MEMORY);
    }
}

static int calls_left;

static bool fails(void) {
    errno = ENOSPC;
    return calls_left-- == 0;
}

static int try_open(const char *path, int flags, mode_t mode) {
    return fails() ? -1 : enf_file_system_calls()->open(path, flags, mode);
}
static ssize_t try_write(int fd, const void *data, size_t size) {
    return fails() ? -1 : enf_file_system_calls()->write(fd, data, size);
}
static int try_fsync(int fd) {
    return fails() ? -1 : enf_file_system_calls()->fsync(fd);
}
static int try_close(int fd) {
    int result = enf_file_system_calls()->close(fd);
    return fails() ? -1 : result;
}
static int try_rename(const char *from, const char *to) {
    return fails() ? -1 : enf_file_system_calls()->rename(from, to);
}

static void every_failing_call_is_survived(void **state) {
    (void)state;
    const char *path = enf_test_temp_path("full.enfreplay");
    EnfReplayHeader header = header_of_seed(2, 1);
    EnfFileCalls failing = *enf_file_system_calls();
    failing.open = try_open;
    failing.write = try_write;
    failing.fsync = try_fsync;
    failing.close = try_close;
    failing.rename = try_rename;
    enf_file_set_calls(&failing);
    EnfResult result = ENF_ERROR_IO;
    int site = 0;
    for (; result != ENF_OK; site++) {
        EnfError error = {0};
        calls_left = site;
        result = record(path, &header, 1, 600, NULL, &error);
        if (result != ENF_OK) {
            assert_int_equal(result, ENF_ERROR_IO);
            assert_string_equal(error.file, path);
            assert_non_null(strstr(error.message, strerror(ENOSPC)));
        }
    }
    enf_file_set_calls(NULL);
    assert_true(site > 10); /* open, header, three chunks, end, fsync, close, rename, folder */
    EnfReplay replay;
    assert_int_equal(enf_replay_read(&replay, path, ENF_REPLAY_WHOLE, NULL, NULL), ENF_OK);
    enf_replay_free(&replay);
}

/* After the disk was full, the game may go on calling. */
static void failure_is_sticky(void **state) {
    (void)state;
    EnfReplayHeader header = enf_replay_header_default();
    EnfRecorder *recorder;
    EnfError error;
    const EnfInput input = {0, 0, 0, 0, 0};
    if (access("/dev/full", W_OK) != 0) {
        printf("no /dev/full\n");
        skip();
    }
    EnfResult result = enf_recorder_create(&recorder, &header, "/dev/full", NULL, &error);
    assert_int_equal(result, ENF_ERROR_IO); /* the header already */
    assert_null(recorder);
    EnfFileCalls failing = *enf_file_system_calls();
    failing.write = try_write;
    calls_left = 1;
    enf_file_set_calls(&failing);
    assert_int_equal(enf_recorder_create(&recorder, &header, enf_test_temp_path("sticky"), NULL, &error), ENF_OK);
    for (uint32_t i = 0; i < 1000; i++) {
        memset(&error, 0, sizeof error);
        result = enf_recorder_tick(recorder, &input, i, NULL, &error);
        assert_int_equal(result, i < 255 ? ENF_OK : ENF_ERROR_IO);
        assert_int_equal(error.code, result);
    }
    assert_int_equal(enf_recorder_finish(recorder, &error), ENF_ERROR_IO);
    enf_recorder_destroy(recorder);
    enf_file_set_calls(NULL);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(recording_comes_back),
    cmocka_unit_test(inputs_come_back),
    cmocka_unit_test(recording_is_small),
    cmocka_unit_test(divergence_is_named),
    cmocka_unit_test(foreign_recording_is_refused_by_name),
    cmocka_unit_test(bad_header_is_refused),
    cmocka_unit_test(longest_header_comes_back),
    cmocka_unit_test(every_truncation_is_refused_or_salvaged),
    cmocka_unit_test(every_changed_byte_is_refused),
    cmocka_unit_test(damage_under_a_right_checksum_is_survived),
    cmocka_unit_test(later_format_is_refused),
    cmocka_unit_test(what_follows_the_end_is_refused),
    cmocka_unit_test(unfinished_recording_is_salvaged),
    cmocka_unit_test(every_failing_malloc_is_survived),
    cmocka_unit_test(every_failing_call_is_survived),
    cmocka_unit_test(failure_is_sticky),
};

ENF_TEST_MAIN(tests)
