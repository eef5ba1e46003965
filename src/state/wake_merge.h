/* wake_merge.h: neighbours in an old wake become one, where the bodies hardly notice it: `wake.merge`. doc/numerics.md,
 * section 13. Tested by tests/state/test_wake_merge.c.
 *
 *     vortices            a     b          ->        a + b        at their centroid
 *
 *     markers     i-1 --- i --- i+1 --- i+2  ->   i-1 --- p --- i+2   the middle stretch is halved between the others
 *
 * The circulation of a wake and its first moment, the impulse, stay what they are to rounding. What is left is the
 * change of the second moments: with d the distance of each vortex (or middle of a stretch), before and after, from
 * the merged one, the velocity at a point at the distance r changes by
 *
 *     |du| <= sqrt(2)/(2 pi) sum |Gamma| d^2 / (r - d_max)^3.
 *
 * A pair is merged where that is, at every body, at most wake.merge lengths per beat of that body over the number of
 * vortices that one fish can own: so all that is merged in one wake changes the velocity at a body by at most
 * wake.merge lengths per beat. r is the smallest distance from a circle around the body, now and as long as the newer
 * of the two lives, if bodies and vortices go on with their velocities; and no pair is merged within two lengths of a
 * body. */
#ifndef WAKE_MERGE_H
#define WAKE_MERGE_H

#include "base/status.h"
#include "state/state.h"

/* Wakes are searched for pairs once in so many events, in turn. */
enum { WAKE_MERGE_EVENTS = 8 };

/* Merge what may be merged in the wakes whose turn it is, at the event of the state: after old vortices are removed,
 * and before the others have new velocities. Nothing without wake.merge. Fails with STATUS_MEMORY; nothing is merged
 * then. */
enum status wake_merge(const struct school *school, struct state *state);

#endif
