/* A file that grows while its writer lives: written beside its place, unbuffered, and renamed when it is whole. */
#include "base/base_internal.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>

struct EnfStream {
    const EnfAllocator *allocator;
    int fd;        /* -1 once closed */
    bool in_place; /* no regular file: neither renamed nor removed */
    char path[ENF_PATH_SIZE], part[ENF_PATH_SIZE];
};

static int open_part(EnfStream *stream, const char *path) {
    int length = snprintf(stream->path, sizeof stream->path, "%s", path);
    int part_length = snprintf(stream->part, sizeof stream->part, "%s.part", path);
    if (length < 0 || part_length < 0 || part_length >= ENF_PATH_SIZE) {
        errno = ENAMETOOLONG;
        return -1;
    }
    struct stat status;
    stream->in_place = enf_file_calls()->stat(path, &status) == 0 && !S_ISREG(status.st_mode);
    if (stream->in_place) {
        return enf_file_calls()->open(path, O_WRONLY | O_CLOEXEC, 0);
    }
    return enf_file_calls()->open(stream->part, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
}

EnfResult enf_stream_create(EnfStream **stream, const char *path, const EnfAllocator *allocator, EnfError *error) {
    *stream = NULL;
    allocator = allocator ? allocator : enf_default_allocator();
    EnfStream *made = enf_alloc(allocator, 1, sizeof *made);
    if (!made) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory to write a file");
    }
    made->allocator = allocator;
    made->fd = open_part(made, path);
    if (made->fd < 0) {
        EnfResult result = enf_file_system_error(error, "cannot open for writing", path);
        enf_free(allocator, made, 1, sizeof *made);
        return result;
    }
    *stream = made;
    return ENF_OK;
}

EnfResult enf_stream_write(EnfStream *stream, const void *data, size_t size, EnfError *error) {
    ENF_ASSERT(stream->fd >= 0);
    EnfSpan span = {data, size};
    return enf_file_write_span(stream->fd, span) ? ENF_OK : enf_file_system_error(error, "cannot write", stream->path);
}

/* The close is checked: some file systems tell of a full disk only there. */
static bool close_part(EnfStream *stream, bool flush) {
    bool flushed = !flush || enf_file_calls()->fsync(stream->fd) == 0;
    int number = errno;
    bool closed = enf_file_calls()->close(stream->fd) == 0;
    errno = flushed ? errno : number;
    stream->fd = -1;
    return flushed && closed;
}

EnfResult enf_stream_finish(EnfStream *stream, EnfError *error) {
    ENF_ASSERT(stream->fd >= 0);
    if (!close_part(stream, !stream->in_place)) {
        return enf_file_system_error(error, "cannot write", stream->path);
    }
    if (stream->in_place) {
        return ENF_OK;
    }
    if (enf_file_calls()->rename(stream->part, stream->path) != 0) {
        return enf_file_system_error(error, "cannot rename what was written", stream->path);
    }
    stream->in_place = true; /* there is no part any more */
    bool flushed = enf_file_flush_folder(stream->path);
    return flushed ? ENF_OK : enf_file_system_error(error, "written, but cannot flush its folder", stream->path);
}

void enf_stream_destroy(EnfStream *stream, bool keep) {
    if (!stream) {
        return;
    }
    if (stream->fd >= 0) {
        close_part(stream, false);
    }
    if (!keep && !stream->in_place) {
        enf_file_calls()->unlink(stream->part);
    }
    enf_free(stream->allocator, stream, 1, sizeof *stream);
}
