/* wake_interpolation.h: velocity induced by the released vortices of all fish at the points of the bodies, interpolated
 * in time between two events. doc/numerics.md, section 12. Tested by tests/wake/test_wake_interpolation.c.
 *
 * Between two events t_n and t_n + Dt the vortices move on known paths, and a point of a body stays close to the path
 * X(t) that its position, velocity and acceleration at t_n predict. With tau = t - t_n, q = tau/Dt:
 *
 *     u(x, t) = sum_i l_i(q) U_i + ((1 - q) G_0 + q G_3) (x - X(t)) + the near field
 *
 * U_i: velocity at X at four times (i = 0 .. 3) from the beginning to the end, of all vortices except the near
 * vortices; l_i: the Lagrange cubics of these times; G_i: gradient of the velocity; x - X(t): the drift of the point.
 * The near field (near_field.h) is summed exactly. */
#ifndef WAKE_INTERPOLATION_H
#define WAKE_INTERPOLATION_H

#include "base/status.h"
#include "vortex/vortices.h"
#include "wake/wake.h"

struct wake_interpolation;

/* Positions and motion of all points of the bodies at an event; each array (points of all fish). */
struct wake_interpolation_points {
    const double *x, *y; /* m */
    const double *u, *v; /* velocity of the point, m s-1 */
    const double *a, *b; /* acceleration in x and y, m s-2 */
};

/* points: the points of each fish; without_own: the points of each fish at which the vortices of the same fish are
 * omitted; both (n_fish), owned by the caller, and must outlive the interpolation. Fails with STATUS_MEMORY;
 * wake_interpolation_free accepts NULL. */
enum status wake_interpolation_create(struct wake_interpolation **interpolation, const struct school *school,
                                      const struct range *points, const struct range *without_own);
void wake_interpolation_free(struct wake_interpolation *interpolation);

/* Build the interpolation for the interval that starts with the event at time t, for the points at the event; wakes
 * (n_fish). The estimated error of the velocity (near_field.h) stays below the wake tolerance of the school times one
 * length per beat of the fish. Fails with STATUS_MEMORY; the interpolation is then valid for no fish. */
enum status wake_interpolation_build(struct wake_interpolation *interpolation, const struct wake *wakes, double t,
                                     const struct wake_interpolation_points *points);

/* The released vortices of all wakes (n_fish) at the time tau after the event at time t; wake: range of the vortices of
 * each fish (n_fish). Fails with STATUS_MEMORY. */
enum status wake_interpolation_released(const struct school *school, const struct wake *wakes, double t, double tau,
                                        struct vortices *released, struct range *wake);

/* Set the time t within the interval. */
void wake_interpolation_update(struct wake_interpolation *interpolation, double t);

/* Whether the drift of the points of fish f is small enough for the interpolation; all points in the order of
 * wake_interpolation_build. Validity depends only on the time and the points, not on earlier calls, so that the
 * equations are a function of time and unknowns. At a change of validity the velocity changes by less than the
 * tolerance. */
int wake_interpolation_is_valid(const struct wake_interpolation *interpolation, int f, const double *x,
                                const double *y);

/* Add the interpolated velocity (and gradient) at points of fish f; first: index of the first point among all
 * points. */
void wake_interpolation_induce(const struct wake_interpolation *interpolation, int f, int first,
                               const struct induced *at);

/* Number of vortices in the near field of fish f; -1: too many near vortices, the fish has no interpolation. */
int wake_interpolation_n_near(const struct wake_interpolation *interpolation, int f);

#endif
