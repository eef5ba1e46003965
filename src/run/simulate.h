/* simulate.h: simulation in memory, advanced from event to event. Tested by tests/run/test_simulate.c and
 * tests/run/test_take_up.c. */
#ifndef SIMULATE_H
#define SIMULATE_H

#include <signal.h>

#include "base/status.h"
#include "case/case.h"
#include "school/diagnostics.h"
#include "solver/initial_conditions.h"
#include "solver/integrator.h"

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
    struct integrator_counts totals;   /* up to the last event, with the size of the last step */
    const volatile sig_atomic_t *stop; /* simulate_step stops when *stop is not 0; may be NULL */
    long n_events;                     /* of the whole run, without the event at t = 0 */
    double started;                    /* wall clock, s; for a resumed run: less the wall time before the checkpoint */
};

/* Create a simulation and perform the event at t = 0; stop when *stop is not 0. stop may be NULL. The simulation is an
 * arena of its own, released with the parent (NULL: none) or by simulate_free. Fails with STATUS_CASE, STATUS_SOLVER or
 * STATUS_STOPPED; the simulation can then only be freed. simulate_create is simulate_start without stop. */
enum status simulate_start(struct arena *parent, struct simulation **simulation, const struct case_values *values,
                           const volatile sig_atomic_t *stop);
enum status simulate_create(struct arena *parent, struct simulation **simulation, const struct case_values *values);

/* Create a simulation from a state at an event, with given totals; the run continues as after simulate_renew. The
 * simulation takes ownership of school and state, also on failure. Fails as simulate_create. */
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

/* Integrate to the next event and perform the event. Fails with STATUS_SOLVER, STATUS_STOPPED, or with
 * STATUS_CONTACT (bodies in contact, contact.action: stop); the state is then between two events. */
enum status simulate_step(struct simulation *simulation);

/* Evaluate simulation->diagnostics at the present event. */
void simulate_measure(struct simulation *simulation);

/* The same, and fill *counts and *row for the present event. *row refers to the simulation and to *counts, and contains
 * the wake. */
void simulate_row(struct simulation *simulation, struct integrator_counts *counts, struct result_row *row);

/* Wall time since the creation of the simulation, plus the wall time before the checkpoint of a resumed run, s. */
double simulate_wall_time(const struct simulation *simulation);

#endif
