/* fish_gait.c: the gait as a travelling wave, or as a Fourier series in the phase. */
#include "fish/fish_gait.h"

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
