/* compare.c: the sweep of a comparison, the errors against its reference, the table, and the cost at equal error. */
#include "study/compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/methods.h"
#include "base/table.h"
#include "case/case.h"
#include "case/case_table.h"
#include "case/sweep.h"
#include "fish/fish_school.h"
#include "run/simulate.h"
#include "study/study_folder.h"

enum { BY_METHOD, BY_ORDER, BY_RTOL, BY_STEP, N_KEYS };
static const char *const keys[N_KEYS] = {"solver.method", "solver.order", "solver.rtol", "solver.step"};

enum { MAX_REPEATS = 99, WORD_BYTES = 32, NAME_BYTES = 128 };

static const char standard_rtols[] = "1e-3,1e-4,1e-5,1e-6,1e-7";

bool compare_is(const struct case_values *study) {
    if (study->n_axes != 1 || study->sweep[0].n_keys != N_KEYS) return false;
    for (int k = 0; k < N_KEYS; k++) {
        if (strcmp(study->sweep[0].key[k].path, keys[k]) != 0) return false;
    }
    return study->sweep[0].n_values > COMPARE_N_REFERENCES;
}

// ---- the sweep

/* Take the next word of a list; false at the end. */
static bool list_next_word(const char **list, char word[WORD_BYTES]) {
    if (**list == '\0') return false;
    const size_t length = strcspn(*list, ",");
    snprintf(word, WORD_BYTES, "%.*s", (int)(length < WORD_BYTES ? length : WORD_BYTES - 1), *list);
    *list += length + ((*list)[length] == ',');
    return true;
}

void compare_words(struct text *text) {
    text_add(text, "ida (with solver.order), ida1 to ida%d (with this highest order)", methods_table[METHOD_IDA].order);
    for (int i = 0; i < methods_n; i++) {
        if (i != METHOD_IDA && methods_table[i].has_adaptive_steps) text_add(text, ", %s", methods_table[i].word);
    }
    const char *before = "; with --steps also";
    for (int i = 0; i < methods_n; i++) {
        if (methods_table[i].has_adaptive_steps) continue;
        text_add(text, "%s %s", before, methods_table[i].word);
        before = ",";
    }
}

/* Add one member: a value for each of the four keys. */
static void sweep_add_member(struct text *sweep, int method, int order, const char *rtol, const char *step) {
    const bool is_first = sweep->text && sweep->text[sweep->length - 1] == '[';
    text_add(sweep, "%s[%s, %d, %s, %s]", is_first ? "" : ", ", methods_table[method].word, order, rtol, step);
}

/* Add a method with each tolerance or step. rtol: tolerance of members with fixed steps. */
static enum status sweep_add_method(struct text *sweep, const char *word, const struct compare_options *options,
                                    const char *rtol, int ida_order) {
    // find the row in the table of methods, and the order: "ida2" is ida of order 2, "ida" has the order of the case
    const struct method_properties *const ida = &methods_table[METHOD_IDA];
    const size_t n = strlen(ida->word);
    int method = -1, order = 0;
    if (strncmp(word, ida->word, n) == 0 && strlen(word) <= n + 1) {
        order = word[n] == '\0' ? ida_order : word[n] - '0';
        method = order >= 1 && order <= ida->order ? METHOD_IDA : -1;
    }
    for (int i = 0; i < methods_n && method < 0; i++) {
        if (i == METHOD_IDA || strcmp(methods_table[i].word, word) != 0) continue;
        order = methods_table[i].order;
        method = i;
    }
    if (method < 0) {
        struct text known = {.arena = sweep->arena};
        compare_words(&known);
        return status_fail(STATUS_CASE, "--methods: '%s' is unknown: choose from %s", word, known.text);
    }

    const bool by_step = options->steps && method != METHOD_IDA;
    if (!by_step && !methods_table[method].has_adaptive_steps) {
        return status_fail(STATUS_CASE,
                           "--methods: %s takes fixed steps only: give them with --steps, or omit the method", word);
    }

    const char *list = by_step ? options->steps : options->rtols ? options->rtols : standard_rtols;
    char value[WORD_BYTES];
    while (list_next_word(&list, value)) {
        double number;
        if (!text_number(value, &number)) {
            return status_fail(STATUS_CASE, "%s: '%s' is not a number", by_step ? "--steps" : "--rtol", value);
        }
        const struct bounds *const bounds = &case_table_row("solver.rtol")->bounds;
        if (by_step && !(number >= 0)) {
            return status_fail(STATUS_CASE, "--steps %s: solver.step must be at least 0", value);
        }
        if (!by_step && !(number >= bounds->min && number <= bounds->max)) {
            return status_fail(STATUS_CASE, "--rtol %s: solver.rtol must be from %g to %g", value, bounds->min,
                               bounds->max);
        }
        sweep_add_member(sweep, method, order, by_step ? rtol : value, by_step ? value : "0");
    }

    return STATUS_OK;
}

enum status compare_create(struct arena *arena, struct case_values **study, const struct case_values *values,
                           const struct compare_options *options) {
    if (options->repeats < 1 || options->repeats > MAX_REPEATS) {
        return status_fail(STATUS_CASE, "--repeats: expects 1 to %d", MAX_REPEATS);
    }

    TRY(sweep_refuse(values));
    struct school *school;
    TRY(fish_school_create(arena, &school, &values->school));
    const int ida_order = simulate_order(arena, values, school);
    struct text sweep = {.arena = arena}, rtol = {.arena = arena}, end = {.arena = arena}, standard = {.arena = arena};
    text_add_number(&rtol, values->solver.rtol);
    text_add_number(&end, values->time.end);

    // all methods with adaptive steps
    text_add(&standard, "ida,ida2,ida%d", methods_table[METHOD_IDA].order);
    for (int i = 0; i < methods_n; i++) {
        if (i != METHOD_IDA && methods_table[i].has_adaptive_steps) text_add(&standard, ",%s", methods_table[i].word);
    }

    // the reference, and a second reference with ten times the tolerance
    text_add(&sweep, "sweep=[{keys: [solver.method, solver.order, solver.rtol, solver.step], values: [");
    for (int i = 0; i < COMPARE_N_REFERENCES; i++) {
        struct text number = {.arena = arena};
        text_add_number(&number, text_round((i == 0 ? 1 : 10) * options->reference_rtol));
        sweep_add_member(&sweep, METHOD_IDA, methods_table[METHOD_IDA].order, number.text, "0");
    }

    for (int repeat = 0; repeat < options->repeats; repeat++) {
        char word[WORD_BYTES];
        const char *methods = options->methods ? options->methods : standard.text;
        while (list_next_word(&methods, word)) {
            TRY(sweep_add_method(&sweep, word, options, rtol.text, ida_order));
        }
    }
    text_add(&sweep, "]}]");

    const char *const assignments[] = {sweep.text, arena_text(arena, "time.output_interval=%s", end.text),
                                       arena_text(arena, "output.wake_interval=%s", end.text)};
    TRY(study_folder_parse(arena, study, values->merged, values->name, 3, assignments));
    if (compare_is(*study)) return STATUS_OK;
    return status_fail(STATUS_CASE, "nothing to compare: --methods, --rtol and --steps are lists");
}

// ---- errors, and the cost to the end

static void set_number(const struct member_file *member, const char *quantity, double value) {
    *member_file_place(member, member_file_quantity_number(quantity), 0, 0) = value;
}

/* Set what a member costs until the end. If it exceeded the time limit, extrapolate from what it has reached. */
static void fill_cost(const struct case_values *study, const struct member_file *member) {
    static const char *const reached[] = {
        "time", "steps", "residual_evaluations", "newton_iterations", "jacobian_evaluations", "wall_time"};
    enum { N_REACHED = sizeof reached / sizeof *reached };
    double value[N_REACHED], factor = NAN;
    const char *next = member->progress ? member->progress : "";
    int n = 0;
    for (char *end; n < N_REACHED; n++, next = end) {
        value[n] = strtod(next, &end);
        if (end == next) break;
    }
    for (int i = 0; n == N_REACHED && i < N_REACHED; i++) set_number(member, reached[i], value[0] > 0 ? value[i] : NAN);
    if (n == N_REACHED && value[0] > 0) factor = study->time.end / value[0];
    if (member_file_is_complete(member)) factor = 1;
    set_number(member, "evaluations_to_end", factor * member_file_number(member, "residual_evaluations", 0));
    set_number(member, "wall_time_to_end", factor * member_file_number(member, "wall_time", 0));
}

/* The factor from what a member has reached to the end: 1 for a complete one; NaN: unknown. */
static double factor_to_end(const struct member_file *member) {
    return member_file_number(member, "evaluations_to_end", 0) / member_file_number(member, "residual_evaluations", 0);
}

void compare_fill(const struct case_values *study, const struct member_file *members) {
    static const char *const points[] = {"nose", "tail"}, *const errors[] = {"nose_error", "tail_error"};
    if (!compare_is(study)) return;
    const int power = member_file_quantity_number("power_error");
    const struct member_file *const reference = &members[0];
    for (int m = 0; m < sweep_n_members(study); m++) {
        const struct member_file *const member = &members[m];
        if (member->n_fish > 0) fill_cost(study, member);
        const bool are_known = member_file_is_complete(member) && member_file_is_complete(reference);
        for (int f = 0; f < member->n_fish; f++) {
            // the distance of nose and tail from the reference, in body lengths
            for (int p = 0; p < 2; p++) {
                const int q = member_file_quantity_number(points[p]), error = member_file_quantity_number(errors[p]);
                const double x = member_file_value(member, q, f, 0) - member_file_value(reference, q, f, 0);
                const double y = member_file_value(member, q, f, 1) - member_file_value(reference, q, f, 1);
                const double distance = hypot(x, y) / study->school.fish[f].length;
                *member_file_place(member, error, f, 0) = are_known ? distance : NAN;
            }

            // the work of the muscle, or without a muscle the mean power into the water
            const bool has_muscle = fabs(member_file_number(reference, "actuation_work", f)) > 0;
            const char *const name = has_muscle ? "actuation_work" : "mean_power";
            const double work = member_file_number(reference, name, f);
            *member_file_place(member, power, f, 0) =
                are_known && fabs(work) > 0 ? fabs(member_file_number(member, name, f) / work - 1) : NAN;
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

/* The first of the repeats of member m, which have the same settings. */
static int first_repeat(const struct case_values *study, int m) {
    for (int first = COMPARE_N_REFERENCES; first < m; first++) {
        bool is_same = true;
        for (int k = 0; k < N_KEYS; k++) is_same &= strcmp(set_to(study, m, k), set_to(study, first, k)) == 0;
        if (is_same) return first;
    }
    return m;
}

static int compare_numbers(const void *a, const void *b) {
    const double *const one = a, *const other = b;
    return (*one > *other) - (*one < *other);
}

/* Wall time of a setting, s: median and half range of the complete repeats; NaN: too few complete repeats. */
struct wall_time {
    double median, spread;
};

/* m: the first of its repeats; buffer: (members) */
static struct wall_time wall_time_of(const struct case_values *study, const struct member_file *members, int m,
                                     double *buffer) {
    int n = 0;
    for (int i = m; i < sweep_n_members(study); i++) {
        if (first_repeat(study, i) != m || !member_file_is_complete(&members[i])) continue;
        buffer[n++] = member_file_number(&members[i], "wall_time", 0);
    }
    if (n == 0) return (struct wall_time){NAN, NAN};
    qsort(buffer, (size_t)n, sizeof *buffer, compare_numbers);
    return (struct wall_time){(buffer[(n - 1) / 2] + buffer[n / 2]) / 2, n > 1 ? (buffer[n - 1] - buffer[0]) / 2 : NAN};
}

// ---- names

/* "ida2" for ida of order 2, otherwise the word of the method. */
static void name_method(const struct case_values *study, int m, char name[NAME_BYTES]) {
    const char *const word = set_to(study, m, BY_METHOD);
    snprintf(name, NAME_BYTES, "%s%s", word, strcmp(word, "ida") == 0 ? set_to(study, m, BY_ORDER) : "");
}

static bool has_step(const struct case_values *study, int m) {
    double step;
    return text_number(set_to(study, m, BY_STEP), &step) && step > 0;
}

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

static int compare_errors(const void *a, const void *b) {
    const struct point *const one = a, *const other = b;
    return (one->error > other->error) - (one->error < other->error);
}

/* The complete settings of the method of member m, by increasing error; none if an earlier member has the method. */
static int collect_points(const struct case_values *study, const struct member_file *members, int m, double *buffer,
                          struct point *point) {
    int n = 0;
    for (int i = COMPARE_N_REFERENCES; i < sweep_n_members(study); i++) {
        const bool is_same = strcmp(set_to(study, i, BY_METHOD), set_to(study, m, BY_METHOD)) == 0 &&
                             strcmp(set_to(study, i, BY_ORDER), set_to(study, m, BY_ORDER)) == 0 &&
                             has_step(study, i) == has_step(study, m);
        if (is_same && i < m) return 0;
        if (!is_same || first_repeat(study, i) != i || !member_file_is_complete(&members[i])) continue;
        point[n] =
            (struct point){i, error_of(study, &members[i]), member_file_number(&members[i], "residual_evaluations", 0),
                           wall_time_of(study, members, i, buffer)};
        n += point[n].error > 0;
    }
    qsort(point, (size_t)n, sizeof *point, compare_errors);
    return n;
}

/* The cost at an error, by a power law between two settings, with an error bar from the error of the reference (unsure)
 * and the spread of the costs. */
static struct cost cost_at(const struct point *fine, const struct point *coarse, double error, double unsure,
                           double of_fine, double of_coarse, double spread) {
    const double errors[] = {error, fmax(error - unsure, fine->error), error + unsure};
    double cost[3];
    for (int i = 0; i < 3; i++) {
        const double part = log(errors[i] / fine->error) / log(coarse->error / fine->error);
        cost[i] = of_fine * pow(of_coarse / of_fine, fmin(1, fmax(0, part)));
    }
    const double bar = fmax(fabs(cost[1] - cost[0]), fabs(cost[2] - cost[0]));
    return (struct cost){cost[0], bar + (isnan(spread) ? 0 : spread)};
}

static void name_setting(const struct case_values *study, int m, char text[NAME_BYTES]) {
    const int key = has_step(study, m) ? BY_STEP : BY_RTOL;
    snprintf(text, NAME_BYTES, "%s %s", key == BY_STEP ? "step" : "rtol", set_to(study, m, key));
}

/* Fill the row of a method: the cost at an error, by a power law between two settings. */
static void cost_row(struct table *table, const struct case_values *study, int n, const struct point *point,
                     double error, double unsure) {
    char name[NAME_BYTES], fine[NAME_BYTES], coarse[NAME_BYTES];
    name_method(study, point[0].member, name);
    table_cell(table, "%s", name);

    // the last setting with an error below the common one, which the first setting reaches
    int i = n - 1;
    while (i > 0 && point[i].error > error) i--;

    // if the errors of all settings are below, the cheapest setting gives an upper bound
    const bool is_bound = i == n - 1;
    int least = is_bound ? 0 : i;
    for (int k = 1; k < n && is_bound; k++) least = point[k].evaluations <= point[least].evaluations ? k : least;
    const struct point *const a = &point[least], *const b = is_bound ? a : a + 1;
    name_setting(study, a->member, fine);
    name_setting(study, b->member, coarse);
    const struct cost evaluations =
        is_bound ? (struct cost){a->evaluations, 0} : cost_at(a, b, error, unsure, a->evaluations, b->evaluations, 0);
    const double spread = fmax(a->wall_time.spread, b->wall_time.spread);  // fmax ignores NaN
    const struct cost wall = is_bound ? (struct cost){a->wall_time.median, a->wall_time.spread}
                                      : cost_at(a, b, error, unsure, a->wall_time.median, b->wall_time.median, spread);
    table_number(table, "%.0f", evaluations.value);
    table_number(table, "%.0f", evaluations.bar);
    table_number(table, "%.3f", wall.value);
    table_number(table, "%.3f", wall.bar);
    if (is_bound) {
        table_cell(table, "at most: error %.1e with %s", a->error, fine);
    } else {
        table_cell(table, "between %s and %s", fine, coarse);
    }
    table_row(table);
}

/* Print the cost of each method at a common error. buffer: (members) */
static void print_costs(struct arena *arena, const struct case_values *study, const struct member_file *members,
                        double *buffer, FILE *stream) {
    static const char *const heads[] = {"method", "evaluat.", "+-", "wall, s", "+-", "settings"};
    const int n = sweep_n_members(study);
    struct table *const table = table_create(arena, 0);
    struct point *point;
    NEW(arena, point, n);

    // the smallest power of ten that all methods reach, at least ten times the error of the reference
    const double unsure = error_of(study, &members[1]);
    double worst = 10 * unsure;
    for (int m = COMPARE_N_REFERENCES; m < n; m++) {
        const int n_points = collect_points(study, members, m, buffer, point);
        if (n_points > 0) worst = fmax(worst, point[0].error);
    }
    const double error = pow(10, ceil(log10(worst) - 1e-9));

    int n_methods = 0;
    for (int c = 0; c < 6; c++) table_column(table, heads[c], NULL);
    for (int m = COMPARE_N_REFERENCES; m < n; m++) {
        const int n_points = collect_points(study, members, m, buffer, point);
        if (n_points == 0) continue;
        cost_row(table, study, n_points, point, error, unsure);
        n_methods++;
    }

    if (n_methods == 0 || !isfinite(error)) return;
    fprintf(stream, "Cost at an error of %.0e in nose, tail (lengths) and power (part), known to %.1e:\n", error,
            unsure);
    table_print(table, stream);
}

// ---- the table

void compare_print(struct arena *arena, const struct case_values *study, const struct member_file *members,
                   FILE *stream) {
    static const char *const heads[][2] = {{"method", ""},      {"rtol", ""},      {"step", "s"},  {"nose", "lengths"},
                                           {"tail", "lengths"}, {"power", "part"}, {"wall", "s"},  {"+-", "s"},
                                           {"steps", ""},       {"evaluat.", ""},  {"Newton", ""}, {"Jacobians", ""},
                                           {"us/eval.", ""},    {"status", ""}};
    static const char *const errors[] = {"nose_error", "tail_error", "power_error"};
    static const char *const counts[] = {"steps", "residual_evaluations", "newton_iterations", "jacobian_evaluations"};
    const int n = sweep_n_members(study);
    double *buffer;
    NEW(arena, buffer, n);

    // one sentence on the reference
    char method[NAME_BYTES], other[NAME_BYTES];
    name_method(study, 0, method);
    name_method(study, 1, other);
    fprintf(stream, "Reference: %s, rtol %s; difference of %s, rtol %s: %.1e (nose) and %.1e (tail) lengths", method,
            set_to(study, 0, BY_RTOL), other, set_to(study, 1, BY_RTOL),
            largest_error(study, &members[1], "nose_error"), largest_error(study, &members[1], "tail_error"));
    const double power = largest_error(study, &members[1], "power_error");
    if (!isnan(power)) fprintf(stream, ", relative difference of the power %.1e", power);
    fprintf(stream, ".\n");

    // a row for each setting
    struct table *const table = table_create(arena, 0);
    bool is_extrapolated = false;
    for (size_t c = 0; c < sizeof heads / sizeof *heads; c++) table_column(table, heads[c][0], heads[c][1]);
    for (int m = COMPARE_N_REFERENCES; m < n; m++) {
        if (first_repeat(study, m) != m) continue;
        const struct member_file *const member = &members[m];
        const struct wall_time wall_time = wall_time_of(study, members, m, buffer);
        name_method(study, m, method);
        table_cell(table, "%s", method);
        table_cell(table, "%s", has_step(study, m) ? "-" : set_to(study, m, BY_RTOL));
        table_cell(table, "%s", has_step(study, m) ? set_to(study, m, BY_STEP) : "-");
        for (int e = 0; e < 3; e++) table_number(table, "%.1e", largest_error(study, member, errors[e]));
        const double factor = factor_to_end(member), wall = member_file_number(member, "wall_time_to_end", 0);
        if (isfinite(factor) && !member_file_is_complete(member)) {
            table_cell(table, "~%.3g", wall);
            table_cell(table, "-");
            for (int c = 0; c < 4; c++) {
                const double count = factor * member_file_number(member, counts[c], 0);
                table_cell(table, count > 0 ? "~%.3g" : "%.0f", count);
            }
            table_number(table, "%.1f", 1e6 * wall / (factor * member_file_number(member, counts[1], 0)));
            is_extrapolated = true;
        } else {
            table_number(table, "%.3f", wall_time.median);
            table_number(table, "%.3f", wall_time.spread);
            for (int c = 0; c < 4; c++) table_number(table, "%.0f", member_file_number(member, counts[c], 0));
            table_number(table, "%.1f", 1e6 * wall_time.median / member_file_number(member, counts[1], 0));
        }
        table_cell(table, "%.*s", (int)strcspn(member->status, ":"), member->status);
        table_row(table);
    }
    table_print(table, stream);
    if (is_extrapolated) {
        fprintf(stream, "~: extrapolated to the end, t = %.4g s, from what was done within --limit.\n",
                study->time.end);
    }
    print_costs(arena, study, members, buffer, stream);

    // "failed: reason": the reasons follow the tables
    for (int m = 0; m < n; m++) {
        if (!strchr(members[m].status, ':')) continue;
        if (m >= COMPARE_N_REFERENCES && first_repeat(study, m) != m) continue;
        char setting[NAME_BYTES];
        name_method(study, m, method);
        name_setting(study, m, setting);
        fprintf(stream, "%s, %s %s", method, setting, members[m].status);
        if (isfinite(factor_to_end(&members[m]))) {
            fprintf(stream, ", %.0f steps and %.0f evaluations", member_file_number(&members[m], counts[0], 0),
                    member_file_number(&members[m], counts[1], 0));
        }
        fprintf(stream, "\n");
    }
}
