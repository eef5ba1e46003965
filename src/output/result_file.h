/* result_file.h: the result file, NetCDF classic in the 64-bit data format (CDF-5). doc/output.md lists its contents. One
 * table of variables (name, dimensions, unit, long name, where the value lives) drives definition, writing and the
 * reference. Tested by tests/output/test_result_file.c. */
#ifndef RESULT_FILE_H
#define RESULT_FILE_H

#include <stdio.h>

#include "base/status.h"
#include "case/case.h"
#include "model/diagnostics.h"
#include "model/fish.h"
#include "model/state.h"

/* Running totals of the integrator, as written with every row. */
struct result_counts {
    long steps, residual_evaluations, newton_iterations, jacobian_evaluations;
    long error_test_failures, convergence_failures;
    double step_size; /* the last, s */
    int order;        /* the last */
    double wall_time; /* since the start, s */
};

struct result_file; /* an open result file */

/* Create the file at path. overwrite: replace one that exists, else that is an error. The file is first written under a
 * temporary name beside it and takes its own when its header is complete, so that a failure leaves nothing half made.
 * effective is the complete case (case_show), command the command line, kept in the attribute history.
 * Fails with STATUS_FILE or STATUS_MEMORY; *store is then NULL. */
enum status result_file_create(struct result_file **store, const char *path, int overwrite,
                               const struct case_values *values, const char *effective, const char *command,
                               const struct school *school, long n_events);

/* Append one row; with_wake tells whether the wake is written too (else its variables hold fill values). The file is
 * synchronised at every row, or every second where rows come faster. Fails with STATUS_FILE. */
enum status result_file_row(struct result_file *store, const struct state *state, const struct residual *residual,
                            const struct diagnostics *diagnostics, const struct result_counts *counts, int with_wake);

/* Set the attribute run_status ("complete", "failed: why", "stopped") and close. Accepts NULL. */
enum status result_file_close(struct result_file *store, const char *run_status);

/* Print the table of variables: name, dimensions, unit, meaning; as aligned text, or as JSON. */
void result_variables(FILE *stream, int as_json);

/* The files that shoal writes: of a run, of a study (study_file.h), of a comparison (compare_file.h). */
enum result_kind { RESULT_RUN, RESULT_STUDY, RESULT_COMPARISON };

/* Print a summary of a file, or the case in it alone; of studies and comparisons the head only: see study_info and
 * compare_info. *kind is what the file is. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status result_info(const char *path, int case_only, FILE *stream, enum result_kind *kind);

#endif
