/* test_kernel.c: the vector loops against plain ones. */
#include <string.h>

#include "kernel.h"
#include "school.h"

enum { N_TARGETS = 37, N_SOURCES = 53 };

static struct {
    double x[N_TARGETS], y[N_TARGETS];
    double source_x[N_SOURCES], source_y[N_SOURCES], circulation[N_SOURCES];
} cloud;

static int scatter(void **state) {
    (void)state;
    struct setup random = {.seed = 7};
    for (int i = 0; i < N_TARGETS; i++) {
        cloud.x[i] = school_random(&random);
        cloud.y[i] = school_random(&random);
    }
    for (int j = 0; j < N_SOURCES; j++) {
        cloud.source_x[j] = school_random(&random);
        cloud.source_y[j] = school_random(&random);
        cloud.circulation[j] = school_random(&random);
    }
    // one source lies on a target
    cloud.source_x[5] = cloud.x[3];
    cloud.source_y[5] = cloud.y[3];
    return 0;
}

static void plain_velocity(double x, double y, double smoothing, double *u, double *v) {
    const double two_pi = 6.28318530717958647692;
    double su = 0, sv = 0;
    for (int j = 0; j < N_SOURCES; j++) {
        const double rx = x - cloud.source_x[j], ry = y - cloud.source_y[j];
        if (rx == 0 && ry == 0) continue;
        const double g = cloud.circulation[j] / (rx * rx + ry * ry + smoothing * smoothing);
        su -= g * ry;
        sv += g * rx;
    }
    *u = su / two_pi;
    *v = sv / two_pi;
}

static void velocity(int n, int first, double smoothing, double *u, double *v) {
    kernel_add_velocity(n, cloud.x + first, cloud.y + first, N_SOURCES, cloud.source_x, cloud.source_y,
                        cloud.circulation, smoothing, u, v);
}

static void velocity_has_the_bits_of_a_plain_loop(void **state) {
    (void)state;
    const double smoothings[] = {0, 0.05, 0.2};
    for (int s = 0; s < 3; s++) {
        double u[N_TARGETS] = {0}, v[N_TARGETS] = {0};
        velocity(N_TARGETS, 0, smoothings[s], u, v);
        for (int i = 0; i < N_TARGETS; i++) {
            double want_u, want_v;
            plain_velocity(cloud.x[i], cloud.y[i], smoothings[s], &want_u, &want_v);
            NEAR(u[i], want_u, 0, 0);
            NEAR(v[i], want_v, 0, 0);
        }
    }
}

static void targets_do_not_depend_on_their_neighbours(void **state) {
    (void)state;
    double u[N_TARGETS] = {0}, v[N_TARGETS] = {0};
    velocity(N_TARGETS, 0, 0.1, u, v);
    for (int split = 0; split <= N_TARGETS; split++) {
        double a[N_TARGETS] = {0}, b[N_TARGETS] = {0};
        velocity(split, 0, 0.1, a, b);
        velocity(N_TARGETS - split, split, 0.1, a + split, b + split);
        assert_memory_equal(a, u, sizeof u);
        assert_memory_equal(b, v, sizeof v);
    }
}

static void velocity_is_added_to_what_is_there_and_writes_nothing_else(void **state) {
    (void)state;
    for (int n = 0; n < N_TARGETS; n++) {
        double u[N_TARGETS], v[N_TARGETS], alone_u[N_TARGETS] = {0}, alone_v[N_TARGETS] = {0};
        for (int i = 0; i < N_TARGETS; i++) u[i] = v[i] = 100;
        velocity(n, 0, 0.1, u, v);
        velocity(n, 0, 0.1, alone_u, alone_v);
        for (int i = 0; i < N_TARGETS; i++) {
            NEAR(u[i], 100 + alone_u[i], 0, 0);
            NEAR(v[i], 100 + alone_v[i], 0, 0);
        }
        for (int i = n; i < N_TARGETS; i++) NEAR(u[i], 100, 0, 0);
    }
}

static void gradient_is_that_of_the_velocity(void **state) {
    (void)state;
    double u[N_TARGETS] = {0}, v[N_TARGETS] = {0}, u_x[N_TARGETS] = {0}, u_y[N_TARGETS] = {0}, v_x[N_TARGETS] = {0};
    const double smoothing = 0.2, h = 1e-5;
    kernel_add_gradient(N_TARGETS, cloud.x, cloud.y, N_SOURCES, cloud.source_x, cloud.source_y, cloud.circulation,
                        smoothing, u, v, u_x, u_y, v_x);
    for (int i = 0; i < N_TARGETS; i++) {
        double p[4][2];
        plain_velocity(cloud.x[i] - h, cloud.y[i], smoothing, &p[0][0], &p[0][1]);
        plain_velocity(cloud.x[i] + h, cloud.y[i], smoothing, &p[1][0], &p[1][1]);
        plain_velocity(cloud.x[i], cloud.y[i] - h, smoothing, &p[2][0], &p[2][1]);
        plain_velocity(cloud.x[i], cloud.y[i] + h, smoothing, &p[3][0], &p[3][1]);
        // truncation h^2/6 times third derivatives of order 1/smoothing^4; rounding 1e-15/h
        NEAR(u_x[i], (p[1][0] - p[0][0]) / (2 * h), 1e-7, 0);
        NEAR(v_x[i], (p[1][1] - p[0][1]) / (2 * h), 1e-7, 0);
        NEAR(u_y[i], (p[3][0] - p[2][0]) / (2 * h), 1e-7, 0);
        NEAR(-u_x[i], (p[3][1] - p[2][1]) / (2 * h), 1e-7, 0);
        // the velocity itself: rounding of sums of 53 terms
        plain_velocity(cloud.x[i], cloud.y[i], smoothing, &p[0][0], &p[0][1]);
        NEAR(u[i], p[0][0], 1e-14, 0);
        NEAR(v[i], p[0][1], 1e-14, 0);
    }
}

static void one_unit_source_is_what_the_loops_add(void **state) {
    (void)state;
    const double x = 0.3, y = -0.2, zero = 0, one = 1;
    double u = 0, v = 0, u_x = 0, u_y = 0, v_x = 0;
    kernel_add_gradient(1, &x, &y, 1, &zero, &zero, &one, 0.1, &u, &v, &u_x, &u_y, &v_x);
    const struct kernel_value unit = kernel_unit(x, y, 0.1);
    const double got[] = {unit.u, unit.v, unit.u_x, unit.u_y, unit.v_x}, want[] = {u, v, u_x, u_y, v_x};
    NEAR_ARRAY(5, got, want, 0, 1e-14);
    // K_e(r) = (-r_y, r_x)/(2 pi (r^2 + e^2)) by hand
    NEAR(u, 0.2 / (2 * acos(-1) * 0.14), 0, 1e-15);
}

static void a_vortex_pair_translates_at_the_known_speed(void **state) {
    (void)state;
    // doc/model.md, section 12: G d/(2 pi (d^2 + delta^2))
    const double x[2] = {0, 0}, y[2] = {-0.5, 0.5}, g[2] = {3, -3}, delta = 0.2;
    double u[2] = {0}, v[2] = {0};
    kernel_add_velocity(2, x, y, 2, x, y, g, delta, u, v);
    const double speed = -3 / (2 * acos(-1) * (1 + delta * delta));
    for (int i = 0; i < 2; i++) {
        NEAR(u[i], speed, 0, 1e-15);
        NEAR(v[i], 0, 0, 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(velocity_has_the_bits_of_a_plain_loop),
        cmocka_unit_test(targets_do_not_depend_on_their_neighbours),
        cmocka_unit_test(velocity_is_added_to_what_is_there_and_writes_nothing_else),
        cmocka_unit_test(gradient_is_that_of_the_velocity),
        cmocka_unit_test(one_unit_source_is_what_the_loops_add),
        cmocka_unit_test(a_vortex_pair_translates_at_the_known_speed),
    };
    return cmocka_run_group_tests(tests, scatter, NULL);
}
