/* led.h: change gait and goal of a fish at an event. doc/model.md, section 11. Tested by
 * tests/library/test_led.c. */
#ifndef LED_H
#define LED_H

#include "run/simulate.h"

/* Set the value of a key: "wave.amplitude", "wave.frequency", "control.bias", "control.desired_heading" (one number, in
 * the unit of the case file) or "control.waypoints" (pairs, m). Fails with STATUS_CASE for an invalid value, or if the
 * control law of the fish ignores the key; the fish is then unchanged. */
enum status led_set(const struct simulation *simulation, int fish, const char *key, int n, const double *values);

#endif
