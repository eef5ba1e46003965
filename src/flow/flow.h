/* flow.h: where the points of all bodies are that feel the fluid, and the vortices that move it. What these do is in
 * flow_at_bodies.h, flow_derivative.h, flow_at_wake.h, flow_at_markers.h and flow_field.h. doc/model.md, sections 6 to
 * 9, 17. Tested by tests/flow/test_flow.c.
 *
 * The points of one fish, in this order; which sheets each of them feels:
 *
 *     | control points (M-1)          | edge midpoints (N-1)  | tail (1)                         |
 *     | all; own with no smoothing    | those of other fish   | all, with sheet_smoothing        |
 *
 * With force: reactive the edge midpoints leave out the own wake too (doc/model.md, section 9).
 *
 * The sources: per fish its free vortices, released ones and the nascent one, and its bound vortices. With shedding:
 * sheet the free vortices are the middles of the stretches of a sheet, and the control points of the own fish see more
 * (free_sheet.h).
 *
 * Smoothing: a point vortex has its own whoever feels it. With shedding: sheet a source and a target have one smoothing
 * for each other in both directions (model.md, section 8), which differs between targets of different lengths: fish of
 * one length are a class. */
#ifndef FLOW_H
#define FLOW_H

#include "base/status.h"
#include "fish/fish.h"
#include "flow/ring_sources.h"
#include "state/state.h"
#include "vortex/velocity_sum.h"
#include "vortex/vortices.h"
#include "wake/free_sheet.h"
#include "wake/wake_interpolation.h"

/* Points of one fish that a thread takes at once. */
struct chunk {
    int fish;
    struct range at; /* among the points of all fish */
};

/* Fish that feel every source with the same smoothing: with shedding: sheet those of one length, else all. Their points
 * follow one another, and so do their markers. */
struct flow_class {
    double smoothing, sheet_smoothing; /* delta and e of these fish, m */
    struct range points, markers;      /* of all of them; markers: at the last flow_at_wake */
    struct vortices sheet;             /* the bound vortices as their points feel them: a view of those of the flow */
    struct vortex_group *group; /* of that view and of another (flow_at_markers.c)     (n_fish + n_classes + 1) */
    int sheet_by_tree, images_by_many; /* what of it is summed for all points at once, in this evaluation */
};

struct flow {
    const struct school *school;
    double t;              /* time of the sources, s */
    unsigned long version; /* of the wakes that the sources below were made of */
    int has_sources;       /* whether they have been placed at all */

    int n_classes;
    struct flow_class *class; /*                                                      (n_classes) */
    int *class_of;            /* of each fish                                         (n_fish) */

    /* points */
    struct range *points;      /* of each fish, class after class                   (n_fish) */
    struct range *without_own; /* those of them that leave out the own wake         (n_fish) */
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
    /* with shedding: sheet, what convects the markers, as of the last flow_at_wake: they themselves, class after class,
     * then the bodies */
    struct vortices convecting;
    int n_markers;
    struct range *body_range; /* what each fish has of the bodies                          (n_fish) */
    struct range *wake_range; /* what each fish has of the markers, or of the vortices in `released` (n_fish) */
    double *wake_u, *wake_v;  /* velocity at vortices or markers, after flow_at_wake, m s-1 */
    /* beside walls, the part of it at markers that images cause, and after flow_images that at points (n_points) */
    double *wake_image_u, *wake_image_v, *image_u, *image_v;
    int wake_capacity;
    struct vortices nascent;   /* one of each fish                               (n_fish) */
    struct vortices sheet;     /* the bound vortices of all fish */
    struct range *sheet_range; /* of each fish                                   (n_fish) */
    double *opposite;          /* circulations of the bound vortices with the other sign (sheet.n) */

    struct flow_rings *rings;                 /* of a school with `finite`: ring_sources.h; else NULL */
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
    double *div;   /* with rings: of div u; else, or where nobody needs it, NULL (n_columns, n_points) */
    double *edge;  /* where a depth varies: of a; else NULL                   (2, n_columns, n_points) */
};

/* Fails with STATUS_MEMORY. flow_free accepts NULL. */
enum status flow_create(struct flow **flow, const struct school *school);
void flow_free(struct flow *flow);

/* The number of points of a fish. */
int flow_n_points(const struct fish *fish);

/* Index, among the points of a fish, of the midpoint of an edge and of the tail; control point c is point c. */
int flow_midpoint(const struct fish *fish, int edge);
int flow_tail(const struct fish *fish);

/* Place all sources where they are at time t (at or after the event of the state) for the unknowns y, and the points of
 * all fish; the released vortices, which are not needed at bodies for which they are interpolated, on demand. Fail with
 * STATUS_MEMORY. */
enum status flow_place(struct flow *flow, const struct state *state, double t, const double *y);
enum status flow_place_released(struct flow *flow, const struct state *state);

/* Whether the wakes are free sheets: with shedding: sheet. */
int flow_has_free_sheets(const struct flow *flow);

/* The smoothing with which the points of fish f feel the bound sheet of another fish g, and the images of any, m. */
double flow_sheet_smoothing(const struct flow *flow, int f, int g);

/* The wakes as vortices that everybody sees: those in the queues, or the middles of the stretches between markers. */
const struct wake *flow_seen_wakes(const struct flow *flow, const struct state *state);

/* What the points of fish f have of a quantity that its nodes have; of_points is that of all fish (n_points). */
void flow_from_nodes(const struct flow *flow, int f, const double *of_nodes, double *of_points);

#endif
