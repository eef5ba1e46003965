/* test_kernel.c: the vector loops against plain loops, and against each other. */
#include <string.h>

#include "school.h"
#include "vortex/kernel.h"

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

static void velocity_is_that_of_a_plain_loop(void **state) {
    (void)state;
    const double smoothings[] = {0, 0.05, 0.2};
    for (int s = 0; s < 3; s++) {
        double u[N_TARGETS] = {0}, v[N_TARGETS] = {0};
        velocity(N_TARGETS, 0, smoothings[s], u, v);
        for (int i = 0; i < N_TARGETS; i++) {
            double want_u, want_v;
            plain_velocity(cloud.x[i], cloud.y[i], smoothings[s], &want_u, &want_v);
            // rounding of sums of 53 terms, the largest 20 at the nearest source
            NEAR(u[i], want_u, 2e-14, 1e-14);
            NEAR(v[i], want_v, 2e-14, 1e-14);
        }
    }
}

static int is_fused(const struct kernel_variant *variant) {
    return strcmp(variant->name, "baseline") != 0;
}

// a b + c as the fastest variant rounds it
static double product(double a, double b, double c) {
    return is_fused(kernel_variant(0)) ? fma(a, b, c) : a * b + c;
}

// the rounding of kernel.h, step by step
static void promised_velocity(int n, double smoothing, double *u, double *v) {
    const double square = smoothing * smoothing + 1e-150, inverse_two_pi = 0.159154943091895335769;
    for (int i = 0; i < n; i++) {
        // in the last block a target has a partner only if the block has more than 8 targets; the last target pads the
        // block
        const int first = i - i % 16, in_block = i - first;
        const int alone = n - first <= 8;
        int partner = first + (in_block + 8) % 16;
        if (partner >= n) partner = n - 1;
        double su = 0, sv = 0;
        for (int j = 0; j < N_SOURCES; j++) {
            const double rx = cloud.x[i] - cloud.source_x[j], ry = cloud.y[i] - cloud.source_y[j];
            const double sx = cloud.x[partner] - cloud.source_x[j], sy = cloud.y[partner] - cloud.source_y[j];
            const double d = product(rx, rx, product(ry, ry, square)), e = product(sx, sx, product(sy, sy, square));
            const double g = alone ? cloud.circulation[j] / d : cloud.circulation[j] / (d * e) * e;
            su = product(g, ry, su);
            sv = product(g, rx, sv);
        }
        u[i] = 0 - inverse_two_pi * su;
        v[i] = 0 + inverse_two_pi * sv;
    }
}

static void velocity_has_the_promised_bits_for_any_number_of_targets(void **state) {
    (void)state;
    for (int n = 0; n <= N_TARGETS; n++) {
        double u[N_TARGETS] = {0}, v[N_TARGETS] = {0}, want_u[N_TARGETS] = {0}, want_v[N_TARGETS] = {0};
        velocity(n, 0, 0.1, u, v);
        promised_velocity(n, 0.1, want_u, want_v);
        NEAR_ARRAY(N_TARGETS, u, want_u, 0, 0);
        NEAR_ARRAY(N_TARGETS, v, want_v, 0, 0);
    }
}

static void whole_blocks_do_not_depend_on_other_targets(void **state) {
    (void)state;
    double u[N_TARGETS] = {0}, v[N_TARGETS] = {0};
    velocity(N_TARGETS, 0, 0.1, u, v);
    for (int split = 0; split <= N_TARGETS; split += 16) {
        double a[N_TARGETS] = {0}, b[N_TARGETS] = {0};
        velocity(split, 0, 0.1, a, b);
        velocity(N_TARGETS - split, split, 0.1, a + split, b + split);
        assert_memory_equal(a, u, sizeof u);
        assert_memory_equal(b, v, sizeof v);
    }
}

// numbers of all magnitudes: about half of the sums need rounding, and some fused products are hard cases
static double any_size(struct setup *random, int largest) {
    const int exponent = (int)(largest * school_random(random));
    const double value = ldexp(school_random(random), exponent);
    return school_random(random) > 0.8 ? ldexp(1, exponent) : value;
}

static void all_variants_with_fused_products_give_the_same_bits(void **state) {
    (void)state;
    enum { N = 48 };
    struct setup random = {.seed = 11};
    static double x[N], y[N], source_x[N], source_y[N], circulation[N], square[N];
    for (int trial = 0; trial < 240; trial++) {
        // from similar magnitudes to magnitudes so different that most sums keep one of the two numbers
        const int largest = 1 + trial % 60;
        for (int i = 0; i < N; i++) {
            x[i] = any_size(&random, largest);
            y[i] = any_size(&random, largest);
            source_x[i] = any_size(&random, largest);
            source_y[i] = any_size(&random, largest);
            circulation[i] = any_size(&random, 20);
            square[i] = i % 5 ? fabs(any_size(&random, 3)) : 0;
        }
        // some sources lie on targets
        for (int i = 0; i < N; i += 7) {
            source_x[i] = x[i];
            source_y[i] = y[i];
        }
        const struct kernel_sources sources = {N, source_x, source_y, circulation, trial % 3 ? 0.01 : 1e-150};
        const struct kernel_variant *variant;
        const struct kernel_changes changes = {N, source_x, source_y, circulation, trial % 2 ? 0.04 : 1e-8, square};
        double want[16][N];
        int n_variants = 0;
        for (int k = 0; (variant = kernel_variant(k)); k++) {
            double got[16][N] = {{0}};
            variant->velocity(40, x, y, &sources, got[0], got[1]);
            variant->gradient(40, x, y, &sources, got[2], got[3], got[4], got[5], got[6]);
            // the upper halves of 7 and 8 belong to the second tile
            const struct kernel_tile a = {32, x, y, circulation, got[7], got[8]};
            const struct kernel_tile b = {16, source_x, source_y, circulation + 32, got[7] + 32, got[8] + 32};
            variant->pairwise(&a, &b, sources.square);
            variant->velocity_change(40, x, y, &changes, got[9], got[10]);
            variant->gradient_change(40, x, y, &changes, got[11], got[12], got[13], got[14], got[15]);
            if (k == 0) memcpy(want, got, sizeof want);
            if (k == 0 || is_fused(variant)) assert_memory_equal(got, want, sizeof want);
            n_variants++;
        }
        assert_true(n_variants >= 1);
    }
}

static void the_baseline_differs_by_rounding(void **state) {
    (void)state;
    enum { N = 32 };
    double squares[N_SOURCES];
    for (int j = 0; j < N_SOURCES; j++) squares[j] = 0.02 + 0.001 * j;
    const double *const g = cloud.circulation;
    const struct kernel_sources sources = {N_SOURCES, cloud.source_x, cloud.source_y, g, 0.01};
    const struct kernel_changes changes = {N_SOURCES, cloud.source_x, cloud.source_y, g, 0.01, squares};
    double got[2][14][N] = {{{0}}};
    const struct kernel_variant *variant;
    for (int k = 0; (variant = kernel_variant(k)); k++) {
        double(*const to)[N] = got[k > 0];
        memset(to, 0, sizeof got[0]);
        variant->velocity(N, cloud.x, cloud.y, &sources, to[0], to[1]);
        variant->gradient(N, cloud.x, cloud.y, &sources, to[2], to[3], to[4], to[5], to[6]);
        variant->velocity_change(N, cloud.x, cloud.y, &changes, to[7], to[8]);
        variant->gradient_change(N, cloud.x, cloud.y, &changes, to[9], to[10], to[11], to[12], to[13]);
        // sums of 53 terms, a velocity at most 1/(2 pi 2 0.1) = 0.8 each, a gradient 1/(2 pi 0.01) = 16
        if (k == 0) continue;
        for (int i = 0; i < 14; i++) NEAR_ARRAY(N, got[1][i], got[0][i], 53 * 16 * 2.3e-16, 0);
    }
}

static void every_processor_has_a_variant(void **state) {
    (void)state;
    int n = 0;
    while (kernel_variant(n)) n++;
    assert_string_equal(kernel_variant(n - 1)->name, "baseline");
    assert_null(kernel_variant(n + 1));
}

// the sums of a change, with the new smoothings minus with the old smoothing, for any number of targets
static void a_change_of_smoothing_is_the_difference_of_two_sums(void **state) {
    (void)state;
    const double from = 0.01;
    double to[N_SOURCES], all_from[N_SOURCES], minus[N_SOURCES];
    for (int j = 0; j < N_SOURCES; j++) {
        to[j] = j % 4 ? from * j / N_SOURCES : 0;
        all_from[j] = from;
        minus[j] = -cloud.circulation[j];
    }
    const struct kernel_changes changes = {N_SOURCES, cloud.source_x, cloud.source_y, cloud.circulation, from, to};
    for (int n = 0; n <= N_TARGETS; n++) {
        double got[7][N_TARGETS] = {{0}}, want[5][N_TARGETS] = {{0}};
        kernel_add_velocity_change(n, cloud.x, cloud.y, &changes, got[0], got[1]);
        kernel_add_gradient_change(n, cloud.x, cloud.y, &changes, got[2], got[3], got[4], got[5], got[6]);
        kernel_add_gradient_each(n, cloud.x, cloud.y, N_SOURCES, cloud.source_x, cloud.source_y, cloud.circulation, to,
                                 want[0], want[1], want[2], want[3], want[4]);
        kernel_add_gradient_each(n, cloud.x, cloud.y, N_SOURCES, cloud.source_x, cloud.source_y, minus, all_from,
                                 want[0], want[1], want[2], want[3], want[4]);
        for (int k = 0; k < 2; k++) {
            NEAR_ARRAY(N_TARGETS, got[k], want[k], 1e-13, 1e-12);
            NEAR_ARRAY(N_TARGETS, got[2 + k], want[k], 1e-13, 1e-12);
        }
        for (int k = 2; k < 5; k++) NEAR_ARRAY(N_TARGETS, got[2 + k], want[k], 1e-10, 1e-11);
    }
}

// the same for a smoothing that depends on the target
static void a_change_at_every_target_is_the_difference_of_two_sums(void **state) {
    (void)state;
    const double from = 0.1;
    double square[N_TARGETS], minus[N_SOURCES];
    for (int i = 0; i < N_TARGETS; i++) square[i] = from * from * (i % 5) / 4;
    for (int j = 0; j < N_SOURCES; j++) minus[j] = -cloud.circulation[j];
    for (int n = 0; n <= N_TARGETS; n++) {
        double got[2][N_TARGETS] = {{0}}, want[2][N_TARGETS] = {{0}};
        kernel_add_velocity_change_at(n, cloud.x, cloud.y, square, N_SOURCES, cloud.source_x, cloud.source_y,
                                      cloud.circulation, from * from, got[0], got[1]);
        for (int i = 0; i < n; i++) {
            kernel_add_velocity(1, cloud.x + i, cloud.y + i, N_SOURCES, cloud.source_x, cloud.source_y,
                                cloud.circulation, sqrt(square[i]), want[0] + i, want[1] + i);
            kernel_add_velocity(1, cloud.x + i, cloud.y + i, N_SOURCES, cloud.source_x, cloud.source_y, minus, from,
                                want[0] + i, want[1] + i);
        }
        for (int k = 0; k < 2; k++) NEAR_ARRAY(N_TARGETS, got[k], want[k], 1e-13, 1e-12);
    }
    // the full smoothing changes nothing
    for (int i = 0; i < N_TARGETS; i++) square[i] = from * from;
    double none[2][N_TARGETS] = {{0}};
    kernel_add_velocity_change_at(N_TARGETS, cloud.x, cloud.y, square, N_SOURCES, cloud.source_x, cloud.source_y,
                                  cloud.circulation, from * from, none[0], none[1]);
    for (int i = 0; i < N_TARGETS; i++) {
        NEAR(none[0][i], 0, 0, 0);
        NEAR(none[1][i], 0, 0, 0);
    }
}

// for nearly equal smoothings the change keeps the digits that the difference of two sums loses
static void a_small_change_keeps_its_digits(void **state) {
    (void)state;
    const double from = 0.01, to = 0.01 * (1 - 0x1p-40), place = 0, circulation = 1;
    const double x = 0.3, y = 0.4, square = x * x + y * y;
    const struct kernel_changes changes = {1, &place, &place, &circulation, from, &to};
    double u = 0, v = 0;
    kernel_add_velocity_change(1, &x, &y, &changes, &u, &v);
    const double strength = (from - to) / ((square + from) * (square + to)) / (2 * 3.14159265358979323846);
    NEAR(u, -strength * y, 0, 1e-14);
    NEAR(v, strength * x, 0, 1e-14);
}

static void two_tiles_induce_velocities_at_each_other(void **state) {
    (void)state;
    enum { N_A = 16, N_B = 32 };
    double u[N_A] = {0}, v[N_A] = {0}, back_u[N_B] = {0}, back_v[N_B] = {0};
    double want_u[N_A] = {0}, want_v[N_A] = {0}, want_back_u[N_B] = {0}, want_back_v[N_B] = {0};
    const double *const g = cloud.circulation;
    const struct kernel_tile a = {N_A, cloud.x, cloud.y, g, u, v};
    const struct kernel_tile b = {N_B, cloud.source_x, cloud.source_y, g + N_A, back_u, back_v};
    for (int k = 0; k < 2; k++) kernel_add_pairwise(&a, &b, 0.1);
    kernel_add_velocity(N_A, a.x, a.y, N_B, b.x, b.y, b.circulation, 0.1, want_u, want_v);
    kernel_add_velocity(N_B, b.x, b.y, N_A, a.x, a.y, a.circulation, 0.1, want_back_u, want_back_v);
    for (int i = 0; i < N_A; i++) {
        // added twice; rounding of sums of 32 terms, of at most 5 each
        NEAR(u[i], 2 * want_u[i], 1e-14, 1e-14);
        NEAR(v[i], 2 * want_v[i], 1e-14, 1e-14);
    }
    for (int j = 0; j < N_B; j++) {
        NEAR(back_u[j], 2 * want_back_u[j], 1e-14, 1e-14);
        NEAR(back_v[j], 2 * want_back_v[j], 1e-14, 1e-14);
    }
}

static void a_tile_may_be_as_large_as_promised(void **state) {
    (void)state;
    static double x[2 * KERNEL_TILE], y[2 * KERNEL_TILE], g[2 * KERNEL_TILE], u[2 * KERNEL_TILE], v[2 * KERNEL_TILE];
    struct setup random = {.seed = 3};
    for (int i = 0; i < 2 * KERNEL_TILE; i++) {
        x[i] = school_random(&random);
        y[i] = school_random(&random);
        g[i] = school_random(&random);
    }
    const struct kernel_tile a = {KERNEL_TILE, x, y, g, u, v};
    const struct kernel_tile b = {KERNEL_TILE,     x + KERNEL_TILE, y + KERNEL_TILE,
                                  g + KERNEL_TILE, u + KERNEL_TILE, v + KERNEL_TILE};
    kernel_add_pairwise(&a, &b, 0.1);
    // neither tile acts on itself, so the impulse of both together is zero
    double sum_u = 0, sum_v = 0, size = 0;
    for (int i = 0; i < 2 * KERNEL_TILE; i++) {
        sum_u += g[i] * u[i];
        sum_v += g[i] * v[i];
        size += fabs(g[i] * u[i]) + fabs(g[i] * v[i]);
    }
    assert_true(size > 10);
    NEAR(sum_u, 0, 1e-15 * size, 0);
    NEAR(sum_v, 0, 1e-15 * size, 0);
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
    struct kernel_values unit;
    kernel_unit(1, &x, &y, zero, zero, 0.1, &unit);
    const double got[] = {*unit.u, *unit.v, *unit.u_x, *unit.u_y, *unit.v_x}, want[] = {u, v, u_x, u_y, v_x};
    NEAR_ARRAY(5, got, want, 0, 1e-14);
    // K_e(r) = (-r_y, r_x)/(2 pi (r^2 + e^2)) by hand
    NEAR(u, 0.2 / (2 * acos(-1) * 0.14), 0, 1e-15);
}

static void unit_sources_at_many_targets_have_the_bits_of_one_by_one(void **state) {
    (void)state;
    struct kernel_values all, one;
    kernel_unit(N_TARGETS, cloud.x, cloud.y, 0.1, 0.2, 0.05, &all);
    double sum[4][N_TARGETS] = {{0}};
    const double factor = -3;
    kernel_add_motion(N_TARGETS, 1, &factor, 1, &all, sum[0], sum[1], sum[2], sum[3]);
    for (int i = 0; i < N_TARGETS; i++) {
        kernel_unit(1, cloud.x + i, cloud.y + i, 0.1, 0.2, 0.05, &one);
        const double got[] = {all.u[i], all.v[i], all.u_x[i], all.u_y[i], all.v_x[i]};
        const double want[] = {*one.u, *one.v, *one.u_x, *one.u_y, *one.v_x};
        NEAR_ARRAY(5, got, want, 0, 0);
        // the field has no divergence: v_y = -u_x
        const double moved[] = {sum[0][i], sum[1][i], sum[2][i], sum[3][i]};
        const double by[] = {-3 * *one.u_x, -3 * *one.v_x, -3 * *one.u_y, 3 * *one.u_x};
        NEAR_ARRAY(4, moved, by, 0, 0);
    }
}

static void motion_with_several_sources_has_the_bits_of_one_after_the_other(void **state) {
    (void)state;
    enum { N_TOGETHER = 7 };
    struct setup random = {.seed = 7};
    static struct kernel_values values[N_TOGETHER];
    for (int sign = -1; sign <= 1; sign += 2) {
        double factor[N_TOGETHER], together[4][N_TARGETS] = {{0}}, alone[4][N_TARGETS] = {{0}};
        for (int j = 0; j < N_TOGETHER; j++) {
            factor[j] = school_random(&random);
            kernel_unit(N_TARGETS, cloud.x, cloud.y, 0.1 * j, 0.2, 0.05, &values[j]);
            kernel_add_motion(N_TARGETS, 1, &factor[j], sign, &values[j], alone[0], alone[1], alone[2], alone[3]);
        }
        kernel_add_motion(N_TARGETS, N_TOGETHER, factor, sign, values, together[0], together[1], together[2],
                          together[3]);
        for (int k = 0; k < 4; k++) NEAR_ARRAY(N_TARGETS, together[k], alone[k], 0, 0);
    }
}

static void product_with_a_matrix_adds_column_after_column(void **state) {
    (void)state;
    enum { ROWS = 19, MAX = 9 };
    struct setup random = {.seed = 5};
    double matrix[ROWS * MAX], vector[MAX];
    for (int i = 0; i < ROWS * MAX; i++) matrix[i] = school_random(&random);
    for (int i = 0; i < MAX; i++) vector[i] = school_random(&random);
    for (int n = 0; n <= MAX; n++) {
        double got[ROWS], want[ROWS];
        for (int r = 0; r < ROWS; r++) got[r] = want[r] = 1;
        for (int c = 0; c < n; c++) {
            for (int r = 0; r < ROWS; r++) want[r] += vector[c] * matrix[c * ROWS + r];
        }
        kernel_multiply(ROWS, n, matrix, vector, got);
        NEAR_ARRAY(ROWS, got, want, 0, 0);
    }
}

static void sources_with_a_smoothing_each_add_up_one_by_one(void **state) {
    (void)state;
    double square[N_SOURCES], got[7][N_TARGETS] = {{0}}, want[5][N_TARGETS] = {{0}};
    for (int j = 0; j < N_SOURCES; j++) {
        // one source has no smoothing; the source on a target has a smoothing
        const double smoothing = 0.01 * (j % 9);
        square[j] = smoothing * smoothing;
        kernel_add_gradient(N_TARGETS, cloud.x, cloud.y, 1, &cloud.source_x[j], &cloud.source_y[j],
                            &cloud.circulation[j], smoothing, want[0], want[1], want[2], want[3], want[4]);
    }
    kernel_add_gradient_each(N_TARGETS, cloud.x, cloud.y, N_SOURCES, cloud.source_x, cloud.source_y, cloud.circulation,
                             square, got[0], got[1], got[2], got[3], got[4]);
    kernel_add_velocity_each(N_TARGETS, cloud.x, cloud.y, N_SOURCES, cloud.source_x, cloud.source_y, cloud.circulation,
                             square, got[5], got[6]);
    for (int i = 0; i < N_TARGETS; i++) {
        // rounding of sums of 53 terms, of at most 20 in the velocity and 2000 in the gradient
        for (int k = 0; k < 5; k++) NEAR(got[k][i], want[k][i], k < 2 ? 2e-14 : 5e-12, 1e-13);
        for (int k = 0; k < 2; k++) NEAR(got[5 + k][i], want[k][i], 2e-14, 1e-13);
    }
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
        cmocka_unit_test(velocity_is_that_of_a_plain_loop),
        cmocka_unit_test(velocity_has_the_promised_bits_for_any_number_of_targets),
        cmocka_unit_test(whole_blocks_do_not_depend_on_other_targets),
        cmocka_unit_test(all_variants_with_fused_products_give_the_same_bits),
        cmocka_unit_test(the_baseline_differs_by_rounding),
        cmocka_unit_test(every_processor_has_a_variant),
        cmocka_unit_test(a_change_of_smoothing_is_the_difference_of_two_sums),
        cmocka_unit_test(a_change_at_every_target_is_the_difference_of_two_sums),
        cmocka_unit_test(a_small_change_keeps_its_digits),
        cmocka_unit_test(two_tiles_induce_velocities_at_each_other),
        cmocka_unit_test(a_tile_may_be_as_large_as_promised),
        cmocka_unit_test(velocity_is_added_to_what_is_there_and_writes_nothing_else),
        cmocka_unit_test(gradient_is_that_of_the_velocity),
        cmocka_unit_test(one_unit_source_is_what_the_loops_add),
        cmocka_unit_test(motion_with_several_sources_has_the_bits_of_one_after_the_other),
        cmocka_unit_test(product_with_a_matrix_adds_column_after_column),
        cmocka_unit_test(unit_sources_at_many_targets_have_the_bits_of_one_by_one),
        cmocka_unit_test(sources_with_a_smoothing_each_add_up_one_by_one),
        cmocka_unit_test(a_vortex_pair_translates_at_the_known_speed),
    };
    return cmocka_run_group_tests(tests, scatter, NULL);
}
