/* vortices.c: groups of vortices onto targets. */
#include "vortex/vortices.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "vortex/kernel.h"

void vortices_free(struct vortices *vortices) {
    free(vortices->x);
    free(vortices->y);
    free(vortices->circulation);
    free(vortices->group);
    *vortices = (struct vortices){0};
}

void vortices_clear(struct vortices *vortices) {
    vortices->n = 0;
    vortices->n_groups = 0;
}

static enum status values_grow(double **values, int n, int capacity) {
    // whole cache lines
    enum { LINE = 64 };
    const size_t bytes = ((size_t)capacity * sizeof **values + LINE - 1) / LINE * LINE;
    double *const more = aligned_alloc(LINE, bytes);
    TRY(memory_check(more, "vortices"));
    if (n > 0) memcpy(more, *values, (size_t)n * sizeof *more);
    free(*values);
    *values = more;

    return STATUS_OK;
}

enum status vortices_append(struct vortices *vortices, int n, double smoothing) {
    const int all = vortices->n + n;
    if (all > vortices->capacity) {
        const int capacity = all + all / 2;
        TRY(values_grow(&vortices->x, vortices->n, capacity));
        TRY(values_grow(&vortices->y, vortices->n, capacity));
        TRY(values_grow(&vortices->circulation, vortices->n, capacity));
        vortices->capacity = capacity;
    }

    if (n == 0) return STATUS_OK;
    if (vortices->n_groups > 0 && vortices->group[vortices->n_groups - 1].smoothing == smoothing) {
        vortices->group[vortices->n_groups - 1].at.n += n;
    } else {
        if (vortices->n_groups == vortices->group_capacity) {
            const int capacity = 2 * vortices->group_capacity + 1;
            TRY(MEMORY_RESIZE(vortices->group, capacity, "groups of vortices"));
            vortices->group_capacity = capacity;
        }
        vortices->group[vortices->n_groups++] = (struct vortex_group){{vortices->n, n}, smoothing};
    }

    vortices->n = all;
    return STATUS_OK;
}

double vortices_pair_smoothing(double one, double other) {
    // equal smoothings are returned to the bit
    return fabs(one - other) > 0 ? sqrt((one * one + other * other) / 2) : one;
}

struct vortices vortices_felt_by(const struct vortices *from, double smoothing, struct vortex_group *group) {
    struct vortices felt = *from;
    for (int g = 0; g < from->n_groups; g++) {
        group[g] = from->group[g];
        group[g].smoothing = vortices_pair_smoothing(from->group[g].smoothing, smoothing);
    }

    felt.group = group;
    return felt;
}

struct induced vortices_targets(const struct induced *all, struct range which) {
    const int i = which.first;
    struct induced part = {which.n, all->x + i, all->y + i, all->u + i, all->v + i, NULL, NULL, NULL};
    if (all->u_x) {
        part.u_x = all->u_x + i;
        part.u_y = all->u_y + i;
        part.v_x = all->v_x + i;
    }

    return part;
}

struct range vortices_of_group(const struct vortices *vortices, int g, struct range which) {
    const struct range group = vortices->group[g].at;
    const int group_end = group.first + group.n, which_end = which.first + which.n;
    const int first = group.first > which.first ? group.first : which.first;
    return (struct range){first, (group_end < which_end ? group_end : which_end) - first};
}

void vortices_induce(const struct vortices *vortices, struct range which, const struct induced *at) {
    for (int g = 0; g < vortices->n_groups; g++) {
        const struct range of = vortices_of_group(vortices, g, which);
        if (of.n <= 0) continue;
        const double *const x = vortices->x + of.first, *const y = vortices->y + of.first;
        const double *const circulation = vortices->circulation + of.first, smoothing = vortices->group[g].smoothing;

        if (at->u_x) {
            kernel_add_gradient(at->n, at->x, at->y, of.n, x, y, circulation, smoothing, at->u, at->v, at->u_x, at->u_y,
                                at->v_x);
        } else {
            kernel_add_velocity(at->n, at->x, at->y, of.n, x, y, circulation, smoothing, at->u, at->v);
        }
    }
}

void vortices_induce_without(const struct vortices *vortices, struct range left_out, struct range where,
                             const struct induced *at) {
    const struct range all = {0, vortices->n};
    const int first = where.first > 0 ? where.first : 0, where_end = where.first + where.n;
    const int end = where_end < at->n ? where_end : at->n;

    if (first >= end || left_out.n == 0) {
        vortices_induce(vortices, all, at);
        return;
    }

    const struct induced before = vortices_targets(at, (struct range){0, first});
    const struct induced there = vortices_targets(at, (struct range){first, end - first});
    const struct induced behind = vortices_targets(at, (struct range){end, at->n - end});
    const int rest = left_out.first + left_out.n;
    vortices_induce(vortices, all, &before);
    vortices_induce(vortices, (struct range){0, left_out.first}, &there);
    vortices_induce(vortices, (struct range){rest, vortices->n - rest}, &there);
    vortices_induce(vortices, all, &behind);
}

void vortices_zero(const struct induced *at) {
    double *const values[] = {at->u, at->v, at->u_x, at->u_y, at->v_x};
    for (size_t k = 0; k < sizeof values / sizeof *values; k++) {
        if (values[k]) memset(values[k], 0, (size_t)at->n * sizeof *values[k]);
    }
}
