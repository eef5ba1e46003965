/* symmetry.c: The motion does not depend on the position and the rotation of the school, the order of the fish, the
 * interval of output or the number of threads. */
#include <math.h>
#include <netcdf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "run/simulate_run.h"
#include "verify.h"

enum { N_FISH = 3, MOST_TEXT = 8192 };

// three different fish that meet, with different control laws
static const struct {
    const char *name, *keys;
    double position[2], heading, phase, bias;
} school[N_FISH] = {
    {"leader", "control: {law: heading, desired_heading: %.17g, feedforward: %.17g}", {0, 0}, 180, 0, 0},
    {"side",
     "nodes: 5, sheet_points: 21, length: 0.8, control: {law: heading, desired_heading: %.17g, feedforward: %.17g}",
     {0.3, 0.5},
     180,
     90,
     0},
    {"behind", "nodes: 9, sheet_points: 21, length: 0.9, control: {bias: %.17g}", {1.3, 0.15}, 180, 200, 0.2}};
static const double desired[2] = {175, 190};  // degree, of the first two

// a way of looking at the same school: mirrored at the x axis, then turned, then shifted, seen from a moving frame
struct view_point {
    int mirrored, quarter_turns;
    double shift[2], stream; /* m, and m/s along x */
    int order[N_FISH];       /* in which the fish are listed */
    int threads;
    double feedforward;
    double rtol, ramp, end; /* ramp of the muscle, and end of the run, s */
    int integrator_order;
    int second; /* 0: the options of the article; 1: the default model */
};
static const struct view_point usual = {
    .order = {0, 1, 2}, .threads = 1, .feedforward = 1, .rtol = 1e-5, .ramp = 1, .end = 0.8, .integrator_order = 2};

static const double interval = 0.02;  // s

static void turn(const struct view_point *view, double x, double y, double turned[2]) {
    const double mirrored = view->mirrored ? -y : y;
    const double c[4] = {1, 0, -1, 0}, s[4] = {0, 1, 0, -1};
    const int q = view->quarter_turns;
    turned[0] = c[q] * x - s[q] * mirrored;
    turned[1] = s[q] * x + c[q] * mirrored;
}

static double turned_angle(const struct view_point *view, double degrees) {
    return (view->mirrored ? -degrees : degrees) + 90 * view->quarter_turns;
}

// the case in another view. Mirroring changes the sign of the wave, which adds half a turn to the phase, and the sign
// of the bias
static void write_case(const struct view_point *view, double output_interval, char *text) {
    int used =
        snprintf(text, MOST_TEXT,
                 "%sformat: 1\nname: symmetry\ntime: {end: %.17g, shedding_interval: %.17g, output_interval: %.17g}\n"
                 "fluid: {velocity: [%.17g, 0]}\nwake: {lifetime: 0.5, decay: 0.2}\n"
                 "solver: {threads: %d, rtol: %.17g, order: %d}\n"
                 "defaults: {fish: {body: {depth: 0.25}, %swave: {ramp: %.17g}}}\nfish:\n",
                 view->second ? "" : VERIFY_ARTICLE, view->end, interval, output_interval, view->stream, view->threads,
                 view->rtol, view->integrator_order, view->second ? "nodes: 7, sheet_points: 21, " : "", view->ramp);
    for (int place = 0; place < N_FISH; place++) {
        const int f = view->order[place];
        double at[2];
        turn(view, school[f].position[0], school[f].position[1], at);
        used += snprintf(text + used, (size_t)(MOST_TEXT - used),
                         "  - {name: %s, start: {position: [%.17g, %.17g], heading: %.17g, speed: %.17g}, "
                         "wave: {phase: %.17g}, ",
                         school[f].name, at[0] + view->shift[0], at[1] + view->shift[1],
                         turned_angle(view, school[f].heading), 1 - view->stream,
                         school[f].phase + (view->mirrored ? 180 : 0));
        const double steer = f < 2 ? turned_angle(view, desired[f]) : school[f].bias * (view->mirrored ? -1 : 1);
        used += f < 2 ? snprintf(text + used, (size_t)(MOST_TEXT - used), school[f].keys, steer, view->feedforward)
                      : snprintf(text + used, (size_t)(MOST_TEXT - used), school[f].keys, steer);
        used += snprintf(text + used, (size_t)(MOST_TEXT - used), "}\n");
    }
}

static struct simulation *run(const struct view_point *view) {
    char text[MOST_TEXT];
    write_case(view, interval, text);
    struct simulation *simulation = verify_open("%s", text);
    verify_run(simulation, view->end);
    return simulation;
}

static double largest(double a, double b) {
    return a > b ? a : b;
}

// distance of a point from the point transformed from the other view
static double distance(const struct view_point *view, double x, double y, double seen_x, double seen_y) {
    double turned[2];
    turn(view, x, y, turned);
    return hypot(seen_x - turned[0] - view->shift[0] - view->stream * view->end, seen_y - turned[1] - view->shift[1]);
}

// the largest difference between the usual run and one seen from elsewhere: bodies and wakes, m, and circulations, m2/s
static void compare(const struct simulation *one, const struct simulation *seen, const struct view_point *view,
                    double *bodies, double *wakes) {
    *bodies = *wakes = 0;
    const double sign = view->mirrored ? -1 : 1;
    for (int place = 0; place < N_FISH; place++) {
        const int f = view->order[place];
        const struct fish *a = &one->school->fish[f], *b = &seen->school->fish[place];
        const double *const y = one->state->y, *const z = seen->state->y;
        for (int k = 0; k < a->n_nodes; k++) {
            *bodies = largest(*bodies, distance(view, y[a->at.x + k], y[a->at.y + k], z[b->at.x + k], z[b->at.y + k]));
        }
        for (int j = 0; j < a->n_sheet; j++) {
            *wakes = largest(*wakes, fabs(sign * y[a->at.gamma + j] - z[b->at.gamma + j]) * a->sheet_weight[j]);
        }
        const struct wake *v = &one->state->wake[f], *w = &seen->state->wake[place];
        if (v->n_vortex != w->n_vortex) *wakes = INFINITY;
        for (int i = 0; i < v->n_vortex && i < w->n_vortex; i++) {
            *wakes = largest(*wakes, distance(view, v->x[i], v->y[i], w->x[i], w->y[i]));
            *wakes = largest(*wakes, fabs(sign * v->circulation[i] - w->circulation[i]));
        }
    }
}

static void compare_with_usual(const struct view_point *view, double *bodies, double *wakes) {
    struct view_point plain = usual;
    plain.feedforward = view->feedforward;
    plain.rtol = view->rtol;
    plain.integrator_order = view->integrator_order;
    plain.ramp = view->ramp;
    plain.end = view->end;
    plain.second = view->second;
    struct simulation *one = run(&plain), *seen = run(view);
    compare(one, seen, view, bodies, wakes);
}

// With a smooth start of the muscle the first error estimates are round-off, and round-off determines the first steps.
// So a run from another view agrees to the tolerance. With a sudden start of the muscle the steps are the same, and a
// short run agrees to round-off.
static void check_view(const char *what, const char *source, const struct view_point *view, int same_steps) {
    double bodies, wakes;
    char quantity[80];
    if (same_steps) {
        struct view_point at_once = *view;
        at_once.ramp = 0;
        at_once.end = 5 * interval;
        compare_with_usual(&at_once, &bodies, &wakes);
        snprintf(quantity, sizeof quantity, "%s: five events, same steps", what);
        // one step that differed would show as 1e-6 and more: the tolerance is 1e-5 here
        verify_zero(quantity, source, largest(bodies, wakes), 1e-9);
    }
    struct view_point tight = *view;
    tight.rtol = 1e-11;
    tight.integrator_order = 5;
    if (verify_is_fast()) tight.end = 0.4;
    compare_with_usual(&tight, &bodies, &wakes);
    const char *const tolerance = "own steps at rtol 1e-11, order 5: global error about 1e-9 (section school)";
    snprintf(quantity, sizeof quantity, "%s: bodies [m]", what);
    verify_zero(quantity, tolerance, bodies, 1e-8);
    snprintf(quantity, sizeof quantity, "%s: wakes [m], circulation [m2/s]", what);
    verify_zero(quantity, tolerance, wakes, 1e-8);
}

static void check_views(void) {
    const char *const same = "the equations know no place and no direction: round-off";
    struct view_point view = usual;
    view.shift[0] = 3.7;
    view.shift[1] = -1.3;
    check_view("translation", same, &view, 1);
    view = usual;
    view.quarter_turns = 1;
    check_view("rotation by 90 degrees", same, &view, 1);
    view = usual;
    view.mirrored = 1;
    check_view("mirror", same, &view, 1);
    view.second = 1;
    view.feedforward = 0;  // refused with the pressure
    check_view("mirror, default model", same, &view, 1);
    // tau of doc/model.md 11 is the moment of the whole flow, a uniform stream's too: no feedforward here. IDA's first
    // step depends on the size of the velocities, so the steps differ
    view = usual;
    view.stream = 0.7;
    view.feedforward = 0;
    check_view("stream against moving frame", NULL, &view, 0);
    view = usual;
    view.order[0] = 2;
    view.order[1] = 0;
    view.order[2] = 1;
    check_view("order of the fish", "a sum in another order: round-off", &view, 1);

    view = usual;
    view.threads = 2;
    double bodies, wakes;
    compare_with_usual(&view, &bodies, &wakes);
    verify_zero("threads 2 against 1: all", "every sum has a fixed order: the same bits", largest(bodies, wakes), 0);
}

// the last row of a result file; the caller frees
static double *last_row(const char *path, const char *name, size_t *n) {
    int file, variable, n_dimensions, dimension[NC_MAX_VAR_DIMS];
    size_t start[NC_MAX_VAR_DIMS] = {0}, count[NC_MAX_VAR_DIMS];
    int failed = nc_open(path, NC_NOWRITE, &file) || nc_inq_varid(file, name, &variable) ||
                 nc_inq_varndims(file, variable, &n_dimensions) || nc_inq_vardimid(file, variable, dimension);
    *n = 1;
    for (int i = 0; !failed && i < n_dimensions; i++) {
        failed = nc_inq_dimlen(file, dimension[i], &count[i]);
        if (i > 0) *n *= count[i];
    }
    double *const values = failed ? NULL : calloc(*n, sizeof *values);
    if (values) {
        start[0] = count[0] - 1;
        count[0] = 1;
        failed = nc_get_vara_double(file, variable, start, count, values);
    }
    if (failed || !values || nc_close(file)) {
        fprintf(stderr, "verify symmetry: %s cannot be read from %s\n", name, path);
        exit(1);
    }
    return values;
}

static void write_result(const char *path, double output_interval) {
    char text[MOST_TEXT];
    struct view_point view = usual;
    view.feedforward = 0;
    write_case(&view, output_interval, text);
    struct case_values values;
    const struct simulate_options options = {.path = path, .overwrite = 1, .command = "verify"};
    if (case_parse(&values, text, strlen(text), "verify", ".", 0, NULL) != STATUS_OK ||
        simulate_run(&values, &options) != STATUS_OK) {
        fprintf(stderr, "verify symmetry: %s\n", status_message());
        exit(1);
    }
    case_free(&values);
}

// one row of output at the end, or one at every second event on the way
static void check_output_interval(void) {
    char folder[] = "/tmp/shoal-verify-XXXXXX", path[2][64];
    if (!mkdtemp(folder)) {
        fprintf(stderr, "verify symmetry: no folder for results in /tmp\n");
        exit(1);
    }
    const double output_interval[2] = {usual.end, 2 * interval};
    for (int i = 0; i < 2; i++) {
        snprintf(path[i], sizeof path[i], "%s/%d.nc", folder, i);
        write_result(path[i], output_interval[i]);
    }
    static const char *const names[] = {"x", "sheet_strength", "wake_x", "wake_circulation", "energy_balance"};
    int n_different = 0;
    for (size_t v = 0; v < sizeof names / sizeof *names; v++) {
        size_t n[2];
        double *const row[2] = {last_row(path[0], names[v], &n[0]), last_row(path[1], names[v], &n[1])};
        n_different += n[0] != n[1] || memcmp(row[0], row[1], n[0] * sizeof(double)) != 0;
        free(row[0]);
        free(row[1]);
    }
    verify_zero("20 output intervals against 1: variables that differ",
                "the last row of x, sheet_strength, wake_x, wake_circulation, energy_balance: the same bits",
                n_different, 0);
    for (int i = 0; i < 2; i++) unlink(path[i]);
    rmdir(folder);
}

// final position of a fish with a companion to the left, or without (distance 0); rtol far below the effect
static struct simulation *run_pair(double apart) {
    char companion[128] = "";
    if (apart > 0) snprintf(companion, sizeof companion, "  - {name: other, start: {position: [0, %.17g]}}\n", apart);
    struct simulation *simulation =
        verify_open(VERIFY_ARTICLE
                    "format: 1\nname: pair\ntime: {end: %.17g, shedding_interval: %.17g, output_interval: %.17g}\n"
                    "solver: {rtol: 1e-10, order: 5}\nfish:\n  - {name: fish}\n%s",
                    usual.end, interval, usual.end, companion);
    verify_run(simulation, usual.end);
    return simulation;
}

// the total circulation of a fish is zero: the far velocity is the velocity of a dipole
static void check_far_apart(void) {
    const double apart[] = {4, 8, 16, 32, 1000};
    enum { N = sizeof apart / sizeof *apart };
    double moved[N];
    struct simulation *alone = run_pair(0);
    const struct fish *fish = &alone->school->fish[0];
    for (int i = 0; i < N; i++) {
        struct simulation *pair = run_pair(apart[i]);
        moved[i] = 0;
        for (int k = fish->at.x; k < fish->at.vx; k++) {
            moved[i] = largest(moved[i], fabs(pair->state->y[k] - alone->state->y[k]));
        }
        verify_point("symmetry_far", "change of position", apart[i], moved[i]);
    }
    verify_order("far apart: decay of the change with distance",
                 "no net circulation: a dipole's velocity, distance^-2; 16 against 32 lengths",
                 verify_order_of_errors(moved[2], moved[3]), 1.8, 2.2);
    verify_zero("1000 lengths apart against alone [m]", "dipole: 16 lengths scaled by (16/1000)^2 is 1e-9",
                moved[N - 1], 1e-9);
}

void verify_symmetry(void) {
    check_views();
    check_output_interval();
    check_far_apart();
}
