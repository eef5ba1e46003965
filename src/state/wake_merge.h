/* wake_merge.h: merge neighbours in an old wake within a bound on the velocity change at the bodies: `wake.merge`.
 * doc/numerics.md, section 13. Tested by tests/state/test_wake_merge.c.
 *
 *     vortices            a     b          ->        a + b        at their centroid
 *
 *     markers     i-1 --- i --- i+1 --- i+2  ->   i-1 --- p --- i+2   half of the middle stretch to each side
 *
 * Merging conserves the circulation of a wake and the first moment, the impulse, to rounding. The leading error is the
 * change of the second moments: with d the distance of each vortex (or middle of a stretch), before and after, from
 * the merged vortex, the velocity at a point at the distance r changes by
 *
 *     |du| <= sqrt(2)/(2 pi) sum |Gamma| d^2 / (r - d_max)^3.
 *
 * A pair is merged if this bound, at every body, is at most wake.merge lengths per beat of the body, divided by the
 * largest number of vortices of one fish: all merging in one wake changes the velocity at a body by at most wake.merge
 * lengths per beat. r is the smallest distance from a circle around the body, over the remaining lifetime of the newer
 * vortex, for constant velocities of bodies and vortices. No pair is merged within two lengths of a body. */
#ifndef WAKE_MERGE_H
#define WAKE_MERGE_H

#include "state/state.h"

/* Every wake is searched for pairs once in WAKE_MERGE_EVENTS events, the wakes in turn. */
enum { WAKE_MERGE_EVENTS = 8 };

/* Merge pairs in the wakes of this turn, at the event of the state: after the removal of old vortices, before the
 * evaluation of new velocities. No-op without wake.merge. */
void wake_merge(const struct school *school, struct state *state);

#endif
