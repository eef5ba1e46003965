/* error_plan.c: chooses keys, levels and members of an error study, and combines what the levels say. */
#include "study/error_plan.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "case/case_table.h"
#include "case/sweep.h"
#include "case/sweep_expect.h"
#include "fish/fish_school.h"
#include "school/warnings.h"
#include "steady/steady_problem.h"
#include "steady/steady_static.h"
#include "study/study_folder.h"

const char *const error_relation_words[N_ERROR_RELATIONS] = {"", "ratio", "change"};

int error_plan_place(const struct error_study *study, int quantity, int fish) {
    return quantity * study->n_fish + fish;
}

// ---- columns: the keys that every member sets

/* The number of fish, or 1 for a key of the whole case. */
static int n_owners(const struct case_values *values, const char *path) {
    return case_table_is_of_fish(case_table_row(path)) ? values->school.n_fish : 1;
}

/* The value of a key in beats; NULL: in seconds. Only the life of a wake is varied in beats; other times must remain
 * multiples of each other, and each point of a sweep has its own seconds. */
static const struct case_beats *plan_in_beats(const struct case_values *values, const char *path) {
    const bool is_of_wake = strncmp(path, "wake.", 5) == 0;
    return is_of_wake ? case_table_in_beats(values, case_table_row(path), 0) : NULL;
}

/* The value of a key, in beats if the case gives it in beats. fish is ignored unless the key is of a fish. */
static double plan_number_of(const struct case_values *values, const char *path, int fish) {
    const struct key *const key = case_table_row(path);
    const void *const field =
        case_table_field(key, (struct case_values *)(uintptr_t)values, &values->school.fish[fish]);
    const struct case_beats *const beats = plan_in_beats(values, path);
    if (beats) return beats->n;
    return key->type == REAL || key->type == DURATION ? *(const double *)field : *(const int *)field;
}

/* The text of a value, in the unit of plan_number_of. */
static char *text_of(const struct error_study *study, const struct key *key, double value) {
    struct arena *const arena = study->sweep->arena;
    if (key->type == CHOICE) return arena_text(arena, "%s", key->words[(int)value]);
    struct text text = {.arena = arena};
    text_add_number(&text, value);
    text_add(&text, "%s", plan_in_beats(study->values, key->path) ? " beats" : "");
    return text.text;
}

/* The fish of a column; -1: of all fish, or of the whole case. */
static int fish_of(const struct sweep_key *column) {
    const bool is_of_one = strncmp(column->path, "fish[", 5) == 0 && column->path[5] != '*';
    return is_of_one ? atoi(column->path + 5) : -1;
}

// of several columns, the last one sets the key; a swept column serves like any other
int error_plan_column(const struct error_study *study, const char *path, int fish) {
    const struct sweep_axis *const axis = &study->study->sweep[0];
    for (int c = axis->n_keys - 1; c >= 0; c--) {
        const int of = fish_of(&axis->key[c]);
        if (strcmp(axis->key[c].row, path) == 0 && (of < 0 || of == fish)) return c;
    }
    return -1;
}

/* Point p; after the points of the sweep, the other case. */
static struct error_study *point_at(const struct error_sweep *sweep, int p) {
    return p < sweep->n_points ? &sweep->point[p] : sweep->against;
}

static int n_all_points(const struct error_sweep *sweep) {
    return sweep->n_points + (sweep->against != NULL);
}

/* Whether one column serves all fish: the fish have equal values at every point, and no single fish is swept, nor is
 * its number an input. */
static bool is_of_all_fish(const struct error_sweep *sweep, const char *path) {
    const struct sweep_axis *const axis = &sweep->study.sweep[0];
    const struct sweep_error *const error = sweep->study.error;
    for (int i = 0; i < error->n_inputs; i++) {
        if (error->input[i].key->name && strcmp(error->input[i].key->path, path) == 0) return false;
    }
    for (int c = 0; c < axis->n_keys; c++) {
        if (strcmp(axis->key[c].row, path) == 0 && fish_of(&axis->key[c]) >= 0) return false;
    }
    for (int p = 0; p < n_all_points(sweep); p++) {
        const struct case_values *const values = point_at(sweep, p)->values;
        for (int f = 1; f < n_owners(values, path); f++) {
            const double own = plan_number_of(values, path, f), first = plan_number_of(values, path, 0);
            if (!(fabs(own - first) <= 0) && !(isnan(own) && isnan(first))) return false;
        }
    }
    return true;
}

/* Add a key to the axis, per fish if the fish differ: "fish[*].nodes", or "fish[2].nodes"; unless the axis has it. */
static void add_columns(struct error_sweep *sweep, const char *path) {
    struct arena *const arena = sweep->arena;
    struct sweep_axis *const axis = &sweep->study.sweep[0];
    const struct key *const key = case_table_row(path);
    // a comparison of all points, which each point asks for
    signed char *const of_all = &sweep->of_all[key - case_table];
    if (*of_all == 0) *of_all = is_of_all_fish(sweep, path) ? 1 : -1;
    const bool is_of_all = *of_all > 0;
    const int n = is_of_all ? 1 : n_owners(&sweep->study, path);
    GROW(arena, axis->key, axis->n_keys + n);
    for (int f = 0; f < n; f++) {
        const int column = error_plan_column(&sweep->point[0], path, f);
        if (column >= 0 && (is_of_all || !case_table_is_of_fish(key) || fish_of(&axis->key[column]) == f)) continue;
        axis->key[axis->n_keys++] =
            (struct sweep_key){.path = !case_table_is_of_fish(key) ? arena_text(arena, "%s", path)
                                       : is_of_all                 ? arena_text(arena, "fish[*]%s", path + 4)
                                                                   : arena_text(arena, "fish[%d]%s", f, path + 4),
                               .row = key->path,
                               .unit = key->unit,
                               .is_number = key->type != CHOICE};
    }
}

// ---- rows: the members

/* A new row of the axis. */
struct row {
    const struct error_study *study;
    char **value;     /* (n_keys of the axis) */
    bool is_combined; /* several keys are refined */
};

static void row_set(const struct row *row, const char *path, int fish, double value) {
    const struct error_study *const study = row->study;
    const int c = error_plan_column(study, path, fish);
    if (c < 0) return;

    // if two refined keys set the same points, the finer value counts
    double now;
    const bool are_points = strcmp(path, "fish.sheet_points") == 0;
    if (row->is_combined && are_points && text_number(row->value[c], &now) && now > value) return;
    row->value[c] = text_of(study, case_table_row(path), value);
}

/* Whether a quantity of the modes of small disturbances is requested. */
static bool asks_for_modes(const struct error_study *study) {
    for (int q = 0; q < study->n_asked; q++) {
        const char *const name = member_file_quantity(study->quantity[q])->name;
        if (strncmp(name, "steady_growth", 13) == 0 || strcmp(name, "steady_multiplier") == 0) return true;
    }
    return false;
}

/* The steps of an input, as parts of it, on both sides or on the one side that its range allows; and the largest
 * tolerance of the search at these steps, which moves a derivative by 4e-4 at most. */
static const double input_steps[] = {0.04, 0.08, 0.16};
static const double input_tolerance = 1e-5;

// level i of an input: below and above the value in turn, from the smallest step to the largest
static double input_level(double value, int i) {
    return value * (1 + (i % 2 ? 1 : -1) * input_steps[i / 2]);
}

// the frequency of a beat: the times that are parts of the beat change with it
static bool moves_beat(const struct sweep_error_key *row) {
    return row->kind == SWEEP_INPUT && !row->name && strcmp(strrchr(row->path, '.'), ".frequency") == 0;
}

/* The row of the case of a point with some changes. */
static struct row make_row(const struct error_study *study, int n, const struct error_plan_change *changes) {
    const struct sweep_axis *const axis = &study->study->sweep[0];
    const struct case_values *const values = study->values;
    struct row row = {study, NULL, n > 1};
    NEW(study->sweep->arena, row.value, axis->n_keys);
    memcpy(row.value, axis->value + (size_t)study->base * (size_t)axis->n_keys,
           (size_t)axis->n_keys * sizeof *row.value);

    // only the case itself has multipliers, unless all members need multipliers
    if (!asks_for_modes(study)) row_set(&row, "steady.multipliers", 0, NO);

    for (const struct error_plan_change *change = changes; change < changes + n; change++) {
        const struct error_study_key *const key = &study->key[change->key];
        const char *const path = key->row->path, *const companion = key->row->companion;
        const bool is_model_input = key->row->kind == SWEEP_INPUT;
        const double part =
            change->value / (is_model_input ? key->value[key->first_stated] : plan_number_of(values, path, 0));
        const bool are_nodes = strcmp(path, "fish.nodes") == 0, is_choice = key->row->n_levels > 0;
        const double stated = key->value[key->first_stated];
        if (!are_nodes && !(fabs(change->value - stated) > 1e-12 * fabs(change->value))) continue;

        // all levels of the nodes use the sheet of the finest level
        const double finest = fmax(change->value, key->n_levels > 0 ? key->value[0] : 0);
        const double nodes_part = fmax(1, finest / plan_number_of(values, "fish.nodes", 0));
        for (int f = 0; f < n_owners(values, path); f++) {
            const bool is_of_one = key->row->name != NULL, is_itself = f == 0 || is_choice || is_of_one;
            if (is_of_one && f != key->row->fish) continue;
            const double value = is_itself ? change->value : part * plan_number_of(values, path, f);
            row_set(&row, path, f, key->row->kind == SWEEP_POINTS ? round(value) : value);
            if (!are_nodes) continue;
            const double nodes = round(nodes_part * plan_number_of(values, "fish.nodes", f));
            row_set(&row, "fish.sheet_points", f, fmax(plan_number_of(values, "fish.sheet_points", f), 2 * nodes - 1));
        }

        if (companion && !is_choice) row_set(&row, companion, 0, part * plan_number_of(values, companion, 0));

        // a small change of a quantity needs a small error of the search, and the means over the last beat suffice; the
        // fish beats with the same number of events
        const bool is_beat = moves_beat(key->row);
        if (is_model_input) {
            const double most = values->steady.formation == YES ? INFINITY : input_tolerance;
            row_set(&row, "steady.tolerance", 0, fmin(values->steady.tolerance, most));
            row_set(&row, "steady.output_beats", 0, 0);
        }
        if (strcmp(path, "time.shedding_interval") != 0 && !is_beat) continue;
        if (is_beat) row_set(&row, "time.shedding_interval", 0, values->school.shedding_interval / part);

        // times that must be multiples of the interval; the end time has no effect on a steady state
        const double interval = is_beat ? values->school.shedding_interval / part : change->value,
                     beat = is_beat ? study->beat / part : study->beat, step = values->solver.step;
        if (study->is_steady && beat > 0) row_set(&row, "time.end", 0, beat * ceil(values->time.end / beat - 1e-9));
        if (is_beat && !study->is_steady) row_set(&row, "time.end", 0, values->time.end / part);
        row_set(&row, "time.checkpoint_interval", 0, 0);
        const double output = interval * fmax(1, round(values->time.output_interval / interval));
        row_set(&row, "time.output_interval", 0, output);
        row_set(&row, "output.wake_interval", 0, output * fmax(1, round(values->output.wake_interval / output)));
        if (step > 0) row_set(&row, "solver.step", 0, interval / ceil(interval / step - 1e-9));
    }
    return row;
}

/* Append a row to the axis; the search of the member starts from the member before. is_against: a member of the other
 * case. Returns the member. */
static int row_append(struct error_sweep *sweep, char *const *value, int before, bool is_against) {
    struct sweep_axis *const axis = &sweep->study.sweep[0];
    const size_t n = (size_t)axis->n_keys, m = (size_t)axis->n_values;
    GROW(sweep->arena, axis->value, n * (m + 1));
    GROW(sweep->arena, axis->before, m + 1);
    GROW(sweep->arena, axis->neighbours, m + 1);
    GROW(sweep->arena, axis->is_against, m + 1);
    axis->is_against[m] = is_against;
    memcpy(axis->value + n * m, value, n * sizeof *axis->value);
    axis->before[m] = before;
    axis->neighbours[m].n = 0;
    return axis->n_values++;
}

int error_plan_member(struct error_study *study, int n, const struct error_plan_change *changes, int before,
                      bool *is_new) {
    const struct sweep_axis *const axis = &study->study->sweep[0];
    const int ignored = error_plan_column(study, "steady.multipliers", 0);
    const struct row row = make_row(study, n, changes);

    // a member of the same case with the same values, except for multipliers
    *is_new = false;
    for (int m = 0; m < axis->n_values; m++) {
        bool is_same = axis->is_against[m] == study->is_against;
        for (int c = 0; c < axis->n_keys && is_same; c++) {
            is_same = c == ignored || strcmp(axis->value[m * axis->n_keys + c], row.value[c]) == 0;
        }
        if (is_same) return m;
    }

    *is_new = true;
    return row_append(study->sweep, row.value, before, study->is_against);
}

/* Whether some changes of the case give a valid case. */
static bool are_valid_changes(struct error_study *study, int n, const struct error_plan_change *changes) {
    struct arena *const scratch = arena_create(study->sweep->arena, "a level of an error study");
    struct case_values *values;
    const struct row row = make_row(study, n, changes);
    const int member = row_append(study->sweep, row.value, -1, study->is_against);
    const enum status status = study_folder_case(scratch, &values, study->study, member);
    study->study->sweep[0].n_values = member;
    arena_free(scratch);
    return status == STATUS_OK;
}

static bool is_valid_level(struct error_study *study, int k, double value) {
    return are_valid_changes(study, 1, &(struct error_plan_change){k, value});
}

/* Fewest events in a beat: below, a run has the warning "few events". */
static const double fewest_events = 20;

/* Whether a level of a key is a valid case whose run would have no warning of few events or few nodes. A case with such
 * a warning has it at most levels. */
static bool is_good_level(struct error_study *study, int k, double value) {
    const struct error_study_key *const key = &study->key[k];
    if (!is_valid_level(study, k, value)) return false;
    if (*key->objection) return true;
    if (strcmp(key->row->path, "time.shedding_interval") == 0) {
        const double stated = key->value[key->first_stated];
        return !(study->beat < fewest_events * value * (1 - 1e-9)) || study->beat < fewest_events * stated;
    }
    if (strcmp(key->row->path, "fish.nodes") != 0 || !(study->values->school.fluid.density > 0)) return true;

    // two edges are at most as long as the tail bends over
    for (int f = 0; f < study->n_fish; f++) {
        if (!(study->bending[f] > 0)) continue;
        const double part = value / plan_number_of(study->values, "fish.nodes", 0);
        const double edges = round(part * plan_number_of(study->values, "fish.nodes", f)) - 1;
        if (2 * study->values->school.fish[f].length / edges > study->bending[f]) return false;
    }
    return true;
}

// ---- levels

static bool is_finer(const struct sweep_error_key *row, double a, double b) {
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

double error_plan_find_level(struct error_study *study, int k, double from, double factor) {
    const struct case_values *const values = study->values;
    const struct error_study_key *const key = &study->key[k];
    const bool is_interval = strcmp(key->row->path, "time.shedding_interval") == 0;
    const bool is_step = strcmp(key->row->path, "solver.step") == 0;
    const double run = study->is_steady && study->beat > 0 ? study->beat : values->time.end;
    const double whole = is_step ? values->school.shedding_interval : run;
    const double target = is_interval || is_step ? whole / (from * factor) : from * factor;
    if (key->row->kind != SWEEP_POINTS && !is_interval && !is_step) {
        return is_good_level(study, k, target) ? target : NAN;
    }

    // integers around the target
    for (int j = 0; j <= target / 4; j++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            const double n = floor(target + 0.5) + sign * j, value = is_interval || is_step ? whole / n : n;
            const bool is_same = !(fabs(value - from) > 1e-9 * from);
            if (n < 1 || is_same || is_finer(key->row, value, from) != is_finer(key->row, from * factor, from))
                continue;
            if (is_good_level(study, k, value)) return value;
        }
        // other numbers of points or steps would be refused, too
        if (!is_interval) return NAN;
    }

    return NAN;
}

/* Set the levels of each key: given in the case, or of the table, which has coarser levels, and a finer level with
 * confirm. Finer levels replace invalid coarser levels. */
static enum status choose_levels(struct error_study *study) {
    const struct sweep_error *const error = study->study->error;
    for (int k = 0; k < study->n_keys; k++) {
        struct error_study_key *const key = &study->key[k];
        const struct sweep_error_key *const row = key->row;
        const struct sweep_error_levels *given = NULL;
        for (int i = 0; i < error->n_keys; i++) {
            if (error->levels[i].key == row && error->levels[i].n > 0) given = &error->levels[i];
        }
        for (int i = 0; given && i < given->n; i++) {
            if (!is_valid_level(study, k, given->value[i])) {
                return status_fail(STATUS_CASE, "error.keys: level %g: %s", given->value[i], status_message());
            }
            error_plan_insert(key, given->value[i]);
        }

        // the far wake converges with the design order only after two halvings of the spacing. The other keys have four
        // levels all the same, because three would be judged by twice the largest difference
        const double base = key->value[0];
        if (row->kind == SWEEP_INPUT) {
            // two steps on both sides, else three on one
            bool is_valid[2] = {true, true};
            for (int i = 0; i < 4; i++) {
                is_valid[i % 2] &= is_valid_level(study, k, input_level(base, i));
            }
            const int n_steps = is_valid[0] && is_valid[1] ? 2 : 3;
            for (int i = 0; i < 2 * n_steps; i++) {
                const double level = input_level(base, i);
                if (is_valid[i % 2] && is_valid_level(study, k, level)) error_plan_insert(key, level);
            }
        }
        for (int i = 0; i < row->n_levels && !given; i++) {
            if (is_valid_level(study, k, row->level[i])) error_plan_insert(key, row->level[i]);
        }
        // half the nodes do not resolve the wave of most bodies, so with finer levels one coarser level suffices
        const bool are_nodes = strcmp(row->path, "fish.nodes") == 0;
        int n_missing = 0, n_finer = row->kind == SWEEP_MODEL || error->confirm;
        for (int i = 0; i < 2 && !given; i++) {
            if (!(row->coarser[i] > 0)) continue;
            if (are_nodes && error->confirm && i == 1) {
                n_missing++;
                continue;
            }
            const double level = error_plan_find_level(study, k, base, row->coarser[i]);
            if (!isnan(level)) error_plan_insert(key, level);
            n_missing += isnan(level);
        }
        n_finer = row->kind == SWEEP_DURATION ? 2 * n_finer : n_finer + n_missing;
        for (int i = 0; i < n_finer && !given && row->finer > 0; i++) {
            const double level = error_plan_find_level(study, k, key->value[0], row->finer);
            if (!isnan(level)) error_plan_insert(key, level);
        }

        if (key->n_levels > (row->kind == SWEEP_INPUT ? 2 : 1)) continue;
        key->value[0] = key->value[key->stated];
        key->n_levels = 1;
        key->stated = key->first_stated = 0;

        // the reason of the next finer level: the message without its place in the text
        const double finer = row->kind == SWEEP_INPUT ? 1 + input_steps[0] : row->finer;
        const double next = row->kind == SWEEP_POINTS ? round(base * finer) : base * finer;
        const bool is_refused = finer > 0 && !is_valid_level(study, k, next);
        const char *const message = is_refused ? strstr(status_message(), "error: ") : NULL;
        const char *const reason = message ? message + strlen("error: ") : "";
        snprintf(key->objection, CONVERGENCE_BYTES, "no other level is a valid case%s%.*s", *reason ? ": " : "",
                 (int)strcspn(reason, "\n"), reason);
    }

    return STATUS_OK;
}

// ---- keys

/* Whether a key with this value affects the results of this case. */
static bool is_used(const struct error_study *study, const struct sweep_error_key *row, double value) {
    const struct case_values *const values = study->values;
    const bool is_wake = strncmp(row->path, "wake.", 5) == 0, has_fluid = values->school.fluid.density > 0;

    // the key of a choice may need another choice: a factor of 1 means off, and only a moving body has damping
    if (row->switch_path && (int)plan_number_of(values, row->switch_path, 0) != row->switch_value) return false;
    if (strcmp(row->path, "fish.drag.waving") == 0 && !(value > 1)) return false;
    if (strcmp(row->path, "fish.body.tail_thickness") == 0) return value > 0;
    if (study->is_static && strncmp(row->path, "fish.pressure.", 14) == 0) return true;
    if (strcmp(row->path, "fish.body.relaxation_time") == 0) {
        return value > 0 && !study->is_static && values->school.fish[0].motion.prescribed != PRESCRIBED_ALL;
    }

    // an equilibrium has no events, but the wake of the modes is shed at events
    const bool is_interval = strcmp(row->path, "time.shedding_interval") == 0;
    if (study->is_static) return row->kind == SWEEP_POINTS || (is_interval && asks_for_modes(study));
    if (strcmp(row->path, "solver.rtol") == 0) return !(values->solver.step > 0);
    if (strcmp(row->path, "solver.step") == 0) return values->solver.step > 0;
    if (strcmp(row->path, "fish.nodes") != 0 && !has_fluid) return false;
    if (row->kind == SWEEP_DURATION && !study->is_steady) {
        return row->coarser[0] * values->school.wake.lifetime < values->time.end;
    }

    return !is_wake || value > 0;
}

/* Whether an input with this value affects the results of this case. */
static bool is_used_input(const struct error_study *study, const struct sweep_error_key *row, double value) {
    const struct case_values *const values = study->values;
    const struct fish_parameters *const fish = &values->school.fish[row->name ? row->fish : 0];
    const char *const path = row->path;
    const bool is_held = fish->motion.prescribed != PRESCRIBED_NONE;
    if (!(fabs(value) > 0)) return false;
    if (row->switch_path && (int)plan_number_of(values, row->switch_path, 0) != row->switch_value) return false;
    if (strcmp(path, "fish.drag.waving") == 0 && !(value > 1)) return false;
    if (strcmp(path, "fish.body.thickness") == 0 || strcmp(path, "fish.body.depth") == 0) {
        return fish->body.profile != PROFILE_TABLE;
    }
    if (strncmp(path, "fish.wave.", 10) == 0 && (study->is_static || !(fabs(fish->wave.amplitude) > 0))) return false;
    if (strncmp(path, "fish.motion.", 12) == 0) {
        return is_held && (strcmp(path, "fish.motion.speed") != 0 || fish->motion.surge == SURGE_GIVEN);
    }
    const bool is_damping = strstr(path, "damping") || strstr(path, "relaxation_time");
    const bool is_elastic =
        is_damping || strcmp(path, "fish.body.modulus") == 0 || strcmp(path, "fish.body.density") == 0;
    if (is_elastic && fish->motion.prescribed == PRESCRIBED_ALL) return false;
    if (study->is_static && (is_damping || strcmp(path, "fish.body.density") == 0)) return false;
    const bool is_of_body = strcmp(path, "fish.length") == 0 || strncmp(path, "fish.body.", 10) == 0 ||
                            strncmp(path, "fish.wave.", 10) == 0;
    if (!is_of_body && !(values->school.fluid.density > 0)) return false;
    return !(study->is_static && strncmp(path, "wake.", 5) == 0);
}

/* The value of a key; of a factor of friction that the case does not give, the one that follows from the first body. */
static double value_in_use(const struct error_study *study, const struct school *school, const char *path, int fish) {
    const bool is_set = case_table_is_set(study->values, path, fish);
    if (is_set) return plan_number_of(study->values, path, fish);
    return strcmp(path, "fish.drag.form") == 0 ? school->fish->form : school->fish->waving;
}

/* Add the inputs that the case asks for, or all that it uses if it names none. */
static enum status choose_inputs(struct error_study *study, const struct school *school) {
    const struct sweep_error *const error = study->study->error;
    const struct sweep_axis *const axis = &study->study->sweep[0];
    const bool are_all = error->sensitivity && error->n_inputs == 0;
    for (int i = 0; i < (are_all ? SWEEP_N_INPUTS : error->n_inputs); i++) {
        const struct sweep_error_key *const row = are_all ? &sweep_inputs[i] : error->input[i].key;
        if (row->name && row->fish >= study->n_fish) continue;  // the other case has fewer fish
        // in a school, each fish has a factor of its own that follows from its body
        const int fish = row->name ? row->fish : 0;
        const bool is_one = study->n_fish == 1 || case_table_is_set(study->values, row->path, fish);
        const double value = is_one ? value_in_use(study, school, row->path, fish) : 0;
        for (int c = 0; c < study->sweep->n_swept; c++) {
            if (strcmp(axis->key[c].row, row->path) != 0 || are_all) continue;
            return status_fail(STATUS_CASE, "error: %s is swept: its sensitivity is that of the points", row->path);
        }
        if (row->name && study->is_steady && strstr(row->path, ".frequency")) {
            return status_fail(STATUS_CASE, "error: %s: a steady state needs one frequency: vary that of all fish",
                               row->name);
        }
        if (!is_used_input(study, row, value)) {
            if (are_all || study->is_against) continue;
            return status_fail(
                STATUS_CASE, "error.%s: %s %s", error->sensitivity ? "sensitivity" : "uncertain", sweep_error_name(row),
                fabs(value) > 0 ? "changes nothing in this case" : "is 0 or not given: parts of it have no meaning");
        }
        struct error_study_key *const key = &study->key[study->n_keys++];
        *key = (struct error_study_key){.row = row,
                                        .unit = "",
                                        .n_levels = 1,
                                        .value = {value},
                                        .member = {-1},
                                        .uncertainty = are_all ? 0 : error->input[i].uncertainty};
        NEW(study->sweep->arena, key->part, study->n_asked * study->n_fish);
        NEW(study->sweep->arena, key->slope, study->n_asked * study->n_fish);
    }
    return STATUS_OK;
}

/* Add all varied keys of a point, without levels; no key of the sweep. */
static enum status choose_keys(struct error_study *study, const struct school *school) {
    const struct sweep_error *const error = study->study->error;
    const struct sweep_axis *const axis = &study->study->sweep[0];
    for (int i = 0; i < SWEEP_N_ERROR_KEYS; i++) {
        const struct sweep_error_key *const row = &sweep_error_keys[i];
        bool is_wanted = row->kind == SWEEP_MODEL ? error->models : error->n_keys == 0 && !error->sensitivity;
        for (int k = 0; k < error->n_keys; k++) is_wanted |= error->levels[k].key == row;
        for (int c = 0; c < study->sweep->n_swept; c++) is_wanted &= strcmp(axis->key[c].row, row->path) != 0;
        const bool is_local = strcmp(row->path, "fish.nodes") == 0 || strcmp(row->path, "time.shedding_interval") == 0;
        const double value = value_in_use(study, school, row->path, 0);
        if (!is_wanted || !is_used(study, row, value) || !(study->is_full || is_local)) continue;

        struct error_study_key *const key = &study->key[study->n_keys++];
        *key = (struct error_study_key){.row = row,
                                        .unit = plan_in_beats(study->values, row->path) ? " beats" : "",
                                        .n_levels = 1,
                                        .value = {value},
                                        .member = {-1}};
        NEW(study->sweep->arena, key->part, study->n_asked * study->n_fish);
    }

    TRY(choose_inputs(study, school));
    if (study->n_keys > 0 || !study->is_full || study->is_against) return STATUS_OK;
    return status_fail(STATUS_CASE, "error.keys: none of these keys changes anything in this case");
}

/* Add the columns of the axis for the keys of a point: varied keys, companions of the varied keys, and times that must
 * fit the interval. */
static void add_all_columns(struct error_study *study) {
    struct error_sweep *const sweep = study->sweep;
    const struct case_values *const values = study->values;
    for (int k = 0; k < study->n_keys; k++) {
        const struct sweep_error_key *const row = study->key[k].row;
        const bool are_nodes = strcmp(row->path, "fish.nodes") == 0;
        add_columns(sweep, row->path);
        if (row->companion) add_columns(sweep, row->companion);
        // an input keeps the number of sheet points, which follows from the depth
        const bool is_model_input = row->kind == SWEEP_INPUT;
        if ((are_nodes || is_model_input) && values->school.fluid.density > 0) add_columns(sweep, "fish.sheet_points");
        if (is_model_input && study->is_steady) {
            add_columns(sweep, "steady.tolerance");
            add_columns(sweep, "steady.output_beats");
        }
        const bool is_beat = moves_beat(row);
        if (is_beat) add_columns(sweep, "time.shedding_interval");
        if (strcmp(row->path, "time.shedding_interval") != 0 && !is_beat) continue;
        add_columns(sweep, "time.end");
        add_columns(sweep, "time.checkpoint_interval");
        add_columns(sweep, "time.output_interval");
        add_columns(sweep, "output.wake_interval");
    }

    if (error_plan_column(study, "time.shedding_interval", 0) >= 0 && values->solver.step > 0) {
        add_columns(sweep, "solver.step");
    }
    if (study->is_steady) add_columns(sweep, "steady.multipliers");
}

/* Fill the objections that follow from the case alone. */
static void list_objections(struct error_study *study, const struct school *school) {
    NEW(study->sweep->arena, study->bending, school->n_fish);
    for (int k = 0; k < study->n_keys; k++) {
        struct error_study_key *const key = &study->key[k];
        for (int f = 0; f < school->n_fish && !*key->objection; f++) {
            const struct fish *const fish = &school->fish[f];
            if (strcmp(key->row->path, "fish.sheet_points") == 0 && fish->n_sheet < 2 * fish->n_nodes - 1) {
                snprintf(key->objection, CONVERGENCE_BYTES, "%.60s has fewer sheet_points than 2 nodes - 1",
                         fish->name);
            }
            if (strcmp(key->row->path, "fish.nodes") != 0 || !(school->density > 0)) continue;
            if (fish->has_cusp) {
                snprintf(key->objection, CONVERGENCE_BYTES, "the tail of %.60s ends in a cusp", fish->name);
                continue;
            }
            const double bending = warnings_bending_length(fish);
            study->bending[f] = isfinite(bending) ? bending : 0;
            if (!(2 * fish->edge_length > bending)) continue;
            snprintf(key->objection, CONVERGENCE_BYTES,
                     "two edges of %.60s are longer than its tail bends over, %.2g m", fish->name, bending);
        }
    }
}

// ---- the plan

/* Room for the numbers of all quantities of all fish. */
static void create_numbers(struct arena *arena, struct error_study *study) {
    const int n = study->n_asked * study->n_fish;
    NEW(arena, study->value, n);
    NEW(arena, study->error, n);
    NEW(arena, study->shift, n);
    NEW(arena, study->of_noise, n);
    NEW(arena, study->together, n);
    NEW(arena, study->parts, n);
    NEW(arena, study->inputs, n);
    NEW(arena, study->shared, n);
    NEW(arena, study->lowest, n);
    NEW(arena, study->highest, n);
}

/* Set the requested quantities of a point. */
static enum status choose_quantities(struct error_study *study) {
    const struct sweep_error *const error = study->study->error;
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
        if (error->against_kind == AGAINST_FISH && !quantity->of_fish) {
            return status_fail(STATUS_CASE,
                               "error.against: %s is of the whole case, so %s compares it with itself: compare it with "
                               "another case",
                               error->of[i], error->against);
        }
        if (i == ERROR_STUDY_QUANTITIES) {
            return status_fail(STATUS_CASE, "error.of: more than %d quantities", ERROR_STUDY_QUANTITIES);
        }
        study->is_steady = quantity->of_steady;
        study->quantity[study->n_asked++] = q;
    }

    create_numbers(study->sweep->arena, study);
    return STATUS_OK;
}

/* Whether a key is a numerical one that has finer levels than that of the case. */
static bool has_finer(const struct error_study_key *key) {
    return key->row->kind != SWEEP_MODEL && key->row->kind != SWEEP_INPUT && key->first_stated > 0;
}

/* Find or add the member with all numerical keys at their finest levels; a point that is not full has none. Returns the
 * number of new members. */
static int choose_finest(struct error_study *study) {
    struct error_plan_change changes[ERROR_STUDY_KEYS];
    int n = 0;
    for (int k = 0; k < study->n_keys; k++) {
        if (has_finer(&study->key[k])) changes[n++] = (struct error_plan_change){k, study->key[k].value[0]};
    }
    study->finest = -1;
    if (n == 0 || !study->is_full || !are_valid_changes(study, n, changes)) return 0;
    bool is_new;
    study->finest = error_plan_member(study, n, changes, study->base, &is_new);
    return is_new;
}

/* Let the search of an input's level start from the state of the level before it, level `from`, with an extrapolation
 * through the SWEEP_NEIGHBOURS nearest levels that have members. */
static void add_neighbours(struct error_study *study, const struct error_study_key *key, int level, int from) {
    struct sweep_neighbours *const neighbours = &study->study->sweep[0].neighbours[key->member[level]];
    double place[SWEEP_NEIGHBOURS];
    bool is_used[ERROR_STUDY_LEVELS] = {false};
    is_used[level] = true;
    for (int n = 0, next = from; n < SWEEP_NEIGHBOURS && next >= 0; n++) {
        is_used[next] = true;
        neighbours->value[n] = key->member[next];
        place[n] = key->value[next];
        neighbours->n = n + 1;
        next = -1;
        for (int i = 0; i < key->n_levels; i++) {
            if (is_used[i] || key->member[i] < 0) continue;
            const bool is_nearer = next < 0 || fabs(key->value[i] - key->value[level]) <
                                                   fabs(key->value[next] - key->value[level]) * (1 - 1e-9);
            if (is_nearer) next = i;
        }
    }
    for (int i = 0; i < neighbours->n; i++) {
        neighbours->weight[i] = 1;
        for (int j = 0; j < neighbours->n; j++) {
            if (j != i) neighbours->weight[i] *= (key->value[level] - place[j]) / (place[i] - place[j]);
        }
    }
}

/* Add the member of a level, unless the level has one; returns whether it is new. */
static bool add_level(struct error_study *study, int k, int level) {
    struct error_study_key *const key = &study->key[k];
    if (key->n_levels == 1 || level < 0 || level >= key->n_levels || key->member[level] >= 0) return false;

    // the search starts from the neighbour towards the stated level, which already has a member
    const int from = level + (level < key->stated ? 1 : level > key->stated ? -1 : 0);
    const int before = level == key->stated ? study->base : key->member[from];
    bool is_new;
    key->member[level] =
        error_plan_member(study, 1, &(struct error_plan_change){k, key->value[level]}, before, &is_new);
    const bool has_beat = study->is_steady && !study->is_static;
    if (is_new && has_beat && key->row->kind == SWEEP_INPUT) add_neighbours(study, key, level, from);
    return is_new;
}

int error_plan_members(struct error_study *study) {
    int n_new = 0;
    for (int distance = 0; distance < ERROR_STUDY_LEVELS; distance++) {
        for (int k = 0; k < study->n_keys; k++) {
            if (study->key[k].row->kind == SWEEP_INPUT && distance > 0) continue;
            n_new += add_level(study, k, study->key[k].stated - distance);
            if (distance > 0) n_new += add_level(study, k, study->key[k].stated + distance);
        }

        // one side of all inputs first, because the other side starts from an extrapolation through it
        for (int side = -1; side <= 1 && distance > 0; side += 2) {
            for (int k = 0; k < study->n_keys; k++) {
                if (study->key[k].row->kind != SWEEP_INPUT) continue;
                n_new += add_level(study, k, study->key[k].stated + side * distance);
            }
        }
    }

    return n_new + choose_finest(study);
}

/* Set the twin of each point: the point itself, the point with a value of the first axis, or the other case. */
static enum status choose_twins(struct error_sweep *sweep, int n_axes, const struct sweep_axis *axes) {
    struct arena *const arena = sweep->arena;
    const struct sweep_error *const error = sweep->study.error;
    sweep->fish = sweep->twin_fish = -1;
    if (error->against_kind == AGAINST_NOTHING) return STATUS_OK;
    NEW(arena, sweep->twin, sweep->n_points);
    for (int p = 0; p < sweep->n_points; p++) sweep->twin[p] = p;

    if (error->against_kind == AGAINST_FISH) {
        const char *const equals = strchr(error->against, '=');
        const struct school_parameters *const school = &sweep->study.school;
        sweep->fish = school_find_fish(school, error->against, (size_t)(equals - error->against));
        sweep->twin_fish = school_find_fish(school, equals + 1, strlen(equals + 1));
    } else if (error->against_kind == AGAINST_POINT) {
        const int found = n_axes > 0 ? sweep_find_value(&axes[0], error->against) : -1;
        if (found < 0) {
            return status_fail(STATUS_CASE, "error.against: %.60s is neither `first` nor a value of %s", error->against,
                               n_axes > 0 ? axes[0].key[0].path : "a sweep");
        }
        const int stride = sweep->n_points / axes[0].n_values;
        for (int p = 0; p < sweep->n_points; p++) sweep->twin[p] = found * stride + p % stride;
    } else {
        struct case_values *values;
        struct error_study *against;
        TRY(study_folder_parse(arena, &values, error->against, "error.against", 0, NULL));
        if (values->school.n_fish > sweep->study.school.n_fish) {
            return status_fail(STATUS_CASE, "error.against: %s has more fish than the case: exchange the two",
                               values->name);
        }
        sweep->against = NEW(arena, against, 1);
        *against = (struct error_study){.sweep = sweep,
                                        .study = &sweep->study,
                                        .values = values,
                                        .is_full = true,
                                        .finest = -1,
                                        .is_against = true,
                                        .n_fish = values->school.n_fish};
        for (int p = 0; p < sweep->n_points; p++) sweep->twin[p] = sweep->n_points;
    }
    return STATUS_OK;
}

/* Create the points of the sweep, and the axis of the members in place of the axes of the sweep. *swept: the values of
 * the swept keys (n_points, n_swept) */
static enum status create_points(struct error_sweep *sweep, char ***swept, const struct study_options *options) {
    struct arena *const arena = sweep->arena;
    struct case_values *const study = &sweep->study;
    const int n_axes = study->n_axes;
    const struct sweep_axis *const from = study->sweep;
    sweep->n_points = sweep_n_members(study);
    NEW(arena, sweep->point, sweep->n_points);
    for (int a = 0; a < n_axes; a++) sweep->n_swept += from[a].n_keys;
    NEW(arena, *swept, sweep->n_points * sweep->n_swept);
    struct sweep_axis *axis;
    NEW(arena, axis, 1);
    NEW(arena, axis->key, sweep->n_swept + 1);
    for (int a = 0; a < n_axes; a++) {
        for (int k = 0; k < from[a].n_keys; k++) axis->key[axis->n_keys++] = from[a].key[k];
    }

    struct study_refusals refusals = {0};
    struct study_watch watch = {.options = options, .what = "read", .n = sweep->n_points};
    for (int p = 0; p < sweep->n_points; p++) {
        struct error_study *const point = &sweep->point[p];
        struct case_values *values = NULL;
        TRY(study_folder_watch(&watch, p + 1));
        TRY(study_refusals_add(&refusals, study, p, study_folder_case(arena, &values, study, p)));
        if (!values) continue;
        *point = (struct error_study){.sweep = sweep,
                                      .study = study,
                                      .values = values,
                                      .is_full = true,
                                      .finest = -1,
                                      .n_fish = values->school.n_fish};
        char **value = *swept + p * sweep->n_swept;
        for (int a = 0; a < n_axes; a++) {
            const int i = sweep_member_value(study, p, a), last = from[a].n_values - 1;
            point->is_full &= i == 0 || i == last / 2 || i == last;
            for (int k = 0; k < from[a].n_keys; k++) *value++ = from[a].value[i * from[a].n_keys + k];
        }
    }
    TRY(study_refusals_status(&refusals, study));

    TRY(choose_twins(sweep, n_axes, from));

    // the conditions of expectations name keys of the one axis
    struct sweep_expectation *expect;
    NEW(arena, expect, study->n_expectations);
    for (int e = 0; e < study->n_expectations; e++) {
        struct sweep_condition *where;
        expect[e] = study->expect[e];
        NEW(arena, where, expect[e].n_where);
        for (int i = 0; i < expect[e].n_where; i++) {
            where[i] = expect[e].where[i];
            for (int a = 0; a < expect[e].where[i].axis; a++) where[i].key += from[a].n_keys;
            where[i].axis = 0;
        }
        expect[e].where = where;
    }
    study->expect = expect;

    study->sweep = axis;
    study->n_axes = 1;
    return STATUS_OK;
}

/* Choose quantities, keys and columns of a point. */
static enum status plan_keys(struct error_study *point) {
    struct school *school;
    TRY(fish_school_create(point->sweep->arena, &school, &point->values->school));
    const struct fish *const beating = fish_first_beating(school);
    point->beat = beating ? beating->period : 0;
    point->is_static = steady_static_applies(school);
    enum status status = choose_quantities(point);
    point->is_static &= point->is_steady;
    if (status == STATUS_OK) status = choose_keys(point, school);
    if (status == STATUS_OK) list_objections(point, school);
    fish_school_free(school);
    if (status == STATUS_OK) add_all_columns(point);
    return status;
}

// ---- comparisons

/* The key of a study in a row of the table; NULL: not varied. */
static struct error_study_key *key_in(struct error_study *study, const struct sweep_error_key *row) {
    for (int k = 0; k < study->n_keys; k++) {
        if (study->key[k].row == row) return &study->key[k];
    }
    return NULL;
}

/* The level of the twin for a level of a key: the same choice, or the same part of the level of the case. */
static double twin_level(const struct error_study_key *key, const struct error_study_key *twin, int level) {
    if (key->row->n_levels > 0) return key->value[level];
    const double value = twin->value[twin->first_stated] / key->value[key->first_stated] * key->value[level];
    return key->row->kind == SWEEP_POINTS ? round(value) : value;
}

/* Give the other case the levels of all points, where they are valid. */
static void choose_levels_against(struct error_sweep *sweep) {
    struct error_study *const against = sweep->against;
    for (int k = 0; k < against->n_keys; k++) {
        struct error_study_key *const key = &against->key[k];
        for (int p = 0; p < sweep->n_points; p++) {
            const struct error_study_key *const from = key_in(&sweep->point[p], key->row);
            for (int i = 0; from && i < from->n_levels; i++) {
                const double value = twin_level(from, key, i);
                if (is_valid_level(against, k, value)) error_plan_insert(key, value);
            }
        }
        if (key->n_levels == 1) snprintf(key->objection, CONVERGENCE_BYTES, "no level of the case is valid");
    }
    error_plan_members(against);
}

/* The comparison of all points with their twins: only levels that both have. A key that does not affect the twin
 * compares with the twin itself. */
static struct error_sweep *create_comparison(struct error_sweep *sweep, enum error_relation relation) {
    struct arena *const arena = sweep->arena;
    struct error_sweep *compared;
    NEW(arena, compared, 1);
    *compared = *sweep;
    compared->ratio = compared->change = NULL;
    NEW(arena, compared->point, sweep->n_points);
    for (int p = 0; p < sweep->n_points; p++) {
        struct error_study *const from = &sweep->point[p], *const twin = point_at(sweep, sweep->twin[p]),
                                  *const to = &compared->point[p];
        const int n = from->n_asked * from->n_fish;
        *to = *from;
        to->sweep = compared;
        to->relation = relation;
        to->point = from;
        to->twin = twin;
        create_numbers(arena, to);
        bool have_finest = from->finest >= 0 && twin->finest >= 0;
        for (int k = 0; k < twin->n_keys; k++) {
            have_finest &= !has_finer(&twin->key[k]) || key_in(from, twin->key[k].row);
        }
        for (int k = 0; k < to->n_keys; k++) {
            struct error_study_key *const key = &to->key[k];
            const struct error_study_key *const other = key_in(twin, key->row), copy = *key;
            key->n_levels = 0;
            for (int i = 0; i < copy.n_levels; i++) {
                int member = -1;
                for (int j = 0; other && j < other->n_levels; j++) {
                    const double wanted = twin_level(&copy, other, i);
                    if (!(fabs(other->value[j] - wanted) > 1e-9 * fabs(wanted))) member = other->member[j];
                }
                if (member < 0 && (i == copy.stated || !other)) member = twin->base;
                if (member < 0) continue;
                if (i == copy.stated) key->stated = key->first_stated = key->n_levels;
                key->value[key->n_levels] = copy.value[i];
                key->member[key->n_levels] = copy.member[i];
                key->twin[key->n_levels++] = member;
            }
            // the finest levels of both cases have to be those of the comparison
            if (has_finer(&copy) || (other && has_finer(other))) {
                have_finest &= !(fabs(key->value[0] - copy.value[0]) > 0);
                have_finest &= !other || !has_finer(other) || key->twin[0] == other->member[0];
            }
            if (!*key->objection && other) memcpy(key->objection, other->objection, CONVERGENCE_BYTES);
            if (key->n_levels == 1 && !*key->objection) {
                snprintf(key->objection, CONVERGENCE_BYTES, "both cases have no other level in common");
            }
            NEW(arena, key->part, n);
            if (key->row->kind == SWEEP_INPUT) NEW(arena, key->slope, n);
        }
        if (!have_finest) to->finest = -1;
    }
    return compared;
}

int error_plan_twin_fish(const struct error_study *study, int fish) {
    const struct error_sweep *const sweep = study->sweep;
    if (sweep->fish >= 0) return fish == sweep->fish ? sweep->twin_fish : -1;
    const int n_twin = study->twin->n_fish;
    return n_twin == 1 ? 0 : fish < n_twin ? fish : -1;
}

bool error_plan_has_value(const struct error_study *study, int quantity, int fish) {
    if (!member_file_quantity(study->quantity[quantity])->of_fish) return fish == 0;
    return study->relation == ERROR_VALUE || error_plan_twin_fish(study, fish) >= 0;
}

char *error_plan_twin_name(const struct error_study *study, int fish) {
    struct arena *const arena = study->sweep->arena;
    const struct case_values *const values = study->twin->values;
    const int twin = error_plan_twin_fish(study, fish);
    if (study->sweep->fish >= 0) return arena_text(arena, "%s", values->school.fish[twin].name);
    if (!study->twin->is_against) return arena_text(arena, "point %d", study->twin->base);
    if (values->school.n_fish == 1) return arena_text(arena, "%s", values->name);
    return arena_text(arena, "%s in %s", values->school.fish[twin].name, values->name);
}

enum status error_plan_create(struct arena *arena, struct error_sweep **plan, const struct case_values *values,
                              const struct study_options *options) {
    struct error_sweep *sweep;
    struct case_values *parsed;
    NEW(arena, sweep, 1);
    sweep->arena = arena;
    TRY(study_folder_parse(arena, &parsed, values->merged, values->name, 0, NULL));
    sweep->study = *parsed;
    sweep->study.text = arena_text(arena, "%s", values->text);
    NEW(arena, sweep->of_all, case_table_n);

    // the keys of each point
    char **swept = NULL, **value;
    TRY(create_points(sweep, &swept, options));
    struct study_watch watch = {.options = options, .what = "checked", .n = sweep->n_points};
    for (int p = 0; p < n_all_points(sweep); p++) {
        TRY(study_folder_watch(&watch, p + 1));
        TRY(plan_keys(point_at(sweep, p)));
    }
    if (sweep->against && sweep->against->is_static != sweep->point[0].is_static) {
        return status_fail(STATUS_CASE, "error.against: %s %s: compare two swimmers, or two bodies without a beat",
                           sweep->against->values->name,
                           sweep->against->is_static ? "has no beat" : "has a beat, and the case has none");
    }

    // the case of each point; the search of a point starts from the state of the point before
    struct sweep_axis *const axis = &sweep->study.sweep[0];
    axis->steady = sweep->point[0].is_steady;
    NEW(arena, value, axis->n_keys);
    for (int p = 0; p < n_all_points(sweep); p++) {
        struct error_study *const point = point_at(sweep, p);
        for (int c = 0; c < axis->n_keys; c++) {
            const char *const path = axis->key[c].row;
            const int f = fish_of(&axis->key[c]) < 0 ? 0 : fish_of(&axis->key[c]);
            const struct sweep_error_key *const row = sweep_error_find(path);
            bool is_of_case = row && row->n_levels > 0;
            const bool is_swept = c < sweep->n_swept;

            // an input of the case itself, whose default others may follow
            for (int k = 0; k < point->n_keys; k++) {
                const struct sweep_error_key *const one = point->key[k].row;
                is_of_case |= one->kind == SWEEP_INPUT && strcmp(one->path, path) == 0;
            }
            value[c] = f >= point->n_fish || (is_swept ? point->is_against : is_of_case) ? arena_text(arena, "%s", "")
                       : is_swept                                                        ? swept[p * sweep->n_swept + c]
                                  : text_of(point, case_table_row(path), plan_number_of(point->values, path, f));
        }
        point->base = point->stated = row_append(sweep, value, point->is_against ? -1 : p - 1, point->is_against);
    }

    watch = (struct study_watch){.options = options, .what = "planned", .n = sweep->n_points};
    for (int p = 0; p < sweep->n_points; p++) {
        TRY(choose_levels(&sweep->point[p]));
        error_plan_members(&sweep->point[p]);
        TRY(study_folder_watch(&watch, p + 1));
    }
    if (sweep->against) choose_levels_against(sweep);
    if (sweep->twin) {
        struct error_sweep *const ratio = create_comparison(sweep, ERROR_RATIO);
        sweep->change = create_comparison(sweep, ERROR_CHANGE);
        sweep->ratio = ratio;
    }
    *plan = sweep;
    return STATUS_OK;
}

// ---- members that cost the same

/* Whether a key decides what a member costs, beside the number of fish: the cost hardly depends on numbers of the
 * bodies such as stiffness, amplitude and place. */
static bool decides_cost(const struct sweep_key *column) {
    const struct key *const key = case_table_row(column->row);
    const bool is_of_body = case_table_is_of_fish(key) && (key->type == REAL || key->type == PAIR);
    return !is_of_body || strstr(key->path, "frequency");
}

/* Whether two members cost the same, as far as keys decide it. */
static bool cost_the_same(const struct error_sweep *sweep, int a, int b) {
    const struct sweep_axis *const axis = &sweep->study.sweep[0];
    const bool are_searches = sweep->point[0].is_steady;  // shorter from a neighbour
    bool is_same =
        axis->is_against[a] == axis->is_against[b] && (!are_searches || (axis->before[a] < 0) == (axis->before[b] < 0));
    for (int c = 0; c < axis->n_keys && is_same; c++) {
        is_same = !decides_cost(&axis->key[c]) ||
                  strcmp(axis->value[a * axis->n_keys + c], axis->value[b * axis->n_keys + c]) == 0;
    }
    return is_same;
}

int error_plan_choose_estimated(const struct error_sweep *sweep, int *like) {
    const int n = sweep_n_members(&sweep->study);
    int n_estimated = 0, *point, *estimated;
    NEW(sweep->arena, point, n);
    NEW(sweep->arena, estimated, n);
    for (int p = sweep->n_points - 1; p >= 0; p--) {
        const struct error_study *const study = &sweep->point[p];
        point[study->base] = p;
        if (study->finest >= 0) point[study->finest] = p;
        for (int k = 0; k < study->n_keys; k++) {
            for (int i = 0; i < study->key[k].n_levels && study->key[k].n_levels > 1; i++) {
                point[study->key[k].member[i]] = p;
            }
        }
    }
    for (int m = 0; m < n; m++) {
        like[m] = m;
        for (int i = n_estimated - 1; i >= 0 && like[m] == m; i--) {
            const int other = estimated[i];
            const bool is_near = point[other] == point[m] || !sweep->point[point[m]].is_full;
            if (is_near && cost_the_same(sweep, m, other)) like[m] = other;
        }
        if (like[m] == m) estimated[n_estimated++] = m;
    }
    return n_estimated;
}
