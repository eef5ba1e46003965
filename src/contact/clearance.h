/* clearance.h: remembers how close any two bodies of a school have come so far, at and between the steps of the
 * integrator, because a run in which bodies touch or pass through each other is no valid solution. Tested by
 * tests/contact/test_clearance.c. */
#ifndef CLEARANCE_H
#define CLEARANCE_H

#include "base/arena.h"
#include "base/mathematics.h"
#include "fish/fish.h"
#include "state/state.h"

/* Overlapping pairs of boxes: boxes in a list sorted by x are compared in y if the x ranges overlap.
 * Boxes widened by half a distance find all bodies closer than this distance. */

struct neighbours {
    struct arena *arena;
    int n;
    struct box *box; /* set by the caller                                                        (n) */
    int *order;      /* boxes sorted by low x, from the last call                                    (n) */

    /* Each overlap is listed for both boxes: the boxes that overlap box i are other[first[i]] .. other[first[i + 1] -
     * 1], in ascending order. */
    int *first; /* (n + 1) */
    int *other; /* (first[n]) */
    int capacity;
    int *pair;   /* scratch: pairs in sweep order                                            (capacity) */
    int *filled; /* scratch: number of overlaps of each box entered so far; then free               (n) */
};

/* A list of n boxes. */
struct neighbours *neighbours_create(struct arena *arena, int n);

/* Find all overlaps of the present boxes. The cost is proportional to the overlaps in x, plus the changes of order
 * since the last call. */
void neighbours_find(struct neighbours *neighbours);

/* The box of a body on straight node paths from the positions in before to the positions in y, widened by half the
 * thickness and half a distance, m: bodies with disjoint boxes stay further apart than this distance. */
struct box clearance_box(const struct fish *fish, double distance, const double *before, const double *y);

/* Start the record with the present bodies. neighbours: workspace (n_fish); between: scratch (n_unknowns). */
void clearance_start(const struct school *school, struct state *state, struct neighbours *neighbours, double *between);

/* Whether the distance of two bodies may be below a limit, m, at the end, or 0 on the way. */
bool clearance_may_be_near(const struct fish *a, const struct fish *b, const double *before, const double *y,
                           double limit);

/* The passage of two bodies with straight node paths. */
struct passage {
    double now;   /* distance at the end, m; INFINITY: above the limit */
    double least; /* smallest distance found on the way, m; 0: contact */
    double part;  /* fraction of the way before contact; 1: no contact */
};

/* The passage from the positions in before to the positions in y. Distances above the limit, m, may be INFINITY;
 * contact is found for any limit. between: scratch (n_unknowns). */
struct passage clearance_passage(const struct fish *a, const struct fish *b, const double *before, const double *y,
                                 double limit, double *between);

/* Update state->closest after a step of the integrator to time t, s, and the unknowns y. Node paths within a step are
 * straight: a collision within the step is found for any distance at both ends. Workspace as above. */
void clearance_step(const struct school *school, struct state *state, double t, const double *y,
                    struct neighbours *neighbours, double *between);

/* Test for a body that crosses itself, which is unphysical. A body does not repel itself
 * (doc/model.md, section 16), so a limp body may cross itself.
 *
 *     crossed line          crossed outline        folded: the radius of a bend is less than half the thickness
 *        ___                   .-----.
 *       /   \                 ( (===. )                 _
 *       \___/____              '-'===================  | |\
 *           \                                          | '-`====
 */

/* Whether the centre line or the outline of a fish crosses itself. The outline follows both sides of the nodes at half
 * the thickness and ends in a point at nose and tail. The cost is linear in n_nodes unless the body turns by more than
 * half a turn. scratch: (4 n_nodes). */
bool self_crossing(const struct fish *fish, const double *y, double *scratch);

/* Record the first crossing of any body in the state: has_crossed, crossed and crossed_t. scratch: (n_unknowns). */
void self_crossing_remember(const struct school *school, struct state *state, double *scratch);

#endif
