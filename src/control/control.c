/* control.c: finds where a fish heads and where it should head, and sets phi0 by one of the laws. */
#include "control/control.h"

#include <math.h>

#include "base/mathematics.h"

// ---- Hermite interpolation between value and three derivatives at the start and the target with zero derivatives
// at the end

// value and derivatives by q, up to the third
static void lead_derivatives(const struct lead *lead, double q, double given[LEAD_GIVEN]) {
    double series[LEAD_TERMS];
    for (int i = 0; i < LEAD_TERMS; i++) series[i] = lead->series[i];
    for (int k = 0; k < LEAD_GIVEN; k++) {
        given[k] = 0;
        for (int i = LEAD_TERMS - 1; i >= 0; i--) given[k] = given[k] * q + series[i];
        for (int i = 0; i + 1 < LEAD_TERMS; i++) series[i] = (i + 1) * series[i + 1];
        series[LEAD_TERMS - 1] = 0;
    }
}

// fraction of the last change; 1 before any change
static double lead_progress(const struct lead *lead, double t) {
    return lead->ramp > 0 ? (t - lead->start) / lead->ramp : 1;
}

double lead_value(const struct lead *lead, double t) {
    const double q = lead_progress(lead, t);
    if (q >= 1) return lead->target;
    double given[LEAD_GIVEN];
    lead_derivatives(lead, q, given);
    return given[0];
}

double lead_rate(const struct lead *lead, double t) {
    const double q = lead_progress(lead, t);
    if (q >= 1) return 0;
    double given[LEAD_GIVEN];
    lead_derivatives(lead, q, given);
    return given[1] / lead->ramp;
}

double lead_change_of_rate(const struct lead *lead, double t) {
    const double q = lead_progress(lead, t);
    if (q >= 1) return 0;
    double given[LEAD_GIVEN];
    lead_derivatives(lead, q, given);
    return given[2] / (lead->ramp * lead->ramp);
}

double lead_integral(const struct lead *lead, double t) {
    const double q = lead_progress(lead, t), end = q < 1 ? q : 1;
    double integral = 0;
    for (int i = LEAD_TERMS - 1; i >= 0; i--) integral = (integral + lead->series[i] / (i + 1)) * end;
    integral *= lead->ramp;

    // constant value after the ramp
    if (q >= 1) integral += (t - lead->start - lead->ramp) * lead->target;
    return lead->integral + integral;
}

void lead_begin(struct lead *lead, double t, double ramp, const double given[LEAD_GIVEN], double target) {
    lead->integral = lead_integral(lead, t);
    const double from_target[LEAD_GIVEN] = {given[0] - target, given[1], given[2], given[3]};

    // the sum over k of from_target[k] q^k/k! (1 - q)^4 (1 + 4 q + 10 q^2 + 20 q^3, truncated at q^(3-k)): given
    // derivatives at q = 0, zero derivatives at q = 1
    static const double fall[] = {1, -4, 6, -4, 1}, rise[] = {1, 4, 10, 20}, factorial[] = {1, 1, 2, 6};
    for (int i = 0; i < LEAD_TERMS; i++) lead->series[i] = 0;
    for (int k = 0; k < LEAD_GIVEN; k++) {
        for (int j = 0; j + k < LEAD_GIVEN; j++) {
            for (int i = 0; i < 5; i++) lead->series[k + j + i] += from_target[k] / factorial[k] * rise[j] * fall[i];
        }
    }

    lead->series[0] += target;
    lead->start = t;
    lead->ramp = ramp;
    lead->target = target;
}

void lead_change(struct lead *lead, double t, double ramp, double target) {
    if (lead->target == target) return;
    double given[LEAD_GIVEN] = {lead->target, 0, 0, 0};
    const double q = lead_progress(lead, t);
    if (q < 1) lead_derivatives(lead, q, given);

    // derivatives by q of the new ramp
    double ratio = 1;
    for (int k = 1; k < LEAD_GIVEN; k++) {
        if (q < 1) ratio *= ramp / lead->ramp;
        given[k] *= ratio;
    }

    lead_begin(lead, t, ramp, given, target);
}

// ---- headings and laws

bool control_uses_moment(const struct fish *fish) {
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

int control_n_waypoints(const struct fish *fish, const struct control_memory *memory) {
    return memory->has_waypoints ? memory->n_waypoints : fish->control.n_waypoints;
}

static bool steers_to_waypoint(const struct fish *fish, const struct control_memory *memory) {
    return memory->waypoint < control_n_waypoints(fish, memory);
}

// position of waypoint i; i < 0: start of the leg to the first waypoint
static void waypoint_place(const struct fish *fish, const struct control_memory *memory, int i, double place[2]) {
    for (int d = 0; d < 2; d++) {
        if (memory->has_waypoints) {
            place[d] = i < 0 ? memory->set_out[d] : memory->waypoints[2 * i + d];
        } else {
            const double *const along = d == 0 ? fish->control.waypoint_x : fish->control.waypoint_y;
            place[d] = i < 0 ? fish->start_position[d] : along[i];
        }
    }
}

// vector from the nose to the next waypoint
static void waypoint_vector(const struct fish *fish, const struct control_memory *memory, const double *y,
                            double away[2]) {
    waypoint_place(fish, memory, memory->waypoint, away);
    away[0] -= y[fish->at.x];
    away[1] -= y[fish->at.y];
}

// desired heading of the table and its rate, rad s-1
static double table_heading(const struct control_law_data *control, double t, double *rate) {
    *rate = 0;
    if (t < control->heading_time[0]) return control->heading[0];
    for (int i = 0; i + 1 < control->n_headings; i++) {
        const double start = control->heading_time[i], end = control->heading_time[i + 1];
        if (t >= end) continue;
        const double rise = control->heading[i + 1] - control->heading[i];
        *rate = rise / (end - start);
        return control->heading[i] + (t - start) / (end - start) * rise;
    }

    return control->heading[control->n_headings - 1];
}

double control_desired_heading(const struct fish *fish, const struct control_memory *memory, double t,
                               const double *y) {
    if (fish->control.law == CONTROL_PLACE) return memory->held_heading;
    if (control_n_waypoints(fish, memory) == 0) {
        double rate;
        return memory->has_heading ? lead_value(&memory->heading, t) : table_heading(&fish->control, t, &rate);
    }

    if (!steers_to_waypoint(fish, memory)) return memory->held_heading;
    double away[2];
    waypoint_vector(fish, memory, y, away);

    return atan2(away[1], away[0]);
}

// argument of the hyperbolic tangent of the laws
static double law_argument(const struct fish *fish, const struct control_memory *memory, double t, double direction,
                           double more, const double *y) {
    return fish->control.gain * angle_wrap(direction - control_desired_heading(fish, memory, t, y)) + more;
}

double control_law(const struct fish *fish, const struct control_memory *memory, double t, double direction,
                   double more, const double *y) {
    return fish->control.limit * tanh(law_argument(fish, memory, t, direction, more, y));
}

// law heading, between two events
static double heading_argument(const struct fish *fish, const struct control_memory *memory, double t, double since,
                               const double *y) {
    const double feedforward = fish->control.feedforward * (memory->moment + since * memory->moment_rate);
    return law_argument(fish, memory, t, control_heading(fish, y), feedforward, y);
}

void control_residual(const struct fish *fish, const struct control_memory *memory, double t, double since,
                      const double *y, double *residual) {
    double value = 0;
    switch (fish->control.law) {
        case CONTROL_NONE: value = fish->control.bias + lead_value(&memory->bias, t); break;
        case CONTROL_HEADING: value = fish->control.limit * tanh(heading_argument(fish, memory, t, since, y)); break;
        case CONTROL_AVERAGED_HEADING:
        case CONTROL_COURSE:
        case CONTROL_PLACE: value = memory->phi0 + since * memory->phi0_rate; break;
    }

    residual[fish->at.phi0] = y[fish->at.phi0] - value;
}

// angular rate of a vector
static double turn_rate(const double vector[2], const double rate[2]) {
    return (vector[0] * rate[1] - vector[1] * rate[0]) / (vector[0] * vector[0] + vector[1] * vector[1]);
}

// derivatives of the direction of a vector, and of turn_rate by the rate
static void direction_by_vector(const double vector[2], double by[2]) {
    const double square = vector[0] * vector[0] + vector[1] * vector[1];
    by[0] = -vector[1] / square;
    by[1] = vector[0] / square;
}

// derivatives of turn_rate by the vector
static void turn_rate_by_vector(const double vector[2], const double rate[2], double by[2]) {
    const double square = vector[0] * vector[0] + vector[1] * vector[1], turning = turn_rate(vector, rate);
    by[0] = (rate[1] - 2 * vector[0] * turning) / square;
    by[1] = (-rate[0] - 2 * vector[1] * turning) / square;
}

/* Law heading between two events: the vectors whose directions it compares, their rates, the slope of the law, and the
 * rate of its argument. */
struct steering {
    bool to_waypoint;
    double head[2], head_rate[2];
    double away[2], away_rate[2]; /* from the nose to the waypoint, if any */
    double tangent, slope;        /* tanh of the argument; derivative of phi0 by the argument */
    double argument_rate;         /* s-1 */
};

static struct steering steering_at(const struct fish *fish, const struct control_memory *memory, double t, double since,
                                   const double *y) {
    struct steering of = {.to_waypoint = steers_to_waypoint(fish, memory)};
    head_vector(fish, y, of.head);
    of.head_rate[0] = y[fish->at.vx] - fish_mean(&fish->heading_point, y + fish->at.vx);
    of.head_rate[1] = y[fish->at.vy] - fish_mean(&fish->heading_point, y + fish->at.vy);

    // rate of the desired heading
    double desired = 0;
    if (of.to_waypoint) {
        waypoint_vector(fish, memory, y, of.away);
        of.away_rate[0] = -y[fish->at.vx];
        of.away_rate[1] = -y[fish->at.vy];
        desired = turn_rate(of.away, of.away_rate);
    } else if (control_n_waypoints(fish, memory) == 0 && memory->has_heading) {
        desired = lead_rate(&memory->heading, t);
    } else if (control_n_waypoints(fish, memory) == 0) {
        table_heading(&fish->control, t, &desired);
    }

    const double error_rate = turn_rate(of.head, of.head_rate) - desired;
    of.tangent = tanh(heading_argument(fish, memory, t, since, y));
    of.slope = fish->control.limit * (1 - of.tangent * of.tangent);
    of.argument_rate = fish->control.feedforward * memory->moment_rate + fish->control.gain * error_rate;
    return of;
}

double control_rate(const struct fish *fish, const struct control_memory *memory, double t, double since,
                    const double *y) {
    if (fish->control.law == CONTROL_NONE) return lead_rate(&memory->bias, t);
    if (fish->control.law != CONTROL_HEADING) return memory->phi0_rate;
    const struct steering of = steering_at(fish, memory, t, since, y);
    return of.slope * of.argument_rate;
}

bool control_rate_varies(const struct fish *fish) {
    return fish->control.law == CONTROL_HEADING;
}

void control_rate_jacobian(const struct fish *fish, const struct control_memory *memory, double t, double since,
                           const double *y, int first_row, int n_rows, const double *factor, struct sparse *jacobian) {
    const struct steering of = steering_at(fish, memory, t, since, y);
    const double gain = of.slope * fish->control.gain;

    // by the head vector and by its rate; the slope is limit (1 - tanh^2)
    double by_head[2], by_head_rate[2];
    turn_rate_by_vector(of.head, of.head_rate, by_head);
    direction_by_vector(of.head, by_head_rate);
    // the direction to the waypoint is subtracted, and the vector to it shrinks as the nose moves; without a waypoint
    // the nose has no such part
    double by_nose[2] = {0, 0}, by_nose_rate[2] = {0, 0};
    if (of.to_waypoint) {
        turn_rate_by_vector(of.away, of.away_rate, by_nose);
        direction_by_vector(of.away, by_nose_rate);
    }
    const double bend = 2 * of.tangent * of.argument_rate;
    for (int d = 0; d < 2; d++) {
        by_head[d] -= bend * by_head_rate[d];
        by_nose[d] -= bend * by_nose_rate[d];
    }

    // the nose, then the nodes of the point at a third of the length
    for (int i = -1; i < fish->heading_point.n; i++) {
        const int node = i < 0 ? 0 : fish->heading_point.node[i];
        const double weight = i < 0 ? 1 : -fish->heading_point.weight[i];
        for (int d = 0; d < 2; d++) {
            const double by_place = gain * (weight * by_head[d] + (i < 0 ? by_nose[d] : 0));
            const double by_velocity = gain * (weight * by_head_rate[d] + (i < 0 ? by_nose_rate[d] : 0));
            const int place = (d == 0 ? fish->at.x : fish->at.y) + node;
            const int velocity = (d == 0 ? fish->at.vx : fish->at.vy) + node;
            for (int k = 0; k < n_rows; k++) {
                sparse_add(jacobian, first_row + k, place, factor[k] * by_place);
                sparse_add(jacobian, first_row + k, velocity, factor[k] * by_velocity);
            }
        }
    }
}

void control_jacobian(const struct fish *fish, const struct control_memory *memory, double t, double since,
                      const double *y, struct sparse *jacobian) {
    const int row = fish->at.phi0;
    sparse_add(jacobian, row, fish->at.phi0, 1);
    if (fish->control.law != CONTROL_HEADING) return;
    const struct steering of = steering_at(fish, memory, t, since, y);
    const double gain = of.slope * fish->control.gain;

    double by_head[2];
    direction_by_vector(of.head, by_head);
    sparse_add(jacobian, row, fish->at.x, -gain * by_head[0]);
    sparse_add(jacobian, row, fish->at.y, -gain * by_head[1]);
    for (int i = 0; i < fish->heading_point.n; i++) {
        const double weight = fish->heading_point.weight[i];
        sparse_add(jacobian, row, fish->at.x + fish->heading_point.node[i], gain * weight * by_head[0]);
        sparse_add(jacobian, row, fish->at.y + fish->heading_point.node[i], gain * weight * by_head[1]);
    }
    // the direction to the waypoint turns with the nose; without a waypoint the entries are 0, for a constant pattern
    double by_nose[2] = {0, 0};
    if (of.to_waypoint) direction_by_vector(of.away, by_nose);
    sparse_add(jacobian, row, fish->at.x, -gain * by_nose[0]);
    sparse_add(jacobian, row, fish->at.y, -gain * by_nose[1]);
}

void control_advance(struct control_memory *memory, double interval) {
    memory->phi0 += interval * memory->phi0_rate;
    memory->moment += interval * memory->moment_rate;
    memory->drive += interval * memory->drive_rate;
}

/* Law place at an event: the rate of the amplitude for the distance along the heading of the leader, and the desired
 * course for the distance across. doc/model.md, section 11. */
static void place_event(const struct fish *fish, struct control_memory *memory, const struct control_view *view) {
    const struct control_law_data *const control = &fish->control;
    const double heading = view->leader_heading, turn = heading - control->frame;
    const double ahead[2] = {cos(heading), sin(heading)}, left[2] = {-ahead[1], ahead[0]};

    // the vector to the place, in body lengths: ahead and to the left. The offset turns with the leader
    double offset[2], error[2] = {0, 0}, change = 0;
    for (int d = 0; d < 2; d++) offset[d] = control->offset[d] + lead_value(&memory->offset[d], view->t);
    const double to_place[2] = {view->away[0] + cos(turn) * offset[0] - sin(turn) * offset[1],
                                view->away[1] + sin(turn) * offset[0] + cos(turn) * offset[1]};
    for (int d = 0; d < 2; d++) {
        error[0] += to_place[d] * ahead[d] / fish->length;
        error[1] += to_place[d] * left[d] / fish->length;
        change += view->away_change[d] * ahead[d] / fish->length;
    }

    // the amplitude; an integral stands still where its law is at the limit
    const double share = view->interval / fish->period / control->hold_time, most = control->amplitude_limit;
    const double wish = control->gains[0] * error[0] + control->gains[1] * change + memory->hold[0];
    const double drive = most * tanh(wish / most), slope = 1 - (drive / most) * (drive / most);
    memory->hold[0] += share * slope * control->gains[0] * error[0];
    memory->drive_rate = (drive - memory->drive) / view->interval;
    memory->drive_rate = fmax(-control->rate, fmin(control->rate, memory->drive_rate));

    // the course towards a point ahead of the place by the lookahead
    const double slant = error[1] / control->lookahead + memory->hold[1];
    memory->hold[1] += share / (1 + slant * slant) * error[1] / control->lookahead;
    memory->held_heading = heading + atan(slant);
}

bool control_event(const struct fish *fish, struct control_memory *memory, const struct control_view *view,
                   const double *y) {
    // pass the waypoints within the acceptance radius; after the last waypoint the course of the last leg is held
    const struct control_law_data *const control = &fish->control;
    bool passed = false;
    for (; steers_to_waypoint(fish, memory); memory->waypoint++, passed = true) {
        double away[2], from[2], to[2];
        waypoint_vector(fish, memory, y, away);
        if (hypot(away[0], away[1]) > control->acceptance_radius) break;
        waypoint_place(fish, memory, memory->waypoint - 1, from);
        waypoint_place(fish, memory, memory->waypoint, to);
        memory->held_heading = atan2(to[1] - from[1], to[0] - from[0]);
    }

    // the moving mean approaches the newest value by filter_share of the difference, linearly until the next event
    memory->moment_rate = control->filter_share * (view->moment - memory->moment) / view->interval;
    if (control->law == CONTROL_NONE) return false;
    if (control->law == CONTROL_HEADING) return passed;

    // target of an event-based law; phi0 is constant as long as there is no course
    double target = memory->phi0;
    if (control->law == CONTROL_AVERAGED_HEADING) {
        const double feedforward = control->feedforward * (memory->moment + view->interval * memory->moment_rate);
        target = control_law(fish, memory, view->t, view->mean_heading, feedforward, y);
    } else if (view->has_course) {
        if (control->law == CONTROL_PLACE) place_event(fish, memory, view);

        // r: weight of the course, 0 without displacement
        const double square = view->speed * view->speed;
        const double weight = square > 0 ? square / (square + control->slow * control->slow) : 0;
        memory->course_rate =
            (1 - control->course_share) * memory->course_rate + control->course_share * (weight * view->course_rate);
        const double error = angle_wrap(view->course - control_desired_heading(fish, memory, view->t, y));
        const double damping = control->damping * fish->period * memory->course_rate;
        target = control->limit * tanh(weight * control->gain * error + damping);
    }

    // approach the target by at most rate per second
    const double most = control->rate;
    memory->phi0_rate = fmax(-most, fmin(most, (target - memory->phi0) / view->interval));

    return false;
}

// ---- values set from outside

struct fish_gait control_gait(const struct fish *fish, const struct control_memory *memory, double t, double since) {
    struct fish_gait gait = fish_own_gait(fish, t);
    const double set = 1 + lead_value(&memory->amplitude, t), driven = 1 + memory->drive + since * memory->drive_rate;
    const double scale = set * driven,
                 scale_rate = lead_rate(&memory->amplitude, t) * driven + set * memory->drive_rate;
    gait.amplitude_rate = gait.amplitude_rate * scale + gait.amplitude * scale_rate;
    gait.amplitude *= scale;
    gait.angle += 2 * M_PI * lead_integral(&memory->frequency, t);
    gait.omega += 2 * M_PI * lead_value(&memory->frequency, t);

    return gait;
}

void control_heave(const struct fish *fish, const struct control_memory *memory, double t, double heave[3]) {
    heave[0] = fish->motion.heave + lead_value(&memory->heave, t);
    heave[1] = lead_rate(&memory->heave, t);
    heave[2] = lead_change_of_rate(&memory->heave, t);
}

void control_set(const struct fish *fish, struct control_memory *memory, enum control_set which, double t,
                 double value) {
    const double ramp = fish->control.ramp;
    switch (which) {
        case CONTROL_SET_AMPLITUDE: lead_change(&memory->amplitude, t, ramp, value / fish->amplitude - 1); return;
        case CONTROL_SET_FREQUENCY: lead_change(&memory->frequency, t, ramp, value - fish->omega / (2 * M_PI)); return;
        case CONTROL_SET_BIAS: lead_change(&memory->bias, t, ramp, value - fish->control.bias); return;
        case CONTROL_SET_HEAVE: lead_change(&memory->heave, t, ramp, value - fish->motion.heave); return;
        case CONTROL_SET_OFFSET_X:
            lead_change(&memory->offset[0], t, ramp, value - fish->control.nose_offset[0]);
            return;
        case CONTROL_SET_OFFSET_Y:
            lead_change(&memory->offset[1], t, ramp, value - fish->control.nose_offset[1]);
            return;
        case CONTROL_SET_HEADING: break;
    }

    // the shorter turn from the heading set before, or from the table
    if (memory->has_heading) {
        const double now = memory->heading.target;
        lead_change(&memory->heading, t, ramp, now + angle_wrap(value - now));
        return;
    }
    double rate;
    const double now = table_heading(&fish->control, t, &rate);
    lead_begin(&memory->heading, t, ramp, (const double[]){now, rate * ramp, 0, 0}, now + angle_wrap(value - now));
    memory->has_heading = true;
}

void control_set_waypoints(const struct fish *fish, struct control_memory *memory, int n, const double *waypoints,
                           const double *y) {
    memory->has_waypoints = true;
    memory->n_waypoints = n;
    memory->waypoint = 0;
    for (int i = 0; i < 2 * n; i++) memory->waypoints[i] = waypoints[i];

    memory->set_out[0] = y[fish->at.x];
    memory->set_out[1] = y[fish->at.y];
}

double control_offset(const struct fish *fish, const struct control_memory *memory, int d) {
    return fish->control.nose_offset[d] + memory->offset[d].target;
}

double control_largest_amplitude(const struct fish *fish, const struct control_memory *memory) {
    const double more = fish->control.law == CONTROL_PLACE ? fish->control.amplitude_limit : 0;
    return (1 + memory->amplitude.target) * (1 + more);
}

double control_largest_bias(const struct fish *fish, const struct control_memory *memory) {
    if (fish->control.law != CONTROL_NONE) return fish->control.limit;
    return fabs(fish->control.bias + memory->bias.target);
}
