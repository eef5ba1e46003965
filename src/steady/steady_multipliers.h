/* steady_multipliers.h: stability of a steady state: growth or decay of small disturbances of the slow quantities.
 * doc/steady.md. Tested by tests/steady/test_steady.c. */
#ifndef STEADY_MULTIPLIERS_H
#define STEADY_MULTIPLIERS_H

#include "steady/steady_problem.h"

/* Find the multipliers at the current state of the simulation, by decreasing absolute value (n_unknowns). The state is
 * restored on success. way: step to the fixed point of the linearised map, over the scales of the unknowns
 * (n_unknowns). *n_beats: number of beats simulated. Fails with STATUS_SOLVER or STATUS_MEMORY. */
enum status steady_multipliers_find(struct steady_problem *problem, double *real, double *imaginary, double *way,
                                    int *n_beats);

#endif
