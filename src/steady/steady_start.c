/* steady_start.c: see steady_problem.h. */
#include "steady/steady_start.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "fish/fish_motion.h"
#include "result/netcdf.h"
#include "steady/steady_problem.h"

struct reading {
    struct netcdf_reader reader;
    size_t last;             /* row */
    double nose[2], heading; /* of the first fish in the file, m, rad */
};

static enum status read_nose(const struct reading *reading, size_t f, double nose[2]) {
    const struct netcdf_slice slice[] = {
        {"time", reading->last, 1}, {"fish", f, 1}, {"node", 0, 1}, {"xy", 0, 2}, {NULL}};
    return netcdf_read_doubles(&reading->reader, "x", slice, nose);
}

// open a file until the arena is freed
static enum status start_open(struct arena *arena, struct reading **opened, const char *path, int n_fish) {
    struct reading *reading;
    size_t n_rows = 0, n = 0;
    double degrees;
    NEW(arena, reading, 1);
    *opened = reading;
    TRY(netcdf_open(arena, &reading->reader, path));
    TRY(netcdf_read_length(&reading->reader, "time", 0, SIZE_MAX, &n_rows));
    TRY(netcdf_read_length(&reading->reader, "fish", 1, INT_MAX, &n));
    if (n_rows == 0 || n != (size_t)n_fish || !netcdf_has(&reading->reader, "steady_speed")) {
        return status_fail(STATUS_FILE, "%s does not contain a steady state of %d fish to start from", path, n_fish);
    }

    const struct netcdf_slice slice[] = {{"time", n_rows - 1, 1}, {"fish", 0, 1}, {NULL}};
    TRY(netcdf_read_doubles(&reading->reader, "heading", slice, &degrees));
    reading->last = n_rows - 1;
    reading->heading = angle_radians(degrees);
    return read_nose(reading, 0, reading->nose);
}

enum status steady_start_read(struct arena *arena, const char *path, const struct school_parameters *school,
                              struct fish_parameters **fish) {
    struct arena *const scratch = arena_create(arena, path);
    struct reading *reading;
    struct fish_parameters *copy;
    *fish = NULL;
    TRY(start_open(scratch, &reading, path, school->n_fish));
    NEW(arena, copy, school->n_fish);
    memcpy(copy, school->fish, (size_t)school->n_fish * sizeof *copy);
    for (int f = 0; f < school->n_fish; f++) {
        const struct motion_parameters *const motion = &copy[f].motion;
        const struct netcdf_slice slice[] = {{"fish", (size_t)f, 1}, {NULL}};
        double speed, nose[2];
        if (motion->prescribed != PRESCRIBED_NONE && motion->surge != SURGE_FREE) continue;
        TRY(netcdf_read_doubles(&reading->reader, "steady_speed", slice, &speed));
        if (!isfinite(speed)) {
            return status_fail(STATUS_FILE, "%s does not contain a steady state to start from", path);
        }
        copy[f].start_speed = copy[f].motion.speed = speed;
        if (f == 0) continue;

        // transform the nose from the frame of the first fish in the file to the initial frame of the first fish
        const struct fish_parameters *const first = school->fish;
        TRY(read_nose(reading, (size_t)f, nose));
        const double turn = angle_radians(first->start_heading) - reading->heading;
        const double way[2] = {nose[0] - reading->nose[0], nose[1] - reading->nose[1]};
        copy[f].start_position[0] = first->start_position[0] + cos(turn) * way[0] - sin(turn) * way[1];
        copy[f].start_position[1] = first->start_position[1] + sin(turn) * way[0] + cos(turn) * way[1];
    }
    arena_free(scratch);
    *fish = copy;
    return STATUS_OK;
}

// ---- shapes

enum status steady_start_shapes(struct arena *arena, const char *path, const struct school *school, double *y) {
    struct arena *const scratch = arena_create(arena, path);
    struct reading *reading;
    size_t n = 0;
    TRY(start_open(scratch, &reading, path, school->n_fish));
    TRY(netcdf_read_length(&reading->reader, "node", 2, INT_MAX, &n));
    for (int f = 0; f < school->n_fish; f++) {
        // the node positions of a body, x and y interleaved; a body with fewer nodes is padded with NaN
        const struct fish *const fish = &school->fish[f];
        const size_t n_nodes = (size_t)fish->n_nodes;
        const struct netcdf_slice slice[] = {
            {"time", reading->last, 1}, {"fish", (size_t)f, 1}, {"node", 0, n_nodes}, {"xy", 0, 2}, {NULL}};
        const struct netcdf_slice next[] = {
            {"time", reading->last, 1}, {"fish", (size_t)f, 1}, {"node", n_nodes, 1}, {"xy", 0, 2}, {NULL}};
        double *places, beyond[2] = {NAN, NAN}, direction[2], rate;
        NEW(scratch, places, 2 * n_nodes);
        if (n >= n_nodes) TRY(netcdf_read_doubles(&reading->reader, "x", slice, places));
        if (n > n_nodes) TRY(netcdf_read_doubles(&reading->reader, "x", next, beyond));
        bool is_other = n < n_nodes || isfinite(beyond[0]);
        for (size_t i = 0; i < 2 * n_nodes; i++) is_other |= !isfinite(places[i]);
        if (is_other) {
            return status_fail(STATUS_FILE, "%s: %s does not have %d nodes in this file", path, fish->name,
                               fish->n_nodes);
        }

        // rotate and scale the shape so that edge 0 coincides with edge 0 of a straight body at the nose
        fish_prescribe(fish, NULL, 1, 0, y);
        fish_prescribed_direction(fish, 0, direction, &rate);
        const double edge[2] = {places[2] - places[0], places[3] - places[1]}, length = hypot(edge[0], edge[1]);
        const double factor = fish->edge_length / (length * length);
        const double c = factor * (edge[0] * direction[0] + edge[1] * direction[1]);
        const double s = factor * (edge[0] * direction[1] - edge[1] * direction[0]);
        for (int k = fish_n_prescribed(fish); k < fish->n_nodes; k++) {
            const double way[2] = {places[2 * k] - places[0], places[2 * k + 1] - places[1]};
            y[fish->at.x + k] = y[fish->at.x] + c * way[0] - s * way[1];
            y[fish->at.y + k] = y[fish->at.y] + s * way[0] + c * way[1];
        }
    }
    arena_free(scratch);
    return STATUS_OK;
}
