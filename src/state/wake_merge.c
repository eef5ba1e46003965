/* wake_merge.c: circles around bodies, velocity change by a merged pair, and compaction of the queue. */
#include <limits.h>
#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "state/state.h"

static const double two_pi = 6.28318530717958647692;

/* No pair is merged within this distance of a body, lengths; the taper of the wake of the body ends there too
 * (sheet.h). */
static const double nearest = 2;

/* The newest vortices of a queue are never merged. */
enum { NEWEST = 16 };

/* A moving circle around a body. */
struct body {
    double at[2], velocity[2], radius;
    double nearest;    /* no merging below this distance, m */
    double per_moment; /* cube of the distance over sum |Gamma| d^2 at the largest allowed velocity change */
};

/* The vortex, or marker, that replaces a pair. */
struct merged {
    double x[2], u[2], u_before[2];
    double circulation;   /* circulation, or label of a marker, m2 s-1 */
    double rate[2];       /* rate of the label, now and at the event before */
    double second_moment; /* sum |Gamma| d^2 before and after the merge, m4 s-1 */
    double span;          /* largest d, m */
};

// whether all bodies are far enough from a pair with a remaining lifetime of life, s
static bool is_far(const struct body *body, int n, const struct merged *pair, double life) {
    const double moment = pair->second_moment;
    if (!isfinite(moment)) return false;

    for (int f = 0; f < n; f++) {
        const double r[2] = {pair->x[0] - body[f].at[0], pair->x[1] - body[f].at[1]};
        const double w[2] = {pair->u[0] - body[f].velocity[0], pair->u[1] - body[f].velocity[1]};
        const double approach = -(r[0] * w[0] + r[1] * w[1]), square = w[0] * w[0] + w[1] * w[1];

        // time of the closest approach, for constant velocities
        const double t = approach <= 0 ? 0 : approach < life * square ? approach / square : life;
        const double gap = hypot(r[0] + t * w[0], r[1] + t * w[1]) - body[f].radius - pair->span;
        if (gap < body[f].nearest || gap * gap * gap < moment * body[f].per_moment) return false;
    }
    return true;
}

// add one vortex, before or after the merge, to the second moment of a pair
static void add_moment(struct merged *pair, double circulation, double x, double y) {
    const double d = hypot(x - pair->x[0], y - pair->x[1]);
    pair->second_moment += fabs(circulation) * d * d;
    pair->span = fmax(pair->span, d);
}

// weighted mean of the n vortices with the numbers at; the weights have the sum 1
static struct merged mean_of(const struct wake *wake, int n, const int *at, const double *weight) {
    struct merged mean = {.x = {0}};
    for (int k = 0; k < n; k++) {
        mean.x[0] += weight[k] * wake->x[at[k]];
        mean.x[1] += weight[k] * wake->y[at[k]];
        mean.u[0] += weight[k] * wake->u[at[k]];
        mean.u[1] += weight[k] * wake->v[at[k]];
        mean.u_before[0] += weight[k] * wake->u_before[at[k]];
        mean.u_before[1] += weight[k] * wake->v_before[at[k]];
    }
    return mean;
}

// merge the two middle ones of the vortices or markers with these numbers; two vortices may be the only ones
static struct merged merge_pair(const struct wake *wake, const int at[4]) {
    if (!wake->has_markers) {
        const double g[2] = {wake->circulation[at[1]], wake->circulation[at[2]]}, sum = g[0] + g[1];
        struct merged pair = mean_of(wake, 2, at + 1, (const double[]){g[0] / sum, g[1] / sum});
        pair.circulation = sum;
        for (int k = 0; k < 2; k++) add_moment(&pair, g[k], wake->x[at[k + 1]], wake->y[at[k + 1]]);
        return pair;
    }

    double g[3], sum = 0;
    for (int k = 0; k < 3; k++) {
        g[k] = wake->circulation[at[k + 1]] - wake->circulation[at[k]];
        sum += g[k];
    }

    const double half = g[1] / 2;
    struct merged pair =
        mean_of(wake, 4, at, (const double[]){-half / sum, (g[0] + g[1]) / sum, (g[1] + g[2]) / sum, -half / sum});
    pair.circulation = wake->circulation[at[1]] + half;
    pair.rate[0] = (wake->rate[at[1]] + wake->rate[at[2]]) / 2;
    pair.rate[1] = (wake->rate_before[at[1]] + wake->rate_before[at[2]]) / 2;

    // second moment: the three stretches before, and the two stretches after
    for (int k = 0; k < 3; k++) {
        add_moment(&pair, g[k], (wake->x[at[k]] + wake->x[at[k + 1]]) / 2, (wake->y[at[k]] + wake->y[at[k + 1]]) / 2);
    }
    for (int k = 0; k < 2; k++) {
        const int end = at[3 * k];
        add_moment(&pair, g[2 * k] + half, (wake->x[end] + pair.x[0]) / 2, (wake->y[end] + pair.x[1]) / 2);
    }
    return pair;
}

// merge from the oldest vortex; a merged vortex and the next vortex are not merged again in this pass
static void merge_wake(const struct school *school, const struct body *body, struct state *state, int f) {
    struct wake *const wake = &state->wake[f];
    const double t = state->t;
    const struct impulse_moments before = impulse_of_wake(wake, school, t, 0);
    const int n = wake->n_vortex, last = n - NEWEST - 1;
    double *const values[] = {wake->x,        wake->y,           wake->u,     wake->v,    wake->u_before,
                              wake->v_before, wake->circulation, wake->birth, wake->rate, wake->rate_before};
    enum { N_VALUES = sizeof values / sizeof *values };

    // a pair of markers needs a marker on both sides
    int from = wake->has_markers, to = from;
    while (from < n) {
        if (from < last) {
            const int at[4] = {to - 1, from, from + 1, from + 2};
            const struct merged pair = merge_pair(wake, at);
            const double birth = wake->birth[from + 1];
            if (is_far(body, school->n_fish, &pair, school->lifetime - (t - birth))) {
                const double merged[N_VALUES] = {pair.x[0],        pair.x[1],        pair.u[0],        pair.u[1],
                                                 pair.u_before[0], pair.u_before[1], pair.circulation, birth,
                                                 pair.rate[0],     pair.rate[1]};
                for (int k = 0; k < N_VALUES; k++) values[k][to] = merged[k];
                to++;
                wake->n_merged++;
                from += 2;
            }
        }

        for (int k = 0; k < N_VALUES; k++) values[k][to] = values[k][from];
        to++;
        from++;
    }
    if (to == from) return;

    wake->n_vortex = to;
    wake->version++;

    const struct impulse_moments after = impulse_of_wake(wake, school, t, 0);
    impulse_book(&state->momentum[f], &before, &after);
}

void wake_merge(const struct school *school, struct state *state) {
    if (school->wake_merge <= 0) return;
    struct arena *const scratch = arena_create(state->arena, "circles around bodies");
    struct body *body;
    NEW(scratch, body, school->n_fish);

    // a circle around the nodes of every body, with the mean velocity
    int n_vortices = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const double *const y = state->y, part = 1.0 / fish->n_nodes;
        struct body *const of = &body[f];
        of->nearest = nearest * fish->length;
        for (int k = 0; k < fish->n_nodes; k++) {
            of->at[0] += part * y[fish->at.x + k];
            of->at[1] += part * y[fish->at.y + k];
            of->velocity[0] += part * y[fish->at.vx + k];
            of->velocity[1] += part * y[fish->at.vy + k];
        }

        for (int k = 0; k < fish->n_nodes; k++) {
            of->radius = fmax(of->radius, hypot(y[fish->at.x + k] - of->at[0], y[fish->at.y + k] - of->at[1]));
        }

        const double change =
            school->wake_merge * fish->length * fish_rate(school, fish) / wake_most(school, LONG_MAX - 1);
        of->per_moment = sqrt(2) / (two_pi * change);
        n_vortices += state->wake[f].n_vortex / WAKE_MERGE_EVENTS;
    }

    const int threads =
        parallel_threads(school->threads, school->n_fish, (double)n_vortices * school->n_fish, PARALLEL_VORTICES);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < school->n_fish; f++) {
        if ((state->event + f) % WAKE_MERGE_EVENTS == 0) merge_wake(school, body, state, f);
    }
    arena_free(scratch);
}
