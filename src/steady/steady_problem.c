/* steady_problem.c: see steady_problem.h. */
#include "steady/steady_problem.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// ---- which quantities are slow

static void add_unknown(struct steady_problem *problem, int f, enum steady_quantity quantity) {
    problem->unknown[problem->n_unknowns++] = (struct steady_unknown){f, quantity};
}

static void add_pin(struct steady_problem *problem, int f, enum steady_quantity quantity) {
    add_unknown(problem, f, quantity);
    problem->pin[problem->n_pins++] = (struct steady_unknown){f, quantity};
}

static void list_fish_unknowns(struct steady_problem *problem, int f, const struct fish *fish) {
    const enum steady_freedom freedom = steady_map_freedom(fish);
    const int follows = f > 0 && problem->map.is_formation;
    if (freedom == STEADY_HELD) return;
    if (!follows) problem->solves_speed = 1;
    add_pin(problem, f, STEADY_SPEED);
    if (follows) add_pin(problem, f, STEADY_AHEAD);
    if (freedom == STEADY_SURGES) return;
    add_unknown(problem, f, STEADY_SLIP);
    add_unknown(problem, f, STEADY_TURN);
    if (follows) {
        add_pin(problem, f, STEADY_ASIDE);
        add_pin(problem, f, STEADY_HEADING);
    } else if (problem->map.steered >= 0) {
        add_unknown(problem, f, STEADY_HEADING);
    }
}

static enum status list_unknowns(struct steady_problem *problem) {
    const struct school *const school = problem->map.simulation->school;
    const size_t most = STEADY_QUANTITIES * (size_t)school->n_fish;
    problem->unknown = calloc(most, sizeof *problem->unknown);
    problem->pin = calloc(most, sizeof *problem->pin);
    problem->pinned = calloc(most, sizeof *problem->pinned);
    problem->scratch = calloc(4 * most, sizeof *problem->scratch);
    if (!problem->unknown || !problem->pin || !problem->pinned || !problem->scratch) {
        return status_fail(STATUS_MEMORY, "out of memory: the slow quantities of %d fish", school->n_fish);
    }

    for (int f = 0; f < school->n_fish; f++) list_fish_unknowns(problem, f, &school->fish[f]);
    steady_map_read(&problem->map, problem->n_pins, problem->pin, problem->pinned);
    return STATUS_OK;
}

// ---- cases without a steady state

static enum status refuse_fish(const struct school *school, const struct fish *fish) {
    const enum steady_freedom freedom = steady_map_freedom(fish);
    if (freedom != STEADY_HELD && fabs(school->shear) > 0) {
        return status_fail(STATUS_CASE,
                           "%s swims in a shear, where the stream depends on the place of the fish: hold the fish with "
                           "motion.prescribed, or set fluid.shear to 0",
                           fish->name);
    }

    if (freedom == STEADY_SWIMS && school->walls.n > 0) {
        return status_fail(STATUS_CASE,
                           "%s swims freely beside a wall without control of the wall distance: hold the fish with "
                           "motion.prescribed (surge: free keeps the speed free), or remove fluid.walls",
                           fish->name);
    }

    if (fish->control.n_waypoints > 0 || fish->control.n_headings > 1) {
        return status_fail(STATUS_CASE, "%s changes heading during the case: give one desired_heading and no waypoints",
                           fish->name);
    }

    return STATUS_OK;
}

static enum status refuse_case(const struct steady_problem *problem) {
    const struct school *const school = problem->map.simulation->school;
    int n_free = 0;
    for (int f = 0; f < school->n_fish; f++) {
        TRY(refuse_fish(school, &school->fish[f]));
        n_free += steady_map_freedom(&school->fish[f]) != STEADY_HELD;
    }

    if (n_free == 0 || school->n_fish == 1 || problem->map.is_formation) return STATUS_OK;
    return status_fail(STATUS_CASE,
                       "%d of %d fish swim at independent speeds, so the places change: search for a formation with "
                       "steady.formation: true, or hold all fish with motion.prescribed",
                       n_free, school->n_fish);
}

enum status steady_problem_create(struct steady_problem *problem, const struct case_steady *settings,
                                  struct simulation *simulation) {
    *problem = (struct steady_problem){.settings = settings};
    TRY(steady_map_create(&problem->map, simulation));
    problem->map.is_formation = settings->formation == YES;
    TRY(refuse_case(problem));
    return list_unknowns(problem);
}

void steady_problem_free(struct steady_problem *problem) {
    steady_map_free(&problem->map);
    free(problem->unknown);
    free(problem->pin);
    free(problem->pinned);
    free(problem->scratch);
    free(problem->jacobian);
    *problem = (struct steady_problem){.n_unknowns = 0};
}

// ---- beats

// the largest speed difference between recent beats at this distance in beats, m s-1
static double largest_difference(const struct steady_problem *problem, int apart) {
    double most = 0;
    for (int i = 0; i + apart < STEADY_RECENT; i++) {
        const int n = problem->map.n_beats - i;
        most = fmax(most, fabs(problem->recent[n % STEADY_RECENT] - problem->recent[(n - apart) % STEADY_RECENT]));
    }
    return most;
}

// describe the last beats: period of a repetition, or largest difference
static void format_rhythm(const struct steady_problem *problem, size_t size, char *words) {
    const struct steady_map *const map = &problem->map;
    const double speed = map->last[0].speed;
    const double equal = problem->settings->tolerance * map->simulation->school->fish[0].length / map->period;
    double most = 0;

    words[0] = 0;
    if (map->n_beats < STEADY_RECENT) return;
    for (int apart = 1; apart < STEADY_RECENT; apart++) most = fmax(most, largest_difference(problem, apart));
    for (int apart = 2; apart <= STEADY_RECENT / 4 && largest_difference(problem, 1) > equal; apart++) {
        if (largest_difference(problem, apart) > equal) continue;
        snprintf(words, size, ", and the speed repeats every %d beats", apart);
        return;
    }

    snprintf(words, size, ", and the speed differs by %.2g %% between the last %d beats", 100 * most / fabs(speed),
             STEADY_RECENT);
}

static enum status no_steady_state(const struct steady_problem *problem) {
    char rhythm[128];
    format_rhythm(problem, sizeof rhythm, rhythm);
    const struct steady_map *const map = &problem->map;
    const struct fish *const first = map->simulation->school->fish;
    return status_fail(STATUS_SOLVER,
                       "no steady state in %d beats (steady.beats): residual change per beat %.2g, more than "
                       "steady.tolerance, %.2g; speed of %s %.4g m/s, %.2g lengths per beat%s; if the residual no "
                       "longer falls from beat to beat, reduce solver.rtol",
                       map->n_beats, steady_map_residual(map), problem->settings->tolerance, first->name,
                       map->last[0].speed, map->last[0].speed * map->period / first->length, rhythm);
}

enum status steady_problem_beat(struct steady_problem *problem) {
    if (problem->map.n_beats >= problem->settings->beats) return no_steady_state(problem);
    TRY(steady_map_beat(&problem->map, NULL, NULL));
    problem->recent[problem->map.n_beats % STEADY_RECENT] = problem->map.last[0].speed;
    if (problem->progress) problem->progress(problem, problem->data);
    return STATUS_OK;
}

// set n quantities, SI units; leave the state untouched if all quantities have these values already
static enum status put_quantities(struct steady_problem *problem, int n, const struct steady_unknown *unknown,
                                  const double *to) {
    double *const add = problem->scratch;
    steady_map_read(&problem->map, n, unknown, add);
    int is_elsewhere = 0;
    for (int i = 0; i < n; i++) {
        add[i] = to[i] - add[i];
        is_elsewhere |= fabs(add[i]) > 1e-12 * steady_map_scale(&problem->map, unknown[i]);
    }
    return is_elsewhere ? steady_map_add(&problem->map, n, unknown, add) : STATUS_OK;
}

void steady_problem_read(const struct steady_problem *problem, double *value) {
    steady_map_read(&problem->map, problem->n_unknowns, problem->unknown, value);
    for (int i = 0; i < problem->n_unknowns; i++) value[i] /= steady_map_scale(&problem->map, problem->unknown[i]);
}

enum status steady_problem_put(struct steady_problem *problem, const double *to) {
    const int n = problem->n_unknowns;
    double *const target = problem->scratch + n;
    for (int i = 0; i < n; i++) target[i] = to[i] * steady_map_scale(&problem->map, problem->unknown[i]);
    return put_quantities(problem, n, problem->unknown, target);
}

enum status steady_problem_put_pins(struct steady_problem *problem, double speed) {
    for (int i = 0; i < problem->n_pins; i++) {
        if (problem->pin[i].quantity == STEADY_SPEED) problem->pinned[i] = speed;
    }
    return put_quantities(problem, problem->n_pins, problem->pin, problem->pinned);
}
