/* sensor_pressure.h: the pressure of the fluid on both sides of a body, at the sensors of a lateral line.
 * doc/model.md, section 15. Tested by tests/force/test_sensor_pressure.c.
 *
 * The potential of the flow is a sum over the vortices of all bodies, wakes and images; the rate of the potential at a
 * point that moves with the skin has no singularity of its own sheet and no branch. */
#ifndef SENSOR_PRESSURE_H
#define SENSOR_PRESSURE_H

#include "flow/flow_at_bodies.h"
#include "force/pressure.h"
#include "state/state.h"

/* First of the four control points next to the fraction s/L of the length, and the weights of the cubic in theta. */
int sensor_weights(const struct fish *fish, double fraction, double weight[4]);

/* Set potential_rate of the control points of fish f, and the pressure at the sensors, at the event of the state; no-op
 * without sensors. Requires the flow, pressure_update and pressure_update_rate of this event. */
void sensor_pressure_update(const struct flow *flow, const struct state *state, int f, struct pressure *pressure);

#endif
