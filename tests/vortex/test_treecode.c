/* test_treecode.c: the tree against direct sums, on wakes and on difficult distributions. */
#include <stdlib.h>
#include <string.h>

#include "failing_malloc.h"
#include "near.h"
#include "vortex/kernel.h"
#include "vortex/treecode.h"

enum { MAX = 6400 };

static double x[MAX], y[MAX], circulation[MAX];

// ---- distributions of vortices ----

static uint64_t seed;

// in [0, 1)
static double random_number(void) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(seed >> 11) * 0x1p-53;
}

static void put(int i, double at_x, double at_y, double gamma) {
    x[i] = at_x;
    y[i] = at_y;
    circulation[i] = gamma;
}

static void square(int i) {
    const double at_x = 30 * random_number();
    put(i, at_x, 30 * random_number(), random_number() - 0.5);
}

// wakes of 100 vortices, 2 lengths long, of fish 1.5 lengths apart
static void strips(int i) {
    const int fish = i / 100;
    const double along = 0.02 * (i % 100);
    const double phase = 9.4 * along + fish;
    put(i, 1.5 * (fish % 8) + along, 1.5 * (fish / 8) + 0.1 * sin(phase), cos(phase) + 0.2 * random_number());
}

// distances from 1 down to 1e-9, all of one sign
static void cluster(int i) {
    const double r = exp(-20 * random_number()), angle = 6.3 * random_number();
    put(i, r * cos(angle), r * sin(angle), 1);
}

static void line(int i) {
    put(i, 30 * random_number(), 7, 1);
}

// Heaps of 32: the points of a box lie at the ends of the box, the worst case for expansions.
static void heaps(int i) {
    const double at_x = i / 32 % 12 + 1e-3 * random_number();
    put(i, at_x, i / 384 + 1e-3 * random_number(), 1);
}

static void far_away(int i) {
    square(i);
    x[i] += 1e6;
    y[i] -= 3e7;
}

static void one_place(int i) {
    put(i, 0.3, -0.1, 1 + i % 3);
}

static void fill(int n, void (*place)(int i)) {
    seed = 1;
    for (int i = 0; i < n; i++) place(i);
}

static struct treecode *build(int n, double smoothing, double tolerance) {
    struct treecode *tree;
    assert_int_equal(treecode_create(&tree), STATUS_OK);
    assert_int_equal(treecode_build(tree, n, x, y, circulation, smoothing, tolerance, 1), STATUS_OK);
    return tree;
}

// ---- errors ----

struct errors {
    double velocity, gradient; /* largest errors, in units of A and of the same sum for the gradient */
};

// not fmax, which ignores NaN
static void keep_worse(double *worst, double error) {
    if (!(error <= *worst)) *worst = error;
}

// the errors of two velocities and a gradient at every seventh target
static struct errors compare(int n, double smoothing, int n_targets, const double *at_x, const double *at_y,
                             const double *u, const double *v, double got[5][MAX]) {
    double want[5];
    struct errors worst = {0};
    for (int i = 0; i < n_targets; i += 7) {
        memset(want, 0, sizeof want);
        kernel_add_gradient(1, &at_x[i], &at_y[i], n, x, y, circulation, smoothing, &want[0], &want[1], &want[2],
                            &want[3], &want[4]);
        double a = 0, b = 0;
        for (int j = 0; j < n; j++) {
            const double rx = at_x[i] - x[j], ry = at_y[i] - y[j];
            const double distance = rx * rx + ry * ry + smoothing * smoothing;
            if (distance == 0) continue;
            a += fabs(circulation[j]) / (2 * M_PI * sqrt(distance));
            b += fabs(circulation[j]) / (2 * M_PI * distance);
        }
        keep_worse(&worst.velocity, hypot(u[i] - want[0], v[i] - want[1]) / a);
        keep_worse(&worst.velocity, hypot(got[0][i] - want[0], got[1][i] - want[1]) / a);
        for (int k = 2; k < 5; k++) keep_worse(&worst.gradient, fabs(got[k][i] - want[k]) / b);
    }
    return worst;
}

static struct errors errors(int n, double smoothing, double tolerance, int n_targets, const double *at_x,
                            const double *at_y) {
    static double got[5][MAX];
    memset(got, 0, sizeof got);
    struct treecode *const tree = build(n, smoothing, tolerance);
    double u[MAX] = {0}, v[MAX] = {0};
    assert_int_equal(treecode_add_velocity(tree, n_targets, at_x, at_y, 1, u, v), STATUS_OK);
    assert_int_equal(treecode_add_gradient(tree, n_targets, at_x, at_y, 1, got[0], got[1], got[2], got[3], got[4]),
                     STATUS_OK);
    treecode_free(tree);
    return compare(n, smoothing, n_targets, at_x, at_y, u, v, got);
}

struct cloud {
    const char *name;
    void (*place)(int i);
    int n;
    double smoothing;
};

static const struct cloud clouds[] = {
    {"square", square, 5000, 0},        {"square", square, 5000, 0.2},    {"square", square, 5000, 40},
    {"strips", strips, 6400, 1e-5},     {"strips", strips, 6400, 0.2},    {"strips", strips, 6400, 1},
    {"cluster", cluster, 5000, 1e-5},   {"cluster", cluster, 5000, 0.01}, {"line", line, 5000, 0},
    {"line", line, 5000, 0.2},          {"heaps", heaps, 4608, 0},        {"heaps", heaps, 4608, 0.3},
    {"heaps", heaps, 4608, 3},          {"far away", far_away, 3001, 0},  {"far away", far_away, 3001, 0.2},
    {"one place", one_place, 700, 0.2},
};
static const double tolerances[] = {1e-4, 1e-6, 1e-8, 1e-10, 1e-12};
enum { N_CLOUDS = sizeof clouds / sizeof *clouds, N_TOLERANCES = sizeof tolerances / sizeof *tolerances };

static void errors_are_below_the_tolerance_and_not_far_below(void **state) {
    (void)state;
    double worst[N_TOLERANCES] = {0};
    for (int c = 0; c < N_CLOUDS; c++) {
        const struct cloud *const cloud = &clouds[c];
        struct errors max = {0};  // in tolerances
        fill(cloud->n, cloud->place);
        for (int t = 0; t < N_TOLERANCES; t++) {
            const struct errors now = errors(cloud->n, cloud->smoothing, tolerances[t], cloud->n, x, y);
            // rounding of both sums: some 1e-15 each
            NEAR(now.velocity, 0, tolerances[t] + 1e-14, 0);
            NEAR(now.gradient, 0, 50 * tolerances[t] + 1e-13, 0);
            keep_worse(&worst[t], now.velocity);
            keep_worse(&max.velocity, now.velocity / tolerances[t]);
            keep_worse(&max.gradient, now.gradient / tolerances[t]);
        }
        print_message("%-9s smoothing %-5g errors in tolerances: velocity %.3f, gradient %.3f\n", cloud->name,
                      cloud->smoothing, max.velocity, max.gradient);
    }
    // the degrees are no higher than needed for the worst of these clouds
    for (int t = 0; t < N_TOLERANCES; t++) assert_true(worst[t] > tolerances[t] / 50);
}

static void targets_need_not_be_the_sources(void **state) {
    (void)state;
    // points of bodies, 27 along each body; one body far away; all sources in one box or in many
    enum { N_TARGETS = 27 * 40 };
    static double at_x[N_TARGETS], at_y[N_TARGETS];
    for (int i = 0; i < N_TARGETS; i++) {
        at_x[i] = 1.5 * (i / 27 % 8) - (i % 27) / 26.0;
        at_y[i] = 1.5 * (i / 27 / 8) + 0.05 * sin(0.2 * i);
    }
    at_x[500] = 1e9;
    const int n_sources[] = {1, 2, 50, 6400}, n_targets[] = {1, 2, 27, N_TARGETS};
    for (int s = 0; s < 4; s++) {
        fill(n_sources[s], strips);
        for (int t = 0; t < 4; t++) {
            const struct errors now = errors(n_sources[s], 0.2, 1e-8, n_targets[t], at_x, at_y);
            NEAR(now.velocity, 0, 1e-8, 0);
            NEAR(now.gradient, 0, 50e-8, 0);
        }
    }
}

// ---- plans ----

enum { N_PLANNED = 4000, BODIES = 27 * 40 };

struct targets {
    double x[BODIES], y[BODIES];
};

// points of bodies, 27 along each body, and wakes; every point is displaced by up to a distance in a different
// direction
static void move(struct targets *targets, double far) {
    fill(N_PLANNED, strips);
    for (int i = 0; i < N_PLANNED; i++) {
        x[i] += far * sin(0.1 * i);
        y[i] += far * cos(0.3 * i);
        circulation[i] *= 1 + far * sin(i);
    }
    for (int i = 0; i < BODIES; i++) {
        targets->x[i] = 1.5 * (i / 27 % 8) - (i % 27) / 26.0 + far * cos(0.2 * i);
        targets->y[i] = 1.5 * (i / 27 / 8) + 0.05 * sin(0.2 * i) + far * sin(0.1 * i);
    }
}

static struct treecode *plan(double smoothing, double tolerance, int with_gradient, int threads) {
    struct targets targets;
    move(&targets, 0);
    struct treecode *const tree = build(N_PLANNED, smoothing, tolerance);
    assert_int_equal(treecode_plan(tree, BODIES, targets.x, targets.y, with_gradient, threads), STATUS_OK);
    return tree;
}

// whether a plan fits after displacements of up to a distance
static int move_all(struct treecode *tree, struct targets *targets, double far, int threads) {
    move(targets, far);
    treecode_move_vortices(tree, 0, x, y, circulation, threads);
    treecode_move_targets(tree, targets->x, targets->y, threads);
    return treecode_fits(tree, threads);
}

// The sums of a plan for a distance; with the gradient if the arrays are given.
static void sum_planned(struct treecode *tree, int threads, double value[5][MAX], int with_gradient) {
    memset(value, 0, 5 * sizeof *value);
    double *const none = NULL, *const *const g = with_gradient ? (double *[]){value[2], value[3], value[4]}
                                                               : (double *[]){none, none, none};
    treecode_add_planned(tree, threads, value[0], value[1], g[0], g[1], g[2]);
}

static void a_plan_keeps_the_tolerance_wherever_it_fits(void **state) {
    (void)state;
    static const double far[] = {0, 1e-6, 1e-3, 0.005, 0.01, 0.02, 0.03, 0.05, 0.1, 0.3, 1, 10, 0};
    static const double smoothing[] = {0, 0.2, 3};
    enum { N_FAR = sizeof far / sizeof *far };
    static double velocity[5][MAX], gradient[5][MAX];
    for (int t = 0; t < N_TOLERANCES; t++) {
        for (int e = 0; e < 3; e++) {
            struct treecode *const one = plan(smoothing[e], tolerances[t], 0, 1);
            struct treecode *const both = plan(smoothing[e], tolerances[t], 1, 1);
            int n_fit = 0;
            for (int k = 0; k < N_FAR; k++) {
                struct targets targets;
                const int fits = move_all(one, &targets, far[k], 1) && move_all(both, &targets, far[k], 1);
                n_fit += fits;
                // small tolerances give so few pairs that a plan may fit any displacement
                assert_true(far[k] > 0.02 || fits);
                assert_false(far[k] >= 1 && tolerances[t] > 1e-9 && fits);
                if (!fits) continue;
                sum_planned(one, 1, velocity, 0);
                sum_planned(both, 1, gradient, 1);
                struct errors now =
                    compare(N_PLANNED, smoothing[e], BODIES, targets.x, targets.y, velocity[0], velocity[1], gradient);
                NEAR(now.velocity, 0, tolerances[t] + 1e-14, 0);
                NEAR(now.gradient, 0, 50 * tolerances[t] + 1e-13, 0);
                // a plan with the gradient also serves velocities alone
                sum_planned(both, 1, velocity, 0);
                now =
                    compare(N_PLANNED, smoothing[e], BODIES, targets.x, targets.y, velocity[0], velocity[1], gradient);
                NEAR(now.velocity, 0, tolerances[t] + 1e-14, 0);
            }
            print_message("tolerance %.0e, smoothing %-3g: fits %d of %d\n", tolerances[t], smoothing[e], n_fit, N_FAR);
            treecode_free(one);
            treecode_free(both);
        }
    }
}

static void a_plan_is_the_tree_that_is_built_there(void **state) {
    (void)state;
    const double tolerance = 1e-8;
    static double planned[5][MAX], built[5][MAX];
    struct treecode *const tree = plan(0.2, tolerance, 0, 1);
    for (int k = 0; k < 3; k++) {
        struct targets targets;
        assert_true(move_all(tree, &targets, 0.004 * k, 1));
        sum_planned(tree, 1, planned, 0);
        memset(built, 0, sizeof built);
        struct treecode *const fresh = build(N_PLANNED, 0.2, tolerance);
        assert_int_equal(treecode_add_velocity(fresh, BODIES, targets.x, targets.y, 1, built[0], built[1]), STATUS_OK);
        treecode_free(fresh);
        // the error of both sums, A is below 160
        NEAR_ARRAY(BODIES, planned[0], built[0], 2 * 160 * tolerance, 0);
        NEAR_ARRAY(BODIES, planned[1], built[1], 2 * 160 * tolerance, 0);
    }
    treecode_free(tree);
}

static void neither_threads_nor_what_came_between_change_a_bit_of_a_plan(void **state) {
    (void)state;
    static double one[5][MAX], more[5][MAX];
    for (int with_gradient = 0; with_gradient < 2; with_gradient++) {
        struct targets targets;
        struct treecode *const tree = plan(0.2, 1e-8, with_gradient, 1);
        assert_true(move_all(tree, &targets, 0.01, 1));
        sum_planned(tree, 1, one, with_gradient);
        for (int threads = 2; threads < 5; threads++) {
            struct treecode *const other = plan(0.2, 1e-8, with_gradient, threads);
            assert_false(move_all(other, &targets, 3, threads));
            assert_true(move_all(other, &targets, 0.005, threads));
            sum_planned(other, threads, more, 0);
            assert_true(move_all(other, &targets, 0.01, threads));
            sum_planned(other, threads, more, with_gradient);
            assert_memory_equal(more, one, sizeof one);
            treecode_free(other);
        }
        treecode_free(tree);
    }
}

// A sum with new pairs for every displacement jumps by up to the tolerance; the second difference shows the jump.
static void a_planned_sum_is_continuous(void **state) {
    (void)state;
    enum { STEPS = 100 };
    const double tolerance = 1e-4;
    static double planned[3][5][MAX], built[3][5][MAX];
    double jump[2] = {0};
    struct treecode *const tree = plan(0.2, tolerance, 0, 1);
    for (int k = 0; k < STEPS; k++) {
        struct targets targets;
        assert_true(move_all(tree, &targets, 2e-5 * k, 1));
        sum_planned(tree, 1, planned[k % 3], 0);
        memset(built[k % 3], 0, sizeof built[k % 3]);
        struct treecode *const fresh = build(N_PLANNED, 0.2, tolerance);
        assert_int_equal(
            treecode_add_velocity(fresh, BODIES, targets.x, targets.y, 1, built[k % 3][0], built[k % 3][1]), STATUS_OK);
        treecode_free(fresh);
        for (int i = 0; k >= 2 && i < BODIES; i++) {
            const int a = (k - 2) % 3, b = (k - 1) % 3, c = k % 3;
            keep_worse(&jump[0], fabs(planned[a][0][i] - 2 * planned[b][0][i] + planned[c][0][i]));
            keep_worse(&jump[1], fabs(built[a][0][i] - 2 * built[b][0][i] + built[c][0][i]));
        }
    }
    print_message("second differences: planned %.1e, built %.1e\n", jump[0], jump[1]);
    assert_true(10 * jump[0] < jump[1]);
    treecode_free(tree);
}

// ---- everything else ----

static void few_points_are_summed_directly(void **state) {
    (void)state;
    fill(100, square);
    x[1] = x[0];
    y[1] = y[0];
    for (int n = 0; n <= 100; n = 2 * n + 1) {
        struct treecode *const tree = build(n, 0, 1e-8);
        double u[100], v[100], want_u[100], want_v[100];
        for (int i = 0; i < 100; i++) u[i] = v[i] = want_u[i] = want_v[i] = 5;
        assert_int_equal(treecode_add_velocity(tree, n, x, y, 1, u, v), STATUS_OK);
        kernel_add_velocity(n, x, y, n, x, y, circulation, 0, want_u, want_v);
        // the same terms in another order
        NEAR_ARRAY(100, u, want_u, 1e-14, 0);
        NEAR_ARRAY(100, v, want_v, 1e-14, 0);
        treecode_free(tree);
    }
}

static void a_vortex_adds_nothing_at_itself(void **state) {
    (void)state;
    fill(1000, one_place);
    const double smoothings[] = {0, 1e-5, 0.2};
    for (int s = 0; s < 3; s++) {
        struct treecode *const tree = build(1000, smoothings[s], 1e-8);
        double u[1000] = {0}, v[1000] = {0};
        assert_int_equal(treecode_add_velocity(tree, 1000, x, y, 1, u, v), STATUS_OK);
        for (int i = 0; i < 1000; i++) {
            NEAR(u[i], 0, 0, 0);
            NEAR(v[i], 0, 0, 0);
        }
        treecode_free(tree);
    }
}

static void threads_do_not_change_a_bit(void **state) {
    (void)state;
    static double one[5][MAX], more[5][MAX];
    fill(MAX, strips);
    struct treecode *const tree = build(MAX, 0.2, 1e-8);
    memset(one, 0, sizeof one);
    assert_int_equal(treecode_add_gradient(tree, MAX, x, y, 1, one[0], one[1], one[2], one[3], one[4]), STATUS_OK);
    for (int threads = 2; threads < 5; threads++) {
        memset(more, 0, sizeof more);
        assert_int_equal(treecode_add_gradient(tree, MAX, x, y, threads, more[0], more[1], more[2], more[3], more[4]),
                         STATUS_OK);
        assert_memory_equal(more, one, sizeof one);
    }
    treecode_free(tree);
}

static void a_tree_may_be_built_again(void **state) {
    (void)state;
    static double fresh[2][MAX], again[2][MAX];
    memset(fresh, 0, sizeof fresh);
    memset(again, 0, sizeof again);
    fill(2000, square);
    struct treecode *tree = build(2000, 0.1, 1e-10);
    assert_int_equal(treecode_add_velocity(tree, 2000, x, y, 1, fresh[0], fresh[1]), STATUS_OK);
    treecode_free(tree);
    fill(5000, cluster);
    tree = build(5000, 0.3, 1e-4);
    assert_int_equal(treecode_add_velocity(tree, 5000, x, y, 1, again[0], again[1]), STATUS_OK);
    memset(again, 0, sizeof again);
    fill(2000, square);
    assert_int_equal(treecode_build(tree, 2000, x, y, circulation, 0.1, 1e-10, 1), STATUS_OK);
    assert_int_equal(treecode_add_velocity(tree, 2000, x, y, 1, again[0], again[1]), STATUS_OK);
    treecode_free(tree);
    assert_memory_equal(again, fresh, sizeof fresh);
}

static enum status make_and_add(double *u, double *v) {
    struct treecode *tree;
    enum status status = treecode_create(&tree);
    if (status != STATUS_OK) return status;
    status = treecode_build(tree, 3000, x, y, circulation, 0.2, 1e-8, 1);
    if (status == STATUS_OK) status = treecode_add_velocity(tree, 3000, x, y, 1, u, v);
    treecode_free(tree);
    return status;
}

static void without_memory_nothing_is_added_and_nothing_leaks(void **state) {
    (void)state;
    static double u[MAX], v[MAX];
    memset(u, 0, sizeof u);
    memset(v, 0, sizeof v);
    fill(3000, square);
    const int n_before = n_live;
    int n_allowed = 0;
    for (;; n_allowed++) {
        n_until_failure = n_allowed;
        const enum status status = make_and_add(u, v);
        n_until_failure = -1;
        assert_int_equal(n_live, n_before);
        if (status == STATUS_OK) break;
        assert_int_equal(status, STATUS_MEMORY);
        for (int i = 0; i < 3000; i++) assert_true(u[i] == 0 && v[i] == 0);
    }
    assert_true(n_allowed > 10);
    assert_true(u[0] != 0);
}

static void a_second_sum_needs_no_more_memory(void **state) {
    (void)state;
    static double u[MAX], v[MAX];
    fill(3000, square);
    struct treecode *const tree = build(3000, 0.2, 1e-8);
    assert_int_equal(treecode_add_velocity(tree, 3000, x, y, 1, u, v), STATUS_OK);
    n_until_failure = 0;
    const enum status built = treecode_build(tree, 3000, x, y, circulation, 0.2, 1e-8, 1);
    const enum status added = treecode_add_velocity(tree, 3000, x, y, 1, u, v);
    n_until_failure = -1;
    assert_int_equal(built, STATUS_OK);
    assert_int_equal(added, STATUS_OK);
    // a failed allocation leaves an empty tree that can be filled later
    fill(MAX, strips);
    n_until_failure = 0;
    assert_int_equal(treecode_build(tree, MAX, x, y, circulation, 0.2, 1e-8, 1), STATUS_MEMORY);
    n_until_failure = -1;
    const double before = u[0];
    assert_int_equal(treecode_add_velocity(tree, 3000, x, y, 1, u, v), STATUS_OK);
    NEAR(u[0], before, 0, 0);
    assert_int_equal(treecode_build(tree, MAX, x, y, circulation, 0.2, 1e-8, 1), STATUS_OK);
    assert_int_equal(treecode_add_velocity(tree, 3000, x, y, 1, u, v), STATUS_OK);
    assert_true(u[0] != before);
    treecode_free(tree);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_below_the_tolerance_and_not_far_below),
        cmocka_unit_test(targets_need_not_be_the_sources),
        cmocka_unit_test(a_plan_keeps_the_tolerance_wherever_it_fits),
        cmocka_unit_test(a_plan_is_the_tree_that_is_built_there),
        cmocka_unit_test(neither_threads_nor_what_came_between_change_a_bit_of_a_plan),
        cmocka_unit_test(a_planned_sum_is_continuous),
        cmocka_unit_test(few_points_are_summed_directly),
        cmocka_unit_test(a_vortex_adds_nothing_at_itself),
        cmocka_unit_test(threads_do_not_change_a_bit),
        cmocka_unit_test(a_tree_may_be_built_again),
        cmocka_unit_test(without_memory_nothing_is_added_and_nothing_leaks),
        cmocka_unit_test(a_second_sum_needs_no_more_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
