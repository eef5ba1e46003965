/* drag.c: drag on an edge in the frame of the edge, and the derivatives of this drag. */
#include "force/drag.h"

#include <math.h>

#include "body/rod.h"
#include "flow/flow_at_bodies.h"

static double drag_speed_law(const struct fish *fish, double speed) {
    return speed * (fabs(speed) + fish->linear_speed);
}

static double drag_speed_law_slope(const struct fish *fish, double speed) {
    return 2 * fabs(speed) + fish->linear_speed;
}

/* Friction of a boundary layer on an edge over tangential velocity, kg s-1, and the derivative of this ratio by s2, the
 * sum of the squares of velocity and u0. */
struct boundary_layer {
    double resistance, by_square;
};

static struct boundary_layer boundary_layer(const struct fish *fish, int k, double square) {
    // B: turbulent fraction, 1 - B: laminar fraction; dB/ds2 = 2 B (1 - B)/s2
    const double ratio = square * fish->past_transition[k], laminar = 1 / (1 + ratio * ratio), turbulent = 1 - laminar;
    const double by_square = 2 * turbulent * laminar / square;
    const double factor = fish->form * (1 + (fish->waving - 1) * laminar);
    const double factor_slope = -fish->form * (fish->waving - 1) * by_square;

    // laminar and turbulent friction, blended
    const double blasius = fish->drag_tangential[k] * sqrt(sqrt(square));
    const double power_law = fish->drag_turbulent[k] * pow(square, 0.4);
    const double sum = laminar * blasius + turbulent * power_law;
    const double slope =
        by_square * (power_law - blasius) + (laminar * blasius / 4 + turbulent * power_law * 2 / 5) / square;
    return (struct boundary_layer){factor * sum, factor * slope + factor_slope * sum};
}

static double friction_speed_square(const struct fish *fish, double speed) {
    return speed * speed + fish->friction_speed * fish->friction_speed;
}

// tangential drag on edge k; laminar: c_t (u^2 + u0^2)^(1/4) u
static double skin_drag(const struct fish *fish, int k, double speed) {
    switch (fish->skin) {
        case SKIN_LAMINAR: return fish->drag_tangential[k] * (sqrt(hypot(speed, fish->friction_speed)) * speed);
        case SKIN_BOUNDARY_LAYER: return boundary_layer(fish, k, friction_speed_square(fish, speed)).resistance * speed;
        case SKIN_QUADRATIC: break;
    }
    return fish->drag_tangential[k] * drag_speed_law(fish, speed);
}

static double skin_drag_slope(const struct fish *fish, int k, double speed) {
    if (fish->skin == SKIN_BOUNDARY_LAYER) {
        const struct boundary_layer layer = boundary_layer(fish, k, friction_speed_square(fish, speed));
        return layer.resistance + 2 * layer.by_square * speed * speed;
    }

    if (fish->skin == SKIN_QUADRATIC) return fish->drag_tangential[k] * drag_speed_law_slope(fish, speed);
    const double size = hypot(speed, fish->friction_speed);
    return fish->drag_tangential[k] * (sqrt(size) * (1 + speed / size * (speed / size) / 2));
}

void drag_force(const struct fish *fish, int k, const struct edge *s, const double w[2], double force[2]) {
    const double along = skin_drag(fish, k, edge_dot(w, s->t));
    const double across = fish->drag_normal[k] * drag_speed_law(fish, edge_dot(w, s->n));
    for (int i = 0; i < 2; i++) force[i] = -along * s->t[i] - across * s->n[i];
}

void drag_friction(const struct fish *fish, int k, const struct edge *s, const double w[2], double force[2]) {
    const double along = skin_drag(fish, k, edge_dot(w, s->t));
    for (int i = 0; i < 2; i++) force[i] = -along * s->t[i];
}

void drag_slope(const struct fish *fish, int k, const struct edge *s, const double w[2], double by_velocity[2][2],
                double by_turn[2]) {
    const double wt = edge_dot(w, s->t), wn = edge_dot(w, s->n);
    const double along = skin_drag(fish, k, wt);
    const double across = fish->drag_normal[k] * drag_speed_law(fish, wn);
    const double along_slope = skin_drag_slope(fish, k, wt);
    const double across_slope = fish->drag_normal[k] * drag_speed_law_slope(fish, wn);

    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            by_velocity[i][j] = -along_slope * s->t[i] * s->t[j] - across_slope * s->n[i] * s->n[j];
        }
        by_turn[i] = -along_slope * wn * s->t[i] - along * s->n[i] + across_slope * wt * s->n[i] + across * s->t[i];
    }
}

// the drag that the flow causes on edge k: F(v - u) - F(v)
static void drag_of_flow(const struct fish *fish, int k, const struct edge *s, const double *u, const double *v,
                         double force[2]) {
    double w[2], still[2];
    flow_relative_velocity(fish, k, s->velocity, u, v, w);
    drag_force(fish, k, s, w, force);
    drag_force(fish, k, s, s->velocity, still);
    force[0] -= still[0];
    force[1] -= still[1];
}

static void drag_centre_of_mass(const struct fish *fish, const double *y, double com[2]) {
    com[0] = com[1] = 0;
    for (int k = 0; k < fish->n_nodes; k++) {
        com[0] += fish->mass[k] / fish->total_mass * y[fish->at.x + k];
        com[1] += fish->mass[k] / fish->total_mass * y[fish->at.y + k];
    }
}

double drag_moment(const struct fish *fish, const double *u, const double *v, const double *y) {
    double com[2], moment = 0;
    drag_centre_of_mass(fish, y, com);

    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge s = edge_at(fish, k, y);
        double force[2];
        drag_of_flow(fish, k, &s, u, v, force);
        moment += (s.middle[0] - com[0]) * force[1] - (s.middle[1] - com[1]) * force[0];
    }

    return moment / fish->control.torque_scale;
}
