/* test_carry.c: what a field of vectors keeps while it is carried from one shape of a body to another. */
#include <stdlib.h>
#include <string.h>

#include "model/rod.h"
#include "school.h"
#include "solver/corotation.h"

static const char *const text =
    "time: {end: 1}\n"
    "fish:\n"
    "  - {nodes: 6, sheet_points: 7}\n"
    "  - {nodes: 4, sheet_points: 5, start: {position: [0, 2]}, motion: {driven: head, heave: 0.1, frequency: 1}}\n"
    "  - {nodes: 9, sheet_points: 5, length: 0.6, start: {position: [2, 1], heading: 30}}\n";

enum { MOST_NODES = 9 };

/* A school before and after its bodies have moved. */
struct places {
    struct setup setup;
    struct corotation *corotation;
    int n;
    double *before, *after, *field, *carried; /* (n each) */
};

// every edge of every body turns by angle and by up to bend more, then the body goes elsewhere
static void move(struct places *places, double angle, double bend) {
    for (int f = 0; f < places->setup.school->n_fish; f++) {
        const struct fish *fish = &places->setup.school->fish[f];
        const double *const x = places->before + fish->at.x, *const y = places->before + fish->at.y;
        double *const to_x = places->after + fish->at.x, *const to_y = places->after + fish->at.y;
        to_x[0] = x[0] - 3;
        to_y[0] = y[0] + 0.7;
        for (int k = 0; k < fish->n_edges; k++) {
            const double turn = angle + bend * school_random(&places->setup);
            const double ex = x[k + 1] - x[k], ey = y[k + 1] - y[k];
            to_x[k + 1] = to_x[k] + cos(turn) * ex - sin(turn) * ey;
            to_y[k + 1] = to_y[k] + sin(turn) * ex + cos(turn) * ey;
        }
    }
}

static void set_up(struct places *places, double angle, double bend) {
    school_build(&places->setup, text);
    school_stir(&places->setup);
    school_ok(corotation_create(&places->corotation, places->setup.school));
    places->n = places->setup.school->n_unknowns;
    double **const arrays[] = {&places->before, &places->after, &places->field, &places->carried};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        *arrays[i] = calloc((size_t)places->n, sizeof(double));
        assert_non_null(*arrays[i]);
    }
    memcpy(places->before, places->setup.state->y, (size_t)places->n * sizeof(double));
    // nothing moves: the derivative of the damping turns with the velocities
    for (int f = 0; f < 3; f++) {
        const struct fish *fish = &places->setup.school->fish[f];
        memset(places->before + fish->at.vx, 0, 2 * (size_t)fish->n_nodes * sizeof(double));
    }
    move(places, angle, bend);
    for (int i = 0; i < places->n; i++) places->carried[i] = places->field[i] = school_random(&places->setup);
    corotation_set_reference(places->corotation, places->before);
    corotation_set_current(places->corotation, places->after);
}

static void clear(struct places *places) {
    corotation_free(places->corotation);
    free(places->before);
    free(places->after);
    free(places->field);
    free(places->carried);
    school_clear(&places->setup);
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

static void there_and_back_changes_nothing(void **state) {
    (void)state;
    struct places places;
    set_up(&places, 2.5, 0.4);
    corotation_to_current(places.corotation, places.carried);
    assert_true(fabs(places.carried[0] - places.field[0]) > 1e-3);
    corotation_to_reference(places.corotation, places.carried);
    // rounding of three rotations there and back
    NEAR_ARRAY(places.n, places.carried, places.field, 1e-14, 0);
    clear(&places);
}

static void products_weighted_with_the_masses_are_kept(void **state) {
    (void)state;
    struct places places;
    set_up(&places, -1, 0.4);
    corotation_to_current(places.corotation, places.carried);
    for (int f = 0; f < 3; f++) {
        const struct fish *fish = &places.setup.school->fish[f];
        const int slices[] = {fish->at.x, fish->at.vx, fish->at.ax};
        for (int i = 0; i < 3; i++) {
            const double *const a = places.field + slices[i], *const b = places.carried + slices[i];
            NEAR(product(fish, b, b), product(fish, a, a), 0, 1e-14);
        }
        NEAR(product(fish, places.carried + fish->at.x, places.carried + fish->at.ax),
             product(fish, places.field + fish->at.x, places.field + fish->at.ax), 1e-13, 0);
    }
    clear(&places);
}

static void a_rigid_motion_stays_one(void **state) {
    (void)state;
    struct places places;
    set_up(&places, 0.8, 0.3);
    for (int which = 0; which < 3; which++) {
        for (int f = 0; f < 3; f += 2) {
            const struct fish *fish = &places.setup.school->fish[f];
            double want[2 * MOST_NODES];
            double *const got = places.carried + fish->at.vx;
            rigid(fish, places.before + fish->at.x, which, got);
            const double size = product(fish, got, got);
            corotation_to_current(places.corotation, places.carried);
            // the same one, but for the moment of inertia, which bending has changed
            rigid(fish, places.after + fish->at.x, which, want);
            const double scale = sqrt(size / product(fish, want, want));
            for (int i = 0; i < 2 * fish->n_nodes; i++) want[i] *= scale;
            NEAR(scale, 1, which < 2 ? 1e-14 : 0.1, 0);
            NEAR_ARRAY(2 * fish->n_nodes, got, want, 1e-14, 0);
        }
    }
    clear(&places);
}

static void other_unknowns_and_driven_fish_are_left_alone(void **state) {
    (void)state;
    struct places places;
    set_up(&places, 0.8, 0.3);
    corotation_to_current(places.corotation, places.carried);
    for (int f = 0; f < 3; f++) {
        const struct layout *at = &places.setup.school->fish[f].at;
        const int first = f == 1 ? at->x : at->gamma;
        NEAR_ARRAY(at->end - first, places.carried + first, places.field + first, 0, 0);
    }
    // and all fish where no time has passed
    memcpy(places.carried, places.field, (size_t)places.n * sizeof(double));
    corotation_set_reference(places.corotation, places.after);
    corotation_to_current(places.corotation, places.carried);
    NEAR_ARRAY(places.n, places.carried, places.field, 0, 0);
    clear(&places);
}

// column by column the elastic derivative of fish f where the bodies were, carried, and where they are
static void stiffness(struct places *places, int f, const double *y, double *dense) {
    const struct fish *fish = &places->setup.school->fish[f];
    const double natural[MOST_NODES] = {0};
    struct sparse *matrix;
    school_ok(sparse_create(&matrix, 0, places->n));
    sparse_begin(matrix);
    rod_jacobian(fish, natural, natural, y, matrix);
    school_ok(sparse_end(matrix));
    double *const all = school_dense(matrix);
    for (int row = 0; row < 2 * fish->n_nodes; row++) {
        for (int column = 0; column < 2 * fish->n_nodes; column++) {
            dense[row * 2 * MOST_NODES + column] = all[(fish->at.ax + row) * places->n + fish->at.x + column];
        }
    }
    free(all);
    sparse_free(matrix);
}

// T K T^-1
static void carried_stiffness(const struct places *places, int f, double *dense) {
    const struct fish *fish = &places->setup.school->fish[f];
    const int n = 2 * fish->n_nodes;
    double result[2 * MOST_NODES * 2 * MOST_NODES];
    double *const vector = calloc((size_t)places->n, sizeof *vector);
    assert_non_null(vector);
    for (int column = 0; column < n; column++) {
        for (int i = 0; i < n; i++) vector[fish->at.x + i] = i == column;
        corotation_to_reference(places->corotation, vector);
        for (int row = 0; row < n; row++) {
            vector[fish->at.ax + row] = 0;
            for (int i = 0; i < n; i++) {
                vector[fish->at.ax + row] += dense[row * 2 * MOST_NODES + i] * vector[fish->at.x + i];
            }
        }
        corotation_to_current(places->corotation, vector);
        for (int row = 0; row < n; row++) result[row * 2 * MOST_NODES + column] = vector[fish->at.ax + row];
    }
    free(vector);
    memcpy(dense, result, sizeof result);
}

static double largest_difference(int n, const double *a, const double *b) {
    double largest = 0;
    for (int row = 0; row < n; row++) {
        for (int column = 0; column < n; column++) {
            largest = fmax(largest, fabs(a[row * 2 * MOST_NODES + column] - b[row * 2 * MOST_NODES + column]));
        }
    }
    return largest;
}

static void an_elastic_matrix_is_carried_with_the_body(void **state) {
    (void)state;
    const double bends[] = {0, 0.02};
    for (int i = 0; i < 2; i++) {
        for (int f = 0; f < 3; f += 2) {
            struct places places;
            set_up(&places, 0.3, bends[i]);
            const int n = 2 * places.setup.school->fish[f].n_nodes;
            double was[2 * MOST_NODES * 2 * MOST_NODES] = {0}, is[2 * MOST_NODES * 2 * MOST_NODES] = {0};
            double carried[2 * MOST_NODES * 2 * MOST_NODES];
            stiffness(&places, f, places.before, was);
            stiffness(&places, f, places.after, is);
            memcpy(carried, was, sizeof was);
            carried_stiffness(&places, f, carried);
            // after a turn it is the matrix itself; after a bend what is left is half of what an edge has turned
            // against its neighbours
            const double error = largest_difference(n, carried, is), without = largest_difference(n, was, is);
            assert_true(error < (bends[i] > 0 ? 0.1 : 1e-12) * without);
            clear(&places);
        }
    }
}

static void a_carried_elastic_force_has_no_net_force_and_moment(void **state) {
    (void)state;
    for (int f = 0; f < 3; f += 2) {
        struct places places;
        set_up(&places, 0.3, 0.3);
        const struct fish *fish = &places.setup.school->fish[f];
        const int n = 2 * fish->n_nodes;
        // without tension and moment the derivative itself has none
        memset(places.before, 0, (size_t)places.n * sizeof(double));
        for (int k = 0; k < fish->n_nodes; k++) {
            places.before[fish->at.x + k] = k * fish->edge_length;
        }
        corotation_set_reference(places.corotation, places.before);
        corotation_set_current(places.corotation, places.after);
        double dense[2 * MOST_NODES * 2 * MOST_NODES] = {0}, force[2 * MOST_NODES], motion[2 * MOST_NODES];
        stiffness(&places, f, places.before, dense);
        double largest = 0;
        for (int row = 0; row < n; row++) {
            for (int i = 0; i < n; i++) largest = fmax(largest, fabs(dense[row * 2 * MOST_NODES + i]));
        }
        double uncarried = 0;
        for (int pass = 0; pass < 2; pass++) {
            if (pass == 1) carried_stiffness(&places, f, dense);
            for (int column = 0; column < n; column++) {
                for (int row = 0; row < n; row++) force[row] = dense[row * 2 * MOST_NODES + column];
                for (int which = 0; which < 3; which++) {
                    rigid(fish, places.after + fish->at.x, which, motion);
                    const double net = product(fish, motion, force);
                    if (pass == 0) uncarried = fmax(uncarried, fabs(net));
                    if (pass == 1) NEAR(net, 0, 1e-13 * fish->total_mass * largest, 0);
                }
            }
        }
        assert_true(uncarried > 1e-3 * fish->total_mass * largest);
        clear(&places);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(there_and_back_changes_nothing),
        cmocka_unit_test(products_weighted_with_the_masses_are_kept),
        cmocka_unit_test(a_rigid_motion_stays_one),
        cmocka_unit_test(other_unknowns_and_driven_fish_are_left_alone),
        cmocka_unit_test(an_elastic_matrix_is_carried_with_the_body),
        cmocka_unit_test(a_carried_elastic_force_has_no_net_force_and_moment),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
