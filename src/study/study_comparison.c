/* study_comparison.c: errors against the reference, and the table of a comparison. */
#include "study/study_comparison.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "case/sweep_members.h"
#include "study/study_table.h"

enum { METHOD, ORDER, RTOL, STEP, N_KEYS };
static const char *const keys[N_KEYS] = {"solver.method", "solver.order", "solver.rtol", "solver.step"};

int study_comparison_is(const struct case_values *study) {
    if (study->n_axes != 1 || study->sweep[0].n_keys != N_KEYS) return 0;
    for (int k = 0; k < N_KEYS; k++) {
        if (strcmp(study->sweep[0].key[k].path, keys[k]) != 0) return 0;
    }
    return study->sweep[0].n_values > STUDY_COMPARISON_N_REFERENCES;
}

static int is_complete(const struct member_file *member) {
    return strcmp(member->status, "complete") == 0;
}

// ---- errors

/* The distance of a point of a fish from that of the reference, in body lengths; NaN where one of them has none. */
static double distance(const struct case_values *study, const struct member_file *members, int m, const char *point,
                       int f) {
    if (!is_complete(&members[m]) || !is_complete(&members[0])) return NAN;
    const int q = member_file_quantity_number(point);
    const double x = member_file_value(&members[m], q, f, 0) - member_file_value(&members[0], q, f, 0);
    const double y = member_file_value(&members[m], q, f, 1) - member_file_value(&members[0], q, f, 1);
    return hypot(x, y) / study->school.fish[f].length;
}

void study_comparison_fill_errors(const struct case_values *study, const struct member_file *members) {
    if (!study_comparison_is(study)) return;
    const int nose_error = member_file_quantity_number("nose_error");
    const int tail_error = member_file_quantity_number("tail_error");
    for (int m = 0; m < sweep_n_members(study); m++) {
        for (int f = 0; f < members[m].n_fish; f++) {
            *member_file_place(&members[m], nose_error, f, 0) = distance(study, members, m, "nose", f);
            *member_file_place(&members[m], tail_error, f, 0) = distance(study, members, m, "tail", f);
        }
    }
}

/* The largest error of a fish. */
static double largest_error(const struct case_values *study, const struct member_file *member, const char *error) {
    double max = NAN;
    for (int f = 0; f < study->school.n_fish; f++) {
        max = fmax(max, member_file_value(member, member_file_quantity_number(error), f, 0));
    }
    return max;
}

// ---- repeats

/* What member m sets a key to. */
static const char *set_to(const struct case_values *study, int m, int key) {
    return study->sweep[0].value[m * N_KEYS + key];
}

static int are_repeats(const struct case_values *study, int m, int other) {
    for (int k = 0; k < N_KEYS; k++) {
        if (strcmp(set_to(study, m, k), set_to(study, other, k)) != 0) return 0;
    }
    return 1;
}

/* The first of the repeats of member m. */
static int first_of(const struct case_values *study, int m) {
    int first = STUDY_COMPARISON_N_REFERENCES;
    while (!are_repeats(study, m, first)) first++;
    return first;
}

static int ascending(const void *a, const void *b) {
    const double *const one = a, *const other = b;
    return (*one > *other) - (*one < *other);
}

/* The median of the wall times of the complete repeats of member m, s; NaN: none is complete. buffer: (members) */
static double median_wall_time(const struct case_values *study, const struct member_file *members, int m,
                               double *buffer) {
    const int wall_time = member_file_quantity_number("wall_time");
    int n = 0;
    for (int i = m; i < sweep_n_members(study); i++) {
        if (!are_repeats(study, i, m) || !is_complete(&members[i])) continue;
        buffer[n++] = member_file_value(&members[i], wall_time, 0, 0);
    }
    if (n == 0) return NAN;
    qsort(buffer, (size_t)n, sizeof *buffer, ascending);
    return (buffer[(n - 1) / 2] + buffer[n / 2]) / 2;
}

// ---- the table

/* "ida2" for ida of order 2, else the word of the method. */
static void name_method(const struct case_values *study, int m, char name[STUDY_CELL_BYTES]) {
    const char *const word = set_to(study, m, METHOD);
    snprintf(name, STUDY_CELL_BYTES, "%s%s", word, strcmp(word, "ida") == 0 ? set_to(study, m, ORDER) : "");
}

static int has_step(const struct case_values *study, int m) {
    double step;
    return text_number(set_to(study, m, STEP), &step) && step > 0;
}

/* The counts and their columns. */
static const struct count {
    const char *quantity, *head;
} counts[] = {
    {"steps", "steps"},
    {"residual_evaluations", "evaluat."},
    {"newton_iterations", "Newton"},
    {"jacobian_evaluations", "Jacobians"},
};
enum { N_COUNTS = sizeof counts / sizeof *counts, N_BEFORE = 6, N_COLUMNS = N_BEFORE + N_COUNTS + 2 };

static void fill_head(const struct study_table *table) {
    static const char *const heads[N_BEFORE][2] = {{"method", ""},      {"rtol", ""},        {"step", "s"},
                                                   {"nose", "lengths"}, {"tail", "lengths"}, {"wall", "s"}};
    for (int c = 0; c < N_BEFORE; c++) {
        for (int row = 0; row < 2; row++) study_table_set(table, row, c, "%s", heads[c][row]);
    }
    for (int c = 0; c < N_COUNTS; c++) study_table_set(table, 0, N_BEFORE + c, "%s", counts[c].head);
    study_table_set(table, 0, N_COLUMNS - 2, "us/eval.");
    study_table_set(table, 0, N_COLUMNS - 1, "status");
}

static void fill_row(const struct study_table *table, int row, const struct case_values *study,
                     const struct member_file *members, int m, double wall_time) {
    const struct member_file *const member = &members[m];
    char method[STUDY_CELL_BYTES];
    name_method(study, m, method);
    study_table_set(table, row, 0, "%s", method);
    study_table_set(table, row, 1, "%s", has_step(study, m) ? "-" : set_to(study, m, RTOL));
    study_table_set(table, row, 2, "%s", has_step(study, m) ? set_to(study, m, STEP) : "-");
    study_table_number(table, row, 3, "%.1e", largest_error(study, member, "nose_error"));
    study_table_number(table, row, 4, "%.1e", largest_error(study, member, "tail_error"));
    study_table_number(table, row, 5, "%.3f", wall_time);
    for (int c = 0; c < N_COUNTS; c++) {
        const int quantity = member_file_quantity_number(counts[c].quantity);
        study_table_number(table, row, N_BEFORE + c, "%.0f", member_file_value(member, quantity, 0, 0));
    }
    const int evaluations = member_file_quantity_number("residual_evaluations");
    study_table_number(table, row, N_COLUMNS - 2, "%.1f",
                       1e6 * wall_time / member_file_value(member, evaluations, 0, 0));
    // "failed: why": the reasons follow the table
    study_table_set(table, row, N_COLUMNS - 1, "%.*s", (int)strcspn(member->status, ":"), member->status);
}

/* One sentence on the reference. */
static void print_reference(const struct case_values *study, const struct member_file *members, FILE *stream) {
    char method[STUDY_CELL_BYTES], other[STUDY_CELL_BYTES];
    name_method(study, 0, method);
    name_method(study, 1, other);
    fprintf(stream, "Reference: %s, rtol %s; %s, rtol %s is off by %.1e (nose) and %.1e (tail) lengths.\n", method,
            set_to(study, 0, RTOL), other, set_to(study, 1, RTOL), largest_error(study, &members[1], "nose_error"),
            largest_error(study, &members[1], "tail_error"));
}

/* Why rows are not complete. */
static void print_reasons(const struct case_values *study, const struct member_file *members, FILE *stream) {
    for (int m = 0; m < sweep_n_members(study); m++) {
        if (!strchr(members[m].status, ':')) continue;
        if (m >= STUDY_COMPARISON_N_REFERENCES && first_of(study, m) != m) continue;
        char method[STUDY_CELL_BYTES];
        name_method(study, m, method);
        const int by_step = has_step(study, m);
        fprintf(stream, "%s, %s %s %s\n", method, by_step ? "step" : "rtol", set_to(study, m, by_step ? STEP : RTOL),
                members[m].status);
    }
}

enum status study_comparison_print(const struct case_values *study, const struct member_file *members, FILE *stream) {
    const int n = sweep_n_members(study);
    int n_rows = 0;
    for (int m = STUDY_COMPARISON_N_REFERENCES; m < n; m++) n_rows += first_of(study, m) == m;
    double *const buffer = calloc((size_t)n, sizeof *buffer);
    if (!buffer) return status_fail(STATUS_MEMORY, "out of memory: a comparison of %d members", n);
    struct study_table table;
    const enum status status = study_table_create(&table, 2 + n_rows, N_COLUMNS);
    if (status == STATUS_OK) {
        fill_head(&table);
        for (int m = STUDY_COMPARISON_N_REFERENCES, row = 2; m < n; m++) {
            if (first_of(study, m) != m) continue;
            fill_row(&table, row++, study, members, m, median_wall_time(study, members, m, buffer));
        }
        print_reference(study, members, stream);
        study_table_print(&table, stream);
        study_table_free(&table);
        print_reasons(study, members, stream);
    }
    free(buffer);
    return status;
}
