/* flow.h: what induces velocity, and where it is needed: the evaluation points of all bodies, and the positions and
 * strengths of all sources. The sums at bodies are in flow_at_bodies.h and flow_derivative.h, those at wakes in
 * flow_at_wake.h and flow_leg_rate.h. doc/model.md, sections 6 to 9, 17, 18. Tested by tests/flow/test_flow.c.
 *
 * The points of one fish, in this order:
 *
 *     | control points (M-1)      | edge midpoints (N-1)      | tail (1)        |
 *
 * The same fish is a source of several shapes, one for each kind of target, because the kernel (kernel.h) has one pair
 * of constants for targets in the strip of the same fish and another for all others:
 *
 *     own control points        own: bound vortices, and legs at the control points; wake, point by point, tapered
 *     own midpoints, own tail   the middle of every stretch, at midpoints not with force: reactive; point vortices: the
 *                               queue, and at the tail the bound vortices
 *     bodies of other fish      body: control points, or bound vortices; the middle of every stretch, or the queue
 *     own and other wakes       body, for its own markers tapered; markers, or the queue
 *     images in walls           of all fish, including itself, as for other fish
 *
 * How a source is smoothed depends on the pair (flow_square). Fish of equal length form a class, whose sources and
 * targets have the same smoothing, so that sums can run over a whole class. */
#ifndef FLOW_H
#define FLOW_H

#include "base/status.h"
#include "fish/fish.h"
#include "flow/kernel.h"
#include "flow/tree.h"
#include "state/state.h"
#include "wake/sheet.h"
#include "wake/sources.h"

enum { N_LEG_SUMS = 7 };

/* The sources of one fish. */
struct flow_fish {
    struct sheet wake;  /* one view for the control points of this fish, one for all other targets */
    struct sources own; /* bound vortices, followed by the legs at control points if the kernel has legs */
    /* with integrals of the sheet the control points, each with the circulation of its interval and its leg; otherwise
     * the bound vortices */
    struct sources body;
    double *line[2];        /* dx of the control points, m                        (n_control) */
    double nascent;         /* circulation of the nascent stretch or vortex, m2 s-1 */
    double newest;          /* circulation that was shed before it, m2 s-1 */
    double downstream[2];   /* direction of the legs of a steady wake; 0 without a stream */
    struct sources markers; /* markers, or queue and nascent vortex, at the last event */
    struct sources body_image, wake_image, markers_image;
    struct box *leg_box; /* first around the body, then around every 64 markers     (n_leg_boxes) */
    int n_leg_boxes, leg_box_capacity;
};

/* Points of one fish that a thread evaluates at once. */
struct chunk {
    int fish;
    struct range at; /* range among the points of all fish */
};

/* Fish of one length. The points of a class are consecutive. */
struct flow_class {
    double smoothing, sheet_smoothing; /* delta and e of these fish, m */
    struct range points;
};

struct flow {
    struct arena *arena;
    const struct school *school;
    const struct kernel *kernel;
    /* at the last sum, all circulation was shed infinitely long ago: legs reach from the tail to infinity */
    bool is_steady;
    const volatile sig_atomic_t *stop; /* once *stop is not 0, flow_gradient abandons its sums; or NULL */
    double t;                          /* time of the sources, s */
    unsigned long version, n_turns; /* of the wakes from which the sources were built: changes, of velocities alone */
    bool has_sources;               /* whether the sources have been placed */

    int n_classes;
    struct flow_class *classes; /*                                                      (n_classes) */
    int *class_of;              /* of each fish                                         (n_fish) */

    struct range *points; /* of each fish, class after class                   (n_fish) */
    int n_points;
    int n_chunks;
    struct chunk *chunk;     /* all points in chunks for the threads               (n_chunks) */
    double *x, *y, *u, *v;   /* position, m, and velocity of the fluid, m s-1     (n_points) */
    double *u_x, *u_y, *v_x; /* gradient, after flow_gradient, s-1                 (n_points) */
    /* div u and its gradient; a of the edge force and its gradient, one component after the other       (n_points) */
    double *div, *div_x, *div_y, *edge, *edge_gradient;
    double *image_u, *image_v, *image_div; /* velocity and div u of all images, after flow_images         (n_points) */
    double *legs[N_LEG_SUMS];              /* workspace: velocities of legs at control points (n_points) */

    struct flow_fish *fish; /* (n_fish) */
    int n_images;
    struct image *image; /* the images of every source in the walls                     (n_images) */

    /* at the markers or vortices of all wakes, after flow_at_wake: velocity and div u, those of images alone, those of
     * the legs of the same fish alone, and rates of the labels                                 (n_markers) */
    struct range *wake_range; /* of each fish                                                  (n_fish) */
    int n_markers, wake_capacity;
    double *wake_u, *wake_v, *wake_div, *wake_image_u, *wake_image_v, *wake_image_div;
    double *wake_leg_u, *wake_leg_v, *wake_leg_div, *wake_rate;
    bool is_in_pairs; /* wakes act on each other in pairs, because no sum at wakes goes through the tree */

    /* For sums over many fish by the tree: sources and targets of one sum. by_tree says, for bodies or wakes, for
     * themselves or their images, whether the sum of one class at another goes through the tree in this evaluation (2,
     * 2, n_classes, n_classes). */
    struct others *others; /* sums of distant sources of other fish: others.h; NULL before the first sum */
    struct tree *tree;
    struct sources many, places;
    int *by_tree;
};

/* How the velocity at the points of fish f depends on the unknowns of fish g. The columns are x (N_g), y (N_g), sheet
 * (M_g) and shed (1) of fish g. */
struct influence_block {
    int n_points, n_columns;
    double *u, *v; /* (n_columns, n_points) */
    double *div;   /* derivative of div u; NULL if not required (n_columns, n_points) */
    double *edge;  /* with varying depth: derivative of a; else NULL (2, n_columns, n_points) */
};

struct flow *flow_create(struct arena *arena, const struct school *school);

/* Fail with STATUS_CASE if a steady wake (in an equilibrium) would have to be longer than 1e5 depths to pass all
 * fish. */
enum status flow_check_steady(const struct school *school);

/* Number of points of a fish. */
int flow_n_points(const struct fish *fish);

/* Where the midpoint of an edge and the tail stand among the points of a fish. Control point c has index c. */
int flow_midpoint(const struct fish *fish, int edge);
int flow_tail(const struct fish *fish);

/* Place all sources and the points of all fish at time t (at or after the event of the state), for the unknowns y. */
void flow_place(struct flow *flow, const struct state *state, double t, const double *y);

/* Place only what has been released, that is the wakes, at time t. */
void flow_place_released(struct flow *flow, const struct state *state, double t);

/* Whether the wakes are free sheets (shedding: sheet). */
bool flow_has_free_sheets(const struct flow *flow);

/* The square of the smoothing of a source at a target, m2, where fish or classes have the given delta and e.
 * doc/model.md, section 8. For point vortices it depends on the source alone. */
enum flow_pair { BODY_AT_BODY, WAKE_AT_BODY, BODY_AT_WAKE, WAKE_AT_WAKE };
double flow_square(const struct flow *flow, enum flow_pair pair, const struct flow_class *target,
                   const struct flow_class *source);

/* The sources that a fish is for all other targets. They are either its body or its wake, at points or at markers, and
 * either the fish itself or its images. */
struct flow_sum {
    enum flow_pair pair;
    bool of_images;
};
const struct sources *flow_sources(const struct flow *flow, int g, const struct flow_sum *sum);

/* The constants of the kernel for these sources of fish g and targets of fish f. */
struct kernel_pair flow_pair_of(const struct flow *flow, int f, int g, const struct flow_sum *sum);

/* Append sources, with the span in their strengths, so that fish of different depths can be summed together. */
void flow_append_with_span(struct sources *many, const struct sources *sources, struct range which, double span);

/* Interpolate a quantity from the nodes of fish f to its points; of_points holds the values at the points of all fish
 * (n_points). */
void flow_from_nodes(const struct flow *flow, int f, const double *of_nodes, double *of_points);

#endif
