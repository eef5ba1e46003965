/* self_crossing.c: fold test at every joint; beyond half a turn, all pairs of segments of line and outline. */
#include "contact/self_crossing.h"

#include <math.h>

#include "body/edge.h"

static const double pi = 3.14159265358979323846;

/* n points (x, y), joined by segments; a closed line has a segment from the last point to the first. */
struct line {
    int n, is_closed;
    const double *point; /* (n, 2) */
};

// twice the signed area of a triangle, positive for a left turn
static double triangle_area(const double *a, const double *b, const double *c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static int segments_cross(const double *a, const double *b, const double *c, const double *d) {
    return triangle_area(a, b, c) * triangle_area(a, b, d) < 0 && triangle_area(c, d, a) * triangle_area(c, d, b) < 0;
}

// whether two segments that share no point cross
static int line_crosses(const struct line *line) {
    const int n_segments = line->is_closed ? line->n : line->n - 1;
    for (int i = 0; i < n_segments; i++) {
        const double *const a = line->point + 2 * i, *const b = line->point + 2 * ((i + 1) % line->n);
        // the first and the last segment of a closed line share a point
        const int end = i == 0 && line->is_closed ? n_segments - 1 : n_segments;
        for (int j = i + 2; j < end; j++) {
            if (segments_cross(a, b, line->point + 2 * j, line->point + 2 * ((j + 1) % line->n))) return 1;
        }
    }

    return 0;
}

// Whether the inner side of a joint is folded; *turn is the angle between the two edges. The inner side has length 0 if
// the radius of curvature, length/(2 tan(turn/2)), is half the thickness.
static int joint_is_folded(const struct fish *fish, int joint, const struct edge *before, const struct edge *after,
                           double *turn) {
    *turn = atan2(before->t[0] * after->t[1] - before->t[1] * after->t[0], edge_dot(before->t, after->t));
    const double half = (fish->thickness[joint] + fish->thickness[joint + 1]) / 4;
    return 2 * half * fabs(tan(*turn / 2)) > (before->length + after->length) / 2;
}

// test the centre line, then the outline: along the left side to the tail, back along the right side
static int all_segments_cross(const struct fish *fish, const double *y, double *scratch) {
    const int n = fish->n_nodes;
    for (int k = 0; k < n; k++) {
        scratch[2 * k] = y[edge_place(fish, 0, k)];
        scratch[2 * k + 1] = y[edge_place(fish, 1, k)];
    }

    if (line_crosses(&(struct line){n, 0, scratch})) return 1;
    for (int k = 1; k < n - 1; k++) {
        const struct edge before = edge_at(fish, k - 1, y), after = edge_at(fish, k, y);
        const double normal[2] = {before.n[0] + after.n[0], before.n[1] + after.n[1]};
        const double length = hypot(normal[0], normal[1]), half = (fish->thickness[k - 1] + fish->thickness[k]) / 4;

        for (int i = 0; i < 2 && length > 0; i++) {
            const double side = half * normal[i] / length;
            scratch[2 * (2 * n - 2 - k) + i] = scratch[2 * k + i] - side;
            scratch[2 * k + i] += side;
        }
    }

    return line_crosses(&(struct line){2 * n - 2, 1, scratch});
}

int self_crossing(const struct fish *fish, const double *y, double *scratch) {
    double angle = 0, low = 0, high = 0;
    struct edge before = edge_at(fish, 0, y);
    for (int k = 1; k < fish->n_edges; k++) {
        const struct edge after = edge_at(fish, k, y);
        double turn;
        if (joint_is_folded(fish, k - 1, &before, &after, &turn)) return 1;
        angle += turn;
        low = fmin(low, angle);
        high = fmax(high, angle);
        before = after;
    }

    // a line with all directions within half a turn advances along the mean direction and cannot cross; so do the sides
    return high - low >= pi && all_segments_cross(fish, y, scratch);
}

void self_crossing_remember(const struct school *school, struct state *state, double *scratch) {
    for (int f = 0; f < school->n_fish && state->crossed < 0; f++) {
        if (!self_crossing(&school->fish[f], state->y, scratch)) continue;
        state->crossed = f;
        state->crossed_t = state->t;
    }
}
