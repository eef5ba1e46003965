/* steady_reason.c: see steady_reason.h. */
#include "steady/steady_reason.h"

#include <math.h>
#include <stdio.h>

#include "school/diagnostics_energy.h"

/* Largest number of beats of free motion. */
enum { BEATS = 15 };

/* A drift above this multiple of the tolerance is distinct from the variation of the wake between beats. */
static const double clear = 3;

/* Displacement, in lengths, that must change the beat by more than the tolerance. */
static const double longest_place = 0.25;

// the first part of the message
static void format_beats(const struct steady_problem *problem, size_t size, char *words) {
    const int n_beats = problem->map.n_beats, is_late = n_beats >= problem->settings->beats;
    snprintf(words, size, "no steady state in %d beats%s", n_beats, is_late ? " (steady.beats)" : " near the start");
}

static enum status report_collision(const struct steady_problem *problem, const char *first, int n_beats) {
    const struct simulation *const simulation = problem->map.simulation;
    const struct closest *const closest = simulation->state->closest;
    const struct fish *const fish = simulation->school->fish;
    return status_fail(STATUS_SOLVER,
                       "%s: collision: after release, %s and %s approach to %.2g m in beat %d, within "
                       "contact.range",
                       first, fish[closest->fish[0]].name, fish[closest->fish[1]].name, closest->distance, n_beats);
}

// displacement in the frame of the first fish, ahead and to the left, lengths per beat
static void fish_drift(const struct steady_map *map, int f, double drift[2]) {
    const double length = map->simulation->school->fish[f].length;
    for (int i = 0; i < 2; i++) drift[i] = (map->last[f].place[i] - map->before[f].place[i]) / length;
}

static const char *drift_direction(const double drift[2]) {
    if (fabs(drift[0]) >= fabs(drift[1])) return drift[0] > 0 ? "ahead" : "back";
    return drift[1] > 0 ? "to the left" : "to the right";
}

static enum status report_drift(const struct steady_problem *problem, const char *first) {
    const struct steady_map *const map = &problem->map;
    const struct school *const school = map->simulation->school;
    int fastest = 0;
    double most = 0, drift[2];

    for (int f = 1; f < school->n_fish; f++) {
        fish_drift(map, f, drift);
        if (hypot(drift[0], drift[1]) <= most) continue;
        most = hypot(drift[0], drift[1]);
        fastest = f;
    }

    const double change = steady_map_residual(map), tolerance = problem->settings->tolerance;
    if (most <= clear * tolerance) {
        return status_fail(STATUS_SOLVER,
                           "%s: after release, the fish stay together with a residual change per beat of %.2g, %s "
                           "steady.tolerance, %.2g",
                           first, change, change > tolerance ? "more than" : "visible only with a smaller", tolerance);
    }

    fish_drift(map, fastest, drift);
    return status_fail(STATUS_SOLVER,
                       "%s: drift: after release, %s drifts %s relative to %s by %.2g lengths per beat, %.2g m/s",
                       first, school->fish[fastest].name, drift_direction(drift), school->fish[0].name, most,
                       most * school->fish[fastest].length / map->period);
}

static enum status release_fish(struct steady_problem *problem, const char *first) {
    struct simulation *const simulation = problem->map.simulation;
    diagnostics_restart(simulation->residual, simulation->state);
    for (int i = 0; i < BEATS; i++) {
        TRY(steady_map_beat(&problem->map, NULL, NULL));
        const double distance = simulation->state->closest->distance;
        if (distance < simulation->school->contact_range) return report_collision(problem, first, i + 1);
    }
    return report_drift(problem, first);
}

enum status steady_reason_find(struct steady_problem *problem) {
    const int n_beats = problem->map.n_beats;
    char first[64];
    format_beats(problem, sizeof first, first);
    const enum status status = release_fish(problem, first);
    problem->map.n_beats = n_beats;
    return status;
}

enum status steady_reason_check(const struct steady_problem *problem, double in_a_length) {
    const double tolerance = problem->settings->tolerance;
    if (!problem->map.is_formation || in_a_length * longest_place > tolerance) return STATUS_OK;
    return status_fail(
        STATUS_SOLVER,
        "no equilibrium: the fish hardly interact: a displacement of %g lengths changes a beat by at most "
        "steady.tolerance, %.2g, too",
        longest_place, tolerance);
}
