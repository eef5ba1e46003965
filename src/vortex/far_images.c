/* far_images.c: moments of cells, table of node-to-node velocities, and the polynomials of cells. */
#include "vortex/far_images.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "vortex/tolerance.h"

static const double pi = 3.14159265358979323846;

enum {
    MAX_NODES = 24, /* per cell and direction, or in the smoothing */
    MAX_CELLS = 32, /* along a channel */
    MIN_INTERACTIONS = 100000
};

/* Largest table, bytes. */
static const double max_table = 2e8;

/* The error of an interpolation with p nodes is about rho^-p; rho is the sum of the half axes of the Bernstein ellipse
 * through the nearest pole. The nearest pole in y is the image at a distance of 2H of a vortex at the other wall; the
 * nearest pole in x is an image of a vortex beside the other wall. */
static const double rho_x = 4.2361, rho_y = 5.8284;

/* Upper bound of the interpolation error over rho^-p, in units of the bound in far_images.h; from test_images.c.
 */
static const double error_factor = 50;

/* A set of Chebyshev nodes on (-1, 1), and the matrix from node values to polynomial coefficients: coefficient k is
 * sum_i matrix[k][i] value[i]. */
struct nodes {
    int n;
    double at[MAX_NODES];
    double matrix[MAX_NODES][MAX_NODES];
};

/* Velocity of unit vortices at the nodes of a cell, at the nodes of the cell at an offset of d cells. A node is a pair
 * (y, x), x varies fastest. Rows are targets, columns are vortices; a column is contiguous. */
struct table {
    struct walls channel;
    double low, high; /* of the squares of the smoothings, m2 */
    struct nodes x, y, square;
    int n_offsets, capacity; /* d = 0 .. n_offsets - 1 */
    double *value;           /* (n_offsets, squares, 2, y x, y x) */
};

// free, bound and field vortices; free and bound vortices for every smoothing of the targets
enum { N_TABLES = 8 };

struct far_images {
    struct table table[N_TABLES];
    int oldest;
};

/* The cells of one sum, with node values. */
struct cells {
    double width, middle, half; /* of a cell; of the channel, m */
    int first, n;               /* cell first + c holds x from (first + c) width on */
    double *weight;             /* circulation at the nodes, m2 s-1         (n, squares, y x) */
    double *velocity;           /* at the nodes, then the coefficients           (n, 2, y x) */
};

// ---- vortices

/* The squares of the smoothings of all groups, m2. */
struct squares {
    double low, high;
};

static struct squares squares_of(const struct vortices *vortices) {
    struct squares squares = {.low = INFINITY};
    for (int g = 0; g < vortices->n_groups; g++) {
        const double one = vortices->group[g].smoothing * vortices->group[g].smoothing;
        squares.low = fmin(squares.low, one);
        squares.high = fmax(squares.high, one);
    }

    return squares;
}

// ---- nodes

static void nodes_set(struct nodes *nodes, int n) {
    nodes->n = n;
    for (int i = 0; i < n; i++) {
        const double angle = pi * (i + 0.5) / n;
        nodes->at[i] = cos(angle);
        for (int k = 0; k < n; k++) nodes->matrix[k][i] = (k > 0 ? 2 : 1) * cos(k * angle) / n;
    }
}

// Chebyshev polynomials below degree n at x, and the derivatives if slope is not NULL
static void chebyshev_polynomials(int n, double x, double *value, double *slope) {
    value[0] = 1;
    if (n > 1) value[1] = x;
    for (int k = 2; k < n; k++) value[k] = 2 * x * value[k - 1] - value[k - 2];
    if (!slope) return;
    slope[0] = 0;
    if (n > 1) slope[1] = 1;
    for (int k = 2; k < n; k++) slope[k] = 2 * value[k - 1] + 2 * x * slope[k - 1] - slope[k - 2];
}

static int n_nodes(double rho, double tolerance) {
    const double n = ceil(log(error_factor * TOLERANCE_SUM / tolerance) / log(rho));
    return n < 2 ? 2 : n > MAX_NODES ? MAX_NODES : (int)n;
}

// the nearest pole in the square of the smoothing is -H^2: an image beside the other wall
static int n_squares(double low, double high, double width, double tolerance) {
    if (!(high > low)) return 1;
    const double a = ((low + high) / 2 + width * width) / ((high - low) / 2);
    return n_nodes(a + sqrt(a * a - 1), tolerance);
}

// ---- velocity of nodes at nodes

static int n_of_cell(const struct table *table) {
    return table->x.n * table->y.n;
}

static size_t n_of_square(const struct table *table) {
    return 2 * (size_t)n_of_cell(table) * (size_t)n_of_cell(table);
}

/* Position of a table entry. */
struct entry {
    double width, x, square;
    double y[2]; /* of the point and the vortex above the lower wall, m */
    struct image_height height[2];
    struct image_column column;
};

// velocity of all images of a unit vortex except the two near images
static struct image_velocity far_velocity(const struct entry *at) {
    const double apart = at->y[0] - at->y[1], both = at->y[0] + at->y[1];
    const struct image_rows rows =
        image_rows_of(&at->column, (double[]){at->x, apart}, &at->height[0], &at->height[1], at->square, 0);
    const struct image_velocity lower = image_direct_of(at->x, both, at->square, 0),
                                upper = image_direct_of(at->x, both - 2 * at->width, at->square, 0);

    return (struct image_velocity){.u = rows.shifted.u - (rows.mirrored.u - lower.u - upper.u),
                                   .v = rows.shifted.v - (rows.mirrored.v - lower.v - upper.v)};
}

// fill the entries of one pair of nodes in x and all pairs in y; value: of the first pair
static void table_fill_pairs(const struct table *table, struct entry *at, double *value) {
    const size_t n = (size_t)n_of_cell(table);
    const int nx = table->x.n, ny = table->y.n;
    double y[MAX_NODES];
    struct image_height height[MAX_NODES];

    for (int i = 0; i < ny; i++) {
        y[i] = (1 + table->y.at[i]) / 2 * at->width;
        height[i] = image_height_of(&table->channel, table->channel.y[0] + y[i]);
    }

    for (int j = 0; j < ny; j++) {
        for (int i = 0; i < ny; i++) {
            at->y[0] = y[i];
            at->y[1] = y[j];
            at->height[0] = height[i];
            at->height[1] = height[j];
            const struct image_velocity one = far_velocity(at);
            double *const here = value + (size_t)(j * nx) * n + (size_t)(i * nx);
            here[0] = one.u;
            here[n * n] = one.v;
        }
    }
}

// fill the entries of smoothing e and cells at an offset of d
static void table_fill_offset(const struct table *table, int d, int e, double *value) {
    const size_t n = (size_t)n_of_cell(table);
    const double middle = (table->low + table->high) / 2, half = (table->high - table->low) / 2;
    struct entry at = {.width = image_rows_width(&table->channel), .square = middle + table->square.at[e] * half};

    for (int b = 0; b < table->x.n; b++) {
        for (int a = 0; a < table->x.n; a++) {
            at.x = (d + (table->x.at[a] - table->x.at[b]) / 2) * at.width;
            at.column = image_column_of(pi / at.width, at.x, at.square);
            table_fill_pairs(table, &at, value + (size_t)b * n + (size_t)a);
        }
    }
}

// extend the table to n_offsets offsets, one per cell
static enum status table_fill(struct table *table, int n_offsets, int threads) {
    const size_t n_values = (size_t)table->square.n * n_of_square(table);
    if (n_offsets > table->capacity) {
        TRY(MEMORY_RESIZE(table->value, (size_t)n_offsets * n_values, "images in a channel"));
        table->capacity = n_offsets;
    }

    const int n_squares = table->square.n, first = table->n_offsets * n_squares, end = n_offsets * n_squares;
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int i = first; i < end; i++) {
        table_fill_offset(table, i / n_squares, i % n_squares, table->value + (size_t)i * n_of_square(table));
    }

    if (n_offsets > table->n_offsets) table->n_offsets = n_offsets;
    return STATUS_OK;
}

static int has_values_of(const struct table *table, const struct table *other) {
    return table->value && !(fabs(table->channel.y[0] - other->channel.y[0]) > 0) &&
           !(fabs(table->channel.y[1] - other->channel.y[1]) > 0) && !(fabs(table->low - other->low) > 0) &&
           !(fabs(table->high - other->high) > 0) && table->x.n == other->x.n && table->square.n == other->square.n;
}

// the table of a channel and of a range of squared smoothings; the oldest table is replaced if none fits
static struct table *table_find(struct far_images *far, const struct walls *channel, const struct squares *squares,
                                double tolerance) {
    struct table wanted = {.channel = *channel, .low = squares->low, .high = squares->high};
    wanted.x.n = n_nodes(rho_x, tolerance);
    wanted.y.n = n_nodes(rho_y, tolerance);
    wanted.square.n = n_squares(wanted.low, wanted.high, image_rows_width(channel), tolerance);

    for (int i = 0; i < N_TABLES; i++) {
        if (has_values_of(&far->table[i], &wanted)) return &far->table[i];
    }

    nodes_set(&wanted.x, wanted.x.n);
    nodes_set(&wanted.y, wanted.y.n);
    nodes_set(&wanted.square, wanted.square.n);
    struct table *const table = &far->table[far->oldest];
    far->oldest = (far->oldest + 1) % N_TABLES;
    free(table->value);
    *table = wanted;

    return table;
}

enum status far_images_create(struct far_images **far) {
    return MEMORY_NEW(*far, 1, "images in a channel");
}

void far_images_free(struct far_images *far) {
    if (!far) return;
    for (int i = 0; i < N_TABLES; i++) free(far->table[i].value);
    free(far);
}

// ---- cells

static int cell_of(const struct cells *cells, double x) {
    return (int)(floor(x / cells->width) - cells->first);
}

// position of a point in the cell, from -1 to 1
static void cell_place(const struct cells *cells, int cell, double x, double y, double at[2]) {
    at[0] = 2 * (x / cells->width - (cells->first + cell)) - 1;
    at[1] = (y - cells->middle) / cells->half;
}

// extend ends to the range of n numbers; returns whether all numbers are finite
static int range_extend(int n, const double *x, double ends[2]) {
    for (int i = 0; i < n; i++) {
        if (!isfinite(x[i])) return 0;
        ends[0] = fmin(ends[0], x[i]);
        ends[1] = fmax(ends[1], x[i]);
    }
    return 1;
}

// n = 0: too many cells, or positions that are not finite
static struct cells cells_of(const struct walls *channel, const struct vortices *vortices, const struct induced *at) {
    const double width = image_rows_width(channel);
    struct cells cells = {.width = width, .middle = (channel->y[0] + channel->y[1]) / 2, .half = width / 2};
    double ends[2] = {INFINITY, -INFINITY};
    const int is_finite = range_extend(vortices->n, vortices->x, ends) && range_extend(at->n, at->x, ends);
    if (!is_finite || !(ends[1] - ends[0] < MAX_CELLS * width) || !(fabs(ends[0]) < 1e9 * width)) return cells;
    cells.first = (int)floor(ends[0] / width);
    cells.n = (int)floor(ends[1] / width) + 1 - cells.first;

    return cells;
}

int far_images_pay(const struct walls *channel, const struct vortices *vortices, double tolerance,
                   const struct induced *at) {
    const double interactions = (double)vortices->n * at->n;
    if (!(tolerance > 0) || interactions < MIN_INTERACTIONS) return 0;
    const struct cells cells = cells_of(channel, vortices, at);
    if (cells.n == 0) return 0;
    const struct squares squares = squares_of(vortices);
    const double n = n_nodes(rho_x, tolerance) * n_nodes(rho_y, tolerance);
    const double n_smoothings = n_squares(squares.low, squares.high, cells.width, tolerance);
    if (cells.n * n_smoothings * 2 * n * n * sizeof(double) > max_table) return 0;

    // costs in interactions of the direct sum; fitted to measurements
    const double points = (vortices->n * n_smoothings + 2.0 * at->n) * n / 40;
    const double pairs = (double)cells.n * cells.n * n_smoothings * n * n / 80;

    return points + pairs < interactions;
}

// from node values to coefficients of all pairs of polynomials: to = Y from X^T; transposed: with Y^T and X
static void nodes_transform(const struct table *table, int transposed, const double *from, double *to) {
    const int nx = table->x.n, ny = table->y.n;
    double half[MAX_NODES * MAX_NODES];
    for (int j = 0; j < ny; j++) {
        for (int k = 0; k < nx; k++) {
            double sum = 0;
            for (int b = 0; b < nx; b++) {
                sum += (transposed ? table->x.matrix[b][k] : table->x.matrix[k][b]) * from[j * nx + b];
            }
            half[j * nx + k] = sum;
        }
    }

    for (int l = 0; l < ny; l++) {
        for (int k = 0; k < nx; k++) {
            double sum = 0;
            for (int j = 0; j < ny; j++) {
                sum += (transposed ? table->y.matrix[j][l] : table->y.matrix[l][j]) * half[j * nx + k];
            }
            to[l * nx + k] = sum;
        }
    }
}

// interpolation weights of a squared smoothing at the smoothing nodes of the table
static void smoothing_share(const struct table *table, double square, double share[MAX_NODES]) {
    const int n = table->square.n;
    const double half = (table->high - table->low) / 2;
    double value[MAX_NODES];
    chebyshev_polynomials(n, half > 0 ? (square - (table->low + table->high) / 2) / half : 0, value, NULL);

    for (int e = 0; e < n; e++) {
        share[e] = 0;
        for (int m = 0; m < n; m++) share[e] += table->square.matrix[m][e] * value[m];
    }
}

// add the moments of vortex i: circulation times the polynomials at the position of the vortex
static void moments_add(const struct table *table, const struct cells *cells, const struct vortices *vortices, int i,
                        const double *share) {
    const int cell = cell_of(cells, vortices->x[i]), nx = table->x.n, ny = table->y.n, ns = table->square.n;
    double at[2], x[MAX_NODES], y[MAX_NODES];
    cell_place(cells, cell, vortices->x[i], vortices->y[i], at);
    chebyshev_polynomials(nx, at[0], x, NULL);
    chebyshev_polynomials(ny, at[1], y, NULL);

    for (int e = 0; e < ns; e++) {
        double *const moment = cells->weight + (size_t)(cell * ns + e) * (size_t)n_of_cell(table);
        const double circulation = share[e] * vortices->circulation[i];
        for (int j = 0; j < ny; j++) {
            const double part = circulation * y[j];
            for (int b = 0; b < nx; b++) moment[j * nx + b] += part * x[b];
        }
    }
}

// replace all vortices by vortices at the nodes of all cells
static void cells_gather(const struct table *table, const struct cells *cells, const struct vortices *all) {
    const size_t n = (size_t)n_of_cell(table);
    double share[MAX_NODES];
    for (int g = 0; g < all->n_groups; g++) {
        const struct vortex_group *const group = &all->group[g];
        smoothing_share(table, group->smoothing * group->smoothing, share);
        for (int i = group->at.first; i < group->at.first + group->at.n; i++) moments_add(table, cells, all, i, share);
    }

    for (int i = 0; i < cells->n * table->square.n; i++) {
        double moment[MAX_NODES * MAX_NODES];
        memcpy(moment, cells->weight + (size_t)i * n, n * sizeof *moment);
        nodes_transform(table, 1, moment, cells->weight + (size_t)i * n);
    }
}

// add the velocity from the nodes of a cell to the nodes of the cell at offset d >= 0; backward: at offset -d, mirrored
// in x
static void cell_add(const struct table *table, int d, int backward, const double *weight, double *velocity) {
    const int n = n_of_cell(table), nx = table->x.n;
    double sum[2][MAX_NODES * MAX_NODES] = {{0}};
    for (int e = 0; e < table->square.n; e++) {
        const double *const value = table->value + (size_t)(d * table->square.n + e) * n_of_square(table);
        for (int j = 0; j < n; j++) {
            // the nodes of a row are symmetric in x
            const int from = backward ? j / nx * nx + nx - 1 - j % nx : j;
            const double circulation = weight[e * n + from];
            const double *const u = value + (size_t)j * (size_t)n, *const v = u + (size_t)n * (size_t)n;
            for (int i = 0; i < n; i++) sum[0][i] += circulation * u[i];
            for (int i = 0; i < n; i++) sum[1][i] += circulation * v[i];
        }
    }

    for (int i = 0; i < n; i++) {
        const int to = backward ? i / nx * nx + nx - 1 - i % nx : i;
        velocity[to] += sum[0][i];
        velocity[n + to] += backward ? -sum[1][i] : sum[1][i];
    }
}

// velocity coefficients of all cells
static void cells_spread(const struct table *table, const struct cells *cells, int threads) {
    const size_t n = (size_t)n_of_cell(table);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int to = 0; to < cells->n; to++) {
        double velocity[2 * MAX_NODES * MAX_NODES] = {0};
        for (int from = 0; from < cells->n; from++) {
            const double *const weight = cells->weight + (size_t)(from * table->square.n) * n;
            cell_add(table, abs(to - from), to < from, weight, velocity);
        }

        for (size_t c = 0; c < 2; c++) {
            nodes_transform(table, 0, velocity + c * n, cells->velocity + ((size_t)to * 2 + c) * n);
        }
    }
}

// sum of coefficients times polynomials in y and x
static double polynomial_sum(const struct table *table, const double *coefficient, const double *y, const double *x) {
    double sum = 0;
    for (int j = 0; j < table->y.n; j++) {
        double row = 0;
        for (int b = 0; b < table->x.n; b++) row += coefficient[j * table->x.n + b] * x[b];
        sum += y[j] * row;
    }

    return sum;
}

static void cells_add_velocity(const struct table *table, const struct cells *cells, const struct induced *to) {
    const size_t n = (size_t)n_of_cell(table);
    for (int i = 0; i < to->n; i++) {
        const int cell = cell_of(cells, to->x[i]);
        const double *const u = cells->velocity + (size_t)cell * 2 * n, *const v = u + n;
        double at[2], x[MAX_NODES], y[MAX_NODES], by_x[MAX_NODES], by_y[MAX_NODES];
        cell_place(cells, cell, to->x[i], to->y[i], at);
        chebyshev_polynomials(table->x.n, at[0], x, by_x);
        chebyshev_polynomials(table->y.n, at[1], y, by_y);

        to->u[i] += polynomial_sum(table, u, y, x);
        to->v[i] += polynomial_sum(table, v, y, x);
        if (!to->u_x) continue;

        const double scale = 2 / cells->width;
        to->u_x[i] += scale * polynomial_sum(table, u, y, by_x);
        to->u_y[i] += scale * polynomial_sum(table, u, by_y, x);
        to->v_x[i] += scale * polynomial_sum(table, v, y, by_x);
    }
}

enum status far_images_induce(struct far_images *far, const struct walls *channel, const struct vortices *vortices,
                              double tolerance, int threads, const struct induced *at) {
    const struct squares squares = squares_of(vortices);
    struct cells cells = cells_of(channel, vortices, at);
    struct table *const table = table_find(far, channel, &squares, tolerance);
    TRY(table_fill(table, cells.n, threads));
    const size_t n_nodes_of_all = (size_t)cells.n * (size_t)n_of_cell(table);
    double *memory;
    TRY(MEMORY_NEW(memory, n_nodes_of_all * (size_t)(table->square.n + 2), "images in a channel"));
    cells.weight = memory;
    cells.velocity = memory + n_nodes_of_all * (size_t)table->square.n;
    cells_gather(table, &cells, vortices);
    cells_spread(table, &cells, threads);
    const int n_chunks = parallel_n_chunks(at->n);

#pragma omp parallel for num_threads(threads) schedule(static)
    for (int chunk = 0; chunk < n_chunks; chunk++) {
        const struct induced part = vortices_targets(at, parallel_chunk(chunk, at->n));
        cells_add_velocity(table, &cells, &part);
    }

    free(memory);
    return STATUS_OK;
}
