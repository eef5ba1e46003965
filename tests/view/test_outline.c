/* test_outline.c: the outline of bodies whose shape is known. */
#include <math.h>
#include <string.h>

#include "near.h"
#include "school.h"
#include "view/outline.h"

const bool school_small = true;

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
        NEAR(polygon[2 * i + 1], side * 0.2 * sqrt(fmax(0, q * (1 - q))), tolerance, 0);
    }
    // on the left side, seen from tail to nose, and ends in the nodes
    NEAR(polygon[0], 0, 1e-15, 0);
    NEAR(polygon[2 * OUTLINE_POINTS - 2], 1, 1e-15, 0);
}

TEST(an_ellipse_stays_one) {
    for (int n = 4; n <= MAX_NODES; n += 29) {
        is_an_ellipse(n, false, 1e-12);
        is_an_ellipse(n, true, 1e-7);  // the error of the midpoints
    }
}

// the half thickness over the angle is a sine times a slope that is even about nose and tail, as in a mirror
TEST(an_egg_stays_one) {
    double nodes[2 * MAX_NODES], thickness[MAX_NODES], half[MAX_NODES], polygon[2 * OUTLINE_SIDES];
    for (int k = 0; k < MAX_NODES; k++) {
        const double q = (double)k / (MAX_NODES - 1), angle = acos(1 - 2 * q);
        nodes[2 * k] = q;
        nodes[2 * k + 1] = 0;
        half[k] = 0.1 * sin(angle) * (1 + 0.4 * cos(angle));
        if (k > 0) thickness[k - 1] = half[k - 1] + half[k];
    }
    const struct outline outline = outline_create(test_arena(), MAX_NODES, thickness, false);
    outline_polygon(&outline, nodes, polygon);
    double worst = 0;
    for (int i = 0; i < OUTLINE_POINTS; i++) {
        const double angle = acos(1 - 2 * polygon[2 * i]);
        worst = fmax(worst, fabs(polygon[2 * i + 1] - 0.1 * sin(angle) * (1 + 0.4 * cos(angle))));
    }
    BELOW(worst, 5e-4);
}

// a parabola over the angle, which is the ratio of half thickness to sine at the middle of every edge, stays one
// between the second edge and the last but one
TEST(a_ratio_that_is_a_parabola_stays_one) {
    enum { N = 9 };
    double nodes[2 * N], thickness[N - 1], knot[N - 1], polygon[2 * OUTLINE_SIDES];
    for (int k = 0; k < N; k++) {
        nodes[2 * k] = (double)k / (N - 1);
        nodes[2 * k + 1] = 0;
    }
    for (int k = 0; k < N - 1; k++) {
        const double from = acos(1 - 2 * nodes[2 * k]), to = acos(1 - 2 * nodes[2 * k + 2]);
        knot[k] = acos((cos(from) + cos(to)) / 2);
        thickness[k] = 0.1 * (1 + 0.3 * knot[k] - 0.2 * knot[k] * knot[k]) * (sin(from) + sin(to));
    }
    const struct outline outline = outline_create(test_arena(), N, thickness, false);
    outline_polygon(&outline, nodes, polygon);
    int n = 0;
    for (int i = 0; i < OUTLINE_POINTS; i++) {
        const double angle = acos(1 - 2 * polygon[2 * i]);
        if (angle < knot[1] || angle > knot[N - 3]) continue;
        NEAR(polygon[2 * i + 1], 0.1 * sin(angle) * (1 + 0.3 * angle - 0.2 * angle * angle), 1e-12, 0);
        n++;
    }
    AT_LEAST(n, 8);
}

// thicknesses in reverse order give the half thickness in reverse order
TEST(nose_and_tail_are_interpolated_alike) {
    static const double thickness[] = {0.02, 0.09, 0.16, 0.11, 0.05}, reversed[] = {0.05, 0.11, 0.16, 0.09, 0.02};
    for (int is_mean = 0; is_mean < 2; is_mean++) {
        const struct outline one = outline_create(test_arena(), 6, thickness, is_mean);
        const struct outline other = outline_create(test_arena(), 6, reversed, is_mean);
        for (int i = 0; i < OUTLINE_POINTS; i++) NEAR(other.half[i], one.half[OUTLINE_POINTS - 1 - i], 1e-14, 0);
    }
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
        assert_int_equal(outline_point(other), i);
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
