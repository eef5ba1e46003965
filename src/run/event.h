/* event.h: what happens at the times t_n = n Dt: the wake moves on, vortices are released and removed, their velocities
 * are evaluated, the control decides. doc/model.md, sections 7 and 8. Tested by tests/run/test_event.c.
 *
 *     t_n-1 ---- integrator ----> t_n  | move, shed, remove, (consistent), velocities, control, samples |  ---> t_n+1
 */
#ifndef EVENT_H
#define EVENT_H

#include "base/status.h"
#include "school/residual.h"
#include "solver/initial_conditions.h"
#include "state/state.h"

/* Make the state at t = 0 consistent and do what belongs to the first event. */
enum status event_start(struct state *state, struct residual *residual, struct initial_conditions *initial);

/* Do what belongs to the next event; the unknowns have reached its time. *jumped tells whether the unknowns are no
 * longer continuous there: the integrator has to restart. Fails with STATUS_MEMORY or STATUS_SOLVER. */
enum status event_next(struct state *state, struct residual *residual, struct initial_conditions *initial, int *jumped);

/* Bodies or wakes have been changed from outside at the event of the state: make the unknowns consistent, as at an
 * event with a jump, and find the velocities of all vortices again; they move on their first interval with these
 * alone. velocities_are_given: momenta follow from the velocities of the bodies, as at the start; else velocities
 * follow from the momenta. The integrator has to restart. Fails with STATUS_MEMORY or STATUS_SOLVER. */
enum status event_change(struct state *state, struct residual *residual, struct initial_conditions *initial,
                         int velocities_are_given);

#endif
