/* links: core */
/* Any bytes as a recording: refused with a message and an offset, or sound enough to be played to its end.
 * Checksums would refuse nearly everything, so the chunks are also taken with theirs made right. */
#define _XOPEN_SOURCE 700
#include "replay/replay_internal.h"

#include <stdlib.h>
#include <string.h>

#include "fuzz/fuzz.h"

/* Plays it to its end. */
static void play(const EnfReplay *replay) {
    EnfReplayCursor cursor = enf_replay_begin(replay);
    const EnfReplayTick *tick;
    uint64_t ticks = 0;
    while ((tick = enf_replay_next(&cursor)) != NULL) {
        if (tick->tick != ticks++) {
            __builtin_trap();
        }
    }
    if (ticks != replay->ticks) {
        __builtin_trap();
    }
}

static void look(const uint8_t *data, size_t size, EnfReplayMode mode) {
    EnfReplay replay;
    EnfError error = {0};
    EnfResult result = enf_replay_view(&replay, data, size, mode, &error);
    if (result == ENF_OK) {
        play(&replay);
    } else if (!error.message[0] || error.offset > size) {
        __builtin_trap(); /* refused without a word, or nowhere */
    }
}

/* The chunks with right checksums and first ticks, as far as their sizes lead. */
static void repair(uint8_t *data, size_t size, size_t body) {
    uint64_t tick = 0;
    for (size_t at = body; size - at >= ENF_REPLAY_CHUNK_HEAD;) {
        EnfCursor head = enf_cursor(data + at, size - at);
        size_t length = enf_cursor_u32(&head);
        if (length > size - at - ENF_REPLAY_CHUNK_HEAD) {
            return;
        }
        for (unsigned k = 0; k < 4; k++) {
            data[at + 4 + k] = (uint8_t)(tick >> (8 * k));
        }
        uint32_t crc = enf_crc32c(enf_crc32c(0, data + at, 16), data + at + ENF_REPLAY_CHUNK_HEAD, length);
        for (unsigned k = 0; k < 4; k++) {
            data[at + 16 + k] = (uint8_t)(crc >> (8 * k));
        }
        enf_cursor_u32(&head);
        tick += enf_cursor_u32(&head);
        at += ENF_REPLAY_CHUNK_HEAD + length;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    look(data, size, ENF_REPLAY_WHOLE);
    look(data, size, ENF_REPLAY_SALVAGE);
    EnfReplayHeader header;
    size_t body = 0;
    if (enf_replay_parse_header(&header, &body, data, size, NULL) == ENF_OK) {
        uint8_t *copy = malloc(size);
        if (copy) {
            memcpy(copy, data, size);
            repair(copy, size, body);
            look(copy, size, ENF_REPLAY_WHOLE);
            look(copy, size, ENF_REPLAY_SALVAGE);
        }
        free(copy);
    }
    return 0;
}
