/* test_ida_newton.c: Newton's iteration is run on equations whose Jacobian is wrong by a known factor, so that its rate
 * and its decisions are known. */
#include <stdlib.h>

#include "school.h"
#include "solver/ida_newton.h"

/* The equations y - root + bend (y - root)^2 = 0 for each unknown by itself; the Jacobian that the solver gets is that
 * at the last set-up, times 1 / (1 - wrong): each iteration leaves the fraction wrong of the error. */
struct problem {
    struct setup setup;
    struct sundials_context context;
    enum status failure;
    SUNNonlinearSolver solver;
    N_Vector predicted, total, weights, kinds;
    double root, bend, wrong;
    /* of unknown 0, where it differs: the place of its root, and how wrong its Jacobian is */
    double root_of_first, wrong_for_first;
    double slope;       /* 1 / the Jacobian */
    double growth;      /* added to wrong at each solution */
    double coefficient; /* of the step */
    bool is_periodic, is_traced;
    int n_residuals, n_set_ups, n_bad, n_updates, never_finite;
    double updated;  /* how wrong the Jacobian is after an update; 0: there are none */
    long iterations; /* of the last solution */
    /* the record of a solution, while one is wanted, and the results of recorded solutions */
    int n_recorded, last_code;
    struct trace_attempt attempt;
};

// of all unknowns but the first; the last one is predicted as 0
static double error_of(const struct problem *problem, N_Vector total) {
    const long last = NV_LENGTH_S(total) - 1;
    return NV_Ith_S(problem->predicted, last) + NV_Ith_S(total, last) - problem->root;
}

static double error_of_first(const struct problem *problem, N_Vector total) {
    return NV_Ith_S(problem->predicted, 0) + NV_Ith_S(total, 0) - problem->root_of_first;
}

static int residual(N_Vector total, N_Vector value, void *data) {
    struct problem *const problem = data;
    problem->n_residuals++;
    const double error = error_of(problem, total);
    N_VConst(problem->never_finite ? NAN : error + problem->bend * error * error, value);
    if (problem->wrong_for_first > 0) NV_Ith_S(value, 0) = error_of_first(problem, total);
    return 0;
}

static int set_up_matrix(sunbooleantype bad, sunbooleantype *current, void *data) {
    struct problem *const problem = data;
    problem->n_set_ups++;
    problem->n_bad += bad;
    *current = SUNTRUE;
    problem->wrong = 0;
    problem->slope = 1 / (1 + 2 * problem->bend * error_of(problem, problem->total));
    return 0;
}

static int solve_matrix(N_Vector value, void *data) {
    const struct problem *const problem = data;
    const double first = (1 - problem->wrong_for_first) * NV_Ith_S(value, 0);
    N_VScale((1 - problem->wrong) * problem->slope, value, value);
    if (problem->wrong_for_first > 0) NV_Ith_S(value, 0) = first;
    return 0;
}

static double coefficient(void *data) {
    const struct problem *const problem = data;
    return problem->coefficient;
}

static void update(void *data) {
    struct problem *const problem = data;
    // the residual has been evaluated at the guess
    assert_int_equal(problem->n_residuals, 1);
    problem->n_updates++;
    problem->wrong = problem->updated;
}

static struct trace_attempt *attempt_of(void *data) {
    struct problem *const problem = data;
    return problem->is_traced ? &problem->attempt : NULL;
}

static void attempted(void *data, int code) {
    struct problem *const problem = data;
    problem->n_recorded++;
    problem->last_code = code;
}

static struct problem *pose(double updated, bool is_periodic) {
    struct problem *problem;
    NEW(test_arena(), problem, 1);
    *problem = (struct problem){.root = 1, .coefficient = 100, .updated = updated, .is_periodic = is_periodic};
    school_build(&problem->setup, "time: {end: 1}\nfish: [{nodes: 4, sheet_points: 7, body: {depth: 1}}]\n");
    const int n = problem->setup.school->n_unknowns;
    sundials_context_create(&problem->context, problem->setup.arena, n, 1, &problem->failure);
    problem->predicted = sundials_context_vector(&problem->context, NULL);
    problem->total = sundials_context_vector(&problem->context, NULL);
    problem->weights = sundials_context_vector(&problem->context, NULL);
    problem->kinds = sundials_context_vector(&problem->context, NULL);
    N_VConst(0, problem->kinds);
    NV_Ith_S(problem->kinds, 0) = 1;
    N_VConst(0, problem->predicted);
    N_VConst(1, problem->weights);
    // the positions of a straight body; the first unknown is 0
    const struct fish *fish = problem->setup.school->fish;
    for (int k = 0; k < fish->n_nodes; k++) NV_Ith_S(problem->predicted, fish->at.x + k) = k * fish->edge_length;
    const struct ida_newton_rules rules = {.max_iterations = 6,
                                           .max_with_new = 20,
                                           .jacobian_cost = 5,
                                           .kinds = problem->kinds,
                                           .is_periodic = problem->is_periodic,
                                           .data = problem,
                                           .leading_coefficient = coefficient,
                                           .update = problem->updated > 0 ? update : NULL,
                                           .attempt = attempt_of,
                                           .attempted = attempted};
    problem->solver = ida_newton_create(&problem->context, problem->setup.school, rules);
    assert_int_equal(SUNNonlinSolGetType(problem->solver), SUNNONLINEARSOLVER_ROOTFIND);
    assert_int_equal(SUNNonlinSolSetSysFn(problem->solver, residual), 0);
    assert_int_equal(SUNNonlinSolSetLSetupFn(problem->solver, set_up_matrix), 0);
    assert_int_equal(SUNNonlinSolSetLSolveFn(problem->solver, solve_matrix), 0);
    assert_int_equal(SUNNonlinSolInitialize(problem->solver), 0);
    return problem;
}

// solve as IDA does
static int solve(struct problem *problem, double tolerance, int evaluate) {
    problem->n_residuals = problem->n_set_ups = problem->n_bad = problem->n_updates = 0;
    problem->wrong += problem->growth;
    N_VConst(0, problem->total);
    const int code = SUNNonlinSolSolve(problem->solver, problem->predicted, problem->total, problem->weights, tolerance,
                                       evaluate, problem);
    assert_int_equal(SUNNonlinSolGetNumIters(problem->solver, &problem->iterations), 0);
    return code;
}

// a problem with the Jacobian of its first solution
static struct problem *pose_and_solve(double updated, bool is_periodic) {
    struct problem *const problem = pose(updated, is_periodic);
    assert_int_equal(solve(problem, 1e-6, 1), 0);
    return problem;
}

// solve for another root, with another step, an old Jacobian and the error that each iteration leaves
static void solve_again(struct problem *problem, double wrong, double tolerance) {
    problem->root = 2;
    problem->coefficient *= 2;
    problem->wrong = wrong;
    assert_int_equal(solve(problem, tolerance, 0), 0);
}

static long failures_of(const struct problem *problem) {
    long failures;
    assert_int_equal(SUNNonlinSolGetNumConvFails(problem->solver, &failures), 0);
    return failures;
}

TEST(an_exact_jacobian_needs_two_iterations) {
    struct problem *const problem = pose_and_solve(0, 0);
    assert_int_equal(problem->iterations, 2);
    assert_int_equal(problem->n_residuals, 2);
    assert_int_equal(problem->n_set_ups, 1);
    NEAR(error_of(problem, problem->total), 0, 1e-15, 0);
}

TEST(the_error_left_is_below_the_tolerance) {
    // linear convergence: the estimate from the rate is the error itself
    const double wrongs[] = {0.01, 0.1, 0.3, -0.3};
    const double tolerances[] = {1e-2, 4e-3};
    for (size_t i = 0; i < sizeof wrongs / sizeof *wrongs; i++) {
        for (int j = 0; j < 2; j++) {
            struct problem *const problem = pose_and_solve(0, 0);
            solve_again(problem, wrongs[i], tolerances[j]);
            assert_int_equal(problem->n_set_ups, 0);
            const double rate = fabs(wrongs[i]), left = fabs(error_of(problem, problem->total));
            NEAR(left, 2 * pow(rate, (double)problem->iterations), 0, 1e-9);
            AT_MOST(left, (wrongs[i] > 0 ? 1 : (1 + rate) / (1 - rate)) * tolerances[j]);
            // one iteration less is not enough, or cannot show the rate
            if (problem->iterations != 2) ABOVE(left, rate * rate * tolerances[j]);
            assert_int_equal(failures_of(problem), 0);
        }
    }
}

TEST(an_old_jacobian_that_does_not_converge_is_replaced) {
    // too slow, divergent, or not within the maximum of iterations
    const double wrongs[] = {0.95, -1.5, 0.8};
    for (size_t i = 0; i < sizeof wrongs / sizeof *wrongs; i++) {
        struct problem *const problem = pose_and_solve(0, 0);
        solve_again(problem, wrongs[i], 1e-6);
        assert_int_equal(problem->n_set_ups, 1);
        assert_int_equal(problem->n_bad, 1);
        assert_int_equal(failures_of(problem), 1);
        // it fails as soon as the rate shows
        assert_int_equal(problem->iterations, (wrongs[i] == 0.8 ? 6 : 3) + 2);
        NEAR(error_of(problem, problem->total), 0, 1e-12, 0);
    }
}

TEST(slow_places_show_beside_fast_algebraic_unknowns) {
    struct problem *const problem = pose_and_solve(0, 0);
    // the algebraic ones change by 1 and are right at once; the first unknown changes by 0.05, and slowly
    problem->root = 2;
    problem->coefficient *= 2;
    problem->wrong = 1e-6;
    problem->root_of_first = 0.05;
    problem->wrong_for_first = 0.3;
    assert_int_equal(solve(problem, 1e-4, 0), 0);
    // in the root mean square over all unknowns
    const double left = fabs(error_of_first(problem, problem->total)) / sqrt((double)NV_LENGTH_S(problem->total));
    AT_MOST(left, 1e-4);
    ABOVE(problem->iterations, 3);
}

TEST(an_old_jacobian_is_updated_once_in_a_solution) {
    struct problem *const problem = pose_and_solve(0.01, 0);
    // a new one is not
    assert_int_equal(problem->n_updates, 0);
    // without the update this one would not converge
    solve_again(problem, 0.95, 1e-6);
    assert_int_equal(problem->n_updates, 1);
    assert_int_equal(problem->n_set_ups, 0);
    AT_MOST(problem->iterations, 4);
}

TEST(small_corrections_that_do_not_shrink_are_noise) {
    struct problem *const problem = pose_and_solve(0, 0);
    // corrections of 0.05 and 0.0475 tolerances
    problem->root = 1 + 1e-6;
    problem->wrong = 0.95;
    assert_int_equal(solve(problem, 1e-6, 0), 0);
    assert_int_equal(problem->iterations, 2);
    assert_int_equal(failures_of(problem), 0);
    AT_MOST(fabs(error_of(problem, problem->total)), 1e-6);
}

TEST(a_new_jacobian_that_leaves_something_out_may_take_longer) {
    struct problem *const problem = pose(0, 0);
    problem->root_of_first = 1;
    problem->wrong_for_first = 0.3;
    assert_int_equal(solve(problem, 1e-6, 1), 0);
    assert_in_range(problem->iterations, 8, 14);
    const double left = fabs(error_of_first(problem, problem->total)) / sqrt((double)NV_LENGTH_S(problem->total));
    AT_MOST(left, 1e-6);
    // but not for ever
    problem->wrong_for_first = 0.8;
    problem->coefficient *= 2;
    assert_int_equal(solve(problem, 1e-6, 1), SUN_NLS_CONV_RECVR);
    assert_int_equal(problem->iterations, 20);
}

TEST(a_failure_with_a_new_jacobian_asks_for_a_smaller_step) {
    struct problem *const problem = pose(0, 0);
    // no root: y^2 + ... stays above zero
    problem->root = 0;
    problem->never_finite = 1;
    assert_int_equal(solve(problem, 1e-6, 1), SUN_NLS_CONV_RECVR);
    assert_int_equal(problem->iterations, 1);
}

TEST(the_last_correction_is_the_guess_while_the_step_stays) {
    struct problem *const problem = pose_and_solve(0, 0);
    // the same correction again: the guess is the solution
    problem->wrong = 0.3;
    assert_int_equal(solve(problem, 1e-6, 0), 0);
    assert_int_equal(problem->iterations, 1);
    // not with another step
    problem->coefficient *= 1.001;
    assert_int_equal(solve(problem, 1e-3, 0), 0);
    ABOVE(problem->iterations, 2);
    // nor after a restart, whatever the step
    assert_int_equal(SUNNonlinSolInitialize(problem->solver), 0);
    assert_int_equal(solve(problem, 1e-3, 0), 0);
    ABOVE(problem->iterations, 2);
}

TEST(the_start_has_the_period_of_the_corrections) {
    // corrections with a period of solutions, which grow: the first solution of the third period starts at the root
    for (int period = 1; period <= 4; period++) {
        struct problem *const problem = pose(0, 1);
        for (int i = 0; i <= 2 * period; i++) {
            const double of_phase[] = {1, -3, 0.5, 2};
            problem->root = of_phase[i % period] * (1 + 0.01 * (i / period));
            assert_int_equal(solve(problem, 1e-6, i == 0), 0);
            assert_int_equal(problem->iterations, i < 2 * period ? 2 : 1);
        }
        NEAR(error_of(problem, problem->total), 0, 1e-10, 0);
        // not with another step
        problem->coefficient *= 1.001;
        assert_int_equal(solve(problem, 1e-6, 0), 0);
        assert_int_equal(problem->iterations, 2);
    }
}

TEST(without_a_period_the_start_is_the_last_correction) {
    struct problem *const problem = pose(0, 0);
    for (int i = 0; i < 6; i++) {
        problem->root = i % 2 == 0 ? 1 : -3;
        assert_int_equal(solve(problem, 1e-6, i == 0), 0);
    }
    // the last root once more, where a period of two would promise the other root
    assert_int_equal(solve(problem, 1e-6, 0), 0);
    assert_int_equal(problem->iterations, 1);
}

TEST(a_jacobian_that_has_become_expensive_is_evaluated_again) {
    struct problem *const problem = pose_and_solve(0, 0);
    long before = 0;
    int served = 1, spent = (int)problem->iterations;
    for (problem->growth = 0.01;; served++) {
        before = problem->iterations;
        problem->coefficient *= 2;
        assert_int_equal(solve(problem, 1e-6, 0), 0);
        if (problem->n_set_ups > 0) break;
        spent += (int)problem->iterations;
        BELOW(served, 100);
    }
    // not after a failure, but when the last solution cost as much as the mean one, the Jacobian's cost of 5 included
    assert_int_equal(problem->n_bad, 0);
    AT_LEAST(before * served, spent + 5);
    BELOW(before * (served - 1), spent - before + 5 + served);
    ABOVE(served, 2);
}

TEST(corrections_are_recorded_only_while_they_are_wanted) {
    struct problem *const problem = pose(0, 0);
    problem->attempt.n_corrections = -1;
    assert_int_equal(solve(problem, 1e-6, 1), 0);
    assert_int_equal(problem->n_recorded, 0);
    assert_int_equal(problem->attempt.n_corrections, -1);

    // an old Jacobian that leaves a tenth of the error: of 1, 0.1, 0.01 in each unknown
    problem->is_traced = 1;
    solve_again(problem, 0.1, 4e-3);
    const struct trace_attempt *const attempt = &problem->attempt;
    assert_int_equal(problem->n_recorded, 1);
    assert_int_equal(problem->last_code, 0);
    assert_int_equal(attempt->n_corrections, problem->iterations);
    assert_int_equal(attempt->age, 1);
    for (int i = 0; i < attempt->n_corrections; i++) {
        NEAR(attempt->norm[i], 1.8 * pow(0.1, i), 0, 1e-9);
        assert_int_equal(attempt->is_first[i], i == 0);
        if (i > 0) NEAR(attempt->rate[i], 0.1, 0, 1e-9);
    }

    // one that fails is replaced within the same record
    problem->root = 3;
    problem->coefficient *= 2;
    problem->wrong = 0.95;
    assert_int_equal(solve(problem, 1e-6, 0), 0);
    assert_int_equal(problem->n_recorded, 2);
    assert_int_equal(attempt->n_corrections, 5);
    assert_true(attempt->is_first[3]);

    problem->is_traced = 0;
    problem->coefficient *= 2;
    assert_int_equal(solve(problem, 1e-6, 0), 0);
    assert_int_equal(problem->n_recorded, 2);
    assert_int_equal(attempt->n_corrections, 5);
}
