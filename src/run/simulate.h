/* simulate.h: a simulation in memory, which advances from event to event without any file. Tested by
 * tests/run/test_simulate.c and tests/run/test_take_up.c. */
#ifndef SIMULATE_H
#define SIMULATE_H

#include <signal.h>

#include "base/status.h"
#include "case/case.h"
#include "school/diagnostics.h"
#include "school/residual.h"
#include "solver/initial_conditions.h"
#include "solver/integrator.h"
#include "state/state.h"

struct event;      /* run/event.h */
struct observers;  /* run/observers.h */
struct result_row; /* result/result_table.h */

/* A simulation. Callers may read the fields; only the functions below change them. */
struct simulation {
    struct arena *arena;
    struct arena *renewed; /* owns residual, consistent and solver, which simulate_renew replaces */
    struct school *school;
    struct state *state;
    struct residual *residual;
    struct initial_conditions *consistent;
    struct diagnostics *diagnostics;
    struct event *event; /* what the last event did */
    struct observers *observers;
    const struct integrator *integrator;
    void *solver;
    struct integrator_options options;
    struct integrator_counts totals;          /* up to the last event, with the size of the last step */
    const volatile sig_atomic_t *stop;        /* once *stop is not 0, simulate_step stops; may be NULL */
    struct trace *trace;                      /* gets a line for each step that ida attempts; NULL: no trace */
    void (*after_step)(double t, void *data); /* called after each step of the integrator, to t [s]; may be NULL */
    void *after_step_data;
    long n_events;  /* of the whole run, without the event at t = 0 */
    double started; /* wall clock at the start, s; a resumed run sets it back by the wall time before the checkpoint */
};

/* Create a simulation and perform the event at t = 0; stop as soon as *stop is not 0 (stop may be NULL). The simulation
 * has an arena of its own, which is released with the parent (NULL: none) or by simulate_free. Fails with STATUS_CASE,
 * STATUS_SOLVER or STATUS_STOPPED; the simulation can then only be freed. */
enum status simulate_start(struct arena *parent, struct simulation **simulation, const struct case_values *values,
                           const volatile sig_atomic_t *stop);

/* Create a simulation from a state at an event and from the totals up to it. The run continues as it would after
 * simulate_renew. The simulation takes ownership of school and state, even if it fails. Fails as simulate_start
 * does. */
enum status simulate_take_up(struct arena *parent, struct simulation **simulation, const struct case_values *values,
                             struct school *school, struct state *state, const struct integrator_counts *totals);

/* What stopped the run, for messages: --max-wall or a signal. */
const char *simulate_stopped_by(const volatile sig_atomic_t *stop);

/* At an event, discard everything but state and totals (that is the integrator with its history, and the Jacobians with
 * their factors) and create it again. The simulation is then identical to one made by simulate_take_up. Fails with
 * STATUS_SOLVER; the simulation can then only be freed. */
enum status simulate_renew(struct simulation *simulation);

/* Release the simulation and all that it owns. Accepts NULL. */
void simulate_free(struct simulation *simulation);

/* The highest order of ida for a case and its school. This is solver.order if it is set. By default (doc/numerics.md,
 * section 3) it is 2 if the stiffness of some body is not damped, 5 if the slowest bending mode of every fish is below
 * 0.6 of the beat frequency, and 3 otherwise. arena: for scratch. */
int simulate_order(struct arena *arena, const struct case_values *values, const struct school *school);

/* Integrate to time t [s], the next event, but do not perform it. Fails with STATUS_SOLVER or STATUS_STOPPED. */
enum status simulate_interval(struct simulation *simulation, double t);

/* Perform the first event, at t = 0, or the next one, for which the unknowns must be those at its time; observe the
 * state before and after. After the next one the integrator has to restart if simulation->event->jumps. Fails with
 * STATUS_SOLVER. */
enum status simulate_first_event(struct simulation *simulation);
enum status simulate_event(struct simulation *simulation);

/* Integrate to the next event and perform it. Fails with STATUS_SOLVER, STATUS_STOPPED, or STATUS_CONTACT (bodies in
 * contact with contact.action: stop); the state is then between two events. */
enum status simulate_step(struct simulation *simulation);

/* Evaluate simulation->diagnostics at the present event. */
void simulate_measure(struct simulation *simulation);

/* The same, and describe the event in *counts and *row. *row refers to the simulation and to *counts, and contains the
 * wake. */
void simulate_row(struct simulation *simulation, struct integrator_counts *counts, struct result_row *row);

/* The totals of the integrator and of the consistent states, and the last step. */
void simulate_count(const struct simulation *simulation, struct integrator_counts *counts);

/* Wall time since the creation of the simulation, plus the wall time before the checkpoint of a resumed run, s. */
double simulate_wall_time(const struct simulation *simulation);

#endif
