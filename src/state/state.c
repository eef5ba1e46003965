/* state.c: the state at the start, the histories of samples, and the table of fields with the loops over it. */
#include "state/state.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "body/rod.h"
#include "fish/fish_motion.h"
#include "wake/stretch.h"

struct state *state_create(struct arena *parent, const struct school *school) {
    struct arena *const arena = arena_create(parent, "the state");
    const int n_fish = school->n_fish, n_unknowns = school->n_unknowns;
    struct state *state;
    NEW(arena, state, 1);
    state->arena = arena;
    NEW(arena, state->y, n_unknowns);
    NEW(arena, state->yp, n_unknowns);
    NEW(arena, state->past, STATE_PAST * n_unknowns);
    NEW(arena, state->wake, n_fish);
    NEW(arena, state->control, n_fish);
    NEW(arena, state->history, n_fish);
    NEW(arena, state->balance, n_fish);
    NEW(arena, state->momentum, n_fish);
    NEW(arena, state->closest, 1);
    NEW(arena, state->closest->before, n_unknowns);

    // set values that do not start at zero
    state->closest->distance = INFINITY;
    const struct stretch_forms *const forms = stretch_forms_create(arena);
    for (int f = 0; f < n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        wake_create(arena, &state->wake[f], 16);
        state->wake[f].forms = forms;
        state->wake[f].aged = wake_aged(school, fish->wake_part);
        state->wake[f].has_markers = school->shedding == SHEDDING_SHEET;

        struct history *const history = &state->history[f];
        history->capacity = (int)fmin(floor(fish->period / school->interval + 0.5), 1e7) + 1;
        history->last = -1;

        struct energy_balance *const balance = &state->balance[f];
        NEW(arena, balance->strain, rod_n_strains(fish));
        NEW(arena, balance->stress, rod_n_strains(fish));
        NEW(arena, balance->stress_before, rod_n_strains(fish));

        state->control[f].held_heading = fish->start_heading;
        fish_start(fish, state->y);
    }

    memcpy(state->closest->before, state->y, (size_t)n_unknowns * sizeof *state->y);
    return state;
}

void state_free(struct state *state) {
    if (state) arena_free(state->arena);
}

void state_begin_rates(struct state *state, const struct school *school) {
    memcpy(state->past, state->y, (size_t)school->n_unknowns * sizeof *state->past);
    state->n_past = 1;
}

void state_find_rates(struct state *state, const struct school *school, bool shed_is_algebraic) {
    // slopes at the newest of up to 5 values at equal distances of 1, newest first
    static const double slope[STATE_PAST + 1][STATE_PAST + 1] = {
        {0}, {1, -1}, {3. / 2, -2, 1. / 2}, {11. / 6, -3, 3. / 2, -1. / 3}, {25. / 12, -4, 3, -4. / 3, 1. / 4}};
    const int n = school->n_unknowns;

    for (int f = 0; f < school->n_fish; f++) {
        // velocities that follow from momenta, bound strengths whose rates act, circulation shed
        const struct layout *const at = &school->fish[f].at;
        const int slices[][2] = {
            {at->vx, at->second}, {at->gamma, at->rated}, {at->circulation, at->circulation + shed_is_algebraic}};
        for (int s = 0; s < 3; s++) {
            for (int i = slices[s][0]; i < slices[s][1]; i++) {
                double sum = slope[state->n_past][0] * state->y[i];
                for (long k = 0; k < state->n_past; k++) sum += slope[state->n_past][k + 1] * state->past[k * n + i];
                state->yp[i] = sum / school->interval;
            }
        }
    }

    // keep the unknowns as the newest row
    const size_t row = (size_t)n * sizeof *state->past;
    memmove(state->past + n, state->past, (STATE_PAST - 1) * row);
    memcpy(state->past, state->y, row);
    if (state->n_past < STATE_PAST) state->n_past++;
}

unsigned long state_wake_version(const struct state *state, const struct school *school) {
    unsigned long version = 0;
    for (int f = 0; f < school->n_fish; f++) version += state->wake[f].version;
    return version;
}

unsigned long state_wake_turns(const struct state *state, const struct school *school) {
    unsigned long n_turns = 0;
    for (int f = 0; f < school->n_fish; f++) n_turns += state->wake[f].n_turns;
    return n_turns;
}

// zeroed slots behind the slots of a history
static void history_resize(struct arena *arena, struct history *history, int n_slots) {
    if (n_slots == history->n_slots && history->sample) return;
    GROW(arena, history->sample, n_slots);
    history->n_slots = n_slots;
}

// one slot more than samples: a new sample leaves the sample that it drops in place
static int history_next(const struct history *history) {
    return history->last < history->capacity ? history->last + 1 : 0;
}

void state_reserve(struct state *state, const struct school *school) {
    for (int f = 0; f < school->n_fish; f++) {
        struct history *const history = &state->history[f];
        const int next = history_next(history), most = history->capacity + 1;
        if (next < history->n_slots) continue;
        const int twice = history->n_slots > most / 2 ? most : 2 * history->n_slots;
        history_resize(state->arena, history, twice > next ? twice : next + 1);
    }
}

void state_forget_newest(struct history *history) {
    const bool has_wrapped = history->last == 0 && history->n > 1;
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
    {"arena", OF_STATE(STATE_UNKEPT, arena), STATE_NO_ARRAY},
    {"t", OF_STATE(STATE_REAL, t), STATE_NO_ARRAY},
    {"event", OF_STATE(STATE_COUNT, event), STATE_NO_ARRAY},
    {"y", OF_STATE(STATE_REAL, y), STATE_UNKNOWNS},
    {"yp", OF_STATE(STATE_REAL, yp), STATE_UNKNOWNS},
    {"n_past", OF_STATE(STATE_COUNT, n_past), STATE_NO_ARRAY},
    {"past", OF_STATE(STATE_REAL, past), STATE_PASTS},

    {"wake.arena", OF_WAKE(STATE_UNKEPT, arena), STATE_NO_ARRAY},
    {"wake.forms", OF_WAKE(STATE_UNKEPT, forms), STATE_NO_ARRAY},
    {"wake.aged", OF_WAKE(STATE_UNKEPT, aged), STATE_NO_ARRAY},
    {"wake.version", OF_WAKE(STATE_UNKEPT, version), STATE_NO_ARRAY},
    {"wake.n_turns", OF_WAKE(STATE_UNKEPT, n_turns), STATE_NO_ARRAY},
    {"wake.n_vortex", OF_WAKE(STATE_INTEGER, n_vortex), STATE_NO_ARRAY},
    {"wake.capacity", OF_WAKE(STATE_UNKEPT, capacity), STATE_NO_ARRAY},
    {"wake.x", OF_WAKE(STATE_REAL, x), STATE_VORTICES},
    {"wake.y", OF_WAKE(STATE_REAL, y), STATE_VORTICES},
    {"wake.u", OF_WAKE(STATE_REAL, u), STATE_VORTICES},
    {"wake.v", OF_WAKE(STATE_REAL, v), STATE_VORTICES},
    {"wake.u_before", OF_WAKE(STATE_REAL, u_before), STATE_VORTICES},
    {"wake.v_before", OF_WAKE(STATE_REAL, v_before), STATE_VORTICES},
    {"wake.circulation", OF_WAKE(STATE_REAL, circulation), STATE_VORTICES},
    {"wake.rate", OF_WAKE(STATE_REAL, rate), STATE_VORTICES},
    {"wake.rate_before", OF_WAKE(STATE_REAL, rate_before), STATE_VORTICES},
    {"wake.birth", OF_WAKE(STATE_REAL, birth), STATE_VORTICES},
    {"wake.has_markers", OF_WAKE(STATE_FLAG, has_markers), STATE_NO_ARRAY},
    {"wake.tail_velocity", OF_WAKE(STATE_REAL, tail_velocity), STATE_NO_ARRAY},
    {"wake.tail_tangent", OF_WAKE(STATE_REAL, tail_tangent), STATE_NO_ARRAY},
    {"wake.n_old", OF_WAKE(STATE_INTEGER, n_old), STATE_NO_ARRAY},
    {"wake.n_added", OF_WAKE(STATE_INTEGER, n_added), STATE_NO_ARRAY},
    {"wake.removed", OF_WAKE(STATE_REAL, removed), STATE_NO_ARRAY},
    {"wake.shed_before", OF_WAKE(STATE_REAL, shed_before), STATE_NO_ARRAY},
    {"wake.slip", OF_WAKE(STATE_REAL, slip), STATE_NO_ARRAY},

    {"control.waypoint", OF_CONTROL(STATE_INTEGER, waypoint), STATE_NO_ARRAY},
    {"control.held_heading", OF_CONTROL(STATE_REAL, held_heading), STATE_NO_ARRAY},
    {"control.phi0", OF_CONTROL(STATE_REAL, phi0), STATE_NO_ARRAY},
    {"control.phi0_rate", OF_CONTROL(STATE_REAL, phi0_rate), STATE_NO_ARRAY},
    {"control.course_rate", OF_CONTROL(STATE_REAL, course_rate), STATE_NO_ARRAY},
    {"control.moment", OF_CONTROL(STATE_REAL, moment), STATE_NO_ARRAY},
    {"control.moment_rate", OF_CONTROL(STATE_REAL, moment_rate), STATE_NO_ARRAY},
    {"control.amplitude", OF_CONTROL(STATE_REAL, amplitude), STATE_NO_ARRAY},
    {"control.frequency", OF_CONTROL(STATE_REAL, frequency), STATE_NO_ARRAY},
    {"control.bias", OF_CONTROL(STATE_REAL, bias), STATE_NO_ARRAY},
    {"control.heave", OF_CONTROL(STATE_REAL, heave), STATE_NO_ARRAY},
    {"control.has_heading", OF_CONTROL(STATE_FLAG, has_heading), STATE_NO_ARRAY},
    {"control.heading", OF_CONTROL(STATE_REAL, heading), STATE_NO_ARRAY},
    {"control.has_waypoints", OF_CONTROL(STATE_FLAG, has_waypoints), STATE_NO_ARRAY},
    {"control.n_waypoints", OF_CONTROL(STATE_INTEGER, n_waypoints), STATE_NO_ARRAY},
    {"control.waypoints", OF_CONTROL(STATE_REAL, waypoints), STATE_NO_ARRAY},
    {"control.set_out", OF_CONTROL(STATE_REAL, set_out), STATE_NO_ARRAY},
    {"control.drive", OF_CONTROL(STATE_REAL, drive), STATE_NO_ARRAY},
    {"control.drive_rate", OF_CONTROL(STATE_REAL, drive_rate), STATE_NO_ARRAY},
    {"control.hold", OF_CONTROL(STATE_REAL, hold), STATE_NO_ARRAY},
    {"control.offset", OF_CONTROL(STATE_REAL, offset), STATE_NO_ARRAY},

    {"history.capacity", OF_HISTORY(STATE_UNKEPT, capacity), STATE_NO_ARRAY},
    {"history.n", OF_HISTORY(STATE_INTEGER, n), STATE_NO_ARRAY},
    {"history.last", OF_HISTORY(STATE_INTEGER, last), STATE_NO_ARRAY},
    {"history.n_slots", OF_HISTORY(STATE_INTEGER, n_slots), STATE_NO_ARRAY},
    {"history.sample", OF_HISTORY(STATE_REAL, sample), STATE_SAMPLES},

    {"balance.initial_energy", OF_BALANCE(STATE_REAL, initial_energy), STATE_NO_ARRAY},
    {"balance.work", OF_BALANCE(STATE_REAL, work), STATE_NO_ARRAY},
    {"balance.t", OF_BALANCE(STATE_REAL, t), STATE_NO_ARRAY},
    {"balance.power", OF_BALANCE(STATE_REAL, power), STATE_NO_ARRAY},
    {"balance.n", OF_BALANCE(STATE_INTEGER, n), STATE_NO_ARRAY},
    {"balance.strain", OF_BALANCE(STATE_REAL, strain), STATE_STRAINS},
    {"balance.stress", OF_BALANCE(STATE_REAL, stress), STATE_STRAINS},
    {"balance.stress_before", OF_BALANCE(STATE_REAL, stress_before), STATE_STRAINS},

    {"momentum.lost", OF_MOMENTUM(STATE_REAL, lost), STATE_NO_ARRAY},
    {"momentum.external", OF_MOMENTUM(STATE_REAL, external), STATE_NO_ARRAY},
    {"momentum.force", OF_MOMENTUM(STATE_REAL, force), STATE_NO_ARRAY},
    {"momentum.images", OF_MOMENTUM(STATE_REAL, images), STATE_NO_ARRAY},
    {"momentum.legs", OF_MOMENTUM(STATE_REAL, legs), STATE_NO_ARRAY},
    {"momentum.leg_rate", OF_MOMENTUM(STATE_REAL, leg_rate), STATE_NO_ARRAY},
    {"momentum.first_body", OF_MOMENTUM(STATE_REAL, first_body), STATE_NO_ARRAY},
    {"momentum.first_fluid", OF_MOMENTUM(STATE_REAL, first_fluid), STATE_NO_ARRAY},
    {"momentum.first_given", OF_MOMENTUM(STATE_REAL, first_given), STATE_NO_ARRAY},

    {"closest.distance", OF_CLOSEST(STATE_REAL, distance), STATE_NO_ARRAY},
    {"closest.t", OF_CLOSEST(STATE_REAL, t), STATE_NO_ARRAY},
    {"closest.fish", OF_CLOSEST(STATE_INTEGER, fish), STATE_NO_ARRAY},
    {"closest.before_t", OF_CLOSEST(STATE_REAL, before_t), STATE_NO_ARRAY},
    {"closest.before", OF_CLOSEST(STATE_REAL, before), STATE_UNKNOWNS},

    {"has_crossed", OF_STATE(STATE_FLAG, has_crossed), STATE_NO_ARRAY},
    {"crossed", OF_STATE(STATE_COUNT, crossed), STATE_NO_ARRAY},
    {"crossed_t", OF_STATE(STATE_REAL, crossed_t), STATE_NO_ARRAY},
    {"diverged", OF_STATE(STATE_COUNT, diverged), STATE_NO_ARRAY},
    {"divergence", OF_STATE(STATE_REAL, divergence), STATE_NO_ARRAY},
    {"faded", OF_STATE(STATE_COUNT, faded), STATE_NO_ARRAY},
    {"fading", OF_STATE(STATE_REAL, fading), STATE_NO_ARRAY},
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
        case STATE_FLAG: return sizeof(bool);
        case STATE_UNKEPT: break;
    }
    return 1;
}

size_t state_table_length(const struct state_row *row, const struct state *state, const struct school *school, int f) {
    switch (row->length) {
        case STATE_UNKNOWNS: return (size_t)school->n_unknowns;
        case STATE_PASTS: return STATE_PAST * (size_t)school->n_unknowns;
        case STATE_VORTICES: return (size_t)state->wake[f].n_vortex;
        // struct sample consists of doubles
        case STATE_SAMPLES: return (size_t)state->history[f].n_slots * (sizeof(struct sample) / sizeof(double));
        case STATE_STRAINS: return (size_t)rod_n_strains(&school->fish[f]);
        case STATE_NO_ARRAY: break;
    }
    return row->bytes / state_table_size(row);
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

void state_table_make_room(struct state *state, const struct school *school) {
    for (int f = 0; f < school->n_fish; f++) {
        struct history *const history = &state->history[f];
        const int n_slots = history->n_slots;
        history->n_slots = 0;
        wake_resize(&state->wake[f], state->wake[f].n_vortex);
        history_resize(state->arena, history, n_slots);
    }
}

// ---- loops over the table

void state_table_copy(struct state *to, const struct state *from, const struct school *school, bool with_samples) {
    for (int f = 0; f < school->n_fish; f++) {
        wake_resize(&to->wake[f], from->wake[f].n_vortex);
        to->wake[f].version++;
        if (with_samples) history_resize(to->arena, &to->history[f], from->history[f].n_slots);
    }

    for (int i = 0; i < state_table_n; i++) {
        const struct state_row *const row = &state_table[i];
        if (row->type == STATE_UNKEPT || (row->length == STATE_SAMPLES && !with_samples)) continue;
        if (strcmp(row->name, "history.n_slots") == 0) continue;
        for (int f = 0; f < state_table_n_owners(row, school); f++) {
            const size_t bytes = state_table_length(row, from, school, f) * state_table_size(row);
            if (bytes > 0) memcpy(state_table_place(row, to, f), state_table_values(row, from, f), bytes);
        }
    }
}

enum status state_table_check(const struct state *state, const struct school *school) {
    const size_t n_sample = sizeof(struct sample) / sizeof(double);
    const size_t speed = offsetof(struct sample, speed) / sizeof(double);
    const size_t edge = offsetof(struct sample, leading_edge) / sizeof(double);

    // all values are finite, except the distance of a single fish, the speed of a sample in the first period, and the
    // leading-edge parameter of a sample, which exists only with force: pressure
    for (int i = 0; i < state_table_n; i++) {
        const struct state_row *const row = &state_table[i];
        if (row->type != STATE_REAL) continue;
        if (row->owner == STATE_CLOSEST && row->offset == offsetof(struct closest, distance)) continue;
        for (int f = 0; f < state_table_n_owners(row, school); f++) {
            const double *const values = state_table_values(row, state, f);
            const size_t n = state_table_length(row, state, school, f);
            for (size_t k = 0; k < n; k++) {
                const bool may_be_undefined =
                    row->owner == STATE_HISTORY && (k % n_sample == speed || k % n_sample == edge);
                if (isfinite(values[k]) || may_be_undefined) continue;
                return status_fail(STATUS_FILE, "value %zu of '%s' is %g", k, row->name, values[k]);
            }
        }
    }

    // a byte that is no truth value is examined as a byte
    for (int i = 0; i < state_table_n; i++) {
        const struct state_row *const row = &state_table[i];
        if (row->type != STATE_FLAG) continue;
        for (int f = 0; f < state_table_n_owners(row, school); f++) {
            const unsigned char flag = *(const unsigned char *)state_table_values(row, state, f);
            if (flag > 1) return status_fail(STATUS_FILE, "'%s' is %d, neither 0 nor 1", row->name, flag);
        }
    }

    // indices are within range
    bool is_good = state->event >= 0 &&
                   fabs(state->t - (double)state->event * school->interval) <= school->interval / 2 &&
                   state->crossed >= 0 && state->crossed < school->n_fish && state->diverged >= 0 &&
                   state->diverged < school->n_fish && state->faded >= 0 && state->faded < school->n_fish;
    is_good = is_good && state->n_past >= 0 && state->n_past <= STATE_PAST;
    for (int i = 0; i < 2; i++) {
        is_good = is_good && state->closest->fish[i] >= 0 && state->closest->fish[i] < school->n_fish;
    }

    for (int f = 0; f < school->n_fish; f++) {
        const struct history *const history = &state->history[f];
        const struct energy_balance *const balance = &state->balance[f];
        const struct control_memory *const control = &state->control[f];
        const int n_waypoints = control_n_waypoints(&school->fish[f], control);

        is_good = is_good && history->n >= 1 && history->n <= history->capacity && history->n <= history->n_slots &&
                  history->last >= 0 && history->last < history->n_slots && history->n_slots <= history->capacity + 1;
        is_good = is_good && balance->n >= 0 && balance->n <= 2 && control->waypoint >= 0 &&
                  control->waypoint <= n_waypoints && control->n_waypoints >= 0 &&
                  control->n_waypoints <= CONTROL_MAX_WAYPOINTS;
        const struct wake *const wake = &state->wake[f];
        is_good = is_good && wake->has_markers == (school->shedding == SHEDDING_SHEET) && wake->n_old >= 0 &&
                  wake->n_old <= wake_n_sources(wake) && (wake->n_old == 0 || wake->has_markers);
    }

    return is_good ? STATUS_OK : status_fail(STATUS_FILE, "the state does not fit this case");
}
