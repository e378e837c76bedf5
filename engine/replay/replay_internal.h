/* What the room's files share: the text header and the chunks of .enfreplay. */
#ifndef ENFILADE_REPLAY_INTERNAL_H
#define ENFILADE_REPLAY_INTERNAL_H

#include <enfilade/replay.h>

enum {
    ENF_REPLAY_HEADER_MAX = 8192,             /* bytes of a text header: all texts and names at their longest, with room */
    ENF_REPLAY_CHUNK_TICKS = 256,             /* ticks that the recorder puts into a chunk: what a crash can lose, 4 seconds */
    ENF_REPLAY_CHUNK_TICKS_MAX = 4096,        /* and the most that the reader takes */
    ENF_REPLAY_CHUNK_HEAD = 20,               /* bytes */
    ENF_REPLAY_INPUT_MAX = 1 + 4 * 5 + 5 + 5, /* bytes of one tick's input: what changed, four changes, buttons, repeats */
    ENF_REPLAY_MARKS_MAX = 5 + 2 * ENF_REPLAY_FIELDS_MAX, /* bytes of one tick's fields */
    ENF_REPLAY_CHUNK_MAX = ENF_REPLAY_CHUNK_HEAD + ENF_REPLAY_CHUNK_TICKS * (ENF_REPLAY_INPUT_MAX + 8 + ENF_REPLAY_MARKS_MAX)
};

/* Bits of the byte before an input. */
enum {
    ENF_REPLAY_FORWARD = 1,
    ENF_REPLAY_RIGHT = 2,
    ENF_REPLAY_YAW = 4,
    ENF_REPLAY_PITCH = 8,
    ENF_REPLAY_BUTTONS = 16,
    ENF_REPLAY_REPEATS = 128
};

/* ---- header.c ---- */

/** ENF_ERROR_ARGUMENT with a message that names the member at fault. */
EnfResult enf_replay_check_header(const EnfReplayHeader *header, EnfError *error);
/** The header as text; returns its length. `header` is checked. */
size_t enf_replay_write_header(char text[ENF_REPLAY_HEADER_MAX], const EnfReplayHeader *header);
/** Parses the header at the start of `data`; `*length` is then where it ends. */
EnfResult enf_replay_parse_header(EnfReplayHeader *header, size_t *length, const uint8_t *data, size_t size, EnfError *error);

/* ---- encode.c ---- */

/** The ticks of a chunk, as they come. */
typedef struct EnfReplayEncoder {
    uint32_t field_count, field_every;
    uint64_t tick_first;
    uint32_t ticks;
    EnfInput input;                         /* the last */
    uint32_t repeats;                       /* of it, not written yet */
    size_t input_at;                        /* where its first byte is */
    uint16_t fields[ENF_REPLAY_FIELDS_MAX]; /* the last */
    size_t input_size, marks_size;
    uint8_t inputs[ENF_REPLAY_CHUNK_TICKS * ENF_REPLAY_INPUT_MAX];
    uint8_t hashes[ENF_REPLAY_CHUNK_TICKS * 8];
    uint8_t marks[ENF_REPLAY_CHUNK_TICKS * ENF_REPLAY_MARKS_MAX];
} EnfReplayEncoder;

/** Begins a chunk. */
void enf_replay_encode_begin(EnfReplayEncoder *encoder, const EnfReplayHeader *header, uint64_t tick_first);
/** Adds a tick; `encoder->ticks` is below ENF_REPLAY_CHUNK_TICKS. */
void enf_replay_encode_tick(EnfReplayEncoder *encoder, const EnfInput *input, uint64_t hash, const uint64_t *field_hashes);
/** The bytes of the chunk (of the end, if it has no ticks); returns their number. */
size_t enf_replay_encode_end(EnfReplayEncoder *encoder, uint8_t bytes[ENF_REPLAY_CHUNK_MAX]);

/* ---- decode.c ---- */

typedef struct EnfReplayChunk {
    size_t offset, size; /* of all of it, with its head, bytes */
    uint32_t ticks, input_size;
} EnfReplayChunk;

/** The chunk at `offset`, its bytes all there, its checksum right, its first tick `tick_first`. */
EnfResult enf_replay_chunk_at(EnfReplayChunk *chunk, const EnfReplay *replay, size_t offset, uint64_t tick_first,
                              EnfError *error);
/** Points the cursor at its streams. */
void enf_replay_enter_chunk(EnfReplayCursor *cursor, const EnfReplayChunk *chunk);
/** Takes the next tick of the cursor's chunk; false if the streams are malformed. */
bool enf_replay_decode_tick(EnfReplayCursor *cursor);
/** True if the chunk's ticks used its streams up. */
bool enf_replay_chunk_is_spent(const EnfReplayCursor *cursor);

#endif
