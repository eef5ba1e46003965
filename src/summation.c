/* summation.c: one tree after another for the vortices of each smoothing. */
#include "summation.h"

#include <stdlib.h>
#include <string.h>

#include "tree.h"

/* Where the tree is faster than direct sums: at least so many vortices, and so many interactions. Measured by
 * `make bench`; the ways differ little near these numbers. */
static const int fewest_vortices = 1000;
static const double fewest_interactions = 6e6;

struct summation {
    struct tree *tree;
    struct vortices gathered; /* those of one smoothing */
};

enum status summation_create(struct summation **summation) {
    *summation = NULL;
    struct summation *const new = calloc(1, sizeof *new);
    if (!new) return status_fail(STATUS_MEMORY, "no room for a sum");
    const enum status status = tree_create(&new->tree);
    if (status != STATUS_OK) {
        summation_free(new);
        return status;
    }
    *summation = new;
    return STATUS_OK;
}

void summation_free(struct summation *summation) {
    if (!summation) return;
    tree_free(summation->tree);
    vortices_free(&summation->gathered);
    free(summation);
}

int summation_by_tree(const struct vortices *vortices, int n_targets, double tolerance) {
    return tolerance > 0 && vortices->n >= fewest_vortices && (double)vortices->n * n_targets >= fewest_interactions;
}

// whether an earlier group has the smoothing of group k
static int is_done(const struct vortices *vortices, int k) {
    int first = 0;
    while (vortices->group[first].smoothing != vortices->group[k].smoothing) first++;
    return first < k;
}

// all vortices with the smoothing of group k
static enum status gather(struct summation *summation, const struct vortices *vortices, int k) {
    struct vortices *const all = &summation->gathered;
    vortices_clear(all);
    for (int g = k; g < vortices->n_groups; g++) {
        const struct vortex_group *const group = &vortices->group[g];
        if (group->smoothing != vortices->group[k].smoothing) continue;
        const int n = all->n;
        const size_t size = (size_t)group->at.n * sizeof(double);
        TRY(vortices_append(all, group->at.n, group->smoothing));
        memcpy(all->x + n, vortices->x + group->at.first, size);
        memcpy(all->y + n, vortices->y + group->at.first, size);
        memcpy(all->circulation + n, vortices->circulation + group->at.first, size);
    }
    return STATUS_OK;
}

enum status summation_induce(struct summation *summation, const struct vortices *vortices, double tolerance,
                             int threads, const struct induced *at) {
    for (int k = 0; k < vortices->n_groups; k++) {
        if (is_done(vortices, k)) continue;
        TRY(gather(summation, vortices, k));
        const struct vortices *const all = &summation->gathered;
        TRY(tree_build(summation->tree, all->n, all->x, all->y, all->circulation, vortices->group[k].smoothing,
                       tolerance / 10));
        if (at->u_x) {
            TRY(tree_add_gradient(summation->tree, at->n, at->x, at->y, threads, at->u, at->v, at->u_x, at->u_y,
                                  at->v_x));
        } else {
            TRY(tree_add_velocity(summation->tree, at->n, at->x, at->y, threads, at->u, at->v));
        }
    }
    return STATUS_OK;
}
