/* fish_motion.c: the gait as a travelling wave or as a Fourier series, prescribed motion, and the start. */
#include "fish/fish_motion.h"

#include <math.h>

#include "base/mathematics.h"

void fish_gait_set(struct arena *arena, struct fish *fish, const struct fish_parameters *from) {
    const struct wave_parameters *const wave = &from->wave;
    const struct number_list *const table = &wave->table;
    const double reference = fish->length / (from->reference_nodes - 1);
    NEW(arena, fish->wave_amplitude, fish->n_joints);
    NEW(arena, fish->wave_phase, fish->n_joints);
    fish->omega = 2 * M_PI * wave->frequency;
    fish->ramp = wave->ramp;
    fish->amplitude = wave->amplitude;
    for (int joint = 0; joint < fish->n_joints; joint++) {
        const double sigma = (joint + 1.0) / fish->n_edges;
        fish->wave_amplitude[joint] = wave->amplitude * (fish->edge_length / reference) *
                                      (wave->constant + wave->linear * sigma + wave->quadratic * sigma * sigma);
        // a table contains the phase along the body
        fish->wave_phase[joint] = (table->n > 0 ? 0 : wave->number * sigma) + angle_radians(wave->phase);
    }

    // Fourier coefficients, over the phase, of the table's curvature at every joint, as a turning angle
    if (table->n == 0) return;
    const int n = table->width;
    const double unit = fish->edge_length / fish->length;
    fish->n_harmonics = n / 2 + 1;
    NEW(arena, fish->harmonic, 2 * fish->n_joints * fish->n_harmonics);
    for (int joint = 0; joint < fish->n_joints; joint++) {
        const double place = (joint + 1.0) / fish->n_edges * (table->n - 1);
        const int row = place < table->n - 2 ? (int)place : table->n - 2;
        const double *const low = &table->value[row * n], *const high = low + n;
        double *const to = &fish->harmonic[2 * joint * fish->n_harmonics];
        for (int m = 0; m < fish->n_harmonics; m++) {
            // weight 1 for the mean, and for the highest harmonic of an even number of values
            const double weight = (m == 0 || 2 * m == n ? 1.0 : 2.0) / n * unit;
            for (int j = 0; j < n; j++) {
                const double value = low[j] + (place - row) * (high[j] - low[j]), angle = 2 * M_PI * m * j / n;
                to[2 * m] += weight * value * cos(angle);
                if (2 * m < n) to[2 * m + 1] += weight * value * sin(angle);
            }
        }
    }
}

struct fish_gait fish_own_gait(const struct fish *fish, double t) {
    return (struct fish_gait){.amplitude = ramp_value(t, fish->ramp),
                              .amplitude_rate = ramp_rate(t, fish->ramp),
                              .angle = fish->omega * t,
                              .omega = fish->omega};
}

struct fish_demand fish_demand(const struct fish *fish, int j, const struct fish_gait *gait) {
    const double phase = fish->wave_phase[j] + gait->angle;
    if (fish->n_harmonics == 0) return (struct fish_demand){.sine = sin(phase), .sine_rate = gait->omega * cos(phase)};
    const double *const harmonic = &fish->harmonic[2 * j * fish->n_harmonics];
    struct fish_demand demand = {.sine = 0};

    for (int m = 0; m < fish->n_harmonics; m++) {
        const double c = cos(m * phase), s = sin(m * phase), a = harmonic[2 * m], b = harmonic[2 * m + 1];
        demand.angle += a * c + b * s;
        demand.angle_rate += m * gait->omega * (b * c - a * s);
    }

    return demand;
}

double fish_natural_angle(const struct fish *fish, int j, const struct fish_gait *gait, double phi0) {
    const struct fish_demand demand = fish_demand(fish, j, gait);
    const double angle = gait->amplitude * fish->wave_amplitude[j] * (demand.sine + phi0);
    return fish->n_harmonics == 0 ? angle : angle + gait->amplitude * demand.angle;
}

double fish_largest_turn(const struct fish *fish, double amplitude, double bias) {
    double largest = 0;
    for (int j = 0; j < fish->n_joints; j++) {
        double beat = fish->n_harmonics == 0 ? fabs(fish->wave_amplitude[j]) : 0;
        const double *const harmonic = &fish->harmonic[2 * j * fish->n_harmonics];
        for (int m = 0; m < fish->n_harmonics; m++) beat += hypot(harmonic[2 * m], harmonic[2 * m + 1]);
        largest = fmax(largest, fabs(amplitude) * (beat + fabs(fish->wave_amplitude[j] * bias)));
    }

    return largest;
}

// ---- sines in time, with derivatives

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

// ---- nodes of the initial shape from nose to tail

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
