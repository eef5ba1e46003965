/* threshold.h: where an uncertain quantity changes its sign along a line, by secants, for the stability along a branch
 * of steady states (branch.h). doc/steady.md, section "Thresholds". Tested by tests/study/test_threshold.c. */
#ifndef THRESHOLD_H
#define THRESHOLD_H

#include "base/arena.h"
#include "base/status.h"

struct threshold_point {
    double at;     /* place on the line */
    double excess; /* the quantity whose zero is sought */
    double error;  /* of the excess; 0: unknown */
};

struct threshold_search {
    double shortest; /* a secant of this length ends the search although it is longer than the error allows */

    /* Fill excess and error at point->at. */
    enum status (*find)(void *data, struct threshold_point *point);
    void *data;
    int n;
    struct threshold_point *point; /* known points in any order, to which the search adds its own            (n) */
};

struct threshold {
    double at;        /* where the excess is 0 */
    double by_error;  /* error of the excess over the slope */
    double by_secant; /* length of the last secant */
    double slope;     /* of the excess over the place */
};

/* Find the zero between two known points, numbers a and b, whose excesses have different signs. arena: of the points.
 * Fails with STATUS_SOLVER if the errors hide the zero, or if the excess jumps there, and as find. The points stay. */
enum status threshold_solve(struct arena *arena, struct threshold_search *search, int a, int b,
                            struct threshold *found);

#endif
