/* pressure.c: the added momentum and how it rotates, convection along the sheet, and suction, with the derivatives of
 * each. The force model that these make is at the end. */
#include "force/pressure.h"

#include <math.h>
#include <string.h>

#include "base/wide.h"
#include "body/rod.h"
#include "fish/fish_motion.h"
#include "fish/fish_sheet.h"
#include "force/edge_force.h"
#include "force/force_model.h"
#include "state/impulse.h"

/* What is evaluated at the control points by full matrices: X' in x and y, velocity in x and y, circulation of the
 * interval, and circulation between nose and point. */
enum { LINE, VELOCITY = 2, AROUND = 4, BEFORE, N_AT_POINTS };

static void pressure_create(struct arena *arena, struct fluid_force *force) {
    const struct fish *const fish = force->fish;
    const int n = fish->n_nodes, n_control = fish->n_control;
    struct pressure *created;
    NEW(arena, created, 1);
    created->arena = arena;
    created->fish = fish;
    force->pressure = created;
    created->momentum = force->momentum;
    NEW(arena, created->momentum_rate, 2 * n);
    NEW(arena, created->force, 2 * n);
    struct pressure_matrix *const matrices[] = {&created->matrix, &created->rate};
    for (int i = 0; i < 2; i++) {
        NEW(arena, matrices[i]->circulation, fish->n_sheet);
        NEW(arena, matrices[i]->value, n * n);
        if (fish->n_sensors > 0) NEW(arena, created->sensor[i], fish->n_sensors);
    }
    NEW(arena, created->point, n_control);
    NEW(arena, created->product, 2 * n);
    NEW(arena, created->parts, 4 * n);
    NEW(arena, created->at_points, N_AT_POINTS * n_control);
    NEW(arena, created->spread, 2 * n_control);
    const long n_input = 4L * n + fish->n_sheet + 5L * n_control;
    NEW(arena, created->input.last, n_input);
    NEW(arena, created->input.next, n_input);

    NEW(arena, created->share, n_control * n);
    for (int c = 0; c < n_control; c++) {
        for (int k = 0; k < n; k++) created->share[c * n + k] = fish->control_point[c].weight[k] / fish->mass[k];
    }
}

// R is the sum over j of P_j times the circulation of vortex j. strength: the unknowns, or their rates. If the
// circulations are the same as before, R is kept. Returns whether it is new.
static bool pressure_find_matrix(struct pressure *p, const double *strength, struct pressure_matrix *to) {
    const struct fish *const fish = p->fish;
    bool is_new = false;
    for (int j = 0; j < fish->n_sheet; j++) {
        const double circulation = fish->sheet_weight[j] * strength[fish->at.gamma + j];
        is_new |= !(fabs(circulation - to->circulation[j]) <= 0);
        to->circulation[j] = circulation;
    }

    if (is_new) sheet_integrals_matrix(fish->integrals, to->circulation, p->parts, to->value);
    return is_new;
}

// add E3 R x to the pairs of all nodes; in x, too, all x components come first
static void pressure_add_product(struct pressure *p, const struct pressure_matrix *matrix, const double *x,
                                 double *to) {
    const int n = p->fish->n_nodes;
    wide_product(n, n, matrix->value, x + n, p->product);
    for (int k = 0; k < n; k++) to[k] -= p->product[k];
    wide_multiply(n, n, matrix->value, x, to + n);
}

// tau, the tangential velocity of the fluid relative to the body
static double slip_along(const struct pressure_point *point) {
    return edge_dot(point->slip, point->body.t);
}

// add forces at the control points, x then y, to the rows ax, ay of all nodes, as forces per mass
static void spread_forces(const struct pressure *p, double *column) {
    const int n = p->fish->n_nodes, n_control = p->fish->n_control;
    wide_multiply(n, n_control, p->share, p->spread, column);
    wide_multiply(n, n_control, p->share, p->spread + n_control, column + n);
}

// Add the forces that act at the control points: convection, and with rings the spanwise flow and the force along the
// side edges (doc/model.md, sections 15 and 18).
static void pressure_convect(struct pressure *p, const struct flow_at_body *flow, const double *y) {
    const struct fish *fish = p->fish;
    const int n = fish->n_nodes, n_control = fish->n_control;

    // values at all control points, with rings also the circulation before each of them
    double *const at = p->at_points;
    for (int i = 0; i < 2; i++) {
        wide_product(n_control, n, fish->control_by_node[1], y + fish->at.x + i * n, at + (LINE + i) * n_control);
        wide_product(n_control, n, fish->control_by_node[0], y + fish->at.vx + i * n, at + (VELOCITY + i) * n_control);
    }
    const struct sheet_integrals *const integrals = fish->integrals;
    const double *const q = p->matrix.circulation;
    wide_product(n_control, fish->n_sheet, integrals->strength, q, at + AROUND * n_control);
    if (fish->strip_depth > 0)
        wide_product(n_control, fish->n_sheet, integrals->circulation, q, at + BEFORE * n_control);

    double *const x = p->spread, *const z = p->spread + n_control;
    for (int c = 0; c < n_control; c++) {
        struct pressure_point *const point = &p->point[c];
        const double *const value = at + c;
        point->body = fish_direction_of((const double[2]){value[LINE * n_control], value[(LINE + 1) * n_control]});
        point->slip[0] = flow->u[c] - value[VELOCITY * n_control];
        point->slip[1] = flow->v[c] - value[(VELOCITY + 1) * n_control];
        point->circulation = value[AROUND * n_control];
        point->strength = fish->control_density[c] * point->circulation;

        // convection: -rho w gamma tau n
        const double size = -point->strength * slip_along(point);
        x[c] = size * point->body.n[0];
        z[c] = size * point->body.n[1];
        if (!flow->div) continue;

        // force of the spanwise flow, and force along the side edges
        const double length = point->body.length * fish->control_interval[c];
        const double widening = fish->control_widening[c] * fish->control_interval[c];
        point->before = fish->control_density[c] * at[BEFORE * n_control + c];
        point->divergence = flow->div[c];
        for (int i = 0; i < 2; i++) point->edge[i] = widening * flow->edge[i * flow->edge_stride + c];
        x[c] += point->before * (point->edge[0] - point->divergence * length * point->body.n[0]);
        z[c] += point->before * (point->edge[1] - point->divergence * length * point->body.n[1]);
    }

    memset(p->parts, 0, 2 * (size_t)n * sizeof *p->parts);
    spread_forces(p, p->parts);
    for (int i = 0; i < 2 * n; i++) p->force[i] += fish->mass[i % n] * p->parts[i];
}

// a smooth minimum, full bound/(full^4 + bound^4)^(1/4), from the ratio of the smaller to the larger
struct suction_law pressure_suction_law(double full, double bound) {
    const double least = fmin(full, bound), most = fmax(full, bound);
    const double ratio = most > 0 ? least / most : 0, fourth = ratio * ratio * ratio * ratio;
    const double share = 1 / sqrt(sqrt(1 + fourth)), by_least = share / (1 + fourth),
                 by_most = by_least * fourth * ratio;
    const bool is_attached = full <= bound;

    return (struct suction_law){.value = least * share,
                                .by_full = is_attached ? by_least : by_most,
                                .by_bound = is_attached ? by_most : by_least};
}

static void input_add(struct pressure_input *input, const double *value, int n) {
    memcpy(input->next + input->n, value, (size_t)n * sizeof *value);
    input->n += (size_t)n;
}

// take the values that an update depends on; whether they differ from those of the last update
static bool input_is_new(struct pressure_input *input, const struct fish *fish, const struct flow_at_body *flow,
                         const double *y) {
    const size_t n_before = input->n;
    const int n_control = fish->n_control;
    input->n = 0;
    input_add(input, y + fish->at.x, 2 * fish->n_nodes);
    input_add(input, y + fish->at.vx, 2 * fish->n_nodes);
    input_add(input, y + fish->at.gamma, fish->n_sheet);
    input_add(input, flow->u, n_control);
    input_add(input, flow->v, n_control);
    if (flow->div) {
        input_add(input, flow->div, n_control);
        for (int i = 0; i < 2; i++) input_add(input, flow->edge + i * flow->edge_stride, n_control);
    }

    const bool is_same =
        input->exists && input->n == n_before && memcmp(input->next, input->last, input->n * sizeof *input->next) == 0;
    double *const next = input->next;
    input->next = input->last;
    input->last = next;
    input->exists = true;
    return !is_same;
}

void pressure_update(struct pressure *p, const struct flow_at_body *flow, const double *y) {
    const struct fish *fish = p->fish;
    if (!input_is_new(&p->input, fish, flow, y)) return;
    p->has_rate = false;
    const size_t size = 2 * (size_t)fish->n_nodes * sizeof *p->momentum;
    pressure_find_matrix(p, y, &p->matrix);
    memset(p->momentum, 0, size);
    memset(p->force, 0, size);
    pressure_add_product(p, &p->matrix, y + fish->at.x, p->momentum);
    pressure_add_product(p, &p->matrix, y + fish->at.vx, p->force);
    pressure_convect(p, flow, y);

    // the suction on the nose, and how much of the attached suction separation takes away
    const double strength = fish->nose_factor * y[fish->at.gamma], full = strength * strength;
    const double square = fish->suction_limit * fish->suction_limit, tau = slip_along(&p->point[0]);
    const struct suction_law law =
        square > 0 ? pressure_suction_law(full, square * tau * tau) : (struct suction_law){full, 1, 0};
    p->nose = fish_direction(fish, &fish->nose_tangent, y);
    p->by_strength = fish->suction * law.by_full * 2 * strength * fish->nose_factor;
    p->by_slip = fish->suction * law.by_bound * 2 * square * tau;
    for (int i = 0; i < 2; i++) {
        p->suction[i] = -fish->suction * law.value * p->nose.t[i];
        p->separation[i] = -fish->full_suction * full * p->nose.t[i] - p->suction[i];
    }
}

double pressure_momentum_ratio(const struct fish *fish, int k) {
    const double at_nose = fish->control_density[0], at_tail = fish->control_density[fish->n_control - 1];
    const double per_area = M_PI / 4 * fmax(at_nose, at_tail);
    return 1 + per_area * fish->length * fish->edge_length / fish->mass[k];
}

int pressure_momentum_row(const struct fish *fish, bool at_start, int i, int k) {
    const bool is_given = at_start || fish_is_prescribed(fish, k, i);
    return (is_given ? fish->at.px : fish->at.vx) + i * fish->n_nodes + k;
}

// The relation of p, v and I goes into one of the two rows of a component. The other one says dp/dt = a, or nothing
// where v is given.
static void pressure_motion_residual(const struct fluid_force *force, bool at_start, const double *y, const double *yp,
                                     double *residual) {
    const struct fish *const fish = force->fish;
    const struct layout *const at = &fish->at;
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < fish->n_nodes; k++) {
            const int node = i * fish->n_nodes + k, row = pressure_momentum_row(fish, at_start, i, k);
            residual[row] = y[at->px + node] - y[at->vx + node] - force->momentum[node] / fish->mass[k];
            if (row < at->px) {
                residual[at->px + node] = yp[at->px + node] - y[at->ax + node];
            } else if (!fish_is_prescribed(fish, k, i)) {
                residual[at->vx + node] = 0;
            }
        }
    }
}

static void pressure_residual(const struct fluid_force *force, const struct flow_at_body *flow, const double *y,
                              double *residual) {
    const struct pressure *const p = force->pressure;
    const struct fish *const fish = force->fish;
    edge_force_residual(force, flow, y, residual);
    for (int i = 0; i < 2 * fish->n_nodes; i++) residual[fish->at.ax + i] -= p->force[i];
    residual[fish->at.ax] -= p->suction[0];
    residual[fish->at.ay] -= p->suction[1];
}

static void pressure_momentum_by_strength(const struct fish *fish, int j, const double *x, double *momentum) {
    const int n = fish->n_nodes;
    sheet_integrals_product(fish->integrals, j, x, x + n, momentum + n, momentum);
    for (int k = 0; k < n; k++) {
        momentum[k] *= -fish->sheet_weight[j];
        momentum[n + k] *= fish->sheet_weight[j];
    }
}

static void pressure_motion_jacobian(const struct fluid_force *force, bool at_start, double cj, const double *y,
                                     struct sparse *jacobian) {
    struct pressure *const p = force->pressure;
    const struct fish *const fish = force->fish;
    const int n = fish->n_nodes;
    for (int k = 0; k < n; k++) {
        for (int i = 0; i < 2; i++) {
            const int row = pressure_momentum_row(fish, at_start, i, k), node = i * n + k, other = (1 - i) * n;
            const double sign = (i == 0 ? 1 : -1) / fish->mass[k];  // -E3 per mass
            sparse_add(jacobian, row, fish->at.px + node, 1);
            sparse_add(jacobian, row, fish->at.vx + node, -1);

            // by the positions
            for (int m = 0; m < n; m++) {
                sparse_add(jacobian, row, fish->at.x + other + m, sign * p->matrix.value[m * n + k]);
            }

            // dp/dt = a
            if (row >= fish->at.px) continue;
            sparse_add(jacobian, fish->at.px + node, fish->at.px + node, cj);
            sparse_add(jacobian, fish->at.px + node, fish->at.ax + node, -1);
        }
    }

    // by the strengths
    for (int j = 0; j < fish->n_sheet; j++) {
        pressure_momentum_by_strength(fish, j, y + fish->at.x, p->product);
        for (int i = 0; i < 2; i++) {
            for (int k = 0; k < n; k++) {
                sparse_add(jacobian, pressure_momentum_row(fish, at_start, i, k), fish->at.gamma + j,
                           -p->product[i * n + k] / fish->mass[k]);
            }
        }
    }
}

static void pressure_jacobian(const struct fluid_force *force, const struct flow_at_body *flow, const double *y,
                              struct sparse *jacobian) {
    const struct pressure *const p = force->pressure;
    const struct fish *const fish = force->fish;
    edge_force_jacobian(force, flow, y, jacobian);
    const struct direction *const first = &p->point[0].body;
    const int n = fish->n_nodes, n_control = fish->n_control;
    double *const column = p->parts;

    for (int m = 0; m < 2 * n; m++) {
        // convection: n t at every control point
        const int j = m / n;
        const double *const weight = fish->control_by_node[0] + (long)(m % n) * n_control;
        for (int c = 0; c < n_control; c++) {
            const struct direction *const body = &p->point[c].body;
            const double factor = weight[c] * p->point[c].strength * body->t[j];
            p->spread[c] = -factor * body->n[0];
            p->spread[n_control + c] = -factor * body->n[1];
        }
        memset(column, 0, 2 * (size_t)n * sizeof *column);
        spread_forces(p, column);

        // rotation: -E3; suction: through tau
        const double *const rotation = p->matrix.value + (long)(m % n) * n;
        for (int k = 0; k < n; k++) column[(1 - j) * n + k] += (j == 0 ? -1 : 1) * rotation[k] / fish->mass[k];
        for (int i = 0; i < 2; i++)
            column[i * n] -= p->by_slip * p->nose.t[i] * first->t[j] * weight[0] / fish->mass[0];
        for (int i = 0; i < 2 * n; i++) sparse_add(jacobian, fish->at.ax + i, fish->at.vx + m, column[i]);
    }
}

static void pressure_own_jacobian(const struct fluid_force *force, const double *y, struct coupling_block *rows) {
    const struct pressure *const p = force->pressure;
    const struct fish *const fish = force->fish;
    const int n = fish->n_nodes, n_control = fish->n_control;
    double *const at_point[2] = {p->spread, p->spread + n_control};

    // By the positions. Convection changes because the tangent turns with X', dt = n (n.dX')/|X'|, dn = -t
    // (n.dX')/|X'|. The spanwise flow changes because E3 dx_c is linear in the positions.
    for (int m = 0; m < 2 * n; m++) {
        const int i = m / n;
        const double *const slope = fish->control_by_node[1] + (long)(m % n) * n_control;
        for (int c = 0; c < n_control; c++) {
            const struct pressure_point *const point = &p->point[c];
            const struct direction *const body = &point->body;
            const double across = edge_dot(point->slip, body->n), tau = slip_along(point);
            const double turn = point->strength / body->length * body->n[i] * slope[c];
            at_point[0][c] = turn * (across * body->n[0] - tau * body->t[0]);
            at_point[1][c] = turn * (across * body->n[1] - tau * body->t[1]);
            if (!(fish->strip_depth > 0)) continue;
            const double span = point->before * point->divergence * fish->control_interval[c] * slope[c];
            at_point[0][c] -= i == 1 ? span : 0;
            at_point[1][c] += i == 0 ? span : 0;
        }
        spread_forces(p, rows->value + (long)m * rows->n_rows);
    }

    // suction changes with the strength and the tangent at the nose, and through tau with the tangent at control point
    // 0
    const struct direction *const nose = &p->nose, *const first = &p->point[0].body;
    const double *const turn = fish->nose_tangent.to.weight, *const turn_first = fish->control_tangent[0].to.weight;
    const double suction = -edge_dot(p->suction, nose->t), slip_across = edge_dot(p->point[0].slip, first->n);
    for (int i = 0; i < 2; i++) {
        rows->value[2L * n * rows->n_rows + i * n] += p->by_strength * nose->t[i] / fish->mass[0];
        const double by_turn = suction * nose->n[i] / nose->length / fish->mass[0];
        const double by_slip = p->by_slip * nose->t[i] / fish->mass[0] * slip_across / first->length;
        for (long m = 0; m < 2 * n; m++) {
            rows->value[m * rows->n_rows + i * n] +=
                by_turn * nose->n[m / n] * turn[m % n] + by_slip * first->n[m / n] * turn_first[m % n];
        }
    }

    // by the strengths: convection and spanwise flow, then rotation of the momentum
    for (int j = 0; j < fish->n_sheet; j++) {
        double *const column = rows->value + (long)(2 * n + j) * rows->n_rows;
        for (int c = 0; c < n_control; c++) {
            const struct pressure_point *const point = &p->point[c];
            const double size = fish->control_density[c] * fish->integrals->strength[(long)j * n_control + c] *
                                fish->sheet_weight[j] * slip_along(point);
            at_point[0][c] = size * point->body.n[0];
            at_point[1][c] = size * point->body.n[1];
            if (!(fish->strip_depth > 0)) continue;
            const double before = fish->control_density[c] * fish->sheet_weight[j] *
                                  fish->integrals->circulation[(long)j * n_control + c];
            const double across = before * point->divergence * point->body.length * fish->control_interval[c];
            at_point[0][c] += across * point->body.n[0] - before * point->edge[0];
            at_point[1][c] += across * point->body.n[1] - before * point->edge[1];
        }
        spread_forces(p, column);

        pressure_momentum_by_strength(fish, j, y + fish->at.vx, p->product);
        for (int i = 0; i < 2 * n; i++) column[i] -= p->product[i] / fish->mass[i % n];
    }
}

static void pressure_flow_jacobian(const struct fluid_force *force, const struct flow_at_body *flow,
                                   const struct influence_block *block, const double *y, struct coupling_block *rows) {
    const struct pressure *const p = force->pressure;
    const struct fish *const fish = force->fish;
    edge_force_flow_jacobian(force, flow, block, y, rows);
    const struct direction *const first = &p->point[0].body;
    for (long m = 0; m < block->n_columns; m++) {
        const double *const u = block->u + m * block->n_points, *const v = block->v + m * block->n_points;
        for (int c = 0; c < fish->n_control; c++) {
            const struct direction *const body = &p->point[c].body;
            const double size = p->point[c].strength * (body->t[0] * u[c] + body->t[1] * v[c]);
            p->spread[c] = size * body->n[0];
            p->spread[fish->n_control + c] = size * body->n[1];
        }

        // spanwise flow and force along the side edges
        const double *const div = block->div ? block->div + m * block->n_points : NULL;
        const double *const edge = fish->depth_varies && block->edge ? block->edge + m * block->n_points : NULL;
        for (int c = 0; div && c < fish->n_control; c++) {
            const struct pressure_point *const point = &p->point[c];
            const double across = point->before * div[c] * point->body.length * fish->control_interval[c];
            double *const along_x = p->spread + c, *const along_y = along_x + fish->n_control;
            *along_x += across * point->body.n[0];
            *along_y += across * point->body.n[1];
            if (!edge) continue;
            const double widening = point->before * fish->control_widening[c] * fish->control_interval[c];
            *along_x -= widening * edge[c];
            *along_y -= widening * edge[(long)block->n_columns * block->n_points + c];
        }
        spread_forces(p, rows->value + m * rows->n_rows);

        // suction, through tau
        const double by_slip = p->by_slip * (first->t[0] * u[0] + first->t[1] * v[0]) / fish->mass[0];
        for (int i = 0; i < 2; i++) rows->value[m * rows->n_rows + i * fish->n_nodes] += by_slip * p->nose.t[i];
    }
}

void pressure_update_rate(struct pressure *p, const double *y, const double *yp) {
    const struct fish *fish = p->fish;
    const bool is_new = pressure_find_matrix(p, yp, &p->rate);
    if (p->has_rate && !is_new) return;
    p->has_rate = true;
    memset(p->momentum_rate, 0, 2 * (size_t)fish->n_nodes * sizeof *p->momentum_rate);
    pressure_add_product(p, &p->matrix, y + fish->at.vx, p->momentum_rate);
    pressure_add_product(p, &p->rate, y + fish->at.x, p->momentum_rate);
}

// the amplitude of the kink of the sheet at the tail, from the strengths or from their rates
static double tail_kink(const struct fish *fish, const double *y) {
    const int last = fish->n_sheet - 1;
    const double *const strength = y + fish->at.gamma;
    return fish->sheet_weight[last - 1] * strength[last - 1] - 2 * fish->sheet_weight[last] * strength[last];
}

double pressure_strip_depth_at(const struct fish *fish, int c) {
    return 4 * sqrt(2 * fish->point_half[c]);
}

struct pressure_sheet pressure_sheet_at(const struct pressure *p, int c, const double *y, const double *yp) {
    const struct fish *fish = p->fish;
    const double *const circulation = fish->integrals->circulation + c;
    const struct pressure_point *const point = &p->point[c];

    // the interval around the control point, which holds the circulation of the point
    const double length = point->body.length * fish->control_interval[c];
    double rate = fish->integrals->kink_circulation[c] * tail_kink(fish, yp);

    for (int j = 0; j < fish->n_sheet; j++) {
        rate += circulation[j * fish->n_control] * fish->sheet_weight[j] * yp[fish->at.gamma + j];
    }

    const double around = point->circulation + fish->integrals->kink_strength[c] * tail_kink(fish, y);
    struct pressure_sheet sheet = {rate, around / length, slip_along(point), 0};
    if (!(fish->strip_depth > 0)) return sheet;
    const double before =
        point->before / fish->control_density[c] + fish->integrals->kink_circulation[c] * tail_kink(fish, y);
    sheet.spanwise = before * point->divergence;
    return sheet;
}

double pressure_jump(const struct pressure *p, int c, const double *y, const double *yp) {
    const struct fish *fish = p->fish;
    const struct pressure_sheet sheet = pressure_sheet_at(p, c, y, yp);
    const double jump = sheet.rate + sheet.strength * sheet.slip;
    if (!(fish->strip_depth > 0)) return fish->fluid_density * jump;
    return fish->fluid_density * fish->strip_depth / pressure_strip_depth_at(fish, c) * (jump + sheet.spanwise);
}

void pressure_of_edge(const struct pressure *p, int k, const double *y, const double *yp, double force[2]) {
    const struct fish *fish = p->fish;
    force[0] = force[1] = 0;
    for (int c = 0; c < fish->n_control; c++) {
        if ((int)(fish_sheet_place(fish, c + 0.5) * fish->n_edges) != k) continue;

        const struct direction *const body = &p->point[c].body;
        const double length = body->length * fish->control_interval[c];
        const double depth = fish->strip_depth > 0 ? pressure_strip_depth_at(fish, c) : fish->depth[k];
        const double size = -depth * pressure_jump(p, c, y, yp) * length;
        for (int i = 0; i < 2; i++) force[i] += size * body->n[i];
    }
}

struct pressure_forces pressure_sum(const struct pressure *p, const double about[2], const double *y) {
    const struct fish *fish = p->fish;
    const int n = fish->n_nodes;
    const double tau = slip_along(&p->point[0]), strength = fish->nose_factor * y[fish->at.gamma];
    struct pressure_forces sum = {.leading_edge_a0 = fabs(tau) > 0 ? strength / tau : NAN};

    for (int k = 0; k < n; k++) {
        const double arm[2] = {y[fish->at.x + k] - about[0], y[fish->at.y + k] - about[1]};
        const double velocity[2] = {y[fish->at.vx + k], y[fish->at.vy + k]};
        const double momentum[2] = {p->momentum[k], p->momentum[n + k]};
        const double force[2] = {p->force[k] - p->momentum_rate[k], p->force[n + k] - p->momentum_rate[n + k]};

        for (int i = 0; i < 2; i++) {
            sum.pressure[i] += force[i];
            sum.momentum[i] += momentum[i];
        }

        sum.pressure_moment += edge_cross(arm, force);
        sum.momentum_moment += edge_cross(arm, momentum);
        sum.pressure_power += edge_dot(force, velocity);
        if (k > 0) continue;
        sum.suction_moment = edge_cross(arm, p->suction);
        sum.suction_power = edge_dot(p->suction, velocity);
        sum.separation_power = edge_dot(p->separation, velocity);
    }

    for (int i = 0; i < 2; i++) {
        sum.suction[i] = p->suction[i];
        sum.separation[i] = p->separation[i];
    }

    return sum;
}

// ---- the force model

static void pressure_update_all(const struct fluid_force *force, const struct flow_at_body *flow, const double *y,
                                const double *yp) {
    pressure_update(force->pressure, flow, y);
    if (yp) pressure_update_rate(force->pressure, y, yp);
}

static void pressure_add_momentum_rate(const struct fluid_force *force, const double *y, const double *yp,
                                       double *residual) {
    const struct fish *const fish = force->fish;
    pressure_update_rate(force->pressure, y, yp);
    for (int i = 0; i < 2 * fish->n_nodes; i++) residual[fish->at.ax + i] += force->pressure->momentum_rate[i];
}

static struct fluid_forces pressure_fluid_forces(const struct fluid_force *force, const struct flow_at_body *flow,
                                                 const double about[2], const double *y) {
    struct fluid_forces forces = edge_force_sum(force, flow, about, y);
    forces.pressure = pressure_sum(force->pressure, about, y);
    return forces;
}

static struct fluid_power pressure_fluid_power(const struct fluid_force *force, const struct flow_at_body *flow,
                                               const double *y) {
    struct fluid_power power = edge_force_power(force, flow, y);
    const struct pressure_forces of_sheet = pressure_sum(force->pressure, (const double[2]){0, 0}, y);
    power.pressure = of_sheet.pressure_power;
    power.suction = of_sheet.suction_power;
    return power;
}

// The momentum of the fluid, plus the bound circulation as if it were at the tail: together they equal the sum over the
// control points.
static void pressure_add_impulse(const struct fluid_force *force, const struct sources *bound, double factor,
                                 const double *y, double impulse[3]) {
    const struct fish *const fish = force->fish;
    for (int k = 0; k < fish->n_nodes; k++) {
        const double place[2] = {y[fish->at.x + k], y[fish->at.y + k]};
        const double momentum[2] = {force->momentum[k], force->momentum[fish->n_nodes + k]};
        impulse[0] += momentum[0];
        impulse[1] += momentum[1];
        impulse[2] += edge_cross(place, momentum);
    }

    double total = 0, tail[2], of_sheet[3];
    for (int j = 0; j < fish->n_sheet; j++) total += bound->q[j];
    struct impulse_moments at_tail = {0};
    fish_tail(fish, y, tail);
    impulse_add(&at_tail, total, tail[0], tail[1]);
    impulse_of(&at_tail, factor, of_sheet);
    for (int i = 0; i < 3; i++) impulse[i] += of_sheet[i];
}

static void pressure_add_moments(const struct fluid_force *force, const double *x, const double *y,
                                 struct impulse_moments *sum) {
    for (int c = 0; c < force->fish->n_control; c++)
        impulse_add(sum, force->pressure->point[c].circulation, x[c], y[c]);
}

const struct force_model pressure_model = {.has_balance = true,
                                           .create = pressure_create,
                                           .update = pressure_update_all,
                                           .motion_residual = pressure_motion_residual,
                                           .motion_jacobian = pressure_motion_jacobian,
                                           .residual = pressure_residual,
                                           .jacobian = pressure_jacobian,
                                           .own_jacobian = pressure_own_jacobian,
                                           .flow_jacobian = pressure_flow_jacobian,
                                           .add_momentum_rate = pressure_add_momentum_rate,
                                           .momentum_by_strength = pressure_momentum_by_strength,
                                           .forces = pressure_fluid_forces,
                                           .power = pressure_fluid_power,
                                           .energy = edge_force_energy,
                                           .add_impulse = pressure_add_impulse,
                                           .add_moments = pressure_add_moments};
