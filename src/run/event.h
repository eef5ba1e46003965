/* event.h: what happens at the times t_n = n Dt. Wakes advance, vortices are released and removed, the water gets new
 * velocities, and the control is updated. doc/model.md, sections 7 and 8. Tested by tests/run/test_event.c.
 *
 *     t_n-1 --- integrator ---> t_n | event_water: move, shed, remove, (consistent), velocities
 *                                   | event_control: control, (consistent) | --- integrator ---> t_n+1
 *
 * simulate_event (simulate.h) calls both, with the observers (observers.h) before, between and after them: the control
 * reads the samples that the observers take. */
#ifndef EVENT_H
#define EVENT_H

#include <stdbool.h>

#include "base/status.h"
#include "school/residual.h"
#include "solver/initial_conditions.h"
#include "state/impulse.h"
#include "state/state.h"

/* What an event did, for the observers and for the integrator. */
struct event {
    struct arena *arena;
    struct impulse_thinning *thinning; /* workspace                                                        (n_fish) */
    bool jumps;                        /* the unknowns are discontinuous */
    bool *has_kink;               /* whether the control has a new rate, so that powers are discontinuous  (n_fish) */
    struct impulse_moments *lost; /* what the wake lost when old vortices and markers went                 (n_fish) */
};
struct event *event_create(struct arena *arena, const struct school *school);

/* Make the state at t = 0 consistent, and put the first vortices into the water. Fails with STATUS_SOLVER. */
enum status event_start(struct state *state, struct residual *residual, struct initial_conditions *initial,
                        struct event *event);

/* Take the water to the next event; the unknowns must be those at its time. Fails with STATUS_SOLVER. */
enum status event_water(struct state *state, struct residual *residual, struct initial_conditions *initial,
                        struct event *event);

/* Let the control laws act on the samples up to this event. Fails with STATUS_SOLVER. */
enum status event_control(struct state *state, struct residual *residual, struct initial_conditions *initial,
                          struct event *event);

/* Account for bodies or wakes that a caller has changed at the event of the state: make the unknowns consistent, as at
 * an event with a jump, and evaluate the velocities of all vortices again. In the next interval the vortices move with
 * these velocities alone. velocities_are_given: the momenta follow from the velocities of the bodies, as at the start;
 * otherwise the velocities follow from the momenta. The integrator has to restart. Fails with STATUS_SOLVER. */
enum status event_change(struct state *state, struct residual *residual, struct initial_conditions *initial,
                         bool velocities_are_given);

#endif
