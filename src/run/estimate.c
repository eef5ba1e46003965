/* estimate.c: measures the first events of a run and events with synthetic wakes, and extrapolates to the whole run. */
#include "run/estimate.h"

#include <math.h>
#include <sys/resource.h>

#include "base/parallel.h"
#include "wake/stretch.h"

/* The shape of a synthetic wake: it leaves the tail by `drift` body lengths per beat and swings to both sides by
 * `width` body lengths. */
static const double drift = 0.5, width = 0.1;

/* Memory of NetCDF, and of the copy of a small state at the last event, bytes. */
static const double bytes_of_file = 7e6;

/* Residual evaluations per event, used while no event has been completed: doc/numerics.md, section 4. */
static const double usual_evaluations = 12;

/* Memory per vortex, bytes, used if the synthetic wakes are too short to measure it. 200,000 vortices take 370 MB,
 * because arrays that grow leave their old pieces to the arena. */
static const double usual_bytes = 1900;

/* Vortices per fish in the first synthetic wake, which doubles from wake to wake, and the largest number of wakes. */
enum { FIRST_WAKE = 64, MAX_WAKES = 24 };

/* What an event costs with a given number of vortices per fish; released vortices are counted, of which some have been
 * dropped. Entry 0 is the cost with the actual wakes. Beyond the last entry the added time is taken to grow as n^2 up
 * to the number of vortices from which the tree sums, and as n log n from there; memory grows linearly. */
struct costs {
    int n;
    double vortices[MAX_WAKES + 1], seconds[MAX_WAKES + 1], bytes[MAX_WAKES + 1], by_tree;
    double stays; /* the fraction of the vortices of the last entry that was not dropped */
};

static double bytes_so_far(void) {
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * (double)usage.ru_maxrss;
}

// the cost of one event plus a number of residual evaluations with the present wakes
static enum status event_cost(struct simulation *simulation, double evaluations, double *seconds) {
    struct state *const state = simulation->state;
    struct residual *const residual = simulation->residual;

    double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    TRY(simulate_event(simulation));
    *seconds = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start;

    // the first evaluation after an event also selects the sources of the wakes, the others only move them
    const double repeats[2] = {1, fmax(0, evaluations - 1)};
    for (int i = 0; i < 2; i++) {
        const double t = state->t + (i + 1) * simulation->school->interval / 3;
        start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
        TRY(residual_evaluate(residual, &residual_run, t, state->y, state->yp, residual->scratch));
        *seconds += repeats[i] * (clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start);
    }
    return STATUS_OK;
}

// Run the first events, and find what one costs and how often it evaluates the equations.
static enum status measure_first_events(struct simulation *simulation, double patience, struct estimate *estimate,
                                        double *seconds, double *evaluations) {
    const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    double first = 0, spent = 0;
    struct integrator_counts after_first = {0};
    long n = 0;
    while (n < simulation->n_events && (n < 2 || spent < patience)) {
        const enum status status = simulate_step(simulation);
        if (status == STATUS_STOPPED) break;
        TRY(status);
        spent = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start;
        if (n++ == 0) {
            first = spent;
            after_first = simulation->totals;
        }
    }

    estimate->n_events = n;
    *evaluations = usual_evaluations;
    if (n == 0) {
        // extrapolate from the completed part of the first event
        struct integrator_counts now;
        simulate_count(simulation, &now);
        *seconds = (clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start) *
                   fmax(1, usual_evaluations / fmax(1, (double)now.residual_evaluations));
        return STATUS_OK;
    }

    // leave out the first event, which costs more than the others
    *seconds = n > 1 ? (spent - first) / (double)(n - 1) : first;
    const long rest = simulation->totals.residual_evaluations - (n > 1 ? after_first.residual_evaluations : 0);
    *evaluations = (double)rest / (double)(n > 1 ? n - 1 : 1);
    return STATUS_OK;
}

// Measure events with synthetic wakes of doubling length for as long as there is time for the next one; doubling the
// number of vortices raises the cost at most fourfold.
static enum status measure_synthetic_wakes(struct simulation *simulation, double end, double evaluations,
                                           struct costs *costs) {
    const struct school *const school = simulation->school;
    struct state *const state = simulation->state;
    const int most = wake_most(school, simulation->n_events);

    // entry 0: the actual wakes
    int n = wake_most(school, state->event) < most ? wake_most(school, state->event) : most;
    costs->vortices[0] = fmax(1, n);
    costs->stays = fmin(1, state->wake[0].n_vortex / costs->vortices[0]);
    TRY(event_cost(simulation, evaluations, &costs->seconds[0]));
    costs->bytes[0] = bytes_so_far();

    while (n < most && costs->n <= MAX_WAKES) {
        const double left = simulation->stop && *simulation->stop ? 0 : end - clock_seconds(CLOCK_THREAD_CPUTIME_ID);
        if (!(left > 4 * costs->seconds[costs->n - 1])) break;
        n = (int)fmin(most, fmax(FIRST_WAKE, 2.0 * n));

        // replace the wakes by synthetic ones of n vortices, the newest at the tail
        for (int f = 0; f < school->n_fish; f++) {
            const struct fish *const fish = &school->fish[f];
            struct wake *const wake = &state->wake[f];
            const int last = fish->n_nodes - 1;
            const double *const x = state->y + fish->at.x, *const y = state->y + fish->at.y;
            const double along[2] = {(x[last] - x[0]) / fish->length, (y[last] - y[0]) / fish->length};
            const double rate = fish_rate(school, fish), spacing = drift * fish->length * rate * school->interval;
            wake_resize(wake, n);
            wake->version++;
            for (int i = 0; i < n; i++) {
                const double age = (n - 1 - i) * school->interval, phase = 2 * M_PI * rate * age;
                const double behind = (n - 1 - i) * spacing, beside = width * fish->length * sin(phase);
                wake->x[i] = x[last] + behind * along[0] - beside * along[1];
                wake->y[i] = y[last] + behind * along[1] + beside * along[0];
                wake->u[i] = wake->v[i] = wake->u_before[i] = wake->v_before[i] = 0;
                wake->rate[i] = wake->rate_before[i] = 0;
                wake->circulation[i] = 0.01 * fish->length * fish->length * rate * cos(phase);
                wake->birth[i] = state->t - age;
            }

            // drop markers until none is left to drop, as a run does event by event
            wake->n_old = 0;
            stretch_find_old(wake, fish, school);
            for (int before = -1; before != wake->n_vortex;) {
                before = wake->n_vortex;
                stretch_drop(wake, fish, school);
            }
        }
        costs->vortices[costs->n] = n;
        costs->stays = (double)state->wake[0].n_vortex / n;
        TRY(event_cost(simulation, evaluations, &costs->seconds[costs->n]));
        costs->bytes[costs->n] = bytes_so_far();
        costs->n++;
    }

    return STATUS_OK;
}

// what an event with so many vortices per fish costs more than entry 0
static double event_added_cost(const struct costs *costs, double vortices) {
    int i = 0;
    while (i < costs->n - 1 && vortices > costs->vortices[i + 1]) i++;
    const double from = costs->seconds[i] - costs->seconds[0];
    if (i == costs->n - 1) {
        const double last = costs->vortices[i], direct = fmax(last, fmin(vortices, costs->by_tree));
        return fmax(0, from * pow(direct / last, 2) * pow(vortices / direct, 1.1));
    }
    const double part = (vortices - costs->vortices[i]) / (costs->vortices[i + 1] - costs->vortices[i]);
    return fmax(0, from + part * (costs->seconds[i + 1] - costs->seconds[i]));
}

enum status estimate_run(struct simulation *simulation, double patience, struct estimate *estimate) {
    const double end = clock_seconds(CLOCK_THREAD_CPUTIME_ID) + patience;
    double each, evaluations;
    struct costs costs = {.n = 1, .vortices = {1}, .stays = 1};
    TRY(measure_first_events(simulation, patience / 2, estimate, &each, &evaluations));

    // A run that has ended already has its longest wakes. A synthetic wake does not fit the body, so a failure of the
    // solver with it predicts no failure of the run.
    const double most = wake_most(simulation->school, simulation->n_events);
    if (estimate->n_events == simulation->n_events) {
        costs.vortices[0] = most;
    } else {
        measure_synthetic_wakes(simulation, end, evaluations, &costs);
    }

    // from so many vortices on, the tree is faster (tree_is_faster)
    const struct school *const school = simulation->school;
    const struct kernel *const kernel = simulation->residual->flow->kernel;
    costs.by_tree = school->wake_tolerance > 0 ? fmax(kernel->tree_sources, sqrt(kernel->tree_interactions)) : INFINITY;
    costs.by_tree /= school->n_fish * costs.stays;

    // sum over all events: in panels while the wakes grow, then with wakes of constant length
    enum { PANELS = 2000 };
    const double n_events = (double)simulation->n_events, growing = fmin(most, n_events);
    double sum = 0;
    for (int i = 0; i < PANELS; i++) sum += event_added_cost(&costs, (i + 0.5) * growing / PANELS) * growing / PANELS;
    estimate->seconds = n_events * each + sum + (n_events - growing) * event_added_cost(&costs, most);

    // memory with the longest wakes; what one vortex needs is measured by the last doubling
    const int last = costs.n - 1, n_fish = school->n_fish, enough = 20000;
    const double more = last > 0 ? (costs.vortices[last] - costs.vortices[last - 1]) * n_fish : 0;
    const double bytes_each =
        more > enough ? (costs.bytes[last] - costs.bytes[last - 1]) / more : costs.stays * usual_bytes;
    estimate->bytes = bytes_so_far() + bytes_of_file + fmax(0, most - costs.vortices[last]) * n_fish * bytes_each;

    // the samples of a period
    for (int f = 0; f < n_fish; f++) {
        const struct history *const history = &simulation->state->history[f];
        const double n_samples = fmax(0, fmin(history->capacity, n_events) - history->n_slots);
        estimate->bytes += n_samples * sizeof(struct sample);
    }
    return STATUS_OK;
}

double estimate_of_study(double seconds, int n_estimated, int n_failed, int n_members) {
    return seconds * n_members / (n_estimated + n_failed);
}
