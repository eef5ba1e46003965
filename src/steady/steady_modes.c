/* steady_modes.c: how stable the state is: the modes of an equilibrium, and the multipliers of a beat. */
#include "steady/steady_modes.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/mathematics.h"
#include "fish/fish_motion.h"
#include "flow/flow.h"
#include "flow/flow_external.h"
#include "run/simulate.h"
#include "solver/modes.h"
#include "solver/newton.h"
#include "state/state.h"

/* Wake length, in body lengths: the growth rates agree with an infinite wake to 1e-4 of speed over length. */
static const double wake_lengths = 12;
enum { MOST_EVENTS = 4000 };

static void set_growth(struct steady_values *found) {
    found->growth = found->n_exponents > 0 ? found->rate[0] : NAN;
    found->growth_frequency = found->n_exponents > 0 ? found->omega[0] / (2 * M_PI) : NAN;
}

// ---- an equilibrium

/* Set the bodies to the positions at time t: the whole body moves at the velocity of the first node. */
static void hold_bodies(const struct simulation *simulation, const struct state *equilibrium, double t) {
    const struct school *const school = simulation->school;
    struct state *const state = simulation->state;
    memcpy(state->y, equilibrium->y, (size_t)school->n_unknowns * sizeof *state->y);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        double position[2], velocity[2], acceleration[2];
        fish_prescribed_node(fish, NULL, 0, equilibrium->t, position, velocity, acceleration);
        for (int i = 0; i < 2 * fish->n_nodes; i++) {
            state->y[fish->at.x + i] += (t - equilibrium->t) * velocity[i / fish->n_nodes];
        }
    }
}

enum status steady_modes_find(struct simulation *simulation, struct steady_values *found) {
    const struct school *const school = simulation->school;
    struct state *const state = simulation->state;
    const struct fish *const fish = &school->fish[0];

    // the number of events until the wakes are long enough; 0 without a stream
    double stream[2], position[2], velocity[2], acceleration[2];
    fish_prescribed_node(fish, NULL, 0, 0, position, velocity, acceleration);
    flow_external(school, 0, position[0], position[1], &stream[0], &stream[1]);
    const double speed = hypot(stream[0] - velocity[0], stream[1] - velocity[1]);
    const double duration = fmin(school->lifetime, wake_lengths * fish->length / speed);
    const int n_events = speed > 0 ? (int)fmin(MOST_EVENTS, duration / school->interval) : 0;
    found->n_exponents = 0;
    set_growth(found);
    if (n_events == 0 || school->finite || school->shedding == SHEDDING_IMPULSIVE || !(school->density > 0)) {
        return STATUS_OK;
    }

    // the held bodies grow a wake
    struct arena *const arena = arena_create(simulation->arena, "the modes of the bodies");
    struct state *kept = NULL;
    int n_most = STEADY_QUANTITIES * school->n_fish;
    steady_map_save(arena, simulation, &kept);
    TRY(simulate_first_event(simulation));
    hold_bodies(simulation, kept, state->t);
    for (int i = 0; i < n_events; i++) {
        if (simulation->stop && *simulation->stop) {
            return status_fail(STATUS_STOPPED, "stopped %s before the modes were found",
                               simulate_stopped_by(simulation->stop));
        }
        hold_bodies(simulation, kept, fish_event_time(school, state->event + 1));
        TRY(simulate_event(simulation));
    }

    // the modes of the bodies with this wake
    struct mode *mode;
    NEW(arena, mode, n_most);
    TRY(modes_find(arena, simulation->residual, state, n_most, mode, &found->n_exponents));
    for (int i = 0; i < found->n_exponents; i++) {
        found->rate[i] = mode[i].rate;
        found->omega[i] = mode[i].omega;
    }
    TRY(steady_map_return(simulation, kept));
    arena_free(arena);
    set_growth(found);
    simulate_measure(simulation);
    return STATUS_OK;
}

// ---- a beat

void steady_modes_of_multipliers(struct steady_values *found, double period) {
    found->n_exponents = 0;
    for (int i = 0; i < found->n_multipliers; i++) {
        const double size = hypot(found->real[i], found->imaginary[i]);
        // take the first multiplier of a complex pair; a zero multiplier has no rate
        if (found->imaginary[i] < 0 || !(size > 0)) continue;
        found->rate[found->n_exponents] = log(size) / period;
        found->omega[found->n_exponents++] = atan2(found->imaginary[i], found->real[i]) / period;
    }
    set_growth(found);
}

// ---- multipliers

/* Change of a slow quantity, in the scale of the quantity, over the distance per beat in lengths, and limits of the
 * change. After a failure, such as an overlap of two fish, the change is smaller by the factor shorter. */
static const double disturbance = 0.04, smallest = 0.02, largest = 0.06, shorter = 0.25, least_disturbance = 2e-4;

/* MEMORY: beats of the response of one fish, and by so many the memory grows, once if it is longer than SHORT_MEMORY.
 * MOST_MEMORY: of all. SAMPLES: of the noise of the responses. */
enum { MEMORY = 3, SHORT_MEMORY = 12, MOST_MEMORY = 24, SAMPLES = 16 };

/* The changes become smaller, or the memory longer, if that changes the modulus of the largest multiplier by more than
 * telling and by more than the noise does. A memory that is too long consists of noise, which has multipliers of its
 * own: that of several fish grows only if the noise is below quiet, and that of a control law, which remembers for
 * long, only for changes of more than telling_of_law. */
static const double telling = 0.002, quiet = 0.001, telling_of_law = 0.01;

/* Central differences have two sizes, the first of which is twice the second. */
enum { SIZES = 2 };

/* The beats that follow a change of one unknown; all later beats begin with the unknowns of the kept state, so that
 * what changes in them is the memory of the wake. */
struct series {
    int unknown;       /* -1: none changes */
    double change;     /* in the scale of the quantity */
    int n_beats;       /* so far */
    double *seen;      /* unknowns after each beat                       (n_unknowns, MOST_MEMORY) */
    struct state *end; /* after the last beat */
};

struct disturbances {
    struct arena *arena;
    struct steady_problem *problem;
    int n_memory;
    struct state *kept; /* undisturbed state */
    double *start, *to; /* unknowns of the kept state, and at the start of a beat                      (n_unknowns) */
    double *sizes;      /* larger change of each unknown                                               (n_unknowns) */
    struct series base; /* without a change */
    struct series *series;  /* increase and decrease by both sizes                           (n_unknowns, SIZES, 2) */
    double *central[SIZES]; /* differences by both sizes              (n_unknowns, n_unknowns, n_memory), as the rest */
    double *response;       /* their extrapolation */
    double *error, *sample; /* its noise, and response with a sample of it */
};

static struct series *series_of(const struct disturbances *all, int j, int s) {
    return all->series + 2 * (s + SIZES * j);
}

// begin the series s of unknown j anew
static void begin_series(const struct disturbances *all, int j, int s) {
    const double change = all->sizes[j] / (1 << s);
    for (int i = 0; i < 2; i++) {
        struct series *const series = series_of(all, j, s) + i;
        series->unknown = j;
        series->change = i == 0 ? change : -change;
        series->n_beats = 0;
    }
}

static void set_size(const struct disturbances *all, int j, double size) {
    all->sizes[j] = size;
    for (int s = 0; s < SIZES; s++) begin_series(all, j, s);
}

// half of the sizes: the smaller changes become the larger ones
static void halve_sizes(const struct disturbances *all) {
    for (int j = 0; j < all->problem->n_unknowns; j++) {
        struct series *const larger_one = series_of(all, j, 0), *const smaller_one = series_of(all, j, 1);
        for (int i = 0; i < 2; i++) {
            const struct series old = larger_one[i];
            larger_one[i] = smaller_one[i];
            smaller_one[i] = old;
        }
        all->sizes[j] /= 2;
        begin_series(all, j, 1);
    }
}

static enum status follow_series(const struct disturbances *all, struct series *series) {
    struct steady_problem *const problem = all->problem;
    const int n = problem->n_unknowns;
    if (series->n_beats >= all->n_memory) return STATUS_OK;
    TRY(steady_map_return(problem->map.simulation, series->n_beats > 0 ? series->end : all->kept));
    for (; series->n_beats < all->n_memory; series->n_beats++) {
        memcpy(all->to, all->start, (size_t)n * sizeof *all->to);
        if (series->n_beats == 0 && series->unknown >= 0) all->to[series->unknown] += series->change;
        TRY(steady_problem_put(problem, all->to));
        TRY(steady_map_beat(&problem->map, NULL, NULL));
        steady_problem_read(problem, series->seen + n * series->n_beats);
    }
    steady_map_save(all->arena, problem->map.simulation, &series->end);
    return STATUS_OK;
}

// follow all series up to the end of the memory
static enum status follow_all(struct disturbances *all) {
    TRY(follow_series(all, &all->base));
    for (int j = 0; j < all->problem->n_unknowns; j++) {
        for (;;) {
            enum status status = STATUS_OK;
            for (int k = 0; k < 2 * SIZES && status == STATUS_OK; k++) {
                status = follow_series(all, series_of(all, j, 0) + k);
            }
            if (status == STATUS_OK) break;
            if (status == STATUS_STOPPED || all->sizes[j] * shorter < least_disturbance) return status;
            set_size(all, j, all->sizes[j] * shorter);
        }
    }
    return STATUS_OK;
}

/* With the standard deviation e of an unknown after a beat, which is noise of the wake and of the solver,
 * central(h) differs from central(h/2) by the truncation 3/4 c h^2 and by noise of the variance 5/2 (e/h)^2. The
 * half sum of an increase and a decrease less the undisturbed beat, second(h), tells e: second(h) - 4 second(h/2),
 * in which the curvature cancels, has the variance 35/2 e^2. What an increase and a decrease have in common is in
 * second but not in central, so that the noise of an element is at most what explains the difference of its
 * centrals. A leader that does not feel its follower has no noise when the follower is disturbed, so that each
 * element has its own e. */
static void find_responses(const struct disturbances *all) {
    const int n = all->problem->n_unknowns;
    double difference = 0, noise_of_difference = 0;
    for (int j = 0; j < n; j++) {
        const double size = all->sizes[j];
        for (int i = 0; i < n; i++) {
            double apart_squared = 0, noise_squared = 0;
            for (int m = 0; m < all->n_memory; m++) {
                const int from = i + n * m, to = i + n * (j + n * m);
                double second[SIZES];
                for (int s = 0; s < SIZES; s++) {
                    const struct series *const series = series_of(all, j, s);
                    const double above = series[0].seen[from], below = series[1].seen[from];
                    all->central[s][to] = (above - below) / (2 * series->change);
                    second[s] = (above + below) / 2 - all->base.seen[from];
                }
                all->error[to] = (second[0] - 4 * second[1]) / (size * sqrt(17.5));
                noise_squared += all->error[to] * all->error[to];
                apart_squared += pow(all->central[1][to] - all->central[0][to], 2);
            }
            const bool is_common = 2.5 * noise_squared > apart_squared;
            const double part = is_common ? sqrt(apart_squared / (2.5 * noise_squared)) : 1;
            for (int m = 0; m < all->n_memory; m++) all->error[i + n * (j + n * m)] *= part;
            difference += apart_squared;
            noise_of_difference += is_common ? apart_squared : 2.5 * noise_squared;
        }
    }

    // the part of the difference that is truncation is extrapolated
    const double part = difference > 0 ? 1 - noise_of_difference / difference : 0, way = 4 * part / 3;
    for (int k = 0; k < n * n * all->n_memory; k++) {
        all->response[k] = all->central[0][k] + way * (all->central[1][k] - all->central[0][k]);
        all->error[k] *= sqrt((1 - way) * (1 - way) / 2 + 2 * way * way);
    }
}

// the moduli of the multipliers of other responses, of which the first n_memory beats count
static enum status find_moduli(const struct disturbances *all, int n_memory, const double *response, double *modulus) {
    const int n = all->problem->n_unknowns;
    double *real, *imaginary;
    ARENA(scratch, all->arena, "moduli");
    NEW(scratch, real, n);
    NEW(scratch, imaginary, n);
    TRY(newton_multipliers(scratch, n, n_memory, response, real, imaginary, NULL));
    for (int i = 0; i < n; i++) modulus[i] = hypot(real[i], imaginary[i]);
    return STATUS_OK;
}

/* What changes the modulus of the largest multiplier. */
struct changes {
    double noise;  /* of random sign, twice the root mean square */
    double sizes;  /* from one size of the disturbances to the other */
    double memory; /* without one of the last beats */
};

/* The bar of a modulus consists of these changes, in quadrature. A multiplier below its error has decayed: 0. */
static enum status find_errors(const struct disturbances *all, struct steady_multipliers *found,
                               struct changes *changes) {
    const int n = all->problem->n_unknowns, n_last = all->n_memory > MEMORY + 1 ? 2 : 1;
    double *size, *other, *change, *square = found->error;
    uint64_t random = 1;
    ARENA(scratch, all->arena, "the errors of the multipliers");
    NEW(scratch, size, n);
    NEW(scratch, other, n);
    NEW(scratch, change, n);
    for (int i = 0; i < n; i++) size[i] = hypot(found->real[i], found->imaginary[i]);

    memset(square, 0, (size_t)n * sizeof *square);
    for (int s = 0; s < SAMPLES; s++) {
        for (int k = 0; k < n * n * all->n_memory; k++) {
            random = random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
            all->sample[k] = all->response[k] + (random >> 63 ? all->error[k] : -all->error[k]);
        }
        TRY(find_moduli(all, all->n_memory, all->sample, other));
        for (int i = 0; i < n; i++) square[i] += 4 * (other[i] - size[i]) * (other[i] - size[i]) / SAMPLES;
    }
    changes->noise = sqrt(square[0]);

    TRY(find_moduli(all, all->n_memory, all->central[0], change));
    TRY(find_moduli(all, all->n_memory, all->central[1], other));
    for (int i = 0; i < n; i++) square[i] += (other[i] - change[i]) * (other[i] - change[i]);
    changes->sizes = fabs(other[0] - change[0]);

    memset(change, 0, (size_t)n * sizeof *change);
    for (int m = 1; m <= n_last; m++) {
        TRY(find_moduli(all, all->n_memory - m, all->response, other));
        for (int i = 0; i < n; i++) change[i] = larger(change[i], fabs(other[i] - size[i]));
    }
    for (int i = 0; i < n; i++) found->error[i] = sqrt(square[i] + change[i] * change[i]);
    changes->memory = change[0];

    // both of a pair have the larger error
    for (int i = 0; i < n; i++) {
        const bool is_pair = found->imaginary[i] > 0 && i + 1 < n;
        const double error = is_pair ? larger(found->error[i], found->error[i + 1]) : found->error[i];
        const bool is_lost = size[i] <= error;
        for (int k = i; k <= i + is_pair; k++) {
            if (is_lost) found->real[k] = found->imaginary[k] = 0;
            found->error[k] = is_lost ? 0 : error;
        }
        i += is_pair;
    }
    return STATUS_OK;
}

// the multipliers, from changes that are small enough and a memory that is long enough
static enum status follow_until_known(struct disturbances *all, struct steady_multipliers *found) {
    const struct school *const school = all->problem->map.simulation->school;
    const int n = all->problem->n_unknowns;
    const int grown = all->n_memory + MEMORY, most = grown > SHORT_MEMORY ? grown : SHORT_MEMORY;
    double forgotten = school->n_fish > 1 ? telling : INFINITY, loudest = quiet;
    for (int f = 0; f < school->n_fish; f++) {
        if (school->fish[f].control.law != CONTROL_NONE) {
            forgotten = telling_of_law;
            loudest = INFINITY;
        }
    }
    for (;;) {
        TRY(follow_all(all));
        find_responses(all);
        TRY(newton_multipliers(all->arena, n, all->n_memory, all->response, found->real, found->imaginary,
                               found->mode));
        struct changes changes;
        double least = INFINITY;
        TRY(find_errors(all, found, &changes));
        for (int j = 0; j < n; j++) least = smaller(least, all->sizes[j]);
        const bool is_loud = changes.noise >= loudest, remembers = changes.memory > larger(forgotten, changes.noise);
        if (changes.sizes > larger(telling, changes.noise) && least / 2 >= least_disturbance) {
            halve_sizes(all);
        } else if (remembers && !is_loud && all->n_memory + MEMORY <= most) {
            all->n_memory += MEMORY;
        } else {
            return STATUS_OK;
        }
    }
}

// the largest norm of the unknowns within some beats after a unit increment of one unknown
static double find_amplification(struct arena *arena, const struct disturbances *all) {
    const int n = all->problem->n_unknowns;
    double *x, most = 0;
    NEW(arena, x, n * (STEADY_AMPLIFIED_BEATS + 1));
    for (int j = 0; j < n; j++) {
        memset(x, 0, (size_t)n * (STEADY_AMPLIFIED_BEATS + 1) * sizeof *x);
        x[j] = 1;
        for (int k = 0; k < STEADY_AMPLIFIED_BEATS; k++) {
            double *const next = x + n * (k + 1), square = 0;
            for (int m = 0; m < all->n_memory && m <= k; m++) {
                for (int i = 0; i < n * n; i++) next[i % n] += all->response[i + n * n * m] * x[n * (k - m) + i / n];
            }
            for (int i = 0; i < n; i++) square += next[i] * next[i];
            most = larger(most, sqrt(square));
        }
    }
    return most;
}

enum status steady_multipliers_find(struct arena *arena, struct steady_problem *problem,
                                    struct steady_multipliers *found) {
    struct simulation *const simulation = problem->map.simulation;
    struct arena *const scratch = arena_create(simulation->arena, "the multipliers");
    const int n = problem->n_unknowns, n_before = problem->map.n_beats;
    struct disturbances all = {.arena = scratch, .problem = problem};

    // the wake of the first fish reaches the last one after so many beats
    double least = 0, most = 0;
    for (int f = 0; f < simulation->school->n_fish; f++) {
        double ahead;
        steady_map_read(&problem->map, 1, &(struct steady_unknown){f, STEADY_AHEAD}, &ahead);
        least = smaller(least, ahead);
        most = larger(most, ahead);
    }
    const double way = fabs(problem->map.last[0].speed) * problem->map.period;
    const double beats = (most - least) / way;
    const double size = fmin(largest, fmax(smallest, disturbance * way / simulation->school->fish[0].length));
    all.n_memory = MEMORY + (beats <= MOST_MEMORY - 2 * MEMORY ? (int)ceil(beats) : MOST_MEMORY - 2 * MEMORY);
    const int n_series = 2 * SIZES * n, n_values = n * n * MOST_MEMORY;

    NEW(scratch, all.start, n);
    NEW(scratch, all.to, n);
    NEW(scratch, all.sizes, n);
    NEW(scratch, all.series, n_series);
    for (int k = 0; k < n_series; k++) NEW(scratch, all.series[k].seen, n * MOST_MEMORY);
    all.base.unknown = -1;
    NEW(scratch, all.base.seen, n * MOST_MEMORY);
    for (int j = 0; j < n; j++) set_size(&all, j, size);
    for (int s = 0; s < SIZES; s++) NEW(scratch, all.central[s], n_values);
    NEW(scratch, all.response, n_values);
    NEW(scratch, all.error, n_values);
    NEW(scratch, all.sample, n_values);
    *found = (struct steady_multipliers){.n = n};
    NEW(arena, found->real, n);
    NEW(arena, found->imaginary, n);
    NEW(arena, found->error, n);
    NEW(arena, found->mode, 2 * n * n);
    NEW(arena, found->way, n);

    // the beats of the search are still the last ones afterwards
    const size_t n_fish = (size_t)simulation->school->n_fish;
    struct steady_beat *beats_kept;
    NEW(scratch, beats_kept, 2 * n_fish);
    memcpy(beats_kept, problem->map.last, n_fish * sizeof *beats_kept);
    memcpy(beats_kept + n_fish, problem->map.before, n_fish * sizeof *beats_kept);

    steady_map_save(scratch, simulation, &all.kept);
    steady_problem_read(problem, all.start);
    enum status status = follow_until_known(&all, found);
    if (status == STATUS_OK) {
        // the change of the last undisturbed beat
        const double *const last = all.base.seen + n * (all.n_memory - 1);
        for (int i = 0; i < n; i++) all.to[i] = last[i] - all.start[i];
        newton_way(scratch, n, all.n_memory, all.response, all.to, found->way);
        found->amplification = find_amplification(scratch, &all);
        status = steady_map_return(simulation, all.kept);
    }
    memcpy(problem->map.last, beats_kept, n_fish * sizeof *beats_kept);
    memcpy(problem->map.before, beats_kept + n_fish, n_fish * sizeof *beats_kept);
    arena_free(scratch);
    found->n_beats = problem->map.n_beats - n_before;
    problem->map.n_beats = n_before;
    return status;
}
