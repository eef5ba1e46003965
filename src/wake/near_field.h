/* near_field.h: near field of a body: the released vortices for which interpolation in time (wake_interpolation.h) is
 * too inaccurate. doc/numerics.md, section 12. Tested by tests/wake/test_near_field.c.
 *
 * The error of the interpolated velocity at a point with the drift d, the distance from the predicted path:
 *
 *     error + by_drift d + by_drift_square d^2,      summed over the vortices of the far field
 *
 * Each of the three coefficients is an ESTIMATE, a tenth of a bound. The bound assumes the smallest distance, the
 * largest speed and one sign for all vortices; in wakes the bound is 50 to 1000 times the true error. The estimate is
 * kept below the tolerance. The true error can therefore exceed the tolerance: 1.65 times in the tests for a cluster of
 * vortices of one sign at the smallest distance, and never ten times.
 *
 * The nearest images of the vortices in walls (images.h) are treated like vortices and may belong to the near field.
 * The estimate omits the further images, whose distance exceeds the width of the channel. */
#ifndef NEAR_FIELD_H
#define NEAR_FIELD_H

#include "base/status.h"
#include "vortex/vortices.h"
#include "wake/wake.h"

/* Bounds for all vortices of a wake. */
struct near_field_bounds {
    double low[2], high[2]; /* bounding box at the event, m */
    double speed;           /* m s-1 */
    double acceleration;    /* m s-2 */
    double strength;        /* sum of the absolute strengths, m2 s-1 */
    double decay;           /* sum of the absolute changes in the interval, m2 s-1 */
};

/* Estimated error of the interpolated velocity: see above. */
struct near_field_error {
    double error;           /* on the predicted path, m s-1 */
    double by_drift;        /* of the gradient, s-1 */
    double by_drift_square; /* half the second derivatives of the velocity, m-1 s-1 */
};

/* A vortex in the near field: path x + tau u + tau^2 a/2, and strength in velocity sums. */
struct near_field_vortex {
    struct near_field_error error; /* error of the vortex in the far field */
    double x[2], u[2], a[2];       /* at the event */
    double strength, change;       /* at the event; change until the end of the interval, m2 s-1 */
    double smoothing;              /* m */
    int is_own;                    /* belongs to the own wake and is not an image */
};

/* Near and far field of one fish. */
struct near_field {
    int is_interpolated;         /* 0: the sum over all vortices costs less than the near field */
    double tolerance;            /* of the velocity, m s-1 */
    struct near_field_error far; /* sum over the far field */
    int n_near, capacity;
    struct near_field_vortex *near; /* (n_near) */
    struct range own;               /* near vortices of the own wake */
    struct vortices vortices;       /* the near vortices at the time of near_field_update */
};

/* Bodies and wakes at the start of an interval. */
struct near_field_input {
    const struct school *school;
    const struct wake *wakes;                    /* (n_fish) */
    const struct range *points;                  /* of each fish                           (n_fish) */
    double *const *motion;                       /* of all points: x y, u v, a b           (6 of n_points) */
    const struct near_field_bounds *bounds;      /* of each wake                           (n_fish) */
    const struct range *wake;                    /* the released vortices of each fish     (n_fish) */
    const double *strength_start, *strength_end; /* at the start and at the end of the interval (n_released) */
    int n_released;
};

/* Bounds of a wake; strength_start, strength_end: strengths of the vortices at the start and at the end of the
 * interval; interval in s. */
struct near_field_bounds near_field_bound_wake(const struct wake *wake, double interval, const double *strength_start,
                                               const double *strength_end);

/* Divide the released vortices into the near and the far field of fish f. Fails with STATUS_MEMORY. */
enum status near_field_find(struct near_field *near_field, const struct near_field_input *input, int f);

/* Whether the far field is accurate enough at points with at most this square of the drift, m2. */
int near_field_is_valid(const struct near_field *near_field, double drift_square);

/* Move the near vortices to the time tau, the fraction q of the interval; multiply the strengths by factor. */
void near_field_update(struct near_field *near_field, double tau, double q, double factor);

/* Free all memory of the near field; accepts a zeroed near field. */
void near_field_free(struct near_field *near_field);

#endif
