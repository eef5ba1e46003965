/* bending_mode.c: the slowest bending mode, by power iteration on the flexibility of a body (Stodola's method). */
#include "body/bending_mode.h"

#include <math.h>

#include "body/rod.h"

/* Data of the power iteration. */
struct modes {
    const struct fish *fish;
    bool is_held;
    double *mode, *next, *load, *term;
    double *rigid[2]; /* the loads of translation and rotation */
};

// The momentum of body and fluid for the normal node velocities w of a straight body. The jump of the potential of a
// straight sheet without shedding is L sum (2/(pi n)) (int w sin(theta) sin(n theta) dtheta) sin(n theta). Where the
// depth varies, two strips act on each other with the geometric mean of their depths: the fluid then has an energy.
static void momentum_load(const struct modes *modes, const double *w, double *load) {
    const struct fish *const fish = modes->fish;
    for (int k = 0; k < fish->n_nodes; k++) {
        // mass plus local lateral added mass
        const double before = k > 0 ? fish->added_mass[k - 1] : 0, after = k < fish->n_edges ? fish->added_mass[k] : 0;
        load[k] = (fish->mass[k] + (before + after) / 2) * w[k];
    }
    if (!fish_is_loaded_by_sheet(fish)) return;

    const int n_terms = fish->n_nodes, n_points = 4 * fish->n_nodes;
    const double step = M_PI / n_points;
    double *const term = modes->term;
    for (int n = 0; n < n_terms; n++) term[n] = 0;
    for (int add = 0; add < 2; add++) {  // first the integrals, then the loads
        for (int i = 0; i < n_points; i++) {
            // the point at s = L (1 - cos theta)/2: the node before the point, and the fraction of the edge
            const double theta = (i + 0.5) * step, first = sin(theta), cosine = cos(theta);
            const double along = fish->n_edges * (1 - cosine) / 2;
            const int node = along < fish->n_edges ? (int)along : fish->n_edges - 1;
            const double part = along - node, here = (1 - part) * w[node] + part * w[node + 1];
            const double root = sqrt(fish->depth[node]);
            double sine = first, before = 0, jump = 0;
            for (int n = 0; n < n_terms; n++) {
                if (add) jump += fish->length * 2 / (M_PI * (n + 1)) * term[n] * sine;
                if (!add) term[n] += step * root * here * first * sine;
                const double next = 2 * cosine * sine - before;
                before = sine;
                sine = next;
            }

            const double size = fish->fluid_density * root * jump * fish->length / 2 * first * step;
            load[node] += (1 - part) * size;
            load[node + 1] += part * size;
        }
    }
}

static double load_product(const struct fish *fish, const double *load, const double *w) {
    double sum = 0;
    for (int k = 0; k < fish->n_nodes; k++) sum += load[k] * w[k];
    return sum;
}

// remove the rigid motion of a free body: translation and rotation
static void rigid_remove(const struct modes *modes, double *w) {
    const int n = modes->fish->n_nodes;
    double m[3] = {0, 0, 0};
    for (int k = 0; k < n; k++) {
        m[0] += modes->rigid[0][k];
        m[1] += modes->rigid[1][k];
        m[2] += modes->rigid[1][k] * k;
    }

    const double by[2] = {load_product(modes->fish, modes->rigid[0], w), load_product(modes->fish, modes->rigid[1], w)};
    const double det = m[0] * m[2] - m[1] * m[1];
    const double a = (by[0] * m[2] - by[1] * m[1]) / det, b = (by[1] * m[0] - by[0] * m[1]) / det;
    for (int k = 0; k < n; k++) w[k] -= a + b * k;
}

double bending_mode_frequency(const struct fish *fish, double *scratch) {
    enum { ITERATIONS = 25 };  // an iteration reduces the next mode of a uniform body to 0.13
    const int n = fish->n_nodes;
    const struct modes modes = {.fish = fish,
                                .is_held = fish->motion.prescribed == PRESCRIBED_HEAD,
                                .mode = scratch,
                                .next = scratch + n,
                                .load = scratch + 2 * n,
                                .term = scratch + 3 * n,
                                .rigid = {scratch + 4 * n, scratch + 5 * n}};
    double *const next = modes.next, square = 0;  // of the angular frequency
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < n; k++) next[k] = pow(k, i);
        momentum_load(&modes, next, modes.rigid[i]);
    }
    for (int k = 0; k < n; k++) modes.mode[k] = (double)k * k;

    for (int iteration = 0; iteration < ITERATIONS; iteration++) {
        // a mode with the momentum 1
        if (!modes.is_held) rigid_remove(&modes, modes.mode);
        momentum_load(&modes, modes.mode, modes.load);
        const double size = sqrt(load_product(fish, modes.load, modes.mode));
        for (int k = 0; k < n; k++) modes.load[k] /= size;

        // bending moments from the loads, joint angles from the moments: moments of a held body are summed from the
        // tail, moments of a free body from either end; the angle of a joint is stored at the node behind the joint
        double shear = 0, moment = 0;
        for (int i = 0; i < fish->n_joints; i++) {
            const int node = modes.is_held ? n - 1 - i : i, joint = modes.is_held ? fish->n_joints - 1 - i : i;
            shear += modes.load[node];
            moment += shear * fish->edge_length;
            next[joint + 2] = moment * fish->edge_length / fish->bending_stiffness[joint];
        }

        // displacements in place of the angles
        next[0] = next[1] = 0;
        for (int k = 2; k < n; k++) next[k] = 2 * next[k - 1] - next[k - 2] + fish->edge_length * next[k];

        if (!modes.is_held) rigid_remove(&modes, next);
        momentum_load(&modes, next, modes.load);
        square = 1 / sqrt(load_product(fish, modes.load, next));
        for (int k = 0; k < n; k++) modes.mode[k] = next[k];
    }

    return sqrt(square) / (2 * M_PI);
}
