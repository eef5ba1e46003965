/* steady_modes.h: growth and decay of small disturbances: modes of the bodies for an equilibrium, multipliers for a
 * beat. doc/steady.md. Tested by tests/steady/test_steady_modes.c, test_steady.c and by the section
 * "elastic" of `make verify`. */
#ifndef STEADY_MODES_H
#define STEADY_MODES_H

#include "result/result_row.h"
#include "run/simulate.h"
#include "steady/steady_problem.h"

/* Fill the exponents of an equilibrium; the state of the simulation is restored. Hold the bodies while a wake of zero
 * strength is convected downstream, then find the modes with solver/modes.h. No exponents if the state jumps at events
 * (wake.shedding: impulsive), without a stream, or without shedding. Fails with STATUS_MEMORY, STATUS_SOLVER or
 * STATUS_STOPPED. */
enum status steady_modes_find(struct simulation *simulation, struct steady_values *found);

/* Fill the exponents of a beat from the multipliers and the period, s. */
void steady_modes_of_multipliers(struct steady_values *found, double period);

// ---- multipliers of a beat: growth or decay of small disturbances of the slow quantities

/* Find the multipliers at the current state of the simulation, by decreasing absolute value (n_unknowns). The state is
 * restored on success. way: step to the fixed point of the linearised map, over the scales of the unknowns
 * (n_unknowns). *n_beats: number of beats simulated. Fails with STATUS_SOLVER or STATUS_MEMORY. */
enum status steady_multipliers_find(struct steady_problem *problem, double *real, double *imaginary, double *way,
                                    int *n_beats);

#endif
