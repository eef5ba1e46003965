/* study_print.c: the table of members. */
#include "study/study_print.h"

#include <math.h>
#include <string.h>

#include "case/sweep.h"
#include "study/study_table.h"

enum { MAX_FISH_SHOWN = 4, MAX_WARNINGS_SHOWN = 20 };

/* The printed quantities, those of steady states only where a member has a value, those of held bodies only with a held
 * body; study.nc contains all quantities. */
static const struct shown {
    const char *quantity, *head, *format;
    int of_held;
} shown[] = {
    {"time", "t", "%.4g", 0},
    {"speed", "speed", "%.5f", 0},
    {"mean_heading", "heading", "%.3f", 0},
    {"cost_of_transport", "cost", "%.4g", 0},
    {"strouhal", "Strouhal", "%.4f", 0},
    {"mean_thrust", "thrust", "%.5g", 1},
    {"mean_power", "power", "%.5g", 1},
    {"efficiency", "efficiency", "%.5f", 1},
    {"steady_growth", "growth", "%+.4f", 0},
    {"lateral_drift", "drift", "%.5f", 0},
    {"shed_circulation", "shed", "%.5f", 0},
    {"energy_balance", "balance", "%.1e", 0},
    {"steps", "steps", "%.0f", 0},
    {"residual_evaluations", "evaluations", "%.0f", 0},
    {"wall_time", "wall", "%.2f", 0},
};
enum { N_SHOWN = sizeof shown / sizeof *shown };

/* The printed quantities of the members of a study. */
struct columns {
    const struct shown *shown[N_SHOWN];
    int n;
};

static int has_held(const struct case_values *study) {
    for (int f = 0; f < study->school.n_fish; f++) {
        const struct motion_parameters *const motion = &study->school.fish[f].motion;
        if (motion->prescribed != PRESCRIBED_NONE && motion->surge == SURGE_GIVEN) return 1;
    }
    return 0;
}

/* Leave out the quantities of held bodies in a study without one, and those of steady states that no member has. */
static struct columns columns_of(const struct case_values *study, const struct member_file *members, int n) {
    struct columns columns = {.n = 0};
    for (int s = 0; s < N_SHOWN; s++) {
        if (shown[s].of_held && !has_held(study)) continue;
        const int quantity = member_file_quantity_number(shown[s].quantity);
        int is_known = !member_file_quantity(quantity)->of_steady;
        for (int m = 0; m < n && !is_known; m++) is_known = !isnan(member_file_value(&members[m], quantity, 0, 0));
        if (is_known) columns.shown[columns.n++] = &shown[s];
    }
    return columns;
}

/* "modulus" for fish[*].body.modulus, "[1]phase" for fish[1].wave.phase. */
static void set_short_name(const struct study_table *table, int row, int column, const char *path) {
    const char *const dot = strrchr(path, '.');
    const int is_one = strncmp(path, "fish[", 5) == 0 && path[5] != '*';
    study_table_set(table, row, column, "%.*s%s", is_one ? (int)strcspn(path + 4, ".") : 0, path + 4,
                    dot ? dot + 1 : path);
}

/* Head and unit of each column. */
static void members_fill_head(const struct study_table *table, const struct case_values *study,
                              const struct columns *columns, int with_fish) {
    int c = 0;
    study_table_set(table, 0, c++, "member");
    for (int a = 0; a < study->n_axes; a++) {
        for (int k = 0; k < study->sweep[a].n_keys; k++, c++) {
            set_short_name(table, 0, c, study->sweep[a].key[k].path);
            study_table_set(table, 1, c, "%s", study->sweep[a].key[k].unit);
        }
    }

    if (with_fish) study_table_set(table, 0, c++, "fish");
    for (int s = 0; s < columns->n; s++, c++) {
        const char *const unit = member_file_quantity(member_file_quantity_number(columns->shown[s]->quantity))->unit;
        study_table_set(table, 0, c, "%s", columns->shown[s]->head);
        study_table_set(table, 1, c, "%s", strcmp(unit, "1") == 0 ? "" : unit);
    }

    study_table_set(table, 0, c, "status");
}

/* Fill the row of one fish of one member. */
static void members_fill_row(const struct study_table *table, int row, const struct case_values *study,
                             const struct columns *columns, const struct member_file *member, int number, int f,
                             int with_fish) {
    int c = 0;
    study_table_set(table, row, c++, "%d", number);
    for (int a = 0; a < study->n_axes; a++) {
        const struct sweep_axis *const axis = &study->sweep[a];
        const int value = sweep_member_value(study, number, a);
        for (int k = 0; k < axis->n_keys; k++) {
            study_table_set(table, row, c++, "%s", axis->value[value * axis->n_keys + k]);
        }
    }

    if (with_fish) study_table_set(table, row, c++, "%s", study->school.fish[f].name);
    for (int s = 0; s < columns->n; s++) {
        const int quantity = member_file_quantity_number(columns->shown[s]->quantity);
        const double value = member_file_value(member, quantity, member_file_quantity(quantity)->of_fish ? f : 0, 0);
        study_table_number(table, row, c++, columns->shown[s]->format, value);
    }

    // "failed: reason": the reasons follow the table
    study_table_set(table, row, c, "%.*s", (int)strcspn(member->status, ":"), member->status);
}

/* Print the reasons of incomplete members. */
static void members_print_reasons(const struct member_file *members, int n, FILE *stream) {
    for (int m = 0; m < n; m++) {
        if (strchr(members[m].status, ':')) fprintf(stream, "member %d %s\n", m, members[m].status);
    }
}

enum status study_print(const struct case_values *study, const struct member_file *members, FILE *stream) {
    const int n = sweep_n_members(study),
              n_fish = study->school.n_fish < MAX_FISH_SHOWN ? study->school.n_fish : MAX_FISH_SHOWN;
    const struct columns columns = columns_of(study, members, n);
    int n_columns = 2 + (n_fish > 1) + columns.n;

    for (int a = 0; a < study->n_axes; a++) n_columns += study->sweep[a].n_keys;
    struct study_table table;
    TRY(study_table_create(&table, 2 + n * n_fish, n_columns));
    members_fill_head(&table, study, &columns, n_fish > 1);

    for (int m = 0; m < n; m++) {
        for (int f = 0; f < n_fish; f++) {
            members_fill_row(&table, 2 + m * n_fish + f, study, &columns, &members[m], m, f, n_fish > 1);
        }
    }

    study_table_print(&table, stream);
    study_table_free(&table);
    if (n_fish < study->school.n_fish)
        fprintf(stream, "The first %d of %d fish; study.nc has all.\n", n_fish, study->school.n_fish);
    members_print_reasons(members, n, stream);

    return STATUS_OK;
}

int study_print_warnings(const struct member_file *members, int n, FILE *stream) {
    int n_warnings = 0;
    for (int m = 0; m < n; m++) {
        for (const char *line = members[m].warnings; line && *line; line += *line == '\n') {
            const int length = (int)strcspn(line, "\n");
            if (n_warnings++ < MAX_WARNINGS_SHOWN) fprintf(stream, "member %d: warning: %.*s\n", m, length, line);
            line += length;
        }
    }

    if (n_warnings > MAX_WARNINGS_SHOWN)
        fprintf(stream, "The first %d of %d warnings; study.nc has all.\n", MAX_WARNINGS_SHOWN, n_warnings);
    return n_warnings;
}
