/* clearance.h: how close two bodies of a school have come, at the steps of the integrator and between them: the model
 * knows no contact, so bodies that touch or pass through each other are no solution. Tested by
 * tests/model/test_clearance.c. */
#ifndef CLEARANCE_H
#define CLEARANCE_H

#include "model/fish.h"
#include "model/state.h"

/* The record begins with the bodies as they are. between: scratch (n_unknowns). */
void clearance_start(const struct school *school, struct state *state, double *between);

/* A step of the integrator has ended at time t, s, with the unknowns y: bring state->closest up to date. Between two
 * steps nodes go straight: bodies that meet there are found too, however far apart they are at both ends. between:
 * scratch (n_unknowns). */
void clearance_step(const struct school *school, struct state *state, double t, const double *y, double *between);

#endif
