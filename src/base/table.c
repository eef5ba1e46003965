/* table.c: see table.h. */
#include "base/table.h"

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <string.h>

enum { CELL_BYTES = 1024 };

struct table {
    struct arena *arena;
    int n_columns, n_left, n_cells;
    bool has_units;
    char **head, **unit; /* (n_columns) */
    char **cell;         /* complete rows, and the begin of a row       (n_cells) */
};

struct table *table_create(struct arena *arena, int n_left) {
    struct table *table;
    NEW(arena, table, 1);
    table->arena = arena;
    table->n_left = n_left;
    return table;
}

void table_column(struct table *table, const char *head, const char *unit) {
    const int c = table->n_columns++;
    GROW(table->arena, table->head, table->n_columns);
    GROW(table->arena, table->unit, table->n_columns);
    table->head[c] = arena_text(table->arena, "%s", head);
    table->unit[c] = arena_text(table->arena, "%s", unit ? unit : "");
    table->has_units |= unit != NULL;
}

// append a cell with a text of the arena; enlarge by doubling
static void table_append(struct table *table, char *text) {
    const int n = table->n_cells++;
    if ((n & (n - 1)) == 0) GROW(table->arena, table->cell, n > 0 ? 2 * n : 1);
    table->cell[n] = text;
}

void table_cell(struct table *table, const char *format, ...) {
    char text[CELL_BYTES];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    table_append(table, arena_text(table->arena, "%s", text));
}

void table_number(struct table *table, const char *format, double number) {
    char text[CELL_BYTES];
    snprintf(text, sizeof text, format, number);
    table_append(table, arena_text(table->arena, "%s", isnan(number) ? "-" : text));
}

void table_row(struct table *table) {
    static char empty[] = "";
    while (table->n_cells % table->n_columns != 0) table_append(table, empty);
}

void table_print(const struct table *table, FILE *stream) {
    const int n = table->n_columns, n_rows = table->n_cells / n;
    int *width;
    NEW(table->arena, width, n);
    for (int row = -2; row < n_rows; row++) {
        char **const line = row == -2 ? table->head : row == -1 ? table->unit : table->cell + row * n;
        for (int c = 0; c < n; c++) {
            const int length = (int)strlen(line[c]);
            width[c] = length > width[c] ? length : width[c];
        }
    }

    for (int row = -2; row < n_rows; row++) {
        if (row == -1 && !table->has_units) continue;
        char **const line = row == -2 ? table->head : row == -1 ? table->unit : table->cell + row * n;
        int n_blanks = 0;
        for (int c = 0; c < n; c++) {
            const bool is_left = c < table->n_left;
            const int rest = c == n - 1 ? 0 : width[c] - (int)strlen(line[c]);
            n_blanks += (c > 0 ? 2 : 0) + (is_left ? 0 : rest);
            if (*line[c]) fprintf(stream, "%*s%s", n_blanks, "", line[c]);
            n_blanks = (*line[c] ? 0 : n_blanks) + (is_left ? rest : 0);
        }
        fprintf(stream, "\n");
    }
}
