/* A recording from untrusted bytes: the header parsed, every chunk's checksum and every tick of it checked when it is opened,
 * so that whoever replays it later meets no error. */
#include "replay/replay_internal.h"

#include <string.h>

/* Decodes all ticks of a chunk; on success the replay ends behind it. */
static EnfResult check_chunk(EnfReplay *replay, const EnfReplayChunk *chunk, EnfError *error) {
    EnfReplayCursor cursor;
    memset(&cursor, 0, sizeof cursor);
    cursor.replay = replay;
    enf_replay_enter_chunk(&cursor, chunk);
    for (uint32_t i = 0; i < chunk->ticks; i++) {
        cursor.now.tick = replay->ticks + i;
        if (!enf_replay_decode_tick(&cursor)) {
            return enf_error_set(error, ENF_ERROR_FORMAT, chunk->offset, "tick %llu of the recording is malformed",
                                 (unsigned long long)cursor.now.tick);
        }
    }
    if (!enf_replay_chunk_is_spent(&cursor)) {
        return enf_error_set(error, ENF_ERROR_FORMAT, chunk->offset,
                             "the chunk that begins at tick %llu holds more than its ticks", (unsigned long long)replay->ticks);
    }
    replay->ticks += chunk->ticks;
    replay->final_hash = cursor.now.hash;
    replay->end = chunk->offset + chunk->size;
    return ENF_OK;
}

static EnfResult check_chunks(EnfReplay *replay, EnfError *error) {
    for (;;) {
        EnfReplayChunk chunk;
        if (replay->end == replay->size) {
            return enf_error_set(error, ENF_ERROR_TRUNCATED, replay->end,
                                 "the recording was never finished: it ends after %llu ticks",
                                 (unsigned long long)replay->ticks);
        }
        EnfResult result = enf_replay_chunk_at(&chunk, replay, replay->end, replay->ticks, error);
        if (result != ENF_OK) {
            return result;
        }
        if (chunk.ticks == 0) {
            break;
        }
        if ((result = check_chunk(replay, &chunk, error)) != ENF_OK) {
            return result;
        }
    }
    size_t last = replay->end + ENF_REPLAY_CHUNK_HEAD;
    if (last != replay->size) {
        return enf_error_set(error, ENF_ERROR_FORMAT, last, "something follows the end of the recording");
    }
    return ENF_OK;
}

EnfResult enf_replay_view(EnfReplay *replay, const void *data, size_t size, EnfReplayMode mode, EnfError *error) {
    memset(replay, 0, sizeof *replay);
    EnfReplayHeader header;
    size_t body = 0;
    EnfResult result = enf_replay_parse_header(&header, &body, data, size, error);
    if (result != ENF_OK) {
        return result;
    }
    replay->header = header;
    replay->data = data;
    replay->size = size;
    replay->body = replay->end = body;
    replay->final_hash = header.start_hash;
    result = check_chunks(replay, &replay->damage);
    replay->complete = result == ENF_OK;
    if (result != ENF_OK && mode == ENF_REPLAY_WHOLE) {
        if (error) {
            *error = replay->damage;
        }
        memset(replay, 0, sizeof *replay);
        return result;
    }
    return ENF_OK;
}

EnfResult enf_replay_read(EnfReplay *replay, const char *path, EnfReplayMode mode, const EnfAllocator *allocator,
                          EnfError *error) {
    memset(replay, 0, sizeof *replay);
    EnfFile file;
    EnfResult result = enf_file_read(&file, path, ENF_REPLAY_FILE_MAX, allocator, error);
    if (result != ENF_OK) {
        return result;
    }
    if ((result = enf_replay_view(replay, file.data, file.size, mode, error)) != ENF_OK) {
        enf_file_free(&file);
        return enf_error_file(error, result, path);
    }
    replay->file = file;
    if (!replay->complete) {
        enf_error_file(&replay->damage, replay->damage.code, path);
    }
    return ENF_OK;
}

void enf_replay_free(EnfReplay *replay) {
    if (replay->file.allocator) {
        enf_file_free(&replay->file);
    }
    memset(replay, 0, sizeof *replay);
}

EnfResult enf_replay_accept(const EnfReplay *replay, const char *game, const char *map, uint64_t map_hash, EnfError *error) {
    const EnfReplayHeader *header = &replay->header;
    if (strcmp(header->engine, ENF_VERSION) != 0) {
        return enf_error_set(error, ENF_ERROR_VERSION, UINT64_MAX, "recorded with Enfilade %s, this is Enfilade %s",
                             header->engine, ENF_VERSION);
    }
    if (game && strcmp(header->game, game) != 0) {
        return enf_error_set(error, ENF_ERROR_VERSION, UINT64_MAX, "recorded with the game '%s', this is the game '%s'",
                             header->game, game);
    }
    if (header->map_hash != map_hash) {
        return enf_error_set(error, ENF_ERROR_ARGUMENT, UINT64_MAX,
                             "recorded with the map %s (%016llx), this is the map %s (%016llx)", header->map,
                             (unsigned long long)header->map_hash, map ? map : "", (unsigned long long)map_hash);
    }
    return ENF_OK;
}

/* ---- playing ---------------------------------------------------------------------------------------------------- */

EnfReplayCursor enf_replay_begin(const EnfReplay *replay) {
    EnfReplayCursor cursor;
    memset(&cursor, 0, sizeof cursor);
    cursor.replay = replay;
    cursor.chunk = replay->body;
    cursor.now.tick = UINT64_MAX; /* the one before tick 0 */
    return cursor;
}

const EnfReplayTick *enf_replay_next(EnfReplayCursor *cursor) {
    cursor->now.tick++;
    if (cursor->now.tick >= cursor->replay->ticks) {
        cursor->now.tick = cursor->replay->ticks - 1;
        return NULL;
    }
    if (cursor->left == 0) {
        EnfReplayChunk chunk;
        if (enf_replay_chunk_at(&chunk, cursor->replay, cursor->chunk, cursor->now.tick, NULL) != ENF_OK) {
            return NULL; /* the bytes changed since they were checked */
        }
        enf_replay_enter_chunk(cursor, &chunk);
    }
    return enf_replay_decode_tick(cursor) ? &cursor->now : NULL;
}
