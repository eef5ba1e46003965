/* steady_together.h: Newton's method on all slow quantities of one fish. doc/steady.md. Tested by
 * tests/steady/test_steady.c. */
#ifndef STEADY_TOGETHER_H
#define STEADY_TOGETHER_H

#include "steady/steady_problem.h"

/* How a search takes its evaluations, and their Jacobian, which it keeps. */
struct steady_together {
    int beats; /* of an evaluation, each of which begins with the same values; the last one counts */
    int is_known;
    double matrix[STEADY_QUANTITIES * STEADY_QUANTITIES]; /* column after column */
};

/* Change the slow quantities of the only fish until a beat changes them by no more than the tolerance. The Jacobian is
 * made where it is not known. *is_done: whether that is found; if not, the simulation is where it was. Fails after
 * steady.beats as steady_problem_beat, or with STATUS_MEMORY. */
enum status steady_together_solve(struct steady_together *together, struct steady_problem *problem, double tolerance,
                                  int *is_done);

#endif
