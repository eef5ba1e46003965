/* wake_interpolation_outlook.c: bounds of errors, and what they make near. */
#include "model/near_field.h"

#include <math.h>
#include <stdlib.h>

static const double two_pi = 6.28318530717958647692;

/* A forecast for a fish to which more vortices are near, and more than a third of all, costs more than it saves. */
enum { FEW = 32 };

/* What a cubic through the times of wake_interpolation.c errs by, times the fourth derivative over 4!. */
static const double cubic_error = 0.0107233047033631;

/* The bounds below take every vortex at its closest and fastest, and all with one sign: they are 50 to 1000 times the
 * error that is found in the cases of tests/model/test_wake_interpolation.c. This part of them is held below the tolerance. */
static const double part_of_bound = 0.1;

/* Along a straight line, n-th derivatives of K over n! are at most this times 1/(2 pi R^(n+1)), R^2 = r^2 + e^2: K is a
 * sum of two complex poles at the distance R. */
static const double pole_bound = 1.4142135623730951;

/* How a body moves: its points stay within width of the line from one end to the other. */
struct body {
    double end[2], along[2], length; /* along: unit vector */
    double width;                    /* m */
    double mean[2], spread;          /* velocity of the points, and how far they differ from it, m s-1 */
    double acceleration;             /* largest, m s-2 */
};

static double max_of(double a, double b) {
    return a > b ? a : b;
}

struct near_field_bounds near_field_bound_wake(const struct wake *wake, double interval, const double *before,
                                               const double *after) {
    struct near_field_bounds b = {.low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
    double speed = 0, jump = 0;
    for (int i = 0; i < wake->n_vortex; i++) {
        const double position[2] = {wake->x[i], wake->y[i]};
        for (int k = 0; k < 2; k++) {
            if (position[k] < b.low[k]) b.low[k] = position[k];
            if (position[k] > b.high[k]) b.high[k] = position[k];
        }
        const double du = wake->u[i] - wake->u_before[i], dv = wake->v[i] - wake->v_before[i];
        speed = max_of(speed, wake->u[i] * wake->u[i] + wake->v[i] * wake->v[i]);
        jump = max_of(jump, du * du + dv * dv);
        b.strength += fabs(before[i]);
        b.fading += fabs(after[i] - before[i]);
    }
    b.acceleration = sqrt(jump) / interval;
    b.speed = sqrt(speed);
    return b;
}

// how far a place is from the line between the ends of a body
static double off_axis(const struct body *body, double x, double y) {
    const double rx = x - body->end[0], ry = y - body->end[1];
    double s = rx * body->along[0] + ry * body->along[1];
    s = s < 0 ? 0 : s > body->length ? body->length : s;
    const double dx = rx - s * body->along[0], dy = ry - s * body->along[1];
    return sqrt(dx * dx + dy * dy);
}

static struct body observe(const struct near_field_scene *scene, int f) {
    const int first = scene->points[f].first, n = scene->points[f].n;
    const double *const x = scene->motion[0] + first, *const y = scene->motion[1] + first;
    const double *const u = scene->motion[2] + first, *const v = scene->motion[3] + first;
    const double *const a = scene->motion[4] + first, *const b = scene->motion[5] + first;
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
        body.width = max_of(body.width, off_axis(&body, x[p], y[p]));
        body.spread = max_of(body.spread, hypot(u[p] - body.mean[0], v[p] - body.mean[1]));
        body.acceleration = max_of(body.acceleration, hypot(a[p], b[p]));
    }
    return body;
}

// what vortices of some strength contribute that come no closer than the distance, m, with a relative velocity and
// acceleration no larger than these, and fade by so much
static struct near_field_part part_of(double distance, double smoothing, double speed, double acceleration,
                                      double interval, double strength, double fading) {
    const double square = distance * distance + smoothing * smoothing;
    const double inverse = 1 / sqrt(square), h = interval;
    // derivatives in time of K(r(t)): of K along the line, and by the path's bending
    const double w = speed * h * inverse, bend = acceleration * h * h * inverse;
    const double k = part_of_bound * pole_bound / two_pi * inverse;
    return (struct near_field_part){
        .error =
            cubic_error * k *
            (strength * (w * w * w * w + 1.5 * w * w * bend + 0.25 * bend * bend) + fading * (w * w * w + w * bend)),
        .second = strength * k * inverse * inverse,
        .drifting = k * inverse * (strength * (0.75 * w * w + 0.25 * bend) + fading * w / 2),
    };
}

// no point of the box is closer to the body than this
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

static enum status add_near(struct near_field *near_field, const struct wake_interpolation_n_near *near) {
    if (near_field->n_near == near_field->capacity) {
        const int capacity = 2 * near_field->capacity + 64;
        struct wake_interpolation_n_near *const more = realloc(near_field->near, (size_t)capacity * sizeof *more);
        if (!more) return status_fail(STATUS_MEMORY, "out of memory: %d near vortices", capacity);
        near_field->near = more;
        near_field->capacity = capacity;
    }
    near_field->near[near_field->n_near++] = *near;
    return STATUS_OK;
}

static void count_far(struct near_field *near_field, const struct near_field_part *part) {
    near_field->second += part->second;
    near_field->drifting += part->drifting;
}

// the vortices of one wake: those that contribute little are far, the others might be near
static enum status sort_wake(const struct near_field_scene *scene, int g, const struct body *body, double little,
                             struct near_field *near_field) {
    const struct wake *const wake = &scene->state->wake[g];
    const struct near_field_bounds *const bounds = &scene->bounds[g];
    const double h = scene->school->interval, smoothing = scene->school->fish[g].smoothing;
    const double acceleration = body->acceleration + bounds->acceleration;
    const double *const before = scene->before + scene->wake[g].first;
    const double *const after = scene->after + scene->wake[g].first;
    for (int i = 0; i < wake->n_vortex; i++) {
        const double du = body->mean[0] - wake->u[i], dv = body->mean[1] - wake->v[i];
        const double speed = sqrt(du * du + dv * dv) + body->spread + h * acceleration;
        const double distance = off_axis(body, wake->x[i], wake->y[i]) - body->width - h * speed;
        const struct near_field_part part = part_of(max_of(distance, 0), smoothing, speed, acceleration, h,
                                                    fabs(before[i]), fabs(after[i] - before[i]));
        if (part.error <= little) {
            count_far(near_field, &part);
            continue;
        }
        const struct wake_interpolation_n_near near = {
            .part = part,
            .x = {wake->x[i], wake->y[i]},
            .u = {wake->u[i], wake->v[i]},
            .a = {(wake->u[i] - wake->u_before[i]) / h, (wake->v[i] - wake->v_before[i]) / h},
            .strength = before[i],
            .change = after[i] - before[i],
            .smoothing = smoothing,
        };
        TRY(add_near(near_field, &near));
    }
    return STATUS_OK;
}

// 0 for numbers below 2^-(n - 1), n - 1 for 1 and more, in between by powers of two
static int exponent_bin(double number, int n) {
    if (!(number < 1)) return n - 1;
    int exponent;
    frexp(number, &exponent);
    return exponent + n - 1 > 0 ? exponent + n - 1 : 0;
}

/* Of the vortices that might be near, let those be far whose errors, the smallest first, add up to no more than this.
 * Sorted by powers of two only. */
static void let_go(struct near_field *near_field, double most) {
    enum { BINS = 64 };
    double sum[BINS] = {0};
    for (int i = 0; i < near_field->n_near; i++) {
        sum[exponent_bin(near_field->near[i].part.error / most, BINS)] += near_field->near[i].part.error;
    }
    int last = 0;
    for (double total = sum[0]; last < BINS - 1 && total <= most; total += sum[last]) last++;
    int n_kept = 0;
    for (int i = 0; i < near_field->n_near; i++) {
        const struct wake_interpolation_n_near near = near_field->near[i];
        if (exponent_bin(near.part.error / most, BINS) < last) {
            count_far(near_field, &near.part);
        } else {
            near_field->near[n_kept++] = near;
        }
    }
    near_field->n_near = n_kept;
}

/* Decide for one fish which vortices are near. Half of the error that is allowed is for the far ones (an eighth for whole
 * wakes, one for single vortices of little effect, a quarter for those that let_go finds), half for the body's way off
 * its foretold path. */
static enum status look_out(struct near_field *near_field, const struct near_field_scene *scene, int f) {
    const struct school *const school = scene->school;
    const struct fish *const fish = &school->fish[f];
    const struct body body = observe(scene, f);
    const int n_released = scene->n_released;
    near_field->n_near = 0;
    near_field->second = near_field->drifting = 0;
    near_field->allowed = school->wake_tolerance * fish->length * fish_rate(school, fish);
    for (int g = 0; g < school->n_fish; g++) {
        const struct near_field_bounds *const bounds = &scene->bounds[g];
        const double acceleration = body.acceleration + bounds->acceleration;
        const double speed = sqrt(body.mean[0] * body.mean[0] + body.mean[1] * body.mean[1]) + body.spread +
                             bounds->speed + school->interval * acceleration;
        const double distance = box_distance(bounds, &body) - school->interval * speed;
        const struct near_field_part part = part_of(max_of(distance, 0), school->fish[g].smoothing, speed, acceleration,
                                                    school->interval, bounds->strength, bounds->fading);
        if (part.error <= near_field->allowed / 8 / school->n_fish) {
            count_far(near_field, &part);
        } else {
            TRY(sort_wake(scene, g, &body, near_field->allowed / 8 / n_released, near_field));
        }
    }
    let_go(near_field, near_field->allowed / 4);
    // a near vortex is evaluated about twice as often as a far one
    near_field->serves = 3 * near_field->n_near <= n_released || near_field->n_near <= FEW;
    return STATUS_OK;
}

// room for the near vortices, in their groups
static enum status reserve_near(struct near_field *near_field) {
    vortices_clear(&near_field->now);
    for (int i = 0, n; i < near_field->n_near; i += n) {
        for (n = 1; i + n < near_field->n_near && near_field->near[i + n].smoothing == near_field->near[i].smoothing;)
            n++;
        TRY(vortices_append(&near_field->now, n, near_field->near[i].smoothing));
    }
    return STATUS_OK;
}

enum status near_field_find(struct near_field *near_field, const struct near_field_scene *scene, int f) {
    TRY(look_out(near_field, scene, f));
    return reserve_near(near_field);
}

void near_field_place(struct near_field *near_field, double tau, double q, double factor) {
    for (int i = 0; i < near_field->n_near; i++) {
        const struct wake_interpolation_n_near *const near = &near_field->near[i];
        near_field->now.x[i] = near->x[0] + tau * (near->u[0] + tau / 2 * near->a[0]);
        near_field->now.y[i] = near->x[1] + tau * (near->u[1] + tau / 2 * near->a[1]);
        near_field->now.circulation[i] = factor * (near->strength + q * near->change);
    }
}

void near_field_free(struct near_field *near_field) {
    free(near_field->near);
    vortices_free(&near_field->now);
    *near_field = (struct near_field){0};
}
