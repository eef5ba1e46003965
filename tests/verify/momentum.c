/* momentum.c: the section "momentum": the fluid receives the momentum of swimmers with force: pressure (doc/model.md,
 * sections 8 and 13). The bodies have explicit settings: 17 nodes, 33 sheet points, a pointed tail, full suction; no
 * friction and a wake without decay unless stated. */
#include <math.h>
#include <stdio.h>

#include "verify.h"

#define PLAIN                                                                                                         \
    "force: pressure, nodes: 17, drag: {skin: laminar}, pressure: {span: infinite, suction_limit: 0}, body: {depth: " \
    "%g, "                                                                                                            \
    "tail_thickness: 0, damping: curvature, relaxation_time: 0.001}"

/* A run: the fish, and the differences from the standard run. */
struct run {
    const char *fish;
    double end, interval, viscosity; /* s, s, m2 s-1 */
    int n_sheet, decays;             /* decays: a lifetime of 2 s, three quarters of it decaying */
    const char *fluid;               /* further keys of the fluid */
};

/* Results of a run: the largest balance over the largest term of the balance; at the end; over the largest momentum of
 * the bodies; the largest angular balance, and at the end, N m s; the mean rate of the balance from a beat on, N; the
 * balance at the end, and since the first beat. */
struct found {
    double part, part_at_end, of_momentum, angular, angular_at_end, force[2], balance[2], since_beat[2], size;
};

static struct simulation *open_run(const struct run *run) {
    return verify_open(
        "format: 1\ntime: {end: %.17g, shedding_interval: %.17g, output_interval: %.17g}\n"
        "solver: {rtol: 1.0e-6}\nfluid: {viscosity: %g%s}\nwake: {lifetime: %g, decay: %g}\n"
        "defaults: {fish: {sheet_points: %d, body: {thickness: 0.2, depth: 0.25, modulus: 1e6}}}\n"
        "fish: [%s]\n",
        run->end, run->interval, run->interval, run->viscosity, run->fluid ? run->fluid : "",
        run->decays ? 2.0 : 1000.0, run->decays ? 1.5 : 100.0, run->n_sheet, run->fish);
}

static double momentum_of(const struct simulation *simulation) {
    const struct school *const school = simulation->school;
    double sum = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const double *const v = simulation->diagnostics->fish[f].com_velocity;
        sum += school->fish[f].total_mass * hypot(v[0], v[1]);
    }
    return sum;
}

static struct found find(const struct run *run) {
    struct simulation *const simulation = open_run(run);
    struct found found = {0};
    double largest = 0, momentum = 0, at_beat[2] = {0};
    for (int n = 1; n <= lround(run->end / run->interval); n++) {
        verify_run(simulation, n * run->interval);
        simulate_measure(simulation);
        const double *const imbalance = simulation->diagnostics->momentum_balance;
        largest = fmax(largest, hypot(imbalance[0], imbalance[1]));
        found.angular = fmax(found.angular, fabs(imbalance[2]));
        found.angular_at_end = fabs(imbalance[2]);
        found.size = fmax(found.size, simulation->diagnostics->momentum_size);
        momentum = fmax(momentum, momentum_of(simulation));
        for (int i = 0; i < 2; i++) {
            if (n == lround(1 / run->interval)) at_beat[i] = imbalance[i];
            found.balance[i] = imbalance[i];
            found.since_beat[i] = imbalance[i] - at_beat[i];
            found.force[i] = found.since_beat[i] / (run->end - 1);
        }
    }
    found.part = largest / found.size;
    found.part_at_end = hypot(found.balance[0], found.balance[1]) / found.size;
    found.of_momentum = largest / momentum;
    return found;
}

#define REST "{" PLAIN ", start: {speed: 0}}"
#define MOVES "{" PLAIN ", start: {speed: 0.5}}"
#define FOLLOWS MOVES ", {" PLAIN ", start: {speed: 0.5, position: [%g, 0]}}"

static const char conservation[] = "0 (conservation)";

// a text of a fish, or of two
static const char *fish(const char *format, double a, double b, double c) {
    static char text[1024];
    snprintf(text, sizeof text, format, a, b, c);
    return text;
}

static void nothing_comes_from_outside(void) {
    const struct run start = {fish(REST, 1, 0, 0), 6, 0.01, 0, 33, 0, NULL};
    const struct found rest = find(&start);
    verify_zero("one fish from rest, 6 s: momentum lost, of the largest", conservation, rest.of_momentum, 2.5e-3);
    verify_zero("one fish from rest, 6 s: at the end", conservation, rest.part_at_end, 2e-3);
    verify_zero("one fish from rest, 6 s: angular, at the end, N m s", conservation, rest.angular_at_end, 0.06);
    const struct run turning = {
        fish("{" PLAIN ", start: {speed: 0}, control: {bias: 0.4}}", 1, 0, 0), 6, 0.01, 0, 33, 0, NULL};
    verify_zero("one that turns, bias 0.4: momentum lost", conservation, find(&turning).of_momentum, 2.5e-3);
    const struct run pair = {fish(FOLLOWS, 1, 1, 1.3), 5, 0.01, 0, 33, 0, NULL};
    const struct found tandem = find(&pair);
    verify_zero("tandem, gap 0.3 L, 5 s: momentum lost, of the largest", conservation, tandem.of_momentum, 1.2e-3);
    verify_zero("tandem: angular, N m s", conservation, tandem.angular, 0.06);
    for (int i = 0; i < 2; i++) {
        verify_zero(verify_text("tandem: mean force that has no reaction, %c, N", "xy"[i]), "0 (Newton's third law)",
                    tandem.force[i], 0.1);
    }
    // the same depth, so that both push the same water
    const struct run long_first = {
        fish(MOVES ", {" PLAIN ", length: 0.5, start: {speed: 0.5, position: [%g, 0]}}", 1, 2, 1.3),
        4,
        0.01,
        0,
        33,
        0,
        NULL};
    verify_zero("length 1 leads 0.5: momentum lost, of the largest", conservation, find(&long_first).of_momentum,
                1.2e-3);
    const struct run short_first = {
        fish("{" PLAIN ", length: 0.5, start: {speed: 0.5}}, {" PLAIN ", start: {speed: 0.5, position: [%g, 0]}}", 2, 1,
             0.8),
        4,
        0.01,
        0,
        33,
        0,
        NULL};
    verify_zero("length 0.5 leads 1: momentum lost, of the largest", conservation, find(&short_first).of_momentum,
                1.2e-3);
    const struct run beside = {
        fish(REST ", {" PLAIN ", start: {position: [0, %g]}}", 1, 1, 0.35), 4, 0.01, 0, 33, 0, NULL};
    verify_zero("side by side, 0.35 L, from rest: momentum lost", conservation, find(&beside).of_momentum, 4e-3);
}

// M - 1 grows like 1/sqrt(U Dt/L), as required by the sheet; at one interval more points must not increase the error
static void refined(void) {
    const struct {
        double interval;
        int n_sheet;
    } both[3] = {{0.01, 33}, {0.005, 47}, {0.0025, 65}};
    double error[3];
    for (int i = 0; i < 3; i++) {
        const struct run run = {fish(REST, 1, 0, 0), 6, both[i].interval, 0, both[i].n_sheet, 0, NULL};
        error[i] = find(&run).part_at_end;
        verify_point("momentum_interval", "from rest, 6 s", both[i].interval, error[i]);
    }
    verify_order("momentum lost in the interval, sheet points refined with the interval", "0.01 s, 33 to 0.0025 s, 65",
                 verify_order_of_errors(error[0], error[2]) / 2, 0.7, 2);
    double least = INFINITY, most = 0;
    for (int i = 0; i < 3; i++) {
        const struct run run = {fish(REST, 1, 0, 0), 6, 0.01, 0, (32 << i) + 1, 0, NULL};
        const double lost = find(&run).of_momentum;
        least = fmin(least, lost);
        most = fmax(most, lost);
        verify_show(verify_text("one fish from rest, %d sheet points: momentum lost", (32 << i) + 1), conservation,
                    lost);
    }
    verify_value("33, 65, 129 sheet points: largest over smallest", "1, within a factor of 3", 1, most / least, 2);
}

#define PLATE(phase)                                                                                              \
    "{force: pressure, nodes: 17, wave: {amplitude: 0, frequency: 0}, start: {speed: 1}, drag: {skin: laminar}, " \
    "pressure: {span: infinite, suction_limit: 0}, body: {profile: uniform, thickness: 0.05, depth: 1}, "         \
    "motion: {prescribed: all, heave: 0.1, frequency: 1, phase: " phase "}}"

static void balances(void) {
    const struct run one = {fish(MOVES, 1, 0, 0), 6, 0.01, 1e-6, 33, 1, NULL};
    const struct found of_one = find(&one);
    verify_zero("friction and decay, one fish: balance over its largest term", conservation, of_one.part, 1e-3);
    verify_zero("friction and decay, one fish: angular, N m s", conservation, of_one.angular, 0.06);
    const struct run pair = {fish(FOLLOWS, 1, 1, 1.3), 5, 0.01, 1e-6, 33, 1, NULL};
    verify_zero("friction and decay, tandem: balance over its largest term", conservation, find(&pair).part, 1e-3);
    const struct run plate = {PLATE("90"), 5, 0.01, 1e-6, 33, 1, NULL};
    verify_zero("friction and decay, plate held in heave: balance over its largest term", conservation,
                find(&plate).part, 1e-3);
    const struct run sudden = {PLATE("0"), 5, 0.01, 1e-6, 33, 1, NULL};
    const struct found jump = find(&sudden);
    verify_zero("plate that starts at once: balance since the first beat, over its largest term", conservation,
                hypot(jump.since_beat[0], jump.since_beat[1]) / jump.size, 1e-3);
    verify_show("plate that starts at once: balance at the end, over its largest term", conservation, jump.part_at_end);
    const struct run wall = {fish(MOVES, 1, 0, 0), 4, 0.01, 1e-6, 33, 1, ", walls: [-0.3]"};
    verify_zero("beside a wall, 0.3 L: balance over its largest term", conservation, find(&wall).part, 1e-3);
    const struct run shear = {
        fish(MOVES, 1, 0, 0), 4, 0.01, 1e-6, 33, 1, ", shear: 0.2, gust: {amplitude: 0.1, frequency: 1}"};
    verify_zero("in shear and gusts: balance over its largest term", conservation, find(&shear).part, 1e-3);
}

// the same swimming motion over ground: heading 180 degrees against the stream
static void stream(void) {
    const struct run still = {fish(MOVES, 1, 0, 0), 3, 0.01, 1e-6, 33, 1, NULL};
    const struct found a = find(&still);
    const struct run moving = {
        fish("{" PLAIN ", start: {speed: -0.4}}", 1, 0, 0), 3, 0.01, 1e-6, 33, 1, ", velocity: [0.9, 0]"};
    const struct found b = find(&moving);
    verify_zero("one fish from 0.5 m/s, 3 s: balance over its largest term", conservation, a.part, 8e-4);
    verify_zero("the same in a stream of 0.9 m/s: difference of the balance, N s", "0 (Galileo)",
                hypot(b.balance[0] - a.balance[0], b.balance[1] - a.balance[1]), 1e-3);
}

void verify_momentum(void) {
    if (verify_is_fast()) {
        const struct run run = {fish(MOVES, 1, 0, 0), 0.5, 0.01, 0, 33, 0, NULL};
        verify_zero("one fish from 0.5 m/s, 0.5 s: momentum lost, of the largest", conservation, find(&run).of_momentum,
                    8e-4);
        return;
    }
    stream();
    const struct run run = {fish(MOVES, 1, 0, 0), 3, 0.01, 0, 33, 0, NULL};
    verify_zero("one fish from 0.5 m/s, 3 s: momentum lost, of the largest", conservation, find(&run).of_momentum,
                8e-4);
    nothing_comes_from_outside();
    balances();
    refined();
}
