/* school.c: Schools from the text of a case, random states, and derivatives by differences, for the tests of the
 * physics. */
#include "school.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fish/fish_school.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_derivative.h"
#include "school/residual.h"
#include "school/residual_jacobian.h"
#include "state/state.h"

void school_ok(enum status status) {
    if (status == STATUS_OK) return;
    print_error("%s\n", status_message());
    fail();
}

struct case_values school_values(const char *text) {
    struct case_values values;
    char whole[32768];
    const int length = snprintf(whole, sizeof whole, "format: 1\nname: test\n%s", text);
    assert_in_range(length, 0, sizeof whole - 1);
    school_ok(case_parse(&values, whole, (size_t)length, "test", ".", 0, NULL));
    arena_move(values.arena, test_arena());
    return values;
}

void school_build(struct setup *setup, const char *text) {
    *setup = (struct setup){.arena = arena_create(test_arena(), "a school"), .mode = &residual_run, .seed = 1};
    setup->values = school_values(text);
    arena_move(setup->values.arena, setup->arena);
    school_ok(fish_school_create(setup->arena, &setup->school, &setup->values.school));
    setup->state = state_create(setup->arena, setup->school);
    setup->residual = residual_create(setup->arena, setup->school, setup->state);
    setup->jacobian = jacobian_create(setup->arena, setup->school);
    residual_mask(setup->residual, setup->jacobian);
    setup->term = sparse_create(setup->arena, 0, setup->school->n_unknowns);
    NEW(setup->arena, setup->value, setup->school->n_unknowns);
}

void school_clear(struct setup *setup) {
    arena_free(setup->arena);
}

struct initial_conditions *school_consistent(struct setup *setup, double t) {
    struct initial_conditions *solver;
    school_ok(initial_conditions_create(test_arena(), &solver, setup->residual));
    school_ok(initial_conditions_solve(solver, &residual_run, t, setup->state->y, setup->state->yp));
    return solver;
}

struct setup setup_of(const char *text) {
    struct setup setup;
    school_build(&setup, text);
    return setup;
}

struct setup setup_with(const char *format, ...) {
    char text[4096];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    assert_in_range(length, 1, sizeof text - 1);
    return setup_of(text);
}

struct setup setup_stirred(const char *text) {
    struct setup setup = setup_of(text);
    school_stir(&setup);
    return setup;
}

double school_random(struct setup *setup) {
    // Knuth's linear congruential generator; the upper bits are good ones
    setup->seed = setup->seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(int64_t)(setup->seed >> 11) / 4503599627370496.0 - 1;
}

static void stir_fish(struct setup *setup, const struct fish *fish, double *y, double *yp) {
    // joints turned by up to 0.3 rad, edges stretched by up to 2 %
    double angle = fish->start_heading - 3.14159265358979 + 0.2 * school_random(setup);
    for (int k = 0; k < fish->n_edges; k++) {
        const double l = fish->edge_length * (1 + 0.02 * school_random(setup));
        y[fish->at.x + k + 1] = y[fish->at.x + k] + l * cos(angle);
        y[fish->at.y + k + 1] = y[fish->at.y + k] + l * sin(angle);
        angle += 0.3 * school_random(setup);
    }
    for (int k = 0; k < fish->n_nodes; k++) {
        y[fish->at.vx + k] += 0.5 * school_random(setup);
        y[fish->at.vy + k] += 0.5 * school_random(setup);
        y[fish->at.ax + k] = 2 * school_random(setup);
        y[fish->at.ay + k] = 2 * school_random(setup);
    }
    for (int i = fish->at.px; i < fish->at.ax; i++) y[i] = school_random(setup);
    for (int j = 0; j < fish->n_sheet; j++) y[fish->at.gamma + j] = school_random(setup);
    y[fish->at.circulation] = 0.4 * school_random(setup);
    y[fish->at.phi0] = 0.3 * school_random(setup);
    for (int i = fish->at.x; i < fish->at.end; i++) yp[i] = school_random(setup);
}

static void stir_wake(struct setup *setup, const struct fish *fish, struct wake *wake) {
    const double back[2] = {-cos(fish->start_heading), -sin(fish->start_heading)};
    for (int i = 0; i < 6; i++) {
        const double along = fish->length * (1.6 - 0.1 * i), across = 0.2 * fish->length * school_random(setup);
        // the oldest one is decaying
        const double age = i == 0 ? setup->school->lifetime - setup->school->decay / 2 : 0.5 * setup->school->lifetime;
        wake_release(wake, fish->start_position[0] + along * back[0] - across * back[1],
                     fish->start_position[1] + along * back[1] + across * back[0], 0.1 * school_random(setup),
                     setup->state->t - age);
        wake->u[i] = school_random(setup);
        wake->v[i] = school_random(setup);
        wake->u_before[i] = school_random(setup);
        wake->v_before[i] = school_random(setup);
    }
    for (int i = 0; i < 6 && setup->school->finite; i++) {
        wake->rate[i] = school_random(setup);
        wake->rate_before[i] = school_random(setup);
    }
    if (wake->has_markers) {
        // the newest one not far from the tail
        const double tail = fish->length * (1 + 0.05);
        wake->x[5] = fish->start_position[0] + tail * back[0];
        wake->y[5] = fish->start_position[1] + tail * back[1];
        wake_set_tail(wake, (const double[]){school_random(setup), school_random(setup)}, back);
    }
    wake->removed = 0.1 * school_random(setup);
    wake->shed_before = 0.3 * school_random(setup);
    wake->slip[0] = school_random(setup);
    wake->slip[1] = school_random(setup);
}

void school_stir(struct setup *setup) {
    struct state *state = setup->state;
    state->event = 10;
    state->t = 10 * setup->school->interval;
    setup->t = state->t + 0.4 * setup->school->interval;
    for (int f = 0; f < setup->school->n_fish; f++) {
        const struct fish *fish = &setup->school->fish[f];
        stir_fish(setup, fish, state->y, state->yp);
        stir_wake(setup, fish, &state->wake[f]);
        state->control[f].phi0 = 0.2 * school_random(setup);
        state->control[f].phi0_rate = school_random(setup);
        state->control[f].moment = 0.1 + 0.05 * f;
        state->control[f].moment_rate = -0.7;
        if (fish->control.law == CONTROL_PLACE) {
            state->control[f].drive = 0.3;
            state->control[f].drive_rate = 0.8;
        }
        // half way to what has been set from outside
        const double ramp = fish->control.ramp, t = setup->t - ramp / 2;
        if (fish->amplitude > 0) control_set(fish, &state->control[f], CONTROL_SET_AMPLITUDE, t, 0.8 * fish->amplitude);
        control_set(fish, &state->control[f], CONTROL_SET_FREQUENCY, t, fish->frequency + 0.2);
        control_set(fish, &state->control[f], CONTROL_SET_BIAS, t, fish->control.bias + 0.1);
    }
    residual_couple(&setup->residual->couplings, state->y);
}

void school_fill_wakes(struct setup *setup, int n) {
    for (int f = 0; f < setup->school->n_fish; f++) {
        const double *const nose = setup->school->fish[f].start_position;
        struct wake *const wake = &setup->state->wake[f];
        while (wake->n_vortex < n) {
            wake_release(wake, nose[0] + 1.1 + school_random(setup), nose[1] + 0.2 * school_random(setup),
                         0.1 * school_random(setup), setup->state->t);
        }
    }
}

struct wake *school_wake(struct setup *setup, int f, int n, double tail[2]) {
    const struct fish *const fish = &setup->school->fish[f];
    struct wake *const wake = &setup->state->wake[f];
    wake_resize(wake, n);
    wake->n_old = 0;
    for (int i = 0; i < n; i++) {
        wake->x[i] = wake->y[i] = wake->circulation[i] = 0;
        wake->u[i] = wake->v[i] = wake->u_before[i] = wake->v_before[i] = wake->rate[i] = wake->rate_before[i] = 0;
        wake->birth[i] = setup->state->t - setup->school->interval * (n - 1 - i);
    }
    fish_tail(fish, setup->state->y, tail);
    wake_set_tail(wake, (const double[]){0, 0}, fish_direction(fish, &fish->tail_tangent, setup->state->y).t);
    return wake;
}

void school_shed(struct setup *setup, int f) {
    struct wake *const wake = &setup->state->wake[f];
    wake->shed_before = wake->circulation[wake->n_vortex - 1];
    setup->state->y[setup->school->fish[f].at.circulation] = wake->shed_before;
}

void school_flow(struct setup *setup, const double *y) {
    flow_gradient(setup->residual->flow, setup->state, setup->t, y, false);
}

struct jacobian_scratch *school_influence(struct setup *setup, int f, int g) {
    struct jacobian_scratch *const jacobian_scratch = &setup->residual->jacobian_scratch[0];
    flow_derivative(setup->residual->flow, f, g, COLUMNS_OF_ALL, &jacobian_scratch->block);
    jacobian_scratch->rows.n_rows = flow_n_rows(&setup->school->fish[f]);
    jacobian_scratch->rows.n_columns = flow_n_columns(&setup->school->fish[g]);
    for (int i = 0; i < jacobian_scratch->rows.n_rows * jacobian_scratch->rows.n_columns; i++)
        jacobian_scratch->rows.value[i] = 0;
    return jacobian_scratch;
}

void school_add_rows(struct setup *setup, int f, int g, struct sparse *term) {
    const struct coupling_block *rows = &setup->residual->jacobian_scratch[0].rows;
    for (int c = 0; c < rows->n_columns; c++) {
        for (int r = 0; r < rows->n_rows; r++) {
            sparse_add(term, setup->school->fish[f].at.ax + r, flow_column(&setup->school->fish[g], c),
                       rows->value[c * rows->n_rows + r]);
        }
    }
}

// a block of a dense matrix of order n
static void copy_block(const struct sparse *block, size_t n, double *dense) {
    const size_t first = (size_t)block->first;
    for (size_t column = 0; column < (size_t)block->n; column++) {
        for (int64_t i = block->column_start[column]; i < block->column_start[column + 1]; i++) {
            dense[(first + (size_t)block->row_index[i]) * n + first + column] = block->value[i];
        }
    }
}

double *school_dense(struct arena *arena, const struct sparse *matrix) {
    const size_t n = (size_t)matrix->n;
    double *dense;
    NEW(arena, dense, n * n);
    copy_block(matrix, n, dense);
    return dense;
}

double *school_dense_jacobian(struct arena *arena, const struct jacobian *jacobian) {
    const struct school *school = jacobian->school;
    const size_t n = (size_t)school->n_unknowns;
    double *dense;
    NEW(arena, dense, n * n);
    for (int f = 0; f < school->n_fish; f++) {
        copy_block(jacobian->own[f], n, dense);
        for (int i = jacobian->first[f]; i < jacobian->first[f + 1]; i++) {
            const struct fish *other = &school->fish[jacobian->coupling[i].other];
            const struct coupling_block *rows = &jacobian->coupling[i].rows;
            for (int c = 0; c < rows->n_columns; c++) {
                for (int r = 0; r < rows->n_rows; r++) {
                    dense[(size_t)(school->fish[f].at.ax + r) * n + (size_t)flow_column(other, c)] =
                        rows->value[c * rows->n_rows + r];
                }
            }
        }
    }
    return dense;
}

/* The step of the differences for an unknown, and the size of its values. The sum of what is cut off, of relative size
 * (step/d)^4/30 with d the length over which the function changes, and of what is rounded off, 1e-16 size/step, is
 * smallest near these. The shortest d: bound vortex to control point, 2e-3 lengths at the ends of a sheet of 21. */
struct step {
    double step, size;
};
static struct step step_of(enum unknown kind) {
    switch (kind) {
        case UNKNOWN_X:
        case UNKNOWN_Y: return (struct step){1e-5, 1};
        case UNKNOWN_VX:
        case UNKNOWN_VY:
        case UNKNOWN_PX:
        case UNKNOWN_PY: return (struct step){1e-3, 1};
        case UNKNOWN_AX:
        case UNKNOWN_AY: return (struct step){1, 1};
        case UNKNOWN_GAMMA:
        case UNKNOWN_CIRCULATION: return (struct step){1e-3, 1};
        case UNKNOWN_PHI0: return (struct step){1e-3, 1};
    }
    return (struct step){0, 0};
}

// column j of dF/dy + cj dF/dyp by differences of fourth order
static void difference(struct setup *setup, school_value *value, double cj, int j, double step, double *column) {
    static const double node[4] = {-2, -1, 1, 2}, weight[4] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
    const size_t n = (size_t)setup->school->n_unknowns;
    double *const y = malloc(3 * n * sizeof *y), *const yp = y + n, *const at = y + 2 * n;
    assert_non_null(y);
    memset(column, 0, n * sizeof *column);
    memcpy(y, setup->state->y, n * sizeof *y);
    memcpy(yp, setup->state->yp, n * sizeof *yp);
    for (int i = 0; i < 4; i++) {
        y[j] = setup->state->y[j] + node[i] * step;
        yp[j] = setup->state->yp[j] + cj * (y[j] - setup->state->y[j]);
        memset(at, 0, n * sizeof *at);
        value(setup, y, yp, at);
        for (size_t row = 0; row < n; row++) column[row] += weight[i] / step * at[row];
    }
    free(y);
}

// no entry may differ by more than 1e-6 of the largest in its row among unknowns of the same kind (a large stiffness
// hides no error in a small drag), and what the differences round off
static void check_row(struct setup *setup, int row, const double *got, const double *want, const char *name) {
    const int n = setup->school->n_unknowns;
    double largest[UNKNOWN_PHI0 + 1] = {0}, size = 0;
    for (int j = 0; j < n; j++) {
        const enum unknown kind = residual_place(setup->school, j).kind;
        largest[kind] = fmax(largest[kind], fmax(fabs(got[j]), fabs(want[j])));
        size = fmax(size, fabs(want[j]) * step_of(kind).size);
    }
    // x and y, and so on, are of one kind
    for (int kind = UNKNOWN_X; kind < UNKNOWN_GAMMA; kind += 2) {
        largest[kind] = largest[kind + 1] = fmax(largest[kind], largest[kind + 1]);
    }
    for (int j = 0; j < n; j++) {
        const struct unknown_place of = residual_place(setup->school, j), in = residual_place(setup->school, row);
        const double allowed = 1e-6 * largest[of.kind] + 1e-14 * size / step_of(of.kind).step;
        if (fabs(got[j] - want[j]) <= allowed) continue;
        print_error(
            "%s: derivative of row %s[%d] of fish %d by %s[%d] of fish %d: derivative %.10g, differences %.10g, "
            "allowed %.3g\n",
            name, in.name, in.index, in.fish, of.name, of.index, of.fish, got[j], want[j], allowed);
        fail();
    }
}

void school_compare(struct setup *setup, school_value *value, school_jacobian *jacobian, const char *name) {
    const double cj = 37;
    const size_t n = (size_t)setup->school->n_unknowns;
    // once while recording, once replayed
    sparse_forget(setup->term);
    for (int f = 0; f < setup->school->n_fish; f++) sparse_forget(setup->jacobian->own[f]);
    for (int pass = 0; pass < 2; pass++) {
        school_flow(setup, setup->state->y);
        if (jacobian) {
            sparse_begin(setup->term);
            jacobian(setup, cj, setup->state->y, setup->term);
            sparse_end(setup->term);
        } else {
            school_ok(residual_jacobian(setup->residual, setup->mode, setup->t, cj, setup->state->y, setup->jacobian));
        }
        ARENA(arena, NULL, "dense matrices");
        double *const dense =
            jacobian ? school_dense(arena, setup->term) : school_dense_jacobian(arena, setup->jacobian);
        double *expected, *column;
        NEW(arena, expected, n * n);
        NEW(arena, column, n);
        for (size_t j = 0; j < n; j++) {
            difference(setup, value, cj, (int)j, step_of(residual_place(setup->school, (int)j).kind).step, column);
            for (size_t row = 0; row < n; row++) expected[row * n + j] = column[row];
        }
        for (size_t row = 0; row < n; row++) check_row(setup, (int)row, dense + row * n, expected + row * n, name);
    }
}

struct simulation *school_simulation(const char *text) {
    struct simulation *simulation;
    struct case_values values = school_values(text);
    school_ok(simulate_start(test_arena(), &simulation, &values, NULL));
    case_free(&values);
    return simulation;
}

struct simulation *school_simulation_of(const char *format, ...) {
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    assert_in_range(length, 1, sizeof text - 1);
    return school_simulation(text);
}

void school_run(struct simulation *simulation, double t) {
    while (simulation->state->t < t - simulation->school->interval / 2) school_ok(simulate_step(simulation));
}

void school_measure(struct simulation *simulation, double t) {
    school_run(simulation, t);
    simulate_measure(simulation);
}

struct integrator_counts school_counts(const struct simulation *simulation) {
    struct integrator_counts counts;
    simulate_count(simulation, &counts);
    return counts;
}

void school_fails(struct simulation *simulation, const char *message) {
    enum status status = STATUS_OK;
    for (int event = 0; event < 50 && status == STATUS_OK; event++) status = simulate_step(simulation);
    assert_int_equal(status, STATUS_SOLVER);
    if (!strstr(status_message(), message)) fail_msg("'%s' is not in: %s", message, status_message());
}

void school_shed_event_by_event(struct simulation *simulation) {
    const struct layout *at = &simulation->school->fish[0].at;
    const double *const y = simulation->state->y, *const yp = simulation->state->yp;
    const double step = simulation->school->interval;
    double q[5] = {y[at->circulation]};  // at the last events, newest first
    for (int n = 0; n < 20; n++) {
        school_ok(simulate_step(simulation));
        for (int i = 4; i > 0; i--) q[i] = q[i - 1];
        q[0] = y[at->circulation];
        const double line = (q[0] - q[1]) / step;
        const double quartic = (25 * q[0] - 48 * q[1] + 36 * q[2] - 16 * q[3] + 3 * q[4]) / (12 * step);
        if (n == 0 || n > 2) NEAR(yp[at->circulation], n == 0 ? line : quartic, 1e-11, 1e-11);
    }
    ABOVE(fabs(yp[at->circulation]), 1e-3);
}

void school_same_bits(const struct simulation *got, const struct simulation *want, const char *text) {
    for (int i = 0; i < state_table_n; i++) {
        const struct state_row *const row = &state_table[i];
        for (int f = 0; f < state_table_n_owners(row, want->school) && row->type != STATE_UNKEPT; f++) {
            const size_t n = state_table_length(row, want->state, want->school, f);
            const void *const one = state_table_values(row, got->state, f);
            const void *const other = state_table_values(row, want->state, f);
            if (state_table_length(row, got->state, got->school, f) != n ||
                memcmp(one, other, n * state_table_size(row)) != 0) {
                fail_msg("%s of fish %d differs, case:\n%s", row->name, f, text);
            }
        }
    }
    const struct integrator_counts counts[] = {school_counts(got), school_counts(want)};
    if (memcmp(&counts[0], &counts[1], sizeof *counts) != 0) fail_msg("the totals differ, case:\n%s", text);
    ABOVE(counts[0].steps, want->options.before.steps);
}
