/* compare_file.h: the file of a comparison of methods: what each run cost and how far it was off. */
#ifndef COMPARE_FILE_H
#define COMPARE_FILE_H

#include "base/status.h"
#include "case/case.h"
#include "output/result_kind.h"

enum { COMPARE_FILE_SCHEMA = 1 /* attribute shoal_compare */ };

struct compare_file_row {
    char method[32];               /* "ida2": implicit of order 2; or an explicit method */
    char status[512];              /* "complete", or why it ended early */
    double rtol, step;             /* NaN: not what was varied */
    double nose_error, tail_error; /* of the fish that is off most at the end, in its lengths; NaN: unknown */
    double wall_time;              /* median, s */
    double steps, evaluations, newton_iterations, jacobians, linear_solves;
};

/* What all are compared with: the implicit method of order 5. */
struct compare_file_reference {
    double rtol;
    double nose_error, tail_error; /* with ten times that tolerance, against it: how good it is, in lengths */
};

/* Write the rows. A file that is there is replaced when the new one is complete. Fails with STATUS_FILE. */
enum status compare_file_write(const char *path, const struct case_values *values,
                               const struct compare_file_reference *reference, int n,
                               const struct compare_file_row *row, const char *command);

/* Read them back; the caller frees *row. Fails with STATUS_FILE or STATUS_MEMORY; *row is then NULL. */
enum status compare_file_read(const char *path, struct compare_file_reference *reference, int *n,
                              struct compare_file_row **row);

/* Row i, from 0, of the reference of its variables; 0 beyond the last. */
int compare_file_listed(int i, struct result_listed *listed);

#endif
