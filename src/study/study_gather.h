/* study_gather.h: gathering of the member files into study.nc and the printed tables. Tested by
 * tests/study/test_study.sh, test_error.sh and test_compare.sh. */
#ifndef STUDY_GATHER_H
#define STUDY_GATHER_H

#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"
#include "base/text.h"
#include "case/case_values.h"
#include "study/study.h"

/* Write study.nc from the member files in a folder, to FOLDER/study.nc if path is NULL. Print the members (or the
 * comparison of methods), orders and expectations to stream, the warnings about the members to warnings. Fails with
 * STATUS_FILE (a file belongs to another study, or study.nc cannot be written), STATUS_SOLVER (incomplete members),
 * STATUS_MISSED (an expectation is not met, or, if strict, a result has a warning) or STATUS_MEMORY. */
enum status study_report(const struct case_values *study, const char *folder, const char *path, const char *command,
                         int strict, FILE *stream, FILE *warnings);

/* Run the study of a case with `error` (error_plan.h) in a folder, including all members that the error bound
 * requires, and report: budget, FOLDER/study.nc, FOLDER/error.csv. plan: 1: print the plan first; 2: print the plan
 * only. Fails as study_run and study_report, and with STATUS_MISSED if the errors exceed the bound. */
enum status study_errors(const struct case_values *values, const struct study_options *options, int plan, int strict,
                         FILE *stream, FILE *warnings);

/* Report as study_report the study of the members in a folder. */
enum status study_gather(const char *folder, const char *command, int strict, FILE *stream, FILE *warnings);

/* Print the contents of a study.nc: axes, members and orders. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status study_info(struct arena *arena, const char *path, FILE *stream);

// ---- study_compare.c: comparison of integration methods and tolerances or steps: error, wall time and counts
//
// The comparison is a study with a reference (study_comparison.h) in a temporary folder. The members run one at a time,
// and each round of repeats runs all settings, so that the noise of the machine affects all settings alike.

struct study_compare_options {
    const char
        *methods;      /* "ida2,ida5,rk4": ida with the highest order, or words of solver.method; NULL: all adaptive */
    const char *rtols; /* "1e-3,1e-5"; NULL: 1e-3 to 1e-7 */
    const char *steps; /* fixed steps of all methods but ida, instead of tolerances; NULL: none */
    int repeats;
    double reference_rtol; /* of the reference, ida of order 5 */
    const char *path;      /* file to write, in the format of study.nc; NULL: none */
};

/* Run the comparison, print the table and write the file. Used fields of run: command, limit, progress, stop.
 * STATUS_CASE, STATUS_SOLVER (the reference failed), STATUS_STOPPED, STATUS_FILE or STATUS_MEMORY. */
enum status study_compare(const struct case_values *values, const struct study_compare_options *options,
                          const struct study_options *run, FILE *stream);

/* Add the words accepted in methods. */
void study_compare_words(struct text *text);

#endif
