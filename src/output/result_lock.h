/* result_lock.h: no two runs write the same result. A run locks the file RESULT.lock beside it; the kernel frees the
 * lock when the run ends, however it ends. Tested by tests/output/test_result_lock.c. */
#ifndef RESULT_LOCK_H
#define RESULT_LOCK_H

#include "base/status.h"

/* Zero it, with descriptor -1, to begin. */
struct result_lock {
    char *path; /* owned; NULL: there is no lock */
    int descriptor;
};

/* Lock the result at this path. Fails at once with STATUS_FILE where another run has it; the message names its process
 * and host. A file system without locks locks nothing. */
enum status result_lock_take(struct result_lock *lock, const char *result);

/* Remove the lock. */
void result_lock_release(struct result_lock *lock);

/* Do the work under the lock of the result at this path, which may be there or not (netcdf_check_target). Fails with
 * STATUS_FILE, the work not begun, where nothing can be written there or another run has the lock; then as the work. */
enum status result_lock_hold(const char *result, enum status (*work)(void *data), void *data);

#endif
