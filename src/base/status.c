/* status.c: keeps one message for each thread, and translates a status into an exit code. */
#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>

// alignment of the next thread-local block: without this alignment mold 1.10 may produce a program that does not start
static _Thread_local _Alignas(64) char message[65536];

enum status status_fail(enum status status, const char *format, ...) {
    // the arguments may point into the old message, so write elsewhere first
    static _Thread_local char new_message[sizeof message];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(new_message, sizeof new_message, format, arguments);
    va_end(arguments);
    snprintf(message, sizeof message, "%s", new_message);

    return status;
}

const char *status_message(void) {
    return message;
}

void status_clear(void) {
    message[0] = '\0';
}

int status_exit_code(enum status status) {
    switch (status) {
        case STATUS_OK: return 0;
        case STATUS_RETRY:
        case STATUS_SOLVER: return 1;
        case STATUS_CASE: return 2;
        case STATUS_MISSED:
        case STATUS_CONTACT: return 3;
        case STATUS_FILE:
        case STATUS_MEMORY: return 4;
        case STATUS_STOPPED: return 75;
    }

    return 1;
}
