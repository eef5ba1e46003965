/* test_field_file.c: The flow around a row of a result file agrees with that of the run itself and with a sum of its
 * own. Also tests field_row and flow_field. */
#include <math.h>
#include <stdlib.h>

#include "crafted_file.h"
#include "flow/flow.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_external.h"
#include "run/simulate_run.h"
#include "school.h"
#include "view/field_file.h"
#include "view/field_row.h"

enum { N_POINTS = 60 };

static char folder[] = "/tmp/test_field.XXXXXX", path[64], field_path[64];

#define SEVENTEEN "force: reactive, sheet_points: 17"

/* Two fish whose wakes decay during the run, in an external flow with all its terms; keys: of both fish. */
static const char *school_with(const char *shedding, const char *keys) {
    static char text[1024];
    snprintf(text, sizeof text,
             "time: {end: 0.6, shedding_interval: 0.02, output_interval: 0.1}\noutput: {wake_interval: 0.3}\n"
             "fluid: {velocity: [0.3, -0.2], shear: 0.2, gust: {amplitude: 0.1, frequency: 1}}\n"
             "wake: {shedding: %s, lifetime: 0.4, decay: 0.2}\nsolver: {rtol: 1e-3}\n"
             "defaults: {fish: {nodes: 5, %s, start: {speed: 0.5}}}\n"
             "fish: [{name: one}, {name: another, nodes: 7, length: 0.8, start: {position: [0.2, 0.5]}}]\n",
             shedding, keys);
    return text;
}

static const char *school_of(const char *shedding) {
    return school_with(shedding, SEVENTEEN);
}

static void write_run(const char *text) {
    const struct case_values values = school_values(text);
    const struct simulate_options options = {.path = path, .overwrite = 1, .command = "test"};
    school_ok(simulate_run(&values, &options));
}

/* Points near the bodies and the wakes, and the flow there. */
struct points {
    double x[N_POINTS], y[N_POINTS], u[N_POINTS], v[N_POINTS], u_x[N_POINTS], u_y[N_POINTS], v_x[N_POINTS];
};

static struct targets field_of(struct flow *flow, const struct state *state, struct points *points) {
    const struct targets at = {.n = N_POINTS,
                               .x = points->x,
                               .y = points->y,
                               .u = points->u,
                               .v = points->v,
                               .u_x = points->u_x,
                               .u_y = points->u_y,
                               .v_x = points->v_x};
    flow_field(flow, state, &at, false);
    return at;
}

static void place_points(struct points *points) {
    for (int i = 0; i < N_POINTS; i++) {
        points->x[i] = -0.6 + 0.03 * i;
        points->y[i] = 0.3 + 0.5 * sin(1.7 * i);
    }
}

// ---- the flow of a row

TEST(the_flow_of_a_row_is_that_of_the_run) {
    static const char *const schools[][2] = {{"sheet", SEVENTEEN},
                                             {"continuous", SEVENTEEN},
                                             {"impulsive", SEVENTEEN},
                                             {"sheet", "sheet_points: 26, force: pressure, pressure: {span: finite}"}};
    for (int s = 0; s < 4; s++) {
        const char *const text = school_with(schools[s][0], schools[s][1]);
        write_run(text);
        struct simulation *const run = school_simulation(text);
        school_run(run, 0.6);
        struct field_row *row;
        struct points there, here;
        school_ok(field_row_read(test_arena(), &row, path, NULL, 0, NULL));
        struct flow *const flow = flow_create(test_arena(), row->school);
        NEAR(row->state->t, 0.6, 1e-12, 0);
        assert_int_equal(row->state->wake[0].n_vortex, run->state->wake[0].n_vortex);
        ABOVE(row->state->wake[0].n_vortex, 15);
        place_points(&there);
        place_points(&here);
        field_of(run->residual->flow, run->state, &there);
        field_of(flow, row->state, &here);
        NEAR_ARRAY(N_POINTS, here.u, there.u, 1e-12, 0);
        NEAR_ARRAY(N_POINTS, here.v, there.v, 1e-12, 0);
        NEAR_ARRAY(N_POINTS, here.v_x, there.v_x, 1e-10, 0);
    }
}

// add what one smoothed vortex causes at a point: velocity, and the vorticity of its core
static void add_vortex(const double at[2], double x, double y, double circulation, double smoothing, double sum[3]) {
    const double dx = at[0] - x, dy = at[1] - y, square = dx * dx + dy * dy + smoothing * smoothing;
    sum[0] -= circulation * dy / (2 * M_PI * square);
    sum[1] += circulation * dx / (2 * M_PI * square);
    sum[2] += circulation * smoothing * smoothing / (M_PI * square * square);
}

// the middles of the stretches of a free sheet, and the bound vortices
static void add_fish(const struct fish *fish, const struct school *school, const struct state *state,
                     const struct wake *wake, const double at[2], double sum[3]) {
    for (int i = 0; i + 1 < wake->n_vortex; i++) {
        const double strength = wake_strength(school, state->t - wake->birth[i + 1]);
        add_vortex(at, (wake->x[i] + wake->x[i + 1]) / 2, (wake->y[i] + wake->y[i + 1]) / 2,
                   strength * (wake->circulation[i + 1] - wake->circulation[i]), fish->smoothing, sum);
    }
    for (int j = 0; j < fish->n_sheet; j++) {
        add_vortex(at, fish_mean(&fish->sheet_point[j], state->y + fish->at.x),
                   fish_mean(&fish->sheet_point[j], state->y + fish->at.y),
                   fish->sheet_weight[j] * state->y[fish->at.gamma + j], fish->sheet_smoothing, sum);
    }
}

TEST(it_is_the_sum_of_all_wakes_and_sheets) {
    struct simulation *const run = school_simulation(school_of("sheet"));
    struct points points;
    school_run(run, 0.6);
    place_points(&points);
    field_of(run->residual->flow, run->state, &points);
    for (int i = 0; i < N_POINTS; i++) {
        const double at[2] = {points.x[i], points.y[i]};
        double sum[3] = {0, 0, -run->school->shear};
        flow_external(run->school, run->state->t, at[0], at[1], &sum[0], &sum[1]);
        for (int f = 0; f < 2; f++) {
            add_fish(&run->school->fish[f], run->school, run->state, &run->state->wake[f], at, sum);
        }
        NEAR(points.u[i], sum[0], 1e-13, 0);
        NEAR(points.v[i], sum[1], 1e-13, 0);
        NEAR(points.v_x[i] - points.u_y[i], sum[2], 1e-11, 0);
    }
}

// the tail of a body feels all sheets and wakes as another body does
TEST(at_a_tail_it_is_what_the_tail_feels) {
    write_run(school_of("continuous"));
    struct simulation *const run = school_simulation(school_of("continuous"));
    school_run(run, 0.6);
    struct flow *const live = run->residual->flow;
    flow_velocity(live, run->state, run->state->t, run->state->y, false);
    double felt[2][2];
    for (int f = 0; f < 2; f++) {
        const int tail = live->points[f].first + flow_tail(&run->school->fish[f]);
        felt[f][0] = live->u[tail];
        felt[f][1] = live->v[tail];
    }
    struct field_row *row;
    struct points points;
    school_ok(field_row_read(test_arena(), &row, path, &(double){0.6}, 0, NULL));
    struct flow *const flow = flow_create(test_arena(), row->school);
    place_points(&points);
    for (int f = 0; f < 2; f++) {
        const struct fish *const fish = &row->school->fish[f];
        points.x[f] = row->state->y[fish->at.x + fish->n_nodes - 1];
        points.y[f] = row->state->y[fish->at.y + fish->n_nodes - 1];
    }
    field_of(flow, row->state, &points);
    for (int f = 0; f < 2; f++) {
        NEAR(points.u[f], felt[f][0], 1e-12, 0);
        NEAR(points.v[f], felt[f][1], 1e-12, 0);
    }
}

// ---- rows that there are not

static void refused(double t, enum status want, const char *part) {
    ARENA(arena, NULL, "a row");
    struct field_row *row;
    const enum status status = field_row_read(arena, &row, path, &t, 0, NULL);
    if (status != want || !strstr(status_message(), part)) {
        fail_msg("t = %g: status %d, message: %s", t, (int)status, status_message());
    }
}

TEST(other_times_are_refused) {
    write_run(school_of("sheet"));
    refused(0.17, STATUS_CASE, "no row at t = 0.17 s: the nearest are at 0.1 s and 0.2 s");
    refused(0.5, STATUS_CASE,
            "has no wake (output.wake_interval): the nearest rows with a wake are at 0.3 s and 0.6 s");
    refused(0.7, STATUS_CASE, "outside of the rows, 0 s to 0.6 s");
    refused(-0.1, STATUS_CASE, "outside of the rows");
    struct field_row *row;
    school_ok(field_row_read(test_arena(), &row, path, &(double){0.3}, 0, NULL));
    NEAR(row->state->t, 0.3, 1e-12, 0);

    // a time may be off by a millionth of an interval of 0.02 s
    static const double close[] = {0.3 - 1.9e-8, 0.3 + 1.9e-8, 0.6 + 1.9e-8, -1.9e-8};
    for (int i = 0; i < 4; i++) {
        school_ok(field_row_read(test_arena(), &row, path, &close[i], 0, NULL));
        NEAR(row->state->t, close[i], 1.95e-8, 0);
    }
    refused(0.3 + 2.1e-8, STATUS_CASE, "no row at t = 0.3 s: the nearest are at 0.3 s and 0.4 s");
    refused(0.3 - 2.1e-8, STATUS_CASE, "no row at t = 0.3 s: the nearest are at 0.2 s and 0.3 s");
    refused(0.6 + 2.1e-8, STATUS_CASE, "outside of the rows");
    refused(-2.1e-8, STATUS_CASE, "outside of the rows");
}

TEST(damaged_rows_are_refused) {
    static const struct {
        const char *name, *part;
        double value;
    } damage[] = {{"x", "variable x has a gap", NAN},
                  {"sheet_strength", "variable sheet_strength has a gap", INFINITY},
                  {"wake_count", "vortices", -3},
                  {"wake_x", "variable wake_x has a gap", NAN},
                  {"wake_birth", "variable wake_birth has a gap", NAN}};
    write_run(school_of("sheet"));
    size_t n;
    char *const good = read_bytes(path, &n);
    for (size_t i = 0; i < sizeof damage / sizeof *damage; i++) {
        int file, number;
        write_bytes(path, n, good);
        assert_int_equal(nc_open(path, NC_WRITE, &file), NC_NOERR);
        assert_int_equal(nc_inq_varid(file, damage[i].name, &number), NC_NOERR);
        const size_t last[] = {6, 1, 2, 1};
        assert_int_equal(nc_put_var1_double(file, number, last, &damage[i].value), NC_NOERR);
        nc_close(file);
        refused(0.6, STATUS_FILE, damage[i].part);
    }
}

// ---- the file

static double value_of(int file, const char *name, size_t i, size_t j, size_t k, size_t l) {
    int number;
    double value;
    assert_int_equal(nc_inq_varid(file, name, &number), NC_NOERR);
    assert_int_equal(nc_get_var1_double(file, number, (const size_t[]){i, j, k, l}, &value), NC_NOERR);
    return value;
}

TEST(the_file_has_the_field_on_its_grid) {
    write_run(school_of("sheet"));
    struct field_row *row;
    struct field_grid grid = {.nx = 12, .ny = 5};
    school_ok(field_row_read(test_arena(), &row, path, NULL, 0, NULL));
    field_file_box(row, grid.low, grid.high);
    // half a length of the longer fish around all nodes and vortices
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int f = 0; f < 2; f++) {
        const struct fish *const fish = &row->school->fish[f];
        const struct wake *const wake = &row->state->wake[f];
        const double *const of[2][2] = {{row->state->y + fish->at.x, row->state->y + fish->at.y}, {wake->x, wake->y}};
        for (int part = 0; part < 2; part++) {
            for (int k = 0; k < (part == 0 ? fish->n_nodes : wake->n_vortex); k++) {
                for (int i = 0; i < 2; i++) {
                    low[i] = fmin(low[i], of[part][i][k]);
                    high[i] = fmax(high[i], of[part][i][k]);
                }
            }
        }
    }
    for (int i = 0; i < 2; i++) {
        NEAR(grid.low[i], low[i] - 0.5, 1e-14, 0);
        NEAR(grid.high[i], high[i] + 0.5, 1e-14, 0);
    }
    school_ok(field_file_write(test_arena(), field_path, 1, path, "test", row, &grid));
    int file;
    assert_int_equal(nc_open(field_path, NC_NOWRITE, &file), NC_NOERR);
    struct flow *const flow = flow_create(test_arena(), row->school);
    for (size_t j = 0; j < 5; j++) {
        for (size_t i = 0; i < 12; i++) {
            const double x = value_of(file, "x", i, 0, 0, 0), y = value_of(file, "y", j, 0, 0, 0);
            double u, v, u_x, u_y, v_x;
            NEAR(x, grid.low[0] + (grid.high[0] - grid.low[0]) * (double)i / 11, 1e-14, 0);
            NEAR(y, grid.low[1] + (grid.high[1] - grid.low[1]) * (double)j / 4, 1e-14, 0);
            flow_field(
                flow, row->state,
                &(struct targets){.n = 1, .x = &x, .y = &y, .u = &u, .v = &v, .u_x = &u_x, .u_y = &u_y, .v_x = &v_x},
                false);
            NEAR(value_of(file, "u", 0, j, i, 0), u, 1e-13, 0);
            NEAR(value_of(file, "v", 0, j, i, 0), v, 1e-13, 0);
            NEAR(value_of(file, "vorticity", 0, j, i, 0), v_x - u_y, 1e-11, 0);
        }
    }
    NEAR(value_of(file, "time", 0, 0, 0, 0), 0.6, 1e-12, 0);
    NEAR(value_of(file, "body_x", 0, 1, 6, 1), row->state->y[row->school->fish[1].at.y + 6], 0, 0);
    assert_true(isnan(value_of(file, "body_x", 0, 0, 6, 1)));
    NEAR(value_of(file, "edge_thickness", 0, 1, 0, 0), row->school->fish[0].thickness[1], 0, 0);
    nc_close(file);
}

static int make_folder(void **state) {
    (void)state;
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/run.nc", folder);
    snprintf(field_path, sizeof field_path, "%s/field.nc", folder);
    return 0;
}

static int remove_folder(void **state) {
    (void)state;
    unlink(path);
    unlink(field_path);
    assert_int_equal(rmdir(folder), 0);  // nothing else is left in it
    return 0;
}

TEST_GROUP(make_folder, remove_folder)
