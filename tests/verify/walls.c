/* walls.c: The section "walls" compares bodies and wakes beside straight walls with thin-foil theory between two walls
 * and with the same bodies beside mirror images. Length L = 1 m. */
#include <math.h>

#include "force/bound_sheet.h"
#include "verify.h"

static const double pi = 3.14159265358979323846;

// ---- a plate between two walls

/* Circulation of a plate at small incidence half way between walls at the distance H, over that without walls: the
 * singular equation with the kernel 1/(2H sinh(pi r/H)) of the row of images, and the Kutta condition at the tail,
 * solved at 60 Gauss-Jacobi points to 1e-14. To the order (L/H)^2 the ratio is 1 + pi^2 (L/H)^2/24. */
static const struct {
    double ratio, circulation; /* L/H, 1 */
} channel[] = {{0.5, 1.0951764318283912}, {1, 1.3209183476231910}};

static double circulation_between(double distance) {
    const double degree = 0.5, angle = degree * pi / 180;
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: %.17g, shedding_interval: 0.04, output_interval: 0.04}\n"
        "fluid: {velocity: [1, 0], walls: [%.17g, %.17g]}\nwake: {lifetime: %.17g}\n"
        "fish: [{force: reactive, nodes: 4, wave: {amplitude: 0}, start: {heading: %.17g, position: [%.17g, %.17g]},\n"
        "        motion: {prescribed: all, speed: 0}}]\n",
        12 * distance, -distance / 2, distance / 2, 6 * distance, 180 - degree, -0.5 * cos(angle), 0.5 * sin(angle));
    // a vortex at the distance x acts like exp(-pi x/H); the circulation approaches the limit like exp(-0.7 U t/H)
    verify_run(simulation, 12 * distance);
    const double circulation = bound_sheet_circulation(&simulation->school->fish[0], simulation->state->y);
    return fabs(circulation) / (pi * sin(angle));
}

static void check_plate(void) {
    for (int i = 0; i < 2; i++) {
        const double ratio = channel[i].ratio;
        verify_relative(verify_text("plate between walls, L/H = %g: circulation over that without", ratio),
                        "thin foil, row of images", channel[i].circulation, circulation_between(1 / ratio), 2e-3);
    }
}

// ---- mirrored fish

static struct simulation *open_fish(const char *force, double rtol, const char *fluid, const char *other) {
    return verify_open(
        "format: 1\ntime: {end: 1, output_interval: 0.1}\nwake: {tolerance: 0}\nsolver: {rtol: %.17g}\n"
        "%sdefaults: {fish: {force: %s}}\nfish: [{start: {position: [0, 0.25]}}%s]\n",
        rtol, fluid, force, other);
}

// the largest difference of the places of nodes and of the wake of the first fish
static double difference(const struct simulation *a, const struct simulation *b) {
    const struct fish *const fish = &a->school->fish[0];
    double worst = 0;
    for (int i = 0; i < 2 * fish->n_nodes; i++) {
        worst = fmax(worst, fabs(a->state->y[fish->at.x + i] - b->state->y[fish->at.x + i]));
    }
    const struct wake *const wake = &a->state->wake[0], *const other = &b->state->wake[0];
    for (int i = 0; i < wake->n_vortex; i++) {
        worst = fmax(worst, hypot(wake->x[i] - other->x[i], wake->y[i] - other->y[i]));
    }
    return worst;
}

static void check_mirror(const char *force, double bound) {
    const double rtol = 1e-10, end = verify_is_fast() ? 0.1 : 0.5;
    struct simulation *const wall = open_fish(force, rtol, "fluid: {walls: [0]}\n", "");
    struct simulation *const pair = open_fish(force, rtol, "", ", {start: {position: [0, -0.25]}, wave: {phase: 180}}");
    struct simulation *const alone = open_fish(force, rtol, "", "");
    verify_run(wall, end);
    verify_run(pair, end);
    verify_run(alone, end);
    verify_show(verify_text("%s: a fish 0.25 L beside a wall: place less that without wall, L", force), "",
                difference(wall, alone));
    verify_zero(verify_text("%s: the same less the result beside the mirror image, L", force), "two fish, rtol 1e-10",
                difference(wall, pair), bound);
}

// ---- against the wall

// a fish that swims against and along the wall of a channel
static void check_energy(const char *force) {
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: 3, shedding_interval: 0.02, output_interval: 0.02}\n"
        "fluid: {walls: [0, 2]}\n"
        "fish: [{force: %s, start: {position: [0, 0.6], heading: 215, speed: 0.8}}]\n",
        force);
    double imbalance = 0, energy = 0, circulation = 0, contact = 0;
    for (int i = 1; i <= 150; i++) {
        verify_run(simulation, 0.02 * i);
        simulate_measure(simulation);
        const struct diagnostics_fish *const fish = &simulation->diagnostics->fish[0];
        imbalance = fmax(imbalance, fabs(fish->energy_balance));
        energy = fmax(energy, fish->kinetic_energy);
        contact = fmax(contact, fish->contact_energy);
        circulation = fmax(circulation, fabs(simulation->diagnostics->total_circulation));
    }
    verify_show(verify_text("%s: a fish swims against and along a wall: largest contact_energy, J", force), "",
                contact);
    verify_zero(verify_text("%s: energy balance over the largest kinetic energy, rtol 1e-5", force), "conservation",
                imbalance / energy, 2e-3);
    verify_zero(verify_text("%s: total circulation, m2/s", force), "Kelvin", circulation, 1e-12);
}

// ---- a dipole at a wall

/* Two opposite vortices approach the wall y = 0 and part there: 1/x^2 + 1/y^2 is constant on the way of each (Lamb,
 * Hydrodynamics, section 155). The fish is far away. The error is of second order in the interval. */
static double dipole_error(double interval, double *parted) {
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: 5, shedding_interval: %.17g, output_interval: %.17g}\n"
        "fluid: {density: 1, viscosity: 0, walls: [0]}\n"
        "wake: {lifetime: 1000, decay: 0, smoothing: 0.001, tolerance: 0,\n"
        "       vortices: [[-0.5, 2, -6.283185307179586], [0.5, 2, 6.283185307179586]]}\n"
        "fish: [{nodes: 5, sheet_points: 33, force: pressure, pressure: {span: infinite}, wave: "
        "{amplitude: 0, frequency: 0},\n"
        "        motion: {prescribed: all, speed: 0}, start: {position: [1000, 1]}}]\n",
        interval, interval);
    double most = 0;
    for (int i = 1; i <= 20; i++) {
        verify_run(simulation, 0.25 * i);
        const struct wake *const wake = &simulation->state->wake[0];
        for (int k = 0; k < wake->n_vortex - 1; k++) {
            if (fabs(wake->circulation[k + 1] - wake->circulation[k]) < 1) continue;
            const double x = (wake->x[k] + wake->x[k + 1]) / 2, y = (wake->y[k] + wake->y[k + 1]) / 2;
            most = fmax(most, fabs((1 / (x * x) + 1 / (y * y)) / 4.25 - 1));
            *parted = x;
        }
    }

    return most;
}

static void check_dipole(void) {
    double parted = 0, not_used;
    const double coarse = dipole_error(0.02, &not_used), fine = dipole_error(0.01, &parted);
    verify_zero("dipole at a wall: 1/x^2 + 1/y^2 on the way of a vortex", "Lamb, section 155", fine, 1e-4);
    verify_regression("dipole at a wall: distance of a vortex from the middle", "half the distance at the start", 0.5,
                      fabs(parted), 4, 10);
    verify_order("dipole at a wall: order in the shedding interval", "order of the motion of a vortex",
                 verify_order_of_errors(coarse, fine), 1.7, 2.6);
}

void verify_walls(void) {
    check_dipole();
    check_mirror("reactive", 1e-8);
    if (verify_is_fast()) return;
    check_mirror("pressure", 1e-8);
    check_plate();
    check_energy("reactive");
    check_energy("pressure");
}
