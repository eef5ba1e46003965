/* test_images.c: The images in one wall and in a channel are compared with theory, with sums in closed form, and with
 * sums over many images. */
#include <stdlib.h>
#include <string.h>

#include "flow/flow.h"
#include "flow/images.h"
#include "flow/kernel.h"
#include "school.h"

static const double pi = 3.14159265358979323846;

static const struct walls below = {1, {-0.4}, {1}}, above = {1, {1.1}, {-1}}, channel = {2, {-0.4, 1.1}, {1, -1}};

// ---- rings in a channel of width 1.5

enum { N_RING_TARGETS = 24 };

// velocity and div u of one ring of half span `span` with its images at targets, half of them on the walls
struct ring_field {
    double x[N_RING_TARGETS], y[N_RING_TARGETS], u[N_RING_TARGETS], v[N_RING_TARGETS], div[N_RING_TARGETS];
};
static void ring_field_of(const struct sources *rings, double span, int n_images, const struct image *image,
                          struct ring_field *field) {
    struct sources images = {.arena = test_arena()};
    memset(field, 0, sizeof *field);
    for (int i = 0; i < N_RING_TARGETS; i++) {
        field->x[i] = 0.7 * (i / 2 - 4);
        field->y[i] = i % 2 == 0 ? channel.y[i / 2 % 2] : 0.35 + 0.6 * sin(13 * i);
    }

    const struct kernel_pair pair = kernel_finite.other(2 * span, 0.001);
    const struct targets at = {.n = N_RING_TARGETS,
                               .x = field->x,
                               .y = field->y,
                               .half = rings->leg,
                               .u = field->u,
                               .v = field->v,
                               .div = field->div};
    images_write(rings, n_images, image, &images);
    kernel_induce(&pair, rings, (struct range){0, 1}, &at);
    kernel_induce(&pair, &images, (struct range){0, images.n}, &at);
}

// a ring with half = span^2/8: all of T; leg: 0 for all targets
static void ring_make(struct sources *rings, double span) {
    *rings = (struct sources){.arena = test_arena()};
    sources_append(rings, N_RING_TARGETS);
    rings->n = 1;
    rings->x[0] = 0.1;
    rings->y[0] = 0.8;
    rings->q[0] = 0.7;
    rings->dx[0] = 0.05;
    rings->dy[0] = 0.04;
    rings->half[0] = span * span / 4;
}

// targets up to 6 channel widths away; bound: part of the largest velocity on a wall, 2 q/(4 H) without depth
TEST(rings_and_images_cause_no_flow_through_a_channel) {
    static const struct {
        double depth, bound;
        int n;
    } cases[] = {{0.1, 1e-12, 36}, {1, 1e-12, 36}, {12, 1e-11, 36}, {100, 1e-8, 80}, {1e5, 1e-8, 240}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct image *image;
        struct sources rings;
        struct ring_field field;
        ring_make(&rings, cases[i].depth / 2);
        const int n = images_find(test_arena(), &channel, cases[i].depth, &image);
        assert_int_equal(n, cases[i].n);
        ring_field_of(&rings, cases[i].depth / 2, n, image, &field);
        double through = 0, along = 0;
        for (int k = 0; k < N_RING_TARGETS; k += 2) {
            through = fmax(through, fabs(field.v[k]));
            along = fmax(along, fabs(field.u[k]));
        }
        BELOW(through, cases[i].bound * along);
    }
}

TEST(a_ring_with_its_image_is_symmetric_about_the_wall) {
    enum { N = 6 };
    struct sources ring, images = {.arena = test_arena()};
    struct image *image;
    double x[2 * N], y[2 * N], u[2 * N] = {0}, v[2 * N] = {0}, div[2 * N] = {0};
    ring_make(&ring, 0.5);
    for (int i = 0; i < N; i++) {
        x[i] = x[N + i] = 0.3 * i - 0.7;
        y[i] = below.y[0] + 0.2 * i;
        y[N + i] = below.y[0] - 0.2 * i;
    }
    const struct kernel_pair pair = kernel_finite.other(1, 0.001);
    const struct targets at = {.n = 2 * N, .x = x, .y = y, .u = u, .v = v, .div = div};
    const int n_images = images_find(test_arena(), &below, 1, &image);
    images_write(&ring, n_images, image, &images);
    kernel_induce(&pair, &ring, (struct range){0, 1}, &at);
    kernel_induce(&pair, &images, (struct range){0, 1}, &at);
    for (int i = 0; i < N; i++) {
        NEAR(u[N + i], u[i], 1e-14, 1e-12);
        NEAR(v[N + i], -v[i], 1e-14, 1e-12);
        NEAR(div[N + i], div[i], 1e-14, 1e-12);
    }
}

// the sum over 40 000 images
TEST(few_images_of_rings_are_the_sum_over_all) {
    enum { MANY = 10000 };
    struct image *image, *all;
    NEW(test_arena(), all, 4 * MANY);
    for (int k = 1; k <= MANY; k++) {
        all[4 * k - 4] = (struct image){-1, 0.7 - 1.5 * (2 * k - 1), 1};
        all[4 * k - 3] = (struct image){-1, 0.7 + 1.5 * (2 * k - 1), 1};
        all[4 * k - 2] = (struct image){1, 3.0 * k, 1};
        all[4 * k - 1] = (struct image){1, -3.0 * k, 1};
    }

    static const double depths[] = {0.1, 1, 12, 100};
    for (size_t i = 0; i < sizeof depths / sizeof *depths; i++) {
        struct sources rings;
        struct ring_field sum, few;
        ring_make(&rings, depths[i] / 2);
        const int n = images_find(test_arena(), &channel, depths[i], &image);
        ring_field_of(&rings, depths[i] / 2, 4 * MANY, all, &sum);
        ring_field_of(&rings, depths[i] / 2, n, image, &few);

        // the rest beyond the sum is depth/(H MANY)^2
        const double bound = 2e-8 + 1e-2 * depths[i] / ((double)MANY * MANY);
        for (int k = 0; k < N_RING_TARGETS; k++) {
            NEAR(few.u[k], sum.u[k], bound, 0);
            NEAR(few.v[k], sum.v[k], bound, 0);
            NEAR(few.div[k], sum.div[k], bound, 0);
        }
    }
}

// ---- vortices

/* The velocity of vortices of infinite span, and of the images with `weight`; square: e^2 of the vortices themselves
 * and of the images. */
static void induce(const struct walls *walls, const struct sources *vortices, double square, double of_themselves,
                   const struct targets *at) {
    struct sources images = {.arena = test_arena()};
    struct image *image;
    const int n = images_find(test_arena(), walls, 0, &image);
    images_write(vortices, n, image, &images);
    memset(at->u, 0, (size_t)at->n * sizeof *at->u);
    memset(at->v, 0, (size_t)at->n * sizeof *at->v);
    struct kernel_pair pair = kernel_infinite.other(0, square);
    kernel_induce(&pair, &images, (struct range){0, images.n}, at);
    pair.span = of_themselves;
    if (of_themselves > 0) kernel_induce(&pair, vortices, (struct range){0, vortices->n}, at);
}

static void make_vortex(struct sources *vortex, double x, double y) {
    *vortex = (struct sources){.arena = test_arena()};
    sources_append(vortex, 1);
    vortex->x[0] = x;
    vortex->y[0] = y;
    vortex->q[0] = 1;
}

// the closed sum over all images of a vortex, with X = sqrt(x^2 + e^2), S = pi X/H, Y = pi y/H: the row at y + 2kH
// induces (-sin Y, (x/X) sinh S)/(4H (cosh S - cos Y))
static void row_add(double x, double y, double square, double sign, double velocity[2]) {
    const double width = 1.5, length = sqrt(x * x + square), s = pi * length / width, t = pi * y / width;
    const double scale = sign / (4 * width * (cosh(s) - cos(t)));
    velocity[0] -= scale * sin(t);
    velocity[1] += scale * x / length * sinh(s);
}

TEST(images_of_a_vortex_in_a_channel_are_the_closed_sum) {
    // largest error of the weighted images; the velocity of the vortex at the distance H is 0.1
    static const struct { double distance, error; } cases[] = {{4.5, 1e-11}, {9, 1e-10}, {30, 1e-6}};
    const double square = 0.0004, from[2] = {0.1, 0.8};
    struct sources vortex;
    make_vortex(&vortex, from[0], from[1]);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        for (int k = -20; k <= 20; k++) {
            const double x = from[0] + cases[i].distance * k / 20, y = 0.35 + 0.74 * sin(5 * k);
            double u, v, want[2] = {0, 0};
            const struct targets at = {.n = 1, .x = &x, .y = &y, .u = &u, .v = &v};
            induce(&channel, &vortex, square, 1, &at);
            row_add(x - from[0], y - from[1], square, 1, want);
            row_add(x - from[0], y - (2 * channel.y[0] - from[1]), square, -1, want);
            NEAR(u, want[0], cases[i].error, 1e-12);
            NEAR(v, want[1], cases[i].error, 1e-12);
        }
    }
}

TEST(distances_are_those_from_the_nearest_wall) {
    const struct walls none = {0};
    assert_true(isinf(fish_walls_distance(&none, 3)));
    NEAR(fish_walls_distance(&below, 0.1), 0.5, 1e-15, 0);
    NEAR(fish_walls_distance(&above, 0.1), 1, 1e-15, 0);
    NEAR(fish_walls_distance(&channel, 0.1), 0.5, 1e-15, 0);
    NEAR(fish_walls_distance(&channel, 1), 0.1, 1e-15, 0);
    NEAR(fish_walls_distance(&channel, 1.2), -0.1, 1e-15, 0);
}

// the speed of a lone vortex with a very small core
static double speed_of_one(const struct walls *walls, double y) {
    struct sources vortex;
    double u, v;
    make_vortex(&vortex, 0, y);
    induce(walls, &vortex, 1e-14, 0, &(struct targets){.n = 1, .x = vortex.x, .y = vortex.y, .u = &u, .v = &v});
    NEAR(v, 0, 1e-15, 0);
    return u;
}

TEST(a_vortex_goes_along_the_wall_at_the_classical_speed) {
    // Lamb, Hydrodynamics, 155: G/(4 pi d) beside a wall; between two walls G/(4H) cot(pi d/H)
    for (double d = 0.05; d < 1.5; d += 0.1) {
        NEAR(speed_of_one(&below, below.y[0] + d), 1 / (4 * pi * d), 0, 1e-11);
        NEAR(speed_of_one(&above, above.y[0] - d), -1 / (4 * pi * d), 0, 1e-11);
        NEAR(speed_of_one(&channel, channel.y[0] + d), 1 / (4 * 1.5 * tan(pi * d / 1.5)), 1e-12, 1e-10);
    }
}

TEST(a_pair_that_meets_a_wall_parts_along_it) {
    // Lamb, 155: the path of each vortex is 1/x^2 + 1/d^2 = constant, d from the wall
    struct sources pair = {.arena = test_arena()};
    sources_append(&pair, 2);
    for (int i = 0; i < 2; i++) {
        pair.x[i] = i == 0 ? 0.1 : -0.1;
        pair.y[i] = 0.6 + below.y[0];
        pair.q[i] = i == 0 ? 1 : -1;
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
            induce(&below, &pair, 1e-12, 1, &(struct targets){.n = 2, .x = pair.x, .y = pair.y, .u = u, .v = v});
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
    ABOVE(pair.x[0], 0.3);
    BELOW(pair.x[1], -0.3);
}
