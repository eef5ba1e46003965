/* forecast.c: cubics in time for the far vortices, the near ones as they are. */
#include "forecast.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "summation.h"

static const double two_pi = 6.28318530717958647692;

enum { N_TIMES = 4, END = N_TIMES - 1 };

/* A forecast for a fish to which more vortices are near, and more than a third of all, costs more than it saves. */
enum { FEW = 32 };

/* The times, as parts of the interval: of all four with both ends these have the least largest |product of (q - time)|,
 * (3 - 2 sqrt(2))/16, which the fourth derivative over 4! comes with in the error of the cubic. */
static const double time_of[N_TIMES] = {0, 0.29289321881345248, 0.70710678118654752, 1};
static const double cubic_error = 0.0107233047033631;

/* The bounds below take every vortex at its closest and fastest, and all with one sign: they are 50 to 1000 times the
 * error that is found in the cases of tests/test_forecast.c. This part of them is held below the tolerance. */
static const double part_of_bound = 0.1;

/* Along a straight line, n-th derivatives of K over n! are at most this times 1/(2 pi R^(n+1)), R^2 = r^2 + e^2: K is a
 * sum of two complex poles at the distance R. */
static const double pole_bound = 1.4142135623730951;

/* What holds for all vortices of a wake. */
struct bounds {
    double low[2], high[2]; /* where they are at the event, m */
    double speed;           /* m s-1 */
    double acceleration;    /* m s-2 */
    double strength;        /* sum of the absolute values, m2 s-1 */
    double fading;          /* sum of the absolute changes in the interval, m2 s-1 */
};

/* How a body moves: its points stay within width of the line from one end to the other. */
struct body {
    double end[2], along[2], length; /* along: unit vector */
    double width;                    /* m */
    double mean[2], spread;          /* velocity of the points, and how far they differ from it, m s-1 */
    double acceleration;             /* largest, m s-2 */
};

/* Bounds of what a vortex contributes to errors, see struct outlook. */
struct part {
    double error, second, drifting;
};

/* A vortex that is near to a body: its path x + tau u + tau^2 a/2, and its strength as it counts in sums. */
struct near {
    struct part part;        /* what it would contribute if it were far */
    double x[2], u[2], a[2]; /* at the event */
    double strength, change; /* at the event, and until the end of the interval, m2 s-1 */
    double smoothing;        /* m */
};

/* What is foretold for one fish. */
struct outlook {
    int serves;      /* 0: so much is near that nothing is foretold */
    double allowed;  /* error of the velocity, m s-1 */
    double second;   /* of the far vortices: bound of half the second derivatives of the velocity, m-1 s-1 */
    double drifting; /* and of the error of the gradient, s-1 */
    int n_near, capacity;
    struct near *near;
    struct vortices now; /* the near ones at the time of forecast_place */
};

struct forecast {
    const struct school *school;
    double start, q;        /* time of the event, s; part of the interval that has passed */
    double weight[N_TIMES]; /* of the values at the four times, now */
    int n_points;
    const struct range *points; /* of each fish                                    (n_fish) */
    struct outlook *outlook;    /*                                                    (n_fish) */

    double *motion[6];                                  /* of all points at the event: x y, u v, a b (n_points) */
    double *now[2];                                     /* where they are foretold to be now, m      (n_points) */
    double *path[N_TIMES][2];                           /* and at the times of the forecast          (n_points) */
    double *velocity_u[N_TIMES], *velocity_v[N_TIMES];  /* of the fluid there, m s-1                 (n_points) */
    double *u_x[N_TIMES], *u_y[N_TIMES], *v_x[N_TIMES]; /* its gradient at both ends, s-1          (n_points) */

    struct summation *summation;
    struct vortices released[N_TIMES]; /* of all fish */
    struct range *wake;                /* those of each fish                       (n_fish) */
    struct bounds *bounds;             /* of each wake                             (n_fish) */
};

static enum status doubles(double **values, int n) {
    *values = calloc((size_t)(n > 0 ? n : 1), sizeof **values);
    return *values ? STATUS_OK : status_fail(STATUS_MEMORY, "no room for a forecast at %d points", n);
}

static enum status fill(struct forecast *forecast) {
    TRY(summation_create(&forecast->summation));
    const size_t n_fish = (size_t)forecast->school->n_fish;
    forecast->outlook = calloc(n_fish, sizeof *forecast->outlook);
    forecast->wake = calloc(n_fish, sizeof *forecast->wake);
    forecast->bounds = calloc(n_fish, sizeof *forecast->bounds);
    if (!forecast->outlook || !forecast->wake || !forecast->bounds) {
        return status_fail(STATUS_MEMORY, "no room for a forecast for %d fish", forecast->school->n_fish);
    }
    const int n = forecast->n_points;
    for (int i = 0; i < 6; i++) TRY(doubles(&forecast->motion[i], n));
    for (int i = 0; i < 2; i++) TRY(doubles(&forecast->now[i], n));
    for (int i = 0; i < N_TIMES; i++) {
        for (int k = 0; k < 2; k++) TRY(doubles(&forecast->path[i][k], n));
        TRY(doubles(&forecast->velocity_u[i], n));
        TRY(doubles(&forecast->velocity_v[i], n));
        if (i > 0 && i < END) continue;
        TRY(doubles(&forecast->u_x[i], n));
        TRY(doubles(&forecast->u_y[i], n));
        TRY(doubles(&forecast->v_x[i], n));
    }
    return STATUS_OK;
}

enum status forecast_create(struct forecast **forecast, const struct school *school, const struct range *points) {
    *forecast = NULL;
    struct forecast *const new = calloc(1, sizeof *new);
    if (!new) return status_fail(STATUS_MEMORY, "no room for a forecast");
    new->school = school;
    const struct range last = points[school->n_fish - 1];
    new->n_points = last.first + last.n;
    new->points = points;
    const enum status status = fill(new);
    if (status != STATUS_OK) {
        forecast_free(new);
        return status;
    }
    *forecast = new;
    return STATUS_OK;
}

void forecast_free(struct forecast *forecast) {
    if (!forecast) return;
    for (int i = 0; i < 6; i++) free(forecast->motion[i]);
    for (int i = 0; i < 2; i++) free(forecast->now[i]);
    for (int i = 0; i < N_TIMES; i++) {
        for (int k = 0; k < 2; k++) free(forecast->path[i][k]);
        double *const at_points[] = {forecast->velocity_u[i], forecast->velocity_v[i], forecast->u_x[i],
                                     forecast->u_y[i], forecast->v_x[i]};
        for (size_t k = 0; k < sizeof at_points / sizeof *at_points; k++) free(at_points[k]);
        vortices_free(&forecast->released[i]);
    }
    for (int f = 0; forecast->outlook && f < forecast->school->n_fish; f++) {
        free(forecast->outlook[f].near);
        vortices_free(&forecast->outlook[f].now);
    }
    summation_free(forecast->summation);
    free(forecast->outlook);
    free(forecast->wake);
    free(forecast->bounds);
    free(forecast);
}

// ---- what is near

static double max_of(double a, double b) {
    return a > b ? a : b;
}

static struct bounds bound_wake(const struct wake *wake, double interval, const double *before, const double *after) {
    struct bounds b = {.low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
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

static struct body observe(const struct forecast *forecast, int f) {
    const int first = forecast->points[f].first, n = forecast->points[f].n;
    const double *const x = forecast->motion[0] + first, *const y = forecast->motion[1] + first;
    const double *const u = forecast->motion[2] + first, *const v = forecast->motion[3] + first;
    const double *const a = forecast->motion[4] + first, *const b = forecast->motion[5] + first;
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
        const double r[2] = {x[p] - x[0], y[p] - y[0]};
        double s = r[0] * body.along[0] + r[1] * body.along[1];
        s = s < 0 ? 0 : s > body.length ? body.length : s;
        body.width = max_of(body.width, hypot(r[0] - s * body.along[0], r[1] - s * body.along[1]));
        body.spread = max_of(body.spread, hypot(u[p] - body.mean[0], v[p] - body.mean[1]));
        body.acceleration = max_of(body.acceleration, hypot(a[p], b[p]));
    }
    return body;
}

// what vortices of some strength contribute that come no closer than the distance, m, with a relative velocity and
// acceleration no larger than these, and fade by so much
static struct part part_of(double distance, double smoothing, double speed, double acceleration, double interval,
                           double strength, double fading) {
    const double square = distance * distance + smoothing * smoothing;
    const double inverse = 1 / sqrt(square), h = interval;
    // derivatives in time of K(r(t)): of K along the line, and by the path's bending
    const double w = speed * h * inverse, bend = acceleration * h * h * inverse;
    const double k = part_of_bound * pole_bound / two_pi * inverse;
    return (struct part){
        .error =
            cubic_error * k *
            (strength * (w * w * w * w + 1.5 * w * w * bend + 0.25 * bend * bend) + fading * (w * w * w + w * bend)),
        .second = strength * k * inverse * inverse,
        .drifting = k * inverse * (strength * (0.75 * w * w + 0.25 * bend) + fading * w / 2),
    };
}

// no point of the box is closer to the body than this
static double box_distance(const struct bounds *bounds, const struct body *body) {
    double square = 0;
    for (int k = 0; k < 2; k++) {
        const double from = body->end[k], to = from + body->length * body->along[k];
        const double low = fmin(from, to), high = fmax(from, to);
        const double gap = max_of(max_of(bounds->low[k] - high, low - bounds->high[k]), 0);
        square += gap * gap;
    }
    return sqrt(square) - body->width;
}

static double axis_distance(const struct body *body, double x, double y) {
    const double rx = x - body->end[0], ry = y - body->end[1];
    double s = rx * body->along[0] + ry * body->along[1];
    s = s < 0 ? 0 : s > body->length ? body->length : s;
    const double dx = rx - s * body->along[0], dy = ry - s * body->along[1];
    return sqrt(dx * dx + dy * dy) - body->width;
}

static enum status add_near(struct outlook *outlook, const struct near *near) {
    if (outlook->n_near == outlook->capacity) {
        const int capacity = 2 * outlook->capacity + 64;
        struct near *const more = realloc(outlook->near, (size_t)capacity * sizeof *more);
        if (!more) return status_fail(STATUS_MEMORY, "no room for %d near vortices", capacity);
        outlook->near = more;
        outlook->capacity = capacity;
    }
    outlook->near[outlook->n_near++] = *near;
    return STATUS_OK;
}

static void count_far(struct outlook *outlook, const struct part *part) {
    outlook->second += part->second;
    outlook->drifting += part->drifting;
}

// the vortices of one wake: those that contribute little are far, the others might be near
static enum status sort_wake(struct forecast *forecast, const struct state *state, int g, const struct body *body,
                             double little, struct outlook *outlook) {
    const struct wake *const wake = &state->wake[g];
    const struct bounds *const bounds = &forecast->bounds[g];
    const double h = forecast->school->interval, smoothing = forecast->school->fish[g].smoothing;
    const double acceleration = body->acceleration + bounds->acceleration;
    const double *const before = forecast->released[0].circulation + forecast->wake[g].first;
    const double *const after = forecast->released[END].circulation + forecast->wake[g].first;
    for (int i = 0; i < wake->n_vortex; i++) {
        const double du = body->mean[0] - wake->u[i], dv = body->mean[1] - wake->v[i];
        const double speed = sqrt(du * du + dv * dv) + body->spread + h * acceleration;
        const double distance = axis_distance(body, wake->x[i], wake->y[i]) - h * speed;
        const struct part part = part_of(max_of(distance, 0), smoothing, speed, acceleration, h, fabs(before[i]),
                                         fabs(after[i] - before[i]));
        if (part.error <= little) {
            count_far(outlook, &part);
            continue;
        }
        const struct near near = {
            .part = part,
            .x = {wake->x[i], wake->y[i]},
            .u = {wake->u[i], wake->v[i]},
            .a = {(wake->u[i] - wake->u_before[i]) / h, (wake->v[i] - wake->v_before[i]) / h},
            .strength = before[i],
            .change = after[i] - before[i],
            .smoothing = smoothing,
        };
        TRY(add_near(outlook, &near));
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
static void let_go(struct outlook *outlook, double most) {
    enum { BINS = 64 };
    double sum[BINS] = {0};
    for (int i = 0; i < outlook->n_near; i++) {
        sum[exponent_bin(outlook->near[i].part.error / most, BINS)] += outlook->near[i].part.error;
    }
    int last = 0;
    for (double total = sum[0]; last < BINS - 1 && total <= most; total += sum[last]) last++;
    int n_kept = 0;
    for (int i = 0; i < outlook->n_near; i++) {
        const struct near near = outlook->near[i];
        if (exponent_bin(near.part.error / most, BINS) < last) {
            count_far(outlook, &near.part);
        } else {
            outlook->near[n_kept++] = near;
        }
    }
    outlook->n_near = n_kept;
}

/* Decide for one fish which vortices are near. Half of the error that is allowed is for the far ones (an eighth for whole
 * wakes, one for single vortices of little effect, a quarter for those that let_go finds), half for the body's way off
 * its foretold path. */
static enum status look_out(struct forecast *forecast, const struct state *state, int f) {
    const struct school *const school = forecast->school;
    const struct fish *const fish = &school->fish[f];
    struct outlook *const outlook = &forecast->outlook[f];
    const struct body body = observe(forecast, f);
    const int n_released = forecast->released[0].n;
    outlook->n_near = 0;
    outlook->second = outlook->drifting = 0;
    outlook->allowed = school->wake_tolerance * fish->length * fish_rate(school, fish);
    for (int g = 0; g < school->n_fish; g++) {
        const struct bounds *const bounds = &forecast->bounds[g];
        const double acceleration = body.acceleration + bounds->acceleration;
        const double speed = sqrt(body.mean[0] * body.mean[0] + body.mean[1] * body.mean[1]) + body.spread +
                             bounds->speed + school->interval * acceleration;
        const double distance = box_distance(bounds, &body) - school->interval * speed;
        const struct part part = part_of(max_of(distance, 0), school->fish[g].smoothing, speed, acceleration,
                                         school->interval, bounds->strength, bounds->fading);
        if (part.error <= outlook->allowed / 8 / school->n_fish) {
            count_far(outlook, &part);
        } else {
            TRY(sort_wake(forecast, state, g, &body, outlook->allowed / 8 / n_released, outlook));
        }
    }
    let_go(outlook, outlook->allowed / 4);
    // a near vortex is evaluated about twice as often as a far one
    outlook->serves = 3 * outlook->n_near <= n_released || outlook->n_near <= FEW;
    return STATUS_OK;
}

// ---- the values

// the near vortices at the time tau, with their strengths times a factor
static void place_near(struct outlook *outlook, double tau, double q, double factor) {
    for (int i = 0; i < outlook->n_near; i++) {
        const struct near *const near = &outlook->near[i];
        outlook->now.x[i] = near->x[0] + tau * (near->u[0] + tau / 2 * near->a[0]);
        outlook->now.y[i] = near->x[1] + tau * (near->u[1] + tau / 2 * near->a[1]);
        outlook->now.circulation[i] = factor * (near->strength + q * near->change);
    }
}

static enum status reserve_near(struct outlook *outlook) {
    vortices_clear(&outlook->now);
    for (int i = 0, n; i < outlook->n_near; i += n) {
        for (n = 1; i + n < outlook->n_near && outlook->near[i + n].smoothing == outlook->near[i].smoothing;) n++;
        TRY(vortices_append(&outlook->now, n, outlook->near[i].smoothing));
    }
    return STATUS_OK;
}

// where all points are on their foretold paths
static void follow(const struct forecast *forecast, double tau, double *const path[2]) {
    for (int k = 0; k < 2; k++) {
        const double *const x = forecast->motion[k], *const u = forecast->motion[2 + k],
                            *const a = forecast->motion[4 + k];
        for (int p = 0; p < forecast->n_points; p++) path[k][p] = x[p] + tau * (u[p] + tau / 2 * a[p]);
    }
}

enum status forecast_released(const struct school *school, const struct state *state, double tau,
                              struct vortices *released, struct range *wake) {
    vortices_clear(released);
    for (int g = 0; g < school->n_fish; g++) {
        wake[g] = (struct range){released->n, state->wake[g].n_vortex};
        TRY(vortices_append(released, wake[g].n, school->fish[g].smoothing));
        const int first = wake[g].first;
        wake_at(&state->wake[g], school, state->t, tau, released->x + first, released->y + first,
                released->circulation + first);
    }
    return STATUS_OK;
}

static struct induced at_time(const struct forecast *forecast, int i) {
    return (struct induced){forecast->n_points,      forecast->path[i][0],    forecast->path[i][1],
                            forecast->velocity_u[i], forecast->velocity_v[i], forecast->u_x[i],
                            forecast->u_y[i],        forecast->v_x[i]};
}

// the sums of all released vortices at all points at all times
static void sum_directly(const struct forecast *forecast, int threads) {
    const int n_tasks = N_TIMES * vortices_n_chunks(forecast->n_points);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int task = 0; task < n_tasks; task++) {
        const int i = task % N_TIMES;
        const struct induced all = at_time(forecast, i);
        const struct induced at = vortices_targets(&all, vortices_chunk(task / N_TIMES, all.n));
        vortices_induce(&forecast->released[i], (struct range){0, forecast->released[i].n}, &at);
    }
}

static enum status sum(const struct forecast *forecast, int threads) {
    const double tolerance = forecast->school->wake_tolerance;
    for (int i = 0; i < N_TIMES; i++) {
        const struct induced at = at_time(forecast, i);
        vortices_zero(&at);
    }
    if (!summation_by_tree(&forecast->released[0], forecast->n_points, tolerance)) {
        sum_directly(forecast, threads);
        return STATUS_OK;
    }
    for (int i = 0; i < N_TIMES; i++) {
        const struct induced at = at_time(forecast, i);
        TRY(summation_induce(forecast->summation, &forecast->released[i], tolerance, threads, &at));
    }
    return STATUS_OK;
}

// take what is near to a fish out of the sums of all times again
static void take_near(struct forecast *forecast, int f) {
    struct outlook *const outlook = &forecast->outlook[f];
    if (!outlook->serves || outlook->n_near == 0) return;
    for (int i = 0; i < N_TIMES; i++) {
        const struct induced all = at_time(forecast, i), at = vortices_targets(&all, forecast->points[f]);
        place_near(outlook, time_of[i] * forecast->school->interval, time_of[i], -1);
        vortices_induce(&outlook->now, (struct range){0, outlook->n_near}, &at);
    }
}

static enum status make(struct forecast *forecast, const struct state *state, const struct forecast_points *points) {
    const struct school *const school = forecast->school;
    const double *const motion[6] = {points->x, points->y, points->u, points->v, points->a, points->b};
    for (int k = 0; k < 6; k++) memcpy(forecast->motion[k], motion[k], (size_t)forecast->n_points * sizeof(double));
    forecast->start = state->t;
    for (int i = 0; i < N_TIMES; i++) {
        TRY(forecast_released(school, state, time_of[i] * school->interval, &forecast->released[i], forecast->wake));
    }
    for (int g = 0; g < school->n_fish; g++) {
        const int first = forecast->wake[g].first;
        forecast->bounds[g] = bound_wake(&state->wake[g], school->interval, forecast->released[0].circulation + first,
                                         forecast->released[END].circulation + first);
    }
    const double work = (double)N_TIMES * forecast->n_points * forecast->released[0].n;
    const int threads = vortices_threads(school->threads, work);
    enum status status = STATUS_OK;
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < school->n_fish; f++) {
        enum status here = look_out(forecast, state, f);
        if (here == STATUS_OK) here = reserve_near(&forecast->outlook[f]);
        if (here != STATUS_OK) {
#pragma omp atomic write
            status = here;
        }
    }
    // a message stays with the thread that wrote it
    if (status != STATUS_OK) return status_fail(status, "no room for the near vortices of %d fish", school->n_fish);
    for (int i = 0; i < N_TIMES; i++) follow(forecast, time_of[i] * school->interval, forecast->path[i]);
    TRY(sum(forecast, threads));
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < school->n_fish; f++) take_near(forecast, f);
    return STATUS_OK;
}

enum status forecast_make(struct forecast *forecast, const struct state *state, const struct forecast_points *points) {
    const enum status status = make(forecast, state, points);
    for (int f = 0; status != STATUS_OK && f < forecast->school->n_fish; f++) forecast->outlook[f].serves = 0;
    return status;
}

void forecast_place(struct forecast *forecast, double t) {
    const double tau = t - forecast->start;
    const double q = tau / forecast->school->interval;
    forecast->q = q;
    for (int i = 0; i < N_TIMES; i++) {
        forecast->weight[i] = 1;
        for (int k = 0; k < N_TIMES; k++) {
            if (k != i) forecast->weight[i] *= (q - time_of[k]) / (time_of[i] - time_of[k]);
        }
    }
    follow(forecast, tau, forecast->now);
    for (int f = 0; f < forecast->school->n_fish; f++) place_near(&forecast->outlook[f], tau, q, 1);
}

int forecast_holds(struct forecast *forecast, int f, const double *x, const double *y) {
    struct outlook *const outlook = &forecast->outlook[f];
    if (!outlook->serves) return 0;
    const int first = forecast->points[f].first;
    double square = 0;
    for (int p = 0; p < forecast->points[f].n; p++) {
        const double dx = x[p] - forecast->now[0][first + p], dy = y[p] - forecast->now[1][first + p];
        square = max_of(square, dx * dx + dy * dy);
    }
    // written so that NaN does not pass
    outlook->serves = outlook->second * square + outlook->drifting * sqrt(square) <= outlook->allowed / 2;
    return outlook->serves;
}

void forecast_induce(const struct forecast *forecast, int f, int first, const struct induced *at) {
    const double q = forecast->q;
    for (int i = 0; i < at->n; i++) {
        const int p = first + i;
        const double dx = at->x[i] - forecast->now[0][p], dy = at->y[i] - forecast->now[1][p];
        const double u_x = (1 - q) * forecast->u_x[0][p] + q * forecast->u_x[END][p];
        const double u_y = (1 - q) * forecast->u_y[0][p] + q * forecast->u_y[END][p];
        const double v_x = (1 - q) * forecast->v_x[0][p] + q * forecast->v_x[END][p];
        double u = u_x * dx + u_y * dy, v = v_x * dx - u_x * dy;
        for (int k = 0; k < N_TIMES; k++) {
            u += forecast->weight[k] * forecast->velocity_u[k][p];
            v += forecast->weight[k] * forecast->velocity_v[k][p];
        }
        at->u[i] += u;
        at->v[i] += v;
        if (at->u_x) {
            at->u_x[i] += u_x;
            at->u_y[i] += u_y;
            at->v_x[i] += v_x;
        }
    }
    const struct vortices *const near = &forecast->outlook[f].now;
    vortices_induce(near, (struct range){0, near->n}, at);
}

int forecast_near(const struct forecast *forecast, int f) {
    return forecast->outlook[f].serves ? forecast->outlook[f].n_near : -1;
}
