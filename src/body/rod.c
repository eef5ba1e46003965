/* rod.c: for every joint and every edge: local geometry, then energy, force and derivative. */
#include "body/rod.h"

#include <math.h>

#include "body/edge.h"

// a joint: gradient and rate of the turning angle, curvature and derivatives of the curvature by the angle
enum { N_LOCAL = 6 };  // coordinates of the joint's three nodes: x, y of each in turn
struct joint {
    struct edge before, after;
    struct bend bend;
    double gradient[N_LOCAL]; /* dphi/dx */
    double angle_rate;        /* dphi/dt */
};

static struct joint joint_at(const struct fish *fish, int j, const double *y) {
    struct joint joint = {.before = edge_at(fish, j, y), .after = edge_at(fish, j + 1, y)};
    const struct edge *a = &joint.before, *b = &joint.after;
    joint.bend = edge_bend(a->t, b->t);

    for (int i = 0; i < 2; i++) {
        joint.gradient[i] = a->n[i] / a->length;
        joint.gradient[4 + i] = b->n[i] / b->length;
        joint.gradient[2 + i] = -joint.gradient[i] - joint.gradient[4 + i];
    }

    joint.angle_rate = edge_turn_rate(b) - edge_turn_rate(a);
    return joint;
}

// second derivative of the turning angle; the second derivative of an edge direction is -(n t + t n)/l^2
static void joint_hessian(const struct joint *joint, double hessian[N_LOCAL][N_LOCAL]) {
    const struct edge *const edges[2] = {&joint->before, &joint->after};
    for (int i = 0; i < N_LOCAL; i++) {
        for (int k = 0; k < N_LOCAL; k++) hessian[i][k] = 0;
    }

    for (int side = 0; side < 2; side++) {
        const struct edge *edge = edges[side];
        const double sign = side == 0 ? 1 : -1;
        for (int i = 0; i < 2; i++) {
            for (int k = 0; k < 2; k++) {
                const double h =
                    sign * (edge->n[i] * edge->t[k] + edge->t[i] * edge->n[k]) / (edge->length * edge->length);
                const int first = 2 * side, last = 2 * side + 2;
                hessian[first + i][first + k] += h;
                hessian[last + i][last + k] += h;
                hessian[first + i][last + k] -= h;
                hessian[last + i][first + k] -= h;
            }
        }
    }
}

static double elastic_moment(const struct fish *fish, int j, double curvature, double natural_curvature) {
    return fish->bending_stiffness[j] * (curvature - natural_curvature) / fish->edge_length;
}

// the undamped part of the rate of curvature: the rate of natural curvature if damping acts on the strain
static double undamped_rate(const struct fish *fish, const struct actuation *muscle, int j) {
    return fish->damping == DAMPING_STRAIN ? muscle->rate[j] : 0;
}

void rod_curvature(const struct fish *fish, const double *y, double *curvature) {
    for (int j = 0; j < fish->n_joints; j++) curvature[j] = joint_at(fish, j, y).bend.curvature;
}

void rod_residual(const struct fish *fish, const struct actuation *muscle, const double *y, double *residual) {
    double *const force[2] = {residual + fish->at.ax, residual + fish->at.ay};
    for (int j = 0; j < fish->n_joints; j++) {
        const struct joint joint = joint_at(fish, j, y);
        const double elastic = elastic_moment(fish, j, joint.bend.curvature, muscle->curvature[j]) * joint.bend.slope;
        const double d = fish->bending_damping[j], undamped = undamped_rate(fish, muscle, j);
        const double damping =
            d * joint.bend.slope * joint.bend.slope * joint.angle_rate - d * joint.bend.slope * undamped;
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
    const struct joint joint = joint_at(fish, j, y);
    double hessian[N_LOCAL][N_LOCAL], turned[N_LOCAL];
    joint_hessian(&joint, hessian);
    const double stiffness = fish->bending_stiffness[j] / fish->edge_length, d = fish->bending_damping[j];
    const double moment = elastic_moment(fish, j, joint.bend.curvature, muscle->curvature[j]);
    const double undamped = undamped_rate(fish, muscle, j);
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

static void edge_jacobian(const struct fish *fish, int k, const double *y, struct sparse *jacobian) {
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
            const double by_place = stiffness * edge.t[a] * edge.t[b] + tension / edge.length * edge.n[a] * edge.n[b] +
                                    fish->axial_damping[k] * turn_rate * edge.t[a] * edge.n[b];
            const double by_velocity = fish->axial_damping[k] * edge.t[a] * edge.t[b];
            sparse_add(jacobian, row, (b == 0 ? fish->at.x : fish->at.y) + k + m / 2, sign * by_place);
            sparse_add(jacobian, row, (b == 0 ? fish->at.vx : fish->at.vy) + k + m / 2, sign * by_velocity);
        }
    }
}

void rod_jacobian(const struct fish *fish, const struct actuation *muscle, const double *y, struct sparse *jacobian) {
    for (int j = 0; j < fish->n_joints; j++) joint_jacobian(fish, j, muscle, y, jacobian);
    for (int k = 0; k < fish->n_edges; k++) edge_jacobian(fish, k, y, jacobian);
}

int rod_n_strains(const struct fish *fish) {
    return fish->n_joints + fish->n_edges;
}

void rod_strains(const struct fish *fish, const struct actuation *muscle, const double *y,
                 const struct rod_strains *to) {
    for (int j = 0; j < fish->n_joints; j++) {
        const struct joint joint = joint_at(fish, j, y);
        to->strain[j] = joint.bend.curvature - muscle->curvature[j];
        to->rate[j] = joint.bend.slope * joint.angle_rate - undamped_rate(fish, muscle, j);
        to->stress[j] = elastic_moment(fish, j, joint.bend.curvature, muscle->curvature[j]);
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

double rod_bending_energy(const struct fish *fish, const double *strain) {
    double energy = 0;
    for (int j = 0; j < fish->n_joints; j++) {
        energy += fish->bending_stiffness[j] * strain[j] * strain[j] / (2 * fish->edge_length);
    }
    return energy;
}

double rod_stretching_energy(const struct fish *fish, const double *strain) {
    double energy = 0;
    for (int k = 0; k < fish->n_edges; k++) {
        const double of_edge = strain[fish->n_joints + k];
        energy += fish->axial_stiffness[k] * of_edge * of_edge * fish->edge_length / 2;
    }
    return energy;
}

int rod_is_torn(const struct fish *fish, const double *y) {
    const double most = 10 * fish->edge_length;
    for (int k = 0; k < fish->n_edges; k++) {
        if (edge_at(fish, k, y).length > most) return 1;
    }
    return 0;
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

double rod_actuation_power(const struct fish *fish, const struct actuation *muscle, const double *stress) {
    double power = 0;
    for (int j = 0; j < fish->n_joints; j++) power -= stress[j] * muscle->rate[j];
    return power;
}

double rod_damping_power(const struct fish *fish, const double *rate) {
    double power = 0;
    for (int j = 0; j < fish->n_joints; j++) power -= fish->bending_damping[j] * rate[j] * rate[j];
    for (int k = 0; k < fish->n_edges; k++) {
        const double of_edge = rate[fish->n_joints + k];
        power -= fish->axial_damping[k] * of_edge * of_edge;
    }

    return power;
}
