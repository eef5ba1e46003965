/* simulate.c: creates a simulation from a case or from a state, and takes it from one event to the next. */
#include "run/simulate.h"

#include <math.h>
#include <stdbool.h>
#include <time.h>

#include "base/parallel.h"
#include "body/bending_mode.h"
#include "body/rod.h"
#include "fish/fish.h"
#include "fish/fish_school.h"
#include "flow/flow_at_bodies.h"
#include "result/result_table.h"
#include "run/event.h"
#include "run/observers.h"
#include "school/diagnostics_energy.h"
#include "solver/integrator.h"

int simulate_order(struct arena *arena, const struct case_values *values, const struct school *school) {
    if (values->solver.order > 0) return values->solver.order;
    bool are_soft = true;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const double periods = values->school.fish[f].body.relaxation_time * fish->frequency;
        if (!(periods > 0.001 * (1 - 1e-9))) return 2;
        if (!are_soft) continue;

        double *scratch;
        NEW(arena, scratch, 6 * fish->n_nodes);
        are_soft = bending_mode_frequency(fish, scratch) < 0.6 * fish->frequency;
    }
    return are_soft ? 5 : 3;
}

static void simulation_set_order(struct simulation *simulation, const struct case_values *values) {
    simulation->options.order = values->solver.order;
    if (values->solver.method != METHOD_IDA) return;
    simulation->options.order = simulate_order(simulation->arena, values, simulation->school);
}

static struct simulation *simulation_begin(struct arena *parent, const struct case_values *values) {
    struct arena *const arena = arena_create(parent, "a simulation");
    struct simulation *created;
    NEW(arena, created, 1);
    created->arena = arena;
    created->started = clock_seconds(CLOCK_MONOTONIC);
    created->n_events = lround(values->time.end / values->school.shedding_interval);
    created->integrator = integrator_of(values->solver.method);
    created->options = (struct integrator_options){.method = values->solver.method,
                                                   .error_test = values->solver.error_test,
                                                   .rtol = values->solver.rtol,
                                                   .step = values->solver.step,
                                                   .max_steps = values->solver.max_steps};
    return created;
}

static void simulation_create_results(struct simulation *simulation) {
    simulation->diagnostics = diagnostics_create(simulation->arena, simulation->school);
    simulation->event = event_create(simulation->arena, simulation->school);
    simulation->observers = observers_create(simulation->arena, simulation->school);
}

/* Create the equations and their initial conditions; give up in between once *stop is not 0. */
static enum status simulation_create_equations(struct simulation *simulation, const volatile sig_atomic_t *stop) {
    arena_free(simulation->renewed);
    simulation->renewed = NULL;
    simulation->solver = NULL;
    simulation->residual = NULL;
    simulation->renewed = arena_create(simulation->arena, "the equations and the solver");
    simulation->residual = residual_create(simulation->renewed, simulation->school, simulation->state);
    TRY(status_ask(stop));
    return initial_conditions_create(simulation->renewed, &simulation->consistent, simulation->residual);
}

enum status simulate_start(struct arena *parent, struct simulation **started, const struct case_values *values,
                           const volatile sig_atomic_t *stop) {
    struct simulation *const simulation = *started = simulation_begin(parent, values);
    simulation->stop = stop;
    struct school_parameters parameters = values->school;
    parameters.stop = stop;
    TRY(fish_school_create(simulation->arena, &simulation->school, &parameters));
    simulation_set_order(simulation, values);
    simulation->state = state_create(simulation->arena, simulation->school);
    TRY(status_ask(stop));
    TRY(simulation_create_equations(simulation, stop));
    simulation_create_results(simulation);
    simulation->residual->stop = stop;
    TRY(simulate_first_event(simulation));
    TRY(status_ask(stop));
    return simulation->integrator->create(simulation->renewed, &simulation->solver, simulation->residual,
                                          simulation->state, &simulation->options);
}

const char *simulate_stopped_by(const volatile sig_atomic_t *stop) {
    return *stop == SIGALRM ? "after --max-wall" : "by a signal";
}

enum status simulate_renew(struct simulation *simulation) {
    simulation->options.before = simulation->totals;
    TRY(simulation_create_equations(simulation, NULL));
    return simulation->integrator->create(simulation->renewed, &simulation->solver, simulation->residual,
                                          simulation->state, &simulation->options);
}

enum status simulate_take_up(struct arena *parent, struct simulation **simulation, const struct case_values *values,
                             struct school *school, struct state *state, const struct integrator_counts *totals) {
    struct simulation *const created = *simulation = simulation_begin(parent, values);
    created->school = school;
    created->state = state;
    arena_move(school->arena, created->arena);
    arena_move(state->arena, created->arena);
    created->totals = *totals;
    simulation_set_order(created, values);
    simulation_create_results(created);
    return simulate_renew(created);
}

void simulate_free(struct simulation *simulation) {
    if (simulation) arena_free(simulation->arena);
}

/* Complete the message of a failure with what the bodies look like at the end of the last step. Name a body that is
 * folded at a joint, because the curve through its nodes describes no such body, and the two bodies, or the body and
 * the wall, that are closest to each other if their gap is below contact.range. */
static enum status simulation_explain(const struct simulation *simulation, enum status status) {
    const double sharp = M_PI / 4;
    const struct school *const school = simulation->school;
    const double *const y = simulation->state->closest->before;
    for (int f = 0; f < school->n_fish; f++) {
        double turn;
        const int joint = rod_sharpest_joint(&school->fish[f], y, &turn);
        if (turn < sharp) continue;
        status_fail(status,
                    "%s; the body of %s folds: it turns by %.0f degrees at node %d: raise body.modulus, or nodes",
                    status_message(), school->fish[f].name, turn / M_PI * 180, joint);
        break;
    }

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

/* What follows each step: balances and the closest approach, then whoever watches the simulation. data: struct
 * simulation. */
static void simulation_after_step(void *data, double t) {
    struct simulation *const simulation = data;
    diagnostics_step(simulation->residual, simulation->state, t, simulation->state->y);
    if (simulation->after_step) simulation->after_step(t, simulation->after_step_data);
}

enum status simulate_interval(struct simulation *simulation, double t) {
    const struct integrator_watch watch = {
        .stop = simulation->stop, .trace = simulation->trace, .after = simulation_after_step, .data = simulation};
    return integrator_advance(simulation->integrator, simulation->solver, &simulation->options, simulation->state->t, t,
                              &watch);
}

enum status simulate_first_event(struct simulation *simulation) {
    struct residual *const residual = simulation->residual;
    struct state *const state = simulation->state;
    TRY(event_start(state, residual, simulation->consistent, simulation->event));
    observers_after(residual, state, simulation->event);
    TRY(event_control(state, residual, simulation->consistent, simulation->event));
    diagnostics_start(residual, state);
    return STATUS_OK;
}

enum status simulate_event(struct simulation *simulation) {
    struct residual *const residual = simulation->residual;
    struct state *const state = simulation->state;
    observers_before(simulation->observers, residual, state);
    TRY(event_water(state, residual, simulation->consistent, simulation->event));
    observers_after(residual, state, simulation->event);
    TRY(event_control(state, residual, simulation->consistent, simulation->event));
    observers_jump(simulation->observers, residual, state, simulation->event);
    return STATUS_OK;
}

enum status simulate_step(struct simulation *simulation) {
    const struct school *const school = simulation->school;
    const struct integrator *const integrator = simulation->integrator;
    struct state *const state = simulation->state;

    // the equations may have been renewed since the last event
    simulation->residual->stop = simulation->stop;
    enum status status = simulate_interval(simulation, fish_event_time(school, state->event + 1));

    // a contact with contact.action: stop ends the run, whatever the integrator says
    const struct closest *const closest = state->closest;
    if (school->contact == CONTACT_STOP && !(closest->distance >= school->contact_range)) {
        return status_fail(STATUS_CONTACT,
                           "contact of %s and %s at t = %.10g s: %.4g m between their outlines, less than "
                           "contact.range, %.4g m; contact.action is stop",
                           school->fish[closest->fish[0]].name, school->fish[closest->fish[1]].name, closest->t,
                           closest->distance, school->contact_range);
    }

    // perform the event, and count before a restart, which discards the last step
    if (status == STATUS_OK) {
        status = simulate_event(simulation);
        if (status == STATUS_OK) simulate_count(simulation, &simulation->totals);
        if (status == STATUS_OK && simulation->event->jumps && integrator->restart)
            status = integrator->restart(simulation->solver);
    }

    return status == STATUS_SOLVER ? simulation_explain(simulation, status) : status;
}

void simulate_measure(struct simulation *simulation) {
    diagnostics_event(simulation->residual, simulation->state, simulation->diagnostics);
}

void simulate_count(const struct simulation *simulation, struct integrator_counts *counts) {
    simulation->integrator->count(simulation->solver, counts);
    counts->initial_iterations += initial_conditions_iterations(simulation->consistent);
}

double simulate_wall_time(const struct simulation *simulation) {
    return clock_seconds(CLOCK_MONOTONIC) - simulation->started;
}

void simulate_row(struct simulation *simulation, struct integrator_counts *counts, struct result_row *row) {
    simulate_count(simulation, counts);
    simulate_measure(simulation);
    *row = (struct result_row){.school = simulation->school,
                               .state = simulation->state,
                               .residual = simulation->residual,
                               .diagnostics = simulation->diagnostics,
                               .counts = counts,
                               .wall_time = simulate_wall_time(simulation),
                               .with_wake = true};
}
