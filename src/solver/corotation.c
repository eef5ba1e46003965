/* corotation.c: a rotation at each node, followed by one rotation in a plane for each of the three rigid motions. */
#include "solver/corotation.h"

#include <math.h>

#include "base/parallel.h"
#include "fish/fish_motion.h"

// two translations and a rotation
enum { N_RIGID = 3 };

// in all arrays x comes first and then y, as in the unknowns
struct body {
    const struct fish *fish;
    bool has_moved;        /* since corotation_set_reference */
    int n_rigid;           /* number of rigid motions to map: 0 with prescribed nodes */
    double *reference;     /* positions in the reference configuration, m      (2 n_nodes) */
    double *rotation;      /* cosine and sine of the rotation of each node since the reference  (2 n_nodes) */
    double *from[N_RIGID]; /* orthonormal rigid motions of the reference body, nodes rotated (2 n_nodes each) */
    double *to[N_RIGID];   /* orthonormal rigid motions of the current body                 (2 n_nodes each) */
};

struct corotation {
    const struct school *school;
    struct body *body; /* (n_fish) */
};

struct corotation *corotation_create(struct arena *arena, const struct school *school) {
    struct corotation *corotation;
    NEW(arena, corotation, 1);
    corotation->school = school;
    NEW(arena, corotation->body, school->n_fish);
    for (int f = 0; f < school->n_fish; f++) {
        struct body *const body = &corotation->body[f];
        body->fish = &school->fish[f];
        body->n_rigid = fish_n_prescribed(body->fish) > 0 ? 0 : N_RIGID;
        NEW(arena, body->reference, 2 * body->fish->n_nodes);
        NEW(arena, body->rotation, 2 * body->fish->n_nodes);
        for (int i = 0; i < N_RIGID; i++) {
            NEW(arena, body->from[i], 2 * body->fish->n_nodes);
            NEW(arena, body->to[i], 2 * body->fish->n_nodes);
        }
    }
    return corotation;
}

static double corotation_dot(const struct fish *fish, const double *a, const double *b) {
    const int n = fish->n_nodes;
    double sum = 0;
    for (int k = 0; k < n; k++) sum += fish->mass[k] * (a[k] * b[k] + a[n + k] * b[n + k]);
    return sum;
}

// the orthonormal rigid motions: translation along x, along y, rotation about the centre of mass
static void rigid_motions(const struct fish *fish, const double *position, double *const motion[N_RIGID]) {
    const int n = fish->n_nodes;
    for (int k = 0; k < n; k++) {
        motion[0][k] = motion[1][n + k] = 1;
        motion[0][n + k] = motion[1][k] = 0;
    }
    for (int m = 0; m < N_RIGID; m++) {
        const double along_x = m == 2 ? corotation_dot(fish, motion[0], position) : 0;
        const double along_y = m == 2 ? corotation_dot(fish, motion[1], position) : 0;
        for (int k = 0; k < n && m == 2; k++) {
            motion[2][k] = -(position[n + k] - along_y * motion[1][n + k]);
            motion[2][n + k] = position[k] - along_x * motion[0][k];
        }
        const double size = sqrt(corotation_dot(fish, motion[m], motion[m]));
        for (int i = 0; i < 2 * n; i++) motion[m][i] /= size;
    }
}

// rotate a by the rotation that takes the unit vector u to the unit vector v and leaves vectors perpendicular to both
static void corotation_rotate(const struct fish *fish, const double *u, const double *v, double *a) {
    const double both = (corotation_dot(fish, u, a) + corotation_dot(fish, v, a)) / (1 + corotation_dot(fish, u, v)),
                 first = 2 * corotation_dot(fish, u, a);
    for (int i = 0; i < 2 * fish->n_nodes; i++) a[i] += first * v[i] - both * (u[i] + v[i]);
}

// rotate the vector of each node; sign -1: backwards
static void rotate_nodes(const struct body *body, double sign, double *a) {
    const int n = body->fish->n_nodes;
    for (int k = 0; k < n; k++) {
        const double c = body->rotation[k], s = sign * body->rotation[n + k], x = a[k], y = a[n + k];
        a[k] = c * x - s * y;
        a[n + k] = s * x + c * y;
    }
}

void corotation_set_reference(struct corotation *corotation, const double *y) {
    for (int f = 0; f < corotation->school->n_fish; f++) {
        struct body *body = &corotation->body[f];
        for (int i = 0; i < 2 * body->fish->n_nodes; i++) body->reference[i] = y[body->fish->at.x + i];
        body->has_moved = false;
    }
}

// the unit vector along (c, s): cosine and sine of its angle
static void corotation_direction(double c, double s, double *unit) {
    const double size = hypot(c, s);
    unit[0] = c / size;
    unit[1] = s / size;
}

static void body_set_current(struct body *body, const double *y) {
    const struct fish *fish = body->fish;
    const double *const position = y + fish->at.x;
    const int n = fish->n_nodes;
    body->has_moved = true;

    // The rotation of a node is the mean of the rotations of its two edges, that is the direction of the sum of their
    // unit vectors.
    double before[2] = {0, 0};
    for (int k = 0; k < n; k++) {
        double after[2] = {0, 0}, mean[2];
        if (k < n - 1) {
            const double a[2] = {body->reference[k + 1] - body->reference[k],
                                 body->reference[n + k + 1] - body->reference[n + k]};
            const double b[2] = {position[k + 1] - position[k], position[n + k + 1] - position[n + k]};
            corotation_direction(a[0] * b[0] + a[1] * b[1], a[0] * b[1] - a[1] * b[0], after);
        }
        corotation_direction(before[0] + after[0], before[1] + after[1], mean);
        body->rotation[k] = mean[0];
        body->rotation[n + k] = mean[1];
        before[0] = after[0];
        before[1] = after[1];
    }

    // the rigid motions of the reference body, each rotated by P and by the maps of the earlier ones, and of the
    // current body
    if (body->n_rigid == 0) return;
    rigid_motions(fish, body->reference, body->from);
    rigid_motions(fish, position, body->to);
    for (int i = 0; i < N_RIGID; i++) {
        rotate_nodes(body, 1, body->from[i]);
        for (int j = 0; j < i; j++) corotation_rotate(fish, body->from[j], body->to[j], body->from[i]);
    }
}

void corotation_set_current(struct corotation *corotation, const double *y) {
    const struct school *const school = corotation->school;
    const int threads = fish_threads(school);
    if (threads == 1) {
        for (int f = 0; f < school->n_fish; f++) body_set_current(&corotation->body[f], y);
    } else {
#pragma omp parallel for num_threads(threads) schedule(static)
        for (int f = 0; f < school->n_fish; f++) body_set_current(&corotation->body[f], y);
    }
}

// map the slices of one body: to the current configuration, or, backwards, to the reference configuration
static void map_body(const struct body *body, bool backwards, double *vector) {
    const struct layout *const at = &body->fish->at;
    for (int pairs = at->x; pairs < at->gamma && body->has_moved; pairs += 2 * body->fish->n_nodes) {
        double *const a = vector + pairs;
        if (!backwards) rotate_nodes(body, 1, a);
        for (int m = 0; m < body->n_rigid; m++) {
            const int i = backwards ? body->n_rigid - 1 - m : m;
            corotation_rotate(body->fish, (backwards ? body->to : body->from)[i],
                              (backwards ? body->from : body->to)[i], a);
        }
        if (backwards) rotate_nodes(body, -1, a);
    }
}

void corotation_map(const struct corotation *corotation, bool backwards, double *vector) {
    const struct school *const school = corotation->school;
    const int threads = fish_threads(school);
    if (threads == 1) {
        for (int f = 0; f < school->n_fish; f++) map_body(&corotation->body[f], backwards, vector);
    } else {
#pragma omp parallel for num_threads(threads) schedule(static)
        for (int f = 0; f < school->n_fish; f++) map_body(&corotation->body[f], backwards, vector);
    }
}
