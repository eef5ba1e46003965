/* wake_interpolation_outlook.h: which of the released vortices are near to a body: too near for a cubic in time. doc/numerics.md,
 * section 13. Only wake_interpolation.c uses it. Tested by tests/model/test_wake_interpolation.c. */
#ifndef NEAR_FIELD_H
#define NEAR_FIELD_H

#include "base/status.h"
#include "model/state.h"
#include "vortex/vortices.h"

/* What holds for all vortices of a wake. */
struct near_field_bounds {
    double low[2], high[2]; /* where they are at the event, m */
    double speed;           /* m s-1 */
    double acceleration;    /* m s-2 */
    double strength;        /* sum of the absolute values, m2 s-1 */
    double fading;          /* sum of the absolute changes in the interval, m2 s-1 */
};

/* Bounds of what a vortex contributes to errors, see struct near_field. */
struct near_field_part {
    double error, second, drifting;
};

/* A vortex that is near to a body: its path x + tau u + tau^2 a/2, and its strength as it counts in sums. */
struct wake_interpolation_n_near {
    struct near_field_part part; /* what it would contribute if it were far */
    double x[2], u[2], a[2];     /* at the event */
    double strength, change;     /* at the event, and until the end of the interval, m2 s-1 */
    double smoothing;            /* m */
};

/* What is foretold for one fish. */
struct near_field {
    int serves;      /* 0: so much is near that nothing is foretold */
    double allowed;  /* error of the velocity, m s-1 */
    double second;   /* of the far vortices: bound of half the second derivatives of the velocity, m-1 s-1 */
    double drifting; /* and of the error of the gradient, s-1 */
    int n_near, capacity;
    struct wake_interpolation_n_near *near;
    struct vortices now; /* the near ones, where near_field_place has put them */
};

/* What all fish see at the beginning of an interval. */
struct near_field_scene {
    const struct school *school;
    const struct state *state;
    const struct range *points;             /* of each fish                           (n_fish) */
    double *const *motion;                  /* of all points: x y, u v, a b           (6 of n_points) */
    const struct near_field_bounds *bounds; /* of each wake                           (n_fish) */
    const struct range *wake;               /* the released vortices of each fish     (n_fish) */
    const double *before, *after;           /* strengths at both ends of the interval (n_released) */
    int n_released;
};

/* before and after: the strengths of this wake's vortices at both ends of the interval, s. */
struct near_field_bounds near_field_bound_wake(const struct wake *wake, double interval, const double *before,
                                               const double *after);

/* Decide for fish f which vortices are near. Fails with STATUS_MEMORY. */
enum status near_field_find(struct near_field *near_field, const struct near_field_scene *scene, int f);

/* Put the near vortices where they are at the time tau, q of the interval, with their strengths times a factor. */
void near_field_place(struct near_field *near_field, double tau, double q, double factor);

/* Release what it owns; accepts a zeroed one. */
void near_field_free(struct near_field *near_field);

#endif
