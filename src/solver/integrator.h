/* integrator.h: the interface of every time integrator, implicit or explicit. */
#ifndef INTEGRATOR_H
#define INTEGRATOR_H

#include <signal.h>

#include "base/methods.h"
#include "base/status.h"
#include "school/residual.h"
#include "state/state.h"

/* Totals since the start, and the last step. */
struct integrator_counts {
    long steps, residual_evaluations, newton_iterations, jacobian_evaluations;
    long error_test_failures, convergence_failures;
    double step_size; /* s */
    int order;
};

/* How to integrate. */
struct integrator_options {
    enum method method;
    int order;     /* maximum, of BDF */
    double step;   /* fixed step of all other methods, s; 0: adaptive */
    int max_steps; /* maximum between two events */
    /* totals up to now, from which the counts go on; where the method chooses its steps, the first one follows from the
     * size of the last one; zeros at the start of a run */
    struct integrator_counts before;
};

/* STATUS_STOPPED once *stop is no longer 0; stop may be NULL. */
static inline enum status integrator_ask(const volatile sig_atomic_t *stop) {
    return stop && *stop ? status_fail(STATUS_STOPPED, "stopped by a signal") : STATUS_OK;
}

/* A family of methods. A solver advances y and yp of a state in place, and reads the wakes through the residual. */
struct integrator {
    /* Create a solver for the present state, which must be consistent. Fails with STATUS_MEMORY or STATUS_SOLVER. */
    enum status (*create)(void **solver, struct residual *residual, struct state *state,
                          const struct integrator_options *options);

    /* Integrate to time t [s], the next event, and update the energy balance after every step. Fails with
     * STATUS_SOLVER, and a message that says when and why, or with STATUS_MEMORY; never with STATUS_RETRY. Before each
     * step and each iteration it looks whether it has been asked to stop (integrator_ask), and fails with
     * STATUS_STOPPED, anywhere between the two events. */
    enum status (*advance)(void *solver, double t, const volatile sig_atomic_t *stop);

    /* Start again after a jump: the state is consistent, the history is discarded. Fails with STATUS_SOLVER. */
    enum status (*restart)(void *solver);

    void (*count)(const void *solver, struct integrator_counts *counts);
    void (*free)(void *solver); /* accepts NULL */
};

#endif
