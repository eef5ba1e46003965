/* durable.c: write, fsync, rename, fsync of the folder. */
#define _GNU_SOURCE  // F_OFD_SETLK, renameat2
#include "result/durable.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

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

/* Unlock a file. A fork of the process shares the descriptor, so closing the descriptor here would leave the lock to
 * the fork. */
static void unlock(int descriptor) {
#ifdef F_OFD_SETLK
    struct flock whole = {.l_type = F_UNLCK, .l_whence = SEEK_SET};
    fcntl(descriptor, F_OFD_SETLK, &whole);
#else
    flock(descriptor, LOCK_UN);
#endif
}

bool durable_has_name(int descriptor, const char *path) {
    struct stat open_file, named;
    return fstat(descriptor, &open_file) == 0 && lstat(path, &named) == 0 && open_file.st_ino == named.st_ino &&
           open_file.st_dev == named.st_dev;
}

/* The bytes of a file that are locked by the claim of a run, and by a part that is being made. */
enum { BYTE_OF_CLAIM = 0, BYTE_OF_PART = 1 };

/* Open a file and lock a byte of the inode that then still has the name; errno or 0. */
static int open_locked(const char *name, int flags, unsigned permissions, uint64_t byte, int *descriptor) {
    for (;;) {
        const int file = open(name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC | flags, permissions);
        if (file < 0) return errno;
        const int code = durable_lock(file, byte, 1);

        // meanwhile another process may have renamed or removed the file
        if (code != EAGAIN && durable_has_name(file, name)) {
            *descriptor = file;
            return 0;
        }
        close(file);
        if (code == EAGAIN) return EAGAIN;
    }
}

/* Open and lock a part, new or left by a process that died; errno or 0. */
static int open_part(const char *name, unsigned permissions, uint64_t byte, int *descriptor) {
    unsigned char head[16];
    struct stat facts;
    int code = open_locked(name, O_CREAT, permissions, byte, descriptor);
    if (code != 0) return code == ELOOP || code == EISDIR || code == ENXIO ? ENOTUNIQ : code;

    // never empty a file of another program, or a file with another name
    const bool is_file = fstat(*descriptor, &facts) == 0 && S_ISREG(facts.st_mode) && facts.st_nlink == 1;
    const ssize_t n = is_file ? pread(*descriptor, head, sizeof head, 0) : -1;
    if (n >= 0 && target_may_begin(head, (size_t)n)) return 0;
    close(*descriptor);
    *descriptor = -1;
    return ENOTUNIQ;
}

/* The name of the part of a file: false for a name too long for the system. */
static bool part_name_of(const char *target, char name[PATH_MAX]) {
    const int length = snprintf(name, PATH_MAX, "%s.part", target);
    if (length < PATH_MAX) return true;
    name[0] = '\0';
    return false;
}

// ---- a file in the making

/* The names of the unpublished parts of this process, which an end by a signal or for lack of memory has to remove. */
enum { MAX_PARTS = 8 };
static struct {
    _Atomic pid_t process; /* 0: free. A fork does not remove the parts of its parent */
    char name[PATH_MAX];
} parts[MAX_PARTS];

static void part_note(const char *name) {
    for (int i = 0; i < MAX_PARTS; i++) {
        pid_t none = 0;
        if (parts[i].process > 0 && parts[i].process != getpid()) parts[i].process = 0;
        if (!atomic_compare_exchange_strong(&parts[i].process, &none, -1)) continue;
        memcpy(parts[i].name, name, strlen(name) + 1);
        parts[i].process = getpid();
        return;
    }
}

static void part_forget(const char *name) {
    for (int i = 0; i < MAX_PARTS; i++) {
        if (parts[i].process == getpid() && strcmp(parts[i].name, name) == 0) parts[i].process = 0;
    }
}

void durable_remove_parts(void) {
    for (int i = 0; i < MAX_PARTS; i++) {
        if (parts[i].process == getpid()) unlink(parts[i].name);
    }
}

int durable_begin(struct durable_part *part, const char *target, unsigned permissions) {
    *part = (struct durable_part){.descriptor = -1};
    if (!part_name_of(target, part->name)) return ENAMETOOLONG;
    memcpy(part->target, target, strlen(target) + 1);

    // a signal between the creation and the note would leave the part behind
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    int code = open_part(part->name, permissions, BYTE_OF_PART, &part->descriptor);
    if (code == 0) part_note(part->name);
    pthread_sigmask(SIG_SETMASK, &before, NULL);

    if (code == 0) {
        code = ftruncate(part->descriptor, 0) == 0 ? 0 : errno;
    } else {
        part->name[0] = '\0';
    }
    return code;
}

int durable_publish(struct durable_part *part, bool overwrite) {
    int code = durable_sync(part->descriptor);
    if (code != 0) return code;
    bool is_renamed = false;

    if (!overwrite) {
#ifdef RENAME_NOREPLACE
        is_renamed = renameat2(AT_FDCWD, part->name, AT_FDCWD, part->target, RENAME_NOREPLACE) == 0;
        if (!is_renamed && errno != EINVAL && errno != ENOSYS) return errno;
#endif

        // a file system without this kind of renaming
        struct stat facts;
        if (!is_renamed && lstat(part->target, &facts) == 0) return EEXIST;
    }

    if (!is_renamed && rename(part->name, part->target) != 0) return errno;
    part_forget(part->name);
    part->name[0] = '\0';
    return durable_sync_folder(part->target);
}

void durable_end(struct durable_part *part) {
    if (part->name[0] != '\0') {
        unlink(part->name);
        part_forget(part->name);
    }
    if (part->descriptor >= 0) close(part->descriptor);
    part->name[0] = '\0';
    part->descriptor = -1;
}

void durable_discard(const char *target) {
    struct durable_part part;
    if (!part_name_of(target, part.name) || access(part.name, F_OK) != 0) return;
    durable_begin(&part, target, 0666);
    durable_end(&part);
}

// ---- the claim of a run

enum status durable_claim_take(struct durable_claim *claim, const char *path) {
    *claim = (struct durable_claim){.descriptor = {-1, -1}, .process = getpid()};
    int code = part_name_of(path, claim->part) ? 0 : ENAMETOOLONG;
    if (code == 0) code = open_part(claim->part, 0666, BYTE_OF_CLAIM, &claim->descriptor[0]);

    if (code == 0) {
        // a result that cannot be opened for writing has no writer
        part_note(claim->part);
        code = open_locked(path, 0, 0, BYTE_OF_CLAIM, &claim->descriptor[1]);
        if (code != EAGAIN) return STATUS_OK;
    }

    durable_claim_release(claim);
    if (code != EAGAIN) return target_failed(path, code, strerror(code));
    return status_fail(STATUS_FILE,
                       "%s: another run writes this result: wait until it has ended, or choose another name with -o",
                       path);
}

void durable_claim_release(struct durable_claim *claim) {
    if (claim->part[0] == '\0') return;

    // remove the name before unlocking
    const bool is_mine = claim->process == getpid();
    if (is_mine && durable_has_name(claim->descriptor[0], claim->part)) unlink(claim->part);
    part_forget(claim->part);

    for (int i = 0; i < 2; i++) {
        if (is_mine && claim->descriptor[i] >= 0) unlock(claim->descriptor[i]);
        if (claim->descriptor[i] >= 0) close(claim->descriptor[i]);
        claim->descriptor[i] = -1;
    }
    claim->part[0] = '\0';
}

// ---- replacing, and keeping the one before

enum status durable_replace(const char *path, const char *previous, const void *bytes, size_t n) {
    struct durable_part part;
    int code = durable_begin(&part, path, 0666);
    if (code == 0) code = durable_write(part.descriptor, bytes, n);
    if (code == 0) code = durable_sync(part.descriptor);
    if (code == 0 && previous && rename(part.target, previous) != 0 && errno != ENOENT) code = errno;
    if (code == 0) code = durable_publish(&part, true);
    durable_end(&part);
    return code == 0 ? STATUS_OK : target_failed(path, code, strerror(code));
}

// ---- reading

enum status durable_read(struct arena *arena, const char *path, unsigned char **bytes, size_t *n) {
    // request the memory before the file is open
    struct stat facts;
    if (stat(path, &facts) != 0) return status_fail(STATUS_FILE, "%s: cannot be read: %s", path, strerror(errno));
    if (!S_ISREG(facts.st_mode)) return status_fail(STATUS_FILE, "%s: is not an ordinary file", path);
    *n = (size_t)facts.st_size;
    NEW(arena, *bytes, *n);

    const int descriptor = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    int code = descriptor < 0 ? errno : 0;
    for (size_t done = 0; done < *n && code == 0;) {
        const ssize_t got = read(descriptor, *bytes + done, *n - done);
        if (got > 0) done += (size_t)got;
        if (got < 0 && errno != EINTR) code = errno;
        if (got == 0) code = EIO;  // the file was truncated meanwhile
    }

    if (descriptor >= 0) close(descriptor);
    return code == 0 ? STATUS_OK : status_fail(STATUS_FILE, "%s: cannot be read: %s", path, strerror(code));
}

// ---- a stream over a file in the making

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
    return target_failed(path, code, strerror(code));
}

enum status plain_file_close(struct plain_file *file, enum status status) {
    errno = 0;
    const bool is_broken = fflush(file->stream) != 0 || ferror(file->stream);
    int code = errno;

    // after a failure of an earlier write the reason is lost: another byte fails for the same reason
    if (is_broken && code == 0) code = durable_write(file->part.descriptor, "", 1);
    if (status == STATUS_OK && is_broken) status = target_failed(file->path, code, strerror(code));
    if (status == STATUS_OK) status = target_check(file->path, file->kind, file->overwrite);

    if (status == STATUS_OK) {
        code = durable_publish(&file->part, file->overwrite);
        if (code != 0) status = target_failed(file->path, code, strerror(code));
    }

    // the stream owns the descriptor
    const bool is_open = fclose(file->stream) != 0;
    file->part.descriptor = -1;
    if (is_open && status == STATUS_OK) status = target_failed(file->path, errno, strerror(errno));
    durable_end(&file->part);
    return status;
}
