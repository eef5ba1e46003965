/* wake_interpolation.c: cubics in time for the far field, exact sums for the near field. */
#include "wake/wake_interpolation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "vortex/velocity_sum.h"
#include "wake/near_field.h"

enum { N_TIMES = 4, END = N_TIMES - 1 };

/* The times as fractions of the interval. Of all four times with both ends of the interval, these have the smallest
 * maximum of the product of |q - time|, (3 - 2 sqrt(2))/16: the cubic_error of near_field.c. */
static const double time_of[N_TIMES] = {0, 0.29289321881345248, 0.70710678118654752, 1};

struct wake_interpolation {
    const struct school *school;
    double start, q;        /* time of the event, s; current time as a fraction of the interval */
    double weight[N_TIMES]; /* current weights of the values at the four times */
    int n_points;
    const struct range *points;      /* of each fish                                    (n_fish) */
    const struct range *without_own; /* see wake_interpolation_create                 (n_fish) */
    struct near_field *near_field;   /*                                                    (n_fish) */

    double *motion[6];        /* of all points at the event: x y, u v, a b (n_points) */
    double *predicted[2];     /* predicted positions at the current time, m        (n_points) */
    double *path[N_TIMES][2]; /* predicted positions at the four times, m          (n_points) */
    double *velocity_u[N_TIMES], *velocity_v[N_TIMES]; /* velocity of the fluid on these paths, m s-1      (n_points) */
    double *u_x[N_TIMES], *u_y[N_TIMES],
        *v_x[N_TIMES]; /* velocity gradient at both ends, s-1              (n_points) */

    struct velocity_sum *velocity_sum;
    struct vortices released[N_TIMES]; /* of all fish */
    struct range *wake;                /* released vortices of each fish                (n_fish) */
    double *opposite;                  /* circulations at one time with opposite sign  (n_opposite) */
    int n_opposite;
    struct near_field_bounds *bounds; /* of each wake                             (n_fish) */
};

static enum status allocate_at_points(double **values, int n) {
    return MEMORY_NEW(*values, n, "velocity of the wakes at points");
}

static enum status wake_interpolation_allocate(struct wake_interpolation *interpolation) {
    TRY(velocity_sum_create(&interpolation->velocity_sum));
    const size_t n_fish = (size_t)interpolation->school->n_fish;
    TRY(MEMORY_NEW(interpolation->near_field, n_fish, "velocity of the wakes at the fish"));
    TRY(MEMORY_NEW(interpolation->wake, n_fish, "velocity of the wakes at the fish"));
    TRY(MEMORY_NEW(interpolation->bounds, n_fish, "velocity of the wakes at the fish"));

    const int n = interpolation->n_points;
    for (int i = 0; i < 6; i++) TRY(allocate_at_points(&interpolation->motion[i], n));
    for (int i = 0; i < 2; i++) TRY(allocate_at_points(&interpolation->predicted[i], n));
    for (int i = 0; i < N_TIMES; i++) {
        for (int k = 0; k < 2; k++) TRY(allocate_at_points(&interpolation->path[i][k], n));
        TRY(allocate_at_points(&interpolation->velocity_u[i], n));
        TRY(allocate_at_points(&interpolation->velocity_v[i], n));
        if (i > 0 && i < END) continue;
        TRY(allocate_at_points(&interpolation->u_x[i], n));
        TRY(allocate_at_points(&interpolation->u_y[i], n));
        TRY(allocate_at_points(&interpolation->v_x[i], n));
    }

    return STATUS_OK;
}

enum status wake_interpolation_create(struct wake_interpolation **interpolation, const struct school *school,
                                      const struct range *points, const struct range *without_own) {
    *interpolation = NULL;
    struct wake_interpolation *new;
    TRY(MEMORY_NEW(new, 1, "interpolation of wakes"));
    new->school = school;
    for (int f = 0; f < school->n_fish; f++) new->n_points += points[f].n;
    new->points = points;
    new->without_own = without_own;
    const enum status status = wake_interpolation_allocate(new);
    if (status != STATUS_OK) {
        wake_interpolation_free(new);
        return status;
    }

    *interpolation = new;
    return STATUS_OK;
}

void wake_interpolation_free(struct wake_interpolation *interpolation) {
    if (!interpolation) return;
    for (int i = 0; i < 6; i++) free(interpolation->motion[i]);
    for (int i = 0; i < 2; i++) free(interpolation->predicted[i]);
    for (int i = 0; i < N_TIMES; i++) {
        for (int k = 0; k < 2; k++) free(interpolation->path[i][k]);
        double *const allocate_at_points[] = {interpolation->velocity_u[i], interpolation->velocity_v[i],
                                              interpolation->u_x[i], interpolation->u_y[i], interpolation->v_x[i]};
        for (size_t k = 0; k < sizeof allocate_at_points / sizeof *allocate_at_points; k++) free(allocate_at_points[k]);
        vortices_free(&interpolation->released[i]);
    }

    for (int f = 0; interpolation->near_field && f < interpolation->school->n_fish; f++) {
        near_field_free(&interpolation->near_field[f]);
    }

    velocity_sum_free(interpolation->velocity_sum);
    free(interpolation->near_field);
    free(interpolation->opposite);
    free(interpolation->wake);
    free(interpolation->bounds);
    free(interpolation);
}

// predicted positions of all points
static void predict_paths(const struct wake_interpolation *interpolation, double tau, double *const path[2]) {
    for (int k = 0; k < 2; k++) {
        const double *const x = interpolation->motion[k], *const u = interpolation->motion[2 + k],
                            *const a = interpolation->motion[4 + k];
        for (int p = 0; p < interpolation->n_points; p++) path[k][p] = x[p] + tau * (u[p] + tau / 2 * a[p]);
    }
}

// reserve the released vortices of all wakes
static enum status reserve_released(const struct school *school, const struct wake *wakes, struct vortices *released,
                                    struct range *wake) {
    vortices_clear(released);
    for (int g = 0; g < school->n_fish; g++) {
        wake[g] = (struct range){released->n, wakes[g].n_vortex};
        TRY(vortices_append(released, wake[g].n, school->fish[g].smoothing));
    }
    return STATUS_OK;
}

// reserve the opposite of all circulations
static enum status reserve_opposite(struct wake_interpolation *interpolation) {
    const int n = interpolation->released[0].n;
    if (n <= interpolation->n_opposite) return STATUS_OK;
    free(interpolation->opposite);
    interpolation->n_opposite = 0;
    TRY(MEMORY_NEW(interpolation->opposite, n + n / 2, "the vortices of all wakes"));
    interpolation->n_opposite = n + n / 2;
    return STATUS_OK;
}

// positions and strengths of the released vortices of one wake, tau after the event at time t
static void place_released(const struct school *school, const struct wake *wake, double t, double tau, int first,
                           const struct vortices *released) {
    wake_at(wake, school, t, tau, released->x + first, released->y + first, released->circulation + first);
}

enum status wake_interpolation_released(const struct school *school, const struct wake *wakes, double t, double tau,
                                        struct vortices *released, struct range *wake) {
    TRY(reserve_released(school, wakes, released, wake));
    const int threads = parallel_threads(school->threads, school->n_fish, released->n, PARALLEL_VORTICES);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int g = 0; g < school->n_fish; g++) place_released(school, &wakes[g], t, tau, wake[g].first, released);
    return STATUS_OK;
}

static struct induced targets_at(const struct wake_interpolation *interpolation, int i) {
    return (struct induced){interpolation->n_points,      interpolation->path[i][0],    interpolation->path[i][1],
                            interpolation->velocity_u[i], interpolation->velocity_v[i], interpolation->u_x[i],
                            interpolation->u_y[i],        interpolation->v_x[i]};
}

// ---- steps of a build; `omp for` shares the loops among the threads of the calling region

// sum of every released vortex at every point and time
static void sum_directly(const struct wake_interpolation *interpolation) {
    const int n_tasks = N_TIMES * parallel_n_chunks(interpolation->n_points);
#pragma omp for schedule(dynamic)
    for (int task = 0; task < n_tasks; task++) {
        const int i = task % N_TIMES;
        const struct induced all = targets_at(interpolation, i);
        const struct induced at = vortices_targets(&all, parallel_chunk(task / N_TIMES, all.n));
        vortices_induce(&interpolation->released[i], (struct range){0, interpolation->released[i].n}, &at);
    }
}

// tree sum, planned once for all times, and the images of all vortices in walls, one time after another
static enum status sum_by_tree(const struct wake_interpolation *interpolation, int by_tree, int threads) {
    const double tolerance = interpolation->school->wake_tolerance;
    struct velocity_sum *const sum = interpolation->velocity_sum;
    if (by_tree) {
        const struct induced first = targets_at(interpolation, 0);
        TRY(velocity_sum_plan(sum, &interpolation->released[0], tolerance, threads, &first));
    }

    for (int i = 0; i < N_TIMES; i++) {
        const struct induced at = targets_at(interpolation, i);
        const struct vortices *const released = &interpolation->released[i];
        if (by_tree) TRY(velocity_sum_by_plan(sum, released, tolerance, threads, &at));
        TRY(images_induce_many(&interpolation->school->walls, sum, released, tolerance, threads, &at));
    }

    return STATUS_OK;
}

// the points of fish f at which its own vortices are omitted; indices relative to point number first
static struct range without_own(const struct wake_interpolation *interpolation, int f, int first) {
    const struct range points = interpolation->without_own[f];
    return (struct range){points.first - first, points.n};
}

// subtract the own wake of a fish, at time i, at the points at which the own wake is omitted
static void subtract_own(const struct wake_interpolation *interpolation, int f, int i) {
    const struct range own = interpolation->wake[f];
    const struct induced all = targets_at(interpolation, i);
    const struct induced at = vortices_targets(&all, interpolation->without_own[f]);
    struct vortices released = interpolation->released[i];

    if (at.n == 0) return;
    for (int k = own.first; k < own.first + own.n; k++) interpolation->opposite[k] = -released.circulation[k];
    released.circulation = interpolation->opposite;
    vortices_induce(&released, own, &at);
}

// subtract near vortices and own wake of a fish from the sums of all times
static void subtract(struct wake_interpolation *interpolation, int f) {
    struct near_field *const near_field = &interpolation->near_field[f];
    const struct range points = interpolation->points[f];
    for (int i = 0; i < N_TIMES && near_field->is_interpolated; i++) {
        const struct induced all = targets_at(interpolation, i), at = vortices_targets(&all, points);
        near_field_update(near_field, time_of[i] * interpolation->school->interval, time_of[i], -1);
        vortices_induce_without(&near_field->vortices, near_field->own, without_own(interpolation, f, points.first),
                                &at);
        subtract_own(interpolation, f, i);
    }
}

static void subtract_all(struct wake_interpolation *interpolation) {
#pragma omp for schedule(dynamic)
    for (int f = 0; f < interpolation->school->n_fish; f++) subtract(interpolation, f);
}

// released vortices at the four times, and bounds of each wake
static void place_wakes(const struct wake_interpolation *interpolation, const struct wake *wakes) {
    const struct school *const school = interpolation->school;
    const struct vortices *const released = interpolation->released;
#pragma omp for schedule(static)
    for (int g = 0; g < school->n_fish; g++) {
        const int first = interpolation->wake[g].first;
        for (int i = 0; i < N_TIMES; i++) {
            place_released(school, &wakes[g], interpolation->start, time_of[i] * school->interval, first, &released[i]);
        }
        interpolation->bounds[g] = near_field_bound_wake(&wakes[g], school->interval, released[0].circulation + first,
                                                         released[END].circulation + first);
    }
}

// divide the wakes into near and far field of every fish; n_failed counts the fish that are out of memory
static void find_near_fields(const struct wake_interpolation *interpolation, const struct wake *wakes, int *n_failed) {
    const struct near_field_input input = {.school = interpolation->school,
                                           .wakes = wakes,
                                           .points = interpolation->points,
                                           .motion = interpolation->motion,
                                           .bounds = interpolation->bounds,
                                           .wake = interpolation->wake,
                                           .strength_start = interpolation->released[0].circulation,
                                           .strength_end = interpolation->released[END].circulation,
                                           .n_released = interpolation->released[0].n};
#pragma omp for schedule(dynamic)
    for (int f = 0; f < interpolation->school->n_fish; f++) {
        if (near_field_find(&interpolation->near_field[f], &input, f) == STATUS_OK) continue;
#pragma omp atomic
        (*n_failed)++;
    }
}

static enum status wake_interpolation_try_build(struct wake_interpolation *interpolation, const struct wake *wakes,
                                                double t, const struct wake_interpolation_points *points) {
    const struct school *const school = interpolation->school;
    const struct vortices *const released = interpolation->released;
    const int n_points = interpolation->n_points;
    const double *const motion[6] = {points->x, points->y, points->u, points->v, points->a, points->b};

    for (int k = 0; k < 6; k++) memcpy(interpolation->motion[k], motion[k], (size_t)n_points * sizeof(double));

    interpolation->start = t;
    for (int i = 0; i < N_TIMES; i++) {
        TRY(reserve_released(school, wakes, &interpolation->released[i], interpolation->wake));
    }

    TRY(reserve_opposite(interpolation));

    const double work = (double)N_TIMES * n_points * released[0].n;
    const int threads = parallel_threads(school->threads, n_points, work, PARALLEL_INTERACTIONS);
    const int by_tree = velocity_sum_by_tree(&released[0], n_points, school->wake_tolerance);
    const int is_whole = !by_tree && school->walls.n == 0;

    int n_failed = 0;
#pragma omp parallel num_threads(threads)
    {
        place_wakes(interpolation, wakes);

        // targets of the sums at the four times
#pragma omp for schedule(static)
        for (int i = 0; i < N_TIMES; i++) {
            const struct induced at = targets_at(interpolation, i);
            predict_paths(interpolation, time_of[i] * interpolation->school->interval, interpolation->path[i]);
            vortices_zero(&at);
        }

        find_near_fields(interpolation, wakes, &n_failed);
        if (!by_tree) sum_directly(interpolation);
        if (is_whole && n_failed == 0) subtract_all(interpolation);
    }

    // messages are per thread: write the message on the calling thread
    if (n_failed > 0) return memory_check(NULL, "near vortices");

    if (is_whole) return STATUS_OK;
    TRY(sum_by_tree(interpolation, by_tree, threads));
#pragma omp parallel num_threads(threads)
    subtract_all(interpolation);
    return STATUS_OK;
}

enum status wake_interpolation_build(struct wake_interpolation *interpolation, const struct wake *wakes, double t,
                                     const struct wake_interpolation_points *points) {
    const enum status status = wake_interpolation_try_build(interpolation, wakes, t, points);
    for (int f = 0; status != STATUS_OK && f < interpolation->school->n_fish; f++) {
        interpolation->near_field[f].is_interpolated = 0;
    }
    return status;
}

void wake_interpolation_update(struct wake_interpolation *interpolation, double t) {
    const double tau = t - interpolation->start;
    const double q = tau / interpolation->school->interval;
    interpolation->q = q;
    for (int i = 0; i < N_TIMES; i++) {
        interpolation->weight[i] = 1;
        for (int k = 0; k < N_TIMES; k++) {
            if (k != i) interpolation->weight[i] *= (q - time_of[k]) / (time_of[i] - time_of[k]);
        }
    }

    predict_paths(interpolation, tau, interpolation->predicted);
    const int threads = fish_threads(interpolation->school);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < interpolation->school->n_fish; f++) near_field_update(&interpolation->near_field[f], tau, q, 1);
}

int wake_interpolation_is_valid(const struct wake_interpolation *interpolation, int f, const double *x,
                                const double *y) {
    const int first = interpolation->points[f].first;
    double drift_square = 0;
    for (int p = 0; p < interpolation->points[f].n; p++) {
        const double dx = x[p] - interpolation->predicted[0][first + p];
        const double dy = y[p] - interpolation->predicted[1][first + p];
        const double here = dx * dx + dy * dy;
        drift_square = here > drift_square ? here : drift_square;
    }

    return near_field_is_valid(&interpolation->near_field[f], drift_square);
}

void wake_interpolation_induce(const struct wake_interpolation *interpolation, int f, int first,
                               const struct induced *at) {
    const double q = interpolation->q;
    for (int i = 0; i < at->n; i++) {
        const int p = first + i;
        const double dx = at->x[i] - interpolation->predicted[0][p], dy = at->y[i] - interpolation->predicted[1][p];

        // gradient, linear in time
        const double u_x = (1 - q) * interpolation->u_x[0][p] + q * interpolation->u_x[END][p];
        const double u_y = (1 - q) * interpolation->u_y[0][p] + q * interpolation->u_y[END][p];
        const double v_x = (1 - q) * interpolation->v_x[0][p] + q * interpolation->v_x[END][p];

        // drift term, and cubic in time
        double u = u_x * dx + u_y * dy, v = v_x * dx - u_x * dy;
        for (int k = 0; k < N_TIMES; k++) {
            u += interpolation->weight[k] * interpolation->velocity_u[k][p];
            v += interpolation->weight[k] * interpolation->velocity_v[k][p];
        }

        at->u[i] += u;
        at->v[i] += v;
        if (at->u_x) {
            at->u_x[i] += u_x;
            at->u_y[i] += u_y;
            at->v_x[i] += v_x;
        }
    }

    const struct near_field *const near_field = &interpolation->near_field[f];
    vortices_induce_without(&near_field->vortices, near_field->own, without_own(interpolation, f, first), at);
}

int wake_interpolation_n_near(const struct wake_interpolation *interpolation, int f) {
    return interpolation->near_field[f].is_interpolated ? interpolation->near_field[f].n_near : -1;
}
