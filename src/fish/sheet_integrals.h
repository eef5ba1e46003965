/* sheet_integrals.h: integrals over the bound sheet. All of them are linear in the circulations, so they are matrices
 * that are computed once. doc/model.md, section 15. Tested by tests/fish/test_sheet_integrals.c.
 *
 * Between nose and tail, 0 <= theta <= pi, the sheet is the cosine series through the vortices. C_j(theta) is the
 * circulation between nose and theta of the series that has circulation 1 at vortex j and 0 at all others. */
#ifndef SHEET_INTEGRALS_H
#define SHEET_INTEGRALS_H

#include <signal.h>

#include "base/arena.h"
#include "base/status.h"

struct sheet_integrals {
    int n_nodes, n_sheet, n_control;
    /* P_kij, the integral over u of density C_j b_k b_i', kg m-2, in partial fractions: of each vortex j the numbers A,
     * B, E and the diagonal P_kkj of each node                                           (n_sheet, 4, n_nodes) */
    double *part;
    double *factor;  /* c_k of the smooth curve                                               (n_nodes) */
    double *inverse; /* 1/m for m = 1 - n_nodes .. n_nodes - 1; 0 for m = 0             (2 n_nodes - 1) */
    /* times the circulations of the vortices: Q_c, the circulation of the interval around each control point, by G; the
     * circulation between the nose and each control point, by C_j; both 1          (n_sheet, n_control) by columns */
    double *strength, *circulation;
    /* Corrections of both sums at the control points for a finite strength at the tail, per q_M-2 - 2 q_M-1: g then has
     * a kink at the tail, beyond the cosine series                                               (n_control) */
    double *kink_strength, *kink_circulation;
};

/* Integrals on the smooth curve; density: fluid density times depth of every edge, kg m-2 (n_nodes - 1). Fails with
 * STATUS_STOPPED once *stop is not 0 (stop may be NULL). */
enum status sheet_integrals_create(struct arena *arena, struct sheet_integrals **integrals, int n_nodes, int n_sheet,
                                   const double *density, const volatile sig_atomic_t *stop);

/* sum over j of P_kij times circulation j, kg s-1, as a matrix (k, i) by columns; parts: workspace (4 n_nodes). */
void sheet_integrals_matrix(const struct sheet_integrals *integrals, const double *circulation, double *parts,
                            double *matrix);

/* sums over i of P_kij x_i and of P_kij y_i of vortex j for all nodes k (n_nodes). */
void sheet_integrals_product(const struct sheet_integrals *integrals, int j, const double *x, const double *y,
                             double *to_x, double *to_y);

#endif
