/* test_lacking_memory.c: every x_create fails cleanly at each allocation. */
#include "failing_malloc.h"
#include "fish/fish_school.h"
#include "school.h"
#include "solver/integrator.h"
#include "solver/ode_rhs.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"

static const char *const text = TIME
    "fish:\n"
    "  - {nodes: 5, sheet_points: 7, control: {law: heading, waypoints: [[-3, 1]]}}\n"
    "  - {nodes: 4, sheet_points: 5, start: {position: [0, 2]}, control: {law: heading, desired_heading: [[0, 180], "
    "[1, 90]]}}\n";

/* An object that is created from a setup, and released. */
typedef enum status create(struct setup *setup, void **made);
typedef void release(struct setup *setup, void *made);

static enum status create_school(struct setup *setup, void **made) {
    return fish_school_create((struct school **)made, &setup->values.school);
}
static void release_school(struct setup *setup, void *made) {
    (void)setup;
    fish_school_free(made);
}

static enum status create_state(struct setup *setup, void **made) {
    return state_create((struct state **)made, setup->school);
}
static void release_state(struct setup *setup, void *made) {
    state_free(made, setup->school);
}

static enum status create_residual(struct setup *setup, void **made) {
    return residual_create((struct residual **)made, setup->school, setup->state);
}
static void release_residual(struct setup *setup, void *made) {
    (void)setup;
    residual_free(made);
}

static enum status create_consistent(struct setup *setup, void **made) {
    return initial_conditions_create((struct initial_conditions **)made, setup->residual);
}
static void release_consistent(struct setup *setup, void *made) {
    (void)setup;
    initial_conditions_free(made);
}

static enum status create_measure(struct setup *setup, void **made) {
    return diagnostics_create((struct diagnostics **)made, setup->school);
}
static void release_measure(struct setup *setup, void *made) {
    (void)setup;
    diagnostics_free(made);
}

static enum status create_flow(struct setup *setup, void **made) {
    return flow_create((struct flow **)made, setup->school);
}
static void release_flow(struct setup *setup, void *made) {
    (void)setup;
    flow_free(made);
}

static enum status create_sparse(struct setup *setup, void **made) {
    (void)setup;
    return sparse_create((struct sparse **)made, 0, 10);
}
static void release_sparse(struct setup *setup, void *made) {
    (void)setup;
    sparse_free(made);
}

static enum status create_wake(struct setup *setup, void **made) {
    *made = &setup->state->wake[0];
    wake_free(*made);
    const enum status status = wake_create(*made, 4);
    if (status != STATUS_OK) *made = NULL;
    return status;
}
static void release_wake(struct setup *setup, void *made) {
    (void)setup;
    wake_free(made);
}

static enum status create_implicit(struct setup *setup, void **made) {
    const struct integrator_options options = {.order = 2, .max_steps = 100};
    return ida_integrator.create(made, setup->residual, setup->state, &options);
}
static void release_implicit(struct setup *setup, void *made) {
    (void)setup;
    ida_integrator.free(made);
}

static enum status create_direct(struct setup *setup, void **made) {
    return ode_rhs_create((struct ode_rhs **)made, setup->residual);
}
static void release_direct(struct setup *setup, void *made) {
    (void)setup;
    ode_rhs_free(made);
}

static enum status create_explicit(struct setup *setup, void **made) {
    const struct integrator_options options = {.method = METHOD_RK4, .max_steps = 100};
    return runge_kutta_integrator.create(made, setup->residual, setup->state, &options);
}
static void release_explicit(struct setup *setup, void *made) {
    (void)setup;
    runge_kutta_integrator.free(made);
}

static enum status create_fixed(struct setup *setup, void **made) {
    const struct integrator_options options = {.method = METHOD_TRAPEZOID, .step = 0.01, .max_steps = 100};
    return one_step_integrator.create(made, setup->residual, setup->state, &options);
}
static void release_fixed(struct setup *setup, void *made) {
    (void)setup;
    one_step_integrator.free(made);
}

static enum status create_simulation(struct setup *setup, void **made) {
    return simulate_create((struct simulation **)made, &setup->values);
}
static void release_simulation(struct setup *setup, void *made) {
    (void)setup;
    simulate_free(made);
}

// let the first, second, ... allocation fail until all succeed; returns the number of failed allocations
static int fail_one_by_one(create *make, release *drop, const char *name) {
    struct setup setup;
    school_build(&setup, text);
    int n_failed = 0;
    enum status status = STATUS_MEMORY;
    for (; status != STATUS_OK; n_failed += status != STATUS_OK) {
        // the sources may keep memory from an earlier failure; all memory of a failed create must be released
        wake_free(&setup.state->wake[0]);
        void *made = &setup;
        const int n_before = n_live;
        n_until_failure = n_failed;
        status = make(&setup, &made);
        n_until_failure = -1;
        if (status == STATUS_OK) {
            assert_non_null(made);
            drop(&setup, made);
        } else {
            assert_int_equal(status, STATUS_MEMORY);
            assert_null(made);
            assert_true(status_message()[0] != 0);
        }
        if (n_live != n_before) {
            print_error("%s: with allocation %d failing %d are left\n", name, n_failed, n_live - n_before);
            fail();
        }
        assert_true(n_failed < 10000);
    }
    school_clear(&setup);
    return n_failed;
}

static void every_create_fails_cleanly_at_every_allocation(void **state) {
    (void)state;
    const struct {
        create *make;
        release *drop;
        const char *name;
        int least; /* allocations */
    } all[] = {{create_school, release_school, "school", 40},
               {create_state, release_state, "state", 20},
               {create_residual, release_residual, "residual", 15},
               {create_consistent, release_consistent, "consistent", 8},
               {create_measure, release_measure, "measure", 2},
               {create_flow, release_flow, "flow", 14},
               {create_sparse, release_sparse, "sparse", 4},
               {create_wake, release_wake, "wake", 8},
               {create_implicit, release_implicit, "implicit", 7},
               {create_direct, release_direct, "direct", 17},
               {create_explicit, release_explicit, "explicit", 22},
               {create_fixed, release_fixed, "fixed", 10},
               {create_simulation, release_simulation, "simulation", 100}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        const int n_failed = fail_one_by_one(all[i].make, all[i].drop, all[i].name);
        assert_true(n_failed >= all[i].least);
    }
}

static void every_free_accepts_nothing(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, text);
    release *const all[] = {release_school,  release_state,    release_residual, release_consistent,
                            release_measure, release_flow,     release_sparse,   release_implicit,
                            release_direct,  release_explicit, release_fixed,    release_simulation};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) all[i](&setup, NULL);
    school_clear(&setup);
}

static void a_wake_that_cannot_grow_stays_as_it_is(void **state) {
    (void)state;
    struct wake wake;
    school_ok(wake_create(&wake, 2));
    school_ok(wake_release(&wake, 1, 2, 3, 4));
    school_ok(wake_release(&wake, 5, 6, 7, 8));
    for (int n = 0; n < 8; n++) {
        n_until_failure = n;
        const enum status status = wake_release(&wake, 9, 9, 9, 9);
        n_until_failure = -1;
        assert_int_equal(status, STATUS_MEMORY);
        assert_int_equal(wake.n_vortex, 2);
        NEAR(wake.x[1], 5, 0, 0);
        NEAR(wake.birth[1], 8, 0, 0);
    }
    school_ok(wake_release(&wake, 9, 9, 9, 9));
    NEAR(wake.x[1], 5, 0, 0);
    NEAR(wake.x[2], 9, 0, 0);
    wake_free(&wake);
}

static void a_matrix_that_could_not_be_recorded_records_again(void **state) {
    (void)state;
    struct sparse *matrix;
    school_ok(sparse_create(&matrix, 0, 50));
    // entries 0 .. 2499: recording grows twice, compiling allocates six times
    int n_failed = 0;
    enum status status = STATUS_MEMORY;
    for (; status != STATUS_OK; n_failed += status != STATUS_OK) {
        n_until_failure = n_failed;
        sparse_begin(matrix);
        for (int i = 0; i < 2500; i++) sparse_add(matrix, i / 50, i % 50, i);
        status = sparse_end(matrix);
        n_until_failure = -1;
        if (status != STATUS_OK) assert_int_equal(status, STATUS_MEMORY);
        assert_true(n_failed < 100);
    }
    assert_true(n_failed >= 6);
    assert_int_equal(matrix->n_nonzeros, 2500);
    for (int i = 0; i < 2500; i++) NEAR(matrix->value[i], (i % 50) * 50 + i / 50, 0, 0);
    sparse_free(matrix);
}

static void a_run_without_memory_for_a_step_fails_with_a_message(void **state) {
    (void)state;
    int n_failed = 0;
    for (int n = 0; n < 60; n += 3) {
        struct simulation *const simulation = school_simulation(text);
        // the wake, with a capacity of sixteen, grows at the seventeenth event
        for (int i = 0; i < 16; i++) school_ok(simulate_step(simulation));
        n_until_failure = n;
        enum status status = STATUS_OK;
        for (int i = 0; i < 3 && status == STATUS_OK; i++) status = simulate_step(simulation);
        n_until_failure = -1;
        if (status != STATUS_OK) {
            n_failed++;
            assert_true(status == STATUS_MEMORY || status == STATUS_SOLVER);
        }
        simulate_free(simulation);
    }
    assert_true(n_failed > 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_create_fails_cleanly_at_every_allocation),
        cmocka_unit_test(every_free_accepts_nothing),
        cmocka_unit_test(a_wake_that_cannot_grow_stays_as_it_is),
        cmocka_unit_test(a_matrix_that_could_not_be_recorded_records_again),
        cmocka_unit_test(a_run_without_memory_for_a_step_fails_with_a_message),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
