/* Ticks into a chunk: three streams (inputs by what changed, hashes, fields by what changed), then head and checksum. */
#include "replay/replay_internal.h"

#include <string.h>

static void put_bytes(uint8_t *at, uint64_t value, unsigned size) {
    for (unsigned i = 0; i < size; i++) {
        at[i] = (uint8_t)(value >> (8 * i));
    }
}

/* Seven bits a byte, the low ones first; the top bit says that more follow. */
static size_t put_varint(uint8_t *at, uint32_t value) {
    size_t size = 0;
    for (; value >= 128; value >>= 7) {
        at[size++] = (uint8_t)(value | 128);
    }
    at[size++] = (uint8_t)value;
    return size;
}

/* Small changes of either sign become small numbers. The difference wraps, and so does the reader's sum. */
static uint32_t zigzag(int32_t from, int32_t to) {
    uint32_t change = (uint32_t)to - (uint32_t)from;
    return change << 1 ^ (0u - (change >> 31));
}

void enf_replay_encode_begin(EnfReplayEncoder *encoder, const EnfReplayHeader *header, uint64_t tick_first) {
    encoder->field_count = header->field_count;
    encoder->field_every = header->field_every;
    encoder->tick_first = tick_first;
    encoder->ticks = encoder->repeats = 0;
    encoder->input_at = encoder->input_size = encoder->marks_size = 0;
    memset(&encoder->input, 0, sizeof encoder->input);
    memset(encoder->fields, 0, sizeof encoder->fields);
}

/* A run of equal inputs is written when it ends. */
static void end_run(EnfReplayEncoder *encoder) {
    if (encoder->repeats > 0) {
        encoder->inputs[encoder->input_at] |= ENF_REPLAY_REPEATS;
        encoder->input_size += put_varint(encoder->inputs + encoder->input_size, encoder->repeats);
        encoder->repeats = 0;
    }
}

static void put_input(EnfReplayEncoder *encoder, const EnfInput *input) {
    const EnfInput *last = &encoder->input;
    const uint32_t changes[5] = {zigzag(last->forward, input->forward), zigzag(last->right, input->right),
                                 zigzag(last->yaw, input->yaw), zigzag(last->pitch, input->pitch),
                                 last->buttons ^ input->buttons};
    bool same = !(changes[0] | changes[1] | changes[2] | changes[3] | changes[4]);
    if (same && encoder->ticks > 0) {
        encoder->repeats++;
        return;
    }
    end_run(encoder);
    encoder->input_at = encoder->input_size++;
    uint8_t what = 0;
    for (unsigned i = 0; i < 5; i++) {
        if (changes[i]) {
            what = (uint8_t)(what | 1u << i);
            encoder->input_size += put_varint(encoder->inputs + encoder->input_size, changes[i]);
        }
    }
    encoder->inputs[encoder->input_at] = what;
    encoder->input = *input;
}

static void put_fields(EnfReplayEncoder *encoder, const uint64_t *field_hashes) {
    uint32_t changed = 0;
    uint16_t folded[ENF_REPLAY_FIELDS_MAX];
    for (uint32_t i = 0; i < encoder->field_count; i++) {
        folded[i] = enf_replay_fold(field_hashes[i]);
        changed |= (uint32_t)(folded[i] != encoder->fields[i]) << i;
    }
    encoder->marks_size += put_varint(encoder->marks + encoder->marks_size, changed);
    for (uint32_t i = 0; i < encoder->field_count; i++) {
        if (changed >> i & 1) {
            put_bytes(encoder->marks + encoder->marks_size, folded[i], 2);
            encoder->marks_size += 2;
            encoder->fields[i] = folded[i];
        }
    }
}

void enf_replay_encode_tick(EnfReplayEncoder *encoder, const EnfInput *input, uint64_t hash, const uint64_t *field_hashes) {
    ENF_ASSERT(encoder->ticks < ENF_REPLAY_CHUNK_TICKS);
    put_input(encoder, input);
    put_bytes(encoder->hashes + (size_t)encoder->ticks * 8, hash, 8);
    if (encoder->field_count > 0 && (encoder->tick_first + encoder->ticks) % encoder->field_every == 0) {
        put_fields(encoder, field_hashes);
    }
    encoder->ticks++;
}

size_t enf_replay_encode_end(EnfReplayEncoder *encoder, uint8_t bytes[ENF_REPLAY_CHUNK_MAX]) {
    end_run(encoder);
    size_t hash_size = (size_t)encoder->ticks * 8, size = encoder->input_size + hash_size + encoder->marks_size;
    uint8_t *at = bytes + ENF_REPLAY_CHUNK_HEAD;
    memcpy(at, encoder->inputs, encoder->input_size);
    memcpy(at + encoder->input_size, encoder->hashes, hash_size);
    memcpy(at + encoder->input_size + hash_size, encoder->marks, encoder->marks_size);
    put_bytes(bytes, size, 4);
    put_bytes(bytes + 4, encoder->tick_first & UINT32_MAX, 4);
    put_bytes(bytes + 8, encoder->ticks, 4);
    put_bytes(bytes + 12, encoder->input_size, 4);
    put_bytes(bytes + 16, enf_crc32c(enf_crc32c(0, bytes, 16), at, size), 4);
    return ENF_REPLAY_CHUNK_HEAD + size;
}
