/* study_print.h: the table of the members of a study. Tested by tests/study/test_study.sh. */
#ifndef STUDY_PRINT_H
#define STUDY_PRINT_H

#include <stdio.h>

#include "base/status.h"
#include "case/case_values.h"
#include "study/member_file.h"

/* Print swept values, final values and status of the members, in columns. Fails with STATUS_MEMORY. */
enum status study_print(const struct case_values *study, const struct member_file *members, FILE *stream);

/* Print the first warnings about the results of n members; returns the number of all warnings. */
int study_print_warnings(const struct member_file *members, int n, FILE *stream);

#endif
