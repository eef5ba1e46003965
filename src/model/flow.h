/* flow.h: the velocity of the fluid at the points of every body and anywhere else: external flow, free sheets, nascent
 * vortices, bound sheets, and their images in walls. doc/model.md, sections 6 to 9, 17. Tested by
 * tests/model/test_flow.c.
 *
 * The points of one fish, in this order; which sheets each of them feels:
 *
 *     | control points (M-1)          | edge midpoints (N-1)  | tail (1)                         |
 *     | all; own with no smoothing    | those of other fish   | all, with sheet_smoothing        |
 *
 * The sources: per fish its free vortices, released ones and the nascent one, and its bound vortices. With shedding:
 * sheet the free vortices are the middles of the stretches of a sheet, and the control points of the own fish see more
 * (free_sheet.h). */
#ifndef FLOW_H
#define FLOW_H

#include "base/status.h"
#include "model/fish.h"
#include "model/free_sheet.h"
#include "model/state.h"
#include "model/wake_interpolation.h"
#include "vortex/velocity_sum.h"
#include "vortex/vortices.h"

/* Points of one fish that a thread takes at once. */
struct chunk {
    int fish;
    struct range at; /* among the points of all fish */
};

struct flow {
    const struct school *school;
    double t;              /* time of the sources, s */
    unsigned long version; /* of the wakes that the sources below were made of */
    int has_sources;       /* whether they have been placed at all */

    /* points */
    struct range *points; /* of each fish                                           (n_fish) */
    int n_points;
    int n_chunks;
    struct chunk *chunk;     /* all points, in pieces for the threads               (n_chunks) */
    double *x, *y, *u, *v;   /* place, m, and velocity of the fluid, m s-1         (n_points) */
    double *u_x, *u_y, *v_x; /* gradient, after flow_gradient, s-1                 (n_points) */

    /* sources */
    /* with shedding: sheet, what others see of each free sheet, as a wake of vortices; else it is not used (n_fish) */
    struct wake *middles;
    struct free_sheet *free_sheet; /* and what the own body sees besides                (n_fish) */
    struct vortices released;      /* the free vortices of all fish; placed only where a fish is not interpolated */
    struct range *released_range;  /* of each fish                                   (n_fish) */
    int has_released;              /* whether they are placed at t */
    struct vortices markers;       /* of all fish, at the last flow_at_wake */
    struct range *wake_range;      /* what each fish has of the following arrays         (n_fish) */
    double *wake_u, *wake_v;       /* velocity at vortices or markers, after flow_at_wake, m s-1 */
    int wake_capacity;
    struct vortices nascent;   /* one of each fish                               (n_fish) */
    struct vortices sheet;     /* the bound vortices of all fish */
    struct range *sheet_range; /* of each fish                                   (n_fish) */
    double *sheet_square;      /* of the smoothing with which markers see them, m2 (sheet.n) */
    double *opposite;          /* circulations of the bound vortices with the other sign (sheet.n) */

    struct velocity_sum *velocity_sum;        /* where wakes or sheets are summed by the tree */
    struct wake_interpolation *interpolation; /* of the released vortices; NULL: they are never interpolated */
    int is_interpolated;                      /* whether it was built, for the wakes of this version: */
    unsigned long interpolated_version;
    unsigned char *by_interpolation; /* whether it serves the fish where it is now        (n_fish) */
    int all_interpolated;            /* whether it serves all of them */
    double *motion[4];               /* velocity and acceleration of the points           (n_points) */
};

/* Derivative of the velocity at the points of fish f with respect to the unknowns of fish g, column by column:
 * columns are x (N_g), y (N_g), sheet (M_g), shed (1) of fish g. */
struct influence_block {
    int n_points, n_columns;
    double *u, *v; /* (n_columns, n_points) */
};

/* Derivative of the equations of fish f that feel the fluid with respect to the same unknowns of fish g, column by
 * column: row r is the equation at.ax + r of fish f, so rows are ax, ay, gamma, circulation. */
struct coupling_block {
    int n_rows, n_columns;
    double *value; /* (n_columns, n_rows) */
};

/* Fails with STATUS_MEMORY. flow_free accepts NULL. */
enum status flow_create(struct flow **flow, const struct school *school);
void flow_free(struct flow *flow);

/* The number of points of a fish. */
int flow_n_points(const struct fish *fish);

/* Index, among the points of a fish, of the midpoint of an edge and of the tail; control point c is point c. */
int flow_midpoint(const struct fish *fish, int edge);
int flow_tail(const struct fish *fish);

/* The unknown that column c of the block of fish other stands for. */
int flow_column(const struct fish *other, int c);

/* The number of rows of fish that feel the fluid, and of columns of the block of fish other. */
int flow_n_rows(const struct fish *fish);
int flow_n_columns(const struct fish *other);

/* The external flow at height y at time t. */
void flow_external(const struct school *school, double t, double y, double *u, double *v);

/* The acceleration Du/Dt of a particle of the external flow at time t, the same everywhere, m s-2. */
void flow_external_acceleration(const struct school *school, double t, double acceleration[2]);

/* What a body feels of the flow as it was last summed. */
struct flow_at_body {
    const double *u, *v;    /* velocity at its points, m s-1 (flow_n_points) */
    double acceleration[2]; /* of the external flow, m s-2 */
};
struct flow_at_body flow_at_body(const struct flow *flow, int f);

/* Velocity of the midpoint of an edge, which moves with the given one, relative to the fluid: w. */
void flow_relative_velocity(const struct fish *fish, int edge, const double velocity[2], const double *u,
                            const double *v, double w[2]);

/* Place all sources where they are at time t (at or after the event of the state) for the unknowns y, and sum the
 * velocity at all points of all fish; or the velocity with its gradient. Fail with STATUS_MEMORY. */
enum status flow_velocity(struct flow *flow, const struct state *state, double t, const double *y);
enum status flow_gradient(struct flow *flow, const struct state *state, double t, const double *y);

/* Interpolate in time what the released vortices cause at the bodies until the next event: from now on, and until the
 * wakes change, they are summed no more for a fish that stays near the path that it has in the state. At an event, once
 * the vortices have their velocities. Fails with STATUS_MEMORY. */
enum status flow_interpolate(struct flow *flow, const struct state *state);

/* Sum every released vortex until the next flow_interpolate. */
void flow_sum_exactly(struct flow *flow);

/* Fill block with the derivative of the velocity at the points of fish f by the unknowns of fish g. After
 * flow_gradient. */
void flow_derivative(const struct flow *flow, int f, int g, struct influence_block *block);

/* Fill block with the velocity at the points of fish f that each bound vortex of unit strength, and a nascent vortex of
 * unit circulation, of fish g causes: columns gamma (M_g), circulation (1). With the places of the last velocity. */
void flow_influence(const struct flow *flow, int f, int g, struct influence_block *block);

/* Fill block, of one column, with the velocity at the points of fish f that its own nascent vortex or stretch of unit
 * circulation causes. With the places of the last velocity. */
void flow_nascent_influence(const struct flow *flow, int f, struct influence_block *block);

/* The velocity of the fluid at the released vortices, or markers, of all fish at the event of the state: wake_u,
 * wake_v, of fish f from wake_range[f].first on. Fails with STATUS_MEMORY. */
enum status flow_at_wake(struct flow *flow, const struct state *state);

/* The velocity of the fluid and its gradient at any points, at the event of the state, as another body would see them:
 * every wake and every bound sheet with its full smoothing; NaN beyond the walls. Where there are many it sums by the
 * tree, to 1e-7 (velocity_sum.h). Changes nothing that a run depends on. Fails with STATUS_MEMORY. */
enum status flow_field(struct flow *flow, const struct state *state, const struct induced *at);

/* The fluid's velocity past the tail of fish f, u - v_tail. After flow_velocity. */
void flow_slip(const struct flow *flow, int f, const double *y, double slip[2]);

#endif
