/* sheet_integrals.c: puts a cosine series through the circulations and integrates it by Gauss-Legendre quadrature in
 * theta. */
#include "fish/sheet_integrals.h"

#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "base/wide.h"
#include "fish/shape.h"

/* Gauss points per piece. A piece is at most the distance of two vortices: half a period of the highest term of the
 * series, and the error is below 1e-10 of this term. */
enum { GAUSS = 6 };

/* The cosine series through the circulations. Column m - 1 of `cosine` has the factors cos(m theta_j) of all vortices
 * j, for m = 1 .. n-1; the factors of the last term are halved. */
struct series {
    int n;
    double *cosine; /* (n, n - 1) by columns */
    double *term;   /* coefficients of the terms (n - 1) */
    double *sum;    /* of all vortices j (n) */
};

static void series_sum(const struct series *series, double constant) {
    for (int j = 0; j < series->n; j++) series->sum[j] = constant;
    wide_multiply(series->n, series->n - 1, series->cosine, series->term, series->sum);
}

// C_j of all vortices j at theta
static void series_circulation(const struct series *series, double theta) {
    for (int m = 1; m < series->n; m++) series->term[m - 1] = 2 / M_PI * sin(m * theta) / m;
    series_sum(series, theta / M_PI);
}

/* Add the momentum of one edge, in pieces of equal length in theta with these Gauss points. Partial fractions of b_k
 * b_i' with b_k = c_k/(D (u - k)) and the mean slope M = sum over k of b_k/(u - k), k != i:
 *
 *     b_k b_i' = c_k c_i/D^2 1/((u - k)(u - i)) (M - 1/(u - i))                                          m = k - i
 *     P_kij = c_k c_i ((A_k - A_i + E_i)/m - (B_k - B_i)/m^2)
 *     A, B, E: integrals of density C_j/D^2 times M/(u - k), 1/(u - k), 1/(u - k)^2
 *
 * The diagonal is b_k b_k', with the slope of the nearest node as minus the sum of all other slopes: exact, without
 * cancellation. part: workspace (4 n_nodes). */
static enum status momentum_add(struct sheet_integrals *to, const struct series *series, int edge, double density,
                                const double *node, const double *gauss, double *part,
                                const volatile sig_atomic_t *stop) {
    const int n = to->n_nodes, n_edges = to->n_nodes - 1;
    double *const a = part, *const b = part + n, *const e = part + 2 * n, *const own = part + 3 * n;
    const double first = acos(1 - 2.0 * edge / n_edges), last = acos(1 - 2.0 * (edge + 1) / n_edges);
    const int needed = (int)ceil((last - first) / (M_PI / to->n_control)), n_pieces = needed < 2 ? 2 : needed;
    const double piece = (last - first) / n_pieces;
    for (int p = 0; p < GAUSS * n_pieces; p++) {
        TRY(status_ask(stop));
        const double theta = first + (p / GAUSS + node[p % GAUSS]) * piece;
        const double u = n_edges * (1 - cos(theta)) / 2;
        const double weight = density * gauss[p % GAUSS] * piece * n_edges * sin(theta) / 2;

        // D and M
        double sum = 0, mean = 0, slopes = 0;
        for (int k = 0; k < n; k++) {
            const double inverse = 1 / (u - k);
            b[k] = inverse;
            sum += to->factor[k] * inverse;
            mean += to->factor[k] * inverse * inverse;
        }
        mean /= sum;

        // the diagonal
        const int nearest = (int)(u + 0.5);
        for (int k = 0; k < n; k++) {
            const double value = to->factor[k] * b[k] / sum, slope = value * (mean - b[k]);
            own[k] = weight * value * slope;
            if (k != nearest) slopes += slope;
        }
        own[nearest] = -weight * to->factor[nearest] * b[nearest] / sum * slopes;

        const double share = weight / (sum * sum);
        for (int k = 0; k < n; k++) {
            a[k] = share * mean * b[k];
            e[k] = share * b[k] * b[k];
            b[k] *= share;
        }

        series_circulation(series, theta);
        for (int j = 0; j < to->n_sheet; j++) {
            wide_multiply(4 * n, 1, part, &series->sum[j], to->part + (long)j * 4 * n);
        }
    }
    return STATUS_OK;
}

// fill all integrals; scratch: of the series
static enum status integrals_fill(struct sheet_integrals *to, struct arena *scratch, const double *density,
                                  const volatile sig_atomic_t *stop) {
    const int n = to->n_sheet, n_control = to->n_control, n_nodes = to->n_nodes;
    struct series series = {.n = n};
    NEW(scratch, series.cosine, n * (n - 1));
    NEW(scratch, series.term, n - 1);
    NEW(scratch, series.sum, n);
    for (int m = 1; m < n; m++) {
        double *const column = series.cosine + (long)(m - 1) * n;
        for (int j = 0; j < n; j++) column[j] = (m < n - 1 ? 1 : 0.5) * cos(m * j % (2 * (n - 1)) * M_PI / (n - 1));
    }

    // strength and circulation at the control points
    for (int c = 0; c < n_control; c++) {
        TRY(status_ask(stop));
        const double theta = M_PI * (c + 0.5) / n_control;
        for (int m = 1; m < n; m++) series.term[m - 1] = 2 * cos(m * theta) / (n - 1);
        series_sum(&series, 1.0 / (n - 1));
        for (int j = 0; j < n; j++) to->strength[j * n_control + c] = series.sum[j];
        series_circulation(&series, theta);
        for (int j = 0; j < n; j++) to->circulation[j * n_control + c] = series.sum[j];
    }

    // the kink for a vortex strength equal to the position: g = sin(theta) (1 - cos(theta)) minus the series of g
    const double h = M_PI / n_control, scale = sin(M_PI - h) * (1 - cos(M_PI - h)) * h;
    for (int c = 0; c < n_control; c++) {
        const double theta = h * (c + 0.5), place = 1 - cos(theta);
        double strength = sin(theta) * place * h, circulation = place * place / 2;
        for (int j = 1; j < n_control; j++) {
            const double here = sin(j * h) * (1 - cos(j * h)) * h;
            strength -= to->strength[j * n_control + c] * here;
            circulation -= to->circulation[j * n_control + c] * here;
        }
        to->kink_strength[c] = strength / scale;
        to->kink_circulation[c] = circulation / scale;
    }

    // momentum
    curve_smooth_factors(n_nodes, to->factor);
    for (int m = 1; m < n_nodes; m++) {
        to->inverse[n_nodes - 1 + m] = 1.0 / m;
        to->inverse[n_nodes - 1 - m] = -1.0 / m;
    }
    double *part, node[GAUSS], gauss[GAUSS];
    quadrature_legendre(GAUSS, node, gauss);
    NEW(scratch, part, 4 * n_nodes);
    for (int k = 0; k < n_nodes - 1; k++) TRY(momentum_add(to, &series, k, density[k], node, gauss, part, stop));
    return STATUS_OK;
}

enum status sheet_integrals_create(struct arena *arena, struct sheet_integrals **integrals, int n_nodes, int n_sheet,
                                   const double *density, const volatile sig_atomic_t *stop) {
    struct sheet_integrals *to;
    const int n_control = n_sheet - 1;
    NEW(arena, to, 1);
    to->n_nodes = n_nodes;
    to->n_sheet = n_sheet;
    to->n_control = n_control;
    NEW(arena, to->part, (long)n_sheet * 4 * n_nodes);
    NEW(arena, to->factor, n_nodes);
    NEW(arena, to->inverse, 2 * n_nodes - 1);
    NEW(arena, to->strength, n_control * n_sheet);
    NEW(arena, to->circulation, n_control * n_sheet);
    NEW(arena, to->kink_strength, n_control);
    NEW(arena, to->kink_circulation, n_control);

    struct arena *const scratch = arena_create(arena, "the series of a sheet");
    const enum status status = integrals_fill(to, scratch, density, stop);
    arena_free(scratch);
    *integrals = status == STATUS_OK ? to : NULL;
    return status;
}

WIDE(void, sheet_integrals_matrix,
     (const struct sheet_integrals *integrals, const double *circulation, double *parts, double *matrix),
     (integrals, circulation, parts, matrix)) {
    const int n = integrals->n_nodes;
    wide_product(4 * n, integrals->n_sheet, integrals->part, circulation, parts);
    const double *const a = parts, *const b = parts + n, *const e = parts + 2 * n, *const own = parts + 3 * n;
    const double *const factor = integrals->factor;
    for (int i = 0; i < n; i++) {
        const double *const over = integrals->inverse + n - 1 - i;
        const double scale = factor[i], shift = e[i] - a[i], here = b[i];
        double *restrict const column = matrix + (long)i * n;
        for (int k = 0; k < n; k++) {
            column[k] = scale * factor[k] * over[k] * (a[k] + shift - over[k] * (b[k] - here));
        }
        column[i] = own[i];
    }
}

WIDE(void, sheet_integrals_product,
     (const struct sheet_integrals *integrals, int j, const double *x, const double *y, double *restrict to_x,
      double *restrict to_y),
     (integrals, j, x, y, to_x, to_y)) {
    const int n = integrals->n_nodes;
    const double *const a = integrals->part + (long)j * 4 * n, *const b = a + n, *const e = b + n, *const own = e + n;
    const double *const factor = integrals->factor;
    for (int k = 0; k < n; k++) to_x[k] = to_y[k] = 0;
    for (int i = 0; i < n; i++) {
        const double *const over = integrals->inverse + n - 1 - i;
        const double scale_x = factor[i] * x[i], scale_y = factor[i] * y[i], shift = e[i] - a[i], here = b[i];
        for (int k = 0; k < n; k++) {
            const double value = over[k] * (a[k] + shift - over[k] * (b[k] - here));
            to_x[k] += scale_x * value;
            to_y[k] += scale_y * value;
        }
    }
    for (int k = 0; k < n; k++) {
        to_x[k] = factor[k] * to_x[k] + own[k] * x[k];
        to_y[k] = factor[k] * to_y[k] + own[k] * y[k];
    }
}
