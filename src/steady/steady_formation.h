/* steady_formation.h: Newton's method on all slow quantities of a formation, with a Jacobian by differences.
 * doc/steady.md. Tested by tests/steady/test_steady_formation.c. */
#ifndef STEADY_FORMATION_H
#define STEADY_FORMATION_H

#include "steady/steady_problem.h"

/* Find values that all slow quantities keep, near those that they have, to a change of no more than tolerance in a
 * beat, in their scales. Where that leads nowhere, begin again, and follow what the fish do. Fails with STATUS_SOLVER,
 * or as steady_problem_beat. */
enum status steady_formation_solve(struct steady_problem *problem, double tolerance);

#endif
