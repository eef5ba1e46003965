/* ida_newton.c: the iteration with its start, its test of convergence, and the decision when a new Jacobian pays. */
#include "solver/ida_newton.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/* A correction is judged by two norms, over all unknowns and over the differential ones only. In the first norm the
 * algebraic unknowns would hide that positions converge slowly: with a free sheet the first correction of the
 * circulation is a hundred times larger than the others, and the second removes it. */
enum { ALL, DIFFERENTIAL, N_NORMS };

/* Total corrections of steps up to MOST_LAG apart may be alike. To find the lag, two periods are kept. */
enum { MOST_LAG = 4, N_PAST = 2 * MOST_LAG };

struct ida_newton {
    struct ida_newton_rules rules;
    struct corotation *corotation;
    N_Vector correction;
    N_Vector past[N_PAST]; /* total corrections of the last solutions with this leading coefficient, newest first */
    int n_past;
    double coefficient; /* leading coefficient of the last solution */

    /* functions of IDA */
    SUNNonlinSolSysFn residual;
    SUNNonlinSolLSetupFn set_up;
    SUNNonlinSolLSolveFn solve;

    /* during this solution */
    long iterations, failures;
    int done, most;        /* iterations with the present Jacobian, and their maximum */
    double first[N_NORMS]; /* size of the first correction */

    /* since the evaluation of the Jacobian: solutions, their iterations, iterations of the last solution */
    int n_solutions, n_iterations, n_last;
    bool is_incomplete;            /* a new Jacobian would be more complete */
    struct trace_attempt *attempt; /* corrections of this solution; NULL: not recorded */
};

// judge a correction by one norm: has the iteration converged, should it continue, or has it failed?
static int newton_test(struct ida_newton *newton, int norm, double size, double tolerance) {
    if (!isfinite(size)) return SUN_NLS_CONV_RECVR;
    if (newton->done == 1) {
        newton->first[norm] = size;
        // one correction tells nothing about the rate, so accept it only if it is mere rounding
        return size <= 1e-4 * tolerance ? SUN_SUCCESS : SUN_NLS_CONTINUE;
    }
    const double rate = size > 0 ? pow(size / newton->first[norm], 1.0 / (newton->done - 1)) : 0;
    // At the noise level of the linear solver corrections no longer shrink; small ones are accepted there.
    const double remaining = rate < 0.9 ? rate / (1 - rate) : 10;
    if (size * remaining <= tolerance) return SUN_SUCCESS;
    // with an old Jacobian the first two corrections may grow
    if (newton->done > 2 && rate >= 0.9) return SUN_NLS_CONV_RECVR;
    return newton->done < newton->most ? SUN_NLS_CONTINUE : SUN_NLS_CONV_RECVR;
}

// keep a correction for the trace: its norms, and the unknown that it changes most
static void newton_record(struct ida_newton *newton, double all, double differential, const double *correction,
                          const double *weight) {
    struct trace_attempt *const attempt = newton->attempt;
    const int n = (int)N_VGetLength(newton->correction), i = attempt->n_corrections++;
    for (int k = 0; k < n; k++) {
        const double weighted = fabs(correction[k] * weight[k]);
        if (k > 0 && !(weighted > attempt->worst_correction)) continue;
        attempt->worst = k;
        attempt->worst_correction = weighted;
    }
    if (i >= TRACE_MOST_CORRECTIONS) return;
    attempt->is_first[i] = newton->done == 1;
    attempt->norm[i] = all;
    attempt->differential[i] = differential;
    attempt->rate[i] = newton->done > 1 ? pow(all / newton->first[ALL], 1.0 / (newton->done - 1)) : NAN;
}

// iterate with the present Jacobian; newton->correction holds the residual when the iteration starts
static int newton_iterate(struct ida_newton *newton, N_Vector total, N_Vector weights, double tolerance, void *ida) {
    double *const correction = N_VGetArrayPointer(newton->correction);
    const double *const weight = N_VGetArrayPointer(weights);
    const double *const kind = newton->rules.kinds ? N_VGetArrayPointer(newton->rules.kinds) : NULL;
    const sunindextype n = N_VGetLength(newton->correction);
    newton->done = 0;
    for (;;) {
        newton->iterations++;
        newton->done++;

        // solve in the configuration in which the Jacobian was evaluated, then map the correction back
        N_VScale(-1, newton->correction, newton->correction);
        corotation_map(newton->corotation, true, correction);
        int code = newton->solve(newton->correction, ida);
        if (code != 0) return code;
        corotation_map(newton->corotation, false, correction);
        N_VLinearSum(1, total, 1, newton->correction, total);

        // Both norms are weighted root mean squares. Each sum is taken in the order of the unknowns, so that bits do
        // not depend on threads.
        double all = 0, differential = 0;
        for (sunindextype i = 0; i < n; i++) {
            const double weighted = correction[i] * weight[i], square = weighted * weighted;
            all += square;
            differential += kind && kind[i] > 0 ? square : 0;
        }

        if (newton->attempt) {
            newton_record(newton, sqrt(all / (double)n), kind ? sqrt(differential / (double)n) : NAN, correction,
                          weight);
        }

        // the positions may converge later than the other unknowns
        code = newton_test(newton, ALL, sqrt(all / (double)n), tolerance);
        if (code == SUN_NLS_CONV_RECVR) return code;
        if (kind && newton_test(newton, DIFFERENTIAL, sqrt(differential / (double)n), tolerance) != SUN_SUCCESS) {
            code = newton->done < newton->most ? SUN_NLS_CONTINUE : SUN_NLS_CONV_RECVR;
        }
        if (code != SUN_NLS_CONTINUE) return code;
        code = newton->residual(total, newton->correction, ida);
        if (code != 0) return code;
    }
}

/* Guess the total correction of this step. Events repeat, so corrections recur with a period of one step or a few; the
 * period is the lag at which the last correction resembles an earlier one most. The guess is the total correction one
 * period ago plus its change over the period before; without a period it is the last correction. doc/numerics.md,
 * section 3. */
static void newton_start(const struct ida_newton *newton, N_Vector weights, N_Vector total) {
    if (newton->n_past == 0) {
        N_VConst(0, total);
        return;
    }

    const int most = newton->rules.is_periodic ? MOST_LAG : 0;
    const double *const weight = N_VGetArrayPointer(weights), *const last = N_VGetArrayPointer(newton->past[0]);
    const sunindextype n_values = N_VGetLength(weights);
    int period = 1;
    double least = INFINITY;
    for (int lag = 1; lag <= most && lag < newton->n_past; lag++) {
        const double *const before = N_VGetArrayPointer(newton->past[lag]);
        double sum = 0;
        for (sunindextype i = 0; i < n_values; i++) {
            const double difference = (last[i] - before[i]) * weight[i];
            sum += difference * difference;
        }
        if (!(sum < least)) continue;
        least = sum;
        period = lag;
    }

    const int n = 2 * period;
    if (newton->rules.is_periodic && n <= newton->n_past) {
        N_VLinearSum(2, newton->past[period - 1], -1, newton->past[n - 1], total);
    } else {
        N_VScale(1, newton->past[period - 1], total);
    }
}

static int newton_solve_step(SUNNonlinearSolver solver, N_Vector predicted, N_Vector total, N_Vector weights,
                             sunrealtype tolerance, sunbooleantype evaluate, void *ida) {
    struct ida_newton *const newton = solver->content;
    const struct ida_newton_rules *const rules = &newton->rules;
    newton->iterations = newton->failures = 0;
    // The Jacobian is stale if the last solution took as many iterations as the average solution with this Jacobian, in
    // which its own cost is included.
    const bool is_stale = newton->n_last * newton->n_solutions >= newton->n_iterations + rules->jacobian_cost;
    if (newton->is_incomplete || is_stale) evaluate = SUNTRUE;
    newton->is_incomplete = false;
    if (!evaluate) corotation_set_current(newton->corotation, N_VGetArrayPointer(predicted));

    // with another step size, total corrections are not alike
    const double coefficient = rules->leading_coefficient(rules->data);
    if (!(fabs(coefficient - newton->coefficient) <= 1e-9 * coefficient)) newton->n_past = 0;
    newton->coefficient = coefficient;
    newton_start(newton, weights, total);

    for (sunbooleantype failed = SUNFALSE;; failed = SUNTRUE) {
        int code = newton->residual(total, newton->correction, ida);
        if (code != 0) return code;
        if (evaluate) {
            sunbooleantype current;
            code = newton->set_up(failed, &current, ida);
            if (code != 0) return code;
            corotation_set_reference(newton->corotation, N_VGetArrayPointer(predicted));
            newton->n_solutions = newton->n_iterations = 0;
            if (newton->attempt && newton->attempt->n_corrections == 0) newton->attempt->age = 0;
        } else if (rules->update) {
            rules->update(rules->data);
        }
        newton->most = evaluate ? rules->max_with_new : rules->max_iterations;
        code = newton_iterate(newton, total, weights, tolerance, ida);
        if (code == 0) {
            N_Vector const oldest = newton->past[N_PAST - 1];
            memmove(newton->past + 1, newton->past, (N_PAST - 1) * sizeof *newton->past);
            newton->past[0] = oldest;
            N_VScale(1, total, oldest);
            if (newton->n_past < N_PAST) newton->n_past++;
            newton->n_solutions++;
            newton->n_last = newton->done;
            newton->n_iterations += newton->done;
            newton->is_incomplete =
                evaluate && newton->done > rules->max_iterations && rules->complete && rules->complete(rules->data);
            return 0;
        }
        newton->failures++;
        if (code < 0) return code;
        if (evaluate && !(rules->complete && rules->complete(rules->data))) return code;
        evaluate = SUNTRUE;
        N_VConst(0, total);
    }
}

static int newton_solve(SUNNonlinearSolver solver, N_Vector predicted, N_Vector total, N_Vector weights,
                        sunrealtype tolerance, sunbooleantype evaluate, void *ida) {
    struct ida_newton *const newton = solver->content;
    const struct ida_newton_rules *const rules = &newton->rules;
    newton->attempt = rules->attempt ? rules->attempt(rules->data) : NULL;
    if (newton->attempt) *newton->attempt = (struct trace_attempt){.age = newton->n_solutions};
    const int code = newton_solve_step(solver, predicted, total, weights, tolerance, evaluate, ida);
    if (newton->attempt) rules->attempted(rules->data, code);
    return code;
}

// IDA has restarted, so the history is worthless
static int newton_initialize(SUNNonlinearSolver solver) {
    struct ida_newton *const newton = solver->content;
    newton->coefficient = 0;
    newton->n_past = 0;
    newton->n_solutions = newton->n_iterations = newton->n_last = 0;
    return 0;
}

static SUNNonlinearSolver_Type newton_type(SUNNonlinearSolver solver) {
    (void)solver;
    return SUNNONLINEARSOLVER_ROOTFIND;
}

static int newton_set_residual(SUNNonlinearSolver solver, SUNNonlinSolSysFn function) {
    ((struct ida_newton *)solver->content)->residual = function;
    return 0;
}

static int newton_set_set_up(SUNNonlinearSolver solver, SUNNonlinSolLSetupFn function) {
    ((struct ida_newton *)solver->content)->set_up = function;
    return 0;
}

static int newton_set_solve(SUNNonlinearSolver solver, SUNNonlinSolLSolveFn function) {
    ((struct ida_newton *)solver->content)->solve = function;
    return 0;
}

static int newton_iterations(SUNNonlinearSolver solver, long *iterations) {
    *iterations = ((struct ida_newton *)solver->content)->iterations;
    return 0;
}

static int newton_failures(SUNNonlinearSolver solver, long *failures) {
    *failures = ((struct ida_newton *)solver->content)->failures;
    return 0;
}

static void release_newton(void *newton) {
    SUNNonlinSolFreeEmpty(newton);
}

SUNNonlinearSolver ida_newton_create(struct sundials_context *context, const struct school *school,
                                     struct ida_newton_rules rules) {
    struct arena *const arena = context->arena;
    struct ida_newton *newton;
    NEW(arena, newton, 1);
    newton->rules = rules;
    newton->corotation = corotation_create(arena, school);
    newton->correction = sundials_context_vector(context, NULL);
    for (int i = 0; i < N_PAST; i++) newton->past[i] = sundials_context_vector(context, NULL);

    const SUNNonlinearSolver solver = sundials_own(arena, release_newton, SUNNonlinSolNewEmpty(context->context));
    solver->content = newton;
    solver->ops->gettype = newton_type;
    solver->ops->initialize = newton_initialize;
    solver->ops->solve = newton_solve;
    solver->ops->setsysfn = newton_set_residual;
    solver->ops->setlsetupfn = newton_set_set_up;
    solver->ops->setlsolvefn = newton_set_solve;
    solver->ops->getnumiters = newton_iterations;
    solver->ops->getnumconvfails = newton_failures;
    return solver;
}
