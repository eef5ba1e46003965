/* pairwise.c: the vortices sorted into tiles, the pairs of tiles shared out. */
#include "vortex/pairwise.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "vortex/kernel.h"

enum {
    ALIGNMENT = 64,     /* bytes: the widest vector, and a line of the cache */
    BLOCK = 16,         /* a tile is a multiple of so many vortices (kernel.h) */
    FEWEST_SHARES = 16, /* no more threads than shares find work, but each share costs a sum over all vortices */
    MOST_SHARES = 64
};

/* Places first .. first + n - 1 of the sorted vortices. */
struct tile {
    int first, n;
    double smoothing;
};

struct sorted {
    int n_vortices, n_places; /* those of all groups; with those of strength 0 that fill up tiles */
    int n_tiles, n_shares;
    int *place;                  /* of each vortex                                      (n_vortices) */
    struct tile *tile;           /*                                                     (n_tiles) */
    double *x, *y, *circulation; /*                                                     (n_places) */
    double *u, *v;               /* what each share has summed                          (n_shares, n_places) */
    void *memory;                /* holds the last five */
};

static long n_pairs(int n_tiles) {
    return (long)n_tiles * (n_tiles + 1) / 2;
}

static int n_shares(int n_tiles) {
    const int n = n_tiles < FEWEST_SHARES ? FEWEST_SHARES : n_tiles > MOST_SHARES ? MOST_SHARES : n_tiles;
    return n_pairs(n_tiles) < n ? (int)n_pairs(n_tiles) : n;
}

static int rounded_up(int n) {
    return (n + BLOCK - 1) / BLOCK * BLOCK;
}

// the place of every vortex, and the tiles: groups of one smoothing next to each other
static void sort(struct sorted *sorted, int n_groups, const struct vortex_group *group) {
    for (int k = 0; k < n_groups; k++) {
        int first_of_smoothing = 0;
        while (group[first_of_smoothing].smoothing != group[k].smoothing) first_of_smoothing++;
        if (first_of_smoothing < k) continue;
        int n = sorted->n_places, vortex = 0;
        for (int l = 0; l < n_groups; l++) {
            const int same = group[l].smoothing == group[k].smoothing;
            for (int i = 0; same && i < group[l].at.n; i++) sorted->place[vortex + i] = n++;
            vortex += group[l].at.n;
        }
        const int end = sorted->n_places + rounded_up(n - sorted->n_places);
        for (int first = sorted->n_places; first < end; first += KERNEL_TILE) {
            const int rest = end - first;
            sorted->tile[sorted->n_tiles++] =
                (struct tile){first, rest < KERNEL_TILE ? rest : KERNEL_TILE, group[k].smoothing};
        }
        sorted->n_places = end;
    }
}

static void sorted_free(struct sorted *sorted) {
    free(sorted->place);
    free(sorted->tile);
    free(sorted->memory);
}

static enum status sorted_fill(struct sorted *sorted, const struct vortices *vortices) {
    const int n = sorted->n_vortices = vortices->n;
    sorted->place = malloc((size_t)(n + 1) * sizeof *sorted->place);
    sorted->tile = malloc((size_t)(n / KERNEL_TILE + vortices->n_groups + 1) * sizeof *sorted->tile);
    if (!sorted->place || !sorted->tile) goto no_memory;
    sort(sorted, vortices->n_groups, vortices->group);
    sorted->n_shares = n_shares(sorted->n_tiles);
    // places are a multiple of BLOCK: where one array is aligned, the next is
    const size_t n_places = (size_t)sorted->n_places, n_sums = n_places * (size_t)sorted->n_shares;
    sorted->memory = malloc((3 * n_places + 2 * n_sums) * sizeof(double) + ALIGNMENT);
    if (!sorted->memory) goto no_memory;
    double *const aligned = (double *)(((uintptr_t)sorted->memory + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT);
    sorted->x = aligned;
    sorted->y = aligned + n_places;
    sorted->circulation = aligned + 2 * n_places;
    sorted->u = aligned + 3 * n_places;
    sorted->v = sorted->u + n_sums;
    memset(aligned, 0, 3 * n_places * sizeof *aligned);
    for (int i = 0; i < n; i++) {
        sorted->x[sorted->place[i]] = vortices->x[i];
        sorted->y[sorted->place[i]] = vortices->y[i];
        sorted->circulation[sorted->place[i]] = vortices->circulation[i];
    }
    return STATUS_OK;

no_memory:
    return status_fail(STATUS_MEMORY, "out of memory: the velocities of %d vortices at one another", n);
}

// the velocities of the vortices of tiles a and b at each other, to those of a share
static void feel(const struct sorted *sorted, const struct tile *a, const struct tile *b, double *u, double *v) {
    const double *const x = sorted->x, *const y = sorted->y, *const g = sorted->circulation;
    const int i = a->first, j = b->first;
    if (a != b && a->smoothing == b->smoothing) {
        const struct kernel_tile at_a = {a->n, x + i, y + i, g + i, u + i, v + i};
        const struct kernel_tile at_b = {b->n, x + j, y + j, g + j, u + j, v + j};
        kernel_add_pairwise(&at_a, &at_b, a->smoothing);
        return;
    }
    kernel_add_velocity(a->n, x + i, y + i, b->n, x + j, y + j, g + j, b->smoothing, u + i, v + i);
    if (a == b) return;
    kernel_add_velocity(b->n, x + j, y + j, a->n, x + i, y + i, g + i, a->smoothing, u + j, v + j);
}

static void sum_share(const struct sorted *sorted, int share) {
    const int n_tiles = sorted->n_tiles;
    const long begin = n_pairs(n_tiles) * share / sorted->n_shares;
    const long end = n_pairs(n_tiles) * (share + 1) / sorted->n_shares;
    double *const u = sorted->u + (size_t)share * (size_t)sorted->n_places;
    double *const v = sorted->v + (size_t)share * (size_t)sorted->n_places;
    memset(u, 0, (size_t)sorted->n_places * sizeof *u);
    memset(v, 0, (size_t)sorted->n_places * sizeof *v);
    long pair = 0;
    for (int a = 0; a < n_tiles; a++) {
        for (int b = a; b < n_tiles; b++, pair++) {
            if (pair >= begin && pair < end) feel(sorted, &sorted->tile[a], &sorted->tile[b], u, v);
        }
    }
}

// the sums of all shares at one tile, into the first
static void gather(const struct sorted *sorted, const struct tile *tile) {
    double *const u = sorted->u + tile->first, *const v = sorted->v + tile->first;
    for (int share = 1; share < sorted->n_shares; share++) {
        const size_t behind = (size_t)share * (size_t)sorted->n_places;
        for (int i = 0; i < tile->n; i++) {
            u[i] += u[behind + (size_t)i];
            v[i] += v[behind + (size_t)i];
        }
    }
}

enum status pairwise_add_velocity(const struct vortices *vortices, int threads, double *u, double *v) {
    struct sorted sorted = {0};
    const enum status status = sorted_fill(&sorted, vortices);
    if (status == STATUS_OK) {
#pragma omp parallel num_threads(threads)
        {
#pragma omp for schedule(dynamic)
            for (int share = 0; share < sorted.n_shares; share++) sum_share(&sorted, share);
#pragma omp for nowait
            for (int tile = 0; tile < sorted.n_tiles; tile++) gather(&sorted, &sorted.tile[tile]);
        }
        for (int i = 0; i < sorted.n_vortices; i++) {
            u[i] += sorted.u[sorted.place[i]];
            v[i] += sorted.v[sorted.place[i]];
        }
    }
    sorted_free(&sorted);
    return status;
}
