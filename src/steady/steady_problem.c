/* steady_problem.c: chooses the unknowns of the search, counts its beats, and says why a search has no result. */
#include "steady/steady_problem.h"

#include <math.h>
#include <stdio.h>

#include "base/mathematics.h"
#include "school/diagnostics_energy.h"

// ---- cases without a steady state

enum status steady_problem_refuse(const struct case_steady *settings, const struct school *school) {
    int n_free = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const enum steady_freedom freedom = steady_map_freedom(fish);
        n_free += freedom != STEADY_HELD;
        if (freedom != STEADY_HELD && fabs(school->shear) > 0) {
            return status_fail(STATUS_CASE,
                               "%s swims in a shear, where the stream depends on the place of the fish: hold the fish "
                               "with motion.prescribed, or set fluid.shear to 0",
                               fish->name);
        }
        if (freedom == STEADY_SWIMS && school->walls.n > 0) {
            return status_fail(STATUS_CASE,
                               "%s swims freely beside a wall without control of the wall distance: hold the fish with "
                               "motion.prescribed (surge: free keeps the speed free), or remove fluid.walls",
                               fish->name);
        }
        if (fish->control.n_waypoints > 0 || fish->control.n_headings > 1) {
            return status_fail(STATUS_CASE,
                               "%s changes heading during the case: give one desired_heading and no waypoints",
                               fish->name);
        }
    }

    if (n_free == 0 || school->n_fish == 1 || settings->formation == YES) return STATUS_OK;
    return status_fail(STATUS_CASE,
                       "%d of %d fish swim at independent speeds, so the places change: search for a formation with "
                       "steady.formation: true, or hold all fish with motion.prescribed",
                       n_free, school->n_fish);
}

enum status steady_problem_create(struct steady_problem *problem, const struct case_steady *settings,
                                  struct simulation *simulation) {
    const struct school *const school = simulation->school;
    struct arena *const arena = simulation->arena;
    const size_t most = STEADY_QUANTITIES * (size_t)school->n_fish;
    *problem = (struct steady_problem){.settings = settings, .multiplier = NAN};
    TRY(steady_map_create(&problem->map, simulation));
    problem->map.is_formation = settings->formation == YES;
    TRY(steady_problem_refuse(settings, school));
    NEW(arena, problem->unknown, most);
    NEW(arena, problem->pin, most);
    NEW(arena, problem->pinned, most);
    NEW(arena, problem->scratch, 4 * most);

    // the slow quantities of each fish
    for (int f = 0; f < school->n_fish; f++) {
        const enum steady_freedom freedom = steady_map_freedom(&school->fish[f]);
        const bool is_free = freedom != STEADY_HELD, swims = freedom == STEADY_SWIMS;
        const bool follows = f > 0 && problem->map.is_formation, is_steered = problem->map.is_steered;
        const struct {
            enum steady_quantity quantity;
            bool is_slow, is_pinned;
        } rows[] = {
            {STEADY_SPEED, is_free, true},
            {STEADY_AHEAD, is_free && follows, true},
            {STEADY_SLIP, swims, false},
            {STEADY_TURN, swims, false},
            {STEADY_ASIDE, swims && follows, true},
            {STEADY_HEADING, swims && (follows || is_steered), follows},
            {STEADY_HOLD_ALONG, school->fish[f].control.law == CONTROL_PLACE, false},
            {STEADY_HOLD_ACROSS, school->fish[f].control.law == CONTROL_PLACE, false},
        };
        if (is_free && !follows) problem->solves_speed = true;
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
            const struct steady_unknown unknown = {f, rows[i].quantity};
            if (rows[i].is_slow) problem->unknown[problem->n_unknowns++] = unknown;
            if (rows[i].is_slow && rows[i].is_pinned) problem->pin[problem->n_pins++] = unknown;
        }
    }
    steady_map_read(&problem->map, problem->n_pins, problem->pin, problem->pinned);
    return STATUS_OK;
}

// ---- beats

// the largest speed difference between recent beats at this distance in beats, m s-1
static double largest_difference(const struct steady_problem *problem, int apart) {
    double most = 0;
    for (int i = 0; i + apart < STEADY_RECENT; i++) {
        const int n = problem->map.n_beats - i;
        most = larger(most, fabs(problem->recent[n % STEADY_RECENT] - problem->recent[(n - apart) % STEADY_RECENT]));
    }
    return most;
}

enum status steady_problem_beat(struct steady_problem *problem) {
    struct steady_map *const map = &problem->map;
    const struct fish *const first = map->simulation->school->fish;
    if (map->n_beats < problem->settings->beats) {
        TRY(steady_map_beat(map, NULL, NULL));
        problem->recent[map->n_beats % STEADY_RECENT] = map->last[0].speed;
        if (problem->progress) problem->progress(problem, problem->data);
        return STATUS_OK;
    }

    // no steady state: describe the last beats, period of a repetition or largest difference
    const double speed = map->last[0].speed, equal = problem->settings->tolerance * first->length / map->period;
    char rhythm[128] = "";
    if (map->n_beats >= STEADY_RECENT) {
        double most = 0;
        int period = 0;
        for (int apart = 1; apart < STEADY_RECENT; apart++) most = fmax(most, largest_difference(problem, apart));
        for (int apart = 2; apart <= STEADY_RECENT / 4 && period == 0; apart++) {
            const bool repeats = largest_difference(problem, 1) > equal && largest_difference(problem, apart) <= equal;
            period = repeats ? apart : 0;
        }
        if (period > 0) {
            snprintf(rhythm, sizeof rhythm, ", and the speed repeats every %d beats", period);
        } else {
            snprintf(rhythm, sizeof rhythm, ", and the speed differs by %.2g %% between the last %d beats",
                     100 * most / fabs(speed), STEADY_RECENT);
        }
    }

    return status_fail(STATUS_SOLVER,
                       "no steady state in %d beats (steady.beats): residual change per beat %.2g, more than "
                       "steady.tolerance, %.2g; speed of %s %.4g m/s, %.2g lengths per beat%s; if the residual no "
                       "longer falls from beat to beat, reduce solver.rtol",
                       map->n_beats, steady_map_residual(map), problem->settings->tolerance, first->name, speed,
                       speed * map->period / first->length, rhythm);
}

// set n quantities, SI units; leave the state untouched if all quantities have these values already
static enum status steady_problem_put_quantities(struct steady_problem *problem, int n,
                                                 const struct steady_unknown *unknown, const double *to) {
    double *const add = problem->scratch;
    steady_map_read(&problem->map, n, unknown, add);
    bool is_elsewhere = false;
    for (int i = 0; i < n; i++) {
        add[i] = to[i] - add[i];
        is_elsewhere |= fabs(add[i]) > 1e-12 * steady_map_scale(&problem->map, unknown[i]);
    }
    return is_elsewhere ? steady_map_add(&problem->map, n, unknown, add) : STATUS_OK;
}

double steady_problem_residual(const struct steady_problem *problem) {
    const struct steady_map *const map = &problem->map;
    if (isnan(problem->multiplier)) return steady_map_residual(map);
    const int n = map->n_beats + STEADY_RECENT;
    const double speed[] = {problem->recent[n % STEADY_RECENT], problem->recent[(n - 1) % STEADY_RECENT],
                            problem->recent[(n - 2) % STEADY_RECENT]};
    const double left = speed[0] - speed[1] - problem->multiplier * (speed[1] - speed[2]);
    const double turn = fabs(map->last[0].turn - map->before[0].turn) / (10 * 2 * M_PI);
    return larger(fabs(left) / steady_map_scale(map, (struct steady_unknown){0, STEADY_SPEED}), turn);
}

void steady_problem_read(const struct steady_problem *problem, double *value) {
    steady_map_read(&problem->map, problem->n_unknowns, problem->unknown, value);
    for (int i = 0; i < problem->n_unknowns; i++) value[i] /= steady_map_scale(&problem->map, problem->unknown[i]);
}

enum status steady_problem_put(struct steady_problem *problem, const double *to) {
    const int n = problem->n_unknowns;
    double *const target = problem->scratch + n;
    for (int i = 0; i < n; i++) target[i] = to[i] * steady_map_scale(&problem->map, problem->unknown[i]);
    return steady_problem_put_quantities(problem, n, problem->unknown, target);
}

enum status steady_problem_put_pins(struct steady_problem *problem, double speed) {
    for (int i = 0; i < problem->n_pins; i++) {
        if (problem->pin[i].quantity == STEADY_SPEED) problem->pinned[i] = speed;
    }
    return steady_problem_put_quantities(problem, problem->n_pins, problem->pin, problem->pinned);
}

// ---- the free motion of a formation

/* Largest number of beats of free motion. */
enum { BEATS = 15 };

/* A drift above this multiple of the tolerance is distinct from the variation of the wake between beats. */
static const double clear = 3;

/* Displacement, in lengths, that must change the beat by more than the tolerance. */
static const double longest_place = 0.25;

enum status steady_reason_find(struct steady_problem *problem) {
    struct steady_map *const map = &problem->map;
    struct simulation *const simulation = map->simulation;
    const struct fish *const fish = simulation->school->fish;
    const int n_beats = map->n_beats;
    char first[64];
    snprintf(first, sizeof first, "no steady state in %d beats%s", n_beats,
             n_beats >= problem->settings->beats ? " (steady.beats)" : " near the start");

    // release the fish, until two of them collide
    enum status status = STATUS_OK;
    int beat = 0;
    diagnostics_restart(simulation->residual, simulation->state);
    for (; beat < BEATS && status == STATUS_OK; beat++) {
        status = steady_map_beat(map, NULL, NULL);
        if (simulation->state->closest->distance < simulation->school->contact_range) break;
    }
    map->n_beats = n_beats;
    TRY(status);
    if (beat < BEATS) {
        const struct closest *const closest = simulation->state->closest;
        return status_fail(
            STATUS_SOLVER,
            "%s: collision: after release, %s and %s approach to %.2g m in beat %d, within contact.range", first,
            fish[closest->fish[0]].name, fish[closest->fish[1]].name, closest->distance, beat + 1);
    }

    // the fastest drift in the frame of the first fish, ahead and to the left, lengths per beat
    int fastest = 0;
    double most = 0, drift[2] = {0, 0};
    for (int f = 1; f < simulation->school->n_fish; f++) {
        const struct steady_beat *const last = &map->last[f], *const before = &map->before[f];
        const double ahead = (last->place[0] - before->place[0]) / fish[f].length;
        const double aside = (last->place[1] - before->place[1]) / fish[f].length;
        if (hypot(ahead, aside) <= most) continue;
        most = hypot(ahead, aside);
        fastest = f;
        drift[0] = ahead;
        drift[1] = aside;
    }

    const double change = steady_map_residual(map), tolerance = problem->settings->tolerance;
    if (most <= clear * tolerance) {
        return status_fail(STATUS_SOLVER,
                           "%s: after release, the fish stay together with a residual change per beat of %.2g, %s "
                           "steady.tolerance, %.2g%s",
                           first, change, change > tolerance ? "more than" : "visible only with a smaller", tolerance,
                           change > tolerance ? "; set steady.tolerance to 1e-3, as the wake behind a fish that cuts "
                                                "another wake is less periodic"
                                              : "");
    }

    const char *const along = drift[0] > 0 ? "ahead" : "back";
    const char *const across = drift[1] > 0 ? "to the left" : "to the right";
    return status_fail(STATUS_SOLVER,
                       "%s: drift: after release, %s drifts %s relative to %s by %.2g lengths per beat, %.2g m/s, from "
                       "the place (%.3g, %.3g) m, ahead and to the left",
                       first, fish[fastest].name, fabs(drift[0]) >= fabs(drift[1]) ? along : across, fish[0].name, most,
                       most * fish[fastest].length / map->period, map->last[fastest].place[0],
                       map->last[fastest].place[1]);
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
