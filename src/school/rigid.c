/* rigid.c: reads and changes the rigid-body quantities of a fish. */
#include "school/rigid.h"

#include <math.h>

#include "flow/flow.h"
#include "flow/flow_external.h"

struct rigid rigid_of(const struct fish *fish, const double *y) {
    const double *const x[2] = {y + fish->at.x, y + fish->at.y}, *const v[2] = {y + fish->at.vx, y + fish->at.vy};
    struct rigid rigid = {.place = {fish_mass_mean(fish, x[0]), fish_mass_mean(fish, x[1])},
                          .heading = control_heading(fish, y)};

    const double mean[2] = {fish_mass_mean(fish, v[0]), fish_mass_mean(fish, v[1])};
    const double c = cos(rigid.heading), s = sin(rigid.heading);
    rigid.velocity[0] = c * mean[0] + s * mean[1];
    rigid.velocity[1] = c * mean[1] - s * mean[0];

    double momentum = 0, inertia = 0;
    for (int k = 0; k < fish->n_nodes; k++) {
        const double arm[2] = {x[0][k] - rigid.place[0], x[1][k] - rigid.place[1]};
        momentum += fish->mass[k] * (arm[0] * (v[1][k] - mean[1]) - arm[1] * (v[0][k] - mean[0]));
        inertia += fish->mass[k] * (arm[0] * arm[0] + arm[1] * arm[1]);
    }
    rigid.turn = momentum / inertia;
    return rigid;
}

void rigid_relative_place(const struct rigid *seen_from, const struct rigid *other, double place[2]) {
    const double c = cos(seen_from->heading), s = sin(seen_from->heading);
    const double way[2] = {other->place[0] - seen_from->place[0], other->place[1] - seen_from->place[1]};
    place[0] = c * way[0] + s * way[1];
    place[1] = c * way[1] - s * way[0];
}

static void rotate(const double centre[2], double angle, double *x, double *y) {
    const double c = cos(angle), s = sin(angle), dx = *x - centre[0], dy = *y - centre[1];
    *x = centre[0] + c * dx - s * dy;
    *y = centre[1] + s * dx + c * dy;
}

static const double origin[2] = {0, 0};

// Make the wake the one of a fish that has always had the new velocity and turn, then rotate and move it with the fish;
// tail: where the last node was.
static void change_wake(struct wake *wake, double t, const double centre[2], const double tail[2],
                        const double velocity[2], double turn, double angle, const double way[2]) {
    const double of_tail[2] = {velocity[0] - turn * (tail[1] - centre[1]), velocity[1] + turn * (tail[0] - centre[0])};
    for (int i = 0; i < wake->n_vortex; i++) {
        const double age = t - wake->birth[i];
        rotate(centre, -turn * age, &wake->x[i], &wake->y[i]);
        wake->x[i] -= age * velocity[0];
        wake->y[i] -= age * velocity[1];

        rotate(centre, angle, &wake->x[i], &wake->y[i]);
        rotate(origin, angle, &wake->u[i], &wake->v[i]);
        rotate(origin, angle, &wake->u_before[i], &wake->v_before[i]);
        wake->x[i] += way[0];
        wake->y[i] += way[1];
    }

    // the slip is the velocity of the flow minus that of the tail
    for (int i = 0; i < 2; i++) {
        wake->tail_velocity[i] += of_tail[i];
        wake->slip[i] -= of_tail[i];
    }
    rotate(origin, angle, &wake->tail_velocity[0], &wake->tail_velocity[1]);
    rotate(origin, angle, &wake->tail_tangent[0], &wake->tail_tangent[1]);
    rotate(origin, angle, &wake->slip[0], &wake->slip[1]);
    wake->version++;
}

void rigid_change(const struct school *school, struct state *state, int f, const struct rigid *change) {
    const struct fish *const fish = &school->fish[f];
    const int last = fish->n_nodes - 1;
    const double tail[2] = {state->y[fish->at.x + last], state->y[fish->at.y + last]};
    const struct rigid before = rigid_of(fish, state->y);
    const double c = cos(before.heading), s = sin(before.heading);
    const double velocity[2] = {c * change->velocity[0] - s * change->velocity[1],
                                s * change->velocity[0] + c * change->velocity[1]};

    double *const x = state->y + fish->at.x, *const y = state->y + fish->at.y;
    double *const vx = state->y + fish->at.vx, *const vy = state->y + fish->at.vy;

    // change the velocity, then rotate about the centre of mass and move
    for (int k = 0; k < fish->n_nodes; k++) {
        vx[k] += velocity[0] - change->turn * (y[k] - before.place[1]);
        vy[k] += velocity[1] + change->turn * (x[k] - before.place[0]);
        rotate(before.place, change->heading, &x[k], &y[k]);
        rotate(origin, change->heading, &vx[k], &vy[k]);
        x[k] += change->place[0];
        y[k] += change->place[1];
    }
    change_wake(&state->wake[f], state->t, before.place, tail, velocity, change->turn, change->heading, change->place);

    // rotate every vector in the samples of the last period with the fish, so that means over the period do not jump
    struct history *const history = &state->history[f];
    for (int i = 0; i < history->n_slots; i++) {
        struct sample *const sample = &history->sample[i];
        rotate(before.place, change->heading, &sample->com[0], &sample->com[1]);
        rotate(before.place, change->heading, &sample->tail[0], &sample->tail[1]);
        rotate(origin, change->heading, &sample->velocity[0], &sample->velocity[1]);
        rotate(origin, change->heading, &sample->friction[0], &sample->friction[1]);
        rotate(origin, change->heading, &sample->force[0], &sample->force[1]);
        rotate(origin, change->heading, &sample->stream[0], &sample->stream[1]);
        rotate(origin, change->heading, &sample->drifted[0], &sample->drifted[1]);
        sample->heading += change->heading;
        for (int j = 0; j < 2; j++) {
            sample->com[j] += change->place[j];
            sample->tail[j] += change->place[j];
        }
    }
    // and those of the fish that hold a place beside it
    for (int g = 0; g < school->n_fish; g++) {
        const struct control_law_data *const control = &school->fish[g].control;
        if (control->law != CONTROL_PLACE || control->leader != f) continue;
        for (int i = 0; i < state->history[g].n_slots; i++) {
            struct sample *const sample = &state->history[g].sample[i];
            rotate(before.place, change->heading, &sample->leader[0], &sample->leader[1]);
            sample->leader_heading += change->heading;
            for (int j = 0; j < 2; j++) sample->leader[j] += change->place[j];
        }
    }
    if (history->n == 0) return;

    // give the newest sample the stream at its new position, from which the next event integrates drifted
    struct sample *const newest = &history->sample[history->last];
    flow_external(school, state->t, newest->com[0], newest->com[1], &newest->stream[0], &newest->stream[1]);
}
