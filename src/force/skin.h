/* skin.h: the pressure of the fluid on both sides of a body, at the sensors of a lateral line. doc/model.md, section
 * 15. Tested by tests/force/test_skin.c.
 *
 * The potential of the flow is a sum over the vortices of all bodies, wakes and images; the rate of the potential at a
 * point that moves with the skin has no singularity of the own sheet and no branch. */
#ifndef SKIN_H
#define SKIN_H

#include "flow/flow_at_bodies.h"
#include "force/pressure.h"
#include "state/state.h"

/* First of the four control points next to the fraction s/L of the length, and the weights of the cubic in theta. */
int skin_weights(const struct fish *fish, double fraction, double weight[4]);

/* Set potential_rate of the control points of fish f, and the pressure at the sensors, at the event of the state; no-op
 * without sensors. Requires the flow, pressure_update and pressure_update_rate of this event. */
void skin_update(const struct flow *flow, const struct state *state, int f, struct pressure *pressure);

#endif
