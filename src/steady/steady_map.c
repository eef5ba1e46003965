/* steady_map.c: swims a beat, and reads and changes the slow quantities. */
#include "steady/steady_map.h"

#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "contact/clearance.h"
#include "flow/flow.h"
#include "flow/flow_external.h"
#include "school/diagnostics_energy.h"
#include "school/diagnostics_momentum.h"
#include "state/state.h"

enum steady_freedom steady_map_freedom(const struct fish *fish) {
    if (fish->motion.prescribed == PRESCRIBED_NONE) return STEADY_SWIMS;
    return fish->motion.is_held ? STEADY_HELD : STEADY_SURGES;
}

enum status steady_map_refuse(const struct school *school) {
    const struct fish *const first = fish_first_beating(school);
    if (!first) return status_fail(STATUS_CASE, "no fish beats, so there is no beat to repeat");

    // the common beat period of all fish
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        if (fish->period <= 0 || fabs(fish->period - first->period) <= 1e-9 * first->period) continue;
        return status_fail(STATUS_CASE,
                           "%s beats %g times per second and %s beats %g times: a periodic state needs one frequency",
                           first->name, 1 / first->period, fish->name, 1 / fish->period);
    }

    // an integer number of events and gusts in a beat
    const double period = first->period, events = period / school->interval, whole = round(events);
    if (whole < 1 || !(fabs(events - whole) <= 1e-6 * events)) {
        return status_fail(STATUS_CASE,
                           "a beat of %.10g s has %.6g events, not an integer: set time.shedding_interval to %.10g, "
                           "and time.end and time.output_interval to multiples of it",
                           period, events, period / ceil(events));
    }

    const double gusts = school->gust_omega * period / (2 * M_PI);
    const bool has_gust = fabs(school->gust[0]) + fabs(school->gust[1]) > 0;
    if (!has_gust || fabs(gusts - nearbyint(gusts)) <= 1e-9 * gusts) return STATUS_OK;
    return status_fail(STATUS_CASE,
                       "a beat has %g gusts, not an integer: set fluid.gust.frequency to a multiple of the frequency "
                       "of the beat",
                       gusts);
}

enum status steady_map_create(struct steady_map *map, struct simulation *simulation) {
    const struct school *const school = simulation->school;
    *map = (struct steady_map){.simulation = simulation};
    NEW(simulation->arena, map->last, school->n_fish);
    NEW(simulation->arena, map->before, school->n_fish);
    for (int f = 0; f < school->n_fish && !map->is_steered; f++) {
        const enum control_law law = school->fish[f].control.law;
        map->is_steered = law != CONTROL_NONE && law != CONTROL_PLACE;
        map->steered = f;
    }
    TRY(steady_map_refuse(school));
    map->period = fish_first_beating(school)->period;
    map->events = lround(map->period / school->interval);
    return STATUS_OK;
}

// ---- one beat

// trapezoidal rule over the events of a beat: half weight for both ends
static void add_event(struct steady_map *map, long event) {
    const struct simulation *const simulation = map->simulation;
    const struct school *const school = simulation->school;
    const double share = (event % map->events == 0 ? 0.5 : 1) / (double)map->events;
    struct rigid axes = rigid_of(&school->fish[0], simulation->state->y);
    axes.heading = map->before[0].turn * (double)event / (double)map->events;

    for (int f = 0; f < school->n_fish; f++) {
        const struct diagnostics_fish *const now = &simulation->diagnostics->fish[f];
        struct steady_beat *const sum = &map->last[f];

        sum->heading += share * state_recall(&simulation->state->history[f], 0)->heading;

        // where another fish is, in axes that turn with the path of the first fish but do not yaw with it
        const struct rigid other = rigid_of(&school->fish[f], simulation->state->y);
        double place[2];
        rigid_relative_place(&axes, &other, place);
        for (int i = 0; i < 2 && f > 0; i++) sum->place[i] += share * place[i];

        double force[2];
        diagnostics_fluid_force(now->resistive_force, now->reactive_force, &now->pressure, force);
        for (int i = 0; i < 2; i++) sum->force[i] += share * force[i];
        const double power = now->actuation_power + now->constraint_power;
        sum->thrust += share * now->thrust;
        sum->rms_thrust += share * now->thrust * now->thrust;
        sum->rms_power += share * power * power;
    }
}

enum status steady_map_beat(struct steady_map *map, enum status (*row)(void *data), void *data) {
    struct steady_beat *const oldest = map->before;
    map->before = map->last;
    map->last = oldest;
    memset(map->last, 0, (size_t)map->simulation->school->n_fish * sizeof *map->last);
    simulate_measure(map->simulation);
    add_event(map, 0);

    for (long i = 1; i <= map->events; i++) {
        TRY(simulate_step(map->simulation));
        simulate_measure(map->simulation);
        add_event(map, i);
        if (row) TRY(row(data));
    }

    // means from the history; works give the mean powers, because works include the steps between events
    for (int f = 0; f < map->simulation->school->n_fish; f++) {
        const struct history *const history = &map->simulation->state->history[f];
        const struct sample *const created = state_recall(history, 0), *const old =
                                                                           state_recall(history, history->n - 1);
        struct steady_beat *const beat = &map->last[f];
        beat->speed = map->simulation->diagnostics->fish[f].speed;
        beat->turn = created->heading - old->heading;
        const struct steady_unknown place[] = {{f, STEADY_AHEAD}, {f, STEADY_ASIDE}};
        steady_map_read(map, 2, place, beat->end_place);

        // turn the axes of add_event, which are those of the ground at the begin of the beat, to the mean heading
        const struct rigid axes = {.heading = map->last[0].heading - map->before[0].turn / 2},
                           mean = {.place = {beat->place[0], beat->place[1]}};
        if (f > 0) rigid_relative_place(&axes, &mean, beat->place);

        beat->actuation = (created->work[WORK_ACTUATION] - old->work[WORK_ACTUATION]) / map->period;
        beat->damping = (created->work[WORK_DAMPING] - old->work[WORK_DAMPING]) / map->period;
        beat->driving = (created->work[WORK_DRIVING] - old->work[WORK_DRIVING]) / map->period;
        beat->fluid = (old->work[WORK_FLUID] - created->work[WORK_FLUID]) / map->period;
        beat->rms_thrust = sqrt(beat->rms_thrust);
        beat->rms_power = sqrt(beat->rms_power);
    }
    map->n_beats++;
    return STATUS_OK;
}

// change over scale; 0 if the scale is 0
static double relative_change(double now, double before, double scale) {
    return scale <= 0 ? 0 : fabs(now - before) / scale;
}

double steady_map_residual(const struct steady_map *map) {
    const struct school *const school = map->simulation->school;
    double residual = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const struct steady_beat *const now = &map->last[f], *const before = &map->before[f];
        residual = larger(residual, relative_change(now->speed, before->speed, school->fish[f].length / map->period));
        const bool circles = fabs(school->fish[f].control.bias) > 0;
        residual = larger(residual, relative_change(now->turn, before->turn, (circles ? 1 : 10) * 2 * M_PI));
        for (int i = 0; i < 2 && map->is_formation; i++) {
            residual =
                larger(residual, relative_change(now->end_place[i], before->end_place[i], school->fish[f].length));
        }
        if (steady_map_freedom(&school->fish[f]) != STEADY_HELD) continue;
        residual = larger(residual, relative_change(now->thrust, before->thrust, now->rms_thrust));
        residual = larger(residual, relative_change(now->actuation + now->driving, before->actuation + before->driving,
                                                    now->rms_power));
    }

    return residual;
}

// ---- the slow quantities

double steady_map_scale(const struct steady_map *map, struct steady_unknown unknown) {
    const double length = map->simulation->school->fish[unknown.fish].length;
    switch (unknown.quantity) {
        case STEADY_SPEED:
        case STEADY_SLIP: return length / map->period;
        case STEADY_TURN: return 1 / map->period;
        case STEADY_HEADING:
        case STEADY_HOLD_ALONG:
        case STEADY_HOLD_ACROSS: return 1;
        case STEADY_SHED: return length * length / map->period;
        default: return length;
    }
}

void steady_map_read(const struct steady_map *map, int n, const struct steady_unknown *unknown, double *value) {
    const struct simulation *const simulation = map->simulation;
    const struct school *const school = simulation->school;
    const struct state *const state = simulation->state;
    const struct rigid first = rigid_of(&school->fish[0], state->y);

    for (int i = 0; i < n; i++) {
        const int f = unknown[i].fish;
        const struct rigid rigid = rigid_of(&school->fish[f], state->y);

        // the stream at the centre of mass: components along the heading and to the left
        double u, v, place[2];
        flow_external(school, state->t, rigid.place[0], rigid.place[1], &u, &v);
        const double c = cos(rigid.heading), s = sin(rigid.heading);
        rigid_relative_place(&first, &rigid, place);

        // the heading is relative to that of the first fish; of the first fish, to the desired heading, if any
        double heading = first.heading;
        if (f == 0 && map->is_steered) {
            heading =
                control_desired_heading(&school->fish[map->steered], &state->control[map->steered], state->t, state->y);
        }
        switch (unknown[i].quantity) {
            case STEADY_SPEED: value[i] = rigid.velocity[0] - (c * u + s * v); break;
            case STEADY_SLIP: value[i] = rigid.velocity[1] - (c * v - s * u); break;
            case STEADY_TURN: value[i] = rigid.turn; break;
            case STEADY_HEADING: value[i] = remainder(rigid.heading - heading, 2 * M_PI); break;
            case STEADY_AHEAD: value[i] = place[0]; break;
            case STEADY_ASIDE: value[i] = place[1]; break;
            case STEADY_SHED: value[i] = state->wake[f].shed_before; break;
            case STEADY_HOLD_ALONG: value[i] = state->control[f].hold[0]; break;
            case STEADY_HOLD_ACROSS: value[i] = state->control[f].hold[1]; break;
        }
    }
}

// renew all data derived from the state; evaluate the fluid velocity at the event
static enum status renew_simulation(struct simulation *simulation) {
    TRY(simulate_renew(simulation));
    struct residual *const residual = simulation->residual;
    const struct state *const state = simulation->state;
    const enum status status =
        residual_evaluate(residual, &residual_run, state->t, state->y, state->yp, residual->scratch);
    return status == STATUS_RETRY ? status_fail(STATUS_SOLVER, "%s", status_message()) : status;
}

enum status steady_map_add(struct steady_map *map, int n, const struct steady_unknown *unknown, const double *add) {
    struct simulation *const simulation = map->simulation;
    struct residual *const residual = simulation->residual;
    struct state *const state = simulation->state;
    const struct school *const school = simulation->school;
    const struct rigid first = rigid_of(&school->fish[0], state->y);
    const double c = cos(first.heading), s = sin(first.heading);
    double turn = 0;

    diagnostics_before_jump(residual, state);
    for (int f = 0; f < school->n_fish; f++) {
        struct rigid change = {.heading = 0};
        for (int i = 0; i < n; i++) {
            if (unknown[i].fish != f) continue;
            switch (unknown[i].quantity) {
                case STEADY_SPEED: change.velocity[0] += add[i]; break;
                case STEADY_SLIP: change.velocity[1] += add[i]; break;
                case STEADY_TURN: change.turn += add[i]; break;
                case STEADY_HEADING: change.heading += add[i]; break;
                case STEADY_AHEAD:
                    change.place[0] += c * add[i];
                    change.place[1] += s * add[i];
                    break;
                case STEADY_ASIDE:
                    change.place[0] -= s * add[i];
                    change.place[1] += c * add[i];
                    break;
                case STEADY_SHED:
                    // the added circulation counts as shed infinitely long ago
                    state->y[school->fish[f].at.circulation] += add[i];
                    wake_add_shed(&state->wake[f], add[i]);
                    break;
                case STEADY_HOLD_ALONG: state->control[f].hold[0] += add[i]; break;
                case STEADY_HOLD_ACROSS: state->control[f].hold[1] += add[i]; break;
            }
        }

        // rotate another fish with the first fish: the place in the frame of the first fish is constant
        if (f == 0) turn = change.heading;
        if (f > 0 && fabs(turn) > 0) {
            const struct rigid other = rigid_of(&school->fish[f], state->y);
            const double way[2] = {other.place[0] - first.place[0], other.place[1] - first.place[1]};
            change.heading += turn;
            change.place[0] += (cos(turn) - 1) * way[0] - sin(turn) * way[1];
            change.place[1] += sin(turn) * way[0] + (cos(turn) - 1) * way[1];
        }
        rigid_change(school, state, f, &change);
    }

    // restart the record of the closest approach
    const struct closest *const closest = state->closest;
    clearance_start(school, state, residual->neighbours, residual->scratch);
    if (!(closest->distance > 0) && school->contact != CONTACT_WARN) {
        return status_fail(STATUS_SOLVER, "collision: the next search iterate makes %s and %s overlap",
                           school->fish[closest->fish[0]].name, school->fish[closest->fish[1]].name);
    }

    // velocities are given, as at the start of a run: solve for the momenta
    const struct residual_mode start = {.velocities_are_given = true};
    TRY(initial_conditions_solve(simulation->consistent, &start, state->t, state->y, state->yp));

    // the simulation has a new residual
    TRY(renew_simulation(simulation));
    diagnostics_after_jump(simulation->residual, state);
    return STATUS_OK;
}

void steady_map_save(struct arena *arena, const struct simulation *simulation, struct state **state) {
    if (!*state) *state = state_create(arena, simulation->school);
    state_table_copy(*state, simulation->state, simulation->school, true);
}

enum status steady_map_return(struct simulation *simulation, const struct state *state) {
    state_table_copy(simulation->state, state, simulation->school, true);
    return renew_simulation(simulation);
}
