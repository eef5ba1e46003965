/* durable.c: write, fsync, rename, fsync of the folder. */
#include "output/durable.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void durable_folder_of(const char *path, char folder[PATH_MAX]) {
    const char *const slash = strrchr(path, '/');
    const int length = slash == path ? 1 : slash ? (int)(slash - path) : 0;
    snprintf(folder, PATH_MAX, "%.*s", length > 0 ? length : 1, length > 0 ? path : ".");
}

int durable_sync(int descriptor) {
    int code;
    do {
        code = fsync(descriptor) == 0 ? 0 : errno;
    } while (code == EINTR);
    return code;
}

int durable_sync_folder(const char *path) {
    char folder[PATH_MAX];
    durable_folder_of(path, folder);
    const int descriptor = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return 0;
    const int code = durable_sync(descriptor);
    close(descriptor);
    return code == EINVAL || code == ENOTSUP ? 0 : code;
}

// ---- writing

// write all bytes; errno or 0
static int write_all(int descriptor, const unsigned char *bytes, size_t n) {
    while (n > 0) {
        const ssize_t written = write(descriptor, bytes, n);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        if (written == 0) return ENOSPC;
        bytes += written;
        n -= (size_t)written;
    }
    return 0;
}

// make a new file with these bytes; errno or 0
static int write_file(const char *path, const void *bytes, size_t n) {
    // what an earlier run may have left there; a link is removed, not followed
    if (unlink(path) != 0 && errno != ENOENT) return errno;
    const int descriptor = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0) return errno;
    int code = write_all(descriptor, bytes, n);
    if (code == 0) code = durable_sync(descriptor);
    if (close(descriptor) != 0 && code == 0) code = errno;
    return code;
}

// the new file gets the name, the old one that of the previous one; errno or 0
static int exchange(const char *path, const char *previous, const char *part) {
    if (rename(path, previous) != 0 && errno != ENOENT) return errno;
    if (rename(part, path) != 0) return errno;
    return durable_sync_folder(path);
}

enum status durable_replace(const char *path, const char *previous, const void *bytes, size_t n) {
    const size_t size = strlen(path) + sizeof ".part";
    char *const part = malloc(size);
    if (!part) return status_fail(STATUS_MEMORY, "out of memory: a file name");
    snprintf(part, size, "%s.part", path);
    int code = write_file(part, bytes, n);
    if (code == 0) code = exchange(path, previous, part);
    if (code != 0) unlink(part);
    free(part);
    if (code == 0) return STATUS_OK;
    return status_fail(STATUS_FILE, "%s: cannot be written (%s): make room or choose another place", path,
                       strerror(code));
}

// ---- reading

// read all bytes; errno or 0
static int read_all(int descriptor, unsigned char *bytes, size_t n) {
    while (n > 0) {
        const ssize_t got = read(descriptor, bytes, n);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return errno;
        if (got == 0) return EIO;  // it has become shorter
        bytes += got;
        n -= (size_t)got;
    }
    return 0;
}

static enum status read_open(int descriptor, const char *path, unsigned char **bytes, size_t *n) {
    struct stat facts;
    if (fstat(descriptor, &facts) != 0 || !S_ISREG(facts.st_mode)) {
        return status_fail(STATUS_FILE, "%s: is not an ordinary file", path);
    }
    *n = (size_t)facts.st_size;
    *bytes = malloc(*n > 0 ? *n : 1);
    if (!*bytes) return status_fail(STATUS_MEMORY, "%s: out of memory while reading", path);
    const int code = read_all(descriptor, *bytes, *n);
    if (code == 0) return STATUS_OK;
    free(*bytes);
    *bytes = NULL;
    return status_fail(STATUS_FILE, "%s: cannot be read: %s", path, strerror(code));
}

enum status durable_read(const char *path, unsigned char **bytes, size_t *n) {
    *bytes = NULL;
    *n = 0;
    const int descriptor = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return status_fail(STATUS_FILE, "%s: cannot be read: %s", path, strerror(errno));
    const enum status status = read_open(descriptor, path, bytes, n);
    close(descriptor);
    return status;
}
