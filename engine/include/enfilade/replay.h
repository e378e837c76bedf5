/* Recorded input: what a person did, tick by tick, and a hash of the state that came of it (DESIGN §8).
 *
 * A simulation that is a pure function of its start and its inputs can be walked again, bit for bit. A recording holds its
 * input of every tick, a 64-bit hash of the whole state after every tick, and short hashes of the state's parts ("fields":
 * player, doors, guards, ...), so that whoever replays it learns the first tick that differs and the field that does. This
 * room knows nothing of the simulation: the caller steps it and hashes it.
 *
 *     record:  enf_recorder_create, then for each tick step, enf_recorder_tick; at the end enf_recorder_finish
 *     replay:  enf_replay_read, enf_replay_accept, then for each tick enf_replay_next, step, enf_replay_compare
 *
 * The file (.enfreplay) is a text header that a person can read with `head`, then chunks of ticks in binary, little-endian,
 * each under a CRC-32C; engine/replay/README.md has its layout. Files from strangers are safe to read: the whole of a
 * recording is checked when it is opened, and nothing that opened can fail later. */
#ifndef ENFILADE_REPLAY_H
#define ENFILADE_REPLAY_H

#include <enfilade/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The version of the file format: the first line of a recording is "enfreplay 1". */
#define ENF_REPLAY_VERSION 1

/* ---- input ------------------------------------------------------------------------------------------------------ */

/** Buttons held during a tick. Bits from 1 << 8 on are the game's. */
enum {
    ENF_BUTTON_JUMP = 1,
    ENF_BUTTON_CROUCH = 2,
    ENF_BUTTON_RUN = 4,
    ENF_BUTTON_USE = 8,
    ENF_BUTTON_DROP = 16,
    ENF_BUTTON_NOCLIP = 32,
    ENF_BUTTON_FLY = 64
};

/** Units of EnfInput's yaw and pitch in a degree. */
#define ENF_INPUT_DEGREE 65536

/** What the person did in one tick: integers, so that it is the same everywhere. 16 bytes, no padding. */
typedef struct EnfInput {
    int16_t forward, right; /**< -32767..32767 of full speed; negative is back and left */
    int32_t yaw, pitch;     /**< change in this tick, 1/65536 degree; yaw counter-clockwise, pitch up */
    uint32_t buttons;       /**< ENF_BUTTON_* that are down */
} EnfInput;

/* ---- header ----------------------------------------------------------------------------------------------------- */

#define ENF_REPLAY_FIELDS_MAX 32 /**< fields in a recording */
#define ENF_REPLAY_NAME_SIZE 32  /**< bytes of a field's name with its 0 */
#define ENF_REPLAY_TEXT_SIZE 256 /**< bytes of a text with its 0 */

/** What a recording says of itself. Texts are UTF-8 in one line (no byte below 32, no 127); anything longer is refused. */
typedef struct EnfReplayHeader {
    char engine[ENF_REPLAY_NAME_SIZE]; /**< the version that recorded; "" when recording: this one */
    char game[ENF_REPLAY_TEXT_SIZE];   /**< the simulation and its version, or "" */
    char map[ENF_REPLAY_TEXT_SIZE];    /**< the map's name, as its user knows it: for messages */
    char start[ENF_REPLAY_TEXT_SIZE];  /**< how the simulation began, in the game's own words ("guards=0"), or "" */
    char title[ENF_REPLAY_TEXT_SIZE];  /**< for people, or "" */
    char script[ENF_REPLAY_TEXT_SIZE]; /**< what it was made from, or "" */
    uint64_t map_hash;                 /**< EnfMap.hash */
    uint64_t seed;
    uint64_t start_hash;  /**< of the state before the first tick */
    uint32_t tick_rate;   /**< ticks a second, 1..1000 */
    uint32_t field_every; /**< fields are recorded after ticks 0, n, 2 n, ...; 1..65536 (1: names the field at once) */
    uint32_t field_count; /**< 0..ENF_REPLAY_FIELDS_MAX */
    char fields[ENF_REPLAY_FIELDS_MAX][ENF_REPLAY_NAME_SIZE]; /**< names: of a-z, 0-9, '_', '-' and '.', all different */
} EnfReplayHeader;

/** An empty header of this engine: 60 ticks a second, fields at every tick. */
EnfReplayHeader enf_replay_header_default(void);

/** The engine's version, e.g. "0.1.0": what `engine` of a new recording says. */
const char *enf_replay_engine(void);

/* ---- recording -------------------------------------------------------------------------------------------------- */

typedef struct EnfRecorder EnfRecorder;

/** Begins a recording that will be `path`. Ticks go to `path`.part, a chunk at a time, and are with the system from then on:
 *  if the process dies, that file holds all but the last chunk, and enf_replay_read salvages it. Until enf_recorder_finish,
 *  whatever was at `path` stays there. All memory (about 64 KiB) is taken here.
 *  Errors: ENF_ERROR_ARGUMENT (the header; the message names its field), ENF_ERROR_MEMORY, ENF_ERROR_IO. `*recorder` is then
 *  NULL. `allocator` may be NULL. One thread a recorder. */
EnfResult enf_recorder_create(EnfRecorder **recorder, const EnfReplayHeader *header, const char *path,
                              const EnfAllocator *allocator, EnfError *error);

/** Adds a tick: its input, the hash of the state after it, and the hashes of the header's fields in their order (NULL if
 *  there are none). No heap call; a system call once a chunk (256 ticks). After an error (ENF_ERROR_IO) every further call
 *  gives the same error and records nothing: the game may go on. */
EnfResult enf_recorder_tick(EnfRecorder *recorder, const EnfInput *input, uint64_t hash, const uint64_t *field_hashes,
                            EnfError *error);

/** Gives the ticks so far to the system: at a pause, say. Later ticks begin a new chunk. */
EnfResult enf_recorder_flush(EnfRecorder *recorder, EnfError *error);

/** Ticks so far. */
uint64_t enf_recorder_ticks(const EnfRecorder *recorder);

/** Ends the recording: the rest is written, flushed to the disk and renamed to `path`. The recorder is then closed and can
 *  only be destroyed. */
EnfResult enf_recorder_finish(EnfRecorder *recorder, EnfError *error);

/** Frees it. A recording that was not finished stays in `path`.part (with what was flushed; nothing is added), or is removed
 *  if `path`.part holds no tick. NULL is allowed. */
void enf_recorder_destroy(EnfRecorder *recorder);

/* ---- replaying -------------------------------------------------------------------------------------------------- */

/** The largest file that enf_replay_read takes: some days of play. */
#define ENF_REPLAY_FILE_MAX ((size_t)1 << 28)

typedef enum EnfReplayMode {
    ENF_REPLAY_WHOLE,  /**< a file that is cut or damaged is an error */
    ENF_REPLAY_SALVAGE /**< its sound chunks from the beginning are taken; `complete` is false then */
} EnfReplayMode;

/** A recording, opened. Plain data; it holds no pointer but to its bytes. */
typedef struct EnfReplay {
    EnfReplayHeader header;
    uint64_t ticks;         /**< in all */
    uint64_t final_hash;    /**< of the state after the last tick; start_hash if there is none */
    bool complete;          /**< it was finished, and is whole */
    EnfError damage;        /**< why it is not complete; code ENF_OK if it is */
    const uint8_t *data;    /**< the file */
    size_t size, body, end; /**< its size; where the first chunk begins; where the last sound one ends: bytes */
    EnfFile file;           /**< owns `data`, or empty */
} EnfReplay;

/** Opens the recording `path` and checks every byte of it. Free it with enf_replay_free.
 *  Errors, all with the byte offset: ENF_ERROR_IO, ENF_ERROR_MEMORY, ENF_ERROR_SIZE (the file); ENF_ERROR_MAGIC (no
 *  recording), ENF_ERROR_VERSION (a later format); ENF_ERROR_TRUNCATED (cut, or never finished), ENF_ERROR_CHECKSUM and
 *  ENF_ERROR_FORMAT (damaged). In mode ENF_REPLAY_SALVAGE only a bad header is an error. `*replay` is zeroed on errors.
 *  @guarantee No input makes it read outside the file, loop or allocate beyond the file's size; every truncation and every
 *  flipped byte is an error (tests/unit/test_replay_file, tests/fuzz/fuzz_replay). */
EnfResult enf_replay_read(EnfReplay *replay, const char *path, EnfReplayMode mode, const EnfAllocator *allocator,
                          EnfError *error);
/** The same from memory, which must outlive it. No heap. */
EnfResult enf_replay_view(EnfReplay *replay, const void *data, size_t size, EnfReplayMode mode, EnfError *error);
void enf_replay_free(EnfReplay *replay);

/** Whether the recording is of this engine, this game and this map. If not: ENF_ERROR_VERSION (engine, game) or
 *  ENF_ERROR_ARGUMENT (map), and the message names both: "recorded with ..., this is ...". `game` may be NULL (any). */
EnfResult enf_replay_accept(const EnfReplay *replay, const char *game, const char *map, uint64_t map_hash, EnfError *error);

/** A tick of a recording. */
typedef struct EnfReplayTick {
    uint64_t tick; /**< from 0 */
    EnfInput input;
    uint64_t hash;                          /**< of the state after it */
    bool has_fields;                        /**< `fields` were recorded at this tick */
    uint16_t fields[ENF_REPLAY_FIELDS_MAX]; /**< enf_replay_fold of each field's hash, as last recorded */
} EnfReplayTick;

/** A place in a recording, which it must not outlive. Plain data: a copy is a place to come back to. */
typedef struct EnfReplayCursor {
    const EnfReplay *replay;
    size_t chunk;                    /**< where the next chunk begins, bytes */
    EnfCursor inputs, hashes, marks; /**< the three streams of the chunk */
    uint32_t left;                   /**< ticks left in it */
    uint32_t repeats;                /**< ticks that the last input goes on for */
    EnfReplayTick now;
} EnfReplayCursor;

EnfReplayCursor enf_replay_begin(const EnfReplay *replay);
/** The next tick, which stays valid until the next call; NULL after the last. No heap. */
const EnfReplayTick *enf_replay_next(EnfReplayCursor *cursor);

/** The 16 bits that a recording keeps of a field's hash. */
uint16_t enf_replay_fold(uint64_t field_hash);

/** Where a replay left its recording. */
typedef struct EnfReplayDivergence {
    uint64_t tick;
    uint64_t recorded, replayed; /**< hashes of the whole state */
    bool has_fields;             /**< the recording has fields at this tick; else `differing` is 0 */
    uint32_t differing;          /**< bit i: field i of the header differs. May be 0: two field hashes in 65536 look equal */
} EnfReplayDivergence;

/** True if the state after `tick` is what was recorded; else false, and `*divergence` (may be NULL) says how it differs.
 *  `field_hashes`: in the order of the header's fields, or NULL. */
bool enf_replay_compare(const EnfReplay *replay, const EnfReplayTick *tick, uint64_t hash, const uint64_t *field_hashes,
                        EnfReplayDivergence *divergence);

#ifdef __cplusplus
}
#endif
#endif
