/* Files: a whole file in memory, bounded; and a file replaced as a whole or not at all (written beside its place,
 * flushed, renamed, the folder flushed). Every failure names the file and says what the system said. */
#include "base/base_internal.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum {
    TEMP_TRIES = 1000,          /* names tried for the temporary */
    FIRST_STEP = 1 << 16,       /* first block for a file that does not know its size (a pipe) */
    LARGEST_TRANSFER = 1 << 30, /* one read or write; the system takes at most 2^31 - 4096 */
};

/* open is variadic; the table needs one shape. */
static int open_file(const char *path, int flags, mode_t mode) {
    return open(path, flags, mode);
}

static const EnfFileCalls system_calls = {open_file, stat, fstat, read, write, fsync, close, rename, unlink};
static const EnfFileCalls *calls = &system_calls;

void enf_file_set_calls(const EnfFileCalls *replacement) {
    calls = replacement ? replacement : &system_calls;
}

const EnfFileCalls *enf_file_system_calls(void) {
    return &system_calls;
}

const EnfFileCalls *enf_file_calls(void) {
    return calls;
}

EnfResult enf_file_system_error(EnfError *error, const char *what, const char *path) {
    int number = errno;
    EnfResult code = enf_error_set(error, ENF_ERROR_IO, UINT64_MAX, "%s: %s", what, strerror(number));
    return enf_error_file(error, code, path);
}

static size_t smaller(size_t a, size_t b) {
    return a < b ? a : b;
}

/* ---- reading ---------------------------------------------------------------------------------------------------- */

/* Reads until `size` bytes are there or the file ends; false on an error. */
static bool read_up_to(int fd, uint8_t *data, size_t size, size_t *done) {
    *done = 0;
    while (*done < size) {
        ssize_t got = calls->read(fd, data + *done, smaller(size - *done, LARGEST_TRANSFER));
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            return got == 0;
        }
        *done += (size_t)got;
    }
    return true;
}

static EnfResult too_large(EnfError *error, size_t max_size) {
    return enf_error_set(error, ENF_ERROR_SIZE, UINT64_MAX, "the file is larger than the %zu bytes allowed", max_size);
}

static EnfResult resize(EnfFile *file, size_t *capacity, size_t wanted, EnfError *error) {
    if (wanted == *capacity) {
        return ENF_OK;
    }
    if (wanted == 0) {
        enf_free(file->allocator, file->data, *capacity, 1);
        file->data = NULL;
    } else {
        uint8_t *data = enf_realloc(file->allocator, file->data, *capacity, wanted, 1);
        if (!data) {
            return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a file of %zu bytes", wanted);
        }
        file->data = data;
    }
    *capacity = wanted;
    return ENF_OK;
}

/* Reads to the end of `fd`, whatever its size was said to be; a file may grow or shrink, and a pipe has none. */
static EnfResult read_to_end(EnfFile *file, int fd, size_t *capacity, size_t max_size, EnfError *error) {
    for (;;) {
        size_t got;
        uint8_t *end = file->data ? file->data + file->size : NULL; /* NULL + 0 is undefined too */
        if (!read_up_to(fd, end, *capacity - file->size, &got)) {
            return enf_file_system_error(error, "cannot read", "");
        }
        file->size += got;
        if (file->size < *capacity) {
            return ENF_OK;
        }
        uint8_t next;
        if (!read_up_to(fd, &next, 1, &got)) {
            return enf_file_system_error(error, "cannot read", "");
        }
        if (got == 0) {
            return ENF_OK;
        }
        if (file->size >= max_size) {
            return too_large(error, max_size);
        }
        size_t wanted = *capacity < FIRST_STEP ? FIRST_STEP : *capacity + *capacity / 2;
        EnfResult result = resize(file, capacity, smaller(wanted, max_size), error);
        if (result != ENF_OK) {
            return result;
        }
        file->data[file->size++] = next;
    }
}

static EnfResult read_opened(EnfFile *file, int fd, size_t max_size, EnfError *error) {
    struct stat status;
    if (calls->fstat(fd, &status) != 0) {
        return enf_file_system_error(error, "cannot read", "");
    }
    if (S_ISDIR(status.st_mode)) {
        return enf_error_set(error, ENF_ERROR_IO, UINT64_MAX, "cannot read: it is a directory");
    }
    uint64_t expected = status.st_size > 0 ? (uint64_t)status.st_size : 0;
    if (expected > max_size) {
        return too_large(error, max_size);
    }
    size_t capacity = 0;
    EnfResult result = resize(file, &capacity, (size_t)expected, error);
    if (result == ENF_OK) {
        result = read_to_end(file, fd, &capacity, max_size, error);
    }
    if (result == ENF_OK) {
        /* The block has the file's size exactly: an over-read shows under a sanitizer. */
        result = resize(file, &capacity, file->size, error);
    }
    if (result != ENF_OK) {
        enf_free(file->allocator, file->data, capacity, 1);
    }
    return result;
}

EnfResult enf_file_read(EnfFile *file, const char *path, size_t max_size, const EnfAllocator *allocator, EnfError *error) {
    *file = (EnfFile){NULL, 0, allocator ? allocator : enf_default_allocator()};
    int fd = calls->open(path, O_RDONLY | O_CLOEXEC, 0);
    if (fd < 0) {
        *file = (EnfFile){NULL, 0, NULL};
        return enf_file_system_error(error, "cannot open", path);
    }
    EnfResult result = read_opened(file, fd, max_size, error);
    calls->close(fd);
    if (result != ENF_OK) {
        *file = (EnfFile){NULL, 0, NULL};
        return enf_error_file(error, result, path);
    }
    return ENF_OK;
}

void enf_file_free(EnfFile *file) {
    enf_free(file->allocator, file->data, file->size, 1);
    *file = (EnfFile){NULL, 0, NULL};
}

/* ---- writing ---------------------------------------------------------------------------------------------------- */

bool enf_file_write_span(int fd, EnfSpan span) {
    const uint8_t *data = span.data;
    size_t done = 0;
    while (done < span.size) {
        ssize_t put = calls->write(fd, data + done, smaller(span.size - done, LARGEST_TRANSFER));
        if (put < 0 && errno == EINTR) {
            continue;
        }
        if (put <= 0) {
            errno = put == 0 ? ENOSPC : errno;
            return false;
        }
        done += (size_t)put;
    }
    return true;
}

static bool write_spans(int fd, const EnfSpan *spans, size_t span_count) {
    for (size_t i = 0; i < span_count; i++) {
        if (!enf_file_write_span(fd, spans[i])) {
            return false;
        }
    }
    return true;
}

/* Writes and closes. The close is checked: some file systems tell of a full disk only there. */
static bool write_and_close(int fd, const EnfSpan *spans, size_t span_count, bool flush) {
    bool written = write_spans(fd, spans, span_count) && (!flush || calls->fsync(fd) == 0);
    int number = errno;
    bool closed = calls->close(fd) == 0;
    errno = written ? errno : number;
    return written && closed;
}

/* A terminal, a pipe or /dev/null cannot be replaced by a rename (and must not be): it is written in place. */
static EnfResult write_in_place(const char *path, const EnfSpan *spans, size_t span_count, EnfError *error) {
    int fd = calls->open(path, O_WRONLY | O_CLOEXEC, 0);
    if (fd < 0) {
        return enf_file_system_error(error, "cannot open for writing", path);
    }
    return write_and_close(fd, spans, span_count, false) ? ENF_OK : enf_file_system_error(error, "cannot write", path);
}

/* The folder part of `path` with its slash, "" for none. */
static bool folder_of(char *folder, const char *path) {
    const char *slash = strrchr(path, '/');
    size_t length = slash ? (size_t)(slash - path) + 1 : 0;
    if (length >= ENF_PATH_SIZE) {
        errno = ENAMETOOLONG;
        return false;
    }
    memcpy(folder, path, length);
    folder[length] = '\0';
    return true;
}

/* Makes a new file beside the target. The mode is open's usual one, so the result has the permissions of any file that
 * the user makes (mkstemp's would be private). */
static int open_temporary(char *temporary, const char *folder) {
    for (unsigned i = 0; i < TEMP_TRIES; i++) {
        int length = snprintf(temporary, ENF_PATH_SIZE, "%s.enf-%ld-%u.tmp", folder, (long)getpid(), i);
        if (length < 0 || length >= ENF_PATH_SIZE) {
            errno = ENAMETOOLONG;
            return -1;
        }
        int fd = calls->open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0 || errno != EEXIST) {
            return fd;
        }
    }
    return -1;
}

/* Makes the rename itself durable. Some file systems cannot flush a folder and say EINVAL: nothing more can be done. */
bool enf_file_flush_folder(const char *path) {
    char folder[ENF_PATH_SIZE];
    if (!folder_of(folder, path)) {
        return false;
    }
    int fd = calls->open(folder[0] ? folder : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC, 0);
    if (fd < 0) {
        return false;
    }
    bool flushed = calls->fsync(fd) == 0 || errno == EINVAL;
    int number = errno;
    calls->close(fd);
    errno = number;
    return flushed;
}

EnfResult enf_file_write(const char *path, const EnfSpan *spans, size_t span_count, EnfError *error) {
    struct stat status;
    if (calls->stat(path, &status) == 0 && !S_ISREG(status.st_mode)) {
        return write_in_place(path, spans, span_count, error);
    }
    char folder[ENF_PATH_SIZE], temporary[ENF_PATH_SIZE];
    int fd = folder_of(folder, path) ? open_temporary(temporary, folder) : -1;
    if (fd < 0) {
        return enf_file_system_error(error, "cannot make a temporary file beside it", path);
    }
    const char *failed = NULL;
    if (!write_and_close(fd, spans, span_count, true)) {
        failed = "cannot write";
    } else if (calls->rename(temporary, path) != 0) {
        failed = "cannot rename the temporary file";
    }
    if (failed) {
        EnfResult result = enf_file_system_error(error, failed, path);
        calls->unlink(temporary);
        return result;
    }
    return enf_file_flush_folder(path) ? ENF_OK : enf_file_system_error(error, "written, but cannot flush its folder", path);
}
