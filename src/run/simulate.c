/* simulate.c: creation of a simulation from a case or from a state, and the step from event to event. */
#include "run/simulate.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <time.h>

#include "base/memory.h"
#include "body/rod.h"
#include "fish/fish.h"
#include "fish/fish_school.h"
#include "flow/flow_at_bodies.h"
#include "result/result_table.h"
#include "run/event.h"
#include "solver/integrator.h"

static double wall_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Set the highest order of ida. Default (doc/numerics.md, section 3): 2 if the stiffness of a body is not damped, 5 if
 * the slowest bending mode of every fish is below 0.6 of the beat frequency, else 3. */
static enum status simulation_set_order(struct simulation *simulation, const struct case_values *values) {
    const struct school *const school = simulation->school;
    simulation->options.order = values->solver.order;
    if (values->solver.order > 0 || values->solver.method != METHOD_IDA) return STATUS_OK;

    bool are_soft = true;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const double periods = values->school.fish[f].body.relaxation_time * fish->frequency;
        simulation->options.order = 2;
        if (!(periods > 0.001 * (1 - 1e-9))) return STATUS_OK;
        if (!are_soft) continue;

        double *scratch;
        TRY(MEMORY_NEW(scratch, 6 * fish->n_nodes, "the bending modes"));
        are_soft = bending_mode_frequency(fish, scratch) < 0.6 * fish->frequency;
        free(scratch);
    }

    simulation->options.order = are_soft ? 5 : 3;
    return STATUS_OK;
}

// an empty simulation of a case
static enum status simulation_begin(struct simulation **simulation, const struct case_values *values) {
    TRY(MEMORY_NEW(*simulation, 1, "a simulation"));
    struct simulation *const new = *simulation;
    new->started = wall_clock();
    new->n_events = lround(values->time.end / values->school.shedding_interval);
    new->integrator = integrator_of(values->solver.method);
    new->options = (struct integrator_options){
        .method = values->solver.method, .step = values->solver.step, .max_steps = values->solver.max_steps};
    return STATUS_OK;
}

// discard a simulation that could not be built
static enum status simulation_discard_failed(struct simulation **simulation, enum status status) {
    if (status == STATUS_OK) return STATUS_OK;
    simulate_free(*simulation);
    *simulation = NULL;
    return status;
}

static enum status simulation_create_equations(struct simulation *simulation) {
    TRY(residual_create(&simulation->residual, simulation->school, simulation->state));
    return initial_conditions_create(&simulation->consistent, simulation->residual);
}

static enum status simulation_create_integrator(struct simulation *simulation) {
    return simulation->integrator->create(&simulation->solver, simulation->residual, simulation->state,
                                          &simulation->options);
}

static void simulation_free_solvers(struct simulation *simulation) {
    if (simulation->integrator) simulation->integrator->free(simulation->solver);
    initial_conditions_free(simulation->consistent);
    residual_free(simulation->residual);
    simulation->solver = NULL;
    simulation->consistent = NULL;
    simulation->residual = NULL;
}

static enum status simulation_start(struct simulation *simulation, const struct case_values *values,
                                    const volatile sig_atomic_t *stop) {
    simulation->stop = stop;
    TRY(fish_school_create(&simulation->school, &values->school));
    TRY(simulation_set_order(simulation, values));
    TRY(state_create(&simulation->state, simulation->school));
    TRY(simulation_create_equations(simulation));
    TRY(diagnostics_create(&simulation->diagnostics, simulation->school));
    initial_conditions_listen(simulation->consistent, stop);
    TRY(event_start(simulation->state, simulation->residual, simulation->consistent));
    return simulation_create_integrator(simulation);
}

enum status simulate_start(struct simulation **simulation, const struct case_values *values,
                           const volatile sig_atomic_t *stop) {
    TRY(simulation_begin(simulation, values));
    return simulation_discard_failed(simulation, simulation_start(*simulation, values, stop));
}

enum status simulate_create(struct simulation **simulation, const struct case_values *values) {
    return simulate_start(simulation, values, NULL);
}

const char *simulate_stopped_by(const volatile sig_atomic_t *stop) {
    return *stop == SIGALRM ? "after --max-wall" : "by a signal";
}

enum status simulate_renew(struct simulation *simulation) {
    simulation_free_solvers(simulation);
    simulation->options.before = simulation->totals;
    TRY(simulation_create_equations(simulation));
    TRY(flow_interpolate(simulation->residual->flow, simulation->state));
    return simulation_create_integrator(simulation);
}

enum status simulate_take_up(struct simulation **simulation, const struct case_values *values, struct school *school,
                             struct state *state, const struct integrator_counts *totals) {
    const enum status begun = simulation_begin(simulation, values);
    if (begun != STATUS_OK) {
        state_free(state, school);
        fish_school_free(school);
        return begun;
    }

    struct simulation *const new = *simulation;
    new->school = school;
    new->state = state;
    new->totals = *totals;
    enum status status = simulation_set_order(new, values);
    if (status == STATUS_OK) status = diagnostics_create(&new->diagnostics, school);
    if (status == STATUS_OK) status = simulate_renew(new);
    return simulation_discard_failed(simulation, status);
}

void simulate_free(struct simulation *simulation) {
    if (!simulation) return;
    simulation_free_solvers(simulation);
    diagnostics_free(simulation->diagnostics);
    state_free(simulation->state, simulation->school);
    fish_school_free(simulation->school);
    free(simulation);
}

// contact.action: stop takes precedence over the status of the integrator
static enum status simulation_refuse_contact(const struct simulation *simulation) {
    const struct school *const school = simulation->school;
    const struct closest *const closest = simulation->state->closest;
    if (school->contact != CONTACT_STOP || closest->distance >= school->contact_range) return STATUS_OK;
    return status_fail(STATUS_CONTACT,
                       "contact of %s and %s at t = %.10g s: %.4g m between their outlines, less than contact.range, "
                       "%.4g m; contact.action is stop",
                       school->fish[closest->fish[0]].name, school->fish[closest->fish[1]].name, closest->t,
                       closest->distance, school->contact_range);
}

// name a body that is folded at a joint at the end of the last step: the curve through the nodes does not describe a
// folded body
static enum status simulation_name_folded(const struct simulation *simulation, enum status status) {
    const double right_angle = 1.57079632679489662, sharp = right_angle / 2;
    const struct school *const school = simulation->school;
    for (int f = 0; f < school->n_fish; f++) {
        double turn;
        const int joint = rod_sharpest_joint(&school->fish[f], simulation->state->closest->before, &turn);
        if (turn < sharp) continue;
        return status_fail(
            status, "%s; the body of %s folds: it turns by %.0f degrees at node %d: raise body.modulus, or nodes",
            status_message(), school->fish[f].name, turn / right_angle * 90, joint);
    }

    return status;
}

// name the two bodies, or the body and the wall, with the least gap at the end of the last step, if the gap is below
// contact.range
static enum status simulation_name_contact(const struct simulation *simulation, enum status status) {
    const struct school *const school = simulation->school;
    const double *const y = simulation->state->closest->before;
    double least = school->contact_range;
    int one = -1, other = -1, wall = -1;
    for (int f = 0; f < school->n_fish; f++) {
        int nearest;
        const double from_wall = fish_wall_distance(school, &school->fish[f], y, &nearest);
        if (from_wall < least) {
            least = from_wall;
            one = f;
            wall = nearest;
        }
        for (int g = 0; g < f; g++) {
            const double gap = fish_distance(&school->fish[g], &school->fish[f], y, least);
            if (gap >= least) continue;
            least = gap;
            one = g;
            other = f;
            wall = -1;
        }
    }

    if (one < 0) return status;
    const char *const name = school->fish[one].name;
    if (wall < 0) {
        return status_fail(status, "%s; %s and %s were in contact, with a gap of %.3g m", status_message(), name,
                           school->fish[other].name, least);
    }
    const char *const which = school->walls.n == 1 ? "" : wall == 0 ? "lower " : "upper ";
    return status_fail(status, "%s; %s was in contact with the %swall at y = %g, with a gap of %.3g m",
                       status_message(), name, which, school->walls.y[wall], least);
}

static enum status simulation_advance(struct simulation *simulation) {
    struct state *const state = simulation->state;
    const double next = (double)(state->event + 1) * simulation->school->interval;
    const enum status advanced = simulation->integrator->advance(simulation->solver, next, simulation->stop);
    TRY(simulation_refuse_contact(simulation));
    TRY(advanced);

    int jumped = 0;
    initial_conditions_listen(simulation->consistent, simulation->stop);
    TRY(event_next(state, simulation->residual, simulation->consistent, &jumped));

    // count before the restart, which discards the last step
    simulation->integrator->count(simulation->solver, &simulation->totals);
    return jumped ? simulation->integrator->restart(simulation->solver) : STATUS_OK;
}

enum status simulate_step(struct simulation *simulation) {
    const int threads = simulation->school->threads;
    parallel_choice_begin(&simulation->choice, threads);
    enum status status = simulation_advance(simulation);
    parallel_choice_end(&simulation->choice, threads);
    if (status != STATUS_SOLVER) return status;

    // what the bodies do at a failure of the integrator or of the event
    status = simulation_name_folded(simulation, status);
    return simulation_name_contact(simulation, status);
}

void simulate_measure(struct simulation *simulation) {
    diagnostics_event(simulation->residual, simulation->state, simulation->diagnostics);
}

double simulate_wall_time(const struct simulation *simulation) {
    return wall_clock() - simulation->started;
}

void simulate_row(struct simulation *simulation, struct integrator_counts *counts, struct result_row *row) {
    simulation->integrator->count(simulation->solver, counts);
    simulate_measure(simulation);
    *row = (struct result_row){.school = simulation->school,
                               .state = simulation->state,
                               .residual = simulation->residual,
                               .diagnostics = simulation->diagnostics,
                               .counts = counts,
                               .wall_time = simulate_wall_time(simulation),
                               .with_wake = true};
}
