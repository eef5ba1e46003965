/* study_print.c: see study_print.h. */
#include "study/study_print.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/table.h"
#include "base/text.h"
#include "case/case.h"
#include "case/case_table.h"
#include "case/sweep.h"
#include "case/sweep_expect.h"
#include "case/sweep_quantity.h"
#include "result/durable.h"
#include "result/result_row.h"
#include "result/target.h"
#include "run/estimate.h"
#include "run/simulate.h"
#include "study/study_folder.h"

// ---- lines about several members

/* Whether two lines differ at most in numbers: of two warnings, their kind and the fish agree. */
static bool lines_agree(const char *a, int n, const char *b, int m) {
    static const char digits[] = "0123456789.";
    const char *const end_a = a + n, *const end_b = b + m;
    while (a < end_a && b < end_b) {
        const bool is_number = *a >= '0' && *a <= '9' && *b >= '0' && *b <= '9';
        if (!is_number && *a != *b) return false;
        a += is_number ? (long)strspn(a, digits) : 1;
        b += is_number ? (long)strspn(b, digits) : 1;
        // exponents: 4e+03 and 27
        if (is_number && a < end_a && *a == 'e') a += 1 + strspn(a + 1, "+-0123456789");
        if (is_number && b < end_b && *b == 'e') b += 1 + strspn(b + 1, "+-0123456789");
    }
    return a >= end_a && b >= end_b;
}

/* A line about several members. */
struct line_group {
    const char *line; /* of the first member, without the line break */
    int length, n;
    bool differs; /* the numbers of another member are others */
    int *member;  /* ascending                                         (n) */
};

struct line_groups {
    struct arena *arena;
    int n;
    struct line_group *group; /* (n) */
};

/* Add a line about a member, without the line break, to the group of its kind, or to a new group. */
static void group_line(struct line_groups *groups, const char *line, int length, int member) {
    int g = 0;
    while (g < groups->n && !lines_agree(groups->group[g].line, groups->group[g].length, line, length)) g++;
    if (g == groups->n) {
        GROW(groups->arena, groups->group, ++groups->n);
        groups->group[g] = (struct line_group){.line = line, .length = length};
    }
    struct line_group *const group = &groups->group[g];
    group->differs |= length != group->length || memcmp(group->line, line, (size_t)length) != 0;
    GROW(groups->arena, group->member, group->n + 1);
    group->member[group->n++] = member;
}

/* Print "members 0-2, 5", or with the number "4 members (0-2, 5)", the word, and the line of the first member. */
static void print_line(const struct line_group *group, bool with_number, const char *word, FILE *stream) {
    const bool has_number = with_number && group->n > 1;
    if (has_number) fprintf(stream, "%d ", group->n);
    fprintf(stream, "member%s %s", group->n > 1 ? "s" : "", has_number ? "(" : "");
    for (int i = 0, first = 0; i < group->n; i++) {
        if (i + 1 < group->n && group->member[i + 1] <= group->member[i] + 1) continue;
        fprintf(stream, "%s%d", first > 0 ? ", " : "", group->member[first]);
        if (group->member[i] > group->member[first]) fprintf(stream, "-%d", group->member[i]);
        first = i + 1;
    }
    fprintf(stream, "%s%s%.*s", has_number ? ")" : "", word, group->length, group->line);
    if (group->differs) fprintf(stream, " (numbers of member %d)", group->member[0]);
    fprintf(stream, "\n");
}

/* Print the members that have failed, and with all every member that is not complete: a failure that repeats once, with
 * the number of its members. */
static void print_failures(struct arena *arena, const struct member_file *members, int n, bool all, FILE *stream) {
    struct line_groups groups = {.arena = arena};
    for (int m = 0; m < n; m++) {
        const char *const status = members[m].status;
        const bool is_shown = all ? !member_file_is_complete(&members[m]) : strchr(status, ':') != NULL;
        if (is_shown) group_line(&groups, status, (int)strlen(status), m);
    }
    for (int g = 0; g < groups.n; g++) print_line(&groups.group[g], true, all ? ": " : " ", stream);
}

// ---- members

enum { MAX_FISH_SHOWN = 4, MAX_WARNINGS_SHOWN = 20 };

/* The printed quantities. A quantity of steady states needs a member with a value, a quantity of held bodies a held
 * body. study.nc contains all quantities. */
static const struct shown {
    const char *quantity, *head, *format;
    int of_held;
    bool has_ratio; /* says something over the value of another member */
} shown[] = {
    {"time", "t", "%.4g", 0, false},
    {"speed", "speed", "%.5f", 0, true},
    {"mean_heading", "heading", "%.3f", 0, false},
    {"cost_of_transport", "cost", "%.4g", 0, true},
    {"strouhal", "Strouhal", "%.4f", 0, true},
    {"mean_thrust", "thrust", "%.5g", 1, true},
    {"mean_power", "power", "%.5g", 1, true},
    {"efficiency", "efficiency", "%.5f", 1, true},
    {"steady_growth", "growth", "%+.4f", 0, false},
    {"lateral_drift", "drift", "%.5f", 0, false},
    {"shed_circulation", "shed", "%.5f", 0, true},
    {"energy_balance", "balance", "%.1e", 0, false},
    {"steps", "steps", "%.0f", 0, false},
    {"residual_evaluations", "evaluations", "%.0f", 0, true},
    {"wall_time", "wall", "%.2f", 0, true},
};
enum { N_SHOWN = sizeof shown / sizeof *shown };

/* The last word of a path. */
static const char *last_word(const char *path) {
    const char *const dot = strrchr(path, '.');
    return dot ? dot + 1 : path;
}

/* Add the columns of the first n_keys swept keys of an axis: "modulus" for fish[*].body.modulus, "[1]phase" for
 * fish[1].wave.phase, and "wake.smoothing" if another key of the study ends in the same word. */
static void add_key_columns(struct table *table, const struct case_values *study, const struct sweep_axis *axis,
                            int n_keys) {
    for (const struct sweep_key *key = axis->key; key < axis->key + n_keys; key++) {
        const char *const path = key->path;
        const bool is_of_fish = strncmp(path, "fish[", 5) == 0, is_one = is_of_fish && path[5] != '*';
        bool is_shared = false;
        for (int a = 0; a < study->n_axes; a++) {
            const struct sweep_axis *const other = &study->sweep[a];
            for (int k = 0; k < (other == axis ? n_keys : other->n_keys); k++) {
                const bool is_same_word = strcmp(last_word(other->key[k].path), last_word(path)) == 0;
                is_shared |= is_same_word && strcmp(other->key[k].row, key->row) != 0;
            }
        }
        const char *const all = is_of_fish && strchr(path, '.') ? strchr(path, '.') + 1 : path;
        char head[128];
        snprintf(head, sizeof head, "%.*s%s", is_one ? (int)strcspn(path + 4, ".") : 0, is_one ? path + 4 : "",
                 is_shared ? all : last_word(path));
        table_column(table, head, key->unit);
    }
}

/* Whether the study sweeps keys of other fish than the first one, so that one asks what the first fish changes at them.
 * */
static bool is_of_followers(const struct case_values *study) {
    for (int a = 0; a < study->n_axes; a++) {
        for (int k = 0; k < study->sweep[a].n_keys; k++) {
            const char *const path = study->sweep[a].key[k].path;
            if (strncmp(path, "fish[", 5) == 0 && path[5] != '*' && path[5] != '0') return true;
        }
    }
    return false;
}

/* Add the columns of the member, of the swept keys and, of a school, of the fish. */
static void add_member_columns(struct table *table, const struct case_values *study) {
    table_column(table, "member", "");
    for (int a = 0; a < study->n_axes; a++) {
        add_key_columns(table, study, &study->sweep[a], study->sweep[a].n_keys);
    }
    if (study->school.n_fish > 1) table_column(table, "fish", NULL);
}

static void add_member_cells(struct table *table, const struct case_values *study, int m, int f) {
    table_cell(table, "%d", m);
    for (int a = 0; a < study->n_axes; a++) {
        const struct sweep_axis *const axis = &study->sweep[a];
        const int value = sweep_member_value(study, m, a);
        for (int k = 0; k < axis->n_keys; k++) table_cell(table, "%s", axis->value[value * axis->n_keys + k]);
    }
    if (study->school.n_fish > 1) table_cell(table, "%s", study->school.fish[f].name);
}

/* Print the values of the members over those of the members with the value of `relative_to`. quantity: the numbers of
 * the shown quantities, -1: not shown                                                                      (N_SHOWN) */
static void print_ratios(struct arena *arena, const struct case_values *study, const struct member_file *members,
                         int n_fish, const int *quantity, FILE *stream) {
    const struct sweep_axis *axis = study->sweep;
    while (!axis->is_relative) axis++;
    fprintf(stream, "\nOver the values at");
    for (int k = 0; k < axis->n_keys; k++) {
        fprintf(stream, "%s %s %s", k > 0 ? "," : "", last_word(axis->key[k].path),
                axis->value[axis->relative_to * axis->n_keys + k]);
    }
    fprintf(stream, ":\n");

    struct table *const table = table_create(arena, 0);
    add_member_columns(table, study);
    for (int s = 0; s < N_SHOWN; s++) {
        if (quantity[s] >= 0 && shown[s].has_ratio) table_column(table, shown[s].head, "");
    }
    for (int m = 0; m < sweep_n_members(study); m++) {
        for (int f = 0; f < n_fish; f++) {
            add_member_cells(table, study, m, f);
            for (int s = 0; s < N_SHOWN; s++) {
                if (quantity[s] < 0 || !shown[s].has_ratio) continue;
                const int of = member_file_quantity(quantity[s])->of_fish ? f : 0;
                table_number(table, "%.5f",
                             member_file_ratio(members, m, sweep_member_reference(study, m), quantity[s], of));
            }
            table_row(table);
        }
    }
    table_print(table, stream);
}

void study_print(struct arena *arena, const struct case_values *study, const struct member_file *members,
                 FILE *stream) {
    const int n = sweep_n_members(study),
              n_fish = study->school.n_fish < MAX_FISH_SHOWN ? study->school.n_fish : MAX_FISH_SHOWN;
    struct table *const table = table_create(arena, 0);
    add_member_columns(table, study);

    // the printed quantities: thrust and power only beside a held body, values of steady states if a member has one
    bool has_held = false;
    for (int f = 0; f < study->school.n_fish; f++) {
        const struct motion_parameters *const motion = &study->school.fish[f].motion;
        has_held |= motion->prescribed != PRESCRIBED_NONE && motion->surge == SURGE_GIVEN;
    }
    int quantity[N_SHOWN];
    for (int s = 0; s < N_SHOWN; s++) {
        quantity[s] = member_file_quantity_number(shown[s].quantity);
        const struct member_file_quantity *const row = member_file_quantity(quantity[s]);
        bool is_known = !row->of_steady;
        for (int m = 0; m < n && !is_known; m++) is_known = !isnan(member_file_value(&members[m], quantity[s], 0, 0));
        if (!is_known || (shown[s].of_held && !has_held)) quantity[s] = -1;
        if (quantity[s] >= 0) table_column(table, shown[s].head, strcmp(row->unit, "1") == 0 ? "" : row->unit);
    }

    // print the power of followers, that of the muscle or of the held body, over that of the first fish; and beside
    // this ratio the change, because a ratio looks mild where the power of a single fish is too large
    const bool has_ratio = is_of_followers(study);
    const int power = member_file_quantity_number("mean_power");
    if (has_ratio) {
        table_column(table, "power ratio", "");
        table_column(table, "change", "W");
    }

    // a row for each fish of each member
    table_column(table, "status", NULL);
    for (int m = 0; m < n; m++) {
        for (int f = 0; f < n_fish; f++) {
            add_member_cells(table, study, m, f);
            for (int s = 0; s < N_SHOWN; s++) {
                if (quantity[s] < 0) continue;
                const int of = member_file_quantity(quantity[s])->of_fish ? f : 0;
                table_number(table, shown[s].format, member_file_value(&members[m], quantity[s], of, 0));
            }
            if (has_ratio) {
                const double first = member_file_value(&members[m], power, 0, 0),
                             own = f > 0 ? member_file_value(&members[m], power, f, 0) : NAN;
                table_number(table, "%.4f", own / first);
                table_number(table, "%+.4g", own - first);
            }
            // "failed: reason": the reasons follow the table
            table_cell(table, "%.*s", (int)strcspn(members[m].status, ":"), members[m].status);
            table_row(table);
        }
    }

    table_print(table, stream);
    if (n_fish < study->school.n_fish) {
        fprintf(stream, "The first %d of %d fish; study.nc has all.\n", n_fish, study->school.n_fish);
    }
    print_failures(arena, members, n, false, stream);
    if (sweep_member_reference(study, 0) >= 0) print_ratios(arena, study, members, n_fish, quantity, stream);
}

// ---- warnings

int study_print_warnings(struct arena *arena, const struct member_file *members, int n, FILE *stream) {
    struct line_groups groups = {.arena = arena};
    int n_warnings = 0;
    for (int m = 0; m < n; m++) {
        int length;
        for (const char *line = members[m].warnings; line && *line; line += length + (line[length] == '\n')) {
            length = (int)strcspn(line, "\n");
            n_warnings++;
            group_line(&groups, line, length, m);
        }
    }
    for (int g = 0; g < groups.n && g < MAX_WARNINGS_SHOWN; g++)
        print_line(&groups.group[g], false, ": warning: ", stream);
    if (groups.n > MAX_WARNINGS_SHOWN)
        fprintf(stream, "The first %d of %d kinds of warnings; study.nc has all.\n", MAX_WARNINGS_SHOWN, groups.n);
    return n_warnings;
}

// ---- expectations

/* Test the bounds of an expectation on one quantity. */
static bool test_quantity(const struct case_values *study, const struct member_file *members, int number, int q,
                          FILE *stream) {
    const struct sweep_expectation *const one = &study->expect[number];
    const struct sweep_quantity *const what = &sweep_quantities[q];
    const int quantity = member_file_quantity_number(what->name);

    // smallest and largest value over the members and fish of the expectation
    double min[2] = {INFINITY, INFINITY}, max[2] = {-INFINITY, -INFINITY};
    int n = 0, missing = -1;
    for (int m = 0; m < sweep_n_members(study); m++) {
        if (!sweep_expects_of(study, one, m)) continue;
        for (int f = 0; f < (what->of_fish ? study->school.n_fish : 1); f++) {
            if (one->fish >= 0 && one->fish != f) continue;
            n++;
            for (int k = 0; k < 1 + what->of_xy; k++) {
                const double value = member_file_value(&members[m], quantity, f, k);
                if (isnan(value) || !member_file_is_complete(&members[m])) missing = m;
                min[k] = fmin(min[k], value);
                max[k] = fmax(max[k], value);
            }
        }
    }

    fprintf(stream, "%s%s%s, %d value%s\n", what->name, one->fish >= 0 ? " of " : "",
            one->fish >= 0 ? study->school.fish[one->fish].name : "", n, n == 1 ? "" : "s");
    if (missing >= 0) {
        fprintf(stream, "  MISSED   member %d %s\n", missing,
                member_file_is_complete(&members[missing]) ? "has no such value" : "is not complete");
        return false;
    }

    // a scalar has no second direction; the ratio is infinite if the signs differ or a value is 0
    const double width = max[0] - min[0], height = what->of_xy ? max[1] - min[1] : 0;
    const double ratio = min[0] > 0 ? max[0] / min[0] : max[0] < 0 ? min[0] / max[0] : INFINITY;

    const struct {
        const char *what, *word;
        double value, bound;
    } tests[] = {{"the smallest is", "least", min[0], one->min},
                 {"the largest is", "most", max[0], one->max},
                 {"the spread is", "most", hypot(width, height), one->spread},
                 {"the ratio is", "most", ratio, one->ratio}};
    bool are_met = true;
    for (int t = 0; t < 4; t++) {
        const double value = tests[t].value, bound = tests[t].bound;
        if (isinf(bound)) continue;
        const bool is_met = t == 0 ? value >= bound : value <= bound;
        fprintf(stream, "  %-8s %s %.9g, expected at %s %.9g\n", is_met ? "met" : "MISSED", tests[t].what, value,
                tests[t].word, bound);
        are_met &= is_met;
    }
    return are_met;
}

enum status study_expect(const struct case_values *study, const struct member_file *members, FILE *stream) {
    int n_missed = 0, first = 0;
    const char *first_what = "";
    if (study->n_expectations > 0) fprintf(stream, "\nExpected:\n");

    for (int i = 0; i < study->n_expectations; i++) {
        // test all quantities, and keep the first that is missed
        const struct sweep_expectation *const one = &study->expect[i];
        const char *what = NULL;

        // all members of an expectation of failures have failed with the expected message
        int n_failures = 0, wrong = -1;
        for (int m = 0; m < sweep_n_members(study) && one->fails; m++) {
            if (!sweep_expects_of(study, one, m)) continue;
            n_failures++;
            if (!member_file_has_failed(&members[m], one->fails)) wrong = m;
        }
        if (one->fails) fprintf(stream, "failures, %d member%s\n", n_failures, n_failures == 1 ? "" : "s");
        if (one->fails && wrong < 0) {
            fprintf(stream, "  met      failed with '%s'\n", one->fails);
        } else if (one->fails) {
            fprintf(stream, "  MISSED   member %d has not failed with '%s'\n", wrong, one->fails);
            what = "failures";
        }

        for (int q = 0; q < SWEEP_N_QUANTITIES && !one->fails; q++) {
            if (!(one->of >> q & 1) || test_quantity(study, members, i, q, stream) || what) continue;
            what = sweep_quantities[q].name;
        }
        if (!what || n_missed++ > 0) continue;
        first = i;
        first_what = what;
    }

    if (n_missed == 0) return STATUS_OK;
    return status_fail(STATUS_MISSED, "expect[%d]: %s: expectation not met%s: see the output", first, first_what,
                       n_missed > 1 ? ", and others" : "");
}

// ---- orders along a refined axis

/* Print errors and orders of one group: members that differ in the refined axis only. */
static void print_group(struct arena *arena, const struct case_values *study, const struct convergence_orders *orders,
                        int group, FILE *stream) {
    static const char *const heads[] = {"coarse order", "order", "extrapolated", "", "error", "by"};
    const struct sweep_axis *const axis = &study->sweep[orders->axis];
    const int n = orders->n_levels;

    // the values of the axis over the columns of errors
    struct table *const table = table_create(arena, 0);
    table_column(table, "difference of", NULL);
    table_column(table, "fish", NULL);
    table_column(table, "unit", NULL);
    for (int i = 0; i < n; i++) table_column(table, axis->value[orders->level[i] * axis->n_keys], NULL);
    for (int i = 0; i < 6; i++) table_column(table, heads[i], NULL);

    // a row for each quantity of each fish
    for (int q = 0; q < SWEEP_N_ORDERS; q++) {
        for (int f = 0; f < orders->n_fish; f++) {
            const int place = convergence_place(orders, group, q, f);
            const struct convergence_row *const row = &orders->row[place];
            const struct sweep_quantity *const quantity = &sweep_quantities[q];
            const bool is_given = !isnan(sweep_reference(study, orders->axis, q, f, 0));
            if (!row->is_known) continue;
            table_cell(table, "%s%s", quantity->name, is_given ? "*" : "");
            table_cell(table, "%s", study->school.fish[f].name);
            table_cell(table, "%s", member_file_quantity(member_file_quantity_number(quantity->name))->unit);
            for (int i = 0; i < n; i++) table_number(table, "%.2e", orders->error[place * n + i]);
            table_number(table, "%.2f", row->result.coarse_order);
            table_number(table, "%.2f", row->result.order);
            table_number(table, "%.9g", row->limit[0]);
            if (quantity->of_xy) table_number(table, "%.9g", row->limit[1]);
            if (!quantity->of_xy) table_cell(table, "%s", "");
            table_number(table, "%.1e", row->result.error);
            table_cell(table, "%s",
                       is_given                                      ? "reference"
                       : row->result.verdict == CONVERGENCE_NONE     ? "noise"
                       : convergence_is_flagged(row->result.verdict) ? "flagged"
                       : orders->n_judged < CONVERGENCE_LEVELS       ? "3 levels"
                                                                     : "4 levels");
            table_row(table);
        }
    }
    table_print(table, stream);

    // one line for each kind of flag with the flagged quantities; the table states their orders
    for (int verdict = CONVERGENCE_OBJECTION; verdict <= CONVERGENCE_UNKNOWN; verdict++) {
        int n_flagged = 0;
        for (int i = 0; i < SWEEP_N_ORDERS * orders->n_fish; i++) {
            const struct convergence_row *const row =
                &orders->row[convergence_place(orders, group, i / orders->n_fish, i % orders->n_fish)];
            if (!row->is_known || (int)row->result.verdict != verdict || !*row->flag) continue;
            if (n_flagged == 0) {
                fprintf(stream, "warning: %s: ", convergence_words((enum convergence_verdict)verdict));
            }
            fprintf(stream, "%s%s of %s", n_flagged++ > 0 ? ", " : "", sweep_quantities[i / orders->n_fish].name,
                    study->school.fish[i % orders->n_fish].name);
        }
        if (n_flagged > 0) fprintf(stream, "\n");
    }
}

enum status study_print_orders(struct arena *arena, const struct case_values *study,
                               const struct convergence_orders *orders, FILE *stream) {
    enum status status = STATUS_OK;
    for (int g = 0; g < orders->n_groups; g++) {
        const struct sweep_axis *const axis = &study->sweep[orders->axis];
        const char *const text = sweep_member_text(arena, study, orders->first[g]);
        fprintf(stream, "\nRefinement of ");
        for (int k = 0; k < axis->n_keys; k++) fprintf(stream, "%s%s", k > 0 ? " with " : "", axis->key[k].path);
        if (study->n_axes > 1) fprintf(stream, ", from member %d (%s) on", orders->first[g], text);
        fprintf(stream,
                ": differences from the finest level%s; observed order of the next coarser and of the\n"
                "finest levels, Richardson's extrapolation, and the error of the finest level (doc/studies.md)\n",
                axis->reference ? " (*: from the reference of the case)" : "");
        print_group(arena, study, orders, g, stream);

        // the expected order of all quantities
        for (int q = 0; q < SWEEP_N_ORDERS; q++) {
            if (!(axis->order_of >> q & 1) || !(axis->order > 0)) continue;
            for (int f = 0; f < orders->n_fish; f++) {
                const double order = orders->row[convergence_place(orders, g, q, f)].result.order;
                const char *const fish = study->school.fish[f].name, *const quantity = sweep_quantities[q].name;
                const bool is_met = fabs(order - axis->order) <= axis->within;
                fprintf(stream, "%s: order of %s of %s is %.2f, expected %g +- %g\n", is_met ? "met" : "MISSED",
                        quantity, fish, order, axis->order, axis->within);
                if (is_met || status != STATUS_OK) continue;
                status = status_fail(STATUS_MISSED, "%s of %s: observed order %.2f in %s, expected %g +- %g", quantity,
                                     fish, order, axis->key[0].path, axis->order, axis->within);
            }
        }
    }

    return status;
}

// ---- the plan of an error study

enum { OF_QUANTITY = 4 /* columns */, LEVEL_BYTES = 160 };

/* Beats of a search from the initial state of a case, from the state of a neighbour, and for the multipliers of a fish;
 * wall time of the events simulated for an estimate, s. */
static const double beats_from_start = 14, beats_from_neighbour = 11, beats_of_multipliers = 32, patience = 2;

static const struct member_file_quantity *quantity_of(const struct error_study *study, int q) {
    return member_file_quantity(study->quantity[q]);
}

/* The name of a quantity without "steady_", or of a comparison of it: "ratio of speed". */
static const char *short_name_of(const struct error_study *study, int q) {
    const char *const whole = quantity_of(study, q)->name, *const name =
                                                               whole + (strncmp(whole, "steady_", 7) == 0 ? 7 : 0);
    if (study->relation == ERROR_VALUE) return name;
    return arena_text(study->sweep->arena, "%s of %s", error_relation_words[study->relation], name);
}

/* The unit of a value; "": none. */
static const char *unit_of(const struct error_study *study, int q) {
    const char *const unit = quantity_of(study, q)->unit;
    return study->relation == ERROR_RATIO || strcmp(unit, "1") == 0 ? "" : unit;
}

/* The value of a level: "17", or a word. */
static const char *level_text(const struct error_study *study, const struct error_study_key *key, int level) {
    const struct key *const row = case_table_row(key->row->path);
    return row->type == CHOICE ? row->words[(int)key->value[level]]
                               : arena_text(study->sweep->arena, "%.4g", key->value[level]);
}

/* "13 17 [25] 35", from coarse to fine; the stated value in brackets. */
static void write_levels(const struct error_study *study, const struct error_study_key *key, char text[LEVEL_BYTES]) {
    int length = 0;
    *text = '\0';
    for (int i = key->n_levels - 1; i >= 0 && length < LEVEL_BYTES - 1; i--) {
        const bool is_stated = i == key->stated;
        length += snprintf(text + length, (size_t)(LEVEL_BYTES - length), "%s%s%s%s", length > 0 ? " " : "",
                           is_stated ? "[" : "", level_text(study, key, i), is_stated ? "]" : "");
    }
    if (length < LEVEL_BYTES) snprintf(text + length, (size_t)(LEVEL_BYTES - length), "%s", key->unit);
}

/* The estimated CPU time of a member, s; NaN if the estimate fails. On one thread: a process that is forked after
 * OpenMP has started threads, as the members are, would wait for them forever. */
static enum status estimate_member(const struct error_sweep *sweep, int m, double seconds, double *duration) {
    struct arena *const scratch = arena_create(sweep->arena, "the estimate of a member");
    const struct error_study *const first = &sweep->point[0];
    struct case_values *values;
    struct simulation *simulation;
    struct estimate estimate;
    TRY(study_folder_case(scratch, &values, &sweep->study, m));
    values->school.threads = 1;
    enum status status = simulate_start(scratch, &simulation, values, NULL);
    if (status == STATUS_OK && first->is_steady && first->beat > 0) {
        const bool has_before = sweep_member_before(&sweep->study, m) >= 0;
        double beats = has_before ? beats_from_neighbour : beats_from_start;
        if (m < sweep->n_points && values->steady.multipliers != NO) beats += beats_of_multipliers * first->n_fish;
        const struct school *const school = simulation->school;
        simulation->n_events = lround(beats * fish_first_beating(school)->period / school->interval);
    }
    if (status == STATUS_OK) status = estimate_run(simulation, seconds, &estimate);
    *duration = status == STATUS_OK ? estimate.seconds : NAN;
    arena_free(scratch);
    return status == STATUS_SOLVER ? STATUS_OK : status;
}

enum status study_print_plan(const struct error_sweep *sweep, int n_processes, const struct study_options *options,
                             FILE *stream) {
    const int n = sweep_n_members(&sweep->study);
    double sum = 0, longest = 0, *duration;
    int *like;
    NEW(sweep->arena, duration, n);
    NEW(sweep->arena, like, n);
    const int n_estimated = error_plan_choose_estimated(sweep, like);
    struct study_watch watch = {.options = options, .what = "estimated", .n = n_estimated};
    // the time of an equilibrium is negligible
    for (int m = 0, i = 0; m < n && !sweep->point[0].is_static; m++) {
        if (like[m] != m) continue;
        TRY(estimate_member(sweep, m, patience / n_estimated, &duration[m]));
        TRY(study_folder_watch(&watch, ++i));
    }
    for (int m = 0; m < n; m++) {
        duration[m] = duration[like[m]];
        sum += duration[m];
        longest = fmax(longest, duration[m]);
    }

    struct table *const table = table_create(sweep->arena, 3);
    if (sweep->n_points > 1) table_column(table, "point", NULL);
    table_column(table, "key", NULL);
    table_column(table, "levels", NULL);
    table_column(table, "members", NULL);
    table_column(table, "time of each, s", NULL);
    for (int p = 0; p < sweep->n_points; p++) {
        for (int k = 0; k < sweep->point[p].n_keys; k++) {
            const struct error_study_key *const key = &sweep->point[p].key[k];
            char levels[LEVEL_BYTES];
            struct text members = {.arena = sweep->arena}, times = {.arena = sweep->arena};
            write_levels(&sweep->point[p], key, levels);
            for (int i = key->n_levels - 1; i >= 0 && key->n_levels > 1; i--) {
                text_add(&members, "%s%d", members.length > 0 ? " " : "", key->member[i]);
                text_add(&times, "%s%.2g", times.length > 0 ? " " : "", duration[key->member[i]]);
            }
            if (sweep->n_points > 1) table_cell(table, "%d", p);
            table_cell(table, "%s", sweep_error_name(key->row));
            table_cell(table, "%s", levels);
            table_cell(table, "%s", members.text ? members.text : "not varied");
            table_cell(table, "%s", times.text ? times.text : "");
            table_row(table);
        }
        const int finest = sweep->point[p].finest;
        if (finest < 0) continue;
        if (sweep->n_points > 1) table_cell(table, "%d", p);
        table_cell(table, "%s", "together");
        table_cell(table, "%s", "the finest");
        table_cell(table, "%d", finest);
        table_cell(table, "%.2g", duration[finest]);
        table_row(table);
    }
    table_print(table, stream);

    const double least = 0.05, shown_least = 0.1, wall = fmax(longest, sum / n_processes);
    char all[TEXT_DURATION_BYTES], simultaneous[TEXT_DURATION_BYTES];
    text_duration(all, sum > least ? sum : shown_least);
    text_duration(simultaneous, wall > least ? wall : shown_least);
    fprintf(stream,
            "%d members, [the case] among them; about %s of CPU time, %s with %d at once: estimated from a few events, "
            "often within a factor of two\n",
            n, all, simultaneous, n_processes);
    const struct sweep_error *const error = sweep->study.error;
    if (error->within > 0) {
        fprintf(stream,
                "then refined until the errors are below %.3g %% of the values, up to %g times the time of the "
                "case\n",
                100 * error->within, error->most);
    }

    return STATUS_OK;
}

// ---- values and errors

/* The number of decimals for two significant digits. */
static int decimals_for(double number) {
    if (!(fabs(number) > 0) || !isfinite(number)) return 5;
    const int decimals = 1 - (int)floor(log10(fabs(number)));
    return decimals < 0 ? 0 : decimals > 12 ? 12 : decimals;
}

/* Whether a numerical key belongs to the error but has no other level. */
static bool is_missing(const struct error_study_key *key) {
    return key->row->kind != SWEEP_MODEL && key->n_levels == 1;
}

/* "0.9364 +- 0.0019 m s-1 (0.2 %), without nodes" */
static void print_value(const struct error_study *study, int q, int f, FILE *stream) {
    const int place = error_plan_place(study, q, f);
    const double value = study->value[place], error = study->error[place];
    const char *const unit = unit_of(study, q), *const blank = *unit ? " " : "";
    const bool is_ratio = study->relation == ERROR_RATIO;

    // "steady_speed of follower over that of alone"
    if (study->relation == ERROR_CHANGE) fprintf(stream, "difference");
    if (study->relation != ERROR_CHANGE) fprintf(stream, "%s", quantity_of(study, q)->name);
    const bool is_named = study->relation != ERROR_CHANGE && quantity_of(study, q)->of_fish;
    const bool is_only = study->is_against && study->n_fish == 1;
    if (is_named) fprintf(stream, " of %s", is_only ? study->values->name : study->values->school.fish[f].name);
    if (study->is_against && !(is_named && is_only)) fprintf(stream, " in %s", study->values->name);
    if (is_ratio) fprintf(stream, " over that of %s", error_plan_twin_name(study, f));
    if (isnan(value)) {
        fprintf(stream, ": unknown\n");
    } else if (study->study->error->sensitivity) {
        fprintf(stream, ": %.5g%s%s\n", value, blank, unit);
    } else if (isnan(error)) {
        fprintf(stream, ": %.5g%s%s, error unknown\n", value, blank, unit);
    } else {
        const int decimals = decimals_for(error);
        fprintf(stream, ": %.*f +- %.*f%s%s", decimals, value, decimals, error, blank, unit);
        const int of_percent = decimals_for(100 * error);
        if (is_ratio) {
            fprintf(stream, " (%+.*f +- %.*f %%)", of_percent, 100 * (value - 1), of_percent, 100 * error);
        } else if (study->relation == ERROR_VALUE && fabs(value) > 0) {
            fprintf(stream, " (%.2g %%)", 100 * error / fabs(value));
        }
        if (study->relation == ERROR_VALUE && strcmp(quantity_of(study, q)->name, "steady_multiplier") == 0) {
            fprintf(stream, ": %s", steady_verdict(value - 1, error));
        }

        // numerical keys that could not be varied: ", without nodes, lifetime"
        int n_missing = 0;
        for (int k = 0; k < study->n_keys; k++) {
            if (!is_missing(&study->key[k])) continue;
            fprintf(stream, "%s %s", n_missing++ > 0 ? "," : ", without", strrchr(study->key[k].row->path, '.') + 1);
        }
        fprintf(stream, "\n");
    }

    // "other models: from 0.7754 (drag.transition 0) to 0.936 m s-1 (force reactive)"
    const struct error_study_model *const models[] = {&study->lowest[place], &study->highest[place]};
    if (isnan(value) || !study->study->error->models) return;
    for (int i = 0; i < 2; i++) {
        fprintf(stream, "%s ", i == 0 ? "other models: from" : " to");
        if (is_ratio) {
            fprintf(stream, "%+.2g %%", 100 * (models[i]->value - 1));
        } else {
            fprintf(stream, "%.4g%s%s", models[i]->value, blank, unit);
        }
        if (models[i]->key < 0) continue;
        const struct error_study_key *const key = &study->key[models[i]->key];
        const char *const path =
            sweep_error_name(key->row) + (strncmp(sweep_error_name(key->row), "fish.", 5) == 0 ? 5 : 0);
        fprintf(stream, " (%s %s)", path, level_text(study, key, models[i]->level));
    }
    fprintf(stream, "\n");
}

void study_print_reason(const struct error_study *study, const struct error_study_key *key, int place,
                        char text[CONVERGENCE_BYTES]) {
    double size[ERROR_STUDY_LEVELS];
    const struct convergence_levels levels = convergence_study_levels(study, key, size);
    convergence_reason(&levels, &key->part[place], key->value, text);
}

/* The effect of the next level of the key with the largest share of the largest relative error: cost and predicted
 * error, where known. */
static char *next_words(const struct error_study *study, const struct error_study_next *next) {
    struct arena *const arena = study->sweep->arena;
    if (isnan(next->value)) return arena_text(arena, "<- spend here");

    // times of short runs do not tell a smaller factor from 1
    const double least = 1.05;
    char cost[32] = "", error[64];
    if (next->cost > least) snprintf(cost, sizeof cost, ", CPU x %.2g", next->cost);
    const char *const quantity = short_name_of(study, next->place / study->n_fish);
    snprintf(error, sizeof error, isnan(next->sum) ? ", to find an order of %.40s" : ", %.40s +-%.2g %%", quantity,
             100 * next->sum);
    return arena_text(arena, "<- spend here: %s %.4g%s%s", strrchr(study->key[next->key].row->path, '.') + 1,
                      next->value, cost, error);
}

/* Print two digits of a part of the sum, at most one decimal more than the sum and at most five decimals. */
static void part_cell(struct table *table, double part, double sum) {
    const int most = decimals_for(sum) < 4 ? 5 : decimals_for(sum) + 1, own = decimals_for(part);
    table_cell(table, isnan(part) ? "unknown" : "%.*f", own < most ? own : most, part);
}

/* Print the row of the sum, or of a part of the sum; f: fish */
static void sum_row(struct table *table, const struct error_study *study, const char *head, const double *value,
                    int f) {
    table_cell(table, "%s", head);
    table_cell(table, "%s", "");
    for (int q = 0; q < study->n_asked; q++) {
        const int place = error_plan_place(study, q, f);
        const bool is_shown = error_plan_has_value(study, q, f);
        for (int c = 0; c < OF_QUANTITY; c++) {
            if (is_shown && c == 0) {
                part_cell(table, value[place], study->error[place]);
            } else if (is_shown && c == 2) {
                table_number(table, "%.2f", 100 * value[place] / fabs(study->value[place]));
            } else {
                table_cell(table, "%s", "");
            }
        }
    }
    table_row(table);
}

/* Print the share of each key for one fish. */
static void print_shares(const struct error_study *study, const struct error_study_next *next, int f, FILE *stream) {
    int n_moved = 0;
    struct table *const table = table_create(study->sweep->arena, 2);
    table_column(table, "key", NULL);
    table_column(table, "levels", NULL);
    for (int q = 0; q < study->n_asked; q++) {
        const char *const heads[OF_QUANTITY] = {short_name_of(study, q), "order", "%", "share"};
        for (int c = 0; c < OF_QUANTITY; c++) table_column(table, heads[c], NULL);
    }
    table_column(table, "by", NULL);
    table_column(table, "next", NULL);

    for (int k = 0; k < study->n_keys; k++) {
        const struct error_study_key *const key = &study->key[k];
        n_moved += key->stated != key->first_stated;
        if (key->row->kind == SWEEP_MODEL) continue;
        char levels[LEVEL_BYTES];
        write_levels(study, key, levels);
        if (key->slope) {
            snprintf(levels, LEVEL_BYTES, "%.4g +- %.3g %%", key->value[key->stated], 100 * key->uncertainty);
        }
        table_cell(table, "%s", sweep_error_name(key->row));
        table_cell(table, "%s", levels);
        for (int q = 0; q < study->n_asked; q++) {
            const int place = error_plan_place(study, q, f);
            const struct convergence_result *const part = &key->part[place];
            const bool is_said = error_plan_has_value(study, q, f);
            if (key->n_levels == 1 || !is_said) {
                for (int c = 0; c < OF_QUANTITY; c++) table_cell(table, "%s", is_said && c == 1 ? "not varied" : "");
                continue;
            }
            part_cell(table, part->error, study->error[place]);
            if (key->slope) {
                table_cell(table, "%s", isnan(part->error) ? "unknown" : "input");
            } else if (part->verdict == CONVERGENCE_ACCEPTED) {
                table_cell(table, "%.1f", part->order);
            } else {
                table_cell(table, "%s",
                           part->verdict == CONVERGENCE_NONE      ? "none"
                           : part->verdict == CONVERGENCE_UNKNOWN ? "unknown"
                                                                  : "flagged");
            }
            table_number(table, "%.2f", 100 * part->error / fabs(study->value[place]));
            if (key->slope) {
                table_cell(table, "%s", "");
                continue;
            }
            table_number(table, "%.0f", study->parts[place] > 0 ? 100 * part->error / study->parts[place] : 0);
        }
        table_cell(table, key->n_levels > 1 && !key->slope ? "%d levels" : "", key->n_levels < 4 ? key->n_levels : 4);
        table_cell(table, "%s", k == next->key ? next_words(study, next) : "");
        table_row(table);
    }

    // what signs and independence of the errors take away from their sum
    bool cancel = false, is_noisy = false, has_inputs = false, act_together = n_moved > 1;
    double *cancelled, *numerical;
    NEW(study->sweep->arena, cancelled, study->n_asked * study->n_fish);
    NEW(study->sweep->arena, numerical, study->n_asked * study->n_fish);
    for (int place = 0; place < study->n_asked * study->n_fish; place++) {
        const double noise = study->of_noise[place], together = study->together[place],
                     sum = study->parts[place] + together + study->shared[place] + noise, all = study->error[place],
                     inputs = study->inputs[place], least = 1e-3 * fabs(sum);
        numerical[place] = sqrt(fmax(0, all * all - inputs * inputs));
        cancelled[place] = numerical[place] - sum;
        cancel |= fabs(cancelled[place]) > least;
        is_noisy |= noise > least;
        act_together |= fabs(together) > least;
        has_inputs |= inputs > 0;
    }

    if (act_together) sum_row(table, study, "together", study->together, f);
    if (is_noisy) sum_row(table, study, "noise", study->of_noise, f);
    if (cancel) sum_row(table, study, "cancelled", cancelled, f);
    if (has_inputs) sum_row(table, study, "numerical", numerical, f);
    if (has_inputs) sum_row(table, study, "inputs", study->inputs, f);
    sum_row(table, study, has_inputs ? "sum, in quadrature" : "sum", study->error, f);
    table_print(table, stream);
}

/* The steps of an input: "+-4, 8 %" or, on one side, "-4, 8, 16 %". */
static char *steps_text(const struct error_study *study, const struct error_study_key *key) {
    struct text text = {.arena = study->sweep->arena};
    const bool is_below = key->stated == key->n_levels - 1, is_above = key->stated == 0;
    const int sign = is_below ? -1 : 1;
    for (int i = 1; key->stated + sign * i >= 0 && key->stated + sign * i < key->n_levels; i++) {
        const double step = key->value[key->stated + sign * i] / key->value[key->stated] - 1;
        text_add(&text, "%s%.3g", i > 1 ? ", " : is_below ? "-" : is_above ? "+" : "+-", 100 * fabs(step));
    }
    text_add(&text, " %%");
    return text.text;
}

/* Print the derivatives by all inputs for each fish, those of the first quantity falling in size. */
static void print_sensitivities(const struct error_study *study, FILE *stream) {
    const int n_shown = study->n_fish < MAX_FISH_SHOWN ? study->n_fish : MAX_FISH_SHOWN;
    for (int f = 0; f < n_shown; f++) {
        bool is_any = false;
        for (int q = 0; q < study->n_asked; q++) {
            if (!error_plan_has_value(study, q, f)) continue;
            is_any = true;
            print_value(study, q, f, stream);
        }
        if (!is_any) continue;

        // an insertion sort; an unknown derivative comes last
        int order[ERROR_STUDY_KEYS], n = 0;
        for (int k = 0; k < study->n_keys; k++) {
            if (!study->key[k].slope || study->key[k].n_levels == 1) continue;
            const int place = error_plan_place(study, 0, quantity_of(study, 0)->of_fish ? f : 0);
            const double size = fabs(study->key[k].slope[place].value);
            int i = n++;
            for (; i > 0 && !(fabs(study->key[order[i - 1]].slope[place].value) >= size) && !isnan(size); i--)
                order[i] = order[i - 1];
            order[i] = k;
        }

        struct table *const table = table_create(study->sweep->arena, 1);
        table_column(table, "d ln Q/d ln p", NULL);
        table_column(table, "p", NULL);
        table_column(table, "steps", NULL);
        for (int q = 0; q < study->n_asked; q++) {
            table_column(table, short_name_of(study, q), NULL);
            table_column(table, "error", NULL);
        }
        for (int i = 0; i < n; i++) {
            const struct error_study_key *const key = &study->key[order[i]];
            const char *const unit = case_table_row(key->row->path)->unit;
            table_cell(table, "%s", sweep_error_name(key->row));
            table_cell(table, "%.4g%s%s", key->value[key->stated], *unit ? " " : "", unit);
            table_cell(table, "%s", steps_text(study, key));
            for (int q = 0; q < study->n_asked; q++) {
                const struct convergence_slope slope =
                    key->slope[error_plan_place(study, q, quantity_of(study, q)->of_fish ? f : 0)];
                const int own = decimals_for(slope.error), decimals = own > 6 ? 6 : own;
                table_cell(table, isnan(slope.value) ? "unknown" : "%+.*f", decimals, slope.value);
                table_cell(table, isnan(slope.error) ? "" : "%.*f", decimals, slope.error);
            }
            table_row(table);
        }
        table_print(table, stream);
        fprintf(stream, "\n");
    }
    if (n_shown < study->n_fish) {
        fprintf(stream, "The first %d of %d fish; error.csv and study.nc have all.\n", n_shown, study->n_fish);
    }
}

/* Print the largest change of a requested quantity by each choice of the model. */
static void print_choices(const struct error_study *study, FILE *stream) {
    int n = 0;
    for (int k = 0; k < study->n_keys; k++) {
        const struct error_study_key *const key = &study->key[k];
        if (key->row->kind != SWEEP_MODEL || key->n_levels == 1) continue;
        double most = 0;
        bool is_none = true;
        for (int place = 0; place < study->n_asked * study->n_fish; place++) {
            most = fmax(most, key->part[place].error / fabs(study->value[place]));
            is_none &= key->part[place].verdict == CONVERGENCE_NONE;
        }
        char levels[LEVEL_BYTES];
        write_levels(study, key, levels);
        fprintf(stream, "%s%s (%s) ", n++ > 0 ? "; " : "choices, not in the sum: ", key->row->path, levels);
        if (is_none) {
            fprintf(stream, "none");
        } else {
            fprintf(stream, "%.2g %%", 100 * most);
        }
    }

    if (n > 0) fprintf(stream, "\n");
}

/* Print the reasons of flags, each with its quantity, of fixed keys, and of failed members. */
static void print_reasons(const struct error_study *study, const struct member_file *members, FILE *stream) {
    for (int k = 0; k < study->n_keys; k++) {
        const struct error_study_key *const key = &study->key[k];
        const bool is_known = study->relation != ERROR_VALUE && study->point->key[k].n_levels == 1;
        if (key->n_levels == 1 && !is_known)
            fprintf(stream, "not varied: %s: %s\n", sweep_error_name(key->row), key->objection);
        if (key->n_levels == 1 || key->row->kind == SWEEP_MODEL) continue;
        if (key->n_left_out > 0) {
            fprintf(stream, "left out: %s %.4g%s: too few for the shedding_interval\n", key->row->path,
                    key->value[key->n_levels - key->n_left_out], key->n_left_out > 1 ? " and coarser" : "");
        }
        for (int place = 0; place < study->n_asked * study->n_fish; place++) {
            const int q = place / study->n_fish, f = place % study->n_fish;
            const struct convergence_result *const part = &key->part[place];
            const bool is_objection = part->verdict == CONVERGENCE_OBJECTION;

            // at least 1 % of the error of the quantity, or an unknown error
            if (!convergence_is_flagged(part->verdict) || part->error < 0.01 * study->error[place]) continue;
            char reason[CONVERGENCE_BYTES];
            study_print_reason(study, key, place, reason);
            fprintf(stream, "flagged: %s: ", key->row->path);
            if (!is_objection) fprintf(stream, "%s", short_name_of(study, q));
            if (!is_objection && quantity_of(study, q)->of_fish)
                fprintf(stream, " of %s", study->study->school.fish[f].name);
            fprintf(stream, "%s%s\n", is_objection ? "" : ": ", reason);
            if (is_objection) break;
        }
    }
    if (study->relation != ERROR_VALUE) return;
    print_failures(study->sweep->arena, members, sweep_n_members(study->study), true, stream);
}

/* Print a row of values and errors for each point of a sweep. */
static void print_points(const struct error_sweep *sweep, const struct member_file *members, FILE *stream) {
    const struct error_study *const first = &sweep->point[0];
    const struct sweep_axis *const axis = &sweep->study.sweep[0];
    const int n_shown = first->n_fish < MAX_FISH_SHOWN ? first->n_fish : MAX_FISH_SHOWN;
    const bool has_models = sweep->study.error->models;
    struct table *const table = table_create(sweep->arena, 0);
    table_column(table, "point", "");
    add_key_columns(table, &sweep->study, axis, sweep->n_swept);
    if (n_shown > 1) table_column(table, "fish", NULL);
    for (int q = 0; q < first->n_asked; q++) {
        table_column(table, short_name_of(first, q), unit_of(first, q));
        table_column(table, "error", NULL);
        table_column(table, "%", NULL);
        if (has_models) table_column(table, "other models", NULL);
    }
    table_column(table, "flagged", NULL);

    for (int p = 0; p < sweep->n_points; p++) {
        const struct error_study *const point = &sweep->point[p];
        for (int f = 0; f < n_shown; f++) {
            table_cell(table, "%d%s", p, point->is_full ? "" : "*");
            for (int c = 0; c < sweep->n_swept; c++) {
                table_cell(table, "%s", axis->value[point->base * axis->n_keys + c]);
            }
            if (n_shown > 1) table_cell(table, "%s", point->values->school.fish[f].name);
            for (int q = 0; q < point->n_asked; q++) {
                const int place = error_plan_place(point, q, quantity_of(point, q)->of_fish ? f : 0);
                const double value = point->value[place], error = point->error[place];
                const int decimals = decimals_for(error);
                if (isnan(value) || isnan(error)) {
                    table_number(table, "%.5g", value);
                } else {
                    table_cell(table, "%.*f", decimals, value);
                }
                table_cell(table, isnan(error) ? "unknown" : "%.*f", decimals, error);
                table_number(table, "%.2g", 100 * error / fabs(value));
                if (!has_models) continue;
                table_cell(table, point->is_full ? "%.4g to %.4g" : "", point->lowest[place].value,
                           point->highest[place].value);
            }

            // the keys with a flag that has a hundredth of the error
            struct text flags = {.arena = sweep->arena};
            for (int k = 0; k < point->n_keys; k++) {
                bool is_flagged = false;
                for (int q = 0; q < point->n_asked; q++) {
                    const int place = error_plan_place(point, q, quantity_of(point, q)->of_fish ? f : 0);
                    const struct convergence_result *const part = &point->key[k].part[place];
                    is_flagged |= point->key[k].n_levels > 1 && point->key[k].row->kind != SWEEP_MODEL &&
                                  convergence_is_flagged(part->verdict) && !(part->error < 0.01 * point->error[place]);
                }
                const char *const name = strrchr(point->key[k].row->path, '.') + 1;
                if (is_flagged) text_add(&flags, "%s%s", flags.length > 0 ? ", " : "", name);
            }
            table_cell(table, "%s", flags.text ? flags.text : "");
            table_row(table);
        }
    }
    table_print(table, stream);
    if (n_shown < first->n_fish) {
        fprintf(stream, "The first %d of %d fish; error.csv and study.nc have all.\n", n_shown, first->n_fish);
    }

    // the notes on a sweep hold for its comparisons, too
    if (first->relation != ERROR_VALUE) return;

    // a numerical key of the sweep has a value at every point, and no levels
    for (int c = 0; c < sweep->n_swept; c++) {
        const struct sweep_error_key *const row = sweep_error_find(axis->key[c].row);
        if (!row || row->kind == SWEEP_MODEL) continue;
        fprintf(stream, "%s is swept: the errors do not include it\n", axis->key[c].path);
    }
    // a numerical key that some points could not vary, with the reason of the first
    for (int i = 0; i < SWEEP_N_ERROR_KEYS; i++) {
        const struct error_study_key *missing = NULL;
        int n_missing = 0, first_missing = 0;
        for (int p = 0; p < sweep->n_points; p++) {
            for (int k = 0; k < sweep->point[p].n_keys; k++) {
                const struct error_study_key *const key = &sweep->point[p].key[k];
                if (key->row != &sweep_error_keys[i] || !is_missing(key)) continue;
                if (n_missing++ > 0) continue;
                missing = key;
                first_missing = p;
            }
        }
        if (!missing) continue;
        fprintf(stream, "the errors of %d point%s, the first is %d, do not include %s: %s\n", n_missing,
                n_missing > 1 ? "s" : "", first_missing, sweep_error_name(missing->row), missing->objection);
    }
    bool are_shared = false;
    for (int p = 0; p < sweep->n_points; p++) are_shared |= !sweep->point[p].is_full;
    if (are_shared) {
        fprintf(stream,
                "*: only nodes and shedding_interval are varied; every other key has the largest relative error of the "
                "other points\n");
    }
    fprintf(stream, "error.csv has the shares of the keys and the reasons of flags\n");
    print_failures(sweep->arena, members, sweep_n_members(&sweep->study), true, stream);
}

/* Print ratios and differences of one point, with the shares of the keys in the ratios. */
static void print_comparison(const struct error_sweep *sweep, const struct member_file *members, FILE *stream) {
    const struct error_study *const ratio = &sweep->ratio->point[0], *const change = &sweep->change->point[0];
    const struct error_study_next none = {.key = -1};
    for (int f = 0; f < ratio->n_fish; f++) {
        bool is_any = false;
        for (int q = 0; q < ratio->n_asked; q++) {
            if (!error_plan_has_value(ratio, q, f)) continue;
            is_any = true;
            print_value(ratio, q, f, stream);
            print_value(change, q, f, stream);
        }
        if (is_any) print_shares(ratio, &none, f, stream);
        if (is_any) fprintf(stream, "\n");
    }
    print_reasons(ratio, members, stream);

    // the value of the other case, without the budget
    const struct error_study *const against = sweep->against;
    for (int i = 0; against && i < against->n_asked * against->n_fish; i++) {
        const int q = i % against->n_asked, f = i / against->n_asked;
        if (error_plan_has_value(against, q, f)) print_value(against, q, f, stream);
    }
}

enum status study_print_errors(struct error_study *study, const struct member_file *members, FILE *stream) {
    if (study->sweep->n_swept > 0) {
        print_points(study->sweep, members, stream);
        if (!study->sweep->twin) return STATUS_OK;
        fprintf(stream, "\nRatios to %s:\n", error_plan_twin_name(&study->sweep->ratio->point[0], 0));
        print_points(study->sweep->ratio, members, stream);
        fprintf(stream, "\nDifferences from %s:\n", error_plan_twin_name(&study->sweep->change->point[0], 0));
        print_points(study->sweep->change, members, stream);
        return STATUS_OK;
    }
    if (study->study->error->sensitivity) {
        if (study->sweep->twin) print_sensitivities(&study->sweep->ratio->point[0], stream);
        print_sensitivities(study, stream);
        print_reasons(study, members, stream);
        return STATUS_OK;
    }
    if (study->sweep->twin) print_comparison(study->sweep, members, stream);

    const struct error_study_next next = convergence_study_next(study, members);
    const int n_shown = study->n_fish < MAX_FISH_SHOWN ? study->n_fish : MAX_FISH_SHOWN;
    for (int f = 0; f < n_shown; f++) {
        for (int q = 0; q < study->n_asked; q++) {
            if (f == 0 || quantity_of(study, q)->of_fish) print_value(study, q, f, stream);
        }
        print_shares(study, &next, f, stream);
        if (f + 1 < n_shown) fprintf(stream, "\n");
    }

    if (n_shown < study->n_fish) {
        fprintf(stream, "The first %d of %d fish; error.csv and study.nc have all.\n", n_shown, study->n_fish);
    }

    fprintf(stream, "noise of a value, of integrator and search: %.1e\n", study->noise);
    print_choices(study, stream);
    print_reasons(study, members, stream);
    if (study->stated > 0) fprintf(stream, "the stated value takes %.2g times the time of the case\n", study->cost);
    if (study->is_reached) return STATUS_OK;
    char words[CONVERGENCE_BYTES];
    convergence_study_say_cost(study, words);

    return status_fail(STATUS_MISSED, "the errors are not within %.3g %% of the values; %s",
                       100 * study->study->error->within, words);
}

// ---- error.csv

/* The place of a row of error.csv: a quantity of a fish at a point. */
struct csv_row {
    FILE *file;
    const struct error_sweep *sweep;
    const struct error_study *study;
    int q, f;
};
static const char of_model[] = "a choice of the model, not in the sum", of_input[] = "an input, in quadrature";

static void write_csv_row(const struct csv_row *row, const char *kind, const char *key, const char *levels,
                          double value, double order, double error, const char *verdict) {
    const struct error_study *const study = row->study;
    const struct sweep_axis *const axis = &row->sweep->study.sweep[0];
    const struct member_file_quantity *const quantity = quantity_of(study, row->q);
    const char *const word = error_relation_words[study->relation];
    text_print_csv(row->file, quantity->of_fish ? study->values->school.fish[row->f].name : "");
    const double whole = *kind ? value : study->value[error_plan_place(study, row->q, row->f)];
    fprintf(row->file, ",%s%s%s%s,%s,%.9g,%s,%s,%.3g,%.3g,%.3g,", kind, word, *word ? "_" : "", quantity->name,
            study->relation == ERROR_RATIO || *kind ? "1" : quantity->unit, value, key, levels, order, error,
            100 * error / fabs(whole));
    text_print_csv(row->file, verdict);
    for (int c = 0; c < row->sweep->n_swept; c++) {
        const char *const swept = axis->value[study->base * axis->n_keys + c];
        fputc(',', row->file);
        if (strpbrk(swept, ",\"\n")) {
            text_print_csv(row->file, swept);
        } else {
            fputs(swept, row->file);
        }
    }
    fputs("\n", row->file);
}

/* Write the rows of all points of a sweep, or of a comparison. */
static void write_csv_rows(const struct error_sweep *sweep, FILE *file) {
    for (int p = 0; p < sweep->n_points; p++) {
        const struct error_study *const study = &sweep->point[p];
        for (int i = 0; i < study->n_fish * study->n_asked; i++) {
            const int q = i % study->n_asked, f = i / study->n_asked, place = error_plan_place(study, q, f);
            if (!error_plan_has_value(study, q, f)) continue;
            const struct csv_row row = {file, sweep, study, q, f};
            write_csv_row(&row, "", "sum", "", study->value[place], NAN, study->error[place], "");

            char levels[LEVEL_BYTES], reason[CONVERGENCE_BYTES];
            for (int k = 0; k < study->n_keys; k++) {
                const struct error_study_key *const key = &study->key[k];
                write_levels(study, key, levels);
                if (is_missing(key)) {
                    snprintf(reason, CONVERGENCE_BYTES, "not varied: %.200s", key->objection);
                    write_csv_row(&row, "", sweep_error_name(key->row), levels, study->value[place], NAN, NAN, reason);
                }
                if (key->n_levels == 1) continue;
                if (key->slope) {
                    const struct convergence_slope slope = key->slope[place];
                    write_csv_row(&row, "sensitivity_", sweep_error_name(key->row), levels, slope.value, NAN,
                                  slope.error, "");
                    if (!(key->uncertainty > 0)) continue;
                    write_csv_row(&row, "", sweep_error_name(key->row), levels, study->value[place], NAN,
                                  key->part[place].error, of_input);
                    continue;
                }
                study_print_reason(study, key, place, reason);
                const char *const verdict = key->row->kind == SWEEP_MODEL ? of_model
                                            : *reason                     ? reason
                                                                          : convergence_words(key->part[place].verdict);
                write_csv_row(&row, "", sweep_error_name(key->row), levels, study->value[place], key->part[place].order,
                              key->part[place].error, verdict);
            }

            // the lowest and the highest value of other models
            const struct error_study_model *const models[] = {&study->lowest[place], &study->highest[place]};
            for (int m = 0; m < 2 && study->study->error->models && study->is_full; m++) {
                const struct error_study_key *const key = models[m]->key < 0 ? NULL : &study->key[models[m]->key];
                *levels = '\0';
                if (key)
                    snprintf(levels, LEVEL_BYTES, "%s %s", key->row->path, level_text(study, key, models[m]->level));
                write_csv_row(&row, "", m == 0 ? "lowest" : "highest", levels, models[m]->value, NAN,
                              fabs(models[m]->value - study->value[place]), of_model);
            }
        }
    }
}

enum status study_print_csv(const struct error_sweep *sweep, const char *path) {
    const struct sweep_axis *const axis = &sweep->study.sweep[0];
    struct plain_file table;
    TRY(plain_file_open(&table, path, TARGET_TABLE, true, 0666));
    FILE *const file = table.stream;
    fputs(TARGET_TABLE_MARK, file);
    for (int c = 0; c < sweep->n_swept; c++) fprintf(file, ",%s", axis->key[c].path);
    fputs("\n", file);

    write_csv_rows(sweep, file);
    if (sweep->ratio) write_csv_rows(sweep->ratio, file);
    if (sweep->change) write_csv_rows(sweep->change, file);
    return plain_file_close(&table, STATUS_OK);
}
