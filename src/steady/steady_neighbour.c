/* steady_neighbour.c: see steady_neighbour.h. */
#include "steady/steady_neighbour.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "fish/fish_school.h"
#include "result/checkpoint.h"
#include "result/netcdf.h"
#include "school/diagnostics_energy.h"

enum status steady_neighbour_write(struct arena *arena, const char *path, const struct case_values *values,
                                   const struct simulation *simulation) {
    // without the name of a result no run can be resumed from it
    const struct checkpoint all = {.effective = case_show(arena, values), .result = "", .places = ""};
    return checkpoint_write(arena, path, NULL, &all, simulation->state, simulation->school);
}

// ---- the units of the case

static void multiply(double *values, int n, double factor) {
    for (int i = 0; i < n; i++) values[i] *= factor;
}

/* Stretch n places about a centre by a factor. */
static void stretch(double *places, int n, double centre, double factor) {
    for (int i = 0; i < n; i++) places[i] = centre + factor * (places[i] - centre);
}

/* Change the units of a fish and its wake: 1 length and 1 duration become these. */
static void change_units(const struct fish *fish, struct state *state, int f, double length, double duration) {
    const struct rigid rigid = rigid_of(fish, state->y);
    struct wake *const wake = &state->wake[f];
    double *const places[] = {state->y + fish->at.x, state->y + fish->at.y},
                  *const velocities[] = {state->y + fish->at.vx, state->y + fish->at.vy},
                  *const wake_places[] = {wake->x, wake->y},
                  *const wake_velocities[] = {wake->u, wake->v, wake->u_before, wake->v_before};
    const double speed = length / duration, circulation = length * speed;

    for (int i = 0; i < 2; i++) {
        stretch(places[i], fish->n_nodes, rigid.place[i], length);
        stretch(wake_places[i], wake->n_vortex, rigid.place[i], length);
        multiply(velocities[i], fish->n_nodes, speed);
        wake->tail_velocity[i] *= speed;
        wake->slip[i] *= speed;
    }
    for (int i = 0; i < 4; i++) multiply(wake_velocities[i], wake->n_vortex, speed);
    state->y[fish->at.circulation] *= circulation;
    wake->removed *= circulation;
    wake->shed_before *= circulation;
    multiply(wake->circulation, wake->n_vortex, circulation);
    multiply(wake->rate, wake->n_vortex, circulation / duration);
    multiply(wake->rate_before, wake->n_vortex, circulation / duration);
    multiply(wake->birth, wake->n_vortex, duration);
}

enum status steady_neighbour_start(struct arena *arena, struct simulation **simulation,
                                   const struct case_values *values, const char *path) {
    ARENA(scratch, arena, path);
    struct checkpoint file;
    struct case_values of_file = {0};
    struct school *from, *school;
    *simulation = NULL;
    TRY(checkpoint_read(scratch, &file, path));
    TRY(case_parse(&of_file, file.effective, strlen(file.effective), path, NULL, 0, NULL));
    arena_move(of_file.arena, scratch);
    TRY(fish_school_create(scratch, &from, &of_file.school));
    TRY(fish_school_create(arena, &school, &values->school));
    bool is_same = from->n_fish == school->n_fish && from->n_unknowns == school->n_unknowns;
    for (int f = 0; f < school->n_fish && is_same; f++) is_same = from->fish[f].n_nodes == school->fish[f].n_nodes;
    if (!is_same) return status_fail(STATUS_FILE, "%s: the state has other unknowns than the case", path);

    // read the state with the school of the file, then let it belong to the school of the case
    struct state *const state = state_create(arena, school);
    TRY(checkpoint_set_state(&file, state, from));
    const double duration = school->interval / from->interval;
    for (int f = 0; f < school->n_fish; f++) {
        change_units(&from->fish[f], state, f, school->fish[f].length / from->fish[f].length, duration);
    }
    state->t = fish_event_time(school, state->event);
    TRY(state_table_check(state, school));

    const struct integrator_counts none = {0};
    return simulate_take_up(arena, simulation, values, school, state, &none);
}

// ---- the slow quantities

/* A number of a fish in a result; component: of a pair, -1: no pair. */
static enum status read_number(const struct netcdf_reader *reader, const char *name, int fish, int component,
                               double *value) {
    const struct netcdf_slice one[] = {{"fish", (size_t)fish, 1}, {NULL}},
                              pair[] = {{"fish", (size_t)fish, 1}, {"xy", (size_t)component, 1}, {NULL}};
    return netcdf_read_doubles(reader, name, component < 0 ? one : pair, value);
}

/* Add the part of a neighbour to the slow quantities, which are in lengths and beats. */
static enum status add_part(const struct steady_problem *problem, const struct netcdf_reader *reader, double weight,
                            double *sum) {
    const struct netcdf_slice scalar[] = {{NULL}};
    double interval;
    TRY(netcdf_read_doubles(reader, "shedding_interval", scalar, &interval));
    const double period = interval * (double)problem->map.events;
    for (int i = 0; i < problem->n_unknowns; i++) {
        const struct steady_unknown unknown = problem->unknown[i];
        const bool is_speed = unknown.quantity == STEADY_SPEED;
        const int component = unknown.quantity == STEADY_AHEAD ? 0 : unknown.quantity == STEADY_ASIDE ? 1 : -1;
        double value, length;
        if (!is_speed && component < 0) continue;
        TRY(read_number(reader, "body_length", unknown.fish, -1, &length));
        TRY(read_number(reader, is_speed ? "steady_speed" : "steady_place", unknown.fish, component, &value));
        sum[i] += weight * value * (is_speed ? period : 1) / length;
    }
    return STATUS_OK;
}

/* Limits of a multiplier that serves for an extrapolation. */
static const double least_multiplier = 0, largest_multiplier = 0.99;

/* The multiplier of the disturbance that is one of the speed above all, if the file has it and it is real. */
static enum status read_multiplier(const struct netcdf_reader *reader, double *multiplier) {
    size_t n = 0;
    if (!netcdf_has(reader, "steady_multiplier")) return STATUS_OK;
    TRY(netcdf_read_length(reader, "multiplier", 0, INT_MAX, &n));
    for (size_t i = 0; i < n; i++) {
        const struct netcdf_slice one[] = {{"multiplier", i, 1}, {"xy", 0, 2}, {NULL}},
                                  part[] = {{"multiplier", i, 1},
                                            {"fish", 0, 1},
                                            {"slow", STEADY_SPEED, 1},
                                            {"xy", 0, 1},
                                            {NULL}};
        double value[2], of_speed;
        TRY(netcdf_read_doubles(reader, "steady_multiplier", one, value));
        TRY(netcdf_read_doubles(reader, "steady_mode", part, &of_speed));

        // parts of a mode are over the largest
        const bool is_real = !(fabs(value[1]) > 0), is_of_speed = of_speed > 1 - 1e-9;
        if (!is_real || !is_of_speed || !(value[0] > least_multiplier) || !(value[0] < largest_multiplier)) continue;
        *multiplier = value[0];
        return STATUS_OK;
    }
    return STATUS_OK;
}

enum status steady_neighbour_predict(struct steady_problem *problem, const struct steady_neighbours *neighbours) {
    struct simulation *const simulation = problem->map.simulation;
    ARENA(scratch, simulation->arena, "the slow quantities of neighbours");
    double *sum;
    NEW(scratch, sum, problem->n_unknowns + 1);
    const bool circles = fabs(simulation->school->fish[0].control.bias) > 0;
    const bool is_alone = problem->solves_speed && !problem->map.is_formation && !circles;
    for (int i = 0; i < neighbours->n; i++) {
        struct netcdf_reader *reader;
        NEW(scratch, reader, 1);
        TRY(netcdf_open(scratch, reader, neighbours->result[i]));
        TRY(add_part(problem, reader, neighbours->weight[i] - (i == 0), sum));
        if (is_alone) TRY(read_multiplier(reader, &problem->multiplier));
    }
    for (int i = 0; i < problem->n_unknowns; i++) {
        sum[i] *= steady_map_scale(&problem->map, problem->unknown[i]);
        if (!isfinite(sum[i])) return status_fail(STATUS_FILE, "%s has no steady state", neighbours->result[0]);
    }

    // make the state consistent, and let balances begin with it
    TRY(steady_map_add(&problem->map, problem->n_unknowns, problem->unknown, sum));
    diagnostics_restart(simulation->residual, simulation->state);
    return STATUS_OK;
}
