/* clearance.h: how close two bodies of a school have come, at the steps of the integrator and between them: bodies that
 * touch or pass through each other are no solution. Tested by tests/contact/test_clearance.c. */
#ifndef CLEARANCE_H
#define CLEARANCE_H

#include "contact/neighbours.h"
#include "fish/fish.h"
#include "state/state.h"

/* All places of a body while its nodes go straight from those in before to those in y, with half its thickness and half
 * a distance, m: bodies whose boxes do not overlap never come as near to each other as that. */
struct box clearance_box(const struct fish *fish, double distance, const double *before, const double *y);

/* The record begins with the bodies as they are. neighbours: workspace (n_fish); between: scratch (n_unknowns). */
void clearance_start(const struct school *school, struct state *state, struct neighbours *neighbours, double *between);

/* Whether two bodies may be nearer to each other than a limit, m, at the end or, should they have met, on the way. */
int clearance_may_be_near(const struct fish *a, const struct fish *b, const double *before, const double *y,
                          double limit);

/* How two bodies pass each other while their nodes go straight. */
struct passage {
    double now;   /* distance at the end, m; INFINITY: above the limit */
    double least; /* smallest distance seen on the way, m; 0: they touch */
    double part;  /* of the way after which they touch; 1: they do not */
};

/* From the places in before to those in y. Distances above the limit, m, may be INFINITY; whether bodies touch is found
 * for any limit. between: scratch (n_unknowns). */
struct passage clearance_passage(const struct fish *a, const struct fish *b, const double *before, const double *y,
                                 double limit, double *between);

/* A step of the integrator has ended at time t, s, with the unknowns y: bring state->closest up to date. Between two
 * steps nodes go straight: bodies that meet there are found too, however far apart they are at both ends. Workspace
 * as above. */
void clearance_step(const struct school *school, struct state *state, double t, const double *y,
                    struct neighbours *neighbours, double *between);

#endif
