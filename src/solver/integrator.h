/* integrator.h: what every time integrator offers to the loop over a run. All methods stand behind one interface, so
 * that a run does not know which of them it uses; the loop over the steps and the rates of the bound strengths are
 * common to all. The files ida.c, runge_kutta.c and one_step.c have no headers of their own: all that they share are
 * the constants below, one for each family of methods. Tested by tests/solver/test_integrator.c. */
#ifndef INTEGRATOR_H
#define INTEGRATOR_H

#include <signal.h>

#include "base/arena.h"
#include "base/methods.h"
#include "base/status.h"
#include "school/residual.h"
#include "solver/trace.h"
#include "state/state.h"

/* What an integrator has done since the start of the run, then the size of its linear systems, then its last step. */
struct integrator_counts {
    long steps, steps_of_order[METHODS_MAX_ORDER]; /* of order 1, 2, ... */
    long residual_evaluations, newton_iterations, jacobian_evaluations;
    long klu_analyses;         /* of sparsity patterns */
    long klu_factorisations;   /* with new pivots */
    long klu_refactorisations; /* with the pivots that were chosen before */
    long gmres_iterations;
    long error_test_failures, convergence_failures;
    long initial_iterations;                   /* by KINSOL for consistent states, each with a Jacobian and factors */
    long jacobian_non_zeros, factor_non_zeros; /* of the last factorisation */
    double step_size;                          /* s */
    int order;
};

struct integrator_options {
    enum method method;
    enum error_test error_test;
    int order;     /* maximum order of BDF */
    double rtol;   /* error tolerance in units of residual_scale */
    double step;   /* fixed step of all other methods, s; 0: adaptive */
    int max_steps; /* maximum number of steps between two events */
    /* totals so far; zeros at the start of a run. An adaptive method derives its first step from the last step size
     * here. */
    struct integrator_counts before;
};

/* What a caller wants to know about the steps. */
struct integrator_watch {
    const volatile sig_atomic_t *stop;   /* the integration stops when *stop is not 0; may be NULL */
    struct trace *trace;                 /* gets a line for each step that ida attempts; NULL: no trace */
    void (*after)(void *data, double t); /* called after each step, to t [s], with the state there; may be NULL */
    void *data;
};

/* A family of methods. A solver advances y and yp of a state in place, and it reads the wakes through the residual. */
struct integrator {
    /* Create a solver for the present state, which must be consistent. Fails with STATUS_SOLVER. */
    enum status (*create)(struct arena *arena, void **solver, struct residual *residual, struct state *state,
                          const struct integrator_options *options);

    /* Prepare the steps from the present event to time t [s], the next one. Fails with STATUS_SOLVER. */
    enum status (*begin)(void *solver, double t, const struct integrator_watch *watch);

    /* Take one step towards t, and set *reached to its end, t exactly for the last step. Calls status_ask before the
     * step and each iteration. Fails with STATUS_SOLVER and a message with time and cause, or with STATUS_STOPPED;
     * never with STATUS_RETRY. */
    enum status (*step)(void *solver, double t, double *reached);

    /* Fail because solver.max_steps are used up, and add what the solver knows about the cause. NULL: it knows
     * nothing. */
    enum status (*limited)(void *solver);

    /* Discard the history after a jump of the state, which must be consistent. NULL for a method without a history.
     * Fails with STATUS_SOLVER. */
    enum status (*restart)(void *solver);

    void (*count)(const void *solver, struct integrator_counts *counts);
};

/* BDF of variable order and step by IDA, with the analytic Jacobian, our linear solver (linear.h) and our nonlinear
 * solver (ida_newton.h). doc/numerics.md. Tested by tests/solver/test_ida.c. */
extern const struct integrator ida_integrator;

/* Explicit Runge-Kutta methods by ARKStep of ARKODE, for comparison, on the right-hand side of ode_rhs.h. An overflow
 * or a step below the minimum is STATUS_SOLVER, with a message that says "unstable" and when. Tested by
 * tests/solver/test_runge_kutta.c. */
extern const struct integrator runge_kutta_integrator;

/* Implicit methods of fixed step, for comparison. The equations F(t, y, y') = 0 hold at the end of each step of h from
 * y_n to y_n+1, with
 *
 *     implicit Euler      y'_n+1 = (y_n+1 - y_n) / h
 *     trapezoid           y'_n+1 = 2 (y_n+1 - y_n) / h - y'_n
 *     imex                y'_n+1 = (3 y_n+1 - 4 y_n + y_n-1) / (2 h);  implicit Euler in the first step
 *
 * imex splits the equations (SBDF2: Ascher, Ruuth and Wetton 1995). The forces of the body itself are implicit; all
 * other forces on the nodes, R, are extrapolated as 2 R_n - R_n-1, and in the first step as R_n. The added mass belongs
 * to the momenta and therefore stays implicit: if it were explicit, a body lighter than its added mass would be
 * unstable at every step.
 *
 * Newton's iteration solves for y_n+1 with the Jacobian dF/dy + cj dF/dy', where cj = 1/h, 2/h or 3/(2h). If it does
 * not converge, the step fails with STATUS_SOLVER. Tested by tests/solver/test_one_step.c. */
extern const struct integrator one_step_integrator;

/* Velocity Verlet, symplectic and of order 2, for comparison. It serves only rods under elastic forces and loads,
 * without fluid, damping, prescribed motion or control law (case/case_check.c), because the accelerations a may depend
 * on nothing but positions and time. doc/numerics.md, section 4.
 *
 *     v_n+1/2 = v_n + h/2 a(x_n, t_n)     x_n+1 = x_n + h v_n+1/2     v_n+1 = v_n+1/2 + h/2 a(x_n+1, t_n+1)
 *
 * Sheets and wakes exert no force here, but the output shows them, so they are solved for once at the end of each
 * interval. A step above the stability limit is STATUS_SOLVER. Tested by tests/solver/test_one_step.c. */
extern const struct integrator one_step_verlet;

/* Integrate from the event at `start` to the next one at t [s]. This is the only loop over the steps of a method; it
 * calls watch->after after each of them. Fails as begin and step do, and with STATUS_SOLVER if solver.max_steps do not
 * suffice. */
enum status integrator_advance(const struct integrator *integrator, void *solver,
                               const struct integrator_options *options, double start, double t,
                               const struct integrator_watch *watch);

/* Fail at t [s] because solver.max_steps are used up. more: further words, "; ..." or empty. */
enum status integrator_limited(const struct integrator_options *options, double t, const char *more);

/* The integrator of a method. */
static inline const struct integrator *integrator_of(enum method method) {
    if (methods_table[method].fixed) return &runge_kutta_integrator;
    if (method == METHOD_IDA) return &ida_integrator;
    return method == METHOD_VERLET ? &one_step_verlet : &one_step_integrator;
}

struct linear_counts; /* solver/linear.h */

/* Set the totals and sizes of the linear solver: what was counted before the solver was created, plus the counts
 * since. */
void integrator_count_linear(struct integrator_counts *counts, const struct integrator_counts *before,
                             const struct linear_counts *linear);

/* ---- rates of the bound strengths after a step
 *
 * With force: pressure, the powers of the energy balance and the reactions of prescribed nodes depend on the rates of
 * the bound strengths, which are algebraic unknowns. IDA's own derivatives of algebraic unknowns are only of first
 * order where the motion of a body is prescribed, because no differential unknown then controls the order. We therefore
 * use the slope of the parabola through the last three steps; at events state_find_rates takes over. doc/numerics.md,
 * section 3. */
struct integrator_rates;

/* For a school, which must outlive the rates. */
struct integrator_rates *integrator_rates_create(struct arena *arena, const struct school *school);

/* Discard the history at an event: at the start, or after a jump. */
void integrator_rates_begin(struct integrator_rates *rates, const struct state *state);

/* Set the rates in state->yp after a step that ended at t [s]. */
void integrator_rates_step(struct integrator_rates *rates, double t, struct state *state);

#endif
