/* test_outline.c: Tests the outline of bodies whose shape is known. */
#include <math.h>
#include <string.h>

#include "near.h"
#include "school.h"
#include "view/outline.h"

enum { MAX_NODES = 33 };

/* A straight body along x of length 1, tail at the right, with the thickness of an ellipse: the mean over each edge, or
 * the sum of the half thicknesses at its ends. */
static void fill_ellipse(int n_nodes, bool is_mean, double *nodes, double *thickness) {
    enum { PARTS = 2000 };
    const double d = 0.2;
    for (int k = 0; k < n_nodes; k++) {
        nodes[2 * k] = (double)k / (n_nodes - 1);
        nodes[2 * k + 1] = 0;
    }
    for (int k = 0; k < n_nodes - 1; k++) {
        const double from = nodes[2 * k], to = nodes[2 * k + 2];
        thickness[k] = d * (sqrt(from * (1 - from)) + sqrt(to * (1 - to)));
        if (!is_mean) continue;
        thickness[k] = 0;
        // midpoints in the angle, in which the integrand is smooth
        const double first = acos(1 - 2 * from), last = acos(1 - 2 * to), step = (last - first) / PARTS;
        for (int i = 0; i < PARTS; i++) {
            const double angle = first + (i + 0.5) * step;
            thickness[k] += d * sin(angle) * sin(angle) / 2 * step / (to - from);
        }
    }
}

static void is_an_ellipse(int n, bool is_mean, double tolerance) {
    double nodes[2 * MAX_NODES], thickness[MAX_NODES], polygon[2 * OUTLINE_SIDES];
    fill_ellipse(n, is_mean, nodes, thickness);
    const struct outline outline = outline_create(test_arena(), n, thickness, is_mean);
    outline_polygon(&outline, nodes, polygon);
    for (int i = 0; i < OUTLINE_SIDES; i++) {
        const double q = polygon[2 * i], side = i < OUTLINE_POINTS ? 1 : -1;
        if (i > 0 && q > 1 - 2.0 / (n - 1)) continue;
        NEAR(polygon[2 * i + 1], side * 0.2 * sqrt(fmax(0, q * (1 - q))), tolerance, 0);
    }
    // on the left side, seen from tail to nose, and ends in the nodes
    NEAR(polygon[0], 0, 1e-15, 0);
    NEAR(polygon[2 * OUTLINE_POINTS - 2], 1, 1e-15, 0);
}

// but for the last two edges: a round tail is not known from mean thicknesses
TEST(an_ellipse_stays_one) {
    for (int is_mean = 0; is_mean < 2; is_mean++) {
        is_an_ellipse(9, is_mean, 2e-3);
        is_an_ellipse(MAX_NODES, is_mean, 1e-3);
    }
}

/* The default body: a Joukowski foil whose tail has a thickness (doc/model.md, section 1), over the arc coordinate. */
static double default_half_thickness(double s) {
    const double d = 0.1, b = 0.04, r0 = (1 - d) / 4, c = r0 * (1 + d), nose = 2 * r0 * (1 + d * d) / (d - 1);
    double low = 0, high = M_PI, r = 0;
    for (int i = 0; i < 60; i++) {
        const double angle = (low + high) / 2, x = r0 * (cos(angle) + d), y = r0 * sin(angle), square = x * x + y * y;
        r = y - c * c * y / square;
        if (x + c * c * x / square > nose + s)
            low = angle;
        else
            high = angle;
    }
    return sqrt(4 * r * r + b * b * s * s) / 2;
}

TEST(the_tail_of_the_default_fish_has_no_knob) {
    enum { N = 25, PARTS = 400 };
    double nodes[2 * N], thickness[N - 1], polygon[2 * OUTLINE_SIDES];
    for (int k = 0; k < N; k++) {
        nodes[2 * k] = (double)k / (N - 1);
        nodes[2 * k + 1] = 0;
    }
    for (int k = 0; k < N - 1; k++) {
        thickness[k] = 0;
        for (int i = 0; i < PARTS; i++)
            thickness[k] += 2 * default_half_thickness((k + (i + 0.5) / PARTS) / (N - 1)) / PARTS;
    }
    const struct outline outline = outline_create(test_arena(), N, thickness, true);
    outline_polygon(&outline, nodes, polygon);
    for (int i = 0; i < OUTLINE_POINTS - 1; i++)
        NEAR(polygon[2 * i + 1], default_half_thickness(polygon[2 * i]), 2e-4, 0);
    NEAR(polygon[2 * OUTLINE_POINTS - 3], 0.02, 2e-4, 0);
}

// a parabola over the angle, which is the square of the ratio of half thickness to sine at the middle of every edge,
// stays one between the second edge and the last but one
TEST(a_ratio_that_is_a_parabola_stays_one) {
    enum { N = 9 };
    double nodes[2 * N], thickness[N - 1], knot[N - 1], polygon[2 * OUTLINE_SIDES];
    for (int k = 0; k < N; k++) {
        nodes[2 * k] = (double)k / (N - 1);
        nodes[2 * k + 1] = 0;
    }
    for (int k = 0; k < N - 1; k++) {
        const double from = acos(1 - nodes[2 * k]), to = acos(1 - nodes[2 * k + 2]);
        knot[k] = acos((cos(from) + cos(to)) / 2);
        thickness[k] = 0.1 * sqrt(1 + 0.3 * knot[k] - 0.2 * knot[k] * knot[k]) * (sin(from) + sin(to));
    }
    const struct outline outline = outline_create(test_arena(), N, thickness, false);
    outline_polygon(&outline, nodes, polygon);
    int n = 0;
    for (int i = 0; i < OUTLINE_POINTS; i++) {
        const double angle = acos(1 - polygon[2 * i]);
        if (angle < knot[1] || angle > knot[N - 3]) continue;
        NEAR(polygon[2 * i + 1], 0.1 * sin(angle) * sqrt(1 + 0.3 * angle - 0.2 * angle * angle), 1e-12, 0);
        n++;
    }
    AT_LEAST(n, 8);
}

TEST(the_middle_line_is_the_smooth_curve) {
    // nodes on an arc of one radian: the curve of order 4 through 17 nodes is the circle to 1e-6
    enum { N = 17 };
    double nodes[2 * N], thickness[N], polygon[2 * OUTLINE_SIDES];
    for (int k = 0; k < N; k++) {
        nodes[2 * k] = cos((double)k / (N - 1));
        nodes[2 * k + 1] = sin((double)k / (N - 1));
        thickness[k] = 0.1;
    }
    const struct outline outline = outline_create(test_arena(), N, thickness, false);
    outline_polygon(&outline, nodes, polygon);
    for (int i = 1; i < OUTLINE_POINTS - 1; i++) {
        const int other = OUTLINE_SIDES - i;
        NEAR(outline_part(other), outline_part(i), 0, 0);
        const double left = hypot(polygon[2 * i], polygon[2 * i + 1]);
        const double right = hypot(polygon[2 * other], polygon[2 * other + 1]);
        NEAR((left + right) / 2, 1, 1e-5, 0);
        NEAR(right - left, 2 * outline.half[i], 1e-9, 0);
    }
}

TEST(a_body_in_one_point_has_an_outline) {
    double nodes[2 * MAX_NODES], thickness[MAX_NODES], polygon[2 * OUTLINE_SIDES];
    fill_ellipse(5, true, nodes, thickness);
    memset(nodes, 0, sizeof nodes);
    const struct outline outline = outline_create(test_arena(), 5, thickness, true);
    outline_polygon(&outline, nodes, polygon);
    for (int i = 0; i < 2 * OUTLINE_SIDES; i++) NEAR(polygon[i], 0, 0, 0);
}
