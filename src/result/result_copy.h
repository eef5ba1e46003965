/* result_copy.h: rows of one result file into another that has room for more vortices. Tested by
 * tests/result/test_result_mark.c. */
#ifndef RESULT_COPY_H
#define RESULT_COPY_H

#include <stdbool.h>

#include "base/status.h"
#include "result/netcdf.h"
#include "result/result_table.h"

/* Where rows come from. */
struct result_source {
    const char *path;
    long n_rows;
    bool drop_last_wake; /* the last of them gets no record of the wake */
};

/* Where they go: number of each variable of the table, whether it is in the file, its lengths, and a buffer for one
 * row of any. */
struct result_target {
    struct netcdf_writer *writer;
    const int *number;
    enum output_forces forces;
    const size_t *length;
    double *buffer;
};

/* Copy all rows. Fails with STATUS_FILE or STATUS_MEMORY where they cannot be read; the writer knows what could not be
 * written. */
enum status result_copy_rows(const struct result_source *source, const struct result_target *target);

#endif
