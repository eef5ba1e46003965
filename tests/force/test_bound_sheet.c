/* test_bound_sheet.c: The strength of the bound sheet satisfies impermeability, Kelvin's theorem and the Kutta
 * condition, and agrees with the closed forms for a flat plate and a circular arc (doc/model.md, sections 6, 7 and 12).
 * */
#include <stdio.h>

#include "flow/flow_at_bodies.h"
#include "force/bound_sheet.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"
// a sheet that sheds vortices at its last point: with midpoints and a rate, too
#define CLASSIC "wake: {shedding: continuous}\n"
#define FAR "solver: {coupling_distance: 100}\n"

static const double pi = 3.14159265358979323846;

static void of_fish(struct setup *setup, int f, const double **u, const double **v) {
    *u = setup->residual->flow->u + setup->residual->flow->points[f].first;
    *v = setup->residual->flow->v + setup->residual->flow->points[f].first;
}

static const double removed = 0.3;
static enum bound_sheet_law law; /* law of the Jacobian under test */

static void value_of_sheet(struct setup *setup, const double *y, const double *yp, double *value) {
    school_flow(setup, y);
    for (int f = 0; f < setup->school->n_fish; f++) {
        const double *u, *v;
        of_fish(setup, f, &u, &v);
        bound_sheet_residual(&setup->school->fish[f], removed, u, v, y, value);
        bound_sheet_kutta_residual(&setup->school->fish[f], law, u, v, y, yp, value);
    }
}

static void jacobian_of_sheet(struct setup *setup, double cj, const double *y, struct sparse *jacobian) {
    for (int f = 0; f < setup->school->n_fish; f++) {
        const struct fish *fish = &setup->school->fish[f];
        const double *u, *v;
        of_fish(setup, f, &u, &v);
        bound_sheet_jacobian(fish, u, v, y, jacobian);
        bound_sheet_kutta_jacobian(fish, law, cj, u, v, y, jacobian);
        for (int g = 0; g < setup->school->n_fish; g++) {
            struct jacobian_scratch *const through = school_influence(setup, f, g);
            bound_sheet_flow_jacobian(fish, &through->block, y, &through->rows);
            if (law == BOUND_SHEET_RATE) bound_sheet_kutta_flow_jacobian(fish, &through->block, y, &through->rows);
            school_add_rows(setup, f, g, jacobian);
        }
    }
}

TEST(derivatives_agree_with_differences) {
    const char *const texts[] = {
        SMALL "fish: [{}]\n",
        SMALL CLASSIC "sheet: {collocation: midpoint}\nfish: [{force: reactive, sheet_points: 21}]\n",
        TIME "fluid: {velocity: [0.3, -0.2], shear: 0.7}\nfish: [{force: reactive, sheet_points: 5, nodes: 9}]\n",
        SMALL CLASSIC "fish: [{force: reactive, sheet_points: 9}]\n",
        SMALL CLASSIC "sheet: {curve: polygon}\nfish: [{force: reactive, sheet_points: 9}]\n",
        TIME CLASSIC
        "sheet: {curve: polygon, collocation: midpoint}\nfish: [{force: reactive, sheet_points: 15, nodes: 4}]\n",
        SMALL FAR
        "fish:\n  - {}\n"
        "  - {nodes: 5, force: reactive, sheet_points: 13, length: 0.7, start: {position: [0.2, 0.5], heading: 170}}\n",
        SMALL CLASSIC FAR
        "sheet: {curve: polygon, collocation: midpoint}\nfish:\n  - {sheet_points: 9}\n"
        "  - {nodes: 5, sheet_points: 7, length: 0.7, start: {position: [0.2, 0.5], heading: 170}}\n"
        "  - {nodes: 9, sheet_points: 11, length: 1.2, start: {position: [0.1, -0.6], heading: 200}}\n"};
    const enum bound_sheet_law laws[] = {BOUND_SHEET_EDGE, BOUND_SHEET_RATE, BOUND_SHEET_FROZEN};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        for (int l = 0; l < 3; l++) {
            struct setup setup = setup_stirred(texts[i]);
            law = laws[l];
            school_compare(&setup, value_of_sheet, jacobian_of_sheet, texts[i]);
        }
    }
}

// Bound circulations q (m) of a plate at rest along x in the stream (cos alpha, sin alpha). The smoothing of the free
// vortex is so wide that the vortex induces no velocity: only the bound sheet remains.
static void solve_plate(const char *collocation, const char *kutta, int m, const char *more, double *q) {
    struct setup setup = setup_with(SMALL
                                    "fluid: {velocity: [0.8, 0.6]%s}\n"
                                    "wake: {shedding: continuous, smoothing: 1.0e+9}\n"
                                    "sheet: {collocation: %s, kutta: %s}\n"
                                    "fish: [{force: reactive, sheet_points: %d, motion: {prescribed: all}}]\n",
                                    more, collocation, kutta, m);
    school_consistent(&setup, 0);
    const struct fish *fish = setup.school->fish;
    for (int j = 0; j < m; j++) q[j] = fish->sheet_weight[j] * setup.state->y[fish->at.gamma + j];
}

TEST(plate_without_circulation_is_exact_with_chebyshev_points) {
    // gamma = -2 w (L/2 - s)/sqrt(s (L-s)) with w = 0.6, as circulations of Gauss-Lobatto quadrature
    for (int m = 5; m <= 33; m += 7) {
        double q[64], want[64];
        solve_plate("chebyshev", "rate", m, "", q);
        for (int j = 0; j < m; j++) {
            want[j] = -0.6 * pi / (m - 1) * cos(pi * j / (m - 1)) * (j == 0 || j == m - 1 ? 0.5 : 1);
        }
        // rounding of a linear system with a condition number of order M^2
        NEAR_ARRAY(m, q, want, 1e-12, 0);
    }
}

TEST(plate_with_kutta_condition_is_exact_with_chebyshev_points) {
    for (int m = 5; m <= 33; m += 7) {
        double q[64], total = 0;
        solve_plate("chebyshev", "edge", m, "", q);
        for (int j = 0; j < m; j++) total += q[j];
        // Gamma = pi L U sin(alpha)
        NEAR(total, -pi * 0.6, 0, 1e-12);
        NEAR(q[m - 1], 0, 1e-14, 0);
    }
}

// largest error of the strengths in the middle of a plate without circulation, relative to the strengths of the plate
static double error_of_midpoints(int m) {
    static double q[300];
    solve_plate("midpoint", "rate", m, "", q);
    double error = 0;
    for (int j = m / 4; j < 3 * m / 4; j++) {
        error = fmax(error, fabs(q[j] / (-0.6 * pi / (m - 1)) - cos(pi * j / (m - 1))));
    }

    return error;
}

TEST(plate_with_midpoints_converges) {
    const double coarse = error_of_midpoints(41), fine = error_of_midpoints(81);
    BELOW(fine, 0.03);

    // first order: midpoints of chords are not the points of a quadrature
    ABOVE(coarse / fine, 1.8);

    // With Kutta's condition the sum of the strengths is exact on any mesh: (L/2) w times 2 pi, by Vieta's formula for
    // the polynomial whose zeros are the control points, the means of neighbouring bound points.
    for (int m = 5; m <= 33; m += 7) {
        double q[64], total = 0;
        solve_plate("midpoint", "edge", m, "", q);
        for (int j = 0; j < m; j++) total += q[j];
        NEAR(total, -pi * 0.6, 0, 1e-12);
    }
}

// bound circulation of a plate beside a vortex of circulation 1 at (0.4, 0.3) with smoothing 0.2
static double circulation_beside_a_vortex(int m) {
    struct setup setup = setup_with(SMALL
                                    "wake: {shedding: continuous, smoothing: 0.2}\nfish: [{force: reactive, "
                                    "sheet_points: %d, motion: {prescribed: all}}]\n",
                                    m);
    wake_release(&setup.state->wake[0], 0.4, 0.3, 1, 0);
    school_consistent(&setup, 0);
    const double circulation = bound_sheet_circulation(setup.school->fish, setup.state->y);
    return circulation;
}

TEST(chebyshev_points_converge_spectrally) {
    const double limit = circulation_beside_a_vortex(161);
    double before = fabs(circulation_beside_a_vortex(11) - limit);
    BELOW(before, 0.1);
    ABOVE(before, 1e-9);

    // spectral convergence: ten more points reduce the error tenfold, down to rounding
    for (int m = 21; m <= 51; m += 10) {
        const double error = fabs(circulation_beside_a_vortex(m) - limit);
        BELOW(error, fmax(before / 10, 1e-12));
        before = error;
    }
}

/* The bound circulation, under Kutta's condition, of a body of length 1 at rest in the stream (cos 10, sin 10 degrees).
 * place: positions of the nodes as functions of the arc length. Shed circulation induces no velocity. */
typedef void line(double s, double place[2]);
static double circulation_of_a_bent_body(line *place, const char *curve, int n_nodes, int m) {
    struct setup setup =
        setup_with(TIME
                   "fluid: {velocity: [%.17g, %.17g]}\nwake: {shedding: continuous, smoothing: 1.0e+9}\n"
                   "sheet: {curve: %s}\n"
                   "fish: [{force: reactive, nodes: %d, sheet_points: %d, wave: {amplitude: 0}}]\n",
                   cos(pi / 18), sin(pi / 18), curve, n_nodes, m);
    const struct fish *fish = setup.school->fish;
    for (int k = 0; k < n_nodes; k++) {
        double at[2];
        place((double)k / (n_nodes - 1), at);
        setup.state->y[fish->at.x + k] = at[0];
        setup.state->y[fish->at.y + k] = at[1];
    }

    school_consistent(&setup, 0);
    const double circulation = bound_sheet_circulation(fish, setup.state->y);
    return circulation;
}

// an arc of half opening 30 degrees, convex upwards; circulation by Joukowski's map
static void arc(double s, double place[2]) {
    const double angle = pi / 6 * (2 * s - 1), radius = 3 / pi;
    place[0] = radius * (sin(angle) + 0.5);
    place[1] = radius * (cos(angle) - cos(pi / 6));
}

TEST(smooth_curve_has_the_circulation_of_an_arc) {
    const double exact = -3 / cos(pi / 12) * sin(pi / 18 + pi / 12);
    const int n_nodes[] = {7, 11, 21, 41};
    const double allowed[] = {1e-4, 2e-5, 2e-6, 2e-7};
    for (int i = 0; i < 4; i++) NEAR(circulation_of_a_bent_body(arc, "smooth", n_nodes[i], 41), exact, 0, allowed[i]);
}

// a default fish in mid-beat: curvature of the full wave, integrated by Simpson's rule
static void beat(double s, double place[2]) {
    enum { N = 2000 };
    double angle = 0;
    place[0] = place[1] = 0;
    for (int i = 0; i < N; i++) {
        double turn[5];
        for (int k = 0; k < 5; k++) {
            const double q = s * (i + k / 4.0) / N;
            turn[k] = s / N * 6 * 0.4 * (q + 0.2 * q * q) * sin(1 - 6 * q);
        }

        const double half = angle + (turn[0] + 4 * turn[1] + turn[2]) / 12;
        const double end = angle + (turn[0] + 4 * turn[1] + 2 * turn[2] + 4 * turn[3] + turn[4]) / 12;
        place[0] += s / N * (cos(angle) + 4 * cos(half) + cos(end)) / 6;
        place[1] += s / N * (sin(angle) + 4 * sin(half) + sin(end)) / 6;
        angle = end;
    }
}

TEST(smooth_curve_and_polygon_of_a_bent_fish_have_one_limit) {
    const double limit = circulation_of_a_bent_body(beat, "smooth", 641, 65);

    // about 16 N^-3.5 and 2.5 N^-1.5 on this body
    const int n_nodes[] = {17, 33, 65};
    double smooth[3], polygon[3];
    for (int i = 0; i < 3; i++) {
        smooth[i] = fabs(circulation_of_a_bent_body(beat, "smooth", n_nodes[i], 65) / limit - 1);
        polygon[i] = fabs(circulation_of_a_bent_body(beat, "polygon", n_nodes[i], 65) / limit - 1);
    }

    BELOW(smooth[0], 1e-3);
    BELOW(smooth[1], 1e-4);
    BELOW(smooth[2], 1e-5);
    ABOVE(log2(smooth[0] / smooth[1]), 3);
    ABOVE(log2(smooth[1] / smooth[2]), 3);
    ABOVE(polygon[0], 1e-2);
    ABOVE(log2(polygon[1] / polygon[2]), 1.3);
    NEAR(circulation_of_a_bent_body(beat, "polygon", 641, 65), limit, 0, 1e-3);
}

TEST(strength_is_circulation_per_length_of_the_body_as_it_is) {
    struct setup setup =
        setup_of(SMALL "fish: [{force: reactive, sheet_points: 9, length: 1.2, start: {heading: 30}}]\n");
    const struct fish *fish = setup.school->fish;
    double *const y = setup.state->y;

    // stretched by a tenth
    for (int i = fish->at.x; i < fish->at.vx; i++) y[i] *= 1.1;
    const double h = pi / 8;
    for (int j = 1; j < 8; j++) {
        y[fish->at.gamma + j] = 0.7;
        const double q = 0.7 * fish->sheet_weight[j];
        NEAR(bound_sheet_strength(fish, j, y), q / (1.1 * 0.6 * h * sin(j * h)), 0, 1e-13);
    }

    // the quadrature weight vanishes at both ends
    y[fish->at.gamma + 8] = 0.7;
    NEAR(bound_sheet_strength(fish, 8, y), 0.7, 0, 0);
    NEAR(fish->sheet_weight[8], 0.3 * (1 - cos(h)), 1e-15, 0);
}

TEST(end_correction_makes_a_sheet_that_ends_with_a_step_exact) {
    // a plate along x at rest with the strength s/L, except 0 at the tail point: normal velocity by Cauchy's integral
    for (int m = 5; m <= 33; m += 14) {
        struct setup setup = setup_with(SMALL "fish: [{force: reactive, sheet_points: %d, length: 1.2}]\n", m);
        const struct fish *fish = setup.school->fish;
        double *const y = setup.state->y, with[64];
        for (int j = 1; j < m - 1; j++) y[fish->at.gamma + j] = fish_mean(&fish->sheet_point[j], fish->arc) / 1.2;
        school_flow(&setup, y);
        const double *u, *v;
        of_fish(&setup, 0, &u, &v);
        bound_sheet_residual(fish, 0, u, v, y, setup.value);
        for (int c = 0; c < m - 1; c++) {
            const double sigma = fish_mean(&fish->control_point[c], fish->arc) / 1.2;
            with[c] = (sigma * log(sigma / (1 - sigma)) - 1) / (2 * pi);
            // the correction is proportional to the strength next to the tail, not to the strength at the tail
            const double strength = y[fish->at.gamma + m - 2];
            setup.value[fish->at.gamma + c] +=
                (1 / strength - 1) * bound_sheet_end_correction(fish, c, m - 2) * strength;
        }

        NEAR_ARRAY(m - 1, setup.value + fish->at.gamma, with, 1e-13, 0);
    }
}

TEST(kelvin_counts_bound_shed_and_dissipated_circulation) {
    struct setup setup =
        setup_stirred(SMALL CLASSIC "sheet: {curve: polygon}\nfish: [{force: reactive, sheet_points: 9}]\n");
    school_flow(&setup, setup.state->y);
    const struct fish *fish = setup.school->fish;
    const double *u, *v;
    of_fish(&setup, 0, &u, &v);
    bound_sheet_residual(fish, 0.3, u, v, setup.state->y, setup.value);
    NEAR(setup.value[fish->at.gamma + 8],
         bound_sheet_circulation(fish, setup.state->y) + setup.state->y[fish->at.circulation] - 0.3, 1e-15, 0);
    double sum = 0;
    for (int j = 0; j < 9; j++) sum += fish->sheet_weight[j] * setup.state->y[fish->at.gamma + j];
    NEAR(bound_sheet_circulation(fish, setup.state->y), sum, 1e-15, 0);
}

TEST(shedding_rate_is_edge_strength_times_slip) {
    struct setup setup =
        setup_stirred(SMALL CLASSIC "sheet: {curve: polygon}\nfish: [{force: reactive, sheet_points: 9}]\n");
    school_flow(&setup, setup.state->y);
    const struct fish *fish = setup.school->fish;
    const double *const y = setup.state->y, *u, *v;
    of_fish(&setup, 0, &u, &v);
    double slip[2];
    flow_slip(setup.residual->flow, 0, y, slip);

    // the last two bound points lie on the last edge
    const double e[2] = {y[fish->at.x + 6] - y[fish->at.x + 5], y[fish->at.y + 6] - y[fish->at.y + 5]};
    const double along = (slip[0] * e[0] + slip[1] * e[1]) / hypot(e[0], e[1]);
    NEAR(bound_sheet_shedding_rate(fish, u, v, y), y[fish->at.gamma + 8] * along, 0, 1e-13);
}
