/* diagnostics_momentum.h: the impulse of the fluid, the forces from outside, and the balance of momentum over the steps
 * of the integrator. doc/model.md, section 13. Tested by tests/school/test_diagnostics_momentum.c. */
#ifndef DIAGNOSTICS_MOMENTUM_H
#define DIAGNOSTICS_MOMENTUM_H

#include "school/diagnostics_values.h"
#include "school/residual.h"
#include "state/state.h"

/* Whether the forces of the fluid on a fish have a reaction, so that its momentum can balance: with force: pressure and
 * one depth along the body, or where there is no fluid. */
int diagnostics_has_reaction(const struct school *school, const struct fish *fish);

/* Add the external forces of the step that ended at t to the balance of fish f, as diagnostics_step does with powers;
 * n: how many values the integral has, times: the newest first. Where n is 0 these forces are the first ones. */
void diagnostics_momentum_step(struct residual *residual, struct state *state, int f, double t, const double *y, int n,
                               const double times[3]);

/* Add what the images in walls have done since the event before; at every event, once the velocities of all wakes are
 * known and the residual has been evaluated. Nothing without walls. Fails with STATUS_MEMORY. */
enum status diagnostics_momentum_event(struct residual *residual, struct state *state);

/* Begin all balances with the state as it is now. */
void diagnostics_momentum_start(struct residual *residual, struct state *state);

/* Fill the impulses of all fish, and the balance of the school, at the event of the state. */
void diagnostics_momentum(struct residual *residual, const struct state *state, struct diagnostics *diagnostics);

#endif
