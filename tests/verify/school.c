/* school.c: The whole coupled school, compared with itself: order in the shedding interval, in the nodes of the body
 * and in the points of the sheet, error against tolerance, and the implicit solution against an explicit one. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "run/simulate.h"
#include "verify.h"

// final state of a run, for comparisons between two runs: positions in m, circulation in m2/s, fish after fish
enum quantity { NOSE, TAIL, CENTRE, SHED, SHEET, N_QUANTITIES };
static const char *const quantity_name[N_QUANTITIES] = {"nose", "tail", "centre of mass", "shed circulation",
                                                        "free sheet"};
enum { MOST_VALUES = 8, MOST_RUNS = 12 };
struct ends {
    int n[N_QUANTITIES];
    double value[N_QUANTITIES][MOST_VALUES];
};

static const double end_time = 1.2;  // s; every shedding interval used here divides it
static const double label = 0.6;     // s; the piece of free sheet that is followed was shed at this time

static void add(struct ends *ends, enum quantity quantity, double value) {
    ends->value[quantity][ends->n[quantity]++] = value;
}

static double difference(const struct ends *a, const struct ends *b, enum quantity quantity) {
    double sum = 0;
    for (int i = 0; i < a->n[quantity]; i++) {
        const double change = a->value[quantity][i] - b->value[quantity][i];
        sum += change * change;
    }
    return sqrt(sum);
}

// Position of the piece of sheet shed at time shed_at: cubic in the label. A vortex represents the circulation shed
// between two events, so the label is half an interval before the release (doc/model.md, section 8).
static void add_place_in_sheet(struct ends *ends, const struct simulation *simulation, int f, double shed_at) {
    const struct wake *wake = &simulation->state->wake[f];
    const double interval = simulation->school->interval;
    const double place = (shed_at - (wake->birth[0] - interval / 2)) / interval;
    const int first = (int)fmax(0, fmin(floor(place) - 1, wake->n_vortex - 4));
    double x = 0, y = 0;
    for (int a = 0; a < 4; a++) {
        double weight = 1;
        for (int b = 0; b < 4; b++) {
            if (b != a) weight *= (place - first - b) / (a - b);
        }
        x += weight * wake->x[first + a];
        y += weight * wake->y[first + a];
    }
    add(ends, SHEET, x);
    add(ends, SHEET, y);
}

static struct ends ends_of(const struct simulation *simulation, double shed_at) {
    struct ends ends = {0};
    const double *const y = simulation->state->y;
    for (int f = 0; f < simulation->school->n_fish; f++) {
        const struct fish *fish = &simulation->school->fish[f];
        const int slices[2] = {fish->at.x, fish->at.y};
        for (int i = 0; i < 2; i++) {
            double centre = 0;
            for (int k = 0; k < fish->n_nodes; k++) centre += fish->mass[k] * y[slices[i] + k] / fish->total_mass;
            add(&ends, NOSE, y[slices[i]]);
            add(&ends, TAIL, y[slices[i] + fish->n_nodes - 1]);
            add(&ends, CENTRE, centre);
        }
        add(&ends, SHED, y[fish->at.circulation]);
        add_place_in_sheet(&ends, simulation, f, shed_at);
    }
    return ends;
}

// how a run differs from the usual one
struct variant {
    double interval;     // between two events, s
    const char *sheets;  // lines of the keys wake and sheet
    double rtol;
    int order;
    double softness;      // divides the modulus of every fish
    double end, shed_at;  // s; time of the comparison, and the label of the sheet
};

static const struct variant usual = {.interval = 0.02,
                                     .sheets = "wake: {lifetime: 4}\n",
                                     .rtol = 1e-10,
                                     .order = 5,
                                     .softness = 1,
                                     .end = end_time,
                                     .shed_at = label};

// Three different fish near each other, steering by different control laws. The muscles start smoothly.
static struct simulation *open_school(const struct variant *variant) {
    return verify_open(VERIFY_ARTICLE
                       "format: 1\nname: school\ntime: {end: %.17g, shedding_interval: %.17g, output_interval: %.17g}\n"
                       "%ssolver: {rtol: %.17g, order: %d}\ndefaults: {fish: {control: {law: heading}}}\nfish:\n"
                       "  - {name: leader, body: {modulus: %.17g}}\n"
                       "  - {name: side, nodes: 5, sheet_points: 13, length: 0.8, body: {modulus: %.17g},\n"
                       "     wave: {frequency: 1.25, phase: 90}, control: {desired_heading: 185},\n"
                       "     start: {position: [0.3, 0.5], heading: 170, speed: 0.9}}\n"
                       "  - {name: behind, length: 0.9, sheet_points: 17, body: {modulus: %.17g}, wave: {phase: 200},\n"
                       "     start: {position: [1.3, 0.15]}}\n",
                       variant->end, variant->interval, variant->end, variant->sheets, variant->rtol, variant->order,
                       1e6 / variant->softness, 3e5 / variant->softness, 2e6 / variant->softness);
}

static struct ends run_school(const struct variant *variant) {
    struct simulation *simulation = open_school(variant);
    verify_run(simulation, variant->end);
    return ends_of(simulation, variant->shed_at);
}

// one fish of the usual kind, with further keys of the fish
static struct ends run_fish(double rtol, int order, const char *sheets, const char *keys) {
    struct simulation *simulation =
        verify_open(VERIFY_ARTICLE
                    "format: 1\nname: fish\ntime: {end: %.17g, shedding_interval: 0.02, output_interval: %.17g}\n"
                    "wake: {lifetime: 4}\n%ssolver: {rtol: %.17g, order: %d}\nfish:\n  - {name: fish%s}\n",
                    end_time, end_time, sheets, rtol, order, keys);
    verify_run(simulation, end_time);
    return ends_of(simulation, label);
}

// the order from the last three of n runs, each refined by a factor of two
static double order_at_end(const struct ends *runs, int n, enum quantity quantity) {
    return log2(difference(&runs[n - 3], &runs[n - 2], quantity) / difference(&runs[n - 2], &runs[n - 1], quantity));
}

// the change of every run against the next finer run; x is the size of the refined quantity
static void draw_changes(const char *figure, const char *series, int n, const double *x, const struct ends *runs,
                         enum quantity quantity) {
    for (int i = 0; i + 1 < n; i++) verify_point(figure, series, x[i], difference(&runs[i], &runs[i + 1], quantity));
}

// ---- the shedding interval ----

// runs with intervals halved down to the finest one, and the order of every quantity at the end
static void halve_interval(const char *what, const char *source, const char *figure, const struct variant *variant,
                           int n, double finest, double least, double most) {
    struct ends runs[MOST_RUNS];
    double interval[MOST_RUNS];
    for (int i = 0; i < n; i++) {
        struct variant refined = *variant;
        refined.interval = interval[i] = ldexp(finest, n - 1 - i);
        runs[i] = run_school(&refined);
    }
    const enum quantity shown[] = {NOSE, TAIL, SHED, SHEET};
    for (size_t i = 0; i < sizeof shown / sizeof *shown; i++) {
        char quantity[80];
        snprintf(quantity, sizeof quantity, "order in Dt, %s: %s", what, quantity_name[shown[i]]);
        verify_order(quantity, source, order_at_end(runs, n, shown[i]), least, most);
        draw_changes(figure, quantity_name[shown[i]], n, interval, runs, shown[i]);
    }
}

static void check_interval(void) {
    const int fast = verify_is_fast();
    const char *const second = "doc/model.md 7, 8: every part of the scheme is of second order";
    struct variant continuous = usual;
    if (fast) continuous.rtol = 1e-9;
    halve_interval("continuous", second, "school_interval", &continuous, fast ? 3 : 6, fast ? 0.005 : 0.0025, 1.8, 2.2);

    // an impulse represents the circulation of the following interval, and appears at the start of the interval
    struct variant impulsive = usual;
    impulsive.rtol = 1e-8;
    impulsive.sheets = "wake: {lifetime: 4, shedding: impulsive}\n";
    halve_interval("impulsive", "an impulse is shed half an interval off: first order", "school_interval_impulsive",
                   &impulsive, fast ? 3 : 5, fast ? 0.005 : 0.0025, 0.9, 1.1);
    if (fast) return;

    // the errors are small and change sign near Dt = 0.01: the order shows only below
    struct variant rate = usual;
    rate.sheets = "wake: {lifetime: 4}\nsheet: {kutta: rate}\n";
    halve_interval("kutta rate", "as above; errors change sign near Dt = 0.01, so that finer steps are taken",
                   "school_interval_rate", &rate, 5, 0.000625, 1.8, 2.2);
    impulsive.sheets = "wake: {lifetime: 4, shedding: impulsive}\nsheet: {kutta: rate}\n";
    halve_interval("impulsive rate", "as for impulsive", "school_interval_impulsive_rate", &impulsive, 5, 0.0025, 0.9,
                   1.1);

    // vortices that fade out and are removed during the run
    static const char decays[] = "the strength of a vortex is the circulation shed half an interval before the release";
    struct variant decaying = usual;
    decaying.sheets = "wake: {lifetime: 0.64, decay: 0.32}\n";
    decaying.end = 1.28;
    decaying.shed_at = 1;
    halve_interval("decaying wake", decays, "school_interval_fading", &decaying, 5, 0.0025, 1.8, 2.2);
}

// ---- the body ----

// integral from the nose to s of the half thickness of the Joukowski profile (thickness 0.2, length 1), by the midpoint
// rule in the angle theta of doc/model.md section 1, in which the integrand is smooth
static double profile_integral(double s) {
    const double d = 0.2, r0 = (1 - d) / 4, c = r0 * (1 + d), nose = 2 * r0 * (1 + d * d) / (d - 1);
    const int n = 20000;
    const double step = M_PI / n;
    double sum = 0, x_before = 0;
    for (int i = 0; i <= n; i++) {
        const double theta = M_PI - i * step, middle = theta + step / 2;
        const double re = r0 * (cos(theta) + d), im = r0 * sin(theta);
        const double x = re * (1 + c * c / (re * re + im * im)) - nose;
        if (i > 0) {
            const double re_middle = r0 * (cos(middle) + d), im_middle = r0 * sin(middle);
            const double r = im_middle * (1 - c * c / (re_middle * re_middle + im_middle * im_middle));
            const double part = x > s ? (s - x_before) / (x - x_before) : 1;
            sum += part * fabs(r) * (x - x_before);
            if (x >= s) break;
        }
        x_before = x;
    }
    return sum;
}

// keys of a body with the mean thickness of the profile over each edge, so that the mass does not depend on N
static void mean_heights(int n_nodes, char *keys, size_t size) {
    int used = snprintf(keys, size, ", nodes: %d, body: {profile: table, thickness_table: [", n_nodes);
    double before = 0;
    for (int k = 1; k < n_nodes; k++) {
        const double now = profile_integral((double)k / (n_nodes - 1));
        used += snprintf(keys + used, size - (size_t)used, "%s%.15g", k > 1 ? ", " : "",
                         2 * (now - before) * (n_nodes - 1));
        before = now;
    }
    used += snprintf(keys + used, size - (size_t)used, "], depth_table: [0.25");
    for (int k = 2; k < n_nodes; k++) used += snprintf(keys + used, size - (size_t)used, ", 0.25");
    snprintf(keys + used, size - (size_t)used, "]}");
}

struct body {
    const char *name, *keys; /* keys NULL: mean heights */
    struct {
        enum quantity quantity;
        double least, most; /* most 0: a number without a bound */
        const char *source;
    } check[3];
};

static const char blunt[] = "h = r(s_k) + r(s_k+1) is the trapezoidal rule: 3/2 where r rises like the root of s";
static const char unsettled[] =
    "no bound: not asymptotic; N = 129 gives 1.3 (uniform), and at t = 0.4 s the order is 3.3, then -0.1, whatever "
    "rtol";
static const char smooth_body[] = "smooth in s: second order";
static const char mean[] = "h the mean of 2 r(s) over each edge: the mass does not depend on N, second order";
static const char rest[] = "as above; the rest, of unknown cause, is 17 times smaller than with h = r(s_k) + r(s_k+1)";
static const struct body bodies[] = {
    {"joukowski", "", {{NOSE, 1.3, 1.7, blunt}, {CENTRE, 1.3, 1.7, blunt}, {TAIL, 1.6, 2.2, smooth_body}}},
    {"uniform",
     ", body: {profile: uniform, thickness: 0.1}",
     {{NOSE, 1.8, 2.2, smooth_body}, {TAIL, 1.8, 2.2, smooth_body}, {SHED, 0, 0, unsettled}}},
    {"joukowski, mean height", NULL, {{NOSE, 1.2, 2.2, rest}, {TAIL, 1.8, 2.2, mean}, {SHED, 0, 0, unsettled}}},
};

static void check_nodes(void) {
    enum { N_RUNS = 4 };
    const int n_nodes[N_RUNS] = {9, 17, 33, 65};
    for (size_t b = 0; b < sizeof bodies / sizeof *bodies; b++) {
        struct ends runs[N_RUNS];
        double edge_length[N_RUNS];
        for (int i = 0; i < N_RUNS; i++) {
            char keys[8192];
            if (bodies[b].keys) {
                snprintf(keys, sizeof keys, ", nodes: %d%s", n_nodes[i], bodies[b].keys);
            } else {
                mean_heights(n_nodes[i], keys, sizeof keys);
            }
            edge_length[i] = 1.0 / (n_nodes[i] - 1);
            runs[i] = run_fish(1e-7, 5, "", keys);
        }
        for (int i = 0; i < 3; i++) {
            const enum quantity quantity = bodies[b].check[i].quantity;
            char what[80];
            snprintf(what, sizeof what, "order in N, %s: %s", bodies[b].name, quantity_name[quantity]);
            const double order = order_at_end(runs, N_RUNS, quantity);
            if (bodies[b].check[i].most > 0) {
                verify_order(what, bodies[b].check[i].source, order, bodies[b].check[i].least, bodies[b].check[i].most);
            } else {
                verify_show(what, bodies[b].check[i].source, order);
            }
            char series[80];
            snprintf(series, sizeof series, "%s: %s", bodies[b].name, quantity_name[quantity]);
            draw_changes("school_nodes", series, N_RUNS, edge_length, runs, quantity);
        }
    }
}

// ---- the points of the sheet ----

// the changes of shed circulation under refinement of the sheet, as points of the figure; returns how many
static int refine_sheet(const char *series, const char *sheets, const char *keys, int n_runs, double *spacing,
                        double *change) {
    struct ends runs[MOST_RUNS];
    for (int i = 0; i < n_runs; i++) {
        char all[512];
        const int n_spaces = 8 << i;
        snprintf(all, sizeof all, ", sheet_points: %d%s", n_spaces + 1, keys);
        runs[i] = run_fish(1e-9, 5, sheets, all);
        spacing[i] = 1.0 / n_spaces;
    }
    for (int i = 0; i + 1 < n_runs; i++) {
        change[i] = difference(&runs[i], &runs[i + 1], SHED);
        verify_point("school_points", series, 1 / spacing[i] + 1, change[i]);
    }
    return n_runs - 1;
}

static void check_sheet_points(void) {
    const int fast = verify_is_fast();
    double spacing[MOST_RUNS], change[MOST_RUNS];
    int n =
        refine_sheet("straight plate", "",
                     ", motion: {prescribed: all, heave: 0.05, pitch: 5, pitch_phase: 90, frequency: 1, pivot: 0.25}",
                     4, spacing, change);
    verify_zero("straight plate: shed circulation, M = 33 against 65",
                "spectral: down to where Newton's iteration stops, 0.01 rtol = 1e-11; M = 9 is off by 1e-6",
                change[n - 1], 1e-10);
    if (fast) return;
    n = refine_sheet("default fish", "", "", 5, spacing, change);
    verify_order("order in M, default fish: shed circulation",
                 "5 kinks (N = 7) end spectral convergence: the flow at a kink is logarithmic",
                 verify_slope(n, spacing, change), 1.7, 2.3);
    verify_show("default fish: shed circulation, M = 33 against 65", "in m2/s, of about 0.5; see the figure",
                change[2]);
    n = refine_sheet("default fish, midpoint", "sheet: {collocation: midpoint}\n", "", 5, spacing, change);
    verify_order("order in M, midpoint collocation: shed circulation", "first order: doc/model.md 7, section sheet",
                 verify_slope(n, spacing, change), 0.7, 1.3);
}

// ---- the tolerance ----

static void check_tolerance(void) {
    enum { N_RTOL = 9 };
    struct variant variant = usual;
    variant.rtol = 1e-13;
    const struct ends exact = run_school(&variant);
    const struct {
        int order;
        double coarsest, least, most;
        const char *source;
    } cases[] = {
        {2, 1e-4, 2.0 / 3 - 0.1, 2.0 / 3 + 0.1,
         "not the 1 of issue 3: BDF of order p holds a step's error h^(p+1) at rtol, the global one is rtol^(p/(p+1)): "
         "2/3"},
        {5, 1e-5, 2.0 / 3 - 0.1, 1.3,
         "as above: 5/6; issue 3: 1 within 0.3, which the nose misses: with equal steps its error at 1e-5 fell by a "
         "factor of 12, at 1e-9 by 2; 1e-5 to 1e-9, chosen after seeing that 1e-3 is not asymptotic"}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        double rtol[N_RTOL], error[N_QUANTITIES][N_RTOL];
        for (int i = 0; i < N_RTOL; i++) {
            variant.order = cases[c].order;
            variant.rtol = rtol[i] = cases[c].coarsest * pow(10, -0.5 * i);
            const struct ends got = run_school(&variant);
            for (int q = 0; q < N_QUANTITIES; q++) error[q][i] = difference(&got, &exact, (enum quantity)q);
        }
        const enum quantity shown[] = {NOSE, TAIL, SHED, SHEET};
        for (size_t i = 0; i < sizeof shown / sizeof *shown; i++) {
            char what[80], series[80];
            snprintf(what, sizeof what, "slope over rtol, order %d: %s", cases[c].order, quantity_name[shown[i]]);
            verify_order(what, cases[c].source, verify_slope(N_RTOL, rtol, error[shown[i]]), cases[c].least,
                         cases[c].most);
            snprintf(series, sizeof series, "order %d: %s", cases[c].order, quantity_name[shown[i]]);
            for (int k = 0; k < N_RTOL; k++) verify_point("school_tolerance", series, rtol[k], error[shown[i]][k]);
        }
    }
}

// ---- the implicit solution against an explicit one ----

// One step h of the classical Runge-Kutta method on the ODE that is left of the DAE when the algebraic equations are
// solved at every stage (doc/model.md, section 10). kind is 1 where an unknown is differential. Returns a status.
static enum status runge_kutta_step(struct simulation *simulation, const double *kind, double t, double h,
                                    double *scratch) {
    static const double node[4] = {0, 0.5, 0.5, 1}, weight[4] = {1 / 6.0, 1 / 3.0, 1 / 3.0, 1 / 6.0};
    const int n = simulation->school->n_unknowns;
    double *const y = simulation->state->y, *const stage = scratch, *const rate = scratch + n, *const sum = rate + n;
    memcpy(stage, y, (size_t)n * sizeof *y);
    memset(sum, 0, (size_t)n * sizeof *sum);
    for (int s = 0; s < 4; s++) {
        for (int i = 0; s > 0 && i < n; i++) {
            if (kind[i] > 0) stage[i] = y[i] + node[s] * h * rate[i];
        }
        TRY(initial_conditions_solve(simulation->consistent, &residual_run, t + node[s] * h, stage, rate));
        for (int i = 0; i < n; i++) sum[i] += weight[s] * rate[i];
    }
    for (int i = 0; i < n; i++) y[i] = kind[i] > 0 ? y[i] + h * sum[i] : stage[i];
    return initial_conditions_solve(simulation->consistent, &residual_run, t + h, y, simulation->state->yp);
}

static enum status runge_kutta_run(struct simulation *simulation, double end, int steps_per_event) {
    const size_t n = (size_t)simulation->school->n_unknowns;
    const double interval = simulation->school->interval, h = interval / steps_per_event;
    double *const scratch = calloc(4 * n, sizeof *scratch);
    if (!scratch) return status_fail(STATUS_MEMORY, "out of memory: the stages of %zu unknowns", n);
    enum status status = STATUS_OK;
    residual_kinds(simulation->residual, &residual_run, scratch + 3 * n);
    while (status == STATUS_OK && simulation->state->t < end - interval / 2) {
        const double t = simulation->state->t;
        for (int i = 0; i < steps_per_event && status == STATUS_OK; i++) {
            status = runge_kutta_step(simulation, scratch + 3 * n, t + i * h, h, scratch);
        }
        if (status == STATUS_OK) {
            status = simulate_event(simulation);
        }
    }
    free(scratch);
    return status;
}

static struct ends run_explicit(const struct variant *variant, int steps_per_event) {
    struct simulation *simulation = open_school(variant);
    if (runge_kutta_run(simulation, variant->end, steps_per_event) != STATUS_OK) {
        fprintf(stderr, "verify school: the explicit method failed: %s\n", status_message());
        exit(1);
    }
    return ends_of(simulation, variant->shed_at);
}

static void check_explicit(void) {
    const int fast = verify_is_fast();
    static const char *const kutta[] = {"edge", "rate"};
    for (int k = 0; k < (fast ? 1 : 2); k++) {
        // bodies that are soft enough for an explicit method
        char sheets[64];
        snprintf(sheets, sizeof sheets, "wake: {lifetime: 4}\nsheet: {kutta: %s}\n", kutta[k]);
        struct variant soft = usual;
        soft.sheets = sheets;
        soft.softness = 100;
        soft.rtol = 1e-12;
        if (fast) soft.end = 0.4;
        if (fast) soft.shed_at = 0.2;
        const struct ends want = run_explicit(&soft, fast ? 5 : 20);
        const struct ends got = run_school(&soft);
        const enum quantity shown[] = {NOSE, TAIL, SHED, SHEET};
        for (size_t i = 0; i < sizeof shown / sizeof *shown; i++) {
            char what[80];
            snprintf(what, sizeof what, "IDA against RK4, kutta %s: %s", kutta[k], quantity_name[shown[i]]);
            verify_zero(what, "own RK4 with KINSOL at each stage; soft school, rtol 1e-12, order 5; m or m2/s",
                        difference(&want, &got, shown[i]), shown[i] == SHED ? 1e-8 : 1e-9);
        }
    }
}

void verify_school(void) {
    check_interval();
    if (!verify_is_fast()) check_nodes();
    check_sheet_points();
    if (!verify_is_fast()) check_tolerance();
    check_explicit();
}
