/* study_print.c: the table of members. Declared in study.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study.h"

enum { CELL_BYTES = 32, MOST_FISH_SHOWN = 4 };

/* The quantities that are shown; all others are in study.nc. */
static const struct shown {
    const char *quantity, *head, *format;
} shown[] = {
    {"time", "t", "%.4g"},
    {"mean_speed", "speed", "%.5f"},
    {"mean_heading", "heading", "%.3f"},
    {"cost_of_transport", "cost", "%.4g"},
    {"strouhal", "Strouhal", "%.4f"},
    {"lateral_drift", "drift", "%.5f"},
    {"shed_circulation", "shed", "%.5f"},
    {"energy_audit", "audit", "%.1e"},
    {"steps", "steps", "%.0f"},
    {"residual_evaluations", "evaluations", "%.0f"},
    {"wall_time", "wall", "%.2f"},
};
enum { N_SHOWN = sizeof shown / sizeof *shown };

/* A table of texts, filled column by column. */
struct table {
    int n_rows, n_columns;
    char (*cell)[CELL_BYTES]; /* (n_rows, n_columns) */
};

static char *cell(const struct table *table, int row, int column) {
    return table->cell[row * table->n_columns + column];
}

static void print_cells(const struct table *table, FILE *stream) {
    for (int row = 0; row < table->n_rows; row++) {
        for (int column = 0; column < table->n_columns; column++) {
            int width = 0;
            for (int r = 0; r < table->n_rows; r++) {
                const int length = (int)strlen(cell(table, r, column));
                if (length > width) width = length;
            }
            if (column < table->n_columns - 1) {
                fprintf(stream, "%*s  ", width, cell(table, row, column));
            } else {
                fprintf(stream, "%s", cell(table, row, column));
            }
        }
        fprintf(stream, "\n");
    }
}

/* "modulus" for fish[*].body.modulus, "[1]phase" for fish[1].wave.phase. */
static void short_name(const char *path, char *to) {
    const char *const dot = strrchr(path, '.');
    const int is_one = strncmp(path, "fish[", 5) == 0 && path[5] != '*';
    snprintf(to, CELL_BYTES, "%.*s%.20s", is_one ? (int)strcspn(path + 4, ".") : 0, path + 4, dot ? dot + 1 : path);
}

/* "complete", "failed", "missing": the first word of a status. */
static void first_word(const char *status, char *to) {
    snprintf(to, CELL_BYTES, "%.*s", (int)strcspn(status, ":"), status);
}

/* Head and unit of each column. */
static void fill_head(struct table *table, const struct settings *study, int with_fish) {
    int c = 0;
    snprintf(cell(table, 0, c++), CELL_BYTES, "member");
    for (int a = 0; a < study->n_axes; a++) {
        for (int k = 0; k < study->sweep[a].n_keys; k++, c++) {
            short_name(study->sweep[a].key[k].path, cell(table, 0, c));
            snprintf(cell(table, 1, c), CELL_BYTES, "%s", study->sweep[a].key[k].unit);
        }
    }
    if (with_fish) snprintf(cell(table, 0, c++), CELL_BYTES, "fish");
    for (int s = 0; s < N_SHOWN; s++, c++) {
        const char *const unit = store_quantity(store_quantity_number(shown[s].quantity))->unit;
        snprintf(cell(table, 0, c), CELL_BYTES, "%s", shown[s].head);
        snprintf(cell(table, 1, c), CELL_BYTES, "%s", strcmp(unit, "1") == 0 ? "" : unit);
    }
    snprintf(cell(table, 0, c), CELL_BYTES, "status");
}

/* One fish of one member. */
static void fill_row(struct table *table, int row, const struct settings *study, const struct store_member *member,
                     int number, int f, int with_fish) {
    int c = 0;
    snprintf(cell(table, row, c++), CELL_BYTES, "%d", number);
    for (int a = 0; a < study->n_axes; a++) {
        const struct settings_axis *const axis = &study->sweep[a];
        const int value = settings_member_value(study, number, a);
        for (int k = 0; k < axis->n_keys; k++) {
            snprintf(cell(table, row, c++), CELL_BYTES, "%.24s", axis->value[value * axis->n_keys + k]);
        }
    }
    if (with_fish) snprintf(cell(table, row, c++), CELL_BYTES, "%.24s", study->fish[f].name);
    for (int s = 0; s < N_SHOWN; s++, c++) {
        const int quantity = store_quantity_number(shown[s].quantity);
        const double value = store_member_value(member, quantity, store_quantity(quantity)->of_fish ? f : 0, 0);
        if (isnan(value)) {
            snprintf(cell(table, row, c), CELL_BYTES, "-");
        } else {
            snprintf(cell(table, row, c), CELL_BYTES, shown[s].format, value);
        }
    }
    first_word(member->status, cell(table, row, c));
}

/* What else there is to say about the members that are not complete. */
static void print_reasons(const struct store_member *members, int n, FILE *stream) {
    for (int m = 0; m < n; m++) {
        const char *const colon = strchr(members[m].status, ':');
        if (colon) fprintf(stream, "member %d %s\n", m, members[m].status);
    }
}

enum status study_print(const struct settings *study, const struct store_member *members, FILE *stream) {
    const int n = settings_n_members(study), n_fish = study->n_fish < MOST_FISH_SHOWN ? study->n_fish : MOST_FISH_SHOWN;
    struct table table = {.n_rows = 2 + n * n_fish, .n_columns = 2 + (n_fish > 1) + N_SHOWN};
    for (int a = 0; a < study->n_axes; a++) table.n_columns += study->sweep[a].n_keys;
    table.cell = calloc((size_t)table.n_rows * (size_t)table.n_columns, sizeof *table.cell);
    if (!table.cell) return status_fail(STATUS_MEMORY, "no memory for a table of %d members", n);
    fill_head(&table, study, n_fish > 1);
    for (int m = 0; m < n; m++) {
        for (int f = 0; f < n_fish; f++) {
            fill_row(&table, 2 + m * n_fish + f, study, &members[m], m, f, n_fish > 1);
        }
    }
    print_cells(&table, stream);
    if (n_fish < study->n_fish) fprintf(stream, "The first %d of %d fish; study.nc has all.\n", n_fish, study->n_fish);
    print_reasons(members, n, stream);
    free(table.cell);
    return STATUS_OK;
}
