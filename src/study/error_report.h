/* error_report.h: the error budget of a case as a plan, as a table, as error.csv, and in study.nc. doc/studies.md,
 * "Error bars". Tested by tests/study/test_error.sh. */
#ifndef ERROR_REPORT_H
#define ERROR_REPORT_H

#include <stdio.h>

#include "result/netcdf.h"
#include "result/result_kind.h"
#include "study/error_plan.h"

/* Print keys, levels and number of members; estimate the time of n_processes simultaneous members from a few events of
 * each member. Fails as simulate_create, or with STATUS_MEMORY. */
enum status error_report_plan(const struct error_study *study, int n_processes, FILE *stream);

/* Print values, errors and, for each fish, the share of each key. Fails with STATUS_MEMORY, or with STATUS_MISSED and
 * an estimate of the required refinement if the errors exceed the bound of the case. */
enum status error_report_print(struct error_study *study, const struct member_file *members, FILE *stream);

/* Write values, errors and shares as a table of comma-separated values. Fails with STATUS_FILE. */
enum status error_report_write_csv(const struct error_study *study, const char *path);

/* Define and write the variables of the budget in an open study.nc. dimensions: numbers of the dimensions fish and
 * text; n_text: length of the dimension text; text: scratch of n_text bytes. */
void error_report_define(struct netcdf_writer *writer, const struct error_study *study, const int dimensions[2]);
void error_report_write(struct netcdf_writer *writer, const struct error_study *study, size_t n_text, char *text);

/* Row i, from 0, of the list of variables; 0 beyond the last row. */
int error_report_listed(int i, struct result_listed *listed);

#endif
