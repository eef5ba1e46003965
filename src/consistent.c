/* consistent.c: the algebraic rows and columns of the whole Jacobian, and Newton's method of KINSOL on them. */
#include "consistent.h"

#include <kinsol/kinsol.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bridge.h"

/* Rows are scaled to order one; Newton ends at this norm, or where its steps no longer change the unknowns. */
static const double tolerance = 1e-14;

struct consistent {
    struct residual *residual;
    struct sparse *whole; /* the Jacobian of all equations */
    int n_unknowns;
    double t;
    double *y, *value, *zero, *kind; /* all unknowns, all equations, no rates, kinds      (n_unknowns) */

    /* the algebraic part; made anew when the kinds or the pattern change */
    int n;
    int *member;         /* its unknowns                                                  (n) */
    int *place;          /* of each unknown in the part, -1: not in it                    (n_unknowns) */
    struct sparse part;  /* shares nothing with whole */
    int64_t *source;     /* where in whole its values stand                               (part.n_nonzeros) */
    unsigned pattern;    /* of the residual's Jacobian that it was made from */
    enum status failure; /* of the last callback */

    SUNContext context;
    N_Vector solution, solution_scale, value_scale;
    double *solution_data, *solution_scale_data, *value_scale_data; /* (n) */
    struct bridge_klu klu;
    void *kinsol;
    long iterations;
};

static void part_free(struct consistent *c) {
    if (c->kinsol) KINFree(&c->kinsol);
    bridge_klu_free(&c->klu);
    N_Vector *const vectors[] = {&c->solution, &c->solution_scale, &c->value_scale};
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        if (*vectors[i]) N_VDestroy(*vectors[i]);
        *vectors[i] = NULL;
    }
    void **const owned[] = {(void **)&c->member,           (void **)&c->solution_data, (void **)&c->solution_scale_data,
                            (void **)&c->value_scale_data, (void **)&c->source,        (void **)&c->part.column_start,
                            (void **)&c->part.row_index,   (void **)&c->part.value};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) {
        free(*owned[i]);
        *owned[i] = NULL;
    }
    c->part = (struct sparse){0};
}

void consistent_free(struct consistent *c) {
    if (!c) return;
    part_free(c);
    sparse_free(c->whole);
    free(c->y);
    free(c->value);
    free(c->zero);
    free(c->kind);
    free(c->place);
    if (c->context) SUNContext_Free(&c->context);
    free(c);
}

static enum status fill(struct consistent *c) {
    const size_t n = (size_t)c->n_unknowns;
    c->y = calloc(n, sizeof *c->y);
    c->value = calloc(n, sizeof *c->value);
    c->zero = calloc(n, sizeof *c->zero);
    c->kind = calloc(n, sizeof *c->kind);
    c->place = calloc(n, sizeof *c->place);
    if (!c->y || !c->value || !c->zero || !c->kind || !c->place) {
        return status_fail(STATUS_MEMORY, "no room for a consistent start of %d unknowns", c->n_unknowns);
    }
    TRY(sparse_create(&c->whole, c->n_unknowns));
    residual_mask(c->residual, c->whole);
    return bridge_context(&c->context);
}

enum status consistent_create(struct consistent **consistent, struct residual *residual) {
    *consistent = NULL;
    struct consistent *const new = calloc(1, sizeof *new);
    if (!new) return status_fail(STATUS_MEMORY, "no room for a consistent start");
    new->residual = residual;
    new->n_unknowns = residual->school->n_unknowns;
    const enum status status = fill(new);
    if (status != STATUS_OK) {
        consistent_free(new);
        return status;
    }
    *consistent = new;
    return STATUS_OK;
}

// F of the algebraic equations for KINSOL
static int algebraic_value(N_Vector solution, N_Vector value, void *data) {
    struct consistent *const c = data;
    const double *const from = N_VGetArrayPointer(solution);
    double *const to = N_VGetArrayPointer(value);
    for (int i = 0; i < c->n; i++) c->y[c->member[i]] = from[i];
    c->failure = residual_evaluate(c->residual, c->t, c->y, c->zero, c->value);
    for (int i = 0; i < c->n; i++) to[i] = c->value[c->member[i]];
    return c->failure;
}

static void part_values(struct consistent *c) {
    for (int64_t i = 0; i < c->part.n_nonzeros; i++) c->part.value[i] = c->whole->value[c->source[i]];
}

static int algebraic_jacobian(N_Vector solution, N_Vector value, SUNMatrix matrix, void *data, N_Vector scratch1,
                              N_Vector scratch2) {
    (void)value;
    (void)matrix;
    (void)scratch1;
    (void)scratch2;
    struct consistent *const c = data;
    const double *const from = N_VGetArrayPointer(solution);
    for (int i = 0; i < c->n; i++) c->y[c->member[i]] = from[i];
    c->failure = residual_jacobian(c->residual, c->t, 0, c->y, c->whole);
    if (c->failure != STATUS_OK) return c->failure;
    part_values(c);
    c->failure = bridge_klu_copy(&c->klu, &c->part);
    return c->failure;
}

// the pattern of the algebraic rows and columns
static enum status choose_part(struct consistent *c) {
    c->n = 0;
    for (int i = 0; i < c->n_unknowns; i++) c->place[i] = c->kind[i] > 0 ? -1 : c->n++;
    const size_t n = (size_t)c->n, most = (size_t)c->whole->n_nonzeros + 1;
    c->member = calloc(n, sizeof *c->member);
    c->solution_data = calloc(n, sizeof(double));
    c->solution_scale_data = calloc(n, sizeof(double));
    c->value_scale_data = calloc(n, sizeof(double));
    c->source = calloc(most, sizeof *c->source);
    c->part.column_start = calloc(n + 1, sizeof *c->part.column_start);
    c->part.row_index = calloc(most, sizeof *c->part.row_index);
    c->part.value = calloc(most, sizeof *c->part.value);
    if (!c->member || !c->solution_data || !c->solution_scale_data || !c->value_scale_data || !c->source ||
        !c->part.column_start || !c->part.row_index || !c->part.value) {
        return status_fail(STATUS_MEMORY, "no room for %d algebraic unknowns", c->n);
    }
    c->part.n = c->n;
    c->part.version = 1;
    for (int column = 0; column < c->n_unknowns; column++) {
        if (c->place[column] < 0) continue;
        c->member[c->place[column]] = column;
        for (int64_t i = c->whole->column_start[column]; i < c->whole->column_start[column + 1]; i++) {
            const int row = c->place[c->whole->row_index[i]];
            if (row < 0) continue;
            c->part.row_index[c->part.n_nonzeros] = row;
            c->source[c->part.n_nonzeros++] = i;
        }
        c->part.column_start[c->place[column] + 1] = c->part.n_nonzeros;
    }
    return STATUS_OK;
}

// the equations come in accelerations, velocities, circulations and numbers; their scales follow the unknowns'
static double row_scale(const struct residual *residual, int i) {
    const struct unknown_place place = residual_place(residual->school, i);
    const struct layout *at = &residual->school->fish[place.fish].at;
    const double speed = residual_scale(residual, at->sheet);
    return place.kind == UNKNOWN_SHEET ? speed : residual_scale(residual, i);
}

static enum status part_create(struct consistent *c) {
    TRY(choose_part(c));
    for (int i = 0; i < c->n; i++) {
        c->solution_scale_data[i] = 1 / residual_scale(c->residual, c->member[i]);
        c->value_scale_data[i] = 1 / row_scale(c->residual, c->member[i]);
    }
    TRY(bridge_vector(&c->solution, c->context, c->n, c->solution_data));
    TRY(bridge_vector(&c->solution_scale, c->context, c->n, c->solution_scale_data));
    TRY(bridge_vector(&c->value_scale, c->context, c->n, c->value_scale_data));
    TRY(bridge_klu_create(&c->klu, c->context, c->solution, c->n));
    c->kinsol = KINCreate(c->context);
    if (!c->kinsol) return status_fail(STATUS_MEMORY, "no room for KINSOL");
    // a full step of Newton's method on equations that are nearly linear, with a new Jacobian each time
    if (KINSetErrHandlerFn(c->kinsol, bridge_message, NULL) || KINSetUserData(c->kinsol, c) ||
        KINInit(c->kinsol, algebraic_value, c->solution) ||
        KINSetLinearSolver(c->kinsol, c->klu.solver, c->klu.matrix) || KINSetJacFn(c->kinsol, algebraic_jacobian) ||
        KINSetMaxSetupCalls(c->kinsol, 1) || KINSetFuncNormTol(c->kinsol, tolerance) ||
        KINSetScaledStepTol(c->kinsol, 1e-14) || KINSetNumMaxIters(c->kinsol, 50) ||
        KINSetMaxNewtonStep(c->kinsol, 1e30)) {
        return status_fail(STATUS_SOLVER, "KINSOL cannot be set up: %s", status_message());
    }
    return STATUS_OK;
}

// the kinds of the unknowns or the pattern of the Jacobian may have changed since the last solution
static enum status refresh(struct consistent *c) {
    double *const kind = c->value;
    residual_kinds(c->residual, kind);
    const int same_kinds = memcmp(kind, c->kind, (size_t)c->n_unknowns * sizeof *kind) == 0;
    if (c->kinsol && same_kinds && c->pattern == c->residual->pattern) return STATUS_OK;
    memcpy(c->kind, kind, (size_t)c->n_unknowns * sizeof *kind);
    c->pattern = c->residual->pattern;
    part_free(c);
    sparse_forget(c->whole);
    TRY(residual_jacobian(c->residual, c->t, 0, c->y, c->whole));
    return part_create(c);
}

// what KINSOL could not do, and for which unknown the equation is worst
static enum status give_up(struct consistent *c, int code) {
    int worst = 0;
    double most = -1;
    for (int i = 0; i < c->n; i++) {
        const double size = fabs(c->value[c->member[i]] * c->value_scale_data[i]);
        if (!(size <= most)) {
            most = size;
            worst = c->member[i];
        }
    }
    const struct unknown_place place = residual_place(c->residual->school, worst);
    char cause[512];
    snprintf(cause, sizeof cause, "%s", status_message());
    return status_fail(
        STATUS_SOLVER,
        "no consistent state at t = %.10g s: KINSOL ended with code %d; the equation for %s[%d] of fish %s "
        "is left with %.3g of its scale (%s)",
        c->t, code, place.name, place.index, c->residual->school->fish[place.fish].name, most, cause);
}

// rates of the differential unknowns; those of the algebraic ones stay
static void set_rates(const struct consistent *c, double t, const double *y, double *yp) {
    const struct school *school = c->residual->school;
    for (int f = 0; f < school->n_fish; f++) {
        const struct layout *at = &school->fish[f].at;
        for (int i = at->x; i < at->vx; i++) yp[i] = y[i + (at->vx - at->x)];
        for (int i = at->vx; i < at->ax; i++) yp[i] = y[i + (at->ax - at->vx)];
        if (c->kind[at->shed] > 0) yp[at->shed] = residual_shed_rate(c->residual, f, t, y);
    }
}

enum status consistent_solve(struct consistent *c, double t, double *y, double *yp) {
    c->t = t;
    memcpy(c->y, y, (size_t)c->n_unknowns * sizeof *y);
    flow_forget(c->residual->flow);
    TRY(refresh(c));
    for (int i = 0; i < c->n; i++) c->solution_data[i] = y[c->member[i]];
    c->failure = STATUS_OK;
    const int code = KINSol(c->kinsol, c->solution, KIN_NONE, c->solution_scale, c->value_scale);
    long iterations = 0;
    KINGetNumNonlinSolvIters(c->kinsol, &iterations);
    c->iterations += iterations;
    if (c->failure < 0) return c->failure;
    if (code < 0) return give_up(c, code);
    for (int i = 0; i < c->n; i++) y[c->member[i]] = c->solution_data[i];
    // the fluid's velocity at the solution serves the rates, and whoever measures the state
    TRY(residual_evaluate(c->residual, t, y, yp, c->value));
    set_rates(c, t, y, yp);
    return STATUS_OK;
}

long consistent_iterations(const struct consistent *consistent) {
    return consistent->iterations;
}
