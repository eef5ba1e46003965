/* result_fixture.h: What the tests of result files share: a folder, a file in it, and everything of which a row is
 * made. */
#ifndef RESULT_FIXTURE_H
#define RESULT_FIXTURE_H

#include <netcdf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fish/fish_school.h"
#include "near.h"
#include "result/result_file.h"

enum { N_FISH = 2, N_OF_FISH = sizeof(struct diagnostics_fish) / sizeof(double) };

#define CASE_TEXT                                                                                      \
    "format: 1\n"                                                                                      \
    "name: result\n"                                                                                   \
    "time: {end: 1, shedding_interval: 0.1}\n"                                                         \
    "wake: {shedding: continuous, taper: 0, taper_beside: 0}\n"                                        \
    "fish:\n"                                                                                          \
    "  - {name: leader, nodes: 5, sheet_points: 7, wave: {frequency: 2}, start: {position: [0, 0]}}\n" \
    "  - {name: suédois, nodes: 7, sheet_points: 5, length: 2, start: {position: [0, 5]}}\n"
#define EFFECTIVE "format: 1\nname: the whole case\n"

// Everything a row is made of, each number different from all others, and a folder to write in.
struct fixture {
    struct arena *arena;
    struct case_values values;
    struct school *school;
    struct state *state;
    struct residual residual;
    struct range joints[N_FISH];
    struct fluid_force force[N_FISH]; /* without pressure */
    double natural_curvature[8];
    struct diagnostics diagnostics;
    struct diagnostics_fish of_fish[N_FISH];
    struct integrator_counts counts;
    char folder[32], path[64];
    int file; /* path, open to read; or -1 */
};

static inline void number_consecutively(double *value, size_t n, double first) {
    for (size_t i = 0; i < n; i++) value[i] = first + (double)i;
}

static inline int set_up(void **state) {
    struct fixture *f = calloc(1, sizeof *f);
    f->file = -1;
    f->arena = arena_create(NULL, "a test");
    assert_int_equal(case_parse(&f->values, CASE_TEXT, strlen(CASE_TEXT), "case", ".", 0, NULL), STATUS_OK);
    assert_int_equal(fish_school_create(NULL, &f->school, &f->values.school), STATUS_OK);
    f->state = state_create(NULL, f->school);
    number_consecutively(f->state->y, (size_t)f->school->n_unknowns, 1000);
    for (int i = 0; i < N_FISH; i++) {
        f->joints[i] = (struct range){i == 0 ? 0 : 3, f->school->fish[i].n_joints};
        number_consecutively((double *)&f->of_fish[i], N_OF_FISH, 100.0 * (i + 1));
    }
    number_consecutively(f->natural_curvature, 8, 1);
    f->residual = (struct residual){.school = f->school,
                                    .state = f->state,
                                    .force = f->force,
                                    .joints = f->joints,
                                    .muscle = {.curvature = f->natural_curvature}};
    f->diagnostics =
        (struct diagnostics){.fish = f->of_fish, .total_circulation = 11, .least_distance = 12, .polarisation = 13};
    f->counts = (struct integrator_counts){.steps = 21,
                                           .residual_evaluations = 22,
                                           .newton_iterations = 23,
                                           .jacobian_evaluations = 24,
                                           .steps_of_order = {1, 20},
                                           .klu_analyses = 31,
                                           .klu_factorisations = 32,
                                           .klu_refactorisations = 33,
                                           .gmres_iterations = 34,
                                           .initial_iterations = 35,
                                           .jacobian_non_zeros = 36,
                                           .factor_non_zeros = 37,
                                           .error_test_failures = 25,
                                           .convergence_failures = 26,
                                           .step_size = 27,
                                           .order = 2};
    strcpy(f->folder, "/tmp/test_result.XXXXXX");
    assert_non_null(mkdtemp(f->folder));
    snprintf(f->path, sizeof f->path, "%s/run.nc", f->folder);
    *state = f;
    return 0;
}

static inline void close_to_read(struct fixture *f) {
    if (f->file >= 0) nc_close(f->file);
    f->file = -1;
}

static inline int tear_down(void **state) {
    struct fixture *f = *state;
    close_to_read(f);
    unlink(f->path);
    arena_free(f->arena);
    assert_int_equal(rmdir(f->folder), 0);  // nothing else is left in it
    state_free(f->state);
    fish_school_free(f->school);
    case_free(&f->values);
    free(f);
    return 0;
}

// ---- writing ----

static inline struct result_origin origin_of(struct fixture *f) {
    return (struct result_origin){.path = f->path,
                                  .values = &f->values,
                                  .effective = EFFECTIVE,
                                  .command = "shoal run case.yaml",
                                  .school = f->school,
                                  .n_events = 10};
}

static inline enum status begin(struct fixture *f, bool overwrite, bool is_steady, struct result_file **result) {
    struct result_origin origin = origin_of(f);
    origin.overwrite = overwrite;
    origin.is_steady = is_steady;
    return result_file_create(f->arena, result, &origin);
}

static inline struct result_file *create(struct fixture *f) {
    struct result_file *result;
    assert_int_equal(begin(f, false, false, &result), STATUS_OK);
    assert_int_equal(result_file_publish(result, "running"), STATUS_OK);
    return result;
}

static inline enum status append(struct fixture *f, struct result_file *result, double t, bool with_wake) {
    f->state->t = t;
    return result_file_row(result, &(struct result_row){.school = f->school,
                                                        .state = f->state,
                                                        .residual = &f->residual,
                                                        .diagnostics = &f->diagnostics,
                                                        .counts = &f->counts,
                                                        .wall_time = 28,
                                                        .with_wake = with_wake != 0});
}

/* A whole file with rows at t = 0, 0.5, ... */
static inline void write_file(struct fixture *f, int n_rows) {
    struct result_file *result = create(f);
    for (int i = 0; i < n_rows; i++) assert_int_equal(append(f, result, 0.5 * i, 1), STATUS_OK);
    assert_int_equal(result_file_close(result, "complete"), STATUS_OK);
}

/* A steady state, with rows at n times. */
static inline void write_steady(struct fixture *f, int n, const double *times, const struct steady_values *values) {
    struct result_file *result;
    assert_int_equal(begin(f, false, true, &result), STATUS_OK);
    for (int i = 0; i < n; i++) assert_int_equal(append(f, result, times[i], 0), STATUS_OK);
    result_file_steady(result, f->school, values);
    assert_int_equal(result_file_publish(result, "complete"), STATUS_OK);
    assert_int_equal(result_file_close(result, "complete"), STATUS_OK);
}

// ---- reading ----

/* The file, open until the next call or the end of the test. */
static inline int open_to_read(struct fixture *f) {
    close_to_read(f);
    assert_int_equal(nc_open(f->path, NC_NOWRITE, &f->file), NC_NOERR);
    return f->file;
}

/* The same, of a new file with rows. */
static inline int open_new(struct fixture *f, int n_rows) {
    write_file(f, n_rows);
    return open_to_read(f);
}

static inline int number_of(int file, const char *name) {
    int number;
    if (nc_inq_varid(file, name, &number) != NC_NOERR) fail_msg("there is no variable %s", name);
    return number;
}

/* One value; the unused indices are ignored. */
static inline double value_at(int file, const char *name, size_t i, size_t j, size_t k, size_t l) {
    double value;
    assert_int_equal(nc_get_var1_double(file, number_of(file, name), (size_t[]){i, j, k, l}, &value), NC_NOERR);
    return value;
}

static inline size_t length_of(int file, const char *name) {
    int number;
    size_t length;
    assert_int_equal(nc_inq_dimid(file, name, &number), NC_NOERR);
    assert_int_equal(nc_inq_dimlen(file, number, &length), NC_NOERR);
    return length;
}

static inline const char *text_of(int file, int variable, const char *name) {
    static char text[4096];
    size_t length;
    if (nc_inq_attlen(file, variable, name, &length) != NC_NOERR) fail_msg("there is no attribute %s", name);
    BELOW(length, sizeof text);
    memset(text, 0, sizeof text);
    assert_int_equal(nc_get_att_text(file, variable, name, text), NC_NOERR);
    return text;
}

// ---- messages ----

static inline void assert_message(const char *part) {
    if (strstr(status_message(), part) == NULL) fail_msg("\"%s\" is not in \"%s\"", part, status_message());
}

#define WITH_FILE(test) cmocka_unit_test_setup_teardown(test, set_up, tear_down)

#endif
