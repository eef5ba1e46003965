/* outline.c: weights of the nodes at each point, and the thickness between the edges. */
#include "view/outline.h"

#include <math.h>

#include "fish/shape.h"

/* Half thickness at the points. As a function of the angle whose cosine is the coordinate along the body, the half
 * thickness of a blunt nose is as smooth as a sine. Interpolate the ratio of half thickness to sine, continued
 * symmetrically at both ends. knot, ratio and slope have room for n_nodes + 3. */
static void interpolate_half(const struct outline *outline, const double *thickness, bool is_mean, double *knot,
                             double *ratio, double *slope) {
    const int n_edges = outline->n_nodes - 1, n = n_edges + 4;
    for (int k = 0; k < n_edges; k++) {
        const double from = acos(1 - 2.0 * k / n_edges), to = acos(1 - 2.0 * (k + 1) / n_edges);
        knot[k + 2] = acos((cos(from) + cos(to)) / 2);

        // the thickness of this edge for a half thickness equal to the sine; along the body ds = sin(angle)/2 d angle
        const double mean = ((to - sin(2 * to) / 2) - (from - sin(2 * from) / 2)) / (cos(from) - cos(to));
        ratio[k + 2] = thickness[k] / (is_mean ? mean : sin(from) + sin(to));
    }

    for (int k = 0; k < 2; k++) {
        knot[1 - k] = -knot[2 + k];
        ratio[1 - k] = ratio[2 + k];
        knot[n - 2 + k] = 2 * M_PI - knot[n - 3 - k];
        ratio[n - 2 + k] = ratio[n - 3 - k];
    }

    // slopes of the parabolas through three points
    for (int k = 1; k < n - 1; k++) {
        const double left = knot[k] - knot[k - 1], right = knot[k + 1] - knot[k];
        const double before = (ratio[k] - ratio[k - 1]) * right / left,
                     after = (ratio[k + 1] - ratio[k]) * left / right;
        slope[k] = (before + after) / (left + right);
    }

    for (int i = 0, k = 1; i < OUTLINE_POINTS; i++) {
        const double angle = M_PI * i / (OUTLINE_POINTS - 1);
        while (k < n - 3 && angle > knot[k + 1]) k++;

        // the cubic between knots k and k + 1
        const double length = knot[k + 1] - knot[k], q = (angle - knot[k]) / length, p = 1 - q;
        const double at_angle = (1 + 2 * q) * p * p * ratio[k] + q * p * p * length * slope[k] +
                                q * q * (3 - 2 * q) * ratio[k + 1] - q * q * p * length * slope[k + 1];
        outline->half[i] = fmax(0, sin(angle) * at_angle);
    }

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
        const double part = (1 - cos(M_PI * i / (OUTLINE_POINTS - 1))) / 2;
        const double u = i < OUTLINE_POINTS - 1 ? part * (n - 1) : n - 1;
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

int outline_point(int i) {
    return i < OUTLINE_POINTS ? i : OUTLINE_SIDES - i;
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
