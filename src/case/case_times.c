/* case_times.c: see case_times.h. */
#include "case/case_times.h"

#include <math.h>

static const double events_per_beat = 100, without_beat = 0.01 /* s */;

double case_times_beat(const struct fish_parameters *fish) {
    const bool is_prescribed = (int)fish->motion.prescribed > PRESCRIBED_NONE && fish->motion.frequency > 0;
    return is_prescribed ? fish->motion.frequency : fish->wave.frequency;
}

/* Round a time to a multiple of a unit, up or to the nearest; false if the time is a multiple already. */
static bool round_to_multiple(double *time, double unit, bool up) {
    const double n = *time / unit, nearest = fmax(round(n), 1);
    if (!(*time > 0) || fabs(n - nearest) <= 1e-9 * n) return false;
    *time = (up ? ceil(n) : nearest) * unit;
    return true;
}

void case_times_derive(struct case_values *values) {
    double *const interval = &values->school.shedding_interval;
    if (!isnan(*interval)) return;
    double fastest = 0;
    for (int i = 0; i < values->school.n_fish; i++) {
        fastest = fmax(fastest, case_times_beat(&values->school.fish[i]));
    }
    *interval = fastest > 0 ? 1 / (events_per_beat * fastest) : without_beat;
    round_to_multiple(&values->time.end, *interval, true);
    round_to_multiple(&values->time.checkpoint_interval, *interval, false);

    // round the wake interval too if the output interval is rounded or not read
    double *const rows = &values->time.output_interval;
    const bool are_free = isnan(*rows) || round_to_multiple(rows, *interval, false);
    if (are_free) round_to_multiple(&values->output.wake_interval, isnan(*rows) ? 10 * *interval : *rows, false);
}
