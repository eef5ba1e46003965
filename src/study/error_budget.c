/* error_budget.c: the rule for the error of a sequence of levels. */
#include "study/error_budget.h"

#include <math.h>

/* Bounds of the rule: slack of an order below the design order; change from p' to p; distance above the design order
 * from which the change is irrelevant, because the rule then uses the design order. */
static const double slack = 1, most_change = 0.8, far_above = 1.5;

/* Roache's safety factor; safety factors of the largest difference of fewer than four levels, if the base is the finest
 * level and otherwise; multiple of the noise below which differences have no meaning. */
static const double safety = 1.25, without_finer = 1.5, with_finer = 2, of_noise = 3;

/* Values that differ by less than this part of their size are equal: rounding hides the order. */
static const double rounding = 1e-12;

// ---- order

// the ratio of differences for an order
static double ratio_of_order(double p, double r, double s) {
    if (fabs(p) < 1e-9) return log(s) / log(r);
    return pow(r, p) * (pow(s, p) - 1) / (pow(r, p) - 1);
}

// by bisection: the ratio grows with the order
static double order_of_ratio(double ratio, double r, double s) {
    double low = -20, high = 20;
    while (high - low > 1e-12) {
        const double middle = (low + high) / 2;
        if (ratio_of_order(middle, r, s) < ratio) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return (low + high) / 2;
}

static double distance(const double *a, const double *b) {
    return hypot(a[0] - b[0], a[1] - b[1]);
}

double error_budget_order(const double *size, const double (*value)[2]) {
    const double fine = distance(value[0], value[1]), coarse = distance(value[1], value[2]);
    const double least = rounding * fmax(1, hypot(value[0][0], value[0][1]));
    if (!(fine > least)) return NAN;
    if (!(coarse > least)) return -INFINITY;
    return order_of_ratio(coarse / fine, size[1] / size[0], size[2] / size[1]);
}

// ---- one sequence

static enum error_budget_verdict judge_one(const struct error_budget_levels *levels,
                                           const struct error_budget_sequence *sequence,
                                           struct error_budget_result *result) {
    const int n = levels->n;
    const double(*const f)[2] = sequence->value;
    const double design = levels->design_order;
    double largest = 0;
    for (int i = 0; i < n; i++) {
        const double difference = distance(f[i], f[levels->base]);
        largest = isnan(difference) ? NAN : isnan(largest) ? largest : fmax(largest, difference);
    }

    *result = (struct error_budget_result){.error = largest, .finest_error = NAN, .order = NAN, .coarse_order = NAN};
    if (isnan(largest)) return ERROR_BUDGET_UNKNOWN;
    if (n >= 3) result->order = error_budget_order(levels->size, f);
    if (n >= 4) result->coarse_order = error_budget_order(levels->size + 1, f + 1);

    if (largest <= of_noise * sequence->noise * hypot(f[levels->base][0], f[levels->base][1])) return ERROR_BUDGET_NONE;
    if (n < 3) return ERROR_BUDGET_FEW;

    // two neighbouring differences turn if their scalar product is negative
    for (int i = 0; i + 2 < n; i++) {
        const double x = (f[i][0] - f[i + 1][0]) * (f[i + 1][0] - f[i + 2][0]);
        const double y = (f[i][1] - f[i + 1][1]) * (f[i + 1][1] - f[i + 2][1]);
        if (x + y < 0) return ERROR_BUDGET_TURNS;
    }

    // compare orders, because spacings are not halved; equal values have no order and are acceptable
    const double least = 1e-6;
    if (result->order < least || result->coarse_order < least) return ERROR_BUDGET_GROWS;
    if (isnan(design)) return ERROR_BUDGET_NO_ORDER;
    if (result->order < design - slack || result->coarse_order < design - slack) return ERROR_BUDGET_LOW;

    // the rule uses the design order, so an order that rises above the design order is acceptable
    const int is_far_above = !(result->order <= design + far_above);
    const int is_rising = result->coarse_order >= design && result->order >= result->coarse_order;
    if (fabs(result->order - result->coarse_order) > most_change && !is_far_above && !is_rising) {
        return ERROR_BUDGET_CHANGES;
    }
    return ERROR_BUDGET_ACCEPTED;
}

// ---- all sequences

enum error_budget_verdict error_budget_judge(const struct error_budget_levels *levels, int n,
                                             const struct error_budget_sequence *sequences,
                                             struct error_budget_result *results, int *culprit) {
    struct error_budget_levels judged = *levels;
    if (judged.n > ERROR_BUDGET_LEVELS) judged.n = ERROR_BUDGET_LEVELS;
    enum error_budget_verdict all = ERROR_BUDGET_NONE;
    *culprit = -1;
    for (int q = 0; q < n; q++) {
        const enum error_budget_verdict one = judge_one(&judged, &sequences[q], &results[q]);
        results[q].verdict = one;
        if (one == ERROR_BUDGET_ACCEPTED && all == ERROR_BUDGET_NONE) all = one;

        // a missing level takes precedence over any flag
        const int is_first = error_budget_is_flagged(one) && !error_budget_is_flagged(all);
        if (!is_first && !(one == ERROR_BUDGET_UNKNOWN && all != ERROR_BUDGET_UNKNOWN)) continue;
        all = one;
        *culprit = q;
    }
    if (levels->objection && all != ERROR_BUDGET_UNKNOWN) {
        all = ERROR_BUDGET_OBJECTION;
        *culprit = -1;
    }

    // four levels span a range that is wide enough
    const double factor = judged.n >= ERROR_BUDGET_LEVELS ? 1 : judged.base == 0 ? without_finer : with_finer;
    for (int q = 0; q < n; q++) {
        struct error_budget_result *const result = &results[q];
        if (result->verdict == ERROR_BUDGET_UNKNOWN) continue;
        if (all == ERROR_BUDGET_ACCEPTED && result->verdict == ERROR_BUDGET_ACCEPTED) {
            // extrapolate with the order, at most the design order; fmin ignores NaN
            const double(*const f)[2] = sequences[q].value;
            const double p = fmin(result->order, judged.design_order);
            const double part = 1 / (pow(judged.size[1] / judged.size[0], p) - 1);
            result->finest_error = safety * distance(f[0], f[1]) * part;
            result->error = result->finest_error + distance(f[0], f[judged.base]);
        } else if (error_budget_is_flagged(all) && result->verdict != ERROR_BUDGET_NONE) {
            result->error *= factor;
        }
    }
    return all;
}

int error_budget_is_flagged(enum error_budget_verdict verdict) {
    return verdict >= ERROR_BUDGET_OBJECTION;
}

const char *error_budget_words(enum error_budget_verdict verdict) {
    static const char *const words[] = {
        [ERROR_BUDGET_NONE] = "differences are below the noise",
        [ERROR_BUDGET_ACCEPTED] = "accepted",
        [ERROR_BUDGET_OBJECTION] = "no level can be trusted",
        [ERROR_BUDGET_NO_ORDER] = "the key has no design order",
        [ERROR_BUDGET_FEW] = "fewer than three levels",
        [ERROR_BUDGET_TURNS] = "differences change sign",
        [ERROR_BUDGET_GROWS] = "differences do not fall towards the finest level",
        [ERROR_BUDGET_LOW] = "the order is more than 1 below the design order",
        [ERROR_BUDGET_CHANGES] = "the order changes from level to level",
        [ERROR_BUDGET_UNKNOWN] = "a level is missing",
    };

    return words[verdict];
}
