/* test_result_file.c: Tests what a result file contains, from when on it can be read, and what happens if it cannot be
 * written. */
#include <klu.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

#include "base/version.h"
#include "result/result_table.h"
#include "result_fixture.h"

// ---- what is in the file ----

TEST_WITH(format_is_cdf5, set_up, tear_down) {
    struct fixture *f = *state;
    const int file = open_new(f, 1);
    int format;
    assert_int_equal(nc_inq_format(file, &format), NC_NOERR);
    assert_int_equal(format, NC_FORMAT_CDF5);
}

// the place on the body of each slot along a body
static void coordinates_are_complete(int file, const struct result_variable *variable) {
    static const char *const places[][2] = {{"node", "node_arc"},       {"edge", "edge_arc"},
                                            {"joint", "joint_arc"},     {"sheet", "sheet_arc"},
                                            {"control", "control_arc"}, {"sensor", "sensor_place"}};
    char want[100] = "";
    for (const enum result_dimension *d = variable->dimension; *d != NONE; d++) {
        for (int i = 0; i < 6; i++) {
            if (strcmp(result_table_dimension(*d), places[i][0]) != 0 || strcmp(variable->name, places[i][1]) == 0)
                continue;
            strcat(want, places[i][1]);
        }
    }
    const int number = number_of(file, variable->name);
    if (*want) assert_string_equal(text_of(file, number, "coordinates"), want);
    if (!*want) assert_int_equal(nc_inq_attid(file, number, "coordinates", NULL), NC_ENOTATT);
}

TEST_WITH(every_variable_of_the_table_is_there_with_its_dimensions_unit_and_name, set_up, tear_down) {
    struct fixture *f = *state;
    f->values.output.forces = OUTPUT_FORCES_SIDES;
    f->school->walls = (struct walls){2, {-7, 8}, {1, -1}};
    f->school->fish[1].n_sensors = 2;
    f->school->fish[1].sensor = (double[2]){0.25, 0.5};
    struct result_file *result;
    assert_int_equal(begin(f, false, true, &result), STATUS_OK);
    assert_int_equal(result_file_publish(result, "running"), STATUS_OK);
    assert_int_equal(result_file_close(result, "complete"), STATUS_OK);
    f->school->fish[1].sensor = NULL;
    const int file = open_to_read(f);
    for (int i = 0; i < result_table_n; i++) {
        const struct result_variable *variable = &result_table[i];
        const int number = number_of(file, variable->name);
        int n, dimensions[NC_MAX_VAR_DIMS];
        assert_int_equal(nc_inq_var(file, number, NULL, NULL, &n, dimensions, NULL), NC_NOERR);
        for (int d = 0; d < n; d++) {
            char name[NC_MAX_NAME + 1];
            nc_inq_dimname(file, dimensions[d], name);
            assert_string_equal(name, result_table_dimension(variable->dimension[d]));
        }
        assert_int_equal(variable->dimension[n], NONE);
        assert_string_equal(text_of(file, number, "long_name"), variable->long_name);
        if (variable->type != RESULT_TEXT) assert_string_equal(text_of(file, number, "units"), variable->unit);
        coordinates_are_complete(file, variable);
    }
}

TEST(the_list_has_every_variable_with_its_dimensions) {
    struct result_listed listed;
    int n = 0;
    for (; result_table_listed(n, &listed); n++) {
        assert_string_equal(listed.name, result_table[n].name);
        char want[128] = "";
        for (const enum result_dimension *d = result_table[n].dimension; *d != NONE; d++) {
            if (*want) strcat(want, ", ");
            strcat(want, result_table_dimension(*d));
        }
        assert_string_equal(listed.dimensions, want);
    }
    assert_int_equal(n, result_table_n);
}

TEST(versions_of_the_libraries_are_those_loaded) {
    char text[VERSION_LENGTH];
    version_libraries(text);
    int suitesparse[3], found[3];
    SuiteSparse_version(suitesparse);
    const char *const of = strstr(text, "(SuiteSparse ");
    assert_non_null(of);
    assert_int_equal(sscanf(of, "(SuiteSparse %d.%d.%d)", &found[0], &found[1], &found[2]), 3);
    for (int i = 0; i < 3; i++) assert_int_equal(found[i], suitesparse[i]);
}

TEST_WITH(dimensions_are_those_of_the_largest_fish, set_up, tear_down) {
    struct fixture *f = *state;
    const int file = open_new(f, 3);
    assert_int_equal(length_of(file, "time"), 3);
    assert_int_equal(length_of(file, "fish"), 2);
    assert_int_equal(length_of(file, "node"), 7);
    assert_int_equal(length_of(file, "edge"), 6);
    assert_int_equal(length_of(file, "joint"), 5);
    assert_int_equal(length_of(file, "sheet"), 7);
    assert_int_equal(length_of(file, "vortex"), (size_t)wake_most(f->school, 10));
    assert_int_equal(length_of(file, "name"), strlen("suédois"));
}

TEST_WITH(attributes_name_the_case_the_program_and_the_conventions, set_up, tear_down) {
    struct fixture *f = *state;
    const int file = open_new(f, 1);
    assert_string_equal(text_of(file, NC_GLOBAL, "Conventions"), "CF-1.10");
    assert_string_equal(text_of(file, NC_GLOBAL, "title"), "result");
    assert_string_equal(text_of(file, NC_GLOBAL, "case_text"), CASE_TEXT);
    assert_string_equal(text_of(file, NC_GLOBAL, "case_effective"), EFFECTIVE);
    assert_string_equal(text_of(file, NC_GLOBAL, "run_status"), "complete");
    assert_non_null(strstr(text_of(file, NC_GLOBAL, "history"), "shoal run case.yaml"));
    assert_non_null(strstr(text_of(file, NC_GLOBAL, "source"), version_short()));
    assert_string_equal(text_of(file, number_of(file, "fish"), "_Encoding"), "utf-8");
}

TEST_WITH(constants_are_those_of_the_fish, set_up, tear_down) {
    struct fixture *f = *state;
    const int file = open_new(f, 0);
    char name[16] = {0};
    assert_int_equal(nc_get_vara_text(file, number_of(file, "fish"), (size_t[]){1, 0}, (size_t[]){1, 8}, name), 0);
    assert_string_equal(name, "suédois");
    NEAR(value_at(file, "n_nodes", 0, 0, 0, 0), 5, 0, 0);
    NEAR(value_at(file, "n_sheet", 1, 0, 0, 0), 5, 0, 0);
    NEAR(value_at(file, "body_length", 1, 0, 0, 0), 2, 0, 0);
    NEAR(value_at(file, "frequency", 0, 0, 0, 0), 2, 0, 0);
    NEAR(value_at(file, "shedding_interval", 0, 0, 0, 0), 0.1, 0, 0);
    NEAR(value_at(file, "edge_thickness", 1, 2, 0, 0), f->school->fish[1].thickness[2], 0, 0);
    NEAR(value_at(file, "node_mass", 0, 4, 0, 0), f->school->fish[0].mass[4], 0, 0);
    for (size_t k = 1; k < 4; k++) {
        const double arc = (double)k * value_at(file, "edge_length", 0, 0, 0, 0);
        NEAR(value_at(file, "node_arc", 0, k, 0, 0), arc, 0, 1e-15);
        NEAR(value_at(file, "joint_arc", 0, k - 1, 0, 0), arc, 0, 1e-15);
        NEAR(value_at(file, "edge_arc", 0, k, 0, 0), arc * ((double)k + 0.5) / (double)k, 0, 1e-15);
    }
    NEAR(value_at(file, "sheet_arc", 1, 4, 0, 0), 2, 0, 1e-15);
}

TEST_WITH(unknowns_of_each_fish_come_back, set_up, tear_down) {
    struct fixture *f = *state;
    const int file = open_new(f, 2);
    const struct layout *at = &f->school->fish[1].at;
    const double *y = f->state->y;
    NEAR(value_at(file, "x", 1, 1, 3, 0), y[at->x + 3], 0, 0);
    NEAR(value_at(file, "x", 1, 1, 3, 1), y[at->y + 3], 0, 0);
    NEAR(value_at(file, "v", 1, 1, 6, 0), y[at->vx + 6], 0, 0);
    NEAR(value_at(file, "v", 1, 1, 6, 1), y[at->vy + 6], 0, 0);
    NEAR(value_at(file, "a", 1, 1, 0, 0), y[at->ax], 0, 0);
    NEAR(value_at(file, "a", 1, 1, 0, 1), y[at->ay], 0, 0);
    NEAR(value_at(file, "sheet_strength", 1, 1, 4, 0), y[at->gamma + 4], 0, 0);
    // the first one after the 3 joints of fish 0, over the length of an edge
    NEAR(value_at(file, "natural_curvature", 1, 1, 0, 0), 4 / f->school->fish[1].edge_length, 0, 1e-15);
}

TEST_WITH(sheet_starts_at_the_nose_and_ends_at_the_tail, set_up, tear_down) {
    struct fixture *f = *state;
    const int file = open_new(f, 1);
    const struct layout *at = &f->school->fish[1].at;
    NEAR(value_at(file, "sheet_x", 0, 1, 0, 0), f->state->y[at->x], 0, 1e-15);
    NEAR(value_at(file, "sheet_x", 0, 1, 4, 1), f->state->y[at->y + 6], 0, 1e-15);
}

TEST_WITH(curvature_of_a_right_angle_is_two_over_an_edge, set_up, tear_down) {
    struct fixture *f = *state;
    const struct layout *at = &f->school->fish[0].at;
    const double x[] = {0, 1, 1, 0, 0}, y[] = {0, 0, 1, 1, 0};
    memcpy(f->state->y + at->x, x, sizeof x);
    memcpy(f->state->y + at->y, y, sizeof y);
    const int file = open_new(f, 1);
    for (size_t j = 0; j < 3; j++)
        NEAR(value_at(file, "curvature", 0, 0, j, 0), 2 / f->school->fish[0].edge_length, 0, 1e-15);
}

TEST_WITH(unused_slots_hold_nan, set_up, tear_down) {
    struct fixture *f = *state;
    const int file = open_new(f, 1);
    assert_true(isnan(value_at(file, "x", 0, 0, 5, 0)));
    assert_true(isnan(value_at(file, "curvature", 0, 0, 3, 0)));
    assert_true(isnan(value_at(file, "sheet_strength", 0, 1, 5, 0)));
    assert_true(isnan(value_at(file, "node_mass", 0, 5, 0, 0)));
    assert_true(isnan(value_at(file, "wake_x", 0, 0, 0, 0)));
    double fill = 0;
    assert_int_equal(nc_get_att_double(file, number_of(file, "x"), "_FillValue", &fill), NC_NOERR);
    assert_true(isnan(fill));
}

TEST_WITH(derived_quantities_have_their_names, set_up, tear_down) {
    struct fixture *f = *state;
    const int file = open_new(f, 2);
    NEAR(value_at(file, "time", 1, 0, 0, 0), 0.5, 0, 0);
    NEAR(value_at(file, "com", 1, 0, 1, 0), f->of_fish[0].com[1], 0, 0);
    NEAR(value_at(file, "com_velocity", 1, 1, 0, 0), f->of_fish[1].com_velocity[0], 0, 0);
    NEAR(value_at(file, "speed", 1, 1, 0, 0), f->of_fish[1].speed, 0, 0);
    NEAR(value_at(file, "heading", 1, 0, 0, 0), f->of_fish[0].heading, 0, 0);
    NEAR(value_at(file, "energy_balance", 1, 1, 0, 0), f->of_fish[1].energy_balance, 0, 0);
    NEAR(value_at(file, "strouhal", 1, 0, 0, 0), f->of_fish[0].strouhal, 0, 0);
    NEAR(value_at(file, "total_circulation", 1, 0, 0, 0), 11, 0, 0);
    NEAR(value_at(file, "least_distance", 1, 0, 0, 0), 12, 0, 0);
    NEAR(value_at(file, "polarisation", 1, 0, 0, 0), 13, 0, 0);
    NEAR(value_at(file, "steps", 1, 0, 0, 0), 21, 0, 0);
    NEAR(value_at(file, "jacobian_evaluations", 1, 0, 0, 0), 24, 0, 0);
    NEAR(value_at(file, "steps_of_order", 1, 1, 0, 0), 20, 0, 0);
    NEAR(value_at(file, "klu_refactorisations", 1, 0, 0, 0), 33, 0, 0);
    NEAR(value_at(file, "factor_non_zeros", 1, 0, 0, 0), 37, 0, 0);
    NEAR(value_at(file, "order", 1, 0, 0, 0), 2, 0, 0);
    NEAR(value_at(file, "wall_time", 1, 0, 0, 0), 28, 0, 0);
}

TEST_WITH(walls_are_there_where_the_case_has_them, set_up, tear_down) {
    struct fixture *f = *state;
    for (int n = 0; n <= 2; n++) {
        f->school->walls = (struct walls){n, {-7, 8}, {1, -1}};
        const int file = open_new(f, 1);
        int number;
        assert_int_equal(nc_inq_varid(file, "wall_y", &number), n > 0 ? NC_NOERR : NC_ENOTVAR);
        assert_int_equal(nc_inq_dimid(file, "wall", &number), n > 0 ? NC_NOERR : NC_EBADDIM);
        if (n > 0) assert_int_equal(length_of(file, "wall"), (size_t)n);
        for (size_t i = 0; i < (size_t)n; i++) {
            NEAR(value_at(file, "wall_y", i, 0, 0, 0), f->school->walls.y[i], 0, 0);
        }
        unlink(f->path);
    }
}

TEST_WITH(sensors_are_there_where_the_case_has_them, set_up, tear_down) {
    struct fixture *f = *state;
    double place[2] = {0.25, 0.5};
    struct fish *const fish = &f->school->fish[0];
    for (int n = 0; n <= 2; n += 2) {
        fish->n_sensors = n;
        fish->sensor = place;
        write_file(f, 1);
        fish->sensor = NULL;
        const int file = open_to_read(f);
        int number;
        assert_int_equal(nc_inq_varid(file, "sensor_pressure_left", &number), n > 0 ? NC_NOERR : NC_ENOTVAR);
        assert_int_equal(nc_inq_dimid(file, "sensor", &number), n > 0 ? NC_NOERR : NC_EBADDIM);
        for (size_t i = 0; i < (size_t)n; i++) {
            NEAR(value_at(file, "sensor_place", 0, i, 0, 0), place[i], 0, 0);
            assert_true(isnan(value_at(file, "sensor_place", 1, i, 0, 0)));
            assert_true(isnan(value_at(file, "sensor_pressure_right", 0, 1, i, 0)));
        }
        unlink(f->path);
    }
}

TEST(every_diagnostic_of_a_fish_has_a_variable) {
    bool is_written[N_OF_FISH] = {false};
    for (int i = 0; i < result_table_n; i++) {
        if (result_table[i].owner != OF_DIAGNOSTICS_FISH) continue;
        const size_t first = result_table[i].offset / sizeof(double),
                     n = result_table_has(&result_table[i], XY) ? 2 : 1;
        for (size_t k = first; k < first + n; k++) is_written[k] = true;
    }
    for (size_t k = 0; k < N_OF_FISH; k++) assert_true(is_written[k]);
}

TEST_WITH(wake_is_oldest_first_and_can_be_left_out, set_up, tear_down) {
    struct fixture *f = *state;
    struct wake *wake = &f->state->wake[1];
    struct result_file *result = create(f);
    assert_int_equal(append(f, result, 0, 1), STATUS_OK);
    wake_release(wake, 1, 2, 3, 0.1);
    wake_release(wake, 4, 5, 6, 0.2);
    assert_int_equal(append(f, result, 0.2, 1), STATUS_OK);
    assert_int_equal(append(f, result, 0.3, 0), STATUS_OK);
    assert_int_equal(result_file_close(result, "complete"), STATUS_OK);

    const int file = open_to_read(f);
    NEAR(value_at(file, "wake_count", 0, 1, 0, 0), 0, 0, 0);
    NEAR(value_at(file, "wake_count", 1, 1, 0, 0), 2, 0, 0);
    NEAR(value_at(file, "wake_x", 1, 1, 0, 1), 2, 0, 0);
    NEAR(value_at(file, "wake_x", 1, 1, 1, 0), 4, 0, 0);
    NEAR(value_at(file, "wake_circulation", 1, 1, 1, 0), 6, 0, 0);
    NEAR(value_at(file, "wake_birth", 1, 1, 0, 0), 0.1, 0, 0);
    assert_true(isnan(value_at(file, "wake_x", 1, 1, 2, 0)));
    assert_true(isnan(value_at(file, "wake_x", 1, 0, 0, 0)));
    NEAR(value_at(file, "wake_count", 2, 1, 0, 0), 2, 0, 0);
    assert_true(isnan(value_at(file, "wake_x", 2, 1, 0, 0)));
    assert_true(isnan(value_at(file, "wake_birth", 2, 1, 0, 0)));
}

TEST_WITH(single_precision_keeps_time_and_scalars_double, set_up, tear_down) {
    struct fixture *f = *state;
    f->values.output.precision = PRECISION_SINGLE;
    f->state->y[f->school->fish[0].at.x] = 0.1;
    const int file = open_new(f, 1);
    nc_type bulk, time, speed;
    nc_inq_vartype(file, number_of(file, "x"), &bulk);
    nc_inq_vartype(file, number_of(file, "time"), &time);
    nc_inq_vartype(file, number_of(file, "speed"), &speed);
    assert_int_equal(bulk, NC_FLOAT);
    assert_int_equal(time, NC_DOUBLE);
    assert_int_equal(speed, NC_DOUBLE);
    NEAR(value_at(file, "x", 0, 0, 0, 0), (double)0.1f, 0, 0);
    assert_true(isnan(value_at(file, "x", 0, 0, 5, 0)));
}

TEST_WITH(forces_of_edges_are_there_on_request_only, set_up, tear_down) {
    struct fixture *f = *state;
    const int file = open_new(f, 1);
    int number;
    assert_int_equal(nc_inq_varid(file, "edge_resistive_force", &number), NC_ENOTVAR);
    assert_int_equal(nc_inq_varid(file, "edge_reactive_force", &number), NC_ENOTVAR);
    assert_int_equal(nc_inq_varid(file, "resistive_force", &number), NC_NOERR);
}

TEST_WITH(long_status_is_cut, set_up, tear_down) {
    struct fixture *f = *state;
    char reason[1000];
    memset(reason, 'x', sizeof reason);
    memcpy(reason, "failed: ", 8);
    reason[sizeof reason - 1] = '\0';
    struct result_file *result = create(f);
    assert_int_equal(result_file_close(result, reason), STATUS_OK);
    const int file = open_to_read(f);
    assert_memory_equal(text_of(file, NC_GLOBAL, "run_status"), reason, 255);
    assert_int_equal(strlen(text_of(file, NC_GLOBAL, "run_status")), 255);
}

// ---- while it is written ----

TEST_WITH(file_can_be_read_between_rows, set_up, tear_down) {
    struct fixture *f = *state;
    struct result_file *result = create(f);
    for (size_t n = 0; n < 4; n++) {
        const int file = open_to_read(f);
        assert_int_equal(length_of(file, "time"), n);
        assert_string_equal(text_of(file, NC_GLOBAL, "run_status"), "running");
        if (n > 0) {
            NEAR(value_at(file, "time", n - 1, 0, 0, 0), (double)n - 1, 0, 0);
            NEAR(value_at(file, "wall_time", n - 1, 0, 0, 0), 28, 0, 0);
        }
        assert_int_equal(append(f, result, (double)n, 1), STATUS_OK);
    }
    assert_int_equal(result_file_close(result, "stopped"), STATUS_OK);
}

TEST(closing_nothing_is_allowed) {
    assert_int_equal(result_file_close(NULL, "complete"), STATUS_OK);
}

// ---- failures ----

static void assert_refused(struct fixture *f, const char *path, int overwrite, const char *part) {
    struct result_file *result;
    struct result_origin origin = origin_of(f);
    origin.path = path;
    origin.overwrite = overwrite;
    assert_int_equal(result_file_create(f->arena, &result, &origin), STATUS_FILE);
    assert_null(result);
    assert_message(path);
    assert_message(part);
}

TEST_WITH(existing_file_stays_untouched, set_up, tear_down) {
    struct fixture *f = *state;
    FILE *other = fopen(f->path, "w");
    fputs("mine", other);
    fclose(other);
    assert_refused(f, f->path, 0, "exists and is no NetCDF file of shoal");
    char text[8] = {0};
    other = fopen(f->path, "r");
    assert_int_equal(fread(text, 1, 7, other), 4);
    fclose(other);
    assert_string_equal(text, "mine");
}

static size_t number_of_rows(struct fixture *f) {
    return length_of(open_to_read(f), "time");
}

TEST_WITH(a_file_without_its_name_leaves_nothing, set_up, tear_down) {
    struct fixture *f = *state;
    struct result_file *result;
    write_file(f, 3);
    assert_int_equal(begin(f, true, false, &result), STATUS_OK);
    assert_int_equal(append(f, result, 0, 1), STATUS_OK);
    assert_int_equal(result_file_close(result, "failed: for a reason"), STATUS_OK);
    assert_int_equal(number_of_rows(f), 3);
}

/* Remove the file, replace it by another one, or rename it, while it is written. */
static void take_name(struct fixture *f, int how, char renamed[80]) {
    snprintf(renamed, 80, "%s/renamed.nc", f->folder);
    assert_int_equal(how == 2 ? rename(f->path, renamed) : unlink(f->path), 0);
    if (how != 1) return;
    FILE *const other = fopen(f->path, "w");
    fputs("other", other);
    fclose(other);
}

TEST_WITH(a_file_that_loses_its_name_is_an_error, set_up, tear_down) {
    struct fixture *f = *state;
    char renamed[80];
    for (int how = 0; how < 3; how++) {
        // noticed by the next row, by a mark, and when the file is closed
        struct result_file *result = create(f);
        struct result_mark mark;
        assert_int_equal(append(f, result, 0, 1), STATUS_OK);
        take_name(f, how, renamed);
        assert_int_equal(append(f, result, 1, 1), STATUS_FILE);
        assert_message(f->path);
        assert_message("was removed or replaced during the run");
        assert_int_equal(result_file_mark(result, &mark), STATUS_FILE);
        assert_message("was removed or replaced during the run");
        assert_int_equal(result_file_close(result, "failed: for a reason"), STATUS_FILE);
        assert_message("was removed or replaced during the run");
        unlink(f->path);
        unlink(renamed);
    }
}

/* What another program, or a user, has made is not replaced, however the file begins. */
TEST_WITH(existing_file_of_another_program_is_never_replaced, set_up, tear_down) {
    struct fixture *f = *state;
    const char *const texts[] = {"mine", "format: 1\n", "CDF\1 of another program", "<!DOCTYPE html>"};
    for (int i = 0; i < 4; i++) {
        FILE *const other = fopen(f->path, "w");
        fputs(texts[i], other);
        fclose(other);
        assert_refused(f, f->path, 1, "is no NetCDF file of shoal, so no option replaces the file");
    }
}

TEST_WITH(existing_file_is_replaced_when_asked, set_up, tear_down) {
    struct fixture *f = *state;
    write_file(f, 3);
    struct result_file *result;
    assert_int_equal(begin(f, true, false, &result), STATUS_OK);
    assert_int_equal(number_of_rows(f), 3);
    assert_int_equal(result_file_publish(result, "running"), STATUS_OK);
    assert_int_equal(result_file_close(result, "complete"), STATUS_OK);
    assert_int_equal(number_of_rows(f), 0);
}

TEST_WITH(wrong_places_are_named, set_up, tear_down) {
    struct fixture *f = *state;
    char missing[64];
    snprintf(missing, sizeof missing, "%s/no/run.nc", f->folder);
    assert_refused(f, missing, 0, "there is no folder");
    assert_refused(f, f->folder, 1, "is a folder");
    assert_refused(f, "/dev/null", 1, "not an ordinary file");
    // the kernel's own files, where they are mounted: a folder in which not even root makes a file
    if (access("/sys/kernel", F_OK) == 0) assert_refused(f, "/sys/run.nc", 0, "cannot be written to");
    assert_refused(f, "", 0, "is empty");
}

/* Set the largest size that files may have, in bytes; returns the limit before. */
static rlim_t limit_file_size(rlim_t size) {
    signal(SIGXFSZ, SIG_IGN);
    struct rlimit limit;
    getrlimit(RLIMIT_FSIZE, &limit);
    const rlim_t before = limit.rlim_cur;
    limit.rlim_cur = size;
    setrlimit(RLIMIT_FSIZE, &limit);
    return before;
}

TEST_WITH(full_disk_leaves_no_file_without_a_header, set_up, tear_down) {
    struct fixture *f = *state;
    for (rlim_t size = 0; size < 20000; size += 3000) {
        const rlim_t before = limit_file_size(size);
        struct result_file *result;
        const enum status status = begin(f, false, false, &result);
        limit_file_size(before);
        assert_int_equal(status, STATUS_FILE);
        assert_message("File too large");
        assert_int_not_equal(access(f->path, F_OK), 0);
    }
}

TEST_WITH(full_disk_keeps_the_rows_before, set_up, tear_down) {
    struct fixture *f = *state;
    struct result_file *result = create(f);
    const rlim_t before = limit_file_size(100000);
    int n_rows = 0;
    enum status status;
    while ((status = append(f, result, n_rows, 1)) == STATUS_OK) n_rows++;
    assert_int_equal(status, STATUS_FILE);
    assert_message(f->path);
    assert_message("File too large");
    assert_int_equal(result_file_close(result, "failed: no room"), STATUS_OK);
    limit_file_size(before);

    assert_in_range(n_rows, 5, 1000);
    const int file = open_to_read(f);
    assert_int_equal(length_of(file, "time"), n_rows);
    assert_string_equal(text_of(file, NC_GLOBAL, "run_status"), "failed: no room");
    NEAR(value_at(file, "wall_time", (size_t)n_rows - 1, 0, 0, 0), 28, 0, 0);
}

/* A checkpoint of few rows, then one of more, has the checksum of all rows. */
TEST_WITH(a_checksum_goes_on_where_it_ended, set_up, tear_down) {
    struct fixture *f = *state;
    write_file(f, 3);
    struct result_checksum in_parts = {0}, at_once = {0};
    struct result_mark part, whole;
    assert_int_equal(result_mark_take(f->path, 1, &in_parts, &part), STATUS_OK);
    assert_int_equal(result_mark_take(f->path, 3, &in_parts, &part), STATUS_OK);
    assert_int_equal(result_mark_take(f->path, 3, &at_once, &whole), STATUS_OK);
    assert_int_equal(part.check, whole.check);
}

TEST_WITH(too_many_vortices_are_refused, set_up, tear_down) {
    struct fixture *f = *state;
    struct result_file *result = create(f);
    const int most = wake_most(f->school, 10);
    char message[80];
    for (int i = 0; i <= most; i++) wake_release(&f->state->wake[1], 0, 0, 0, 0);
    assert_int_equal(append(f, result, 0.25, 1), STATUS_FILE);
    snprintf(message, sizeof message, "%d vortices of suédois at t = 0.25 s, but the file has room for %d", 1 + most,
             most);
    assert_message(message);
    assert_int_equal(result_file_close(result, "failed"), STATUS_OK);
}

// ---- what a state is called

TEST(a_state_is_stable_or_not_by_the_sign_of_its_excess) {
    assert_string_equal(steady_verdict(-0.1, 0.05), "stable");
    assert_string_equal(steady_verdict(0.1, 0.05), "unstable");
    assert_string_equal(steady_verdict(0.1, 0.1), "undecided");

    // a growth rate may be of any size
    assert_string_equal(steady_verdict(1e-20, 0), "unstable");
    assert_string_equal(steady_verdict(-1e-20, 0), "stable");
}
