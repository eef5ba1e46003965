/* study_gather.h: from the files of the members to study.nc and the tables. Tested by tests/study/test_study.sh. */
#ifndef STUDY_GATHER_H
#define STUDY_GATHER_H

#include <stdio.h>

#include "base/status.h"
#include "case/case_values.h"
#include "study/study.h"

/* Make the file of a study, FOLDER/study.nc unless path is another one, from the files of the members in a folder, and
 * print the members (of a comparison of methods: the comparison), orders and expectations. Fails with
 * STATUS_FILE (a file belongs to another study, or study.nc cannot be written), STATUS_SOLVER (some members are not
 * complete), STATUS_MISSED (another order or value than the case expects; where strict, a warning about a result) or
 * STATUS_MEMORY. */
enum status study_report(const struct case_values *study, const char *folder, const char *path, const char *command,
                         int strict, FILE *stream);

/* Run the study of a case with `error` (error_study.h) in its folder, with all members that its bound asks for, and
 * report: the budget, FOLDER/study.nc and FOLDER/error.csv. plan: print the plan before; 2: and run nothing. Fails as
 * study_run and study_report; with STATUS_MISSED also where the errors are not within the bound. */
enum status study_errors(const struct case_values *values, const struct study_options *options, int plan, int strict,
                         FILE *stream);

/* The same as study_report for the study that the members in the folder belong to. */
enum status study_gather(const char *folder, const char *command, int strict, FILE *stream);

/* Print what a study.nc holds: axes, members and orders. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status study_info(const char *path, FILE *stream);

#endif
