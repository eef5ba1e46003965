/* study_table.h: a table of strings, filled by cells and printed in columns. Tested by
 * tests/study/test_study_file.c. */
#ifndef STUDY_TABLE_H
#define STUDY_TABLE_H

#include <stdio.h>

#include "base/status.h"

enum { STUDY_CELL_BYTES = 128 };
struct study_table {
    int n_rows, n_columns;
    int n_left;                     /* the first n_left columns are left-aligned, like the last column */
    char (*cell)[STUDY_CELL_BYTES]; /* (n_rows, n_columns) */
};

/* Create a table of empty cells; all columns except the last one are right-aligned. Fails with STATUS_MEMORY. */
enum status study_table_create(struct study_table *table, int n_rows, int n_columns);
void study_table_free(struct study_table *table);

/* Fill a cell (printf format; longer text is truncated). */
void study_table_set(const struct study_table *table, int row, int column, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Fill a cell with a number; "-" for NaN. */
void study_table_number(const struct study_table *table, int row, int column, const char *format, double number);

/* Print all columns with the alignment of each column. */
void study_table_print(const struct study_table *table, FILE *stream);

#endif
