/* steady_together.h: Newton's method for all slow quantities of one fish. doc/steady.md. Tested by
 * tests/steady/test_steady.c. */
#ifndef STEADY_TOGETHER_H
#define STEADY_TOGETHER_H

#include "steady/steady_problem.h"

/* Settings of the evaluations of a search, and the Jacobian, which is kept between solutions. */
struct steady_together {
    int beats; /* per evaluation; every beat begins with the same values, the last beat gives the change */
    int is_known;
    double matrix[STEADY_QUANTITIES * STEADY_QUANTITIES]; /* by columns */
};

/* Solve for slow quantities of the only fish that one beat changes by at most the tolerance. Evaluate the Jacobian
 * unless is_known. *is_done: 1 on success; 0: no convergence, the simulation is restored. Fails after steady.beats as
 * steady_problem_beat, or with STATUS_MEMORY. */
enum status steady_together_solve(struct steady_together *together, struct steady_problem *problem, double tolerance,
                                  int *is_done);

#endif
