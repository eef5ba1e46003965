/* test_sheets_at_wake.c: three sets of a tree for the bound vortices, and the markers near them. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/free_sheet.h"
#include "model/sheets_at_wake.h"
#include "school.h"
#include "vortex/kernel.h"

enum { FISH = 60, WAKE = 100, MARKERS = FISH * WAKE };

struct sums {
    struct setup setup;
    struct bound_vortices bound;
    struct vortices vortices, markers;
    struct range range[FISH];
    double *square, *u, *v;
};

/* Fish in a square with wakes that pass others; what is bound has a random circulation. */
static void make(struct sums *sums) {
    char text[8192];
    int length =
        snprintf(text, sizeof text, "time: {end: 1, shedding_interval: 0.02}\nwake: {sheet_smoothing: 0.05}\nfish:\n");
    for (int f = 0; f < FISH; f++) {
        length +=
            snprintf(text + length, sizeof text - (size_t)length,
                     "  - {nodes: 7, sheet_points: 21, start: {position: [%g, %g]}}\n", 1.5 * (f % 8), 0.6 * (f / 8));
    }
    memset(sums, 0, sizeof *sums);
    school_build(&sums->setup, text);
    const struct school *const school = sums->setup.school;
    const double *const y = sums->setup.state->y;
    sums->square = calloc((size_t)FISH * 21, sizeof(double));
    sums->u = calloc(MARKERS, sizeof(double));
    sums->v = calloc(MARKERS, sizeof(double));
    assert_true(sums->square && sums->u && sums->v);
    for (int f = 0; f < FISH; f++) {
        const struct fish *const fish = &school->fish[f];
        const int first = sums->vortices.n;
        sums->range[f] = (struct range){first, fish->n_sheet};
        school_ok(vortices_append(&sums->vortices, fish->n_sheet, fish->sheet_smoothing));
        for (int j = 0; j < fish->n_sheet; j++) {
            sums->vortices.x[first + j] = fish_mean(&fish->sheet_point[j], y + fish->at.x);
            sums->vortices.y[first + j] = fish_mean(&fish->sheet_point[j], y + fish->at.y);
            sums->vortices.circulation[first + j] = school_random(&sums->setup);
            sums->square[first + j] = pow(free_sheet_bound_smoothing(fish, j), 2);
        }
        const int tail = fish->n_nodes - 1, from = sums->markers.n;
        school_ok(vortices_append(&sums->markers, WAKE, 0.1));
        for (int i = 0; i < WAKE; i++) {
            sums->markers.x[from + i] = y[fish->at.x + tail] + 0.02 * i;
            sums->markers.y[from + i] = y[fish->at.y + tail] + 0.3 * sin(0.1 * i);
        }
    }
    sums->bound = (struct bound_vortices){school, &sums->vortices, sums->range, sums->square};
}

static void clear(struct sums *sums) {
    free(sums->square);
    free(sums->u);
    free(sums->v);
    vortices_free(&sums->vortices);
    vortices_free(&sums->markers);
    school_clear(&sums->setup);
}

static void induce(struct sums *sums, double tolerance, int threads) {
    struct velocity_sum *sum;
    school_ok(velocity_sum_create(&sum));
    memset(sums->u, 0, MARKERS * sizeof(double));
    memset(sums->v, 0, MARKERS * sizeof(double));
    const struct induced at = {MARKERS, sums->markers.x, sums->markers.y, sums->u, sums->v, NULL, NULL, NULL};
    school_ok(sheets_at_wake_induce(&sums->bound, NULL, sum, tolerance, threads, &at));
    velocity_sum_free(sum);
}

static void it_is_the_direct_sum_to_the_tolerance(void **state) {
    (void)state;
    struct sums sums;
    make(&sums);
    static double u[MARKERS], v[MARKERS];
    const struct vortices *const bound = &sums.vortices;
    kernel_add_velocity_each(MARKERS, sums.markers.x, sums.markers.y, bound->n, bound->x, bound->y, bound->circulation,
                             sums.square, u, v);
    const double tolerance[] = {1e-5, 1e-7, 1e-9};
    for (int k = 0; k < 3; k++) {
        induce(&sums, tolerance[k], 1);
        double worst = 0;
        for (int i = 0; i < MARKERS; i++) {
            // the velocity without cancellation
            double size = 0;
            for (int j = 0; j < bound->n; j++) {
                const double r = hypot(sums.markers.x[i] - bound->x[j], sums.markers.y[i] - bound->y[j]);
                size += fabs(bound->circulation[j]) / (2 * acos(-1) * hypot(r, 0.05));
            }
            worst = fmax(worst, hypot(sums.u[i] - u[i], sums.v[i] - v[i]) / size);
        }
        print_message("tolerance %.0e: error %.1e\n", tolerance[k], worst);
        assert_true(worst <= 0.2 * tolerance[k]);
        assert_true(worst > 0);
    }
    clear(&sums);
}

static void others_are_summed_too(void **state) {
    (void)state;
    struct sums sums;
    make(&sums);
    static double u[MARKERS], v[MARKERS];
    for (int i = 0; i < sums.markers.n; i++) sums.markers.circulation[i] = school_random(&sums.setup);
    induce(&sums, 1e-7, 1);
    memcpy(u, sums.u, sizeof u);
    memcpy(v, sums.v, sizeof v);
    const struct induced want = {MARKERS, sums.markers.x, sums.markers.y, u, v, NULL, NULL, NULL};
    vortices_induce(&sums.markers, (struct range){0, MARKERS}, &want);
    struct velocity_sum *sum;
    school_ok(velocity_sum_create(&sum));
    memset(sums.u, 0, MARKERS * sizeof(double));
    memset(sums.v, 0, MARKERS * sizeof(double));
    const struct induced at = {MARKERS, sums.markers.x, sums.markers.y, sums.u, sums.v, NULL, NULL, NULL};
    school_ok(sheets_at_wake_induce(&sums.bound, &sums.markers, sum, 1e-7, 1, &at));
    velocity_sum_free(sum);
    double size = 0, worst = 0;
    for (int i = 0; i < MARKERS; i++) {
        size = fmax(size, hypot(u[i], v[i]));
        worst = fmax(worst, hypot(sums.u[i] - u[i], sums.v[i] - v[i]));
    }
    print_message("velocities up to %.1e, error %.1e\n", size, worst);
    // without cancellation velocities are some ten times as large
    assert_true(worst <= 1e-7 * size);
    clear(&sums);
}

static void threads_change_no_bit(void **state) {
    (void)state;
    struct sums sums;
    make(&sums);
    static double u[MARKERS];
    induce(&sums, 1e-7, 1);
    memcpy(u, sums.u, sizeof u);
    induce(&sums, 1e-7, 3);
    assert_memory_equal(u, sums.u, sizeof u);
    clear(&sums);
}

static void only_large_schools_take_the_tree(void **state) {
    (void)state;
    struct sums sums;
    make(&sums);
    assert_int_equal(sheets_at_wake_by_tree(&sums.vortices, MARKERS, 1e-7), 0);
    assert_int_equal(sheets_at_wake_by_tree(&sums.vortices, 100 * MARKERS, 1e-7), 1);
    assert_int_equal(sheets_at_wake_by_tree(&sums.vortices, 100 * MARKERS, 0), 0);
    clear(&sums);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_the_direct_sum_to_the_tolerance),
        cmocka_unit_test(others_are_summed_too),
        cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(only_large_schools_take_the_tree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
