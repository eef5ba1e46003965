/* test_rod_stress.c: In stiff bodies the stresses come from the balance of momentum. Their work and the strains that
 * follow from them are tested here (doc/model.md, section 13). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "body/rod.h"
#include "school.h"

#define TIME "time: {end: 8, shedding_interval: 0.02}\n"
enum { STRAINS = 64 };

static double zero[STRAINS];
static const struct actuation no_muscle = {zero, zero, zero, zero};

/* The stresses of a body from the node positions. */
static void stresses(const struct fish *fish, const double *y, double *stress) {
    double strain[STRAINS], rate[STRAINS];
    AT_MOST(rod_n_strains(fish), STRAINS);
    rod_strains(fish, &no_muscle, y, &(struct rod_strains){strain, rate, stress});
}

// m a minus the forces of the rod: the residue of a body without other forces
static void residue_of(const struct fish *fish, const double *y, double *residue) {
    for (int i = 0; i < 2 * fish->n_nodes; i++) {
        residue[fish->at.ax + i] = fish->mass[i % fish->n_nodes] * y[fish->at.ax + i];
    }
    rod_residual(fish, &no_muscle, y, residue);
}

TEST(the_balance_finds_the_stresses_that_the_accelerations_say) {
    struct setup setup =
        setup_of(TIME
                 "fluid: {density: 0}\nfish: [{nodes: 9, wave: {amplitude: 0},\n"
                 "  body: {modulus: 1.0e+9, damping: strain, relaxation_time: 0.02, bending_damping: 0.1}}]\n");
    const struct fish *fish = setup.school->fish;
    double *const y = setup.state->y;
    double want[STRAINS], law[STRAINS], got[STRAINS];
    // strains of a stiff body, and errors of positions and velocities, as large as the strains, left by an iteration
    const double strain = 1e-6, error = 1e-6;
    for (int i = 0; i < 2 * fish->n_nodes; i++) {
        y[fish->at.x + i] += strain * school_random(&setup);
        y[fish->at.vx + i] = 10 * strain * school_random(&setup);
    }
    // accelerations that obey the law of motion
    memset(y + fish->at.ax, 0, 2 * (size_t)fish->n_nodes * sizeof *y);
    residue_of(fish, y, setup.value);
    for (int i = 0; i < 2 * fish->n_nodes; i++) {
        y[fish->at.ax + i] = -setup.value[fish->at.ax + i] / fish->mass[i % fish->n_nodes];
    }
    stresses(fish, y, want);
    for (int i = 0; i < 2 * fish->n_nodes; i++) {
        y[fish->at.x + i] += error * school_random(&setup);
        y[fish->at.vx + i] += 10 * error * school_random(&setup);
    }
    stresses(fish, y, law);
    stresses(fish, y, got);
    residue_of(fish, y, setup.value);
    rod_stress_balance(fish, setup.value, y, got);
    double wrong = 0, size[2] = {0, 0};
    for (int i = 0; i < rod_n_strains(fish); i++)
        size[i >= fish->n_joints] = fmax(size[i >= fish->n_joints], fabs(want[i]));
    for (int i = 0; i < rod_n_strains(fish); i++) {
        // turned by the position errors over the length of an edge
        NEAR(got[i], want[i], 1e-4 * size[i >= fish->n_joints], 0);
        wrong = fmax(wrong, fabs(law[i] - want[i]) / size[i >= fish->n_joints]);
    }
    ABOVE(wrong, 0.3);
}

// a body that is bent by up to 0.3 rad at a joint, on which nothing but its rod acts
TEST(the_balance_of_a_bent_body_has_the_stresses_of_its_law) {
    struct setup setup =
        setup_stirred(TIME
                      "fluid: {density: 0}\nfish: [{nodes: 9, wave: {amplitude: 0},\n"
                      "  body: {modulus: 1.0e+5, damping: strain, relaxation_time: 0.02, bending_damping: 0.1}}]\n");
    const struct fish *fish = setup.school->fish;
    double *const y = setup.state->y, want[STRAINS], got[STRAINS] = {0};
    memset(y + fish->at.ax, 0, 2 * (size_t)fish->n_nodes * sizeof *y);
    memset(setup.value, 0, (size_t)setup.school->n_unknowns * sizeof *setup.value);
    // mass times the acceleration that the rod gives
    residue_of(fish, y, setup.value);
    for (int i = 0; i < 2 * fish->n_nodes; i++) setup.value[fish->at.ax + i] = -setup.value[fish->at.ax + i];
    stresses(fish, y, want);
    rod_stress_balance(fish, setup.value, y, got);
    double size[2] = {0, 0};
    for (int i = 0; i < rod_n_strains(fish); i++) {
        size[i >= fish->n_joints] = fmax(size[i >= fish->n_joints], fabs(want[i]));
    }
    for (int i = 0; i < rod_n_strains(fish); i++) NEAR(got[i], want[i], 1e-9 * size[i >= fish->n_joints], 0);
}

TEST(stresses_ahead_of_prescribed_nodes_stay) {
    const struct {
        const char *motion;
        int first_joint, first_edge;
    } cases[] = {{"prescribed: none", 0, 0},
                 {"prescribed: head, heave: 0.1, frequency: 1", 0, 0},
                 {"prescribed: head, heave: 0.1, frequency: 1}, body: {section: nodes", 0, 1},
                 {"prescribed: all, heave: 0.1, frequency: 1", 5, 6}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct setup setup = setup_with(TIME "fish: [{nodes: 7, motion: {%s}}]\n", cases[i].motion);
        school_stir(&setup);
        const struct fish *fish = setup.school->fish;
        double before[STRAINS], after[STRAINS];
        stresses(fish, setup.state->y, before);
        memcpy(after, before, sizeof after);
        for (int k = 0; k < 2 * fish->n_nodes; k++) setup.value[fish->at.ax + k] = school_random(&setup);
        rod_stress_balance(fish, setup.value, setup.state->y, after);
        for (int j = 0; j < fish->n_joints; j++) assert_int_equal(after[j] != before[j], j >= cases[i].first_joint);
        for (int k = 0; k < fish->n_edges; k++) {
            assert_int_equal(after[fish->n_joints + k] != before[fish->n_joints + k], k >= cases[i].first_edge);
        }
    }
}

// the strain of stress a + b t + c t^2 after infinitely long, at time t: S/K - tau S'/K + tau^2 S''/K
static double settled(double stiffness, double tau, const double s[3], double t) {
    return (s[0] + s[1] * t + s[2] * t * t - tau * (s[1] + 2 * s[2] * t) + 2 * tau * tau * s[2]) / stiffness;
}

static double parabola(const double s[3], double t) {
    return s[0] + s[1] * t + s[2] * t * t;
}

// the strain after h, by Simpson's rule in the integral over the stresses
static double crept(double stiffness, double tau, const double s[3], double t, double h, double strain) {
    enum { N = 200 };
    double sum = 0;
    for (int i = 0; i <= N; i++) {
        const double q = (double)i / N, weight = i == 0 || i == N ? 1 : i % 2 == 1 ? 4 : 2;
        sum += weight / (3 * N) * exp(-h / tau * (1 - q)) * parabola(s, t + q * h);
    }
    return exp(-h / tau) * strain + h / tau * sum / stiffness;
}

TEST(strains_creep_as_the_law_of_the_material_says) {
    // relaxation times far below a step, and far above it
    const double relaxation[] = {0, 1e-9, 1e-4, 0.003, 0.02, 0.5, 100, 1e6};
    const double s[3] = {0.3, -2, 7}, h = 0.004, g = 0.007, start = 0.01;
    for (size_t r = 0; r < sizeof relaxation / sizeof *relaxation; r++) {
        struct setup setup =
            setup_with(TIME
                       "fish: [{nodes: 5, body: {damping: strain, bending_damping: 0, stretching_damping: 0, "
                       "relaxation_time: %g}}]\n",
                       relaxation[r]);
        const struct fish *fish = setup.school->fish;
        const int n = rod_n_strains(fish);
        const double tau = relaxation[r];
        double oldest[STRAINS], before[STRAINS], now[STRAINS], strain[STRAINS], rate[STRAINS];
        for (int i = 0; i < n; i++) {
            oldest[i] = parabola(s, start - g);
            before[i] = parabola(s, start);
            now[i] = parabola(s, start + h);
            // an initial strain that decays
            strain[i] = 0.1;
        }
        rod_stress_creep(fish, h, g, oldest, before, now, strain);
        rod_stress_rates(fish, strain, now, rate);
        for (int i = 0; i < n; i++) {
            const int edge = i - fish->n_joints;
            const double stiffness =
                edge < 0 ? fish->bending_stiffness[i] / fish->edge_length : fish->axial_stiffness[edge];
            // for a long relaxation time the sum of the steady strain cancels, and the integral is easy
            const double own = 0.1 - settled(stiffness, tau, s, start);
            const double want = tau < h ? settled(stiffness, tau, s, start + h) + (tau > 0 ? exp(-h / tau) * own : 0)
                                        : crept(stiffness, tau, s, start, h, 0.1);
            NEAR(strain[i], want, 1e-14, 1e-12);
            const double by_law = tau > 0 ? (now[i] / stiffness - strain[i]) / tau : 0;
            NEAR(rate[i], by_law * (edge < 0 ? 1 : fish->edge_length), 1e-12, 1e-7);
        }
    }
}

TEST(without_an_older_stress_the_step_is_linear) {
    struct setup setup = setup_of(TIME "fish: [{nodes: 5, body: {damping: strain, relaxation_time: 0.02}}]\n");
    const struct fish *fish = setup.school->fish;
    const double s[3] = {0.3, -2, 0}, h = 0.004;
    double nothing[STRAINS], before[STRAINS], now[STRAINS], strain[STRAINS];
    for (int i = 0; i < rod_n_strains(fish); i++) {
        nothing[i] = 1e9;
        before[i] = s[0];
        now[i] = parabola(s, h);
        const double k = i < fish->n_joints ? fish->bending_stiffness[i] / fish->edge_length
                                            : fish->axial_stiffness[i - fish->n_joints];
        strain[i] = settled(k, 0.02, s, 0);
    }
    fish->bending_damping[0] = 0.02 * fish->bending_stiffness[0] / fish->edge_length;
    rod_stress_creep(fish, h, 0, nothing, before, now, strain);
    NEAR(strain[0], settled(fish->bending_stiffness[0] / fish->edge_length, 0.02, s, h), 0, 1e-12);
}

/* A default fish from rest, after two beats. */
static struct simulation *fish_from_rest(const char *modulus, const char *rtol) {
    struct simulation *const simulation =
        school_simulation_of(TIME
                             "solver: {rtol: %s}\nfish: [{force: reactive, nodes: 13, sheet_points: 33, body: "
                             "{modulus: %s, relaxation_time: 0.02}}]\n",
                             rtol, modulus);
    school_measure(simulation, 2);
    return simulation;
}

TEST(a_soft_body_has_the_stresses_of_its_places) {
    struct simulation *const simulation = fish_from_rest("1e6", "1e-7");
    const struct fish *fish = simulation->school->fish;
    const struct energy_balance *const balance = &simulation->state->balance[0];
    const struct actuation muscle = residual_actuate(simulation->residual, 0, 2, simulation->state->y);
    double strain[STRAINS], rate[STRAINS], stress[STRAINS], largest = 0;
    const struct rod_strains by_places = {strain, rate, stress}, by_momentum = {strain, rate, balance->stress};
    rod_strains(fish, &muscle, simulation->state->y, &by_places);
    for (int j = 0; j < fish->n_joints; j++) largest = fmax(largest, fabs(stress[j]));
    NEAR_ARRAY(fish->n_joints, balance->stress, stress, 1e-5 * largest, 0);
    const struct rod_energetics one = rod_energetics(fish, &muscle, &by_places);
    NEAR(one.actuation, rod_energetics(fish, &muscle, &by_momentum).actuation, 0, 1e-5);
    NEAR(one.bending, simulation->diagnostics->fish[0].bending_energy, 0, 1e-4);
}

TEST(powers_and_energies_of_a_stiff_body_have_a_limit) {
    // a hundred times stiffer, and at three times the default tolerance
    struct simulation *const fine = fish_from_rest("1e10", "1e-7"), *const stiff = fish_from_rest("1e12", "1e-4");
    const struct diagnostics_fish *const want = &fine->diagnostics->fish[0], *const got = &stiff->diagnostics->fish[0];
    NEAR(got->actuation_work, want->actuation_work, 0, 5e-3);
    NEAR(got->cost_of_transport, want->cost_of_transport, 0, 5e-3);
    // strains are proportional to 1/modulus, and so are energy and damping
    NEAR(100 * got->bending_energy, want->bending_energy, 0, 0.02);
    NEAR(100 * got->damping_power, want->damping_power, 0, 0.05);
    NEAR(100 * got->cost_of_transport_body, want->cost_of_transport_body, 0, 0.05);
    // energies and works are consistent
    BELOW(fabs(got->energy_balance), 1e-3 * got->actuation_work);
}
