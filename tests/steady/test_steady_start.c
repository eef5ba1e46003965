/* test_steady_start.c: A search that starts from a file takes places and shapes from it, in the frame of the case. */
#include <netcdf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fish/fish_motion.h"
#include "school.h"
#include "steady/steady_problem.h"
#include "steady/steady_start.h"

#define TIME "time: {end: 1, shedding_interval: 0.02}\n"
enum { N_FISH = 2, N_NODES = 5 };

static char path[] = "/tmp/test_steady_start_XXXXXX";

static int set_up(void **state) {
    (void)state;
    const int file = mkstemp(path);
    if (file < 0) return -1;
    close(file);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    return unlink(path);
}

TEST_GROUP(set_up, tear_down)

/* A steady state of n fish in the last of two rows: heading of the first fish in degrees, speeds, nodes (n, N_NODES,
 * 2). */
static void put_state(int n, double heading, const double *speed, const double *nodes) {
    int file, dimension[4], variable[3];
    const char *const names[] = {"time", "fish", "node", "xy"};
    const size_t lengths[] = {2, (size_t)n, N_NODES, 2}, last[] = {1, 0, 0, 0}, row[] = {1, (size_t)n, N_NODES, 2};
    const double headings[N_FISH] = {heading, 77};
    assert_int_equal(nc_create(path, NC_CLOBBER | NC_64BIT_DATA, &file), NC_NOERR);
    for (int d = 0; d < 4; d++) assert_int_equal(nc_def_dim(file, names[d], lengths[d], &dimension[d]), NC_NOERR);
    assert_int_equal(nc_def_var(file, "x", NC_DOUBLE, 4, dimension, &variable[0]), NC_NOERR);
    assert_int_equal(nc_def_var(file, "heading", NC_DOUBLE, 2, dimension, &variable[1]), NC_NOERR);
    assert_int_equal(nc_def_var(file, "steady_speed", NC_DOUBLE, 1, dimension + 1, &variable[2]), NC_NOERR);
    assert_int_equal(nc_enddef(file), NC_NOERR);
    assert_int_equal(nc_put_vara_double(file, variable[0], last, row, nodes), NC_NOERR);
    assert_int_equal(nc_put_vara_double(file, variable[1], last, row, headings), NC_NOERR);
    assert_int_equal(nc_put_var_double(file, variable[2], speed), NC_NOERR);
    assert_int_equal(nc_close(file), NC_NOERR);
}

TEST(followers_keep_their_places_in_the_frame_of_the_first_fish) {
    // the first fish of the file heads along +y; the nose of the second one is 2 m behind it and 1 m to its right
    double nodes[N_FISH * N_NODES * 2] = {0};
    nodes[0] = 10;
    nodes[1] = 5;
    nodes[2 * N_NODES] = 11;
    nodes[2 * N_NODES + 1] = 3;
    put_state(N_FISH, 90, (double[]){1.5, 1.6}, nodes);

    // in the case the first fish begins at (1, 2) and heads along -x: behind it is +x, to its right +y
    struct fish_parameters fish[N_FISH] = {{.start_position = {1, 2}, .start_heading = 180}};
    fish[0].motion.prescribed = fish[1].motion.prescribed = PRESCRIBED_NONE;
    const struct school_parameters school = {.n_fish = N_FISH, .fish = fish};
    struct fish_parameters *found;
    school_ok(steady_start_read(test_arena(), path, &school, &found));
    NEAR_ARRAY(2, found[0].start_position, ((double[]){1, 2}), 0, 0);
    NEAR_ARRAY(2, found[1].start_position, ((double[]){3, 3}), 1e-14, 0);
    NEAR(found[0].start_speed, 1.5, 0, 0);
    NEAR(found[1].start_speed, 1.6, 0, 0);
    NEAR(found[0].motion.speed, 1.5, 0, 0);
    NEAR(found[1].motion.speed, 1.6, 0, 0);
}

// an arc of a body that is twice as long and points elsewhere, as an arc behind the prescribed first edge
TEST(shapes_are_turned_and_scaled_to_the_first_edge) {
    const double turn = 0.3, first = 2.1;
    struct setup setup = setup_of(TIME
                                  "fish: [{nodes: 5, wave: {amplitude: 0}, start: {position: [1, 2], heading: 160},\n"
                                  "        motion: {prescribed: head}}]\n");
    const struct fish *const fish = setup.school->fish;
    double nodes[2 * N_NODES] = {7, -3}, direction[2], rate;
    for (int k = 1; k < N_NODES; k++) {
        nodes[2 * k] = nodes[2 * k - 2] + 2 * fish->edge_length * cos(first + (k - 1) * turn);
        nodes[2 * k + 1] = nodes[2 * k - 1] + 2 * fish->edge_length * sin(first + (k - 1) * turn);
    }
    put_state(1, 0, (double[]){1}, nodes);

    double *const y = setup.state->y;
    school_ok(steady_start_shapes(test_arena(), path, setup.school, y));
    fish_prescribed_direction(fish, 0, direction, &rate);
    for (int k = 0; k < fish->n_edges; k++) {
        const double angle = atan2(direction[1], direction[0]) + k * turn;
        NEAR(y[fish->at.x + k + 1] - y[fish->at.x + k], fish->edge_length * cos(angle), 1e-13, 0);
        NEAR(y[fish->at.y + k + 1] - y[fish->at.y + k], fish->edge_length * sin(angle), 1e-13, 0);
    }
}

TEST(a_file_of_other_bodies_is_refused) {
    double nodes[N_FISH * N_NODES * 2] = {0};
    put_state(1, 0, (double[]){1}, nodes);
    struct fish_parameters fish[N_FISH] = {{.start_heading = 0}}, *found;
    const struct school_parameters school = {.n_fish = N_FISH, .fish = fish};
    assert_int_equal(steady_start_read(test_arena(), path, &school, &found), STATUS_FILE);
    assert_null(found);
    assert_non_null(strstr(status_message(), "does not contain a steady state of 2 fish"));

    struct setup setup = setup_of(TIME "fish: [{nodes: 7, motion: {prescribed: head}}]\n");
    assert_int_equal(steady_start_shapes(test_arena(), path, setup.school, setup.state->y), STATUS_FILE);
    assert_non_null(strstr(status_message(), "does not have 7 nodes"));

    // a body with more nodes in the file, and one that is padded
    for (int is_padded = 0; is_padded < 2; is_padded++) {
        double longer[2 * N_NODES];
        for (int k = 0; k < N_NODES; k++) {
            longer[2 * k] = is_padded && k >= 4 ? (double)NAN : (double)k;
            longer[2 * k + 1] = is_padded && k >= 4 ? (double)NAN : 0;
        }
        put_state(1, 0, (double[]){1}, longer);
        school_build(&setup, TIME "fish: [{nodes: 4, motion: {prescribed: head}}]\n");
        const enum status status = steady_start_shapes(test_arena(), path, setup.school, setup.state->y);
        assert_int_equal(status, is_padded ? STATUS_OK : STATUS_FILE);
        if (!is_padded) assert_non_null(strstr(status_message(), "does not have 4 nodes"));
    }
}
