/* study_print.h: tables of strings in columns; the table of the members of a study, their warnings, and the
 * expectations of the case. Tested by tests/study/test_study.sh, test_study_file.c and test_study_print.c. */
#ifndef STUDY_PRINT_H
#define STUDY_PRINT_H

#include <stdio.h>

#include "base/status.h"
#include "case/case_values.h"
#include "study/member_file.h"

// ---- tables

enum { STUDY_CELL_BYTES = 128 };
struct study_table {
    int n_rows, n_columns;
    int n_left;                     /* the first n_left columns are left-aligned, like the last column */
    char (*cell)[STUDY_CELL_BYTES]; /* (n_rows, n_columns) */
};

/* Create a table of empty cells; all columns except the last one are right-aligned. Fails with STATUS_MEMORY. */
enum status study_table_create(struct study_table *table, int n_rows, int n_columns);
void study_table_free(struct study_table *table);

/* Fill a cell (printf format; longer text is truncated), or a cell with a number ("-" for NaN). */
void study_table_set(const struct study_table *table, int row, int column, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void study_table_number(const struct study_table *table, int row, int column, const char *format, double number);

/* Insert the name of a quantity for the %s of a format. */
void study_fill_name(char *text, size_t size, const char *format, const char *quantity);

/* Print all columns with the alignment of each column. */
void study_table_print(const struct study_table *table, FILE *stream);

// ---- members

/* Print swept values, final values and status of the members, in columns. Fails with STATUS_MEMORY. */
enum status study_print(const struct case_values *study, const struct member_file *members, FILE *stream);

/* Print the warnings about the results of n members, one line per kind of warning with its members: warnings that
 * differ only in numbers are of one kind. Returns the number of all warnings. */
int study_print_warnings(const struct member_file *members, int n, FILE *stream);

/* Print the expectations and the actual values. Fails with STATUS_MISSED if an expectation is not met. */
enum status study_expect(const struct case_values *study, const struct member_file *members, FILE *stream);

/* Whether the failure of a member is expected. */
int study_expects_failure(const struct case_values *study, const struct member_file *members, int member);

#endif
