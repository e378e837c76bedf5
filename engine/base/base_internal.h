/* What the room's files and its tests share: the system calls on files, in a table that a test can replace. */
#ifndef ENFILADE_BASE_INTERNAL_H
#define ENFILADE_BASE_INTERNAL_H

#include <enfilade/base.h>

#include <sys/stat.h>
#include <sys/types.h>

/** Every call by which the engine touches a file system, so that each can be made to fail where it stands. */
typedef struct EnfFileCalls {
    int (*open)(const char *path, int flags, mode_t mode);
    int (*stat)(const char *path, struct stat *status);
    int (*fstat)(int fd, struct stat *status);
    ssize_t (*read)(int fd, void *data, size_t size);
    ssize_t (*write)(int fd, const void *data, size_t size);
    int (*fsync)(int fd);
    int (*close)(int fd);
    int (*rename)(const char *from, const char *to);
    int (*unlink)(const char *path);
} EnfFileCalls;

/** The calls in use; NULL restores the system's. For tests, before threads start. */
void enf_file_set_calls(const EnfFileCalls *calls);
const EnfFileCalls *enf_file_system_calls(void);
const EnfFileCalls *enf_file_calls(void);

/* What file.c and stream.c share. */
enum { ENF_PATH_SIZE = 4096 }; /* PATH_MAX of Linux */
/** ENF_ERROR_IO with `what` and what errno says. */
EnfResult enf_file_system_error(EnfError *error, const char *what, const char *path);
/** All of the span, whatever interrupts; false with errno set. */
bool enf_file_write_span(int fd, EnfSpan span);
/** Makes a rename to `path` durable. */
bool enf_file_flush_folder(const char *path);

#endif
