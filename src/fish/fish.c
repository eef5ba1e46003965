/* fish.c: quantities that follow from the constants of a fish. */
#include "fish/fish.h"

#include <math.h>

#include "base/mathematics.h"

double fish_mass_mean(const struct fish *fish, const double *value) {
    double sum = 0;
    for (int k = 0; k < fish->n_nodes; k++) sum += fish->mass[k] * value[k];
    return sum / fish->total_mass;
}

struct direction fish_direction_of(const double vector[2]) {
    struct direction direction = {.length = sqrt(vector[0] * vector[0] + vector[1] * vector[1])};
    direction.t[0] = vector[0] / direction.length;
    direction.t[1] = vector[1] / direction.length;
    direction.n[0] = -direction.t[1];
    direction.n[1] = direction.t[0];
    return direction;
}

struct direction fish_direction(const struct fish *fish, const struct tangent *tangent, const double *y) {
    const double *const x = y + fish->at.x, *const z = y + fish->at.y;
    const double e[2] = {fish_mean(&tangent->to, x) - fish_mean(&tangent->from, x),
                         fish_mean(&tangent->to, z) - fish_mean(&tangent->from, z)};
    return fish_direction_of(e);
}

const struct fish *fish_first_beating(const struct school *school) {
    for (int f = 0; f < school->n_fish; f++) {
        if (school->fish[f].period > 0) return &school->fish[f];
    }
    return NULL;
}

bool fish_has_wave(const struct fish *fish) {
    bool has = fish->n_harmonics > 0;
    for (int j = 0; j < fish->n_joints; j++) has |= fabs(fish->wave_amplitude[j]) > 0;
    return has && fish->omega > 0 && fish->motion.prescribed != PRESCRIBED_ALL;
}

double fish_rate(const struct school *school, const struct fish *fish) {
    if (fish->frequency > 0) return fish->frequency;
    const double drift = hypot(school->velocity[0], school->velocity[1]);
    const double speed = fmax(fmax(fabs(fish->start_speed), fabs(fish->motion.speed)), drift);
    return speed > 0 ? speed / fish->length : 1;
}

// ---- distances of points and segments

// distance of the point p from the segment a b
static double point_to_segment(const double p[2], const double a[2], const double b[2]) {
    const double e[2] = {b[0] - a[0], b[1] - a[1]}, r[2] = {p[0] - a[0], p[1] - a[1]};
    const double square = e[0] * e[0] + e[1] * e[1];
    double q = square > 0 ? (r[0] * e[0] + r[1] * e[1]) / square : 0;
    q = fmin(1, fmax(0, q));
    const double d[2] = {r[0] - q * e[0], r[1] - q * e[1]};
    return sqrt(d[0] * d[0] + d[1] * d[1]);
}

double fish_point_distance(const struct fish *fish, const double *y, const double p[2]) {
    double min = INFINITY;
    for (int k = 0; k < fish->n_edges; k++) {
        const double a[2] = {y[fish->at.x + k], y[fish->at.y + k]};
        const double b[2] = {y[fish->at.x + k + 1], y[fish->at.y + k + 1]};
        min = fmin(min, point_to_segment(p, a, b) - fish->thickness[k] / 2);
    }

    return min;
}

double fish_walls_distance(const struct walls *walls, double y) {
    double distance = INFINITY;
    for (int i = 0; i < walls->n; i++) distance = fmin(distance, walls->inward[i] * (y - walls->y[i]));
    return distance;
}

double fish_wall_distance(const struct school *school, const struct fish *fish, const double *y, int *wall) {
    const struct walls *const walls = &school->walls;
    double min = INFINITY;
    for (int k = 0; k < fish->n_nodes; k++) {
        // the thicker edge at the node
        const double before = k > 0 ? fish->thickness[k - 1] : 0, after = k < fish->n_edges ? fish->thickness[k] : 0;
        for (int w = 0; w < walls->n; w++) {
            const double gap = walls->inward[w] * (y[fish->at.y + k] - walls->y[w]) - fmax(before, after) / 2;
            if (!(gap < min)) continue;
            min = gap;
            if (wall) *wall = w;
        }
    }

    return min;
}

double fish_distance(const struct fish *a, const struct fish *b, const double *y, double limit) {
    // the boxes around the bodies exclude most pairs of a school
    const struct box box = box_around(a->n_nodes, y + a->at.x, y + a->at.y),
                     other = box_around(b->n_nodes, y + b->at.x, y + b->at.y);

    double thickest[2] = {0, 0};
    for (int i = 0; i < a->n_edges; i++) thickest[0] = fmax(thickest[0], a->thickness[i] / 2);
    for (int j = 0; j < b->n_edges; j++) thickest[1] = fmax(thickest[1], b->thickness[j] / 2);
    if (box_gap(&box, &other) - thickest[0] - thickest[1] > limit) return INFINITY;

    double min = INFINITY, farthest = limit; /* the smaller one of min and limit */
    for (int i = 0; i < a->n_edges; i++) {
        const double p[2] = {y[a->at.x + i], y[a->at.y + i]}, q[2] = {y[a->at.x + i + 1], y[a->at.y + i + 1]};
        const double length = fabs(q[0] - p[0]) + fabs(q[1] - p[1]);
        for (int j = 0; j < b->n_edges; j++) {
            const double r[2] = {y[b->at.x + j], y[b->at.y + j]}, s[2] = {y[b->at.x + j + 1], y[b->at.y + j + 1]};
            const double thickness = (a->thickness[i] + b->thickness[j]) / 2;

            // every point of an edge is within half of the edge length of the middle; all twice
            const double reach = 2 * (farthest + thickness) + length + fabs(s[0] - r[0]) + fabs(s[1] - r[1]);
            const double dx = r[0] + s[0] - (p[0] + q[0]), dy = r[1] + s[1] - (p[1] + q[1]);
            if (dx * dx + dy * dy > reach * reach) continue;
            const double apart = fmin(fmin(point_to_segment(p, r, s), point_to_segment(q, r, s)),
                                      fmin(point_to_segment(r, p, q), point_to_segment(s, p, q)));
            min = fmin(min, (segments_cross(p, q, r, s) ? 0 : apart) - thickness);
            farthest = fmin(min, limit);
        }
    }

    return fmax(0, min);
}
