/* steady_problem.h: what has to be found for a steady state: which slow quantities a case has, and the beats of the
 * search. doc/steady.md. Tested by tests/steady/test_steady.c. */
#ifndef STEADY_PROBLEM_H
#define STEADY_PROBLEM_H

#include "case/case_values.h"
#include "steady/steady_map.h"

enum { STEADY_RECENT = 16 };

struct steady_problem {
    struct steady_map map;
    const struct case_steady *settings;
    int n_unknowns; /* the slow quantities of the case                             (n_unknowns) */
    struct steady_unknown *unknown;
    int solves_speed; /* whether the first fish has a speed to solve for; without a formation there is no other one */
    int n_pins;       /* of these the ones that are set while its speed is solved for: all speeds, to that one, and the
                         places and directions in a formation, to what they are at the start (n_pins) */
    struct steady_unknown *pin;
    double *pinned;   /* (n_pins) */
    double *scratch;  /* (4 n_unknowns) */
    double *jacobian; /* of a formation: by what each unknown changes what a beat does to all of them, in their scales,
                         column after column; NULL: not known yet (n_unknowns, n_unknowns) */
    double recent[STEADY_RECENT]; /* speed of the first fish in the last beats, beat n at n % STEADY_RECENT, m s-1 */
    /* told after each beat of the search; may be NULL */
    void (*progress)(const struct steady_problem *problem, void *data);
    void *data;
};

/* Pose the problem of a simulation at its start, which stays its owner's. Fails with STATUS_CASE where the case can
 * have no steady state, with the reason, or with STATUS_MEMORY; steady_problem_free takes what is left. */
enum status steady_problem_create(struct steady_problem *problem, const struct case_steady *settings,
                                  struct simulation *simulation);
void steady_problem_free(struct steady_problem *problem);

/* Go on by a beat of the search. Fails with STATUS_SOLVER and the reason after settings->beats of them, or as
 * steady_map_beat. */
enum status steady_problem_beat(struct steady_problem *problem);

/* What the unknowns are now, over their scales                                                   (n_unknowns) */
void steady_problem_read(const struct steady_problem *problem, double *value);

/* Make the unknowns what they are to be, over their scales. Fails as steady_map_add.               (n_unknowns) */
enum status steady_problem_put(struct steady_problem *problem, const double *to);

/* Put all pins where they belong, and the speeds among them to this one, m s-1. */
enum status steady_problem_put_pins(struct steady_problem *problem, double speed);

#endif
