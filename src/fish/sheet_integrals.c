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

/* Both series run over m = 1 .. n-1 with the factors cos(m theta_j), the last term halved: of sin(m theta)/m, of
 * cos(m theta). Multiples of an angle follow by cos((m+1) a) = 2 cos(a) cos(m a) - cos((m-1) a), and so for sin. */
static void series_sum(int n, int j, double theta, double *of_sines, double *of_cosines) {
    const double step = pi * j / (n - 1), twice_step = 2 * cos(step), twice = 2 * cos(theta);
    double factor[2] = {1, cos(step)}, cosine[2] = {1, cos(theta)}, sine[2] = {0, sin(theta)};
    *of_sines = *of_cosines = 0;

    for (int m = 1; m < n; m++) {
        const double weight = (m < n - 1 ? 1 : 0.5) * factor[m % 2];
        *of_sines += weight * sine[m % 2] / m;
        *of_cosines += weight * cosine[m % 2];
        const int next = (m + 1) % 2;
        factor[next] = twice_step * factor[m % 2] - factor[next];
        cosine[next] = twice * cosine[m % 2] - cosine[next];
        sine[next] = twice * sine[m % 2] - sine[next];
    }
}

double sheet_integrals_circulation(int n, int j, double theta) {
    double of_sines, of_cosines;
    series_sum(n, j, theta, &of_sines, &of_cosines);
    return (theta + 2 * of_sines) / pi;
}

// G of the control point at theta
static double strength_between(int n, int j, double theta) {
    double of_sines, of_cosines;
    series_sum(n, j, theta, &of_sines, &of_cosines);
    return (1 + 2 * of_cosines) / (n - 1);
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

// add a point theta with its weight to the integrals of every j
static void integrals_add_point(struct sheet_integrals *to, double theta, double weight, const struct stencil *point,
                                const struct stencil *slope) {
    const int n = to->n_nodes;
    for (int j = 0; j < to->n_sheet; j++) {
        double *const matrix = to->momentum + (long)j * n * n;
        const double value = weight * sheet_integrals_circulation(to->n_sheet, j, theta);
        for (int i = 0; i < n; i++) {
            for (int k = 0; k < n; k++) matrix[i * n + k] += value * point->weight[k] * slope->weight[i];
        }
    }
}

// one edge, in pieces of equal length in theta
static enum status edge_integrate(struct sheet_integrals *to, int edge, double density) {
    const int n_edges = to->n_nodes - 1;
    const double first = acos(1 - 2.0 * edge / n_edges), last = acos(1 - 2.0 * (edge + 1) / n_edges);
    const int needed = (int)ceil((last - first) / (pi / to->n_control)), n_pieces = needed < 2 ? 2 : needed;
    const double piece = (last - first) / n_pieces;
    double node[GAUSS], gauss[GAUSS];
    quadrature_legendre(GAUSS, node, gauss);
    struct curve *curve;
    TRY(curve_create(&curve, to->n_nodes, 0, 2 * GAUSS * n_pieces));

    for (int i = 0; i < GAUSS * n_pieces; i++) {
        const double theta = first + (i / GAUSS + node[i % GAUSS]) * piece;
        const double u = n_edges * (1 - cos(theta)) / 2;
        const struct stencil point = curve_smooth_point(curve, u), slope = curve_smooth_slope(curve, u);
        integrals_add_point(to, theta, density * gauss[i % GAUSS] * piece * n_edges * sin(theta) / 2, &point, &slope);
    }

    curve_free(curve);
    return STATUS_OK;
}

static enum status integrals_fill(struct sheet_integrals *to, const double *density) {
    const size_t n_nodes = (size_t)to->n_nodes, n_sheet = (size_t)to->n_sheet, n_control = (size_t)to->n_control;
    TRY(MEMORY_NEW(to->momentum, n_sheet * n_nodes * n_nodes, "the integrals over a sheet"));
    TRY(MEMORY_NEW(to->strength, n_control * n_sheet, "the integrals over a sheet"));
    TRY(MEMORY_NEW(to->circulation, n_control * n_sheet, "the integrals over a sheet"));
    TRY(MEMORY_NEW(to->kink_strength, n_control, "the integrals over a sheet"));
    TRY(MEMORY_NEW(to->kink_circulation, n_control, "the integrals over a sheet"));

    // strength and circulation at the control points
    for (int c = 0; c < to->n_control; c++) {
        const double theta = pi * (c + 0.5) / to->n_control;
        for (int j = 0; j < to->n_sheet; j++) {
            to->strength[j * to->n_control + c] = strength_between(to->n_sheet, j, theta);
            to->circulation[j * to->n_control + c] = sheet_integrals_circulation(to->n_sheet, j, theta);
        }
    }

    kink_fill(to);
    for (int k = 0; k < to->n_nodes - 1; k++) TRY(edge_integrate(to, k, density[k]));

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
    const enum status status = integrals_fill(new, density);

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
