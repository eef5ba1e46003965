/* fish_motion.c: the motion of heaving and pitching bodies, and how a fish starts. */
#include "fish/fish_motion.h"

#include <math.h>

#include "fish/fish_gait.h"

int fish_n_prescribed(const struct fish *fish) {
    switch (fish->motion.prescribed) {
        case PRESCRIBED_NONE: return 0;
        case PRESCRIBED_HEAD: return fish->has_clamp ? 1 : 2;
        case PRESCRIBED_ALL: return fish->n_nodes;
    }
    return 0;
}

// heading angle of the prescribed motion, with first and second derivative
static void prescribed_heading(const struct fish *fish, double t, double heading[3]) {
    const struct motion *const motion = &fish->motion;
    const double omega = motion->omega, angle = omega * t + motion->phase, pitch_angle = angle + motion->pitch_phase;
    heading[0] = fish->start_heading + motion->pitch * sin(pitch_angle);
    heading[1] = motion->pitch * omega * cos(pitch_angle);
    heading[2] = -omega * omega * motion->pitch * sin(pitch_angle);
}

void fish_prescribed_direction(const struct fish *fish, double t, double direction[2], double *rate) {
    double heading[3];
    prescribed_heading(fish, t, heading);
    direction[0] = -cos(heading[0]);
    direction[1] = -sin(heading[0]);
    *rate = heading[1];
}

void fish_prescribed_node(const struct fish *fish, const double heave[3], int k, double t, double position[2],
                          double velocity[2], double acceleration[2]) {
    const struct motion *motion = &fish->motion;
    const double ahead[2] = {cos(fish->start_heading), sin(fish->start_heading)}, left[2] = {-ahead[1], ahead[0]};
    const double omega = motion->omega;
    const double angle = omega * t + motion->phase;
    const double of_case[3] = {motion->heave, 0, 0}, *const a = heave ? heave : of_case;
    const double s = sin(angle), c = omega * cos(angle);
    const double height = a[0] * s, height_rate = a[0] * c + a[1] * s;
    const double height_change = -omega * omega * height + 2 * a[1] * c + a[2] * s;
    double heading[3];
    prescribed_heading(fish, t, heading);
    const double rate = heading[1], rate_change = heading[2];
    const double along[2] = {cos(heading[0]), sin(heading[0])}, across[2] = {-along[1], along[0]};
    const double arm = motion->pivot - fish->arc[k];

    for (int i = 0; i < 2; i++) {
        position[i] = fish->start_position[i] + (motion->speed * t - motion->pivot) * ahead[i] + height * left[i] +
                      arm * along[i];
        velocity[i] = motion->speed * ahead[i] + height_rate * left[i] + arm * rate * across[i];
        acceleration[i] = height_change * left[i] + arm * (rate_change * across[i] - rate * rate * along[i]);
    }
}

void fish_prescribe(const struct fish *fish, const double heave[3], bool at_start, double t, double *y) {
    const int n = at_start ? fish->n_nodes : fish_n_prescribed(fish);
    for (int k = 0; k < n; k++) {
        double position[2], velocity[2], acceleration[2];
        fish_prescribed_node(fish, heave, k, t, position, velocity, acceleration);
        for (int i = 0; i < 2; i++) {
            if (!at_start && !fish_is_prescribed(fish, k, i)) continue;
            y[fish->at.x + i * fish->n_nodes + k] = position[i];
            y[fish->at.vx + i * fish->n_nodes + k] = velocity[i];
        }
    }
}

// ---- the start

void fish_start(const struct fish *fish, double *y) {
    double *const x = y + fish->at.x, *const z = y + fish->at.y;
    if (fish->motion.prescribed != PRESCRIBED_NONE) {
        // the free nodes behind a prescribed head start with the rigid motion of the head
        fish_prescribe(fish, NULL, true, 0, y);
        return;
    }

    // the bias of a control law is not known yet, and control.bias is 0 then
    const struct fish_gait gait = fish_own_gait(fish, 0);
    double angle = fish->start_heading - M_PI;
    x[0] = fish->start_position[0];
    z[0] = fish->start_position[1];

    for (int k = 0; k < fish->n_edges; k++) {
        if (k > 0) angle += fish_natural_angle(fish, k - 1, &gait, fish->control.bias);
        x[k + 1] = x[k] + fish->edge_length * cos(angle);
        z[k + 1] = z[k] + fish->edge_length * sin(angle);
    }

    for (int k = 0; k < fish->n_nodes; k++) {
        y[fish->at.vx + k] = fish->start_speed * cos(fish->start_heading);
        y[fish->at.vy + k] = fish->start_speed * sin(fish->start_heading);
    }
}
