/* steady_modes.h: growth and decay of small disturbances: modes of the bodies for an equilibrium, multipliers for a
 * beat. doc/steady.md. Tested by tests/steady/test_steady_modes.c and by the section "elastic" of
 * `make verify`. */
#ifndef STEADY_MODES_H
#define STEADY_MODES_H

#include "result/steady_values.h"
#include "run/simulate.h"

/* Fill the exponents of an equilibrium; the state of the simulation is restored. Hold the bodies while a wake of zero
 * strength is convected downstream, then find the modes with solver/modes.h. No exponents if the state jumps at events
 * (wake.shedding: impulsive), without a stream, or without shedding. Fails with STATUS_MEMORY, STATUS_SOLVER or
 * STATUS_STOPPED. */
enum status steady_modes_find(struct simulation *simulation, struct steady_values *found);

/* Fill the exponents of a beat from the multipliers and the period, s. */
void steady_modes_of_multipliers(struct steady_values *found, double period);

#endif
