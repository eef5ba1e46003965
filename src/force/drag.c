/* drag.c: the laws of drag along and across an edge, each with its slope. Another law goes beside them. */
#include "force/drag.h"

#include <math.h>

#include "body/rod.h"
#include "flow/flow_at_bodies.h"

/* The drag at a speed, N, and its derivative by the speed, N s m-1. */
struct drag_at {
    double force, slope;
};

// factor v (V1 + |v|)
static struct drag_at drag_speed_law(const struct fish *fish, double factor, double speed) {
    return (struct drag_at){factor * (speed * (fabs(speed) + fish->linear_speed)),
                            factor * (2 * fabs(speed) + fish->linear_speed)};
}

// tangential drag on edge k; waving: K_w, by which waving raises the friction
static struct drag_at drag_tangential(const struct fish *fish, int k, double waving, double speed) {
    if (fish->friction == FRICTION_QUADRATIC) return drag_speed_law(fish, fish->drag_tangential[k], speed);

    // laminar: c_t (u^2 + u0^2)^(1/4) u
    if (fish->friction == FRICTION_LAMINAR) {
        const double size = hypot(speed, fish->friction_speed);
        const double by_speed = sqrt(size) * (1 + speed / size * (speed / size) / 2);
        return (struct drag_at){fish->drag_tangential[k] * (sqrt(size) * speed), fish->drag_tangential[k] * by_speed};
    }

    // B is the turbulent fraction and 1 - B the laminar one, and dB/ds2 = 2 B (1 - B)/s2
    const double square = speed * speed + fish->friction_speed * fish->friction_speed;
    const double ratio = square * fish->past_transition[k], laminar = 1 / (1 + ratio * ratio), turbulent = 1 - laminar;
    const double by_square = 2 * turbulent * laminar / square;
    const double factor = fish->form * (1 + (waving - 1) * laminar);
    const double factor_slope = -fish->form * (waving - 1) * by_square;

    // laminar and turbulent friction over the speed are blended; slope is the derivative by s2
    const double blasius = fish->drag_tangential[k] * sqrt(sqrt(square));
    const double power_law = fish->drag_turbulent[k] * pow(square, 0.4);
    const double sum = laminar * blasius + turbulent * power_law;
    const double slope =
        by_square * (power_law - blasius) + (laminar * blasius / 4 + turbulent * power_law * 2 / 5) / square;
    const double resistance = factor * sum, resistance_slope = factor * slope + factor_slope * sum;
    return (struct drag_at){resistance * speed, resistance + 2 * resistance_slope * speed * speed};
}

void drag_force(const struct fish *fish, int k, const struct edge *s, const double w[2], double force[2],
                double friction[2]) {
    const double along = drag_tangential(fish, k, fish->waving, edge_dot(w, s->t)).force;
    const double across = drag_speed_law(fish, fish->drag_normal[k], edge_dot(w, s->n)).force;
    for (int i = 0; i < 2; i++) {
        force[i] = -along * s->t[i] - across * s->n[i];
        friction[i] = -along * s->t[i];
    }
}

void drag_slope(const struct fish *fish, int k, const struct edge *s, const double w[2], double by_velocity[2][2],
                double by_turn[2]) {
    const double wt = edge_dot(w, s->t), wn = edge_dot(w, s->n);
    const struct drag_at along = drag_tangential(fish, k, fish->waving, wt);
    const struct drag_at across = drag_speed_law(fish, fish->drag_normal[k], wn);

    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            by_velocity[i][j] = -along.slope * s->t[i] * s->t[j] - across.slope * s->n[i] * s->n[j];
        }
        by_turn[i] =
            -along.slope * wn * s->t[i] - along.force * s->n[i] + across.slope * wt * s->n[i] + across.force * s->t[i];
    }
}

double drag_towed(const struct fish *fish, double speed) {
    double sum = 0;
    for (int k = 0; k < fish->n_edges; k++) sum += drag_tangential(fish, k, 1, speed).force;
    return sum;
}

double drag_moment(const struct fish *fish, const double *u, const double *v, const double *y) {
    double com[2] = {0, 0}, moment = 0;
    for (int k = 0; k < fish->n_nodes; k++) {
        com[0] += fish->mass[k] / fish->total_mass * y[fish->at.x + k];
        com[1] += fish->mass[k] / fish->total_mass * y[fish->at.y + k];
    }

    for (int k = 0; k < fish->n_edges; k++) {
        // the drag that the flow causes: F(v - u) - F(v)
        const struct edge s = edge_at(fish, k, y);
        double w[2], force[2], still[2], friction[2];
        flow_relative_velocity(fish, k, s.velocity, u, v, w);
        drag_force(fish, k, &s, w, force, friction);
        drag_force(fish, k, &s, s.velocity, still, friction);
        moment += (s.middle[0] - com[0]) * (force[1] - still[1]) - (s.middle[1] - com[1]) * (force[0] - still[0]);
    }

    return moment / fish->control.torque_scale;
}
