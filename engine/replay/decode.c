/* A chunk back into ticks. The bytes may be anybody's: every read goes through a sticky cursor, and a number that the
 * encoder would not have written is malformed. */
#include "replay/replay_internal.h"

#include <string.h>

EnfResult enf_replay_chunk_at(EnfReplayChunk *chunk, const EnfReplay *replay, size_t offset, uint64_t tick_first,
                              EnfError *error) {
    EnfCursor cursor = enf_cursor(replay->data, replay->size);
    cursor.offset = offset;
    uint32_t size = enf_cursor_u32(&cursor), first = enf_cursor_u32(&cursor);
    chunk->ticks = enf_cursor_u32(&cursor);
    chunk->input_size = enf_cursor_u32(&cursor);
    uint32_t crc = enf_cursor_u32(&cursor);
    const uint8_t *streams = enf_cursor_bytes(&cursor, size);
    if (!streams) {
        return enf_error_set(error, ENF_ERROR_TRUNCATED, offset, "the recording ends in the chunk that begins at tick %llu",
                             (unsigned long long)tick_first);
    }
    if (crc != enf_crc32c(enf_crc32c(0, replay->data + offset, 16), streams, size)) {
        return enf_error_set(error, ENF_ERROR_CHECKSUM, offset, "the chunk that begins at tick %llu is damaged",
                             (unsigned long long)tick_first);
    }
    uint64_t fixed = (uint64_t)chunk->ticks * 8 + chunk->input_size;
    bool is_end = chunk->ticks == 0;
    if (first != (tick_first & UINT32_MAX) || chunk->ticks > ENF_REPLAY_CHUNK_TICKS_MAX || fixed > size || (is_end && size)) {
        return enf_error_set(error, ENF_ERROR_FORMAT, offset, "the chunk that should begin at tick %llu has an impossible head",
                             (unsigned long long)tick_first);
    }
    chunk->offset = offset;
    chunk->size = cursor.offset - offset;
    return ENF_OK;
}

void enf_replay_enter_chunk(EnfReplayCursor *cursor, const EnfReplayChunk *chunk) {
    const uint8_t *at = cursor->replay->data + chunk->offset + ENF_REPLAY_CHUNK_HEAD;
    size_t hash_size = (size_t)chunk->ticks * 8, front = chunk->input_size + hash_size;
    cursor->inputs = enf_cursor(at, chunk->input_size);
    cursor->hashes = enf_cursor(at + chunk->input_size, hash_size);
    cursor->marks = enf_cursor(at + front, chunk->size - ENF_REPLAY_CHUNK_HEAD - front);
    cursor->chunk = chunk->offset + chunk->size;
    cursor->left = chunk->ticks;
    cursor->repeats = 0;
    memset(&cursor->now.input, 0, sizeof cursor->now.input);
    memset(cursor->now.fields, 0, sizeof cursor->now.fields);
}

/* ---- ticks ------------------------------------------------------------------------------------------------------ */

static uint32_t take_varint(EnfCursor *cursor) {
    uint64_t value = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
        uint8_t byte = enf_cursor_u8(cursor);
        value |= (uint64_t)(byte & 127) << shift;
        if (byte < 128) {
            cursor->failed |= value > UINT32_MAX || (byte == 0 && shift > 0);
            return cursor->failed ? 0 : (uint32_t)value;
        }
    }
    cursor->failed = true;
    return 0;
}

/* Modulo 2^32, as the encoder took the difference. */
static int32_t take_change(EnfCursor *cursor, int32_t from) {
    uint32_t zigzag = take_varint(cursor);
    uint32_t to = (uint32_t)from + (zigzag >> 1 ^ (0u - (zigzag & 1)));
    cursor->failed |= zigzag == 0; /* a change that is none */
    return to <= INT32_MAX ? (int32_t)to : -(int32_t)(UINT32_MAX - to) - 1;
}

static int16_t take_change_16(EnfCursor *cursor, int16_t from) {
    int32_t to = take_change(cursor, from);
    cursor->failed |= to < INT16_MIN || to > INT16_MAX;
    return cursor->failed ? 0 : (int16_t)to;
}

static void take_input(EnfReplayCursor *cursor) {
    EnfCursor *bytes = &cursor->inputs;
    EnfInput *input = &cursor->now.input;
    uint8_t what = enf_cursor_u8(bytes);
    bytes->failed |= (what & ~(ENF_REPLAY_REPEATS | 31)) != 0;
    if (what & ENF_REPLAY_FORWARD) {
        input->forward = take_change_16(bytes, input->forward);
    }
    if (what & ENF_REPLAY_RIGHT) {
        input->right = take_change_16(bytes, input->right);
    }
    if (what & ENF_REPLAY_YAW) {
        input->yaw = take_change(bytes, input->yaw);
    }
    if (what & ENF_REPLAY_PITCH) {
        input->pitch = take_change(bytes, input->pitch);
    }
    if (what & ENF_REPLAY_BUTTONS) {
        uint32_t buttons = take_varint(bytes);
        bytes->failed |= buttons == 0;
        input->buttons ^= buttons;
    }
    if (what & ENF_REPLAY_REPEATS) {
        cursor->repeats = take_varint(bytes);
        bytes->failed |= cursor->repeats == 0 || cursor->repeats >= cursor->left;
    }
}

static void take_fields(EnfReplayCursor *cursor) {
    uint32_t count = cursor->replay->header.field_count, changed = take_varint(&cursor->marks);
    cursor->marks.failed |= (uint64_t)changed >> count != 0;
    for (uint32_t i = 0; i < count && !cursor->marks.failed; i++) {
        if (changed >> i & 1) {
            uint32_t low = enf_cursor_u8(&cursor->marks), high = enf_cursor_u8(&cursor->marks);
            cursor->now.fields[i] = (uint16_t)(low | high << 8);
        }
    }
}

bool enf_replay_decode_tick(EnfReplayCursor *cursor) {
    const EnfReplayHeader *header = &cursor->replay->header;
    ENF_ASSERT(cursor->left > 0);
    if (cursor->repeats > 0) {
        cursor->repeats--;
    } else {
        take_input(cursor);
    }
    cursor->now.hash = enf_cursor_u64(&cursor->hashes);
    cursor->now.has_fields = header->field_count > 0 && cursor->now.tick % header->field_every == 0;
    if (cursor->now.has_fields) {
        take_fields(cursor);
    }
    cursor->left--;
    return !cursor->inputs.failed && !cursor->hashes.failed && !cursor->marks.failed;
}

bool enf_replay_chunk_is_spent(const EnfReplayCursor *cursor) {
    return cursor->inputs.offset == cursor->inputs.size && cursor->marks.offset == cursor->marks.size && cursor->repeats == 0;
}

/* ---- comparing -------------------------------------------------------------------------------------------------- */

uint16_t enf_replay_fold(uint64_t field_hash) {
    uint32_t half = (uint32_t)(field_hash ^ field_hash >> 32);
    return (uint16_t)(half ^ half >> 16);
}

bool enf_replay_compare(const EnfReplay *replay, const EnfReplayTick *tick, uint64_t hash, const uint64_t *field_hashes,
                        EnfReplayDivergence *divergence) {
    if (hash == tick->hash) {
        return true;
    }
    if (divergence) {
        EnfReplayDivergence found = {tick->tick, tick->hash, hash, tick->has_fields && field_hashes, 0};
        for (uint32_t i = 0; found.has_fields && i < replay->header.field_count; i++) {
            found.differing |= (uint32_t)(enf_replay_fold(field_hashes[i]) != tick->fields[i]) << i;
        }
        *divergence = found;
    }
    return false;
}
