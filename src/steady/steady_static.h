/* steady_static.h: the equilibrium of passive bodies in a stream: `shoal steady` of a case without a beat.
 * Tested by tests/steady/test_steady_static.c and tests/app/test_steady_command.sh. */
#ifndef STEADY_STATIC_H
#define STEADY_STATIC_H

#include <stdbool.h>

#include "result/result_row.h"
#include "run/simulate.h"
#include "steady/steady.h"

/* Whether no fish beats, neither by a wave nor by prescribed motion. */
bool steady_static_applies(const struct school *school);

/* STATUS_CASE, with the reason and the remedy, if the bodies can have no equilibrium. */
enum status steady_static_refuse(const struct school *school);

/* Bring a simulation from the initial state to the equilibrium and fill *found; the caller allocates found->fish. Start
 * from the shapes of another equilibrium in the file from. If from is NULL, has other bodies or gives no solution,
 * increase the stream in steps from rest. Fails with STATUS_SOLVER if no equilibrium exists; the message gives the
 * largest stream with an equilibrium. Fails also with STATUS_STOPPED. */
enum status steady_static_find(struct simulation *simulation, const char *from, struct steady_values *found);

#endif
