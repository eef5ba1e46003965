/* test_shape.c: Points and tangents on the polygon and on the smooth curve are those of doc/model.md, section 6. */
#include "fish/shape.h"
#include "near.h"
#include "school.h"

static const double pi = 3.14159265358979323846;

static double sum(const struct stencil *stencil, const double *value) {
    double total = 0;
    for (int i = 0; i < stencil->n; i++) total += stencil->weight[i] * value[stencil->node[i]];
    return total;
}

TEST(polygon_is_straight_between_two_nodes) {
    const double value[] = {2, 5, 3, -1};
    const double u[] = {0, 0.25, 1, 1.5, 2.75, 3}, want[] = {2, 2.75, 5, 4, 0, -1};
    struct curve *const curve = curve_create(test_arena(), 4, 6, 6);
    for (int i = 0; i < 6; i++) {
        const struct stencil point = curve_polygon_point(curve, u[i]);
        assert_int_equal(point.n, 2);
        NEAR(sum(&point, value), want[i], 0, 0);
    }
}

TEST(middles_of_the_polygon_hold_each_node_once) {
    const double value[] = {2, 5, 3, -1};
    struct curve *const curve = curve_create(test_arena(), 4, 6, 6);
    const struct stencil a = curve_polygon_point(curve, 0.25), b = curve_polygon_point(curve, 0.75),
                         c = curve_polygon_point(curve, 1.5), d = curve_polygon_point(curve, 2.75);
    const struct stencil one_edge = curve_polygon_middle(curve, &a, &b), two = curve_polygon_middle(curve, &b, &c),
                         edge = curve_edge_middle(curve, 2);
    assert_int_equal(one_edge.n, 2);
    assert_int_equal(two.n, 3);
    NEAR(sum(&one_edge, value), 3.5, 0, 0);
    NEAR(sum(&two, value), 4.125, 0, 0);
    NEAR(sum(&edge, value), 1, 0, 0);
    const struct stencil far = curve_polygon_middle(curve, &a, &d);
    assert_int_equal(far.n, 4);
    NEAR(sum(&far, value), 1.375, 0, 0);
}

// positions between nodes, on nodes, and as close to nodes as rounding permits
static const double places[] = {0, 1e-300, 1e-12, 0.3, 0.5, 1 - 1e-15, 1, 1 + 1e-9, 1.7, 2.5, 3 - 4e-16, 3};
enum { N_PLACES = sizeof places / sizeof *places };

TEST(smooth_curve_reproduces_cubics_and_their_slopes) {
    for (int n = 4; n <= 40; n += 3) {
        struct curve *const curve = curve_create(test_arena(), n, 2 * N_PLACES, 2 * N_PLACES);
        for (int i = 0; i < N_PLACES; i++) {
            const double u = places[i] * (n - 1) / 3;
            const struct stencil point = curve_smooth_point(curve, u), slope = curve_smooth_slope(curve, u);
            double constant[40], cubic[40];
            const double s = u / (n - 1);
            for (int k = 0; k < n; k++) {
                const double q = (double)k / (n - 1);
                constant[k] = 1;
                cubic[k] = 0.3 - q * (1 + q * (0.7 - 2 * q));
            }
            NEAR(sum(&point, constant), 1, 1e-15, 0);
            // the rounding of a sum of n values, in a slope times n
            NEAR(sum(&point, cubic), 0.3 - s * (1 + s * (0.7 - 2 * s)), 1e-14, 0);
            NEAR(sum(&slope, constant), 0, 1e-14, 0);
            NEAR(sum(&slope, cubic) * (n - 1), -1 - s * (1.4 - 6 * s), 1e-13 * n, 0);
        }
    }
}

TEST(smooth_curve_goes_through_its_nodes) {
    struct curve *const curve = curve_create(test_arena(), 9, 9, 9);
    for (int k = 0; k < 9; k++) {
        const struct stencil point = curve_smooth_point(curve, k);
        for (int i = 0; i < 9; i++) NEAR(point.weight[i], i == k, 0, 0);
    }
}

TEST(slope_is_the_derivative_of_the_point) {
    const double h = 1e-3;
    for (int n = 4; n <= 13; n += 3) {
        struct curve *const curve = curve_create(test_arena(), n, 1000, 1000);
        for (double u = 0.05; u < n - 1; u += 0.19) {
            const struct stencil slope = curve_smooth_slope(curve, u);
            const struct stencil at[4] = {curve_smooth_point(curve, u - 2 * h), curve_smooth_point(curve, u - h),
                                          curve_smooth_point(curve, u + h), curve_smooth_point(curve, u + 2 * h)};
            for (int k = 0; k < n; k++) {
                const double difference =
                    (at[0].weight[k] - 8 * at[1].weight[k] + 8 * at[2].weight[k] - at[3].weight[k]) / (12 * h);
                // h^4/30 times the fifth derivative
                NEAR(slope.weight[k], difference, 1e-10, 0);
            }
        }
    }
}

// largest position error on the curve through n nodes on a half circle
static double error_of_arc(int n) {
    double x[200], y[200], largest = 0;
    for (int k = 0; k < n; k++) {
        x[k] = cos(pi * k / (n - 1));
        y[k] = sin(pi * k / (n - 1));
    }
    struct curve *const curve = curve_create(test_arena(), n, 10 * n, 10 * n);
    for (int i = 0; i < 10 * (n - 1); i++) {
        const double u = 0.1 * i + 0.05;
        const struct stencil point = curve_smooth_point(curve, u);
        largest = fmax(largest, hypot(sum(&point, x) - cos(pi * u / (n - 1)), sum(&point, y) - sin(pi * u / (n - 1))));
    }
    return largest;
}

TEST(smooth_curve_is_of_fourth_order) {
    const double coarse = error_of_arc(41), fine = error_of_arc(81);
    assert_in_range((int)(100 * log2(coarse / fine)), 380, 420);
}

// ---- the outline of a body and the section of its edges: doc/model.md, section 1

static struct fish_parameters foil(int nodes, double thickness, enum section section) {
    return (struct fish_parameters){
        .length = 1.3,
        .nodes = nodes,
        .body = {.profile = PROFILE_JOUKOWSKI, .thickness = thickness, .depth = 0.25, .section = section}};
}

TEST(joukowski_heights_are_those_of_the_mapped_circle) {
    // the thickness of both ends of an edge; s(theta) and r from z(theta): check with theta of every node from s by
    // Newton's method
    const double d = 0.15, r0 = 1.3 * (1 - d) / 4, c = r0 * (1 + d), nose = 2 * r0 * (1 + d * d) / (d - 1);
    const struct fish_parameters fish = foil(9, d, SECTION_NODES);
    double before = 0;
    for (int k = 1; k < 9; k++) {
        double r = 0;
        if (k < 8) {
            double theta = pi * (1 - k / 8.0);
            for (int i = 0; i < 60; i++) {
                const double a = r0 * (cos(theta) + d), b = r0 * sin(theta), m = a * a + b * b;
                const double x = a + c * c * a / m - (nose + 1.3 * k / 8);
                const double by_a = 1 + c * c * (b * b - a * a) / (m * m), by_b = -2 * c * c * a * b / (m * m);
                theta -= x / (by_a * -r0 * sin(theta) + by_b * r0 * cos(theta));
                r = fabs(r0 * sin(theta) * (1 - c * c / m));
            }
        }
        const struct profile_edge edge = profile_edge(&fish, k - 1);
        // rounding, twice the rounding of the arc coordinate at the steep nose
        NEAR(edge.h, before + r, 1e-13, 0);
        NEAR(edge.w, 0.25 * 1.3, 1e-15, 0);
        NEAR(edge.square, 1, 0, 0);
        NEAR(edge.cube, 1, 0, 0);
        before = r;
    }
}

// the integrals of h, h^2 and h^3 over the whole foil: along the circle, by the rule of rectangles in theta
static void whole(double d, double length, double integral[3]) {
    const int n = 1000000;
    const double r0 = length * (1 - d) / 4, c = r0 * (1 + d);
    for (int p = 0; p < 3; p++) integral[p] = 0;
    for (int i = 0; i < n; i++) {
        double x[2], h = 0;
        for (int side = 0; side < 2; side++) {
            const double theta = pi * (i + side) / n, middle = pi * (i + 0.5) / n;
            const double a = r0 * (cos(theta) + d), b = r0 * sin(theta);
            x[side] = a + c * c * a / (a * a + b * b);
            const double e = r0 * (cos(middle) + d), f = r0 * sin(middle);
            h = 2 * fabs(f - c * c * f / (e * e + f * f));
        }
        for (int p = 0; p < 3; p++) integral[p] += (x[0] - x[1]) * pow(h, p + 1);
    }
}

TEST(means_over_the_edges_add_up_to_the_foil_with_any_number_of_nodes) {
    const double thickness[] = {0.05, 0.2, 0.6, 0.95};
    for (int t = 0; t < 4; t++) {
        double want[3];
        whole(thickness[t], 1.3, want);
        // the area within the mapped circle
        const double d = thickness[t], r0 = 1.3 * (1 - d) / 4, ratio = (1 + d) / (1 - d);
        const double area = pi * r0 * r0 * (ratio * ratio - 1);
        for (int nodes = 4; nodes <= 256; nodes *= 4) {
            const struct fish_parameters fish = foil(nodes, thickness[t], SECTION_MEAN);
            const double l = 1.3 / (nodes - 1);
            double got[3] = {0, 0, 0};
            for (int k = 0; k < nodes - 1; k++) {
                const struct profile_edge edge = profile_edge(&fish, k);
                got[0] += l * edge.h;
                got[1] += l * edge.h * edge.h * edge.square;
                got[2] += l * edge.h * edge.h * edge.h * edge.cube;
                AT_LEAST(edge.square, 1);
                AT_LEAST(edge.cube, edge.square);
            }
            NEAR(got[0], area, 0, 1e-10);
            // error of the rectangles for the thickest foil
            NEAR_ARRAY(3, got, want, 0, 1e-9);
        }
    }
}

TEST(means_are_good_to_ten_figures_next_to_the_blunt_nose) {
    // h = alpha sqrt(s) (1 + beta s + ...) there: h^2 is smooth in s, so Gauss-Legendre in s is exact. The thickness at
    // s follows from an independent bisection in theta
    const struct fish_parameters fish = foil(41, 0.2, SECTION_MEAN);
    const double d = 0.2, r0 = 1.3 * (1 - d) / 4, c = r0 * (1 + d), nose = 2 * r0 * (1 + d * d) / (d - 1);
    const double x[] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831, 0.9061798459386640};
    const double w[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                        0.2369268850561891};
    double mean = 0;
    for (int i = 0; i < 5; i++) {
        const double s = 1.3 / 40 * (1 + x[i]) / 2;
        double low = 0, high = pi, r = 0;
        for (int step = 0; step < 60; step++) {
            const double theta = (low + high) / 2, a = r0 * (cos(theta) + d), b = r0 * sin(theta);
            r = b * (1 - c * c / (a * a + b * b));
            if (a + c * c * a / (a * a + b * b) > nose + s) {
                low = theta;
            } else {
                high = theta;
            }
        }
        mean += w[i] / 2 * 4 * r * r;
    }
    const struct profile_edge edge = profile_edge(&fish, 0);
    NEAR(edge.h * edge.h * edge.square, mean, 0, 1e-10);
}

TEST(uniform_and_table_have_one_section_along_an_edge) {
    for (enum section section = SECTION_MEAN; section <= SECTION_NODES; section++) {
        struct fish_parameters fish = foil(4, 0.1, section);
        fish.body.profile = PROFILE_UNIFORM;
        struct profile_edge edge = profile_edge(&fish, 1);
        NEAR(edge.h, 0.13, 1e-15, 0);
        NEAR(edge.w, 0.325, 1e-15, 0);
        NEAR(edge.square, 1, 0, 0);
        NEAR(profile_tail_thickness(&fish), 0.13, 1e-15, 0);
        double h[] = {0.1, 0.2, 0.3}, w[] = {0.3, 0.2, 0.1};
        fish.body.profile = PROFILE_TABLE;
        fish.body.thickness_table = (struct number_list){.n = 3, .value = h};
        fish.body.depth_table = (struct number_list){.n = 3, .value = w};
        edge = profile_edge(&fish, 1);
        NEAR(edge.h, 0.2, 0, 0);
        NEAR(edge.w, 0.2, 0, 0);
        NEAR(edge.cube, 1, 0, 0);
        NEAR(profile_tail_thickness(&fish), 0.3, 0, 0);
    }
}

// a fish of the test foil with pairs of thickness and depth
static struct fish_parameters measured(int nodes, enum section section, int n, double *h, int m, double *w) {
    struct fish_parameters fish = foil(nodes, 0.1, section);
    fish.body.profile = PROFILE_TABLE;
    fish.body.thickness_table = (struct number_list){.n = n, .value = h, .width = 2};
    fish.body.depth_table = (struct number_list){.n = m, .value = w, .width = 2};
    return fish;
}

TEST(pairs_on_a_line_give_the_means_of_a_wedge) {
    // h = 0.1 + 0.2 s, w = 0.3 - 0.1 s; the middle pair of h is on the line
    double h[] = {0, 0.1, 0.3, 0.16, 1, 0.3}, w[] = {0, 0.3, 1, 0.2};
    for (int nodes = 4; nodes <= 9; nodes += 5) {
        const struct fish_parameters fish = measured(nodes, SECTION_MEAN, 3, h, 2, w);
        for (int k = 0; k + 1 < nodes; k++) {
            const double n = nodes - 1, a = 0.1 + 0.2 * k / n, b = 0.1 + 0.2 * (k + 1) / n;
            const struct profile_edge edge = profile_edge(&fish, k);
            NEAR(edge.h, (a + b) / 2, 1e-14, 0);
            NEAR(edge.square * edge.h * edge.h, (a * a + a * b + b * b) / 3, 1e-13, 0);
            NEAR(edge.cube * edge.h * edge.h * edge.h, (a + b) * (a * a + b * b) / 4, 1e-13, 0);
            NEAR(edge.w, 0.3 - 0.1 * (k + 0.5) / n, 1e-14, 0);
        }
        NEAR(profile_tail_thickness(&fish), 0.3, 0, 0);
    }
}

TEST(the_sections_of_nodes_are_those_of_the_pairs) {
    double h[] = {0, 0.1, 1.0 / 3, 0.4, 2.0 / 3, 0.2, 1, 0.1}, w[] = {0, 0.3, 1, 0.2};
    const struct fish_parameters fish = measured(4, SECTION_NODES, 4, h, 2, w);
    const double means[] = {0.25, 0.3, 0.15};
    for (int k = 0; k < 3; k++) {
        const struct profile_edge edge = profile_edge(&fish, k);
        NEAR(edge.h, means[k], 1e-14, 0);
        NEAR(edge.cube, 1, 0, 0);
    }
}

TEST(values_between_pairs_stay_between_them) {
    // a step, an extremum, and unequal distances, where a spline would exceed the values; the mean over an edge of a
    // monotone interval lies between the values at its ends
    double h[] = {0, 0.1, 0.1, 0.1, 0.15, 0.4, 0.5, 0.4, 0.9, 0.05, 1, 0.06}, w[] = {0, 0.3, 1, 0.3};
    const int n = 400;
    const struct fish_parameters fish = measured(n + 1, SECTION_MEAN, 6, h, 2, w);
    double before = 0.1;
    for (int k = 0; k < n; k++) {
        const struct profile_edge edge = profile_edge(&fish, k);
        const double middle = (k + 0.5) / n;
        assert_true(edge.h >= 0.05 - 1e-15 && edge.h <= 0.4 + 1e-15);
        if (middle < 0.5) assert_true(edge.h >= before - 1e-15);
        if (middle > 0.5 && middle < 0.9) assert_true(edge.h <= before + 1e-15);
        if (middle < 0.1) NEAR(edge.h, 0.1, 1e-14, 0);
        if (middle > 0.15 && middle < 0.5) NEAR(edge.h, 0.4, 1e-14, 0);
        before = edge.h;
    }
}

TEST(mass_and_stiffness_do_not_depend_on_the_nodes) {
    // the sums of <h> and <h^3> over the edges are integrals of the same cubics for any number of edges
    double h[] = {0, 0.02, 0.15, 0.11, 0.5, 0.13, 0.8, 0.05, 1, 0.01}, w[] = {0, 0.3, 1, 0.3};
    double first[2] = {0, 0};
    for (int nodes = 5; nodes <= 40; nodes += 7) {
        const struct fish_parameters fish = measured(nodes, SECTION_MEAN, 5, h, 2, w);
        double sum[2] = {0, 0};
        for (int k = 0; k + 1 < nodes; k++) {
            const struct profile_edge edge = profile_edge(&fish, k);
            sum[0] += edge.h / (nodes - 1);
            sum[1] += edge.cube * edge.h * edge.h * edge.h / (nodes - 1);
        }
        for (int i = 0; i < 2; i++) {
            if (nodes == 5) first[i] = sum[i];
            NEAR(sum[i], first[i], 1e-13, 0);
        }
    }
}

TEST(a_parabola_is_interpolated_to_third_order_at_a_smooth_monotone_place) {
    // h = (s + 0.2)^2: the harmonic mean of secants is a second-order slope
    double error[2];
    for (int r = 0; r < 2; r++) {
        const int n = 11 * (r + 1) - r;
        double h[2 * 22], w[] = {0, 0.3, 1, 0.3};
        for (int i = 0; i < n; i++) {
            h[2 * i] = (double)i / (n - 1);
            h[2 * i + 1] = (h[2 * i] + 0.2) * (h[2 * i] + 0.2);
        }
        const int edges = 997;
        const struct fish_parameters fish = measured(edges + 1, SECTION_NODES, n, h, 2, w);
        error[r] = 0;
        for (int k = 300; k < 700; k++) {
            const double a = (double)k / edges + 0.2, b = (k + 1.0) / edges + 0.2;
            error[r] = fmax(error[r], fabs(profile_edge(&fish, k).h - (a * a + b * b) / 2));
        }
    }
    assert_true(error[0] < 1e-3);
    assert_true(error[0] / error[1] > 6);
}

TEST(a_foil_ends_in_a_cusp_or_with_the_thickness_of_its_tail) {
    struct fish_parameters fish = foil(4, 0.1, SECTION_MEAN);
    NEAR(profile_tail_thickness(&fish), 0, 0, 0);
    fish.body.tail_thickness = 0.03;
    NEAR(profile_tail_thickness(&fish), 0.03 * 1.3, 1e-17, 0);
}

// h of a foil with a cusp, and with a tail thickness, at an arc coordinate over the length: theta by bisection
static double thickness_at(double d, double tail, double length, double sigma) {
    const double r0 = length * (1 - d) / 4, c = r0 * (1 + d), nose = 2 * r0 * (1 + d * d) / (d - 1);
    double low = 0, high = pi, h = 0;
    for (int step = 0; step < 60; step++) {
        const double theta = (low + high) / 2, a = r0 * (cos(theta) + d), b = r0 * sin(theta);
        h = 2 * fabs(b * (1 - c * c / (a * a + b * b)));
        if (a + c * c * a / (a * a + b * b) > nose + sigma * length) {
            low = theta;
        } else {
            high = theta;
        }
    }
    return sqrt(h * h + tail * length * sigma * tail * length * sigma);
}

TEST(a_tail_of_some_thickness_changes_the_whole_outline_smoothly) {
    // nodes: the outline itself
    struct fish_parameters fish = foil(9, 0.2, SECTION_NODES);
    fish.body.tail_thickness = 0.04;
    for (int k = 0; k < 8; k++) {
        const double before = k > 0 ? thickness_at(0.2, 0.04, 1.3, k / 8.0) : 0;
        const double after = k < 7 ? thickness_at(0.2, 0.04, 1.3, (k + 1) / 8.0) : 0.04 * 1.3;
        NEAR(profile_edge(&fish, k).h, (before + after) / 2, 1e-13, 0);
    }
    // mean: over the last edge h^2 of the foil behaves like (1 - sigma)^3: the rule of the trapezoids
    // has an error proportional to the interval squared
    fish.body.section = SECTION_MEAN;
    enum { N = 20000 };
    double mean[3] = {0, 0, 0};
    for (int i = 0; i <= N; i++) {
        const double h = thickness_at(0.2, 0.04, 1.3, (7 + (double)i / N) / 8), weight = (i % N == 0 ? 0.5 : 1.0) / N;
        for (int p = 0; p < 3; p++) mean[p] += weight * pow(h, p + 1);
    }
    const struct profile_edge edge = profile_edge(&fish, 7);
    const double got[3] = {edge.h, edge.h * edge.h * edge.square, edge.h * edge.h * edge.h * edge.cube};
    NEAR_ARRAY(3, got, mean, 0, 1e-9);
}

TEST(means_with_a_tail_are_good_to_twelve_figures_next_to_the_blunt_nose) {
    // h^2 is smooth in s, with a tail as well: Gauss-Legendre in s, exact for degree 9
    struct fish_parameters fish = foil(41, 0.2, SECTION_MEAN);
    fish.body.tail_thickness = 0.04;
    const double x[] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831, 0.9061798459386640};
    const double w[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                        0.2369268850561891};
    double mean = 0;
    for (int i = 0; i < 5; i++) {
        const double h = thickness_at(0.2, 0.04, 1.3, (1 + x[i]) / 2 / 40);
        mean += w[i] / 2 * h * h;
    }
    const struct profile_edge edge = profile_edge(&fish, 0);
    // the arc coordinates of both ends are rounded
    NEAR(edge.h * edge.h * edge.square, mean, 0, 1e-11);
}

TEST(the_masses_of_the_default_body_are_those_of_its_outline) {
    // 1000 kg/m3, length 1 m, width 0.25: with and without a tail
    const double tail[] = {0, 0.04}, mass[] = {30.84, 31.87};
    for (int i = 0; i < 2; i++) {
        struct fish_parameters fish = foil(25, 0.2, SECTION_MEAN);
        fish.length = 1;
        fish.body.tail_thickness = tail[i];
        double sum = 0;
        for (int k = 0; k < 24; k++) sum += 1000 * pi / 4 * profile_edge(&fish, k).h * 0.25 / 24;
        NEAR(sum, mass[i], 0.006, 0);
    }
}
