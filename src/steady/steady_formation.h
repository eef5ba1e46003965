/* steady_formation.h: Newton's method for all slow quantities of a formation, with a difference Jacobian */
#ifndef STEADY_FORMATION_H
#define STEADY_FORMATION_H

#include "steady/steady_problem.h"

/* Solve for values of all slow quantities that one beat changes by at most the tolerance, in the scales of the
 * quantities, near the current values. If Newton's method fails, restart and follow the motion of the fish in time
 * (implicit Euler steps). Fails with STATUS_SOLVER, or as steady_problem_beat. */
enum status steady_formation_solve(struct steady_problem *problem, double tolerance);

#endif
