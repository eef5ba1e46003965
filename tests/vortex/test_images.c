/* test_images.c: the images of vortices in one wall and in a channel. */
#include <stdlib.h>
#include <string.h>

#include "near.h"
#include "vortex/images.h"

static const double pi = 3.14159265358979323846;

static const struct walls below = {1, {-0.4}, {1}}, above = {1, {1.1}, {-1}}, channel = {2, {-0.4, 1.1}, {1, -1}};

enum { N_SOURCES = 40, N_TARGETS = 70, SMALL = 7 };

// vortices of two smoothings, inside all walls
static void make(struct vortices *vortices, int n) {
    *vortices = (struct vortices){0};
    assert_int_equal(vortices_append(vortices, n / 3, 0.1), STATUS_OK);
    assert_int_equal(vortices_append(vortices, n - n / 3, 0.02), STATUS_OK);
    for (int i = 0; i < n; i++) {
        vortices->x[i] = 2 * sin(3 * i);
        vortices->y[i] = 0.35 + 0.74 * cos(5 * i);
        vortices->circulation[i] = cos(7 * i);
    }
}

struct points {
    double *memory;
    struct induced at;
};

static void make_points(struct points *points, int n) {
    double *const p = points->memory = calloc(7 * (size_t)n, sizeof *p);
    assert_non_null(p);
    for (int i = 0; i < n; i++) {
        p[i] = 2 * cos(11 * i);
        p[n + i] = 0.35 + 0.74 * sin(13 * i);
    }
    points->at = (struct induced){n, p, p + n, p + 2 * n, p + 3 * n, p + 4 * n, p + 5 * n, p + 6 * n};
}

static void all_of(const struct walls *walls, const struct vortices *vortices, const struct induced *at) {
    vortices_zero(at);
    vortices_induce(vortices, (struct range){0, vortices->n}, at);
    images_induce(walls, vortices, (struct range){0, vortices->n}, at);
}

// ---- rings in a channel of width 1.5

enum { N_RING_TARGETS = 24 };

// velocity and div u of one ring of half span `span` with its images at targets, half of them on the walls
struct ring_field {
    double x[N_RING_TARGETS], y[N_RING_TARGETS];
    double u[N_RING_TARGETS], v[N_RING_TARGETS], div[N_RING_TARGETS];
};
static void ring_field_of(const struct rings *rings, double span, int n_images, const struct ring_image *image,
                          struct ring_field *field) {
    struct rings images = {0};
    memset(field, 0, sizeof *field);
    for (int i = 0; i < N_RING_TARGETS; i++) {
        field->x[i] = 0.7 * (i / 2 - 4);
        field->y[i] = i % 2 == 0 ? channel.y[i / 2 % 2] : 0.35 + 0.6 * sin(13 * i);
    }

    const struct ring_pair pair = {.span = span, .factor = 4, .square = 0.001};
    const struct ring_targets at = {.n = N_RING_TARGETS,
                                    .x = field->x,
                                    .y = field->y,
                                    .half = rings->leg,
                                    .u = field->u,
                                    .v = field->v,
                                    .div = field->div};
    assert_int_equal(ring_write_images(rings, n_images, image, &images), STATUS_OK);
    ring_induce(&pair, rings, (struct range){0, 1}, &at);
    ring_induce(&pair, &images, (struct range){0, images.n}, &at);
    ring_free(&images);
}

// a ring with half = span^2/8: all of T; leg: 0 for all targets
static void ring_make(struct rings *rings, double span) {
    *rings = (struct rings){0};
    assert_int_equal(ring_append(rings, N_RING_TARGETS), STATUS_OK);
    rings->n = 1;
    rings->x[0] = 0.1;
    rings->y[0] = 0.8;
    rings->q[0] = 0.7;
    rings->dx[0] = 0.05;
    rings->dy[0] = 0.04;
    rings->half[0] = span * span / 4;
}

// targets up to 6 channel widths away; bound: part of the largest velocity on a wall, 2 q/(4 H) without depth
static void rings_and_images_cause_no_flow_through_a_channel(void **state) {
    (void)state;
    static const struct {
        double depth, bound;
        int n;
    } cases[] = {{0.1, 1e-12, 36}, {1, 1e-12, 36}, {12, 1e-11, 36}, {100, 1e-8, 80}, {1e5, 1e-8, 240}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct ring_image *image;
        struct rings rings;
        struct ring_field field;
        int n;
        ring_make(&rings, cases[i].depth / 2);
        assert_int_equal(images_of_rings(&channel, cases[i].depth, &image, &n), STATUS_OK);
        assert_int_equal(n, cases[i].n);
        ring_field_of(&rings, cases[i].depth / 2, n, image, &field);
        double through = 0, along = 0;
        for (int k = 0; k < N_RING_TARGETS; k += 2) {
            through = fmax(through, fabs(field.v[k]));
            along = fmax(along, fabs(field.u[k]));
        }
        print_message("depth %g: %d images, flow through the walls %.2g of %.2g\n", cases[i].depth, n, through, along);
        assert_true(through < cases[i].bound * along);
        free(image);
        ring_free(&rings);
    }
}

// the sum over 40 000 images
static void few_images_of_rings_are_the_sum_over_all(void **state) {
    (void)state;
    enum { MANY = 10000 };
    struct ring_image *image, *all = calloc(4 * MANY, sizeof *all);
    assert_non_null(all);
    for (int k = 1; k <= MANY; k++) {
        all[4 * k - 4] = (struct ring_image){-1, 0.7 - 1.5 * (2 * k - 1), 1};
        all[4 * k - 3] = (struct ring_image){-1, 0.7 + 1.5 * (2 * k - 1), 1};
        all[4 * k - 2] = (struct ring_image){1, 3.0 * k, 1};
        all[4 * k - 1] = (struct ring_image){1, -3.0 * k, 1};
    }

    static const double depths[] = {0.1, 1, 12, 100};
    for (size_t i = 0; i < sizeof depths / sizeof *depths; i++) {
        struct rings rings;
        struct ring_field sum, few;
        int n;
        ring_make(&rings, depths[i] / 2);
        assert_int_equal(images_of_rings(&channel, depths[i], &image, &n), STATUS_OK);
        ring_field_of(&rings, depths[i] / 2, 4 * MANY, all, &sum);
        ring_field_of(&rings, depths[i] / 2, n, image, &few);

        // the rest beyond the sum is depth/(H MANY)^2
        const double bound = 2e-8 + 1e-2 * depths[i] / ((double)MANY * MANY);
        for (int k = 0; k < N_RING_TARGETS; k++) {
            NEAR(few.u[k], sum.u[k], bound, 0);
            NEAR(few.v[k], sum.v[k], bound, 0);
            NEAR(few.div[k], sum.div[k], bound, 0);
        }
        free(image);
        ring_free(&rings);
    }
    free(all);
}

// for a deep strip: the closed sum over the images of a vortex
static void images_of_deep_rings_are_those_of_vortices(void **state) {
    (void)state;
    const double depth = 1e7;
    struct ring_image *image;
    struct rings rings;
    struct ring_field field;
    int n;
    ring_make(&rings, depth / 2);
    assert_int_equal(images_of_rings(&channel, depth, &image, &n), STATUS_OK);
    assert_int_equal(n, 272);
    ring_field_of(&rings, depth / 2, n, image, &field);

    struct vortices vortex = {0};
    double u[N_RING_TARGETS], v[N_RING_TARGETS];
    const struct induced at = {.n = N_RING_TARGETS, .x = field.x, .y = field.y, .u = u, .v = v};
    assert_int_equal(vortices_append(&vortex, 1, sqrt(0.001)), STATUS_OK);
    vortex.x[0] = rings.x[0];
    vortex.y[0] = rings.y[0];
    vortex.circulation[0] = rings.q[0];
    memset(u, 0, sizeof u);
    memset(v, 0, sizeof v);
    vortices_induce(&vortex, (struct range){0, 1}, &at);
    images_induce(&channel, &vortex, (struct range){0, 1}, &at);
    for (int k = 0; k < N_RING_TARGETS; k++) {
        NEAR(field.u[k], u[k], 1e-7, 0);
        NEAR(field.v[k], v[k], 1e-7, 0);
        NEAR(field.div[k], 0, 1e-7, 0);
    }
    free(image);
    ring_free(&rings);
    vortices_free(&vortex);
}

static void distances_are_those_from_the_nearest_wall(void **state) {
    (void)state;
    const struct walls none = {0};
    assert_true(isinf(images_distance(&none, 3)));
    NEAR(images_distance(&below, 0.1), 0.5, 1e-15, 0);
    NEAR(images_distance(&above, 0.1), 1, 1e-15, 0);
    NEAR(images_distance(&channel, 0.1), 0.5, 1e-15, 0);
    NEAR(images_distance(&channel, 1), 0.1, 1e-15, 0);
    NEAR(images_distance(&channel, 1.2), -0.1, 1e-15, 0);
}

// K_e of a vortex at (sx, sy)
static void add_kernel(double x, double y, double sx, double sy, double g, double e, double velocity[2]) {
    const double rx = x - sx, ry = y - sy, d = 2 * pi * (rx * rx + ry * ry + e * e);
    velocity[0] -= g * ry / d;
    velocity[1] += g * rx / d;
}

static void one_wall_has_one_image_of_every_vortex(void **state) {
    (void)state;
    const struct walls *const walls[] = {&below, &above};
    struct vortices vortices;
    struct points points;
    make(&vortices, N_SOURCES);
    make_points(&points, N_TARGETS);
    for (int w = 0; w < 2; w++) {
        vortices_zero(&points.at);
        images_induce(walls[w], &vortices, (struct range){5, 20}, &points.at);
        for (int i = 0; i < N_TARGETS; i++) {
            double want[2] = {0, 0};
            for (int j = 5; j < 25; j++) {
                add_kernel(points.at.x[i], points.at.y[i], vortices.x[j], 2 * walls[w]->y[0] - vortices.y[j],
                           -vortices.circulation[j], j < N_SOURCES / 3 ? 0.1 : 0.02, want);
            }
            NEAR(points.at.u[i], want[0], 1e-14, 1e-13);
            NEAR(points.at.v[i], want[1], 1e-14, 1e-13);
        }
    }
    free(points.memory);
    vortices_free(&vortices);
}

// velocity of a number of images on either side at a point
static void sum_images(const struct vortices *vortices, double x, double y, int rows, double velocity[2]) {
    const double low = channel.y[0], width = channel.y[1] - channel.y[0];
    velocity[0] = velocity[1] = 0;
    for (int j = 0; j < vortices->n; j++) {
        const double g = vortices->circulation[j], e = j < vortices->n / 3 ? 0.1 : 0.02;
        for (int k = -rows; k <= rows; k++) {
            const double shift = 2 * k * width;
            if (k != 0) add_kernel(x, y, vortices->x[j], vortices->y[j] + shift, g, e, velocity);
            add_kernel(x, y, vortices->x[j], 2 * low - vortices->y[j] + shift, -g, e, velocity);
        }
    }
}

static void a_channel_has_all_images_of_the_images(void **state) {
    (void)state;
    struct vortices vortices;
    struct points points;
    make(&vortices, SMALL);
    make_points(&points, SMALL);
    vortices_zero(&points.at);
    images_induce(&channel, &vortices, (struct range){0, SMALL}, &points.at);
    for (int i = 0; i < SMALL; i++) {
        // the truncated part of the sum decreases as 1/rows: extrapolate
        double few[2], more[2];
        sum_images(&vortices, points.at.x[i], points.at.y[i], 500, few);
        sum_images(&vortices, points.at.x[i], points.at.y[i], 1000, more);
        assert_true(fabs(more[0] - few[0]) > 1e-5);
        NEAR(points.at.u[i], 2 * more[0] - few[0], 1e-6, 0);
        NEAR(points.at.v[i], 2 * more[1] - few[1], 1e-6, 0);
    }
    free(points.memory);
    vortices_free(&vortices);
}

// the speed of a lone vortex with a very small core
static double speed_of_one(const struct walls *walls, double y) {
    double x = 0, circulation = 1.3, u = 0, v = 0;
    struct vortex_group group = {{0, 1}, 1e-7};
    const struct vortices one = {.n = 1, .x = &x, .y = &y, .circulation = &circulation, .n_groups = 1, .group = &group};
    images_induce(walls, &one, (struct range){0, 1}, &(struct induced){1, &x, &y, &u, &v, NULL, NULL, NULL});
    NEAR(v, 0, 1e-15, 0);
    return u / circulation;
}

static void a_vortex_goes_along_the_wall_at_the_classical_speed(void **state) {
    (void)state;
    // Lamb, Hydrodynamics, 155: G/(4 pi d) beside a wall; between two walls G/(4H) cot(pi d/H)
    for (double d = 0.05; d < 1.5; d += 0.1) {
        NEAR(speed_of_one(&below, below.y[0] + d), 1 / (4 * pi * d), 0, 1e-11);
        NEAR(speed_of_one(&above, above.y[0] - d), -1 / (4 * pi * d), 0, 1e-11);
        NEAR(speed_of_one(&channel, channel.y[0] + d), 1 / (4 * 1.5 * tan(pi * d / 1.5)), 1e-12, 1e-10);
    }
}

static void nothing_goes_through_the_walls(void **state) {
    (void)state;
    const struct walls *const walls[] = {&below, &above, &channel};
    struct vortices vortices;
    struct points points;
    make(&vortices, N_SOURCES);
    make_points(&points, N_TARGETS);
    double *const y = points.memory + N_TARGETS;
    for (int w = 0; w < 3; w++) {
        for (int i = 0; i < N_TARGETS; i++) y[i] = walls[w]->y[i % walls[w]->n];
        all_of(walls[w], &vortices, &points.at);
        double largest = 0;
        for (int i = 0; i < N_TARGETS; i++) {
            NEAR(points.at.v[i], 0, 1e-12, 0);
            largest = fmax(largest, fabs(points.at.u[i]));
        }
        assert_true(largest > 1);
    }
    free(points.memory);
    vortices_free(&vortices);
}

static void gradients_are_differences_of_velocities(void **state) {
    (void)state;
    const struct walls *const walls[] = {&below, &above, &channel};
    struct vortices vortices;
    struct points here;
    make(&vortices, N_SOURCES);
    make_points(&here, SMALL);
    const double h = 1e-5;
    for (int w = 0; w < 3; w++) {
        vortices_zero(&here.at);
        images_induce(walls[w], &vortices, (struct range){0, N_SOURCES}, &here.at);
        double difference[2][2][SMALL] = {{{0}}};  // of u, v by x, y
        for (int c = 0; c < 2; c++) {
            for (int side = -1; side <= 1; side += 2) {
                struct points there;
                make_points(&there, SMALL);
                for (int i = 0; i < SMALL; i++) there.memory[c * SMALL + i] += side * h;
                struct induced at = there.at;
                at.u_x = at.u_y = at.v_x = NULL;
                images_induce(walls[w], &vortices, (struct range){0, N_SOURCES}, &at);
                for (int i = 0; i < SMALL; i++) {
                    difference[0][c][i] += side * at.u[i] / (2 * h);
                    difference[1][c][i] += side * at.v[i] / (2 * h);
                }
                free(there.memory);
            }
        }
        NEAR_ARRAY(SMALL, here.at.u_x, difference[0][0], 1e-5, 1e-6);
        NEAR_ARRAY(SMALL, here.at.u_y, difference[0][1], 1e-5, 1e-6);
        NEAR_ARRAY(SMALL, here.at.v_x, difference[1][0], 1e-5, 1e-6);
        for (int i = 0; i < SMALL; i++) NEAR(difference[1][1][i], -here.at.u_x[i], 1e-5, 1e-6);
    }
    free(here.memory);
    vortices_free(&vortices);
}

static void images_of(const struct walls *walls, int n, const double *x, const double *y, const double source[2],
                      double *u, double *v) {
    double sx = source[0], sy = source[1], circulation = 1;
    struct vortex_group group = {{0, 1}, 0.03};
    const struct vortices one = {
        .n = 1, .x = &sx, .y = &sy, .circulation = &circulation, .n_groups = 1, .group = &group};
    memset(u, 0, (size_t)n * sizeof *u);
    memset(v, 0, (size_t)n * sizeof *v);
    images_induce(walls, &one, (struct range){0, 1}, &(struct induced){n, x, y, u, v, NULL, NULL, NULL});
}

static void images_of_one_source_follow_it(void **state) {
    (void)state;
    const struct walls *const walls[] = {&below, &above, &channel};
    struct points points;
    make_points(&points, SMALL);
    const double *const x = points.at.x, *const y = points.at.y, h = 1e-5;
    for (int w = 0; w < 3; w++) {
        const double source[2] = {0.1, 0.3};
        struct images_values unit;
        double u[SMALL], v[SMALL];
        images_unit(walls[w], SMALL, x, y, source[0], source[1], 0.03, &unit);
        images_of(walls[w], SMALL, x, y, source, u, v);
        for (int i = 0; i < SMALL; i++) {
            NEAR(unit.shifted.u[i] + unit.mirrored.u[i], u[i], 1e-14, 1e-12);
            NEAR(unit.shifted.v[i] + unit.mirrored.v[i], v[i], 1e-14, 1e-12);
        }
        // by the source position
        for (int c = 0; c < 2; c++) {
            double after[2] = {source[0], source[1]}, before[2] = {source[0], source[1]};
            const double minus = -1;
            double u_after[SMALL], v_after[SMALL], by_x[2][SMALL] = {{0}}, by_y[2][SMALL] = {{0}};
            after[c] += h;
            before[c] -= h;
            images_of(walls[w], SMALL, x, y, after, u_after, v_after);
            images_of(walls[w], SMALL, x, y, before, u, v);
            kernel_add_motion(SMALL, 1, &minus, 1, &unit.shifted, by_x[0], by_x[1], by_y[0], by_y[1]);
            kernel_add_motion(SMALL, 1, &minus, -1, &unit.mirrored, by_x[0], by_x[1], by_y[0], by_y[1]);
            for (int i = 0; i < SMALL; i++) {
                NEAR((u_after[i] - u[i]) / (2 * h), c == 0 ? by_x[0][i] : by_y[0][i], 1e-7, 1e-7);
                NEAR((v_after[i] - v[i]) / (2 * h), c == 0 ? by_x[1][i] : by_y[1][i], 1e-7, 1e-7);
            }
        }
    }
    free(points.memory);
}

static void many_are_summed_by_the_tree_and_by_threads(void **state) {
    (void)state;
    enum { MANY = 2600 };
    const struct walls *const walls[] = {&below, &channel};
    struct velocity_sum *sum;
    assert_int_equal(velocity_sum_create(&sum), STATUS_OK);
    struct vortices vortices;
    make(&vortices, MANY);
    for (int w = 0; w < 2; w++) {
        const int n = w == 0 ? MANY : 200;
        struct points points[3];
        for (int k = 0; k < 3; k++) make_points(&points[k], n);
        images_induce(walls[w], &vortices, (struct range){0, MANY}, &points[0].at);
        const double tolerance = 1e-6;
        assert_int_equal(velocity_sum_by_tree(&vortices, n, tolerance), w == 0);
        for (int k = 1; k < 3; k++) {
            assert_int_equal(images_induce_many(walls[w], sum, &vortices, tolerance, k, &points[k].at), STATUS_OK);
        }
        // the circulations add up to 1700, and nothing is nearer than 0.01
        NEAR_ARRAY(n, points[1].at.u, points[0].at.u, 1e-4, 1e-6);
        NEAR_ARRAY(n, points[1].at.v, points[0].at.v, 1e-4, 1e-6);
        NEAR_ARRAY(n, points[1].at.v_x, points[0].at.v_x, 1e-2, 1e-5);
        assert_memory_equal(points[1].memory, points[2].memory, 7 * (size_t)n * sizeof(double));
        for (int k = 0; k < 3; k++) free(points[k].memory);
    }
    velocity_sum_free(sum);
    vortices_free(&vortices);
}

// The largest error of the images of many vortices in a channel, in units of the bound, at targets next to both walls
// and between the walls, over a channel length of `length` widths.
static double error_in_channel(const struct vortices *vortices, double length, double tolerance,
                               struct velocity_sum *sum) {
    enum { N = 400 };
    struct points exact, far;
    make_points(&exact, N);
    for (int i = 0; i < N; i++) {
        exact.memory[i] = length * 1.5 * (0.5 + 0.5 * sin(1 + 11 * i));
        exact.memory[N + i] = -0.4 + 1.5 * (0.5 - 0.5 * cos(13 * i));
    }
    make_points(&far, N);
    memcpy(far.memory, exact.memory, 2 * N * sizeof(double));
    const struct range all = {0, vortices->n};
    images_induce(&channel, vortices, all, &exact.at);
    assert_int_equal(far_images_induce(velocity_sum_far_images(sum), &channel, vortices, tolerance, 2, &far.at),
                     STATUS_OK);
    images_induce(&below, vortices, all, &far.at);
    images_induce(&above, vortices, all, &far.at);
    double worst = 0;
    for (int i = 0; i < N; i++) {
        double bound = 0, slope = 0;
        for (int j = 0; j < vortices->n; j++) {
            const double rx = exact.at.x[i] - vortices->x[j], ry = exact.at.y[i] - vortices->y[j];
            const double r = sqrt(rx * rx + ry * ry + 0.02 * 0.02), g = fabs(vortices->circulation[j]) / (2 * pi * r);
            bound += g;
            slope += 50 * g / r;
        }
        const double *const want[] = {exact.at.u, exact.at.v, exact.at.u_x, exact.at.u_y, exact.at.v_x};
        const double *const got[] = {far.at.u, far.at.v, far.at.u_x, far.at.u_y, far.at.v_x};
        for (int k = 0; k < 5; k++) {
            worst = fmax(worst, fabs(got[k][i] - want[k][i]) / ((k < 2 ? bound : slope) * tolerance / 10));
        }
    }
    free(exact.memory);
    free(far.memory);
    return worst;
}

static void far_images_in_a_channel_are_within_the_tolerance(void **state) {
    (void)state;
    enum { N = 400 };
    static const double lengths[] = {2.6, 12.3}, tolerances[] = {1e-4, 1e-7, 1e-10};
    struct velocity_sum *sum;
    assert_int_equal(velocity_sum_create(&sum), STATUS_OK);
    for (int l = 0; l < 2; l++) {
        const int n_smoothings = l == 0 ? 1 : 3;
        struct vortices vortices = {0};
        for (int i = 0; i < N; i += 50) {
            assert_int_equal(vortices_append(&vortices, 50, 0.02 + 0.04 * (i / 50 % n_smoothings)), STATUS_OK);
        }
        for (int i = 0; i < N; i++) {
            vortices.x[i] = lengths[l] * 1.5 * (0.5 + 0.5 * cos(7 * i));
            vortices.y[i] = -0.4 + 1.5 * (0.5 + 0.5 * sin(3 * i));
        }
        for (size_t t = 0; t < sizeof tolerances / sizeof *tolerances; t++) {
            // all together, and one alone: beside a wall, in the middle, beside a wall and an end of its cell
            double worst[4];
            for (int k = 0; k < 4; k++) {
                for (int i = 0; i < N; i++) vortices.circulation[i] = k == 0 ? cos(5 * i) : 0;
                if (k > 0) {
                    const double y[] = {-0.4, 0.35, 1.1}, x[] = {0.75, 0.75, 1.5};
                    vortices.circulation[0] = 1;
                    vortices.x[0] = x[k - 1];
                    vortices.y[0] = y[k - 1];
                }
                worst[k] = error_in_channel(&vortices, lengths[l], tolerances[t], sum);
                assert_true(worst[k] < 1);
            }
            print_message("%d smoothings, %.1f widths, tolerance %.0e: %.2g, %.2g, %.2g, %.2g of the bound\n",
                          n_smoothings, lengths[l], tolerances[t], worst[0], worst[1], worst[2], worst[3]);
        }
        vortices_free(&vortices);
    }
    velocity_sum_free(sum);
}

static void cells_sum_where_that_pays(void **state) {
    (void)state;
    enum { N = 400 };
    const double tolerance = 1e-7;
    struct vortices vortices;
    struct points points;
    make(&vortices, N);
    make_points(&points, N);
    assert_true(images_by_cells(&channel, &vortices, tolerance, &points.at));
    // one wall, no tolerance, few vortices, a channel far too long, a position that is not finite
    assert_false(images_by_cells(&below, &vortices, tolerance, &points.at));
    assert_false(images_by_cells(&channel, &vortices, 0, &points.at));
    struct induced few = points.at;
    few.n = 100;
    assert_false(images_by_cells(&channel, &vortices, tolerance, &few));
    const double far[] = {1e4, INFINITY, NAN};
    for (int i = 0; i < 3; i++) {
        vortices.x[7] = far[i];
        assert_false(images_by_cells(&channel, &vortices, tolerance, &points.at));
    }
    free(points.memory);
    vortices_free(&vortices);
}

static void the_nearest_images_leave_only_distant_ones(void **state) {
    (void)state;
    struct image image[IMAGES_NEAREST];
    const struct walls none = {0};
    assert_int_equal(images_nearest(&none, image), 0);
    assert_int_equal(images_nearest(&above, image), 1);
    NEAR(image[0].sign * 0.3 + image[0].shift, 1.9, 1e-15, 0);
    assert_int_equal(images_nearest(&channel, image), 4);
    const double want[] = {-1.1, 1.9, 3.3, -2.7}, sign[] = {-1, -1, 1, 1};
    for (int i = 0; i < 4; i++) {
        NEAR(image[i].sign * 0.3 + image[i].shift, want[i], 1e-15, 0);
        NEAR(image[i].sign, sign[i], 0, 0);
    }
}

static void rates(const struct walls *walls, const struct vortices *vortices, double *u, double *v) {
    const struct induced at = {vortices->n, vortices->x, vortices->y, u, v, NULL, NULL, NULL};
    all_of(walls, vortices, &at);
}

static void a_pair_that_meets_a_wall_parts_along_it(void **state) {
    (void)state;
    // Lamb, 155: the path of each vortex is 1/x^2 + 1/d^2 = constant, d from the wall
    struct vortices pair = {0};
    assert_int_equal(vortices_append(&pair, 2, 1e-6), STATUS_OK);
    const double start[2][2] = {{0.1, 0.6}, {-0.1, 0.6}};
    for (int i = 0; i < 2; i++) {
        pair.x[i] = start[i][0];
        pair.y[i] = start[i][1] + below.y[0];
        pair.circulation[i] = i == 0 ? 1 : -1;
    }
    const double constant = 1 / (0.1 * 0.1) + 1 / (0.6 * 0.6), dt = 1e-3;
    for (int step = 0; step < 1200; step++) {  // Runge-Kutta method of order 4
        static const double part[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
        double x[2], y[2], u[2] = {0, 0}, v[2] = {0, 0}, sum_u[2] = {0, 0}, sum_v[2] = {0, 0};
        memcpy(x, pair.x, sizeof x);
        memcpy(y, pair.y, sizeof y);
        for (int stage = 0; stage < 4; stage++) {
            for (int i = 0; i < 2; i++) {
                pair.x[i] = x[i] + part[stage] * dt * u[i];
                pair.y[i] = y[i] + part[stage] * dt * v[i];
            }
            rates(&below, &pair, u, v);
            for (int i = 0; i < 2; i++) {
                sum_u[i] += weight[stage] * u[i] / 6;
                sum_v[i] += weight[stage] * v[i] / 6;
            }
        }
        for (int i = 0; i < 2; i++) {
            pair.x[i] = x[i] + dt * sum_u[i];
            pair.y[i] = y[i] + dt * sum_v[i];
            const double d = pair.y[i] - below.y[0];
            NEAR(1 / (pair.x[i] * pair.x[i]) + 1 / (d * d), constant, 0, 1e-6);
        }
    }
    assert_true(pair.x[0] > 0.3 && pair.x[1] < -0.3);
    vortices_free(&pair);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rings_and_images_cause_no_flow_through_a_channel),
        cmocka_unit_test(few_images_of_rings_are_the_sum_over_all),
        cmocka_unit_test(images_of_deep_rings_are_those_of_vortices),
        cmocka_unit_test(distances_are_those_from_the_nearest_wall),
        cmocka_unit_test(one_wall_has_one_image_of_every_vortex),
        cmocka_unit_test(a_channel_has_all_images_of_the_images),
        cmocka_unit_test(a_vortex_goes_along_the_wall_at_the_classical_speed),
        cmocka_unit_test(nothing_goes_through_the_walls),
        cmocka_unit_test(gradients_are_differences_of_velocities),
        cmocka_unit_test(images_of_one_source_follow_it),
        cmocka_unit_test(many_are_summed_by_the_tree_and_by_threads),
        cmocka_unit_test(far_images_in_a_channel_are_within_the_tolerance),
        cmocka_unit_test(cells_sum_where_that_pays),
        cmocka_unit_test(the_nearest_images_leave_only_distant_ones),
        cmocka_unit_test(a_pair_that_meets_a_wall_parts_along_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
