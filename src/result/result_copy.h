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
    bool drop_last_wake; /* the last row gets no record of the wake */
};

/* The target: for each variable of the table the number, presence in the file and lengths, and a buffer for one row of
 * any variable. */
struct result_target {
    struct netcdf_writer *writer;
    const int *number;
    enum output_forces forces;
    const size_t *length;
    double *buffer;
};

/* Copy all rows. Fails with STATUS_FILE or STATUS_MEMORY if rows cannot be read; the writer stores failures of writing.
 * */
enum status result_copy_rows(const struct result_source *source, const struct result_target *target);

#endif
