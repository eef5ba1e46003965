/* control.c: heading, desired heading, and the law between them and phi0. */
#include "model/control.h"

#include <math.h>

#include "base/angle.h"

int control_feels_moment(const struct fish *fish) {
    return fish->control.law != CONTROL_NONE && fabs(fish->control.feedforward) > 0;
}

// from the body point at a third of the length to the nose
static void head_vector(const struct fish *fish, const double *y, double head[2]) {
    const double *const x = y + fish->at.x, *const z = y + fish->at.y;
    head[0] = x[0] - fish_mean(&fish->heading_point, x);
    head[1] = z[0] - fish_mean(&fish->heading_point, z);
}

double control_heading(const struct fish *fish, const double *y) {
    double head[2];
    head_vector(fish, y, head);
    return atan2(head[1], head[0]);
}

static int steers_to_waypoint(const struct fish *fish, const struct control_memory *memory) {
    return memory->waypoint < fish->control.n_waypoints;
}

// from the nose to the waypoint that is steered to
static void to_waypoint(const struct fish *fish, const struct control_memory *memory, const double *y, double away[2]) {
    away[0] = fish->control.waypoint_x[memory->waypoint] - y[fish->at.x];
    away[1] = fish->control.waypoint_y[memory->waypoint] - y[fish->at.y];
}

static double heading_in_table(const struct control_law_data *control, double t) {
    const int last = control->n_headings - 1;
    if (t <= control->heading_time[0]) return control->heading[0];
    for (int i = 0; i < last; i++) {
        const double start = control->heading_time[i], end = control->heading_time[i + 1];
        if (t < end) {
            return control->heading[i] + (t - start) / (end - start) * (control->heading[i + 1] - control->heading[i]);
        }
    }
    return control->heading[last];
}

double control_desired_heading(const struct fish *fish, const struct control_memory *memory, double t,
                               const double *y) {
    const struct control_law_data *control = &fish->control;
    if (control->n_waypoints == 0) return heading_in_table(control, t);
    if (!steers_to_waypoint(fish, memory)) return memory->held_heading;
    double away[2];
    to_waypoint(fish, memory, y, away);
    return atan2(away[1], away[0]);
}

// what the hyperbolic tangent of the laws is taken of
static double law_argument(const struct fish *fish, const struct control_memory *memory, double t, double direction,
                           double more, const double *y) {
    return fish->control.gain * angle_wrap(direction - control_desired_heading(fish, memory, t, y)) + more;
}

double control_law(const struct fish *fish, const struct control_memory *memory, double t, double direction,
                   double more, const double *y) {
    return fish->control.limit * tanh(law_argument(fish, memory, t, direction, more, y));
}

// tau_f between two events
static double moment_at(const struct control_memory *memory, double since) {
    return memory->moment + since * memory->moment_rate;
}

// law heading, between two events
static double heading_argument(const struct fish *fish, const struct control_memory *memory, double t, double since,
                               const double *y) {
    const double feedforward = fish->control.feedforward * moment_at(memory, since);
    return law_argument(fish, memory, t, control_heading(fish, y), feedforward, y);
}

void control_residual(const struct fish *fish, const struct control_memory *memory, double t, double since,
                      const double *y, double *residual) {
    double value = fish->control.bias;
    switch (fish->control.law) {
        case CONTROL_NONE: break;
        case CONTROL_HEADING: value = fish->control.limit * tanh(heading_argument(fish, memory, t, since, y)); break;
        case CONTROL_AVERAGED_HEADING:
        case CONTROL_COURSE: value = memory->phi0 + since * memory->phi0_rate; break;
    }
    residual[fish->at.phi0] = y[fish->at.phi0] - value;
}

// how fast the table's heading changes, rad s-1
static double table_rate(const struct control_law_data *control, double t) {
    for (int i = 0; i + 1 < control->n_headings; i++) {
        const double start = control->heading_time[i], end = control->heading_time[i + 1];
        if (start <= t && t < end) return (control->heading[i + 1] - control->heading[i]) / (end - start);
    }
    return 0;
}

// the rate at which a vector turns
static double turn_rate(const double vector[2], const double rate[2]) {
    return (vector[0] * rate[1] - vector[1] * rate[0]) / (vector[0] * vector[0] + vector[1] * vector[1]);
}

static double desired_heading_rate(const struct fish *fish, const struct control_memory *memory, double t,
                                   const double *y) {
    if (fish->control.n_waypoints == 0) return table_rate(&fish->control, t);
    if (!steers_to_waypoint(fish, memory)) return 0;
    double away[2];
    to_waypoint(fish, memory, y, away);
    const double rate[2] = {-y[fish->at.vx], -y[fish->at.vy]};
    return turn_rate(away, rate);
}

double control_rate(const struct fish *fish, const struct control_memory *memory, double t, double since,
                    const double *y) {
    if (fish->control.law == CONTROL_NONE) return 0;
    if (fish->control.law != CONTROL_HEADING) return memory->phi0_rate;
    double head[2], rate[2];
    head_vector(fish, y, head);
    rate[0] = y[fish->at.vx] - fish_mean(&fish->heading_point, y + fish->at.vx);
    rate[1] = y[fish->at.vy] - fish_mean(&fish->heading_point, y + fish->at.vy);
    const double error_rate = turn_rate(head, rate) - desired_heading_rate(fish, memory, t, y);
    const double tangent = tanh(heading_argument(fish, memory, t, since, y));
    return fish->control.limit * (1 - tangent * tangent) *
           (fish->control.feedforward * memory->moment_rate + fish->control.gain * error_rate);
}

void control_jacobian(const struct fish *fish, const struct control_memory *memory, double t, double since,
                      const double *y, struct sparse *jacobian) {
    const int row = fish->at.phi0;
    sparse_add(jacobian, row, fish->at.phi0, 1);
    if (fish->control.law != CONTROL_HEADING) return;
    const double tangent = tanh(heading_argument(fish, memory, t, since, y));
    const double slope = fish->control.limit * (1 - tangent * tangent);

    // the heading turns with the head vector (hx, hy): dh = (hx dhy - hy dhx)/|h|^2
    double head[2];
    head_vector(fish, y, head);
    const double square = head[0] * head[0] + head[1] * head[1], gain = slope * fish->control.gain;
    const double by_head[2] = {-head[1] / square, head[0] / square};
    sparse_add(jacobian, row, fish->at.x, -gain * by_head[0]);
    sparse_add(jacobian, row, fish->at.y, -gain * by_head[1]);
    for (int i = 0; i < fish->heading_point.n; i++) {
        const double weight = fish->heading_point.weight[i];
        sparse_add(jacobian, row, fish->at.x + fish->heading_point.node[i], gain * weight * by_head[0]);
        sparse_add(jacobian, row, fish->at.y + fish->heading_point.node[i], gain * weight * by_head[1]);
    }
    // so does the direction to the waypoint with the nose; without one the entries are there and zero
    double by_nose[2] = {0, 0};
    if (fish->control.n_waypoints > 0 && steers_to_waypoint(fish, memory)) {
        double away[2];
        to_waypoint(fish, memory, y, away);
        const double distance = away[0] * away[0] + away[1] * away[1];
        by_nose[0] = away[1] / distance;
        by_nose[1] = -away[0] / distance;
    }
    sparse_add(jacobian, row, fish->at.x, gain * by_nose[0]);
    sparse_add(jacobian, row, fish->at.y, gain * by_nose[1]);
}

void control_advance(struct control_memory *memory, double interval) {
    memory->phi0 += interval * memory->phi0_rate;
    memory->moment += interval * memory->moment_rate;
}

// Pass the waypoints that have been reached; returns whether there are any.
static int pass_waypoints(const struct fish *fish, struct control_memory *memory, const double *y) {
    const struct control_law_data *control = &fish->control;
    int passed = 0;
    for (; steers_to_waypoint(fish, memory); memory->waypoint++, passed = 1) {
        double away[2];
        to_waypoint(fish, memory, y, away);
        if (hypot(away[0], away[1]) > control->acceptance_radius) break;
        // after the last waypoint the course of the last leg is held
        const int before = memory->waypoint - 1;
        const double from[2] = {before >= 0 ? control->waypoint_x[before] : fish->start_position[0],
                                before >= 0 ? control->waypoint_y[before] : fish->start_position[1]};
        memory->held_heading =
            atan2(control->waypoint_y[memory->waypoint] - from[1], control->waypoint_x[memory->waypoint] - from[0]);
    }
    return passed;
}

// where phi0 of a law that decides at events goes; without a course yet it stays
static double target_of(const struct fish *fish, const struct control_memory *memory, const struct control_view *view,
                        const double *y) {
    const struct control_law_data *control = &fish->control;
    if (control->law == CONTROL_COURSE) {
        if (!view->has_course) return memory->phi0;
        const double damping = control->damping * fish->period * view->course_rate;
        return control_law(fish, memory, view->t, view->course, damping, y);
    }
    const double feedforward = control->feedforward * moment_at(memory, view->interval);
    return control_law(fish, memory, view->t, view->mean_heading, feedforward, y);
}

int control_event(const struct fish *fish, struct control_memory *memory, const struct control_view *view,
                  const double *y) {
    const int passed = pass_waypoints(fish, memory, y);
    // the moving mean changes by a part of its distance from the newest value, linearly until the next event
    memory->moment_rate = fish->control.filter_share * (view->moment - memory->moment) / view->interval;
    if (fish->control.law == CONTROL_NONE) return 0;
    if (fish->control.law == CONTROL_HEADING) return passed;
    const double most = fish->control.rate, target = target_of(fish, memory, view, y);
    memory->phi0_rate = fmax(-most, fmin(most, (target - memory->phi0) / view->interval));
    return 0;
}
