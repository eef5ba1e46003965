/* steady_modes.h: growth and decay of small disturbances: of an equilibrium by the modes of its bodies, of a beat by
 * its multipliers. doc/steady.md. Tested by tests/steady/test_steady_modes.c and by the section "elastic" of
 * `make verify`. */
#ifndef STEADY_MODES_H
#define STEADY_MODES_H

#include "result/steady_values.h"
#include "run/simulate.h"

/* Fill the exponents of an equilibrium that a simulation is in, and where it stays: its bodies are held while a wake
 * without strength drifts away from them, then solver/modes.h finds the modes. None where events jump
 * (wake.shedding: impulsive) or nothing sheds. Fails with STATUS_MEMORY, STATUS_SOLVER or STATUS_STOPPED. */
enum status steady_modes_find(struct simulation *simulation, struct steady_values *found);

/* Fill the exponents of a beat of this period, s, from its multipliers. */
void steady_modes_of_multipliers(struct steady_values *found, double period);

#endif
