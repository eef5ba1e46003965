/* fuzz.h: A fuzz target takes one input, which must do no harm. tests/fuzz/driver.c calls it or, with clang, libFuzzer,
 * whose names these are. */
#ifndef FUZZ_H
#define FUZZ_H

#include <fcntl.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/status.h"

/* Try an input; abort where something is wrong. Returns 0. */
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n);

/* ---- for targets that read a file */

static char fuzz_path[64];

static inline void fuzz_remove(void) {
    unlink(fuzz_path);
}

/* Write the input to fuzz_path, a file of this process in memory. */
static inline void fuzz_write(const uint8_t *bytes, size_t n) {
    if (!*fuzz_path) {
        snprintf(fuzz_path, sizeof fuzz_path, "/dev/shm/shoal-fuzz-%ld", (long)getpid());
        atexit(fuzz_remove);
    }
    const int file = open(fuzz_path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (file < 0 || write(file, bytes, n) != (ssize_t)n || close(file) != 0) abort();
}

/* A stream that keeps nothing. */
static inline FILE *fuzz_nowhere(void) {
    static FILE *nowhere;
    if (!nowhere) nowhere = fopen("/dev/null", "w");
    if (!nowhere) abort();
    return nowhere;
}

/* The input is refused, if at all, as a file or for the case in it. */
static inline void fuzz_demand_refusal(enum status status) {
    if (status == STATUS_OK || status == STATUS_FILE || status == STATUS_CASE) return;
    fprintf(stderr, "refused with status %d: %s\n", status, status_message());
    abort();
}

#endif
