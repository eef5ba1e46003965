/* estimate.h: what a run will take: a few of its events are done, then single events with wakes that are made up, each
 * twice as long as the one before; from these the cost of the longest wakes is extrapolated. A run that changes later,
 * because fish come near each other or stop, is not known from that. Tested by tests/run/test_estimate.c. */
#ifndef ESTIMATE_H
#define ESTIMATE_H

#include "base/status.h"
#include "run/simulate.h"

struct estimate {
    double seconds; /* of a processor that has nothing else to do, for the whole run */
    double bytes;   /* of memory */
    long n_events;  /* that were done for it */
};

/* Estimate what the run of a simulation takes that is at its start; it can only be freed afterwards. The estimate takes
 * no more than this time [s] of the processor, except that the first event is done to its end; where simulation->stop
 * ends that, the estimate has no event, and follows from a part of one. Fails as simulate_step where the first events
 * fail, as they will in the run. */
enum status estimate_run(struct simulation *simulation, double patience, struct estimate *estimate);

#endif
