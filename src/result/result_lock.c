/* result_lock.c: locks on a file that names the owner. */
#include "result/result_lock.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "result/durable.h"
#include "result/target.h"

enum { OWNER_BYTES = 256, OWNER_WIDTH = 160 /* letters of every owner, so that one replaces another in place */ };

/* A range of bytes to lock, and the message for a range held by another process. */
struct claim {
    const char *path, *message; /* of the result or study; a format with the path and the owner */
    uint64_t first, n;
};

// ---- the owner of the lock

// Read the bytes of the file, with a zero at the end; returns the number of bytes.
static size_t read_owner(int descriptor, char owner[OWNER_BYTES]) {
    const ssize_t n = pread(descriptor, owner, OWNER_BYTES - 1, 0);
    owner[n > 0 ? n : 0] = '\0';
    return n > 0 ? (size_t)n : 0;
}

/* True for bytes of write_owner, or for the remains after a power cut: a part, or zeros. */
static bool is_owner(const char *owner, size_t n) {
    static const char form[] = TARGET_LOCK_MARK "# on ";
    size_t n_zeros = 0, at = 0;
    while (n_zeros < n && owner[n_zeros] == '\0') n_zeros++;
    if (n_zeros == n || n == OWNER_BYTES - 1) return n_zeros == n;

    for (const char *letter = form; *letter && at < n; letter++) {
        const size_t n_same = *letter == '#' ? strspn(owner + at, "0123456789") : owner[at] == *letter;
        if (n_same == 0) return false;
        at += n_same;
    }

    const char *const end = memchr(owner, '\n', n);
    return !end || end == owner + n - 1;
}

// write the owner over the previous one, never emptying the file; the lock is valid even if writing fails
static void write_owner(int descriptor) {
    char host[128] = "an unknown host", owner[OWNER_WIDTH], line[OWNER_BYTES];
    gethostname(host, sizeof host - 1);
    snprintf(owner, sizeof owner, TARGET_LOCK_MARK "%ld on %s", (long)getpid(), host);
    const int n = snprintf(line, sizeof line, "%-*s\n", OWNER_WIDTH, owner);
    if (pwrite(descriptor, line, (size_t)n, 0) != n) return;
}

static enum status refuse_lock(const struct claim *claim, int descriptor) {
    char owner[OWNER_BYTES];
    read_owner(descriptor, owner);
    size_t n = strcspn(owner, "\n");
    while (n > 0 && owner[n - 1] == ' ') n--;
    owner[n] = '\0';
    return status_fail(STATUS_FILE, "%s: %s (%s): wait until it has ended, or choose another name with -o", claim->path,
                       claim->message, *owner ? owner : "an unknown process");
}

// ---- the file

/* Create the file under a part's name, lock the part, write the owner, and link the part to the lock's name: no process
 * ever opens a lock file that is new, unlocked or empty. Errno or 0. */
static int create_locked(struct result_lock *lock, const struct claim *claim) {
    struct durable_part part;
    int code = durable_begin(&part, lock->path, 0666);

    if (code == 0) {
        durable_narrow(part.descriptor, claim->first, claim->n);
        write_owner(part.descriptor);
        code = link(part.name, lock->path) == 0 ? 0 : errno;
    }

    if (code == 0) {
        lock->is_my_own = true;
        lock->descriptor = part.descriptor;
        part.descriptor = -1;
    }

    durable_end(&part);
    return code;
}

// Fail unless the open file is a lock of shoal, complete or truncated by a power cut.
static enum status check_file(struct result_lock *lock) {
    struct stat facts;
    char owner[OWNER_BYTES];
    if (fstat(lock->descriptor, &facts) != 0 || !S_ISREG(facts.st_mode)) {
        return status_fail(STATUS_FILE, "%s: cannot be made (it is not an ordinary file): choose another name with -o",
                           lock->path);
    }

    if (!is_owner(owner, read_owner(lock->descriptor, owner))) {
        return status_fail(STATUS_FILE, "%s exists and is no lock of shoal: remove it, or choose another name with -o",
                           lock->path);
    }

    // an empty file may be anybody's
    if (facts.st_size > 0) lock->is_my_own = true;
    return STATUS_OK;
}

/* Open or create the file, and lock the file once; *is_gone: try again, because another owner has removed or created
 * the file meanwhile. */
static enum status try_claim(struct result_lock *lock, const struct claim *claim, bool *is_gone) {
    const int flags = O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
    *is_gone = false;
    lock->is_my_own = false;
    lock->descriptor = open(lock->path, flags);

    if (lock->descriptor < 0 && errno == ENOENT) {
        const int code = create_locked(lock, claim);
        *is_gone = code == EEXIST;
        if (code == 0 || code == EEXIST) return STATUS_OK;

        // a file system without hard links: a rival can open the file while it is still empty
        lock->is_my_own = true;
        lock->descriptor = open(lock->path, flags | O_CREAT | O_EXCL, 0666);
        *is_gone = lock->descriptor < 0 && errno == EEXIST;
        if (*is_gone) return STATUS_OK;
    }

    if (lock->descriptor < 0 && errno == ENOENT)  // the folder is there: that has been checked
        return status_fail(STATUS_FILE, "%s: the folder takes no new files: choose another place with -o", claim->path);
    if (lock->descriptor < 0) {
        return status_fail(STATUS_FILE, "%s: cannot be made (%s): choose another name with -o", lock->path,
                           strerror(errno));
    }

    TRY(check_file(lock));
    if (durable_lock(lock->descriptor, claim->first, claim->n) == EAGAIN) return refuse_lock(claim, lock->descriptor);
    *is_gone = !durable_has_name(lock->descriptor, lock->path);
    if (!*is_gone) write_owner(lock->descriptor);
    return STATUS_OK;
}

// Close the file and clear the name.
static void forget(struct result_lock *lock) {
    if (lock->descriptor >= 0) close(lock->descriptor);
    free(lock->path);
    *lock = (struct result_lock){.descriptor = -1};
}

static enum status take_lock(struct result_lock *lock, const struct claim *claim, const char *ending) {
    const size_t size = strlen(claim->path) + strlen(ending) + 1;
    *lock = (struct result_lock){.descriptor = -1, .owner = getpid()};
    TRY(MEMORY_NEW(lock->path, size, "a file name"));
    snprintf(lock->path, size, "%s%s", claim->path, ending);

    for (;;) {
        bool is_gone;
        const enum status status = try_claim(lock, claim, &is_gone);
        if (status != STATUS_OK) forget(lock);
        if (status != STATUS_OK || !is_gone) return status;
        if (lock->descriptor >= 0) close(lock->descriptor);
    }
}

// ---- locks

enum status result_lock_take(struct result_lock *lock, const char *result) {
    const struct claim claim = {.path = result, .message = "another run writes this result"};
    return take_lock(lock, &claim, ".lock");
}

enum status result_lock_members(struct result_lock *lock, const char *folder, int first, int n) {
    const struct claim claim = {.path = folder,
                                .message = "another study runs some of the same members",
                                .first = (uint64_t)first,
                                .n = (uint64_t)n};
    return take_lock(lock, &claim, "/study.lock");
}

void result_lock_release(struct result_lock *lock) {
    // remove the name before unlocking, so that a waiting process finds the name gone
    if (lock->path && lock->owner == getpid() && durable_lock(lock->descriptor, 0, 0) != EAGAIN) {
        const int code = lock->is_my_own ? unlink(lock->path) : ftruncate(lock->descriptor, 0);
        (void)code;  // a lock without an owner locks nothing

        // remove the parts of runs that died while they made this lock; one may be linked to the file closed here
        close(lock->descriptor);
        lock->descriptor = -1;
        durable_sweep(lock->path);
    }
    forget(lock);
}

enum status result_lock_hold(const char *result, enum status (*work)(void *data), void *data) {
    struct result_lock lock;
    TRY(target_check(result, TARGET_NETCDF, true));
    TRY(result_lock_take(&lock, result));
    const enum status status = work(data);
    result_lock_release(&lock);
    return status;
}
