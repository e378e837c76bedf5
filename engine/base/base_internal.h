/* What the room's files and its tests share: the system calls of file.c, in a table that a test can replace. */
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

#endif
