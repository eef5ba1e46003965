/* error_report.h: the error budget of a case as a plan, as a table, as error.csv, and in study.nc. doc/studies.md,
 * "Error bars". Tested by tests/study/test_error.sh. */
#ifndef ERROR_REPORT_H
#define ERROR_REPORT_H

#include <stdio.h>

#include "result/netcdf.h"
#include "result/result_kind.h"
#include "study/error_study.h"

/* Print keys and levels, the number of members, and, after a few events of each, the time that they take; n_processes
 * of them at once. Fails as simulate_create, or with STATUS_MEMORY. */
enum status error_report_plan(const struct error_study *study, int n_processes, FILE *stream);

/* Print the values with their errors, and for each fish the share of each key. Fails with STATUS_MEMORY, or, where the
 * errors are not within the bound of the case, with STATUS_MISSED and what that would take. */
enum status error_report_print(struct error_study *study, const struct member_file *members, FILE *stream);

/* Write the same as a table of comma-separated values. Fails with STATUS_FILE. */
enum status error_report_write_csv(const struct error_study *study, const char *path);

/* Define and write its variables in a study.nc that is being written. dimensions: those of fish and text, of which the
 * last has the length n_text; text: room for so much. */
void error_report_define(struct netcdf_writer *writer, const struct error_study *study, const int dimensions[2]);
void error_report_write(struct netcdf_writer *writer, const struct error_study *study, size_t n_text, char *text);

/* Row i, from 0, of the list of its variables; 0 beyond the last. */
int error_report_listed(int i, struct result_listed *listed);

#endif
