/* estimate.c: a few events, wakes that are made up, and a parabola through what they cost. */
#include "run/estimate.h"

#include <math.h>
#include <sys/resource.h>
#include <time.h>

#include "run/event.h"

/* A wake that is made up leaves the tail with this part of the speed of the beat, and is as wide as this part of the
 * body. */
static const double drift = 0.5, width = 0.1;

/* What NetCDF takes, and the state that a run keeps of its last event, if that is not large. */
static const double bytes_of_file = 7e6;

/* Of this thread, which has a part in all work and does not count what other programs do. */
static double processor_time(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// vortices of all fish
static double n_vortices(const struct state *state, const struct school *school) {
    double n = 0;
    for (int f = 0; f < school->n_fish; f++) n += state->wake[f].n_vortex;
    return n;
}

// replace the wake of a fish by one of n vortices, the newest at its tail
static enum status make_up_wake(const struct school *school, struct state *state, int f, int n) {
    const struct fish *const fish = &school->fish[f];
    struct wake *const wake = &state->wake[f];
    const int last = fish->n_nodes - 1;
    const double *const x = state->y + fish->at.x, *const y = state->y + fish->at.y;
    const double along[2] = {(x[last] - x[0]) / fish->length, (y[last] - y[0]) / fish->length};
    const double rate = fish_rate(school, fish), spacing = drift * fish->length * rate * school->interval;
    TRY(wake_resize(wake, n));
    wake->version++;
    for (int i = 0; i < n; i++) {
        const double age = (n - 1 - i) * school->interval, phase = 2 * M_PI * rate * age;
        const double behind = (n - 1 - i) * spacing, beside = width * fish->length * sin(phase);
        wake->x[i] = x[last] + behind * along[0] - beside * along[1];
        wake->y[i] = y[last] + behind * along[1] + beside * along[0];
        wake->u[i] = wake->v[i] = wake->u_before[i] = wake->v_before[i] = 0;
        wake->circulation[i] = 0.01 * fish->length * fish->length * rate * cos(phase);
        wake->birth[i] = state->t - age;
    }
    return STATUS_OK;
}

// what one event, and the evaluation of the equations so many times, cost with the present wakes
static enum status measure_event(struct simulation *simulation, double evaluations, double *seconds) {
    struct state *const state = simulation->state;
    struct residual *const residual = simulation->residual;
    int jumped;
    double start = processor_time();
    TRY(event_next(state, residual, simulation->consistent, &jumped));
    *seconds = processor_time() - start;
    start = processor_time();
    TRY(residual_evaluate(residual, state->t, state->y, state->yp, residual->scratch));
    *seconds += evaluations * (processor_time() - start);
    return STATUS_OK;
}

// the first events of the run; what one costs, and how often it evaluates the equations
static enum status measure_start(struct simulation *simulation, double patience, struct estimate *estimate,
                                 double *seconds, double *evaluations) {
    const double start = processor_time();
    double first = 0, spent = 0;
    struct integrator_counts after_first = {0};
    long n = 0;
    while (n < simulation->n_events && (n == 0 || spent < patience)) {
        TRY(simulate_step(simulation));
        spent = processor_time() - start;
        if (n++ == 0) {
            first = spent;
            after_first = simulation->totals;
        }
    }
    estimate->n_events = n;
    // the first one is dearer than those that follow
    *seconds = n > 1 ? (spent - first) / (double)(n - 1) : first;
    const long rest = simulation->totals.residual_evaluations - (n > 1 ? after_first.residual_evaluations : 0);
    *evaluations = (double)rest / (double)(n > 1 ? n - 1 : 1);
    return STATUS_OK;
}

/* What is added to the cost of an event with w vortices: 0, e[1], e[2] at w[0], w[1], w[2]; between them a parabola. */
static double added(const double w[3], const double e[3], double at) {
    const double slope = e[1] / (w[1] - w[0]), next = (e[2] - e[1]) / (w[2] - w[1]);
    const double value = (at - w[0]) * (slope + (at - w[1]) * (next - slope) / (w[2] - w[0]));
    return fmax(0, value);
}

// the sum over all events that have not been done
static double sum_up(const struct simulation *simulation, const double w[3], const double e[3], double each) {
    const struct school *const school = simulation->school;
    const double per_event = school->n_fish;
    const int is_long = w[2] > w[1] && w[1] > w[0];
    double sum = 0;
    for (long event = 1; event <= simulation->n_events; event++) {
        const double at = fmin((double)event * per_event, w[2]);
        sum += each + (is_long ? added(w, e, at) : 0);
    }
    return sum;
}

enum status estimate_run(struct simulation *simulation, double patience, struct estimate *estimate) {
    struct state *const state = simulation->state;
    const struct school *const school = simulation->school;
    double each, evaluations, w[3], e[3] = {0};
    TRY(measure_start(simulation, patience, estimate, &each, &evaluations));
    w[0] = n_vortices(state, school);
    double now = 0;
    TRY(measure_event(simulation, evaluations, &now));
    for (int i = 1; i < 3; i++) {
        const int n = (int)(wake_most(school, simulation->n_events) * (i / 2.0));
        for (int f = 0; f < school->n_fish; f++) {
            if (n > state->wake[f].n_vortex) TRY(make_up_wake(school, state, f, n));
        }
        w[i] = n_vortices(state, school);
        TRY(measure_event(simulation, evaluations, &e[i]));
        e[i] -= now;
    }
    estimate->seconds = sum_up(simulation, w, e, each);
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    estimate->bytes = 1024.0 * (double)usage.ru_maxrss + bytes_of_file;
    return STATUS_OK;
}
