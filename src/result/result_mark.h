/* result_mark.h: which rows of a result file belong to a checkpoint: how many, and a checksum of their bytes. Tested by
 * tests/result/test_result_mark.c. */
#ifndef RESULT_MARK_H
#define RESULT_MARK_H

#include <stdint.h>

#include "base/status.h"

struct result_mark {
    long n_rows;
    uint32_t check; /* CRC-32 of all values that do not grow, and of these rows, as they are in the file */
};

/* How far the checksum of a growing file has come. Zero it to begin. */
struct result_checksum {
    uint64_t done; /* bytes of the file, 0: none */
    uint32_t value;
};

/* Mark the first n_rows of a file. Bytes that the checksum has seen are not read again. Fails with STATUS_FILE (there
 * are not so many rows, or they cannot be read). */
enum status result_mark_take(const char *path, long n_rows, struct result_checksum *checksum, struct result_mark *mark);

/* Fail with STATUS_FILE, and the reason, unless the file at path holds the rows of a mark, and the case (effective) is
 * its own. *is_complete: whether its run has reached its end. *checksum: that of the mark. */
enum status result_mark_check(const char *path, const struct result_mark *mark, const char *effective,
                              struct result_checksum *checksum, int *is_complete);

#endif
