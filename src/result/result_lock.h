/* result_lock.h: no two runs write the same result, and no two studies run the same members. A run locks the file
 * RESULT.lock, a study a part of FOLDER/study.lock; the kernel frees the lock when the run ends, however it ends. Two
 * runs of one process exclude each other too. Tested by tests/result/test_result_lock.c. */
#ifndef RESULT_LOCK_H
#define RESULT_LOCK_H

#include <stdbool.h>
#include <sys/types.h>

#include "base/status.h"

/* Zero it, with descriptor -1, to begin. */
struct result_lock {
    char *path; /* owned; NULL: there is no lock */
    int descriptor;
    pid_t owner;    /* the process that took the lock: a fork of it does not release it */
    bool is_my_own; /* the file is to be removed: it was created for this lock, or left by a run that died */
};

/* Lock the result at this path. Fails at once with STATUS_FILE where another run has it; the message names its process
 * and host. A file system without locks locks nothing. */
enum status result_lock_take(struct result_lock *lock, const char *result);

/* Lock n members of the study in a folder from first on, or with n = 0 all of them. Fails at once with STATUS_FILE
 * where another study runs one of them. */
enum status result_lock_members(struct result_lock *lock, const char *folder, int first, int n);

/* Release the lock, and remove its file unless that is locked by others too. In a fork of the process that took the
 * lock: only forget it. */
void result_lock_release(struct result_lock *lock);

/* Do the work under the lock of the result at this path, which may be there or not (target_check). Fails with
 * STATUS_FILE, the work not begun, where nothing can be written there or another run has the lock; then as the work. */
enum status result_lock_hold(const char *result, enum status (*work)(void *data), void *data);

#endif
