/* rod_stress.c: running sums from the tail; an exponential integrator for every joint and edge. */
#include "body/rod_stress.h"

#include <math.h>

#include "body/edge.h"
#include "fish/fish_prescribed.h"

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
