/* study_table.h: a table of strings that is filled cell by cell and printed in columns. Tested by
 * tests/study/test_study_file.c. */
#ifndef STUDY_TABLE_H
#define STUDY_TABLE_H

#include <stdio.h>

#include "base/status.h"

enum { STUDY_CELL_BYTES = 128 };
struct study_table {
    int n_rows, n_columns;
    int n_left;                     /* columns from the first one on that are aligned to the left, as the last one is */
    char (*cell)[STUDY_CELL_BYTES]; /* (n_rows, n_columns) */
};

/* All cells are empty, and all columns but the last one aligned to the right. Fails with STATUS_MEMORY. */
enum status study_table_create(struct study_table *table, int n_rows, int n_columns);
void study_table_free(struct study_table *table);

/* Fill a cell (printf format; what is too long is cut). */
void study_table_set(const struct study_table *table, int row, int column, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* The same for a number, "-" where it is NaN. */
void study_table_number(const struct study_table *table, int row, int column, const char *format, double number);

/* Print all columns, those that are not aligned to the left to the right. */
void study_table_print(const struct study_table *table, FILE *stream);

#endif
