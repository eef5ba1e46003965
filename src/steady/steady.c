/* steady.c: finds a steady state, corrects it by the multipliers, swims the last beats and writes the result. */
#include "steady/steady.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/arena.h"
#include "base/mathematics.h"
#include "fish/fish_school.h"
#include "result/durable.h"
#include "result/target.h"
#include "run/record.h"
#include "school/diagnostics_energy.h"
#include "school/warnings.h"
#include "steady/steady_modes.h"
#include "steady/steady_neighbour.h"
#include "steady/steady_problem.h"
#include "steady/steady_search.h"
#include "steady/steady_start.h"
#include "steady/steady_static.h"

/* Correct the state, at most CORRECTIONS times, while the estimated distance between the speed and the speed of the
 * fixed point, in lengths per beat, exceeds far_away times the tolerance. A small change of the speed per beat does not
 * prove a steady state: a slow oscillation also has a small change per beat at its turning points. The multipliers give
 * the correction. If the correction is longer than farthest, or longer than half of the previous correction, a Newton
 * step replaces the correction. */
static const double far_away = 10, half = 0.5, farthest = 2;
enum { CORRECTIONS = 6 };

/* A symmetric gait without control that turns by more, in degrees per beat, swims in a circle. */
static const double most_turn = 0.5;

struct run {
    const struct case_values *values;
    const struct steady_options *options;
    struct arena *arena;
    struct simulation *simulation;
    struct steady_problem problem;
    struct steady_multipliers multipliers;
    struct steady_values found;
    struct steady_fish *last, *before; /* means over the last two beats        (n_fish) */
    struct record record;
    char warnings[4 * WARNING_BYTES]; /* lines about the state that was found */
};

// keep the means over the last beat
static void keep_means(struct run *run) {
    const struct simulation *const simulation = run->simulation;
    struct steady_fish *const oldest = run->before;
    run->before = run->last;
    run->last = oldest;
    for (int f = 0; f < simulation->school->n_fish; f++) {
        const struct steady_beat *const beat = &run->problem.map.last[f];
        const struct diagnostics_fish *const now = &simulation->diagnostics->fish[f];
        run->last[f] = (struct steady_fish){.speed = beat->speed,
                                            .turn = beat->turn * 180 / M_PI,
                                            .place = {beat->place[0], beat->place[1]},
                                            .force = {beat->force[0], beat->force[1]},
                                            .thrust = now->mean_thrust,
                                            .drag = NAN,
                                            .lift = NAN,
                                            .deflection = NAN,
                                            .actuation_power = beat->actuation,
                                            .damping_power = beat->damping,
                                            .constraint_power = beat->driving,
                                            .fluid_power = beat->fluid,
                                            .power = now->mean_power,
                                            .cost_of_transport = now->cost_of_transport,
                                            .efficiency = now->efficiency,
                                            .towed_efficiency = now->towed_efficiency,
                                            .strouhal = now->strouhal};
    }
}

static void report_progress(const struct steady_problem *problem, void *data) {
    struct run *const run = data;
    keep_means(run);
    if (!run->options->progress) return;
    const struct steady_progress progress = {.n_beats = problem->map.n_beats,
                                             .max_beats = run->values->steady.beats,
                                             .t = run->simulation->state->t,
                                             .residual = steady_map_residual(&problem->map),
                                             .tolerance = run->values->steady.tolerance,
                                             .speed = problem->map.last[0].speed,
                                             .wall_time = simulate_wall_time(run->simulation)};
    run->options->progress(&progress, run->options->data);
}

// ---- the values of the steady state

// distance between the speed and the speed of the fixed point, lengths per beat; 0 for a formation, which is solved for
static double speed_distance(const struct run *run) {
    const struct steady_problem *const problem = &run->problem;
    double most = 0;
    for (int i = 0; i < problem->n_unknowns && !problem->map.is_formation; i++) {
        if (problem->unknown[i].quantity == STEADY_SPEED) most = larger(most, fabs(run->multipliers.way[i]));
    }
    return most;
}

static enum status find_multipliers(struct run *run) {
    struct steady_values *const found = &run->found;
    const struct steady_multipliers *const now = &run->multipliers;
    const int n = run->problem.n_unknowns, n_slots = run->simulation->school->n_fish * STEADY_QUANTITIES;
    found->residual = steady_map_residual(&run->problem.map);
    TRY(steady_multipliers_find(run->arena, &run->problem, &run->multipliers));
    found->n_multipliers = n;
    found->n_multiplier_beats += now->n_beats;
    found->real = now->real;
    found->imaginary = now->imaginary;
    found->multiplier_error = now->error;
    found->amplification = now->amplification;
    for (int i = 0; i < 2 * n * n_slots; i++) found->mode[i] = NAN;
    for (int i = 0; i < 2 * n * n; i++) {
        const struct steady_unknown *const unknown = &run->problem.unknown[i / 2 % n];
        const int slot = unknown->fish * STEADY_QUANTITIES + (int)unknown->quantity;
        found->mode[2 * (i / (2 * n) * n_slots + slot) + i % 2] = now->mode[i];
    }

    // distance between 1 and the nearest multiplier
    double nearest = INFINITY;
    for (int i = 0; i < found->n_multipliers; i++) {
        nearest = smaller(nearest, hypot(1 - found->real[i], found->imaginary[i]));
    }

    found->error = larger(found->residual / nearest, speed_distance(run));

    // at a fold, where a held state may be, a multiplier is 1 although the places are determined
    return run->options->hold ? STATUS_OK : steady_reason_check(&run->problem, nearest);
}

// ---- the rows

static enum status write_if_due(void *data) {
    struct run *const run = data;
    if (!record_is_due(&run->record, run->simulation->state->event)) return STATUS_OK;
    struct integrator_counts counts;
    struct result_row row;
    simulate_row(run->simulation, &counts, &row);
    return record_row(&run->record, &row);
}

// write the last beats, which start from the steady state; energy balance and closest approach cover these rows only
static enum status write_beats(struct run *run) {
    struct simulation *const simulation = run->simulation;
    const int n_beats = run->problem.map.n_beats, n_output = run->values->steady.output_beats;
    diagnostics_restart(simulation->residual, simulation->state);
    run->record.first = simulation->state->event;
    run->record.n_events = run->record.first + n_output * run->problem.map.events;

    TRY(write_if_due(run));
    for (int i = 0; i < n_output; i++) {
        TRY(steady_map_beat(&run->problem.map, write_if_due, run));
        keep_means(run);
    }

    run->problem.map.n_beats = n_beats;
    if (n_output > 0) run->found.residual = larger(run->found.residual, steady_map_residual(&run->problem.map));

    // the means over the last beat; those of two beats say where the slow disturbance that is left leads to
    const double multiplier = run->problem.multiplier;
    const double further = isnan(multiplier) ? 0 : multiplier / (1 - multiplier);
    for (int f = 0; f < simulation->school->n_fish; f++) {
        double *const found = (double *)&run->found.fish[f];
        const double *const last = (const double *)&run->last[f], *const before = (const double *)&run->before[f];
        const int n_means = sizeof run->found.fish[f] / sizeof *found;
        for (int i = 0; i < n_means; i++) found[i] = last[i] + (further > 0 ? further * (last[i] - before[i]) : 0);
    }

    return STATUS_OK;
}

// ---- a run

// add a line to the warnings of the result and tell it
__attribute__((format(printf, 2, 3))) static void warn(struct run *run, const char *format, ...) {
    char line[WARNING_BYTES];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    const size_t length = strlen(run->warnings);
    snprintf(run->warnings + length, sizeof run->warnings - length, "%s%s", length > 0 ? "\n" : "", line);
    if (run->options->warn) run->options->warn(line, run->options->data);
}

/* Warn of a state that a run would leave, of a gait that leads in a circle by itself, and of beats that do not repeat:
 * the integrator restarts at the first row, and the error of the restart can exceed a small tolerance. */
static void warn_of_state(struct run *run) {
    const struct school *const school = run->simulation->school;
    const struct steady_values *const found = &run->found;
    const double tolerance = run->values->steady.tolerance;
    if (found->residual > tolerance) {
        warn(run,
             "the beats of the result change by %.2g per beat, more than steady.tolerance, %g: the state is unstable, "
             "or the integrator restarts with this error: lower solver.rtol",
             found->residual, tolerance);
    }

    const double largest = found->n_multipliers > 0 ? hypot(found->real[0], found->imaginary[0]) : 0;
    const double error = found->n_multipliers > 0 ? found->multiplier_error[0] : 0;
    if (largest > 1 && !run->options->judges_stability) {
        const bool is_certain = largest - error > 1;
        warn(run, "the steady state %s unstable: a disturbance grows by the factor %.4g +- %.2g a beat (limit 1)%s; %s",
             is_certain ? "is" : "may be", largest, error, is_certain ? ", so that a run leaves it" : "",
             school->n_fish > 1 ? "search from another place, or hold the places by control (control.law: place)"
                                : "a deeper body, cross-flow drag (drag.normal) or control.law: course stabilises it");
    }

    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const double turn = found->fish[f].turn;
        if (fish->control.law != CONTROL_NONE || fish->control.bias != 0 || !(fabs(turn) > most_turn)) continue;
        warn(run,
             "%s swims in a circle: it turns by %.3g degrees a beat (limit %g) without control, and its speed is that "
             "on the circle; a deeper body, cross-flow drag (drag.normal) or control.law: course keeps it straight",
             fish->name, turn, most_turn);
    }
}

static enum status hold(struct run *run) {
    const struct steady_point *const point = run->options->hold;
    double *change;
    NEW(run->arena, change, point->n);
    return steady_search_hold(&run->problem, point->value, change);
}

static void tell_point(const struct run *run, bool has_beat) {
    const struct steady_values *const found = &run->found;
    struct steady_point *const point = run->options->found;
    if (!point) return;
    const bool has_multipliers = found->n_multipliers > 0;
    point->n = has_beat ? run->problem.n_unknowns : 0;
    point->has_beat = has_beat;
    NEW(point->arena, point->value, point->n);
    if (has_beat) {
        steady_problem_read(&run->problem, point->value);
        point->real = has_multipliers ? found->real[0] : NAN;
        point->imaginary = has_multipliers ? found->imaginary[0] : NAN;
        point->error = has_multipliers ? found->multiplier_error[0] : NAN;
    } else {
        point->real = found->growth;
        point->imaginary = 2 * M_PI * found->growth_frequency;
        point->error = 0;
    }
}

static enum status steady_find(struct run *run, bool is_static) {
    run->found.error = NAN;

    // an equilibrium of bodies without a beat has one row
    if (is_static) {
        TRY(steady_static_find(run->simulation, run->options->from, &run->found));
        if (run->values->steady.multipliers != NO) TRY(steady_modes_find(run->simulation, &run->found));
        tell_point(run, false);
        return write_if_due(run);
    }

    TRY(run->options->hold ? hold(run) : steady_search_run(&run->problem));
    run->found.residual = steady_problem_residual(&run->problem);
    run->found.stiffness = NAN;

    // correct the state by the multipliers until the speed is near the fixed point
    const bool has_multipliers = run->values->steady.multipliers != NO && run->problem.n_unknowns > 0;
    double last = farthest;
    if (has_multipliers) TRY(find_multipliers(run));
    for (int i = 0; i < CORRECTIONS && has_multipliers && !run->options->hold; i++) {
        const double now = speed_distance(run);
        if (now <= far_away * run->values->steady.tolerance) break;
        TRY(steady_search_correct(&run->problem, now <= half * last ? run->multipliers.way : NULL));
        last = now;
        TRY(find_multipliers(run));
    }
    steady_modes_of_multipliers(&run->found, run->problem.map.period);
    run->found.n_beats = run->problem.map.n_beats;
    tell_point(run, true);
    if (run->options->state) {
        TRY(steady_neighbour_write(run->arena, run->options->state, run->values, run->simulation));
    }
    return write_beats(run);
}

static enum status refuse_school(const struct case_steady *settings, const struct school *school) {
    if (school->gust_profile != GUST_UNIFORM && fabs(school->gust[0]) + fabs(school->gust[1]) > 0) {
        return status_fail(STATUS_CASE,
                           "a gust that travels past the fish has no steady state: run the case in time, or set "
                           "fluid.gust.profile to uniform");
    }
    if (steady_static_applies(school)) return steady_static_refuse(school);
    TRY(steady_map_refuse(school));
    return steady_problem_refuse(settings, school);
}

enum status steady_refuse(const struct case_values *values) {
    ARENA(arena, NULL, "the school of a case");
    struct school *school;
    TRY(fish_school_create(arena, &school, &values->school));
    const enum status status = refuse_school(&values->steady, school);
    fish_school_free(school);
    return status;
}

enum status steady_change(const struct case_values *values, int n, const double *value, double *change,
                          const volatile sig_atomic_t *stop) {
    ARENA(arena, NULL, "the change in a beat");
    struct simulation *simulation;
    struct steady_problem problem;
    TRY(simulate_start(arena, &simulation, values, stop));
    simulation->stop = stop;
    TRY(refuse_school(&values->steady, simulation->school));
    TRY(steady_problem_create(&problem, &values->steady, simulation));
    if (problem.n_unknowns != n) {
        return status_fail(STATUS_CASE,
                           "the steady state has %d slow quantities here, and %d at the start of the branch",
                           problem.n_unknowns, n);
    }
    return steady_search_hold(&problem, value, change);
}

static enum status find_and_write(struct run *run) {
    const struct steady_options *const options = run->options;
    run->arena = arena_create(NULL, "the steady state");
    TRY(target_check(options->path, TARGET_NETCDF, options->overwrite));
    if (options->from) TRY(target_refuse_input(options->path, options->from));

    // start from the initial values of the case, from another steady state, or from the whole state of a neighbour
    struct case_values values = *run->values;
    if (options->from) {
        TRY(steady_start_read(run->arena, options->from, &run->values->school, &values.school.fish));
    }
    const struct steady_neighbours *const neighbours = options->neighbours;
    const enum status started = neighbours
                                    ? steady_neighbour_start(run->arena, &run->simulation, &values, neighbours->state)
                                    : simulate_start(run->arena, &run->simulation, &values, options->stop);
    if (started == STATUS_STOPPED) {
        return status_fail(started, "stopped %s before the search: start the search again",
                           simulate_stopped_by(options->stop));
    }
    TRY(started);
    run->simulation->stop = options->stop;
    run->simulation->trace = options->trace;
    const struct school *const school = run->simulation->school;
    const bool is_static = steady_static_applies(school);
    TRY(refuse_school(&values.steady, school));
    if (!is_static) TRY(steady_problem_create(&run->problem, &run->values->steady, run->simulation));
    run->problem.is_near = neighbours != NULL;
    if (neighbours && !is_static) TRY(steady_neighbour_predict(&run->problem, neighbours));
    run->problem.progress = report_progress;
    run->problem.data = run;
    const int n_fish = run->simulation->school->n_fish, n = STEADY_QUANTITIES * n_fish;
    run->found.growth = run->found.growth_frequency = run->found.amplification = NAN;
    NEW(run->arena, run->found.fish, n_fish);
    NEW(run->arena, run->last, n_fish);
    NEW(run->arena, run->before, n_fish);
    NEW(run->arena, run->found.mode, 2 * n * n);
    NEW(run->arena, run->found.rate, n);
    NEW(run->arena, run->found.omega, n);

    // the largest number of events bounds the number of vortices in the file
    const long n_beats = run->values->steady.beats + run->values->steady.output_beats;
    const long n_events = is_static ? 1 : run->simulation->state->event + n_beats * run->problem.map.events;
    const struct result_origin origin = {.path = options->path,
                                         .overwrite = options->overwrite,
                                         .values = run->values,
                                         .command = options->command,
                                         .school = school,
                                         .n_events = n_events,
                                         .is_steady = true};
    TRY(record_create(run->arena, &run->record, &origin));

    const enum status status = steady_find(run, is_static);
    if (status == STATUS_STOPPED && !is_static) {
        const struct steady_map *const map = &run->problem.map;
        char found[128] = "";
        if (map->n_beats > 0) {
            snprintf(found, sizeof found, ", at a speed of %.4g m/s with a residual change per beat of %.2g",
                     map->last[0].speed, steady_map_residual(map));
        }
        status_fail(status, "stopped %s in beat %d of the search%s; a search cannot be resumed: start the search again",
                    simulate_stopped_by(options->stop), map->n_beats + 1, found);
    }

    if (status == STATUS_OK) {
        result_file_steady(run->record.file, run->simulation->school, &run->found);
        if (!is_static) warn_of_state(run);
        record_notes_write(run->record.file, run->simulation, run->warnings, options->warn, options->data);
    }

    // rename the temporary file to the result file and close the file; a failed search keeps an earlier result
    char reason[4096];
    snprintf(reason, sizeof reason, "%s", status_message());
    if (status == STATUS_OK) return record_close(&run->record, result_file_publish(run->record.file, "complete"));
    if (access(options->path, F_OK) != 0) result_file_publish(run->record.file, "running");
    status_fail(status, "%s", reason);
    return record_close(&run->record, status);
}

enum status steady_run(const struct case_values *values, const struct steady_options *options) {
    struct run run = {.values = values, .options = options};
    struct durable_claim claim;
    TRY(target_check(options->path, TARGET_NETCDF, true));
    TRY(durable_claim_take(&claim, options->path));
    const enum status status = find_and_write(&run);
    arena_free(run.arena);
    durable_claim_release(&claim);
    return status;
}
