/* fish.c: quantities derived from the constants of a fish. */
#include "fish/fish.h"

#include <math.h>

#include "base/parallel.h"

int fish_threads(const struct school *school) {
    return parallel_threads(school->threads, school->n_fish, school->n_unknowns, PARALLEL_UNKNOWNS);
}

double fish_mean(const struct stencil *point, const double *value) {
    double mean = 0;
    for (int i = 0; i < point->n; i++) mean += point->weight[i] * value[point->node[i]];
    return mean;
}

double fish_mass_mean(const struct fish *fish, const double *value) {
    double sum = 0;
    for (int k = 0; k < fish->n_nodes; k++) sum += fish->mass[k] * value[k];
    return sum / fish->total_mass;
}

struct direction fish_direction(const struct fish *fish, const struct tangent *tangent, const double *y) {
    const double *const x = y + fish->at.x, *const z = y + fish->at.y;
    const double e[2] = {fish_mean(&tangent->to, x) - fish_mean(&tangent->from, x),
                         fish_mean(&tangent->to, z) - fish_mean(&tangent->from, z)};
    struct direction direction = {.length = sqrt(e[0] * e[0] + e[1] * e[1])};
    direction.t[0] = e[0] / direction.length;
    direction.t[1] = e[1] / direction.length;
    direction.n[0] = -direction.t[1];
    direction.n[1] = direction.t[0];

    return direction;
}

int fish_has_momentum(const struct fish *fish) {
    return fish->at.px < fish->at.ax;
}

int fish_feels_own_wake(const struct fish *fish) {
    return fish->force != FORCE_REACTIVE;
}

int fish_has_wave(const struct fish *fish) {
    int has = fish->n_harmonics > 0;
    for (int j = 0; j < fish->n_joints; j++) has |= fabs(fish->wave_amplitude[j]) > 0;
    return has && fish->omega > 0 && fish->motion.prescribed != PRESCRIBED_ALL;
}

double fish_rate(const struct school *school, const struct fish *fish) {
    if (fish->frequency > 0) return fish->frequency;
    const double drift = hypot(school->velocity[0], school->velocity[1]);
    const double speed = fmax(fmax(fabs(fish->start_speed), fabs(fish->motion.speed)), drift);
    return speed > 0 ? speed / fish->length : 1;
}
