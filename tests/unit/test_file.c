/* Reading and writing whole files: each error, and the failure of every malloc and of every system call. */
#include "base/base_internal.h"
#include "harness/harness.h"
#include "harness/purse.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- system calls that fail ------------------------------------------------------------------------------------- */

static int calls_left;    /* before one fails; negative: none does */
static int failing_errno; /* what that one says */
static bool one_byte;     /* read and write move a byte at a time, with an interruption before each */
static bool interrupted;

static bool fails(void) {
    if (calls_left < 0 || calls_left-- > 0) {
        return false;
    }
    errno = failing_errno;
    return true;
}

static bool interrupts(void) {
    interrupted = one_byte && !interrupted;
    errno = interrupted ? EINTR : errno;
    return interrupted;
}

static int try_open(const char *path, int flags, mode_t mode) {
    return fails() ? -1 : enf_file_system_calls()->open(path, flags, mode);
}
static int try_fstat(int fd, struct stat *status) {
    return fails() ? -1 : enf_file_system_calls()->fstat(fd, status);
}
static ssize_t try_read(int fd, void *data, size_t size) {
    return fails() || interrupts() ? -1 : enf_file_system_calls()->read(fd, data, one_byte ? 1 : size);
}
static ssize_t try_write(int fd, const void *data, size_t size) {
    return fails() || interrupts() ? -1 : enf_file_system_calls()->write(fd, data, one_byte ? 1 : size);
}
static int try_fsync(int fd) {
    return fails() ? -1 : enf_file_system_calls()->fsync(fd);
}
static int try_close(int fd) {
    int result = enf_file_system_calls()->close(fd); /* the descriptor is gone even where close fails */
    return fails() ? -1 : result;
}
static int try_rename(const char *from, const char *to) {
    return fails() ? -1 : enf_file_system_calls()->rename(from, to);
}

static void use_failing_calls(int left, int number) {
    static EnfFileCalls failing;
    failing = *enf_file_system_calls();
    failing.open = try_open;
    failing.fstat = try_fstat;
    failing.read = try_read;
    failing.write = try_write;
    failing.fsync = try_fsync;
    failing.close = try_close;
    failing.rename = try_rename;
    calls_left = left;
    failing_errno = number;
    one_byte = interrupted = false;
    enf_file_set_calls(&failing);
}

/* ---- reading files ---------------------------------------------------------------------------------------------- */

static void expect_unread(const char *path, size_t max_size, EnfResult expected, const char *message) {
    EnfFile file;
    EnfError error;
    memset(&file, 1, sizeof file);
    assert_int_equal(enf_file_read(&file, path, max_size, NULL, &error), expected);
    assert_int_equal(error.code, expected);
    assert_string_equal(error.file, path);
    assert_non_null(strstr(error.message, message));
    assert_true(!file.data && file.size == 0 && !file.allocator);
    assert_int_equal(enf_file_read(&file, path, max_size, NULL, NULL), expected);
}

static void file_is_read_within_bounds(void **state) {
    (void)state;
    const char *path = enf_test_temp_path("eight");
    enf_test_write_file(path, "12345678", 8);
    EnfFile file;
    EnfError error;
    assert_int_equal(enf_file_read(&file, path, 8, NULL, &error), ENF_OK);
    assert_int_equal(file.size, 8);
    assert_memory_equal(file.data, "12345678", 8);
    enf_file_free(&file);
    assert_null(file.data);
    enf_file_free(&file);
    expect_unread(path, 7, ENF_ERROR_SIZE, "7 bytes");
    expect_unread(enf_test_temp_path("absent"), 7, ENF_ERROR_IO, "cannot open");
    expect_unread(enf_test_temp_folder(), 7, ENF_ERROR_IO, "directory");
    enf_test_write_file(path, "", 0);
    assert_int_equal(enf_file_read(&file, path, 0, NULL, &error), ENF_OK);
    assert_true(!file.data && file.size == 0);
    enf_file_free(&file);
}

/* A pipe says that its size is 0. */
static void pipe_is_read_to_its_end(void **state) {
    (void)state;
    enum { SIZE = 60000 };
    static uint8_t bytes[SIZE];
    memset(bytes, 3, SIZE);
    for (size_t max_size = SIZE - 1; max_size <= SIZE + 1; max_size++) {
        int ends[2];
        char path[64];
        assert_int_equal(pipe(ends), 0);
        assert_int_equal(write(ends[1], bytes, SIZE), SIZE);
        close(ends[1]);
        snprintf(path, sizeof path, "/dev/fd/%d", ends[0]);
        EnfFile file;
        EnfError error;
        EnfResult result = enf_file_read(&file, path, max_size, NULL, &error);
        close(ends[0]);
        assert_int_equal(result, max_size < SIZE ? ENF_ERROR_SIZE : ENF_OK);
        if (result == ENF_OK) {
            assert_int_equal(file.size, SIZE);
            assert_memory_equal(file.data, bytes, SIZE);
            enf_file_free(&file);
        }
    }
}

static void read_survives_every_failure(void **state) {
    (void)state;
    const char *path = enf_test_temp_path("read");
    enf_test_write_file(path, "12345678", 8);
    EnfFile file;
    EnfError error;
    int sites = 0;
    for (EnfResult result = ENF_ERROR_IO; result != ENF_OK; sites++) {
        use_failing_calls(sites, EIO);
        result = enf_file_read(&file, path, 100, NULL, &error);
        if (calls_left < 0 && result != ENF_OK) {
            assert_int_equal(result, ENF_ERROR_IO);
            assert_string_equal(error.file, path);
            assert_non_null(strstr(error.message, strerror(EIO)));
            assert_true(!file.data && file.size == 0);
        }
    }
    assert_in_range(sites, 5, 6); /* open, fstat, read, the probe for the end; a failing close loses nothing */
    enf_file_free(&file);
    use_failing_calls(-1, 0);
    one_byte = true;
    assert_int_equal(enf_file_read(&file, path, 100, NULL, &error), ENF_OK);
    enf_file_set_calls(NULL);
    assert_memory_equal(file.data, "12345678", 8);
    enf_file_free(&file);
}

static void read_survives_every_failing_malloc(void **state) {
    (void)state;
    const char *path = enf_test_temp_path("memory");
    enf_test_write_file(path, "12345678", 8);
    Purse purse = purse_with(0);
    EnfAllocator own = purse_allocator(&purse);
    EnfFile file;
    EnfError error;
    assert_int_equal(enf_file_read(&file, path, 100, &own, &error), ENF_ERROR_MEMORY);
    assert_string_equal(error.file, path);
    purse.budget = 1;
    assert_int_equal(enf_file_read(&file, path, 100, &own, &error), ENF_OK);
    enf_file_free(&file);
    purse_assert_whole(&purse);
    for (uint32_t budget = 0;; budget++) { /* a pipe grows its block, then trims it */
        int ends[2];
        char pipe_path[64];
        assert_int_equal(pipe(ends), 0);
        assert_int_equal(write(ends[1], "abc", 3), 3);
        close(ends[1]);
        snprintf(pipe_path, sizeof pipe_path, "/dev/fd/%d", ends[0]);
        purse.budget = budget;
        EnfResult result = enf_file_read(&file, pipe_path, 100, &own, &error);
        close(ends[0]);
        if (result == ENF_OK) {
            assert_int_equal(budget, 2);
            break;
        }
        assert_int_equal(result, ENF_ERROR_MEMORY);
        purse_assert_whole(&purse);
    }
    enf_file_free(&file);
    purse_assert_whole(&purse);
}

/* ---- writing files ---------------------------------------------------------------------------------------------- */

static unsigned entries_of(const char *folder) {
    DIR *listing = opendir(folder);
    assert_non_null(listing);
    unsigned count = 0;
    while (readdir(listing)) {
        count++;
    }
    closedir(listing);
    return count;
}

static void expect_content(const char *path, const char *content) {
    size_t size;
    uint8_t *data = enf_test_read_file(path, &size);
    assert_int_equal(size, strlen(content));
    assert_memory_equal(data, content, size);
    free(data);
}

static const EnfSpan new_content[] = {{"new ", 4}, {NULL, 0}, {"content", 7}};

static void write_replaces_the_whole_file(void **state) {
    (void)state;
    const char *path = enf_test_temp_path("written");
    EnfError error;
    unsigned before = entries_of(enf_test_temp_folder());
    assert_int_equal(enf_file_write(path, new_content, 3, &error), ENF_OK);
    expect_content(path, "new content");
    assert_int_equal(enf_file_write(path, new_content, 1, &error), ENF_OK);
    expect_content(path, "new ");
    assert_int_equal(enf_file_write(path, NULL, 0, &error), ENF_OK);
    expect_content(path, "");
    assert_int_equal(entries_of(enf_test_temp_folder()), before + 1);
    struct stat status;
    mode_t mask = umask(027);
    assert_int_equal(enf_file_write(enf_test_temp_path("mask"), new_content, 3, &error), ENF_OK);
    umask(mask);
    assert_int_equal(stat(enf_test_temp_path("mask"), &status), 0);
    assert_int_equal(status.st_mode & 0777, 0640);
}

static void write_names_what_failed(void **state) {
    (void)state;
    EnfError error;
    const char *path = enf_test_temp_path("no_folder/file");
    assert_int_equal(enf_file_write(path, new_content, 3, &error), ENF_ERROR_IO);
    assert_string_equal(error.file, path);
    assert_int_equal(enf_file_write(enf_test_temp_folder(), new_content, 3, &error), ENF_ERROR_IO);
    char long_path[6000];
    memset(long_path, '/', sizeof long_path - 1);
    long_path[sizeof long_path - 2] = 'x';
    long_path[sizeof long_path - 1] = '\0';
    assert_int_equal(enf_file_write(long_path, new_content, 3, &error), ENF_ERROR_IO);
    assert_int_equal(enf_file_write(long_path, new_content, 3, NULL), ENF_ERROR_IO);
}

/* A rename over /dev/null would replace the device by a file. */
static void write_leaves_devices_alone(void **state) {
    (void)state;
    EnfError error;
    struct stat status;
    assert_int_equal(enf_file_write("/dev/null", new_content, 3, &error), ENF_OK);
    assert_int_equal(stat("/dev/null", &status), 0);
    assert_true(S_ISCHR(status.st_mode));
}

/* The old file or the whole new one, and no temporary, whichever call fails. */
static void write_survives_every_failure(void **state) {
    (void)state;
    const char *path = enf_test_temp_path("atomic");
    EnfError error;
    int sites = 0, replaced = 0;
    EnfResult result = ENF_ERROR_IO;
    for (; result != ENF_OK; sites++) {
        enf_test_write_file(path, "old", 3);
        unsigned before = entries_of(enf_test_temp_folder());
        use_failing_calls(sites, ENOSPC);
        result = enf_file_write(path, new_content, 3, &error);
        enf_file_set_calls(NULL);
        assert_int_equal(entries_of(enf_test_temp_folder()), before);
        if (result != ENF_OK) {
            assert_int_equal(result, ENF_ERROR_IO);
            assert_string_equal(error.file, path);
            assert_non_null(strstr(error.message, strerror(ENOSPC)));
        }
        bool whole = result == ENF_OK || strstr(error.message, "written, but");
        replaced += result != ENF_OK && whole;
        expect_content(path, whole ? "new content" : "old");
    }
    assert_int_equal(replaced, 2); /* opening and flushing the folder come after the rename */
    /* open, two writes, fsync, close, rename, the folder's open and fsync; its close loses nothing */
    assert_int_equal(sites, 9);
    use_failing_calls(-1, 0);
    one_byte = true;
    assert_int_equal(enf_file_write(path, new_content, 3, &error), ENF_OK);
    enf_file_set_calls(NULL);
    expect_content(path, "new content");
    use_failing_calls(7, EINVAL); /* what flushing a folder says where that cannot be done */
    assert_int_equal(enf_file_write(path, new_content, 3, &error), ENF_OK);
    enf_file_set_calls(NULL);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(file_is_read_within_bounds),    cmocka_unit_test(pipe_is_read_to_its_end),
    cmocka_unit_test(read_survives_every_failure),   cmocka_unit_test(read_survives_every_failing_malloc),
    cmocka_unit_test(write_replaces_the_whole_file), cmocka_unit_test(write_names_what_failed),
    cmocka_unit_test(write_leaves_devices_alone),    cmocka_unit_test(write_survives_every_failure),
};

ENF_TEST_MAIN(tests)
