/* forecast.c: cubics in time for the far vortices, the near ones as they are. */
#include "forecast.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "forecast_outlook.h"
#include "summation.h"

enum { N_TIMES = 4, END = N_TIMES - 1 };

/* The times, as parts of the interval: of all four with both ends these have the least largest |product of (q - time)|,
 * (3 - 2 sqrt(2))/16: the cubic_error of forecast_outlook.c. */
static const double time_of[N_TIMES] = {0, 0.29289321881345248, 0.70710678118654752, 1};

struct forecast {
    const struct school *school;
    double start, q;        /* time of the event, s; part of the interval that has passed */
    double weight[N_TIMES]; /* of the values at the four times, now */
    int n_points;
    const struct range *points;       /* of each fish                                    (n_fish) */
    struct forecast_outlook *outlook; /*                                                    (n_fish) */

    double *motion[6];                                  /* of all points at the event: x y, u v, a b (n_points) */
    double *now[2];                                     /* where they are foretold to be now, m      (n_points) */
    double *path[N_TIMES][2];                           /* and at the times of the forecast          (n_points) */
    double *velocity_u[N_TIMES], *velocity_v[N_TIMES];  /* of the fluid there, m s-1                 (n_points) */
    double *u_x[N_TIMES], *u_y[N_TIMES], *v_x[N_TIMES]; /* its gradient at both ends, s-1          (n_points) */

    struct summation *summation;
    struct vortices released[N_TIMES]; /* of all fish */
    struct range *wake;                /* those of each fish                       (n_fish) */
    struct forecast_bounds *bounds;    /* of each wake                             (n_fish) */
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
        forecast_outlook_free(&forecast->outlook[f]);
    }
    summation_free(forecast->summation);
    free(forecast->outlook);
    free(forecast->wake);
    free(forecast->bounds);
    free(forecast);
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
    struct forecast_outlook *const outlook = &forecast->outlook[f];
    if (!outlook->serves || outlook->n_near == 0) return;
    for (int i = 0; i < N_TIMES; i++) {
        const struct induced all = at_time(forecast, i), at = vortices_targets(&all, forecast->points[f]);
        forecast_place_near(outlook, time_of[i] * forecast->school->interval, time_of[i], -1);
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
        forecast->bounds[g] =
            forecast_bound_wake(&state->wake[g], school->interval, forecast->released[0].circulation + first,
                                forecast->released[END].circulation + first);
    }
    const double work = (double)N_TIMES * forecast->n_points * forecast->released[0].n;
    const int threads = vortices_threads(school->threads, work);
    const struct forecast_scene scene = {.school = school,
                                         .state = state,
                                         .points = forecast->points,
                                         .motion = forecast->motion,
                                         .bounds = forecast->bounds,
                                         .wake = forecast->wake,
                                         .before = forecast->released[0].circulation,
                                         .after = forecast->released[END].circulation,
                                         .n_released = forecast->released[0].n};
    enum status status = STATUS_OK;
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < school->n_fish; f++) {
        const enum status here = forecast_look_out(&forecast->outlook[f], &scene, f);
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
    for (int f = 0; f < forecast->school->n_fish; f++) forecast_place_near(&forecast->outlook[f], tau, q, 1);
}

int forecast_holds(struct forecast *forecast, int f, const double *x, const double *y) {
    struct forecast_outlook *const outlook = &forecast->outlook[f];
    if (!outlook->serves) return 0;
    const int first = forecast->points[f].first;
    double square = 0;
    for (int p = 0; p < forecast->points[f].n; p++) {
        const double dx = x[p] - forecast->now[0][first + p], dy = y[p] - forecast->now[1][first + p];
        const double here = dx * dx + dy * dy;
        square = here > square ? here : square;
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
