/* estimate.h: what a run will take: a few of its events are done, and then one with wakes as long as they will be. A
 * run that changes later, because fish come near each other or stop, is not known from that. Tested by
 * tests/run/test_estimate.c. */
#ifndef ESTIMATE_H
#define ESTIMATE_H

#include "base/status.h"
#include "run/simulate.h"

struct estimate {
    double seconds; /* of a processor that has nothing else to do, for the whole run */
    double bytes;   /* of memory */
    long n_events;  /* that were done for it */
};

/* Estimate what the run of a simulation takes that is at its start; it can only be freed afterwards. Events are done
 * for about this time [s], at least one. Fails as simulate_step. */
enum status estimate_run(struct simulation *simulation, double patience, struct estimate *estimate);

#endif
