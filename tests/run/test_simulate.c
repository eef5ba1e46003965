/* test_simulate.c: Short runs of the whole program have the symmetries of the model, and end or fail as they should. */
#include <netcdf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "result/checkpoint.h"
#include "run/checkpoints.h"
#include "run/simulate_run.h"
#include "school.h"
#include "school/residual_jacobian.h"
#include "solver/sundials.h"

#define TIME "time: {end: 0.5, shedding_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"
#define TIGHT "solver: {rtol: 1.0e-8, order: 2, coupling_distance: 100}\n"

// nose, tail, circulation shed and newest vortex of a fish
struct outcome {
    double nose[2], tail[2], shed, vortex[2];
};

static void outcomes_of(const char *text, int n_fish, struct outcome *outcome) {
    struct simulation *const simulation = school_simulation(text);
    school_run(simulation, 0.5);
    assert_int_equal(simulation->school->n_fish, n_fish);
    for (int f = 0; f < n_fish; f++) {
        const struct fish *fish = &simulation->school->fish[f];
        const struct wake *wake = &simulation->state->wake[f];
        const double *const x = simulation->state->y + fish->at.x, *const y = simulation->state->y + fish->at.y;
        const int tail = fish->n_nodes - 1;
        outcome[f] = (struct outcome){{x[0], y[0]},
                                      {x[tail], y[tail]},
                                      simulation->state->y[fish->at.circulation],
                                      {wake->x[wake->n_vortex - 1], wake->y[wake->n_vortex - 1]}};
    }
}

static void same(const struct outcome *got, const struct outcome *want) {
    // errors of a run at rtol 1e-8, some 1e-7; all lengths are of order 1
    NEAR_ARRAY(2, got->nose, want->nose, 1e-6, 0);
    NEAR_ARRAY(2, got->tail, want->tail, 1e-6, 0);
    NEAR_ARRAY(2, got->vortex, want->vortex, 1e-6, 0);
    NEAR(got->shed, want->shed, 1e-5, 0);
    // the compared values are not zero
    ABOVE(fabs(want->shed), 1e-4);
}

#define LEFT "{name: a, body: {modulus: 1.0e+5}}"
#define RIGHT                                                                                      \
    "{name: b, nodes: 6, length: 0.8, start: {position: [0.2, 0.5], heading: 170}, wave: {phase: " \
    "60}}"

TEST(order_of_the_fish_does_not_matter) {
    struct outcome one[2], other[2];
    outcomes_of(SMALL TIGHT "fish: [" LEFT ", " RIGHT "]\n", 2, one);
    outcomes_of(SMALL TIGHT "fish: [" RIGHT ", " LEFT "]\n", 2, other);
    same(&one[0], &other[1]);
    same(&one[1], &other[0]);
}

TEST(a_shift_of_the_start_shifts_the_run) {
    struct outcome at_origin, elsewhere;
    outcomes_of(SMALL TIGHT "fish: [{body: {modulus: 1.0e+5}}]\n", 1, &at_origin);
    outcomes_of(SMALL TIGHT "fish: [{body: {modulus: 1.0e+5}, start: {position: [3, -7]}}]\n", 1, &elsewhere);
    double *const moved[] = {elsewhere.nose, elsewhere.tail, elsewhere.vortex};
    for (int i = 0; i < 3; i++) {
        moved[i][0] -= 3;
        moved[i][1] += 7;
    }
    same(&elsewhere, &at_origin);
}

TEST(a_turn_of_everything_turns_the_run) {
    struct outcome one[2], turned[2];
    outcomes_of(SMALL TIGHT
                "fluid: {velocity: [0.1, 0.05]}\n"
                "fish: [{control: {law: heading, desired_heading: 160}}, {start: {position: [0.3, 0.6]}}]\n",
                2, one);
    // by 90 degrees to the left: (x, y) becomes (-y, x)
    outcomes_of(SMALL TIGHT
                "fluid: {velocity: [-0.05, 0.1]}\n"
                "fish: [{start: {heading: 270}, control: {law: heading, desired_heading: 250}},\n"
                "  {start: {position: [-0.6, 0.3], heading: 270}}]\n",
                2, turned);
    for (int f = 0; f < 2; f++) {
        double *const places[] = {turned[f].nose, turned[f].tail, turned[f].vortex};
        for (int i = 0; i < 3; i++) {
            const double x = places[i][0];
            places[i][0] = places[i][1];
            places[i][1] = -x;
        }
        same(&turned[f], &one[f]);
    }
}

TEST(the_mirror_image_of_a_case_runs_as_the_mirror_image) {
    struct outcome one[2], mirrored[2];
    outcomes_of(SMALL TIGHT
                "fluid: {velocity: [0.1, 0.05], shear: 0.2}\nfish: [{control: {law: heading, desired_heading: 160}},\n"
                "  {start: {position: [0.3, 0.6], heading: 170}, control: {bias: 0.2}}]\n",
                2, one);
    // y becomes -y: the wave is half a beat on, angles, bias and shear change sign
    outcomes_of(TIME TIGHT
                "fluid: {velocity: [0.1, -0.05], shear: -0.2}\ndefaults: {fish: {nodes: 7, wave: {phase: 180}}}\n"
                "fish: [{control: {law: heading, desired_heading: 200}},\n"
                "  {start: {position: [0.3, -0.6], heading: 190}, control: {bias: -0.2}}]\n",
                2, mirrored);
    for (int f = 0; f < 2; f++) {
        mirrored[f].nose[1] *= -1;
        mirrored[f].tail[1] *= -1;
        mirrored[f].vortex[1] *= -1;
        mirrored[f].shed *= -1;
        same(&mirrored[f], &one[f]);
    }
}

TEST(fish_far_apart_swim_as_if_alone) {
    struct outcome alone, pair[2];
    outcomes_of(SMALL TIGHT "fish: [{}]\n", 1, &alone);
    outcomes_of(SMALL TIGHT "fish: [{}, {start: {position: [0, 1.0e+5]}}]\n", 2, pair);
    same(&pair[0], &alone);
}

TEST(two_runs_of_one_case_have_the_same_bits) {
    struct outcome one[2], other[2];
    outcomes_of(SMALL "fish: [" LEFT ", " RIGHT "]\n", 2, one);
    outcomes_of(SMALL "fish: [" LEFT ", " RIGHT "]\n", 2, other);
    assert_memory_equal(one, other, sizeof one);
}

TEST(an_uncoupled_jacobian_gives_the_same_run) {
    struct outcome one[2], other[2];
    outcomes_of(SMALL TIGHT "fish: [" LEFT ", " RIGHT "]\n", 2, one);
    outcomes_of(SMALL "solver: {rtol: 1.0e-8, coupling_distance: 0}\nfish: [" LEFT ", " RIGHT "]\n", 2, other);
    same(&other[0], &one[0]);
    same(&other[1], &one[1]);
}

TEST(places_are_second_order_in_the_shedding_interval) {
    struct outcome at[3];
    const char *const intervals[] = {"0.02", "0.01", "0.005"};
    for (int i = 0; i < 3; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 0.8, shedding_interval: %s}\nsolver: {rtol: 1.0e-10, order: 5}\n"
            "wake: {shedding: continuous}\nfish: [{nodes: 7, force: published, body: {modulus: 1.0e+6}}]\n",
            intervals[i]);
        school_run(simulation, 0.8);
        const struct fish *fish = simulation->school->fish;
        at[i].shed = simulation->state->y[fish->at.circulation];
        at[i].tail[0] = simulation->state->y[fish->at.y + fish->n_nodes - 1];
    }
    // 2.0 to 2.1 for smaller intervals; the tolerance keeps the error of the integrator far below the differences
    const double tail = log2(fabs((at[1].tail[0] - at[0].tail[0]) / (at[2].tail[0] - at[1].tail[0])));
    const double shed = log2(fabs((at[1].shed - at[0].shed) / (at[2].shed - at[1].shed)));
    print_message("observed order: tail %.2f, shed %.2f\n", tail, shed);
    ABOVE(tail, 1.6);
    BELOW(tail, 2.8);
    ABOVE(shed, 1.6);
    BELOW(shed, 2.8);
}

TEST(positive_bias_turns_right) {
    double heading[2];
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation(
            i == 0 ? "time: {end: 3, shedding_interval: 0.02}\nfish: [{nodes: 7, control: {bias: 0.5}}]\n"
                   : "time: {end: 3, shedding_interval: 0.02}\nfish: [{nodes: 7, control: {bias: -0.5}}]\n");
        school_measure(simulation, 3);
        heading[i] = simulation->diagnostics->fish[0].heading;
    }
    // after three beats; within a beat the heading oscillates by some degrees
    BELOW(heading[0], 170);
    ABOVE(heading[1], 190);
}

static int n_told;
static void count_progress(const struct simulate_progress *progress, void *data) {
    (void)data;
    n_told++;
    assert_int_equal(progress->event, n_told);
    NEAR(progress->t, 0.02 * n_told, 1e-15, 0);
    NEAR(progress->end, 0.5, 0, 0);
}

static void run_into(const char *text, const struct simulate_options *options, enum status want) {
    const struct case_values values = school_values(text);
    const enum status status = simulate_run(&values, options);
    if (status != want) print_error("%s\n", status_message());
    assert_int_equal(status, want);
}

/* An attribute of a result, until the end of the test. */
static const char *read_attribute(const char *path, const char *name) {
    int file;
    size_t n;
    assert_int_equal(nc_open(path, NC_NOWRITE, &file), NC_NOERR);
    assert_int_equal(nc_inq_attlen(file, NC_GLOBAL, name, &n), NC_NOERR);
    char *const text = arena_new(test_arena(), n + 1, 1);
    assert_int_equal(nc_get_att_text(file, NC_GLOBAL, name, text), NC_NOERR);
    nc_close(file);
    return text;
}

/* The checkpoint of a result, with an ending. */
static const char *checkpoint_of(const char *result, const char *ending) {
    static char path[128];
    snprintf(path, sizeof path, "%s%s", checkpoints_path(test_arena(), result), ending);
    return path;
}

TEST(the_times_of_checkpoints_are_a_list_in_the_result) {
    const char *const path = *state;
    const struct simulate_options options = {
        .path = path, .overwrite = 1, .command = "test", .checkpoint_at = "0.04,0.1,0.5"};
    run_into(SMALL "fish: [{}]\n", &options, STATUS_OK);
    assert_string_equal(read_attribute(path, "checkpoint_at"), "0.04,0.1,0.5");
    unlink(checkpoint_of(path, ""));
    unlink(checkpoint_of(path, ".previous"));
}

TEST(a_run_tells_its_progress_at_every_event) {
    const char *const path = *state;
    const struct simulate_options options = {
        .path = path, .overwrite = 1, .command = "test", .progress = count_progress};
    n_told = 0;
    run_into(SMALL "fish: [{}]\n", &options, STATUS_OK);
    assert_int_equal(n_told, 25);
    assert_int_equal(access(path, R_OK), 0);
}

static int n_between;
static double last_told;
static void count_between(const struct simulate_progress *progress, void *data) {
    (void)data;
    ABOVE(progress->t, last_told - 1e-15);
    last_told = progress->t;
    n_between += progress->t < 0.02 * (double)(progress->event + 1) - 1e-9 &&
                 progress->t > 0.02 * (double)progress->event + 1e-9;
}

TEST(an_event_of_many_steps_tells_its_progress_in_between) {
    const struct simulate_options options = {
        .path = *state, .overwrite = 1, .command = "test", .progress = count_between};
    n_between = 0;
    last_told = 0;
    // a body soft enough for an explicit step of 4e-5 s
    run_into(
        "time: {end: 0.04, shedding_interval: 0.02}\nsolver: {method: rk4, step: 4e-5}\n"
        "fish: [{force: reactive, nodes: 7, body: {modulus: 1e4}}]\n",
        &options, STATUS_OK);
    // 500 steps from event to event; the fifth report of each is at the event
    assert_int_equal(n_between, 2 * 4);
}

/* Read wake_count of the rows 0 to 4 into n_vortices, and into holds_wake whether these rows contain the vortices. */
static void read_wake(const char *path, int n_vortices[5], int holds_wake[5]) {
    int file, count, x;
    assert_int_equal(nc_open(path, NC_NOWRITE, &file), NC_NOERR);
    assert_int_equal(nc_inq_varid(file, "wake_count", &count), NC_NOERR);
    assert_int_equal(nc_inq_varid(file, "wake_x", &x), NC_NOERR);
    for (size_t row = 0; row < 5; row++) {
        double position;
        assert_int_equal(nc_get_var1_int(file, count, (size_t[]){row, 0}, &n_vortices[row]), NC_NOERR);
        assert_int_equal(nc_get_var1_double(file, x, (size_t[]){row, 0, 0, 0}, &position), NC_NOERR);
        holds_wake[row] = !isnan(position);
    }
    nc_close(file);
}

TEST(the_wake_is_written_at_its_own_interval_and_at_the_end) {
    const char *const path = *state;
    const struct simulate_options options = {.path = path, .overwrite = 1, .command = "test"};
    run_into(
        "time: {end: 0.28, shedding_interval: 0.02, output_interval: 0.08}\noutput: {wake_interval: 0.16}\nfish: "
        "[{nodes: 7}]\n",
        &options, STATUS_OK);
    // rows at 0, 0.08, 0.16, 0.24 and at the end, which is on neither interval
    int n_vortices[5], holds_wake[5];
    read_wake(path, n_vortices, holds_wake);
    const int count[] = {1, 5, 9, 13, 15}, held[] = {1, 0, 1, 0, 1};
    assert_memory_equal(n_vortices, count, sizeof count);
    assert_memory_equal(holds_wake, held, sizeof held);
}

static volatile sig_atomic_t stop;
static void stop_at_the_fifth(const struct simulate_progress *progress, void *data) {
    (void)data;
    stop = progress->event >= 5;
}

// also after the equations were created again, at a checkpoint: within the sums of the gradients, which are then zero
TEST(a_signal_ends_a_jacobian) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 1, shedding_interval: 0.02}\n"
        "fish: [{}, {start: {position: [0, 1]}}]\n");
    const struct school *const school = simulation->school;
    stop = 0;
    simulation->stop = &stop;
    school_ok(simulate_renew(simulation));
    school_ok(simulate_step(simulation));
    struct residual *const residual = simulation->residual;
    struct jacobian *const jacobian = jacobian_create(simulation->arena, school);
    const double *const y = simulation->state->y, t = simulation->state->t;
    school_ok(residual_jacobian(residual, &residual_run, t, 1, y, jacobian));
    ABOVE(fabs(residual->flow->u_x[0]), 0);
    stop = 1;
    assert_int_equal(residual_jacobian(residual, &residual_run, t, 1, y, jacobian), STATUS_STOPPED);
    for (int p = 0; p < residual->flow->n_points; p++) NEAR(residual->flow->u_x[p], 0, 0, 0);
    stop = 0;
}

TEST(a_signal_stops_a_run_at_the_next_event) {
    const struct simulate_options options = {
        .path = *state, .overwrite = 1, .command = "test", .progress = stop_at_the_fifth, .stop = &stop};
    stop = 0;
    run_into(SMALL "fish: [{}]\n", &options, STATUS_STOPPED);
    assert_non_null(strstr(status_message(), "t = 0.1"));
}

TEST(a_result_with_only_the_previous_checkpoint_is_unfinished_too) {
    const char *const text = SMALL "fish: [{}]\n";
    char path[128], previous[128];
    strcpy(path, checkpoint_of(*state, ""));
    strcpy(previous, checkpoint_of(*state, ".previous"));
    struct simulate_options options = {.path = *state,
                                       .overwrite = 1,
                                       .command = "test",
                                       .checkpoint_at = "0.04",
                                       .progress = stop_at_the_fifth,
                                       .stop = &stop};
    stop = 0;
    run_into(text, &options, STATUS_STOPPED);
    stop = 0;
    options.overwrite = 0;
    run_into(text, &options, STATUS_FILE);
    assert_non_null(strstr(status_message(), "continue from t = 0.1 s with"));
    assert_int_equal(truncate(path, 100), 0);
    run_into(text, &options, STATUS_FILE);
    assert_non_null(strstr(status_message(), "is an unfinished result of this case: continue from t = 0.04 s with"));
    // without checkpoints it is only a file that exists
    assert_int_equal(unlink(previous), 0);
    run_into(text, &options, STATUS_FILE);
    assert_null(strstr(status_message(), "unfinished"));
    assert_non_null(strstr(status_message(), "exists"));
}

static double wall_time, first_resumed;
static void take_a_tenth_of_a_second(const struct simulate_progress *progress, void *data) {
    (void)data;
    if (progress->event == 1) nanosleep(&(struct timespec){.tv_nsec = 100000000}, NULL);
    stop = progress->event >= 2;
    wall_time = progress->wall_time;
}

static void note_the_first(const struct simulate_progress *progress, void *data) {
    (void)data;
    if (progress->event == 3) first_resumed = progress->wall_time;
}

TEST(wall_time_of_a_resumed_run_continues) {
    const char *const path = checkpoint_of(*state, "");
    struct simulate_options options = {
        .path = *state, .overwrite = 1, .command = "test", .progress = take_a_tenth_of_a_second, .stop = &stop};
    stop = 0;
    run_into(SMALL "fish: [{}]\n", &options, STATUS_STOPPED);
    ABOVE(wall_time, 0.1);
    stop = 0;
    options.progress = note_the_first;
    school_ok(simulate_resume(path, &(struct simulate_changes){0}, &options));
    ABOVE(first_resumed, 0.1);
}

// number of the KINSOL call, from 0, at which a signal arrives; -1: no signal
static int n_until_signal = -1;

int __real_KINSol(void *kinsol, N_Vector solution, int strategy, N_Vector solution_scale, N_Vector value_scale);
int __wrap_KINSol(void *kinsol, N_Vector solution, int strategy, N_Vector solution_scale, N_Vector value_scale);
int __wrap_KINSol(void *kinsol, N_Vector solution, int strategy, N_Vector solution_scale, N_Vector value_scale) {
    if (n_until_signal >= 0 && n_until_signal-- == 0) stop = 1;
    return __real_KINSol(kinsol, solution, strategy, solution_scale, value_scale);
}

TEST(a_signal_within_the_event_of_a_run_leads_back_to_the_last_one) {
    static const char text[] = SMALL "wake: {shedding: impulsive}\nfish: [{}]\n";
    const char *const path = checkpoint_of(*state, "");
    struct simulation *const undisturbed = school_simulation(text);
    // three solutions at the start, two at each event: in the first and in the second one of the third and fourth event
    for (int event = 2; event <= 3; event++) {
        school_run(undisturbed, 0.02 * event);
        const struct simulate_options options = {.path = *state, .overwrite = 1, .command = "test", .stop = &stop};
        stop = 0;
        n_until_signal = 3 + 2 * event + event % 2;
        run_into(text, &options, STATUS_STOPPED);
        n_until_signal = -1;
        struct checkpoint checkpoint;
        school_ok(checkpoint_read(test_arena(), &checkpoint, path));
        NEAR(checkpoint.t, undisturbed->state->t, 0, 0);
        assert_memory_equal(&checkpoint.totals, &undisturbed->totals, sizeof checkpoint.totals);
        assert_int_equal(unlink(path), 0);
    }
}

TEST(a_signal_during_the_start_leaves_nothing) {
    const struct simulate_options options = {.path = *state, .overwrite = 1, .command = "test", .stop = &stop};
    const char *const path = checkpoint_of(*state, "");
    unlink(path);
    stop = 0;
    n_until_signal = 1;
    run_into(SMALL "wake: {shedding: sheet}\nfish: [{}]\n", &options, STATUS_STOPPED);
    n_until_signal = -1;
    assert_non_null(strstr(status_message(), "stopped by a signal during the event at t = 0"));
    assert_int_equal(access(path, F_OK), -1);
}

TEST(a_failing_run_says_when_and_keeps_its_file) {
    const char *const path = *state;
    const struct simulate_options options = {.path = path, .overwrite = 1, .command = "test"};
    run_into(SMALL "solver: {max_steps: 1}\nfish: [{}]\n", &options, STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "t = "));
    assert_non_null(strstr(status_message(), "solver.max_steps"));
    assert_int_equal(access(path, R_OK), 0);
}

TEST(a_run_that_diverges_ends_with_its_last_finite_row) {
    const char *const path = *state;
    const struct simulate_options options = {.path = path, .overwrite = 1, .command = "test"};

    // one event a beat: the wake grows by some orders of magnitude at each event, up to the largest double
    run_into(
        "time: {end: 0.9, shedding_interval: 0.02, output_interval: 0.02}\n"
        "wake: {lifetime: 3 beats, decay: 2.25 beats}\n"
        "fish: [{wave: {amplitude: 0}, motion: {prescribed: all, heave: 0.7, frequency: 50}}]\n",
        &options, STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "has diverged at t = 0."));
    assert_non_null(strstr(read_attribute(path, "run_status"), "failed: the run has diverged"));
    assert_non_null(strstr(read_attribute(path, "warnings"), "fish1 has diverged: at t = "));

    int file, time, energy, momentum;
    size_t n_rows;
    assert_int_equal(nc_open(path, NC_NOWRITE, &file), NC_NOERR);
    assert_int_equal(nc_inq_dimid(file, "time", &time), NC_NOERR);
    assert_int_equal(nc_inq_dimlen(file, time, &n_rows), NC_NOERR);
    assert_int_equal(nc_inq_varid(file, "energy_balance", &energy), NC_NOERR);
    assert_int_equal(nc_inq_varid(file, "momentum_balance", &momentum), NC_NOERR);
    assert_in_range(n_rows, 5, 44);
    for (size_t row = 0; row < n_rows; row++) {
        double value[3];
        assert_int_equal(nc_get_var1_double(file, energy, (size_t[]){row, 0}, &value[0]), NC_NOERR);
        assert_int_equal(nc_get_vara_double(file, momentum, (size_t[]){row, 0}, (size_t[]){1, 2}, value + 1), NC_NOERR);
        for (int i = 0; i < 3; i++) {
            if (!isfinite(value[i])) fail_msg("balance %d of row %zu is %g", i, row, value[i]);
        }
    }
    nc_close(file);
}

static int make_path(void **state) {
    static char path[] = "/tmp/test_simulate_XXXXXX";
    const int file = mkstemp(path);
    if (file < 0) return -1;
    close(file);
    *state = path;
    return 0;
}

static int remove_path(void **state) {
    unlink(checkpoint_of(*state, ""));
    return unlink(*state);
}

TEST_GROUP(make_path, remove_path)

// ---- before the start

static int n_schools;

enum status __real_fish_school_create(struct arena *parent, struct school **school, const void *parameters);
enum status __wrap_fish_school_create(struct arena *parent, struct school **school, const void *parameters);
enum status __wrap_fish_school_create(struct arena *parent, struct school **school, const void *parameters) {
    n_schools++;
    return __real_fish_school_create(parent, school, parameters);
}

TEST(a_result_that_cannot_be_written_is_told_before_the_start) {
    const char *const places[][2] = {{*state, "exists"}, {"/no/folder/run.nc", "there is no folder"}};
    struct case_values values;
    const char *const text = "format: 1\n" SMALL "fish: [" LEFT "]\n";
    assert_int_equal(case_parse(&values, text, strlen(text), "case", NULL, 0, NULL), STATUS_OK);
    for (int i = 0; i < 2; i++) {
        const struct simulate_options options = {.path = places[i][0], .overwrite = 0, .command = "test"};
        n_schools = 0;
        assert_int_equal(simulate_run(&values, &options), STATUS_FILE);
        assert_non_null(strstr(status_message(), places[i][1]));
        assert_int_equal(n_schools, 0);
    }
    case_free(&values);
}

TEST(a_limp_fish_swims_on) {
    // the body bends back and forth: the tail overtakes the markers
    static const char *const forces[] = {"reactive", "pressure"};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 26, shedding_interval: 0.02, output_interval: 0.02}\n"
            "fish: [{force: %s, nodes: 17, body: {modulus: 1e4}, start: {speed: 0.3}}]\n",
            forces[i]);
        school_measure(simulation, 26);
        const double speed = simulation->diagnostics->fish[0].speed;
        ABOVE(speed, 0.01);
        BELOW(speed, 1);
    }
}

TEST(a_failure_of_a_folded_body_says_so) {
    static const char *const amplitudes[] = {"1.2", "0.2"};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\nsolver: {max_steps: 1}\n"
            "fish: [{name: worm, nodes: 7, wave: {amplitude: %s, ramp: 0}}]\n",
            amplitudes[i]);
        assert_int_equal(simulate_step(simulation), STATUS_SOLVER);
        const char *const said = strstr(status_message(), "; the body of worm folds: it turns by ");
        assert_int_equal(said != NULL, i == 0);
        if (!said) continue;

        // the largest turn of all nodes
        double degrees, largest = 0;
        int node, sharpest = 0;
        const double *const x = simulation->state->closest->before + simulation->school->fish[0].at.x;
        const double *const y = simulation->state->closest->before + simulation->school->fish[0].at.y;
        for (int k = 1; k < 6; k++) {
            const double turn = atan2(y[k + 1] - y[k], x[k + 1] - x[k]) - atan2(y[k] - y[k - 1], x[k] - x[k - 1]);
            if (fabs(remainder(turn, 2 * M_PI)) > largest) sharpest = k;
            largest = fmax(largest, fabs(remainder(turn, 2 * M_PI)));
        }
        assert_int_equal(sscanf(said, "; the body of worm folds: it turns by %lf degrees at node %d", &degrees, &node),
                         2);
        NEAR(degrees, largest * 180 / M_PI, 0.5, 0);
        assert_int_equal(node, sharpest);
    }
}

// the default order of a fish with these values, or of a school that is written as a list
static int order_of(const char *solver, const char *fish) {
    char text[400];
    snprintf(text, sizeof text,
             "format: 1\n" TIME "solver: {%s}\ndefaults: {fish: {body: {thickness: 0.2, depth: 0.25}}}\nfish: %s\n",
             solver, fish);
    struct case_values values;
    school_ok(case_parse(&values, text, strlen(text), "test", NULL, 0, NULL));
    struct simulation *simulation;
    school_ok(simulate_start(test_arena(), &simulation, &values, NULL));
    case_free(&values);
    return simulation->options.order;
}

TEST(order_3_needs_bodies_whose_stiffness_is_damped) {
    assert_int_equal(order_of("", "[{}]"), 3);
    assert_int_equal(order_of("", "[{wave: {frequency: 0.7}}]"), 3);
    assert_int_equal(order_of("", "[{wave: {frequency: 0.7}, body: {relaxation_time: 0.001}}]"), 2);
    assert_int_equal(order_of("", "[{body: {relaxation_time: 0.01}}]"), 3);
    assert_int_equal(order_of("", "[{body: {relaxation_time: 0.0010}}]"), 3);
    assert_int_equal(order_of("", "[{body: {relaxation_time: 0.0009}}]"), 2);
    assert_int_equal(order_of("", "[{body: {relaxation_time: 0}}]"), 2);
    assert_int_equal(order_of("order: 4", "[{body: {relaxation_time: 0}}]"), 4);
    assert_int_equal(order_of("", "[{wave: {frequency: 0}}]"), 2);
    assert_int_equal(order_of("", "[{}, {start: {position: [0, 2]}, body: {relaxation_time: 1e-4}}]"), 2);
}

TEST(order_5_is_for_bodies_slower_than_their_beat) {
    // the slowest mode of a fish with the reactive force has 0.6 Hz at 6.6e4 Pa, and grows with the root of the modulus
    assert_int_equal(order_of("", "[{force: reactive, body: {modulus: 6e4}}]"), 5);
    assert_int_equal(order_of("", "[{force: reactive, body: {modulus: 1e5}}]"), 3);
    assert_int_equal(order_of("", "[{force: reactive, body: {modulus: 1e5}, wave: {frequency: 2}}]"), 5);
    assert_int_equal(
        order_of("", "[{force: reactive, body: {modulus: 6e4}}, {force: reactive, start: {position: [2, 0]}}]"), 3);
    assert_int_equal(order_of("", "[{force: reactive, body: {modulus: 6e4, relaxation_time: 0}}]"), 2);
    assert_int_equal(order_of("order: 3", "[{force: reactive, body: {modulus: 6e4}}]"), 3);
}
