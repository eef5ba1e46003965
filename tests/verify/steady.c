/* steady.c: The section "steady" (doc/steady.md) compares results of `shoal steady` after some twenty beats with runs
 * of two hundred beats. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "steady/steady_modes.h"
#include "steady/steady_search.h"
#include "verify.h"

// ---- one fish, against a run of two hundred beats

enum { BRUTE_BEATS = 200, MOST_BEATS = BRUTE_BEATS / 10 };

struct swimmer {
    const char *name, *text;
    bool is_fish;
    int decays_from, decays_to; /* beats of the run between which the error falls by the largest multiplier */
};

struct found {
    double speed, cost, strouhal, multiplier, to_bound[MOST_BEATS + 1];
    int n_beats;
};

static void note_speed(const struct steady_problem *problem, void *data) {
    struct found *const found = data;
    if (problem->map.n_beats <= MOST_BEATS) found->to_bound[problem->map.n_beats] = problem->map.last[0].speed;
}

static struct found search_for(const char *text) {
    struct found found = {.n_beats = 0};
    struct verify_search search;
    struct steady_multipliers multipliers;
    verify_search_open(&search, text);
    struct steady_problem *const problem = &search.problem;
    problem->progress = note_speed;
    problem->data = &found;
    verify_ok(steady_search_run(problem));
    found.n_beats = problem->map.n_beats;
    found.speed = problem->map.last[0].speed;
    found.strouhal = search.simulation->diagnostics->fish[0].strouhal;
    found.cost = problem->map.last[0].actuation + problem->map.last[0].driving;
    verify_ok(steady_multipliers_find(search.simulation->arena, problem, &multipliers));
    found.multiplier = hypot(multipliers.real[0], multipliers.imaginary[0]);
    return found;
}

// the speed over each beat of a long run, and the mean power over the last beat
static double run_long(const char *text, double speed[BRUTE_BEATS + 1]) {
    struct simulation *const simulation = verify_open("%s", text);
    struct steady_map map;
    verify_ok(steady_map_create(&map, simulation));
    for (int i = 1; i <= BRUTE_BEATS; i++) {
        verify_ok(steady_map_beat(&map, NULL, NULL));
        speed[i] = map.last[0].speed;
    }
    return map.last[0].actuation + map.last[0].driving;
}

// the first beat from which on all speeds are right to 1e-4
static int beats_to_bound(int n, const double *speed, double reference) {
    int beat = n;
    while (beat > 1 && fabs(speed[beat - 1] / reference - 1) <= 1e-4) beat--;
    return beat;
}

static void compare(const struct swimmer *swimmer) {
    const char *const name = swimmer->name;
    double speed[BRUTE_BEATS + 1];
    const double power = run_long(swimmer->text, speed), reference = speed[BRUTE_BEATS];
    const struct found found = search_for(swimmer->text);
    verify_relative(verify_text("%s: speed, m/s", name), "a run of 200 beats", reference, found.speed, 1e-4);
    verify_relative(verify_text("%s: power, W", name), "a run of 200 beats", power, found.cost, 5e-4);
    // fish of length 1 m with a beat of 1 s: the stride, in lengths a beat, equals the speed
    if (swimmer->is_fish) {
        verify_ratio(verify_text("%s: stride, lengths a beat", name), "range published for fish", 1, found.speed, 0.45,
                     1.25);
        verify_ratio(verify_text("%s: Strouhal number", name), "range published for fish", 1, found.strouhal, 0.14,
                     0.35);
    }
    verify_zero(verify_text("%s: beats of the search", name), "at most a tenth of the run's", found.n_beats,
                MOST_BEATS);
    const int n = found.n_beats < MOST_BEATS ? found.n_beats : MOST_BEATS;
    verify_show(verify_text("%s: beats to 1e-4, search", name), "all later ones are right, too",
                beats_to_bound(n, found.to_bound, reference));
    verify_show(verify_text("%s: beats to 1e-4, run", name), "all later ones are right, too",
                beats_to_bound(BRUTE_BEATS, speed, reference));
    const double before = speed[swimmer->decays_from] - reference, after = speed[swimmer->decays_to] - reference;
    verify_value(verify_text("%s: largest multiplier", name), "by which the run's error falls in a beat",
                 pow(after / before, 1.0 / (swimmer->decays_to - swimmer->decays_from)), found.multiplier, 0.01);
    for (int i = 1; i <= 60; i++) {
        verify_point(verify_text("steady_%s", name), "run", i, fmax(1e-7, fabs(speed[i] / reference - 1)));
    }
    for (int i = 1; i <= n; i++) {
        verify_point(verify_text("steady_%s", name), "search", i, fmax(1e-7, fabs(found.to_bound[i] / reference - 1)));
    }
}

#define TIME "format: 1\ntime: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"

static const struct swimmer swimmers[] = {
    {"default fish", TIME "fish: [{start: {speed: 0.5}}]\n", true, 20, 30},
    {"stiff fish", TIME "fish: [{body: {modulus: 1e7}}]\n", true, 20, 30},
    {"fish with pressure",
     // with a wake of 8 beats a turn, which the run does not excite, decays more slowly than the speed
     TIME "fish: [{force: pressure, pressure: {span: infinite}, start: {speed: 0.5}, body: {depth: 1}}]\n", true, 20,
     30},
    {"fish with the reactive force", TIME "fish: [{force: reactive}]\n", true, 20, 30},
    {"heaving plate",
     TIME "solver: {rtol: 1e-6}\n"
          "fluid: {density: 1, viscosity: 4.536e-4}\nwake: {lifetime: 8, smoothing: 0.1}\n"
          "fish: [{length: 2, force: pressure, pressure: {span: infinite}, start: {speed: 4}, wave: "
          "{amplitude: 0, frequency: 0},\n"
          "  body: {profile: uniform, thickness: 0.1, depth: 0.5, density: 1.5915, modulus: 1e5},\n"
          "  motion: {prescribed: all, surge: free, heave: 0.1, frequency: 1}}]\n",
     false, 20, 30},
};

// ---- a fish that is steered, and two that swim freely

static void let_run(struct verify_search *steered, int n_beats) {
    for (int i = 0; i < n_beats; i++) verify_ok(steady_map_beat(&steered->problem.map, NULL, NULL));
}

// the largest multiplier
static double find_steered(struct verify_search *steered, const char *text) {
    struct steady_multipliers multipliers;
    verify_search_open(steered, text);
    verify_ok(steady_search_run(&steered->problem));
    verify_ok(steady_multipliers_find(steered->simulation->arena, &steered->problem, &multipliers));
    return hypot(multipliers.real[0], multipliers.imaginary[0]);
}

static void circle(const char *name, const char *text) {
    struct verify_search found, run;
    find_steered(&found, text);
    verify_search_open(&run, text);
    let_run(&run, BRUTE_BEATS);
    const struct steady_beat *const last = found.problem.map.last, *const reference = run.problem.map.last;
    static const char source[] = "a run of 200 beats";
    verify_relative(verify_text("%s: speed, m/s", name), source, reference->speed, last->speed, 1e-4);
    // the tolerance of the search, 1e-5 of a circle
    verify_value(verify_text("%s: turn in a beat, rad", name), source, reference->turn, last->turn, 6.3e-5);
    // one more beat has been taken for the means
    verify_zero(verify_text("%s: beats of the search", name), "about a tenth of the run's",
                found.problem.map.n_beats - 1, 24);
}

static void circles(void) {
    circle("fish in a wide circle", TIME "fish: [{start: {speed: 0.6}, control: {bias: 0.03}}]\n");
    circle("fish in a circle", TIME "fish: [{start: {speed: 0.6}, control: {bias: 0.1}}]\n");
    circle("fish in a narrow circle", TIME "fish: [{start: {speed: 0.6}, control: {bias: 0.4}}]\n");
    circle("fish with pressure in a circle",
           TIME "fish: [{force: pressure, pressure: {span: infinite}, control: {bias: 0.2}}]\n");
}

/* cases/formation.yaml */
#define PAIR                                            \
    TIME "steady: {formation: true, tolerance: 3e-4}\n" \
         "defaults: {fish: {force: reactive, start: {speed: 0.8}, control: {law: heading, desired_heading: 180}}}\n"

static void formation(void) {
    struct verify_search found, run;
    const double multiplier = find_steered(&found, PAIR "fish: [{}, {start: {position: [1.5, 0]}}]\n");
    verify_search_open(&run, PAIR "fish: [{}, {start: {position: [1.7, 0.1]}}]\n");
    let_run(&run, 150);
    const struct steady_beat *const last = found.problem.map.last, *const reference = run.problem.map.last;
    static const char source[] = "a run of 150 beats from 0.2 L behind, 0.1 L aside";
    verify_relative("two free fish: place of the second, m", source, reference[1].place[0], last[1].place[0], 1e-3);
    verify_value("two free fish: to the side, m", source, reference[1].place[1], last[1].place[1], 1e-3);
    verify_relative("two free fish: speed, m/s", source, reference[1].speed, last[1].speed, 3e-4);
    verify_zero("two free fish: largest multiplier", "stable: below 1", multiplier, 1);
    verify_show("two free fish: beats of the search", "speeds, slips, turns, headings, a place",
                found.problem.map.n_beats);
}

void verify_steady(void) {
    if (verify_is_fast()) return;
    for (size_t i = 0; i < sizeof swimmers / sizeof *swimmers; i++) compare(&swimmers[i]);
    circles();
    formation();
}
