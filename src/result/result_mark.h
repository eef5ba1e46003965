/* result_mark.h: the rows of a result file before a checkpoint: number and checksum. Tested by
 * tests/result/test_result_mark.c. */
#ifndef RESULT_MARK_H
#define RESULT_MARK_H

#include <stdint.h>

#include "base/status.h"

struct result_mark {
    long n_rows;
    uint32_t check; /* CRC-32 of the bytes in the file: all variables without rows, and these rows */
};

/* The state of the checksum of a growing file. Zero to begin. */
struct result_checksum {
    uint64_t done; /* bytes of the file, 0: none */
    uint32_t value;
};

/* Mark the first n_rows of a file. Bytes in the checksum are not read again. Fails with STATUS_FILE if rows are missing
 * or unreadable. */
enum status result_mark_take(const char *path, long n_rows, struct result_checksum *checksum, struct result_mark *mark);

/* Fail with STATUS_FILE, and the reason, unless the file at path has the rows of a mark and the same case (effective).
 * *is_complete: the run has reached time.end. *checksum: of the mark. */
enum status result_mark_check(const char *path, const struct result_mark *mark, const char *effective,
                              struct result_checksum *checksum, int *is_complete);

#endif
