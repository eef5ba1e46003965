/* test_result_info.c: Tests the summary of a result, the list of its variables, and the version that it names. */
#include <sys/stat.h>

#include "base/version.h"
#include "crafted_file.h"
#include "result/result_info.h"
#include "result/result_kind.h"
#include "result/result_table.h"
#include "result_fixture.h"

// ---- info ----

static const struct result_kind run = {"run",       "shoal_schema",     RESULT_SCHEMA, "case_effective",
                                       result_info, result_table_listed};

static char printed[8192];

/* Print into printed, which stays empty when that fails. */
static enum status print_info(const struct fixture *f, bool case_only) {
    memset(printed, 0, sizeof printed);
    FILE *stream = fmemopen(printed, sizeof printed - 1, "w");
    ARENA(arena, NULL, "info");
    const enum status status =
        result_kind_info(arena, 1, &run, f->path, case_only ? RESULT_INFO_CASE : RESULT_INFO_TEXT, stream);
    fclose(stream);
    return status;
}

static void has_lines(const char *text, int n, const char *const *lines) {
    for (int i = 0; i < n; i++)
        if (strstr(text, lines[i]) == NULL) fail_msg("\"%s\" is not in\n%s", lines[i], text);
}

TEST_WITH(info_sums_up, set_up, tear_down) {
    struct fixture *f = *state;
    f->diagnostics.momentum_balance[0] = -3e-3;
    f->diagnostics.momentum_balance[1] = 4e-3;
    write_file(f, 3);
    assert_int_equal(print_info(f, false), STATUS_OK);
    const char *const parts[] = {"momentum balance          5.0e-03 N s",
                                 "total circulation         1.1e+01 m2 s-1",
                                 "least distance            12.0000 m",
                                 "polarisation              13.0000",
                                 "steps                          21   2.10 per event",
                                 "a vortex every 0.1 s",
                                 "convergence_failures           26   2.60 per event",
                                 "result",
                                 "complete",
                                 "3, from t = 0 s to 1 s",
                                 "leader",
                                 "suédois",
                                 "2.10 per event",
                                 "28.00 s   0.0357 times real time"};
    has_lines(printed, sizeof parts / sizeof *parts, parts);
    assert_null(strstr(printed, "nan"));

    // the size in kB up to 1 MB; bytes behind the rows are no rows
    static const char *const sizes[] = {"size        1000.0 kB\n", "size        1.0 MB\n", "size        2.5 MB\n"};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(truncate(f->path, (off_t[]){999999, 1000000, 2500000}[i]), 0);
        assert_int_equal(print_info(f, false), STATUS_OK);
        has_lines(printed, 1, &sizes[i]);
    }
}

/* The summary of a steady state, on a page of its own. */
static const char *steady_summary(struct fixture *f, const struct steady_values *values) {
    unlink(f->path);
    write_steady(f, 1, &(double){0}, values);
    assert_int_equal(print_info(f, false), STATUS_OK);
    return printed;
}

static void is_printed(const char *got, const char *want) {
    size_t i = 0;
    while (got[i] && got[i] == want[i]) i++;
    if (got[i] != want[i]) fail_msg("from \"%.60s\" on:\n%s", want + i, got);
}

TEST_WITH(thrust_is_told_of_a_school_with_a_held_body, set_up, tear_down) {
    struct fixture *f = *state;
    for (int held = -1; held < N_FISH; held++) {
        for (int i = 0; i < N_FISH; i++) f->school->fish[i].motion.is_held = i == held;
        f->of_fish[1].mean_thrust = 0.125;
        write_file(f, 1);
        assert_int_equal(print_info(f, false), STATUS_OK);
        assert_int_equal(strstr(printed, "  thrust") != NULL && strstr(printed, "  0.125") != NULL, held >= 0);
        unlink(f->path);
    }
}

TEST_WITH(info_is_printed_whole, set_up, tear_down) {
    struct fixture *f = *state;
    for (int i = 0; i < N_FISH; i++) {
        struct diagnostics_fish *const of = &f->of_fish[i];
        const double n = i + 1;
        of->speed = 0.123456 * n;
        of->heading = -12.3456 * n;
        of->phi0 = 0.0123456 * n;
        of->shed_circulation = -1.23456e-3 * n;
        of->cross_flow_power = -0.567891 * n;
        of->kinetic_energy = 23.45678 * n;
        of->actuation_work = 34.56789 * n;
        of->energy_balance = -4.5678e-5 * n;
    }
    f->diagnostics.momentum_balance[0] = -3e-3;
    f->diagnostics.momentum_balance[1] = 4e-3;
    write_file(f, 4);
    assert_int_equal(print_info(f, false), STATUS_OK);
    is_printed(strstr(printed, "  status"),
               "  status      complete\n  rows        4, from t = 0 s to 1.5 s; a vortex every 0.1 s\n\n"
               "fish      nodes  sheet  length  vortices   speed  heading    phi0        shed"
               "  cross-flow  energy   work   balance\n"
               "                             m             m s-1   degree              m2 s-1"
               "           W       J      J         J\n"
               "leader        5      7       1         0  0.1235   -12.35  0.0123  -1.235e-03"
               "      -0.568   23.46  34.57  -4.6e-05\n"
               "suédois      7      5       2         0  0.2469   -24.69  0.0247  -2.469e-03"
               "       -1.14   46.91  69.14  -9.1e-05\n\n  total circulation         1.1e+01 m2 s-1\n"
               "  momentum balance          5.0e-03 N s\n  least distance            12.0000 m\n"
               "  polarisation              13.0000\n\n"
               "  method                        ida   steps of order 1: 1, 2: 20\n"
               "  unknowns                       48   differential, and 40 algebraic\n"
               "  non-zeros                      36   of the Jacobian, and 37 of its factors\n"
               "  steps                          21   1.40 per event\n"
               "  residual_evaluations           22   1.47 per event\n"
               "  newton_iterations              23   1.53 per event\n"
               "  jacobian_evaluations           24   1.60 per event\n"
               "  klu_analyses                   31   2.07 per event\n"
               "  klu_factorisations             32   2.13 per event\n"
               "  klu_refactorisations           33   2.20 per event\n"
               "  gmres_iterations               34   2.27 per event\n"
               "  error_test_failures            25   1.67 per event\n"
               "  convergence_failures           26   1.73 per event\n"
               "  initial_iterations             35   2.33 per event\n"
               "  wall_time                   28.00 s   0.0536 times real time\n");
}

TEST_WITH(a_steady_state_is_printed_whole, set_up, tear_down) {
    struct fixture *f = *state;
    double numbers[2 * 20];
    for (int i = 0; i < 40; i++) numbers[i] = 0.123456 * (i + 1);
    struct steady_fish fish[N_FISH];
    for (int i = 0; i < N_FISH; i++) {
        const double *const n = numbers + 20 * i;
        fish[i] = (struct steady_fish){.speed = n[0],
                                       .turn = n[1],
                                       .place = {n[2], n[3]},
                                       .force = {n[4], n[5]},
                                       .thrust = n[6],
                                       .drag = n[7],
                                       .lift = n[8],
                                       .deflection = n[9],
                                       .actuation_power = n[10],
                                       .constraint_power = n[11],
                                       .damping_power = n[12],
                                       .fluid_power = n[13],
                                       .power = n[14],
                                       .cost_of_transport = n[15],
                                       .efficiency = n[16],
                                       .towed_efficiency = n[17],
                                       .strouhal = n[18]};
    }
    const struct steady_values values = {
        .n_beats = 12, .residual = 2e-6, .error = 3e-5, .stiffness = NAN, .fish = fish};
    is_printed(strstr(steady_summary(f, &values), "  steady state"),
               "  steady state after 12 beats: change from beat to beat 2.0e-06, about 3.0e-05 from the fixed point\n\n"
               "                            leader  suédois\nspeed                      0.12346   2.59258  m s-1\n"
               "turn in a beat              0.2469    2.7160  degree\nplace, ahead               0.37037   2.83949  m\n"
               "place, aside               0.49382   2.96294  m\nforce of the fluid, x      0.61728    3.0864  N\n"
               "force of the fluid, y      0.74074    3.2099  N\nthrust                     0.86419    3.3333  N\n"
               "drag                       0.98765    3.4568  N\nlift                        1.1111    3.5802  N\n"
               "deflection                 1.23456   3.70368  m\npower of the muscle          1.358    3.8271  W\n"
               "driving power               1.4815    3.9506  W\npower of damping            1.6049     4.074  W\n"
               "power to the fluid          1.7284    4.1975  W\npower of muscle and drive   1.8518     4.321  W\n"
               "cost of transport          1.97530   4.44442  m s-2\nefficiency                 2.09875   4.56787\n"
               "towed efficiency           2.22221   4.69133\nStrouhal number            2.34566   4.81478\n\n"
               "  method                        ida   steps of order 1: 1, 2: 20\n"
               "  unknowns                       48   differential, and 40 algebraic\n"
               "  non-zeros                      36   of the Jacobian, and 37 of its factors\n"
               "  steps                          21\n  residual_evaluations           22\n"
               "  newton_iterations              23\n  jacobian_evaluations           24\n"
               "  klu_analyses                   31\n  klu_factorisations             32\n"
               "  klu_refactorisations           33\n  gmres_iterations               34\n"
               "  error_test_failures            25\n  convergence_failures           26\n"
               "  initial_iterations             35\n"
               "  wall_time                   28.00 s   0 times real time\n");
}

TEST_WITH(info_shows_the_multipliers_of_a_steady_state_and_a_table, set_up, tear_down) {
    struct fixture *f = *state;
    struct steady_fish fish[N_FISH] = {{.speed = 0.5, .place = {0, 0}, .force = {4, 5}, .lift = NAN, .drag = NAN},
                                       {.speed = 0.25, .place = {-3, 2}, .force = {7, 8}, .lift = NAN, .drag = 6}};
    double real[] = {0.6, 0.6, 0.4}, imaginary[] = {0.6, -0.6, 0}, error[] = {0.02, 0.02, 0.01};
    double mode[3 * N_FISH * STEADY_QUANTITIES * 2] = {0};
    mode[0] = -1, mode[2 * STEADY_QUANTITIES + 9] = 0.5,
    mode[2 * 2 * N_FISH * STEADY_QUANTITIES + 2] = 1; /* speed of the first fish, place ahead of the second */
    struct steady_values values = {.n_beats = 12,
                                   .n_multiplier_beats = 30,
                                   .residual = 2e-6,
                                   .error = 3e-5,
                                   .stiffness = NAN,
                                   .n_multipliers = 3,
                                   .real = real,
                                   .imaginary = imaginary,
                                   .multiplier_error = error,
                                   .mode = mode,
                                   .amplification = 2.5,
                                   .fish = fish};
    static const char *const lines[] = {
        "  steady state after 12 beats: change from beat to beat 2.0e-06, about 3.0e-05 from the fixed point\n"
        "  multipliers in 30 more beats, and the largest parts of their modes:\n"
        "    0.8485 +- 0.0200, period 8.0 beats: leader speed 1.00, suédois ahead 0.50\n"
        "    0.4000 +- 0.0100: leader slip 1.00\n"
        "  stable; a disturbance may grow by the factor 2.5 in 32 beats\n",
        "speed                      0.50000   0.25000  m s-1\n",
        "place, ahead               0.00000  -3.00000  m\nplace, aside               0.00000   2.00000  m\n"
        "force of the fluid, x            4         7  N\nforce of the fluid, y            5         8  N\n",
        "drag                             -         6  N\n"};
    has_lines(steady_summary(f, &values), 4, lines);
    assert_null(strstr(printed, "lift"));
    // by the absolute value
    real[0] = real[1] = 0.81;
    values.error = NAN;
    static const char *const unstable[] = {"from beat to beat 2.0e-06\n",
                                           "  undecided: 1 is within the error of the largest multiplier;"};
    has_lines(steady_summary(f, &values), 2, unstable);
    error[0] = error[1] = 0.005;
    static const char *const surely[] = {"    1.0080 +- 0.0050, period 9.9 beats: ", "  unstable\n"};
    has_lines(steady_summary(f, &values), 2, surely);
}

TEST_WITH(info_says_how_bodies_without_a_beat_lose_their_stability, set_up, tear_down) {
    struct fixture *f = *state;
    const double two_pi = 6.283185307179586;
    static const struct {
        double stiffness, rate[2], turns[2]; /* turns: Hz */
        const char *line[2];
    } of[] = {
        {0.5,
         {-0.25, -2},
         {3, 0},
         {"over that at rest: 0.5000: does not diverge\n",
          "  growth of disturbances: -0.2500 s-1 at 3 Hz, -2.0000 s-1 at 0 Hz: stable\n"}},
        {0.5,
         {0.25, -2},
         {3, 0},
         {"does not diverge\n", "+0.2500 s-1 at 3 Hz, -2.0000 s-1 at 0 Hz: unstable: flutters\n"}},
        {-0.5,
         {0.25, -2},
         {0, 3},
         {"-0.5000: diverges\n", "+0.2500 s-1 at 0 Hz, -2.0000 s-1 at 3 Hz: unstable: diverges\n"}},
        // rounding
        {0.5, {9e-6, -2}, {3, 0}, {"does not diverge\n", ": +0.0000 s-1 at 3 Hz, -2.0000 s-1 at 0 Hz: stable\n"}}};
    for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
        struct steady_fish fish[N_FISH] = {{.speed = 1}, {.speed = 1}};
        double rate[] = {of[i].rate[0], of[i].rate[1]}, omega[] = {two_pi * of[i].turns[0], two_pi * of[i].turns[1]};
        const struct steady_values values = {.stiffness = of[i].stiffness,
                                             .residual = 1e-9,
                                             .n_exponents = 2,
                                             .rate = rate,
                                             .omega = omega,
                                             .fish = fish};
        has_lines(steady_summary(f, &values), 2, of[i].line);
    }

    // without modes, the reasons that are possible
    struct steady_fish fish[N_FISH] = {{.speed = 1}, {.speed = 1}};
    const struct steady_values values = {.stiffness = NAN, .residual = 1e-9, .fish = fish};
    static const char *const reasons[] = {
        "  growth of disturbances: not computed: needs steady.multipliers, pressure.span infinite, and a\n"};
    has_lines(steady_summary(f, &values), 1, reasons);
}

TEST_WITH(info_of_a_file_without_rows_says_so, set_up, tear_down) {
    struct fixture *f = *state;
    write_file(f, 0);
    assert_int_equal(print_info(f, false), STATUS_OK);
    assert_non_null(strstr(printed, "none yet"));
}

TEST_WITH(info_prints_the_case_exactly, set_up, tear_down) {
    struct fixture *f = *state;
    write_file(f, 1);
    assert_int_equal(print_info(f, true), STATUS_OK);
    assert_string_equal(printed, EFFECTIVE);
}

static void assert_no_info(const struct fixture *f, const char *part) {
    assert_int_equal(print_info(f, false), STATUS_FILE);
    assert_message(f->path);
    assert_message(part);
}

TEST_WITH(info_refuses_other_files, set_up, tear_down) {
    struct fixture *f = *state;
    assert_no_info(f, "No such file");
    mkdir(f->path, 0700);
    assert_no_info(f, "is a folder");
    rmdir(f->path);

    FILE *text = fopen(f->path, "w");
    assert_no_info(f, "not a NetCDF file");  // empty
    fputs("format: 1\n", text);
    fclose(text);
    assert_no_info(f, "not a NetCDF file");

    int file;
    assert_int_equal(nc_create(f->path, NC_CLOBBER, &file), NC_NOERR);
    nc_close(file);
    assert_no_info(f, "not of shoal");
}

TEST_WITH(info_refuses_another_schema, set_up, tear_down) {
    struct fixture *f = *state;
    write_file(f, 1);
    int file;
    const int schema = RESULT_SCHEMA + 1;
    assert_int_equal(nc_open(f->path, NC_WRITE, &file), NC_NOERR);
    assert_int_equal(nc_put_att_int(file, NC_GLOBAL, "shoal_schema", NC_INT, 1, &schema), NC_NOERR);
    nc_close(file);
    assert_no_info(f, "written in schema 2");
}

TEST_WITH(info_shows_the_whole_rows_of_a_file_that_was_cut, set_up, tear_down) {
    struct fixture *f = *state;
    struct netcdf_rows rows;
    write_file(f, 4);
    assert_int_equal(netcdf_read_rows(f->path, &rows), STATUS_OK);
    for (uint64_t n = 4; n-- > 0;) {
        // half of a row, and a row but for its last byte
        const uint64_t left[] = {rows.bytes / 2, rows.bytes - 1};
        for (int i = 1; i >= 0; i--) {
            char missing[64], whole[64];
            assert_int_equal(truncate(f->path, (off_t)(rows.begin_of_rows + n * rows.bytes + left[i])), 0);
            assert_int_equal(print_info(f, false), STATUS_OK);
            snprintf(missing, sizeof missing, "missing     %d of 4 rows: the file was cut off", (int)(4 - n));
            snprintf(whole, sizeof whole, "rows        %d, from t = 0 s to %g s", (int)n, 0.5 * ((int)n - 1));
            assert_non_null(strstr(printed, missing));
            assert_non_null(strstr(printed, n > 0 ? whole : "rows        none is whole"));
        }
    }
    const off_t left[] = {(off_t)rows.begin_of_rows - 1, 5000, 100, 3};
    for (size_t i = 0; i < sizeof left / sizeof *left; i++) {
        assert_int_equal(truncate(f->path, left[i]), 0);
        assert_int_equal(print_info(f, false), STATUS_FILE);
    }
}

TEST_WITH(info_refuses_variables_that_do_not_fit, set_up, tear_down) {
    struct fixture *f = *state;
    write_file(f, 3);
    size_t n;
    char *const bytes = read_bytes(f->path, &n), name[NC_MAX_NAME + 1];
    int n_refused = 0;
    for (int i = 0; name_of_variable(f->path, i, name); i++) {
        for (enum craft how = 0; how < N_CRAFTS; how++) {
            craft_variable(f->path, name, how);
            const enum status status = print_info(f, false);
            if (status == STATUS_FILE) {
                assert_message(f->path);
                n_refused++;
            } else {
                assert_int_equal(status, STATUS_OK);
            }
            write_bytes(f->path, n, bytes);
        }
    }
    // 24 variables are printed
    AT_LEAST(n_refused, 24 * N_CRAFTS);
}

// ---- the list of variables and the version ----

TEST(the_list_has_one_line_per_variable) {
    const struct result_kind kinds[] = {run, run};
    for (int as_json = 0; as_json < 2; as_json++) {
        static char text[65536];
        memset(text, 0, sizeof text);
        FILE *stream = fmemopen(text, sizeof text - 1, "w");
        ABOVE(result_kind_variables(2, kinds, as_json, NULL, stream), 0);
        fclose(stream);
        int n_lines = 0;
        for (const char *c = text; *c; c++) n_lines += *c == '\n';
        // the text has a heading of three lines for the further file
        assert_int_equal(n_lines, 2 * result_table_n + (as_json ? 2 : 3));
        assert_non_null(strstr(
            text, as_json ? "\"dimensions\": [\"time\", \"fish\", \"node\", \"xy\"]" : "(time, fish, node, xy)"));
    }
}

TEST(version_names_every_library) {
    char libraries[VERSION_LENGTH];
    version_libraries(libraries);
    const char *const names[] = {"SUNDIALS ", "KLU ", "SuiteSparse ", "NetCDF ", "libyaml "};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *name = strstr(libraries, names[i]);
        assert_non_null(name);
        assert_in_range(name[strlen(names[i])], '0', '9');
    }
    assert_memory_equal(version_short(), "shoal ", 6);
}
