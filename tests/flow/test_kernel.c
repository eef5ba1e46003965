/* test_kernel.c: The kernels agree with their formulas and limits, their derivatives with differences, and their
 * variants for different processors with each other. */
#include <math.h>
#include <string.h>

#include "flow/flow.h"
#include "flow/images.h"
#include "flow/kernel.h"
#include "school.h"

static const double two_pi = 6.28318530717958647692;

// one source, and what it causes at a point
struct sum {
    double u, v, leg_u, leg_v, div, u_x, u_y, v_x, div_x, div_y, edge[2], edge_gradient[4];
};
static struct sum induce(const struct kernel_pair *pair, const struct source *source, double x, double y, double half,
                         double leg, double square) {
    struct sources rings = {.arena = test_arena()};
    sources_append(&rings, 1);
    rings.x[0] = source->x;
    rings.y[0] = source->y;
    rings.q[0] = source->q;
    rings.dx[0] = source->dx;
    rings.dy[0] = source->dy;
    rings.half[0] = source->half;
    rings.leg[0] = source->leg;
    rings.square[0] = source->square;
    struct sum sum = {0}, plain = {0};
    struct targets at = {.n = 1,
                         .x = &x,
                         .y = &y,
                         .half = &half,
                         .leg = &leg,
                         .square = &square,
                         .u = &plain.u,
                         .v = &plain.v,
                         .div = &plain.div};
    kernel_induce(pair, &rings, (struct range){0, 1}, &at);
    at.u = &sum.u;
    at.v = &sum.v;
    at.leg_u = &sum.leg_u;
    at.leg_v = &sum.leg_v;
    at.div = &sum.div;
    at.u_x = &sum.u_x;
    at.u_y = &sum.u_y;
    at.v_x = &sum.v_x;
    at.div_x = &sum.div_x;
    at.div_y = &sum.div_y;
    at.edge = sum.edge;
    at.edge_gradient = sum.edge_gradient;
    at.edge_stride = 1;
    kernel_induce(pair, &rings, (struct range){0, 1}, &at);
    NEAR(plain.u, sum.u, 0, 1e-14);
    NEAR(plain.v, sum.v, 0, 1e-14);
    NEAR(plain.div, sum.div, 0, 1e-14);
    return sum;
}

static const struct source source = {
    .x = 0.3, .y = -0.2, .q = 1, .dx = 0.02, .dy = 0.03, .half = 0.0625 * 0.0625 / 2, .leg = 0.001, .square = 0.0015};
static const struct kernel_pair own = {.kernel = &kernel_finite, .span = 0.0625, .factor = 1, .square = 0.0005};

// numbers of an independent program (NumPy)
TEST(velocity_and_divergence_are_those_of_the_formulas) {
    const struct sum sum = induce(&own, &source, 0.4, -0.15, 0.0625 * 0.0625 / 2, 0.002, 0.0005);
    NEAR(sum.u, -0.34840178, 5e-9, 0);
    NEAR(sum.v, 0.54962393, 5e-9, 0);
    NEAR(sum.div, 1.13762033, 5e-9, 0);
    // a = h/2 d and div = h r.(E3 d)
    const double h = sum.div / (0.05 * 0.02 - 0.1 * 0.03);
    NEAR(sum.edge[0], h / 2 * 0.02, 0, 1e-13);
    NEAR(sum.edge[1], h / 2 * 0.03, 0, 1e-13);
}

TEST(the_root_has_full_precision_at_any_distance) {
    // induce compares the root that begins in single precision with a root in double precision
    for (int i = 0; i < 3000; i++) {
        const double r = pow(10, -15 + 0.01 * i);
        const struct source at_once[] = {{.q = 1, .dx = 0.02 * r, .dy = 0.03 * r, .half = r * r},
                                         {.q = 1, .half = r * r},
                                         {.dx = 0.02 * r, .dy = 0.03 * r, .half = r * r}};
        const struct kernel_pair pair = {.kernel = &kernel_finite, .span = r, .factor = 1};
        double u[3], v[3];
        for (int k = 0; k < 3; k++) {
            const struct sum sum = induce(&pair, &at_once[k], 0.6 * r, 0.8 * r, 0, 0, 0);
            u[k] = sum.u;
            v[k] = sum.v;
        }
        // vortex and leg apart
        NEAR(u[1] + u[2], u[0], 0, 1e-14);
        NEAR(v[1] + v[2], v[0], 0, 1e-14);
        NEAR(v[1], 0.6 / (two_pi * sqrt(2) * r), 0, 1e-14);
        NEAR(v[2], 0.02 / (two_pi * pow(2, 1.5) * r), 0, 1e-14);
    }
}

// K_e(r) = (-r_y, r_x)/(2 pi (r^2 + e^2)), with the squares of source, target and pair
TEST(infinite_span_is_a_smoothed_vortex) {
    const struct kernel_pair pair = kernel_infinite.other(7, 0.0005);
    const struct sum sum = induce(&pair, &source, 0.4, -0.15, 3, 4, 0.0007);
    const double r[2] = {0.1, 0.05}, e2 = 0.0005 + 0.0007 + 0.0015, d = r[0] * r[0] + r[1] * r[1] + e2;
    NEAR(sum.u, -r[1] / (two_pi * d), 0, 1e-14);
    NEAR(sum.v, r[0] / (two_pi * d), 0, 1e-14);
    NEAR(sum.u_x, 2 * r[0] * r[1] / (two_pi * d * d), 0, 1e-13);
    NEAR(sum.u_y, (2 * r[1] * r[1] - d) / (two_pi * d * d), 0, 1e-13);
    NEAR(sum.v_x, (d - 2 * r[0] * r[0]) / (two_pi * d * d), 0, 1e-13);
    NEAR(fabs(sum.div) + fabs(sum.leg_u) + fabs(sum.edge[0]), 0, 0, 0);
}

TEST(a_deep_strip_is_that_of_two_dimensions) {
    const double b = 1e5;
    const struct kernel_pair pair = {.kernel = &kernel_finite, .span = b, .factor = 1};
    struct source deep = source;
    deep.half = b * b / 2;
    deep.leg = deep.square = 0;
    const struct sum sum = induce(&pair, &deep, 0.4, -0.15, b * b / 2, 0, 0);
    const double r2 = 0.1 * 0.1 + 0.05 * 0.05;
    // short by r^2/(2 b^2)
    NEAR(sum.u, -0.05 / (two_pi * r2), 0, 1e-11);
    NEAR(sum.v, 0.1 / (two_pi * r2), 0, 1e-11);
    NEAR(sum.div, 0, 1e-15, 0);
}

// seen from outside, from afar, a ring is a dipole whose moment is its circulation, depth and length
TEST(far_away_a_closed_ring_is_a_dipole_of_its_area) {
    const double w = 0.25, length = 0.01, far = 30;
    const struct kernel_pair outside = {.kernel = &kernel_finite, .span = w / 2, .factor = 4};
    // spanwise parts 1 and -1 at both ends of a leg along x, w deep
    struct source part[3] = {{.x = 0, .q = 1}, {.x = length, .q = -1}, {.x = length / 2, .dx = length}};
    double u = 0, v = 0;
    for (int i = 0; i < 3; i++) {
        part[i].half = w * w / 32;
        const struct sum sum = induce(&outside, &part[i], 0.6 * far, 0.8 * far, w * w / 32, 0, 0);
        u += sum.u;
        v += sum.v;
    }
    // in the middle plane (z = 0) the field of a dipole normal to the wall that the ring spans: m along y
    const double m = w * length, n[2] = {0.6, 0.8}, r3 = far * far * far;
    NEAR(u, m / (2 * two_pi * r3) * 3 * n[1] * n[0], 1e-3 * m / (2 * two_pi * r3), 0);
    NEAR(v, m / (2 * two_pi * r3) * (3 * n[1] * n[1] - 1), 1e-3 * m / (2 * two_pi * r3), 0);
}

TEST(gradients_agree_with_differences) {
    const double half = 0.003, leg = 0.002, square = 0.0004, step = 1e-6, x = 0.37, y = -0.11;
    for (int k = 0; k < 2; k++) {
        const struct kernel_pair pair = k == 0 ? own : kernel_infinite.own(0, 0.0005);
        const bool has_legs = pair.kernel->has_legs;
        const struct sum at = induce(&pair, &source, x, y, half, leg, square);
        static struct unit_values unit;
        struct source with_target = source;
        with_target.leg += leg;
        with_target.square += square;
        kernel_unit(&pair, &with_target, 1, &x, &y, &half, &unit);
        for (int i = 0; i < 2; i++) {
            const double dx = i == 0 ? step : 0, dy = i == 1 ? step : 0;
            const struct sum more = induce(&pair, &source, x + dx, y + dy, half, leg, square);
            const struct sum less = induce(&pair, &source, x - dx, y - dy, half, leg, square);
            const double by[] = {(more.u - less.u) / (2 * step), (more.v - less.v) / (2 * step),
                                 (more.div - less.div) / (2 * step)};
            const double got[2][3] = {{at.u_x, at.v_x, at.div_x}, {at.u_y, at.div - at.u_x, at.div_y}};
            const double of_unit[2][3] = {{*unit.u_x, *unit.v_x, *unit.div_x}, {*unit.u_y, *unit.v_y, *unit.div_y}};
            for (int m = 0; m < 3; m++) {
                NEAR(got[i][m], by[m], 1e-7, 1e-7);
                if (m < 2 || has_legs) NEAR(of_unit[i][m], by[m], 1e-7, 1e-7);
            }
            for (int m = 0; m < 2; m++) {
                NEAR(at.edge_gradient[2 * m + i], (more.edge[m] - less.edge[m]) / (2 * step), 1e-7, 1e-7);
            }
            if (has_legs) NEAR((i == 0 ? *unit.edge_x : *unit.edge_y) * source.dx, at.edge_gradient[i], 0, 1e-12);
        }

        // linear in circulation and legs
        NEAR(*unit.unit_u * source.q + at.leg_u, at.u, 0, 1e-13);
        NEAR(*unit.unit_v * source.q + at.leg_v, at.v, 0, 1e-13);
        if (!has_legs) continue;
        NEAR(-*unit.leg * source.dy, at.leg_u, 0, 1e-13);
        NEAR(*unit.leg * source.dx, at.leg_v, 0, 1e-13);
        NEAR(*unit.div_by_dx * source.dx + *unit.div_by_dy * source.dy, at.div, 0, 1e-12);
        NEAR(*unit.edge * source.dy, at.edge[1], 0, 1e-13);
    }
}

TEST(a_source_has_no_spanwise_part_at_its_own_place) {
    struct source at_target = source;
    at_target.square = 0;
    const struct kernel_pair exact = {.kernel = &kernel_finite, .span = 0.0625, .factor = 1};
    const struct sum sum = induce(&exact, &at_target, source.x, source.y, 0.002, 0, 0);
    NEAR(sum.u, sum.leg_u, 0, 0);
    NEAR(sum.v, sum.leg_v, 0, 0);
    NEAR(sum.div, 0, 0, 0);
}

// the wall is half way between a source and its image, and no fluid goes through
TEST(a_ring_and_its_image_cause_no_flow_through_the_wall) {
    struct sources rings = {.arena = test_arena()}, image = {.arena = test_arena()};
    sources_append(&rings, 1);
    rings.x[0] = 0.1;
    rings.y[0] = 0.4;
    rings.q[0] = 0.7;
    rings.dx[0] = 0.2;
    rings.dy[0] = -0.3;
    rings.half[0] = 0.002;
    images_write(&rings, 1, &(struct image){-1, -0.5, 1}, &image);
    enum { N = 20 };
    double x[N], y[N], u[N] = {0}, v[N] = {0};
    for (int i = 0; i < N; i++) {
        x[i] = -1 + 0.1 * i;
        y[i] = -0.25;
    }
    const struct targets at = {.n = N, .x = x, .y = y, .u = u, .v = v};
    kernel_induce(&own, &rings, (struct range){0, 1}, &at);
    kernel_induce(&own, &image, (struct range){0, 1}, &at);
    for (int i = 0; i < N; i++) NEAR(v[i], 0, 1e-17, 0);
}

// the value number i of a sequence without a pattern, from -1 to 1
static double number(int i) {
    return 2 * fmod(0.618033988749895 * (i + 1) * (i + 7), 1) - 1;
}

TEST(fused_variants_round_identically) {
    enum { N = 37 };
    double value[8][N];
    for (int i = 0; i < 8 * N; i++) value[i / N][i % N] = number(i);
    for (int i = 0; i < N; i++) {
        for (int k = 5; k < 8; k++) value[k][i] *= value[k][i];
    }
    const struct block_sources from = {.n = N,
                                       .x = value[0],
                                       .y = value[1],
                                       .q = value[2],
                                       .dx = value[3],
                                       .dy = value[4],
                                       .half = value[5],
                                       .leg = value[6],
                                       .square = value[7],
                                       .span = 0.3,
                                       .factor = 4,
                                       .add = 1e-4};
    struct kernel_block first;
    memset(&first, 0, sizeof first);
    first.n = KERNEL_BLOCK;
    first.has_squares = 1;
    for (int i = 0; i < KERNEL_BLOCK; i++) {
        first.x[i] = number(1000 + i);
        first.y[i] = number(2000 + i);
        first.half[i] = first.square[i] = 0.01 + 0.001 * i;
    }
    const struct kernel_block targets = first;
    struct block_mates mates;
    for (int i = 0; i < KERNEL_BLOCK; i++) {
        mates.q[i] = number(3000 + i);
        mates.dx[i] = number(4000 + i);
        mates.dy[i] = number(5000 + i);
    }

    const struct kernel *const kernels[] = {&kernel_finite, &kernel_infinite};
    for (int m = 0; m < 2; m++) {
        const struct kernel *const kernel = kernels[m];
        // mutual sums: at the block, then one number per lane at the sources
        struct block_lanes sums[N];
        struct kernel_block mutual = targets;
        memset(sums, 0, sizeof sums);
        first = targets;
        kernel->loops(0)->velocity(&first, &from);
        if (kernel->loops(0)->mutual) kernel->loops(0)->mutual(&mutual, &mates, &from, sums);
        if (kernel->loops(0)->mutual) NEAR_ARRAY(KERNEL_BLOCK, mutual.u, first.u, 1e-12, 1e-12);
        for (int k = 1; kernel->loops(k); k++) {
            struct kernel_block other = targets;
            struct block_lanes others[N];
            memset(others, 0, sizeof others);
            // the last variant is the baseline, without fused products
            const double rounding = kernel->loops(k + 1) ? 0 : 1e-12;
            kernel->loops(k)->velocity(&other, &from);
            NEAR_ARRAY(KERNEL_BLOCK, other.u, first.u, rounding, rounding);
            NEAR_ARRAY(KERNEL_BLOCK, other.v, first.v, rounding, rounding);
            NEAR_ARRAY(KERNEL_BLOCK, other.leg_u, first.leg_u, rounding, rounding);
            NEAR_ARRAY(KERNEL_BLOCK, other.leg_v, first.leg_v, rounding, rounding);
            NEAR_ARRAY(KERNEL_BLOCK, other.div, first.div, 100 * rounding, rounding);
            struct kernel_block slopes[2] = {targets, targets};
            for (int i = 0; i < 2; i++) kernel->loops(i == 0 ? 0 : k)->gradient(&slopes[i], &from);
            NEAR_ARRAY(KERNEL_BLOCK, slopes[0].u, first.u, 1e-12, 1e-12);
            NEAR_ARRAY(KERNEL_BLOCK, slopes[1].u_y, slopes[0].u_y, 100 * rounding, rounding);
            NEAR_ARRAY(KERNEL_BLOCK, slopes[1].v_x, slopes[0].v_x, 100 * rounding, rounding);
            NEAR_ARRAY(KERNEL_BLOCK, slopes[1].div_x, slopes[0].div_x, 1e4 * rounding, rounding);
            if (!kernel->loops(k)->mutual) continue;
            kernel->loops(k)->mutual(&other, &mates, &from, others);
            NEAR_ARRAY(KERNEL_BLOCK, other.u, mutual.u, rounding, rounding);
            NEAR_ARRAY(KERNEL_BLOCK, other.leg_v, mutual.leg_v, rounding, rounding);
            for (int n = 0; n < N; n++) {
                NEAR_ARRAY(KERNEL_BLOCK / 2, others[n].u, sums[n].u, rounding, rounding);
                NEAR_ARRAY(KERNEL_BLOCK / 2, others[n].leg_u, sums[n].leg_u, rounding, rounding);
                NEAR_ARRAY(KERNEL_BLOCK / 2, others[n].div, sums[n].div, 100 * rounding, rounding);
            }
        }
    }
}

TEST(sources_cause_the_same_velocity_one_by_one_and_mutually) {
    // several tiles, and a last tile and block that are not full
    enum { N = 137 };
    struct sources rings = {.arena = test_arena()};
    sources_append(&rings, N);
    double *const values[] = {rings.x, rings.y, rings.q, rings.dx, rings.dy, rings.half, rings.leg};
    for (int k = 0; k < 7; k++) {
        for (int i = 0; i < N; i++) values[k][i] = k < 5 ? number(k * N + i) : 0.01 + 0.01 * fabs(number(k * N + i));
    }
    // a set at itself, and its two parts at each other
    const struct range part[2] = {{0, 61}, {61, N - 61}};
    struct sources parts[2] = {rings, rings};
    for (int i = 0; i < 2; i++) {
        double **const arrays[] = {&parts[i].x,  &parts[i].y,    &parts[i].q,   &parts[i].dx,
                                   &parts[i].dy, &parts[i].half, &parts[i].leg, &parts[i].square};
        for (int k = 0; k < 8; k++) *arrays[k] += part[i].first;
        parts[i].n = part[i].n;
    }
    for (int m = 0; m < 4; m++) {
        const struct kernel_pair pair = m % 2 == 0 ? kernel_finite.own(1.2, 1e-4) : kernel_infinite.own(0, 1e-4);
        double one[5][N] = {{0}}, mutual[5][N] = {{0}};
        struct targets at = {.n = N, .x = rings.x, .y = rings.y, .half = rings.half, .leg = rings.leg}, at_part[2];
        at.u = one[0], at.v = one[1], at.leg_u = one[2], at.leg_v = one[3], at.div = one[4];
        for (int i = 0; i < 2; i++) at_part[i] = kernel_targets_part(&at, part[i]);
        if (m < 2) kernel_induce(&pair, &rings, (struct range){0, N}, &at);
        for (int i = 0; i < 2 && m >= 2; i++) kernel_induce(&pair, &rings, part[1 - i], &at_part[i]);
        at.u = mutual[0], at.v = mutual[1], at.leg_u = mutual[2], at.leg_v = mutual[3], at.div = mutual[4];
        for (int i = 0; i < 2; i++) at_part[i] = kernel_targets_part(&at, part[i]);
        if (m < 2) kernel_induce_mutual(&pair, &rings, &at, &rings, &at);
        if (m >= 2) kernel_induce_mutual(&pair, &parts[0], &at_part[0], &parts[1], &at_part[1]);
        for (int k = 0; k < (m % 2 == 0 ? 5 : 2); k++) {
            double most = 0;
            for (int i = 0; i < N; i++) most = fmax(most, fabs(one[k][i]));
            NEAR_ARRAY(N, mutual[k], one[k], 1e-13 * most, 0);
            ABOVE(most, 0.1);
        }
    }
}
