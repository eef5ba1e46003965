/* status.h: how a function tells its caller that it failed, and why. Tested by tests/base/test_status.c.
 *
 * Zero is success, a positive status asks for a smaller step, and a negative one is final. These are the signs that the
 * callbacks of SUNDIALS use, so a status passes through a callback unchanged. The function that knows the cause calls
 * status_fail with a sentence on which a user can act; its callers use TRY; only main prints. */
#ifndef STATUS_H
#define STATUS_H

#include <signal.h>

enum status {
    STATUS_OK = 0,
    STATUS_RETRY = 1,    /* not a number here: a smaller step may help */
    STATUS_CASE = -1,    /* wrong usage or a wrong case */
    STATUS_FILE = -2,    /* a file cannot be read or written */
    STATUS_MEMORY = -3,  /* out of memory */
    STATUS_SOLVER = -4,  /* the integration failed */
    STATUS_STOPPED = -5, /* a signal asked the run to stop */
    STATUS_MISSED = -6,  /* an expectation of the case is not met */
    STATUS_CONTACT = -7  /* two bodies came together, and the case stops at contact */
};

/* Store the message (printf format, truncated if too long) for this thread and return the status. */
enum status status_fail(enum status status, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The message of the last status_fail of this thread, or "". Valid until the next status_fail of this thread. */
const char *status_message(void);

/* Clear the message, so that a later failure without a message does not show an old message. */
void status_clear(void);

/* STATUS_STOPPED once *stop is no longer 0; stop may be NULL. */
static inline enum status status_ask(const volatile sig_atomic_t *stop) {
    return stop && *stop ? status_fail(STATUS_STOPPED, "stopped by a signal") : STATUS_OK;
}

/* The exit code of the program for a status: 0, 1 (solver), 2 (case, usage), 3 (missed, contact), 4 (file, memory),
 * 75 (stopped by a signal). */
int status_exit_code(enum status status);

/* Return a failure to the caller. */
#define TRY(expression)                                 \
    do {                                                \
        const enum status try_status = (expression);    \
        if (try_status != STATUS_OK) return try_status; \
    } while (0)

#endif
