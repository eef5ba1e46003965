/* result_lock.c: a lock of fcntl, on a file that says who has it. */
#include "output/result_lock.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "output/netcdf.h"

enum { OWNER_BYTES = 256 };

static enum status refuse(const char *result, int descriptor) {
    char owner[OWNER_BYTES] = "";
    const ssize_t n = pread(descriptor, owner, sizeof owner - 1, 0);
    owner[n > 0 ? n : 0] = '\0';
    owner[strcspn(owner, "\n")] = '\0';
    return status_fail(STATUS_FILE, "%s: another run writes it (%s): wait for its end, or choose another name with -o",
                       result, *owner ? owner : "an unknown process");
}

// say who has the lock; it holds without that too
static void write_owner(int descriptor) {
    char host[128] = "an unknown host", owner[OWNER_BYTES];
    gethostname(host, sizeof host - 1);
    const int n = snprintf(owner, sizeof owner, "process %ld on %s\n", (long)getpid(), host);
    if (ftruncate(descriptor, 0) != 0 || pwrite(descriptor, owner, (size_t)n, 0) != n) return;
}

// whether the file of a descriptor still has this name: the run that had the lock may just have removed it
static int has_name(int descriptor, const char *path) {
    struct stat open_file, named;
    return fstat(descriptor, &open_file) == 0 && stat(path, &named) == 0 && open_file.st_ino == named.st_ino &&
           open_file.st_dev == named.st_dev;
}

// open and lock the file once; *is_gone: it has lost its name meanwhile
static enum status try_lock(struct result_lock *lock, const char *result, int *is_gone) {
    struct stat facts;
    *is_gone = 0;
    lock->descriptor = open(lock->path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    if (lock->descriptor < 0 && errno == ENOENT)  // the folder is there: that has been checked
        return status_fail(STATUS_FILE, "%s: the folder takes no new files: choose another place with -o", result);
    if (lock->descriptor < 0 || fstat(lock->descriptor, &facts) != 0 || !S_ISREG(facts.st_mode)) {
        return status_fail(STATUS_FILE, "%s: cannot be made (%s): choose another name with -o", lock->path,
                           lock->descriptor < 0 ? strerror(errno) : "it is not an ordinary file");
    }
    struct flock all = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    if (fcntl(lock->descriptor, F_SETLK, &all) != 0) {
        return errno == EACCES || errno == EAGAIN ? refuse(result, lock->descriptor) : STATUS_OK;
    }
    *is_gone = !has_name(lock->descriptor, lock->path);
    if (!*is_gone) write_owner(lock->descriptor);
    return STATUS_OK;
}

// close the file and forget its name
static void forget(struct result_lock *lock) {
    if (lock->descriptor >= 0) close(lock->descriptor);
    free(lock->path);
    *lock = (struct result_lock){.descriptor = -1};
}

enum status result_lock_take(struct result_lock *lock, const char *result) {
    const size_t size = strlen(result) + sizeof ".lock";
    *lock = (struct result_lock){.path = malloc(size), .descriptor = -1};
    if (!lock->path) return status_fail(STATUS_MEMORY, "out of memory: a file name");
    snprintf(lock->path, size, "%s.lock", result);
    for (;;) {
        int is_gone;
        const enum status status = try_lock(lock, result, &is_gone);
        if (status != STATUS_OK) forget(lock);
        if (status != STATUS_OK || !is_gone) return status;
        close(lock->descriptor);
    }
}

void result_lock_release(struct result_lock *lock) {
    // while it is locked: who waits for the name then finds that it is gone
    if (lock->path) unlink(lock->path);
    forget(lock);
}

enum status result_lock_hold(const char *result, enum status (*work)(void *data), void *data) {
    struct result_lock lock;
    TRY(netcdf_check_target(result, 1));
    TRY(result_lock_take(&lock, result));
    const enum status status = work(data);
    result_lock_release(&lock);
    return status;
}
