/* near_field.c: error estimates, and the selection of the near field. */
#include "wake/near_field.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "vortex/tolerance.h"

static const double two_pi = 6.28318530717958647692;

/* Interpolation costs more than the direct sum if the near vortices are more than FEW and more than a third of all. */
enum { FEW = 32 };

/* Largest error of the cubic through the times of wake_interpolation.c, over the fourth derivative / 4!. */
static const double cubic_error = 0.0107233047033631;

/* Along a straight line the n-th derivative of K over n! is at most pole_bound/(2 pi R^(n+1)), R^2 = r^2 + e^2: K is a
 * sum of two complex poles at the distance R. */
static const double pole_bound = 1.4142135623730951;

/* Ratio of estimate to bound: near_field.h. */
static const double estimate_per_bound = 0.1;

/* Motion of a body: all points stay within width of the line from the first to the last point. */
struct body {
    double end[2], along[2], length; /* along: unit vector */
    double width;                    /* m */
    double mean[2], deviation;       /* mean velocity of the points, and largest deviation from the mean, m s-1 */
    double acceleration;             /* largest, m s-2 */
};

static double max_of(double a, double b) {
    return a > b ? a : b;
}

struct near_field_bounds near_field_bound_wake(const struct wake *wake, double interval, const double *strength_start,
                                               const double *strength_end) {
    struct near_field_bounds b = {.low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
    double speed = 0, change = 0;
    for (int i = 0; i < wake->n_vortex; i++) {
        const double position[2] = {wake->x[i], wake->y[i]};
        for (int k = 0; k < 2; k++) {
            if (position[k] < b.low[k]) b.low[k] = position[k];
            if (position[k] > b.high[k]) b.high[k] = position[k];
        }

        const double du = wake->u[i] - wake->u_before[i], dv = wake->v[i] - wake->v_before[i];
        speed = max_of(speed, wake->u[i] * wake->u[i] + wake->v[i] * wake->v[i]);
        change = max_of(change, du * du + dv * dv);
        b.strength += fabs(strength_start[i]);
        b.decay += fabs(strength_end[i] - strength_start[i]);
    }

    b.acceleration = sqrt(change) / interval;
    b.speed = sqrt(speed);
    return b;
}

// distance of a position from the line between the ends of a body
static double distance_to_line(const struct body *body, double x, double y) {
    const double rx = x - body->end[0], ry = y - body->end[1];
    double s = rx * body->along[0] + ry * body->along[1];
    s = s < 0 ? 0 : s > body->length ? body->length : s;
    const double dx = rx - s * body->along[0], dy = ry - s * body->along[1];
    return sqrt(dx * dx + dy * dy);
}

static struct body body_motion(const struct near_field_input *input, int f) {
    const int first = input->points[f].first, n = input->points[f].n;
    const double *const x = input->motion[0] + first, *const y = input->motion[1] + first;
    const double *const u = input->motion[2] + first, *const v = input->motion[3] + first;
    const double *const a = input->motion[4] + first, *const b = input->motion[5] + first;
    struct body body = {.end = {x[0], y[0]}, .along = {x[n - 1] - x[0], y[n - 1] - y[0]}};

    body.length = hypot(body.along[0], body.along[1]);
    if (body.length > 0) {
        body.along[0] /= body.length;
        body.along[1] /= body.length;
    }

    for (int p = 0; p < n; p++) {
        body.mean[0] += u[p] / n;
        body.mean[1] += v[p] / n;
    }

    for (int p = 0; p < n; p++) {
        body.width = max_of(body.width, distance_to_line(&body, x[p], y[p]));
        body.deviation = max_of(body.deviation, hypot(u[p] - body.mean[0], v[p] - body.mean[1]));
        body.acceleration = max_of(body.acceleration, hypot(a[p], b[p]));
    }

    return body;
}

// error of vortices with the given total strength and decay, which stay at least distance, m, away and whose relative
// speed and acceleration do not exceed the given values
static struct near_field_error estimate_error(double distance, double smoothing, double speed, double acceleration,
                                              double interval, double strength, double decay) {
    const double square = distance * distance + smoothing * smoothing;
    const double inverse = 1 / sqrt(square), h = interval;

    // derivatives in time of K(r(t)): derivatives of K along a line, and terms of the curvature of the path
    const double w = speed * h * inverse, bend = acceleration * h * h * inverse;
    const double k = estimate_per_bound * pole_bound / two_pi * inverse;

    return (struct near_field_error){
        .error =
            cubic_error * k *
            (strength * (w * w * w * w + 1.5 * w * w * bend + 0.25 * bend * bend) + decay * (w * w * w + w * bend)),
        .by_drift_square = strength * k * inverse * inverse,
        .by_drift = k * inverse * (strength * (0.75 * w * w + 0.25 * bend) + decay * w / 2),
    };
}

// lower bound of the distance between box and body
static double box_distance(const struct near_field_bounds *bounds, const struct body *body) {
    double square = 0;
    for (int k = 0; k < 2; k++) {
        const double from = body->end[k], to = from + body->length * body->along[k];
        const double low = fmin(from, to), high = fmax(from, to);
        const double gap = max_of(max_of(bounds->low[k] - high, low - bounds->high[k]), 0);
        square += gap * gap;
    }

    return sqrt(square) - body->width;
}

static enum status near_field_add_near(struct near_field *near_field, const struct near_field_vortex *near) {
    if (near_field->n_near == near_field->capacity) {
        const int capacity = 2 * near_field->capacity + 64;
        TRY(MEMORY_RESIZE(near_field->near, capacity, "near vortices"));
        near_field->capacity = capacity;
    }

    near_field->near[near_field->n_near++] = *near;
    return STATUS_OK;
}

static void near_field_add_far(struct near_field *near_field, const struct near_field_error *error) {
    near_field->far.error += error->error;
    near_field->far.by_drift_square += error->by_drift_square;
    near_field->far.by_drift += error->by_drift;
}

// bounds of the image of a wake
static struct near_field_bounds bounds_of_image(const struct near_field_bounds *bounds, const struct image *image) {
    struct near_field_bounds mirrored = *bounds;
    const double low = image->sign * bounds->low[1] + image->shift, high = image->sign * bounds->high[1] + image->shift;
    mirrored.low[1] = fmin(low, high);
    mirrored.high[1] = fmax(low, high);
    return mirrored;
}

// the vortices of one wake or of an image of the wake: vortices with an error up to max_error go to the far field, all
// others to the candidates of the near field
static enum status near_field_divide_wake(const struct near_field_input *input, int g, const struct image *image,
                                          int is_own, const struct body *body, double max_error,
                                          struct near_field *near_field) {
    const struct wake *const wake = &input->wakes[g];
    const struct near_field_bounds *const bounds = &input->bounds[g];
    const double h = input->school->interval, smoothing = input->school->fish[g].smoothing;
    const double acceleration = body->acceleration + bounds->acceleration;
    const double *const start = input->strength_start + input->wake[g].first;
    const double *const end = input->strength_end + input->wake[g].first;

    for (int i = 0; i < wake->n_vortex; i++) {
        const double y = image->sign * wake->y[i] + image->shift, v = image->sign * wake->v[i];
        const double du = body->mean[0] - wake->u[i], dv = body->mean[1] - v;
        const double speed = sqrt(du * du + dv * dv) + body->deviation + h * acceleration;
        const double distance = distance_to_line(body, wake->x[i], y) - body->width - h * speed;

        const struct near_field_error error = estimate_error(max_of(distance, 0), smoothing, speed, acceleration, h,
                                                             fabs(start[i]), fabs(end[i] - start[i]));
        if (error.error <= max_error) {
            near_field_add_far(near_field, &error);
            continue;
        }

        const struct near_field_vortex near = {
            .error = error,
            .x = {wake->x[i], y},
            .u = {wake->u[i], v},
            .a = {(wake->u[i] - wake->u_before[i]) / h, image->sign * (wake->v[i] - wake->v_before[i]) / h},
            .strength = image->sign * start[i],
            .change = image->sign * (end[i] - start[i]),
            .smoothing = smoothing,
            .is_own = is_own,
        };
        TRY(near_field_add_near(near_field, &near));
    }

    return STATUS_OK;
}

// 0 for numbers below 2^-(n - 1), n - 1 for numbers >= 1, binned by powers of two in between
static int exponent_bin(double number, int n) {
    if (!(number < 1)) return n - 1;
    int exponent;
    frexp(number, &exponent);
    return exponent + n - 1 > 0 ? exponent + n - 1 : 0;
}

/* Move the candidates with the smallest errors to the far field, up to a sum of errors of max_error. The candidates are
 * sorted by powers of two only. */
static void near_field_move_far(struct near_field *near_field, double max_error) {
    enum { BINS = 64 };
    double sum[BINS] = {0};
    for (int i = 0; i < near_field->n_near; i++) {
        const double error = near_field->near[i].error.error;
        sum[exponent_bin(error / max_error, BINS)] += error;
    }

    // largest bin up to which the sum of errors stays below max_error
    int last = 0;
    for (double total = sum[0]; last < BINS - 1 && total <= max_error; total += sum[last]) last++;

    int n_near = 0;
    for (int i = 0; i < near_field->n_near; i++) {
        const struct near_field_vortex near = near_field->near[i];
        if (exponent_bin(near.error.error / max_error, BINS) < last) {
            near_field_add_far(near_field, &near.error);
        } else {
            near_field->near[n_near++] = near;
        }
    }

    near_field->n_near = n_near;
}

// a wake or an image of the wake: move the whole wake to the far field, or divide the wake vortex by vortex; n_images:
// images per wake
static enum status near_field_divide_image(struct near_field *near_field, const struct near_field_input *input, int g,
                                           const struct image *image, int is_own, int n_images,
                                           const struct body *body) {
    const struct school *const school = input->school;
    const struct near_field_bounds bounds = bounds_of_image(&input->bounds[g], image);
    const double acceleration = body->acceleration + bounds.acceleration;
    const double speed = sqrt(body->mean[0] * body->mean[0] + body->mean[1] * body->mean[1]) + body->deviation +
                         bounds.speed + school->interval * acceleration;
    const double distance = box_distance(&bounds, body) - school->interval * speed;
    const struct near_field_error error = estimate_error(max_of(distance, 0), school->fish[g].smoothing, speed,
                                                         acceleration, school->interval, bounds.strength, bounds.decay);

    if (error.error <= near_field->tolerance / TOLERANCE_WAKES / (school->n_fish * n_images)) {
        near_field_add_far(near_field, &error);
        return STATUS_OK;
    }

    const double max_error = near_field->tolerance / TOLERANCE_SINGLES / (input->n_released * n_images);
    return near_field_divide_wake(input, g, image, is_own, body, max_error, near_field);
}

// parts of the tolerance: vortex/tolerance.h
static enum status near_field_divide(struct near_field *near_field, const struct near_field_input *input, int f) {
    const struct school *const school = input->school;
    const struct fish *const fish = &school->fish[f];
    const struct body body = body_motion(input, f);
    const int n_released = input->n_released;

    near_field->n_near = 0;
    near_field->far = (struct near_field_error){0};
    near_field->tolerance = school->wake_tolerance * fish->length * fish_rate(school, fish);

    struct image image[1 + IMAGES_NEAREST] = {{1, 0}};
    const int n_images = 1 + images_nearest(&school->walls, image + 1);
    for (int g = 0; g < school->n_fish; g++) {
        for (int i = 0; i < n_images; i++) {
            TRY(near_field_divide_image(near_field, input, g, &image[i], g == f && i == 0, n_images, &body));
        }
    }

    near_field_move_far(near_field, near_field->tolerance / TOLERANCE_MOVED);

    // a near vortex is evaluated about twice as often as a far vortex
    near_field->is_interpolated = 3 * near_field->n_near <= n_released || near_field->n_near <= FEW;
    return STATUS_OK;
}

// the near vortices of the own wake are consecutive
static struct range near_field_own(const struct near_field *near_field) {
    struct range own = {0, 0};
    for (int i = 0; i < near_field->n_near; i++) {
        if (!near_field->near[i].is_own) continue;
        if (own.n == 0) own.first = i;
        own.n++;
    }

    return own;
}

// allocate the near vortices in groups of equal smoothing
static enum status near_field_reserve(struct near_field *near_field) {
    const struct near_field_vortex *const near = near_field->near;
    vortices_clear(&near_field->vortices);
    for (int i = 0, n; i < near_field->n_near; i += n) {
        for (n = 1; i + n < near_field->n_near && near[i + n].smoothing == near[i].smoothing;) n++;
        TRY(vortices_append(&near_field->vortices, n, near[i].smoothing));
    }

    return STATUS_OK;
}

enum status near_field_find(struct near_field *near_field, const struct near_field_input *input, int f) {
    TRY(near_field_divide(near_field, input, f));
    near_field->own = near_field_own(near_field);
    return near_field_reserve(near_field);
}

int near_field_is_valid(const struct near_field *near_field, double drift_square) {
    const struct near_field_error *const far = &near_field->far;
    return near_field->is_interpolated && far->by_drift_square * drift_square + far->by_drift * sqrt(drift_square) <=
                                              near_field->tolerance / TOLERANCE_DRIFT;
}

void near_field_update(struct near_field *near_field, double tau, double q, double factor) {
    struct vortices *const to = &near_field->vortices;
    for (int i = 0; i < near_field->n_near; i++) {
        const struct near_field_vortex *const near = &near_field->near[i];
        to->x[i] = near->x[0] + tau * (near->u[0] + tau / 2 * near->a[0]);
        to->y[i] = near->x[1] + tau * (near->u[1] + tau / 2 * near->a[1]);
        to->circulation[i] = factor * (near->strength + q * near->change);
    }
}

void near_field_free(struct near_field *near_field) {
    free(near_field->near);
    vortices_free(&near_field->vortices);
    *near_field = (struct near_field){0};
}
