/* simulate.h: simulation in memory, advanced from event to event. Tested by tests/run/test_simulate.c and
 * tests/run/test_take_up.c. */
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

struct result_row; /* result/result_table.h */

/* Callers read the fields; only the functions below change the simulation. */
struct simulation {
    struct arena *arena;
    struct arena *renewed; /* of residual, consistent and solver */
    struct school *school;
    struct state *state;
    struct residual *residual;
    struct initial_conditions *consistent;
    struct diagnostics *diagnostics;
    const struct integrator *integrator;
    void *solver;
    struct integrator_options options;
    struct integrator_counts totals;          /* up to the last event, with the size of the last step */
    const volatile sig_atomic_t *stop;        /* simulate_step stops when *stop is not 0; may be NULL */
    struct trace *trace;                      /* of the steps that ida attempts; NULL: none */
    void (*after_step)(double t, void *data); /* called after each step of the integrator, to t [s]; may be NULL */
    void *after_step_data;
    long n_events;  /* of the whole run, without the event at t = 0 */
    double started; /* wall clock, s; for a resumed run: less the wall time before the checkpoint */
};

/* Create a simulation and perform the event at t = 0; stop when *stop is not 0. stop may be NULL. The simulation is an
 * arena of its own, released with the parent (NULL: none) or by simulate_free. Fails with STATUS_CASE, STATUS_SOLVER or
 * STATUS_STOPPED; the simulation can then only be freed. */
enum status simulate_start(struct arena *parent, struct simulation **simulation, const struct case_values *values,
                           const volatile sig_atomic_t *stop);

/* Create a simulation from a state at an event, with given totals; the run continues as after simulate_renew. The
 * simulation takes ownership of school and state, also on failure. Fails as simulate_start. */
enum status simulate_take_up(struct arena *parent, struct simulation **simulation, const struct case_values *values,
                             struct school *school, struct state *state, const struct integrator_counts *totals);

/* Cause of the stop, for messages: --max-wall or a signal. */
const char *simulate_stopped_by(const volatile sig_atomic_t *stop);

/* At an event: discard everything but state and totals (the integrator with history, the Jacobians with factors)
 * and create these parts again from state and totals. The simulation is then identical to a
 * simulation made by simulate_take_up. Fails with STATUS_SOLVER; the simulation can then only be
 * freed. */
enum status simulate_renew(struct simulation *simulation);

/* Release the simulation with everything that the simulation owns. Accepts NULL. */
void simulate_free(struct simulation *simulation);

/* The highest order of ida for a case and its school: solver.order, or by default (doc/numerics.md, section 3) 2 if the
 * stiffness of a body is not damped, 5 if the slowest bending mode of every fish is below 0.6 of the beat frequency,
 * else 3. arena: for scratch. */
int simulate_order(struct arena *arena, const struct case_values *values, const struct school *school);

/* Integrate to time t [s], the next event, without performing it. Fails with STATUS_SOLVER or STATUS_STOPPED. */
enum status simulate_interval(struct simulation *simulation, double t);

/* Integrate to the next event and perform the event. Fails with STATUS_SOLVER, STATUS_STOPPED, or with
 * STATUS_CONTACT (bodies in contact, contact.action: stop); the state is then between two events. */
enum status simulate_step(struct simulation *simulation);

/* Evaluate simulation->diagnostics at the present event. */
void simulate_measure(struct simulation *simulation);

/* The same, and fill *counts and *row for the present event. *row refers to the simulation and to *counts, and contains
 * the wake. */
void simulate_row(struct simulation *simulation, struct integrator_counts *counts, struct result_row *row);

/* The totals of the integrator and of the consistent states, with the last step. */
void simulate_count(const struct simulation *simulation, struct integrator_counts *counts);

/* Wall time since the creation of the simulation, plus the wall time before the checkpoint of a resumed run, s. */
double simulate_wall_time(const struct simulation *simulation);

// ---- estimate.c: estimate of CPU time and memory of a run. The estimate measures the first events of the run, then
// single events with synthetic wakes of doubling length, and extrapolates the cost to the longest wakes. The estimate
// does not account for later changes of the motion, such as fish that approach each other or stop. Tested by
// tests/run/test_estimate.c.

struct estimate {
    double seconds; /* CPU time of the whole run */
    double bytes;   /* of memory */
    long n_events;  /* events of the run that the estimate measured */
};

/* Estimate the cost of a run from a simulation at the start; the simulation can only be freed afterwards. The estimate
 * takes at most `patience` [s] of CPU time, but completes the first two events: the first costs more than the others.
 * If simulation->stop interrupts the first event, the estimate has no event and extrapolates from the completed part.
 * Fails as simulate_step if one of the first events fails; the run then fails at the same event. */
enum status estimate_run(struct simulation *simulation, double patience, struct estimate *estimate);

// ---- event.c: event at the times t_n = n Dt: advance the wakes, release and remove vortices, evaluate the velocities
// of the vortices, update the control. doc/model.md, sections 7 and 8. Tested by tests/run/test_event.c.
//
//     t_n-1 ---- integrator ----> t_n  | move, shed, remove, (consistent), velocities, control, samples |  ---> t_n+1

/* Make the state at t = 0 consistent and perform the first event. Fails with STATUS_SOLVER. */
enum status event_start(struct state *state, struct residual *residual, struct initial_conditions *initial);

/* Perform the next event; the unknowns are given at the time of the event. *jumped: the unknowns are discontinuous at
 * the event, and the integrator has to restart. Fails with STATUS_SOLVER. */
enum status event_next(struct state *state, struct residual *residual, struct initial_conditions *initial, int *jumped);

/* Account for bodies or wakes that a caller has changed at the event of the state: make the unknowns consistent, as at
 * an event with a jump, and evaluate the velocities of all vortices again. The next interval advances the vortices
 * with these velocities alone. velocities_are_given: the momenta follow from the velocities of the bodies, as at the
 * start; else the velocities follow from the momenta. The integrator has to restart. Fails with
 * STATUS_SOLVER. */
enum status event_change(struct state *state, struct residual *residual, struct initial_conditions *initial,
                         int velocities_are_given);

#endif
