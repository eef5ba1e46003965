/* convergence.c: the rule for the error of a sequence of levels, refined axes, and error studies. */
#include "study/convergence.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "case/sweep.h"
#include "case/sweep_quantity.h"
#include "study/error_plan.h"

/* Bounds of the rule: smallest order over the design order, largest distance above the design order, largest change
 * from p' to p. */
static const double least_part = 0.5, most_above = 0.5, most_change = 0.8;

/* Roache's safety factor; the safety factors of the largest difference of fewer than four levels, if the base is the
 * finest level and if it is not; and the multiple of the noise below which differences have no meaning. */
static const double safety = 1.25, without_finer = 1.5, with_finer = 2, of_noise = 3;

/* How much finer than the stated level the finest one has to be, so that the levels between them suffice although they
 * have no order; and the same for tolerances. */
static const double enough_finer = 1.9, tenth = 9;

/* Values that differ by less than this part of their size are equal: rounding hides the order. */
static const double rounding = 1e-12;

/* Error of a steady state without multipliers over the residual change per beat, unless this ratio is known. */
static const double of_residual = 10;

/* Largest number of added levels per key. */
enum { MOST_ADDED = 3 };

// ---- order

static double distance(const double *a, const double *b) {
    return hypot(a[0] - b[0], a[1] - b[1]);
}

double convergence_order(const double *size, const double (*value)[2]) {
    const double fine = distance(value[0], value[1]), coarse = distance(value[1], value[2]);
    const double least = rounding * fmax(1, hypot(value[0][0], value[0][1]));
    if (!(fine > least)) return NAN;
    if (!(coarse > least)) return -INFINITY;

    // by bisection: the ratio of the differences, r^p (s^p - 1)/(r^p - 1), grows with the order p
    const double r = size[1] / size[0], s = size[2] / size[1];
    double low = -20, high = 20;
    while (high - low > 1e-12) {
        const double p = (low + high) / 2;
        const double ratio = fabs(p) < 1e-9 ? log(s) / log(r) : pow(r, p) * (pow(s, p) - 1) / (pow(r, p) - 1);
        if (ratio < coarse / fine) {
            low = p;
        } else {
            high = p;
        }
    }
    return (low + high) / 2;
}

// ---- the rule

/* The verdict on differences above the noise. result: p and p'; *first: the finest of the three levels of a flag. */
static enum convergence_verdict judge_differences(const struct convergence_levels *levels, int n, const double (*f)[2],
                                                  const struct convergence_result *result, int *first) {
    const double design = levels->design_order, p = result->order, coarse_p = result->coarse_order;
    if (levels->objection && *levels->objection) return CONVERGENCE_OBJECTION;
    if (n < 3) return CONVERGENCE_FEW;

    // two neighbouring differences turn if their scalar product is negative
    for (int i = 0; i + 2 < n; i++) {
        const double x = (f[i][0] - f[i + 1][0]) * (f[i + 1][0] - f[i + 2][0]);
        const double y = (f[i][1] - f[i + 1][1]) * (f[i + 1][1] - f[i + 2][1]);
        *first = i;
        if (x + y < 0) return CONVERGENCE_TURNS;
    }

    // compare orders, because spacings are not halved
    const double least = 1e-6;
    *first = p < least ? 0 : 1;
    if (p < least || coarse_p < least) return CONVERGENCE_GROWS;
    *first = 0;
    if (isnan(design)) return CONVERGENCE_NO_ORDER;

    // the two finest levels may be equal: the order is infinite, and p is NaN
    if (!(p <= design + most_above)) return CONVERGENCE_HIGH;
    *first = p < least_part * design ? 0 : 1;
    if (p < least_part * design || coarse_p < least_part * design) return CONVERGENCE_LOW;
    *first = 0;
    return fabs(p - coarse_p) > most_change ? CONVERGENCE_CHANGES : CONVERGENCE_ACCEPTED;
}

struct convergence_result convergence_judge(const struct convergence_levels *levels, const double (*f)[2],
                                            double noise) {
    const int n = levels->n < levels->n_judged ? levels->n : levels->n_judged;
    const double *const base = f[levels->base];
    struct convergence_result result = {
        .verdict = CONVERGENCE_UNKNOWN, .error = NAN, .finest_error = NAN, .order = NAN, .coarse_order = NAN};
    if (n >= 3) result.order = convergence_order(levels->size, f);
    if (n >= 4) result.coarse_order = convergence_order(levels->size + 1, f + 1);

    // the largest difference from the stated value
    double largest = 0;
    for (int i = 0; i < n; i++) {
        const double difference = distance(f[i], base);
        if (isnan(difference)) return result;
        largest = fmax(largest, difference);
    }
    result.error = largest;
    result.verdict = CONVERGENCE_NONE;
    const bool is_noise = !(largest > 0) || largest <= of_noise * noise * hypot(base[0], base[1]);
    if (is_noise) {
        // coarser levels have larger errors than the stated one, and count only without finer ones
        for (int i = 0; i < levels->base && i < 2; i++) result.spread = fmax(result.spread, distance(f[i], f[i + 1]));
        result.shift = f[0][0] - base[0];
        if (levels->base == 0) result.spread = result.error;
        result.error = distance(f[0], base) + result.spread;
        return result;
    }

    // Richardson's estimate with the order, at most the design order; fmin ignores NaN
    result.verdict = judge_differences(levels, n, f, &result, &result.first);
    const double p = fmin(result.order, levels->design_order), d_0 = distance(f[0], f[1]);
    const double d_1 = n < 3 ? 0 : distance(f[1], f[2]), of_base = distance(f[0], base);
    const double richardson = safety * d_0 / (pow(levels->size[1] / levels->size[0], p) - 1);
    result.shift = f[0][0] - base[0];
    if (result.verdict == CONVERGENCE_ACCEPTED) {
        result.finest_error = richardson;
        result.error = richardson + of_base;
        result.shift += copysign(richardson / safety, f[0][0] - f[1][0]);
        result.spread = result.error - fabs(result.shift);
        return result;
    }

    // without an order the finest levels count, if they are fine enough; otherwise all levels
    const double finer = levels->size[levels->base] / levels->size[0];
    const bool is_high = result.verdict == CONVERGENCE_HIGH;
    result.spread = is_high ? fmax(richardson, fmax(d_0, d_1)) : fmax(d_0, d_1);
    if (is_high) result.finest_error = result.spread;
    const bool is_fine = finer > tenth || (finer > enough_finer && n == CONVERGENCE_LEVELS);
    if (result.verdict == CONVERGENCE_OBJECTION || !is_fine) {
        if (is_high) {
            result.error = fmax(result.finest_error, richardson + of_base);
        } else if (n < CONVERGENCE_LEVELS) {
            // fewer levels span a narrow range
            result.error *= levels->base == 0 ? without_finer : with_finer;
        }
        result.spread = fmax(result.spread, result.error - fabs(result.shift));
        return result;
    }

    // faster than the design order without a jump to it: what remains is between nothing and Richardson's estimate with
    // the design order
    if (is_high && result.order <= result.coarse_order + most_change) {
        const double middle = richardson / safety / 2;
        result.finest_error = richardson;
        result.error = of_base + richardson;
        result.shift += copysign(middle, f[0][0] - f[1][0]);
        result.spread = richardson - middle;
        return result;
    }

    // a tolerance of a tenth needs no coarser one beside it
    if (finer > tenth) result.spread = of_base;
    result.error = of_base + result.spread;
    return result;
}

struct convergence_result convergence_judge_exact(int n, const double *size, const double (*f)[2],
                                                  const double *exact) {
    struct convergence_result result = {.verdict = CONVERGENCE_ACCEPTED,
                                        .order = NAN,
                                        .coarse_order = NAN,
                                        .error = distance(f[0], exact),
                                        .finest_error = NAN};

    // the order of two levels each; none if a level is exact to rounding
    const double least = rounding * fmax(1, hypot(exact[0], exact[1]));
    for (int i = 0; i < 2 && i + 1 < n; i++) {
        const double fine = distance(f[i], exact), coarse = distance(f[i + 1], exact);
        if (!(fine > least && coarse > least)) continue;
        *(i == 0 ? &result.order : &result.coarse_order) = log(coarse / fine) / log(size[i + 1] / size[i]);
    }
    for (int i = 0; i < n; i++) {
        if (isnan(f[i][0] + f[i][1])) result.verdict = CONVERGENCE_UNKNOWN;
    }

    return result;
}

bool convergence_is_flagged(enum convergence_verdict verdict) {
    return verdict >= CONVERGENCE_OBJECTION;
}

// ---- words

const char *convergence_words(enum convergence_verdict verdict) {
    static const char *const words[] = {
        [CONVERGENCE_NONE] = "differences are below the noise",
        [CONVERGENCE_ACCEPTED] = "accepted",
        [CONVERGENCE_OBJECTION] = "no level can be trusted",
        [CONVERGENCE_NO_ORDER] = "the key has no design order",
        [CONVERGENCE_FEW] = "fewer than three levels",
        [CONVERGENCE_TURNS] = "differences change sign",
        [CONVERGENCE_GROWS] = "differences do not fall",
        [CONVERGENCE_LOW] = "the order is below half of the design order",
        [CONVERGENCE_HIGH] = "the order is more than 0.5 above the design order",
        [CONVERGENCE_CHANGES] = "the order changes",
        [CONVERGENCE_UNKNOWN] = "a level is missing",
    };

    return words[verdict];
}

void convergence_reason(const struct convergence_levels *levels, const struct convergence_result *result,
                        const double *key, char text[CONVERGENCE_BYTES]) {
    const char *const words = convergence_words(result->verdict);
    const double p = result->first == 0 ? result->order : result->coarse_order;
    const int i = result->first;
    *text = '\0';
    if (!convergence_is_flagged(result->verdict)) return;

    switch (result->verdict) {
        case CONVERGENCE_OBJECTION: snprintf(text, CONVERGENCE_BYTES, "%s", levels->objection); break;
        case CONVERGENCE_TURNS: snprintf(text, CONVERGENCE_BYTES, "%s at %.4g", words, key[i + 1]); break;
        case CONVERGENCE_GROWS:
            snprintf(text, CONVERGENCE_BYTES, "%s from %.4g over %.4g to %.4g", words, key[i + 2], key[i + 1], key[i]);
            break;
        case CONVERGENCE_LOW:
        case CONVERGENCE_HIGH:
            snprintf(text, CONVERGENCE_BYTES, "%s, %g: %.2g from %.4g to %.4g", words, levels->design_order,
                     isnan(p) ? INFINITY : p, key[i + 2], key[i]);
            break;
        case CONVERGENCE_CHANGES:
            snprintf(text, CONVERGENCE_BYTES, "%s from %.2g to %.2g towards %.4g", words, result->coarse_order,
                     result->order, key[0]);
            break;
        default: snprintf(text, CONVERGENCE_BYTES, "%s", words);
    }
}

// ---- derivatives

/* The weights of n values in the derivative at 0 of the polynomial through them. */
static void fill_weights(int n, const double *step, double *weight) {
    // Lagrange's polynomials, each the product of (x - x_j)/(x_i - x_j): the derivative at 0 by the product rule
    for (int i = 0; i < n; i++) {
        weight[i] = 0;
        for (int k = 0; k < n; k++) {
            if (k == i) continue;
            double product = 1 / (step[i] - step[k]);
            for (int j = 0; j < n; j++) {
                if (j != i && j != k) product *= (0 - step[j]) / (step[i] - step[j]);
            }
            weight[i] += product;
        }
    }
}

struct convergence_slope convergence_find_slope(int n, const double *step, const double *value, int base,
                                                double noise) {
    const struct convergence_slope unknown = {NAN, NAN};
    if (n < 3 || n > CONVERGENCE_STEPS) return unknown;

    // all values, then those nearer than the farthest
    double farthest = 0, slope[2] = {0, 0}, squares = 0;
    for (int i = 0; i < n; i++) farthest = fmax(farthest, fabs(step[i]));
    for (int part = 0; part < 2; part++) {
        double x[CONVERGENCE_STEPS], y[CONVERGENCE_STEPS], weight[CONVERGENCE_STEPS];
        int m = 0;
        for (int i = 0; i < n; i++) {
            if (part == 1 && fabs(step[i]) > farthest * (1 - 1e-9)) continue;
            x[m] = step[i];
            y[m++] = value[i] / value[base];
        }
        fill_weights(m, x, weight);
        for (int i = 0; i < m; i++) {
            slope[part] += weight[i] * y[i];
            if (part == 0) squares += weight[i] * weight[i] * y[i] * y[i];
        }
    }
    return (struct convergence_slope){slope[0], fabs(slope[0] - slope[1]) + noise * sqrt(squares)};
}

// ---- values of members

/* The member that a member is compared with. */
static int twin_of(const struct error_study *study, int m) {
    if (m == study->base) return study->twin->base;
    if (m == study->finest) return study->twin->finest;
    for (int k = 0; k < study->n_keys; k++) {
        for (int i = 0; i < study->key[k].n_levels; i++) {
            if (study->key[k].member[i] == m) return study->key[k].twin[i];
        }
    }
    return -1;
}

double convergence_study_value(const struct error_study *study, const struct member_file *members, int m, int q,
                               int f) {
    if (m < 0 || !member_file_is_complete(&members[m])) return NAN;
    const int quantity = study->quantity[q];
    const bool of_fish = member_file_quantity(quantity)->of_fish;
    const double value = member_file_value(&members[m], quantity, of_fish ? f : 0, 0);
    if (study->relation == ERROR_VALUE) return value;
    const int twin_fish = of_fish ? error_plan_twin_fish(study, f) : 0;
    if (twin_fish < 0) return NAN;
    const double other = convergence_study_value(study->twin, members, twin_of(study, m), q, twin_fish);
    return study->relation == ERROR_RATIO ? value / other : value - other;
}

static bool is_multiplier(const char *quantity) {
    return quantity && strcmp(quantity, "steady_multiplier") == 0;
}

/* The relative error of member m by the search for its steady state. */
static double search_noise(const struct case_values *values, const struct member_file *members, int m, int known,
                           double beat, const char *quantity, int f) {
    // the multiplier: noise of the wake and size of the disturbances
    if (is_multiplier(quantity)) {
        return member_file_number(&members[m], "steady_multiplier_error", 0) /
               member_file_number(&members[m], "steady_multiplier", 0);
    }

    // the distance from the fixed point, or an estimate by the residual
    const double residual = member_file_number(&members[m], "steady_residual", 0);
    const double ratio = member_file_number(&members[known], "steady_error", 0) /
                         member_file_number(&members[known], "steady_residual", 0);
    double search_error = member_file_number(&members[m], "steady_error", 0);
    if (isnan(search_error)) search_error = residual * (isfinite(ratio) ? fmax(1, ratio) : of_residual);

    // in body lengths: distance travelled per beat, or tail excursion
    const double way = member_file_number(&members[m], "steady_speed", f) * beat / values->school.fish[f].length;
    const double strouhal = member_file_number(&members[m], "steady_strouhal", f);
    const bool is_tail = quantity && strcmp(quantity, "steady_strouhal") == 0 && strouhal > 0;
    return search_error / (way > 0 ? fmin(1, is_tail ? strouhal * way : way) : 1);
}

double convergence_noise(const struct case_values *study, const struct case_values *values,
                         const struct member_file *members, int m, int known, double beat, const char *quantity,
                         int f) {
    const bool is_steady = sweep_is_steady(study);
    const double of_search = is_steady ? search_noise(values, members, m, known, beat, quantity, f) : 0;
    if (is_steady && is_multiplier(quantity)) return of_search;

    // the integrator; a fixed step has no tolerance
    double rtol = values->solver.rtol;
    for (int a = 0; a < study->n_axes; a++) {
        const struct sweep_axis *const axis = &study->sweep[a];
        for (int k = 0; k < axis->n_keys; k++) {
            if (strcmp(axis->key[k].row, "solver.rtol") != 0) continue;
            text_number(axis->value[sweep_member_value(study, m, a) * axis->n_keys + k], &rtol);
        }
    }
    if (values->solver.step > 0) rtol = rounding;
    return rtol + of_search;
}

/* The noise of a quantity of a member of an error study; a ratio or a difference has that of both its parts.
 * is_neighbour: leave out the error of the integrator, which neighbours share. */
static double study_noise(const struct error_study *study, const struct member_file *members, int m, int q, int f,
                          bool is_neighbour) {
    if (study->relation != ERROR_VALUE) {
        const int twin = twin_of(study, m), found = error_plan_twin_fish(study, f), fish = found < 0 ? 0 : found;
        const double own = study_noise(study->point, members, m, q, f, is_neighbour),
                     other = study_noise(study->twin, members, twin, q, fish, is_neighbour);
        if (study->relation == ERROR_RATIO) return own + other;
        return (own * fabs(convergence_study_value(study->point, members, m, q, f)) +
                other * fabs(convergence_study_value(study->twin, members, twin, q, fish))) /
               fabs(convergence_study_value(study, members, m, q, f));
    }
    const char *const quantity = member_file_quantity(study->quantity[q])->name;
    // an equilibrium is found by Newton's method, without the integrator
    const bool is_of_search = study->is_static || (study->is_steady && is_neighbour);
    if (!is_of_search) {
        return convergence_noise(study->study, study->values, members, m, study->base, study->beat, quantity, f);
    }
    return fmax(rounding,
                search_noise(study->values, members, m, study->base, study->is_static ? 0 : study->beat, quantity, f));
}

// ---- the refined axis

int convergence_place(const struct convergence_orders *orders, int group, int quantity, int fish) {
    return (group * SWEEP_N_ORDERS + quantity) * orders->n_fish + fish;
}

/* Fill the row of one quantity of one fish of a group. stride: distance of the members of neighbouring values. */
static void fill_row(struct convergence_orders *orders, const struct case_values *study,
                     const struct member_file *members, int group, int stride, int q, int f) {
    const struct sweep_axis *const axis = &study->sweep[orders->axis];
    const int n = orders->n_levels, n_judged = orders->n_judged, place = convergence_place(orders, group, q, f);
    const int quantity = member_file_quantity_number(sweep_quantities[q].name), of_xy = sweep_quantities[q].of_xy;
    const double given[2] = {sweep_reference(study, orders->axis, q, f, 0),
                             of_xy ? sweep_reference(study, orders->axis, q, f, 1) : 0};
    const bool is_given = !isnan(given[0]);
    struct convergence_row *const row = &orders->row[place];

    // judge the finest levels, from fine to coarse
    double size[CONVERGENCE_LEVELS], number[CONVERGENCE_LEVELS], at[2] = {0, 0};
    double value[CONVERGENCE_LEVELS][2] = {{0}};
    int finest = 0;
    for (int i = 0; i < n; i++) {
        const int m = orders->first[group] + orders->level[n - 1 - i] * stride;
        const bool is_complete = member_file_is_complete(&members[m]);
        at[0] = is_complete ? member_file_value(&members[m], quantity, f, 0) : NAN;
        at[1] = of_xy ? member_file_value(&members[m], quantity, f, 1) : 0;
        if (i == 0) finest = m;
        if (i < n_judged) {
            size[i] = orders->grid_spacing[n - 1 - i];
            number[i] = orders->value[n - 1 - i];
            memcpy(value[i], at, sizeof at);
            row->is_known |= !isnan(at[0]);
        }
        const double *const exact = is_given ? given : value[0];
        orders->error[place * n + n - 1 - i] = i > 0 || is_given ? hypot(at[0] - exact[0], at[1] - exact[1]) : NAN;
    }

    if (is_given) {
        row->result = convergence_judge_exact(n_judged, size, (const double(*)[2])value, given);
    } else {
        const struct convergence_levels levels = {
            .n = n_judged,
            .n_judged = n_judged,
            .size = size,
            .design_order = sweep_error_order(study, sweep_error_find(axis->key[0].row))};
        const double noise = convergence_noise(study, study, members, finest, finest, 0, NULL, 0);
        row->result = convergence_judge(&levels, (const double(*)[2])value, noise);
        convergence_reason(&levels, &row->result, number, row->flag);
    }

    const double part = 1 / (pow(size[1] / size[0], row->result.order) - 1);
    for (int k = 0; k < 2; k++) {
        const double limit = value[0][k] + (value[0][k] - value[1][k]) * part;
        row->limit[k] = convergence_is_flagged(row->result.verdict) ? NAN : limit;
    }
}

void convergence_orders_create(struct arena *arena, struct convergence_orders *orders, const struct case_values *study,
                               const struct member_file *members) {
    *orders = (struct convergence_orders){.n_fish = study->school.n_fish};
    while (orders->axis < study->n_axes && !study->sweep[orders->axis].refine) orders->axis++;
    if (orders->axis == study->n_axes) return;

    const struct sweep_axis *const axis = &study->sweep[orders->axis];
    const int n_levels = axis->n_values, n_groups = sweep_n_members(study) / n_levels;
    const int n = n_groups * SWEEP_N_ORDERS * orders->n_fish;
    NEW(arena, orders->level, n_levels);
    NEW(arena, orders->value, n_levels);
    NEW(arena, orders->grid_spacing, n_levels);
    NEW(arena, orders->first, n_groups);
    NEW(arena, orders->row, n);
    NEW(arena, orders->error, n * n_levels);
    orders->n_groups = n_groups;
    orders->n_levels = n_levels;
    orders->n_judged = n_levels < CONVERGENCE_LEVELS ? n_levels : CONVERGENCE_LEVELS;

    // sort the levels from coarse to fine: insertion sort of few levels
    for (int i = 0; i < n_levels; i++) {
        double value = NAN;
        text_number(axis->value[i * axis->n_keys], &value);
        const double size = error_plan_size(sweep_error_find(axis->key[0].row), value);
        int j = i;
        for (; j > 0 && orders->grid_spacing[j - 1] < size; j--) {
            orders->grid_spacing[j] = orders->grid_spacing[j - 1];
            orders->value[j] = orders->value[j - 1];
            orders->level[j] = orders->level[j - 1];
        }
        orders->grid_spacing[j] = size;
        orders->value[j] = value;
        orders->level[j] = i;
    }

    // a group starts at each member with the first value of the refined axis
    for (int m = 0, g = 0; m < sweep_n_members(study); m++) {
        if (sweep_member_value(study, m, orders->axis) == 0) orders->first[g++] = m;
    }

    int stride = 1;
    for (int a = orders->axis + 1; a < study->n_axes; a++) stride *= study->sweep[a].n_values;
    for (int g = 0; g < n_groups; g++) {
        for (int q = 0; q < SWEEP_N_ORDERS; q++) {
            if (!(sweep_refine_orders(study) >> q & 1)) continue;
            for (int f = 0; f < orders->n_fish; f++) fill_row(orders, study, members, g, stride, q, f);
        }
    }
}

// ---- the judgement of an error study

/* CPU time that a member would take for a simulated time that is common to all members [s], plus a constant, because
 * below it the cost is irrelevant. */
static double cost_of(const struct error_study *study, const struct member_file *members, int m) {
    const bool is_by_beats = study->is_steady && !study->is_static;
    const double least_beat = 1e-3, least_run = 0.1;
    return member_file_number(&members[m], is_by_beats ? "beat_time" : "wall_time", 0) +
           (is_by_beats ? least_beat : least_run);
}

// judge at most four levels, but three of a duration, because a wake that ends within two body lengths is not yet a far
// wake
struct convergence_levels convergence_study_levels(const struct error_study *study, const struct error_study_key *key,
                                                   double *size) {
    for (int i = 0; i < key->n_levels; i++) size[i] = error_plan_size(key->row, key->value[i]);
    return (struct convergence_levels){.n = key->n_levels,
                                       .n_judged = key->row->kind == SWEEP_DURATION ? 3 : CONVERGENCE_LEVELS,
                                       .base = key->stated,
                                       .size = size,
                                       .design_order = sweep_error_order(study->values, key->row),
                                       .objection = key->objection};
}

/* The derivatives of each requested quantity by an input; times its uncertainty they are a part of the error. */
static void judge_input(const struct error_study *study, const struct member_file *members,
                        struct error_study_key *key) {
    double step[ERROR_STUDY_LEVELS], value[ERROR_STUDY_LEVELS];
    const double stated = key->value[key->stated];
    for (int place = 0; place < study->n_asked * study->n_fish; place++) {
        const int q = place / study->n_fish, f = place % study->n_fish;
        double noise = 0;
        for (int i = 0; i < key->n_levels; i++) {
            step[i] = key->value[i] / stated - 1;
            value[i] = convergence_study_value(study, members, key->member[i], q, f);
            noise = fmax(noise, study_noise(study, members, key->member[i], q, f, true));
        }
        struct convergence_slope *const slope = &key->slope[place];
        *slope = convergence_find_slope(key->n_levels, step, value, key->stated, noise);
        const double part = key->uncertainty > 0 ? fabs(slope->value * value[key->stated]) * key->uncertainty : NAN;
        key->part[place] = (struct convergence_result){.verdict = CONVERGENCE_ACCEPTED,
                                                       .error = part,
                                                       .finest_error = NAN,
                                                       .spread = part,
                                                       .order = NAN,
                                                       .coarse_order = NAN};
    }
}

/* Judge each requested quantity of each fish by the finest levels of a key; a choice of the model by the largest
 * change. */
static void judge_key(struct error_study *study, const struct member_file *members, struct error_study_key *key) {
    const struct case_values *const values = study->values;
    double size[ERROR_STUDY_LEVELS], value[ERROR_STUDY_LEVELS][2] = {{0}};
    if (key->row->kind == SWEEP_INPUT) {
        judge_input(study, members, key);
        return;
    }
    struct convergence_levels levels = convergence_study_levels(study, key, size);
    const int stated = key->member[key->stated];

    // object to an interval for which the sheet has too few points, and leave out levels with too few points for the
    // interval: doc/model.md, section 8
    const bool is_interval = strcmp(key->row->path, "time.shedding_interval") == 0;
    const bool are_points = strcmp(key->row->path, "fish.sheet_points") == 0;
    const bool is_of_sheet = values->school.wake.shedding == SHEDDING_SHEET;
    if (is_interval && is_of_sheet) *key->objection = '\0';
    for (int f = 0; f < study->n_fish && (is_interval || are_points) && is_of_sheet && !*key->objection; f++) {
        const struct fish_parameters *const fish = &values->school.fish[f];
        const double speed = member_file_number(&members[study->base], "speed", f);
        const double needed = 1 + 3.2 / sqrt(fabs(speed) * values->school.shedding_interval / fish->length);
        const double most = 1000;       // a fish that needs more sheet points does not swim
        const double of_warning = 0.9;  // a run with this part of them has the warning
        const double least = 1 + of_warning * (needed - 1);
        while (are_points && levels.n > 2 && levels.n > key->stated + 1 && key->value[levels.n - 1] < least) levels.n--;
        key->n_left_out = key->n_levels - levels.n;
        if (are_points || !(fish->sheet_points < needed) || needed > most) continue;
        snprintf(key->objection, CONVERGENCE_BYTES, "%.60s needs %.0f sheet_points for this interval", fish->name,
                 ceil(needed));
    }

    // a numerical key by the finest levels, a choice of the model by the largest change
    for (int q = 0; q < study->n_asked; q++) {
        for (int f = 0; f < study->n_fish; f++) {
            struct convergence_result *const part = &key->part[error_plan_place(study, q, f)];
            const bool is_choice = key->row->kind == SWEEP_MODEL;
            if (!error_plan_has_value(study, q, f)) {
                *part =
                    (struct convergence_result){.error = NAN, .finest_error = NAN, .order = NAN, .coarse_order = NAN};
                continue;
            }
            for (int i = 0; i < key->n_levels; i++)
                value[i][0] = convergence_study_value(study, members, key->member[i], q, f);
            const double noise = study_noise(study, members, stated, q, f, false);
            if (!is_choice) {
                *part = convergence_judge(&levels, (const double(*)[2])value, noise);
                continue;
            }
            const double base = convergence_study_value(study, members, stated, q, f);
            *part = (struct convergence_result){.finest_error = NAN, .order = NAN};
            for (int i = 0; i < key->n_levels; i++) {
                const double change = fabs(value[i][0] - base);
                part->error = isnan(change) ? NAN : fmax(part->error, change);
            }
            part->verdict = part->error <= of_noise * noise * fabs(base) ? CONVERGENCE_NONE : CONVERGENCE_ACCEPTED;
        }
    }
    if (key->row->kind == SWEEP_MODEL) return;

    // the logarithmic slope of the wall time over the resolution, from the coarsest to the finest level
    const int last = key->n_levels - 1;
    const double ratio = cost_of(study, members, key->member[0]) / cost_of(study, members, key->member[last]);
    const double exponent = log(ratio) / log(size[last] / size[0]);
    key->cost_exponent = isfinite(exponent) ? fmin(4, fmax(0, exponent)) : 1;
}

/* Whether a key is a numerical one whose error contributes to the sum. */
static bool is_error(const struct error_study_key *key) {
    return key->row->kind != SWEEP_MODEL && key->row->kind != SWEEP_INPUT && key->n_levels > 1;
}

/* An error over the stated value of its quantity. */
static double relative(const struct error_study *study, int place, double error) {
    return error > 0 ? error / fabs(study->value[place]) : error;
}

/* The quantity and the fish with the largest relative error; an unknown error is the largest. */
static int find_worst(const struct error_study *study) {
    int worst = 0;
    for (int q = 0; q < study->n_asked; q++) {
        for (int f = 0; f < (member_file_quantity(study->quantity[q])->of_fish ? study->n_fish : 1); f++) {
            const int place = error_plan_place(study, q, f);
            const double error = relative(study, place, study->error[place]);
            if (isnan(error)) return place;
            if (error > relative(study, worst, study->error[worst])) worst = place;
        }
    }

    return worst;
}

/* The error of the differences from which a multiplier follows, which is no part of any key; of a ratio or a change,
 * that of both multipliers. */
static double error_of_differences(const struct error_study *study, const struct member_file *members) {
    static const char multiplier[] = "steady_multiplier", error[] = "steady_multiplier_error";
    const struct member_file *const own = &members[study->stated];
    if (study->relation == ERROR_VALUE) return member_file_number(own, error, 0);
    const struct member_file *const other = &members[twin_of(study, study->stated)];
    const double part = study->relation == ERROR_CHANGE
                            ? 1
                            : member_file_number(own, multiplier, 0) / member_file_number(other, multiplier, 0);
    const double sum = member_file_number(own, error, 0) + fabs(part) * member_file_number(other, error, 0);
    return study->relation == ERROR_CHANGE ? sum : sum / member_file_number(other, multiplier, 0);
}

/* What the sheet of the levels of the nodes adds to a value. The finest levels together have it, too, although the
 * sheet is not varied. */
static double value_with_sheet(const struct error_study *study, const struct member_file *members, int q, int f) {
    const struct error_study_key *nodes = NULL;
    for (int k = 0; k < study->n_keys; k++) {
        const struct error_study_key *const key = &study->key[k];
        if (strcmp(key->row->path, "fish.sheet_points") == 0 && key->n_levels > 1) return 0;
        if (strcmp(key->row->path, "fish.nodes") == 0 && key->n_levels > 1) nodes = key;
    }
    if (!nodes || nodes->stated != nodes->first_stated) return 0;
    return convergence_study_value(study, members, nodes->member[nodes->stated], q, f) -
           convergence_study_value(study, members, study->base, q, f);
}

void convergence_study_judge(struct error_study *study, const struct member_file *members) {
    for (int k = 0; k < study->n_keys; k++) {
        struct error_study_key *const key = &study->key[k];
        if (key->n_levels == 1) continue;
        judge_key(study, members, key);
    }

    // the stated value and its error
    int n_moved = 0;
    for (int k = 0; k < study->n_keys; k++) n_moved += study->key[k].stated != study->key[k].first_stated;
    for (int q = 0; q < study->n_asked; q++) {
        for (int f = 0; f < study->n_fish; f++) {
            const int place = error_plan_place(study, q, f);
            const double base = convergence_study_value(study, members, study->base, q, f);
            double sum = 0, shift = 0, squares = 0, moved = base, apart = 0;
            study->value[place] = convergence_study_value(study, members, study->stated, q, f);
            for (int k = 0; k < study->n_keys; k++) {
                const struct error_study_key *const key = &study->key[k];
                if (!is_error(key)) continue;
                const double stated = convergence_study_value(study, members, key->member[key->stated], q, f);
                sum += key->part[place].error;
                shift += key->part[place].shift;
                squares += key->part[place].spread * key->part[place].spread;
                moved += stated - convergence_study_value(study, members, key->member[key->first_stated], q, f);
                apart += convergence_study_value(study, members, key->member[0], q, f) - stated;
            }

            // the finest levels together, less the sum of the finest levels apart; the keys of a study without such a
            // member add up, but for those that are refined
            const double with_sheet = value_with_sheet(study, members, q, f);
            const double interaction = study->finest < 0
                                           ? 0
                                           : convergence_study_value(study, members, study->finest, q, f) -
                                                 (study->value[place] + with_sheet) - apart;
            const double unsigned_part = study->finest < 0 && n_moved > 1 ? fabs(study->value[place] - moved) : 0;
            study->parts[place] = sum;
            study->shift[place] = shift + interaction;
            study->together[place] = fabs(shift + interaction) - fabs(shift) + unsigned_part;

            // nothing is known more exactly than the noise
            const bool is_of_mode = is_multiplier(member_file_quantity(study->quantity[q])->name);
            const double size = fabs(study->value[place]);
            const bool is_itself = study->relation != ERROR_VALUE && twin_of(study, study->stated) == study->stated &&
                                   error_plan_twin_fish(study, f) == f;
            study->of_noise[place] = is_of_mode ? error_of_differences(study, members)
                                     : is_itself || !(size > 0)
                                         ? 0
                                         : size * study_noise(study, members, study->stated, q, f, false);
            study->error[place] = fabs(study->shift[place]) + sqrt(squares) + unsigned_part + study->of_noise[place];
            if (isnan(sum) || study->study->error->sensitivity) study->error[place] = NAN;

            // uncertain inputs are independent of each other and of the numerical errors
            double inputs = 0;
            for (int k = 0; k < study->n_keys; k++) {
                const struct error_study_key *const key = &study->key[k];
                if (key->slope && key->n_levels > 1) inputs += key->part[place].error * key->part[place].error;
            }
            study->inputs[place] = sqrt(inputs);
            study->error[place] = hypot(study->error[place], study->inputs[place]);

            // the lowest and the highest value with other choices of the model: the stated value plus the change of the
            // case by the choice
            const double stated = study->value[place];
            study->lowest[place] = study->highest[place] = (struct error_study_model){stated, -1, 0};
            for (int k = 0; k < study->n_keys; k++) {
                const struct error_study_key *const key = &study->key[k];
                for (int i = 0; i < key->n_levels && key->n_levels > 1 && key->row->kind == SWEEP_MODEL; i++) {
                    const double value = stated + convergence_study_value(study, members, key->member[i], q, f) - base;
                    const struct error_study_model model = {value, k, i};
                    if (value < study->lowest[place].value) study->lowest[place] = model;
                    if (value > study->highest[place].value) study->highest[place] = model;
                }
            }
        }
    }

    study->noise = study_noise(study, members, study->stated, 0, 0, false);
    study->cost = cost_of(study, members, study->stated) / cost_of(study, members, study->base);
    const double within = study->study->error->within;
    const int worst = find_worst(study);
    study->is_reached = !(within > 0) || relative(study, worst, study->error[worst]) <= within;
}

void convergence_sweep_judge(struct error_sweep *sweep, const struct member_file *members) {
    if (sweep->ratio) convergence_sweep_judge(sweep->ratio, members);
    if (sweep->change) convergence_sweep_judge(sweep->change, members);
    if (sweep->against && sweep->ratio) convergence_study_judge(sweep->against, members);
    for (int p = 0; p < sweep->n_points; p++) convergence_study_judge(&sweep->point[p], members);

    // a point that is not full takes the largest relative errors of the keys that only the full points vary
    const struct error_study *const first = &sweep->point[0];
    for (int place = 0; place < first->n_asked * first->n_fish; place++) {
        double largest[SWEEP_N_ERROR_KEYS] = {0};
        for (int p = 0; p < sweep->n_points; p++) {
            const struct error_study *const point = &sweep->point[p];
            for (int k = 0; k < point->n_keys && point->is_full; k++) {
                const double part = fabs(point->key[k].part[place].error / point->value[place]);
                if (!is_error(&point->key[k])) continue;
                double *const most = &largest[point->key[k].row - sweep_error_keys];
                *most = isnan(part) || part > *most ? part : *most;
            }
        }
        for (int p = 0; p < sweep->n_points; p++) {
            struct error_study *const point = &sweep->point[p];
            double sum = 0;
            for (int i = 0; i < SWEEP_N_ERROR_KEYS && !point->is_full; i++) {
                bool is_varied = false;
                for (int k = 0; k < point->n_keys; k++) is_varied |= point->key[k].row == &sweep_error_keys[i];
                if (!is_varied) sum += largest[i];
            }
            point->shared[place] = sum * fabs(point->value[place]);
            point->error[place] += point->shared[place];
        }
    }
}

// ---- refinement

/* The predicted error of a quantity with the stated value at the next finer level, with or without a member; NaN: not
 * predictable. The error decreases if the levels have an order, or if a coarse stated value has a larger error than the
 * finest level. */
static bool is_movable(const struct error_study_key *key, const struct convergence_result *part) {
    return !convergence_is_flagged(part->verdict) || (part->verdict == CONVERGENCE_HIGH && key->stated > 1);
}

static double next_error(const struct error_study *study, const struct member_file *members,
                         const struct error_study_key *key, double next, int place) {
    const struct convergence_result *const part = &key->part[place];
    const int q = place / study->n_fish, f = place % study->n_fish;
    if (!is_movable(key, part)) return NAN;
    if (part->verdict == CONVERGENCE_NONE) return part->error;
    if (key->stated > 0) {
        return part->finest_error + fabs(convergence_study_value(study, members, key->member[key->stated - 1], q, f) -
                                         convergence_study_value(study, members, key->member[0], q, f));
    }
    const double order = fmin(sweep_error_order(study->values, key->row), part->order);  // fmin ignores NaN
    return part->finest_error * pow(error_plan_size(key->row, next) / error_plan_size(key->row, key->value[0]), order);
}

struct error_study_next convergence_study_next(struct error_study *study, const struct member_file *members) {
    double most = 0;
    struct error_study_next next = {
        .key = -1, .place = find_worst(study), .value = NAN, .cost = NAN, .part = NAN, .sum = NAN};
    for (int k = 0; k < study->n_keys; k++) {
        const struct error_study_key *const key = &study->key[k];
        const struct convergence_result *const part = &key->part[next.place];
        if (!is_error(key) || part->verdict == CONVERGENCE_NONE || !(part->error > most)) continue;
        most = part->error;
        next.key = k;
    }
    if (next.key < 0 || isnan(study->error[next.place])) return next;

    // the next finer level: a member, or a new level
    struct error_study_key *const key = &study->key[next.key];
    const bool has_room = key->n_levels < ERROR_STUDY_LEVELS && key->n_added < MOST_ADDED;
    if (key->stated > 0 && is_movable(key, &key->part[next.place])) {
        next.value = key->value[key->stated - 1];
        next.is_member = true;
        next.cost =
            cost_of(study, members, key->member[key->stated - 1]) / cost_of(study, members, key->member[key->stated]);
    } else if (has_room) {
        next.value = error_plan_find_level(study, next.key, key->value[0], key->row->finer);
        const double ratio = error_plan_size(key->row, key->value[key->stated]) / error_plan_size(key->row, next.value);
        next.cost = pow(ratio, key->cost_exponent);
    }
    if (isnan(next.value)) return next;
    next.cost = fmax(1, next.cost);  // short runs have noisy times

    // predict the error of the worst quantity by the refined key, and the largest error of all keys; shift and spread
    // of the refined key fall together
    next.part = relative(study, next.place, next_error(study, members, key, next.value, next.place));
    next.sum = isnan(next.part) ? NAN : 0;
    for (int place = 0; place < study->n_asked * study->n_fish; place++) {
        const double now = key->part[place].error, then = next_error(study, members, key, next.value, place);
        const double part = isnan(then) || !(now > 0) ? 1 : then / now;
        double shift = study->shift[place], squares = 0;
        for (int k = 0; k < study->n_keys; k++) {
            if (!is_error(&study->key[k])) continue;
            const struct convergence_result *const of = &study->key[k].part[place];
            const double factor = k == next.key ? part : 1;
            shift += (factor - 1) * of->shift;
            squares += factor * factor * of->spread * of->spread;
        }
        const double rest = study->of_noise[place] + (study->finest < 0 ? study->together[place] : 0);
        const double sum = relative(study, place, fabs(shift) + sqrt(squares) + rest);
        if (sum > next.sum) next.sum = sum;
    }
    return next;
}

int convergence_study_refine(struct error_study *study, const struct member_file *members, int most_members) {
    while (!study->is_reached) {
        const struct error_study_next next = convergence_study_next(study, members);
        const bool is_useful = next.key >= 0 && !isnan(next.value) && !isnan(study->error[next.place]);
        if (!is_useful || study->cost * next.cost > study->study->error->most) return 0;
        const int n_before = study->study->sweep[0].n_values, stated = study->stated, finest = study->finest;
        const struct error_study_key before = study->key[next.key];

        // move to the next finer level, or insert a finer level
        struct error_study_key *const refined = &study->key[next.key];
        int n_new = 0;
        if (next.is_member) {
            refined->stated--;
        } else {
            error_plan_insert(refined, next.value);
            refined->n_added++;
            // more nodes need more sheet points at all levels
            const bool are_nodes = strcmp(refined->row->path, "fish.nodes") == 0;
            for (int i = 0; i < refined->n_levels && are_nodes; i++) refined->member[i] = -1;
            n_new = error_plan_members(study);
        }

        // find or add the member with all refined keys at the stated levels
        struct error_plan_change changes[SWEEP_N_ERROR_KEYS];
        int n = 0;
        bool is_new = false;
        for (int k = 0; k < study->n_keys; k++) {
            const struct error_study_key *const key = &study->key[k];
            if (key->stated != key->first_stated) changes[n++] = (struct error_plan_change){k, key->value[key->stated]};
        }
        if (n > 0) study->stated = error_plan_member(study, n, changes, study->stated, &is_new);
        n_new += is_new;

        if (study->study->sweep[0].n_values > most_members) {
            study->study->sweep[0].n_values = n_before;
            study->stated = stated;
            study->finest = finest;
            study->key[next.key] = before;
            return 0;
        }
        if (n_new > 0) return n_new;
        convergence_study_judge(study, members);
    }

    return 0;
}

void convergence_study_say_cost(const struct error_study *study, char words[CONVERGENCE_BYTES]) {
    const double within = study->study->error->within;
    double part[ERROR_STUDY_KEYS], ratio[ERROR_STUDY_KEYS], order[ERROR_STUDY_KEYS], sum = 0, fixed = 0, cost = 1;
    const int place = find_worst(study);
    const char *worst = "";

    for (int k = 0; k < study->n_keys; k++) {
        const struct error_study_key *const key = &study->key[k];
        const bool is_fixed = !is_error(key) || key->part[place].verdict != CONVERGENCE_ACCEPTED;
        part[k] = is_error(key) ? relative(study, place, key->part[place].error) : 0;
        order[k] = is_fixed ? NAN : sweep_error_order(study->values, key->row);
        ratio[k] = 1;
        sum += part[k];
        if (is_fixed && part[k] > within / 2) worst = key->row->path;
        fixed += is_fixed ? part[k] : 0;
    }

    if (fixed > 0.9 * within || isnan(study->error[place])) {
        snprintf(words, CONVERGENCE_BYTES, "the errors of keys that are flagged or unknown cannot be predicted%s%s",
                 *worst ? ": " : "", worst);
        return;
    }

    // refine the largest part first, in steps of 10 %
    const double step = 1.1;
    while (sum > within) {
        int k = -1;
        for (int i = 0; i < study->n_keys; i++) {
            if (!isnan(order[i]) && (k < 0 || part[i] > part[k])) k = i;
        }
        const double fallen = part[k] * pow(step, -order[k]);
        sum -= part[k] - fallen;
        part[k] = fallen;
        ratio[k] *= step;
        cost *= pow(step, study->key[k].cost_exponent);
    }

    int length = 0;
    for (int k = 0; k < study->n_keys; k++) {
        const struct error_study_key *const key = &study->key[k];
        if (!(ratio[k] > 1)) continue;
        const double value = key->value[key->stated];
        length += snprintf(words + length, (size_t)(CONVERGENCE_BYTES - length), "%s%s %.3g", length > 0 ? ", " : "",
                           key->row->path,
                           key->row->kind == SWEEP_POINTS ? 1 + round((value - 1) * ratio[k]) : value / ratio[k]);
        if (length >= CONVERGENCE_BYTES) return;
    }

    if (length == 0) {
        snprintf(words, CONVERGENCE_BYTES, "the interaction of the refined keys exceeds it: start from finer values");
        return;
    }
    snprintf(words + length, (size_t)(CONVERGENCE_BYTES - length), ": about %.2g times the CPU time", cost);
}
