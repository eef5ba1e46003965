/* steady_modes.h: growth and decay of small disturbances: modes of the bodies for an equilibrium, multipliers for
 * a beat. Tested by tests/steady/test_steady_modes.c, test_steady.c and the section "elastic" of `make verify`. */
#ifndef STEADY_MODES_H
#define STEADY_MODES_H

#include "steady/steady_problem.h"

/* Fill the exponents of an equilibrium; the state of the simulation is restored on success. Hold the bodies while a
 * wake of zero strength is convected downstream, then find the modes with solver/modes.h. No exponents with
 * pressure.span: finite, if the state jumps at events (wake.shedding: impulsive), without a stream, or without
 * shedding. Fails with STATUS_SOLVER or STATUS_STOPPED. */
enum status steady_modes_find(struct simulation *simulation, struct steady_values *found);

/* Fill the exponents of a beat from the multipliers and the period, s. */
void steady_modes_of_multipliers(struct steady_values *found, double period);

/* Floquet multipliers: factors by which small disturbances of the slow quantities grow in a beat, by falling absolute
 * value. */
struct steady_multipliers {
    int n;                    /* n_unknowns */
    double *real, *imaginary; /* 0: the disturbance has decayed below the noise          (n) */
    double *error;            /* of the absolute value: noise and size of the differences, memory of the wake  (n) */
    double *mode;             /* real and imaginary parts of the unknowns, over the scales and over the largest
                                    (n multipliers, n unknowns, 2) */
    double amplification;     /* largest norm of the unknowns, over the scales, within
                                 STEADY_AMPLIFIED_BEATS after a unit change of one unknown */
    double *way;              /* step to the fixed point of the linearised map, over the scales of the unknowns (n) */
    int n_beats;              /* simulated */
};

/* Find the multipliers at the current state of the simulation. arena: of the arrays. The state is restored on success.
 * Fails with STATUS_SOLVER, STATUS_CONTACT or STATUS_STOPPED. */
enum status steady_multipliers_find(struct arena *arena, struct steady_problem *problem,
                                    struct steady_multipliers *found);

#endif
