/* interval.c: the section "interval": the order in the shedding interval of the default model: one soft fish, from rest
 * and from a moving start, with decay of the oldest wake during the run.
 *
 * Runs are compared with finer runs as root mean squares over the run, because the instantaneous error of a point of a
 * beating fish changes sign, with orders between 0.7 and 1.9. A free sheet is refined together with the bound sheet, M
 * - 1 with the inverse root of the interval (doc/numerics.md 5): with the same sheet points, intervals below U Dt/L =
 * (3.2/(M - 1))^2 change nothing. Errors are larger for a fish from rest, because the first wake stays next to the
 * tail.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "verify.h"

enum quantity { NOSE, TAIL, SHED, N_QUANTITIES };
static const char *const quantity_name[N_QUANTITIES] = {"nose", "tail", "shed circulation"};
enum { MOST_RUNS = 5, N_TIMES = 75 };
static const double longest = 0.02;  // interval, s; runs are compared at multiples of this interval

// a run: places in m, circulation in m2/s
struct path {
    double nose[N_TIMES][2], tail[N_TIMES][2], shed[N_TIMES];
};

// one fish, and the varied keys; force: a force that depends on the own wake
struct variant {
    const char *shedding, *force, *removed;
    double speed;  // at the start, m/s
};

// A free sheet acts on the own fish by the pressure. The own wake has no effect on a reactive fish, so only the
// circulation depends on the interval.
static bool is_sheet(const struct variant *variant) {
    return strcmp(variant->shedding, "sheet") == 0;
}

static void run_fish(const struct variant *variant, double interval, struct path *path) {
    const int n_sheet = is_sheet(variant) ? 1 + (int)lround(32 * sqrt(longest / interval)) : 65;
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: %.17g, shedding_interval: %.17g, output_interval: %.17g}\n"
        "wake: {shedding: %s, removed_circulation: %s, lifetime: 1, decay: 0.2}\n"
        "solver: {rtol: 1e-9, order: 5}\n"
        "fish: [{nodes: 7, sheet_points: %d, force: %s, start: {speed: %g},\n"
        "  body: {thickness: 0.2, depth: 0.25, modulus: 1.0e+5}, drag: {normal: %d}}]\n",
        N_TIMES * longest, interval, N_TIMES * longest, variant->shedding, variant->removed, n_sheet, variant->force,
        variant->speed, strcmp(variant->force, "pressure") != 0);
    const struct fish *const fish = &simulation->school->fish[0];
    const double *const y = simulation->state->y;
    const int last = fish->n_nodes - 1;
    for (int i = 0; i < N_TIMES; i++) {
        verify_run(simulation, (i + 1) * longest);
        path->nose[i][0] = y[fish->at.x];
        path->nose[i][1] = y[fish->at.y];
        path->tail[i][0] = y[fish->at.x + last];
        path->tail[i][1] = y[fish->at.y + last];
        path->shed[i] = y[fish->at.circulation];
    }
}

// the root mean square over the run
static double difference(const struct path *a, const struct path *b, enum quantity quantity) {
    double sum = 0;
    for (int i = 0; i < N_TIMES; i++) {
        const double *const p = quantity == NOSE ? a->nose[i] : a->tail[i];
        const double *const q = quantity == NOSE ? b->nose[i] : b->tail[i];
        const double far = quantity == SHED ? a->shed[i] - b->shed[i] : hypot(p[0] - q[0], p[1] - q[1]);
        sum += far * far;
    }
    return sqrt(sum / N_TIMES);
}

// expected orders, with reasons
struct expected {
    double least, most;
    const char *source;
};

static void report(const struct variant *variant, const struct expected *expected, int n, const double *interval,
                   const struct path *runs, enum quantity quantity) {
    double change[MOST_RUNS];
    char name[80], what[120], series[80];
    snprintf(name, sizeof name, "%s, %s, %s: %s", variant->shedding, variant->removed,
             variant->speed > 0 ? "moving" : "from rest", quantity_name[quantity]);
    snprintf(series, sizeof series, "%s: %s", variant->speed > 0 ? "moving" : "from rest", quantity_name[quantity]);
    for (int i = 0; i + 1 < n; i++) {
        change[i] = difference(&runs[i], &runs[i + 1], quantity);
        verify_point(verify_text("interval, %s, %s", variant->shedding, variant->removed), series, interval[i],
                     change[i]);
    }
    snprintf(what, sizeof what, "order in Dt, %s", name);
    verify_order(what, expected->source, verify_slope(n - 1, interval, change), expected->least, expected->most);
    if (verify_is_fast()) return;
    snprintf(what, sizeof what, "%s, the two finest changes: order", name);
    verify_show(what, "", verify_order_of_errors(change[n - 3], change[n - 2]));
    snprintf(what, sizeof what, "%s, error at Dt = 0.01 s", name);
    verify_show(what, quantity == SHED ? "m2/s, against Dt = 0.00125 s" : "m, against Dt = 0.00125 s",
                difference(&runs[1], &runs[n - 1], quantity));
}

// the changes when the interval is halved, from the longest on: the slope over all changes, and the size of the error
static void halve_interval(const struct variant *variant, const struct expected *expected) {
    const int n = verify_is_fast() ? 4 : MOST_RUNS;
    double interval[MOST_RUNS];
    static struct path runs[MOST_RUNS];
    for (int i = 0; i < n; i++) {
        interval[i] = ldexp(longest, -i);
        run_fish(variant, interval[i], &runs[i]);
    }
    for (int q = is_sheet(variant) ? 0 : SHED; q < N_QUANTITIES; q++)
        report(variant, &expected[q], n, interval, runs, (enum quantity)q);
}

void verify_interval(void) {
    static const char second[] = "doc/model.md 7, 8: every part of the scheme is of second order";
    static const struct expected continuous[N_QUANTITIES] = {
        [NOSE] = {1.8, 2.2, second}, [TAIL] = {1.8, 2.2, second}, [SHED] = {1.8, 2.2, second}};
    static const char first[] = "the spacing of the bound sheet, which is refined as the root of Dt: first order";
    static const struct expected sheet[N_QUANTITIES] = {
        [NOSE] = {0.9, 2.2, first}, [TAIL] = {0.9, 2.2, first}, [SHED] = {0.9, 2.2, first}};
    static const char *const removed[] = {"retained", "dropped"};
    for (int is_moving = verify_is_fast(); is_moving < 2; is_moving++) {
        for (int d = 0; d < (verify_is_fast() ? 1 : 2); d++) {
            const struct variant free_sheet = {"sheet", "pressure, pressure: {span: infinite}", removed[d], is_moving};
            const struct variant one = {"continuous", "published", removed[d], is_moving};
            halve_interval(&free_sheet, sheet);
            halve_interval(&one, continuous);
        }
    }
}
