/* clamp.c: a joint of the rod with one given edge direction. */
#include "body/clamp.h"

#include "body/rod.h"
#include "fish/fish_motion.h"

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

void clamp_residual(const struct fish *fish, double t, const double *y, double *residual) {
    if (!fish->has_clamp) return;
    const struct clamp clamp = clamp_at(fish, t, y);
    for (int i = 0; i < 2; i++) {
        const double force = clamp.moment * clamp.edge.n[i] / clamp.edge.length;
        residual[edge_acceleration(fish, i, 0)] -= force;
        residual[edge_acceleration(fish, i, 1)] += force;
    }
}

void clamp_jacobian(const struct fish *fish, double t, const double *y, struct sparse *jacobian) {
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

struct clamp_terms clamp_terms(const struct fish *fish, double t, const double *y) {
    if (!fish->has_clamp) return (struct clamp_terms){0};
    const struct clamp clamp = clamp_at(fish, t, y);
    return (struct clamp_terms){.energy = fish->clamp_stiffness * clamp.bend.curvature * clamp.bend.curvature / 2,
                                .damping_power = -clamp.by_rate * clamp.angle_rate * clamp.angle_rate,
                                .driving_power = -clamp.moment * clamp.given_rate,
                                .moment = -clamp.moment};
}
