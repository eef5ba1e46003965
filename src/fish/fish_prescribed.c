/* fish_prescribed.c: sines in time, with derivatives. */
#include "fish/fish_prescribed.h"

#include <math.h>

int fish_n_prescribed(const struct fish *fish) {
    switch (fish->motion.prescribed) {
        case PRESCRIBED_NONE: return 0;
        case PRESCRIBED_HEAD: return fish->has_clamp ? 1 : 2;
        case PRESCRIBED_ALL: return fish->n_nodes;
    }
    return 0;
}

int fish_is_prescribed(const struct fish *fish, int k, int i) {
    return k < fish_n_prescribed(fish) && (i == 1 || fish->motion.surge == SURGE_GIVEN);
}

// heading angle of the prescribed motion, with first and second derivative
static void prescribed_heading(const struct fish *fish, double t, double heading[3]) {
    const struct motion *motion = &fish->motion;
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

void fish_prescribed_node(const struct fish *fish, int k, double t, double position[2], double velocity[2],
                          double acceleration[2]) {
    const struct motion *motion = &fish->motion;
    const double ahead[2] = {cos(fish->start_heading), sin(fish->start_heading)}, left[2] = {-ahead[1], ahead[0]};
    const double omega = motion->omega;
    const double angle = omega * t + motion->phase;
    const double heave = motion->heave * sin(angle), heave_rate = motion->heave * omega * cos(angle);
    const double heave_change = -omega * omega * heave;
    double heading[3];
    prescribed_heading(fish, t, heading);
    const double rate = heading[1], rate_change = heading[2];
    const double along[2] = {cos(heading[0]), sin(heading[0])}, across[2] = {-along[1], along[0]};
    const double arm = motion->pivot - fish->arc[k];

    for (int i = 0; i < 2; i++) {
        position[i] =
            fish->start_position[i] + (motion->speed * t - motion->pivot) * ahead[i] + heave * left[i] + arm * along[i];
        velocity[i] = motion->speed * ahead[i] + heave_rate * left[i] + arm * rate * across[i];
        acceleration[i] = heave_change * left[i] + arm * (rate_change * across[i] - rate * rate * along[i]);
    }
}

void fish_prescribe(const struct fish *fish, int at_start, double t, double *y) {
    const int n = at_start ? fish->n_nodes : fish_n_prescribed(fish);
    for (int k = 0; k < n; k++) {
        double position[2], velocity[2], acceleration[2];
        fish_prescribed_node(fish, k, t, position, velocity, acceleration);
        for (int i = 0; i < 2; i++) {
            if (!at_start && !fish_is_prescribed(fish, k, i)) continue;
            y[fish->at.x + i * fish->n_nodes + k] = position[i];
            y[fish->at.vx + i * fish->n_nodes + k] = velocity[i];
        }
    }
}
