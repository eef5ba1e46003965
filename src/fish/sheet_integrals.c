/* sheet_integrals.c: a cosine series through the circulations, and Gauss-Legendre quadrature in theta. */
#include "fish/sheet_integrals.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "base/memory.h"
#include "fish/shape.h"
#include "vortex/kernel.h"

static const double pi = 3.14159265358979323846;

/* Gauss points per piece. A piece is at most the distance of two vortices: half a period of the highest term of the
 * series, and the error is below 1e-10 of this term. */
enum { GAUSS = 6 };

/* The cosine series through the circulations. Column m - 1 of `cosine` has the factors cos(m theta_j) of all vortices
 * j, for m = 1 .. n-1; the factors of the last term are halved. */
struct series {
    int n;
    double *cosine; /* (n, n - 1) by columns */
    double *term;   /* coefficients of the terms (n - 1) */
    double *sum;    /* of all vortices j, from the last call of series_circulation or series_strength (n) */
};

static enum status series_create(struct series *series, int n) {
    *series = (struct series){.n = n};
    TRY(MEMORY_NEW(series->cosine, n * (n - 1), "the integrals over a sheet"));
    TRY(MEMORY_NEW(series->term, n - 1, "the integrals over a sheet"));
    TRY(MEMORY_NEW(series->sum, n, "the integrals over a sheet"));

    for (int m = 1; m < n; m++) {
        double *const column = series->cosine + (long)(m - 1) * n;
        for (int j = 0; j < n; j++) column[j] = (m < n - 1 ? 1 : 0.5) * cos(m * j % (2 * (n - 1)) * pi / (n - 1));
    }

    return STATUS_OK;
}

static void series_free(struct series *series) {
    free(series->cosine);
    free(series->term);
    free(series->sum);
}

static void series_sum(const struct series *series, double constant) {
    for (int j = 0; j < series->n; j++) series->sum[j] = constant;
    kernel_multiply(series->n, series->n - 1, series->cosine, series->term, series->sum);
}

// C_j of all vortices j at theta
static void series_circulation(const struct series *series, double theta) {
    for (int m = 1; m < series->n; m++) series->term[m - 1] = 2 / pi * sin(m * theta) / m;
    series_sum(series, theta / pi);
}

// G of all vortices j for a control point at theta
static void series_strength(const struct series *series, double theta) {
    for (int m = 1; m < series->n; m++) series->term[m - 1] = 2 * cos(m * theta) / (series->n - 1);
    series_sum(series, 1.0 / (series->n - 1));
}

// the kink for a vortex strength equal to the position: g = sin(theta) (1 - cos(theta)) minus the series of g
static void kink_fill(struct sheet_integrals *to) {
    const int n = to->n_control;
    const double h = pi / to->n_control, scale = sin(pi - h) * (1 - cos(pi - h)) * h;
    for (int c = 0; c < to->n_control; c++) {
        const double theta = h * (c + 0.5), place = 1 - cos(theta);
        double strength = sin(theta) * place * h, circulation = place * place / 2;
        for (int j = 1; j < to->n_control; j++) {
            const double here = sin(j * h) * (1 - cos(j * h)) * h;
            strength -= to->strength[j * n + c] * here;
            circulation -= to->circulation[j * n + c] * here;
        }

        to->kink_strength[c] = strength / scale;
        to->kink_circulation[c] = circulation / scale;
    }
}

// the momentum of one edge, in pieces of equal length in theta
static enum status edge_integrate(struct sheet_integrals *to, const struct series *series, int edge, double density) {
    const int n = to->n_nodes, n_edges = to->n_nodes - 1;
    const double first = acos(1 - 2.0 * edge / n_edges), last = acos(1 - 2.0 * (edge + 1) / n_edges);
    const int needed = (int)ceil((last - first) / (pi / to->n_control)), n_pieces = needed < 2 ? 2 : needed;
    const double piece = (last - first) / n_pieces;
    double node[GAUSS], gauss[GAUSS];
    quadrature_legendre(GAUSS, node, gauss);
    struct curve *curve;
    TRY(curve_create(&curve, to->n_nodes, 0, 2 * GAUSS * n_pieces));

    for (int p = 0; p < GAUSS * n_pieces; p++) {
        const double theta = first + (p / GAUSS + node[p % GAUSS]) * piece;
        const double u = n_edges * (1 - cos(theta)) / 2;
        const double weight = density * gauss[p % GAUSS] * piece * n_edges * sin(theta) / 2;
        const struct stencil point = curve_smooth_point(curve, u), slope = curve_smooth_slope(curve, u);
        series_circulation(series, theta);

        for (int j = 0; j < to->n_sheet; j++) {
            double *const matrix = to->momentum + (long)j * n * n;
            for (int i = 0; i < n; i++) {
                const double value = weight * series->sum[j] * slope.weight[i];
                for (int k = 0; k < n; k++) matrix[i * n + k] += value * point.weight[k];
            }
        }
    }

    curve_free(curve);
    return STATUS_OK;
}

static enum status integrals_fill(struct sheet_integrals *to, const struct series *series, const double *density) {
    const size_t n_nodes = (size_t)to->n_nodes, n_sheet = (size_t)to->n_sheet, n_control = (size_t)to->n_control;
    TRY(MEMORY_NEW(to->momentum, n_sheet * n_nodes * n_nodes, "the integrals over a sheet"));
    TRY(MEMORY_NEW(to->strength, n_control * n_sheet, "the integrals over a sheet"));
    TRY(MEMORY_NEW(to->circulation, n_control * n_sheet, "the integrals over a sheet"));
    TRY(MEMORY_NEW(to->kink_strength, n_control, "the integrals over a sheet"));
    TRY(MEMORY_NEW(to->kink_circulation, n_control, "the integrals over a sheet"));

    // strength and circulation at the control points
    for (int c = 0; c < to->n_control; c++) {
        const double theta = pi * (c + 0.5) / to->n_control;
        series_strength(series, theta);
        for (int j = 0; j < to->n_sheet; j++) to->strength[j * to->n_control + c] = series->sum[j];
        series_circulation(series, theta);
        for (int j = 0; j < to->n_sheet; j++) to->circulation[j * to->n_control + c] = series->sum[j];
    }

    kink_fill(to);
    for (int k = 0; k < to->n_nodes - 1; k++) TRY(edge_integrate(to, series, k, density[k]));

    return STATUS_OK;
}

enum status sheet_integrals_create(struct sheet_integrals **integrals, int n_nodes, int n_sheet,
                                   const double *density) {
    *integrals = NULL;
    struct sheet_integrals *new;
    TRY(MEMORY_NEW(new, 1, "the integrals over a sheet"));
    new->n_nodes = n_nodes;
    new->n_sheet = n_sheet;
    new->n_control = n_sheet - 1;
    struct series series;
    enum status status = series_create(&series, n_sheet);
    if (status == STATUS_OK) status = integrals_fill(new, &series, density);
    series_free(&series);

    if (status != STATUS_OK) {
        sheet_integrals_free(new);
        return status;
    }

    *integrals = new;
    return STATUS_OK;
}

void sheet_integrals_free(struct sheet_integrals *integrals) {
    if (!integrals) return;
    free(integrals->momentum);
    free(integrals->strength);
    free(integrals->circulation);
    free(integrals->kink_strength);
    free(integrals->kink_circulation);
    free(integrals);
}

static void integrals_multiply(const struct sheet_integrals *integrals, const double *matrix, const double *circulation,
                               double *sum) {
    memset(sum, 0, (size_t)integrals->n_control * sizeof *sum);
    kernel_multiply(integrals->n_control, integrals->n_sheet, matrix, circulation, sum);
}

void sheet_integrals_around(const struct sheet_integrals *integrals, const double *circulation, double *around) {
    integrals_multiply(integrals, integrals->strength, circulation, around);
}

void sheet_integrals_before(const struct sheet_integrals *integrals, const double *circulation, double *before) {
    integrals_multiply(integrals, integrals->circulation, circulation, before);
}
