/* estimate.h: estimate of CPU time and memory of a run. The estimate measures the first events of the run, then single
 * events with synthetic wakes of doubling length, and extrapolates the cost to the longest wakes. The estimate does not
 * account for later changes of the motion, such as fish that approach each other or stop. Tested by
 * tests/run/test_estimate.c. */
#ifndef ESTIMATE_H
#define ESTIMATE_H

#include "base/status.h"
#include "run/simulate.h"

struct estimate {
    double seconds; /* CPU time of the whole run */
    double bytes;   /* of memory */
    long n_events;  /* events of the run that the estimate measured */
};

/* Estimate the cost of a run from a simulation at the start; the simulation can only be freed afterwards. The estimate
 * takes at most `patience` [s] of CPU time, but completes the first two events: the first costs more than the others.
 * If simulation->stop interrupts the first event, the estimate has no event and extrapolates from the completed part.
 * Fails as simulate_step if one of the first events fails; the run then fails at the same event. */
enum status estimate_run(struct simulation *simulation, double patience, struct estimate *estimate);

#endif
