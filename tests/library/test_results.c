/* test_results.c: the variables of tests/data/results.tsv, fourteen of each of fifteen short runs and three steady
 * states, in which all terms of the model act at once; and, more precisely, all variables after two intervals with each
 * key changed, against tests/data/key_results.tsv. Independent tests verify the terms; this test notices every change
 * of a result, which CHANGES.md promises to state. After an intended change:
 *
 *     build/tests/library/test_results --write
 */
#include <netcdf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "case/case.h"
#include "case/case_table.h"
#include "near.h"
#include "shoal.h"
#include "steady/steady.h"

static const char table[] = "tests/data/results.tsv", key_table[] = "tests/data/key_results.tsv";

/* Over the sum of the magnitudes. The runs have rtol 1e-8: with fused multiplications these variables change by less
 * than 2e-7, all variables after two intervals by less than 1e-11. On another processor the integrator may choose
 * another step: arm64 with SUNDIALS 7 differs by 1.8e-6. */
#ifdef __x86_64__
static const double tolerance = 1e-6, of_keys = 1e-7;
#else
static const double tolerance = 1e-5, of_keys = 1e-5;
#endif
static const double of_differences = 1e-2;

#define BODY "defaults: {fish: {body: {thickness: 0.2, depth: 0.25, modulus: 1e6}}}\n"
#define TIME "format: 1\ntime: {end: 0.3, shedding_interval: 0.0125}\nsolver: {rtol: 1e-8}\n" BODY
#define STREAM "fluid: {velocity: [0.2, -0.1], shear: 0.3, gust: {amplitude: 0.15, frequency: 2.2}}\n"
#define FISH "nodes: 5, sheet_points: 17, wave: {frequency: 4, phase: 20}"
#define SLENDER "force: reactive, " FISH

static const struct run {
    const char *name, *text;
} runs[] = {
    {"reactive", TIME STREAM
     "wake: {lifetime: 0.16, decay: 0.09}\noutput: {forces: edges}\n"
     "fish: [{" SLENDER ", start: {heading: 170, speed: 0.8}, control: {bias: 0.3}, drag: {skin: boundary_layer}},\n"
     "    {force: reactive, nodes: 6, sheet_points: 15, length: 0.7, start: {position: [0.3, 0.5], heading: 200, "
     "speed: 0.5},\n"
     "     wave: {frequency: 3, wavelength: 0.8}, body: {profile: uniform, thickness: 0.1, relaxation_time: 0.02},\n"
     "     drag: {law: linear_quadratic, linear_speed: 0.3}}]\n"},
    {"pressure", TIME STREAM
     "wake: {lifetime: 0.2, spare_vortices: 6, vortices: [[0.5, 0.4, 0.05], [-0.4, -0.3, -0.04]]}\n"
     "output: {forces: edges}\nfish: [{" FISH
     ", force: pressure, start: {heading: 170, speed: 0.6}, pressure: {span: infinite, suction_limit: 0.12},\n"
     "     drag: {skin: boundary_layer, transition: 1e5}},\n"
     "    {nodes: 6, sheet_points: 19, length: 1.2, force: pressure, pressure: {span: infinite}, start: {position: "
     "[0.2, 0.7], speed: 0.7},\n     wave: {frequency: 3}, drag: {skin: laminar}}]\n"},
    {"span", TIME
     "fluid: {walls: [-0.6], velocity: [0.1, 0], shear: 0.2}\nwake: {lifetime: 0.2, decay: 0.1}\n"
     "fish: [{nodes: 5, sheet_points: 21, wave: {frequency: 4}, force: pressure, pressure: {span: finite}, start: "
     "{speed: 0.6}},\n"
     "    {nodes: 5, sheet_points: 27, length: 0.8, force: pressure, pressure: {span: finite}, start: {position: [0.2, "
     "0.6],\n     heading: 190, speed: 0.9}, wave: {frequency: 4}, body: {profile: table, thickness_table: [0.05, 0.1, "
     "0.08,\n     0.04], depth_table: [0.16, 0.2, 0.18, 0.22]}}]\n"},
    {"channel", TIME "fluid: {walls: [-0.5, 0.8], velocity: [0.3, 0]}\nwake: {lifetime: 0.2}\ncontact: {range: 0.05}\n"
                     "fish: [{" SLENDER ", start: {heading: 160, speed: 0.9}},\n"
                     "    {nodes: 6, sheet_points: 13, length: 0.8, force: pressure, pressure: {span: infinite}, "
                     "start: {position: [0.3, 0.5], heading: 190},\n     wave: {frequency: 3}}]\n"},
    {"published",
     "format: 1\ntime: {end: 0.3, shedding_interval: 0.0125}\nsolver: {method: rk4, step: 2.5e-4}\npreset: published\n"
     "fluid: {velocity: [0.2, 0.1]}\nwake: {lifetime: 0.1, removed_circulation: dropped}\n"
     "defaults: {fish: {drag: {normal: 0.5}}}\n"
     "fish: [{sheet_points: 15, wave: {frequency: 4, ramp: 0.2}, start: {speed: 0.7}},\n"
     "    {sheet_points: 13, length: 0.8, wave: {frequency: 3, ramp: 0}, start: {position: [0.2, 0.6], speed: 0.5,\n"
     "     heading: 170},\n     control: {law: heading, desired_heading: [[0, 170], [0.3, 150]], feedforward: 0.5, "
     "filter: 0.2}}]\n"},
    {"steered", TIME STREAM
     "wake: {shedding: continuous, removed_circulation: dropped, lifetime: 0.12, decay: 0.05}\n"
     "fish: [{" SLENDER ", start: {speed: 0.8}, control: {law: heading, waypoints: [[-0.3, 0.2], [-1, -1]],\n"
     "     acceptance_radius: 0.3, gain: 1.5, limit: 0.8}},\n"
     "    {" SLENDER ", length: 0.9, start: {position: [0.2, 0.6], speed: 0.6}, control: {law: averaged_heading,\n"
     "     desired_heading: 150, rate: 2, feedforward: 30, filter: 0.2}},\n    {" SLENDER
     ", start: {position: [0.1, -0.7], speed: 0.7}, control: {law: course, desired_heading: 200, damping: 0.1}}]\n"},
    {"driven", TIME
     "fluid: {velocity: [0.4, 0.1], shear: 0.5}\noutput: {forces: edges}\n"
     "fish: [{" FISH ", force: pressure, pressure: {span: infinite}, motion: {prescribed: head, heave: 0.05, pitch: "
     "10, pitch_phase: 80,\n"
     "     frequency: 4, pivot: 0.2}, load: {tip: [3, -8]}, body: {damping: curvature, relaxation_time: 0.01}},\n"
     "    {" SLENDER ", start: {position: [0.2, 0.7]}, motion: {prescribed: all, heave: 0.1, pitch: 20, frequency: 4,\n"
     "     speed: 0.5}},\n    {" SLENDER
     ", start: {position: [0.1, -0.7], heading: 180, speed: 0.4}, motion: {prescribed: head, surge: free,\n"
     "     heave: 0.05, frequency: 4}}]\n"},
    {"contact", "format: 1\ntime: {end: 0.2, shedding_interval: 0.0125}\nsolver: {rtol: 1e-8}\n" BODY
                "fluid: {walls: [-0.1]}\nwake: {shedding: continuous, taper: 0, taper_beside: 0, lifetime: 0.1}\n"
                "contact: {range: 0.06}\n"
                "fish: [{" SLENDER ", start: {position: [0, 0.04], speed: 0.6}, body: {modulus: 2e6}},\n"
                "    {" SLENDER ", length: 0.8, start: {position: [0.1, 0.34], heading: 176, speed: 0.5}}]\n"},
    {"explicit",
     "format: 1\ntime: {end: 0.2, shedding_interval: 0.0125}\nsolver: {method: rk4, step: 2.5e-4}\n" BODY
     "fluid: {density: 800, velocity: [0.1, 0.1]}\nwake: {shedding: impulsive, lifetime: 0.1}\n"
     "fish: [{" SLENDER ", start: {speed: 0.8}, control: {bias: -0.2}, body: {modulus: 1e5, density: 1200}},\n"
     "    {" SLENDER ", start: {position: [0.2, 0.8], speed: 0.5}, body: {modulus: 1e5}}]\n"},
    {"explicit_sheet",
     "format: 1\ntime: {end: 0.2, shedding_interval: 0.0125}\nsolver: {method: heun, step: 2.5e-4}\n" BODY
     "wake: {lifetime: 0.1}\nfish: [{" SLENDER ", start: {speed: 0.8}, body: {modulus: 1e5}}]\n"},
    {"trapezoid",
     "format: 1\ntime: {end: 0.2, shedding_interval: 0.0125}\nsolver: {method: trapezoid, step: 1.25e-3}\n" BODY STREAM
     "wake: {lifetime: 0.1}\noutput: {forces: edges}\n"
     "fish: [{" FISH ", force: pressure, pressure: {span: infinite}, start: {heading: 170, speed: 0.8}, drag: {skin: "
     "boundary_layer}},\n    {" SLENDER
     ", length: 0.8, start: {position: [0.2, 0.6], speed: 0.5}, control: {law: heading, desired_heading: 170}}]\n"},
    {"implicit_euler",
     "format: 1\ntime: {end: 0.2, shedding_interval: 0.0125}\nsolver: {method: implicit_euler, step: 1.25e-3}\n" BODY
     "wake: {lifetime: 0.1}\n"
     "fish: [{" FISH ", force: pressure, pressure: {span: infinite}, motion: {prescribed: head, heave: 0.05, pitch: "
     "10, frequency: 4}}]\n"},
    {"dormand_prince",
     "format: 1\ntime: {end: 0.2, shedding_interval: 0.0125}\nsolver: {method: dormand_prince, rtol: 1e-9}\n" BODY
         STREAM "wake: {lifetime: 0.1, shedding: continuous}\n"
     "fish: [{" SLENDER
     ", start: {speed: 0.8}, body: {modulus: 1e5, density: 1200}, added_mass: {extent: thickness}},\n"
     "    {" SLENDER ", body: {modulus: 1e5}, motion: {prescribed: head, surge: free, heave: 0.05, frequency: 4},\n"
     "     start: {position: [0.2, 0.7], speed: 0.5}}]\n"},
    {"explicit_pressure",
     "format: 1\ntime: {end: 0.1, shedding_interval: 0.0125}\nsolver: {method: rk4, step: 2.5e-4}\n" BODY STREAM
     "wake: {lifetime: 0.1}\n"
     "fish: [{" FISH ", force: pressure, pressure: {span: infinite}, body: {modulus: 1e5}, load: {tip: [1, 2]},\n"
     "     motion: {prescribed: head, heave: 0.05, pitch: 10, frequency: 4}}]\n"},
    {"changed", TIME STREAM
     "wake: {lifetime: 0.25, decay: 0.1, spare_vortices: 9}\nfish: [{" SLENDER ", start: {heading: 170, speed: 0.8}},\n"
     "    {" FISH ", force: pressure, pressure: {span: infinite}, start: {position: [0.2, 0.7], speed: 0.6}}]\n"},
    {"tapered", TIME
     "fluid: {velocity: [0.3, -0.1]}\nwake: {lifetime: 0.15, decay: 0.07, taper: 0.3, taper_beside: 0.2}\n"
     "contact: {range: 0.16}\noutput: {forces: edges}\n"
     "fish: [{nodes: 6, sheet_points: 51, wave: {frequency: 4}, start: {heading: 190, speed: 0.6}, control: {law: "
     "course,\n     desired_heading: 170}, body: {profile: table, thickness_table: [0.06, 0.11, 0.09, 0.06, 0.04],\n"
     "     depth_table: [0.12, 0.2, 0.18, 0.16, 0.24], damping: curvature}, sensors: [0.2, 0.7]},\n"
     "    {nodes: 5, sheet_points: 57, length: 1.2, start: {position: [-0.1, 0.24], speed: 0.9}, wave: {frequency: "
     "3},\n"
     "     body: {profile: table, thickness_table: [0.05, 0.1, 0.09, 0.04], depth_table: [0.22, 0.3, 0.2, 0.13]},\n"
     "     drag: {normal: 0.5, waving: 1.2, form: 1.3, transition: 1e5}, load: {tip: [2, -3]}},\n"
     "    {nodes: 5, sheet_points: 53, start: {position: [0.1, -0.6]}, motion: {prescribed: head, surge: free, heave: "
     "0.06,\n     pitch: 15, pitch_phase: 70, frequency: 4, pivot: 0.2}, body: {depth: 0.15}}]\n"},
    // names with "steady": steady states
    {"steady_equilibrium",
     "format: 1\ntime: {end: 1, shedding_interval: 0.05}\nsolver: {rtol: 1e-8}\n" BODY
     "fluid: {density: 2, velocity: [0.8, 0.2], shear: 0.3, viscosity: 0}\nwake: {lifetime: 2, decay: 0.5}\n"
     "fish: [{nodes: 6, sheet_points: 17, force: pressure, pressure: {span: infinite}, wave: {amplitude: 0.2, "
     "constant: 1, linear: 0.5, frequency: 0},\n     control: {bias: 0.4}, motion: {prescribed: head}, body: {modulus: "
     "4e4, profile: uniform, thickness: 0.03},\n     start: {heading: 175}, load: {tip: [0.01, 0.02]}},\n"
     "    {force: reactive, nodes: 5, sheet_points: 13, length: 0.7, wave: {frequency: 0, amplitude: 0}, motion: "
     "{prescribed: all},\n     start: {position: [0.3, 0.8], heading: 160}}]\n"},
    {"steady_circle",
     "format: 1\ntime: {end: 1, shedding_interval: 0.05}\nsolver: {rtol: 1e-8}\n" BODY
     "fluid: {velocity: [0.2, 0.1]}\nsteady: {tolerance: 1e-6}\n"
     "fish: [{force: reactive, nodes: 6, sheet_points: 13, start: {speed: 0.9}, control: {bias: 0.2}, drag: {normal: "
     "1}}]\n"},
    {"steady_held",
     "format: 1\ntime: {end: 1, shedding_interval: 0.05}\nsolver: {rtol: 1e-8}\n" BODY
     "fluid: {velocity: [0.9, 0.1]}\nsteady: {tolerance: 1e-6}\n"
     "fish: [{nodes: 6, sheet_points: 17, force: pressure, pressure: {span: infinite}, wave: {amplitude: 0.1},\n"
     "     motion: {prescribed: head, heave: 0.1, pitch: 12, pitch_phase: 80, frequency: 1}}]\n"},
    {"steady_tapered",
     "format: 1\ntime: {end: 1, shedding_interval: 0.05}\nsolver: {rtol: 1e-8}\n"
     "fluid: {density: 20, velocity: [0.9, -0.3]}\nwake: {lifetime: 2, decay: 0.5}\n"
     "fish: [{nodes: 6, sheet_points: 51, wave: {amplitude: 0, constant: 0.5, frequency: 0}, motion: {prescribed: "
     "head},\n"
     "     start: {heading: 170}, body: {profile: table, thickness_table: [0.06, 0.08, 0.06, 0.04, 0.03], depth_table: "
     "[0.12,\n     0.2, 0.18, 0.16, 0.24], modulus: 1e5}}]\n"},
    {"steady_rate",
     "format: 1\ntime: {end: 1, shedding_interval: 0.05}\nsolver: {rtol: 1e-8}\n" BODY
     "fluid: {density: 100, velocity: [0.9, 0.1]}\nwake: {shedding: continuous, lifetime: 2, decay: 0.5}\n"
     "sheet: {kutta: rate}\n"
     "fish: [{force: reactive, nodes: 5, sheet_points: 17, wave: {amplitude: 0, frequency: 0}, motion: {prescribed: "
     "head}, "
     "body: {modulus: 1e5}}]\n"},
};
enum { N_RUNS = sizeof runs / sizeof *runs, MAX_VARIABLES = 200, MAX_ROWS = 500 };

/* The values of a variable, as one number: a sum with weights that differ, and the sum of the magnitudes. NaN counts as
 * a number of its own. */
struct entry {
    char run[32], name[NC_MAX_NAME + 1];
    double sum, size;
};

static void entry_add(struct entry *entry, size_t i, double value) {
    const double weight = 1 + 0.5 * cos(1.3 * (double)i), term = weight * (isnan(value) ? 1e-3 : value);
    entry->sum += term;
    entry->size += fabs(term);
}

static struct entry entry_of(struct shoal *run, const char *name) {
    struct entry entry = {.size = 0};
    struct shoal_array array;
    if (shoal_read(run, name, &array) != SHOAL_OK) fail_msg("%s: %s", name, shoal_message());
    size_t n = 1;
    for (int d = 0; d < array.n_dimensions; d++) n *= array.shape[d];
    for (size_t i = 0; i < n; i++) {
        const double value = array.type == SHOAL_INT    ? ((const int *)array.values)[i]
                             : array.type == SHOAL_LONG ? (double)((const long *)array.values)[i]
                                                        : ((const double *)array.values)[i];
        entry_add(&entry, i, value);
    }
    return entry;
}

// numbers of the machine, numbers and errors of steps, and sums that are zero but for rounding
static int is_left_out(const char *name) {
    static const char *const names[] = {"wall_time",
                                        "steps",
                                        "residual_evaluations",
                                        "newton_iterations",
                                        "order",
                                        "jacobian_evaluations",
                                        "error_test_failures",
                                        "step_size",
                                        "convergence_failures",
                                        "steps_of_order",
                                        "klu_analyses",
                                        "klu_factorisations",
                                        "klu_refactorisations",
                                        "gmres_iterations",
                                        "initial_iterations",
                                        "jacobian_non_zeros",
                                        "factor_non_zeros",
                                        "differential_unknowns",
                                        "algebraic_unknowns",
                                        "total_circulation",
                                        "energy_balance",
                                        "momentum_balance",
                                        "angular_momentum_balance",
                                        "steady_beats",
                                        "steady_residual",
                                        "steady_error",
                                        "steady_multiplier_beats"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strcmp(names[i], name) == 0) return 1;
    }
    return 0;
}

/* The changes of a program, at a third of the run. */
static void change(struct shoal *run) {
    double x[10], v[10];
    assert_int_equal(shoal_set(run, 0, "wave.amplitude", 1, &(double){0.5}), SHOAL_OK);
    assert_int_equal(shoal_set(run, 0, "wave.frequency", 1, &(double){5}), SHOAL_OK);
    assert_int_equal(shoal_set(run, 1, "control.bias", 1, &(double){0.2}), SHOAL_OK);
    assert_int_equal(shoal_state(run, 0, x, v), SHOAL_OK);
    for (int k = 0; k < 5; k++) {
        x[2 * k] += 0.02;
        v[2 * k + 1] -= 0.1;
    }
    assert_int_equal(shoal_set_state(run, 0, x, v), SHOAL_OK);
    assert_int_equal(shoal_add_vortex(run, 1, 0.4, 0.2, 0.05), SHOAL_OK);
}

/* The variables of a steady state that the rows of a run lack. */
static int find_steady_entries(const struct run *of, struct entry *entry) {
    char path[] = "/tmp/test_results_XXXXXX";
    close(mkstemp(path));
    unlink(path);
    struct case_values values;
    const struct steady_options options = {.path = path, .command = "test"};
    if (case_parse(&values, of->text, strlen(of->text), of->name, NULL, 0, NULL) != STATUS_OK ||
        steady_run(&values, &options) != STATUS_OK) {
        fail_msg("%s: %s", of->name, status_message());
    }
    case_free(&values);

    int file, n_variables, n = 0;
    assert_int_equal(nc_open(path, NC_NOWRITE, &file), NC_NOERR);
    assert_int_equal(nc_inq_nvars(file, &n_variables), NC_NOERR);
    for (int i = 0; i < n_variables; i++) {
        struct entry *const to = &entry[n];
        int n_dimensions, dimension[NC_MAX_VAR_DIMS];
        nc_type type;
        size_t n_values = 1, length;
        *to = (struct entry){.size = 0};
        nc_inq_var(file, i, to->name, &type, &n_dimensions, dimension, NULL);
        for (int d = 0; d < n_dimensions; d++) {
            nc_inq_dimlen(file, dimension[d], &length);
            n_values *= length;
        }
        // the number of beats of a search, and so all times, depend on rounding
        if (type == NC_CHAR || is_left_out(to->name) || strncmp(to->name, "steady_", 7) != 0) continue;
        double *const value = calloc(n_values, sizeof *value);
        assert_int_equal(nc_get_var_double(file, i, value), NC_NOERR);
        for (size_t k = 0; k < n_values; k++) entry_add(to, k, value[k]);
        free(value);
        snprintf(to->run, sizeof to->run, "%s", of->name);
        assert_in_range(++n, 0, MAX_VARIABLES - 1);
    }
    nc_close(file);
    unlink(path);
    return n;
}

static int find_entries(const struct run *of, struct entry *entry) {
    if (strncmp(of->name, "steady", 6) == 0) return find_steady_entries(of, entry);
    struct shoal *run;
    if (shoal_open_text(&run, of->text, NULL, 0, NULL) != SHOAL_OK) fail_msg("%s: %s", of->name, shoal_message());
    if (strcmp(of->name, "changed") == 0) {
        assert_int_equal(shoal_advance(run, 0.1), SHOAL_OK);
        change(run);
    }
    if (shoal_advance(run, shoal_end(run)) != SHOAL_OK) fail_msg("%s: %s", of->name, shoal_message());
    int n = 0;
    for (int i = 0; shoal_variable(i); i++) {
        const char *const name = shoal_variable(i);
        struct shoal_array array;
        if (is_left_out(name) || strncmp(name, "steady_", 7) == 0) continue;
        assert_int_equal(shoal_read(run, name, &array), SHOAL_OK);
        if (array.type == SHOAL_CHAR) continue;
        assert_in_range(n, 0, MAX_VARIABLES - 1);
        entry[n] = entry_of(run, name);
        snprintf(entry[n].run, sizeof entry[n].run, "%s", of->name);
        snprintf(entry[n++].name, sizeof entry[n].name, "%s", name);
    }
    shoal_close(run);
    return n;
}

/* Print the variables that have values in some run, but no row. Returns their number. */
static int count_missing(const struct entry *row, int n_rows, struct entry all[N_RUNS][MAX_VARIABLES],
                         const int n[N_RUNS]) {
    int n_missing = 0;
    for (int r = 0; r < N_RUNS; r++) {
        for (int i = 0; i < n[r]; i++) {
            int is_known = !(all[r][i].size > 0);
            for (int k = 0; k < n_rows && !is_known; k++) is_known = strcmp(row[k].name, all[r][i].name) == 0;
            for (int k = 0; k < r && !is_known; k++) {
                for (int j = 0; j < n[k] && !is_known; j++) {
                    is_known = all[k][j].size > 0 && strcmp(all[k][j].name, all[r][i].name) == 0;
                }
            }
            if (is_known) continue;
            n_missing++;
            print_error("%s %s 0 0: no row has this variable\n", all[r][i].run, all[r][i].name);
        }
    }
    return n_missing;
}

/* The row of each line of the table, with its values now; prints a row that no run has. Returns the number of rows. */
static int find_rows(struct entry want[MAX_ROWS], struct entry got[MAX_ROWS], int *n_missing) {
    static struct entry all[N_RUNS][MAX_VARIABLES];
    int n[N_RUNS], n_rows = 0;
    for (int r = 0; r < N_RUNS; r++) n[r] = find_entries(&runs[r], all[r]);
    FILE *const file = fopen(table, "r");
    assert_non_null(file);
    char line[256];
    while (fgets(line, sizeof line, file)) {
        struct entry *const row = &want[n_rows];
        if (sscanf(line, "%31s %255s %lf %lf", row->run, row->name, &row->sum, &row->size) != 4) continue;
        got[n_rows] = (struct entry){.sum = NAN};
        for (int r = 0; r < N_RUNS; r++) {
            for (int i = 0; i < n[r]; i++) {
                const struct entry *const now = &all[r][i];
                if (strcmp(row->run, now->run) == 0 && strcmp(row->name, now->name) == 0) got[n_rows] = *now;
            }
        }
        assert_in_range(++n_rows, 0, MAX_ROWS - 1);
    }
    fclose(file);
    *n_missing = count_missing(want, n_rows, all, n);
    return n_rows;
}

/* The same rows with the values of now. For a new row add its first two words and two zeros to the table before. */
static int write_table(void) {
    static struct entry want[MAX_ROWS], got[MAX_ROWS];
    int n_missing;
    const int n = find_rows(want, got, &n_missing);
    FILE *const file = fopen(table, "w");
    assert_non_null(file);
    fputs("# Sums over the values of a variable of short runs: tests/library/test_results.c --write\n", file);
    for (int i = 0; i < n; i++) {
        fprintf(file, "%s %s %.9g %.3g\n", want[i].run, want[i].name, got[i].sum, got[i].size);
    }
    return fclose(file);
}

TEST(results_of_short_runs_stay) {
    static struct entry want[MAX_ROWS], got[MAX_ROWS];
    int n_missing, n_wrong = 0;
    const int n = find_rows(want, got, &n_missing);
    double worst = 0;
    for (int i = 0; i < n; i++) {
        // multipliers and growth rates are quotients of small differences
        const int is_difference = strstr(want[i].name, "multiplier") || strstr(want[i].name, "growth") ||
                                  strstr(want[i].name, "exponent") || strstr(want[i].name, "mode") ||
                                  strstr(want[i].name, "amplification");
        const double off = fabs(got[i].sum - want[i].sum) / want[i].size;
        if (!is_difference) worst = fmax(worst, off);
        if (off <= (is_difference ? of_differences : tolerance)) continue;
        n_wrong++;
        print_error("%s: %s changes from %.9g to %.9g\n", want[i].run, want[i].name, want[i].sum, got[i].sum);
    }
    print_message("%d values, largest relative difference %.1e\n", n, worst);
    assert_in_range(n, 12 * N_RUNS, MAX_ROWS);
    assert_int_equal(n_wrong, 0);
    assert_int_equal(n_missing, 0);
}

// ---- every key

/* Two intervals of a school in which most keys act. In place of %: sheet points and forces of fish 0, 1 and 2, and
 * what only some forces allow. */
static const char school[] =
    "format: 1\ntime: {end: 0.02, shedding_interval: 0.01}\nsolver: {rtol: 1e-8}\n" BODY
    "fluid: {velocity: [0.2, -0.1]%s}\nwake: {lifetime: 0.3, decay: 0.295}\noutput: {forces: edges}\n"
    "fish: [{nodes: 5, sheet_points: %d, wave: {phase: 20, ramp: 0}, start: {heading: 170, speed: 0.8}%s},\n"
    "    {nodes: 6, sheet_points: %d, length: 0.8, wave: {frequency: 2, phase: 50, ramp: 0.1},\n"
    "     start: {position: [0.2, 0.6], speed: 0.6}%s},\n"
    "    {nodes: 5, sheet_points: %d, start: {position: [0.1, -0.7], heading: 180, speed: 0.5}, wave: {frequency: 3},\n"
    "     motion: {prescribed: head, heave: 0.05, pitch: 8, pitch_phase: 80, frequency: 3, phase: 20, pivot: "
    "0.1}%s}]\n";
#define REACTIVE ", force: reactive"
#define PLANE ", force: pressure, pressure: {span: infinite}"
#define TAPERED(thicknesses, depths) \
    ", body: {profile: table, thickness_table: " thicknesses ", depth_table: " depths "}"
static const char *const school_parts[][4] = {
    {", viscosity: 2e-6, gust: {amplitude: 0.15, frequency: 2.2}", REACTIVE, PLANE ", sensors: [0.2, 0.7]", REACTIVE},
    // the rows that begin with r, p, f
    {"", REACTIVE, REACTIVE, REACTIVE},
    {"", PLANE, PLANE, PLANE},
    {"", TAPERED("[0.06, 0.11, 0.08, 0.04]", "[0.12, 0.2, 0.18, 0.24]"),
     TAPERED("[0.05, 0.1, 0.09, 0.07, 0.04]", "[0.22, 0.3, 0.25, 0.2, 0.1]") ", sensors: [0.2, 0.7]",
     TAPERED("[0.08, 0.09, 0.07, 0.05]", "[0.1, 0.15, 0.25, 0.2]")},
};

#define SINE "fluid.gust.amplitude=0.1; fluid.gust.profile=sine; fluid.gust.wavelength=0.7"
#define STEP "fluid.gust.amplitude=0.1; fluid.gust.profile=step; fluid.gust.gradient_distance=0.3"
#define STREET "wake.street.vortices=6; wake.street.spacing=0.3; wake.street.circulation=0.02"
#define BESIDE "wake.vortices=[[1.2, -0.12, 0.05], [0.8, -0.1, -0.04]]"
#define LINEAR "fish[0].drag.law=linear_quadratic"
#define AVERAGED "fish[0].control.law=averaged_heading; fish[0].control.desired_heading=150"
#define COURSE "fish[0].control.law=course; fish[0].control.desired_heading=150"
#define HEADING "fish[0].control.law=heading; fish[0].control.desired_heading=150"
#define FED HEADING "; fish[0].control.feedforward=0.5"
#define ALL "fish[2].motion.prescribed=all"
#define NEAR_ "fish[1].start.position=[0.05, 0.25]"

/* Assignments to this school. No two rows give the same results: each key acts. */
static const char *const assignments[] = {
    "fluid.density=900",
    "fluid.viscosity=3e-6",
    "fluid.velocity=[0.3, -0.1]",
    "fluid.velocity=[0.2, 0.1]",
    "fluid.shear=0.5; fish[1].sensors=[]",
    "fluid.gust.amplitude=0.2",
    "fluid.gust.frequency=3",
    "p " SINE,
    "p " SINE "; fluid.gust.speed=0.5",
    "p " SINE "; fluid.gust.position=0.1",
    "p fluid.gust.amplitude=0.1; fluid.gust.profile=sine; fluid.gust.wavelength=0.9",
    "p " STEP,
    "p " STEP "; fluid.gust.position=0.1",
    "p " STEP "; fluid.gust.speed=0.5",
    "p fluid.gust.amplitude=0.1; fluid.gust.profile=step; fluid.gust.gradient_distance=0.4",
    "r fluid.velocity=[0.2, 0]; fluid.walls=[-1.2]",
    "r fluid.velocity=[0.2, 0]; fluid.walls=[-1.2, 1.4]",
    "wake.smoothing=0.15",
    "p " BESIDE,
    "p " BESIDE "; wake.taper=0.4",
    "p " BESIDE "; wake.taper_beside=0.2",
    "wake.lifetime=0.4",
    "wake.decay=0.2",
    "wake.lifetime=0.02; wake.decay=0.015",
    "wake.lifetime=0.02; wake.decay=0.015; wake.removed_circulation=dropped",
    "r wake.shedding=continuous",
    "r wake.shedding=continuous; sheet.kutta=rate",
    "r wake.shedding=impulsive",
    "p wake.vortices=[[0.5, 0.4, 0.05]]",
    "p " STREET,
    "p " STREET "; wake.street.row_distance=0.2",
    "p " STREET "; wake.street.position=[0.1, 0.2]",
    "p wake.street.vortices=6; wake.street.spacing=0.4; wake.street.circulation=0.02",
    "p wake.street.vortices=6; wake.street.spacing=0.3; wake.street.circulation=0.03",
    "sheet.smoothing=0.08",
    "r sheet.curve=polygon",
    "r wake.shedding=continuous; sheet.collocation=midpoint",
    NEAR_ "; contact.range=0.1",
    NEAR_ "; contact.range=0.12",
    NEAR_ "; contact.range=0.1; contact.action=warn",
    "r solver.method=rk4; solver.step=1e-3; fish[*].body.modulus=1e4",
    "r solver.method=heun; solver.step=2.5e-3; fish[*].body.modulus=1e4",
    "time.shedding_interval=0.005",
    "fish[0].length=1.1",
    "fish[1].length=0.9",
    "fish[0].nodes=6",
    "fish[0].reference_nodes=9",
    "fish[0].sheet_points=15",
    "fish[1].sheet_points=17",
    "fish[0].body.profile=uniform",
    "fish[0].body.profile=table; fish[0].body.thickness_table=[0.05, 0.1, 0.08, 0.04]; "
    "fish[0].body.depth_table=[0.16, 0.2, 0.18, 0.22]",
    "fish[1].body.profile=uniform; fish[1].body.thickness=0.1",
    "fish[0].body.thickness=0.15",
    "fish[0].body.tail_thickness=0.06",
    "fish[0].body.depth=0.3",
    "fish[1].body.depth=0.3",
    "fish[0].body.section=nodes",
    "fish[0].body.density=1100",
    "fish[0].body.modulus=8e5",
    "fish[0].body.second_moment=published",
    "fish[0].body.bending_damping=0.3",
    "fish[0].body.stretching_damping=700",
    "fish[0].body.relaxation_time=0.03",
    "fish[0].body.damping=curvature",
    "fish[0].wave.amplitude=0.5",
    "fish[0].wave.constant=0.1",
    "fish[0].wave.linear=0.8",
    "fish[0].wave.quadratic=0.4",
    "fish[0].wave.number=-5",
    "fish[0].wave.wavelength=0.9",
    "fish[0].wave.table=[[0.1, 0.3, -0.2, 0], [0.5, 0.1, -0.4, 0.2], [0.6, 1, -0.7, 0.1]]",
    "fish[0].wave.frequency=1.5",
    "fish[0].wave.phase=40",
    "fish[0].wave.ramp=0.3",
    "fish[0].force=published",
    "fish[0].force=published; fish[0].added_mass.extent=thickness",
    "fish[0].force=published; fish[0].added_mass.coefficient=1.5; " LINEAR,
    "fish[0].force=pressure; fish[0].pressure.span=infinite",
    "",
    "r ",
    "p ",
    "fish[1].pressure.span=finite",
    "fish[*].force=pressure; fish[*].pressure.span=finite; fluid.shear=0.1; fish[1].sensors=[]",
    "fish[1].pressure.suction=0.7",
    "fish[1].pressure.suction_limit=0.02",
    "fish[1].pressure.suction_limit=0.03",
    "fish[1].sensors=[0.2, 0.6]",
    "fish[0].drag.tangential=6e-3",
    "fish[0].drag.skin=laminar",
    "fish[0].drag.skin=boundary_layer",
    "fish[0].drag.skin=boundary_layer; fish[0].drag.form=1.8",
    "fish[1].drag.transition=1e5",
    "fish[1].drag.transition=0",
    "fish[1].drag.skin=laminar",
    "fish[1].drag.waving=1.2",
    "fish[1].drag.form=1.3",
    "fish[1].drag.normal=0.4",
    "fish[0].drag.normal=0.7",
    LINEAR,
    LINEAR "; fish[0].drag.linear_speed=0.4",
    "fish[0].added_mass.coefficient=1.2",
    "fish[0].added_mass.extent=thickness",
    "fish[0].start.position=[0.05, 0.02]",
    "fish[0].start.heading=165",
    "fish[0].start.speed=0.7",
    "fish[0].load.tip=[0.3, -0.4]",
    "fish[1].load.tip=[0.3, -0.4]",
    ALL,
    ALL "; fish[2].motion.surge=free",
    "p " ALL "; fish[2].motion.surge=free",
    "fish[2].motion.surge=free",
    "p fish[2].motion.surge=free",
    "fish[2].motion.speed=0.6",
    "fish[2].motion.heave=0.07",
    "fish[2].motion.pitch=12",
    "fish[2].motion.pitch_phase=60",
    "fish[2].motion.frequency=2",
    "fish[2].motion.phase=50",
    "fish[2].motion.pivot=0.3",
    HEADING,
    HEADING "; fish[0].control.gain=0.7",
    HEADING "; fish[0].control.limit=0.3",
    FED,
    FED "; fish[0].control.filter=0.3",
    FED "; fish[0].control.filter=0",
    AVERAGED,
    AVERAGED "; fish[0].control.rate=0.1",
    AVERAGED "; fish[0].control.limit=0.01",
    COURSE,
    "fish[0].control.waypoints=[[-1, -1], [-2, -3]]",
    "fish[0].control.waypoints=[[-1, -1], [-2, -3]]; fish[0].control.acceptance_radius=3",
    "fish[0].control.bias=0.2",
    "r preset=published; fish[*].force=published",
    "f ",
    "f fluid.density=900; fluid.viscosity=3e-6",
    "f wake.leg_length=1.5",
    "f fluid.velocity=[0.3, 0.2]",
    "f fluid.velocity=[1.5, 0.6]",
    "f fluid.velocity=[-1.2, 0.1]",
    "f fluid.velocity=[0.2, 0]; fluid.walls=[-1.2, 1.4]",
    "f fluid.shear=0.5; fish[1].sensors=[]",
    "f fluid.gust.amplitude=0.2; fluid.gust.frequency=3",
    "f " SINE "; fluid.gust.speed=0.5; fish[1].sensors=[]",
    "f " STEP "; fluid.gust.speed=0.5; fish[1].sensors=[]",
    "f fish[1].start.position=[0.05, 0.16]",
    "f wake.lifetime=0.02; wake.decay=0.015",
    "f fish[1].start.position=[0.05, 0.16]; contact.range=0.1",
    "f fish[1].start.position=[0.05, 0.16]; contact.range=0.1; fluid.velocity=[0.2, 0]; fluid.walls=[-1.2, 0.27]",
    "f solver.method=trapezoid; solver.step=2.5e-3",
    "f solver.method=implicit_euler; solver.step=2.5e-3",
    // tight, because the step of another version of SUNDIALS differs
    "f solver.method=dormand_prince; solver.rtol=1e-10; fish[*].body.modulus=1e4",
    "f solver.method=rk4; solver.step=5e-4; fish[*].body.modulus=1e4",
    "f fish[1].length=0.9; fish[0].sheet_points=57",
    "f fish[1].body.depth_table=[0.22, 0.3, 0.25, 0.2, 0.15]",
    "f fish[1].body.depth_table=[0.26, 0.3, 0.25, 0.2, 0.1]",
    "f fish[1].body.section=nodes; fish[1].body.density=1100",
    "f fish[1].body.damping=curvature; fish[1].body.bending_damping=0.3",
    "f fish[1].force=reactive; fish[1].sensors=[]",
    "f fish[1].force=reactive; fish[1].sensors=[]; fish[1].drag.normal=0.6; fish[1].added_mass.coefficient=1.2",
    "f fish[*].pressure.span=infinite",
    "f fish[0].pressure.suction=0.7; fish[1].pressure.suction_limit=0.03",
    "f fish[1].drag.skin=laminar",
    "f fish[1].drag.skin=boundary_layer; fish[1].drag.transition=1e5",
    "f fish[1].drag.waving=1.2; fish[1].drag.form=1.3; fish[1].drag.normal=0.4",
    "f fish[*].start.heading=40",
    "f fish[*].start.heading=200; fish[0].start.speed=-0.4; fish[1].start.speed=1.5",
    "f fish[0].wave.constant=1; fish[0].wave.amplitude=0.8; fish[1].load.tip=[0.3, -0.4]",
    "f " ALL,
    "f fish[2].motion.surge=free; fish[2].motion.pivot=0.3; fish[2].motion.pitch=30",
    "f " COURSE "; fish[0].control.limit=0.2",
    "f fish[0].control.bias=0.4; fish[1].control.law=heading; fish[1].control.desired_heading=100",
};
enum { N_ASSIGNMENTS = sizeof assignments / sizeof *assignments, MAX_ASSIGNED = 6 };

/* Keys without influence on two intervals: files, limits and machines, steady states, what only a program uses, and
 * the law that holds a place, which begins after a beat (tests/control/test_control.c). */
static const char keys_elsewhere[] =
    " format name include time.end time.output_interval time.checkpoint_interval time.checkpoint_wall wake.tolerance "
    "wake.spare_vortices solver.rtol solver.order solver.error_test solver.coupling_distance solver.linear "
    "solver.threads "
    "solver.max_steps output.file "
    "output.precision output.forces output.wake_interval steady.tolerance steady.beats steady.output_beats "
    "steady.formation steady.multipliers defaults fish.name fish.control.damping fish.control.slow "
    "fish.control.course_filter fish.control.ramp fish.control.of fish.control.offset "
    "fish.control.amplitude_gain fish.control.amplitude_damping fish.control.amplitude_limit "
    "fish.control.lookahead fish.control.hold_time sweep expect error ";

/* The kind of the school of a row: 1, 2 and 3 for rows that begin with r, p and f, else 0. */
static int school_kind(const char *row) {
    static const char letters[] = "rpf";
    const char *const letter = *row && row[1] == ' ' ? strchr(letters, *row) : NULL;
    return letter ? (int)(letter - letters) + 1 : 0;
}

/* Sums over all variables at the start and after two intervals. Each variable is divided by its scale, so that each
 * counts as much as any other; without scales the sizes of the variables become the scales. */
static void sum_variables(const char *row, double scale[MAX_VARIABLES][2], int finds_scales, double sum[2]) {
    char words[500], text[2000], *list[MAX_ASSIGNED], *rest = words;
    const int kind = school_kind(row), more = kind == 3 ? 28 : 0;  // a finite span needs more points
    const char *const *const part = school_parts[kind];
    snprintf(text, sizeof text, school, part[0], 25 + more, part[1], 27 + more, part[2], 23 + more, part[3]);
    snprintf(words, sizeof words, "%s", row + (kind > 0 ? 2 : 0));
    int n = 0;
    for (char *word; (word = strtok_r(rest, ";", &rest));) {
        assert_in_range(n, 0, MAX_ASSIGNED - 1);
        list[n++] = word + strspn(word, " ");
    }

    struct shoal *run;
    if (shoal_open_text(&run, text, NULL, n, (const char *const *)list) != SHOAL_OK) {
        fail_msg("%s: %s", row, shoal_message());
    }
    for (int end = 0; end < 2; end++) {
        sum[end] = 0;
        if (shoal_advance(run, end * shoal_end(run)) != SHOAL_OK) fail_msg("%s: %s", row, shoal_message());
        for (int i = 0; shoal_variable(i); i++) {
            const char *const name = shoal_variable(i);
            struct shoal_array array;
            if (is_left_out(name) || strncmp(name, "steady_", 7) == 0) continue;
            assert_int_equal(shoal_read(run, name, &array), SHOAL_OK);
            if (array.type == SHOAL_CHAR) continue;
            assert_in_range(i, 0, MAX_VARIABLES - 1);
            const struct entry entry = entry_of(run, name);
            // a power of 2: the size itself would hide a factor on the variable
            if (finds_scales) scale[i][end] = entry.size > 1e-5 ? exp2(round(log2(entry.size))) : 1;
            sum[end] += (1 + 0.5 * sin(1.7 * i)) * entry.sum / scale[i][end];
        }
    }
    shoal_close(run);
}

static void sum_assignments(double sum[N_ASSIGNMENTS][2]) {
    static double scale[4][MAX_VARIABLES][2];
    static const char *const unchanged[] = {"", "r ", "p ", "f "};
    double unused[2];
    for (int kind = 0; kind < 4; kind++) sum_variables(unchanged[kind], scale[kind], 1, unused);
    for (int i = 0; i < N_ASSIGNMENTS; i++)
        sum_variables(assignments[i], scale[school_kind(assignments[i])], 0, sum[i]);
}

static int write_key_table(void) {
    static double sum[N_ASSIGNMENTS][2];
    sum_assignments(sum);
    FILE *const file = fopen(key_table, "w");
    assert_non_null(file);
    fputs("# Sums at the start and after two intervals, for each row of tests/library/test_results.c --write\n", file);
    for (int i = 0; i < N_ASSIGNMENTS; i++) fprintf(file, "%.14g %.14g\n", sum[i][0], sum[i][1]);
    return fclose(file);
}

TEST(every_key_has_its_results) {
    for (int i = 0; i < case_table_n; i++) {
        const char *const path = case_table[i].path;
        char text[100];
        int n = 0;
        snprintf(text, sizeof text, " %s ", path);
        if (strstr(keys_elsewhere, text)) continue;
        if (case_table_is_of_fish(&case_table[i])) {
            snprintf(text, sizeof text, "].%s=", path + strlen("fish."));
        } else {
            snprintf(text, sizeof text, "%s=", path);
        }
        for (int k = 0; k < N_ASSIGNMENTS; k++) n += strstr(assignments[k], text) != NULL;
        if (n == 0) fail_msg("no assignment to %s", path);
    }

    static double sum[N_ASSIGNMENTS][2];
    sum_assignments(sum);
    int n_wrong = 0;
    for (int i = 0; i < N_ASSIGNMENTS; i++) {
        for (int k = 0; k < i; k++) {
            if (fabs(sum[i][0] - sum[k][0]) + fabs(sum[i][1] - sum[k][1]) > 10 * of_keys) continue;
            n_wrong++;
            print_error("no difference between %s and %s\n", assignments[i], assignments[k]);
        }
    }
    FILE *const file = fopen(key_table, "r");
    assert_non_null(file);
    char line[256];
    int n = 0;
    double worst = 0;
    while (fgets(line, sizeof line, file)) {
        double want[2];
        if (sscanf(line, "%lf %lf", &want[0], &want[1]) != 2) continue;
        assert_in_range(n, 0, N_ASSIGNMENTS - 1);
        for (int end = 0; end < 2; end++) {
            // some rows have forces that the unchanged school lacks
            const double off = fabs(sum[n][end] - want[end]) / fmax(1, fabs(want[end]) / 100);
            worst = fmax(worst, off);
            if (off <= of_keys) continue;
            n_wrong++;
            print_error("%s: %s: %.10g becomes %.10g\n", assignments[n], end ? "two intervals" : "start", want[end],
                        sum[n][end]);
        }
        n++;
    }
    fclose(file);
    print_message("%d assignments, largest difference %.1e\n", n, worst);
    assert_int_equal(n, N_ASSIGNMENTS);
    assert_int_equal(n_wrong, 0);
}

int main(int argc, char **argv) {
    return argc > 1 && strcmp(argv[1], "--write") == 0 ? write_table() + write_key_table() : near_run();
}
