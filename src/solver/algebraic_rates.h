/* algebraic_rates.h: the rates of velocities, bound strengths and circulations shed, where they are algebraic and the
 * force of the pressure is taken from them: force: pressure. doc/numerics.md, section 3. Tested by
 * tests/solver/test_algebraic_rates.c.
 *
 * No integrator needs these rates, and IDA's own are of first order where all of a body's motion is given, for it finds
 * no error by which to choose an order. They are those of the parabola through the last three steps. */
#ifndef ALGEBRAIC_RATES_H
#define ALGEBRAIC_RATES_H

#include "base/status.h"
#include "fish/fish.h"
#include "state/state.h"

struct algebraic_rates;

/* For a school, which must outlive it. Fails with STATUS_MEMORY; algebraic_rates_free accepts NULL. */
enum status algebraic_rates_create(struct algebraic_rates **rates, const struct school *school);
void algebraic_rates_free(struct algebraic_rates *rates);

/* Begin again with the state as it is at its event: at the start, or after a jump. */
void algebraic_rates_begin(struct algebraic_rates *rates, const struct state *state);

/* After a step that ended at t [s]: set the rates in state->yp. */
void algebraic_rates_step(struct algebraic_rates *rates, double t, struct state *state);

#endif
