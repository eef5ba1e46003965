/* bending_mode.c: power iteration on the flexibility of a body (Stodola's method). */
#include "model/bending_mode.h"

#include <math.h>

// mass of a node with that of the fluid that it accelerates sideways, kg
static double moving_mass(const struct fish *fish, int k) {
    const double before = k > 0 ? fish->added_mass[k - 1] : 0, after = k < fish->n_edges ? fish->added_mass[k] : 0;
    return fish->mass[k] + (before + after) / 2;
}

static double weighted(const struct fish *fish, const double *w, int power) {
    double sum = 0;
    for (int k = 0; k < fish->n_nodes; k++) sum += moving_mass(fish, k) * pow(k, power) * w[k];
    return sum;
}

// take away what moves a free body without bending it: its translation and its rotation
static void remove_rigid(const struct fish *fish, double *w) {
    double m[3] = {0, 0, 0};
    for (int k = 0; k < fish->n_nodes; k++) {
        for (int i = 0; i < 3; i++) m[i] += moving_mass(fish, k) * pow(k, i);
    }
    const double by[2] = {weighted(fish, w, 0), weighted(fish, w, 1)}, det = m[0] * m[2] - m[1] * m[1];
    const double a = (by[0] * m[2] - by[1] * m[1]) / det, b = (by[1] * m[0] - by[0] * m[1]) / det;
    for (int k = 0; k < fish->n_nodes; k++) w[k] -= a + b * k;
}

static double norm(const struct fish *fish, const double *w) {
    double sum = 0;
    for (int k = 0; k < fish->n_nodes; k++) sum += moving_mass(fish, k) * w[k] * w[k];
    return sqrt(sum);
}

// the displacements w under the loads mass times mode: bending moments from the loads, joint angles from the moments;
// those of a held body come from its tail, those of a free one from either end
static void deflect(const struct fish *fish, int is_held, const double *mode, double *w) {
    const double l = fish->edge_length;
    double *const angle = w + 2;  // of joint j at the node behind it, where its displacement will be
    double shear = 0, moment = 0;
    for (int i = 0; i < fish->n_joints; i++) {
        const int node = is_held ? fish->n_nodes - 1 - i : i, joint = is_held ? fish->n_joints - 1 - i : i;
        shear += moving_mass(fish, node) * mode[node];
        moment += shear * l;
        angle[joint] = moment * l / fish->bending_stiffness[joint];
    }
    w[0] = w[1] = 0;
    for (int k = 2; k < fish->n_nodes; k++) w[k] = 2 * w[k - 1] - w[k - 2] + l * w[k];
}

double bending_mode_frequency(const struct fish *fish, double *scratch) {
    enum { ITERATIONS = 60 };  // each takes away 0.13 of the next mode of a uniform body
    const int is_held = fish->motion.prescribed == PRESCRIBED_HEAD;
    double *const mode = scratch, *const next = scratch + fish->n_nodes;
    double square = 0;  // of the angular frequency
    for (int k = 0; k < fish->n_nodes; k++) mode[k] = (double)k * k;
    for (int i = 0; i < ITERATIONS; i++) {
        if (!is_held) remove_rigid(fish, mode);
        const double size = norm(fish, mode);
        for (int k = 0; k < fish->n_nodes; k++) mode[k] /= size;
        deflect(fish, is_held, mode, next);
        if (!is_held) remove_rigid(fish, next);
        square = 1 / norm(fish, next);
        for (int k = 0; k < fish->n_nodes; k++) mode[k] = next[k];
    }
    return sqrt(square) / (2 * M_PI);
}
