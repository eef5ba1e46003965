/* modes.h: the modes of small disturbances of bodies in equilibrium in a stream: flutter, divergence, damping.
 * doc/steady.md, "Without a beat". Tested by tests/steady/test_steady_modes.c.
 *
 * With y = equilibrium + Y exp(lambda t) the linearised equations are, with the wake that this motion has shed,
 *
 *     (dF/dy + lambda dF/dy') Y + sum_f w_f(lambda) Y_Gamma,f = 0
 *
 *     w_f(lambda) = sum_a dF/dGamma_a exp(-lambda (a Dt + tau))      Gamma_a: label of the marker, a events old
 *
 * tau after an event, and as a mean over the interval. dF/dy, dF/dy' are those of the Jacobian; w is the difference of
 * two residuals, which is exact, as the residual is linear in the wake. */
#ifndef MODES_H
#define MODES_H

#include "base/status.h"
#include "school/residual.h"

/* A mode: growth rate and angular frequency, real and imaginary part of lambda. */
struct mode {
    double rate, omega; /* s-1, rad s-1 */
};

/* Find modes at an event whose unknowns are an equilibrium and whose wakes have no strength, by falling rate, at most
 * n_most of them; *n: how many. Left out are modes that swing within a few events, and those that decay so fast that
 * the wake ends before they do. residual and state are restored, but for what is made of the wakes. Fails with
 * STATUS_MEMORY or STATUS_SOLVER. */
enum status modes_find(struct residual *residual, struct state *state, int n_most, struct mode *mode, int *n);

#endif
