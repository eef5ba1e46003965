/* error_study.c: judgement of the levels, and refinement. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "case/sweep.h"
#include "study/error_plan.h"

/* Error of a steady state without multipliers over the residual change per beat, unless this ratio is known for the
 * case. */
static const double of_residual = 10;

/* A fixed step has no tolerance; rounding remains. */
static const double rounding = 1e-12;

/* Largest number of added levels per key. */
enum { MOST_ADDED = 3 };

// ---- values of the members

static double errors_value_of(const struct error_study *study, const struct member_file *members, int m, int q, int f) {
    if (m < 0 || !member_file_is_complete(&members[m])) return NAN;
    const int quantity = study->quantity[q];
    return member_file_value(&members[m], quantity, member_file_quantity(quantity)->of_fish ? f : 0, 0);
}

/* The reference length of the error of a search, in body lengths: distance travelled per beat for the speed and derived
 * quantities, tail excursion for a Strouhal number. */
static double lengths_of(const struct error_study *study, const struct member_file *members, int m, int q, int f) {
    const double speed = member_file_number(&members[m], "steady_speed", f);
    const double strouhal = member_file_number(&members[m], "steady_strouhal", f);
    const double way = speed * study->beat / study->study.school.fish[f].length;
    if (study->is_static || !(way > 0)) return 1;
    const int is_tail = strcmp(member_file_quantity(study->quantity[q])->name, "steady_strouhal") == 0;
    return fmin(1, is_tail && strouhal > 0 ? strouhal * way : way);
}

/* The relative error of a value of a member independent of the levels: error of the integrator and of the search. The
 * ratio of search error to residual equals the ratio in the case. */
static double errors_noise_of(const struct error_study *study, const struct member_file *members, int m, int q, int f) {
    const struct sweep_axis *const axis = &study->study.sweep[0];
    const int column = error_plan_column(study, "solver.rtol");
    double rtol = study->study.solver.rtol;

    if (column >= 0) text_number(axis->value[m * axis->n_keys + column], &rtol);
    if (study->study.solver.step > 0) rtol = rounding;
    if (!study->is_steady) return rtol;
    const double error = member_file_number(&members[0], "steady_error", 0);
    const double part = error / member_file_number(&members[0], "steady_residual", 0);
    const double distance =
        member_file_number(&members[m], "steady_residual", 0) * (isfinite(part) ? fmax(1, part) : of_residual);

    return rtol + distance / lengths_of(study, members, m, q, f);
}

/* CPU time of a member for a simulated time common to all members, s, plus a constant, below which the cost is
 * irrelevant. */
static double cost_of(const struct error_study *study, const struct member_file *members, int m) {
    const int is_by_beats = study->is_steady && !study->is_static;
    const double least_beat = 1e-3, least_run = 0.1;
    return member_file_number(&members[m], is_by_beats ? "beat_time" : "wall_time", 0) +
           (is_by_beats ? least_beat : least_run);
}

/* The logarithmic slope of the wall time over the resolution, from the coarsest to the finest level. */
static double cost_exponent_of(const struct error_study *study, const struct member_file *members,
                               const struct error_study_key *key) {
    const int last = key->n_levels - 1;
    const double ratio = cost_of(study, members, key->member[0]) / cost_of(study, members, key->member[last]);
    const double exponent =
        log(ratio) / log(error_plan_size(key->row, key->value[last]) / error_plan_size(key->row, key->value[0]));
    return isfinite(exponent) ? fmin(4, fmax(0, exponent)) : 1;
}

/* The rule of the sheet: doc/model.md, section 8. */
static void object_to_interval(const struct error_study *study, const struct member_file *members,
                               struct error_study_key *key) {
    const struct case_values *const values = &study->study;
    if (strcmp(key->row->path, "time.shedding_interval") != 0 || values->school.wake.shedding != SHEDDING_SHEET) return;
    *key->objection = '\0';
    for (int f = 0; f < study->n_fish && !*key->objection; f++) {
        const struct fish_parameters *const fish = &values->school.fish[f];
        const double speed = member_file_number(&members[0], "speed", f);
        const double needed = 1 + 3.2 / sqrt(fabs(speed) * values->school.shedding_interval / fish->length);
        const double most = 1000;  // a fish that needs more sheet points does not swim
        if (!(fish->sheet_points < needed) || needed > most) continue;
        snprintf(key->objection, ERROR_BUDGET_BYTES, "%.60s needs %.0f sheet_points for this interval", fish->name,
                 ceil(needed));
    }
}

// at most four levels, and three of a duration, because a wake truncated within two body lengths is not yet a far wake
struct error_budget_levels error_study_levels(const struct error_study *study, const struct error_study_key *key,
                                              double *size) {
    for (int i = 0; i < key->n_levels; i++) size[i] = error_plan_size(key->row, key->value[i]);
    return (struct error_budget_levels){.n = key->n_levels,
                                        .n_judged = key->row->kind == SWEEP_DURATION ? 3 : ERROR_BUDGET_LEVELS,
                                        .base = key->stated,
                                        .size = size,
                                        .design_order = sweep_error_order(&study->study, key->row),
                                        .objection = key->objection};
}

/* Judge each requested quantity of each fish by the finest levels of a key. */
static void judge_key(struct error_study *study, const struct member_file *members, struct error_study_key *key) {
    double size[ERROR_STUDY_LEVELS], value[ERROR_STUDY_LEVELS][2] = {{0}};
    const struct error_budget_levels levels = error_study_levels(study, key, size);
    for (int q = 0; q < study->n_asked; q++) {
        for (int f = 0; f < (member_file_quantity(study->quantity[q])->of_fish ? study->n_fish : 1); f++) {
            for (int i = 0; i < key->n_levels; i++) {
                value[i][0] = errors_value_of(study, members, key->member[i], q, f);
            }
            const double noise = errors_noise_of(study, members, key->member[key->stated], q, f);
            key->part[error_plan_place(study, q, f)] = error_budget_judge(&levels, (const double(*)[2])value, noise);
        }
    }
    key->cost_exponent = cost_exponent_of(study, members, key);
}

/* Whether the error of a key contributes to the sum. */
static int errors_is_error(const struct error_study_key *key) {
    return key->row->kind != SWEEP_MODEL && key->n_levels > 1;
}

static void judge_choice(struct error_study *study, const struct member_file *members, struct error_study_key *key) {
    for (int q = 0; q < study->n_asked; q++) {
        for (int f = 0; f < study->n_fish; f++) {
            struct error_budget_result *const part = &key->part[error_plan_place(study, q, f)];
            const double base = errors_value_of(study, members, key->member[key->stated], q, f);
            *part = (struct error_budget_result){.finest_error = NAN, .order = NAN};
            for (int i = 0; i < key->n_levels; i++) {
                const double change = fabs(errors_value_of(study, members, key->member[i], q, f) - base);
                part->error = isnan(change) ? NAN : fmax(part->error, change);
            }
            const double noise = 3 * errors_noise_of(study, members, key->member[key->stated], q, f) * fabs(base);
            part->verdict = part->error <= noise ? ERROR_BUDGET_NONE : ERROR_BUDGET_ACCEPTED;
        }
    }
}

/* Compute the stated value, the error, and the interaction of keys refined together. */
static void sum_errors(struct error_study *study, const struct member_file *members) {
    int n_moved = 0;
    for (int k = 0; k < study->n_keys; k++) n_moved += study->key[k].stated != study->key[k].first_stated;
    for (int q = 0; q < study->n_asked; q++) {
        for (int f = 0; f < study->n_fish; f++) {
            const int place = error_plan_place(study, q, f);
            double sum = 0, moved = errors_value_of(study, members, 0, q, f);
            for (int k = 0; k < study->n_keys; k++) {
                const struct error_study_key *const key = &study->key[k];
                if (!errors_is_error(key)) continue;
                sum += key->part[place].error;
                moved += errors_value_of(study, members, key->member[key->stated], q, f) -
                         errors_value_of(study, members, key->member[key->first_stated], q, f);
            }
            study->value[place] = errors_value_of(study, members, study->stated, q, f);
            study->together[place] = n_moved > 1 ? fabs(study->value[place] - moved) : 0;
            study->error[place] = sum + study->together[place];
        }
    }

    study->noise = errors_noise_of(study, members, study->stated, 0, 0);
    study->cost = cost_of(study, members, study->stated) / cost_of(study, members, 0);
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

void error_study_judge(struct error_study *study, const struct member_file *members) {
    for (int k = 0; k < study->n_keys; k++) {
        struct error_study_key *const key = &study->key[k];
        if (key->n_levels == 1) continue;
        object_to_interval(study, members, key);
        if (errors_is_error(key)) {
            judge_key(study, members, key);
        } else {
            judge_choice(study, members, key);
        }
    }

    sum_errors(study, members);
    const double within = study->study.error->within;
    const int worst = find_worst(study);
    study->is_reached = isnan(within) || relative(study, worst, study->error[worst]) <= within;
}

// ---- refinement

/* Whether the error decreases if the stated value moves to the next finer level: if the levels have an order, or if a
 * coarse stated value has a larger error than the finest level. */
static int is_movable(const struct error_study_key *key, const struct error_budget_result *part) {
    return !error_budget_is_flagged(part->verdict) || (part->verdict == ERROR_BUDGET_HIGH && key->stated > 1);
}

/* The predicted error of a quantity with the stated value at the next finer level, with or without a member; NaN: not
 * predictable. */
static double next_error(const struct error_study *study, const struct member_file *members,
                         const struct error_study_key *key, double next, int place) {
    const struct error_budget_result *const part = &key->part[place];
    const int q = place / study->n_fish, f = place % study->n_fish;
    if (!is_movable(key, part)) return NAN;
    if (part->verdict == ERROR_BUDGET_NONE) return part->error;
    if (key->stated > 0) {
        return part->finest_error + fabs(errors_value_of(study, members, key->member[key->stated - 1], q, f) -
                                         errors_value_of(study, members, key->member[0], q, f));
    }
    const double order = fmin(sweep_error_order(&study->study, key->row), part->order);  // fmin ignores NaN
    return part->finest_error * pow(error_plan_size(key->row, next) / error_plan_size(key->row, key->value[0]), order);
}

/* Predict the errors after a refinement: of the worst quantity by the refined key, and the largest of all keys. */
static void predict(const struct error_study *study, const struct member_file *members, struct error_study_next *next) {
    const struct error_study_key *const key = &study->key[next->key];
    next->part = relative(study, next->place, next_error(study, members, key, next->value, next->place));
    next->sum = isnan(next->part) ? NAN : 0;
    for (int place = 0; place < study->n_asked * study->n_fish; place++) {
        const double now = key->part[place].error, then = next_error(study, members, key, next->value, place);
        const double sum = relative(study, place, study->error[place] + (isnan(then) ? 0 : then - now));
        if (sum > next->sum) next->sum = sum;
    }
}

enum status error_study_find_next(struct error_study *study, const struct member_file *members,
                                  struct error_study_next *next) {
    double most = 0;
    *next = (struct error_study_next){
        .key = -1, .place = find_worst(study), .value = NAN, .cost = NAN, .part = NAN, .sum = NAN};
    for (int k = 0; k < study->n_keys; k++) {
        const struct error_study_key *const key = &study->key[k];
        const struct error_budget_result *const part = &key->part[next->place];
        if (!errors_is_error(key) || part->verdict == ERROR_BUDGET_NONE || !(part->error > most)) continue;
        most = part->error;
        next->key = k;
    }

    if (next->key < 0) return STATUS_OK;

    struct error_study_key *const key = &study->key[next->key];
    const int has_room = key->n_levels < ERROR_STUDY_LEVELS && key->n_added < MOST_ADDED;
    if (key->stated > 0 && is_movable(key, &key->part[next->place])) {
        next->value = key->value[key->stated - 1];
        next->is_member = 1;
        next->cost =
            cost_of(study, members, key->member[key->stated - 1]) / cost_of(study, members, key->member[key->stated]);
    } else if (has_room) {
        TRY(error_plan_find_level(study, next->key, key->value[0], key->row->finer, &next->value));
        const double ratio =
            error_plan_size(key->row, key->value[key->stated]) / error_plan_size(key->row, next->value);
        next->cost = pow(ratio, key->cost_exponent);
    }

    if (isnan(next->value)) return STATUS_OK;
    next->cost = fmax(1, next->cost);  // short runs have noisy times
    predict(study, members, next);

    return STATUS_OK;
}

/* Move to the next finer level, or insert a finer level; then find or add the member with all refined keys at the
 * stated levels. */
static enum status take_step(struct error_study *study, const struct error_study_next *next, int *n_new) {
    struct error_study_key *const refined = &study->key[next->key];
    if (next->is_member) {
        refined->stated--;
    } else {
        error_plan_insert(refined, next->value);
        refined->n_added++;
        // more nodes need more sheet points at all levels
        const int are_nodes = strcmp(refined->row->path, "fish.nodes") == 0;
        for (int i = 0; i < refined->n_levels && are_nodes; i++) refined->member[i] = -1;
        TRY(error_plan_members(study, n_new));
    }

    struct error_plan_change changes[SWEEP_N_ERROR_KEYS];
    int n = 0, is_new;
    for (int k = 0; k < study->n_keys; k++) {
        const struct error_study_key *const key = &study->key[k];
        if (key->stated != key->first_stated) changes[n++] = (struct error_plan_change){k, key->value[key->stated]};
    }
    if (n == 0) return STATUS_OK;
    TRY(error_plan_member(study, n, changes, study->stated, &study->stated, &is_new));
    *n_new += is_new;
    return STATUS_OK;
}

enum status error_study_refine(struct error_study *study, const struct member_file *members, int most_members,
                               int *n_new) {
    *n_new = 0;
    while (!study->is_reached) {
        struct error_study_next next;
        TRY(error_study_find_next(study, members, &next));
        const int is_useful = next.key >= 0 && !isnan(next.value) && !isnan(study->error[next.place]);
        if (!is_useful || study->cost * next.cost > study->study.error->most) return STATUS_OK;
        const int n_before = study->study.sweep[0].n_values, stated = study->stated;
        const struct error_study_key before = study->key[next.key];
        TRY(take_step(study, &next, n_new));
        if (study->study.sweep[0].n_values > most_members) {
            error_plan_shorten(study, n_before);
            study->stated = stated;
            study->key[next.key] = before;
            *n_new = 0;
            return STATUS_OK;
        }
        if (*n_new > 0) return STATUS_OK;
        error_study_judge(study, members);
    }

    return STATUS_OK;
}

void error_study_say_cost(const struct error_study *study, char words[ERROR_BUDGET_BYTES]) {
    const double within = study->study.error->within;
    double part[SWEEP_N_ERROR_KEYS], ratio[SWEEP_N_ERROR_KEYS], order[SWEEP_N_ERROR_KEYS], sum = 0, fixed = 0, cost = 1;
    const int place = find_worst(study);
    const char *worst = "";

    for (int k = 0; k < study->n_keys; k++) {
        const struct error_study_key *const key = &study->key[k];
        const int is_fixed = !errors_is_error(key) || key->part[place].verdict != ERROR_BUDGET_ACCEPTED;
        part[k] = errors_is_error(key) ? relative(study, place, key->part[place].error) : 0;
        order[k] = is_fixed ? NAN : sweep_error_order(&study->study, key->row);
        ratio[k] = 1;
        sum += part[k];
        if (is_fixed && part[k] > within / 2) worst = key->row->path;
        fixed += is_fixed ? part[k] : 0;
    }

    if (fixed > 0.9 * within || isnan(study->error[place])) {
        snprintf(words, ERROR_BUDGET_BYTES, "the errors of keys that are flagged or unknown cannot be predicted%s%s",
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
        length += snprintf(words + length, (size_t)(ERROR_BUDGET_BYTES - length), "%s%s %.3g", length > 0 ? ", " : "",
                           key->row->path,
                           key->row->kind == SWEEP_POINTS ? 1 + round((value - 1) * ratio[k]) : value / ratio[k]);
        if (length >= ERROR_BUDGET_BYTES) return;
    }

    snprintf(words + length, (size_t)(ERROR_BUDGET_BYTES - length), ": about %.2g times the CPU time", cost);
}
