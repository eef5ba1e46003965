/* clearance.h: the smallest distance of any two bodies of a school so far, at and between the steps of the integrator.
 * Bodies that touch or pass through each other are no valid solution. Tested by tests/contact/test_clearance.c. */
#ifndef CLEARANCE_H
#define CLEARANCE_H

#include "contact/neighbours.h"
#include "fish/fish.h"
#include "state/state.h"

/* The box of a body on straight node paths from the positions in before to the positions in y, widened by half the
 * thickness and half a distance, m: bodies with disjoint boxes stay further apart than this distance. */
struct box clearance_box(const struct fish *fish, double distance, const double *before, const double *y);

/* Start the record with the present bodies. neighbours: workspace (n_fish); between: scratch (n_unknowns). */
void clearance_start(const struct school *school, struct state *state, struct neighbours *neighbours, double *between);

/* Whether the distance of two bodies may be below a limit, m, at the end, or 0 on the way. */
int clearance_may_be_near(const struct fish *a, const struct fish *b, const double *before, const double *y,
                          double limit);

/* The passage of two bodies with straight node paths. */
struct passage {
    double now;   /* distance at the end, m; INFINITY: above the limit */
    double least; /* smallest distance found on the way, m; 0: contact */
    double part;  /* fraction of the way before contact; 1: no contact */
};

/* The passage from the positions in before to the positions in y. Distances above the limit, m, may be INFINITY;
 * contact is found for any limit. between: scratch (n_unknowns). */
struct passage clearance_passage(const struct fish *a, const struct fish *b, const double *before, const double *y,
                                 double limit, double *between);

/* Update state->closest after a step of the integrator to time t, s, and the unknowns y. Node paths within a step are
 * straight: a collision within the step is found for any distance at both ends. Workspace as above. */
void clearance_step(const struct school *school, struct state *state, double t, const double *y,
                    struct neighbours *neighbours, double *between);

#endif
