/* steady_formation.h: Newton's method on all slow quantities of a formation, with a Jacobian by differences.
 * doc/steady.md. Tested by tests/run/test_steady_formation.c. */
#ifndef STEADY_FORMATION_H
#define STEADY_FORMATION_H

#include "run/steady_problem.h"

/* Find places that all fish keep, near those where they are. Fails with STATUS_SOLVER, or as steady_problem_beat. */
enum status steady_formation_solve(struct steady_problem *problem);

#endif
