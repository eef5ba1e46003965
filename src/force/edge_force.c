/* edge_force.c: shares drag and reaction of every edge between its nodes, adds the tail flux to the last node, and
 * gives the derivatives. */
#include "force/edge_force.h"

#include <math.h>
#include <string.h>

#include "body/rod.h"
#include "fish/fish_motion.h"
#include "force/drag.h"
#include "force/reactive.h"
#include "state/impulse.h"

// the forces of one edge: the drag on the edge, the reactive force on each node, and, on the last edge, the tail flux
struct edge_forces {
    struct edge edge;
    double drag[2], friction[2], reactive[2][2], tail[2];
};

static struct edge_forces forces_of_edge(const struct fluid_force *force, const struct flow_at_body *flow, int k,
                                         const double *y) {
    const struct fish *const fish = force->fish;
    const struct edge_reaction *const reaction = force->model->reaction;
    struct edge_forces on = {.edge = edge_at(fish, k, y)};
    double w[2];
    flow_relative_velocity(fish, k, on.edge.velocity, flow->u, flow->v, w);
    drag_force(fish, k, &on.edge, w, on.drag, on.friction);
    if (reaction) reaction->force(fish, k, &on.edge, w, flow->acceleration, on.reactive);
    if (k == fish->n_edges - 1) tail_flux_force(fish, flow, y, on.tail);
    return on;
}

void edge_force_residual(const struct fluid_force *force, const struct flow_at_body *flow, const double *y,
                         double *residual) {
    const struct fish *const fish = force->fish;
    const int last = fish->n_edges - 1;
    for (int k = 0; k <= last; k++) {
        const struct edge_forces on = forces_of_edge(force, flow, k, y);
        for (int end = 0; end < 2; end++) {
            residual[fish->at.ax + k + end] -= on.drag[0] / 2 + on.reactive[end][0];
            residual[fish->at.ay + k + end] -= on.drag[1] / 2 + on.reactive[end][1];
        }

        if (k < last) continue;
        residual[fish->at.ax + k + 1] -= on.tail[0];
        residual[fish->at.ay + k + 1] -= on.tail[1];
    }
}

struct fluid_forces edge_force_of_edge(const struct fluid_force *force, const struct flow_at_body *flow, int k,
                                       const double about[2], const double *y) {
    const struct fish *const fish = force->fish;
    const struct edge_forces on = forces_of_edge(force, flow, k, y);
    const double arm[2] = {on.edge.middle[0] - about[0], on.edge.middle[1] - about[1]};
    struct fluid_forces forces = {.resistive = {on.drag[0], on.drag[1]},
                                  .friction = {on.friction[0], on.friction[1]},
                                  .resistive_moment = edge_cross(arm, on.drag),
                                  .friction_moment = edge_cross(arm, on.friction),
                                  .pressure = {.leading_edge_a0 = NAN}};

    for (int end = 0; end < 2; end++) {
        const double arm_of_node[2] = {y[edge_place(fish, 0, k + end)] - about[0],
                                       y[edge_place(fish, 1, k + end)] - about[1]};
        double on_node[2];
        for (int i = 0; i < 2; i++) {
            on_node[i] = on.reactive[end][i] + (end == 1 ? on.tail[i] : 0);
            forces.reactive[i] += on_node[i];
        }

        forces.reactive_moment += edge_cross(arm_of_node, on_node);
    }

    return forces;
}

struct fluid_forces edge_force_sum(const struct fluid_force *force, const struct flow_at_body *flow,
                                   const double about[2], const double *y) {
    struct fluid_forces sum = {.pressure = {.leading_edge_a0 = NAN}};
    for (int k = 0; k < force->fish->n_edges; k++) {
        const struct fluid_forces of_edge = edge_force_of_edge(force, flow, k, about, y);
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

// how all forces of edge k on each node change; half of the drag acts on each of them
static void slope_of_edge(const struct fluid_force *force, const struct flow_at_body *flow, int k,
                          const struct edge *edge, struct reaction_slope *slope) {
    const struct fish *const fish = force->fish;
    const struct edge_reaction *const reaction = force->model->reaction;
    double w[2], by_velocity[2][2], by_turn[2];
    flow_relative_velocity(fish, k, edge->velocity, flow->u, flow->v, w);
    drag_slope(fish, k, edge, w, by_velocity, by_turn);
    memset(slope, 0, sizeof *slope);
    if (reaction) reaction->slope(fish, k, edge, w, flow->acceleration, slope);

    for (int end = 0; end < 2; end++) {
        for (int i = 0; i < 2; i++) {
            slope->by_turn[end][i] += by_turn[i] / 2;
            for (int j = 0; j < 2; j++) slope->by_velocity[end][i][j] += by_velocity[i][j] / 2;
        }
    }
}

void edge_force_jacobian(const struct fluid_force *force, const struct flow_at_body *flow, const double *y,
                         struct sparse *jacobian) {
    const struct fish *const fish = force->fish;
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, y);
        struct reaction_slope slope;
        slope_of_edge(force, flow, k, &edge, &slope);

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

void edge_force_flow_jacobian(const struct fluid_force *force, const struct flow_at_body *flow,
                              const struct influence_block *block, const double *y, struct coupling_block *rows) {
    const struct fish *const fish = force->fish;
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, y);
        struct reaction_slope slope;
        slope_of_edge(force, flow, k, &edge, &slope);

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

struct fluid_power edge_force_power(const struct fluid_force *force, const struct flow_at_body *flow, const double *y) {
    const struct fish *const fish = force->fish;
    const struct edge_reaction *const reaction = force->model->reaction;
    struct fluid_power power = {.wake = 0};
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, y);
        double w[2], drag[2], friction[2];
        flow_relative_velocity(fish, k, edge.velocity, flow->u, flow->v, w);
        drag_force(fish, k, &edge, w, drag, friction);
        power.drag += edge_dot(drag, edge.velocity);
        power.friction += edge_dot(friction, edge.velocity);
        if (reaction) power.added_mass += reaction->power(fish, k, &edge, w, flow->acceleration);
    }

    // the momentum flux at the tail, whose power is never positive in still fluid
    if (fish->tail_added_mass > 0) {
        double on_tail[2];
        tail_flux_force(fish, flow, y, on_tail);
        power.wake = on_tail[0] * y[fish->at.vx + fish->n_nodes - 1] + on_tail[1] * y[fish->at.vy + fish->n_nodes - 1];
    }
    return power;
}

double edge_force_energy(const struct fluid_force *force, const struct flow_at_body *flow, const double *y) {
    const struct fish *const fish = force->fish;
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

// ---- the other functions of a model without momentum of the fluid

// dv/dt = a
static void edge_force_motion_residual(const struct fluid_force *force, bool velocities_are_given, const double *y,
                                       const double *yp, double *residual) {
    (void)velocities_are_given;
    const struct fish *const fish = force->fish;
    for (int i = 0; i < 2 * fish->n_nodes; i++) {
        if (fish_is_prescribed(fish, i % fish->n_nodes, i / fish->n_nodes)) continue;
        residual[fish->at.vx + i] = yp[fish->at.vx + i] - y[fish->at.ax + i];
    }
}

static void edge_force_motion_jacobian(const struct fluid_force *force, bool velocities_are_given, double cj,
                                       const double *y, struct sparse *jacobian) {
    (void)velocities_are_given, (void)y;
    const struct fish *const fish = force->fish;
    for (int i = 0; i < 2 * fish->n_nodes; i++) {
        sparse_add(jacobian, fish->at.vx + i, fish->at.vx + i, cj);
        sparse_add(jacobian, fish->at.vx + i, fish->at.ax + i, -1);
    }
}

static void edge_force_add_impulse(const struct fluid_force *force, const struct sources *bound, double factor,
                                   const double *y, double impulse[3]) {
    (void)y;
    struct impulse_moments sheet = {0};
    for (int j = 0; j < force->fish->n_sheet; j++) impulse_add(&sheet, bound->q[j], bound->x[j], bound->y[j]);

    double of_sheet[3];
    impulse_of(&sheet, factor, of_sheet);
    for (int i = 0; i < 3; i++) impulse[i] += of_sheet[i];
}

const struct force_model edge_force_published = {.reaction = &reactive_published,
                                                 .is_for_comparison = true,
                                                 .motion_residual = edge_force_motion_residual,
                                                 .motion_jacobian = edge_force_motion_jacobian,
                                                 .residual = edge_force_residual,
                                                 .jacobian = edge_force_jacobian,
                                                 .flow_jacobian = edge_force_flow_jacobian,
                                                 .forces = edge_force_sum,
                                                 .power = edge_force_power,
                                                 .energy = edge_force_energy,
                                                 .add_impulse = edge_force_add_impulse};

const struct force_model edge_force_reactive = {.reaction = &reactive_of_lagrange,
                                                .motion_residual = edge_force_motion_residual,
                                                .motion_jacobian = edge_force_motion_jacobian,
                                                .residual = edge_force_residual,
                                                .jacobian = edge_force_jacobian,
                                                .flow_jacobian = edge_force_flow_jacobian,
                                                .forces = edge_force_sum,
                                                .power = edge_force_power,
                                                .energy = edge_force_energy,
                                                .add_impulse = edge_force_add_impulse};
