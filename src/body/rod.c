/* rod.c: goes along the body, joint by joint and edge by edge; for each the local geometry comes first, then energy,
 * force and derivative. */
#include "body/rod.h"

#include <math.h>
#include <string.h>

#include "fish/fish_gait.h"
#include "fish/fish_motion.h"

// ---- from the unknowns of two nodes to the edge between these nodes

struct edge edge_at(const struct fish *fish, int k, const double *y) {
    const double *const x = y + fish->at.x + k, *const z = y + fish->at.y + k;
    const double *const vx = y + fish->at.vx + k, *const vy = y + fish->at.vy + k;
    const double *const ax = y + fish->at.ax + k, *const ay = y + fish->at.ay + k;
    const struct direction along = fish_direction_of((const double[2]){x[1] - x[0], z[1] - z[0]});

    return (struct edge){.length = along.length,
                         .t = {along.t[0], along.t[1]},
                         .n = {along.n[0], along.n[1]},
                         .middle = {(x[0] + x[1]) / 2, (z[0] + z[1]) / 2},
                         .velocity = {(vx[0] + vx[1]) / 2, (vy[0] + vy[1]) / 2},
                         .acceleration = {(ax[0] + ax[1]) / 2, (ay[0] + ay[1]) / 2},
                         .rate = {vx[1] - vx[0], vy[1] - vy[0]}};
}

struct bend edge_bend(const double before[2], const double after[2]) {
    const double sine = edge_cross(before, after), cosine = edge_dot(before, after);
    const double half_tangent = cosine > 0 ? sine / (1 + cosine) : (1 - cosine) / sine;
    const double slope = 1 + half_tangent * half_tangent;
    return (struct bend){.curvature = 2 * half_tangent, .slope = slope, .second = slope * half_tangent};
}

// ---- phibar = a(t) A (lbar/l_ref) (c0 + c1 sigma + c2 sigma^2) (sin(beta sigma + omega t + phase) + phi0), or
// a table instead of the sine

void actuation_find(const struct fish *fish, struct fish_gait gait, double phi0, double phi0_rate,
                    const struct actuation *to) {
    const double ramp = gait.amplitude, rate_of_ramp = gait.amplitude_rate;
    for (int j = 0; j < fish->n_joints; j++) {
        const double half_tangent = tan(fish_natural_angle(fish, j, &gait, phi0) / 2);
        const double slope = 1 + half_tangent * half_tangent;  // of the curvature by the angle
        to->curvature[j] = 2 * half_tangent;
        to->curvature_by_phi0[j] = ramp * fish->wave_amplitude[j] * slope;

        const struct fish_demand demand = fish_demand(fish, j, &gait);
        const double angle_rate =
            fish->wave_amplitude[j] * (rate_of_ramp * (demand.sine + phi0) + ramp * (demand.sine_rate + phi0_rate)) +
            rate_of_ramp * demand.angle + ramp * demand.angle_rate;
        to->rate[j] = angle_rate * slope;
        to->rate_by_phi0[j] =
            fish->wave_amplitude[j] * rate_of_ramp * slope + angle_rate * half_tangent * to->curvature_by_phi0[j];
    }
}

// a joint: gradient and rate of the turning angle, curvature and derivatives of the curvature by the angle, moment
enum { N_LOCAL = 6 };  // coordinates of the joint's three nodes: x, y of each in turn
struct joint {
    struct edge before, after;
    struct bend bend;
    double gradient[N_LOCAL]; /* dphi/dx */
    double angle_rate;        /* dphi/dt */
    double moment;            /* elastic, N m */
    double undamped;          /* undamped part of the rate of curvature: of natural curvature if the strain is damped */
};

static struct joint joint_at(const struct fish *fish, const struct actuation *muscle, int j, const double *y) {
    struct joint joint = {.before = edge_at(fish, j, y), .after = edge_at(fish, j + 1, y)};
    const struct edge *a = &joint.before, *b = &joint.after;
    joint.bend = edge_bend(a->t, b->t);

    for (int i = 0; i < 2; i++) {
        joint.gradient[i] = a->n[i] / a->length;
        joint.gradient[4 + i] = b->n[i] / b->length;
        joint.gradient[2 + i] = -joint.gradient[i] - joint.gradient[4 + i];
    }

    joint.angle_rate = edge_turn_rate(b) - edge_turn_rate(a);
    joint.moment = fish->bending_stiffness[j] * (joint.bend.curvature - muscle->curvature[j]) / fish->edge_length;
    joint.undamped = fish->damping == DAMPING_STRAIN ? muscle->rate[j] : 0;
    return joint;
}

void rod_curvature(const struct fish *fish, const double *y, double *curvature) {
    struct edge before = edge_at(fish, 0, y);
    for (int j = 0; j < fish->n_joints; j++) {
        const struct edge after = edge_at(fish, j + 1, y);
        curvature[j] = edge_bend(before.t, after.t).curvature / fish->edge_length;
        before = after;
    }
}

void rod_residual(const struct fish *fish, const struct actuation *muscle, const double *y, double *residual) {
    double *const force[2] = {residual + fish->at.ax, residual + fish->at.ay};
    for (int j = 0; j < fish->n_joints; j++) {
        const struct joint joint = joint_at(fish, muscle, j, y);
        const double elastic = joint.moment * joint.bend.slope, d = fish->bending_damping[j];
        const double damping =
            d * joint.bend.slope * joint.bend.slope * joint.angle_rate - d * joint.bend.slope * joint.undamped;
        for (int i = 0; i < N_LOCAL; i++) force[i % 2][j + i / 2] += (elastic + damping) * joint.gradient[i];
    }

    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, y);
        const double elastic = fish->axial_stiffness[k] * (edge.length / fish->edge_length - 1);
        const double damping = fish->axial_damping[k] * edge_dot(edge.t, edge.rate);

        for (int i = 0; i < 2; i++) {
            force[i][k] -= (elastic + damping) * edge.t[i];
            force[i][k + 1] += (elastic + damping) * edge.t[i];
        }
    }
}

static void joint_jacobian(const struct fish *fish, int j, const struct actuation *muscle, const double *y,
                           struct sparse *jacobian) {
    const struct joint joint = joint_at(fish, muscle, j, y);
    double hessian[N_LOCAL][N_LOCAL] = {{0}}, turned[N_LOCAL];

    // second derivative of the turning angle; the second derivative of an edge direction is -(n t + t n)/l^2
    for (int side = 0; side < 2; side++) {
        const struct edge *const edge = side == 0 ? &joint.before : &joint.after;
        const double sign = side == 0 ? 1 : -1;
        const int first = 2 * side, last = 2 * side + 2;
        for (int i = 0; i < 2; i++) {
            for (int k = 0; k < 2; k++) {
                const double h =
                    sign * (edge->n[i] * edge->t[k] + edge->t[i] * edge->n[k]) / (edge->length * edge->length);
                hessian[first + i][first + k] += h;
                hessian[last + i][last + k] += h;
                hessian[first + i][last + k] -= h;
                hessian[last + i][first + k] -= h;
            }
        }
    }

    // moment plus damping, and derivatives by the turning angle, by the rate of the angle, and by phi0
    const double stiffness = fish->bending_stiffness[j] / fish->edge_length, d = fish->bending_damping[j];
    const double moment = joint.moment, undamped = joint.undamped;
    const double first = moment * joint.bend.slope + d * joint.bend.slope * joint.bend.slope * joint.angle_rate -
                         d * joint.bend.slope * undamped;

    const double second = stiffness * joint.bend.slope * joint.bend.slope + moment * joint.bend.second +
                          2 * d * joint.bend.slope * joint.bend.second * joint.angle_rate -
                          d * joint.bend.second * undamped;

    const double rate = d * joint.bend.slope * joint.bend.slope;
    const double undamped_by_phi0 = fish->damping == DAMPING_STRAIN ? muscle->rate_by_phi0[j] : 0;
    const double by_phi0 =
        -(stiffness * joint.bend.slope * muscle->curvature_by_phi0[j] + d * joint.bend.slope * undamped_by_phi0);

    // derivative of the angle rate by positions: hessian times velocity
    for (int i = 0; i < N_LOCAL; i++) {
        turned[i] = 0;
        for (int k = 0; k < N_LOCAL; k++) {
            const int velocity = (k % 2 == 0 ? fish->at.vx : fish->at.vy) + j + k / 2;
            turned[i] += hessian[i][k] * y[velocity];
        }
    }

    for (int i = 0; i < N_LOCAL; i++) {
        const int node = j + i / 2, row = (i % 2 == 0 ? fish->at.ax : fish->at.ay) + node;
        const double *b = joint.gradient;
        for (int k = 0; k < N_LOCAL; k++) {
            const int other = j + k / 2;
            sparse_add(jacobian, row, (k % 2 == 0 ? fish->at.x : fish->at.y) + other,
                       (first * hessian[i][k] + second * b[i] * b[k] + rate * b[i] * turned[k]) / fish->mass[node]);
            sparse_add(jacobian, row, (k % 2 == 0 ? fish->at.vx : fish->at.vy) + other,
                       rate * b[i] * b[k] / fish->mass[node]);
        }

        sparse_add(jacobian, row, fish->at.phi0, by_phi0 * b[i] / fish->mass[node]);
    }
}

void rod_jacobian(const struct fish *fish, const struct actuation *muscle, const double *y, struct sparse *jacobian) {
    for (int j = 0; j < fish->n_joints; j++) joint_jacobian(fish, j, muscle, y, jacobian);

    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, y);
        const double stretch_rate = edge_dot(edge.t, edge.rate), turn_rate = edge_turn_rate(&edge);
        const double tension =
            fish->axial_stiffness[k] * (edge.length / fish->edge_length - 1) + fish->axial_damping[k] * stretch_rate;
        const double stiffness = fish->axial_stiffness[k] / fish->edge_length;

        for (int i = 0; i < 4; i++) {
            const int node = k + i / 2, row = (i % 2 == 0 ? fish->at.ax : fish->at.ay) + node;
            for (int m = 0; m < 4; m++) {
                const double sign = (i / 2 == m / 2 ? 1 : -1) / fish->mass[node];
                const int a = i % 2, b = m % 2;
                const double by_place = stiffness * edge.t[a] * edge.t[b] +
                                        tension / edge.length * edge.n[a] * edge.n[b] +
                                        fish->axial_damping[k] * turn_rate * edge.t[a] * edge.n[b];
                const double by_velocity = fish->axial_damping[k] * edge.t[a] * edge.t[b];
                sparse_add(jacobian, row, (b == 0 ? fish->at.x : fish->at.y) + k + m / 2, sign * by_place);
                sparse_add(jacobian, row, (b == 0 ? fish->at.vx : fish->at.vy) + k + m / 2, sign * by_velocity);
            }
        }
    }
}

// the natural angle moves with amplitude times phi0, its rate with amplitude times the rate of phi0: the derivatives of
// curvature and of rate are the same
void rod_by_phi0_rate(const struct fish *fish, const struct actuation *muscle, const double *y, double *value) {
    memset(value, 0, 2 * (size_t)fish->n_nodes * sizeof *value);
    if (fish->damping != DAMPING_STRAIN) return;
    for (int j = 0; j < fish->n_joints; j++) {
        const struct joint joint = joint_at(fish, muscle, j, y);
        const double moment = fish->bending_damping[j] * muscle->curvature_by_phi0[j] * joint.bend.slope;
        for (int i = 0; i < N_LOCAL; i++) {
            const int node = j + i / 2;
            value[i % 2 * fish->n_nodes + node] -= moment * joint.gradient[i] / fish->mass[node];
        }
    }
}

void rod_strains(const struct fish *fish, const struct actuation *muscle, const double *y,
                 const struct rod_strains *to) {
    for (int j = 0; j < fish->n_joints; j++) {
        const struct joint joint = joint_at(fish, muscle, j, y);
        to->strain[j] = joint.bend.curvature - muscle->curvature[j];
        to->rate[j] = joint.bend.slope * joint.angle_rate - joint.undamped;
        to->stress[j] = joint.moment;
        // curvature damping acts in parallel to the muscle, strain damping in series
        if (fish->damping == DAMPING_STRAIN) to->stress[j] += fish->bending_damping[j] * to->rate[j];
    }

    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, y);
        const int i = fish->n_joints + k;
        to->strain[i] = edge.length / fish->edge_length - 1;
        to->rate[i] = edge_dot(edge.t, edge.rate);
        to->stress[i] = fish->axial_stiffness[k] * to->strain[i] + fish->axial_damping[k] * to->rate[i];
    }
}

struct rod_energetics rod_energetics(const struct fish *fish, const struct actuation *muscle,
                                     const struct rod_strains *of) {
    struct rod_energetics sum = {.bending = 0};
    for (int j = 0; j < fish->n_joints; j++) {
        sum.bending += fish->bending_stiffness[j] * of->strain[j] * of->strain[j] / (2 * fish->edge_length);
        sum.actuation -= of->stress[j] * muscle->rate[j];
        sum.damping -= fish->bending_damping[j] * of->rate[j] * of->rate[j];
    }

    for (int k = 0; k < fish->n_edges; k++) {
        const double strain = of->strain[fish->n_joints + k], rate = of->rate[fish->n_joints + k];
        sum.stretching += fish->axial_stiffness[k] * strain * strain * fish->edge_length / 2;
        sum.damping -= fish->axial_damping[k] * rate * rate;
    }
    return sum;
}

bool rod_is_torn(const struct fish *fish, const double *y) {
    const double most = 10 * fish->edge_length;
    for (int k = 0; k < fish->n_edges; k++) {
        if (edge_at(fish, k, y).length > most) return true;
    }
    return false;
}

int rod_shortest_edge(const struct fish *fish, const double *y, double *ratio) {
    int shortest = 0;
    *ratio = INFINITY;
    for (int k = 0; k < fish->n_edges; k++) {
        const double here = edge_at(fish, k, y).length / fish->edge_length;
        if (here >= *ratio) continue;
        *ratio = here;
        shortest = k;
    }

    return shortest;
}

int rod_sharpest_joint(const struct fish *fish, const double *y, double *turn) {
    int sharpest = 0;
    *turn = -1;
    for (int k = 1; k < fish->n_edges; k++) {
        const struct edge before = edge_at(fish, k - 1, y), after = edge_at(fish, k, y);
        const double here = fabs(atan2(edge_dot(before.n, after.t), edge_dot(before.t, after.t)));
        if (here <= *turn) continue;
        *turn = here;
        sharpest = k;
    }

    return sharpest;
}

// ---- running sums from the tail; an exponential integrator for every joint and edge

void rod_stress_balance(const struct fish *fish, const double *residue, const double *y, double *stress) {
    double *const moment = stress, *const tension = stress + fish->n_joints;
    double force[2] = {0, 0}, couple = 0;
    struct edge edge = edge_at(fish, fish->n_edges - 1, y);
    for (int k = fish->n_edges - 1; k + 1 >= fish_n_prescribed(fish); k--) {
        // sum over all nodes behind node k, and moment about node k
        for (int i = 0; i < 2; i++) force[i] += residue[edge_acceleration(fish, i, k + 1)];
        couple += edge.length * edge_dot(edge.n, force);
        tension[k] -= edge_dot(edge.t, force);
        if (k == 0) return;

        const struct edge ahead = edge_at(fish, k - 1, y);
        moment[k - 1] -= couple / edge_bend(ahead.t, edge.t).slope;
        edge = ahead;
    }
}

// stiffness and damping of one strain: EI/lbar and d_b of a joint, EA and d_s lbar of an edge
struct material {
    double stiffness, damping;
};
static struct material material_of(const struct fish *fish, int i) {
    const int edge = i - fish->n_joints;
    if (edge < 0) return (struct material){fish->bending_stiffness[i] / fish->edge_length, fish->bending_damping[i]};
    return (struct material){fish->axial_stiffness[edge], fish->axial_damping[edge] * fish->edge_length};
}

// phi[k] = integral over q from 0 to 1 of exp(-r (1 - q)) q^k/k!
static void exponential_integrals(double r, double phi[3]) {
    if (r > 0.5) {
        phi[0] = -expm1(-r) / r;
        phi[1] = (1 - phi[0]) / r;
        phi[2] = (0.5 - phi[1]) / r;
        return;
    }

    // the series of phi[2], sum over i of (-r)^i/(i + 3)!, then phi[1] and phi[0] by recursion
    double term = 1.0 / 6;
    phi[2] = 0;

    for (int i = 0; i < 12; i++) {
        phi[2] += term;
        term *= -r / (i + 4);
    }

    phi[1] = 0.5 - r * phi[2];
    phi[0] = 1 - r * phi[1];
}

void rod_stress_creep(const struct fish *fish, double h, double g, const double *oldest, const double *before,
                      const double *now, double *strain) {
    for (int i = 0; i < fish->n_joints + fish->n_edges; i++) {
        const struct material material = material_of(fish, i);
        if (material.damping <= 0) {
            strain[i] = now[i] / material.stiffness;
            continue;
        }

        // the stress at the part q of the step is before + linear q + square q (q - 1)
        const double linear = now[i] - before[i];
        const double square = g > 0 ? (linear - (before[i] - oldest[i]) * h / g) * h / (h + g) : 0;
        const double r = h * material.stiffness / material.damping;
        double phi[3];
        exponential_integrals(r, phi);
        const double stress = before[i] * phi[0] + (linear - square) * phi[1] + 2 * square * phi[2];
        strain[i] = exp(-r) * strain[i] + r * stress / material.stiffness;
    }
}

void rod_stress_rates(const struct fish *fish, const double *strain, const double *stress, double *rate) {
    for (int i = 0; i < fish->n_joints + fish->n_edges; i++) {
        const struct material material = material_of(fish, i);
        const double damped = stress[i] - material.stiffness * strain[i];
        rate[i] = material.damping > 0 ? damped / material.damping : 0;
        // the rate of an edge is in m s-1
        if (i >= fish->n_joints) rate[i] *= fish->edge_length;
    }
}

// ---- the clamp: a joint with one given edge direction

// state of the clamp: edge 0, the angle with the given direction, and the rate of the angle
struct clamp {
    struct edge edge;
    struct bend bend;
    double angle_rate, given_rate; /* of the angle, and of the given direction, rad s-1 */
    double moment;                 /* restoring moment, N m */
    double by_angle, by_rate;      /* derivatives of the moment */
};

static struct clamp clamp_at(const struct fish *fish, double t, const double *y) {
    struct clamp clamp = {.edge = edge_at(fish, 0, y)};
    double given[2];
    fish_prescribed_direction(fish, t, given, &clamp.given_rate);
    clamp.bend = edge_bend(given, clamp.edge.t);
    clamp.angle_rate = edge_turn_rate(&clamp.edge) - clamp.given_rate;
    const double k = fish->clamp_stiffness, d = fish->clamp_damping;
    const double curvature = clamp.bend.curvature, slope = clamp.bend.slope, second = clamp.bend.second;
    clamp.moment = k * curvature * slope + d * slope * slope * clamp.angle_rate;
    clamp.by_angle = k * (slope * slope + curvature * second) + 2 * d * slope * second * clamp.angle_rate;
    clamp.by_rate = d * slope * slope;

    return clamp;
}

void rod_clamp_residual(const struct fish *fish, double t, const double *y, double *residual) {
    if (!fish->has_clamp) return;
    const struct clamp clamp = clamp_at(fish, t, y);
    for (int i = 0; i < 2; i++) {
        const double force = clamp.moment * clamp.edge.n[i] / clamp.edge.length;
        residual[edge_acceleration(fish, i, 0)] -= force;
        residual[edge_acceleration(fish, i, 1)] += force;
    }
}

void rod_clamp_jacobian(const struct fish *fish, double t, const double *y, struct sparse *jacobian) {
    if (!fish->has_clamp) return;
    const struct clamp clamp = clamp_at(fish, t, y);
    const struct edge *edge = &clamp.edge;
    const double l = edge->length, along = edge_dot(edge->rate, edge->t), across = edge_dot(edge->rate, edge->n);

    for (int row = 0; row < 4; row++) {
        const int node = row / 2, i = row % 2;
        for (int column = 0; column < 4; column++) {
            const int other = column / 2, j = column % 2;
            const double sign = (node == other ? 1 : -1) / (l * l * fish->mass[node]);

            // the gradient of the angle is n/l, the second derivative -(n t + t n)/l^2
            const double second = -(edge->n[i] * edge->t[j] + edge->t[i] * edge->n[j]);
            const double rate_by_place = -(along * edge->n[j] + across * edge->t[j]) / l;
            const double by_place = clamp.by_angle * edge->n[i] * edge->n[j] +
                                    clamp.by_rate * edge->n[i] * rate_by_place + clamp.moment * second;
            sparse_add(jacobian, edge_acceleration(fish, i, node), edge_place(fish, j, other), sign * by_place);
            sparse_add(jacobian, edge_acceleration(fish, i, node), edge_velocity(fish, j, other),
                       sign * clamp.by_rate * edge->n[i] * edge->n[j]);
        }
    }
}

struct rod_clamp_terms rod_clamp_terms(const struct fish *fish, double t, const double *y) {
    if (!fish->has_clamp) return (struct rod_clamp_terms){0};
    const struct clamp clamp = clamp_at(fish, t, y);
    return (struct rod_clamp_terms){.energy = fish->clamp_stiffness * clamp.bend.curvature * clamp.bend.curvature / 2,
                                    .damping_power = -clamp.by_rate * clamp.angle_rate * clamp.angle_rate,
                                    .driving_power = -clamp.moment * clamp.given_rate,
                                    .moment = -clamp.moment};
}
