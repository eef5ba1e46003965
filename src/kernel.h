/* kernel.h: the velocity of smoothed point vortices at points, the inner loop of everything. doc/model.md, first
 * paragraph: K_e(r) = (-r_y, r_x) / (2 pi (|r|^2 + e^2)). Tested by tests/test_kernel.c.
 *
 * Every target sums over the sources in their order, whatever the width of the machine's vectors, so the results have
 * the same bits on every x86-64. Arrays are separate for x and y and need no alignment. */
#ifndef KERNEL_H
#define KERNEL_H

/* Add to (u, v) at each target the velocity of all sources; smoothing is the length e. A source at a target adds 0. */
void kernel_add_velocity(int n_targets, const double *x, const double *y, int n_sources, const double *source_x,
                         const double *source_y, const double *circulation, double smoothing, double *u, double *v);

/* The same, and add the gradient: u_x = du/dx = -dv/dy, u_y = du/dy, v_x = dv/dx (the field has no divergence). */
void kernel_add_gradient(int n_targets, const double *x, const double *y, int n_sources, const double *source_x,
                         const double *source_y, const double *circulation, double smoothing, double *u, double *v,
                         double *u_x, double *u_y, double *v_x);

/* Velocity and gradient at the distance (rx, ry) from one source of unit circulation. */
struct kernel_value {
    double u, v, u_x, u_y, v_x;
};
struct kernel_value kernel_unit(double rx, double ry, double smoothing);

#endif
