/* test_state.c: Tests the state before the start, its histories of samples and the rates at events, and that every
 * field is a row of the table of checkpoints. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "school.h"
#include "state/state.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"

TEST(state_before_the_start_is_placed_and_empty) {
    struct setup setup = setup_of(SMALL "fish: [{start: {heading: 90}}, {start: {position: [1, 2]}}]\n");
    const struct state *start = setup.state;
    NEAR(start->t, 0, 0, 0);
    assert_int_equal(start->event, 0);
    for (int f = 0; f < 2; f++) {
        const struct fish *fish = &setup.school->fish[f];
        assert_int_equal(start->wake[f].n_vortex, 0);
        NEAR(start->y[fish->at.x], fish->start_position[0], 0, 0);
        NEAR(start->y[fish->at.circulation], 0, 0, 0);
        NEAR(start->control[f].held_heading, fish->start_heading, 0, 0);
        assert_int_equal(start->history[f].n, 0);
        // one beat of 1 s and one more
        assert_int_equal(start->history[f].capacity, 51);
    }
}

TEST(a_fish_without_a_beat_remembers_one_sample) {
    struct setup setup = setup_of(SMALL "fish: [{wave: {frequency: 0}}]\n");
    assert_int_equal(setup.state->history[0].capacity, 1);
    for (int i = 1; i <= 3; i++) {
        const struct sample sample = {.heading = i};
        state_reserve(setup.state, setup.school);
        state_remember(&setup.state->history[0], &sample);
        NEAR(state_recall(&setup.state->history[0], 0)->heading, i, 0, 0);
        assert_int_equal(setup.state->history[0].n, 1);
    }
}

TEST(a_beat_of_whole_intervals_is_rounded_to_them) {
    // 0.3/0.1 is below 3
    struct setup setup = setup_of(
        "time: {end: 1, shedding_interval: 0.1, output_interval: 0.1}\nfish: [{nodes: 7, wave: {frequency: "
        "3.3333333333333335}}]\n");
    BELOW(setup.school->fish[0].period / setup.school->interval, 3);
    assert_int_equal(setup.state->history[0].capacity, 4);
}

TEST(samples_take_memory_for_the_events_of_the_run) {
    // a beat of 1e6 s has 1e8 events of 0.01 s, of which a run has twenty
    struct setup setup = setup_of(
        "time: {end: 0.2, shedding_interval: 0.01, output_interval: 0.01}\nfish: [{nodes: 7, wave: {frequency: "
        "1e-6}}]\n");
    struct history *const history = &setup.state->history[0];
    assert_int_equal(history->n_slots, 0);
    assert_in_range(history->capacity, 10000000, 10000001);
    for (int n = 1; n <= 20; n++) {
        state_reserve(setup.state, setup.school);
        state_remember(history, &(struct sample){.heading = n});
        assert_in_range(history->n_slots, n, 2 * n);
    }
    for (int age = 0; age < 20; age++) NEAR(state_recall(history, age)->heading, 20 - age, 0, 0);

    // a school of one period: never more than the samples of the period and one
    struct setup period =
        setup_of("time: {end: 2, shedding_interval: 0.02, output_interval: 0.02}\nfish: [{nodes: 7}]\n");
    for (int n = 1; n <= 200; n++) {
        state_reserve(period.state, period.school);
        state_remember(&period.state->history[0], &(struct sample){.heading = -1});
        state_forget_newest(&period.state->history[0]);
        state_remember(&period.state->history[0], &(struct sample){.heading = n});
        assert_in_range(period.state->history[0].n_slots, period.state->history[0].n, 52);
    }
    assert_int_equal(period.state->history[0].n, 51);
    for (int age = 0; age < 51; age++) NEAR(state_recall(&period.state->history[0], age)->heading, 200 - age, 0, 0);
}

TEST(a_kept_state_returns_without_a_copy_of_the_samples) {
    struct setup setup = setup_of("time: {end: 2, shedding_interval: 0.2, output_interval: 0.2}\nfish: [{nodes: 7}]\n");
    struct state *const before = state_create(NULL, setup.school);
    struct history *const history = &setup.state->history[0];
    for (int n = 1; n <= 40; n++) {
        // an event that is taken back, also where the ring is full, then the event
        state_table_copy(before, setup.state, setup.school, false);
        assert_null(before->history[0].sample);
        for (int again = 0; again < 2; again++) {
            setup.state->y[0] = n;
            state_reserve(setup.state, setup.school);
            state_remember(history, &(struct sample){.heading = again == 0 ? -1 : n});
            if (again > 0) break;
            state_table_copy(setup.state, before, setup.school, false);
            NEAR(setup.state->y[0], before->y[0], 0, 0);
            assert_int_equal(history->n, n - 1 < 6 ? n - 1 : 6);
            for (int age = 0; age < history->n; age++) NEAR(state_recall(history, age)->heading, n - 1 - age, 0, 0);
        }
    }
    state_free(before);
}

TEST(history_recalls_the_newest_ones_in_order) {
    struct sample samples[5];
    struct history history = {.capacity = 4, .n_slots = 5, .last = -1, .sample = samples};
    for (int i = 0; i < 11; i++) {
        const struct sample sample = {.heading = i};
        state_remember(&history, &sample);
        assert_int_equal(history.n, i < 4 ? i + 1 : 4);
        for (int age = 0; age < history.n; age++) NEAR(state_recall(&history, age)->heading, i - age, 0, 0);
    }
}

TEST(the_only_sample_can_be_forgotten) {
    struct sample samples[5];
    struct history history = {.capacity = 4, .n_slots = 5, .last = -1, .sample = samples};
    for (int i = 0; i < 3; i++) {
        state_remember(&history, &(struct sample){.heading = i});
        assert_int_equal(history.n, 1);
        NEAR(state_recall(&history, 0)->heading, i, 0, 0);
        state_forget_newest(&history);
        assert_int_equal(history.n, 0);
    }
}

// ---- rates at events

static double quartic(int i, double t) {
    return i + 3 * t - (i % 5) * t * t + (i % 7) * t * t * t + (i % 3) * t * t * t * t;
}

static double slope_of_quartic(int i, double t) {
    return 3 - 2 * (i % 5) * t + 3 * (i % 7) * t * t + 4 * (i % 3) * t * t * t;
}

static void set_unknowns(struct setup *setup, double t) {
    for (int i = 0; i < setup->school->n_unknowns; i++) {
        setup->state->y[i] = quartic(i, t);
        setup->state->yp[i] = -7;
    }
}

TEST(rates_of_quartics_are_exact_after_five_events_without_a_jump) {
    static const char two_fish[] = TIME
        "wake: {shedding: sheet}\nsheet: {curve: smooth}\nfish: [{nodes: 5, sheet_points: 9, force: pressure, "
        "pressure: {span: infinite}}, {nodes: 5, force: reactive, start: {position: [0, 2]}}]\n";
    for (int shed_is_algebraic = 0; shed_is_algebraic < 2; shed_is_algebraic++) {
        struct setup setup = setup_of(two_fish);
        const struct fish *const fish = setup.school->fish;
        for (int n = 0; n < 16; n++) {
            const double t = 0.02 * n;
            set_unknowns(&setup, t);
            if (n == 0 || n == 8) {
                state_begin_rates(setup.state, setup.school);
                continue;
            }
            state_find_rates(setup.state, setup.school, shed_is_algebraic);

            for (int i = 0; i < setup.school->n_unknowns; i++) {
                const bool is_shed = i == fish[0].at.circulation || i == fish[1].at.circulation;
                const bool has_rate = (i >= fish->at.vx && i < fish->at.px) ||
                                      (i >= fish->at.gamma && i < fish->at.circulation) ||
                                      (is_shed && shed_is_algebraic);
                // the slope of the polynomial through all values since the jump, five at most: the sum of differences/k
                const int most = n % 8 < 4 ? n % 8 : 4;
                double value[5], slope = 0;
                for (int k = 0; k <= most; k++) value[k] = quartic(i, t - 0.02 * k);
                for (int k = 1; k <= most; k++) {
                    for (int j = 0; j + k <= most; j++) value[j] -= value[j + 1];
                    slope += value[0] / k / 0.02;
                }
                if (!has_rate) NEAR(setup.state->yp[i], -7, 0, 0);
                // rounding of values of 60 over an interval of 0.02
                if (has_rate) NEAR(setup.state->yp[i], slope, 1e-10, 0);
                if (has_rate && n % 8 >= 4) NEAR(setup.state->yp[i], slope_of_quartic(i, t), 1e-10, 0);
            }
        }
    }
}

// ---- every field has a row, and a copy has all values

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SCHOOL TIME "fish: [{}, {nodes: 5, start: {position: [1, 2]}, control: {law: heading, desired_heading: 90}}]\n"

// ---- fields, read from the headers

// the text between the braces of a struct definition, without comments
static void read_definition(const char *path, const char *name, char *body, size_t size) {
    static char text[65536];
    FILE *const file = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    for (char *comment; (comment = strstr(text, "/*"));) {
        char *const end = strstr(comment, "*/");
        assert_non_null(end);
        memset(comment, ' ', (size_t)(end + 2 - comment));
    }
    char start[64];
    snprintf(start, sizeof start, "\nstruct %s {", name);
    const char *const from = strstr(text, start);
    if (!from) fail_msg("%s does not define struct %s", path, name);
    const char *const to = strstr(from, "\n};");
    assert_non_null(to);
    BELOW((size_t)(to - from), size);
    snprintf(body, size, "%.*s", (int)(to - from - (long)strlen(start)), from + strlen(start));
}

// the next declared name: the last word before "," or ";" or "["
static int next_field(const char **body, char field[64]) {
    field[0] = '\0';
    for (const char *c = *body; *c;) {
        const size_t length = strcspn(c, " \n*,;[");
        const char end = c[length];
        if (length > 0) snprintf(field, 64, "%.*s", (int)length, c);
        c += length + (end != '\0');
        if (end == '[') c += strcspn(c, ",;") + 1;
        // "x[2][3]" and "x [2]" end alike
        if (end == ',' || end == ';' || end == '[') {
            *body = c;
            return 1;
        }
    }
    return 0;
}

static bool has_row(const char *name) {
    for (int i = 0; i < state_table_n; i++) {
        if (strcmp(state_table[i].name, name) == 0) return 1;
    }
    return 0;
}

static const struct {
    const char *path, *structure, *prefix;
    enum state_owner owner;
    size_t bytes;
} owners[] = {
    {"src/state/state.h", "state", "", STATE_ITSELF, sizeof(struct state)},
    {"src/wake/wake.h", "wake", "wake.", STATE_WAKE, sizeof(struct wake)},
    {"src/control/control.h", "control_memory", "control.", STATE_CONTROL, sizeof(struct control_memory)},
    {"src/state/state.h", "history", "history.", STATE_HISTORY, sizeof(struct history)},
    {"src/state/state.h", "energy_balance", "balance.", STATE_BALANCE, sizeof(struct energy_balance)},
    {"src/state/state.h", "momentum_balance", "momentum.", STATE_MOMENTUM, sizeof(struct momentum_balance)},
    {"src/state/state.h", "closest", "closest.", STATE_CLOSEST, sizeof(struct closest)},
};
enum { N_OWNERS = sizeof owners / sizeof *owners };

static bool is_owner(const char *field) {
    for (int i = 0; i < N_OWNERS; i++) {
        const size_t length = strlen(owners[i].prefix);
        if (length > 0 && strlen(field) + 1 == length && strncmp(field, owners[i].prefix, length - 1) == 0) return 1;
    }
    return 0;
}

TEST(every_field_has_a_row) {
    int n_fields = 0;
    for (int i = 0; i < N_OWNERS; i++) {
        char body[4096], field[64], name[128];
        read_definition(owners[i].path, owners[i].structure, body, sizeof body);
        for (const char *rest = body; next_field(&rest, field);) {
            snprintf(name, sizeof name, "%s%s", owners[i].prefix, field);
            if (owners[i].owner == STATE_ITSELF && is_owner(field)) continue;
            if (!has_row(name)) fail_msg("struct %s: %s has no row in state.c", owners[i].structure, field);
            n_fields++;
        }
    }
    // each row is a field, too
    assert_int_equal(n_fields, state_table_n);
}

TEST(all_but_the_memory_is_kept) {
    static const char memory[] =
        " arena wake.arena wake.forms wake.aged wake.version wake.n_turns wake.capacity history.capacity ";
    for (int i = 0; i < state_table_n; i++) {
        const char *const name = arena_text(test_arena(), " %s ", state_table[i].name);
        assert_int_equal(state_table[i].type == STATE_UNKEPT, strstr(memory, name) != NULL);
    }
}

TEST(the_rows_cover_every_byte) {
    for (int i = 0; i < N_OWNERS; i++) {
        unsigned char is_covered[sizeof(struct state) + sizeof(struct wake) + sizeof(struct control_memory)] = {0};
        AT_MOST(owners[i].bytes, sizeof is_covered);
        for (int k = 0; k < state_table_n; k++) {
            const struct state_row *const row = &state_table[k];
            if (row->owner == owners[i].owner) memset(is_covered + row->offset, 1, row->bytes);
        }
        // the remaining bytes are padding, and pointers to the owners
        size_t left = 0;
        for (size_t b = 0; b < owners[i].bytes; b++) left += !is_covered[b];
        AT_MOST(left, (owners[i].owner == STATE_ITSELF ? (N_OWNERS - 1) * sizeof(void *) : 0) + 7);
    }
}

TEST(a_sample_is_nothing_but_doubles) {
    char body[4096];
    read_definition("src/state/state.h", "sample", body, sizeof body);
    int n = 0;
    for (const char *line = strtok(body, ";"); line; line = strtok(NULL, ";")) {
        line += strspn(line, " \n");
        if (*line == '\0') continue;
        assert_int_equal(strncmp(line, "double ", 7), 0);
        n++;
    }
    ABOVE(n, 5);
}

// ---- copies

static void fill_with(struct state *to, const struct school *school, double first) {
    double number = first;
    for (int i = 0; i < state_table_n; i++) {
        const struct state_row *const row = &state_table[i];
        if (row->type != STATE_REAL) continue;
        for (int f = 0; f < state_table_n_owners(row, school); f++) {
            double *const values = state_table_place(row, to, f);
            const size_t n = state_table_length(row, to, school, f);
            for (size_t k = 0; k < n; k++) values[k] = number++;
        }
    }
}

TEST(a_copy_has_every_value_and_knows_that_its_wakes_have_changed) {
    struct setup one, other;
    school_build(&one, SCHOOL);
    school_build(&other, SCHOOL);
    // more vortices than the capacity of a new wake, and fewer
    for (int i = 0; i < 40; i++) wake_release(&one.state->wake[1], i, 2, 3, 4);
    for (int i = 0; i < 9; i++) wake_release(&other.state->wake[0], i, 2, 3, 4);
    fill_with(one.state, one.school, 1);
    one.state->event = 77;
    one.state->control[1].waypoint = 3;
    one.state->history[0].n = one.state->history[0].last = 5;
    const unsigned long before = state_wake_version(other.state, other.school);
    state_table_copy(other.state, one.state, one.school, true);
    assert_int_not_equal(state_wake_version(other.state, other.school), before);
    assert_int_equal(other.state->wake[0].n_vortex, 0);
    assert_int_equal(other.state->wake[1].n_vortex, 40);
    for (int i = 0; i < state_table_n; i++) {
        const struct state_row *const row = &state_table[i];
        if (row->type == STATE_UNKEPT) continue;
        for (int f = 0; f < state_table_n_owners(row, one.school); f++) {
            const size_t n = state_table_length(row, one.state, one.school, f);
            assert_int_equal(state_table_length(row, other.state, one.school, f), n);
            const void *const from = state_table_values(row, one.state, f);
            const void *const to = state_table_values(row, other.state, f);
            if (n == 0) continue;
            assert_ptr_not_equal(from, to);
            assert_memory_equal(to, from, n * state_table_size(row));
        }
    }
}

TEST(indices_that_no_run_has_are_refused) {
    struct setup setup = setup_of(SCHOOL);
    struct state *const s = setup.state;
    state_reserve(s, setup.school);
    for (int f = 0; f < 2; f++) state_remember(&s->history[f], &(struct sample){.heading = 1});
    school_ok(state_table_check(s, setup.school));
    int *const fields[] = {&s->history[1].n,     &s->history[1].n,    &s->history[0].last,     &s->history[0].last,
                           &s->balance[1].n,     &s->balance[1].n,    &s->control[1].waypoint, &s->control[0].waypoint,
                           &s->closest->fish[0], &s->closest->fish[1]};
    const int wrong[] = {0, s->history[1].capacity + 1, -1, s->history[0].n_slots, -1, 3, -1, 1, -1, 2};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const int right = *fields[i];
        *fields[i] = wrong[i];
        assert_int_equal(state_table_check(s, setup.school), STATUS_FILE);
        *fields[i] = right;
    }
    s->wake[1].has_markers = false;
    assert_int_equal(state_table_check(s, setup.school), STATUS_FILE);
    memset(&s->wake[1].has_markers, 2, 1);  // a byte that is no truth value
    assert_int_equal(state_table_check(s, setup.school), STATUS_FILE);
    s->wake[1].has_markers = true;
    school_ok(state_table_check(s, setup.school));
    for (int i = 0; i < 2; i++) {
        s->n_past = i == 0 ? -1 : STATE_PAST + 1;
        assert_int_equal(state_table_check(s, setup.school), STATUS_FILE);
    }
    s->n_past = STATE_PAST;
    school_ok(state_table_check(s, setup.school));
    s->event = -1;
    assert_int_equal(state_table_check(s, setup.school), STATUS_FILE);
}
