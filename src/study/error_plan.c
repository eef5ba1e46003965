/* error_plan.c: keys, levels and members of an error study. */
#include "study/error_plan.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "case/case.h"
#include "case/case_table.h"
#include "case/sweep.h"
#include "fish/fish_school.h"
#include "school/warnings.h"
#include "steady/steady_problem.h"

static const char what[] = "the errors of a study"; /* in messages on memory */

int error_plan_place(const struct error_study *study, int quantity, int fish) {
    return quantity * study->n_fish + fish;
}

void error_plan_free(struct error_study *study) {
    for (int k = 0; k < study->n_keys; k++) free(study->key[k].part);
    free(study->value);
    free(study->error);
    free(study->together);
    case_free(&study->study);
    *study = (struct error_study){0};
}

// ---- columns: the keys that every member sets

static struct sweep_axis *axis_of(const struct error_study *study) {
    return &study->study.sweep[0];
}

/* The number of fish, or 1 for a key of the whole case. */
static int n_owners(const struct case_values *values, const char *path) {
    return case_table_is_of_fish(case_table_row(path)) ? values->school.n_fish : 1;
}

/* The field of a key; fish is ignored unless the key is of a fish. */
static const void *field_of(const struct case_values *values, const char *path, int fish) {
    return case_table_field(case_table_row(path), (struct case_values *)(uintptr_t)values, &values->school.fish[fish]);
}

/* Whether the case gives the value of a key as a duration in beats. */
static int is_in_beats(const struct case_values *values, const char *path) {
    if (case_table_row(path)->type != DURATION) return 0;
    return !isnan(((const struct duration *)field_of(values, path, 0))->beats);
}

/* The value of a key, in beats if the case gives a duration in beats. */
static double plan_number_of(const struct case_values *values, const char *path, int fish) {
    const struct key *const key = case_table_row(path);
    const void *const field = field_of(values, path, fish);
    if (is_in_beats(values, path)) return ((const struct duration *)field)->beats;

    // a duration begins with its seconds
    return key->type == REAL || key->type == DURATION ? *(const double *)field : *(const int *)field;
}

static int are_fish_alike(const struct case_values *values, const char *path) {
    for (int f = 1; f < n_owners(values, path); f++) {
        if (fabs(plan_number_of(values, path, f) - plan_number_of(values, path, 0)) > 0) return 0;
    }
    return 1;
}

/* The text of a value, in the unit of plan_number_of. */
static char *text_of(const struct case_values *values, const struct key *key, double value) {
    struct text text = {0};
    if (key->type == CHOICE) {
        text_add(&text, "%s", key->words[(int)value]);
    } else {
        text_add_number(&text, value);
        text_add(&text, "%s", is_in_beats(values, key->path) ? " beats" : "");
    }
    return text.text;
}

/* Add a key to the axis, per fish if the fish differ, with the value of the case in row 0. */
static enum status add_columns(struct error_study *study, const struct case_values *values, const char *path) {
    struct sweep_axis *const axis = axis_of(study);
    const struct key *const key = case_table_row(path);
    const int are_alike = are_fish_alike(values, path), n = are_alike ? 1 : n_owners(values, path);
    TRY(MEMORY_RESIZE(axis->key, axis->n_keys + n, what));
    TRY(MEMORY_RESIZE(axis->value, axis->n_keys + n, what));

    for (int f = 0; f < n; f++) {
        // "fish[*].nodes", or "fish[2].nodes" if the fish differ
        struct text text = {0};
        if (!case_table_is_of_fish(key)) {
            text_add(&text, "%s", path);
        } else if (are_alike) {
            text_add(&text, "fish[*]%s", path + 4);
        } else {
            text_add(&text, "fish[%d]%s", f, path + 4);
        }
        axis->value[axis->n_keys] = text_of(values, key, plan_number_of(values, path, f));
        axis->key[axis->n_keys++] = (struct sweep_key){
            .path = text.text, .row = key->path, .unit = key->unit, .is_number = key->type != CHOICE};
        if (!axis->value[axis->n_keys - 1] || !text.text) return memory_check(NULL, what);
    }

    return STATUS_OK;
}

// the columns of further fish follow
int error_plan_column(const struct error_study *study, const char *path) {
    const struct sweep_axis *const axis = axis_of(study);
    for (int c = 0; c < axis->n_keys; c++) {
        if (strcmp(axis->key[c].row, path) == 0) return c;
    }
    return -1;
}

// ---- rows: the members

/* A new row of the axis. */
struct row {
    const struct error_study *study;
    char **value;    /* (n_keys of the axis) */
    int is_combined; /* several keys are refined */
    int failed;
};

static void row_set(struct row *row, const char *path, int fish, double value) {
    const int column = error_plan_column(row->study, path);
    if (column < 0) return;
    const int c = are_fish_alike(&row->study->study, path) ? column : column + fish;

    // if two refined keys set the same points, the finer value counts
    double now;
    const int are_points = strcmp(path, "fish.sheet_points") == 0;
    if (row->is_combined && are_points && text_number(row->value[c], &now) && now > value) return;
    free(row->value[c]);
    row->value[c] = text_of(&row->study->study, case_table_row(path), value);
    if (!row->value[c]) row->failed = 1;
}

/* The sheet points of a fish for the finest level of the nodes; all levels of the nodes use the same sheet. */
static double sheet_for(const struct error_study *study, double finest, int f) {
    const struct case_values *const values = &study->study;
    const double part = fmax(1, finest / plan_number_of(values, "fish.nodes", 0));
    const double nodes = round(part * plan_number_of(values, "fish.nodes", f));
    return fmax(plan_number_of(values, "fish.sheet_points", f), 2 * nodes - 1);
}

/* Set the times that must be multiples of the interval; the end time has no effect on a steady state. */
static void set_times(struct row *row, double interval) {
    const struct case_values *const values = &row->study->study;
    const double beat = row->study->beat;
    if (row->study->is_steady && beat > 0) row_set(row, "time.end", 0, beat * ceil(values->time.end / beat - 1e-9));
    row_set(row, "time.checkpoint_interval", 0, 0);
    const double output = interval * fmax(1, round(values->time.output_interval / interval));
    row_set(row, "time.output_interval", 0, output);
    row_set(row, "output.wake_interval", 0, output * fmax(1, round(values->output.wake_interval / output)));
    if (values->solver.step > 0) row_set(row, "solver.step", 0, interval / ceil(interval / values->solver.step - 1e-9));
}

static void row_apply(struct row *row, const struct error_plan_change *change) {
    const struct error_study *const study = row->study;
    const struct case_values *const values = &study->study;
    const struct error_study_key *const key = &study->key[change->key];
    const char *const path = key->row->path, *const companion = key->row->companion;
    const double part = change->value / plan_number_of(values, path, 0);
    const int are_nodes = strcmp(path, "fish.nodes") == 0;

    if (!are_nodes && !(fabs(part - 1) > 1e-12)) return;
    for (int f = 0; f < n_owners(values, path); f++) {
        const double value = f == 0 ? change->value : part * plan_number_of(values, path, f);
        row_set(row, path, f, key->row->kind == SWEEP_POINTS ? round(value) : value);
        if (!are_nodes) continue;
        const double finest = fmax(change->value, key->n_levels > 0 ? key->value[0] : 0);
        row_set(row, "fish.sheet_points", f, sheet_for(study, finest, f));
    }

    if (companion) row_set(row, companion, 0, part * plan_number_of(values, companion, 0));
    if (strcmp(path, "time.shedding_interval") == 0) set_times(row, change->value);
}

/* Free a row outside the axis. */
static void row_free(struct row *row) {
    for (int c = 0; row->value && c < axis_of(row->study)->n_keys; c++) free(row->value[c]);
    free(row->value);
}

/* Whether a quantity of the modes of small disturbances is requested. */
static int asks_for_modes(const struct error_study *study) {
    for (int q = 0; q < study->n_asked; q++) {
        if (strncmp(member_file_quantity(study->quantity[q])->name, "steady_growth", 13) == 0) return 1;
    }
    return 0;
}

/* The row of the case with some changes. */
static enum status make_row(const struct error_study *study, int n, const struct error_plan_change *changes,
                            struct row *row) {
    const struct sweep_axis *const axis = axis_of(study);
    *row = (struct row){study, NULL, n > 1, 0};
    TRY(MEMORY_NEW(row->value, axis->n_keys, what));
    for (int c = 0; c < axis->n_keys; c++) {
        row->value[c] = strdup(axis->value[c]);
        if (!row->value[c]) row->failed = 1;
    }

    // only the case itself has multipliers, unless all members need multipliers
    if (!asks_for_modes(study)) row_set(row, "steady.multipliers", 0, NO);
    for (int i = 0; i < n; i++) row_apply(row, &changes[i]);
    if (!row->failed) return STATUS_OK;

    row_free(row);
    return memory_check(NULL, what);
}

/* The member with the values of a row, except for multipliers; -1: none. */
static int plan_find_row(const struct error_study *study, const struct row *row) {
    const struct sweep_axis *const axis = axis_of(study);
    const int ignored = error_plan_column(study, "steady.multipliers");
    for (int m = 0; m < axis->n_values; m++) {
        int is_same = 1;
        for (int c = 0; c < axis->n_keys && is_same; c++) {
            is_same = c == ignored || strcmp(axis->value[m * axis->n_keys + c], row->value[c]) == 0;
        }
        if (is_same) return m;
    }
    return -1;
}

/* Append a row to the axis, which takes over the values; the search of the member starts from the member before. */
static enum status row_append(struct error_study *study, struct row *row, int before, int *member) {
    struct sweep_axis *const axis = axis_of(study);
    const size_t n = (size_t)axis->n_keys, n_values = (size_t)axis->n_values + 1;
    enum status status = MEMORY_RESIZE(axis->value, n * n_values, what);
    if (status == STATUS_OK) status = MEMORY_RESIZE(axis->before, n_values, what);
    if (status != STATUS_OK) {
        row_free(row);
        return status;
    }

    memcpy(axis->value + n * (n_values - 1), row->value, n * sizeof *axis->value);
    axis->before[n_values - 1] = before;
    free(row->value);
    *member = axis->n_values++;
    return STATUS_OK;
}

enum status error_plan_member(struct error_study *study, int n, const struct error_plan_change *changes, int before,
                              int *member, int *is_new) {
    struct row row;
    TRY(make_row(study, n, changes, &row));
    *member = plan_find_row(study, &row);
    *is_new = *member < 0;
    if (*is_new) return row_append(study, &row, before, member);
    row_free(&row);
    return STATUS_OK;
}

void error_plan_shorten(struct error_study *study, int n_values) {
    struct sweep_axis *const axis = axis_of(study);
    for (; axis->n_values > n_values; axis->n_values--) {
        for (int c = 0; c < axis->n_keys; c++) free(axis->value[(axis->n_values - 1) * axis->n_keys + c]);
    }
}

/* Whether a level of a key is a valid case. Fails with STATUS_MEMORY. */
static enum status test_level(struct error_study *study, int k, double value, int *is_valid) {
    struct row row;
    struct case_values member;
    int number;
    TRY(make_row(study, 1, &(struct error_plan_change){k, value}, &row));
    TRY(row_append(study, &row, -1, &number));
    const enum status status = case_member(&member, &study->study, number);
    *is_valid = status == STATUS_OK;
    if (status == STATUS_OK) case_free(&member);
    error_plan_shorten(study, number);
    return status == STATUS_MEMORY ? status : STATUS_OK;
}

// ---- levels

static int is_finer(const struct sweep_error_key *row, double a, double b) {
    return row->kind == SWEEP_POINTS || row->kind == SWEEP_DURATION ? a > b : a < b;
}

double error_plan_size(const struct sweep_error_key *row, double value) {
    return row->kind == SWEEP_POINTS ? 1 / (value - 1) : row->kind == SWEEP_DURATION ? 1 / value : value;
}

// unless the value is a level already
void error_plan_insert(struct error_study_key *key, double value) {
    if (key->n_levels == ERROR_STUDY_LEVELS) return;
    int i = 0;
    while (i < key->n_levels && is_finer(key->row, key->value[i], value)) i++;
    if (i < key->n_levels && !(fabs(key->value[i] - value) > 1e-12 * value)) return;

    for (int j = key->n_levels; j > i; j--) {
        key->value[j] = key->value[j - 1];
        key->member[j] = key->member[j - 1];
    }

    key->value[i] = value;
    key->member[i] = -1;
    key->n_levels++;
    if (i <= key->stated && key->n_levels > 1) key->stated++;
    if (i <= key->first_stated && key->n_levels > 1) key->first_stated++;
}

enum status error_plan_find_level(struct error_study *study, int k, double from, double factor, double *level) {
    const struct case_values *const values = &study->study;
    const struct error_study_key *const key = &study->key[k];
    const int is_interval = strcmp(key->row->path, "time.shedding_interval") == 0;
    const int is_step = strcmp(key->row->path, "solver.step") == 0;
    const double run = study->is_steady && study->beat > 0 ? study->beat : values->time.end;
    const double whole = is_step ? values->school.shedding_interval : run;
    const double target = is_interval || is_step ? whole / (from * factor) : from * factor;

    *level = NAN;
    int is_valid;
    if (key->row->kind != SWEEP_POINTS && !is_interval && !is_step) {
        TRY(test_level(study, k, target, &is_valid));
        if (is_valid) *level = target;
        return STATUS_OK;
    }

    // integers around the target
    for (int j = 0; j <= target / 4; j++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            const double n = floor(target + 0.5) + sign * j, value = is_interval || is_step ? whole / n : n;
            const int is_same = !(fabs(value - from) > 1e-9 * from);
            if (n < 1 || is_same || is_finer(key->row, value, from) != is_finer(key->row, from * factor, from))
                continue;
            TRY(test_level(study, k, value, &is_valid));
            if (!is_valid) continue;
            *level = value;
            return STATUS_OK;
        }
        // other numbers of points or steps would be refused, too
        if (!is_interval) return STATUS_OK;
    }

    return STATUS_OK;
}

/* Add a level near from*factor; *is_there: such a level exists. */
static enum status add_level(struct error_study *study, int k, double from, double factor, int *is_there) {
    double level;
    *is_there = 0;
    if (!(factor > 0)) return STATUS_OK;
    TRY(error_plan_find_level(study, k, from, factor, &level));
    *is_there = !isnan(level);
    if (*is_there) error_plan_insert(&study->key[k], level);
    return STATUS_OK;
}

/* Add the levels of the table: coarser levels, and a finer level with confirm. Finer levels replace invalid coarser
 * levels. */
static enum status add_default_levels(struct error_study *study, int k) {
    struct error_study_key *const key = &study->key[k];
    const struct sweep_error_key *const row = key->row;
    const double base = key->value[0];
    int is_there, n_missing = 0, n_finer = row->kind == SWEEP_MODEL || study->study.error->confirm;

    // the far wake converges with the design order only after two halvings of the spacing
    if (row->kind == SWEEP_DURATION) n_finer *= 2;
    for (int i = 0; i < 2; i++) {
        if (!(row->coarser[i] > 0)) continue;
        TRY(add_level(study, k, base, row->coarser[i], &is_there));
        n_missing += !is_there;
    }

    // four levels all the same: three would be judged by twice the largest difference
    if (row->kind != SWEEP_DURATION) n_finer += n_missing;
    for (int i = 0; i < n_finer; i++) TRY(add_level(study, k, key->value[0], row->finer, &is_there));
    return STATUS_OK;
}

// ---- keys

/* Whether a key affects the results of this case. */
static int is_used(const struct error_study *study, const struct sweep_error_key *row) {
    const struct case_values *const values = &study->study;
    const double value = plan_number_of(values, row->path, 0);
    const int is_wake = strncmp(row->path, "wake.", 5) == 0, has_fluid = values->school.fluid.density > 0;

    // an equilibrium has no events, but the wake of the modes is shed at events
    const int is_interval = strcmp(row->path, "time.shedding_interval") == 0;
    if (study->is_static) return row->kind == SWEEP_POINTS || (is_interval && asks_for_modes(study));
    if (strcmp(row->path, "solver.rtol") == 0) return !(values->solver.step > 0);
    if (strcmp(row->path, "solver.step") == 0) return values->solver.step > 0;
    if (strcmp(row->path, "fish.nodes") != 0 && !has_fluid) return 0;
    if (row->kind == SWEEP_DURATION && !study->is_steady) {
        return row->coarser[0] * values->school.wake.lifetime.seconds < values->time.end;
    }

    return !is_wake || value > 0;
}

/* Add all varied keys, without levels. */
static enum status choose_keys(struct error_study *study) {
    const struct sweep_error *const error = study->study.error;
    for (int i = 0; i < SWEEP_N_ERROR_KEYS; i++) {
        const struct sweep_error_key *const row = &sweep_error_keys[i];
        int is_wanted = error->n_keys == 0;
        for (int k = 0; k < error->n_keys; k++) is_wanted |= error->levels[k].key == row;
        if (!is_wanted || !is_used(study, row)) continue;

        struct error_study_key *const key = &study->key[study->n_keys++];
        *key = (struct error_study_key){.row = row,
                                        .unit = is_in_beats(&study->study, row->path) ? " beats" : "",
                                        .n_levels = 1,
                                        .value = {plan_number_of(&study->study, row->path, 0)},
                                        .member = {-1}};
        TRY(MEMORY_NEW(key->part, study->n_asked * study->n_fish, what));
    }

    if (study->n_keys > 0) return STATUS_OK;
    return status_fail(STATUS_CASE, "error.keys: none of these keys changes anything in this case");
}

/* Add the columns of the axis: varied keys, companions of the varied keys, and times that must fit the interval. */
static enum status add_all_columns(struct error_study *study) {
    const struct case_values *const values = &study->study;
    for (int k = 0; k < study->n_keys; k++) {
        const struct sweep_error_key *const row = study->key[k].row;
        if (error_plan_column(study, row->path) < 0) TRY(add_columns(study, values, row->path));
        if (row->companion) TRY(add_columns(study, values, row->companion));
        const int are_nodes = strcmp(row->path, "fish.nodes") == 0;
        if (are_nodes && values->school.fluid.density > 0) TRY(add_columns(study, values, "fish.sheet_points"));
        if (strcmp(row->path, "time.shedding_interval") != 0) continue;
        TRY(add_columns(study, values, "time.end"));
        TRY(add_columns(study, values, "time.checkpoint_interval"));
        TRY(add_columns(study, values, "time.output_interval"));
        TRY(add_columns(study, values, "output.wake_interval"));
    }

    if (error_plan_column(study, "time.shedding_interval") >= 0 && values->solver.step > 0 &&
        error_plan_column(study, "solver.step") < 0) {
        TRY(add_columns(study, values, "solver.step"));
    }

    return study->is_steady ? add_columns(study, values, "steady.multipliers") : STATUS_OK;
}

/* Fill the objections that follow from the case alone. */
static void list_objections(struct error_study *study, const struct school *school) {
    for (int k = 0; k < study->n_keys; k++) {
        struct error_study_key *const key = &study->key[k];
        for (int f = 0; f < school->n_fish && !*key->objection; f++) {
            const struct fish *const fish = &school->fish[f];
            if (strcmp(key->row->path, "fish.sheet_points") == 0 && fish->n_sheet < 2 * fish->n_nodes - 1) {
                snprintf(key->objection, ERROR_BUDGET_BYTES, "%.60s has fewer sheet_points than 2 nodes - 1",
                         fish->name);
            }
            if (strcmp(key->row->path, "fish.nodes") != 0 || !(school->density > 0)) continue;
            if (fish->has_cusp) {
                snprintf(key->objection, ERROR_BUDGET_BYTES, "the tail of %.60s ends in a cusp", fish->name);
                continue;
            }
            const double bending = warnings_bending_length(fish);
            if (!(2 * fish->edge_length > bending)) continue;
            snprintf(key->objection, ERROR_BUDGET_BYTES,
                     "two edges of %.60s are longer than its tail bends over, %.2g m", fish->name, bending);
        }
    }
}

// ---- quantities

static enum status choose_quantities(struct error_study *study) {
    const struct sweep_error *const error = study->study.error;
    for (int i = 0; i < error->n_of; i++) {
        const int q = member_file_quantity_number(error->of[i]);
        const struct member_file_quantity *const quantity = q < 0 ? NULL : member_file_quantity(q);
        if (!quantity || quantity->of_xy || quantity->of_comparison) {
            return status_fail(STATUS_CASE,
                               "error.of: '%.60s' is no number of a result or of a steady state; `shoal keys --output` "
                               "lists them: those over (time), (time, fish), and steady_... over (fish)",
                               error->of[i]);
        }
        for (int j = 0; j < i; j++) {
            if (study->quantity[j] == q) return status_fail(STATUS_CASE, "error.of: %s is there twice", error->of[i]);
        }
        if (i > 0 && quantity->of_steady != study->is_steady) {
            return status_fail(STATUS_CASE, "error.of: %s is of a run and %s of a steady state: ask for one kind",
                               error->of[study->is_steady ? i : 0], error->of[study->is_steady ? 0 : i]);
        }
        if (i == ERROR_STUDY_QUANTITIES) {
            return status_fail(STATUS_CASE, "error.of: more than %d quantities", ERROR_STUDY_QUANTITIES);
        }
        study->is_steady = quantity->of_steady;
        study->quantity[study->n_asked++] = q;
    }

    return STATUS_OK;
}

// ---- the plan

enum status error_plan_members(struct error_study *study, int *n_new) {
    *n_new = 0;
    for (int distance = 0; distance < ERROR_STUDY_LEVELS; distance++) {
        for (int k = 0; k < study->n_keys; k++) {
            struct error_study_key *const key = &study->key[k];
            const int levels[] = {key->stated - distance, key->stated + distance};
            for (int i = 0; i < (distance > 0 ? 2 : 1) && key->n_levels > 1; i++) {
                const int level = levels[i];
                if (level < 0 || level >= key->n_levels || key->member[level] >= 0) continue;

                // the search starts from the neighbour towards the stated level, which already has a member
                const int before = distance == 0 ? 0 : key->member[level + (level < key->stated ? 1 : -1)];
                int is_new;
                TRY(error_plan_member(study, 1, &(struct error_plan_change){k, key->value[level]}, before,
                                      &key->member[level], &is_new));
                *n_new += is_new;
            }
        }
    }

    return STATUS_OK;
}

/* Set the levels of each key: given in the case, or of the table. */
static enum status choose_levels(struct error_study *study) {
    const struct sweep_error *const error = study->study.error;
    for (int k = 0; k < study->n_keys; k++) {
        const struct sweep_error_levels *given = NULL;
        for (int i = 0; i < error->n_keys; i++) {
            if (error->levels[i].key == study->key[k].row && error->levels[i].n > 0) given = &error->levels[i];
        }

        if (!given) TRY(add_default_levels(study, k));
        for (int i = 0; given && i < given->n; i++) {
            int is_valid;
            TRY(test_level(study, k, given->value[i], &is_valid));
            if (!is_valid) {
                return status_fail(STATUS_CASE, "error.keys: level %g: %s", given->value[i], status_message());
            }
            error_plan_insert(&study->key[k], given->value[i]);
        }
        if (study->key[k].n_levels > 1) continue;
        snprintf(study->key[k].objection, ERROR_BUDGET_BYTES, "no other level is a valid case");
    }

    return STATUS_OK;
}

static enum status make_plan(struct error_study *study) {
    TRY(choose_quantities(study));
    study->is_static &= study->is_steady;
    const int n = study->n_asked * study->n_fish;
    TRY(MEMORY_NEW(study->value, n, what));
    TRY(MEMORY_NEW(study->error, n, what));
    TRY(MEMORY_NEW(study->together, n, what));
    TRY(choose_keys(study));

    // an axis without keys and with one value, which is the case
    TRY(MEMORY_NEW(study->study.sweep, 1, what));
    study->study.n_axes = 1;
    struct sweep_axis *const axis = axis_of(study);
    axis->order = axis->within = NAN;
    axis->steady = study->is_steady;
    TRY(MEMORY_NEW(axis->before, 1, what));
    axis->before[0] = -1;
    axis->n_values = 1;

    int n_new;
    TRY(add_all_columns(study));
    TRY(choose_levels(study));
    return error_plan_members(study, &n_new);
}

enum status error_plan_create(struct error_study *study, const struct case_values *values) {
    *study = (struct error_study){0};
    TRY(case_parse(&study->study, values->merged, strlen(values->merged), values->name, NULL, 0, NULL));
    free(study->study.text);
    TRY(memory_copy_string(&study->study.text, values->text, what));
    study->n_fish = values->school.n_fish;
    struct school *school;
    TRY(fish_school_create(&school, &study->study.school));

    for (int f = study->n_fish - 1; f >= 0; f--) {
        if (school->fish[f].period > 0) study->beat = school->fish[f].period;
    }

    study->is_static = steady_static_applies(school);
    const enum status status = make_plan(study);
    if (status == STATUS_OK) list_objections(study, school);
    fish_school_free(school);

    return status;
}
