/* state.c: the state before the start, histories of samples, the table of fields and loops over the table. */
#include "state/state.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "body/rod.h"
#include "fish/fish_motion.h"

static enum status state_fill(struct state *state, const struct school *school) {
    const int n_fish = school->n_fish, n_unknowns = school->n_unknowns;
    TRY(MEMORY_NEW(state->y, n_unknowns, "the state"));
    TRY(MEMORY_NEW(state->yp, n_unknowns, "the state"));
    TRY(MEMORY_NEW(state->past, STATE_PAST * n_unknowns, "the state"));
    TRY(MEMORY_NEW(state->wake, n_fish, "the state"));
    TRY(MEMORY_NEW(state->control, n_fish, "the state"));
    TRY(MEMORY_NEW(state->history, n_fish, "the state"));
    TRY(MEMORY_NEW(state->balance, n_fish, "the state"));
    TRY(MEMORY_NEW(state->momentum, n_fish, "the state"));
    TRY(MEMORY_NEW(state->closest, 1, "the state"));
    TRY(MEMORY_NEW(state->closest->before, n_unknowns, "the state"));

    // set values that do not start at zero
    state->closest->distance = INFINITY;
    state->crossed = -1;
    for (int f = 0; f < n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        TRY(wake_create(&state->wake[f], 16));
        state->wake[f].has_markers = school->shedding == SHEDDING_SHEET;

        struct history *const history = &state->history[f];
        history->capacity = (int)fmin(floor(fish->period / school->interval + 0.5), 1e7) + 1;
        history->last = -1;

        struct energy_balance *const balance = &state->balance[f];
        double **const per_strain[] = {&balance->strain, &balance->stress, &balance->stress_before};
        TRY(MEMORY_ARRAYS(per_strain, rod_n_strains(fish), "the strains"));

        state->control[f].held_heading = fish->start_heading;
        fish_start(fish, state->y);
    }

    memcpy(state->closest->before, state->y, (size_t)n_unknowns * sizeof *state->y);
    return STATUS_OK;
}

enum status state_create(struct state **state, const struct school *school) {
    *state = NULL;
    struct state *new;
    TRY(MEMORY_NEW(new, 1, "a state"));

    const enum status status = state_fill(new, school);
    if (status != STATUS_OK) {
        state_free(new, school);
        return status;
    }
    *state = new;
    return STATUS_OK;
}

void state_free(struct state *state, const struct school *school) {
    if (!state) return;
    for (int f = 0; f < school->n_fish; f++) {
        if (state->wake) wake_free(&state->wake[f]);
        if (state->history) free(state->history[f].sample);
        if (!state->balance) continue;
        free(state->balance[f].strain);
        free(state->balance[f].stress);
        free(state->balance[f].stress_before);
    }

    free(state->y);
    free(state->yp);
    free(state->past);
    free(state->wake);
    free(state->control);
    free(state->history);
    free(state->balance);
    free(state->momentum);
    if (state->closest) free(state->closest->before);
    free(state->closest);
    free(state);
}

// the newest row of past
static void state_keep_past(struct state *state, const struct school *school) {
    const size_t n = (size_t)school->n_unknowns, size = sizeof *state->past;
    memmove(state->past + n, state->past, (STATE_PAST - 1) * n * size);
    memcpy(state->past, state->y, n * size);
    if (state->n_past < STATE_PAST) state->n_past++;
}

void state_begin_rates(struct state *state, const struct school *school) {
    state->n_past = 0;
    state_keep_past(state, school);
}

void state_find_rates(struct state *state, const struct school *school, int shed_is_algebraic) {
    // slopes at the newest of up to 5 values at equal distances of 1, newest first
    static const double slope[STATE_PAST + 1][STATE_PAST + 1] = {
        {0}, {1, -1}, {3. / 2, -2, 1. / 2}, {11. / 6, -3, 3. / 2, -1. / 3}, {25. / 12, -4, 3, -4. / 3, 1. / 4}};
    const int n = school->n_unknowns;

    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const int has_momentum = fish_has_momentum(fish);
        for (int i = has_momentum ? fish->at.vx : fish->at.circulation; i <= fish->at.circulation; i++) {
            const int is_differential = i == fish->at.circulation && !shed_is_algebraic;
            if (is_differential || (i >= fish->at.px && i < fish->at.gamma)) continue;
            double sum = slope[state->n_past][0] * state->y[i];
            for (long k = 0; k < state->n_past; k++) sum += slope[state->n_past][k + 1] * state->past[k * n + i];
            state->yp[i] = sum / school->interval;
        }
    }

    state_keep_past(state, school);
}

unsigned long state_wake_version(const struct state *state, const struct school *school) {
    unsigned long version = 0;
    for (int f = 0; f < school->n_fish; f++) version += state->wake[f].version;
    return version;
}

// zeroed slots behind the slots of a history
static enum status history_resize(struct history *history, int n_slots) {
    const int n = history->n_slots;
    if (n_slots == n && history->sample) return STATUS_OK;
    TRY(MEMORY_RESIZE(history->sample, n_slots, "the samples of a period"));
    if (n_slots > n) memset(history->sample + n, 0, (size_t)(n_slots - n) * sizeof *history->sample);
    history->n_slots = n_slots;
    return STATUS_OK;
}

// one slot more than samples: a new sample leaves the sample that it drops in place
static int history_next(const struct history *history) {
    return history->last < history->capacity ? history->last + 1 : 0;
}

enum status state_reserve(struct state *state, const struct school *school) {
    for (int f = 0; f < school->n_fish; f++) {
        struct history *const history = &state->history[f];
        const int next = history_next(history), most = history->capacity + 1;
        if (next < history->n_slots) continue;
        const int twice = history->n_slots > most / 2 ? most : 2 * history->n_slots;
        TRY(history_resize(history, twice > next ? twice : next + 1));
    }
    return STATUS_OK;
}

void state_forget_newest(struct history *history) {
    const int has_wrapped = history->last == 0 && history->n > 1;
    history->last = has_wrapped ? history->capacity : history->last - 1;
    if (history->n > 0) history->n--;
}

void state_remember(struct history *history, const struct sample *sample) {
    history->last = history_next(history);
    history->sample[history->last] = *sample;
    if (history->n < history->capacity) history->n++;
}

const struct sample *state_recall(const struct history *history, int age) {
    const int slot = history->last - age;
    return &history->sample[slot < 0 ? slot + history->capacity + 1 : slot];
}

// ---- lengths of arrays

static size_t of_unknowns(const struct state *state, const struct school *school, int f) {
    (void)state, (void)f;
    return (size_t)school->n_unknowns;
}

static size_t of_past(const struct state *state, const struct school *school, int f) {
    (void)state, (void)f;
    return STATE_PAST * (size_t)school->n_unknowns;
}

static size_t of_wake(const struct state *state, const struct school *school, int f) {
    (void)school;
    return (size_t)state->wake[f].n_vortex;
}

// struct sample consists of doubles
static size_t of_history(const struct state *state, const struct school *school, int f) {
    (void)school;
    return (size_t)state->history[f].n_slots * (sizeof(struct sample) / sizeof(double));
}

static size_t of_strains(const struct state *state, const struct school *school, int f) {
    (void)state;
    return (size_t)rod_n_strains(&school->fish[f]);
}

// ---- the table

#define PLACE(type, field) offsetof(type, field), sizeof(((type *)0)->field)
#define OF_STATE(type, field) STATE_ITSELF, type, PLACE(struct state, field)
#define OF_WAKE(type, field) STATE_WAKE, type, PLACE(struct wake, field)
#define OF_CONTROL(type, field) STATE_CONTROL, type, PLACE(struct control_memory, field)
#define OF_HISTORY(type, field) STATE_HISTORY, type, PLACE(struct history, field)
#define OF_BALANCE(type, field) STATE_BALANCE, type, PLACE(struct energy_balance, field)
#define OF_MOMENTUM(type, field) STATE_MOMENTUM, type, PLACE(struct momentum_balance, field)
#define OF_CLOSEST(type, field) STATE_CLOSEST, type, PLACE(struct closest, field)

const struct state_row state_table[] = {
    {"t", OF_STATE(STATE_REAL, t), NULL},
    {"event", OF_STATE(STATE_COUNT, event), NULL},
    {"y", OF_STATE(STATE_REAL, y), of_unknowns},
    {"yp", OF_STATE(STATE_REAL, yp), of_unknowns},
    {"n_past", OF_STATE(STATE_COUNT, n_past), NULL},
    {"past", OF_STATE(STATE_REAL, past), of_past},

    {"wake.version", OF_WAKE(STATE_UNKEPT, version), NULL},
    {"wake.n_vortex", OF_WAKE(STATE_INTEGER, n_vortex), NULL},
    {"wake.capacity", OF_WAKE(STATE_UNKEPT, capacity), NULL},
    {"wake.x", OF_WAKE(STATE_REAL, x), of_wake},
    {"wake.y", OF_WAKE(STATE_REAL, y), of_wake},
    {"wake.u", OF_WAKE(STATE_REAL, u), of_wake},
    {"wake.v", OF_WAKE(STATE_REAL, v), of_wake},
    {"wake.u_before", OF_WAKE(STATE_REAL, u_before), of_wake},
    {"wake.v_before", OF_WAKE(STATE_REAL, v_before), of_wake},
    {"wake.circulation", OF_WAKE(STATE_REAL, circulation), of_wake},
    {"wake.rate", OF_WAKE(STATE_REAL, rate), of_wake},
    {"wake.rate_before", OF_WAKE(STATE_REAL, rate_before), of_wake},
    {"wake.birth", OF_WAKE(STATE_REAL, birth), of_wake},
    {"wake.has_markers", OF_WAKE(STATE_INTEGER, has_markers), NULL},
    {"wake.tail_velocity", OF_WAKE(STATE_REAL, tail_velocity), NULL},
    {"wake.tail_tangent", OF_WAKE(STATE_REAL, tail_tangent), NULL},
    {"wake.n_merged", OF_WAKE(STATE_INTEGER, n_merged), NULL},
    {"wake.n_added", OF_WAKE(STATE_INTEGER, n_added), NULL},
    {"wake.removed", OF_WAKE(STATE_REAL, removed), NULL},
    {"wake.shed_before", OF_WAKE(STATE_REAL, shed_before), NULL},
    {"wake.slip", OF_WAKE(STATE_REAL, slip), NULL},

    {"control.waypoint", OF_CONTROL(STATE_INTEGER, waypoint), NULL},
    {"control.held_heading", OF_CONTROL(STATE_REAL, held_heading), NULL},
    {"control.phi0", OF_CONTROL(STATE_REAL, phi0), NULL},
    {"control.phi0_rate", OF_CONTROL(STATE_REAL, phi0_rate), NULL},
    {"control.moment", OF_CONTROL(STATE_REAL, moment), NULL},
    {"control.moment_rate", OF_CONTROL(STATE_REAL, moment_rate), NULL},
    {"control.amplitude", OF_CONTROL(STATE_REAL, amplitude), NULL},
    {"control.frequency", OF_CONTROL(STATE_REAL, frequency), NULL},
    {"control.bias", OF_CONTROL(STATE_REAL, bias), NULL},
    {"control.has_heading", OF_CONTROL(STATE_INTEGER, has_heading), NULL},
    {"control.heading", OF_CONTROL(STATE_REAL, heading), NULL},
    {"control.has_waypoints", OF_CONTROL(STATE_INTEGER, has_waypoints), NULL},
    {"control.n_waypoints", OF_CONTROL(STATE_INTEGER, n_waypoints), NULL},
    {"control.waypoints", OF_CONTROL(STATE_REAL, waypoints), NULL},
    {"control.set_out", OF_CONTROL(STATE_REAL, set_out), NULL},

    {"history.capacity", OF_HISTORY(STATE_UNKEPT, capacity), NULL},
    {"history.n", OF_HISTORY(STATE_INTEGER, n), NULL},
    {"history.last", OF_HISTORY(STATE_INTEGER, last), NULL},
    {"history.n_slots", OF_HISTORY(STATE_INTEGER, n_slots), NULL},
    {"history.sample", OF_HISTORY(STATE_REAL, sample), of_history},

    {"balance.initial_energy", OF_BALANCE(STATE_REAL, initial_energy), NULL},
    {"balance.work", OF_BALANCE(STATE_REAL, work), NULL},
    {"balance.t", OF_BALANCE(STATE_REAL, t), NULL},
    {"balance.power", OF_BALANCE(STATE_REAL, power), NULL},
    {"balance.n", OF_BALANCE(STATE_INTEGER, n), NULL},
    {"balance.strain", OF_BALANCE(STATE_REAL, strain), of_strains},
    {"balance.stress", OF_BALANCE(STATE_REAL, stress), of_strains},
    {"balance.stress_before", OF_BALANCE(STATE_REAL, stress_before), of_strains},

    {"momentum.lost", OF_MOMENTUM(STATE_REAL, lost), NULL},
    {"momentum.external", OF_MOMENTUM(STATE_REAL, external), NULL},
    {"momentum.force", OF_MOMENTUM(STATE_REAL, force), NULL},
    {"momentum.images", OF_MOMENTUM(STATE_REAL, images), NULL},
    {"momentum.legs", OF_MOMENTUM(STATE_REAL, legs), NULL},
    {"momentum.first_body", OF_MOMENTUM(STATE_REAL, first_body), NULL},
    {"momentum.first_fluid", OF_MOMENTUM(STATE_REAL, first_fluid), NULL},
    {"momentum.first_given", OF_MOMENTUM(STATE_REAL, first_given), NULL},

    {"closest.distance", OF_CLOSEST(STATE_REAL, distance), NULL},
    {"closest.t", OF_CLOSEST(STATE_REAL, t), NULL},
    {"closest.fish", OF_CLOSEST(STATE_INTEGER, fish), NULL},
    {"closest.before_t", OF_CLOSEST(STATE_REAL, before_t), NULL},
    {"closest.before", OF_CLOSEST(STATE_REAL, before), of_unknowns},

    {"crossed", OF_STATE(STATE_COUNT, crossed), NULL},
    {"crossed_t", OF_STATE(STATE_REAL, crossed_t), NULL},
    {"diverged", OF_STATE(STATE_COUNT, diverged), NULL},
    {"divergence", OF_STATE(STATE_REAL, divergence), NULL},
};
const int state_table_n = sizeof state_table / sizeof *state_table;

// ---- the places of values

int state_table_n_owners(const struct state_row *row, const struct school *school) {
    return row->owner == STATE_ITSELF || row->owner == STATE_CLOSEST ? 1 : school->n_fish;
}

size_t state_table_size(const struct state_row *row) {
    switch (row->type) {
        case STATE_REAL: return sizeof(double);
        case STATE_INTEGER: return sizeof(int);
        case STATE_COUNT: return sizeof(long);
        case STATE_UNKEPT: break;
    }
    return 1;
}

size_t state_table_length(const struct state_row *row, const struct state *state, const struct school *school, int f) {
    return row->length ? row->length(state, school, f) : row->bytes / state_table_size(row);
}

/* The struct that contains a field; NULL: the state itself. */
static void *field_owner(const struct state_row *row, const struct state *state, int f) {
    switch (row->owner) {
        case STATE_WAKE: return &state->wake[f];
        case STATE_CONTROL: return &state->control[f];
        case STATE_HISTORY: return &state->history[f];
        case STATE_BALANCE: return &state->balance[f];
        case STATE_MOMENTUM: return &state->momentum[f];
        case STATE_CLOSEST: return state->closest;
        case STATE_ITSELF: break;
    }
    return NULL;
}

/* The array that a field points to. */
static void *field_array(const void *field) {
    void *array;
    memcpy(&array, field, sizeof array);
    return array;
}

const void *state_table_values(const struct state_row *row, const struct state *state, int f) {
    const void *const owner = field_owner(row, state, f);
    const char *const field = (const char *)(owner ? owner : state) + row->offset;
    return row->length ? field_array(field) : field;
}

void *state_table_place(const struct state_row *row, struct state *state, int f) {
    void *const owner = field_owner(row, state, f);
    char *const field = (char *)(owner ? owner : state) + row->offset;
    return row->length ? field_array(field) : field;
}

enum status state_table_make_room(struct state *state, const struct school *school) {
    for (int f = 0; f < school->n_fish; f++) {
        struct history *const history = &state->history[f];
        const int n_slots = history->n_slots;
        history->n_slots = 0;
        TRY(wake_resize(&state->wake[f], state->wake[f].n_vortex));
        TRY(history_resize(history, n_slots));
    }
    return STATUS_OK;
}

// ---- loops over the table

static enum status copy_rows(struct state *to, const struct state *from, const struct school *school,
                             bool with_samples) {
    for (int f = 0; f < school->n_fish; f++) {
        TRY(wake_resize(&to->wake[f], from->wake[f].n_vortex));
        to->wake[f].version++;
        if (with_samples) TRY(history_resize(&to->history[f], from->history[f].n_slots));
    }

    for (int i = 0; i < state_table_n; i++) {
        const struct state_row *const row = &state_table[i];
        if (row->type == STATE_UNKEPT || (row->length == of_history && !with_samples)) continue;
        if (strcmp(row->name, "history.n_slots") == 0) continue;
        for (int f = 0; f < state_table_n_owners(row, school); f++) {
            const size_t bytes = state_table_length(row, from, school, f) * state_table_size(row);
            if (bytes > 0) memcpy(state_table_place(row, to, f), state_table_values(row, from, f), bytes);
        }
    }
    return STATUS_OK;
}

enum status state_table_copy(struct state *to, const struct state *from, const struct school *school) {
    return copy_rows(to, from, school, true);
}

enum status state_table_keep(struct state *to, const struct state *from, const struct school *school) {
    return copy_rows(to, from, school, false);
}

/* Whether a value may be undefined: the distance of a single fish is infinite, a sample in the first period has no
 * speed, and the leading-edge parameter exists only with force: pressure. */
static int may_be_undefined(const struct state_row *row, size_t i) {
    const size_t n_sample = sizeof(struct sample) / sizeof(double),
                 speed = offsetof(struct sample, speed) / sizeof(double),
                 edge = offsetof(struct sample, leading_edge) / sizeof(double);

    if (row->owner == STATE_CLOSEST) return row->offset == offsetof(struct closest, distance);
    return row->owner == STATE_HISTORY && (i % n_sample == speed || i % n_sample == edge);
}

static enum status state_check_finite(const struct state *state, const struct school *school) {
    for (int i = 0; i < state_table_n; i++) {
        const struct state_row *const row = &state_table[i];
        if (row->type != STATE_REAL) continue;
        for (int f = 0; f < state_table_n_owners(row, school); f++) {
            const double *const values = state_table_values(row, state, f);
            const size_t n = state_table_length(row, state, school, f);

            for (size_t k = 0; k < n; k++) {
                if (isfinite(values[k]) || may_be_undefined(row, k)) continue;
                return status_fail(STATUS_FILE, "value %zu of '%s' is %g", k, row->name, values[k]);
            }
        }
    }
    return STATUS_OK;
}

enum status state_table_check(const struct state *state, const struct school *school) {
    TRY(state_check_finite(state, school));
    int is_good = state->event >= 0 &&
                  fabs(state->t - (double)state->event * school->interval) <= school->interval / 2 &&
                  state->crossed >= -1 && state->crossed < school->n_fish && state->diverged >= 0 &&
                  state->diverged < school->n_fish;

    is_good &= state->n_past >= 0 && state->n_past <= STATE_PAST;
    for (int i = 0; i < 2; i++) is_good &= state->closest->fish[i] >= 0 && state->closest->fish[i] < school->n_fish;
    for (int f = 0; f < school->n_fish; f++) {
        const struct history *const history = &state->history[f];
        const struct energy_balance *const balance = &state->balance[f];
        const struct control_memory *const control = &state->control[f];
        const int n_waypoints = control_n_waypoints(&school->fish[f], control);

        is_good &= history->n >= 1 && history->n <= history->capacity;
        is_good &= history->last >= 0 && history->last < history->n_slots && history->n_slots <= history->capacity + 1;
        is_good &= history->n <= history->n_slots;
        is_good &= balance->n >= 0 && balance->n <= 2;
        is_good &= control->waypoint >= 0 && control->waypoint <= n_waypoints;
        is_good &= control->n_waypoints >= 0 && control->n_waypoints <= CONTROL_MAX_WAYPOINTS;
        is_good &= state->wake[f].has_markers == (school->shedding == SHEDDING_SHEET);
    }

    return is_good ? STATUS_OK : status_fail(STATUS_FILE, "the state does not fit this case");
}
