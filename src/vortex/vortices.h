/* vortices.h: point vortices in groups of one smoothing each, and the velocity that they induce. doc/model.md, first
 * paragraph. Tested by tests/vortex/test_vortices.c. */
#ifndef VORTICES_H
#define VORTICES_H

#include "base/parallel.h"
#include "base/status.h"

struct vortex_group {
    struct range at;
    double smoothing; /* m */
};

/* Groups follow one another without a gap; neighbours of one smoothing are one group. */
struct vortices {
    int n, capacity;
    double *x, *y;       /* m, aligned to cache lines                              (n) */
    double *circulation; /* m2 s-1                                                 (n) */
    int n_groups, group_capacity;
    struct vortex_group *group; /* (n_groups) */
};

/* The smoothing of a pair of vortices, or sheets, with a smoothing each: the root of the mean of the squares, m. It is
 * the same in both directions, so that the two velocities conserve the impulse of the pair. */
double vortices_pair_smoothing(double one, double other);

/* Points at which a velocity, and its gradient where u_x is not NULL, are induced and added; all arrays (n).
 * u_x = du/dx = -dv/dy, u_y = du/dy, v_x = dv/dx. */
struct induced {
    int n;
    const double *x, *y;     /* m */
    double *u, *v;           /* m s-1 */
    double *u_x, *u_y, *v_x; /* s-1 */
};

/* Those of group g that are in a range; n <= 0: none. */
struct range vortices_of_group(const struct vortices *vortices, int g, struct range which);

/* Release what the vortices own. Accepts a zeroed struct, as all functions here do. */
void vortices_free(struct vortices *vortices);

/* Remove all vortices; the memory is kept. */
void vortices_clear(struct vortices *vortices);

/* Append n vortices whose values are not set. Fails with STATUS_MEMORY; nothing is changed then. */
enum status vortices_append(struct vortices *vortices, int n, double smoothing);

/* Add what the vortices of a range induce at the targets, group after group. */
void vortices_induce(const struct vortices *vortices, struct range which, const struct induced *at);

/* The same of all vortices but, at the targets in a range, those left out. */
void vortices_induce_without(const struct vortices *vortices, struct range left_out, struct range where,
                             const struct induced *at);

/* The same vortices as vortices of another smoothing feel them: *from with these groups, one for each of its groups, in
 * which every smoothing is that of the pair. It owns nothing. */
struct vortices vortices_felt_by(const struct vortices *from, double smoothing, struct vortex_group *group);

/* A range of the targets. */
struct induced vortices_targets(const struct induced *all, struct range which);

/* Set the velocities and gradients of the targets to zero. */
void vortices_zero(const struct induced *at);

#endif
