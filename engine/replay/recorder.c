/* Ticks into a file, a chunk at a time: what is written stays readable if the writer dies, and only a finished recording takes
 * its name. */
#include "replay/replay_internal.h"

#include <string.h>

struct EnfRecorder {
    EnfReplayHeader header;
    EnfStream *stream;
    const EnfAllocator *allocator;
    uint64_t ticks, written; /* given to the recorder; given to the system */
    bool finished;
    EnfError failure; /* the first */
    EnfReplayEncoder encoder;
    uint8_t chunk[ENF_REPLAY_CHUNK_MAX];
};

static EnfResult write_header(EnfRecorder *recorder, EnfError *error) {
    char text[ENF_REPLAY_HEADER_MAX];
    size_t length = enf_replay_write_header(text, &recorder->header);
    return enf_stream_write(recorder->stream, text, length, error);
}

EnfResult enf_recorder_create(EnfRecorder **recorder, const EnfReplayHeader *header, const char *path,
                              const EnfAllocator *allocator, EnfError *error) {
    *recorder = NULL;
    EnfResult result = enf_replay_check_header(header, error);
    if (result != ENF_OK) {
        return result;
    }
    allocator = allocator ? allocator : enf_default_allocator();
    EnfRecorder *made = enf_alloc(allocator, 1, sizeof *made);
    if (!made) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a recording");
    }
    made->allocator = allocator;
    made->header = *header;
    if (!header->engine[0]) {
        strncpy(made->header.engine, ENF_VERSION, sizeof made->header.engine - 1);
    }
    enf_replay_encode_begin(&made->encoder, header, 0);
    if ((result = enf_stream_create(&made->stream, path, allocator, error)) != ENF_OK ||
        (result = write_header(made, error)) != ENF_OK) {
        enf_recorder_destroy(made);
        return result;
    }
    *recorder = made;
    return ENF_OK;
}

static EnfResult repeat_failure(const EnfRecorder *recorder, EnfError *error) {
    if (error) {
        *error = recorder->failure;
    }
    return recorder->failure.code;
}

/* Writes the chunk at hand (the end of the recording, if it has no ticks) and begins the next. */
static EnfResult write_chunk(EnfRecorder *recorder, EnfError *error) {
    size_t size = enf_replay_encode_end(&recorder->encoder, recorder->chunk);
    if (enf_stream_write(recorder->stream, recorder->chunk, size, &recorder->failure) != ENF_OK) {
        return repeat_failure(recorder, error);
    }
    recorder->written = recorder->ticks;
    enf_replay_encode_begin(&recorder->encoder, &recorder->header, recorder->ticks);
    return ENF_OK;
}

EnfResult enf_recorder_tick(EnfRecorder *recorder, const EnfInput *input, uint64_t hash, const uint64_t *field_hashes,
                            EnfError *error) {
    ENF_ASSERT(!recorder->finished && (field_hashes || recorder->header.field_count == 0));
    if (recorder->failure.code != ENF_OK) {
        return repeat_failure(recorder, error);
    }
    enf_replay_encode_tick(&recorder->encoder, input, hash, field_hashes);
    recorder->ticks++;
    return recorder->encoder.ticks == ENF_REPLAY_CHUNK_TICKS ? write_chunk(recorder, error) : ENF_OK;
}

EnfResult enf_recorder_flush(EnfRecorder *recorder, EnfError *error) {
    if (recorder->failure.code != ENF_OK) {
        return repeat_failure(recorder, error);
    }
    return recorder->encoder.ticks > 0 ? write_chunk(recorder, error) : ENF_OK;
}

uint64_t enf_recorder_ticks(const EnfRecorder *recorder) {
    return recorder->ticks;
}

EnfResult enf_recorder_finish(EnfRecorder *recorder, EnfError *error) {
    ENF_ASSERT(!recorder->finished);
    EnfResult result = enf_recorder_flush(recorder, error);
    if (result != ENF_OK || (result = write_chunk(recorder, error)) != ENF_OK) {
        return result;
    }
    recorder->finished = true;
    if (enf_stream_finish(recorder->stream, &recorder->failure) != ENF_OK) {
        return repeat_failure(recorder, error);
    }
    return ENF_OK;
}

void enf_recorder_destroy(EnfRecorder *recorder) {
    if (recorder) {
        enf_stream_destroy(recorder->stream, recorder->written > 0);
        enf_free(recorder->allocator, recorder, 1, sizeof *recorder);
    }
}
