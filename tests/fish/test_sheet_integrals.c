/* test_sheet_integrals.c: circulation between vortices, and momentum, of sheets with known integrals: doc/model.md,
 * section 15. */
#include "failing_malloc.h"
#include "fish/sheet_integrals.h"
#include "near.h"

static const double pi = 3.14159265358979323846;

enum { N_NODES = 7, N_SHEET = 13 };

// the circulations of a sheet with g = cos(m theta): the trapezoidal rule halves the circulations at the ends
static void cosine(int m, double *circulation) {
    for (int j = 0; j < N_SHEET; j++) {
        const int is_end = j == 0 || j == N_SHEET - 1;
        circulation[j] = (is_end ? 0.5 : 1) * pi / (N_SHEET - 1) * cos(m * pi * j / (N_SHEET - 1));
    }
}

static struct sheet_integrals *make(double (*density)(int)) {
    double values[N_NODES - 1];
    for (int k = 0; k < N_NODES - 1; k++) values[k] = density(k);
    struct sheet_integrals *integrals;
    assert_int_equal(sheet_integrals_create(&integrals, N_NODES, N_SHEET, values), STATUS_OK);
    return integrals;
}

static double three(int edge) {
    (void)edge;
    return 3;
}

static double first_two_edges(int edge) {
    return edge < 2 ? 1 : 0;
}

static void control_points_have_the_circulation_of_their_intervals(void **state) {
    (void)state;
    struct sheet_integrals *const integrals = make(three);
    for (int m = 0; m < N_SHEET - 1; m++) {
        double q[N_SHEET], around[N_SHEET - 1], before[N_SHEET - 1];
        cosine(m, q);
        sheet_integrals_around(integrals, q, around);
        sheet_integrals_before(integrals, q, before);
        for (int c = 0; c < N_SHEET - 1; c++) {
            const double theta = pi * (c + 0.5) / (N_SHEET - 1);
            NEAR(around[c], pi / (N_SHEET - 1) * cos(m * theta), 1e-14, 0);
            NEAR(before[c], m == 0 ? theta : sin(m * theta) / m, 1e-13, 0);
        }
    }
    sheet_integrals_free(integrals);
}

static void a_kink_at_the_tail_is_what_the_series_lacks(void **state) {
    (void)state;
    struct sheet_integrals *const integrals = make(three);
    const double h = pi / (N_SHEET - 1);
    for (int c = 0; c < N_SHEET - 1; c++) {
        // g = sin(theta) (1 - cos(theta)): a strength proportional to the position, finite at the tail
        const double theta = h * (c + 0.5), end = h * sin(pi - h) * (1 - cos(pi - h));
        double around = integrals->kink_strength[c] * end, before = integrals->kink_circulation[c] * end;
        for (int j = 0; j < N_SHEET; j++) {
            const double q = h * sin(j * h) * (1 - cos(j * h));
            around += integrals->strength[j * (N_SHEET - 1) + c] * q;
            before += integrals->circulation[j * (N_SHEET - 1) + c] * q;
        }
        NEAR(around, h * sin(theta) * (1 - cos(theta)), 1e-14, 0);
        NEAR(before, pow(1 - cos(theta), 2) / 2, 1e-13, 0);
    }
    // the kink is large at the tail
    assert_true(fabs(integrals->kink_strength[N_SHEET - 2]) > 0.1);
    assert_true(fabs(integrals->kink_strength[0]) < 0.01);
    sheet_integrals_free(integrals);
}

// sum over nodes k, i and vortices j of weight_k P_kij x_i q_j
static double integral(const struct sheet_integrals *integrals, const double *weight, const double *x,
                       const double *q) {
    double sum = 0;
    for (int j = 0; j < N_SHEET; j++) {
        for (int k = 0; k < N_NODES; k++) {
            for (int i = 0; i < N_NODES; i++) {
                sum += weight[k] * integrals->momentum[(j * N_NODES + i) * N_NODES + k] * x[i] * q[j];
            }
        }
    }
    return sum;
}

static const double one[N_NODES] = {1, 1, 1, 1, 1, 1, 1}, u[N_NODES] = {0, 1, 2, 3, 4, 5, 6};

static void momentum_of_a_sheet_of_constant_g_is_the_exact_one(void **state) {
    (void)state;
    double q[N_SHEET];
    cosine(0, q);
    // C = theta, and with u = (N-1)(1 - cos theta)/2: integral of theta du, and of theta u du
    const double half = (N_NODES - 1) / 2.0;
    struct sheet_integrals *const integrals = make(three);
    NEAR(integral(integrals, one, u, q), 3 * pi * half, 0, 1e-9);
    NEAR(integral(integrals, u, u, q), 3 * pi * half * half * 1.25, 0, 1e-9);
    // a sum over nodes of slopes of 1 vanishes
    NEAR(integral(integrals, u, one, q), 0, 1e-11, 0);
    sheet_integrals_free(integrals);
    // to the end of the second edge: (N-1)/2 (sin(theta) - theta cos(theta))
    struct sheet_integrals *const part = make(first_two_edges);
    const double end = acos(1 - 2 / half);
    NEAR(integral(part, one, u, q), half * (sin(end) - end * cos(end)), 0, 1e-9);
    sheet_integrals_free(part);
}

// g = cos(m theta) has C = sin(m theta)/m; its momentum to the end of the second edge
static void momentum_of_every_cosine_is_the_exact_one(void **state) {
    (void)state;
    struct sheet_integrals *const part = make(first_two_edges);
    const double half = (N_NODES - 1) / 2.0, end = acos(1 - 2 / half);
    for (int m = 1; m < N_SHEET; m++) {
        double q[N_SHEET];
        cosine(m, q);
        const double less = m == 1 ? end : sin((m - 1) * end) / (m - 1), more = sin((m + 1) * end) / (m + 1);
        NEAR(integral(part, one, u, q), half * (less - more) / (2 * m), 1e-10, 0);
    }
    sheet_integrals_free(part);
}

static void no_memory_leaves_nothing(void **state) {
    (void)state;
    const double density[N_NODES - 1] = {1, 1, 1, 1, 1, 1};
    const int before = n_live;
    enum status status = STATUS_MEMORY;
    int n = 0;
    for (; status != STATUS_OK; n++) {
        struct sheet_integrals *integrals;
        n_until_failure = n;
        status = sheet_integrals_create(&integrals, N_NODES, N_SHEET, density);
        n_until_failure = -1;
        if (status != STATUS_OK) assert_null(integrals);
        sheet_integrals_free(integrals);
        assert_int_equal(n_live, before);
    }
    assert_true(n > 4);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(control_points_have_the_circulation_of_their_intervals),
        cmocka_unit_test(a_kink_at_the_tail_is_what_the_series_lacks),
        cmocka_unit_test(momentum_of_a_sheet_of_constant_g_is_the_exact_one),
        cmocka_unit_test(momentum_of_every_cosine_is_the_exact_one),
        cmocka_unit_test(no_memory_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
