/* bound_sheet.h: the equations that determine the vortex sheet along a body. No fluid crosses the body
 * (impermeability), the total circulation stays zero (Kelvin), and the flow leaves the tail smoothly (Kutta).
 * doc/model.md, sections 6 and 7. Tested by tests/force/test_bound_sheet.c. */
#ifndef BOUND_SHEET_H
#define BOUND_SHEET_H

#include "base/sparse.h"
#include "fish/fish.h"
#include "flow/flow_derivative.h"

/* Which equation determines the circulation that a fish sheds. */
enum bound_sheet_law {
    BOUND_SHEET_EDGE,  /* the bound vortex at the tail vanishes */
    BOUND_SHEET_RATE,  /* dGamma/dt = gamma_{M-1} ubar */
    BOUND_SHEET_FROZEN /* dGamma/dt = 0: nothing is shed between events (impulsive shedding) */
};

/* Set the rows gamma: impermeability at the control points, m s-1, then Kelvin's theorem, m2 s-1. removed: circulation
 * that has been removed from the wake, m2 s-1; u, v: velocity of the fluid at the points of the fish, m s-1
 * (flow_n_points). */
void bound_sheet_residual(const struct fish *fish, double removed, const double *u, const double *v, const double *y,
                          double *residual);

/* Add the derivatives of the rows gamma by the unknowns of the fish, with the velocity of the fluid held constant. */
void bound_sheet_jacobian(const struct fish *fish, const double *u, const double *v, const double *y,
                          struct sparse *jacobian);

/* Add their derivatives through the velocity of the fluid. */
void bound_sheet_flow_jacobian(const struct fish *fish, const struct influence_block *block, const double *y,
                               struct coupling_block *rows);

/* The shedding rate dGamma/dt of BOUND_SHEET_RATE, m2 s-2; u, v as above. */
double bound_sheet_shedding_rate(const struct fish *fish, const double *u, const double *v, const double *y);

/* Set the row circulation, add its derivatives, and add those through the velocity of the fluid (with BOUND_SHEET_RATE
 * only). */
void bound_sheet_kutta_residual(const struct fish *fish, enum bound_sheet_law law, const double *u, const double *v,
                                const double *y, const double *yp, double *residual);
void bound_sheet_kutta_jacobian(const struct fish *fish, enum bound_sheet_law law, double cj, const double *u,
                                const double *v, const double *y, struct sparse *jacobian);
void bound_sheet_kutta_flow_jacobian(const struct fish *fish, const struct influence_block *block, const double *y,
                                     struct coupling_block *rows);

/* The derivative of the end correction in the row of control point c by the unknown of bound vortex j, 1. It
 * accounts for the kink of the integrand at the tail. */
double bound_sheet_end_correction(const struct fish *fish, int c, int j);

/* The circulation of bound vortex j per current length of the body, m s-1. */
double bound_sheet_strength(const struct fish *fish, int j, const double *y);

/* Circulation of the bound sheet, m2 s-1. */
double bound_sheet_circulation(const struct fish *fish, const double *y);

#endif
