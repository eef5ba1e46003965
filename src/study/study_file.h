/* study_file.h: the file study.nc, which is gathered from the files of the members of a study, and the reports of
 * studies. Tested by tests/study/test_study_file.c, test_study.sh, test_error.sh and test_compare_command.sh. */
#ifndef STUDY_FILE_H
#define STUDY_FILE_H

#include <stdbool.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case.h"
#include "result/result_kind.h"
#include "study/compare.h"
#include "study/convergence.h"
#include "study/error_plan.h"
#include "study/member_file.h"
#include "study/study.h"

enum { STUDY_FILE_SCHEMA = 1 /* attribute shoal_study */ };

/* Write study.nc: all members of the study, values of the swept keys, all quantities, the orders and, unless errors is
 * NULL, the error budget. The complete new file replaces an existing file. Fails with STATUS_FILE. */
enum status study_file_write(struct arena *arena, const char *path, const struct case_values *study,
                             const struct member_file *member, const struct convergence_orders *orders,
                             const struct error_sweep *errors, const char *command);

/* Read study.nc into the arena of the reader: the study and the *n_members members, without the effective cases. Fails
 * with STATUS_FILE. */
enum status study_file_read(const struct netcdf_reader *reader, struct case_values **study,
                            struct member_file **members, int *n_members);

/* Row i, from 0, of the list of variables; 0 beyond the last row. */
int study_file_listed(int i, struct result_listed *listed);

// ---- reports

/* Write study.nc from the member files in a folder, to FOLDER/study.nc if path is NULL. Print the members (or the
 * comparison of methods), orders and expectations to stream, the warnings about the members to warnings. Fails with
 * STATUS_FILE (a file belongs to another study, or study.nc cannot be written), STATUS_SOLVER (incomplete members),
 * STATUS_MISSED (an expectation is not met, or, if strict, a result has a warning) or STATUS_MEMORY. */
enum status study_report(const struct case_values *study, const char *folder, const char *path, const char *command,
                         bool strict, FILE *stream, FILE *warnings);

/* Run the study of a case with `error` (error_plan.h) in a folder, including all members that the error bound
 * requires, and report: budget, FOLDER/study.nc, FOLDER/error.csv. plan: 1: print the plan first; 2: print the plan
 * only. Fails as study_run and study_report, and with STATUS_MISSED if the errors exceed the bound. */
enum status study_errors(const struct case_values *values, const struct study_options *options, int plan, bool strict,
                         FILE *stream, FILE *warnings);

/* Run a comparison of methods in a temporary folder, print the table and write the file. Used fields of run: command,
 * limit, progress, stop. Fails with STATUS_CASE, STATUS_SOLVER (the reference failed), STATUS_STOPPED, STATUS_FILE or
 * STATUS_MEMORY. */
enum status study_compare(const struct case_values *values, const struct compare_options *options,
                          const struct study_options *run, FILE *stream);

/* Report as study_report the study of the members in a folder. */
enum status study_gather(const char *folder, const char *command, bool strict, FILE *stream, FILE *warnings);

/* Print the contents of a study.nc: axes, members and orders. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status study_info(const struct netcdf_reader *reader, FILE *stream);

#endif
