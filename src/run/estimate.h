/* estimate.h: how long a run will take and how much memory it needs. The estimate measures the first events of the
 * run and then single events with synthetic wakes, each twice as long as the one before, and extrapolates to the
 * longest wakes. It cannot know about later changes of the motion, such as fish that approach each other or stop.
 * Tested by tests/run/test_estimate.c. */
#ifndef ESTIMATE_H
#define ESTIMATE_H

#include "run/simulate.h"

struct estimate {
    double seconds; /* CPU time of the whole run */
    double bytes;   /* of memory */
    long n_events;  /* events of the run that the estimate measured */
};

/* Estimate the cost of a run from a simulation at its start, which can only be freed afterwards. This takes at most
 * `patience` [s] of CPU time, but the first two events are always completed, because the first costs more than the
 * others. If simulation->stop interrupts the first event, the estimate extrapolates from the part that was completed.
 * Fails as simulate_step does if one of the first events fails; the run would fail at the same event. */
enum status estimate_run(struct simulation *simulation, double patience, struct estimate *estimate);

/* The CPU time [s] that all n_members runs of a study are expected to take, when those of n_estimated members take
 * `seconds` together and n_failed others have failed in their first events, which takes no time: of the members that
 * were not examined, as large a part is expected to fail. */
double estimate_of_study(double seconds, int n_estimated, int n_failed, int n_members);

#endif
