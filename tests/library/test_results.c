/* test_results.c: the variables of tests/data/results.tsv, fourteen of each of fifteen short runs and three steady
 * states, in which all terms of the model act at once. Independent tests verify the terms; this test notices every
 * change of a result, which CHANGES.md promises to state; tests/extra/test_key_results.c changes each key. After an
 * intended change:
 *
 *     build/tests/library/test_results --write
 */
#include <netcdf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "case/case.h"
#include "near.h"
#include "result_entry.h"
#include "shoal.h"
#include "steady/steady.h"

static const char table[] = "tests/data/results.tsv";

/* Over the sum of the magnitudes. The runs have rtol 1e-8: with fused multiplications these variables change by less
 * than 2e-7. On another processor the integrator may choose another step: arm64 with SUNDIALS 7 differs by 1.8e-6. */
#ifdef __x86_64__
static const double tolerance = 1e-6;
#else
static const double tolerance = 1e-5;
#endif
static const double of_differences = 1e-2;

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
enum { N_RUNS = sizeof runs / sizeof *runs, MAX_ROWS = 500 };

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
            bool is_known = !(all[r][i].size > 0);
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
        const bool is_difference = strstr(want[i].name, "multiplier") || strstr(want[i].name, "growth") ||
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

int main(int argc, char **argv) {
    return argc > 1 && strcmp(argv[1], "--write") == 0 ? write_table() : near_run();
}
