/* linear.c: factors for the diagonal blocks, GMRES for the couplings. */
#include "solver/linear.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "solver/fish_factors.h"

/* The relative tolerance of GMRES where bodies touch: the forces between two bodies cancel only as far as the system is
 * solved, and what is left changes the momentum of both together. */
static const double contact_relative = 1e-9;

/* GMRES takes at most this many iterations; Newton's iteration judges what it returns then. */
enum { MAX_ITERATIONS = 40 };

/* The diagonal block of one fish. */
struct block {
    struct fish_factors *factors;
    /* the change of one column since then: */
    int is_updated;
    double *update; /* D^-1 times the change over 1 plus its element of that column's unknown  (unknowns of the fish) */
    enum status status; /* of the last set-up */
};

struct linear {
    const struct jacobian *jacobian;
    struct linear_tolerance tolerance;
    double *weight; /* 1/(n_unknowns scale^2)                          (n_unknowns) */
    struct block *block;
    double *direction; /* the Krylov basis, orthonormal    (n_directions, n_unknowns) */
    int n_directions;  /* allocated */
    long solves, iterations;
};

static int n_unknowns(const struct linear *linear) {
    return linear->jacobian->school->n_unknowns;
}

enum status linear_create(struct linear **linear, const struct jacobian *jacobian, const double *scale,
                          struct linear_tolerance tolerance) {
    *linear = NULL;
    struct linear *const new = calloc(1, sizeof *new);
    if (!new) goto no_memory;
    new->jacobian = jacobian;
    new->tolerance = tolerance;
    new->weight = calloc((size_t)n_unknowns(new), sizeof *new->weight);
    new->block = calloc((size_t)jacobian->school->n_fish, sizeof *new->block);
    if (!new->weight || !new->block) goto no_memory;
    for (int i = 0; i < n_unknowns(new); i++) new->weight[i] = 1 / (n_unknowns(new) * scale[i] * scale[i]);
    for (int f = 0; f < jacobian->school->n_fish; f++) {
        const enum status status =
            fish_factors_create(&new->block[f].factors, &jacobian->school->fish[f], jacobian->own[f]);
        if (status != STATUS_OK) goto no_memory;
        new->block[f].update = calloc((size_t)jacobian->own[f]->n, sizeof(double));
        if (!new->block[f].update) goto no_memory;
    }
    *linear = new;
    return STATUS_OK;

no_memory:
    linear_free(new);
    return status_fail(STATUS_MEMORY, "out of memory: linear systems of %d unknowns", jacobian->school->n_unknowns);
}

void linear_free(struct linear *linear) {
    if (!linear) return;
    for (int f = 0; linear->block && f < linear->jacobian->school->n_fish; f++) {
        struct block *const block = &linear->block[f];
        fish_factors_free(block->factors);
        free(block->update);
    }
    free(linear->block);
    free(linear->weight);
    free(linear->direction);
    free(linear);
}

enum status linear_setup(struct linear *linear) {
    const struct jacobian *jacobian = linear->jacobian;
    const struct school *school = jacobian->school;
    const int threads = parallel_threads(school->threads, school->n_fish, school->n_unknowns, PARALLEL_MATRICES);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < school->n_fish; f++) {
        linear->block[f].is_updated = 0;
        linear->block[f].status = fish_factors_set_up(linear->block[f].factors);
    }
    for (int f = 0; f < school->n_fish; f++) {
        const enum status status = linear->block[f].status;
        if (status == STATUS_MEMORY) return status_fail(status, "out of memory: factorising the Jacobian");
        if (status != STATUS_OK)
            return status_fail(status, "the Jacobian of fish %s is singular", school->fish[f].name);
    }
    return STATUS_OK;
}

// x becomes D^-1 x for one fish; x begins with its first unknown
static void solve_block(const struct linear *linear, int f, double *x) {
    const struct layout *at = &linear->jacobian->school->fish[f].at;
    struct block *const block = &linear->block[f];
    const int n = at->end - at->x;
    fish_factors_solve(block->factors, x);
    if (!block->is_updated) return;
    const double shed = x[at->circulation - at->x];
    for (int i = 0; i < n; i++) x[i] -= shed * block->update[i];
}

// the change of the column of the circulation shed, in rows of the block
static void find_change(const struct fish *fish, const struct sparse *own, const double *value, double *change) {
    const int column = fish->at.circulation - fish->at.x, end = fish->at.gamma + fish->n_control - fish->at.x;
    const int first = (fish_has_momentum(fish) ? fish->at.ax : fish->at.gamma) - fish->at.x;
    memset(change, 0, (size_t)own->n * sizeof *change);
    for (int i = first; i < end; i++) {
        if (!sparse_is_masked(own, fish->at.x + i)) change[i] = value[fish->at.x + i];
    }
    for (int64_t i = own->column_start[column]; i < own->column_start[column + 1]; i++) {
        const int64_t row = own->row_index[i];
        if (row >= first && row < end) change[row] -= own->value[i];
    }
}

/* A product or solution, fish by fish, with one vector and for another. */
struct operation {
    struct linear *linear;
    const double *from;
    double *to;
};

static void for_each_fish(parallel_body *body, struct operation operation) {
    const struct school *const school = operation.linear->jacobian->school;
    parallel_for(fish_threads(school), school->n_fish, body, &operation);
}

static void update_shed(void *data, int f) {
    const struct operation *const of = data;
    const struct jacobian *const jacobian = of->linear->jacobian;
    const struct fish *fish = &jacobian->school->fish[f];
    struct block *const block = &of->linear->block[f];
    find_change(fish, jacobian->own[f], of->from, block->update);
    block->is_updated = 0;
    solve_block(of->linear, f, block->update);
    const double divisor = 1 + block->update[fish->at.circulation - fish->at.x];
    for (int i = 0; i < jacobian->own[f]->n; i++) block->update[i] /= divisor;
    block->is_updated = 1;
}

void linear_update_shed(struct linear *linear, const double *value) {
    for_each_fish(update_shed, (struct operation){linear, value, NULL});
}

// x = D^-1 b with the diagonal blocks D alone; both may be the same array
static void solve_one(void *data, int f) {
    const struct operation *const of = data;
    const struct layout *at = &of->linear->jacobian->school->fish[f].at;
    const int n = at->end - at->x;
    if (of->to != of->from) memcpy(of->to + at->x, of->from + at->x, (size_t)n * sizeof *of->to);
    solve_block(of->linear, f, of->to + at->x);
}

// product = v + D^-1 C v, C being the coupling blocks
static void multiply_one(void *data, int f) {
    const struct operation *const of = data;
    const struct jacobian *jacobian = of->linear->jacobian;
    const struct layout *at = &jacobian->school->fish[f].at;
    double *const product = of->to;
    memset(product + at->x, 0, (size_t)(at->ax - at->x) * sizeof *product);
    jacobian_multiply_couplings(jacobian, f, of->from, product + at->ax);
    solve_block(of->linear, f, product + at->x);
    for (int i = at->x; i < at->end; i++) product[i] += of->from[i];
}

static double dot(const struct linear *linear, const double *a, const double *b) {
    double sum = 0;
    for (int i = 0; i < n_unknowns(linear); i++) sum += linear->weight[i] * a[i] * b[i];
    return sum;
}

// allocate n directions; those that exist keep their values
static enum status reserve(struct linear *linear, int n) {
    if (n <= linear->n_directions) return STATUS_OK;
    double *const more = realloc(linear->direction, (size_t)n * (size_t)n_unknowns(linear) * sizeof *more);
    if (!more) return status_fail(STATUS_MEMORY, "out of memory: %d directions of GMRES", n);
    linear->direction = more;
    linear->n_directions = n;
    return STATUS_OK;
}

// the Hessenberg matrix of GMRES by columns, kept upper triangular by Givens rotations, and its right-hand side
struct least_squares {
    double h[MAX_ITERATIONS][MAX_ITERATIONS + 1], cosine[MAX_ITERATIONS], sine[MAX_ITERATIONS], rhs[MAX_ITERATIONS + 1];
};

// rotate column j of the matrix; the norm of the residual is then |rhs[j + 1]|
static void rotate(struct least_squares *ls, int j) {
    double *const h = ls->h[j];
    for (int i = 0; i < j; i++) {
        const double upper = ls->cosine[i] * h[i] + ls->sine[i] * h[i + 1];
        h[i + 1] = ls->cosine[i] * h[i + 1] - ls->sine[i] * h[i];
        h[i] = upper;
    }
    const double length = sqrt(h[j] * h[j] + h[j + 1] * h[j + 1]);
    ls->cosine[j] = length > 0 ? h[j] / length : 1;
    ls->sine[j] = length > 0 ? h[j + 1] / length : 0;
    h[j] = length;
    ls->rhs[j + 1] = -ls->sine[j] * ls->rhs[j];
    ls->rhs[j] = ls->cosine[j] * ls->rhs[j];
}

// x = the combination of n directions with the smallest residual
static void combine(const struct linear *linear, const struct least_squares *ls, int n, double *x) {
    double factor[MAX_ITERATIONS];
    for (int j = n - 1; j >= 0; j--) {
        factor[j] = ls->rhs[j];
        for (int k = j + 1; k < n; k++) factor[j] -= ls->h[k][j] * factor[k];
        factor[j] /= ls->h[j][j];
    }
    memset(x, 0, (size_t)n_unknowns(linear) * sizeof *x);
    for (int j = 0; j < n; j++) {
        const double *const direction = linear->direction + (long)j * n_unknowns(linear);
        for (int i = 0; i < n_unknowns(linear); i++) x[i] += factor[j] * direction[i];
    }
}

// solve the coupled system; x enters as the solution of the uncoupled one
static enum status solve_coupled(struct linear *linear, double *x) {
    const int n = n_unknowns(linear);
    struct least_squares ls;
    const double start = sqrt(dot(linear, x, x));
    const double limit = linear->jacobian->has_contacts
                             ? contact_relative * start
                             : fmax(linear->tolerance.relative * start, linear->tolerance.absolute);
    if (!(start > limit) || !isfinite(start)) return STATUS_OK;
    TRY(reserve(linear, 1));
    for (int i = 0; i < n; i++) linear->direction[i] = x[i] / start;
    ls.rhs[0] = start;
    int j = 0;
    while (j < MAX_ITERATIONS && fabs(ls.rhs[j]) > limit) {
        TRY(reserve(linear, j + 2));
        double *const next = linear->direction + (long)(j + 1) * n;
        for_each_fish(multiply_one, (struct operation){linear, linear->direction + (long)j * n, next});
        for (int k = 0; k <= j; k++) {
            const double *const direction = linear->direction + (long)k * n;
            ls.h[j][k] = dot(linear, direction, next);
            for (int i = 0; i < n; i++) next[i] -= ls.h[j][k] * direction[i];
        }
        const double length = sqrt(dot(linear, next, next));
        ls.h[j][j + 1] = length;
        for (int i = 0; length > 0 && i < n; i++) next[i] /= length;
        rotate(&ls, j++);
    }
    linear->iterations += j;
    combine(linear, &ls, j, x);
    return STATUS_OK;
}

enum status linear_solve(struct linear *linear, const double *b, double *x) {
    linear->solves++;
    for_each_fish(solve_one, (struct operation){linear, b, x});
    if (linear->jacobian->n_couplings > 0) TRY(solve_coupled(linear, x));
    for (int i = 0; i < n_unknowns(linear); i++) {
        if (!isfinite(x[i])) return status_fail(STATUS_RETRY, "a linear system has no finite solution");
    }
    return STATUS_OK;
}

struct linear_counts linear_count(const struct linear *linear) {
    struct linear_counts counts = {.solves = linear->solves, .iterations = linear->iterations};
    for (int f = 0; f < linear->jacobian->school->n_fish; f++) {
        const struct sparse_factors_counts block = fish_factors_count(linear->block[f].factors);
        counts.analyses += block.analyses;
        counts.factorisations += block.factorisations;
        counts.refactorisations += block.refactorisations;
    }
    return counts;
}
