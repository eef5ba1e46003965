/* led.h: a fish whose gait and aim are set from outside, at an event. doc/model.md, section 11. Tested by
 * tests/library/test_led.c. */
#ifndef LED_H
#define LED_H

#include "run/simulate.h"

/* Set what a key of the case has given so far: "wave.amplitude", "wave.frequency", "control.bias",
 * "control.desired_heading" (one number, in the unit of the case file) or "control.waypoints" (pairs). Fails with
 * STATUS_CASE where the fish has no use for it; nothing has changed then. */
enum status led_set(const struct simulation *simulation, int fish, const char *key, int n, const double *values);

#endif
