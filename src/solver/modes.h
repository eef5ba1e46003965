/* modes.h: finds the modes of small disturbances of bodies that are in equilibrium in a stream: how they flutter,
 * diverge or decay. doc/steady.md, "Equilibria without a beat". Tested by tests/steady/test_steady_modes.c.
 *
 * With y = equilibrium + Y exp(lambda t) and the wake that this motion sheds, the linearised equations are
 *
 *     (dF/dy + lambda dF/dy') Y + sum_f w_f(lambda) Y_Gamma,f = 0
 *
 *     w_f(lambda) = sum_a dF/dGamma_a exp(-lambda (a Dt + tau))      Gamma_a: label of the marker, a events old
 *
 * at the time tau after an event, averaged over the interval. dF/dy and dF/dy' come from the Jacobian. w is a
 * difference of two residuals, which is exact because the residual is linear in the wake. */
#ifndef MODES_H
#define MODES_H

#include "base/arena.h"
#include "base/status.h"
#include "school/residual.h"

/* A mode: growth rate and angular frequency, real and imaginary part of lambda. */
struct mode {
    double rate, omega; /* s-1, rad s-1 */
};

/* Find at most n_most modes (*n: how many) at an event at which the unknowns are an equilibrium and the wakes have no
 * strength, and sort them by falling rate. Modes whose period is only a few events are left out, and so are modes that
 * decay so fast that the wake outlives them. residual and state are restored, except for values derived from the wakes.
 * arena: for scratch. Fails with STATUS_SOLVER. */
enum status modes_find(struct arena *arena, struct residual *residual, struct state *state, int n_most,
                       struct mode *mode, int *n);

#endif
