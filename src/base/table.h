/* table.h: tables of strings for the terminal, which grow row by row; over each column stand a head and a unit. Tested
 * by tests/base/test_table.c. */
#ifndef TABLE_H
#define TABLE_H

#include <stdio.h>

#include "base/arena.h"

/* Create a table in an arena. The first n_left columns and the last column are left-aligned, all others right-aligned.
 */
struct table *table_create(struct arena *arena, int n_left);

/* Add a column before the first row. unit NULL: no unit; a table without any unit has no row of units. */
void table_column(struct table *table, const char *head, const char *unit);

/* Fill the next cell of the current row: printf format, or a number ("-" for NaN). table_row ends the row; the cells up
 * to the last column stay empty. */
void table_cell(struct table *table, const char *format, ...) __attribute__((format(printf, 2, 3)));
void table_number(struct table *table, const char *format, double number);
void table_row(struct table *table);

/* Print the columns without blanks at the ends of lines. */
void table_print(const struct table *table, FILE *stream);

#endif
