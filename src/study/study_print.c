/* study_print.c: the members of a study, and the expectations. */
#include "study/study_print.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "case/sweep.h"

void study_fill_name(char *text, size_t size, const char *format, const char *quantity) {
    const int before = (int)(strstr(format, "%s") - format);
    snprintf(text, size, "%.*s%s%s", before, format, quantity, format + before + 2);
}

// ---- members

enum { MAX_FISH_SHOWN = 4, MAX_WARNINGS_SHOWN = 20 };

/* The printed quantities. A quantity of steady states needs a member with a value, a quantity of held bodies a held
 * body. study.nc contains all quantities. */
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

/* Whether a quantity is printed. */
static int print_is_shown(const struct shown *one, const struct case_values *study, const struct member_file *members) {
    int has_held = !one->of_held;
    for (int f = 0; f < study->school.n_fish; f++) {
        const struct motion_parameters *const motion = &study->school.fish[f].motion;
        has_held |= motion->prescribed != PRESCRIBED_NONE && motion->surge == SURGE_GIVEN;
    }

    int is_known = !member_file_quantity(member_file_quantity_number(one->quantity))->of_steady;
    for (int m = 0; m < sweep_n_members(study) && !is_known; m++) {
        is_known = !isnan(member_file_number(&members[m], one->quantity, 0));
    }
    return has_held && is_known;
}

enum status study_print(const struct case_values *study, const struct member_file *members, FILE *stream) {
    const int n = sweep_n_members(study),
              n_fish = study->school.n_fish < MAX_FISH_SHOWN ? study->school.n_fish : MAX_FISH_SHOWN;
    struct text_table table;
    int n_columns = 2 + (n_fish > 1), c = 0;
    for (int a = 0; a < study->n_axes; a++) n_columns += study->sweep[a].n_keys;
    for (int s = 0; s < N_SHOWN; s++) n_columns += print_is_shown(&shown[s], study, members);
    TRY(text_table_create(&table, 2 + n * n_fish, n_columns));

    // one column after the other: head, unit and values
    text_table_set(&table, 0, c, "member");
    for (int row = 0; row < n * n_fish; row++) text_table_set(&table, 2 + row, c, "%d", row / n_fish);
    c++;

    for (int a = 0; a < study->n_axes; a++) {
        const struct sweep_axis *const axis = &study->sweep[a];
        for (int k = 0; k < axis->n_keys; k++, c++) {
            // "modulus" for fish[*].body.modulus, "[1]phase" for fish[1].wave.phase
            const char *const path = axis->key[k].path, *const dot = strrchr(path, '.');
            const int is_one = strncmp(path, "fish[", 5) == 0 && path[5] != '*';
            text_table_set(&table, 0, c, "%.*s%s", is_one ? (int)strcspn(path + 4, ".") : 0, is_one ? path + 4 : "",
                           dot ? dot + 1 : path);
            text_table_set(&table, 1, c, "%s", axis->key[k].unit);
            for (int row = 0; row < n * n_fish; row++) {
                const int value = sweep_member_value(study, row / n_fish, a);
                text_table_set(&table, 2 + row, c, "%s", axis->value[value * axis->n_keys + k]);
            }
        }
    }

    if (n_fish > 1) {
        text_table_set(&table, 0, c, "fish");
        for (int row = 0; row < n * n_fish; row++) {
            text_table_set(&table, 2 + row, c, "%s", study->school.fish[row % n_fish].name);
        }
        c++;
    }

    for (int s = 0; s < N_SHOWN; s++) {
        if (!print_is_shown(&shown[s], study, members)) continue;
        const struct member_file_quantity *const quantity =
            member_file_quantity(member_file_quantity_number(shown[s].quantity));
        text_table_set(&table, 0, c, "%s", shown[s].head);
        text_table_set(&table, 1, c, "%s", strcmp(quantity->unit, "1") == 0 ? "" : quantity->unit);
        for (int row = 0; row < n * n_fish; row++) {
            const int f = quantity->of_fish ? row % n_fish : 0;
            text_table_number(&table, 2 + row, c, shown[s].format,
                              member_file_number(&members[row / n_fish], quantity->name, f));
        }
        c++;
    }

    // "failed: reason": the reasons follow the table
    text_table_set(&table, 0, c, "status");
    for (int row = 0; row < n * n_fish; row++) {
        const char *const status = members[row / n_fish].status;
        text_table_set(&table, 2 + row, c, "%.*s", (int)strcspn(status, ":"), status);
    }

    text_table_print(&table, stream);
    text_table_free(&table);
    if (n_fish < study->school.n_fish) {
        fprintf(stream, "The first %d of %d fish; study.nc has all.\n", n_fish, study->school.n_fish);
    }
    for (int m = 0; m < n; m++) {
        if (strchr(members[m].status, ':')) fprintf(stream, "member %d %s\n", m, members[m].status);
    }

    return STATUS_OK;
}

/* Whether two warnings differ at most in numbers: kind of the warning and fish agree. */
static int warnings_agree(const char *a, int n, const char *b, int m) {
    static const char digits[] = "0123456789.";
    const char *const end_a = a + n, *const end_b = b + m;
    while (a < end_a && b < end_b) {
        const int is_number = *a >= '0' && *a <= '9' && *b >= '0' && *b <= '9';
        if (!is_number && *a != *b) return 0;
        a += is_number ? (long)strspn(a, digits) : 1;
        b += is_number ? (long)strspn(b, digits) : 1;
        // exponents: 4e+03 and 27
        if (is_number && a < end_a && *a == 'e') a += 1 + strspn(a + 1, "+-0123456789");
        if (is_number && b < end_b && *b == 'e') b += 1 + strspn(b + 1, "+-0123456789");
    }
    return a >= end_a && b >= end_b;
}

/* A warning of several members. */
struct warning_group {
    const char *line;  /* of the first member, without the line break */
    int length, shown; /* and its number */
    int first, last, n;
    int differs;   /* the numbers of another member are others */
    char *members; /* "0-2, 5" up to the last range, which is first to last; NULL: no earlier range */
    int members_length;
};

static void group_add_range(struct arena *arena, struct warning_group *group) {
    char range[32];
    int length = snprintf(range, sizeof range, "%s%d", group->members ? ", " : "", group->first);
    if (group->last > group->first) {
        length += snprintf(range + length, sizeof range - (size_t)length, "-%d", group->last);
    }
    GROW(arena, group->members, group->members_length + length + 1);
    memcpy(group->members + group->members_length, range, (size_t)length);
    group->members_length += length;
}

/* Add a warning of a member to the group of its kind, or to a new group. */
static void groups_add(struct arena *arena, struct warning_group **groups, int *n_groups, const char *line, int length,
                       int member) {
    for (int g = 0; g < *n_groups; g++) {
        struct warning_group *const group = &(*groups)[g];
        if (!warnings_agree(group->line, group->length, line, length)) continue;
        group->differs |= length != group->length || memcmp(group->line, line, (size_t)length) != 0;
        if (member > group->last + 1) {
            group_add_range(arena, group);
            group->first = member;
        }
        group->last = member;
        group->n++;
        return;
    }

    GROW(arena, *groups, *n_groups + 1);
    (*groups)[(*n_groups)++] = (struct warning_group){
        .line = line, .length = length, .shown = member, .first = member, .last = member, .n = 1};
}

int study_print_warnings(struct arena *arena, const struct member_file *members, int n, FILE *stream) {
    struct warning_group *groups = NULL;
    int n_warnings = 0, n_groups = 0;

    for (int m = 0; m < n; m++) {
        for (const char *line = members[m].warnings; line && *line; line += *line == '\n') {
            const int length = (int)strcspn(line, "\n");
            n_warnings++;
            groups_add(arena, &groups, &n_groups, line, length, m);
            line += length;
        }
    }

    for (int g = 0; g < n_groups && g < MAX_WARNINGS_SHOWN; g++) {
        struct warning_group *const group = &groups[g];
        group_add_range(arena, group);
        fprintf(stream, "member%s %s: warning: %.*s", group->n > 1 ? "s" : "", group->members, group->length,
                group->line);
        if (group->differs) fprintf(stream, " (numbers of member %d)", group->shown);
        fprintf(stream, "\n");
    }

    if (n_groups > MAX_WARNINGS_SHOWN)
        fprintf(stream, "The first %d of %d kinds of warnings; study.nc has all.\n", MAX_WARNINGS_SHOWN, n_groups);
    return n_warnings;
}

// ---- expectations

/* Smallest and largest value of a quantity over the members and fish of an expectation. */
struct extrema {
    int n;
    double min[2], max[2]; /* x and y of points */
    int missing;           /* a member without a value; -1: none */
};

static struct extrema extrema_of(const struct case_values *study, const struct member_file *members,
                                 const struct sweep_expectation *one, int q) {
    const struct sweep_quantity *const what = &sweep_quantities[q];
    const int quantity = member_file_quantity_number(what->name);
    struct extrema extrema = {.min = {INFINITY, INFINITY}, .max = {-INFINITY, -INFINITY}, .missing = -1};

    for (int m = 0; m < sweep_n_members(study); m++) {
        if (!sweep_expects_of(study, one, m)) continue;
        for (int f = 0; f < (what->of_fish ? study->school.n_fish : 1); f++) {
            if (one->fish >= 0 && one->fish != f) continue;
            extrema.n++;
            for (int k = 0; k < 1 + what->of_xy; k++) {
                const double value = member_file_value(&members[m], quantity, f, k);
                if (isnan(value) || !member_file_is_complete(&members[m])) extrema.missing = m;
                extrema.min[k] = fmin(extrema.min[k], value);
                extrema.max[k] = fmax(extrema.max[k], value);
            }
        }
    }

    return extrema;
}

/* Print a value and the bound; 1 if the bound is met or NaN (no bound). */
static int test_bound(const char *what, double value, const char *word, double bound, FILE *stream) {
    if (isnan(bound)) return 1;
    const int is_lower = strcmp(word, "least") == 0;
    const int is_met = is_lower ? value >= bound : value <= bound;
    fprintf(stream, "  %-8s %s %.9g, expected at %s %.9g\n", is_met ? "met" : "MISSED", what, value, word, bound);
    return is_met;
}

/* Test the bounds of an expectation on one quantity. */
static int test_quantity(const struct case_values *study, const struct member_file *members, int number, int q,
                         FILE *stream) {
    const struct sweep_expectation *const one = &study->expect[number];
    const struct extrema extrema = extrema_of(study, members, one, q);
    const char *const name = sweep_quantities[q].name;

    fprintf(stream, "%s%s%s, %d value%s\n", name, one->fish >= 0 ? " of " : "",
            one->fish >= 0 ? study->school.fish[one->fish].name : "", extrema.n, extrema.n == 1 ? "" : "s");
    if (extrema.missing >= 0) {
        const int is_complete = member_file_is_complete(&members[extrema.missing]);
        fprintf(stream, "  MISSED   member %d %s\n", extrema.missing,
                is_complete ? "has no such value" : "is not complete");
        return 0;
    }

    // a scalar has no second direction
    const double width = extrema.max[0] - extrema.min[0];
    const double height = sweep_quantities[q].of_xy ? extrema.max[1] - extrema.min[1] : 0;

    // infinite if the signs differ or a value is 0
    const double low = extrema.min[0], high = extrema.max[0];
    const double ratio = low > 0 ? high / low : high < 0 ? low / high : INFINITY;

    // no short circuit: print every bound
    const int n_met = test_bound("the smallest is", extrema.min[0], "least", one->min, stream) +
                      test_bound("the largest is", extrema.max[0], "most", one->max, stream) +
                      test_bound("the spread is", hypot(width, height), "most", one->spread, stream) +
                      test_bound("the ratio is", ratio, "most", one->ratio, stream);

    return n_met == 4;
}

static int has_failed(const struct member_file *member, const char *words) {
    return strncmp(member->status, "failed", strlen("failed")) == 0 && strstr(member->status, words) != NULL;
}

int study_expects_failure(const struct case_values *study, const struct member_file *members, int member) {
    for (int i = 0; i < study->n_expectations; i++) {
        const struct sweep_expectation *const one = &study->expect[i];
        if (one->fails && sweep_expects_of(study, one, member) && has_failed(&members[member], one->fails)) return 1;
    }
    return 0;
}

/* Whether all members of an expectation have failed with the expected message. */
static int test_failures(const struct case_values *study, const struct member_file *members,
                         const struct sweep_expectation *one, FILE *stream) {
    int n = 0, wrong = -1;
    for (int m = 0; m < sweep_n_members(study); m++) {
        if (!sweep_expects_of(study, one, m)) continue;
        n++;
        if (!has_failed(&members[m], one->fails)) wrong = m;
    }

    fprintf(stream, "failures, %d member%s\n", n, n == 1 ? "" : "s");
    if (wrong < 0) {
        fprintf(stream, "  met      failed with '%s'\n", one->fails);
    } else {
        fprintf(stream, "  MISSED   member %d has not failed with '%s'\n", wrong, one->fails);
    }

    return wrong < 0;
}

enum status study_expect(const struct case_values *study, const struct member_file *members, FILE *stream) {
    int n_missed = 0, first = 0;
    const char *first_what = "";
    if (study->n_expectations > 0) fprintf(stream, "\nExpected:\n");

    for (int i = 0; i < study->n_expectations; i++) {
        // test all quantities, and keep the first that is missed
        const struct sweep_expectation *const one = &study->expect[i];
        const char *what = NULL;
        if (one->fails && !test_failures(study, members, one, stream)) what = "failures";
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
