/* velocity_sum.c: one set of a tree per smoothing. */
#include "vortex/velocity_sum.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "vortex/treecode.h"

/* The tree is faster than the direct sum above these numbers of vortices and interactions. Measured by `make bench`;
 * near these numbers the difference is small. */
static const int min_vortices = 1000;
static const double min_interactions = 6e6;

struct velocity_sum {
    struct treecode *tree, *planned;
    struct vortices alike; /* vortices of one smoothing */
    struct far_images *far_images;
};

enum status velocity_sum_create(struct velocity_sum **sum) {
    *sum = NULL;
    struct velocity_sum *new;
    TRY(MEMORY_NEW(new, 1, "a velocity sum"));
    enum status status = treecode_create(&new->tree);
    if (status == STATUS_OK) status = treecode_create(&new->planned);
    if (status == STATUS_OK) status = far_images_create(&new->far_images);

    if (status != STATUS_OK) {
        velocity_sum_free(new);
        return status;
    }

    *sum = new;
    return STATUS_OK;
}

void velocity_sum_free(struct velocity_sum *sum) {
    if (!sum) return;
    treecode_free(sum->tree);
    treecode_free(sum->planned);
    far_images_free(sum->far_images);
    vortices_free(&sum->alike);
    free(sum);
}

struct far_images *velocity_sum_far_images(struct velocity_sum *sum) {
    return sum->far_images;
}

int velocity_sum_by_tree(const struct vortices *vortices, int n_targets, double tolerance) {
    return tolerance > 0 && vortices->n >= min_vortices && (double)vortices->n * n_targets >= min_interactions;
}

// whether an earlier group has the smoothing of group k
static int smoothing_is_done(const struct vortices *vortices, int k) {
    int first = 0;
    while (vortices->group[first].smoothing != vortices->group[k].smoothing) first++;
    return first < k;
}

// select all vortices with the smoothing of group k
static enum status alike_select(struct velocity_sum *sum, const struct vortices *vortices, int k) {
    struct vortices *const all = &sum->alike;
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

// add the vortices to a tree, one set for each smoothing
static enum status tree_build(struct velocity_sum *sum, struct treecode *tree, const struct vortices *vortices,
                              double tolerance, int threads, int *n_sets) {
    for (int k = 0; k < vortices->n_groups; k++) {
        if (smoothing_is_done(vortices, k)) continue;
        TRY(alike_select(sum, vortices, k));
        const struct vortices *const all = &sum->alike;
        const double smoothing = vortices->group[k].smoothing;
        TRY(((*n_sets)++ == 0 ? treecode_build : treecode_build_more)(tree, all->n, all->x, all->y, all->circulation,
                                                                      smoothing, tolerance / 10, threads));
    }

    return STATUS_OK;
}

enum status velocity_sum_induce_all(struct velocity_sum *sum, int n, const struct vortices *const *vortices,
                                    double tolerance, int threads, const struct induced *at) {
    int n_sets = 0;
    for (int i = 0; i < n; i++) TRY(tree_build(sum, sum->tree, vortices[i], tolerance, threads, &n_sets));
    if (n_sets == 0) return STATUS_OK;
    if (!at->u_x) return treecode_add_velocity(sum->tree, at->n, at->x, at->y, threads, at->u, at->v);
    return treecode_add_gradient(sum->tree, at->n, at->x, at->y, threads, at->u, at->v, at->u_x, at->u_y, at->v_x);
}

enum status velocity_sum_induce(struct velocity_sum *sum, const struct vortices *vortices, double tolerance,
                                int threads, const struct induced *at) {
    return velocity_sum_induce_all(sum, 1, &vortices, tolerance, threads, at);
}

enum status velocity_sum_plan(struct velocity_sum *sum, const struct vortices *vortices, double tolerance, int threads,
                              const struct induced *at) {
    int n_sets = 0;
    TRY(tree_build(sum, sum->planned, vortices, tolerance, threads, &n_sets));
    return treecode_plan(sum->planned, at->n, at->x, at->y, at->u_x != NULL, threads);
}

enum status velocity_sum_by_plan(struct velocity_sum *sum, const struct vortices *vortices, double tolerance,
                                 int threads, const struct induced *at) {
    const struct vortices *const all = &sum->alike;
    int set = 0;
    for (int k = 0; k < vortices->n_groups; k++) {
        if (smoothing_is_done(vortices, k)) continue;
        TRY(alike_select(sum, vortices, k));
        treecode_move_vortices(sum->planned, set++, all->x, all->y, all->circulation, threads);
    }

    treecode_move_targets(sum->planned, at->x, at->y, threads);
    if (!treecode_fits(sum->planned, threads)) return velocity_sum_induce(sum, vortices, tolerance, threads, at);
    treecode_add_planned(sum->planned, threads, at->u, at->v, at->u_x, at->u_y, at->v_x);

    return STATUS_OK;
}
