/* study_expect.c: test the expectations of a case on the members. */
#include "study/study_expect.h"

#include <math.h>
#include <string.h>

#include "case/sweep.h"
#include "case/sweep_expect.h"
#include "case/sweep_quantity.h"

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
                if (isnan(value) || strcmp(members[m].status, "complete") != 0) extrema.missing = m;
                extrema.min[k] = fmin(extrema.min[k], value);
                extrema.max[k] = fmax(extrema.max[k], value);
            }
        }
    }

    return extrema;
}

/* The ratio of the largest to the smallest absolute value; infinite if the signs differ or a value is 0. */
static double ratio_of(double min, double max) {
    if (min > 0) return max / min;
    return max < 0 ? min / max : INFINITY;
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
        const int is_complete = strcmp(members[extrema.missing].status, "complete") == 0;
        fprintf(stream, "  MISSED   member %d %s\n", extrema.missing,
                is_complete ? "has no such value" : "is not complete");
        return 0;
    }

    // a scalar has no second direction
    const double width = extrema.max[0] - extrema.min[0];
    const double height = sweep_quantities[q].of_xy ? extrema.max[1] - extrema.min[1] : 0;

    // no short circuit: print every bound
    const int n_met = test_bound("the smallest is", extrema.min[0], "least", one->min, stream) +
                      test_bound("the largest is", extrema.max[0], "most", one->max, stream) +
                      test_bound("the spread is", hypot(width, height), "most", one->spread, stream) +
                      test_bound("the ratio is", ratio_of(extrema.min[0], extrema.max[0]), "most", one->ratio, stream);

    return n_met == 4;
}

// ---- members that must fail

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

// ---- all expectations

/* Whether an expectation is met; if not, *what is the first quantity that does not meet the expectation. */
static int test_expectation(const struct case_values *study, const struct member_file *members, int number,
                            const char **what, FILE *stream) {
    const struct sweep_expectation *const one = &study->expect[number];
    *what = "failures";
    if (one->fails) return test_failures(study, members, one, stream);
    int are_met = 1;
    for (int q = 0; q < SWEEP_N_QUANTITIES; q++) {
        if (!(one->of >> q & 1) || test_quantity(study, members, number, q, stream)) continue;
        if (are_met) *what = sweep_quantities[q].name;
        are_met = 0;
    }
    return are_met;
}

enum status study_expect(const struct case_values *study, const struct member_file *members, FILE *stream) {
    int n_missed = 0, first = 0;
    const char *first_what = "", *what;
    if (study->n_expectations > 0) fprintf(stream, "\nExpected:\n");
    for (int i = 0; i < study->n_expectations; i++) {
        if (test_expectation(study, members, i, &what, stream) || n_missed++ > 0) continue;
        first = i;
        first_what = what;
    }

    if (n_missed == 0) return STATUS_OK;
    return status_fail(STATUS_MISSED, "expect[%d]: %s: expectation not met%s: see the output", first, first_what,
                       n_missed > 1 ? ", and others" : "");
}
