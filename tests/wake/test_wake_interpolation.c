/* test_wake_interpolation.c: interpolated velocity against the sum over every vortex. doc/numerics.md, section 12. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "flow/flow_at_bodies.h"
#include "school.h"

// one fish in the wake of another fish, while the oldest vortices decay; the midpoints of one fish omit the own wake
static struct simulation *two_fish_in(const char *fluid, double tolerance, double interval, double smoothing) {
    struct simulation *const simulation = school_simulation_of(
        "%stime: {end: 1, shedding_interval: %g, output_interval: %g}\n"
        "wake: {tolerance: %g, smoothing: %g, lifetime: 0.5}\n"
        "fish: [{nodes: 5, sheet_points: 9, force: reactive}, {nodes: 6, sheet_points: 11, start: {position: "
        "[1.3, 0.2]}}]\n",
        fluid, interval, interval, tolerance, smoothing);
    school_run(simulation, 0.8);
    return simulation;
}

static struct simulation *two_fish(double tolerance, double interval, double smoothing) {
    return two_fish_in("", tolerance, interval, smoothing);
}

// unknowns at the fraction q of the interval: positions on the predicted path, or displaced by a drift in a fixed
// pattern
static double *later(const struct simulation *simulation, double q, double drift) {
    const struct state *const state = simulation->state;
    const double tau = q * simulation->school->interval;
    double *const y = malloc((size_t)simulation->school->n_unknowns * sizeof *y);

    assert_non_null(y);
    memcpy(y, state->y, (size_t)simulation->school->n_unknowns * sizeof *y);
    for (int f = 0; f < simulation->school->n_fish; f++) {
        const struct fish *const fish = &simulation->school->fish[f];
        for (int i = 0; i < 2 * fish->n_nodes; i++) {
            const double v = y[fish->at.vx + i], a = y[fish->at.ax + i];
            y[fish->at.x + i] += tau * (v + tau / 2 * a) + drift * sin(7 * i + f);
        }
    }

    return y;
}

// velocity at all points: interpolated, or (after flow_sum_exactly) summed over every vortex
static void evaluate(const struct simulation *simulation, double q, const double *y, double *u, double *v) {
    struct flow *const flow = simulation->residual->flow;
    school_ok(flow_velocity(flow, simulation->state, simulation->state->t + q * simulation->school->interval, y));
    memcpy(u, flow->u, (size_t)flow->n_points * sizeof *u);
    memcpy(v, flow->v, (size_t)flow->n_points * sizeof *v);
}

enum { POINTS = 64 };

static double worst_error(const struct simulation *simulation, double drift) {
    struct flow *const flow = simulation->residual->flow;
    assert_true(flow->n_points <= POINTS);
    double worst = 0;
    for (int i = 0; i <= 10; i++) {
        const double q = 0.1 * i;
        double *const y = later(simulation, q, drift);
        double u[2][POINTS], v[2][POINTS];
        flow_sum_exactly(flow);
        evaluate(simulation, 0, simulation->state->y, u[0], v[0]);
        school_ok(flow_interpolate(flow, simulation->state));
        evaluate(simulation, q, y, u[0], v[0]);
        assert_true(flow->by_interpolation[0] && flow->by_interpolation[1]);
        flow_sum_exactly(flow);
        evaluate(simulation, q, y, u[1], v[1]);
        assert_true(!flow->by_interpolation[0] && !flow->by_interpolation[1]);
        for (int p = 0; p < flow->n_points; p++) worst = fmax(worst, hypot(u[1][p] - u[0][p], v[1][p] - v[0][p]));
        free(y);
    }

    return worst;
}

static void the_error_stays_below_the_tolerance(void **state) {
    (void)state;

    // the finest tolerance of each case requires near vortices, coarser tolerances fewer or none
    const struct {
        double interval, smoothing, finest;
    } wakes[] = {{0.02, 0.2, 1e-6}, {0.005, 0.05, 1e-7}, {0.0025, 0.05, 1e-8}};
    for (size_t w = 0; w < sizeof wakes / sizeof *wakes; w++) {
        int last_near = 0;
        for (double coarser = 1000; coarser >= 1; coarser /= 10) {
            const double tolerance = wakes[w].finest * coarser;
            struct simulation *const simulation = two_fish(tolerance, wakes[w].interval, wakes[w].smoothing);
            const double error = worst_error(simulation, 0);
            const struct wake_interpolation *const interpolation = simulation->residual->flow->interpolation;
            const int n_near =
                wake_interpolation_n_near(interpolation, 0) + wake_interpolation_n_near(interpolation, 1);
            // length and frequency are 1; an error of 0 would mean that interpolation was not used
            if (error > tolerance || error == 0) {
                print_error("interval %g, smoothing %g, tolerance %g: error %g with %d near vortices\n",
                            wakes[w].interval, wakes[w].smoothing, tolerance, error, n_near);
                fail();
            }
            assert_true(n_near >= last_near);
            last_near = n_near;
            simulate_free(simulation);
        }

        assert_true(last_near > 0);
    }
}

static void images_in_walls_are_interpolated_as_exactly(void **state) {
    (void)state;
    static const char *const fluids[] = {"fluid: {walls: [-0.25]}\n", "fluid: {walls: [-0.25, 0.5]}\n"};
    for (int w = 0; w < 2; w++) {
        for (double tolerance = 1e-6; tolerance > 1e-8; tolerance /= 10) {
            struct simulation *const simulation = two_fish_in(fluids[w], tolerance, 0.005, 0.05);
            const double error = worst_error(simulation, 0);
            assert_true(error > 0 && error < tolerance);
            simulate_free(simulation);
        }
    }
}

// change of the velocity at all points by a drift, at the end of an interval: by interpolation or exactly
static int drift_changes(const struct simulation *simulation, int exactly, double change[2 * POINTS]) {
    struct flow *const flow = simulation->residual->flow;
    double u[2][POINTS], v[2][POINTS];
    if (exactly) {
        flow_sum_exactly(flow);
    } else {
        evaluate(simulation, 0, simulation->state->y, u[0], v[0]);
        school_ok(flow_interpolate(flow, simulation->state));
    }
    for (int i = 0; i < 2; i++) {
        double *const y = later(simulation, 1, i * 1e-5);
        evaluate(simulation, 1, y, u[i], v[i]);
        assert_int_equal(flow->by_interpolation[0] && flow->by_interpolation[1], !exactly);
        free(y);
    }
    for (int p = 0; p < flow->n_points; p++) {
        change[2 * p] = u[1][p] - u[0][p];
        change[2 * p + 1] = v[1][p] - v[0][p];
    }
    return 2 * flow->n_points;
}

static void at_the_end_of_an_interval_drift_counts_with_the_gradient_there(void **state) {
    (void)state;
    struct simulation *const simulation = two_fish(1e-3, 0.02, 0.2);
    double interpolated[2 * POINTS], exact[2 * POINTS], error = 0, most = 0;
    drift_changes(simulation, 0, interpolated);
    const int n = drift_changes(simulation, 1, exact);
    for (int i = 0; i < n; i++) {
        error = fmax(error, fabs(interpolated[i] - exact[i]));
        most = fmax(most, fabs(exact[i]));
    }
    print_message("drift changes the velocity by %.3g m/s at most, error %.3g\n", most, error);
    assert_true(error < 1e-3 * most);
    simulate_free(simulation);
}

static void with_drift_the_error_is_below_the_tolerance_or_every_vortex_is_summed(void **state) {
    (void)state;
    struct simulation *const simulation = two_fish(1e-5, 0.01, 0.2);

    // a gradient of 1 and a second derivative of 10 (in s and m): a drift of 1e-4 adds 1e-7
    const double error = worst_error(simulation, 1e-4);
    assert_true(error > 0 && error < 1e-5);

    // a large drift requires the sum over every vortex
    struct flow *const flow = simulation->residual->flow;
    double *const y = later(simulation, 0.5, 0.1), u[2][POINTS], v[2][POINTS];
    flow_sum_exactly(flow);
    evaluate(simulation, 0.5, y, u[0], v[0]);
    evaluate(simulation, 0, simulation->state->y, u[1], v[1]);
    school_ok(flow_interpolate(flow, simulation->state));
    evaluate(simulation, 0.5, y, u[1], v[1]);
    assert_true(flow->is_interpolated && !flow->by_interpolation[0] && !flow->by_interpolation[1]);
    assert_memory_equal(u[0], u[1], (size_t)flow->n_points * sizeof(double));
    assert_memory_equal(v[0], v[1], (size_t)flow->n_points * sizeof(double));
    free(y);
    simulate_free(simulation);
}

// residual at the fraction q of the interval, as the solver evaluates the residual
static void equations(const struct simulation *simulation, double q, const double *y, double *value) {
    struct residual *const residual = simulation->residual;
    const struct state *const state = simulation->state;
    school_ok(residual_evaluate(residual, state->t + q * simulation->school->interval, y, state->yp, value));
}

static void the_equations_do_not_depend_on_what_was_evaluated_before(void **state) {
    (void)state;
    struct simulation *const simulation = two_fish(1e-5, 0.01, 0.2);
    const struct flow *const flow = simulation->residual->flow;
    const size_t size = (size_t)simulation->school->n_unknowns * sizeof(double);
    double *const near = later(simulation, 0.5, 0), *const far = later(simulation, 0.5, 0.1);
    double *const first = malloc(size), *const again = malloc(size);
    assert_true(first && again);
    equations(simulation, 0.5, near, first);
    assert_true(flow->by_interpolation[0] && flow->by_interpolation[1]);

    // an iterate with a large drift (sum over every vortex), at the same time and at another time
    for (int i = 0; i < 2; i++) {
        equations(simulation, 0.5 + 0.2 * i, far, again);
        assert_true(!flow->by_interpolation[0] && !flow->by_interpolation[1]);
        equations(simulation, 0.5, near, again);
        assert_memory_equal(again, first, size);
    }

    free(near);
    free(far);
    free(first);
    free(again);
    simulate_free(simulation);
}

static void the_gradient_is_that_of_the_interpolated_velocity(void **state) {
    (void)state;

    // includes near vortices
    struct simulation *const simulation = two_fish(1e-6, 0.02, 0.2);
    struct flow *const flow = simulation->residual->flow;
    assert_true(wake_interpolation_n_near(flow->interpolation, 0) > 0);
    wake_interpolation_update(flow->interpolation, simulation->state->t + 0.3 * simulation->school->interval);
    for (int p = 0; p < flow->n_points; p++) {
        const int f = p >= flow->points[1].first;
        const double h = 1e-4;
        double got[5] = {0}, moved[4][2] = {{0}};
        const struct induced at = {1, &flow->x[p], &flow->y[p], &got[0], &got[1], &got[2], &got[3], &got[4]};
        wake_interpolation_induce(flow->interpolation, f, p, &at);
        for (int i = 0; i < 4; i++) {
            const double x = flow->x[p] + (i == 0   ? h
                                           : i == 1 ? -h
                                                    : 0),
                         y = flow->y[p] + (i == 2   ? h
                                           : i == 3 ? -h
                                                    : 0);
            const struct induced there = {1, &x, &y, &moved[i][0], &moved[i][1], NULL, NULL, NULL};
            wake_interpolation_induce(flow->interpolation, f, p, &there);
        }

        // third derivatives of order 100 times h^2/6
        NEAR(got[2], (moved[0][0] - moved[1][0]) / (2 * h), 2e-7, 0);
        NEAR(got[4], (moved[0][1] - moved[1][1]) / (2 * h), 2e-7, 0);
        NEAR(got[3], (moved[2][0] - moved[3][0]) / (2 * h), 2e-7, 0);
        NEAR(-got[2], (moved[2][1] - moved[3][1]) / (2 * h), 2e-7, 0);
    }

    simulate_free(simulation);
}

static void without_a_tolerance_nothing_is_interpolated(void **state) {
    (void)state;
    struct simulation *const simulation = two_fish(0, 0.02, 0.2);
    struct flow *const flow = simulation->residual->flow;
    assert_null(flow->interpolation);
    school_ok(flow_interpolate(flow, simulation->state));
    assert_false(flow->is_interpolated);
    simulate_free(simulation);
}

// nose and tail of both fish after 1 s
static void run(const char *solver, double *x) {
    struct simulation *const simulation = school_simulation_of(
        "time: {end: 1, shedding_interval: 0.01}\n"
        "solver: {rtol: 1e-9, order: 5%s}\n"
        "fish: [{}, {start: {position: [1.3, 0.2]}}]\n",
        solver);
    school_run(simulation, 1);
    for (int f = 0; f < 2; f++) {
        const struct fish *const fish = &simulation->school->fish[f];
        const double *const y = simulation->state->y;
        const int tail = fish->n_nodes - 1;
        const double ends[4] = {y[fish->at.x], y[fish->at.y], y[fish->at.x + tail], y[fish->at.y + tail]};
        memcpy(x + 4 * f, ends, sizeof ends);
    }

    simulate_free(simulation);
}

static void a_run_is_as_exact_as_the_tolerance(void **state) {
    (void)state;
    double exact[8], interpolated[8], coarse[8], threads[8];
    run("}\nwake: {tolerance: 0", exact);
    run("}\nwake: {tolerance: 1e-7", interpolated);
    run(", threads: 3}\nwake: {tolerance: 1e-7", threads);
    run("}\nwake: {tolerance: 1e-3", coarse);

    // tolerance of the wake plus tolerance of the solver
    NEAR_ARRAY(8, interpolated, exact, 1e-7, 0);
    NEAR_ARRAY(8, coarse, exact, 1e-3, 0);
    NEAR_ARRAY(8, threads, interpolated, 0, 0);
    assert_true(memcmp(interpolated, exact, sizeof exact) != 0);
}

// the largest displacement of a whole fish, m, for which the far field of the fish is interpolated
static double largest_drift(const struct simulation *simulation, int f) {
    struct flow *const flow = simulation->residual->flow;
    double u[POINTS], v[POINTS], low = 0, high = 1;
    for (int i = 0; i < 40; i++) {
        const double drift = (low + high) / 2;
        double *const y = later(simulation, 0.5, 0);
        for (int g = 0; g < simulation->school->n_fish; g++) {
            const struct fish *const fish = &simulation->school->fish[g];
            for (int k = 0; k < fish->n_nodes; k++) y[fish->at.x + k] += drift;
        }
        evaluate(simulation, 0.5, y, u, v);
        *(flow->by_interpolation[f] ? &low : &high) = drift;
        free(y);
    }
    return low;
}

static void near_and_far_fields_do_not_depend_on_the_order_of_the_fish(void **state) {
    (void)state;
    static const char *const fish[2] = {
        "nodes: 5, sheet_points: 9, force: reactive",
        "nodes: 6, sheet_points: 11, force: reactive, length: 0.9, start: {position: [1.3, 0.4]}"};
    static const char *const fluids[] = {"", "fluid: {walls: [-0.8]}\n"};
    for (int w = 0; w < 2; w++) {
        for (double tolerance = 1e-2; tolerance > 1e-8; tolerance /= 1000) {
            double drift[2][2];
            int n_near[2][2];
            for (int order = 0; order < 2; order++) {
                struct simulation *const simulation = school_simulation_of(
                    "%stime: {end: 1, shedding_interval: 0.01, output_interval: 0.01}\n"
                    "wake: {tolerance: %g, smoothing: 0.1, lifetime: 0.3, decay: 0.2}\n"
                    "fish: [{%s}, {%s}]\n",
                    fluids[w], tolerance, fish[order], fish[1 - order]);
                school_run(simulation, 0.35);
                struct flow *const flow = simulation->residual->flow;
                school_ok(flow_interpolate(flow, simulation->state));
                for (int f = 0; f < 2; f++) {
                    const int k = order == 0 ? f : 1 - f;
                    n_near[order][k] = wake_interpolation_n_near(flow->interpolation, f);
                    drift[order][k] = largest_drift(simulation, f);
                }
                simulate_free(simulation);
            }
            for (int k = 0; k < 2; k++) {
                print_message("tolerance %g, fish %d: %d near, drift up to %.6g\n", tolerance, k, n_near[0][k],
                              drift[0][k]);
                assert_int_equal(n_near[1][k], n_near[0][k]);
                // steps of the integrator differ
                NEAR(drift[1][k], drift[0][k], 0, 1e-3);
                assert_true(drift[0][k] > 0 && drift[0][k] < 0.5);
            }
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_error_stays_below_the_tolerance),
        cmocka_unit_test(images_in_walls_are_interpolated_as_exactly),
        cmocka_unit_test(with_drift_the_error_is_below_the_tolerance_or_every_vortex_is_summed),
        cmocka_unit_test(at_the_end_of_an_interval_drift_counts_with_the_gradient_there),
        cmocka_unit_test(the_equations_do_not_depend_on_what_was_evaluated_before),
        cmocka_unit_test(the_gradient_is_that_of_the_interpolated_velocity),
        cmocka_unit_test(near_and_far_fields_do_not_depend_on_the_order_of_the_fish),
        cmocka_unit_test(without_a_tolerance_nothing_is_interpolated),
        cmocka_unit_test(a_run_is_as_exact_as_the_tolerance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
