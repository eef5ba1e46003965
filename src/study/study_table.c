/* study_table.c: tables of strings. */
#include "study/study_table.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum status study_table_create(struct study_table *table, int n_rows, int n_columns) {
    *table = (struct study_table){n_rows, n_columns, 0, calloc((size_t)n_rows * (size_t)n_columns, STUDY_CELL_BYTES)};
    return table->cell ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: a table of %d rows", n_rows);
}

void study_table_free(struct study_table *table) {
    free(table->cell);
    *table = (struct study_table){0};
}

void study_table_set(const struct study_table *table, int row, int column, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(table->cell[row * table->n_columns + column], STUDY_CELL_BYTES, format, arguments);
    va_end(arguments);
}

void study_table_number(const struct study_table *table, int row, int column, const char *format, double number) {
    char text[STUDY_CELL_BYTES];
    snprintf(text, sizeof text, format, number);
    study_table_set(table, row, column, "%s", isnan(number) ? "-" : text);
}

static int column_width(const struct study_table *table, int column) {
    int max = 0;
    for (int row = 0; row < table->n_rows; row++) {
        const int length = (int)strlen(table->cell[row * table->n_columns + column]);
        if (length > max) max = length;
    }
    return max;
}

static void table_print_row(const struct study_table *table, int row, FILE *stream) {
    int n_blanks = 0;  // no blanks at the end of a line
    for (int column = 0; column < table->n_columns; column++) {
        const char *const text = table->cell[row * table->n_columns + column];
        const int is_last = column == table->n_columns - 1;
        const int rest = is_last ? 0 : column_width(table, column) - (int)strlen(text),
                  is_left = column < table->n_left;
        n_blanks += (column > 0 ? 2 : 0) + (is_left ? 0 : rest);
        if (*text) fprintf(stream, "%*s%s", n_blanks, "", text);
        n_blanks = (*text ? 0 : n_blanks) + (is_left ? rest : 0);
    }
    fprintf(stream, "\n");
}

void study_table_print(const struct study_table *table, FILE *stream) {
    for (int row = 0; row < table->n_rows; row++) table_print_row(table, row, stream);
}
