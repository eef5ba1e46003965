/* profile.c: the Joukowski outline as a function of the circle angle, smooth up to both tips. */
#include "fish/profile.h"

#include <math.h>

#include "base/mathematics.h"

static const double pi = 3.14159265358979323846;

/* zeta = r0 (exp(i theta) + d), z = zeta + c^2/zeta: the nose is at theta = pi, the tail at 0. */
struct joukowski {
    double r0, c, d, nose;
    double length, tail; /* thickness at the tail, m */
};

static struct joukowski joukowski(const struct fish_parameters *fish) {
    const double length = fish->length, d = fish->body.thickness, r0 = length * (1 - d) / 4;
    return (struct joukowski){.r0 = r0,
                              .c = r0 * (1 + d),
                              .d = d,
                              .nose = 2 * r0 * (1 + d * d) / (d - 1),
                              .length = length,
                              .tail = fish->body.tail_thickness * length};
}

// the chord coordinate, decreasing from tail to nose
static double joukowski_chord(const struct joukowski *foil, double theta) {
    const double re = foil->r0 * (cos(theta) + foil->d), im = foil->r0 * sin(theta), c = foil->c;
    return re * (1 + c * c / (re * re + im * im));
}

// the angle of the point at arc coordinate s
static double joukowski_angle(const struct joukowski *foil, double s) {
    // from tail (theta = 0) to nose (theta = pi): bisect to adjacent floating-point numbers
    double low = 0, high = pi;
    for (;;) {
        const double theta = (low + high) / 2;
        if (theta <= low || theta >= high) break;
        if (joukowski_chord(foil, theta) > foil->nose + s) {
            low = theta;
        } else {
            high = theta;
        }
    }

    return (low + high) / 2;
}

// half of h: the cusped foil plus the wedge of the tail thickness
static double joukowski_half_thickness(const struct joukowski *foil, double theta) {
    const double re = foil->r0 * (cos(theta) + foil->d), im = foil->r0 * sin(theta), c = foil->c;
    const double sigma = (joukowski_chord(foil, theta) - foil->nose) / foil->length;
    const double cusp = im * (1 - c * c / (re * re + im * im)), wedge = foil->tail / 2 * sigma;
    return sqrt(cusp * cusp + wedge * wedge);
}

// minus ds/dtheta
static double joukowski_stretch(const struct joukowski *foil, double theta) {
    const double r0 = foil->r0, c = foil->c;
    const double re = r0 * (cos(theta) + foil->d), im = r0 * sin(theta), square = re * re + im * im;
    return im * (1 + c * c / square) - re * c * c * 2 * r0 * foil->d * im / (square * square);
}

// the means of h, h^2, h^3 between two arc coordinates: quadrature in theta, doubling the number of pieces until
// convergence
static void joukowski_means(const struct joukowski *foil, double from, double to, double mean[3]) {
    enum { N = 16, MOST_PIECES = 4096 };
    double node[N], weight[N];
    quadrature_legendre(N, node, weight);
    const double first = from > 0 ? joukowski_angle(foil, from) : pi, last = joukowski_angle(foil, to),
                 span = first - last;
    double before[3] = {0, 0, 0};

    for (int pieces = 1; pieces <= MOST_PIECES; pieces *= 2) {
        double change = 0;
        for (int p = 0; p < 3; p++) mean[p] = 0;
        for (int i = 0; i < pieces * N; i++) {
            const double theta = last + span * (i / N + node[i % N]) / pieces;
            const double h = 2 * joukowski_half_thickness(foil, theta);
            const double part = weight[i % N] * span / pieces * joukowski_stretch(foil, theta) / (to - from);
            mean[0] += part * h;
            mean[1] += part * h * h;
            mean[2] += part * h * h * h;
        }

        for (int p = 0; p < 3; p++) {
            change = fmax(change, fabs(mean[p] - before[p]) / mean[p]);
            before[p] = mean[p];
        }

        // rounding of the arc coordinates behind the angles
        if (change < 1e-12) return;
    }
}

static struct profile_edge joukowski_edge(const struct fish_parameters *fish, int k) {
    const int n_edges = fish->nodes - 1;
    const double edge_length = fish->length / n_edges, from = k * edge_length, to = (k + 1) * edge_length;
    const struct joukowski foil = joukowski(fish);
    struct profile_edge edge = {.w = fish->body.depth * fish->length, .square = 1, .cube = 1};

    if (fish->body.section == SECTION_MEAN) {
        double mean[3];
        joukowski_means(&foil, from, k + 1 < n_edges ? to : fish->length, mean);
        edge.h = mean[0];
        edge.square = mean[1] / (mean[0] * mean[0]);
        edge.cube = mean[2] / (mean[0] * mean[0] * mean[0]);
    } else {
        // the thickness of nose and tail is exact, independent of the rounding of the last arc coordinate
        edge.h = (k > 0 ? joukowski_half_thickness(&foil, joukowski_angle(&foil, from)) : 0) +
                 (k + 1 < n_edges ? joukowski_half_thickness(&foil, joukowski_angle(&foil, to)) : foil.tail / 2);
    }

    return edge;
}

struct profile_edge profile_edge(const struct fish_parameters *fish, int k) {
    const struct body_parameters *body = &fish->body;
    struct profile_edge edge = {.square = 1, .cube = 1};
    switch (body->profile) {
        case PROFILE_JOUKOWSKI: return joukowski_edge(fish, k);
        case PROFILE_UNIFORM:
            edge.h = body->thickness * fish->length;
            edge.w = body->depth * fish->length;
            break;
        case PROFILE_TABLE:
            edge.h = body->thickness_table.value[k];
            edge.w = body->depth_table.value[k];
            break;
    }

    return edge;
}

double profile_tail_thickness(const struct fish_parameters *fish) {
    return fish->body.profile == PROFILE_JOUKOWSKI ? fish->body.tail_thickness * fish->length
                                                   : profile_edge(fish, fish->nodes - 2).h;
}
