/* near_field.h: which of the released vortices are in the near field of a body: those for which interpolation in time
 * (wake_interpolation.h) is too inaccurate. doc/numerics.md, section 12. Tested by tests/wake/test_near_field.c.
 *
 * The error of the interpolated velocity at a point whose drift, the distance from its predicted path, is d:
 *
 *     error + by_drift d + by_drift_square d^2,      summed over the vortices of the far field
 *
 * Each of the three is an ESTIMATE, a tenth of a bound. The bound takes every vortex at its closest and fastest, and
 * all of them with one sign; in wakes it is 50 to 1000 times the true error. The estimate is held below the tolerance.
 * So a cluster of vortices of one sign, all of them at their closest, can exceed the tolerance: 1.65 times in the
 * tests, and never ten times.
 *
 * The nearest images of the vortices in walls (images.h) count like vortices, and may be near ones. Those beyond are
 * left out of the estimate: they are further than the channel is wide. */
#ifndef NEAR_FIELD_H
#define NEAR_FIELD_H

#include "base/status.h"
#include "vortex/vortices.h"
#include "wake/wake.h"

/* What holds for all vortices of a wake. */
struct near_field_bounds {
    double low[2], high[2]; /* where they are at the event, m */
    double speed;           /* m s-1 */
    double acceleration;    /* m s-2 */
    double strength;        /* sum of the absolute values, m2 s-1 */
    double decay;           /* sum of the absolute changes in the interval, m2 s-1 */
};

/* The estimated error of the interpolated velocity: see above. */
struct near_field_error {
    double error;           /* on the predicted path, m s-1 */
    double by_drift;        /* of the gradient, s-1 */
    double by_drift_square; /* half the second derivatives of the velocity, m-1 s-1 */
};

/* A vortex in the near field: its path x + tau u + tau^2 a/2, and its strength as it counts in sums. */
struct near_field_vortex {
    struct near_field_error error; /* what it would contribute to the far field */
    double x[2], u[2], a[2];       /* at the event */
    double strength, change;       /* at the event, and until the end of the interval, m2 s-1 */
    double smoothing;              /* m */
    int is_own;                    /* of the wake of the fish itself, and no image in a wall */
};

/* The near and the far field of one fish. */
struct near_field {
    int is_interpolated;         /* 0: so many vortices are near that summing all of them costs less */
    double tolerance;            /* of the velocity, m s-1 */
    struct near_field_error far; /* sum over the far field */
    int n_near, capacity;
    struct near_field_vortex *near; /* (n_near) */
    struct range own;               /* those of the own wake */
    struct vortices vortices;       /* the near ones, where near_field_update has put them */
};

/* Bodies and wakes at the beginning of an interval. */
struct near_field_input {
    const struct school *school;
    const struct wake *wakes;                    /* (n_fish) */
    const struct range *points;                  /* of each fish                           (n_fish) */
    double *const *motion;                       /* of all points: x y, u v, a b           (6 of n_points) */
    const struct near_field_bounds *bounds;      /* of each wake                           (n_fish) */
    const struct range *wake;                    /* the released vortices of each fish     (n_fish) */
    const double *strength_start, *strength_end; /* at both ends of the interval         (n_released) */
    int n_released;
};

/* The strengths are those of this wake's vortices at both ends of the interval, s. */
struct near_field_bounds near_field_bound_wake(const struct wake *wake, double interval, const double *strength_start,
                                               const double *strength_end);

/* Divide the released vortices into the near and the far field of fish f. Fails with STATUS_MEMORY. */
enum status near_field_find(struct near_field *near_field, const struct near_field_input *input, int f);

/* Whether the far field is accurate enough at points whose drift, m, has at most this square. */
int near_field_is_valid(const struct near_field *near_field, double drift_square);

/* Move the near vortices to the time tau, q of the interval, with their strengths times a factor. */
void near_field_update(struct near_field *near_field, double tau, double q, double factor);

/* Release what it owns; accepts a zeroed one. */
void near_field_free(struct near_field *near_field);

#endif
