/* equilibrium.c: Newton's method on the residual of a run, with constant velocities. The unknowns are the free
 * positions and the sheets. */
#include "solver/equilibrium.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "fish/fish_motion.h"
#include "school/jacobian.h"
#include "school/residual.h"
#include "school/residual_jacobian.h"
#include "solver/newton.h"

/* Tolerance of the scaled residual. Positions are rounded by some 1e-16 of their size, which stretches an edge and
 * pulls at it; the scale of a force includes this fraction of the axial stiffness for it. */
static const double tolerance = 1e-10, rounding = 1e-5;

/* A good initial guess takes fewer than half as many iterations. */
enum { MAX_ITERATIONS = 16 };

/* An eigenvalue counts as real if its imaginary part is below this fraction of its real part. */
static const double nearly_real = 1e-3;

const struct residual_mode equilibrium_mode = {.shed = SHED_IS_FAR};

struct equilibrium {
    struct arena *arena;
    struct residual *residual;
    struct state *state;
    struct jacobian *jacobian;
    int n,
        n_places; /* number of unknowns, first the free positions of all bodies, then the sheets; number of positions */
    int *unknown, *row;              /* where unknown and equation stand in the school (n) */
    int *number, *row_number;        /* the inverse of unknown and row; -1: not among them (n_unknowns) */
    double *scale, *row_scale, *one; /* (n) */
    double *u, *value;               /* scaled unknowns and residuals                       (n) */
    double *all;                     /* residual of the school                              (n_unknowns) */
};

// ---- unknowns

static void equilibrium_list_one(struct equilibrium *e, int unknown, int row, double scale, double row_scale) {
    const int i = e->n++;
    e->unknown[i] = unknown;
    e->row[i] = row;
    e->scale[i] = scale;
    e->row_scale[i] = row_scale;
    e->number[unknown] = i;
    e->row_number[row] = i;
}

struct equilibrium *equilibrium_create(struct arena *arena, const struct school *school, struct state *state) {
    const int n = school->n_unknowns;
    struct equilibrium *e;
    NEW(arena, e, 1);
    *e = (struct equilibrium){.arena = arena, .residual = residual_create(arena, school, state), .state = state};
    int **const counts[] = {&e->unknown, &e->row, &e->number, &e->row_number};
    double **const reals[] = {&e->scale, &e->row_scale, &e->one, &e->u, &e->value, &e->all};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) NEW(arena, *counts[i], n);
    for (size_t i = 0; i < sizeof reals / sizeof *reals; i++) NEW(arena, *reals[i], n);
    e->jacobian = jacobian_create(arena, school);

    // at any distance, because the problem is small and has to be exact
    e->residual->couplings.reach = 1e6 * school->fish[0].length;
    residual_couple(&e->residual->couplings, state->y);

    for (int i = 0; i < n; i++) {
        e->number[i] = e->row_number[i] = -1;
        e->one[i] = 1;
    }

    // the free positions of all bodies
    for (int f = 0; f < school->n_fish; f++) {
        // the scale of a force: what bends the body by its length, plus what the stream exerts, plus rounding
        const struct fish *const fish = &school->fish[f];
        const double speed = fish->length * fish_rate(school, fish);
        double stiffness = 0, axial = 0, depth = 0;
        for (int k = 0; k < fish->n_edges; k++) {
            axial = fmax(axial, fish->axial_stiffness[k]);
            depth = fmax(depth, fish->depth[k]);
        }
        for (int k = 0; k < fish->n_joints; k++) stiffness = fmax(stiffness, fish->bending_stiffness[k]);
        const double place = fish->length + hypot(fish->start_position[0], fish->start_position[1]);
        const double force = stiffness / (fish->length * fish->length) +
                             school->density * speed * speed * fish->length * depth +
                             rounding * axial * place / fish->edge_length;

        for (int node = 0; node < 2 * fish->n_nodes; node++) {
            const int i = node / fish->n_nodes, k = node % fish->n_nodes;
            if (fish_is_prescribed(fish, k, i)) continue;
            equilibrium_list_one(e, fish->at.x + node, fish->at.ax + node, fish->length, force / fish->mass[k]);
        }
    }
    e->n_places = e->n;

    // the sheets
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const double speed = fish->length * fish_rate(school, fish), circulation = speed * fish->length;
        for (int j = 0; j < fish->n_sheet; j++) {
            // the last equation is Kelvin's
            equilibrium_list_one(e, fish->at.gamma + j, fish->at.gamma + j, speed,
                                 j < fish->n_control ? speed : circulation);
        }
        equilibrium_list_one(e, fish->at.circulation, fish->at.circulation, circulation, circulation);
    }
    return e;
}

// ---- the equations

static enum status equilibrium_evaluate(struct equilibrium *e) {
    struct state *const state = e->state;
    const struct school *school = e->residual->school;
    for (int f = 0; f < school->n_fish; f++) {
        wake_leave_behind(&state->wake[f], state->y[school->fish[f].at.circulation]);
    }
    return residual_evaluate(e->residual, &equilibrium_mode, state->t, state->y, state->yp, e->all);
}

static enum status equilibrium_value_of(void *data, const double *u, double *value) {
    struct equilibrium *const e = data;
    for (int i = 0; i < e->n; i++) e->state->y[e->unknown[i]] = u[i] * e->scale[i];
    TRY(equilibrium_evaluate(e));
    for (int i = 0; i < e->n; i++) value[i] = e->all[e->row[i]] / e->row_scale[i];
    return STATUS_OK;
}

static enum status equilibrium_jacobian_of(void *data, double *matrix) {
    struct equilibrium *const e = data;
    struct jacobian *const jacobian = e->jacobian;
    TRY(residual_jacobian(e->residual, &equilibrium_mode, e->state->t, 0, e->state->y, jacobian));
    memset(matrix, 0, (size_t)e->n * (size_t)e->n * sizeof *matrix);
    jacobian_add(jacobian, 1, e->n, e->row_number, e->number, matrix);
    for (int j = 0; j < e->n; j++) {
        double *const column = matrix + (size_t)e->n * (size_t)j;
        for (int i = 0; i < e->n; i++) column[i] = column[i] * e->scale[j] / e->row_scale[i];
    }
    return STATUS_OK;
}

enum status equilibrium_solve(struct equilibrium *e) {
    const struct newton problem = {.n = e->n,
                                   .scale = e->one,
                                   .tolerance = tolerance,
                                   .max_step = 1e30,
                                   .reuse = 1,
                                   .max_iterations = MAX_ITERATIONS,
                                   .value = equilibrium_value_of,
                                   .jacobian = equilibrium_jacobian_of,
                                   .data = e};
    struct state *const state = e->state;
    const struct school *const school = e->residual->school;

    // what is known: all nodes have the velocity of the first node and no acceleration
    memset(state->yp, 0, (size_t)school->n_unknowns * sizeof *state->yp);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        double position[2], velocity[2], acceleration[2];
        fish_prescribed_node(fish, NULL, 0, state->t, position, velocity, acceleration);
        for (int i = 0; i < 2 * fish->n_nodes; i++) {
            state->y[fish->at.vx + i] = state->yp[fish->at.x + i] = velocity[i / fish->n_nodes];
            state->y[fish->at.ax + i] = 0;
        }
        state->y[fish->at.phi0] = fish->control.bias;
    }

    for (int i = 0; i < e->n; i++) e->u[i] = state->y[e->unknown[i]] / e->scale[i];
    TRY(newton_solve(e->arena, &problem, e->u));
    TRY(equilibrium_value_of(e, e->u, e->value));

    // momenta follow from positions and sheets
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        for (int i = 0; i < fish->at.ax - fish->at.px; i++) {
            state->y[fish->at.px + i] -= e->all[pressure_momentum_row(fish, 0, i / fish->n_nodes, i % fish->n_nodes)];
        }
    }
    return equilibrium_evaluate(e);
}

double equilibrium_residual(const struct equilibrium *e) {
    double most = 0;
    for (int i = 0; i < e->n; i++) most = larger(most, fabs(e->value[i]));
    return most;
}

// ---- the stiffness

enum status equilibrium_stiffness(struct equilibrium *e, struct equilibrium_stiffness *stiffness) {
    const int n = e->n, p = e->n_places, m = n - p;
    *stiffness = (struct equilibrium_stiffness){.n_negative = 0};
    if (p == 0) return STATUS_OK;
    ARENA(scratch, e->arena, "the static stiffness");
    double *matrix, *real, *imaginary;
    lapack_int *pivot;
    NEW(scratch, matrix, (size_t)n * (size_t)n);
    NEW(scratch, real, n);
    NEW(scratch, imaginary, n);
    NEW(scratch, pivot, n);
    TRY(equilibrium_jacobian_of(e, matrix));

    // [A B; C D] is the stiffness, A its block of the positions: replace A by A - B D^-1 C
    double *const right = matrix + (size_t)n * (size_t)p, *const below = matrix + p;
    if (LAPACKE_dgesv(LAPACK_COL_MAJOR, m, p, right + p, n, pivot, below, n) != 0) {
        return status_fail(STATUS_SOLVER, "the positions of the bodies do not determine the sheets");
    }
    for (int j = 0; j < p; j++) {
        double *const column = matrix + (size_t)n * (size_t)j;
        for (int k = 0; k < m; k++) {
            const double factor = column[p + k], *const by_sheet = right + (size_t)n * (size_t)k;
            for (int i = 0; i < p; i++) column[i] -= by_sheet[i] * factor;
        }
        for (int i = 0; i < p; i++) column[i] *= e->row_scale[i] / e->scale[j];
    }

    if (LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', p, matrix, n, real, imaginary, NULL, 1, NULL, 1) != 0) {
        return status_fail(STATUS_SOLVER, "the eigenvalues of the static stiffness do not converge");
    }
    for (int i = 0; i < p; i++) {
        stiffness->log_determinant += log(hypot(real[i], imaginary[i]));
        stiffness->n_negative += real[i] < 0 && fabs(imaginary[i]) <= nearly_real * fabs(real[i]);
    }
    return STATUS_OK;
}
