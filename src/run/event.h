/* event.h: what happens at the times t_n = n Dt: wakes advance, vortices are released and removed and get new
 * velocities, and the control is updated. doc/model.md, sections 7 and 8. Tested by tests/run/test_event.c.
 *
 *     t_n-1 --- integrator ---> t_n | move, shed, remove, (consistent), velocities, control, samples | ---> t_n+1 */
#ifndef EVENT_H
#define EVENT_H

#include <stdbool.h>

#include "base/status.h"
#include "school/residual.h"
#include "solver/initial_conditions.h"
#include "state/state.h"

/* Make the state at t = 0 consistent and perform the first event. Fails with STATUS_SOLVER. */
enum status event_start(struct state *state, struct residual *residual, struct initial_conditions *initial);

/* Perform the next event; the unknowns must be those at its time. *jumped: the unknowns are discontinuous there, so the
 * integrator has to restart. Fails with STATUS_SOLVER. */
enum status event_next(struct state *state, struct residual *residual, struct initial_conditions *initial,
                       bool *jumped);

/* Account for bodies or wakes that a caller has changed at the event of the state: make the unknowns consistent, as at
 * an event with a jump, and evaluate the velocities of all vortices again. In the next interval the vortices move with
 * these velocities alone. velocities_are_given: the momenta follow from the velocities of the bodies, as at the start;
 * otherwise the velocities follow from the momenta. The integrator has to restart. Fails with STATUS_SOLVER. */
enum status event_change(struct state *state, struct residual *residual, struct initial_conditions *initial,
                         bool velocities_are_given);

#endif
