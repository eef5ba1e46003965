/* test_pressure.c: Tests the added mass, the impulses and the force of the pressure (doc/model.md, section 15).
 * test_residual.c compares their derivatives with differences. */
#include <lapacke.h>
#include <stdio.h>
#include <stdlib.h>

#include "body/bending_mode.h"
#include "body/rod.h"
#include "fish/fish_school.h"
#include "force/pressure.h"
#include "school.h"

static const double pi = 3.14159265358979323846;

enum { MAX_NODES = 33 };

// a straight plate of span 1 and length 1 along x, in a fluid of density 1
static void build_plate(struct setup *setup, int nodes, int points, const char *more) {
    char text[1024];
    snprintf(text, sizeof text,
             "time: {end: 1, shedding_interval: 0.002}\nfluid: {density: 1, viscosity: 0}\n"
             "fish: [{nodes: %d, sheet_points: %d, force: pressure, pressure: {span: infinite}, wave: {amplitude: 0, "
             "frequency: 0},\n        body: {profile: uniform, thickness: 0.1, depth: 1, %s}}]\n",
             nodes, 2 * nodes - 1, more);
    setup->values = school_values(text);

    // the keys do not allow this value
    setup->values.school.fish[0].sheet_points = points;
    school_ok(fish_school_create(test_arena(), &setup->school, &setup->values.school));
    setup->state = state_create(test_arena(), setup->school);
    setup->arena = arena_create(test_arena(), "a test");
    setup->residual = residual_create(setup->arena, setup->school, setup->state);
    setup->value = NULL;
    setup->jacobian = NULL;
    setup->term = NULL;
}

// added momentum of the nodes across the plate, for these velocities across the plate and no shed circulation
static void added_momentum(struct setup *setup, const double *velocity, double *momentum) {
    const struct fish *fish = setup->school->fish;
    for (int k = 0; k < fish->n_nodes; k++) setup->state->y[fish->at.vy + k] = velocity[k];
    struct initial_conditions *solver;
    const struct residual_mode start = {.shed = SHED_IS_GIVEN, .velocities_are_given = true};
    school_ok(initial_conditions_create(test_arena(), &solver, setup->residual));
    school_ok(initial_conditions_solve(solver, &start, 0, setup->state->y, setup->state->yp));
    for (int k = 0; k < fish->n_nodes; k++) momentum[k] = setup->residual->force[0].momentum[fish->n_nodes + k];
}

// Heave: pi/4 rho L^2. Rotation about the middle: pi/128 rho L^4. The error of order M^-4 comes from the end
// correction, which assumes a sheet that sheds.
TEST(added_mass_of_a_plate_is_that_of_potential_flow) {
    const struct {
        int points;
        double heave, rotation;  // tolerances
    } cases[] = {{33, 3e-5, 1.2e-4}, {65, 4e-6, 1.5e-5}};
    for (int i = 0; i < 2; i++) {
        struct setup setup;
        build_plate(&setup, 17, cases[i].points, "density: 1");
        double velocity[2][MAX_NODES], momentum[MAX_NODES];
        const double want[2] = {pi / 4, pi / 128}, tolerance[2] = {cases[i].heave, cases[i].rotation};
        for (int k = 0; k < 17; k++) {
            velocity[0][k] = 1;
            velocity[1][k] = k / 16.0 - 0.5;
        }

        for (int motion = 0; motion < 2; motion++) {
            double mass = 0;
            added_momentum(&setup, velocity[motion], momentum);
            for (int k = 0; k < 17; k++) mass += momentum[k] * velocity[motion][k];
            NEAR(mass, want[motion], 0, tolerance[motion]);
        }
    }
}

// symmetric part of the matrix from velocities across the plate to momenta
static void added_mass(struct setup *setup, int nodes, double *symmetric) {
    double matrix[MAX_NODES * MAX_NODES];
    for (int i = 0; i < nodes; i++) {
        double velocity[MAX_NODES] = {0};
        velocity[i] = 1;
        added_momentum(setup, velocity, matrix + i * nodes);
    }
    for (int i = 0; i < nodes; i++) {
        for (int k = 0; k < nodes; k++) symmetric[i * nodes + k] = (matrix[i * nodes + k] + matrix[k * nodes + i]) / 2;
    }
}

// smallest eigenvalue of the symmetric part of the matrix from velocities across the plate to momenta
static double smallest_eigenvalue(int nodes, int points) {
    struct setup setup;
    build_plate(&setup, nodes, points, "density: 1");
    double symmetric[MAX_NODES * MAX_NODES], value[MAX_NODES];
    added_mass(&setup, nodes, symmetric);

    assert_int_equal(LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'U', nodes, symmetric, nodes, value), 0);
    return value[0];
}

TEST(added_mass_is_positive_with_twice_as_many_vortices_as_nodes_only) {
    NEAR(smallest_eigenvalue(17, 33), 1.6e-4, 0.1e-4, 0);
    NEAR(smallest_eigenvalue(7, 33), 1.1e-3, 0.1e-3, 0);
    BELOW(smallest_eigenvalue(17, 17), -1e-4);
}

// Ratios to the two-dimensional added mass, by an independent program (NumPy), with 65 points. Limits: w/L for a
// slender plate, 1 for a deep plate.
TEST(added_mass_of_a_plate_of_finite_span_lies_between_slender_and_deep) {
    static const struct {
        double depth, part;
    } cases[] = {{0.1, 0.0958}, {0.25, 0.2238}, {0.5, 0.3983}, {1, 0.6292},
                 {2, 0.8344},   {4, 0.9454},    {6, 0.9740},   {20, 0.9975}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct setup setup;
        char text[1024];
        snprintf(text, sizeof text,
                 "time: {end: 1, shedding_interval: 0.002}\nfluid: {density: 1, viscosity: 0}\n"
                 "fish: [{nodes: 17, sheet_points: 65, force: pressure, pressure: {span: finite},\n"
                 "  wave: {amplitude: 0, frequency: 0}, body: {profile: uniform, thickness: 0.1, depth: %g}}]\n",
                 cases[i].depth);
        school_build(&setup, text);
        double velocity[17], momentum[17], mass = 0, moment = 0, lift = 0;
        for (int k = 0; k < 17; k++) velocity[k] = 1;
        added_momentum(&setup, velocity, momentum);
        for (int k = 0; k < 17; k++) mass += momentum[k];
        for (int k = 0; k < 17; k++) moment += momentum[k] * (k / 16.0 - 0.5);

        // the last digit; half a per cent if the spacing of the points is not much smaller than the depth of the sheet
        NEAR(mass / (pi / 4 * cases[i].depth), cases[i].part, cases[i].depth < 0.2 ? 6e-4 : 6e-5, 0);

        // symmetry: heave causes no moment, and rotation causes no lift
        for (int k = 0; k < 17; k++) velocity[k] = k / 16.0 - 0.5;
        added_momentum(&setup, velocity, momentum);
        for (int k = 0; k < 17; k++) lift += momentum[k];
        NEAR(moment, lift, 2e-5 * mass, 0);
    }
}

// A smooth bend of a body of varying depth: the matrix from velocities to momenta is positive, and symmetric except for
// a term neglected by the model (2.5 per cent, doc/model.md, section 18). Constant depth: symmetric.
TEST(added_mass_of_finite_span_is_symmetric_and_positive) {
    enum { N = 9 };
    static const struct {
        const char *depth;
        double asymmetry;
    } cases[] = {{"profile: uniform, thickness: 0.1, depth: 0.25", 2e-4},
                 {"profile: table, thickness_table: [0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1], "
                  "depth_table: [0.12, 0.2, 0.24, 0.24, 0.2, 0.16, 0.18, 0.22]",
                  3e-2}};
    for (int i = 0; i < 2; i++) {
        struct setup setup;
        char text[1024];
        snprintf(text, sizeof text,
                 "time: {end: 1, shedding_interval: 0.002}\nfluid: {density: 1, viscosity: 0}\n"
                 "fish: [{nodes: 9, sheet_points: 65, force: pressure, pressure: {span: finite},\n"
                 "        wave: {amplitude: 0, frequency: 0}, body: {%s}}]\n",
                 cases[i].depth);
        school_build(&setup, text);
        double matrix[N * N], largest = 0, asymmetry = 0, value[N];
        for (int k = 0; k < N; k++) {
            double velocity[N] = {0};
            velocity[k] = 1;
            added_momentum(&setup, velocity, matrix + k * N);
        }

        for (int k = 0; k < N * N; k++) {
            largest = fmax(largest, fabs(matrix[k]));
            asymmetry = fmax(asymmetry, fabs(matrix[k] - matrix[k % N * N + k / N]));
        }

        BELOW(asymmetry, cases[i].asymmetry * largest);
        for (int k = 0; k < N * N; k++) {
            if (k % N >= k / N) matrix[k] = (matrix[k] + matrix[k % N * N + k / N]) / 2;
        }

        assert_int_equal(LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'U', N, matrix, N, value), 0);
        ABOVE(value[0], 1e-4 * largest);
    }
}

// modes of a free plate from the added-mass matrix, against the iteration of the warning of slow modes
TEST(slow_modes_have_the_added_mass_of_the_sheet) {
    enum { N = 17 };
    struct setup setup;
    build_plate(&setup, N, 33, "density: 1, modulus: 1.0e+4");
    const struct fish *fish = setup.school->fish;
    double mass[N * N], stiffness[N * N] = {0}, value[N], scratch[6 * N];
    added_mass(&setup, N, mass);
    for (int i = 0; i < N; i++) mass[i * N + i] += fish->mass[i];

    for (int j = 0; j < fish->n_joints; j++) {
        const double turn[3] = {1, -2, 1}, l = fish->edge_length;
        for (int i = 0; i < 9; i++) {
            stiffness[(j + i / 3) * N + j + i % 3] +=
                fish->bending_stiffness[j] / (l * l * l) * turn[i / 3] * turn[i % 3];
        }
    }

    assert_int_equal(LAPACKE_dsygv(LAPACK_ROW_MAJOR, 1, 'N', 'U', N, stiffness, N, mass, N, value), 0);

    // after translation and rotation
    NEAR(bending_mode_frequency(fish, scratch), sqrt(value[2]) / (2 * pi), 0, 0.01);
}

// A stream of 0.1 across a stiff free plate starts impulsively: with p conserved the plate velocity becomes 0.1 mu/(m +
// mu), mu = pi/4.
TEST(a_stream_that_starts_at_once_pushes_by_the_added_mass) {
    char body[128];
    const double mass = 0.1;
    snprintf(body, sizeof body, "density: %.17g, modulus: 1.0e+9, relaxation_time: 0.01", mass / (pi / 4 * 0.1));
    struct simulation *const simulation = school_simulation_of(
        "time: {end: 1, shedding_interval: 0.002}\nfluid: {density: 1, viscosity: 0, velocity: [0, 0.1]}\n"
        "fish: [{nodes: 17, force: pressure, pressure: {span: infinite}, wave: {amplitude: 0, frequency: 0},\n"
        "        body: {profile: uniform, thickness: 0.1, depth: 1, %s}}]\n",
        body);
    const struct fish *fish = simulation->school->fish;
    double *const y = simulation->state->y;

    // as in still fluid
    for (int i = fish->at.px; i < fish->at.ax; i++) y[i] = 0;
    school_ok(initial_conditions_solve(simulation->consistent, &residual_run, 0, y, simulation->state->yp));
    school_ok(simulation->integrator->restart(simulation->solver));
    school_run(simulation, 0.002);
    double velocity = 0;
    for (int k = 0; k < 17; k++) velocity += fish->mass[k] / fish->total_mass * y[fish->at.vy + k];

    // the difference is the lift of the circulation shed within 0.002 s
    NEAR(velocity, 0.1 * (pi / 4) / (mass + pi / 4), 0, 1.5e-3);
}

// the scale of the momenta: 1 + m_L L/m_k for the strip of the deeper end
TEST(momenta_scale_with_the_deeper_end) {
    static const char *const depths[] = {"0.1, 0.2, 0.2, 0.3", "0.3, 0.2, 0.2, 0.1"};
    for (int i = 0; i < 2; i++) {
        struct setup setup;
        char text[512];
        snprintf(text, sizeof text,
                 "time: {end: 1, shedding_interval: 0.02}\nfluid: {density: 800}\n"
                 "fish: [{nodes: 5, sheet_points: 21, length: 2, force: pressure, pressure: {span: infinite}, body: "
                 "{profile: table,\n    thickness_table: [0.1, 0.1, 0.1, 0.1], depth_table: [%s]}}]\n",
                 depths[i]);
        school_build(&setup, text);
        const struct fish *const fish = setup.school->fish;
        for (int k = 0; k < 5; k++) {
            const double per_length = acos(-1) / 4 * 800 * 0.3 * 2;
            NEAR(pressure_momentum_ratio(fish, k), 1 + per_length * 0.5 / fish->mass[k], 0, 1e-12);
        }
    }
}

// the force on the nodes equals the integral of the jump along the line, and the reactions of a prescribed body balance
// this force
TEST(force_and_reaction_are_those_of_the_jump) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 1, shedding_interval: 0.01}\nfluid: {density: 2, viscosity: 0}\n"
        "fish: [{force: pressure, pressure: {span: infinite}, wave: {amplitude: 0, frequency: 0}, "
        "start: {speed: 1}, body: {profile: uniform, thickness: 0.1, depth: 0.5},\n"
        "        motion: {prescribed: all, heave: 0.05, pitch: 5, frequency: 1}}]\n");
    school_measure(simulation, 0.3);
    const struct fish *fish = simulation->school->fish;
    const struct diagnostics_fish *of = simulation->diagnostics->fish;
    const struct pressure *pressure = simulation->residual->force[0].pressure;
    double sum[2] = {0, 0}, inertia[2] = {0, 0};
    for (int c = 0; c < fish->n_control; c++) {
        const struct direction *body = &pressure->point[c].body;
        const double jump = pressure_jump(pressure, c, simulation->state->y, simulation->state->yp);
        for (int i = 0; i < 2; i++) sum[i] -= 0.5 * jump * body->length * fish->control_interval[c] * body->n[i];
    }

    // near the tail the jump decreases to 0 like the square root of the distance, like theta, without oscillations
    const int last = fish->n_control - 1;
    double jump[8], step = 0;
    for (int i = 0; i < 8; i++) {
        jump[i] = pressure_jump(pressure, last - i, simulation->state->y, simulation->state->yp);
        if (i > 0) step += (jump[i] - jump[i - 1]) / 7;
    }

    NEAR(jump[0] - step / 2, 0, 2 * fabs(step), 0);
    for (int i = 1; i < 8; i++) NEAR(jump[i] - jump[i - 1], step, 0, 0.75);
    for (int k = 0; k < fish->n_nodes; k++) {
        for (int i = 0; i < 2; i++) {
            inertia[i] += fish->mass[k] * simulation->state->y[fish->at.ax + i * fish->n_nodes + k];
        }
    }

    double of_edges[2] = {0, 0};
    for (int k = 0; k < fish->n_edges; k++) {
        double force[2];
        pressure_of_edge(pressure, k, simulation->state->y, simulation->state->yp, force);
        for (int i = 0; i < 2; i++) of_edges[i] += force[i];
    }

    for (int i = 0; i < 2; i++) {
        NEAR(of_edges[i], sum[i], 0, 1e-12);

        // midpoint rule in theta, for a jump with a kink at the tail
        NEAR(sum[i], of->pressure.pressure[i], 1e-3 * fabs(of->pressure.pressure[1]), 0);
        NEAR(of->constraint_force[i], inertia[i] - of->pressure.pressure[i] - of->pressure.suction[i], 1e-9, 1e-9);
    }
}

TEST(the_pressure_acts_on_the_depth_of_an_edge) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 1, shedding_interval: 0.01}\n"
        "fish: [{nodes: 5, sheet_points: 21, pressure: {span: infinite}, body: {profile: table, thickness_table: [.1, "
        ".1, .1, .1], depth_table: [.2, .3, .5, .4]}, motion: {prescribed: all, pitch: 5, frequency: 1}}]\n");
    school_measure(simulation, 0.1);
    const struct fish *const fish = simulation->school->fish;
    const struct pressure *const pressure = simulation->residual->force[0].pressure;
    const double *const y = simulation->state->y, *const yp = simulation->state->yp;
    double want[4][2] = {{0}};
    for (int c = 0; c < fish->n_control; c++) {
        const struct direction *const body = &pressure->point[c].body;
        const int k = (int)(fish_mean(&fish->control_point[c], fish->arc) / fish->edge_length);
        const double size =
            fish->depth[k] * pressure_jump(pressure, c, y, yp) * body->length * fish->control_interval[c];
        for (int i = 0; i < 2; i++) want[k][i] -= size * body->n[i];
    }
    for (int k = 0; k < fish->n_edges; k++) {
        double force[2];
        pressure_of_edge(pressure, k, y, yp, force);
        NEAR_ARRAY(2, force, want[k], 1e-14, 1e-12);
    }
}

// a fish that is turned, or carried by a stream, swims as before
TEST(forces_turn_with_the_fish_and_a_stream_carries_them) {
    static const char *const spans[] = {"infinite", "finite"};
    static const struct { double heading, stream; } frames[] = {{0, 0}, {137, 0}, {0, 0.3}};
    for (int k = 0; k < 2; k++) {
        double want[6];
        for (int i = 0; i < 3; i++) {
            const double a = frames[i].heading * pi / 180, stream = frames[i].stream;
            struct simulation *const simulation = school_simulation_of(
                "time: {end: 1, shedding_interval: 0.01}\nfluid: {velocity: [%g, 0]}\nsolver: {rtol: 1.0e-9}\n"
                "fish: [{nodes: 7, sheet_points: 26, pressure: {span: %s}, start: {speed: %g, heading: %g}}]\n",
                stream, spans[k], 0.8 + stream, frames[i].heading);
            school_measure(simulation, 0.1);
            const struct diagnostics_fish *const of = simulation->diagnostics->fish;
            const double vector[3][2] = {{of->pressure.pressure[0], of->pressure.pressure[1]},
                                         {of->pressure.suction[0], of->pressure.suction[1]},
                                         {of->com_velocity[0] - stream, of->com_velocity[1]}};
            for (int n = 0; n < 6; n++) {
                const double *const of_frame = vector[n / 2];
                const double part = n % 2 == 0 ? of_frame[0] * cos(a) + of_frame[1] * sin(a)
                                               : of_frame[1] * cos(a) - of_frame[0] * sin(a);
                if (i == 0) want[n] = part;
                // rtol in the positions
                NEAR(part, want[n], 1e-6 * hypot(want[n / 2 * 2], want[n / 2 * 2 + 1]), 0);
            }
        }
    }
}

// ---- the limit of the suction

TEST(suction_law_has_its_limits_its_bound_and_its_derivatives) {
    // attached: error of the fourth power of the ratio; separated: the bound
    NEAR(pressure_suction_law(3e-4, 3).value, 3e-4, 0, 1e-15);
    NEAR(pressure_suction_law(0.5, 1).value, 0.5 / pow(1 + 1.0 / 16, 0.25), 0, 1e-15);
    NEAR(pressure_suction_law(3, 3e-4).value, 3e-4, 0, 1e-15);
    NEAR(pressure_suction_law(2, 2).value, 2 / pow(2, 0.25), 0, 1e-15);
    const double values[] = {1e-6, 0.02, 0.3, 0.9, 1, 1.1, 3.5, 2e4};
    enum { N = sizeof values / sizeof *values };
    for (int i = 0; i < N * N; i++) {
        const double a = values[i / N], b = values[i % N], h = 1e-5;
        const struct suction_law law = pressure_suction_law(a, b);
        ABOVE(law.value, 0);
        AT_MOST(law.value, fmin(a, b));
        ABOVE(law.by_full, 0);
        ABOVE(law.by_bound, 0);

        // homogeneous of degree 1 (Euler): the derivatives determine the value
        NEAR(law.by_full * a + law.by_bound * b, law.value, 0, 1e-14);
        const double by_full = pressure_suction_law(a * (1 + h), b).value - pressure_suction_law(a * (1 - h), b).value;
        const double by_bound = pressure_suction_law(a, b * (1 + h)).value - pressure_suction_law(a, b * (1 - h)).value;

        // second difference of a function of degree 1, and rounding
        NEAR(law.by_full * a, by_full / (2 * h), 1e-10 * law.value, 1e-8);
        NEAR(law.by_bound * b, by_bound / (2 * h), 1e-10 * law.value, 1e-8);
    }
}

// at rest: zero suction, and no NaN
TEST(suction_law_has_a_value_at_rest) {
    const double at[][2] = {{0, 0}, {0, 2}, {2, 0}, {1e-300, 1e-300}, {1e-310, 2}, {2, 1e-310}};
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        const struct suction_law law = pressure_suction_law(at[i][0], at[i][1]);
        AT_MOST(law.value, fmin(at[i][0], at[i][1]));
        AT_LEAST(law.value, 0);
        AT_LEAST(law.by_full, 0);
        AT_MOST(law.by_full, 1);
        AT_LEAST(law.by_bound, 0);
        AT_MOST(law.by_bound, 1);
    }
}

// a plate at an incidence in a stream, with this suction limit; the caller frees the setup
static struct simulation *inclined_plate(double degrees, double limit) {
    struct simulation *const simulation = school_simulation_of(
        "time: {end: 1, shedding_interval: 0.01}\nfluid: {density: 2, viscosity: 0}\n"
        "fish: [{force: pressure, pressure: {span: infinite, suction: 0.8, suction_limit: %g}, wave: {amplitude: "
        "0, frequency: 0},\n        start: {speed: 3}, body: {profile: uniform, thickness: 0.1, depth: 0.5},\n"
        "        motion: {prescribed: all, pitch: %g, pitch_phase: 90}}]\n",
        limit, degrees);
    school_measure(simulation, 0.1);
    return simulation;
}

static double size_of(const double force[2]) {
    return hypot(force[0], force[1]);
}

// A_0 = qhat/tau. Attached flow: the suction is S pi rho w L qhat^2, and the velocity past the nose is the velocity
// along the plate.
TEST(suction_of_a_plate_ends_at_its_limit) {
    const double scale = 0.8 * pi * 2 * 0.5, along = 3 * cos(20 * pi / 180);
    struct simulation *plate[4];
    const double limit[4] = {0, 1000, 0.15, 0.03};
    for (int i = 0; i < 4; i++) plate[i] = inclined_plate(20, limit[i]);
    const struct pressure_forces *const full = &plate[0]->diagnostics->fish[0].pressure;
    const double a0 = fabs(full->leading_edge_a0);
    ABOVE(a0, 0.15);

    // velocity along the plate induced by the wake, from the curvature of the wake
    NEAR(size_of(full->suction), scale * pow(along * a0, 2), 0, 0.02);
    NEAR(size_of(plate[1]->diagnostics->fish[0].pressure.suction), size_of(full->suction), 0, 1e-12);
    for (int i = 0; i < 4; i++) {
        const struct diagnostics_fish *const of = plate[i]->diagnostics->fish;
        const double ratio = i == 0 ? 0 : pow(a0 / limit[i], 2), part = pow(1 + pow(ratio, 4), -0.25);

        // prescribed motion: the suction limit does not change the circulation
        NEAR(of->pressure.leading_edge_a0, full->leading_edge_a0, 0, 1e-9);
        // of samples, with the flow of the last iterate of a step: the tolerance of Newton's iteration
        NEAR(of->leading_edge_most, a0, 0, 1e-7);
        NEAR(size_of(of->pressure.suction), part * size_of(full->suction), 0, 1e-9);
        NEAR(size_of(of->pressure.separation), (1 / 0.8 - part) * size_of(full->suction), 1e-9, 1e-9);

        // along the plate and forward, like the suction: 20 degrees to the direction of motion
        NEAR(of->pressure.separation[0], (1 / 0.8 - part) * full->suction[0], 1e-9, 1e-9);
        NEAR(of->pressure.separation[1], (1 / 0.8 - part) * full->suction[1], 1e-9, 1e-9);
        NEAR(of->pressure.separation_power, -3 * of->pressure.separation[0], 1e-9, 1e-9);

        // no period: instantaneous value
        NEAR(of->separation_share, limit[i] > 0 && a0 > limit[i], 0, 0);
    }

    ABOVE(plate[3]->diagnostics->fish[0].pressure.separation_power, 0);
}

// a free fish with nearly no suction: the energy balance is as accurate as without a limit
TEST(energy_balance_is_closed_where_the_limit_acts) {
    double imbalance[2];
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 2, shedding_interval: 0.02}\n"
            "fish: [{nodes: 9, sheet_points: 17, force: pressure, pressure: {span: infinite, suction_limit: %g},\n"
            "        body: {modulus: 3.0e+5}, wave: {ramp: 0.3}, start: {speed: 0.5}}]\n",
            i == 0 ? 0 : 0.003);
        school_measure(simulation, 1.5);
        const struct diagnostics_fish *const of = simulation->diagnostics->fish;
        imbalance[i] = fabs(of->energy_balance) / of->actuation_work;
        print_message("limit %s: imbalance over work %.2g, separated for %.2g of the period\n",
                      i == 0 ? "none" : "0.003", imbalance[i], of->separation_share);
        if (i == 0) {
            AT_MOST(of->separation_share, 0);
        } else {
            ABOVE(of->separation_share, 0.5);
        }
    }

    BELOW(imbalance[0], 1e-3);
    BELOW(imbalance[1], 1e-3);
}

// The jump of dC/dt alone, and the jump of the strengths in a stream along the plate, at control point c, for the
// circulation g dtheta with g = 1: singular at both ends, exact cosine series, no kink.
TEST(a_strength_that_is_singular_at_the_tail_has_no_kink) {
    struct setup setup;
    build_plate(&setup, 17, 33, "density: 1");
    const struct fish *const fish = setup.school->fish;
    struct pressure *const pressure = setup.residual->force[0].pressure;
    double *const y = setup.state->y, *const yp = setup.state->yp, u[64], v[64];
    const double speed = 3, h = pi / fish->n_control;
    struct flow_at_body flow = {.u = u, .v = v};
    for (int c = 0; c < fish->n_control; c++) {
        const struct direction body = fish_direction(fish, &fish->control_tangent[c], y);
        u[c] = speed * body.t[0];
        v[c] = speed * body.t[1];
    }

    for (int j = 0; j < fish->n_sheet; j++) {
        const bool is_end = j == 0 || j == fish->n_sheet - 1;
        y[fish->at.gamma + j] = (is_end ? 0.5 : 1) * h / fish->sheet_weight[j];
    }

    pressure_update(pressure, &flow, y);
    for (int c = 0; c < fish->n_control; c++) {
        const double theta = h * (c + 0.5);

        // the interval around the control point is dtheta sin(theta)/2 long
        const double length = h * sin(theta) / 2;
        NEAR(pressure_jump(pressure, c, y, yp), speed * h / length, 0, 1e-12);

        // C(theta) = theta
        const double now = pressure_jump(pressure, c, y, yp);
        for (int j = 0; j < fish->n_sheet; j++) yp[fish->at.gamma + j] = y[fish->at.gamma + j];
        NEAR(pressure_jump(pressure, c, y, yp) - now, theta, 1e-12, 0);
        for (int j = 0; j < fish->n_sheet; j++) yp[fish->at.gamma + j] = 0;
    }
}

// g = sin(theta) (1 - cos(theta)) has the kink of a sheet that goes on behind the tail: C = (1 - cos(theta))^2/2, for
// the rate of the circulation and, with finite span, for the flow that diverges
TEST(a_kink_at_the_tail_has_its_exact_circulation) {
    struct setup setup = setup_of(
        "time: {end: 1, shedding_interval: 0.01}\n"
        "fish: [{nodes: 17, sheet_points: 33, force: pressure, pressure: {span: finite},\n"
        "        body: {profile: uniform, thickness: 0.1, depth: 1}}]\n");
    const struct fish *const fish = setup.school->fish;
    struct pressure *const pressure = setup.residual->force[0].pressure;
    double *const y = setup.state->y, *const yp = setup.state->yp, zero[64] = {0}, div[64];
    const struct flow_at_body flow = {.u = zero, .v = zero, .div = div, .edge = zero};
    const double h = pi / fish->n_control;
    for (int i = 0; i < fish->at.gamma; i++) yp[i] = 0;
    for (int j = 0; j < fish->n_sheet; j++) {
        y[fish->at.gamma + j] = h * sin(h * j) * (1 - cos(h * j)) / fish->sheet_weight[j];
        yp[fish->at.gamma + j] = 0;
    }
    for (int c = 0; c < fish->n_control; c++) div[c] = 3 - 0.1 * c;
    pressure_update(pressure, &flow, y);
    for (int c = 0; c < fish->n_control; c++) {
        const double all = pow(1 - cos(h * (c + 0.5)), 2) / 2;
        NEAR(pressure_sheet_at(pressure, c, y, yp).spanwise, all * div[c], 1e-12, 0);
    }
    memcpy(yp + fish->at.gamma, y + fish->at.gamma, (size_t)fish->n_sheet * sizeof *y);
    for (int c = 0; c < fish->n_control; c++) {
        NEAR(pressure_sheet_at(pressure, c, y, yp).rate, pow(1 - cos(h * (c + 0.5)), 2) / 2, 1e-12, 0);
    }
}

// an update with the same input changes nothing, with any other value it does
TEST(an_update_repeats_only_for_new_input) {
    struct setup setup = setup_of(
        "time: {end: 1, shedding_interval: 0.01}\n"
        "fish: [{nodes: 17, sheet_points: 33, force: pressure, pressure: {span: finite}}]\n");
    const struct fish *const fish = setup.school->fish;
    struct pressure *const pressure = setup.residual->force[0].pressure;
    double *const y = setup.state->y, *const yp = setup.state->yp, flow_of[5][64];
    const struct flow_at_body flow = {
        .u = flow_of[0], .v = flow_of[1], .div = flow_of[2], .edge = flow_of[3], .edge_stride = 64};
    for (int k = 0; k < 5; k++) {
        for (int c = 0; c < 64; c++) flow_of[k][c] = 0.1 * k + 0.01 * c;
    }
    for (int j = 0; j < fish->n_sheet; j++) y[fish->at.gamma + j] = yp[fish->at.gamma + j] = 0.1 + 0.01 * j;

    const int last = fish->n_control - 1;
    double *const input[] = {&y[fish->at.y + 3], &y[fish->at.vx],   &y[fish->at.vy + 8], &y[fish->at.gamma + last],
                             &flow_of[0][0],     &flow_of[1][last], &flow_of[2][1],      &flow_of[3][last],
                             &flow_of[4][last]};
    for (size_t i = 0; i < sizeof input / sizeof *input; i++) {
        for (int is_new = 0; is_new < 2; is_new++) {
            pressure_update(pressure, &flow, y);
            pressure_update_rate(pressure, y, yp);
            pressure->force[0] = pressure->momentum_rate[0] = 1e9;
            if (is_new) *input[i] += 1e-15 * (1 + fabs(*input[i]));
            pressure_update(pressure, &flow, y);
            pressure_update_rate(pressure, y, yp);
            assert_int_equal(pressure->force[0] < 1e9, is_new);
            assert_int_equal(pressure->momentum_rate[0] < 1e9, is_new);
        }
    }

    // the rate follows its own input too
    pressure->momentum_rate[0] = 1e9;
    yp[fish->at.gamma + last] += 1e-3;
    pressure_update_rate(pressure, y, yp);
    BELOW(pressure->momentum_rate[0], 1e9);
}

// a soft free fish starts to beat: energy balance, and momentum against forces
TEST(energy_and_momentum_of_a_free_fish_are_accounted_for) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 1, shedding_interval: 0.01}\nsolver: {rtol: 1.0e-6}\n"
        "fish: [{nodes: 9, sheet_points: 17, force: pressure, pressure: {span: infinite}, body: "
        "{modulus: 3.0e+4}, wave: {ramp: 0.3}, start: {speed: 0.5}}]\n");
    const struct fish *fish = simulation->school->fish;
    const struct diagnostics_fish *of = simulation->diagnostics->fish;

    // momentum at five events, forces at the middle one
    double momentum[5], force = 0;
    for (int n = 0; n < 5; n++) {
        school_measure(simulation, 0.48 + 0.01 * n);
        momentum[n] = fish->total_mass * of->com_velocity[1];
        if (n == 2) force = of->resistive_force[1] + of->pressure.pressure[1] + of->pressure.suction[1];
    }

    // 0.3 % of the largest force, 6 N
    const double rate = (momentum[0] - 8 * momentum[1] + 8 * momentum[3] - momentum[4]) / (12 * 0.01);
    NEAR(force, rate, 0.02, 0);

    BELOW(fabs(of->energy_balance), 1e-3 * of->actuation_work);
    ABOVE(of->actuation_work, 0.1);
}
