/* growth.c: The section "growth" starts runs from the mode of a steady state and compares the growth of the disturbance
 * with the largest multiplier (doc/steady.md, Multipliers), which comes from responses of single beats. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "steady/steady_modes.h"
#include "steady/steady_search.h"
#include "study/branch.h"
#include "study/study_folder.h"
#include "verify.h"

enum { MOST_UNKNOWNS = 16, MOST_BEATS = 24 };

struct growing {
    const char *name, *text;
    double size;     /* of the disturbance: of its largest slow quantity, in the scale of this quantity */
    int first, last; /* beats of the run that count: before the first, the wake has not seen the disturbance */
};

/* The unknowns over their scales after each beat of a run from the mode, with this size and sign. */
static void run_from_mode(struct steady_problem *problem, const struct steady_multipliers *multipliers,
                          const struct state *kept, double size, int n_beats, double path[][MOST_UNKNOWNS]) {
    const int n = problem->n_unknowns;
    double add[MOST_UNKNOWNS];
    for (int i = 0; i < n; i++) {
        add[i] = size * multipliers->mode[2 * i] * steady_map_scale(&problem->map, problem->unknown[i]);
    }
    verify_ok(steady_map_return(problem->map.simulation, kept));
    verify_ok(steady_map_add(&problem->map, n, problem->unknown, add));
    for (int beat = 1; beat <= n_beats; beat++) {
        verify_ok(steady_map_beat(&problem->map, NULL, NULL));
        steady_problem_read(problem, path[beat]);
    }
}

/* The growth in a beat of the differences x_k of two runs: the root of the recurrence x_k+1 = a x_k + b x_k-1 of least
 * squares; b = 0 if the multiplier is real. */
static double growth(int n, int first, int last, bool is_real, double path[][MOST_UNKNOWNS],
                     double other[][MOST_UNKNOWNS]) {
    double now2 = 0, before2 = 0, mixed = 0, next_now = 0, next_before = 0;
    for (int beat = first + 1; beat < last; beat++) {
        for (int i = 0; i < n; i++) {
            const double before = path[beat - 1][i] - other[beat - 1][i], now = path[beat][i] - other[beat][i],
                         next = path[beat + 1][i] - other[beat + 1][i];
            now2 += now * now;
            before2 += before * before;
            mixed += now * before;
            next_now += next * now;
            next_before += next * before;
        }
    }
    if (is_real) return next_now / now2;
    const double determinant = now2 * before2 - mixed * mixed;
    const double a = (next_now * before2 - next_before * mixed) / determinant,
                 b = (next_before * now2 - next_now * mixed) / determinant, discriminant = a * a / 4 + b;
    return discriminant < 0 ? sqrt(-b) : fabs(a) / 2 + sqrt(discriminant);
}

static void compare(const struct growing *state) {
    static double ahead[MOST_BEATS + 1][MOST_UNKNOWNS], back[MOST_BEATS + 1][MOST_UNKNOWNS];
    struct verify_search search;
    struct steady_multipliers multipliers;
    struct state *kept = NULL;
    verify_search_open(&search, state->text);
    struct steady_problem *const problem = &search.problem;
    verify_ok(steady_search_run(problem));
    verify_ok(steady_multipliers_find(search.simulation->arena, problem, &multipliers));
    steady_map_save(search.simulation->arena, search.simulation, &kept);
    run_from_mode(problem, &multipliers, kept, state->size, state->last, ahead);
    run_from_mode(problem, &multipliers, kept, -state->size, state->last, back);
    const double largest = hypot(multipliers.real[0], multipliers.imaginary[0]);
    const double measured =
        growth(problem->n_unknowns, state->first, state->last, fabs(multipliers.imaginary[0]) <= 0, ahead, back);
    verify_relative(verify_text("%s: largest multiplier", state->name), "growth in a run that starts from the mode",
                    measured, largest, 0.05);
    verify_show(verify_text("%s: error of the multiplier", state->name), "of shoal steady", multipliers.error[0]);
}

#define PLATES                                                                    \
    "format: 1\ntime: {end: 1, shedding_interval: %s, output_interval: 0.05}\n"   \
    "fluid: {density: 1, viscosity: 2e-3}\nwake: {lifetime: 8, smoothing: 0.2}\n" \
    "steady: {formation: true, tolerance: %s}\nsolver: {rtol: %s}\n"              \
    "defaults: {fish: {nodes: 4, sheet_points: 13, " VERIFY_ATTACHED              \
    ", wave: {amplitude: 0, frequency: 0},\n"                                     \
    "  body: {profile: uniform, thickness: 0.05, depth: 1, density: 20},\n"       \
    "  start: {speed: %s}, motion: {prescribed: all, surge: free, heave: %s, frequency: 1}}}\n"

/* A state between two places is left at more than twice the distance in every beat, so it has to be found exactly. */
static const struct {
    const char *name, *tolerance, *rtol, *speed, *heave, *fish;
    double size;
    int first, last;
} schools[] = {
    {"two plates", "1e-3", "3e-5", "3.9", "0.15", "{}, {start: {position: [5, 0]}}", 0.05, 4, 16},
    {"two plates, heave 0.1 m", "1e-3", "3e-5", "2.06", "0.1", "{}, {start: {position: [3.16, 0]}}", 0.05, 4, 16},
    {"three plates", "1e-3", "3e-5", "3.9", "0.15", "{}, {start: {position: [5, 0]}}, {start: {position: [10, 0]}}",
     0.05, 5, 18},
    {"three plates, heave 0.1 m", "1e-3", "3e-5", "2.06", "0.1",
     "{}, {start: {position: [3.16, 0]}}, {start: {position: [6.36, 0]}}", 0.05, 5, 18},
    {"second place", "1e-3", "3e-5", "3.9", "0.15", "{}, {start: {position: [8.8, 0]}}", 0.05, 5, 17},
    {"between the first two places", "1e-4", "1e-7", "3.9", "0.15", "{}, {start: {position: [7.24, 0]}}", 1e-4, 1, 6},
    {"four plates", "1e-3", "3e-5", "3.9", "0.15",
     "{}, {start: {position: [5, 0]}}, {start: {position: [10, 0]}}, {start: {position: [14.9, 0]}}", 0.05, 6, 20},
};

/* Five plates at heave 0.12 m, released from their steady state: what is left of the search excites the modes, and
 * the run shows the one that grows. */
static void long_run(void) {
    enum { BEATS = 60, FIRST = 20, N = 5 };
    static double place[BEATS][N];
    struct verify_search search;
    struct steady_multipliers multipliers;
    char text[2048];
    const int length = snprintf(text, sizeof text, PLATES, "0.05", "1e-3", "3e-5", "2.75", "0.12");
    snprintf(text + length, sizeof text - (size_t)length,
             "fish: [{}, {start: {position: [3.87, 0]}}, {start: {position: [7.6, 0]}}, {start: {position: [11.4, "
             "0]}},\n  {start: {position: [15.3, 0]}}]\n");
    verify_search_open(&search, text);
    struct steady_problem *const problem = &search.problem;
    verify_ok(steady_search_run(problem));
    verify_ok(steady_multipliers_find(search.simulation->arena, problem, &multipliers));
    for (int beat = 0; beat < BEATS; beat++) {
        verify_ok(steady_map_beat(&problem->map, NULL, NULL));
        for (int f = 0; f < N; f++) place[beat][f] = problem->map.last[f].place[0];
    }

    // the fish that moves most: in the mode, and about its mean place in the run
    double of_mode[N] = {0}, of_run[N] = {0}, mean[N] = {0};
    for (int i = 0; i < problem->n_unknowns; i++) {
        if (problem->unknown[i].quantity != STEADY_AHEAD) continue;
        of_mode[problem->unknown[i].fish] = hypot(multipliers.mode[2 * i], multipliers.mode[2 * i + 1]);
    }
    for (int f = 0; f < N; f++) {
        for (int beat = FIRST; beat < BEATS; beat++) mean[f] += place[beat][f] / (BEATS - FIRST);
        for (int beat = FIRST; beat < BEATS; beat++) of_run[f] += pow(place[beat][f] - mean[f], 2) / (BEATS - FIRST);
    }
    int mode = 0, run = 0;
    for (int f = 0; f < N; f++) {
        if (of_mode[f] > of_mode[mode]) mode = f;
        if (of_run[f] > of_run[run]) run = f;
    }
    verify_value("five plates: the plate that moves most, of 1 to 5", "a run of 60 beats", run + 1, mode + 1, 0);

    // the period of this plate, from the first and the last passage through its mean place
    double first = -1, last = -1;
    int n_passages = 0;
    for (int beat = FIRST + 1; beat < BEATS; beat++) {
        const double before = place[beat - 1][run] - mean[run], now = place[beat][run] - mean[run];
        if (!(before < 0 && now >= 0)) continue;
        last = beat - now / (now - before);
        if (n_passages++ == 0) first = last;
    }
    const double period = 2 * 3.14159265358979323846 / fabs(atan2(multipliers.imaginary[0], multipliers.real[0]));
    verify_show("five plates: largest multiplier", "of shoal steady",
                hypot(multipliers.real[0], multipliers.imaginary[0]));
    verify_show("five plates: its error", "of shoal steady", multipliers.error[0]);
    verify_show("five plates: largest deviation in the run, m", "root mean square", sqrt(of_run[run]));
    verify_relative("five plates: period, beats", "a run of 60 beats", (last - first) / (n_passages - 1), period, 0.15);
}

/* The multiplier of two plates with other numerical parameters. */
static void other_parameters(void) {
    static const char *const interval[] = {"0.05", "0.05", "0.025", "0.025"}, *const rtol[] = {"3e-5", "1e-6", "3e-5",
                                                                                               "1e-6"};
    double first = 0, first_error = 0;
    for (int i = 0; i < 4; i++) {
        struct verify_search search;
        struct steady_multipliers multipliers;
        char text[2048];
        const int length = snprintf(text, sizeof text, PLATES, interval[i], "1e-3", rtol[i], "3.9", "0.15");
        snprintf(text + length, sizeof text - (size_t)length, "fish: [{}, {start: {position: [5.06, 0]}}]\n");
        verify_search_open(&search, text);
        verify_ok(steady_search_run(&search.problem));
        verify_ok(steady_multipliers_find(search.simulation->arena, &search.problem, &multipliers));
        const double size = hypot(multipliers.real[0], multipliers.imaginary[0]);
        if (i == 0) {
            first = size;
            first_error = multipliers.error[0];
            continue;
        }
        verify_value(verify_text("two plates, interval %s, rtol %s", interval[i], rtol[i]),
                     "the multiplier with 0.05 and 3e-5, within both errors", first, size,
                     first_error + multipliers.error[0]);
    }
}

/* The modulus below which the flag of cases/flag.yaml flutters. bar: NULL: not needed, which saves the finer states. */
static void find_flutter(const char *interval, int nodes, double from, double to, double *value, double *bar) {
    ARENA(arena, NULL, "a threshold");
    struct case_values values;
    struct branch *branch;
    char folder[] = "/tmp/verify_growth.XXXXXX";
    char text[3][64];
    snprintf(text[0], sizeof text[0], "time.shedding_interval=%s", interval);
    snprintf(text[1], sizeof text[1], "fish[0].nodes=%d", nodes);
    snprintf(text[2], sizeof text[2], "fish[0].sheet_points=%d", 2 * nodes - 1);
    const char *const assignments[] = {text[0], text[1], text[2], "time.output_interval=0.2"};
    verify_ok(case_read(&values, "cases/flag.yaml", 4, assignments));
    arena_move(values.arena, arena);
    if (!mkdtemp(folder)) verify_ok(status_fail(STATUS_FILE, "%s: cannot be created", folder));
    const enum status status = branch_follow(arena, &values,
                                             &(struct branch_options){.option = "--threshold",
                                                                      .key = "fish[*].body.modulus",
                                                                      .from = from,
                                                                      .to = to,
                                                                      .to_threshold = bar,
                                                                      .origin = "flag",
                                                                      .folder = folder},
                                             &branch);
    study_folder_remove(folder);
    verify_ok(status);
    if (branch->n_thresholds != 1) verify_ok(status_fail(STATUS_SOLVER, "%d thresholds", branch->n_thresholds));
    *value = branch->threshold[0].value;
    if (bar) *bar = branch->threshold[0].bar;
}

/* The thresholds of the flag at five intervals do not converge to its limit, because sheet and nodes stay the same, but
 * their bars contain that of a fine flag. */
static void other_intervals(void) {
    static const char *const interval[] = {"0.05", "0.025", "0.02", "0.0125", "0.00625"};
    double fine;
    find_flutter("0.0125", 97, 83000, 83600, &fine, NULL);
    verify_show("flag: modulus of flutter, Pa, interval 0.0125 s, 97 nodes", "of shoal steady", fine);
    for (int i = 0; i < 5; i++) {
        double value, bar;
        find_flutter(interval[i], 25, 50000, 120000, &value, &bar);
        verify_value(verify_text("flag: modulus of flutter, Pa, interval %s s", interval[i]),
                     "97 nodes, within the bar", fine, value, bar);
        // a bar that contains everything says nothing
        verify_value(verify_text("flag: bar over the modulus, interval %s s", interval[i]), "2 %", 0, bar / value,
                     0.02);
    }
}

void verify_growth(void) {
    if (verify_is_fast()) return;
    other_intervals();
    compare(&(struct growing){"default fish",
                              "format: 1\ntime: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
                              "fish: [{start: {speed: 0.8}}]\n",
                              0.05, 1, 8});
    for (size_t i = 0; i < sizeof schools / sizeof *schools; i++) {
        char text[2048];
        const int length = snprintf(text, sizeof text, PLATES, "0.05", schools[i].tolerance, schools[i].rtol,
                                    schools[i].speed, schools[i].heave);
        snprintf(text + length, sizeof text - (size_t)length, "fish: [%s]\n", schools[i].fish);
        compare(&(struct growing){schools[i].name, text, schools[i].size, schools[i].first, schools[i].last});
    }
    long_run();
    other_parameters();
}
