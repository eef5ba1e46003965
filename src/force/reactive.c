/* reactive.c: the published added mass; Lagrange's equations of mu w_n^2/2. */
#include "force/reactive.h"

#include <math.h>
#include <string.h>

// components of w and of the relative acceleration a - b in the frame of the edge, and the coefficients of the force
struct frame {
    double wt, wn, at, an;
    double turn_rate;
    double push; /* coefficient of n in the force: (a - b).n - turn_rate w_t */
    double pair; /* mu w_n w_t/l: Munk's couple on the edge over the length of the edge */
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

void reactive_force(const struct fish *fish, int k, const struct edge *edge, const double w[2], const double b[2],
                    double force[2][2]) {
    const double half_mass = fish->added_mass[k] / 2;
    if (fish->force == FORCE_PUBLISHED) {
        const double inertia = half_mass * edge_dot(edge->acceleration, edge->n);
        for (int i = 0; i < 2; i++) force[0][i] = force[1][i] = -inertia * edge->n[i];
        return;
    }

    const struct frame f = reactive_frame(fish, k, edge, w, b);
    for (int i = 0; i < 2; i++) {
        const double both = -half_mass * (f.push * edge->n[i] - f.wn * f.turn_rate * edge->t[i]);
        const double gradient = fish->displaced_mass[k] / 2 * b[i];
        force[0][i] = both + gradient + f.pair * edge->n[i];
        force[1][i] = both + gradient - f.pair * edge->n[i];
    }
}

static void reactive_published_slope(const struct fish *fish, int k, const struct edge *edge,
                                     struct reactive_slope *slope) {
    const double half_mass = fish->added_mass[k] / 2;
    const double an = edge_dot(edge->acceleration, edge->n), at = edge_dot(edge->acceleration, edge->t);
    for (int i = 0; i < 2; i++) {
        slope->by_turn[0][i] = slope->by_turn[1][i] = half_mass * (at * edge->n[i] + an * edge->t[i]);
    }
}

static void reactive_lagrange_slope(const struct fish *fish, int k, const struct edge *edge, const double w[2],
                                    const double b[2], struct reactive_slope *slope) {
    const double *const t = edge->t, *const n = edge->n, l = edge->length;
    const double half_mass = fish->added_mass[k] / 2;
    const struct frame f = reactive_frame(fish, k, edge, w, b);

    // by a rotation: dw_n = -w_t, dw_t = w_n, d(a.n) = -a.t
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

void reactive_slope(const struct fish *fish, int k, const struct edge *edge, const double w[2], const double b[2],
                    struct reactive_slope *slope) {
    memset(slope, 0, sizeof *slope);
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            slope->by_acceleration[i][j] = -fish->added_mass[k] / 2 * edge->n[i] * edge->n[j];
        }
    }

    if (fish->force == FORCE_PUBLISHED) {
        reactive_published_slope(fish, k, edge, slope);
        return;
    }

    reactive_lagrange_slope(fish, k, edge, w, b, slope);
}

double reactive_power(const struct fish *fish, int k, const struct edge *edge, const double w[2], const double b[2]) {
    if (fish->force == FORCE_PUBLISHED) {
        return -fish->added_mass[k] * edge_dot(edge->acceleration, edge->n) * edge_dot(edge->velocity, edge->n);
    }

    double force[2][2], power = 0;
    reactive_force(fish, k, edge, w, b, force);
    for (int i = 0; i < 2; i++) {
        power += (force[0][i] + force[1][i]) * edge->velocity[i] + (force[1][i] - force[0][i]) * edge->rate[i] / 2;
    }

    return power;
}

double reactive_energy(const struct fish *fish, int k, const struct edge *edge, const double w[2]) {
    const double wn = edge_dot(w, edge->n);
    return fish->added_mass[k] * wn * wn / 2;
}
