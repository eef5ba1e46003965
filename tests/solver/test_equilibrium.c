/* test_equilibrium.c: At the equilibrium of a body in a stream the total force vanishes, and the stiffness agrees with
 * differences (doc/steady.md, "Equilibria without a beat"). */
#include <stdio.h>
#include <stdlib.h>

#include "school.h"
#include "solver/equilibrium.h"

#define TIME "time: {end: 1, shedding_interval: 0.1}\n"
#define STREAM TIME "fluid: {density: 1, velocity: [1, 0.2], viscosity: 0}\n"
#define PLATE                                                                                                      \
    "nodes: 7, sheet_points: 13, force: pressure, pressure: {span: infinite}, wave: {amplitude: 0, frequency: 0}," \
    " body: {profile: uniform, thickness: 0.05, depth: 1, density: 20, modulus: 1e5},"                             \
    " start: {heading: 170, speed: 0}, motion: {prescribed: head, speed: 0}"

// two plates, one behind the other, with couplings
static const char pair[] = STREAM "defaults: {fish: {" PLATE "}}\nfish: [{}, {start: {position: [1.2, 0.1]}}]\n";

struct rig {
    struct simulation *simulation;
    struct equilibrium *equilibrium;
};

static struct rig rig_of(const char *text) {
    struct rig rig = {.simulation = school_simulation(text)};
    rig.equilibrium = equilibrium_create(rig.simulation->arena, rig.simulation->school, rig.simulation->state);
    return rig;
}

static void clear(struct rig *rig) {
    simulate_free(rig->simulation);
}

// the equations of the school, at the current state
static void value_of(const struct rig *rig, const struct residual_mode *mode, double *value) {
    const struct state *const state = rig->simulation->state;
    school_ok(residual_evaluate(rig->simulation->residual, mode, state->t, state->y, state->yp, value));
}

TEST(the_equations_of_a_run_hold_at_rest) {
    struct rig rig = rig_of(pair);
    const struct school *const school = rig.simulation->school;
    // what the bodies did before does not count
    for (int i = 0; i < school->n_unknowns; i++) rig.simulation->state->yp[i] = 3;
    for (int f = 0; f < 2; f++) {
        for (int i = school->fish[f].at.vx; i < school->fish[f].at.gamma; i++) rig.simulation->state->y[i] = 7;
    }
    school_ok(equilibrium_solve(rig.equilibrium));
    AT_MOST(equilibrium_residual(rig.equilibrium), 1e-10);
    // every equation of the school, not only those that have been solved, and with Kelvin's theorem
    double *const value = test_array(school->n_unknowns);
    value_of(&rig, &residual_run, value);
    for (int i = 0; i < school->n_unknowns; i++) {
        const enum unknown kind = residual_place(school, i).kind;
        NEAR(value[i], 0, kind == UNKNOWN_AX || kind == UNKNOWN_AY ? 1e-6 : 1e-9, 0);
    }
    for (int f = 0; f < 2; f++) {
        const double shed = rig.simulation->state->y[school->fish[f].at.circulation];
        ABOVE(fabs(shed), 0.1);
        assert_int_equal(rig.simulation->state->wake[f].n_vortex, 0);
        NEAR(rig.simulation->state->wake[f].removed, shed, 0, 0);
    }
    clear(&rig);
}

TEST(bodies_that_go_on_together_are_at_rest_in_their_frame) {
    struct rig held = rig_of(STREAM "fish: [{" PLATE "}]\n");
    struct rig goes = rig_of(TIME "fluid: {density: 1, velocity: [1.5, 0.2], viscosity: 0}\nfish: [{" PLATE "}]\n");
    // the frame moves at half a metre per second along x, the heading of the second plate
    for (int i = 0; i < 2; i++) {
        struct fish *const fish = &(i == 0 ? &held : &goes)->simulation->school->fish[0];
        fish->motion.pitch = 0.1;
        fish->motion.pitch_phase = 1.5707963267948966;
        fish->start_heading = 3.14159265358979323846;
    }
    goes.simulation->school->fish[0].motion.speed = -0.5;
    school_ok(equilibrium_solve(held.equilibrium));
    school_ok(equilibrium_solve(goes.equilibrium));
    const struct layout *const at = &held.simulation->school->fish[0].at;
    const double *const a = held.simulation->state->y, *const b = goes.simulation->state->y;
    for (int i = 0; i < at->end; i++) {
        const int along = (i >= at->vx && i < at->vy) || (i >= at->px && i < at->py);
        NEAR(b[i], a[i] + (along ? 0.5 : 0), 1e-9, 1e-9);
    }
    ABOVE(fabs(a[at->y + 6] - a[at->y]), 0.05);
    clear(&held);
    clear(&goes);
}

enum { MOST = 32 };

// the logarithm of the determinant of the last n - first rows and columns, by elimination from the last row on, which
// leaves the rows before the stop untouched
static double log_determinant(int n, int first, double matrix[MOST][MOST]) {
    double sum = 0;
    for (int i = n - 1; i >= first; i--) {
        int pivot = i;
        for (int k = first; k < i; k++) {
            if (fabs(matrix[k][i]) > fabs(matrix[pivot][i])) pivot = k;
        }
        for (int j = 0; j < n; j++) {
            const double value = matrix[i][j];
            matrix[i][j] = matrix[pivot][j];
            matrix[pivot][j] = value;
        }
        sum += log(fabs(matrix[i][i]));
        for (int k = 0; k < i; k++) {
            const double factor = matrix[k][i] / matrix[i][i];
            for (int j = 0; j <= i; j++) matrix[k][j] -= factor * matrix[i][j];
        }
    }
    return sum;
}

// positions of free nodes and sheets, and the equations, by differences; the shed vortex is far away
static int differences(const struct rig *rig, double matrix[MOST][MOST]) {
    const struct simulation *const simulation = rig->simulation;
    const struct fish *const fish = &simulation->school->fish[0];
    const struct layout *const at = &fish->at;
    double *const y = simulation->state->y, value[2][256];
    int n = 0, unknown[MOST], row[MOST];
    for (int i = 1; i < 2 * fish->n_nodes; i++) {
        if (i == fish->n_nodes) continue;  // the nose is prescribed
        unknown[n] = at->x + i;
        row[n++] = at->ax + i;
    }
    for (int i = at->gamma; i < at->phi0; i++, n++) unknown[n] = row[n] = i;
    AT_MOST(n, MOST);
    AT_MOST(at->end, 256);
    for (int j = 0; j < n; j++) {
        const double before = y[unknown[j]], step = 1e-6;
        for (int side = 0; side < 2; side++) {
            y[unknown[j]] = before + (side == 0 ? -step : step);
            wake_leave_behind(&simulation->state->wake[0], y[at->circulation]);
            value_of(rig, &equilibrium_mode, value[side]);
        }
        y[unknown[j]] = before;
        for (int i = 0; i < n; i++) matrix[i][j] = (value[1][row[i]] - value[0][row[i]]) / (2 * step);
    }
    return n;
}

static void stiffness_is_that_of_differences(const char *span, const char *fluid) {
    char text[1000];
    snprintf(text, sizeof text,
             TIME
             "fluid: {density: 1, viscosity: 0, %s}\n"
             "fish: [{nodes: 4, sheet_points: 9, force: pressure, pressure: {span: %s}, wave: {amplitude: 0, "
             "frequency: 0}, body: {profile: uniform, thickness: 0.05, depth: 1, density: 20, modulus: 1e5}, start: "
             "{heading: 170, speed: 0}, motion: {prescribed: head, speed: 0}}]\n",
             fluid, span);
    struct rig rig = rig_of(text);
    struct equilibrium_stiffness stiffness;
    double matrix[MOST][MOST];
    school_ok(equilibrium_solve(rig.equilibrium));
    school_ok(equilibrium_stiffness(rig.equilibrium, &stiffness));
    const int n_places = 6, n = differences(&rig, matrix);
    // after elimination of the sheets the positions remain
    log_determinant(n, n_places, matrix);
    NEAR(stiffness.log_determinant, log_determinant(n_places, 0, matrix), 1e-4, 0);
    assert_int_equal(stiffness.n_negative, 0);
    clear(&rig);
}

TEST(the_stiffness_is_that_of_differences_with_sheets_that_follow) {
    // two dimensions; rings with legs to infinity, and their images in a channel
    static const char *const spans[][2] = {{"infinite", "velocity: [1, 0.2]"},
                                           {"finite", "velocity: [1, 0.2]"},
                                           {"finite", "walls: [-1, 1.5], velocity: [1, 0]"}};
    for (size_t i = 0; i < sizeof spans / sizeof *spans; i++)
        stiffness_is_that_of_differences(spans[i][0], spans[i][1]);
}
TEST(only_displacements_that_grow_without_oscillation_are_counted) {
    // between the streams at which nothing and at which every bending displacement grows, the eigenvalues with a
    // negative real part are pairs: at 6 m/s one pair, at 12 m/s two
    static const struct {
        const char *stream;
        int n_negative;
    } rows[] = {{"2.5", 0}, {"6", 0}, {"12", 0}, {"40", 6}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[1000];
        snprintf(text, sizeof text, TIME "fluid: {density: 1, velocity: [%s, 0], viscosity: 0}\nfish: [{" PLATE "}]\n",
                 rows[i].stream);
        struct rig rig = rig_of(text);
        struct equilibrium_stiffness stiffness;
        school_ok(equilibrium_solve(rig.equilibrium));
        school_ok(equilibrium_stiffness(rig.equilibrium, &stiffness));
        assert_int_equal(stiffness.n_negative, rows[i].n_negative);
        clear(&rig);
    }
}

TEST(nothing_bends_where_the_whole_motion_is_given) {
    struct rig rig = rig_of(STREAM
                            "fish: [{nodes: 7, sheet_points: 13, force: pressure, pressure: {span: infinite},"
                            " wave: {amplitude: 0, frequency: 0}, start: {heading: 170, speed: 0},"
                            " motion: {prescribed: all, speed: 0}}]\n");
    struct equilibrium_stiffness stiffness;
    school_ok(equilibrium_solve(rig.equilibrium));
    school_ok(equilibrium_stiffness(rig.equilibrium, &stiffness));
    assert_int_equal(stiffness.n_negative, 0);
    NEAR(stiffness.log_determinant, 0, 0, 0);
    clear(&rig);
}
