/* steady_reason.h: why a formation has not been found: what its fish do once they are let go. doc/steady.md. Tested by
 * tests/steady/test_steady_formation.c. */
#ifndef STEADY_REASON_H
#define STEADY_REASON_H

#include "steady/steady_problem.h"

/* Let all fish go for some beats, and fail with STATUS_SOLVER and what becomes of them: two that come within
 * contact.range of each other, the one that drifts fastest from where the first one sees it, or neither. Or fail as
 * steady_map_beat. The beats do not count. */
enum status steady_reason_find(struct steady_problem *problem);

/* Of a formation that has been found: fail with STATUS_SOLVER where nothing keeps its places: 0.25 lengths away, times
 * the distance of 1 from the nearest multiplier, or what else a length does to a beat, is below the tolerance. */
enum status steady_reason_check(const struct steady_problem *problem, double in_a_length);

#endif
