/* study_print.h: the table of the members of a study, the warnings, and the expectations of the case. Tested by
 * tests/study/test_study.sh, test_study_file.c and test_study_print.c. */
#ifndef STUDY_PRINT_H
#define STUDY_PRINT_H

#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case_values.h"
#include "study/member_file.h"

/* Insert the name of a quantity for the %s of a format. */
void study_fill_name(char *text, size_t size, const char *format, const char *quantity);

// ---- members

/* Print swept values, final values and status of the members, in columns. Fails with STATUS_MEMORY. */
enum status study_print(const struct case_values *study, const struct member_file *members, FILE *stream);

/* Print the warnings about the results of n members, one line per kind of warning with its members: warnings that
 * differ only in numbers are of one kind. Returns the number of all warnings. */
int study_print_warnings(struct arena *arena, const struct member_file *members, int n, FILE *stream);

/* Print the expectations and the actual values. Fails with STATUS_MISSED if an expectation is not met. */
enum status study_expect(const struct case_values *study, const struct member_file *members, FILE *stream);

/* Whether the failure of a member is expected. */
int study_expects_failure(const struct case_values *study, const struct member_file *members, int member);

#endif
