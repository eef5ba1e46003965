/* outline.c: the weights of the nodes at each point of the outline, and the thickness between the edges. */
#include "view/outline.h"

#include <math.h>

#include "fish/shape.h"

double outline_part(int i) {
    const int along = i < OUTLINE_POINTS ? i : OUTLINE_SIDES - i;
    return (1 - cos(M_PI * along / (OUTLINE_POINTS - 1))) / 2;
}

/* Half thickness at the points. Near a blunt nose the square of the thickness grows in proportion to the distance, as
 * on a quarter of an ellipse that rises from the nose to the tail: sin(angle) with cos(angle) = 1 - s. What is
 * interpolated over the angle is the square of the ratio of both. It is even about the nose; at the tail, which may be
 * blunt, pointed or round, it is continued in proportion to s. knot, ratio and slope have room for n_nodes + 3. */
static void interpolate_half(const struct outline *outline, const double *thickness, bool is_mean, double *knot,
                             double *ratio, double *slope) {
    const int n_edges = outline->n_nodes - 1, first = 1, last = n_edges, n = n_edges + 3;
    for (int k = 0; k < n_edges; k++) {
        const double from = acos(1 - (double)k / n_edges), to = acos(1 - (k + 1.0) / n_edges);
        knot[first + k] = acos((cos(from) + cos(to)) / 2);

        // the thickness of this edge for a half thickness equal to the sine; along the body ds = sin(angle) d angle
        const double mean = ((to - sin(2 * to) / 2) - (from - sin(2 * from) / 2)) / (cos(from) - cos(to));
        const double part = thickness[k] / (is_mean ? mean : sin(from) + sin(to));
        ratio[first + k] = part * part;
    }

    knot[0] = -knot[first];
    ratio[0] = ratio[first];
    const double at_last = 1 - cos(knot[last]), at_other = 1 - cos(knot[last - 1]);
    const double rise = (ratio[last] - ratio[last - 1]) / (at_last - at_other) * (1 - at_last);
    knot[last + 1] = M_PI / 2;
    ratio[last + 1] = fmax(0, ratio[last] + rise);
    knot[last + 2] = M_PI - knot[last];
    ratio[last + 2] = 2 * ratio[last + 1] - ratio[last];

    // slopes of the parabolas through three points
    for (int k = 1; k < n - 1; k++) {
        const double left = knot[k] - knot[k - 1], right = knot[k + 1] - knot[k];
        const double before = (ratio[k] - ratio[k - 1]) * right / left,
                     after = (ratio[k + 1] - ratio[k]) * left / right;
        slope[k] = (before + after) / (left + right);
    }

    for (int i = 0, k = 0; i < OUTLINE_POINTS; i++) {
        const double angle = acos(1 - outline_part(i));
        while (k < last && angle > knot[k + 1]) k++;

        // the cubic between knots k and k + 1
        const double length = knot[k + 1] - knot[k], q = (angle - knot[k]) / length, p = 1 - q;
        const double at_angle = (1 + 2 * q) * p * p * ratio[k] + q * p * p * length * slope[k] +
                                q * q * (3 - 2 * q) * ratio[k + 1] - q * q * p * length * slope[k + 1];
        outline->half[i] = sin(angle) * sqrt(fmax(0, at_angle));
    }

    // the polygon begins in the nose and turns in the tail
    outline->half[0] = outline->half[OUTLINE_POINTS - 1] = 0;
}

struct outline outline_create(struct arena *arena, int n_nodes, const double *thickness, bool is_mean) {
    const int n = n_nodes;
    struct outline outline = {.n_nodes = n};
    NEW(arena, outline.weight, n * OUTLINE_POINTS);
    NEW(arena, outline.slope, n * OUTLINE_POINTS);
    NEW(arena, outline.half, OUTLINE_POINTS);

    // weights of the nodes
    struct arena *const temporary = arena_create(arena, "the line of a body");
    struct curve *const curve = curve_create(temporary, n, 0, 2 * OUTLINE_POINTS);
    for (int i = 0; i < OUTLINE_POINTS; i++) {
        // the last point is the last node, however the cosine is rounded
        const double u = i < OUTLINE_POINTS - 1 ? outline_part(i) * (n - 1) : n - 1;
        const struct stencil point = curve_smooth_point(curve, u), slope = curve_smooth_slope(curve, u);
        for (int k = 0; k < n; k++) {
            outline.weight[i * n + k] = point.weight[k];
            outline.slope[i * n + k] = slope.weight[k];
        }
    }

    arena_free(temporary);

    // thickness between the edges
    double *scratch;
    NEW(arena, scratch, 3 * (n + 3));
    interpolate_half(&outline, thickness, is_mean, scratch, scratch + n + 3, scratch + 2 * (n + 3));
    return outline;
}

void outline_polygon(const struct outline *outline, const double *nodes, double *polygon) {
    for (int i = 0; i < OUTLINE_POINTS; i++) {
        double x = 0, y = 0, dx = 0, dy = 0;
        for (int k = 0; k < outline->n_nodes; k++) {
            const double weight = outline->weight[i * outline->n_nodes + k];
            const double slope = outline->slope[i * outline->n_nodes + k];
            x += weight * nodes[2 * k];
            y += weight * nodes[2 * k + 1];
            dx += slope * nodes[2 * k];
            dy += slope * nodes[2 * k + 1];
        }
        const double length = hypot(dx, dy), half = length > 0 ? outline->half[i] / length : 0;
        polygon[2 * i] = x - half * dy;
        polygon[2 * i + 1] = y + half * dx;
        if (i == 0 || i == OUTLINE_POINTS - 1) continue;
        const int other = OUTLINE_SIDES - i;
        polygon[2 * other] = x + half * dy;
        polygon[2 * other + 1] = y - half * dx;
    }
}
