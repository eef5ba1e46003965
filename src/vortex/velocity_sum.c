/* velocity_sum.c: one set of a tree per smoothing. */
#include "vortex/velocity_sum.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "vortex/kernel.h"
#include "vortex/tolerance.h"
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
                                                                      smoothing, tolerance / TOLERANCE_SUM, threads));
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

// ---- vortices sorted into tiles, pairs of tiles distributed to shares

enum {
    ALIGNMENT = 64,  /* bytes: the widest vector, and a cache line */
    BLOCK = 16,      /* vortices; the size of a tile is a multiple (kernel.h) */
    MIN_SHARES = 16, /* threads beyond the number of shares are idle; each share costs a sum over all vortices */
    MAX_SHARES = 64
};

/* The sorted vortices first .. first + n - 1. */
struct tile {
    int first, n;
    double smoothing;
};

struct sorted {
    int n_vortices, n_sorted; /* without and with the padding vortices of circulation 0 */
    int n_tiles, n_shares;
    int *index;                  /* of each vortex among the sorted ones                (n_vortices) */
    struct tile *tile;           /*                                                     (n_tiles) */
    double *x, *y, *circulation; /*                                                     (n_sorted) */
    double *u, *v;               /* the sum of each share at the tiles of the share      (n_shares, n_sorted) */
    unsigned char *has;          /* whether a share has a tile                          (n_shares, n_tiles) */
    void *memory;                /* holds x to v */
};

static long n_pairs(int n_tiles) {
    return (long)n_tiles * (n_tiles + 1) / 2;
}

static int n_shares(int n_tiles) {
    const int n = n_tiles < MIN_SHARES ? MIN_SHARES : n_tiles > MAX_SHARES ? MAX_SHARES : n_tiles;
    return n_pairs(n_tiles) < n ? (int)n_pairs(n_tiles) : n;
}

static int round_up_to_block(int n) {
    return (n + BLOCK - 1) / BLOCK * BLOCK;
}

// set the index of every vortex, and the tiles: groups of one smoothing are consecutive
static void tiles_sort(struct sorted *sorted, int n_groups, const struct vortex_group *group) {
    for (int k = 0; k < n_groups; k++) {
        int first_of_smoothing = 0;
        while (group[first_of_smoothing].smoothing != group[k].smoothing) first_of_smoothing++;
        if (first_of_smoothing < k) continue;
        int n = sorted->n_sorted, vortex = 0;

        for (int l = 0; l < n_groups; l++) {
            const int same = group[l].smoothing == group[k].smoothing;
            for (int i = 0; same && i < group[l].at.n; i++) sorted->index[vortex + i] = n++;
            vortex += group[l].at.n;
        }

        const int end = sorted->n_sorted + round_up_to_block(n - sorted->n_sorted);
        for (int first = sorted->n_sorted; first < end; first += KERNEL_TILE) {
            const int rest = end - first;
            sorted->tile[sorted->n_tiles++] =
                (struct tile){first, rest < KERNEL_TILE ? rest : KERNEL_TILE, group[k].smoothing};
        }

        sorted->n_sorted = end;
    }
}

static enum status sorted_fill(struct sorted *sorted, const struct vortices *vortices) {
    const int n = sorted->n_vortices = vortices->n;
    sorted->index = malloc((size_t)(n + 1) * sizeof *sorted->index);
    sorted->tile = malloc((size_t)(n / KERNEL_TILE + vortices->n_groups + 1) * sizeof *sorted->tile);
    if (!sorted->index || !sorted->tile) return memory_check(NULL, "pairwise velocities");
    tiles_sort(sorted, vortices->n_groups, vortices->group);
    sorted->n_shares = n_shares(sorted->n_tiles);
    // the array length is a multiple of BLOCK, so every array is aligned
    const size_t n_sorted = (size_t)sorted->n_sorted, n_sums = n_sorted * (size_t)sorted->n_shares;
    sorted->memory = malloc((3 * n_sorted + 2 * n_sums) * sizeof(double) + ALIGNMENT);
    sorted->has = calloc((size_t)sorted->n_shares * (size_t)sorted->n_tiles + 1, sizeof *sorted->has);
    if (!sorted->memory || !sorted->has) return memory_check(NULL, "pairwise velocities");
    double *const aligned = (double *)(((uintptr_t)sorted->memory + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT);
    sorted->x = aligned;
    sorted->y = aligned + n_sorted;
    sorted->circulation = aligned + 2 * n_sorted;
    sorted->u = aligned + 3 * n_sorted;
    sorted->v = sorted->u + n_sums;
    memset(aligned, 0, 3 * n_sorted * sizeof *aligned);
    for (int i = 0; i < n; i++) {
        sorted->x[sorted->index[i]] = vortices->x[i];
        sorted->y[sorted->index[i]] = vortices->y[i];
        sorted->circulation[sorted->index[i]] = vortices->circulation[i];
    }
    return STATUS_OK;
}

// add the mutually induced velocities of tiles a and b to the sum of a share
static void tile_pair_add(const struct sorted *sorted, enum pairwise_smoothing smoothing, const struct tile *a,
                          const struct tile *b, double *u, double *v) {
    const double *const x = sorted->x, *const y = sorted->y, *const g = sorted->circulation;
    const int i = a->first, j = b->first;
    if (a != b && (a->smoothing == b->smoothing || smoothing == PAIRWISE_OF_PAIR)) {
        const struct kernel_tile at_a = {a->n, x + i, y + i, g + i, u + i, v + i};
        const struct kernel_tile at_b = {b->n, x + j, y + j, g + j, u + j, v + j};
        kernel_add_pairwise(&at_a, &at_b, vortices_pair_smoothing(a->smoothing, b->smoothing));
        return;
    }

    kernel_add_velocity(a->n, x + i, y + i, b->n, x + j, y + j, g + j, b->smoothing, u + i, v + i);
    if (a == b) return;
    kernel_add_velocity(b->n, x + j, y + j, a->n, x + i, y + i, g + i, a->smoothing, u + j, v + j);
}

// zero the sums of a share at the first use of a tile
static void tile_begin(const struct sorted *sorted, int share, int tile, double *u, double *v) {
    unsigned char *const has = &sorted->has[(size_t)share * (size_t)sorted->n_tiles + (size_t)tile];
    if (*has) return;
    *has = 1;
    memset(u + sorted->tile[tile].first, 0, (size_t)sorted->tile[tile].n * sizeof *u);
    memset(v + sorted->tile[tile].first, 0, (size_t)sorted->tile[tile].n * sizeof *v);
}

static void share_sum(const struct sorted *sorted, enum pairwise_smoothing smoothing, int share) {
    const int n_tiles = sorted->n_tiles;
    const long begin = n_pairs(n_tiles) * share / sorted->n_shares;
    const long end = n_pairs(n_tiles) * (share + 1) / sorted->n_shares;
    double *const u = sorted->u + (size_t)share * (size_t)sorted->n_sorted;
    double *const v = sorted->v + (size_t)share * (size_t)sorted->n_sorted;
    long pair = 0;

    for (int a = 0; a < n_tiles; a++) {
        for (int b = a; b < n_tiles; b++, pair++) {
            if (pair < begin || pair >= end) continue;
            tile_begin(sorted, share, a, u, v);
            tile_begin(sorted, share, b, u, v);
            tile_pair_add(sorted, smoothing, &sorted->tile[a], &sorted->tile[b], u, v);
        }
    }
}

// add the sums of all shares at one tile, in order, to the sums of the first share
static void tile_add_shares(const struct sorted *sorted, int tile) {
    const size_t n_sorted = (size_t)sorted->n_sorted, n_tiles = (size_t)sorted->n_tiles;
    double *const u = sorted->u + sorted->tile[tile].first, *const v = sorted->v + sorted->tile[tile].first;
    tile_begin(sorted, 0, tile, sorted->u, sorted->v);

    for (size_t share = 1; share < (size_t)sorted->n_shares; share++) {
        if (!sorted->has[share * n_tiles + (size_t)tile]) continue;
        for (size_t i = 0; i < (size_t)sorted->tile[tile].n; i++) {
            u[i] += u[share * n_sorted + i];
            v[i] += v[share * n_sorted + i];
        }
    }
}

enum status velocity_sum_pairwise(const struct vortices *vortices, enum pairwise_smoothing smoothing, int threads,
                                  double *u, double *v) {
    struct sorted sorted = {0};
    const enum status status = sorted_fill(&sorted, vortices);
    if (status == STATUS_OK) {
#pragma omp parallel num_threads(threads)
        {
#pragma omp for schedule(dynamic)
            for (int share = 0; share < sorted.n_shares; share++) share_sum(&sorted, smoothing, share);

#pragma omp for nowait
            for (int tile = 0; tile < sorted.n_tiles; tile++) tile_add_shares(&sorted, tile);
        }
        for (int i = 0; i < sorted.n_vortices; i++) {
            u[i] += sorted.u[sorted.index[i]];
            v[i] += sorted.v[sorted.index[i]];
        }
    }

    free(sorted.index);
    free(sorted.tile);
    free(sorted.has);
    free(sorted.memory);

    return status;
}
