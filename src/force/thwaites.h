/* thwaites.h: friction of a laminar boundary layer on each side of a body by Thwaites' method, with the velocities on
 * both sides of the bound sheet. An output: no force uses these values. doc/model.md, section 9. Tested by
 * tests/force/test_thwaites.c. */
#ifndef THWAITES_H
#define THWAITES_H

#include "force/pressure.h"

/* Boundary layers on a wall with n points at the distances x, m, increasing; u: velocity at the edge of the layer, m
 * s-1, positive towards larger x. Layers begin at the zeros from which the flow diverges, and at the ends. Set the
 * friction over density, with the sign of u, m2 s-2, and lambda = theta^2 u'/nu, both (n); 0 where u is 0. */
void thwaites_layers(int n, const double *x, const double *u, double viscosity, double *friction, double *lambda);

/* lambda at separation. */
extern const double thwaites_separation;

/* Left and right side. */
struct thwaites_friction {
    double force[2][2];   /* friction of each side on the body, x and y, N */
    double separation[2]; /* distance of separation from the nose over the length; NaN: none */
    double along;         /* friction of both sides along the body, positive towards the tail, N */
};

/* The friction on the sides of a fish with force: pressure, after pressure_update_rate. */
struct thwaites_friction thwaites_friction(struct pressure *pressure, const double *y, const double *yp);

#endif
