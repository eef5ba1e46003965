/* vortices.h: point vortices in groups of one smoothing each, and the induced velocity. doc/model.md, first
 * paragraph. Tested by tests/vortex/test_vortices.c. */
#ifndef VORTICES_H
#define VORTICES_H

#include "base/parallel.h"
#include "base/status.h"

struct vortex_group {
    struct range at;
    double smoothing; /* m */
};

/* Groups are contiguous; adjacent vortices of one smoothing are one group. */
struct vortices {
    int n, capacity;
    double *x, *y;       /* m, aligned to cache lines                              (n) */
    double *circulation; /* m2 s-1                                                 (n) */
    int n_groups, group_capacity;
    struct vortex_group *group; /* (n_groups) */
};

/* The smoothing of a pair of vortices or sheets: the root mean square of both smoothings, m. The pair smoothing is the
 * same in both directions, so the two velocities conserve the impulse of the pair. */
double vortices_pair_smoothing(double one, double other);

/* Targets of an induced velocity, and of the velocity gradient if u_x is not NULL; induced values are added. All arrays
 * (n). u_x = du/dx = -dv/dy, u_y = du/dy, v_x = dv/dx. */
struct induced {
    int n;
    const double *x, *y;     /* m */
    double *u, *v;           /* m s-1 */
    double *u_x, *u_y, *v_x; /* s-1 */
};

/* The vortices of group g inside a range; n <= 0: none. */
struct range vortices_of_group(const struct vortices *vortices, int g, struct range which);

/* Release the arrays of the vortices. All functions here accept a zeroed struct. */
void vortices_free(struct vortices *vortices);

/* Remove all vortices; the memory is kept. */
void vortices_clear(struct vortices *vortices);

/* Append n vortices without setting values. On STATUS_MEMORY nothing is changed. */
enum status vortices_append(struct vortices *vortices, int n, double smoothing);

/* Add the velocity of a range of vortices to the targets, group after group. */
void vortices_induce(const struct vortices *vortices, struct range which, const struct induced *at);

/* The same for all vortices; at the targets in range `where`, without the vortices in range left_out. */
void vortices_induce_without(const struct vortices *vortices, struct range left_out, struct range where,
                             const struct induced *at);

/* The vortices of *from with pair smoothings, for targets of another smoothing: group (from->n_groups) receives the
 * groups with the smoothing of each pair. The result owns nothing. */
struct vortices vortices_felt_by(const struct vortices *from, double smoothing, struct vortex_group *group);

/* A range of the targets. */
struct induced vortices_targets(const struct induced *all, struct range which);

/* Set the velocities and gradients of the targets to zero. */
void vortices_zero(const struct induced *at);

#endif
