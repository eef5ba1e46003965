/* far_images.h: velocity of the far images of many vortices in a channel at many points. doc/model.md, section 17.
 * Tested by tests/vortex/test_images.c. Part of images.h.
 *
 * The two images of a vortex that the walls mirror directly are near. All other images are far: the distance from every
 * point of the fluid is at least the channel width H:
 *
 *                x  mirrored image of an image             .
 *                o  image of the image                     .  far: velocity smooth in the vortex position
 *                x  mirrored by the upper wall             near
 *     ---------------------------------------------------- y = h + H
 *                o  the vortex, and the points
 *     ---------------------------------------------------- y = h
 *                x  mirrored by the lower wall             near
 *                o  image of the image                     far
 *
 * The channel is divided into square cells of length H. Chebyshev interpolation replaces the vortices of a cell by
 * equivalent vortices at the Chebyshev nodes of the cell; vortices of several smoothings are also interpolated in the
 * square of the smoothing. Closed sums over rows of images give the velocity at the nodes of every cell, and a
 * polynomial gives the velocity between the nodes. The cost is proportional to vortices, points and pairs of cells. The
 * number of nodes follows from the tolerance. */
#ifndef FAR_IMAGES_H
#define FAR_IMAGES_H

#include <math.h>

#include "base/status.h"
#include "vortex/vortices.h"

/* ---- walls along x, and the velocity of an infinite row of images of a vortex in a channel
 *
 * With X = sqrt(x^2 + e^2), S = pi X/H, Y = pi y/H and D = cosh S - cos Y,
 *
 *     sum_k K_e(x, y + 2kH) = (-sin Y, (x/X) sinh S) / (4 H D),
 *
 * for e = 0 the (Gamma/4H) coth of complex potentials. The infinite sum is exact: on the walls the normal velocity is
 * 0. */

struct walls {
    int n;            /* 0, 1, or 2: a channel, the lower one first */
    double y[2];      /* m */
    double inward[2]; /* 1: the fluid is above the wall; -1: below */
};

/* H of a channel, m. */
static inline double image_rows_width(const struct walls *walls) {
    return walls->y[1] - walls->y[0];
}

/* Sine and cosine of the half angle a = pi (y - h)/(2H) of a height y above the lower wall y = h. */
struct image_height {
    double sine, cosine;
};

static inline struct image_height image_height_of(const struct walls *walls, double y) {
    static const double pi = 3.14159265358979323846;
    const double a = pi * (y - walls->y[0]) / (2 * image_rows_width(walls));
    return (struct image_height){sin(a), cos(a)};
}

/* Terms of a source and a target that both rows of images share. */
struct image_column {
    double ratio, decay;   /* x/X, e^2/X^3: 1, m-1 */
    double rate, strength; /* pi/H, m-1, and 1/(4H) */
    double t, gap;         /* exp(-S), 1 - exp(-S) */
};

/* Source and target at a distance x along the channel; rate: pi/H; square: e^2. */
static inline struct image_column image_column_of(double rate, double x, double square) {
    static const double pi = 3.14159265358979323846;
    const double length = sqrt(x * x + square), s = rate * length;
    return (struct image_column){.ratio = x / length,
                                 .decay = square / (length * length * length),
                                 .rate = rate,
                                 .strength = rate / (4 * pi),
                                 .t = exp(-s),
                                 .gap = -expm1(-s)};
}

/* A velocity and, if requested, the velocity gradient. */
struct image_velocity {
    double u, v, u_x, u_y, v_x;
};

/* The velocity of a row of unit vortices, from the sine and cosine of the half angle between row and target. Numerator
 * and denominator are multiplied by 2t: 2t D = (1 - t)^2 + 4t sin^2(Y/2), 2t sinh S = 1 - t^2. */
static inline struct image_velocity image_row_of(const struct image_column *c, double sine, double cosine,
                                                 int with_gradient) {
    const double t = c->t, gap = c->gap, square = sine * sine, both = sine * cosine;
    const double inverse = 1 / (gap * gap + 4 * t * square), sinh = gap * (1 + t);
    struct image_velocity row = {.u = -c->strength * 4 * t * both * inverse,
                                 .v = c->strength * c->ratio * sinh * inverse};
    if (!with_gradient) return row;

    const double bend = c->strength * c->rate * 2 * t * inverse * inverse, cos_y = 1 - 2 * square;
    // cosh S cos Y - 1, without cancellation near the vortex
    const double turn = gap * gap * cos_y - 4 * t * square;
    row.u_x = bend * 2 * both * c->ratio * sinh;
    row.u_y = -bend * turn;
    row.v_x = c->strength * c->decay * sinh * inverse - bend * c->ratio * c->ratio * turn;
    return row;
}

/* The velocity of one unit vortex. */
static inline struct image_velocity image_direct_of(double x, double y, double square, int with_gradient) {
    static const double pi = 3.14159265358979323846;
    const double inverse = 1 / (x * x + y * y + square), g = inverse / (2 * pi), twice = 2 * g * inverse;
    struct image_velocity direct = {.u = -g * y, .v = g * x};
    if (!with_gradient) return direct;
    direct.u_x = twice * x * y;
    direct.u_y = twice * y * y - g;
    direct.v_x = g - twice * x * x;
    return direct;
}

/* The row of a source without the source, and the row of the mirror image; r: from the source to the target. */
struct image_rows {
    struct image_velocity shifted, mirrored;
};

static inline struct image_rows image_rows_of(const struct image_column *column, const double r[2],
                                              const struct image_height *target, const struct image_height *source,
                                              double square, int with_gradient) {
    const double sc = target->sine * source->cosine, cs = target->cosine * source->sine;
    const double ss = target->sine * source->sine, cc = target->cosine * source->cosine;
    struct image_rows rows = {image_row_of(column, sc - cs, cc + ss, with_gradient),
                              image_row_of(column, sc + cs, cc - ss, with_gradient)};

    const struct image_velocity direct = image_direct_of(r[0], r[1], square, with_gradient);
    rows.shifted.u -= direct.u;
    rows.shifted.v -= direct.v;
    rows.shifted.u_x -= direct.u_x;
    rows.shifted.u_y -= direct.u_y;
    rows.shifted.v_x -= direct.v_x;
    return rows;
}

struct far_images; /* tables of node-to-node velocities, kept for the next sum */

/* Fails with STATUS_MEMORY; far_images_free accepts NULL. */
enum status far_images_create(struct far_images **far);
void far_images_free(struct far_images *far);

/* Whether the sum by cells is faster than the direct sum over all images. The sum by cells is faster from some hundred
 * thousand interactions on, if the tolerance is above 0 and the channel is not much longer than wide. */
int far_images_pay(const struct walls *channel, const struct vortices *vortices, double tolerance,
                   const struct induced *at);

/* Add the velocity of the far images of all vortices to the targets, all inside the channel. The error of the velocity
 * is at most tolerance / TOLERANCE_SUM times the sum |Gamma| / (2 pi sqrt(r^2 + e^2)) of velocity_sum.h; the error of
 * the gradient is at most 5 tolerance times the sum |Gamma| / (2 pi (r^2 + e^2)). The bits depend neither on the number
 * of threads nor on earlier sums. Requires far_images_pay: finite positions, and a limited number of cells. Fails with
 * STATUS_MEMORY; nothing is added then. */
enum status far_images_induce(struct far_images *far, const struct walls *channel, const struct vortices *vortices,
                              double tolerance, int threads, const struct induced *at);

#endif
