/* bound_sheet.c: impermeability, Kelvin's theorem and the Kutta condition, each with its derivatives below it. */
#include "force/bound_sheet.h"

#include <math.h>
#include <string.h>

#include "base/wide.h"

/* So many control points are evaluated at once. */
enum { CHUNK = 32 };

// add how a row changes with a tangent vector of the body, by the nodes of the two stencils of the vector
static void bound_sheet_tangent_jacobian(const struct fish *fish, const struct tangent *tangent, int row,
                                         const double by_vector[2], struct sparse *jacobian) {
    const struct stencil *const parts[2] = {&tangent->from, &tangent->to};
    for (int part = 0; part < 2; part++) {
        const struct stencil *const end = parts[part];
        const double sign = part == 0 ? -1 : 1;
        for (int i = 0; i < end->n; i++) {
            sparse_add(jacobian, row, fish->at.x + end->node[i], sign * end->weight[i] * by_vector[0]);
            sparse_add(jacobian, row, fish->at.y + end->node[i], sign * end->weight[i] * by_vector[1]);
        }
    }
}

double bound_sheet_strength(const struct fish *fish, int j, const double *y) {
    const struct stencil *const slope = &fish->sheet_slope[j];
    const double per_natural_length = y[fish->at.gamma + j];
    if (slope->n == 0) return per_natural_length;
    const double length = hypot(fish_mean(slope, y + fish->at.x), fish_mean(slope, y + fish->at.y));
    return per_natural_length * fish->edge_length / length;
}

double bound_sheet_circulation(const struct fish *fish, const double *y) {
    double sum = 0;
    for (int j = 0; j < fish->n_sheet; j++) sum += fish->sheet_weight[j] * y[fish->at.gamma + j];
    return sum;
}

double bound_sheet_end_correction(const struct fish *fish, int c, int j) {
    const int last = fish->n_sheet - 1;
    if (j < last - 1) return 0;
    return (j == last ? -2 : 1) * fish->end_correction[c] * fish->sheet_weight[j];
}

// set value at n <= CHUNK control points from the first on, by a matrix of fish.h
static WIDE(void, at_control_points,
            (const struct fish *fish, const double *matrix, const double *of_nodes, int first, int n,
             double *restrict value),
            (fish, matrix, of_nodes, first, n, value)) {
    memset(value, 0, CHUNK * sizeof *value);
    for (int k = 0; k < fish->n_nodes; k++) {
        const double *const weight = matrix + (long)k * fish->n_control + first;
        for (int c = 0; c < n; c++) value[c] += weight[c] * of_nodes[k];
    }
}

static void control_normals(const struct fish *fish, const double *y, int first, int n, double normal[2][CHUNK]) {
    double along[2][CHUNK];
    at_control_points(fish, fish->control_by_node[1], y + fish->at.x, first, n, along[0]);
    at_control_points(fish, fish->control_by_node[1], y + fish->at.y, first, n, along[1]);
    for (int c = 0; c < n; c++) {
        const double length = sqrt(along[0][c] * along[0][c] + along[1][c] * along[1][c]);
        normal[0][c] = -along[1][c] / length;
        normal[1][c] = along[0][c] / length;
    }
}

void bound_sheet_residual(const struct fish *fish, double removed, const double *u, const double *v, const double *y,
                          double *residual) {
    double *const row = residual + fish->at.gamma;

    for (int first = 0; first < fish->n_control; first += CHUNK) {
        const int n = fish->n_control - first < CHUNK ? fish->n_control - first : CHUNK;
        double normal[2][CHUNK], vx[CHUNK], vy[CHUNK];
        control_normals(fish, y, first, n, normal);
        at_control_points(fish, fish->control_by_node[0], y + fish->at.vx, first, n, vx);
        at_control_points(fish, fish->control_by_node[0], y + fish->at.vy, first, n, vy);
        for (int c = 0; c < n; c++) {
            double *const to = &row[first + c];
            *to = (u[first + c] - vx[c]) * normal[0][c] + (v[first + c] - vy[c]) * normal[1][c];
            for (int j = fish->n_sheet - 2; j < fish->n_sheet; j++) {
                *to += bound_sheet_end_correction(fish, first + c, j) * y[fish->at.gamma + j];
            }
        }
    }

    row[fish->n_control] = bound_sheet_circulation(fish, y) + y[fish->at.circulation] - removed;
}

void bound_sheet_jacobian(const struct fish *fish, const double *u, const double *v, const double *y,
                          struct sparse *jacobian) {
    for (int c = 0; c < fish->n_control; c++) {
        const struct direction body = fish_direction(fish, &fish->control_tangent[c], y);
        const struct stencil *point = &fish->control_point[c];
        const int row = fish->at.gamma + c;
        const double slip[2] = {u[c] - fish_mean(point, y + fish->at.vx), v[c] - fish_mean(point, y + fish->at.vy)};

        // by the velocities of the nodes, and by the strengths next to the tail
        for (int i = 0; i < point->n; i++) {
            sparse_add(jacobian, row, fish->at.vx + point->node[i], -point->weight[i] * body.n[0]);
            sparse_add(jacobian, row, fish->at.vy + point->node[i], -point->weight[i] * body.n[1]);
        }

        for (int j = fish->n_sheet - 2; j < fish->n_sheet; j++) {
            sparse_add(jacobian, row, fish->at.gamma + j, bound_sheet_end_correction(fish, c, j));
        }

        // the normal turns with the tangent vector e: dn = -t (n.de)/|e|
        const double turn = -(slip[0] * body.t[0] + slip[1] * body.t[1]) / body.length;
        const double by_vector[2] = {turn * body.n[0], turn * body.n[1]};
        bound_sheet_tangent_jacobian(fish, &fish->control_tangent[c], row, by_vector, jacobian);
    }

    const int kelvin = fish->at.gamma + fish->n_control;
    for (int j = 0; j < fish->n_sheet; j++) sparse_add(jacobian, kelvin, fish->at.gamma + j, fish->sheet_weight[j]);
    sparse_add(jacobian, kelvin, fish->at.circulation, 1);
}

void bound_sheet_flow_jacobian(const struct fish *fish, const struct influence_block *block, const double *y,
                               struct coupling_block *rows) {
    double normal[2][CHUNK];
    for (int first = 0; first < fish->n_control; first += CHUNK) {
        const int n = fish->n_control - first < CHUNK ? fish->n_control - first : CHUNK;
        control_normals(fish, y, first, n, normal);
        for (int i = 0; i < block->n_columns; i++) {
            const double *const u = block->u + (long)i * block->n_points + first;
            const double *const v = block->v + (long)i * block->n_points + first;
            double *const row = rows->value + (long)i * rows->n_rows + (fish->at.gamma - fish->at.ax) + first;
            for (int c = 0; c < n; c++) row[c] += normal[0][c] * u[c] + normal[1][c] * v[c];
        }
    }
}

// find the velocity of the fluid relative to the tail (slip); returns its tangential component
static double tail_slip_along(const struct fish *fish, const struct direction *body, const double *u, const double *v,
                              const double *y, double slip[2]) {
    const int p = flow_tail(fish), tail = fish->n_nodes - 1;
    slip[0] = u[p] - y[fish->at.vx + tail];
    slip[1] = v[p] - y[fish->at.vy + tail];
    return slip[0] * body->t[0] + slip[1] * body->t[1];
}

double bound_sheet_shedding_rate(const struct fish *fish, const double *u, const double *v, const double *y) {
    const struct direction body = fish_direction(fish, &fish->tail_tangent, y);
    double slip[2];
    return y[fish->at.gamma + fish->n_sheet - 1] * tail_slip_along(fish, &body, u, v, y, slip);
}

void bound_sheet_kutta_residual(const struct fish *fish, enum bound_sheet_law law, const double *u, const double *v,
                                const double *y, const double *yp, double *residual) {
    const int last = fish->n_sheet - 1;
    double value = yp[fish->at.circulation];
    switch (law) {
        case BOUND_SHEET_EDGE: value = fish->sheet_weight[last] * y[fish->at.gamma + last]; break;
        case BOUND_SHEET_RATE: value -= bound_sheet_shedding_rate(fish, u, v, y); break;
        case BOUND_SHEET_FROZEN: break;
    }

    residual[fish->at.circulation] = value;
}

void bound_sheet_kutta_jacobian(const struct fish *fish, enum bound_sheet_law law, double cj, const double *u,
                                const double *v, const double *y, struct sparse *jacobian) {
    const int last = fish->n_sheet - 1, tail = fish->n_nodes - 1, row = fish->at.circulation;
    if (law == BOUND_SHEET_EDGE) {
        sparse_add(jacobian, row, fish->at.gamma + last, fish->sheet_weight[last]);
        return;
    }

    sparse_add(jacobian, row, fish->at.circulation, cj);
    if (law == BOUND_SHEET_FROZEN) return;

    const struct direction body = fish_direction(fish, &fish->tail_tangent, y);
    double slip[2];
    const double along = tail_slip_along(fish, &body, u, v, y, slip);
    const double strength = y[fish->at.gamma + last];

    sparse_add(jacobian, row, fish->at.gamma + last, -along);
    sparse_add(jacobian, row, fish->at.vx + tail, strength * body.t[0]);
    sparse_add(jacobian, row, fish->at.vy + tail, strength * body.t[1]);

    // the tangent turns with the tangent vector e: dt = n (n.de)/|e|
    const double turn = -strength * (slip[0] * body.n[0] + slip[1] * body.n[1]) / body.length;
    const double by_vector[2] = {turn * body.n[0], turn * body.n[1]};
    bound_sheet_tangent_jacobian(fish, &fish->tail_tangent, row, by_vector, jacobian);
}

void bound_sheet_kutta_flow_jacobian(const struct fish *fish, const struct influence_block *block, const double *y,
                                     struct coupling_block *rows) {
    const struct direction body = fish_direction(fish, &fish->tail_tangent, y);
    const double strength = y[fish->at.gamma + fish->n_sheet - 1];
    const double *const u = block->u + flow_tail(fish), *const v = block->v + flow_tail(fish);
    double *const row = rows->value + (fish->at.circulation - fish->at.ax);

    for (long i = 0; i < block->n_columns; i++) {
        row[i * rows->n_rows] -= strength * (body.t[0] * u[i * block->n_points] + body.t[1] * v[i * block->n_points]);
    }
}
