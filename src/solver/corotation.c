/* corotation.c: node by node, then three rotations in a plane each, one for each rigid motion. */
#include "solver/corotation.h"

#include <math.h>
#include <stdlib.h>

// two translations and a rotation
enum { N_RIGID = 3 };

// all arrays with x in the first half and y in the second, as the unknowns have them
struct body {
    const struct fish *fish;
    int moved;             /* since corotation_set_reference */
    double *was;           /* positions of the nodes then, m                            (2 n_nodes) */
    double *turn;          /* cosine and sine of the angle by which each node turned    (2 n_nodes) */
    double *from[N_RIGID]; /* what the turned nodes make of the rigid motions then      (2 n_nodes each) */
    double *to[N_RIGID];   /* the rigid motions now; both sets orthonormal */
};

struct corotation {
    int n_fish;
    struct body *body; /* (n_fish) */
    double *values;    /* of all bodies */
};

enum { N_ARRAYS = 2 + 2 * N_RIGID };

enum status corotation_create(struct corotation **corotation, const struct school *school) {
    *corotation = NULL;
    struct corotation *const new = calloc(1, sizeof *new);
    if (!new) goto no_memory;
    const size_t n_fish = (size_t)school->n_fish;
    size_t n_nodes = 0;
    for (int f = 0; f < school->n_fish; f++) n_nodes += (size_t)school->fish[f].n_nodes;
    new->n_fish = school->n_fish;
    new->body = calloc(n_fish, sizeof *new->body);
    new->values = calloc(n_nodes * 2 * N_ARRAYS, sizeof *new->values);
    if (!new->body || !new->values) goto no_memory;
    double *next = new->values;
    for (int f = 0; f < school->n_fish; f++) {
        struct body *body = &new->body[f];
        body->fish = &school->fish[f];
        double **const arrays[N_ARRAYS] = {&body->was,     &body->turn,  &body->from[0], &body->from[1],
                                           &body->from[2], &body->to[0], &body->to[1],   &body->to[2]};
        for (int i = 0; i < N_ARRAYS; i++, next += 2 * body->fish->n_nodes) *arrays[i] = next;
    }
    *corotation = new;
    return STATUS_OK;

no_memory:
    corotation_free(new);
    return status_fail(STATUS_MEMORY, "out of memory: the places of %d bodies", school->n_fish);
}

void corotation_free(struct corotation *corotation) {
    if (!corotation) return;
    free(corotation->body);
    free(corotation->values);
    free(corotation);
}

static double dot(const struct fish *fish, const double *a, const double *b) {
    const int n = fish->n_nodes;
    double sum = 0;
    for (int k = 0; k < n; k++) sum += fish->mass[k] * (a[k] * b[k] + a[n + k] * b[n + k]);
    return sum;
}

static void scale_to_one(const struct fish *fish, double *a) {
    const double size = sqrt(dot(fish, a, a));
    for (int i = 0; i < 2 * fish->n_nodes; i++) a[i] /= size;
}

// orthonormal: translation along x, along y, rotation about the centre of mass
static void rigid_motions(const struct fish *fish, const double *place, double *const motion[N_RIGID]) {
    const int n = fish->n_nodes;
    for (int k = 0; k < n; k++) {
        motion[0][k] = motion[1][n + k] = 1;
        motion[0][n + k] = motion[1][k] = 0;
    }
    scale_to_one(fish, motion[0]);
    scale_to_one(fish, motion[1]);
    const double along_x = dot(fish, motion[0], place), along_y = dot(fish, motion[1], place);
    for (int k = 0; k < n; k++) {
        motion[2][k] = -(place[n + k] - along_y * motion[1][n + k]);
        motion[2][n + k] = place[k] - along_x * motion[0][k];
    }
    scale_to_one(fish, motion[2]);
}

// the rotation that takes the unit vector u to the unit vector v and leaves alone what is perpendicular to both
static void rotate(const struct fish *fish, const double *u, const double *v, double *a) {
    const double both = (dot(fish, u, a) + dot(fish, v, a)) / (1 + dot(fish, u, v)), first = 2 * dot(fish, u, a);
    for (int i = 0; i < 2 * fish->n_nodes; i++) a[i] += first * v[i] - both * (u[i] + v[i]);
}

// sign -1: the other way
static void turn_nodes(const struct body *body, double sign, double *a) {
    const int n = body->fish->n_nodes;
    for (int k = 0; k < n; k++) {
        const double c = body->turn[k], s = sign * body->turn[n + k], x = a[k], y = a[n + k];
        a[k] = c * x - s * y;
        a[n + k] = s * x + c * y;
    }
}

void corotation_set_reference(struct corotation *corotation, const double *y) {
    for (int f = 0; f < corotation->n_fish; f++) {
        struct body *body = &corotation->body[f];
        for (int i = 0; i < 2 * body->fish->n_nodes; i++) body->was[i] = y[body->fish->at.x + i];
        body->moved = 0;
    }
}

// cosine and sine of the angle from one edge to another, or of the mean of two angles: those of a sum of vectors
static void direction(double c, double s, double *unit) {
    const double size = hypot(c, s);
    unit[0] = c / size;
    unit[1] = s / size;
}

static void find_turns(struct body *body, const double *place) {
    const int n = body->fish->n_nodes;
    double before[2] = {0, 0};
    for (int k = 0; k < n; k++) {
        double after[2] = {0, 0}, mean[2];
        if (k < n - 1) {
            const double a[2] = {body->was[k + 1] - body->was[k], body->was[n + k + 1] - body->was[n + k]};
            const double b[2] = {place[k + 1] - place[k], place[n + k + 1] - place[n + k]};
            direction(a[0] * b[0] + a[1] * b[1], a[0] * b[1] - a[1] * b[0], after);
        }
        direction(before[0] + after[0], before[1] + after[1], mean);
        body->turn[k] = mean[0];
        body->turn[n + k] = mean[1];
        before[0] = after[0];
        before[1] = after[1];
    }
}

void corotation_set_current(struct corotation *corotation, const double *y) {
    for (int f = 0; f < corotation->n_fish; f++) {
        struct body *body = &corotation->body[f];
        const struct fish *fish = body->fish;
        if (fish_n_prescribed(fish) > 0) continue;
        const double *const place = y + fish->at.x;
        body->moved = 1;
        find_turns(body, place);
        rigid_motions(fish, body->was, body->from);
        rigid_motions(fish, place, body->to);
        for (int i = 0; i < N_RIGID; i++) {
            turn_nodes(body, 1, body->from[i]);
            for (int j = 0; j < i; j++) rotate(fish, body->from[j], body->to[j], body->from[i]);
        }
    }
}

static void body_forth(const struct body *body, double *a) {
    turn_nodes(body, 1, a);
    for (int i = 0; i < N_RIGID; i++) rotate(body->fish, body->from[i], body->to[i], a);
}

static void body_back(const struct body *body, double *a) {
    for (int i = N_RIGID - 1; i >= 0; i--) rotate(body->fish, body->to[i], body->from[i], a);
    turn_nodes(body, -1, a);
}

static void all(const struct corotation *corotation, void (*one)(const struct body *, double *), double *vector) {
    for (int f = 0; f < corotation->n_fish; f++) {
        const struct body *body = &corotation->body[f];
        if (!body->moved) continue;
        one(body, vector + body->fish->at.x);
        one(body, vector + body->fish->at.vx);
        one(body, vector + body->fish->at.ax);
    }
}

void corotation_to_current(const struct corotation *corotation, double *vector) {
    all(corotation, body_forth, vector);
}

void corotation_to_reference(const struct corotation *corotation, double *vector) {
    all(corotation, body_back, vector);
}
