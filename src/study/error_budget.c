/* error_budget.c: the rule for the error of a sequence of levels. */
#include "study/error_budget.h"

#include <math.h>
#include <stdio.h>

/* Bounds of the rule: smallest order over the design order, largest distance above the design order, largest change
 * from p' to p. */
static const double least_part = 0.5, most_above = 0.5, most_change = 0.8;

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

// ---- the rule

/* The verdict on differences above the noise. result: p and p'; *first: the finest of the three levels of a flag. */
static enum error_budget_verdict judge_differences(const struct error_budget_levels *levels, int n,
                                                   const double (*f)[2], const struct error_budget_result *result,
                                                   int *first) {
    const double design = levels->design_order, p = result->order, coarse_p = result->coarse_order;
    if (levels->objection && *levels->objection) return ERROR_BUDGET_OBJECTION;
    if (n < 3) return ERROR_BUDGET_FEW;

    // two neighbouring differences turn if their scalar product is negative
    for (int i = 0; i + 2 < n; i++) {
        const double x = (f[i][0] - f[i + 1][0]) * (f[i + 1][0] - f[i + 2][0]);
        const double y = (f[i][1] - f[i + 1][1]) * (f[i + 1][1] - f[i + 2][1]);
        *first = i;
        if (x + y < 0) return ERROR_BUDGET_TURNS;
    }

    // compare orders, because spacings are not halved
    const double least = 1e-6;
    *first = p < least ? 0 : 1;
    if (p < least || coarse_p < least) return ERROR_BUDGET_GROWS;
    *first = 0;
    if (isnan(design)) return ERROR_BUDGET_NO_ORDER;

    // the two finest levels may be equal: the order is infinite, and p is NaN
    if (!(p <= design + most_above)) return ERROR_BUDGET_HIGH;
    *first = p < least_part * design ? 0 : 1;
    if (p < least_part * design || coarse_p < least_part * design) return ERROR_BUDGET_LOW;
    *first = 0;
    return fabs(p - coarse_p) > most_change ? ERROR_BUDGET_CHANGES : ERROR_BUDGET_ACCEPTED;
}

struct error_budget_result error_budget_judge(const struct error_budget_levels *levels, const double (*f)[2],
                                              double noise) {
    const int n = levels->n < levels->n_judged ? levels->n : levels->n_judged;
    const double *const base = f[levels->base];
    struct error_budget_result result = {
        .verdict = ERROR_BUDGET_UNKNOWN, .error = NAN, .finest_error = NAN, .order = NAN, .coarse_order = NAN};
    if (n >= 3) result.order = error_budget_order(levels->size, f);
    if (n >= 4) result.coarse_order = error_budget_order(levels->size + 1, f + 1);

    // the largest difference from the stated value
    double largest = 0;
    for (int i = 0; i < n; i++) {
        const double difference = distance(f[i], base);
        if (isnan(difference)) return result;
        largest = fmax(largest, difference);
    }
    result.error = largest;
    result.verdict = ERROR_BUDGET_NONE;
    if (largest <= of_noise * noise * hypot(base[0], base[1])) return result;

    // Richardson's estimate with the order, at most the design order; fmin ignores NaN
    result.verdict = judge_differences(levels, n, f, &result, &result.first);
    const double p = fmin(result.order, levels->design_order), d_0 = distance(f[0], f[1]);
    const double richardson = safety * d_0 / (pow(levels->size[1] / levels->size[0], p) - 1);
    if (result.verdict == ERROR_BUDGET_ACCEPTED) {
        result.finest_error = richardson;
        result.error = richardson + distance(f[0], base);
    } else if (result.verdict == ERROR_BUDGET_HIGH) {
        result.finest_error = fmax(richardson, fmax(d_0, distance(f[1], f[2])));
        result.error = fmax(result.finest_error, richardson + distance(f[0], base));
    } else if (n < ERROR_BUDGET_LEVELS) {
        // fewer levels span a narrow range
        result.error *= levels->base == 0 ? without_finer : with_finer;
    }

    return result;
}

int error_budget_is_flagged(enum error_budget_verdict verdict) {
    return verdict >= ERROR_BUDGET_OBJECTION;
}

// ---- words

const char *error_budget_words(enum error_budget_verdict verdict) {
    static const char *const words[] = {
        [ERROR_BUDGET_NONE] = "differences are below the noise",
        [ERROR_BUDGET_ACCEPTED] = "accepted",
        [ERROR_BUDGET_OBJECTION] = "no level can be trusted",
        [ERROR_BUDGET_NO_ORDER] = "the key has no design order",
        [ERROR_BUDGET_FEW] = "fewer than three levels",
        [ERROR_BUDGET_TURNS] = "differences change sign",
        [ERROR_BUDGET_GROWS] = "differences do not fall",
        [ERROR_BUDGET_LOW] = "the order is below half of the design order",
        [ERROR_BUDGET_HIGH] = "the order is more than 0.5 above the design order",
        [ERROR_BUDGET_CHANGES] = "the order changes",
        [ERROR_BUDGET_UNKNOWN] = "a level is missing",
    };

    return words[verdict];
}

void error_budget_reason(const struct error_budget_levels *levels, const struct error_budget_result *result,
                         const double *key, char text[ERROR_BUDGET_BYTES]) {
    const char *const words = error_budget_words(result->verdict);
    const double p = result->first == 0 ? result->order : result->coarse_order;
    const int i = result->first;
    *text = '\0';
    if (!error_budget_is_flagged(result->verdict)) return;

    switch (result->verdict) {
        case ERROR_BUDGET_OBJECTION: snprintf(text, ERROR_BUDGET_BYTES, "%s", levels->objection); break;
        case ERROR_BUDGET_TURNS: snprintf(text, ERROR_BUDGET_BYTES, "%s at %.4g", words, key[i + 1]); break;
        case ERROR_BUDGET_GROWS:
            snprintf(text, ERROR_BUDGET_BYTES, "%s from %.4g over %.4g to %.4g", words, key[i + 2], key[i + 1], key[i]);
            break;
        case ERROR_BUDGET_LOW:
        case ERROR_BUDGET_HIGH:
            snprintf(text, ERROR_BUDGET_BYTES, "%s, %g: %.2g from %.4g to %.4g", words, levels->design_order,
                     isnan(p) ? INFINITY : p, key[i + 2], key[i]);
            break;
        case ERROR_BUDGET_CHANGES:
            snprintf(text, ERROR_BUDGET_BYTES, "%s from %.2g to %.2g towards %.4g", words, result->coarse_order,
                     result->order, key[0]);
            break;
        default: snprintf(text, ERROR_BUDGET_BYTES, "%s", words);
    }
}
