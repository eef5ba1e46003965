/* modes.c: after the algebraic unknowns have been eliminated, the exponents are roots of a small nonlinear eigenvalue
 * problem. Each root is found by continuation from a wake without memory, for which the problem is linear, to the full
 * one. */
#include "solver/modes.h"

#include <complex.h>
#define lapack_complex_double double complex
#include <lapacke.h>
#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "fish/fish_motion.h"
#include "flow/flow_at_bodies.h"
#include "school/jacobian.h"
#include "school/residual.h"
#include "school/residual_jacobian.h"

/* Gauss points of the interval, as fractions of it. */
enum { N_POINTS = 2 };
static const double point[N_POINTS] = {0.21132486540518712, 0.78867513459481288};

/* The strength of the wake fades over at least this fraction of its length, because an abrupt end would change the
 * modes. */
static const double window = 0.75;

/* A mode is accepted if |lambda| times the interval is at most fastest, and if it decays over the life of the wake by
 * at most exp(-slowest). lambda is found to this relative accuracy. */
static const double fastest = 0.4, slowest = 6, accuracy = 1e-7;

/* Number of candidates, steps of the continuation, and iterations and inverse iterations in each step. */
enum { CANDIDATES = 24, STEPS = 4, ITERATIONS = 30, INNER = 2 };

/* Two modes are the same if they differ by less than this fraction of the larger one. */
static const double same = 1e-4;

struct modes {
    struct arena *arena; /* freed by modes_find */
    struct residual *residual;
    struct state *state;
    /* numbers of the unknowns of the school, of those that are not prescribed, of the differential ones among them, and
     * of circulations, one for each fish */
    int n_all, n, n_slow, n_shed;
    int *number;  /* 0, 1, ...                                          (n_all) */
    int *unknown; /* unknowns that are not prescribed, differential first       (n) */
    /* dF/dy and dF/dy' after the algebraic unknowns are eliminated: rows of differential unknowns and of circulations,
     * columns of differential unknowns                                                   (n_slow + n_shed, n_slow) */
    double *by_value, *by_rate;
    double *eliminate;       /* how all rows combine into these rows            (n_slow + n_shed, n) */
    double *y;               /* unknowns within the interval                       (n_all) */
    double *plain, *shifted; /* residuals of the school                            (n_all) */
    double **label;          /* circulations of the wakes as they were, oldest first     (n_shed, n_vortex) */
    double *shed;            /* (n_shed) */
};

// ---- the wake

/* The age of marker i in events, 0 for the newest one. Dropped markers leave gaps, so the index does not tell it. */
static int marker_age(const struct wake *wake, double interval, int i) {
    return (int)lround((wake->birth[wake->n_vortex - 1] - wake->birth[i]) / interval);
}

/* The length of the wake in events, with the markers that were dropped. */
static int wake_length(const struct wake *wake, double interval) {
    return wake->n_vortex > 0 ? marker_age(wake, interval, 0) + 1 : 0;
}

/* Set the labels of a fish to those that a motion with exponent lambda has shed, tau after the event: their real or
 * imaginary part, times a factor. */
static void put_labels(const struct modes *modes, int f, double complex lambda, double tau, bool is_imaginary,
                       double factor) {
    struct wake *const wake = &modes->state->wake[f];
    const struct school *const school = modes->residual->school;
    const double interval = school->interval, lifetime = school->lifetime - wake->aged;
    // a wake of full length that decays by itself needs no window
    const int length = wake_length(wake, interval);
    const bool has_all = (length + 2) * interval >= lifetime;
    const bool is_whole = has_all && school->decay >= 0.99 * window * lifetime;
    const double complex step = cexp(-lambda * interval);
    double complex exact = cexp(-lambda * tau), label = exact;
    wake->shed_before = modes->shed[f] + factor * (is_imaginary ? cimag(exact) : creal(exact));
    for (int i = wake->n_vortex - 1, a = 0; i >= 0; a++) {
        const double part = is_whole ? 1 : 1 - ramp_step(((a + 0.5) / length - (1 - window)) / window);
        const double complex strength = part * (exact - exact * step);
        for (; i >= 0 && marker_age(wake, interval, i) <= a; i--) {
            const double complex value = wake->has_markers ? label : strength;
            wake->circulation[i] = modes->label[f][i] + factor * (is_imaginary ? cimag(value) : creal(value));
        }
        label -= strength;
        exact *= step;
    }
    wake->version++;
}

/* Evaluate the residual tau after the event, where all nodes of a body have moved with the velocity of the first
 * node. */
static enum status modes_evaluate(const struct modes *modes, double tau, double *value) {
    const struct state *const state = modes->state;
    const struct school *const school = modes->residual->school;
    memcpy(modes->y, state->y, (size_t)modes->n_all * sizeof *modes->y);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        double position[2], velocity[2], acceleration[2];
        fish_prescribed_node(fish, NULL, 0, state->t, position, velocity, acceleration);
        for (int i = 0; i < 2 * fish->n_nodes; i++) modes->y[fish->at.x + i] += tau * velocity[i / fish->n_nodes];
    }
    const enum status status =
        residual_evaluate(modes->residual, &residual_run, state->t + tau, modes->y, state->yp, value);
    return status == STATUS_RETRY ? status_fail(STATUS_SOLVER, "%s", status_message()) : status;
}

/* Find w_f(lambda), reduced, as the mean over the interval                               (n_slow + n_shed) */
static enum status wake_column(const struct modes *modes, int f, double complex lambda, double complex *column) {
    const struct school *const school = modes->residual->school;
    // small compared with a circulation of the stream, because the forces are quadratic in the circulation
    const double factor = 1e-4 * school->fish[f].length * school->fish[f].length;
    const int rows = modes->n_slow + modes->n_shed;
    for (int i = 0; i < rows; i++) column[i] = 0;
    for (int p = 0; p < N_POINTS; p++) {
        const double tau = point[p] * school->interval;
        for (int part = 0; part < (fabs(cimag(lambda)) > 0 ? 2 : 1); part++) {
            put_labels(modes, f, lambda, tau, part, factor);
            TRY(modes_evaluate(modes, tau, modes->plain));
            put_labels(modes, f, lambda, tau, part, -factor);
            TRY(modes_evaluate(modes, tau, modes->shifted));
            for (int k = 0; k < modes->n; k++) {
                const int i = modes->unknown[k];
                const double change = (modes->plain[i] - modes->shifted[i]) / (2 * factor * N_POINTS);
                const double *const by = modes->eliminate + (size_t)k * (size_t)rows;
                for (int row = 0; row < rows; row++) column[row] += by[row] * change * (part ? I : 1);
            }
        }
    }

    for (int g = 0; g < modes->n_shed; g++) {
        struct wake *const wake = &modes->state->wake[g];
        memcpy(wake->circulation, modes->label[g], (size_t)wake->n_vortex * sizeof *wake->circulation);
        wake->shed_before = modes->shed[g];
        wake->version++;
    }

    return STATUS_OK;
}

// ---- the linear equations

/* List the unknowns that are not prescribed, those whose rate occurs in an equation first. */
static void modes_list(struct modes *modes, const struct jacobian *jacobian, const double *by_rate) {
    const struct school *const school = modes->residual->school;
    const int n = modes->n_all;
    for (int slow = 1; slow >= 0; slow--) {
        for (int f = 0; f < school->n_fish; f++) {
            const struct sparse *const own = jacobian->own[f];
            for (int i = own->first; i < own->first + own->n; i++) {
                if (sparse_is_masked(own, i)) continue;
                double most = 0;
                for (int row = 0; row < n; row++) {
                    most = fmax(most, fabs(by_rate[(size_t)row + (size_t)n * (size_t)i]));
                }
                if ((most > 0) == slow) modes->unknown[modes->n++] = i;
            }
        }
        if (slow) modes->n_slow = modes->n;
    }
}

/* Eliminate the algebraic unknowns. Their columns of dF/dy are C = Q [R; 0], so the last columns of Q times all
 * equations do not contain them. R yields a circulation that is algebraic: Gamma + z^T Q^T (rest) = 0, R^T z = e. */
static enum status modes_reduce(struct modes *modes, const double *by_value, const double *by_rate) {
    const int n = modes->n, slow = modes->n_slow, fast = n - slow, rows = slow + modes->n_shed;
    const size_t n_rows = (size_t)rows, n_all = (size_t)modes->n_all;
    double *c, *q, *tau;
    NEW(modes->arena, c, (size_t)n * (size_t)(fast + 1));
    NEW(modes->arena, q, (size_t)n * (size_t)n);
    NEW(modes->arena, tau, n);
    NEW(modes->arena, modes->eliminate, n_rows * (size_t)n);
    NEW(modes->arena, modes->by_value, n_rows * (size_t)slow);
    NEW(modes->arena, modes->by_rate, n_rows * (size_t)slow);

    for (int j = 0; j < fast; j++) {
        const size_t column = n_all * (size_t)modes->unknown[slow + j];
        for (int i = 0; i < n; i++) c[i + n * j] = by_value[(size_t)modes->unknown[i] + column];
    }
    if (fast > 0 && LAPACKE_dgeqrf(LAPACK_COL_MAJOR, n, fast, c, n, tau) != 0) {
        return status_fail(STATUS_SOLVER, "the modes of the bodies cannot be told apart");
    }
    for (int i = 0; i < n; i++) q[i + n * i] = 1;
    if (fast > 0) LAPACKE_dormqr(LAPACK_COL_MAJOR, 'L', 'N', n, n, fast, c, n, tau, q, n);

    // the last columns of Q give the equations without algebraic unknowns
    for (int row = 0; row < slow; row++) {
        for (int k = 0; k < n; k++) modes->eliminate[row + rows * k] = q[k + n * (fast + row)];
    }
    // a circulation is either differential, or it follows from a row of R^-1 Q^T
    for (int f = 0; f < modes->n_shed; f++) {
        const int circulation = modes->residual->school->fish[f].at.circulation;
        int place = 0;
        while (place < n && modes->unknown[place] != circulation) place++;
        if (place >= slow && place < n) {
            // R^T z = e, then Q z
            for (int j = 0; j < fast; j++) tau[j] = j == place - slow;
            LAPACKE_dtrtrs(LAPACK_COL_MAJOR, 'U', 'T', 'N', fast, 1, c, n, tau, n);
            for (int k = 0; k < n; k++) {
                double sum = 0;
                for (int j = 0; j < fast; j++) sum += q[k + n * j] * tau[j];
                modes->eliminate[slow + f + rows * k] = sum;
            }
        }
    }
    for (int j = 0; j < slow; j++) {
        const size_t column = n_all * (size_t)modes->unknown[j];
        for (int k = 0; k < n; k++) {
            const double value = by_value[(size_t)modes->unknown[k] + column];
            const double rate = by_rate[(size_t)modes->unknown[k] + column];
            const double *const by = modes->eliminate + n_rows * (size_t)k;
            for (int row = 0; row < rows; row++) {
                modes->by_value[row + rows * j] += by[row] * value;
                modes->by_rate[row + rows * j] += by[row] * rate;
            }
        }
    }
    // the equation of a circulation that is differential says that it is itself
    for (int f = 0; f < modes->n_shed; f++) {
        for (int j = 0; j < slow; j++) {
            if (modes->unknown[j] == modes->residual->school->fish[f].at.circulation) {
                modes->by_value[slow + f + rows * j] = -1;
            }
        }
    }
    return STATUS_OK;
}

// ---- one mode

/* Workspace of the continuation of one mode. */
struct following {
    double complex *matrix;        /* (rows, rows) */
    double complex *wake, *still;  /* w(lambda), w(0)                                   (rows, n_shed) */
    double complex *vector, *next; /* (rows) */
    lapack_int *pivot;             /* (rows) */
};

/* Find the exponent near lambda if the wake has this fraction (part) of its memory. *found: it converged. */
static enum status mode_solve(const struct modes *modes, struct following *at, double part, double complex *lambda,
                              int *found) {
    const int slow = modes->n_slow, rows = slow + modes->n_shed;
    *found = 0;
    for (int iteration = 0; iteration < ITERATIONS && !*found; iteration++) {
        for (int f = 0; f < modes->n_shed; f++) {
            double complex *const column = at->wake + (size_t)rows * (size_t)f, *const still = at->still +
                                                                                               (size_t)rows * (size_t)f;
            TRY(wake_column(modes, f, *lambda, column));
            for (int i = 0; i < rows; i++) column[i] = part * column[i] + (1 - part) * still[i];
        }

        // the matrix of differential unknowns and circulations at an exponent: [A + lambda E, W; B + lambda D, W + 1]
        for (int k = 0; k < rows * slow; k++) at->matrix[k] = modes->by_value[k] + *lambda * modes->by_rate[k];
        memcpy(at->matrix + (size_t)rows * (size_t)slow, at->wake, (size_t)(rows * modes->n_shed) * sizeof *at->wake);
        for (int f = 0; f < modes->n_shed; f++) at->matrix[slow + f + rows * (slow + f)] += 1;

        if (LAPACKE_zgetrf(LAPACK_COL_MAJOR, rows, rows, at->matrix, rows, at->pivot) != 0) {
            *found = 1;  // singular to rounding: lambda is a root
            return STATUS_OK;
        }
        double complex change = 0;
        for (int inner = 0; inner < INNER; inner++) {
            // the derivative of the matrix by lambda with the wake held constant, times a vector
            for (int i = 0; i < rows; i++) at->next[i] = 0;
            for (int j = 0; j < slow; j++) {
                for (int i = 0; i < rows; i++) at->next[i] += modes->by_rate[i + rows * j] * at->vector[j];
            }

            LAPACKE_zgetrs(LAPACK_COL_MAJOR, 'N', rows, 1, at->matrix, rows, at->pivot, at->next, rows);
            double complex product = 0;
            double square = 0;
            for (int i = 0; i < rows; i++) {
                product += conj(at->next[i]) * at->vector[i];
                square += creal(conj(at->next[i]) * at->next[i]);
            }
            if (!(square > 0) || !isfinite(square)) return STATUS_OK;
            change = product / square;
            for (int i = 0; i < rows; i++) at->vector[i] = at->next[i] / sqrt(square);
        }
        *lambda -= change;
        if (!isfinite(creal(*lambda)) || !isfinite(cimag(*lambda))) return STATUS_OK;
        *found = cabs(change) <= accuracy * cabs(*lambda);
    }
    return STATUS_OK;
}

// ---- candidates: the modes of a wake without memory

struct candidate {
    double complex lambda;
    double complex *vector; /* (rows) */
};

/* The exponents of a wake without memory, whose labels all equal the present circulation. They are the eigenvalues of
 * -E^-1 A after the circulations have been eliminated. real, imaginary (n_slow), vectors (n_slow, n_slow) */
static enum status find_still(const struct modes *modes, const double complex *still, double *real, double *imaginary,
                              double *vectors) {
    const int slow = modes->n_slow, shed = modes->n_shed, rows = slow + shed;
    const size_t size = (size_t)slow * (size_t)slow;
    double *a, *last;
    lapack_int *pivot;
    NEW(modes->arena, a, 2 * size);
    NEW(modes->arena, last, shed * (shed + 2 * slow));
    NEW(modes->arena, pivot, rows);
    double *const e = a + size;

    // the circulations as functions of the slow unknowns: -(W + 1)^-1 (B, D)
    double *const by_value = last + shed * shed, *const by_rate = by_value + shed * slow;
    for (int f = 0; f < shed; f++) {
        for (int g = 0; g < shed; g++) last[g + shed * f] = creal(still[slow + g + rows * f]) + (f == g);
        for (int j = 0; j < slow; j++) {
            by_value[f + shed * j] = -modes->by_value[slow + f + rows * j];
            by_rate[f + shed * j] = -modes->by_rate[slow + f + rows * j];
        }
    }
    int failed = LAPACKE_dgesv(LAPACK_COL_MAJOR, shed, 2 * slow, last, shed, pivot, by_value, shed) != 0;
    for (int j = 0; j < slow; j++) {
        for (int i = 0; i < slow; i++) {
            a[i + slow * j] = -modes->by_value[i + rows * j];
            e[i + slow * j] = modes->by_rate[i + rows * j];
            for (int f = 0; f < shed; f++) {
                a[i + slow * j] -= creal(still[i + rows * f]) * by_value[f + shed * j];
                e[i + slow * j] += creal(still[i + rows * f]) * by_rate[f + shed * j];
            }
        }
    }
    failed = failed || LAPACKE_dgesv(LAPACK_COL_MAJOR, slow, slow, e, slow, pivot, a, slow) != 0 ||
             LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'V', slow, a, slow, real, imaginary, NULL, 1, vectors, slow) != 0;
    return failed ? status_fail(STATUS_SOLVER, "the modes of the bodies cannot be told apart") : STATUS_OK;
}

/* Whether the events resolve a mode and the mode lasts as long as the wake. loosely: a factor on both limits. */
static bool is_resolved(const struct modes *modes, double complex lambda, double loosely) {
    const double interval = modes->residual->school->interval;
    double life = interval;
    for (int f = 0; f < modes->n_shed; f++) life = fmax(life, wake_length(&modes->state->wake[f], interval) * interval);
    return cimag(lambda) >= 0 && cabs(lambda) * interval <= loosely * fastest &&
           -creal(lambda) * life <= loosely * slowest;
}

// ---- all

static enum status modes_find_all(const struct modes *modes, int n_most, struct mode *mode, int *n) {
    struct arena *const arena = modes->arena;
    const int slow = modes->n_slow, rows = slow + modes->n_shed;
    struct following at;
    NEW(arena, at.matrix, rows * rows);
    NEW(arena, at.wake, rows * modes->n_shed);
    NEW(arena, at.still, rows * modes->n_shed);
    NEW(arena, at.next, rows);
    NEW(arena, at.pivot, rows);
    double *values, *vectors;
    NEW(arena, values, 2 * slow);
    NEW(arena, vectors, slow * slow);
    struct candidate candidates[CANDIDATES];
    for (int c = 0; c < CANDIDATES; c++) NEW(arena, candidates[c].vector, rows);

    // the slowest modes of a wake without memory
    for (int f = 0; f < modes->n_shed; f++) TRY(wake_column(modes, f, 0, at.still + (size_t)rows * (size_t)f));
    TRY(find_still(modes, at.still, values, values + slow, vectors));
    int n_candidates = 0;
    for (int j = 0; j < slow; j++) {
        const double complex lambda = values[j] + I * values[slow + j];
        const bool is_slow = n_candidates < CANDIDATES || cabs(candidates[CANDIDATES - 1].lambda) > cabs(lambda);
        if (!is_resolved(modes, lambda, 3) || !is_slow) continue;

        int i = n_candidates < CANDIDATES ? n_candidates++ : CANDIDATES - 1;
        double complex *const vector = candidates[i].vector;
        for (; i > 0 && cabs(candidates[i - 1].lambda) > cabs(lambda); i--) candidates[i] = candidates[i - 1];
        candidates[i] = (struct candidate){lambda, vector};
        const double *const real = vectors + slow * j, *const imaginary = real + slow;
        for (int k = 0; k < slow; k++) vector[k] = real[k] + (cimag(lambda) > 0 ? I * imaginary[k] : 0);
        for (int f = 0; f < modes->n_shed; f++) vector[slow + f] = 0;
    }

    // continue each of them to the full memory of the wake
    for (int c = 0; c < n_candidates; c++) {
        int found = 1;
        at.vector = candidates[c].vector;
        for (int step = 1; step <= STEPS && found; step++) {
            TRY(mode_solve(modes, &at, (double)step / STEPS, &candidates[c].lambda, &found));
        }
        if (!found || !is_resolved(modes, candidates[c].lambda, 1)) continue;

        // insert the mode, sorted by falling rate, unless the list contains it
        const struct mode next = {creal(candidates[c].lambda), cimag(candidates[c].lambda)};
        const double size = same * hypot(next.rate, next.omega);
        bool is_known = *n == n_most && mode[n_most - 1].rate >= next.rate;
        for (int i = 0; i < *n; i++) is_known |= hypot(mode[i].rate - next.rate, mode[i].omega - next.omega) <= size;
        if (is_known) continue;
        int i = *n < n_most ? (*n)++ : n_most - 1;
        for (; i > 0 && mode[i - 1].rate < next.rate; i--) mode[i] = mode[i - 1];
        mode[i] = next;
    }
    return STATUS_OK;
}

/* Linearise the equations and reduce them to the differential unknowns and the circulations. */
static enum status modes_pose(struct modes *modes) {
    struct arena *const arena = modes->arena;
    const size_t n = (size_t)modes->n_all;
    NEW(arena, modes->unknown, n);
    NEW(arena, modes->number, n);
    for (int i = 0; i < modes->n_all; i++) modes->number[i] = i;
    NEW(arena, modes->y, n);
    NEW(arena, modes->plain, n);
    NEW(arena, modes->shifted, n);

    // keep the labels, to restore them
    const int n_fish = modes->residual->school->n_fish;
    NEW(arena, modes->label, n_fish);
    NEW(arena, modes->shed, n_fish);
    modes->n_shed = n_fish;
    for (int f = 0; f < n_fish; f++) {
        const struct wake *const wake = &modes->state->wake[f];
        NEW(arena, modes->label[f], wake->n_vortex);
        for (int i = 0; i < wake->n_vortex; i++) modes->label[f][i] = wake->circulation[i];
        modes->shed[f] = wake->shed_before;
    }

    double *by_value, *by_rate;
    NEW(arena, by_value, n * n);
    NEW(arena, by_rate, n * n);
    residual_couple(&modes->residual->couplings, modes->state->y);
    struct jacobian *const jacobian = jacobian_create(arena, modes->residual->school);
    residual_mask(modes->residual, jacobian);

    // dF/dy and dF/dy', means over the interval
    for (int p = 0; p < N_POINTS; p++) {
        const double tau = point[p] * modes->residual->school->interval, t = modes->state->t + tau;
        TRY(modes_evaluate(modes, tau, modes->plain));
        for (int cj = 0; cj < 2; cj++) {
            TRY(residual_jacobian(modes->residual, &residual_run, t, cj, modes->y, jacobian));
            jacobian_add(jacobian, 1.0 / N_POINTS, modes->n_all, modes->number, modes->number, cj ? by_rate : by_value);
        }
    }
    for (size_t i = 0; i < n * n; i++) by_rate[i] -= by_value[i];
    modes_list(modes, jacobian, by_rate);
    return modes_reduce(modes, by_value, by_rate);
}

enum status modes_find(struct arena *arena, struct residual *residual, struct state *state, int n_most,
                       struct mode *mode, int *n) {
    struct modes modes = {.arena = arena_create(arena, "the modes"),
                          .residual = residual,
                          .state = state,
                          .n_all = residual->school->n_unknowns};
    const double reach = residual->couplings.reach;
    *n = 0;
    // at any distance, because the problem is small and has to be exact
    residual->couplings.reach = 1e6 * residual->school->fish[0].length;
    enum status status = modes_pose(&modes);
    if (status == STATUS_OK && modes.n_slow > 0) status = modes_find_all(&modes, n_most, mode, n);
    residual->couplings.reach = reach;
    arena_free(modes.arena);
    return status;
}
