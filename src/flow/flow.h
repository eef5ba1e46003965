/* flow.h: positions of the evaluation points of all bodies, and positions and strengths of the sources. The velocities
 * are in flow_at_bodies.h, flow_derivative.h and flow_at_wake.h. doc/model.md, sections 6 to 9, 17. Tested by
 * tests/flow/test_flow.c.
 *
 * The points of one fish, in this order, and the bound sheets that act at each point:
 *
 *     | control points (M-1)          | edge midpoints (N-1)  | tail (1)                         |
 *     | all; own without smoothing    | sheets of other fish  | all, with sheet_smoothing        |
 *
 * With force: reactive the own wake is omitted at the edge midpoints (doc/model.md, section 9).
 *
 * Sources per fish: free vortices (released and nascent) and bound vortices. With shedding: sheet the free vortices
 * are the middles of the stretches of a sheet; the own control points have additional sources (free_sheet.h).
 *
 * Smoothing: the smoothing of a point vortex does not depend on the target. With shedding: sheet a source and a target
 * have a common smoothing in both directions (doc/model.md, section 8), which depends on the length of the target: fish
 * of equal length form a class. */
#ifndef FLOW_H
#define FLOW_H

#include "base/status.h"
#include "fish/fish.h"
#include "state/state.h"
#include "vortex/ring.h"
#include "vortex/ring_tree.h"
#include "vortex/velocity_sum.h"
#include "vortex/vortices.h"
#include "wake/free_sheet.h"
#include "wake/ring_sheet.h"
#include "wake/wake_interpolation.h"

/* The external flow at time t: a stream with shear and gusts. doc/model.md, sections 8 and 9. flow_gust: the part of a
 * travelling gust; flow_external_gradient: u_x, u_y, v_x, s-1 (v_y = -u_x). */
void flow_external(const struct school *school, double t, double x, double y, double *u, double *v);
void flow_gust(const struct school *school, double t, double x, double y, double *u, double *v);
void flow_external_gradient(const struct school *school, double t, double x, double y, double gradient[3]);

/* Acceleration Du/Dt of a particle of the external flow at time t, uniform in space, m s-2: without a travelling gust.
 */
void flow_external_acceleration(const struct school *school, double t, double acceleration[2]);

// ---- positions and strengths of the vortex rings of bodies and wakes of finite depth. doc/model.md, section 18

enum { N_LEG_SUMS = 7 };

/* The rings of one fish. */
struct fish_rings {
    struct ring_sheets wake; /* for the own control points, and for all other targets */
    struct rings own;        /* own body at the own control points: bound vortices, then legs of control points */
    struct rings body;       /* control points, each with the circulation of its interval and its leg */
    double *line[2];         /* dx of the control points, m                        (n_control) */
    double newest;           /* label of the newest marker, m2 s-1 */
    double downstream[2];    /* direction of the legs of a steady wake; 0 without a stream */
    struct rings markers;    /* at the last event */
    int n_far;               /* number of oldest stretches that are summed at the far points; 0: none */
    double far[5][FISH_FAR]; /* far points: positions, m; velocity, m s-1; div u, s-1 */
    struct rings body_image, middles_image, markers_image;
};

struct flow_rings {
    struct fish_rings *fish; /* (n_fish) */
    int is_steady;           /* whether all legs go from the tail to infinity, in an equilibrium; set from outside */
    int n_images;
    struct ring_image *image; /* of every ring in the walls                                        (n_images) */
    /* with the velocity at points: div u, gradient of div u; a, gradient of a, one component after the other
     * (n_points) */
    double *div, *div_x, *div_y, *edge, *edge_gradient;
    double *image_div;        /* after flow_rings_images                                       (n_points) */
    double *legs[N_LEG_SUMS]; /* workspace: velocities of the own legs at control points   (n_points) */
    /* at markers, after flow_rings_at_markers: rates of labels; div u of images; velocity and div u of the own legs
     * (n_markers) */
    int wake_capacity;
    double *wake_div, *wake_rate, *wake_image_div, *wake_leg_u, *wake_leg_v, *wake_leg_div;

    /* sums of many fish by the tree: sources and targets of one sum; whether the sum of bodies or of wakes of one class
     * or of the images at another class is by the tree, in this evaluation (2, 2, n_classes, n_classes) */
    struct ring_tree *tree;
    struct rings many, places;
    int *by_tree;
};

/* Points of one fish that a thread evaluates at once. */
struct chunk {
    int fish;
    struct range at; /* range among the points of all fish */
};

/* Fish with the same smoothing for every source: with shedding: sheet the fish of one length, else all fish. The points
 * of a class are consecutive, and so are the markers. */
struct flow_class {
    double smoothing, sheet_smoothing; /* delta and e of these fish, m */
    struct range points, markers;      /* ranges of the class; markers: at the last flow_at_wake */
    struct vortices sheet;             /* the bound vortices with the smoothing of this class: a view of flow.sheet */
    struct vortex_group *group;        /* groups of this view and of flow_at_wake.c        (n_fish + n_classes + 1) */
    int sheet_by_tree, images_by_many; /* whether one sum covers all points, in this evaluation */
};

struct flow {
    const struct school *school;
    double t;              /* time of the sources, s */
    unsigned long version; /* version of the wakes from which the sources below were built */
    int has_sources;       /* whether the sources have been placed */

    int n_classes;
    struct flow_class *class; /*                                                      (n_classes) */
    int *class_of;            /* of each fish                                         (n_fish) */

    /* points */
    struct range *points;      /* of each fish, class after class                   (n_fish) */
    struct range *without_own; /* points at which the own wake is omitted         (n_fish) */
    int n_points;
    int n_chunks;
    struct chunk *chunk;     /* all points in chunks for the threads               (n_chunks) */
    double *x, *y, *u, *v;   /* position, m, and velocity of the fluid, m s-1     (n_points) */
    double *u_x, *u_y, *v_x; /* gradient, after flow_gradient, s-1                 (n_points) */

    /* sources */
    /* with shedding: sheet, each free sheet as a wake of vortices for other targets; else unused (n_fish) */
    struct wake *middles;
    struct free_sheet *free_sheet; /* correction for the own control points               (n_fish) */
    struct vortices released;      /* free vortices of all fish; placed only if a fish is not interpolated */
    struct range *released_range;  /* of each fish                                   (n_fish) */
    int has_released;              /* whether the released vortices are placed at t */
    /* with shedding: sheet, the vortices that convect the markers, at the last flow_at_wake: the markers, class after
     * class, then the bodies */
    struct vortices convecting;
    int n_markers;
    struct range *body_range; /* range of the body of each fish                         (n_fish) */
    struct range *wake_range; /* range of the markers of each fish, or in `released`              (n_fish) */
    double *wake_u, *wake_v;  /* velocity at vortices or markers, after flow_at_wake, m s-1 */
    /* with walls: velocity of the images at markers, and after flow_images at points (n_points) */
    double *wake_image_u, *wake_image_v, *image_u, *image_v;
    int wake_capacity;
    struct vortices nascent;   /* one nascent vortex per fish                  (n_fish) */
    struct vortices sheet;     /* the bound vortices of all fish */
    struct range *sheet_range; /* of each fish                                   (n_fish) */
    double *opposite;          /* opposite circulations of the bound vortices     (sheet.n) */

    struct flow_rings *rings;                 /* only for a school with `finite`: flow.h; else NULL */
    struct velocity_sum *velocity_sum;        /* tree sums of wakes and sheets */
    struct wake_interpolation *interpolation; /* interpolation of the released vortices; NULL: never interpolated */
    int is_interpolated;                      /* whether the interpolation was built for the wakes of this version: */
    unsigned long interpolated_version;
    unsigned char *by_interpolation; /* whether the interpolation is valid for each fish      (n_fish) */
    int all_interpolated;            /* whether the interpolation is valid for all fish */
    double *motion[4];               /* velocity and acceleration of the points           (n_points) */
};

/* Derivative of the velocity at the points of fish f with respect to the unknowns of fish g, column by column:
 * columns are x (N_g), y (N_g), sheet (M_g), shed (1) of fish g. */
struct influence_block {
    int n_points, n_columns;
    double *u, *v; /* (n_columns, n_points) */
    double *div;   /* with rings: derivative of div u; NULL if not required (n_columns, n_points) */
    double *edge;  /* with varying depth: derivative of a; else NULL (2, n_columns, n_points) */
};

/* Fails with STATUS_MEMORY. flow_free accepts NULL. */
enum status flow_create(struct flow **flow, const struct school *school);
void flow_free(struct flow *flow);

/* Number of points of a fish. */
int flow_n_points(const struct fish *fish);

/* Index, among the points of a fish, of the midpoint of an edge and of the tail. Control point c has index c. */
int flow_midpoint(const struct fish *fish, int edge);
int flow_tail(const struct fish *fish);

/* Place all sources and the points of all fish at time t (at or after the event of the state) for the unknowns y.
 * flow_place_released places the released vortices, which are not required at interpolated bodies. Fail with
 * STATUS_MEMORY. */
enum status flow_place(struct flow *flow, const struct state *state, double t, const double *y);
enum status flow_place_released(struct flow *flow, const struct state *state);

/* Whether the wakes are free sheets (shedding: sheet). */
int flow_has_free_sheets(const struct flow *flow);

/* Smoothing of the bound sheet of fish g at the points of another fish f, and of the images of any fish, m. */
double flow_sheet_smoothing(const struct flow *flow, int f, int g);

/* The wakes as vortices: the queues, or the middles of the stretches between markers. */
const struct wake *flow_seen_wakes(const struct flow *flow, const struct state *state);

/* Interpolate a quantity at the nodes of fish f to the points of fish f; of_points: values at the points of all fish
 * (n_points). */
void flow_from_nodes(const struct flow *flow, int f, const double *of_nodes, double *of_points);

#endif
