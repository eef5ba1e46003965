/* durable.c: write, fsync, rename, fsync of the folder. */
#define _GNU_SOURCE  // F_OFD_SETLK
#include "result/durable.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "result/target.h"

int durable_sync(int descriptor) {
    int code;
    do {
        code = fsync(descriptor) == 0 ? 0 : errno;
    } while (code == EINTR);
    return code;
}

int durable_sync_folder(const char *path) {
    char folder[PATH_MAX];
    target_folder(path, folder);
    const int descriptor = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return 0;
    const int code = durable_sync(descriptor);
    close(descriptor);
    return code == EINVAL || code == ENOTSUP ? 0 : code;
}

int durable_write(int descriptor, const void *bytes, size_t n) {
    for (const char *from = bytes; n > 0;) {
        const ssize_t written = write(descriptor, from, n);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        if (written == 0) return ENOSPC;
        from += written;
        n -= (size_t)written;
    }

    return 0;
}

// ---- locks

int durable_lock(int descriptor, uint64_t first, uint64_t n) {
#ifdef F_OFD_SETLK
    struct flock range = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = (off_t)first, .l_len = (off_t)n};
    if (fcntl(descriptor, F_OFD_SETLK, &range) == 0) return 0;
    return errno == EACCES || errno == EAGAIN ? EAGAIN : ENOLCK;
#else

    // flock has no ranges
    if (first > 0 || n > 0) return ENOLCK;
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) return 0;
    return errno == EWOULDBLOCK ? EAGAIN : ENOLCK;
#endif
}

void durable_narrow(int descriptor, uint64_t first, uint64_t n) {
#ifdef F_OFD_SETLK
    const off_t begin = (off_t)first, end = begin + (off_t)n;
    struct flock before = {.l_type = F_UNLCK, .l_whence = SEEK_SET, .l_len = begin}, after = before;
    after.l_start = end;
    after.l_len = 0;
    if (begin > 0) fcntl(descriptor, F_OFD_SETLK, &before);
    if (n > 0) fcntl(descriptor, F_OFD_SETLK, &after);
#else

    // flock has no ranges
    if (first > 0 || n > 0) flock(descriptor, LOCK_UN);
#endif
}

bool durable_has_name(int descriptor, const char *path) {
    struct stat open_file, named;
    return fstat(descriptor, &open_file) == 0 && lstat(path, &named) == 0 && open_file.st_ino == named.st_ino &&
           open_file.st_dev == named.st_dev;
}

// ---- a file in the making

/* Create a part under a unique name, and lock the part before durable_sweep can remove it; errno or 0. */
static int create_part(struct durable_part *part, char *name, size_t size, unsigned permissions) {
    enum { TRIES = 100 };
    static atomic_ulong number;

    for (int i = 0; i < TRIES; i++) {
        snprintf(name, size, "%s.%ld-%lu.part", part->target, (long)getpid(), atomic_fetch_add(&number, 1));
        const int descriptor = open(name, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, permissions);
        if (descriptor < 0 && errno == EEXIST) continue;
        if (descriptor < 0) return errno;
        if (durable_lock(descriptor, 0, 0) != EAGAIN && durable_has_name(descriptor, name)) {
            part->name = name;
            part->descriptor = descriptor;
            return 0;
        }
        close(descriptor);
    }

    return EBUSY;
}

int durable_begin(struct durable_part *part, const char *target, unsigned permissions) {
    enum { ENDING = 64 };
    const size_t size = strlen(target) + ENDING;
    *part = (struct durable_part){.target = strdup(target), .descriptor = -1};
    char *const name = part->target ? malloc(size) : NULL;
    if (!name) return ENOMEM;
    const int code = create_part(part, name, size, permissions);
    if (code != 0) free(name);
    return code;
}

/* A link, unlike a renaming, refuses to replace a file that was made in the meantime; a file system without links has
 * to do with the renaming. Errno or 0. */
static int give_name(const struct durable_part *part, bool overwrite) {
    if (!overwrite) {
        if (link(part->name, part->target) == 0) return unlink(part->name) == 0 ? 0 : errno;
        if (errno == EEXIST) return EEXIST;
    }
    return rename(part->name, part->target) == 0 ? 0 : errno;
}

int durable_publish(struct durable_part *part, bool overwrite) {
    int code = durable_sync(part->descriptor);
    if (code == 0) code = give_name(part, overwrite);
    if (code != 0) return code;
    free(part->name);
    part->name = NULL;
    return durable_sync_folder(part->target);
}

void durable_end(struct durable_part *part) {
    if (part->name) unlink(part->name);
    if (part->descriptor >= 0) close(part->descriptor);
    free(part->name);
    free(part->target);
    *part = (struct durable_part){.descriptor = -1};
}

// ---- parts of processes that died

// True if the rest of a name, after `length` letters, is the ending of a part.
static bool is_part(const char *name, size_t length) {
    for (const char *at = name + length; (at = strchr(at, '.')); at++) {
        int end = 0;
        sscanf(at, ".%*[0-9]-%*[0-9].part%n", &end);
        if (end > 0 && at[end] == '\0') return true;
    }
    return false;
}

/* Remove a file of a folder if no process holds a lock and the file begins like a file of shoal. */
static void sweep_one(int folder, const char *name) {
    unsigned char head[16];
    struct stat facts, named;
    const int file = openat(folder, name, O_RDWR | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0) return;
    const bool is_file = fstat(file, &facts) == 0 && S_ISREG(facts.st_mode) && facts.st_nlink == 1;
    const ssize_t n = is_file ? pread(file, head, sizeof head, 0) : -1;
    if (n >= 0 && target_may_begin(head, (size_t)n) && durable_lock(file, 0, 0) == 0 &&
        fstatat(folder, name, &named, AT_SYMLINK_NOFOLLOW) == 0 && named.st_ino == facts.st_ino)
        unlinkat(folder, name, 0);
    close(file);
}

void durable_sweep(const char *path) {
    char folder[PATH_MAX];
    target_folder(path, folder);
    const char *const slash = strrchr(path, '/'), *const base = slash ? slash + 1 : path;
    DIR *const entries = opendir(folder);
    if (!entries) return;

    for (const struct dirent *entry; (entry = readdir(entries));) {
        const bool begins_so = strncmp(entry->d_name, base, strlen(base)) == 0;
        if (begins_so && is_part(entry->d_name, strlen(base))) sweep_one(dirfd(entries), entry->d_name);
    }

    closedir(entries);
}

// ---- replacing, and keeping the one before

static int replace(struct durable_part *part, const char *previous, const void *bytes, size_t n) {
    int code = durable_write(part->descriptor, bytes, n);
    if (code == 0) code = durable_sync(part->descriptor);
    if (code == 0 && previous && rename(part->target, previous) != 0 && errno != ENOENT) code = errno;
    return code == 0 ? durable_publish(part, true) : code;
}

enum status durable_replace(const char *path, const char *previous, const void *bytes, size_t n) {
    struct durable_part part;
    int code = durable_begin(&part, path, 0666);
    if (code == 0) code = replace(&part, previous, bytes, n);
    durable_end(&part);
    return code == 0 ? STATUS_OK : target_failed(path, code, strerror(code));
}

// ---- reading

// read all bytes; errno or 0
static int durable_read_all(int descriptor, unsigned char *bytes, size_t n) {
    while (n > 0) {
        const ssize_t got = read(descriptor, bytes, n);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return errno;
        if (got == 0) return EIO;  // the file was truncated meanwhile
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
    TRY(MEMORY_NEW(*bytes, *n, path));
    const int code = durable_read_all(descriptor, *bytes, *n);
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

// ---- a stream over a file in the making

static enum status durable_failed(const char *path, int code) {
    return target_failed(path, code, strerror(code));
}

enum status plain_file_open(struct plain_file *file, const char *path, enum target_kind kind, bool overwrite,
                            unsigned permissions) {
    *file = (struct plain_file){.path = path, .kind = kind, .overwrite = overwrite};
    TRY(target_check(path, kind, overwrite));
    int code = durable_begin(&file->part, path, permissions);

    if (code == 0) {
        file->stream = fdopen(file->part.descriptor, "w");
        if (file->stream) return STATUS_OK;
        code = errno;
    }

    durable_end(&file->part);
    return durable_failed(path, code);
}

enum status plain_file_close(struct plain_file *file, enum status status) {
    errno = 0;
    const bool is_broken = fflush(file->stream) != 0 || ferror(file->stream);
    if (status == STATUS_OK && is_broken) status = durable_failed(file->path, errno);
    if (status == STATUS_OK) status = target_check(file->path, file->kind, file->overwrite);

    if (status == STATUS_OK) {
        const int code = durable_publish(&file->part, file->overwrite);
        if (code != 0) status = durable_failed(file->path, code);
    }

    // the stream owns the descriptor
    const bool is_open = fclose(file->stream) != 0;
    file->part.descriptor = -1;
    if (is_open && status == STATUS_OK) status = durable_failed(file->path, errno);
    durable_end(&file->part);
    return status;
}
