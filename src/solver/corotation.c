/* corotation.c: a rotation at each node, then one rotation in a plane for each of the three rigid motions. */
#include "solver/corotation.h"

#include <math.h>

#include "base/parallel.h"
#include "fish/fish_motion.h"

// two translations and a rotation
enum { N_RIGID = 3 };

// in all arrays x is the first half and y the second half, as in the unknowns
struct body {
    const struct fish *fish;
    int has_moved;         /* since corotation_set_reference */
    int n_rigid;           /* number of mapped rigid motions: 0 with prescribed nodes */
    double *reference;     /* positions of the nodes in the reference configuration, m      (2 n_nodes) */
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

static void corotation_normalise(const struct fish *fish, double *a) {
    const double size = sqrt(corotation_dot(fish, a, a));
    for (int i = 0; i < 2 * fish->n_nodes; i++) a[i] /= size;
}

// the orthonormal rigid motions: translation along x, along y, rotation about the centre of mass
static void rigid_motions(const struct fish *fish, const double *position, double *const motion[N_RIGID]) {
    const int n = fish->n_nodes;
    for (int k = 0; k < n; k++) {
        motion[0][k] = motion[1][n + k] = 1;
        motion[0][n + k] = motion[1][k] = 0;
    }
    corotation_normalise(fish, motion[0]);
    corotation_normalise(fish, motion[1]);
    const double along_x = corotation_dot(fish, motion[0], position),
                 along_y = corotation_dot(fish, motion[1], position);
    for (int k = 0; k < n; k++) {
        motion[2][k] = -(position[n + k] - along_y * motion[1][n + k]);
        motion[2][n + k] = position[k] - along_x * motion[0][k];
    }
    corotation_normalise(fish, motion[2]);
}

// apply to a the rotation that maps the unit vector u to the unit vector v and keeps vectors perpendicular to both
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
        body->has_moved = 0;
    }
}

// the unit vector along (c, s): cosine and sine of its angle
static void corotation_direction(double c, double s, double *unit) {
    const double size = hypot(c, s);
    unit[0] = c / size;
    unit[1] = s / size;
}

// the rotation of a node is the mean of the rotations of its two edges: the direction of the sum of their unit vectors
static void find_rotations(struct body *body, const double *position) {
    const int n = body->fish->n_nodes;
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
}

static void body_set_current(struct body *body, const double *y) {
    const struct fish *fish = body->fish;
    const double *const position = y + fish->at.x;
    body->has_moved = 1;
    find_rotations(body, position);
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

static void body_to_current(const struct body *body, double *a) {
    rotate_nodes(body, 1, a);
    for (int i = 0; i < body->n_rigid; i++) corotation_rotate(body->fish, body->from[i], body->to[i], a);
}

static void body_to_reference(const struct body *body, double *a) {
    for (int i = body->n_rigid - 1; i >= 0; i--) corotation_rotate(body->fish, body->to[i], body->from[i], a);
    rotate_nodes(body, -1, a);
}

struct map {
    const struct corotation *corotation;
    void (*of_body)(const struct body *body, double *a);
    double *vector;
};

static void map_fish(const struct map *map, int f) {
    const struct body *body = &map->corotation->body[f];
    if (!body->has_moved) return;
    map->of_body(body, map->vector + body->fish->at.x);
    map->of_body(body, map->vector + body->fish->at.vx);
    if (fish_has_momentum(body->fish)) map->of_body(body, map->vector + body->fish->at.px);
    map->of_body(body, map->vector + body->fish->at.ax);
}

static void map_all(struct map map) {
    const struct school *const school = map.corotation->school;
    const int threads = fish_threads(school);
    if (threads == 1) {
        for (int f = 0; f < school->n_fish; f++) map_fish(&map, f);
    } else {
#pragma omp parallel for num_threads(threads) schedule(static)
        for (int f = 0; f < school->n_fish; f++) map_fish(&map, f);
    }
}

void corotation_to_current(const struct corotation *corotation, double *vector) {
    map_all((struct map){corotation, body_to_current, vector});
}

void corotation_to_reference(const struct corotation *corotation, double *vector) {
    map_all((struct map){corotation, body_to_reference, vector});
}
