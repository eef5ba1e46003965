/* result_lock.h: no two runs write the same result, and no two studies run the same members. A run locks the file
 * RESULT.lock, a study a part of FOLDER/study.lock; the kernel frees the lock at the end of the run, even after a
 * crash. Two runs of one process exclude each other too. Of runs that race for one result, one gets the lock; an empty
 * lock file can stay behind only on a file system without hard links. Tested by tests/result/test_result_lock.c. */
#ifndef RESULT_LOCK_H
#define RESULT_LOCK_H

#include <stdbool.h>
#include <sys/types.h>

#include "base/status.h"

/* Initialise to zero with descriptor -1. */
struct result_lock {
    char *path; /* owned; NULL: there is no lock */
    int descriptor;
    pid_t owner;    /* the process that took the lock: a fork does not release the lock */
    bool is_my_own; /* remove the file at the end: created for this lock, or left by a dead run */
};

/* Lock the result at this path. Fails at once with STATUS_FILE if another run holds the lock; the message names process
 * and host. On a file system without locks the function succeeds without a lock. */
enum status result_lock_take(struct result_lock *lock, const char *result);

/* Lock n members of the study in a folder from first on, or with n = 0 all of them. Fails at once with STATUS_FILE if
 * another study runs one of these members. */
enum status result_lock_members(struct result_lock *lock, const char *folder, int first, int n);

/* Release the lock, and remove the file unless other processes hold locks too. In a fork of the owner: only clear
 * *lock. */
void result_lock_release(struct result_lock *lock);

/* Do the work under the lock of the result at this path, new or existing (target_check). Fails with STATUS_FILE before
 * the work if the path is not writable or another run holds the lock; then as the work. */
enum status result_lock_hold(const char *result, enum status (*work)(void *data), void *data);

#endif
