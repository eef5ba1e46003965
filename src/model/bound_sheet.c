/* bound_sheet.c: normal velocity zero at the control points, total circulation zero, smooth flow off the tail. */
#include "model/bound_sheet.h"

#include <math.h>

// the chord between two neighbouring bound vortices: its length, unit tangent and normal
struct chord {
    double length, t[2], n[2];
};

static struct chord chord_at(const struct fish *fish, int c, const double *y) {
    const double *const x = y + fish->at.x, *const z = y + fish->at.y;
    const struct stencil *a = &fish->sheet_point[c], *b = &fish->sheet_point[c + 1];
    const double e[2] = {fish_mean(b, x) - fish_mean(a, x), fish_mean(b, z) - fish_mean(a, z)};
    struct chord chord = {.length = sqrt(e[0] * e[0] + e[1] * e[1])};
    chord.t[0] = e[0] / chord.length;
    chord.t[1] = e[1] / chord.length;
    chord.n[0] = -chord.t[1];
    chord.n[1] = chord.t[0];
    return chord;
}

// add weight times the derivative of the chord's two ends with respect to the nodes
static void stamp_ends(const struct fish *fish, int c, int row, const double by_end[2], struct sparse *jacobian) {
    for (int end = 0; end < 2; end++) {
        const struct stencil *point = &fish->sheet_point[c + end];
        const double sign = end == 0 ? -1 : 1;
        for (int i = 0; i < point->n; i++) {
            sparse_add(jacobian, row, fish->at.x + point->node[i], sign * point->weight[i] * by_end[0]);
            sparse_add(jacobian, row, fish->at.y + point->node[i], sign * point->weight[i] * by_end[1]);
        }
    }
}

void bound_sheet_normal(const struct fish *fish, int c, const double *y, double normal[2]) {
    const struct chord chord = chord_at(fish, c, y);
    normal[0] = chord.n[0];
    normal[1] = chord.n[1];
}

double bound_sheet_circulation(const struct fish *fish, const double *y) {
    double sum = 0;
    for (int j = 0; j < fish->n_sheet; j++) sum += fish->sheet_weight[j] * y[fish->at.gamma + j];
    return sum;
}

void bound_sheet_residual(const struct fish *fish, double dissipated, const double *u, const double *v, const double *y,
                          double *residual) {
    double *const row = residual + fish->at.gamma;
    for (int c = 0; c < fish->n_control; c++) {
        const struct chord chord = chord_at(fish, c, y);
        const double slip[2] = {u[c] - fish_mean(&fish->control_point[c], y + fish->at.vx),
                                v[c] - fish_mean(&fish->control_point[c], y + fish->at.vy)};
        row[c] = slip[0] * chord.n[0] + slip[1] * chord.n[1];
    }
    row[fish->n_control] = bound_sheet_circulation(fish, y) + y[fish->at.circulation] - dissipated;
}

void bound_sheet_jacobian(const struct fish *fish, const double *u, const double *v, const double *y,
                          struct sparse *jacobian) {
    for (int c = 0; c < fish->n_control; c++) {
        const struct chord chord = chord_at(fish, c, y);
        const struct stencil *point = &fish->control_point[c];
        const int row = fish->at.gamma + c;
        const double slip[2] = {u[c] - fish_mean(point, y + fish->at.vx), v[c] - fish_mean(point, y + fish->at.vy)};
        for (int i = 0; i < point->n; i++) {
            sparse_add(jacobian, row, fish->at.vx + point->node[i], -point->weight[i] * chord.n[0]);
            sparse_add(jacobian, row, fish->at.vy + point->node[i], -point->weight[i] * chord.n[1]);
        }
        // the normal turns with the chord: dn = -t (n.de)/l
        const double turn = -(slip[0] * chord.t[0] + slip[1] * chord.t[1]) / chord.length;
        const double by_end[2] = {turn * chord.n[0], turn * chord.n[1]};
        stamp_ends(fish, c, row, by_end, jacobian);
    }
    const int kelvin = fish->at.gamma + fish->n_control;
    for (int j = 0; j < fish->n_sheet; j++) sparse_add(jacobian, kelvin, fish->at.gamma + j, fish->sheet_weight[j]);
    sparse_add(jacobian, kelvin, fish->at.circulation, 1);
}

void bound_sheet_flow_jacobian(const struct fish *fish, const struct influence_block *block, const double *y,
                               struct coupling_block *rows) {
    enum { CHUNK = 32 };  // normals at a time, so that the loop over them is the inner one
    double normal_x[CHUNK], normal_y[CHUNK];
    for (int first = 0; first < fish->n_control; first += CHUNK) {
        const int n = fish->n_control - first < CHUNK ? fish->n_control - first : CHUNK;
        for (int c = 0; c < n; c++) {
            const struct chord chord = chord_at(fish, first + c, y);
            normal_x[c] = chord.n[0];
            normal_y[c] = chord.n[1];
        }
        for (int i = 0; i < block->n_columns; i++) {
            const double *const u = block->u + (long)i * block->n_points + first;
            const double *const v = block->v + (long)i * block->n_points + first;
            double *const row = rows->value + (long)i * rows->n_rows + (fish->at.gamma - fish->at.ax) + first;
            for (int c = 0; c < n; c++) row[c] += normal_x[c] * u[c] + normal_y[c] * v[c];
        }
    }
}

// the fluid's velocity past the tail along the body
static double slip_along(const struct fish *fish, const struct chord *chord, const double *u, const double *v,
                         const double *y, double slip[2]) {
    const int p = flow_tail(fish), tail = fish->n_nodes - 1;
    slip[0] = u[p] - y[fish->at.vx + tail];
    slip[1] = v[p] - y[fish->at.vy + tail];
    return slip[0] * chord->t[0] + slip[1] * chord->t[1];
}

double bound_sheet_shedding_rate(const struct fish *fish, double chi, const double *u, const double *v,
                                 const double *y) {
    const struct chord chord = chord_at(fish, fish->n_control - 1, y);
    double slip[2];
    return chi * y[fish->at.gamma + fish->n_sheet - 1] * slip_along(fish, &chord, u, v, y, slip);
}

void bound_sheet_kutta_residual(const struct fish *fish, enum bound_sheet_law law, double chi, const double *u,
                                const double *v, const double *y, const double *yp, double *residual) {
    const int last = fish->n_sheet - 1;
    double value = yp[fish->at.circulation];
    switch (law) {
        case BOUND_SHEET_EDGE: value = fish->sheet_weight[last] * y[fish->at.gamma + last]; break;
        case BOUND_SHEET_RATE: value -= bound_sheet_shedding_rate(fish, chi, u, v, y); break;
        case BOUND_SHEET_FROZEN: break;
    }
    residual[fish->at.circulation] = value;
}

void bound_sheet_kutta_jacobian(const struct fish *fish, enum bound_sheet_law law, double chi, double cj,
                                const double *u, const double *v, const double *y, struct sparse *jacobian) {
    const int last = fish->n_sheet - 1, tail = fish->n_nodes - 1, row = fish->at.circulation;
    if (law == BOUND_SHEET_EDGE) {
        sparse_add(jacobian, row, fish->at.gamma + last, fish->sheet_weight[last]);
        return;
    }
    sparse_add(jacobian, row, fish->at.circulation, cj);
    if (law == BOUND_SHEET_FROZEN) return;
    const struct chord chord = chord_at(fish, fish->n_control - 1, y);
    double slip[2];
    const double along = slip_along(fish, &chord, u, v, y, slip);
    const double strength = chi * y[fish->at.gamma + last];
    sparse_add(jacobian, row, fish->at.gamma + last, -chi * along);
    sparse_add(jacobian, row, fish->at.vx + tail, strength * chord.t[0]);
    sparse_add(jacobian, row, fish->at.vy + tail, strength * chord.t[1]);
    // the tangent turns with the chord: dt = n (n.de)/l
    const double turn = -strength * (slip[0] * chord.n[0] + slip[1] * chord.n[1]) / chord.length;
    const double by_end[2] = {turn * chord.n[0], turn * chord.n[1]};
    stamp_ends(fish, fish->n_control - 1, row, by_end, jacobian);
}

void bound_sheet_kutta_flow_jacobian(const struct fish *fish, double chi, const struct influence_block *block,
                                     const double *y, struct coupling_block *rows) {
    const struct chord chord = chord_at(fish, fish->n_control - 1, y);
    const double strength = chi * y[fish->at.gamma + fish->n_sheet - 1];
    const double *const u = block->u + flow_tail(fish), *const v = block->v + flow_tail(fish);
    double *const row = rows->value + (fish->at.circulation - fish->at.ax);
    for (long i = 0; i < block->n_columns; i++) {
        row[i * rows->n_rows] -= strength * (chord.t[0] * u[i * block->n_points] + chord.t[1] * v[i * block->n_points]);
    }
}
