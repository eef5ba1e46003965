/* fluid_force.c: drag and reactive force of every edge on the nodes of the edge, the tail flux on the last node, and
 * the derivatives. */
#include "force/fluid_force.h"

#include "body/rod.h"
#include "force/drag.h"
#include "force/reactive.h"

// forces of one edge: the drag on the edge, the reactive force on each node, and the tail flux on the tail node (last
// edge only)
struct edge_forces {
    struct edge edge;
    double drag[2], friction[2], reactive[2][2], tail[2];
};

static struct edge_forces forces_of_edge(const struct fish *fish, const struct flow_at_body *flow, int k,
                                         const double *y) {
    struct edge_forces on = {.edge = edge_at(fish, k, y)};
    double w[2];
    flow_relative_velocity(fish, k, on.edge.velocity, flow->u, flow->v, w);
    drag_force(fish, k, &on.edge, w, on.drag, on.friction);
    reactive_force(fish, k, &on.edge, w, flow->acceleration, on.reactive);
    if (k == fish->n_edges - 1) tail_flux_force(fish, flow, y, on.tail);
    return on;
}

void fluid_force_residual(const struct fish *fish, const struct flow_at_body *flow, const double *y, double *residual) {
    const int last = fish->n_edges - 1;
    for (int k = 0; k <= last; k++) {
        const struct edge_forces on = forces_of_edge(fish, flow, k, y);
        for (int end = 0; end < 2; end++) {
            residual[fish->at.ax + k + end] -= on.drag[0] / 2 + on.reactive[end][0];
            residual[fish->at.ay + k + end] -= on.drag[1] / 2 + on.reactive[end][1];
        }

        if (k < last) continue;
        residual[fish->at.ax + k + 1] -= on.tail[0];
        residual[fish->at.ay + k + 1] -= on.tail[1];
    }
}

struct fluid_forces fluid_force_of_edge(const struct fish *fish, const struct flow_at_body *flow, int k,
                                        const double about[2], const double *y) {
    const struct edge_forces on = forces_of_edge(fish, flow, k, y);
    const double arm[2] = {on.edge.middle[0] - about[0], on.edge.middle[1] - about[1]};
    struct fluid_forces forces = {.resistive = {on.drag[0], on.drag[1]},
                                  .friction = {on.friction[0], on.friction[1]},
                                  .resistive_moment = edge_cross(arm, on.drag),
                                  .friction_moment = edge_cross(arm, on.friction)};

    for (int end = 0; end < 2; end++) {
        const double arm_of_node[2] = {y[edge_place(fish, 0, k + end)] - about[0],
                                       y[edge_place(fish, 1, k + end)] - about[1]};
        double force[2];
        for (int i = 0; i < 2; i++) {
            force[i] = on.reactive[end][i] + (end == 1 ? on.tail[i] : 0);
            forces.reactive[i] += force[i];
        }

        forces.reactive_moment += edge_cross(arm_of_node, force);
    }

    return forces;
}

struct fluid_forces fluid_force_sum(const struct fish *fish, const struct flow_at_body *flow, const double about[2],
                                    const double *y) {
    struct fluid_forces sum = {.resistive_moment = 0};
    for (int k = 0; k < fish->n_edges; k++) {
        const struct fluid_forces of_edge = fluid_force_of_edge(fish, flow, k, about, y);
        for (int i = 0; i < 2; i++) {
            sum.resistive[i] += of_edge.resistive[i];
            sum.friction[i] += of_edge.friction[i];
            sum.reactive[i] += of_edge.reactive[i];
        }

        sum.resistive_moment += of_edge.resistive_moment;
        sum.friction_moment += of_edge.friction_moment;
        sum.reactive_moment += of_edge.reactive_moment;
    }

    return sum;
}

// derivatives of all forces of edge k on each node; half of the drag acts on each node
static void slope_of_edge(const struct fish *fish, const struct flow_at_body *flow, int k, const struct edge *edge,
                          struct reactive_slope *slope) {
    double w[2], by_velocity[2][2], by_turn[2];
    flow_relative_velocity(fish, k, edge->velocity, flow->u, flow->v, w);
    drag_slope(fish, k, edge, w, by_velocity, by_turn);
    reactive_slope(fish, k, edge, w, flow->acceleration, slope);

    for (int end = 0; end < 2; end++) {
        for (int i = 0; i < 2; i++) {
            slope->by_turn[end][i] += by_turn[i] / 2;
            for (int j = 0; j < 2; j++) slope->by_velocity[end][i][j] += by_velocity[i][j] / 2;
        }
    }
}

void fluid_force_jacobian(const struct fish *fish, const struct flow_at_body *flow, const double *y,
                          struct sparse *jacobian) {
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, y);
        struct reactive_slope slope;
        slope_of_edge(fish, flow, k, &edge, &slope);

        // rows: components of both nodes; columns: components of both nodes
        for (int row = 0; row < 4; row++) {
            const int end = row / 2, i = row % 2, equation = edge_acceleration(fish, i, k + end);
            const double mass = fish->mass[k + end];
            for (int column = 0; column < 4; column++) {
                const int other = column / 2, j = column % 2;
                const double sign = other == 0 ? -1 : 1;
                const double by_place = slope.by_turn[end][i] * (sign / edge.length) * edge.n[j] +
                                        slope.by_length[end][i] * sign * edge.t[j];
                const double by_velocity = slope.by_velocity[end][i][j] / 2 + sign * slope.by_rate[end][i][j];
                sparse_add(jacobian, equation, edge_place(fish, j, k + other), -by_place / mass);
                sparse_add(jacobian, equation, edge_velocity(fish, j, k + other), -by_velocity / mass);
                sparse_add(jacobian, equation, edge_acceleration(fish, j, k + other),
                           -slope.by_acceleration[i][j] / 2 / mass);
            }
        }
    }

    tail_flux_jacobian(fish, flow, y, jacobian);
}

void fluid_force_flow_jacobian(const struct fish *fish, const struct flow_at_body *flow,
                               const struct influence_block *block, const double *y, struct coupling_block *rows) {
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, y);
        struct reactive_slope slope;
        slope_of_edge(fish, flow, k, &edge, &slope);

        const double per_mass[2] = {1 / fish->mass[k], 1 / fish->mass[k + 1]};
        const double *const du = block->u + flow_midpoint(fish, k), *const dv = block->v + flow_midpoint(fish, k);
        for (long c = 0; c < block->n_columns; c++) {
            double *const ax = rows->value + c * rows->n_rows + k, *const ay = ax + fish->n_nodes;
            const double by_u = du[c * block->n_points], by_v = dv[c * block->n_points];
            for (int end = 0; end < 2; end++) {
                const double(*const by_velocity)[2] = slope.by_velocity[end];
                ax[end] += (by_velocity[0][0] * by_u + by_velocity[0][1] * by_v) * per_mass[end];
                ay[end] += (by_velocity[1][0] * by_u + by_velocity[1][1] * by_v) * per_mass[end];
            }
        }
    }

    tail_flux_flow_jacobian(fish, flow, block, y, rows);
}

struct fluid_power fluid_force_power(const struct fish *fish, const struct flow_at_body *flow, const double *y) {
    struct fluid_power power = {.wake = 0};
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, y);
        double w[2], drag[2], friction[2];
        flow_relative_velocity(fish, k, edge.velocity, flow->u, flow->v, w);
        drag_force(fish, k, &edge, w, drag, friction);
        power.drag += edge_dot(drag, edge.velocity);
        power.friction += edge_dot(friction, edge.velocity);
        if (fish->force == FORCE_PUBLISHED) {
            const double inertia = fish->added_mass[k] * edge_dot(edge.acceleration, edge.n);
            power.added_mass -= inertia * edge_dot(edge.velocity, edge.n);
            continue;
        }

        // reactive forces on both nodes
        double force[2][2], of_edge = 0;
        reactive_force(fish, k, &edge, w, flow->acceleration, force);
        for (int i = 0; i < 2; i++) {
            of_edge += (force[0][i] + force[1][i]) * edge.velocity[i] + (force[1][i] - force[0][i]) * edge.rate[i] / 2;
        }
        power.added_mass += of_edge;
    }

    // momentum flux at the tail: never positive in still fluid
    if (fish->tail_added_mass > 0) {
        double force[2];
        tail_flux_force(fish, flow, y, force);
        power.wake = force[0] * y[fish->at.vx + fish->n_nodes - 1] + force[1] * y[fish->at.vy + fish->n_nodes - 1];
    }
    return power;
}

double fluid_force_added_mass_energy(const struct fish *fish, const struct flow_at_body *flow, const double *y) {
    double energy = 0;
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, y);
        double w[2];
        flow_relative_velocity(fish, k, edge.velocity, flow->u, flow->v, w);
        const double wn = edge_dot(w, edge.n);
        energy += fish->added_mass[k] * wn * wn / 2;
    }

    return energy;
}
