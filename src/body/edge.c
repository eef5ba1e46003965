/* edge.c: from the unknowns of two nodes to the edge between these nodes. */
#include "body/edge.h"

#include <math.h>

struct edge edge_at(const struct fish *fish, int k, const double *y) {
    const double *const x = y + fish->at.x + k, *const z = y + fish->at.y + k;
    const double *const vx = y + fish->at.vx + k, *const vy = y + fish->at.vy + k;
    const double *const ax = y + fish->at.ax + k, *const ay = y + fish->at.ay + k;
    const double e[2] = {x[1] - x[0], z[1] - z[0]};

    struct edge edge = {.length = sqrt(e[0] * e[0] + e[1] * e[1]),
                        .middle = {(x[0] + x[1]) / 2, (z[0] + z[1]) / 2},
                        .velocity = {(vx[0] + vx[1]) / 2, (vy[0] + vy[1]) / 2},
                        .acceleration = {(ax[0] + ax[1]) / 2, (ay[0] + ay[1]) / 2},
                        .rate = {vx[1] - vx[0], vy[1] - vy[0]}};

    edge.t[0] = e[0] / edge.length;
    edge.t[1] = e[1] / edge.length;
    edge.n[0] = -edge.t[1];
    edge.n[1] = edge.t[0];

    return edge;
}

double edge_turn_rate(const struct edge *edge) {
    return edge_dot(edge->n, edge->rate) / edge->length;
}

double edge_dot(const double a[2], const double b[2]) {
    return a[0] * b[0] + a[1] * b[1];
}

struct bend edge_bend(const double before[2], const double after[2]) {
    const double sine = before[0] * after[1] - before[1] * after[0];
    const double angle = atan2(sine, edge_dot(before, after));
    struct bend bend = {.curvature = 2 * tan(angle / 2), .slope = 2 / (1 + cos(angle))};
    bend.second = bend.slope * bend.curvature / 2;
    return bend;
}

int edge_place(const struct fish *fish, int i, int node) {
    return (i == 0 ? fish->at.x : fish->at.y) + node;
}
int edge_velocity(const struct fish *fish, int i, int node) {
    return (i == 0 ? fish->at.vx : fish->at.vy) + node;
}
int edge_acceleration(const struct fish *fish, int i, int node) {
    return (i == 0 ? fish->at.ax : fish->at.ay) + node;
}
