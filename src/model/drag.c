/* drag.c: every edge by itself: its frame, the force in it, and how the force changes. */
#include "model/drag.h"

#include <math.h>

#include "model/edge.h"

static const double unit_speed = 1; /* V1 of the linear-quadratic law, m s-1 */

static double speed_law(enum drag_law law, double speed) {
    return speed * (fabs(speed) + (law == DRAG_LINEAR_QUADRATIC ? unit_speed : 0));
}

static double speed_law_slope(enum drag_law law, double speed) {
    return 2 * fabs(speed) + (law == DRAG_LINEAR_QUADRATIC ? unit_speed : 0);
}

// the drag on an edge that moves with the relative velocity w
static void drag_force(const struct fish *fish, int k, const struct edge *s, const double w[2], double force[2]) {
    const double along = fish->drag_tangential[k] * speed_law(fish->drag_law, edge_dot(w, s->t));
    const double across = fish->drag_normal[k] * speed_law(fish->drag_law, edge_dot(w, s->n));
    for (int i = 0; i < 2; i++) force[i] = -along * s->t[i] - across * s->n[i];
}

// its derivatives with respect to w and to a turn of the edge (dt = n, dn = -t)
static void drag_slope(const struct fish *fish, int k, const struct edge *s, const double w[2],
                       double by_velocity[2][2], double by_turn[2]) {
    const double wt = edge_dot(w, s->t), wn = edge_dot(w, s->n);
    const double along = fish->drag_tangential[k] * speed_law(fish->drag_law, wt);
    const double across = fish->drag_normal[k] * speed_law(fish->drag_law, wn);
    const double along_slope = fish->drag_tangential[k] * speed_law_slope(fish->drag_law, wt);
    const double across_slope = fish->drag_normal[k] * speed_law_slope(fish->drag_law, wn);
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            by_velocity[i][j] = -along_slope * s->t[i] * s->t[j] - across_slope * s->n[i] * s->n[j];
        }
        by_turn[i] = -along_slope * wn * s->t[i] - along * s->n[i] + across_slope * wt * s->n[i] + across * s->t[i];
    }
}

static void relative_velocity(const struct fish *fish, int k, const struct edge *s, const double *u, const double *v,
                              double w[2]) {
    w[0] = s->velocity[0] - u[flow_midpoint(fish, k)];
    w[1] = s->velocity[1] - v[flow_midpoint(fish, k)];
}

void drag_residual(const struct fish *fish, const double *u, const double *v, const double *y, double *residual) {
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge s = edge_at(fish, k, y);
        double w[2], force[2];
        relative_velocity(fish, k, &s, u, v, w);
        drag_force(fish, k, &s, w, force);
        const double inertia = fish->added_mass[k] * edge_dot(s.acceleration, s.n);
        for (int node = k; node <= k + 1; node++) {
            residual[fish->at.ax + node] -= (force[0] - inertia * s.n[0]) / 2;
            residual[fish->at.ay + node] -= (force[1] - inertia * s.n[1]) / 2;
        }
    }
}

void drag_jacobian(const struct fish *fish, const double *u, const double *v, const double *y,
                   struct sparse *jacobian) {
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge s = edge_at(fish, k, y);
        double w[2], by_velocity[2][2], by_turn[2];
        relative_velocity(fish, k, &s, u, v, w);
        drag_slope(fish, k, &s, w, by_velocity, by_turn);
        const double an = edge_dot(s.acceleration, s.n), at = edge_dot(s.acceleration, s.t), mu = fish->added_mass[k];
        for (int i = 0; i < 2; i++) by_turn[i] += mu * (at * s.n[i] + an * s.t[i]);
        for (int node = k; node <= k + 1; node++) {
            for (int i = 0; i < 2; i++) {
                const int row = edge_acceleration(fish, i, node);
                for (int other = k; other <= k + 1; other++) {
                    const double turn = (other == k ? -1 : 1) / s.length;
                    for (int j = 0; j < 2; j++) {
                        sparse_add(jacobian, row, edge_place(fish, j, other),
                                   -by_turn[i] * turn * s.n[j] / (2 * fish->mass[node]));
                        sparse_add(jacobian, row, edge_velocity(fish, j, other),
                                   -by_velocity[i][j] / (4 * fish->mass[node]));
                        sparse_add(jacobian, row, edge_acceleration(fish, j, other),
                                   mu * s.n[i] * s.n[j] / (4 * fish->mass[node]));
                    }
                }
            }
        }
    }
}

void drag_flow_jacobian(const struct fish *fish, const double *u, const double *v, const struct influence_block *block,
                        const double *y, struct coupling_block *rows) {
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge s = edge_at(fish, k, y);
        double w[2], by_velocity[2][2], by_turn[2];
        relative_velocity(fish, k, &s, u, v, w);
        drag_slope(fish, k, &s, w, by_velocity, by_turn);
        const double per_mass[2] = {1 / (2 * fish->mass[k]), 1 / (2 * fish->mass[k + 1])};
        const double *const du = block->u + flow_midpoint(fish, k), *const dv = block->v + flow_midpoint(fish, k);
        for (long c = 0; c < block->n_columns; c++) {
            double *const ax = rows->value + c * rows->n_rows + k, *const ay = ax + fish->n_nodes;
            const double by_u = du[c * block->n_points], by_v = dv[c * block->n_points];
            const double change_x = by_velocity[0][0] * by_u + by_velocity[0][1] * by_v;
            const double change_y = by_velocity[1][0] * by_u + by_velocity[1][1] * by_v;
            for (int end = 0; end < 2; end++) {
                ax[end] += change_x * per_mass[end];
                ay[end] += change_y * per_mass[end];
            }
        }
    }
}

// the drag that the flow causes on edge k: F(v - u) - F(v)
static void force_of_flow(const struct fish *fish, int k, const struct edge *s, const double *u, const double *v,
                          double force[2]) {
    double w[2], still[2];
    relative_velocity(fish, k, s, u, v, w);
    drag_force(fish, k, s, w, force);
    drag_force(fish, k, s, s->velocity, still);
    force[0] -= still[0];
    force[1] -= still[1];
}

static void centre_of_mass(const struct fish *fish, const double *y, double com[2]) {
    com[0] = com[1] = 0;
    for (int k = 0; k < fish->n_nodes; k++) {
        com[0] += fish->mass[k] / fish->total_mass * y[fish->at.x + k];
        com[1] += fish->mass[k] / fish->total_mass * y[fish->at.y + k];
    }
}

double drag_moment(const struct fish *fish, const double *u, const double *v, const double *y) {
    double com[2], moment = 0;
    centre_of_mass(fish, y, com);
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge s = edge_at(fish, k, y);
        double force[2];
        force_of_flow(fish, k, &s, u, v, force);
        moment += (s.middle[0] - com[0]) * force[1] - (s.middle[1] - com[1]) * force[0];
    }
    return moment / fish->control.torque_scale;
}

void drag_moment_jacobian(const struct fish *fish, double factor, const double *u, const double *v, const double *y,
                          struct sparse *jacobian) {
    const double scale = factor / fish->control.torque_scale;
    double com[2], total[2] = {0, 0};
    centre_of_mass(fish, y, com);
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge s = edge_at(fish, k, y);
        const double arm[2] = {s.middle[0] - com[0], s.middle[1] - com[1]};
        double force[2], w[2], by_velocity[2][2], by_turn[2], still_velocity[2][2], still_turn[2];
        force_of_flow(fish, k, &s, u, v, force);
        relative_velocity(fish, k, &s, u, v, w);
        drag_slope(fish, k, &s, w, by_velocity, by_turn);
        drag_slope(fish, k, &s, s.velocity, still_velocity, still_turn);
        const double turn = arm[0] * (by_turn[1] - still_turn[1]) - arm[1] * (by_turn[0] - still_turn[0]);
        const double by_arm[2] = {force[1], -force[0]};
        for (int other = k; other <= k + 1; other++) {
            const double sign = (other == k ? -1 : 1) / s.length;
            for (int j = 0; j < 2; j++) {
                const double by_w = arm[0] * (by_velocity[1][j] - still_velocity[1][j]) -
                                    arm[1] * (by_velocity[0][j] - still_velocity[0][j]);
                sparse_add(jacobian, fish->at.phi0, edge_place(fish, j, other),
                           scale * (by_arm[j] / 2 + turn * sign * s.n[j]));
                sparse_add(jacobian, fish->at.phi0, edge_velocity(fish, j, other), scale * by_w / 2);
            }
        }
        total[0] += force[0];
        total[1] += force[1];
    }
    // the arms are measured from the centre of mass
    const double by_com[2] = {-total[1], total[0]};
    for (int node = 0; node < fish->n_nodes; node++) {
        for (int j = 0; j < 2; j++) {
            sparse_add(jacobian, fish->at.phi0, edge_place(fish, j, node),
                       scale * by_com[j] * fish->mass[node] / fish->total_mass);
        }
    }
}

void drag_moment_flow_jacobian(const struct fish *fish, double factor, const double *u, const double *v,
                               const struct influence_block *block, const double *y, struct coupling_block *rows) {
    const double scale = factor / fish->control.torque_scale;
    double *const row = rows->value + (fish->at.phi0 - fish->at.ax);
    double com[2];
    centre_of_mass(fish, y, com);
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge s = edge_at(fish, k, y);
        const double arm[2] = {s.middle[0] - com[0], s.middle[1] - com[1]};
        double w[2], by_velocity[2][2], by_turn[2];
        relative_velocity(fish, k, &s, u, v, w);
        drag_slope(fish, k, &s, w, by_velocity, by_turn);
        const double by_u = arm[1] * by_velocity[0][0] - arm[0] * by_velocity[1][0];
        const double by_v = arm[1] * by_velocity[0][1] - arm[0] * by_velocity[1][1];
        const double *const du = block->u + flow_midpoint(fish, k), *const dv = block->v + flow_midpoint(fish, k);
        for (long c = 0; c < block->n_columns; c++) {
            row[c * rows->n_rows] += scale * (by_u * du[c * block->n_points] + by_v * dv[c * block->n_points]);
        }
    }
}

double drag_power(const struct fish *fish, const double *u, const double *v, const double *y) {
    double power = 0;
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge s = edge_at(fish, k, y);
        double w[2], force[2];
        relative_velocity(fish, k, &s, u, v, w);
        drag_force(fish, k, &s, w, force);
        power += edge_dot(force, s.velocity);
    }
    return power;
}

double drag_added_mass_power(const struct fish *fish, const double *y) {
    double power = 0;
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge s = edge_at(fish, k, y);
        power -= fish->added_mass[k] * edge_dot(s.acceleration, s.n) * edge_dot(s.velocity, s.n);
    }
    return power;
}
