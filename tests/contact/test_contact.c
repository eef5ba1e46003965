/* test_contact.c: Contact forces follow from an energy, and bodies that collide do not cross. test_residual.c tests the
 * derivatives of these forces. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "contact/contact.h"
#include "fish/fish.h"
#include "school.h"
#include "school/diagnostics_energy.h"

#define TIME "time: {end: 1, shedding_interval: 0.01, output_interval: 0.01}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"

// bodies at rest, of uniform thickness: two bodies with the given gap
#define STRAIGHT "defaults: {fish: {nodes: 7, wave: {amplitude: 0}, body: {profile: uniform, thickness: 0.1}}}\n"
#define BESIDE(y) STRAIGHT "fish: [{}, {start: {position: [0, " y "]}}]\n"

TEST(nobody_repels_what_is_farther_than_the_range) {
    const struct {
        const char *text;
        int n;
    } cases[] = {{TIME BESIDE("0.119"), 1},
                 {TIME BESIDE("0.121"), 0},
                 {TIME "contact: {range: 0.03}\n" BESIDE("0.121"), 1},
                 {TIME "contact: {action: warn}\n" BESIDE("0.119"), 0},
                 {TIME "contact: {action: stop}\n" BESIDE("0.119"), 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct setup setup = setup_of(cases[i].text);
        struct contact *const contact = setup.residual->contact;
        school_ok(contact_find(contact, setup.state, 0, setup.state->y));
        const int *other;
        for (int f = 0; f < 2; f++) {
            assert_int_equal(contact_partners(contact, f, &other), cases[i].n);
            for (int k = 0; k < cases[i].n; k++) assert_int_equal(other[k], 1 - f);
            assert_int_equal(contact_terms(contact, f, setup.state->y).energy > 0, cases[i].n);
        }
    }
}

// oblique bodies side by side, in pairs: the boxes around all of them overlap, and only partners are within the range;
// a body that gets through its partner in a step is noticed in every pair
TEST(of_many_candidates_only_partners_are_in_contact) {
    char text[1024];
    int end = snprintf(text, sizeof text, TIME STRAIGHT "fish:\n");
    for (int f = 0; f < 6; f++) {
        const double side = sqrt(0.5) * (0.27 * (f / 2) + 0.119 * (f % 2));
        end += snprintf(text + end, sizeof text - (size_t)end,
                        "  - {start: {position: [%.17g, %.17g], heading: 225}}\n", -side, side);
    }
    struct setup setup = setup_of(text);
    struct contact *const contact = setup.residual->contact;
    double *const y = setup.state->y;
    memcpy(setup.state->closest->before, y, sizeof *y * (size_t)setup.school->n_unknowns);
    school_ok(contact_find(contact, setup.state, 0, y));
    for (int f = 0; f < 6; f++) {
        const int *other;
        assert_int_equal(contact_partners(contact, f, &other), 1);
        assert_int_equal(other[0], f ^ 1);
    }
    for (int f = 1; f < 6; f += 2) {
        const struct fish *const fish = &setup.school->fish[f];
        for (int i = 0; i < 2 * fish->n_nodes; i++) y[fish->at.x + i] += i < fish->n_nodes ? 0.11 : -0.11;
        assert_int_equal(contact_find(contact, setup.state, 0, y), STATUS_RETRY);
        memcpy(y, setup.state->closest->before, sizeof *y * (size_t)setup.school->n_unknowns);
    }
}

static double energy_of_school(struct setup *setup, const double *y) {
    double energy = 0;
    for (int f = 0; f < setup->school->n_fish; f++) energy += contact_terms(setup->residual->contact, f, y).energy;
    return energy;
}

#define NEAR_ANOTHER                                                                           \
    TIME "contact: {range: 0.5}\n"                                                             \
         "fish: [{nodes: 7}, {nodes: 5, length: 0.7, start: {position: [0.2, 0.35], heading: " \
         "190}}, {nodes: 9, start: {position: [0.1, -0.35], heading: 170}}]\n"

TEST(forces_are_the_gradient_of_the_energy) {
    struct setup setup = setup_stirred(NEAR_ANOTHER);
    double *const y = setup.state->y, h = 1e-5;
    school_ok(contact_find(setup.residual->contact, setup.state, 0, y));
    for (int f = 0; f < 3; f++) contact_residual(setup.residual->contact, f, y, setup.value);
    int n = 0;
    for (int f = 0; f < 3; f++) {
        const struct fish *const fish = &setup.school->fish[f];
        for (int i = 0; i < 2 * fish->n_nodes; i++) {
            double *const place = &y[fish->at.x + i], here = *place;
            *place = here + h;
            const double after = energy_of_school(&setup, y);
            *place = here - h;
            const double gradient = (after - energy_of_school(&setup, y)) / (2 * h);
            *place = here;
            NEAR(setup.value[fish->at.ax + i], gradient, 1e-5, 1e-6);
            n += fabs(gradient) > 0.1;
        }
    }
    ABOVE(n, 10);
}

TEST(forces_and_powers_of_all_add_up_to_nothing) {
    struct setup setup = setup_stirred(NEAR_ANOTHER);
    const double *const y = setup.state->y;
    const struct contact *const contact = setup.residual->contact;
    school_ok(contact_find(setup.residual->contact, setup.state, 0, y));
    double sum[2] = {0, 0}, size = 0, power = 0, largest = 0, moment = 0;
    for (int f = 0; f < 3; f++) {
        const struct fish *const fish = &setup.school->fish[f];
        double force[2];
        const struct contact_terms on = contact_terms(contact, f, y);
        memcpy(force, on.force, sizeof force);
        for (int i = 0; i < 2; i++) sum[i] += force[i];
        size = fmax(size, hypot(force[0], force[1]));
        power += contact_terms(contact, f, y).power;
        largest = fmax(largest, fabs(contact_terms(contact, f, y).power));
        memset(setup.value, 0, (size_t)setup.school->n_unknowns * sizeof *setup.value);
        contact_residual(contact, f, y, setup.value);
        double own = 0;
        for (int k = 0; k < fish->n_nodes; k++) {
            own += y[fish->at.x + k] * setup.value[fish->at.ay + k] - y[fish->at.y + k] * setup.value[fish->at.ax + k];
        }
        NEAR(on.moment, -own, 1e-12, 1e-12);
        moment += own;
    }
    ABOVE(size, 1);
    ABOVE(largest, 0.1);
    NEAR_ARRAY(2, sum, ((double[]){0, 0}), 1e-14 * size, 0);
    NEAR(moment, 0, 1e-13 * size, 0);
    NEAR(power, 0, 1e-13 * largest, 0);
}

TEST(walls_push_with_the_gradient_of_the_energy) {
    struct setup setup = setup_stirred(SMALL
                                       "fluid: {walls: [-0.5, 0.6]}\ncontact: {range: 0.5, action: warn}\n"
                                       "fish: [{nodes: 7}, {nodes: 5, length: 0.7, start: {position: "
                                       "[0.2, 0.3], heading: 190}}]\n");
    double *const y = setup.state->y, h = 1e-5;
    const struct contact *const contact = setup.residual->contact;
    school_ok(contact_find(setup.residual->contact, setup.state, 0, y));
    for (int f = 0; f < 2; f++) contact_residual(contact, f, y, setup.value);
    int n = 0;
    for (int f = 0; f < 2; f++) {
        const struct fish *const fish = &setup.school->fish[f];
        double sum[2] = {0, 0}, force[2], moment = 0;
        for (int i = 0; i < 2 * fish->n_nodes; i++) {
            double *const place = &y[fish->at.x + i], here = *place;
            *place = here + h;
            const double after = energy_of_school(&setup, y);
            *place = here - h;
            const double gradient = (after - energy_of_school(&setup, y)) / (2 * h);
            *place = here;
            NEAR(setup.value[fish->at.ax + i], gradient, 1e-5, 1e-6);
            if (i < fish->n_nodes) moment -= y[fish->at.x + i] * setup.value[fish->at.ay + i];
            sum[i / fish->n_nodes] -= setup.value[fish->at.ax + i];
            n += fabs(gradient) > 0.1;
        }
        const struct contact_terms on = contact_terms(contact, f, y);
        memcpy(force, on.force, sizeof force);
        NEAR_ARRAY(2, force, sum, 1e-13, 1e-13);
        NEAR(force[0], 0, 0, 0);
        NEAR(on.moment, moment, 1e-12, 1e-12);
        // a wall is at rest: no power
        NEAR(contact_terms(contact, f, y).power, 0, 0, 0);
    }
    ABOVE(n, 5);
}

TEST(a_wall_is_a_spring_that_stiffens) {
    // E = k r (1 - s)^3/s: E' = k (3 - 2 s - 1/s^2), E'' = 2 k/r (1/s^3 - 1), also where the last term decides
    static const double parts[] = {0.1, 0.5, 0.9, 0.99};
    for (int i = 0; i < 4; i++) {
        const double s = parts[i], range = 0.2, wall = -0.05 - s * range;
        struct setup setup =
            setup_with(TIME STRAIGHT "fluid: {walls: [%.17g]}\ncontact: {range: 0.2}\nfish: [{}]\n", wall);
        const struct fish *const fish = &setup.school->fish[0];
        const double *const y = setup.state->y, k = fish->contact_strength;
        school_ok(contact_find(setup.residual->contact, setup.state, 0, y));
        contact_residual(setup.residual->contact, 0, y, setup.value);
        struct coupling_block block = setup.residual->jacobian_scratch[0].rows;
        block.n_rows = 2 * fish->n_nodes;
        contact_jacobian(setup.residual->contact, 0, 0, y, &block);
        for (int node = 1; node < fish->n_nodes - 1; node++) {
            const int at = fish->n_nodes + node;
            NEAR(setup.value[fish->at.ay + node], k * (3 - 2 * s - 1 / (s * s)), 0, 1e-10);
            NEAR(block.value[at * block.n_rows + at] * fish->mass[node], 2 * k / range * (1 / (s * s * s) - 1), 0,
                 1e-10);
        }
    }
}

// doc/model.md, section 16: half of phi of every end of each edge above each wall
TEST(the_energy_above_walls_is_that_of_all_ends) {
    struct setup setup =
        setup_stirred(SMALL "fluid: {walls: [-0.5, 0.6]}\ncontact: {range: 0.5}\nfish: [{nodes: 7}]\n");
    const struct fish *const fish = &setup.school->fish[0];
    const double *const y = setup.state->y, r = setup.school->contact_range;
    double want = 0;
    for (int i = 0; i < fish->n_edges; i++) {
        for (int end = 0; end < 2; end++) {
            const double place = y[fish->at.y + i + end];
            const double gap[] = {place + 0.5 - fish->thickness[i] / 2, 0.6 - place - fish->thickness[i] / 2};
            for (int wall = 0; wall < 2; wall++) {
                const double s = gap[wall] / r;
                if (s < 1) want += fish->contact_strength * r * pow(1 - s, 3) / s / 2;
            }
        }
    }
    ABOVE(want, 1e-3);
    NEAR(contact_terms(setup.residual->contact, 0, y).energy, want, 0, 1e-12);
}

TEST(two_bodies_with_given_motions_pass_through_each_other) {
    static const char *const motions[][2] = {
        {"all", "all"}, {"head", "all"}, {"all, surge: free", "all"}, {"all", "all, surge: free"}};
    for (int i = 0; i < 4; i++) {
        struct setup setup =
            setup_with(TIME
                       "defaults: {fish: {nodes: 7, wave: {amplitude: 0}, body: {profile: uniform, "
                       "thickness: 0.1}}}\n"
                       "fish: [{motion: {prescribed: %s}}, {start: {position: [0, 0.2]}, motion: {prescribed: %s}}]\n",
                       motions[i][0], motions[i][1]);
        double *const y = setup.state->y;
        const struct fish *const fish = &setup.school->fish[1];
        for (int k = 0; k < fish->n_nodes; k++) y[fish->at.y + k] -= 0.15;
        assert_int_equal(contact_find(setup.residual->contact, setup.state, 0.1, y), i == 0 ? STATUS_OK : STATUS_RETRY);
        const int *other;
        for (int f = 0; f < 2 && i == 0; f++) assert_int_equal(contact_partners(setup.residual->contact, f, &other), 0);
    }
}

TEST(who_is_beyond_a_wall_asks_for_a_smaller_step) {
    struct setup setup = setup_of(TIME STRAIGHT "fluid: {walls: [-0.2]}\nfish: [{}]\n");
    const struct fish *const fish = &setup.school->fish[0];
    double *const y = setup.state->y;
    // half of the body is 0.05 thick
    const double places[] = {-0.149, -0.151, -5};
    for (int i = 0; i < 3; i++) {
        y[fish->at.y + 3] = places[i];
        assert_int_equal(contact_find(setup.residual->contact, setup.state, 0.1, y), i == 0 ? STATUS_OK : STATUS_RETRY);
        NEAR(fish_wall_distance(setup.school, fish, y, NULL), places[i] + 0.15, 1e-15, 0);
    }
    assert_non_null(strstr(status_message(), "touches a wall"));
}

TEST(what_crosses_on_its_way_asks_for_a_smaller_step) {
    struct setup setup = setup_of(TIME BESIDE("0.2"));
    struct contact *const contact = setup.residual->contact;
    const struct fish *const fish = &setup.school->fish[1];
    double *const y = setup.state->y;
    const struct {
        double shift;
        int status;
    } steps[] = {{-0.09, STATUS_OK}, {-0.11, STATUS_RETRY}, {-0.2, STATUS_RETRY}, {-5, STATUS_RETRY}, {5, STATUS_OK}};
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        for (int k = 0; k < fish->n_nodes; k++) y[fish->at.y + k] = 0.2 + steps[i].shift;
        assert_int_equal(contact_find(contact, setup.state, 0.1, y), steps[i].status);
        assert_int_equal(residual_evaluate(setup.residual, &residual_run, 0, y, setup.state->yp, setup.value),
                         steps[i].status);
    }
}

// ---- runs

// momentum of n fish, kg m s-1, and a scale of the momentum
static double momentum(const struct simulation *simulation, int n_fish, double sum[2]) {
    double scale = 0;
    sum[0] = sum[1] = 0;
    for (int f = 0; f < n_fish; f++) {
        const struct fish *const fish = &simulation->school->fish[f];
        const double *const y = simulation->state->y;
        for (int k = 0; k < fish->n_nodes; k++) {
            const double v[2] = {y[fish->at.vx + k], y[fish->at.vy + k]};
            for (int i = 0; i < 2; i++) sum[i] += fish->mass[k] * v[i];
            scale += fish->mass[k] * hypot(v[0], v[1]);
        }
    }
    return scale;
}

#define VACUUM TIME "fluid: {density: 0}\n"
#define PASSIVE "nodes: 5, sheet_points: 26, wave: {amplitude: 0}"
#define HEAD_ON(speed)                                                                                             \
    VACUUM "defaults: {fish: {" PASSIVE ", start: {speed: " speed                                                  \
           "}}}\nfish: [{start: {position: [-0.2, 0.01], heading: 0}}, {length: 0.8, start: {position: [0.2, 0], " \
           "heading: 175}}]\n"

// bodies collide and separate, momentum and energy are conserved; the steps per event show the collision
static void meet(const char *name, const char *text, double end, double audit_limit) {
    struct simulation *const simulation = school_simulation(text);
    const int n_fish = simulation->school->n_fish;
    double before[2], after[2], first[2], energy = 0, imbalance = 0;
    const double scale = momentum(simulation, n_fish, before);
    momentum(simulation, 1, first);
    long most = 0, steps = 0;
    for (int f = 0; f < n_fish; f++) energy += diagnostics_energy(simulation->residual, f, 0, simulation->state->y);
    while (simulation->state->t < end) {
        simulate_measure(simulation);
        for (int f = 0; f < n_fish; f++) {
            imbalance = fmax(imbalance, fabs(simulation->diagnostics->fish[f].energy_balance));
        }
        school_ok(simulate_step(simulation));
        most = simulation->totals.steps - steps > most ? simulation->totals.steps - steps : most;
        steps = simulation->totals.steps;
        momentum(simulation, n_fish, after);
        // walls along x take the momentum across
        NEAR_ARRAY(simulation->school->walls.n > 0 ? 1 : 2, after, before, 1e-10 * scale, 0);
    }
    print_message("%s: least %.2e m, imbalance %.1e of %.0f J, at most %ld steps per event\n", name,
                  simulation->state->closest->distance, imbalance, energy, most);
    // without contact the momentum of the first body is constant
    momentum(simulation, 1, after);
    ABOVE(hypot(after[0] - first[0], after[1] - first[1]), 1e-3 * scale);
    ABOVE(simulation->state->closest->distance, 0);
    BELOW(imbalance, audit_limit * energy);
}

TEST(bodies_that_meet_do_not_cross) {
    meet("head on, 1 m/s", "solver: {rtol: 1.0e-6}\n" HEAD_ON("1"), 0.3, 5e-3);
    meet("head on, 5 m/s", "solver: {rtol: 1.0e-6}\n" HEAD_ON("5"), 0.1, 5e-3);
    meet("head on, 15 m/s", "solver: {rtol: 1.0e-6}\n" HEAD_ON("15"), 0.03, 5e-3);
    meet("side by side",
         VACUUM "defaults: {fish: {" PASSIVE
                ", start: {speed: 3}}}\nfish: [{start: {heading: 170}}, {start: "
                "{position: [0, 0.35], heading: 190}}]\n",
         0.4, 5e-3);
    meet("three at once",
         "solver: {rtol: 1.0e-6}\n" VACUUM "defaults: {fish: {" PASSIVE
         ", start: {speed: 3}}}\n"
         "fish: [{start: {position: [0.2, 0], heading: 180}}, {start: {position: [-0.1, 0.18], heading: 300}}, "
         "{start: {position: [-0.1, -0.2], heading: 60}}]\n",
         0.15, 5e-3);
    meet("nearly touching",
         "solver: {rtol: 1.0e-6}\n" VACUUM "defaults: {fish: {" PASSIVE
         ", body: {profile: uniform, thickness: 0.1}, start: {speed: 0.01}}}\n"
         "fish: [{}, {start: {position: [0.3, 0.1001]}}]\n",
         0.1, 5e-3);
    meet("in line, free along it",
         "solver: {rtol: 1.0e-7}\n" VACUUM "defaults: {fish: {" PASSIVE
         ", motion: {prescribed: all, surge: free}, start: {speed: 3}}}\n"
         "fish: [{start: {position: [-0.2, 0], heading: 0}}, {start: {position: [0.2, 0], heading: 180}}]\n",
         0.3, 5e-3);
}

// Two plates heave and swim in line; the faster plate behind pushes the plate in front and does not pass through.
TEST(plates_that_swim_in_line_do_not_cross) {
    struct simulation *const simulation =
        school_simulation(TIME
                          "defaults: {fish: {nodes: 5, sheet_points: 17, force: pressure, pressure: {span: infinite}, "
                          "wave: {amplitude: 0, frequency: 0}, body: {profile: uniform, thickness: 0.05, depth: 1, "
                          "density: 2000}, motion: {prescribed: all, surge: free, heave: 0.05, frequency: 1}}}\n"
                          "fish: [{start: {speed: 1}}, {start: {position: [1.3, 0], speed: 2}}]\n");
    double stored = 0, imbalance = 0;
    const double energy = diagnostics_energy(simulation->residual, 1, 0, simulation->state->y);
    while (simulation->state->t < 1) {
        school_ok(simulate_step(simulation));
        simulate_measure(simulation);
        const struct diagnostics_fish *const of = simulation->diagnostics->fish;
        stored = fmax(stored, of[0].contact_energy);
        for (int f = 0; f < 2; f++) imbalance = fmax(imbalance, fabs(of[f].energy_balance));
        for (int i = 0; i < 2; i++) NEAR(of[0].contact_force[i], -of[1].contact_force[i], 1e-9, 1e-9);
    }
    ABOVE(simulation->state->closest->distance, 0);
    ABOVE(stored, 0.005 * energy);
    BELOW(imbalance, 5e-3 * energy);
    BELOW(simulation->diagnostics->fish[0].com[0], simulation->diagnostics->fish[1].com[0]);
}

#define AT_A_WALL(height, speed)                                                                                       \
    TIME "solver: {rtol: 1.0e-6}\nfluid: {density: 0, walls: [0]}\nfish: [{" PASSIVE ", start: {position: [0, " height \
         "], heading: 280, speed: " speed "}}]\n"

TEST(walls_throw_bodies_back) {
    meet("at a wall, 1 m/s", AT_A_WALL("0.15", "1"), 0.4, 5e-3);
    meet("at a wall, 5 m/s", AT_A_WALL("0.15", "5"), 0.1, 5e-3);
    meet("at a wall, 15 m/s", AT_A_WALL("0.25", "15"), 0.05, 5e-3);
    meet("two between walls",
         "solver: {rtol: 1.0e-6}\n" TIME
         "fluid: {density: 0, walls: [-0.42, 0.62]}\n"
         "defaults: {fish: {" PASSIVE
         ", start: {speed: 4}}}\nfish: [{start: {heading: 160}}, {start: {position: [0.1, 0.2], heading: 200}}]\n",
         0.3, 5e-3);
}

// Two bodies with sheet pressure, point-symmetric: the momentum of bodies and fluid stays 0, and the energy balance
// includes every power.
TEST(bodies_under_pressure_throw_each_other_back) {
    struct simulation *const simulation = school_simulation(
        TIME
        "solver: {rtol: 1.0e-6}\n"
        "defaults: {fish: {nodes: 9, sheet_points: 17, force: pressure, pressure: {span: infinite, suction_limit: 0},\n"
        "                  drag: {skin: laminar}, wave: {amplitude: 0}, body: {relaxation_time: 0.02},\n"
        "                  start: {speed: 1}}}\n"
        "fish: [{start: {position: [-0.1, 0.01], heading: 0}}, {start: {position: [0.1, -0.01], heading: 180}}]\n");
    double sum[2], stored = 0, imbalance = 0;
    const double scale = momentum(simulation, 2, sum);
    const double energy = 2 * diagnostics_energy(simulation->residual, 0, 0, simulation->state->y);
    while (simulation->state->t < 0.2) {
        school_ok(simulate_step(simulation));
        simulate_measure(simulation);
        const struct diagnostics_fish *const of = simulation->diagnostics->fish;
        stored = fmax(stored, of[0].contact_energy);
        for (int f = 0; f < 2; f++) imbalance = fmax(imbalance, fabs(of[f].energy_balance));
        momentum(simulation, 2, sum);
        NEAR_ARRAY(2, sum, ((double[]){0, 0}), 1e-6 * scale, 0);
        for (int i = 0; i < 2; i++) NEAR(of[0].contact_force[i], -of[1].contact_force[i], 1e-9, 1e-12);
    }
    ABOVE(simulation->state->closest->distance, 0);
    ABOVE(stored, 0.005 * energy);
    BELOW(imbalance, 1e-3 * energy);
    // the bodies have turned back, aside or into a spin
    BELOW(simulation->diagnostics->fish[0].com_velocity[0], 0.5);
}

// A body that is thrown back moves tail first, and the tail overtakes the newest marker.
TEST(bodies_that_are_thrown_back_go_on_tail_first) {
    static const struct {
        const char *defaults, *text;
    } cases[] = {// at a wall, at a right angle: the tail turns back within an interval
                 {"nodes: 9, body: {modulus: 5.394e+6}",
                  "fluid: {walls: [-0.4974]}\nfish: [{start: {heading: 265.83, speed: 4}, wave: {phase: 33.9}}]\n"},
                 // the same with a softer body: the tail turns back later
                 {"nodes: 17, body: {modulus: 9.907e+5}",
                  "fluid: {walls: [-0.6660]}\nfish: [{start: {heading: 259.75, speed: 2}, wave: {phase: 257}}]\n"},
                 // head on: one body at rest; both fast
                 {"nodes: 9, wave: {amplitude: 0}",
                  "fish: [{start: {position: [-0.15, 0.01], heading: 0, speed: 1}},\n"
                  "  {start: {position: [0.15, 0], heading: 187}}]\n"},
                 {"nodes: 9, wave: {amplitude: 0}",
                  "fish: [{start: {position: [-0.15, 0.01], heading: 0, speed: 4}},\n"
                  "  {start: {position: [0.15, 0], heading: 178, speed: 4}}]\n"}};
    const size_t n_cases = sizeof cases / sizeof *cases;
    for (size_t i = 0; i < 2 * n_cases; i++) {
        struct simulation *const simulation = school_simulation_of(
            TIME "defaults: {fish: {force: pressure, pressure: {span: %s}, sheet_points: 33, %s}}\n%s",
            i < n_cases ? "infinite" : "finite", cases[i % n_cases].defaults, cases[i % n_cases].text);
        double stored = 0;
        while (simulation->state->t < 0.6) {
            school_ok(simulate_step(simulation));
            simulate_measure(simulation);
            stored = fmax(stored, simulation->diagnostics->fish[0].contact_energy);
        }
        const double speed =
            hypot(simulation->diagnostics->fish[0].com_velocity[0], simulation->diagnostics->fish[0].com_velocity[1]);
        ABOVE(stored, 0.1);
        BELOW(speed, 4);
    }
}

TEST(every_integrator_keeps_bodies_apart) {
    static const char *const methods[] = {"method: implicit_euler, step: 1.0e-3", "method: trapezoid, step: 1.0e-3",
                                          "method: rk4, step: 2.0e-4", "method: dormand_prince"};
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        char text[1024];
        snprintf(
            text, sizeof text,
            "solver: {%s}\n" VACUUM "defaults: {fish: {" PASSIVE
            ", start: {speed: 0.5}}}\n"
            "fish: [{start: {position: [-0.15, 0], heading: 0}}, {start: {position: [0.15, 0.02], heading: 180}}]\n",
            methods[i]);
        meet(methods[i], text, 0.3, 0.2);
    }
}

TEST(a_fixed_step_that_is_too_long_fails_and_says_so) {
    struct simulation *const simulation =
        school_simulation("solver: {method: implicit_euler, step: 0.01}\n" HEAD_ON("15"));
    enum status status = STATUS_OK;
    for (int i = 0; i < 5 && status == STATUS_OK; i++) status = simulate_step(simulation);
    assert_int_equal(status, STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "choose a smaller solver.step"));
    ABOVE(simulation->state->closest->distance, 0);
}

// a body that is sent at an angle into a wall, which it reaches in 0.05 s
#define INTO_WALL(walls, y, heading)                                                        \
    TIME "solver: {max_steps: 20}\nfluid: {density: 0, walls: " walls "}\nfish: [{" PASSIVE \
         ", start: {position: [0, " y "], heading: " heading ", speed: 5}}]\n"

TEST(a_failure_in_contact_names_both_bodies_or_the_wall_and_the_gap) {
    static const struct {
        const char *text, *message, *unit;
    } cases[] = {
        {"solver: {max_steps: 20}\n" HEAD_ON("5"), "; fish1 and fish2 were in contact, with a gap of ", " m"},
        {INTO_WALL("[0]", "0.15", "280"), "; fish1 was in contact with the wall at y = 0, with a gap of ", " m"},
        {INTO_WALL("[-0.5, 2]", "-0.35", "280"),
         "; fish1 was in contact with the lower wall at y = -0.5, with a gap of ", " m"},
        {INTO_WALL("[-2, 0.5]", "0.35", "80"), "; fish1 was in contact with the upper wall at y = 0.5, with a gap of ",
         " m"},
        // bodies apart: no contact in the message
        {"solver: {max_steps: 1}\n" SMALL "fish: [{}, {start: {position: [0, 1]}}]\n", NULL, NULL}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct simulation *const simulation = school_simulation(cases[i].text);
        enum status status = STATUS_OK;
        for (int n = 0; n < 50 && status == STATUS_OK; n++) status = simulate_step(simulation);
        assert_int_equal(status, STATUS_SOLVER);
        const char *const said = strstr(status_message(), cases[i].message ? cases[i].message : "contact");
        if (cases[i].message) {
            if (!said) fail_msg("%s", status_message());
            char *end;
            const double gap = strtod(said + strlen(cases[i].message), &end);
            ABOVE(gap, 0);
            BELOW(gap, simulation->school->contact_range);
            assert_string_equal(end, cases[i].unit);
        } else {
            assert_null(said);
        }
    }
}

TEST(of_many_contacts_the_least_gap_is_named) {
    // gaps of 0.08, 0.04 and 0.06 m above the wall, and of e above d
    static const char *const height[] = {"1.18", "1.12"},
                             *const named[] = {"; b was in contact with the wall at y = 0, with a gap of 0.04 m",
                                               "; d and e were in contact, with a gap of 0.02 m"};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 1, shedding_interval: 0.02}\nfluid: {walls: [0]}\nsolver: {max_steps: 1}\n"
            "contact: {range: 0.1}\ndefaults: {fish: {" PASSIVE
            ", body: {profile: uniform, thickness: 0.1}}}\n"
            "fish: [{name: a, start: {position: [0, 0.13]}}, {name: b, start: {position: [5, 0.09]}},\n"
            "    {name: c, start: {position: [10, 0.11]}}, {name: d, start: {position: [15, 1]}},\n"
            "    {name: e, start: {position: [15, %s]}}]\n",
            height[i]);
        assert_int_equal(simulate_step(simulation), STATUS_SOLVER);
        if (!strstr(status_message(), named[i])) fail_msg("%s", status_message());
    }
}

enum { CROWD = 256 };

// 256 fish in colliding pairs, each pair at a different angle
static char *crowd(void) {
    enum { BYTES = 40000 };
    char *const text = arena_new(test_arena(), BYTES, 1);
    size_t used = (size_t)snprintf(
        text, BYTES,
        "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
        "fluid: {density: 0}\n"
        "defaults: {fish: {nodes: 4, force: reactive, sheet_points: 5, wave: {amplitude: 0}}}\nfish:\n");
    for (int i = 0; i < CROWD; i++) {
        const int pair = i / 2, column = pair % 16, row = pair / 16;
        const double heading = 7.3 * pair + 180 * (i % 2), angle = heading * acos(-1) / 180,
                     back = 0.075 + 0.0005 * column;
        used += (size_t)snprintf(
            text + used, BYTES - used, "  - {start: {position: [%.4f, %.4f], heading: %.4f, speed: 0.1}}\n",
            3 * column - back * cos(angle) + 0.02 * sin(angle), 3 * row - back * sin(angle), heading);
        BELOW(used, BYTES);
    }
    return text;
}

TEST(of_256_fish_no_two_get_through_each_other) {
    struct simulation *const simulation = school_simulation(crowd());
    double before[2], after[2];
    const double scale = momentum(simulation, CROWD, before);
    while (simulation->state->t < 0.05) school_ok(simulate_step(simulation));
    const struct contact *const contact = simulation->residual->contact;
    const double *const y = simulation->state->y;
    school_ok(contact_find(simulation->residual->contact, simulation->state, simulation->state->t, y));
    // the sorted boxes find the same contacts as all pairs
    const double range = simulation->school->contact_range;
    int n_contacts = 0;
    for (int f = 0; f < CROWD; f++) {
        const int *other;
        const int n = contact_partners(contact, f, &other);
        n_contacts += n;
        for (int g = 0, i = 0; g < CROWD; g++) {
            if (g == f) continue;
            const double distance = fish_distance(&simulation->school->fish[f], &simulation->school->fish[g], y, range);
            assert_int_equal(i < n && other[i] == g, distance < range);
            i += i < n && other[i] == g;
        }
    }
    momentum(simulation, CROWD, after);
    ABOVE(n_contacts, 20);
    ABOVE(simulation->state->closest->distance, 0);
    NEAR_ARRAY(2, after, before, 1e-10 * scale, 0);
}

TEST(stop_ends_the_run_at_the_time_and_with_the_names) {
    struct simulation *const simulation = school_simulation(
        "contact: {action: stop}\n" TIME STRAIGHT
        "fish: [{name: quick, start: {position: [0.5, 0.25], speed: 1, heading: 200}}, {name: lazy}]\n");
    enum status status = STATUS_OK;
    for (int i = 0; i < 50 && status == STATUS_OK; i++) status = simulate_step(simulation);
    assert_int_equal(status, STATUS_CONTACT);
    assert_int_equal(status_exit_code(status), 3);
    const struct closest *const closest = simulation->state->closest;
    char message[200];
    snprintf(message, sizeof message,
             "contact of quick and lazy at t = %.10g s: %.4g m between their outlines, less than contact.range, 0.02 m",
             closest->t, closest->distance);
    assert_non_null(strstr(status_message(), message));
    BELOW(closest->distance, 0.02);
}

TEST(stop_does_not_wait_until_bodies_touch) {
    // the bodies pass each other at 0.1 range, 2 mm
    struct simulation *const simulation =
        school_simulation("contact: {action: stop}\nfluid: {density: 0}\n" TIME STRAIGHT
                          "fish: [{start: {position: [1.2, 0.102], speed: 5}}, {}]\n");
    enum status status = STATUS_OK;
    while (status == STATUS_OK && simulation->state->t < 0.5) status = simulate_step(simulation);
    assert_int_equal(status, STATUS_CONTACT);
    const double distance = simulation->state->closest->distance;
    ABOVE(distance, 0.0015);
    BELOW(distance, simulation->school->contact_range);
}

// the distance of a point from the edge between two others
static double distance_from_edge(const double p[2], const double a[2], const double b[2]) {
    const double e[2] = {b[0] - a[0], b[1] - a[1]}, r[2] = {p[0] - a[0], p[1] - a[1]};
    const double q = fmin(1, fmax(0, (r[0] * e[0] + r[1] * e[1]) / (e[0] * e[0] + e[1] * e[1])));
    return hypot(r[0] - q * e[0], r[1] - q * e[1]);
}

static void place_of(const struct fish *fish, const double *y, int node, double place[2]) {
    place[0] = y[fish->at.x + node];
    place[1] = y[fish->at.y + node];
}

// doc/model.md, section 16: a quarter of phi of every end of each edge of one body above each edge of the other
static double energy_of_pair(const struct school *school, const struct fish *a, const struct fish *b, const double *y) {
    const double r = school->contact_range;
    const double k = a->contact_strength * b->contact_strength / (a->contact_strength + b->contact_strength);
    double energy = 0;
    for (int i = 0; i < a->n_edges; i++) {
        for (int j = 0; j < b->n_edges; j++) {
            double p[4][2];
            for (int end = 0; end < 2; end++) {
                place_of(a, y, i + end, p[end]);
                place_of(b, y, j + end, p[2 + end]);
            }
            for (int end = 0; end < 4; end++) {
                const int other = end < 2 ? 2 : 0;
                const double d =
                    distance_from_edge(p[end], p[other], p[other + 1]) - (a->thickness[i] + b->thickness[j]) / 2;
                if (d < r) energy += k * r * pow(1 - d / r, 3) / (d / r) / 4;
            }
        }
    }
    return energy;
}

TEST(the_energy_is_that_of_all_ends_above_all_edges) {
    // random shapes, and two bodies in line: edges with near ends may have first nodes far apart
    static const char *const texts[] = {
        NEAR_ANOTHER, TIME "contact: {range: 0.5}\n" STRAIGHT "fish: [{}, {start: {position: [1.4, 0.01]}}]\n",
        TIME "contact: {range: 0.5}\n" STRAIGHT "fish: [{}, {start: {position: [2.4, 0.01], heading: 0}}]\n"};
    for (int i = 0; i < 3; i++) {
        struct setup setup = setup_of(texts[i]);
        if (i == 0) school_stir(&setup);
        const double *const y = setup.state->y;
        memcpy(setup.state->closest->before, y, (size_t)setup.school->n_unknowns * sizeof *y);
        school_ok(contact_find(setup.residual->contact, setup.state, 0, y));
        double want = 0;
        for (int f = 0; f < setup.school->n_fish; f++) {
            for (int g = 0; g < f; g++)
                want += energy_of_pair(setup.school, &setup.school->fish[g], &setup.school->fish[f], y);
        }
        ABOVE(want, 1e-3);
        NEAR(energy_of_school(&setup, y), want, 0, 1e-12);
    }
}
