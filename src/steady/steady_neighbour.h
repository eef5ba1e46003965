/* steady_neighbour.h: the start of a search from the whole state of a neighbour, which is the steady state of a case
 * that differs from this one in a number: bodies, wakes and memory of the control. Where steady_start.h supplies a few
 * slow quantities and lets the wake grow from nothing, here the wake is almost right from the first beat.
 * doc/steady.md, "Neighbours". Tested by tests/study/test_error.sh. */
#ifndef STEADY_NEIGHBOUR_H
#define STEADY_NEIGHBOUR_H

#include "steady/steady.h"
#include "steady/steady_problem.h"

/* Write the state of a simulation, as a checkpoint that belongs to no run. arena: for scratch. Fails with STATUS_FILE.
 */
enum status steady_neighbour_write(struct arena *arena, const char *path, const struct case_values *values,
                                   const struct simulation *simulation);

/* Create a simulation with the state in the file. Lengths, durations and circulations of a fish are those of the
 * neighbour in the units of this case: its body lengths and its shedding interval. Each fish keeps its centre of mass.
 * The state is not consistent until steady_neighbour_predict has set the slow quantities. Fails with STATUS_FILE unless
 * the file holds a state with the same unknowns, and as simulate_take_up. */
enum status steady_neighbour_start(struct arena *arena, struct simulation **simulation,
                                   const struct case_values *values, const char *path);

/* Change the speeds, and the places of a formation, from those of the first neighbour to the sum of those of all
 * neighbours times their weights. Finds problem->multiplier if a neighbour has multipliers. Fails with STATUS_FILE if a
 * file has no steady state of these fish, or as steady_map_add. */
enum status steady_neighbour_predict(struct steady_problem *problem, const struct steady_neighbours *neighbours);

#endif
