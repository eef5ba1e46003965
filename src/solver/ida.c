/* ida.c: the default integrator, IDA of SUNDIALS applied to the residual of the school. Most of the file is about
 * spending few Jacobians: when to keep one, how long the steps are, and what Newton's iteration has to achieve. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "body/rod.h"
#include "school/residual.h"
#include "school/residual_jacobian.h"
#include "solver/ida_newton.h"
#include "solver/integrator.h"
#include "solver/linear.h"
#include "solver/sundials.h"

/* Newton's iteration has to reach this fraction of the tolerance of the error test. Velocities are outside the error
 * test, so IDA's default of 0.33 would leave noise in the accelerations of stiff bodies. Measured: doc/numerics.md. */
static const double newton_coefficient = 0.003;

/* Keep a Jacobian while its leading coefficient is within this fraction of that of the step (IDA's default is 0.25),
 * and while it saves more iterations than its evaluation costs. Measured: doc/numerics.md. */
static const double cj_change = 0.1;
static const int jacobian_cost = 5, max_iterations = 6, max_with_new = 20;

/* Tolerances of the linear solver, as fractions of the right-hand side and of the tolerance of Newton's iteration.
 * Smaller ones save no iteration. Measured: doc/numerics.md. */
static const double linear_relative = 1e-4, linear_absolute = 0.1;

/* Keep the step size if IDA would change it by a factor between these bounds, because a changed step costs a Jacobian.
 * IDA by itself cuts every step that its estimate asks to reduce, however little, and then doubles it again. Measured:
 * doc/numerics.md. */
static const double kept_from = 0.85, kept_to = 1.9;

/* At the start and after a restart the order is one, which requires a small first step. After a restart it is
 * first_step times the last step. At the start it is first_step times the interval, and at most first_by_root times the
 * interval times the root of rtol, because of the error at order one. IDA's own first step ignores the stiffness of the
 * body, and is so small that 15 Jacobians follow. */
static const double first_step = 0.3, first_by_root = 20;

/* IDA clones at most this many vectors. */
enum { N_CLONES = 32 };

struct ida {
    struct residual *residual;
    struct state *state;
    struct integrator_options options;
    struct jacobian *jacobian;
    const volatile sig_atomic_t *stop; /* see integrator.h */
    double reached;                    /* time of the state, s */
    long steps;                        /* since the last event */
    enum status failure;               /* of the last callback */
    /* absolute tolerance, one over it, and kind of each unknown                                  (n_unknowns) */
    double *tolerance, *weight, *kind;

    struct sundials_context context;
    N_Vector y, yp, weights, kinds, scratch[2];
    struct linear_sundials linear;
    SUNNonlinearSolver newton;
    void *ida;
    struct integrator_rates *algebraic_rates;
    struct integrator_counts before; /* totals up to the last restart, which resets the totals of IDA */
    long jacobians; /* evaluations so far: IDA resets the total of evaluations only some time after a restart */
    long steps_of_order[METHODS_MAX_ORDER]; /* so far */

    /* the trace of this interval, NULL: none; the last attempt, whose error test is judged after Newton's iteration */
    struct trace *trace;
    bool is_pending;
    int newton_code;
    struct trace_attempt attempt;
    double jacobian_cj; /* leading coefficient of the Jacobian */
    long gmres;         /* iterations up to the last attempt */
};

static int residual_callback(sunrealtype t, N_Vector y, N_Vector yp, N_Vector value, void *data) {
    struct ida *const solver = data;
    solver->failure = status_ask(solver->stop);
    if (solver->failure == STATUS_OK) {
        solver->failure = residual_evaluate(solver->residual, &residual_run, t, N_VGetArrayPointer(y),
                                            N_VGetArrayPointer(yp), N_VGetArrayPointer(value));
    }
    return solver->failure;
}

static int jacobian_callback(sunrealtype t, sunrealtype cj, N_Vector y, N_Vector yp, N_Vector value, SUNMatrix matrix,
                             void *data, N_Vector scratch1, N_Vector scratch2, N_Vector scratch3) {
    (void)yp, (void)value, (void)matrix, (void)scratch1, (void)scratch2, (void)scratch3;
    struct ida *const solver = data;
    solver->jacobians++;
    solver->jacobian_cj = cj;
    solver->failure =
        residual_jacobian(solver->residual, &residual_run, t, cj, N_VGetArrayPointer(y), solver->jacobian);
    return solver->failure;
}

// the same in every step
static int weights_callback(N_Vector y, N_Vector weights, void *data) {
    (void)y;
    const struct ida *const solver = data;
    N_VScale(1, solver->weights, weights);
    return 0;
}

static double leading_coefficient(void *data) {
    const struct ida *const solver = data;
    double value = 0;
    IDAGetCurrentCj(solver->ida, &value);
    return value;
}

// The newest stretch of a free sheet grows from zero length at the tail in every interval. The derivatives by its
// circulation therefore change faster than all others, and are updated without a new Jacobian.
static void update_jacobian(void *data) {
    struct ida *const solver = data;
    double *const by_shed = N_VGetArrayPointer(solver->scratch[1]);
    N_Vector y;
    IDAGetCurrentY(solver->ida, &y);
    residual_by_shed(solver->residual, N_VGetArrayPointer(y), by_shed);
    linear_update_shed(solver->linear.linear, by_shed);
}

static int couple_more(void *data) {
    struct ida *const solver = data;
    return residual_couple_more(&solver->residual->couplings, solver->state->y);
}

// Write the last attempt with its outcome: Newton's iteration failed, or the step was accepted, or else it failed the
// error test.
static void ida_trace_result(struct ida *solver, bool is_accepted) {
    if (!solver->is_pending) return;
    const int code = solver->newton_code;
    trace_write(solver->trace, solver->residual->school, &solver->attempt,
                code == SUN_NLS_CONV_RECVR ? TRACE_NEWTON
                : code != 0                ? TRACE_NO_VALUE
                : is_accepted              ? TRACE_ACCEPTED
                                           : TRACE_ERROR_TEST);
    solver->is_pending = false;
}

// Asked only while a trace is open. If an attempt is still pending here, IDA has rejected it, because it makes another.
static struct trace_attempt *next_attempt(void *data) {
    struct ida *const solver = data;
    if (!solver->trace) return NULL;
    ida_trace_result(solver, false);
    return &solver->attempt;
}

static void keep_attempt(void *data, int code) {
    struct ida *const solver = data;
    const long gmres = linear_count(solver->linear.linear).iterations;
    solver->attempt.event = solver->state->event + 1;
    solver->attempt.cj_ratio = leading_coefficient(solver) / solver->jacobian_cj;
    solver->attempt.gmres = gmres - solver->gmres;
    solver->gmres = gmres;
    IDAGetCurrentTime(solver->ida, &solver->attempt.t);
    IDAGetCurrentStep(solver->ida, &solver->attempt.step);
    IDAGetCurrentOrder(solver->ida, &solver->attempt.order);
    solver->newton_code = code;
    solver->is_pending = true;
}

static enum status ida_first_step(struct ida *solver) {
    const double start = fmin(first_step, first_by_root * sqrt(solver->options.rtol));
    const double last = solver->before.step_size;
    if (IDASetInitStep(solver->ida, last > 0 ? first_step * last : start * solver->residual->school->interval)) {
        return status_fail(STATUS_SOLVER, "IDA cannot start: %s", status_message());
    }
    return STATUS_OK;
}

static void release_ida(void *ida) {
    IDAFree(&ida);
}

static enum status ida_create(struct arena *arena, void **created, struct residual *residual, struct state *state,
                              const struct integrator_options *options) {
    const struct school *const school = residual->school;
    const int n = school->n_unknowns;
    const bool is_sheet = school->shedding == SHEDDING_SHEET;
    bool is_loaded = false;  // whether a sheet, with its nascent stretch, acts on a body
    for (int f = 0; f < school->n_fish; f++) is_loaded |= fish_is_loaded_by_sheet(&school->fish[f]);

    struct ida *solver;
    NEW(arena, solver, 1);
    solver->residual = residual;
    solver->state = state;
    solver->options = *options;
    solver->before = options->before;
    solver->jacobians = options->before.jacobian_evaluations;
    memcpy(solver->steps_of_order, options->before.steps_of_order, sizeof solver->steps_of_order);

    NEW(arena, solver->tolerance, n);
    NEW(arena, solver->weight, n);
    NEW(arena, solver->kind, n);
    residual_kinds(residual, &residual_run, solver->kind);
    for (int i = 0; i < n; i++) {
        solver->tolerance[i] = residual_scale(school, i) * options->rtol;
        solver->weight[i] = 1 / solver->tolerance[i];
    }

    solver->jacobian = jacobian_create(arena, school);
    residual_mask(residual, solver->jacobian);
    solver->algebraic_rates = integrator_rates_create(arena, school);
    integrator_rates_begin(solver->algebraic_rates, state);

    sundials_context_create(&solver->context, arena, n, school->threads, &solver->failure);
    solver->y = sundials_context_vector(&solver->context, state->y);
    solver->yp = sundials_context_vector(&solver->context, state->yp);
    solver->weights = sundials_context_vector(&solver->context, solver->weight);
    solver->kinds = sundials_context_vector(&solver->context, solver->kind);
    for (int i = 0; i < 2; i++) solver->scratch[i] = sundials_context_vector(&solver->context, NULL);
    sundials_context_reserve(&solver->context, N_CLONES);
    const struct linear_tolerance linear = {linear_relative, linear_absolute * newton_coefficient};
    solver->linear = linear_sundials_create(&solver->context, solver->jacobian, solver->tolerance, linear);
    const struct ida_newton_rules rules = {.max_iterations = max_iterations,
                                           .max_with_new = max_with_new,
                                           .jacobian_cost = jacobian_cost,
                                           .kinds = is_sheet ? solver->kinds : NULL,
                                           .is_periodic = is_loaded,
                                           .data = solver,
                                           .leading_coefficient = leading_coefficient,
                                           .update = is_sheet ? update_jacobian : NULL,
                                           .complete = couple_more,
                                           .attempt = next_attempt,
                                           .attempted = keep_attempt};
    solver->newton = ida_newton_create(&solver->context, school, rules);

    void *const ida = solver->ida =
        sundials_own(solver->context.arena, release_ida, IDACreate(solver->context.context));
    if (IDASetErrHandlerFn(ida, sundials_context_message, &solver->failure) || IDASetUserData(ida, solver) ||
        IDAInit(ida, residual_callback, state->t, solver->y, solver->yp) || IDAWFtolerances(ida, weights_callback) ||
        IDASetId(ida, solver->kinds) || IDASetSuppressAlg(ida, options->error_test == ERROR_TEST_POSITIONS) ||
        IDASetLinearSolver(ida, solver->linear.solver, solver->linear.matrix) || IDASetJacFn(ida, jacobian_callback) ||
        IDASetNonlinearSolver(ida, solver->newton) || IDASetNonlinConvCoef(ida, newton_coefficient) ||
        IDASetMaxOrd(ida, options->order) || IDASetDeltaCjLSetup(ida, cj_change) ||
        IDASetEtaFixedStepBounds(ida, kept_from, kept_to) || IDASetMaxErrTestFails(ida, 20) ||
        IDASetMaxConvFails(ida, 20) || IDASetMinStep(ida, 1e-10 * school->interval)) {
        return sundials_context_failed(&solver->context, "IDA");
    }
    *created = solver;
    return ida_first_step(solver);
}

static void ida_count(const void *data, struct integrator_counts *counts) {
    const struct ida *const solver = data;
    long steps, evaluations, setups, error_failures, iterations, convergence_failures;
    int last_order, next_order;
    double initial_step, last_step, next_step, now;
    *counts = solver->before;
    IDAGetIntegratorStats(solver->ida, &steps, &evaluations, &setups, &error_failures, &last_order, &next_order,
                          &initial_step, &last_step, &next_step, &now);
    IDAGetNonlinSolvStats(solver->ida, &iterations, &convergence_failures);
    counts->steps += steps;
    counts->residual_evaluations += evaluations;
    counts->newton_iterations += iterations;
    counts->jacobian_evaluations = solver->jacobians;
    memcpy(counts->steps_of_order, solver->steps_of_order, sizeof counts->steps_of_order);
    const struct linear_counts linear = linear_count(solver->linear.linear);
    integrator_count_linear(counts, &solver->options.before, &linear);
    counts->error_test_failures += error_failures;
    counts->convergence_failures += convergence_failures;
    counts->step_size = last_step;
    counts->order = last_order;
}

static enum status ida_restart(void *data) {
    struct ida *const solver = data;
    ida_count(solver, &solver->before);
    integrator_rates_begin(solver->algebraic_rates, solver->state);
    if (IDAReInit(solver->ida, solver->state->t, solver->y, solver->yp)) {
        return status_fail(STATUS_SOLVER, "IDA cannot start again: %s", status_message());
    }
    return ida_first_step(solver);
}

static const struct {
    int code;
    const char *text;
} reasons[] = {
    {IDA_TOO_MUCH_ACC, "the tolerance is below rounding errors: raise solver.rtol"},
    {IDA_ERR_FAIL, "the error test failed too often, or with the minimum step: lower solver.rtol"},
    {IDA_CONV_FAIL,
     "Newton's iteration did not converge, down to the minimum step: lower solver.rtol or "
     "time.shedding_interval, and check that the motion at that time is physical"},
    {IDA_LSETUP_FAIL, "the Jacobian is singular: check the units of the body"},
    {IDA_REP_RES_ERR,
     "the equations had no finite value, down to the minimum step: check that the motion at that time "
     "is physical"},
};

enum { ERROR_LENGTH = 256 };

// The unknown with the largest estimated error, in units of its tolerance, in words. Empty if there is no estimate.
static void ida_largest_error(const struct ida *solver, char error[ERROR_LENGTH]) {
    const struct school *const school = solver->residual->school;
    *error = '\0';
    if (IDAGetEstLocalErrors(solver->ida, solver->scratch[0]) != 0) return;
    const double *const estimate = N_VGetArrayPointer(solver->scratch[0]);
    double largest = -1;
    int worst = 0;
    for (int i = 0; i < school->n_unknowns; i++) {
        const double weighted = fabs(estimate[i]) / solver->tolerance[i];
        if (weighted <= largest) continue;
        largest = weighted;
        worst = i;
    }
    if (!(largest > 0)) return;
    const struct unknown_place place = residual_place(school, worst);
    const int length = snprintf(error, ERROR_LENGTH, "; largest error: %s[%d] of fish %.80s", place.name, place.index,
                                school->fish[place.fish].name);
    if (largest > 0.01) snprintf(error + length, ERROR_LENGTH - (size_t)length, ", %.3g tolerances", largest);
}

static enum status ida_failed(const struct ida *solver, int code) {
    const struct school *school = solver->residual->school;
    const double *const y = N_VGetArrayPointer(solver->y);
    double now = 0, step = 0;
    IDAGetCurrentTime(solver->ida, &now);
    IDAGetCurrentStep(solver->ida, &step);
    const char *reason = "see the message of IDA";
    for (size_t i = 0; i < sizeof reasons / sizeof *reasons; i++) {
        if (reasons[i].code == code) reason = reasons[i].text;
    }

    char message[512], error[ERROR_LENGTH], last[64] = "", seen[256] = "";
    snprintf(message, sizeof message, "; %s", status_message());
    if (solver->steps > 0) snprintf(last, sizeof last, ", the last of %.3g s", step);

    ida_largest_error(solver, error);

    // An edge that forces have compressed to almost zero length is a likely cause: the elastic force of a rod is finite
    // at length zero, so nothing holds such an edge open.
    for (int f = 0; f < school->n_fish && !*seen; f++) {
        double ratio;
        const int edge = rod_shortest_edge(&school->fish[f], y, &ratio);
        if (ratio >= 0.1) continue;
        snprintf(seen, sizeof seen,
                 "; edge %d of fish %.80s is pressed to %.2g of its length: body.modulus is too low for the forces on "
                 "it",
                 edge, school->fish[f].name, ratio);
    }

    // another likely cause: pairs of fish without coupling blocks in the Jacobian
    const int n_pairs = school->n_fish * (school->n_fish - 1) / 2;
    const int n_uncoupled = n_pairs - solver->jacobian->n_couplings / 2;
    if (code == IDA_CONV_FAIL && !*seen && n_uncoupled > 0) {
        snprintf(seen, sizeof seen,
                 "; the Jacobian has no coupling of %d of %d pairs of fish, which are more than %.3g m apart: increase "
                 "solver.coupling_distance",
                 n_uncoupled, n_pairs, solver->residual->couplings.reach);
    }
    return status_fail(STATUS_SOLVER,
                       "integration failed at t = %.10g s: %s%s%s; tried: orders up to %d, %ld steps since the last "
                       "event%s%s",
                       now, reason, seen, error, solver->options.order, solver->steps, last, message);
}

static enum status ida_limited(void *data) {
    const struct ida *const solver = data;
    char error[ERROR_LENGTH];
    double now = 0;
    IDAGetCurrentTime(solver->ida, &now);
    ida_largest_error(solver, error);
    return integrator_limited(&solver->options, now, error);
}

static enum status ida_begin(void *data, double t, const struct integrator_watch *watch) {
    (void)t;
    struct ida *const solver = data;
    solver->stop = watch->stop;
    solver->trace = watch->trace;
    solver->reached = solver->state->t;
    solver->steps = 0;
    return STATUS_OK;
}

static enum status ida_step(void *data, double t, double *reached) {
    struct ida *const solver = data;
    double step = 0;
    long total = 0;

    // Choose the latest end of the step so that the rest of the interval is divided into equal parts. Steps then keep
    // their size from event to event, and so does the Jacobian. Before the first step there is no step size. The margin
    // for rounding is smaller than the distance from the stop time that IDA ignores.
    IDAGetNumSteps(solver->ida, &total);
    IDAGetCurrentStep(solver->ida, &step);
    const double left = t - solver->reached, rounding = 1e-14 * t;
    const double n_steps = total > 0 ? ceil((left - rounding) / step) : 1;
    const double end = n_steps > 1 ? solver->reached + left / n_steps : t;
    if (IDASetStopTime(solver->ida, end)) return ida_failed(solver, IDA_ILL_INPUT);
    solver->failure = STATUS_OK;
    const int code = IDASolve(solver->ida, t, &solver->reached, solver->y, solver->yp, IDA_ONE_STEP);
    if (solver->failure == STATUS_STOPPED || solver->failure == STATUS_MEMORY) return solver->failure;
    ida_trace_result(solver, code >= 0);
    if (code < 0) return ida_failed(solver, code);
    if (code == IDA_TSTOP_RETURN) solver->reached = end;
    solver->steps++;
    int order;
    IDAGetLastOrder(solver->ida, &order);
    solver->steps_of_order[order - 1]++;
    integrator_rates_step(solver->algebraic_rates, solver->reached, solver->state);
    *reached = solver->reached;
    return STATUS_OK;
}

const struct integrator ida_integrator = {.create = ida_create,
                                          .begin = ida_begin,
                                          .step = ida_step,
                                          .limited = ida_limited,
                                          .restart = ida_restart,
                                          .count = ida_count};
