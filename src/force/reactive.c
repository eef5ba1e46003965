/* reactive.c: first the flux at the tail, then Lagrange's equations of mu w_n^2/2, then the published added mass. */
#include "force/reactive.h"

#include <math.h>

#include "body/rod.h"

// ---- m_L (min(w_t, 0) w_n n - w_n^2/2 t) with direction and velocity of the fluid at the tail

/* Weights of the extrapolation to the tail, half an edge behind the midpoint of the last edge, which comes first. The
 * angle follows a parabola through three edges, the velocity a line through two midpoints. */
enum { N_ANGLES = 3, N_MIDPOINTS = 2 };
static const double angle_weight[N_ANGLES] = {15.0 / 8, -10.0 / 8, 3.0 / 8};
static const double flow_weight[N_MIDPOINTS] = {1.5, -0.5};

// the last edges, the last one first; direction of the body at the tail; velocity of the tail relative to the fluid
struct tail {
    struct edge edge[N_ANGLES];
    double t[2], n[2];
    double w[2], wt, wn;
};

static struct tail tail_at(const struct fish *fish, const struct flow_at_body *flow, const double *y) {
    struct tail tail;
    const int last = fish->n_edges - 1;
    for (int i = 0; i < N_ANGLES; i++) tail.edge[i] = edge_at(fish, last - i, y);

    // the weights of the angles sum to 1, so the direction depends only on the turns at the last two joints
    double angle[2];
    for (int i = 0; i < 2; i++) {
        const struct edge *const after = &tail.edge[i], *const before = after + 1;
        angle[i] = atan2(edge_dot(before->n, after->t), edge_dot(before->t, after->t));
    }
    const double turn = (angle_weight[0] - 1) * angle[0] - angle_weight[2] * angle[1];

    const double c = cos(turn), s = sin(turn);
    for (int i = 0; i < 2; i++) {
        tail.t[i] = c * tail.edge[0].t[i] + s * tail.edge[0].n[i];
        tail.n[i] = c * tail.edge[0].n[i] - s * tail.edge[0].t[i];
    }

    const double *const u[2] = {flow->u, flow->v};
    for (int i = 0; i < 2; i++) {
        tail.w[i] = y[edge_velocity(fish, i, last + 1)];
        for (int k = 0; k < N_MIDPOINTS; k++) tail.w[i] -= flow_weight[k] * u[i][flow_midpoint(fish, last - k)];
    }

    tail.wt = edge_dot(tail.w, tail.t);
    tail.wn = edge_dot(tail.w, tail.n);
    return tail;
}

// derivatives of the force: by w, as [component][component of w], and by a rotation of the tail (dt = n, dn = -t)
static void tail_slope(const struct fish *fish, const struct tail *tail, double by_velocity[2][2], double by_turn[2]) {
    const double *const t = tail->t, *const n = tail->n, mass = fish->tail_added_mass;
    const double wt = tail->wt, wn = tail->wn, leaving = fmin(wt, 0), leaves = wt < 0;

    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            by_velocity[i][j] = mass * (leaves * wn * n[i] * t[j] + (leaving * n[i] - wn * t[i]) * n[j]);
        }
        by_turn[i] = mass * ((leaves * wn * wn - leaving * wt - wn * wn / 2) * n[i] + (wn * wt - leaving * wn) * t[i]);
    }
}

void tail_flux_force(const struct fish *fish, const struct flow_at_body *flow, const double *y, double force[2]) {
    force[0] = force[1] = 0;
    if (!(fish->tail_added_mass > 0)) return;
    const struct tail tail = tail_at(fish, flow, y);
    const double leaving = fmin(tail.wt, 0), wn = tail.wn;
    for (int i = 0; i < 2; i++) {
        force[i] = fish->tail_added_mass * (leaving * wn * tail.n[i] - wn * wn / 2 * tail.t[i]);
    }
}

void tail_flux_jacobian(const struct fish *fish, const struct flow_at_body *flow, const double *y,
                        struct sparse *jacobian) {
    if (!(fish->tail_added_mass > 0)) return;
    const struct tail tail = tail_at(fish, flow, y);
    const int node = fish->n_nodes - 1;
    double by_velocity[2][2], by_turn[2];
    tail_slope(fish, &tail, by_velocity, by_turn);

    for (int i = 0; i < 2; i++) {
        const int row = edge_acceleration(fish, i, node);
        for (int j = 0; j < 2; j++) {
            sparse_add(jacobian, row, edge_velocity(fish, j, node), -by_velocity[i][j] / fish->mass[node]);

            // an edge turns by n/l if its end moves by one
            for (int k = 0; k < N_ANGLES; k++) {
                const struct edge *const edge = &tail.edge[k];
                const double by_end = by_turn[i] * angle_weight[k] * edge->n[j] / edge->length / fish->mass[node];
                sparse_add(jacobian, row, edge_place(fish, j, node - k), -by_end);
                sparse_add(jacobian, row, edge_place(fish, j, node - k - 1), by_end);
            }
        }
    }
}

void tail_flux_flow_jacobian(const struct fish *fish, const struct flow_at_body *flow,
                             const struct influence_block *block, const double *y, struct coupling_block *rows) {
    if (!(fish->tail_added_mass > 0)) return;
    const struct tail tail = tail_at(fish, flow, y);
    const int node = fish->n_nodes - 1, last = fish->n_edges - 1;
    double by_velocity[2][2], by_turn[2];
    tail_slope(fish, &tail, by_velocity, by_turn);

    for (int k = 0; k < N_MIDPOINTS; k++) {
        const double *const du = block->u + flow_midpoint(fish, last - k);
        const double *const dv = block->v + flow_midpoint(fish, last - k);
        const double weight = flow_weight[k] / fish->mass[node];
        for (long c = 0; c < block->n_columns; c++) {
            double *const ax = rows->value + c * rows->n_rows + node, *const ay = ax + fish->n_nodes;
            const double by_u = du[c * block->n_points], by_v = dv[c * block->n_points];
            *ax += weight * (by_velocity[0][0] * by_u + by_velocity[0][1] * by_v);
            *ay += weight * (by_velocity[1][0] * by_u + by_velocity[1][1] * by_v);
        }
    }
}

// ---- Lagrange's equations of mu w_n^2/2

// w and the relative acceleration a - b in the frame of the edge, and the coefficients of the force
struct frame {
    double wt, wn, at, an;
    double turn_rate;
    double push; /* coefficient of n in the force: (a - b).n - turn_rate w_t */
    double pair; /* mu w_n w_t/l: Munk's couple on the edge, over its length */
};

static struct frame reactive_frame(const struct fish *fish, int k, const struct edge *edge, const double w[2],
                                   const double b[2]) {
    const double excess[2] = {edge->acceleration[0] - b[0], edge->acceleration[1] - b[1]};
    struct frame frame = {.wt = edge_dot(w, edge->t),
                          .wn = edge_dot(w, edge->n),
                          .at = edge_dot(excess, edge->t),
                          .an = edge_dot(excess, edge->n),
                          .turn_rate = edge_turn_rate(edge)};

    frame.push = frame.an - frame.turn_rate * frame.wt;
    frame.pair = fish->added_mass[k] * frame.wn * frame.wt / edge->length;
    return frame;
}

static void lagrange_force(const struct fish *fish, int k, const struct edge *edge, const double w[2],
                           const double b[2], double force[2][2]) {
    const double half_mass = fish->added_mass[k] / 2;
    const struct frame f = reactive_frame(fish, k, edge, w, b);
    for (int i = 0; i < 2; i++) {
        const double both = -half_mass * (f.push * edge->n[i] - f.wn * f.turn_rate * edge->t[i]);
        const double gradient = fish->displaced_mass[k] / 2 * b[i];
        force[0][i] = both + gradient + f.pair * edge->n[i];
        force[1][i] = both + gradient - f.pair * edge->n[i];
    }
}

static void lagrange_slope(const struct fish *fish, int k, const struct edge *edge, const double w[2],
                           const double b[2], struct reaction_slope *slope) {
    const double *const t = edge->t, *const n = edge->n, l = edge->length;
    const double half_mass = fish->added_mass[k] / 2;
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) slope->by_acceleration[i][j] = -half_mass * n[i] * n[j];
    }

    // a rotation changes the components: dw_n = -w_t, dw_t = w_n, d(a.n) = -a.t
    const struct frame f = reactive_frame(fish, k, edge, w, b);
    const double rate_by_turn = -edge_dot(edge->rate, t) / l;
    const double push_by_turn = -f.at - rate_by_turn * f.wt - f.turn_rate * f.wn;
    const double pair_by_turn = 2 * half_mass / l * (f.wn * f.wn - f.wt * f.wt);
    for (int i = 0; i < 2; i++) {
        const double spin = half_mass * (f.wt * n[i] + f.wn * t[i]);  // by the turn rate
        const double turn = -half_mass * ((push_by_turn - f.wn * f.turn_rate) * n[i] +
                                          (f.wt * f.turn_rate - f.push - f.wn * rate_by_turn) * t[i]);
        for (int end = 0; end < 2; end++) {
            const double sign = end == 0 ? 1 : -1;
            slope->by_turn[end][i] = turn + sign * (pair_by_turn * n[i] - f.pair * t[i]);
            slope->by_length[end][i] = -spin * f.turn_rate / l - sign * f.pair / l * n[i];
            for (int j = 0; j < 2; j++) {
                const double pair = 2 * half_mass / l * (f.wt * n[j] + f.wn * t[j]);
                slope->by_velocity[end][i][j] =
                    half_mass * f.turn_rate * (n[i] * t[j] + t[i] * n[j]) + sign * pair * n[i];
                slope->by_rate[end][i][j] = spin * n[j] / l;
            }
        }
    }
}

static double lagrange_power(const struct fish *fish, int k, const struct edge *edge, const double w[2],
                             const double b[2]) {
    double force[2][2], power = 0;
    lagrange_force(fish, k, edge, w, b, force);
    for (int i = 0; i < 2; i++) {
        power += (force[0][i] + force[1][i]) * edge->velocity[i] + (force[1][i] - force[0][i]) * edge->rate[i] / 2;
    }
    return power;
}

const struct edge_reaction reactive_of_lagrange = {lagrange_force, lagrange_slope, lagrange_power};

// ---- the article's force: -mu (a.n) n, half on each node

static void published_force(const struct fish *fish, int k, const struct edge *edge, const double w[2],
                            const double b[2], double force[2][2]) {
    (void)w, (void)b;
    const double inertia = fish->added_mass[k] / 2 * edge_dot(edge->acceleration, edge->n);
    for (int i = 0; i < 2; i++) force[0][i] = force[1][i] = -inertia * edge->n[i];
}

static void published_slope(const struct fish *fish, int k, const struct edge *edge, const double w[2],
                            const double b[2], struct reaction_slope *slope) {
    (void)w, (void)b;
    const double *const t = edge->t, *const n = edge->n, half_mass = fish->added_mass[k] / 2;
    const double an = edge_dot(edge->acceleration, n), at = edge_dot(edge->acceleration, t);
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) slope->by_acceleration[i][j] = -half_mass * n[i] * n[j];
        slope->by_turn[0][i] = slope->by_turn[1][i] = half_mass * (at * n[i] + an * t[i]);
    }
}

static double published_power(const struct fish *fish, int k, const struct edge *edge, const double w[2],
                              const double b[2]) {
    (void)w, (void)b;
    const double inertia = fish->added_mass[k] * edge_dot(edge->acceleration, edge->n);
    return -(inertia * edge_dot(edge->velocity, edge->n));
}

const struct edge_reaction reactive_published = {published_force, published_slope, published_power};
