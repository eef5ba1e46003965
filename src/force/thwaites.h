/* thwaites.h: the friction of a laminar boundary layer on each side of a body, by Thwaites' method, from the velocities
 * on both sides of the bound sheet. This is an output: no force uses it. doc/model.md, section 9. Tested by
 * tests/force/test_thwaites.c. */
#ifndef THWAITES_H
#define THWAITES_H

#include "force/pressure.h"

/* Find the boundary layers on a wall with n points at increasing distances x, m. u is the velocity at the edge of
 * the layer, m s-1, positive towards larger x. A layer begins at each zero from which the flow diverges, and at the
 * ends. Set the friction over density, with the sign of u, m2 s-2, and lambda = theta^2 u'/nu, both (n) and 0 where
 * u is 0. */
void thwaites_layers(int n, const double *x, const double *u, double viscosity, double *friction, double *lambda);

/* The value of lambda at separation. */
extern const double thwaites_separation;

/* First index: left and right side. */
struct thwaites_friction {
    double force[2][2];   /* friction of each side on the body, x and y, N */
    double separation[2]; /* distance of separation from the nose over the length; NaN: none */
    double along;         /* friction of both sides along the body, positive towards the tail, N */
};

/* Find the friction on the sides of a fish with force: pressure, after pressure_update_rate. */
struct thwaites_friction thwaites_friction(struct pressure *pressure, const double *y, const double *yp);

#endif
