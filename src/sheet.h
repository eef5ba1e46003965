/* sheet.h: the equations of the bound sheet: no penetration, Kelvin, Kutta. doc/model.md, sections 6 and 7. Tested by
 * tests/test_sheet.c. */
#ifndef SHEET_H
#define SHEET_H

#include "fish.h"
#include "flow.h"
#include "sparse.h"

/* What holds for the circulation shed by a fish. */
enum sheet_law {
    SHEET_EDGE,  /* the bound vortex at the tail vanishes */
    SHEET_RATE,  /* dGamma/dt = chi gamma_{M-1} ubar */
    SHEET_FROZEN /* dGamma/dt = 0: nothing is shed between events (impulsive) */
};

/* No penetration at the control points, then Kelvin: rows sheet. u, v is the fluid's velocity at the fish's points. */
void sheet_residual(const struct fish *fish, double dissipated, const double *u, const double *v, const double *y,
                    double *residual);

/* Add the derivatives of the rows sheet: what depends on the body itself. */
void sheet_stamp(const struct fish *fish, const double *u, const double *v, const double *y, struct sparse *jacobian);

/* Add the derivatives of the rows sheet that come through the fluid's velocity. */
void sheet_stamp_flow(const struct fish *fish, const struct flow_block *block, const double *y, struct flow_rows *rows);

/* The rate at which circulation is shed by law SHEET_RATE, m2 s-2; u, v as above, chi the ramp. */
double sheet_shedding_rate(const struct fish *fish, double chi, const double *u, const double *v, const double *y);

/* The row shed. */
void sheet_kutta_residual(const struct fish *fish, enum sheet_law law, double chi, const double *u, const double *v,
                          const double *y, const double *yp, double *residual);
void sheet_kutta_stamp(const struct fish *fish, enum sheet_law law, double chi, double cj, const double *u,
                       const double *v, const double *y, struct sparse *jacobian);
void sheet_kutta_stamp_flow(const struct fish *fish, double chi, const struct flow_block *block, const double *y,
                            struct flow_rows *rows);

/* Unit normal of the chord between the bound vortices c and c + 1. */
void sheet_normal(const struct fish *fish, int c, const double *y, double normal[2]);

/* Circulation of the bound sheet, m2 s-1. */
double sheet_circulation(const struct fish *fish, const double *y);

#endif
