/* forecast_outlook.h: which of the released vortices are near to a body: too near for a cubic in time. doc/numerics.md,
 * section 13. Only forecast.c uses it. Tested by tests/test_forecast.c. */
#ifndef FORECAST_OUTLOOK_H
#define FORECAST_OUTLOOK_H

#include "state.h"
#include "status.h"
#include "vortices.h"

/* What holds for all vortices of a wake. */
struct forecast_bounds {
    double low[2], high[2]; /* where they are at the event, m */
    double speed;           /* m s-1 */
    double acceleration;    /* m s-2 */
    double strength;        /* sum of the absolute values, m2 s-1 */
    double fading;          /* sum of the absolute changes in the interval, m2 s-1 */
};

/* Bounds of what a vortex contributes to errors, see struct forecast_outlook. */
struct forecast_part {
    double error, second, drifting;
};

/* A vortex that is near to a body: its path x + tau u + tau^2 a/2, and its strength as it counts in sums. */
struct forecast_near {
    struct forecast_part part; /* what it would contribute if it were far */
    double x[2], u[2], a[2];   /* at the event */
    double strength, change;   /* at the event, and until the end of the interval, m2 s-1 */
    double smoothing;          /* m */
};

/* What is foretold for one fish. */
struct forecast_outlook {
    int serves;      /* 0: so much is near that nothing is foretold */
    double allowed;  /* error of the velocity, m s-1 */
    double second;   /* of the far vortices: bound of half the second derivatives of the velocity, m-1 s-1 */
    double drifting; /* and of the error of the gradient, s-1 */
    int n_near, capacity;
    struct forecast_near *near;
    struct vortices now; /* the near ones, where forecast_place_near has put them */
};

/* What all fish see at the beginning of an interval. */
struct forecast_scene {
    const struct school *school;
    const struct state *state;
    const struct range *points;           /* of each fish                           (n_fish) */
    double *const *motion;                /* of all points: x y, u v, a b           (6 of n_points) */
    const struct forecast_bounds *bounds; /* of each wake                           (n_fish) */
    const struct range *wake;             /* the released vortices of each fish     (n_fish) */
    const double *before, *after;         /* strengths at both ends of the interval (n_released) */
    int n_released;
};

/* before and after: the strengths of this wake's vortices at both ends of the interval, s. */
struct forecast_bounds forecast_bound_wake(const struct wake *wake, double interval, const double *before,
                                           const double *after);

/* Decide for fish f which vortices are near. Fails with STATUS_MEMORY. */
enum status forecast_look_out(struct forecast_outlook *outlook, const struct forecast_scene *scene, int f);

/* Put the near vortices where they are at the time tau, q of the interval, with their strengths times a factor. */
void forecast_place_near(struct forecast_outlook *outlook, double tau, double q, double factor);

/* Release what it owns; accepts a zeroed one. */
void forecast_outlook_free(struct forecast_outlook *outlook);

#endif
