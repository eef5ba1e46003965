/* steady_static.c: the equilibrium of passive bodies in a stream. */
#include "steady/steady_static.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mathematics.h"
#include "body/rod.h"
#include "fish/fish_gait.h"
#include "fish/fish_motion.h"
#include "flow/flow.h"
#include "flow/flow_external.h"
#include "school/diagnostics.h"
#include "school/diagnostics_energy.h"
#include "school/diagnostics_momentum.h"
#include "school/rigid.h"
#include "solver/equilibrium.h"
#include "steady/steady_problem.h"
#include "steady/steady_start.h"

bool steady_static_applies(const struct school *school) {
    return !fish_first_beating(school);
}

// ---- cases without an equilibrium

enum status steady_static_refuse(const struct school *school) {
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        double position[2], velocity[2], acceleration[2], first[2];
        if (fish->motion.prescribed == PRESCRIBED_NONE || fish->motion.surge == SURGE_FREE) {
            return status_fail(STATUS_CASE,
                               "%s neither beats nor is held, so the stream carries the body away: hold the body with "
                               "motion.prescribed (and motion.surge: given), or add a beat",
                               fish->name);
        }

        if (fish->control.law != CONTROL_NONE) {
            return status_fail(STATUS_CASE, "%s does not beat and cannot steer: set control.law to none", fish->name);
        }

        if (fish->ramp > 0 && fish_largest_turn(fish, 1, 0) > 0) {
            return status_fail(STATUS_CASE, "the natural curvature of %s has a ramp of %g s: set wave.ramp to 0",
                               fish->name, fish->ramp);
        }

        fish_prescribed_node(&school->fish[0], NULL, 0, 0, position, first, acceleration);
        fish_prescribed_node(fish, NULL, 0, 0, position, velocity, acceleration);
        if (fabs(velocity[0] - first[0]) + fabs(velocity[1] - first[1]) > 0) {
            return status_fail(STATUS_CASE,
                               "%s and %s move at different velocities: give both fish the same motion.speed",
                               school->fish[0].name, fish->name);
        }

        if (fabs(velocity[1]) > 0 && (school->walls.n > 0 || fabs(school->shear) > 0)) {
            return status_fail(STATUS_CASE,
                               "%s moves across %s, so no equilibrium exists: set start.heading to 0 or 180, or "
                               "motion.speed to 0",
                               fish->name, school->walls.n > 0 ? "a channel" : "a shear");
        }
    }

    if (school->gust_omega > 0 && fabs(school->gust[0]) + fabs(school->gust[1]) > 0) {
        return status_fail(
            STATUS_CASE,
            "no fish beats, so an oscillating gust has no equilibrium: set fluid.gust.amplitude to 0, or "
            "give a fish the frequency of the gust");
    }

    if (school->removed == REMOVED_DROPPED) {
        return status_fail(STATUS_CASE,
                           "removed circulation is dropped, so a body with lift never stops shedding: set "
                           "wake.removed_circulation to retained");
    }

    return STATUS_OK;
}

// ---- growth of the stream and the loads from zero

struct growth {
    struct arena *arena;
    struct simulation *simulation;
    struct school
        school; /* school of the simulation with a part of the stream and loads; owns the array of fish only */
    struct equilibrium *equilibrium;
    double *last;                      /* the last solution                                          (n_unknowns) */
    double last_part;                  /* of the stream at the last solution */
    struct equilibrium_stiffness rest; /* without stream and loads */
};

/* Largest rotation of an edge between two successive solutions of one branch. */
static const double most_turn = 0.5; /* rad */

/* A branch ends if a step by this part of the stream fails. */
static const double least_step = 1e-4;

// set the stream to this part of the full stream, and the loads to the square of this part, as forces of a stream scale
static void static_set_part(struct growth *growth, double part) {
    const struct school *const whole = growth->simulation->school;
    struct school *const school = &growth->school;
    for (int i = 0; i < 2; i++) school->velocity[i] = part * whole->velocity[i];
    school->shear = part * whole->shear;
    for (int f = 0; f < school->n_fish; f++) {
        school->fish[f].motion.speed = part * whole->fish[f].motion.speed;
        for (int i = 0; i < 2; i++) school->fish[f].load_tip[i] = part * part * whole->fish[f].load_tip[i];
    }
}

// solve at this part of the stream, from the current state; on a failure restore the last solution
static enum status growth_solve(struct growth *growth, double part) {
    struct simulation *const simulation = growth->simulation;
    struct state *const state = simulation->state;
    const size_t bytes = (size_t)simulation->school->n_unknowns * sizeof *state->y;

    if (simulation->stop && *simulation->stop) {
        return status_fail(STATUS_STOPPED,
                           "stopped %s at %.3g of the stream; a search cannot be resumed: start the search again",
                           simulate_stopped_by(simulation->stop), part);
    }

    static_set_part(growth, part);
    enum status status = equilibrium_solve(growth->equilibrium);

    // the largest rotation of an edge since the last solution
    double turn = 0;
    for (int f = 0; f < simulation->school->n_fish && status == STATUS_OK; f++) {
        const struct fish *const fish = &simulation->school->fish[f];
        for (int k = 0; k < fish->n_edges; k++) {
            const struct edge a = edge_at(fish, k, growth->last), b = edge_at(fish, k, state->y);
            turn = larger(turn, fabs(atan2(edge_cross(a.t, b.t), edge_dot(a.t, b.t))));
        }
    }
    if (status == STATUS_OK && !(turn <= most_turn)) {
        status = status_fail(STATUS_SOLVER, "the solution is on another branch");
    }

    if (status != STATUS_OK) {
        memcpy(state->y, growth->last, bytes);
        return status == STATUS_STOPPED ? status : STATUS_SOLVER;
    }

    memcpy(growth->last, state->y, bytes);

    // contact detection compares with the previous positions
    memcpy(state->closest->before, state->y, bytes);
    growth->last_part = part;
    return STATUS_OK;
}

// determinant of the stiffness over the determinant at rest; negative if the equilibrium is statically unstable
static enum status find_stiffness(struct growth *growth, double *stiffness) {
    struct equilibrium_stiffness now;
    TRY(equilibrium_stiffness(growth->equilibrium, &now));
    const double size = exp(now.log_determinant - growth->rest.log_determinant);
    *stiffness = now.n_negative > 0 ? -size : size;
    return STATUS_OK;
}

static enum status growth_from_rest(struct growth *growth) {
    const struct school *const school = growth->simulation->school;
    double *const y = growth->simulation->state->y;
    static_set_part(growth, 0);

    // straight or naturally curved bodies without sheets
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const struct fish_gait gait = fish_own_gait(fish, 0);
        double direction[2], rate;
        fish_prescribe(fish, NULL, 1, 0, y);
        fish_prescribed_direction(fish, 0, direction, &rate);
        double angle = atan2(direction[1], direction[0]);
        for (int k = 1; k < fish->n_nodes; k++) {
            if (k > 1) angle += fish_natural_angle(fish, k - 2, &gait, fish->control.bias);
            if (fish_is_prescribed(fish, k, 0)) continue;
            y[edge_place(fish, 0, k)] = y[edge_place(fish, 0, k - 1)] + fish->edge_length * cos(angle);
            y[edge_place(fish, 1, k)] = y[edge_place(fish, 1, k - 1)] + fish->edge_length * sin(angle);
        }
        for (int i = fish->at.gamma; i < fish->at.phi0; i++) y[i] = 0;
    }

    memcpy(growth->last, y, (size_t)school->n_unknowns * sizeof *y);
    const enum status status = growth_solve(growth, 0);
    if (status != STATUS_SOLVER) return status;
    char reason[512];
    snprintf(reason, sizeof reason, "%s", status_message());
    return status_fail(status, "no equilibrium of the bodies, not even without a stream (%s)", reason);
}

static enum status find_solution(struct growth *growth, const char *from, struct steady_values *found) {
    const struct school *const school = growth->simulation->school;
    struct state *const state = growth->simulation->state;
    struct arena *const arena = growth->arena;
    const size_t bytes = (size_t)school->n_unknowns * sizeof *state->y;
    double *rest;
    TRY(flow_check_steady(school));
    NEW(arena, growth->last, school->n_unknowns);
    NEW(arena, rest, school->n_unknowns);
    growth->school = *school;
    NEW(arena, growth->school.fish, school->n_fish);
    memcpy(growth->school.fish, school->fish, (size_t)school->n_fish * sizeof *school->fish);
    growth->equilibrium = equilibrium_create(arena, &growth->school, state);

    TRY(growth_from_rest(growth));
    TRY(equilibrium_stiffness(growth->equilibrium, &growth->rest));

    // the full stream from the shapes in a file
    if (from) {
        memcpy(rest, growth->last, bytes);
        enum status status = steady_start_shapes(arena, from, school, state->y);
        if (status == STATUS_OK) {
            memcpy(growth->last, state->y, bytes);
            status = growth_solve(growth, 1);
        }
        if (status == STATUS_STOPPED) return status;
        if (status != STATUS_OK) memcpy(growth->last, rest, bytes);
        memcpy(state->y, growth->last, bytes);
    }

    // without a solution increase the stream from rest with adaptive steps
    double step = 1, stiffness;
    char reason[512];
    while (growth->last_part < 1) {
        const enum status status = growth_solve(growth, fmin(1, growth->last_part + step));
        if (status == STATUS_STOPPED) return status;
        step *= status == STATUS_OK ? 2 : 0.5;
        if (step >= least_step) continue;

        // the end of the branch
        snprintf(reason, sizeof reason, "%s", status_message());
        static_set_part(growth, growth->last_part);
        TRY(find_stiffness(growth, &stiffness));
        return status_fail(STATUS_SOLVER,
                           "no equilibrium in this stream: the branch from rest ends at %.4g of the stream, with "
                           "static stiffness %.2g of the stiffness at rest; try a slower stream or a stiffer body, or "
                           "start from another shape with --from (%s)",
                           growth->last_part, stiffness, reason);
    }

    TRY(find_stiffness(growth, &found->stiffness));
    found->residual = equilibrium_residual(growth->equilibrium);
    return STATUS_OK;
}

enum status steady_static_find(struct simulation *simulation, const char *from, struct steady_values *found) {
    struct growth growth = {.simulation = simulation};
    const struct school *const school = simulation->school;
    struct state *const state = simulation->state;
    const double *const y = state->y;
    growth.arena = arena_create(simulation->arena, "the equilibrium of the bodies");
    const enum status status = find_solution(&growth, from, found);
    arena_free(growth.arena);
    TRY(status);

    // evaluate the full case, which the residual of the simulation describes
    TRY(residual_evaluate(simulation->residual, &equilibrium_mode, state->t, y, state->yp,
                          simulation->residual->scratch));
    diagnostics_remember(simulation->residual, state);
    diagnostics_after_jump(simulation->residual, state);
    diagnostics_restart(simulation->residual, state);
    simulate_measure(simulation);

    const struct rigid first = rigid_of(&school->fish[0], y);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const struct diagnostics_fish *const now = &simulation->diagnostics->fish[f];
        const struct rigid rigid = rigid_of(fish, y);
        struct steady_fish *const one = &found->fish[f];
        const int tail = fish->n_nodes - 1;
        double stream[2], direction[2], rate;
        fish_prescribed_direction(fish, state->t, direction, &rate);
        const double way[2] = {y[fish->at.x + tail] - y[fish->at.x], y[fish->at.y + tail] - y[fish->at.y]};
        *one = (struct steady_fish){.speed = now->speed,
                                    .turn = NAN,
                                    .thrust = now->thrust,
                                    .actuation_power = NAN,
                                    .damping_power = NAN,
                                    .constraint_power = now->constraint_power,
                                    .deflection = edge_cross(way, direction),
                                    .power = NAN,
                                    .cost_of_transport = NAN,
                                    .efficiency = NAN,
                                    .towed_efficiency = NAN,
                                    .strouhal = NAN};
        rigid_relative_place(&first, &rigid, one->place);

        // drag and lift along and across the relative stream
        flow_external(school, state->t, now->com[0], now->com[1], &stream[0], &stream[1]);
        diagnostics_fluid_force(now->resistive_force, now->reactive_force, &now->pressure, one->force);
        for (int i = 0; i < 2; i++) stream[i] -= now->com_velocity[i];
        const double speed = hypot(stream[0], stream[1]);
        one->fluid_power = edge_dot(one->force, stream);
        one->drag = edge_dot(one->force, stream) / speed;
        one->lift = edge_cross(stream, one->force) / speed;
    }

    return STATUS_OK;
}
