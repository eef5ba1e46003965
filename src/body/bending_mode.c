/* bending_mode.c: power iteration on the flexibility of a body (Stodola's method). */
#include <math.h>

#include "body/rod.h"

// mass of a node plus local lateral added mass, kg
static double moving_mass(const struct fish *fish, int k) {
    const double before = k > 0 ? fish->added_mass[k - 1] : 0, after = k < fish->n_edges ? fish->added_mass[k] : 0;
    return fish->mass[k] + (before + after) / 2;
}

/* A point of a straight sheet, at s = L (1 - cos theta)/2: the node before the point, and the fraction of the edge
 * behind that node. */
struct sheet_point {
    double sine, cosine, part;
    int node;
};
static struct sheet_point sheet_point(const struct fish *fish, double theta) {
    const double u = fish->n_edges * (1 - cos(theta)) / 2;
    const int node = u < fish->n_edges ? (int)u : fish->n_edges - 1;
    return (struct sheet_point){sin(theta), cos(theta), u - node, node};
}

// add the momentum of the fluid around a straight sheet with normal node velocities w, without shedding: the jump of
// the potential is L sum (2/(pi n)) (int w sin(theta) sin(n theta) dtheta) sin(n theta). term: (n_nodes)
static void sheet_momentum_add(const struct fish *fish, const double *w, double *term, double *load) {
    const int n_terms = fish->n_nodes, n_points = 4 * fish->n_nodes;
    const double step = M_PI / n_points;
    for (int n = 0; n < n_terms; n++) term[n] = 0;

    for (int add = 0; add < 2; add++) {  // first the integrals, then the loads
        for (int i = 0; i < n_points; i++) {
            const struct sheet_point at = sheet_point(fish, (i + 0.5) * step);
            const double here = (1 - at.part) * w[at.node] + at.part * w[at.node + 1];
            double sine = at.sine, before = 0, jump = 0;
            for (int n = 0; n < n_terms; n++) {
                if (add) jump += fish->length * 2 / (M_PI * (n + 1)) * term[n] * sine;
                if (!add) term[n] += step * here * at.sine * sine;
                const double next = 2 * at.cosine * sine - before;
                before = sine;
                sine = next;
            }

            const double size = fish->fluid_density * fish->depth[at.node] * jump * fish->length / 2 * at.sine * step;
            load[at.node] += (1 - at.part) * size;
            load[at.node + 1] += at.part * size;
        }
    }
}

/* Data of the power iteration. */
struct modes {
    const struct fish *fish;
    int is_held;
    double *mode, *next, *load, *term;
    double *rigid[2]; /* the loads of translation and rotation */
};

// the momentum of body and fluid for the node velocities w
static void momentum_load(const struct modes *modes, const double *w, double *load) {
    const struct fish *fish = modes->fish;
    for (int k = 0; k < fish->n_nodes; k++) load[k] = moving_mass(fish, k) * w[k];
    if (fish_has_momentum(fish)) sheet_momentum_add(fish, w, modes->term, load);
}

static double load_product(const struct fish *fish, const double *load, const double *w) {
    double sum = 0;
    for (int k = 0; k < fish->n_nodes; k++) sum += load[k] * w[k];
    return sum;
}

static void rigid_loads_find(const struct modes *modes) {
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < modes->fish->n_nodes; k++) modes->next[k] = pow(k, i);
        momentum_load(modes, modes->next, modes->rigid[i]);
    }
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

// the displacements w under a load on the nodes: bending moments from the loads, joint angles from the moments; moments
// of a held body are summed from the tail, moments of a free body from either end
static void body_deflect(const struct modes *modes, const double *load, double *w) {
    const struct fish *fish = modes->fish;
    const double l = fish->edge_length;
    double *const angle =
        w + 2;  // of joint j, stored at the node behind the joint until the displacement replaces the angle
    double shear = 0, moment = 0;

    for (int i = 0; i < fish->n_joints; i++) {
        const int node = modes->is_held ? fish->n_nodes - 1 - i : i,
                  joint = modes->is_held ? fish->n_joints - 1 - i : i;
        shear += load[node];
        moment += shear * l;
        angle[joint] = moment * l / fish->bending_stiffness[joint];
    }

    w[0] = w[1] = 0;
    for (int k = 2; k < fish->n_nodes; k++) w[k] = 2 * w[k - 1] - w[k - 2] + l * w[k];
}

double bending_mode_frequency(const struct fish *fish, double *scratch) {
    enum { ITERATIONS = 60 };  // an iteration reduces the next mode of a uniform body to 0.13
    const int n = fish->n_nodes;
    const struct modes modes = {.fish = fish,
                                .is_held = fish->motion.prescribed == PRESCRIBED_HEAD,
                                .mode = scratch,
                                .next = scratch + n,
                                .load = scratch + 2 * n,
                                .term = scratch + 3 * n,
                                .rigid = {scratch + 4 * n, scratch + 5 * n}};

    double square = 0;  // of the angular frequency
    rigid_loads_find(&modes);
    for (int k = 0; k < n; k++) modes.mode[k] = (double)k * k;

    for (int i = 0; i < ITERATIONS; i++) {
        if (!modes.is_held) rigid_remove(&modes, modes.mode);
        momentum_load(&modes, modes.mode, modes.load);
        const double size = sqrt(load_product(fish, modes.load, modes.mode));
        for (int k = 0; k < n; k++) modes.load[k] /= size;
        body_deflect(&modes, modes.load, modes.next);
        if (!modes.is_held) rigid_remove(&modes, modes.next);
        momentum_load(&modes, modes.next, modes.load);
        square = 1 / sqrt(load_product(fish, modes.load, modes.next));
        for (int k = 0; k < n; k++) modes.mode[k] = modes.next[k];
    }

    return sqrt(square) / (2 * M_PI);
}
