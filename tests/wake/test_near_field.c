/* test_near_field.c: estimated errors of the far field against true errors. doc/numerics.md, section 12. */
#include <string.h>

#include "school.h"
#include "vortex/kernel.h"
#include "wake/near_field.h"

enum { N_VORTICES = 20, MOST_POINTS = 3 };

/* One point at rest at the origin, or a bent body, and equal vortices on one path past the point. */
static struct {
    struct setup setup;
    struct near_field near_field;
    struct near_field_bounds bounds;
    double x[2], u[2], a[2]; /* the path of the vortices: m, m s-1, m s-2 */
    double start, end;       /* total strength, m2 s-1 */
    int n_points;            /* 0: one */
    double point[2][MOST_POINTS];
    int one_by_one; /* 0: all vortices at once, if the bounds permit */
} scene;

static int build(void **state) {
    (void)state;
    school_build(&scene.setup, "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\nfish: [{}]\n");
    struct wake *const wake = &scene.setup.state->wake[0];
    for (int i = 0; i < N_VORTICES; i++) school_ok(wake_release(wake, 0, 0, 0, 0));
    return 0;
}

static int clear(void **state) {
    (void)state;
    near_field_free(&scene.near_field);
    school_clear(&scene.setup);
    return 0;
}

// divide the vortices into near and far vortices for a fish with the velocity (mean, 0)
static void divide(double mean, double smoothing, double tolerance) {
    struct school *const school = scene.setup.school;
    struct wake *const wake = &scene.setup.state->wake[0];
    double start[N_VORTICES], end[N_VORTICES];

    school->fish[0].smoothing = smoothing;
    school->wake_tolerance = tolerance;
    for (int i = 0; i < N_VORTICES; i++) {
        wake->x[i] = scene.x[0];
        wake->y[i] = scene.x[1];
        wake->u[i] = mean + scene.u[0];
        wake->v[i] = scene.u[1];
        wake->u_before[i] = wake->u[i] - school->interval * scene.a[0];
        wake->v_before[i] = wake->v[i] - school->interval * scene.a[1];
        start[i] = scene.start / N_VORTICES;
        end[i] = scene.end / N_VORTICES;
    }

    const struct range point = {0, scene.n_points ? scene.n_points : 1}, all = {0, N_VORTICES};
    double zero[MOST_POINTS] = {0}, speed[MOST_POINTS] = {mean, mean, mean};
    double *const motion[6] = {scene.point[0], scene.point[1], speed, zero, zero, zero};
    scene.bounds = near_field_bound_wake(wake, school->interval, start, end);
    if (scene.one_by_one) scene.bounds.strength = INFINITY;
    const struct near_field_input input = {.school = school,
                                           .wakes = wake,
                                           .points = &point,
                                           .motion = motion,
                                           .bounds = &scene.bounds,
                                           .wake = &all,
                                           .strength_start = start,
                                           .strength_end = end,
                                           .n_released = N_VORTICES};
    school_ok(near_field_find(&scene.near_field, &input, 0));
}

// velocity and gradient, u v u_x u_y v_x, at (x, y) at the fraction q of the interval
static void induce(double smoothing, double q, double x, double y, double value[5]) {
    const double tau = q * scene.setup.school->interval;
    const double source[2] = {scene.x[0] + tau * (scene.u[0] + tau / 2 * scene.a[0]),
                              scene.x[1] + tau * (scene.u[1] + tau / 2 * scene.a[1])};
    const double strength = scene.start + q * (scene.end - scene.start);

    memset(value, 0, 5 * sizeof *value);
    kernel_add_gradient(1, &x, &y, 1, &source[0], &source[1], &strength, smoothing, &value[0], &value[1], &value[2],
                        &value[3], &value[4]);
}

// largest errors in the interval: of the cubic through four velocities; of the gradient, linear in time, for a drift of
// unit length; of the linear velocity field at a drift, over the square of the drift
static struct near_field_error true_error(double smoothing) {
    static const double time[4] = {0, 0.29289321881345248, 0.70710678118654752, 1};
    const double drift = 1e-4;
    double at_time[4][5];
    struct near_field_error worst = {0};

    for (int i = 0; i < 4; i++) induce(smoothing, time[i], 0, 0, at_time[i]);
    for (int step = 0; step <= 40; step++) {
        const double q = step / 40.0;
        double now[5], error[5];
        induce(smoothing, q, 0, 0, now);
        memcpy(error, now, sizeof error);
        for (int i = 0; i < 4; i++) {
            double weight = 1;
            for (int k = 0; k < 4; k++) weight *= k == i ? 1 : (q - time[k]) / (time[i] - time[k]);
            for (int k = 0; k < 2; k++) error[k] -= weight * at_time[i][k];
        }

        for (int k = 2; k < 5; k++) error[k] -= (1 - q) * at_time[0][k] + q * at_time[3][k];
        worst.error = fmax(worst.error, hypot(error[0], error[1]));
        for (int direction = 0; direction < 24; direction++) {
            const double c = cos(direction * acos(-1) / 12), s = sin(direction * acos(-1) / 12);
            double there[5];
            induce(smoothing, q, drift * c, drift * s, there);
            const double u = there[0] - now[0] - drift * (now[2] * c + now[3] * s);
            const double v = there[1] - now[1] - drift * (now[4] * c - now[2] * s);
            worst.by_drift_square = fmax(worst.by_drift_square, hypot(u, v) / (drift * drift));
            worst.by_drift = fmax(worst.by_drift, hypot(error[2] * c + error[3] * s, error[4] * c - error[2] * s));
        }
    }

    return worst;
}

enum { DIRECTIONS = 16 };

// a path that starts at the distance 1, with velocity and acceleration in two of the directions
static void set_path(double speed, int direction, double acceleration, int bend) {
    const double turn = 2 * acos(-1) / DIRECTIONS, v = direction * turn, a = bend * turn;
    scene.x[0] = 1;
    scene.x[1] = 0;
    scene.u[0] = speed * cos(v);
    scene.u[1] = speed * sin(v);
    scene.a[0] = acceleration * cos(a);
    scene.a[1] = acceleration * sin(a);
}

// true errors over the bounds (ten times the estimates): maximum over the directions of velocity and acceleration
static struct near_field_error ratios(double speed, double acceleration, double smoothing) {
    struct near_field_error worst = {0};
    for (int i = 0; i < DIRECTIONS * DIRECTIONS; i++) {
        set_path(speed, i % DIRECTIONS, acceleration, i / DIRECTIONS);
        divide(0, smoothing, 1e3);
        assert_int_equal(scene.near_field.n_near, 0);
        const struct near_field_error *const estimate = &scene.near_field.far, error = true_error(smoothing);
        worst.error = fmax(worst.error, error.error / (10 * estimate->error));
        worst.by_drift = fmax(worst.by_drift, error.by_drift / (10 * estimate->by_drift));
        worst.by_drift_square = fmax(worst.by_drift_square, error.by_drift_square / (10 * estimate->by_drift_square));
    }

    return worst;
}

static void errors_are_below_ten_estimates_and_not_far_below(void **state) {
    (void)state;

    // A single pole reaches 1/sqrt(2) of the bound, and less because the bound uses the smallest distance in the
    // interval. Motions: all terms matter; acceleration dominates; the vortex covers half of the distance to the point.
    const struct {
        double speed, acceleration, smoothing, end, least;
    } rows[] = {{1, 1.3, 0, 1, 0.6}, {0, 50, 0, 1, 0.6},  {1, 1.3, 0, 0, 0.6}, {1, 50, 0, 0, 0.3},
                {25, 0, 0, 1, 0.1},  {1, 1, 0.5, 1, 0.4}, {1, 1, 2, 1, 0.1}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        scene.start = 1;
        scene.end = rows[i].end;
        for (scene.one_by_one = 0; scene.one_by_one < 2; scene.one_by_one++) {
            const struct near_field_error worst = ratios(rows[i].speed, rows[i].acceleration, rows[i].smoothing);
            assert_true(worst.error < 1 && worst.error > rows[i].least);
            assert_true(worst.by_drift < 1 && worst.by_drift > rows[i].least);
            assert_true(worst.by_drift_square < 1 && worst.by_drift_square > rows[i].least);
        }
    }

    scene.one_by_one = 0;
}

// estimates of all vortices at once use the box of the wake, which is never farther from the body than the vortices
static void a_bent_body_has_no_smaller_errors_by_the_box_of_the_wake(void **state) {
    (void)state;
    scene.start = 1;
    scene.end = 0.5;
    scene.n_points = MOST_POINTS;
    for (int bend = -2; bend <= 2; bend++) {
        const double x[MOST_POINTS] = {-0.6, 0, 0.6}, y = 0.3 * bend;
        for (int p = 0; p < MOST_POINTS; p++) scene.point[0][p] = x[p];
        scene.point[1][1] = y;

        struct near_field_error far[2];
        for (int i = 0; i < DIRECTIONS; i++) {
            set_path(1, i, 1, 3);
            const double turn = 2 * acos(-1) * i / DIRECTIONS;
            scene.x[0] = 2 * cos(turn);
            scene.x[1] = 2 * sin(turn);
            for (scene.one_by_one = 0; scene.one_by_one < 2; scene.one_by_one++) {
                divide(0, 0.1, 1e3);
                assert_int_equal(scene.near_field.n_near, 0);
                far[scene.one_by_one] = scene.near_field.far;
            }

            assert_true(far[0].error >= (1 - 1e-12) * far[1].error);
            assert_true(far[0].by_drift >= (1 - 1e-12) * far[1].by_drift);
            assert_true(far[0].by_drift_square >= (1 - 1e-12) * far[1].by_drift_square);

            // a wake at one place beside the middle of a straight body: the same distance
            if (bend == 0 && i % (DIRECTIONS / 2) == DIRECTIONS / 4) NEAR(far[0].error, far[1].error, 1e-12, 0);
        }
    }

    memset(scene.point, 0, sizeof scene.point);
    scene.n_points = scene.one_by_one = 0;
}

static void a_vortex_that_moves_with_the_body_is_far(void **state) {
    (void)state;
    scene.start = scene.end = 1;

    // the bounds of the whole wake do not separate the vortices: both are fast
    set_path(0, 0, 0, 0);
    divide(3, 0.1, 1e-12);
    assert_int_equal(scene.near_field.n_near, 0);

    // one vortex is faster
    set_path(1, 0, 0, 0);
    divide(3, 0.1, 1e-12);
    assert_int_equal(scene.near_field.n_near, N_VORTICES);
}

static void a_cluster_of_one_sign_can_exceed_the_tolerance(void **state) {
    (void)state;

    // the path of the largest error, and a strength at which the cluster is just far
    scene.start = scene.end = 1;
    double largest = 0;
    int worst = 0;
    for (int i = 0; i < DIRECTIONS * DIRECTIONS; i++) {
        set_path(1, i % DIRECTIONS, 1, i / DIRECTIONS);
        const double error = true_error(0).error;
        if (error <= largest) continue;
        largest = error;
        worst = i;
    }

    set_path(1, worst % DIRECTIONS, 1, worst / DIRECTIONS);
    divide(0, 0, 1);

    // a quarter of the tolerance is for vortices that are neither in a far wake nor small one by one
    const double tolerance = 4 * scene.near_field.far.error;
    divide(0, 0, 1.01 * tolerance);
    assert_int_equal(scene.near_field.n_near, 0);

    // value of doc/numerics.md
    NEAR(largest / tolerance, 1.65, 0.01, 0);

    // with half of the tolerance all vortices are near
    divide(0, 0, tolerance / 2);
    assert_int_equal(scene.near_field.n_near, N_VORTICES);
}

static void the_far_field_is_valid_up_to_half_of_the_tolerance(void **state) {
    (void)state;
    const struct { double by_drift, by_drift_square; } far[] = {{2, 0}, {0, 4}, {1, 2}};
    for (int i = 0; i < 3; i++) {
        struct near_field near_field = {.is_interpolated = 1, .tolerance = 2};
        near_field.far.by_drift = far[i].by_drift;
        near_field.far.by_drift_square = far[i].by_drift_square;

        // each term is 1 at a drift of a half
        assert_true(near_field_is_valid(&near_field, 0));
        assert_true(near_field_is_valid(&near_field, 0.499 * 0.499));
        assert_false(near_field_is_valid(&near_field, 0.501 * 0.501));
        assert_false(near_field_is_valid(&near_field, NAN));
        near_field.is_interpolated = 0;
        assert_false(near_field_is_valid(&near_field, 0));
    }
}

static void near_vortices_move_on_their_paths_and_decay(void **state) {
    (void)state;
    scene.start = 2;
    scene.end = 1;
    set_path(1, 3, 1, 1);
    divide(0, 0.1, 1e-12);
    assert_int_equal(scene.near_field.n_near, N_VORTICES);
    const double q = 0.3, tau = q * scene.setup.school->interval;
    near_field_update(&scene.near_field, tau, q, -1);
    for (int i = 0; i < N_VORTICES; i++) {
        const struct vortices *const now = &scene.near_field.vortices;
        NEAR(now->x[i], scene.x[0] + tau * scene.u[0] + tau * tau / 2 * scene.a[0], 1e-15, 0);
        NEAR(now->y[i], scene.x[1] + tau * scene.u[1] + tau * tau / 2 * scene.a[1], 1e-15, 0);
        NEAR(now->circulation[i], -(2 - q) / N_VORTICES, 1e-15, 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_below_ten_estimates_and_not_far_below),
        cmocka_unit_test(a_bent_body_has_no_smaller_errors_by_the_box_of_the_wake),
        cmocka_unit_test(a_vortex_that_moves_with_the_body_is_far),
        cmocka_unit_test(a_cluster_of_one_sign_can_exceed_the_tolerance),
        cmocka_unit_test(the_far_field_is_valid_up_to_half_of_the_tolerance),
        cmocka_unit_test(near_vortices_move_on_their_paths_and_decay),
    };
    return cmocka_run_group_tests(tests, build, clear);
}
