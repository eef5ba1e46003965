/* tandem.c: The section "tandem" has a heaving plate in the wake of another one. It compares the equilibrium positions
 * that `shoal steady` finds (doc/steady.md) with published positions and with the linear theory of thin foils. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "linear_theory.h"
#include "steady/steady_modes.h"
#include "steady/steady_search.h"
#include "verify.h"

static const double pi = 3.14159265358979323846;

/* Two plates in line that heave alike once a second. Friction is friction U^(3/2) of a plate of span 1 m. */
struct pair {
    double length, heave, mass, friction, speed; /* m, m, kg m-1 of span, kg m-1.5 s-0.5, m s-1: at the start */
    double smoothing, lifetime;                  /* of the wake, m, s */
    double gap;                                  /* from the tail of the first to the nose of the second, m */
    double lead;                                 /* by which the second one is ahead, of a beat */
};

static const struct pair light = {1, 0.15, 0.785, 0.0594, 3.8, 0.2, 10, 0, 0};
/* the plates that the program of Fang et al. starts with, in half lengths there */
static const struct pair of_fang = {2, 0.2, 2, 0.04, 13.25, 0.2, 10, 0, 0};

/* keys: further keys of the motion of both plates. The wake decays from 4 s on: the follower at position 3 meets
 * vortices of 3 beats at full strength. */
static void text_of(const struct pair *pair, int n_fish, const char *keys, size_t size, char *text) {
    const double thickness = 0.05, area = pi / 4 * thickness * pair->length * pair->length;
    const int length = snprintf(text, size,
                                "format: 1\ntime: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
                                "fluid: {density: 1, viscosity: %.17g}\nwake: {lifetime: %g, decay: 6, smoothing: %g}\n"
                                "steady: {formation: %s, tolerance: 1e-3}\n"
                                "defaults: {fish: {length: %g, nodes: 5, " VERIFY_ATTACHED
                                ", start: {speed: %.17g},\n  wave: {amplitude: 0, frequency: 0},\n"
                                "  body: {profile: uniform, thickness: %g, depth: 1, density: %.17g},\n"
                                "  motion: {prescribed: all, heave: %g, frequency: 1, %s}}}\nfish: [{}",
                                pow(pair->friction / 1.328, 2) / pair->length, pair->lifetime,
                                pair->smoothing / pair->length, n_fish > 1 ? "true" : "false", pair->length,
                                pair->speed, thickness, pair->mass / area, pair->heave, keys);
    if (n_fish > 1) {
        snprintf(text + length, size - (size_t)length, ", {start: {position: [%.17g, 0]}, motion: {phase: %.17g}}]\n",
                 pair->length + pair->gap, 360 * pair->lead);
    } else {
        snprintf(text + length, size - (size_t)length, "]\n");
    }
}

/* A steady state of one plate, or of two. */
struct found {
    double speed; /* of both, m s-1 */
    double place; /* from tail to nose, wavelengths: the distance travelled in a beat */
    int n_beats;
    double largest; /* multiplier */
    double growth;  /* of the distance of two followers in a beat */
    double wander;  /* remaining displacement 30 beats after a displacement of the follower by 0.1 m ahead, m */
};

static double wander(struct steady_problem *problem) {
    const struct steady_unknown ahead = {1, STEADY_AHEAD};
    const double place = problem->map.last[1].end_place[0], add = 0.1;
    verify_ok(steady_map_add(&problem->map, 1, &ahead, &add));
    for (int i = 0; i < 30; i++) verify_ok(steady_map_beat(&problem->map, NULL, NULL));
    return problem->map.last[1].end_place[0] - place;
}

// growth of the distance of two followers, on either side of the equilibrium, from the second beat to the third
static double growth(struct steady_problem *problem, const struct state *kept) {
    const struct steady_unknown ahead = {1, STEADY_AHEAD};
    double apart[2] = {0};
    for (int side = -1; side <= 1; side += 2) {
        const double add = side * 0.01;
        verify_ok(steady_map_return(problem->map.simulation, kept));
        verify_ok(steady_map_add(&problem->map, 1, &ahead, &add));
        for (int beat = 1; beat <= 3; beat++) {
            verify_ok(steady_map_beat(&problem->map, NULL, NULL));
            if (beat > 1) apart[beat - 2] += side * problem->map.last[1].end_place[0];
        }
    }
    return apart[1] / apart[0];
}

static struct found find(const struct pair *pair, int n_fish, bool is_stability_wanted) {
    struct verify_search search;
    struct found found = {.largest = NAN};
    struct steady_multipliers multipliers;
    char text[1024];
    text_of(pair, n_fish, "surge: free", sizeof text, text);
    verify_search_open(&search, text);
    struct steady_problem *const problem = &search.problem;
    verify_ok(steady_search_run(problem));
    found.speed = problem->map.last[0].speed;
    if (n_fish > 1) found.place = (-problem->map.last[1].place[0] - pair->length) / found.speed;
    found.n_beats = problem->map.n_beats;
    if (is_stability_wanted) {
        verify_ok(steady_multipliers_find(search.simulation->arena, problem, &multipliers));
        found.largest = hypot(multipliers.real[0], multipliers.imaginary[0]);
        struct state *kept = NULL;
        steady_map_save(search.simulation->arena, search.simulation, &kept);
        found.wander = wander(problem);
        found.growth = growth(problem, kept);
    }
    return found;
}

static struct linear_theory_places theory_of(const struct pair *pair, double speed) {
    return linear_theory_places(&(struct linear_theory_plate){pair->length, speed, 1, 2 * pi}, pair->smoothing);
}

// ---- in phase, from several starts

static const char integers[] = "near integers: Fang et al. 2026",
                  alone[] = "of one alone; a little faster: Heydari and Kanso 2021";

static double follow(int number, double gap, double speed_alone) {
    struct pair pair = light;
    pair.gap = gap;
    const struct found found = find(&pair, 2, 1);
    char from[64];
    snprintf(from, sizeof from, "follower from %g L behind", gap);
    verify_value(verify_text("%s: place, wavelengths", from), integers, number, found.place, 0.15);
    verify_zero(verify_text("%s: beats of the search", from), "a run needs 60", found.n_beats, 40);
    verify_relative(verify_text("%s: speed, m/s", from), alone, speed_alone, found.speed, 0.02);
    verify_zero(verify_text("%s: largest multiplier", from), "stable: below 1", found.largest, 1);
    verify_zero(verify_text("%s: put 0.1 L ahead, 30 beats on, L", from), "return to the equilibrium", found.wander,
                0.02);
    verify_point("tandem_starts", "search", gap / found.speed, found.place);
    verify_point("tandem_places", "in phase", number, found.place);
    return found.place;
}

static void in_phase(double speed_alone, double place[4]) {
    const double gaps[] = {3.5, 5, 7.3, 8, 11.9};
    const int numbers[] = {1, 1, 2, 2, 3};
    for (int i = 0; i < 5; i++) place[numbers[i]] = follow(numbers[i], gaps[i], speed_alone);
    for (int i = 1; i < 3; i++) {
        verify_value(verify_text("from place %d to place %d, wavelengths", i, i + 1),
                     "quantised on the wavelength: Nitsche et al. 2025", 1, place[i + 1] - place[i], 0.03);
    }
}

// ---- between two stable places

static void between(double speed) {
    struct pair pair = light;
    pair.heave /= 4;
    pair.friction /= 16;
    pair.mass /= 16;
    pair.gap = 1.6 * speed;
    const struct found found = find(&pair, 2, 1);
    verify_value("between places 1 and 2: place, wavelengths", "linear theory",
                 1 + theory_of(&pair, found.speed).unstable, found.place, 0.015);
    verify_zero("between places 1 and 2: 1 over the largest multiplier", "unstable: below 1", 1 / found.largest, 1);
    verify_point("tandem_places", "unstable", 1.5, found.place);
}

static void leave(int number, double gap) {
    struct pair pair = light;
    pair.gap = gap;
    const struct found found = find(&pair, 2, 1);
    char from[64];
    snprintf(from, sizeof from, "follower from %g L behind", gap);
    verify_value(verify_text("%s: place, wavelengths", from), "linear theory",
                 number + theory_of(&pair, found.speed).unstable, found.place, 0.1);
    verify_relative(verify_text("%s: multiplier", from), "growth in a beat of a run", found.growth, found.largest,
                    0.05);
    verify_point("tandem_places", "unstable", number + 0.5, found.place);
}

// ---- out of phase

// a whole beat of lead is one place nearer; the shift is the slope of the line of least squares
static void out_of_phase(double speed, double place, double wavelength) {
    enum { N = 4 };
    const double leads[N] = {0, 0.25, 0.5, 0.75};
    double product = 0, square = 0;
    for (int i = 0; i < N; i++) {
        struct pair pair = light;
        pair.lead = leads[i];
        pair.gap = (2 - leads[i]) * speed;
        const double found = i > 0 ? find(&pair, 2, 0).place : place;
        product += (leads[i] - 0.375) * found;
        square += (leads[i] - 0.375) * (leads[i] - 0.375);
        if (i == 0) continue;
        verify_value(verify_text("follower %g of a beat ahead: place, wavelengths", leads[i]),
                     "that part of the way from place 2 to place 1", place - leads[i] * wavelength, found, 0.008);
        verify_point("tandem_places", "follower ahead", 2 - leads[i], found);
    }
    verify_value("shift of the place, wavelengths over a beat of lead",
                 "linear: Heydari et al. 2024; Newbolt et al. 2019, Li et al. 2020", -1, product / square, 0.03);
}

// ---- other amplitudes

// friction for the same speed; mass for the same effect of the thrust on the speed
static void small_amplitudes(double speed) {
    enum { N = 3 };
    double difference[N];
    struct pair pair = light;
    for (int i = 0; i < N; i++) {
        const double part = pow(0.5, i);
        pair.heave = light.heave * part;
        pair.friction = light.friction * part * part;
        pair.mass = light.mass * part * part;
        pair.gap = 2 * speed;
        const struct found found = find(&pair, 2, 0);
        difference[i] = found.place - 2 - theory_of(&pair, found.speed).stable;
        verify_value(verify_text("heave %g L: place, wavelengths", pair.heave), "linear theory",
                     2 + theory_of(&pair, found.speed).stable, found.place, 0.06 * part);
        verify_point("tandem_places", "smaller amplitude", 2, found.place);
    }
    verify_order("order of the difference in the amplitude", "the wake goes with a speed of second order",
                 verify_order_of_values(difference[0], difference[1], difference[2]), 1.5, 2.5);
}

// ---- the plates of Fang et al.

static void published_plates(void) {
    const struct found lone = find(&of_fang, 1, 0);
    verify_relative("plates of Fang et al.: speed of one, half lengths a beat", "published program, a start value",
                    13.25, lone.speed, 0.003);
    for (int number = 1; number <= 2; number++) {
        struct pair pair = of_fang;
        pair.gap = 1.1 * number * pair.speed;
        const struct found found = find(&pair, 2, 0);
        verify_value(verify_text("plates of Fang et al.: place %d, wavelengths", number), "linear theory",
                     number + theory_of(&pair, found.speed).stable, found.place, 0.015);
        verify_relative(verify_text("plates of Fang et al., place %d: speed, m/s", number), alone, lone.speed,
                        found.speed, 0.01);
        verify_point("tandem_places", "plates of Fang et al.", number, found.place);
    }
}

// ---- a held follower: direction of the force

// mean thrusts of both over the last of some beats, without friction
static double thrust_over_leaders(const struct pair *pair) {
    enum { BEATS = 9, EVENTS = 50 };
    char text[1024];
    double thrust[2] = {0};
    text_of(pair, 2, "surge: given", sizeof text, text);
    struct simulation *const simulation = verify_open("%s", text);
    verify_run(simulation, BEATS - 1);
    for (int n = 1; n <= EVENTS; n++) {
        verify_run(simulation, BEATS - 1 + (double)n / EVENTS);
        simulate_measure(simulation);
        for (int f = 0; f < 2; f++) thrust[f] -= simulation->diagnostics->fish[f].pressure.suction[0];
    }
    return thrust[1] / thrust[0];
}

static void held(double speed) {
    enum { N = 9 };
    struct pair pair = light;
    const struct linear_theory_plate plate = {pair.length, speed, 1, 2 * pi};
    pair.speed = speed;
    pair.lifetime = 20;
    for (int i = 0; i < N; i++) {
        const double place = 1.5 + (double)i / (N - 1);
        pair.gap = place * speed;
        pair.heave = light.heave / 32;
        const double thrust = thrust_over_leaders(&pair);
        verify_value(verify_text("held %g wavelengths behind: thrust over the leader's", place), "linear theory",
                     linear_theory_follower_thrust(&plate, pair.smoothing, pair.gap, 0), thrust, 0.014);
        verify_point("tandem_thrust", verify_text("heave %.2g L", pair.heave), place, thrust);
        pair.heave = light.heave;
        verify_point("tandem_thrust", verify_text("heave %.2g L", pair.heave), place, thrust_over_leaders(&pair));
    }
    for (int i = 0; i <= 100; i++) {
        const double place = 1.5 + i / 100.0;
        verify_point("tandem_thrust", "exact: linear theory", place,
                     linear_theory_follower_thrust(&plate, pair.smoothing, place * speed, 0));
    }
}

void verify_tandem(void) {
    if (verify_is_fast()) return;
    double place[4];
    const struct found lone = find(&light, 1, 0);
    verify_show("plate alone: speed, m/s", "of shoal steady", lone.speed);
    in_phase(lone.speed, place);
    between(lone.speed);
    leave(1, 5.4);
    leave(2, 9.3);
    out_of_phase(lone.speed, place[2], place[2] - place[1]);
    small_amplitudes(lone.speed);
    published_plates();
    held(lone.speed);
    const double first = theory_of(&light, lone.speed).stable;
    for (int n = 1; n <= 3; n += 2) {
        verify_point("tandem_places", "exact: linear theory", n, n + first);
        verify_point("tandem_places", "published: integers", n, n);
    }
}
