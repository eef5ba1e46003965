/* steady_multipliers.h: whether a steady state is stable: what becomes of small disturbances of its slow quantities.
 * doc/steady.md. Tested by tests/steady/test_steady.c. */
#ifndef STEADY_MULTIPLIERS_H
#define STEADY_MULTIPLIERS_H

#include "steady/steady_problem.h"

/* The multipliers at the state where the simulation is, which stays there: by falling absolute value, (n_unknowns).
 * way: what the unknowns, over their scales, are away from the fixed point of the map that is linear there
 * (n_unknowns). *n_beats: what they took. Fails with STATUS_SOLVER or STATUS_MEMORY. */
enum status steady_multipliers_find(struct steady_problem *problem, double *real, double *imaginary, double *way,
                                    int *n_beats);

#endif
