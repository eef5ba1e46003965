/* study_print.h: prints everything about a study: members, warnings, expectations, orders, and errors. Tested by
 * tests/study/test_study.sh, test_error.sh, test_study_file.c, test_study_print.c and test_error_plan.c. */
#ifndef STUDY_PRINT_H
#define STUDY_PRINT_H

#include <stdbool.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case_values.h"
#include "study/convergence.h"
#include "study/error_plan.h"
#include "study/member_file.h"

/* Print swept values, final values and status of the members, in columns. */
void study_print(struct arena *arena, const struct case_values *study, const struct member_file *members, FILE *stream);

/* Print the warnings about the results of n members, one line per kind of warning with its members: warnings that
 * differ only in numbers are of one kind. Returns the number of all warnings. */
int study_print_warnings(struct arena *arena, const struct member_file *members, int n, FILE *stream);

/* Print the expectations and the actual values. Fails with STATUS_MISSED if an expectation is not met. */
enum status study_expect(const struct case_values *study, const struct member_file *members, FILE *stream);

/* Print errors and orders along a refined axis. Fails with STATUS_MISSED if the order of a quantity differs from the
 * order that the axis expects. */
enum status study_print_orders(struct arena *arena, const struct case_values *study,
                               const struct convergence_orders *orders, FILE *stream);

// ---- an error study: doc/studies.md, "Error bars"

/* Print keys, levels and number of members; estimate the time of n_processes simultaneous members from a few events of
 * each member. options: for progress and stop. Fails as simulate_start. */
enum status study_print_plan(const struct error_sweep *sweep, int n_processes, const struct study_options *options,
                             FILE *stream);

/* Print the values with the errors of one point and, for each fish, the share of each key; in a sweep, a row of values
 * and errors for each point. Fails with STATUS_MISSED and an estimate of the required refinement if the errors of one
 * point exceed the bound of the case. */
enum status study_print_errors(struct error_study *study, const struct member_file *members, FILE *stream);

/* Write values, errors and shares of all points as a table of comma-separated values. Fails with STATUS_FILE. */
enum status study_print_csv(const struct error_sweep *sweep, const char *path);

/* The reason of a flag of a quantity of a fish with its levels, or "". */
void study_print_reason(const struct error_study *study, const struct error_study_key *key, int place,
                        char text[CONVERGENCE_BYTES]);

#endif
