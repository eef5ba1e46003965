/* simulate.h: a run in memory, from event to event. Tested by tests/run/test_simulate.c and
 * tests/run/test_take_up.c. */
#ifndef SIMULATE_H
#define SIMULATE_H

#include <signal.h>

#include "base/parallel_choice.h"
#include "base/status.h"
#include "case/case.h"
#include "school/diagnostics.h"
#include "solver/initial_conditions.h"
#include "solver/integrator.h"

struct result_row; /* result/result_table.h */

/* A run in memory. Read its parts; only the functions below change them. */
struct simulation {
    struct school *school;
    struct state *state;
    struct residual *residual;
    struct initial_conditions *consistent;
    struct diagnostics *diagnostics;
    const struct integrator *integrator;
    void *solver;
    struct integrator_options options;
    struct parallel_choice choice;     /* threads of the next step */
    struct integrator_counts totals;   /* up to the last event, with the size of the step that ended there */
    const volatile sig_atomic_t *stop; /* simulate_step stops once this is not 0; or NULL */
    long n_events;                     /* of the whole run, without the one at the start */
    double started;                    /* wall clock, s; of a run that was taken up again: less what it had taken */
};

/* Build everything and do the event at t = 0, and stop once *stop is not 0; stop may be NULL. Fails with STATUS_CASE,
 * STATUS_MEMORY, STATUS_SOLVER or STATUS_STOPPED. simulate_create does not stop. */
enum status simulate_start(struct simulation **simulation, const struct case_values *values,
                           const volatile sig_atomic_t *stop);
enum status simulate_create(struct simulation **simulation, const struct case_values *values);

/* Build everything around a state at one of its events: a run goes on as after simulate_renew, with these totals. The
 * simulation owns school and state from now on, also where this fails, which it does as simulate_create. */
enum status simulate_take_up(struct simulation **simulation, const struct case_values *values, struct school *school,
                             struct state *state, const struct integrator_counts *totals);

/* What stopped a run, for its message: --max-wall or a signal. */
const char *simulate_stopped_by(const volatile sig_atomic_t *stop);

/* At an event: discard all that is not state and totals (the integrator and its history, Jacobians and their factors,
 * the interpolation of wakes), and make it again from these. Nothing is then left that simulate_take_up would not have.
 * Fails with STATUS_MEMORY or STATUS_SOLVER; the simulation can then only be freed. */
enum status simulate_renew(struct simulation *simulation);

/* Release all of it. Accepts NULL. */
void simulate_free(struct simulation *simulation);

/* Go on to the next event and do it. Fails with STATUS_SOLVER, STATUS_MEMORY, STATUS_STOPPED, or with STATUS_CONTACT
 * where two bodies are in contact and the case asks to stop then; the state is then
 * somewhere between two events. */
enum status simulate_step(struct simulation *simulation);

/* Bring simulation->diagnostics up to date. */
void simulate_measure(struct simulation *simulation);

/* The same, and all that a row of the present event is made of: *row refers to the simulation and to *counts, which are
 * filled. Its wake is in it. */
void simulate_row(struct simulation *simulation, struct integrator_counts *counts, struct result_row *row);

/* Seconds of wall clock since the simulation was created. */
double simulate_wall_time(const struct simulation *simulation);

#endif
