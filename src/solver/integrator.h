/* integrator.h: what every time integrator offers, implicit or explicit. */
#ifndef INTEGRATOR_H
#define INTEGRATOR_H

#include "base/methods.h"
#include "base/status.h"
#include "model/residual.h"
#include "model/state.h"
#include "solver/initial_conditions.h"

/* Running totals, and the last step. */
struct integrator_counts {
    long steps, residual_evaluations, newton_iterations, jacobian_evaluations;
    long error_test_failures, convergence_failures;
    long linear_solves; /* of the algebraic unknowns, by an explicit method */
    double step_size;   /* s */
    int order;
};

/* How to integrate. */
struct integrator_options {
    enum method method;
    int order;     /* the most, of the implicit method */
    double step;   /* fixed, of all other methods, s; 0: adaptive */
    int max_steps; /* between two events */
};

/* One method. A solver works on the y and yp of a state, and reads its wakes through the residual. */
struct integrator {
    const char *name;

    /* Make a solver for the state as it is; the state has to be consistent. */
    enum status (*create)(void **solver, struct residual *residual, struct state *state,
                          const struct integrator_options *options);

    /* Go on to time t, the next event. After every step of its own the energy balances of the state are carried on. Fails with
     * STATUS_SOLVER; the message says at which time, in which unknown, and what was tried. */
    enum status (*advance)(void *solver, double t);

    /* The state has jumped and is consistent again: forget the past. */
    enum status (*restart)(void *solver);

    void (*count)(const void *solver, struct integrator_counts *counts);
    void (*free)(void *solver); /* accepts NULL */
};

#endif
