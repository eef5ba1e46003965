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

/* Increment of a slow quantity, in the scale of the quantity, over the distance per beat in lengths, and limits of the
 * increment: smaller increments drown in the noise of the wakes, of larger ones the error is the curvature of the map.
 * After a failure, such as an overlap of two fish, the increment is smaller by the factor shorter. */
static const double disturbance = 0.04, smallest = 0.02, largest = 0.06, shorter = 0.25, least_disturbance = 1e-3;

/* MEMORY: beats of the response of one fish, which is lost in the noise after two, unless a control law remembers more.
 * MOST_MEMORY: with the beats in which the wake of the first fish reaches the last one. SAMPLES: of the errors of the
 * responses. */
enum { MEMORY = 3, MOST_MEMORY = 12, SAMPLES = 16 };

/* With a control law the memory becomes longer by MEMORY if its last beat changes the largest multiplier by more than
 * this, and by more than the noise does. */
static const double forgotten = 0.01;

/* Central differences have two sizes, the first of which is twice the second. */
enum { SIZES = 2 };

struct disturbances {
    struct steady_problem *problem;
    int n_memory;
    double size;                       /* of an increment, in the scale of the quantity */
    struct state *kept;                /* undisturbed state */
    double *start, *to;                /* unknowns of the kept state, and at the start of a beat      (n_unknowns) */
    double *base;                      /* unknowns after each undisturbed beat            (n_unknowns, n_memory) */
    double *sizes;                     /* the larger size of each unknown                             (n_unknowns) */
    double *central, *second;          /* differences and half sums less the base, of each size
                                          (n_unknowns, n_memory, n_unknowns, SIZES) */
    double *above, *below;             /*                                                 (n_unknowns, n_memory) */
    double *response, *error, *sample; /* and its error                     (n_unknowns, n_unknowns, n_memory) */
};

// increase unknown j (-1: none) for one beat; every later beat starts with the unknowns of the kept state again, so
// that its change is the memory of the wake
static enum status follow_disturbance(struct disturbances *all, int j, double size, double *seen) {
    struct steady_problem *const problem = all->problem;
    const int n = problem->n_unknowns;
    TRY(steady_map_return(problem->map.simulation, all->kept));
    for (int m = 0; m < all->n_memory; m++) {
        memcpy(all->to, all->start, (size_t)n * sizeof *all->to);
        if (m == 0 && j >= 0) all->to[j] += size;
        TRY(steady_problem_put(problem, all->to));
        TRY(steady_map_beat(&problem->map, NULL, NULL));
        steady_problem_read(problem, seen + m * n);
    }
    return STATUS_OK;
}

// differences of both sizes of unknown j
static enum status take_differences(struct disturbances *all, int j, double size) {
    const int n = all->problem->n_unknowns, n_seen = n * all->n_memory;
    all->sizes[j] = size;
    for (int s = 0; s < SIZES; s++, size /= 2) {
        double *const central = all->central + n_seen * (j + n * s), *const second = all->second + n_seen * (j + n * s);
        TRY(follow_disturbance(all, j, size, all->above));
        TRY(follow_disturbance(all, j, -size, all->below));
        for (int i = 0; i < n_seen; i++) {
            central[i] = (all->above[i] - all->below[i]) / (2 * size);
            second[i] = (all->above[i] + all->below[i]) / 2 - all->base[i];
        }
    }
    return STATUS_OK;
}

/* With the standard deviation e of an unknown after a beat, which is noise of the wake, central(h) differs from
 * central(h/2) by the truncation 3/4 c h^2 and by noise of the variance 5/2 (e/h)^2, and second(h) - 4 second(h/2), in
 * which the curvature cancels, has the variance 35/2 e^2. The part of the difference that is truncation is extrapolated
 * to h = 0; the error has the noise and what is left of the truncation. A leader that does not feel its follower has no
 * noise when the follower is disturbed, so that each response has its own e. */
static enum status find_responses(struct disturbances *all) {
    const int n = all->problem->n_unknowns, n_seen = n * all->n_memory, n_values = n * n_seen;
    TRY(follow_disturbance(all, -1, 0, all->base));
    for (int j = 0; j < n; j++) {
        for (double size = all->size;; size *= shorter) {
            const enum status status = take_differences(all, j, size);
            if (status == STATUS_OK) break;
            if (status == STATUS_STOPPED || size * shorter < least_disturbance) return status;
        }
    }

    double difference = 0, noise_of_difference = 0;
    for (int k = 0; k < n_values; k++) {
        const double apart = all->central[k + n_values] - all->central[k];
        const double noise = (all->second[k] - 4 * all->second[k + n_values]) / all->sizes[k / n_seen];
        difference += apart * apart;
        noise_of_difference += 2.5 * noise * noise / 17.5;
    }
    const double part = difference > noise_of_difference ? 1 - noise_of_difference / difference : 0, way = 4 * part / 3;

    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n_seen; i++) {
            const int k = i + n_seen * j, to = i % n + n * (j + n * (i / n));
            const double apart = all->central[k + n_values] - all->central[k];
            const double noise = (all->second[k] - 4 * all->second[k + n_values]) / all->sizes[j];
            const double variance = noise * noise / 17.5 * ((1 - way) * (1 - way) / 2 + 2 * way * way);
            all->response[to] = all->central[k] + way * apart;
            all->error[to] = hypot(sqrt(variance), (4.0 / 3 - way) * sqrt(part) * apart);
        }
    }
    return STATUS_OK;
}

/* Twice the root mean square deviation of the moduli under errors of random sign, and at least the effect of the last
 * beat of the memory. A multiplier below its error has decayed: 0. is_short: whether the memory, and not the noise,
 * limits the largest multiplier. */
static enum status find_errors(struct arena *arena, const struct disturbances *all, struct steady_multipliers *found,
                               bool *is_short) {
    const int n = all->problem->n_unknowns, n_values = n * n * all->n_memory;
    double *real, *imaginary;
    uint64_t random = 1;
    NEW(arena, real, n);
    NEW(arena, imaginary, n);
    memset(found->error, 0, (size_t)n * sizeof *found->error);
    for (int s = 0; s <= SAMPLES; s++) {
        for (int i = 0; i < n_values; i++) {
            random = random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
            all->sample[i] = all->response[i] + (random >> 63 ? all->error[i] : -all->error[i]);
        }
        const bool is_shorter = s == SAMPLES;
        TRY(newton_multipliers(arena, n, all->n_memory - is_shorter, is_shorter ? all->response : all->sample, real,
                               imaginary, NULL));
        for (int i = 0; i < n; i++) {
            const double away = fabs(hypot(real[i], imaginary[i]) - hypot(found->real[i], found->imaginary[i]));
            if (is_shorter && i == 0) *is_short = away > larger(forgotten, sqrt(found->error[i]));
            found->error[i] =
                is_shorter ? larger(sqrt(found->error[i]), away) : found->error[i] + 4 * away * away / SAMPLES;
        }
    }

    for (int i = 0; i < n; i++) {
        const bool is_pair = found->imaginary[i] > 0 && i + 1 < n;
        const double error = is_pair ? larger(found->error[i], found->error[i + 1]) : found->error[i];
        const bool is_lost = hypot(found->real[i], found->imaginary[i]) <= error;
        for (int k = i; k <= i + is_pair; k++) {
            if (is_lost) found->real[k] = found->imaginary[k] = 0;
            found->error[k] = is_lost ? 0 : error;
        }
        i += is_pair;
    }
    return STATUS_OK;
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
    struct disturbances all = {.problem = problem};

    // the wake of the first fish reaches the last one after so many beats
    double least = 0, most = 0;
    bool has_law = false;
    for (int f = 0; f < simulation->school->n_fish; f++) {
        has_law |= simulation->school->fish[f].control.law != CONTROL_NONE;
        double ahead;
        steady_map_read(&problem->map, 1, &(struct steady_unknown){f, STEADY_AHEAD}, &ahead);
        least = smaller(least, ahead);
        most = larger(most, ahead);
    }
    const double way = fabs(problem->map.last[0].speed) * problem->map.period;
    const double beats = (most - least) / way;
    all.size = fmin(largest, fmax(smallest, disturbance * way / simulation->school->fish[0].length));
    all.n_memory = MEMORY + (beats <= MOST_MEMORY - MEMORY ? (int)ceil(beats) : MOST_MEMORY - MEMORY);
    const int n_seen = n * MOST_MEMORY, n_values = n * n_seen;

    NEW(scratch, all.start, n);
    NEW(scratch, all.to, n);
    NEW(scratch, all.base, n_seen);
    NEW(scratch, all.sizes, n);
    NEW(scratch, all.central, SIZES * n_values);
    NEW(scratch, all.second, SIZES * n_values);
    NEW(scratch, all.above, n_seen);
    NEW(scratch, all.below, n_seen);
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
    enum status status = STATUS_OK;
    for (bool is_short = true; status == STATUS_OK && is_short;) {
        status = find_responses(&all);
        if (status == STATUS_OK) {
            status =
                newton_multipliers(scratch, n, all.n_memory, all.response, found->real, found->imaginary, found->mode);
        }
        if (status == STATUS_OK) status = find_errors(scratch, &all, found, &is_short);
        if (!has_law || all.n_memory + MEMORY > MOST_MEMORY) break;
        if (is_short) all.n_memory += MEMORY;
    }
    if (status == STATUS_OK) {
        // the change of the last undisturbed beat
        const double *const last = all.base + n * (all.n_memory - 1);
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
