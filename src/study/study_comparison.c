/* study_comparison.c: errors against the reference, the table of a comparison, and the cost at equal error. */
#include "study/study_comparison.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "case/sweep.h"
#include "study/study_print.h"

enum { METHOD, ORDER, RTOL, STEP, N_KEYS };
static const char *const keys[N_KEYS] = {"solver.method", "solver.order", "solver.rtol", "solver.step"};

int study_comparison_is(const struct case_values *study) {
    if (study->n_axes != 1 || study->sweep[0].n_keys != N_KEYS) return 0;
    for (int k = 0; k < N_KEYS; k++) {
        if (strcmp(study->sweep[0].key[k].path, keys[k]) != 0) return 0;
    }
    return study->sweep[0].n_values > STUDY_COMPARISON_N_REFERENCES;
}

// ---- errors

/* The distance of a point of a fish from the same point in the reference, in body lengths. */
static double point_error(const struct case_values *study, const struct member_file *members, int m, const char *point,
                          int f) {
    const int q = member_file_quantity_number(point);
    const double x = member_file_value(&members[m], q, f, 0) - member_file_value(&members[0], q, f, 0);
    const double y = member_file_value(&members[m], q, f, 1) - member_file_value(&members[0], q, f, 1);
    return hypot(x, y) / study->school.fish[f].length;
}

void study_comparison_fill_errors(const struct case_values *study, const struct member_file *members) {
    if (!study_comparison_is(study)) return;
    const int nose = member_file_quantity_number("nose_error"), tail = member_file_quantity_number("tail_error"),
              power = member_file_quantity_number("power_error");
    for (int m = 0; m < sweep_n_members(study); m++) {
        const int are_known = member_file_is_complete(&members[m]) && member_file_is_complete(&members[0]);
        for (int f = 0; f < members[m].n_fish; f++) {
            *member_file_place(&members[m], nose, f, 0) = are_known ? point_error(study, members, m, "nose", f) : NAN;
            *member_file_place(&members[m], tail, f, 0) = are_known ? point_error(study, members, m, "tail", f) : NAN;

            // the work of the muscle, or without a muscle the mean power into the water
            const int has_muscle = fabs(member_file_number(&members[0], "actuation_work", f)) > 0;
            const char *const name = has_muscle ? "actuation_work" : "mean_power";
            const double reference = member_file_number(&members[0], name, f);
            *member_file_place(&members[m], power, f, 0) =
                are_known && fabs(reference) > 0 ? fabs(member_file_number(&members[m], name, f) / reference - 1) : NAN;
        }
    }
}

/* The largest error over the fish. */
static double largest_error(const struct case_values *study, const struct member_file *member, const char *error) {
    double max = NAN;
    for (int f = 0; f < study->school.n_fish; f++) {
        max = fmax(max, member_file_number(member, error, f));
    }
    return max;
}

// ---- repeats

/* The value of a key in member m. */
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
static int first_repeat(const struct case_values *study, int m) {
    int first = STUDY_COMPARISON_N_REFERENCES;
    while (!are_repeats(study, m, first)) first++;
    return first;
}

static int compare_numbers(const void *a, const void *b) {
    const double *const one = a, *const other = b;
    return (*one > *other) - (*one < *other);
}

/* Wall time of a setting, s: median and half range of the complete repeats; NaN: too few complete repeats. */
struct wall_time {
    double median, spread;
};

/* buffer: (members) */
static struct wall_time wall_time_of(const struct case_values *study, const struct member_file *members, int m,
                                     double *buffer) {
    int n = 0;
    for (int i = m; i < sweep_n_members(study); i++) {
        if (!are_repeats(study, i, m) || !member_file_is_complete(&members[i])) continue;
        buffer[n++] = member_file_number(&members[i], "wall_time", 0);
    }
    if (n == 0) return (struct wall_time){NAN, NAN};
    qsort(buffer, (size_t)n, sizeof *buffer, compare_numbers);
    return (struct wall_time){(buffer[(n - 1) / 2] + buffer[n / 2]) / 2, n > 1 ? (buffer[n - 1] - buffer[0]) / 2 : NAN};
}

// ---- names

/* "ida2" for ida of order 2, otherwise the word of the method. */
static void name_method(const struct case_values *study, int m, char name[TEXT_CELL_BYTES]) {
    const char *const word = set_to(study, m, METHOD);
    snprintf(name, TEXT_CELL_BYTES, "%s%s", word, strcmp(word, "ida") == 0 ? set_to(study, m, ORDER) : "");
}

static int has_step(const struct case_values *study, int m) {
    double step;
    return text_number(set_to(study, m, STEP), &step) && step > 0;
}

/* The counts and the columns of the table. */
static const struct count {
    const char *quantity, *head;
} counts[] = {
    {"steps", "steps"},
    {"residual_evaluations", "evaluat."},
    {"newton_iterations", "Newton"},
    {"jacobian_evaluations", "Jacobians"},
};
enum { N_COUNTS = sizeof counts / sizeof *counts, N_BEFORE = 8, N_COLUMNS = N_BEFORE + N_COUNTS + 2 };

// ---- the cost at equal error

/* A setting in the plane of error and cost. */
struct point {
    int member;
    double error, evaluations;
    struct wall_time wall_time;
};

/* A cost at the common error, with an error bar. */
struct cost {
    double value, bar;
};

/* The largest error of a member: nose, tail and power. */
static double error_of(const struct case_values *study, const struct member_file *member) {
    return fmax(largest_error(study, member, "nose_error"),
                fmax(largest_error(study, member, "tail_error"), largest_error(study, member, "power_error")));
}

static int is_same_method(const struct case_values *study, int m, int other) {
    return strcmp(set_to(study, m, METHOD), set_to(study, other, METHOD)) == 0 &&
           strcmp(set_to(study, m, ORDER), set_to(study, other, ORDER)) == 0 &&
           has_step(study, m) == has_step(study, other);
}

static int is_first_of_method(const struct case_values *study, int m) {
    for (int i = STUDY_COMPARISON_N_REFERENCES; i < m; i++) {
        if (is_same_method(study, i, m)) return 0;
    }
    return 1;
}

static int compare_errors(const void *a, const void *b) {
    const struct point *const one = a, *const other = b;
    return (one->error > other->error) - (one->error < other->error);
}

/* The complete settings of the method of member m, by increasing error. */
static int collect_points(const struct case_values *study, const struct member_file *members, int m, double *buffer,
                          struct point *point) {
    int n = 0;
    for (int i = m; i < sweep_n_members(study); i++) {
        if (!is_same_method(study, i, m) || first_repeat(study, i) != i || !member_file_is_complete(&members[i]))
            continue;
        point[n] =
            (struct point){i, error_of(study, &members[i]), member_file_number(&members[i], "residual_evaluations", 0),
                           wall_time_of(study, members, i, buffer)};
        n += point[n].error > 0;
    }
    qsort(point, (size_t)n, sizeof *point, compare_errors);
    return n;
}

/* The cost at an error, by a power law between two settings. */
static double interpolate_cost(const struct point *fine, const struct point *coarse, double error, double of_fine,
                               double of_coarse) {
    const double part = log(error / fine->error) / log(coarse->error / fine->error);
    return of_fine * pow(of_coarse / of_fine, fmin(1, fmax(0, part)));
}

/* The cost at an error, with an error bar from the error of the reference (unsure) and the spread of the costs. */
static struct cost cost_at(const struct point *fine, const struct point *coarse, double error, double unsure,
                           double of_fine, double of_coarse, double spread) {
    const double value = interpolate_cost(fine, coarse, error, of_fine, of_coarse);
    const double dearer = interpolate_cost(fine, coarse, fmax(error - unsure, fine->error), of_fine, of_coarse);
    const double cheaper = interpolate_cost(fine, coarse, error + unsure, of_fine, of_coarse);
    return (struct cost){value, fmax(fabs(dearer - value), fabs(cheaper - value)) + (isnan(spread) ? 0 : spread)};
}

/* The smallest power of ten that all methods reach, at least ten times the error of the reference. */
static double common_error(const struct case_values *study, const struct member_file *members, double *buffer,
                           struct point *point) {
    double worst = 10 * error_of(study, &members[1]);
    for (int m = STUDY_COMPARISON_N_REFERENCES; m < sweep_n_members(study); m++) {
        const int n = is_first_of_method(study, m) ? collect_points(study, members, m, buffer, point) : 0;
        if (n > 0) worst = fmax(worst, point[0].error);
    }
    return pow(10, ceil(log10(worst) - 1e-9));
}

static void name_setting(const struct case_values *study, int m, char text[TEXT_CELL_BYTES]) {
    const int key = has_step(study, m) ? STEP : RTOL;
    snprintf(text, TEXT_CELL_BYTES, "%s %s", key == STEP ? "step" : "rtol", set_to(study, m, key));
}

static void fill_cost(const struct text_table *table, int row, const struct case_values *study, int n,
                      const struct point *point, double error, double unsure) {
    char name[TEXT_CELL_BYTES], fine[TEXT_CELL_BYTES], coarse[TEXT_CELL_BYTES];
    name_method(study, point[0].member, name);
    text_table_set(table, row, 0, "%s", name);

    // the last setting with an error below the common one
    int i = n - 1;
    while (i >= 0 && point[i].error > error) i--;
    if (i < 0) {
        name_setting(study, point[0].member, fine);
        text_table_set(table, row, 5, "not reached: error %.1e with %s", point[0].error, fine);
        return;
    }

    // if the errors of all settings are below, the cheapest setting gives an upper bound
    const int is_bound = i == n - 1;
    int least = is_bound ? 0 : i;
    for (int k = 1; k < n && is_bound; k++) least = point[k].evaluations <= point[least].evaluations ? k : least;
    const struct point *const a = &point[least], *const b = is_bound ? a : a + 1;
    name_setting(study, a->member, fine);
    const struct cost evaluations =
        is_bound ? (struct cost){a->evaluations, 0} : cost_at(a, b, error, unsure, a->evaluations, b->evaluations, 0);
    const double spread = fmax(a->wall_time.spread, b->wall_time.spread);  // fmax ignores NaN
    const struct cost wall = is_bound ? (struct cost){a->wall_time.median, a->wall_time.spread}
                                      : cost_at(a, b, error, unsure, a->wall_time.median, b->wall_time.median, spread);
    text_table_number(table, row, 1, "%.0f", evaluations.value);
    text_table_number(table, row, 2, "%.0f", evaluations.bar);
    text_table_number(table, row, 3, "%.3f", wall.value);
    text_table_number(table, row, 4, "%.3f", wall.bar);
    if (is_bound) {
        text_table_set(table, row, 5, "at most: error %.1e with %s", a->error, fine);
    } else {
        name_setting(study, b->member, coarse);
        text_table_set(table, row, 5, "between %s and %s", fine, coarse);
    }
}

/* Print the cost of each method at a common error, by power laws between the settings. buffer: (members) */
static enum status print_costs(struct arena *arena, const struct case_values *study, const struct member_file *members,
                               double *buffer, FILE *stream) {
    const int n = sweep_n_members(study);
    struct text_table table;
    struct point *point;
    NEW(arena, point, n);
    TRY(text_table_create(&table, 1 + n, 6));

    const double error = common_error(study, members, buffer, point), unsure = error_of(study, &members[1]);
    const char *const heads[] = {"method", "evaluat.", "+-", "wall, s", "+-", "settings"};
    for (int c = 0; c < 6; c++) text_table_set(&table, 0, c, "%s", heads[c]);
    int row = 1;
    for (int m = STUDY_COMPARISON_N_REFERENCES; m < n; m++) {
        const int n_points = is_first_of_method(study, m) ? collect_points(study, members, m, buffer, point) : 0;
        if (n_points > 0) fill_cost(&table, row++, study, n_points, point, error, unsure);
    }

    table.n_rows = row;
    if (row > 1 && isfinite(error)) {
        fprintf(stream, "Cost at an error of %.0e in nose, tail (lengths) and power (part), known to %.1e:\n", error,
                unsure);
        text_table_print(&table, stream);
    }

    text_table_free(&table);
    return STATUS_OK;
}

// ---- the table

/* Fill the row of a setting, whose first member is m. */
static void fill_setting(const struct text_table *table, int row, const struct case_values *study,
                         const struct member_file *members, int m, double *buffer) {
    const struct member_file *const member = &members[m];
    const struct wall_time wall_time = wall_time_of(study, members, m, buffer);
    char method[TEXT_CELL_BYTES];
    name_method(study, m, method);
    text_table_set(table, row, 0, "%s", method);
    text_table_set(table, row, 1, "%s", has_step(study, m) ? "-" : set_to(study, m, RTOL));
    text_table_set(table, row, 2, "%s", has_step(study, m) ? set_to(study, m, STEP) : "-");
    text_table_number(table, row, 3, "%.1e", largest_error(study, member, "nose_error"));
    text_table_number(table, row, 4, "%.1e", largest_error(study, member, "tail_error"));
    text_table_number(table, row, 5, "%.1e", largest_error(study, member, "power_error"));
    text_table_number(table, row, 6, "%.3f", wall_time.median);
    text_table_number(table, row, 7, "%.3f", wall_time.spread);

    for (int c = 0; c < N_COUNTS; c++) {
        text_table_number(table, row, N_BEFORE + c, "%.0f", member_file_number(member, counts[c].quantity, 0));
    }

    text_table_number(table, row, N_COLUMNS - 2, "%.1f",
                      1e6 * wall_time.median / member_file_number(member, "residual_evaluations", 0));

    // "failed: reason": the reasons follow the table
    text_table_set(table, row, N_COLUMNS - 1, "%.*s", (int)strcspn(member->status, ":"), member->status);
}

enum status study_comparison_print(struct arena *arena, const struct case_values *study,
                                   const struct member_file *members, FILE *stream) {
    static const char *const heads[N_BEFORE][2] = {{"method", ""},      {"rtol", ""},        {"step", "s"},
                                                   {"nose", "lengths"}, {"tail", "lengths"}, {"power", "part"},
                                                   {"wall", "s"},       {"+-", "s"}};
    const int n = sweep_n_members(study);
    struct text_table table;
    double *buffer;
    int n_rows = 0;
    NEW(arena, buffer, n);
    for (int m = STUDY_COMPARISON_N_REFERENCES; m < n; m++) n_rows += first_repeat(study, m) == m;
    TRY(text_table_create(&table, 2 + n_rows, N_COLUMNS));

    // one sentence on the reference
    char method[TEXT_CELL_BYTES], other[TEXT_CELL_BYTES];
    name_method(study, 0, method);
    name_method(study, 1, other);
    fprintf(stream, "Reference: %s, rtol %s; difference of %s, rtol %s: %.1e (nose) and %.1e (tail) lengths", method,
            set_to(study, 0, RTOL), other, set_to(study, 1, RTOL), largest_error(study, &members[1], "nose_error"),
            largest_error(study, &members[1], "tail_error"));
    const double power = largest_error(study, &members[1], "power_error");
    if (!isnan(power)) fprintf(stream, ", relative difference of the power %.1e", power);
    fprintf(stream, ".\n");

    for (int c = 0; c < N_BEFORE; c++) {
        for (int row = 0; row < 2; row++) text_table_set(&table, row, c, "%s", heads[c][row]);
    }
    for (int c = 0; c < N_COUNTS; c++) text_table_set(&table, 0, N_BEFORE + c, "%s", counts[c].head);
    text_table_set(&table, 0, N_COLUMNS - 2, "us/eval.");
    text_table_set(&table, 0, N_COLUMNS - 1, "status");
    for (int m = STUDY_COMPARISON_N_REFERENCES, row = 2; m < n; m++) {
        if (first_repeat(study, m) == m) fill_setting(&table, row++, study, members, m, buffer);
    }
    text_table_print(&table, stream);
    text_table_free(&table);

    const enum status status = print_costs(arena, study, members, buffer, stream);
    for (int m = 0; m < n; m++) {
        if (!strchr(members[m].status, ':')) continue;
        if (m >= STUDY_COMPARISON_N_REFERENCES && first_repeat(study, m) != m) continue;
        char setting[TEXT_CELL_BYTES];
        name_method(study, m, method);
        name_setting(study, m, setting);
        fprintf(stream, "%s, %s %s\n", method, setting, members[m].status);
    }

    return status;
}
