/* steady_reason.h: why no formation was found, from the free motion of the fish. doc/steady.md. Tested by
 * tests/steady/test_steady_formation.c. */
#ifndef STEADY_REASON_H
#define STEADY_REASON_H

#include "steady/steady_problem.h"

/* Release all fish for some beats and fail with STATUS_SOLVER and the observed motion: two fish within contact.range of
 * each other; else the fish with the fastest drift relative to the first fish; else no drift. Or fail as
 * steady_map_beat. These beats are not counted. */
enum status steady_reason_find(struct steady_problem *problem);

/* Check that interaction determines the places of a formation: fail with STATUS_SOLVER if a displacement of 0.25
 * lengths changes a beat by less than the tolerance. in_a_length: change per length of displacement, for example the
 * distance between 1 and the nearest multiplier. */
enum status steady_reason_check(const struct steady_problem *problem, double in_a_length);

#endif
