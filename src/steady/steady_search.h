/* steady_search.h: the search for the fixed point of the map from beat to beat */
#ifndef STEADY_SEARCH_H
#define STEADY_SEARCH_H

#include "steady/steady_problem.h"

/* Advance the simulation to a state that repeats with the beat. Fails with STATUS_SOLVER and the reason after
 * steady.beats beats (for a formation: the motion of the released fish), or as simulate_step. */
enum status steady_search_run(struct steady_problem *problem);

/* Take the step way of steady_multipliers_find to the fixed point (n_unknowns), or a Newton step if way is NULL; then
 * advance the simulation to a state that repeats with the beat. Fails as steady_search_run. */
enum status steady_search_correct(struct steady_problem *problem, const double *way);

/* Hold the unknowns at these values, over their scales, until the wake has settled: every beat begins with them.
 * change: of the unknowns in the last beat (n_unknowns each). Fails as simulate_step. */
enum status steady_search_hold(struct steady_problem *problem, const double *value, double *change);

#endif
