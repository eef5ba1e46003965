/* test_corotation.c: The map from one configuration of a body to another keeps the invariants of a vector field. */
#include <stdlib.h>
#include <string.h>

#include "body/rod.h"
#include "school.h"
#include "solver/corotation.h"

static const char *const text =
    "time: {end: 1}\ndefaults: {fish: {pressure: {span: infinite}}}\nfish:\n  - {nodes: 6, sheet_points: 11}\n"
    "  - {nodes: 4, sheet_points: 7, start: {position: [0, 2]}, motion: {prescribed: head, heave: 0.1, frequency: 1}}\n"
    "  - {nodes: 9, sheet_points: 18, length: 0.6, start: {position: [2, "
    "1], heading: 30}}\n";

enum { MAX_NODES = 9 };

/* A school in the reference and in the current configuration, and a field with its image. */
struct configurations {
    struct setup setup;
    struct corotation *corotation;
    int n;
    double *reference, *current, *field, *image; /* (n each) */
};

// every edge of every body rotates by angle and by up to bend more, then the body is displaced
static void move(struct configurations *both, double angle, double bend) {
    for (int f = 0; f < both->setup.school->n_fish; f++) {
        const struct fish *fish = &both->setup.school->fish[f];
        const double *const x = both->reference + fish->at.x, *const y = both->reference + fish->at.y;
        double *const to_x = both->current + fish->at.x, *const to_y = both->current + fish->at.y;
        to_x[0] = x[0] - 3;
        to_y[0] = y[0] + 0.7;
        for (int k = 0; k < fish->n_edges; k++) {
            const double turn = angle + bend * school_random(&both->setup);
            const double ex = x[k + 1] - x[k], ey = y[k + 1] - y[k];
            to_x[k + 1] = to_x[k] + cos(turn) * ex - sin(turn) * ey;
            to_y[k + 1] = to_y[k] + sin(turn) * ex + cos(turn) * ey;
        }
    }
}

static void set_up(struct configurations *both, double angle, double bend) {
    school_build(&both->setup, text);
    school_stir(&both->setup);
    both->corotation = corotation_create(test_arena(), both->setup.school);
    both->n = both->setup.school->n_unknowns;
    double **const arrays[] = {&both->reference, &both->current, &both->field, &both->image};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        *arrays[i] = arena_new(test_arena(), (size_t)both->n, sizeof(double));
        assert_non_null(*arrays[i]);
    }
    memcpy(both->reference, both->setup.state->y, (size_t)both->n * sizeof(double));
    // at rest: the derivative of the damping depends on velocities, which are not rotated here
    for (int f = 0; f < 3; f++) {
        const struct fish *fish = &both->setup.school->fish[f];
        memset(both->reference + fish->at.vx, 0, 2 * (size_t)fish->n_nodes * sizeof(double));
    }
    move(both, angle, bend);
    for (int i = 0; i < both->n; i++) both->image[i] = both->field[i] = school_random(&both->setup);
    corotation_set_reference(both->corotation, both->reference);
    corotation_set_current(both->corotation, both->current);
}

static double product(const struct fish *fish, const double *a, const double *b) {
    double sum = 0;
    for (int k = 0; k < fish->n_nodes; k++) {
        sum += fish->mass[k] * (a[k] * b[k] + a[fish->n_nodes + k] * b[fish->n_nodes + k]);
    }
    return sum;
}

// translation along x, along y, rotation about the centre of mass
static void rigid(const struct fish *fish, const double *place, int which, double *motion) {
    const int n = fish->n_nodes;
    double centre[2] = {0, 0};
    for (int k = 0; k < n; k++) {
        centre[0] += fish->mass[k] * place[k] / fish->total_mass;
        centre[1] += fish->mass[k] * place[n + k] / fish->total_mass;
    }
    for (int k = 0; k < n; k++) {
        motion[k] = which == 0 ? 1 : which == 1 ? 0 : -(place[n + k] - centre[1]);
        motion[n + k] = which == 0 ? 0 : which == 1 ? 1 : place[k] - centre[0];
    }
}

TEST(each_map_is_the_inverse_of_the_other) {
    struct configurations both;
    set_up(&both, 2.5, 0.4);
    corotation_map(both.corotation, false, both.image);
    ABOVE(fabs(both.image[0] - both.field[0]), 1e-3);
    corotation_map(both.corotation, true, both.image);
    // rounding of three rotations and the inverse rotations
    NEAR_ARRAY(both.n, both.image, both.field, 1e-14, 0);
}

TEST(the_inner_product_weighted_with_masses_is_preserved) {
    struct configurations both;
    set_up(&both, -1, 0.4);
    corotation_map(both.corotation, false, both.image);
    for (int f = 0; f < 3; f++) {
        const struct fish *fish = &both.setup.school->fish[f];
        for (int pairs = fish->at.x; pairs < fish->at.gamma; pairs += 2 * fish->n_nodes) {
            const double *const a = both.field + pairs, *const b = both.image + pairs;
            NEAR(product(fish, b, b), product(fish, a, a), 0, 1e-14);
        }
        NEAR(product(fish, both.image + fish->at.x, both.image + fish->at.ax),
             product(fish, both.field + fish->at.x, both.field + fish->at.ax), 1e-13, 0);
    }
}

TEST(momenta_are_mapped_as_velocities_are) {
    struct configurations both;
    set_up(&both, 0.8, 0.4);
    const struct fish *const fish = &both.setup.school->fish[2];
    const size_t size = 2 * (size_t)fish->n_nodes * sizeof(double);
    assert_int_equal(fish->at.second, fish->at.px);
    for (int back = 0; back < 2; back++) {
        memcpy(both.image + fish->at.px, both.image + fish->at.vx, size);
        corotation_map(both.corotation, back, both.image);
        assert_memory_equal(both.image + fish->at.px, both.image + fish->at.vx, size);
        if (!back) ABOVE(fabs(both.image[fish->at.px] - both.field[fish->at.vx]), 1e-3);
    }
}

TEST(a_rigid_motion_is_mapped_to_a_rigid_motion) {
    struct configurations both;
    set_up(&both, 0.8, 0.3);
    for (int which = 0; which < 3; which++) {
        for (int f = 0; f < 3; f += 2) {
            const struct fish *fish = &both.setup.school->fish[f];
            double want[2 * MAX_NODES];
            double *const got = both.image + fish->at.vx;
            rigid(fish, both.reference + fish->at.x, which, got);
            const double size = product(fish, got, got);
            corotation_map(both.corotation, false, both.image);
            // the same motion, but for the moment of inertia, which bending has changed
            rigid(fish, both.current + fish->at.x, which, want);
            const double scale = sqrt(size / product(fish, want, want));
            for (int i = 0; i < 2 * fish->n_nodes; i++) want[i] *= scale;
            NEAR(scale, 1, which < 2 ? 1e-14 : 0.1, 0);
            NEAR_ARRAY(2 * fish->n_nodes, got, want, 2e-14, 0);  // rounding of places up to 4 m from the origin
        }
    }
}

// clear the end nodes of a, make a orthogonal to n orthonormal fields, and normalise a
static void orthonormalise(const struct fish *fish, int n, double basis[][2 * MAX_NODES], double *a) {
    const int last = fish->n_nodes - 1;
    a[0] = a[last] = a[last + 1] = a[2 * last + 1] = 0;
    // twice, against rounding
    for (int i = 0; i < 2 * n; i++) {
        const double component = product(fish, basis[i % n], a);
        for (int k = 0; k < 2 * fish->n_nodes; k++) a[k] -= component * basis[i % n][k];
    }
    const double size = sqrt(product(fish, a, a));
    for (int k = 0; k < 2 * fish->n_nodes; k++) a[k] /= size;
}

TEST(a_node_rotates_by_the_mean_of_its_edges) {
    struct configurations both;
    set_up(&both, 0, 0);
    const struct fish *fish = &both.setup.school->fish[2];
    double *const x = both.current + fish->at.x, *const y = both.current + fish->at.y;
    const double *const from_x = both.reference + fish->at.x, *const from_y = both.reference + fish->at.y;
    // neighbouring edges rotate in opposite senses: inner nodes do not rotate at all
    for (int k = 0; k < fish->n_edges; k++) {
        const double angle = k % 2 == 0 ? 0.3 : -0.3, ex = from_x[k + 1] - from_x[k], ey = from_y[k + 1] - from_y[k];
        x[k + 1] = x[k] + cos(angle) * ex - sin(angle) * ey;
        y[k + 1] = y[k] + sin(angle) * ex + cos(angle) * ey;
    }
    corotation_set_current(both.corotation, both.current);
    // a field on inner nodes that is orthogonal to the rigid motions of both bodies: only these rotations map the field
    double basis[4][2 * MAX_NODES], want[2 * MAX_NODES];
    for (int i = 0; i < 4; i++) {
        rigid(fish, (i < 3 ? both.reference : both.current) + fish->at.x, i < 3 ? i : 2, basis[i]);
        orthonormalise(fish, i, basis, basis[i]);
    }
    double *const image = both.image + fish->at.vx;
    orthonormalise(fish, 4, basis, image);
    memcpy(want, image, 2 * (size_t)fish->n_nodes * sizeof *want);
    corotation_map(both.corotation, false, both.image);
    NEAR_ARRAY(2 * fish->n_nodes, image, want, 1e-13, 0);
}

TEST(where_nodes_are_prescribed_vectors_rotate_with_the_nodes) {
    struct configurations both;
    set_up(&both, 0.8, 0);
    corotation_map(both.corotation, false, both.image);
    const struct fish *fish = &both.setup.school->fish[1];
    for (int k = 0; k < fish->n_nodes; k++) {
        const double x = both.field[fish->at.vx + k], y = both.field[fish->at.vy + k];
        NEAR(both.image[fish->at.vx + k], cos(0.8) * x - sin(0.8) * y, 1e-14, 0);
        NEAR(both.image[fish->at.vy + k], sin(0.8) * x + cos(0.8) * y, 1e-14, 0);
    }
}

TEST(other_unknowns_are_not_mapped) {
    struct configurations both;
    set_up(&both, 0.8, 0.3);
    corotation_map(both.corotation, false, both.image);
    for (int f = 0; f < 3; f++) {
        const struct layout *at = &both.setup.school->fish[f].at;
        NEAR_ARRAY(at->end - at->gamma, both.image + at->gamma, both.field + at->gamma, 0, 0);
    }
    // nor any fish that has not moved since the reference
    memcpy(both.image, both.field, (size_t)both.n * sizeof(double));
    corotation_set_reference(both.corotation, both.current);
    corotation_map(both.corotation, false, both.image);
    NEAR_ARRAY(both.n, both.image, both.field, 0, 0);
}

// the elastic part of the Jacobian of fish f, accelerations by positions
static void stiffness(struct configurations *both, int f, const double *y, double *dense) {
    const struct fish *fish = &both->setup.school->fish[f];
    double zero[MAX_NODES] = {0};
    const struct actuation at_rest = {zero, zero, zero, zero};
    struct sparse *matrix;
    matrix = sparse_create(test_arena(), 0, both->n);
    sparse_begin(matrix);
    rod_jacobian(fish, &at_rest, y, matrix);
    sparse_end(matrix);
    double *const all = school_dense(test_arena(), matrix);
    for (int row = 0; row < 2 * fish->n_nodes; row++) {
        for (int column = 0; column < 2 * fish->n_nodes; column++) {
            dense[row * 2 * MAX_NODES + column] = all[(fish->at.ax + row) * both->n + fish->at.x + column];
        }
    }
}

// K becomes T K T^-1
static void map_stiffness(const struct configurations *both, int f, double *dense) {
    const struct fish *fish = &both->setup.school->fish[f];
    const int n = 2 * fish->n_nodes;
    double result[2 * MAX_NODES * 2 * MAX_NODES];
    double *const vector = test_array(both->n);
    for (int column = 0; column < n; column++) {
        for (int i = 0; i < n; i++) vector[fish->at.x + i] = i == column;
        corotation_map(both->corotation, true, vector);
        for (int row = 0; row < n; row++) {
            vector[fish->at.ax + row] = 0;
            for (int i = 0; i < n; i++) {
                vector[fish->at.ax + row] += dense[row * 2 * MAX_NODES + i] * vector[fish->at.x + i];
            }
        }
        corotation_map(both->corotation, false, vector);
        for (int row = 0; row < n; row++) result[row * 2 * MAX_NODES + column] = vector[fish->at.ax + row];
    }
    memcpy(dense, result, sizeof result);
}

static double largest_difference(int n, const double *a, const double *b) {
    double largest = 0;
    for (int row = 0; row < n; row++) {
        for (int column = 0; column < n; column++) {
            largest = fmax(largest, fabs(a[row * 2 * MAX_NODES + column] - b[row * 2 * MAX_NODES + column]));
        }
    }
    return largest;
}

TEST(an_elastic_matrix_rotates_with_the_body) {
    const double bends[] = {0, 0.02};
    for (int i = 0; i < 2; i++) {
        for (int f = 0; f < 3; f += 2) {
            struct configurations both;
            set_up(&both, 0.3, bends[i]);
            const int n = 2 * both.setup.school->fish[f].n_nodes;
            double old[2 * MAX_NODES * 2 * MAX_NODES] = {0}, turned[2 * MAX_NODES * 2 * MAX_NODES] = {0};
            double mapped[2 * MAX_NODES * 2 * MAX_NODES];
            stiffness(&both, f, both.reference, old);
            stiffness(&both, f, both.current, turned);
            memcpy(mapped, old, sizeof old);
            map_stiffness(&both, f, mapped);
            // exact after a rotation; after bending the error is half the rotation of an edge relative to the
            // neighbouring edges
            const double error = largest_difference(n, mapped, turned), without = largest_difference(n, old, turned);
            BELOW(error, (bends[i] > 0 ? 0.1 : 1e-12) * without);
        }
    }
}

TEST(a_mapped_elastic_force_has_no_net_force_and_moment) {
    for (int f = 0; f < 3; f += 2) {
        struct configurations both;
        set_up(&both, 0.3, 0.3);
        const struct fish *fish = &both.setup.school->fish[f];
        const int n = 2 * fish->n_nodes;
        // a straight body at rest: the elastic matrix gives neither net force nor moment
        memset(both.reference, 0, (size_t)both.n * sizeof(double));
        for (int k = 0; k < fish->n_nodes; k++) both.reference[fish->at.x + k] = k * fish->edge_length;
        corotation_set_reference(both.corotation, both.reference);
        corotation_set_current(both.corotation, both.current);
        double dense[2 * MAX_NODES * 2 * MAX_NODES] = {0}, force[2 * MAX_NODES], motion[2 * MAX_NODES];
        stiffness(&both, f, both.reference, dense);
        double largest = 0;
        for (int row = 0; row < n; row++) {
            for (int i = 0; i < n; i++) largest = fmax(largest, fabs(dense[row * 2 * MAX_NODES + i]));
        }
        double unmapped = 0;
        for (int pass = 0; pass < 2; pass++) {
            if (pass == 1) map_stiffness(&both, f, dense);
            for (int column = 0; column < n; column++) {
                for (int row = 0; row < n; row++) force[row] = dense[row * 2 * MAX_NODES + column];
                for (int which = 0; which < 3; which++) {
                    rigid(fish, both.current + fish->at.x, which, motion);
                    const double net = product(fish, motion, force);
                    if (pass == 0) unmapped = fmax(unmapped, fabs(net));
                    if (pass == 1) NEAR(net, 0, 1e-13 * fish->total_mass * largest, 0);
                }
            }
        }
        ABOVE(unmapped, 1e-3 * fish->total_mass * largest);
    }
}
