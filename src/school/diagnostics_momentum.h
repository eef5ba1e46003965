/* diagnostics_momentum.h: impulse of the fluid, external forces, and the momentum balance over the steps of the
 * integrator. doc/model.md, section 13. Tested by tests/school/test_diagnostics_momentum.c. */
#ifndef DIAGNOSTICS_MOMENTUM_H
#define DIAGNOSTICS_MOMENTUM_H

#include "school/diagnostics_values.h"
#include "school/residual.h"
#include "state/state.h"

/* Whether the momentum of a fish and of the fluid can balance: with force: pressure and constant depth along the body,
 * or without fluid. */
int diagnostics_has_reaction(const struct school *school, const struct fish *fish);

/* Add the impulse of the external forces in the step that ended at t to the momentum balance of fish f, as
 * diagnostics_step adds works. n: number of values for the quadrature; times: the newest time first. n = 0: only store
 * the forces, as the first values. */
void diagnostics_momentum_step(struct residual *residual, struct state *state, int f, double t, const double *y, int n,
                               const double times[3]);

/* Add the impulse of images in walls, and the loss by legs of rings, since the event before. Call at every event, after
 * the velocities of all wakes and the residual have been evaluated. Fails with STATUS_MEMORY. */
enum status diagnostics_momentum_event(struct residual *residual, struct state *state);

/* Start all momentum balances with the present state. */
void diagnostics_momentum_start(struct residual *residual, struct state *state);

/* Fill the impulses of all fish, and the momentum balance of the school, at the event of the state. */
void diagnostics_momentum(struct residual *residual, const struct state *state, struct diagnostics *diagnostics);

#endif
