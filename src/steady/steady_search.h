/* steady_search.h: the search for the fixed point of the map from beat to beat. doc/steady.md. Tested by
 * tests/steady/test_steady.c. */
#ifndef STEADY_SEARCH_H
#define STEADY_SEARCH_H

#include "steady/steady_problem.h"

/* Go on until the simulation repeats itself from beat to beat. Fails with STATUS_SOLVER and the reason where it does
 * not within steady.beats (of a formation, what its fish do then), or as simulate_step. */
enum status steady_search_run(struct steady_problem *problem);

/* Go the way to the fixed point that steady_multipliers_find tells (n_unknowns), or, where that is NULL, take a step of
 * Newton's method; then go on until the simulation repeats itself. Fails as steady_search_run. */
enum status steady_search_correct(struct steady_problem *problem, const double *way);

#endif
