/* sensor_pressure.h: what a lateral line feels, the pressure of the fluid on both sides of a body at its sensors.
 * doc/model.md, section 15. Tested by tests/force/test_sensor_pressure.c.
 *
 * The potential of the flow is a sum over the vortices of all bodies, wakes and images. At a point that moves with the
 * skin its rate has no singularity from the sheet of the same body, and no branch. */
#ifndef SENSOR_PRESSURE_H
#define SENSOR_PRESSURE_H

#include "flow/flow.h"
#include "force/pressure.h"
#include "state/state.h"

/* Find the first of the four control points around the fraction s/L of the length, and the weights of the cubic in
 * theta through them. */
int sensor_weights(const struct fish *fish, double fraction, double weight[4]);

/* Set potential_rate of the control points of fish f and the pressure at its sensors, at the event of the state. Does
 * nothing without sensors. Requires the flow, pressure_update and pressure_update_rate of this event. */
void sensor_pressure_update(const struct flow *flow, const struct state *state, int f, struct pressure *pressure);

#endif
